/*
 * Steps side by side: each lane of a vector takes those of one member.  What stepper.c does for one,
 * with masks: which lanes' steps did not converge, or are not accepted, is told.  Behind wide.h and
 * the model's step for vectors; seats.c and fleet.c say whose the lanes are, and what they do.
 */

/* How many paths a lane may have. */
enum { SLOTS = 3 };

/* Where a path of each lane is: state, last changes, their steps. */
typedef struct {
    real *x, *last, *prior, since, before;
} MODEL(wide_path);

/* What all lanes compute with: paths, ledgers, what is kept of an interval, room for one step. */
typedef struct {
    MODEL(wide_parameters) p;
    const double *next[WIDTH]; /* each lane's inputs of its next step; of an idle lane, any */
    long n, rows, ports, processes, inputs;
    MODEL(wide_path) path[SLOTS];
    mask on[SLOTS], books; /* which lanes are on a path, and which book what their steps do */
    mask good, tries;      /* whose last steps are accepted; iterations of Newton's method so far */
    real h, enough;        /* the steps, and what Newton's method may leave of them */
    real *sums, *lost, *kept[SLOTS], *kept_sums, *kept_lost;
    real *from, *y, *u, *change, *per, *means, *largest;
    real *expected, *allowed, surprise; /* of the fine paths and the trial ones: see stepper.c */
    int adapts; /* whether steps are compared with what was expected */
} MODEL(wide);

/* How many vectors it takes to compute with. */
static long MODEL(wide_numbers)(const MODEL(model) *m)
{
    const long paths = SLOTS * 4 * m->n, step = 6 * m->n + m->inputs + MODEL(newton_size)(m->p);
    return MODEL(wide_room)(m->p) + paths + step + 5 * m->rows;
}

