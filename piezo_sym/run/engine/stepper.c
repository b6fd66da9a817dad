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

/* What a run needs beside the model: sizes, and arrays of n and of ledger rows. */
typedef struct {
    long n, rows, ports, processes;
    double *after, *change, *means, *sums, *lost;
    long halvings, iterations;
    int booked;
} MODEL(space);

/* Add h times the means of a step to the ledger, with compensation for what rounding loses. */
static void MODEL(book)(MODEL(space) *s, double h)
{
    for (long k = 0; k < s->rows; ++k) {
        const double part = h * s->means[k] - s->lost[k];
        const double total = s->sums[k] + part;
        s->lost[k] = (total - s->sums[k]) - part;
        s->sums[k] = total;
    }
}

/* Newton's method from s->after; whether it converged inside the domain. */
static int MODEL(root)(MODEL(space) *s, const double *x, const double *u, double h,
                       const MODEL(parameters) *p)
{
    double *y = s->after, *change = s->change;
    for (int iteration = 0; iteration < MOST_ITERATIONS; ++iteration) {
        double worst = 0.0, share = 1.0;
        ++s->iterations;
        if (!MODEL(newton)(x, y, u, h, p, change))
            return 0;
        for (long i = 0; i < s->n; ++i) {
            const double size = 1e-9 * fabs(y[i] - change[i] - x[i]) + 1e-15 * fabs(x[i]) + 1e-300;
            const double ratio = fabs(change[i]) / size;
            worst = ratio <= worst ? worst : ratio; /* and if it is no number */
            y[i] -= change[i];
        }
        if (!(worst < 1e300))
            return 0;
        for (int k = 0; !MODEL(inside)(y, u, p); ++k) { /* back towards where it came from */
            if (k == MOST_SHARES)
                return 0;
            share *= 0.5;
            for (long i = 0; i < s->n; ++i)
                y[i] += share * change[i];
        }
        if (worst <= 1.0 && share == 1.0)
            return 1;
    }
    return 0;
}

/* Whether the step from x to s->after is one of nature's: no process takes entropy. */
static int MODEL(accepted)(MODEL(space) *s, const double *x, const double *u,
                           const MODEL(parameters) *p)
{
    double total = 0.0, least = 0.0;
    MODEL(means)(x, s->after, u, p, s->means);
    for (long k = 0; k < s->rows; ++k)
        if (!(fabs(s->means[k]) < 1e300))
            return 0;
    for (long k = s->ports + s->processes; k < s->ports + 2 * s->processes; ++k) {
        total += fabs(s->means[k]);
        least = s->means[k] < least ? s->means[k] : least;
    }
    return least >= -1e-14 * total;
}

/* One step over h, halved where it has to be; 0 where that does not help. */
static int MODEL(step)(MODEL(space) *s, double *x, const double *u, double h,
                       const MODEL(parameters) *p, int depth)
{
    for (long i = 0; i < s->n; ++i)
        s->after[i] = x[i];
    if (MODEL(root)(s, x, u, h, p) && MODEL(accepted)(s, x, u, p)) {
        if (s->booked)
            MODEL(book)(s, h);
        for (long i = 0; i < s->n; ++i)
            x[i] = s->after[i];
        return 1;
    }
    if (depth == MOST_HALVINGS)
        return 0;
    ++s->halvings;
    return MODEL(step)(s, x, u, 0.5 * h, p, depth + 1) && MODEL(step)(s, x, u, 0.5 * h, p, depth + 1);
}

/*
 * Steps through intervals: interval k has steps[k] steps of h[k]; u holds the inputs at the middle of
 * each step, one after another.  x[n] is the state, before and after; `ledger` holds rows sums, then
 * rows compensations; states and sums after each interval go to out_x and out_sums.  `space` has room
 * for 2 n + rows numbers.  Returns the number of intervals done; counts[0], counts[1] are the halvings
 * and iterations, counts[2] the steps done in the interval that failed.
 */
long MODEL(run)(long intervals, const long *steps, const double *h, const double *u, long inputs,
                const MODEL(parameters) *p, double *x, double *ledger, double *out_x,
                double *out_sums, double *space, long n, long rows, long ports, long processes,
                long *counts);
