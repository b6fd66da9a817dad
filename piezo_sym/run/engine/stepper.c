/*
 * Runs of the discrete gradient: steps of Newton's method, root acceptance, halving, the ledger.
 *
 * Compiled behind a generated <model>.c, with MODEL(name) as <model>_name; no model is known here.
 * A root counts only if all is finite, the state after the step lies in the domain and no process
 * takes entropy; otherwise the step is halved.  Energy and entropy then close to round-off.
 */

extern const long MODEL(exchanges);
const long MODEL(exchanges) = MODEL(exchange_count);

enum { MOST_ITERATIONS = 14, MOST_HALVINGS = 40, MOST_SHARES = 60 };
/*
 * So many iterations more after each halving: from beyond the bend of an exponential law Newton's
 * method comes back by its width each time, however short the step.
 */
enum { MORE_ITERATIONS = 8 };
/* A step may be halved so often in all: a run that creeps towards an edge ends, as it has to. */
enum { MOST_PARTS = 1 << 16 };
/* What Newton's method may leave, in 1e-9 of a step: 1e-15 of it, where balances have to close. */
#define EXACT 1e-6
/*
 * A step, in 1e-9 of it.  A state that was expected to move, and does not, is off by more; what that
 * falls to says nothing of how the others converge.
 */
#define WHOLE 1e9
/* No state moves by less than 1e9 times this. */
#define LEAST_SIZE 1e-200
/*
 * What rounding leaves of a state's change, in parts of its largest magnitude, by
 * iteration.  Newton's method ends in two or three; where it does not, the noise of what a state
 * follows from is larger than its own.
 */
static double MODEL(noise)(int iteration)
{
    const double parts[] = {1e-15, 1e-15, 1e-14, 1e-13, 1e-12};
    return parts[iteration < 4 ? iteration : 4];
}

/*
 * A model with its sizes, and room for one step: arrays of n, of change_size and of rows numbers.
 * If a run has dissipative starts, the last two rows are heat and entropy production of their loss.
 */
typedef struct {
    const MODEL(parameters) *p;
    long n, rows, ports, processes, inputs;
    double *space, *largest; /* of n: the largest magnitude of each state so far */
    long iterations, halvings;
    long begun; /* the halvings there were before the step at hand */
    long start; /* whether the steps taken now are dissipative */
} MODEL(model);

/* A state on its way: x[n], its last change and the one before, and the ledger. */
typedef struct {
    double *x, *last, *prior;
    double h, h_prior;
    double *sums, *lost;
} MODEL(path);

/* How many numbers `space` of a model has to hold. */
long MODEL(room)(const MODEL(model) *m);
long MODEL(room)(const MODEL(model) *m)
{
    return 2 * m->n + MODEL(change_size)(m->p) + 3 * m->rows;
}

static double *MODEL(means_of)(const MODEL(model) *m)
{
    return m->space + 2 * m->n + MODEL(change_size)(m->p);
}

/* Remember a path before its step is halved, or go back to it: the state and the ledger. */
static void MODEL(save)(MODEL(model) *m, const MODEL(path) *path)
{
    double *ledger = MODEL(means_of)(m) + m->rows;
    memcpy(m->space + m->n, path->x, (size_t)m->n * sizeof(double));
    for (long k = 0; k < m->rows; ++k)
        ledger[k] = path->sums[k], ledger[m->rows + k] = path->lost[k];
}

static void MODEL(restore)(const MODEL(model) *m, MODEL(path) *path)
{
    const double *ledger = MODEL(means_of)(m) + m->rows;
    memcpy(path->x, m->space + m->n, (size_t)m->n * sizeof(double));
    for (long k = 0; k < m->rows; ++k)
        path->sums[k] = ledger[k], path->lost[k] = ledger[m->rows + k];
    path->h = path->h_prior = 0.0;
}

/* Add h times the means of a step to the ledger, with compensation for what rounding loses. */
static void MODEL(book)(const MODEL(model) *m, const MODEL(path) *path, double h)
{
    const double *restrict means = MODEL(means_of)(m);
    double *restrict sums = path->sums, *restrict lost = path->lost;
    for (long k = 0; k < m->rows; ++k) {
        const double part = h * means[k] - lost[k];
        const double total = sums[k] + part;
        lost[k] = (total - sums[k]) - part;
        sums[k] = total;
    }
}

/*
 * Newton's method for the state y after a step; whether it converged inside the domain.  A change is
 * measured in 1e-9 of the step's.  It stops when the last one was less, or, since its error falls
 * quadratically, when the next one would be EXACT.
 */
