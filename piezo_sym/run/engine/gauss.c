/*
 * Steps of Gauss collocation that keep both balances: Newton's method for the rates at the stages,
 * for the runs of all lanes at once.
 *
 * Behind real.h, a generated <model>_step.c and the tables of a number of stages.  With rates K_j
 * the state goes along X(tau) = x + h sum_j K_j int_0^tau l_j; stage i has the co-states' means
 * int_0^1 (l_i/b_i) dU/dx(X) dtau, taken at NODES nodes of Gauss's rule, or at FINE of them where the
 * co-states ask for more.  A root counts only if all is finite, each stage lies in the domain and no
 * process takes entropy.
 */

#include <stddef.h>

/* Iterations, and after how many a step is given up whose changes do not become smaller. */
enum { MOST_ITERATIONS = 12, SOON = 1 };
/*
 * A fixed step may begin far from its root: from beyond the bend of an exponential law Newton's method
 * comes back by its width each time, however short the step.
 */
enum { MOST_OF_FIXED = 1000, LATE = 900, NOISY = 300 };
/* Where a change is more than so much of the one before, slopes are taken anew. */
#define SLOW 0.1
/* Changes go to and fro where so much of one is left, with the other sign. */
#define TO_AND_FRO 0.5
/* What Newton's method may leave of a state's change, in parts of its largest magnitude. */
#define NOISE 1e-16

typedef struct {
    real re, im;
} MODEL(complex);

