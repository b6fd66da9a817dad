/*
 * Steps of Gauss collocation that keep both balances: the rates that stages have to have, for the runs
 * of all lanes at once; newton.c finds them.
 *
 * Behind real.h, a generated <model>_step.c and the tables of a number of stages.  With rates K_j
 * the state goes along X(tau) = x + h sum_j K_j int_0^tau l_j; stage i has the co-states' means
 * int_0^1 (l_i/b_i) dU/dx(X) dtau, taken at NODES nodes of Gauss's rule, or at FINE of them where the
 * co-states ask for more, and piece by piece where energies have kinks.  A root counts only if it solves
 * the equations, these nodes do, all is finite, each stage lies in the domain and no process takes entropy.
 */

#include <stddef.h>

/*
 * What rounding leaves of a change, in parts of a state's size; how much of that may be left where
 * rates are made of much larger numbers; and the least size.
 */
#define NOISE (sizeof(real) < sizeof(double) ? 1e-7 : 1e-16)
#define MOST_NOISE (sizeof(real) < sizeof(double) ? 1e5 : 1e4)
#define NO_SIZE (sizeof(real) < sizeof(double) ? 1e-30 : 1e-300)

#if PAIRS
#if PAIRS > 2
#error "more pairs need another vector"
#endif
/* Numbers for pairs of eigenvalues: those of one run are solved with side by side. */
#if REAL_WIDTH == 1 && PAIRS > 1 && !defined(PLAIN)
#define TOGETHER PAIRS
typedef double pairs __attribute__((vector_size(8 * PAIRS), aligned(8), may_alias));
#define PAIR(number, k) (((double *)&(number))[k])
#define PAIRS_OF(value) ((pairs){0.0} + (value))
#else
#define TOGETHER 1
typedef real pairs;
#define PAIR(number, k) (number)
#define PAIRS_OF(value) wide(value)
#endif

typedef struct {
    pairs re, im;
} MODEL(complex);
#endif /* PAIRS */

#if defined(PATHS)
/* Of a path functional: its bank or -1, the state that is its coordinate, whether each lane has its
 * own, its inner state; what a stage is given; what it takes. */
enum { BANK, COORDINATE, OWN, INNER };
enum { EFFORT, RATE, HEAT, SHARE, GIVEN };
enum { STIFFNESS, LIMIT, PARAMETERS };
#endif /* PATHS */

/* The runs of all lanes, as they take a step: sizes, and the numbers that it works on. */
typedef struct {
    MODEL(reals) p;
    const MODEL(parameters) *own; /* those of p, in the last lane that has taken some */
    long n, inputs, means, branches, booked, slopes, processes;
    long given; /* to a stage: means, and what path functionals give */
    const long *lanes, *first; /* of each bank; of each state, its first row */
    real *x, *end;             /* n: where the step begins, and where it ends */
    real *rates;               /* STAGES*n */
    real *branch;              /* STAGES*branches */
    real *u;                   /* STAGES*inputs */
    real *largest;             /* n: the largest magnitude of each state, by which errors count */
    real *reached, *gap, *prior, *node, *mean, *side, *margin, *rows, *slope, *fresh, *real_factor;
    real *path, *yield;        /* parameters of path functionals; where one first yields in a step */
#if defined(BENDS)
    long bends;
    real *bend, *look, *cut, *piece_slope; /* see bends.c */
#endif /* BENDS */
    mask fine;                 /* lanes whose means are taken at FINE nodes */
    mask over;                 /* lanes whose stages choose their branches: they step over kinks */
    mask sketch, sketched;     /* lanes whose steps may be cut at a switch; those found to have one */
    double enough;             /* what changes, in units of noise, have to be below to tell that */
    real iterations;           /* of Newton's method */
    int most, late;            /* of them in a step; after which it may be given up */
    double stays;              /* a change that is more than this part of the one before is noise */
#if PAIRS
    MODEL(complex) *factor, *right;
#endif /* PAIRS */
#if defined(LANES) /* the same with all stages side by side, see gaps_at_once.c */
    void *shared;
    real *reached_lanes, *gap_lanes, *mean_lanes, *branch_lanes, *u_lanes, *side_lanes, *rows_lanes;
    real *margin_lanes;
#endif /* LANES */
} MODEL(block);

