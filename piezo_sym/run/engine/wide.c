/*
 * Members side by side: each lane of a vector takes steps of one member, and goes on with the next
 * member when that is done.  What stepper.c and paths.c do for one, with masks: a lane whose step
 * does not converge, or is not accepted, is left to stepper.c, which halves it.
 */

enum { SURVEY, MARCH, ADAPT };
/*
 * Surveys and marches give each member a lane.  A mesh gives it two, a track each, that end an
 * interval together: the first takes the fine path, four steps a step; the other the trial and the
 * coarse path, one each, and the middle one, two.  SLOTS: how many paths a lane may have.
 */
enum { FIRST, SECOND, TRACKS };
enum { SLOTS = 3 };

/* A lane: its member (or none), the path it is on, the steps left of it, the next one's inputs. */
typedef struct {
    MODEL(member) *s;
    int track, slot;
    long left;
    const double *u;
} MODEL(lane);

/* Where a path of each lane is: state, last changes, their steps. */
typedef struct {
    real *x, *last, *prior, since, before;
} MODEL(wide_path);

/* What all lanes compute with: paths, ledgers, what is kept of an interval, room for one step. */
typedef struct {
    MODEL(wide_parameters) p;
    MODEL(lane) lane[WIDTH];
    long n, rows, ports, processes, inputs;
    MODEL(wide_path) path[SLOTS];
    mask on[SLOTS], books; /* which lanes are on a path, and which book what their steps do */
    mask tries; /* iterations of Newton's method so far */
    mask good;             /* which lanes' last steps converged */
    real h, enough;        /* the steps, and what Newton's method may leave of them */
    real *sums, *lost, *kept[SLOTS], *kept_sums, *kept_lost;
    real *from, *y, *u, *change, *per, *means, *largest;
    real *expected, *allowed, surprise; /* of the fine paths and the trial ones: see stepper.c */
    int mode, slots;                    /* how many paths its lanes may have */
    const MODEL(block) *b;
} MODEL(wide);

/*
 * The vectors of a run.  If each track has one, a member has the same lane in each: their paths, and
 * what those need, are alike then.  A single vector has a member's lanes side by side.
 */
typedef struct {
    MODEL(wide) of[TRACKS];
    int tracks, vectors;
} MODEL(fleet);

/* Where a track of a member is: a vector and a lane. */
typedef struct {
    MODEL(wide) *w;
    int k;
} MODEL(seat);

static MODEL(seat) MODEL(seat_of)(MODEL(fleet) *f, int place, int track)
{
    if (f->vectors > 1)
        return (MODEL(seat)){&f->of[track], place};
    return (MODEL(seat)){&f->of[0], f->tracks * place + track};
}

extern const long MODEL(width);
const long MODEL(width) = WIDTH;

/* How many vectors `space` of run_wide has to hold: that of each track. */
long MODEL(wide_size)(const MODEL(model) *m);
long MODEL(wide_size)(const MODEL(model) *m)
{
    const long paths = SLOTS * 4 * m->n, step = 6 * m->n + m->inputs + MODEL(newton_size)(m->p);
    return TRACKS * (MODEL(wide_room)(m->p) + paths + step + 5 * m->rows);
}

