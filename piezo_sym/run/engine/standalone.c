/* A step of order two by itself, for programs in C; see <model>_step.h. */

static long MODEL(made)(MODEL(block) *m, const MODEL(parameters) *p, long *sizes, real *space)
{
    m->over = 1, m->most = MOST_OF_FIXED, m->late = LATE, m->stays = 0.7;
    return MODEL(make)(m, p, 0, sizes, space);
}

long MODEL(step_size)(const MODEL(parameters) *p)
{
    MODEL(block) block;
    long sizes[SIZES];
    const long size = MODEL(made)(&block, p, sizes, NULL);
    return size + block.n; /* the largest magnitudes stay from step to step */
}

int MODEL(step)(double *x, const double *u, double h, const MODEL(parameters) *p, double *booked,
                double *space)
{
    MODEL(block) block = {0}, *const m = &block;
    long sizes[SIZES];
    const long size = MODEL(made)(m, p, sizes, (real *)space);
    real *const largest = (real *)space + size;
    memset(space, 0, (size_t)size * sizeof(real));
    MODEL(give)(&m->p, p, 0);
    for (long k = 0; k < m->n; ++k) {
        m->x[k] = x[k];
        m->largest[k] = largest_of(size_of(x[k]), largest[k]);
    }
    for (long k = 0; k < m->inputs; ++k)
        m->u[k] = u[k];
    if (!MODEL(solve)(m, h, 1) || !MODEL(accepted)(m))
        return 0;
    for (long k = 0; k < m->booked; ++k)
        booked[k] = h * m->rows[k];
    MODEL(reach_of)(m, h, stage_weight, m->end);
    MODEL(at_point)(m, m->end, m->branch, m->u, NULL, m->gap, m->rows, m->side, m->margin);
    int good = MODEL(within)(m->margin);
    for (long k = 0; k < m->n; ++k)
        good &= size_of(m->gap[k]) < 1e300;
    if (!good)
        return 0;
    for (long k = 0; k < m->n; ++k) {
        x[k] = m->end[k];
        largest[k] = m->largest[k];
    }
    return 1;
}
