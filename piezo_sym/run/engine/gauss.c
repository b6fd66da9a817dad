/*
 * Steps of Gauss collocation that keep both balances: their work space, and states within them.
 * newton.c solves for the rates at the stages, in all lanes at once.
 *
 * Comes after real.h, a generated <model>_step.c and the tables for a number of stages. With rates
 * K_j at the stages, the state follows X(tau) = x + h sum_j K_j int_0^tau l_j. Stage i uses means
 * of the co-states, int_0^1 (l_i/b_i) dU/dx(X) dtau, by Gauss quadrature with NODES nodes, or with
 * FINE where these are too few, and piece by piece where energies have kinks. A root is accepted
 * only if it solves the equations, the quadrature is accurate, all numbers are finite, each stage
 * lies in the domain and no process consumes entropy.
 */

#include <stddef.h>

/*
 * NOISE is the round-off of a change, relative to the size of a state; up to MOST_NOISE times as
 * much is accepted where rates are sums of much larger numbers. NO_SIZE keeps divisors above 0.
 */
#define NOISE (sizeof(real) < sizeof(double) ? 1e-7 : 1e-16)
#define MOST_NOISE (sizeof(real) < sizeof(double) ? 1e5 : 1e4)
#define NO_SIZE (sizeof(real) < sizeof(double) ? 1e-30 : 1e-300)

#if PAIRS
/*
 * Numbers for pairs of complex eigenvalues: those of one run share a vector, so that their
 * equations are solved side by side.
 */
#if REAL_WIDTH == 1 && PAIRS > 1 && !defined(PLAIN)
#define TOGETHER (PAIRS == 2 ? 2 : 4)
typedef double pairs __attribute__((vector_size(8 * TOGETHER), aligned(8), may_alias));
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
/*
 * Columns of a path functional's row: its bank (-1: none), whether each lane of the bank has a drive
 * of its own, its inner state, and whether a drive depends on it. Then what it gives to a stage, and what its parameters are.
 */
enum { BANK, OWN, INNER, IN_DRIVE };
enum { EFFORT, SLIP, HEAT, SHARE, GIVEN };
enum { STIFFNESS, LIMIT, PARAMETERS };
/* Where in a step, as a fraction, a path functional first begins or ceases to yield; how often some do. */
enum { EARLIEST, HOW_OFTEN, YIELD };
#endif /* PATHS */

/* The work space of a step in all lanes: sizes, states, and intermediate results. */
typedef struct {
    MODEL(reals) p;
    const MODEL(parameters) *own; /* the parameters that were loaded last into a lane of p */
    long n, inputs, means, branches, booked, slopes, processes;
    long given; /* values given to a stage: means, and those of path functionals */
    const long *lanes, *first; /* lanes of each bank; first row of each state */
    real *x, *end;             /* n: states at the begin and the end of the step */
    real *rates;               /* STAGES*n */
    real *branch;              /* STAGES*branches */
    real *u;                   /* STAGES*inputs */
    real *largest;             /* n: largest magnitude of each state, the scale of its errors */
    real *noise;               /* n: how far round-off moves a state that is at rest; else 0 */
    real *reached, *gap, *prior, *node, *mean, *side, *margin, *rows, *slope, *fresh, *real_factor;
#if defined(PATHS)
    long drives;
    real *path, *drive; /* parameters of path functionals; drives at stages and at a point */
    real *follows;      /* the fraction of the step in which each inner state follows its coordinate */
    real *yield;
    real surveyed; /* the length of a survey's step; else 0 */
    long solved[PATHS + 1][2]; /* see FOR_SOLVED */
#endif /* PATHS */
#if defined(BENDS)
    long bends;
    real *bend, *look, *cut, *piece_slope; /* see bends.c */
#endif /* BENDS */
#if defined(COSTATES) /* see residual.c */
    real *costate, *integrand; /* at a point */
    real *rate_noise, *kept;   /* n: the round-off of each rate; `kept_size`: what is put aside to find it */
    size_t kept_size;
    real taken, scale;         /* entropy that the first body takes; factor on what processes book */
    mask loose, early;         /* lanes that may stop short of round-off; lanes that did */
    real allowed;              /* in units of noise: how far from their root they may be */
#endif /* COSTATES */
    mask fine;                 /* lanes whose means are taken at FINE nodes */
    mask over;                 /* lanes that step over kinks: each stage chooses its branches */
    mask sketch, sketched;     /* lanes that may stop early, beyond a switch; lanes that did */
    double enough;             /* in units of noise: they stop when a change is below this */
    real iterations;           /* of Newton's method */
    int most, late;            /* iterations in a step; after `late` it may be given up */
    double stays;              /* changes that shrink by no more than this factor stagnate */
#if PAIRS
    MODEL(complex) *factor, *right;
#endif /* PAIRS */
#if defined(LANES) /* the same with all stages side by side, see gaps_at_once.c */
    void *shared;
    real *reached_lanes, *gap_lanes, *mean_lanes, *branch_lanes, *u_lanes, *side_lanes, *rows_lanes;
    real *margin_lanes, *t_lanes;
#endif /* LANES */
} MODEL(block);