static void MODEL(wide_places)(MODEL(wide) *w, const MODEL(model) *m, real *space)
{
    const long n = w->n = m->n, rows = w->rows = m->rows;
    real *at = space + MODEL(wide_room)(m->p);
    w->ports = m->ports, w->processes = m->processes, w->inputs = m->inputs;
    w->h = wide(1.0), w->enough = wide(EXACT);
    MODEL(wide_place)(&w->p, m->p, space);
    for (int k = 0; k < SLOTS; ++k, at += 4 * n) {
        MODEL(wide_path) *path = &w->path[k];
        path->x = at, path->last = at + n, path->prior = at + 2 * n, w->kept[k] = at + 3 * n;
        path->since = path->before = zero;
    }
    w->from = at, w->y = w->from + n, w->u = w->y + n, w->change = w->u + m->inputs;
    w->per = w->change + MODEL(newton_size)(m->p), w->largest = w->per + n;
    w->expected = w->largest + n, w->allowed = w->expected + n, w->means = w->allowed + n;
    w->sums = w->means + rows, w->lost = w->sums + rows;
    w->kept_sums = w->lost + rows, w->kept_lost = w->kept_sums + rows;
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

/* The state before each lane's step, and the prediction of that after it: a parabola's. */
static void MODEL(predictions)(MODEL(wide) *w)
{
    const MODEL(wide_path) path[SLOTS] = {w->path[0], w->path[1], w->path[2]};
    const mask on[SLOTS] = {w->on[0], w->on[1], w->on[2]};
    const int used[SLOTS] = {1, any(on[1]), any(on[2])};
    real since = path[0].since, before = path[0].before;
    real *from = w->from, *y = w->y, *expected = w->expected;
    for (int k = 1; k < SLOTS; ++k) {
        since = chosen(on[k], path[k].since, since);
        before = chosen(on[k], path[k].before, before);
    }
    const real slope = chosen(before > 0.0, w->h + since, zero) / (since + before + LEAST_SIZE);
    const real by_last = chosen(since > 0.0, w->h * (1.0 + slope) / since, zero);
    const real by_prior = chosen(before > 0.0, w->h * slope / before, zero);
    for (long i = 0, n = w->n; i < n; ++i) {
        real x = path[0].x[i], last = path[0].last[i], prior = path[0].prior[i];
        for (int k = 1; k < SLOTS; ++k) {
            if (!used[k])
                continue;
            x = chosen(on[k], path[k].x[i], x);
            last = chosen(on[k], path[k].last[i], last);
            prior = chosen(on[k], path[k].prior[i], prior);
        }
        from[i] = x;
        y[i] = expected[i] = x + by_last * last - by_prior * prior;
    }
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
    const real *from = w->from, *change = w->change, *largest = w->largest;
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
    MODEL(copy)(~in, w->from, w->y, w->n);
    for (int iteration = 0; iteration < MOST_ITERATIONS && any(going); ++iteration) {
        const mask solved = MODEL(wide_newton)(w->from, w->y, w->u, w->h, &w->p, w->change);
        const real left = MODEL(corrected)(w, going, iteration, before);
        const real cube = left * left * left, room = w->enough * before * before;
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
    MODEL(wide_means)(w->from, w->y, w->u, &w->p, w->means);
    for (long k = 0; k < rows; ++k)
        all += size_of(means[k]);
    for (long k = 0; k < processes; ++k) {
        total += size_of(produced[k]);
        low = chosen(produced[k] < low, produced[k], low);
    }
    return (all < 1e300) & (low >= -1e-14 * total);
}

/* Compare the states after steps of the fine paths and the trial ones with what was expected. */
static void MODEL(compare_wide)(MODEL(wide) *w, mask good)
{
    const real *y = w->y, *expected = w->expected, *allowed = w->allowed;
    real worst = w->surprise;
    for (long i = 0, n = w->n; i < n; ++i) {
        const real missed = size_of(y[i] - expected[i]) * allowed[i];
        worst = chosen(missed > worst, missed, worst);
    }
    w->surprise = chosen(good & w->on[0] & (w->path[0].before > 0.0), worst, w->surprise);
}

/* The lanes in `good` move on along a path. */
static void MODEL(move)(const MODEL(wide) *w, MODEL(wide_path) *path, mask good)
{
    const real *from = w->from, *y = w->y;
    real *x = path->x, *last = path->last, *prior = path->prior;
    for (long i = 0, n = w->n; i < n; ++i) {
        prior[i] = chosen(good, last[i], prior[i]);
        last[i] = chosen(good, y[i] - from[i], last[i]);
        x[i] = chosen(good, y[i], x[i]);
    }
    path->before = chosen(good, path->since, path->before);
    path->since = chosen(good, w->h, path->since);
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

/* Take the steps of the lanes in `good`: states, changes, and the ledger of those that book. */
static void MODEL(commit)(MODEL(wide) *w, mask good)
{
    const real *y = w->y;
    real *largest = w->largest;
    for (long i = 0, n = w->n; i < n; ++i) {
        const real size = size_of(y[i]);
        largest[i] = chosen(good & (size > largest[i]), size, largest[i]);
    }
    if (w->adapts)
        MODEL(compare_wide)(w, good);
    for (int k = 0; k < SLOTS; ++k)
        if (any(good & w->on[k]))
            MODEL(move)(w, &w->path[k], good & w->on[k]);
    if (any(good & w->books))
        MODEL(book_wide)(w, good & w->books);
}

/* A step in all lanes that are on a path; `good` are those that made it.  0 if there are none. */
static int MODEL(advance)(MODEL(wide) *w)
{
    const mask going = w->on[0] | w->on[1] | w->on[2];
    if (!any(going))
        return 0;
    for (long i = 0; i < w->inputs; ++i)
        w->u[i] = gathered(w->next, i);
    MODEL(predictions)(w);
    MODEL(wide_begin)(w->from, &w->p);
    const mask found = MODEL(roots)(w, going);
    w->good = found & MODEL(natural)(w);
    MODEL(commit)(w, w->good);
    return 1;
}
