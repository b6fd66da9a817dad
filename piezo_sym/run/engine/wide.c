/*
 * Steps side by side: each lane of a vector takes those of one member.  What stepper.c does for one,
 * with masks: which lanes' steps did not converge, or are not accepted, is told.  Behind wide.h and
 * the model's step for vectors; fleet.c says whose the lanes are.
 */

/*
 * What all lanes compute with: states and their last changes, over `since` and `before`; ledgers,
 * and room for one step.
 */
typedef struct {
    MODEL(wide_parameters) p;
    const double *next[WIDTH]; /* each lane's inputs of its next step; of an idle lane, any */
    long n, rows, ports, processes, inputs;
    mask on, good, tries; /* who steps; whose last step is accepted; iterations so far */
    real h, since, before;
    real *x, *last, *prior, *sums, *lost;
    real *y, *u, *change, *per, *means, *largest;
} MODEL(wide);

/* How many vectors it takes to compute with. */
static long MODEL(wide_numbers)(const MODEL(model) *m)
{
    const long step = 6 * m->n + m->inputs + MODEL(newton_size)(m->p);
    return MODEL(wide_room)(m->p) + step + 3 * m->rows;
}

static void MODEL(wide_places)(MODEL(wide) *w, const MODEL(model) *m, real *space)
{
    const long n = w->n = m->n, rows = w->rows = m->rows;
    w->ports = m->ports, w->processes = m->processes, w->inputs = m->inputs;
    w->h = wide(1.0);
    MODEL(wide_place)(&w->p, m->p, space);
    w->x = space + MODEL(wide_room)(m->p), w->last = w->x + n, w->prior = w->last + n;
    w->y = w->prior + n, w->per = w->y + n, w->largest = w->per + n;
    w->u = w->largest + n, w->change = w->u + m->inputs;
    w->means = w->change + MODEL(newton_size)(m->p);
    w->sums = w->means + rows, w->lost = w->sums + rows;
}

static void MODEL(put)(real *to, const double *from, long n, int lane)
{
    for (long i = 0; i < n; ++i)
        to[i][lane] = from[i];
}

static void MODEL(take)(const real *from, double *to, long n, int lane)
{
    for (long i = 0; i < n; ++i)
        to[i] = from[i][lane];
}

/* Copy the numbers of some lanes. */
static void MODEL(copy)(mask where, const real *from, real *to, long n)
{
    for (long i = 0; i < n; ++i)
        to[i] = chosen(where, from[i], to[i]);
}

/* The prediction of the state after each lane's step: a parabola's. */
static void MODEL(predictions)(MODEL(wide) *w)
{
    const real since = w->since, before = w->before;
    const real slope = chosen(before > 0.0, w->h + since, zero) / (since + before + LEAST_SIZE);
    const real by_last = chosen(since > 0.0, w->h * (1.0 + slope) / since, zero);
    const real by_prior = chosen(before > 0.0, w->h * slope / before, zero);
    for (long i = 0, n = w->n; i < n; ++i)
        w->y[i] = w->x[i] + by_last * w->last[i] - by_prior * w->prior[i];
}

/*
 * The changes of an iteration, taken off y in lanes of `going`; returns their sum, each in 1e-9 of
 * what its state moves in the step.  How much that is, is seen in all iterations but the second,
 * unless the first one changed more than a tenth of it.
 */
static real MODEL(corrected)(MODEL(wide) *w, mask going, int iteration, real before)
{
    const int measured = iteration != 1 || any(going & ~(before < 1e8));
    const double noise = MODEL(noise)(iteration);
    const real *from = w->x, *change = w->change, *largest = w->largest;
    real *y = w->y, *per = w->per, sum = zero;
    for (long i = 0, n = w->n; i < n; ++i) {
        const real x = from[i], after = y[i] - change[i];
        if (measured)
            per[i] = about_per(1e-9 * size_of(after - x)
                               + noise * (size_of(x) + largest[i]) + LEAST_SIZE);
        sum += size_of(change[i]) * per[i];
        y[i] = chosen(going, after, y[i]);
    }
    return sum; /* no number, if one of them is none */
}