long MODEL(run)(long intervals, const long *steps, const double *h, const double *u, long inputs,
                const MODEL(parameters) *p, double *x, double *ledger, double *out_x,
                double *out_sums, double *space, long n, long rows, long ports, long processes,
                long *counts)
{
    MODEL(space) s = {.n = n, .rows = rows, .ports = ports, .processes = processes};
    s.booked = 1;
    s.after = space;
    s.change = space + n;
    s.means = space + 2 * n;
    s.sums = ledger;
    s.lost = ledger + rows;
    long done = 0;
    counts[2] = 0;
    for (; done < intervals; ++done) {
        for (long k = 0; k < steps[done]; ++k, u += inputs) {
            if (!MODEL(step)(&s, x, u, h[done], p, 0)) {
                counts[2] = k;
                goto end;
            }
        }
        for (long i = 0; i < n; ++i)
            out_x[done * n + i] = x[i];
        for (long k = 0; k < rows; ++k)
            out_sums[done * rows + k] = s.sums[k];
    }
end:
    counts[0] += s.halvings;
    counts[1] += s.iterations;
    return done;
}

/* Steps from x to y: 2^level of them over h, the inputs at their middles one after another. */
static int MODEL(across)(MODEL(space) *s, const double *x, double *y, const double *u, long inputs,
                         double h, int level, const MODEL(parameters) *p)
{
    const long steps = 1L << level;
    for (long i = 0; i < s->n; ++i)
        y[i] = x[i];
    for (long k = 0; k < steps; ++k)
        if (!MODEL(step)(s, y, u + k * inputs, h / (double)steps, p, 0))
            return 0;
    return 1;
}

/*
 * Chooses for each interval how often it is halved: levels[k], so that 2^levels[k] steps and twice as
 * many end within three times tolerance[n] of each other, from the same state.  u holds, for each
 * level up to `deepest`, the inputs at the middles of all steps of all intervals; h the lengths of the
 * intervals.  x goes from interval to interval, extrapolated.  `space` has room for 5 n + rows
 * numbers; levels[0] is where to begin.  Returns the number of intervals done: less than all, if one
 * needs a deeper level (failed = 0) or has no solution (failed = 1).
 */
long MODEL(plan)(long intervals, int deepest, const double *h, const double *u, long inputs,
                 const MODEL(parameters) *p, double *x, const double *tolerance, int *levels,
                 double *space, long n, long rows, long ports, long processes, int *failed);
long MODEL(plan)(long intervals, int deepest, const double *h, const double *u, long inputs,
                 const MODEL(parameters) *p, double *x, const double *tolerance, int *levels,
                 double *space, long n, long rows, long ports, long processes, int *failed)
{
    MODEL(space) s = {.n = n, .rows = rows, .ports = ports, .processes = processes};
    double *coarse = space + 2 * n + rows, *fine = coarse + n;
    int level = levels[0];
    s.after = space;
    s.change = space + n;
    s.means = space + 2 * n;
    *failed = 0;
    for (long k = 0; k < intervals; ++k) {
        for (int known = 0;; ++level) {
            double worst = 0.0;
            if (level + 1 > deepest)
                return k;
            const double *at = u + inputs * (intervals * ((1L << level) - 1) + (k << level));
            const double *next = u + inputs * (intervals * ((2L << level) - 1) + (k << (level + 1)));
            if (!(known || MODEL(across)(&s, x, coarse, at, inputs, h[k], level, p)) ||
                !MODEL(across)(&s, x, fine, next, inputs, h[k], level + 1, p)) {
                *failed = 1;
                return k;
            }
            for (long i = 0; i < n; ++i) {
                const double ratio = fabs(fine[i] - coarse[i]) / (3.0 * tolerance[i]);
                worst = ratio <= worst ? worst : ratio;
            }
            if (worst <= 1.0) {
                for (long i = 0; i < n; ++i)
                    x[i] = fine[i] + (fine[i] - coarse[i]) / 3.0;
                levels[k] = level;
                level = worst < 0.05 && level > 0 ? level - 1 : level;
                break;
            }
            known = 1;
            double *swap = coarse;
            coarse = fine;
            fine = swap;
        }
    }
    return intervals;
}

/* One step at a time, for a caller who decides the inputs: all that a call needs, in one place. */
typedef struct {
    const MODEL(parameters) *p;
    double *x, *u, *y, *space;
    double h;
    long n, rows, ports, processes;
} MODEL(stepper);

/* Takes a step over h with the inputs u, and writes the outputs after it; 0 if there is none. */
int MODEL(tick)(const MODEL(stepper) *t);
int MODEL(tick)(const MODEL(stepper) *t)
{
    MODEL(space) s = {.n = t->n, .rows = t->rows, .ports = t->ports, .processes = t->processes};
    s.after = t->space;
    s.change = t->space + t->n;
    s.means = t->space + 2 * t->n;
    if (!MODEL(step)(&s, t->x, t->u, t->h, t->p, 0))
        return 0;
    MODEL(outputs)(t->x, t->u, t->p, t->y);
    return 1;
}
