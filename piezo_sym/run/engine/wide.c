/*
 * Members side by side: each lane of a vector takes the steps of one member, and goes on with the next
 * member when it is done.  What stepper.c does for one, with masks: a lane whose step does not
 * converge, or is not accepted, is left to stepper.c, which halves it.
 */

enum { FINE, COARSE, TRIAL, PATHS };
enum { SURVEY, MARCH, ADAPT };

/* One lane: its member (or none), the path it is on, the steps left of it, and the next one. */
typedef struct {
    MODEL(member) *s;
    int path;
    long left;
    const double *u;
    double h;
} MODEL(lane);

/* What all lanes compute with: states and last changes of each path, and room for one step. */
typedef struct {
    MODEL(wide_parameters) p;
    MODEL(lane) lane[WIDTH];
    long n, rows, ports, processes, inputs;
    real *x[PATHS], *last[PATHS], *prior[PATHS], since[PATHS], before[PATHS];
    real *from, *y, *u, *change, *means, *sums, *lost;
    int mode;
    const MODEL(block) *b;
} MODEL(wide);

extern const long MODEL(width);
const long MODEL(width) = WIDTH;

static long MODEL(wide_places)(MODEL(wide) *w, const MODEL(model) *m, real *space)
{
    real *at = space;
    w->n = m->n, w->rows = m->rows, w->ports = m->ports, w->processes = m->processes;
    w->inputs = m->inputs;
    MODEL(wide_place)(&w->p, m->p, at);
    at += MODEL(wide_room)(m->p);
    for (int k = 0; k < PATHS; ++k) {
        w->x[k] = at, w->last[k] = at + m->n, w->prior[k] = at + 2 * m->n;
        at += 3 * m->n;
        w->since[k] = w->before[k] = zero;
    }
    w->from = at, w->y = w->from + m->n, w->u = w->y + m->n, w->change = w->u + m->inputs;
    w->means = w->change + MODEL(newton_size)(m->p);
    w->sums = w->means + m->rows, w->lost = w->sums + m->rows;
    return w->lost + m->rows - space;
}