#define NUMBER real
#define NAMED(name) MODEL(name##_real)
#define ONE wide(1.0)
#define NONE zero
#define PER(a) (1.0 / (a))
#define TIMES(a, b) ((a) * (b))
#define BY(a, b) ((a) * (b))
#define MORE(a, b) ((a) + (b))
#define LESS(a, b) ((a) - (b))
#include "elimination.c"
#undef NUMBER
#undef NAMED
#undef ONE
#undef NONE
#undef PER
#undef TIMES
#undef BY
#undef MORE
#undef LESS
#if PAIRS
#define NUMBER MODEL(complex)
#define NAMED(name) MODEL(name##_complex)
#define ONE ((MODEL(complex)){PAIRS_OF(1.0), PAIRS_OF(0.0)})
#define NONE ((MODEL(complex)){PAIRS_OF(0.0), PAIRS_OF(0.0)})
#define PER(a) MODEL(per)(a)
#define TIMES(a, b) MODEL(times)(a, b)
#define BY(a, b) MODEL(by)(a, b)
#define MORE(a, b) MODEL(more)(a, b)
#define LESS(a, b) MODEL(less)(a, b)
static inline MODEL(complex) MODEL(per)(MODEL(complex) a)
{
    const pairs size = a.re * a.re + a.im * a.im;
    return (MODEL(complex)){a.re / size, -a.im / size};
}
static inline MODEL(complex) MODEL(times)(MODEL(complex) a, MODEL(complex) b)
{
    return (MODEL(complex)){a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}
static inline MODEL(complex) MODEL(by)(MODEL(complex) a, real b)
{
    return (MODEL(complex)){a.re * b, a.im * b};
}
static inline MODEL(complex) MODEL(more)(MODEL(complex) a, MODEL(complex) b)
{
    return (MODEL(complex)){a.re + b.re, a.im + b.im};
}
static inline MODEL(complex) MODEL(less)(MODEL(complex) a, MODEL(complex) b)
{
    return (MODEL(complex)){a.re - b.re, a.im - b.im};
}
#include "elimination.c"
#endif /* PAIRS */

/* The numbers that a block says of itself: sizes, lanes of banks, first rows of states, bends. */
enum { SIZES = 7 + MODEL(banks) + MODEL(records) };
#if defined(BENDS)
/* Places where bends are looked at; between them each is about a parabola. */
enum { BEND_LOOKS = 4 * STAGES + 3 };
#endif /* BENDS */

/*
 * Make a block for runs of the sizes of p, `more` rows for the ledger behind the model's own.  Its
 * numbers lie from `at` on; returns how many these are.
 */
static long MODEL(make)(MODEL(block) *m, const MODEL(parameters) *p, long more, long *sizes, real *at)
{
    real *const begin = at;
    at += MODEL(place_reals)(&m->p, p, at);
    MODEL(sizes)(&m->p, sizes);
    const long n = m->n = sizes[0];
    m->means = sizes[1], m->branches = sizes[2], m->booked = sizes[3] + more;
    m->processes = sizes[4], m->slopes = sizes[5];
    m->inputs = MODEL(input_count);
    m->lanes = sizes + 6, m->first = sizes + 6 + MODEL(banks);
    m->given = m->means;
#if defined(PATHS)
    long paths = 0;
    for (long k = 0; k < PATHS; ++k)
        paths += MODEL(path)[k][BANK] < 0 ? 1 : m->lanes[MODEL(path)[k][BANK]];
    m->given += GIVEN * paths;
#endif /* PATHS */
#define PLACE(array, size) (m->array = at, at += (size))
    PLACE(x, n);
    PLACE(end, n);
    PLACE(rates, STAGES * n);
    PLACE(branch, STAGES * m->branches);
    PLACE(u, STAGES * m->inputs);
    PLACE(largest, n);
    PLACE(reached, n);
    PLACE(gap, STAGES * n);
    PLACE(prior, STAGES * n);
    PLACE(node, FINE * m->means + m->given - m->means);
    PLACE(mean, STAGES * m->given);
    PLACE(side, STAGES * m->branches);
    PLACE(margin, STAGES * MODEL(limits));
    PLACE(rows, STAGES * m->booked);
    PLACE(slope, m->slopes);
#if defined(PATHS)
    PLACE(path, PARAMETERS * paths);
    PLACE(yield, 1);
#endif /* PATHS */
    PLACE(fresh, m->slopes);
    PLACE(real_factor, MODEL(factor_size_real)(m));
#if defined(BENDS)
    m->bends = sizes[SIZES - 1];
    PLACE(bend, m->bends);
    PLACE(piece_slope, m->slopes);
    PLACE(look, BEND_LOOKS * m->bends);
    PLACE(cut, (BEND_LOOKS - 1) * m->bends + 1);
#endif /* BENDS */
#if defined(LANES)
    at = begin + (at - begin + LANES - 1) / LANES * LANES;
    PLACE(reached_lanes, n * LANES);
    PLACE(gap_lanes, n * LANES);
    PLACE(mean_lanes, m->given * LANES);
    PLACE(branch_lanes, m->branches * LANES);
    PLACE(u_lanes, m->inputs * LANES);
    PLACE(side_lanes, m->branches * LANES);
    PLACE(rows_lanes, m->booked * LANES);
    PLACE(margin_lanes, MODEL(limits) * LANES);
    m->shared = at, at += MODEL(shared_size)(p) / sizeof(real);
#endif /* LANES */
#undef PLACE
#if PAIRS
    m->factor = (MODEL(complex) *)at;
    m->right = m->factor + PAIRS * MODEL(factor_size_complex)(m);
    at = (real *)(m->right + n);
#endif /* PAIRS */
    return at - begin;
}

/* A state at a place of the step, reached by rates with these weights. */
static inline real MODEL(reached_row)(const MODEL(block) *m, real h, const double *weight, long i)
{
    real sum = zero;
    for (long j = 0; j < STAGES; ++j)
        sum += weight[j] * m->rates[j * m->n + i];
    return m->x[i] + h * sum;
}

/* All states at a place of the step. */
static void MODEL(reach)(const MODEL(block) *m, real h, const double *weight, real *restrict out)
{
    for (long i = 0; i < m->n; ++i)
        out[i] = MODEL(reached_row)(m, h, weight, i);
}

/* Choose branches by their switching functions in some lanes; returns those where any changes. */
static mask MODEL(choose)(long branches, const real *side, real *branch, mask where)
{
    mask changed = nowhere;
    for (long k = 0; k < branches; ++k) {
        const mask positive = side[k] > 0.0;
        const real old = branch[k], new = chosen(positive, wide(1.0), zero);
        changed |= where & (new != old);
        branch[k] = chosen(where, new, old);
    }
    return changed;
}
