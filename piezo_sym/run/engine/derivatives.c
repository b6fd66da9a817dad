/*
 * The equations of a step, G_i = f(X(c_i), means, u_i) - K_i = 0, and their derivatives along a direction
 * in all that they depend on: arguments and results are dual numbers.  Comes after dual.h, a generated
 * <model>_step.c and the tables of a number of stages.  Branches are kept.
 */

#if defined(BENDS) || defined(PATHS)
#error "no derivatives yet of steps with kinks of energies or with path functionals"
#endif

/* Arguments and results of the equations of a step; arrays of dual numbers. */
typedef struct {
    const MODEL(parameters) *p, *slopes; /* the slopes of parameters are a record like theirs */
    const real *h;
    const real *x, *rates; /* n; STAGES*n */
    const real *u;         /* (STAGES + 1)*inputs: at the stages, and at the end */
    const real *branch;    /* STAGES*branches; slopes are zero */
    real *gap, *end, *side; /* STAGES*n; n; branches: the switching functions at the end */
    real *space;
} MODEL(direction);

/* The sizes of a model's arrays, as run/engine has them. */
static void MODEL(direction_sizes)(const MODEL(parameters) *p, long *sizes)
{
    MODEL(reals) reals;
    MODEL(place_reals)(&reals, p, NULL);
    MODEL(sizes)(&reals, sizes);
}

/* How many numbers the space of a direction has. */
long MODEL(direction_space)(const MODEL(parameters) *p);
long MODEL(direction_space)(const MODEL(parameters) *p)
{
    MODEL(reals) none;
    long sizes[7 + MODEL(banks) + MODEL(records)];
    MODEL(direction_sizes)(p, sizes);
    return MODEL(place_reals)(&none, p, NULL) + sizes[0] + (FINE + 1) * sizes[1] + sizes[2] + sizes[3]
        + MODEL(limits);
}

static void MODEL(direction_reach)(const MODEL(direction) *d, long n, const double *weight, real *out)
{
    for (long k = 0; k < n; ++k) {
        real sum = zero;
        for (long j = 0; j < STAGES; ++j)
            sum += weight[j] * d->rates[j * n + k];
        out[k] = d->x[k] + *d->h * sum;
    }
}

void MODEL(along)(const MODEL(direction) *d);
void MODEL(along)(const MODEL(direction) *d)
{
    MODEL(reals) p;
    long sizes[7 + MODEL(banks) + MODEL(records)];
    MODEL(direction_sizes)(d->p, sizes);
    const long n = sizes[0], means = sizes[1], branches = sizes[2], inputs = MODEL(input_count);
    real *const reached = d->space + MODEL(place_reals)(&p, d->p, d->space);
    real *const node = reached + n, *const mean = node + FINE * means, *const side = mean + means;
    real *const rows = side + branches, *const margin = rows + sizes[3];
    MODEL(give)(&p, d->p, 0);
    MODEL(give)(&p, d->slopes, 1);
    for (long q = 0; q < FINE; ++q) {
        MODEL(direction_reach)(d, n, fine_reach[q], reached);
        MODEL(integrands)(reached, &p, node + q * means);
    }
    for (long i = 0; i < STAGES; ++i) {
        real *const gap = d->gap + i * n;
        for (long k = 0; k < means; ++k) {
            mean[k] = zero;
            for (long q = 0; q < FINE; ++q)
                mean[k] += fine_mean[i][q] * node[q * means + k];
        }
        MODEL(direction_reach)(d, n, stage_reach[i], reached);
        MODEL(stage)(reached, mean, d->branch + i * branches, d->u + i * inputs, &p, gap, rows, side,
                     margin);
        for (long k = 0; k < n; ++k)
            gap[k] -= d->rates[i * n + k];
    }
    MODEL(direction_reach)(d, n, stage_weight, d->end);
    MODEL(integrands)(d->end, &p, mean);
    MODEL(stage)(d->end, mean, d->branch + (STAGES - 1) * branches, d->u + STAGES * inputs, &p, reached,
                 rows, d->side, margin);
}