/* How many vectors `space` of the functions below has to hold. */
long MODEL(wide_size)(const MODEL(model) *m);
long MODEL(wide_size)(const MODEL(model) *m)
{
    MODEL(wide) w;
    return MODEL(wide_places)(&w, m, 0);
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

static MODEL(path) *MODEL(path_of)(MODEL(member) *s, int path)
{
    return path == FINE ? &s->fine : path == COARSE ? &s->coarse : &s->trial;
}

static void MODEL(put_path)(MODEL(wide) *w, int lane, int path)
{
    const MODEL(path) *of = MODEL(path_of)(w->lane[lane].s, path);
    MODEL(put)(w->x[path], of->x, w->n, lane);
    MODEL(put)(w->last[path], of->last, w->n, lane);
    MODEL(put)(w->prior[path], of->prior, w->n, lane);
    w->since[path][lane] = of->h;
    w->before[path][lane] = of->h_prior;
    if (path == FINE) {
        MODEL(put)(w->sums, of->sums, w->rows, lane);
        MODEL(put)(w->lost, of->lost, w->rows, lane);
    }
}

static void MODEL(take_path)(const MODEL(wide) *w, int lane, int path)
{
    MODEL(path) *of = MODEL(path_of)(w->lane[lane].s, path);
    MODEL(take)(w->x[path], of->x, w->n, lane);
    MODEL(take)(w->last[path], of->last, w->n, lane);
    MODEL(take)(w->prior[path], of->prior, w->n, lane);
    of->h = w->since[path][lane];
    of->h_prior = w->before[path][lane];
    if (path == FINE) {
        MODEL(take)(w->sums, of->sums, w->rows, lane);
        MODEL(take)(w->lost, of->lost, w->rows, lane);
    }
}

/* Where and how a lane's next path goes: its steps, their length, their inputs. */
static void MODEL(go)(MODEL(wide) *w, MODEL(lane) *lane, int path)
{
    const MODEL(member) *s = lane->s;
    const long level = w->mode == ADAPT ? s->level : 0;
    const long finer = level ? level + 2 : 1;
    const long at = path == FINE && w->mode == ADAPT ? finer : level;
    lane->path = path;
    lane->left = MODEL(steps_at)(at);
    lane->h = w->b->h[s->done] / (double)lane->left;
    lane->u = w->b->u[at - w->b->lowest] + w->inputs * lane->left * s->done;
}

/* Begin the next interval of a lane's member; 0 if there is none. */
static int MODEL(begin)(MODEL(wide) *w, int k)
{
    MODEL(lane) *lane = &w->lane[k];
    MODEL(member) *s = lane->s;
    const size_t n = (size_t)w->n, rows = (size_t)w->rows;
    if (s->failed || s->done >= w->b->intervals)
        return 0;
    if (w->mode != ADAPT) {
        MODEL(go)(w, lane, w->mode == SURVEY ? TRIAL : FINE);
        return 1;
    }
    if (s->level < w->b->lowest || (s->level ? s->level + 2 : 1) > w->b->highest)
        return 0;
    MODEL(take)(w->x[FINE], s->kept, w->n, k);
    MODEL(take)(w->sums, s->kept + n, w->rows, k);
    MODEL(take)(w->lost, s->kept + n + rows, w->rows, k);
    MODEL(put)(w->x[TRIAL], s->kept, w->n, k);
    MODEL(go)(w, lane, TRIAL);
    return 1;
}

/* The fine path of a lane goes back to where its interval began. */
static void MODEL(undo)(MODEL(wide) *w, int k)
{
    const double *kept = w->lane[k].s->kept;
    MODEL(put)(w->x[FINE], kept, w->n, k);
    MODEL(put)(w->sums, kept + w->n, w->rows, k);
    MODEL(put)(w->lost, kept + w->n + w->rows, w->rows, k);
    w->since[FINE][k] = 0.0;
}

/* How far steps and half steps of a lane are apart, in three times the tolerance. */
static double MODEL(apart)(const MODEL(wide) *w, int k)
{
    const double *tolerance = w->lane[k].s->tolerance;
    double worst = 0.0;
    for (long i = 0; i < w->n; ++i) {
        const double ratio = fabs(w->x[FINE][i][k] - w->x[TRIAL][i][k]) / (3.0 * tolerance[i]);
        worst = ratio <= worst ? worst : ratio;
    }
    return worst;
}

/* The last step of a lane's path is done: what comes next; 0 if its member is done here. */
static int MODEL(next)(MODEL(wide) *w, int k)
{
    MODEL(lane) *lane = &w->lane[k];
    MODEL(member) *s = lane->s;
    const long row = w->b->sample[s->done];
    if (w->mode == SURVEY) {
        for (long i = 0; i < w->n; ++i)
            s->tolerance[i] = fmax(s->tolerance[i], fabs(w->x[TRIAL][i][k]));
    } else if (w->mode == MARCH && row >= 0) {
        MODEL(take)(w->x[FINE], s->out_x + row * w->n, w->n, k);
        MODEL(take)(w->sums, s->out_sums + row * w->rows, w->rows, k);
    } else if (w->mode == ADAPT && lane->path == TRIAL) {
        MODEL(go)(w, lane, FINE);
        return 1;
    } else if (w->mode == ADAPT && lane->path == FINE) {
        s->worst = MODEL(apart)(w, k);
        if (s->worst <= 1.0) {
            MODEL(go)(w, lane, COARSE);
            return 1;
        }
        MODEL(undo)(w, k);
        ++s->level;
        return MODEL(begin)(w, k);
    } else if (w->mode == ADAPT) {
        if (row >= 0) {
            MODEL(take_path)(w, k, FINE);
            MODEL(take)(w->x[COARSE], s->coarse.x, w->n, k);
            MODEL(write)(s, row);
        }
        if (s->worst < MUCH_TOO_FINE && s->level > 0)
            --s->level;
    }
    ++s->done;
    return MODEL(begin)(w, k);
}

/* The state before each lane's step, and the prediction of that after it. */
static void MODEL(predictions)(MODEL(wide) *w, const mask *on, real h)
{
    for (int k = 0; k < PATHS; ++k) {
        if (!any(on[k]))
            continue;
        const real line = chosen(w->since[k] > 0.0, h / w->since[k], zero);
        const mask alike = (w->since[k] == h) & (w->before[k] == h);
        for (long i = 0; i < w->n; ++i) {
            const real x = w->x[k][i], last = w->last[k][i];
            const real bend = chosen(alike, last - w->prior[k][i], zero);
            w->from[i] = chosen(on[k], x, w->from[i]);
            w->y[i] = chosen(on[k], x + line * last + bend, w->y[i]);
        }
    }
}

/* Newton's method in all lanes of `going`; returns those in which it converged in the domain. */
static mask MODEL(roots)(MODEL(wide) *w, mask going, real h)
{
    mask found = nowhere;
    real before = zero;
    const mask in = MODEL(wide_inside)(w->y, w->u, &w->p);
    for (long i = 0; i < w->n; ++i)
        w->y[i] = chosen(in, w->y[i], w->from[i]);
    for (int iteration = 0; iteration < MOST_ITERATIONS && any(going); ++iteration) {
        real worst = zero;
        const mask solved = MODEL(wide_newton)(w->from, w->y, w->u, h, &w->p, w->change);
        for (long i = 0; i < w->n; ++i) {
            const real x = w->from[i], after = w->y[i] - w->change[i];
            const real size = 1e-9 * size_of(after - x) + 1e-15 * size_of(x) + 1e-300;
            const real ratio = size_of(w->change[i]) / size;
            worst = chosen(ratio <= worst, worst, ratio);
            w->y[i] = chosen(going, after, w->y[i]);
        }
        const real rate = worst / before;
        going &= solved & (worst < 1e300) & MODEL(wide_inside)(w->y, w->u, &w->p);
        for (int k = 0; k < WIDTH; ++k)
            if (w->lane[k].s)
                ++w->lane[k].s->model.iterations;
        const mask last = going & ((worst <= 1.0) | (worst * rate * rate <= 1e-6));
        found |= last;
        going &= ~last;
        before = worst;
    }
    return found;
}

/* Whether each lane's step is one of nature's: all finite, and no process takes entropy. */
static mask MODEL(natural)(MODEL(wide) *w)
{
    mask good = everywhere;
    real total = zero, low = zero;
    MODEL(wide_means)(w->from, w->y, w->u, &w->p, w->means);
    for (long k = 0; k < w->rows; ++k)
        good &= size_of(w->means[k]) < 1e300;
    for (long k = w->ports + w->processes; k < w->ports + 2 * w->processes; ++k) {
        total += size_of(w->means[k]);
        low = chosen(w->means[k] < low, w->means[k], low);
    }
    return good & (low >= -1e-14 * total);
}

/* Take the steps of the lanes in `good`: states, changes, and on the fine path the ledger. */
static void MODEL(commit)(MODEL(wide) *w, const mask *on, mask good, real h)
{
    const mask booked = good & on[FINE];
    for (int k = 0; k < PATHS; ++k) {
        const mask here = good & on[k];
        if (!any(here))
            continue;
        for (long i = 0; i < w->n; ++i) {
            w->prior[k][i] = chosen(here, w->last[k][i], w->prior[k][i]);
            w->last[k][i] = chosen(here, w->y[i] - w->from[i], w->last[k][i]);
            w->x[k][i] = chosen(here, w->y[i], w->x[k][i]);
        }
        w->before[k] = chosen(here, w->since[k], w->before[k]);
        w->since[k] = chosen(here, h, w->since[k]);
    }
    for (long k = 0; any(booked) && k < w->rows; ++k) {
        const real part = h * w->means[k] - w->lost[k], total = w->sums[k] + part;
        w->lost[k] = chosen(booked, (total - w->sums[k]) - part, w->lost[k]);
        w->sums[k] = chosen(booked, total, w->sums[k]);
    }
}

/* One lane's step by stepper.c, which halves it where it has to; 0 if that does not help. */
static int MODEL(alone)(MODEL(wide) *w, int k)
{
    MODEL(lane) *lane = &w->lane[k];
    MODEL(take_path)(w, k, lane->path);
    if (MODEL(step)(&lane->s->model, MODEL(path_of)(lane->s, lane->path), lane->u, lane->h, 0)) {
        MODEL(put_path)(w, k, lane->path);
        return 1;
    }
    if (w->mode == ADAPT)
        MODEL(undo)(w, k);
    lane->s->failed = 1;
    return 0;
}

/* A lane leaves its member, which keeps all, and goes on with the next that has something to do. */
static void MODEL(refill)(MODEL(wide) *w, int k, MODEL(member) **next, const MODEL(member) *end)
{
    MODEL(lane) *lane = &w->lane[k];
    if (lane->s)
        for (int path = 0; path < PATHS; ++path)
            MODEL(take_path)(w, k, path);
    for (lane->s = 0; *next < end;) {
        lane->s = (*next)++;
        MODEL(wide_load)(&w->p, lane->s->model.p, k);
        for (int path = 0; path < PATHS; ++path)
            MODEL(put_path)(w, k, path);
        if (MODEL(begin)(w, k))
            return;
        lane->s = 0;
    }
}

/* As survey, march or adapt of stepper.c, with lanes of vectors; `space` has wide_size vectors. */
void MODEL(run_wide)(MODEL(member) *members, long count, const MODEL(block) *b, int mode, real *space);
void MODEL(run_wide)(MODEL(member) *members, long count, const MODEL(block) *b, int mode, real *space)
{
    MODEL(wide) w = {.mode = mode, .b = b};
    MODEL(member) *next = members;
    MODEL(wide_places)(&w, &members->model, space);
    for (int k = 0; k < WIDTH; ++k)
        MODEL(wide_load)(&w.p, members->model.p, k); /* so that idle lanes compute with numbers */
    for (int k = 0; k < WIDTH; ++k)
        MODEL(refill)(&w, k, &next, members + count);
    for (;;) {
        mask on[PATHS] = {nowhere, nowhere, nowhere}, going;
        real h = wide(1.0);
        for (int k = 0; k < WIDTH; ++k) {
            if (!w.lane[k].s)
                continue;
            on[w.lane[k].path][k] = -1;
            h[k] = w.lane[k].h;
            for (long i = 0; i < w.inputs; ++i)
                w.u[i][k] = w.lane[k].u[i];
        }
        going = on[FINE] | on[COARSE] | on[TRIAL];
        if (!any(going))
            return;
        MODEL(predictions)(&w, on, h);
        mask good = MODEL(roots)(&w, going, h);
        good &= MODEL(natural)(&w);
        MODEL(commit)(&w, on, good, h);
        for (int k = 0; k < WIDTH; ++k) {
            MODEL(lane) *lane = &w.lane[k];
            if (!lane->s)
                continue;
            int busy = good[k] || MODEL(alone)(&w, k);
            ++lane->s->steps;
            lane->u += w.inputs;
            if (busy && --lane->left == 0)
                busy = MODEL(next)(&w, k);
            if (!busy)
                MODEL(refill)(&w, k, &next, members + count);
        }
    }
}
