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

/* A model with its sizes, and room for one step: arrays of n, of newton_size and of rows numbers. */
typedef struct {
    const MODEL(parameters) *p;
    long n, rows, ports, processes, inputs;
    double *space;
    long iterations, halvings;
} MODEL(model);

/* A state on its way: x[n], its last change and the one before, and the ledger (or none). */
typedef struct {
    double *x, *last, *prior;
    double h, h_prior;
    double *sums, *lost;
} MODEL(path);

/* How many numbers `space` of a model has to hold. */
long MODEL(room)(const MODEL(model) *m);
long MODEL(room)(const MODEL(model) *m)
{
    return 2 * m->n + MODEL(newton_size)(m->p) + m->rows;
}

static double *MODEL(means_of)(const MODEL(model) *m)
{
    return m->space + 2 * m->n + MODEL(newton_size)(m->p);
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
 * quadratically, when the next one would be 1e-15 of the step's.
 */
static int MODEL(root)(MODEL(model) *m, const double *restrict x, double *restrict y,
                       const double *u, double h)
{
    double *restrict change = m->space + 2 * m->n;
    double before = 0.0;
    for (int iteration = 0; iteration < MOST_ITERATIONS; ++iteration) {
        double worst = 0.0, share = 1.0;
        ++m->iterations;
        if (!MODEL(newton)(x, y, u, h, m->p, change))
            return 0;
        for (long i = 0; i < m->n; ++i) {
            const double after = y[i] - change[i];
            const double size = 1e-9 * fabs(after - x[i]) + 1e-15 * fabs(x[i]) + 1e-300;
            const double ratio = fabs(change[i]) / size;
            worst = ratio <= worst ? worst : ratio; /* and if it is no number */
            y[i] = after;
        }
        if (!(worst < 1e300))
            return 0;
        for (int k = 0; !MODEL(inside)(y, u, m->p); ++k) { /* back towards where it came from */
            if (k == MOST_SHARES)
                return 0;
            share *= 0.5;
            for (long i = 0; i < m->n; ++i)
                y[i] += share * change[i];
        }
        if (share == 1.0 && (worst <= 1.0 || worst * worst * worst <= 1e-6 * before * before))
            return 1;
        before = share == 1.0 ? worst : 0.0;
    }
    return 0;
}

/* Whether the step from x to y is one of nature's: no process takes entropy. */
static int MODEL(accepted)(const MODEL(model) *m, const double *x, const double *y, const double *u)
{
    double *means = MODEL(means_of)(m);
    double total = 0.0, least = 0.0;
    MODEL(means)(x, y, u, m->p, means);
    for (long k = 0; k < m->rows; ++k)
        if (!(fabs(means[k]) < 1e300))
            return 0;
    for (long k = m->ports + m->processes; k < m->ports + 2 * m->processes; ++k) {
        total += fabs(means[k]);
        least = means[k] < least ? means[k] : least;
    }
    return least >= -1e-14 * total;
}

/* Where Newton's method begins: on the parabola through the last steps, if they were alike. */
static void MODEL(predict)(const MODEL(model) *m, const MODEL(path) *path, double h, double *y)
{
    const double line = path->h > 0.0 ? h / path->h : 0.0;
    const double bend = path->h == h && path->h_prior == h ? 1.0 : 0.0;
    for (long i = 0; i < m->n; ++i)
        y[i] = path->x[i] + line * path->last[i] + bend * (path->last[i] - path->prior[i]);
}

/* One step over h, halved where it has to be; 0, and the state as before, if that does not help. */
static int MODEL(step)(MODEL(model) *m, MODEL(path) *path, const double *u, double h, int depth)
{
    double *restrict y = m->space;
    int found = 0;
    MODEL(predict)(m, path, h, y);
    for (int trial = path->h > 0.0 ? 0 : 1; trial < 2 && !found; ++trial) {
        if (trial == 1) /* not from a prediction */
            memcpy(y, path->x, (size_t)m->n * sizeof *y);
        found = MODEL(inside)(y, u, m->p) && MODEL(root)(m, path->x, y, u, h) &&
                MODEL(accepted)(m, path->x, y, u);
    }
    if (!found) {
        double *before = m->space + m->n;
        if (depth == MOST_HALVINGS)
            return 0;
        ++m->halvings;
        if (depth == 0)
            memcpy(before, path->x, (size_t)m->n * sizeof *before);
        found = MODEL(step)(m, path, u, 0.5 * h, depth + 1) &&
                MODEL(step)(m, path, u, 0.5 * h, depth + 1);
        if (!found && depth == 0)
            memcpy(path->x, before, (size_t)m->n * sizeof *before);
        return found;
    }
    if (path->sums)
        MODEL(book)(m, path, h);
    double *kept = path->prior;
    path->prior = path->last;
    path->last = kept;
    path->h_prior = path->h;
    path->h = h;
    for (long i = 0; i < m->n; ++i) {
        path->last[i] = y[i] - path->x[i];
        path->x[i] = y[i];
    }
    return 1;
}

/*
 * One step over each interval: over h[k], the inputs u[k] at its middle.  State and sums after
 * interval k go to row sample[k] of out_x and out_sums, if it is not negative.  Returns the number
 * of intervals done.
 */
long MODEL(run)(MODEL(model) *m, MODEL(path) *path, long intervals, const double *h,
                const double *u, const long *sample, double *out_x, double *out_sums);
long MODEL(run)(MODEL(model) *m, MODEL(path) *path, long intervals, const double *h,
                const double *u, const long *sample, double *out_x, double *out_sums)
{
    for (long k = 0; k < intervals; ++k) {
        if (!MODEL(step)(m, path, u + k * m->inputs, h[k], 0))
            return k;
        if (sample[k] >= 0) {
            memcpy(out_x + sample[k] * m->n, path->x, (size_t)m->n * sizeof(double));
            memcpy(out_sums + sample[k] * m->rows, path->sums, (size_t)m->rows * sizeof(double));
        }
    }
    return intervals;
}

/* Takes equal steps, the inputs at their middles one after another; 0 if one has no solution. */
static int MODEL(across)(MODEL(model) *m, MODEL(path) *path, const double *u, double h, long steps)
{
    for (long k = 0; k < steps; ++k)
        if (!MODEL(step)(m, path, u + k * m->inputs, h, 0))
            return 0;
    return 1;
}

/* How many steps a level has: 1, 2, 3, 4, 6, 8, 12 ...; from 1 on, level + 2 has twice as many. */
static long MODEL(steps_at)(long level)
{
    return level == 0 ? 1 : (2 + (level + 1) % 2) << ((level - 1) / 2);
}

/* Three paths through one mesh: fine, of half the steps, and of half the steps from the fine one. */
typedef struct {
    MODEL(path) fine, coarse, trial;
    double *kept; /* of n and of 2 rows: state and ledger of the fine path before an interval */
    long level;
} MODEL(pair);

static void MODEL(keep)(const MODEL(model) *m, const MODEL(pair) *pair)
{
    memcpy(pair->kept, pair->fine.x, (size_t)m->n * sizeof(double));
    memcpy(pair->kept + m->n, pair->fine.sums, (size_t)m->rows * sizeof(double));
    memcpy(pair->kept + m->n + m->rows, pair->fine.lost, (size_t)m->rows * sizeof(double));
}

static void MODEL(back)(const MODEL(model) *m, MODEL(pair) *pair)
{
    memcpy(pair->fine.x, pair->kept, (size_t)m->n * sizeof(double));
    memcpy(pair->fine.sums, pair->kept + m->n, (size_t)m->rows * sizeof(double));
    memcpy(pair->fine.lost, pair->kept + m->n + m->rows, (size_t)m->rows * sizeof(double));
    pair->fine.h = 0.0;
}

/*
 * Runs a mesh and its halves side by side, each with a state and a balance of its own.  How finely
 * interval k of length h[k] is divided is chosen on the way: so that steps and half steps from the
 * finer state end within three times tolerance[n] of each other.  u[level - lowest] holds, for
 * levels lowest to highest, the inputs at the middles of all steps of all intervals.  After interval
 * k, row sample[k] of out_x, out_fine, out_sums gets the state extrapolated from both paths, the
 * finer one and its ledger.  Returns the number of intervals done: less than all if one needs a
 * level that is not there (failed = 0) or a step has no solution (failed = 1).
 */
long MODEL(adapt)(MODEL(model) *m, MODEL(pair) *pair, long intervals, const double *h,
                  const double *const *u, long lowest, long highest, const double *tolerance,
                  const long *sample, double *out_x, double *out_fine, double *out_sums,
                  long *taken, int *failed);
long MODEL(adapt)(MODEL(model) *m, MODEL(pair) *pair, long intervals, const double *h,
                  const double *const *u, long lowest, long highest, const double *tolerance,
                  const long *sample, double *out_x, double *out_fine, double *out_sums,
                  long *taken, int *failed)
{
    *failed = 0;
    for (long k = 0; k < intervals; ++k) {
        double worst = 0.0;
        MODEL(keep)(m, pair);
        for (;; ++pair->level, MODEL(back)(m, pair)) {
            const long level = pair->level, finer = level ? level + 2 : 1;
            const long steps = MODEL(steps_at)(level);
            if (level < lowest || finer > highest)
                return k;
            const double *at = u[level - lowest] + m->inputs * steps * k;
            const double *twice = u[finer - lowest] + m->inputs * 2 * steps * k;
            const double length = h[k] / (double)steps;
            memcpy(pair->trial.x, pair->kept, (size_t)m->n * sizeof(double));
            *failed = !MODEL(across)(m, &pair->trial, at, length, steps) ||
                      !MODEL(across)(m, &pair->fine, twice, 0.5 * length, 2 * steps);
            *taken += 3 * steps;
            if (*failed) {
                MODEL(back)(m, pair);
                return k;
            }
            worst = 0.0;
            for (long i = 0; i < m->n; ++i) {
                const double ratio = fabs(pair->fine.x[i] - pair->trial.x[i]) / (3.0 * tolerance[i]);
                worst = ratio <= worst ? worst : ratio;
            }
            if (!(worst <= 1.0))
                continue;
            *taken += steps;
            *failed = !MODEL(across)(m, &pair->coarse, at, length, steps);
            if (*failed)
                return k;
            break;
        }
        if (sample[k] >= 0) {
            double *restrict best = out_x + sample[k] * m->n, *fine = pair->fine.x;
            for (long i = 0; i < m->n; ++i)
                best[i] = fine[i] + (fine[i] - pair->coarse.x[i]) / 3.0;
            memcpy(out_fine + sample[k] * m->n, fine, (size_t)m->n * sizeof(double));
            memcpy(out_sums + sample[k] * m->rows, pair->fine.sums, (size_t)m->rows * sizeof(double));
        }
        if (worst < 0.05 && pair->level > 0) /* half as many steps and more give 2.25 times that */
            --pair->level;
    }
    return intervals;
}

/* One step at a time, for a caller who decides the inputs: all that a call needs, in one place. */
typedef struct {
    MODEL(model) model;
    MODEL(path) path;
    double *u, *y;
    double h;
} MODEL(stepper);

/* Takes a step over h with the inputs u, and writes the outputs after it; 0 if there is none. */
int MODEL(tick)(MODEL(stepper) *t);
int MODEL(tick)(MODEL(stepper) *t)
{
    if (!MODEL(step)(&t->model, &t->path, t->u, t->h, 0))
        return 0;
    MODEL(outputs)(t->path.x, t->u, t->model.p, t->y);
    return 1;
}