/* The runs of all lanes, as they take a step: sizes, and the numbers that it works on. */
typedef struct {
    MODEL(reals) p;
    const MODEL(parameters) *own; /* those of p, in the last lane that has taken some */
    long n, inputs, means, branches, booked, slopes, processes;
    const long *lanes, *first; /* of each bank; of each state, its first row */
    real *x, *end;             /* n: where the step begins, and where it ends */
    real *rates;               /* STAGES*n */
    real *branch;              /* STAGES*branches */
    real *u;                   /* STAGES*inputs */
    real *largest;             /* n: the largest magnitude of each state, by which errors count */
    real *reached, *gap, *prior, *node, *mean, *side, *margin, *rows, *slope, *fresh, *real_factor;
    mask fine;                 /* lanes whose means are taken at FINE nodes */
    mask over;                 /* lanes whose stages choose their branches: they step over kinks */
    real iterations;           /* of Newton's method */
    int most, late;            /* of them in a step; after which it may be given up */
    double stays;              /* a change that is more than this part of the one before is noise */
    MODEL(complex) *factor, *right;
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
#define ONE ((MODEL(complex)){wide(1.0), zero})
#define NONE ((MODEL(complex)){zero, zero})
#define PER(a) MODEL(per)(a)
#define TIMES(a, b) MODEL(times)(a, b)
#define BY(a, b) MODEL(by)(a, b)
#define MORE(a, b) MODEL(more)(a, b)
#define LESS(a, b) MODEL(less)(a, b)
static inline MODEL(complex) MODEL(per)(MODEL(complex) a)
{
    const real size = a.re * a.re + a.im * a.im;
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

/* The numbers that a block says of itself: sizes, lanes of banks, first rows of states. */
enum { SIZES = 6 + MODEL(banks) + MODEL(records) };

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
    PLACE(node, FINE * m->means);
    PLACE(mean, STAGES * m->means);
    PLACE(side, STAGES * m->branches);
    PLACE(margin, STAGES * MODEL(limits));
    PLACE(rows, STAGES * m->booked);
    PLACE(slope, m->slopes);
    PLACE(fresh, m->slopes);
    PLACE(real_factor, MODEL(factor_size_real)(m));
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

/* The states alone that integrands read. */
static void MODEL(reach_read)(const MODEL(block) *m, real h, const double *weight)
{
    for (long r = 0; r < MODEL(reads); ++r) {
        const long record = MODEL(read)[r];
        const long end = record + 1 < MODEL(records) ? m->first[record + 1] : m->n;
        for (long i = m->first[record]; i < end; ++i)
            m->reached[i] = MODEL(reached_row)(m, h, weight, i);
    }
}

/* The functions of which stages are given means, at nodes of a step. */
static void MODEL(integrate)(const MODEL(block) *m, real h, const double reach[][STAGES], long nodes)
{
    for (long q = 0; q < nodes; ++q) {
        MODEL(reach_read)(m, h, reach[q]);
        MODEL(integrands)(m->reached, &m->p, m->node + q * m->means);
    }
}

/* What the last polynomial of Legendre has of a function at nodes, in parts of its size. */
static real MODEL(last_part)(const MODEL(block) *m, long k, const double *last, long nodes)
{
    real sum = zero, most = 1e-300 + zero;
    for (long q = 0; q < nodes; ++q) {
        sum += last[q] * m->node[q * m->means + k];
        most = largest_of(size_of(m->node[q * m->means + k]), most);
    }
    return size_of(sum) / most;
}

/* Means over the step, by the rule of each lane. */
static void MODEL(average)(const MODEL(block) *m, real h)
{
    MODEL(integrate)(m, h, node_reach, NODES);
    for (long i = 0; i < STAGES; ++i)
        for (long k = 0; k < m->means; ++k) {
            real *const mean = m->mean + i * m->means + k;
            *mean = zero;
            for (long q = 0; q < NODES; ++q)
                *mean += node_mean[i][q] * m->node[q * m->means + k];
        }
    if (!any(m->fine))
        return;
    MODEL(integrate)(m, h, fine_reach, FINE);
    for (long i = 0; i < STAGES; ++i)
        for (long k = 0; k < m->means; ++k) {
            real *const mean = m->mean + i * m->means + k, sum = zero;
            for (long q = 0; q < FINE; ++q)
                sum += fine_mean[i][q] * m->node[q * m->means + k];
            *mean = chosen(m->fine, sum, *mean);
        }
}

/* The lanes whose co-states ask for more nodes than NODES, for balances that are exact to round-off. */
static mask MODEL(coarse)(const MODEL(block) *m, real h)
{
    mask found = nowhere;
    if (m->means)
        MODEL(integrate)(m, h, node_reach, NODES);
    for (long k = 0; k < m->means; ++k)
        found |= MODEL(last_part)(m, k, node_last, NODES) > COARSE;
    return found;
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

#if LOSSY /* see loss.c */
static void MODEL(lose)(const MODEL(block) *m, real h, real *rate, real *rows);
#endif

/* What the rates at the stages have to be, less what they are; returns where branches change. */
static mask MODEL(gaps)(const MODEL(block) *m, real h, mask going)
{
    const mask over = m->over & going;
    mask changed = nowhere;
    if (m->means)
        MODEL(average)(m, h);
    for (long i = 0; i < STAGES; ++i) {
        real *gap = m->gap + i * m->n, *mean = m->mean + i * m->means;
        real *side = m->side + i * m->branches, *branch = m->branch + i * m->branches;
        MODEL(reach)(m, h, stage_reach[i], m->reached);
        for (int again = 0; again < 3; ++again) {
            MODEL(stage)(m->reached, mean, branch, m->u + i * m->inputs, &m->p, gap,
                         m->rows + i * m->booked, side, m->margin + i * MODEL(limits));
            if (!any(over))
                break;
            const mask other = MODEL(choose)(m->branches, side, branch, over);
            if (!any(other))
                break;
            changed |= other;
        }
#if LOSSY
        MODEL(lose)(m, h, gap, m->rows);
#endif
        for (long k = 0; k < m->n; ++k)
            gap[k] -= m->rates[i * m->n + k];
    }
    return changed;
}

/* Newton's change of the rates, from the gaps; gaps become it. */
static void MODEL(change)(const MODEL(block) *m, real h)
{
    const long n = m->n;
    for (long k = 0; k < n; ++k) {
        real one[STAGES];
        for (long i = 0; i < STAGES; ++i) {
            one[i] = zero;
            for (long j = 0; j < STAGES; ++j)
                one[i] += basis_stage[i][j] * m->gap[j * n + k];
        }
        for (long i = 0; i < STAGES; ++i)
            m->gap[i * n + k] = one[i];
    }
#if STAGES % 2
    MODEL(solve_real)(m, h * filter, m->slope, m->real_factor, m->gap);
#endif
#if PAIRS
    const long size = MODEL(factor_size_complex)(m);
    for (long pair = 0; pair < PAIRS; ++pair) {
        const double *value = eigenvalue[STAGES % 2 + pair];
        const MODEL(complex) gamma = {h * value[0], h * value[1]};
        real *one = m->gap + (STAGES % 2 + 2 * pair) * n, *other = one + n;
        for (long k = 0; k < n; ++k)
            m->right[k] = (MODEL(complex)){one[k], -other[k]};
        MODEL(solve_complex)(m, gamma, m->slope, m->factor + pair * size, m->right);
        for (long k = 0; k < n; ++k)
            one[k] = m->right[k].re, other[k] = -m->right[k].im;
    }
#endif /* PAIRS */
    for (long k = 0; k < n; ++k) {
        real one[STAGES];
        for (long i = 0; i < STAGES; ++i) {
            one[i] = zero;
            for (long j = 0; j < STAGES; ++j)
                one[i] += stage_basis[i][j] * m->gap[j * n + k];
        }
        for (long i = 0; i < STAGES; ++i)
            m->gap[i * n + k] = one[i];
    }
}

/*
 * Slopes in the middle of the step, on the branches of its middle stage, and what solves with them;
 * lanes that are not in `where` keep theirs.
 */
static void MODEL(prepare)(const MODEL(block) *m, real h, mask where)
{
    const long middle = STAGES / 2;
    MODEL(reach)(m, h, stage_reach[middle], m->reached);
    MODEL(slopes)(m->reached, m->branch + middle * m->branches, m->u + middle * m->inputs, &m->p,
                  m->fresh);
    for (long k = 0; k < m->slopes; ++k)
        m->slope[k] = chosen(where, m->fresh[k], m->slope[k]);
    MODEL(factorise_real)(m, h * filter, m->slope, m->real_factor);
#if PAIRS
    const long size = MODEL(factor_size_complex)(m);
    for (long pair = 0; pair < PAIRS; ++pair) {
        const double *value = eigenvalue[STAGES % 2 + pair];
        const MODEL(complex) gamma = {h * value[0], h * value[1]};
        MODEL(factorise_complex)(m, gamma, m->slope, m->factor + pair * size);
    }
#endif /* PAIRS */
}

/* The lanes whose margins are those of a state in the domain. */
static mask MODEL(within)(const real *margin)
{
    mask good = none_of(nowhere);
    for (long k = 0; k < MODEL(limits); ++k) {
        const mask inside = margin[k] > 0.0, edge = margin[k] == 0.0;
        good &= MODEL(strict)[k] ? inside : (mask)(inside | edge);
    }
    return good;
}

/* The lanes whose stages all lie in the domain, and whose processes take no entropy. */
static mask MODEL(accepted)(const MODEL(block) *m)
{
    const long processes = m->processes, ports = MODEL(output_count);
    mask good = none_of(nowhere);
    for (long i = 0; i < STAGES; ++i) {
        const real *rows = m->rows + i * m->booked + ports + processes;
        real total = zero, lowest = zero;
        good &= MODEL(within)(m->margin + i * MODEL(limits));
        for (long k = 0; k < processes; ++k) {
            const mask less = rows[k] < lowest;
            total += size_of(rows[k]);
            lowest = chosen(less, rows[k], lowest);
        }
#if LOSSY
        lowest = fmin(lowest, m->rows[m->booked - 1]);
        good &= m->rows[m->booked - 1] == m->rows[m->booked - 1];
#endif
        good &= lowest >= -1e-14 * total;
    }
    return good;
}

/*
 * How much of a change to take where changes go to and fro: slopes are those at one place of a step,
 * with co-states there for means, and a long step has others.  What the change before has left says
 * by how much it went too far.
 */
static real MODEL(damping)(const MODEL(block) *m)
{
    real both = zero, prior = 1e-300 + zero;
    for (long k = 0; k < m->n; ++k) {
        const real size = m->largest[k] + size_of(m->x[k]) + 1e-300;
        for (long j = 0; j < STAGES; ++j) {
            const real last = m->prior[j * m->n + k] / size;
            both += last * (m->gap[j * m->n + k] / size);
            prior += last * last;
        }
    }
    const real left = both / prior;
    const mask fro = left < -TO_AND_FRO;
    return chosen(fro, 1.0 / (1.0 - left), wide(1.0));
}

/*
 * Newton's method for the rates in some lanes, begun where they are; returns those that found them.
 * A lane that has found them stays as it is, however long the others take.
 */
static mask MODEL(iterate)(MODEL(block) *m, real h, mask where)
{
    mask going = where, found = nowhere;
    real before = zero;
    MODEL(gaps)(m, h, going);
    MODEL(prepare)(m, h, going);
    for (int iteration = 0; iteration < m->most && any(going); ++iteration) {
        real worst = zero;
        m->iterations += chosen(going, wide(1.0), zero);
        MODEL(change)(m, h);
        const real part = iteration && m->late > SOON ? MODEL(damping)(m) : (real)wide(1.0);
        for (long k = 0; k < m->n; ++k) {
            real moved = zero, changed = zero;
            for (long j = 0; j < STAGES; ++j) {
                real *const rate = m->rates + j * m->n + k;
                const real change = chosen(going, part * m->gap[j * m->n + k], zero);
                m->prior[j * m->n + k] = change;
                *rate += change;
                moved = largest_of(moved, size_of(*rate));
                changed += size_of(change);
            }
            const real size = NOISE * (m->largest[k] + size_of(m->x[k]) + h * moved) + 1e-300;
            worst = largest_of(h * changed / size, worst);
        }
        const mask switched = MODEL(gaps)(m, h, going);
        const mask smaller = worst < before, lost = none_of(worst < 1e300);
        mask good = (worst <= 4.0) | (smaller & (worst * (worst / before) <= 1.0));
        if (iteration > 1) { /* noise of what rates are made of, or no root */
            const mask stays = (worst > m->stays * before) & none_of(good);
            good |= stays & (worst < (m->late == SOON || iteration > NOISY ? 1e4 : 100.0));
            if (iteration > m->late)
                going &= none_of(stays & none_of(good));
        }
        good &= none_of(lost);
        found |= going & good;
        going &= none_of(good | lost);
        const mask slow = (worst > SLOW * before) & (before > 0.0);
        if (any((switched | slow) & going))
            MODEL(prepare)(m, h, (switched | slow) & going);
        before = worst;
    }
#if LOSSY /* what rounding leaves of the loss, a difference of energies, is booked as it is taken */
    m->rates[m->first[MODEL(heated)]] += m->gap[m->first[MODEL(heated)]];
#endif
    return found;
}

/* The rates in some lanes, with means at as many nodes as they ask for; returns who has them. */
static mask MODEL(solve)(MODEL(block) *m, real h, mask where)
{
    m->fine &= none_of(where);
    const mask found = MODEL(iterate)(m, h, where), more = MODEL(coarse)(m, h) & found;
    if (LOSSY || !any(more))
        return found;
    m->fine |= more;
    return (found & none_of(more)) | MODEL(iterate)(m, h, more);
}