static void MODEL(wide_places)(MODEL(wide) *w, const MODEL(model) *m, real *space)
{
    const long n = w->n = m->n, rows = w->rows = m->rows;
    real *at = space + MODEL(wide_room)(m->p);
    w->ports = m->ports, w->processes = m->processes, w->inputs = m->inputs;
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

static MODEL(path) *MODEL(path_of)(const MODEL(wide) *w, int k, int slot)
{
    MODEL(member) *s = w->lane[k].s;
    MODEL(path) *const seconds[SLOTS] = {&s->trial, &s->coarse, &s->middle};
    if (w->mode == SURVEY || w->lane[k].track == SECOND)
        return seconds[slot];
    return &s->fine;
}

static int MODEL(slots_of)(const MODEL(wide) *w, int k)
{
    return w->lane[k].track == SECOND ? SLOTS : 1;
}

static void MODEL(put_path)(MODEL(wide) *w, int k, int slot)
{
    const MODEL(path) *of = MODEL(path_of)(w, k, slot);
    MODEL(wide_path) *to = &w->path[slot];
    MODEL(put)(to->x, of->x, w->n, k);
    MODEL(put)(to->last, of->last, w->n, k);
    MODEL(put)(to->prior, of->prior, w->n, k);
    to->since[k] = of->h;
    to->before[k] = of->h_prior;
    if (slot == 0)
        w->surprise[k] = of->surprise;
    if (w->books[k]) {
        MODEL(put)(w->sums, of->sums, w->rows, k);
        MODEL(put)(w->lost, of->lost, w->rows, k);
    }
}

static void MODEL(take_path)(const MODEL(wide) *w, int k, int slot)
{
    MODEL(path) *of = MODEL(path_of)(w, k, slot);
    const MODEL(wide_path) *from = &w->path[slot];
    MODEL(take)(from->x, of->x, w->n, k);
    MODEL(take)(from->last, of->last, w->n, k);
    MODEL(take)(from->prior, of->prior, w->n, k);
    of->h = from->since[k];
    of->h_prior = from->before[k];
    if (slot == 0)
        of->surprise = w->surprise[k];
    if (w->books[k]) {
        MODEL(take)(w->sums, of->sums, w->rows, k);
        MODEL(take)(w->lost, of->lost, w->rows, k);
    }
}

/* Remember where an interval of a member begins: states and ledger. */
static void MODEL(keep_wide)(MODEL(fleet) *f, int place)
{
    for (int track = 0; track < f->tracks; ++track) {
        const MODEL(seat) at = MODEL(seat_of)(f, place, track);
        MODEL(wide) *w = at.w;
        mask where = nowhere;
        where[at.k] = -1;
        for (int slot = 0; slot < MODEL(slots_of)(w, at.k); ++slot)
            MODEL(copy)(where, w->path[slot].x, w->kept[slot], w->n);
        if (track == FIRST) {
            MODEL(copy)(where, w->sums, w->kept_sums, w->rows);
            MODEL(copy)(where, w->lost, w->kept_lost, w->rows);
        }
    }
}

static void MODEL(undo)(MODEL(fleet) *f, int place)
{
    for (int track = 0; track < f->tracks; ++track) {
        const MODEL(seat) at = MODEL(seat_of)(f, place, track);
        MODEL(wide) *w = at.w;
        mask where = nowhere;
        where[at.k] = -1;
        for (int slot = 0; slot < MODEL(slots_of)(w, at.k); ++slot) {
            MODEL(copy)(where, w->kept[slot], w->path[slot].x, w->n);
            w->path[slot].since[at.k] = w->path[slot].before[at.k] = 0.0;
        }
        if (track == FIRST) {
            MODEL(copy)(where, w->kept_sums, w->sums, w->rows);
            MODEL(copy)(where, w->kept_lost, w->lost, w->rows);
        }
    }
}

/* Lane k takes the path of a slot next: its steps, their length, their inputs. */
static void MODEL(go)(MODEL(wide) *w, int k, int slot)
{
    MODEL(lane) *lane = &w->lane[k];
    MODEL(member) *s = lane->s;
    const long level = w->mode == ADAPT ? s->level : 0, half = MODEL(twice)(level);
    const long seconds[SLOTS] = {level, level, half};
    const int fine = w->mode == ADAPT && lane->track == FIRST;
    const long at = fine ? MODEL(twice)(half) : seconds[slot];
    w->on[lane->slot][k] = 0;
    w->on[slot][k] = -1;
    lane->slot = slot;
    lane->left = MODEL(steps_at)(at);
    lane->u = w->b->u[at - w->b->lowest] + w->inputs * lane->left * s->done;
    w->h[k] = w->b->h[s->done] / (double)lane->left;
    s->steps += lane->left;
}

/* Whether a member has a next interval to go through. */
static int MODEL(goes_on)(const MODEL(wide) *w, const MODEL(member) *s)
{
    const int there = !s->failed && s->done < w->b->intervals;
    return there && (w->mode != ADAPT || MODEL(levels_there)(s, w->b));
}

/* Begin the next interval of a member; 0 if there is none. */
static int MODEL(begin)(MODEL(fleet) *f, int place)
{
    const MODEL(seat) first = MODEL(seat_of)(f, place, FIRST);
    if (!MODEL(goes_on)(first.w, first.w->lane[first.k].s))
        return 0;
    MODEL(go)(first.w, first.k, 0);
    if (f->tracks == 1)
        return 1;
    const MODEL(seat) second = MODEL(seat_of)(f, place, SECOND);
    MODEL(keep_wide)(f, place);
    for (long i = 0; i < first.w->n; ++i)
        second.w->path[0].x[i][second.k] = first.w->path[0].x[i][first.k];
    first.w->surprise[first.k] = second.w->surprise[second.k] = 0.0;
    MODEL(go)(second.w, second.k, 0);
    return 1;
}

/* The error of an interval, in parts of what is allowed. */
static double MODEL(apart)(MODEL(fleet) *f, int place)
{
    const MODEL(seat) first = MODEL(seat_of)(f, place, FIRST);
    const MODEL(seat) second = MODEL(seat_of)(f, place, SECOND);
    const real *fine = first.w->path[0].x, *trial = second.w->path[0].x;
    const double *tolerance = first.w->lane[first.k].s->tolerance;
    const double strange =
        MODEL(strange)(first.w->surprise[first.k], second.w->surprise[second.k]);
    double worst = 0.0;
    for (long i = 0; i < first.w->n; ++i) {
        const double ratio =
            fabs(fine[i][first.k] - trial[i][second.k]) / (FINEST * tolerance[i]);
        worst = worst != worst || ratio <= worst ? worst : ratio;
    }
    return strange > worst ? strange : worst;
}

/* Write what a member has become at a sample. */
static void MODEL(write_wide)(MODEL(fleet) *f, int place, long row)
{
    const MODEL(seat) at = MODEL(seat_of)(f, place, FIRST);
    const MODEL(wide) *w = at.w;
    const MODEL(member) *s = w->lane[at.k].s;
    const int march = f->tracks == 1;
    MODEL(take)(w->sums, march ? s->out_sums + row * w->rows : s->fine.sums, w->rows, at.k);
    MODEL(take)(w->path[0].x, march ? s->out_x + row * w->n : s->fine.x, w->n, at.k);
    if (march)
        return;
    const MODEL(seat) other = MODEL(seat_of)(f, place, SECOND);
    MODEL(take)(other.w->path[1].x, s->coarse.x, w->n, other.k);
    MODEL(take)(other.w->path[2].x, s->middle.x, w->n, other.k);
    MODEL(write)(s, row);
}

/* A member has ended an interval: what comes next; 0 if it is done here. */
static int MODEL(next)(MODEL(fleet) *f, int place)
{
    const MODEL(seat) at = MODEL(seat_of)(f, place, FIRST);
    const MODEL(wide) *w = at.w;
    MODEL(member) *s = w->lane[at.k].s;
    const long row = w->b->sample[s->done];
    const double worst = w->mode == ADAPT ? MODEL(apart)(f, place) : 0.0;
    if (!(worst <= 1.0)) {
        MODEL(undo)(f, place);
        s->level = MODEL(raised)(s->level, worst);
        return MODEL(begin)(f, place);
    }
    if (w->mode == SURVEY)
        for (long i = 0; i < w->n; ++i)
            s->tolerance[i] = fmax(s->tolerance[i], fabs(w->path[0].x[i][at.k]));
    else if (row >= 0)
        MODEL(write_wide)(f, place, row);
    if (w->mode == ADAPT)
        s->level = MODEL(lowered)(s->level, worst);
    ++s->done;
    return MODEL(begin)(f, place);
}

/* The state before each lane's step, and the prediction of that after it: a parabola's. */
static void MODEL(predictions)(MODEL(wide) *w)
{
    real since = w->path[0].since, before = w->path[0].before;
    int used[SLOTS] = {1};
    for (int k = 1; k < w->slots; ++k) {
        used[k] = any(w->on[k]);
        since = chosen(w->on[k], w->path[k].since, since);
        before = chosen(w->on[k], w->path[k].before, before);
    }
    const real slope = chosen(before > 0.0, w->h + since, zero) / (since + before + LEAST_SIZE);
    const real by_last = chosen(since > 0.0, w->h * (1.0 + slope) / since, zero);
    const real by_prior = chosen(before > 0.0, w->h * slope / before, zero);
    for (long i = 0; i < w->n; ++i) {
        real x = w->path[0].x[i], last = w->path[0].last[i], prior = w->path[0].prior[i];
        for (int k = 1; k < w->slots; ++k) {
            if (!used[k])
                continue;
            x = chosen(w->on[k], w->path[k].x[i], x);
            last = chosen(w->on[k], w->path[k].last[i], last);
            prior = chosen(w->on[k], w->path[k].prior[i], prior);
        }
        w->from[i] = x;
        w->y[i] = w->expected[i] = x + by_last * last - by_prior * prior;
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
    real sum = zero;
    for (long i = 0; i < w->n; ++i) {
        const real x = w->from[i], after = w->y[i] - w->change[i];
        if (measured)
            w->per[i] = about_per(1e-9 * size_of(after - x)
                                  + noise * (size_of(x) + w->largest[i]) + LEAST_SIZE);
        sum += size_of(w->change[i]) * w->per[i];
        w->y[i] = chosen(going, after, w->y[i]);
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
    for (long i = 0; i < w->n; ++i)
        w->y[i] = chosen(in, w->y[i], w->from[i]);
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
    const long produced = w->ports + w->processes, end = produced + w->processes;
    real all = zero, total = zero, low = zero;
    MODEL(wide_means)(w->from, w->y, w->u, &w->p, w->means);
    for (long k = 0; k < w->rows; ++k)
        all += size_of(w->means[k]);
    for (long k = produced; k < end; ++k) {
        total += size_of(w->means[k]);
        low = chosen(w->means[k] < low, w->means[k], low);
    }
    return (all < 1e300) & (low >= -1e-14 * total);
}

/* Compare the states after steps of the fine paths and the trial ones with what was expected. */
static void MODEL(compare_wide)(MODEL(wide) *w, mask good)
{
    real worst = w->surprise;
    for (long i = 0; i < w->n; ++i) {
        const real missed = size_of(w->y[i] - w->expected[i]) * w->allowed[i];
        worst = chosen(missed > worst, missed, worst);
    }
    w->surprise = chosen(good & w->on[0] & (w->path[0].before > 0.0), worst, w->surprise);
}

/* Take the steps of the lanes in `good`: states, changes, and the ledger of those that book. */
static void MODEL(commit)(MODEL(wide) *w, mask good)
{
    for (long i = 0; i < w->n; ++i) {
        const real size = size_of(w->y[i]);
        w->largest[i] = chosen(good & (size > w->largest[i]), size, w->largest[i]);
    }
    if (w->mode == ADAPT)
        MODEL(compare_wide)(w, good);
    for (int k = 0; k < w->slots; ++k) {
        const mask here = good & w->on[k];
        MODEL(wide_path) *path = &w->path[k];
        if (!any(here))
            continue;
        for (long i = 0; i < w->n; ++i) {
            path->prior[i] = chosen(here, path->last[i], path->prior[i]);
            path->last[i] = chosen(here, w->y[i] - w->from[i], path->last[i]);
            path->x[i] = chosen(here, w->y[i], path->x[i]);
        }
        path->before = chosen(here, path->since, path->before);
        path->since = chosen(here, w->h, path->since);
    }
    const mask booked = good & w->books;
    for (long k = 0; any(booked) && k < w->rows; ++k) {
        const real part = w->h * w->means[k] - w->lost[k], total = w->sums[k] + part;
        w->lost[k] = chosen(booked, (total - w->sums[k]) - part, w->lost[k]);
        w->sums[k] = chosen(booked, total, w->sums[k]);
    }
}

/* One lane's step by stepper.c, which halves it where it has to; 0 if that does not help. */
static int MODEL(alone)(MODEL(wide) *w, int k)
{
    MODEL(lane) *lane = &w->lane[k];
    MODEL(take_path)(w, k, lane->slot);
    if (!MODEL(step)(&lane->s->model, MODEL(path_of)(w, k, lane->slot), lane->u, w->h[k], 0))
        return 0;
    MODEL(put_path)(w, k, lane->slot);
    return 1;
}

/* The lanes of a member leave it; it keeps what they have done. */
static void MODEL(leave)(MODEL(fleet) *f, int place)
{
    for (int track = 0; track < f->tracks; ++track) {
        const MODEL(seat) at = MODEL(seat_of)(f, place, track);
        MODEL(wide) *w = at.w;
        MODEL(lane) *lane = &w->lane[at.k];
        for (int slot = 0; slot < MODEL(slots_of)(w, at.k); ++slot)
            MODEL(take_path)(w, at.k, slot);
        if (track == FIRST)
            MODEL(take)(w->largest, lane->s->model.largest, w->n, at.k);
        w->on[lane->slot][at.k] = 0;
        lane->s->model.iterations += w->tries[at.k];
        w->books[at.k] = w->tries[at.k] = 0;
        lane->s = 0;
    }
}

/* Lanes take a member that goes on, and begin. */
static void MODEL(enter)(MODEL(fleet) *f, int place, MODEL(member) *s)
{
    for (int track = 0; track < f->tracks; ++track) {
        const MODEL(seat) at = MODEL(seat_of)(f, place, track);
        MODEL(wide) *w = at.w;
        const int k = at.k, books = w->mode != SURVEY && track == FIRST;
        w->lane[k].s = s;
        w->lane[k].track = track;
        w->books[k] = -books;
        w->enough[k] = books ? EXACT : s->model.slack;
        MODEL(wide_load)(&w->p, s->model.p, k);
        MODEL(put)(w->largest, s->model.largest, w->n, k);
        for (long i = 0; w->mode == ADAPT && i < w->n; ++i)
            w->allowed[i][k] = 1.0 / s->tolerance[i];
        for (int slot = 0; slot < MODEL(slots_of)(w, k); ++slot)
            MODEL(put_path)(w, k, slot);
    }
    if (f->of[0].mode == ADAPT)
        MODEL(watch)(s);
    MODEL(begin)(f, place);
}

/* The lanes that have no member take the next that has something to do. */
static void MODEL(refill)(MODEL(fleet) *f, int place, MODEL(member) **next,
                          const MODEL(member) *end)
{
    const MODEL(seat) at = MODEL(seat_of)(f, place, FIRST);
    for (; !at.w->lane[at.k].s && *next < end; ++*next)
        if (MODEL(goes_on)(at.w, *next))
            MODEL(enter)(f, place, *next);
}

/* A lane has made its step, or makes it alone; 0 if there is none. */
static int MODEL(moved)(MODEL(wide) *w, int k)
{
    MODEL(lane) *lane = &w->lane[k];
    const int found = w->good[k] || MODEL(alone)(w, k);
    lane->u += w->inputs;
    --lane->left;
    return found;
}

/* The lanes of a member have made a step each, or not: go on; 0 if the member is done here. */
static int MODEL(all_moved)(MODEL(fleet) *f, int place)
{
    const MODEL(seat) first = MODEL(seat_of)(f, place, FIRST);
    const MODEL(seat) last = MODEL(seat_of)(f, place, f->tracks - 1);
    MODEL(lane) *lane = &last.w->lane[last.k];
    if (!MODEL(moved)(first.w, first.k) || (f->tracks > 1 && !MODEL(moved)(last.w, last.k))) {
        lane->s->failed = 1;
        if (f->tracks > 1)
            MODEL(undo)(f, place);
        return 0;
    }
    if (first.w->lane[first.k].left == 0)
        return MODEL(next)(f, place);
    if (lane->left == 0)
        MODEL(go)(last.w, last.k, lane->slot + 1);
    return 1;
}

/* All lanes of a vector make a step, those that it fails are told by `good`; 0 if there are none. */
static int MODEL(advance)(MODEL(wide) *w)
{
    const mask going = w->on[0] | w->on[1] | w->on[2];
    if (!any(going))
        return 0;
    for (int k = 0; k < WIDTH; ++k)
        for (long i = 0; w->lane[k].s && i < w->inputs; ++i)
            w->u[i][k] = w->lane[k].u[i];
    MODEL(predictions)(w);
    MODEL(wide_begin)(w->from, &w->p);
    w->good = MODEL(roots)(w, going);
    w->good &= MODEL(natural)(w);
    MODEL(commit)(w, w->good);
    return 1;
}

/* As survey, march or adapt of paths.c, with lanes of vectors; `space` has wide_size vectors. */
void MODEL(run_wide)(MODEL(member) *members, long count, const MODEL(block) *b, int mode,
                     real *space);
void MODEL(run_wide)(MODEL(member) *members, long count, const MODEL(block) *b, int mode,
                     real *space)
{
    const int tracks = mode == ADAPT ? TRACKS : 1;
    const int vectors = tracks * count > WIDTH ? tracks : 1, places = WIDTH * vectors / tracks;
    const long size = MODEL(wide_size)(&members->model) / TRACKS;
    MODEL(fleet) f = {.tracks = tracks, .vectors = vectors};
    MODEL(member) *next = members;
    for (int v = 0; v < vectors; ++v) {
        MODEL(wide) *w = &f.of[v];
        w->mode = mode, w->b = b, w->slots = mode == ADAPT && v == vectors - 1 ? SLOTS : 1;
        w->h = wide(1.0), w->enough = wide(EXACT);
        MODEL(wide_places)(w, &members->model, space + v * size);
        for (int k = 0; k < WIDTH; ++k) /* so that idle lanes compute with numbers */
            MODEL(wide_load)(&w->p, members->model.p, k);
    }
    for (int place = 0; place < places; ++place)
        MODEL(refill)(&f, place, &next, members + count);
    for (;;) {
        int steps = 0;
        for (int v = 0; v < vectors; ++v)
            steps += MODEL(advance)(&f.of[v]);
        if (!steps)
            return;
        for (int place = 0; place < places; ++place) {
            const MODEL(seat) at = MODEL(seat_of)(&f, place, FIRST);
            if (!at.w->lane[at.k].s || MODEL(all_moved)(&f, place))
                continue;
            MODEL(leave)(&f, place);
            MODEL(refill)(&f, place, &next, members + count);
        }
    }
}