/*
 * Newton's method in all lanes of `going`; returns those in which it converged in the domain.  Where
 * a state is beyond all numbers, what is left is negative, or no number.
 */
static mask MODEL(roots)(MODEL(wide) *w, mask going)
{
    mask found = nowhere;
    real before = zero;
    const mask in = MODEL(wide_inside)(w->y, w->u, &w->p);
    MODEL(copy)(~in, w->x, w->y, w->n);
    for (int iteration = 0; iteration < MOST_ITERATIONS && any(going); ++iteration) {
        const mask solved = MODEL(wide_newton)(w->x, w->y, w->u, w->h, &w->p, w->change);
        const real left = MODEL(corrected)(w, going, iteration, before);
        const real cube = left * left * left, room = EXACT * before * before;
        w->tries -= going;
        going &= solved & (left >= 0.0) & (left < 1e100) & MODEL(wide_inside)(w->y, w->u, &w->p);
        const mask last = going & ((left <= 1.0) | (cube <= room));
        found |= last;
        going &= ~last;
        before = chosen(left < WHOLE, left, wide(WHOLE));
    }
    return found;
}

/* Whether each lane's step is one of nature's: all finite, and no process takes entropy. */
static mask MODEL(natural)(MODEL(wide) *w)
{
    const real *means = w->means, *produced = means + w->ports + w->processes;
    const long rows = w->rows, processes = w->processes;
    real all = zero, total = zero, low = zero;
    MODEL(wide_means)(w->x, w->y, w->u, &w->p, w->means);
    for (long k = 0; k < rows; ++k)
        all += size_of(means[k]);
    for (long k = 0; k < processes; ++k) {
        total += size_of(produced[k]);
        low = chosen(produced[k] < low, produced[k], low);
    }
    return (all < 1e300) & (low >= -1e-14 * total);
}

/* Book the means of a step in the ledgers of the lanes in `good`. */
static void MODEL(book_wide)(const MODEL(wide) *w, mask good)
{
    const real *means = w->means, h = w->h;
    real *sums = w->sums, *lost = w->lost;
    for (long k = 0, rows = w->rows; k < rows; ++k) {
        const real part = h * means[k] - lost[k], total = sums[k] + part;
        lost[k] = chosen(good, (total - sums[k]) - part, lost[k]);
        sums[k] = chosen(good, total, sums[k]);
    }
}

/* Take the steps of the lanes in `good`: states, changes, ledgers. */
static void MODEL(commit)(MODEL(wide) *w, mask good)
{
    real *x = w->x, *last = w->last, *prior = w->prior, *largest = w->largest;
    const real *y = w->y;
    MODEL(book_wide)(w, good);
    for (long i = 0, n = w->n; i < n; ++i) {
        const real size = size_of(y[i]);
        largest[i] = chosen(good & (size > largest[i]), size, largest[i]);
        prior[i] = chosen(good, last[i], prior[i]);
        last[i] = chosen(good, y[i] - x[i], last[i]);
        x[i] = chosen(good, y[i], x[i]);
    }
    w->before = chosen(good, w->since, w->before);
    w->since = chosen(good, w->h, w->since);
}

/* A step in all lanes that have a member; `good` are those that made it.  0 if there are none. */
static int MODEL(advance)(MODEL(wide) *w)
{
    if (!any(w->on))
        return 0;
    for (long i = 0; i < w->inputs; ++i)
        w->u[i] = gathered(w->next, i);
    MODEL(predictions)(w);
    MODEL(wide_begin)(w->x, &w->p);
    const mask found = MODEL(roots)(w, w->on);
    w->good = found & MODEL(natural)(w);
    MODEL(commit)(w, w->good);
    return 1;
}