#if defined(PATHS)
/* Whether a record of states is the inner states of a bank's path functional. */
static int MODEL(is_inner)(long record, long bank)
{
    int found = 0;
    for (long n = 0; n < PATHS; ++n)
        found |= MODEL(path)[n][INNER] == record && MODEL(path)[n][BANK] == bank;
    return found;
}

/*
 * Whether the lanes of a bank have no states but inner ones, which Newton's method then leaves out. It leaves out
 * none if a drive depends on an inner state: rates that are set would lag behind those by which they are.
 */
static int MODEL(is_left_out)(long bank)
{
    int found = 1;
    for (long k = MODEL(lane_states_at)[bank]; k < MODEL(lane_states_at)[bank + 1]; ++k)
        found &= MODEL(is_inner)(MODEL(lane_states)[k], bank);
    for (long n = 0; n < PATHS; ++n)
        found &= !MODEL(path)[n][IN_DRIVE];
    return found;
}

/* Find the ranges of FOR_SOLVED: they end where a bank is left out. */
static void MODEL(find_solved)(MODEL(block) *m)
{
    long range = 0;
    memset(m->solved, 0, sizeof m->solved);
    for (long record = 0; record < MODEL(records); ++record) {
        const long end = record + 1 < MODEL(records) ? m->first[record + 1] : m->n;
        int left_out = 0;
        for (long bank = 0; bank < MODEL(banks); ++bank)
            left_out |= MODEL(is_inner)(record, bank) && MODEL(is_left_out)(bank);
        if (left_out)
            m->solved[++range][0] = end;
        m->solved[range][1] = end;
    }
}

/*
 * The ranges of the states that Newton's method solves for. Those of banks of path functionals are left out:
 * their rates are set by the rates of their coordinates.
 */
#define FOR_SOLVED(m, begin, end) \
    for (long range = 0, begin, end; range <= PATHS \
         && (begin = (m)->solved[range][0], end = (m)->solved[range][1], 1); ++range)
#endif /* PATHS */
#if !defined(PATHS)
#define FOR_SOLVED(m, begin, end) for (long begin = 0, end = (m)->n; begin < end; begin = end)

static int MODEL(is_left_out)(long bank)
{
    (void)bank;
    return 0;
}
#endif

enum { ALL, SOLVED }; /* the states that a system of equations is solved for */

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

/* Entries of `sizes`: counts, lanes of banks, first rows of states, and bend functions. */
enum { SIZES = 7 + MODEL(banks) + MODEL(records) };
#if defined(BENDS)
/* Points at which bend functions are sampled; three neighbours make a parabola, see bends.c. */
enum { BEND_LOOKS = 4 * STAGES + 3 };
#endif /* BENDS */

/*
 * Set up the work space of runs with the sizes of p in `memory`, which may be NULL; returns how
 * many numbers it takes. Ledgers have `more` rows behind the model's own.
 */