static int MODEL(root)(MODEL(model) *m, const double *restrict x, double *restrict y,
                       const double *u, double h, int most_iterations)
{
    double *restrict change = m->space + 2 * m->n;
    double before = 0.0;
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
        double most = 0.0, per = 1.0, all = 0.0, share = 1.0; /* the worst change is most / per */
        const double noise = MODEL(noise)(iteration);
        ++m->iterations;
        if (!MODEL(change)(m->p, m->start, x, y, u, h, change))
            return 0;
        for (long i = 0; i < m->n; ++i) {
            const double after = y[i] - change[i];
            const double size = 1e-9 * fabs(after - x[i]) + noise * (fabs(x[i]) + m->largest[i])
                + LEAST_SIZE;
            const double changed = fabs(change[i]);
            const int less = changed * per <= most * size;
            all += changed;
            most = less ? most : changed;
            per = less ? per : size;
            y[i] = after;
        }
        const double worst = most / per + 0.0 * all; /* no number, if one of them is none */
        if (!(worst < 1e300))
            return 0;
        for (int k = 0; !MODEL(inside)(y, u, m->p); ++k) { /* back towards where it came from */
            if (k == MOST_SHARES)
                return 0;
            share *= 0.5;
            for (long i = 0; i < m->n; ++i)
                y[i] += share * change[i];
        }
        if (share == 1.0 && (worst <= 1.0 || worst * (worst / before) * (worst / before) <= EXACT))
            return 1;
        before = share == 1.0 ? fmin(worst, WHOLE) : 0.0;
    }
    return 0;
}

/* Whether the step from x to y is one of nature's: neither a process nor its loss takes entropy. */
static int MODEL(accepted)(const MODEL(model) *m, const double *x, const double *y, const double *u,
                           double h)
{
    double *means = MODEL(means_of)(m);
    double total = 0.0, least = 0.0;
    MODEL(rates)(m->p, m->start, x, y, u, h, means);
    if (m->start) {
        total = fabs(means[m->rows - 1]);
        least = fmin(means[m->rows - 1], 0.0);
    }
    for (long k = 0; k < m->rows; ++k)
        if (!(fabs(means[k]) < 1e300))
            return 0;
    for (long k = m->ports + m->processes; k < m->ports + 2 * m->processes; ++k) {
        total += fabs(means[k]);
        least = means[k] < least ? means[k] : least;
    }
    return least >= -1e-14 * total;
}

/* Where Newton's method begins: on the parabola through the states before, or the line. */
static void MODEL(predict)(const MODEL(model) *m, const MODEL(path) *path, double h, double *y)
{
    const double per_h = path->h > 0.0 ? 1.0 / path->h : 0.0;
    const double per_prior = path->h_prior > 0.0 ? 1.0 / path->h_prior : 0.0;
    const double bend = per_prior > 0.0 ? h * (h + path->h) / (path->h + path->h_prior) : 0.0;
    const double by_last = (h + bend) * per_h, by_prior = bend * per_prior;
    for (long i = 0; i < m->n; ++i)
        y[i] = path->x[i] + by_last * path->last[i] - by_prior * path->prior[i];
}

/* One step over h, halved where it has to be; 0, and the path as before, if that does not help. */
static int MODEL(step)(MODEL(model) *m, MODEL(path) *path, const double *u, double h, int depth)
{
    double *restrict y = m->space;
    const int most = MOST_ITERATIONS + MORE_ITERATIONS * depth;
    int found = 0;
    MODEL(predict)(m, path, h, y);
    for (int trial = path->h > 0.0 ? 0 : 1; trial < 2 && !found; ++trial) {
        if (trial == 1) /* not from a prediction */
            memcpy(y, path->x, (size_t)m->n * sizeof *y);
        found = MODEL(inside)(y, u, m->p) && MODEL(root)(m, path->x, y, u, h, most) &&
                MODEL(accepted)(m, path->x, y, u, h);
    }
    if (!found) {
        if (depth == 0) {
            m->begun = m->halvings;
            MODEL(save)(m, path);
        }
        if (depth == MOST_HALVINGS || m->halvings - m->begun > MOST_PARTS)
            return 0;
        ++m->halvings;
        found = MODEL(step)(m, path, u, 0.5 * h, depth + 1) &&
                MODEL(step)(m, path, u, 0.5 * h, depth + 1);
        if (!found && depth == 0)
            MODEL(restore)(m, path);
        return found;
    }
    MODEL(book)(m, path, h);
    double *kept = path->prior;
    path->prior = path->last;
    path->last = kept;
    path->h_prior = path->h;
    path->h = h;
    for (long i = 0; i < m->n; ++i) {
        path->last[i] = y[i] - path->x[i];
        path->x[i] = y[i];
        m->largest[i] = fabs(y[i]) > m->largest[i] ? fabs(y[i]) : m->largest[i];
    }
    return 1;
}

/*
 * A start after a jump: one step over h as four dissipative quarters, the inputs of each in u[4].
 * A quarter that has no such step is an ordinary one, halved if need be: where an energy is not
 * convex, a dissipative step takes entropy however short it is.
 */
static int MODEL(quarters)(MODEL(model) *m, MODEL(path) *path, const double *u, double h)
{
    double *loss = MODEL(means_of)(m) + m->rows - 2;
    int found = 1;
    for (int k = 0; k < 4 && found; ++k) {
        m->start = 1;
        found = MODEL(step)(m, path, u + k * m->inputs, 0.25 * h, MOST_HALVINGS);
        m->start = 0;
        loss[0] = loss[1] = 0.0; /* ordinary steps write nothing there */
        found = found || MODEL(step)(m, path, u + k * m->inputs, 0.25 * h, 0);
    }
    return found;
}

/* The step over an interval; a start if there are inputs `first` of its quarters. */
static int MODEL(across)(MODEL(model) *m, MODEL(path) *path, const double *u, double h,
                         const double *first)
{
    return first ? MODEL(quarters)(m, path, first, h) : MODEL(step)(m, path, u, h, 0);
}