static long MODEL(make)(MODEL(block) *m, const MODEL(parameters) *p, long more, long *sizes,
                        real *memory)
{
    long at = MODEL(place_reals)(&m->p, p, memory);
    MODEL(sizes)(&m->p, sizes);
    const long n = m->n = sizes[0];
    m->means = sizes[1], m->branches = sizes[2], m->booked = sizes[3] + more;
    m->processes = sizes[4], m->slopes = sizes[5];
    m->inputs = MODEL(input_count);
    m->lanes = sizes + 6, m->first = sizes + 6 + MODEL(banks);
    m->given = m->means;
#if defined(PATHS)
    long paths = 0;
    m->drives = 0;
    for (long k = 0; k < PATHS; ++k) {
        const long lanes = MODEL(path)[k][BANK] < 0 ? 1 : m->lanes[MODEL(path)[k][BANK]];
        paths += lanes, m->drives += MODEL(path)[k][OWN] ? lanes : 1;
    }
    MODEL(find_solved)(m);
    m->given += GIVEN * paths;
#endif /* PATHS */
#define PLACE(array, size) (m->array = memory ? (void *)(memory + at) : NULL, at += (size))
    PLACE(x, n);
    PLACE(end, n);
    PLACE(rates, STAGES * n);
    PLACE(branch, STAGES * m->branches);
    PLACE(u, STAGES * m->inputs);
    PLACE(largest, n);
    PLACE(noise, n);
    PLACE(reached, n);
#if defined(COSTATES)
    const long from = at; /* what a point writes lies from here */
#endif /* COSTATES */
    PLACE(gap, STAGES * n);
    PLACE(prior, STAGES * n);
    PLACE(node, FINE * m->means + m->given - m->means);
    PLACE(mean, STAGES * m->given);
    PLACE(side, STAGES * m->branches);
    PLACE(margin, STAGES * MODEL(limits));
    PLACE(rows, STAGES * m->booked);
#if defined(COSTATES)
    const long until = at; /* to here */
#endif /* COSTATES */
    PLACE(slope, m->slopes);
#if defined(PATHS)
    PLACE(path, PARAMETERS * paths);
    PLACE(follows, paths);
    PLACE(drive, (STAGES + 1) * m->drives);
    PLACE(yield, YIELD);
#endif /* PATHS */
#if defined(COSTATES)
    PLACE(costate, n);
    PLACE(integrand, m->given);
    PLACE(rate_noise, n);
    PLACE(kept, until - from);
    m->kept_size = (size_t)(until - from) * sizeof(real);
#endif /* COSTATES */
    m->fresh = m->slope; /* of one run there is no lane that keeps its slopes */
    if (REAL_WIDTH > 1)
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
    at = (at + LANES - 1) / LANES * LANES;
    PLACE(reached_lanes, n * LANES);
    PLACE(gap_lanes, n * LANES);
    PLACE(mean_lanes, m->given * LANES);
    PLACE(branch_lanes, m->branches * LANES);
    PLACE(u_lanes, m->inputs * LANES);
    PLACE(side_lanes, m->branches * LANES);
    PLACE(rows_lanes, m->booked * LANES);
    PLACE(margin_lanes, MODEL(limits) * LANES);
    PLACE(t_lanes, LANES);
    PLACE(shared, (long)(MODEL(shared_size)(p) / sizeof(real)));
#endif /* LANES */
#if PAIRS
    const long reals = sizeof(MODEL(complex)) / sizeof(real);
    PLACE(factor, reals * PAIRS * MODEL(factor_size_complex)(m));
    PLACE(right, reals * n);
#endif /* PAIRS */
#undef PLACE
    return at;
}

/* State i at a point of the step, which weights of the stages' rates say. */
static inline real MODEL(reached_row)(const MODEL(block) *m, real h, const double *weight, long i)
{
    real sum = zero;
    for (long j = 0; j < STAGES; ++j)
        sum += weight[j] * m->rates[j * m->n + i];
    return m->x[i] + h * sum;
}

/* All states at a point of the step. */
static void MODEL(reach_of)(const MODEL(block) *m, real h, const double *weight, real *restrict out)
{
    for (long i = 0; i < m->n; ++i)
        out[i] = MODEL(reached_row)(m, h, weight, i);
}

/*
 * Set branches by the signs of their switching functions, in some lanes; returns the lanes with
 * changes.
 */
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
