/*
 * Members side by side: what survey, march and adapt of paths.c do for one after another.  Each has
 * a place, with a lane of a vector or two, until it is done; then the next one takes that.  A lane
 * whose step is not accepted is left to stepper.c, which halves it.
 */

enum { SURVEY, MARCH, ADAPT };

/*
 * All places.  If each track has a vector, the lanes of one are alike: those of the first have one
 * path, those of the other book nothing, and neither waits for the other's iterations.  Few members
 * have their lanes in one vector.
 */
typedef struct {
    MODEL(wide) vector[TRACKS];
    MODEL(place) place[WIDTH];
    int mode, tracks, vectors, places;
    const MODEL(block) *b;
} MODEL(fleet);

extern const long MODEL(width);
const long MODEL(width) = WIDTH;

/* How many vectors `space` of run_wide has to hold. */
long MODEL(wide_size)(const MODEL(model) *m);
long MODEL(wide_size)(const MODEL(model) *m)
{
    return TRACKS * MODEL(wide_numbers)(m);
}

static MODEL(path) *MODEL(path_of)(const MODEL(fleet) *f, MODEL(member) *s, int track, int slot)
{
    MODEL(path) *const seconds[SLOTS] = {&s->trial, &s->coarse, &s->middle};
    return f->mode == SURVEY || track == SECOND ? seconds[slot] : &s->fine;
}

/* A track takes the path of a slot next: its steps, their length, their inputs. */
static void MODEL(go)(const MODEL(fleet) *f, MODEL(place) *at, int track, int slot)
{
    MODEL(member) *s = at->s;
    MODEL(seat) *seat = &at->seat[track];
    MODEL(wide) *w = seat->w;
    const int k = seat->k, adapts = f->mode == ADAPT;
    const long level = adapts ? s->level : 0, half = MODEL(twice)(level);
    const long seconds[SLOTS] = {level, level, half};
    const long taken = adapts && track == FIRST ? MODEL(twice)(half) : seconds[slot];
    w->on[seat->slot][k] = 0;
    w->on[slot][k] = -1;
    seat->slot = slot;
    seat->left = MODEL(steps_at)(taken);
    w->next[k] = f->b->u[taken - f->b->lowest] + w->inputs * seat->left * s->done;
    w->h[k] = f->b->h[s->done] / (double)seat->left;
    s->steps += seat->left;
}

/* Whether a member has a next interval to go through. */
static int MODEL(goes_on)(const MODEL(fleet) *f, const MODEL(member) *s)
{
    const int there = !s->failed && s->done < f->b->intervals;
    return there && (f->mode != ADAPT || MODEL(levels_there)(s, f->b));
}

/* Begin the next interval of a member; 0 if there is none. */
static int MODEL(begin)(const MODEL(fleet) *f, MODEL(place) *at)
{
    const MODEL(seat) first = at->seat[FIRST], second = at->seat[SECOND];
    if (!MODEL(goes_on)(f, at->s))
        return 0;
    MODEL(go)(f, at, FIRST, 0);
    if (f->mode != ADAPT)
        return 1;
    MODEL(keep_wide)(at);
    for (long i = 0; i < first.w->n; ++i)
        second.w->path[0].x[i][second.k] = first.w->path[0].x[i][first.k];
    first.w->surprise[first.k] = second.w->surprise[second.k] = 0.0;
    MODEL(go)(f, at, SECOND, 0);
    return 1;
}

/* Write what a member has become at a sample. */
static void MODEL(write_wide)(const MODEL(fleet) *f, const MODEL(place) *at, long row)
{
    const MODEL(member) *s = at->s;
    const MODEL(seat) first = at->seat[FIRST], second = at->seat[SECOND];
    const long n = first.w->n, rows = first.w->rows;
    const int march = f->mode == MARCH;
    MODEL(take)(first.w->sums, march ? s->out_sums + row * rows : s->fine.sums, rows, first.k);
    MODEL(take)(first.w->path[0].x, march ? s->out_x + row * n : s->fine.x, n, first.k);
    if (march)
        return;
    MODEL(take)(second.w->path[1].x, s->coarse.x, n, second.k);
    MODEL(take)(second.w->path[2].x, s->middle.x, n, second.k);
    MODEL(write)(s, row);
}

/* A member has ended an interval: what comes next; 0 if it is done here. */
static int MODEL(next)(const MODEL(fleet) *f, MODEL(place) *at)
{
    MODEL(member) *s = at->s;
    const MODEL(seat) first = at->seat[FIRST];
    const long row = f->b->sample[s->done];
    const double worst = f->mode == ADAPT ? MODEL(apart)(at) : 0.0;
    if (!(worst <= 1.0)) {
        MODEL(undo)(at);
        s->level = MODEL(raised)(s->level, worst);
        return MODEL(begin)(f, at);
    }
    if (f->mode == SURVEY)
        for (long i = 0; i < first.w->n; ++i)
            s->tolerance[i] = fmax(s->tolerance[i], fabs(first.w->path[0].x[i][first.k]));
    else if (row >= 0)
        MODEL(write_wide)(f, at, row);
    if (f->mode == ADAPT)
        s->level = MODEL(lowered)(s->level, worst);
    ++s->done;
    return MODEL(begin)(f, at);
}

/* A lane that has no member computes with some inputs, too. */
static void MODEL(idle)(const MODEL(fleet) *f, MODEL(wide) *w, int k)
{
    w->next[k] = f->b->u[0];
}

/* A member leaves its place; it keeps what it has done. */
static void MODEL(leave)(const MODEL(fleet) *f, MODEL(place) *at)
{
    MODEL(member) *s = at->s;
    for (int track = 0; track < f->tracks; ++track) {
        const MODEL(seat) *seat = &at->seat[track];
        MODEL(wide) *w = seat->w;
        for (int slot = 0; slot < MODEL(slots_of)(track); ++slot)
            MODEL(take_path)(seat, MODEL(path_of)(f, s, track, slot), slot);
        if (track == FIRST)
            MODEL(take)(w->largest, s->model.largest, w->n, seat->k);
        s->model.iterations += w->tries[seat->k];
        w->on[seat->slot][seat->k] = w->books[seat->k] = w->tries[seat->k] = 0;
        MODEL(idle)(f, w, seat->k);
    }
    at->s = NULL;
}

/* A member that goes on takes a place, and begins. */
static void MODEL(enter)(const MODEL(fleet) *f, MODEL(place) *at, MODEL(member) *s)
{
    at->s = s;
    for (int track = 0; track < f->tracks; ++track) {
        const MODEL(seat) *seat = &at->seat[track];
        MODEL(wide) *w = seat->w;
        const int k = seat->k, books = f->mode != SURVEY && track == FIRST;
        w->books[k] = -books;
        w->enough[k] = books ? EXACT : s->model.slack;
        MODEL(wide_load)(&w->p, s->model.p, k);
        MODEL(put)(w->largest, s->model.largest, w->n, k);
        for (long i = 0; f->mode == ADAPT && i < w->n; ++i)
            w->allowed[i][k] = 1.0 / s->tolerance[i];
        for (int slot = 0; slot < MODEL(slots_of)(track); ++slot)
            MODEL(put_path)(MODEL(path_of)(f, s, track, slot), seat, slot);
    }
    if (f->mode == ADAPT)
        MODEL(watch)(s);
    MODEL(begin)(f, at);
}

/* An empty place is taken by the next member that has something to do. */
static void MODEL(refill)(const MODEL(fleet) *f, MODEL(place) *at, MODEL(member) **next,
                          const MODEL(member) *end)
{
    for (; !at->s && *next < end; ++*next)
        if (MODEL(goes_on)(f, *next))
            MODEL(enter)(f, at, *next);
}

/* One track's step by stepper.c, which halves it where it has to; 0 if that does not help. */
static int MODEL(alone)(const MODEL(fleet) *f, MODEL(member) *s, const MODEL(seat) *seat, int track)
{
    const MODEL(wide) *w = seat->w;
    MODEL(path) *path = MODEL(path_of)(f, s, track, seat->slot);
    MODEL(take_path)(seat, path, seat->slot);
    if (!MODEL(step)(&s->model, path, w->next[seat->k], w->h[seat->k], 0))
        return 0;
    MODEL(put_path)(path, seat, seat->slot);
    return 1;
}

/* A track has made its step, or makes it alone; 0 if there is none. */
static int MODEL(moved)(const MODEL(fleet) *f, MODEL(place) *at, int track)
{
    MODEL(seat) *seat = &at->seat[track];
    MODEL(wide) *w = seat->w;
    const int found = w->good[seat->k] || MODEL(alone)(f, at->s, seat, track);
    w->next[seat->k] += w->inputs;
    --seat->left;
    return found;
}

/* The tracks of a member have made a step each, or not: go on; 0 if it is done here. */
static int MODEL(all_moved)(const MODEL(fleet) *f, MODEL(place) *at)
{
    const int last = f->tracks - 1;
    for (int track = 0; track <= last; ++track) {
        if (MODEL(moved)(f, at, track))
            continue;
        at->s->failed = 1;
        if (f->mode == ADAPT)
            MODEL(undo)(at);
        return 0;
    }
    if (at->seat[FIRST].left == 0)
        return MODEL(next)(f, at);
    if (at->seat[last].left == 0)
        MODEL(go)(f, at, last, at->seat[last].slot + 1);
    return 1;
}

/* Make vectors and places ready for members of a model. */
static void MODEL(furnish)(MODEL(fleet) *f, const MODEL(model) *m, real *space)
{
    for (int v = 0; v < f->vectors; ++v) {
        MODEL(wide) *w = &f->vector[v];
        MODEL(wide_places)(w, m, space + v * MODEL(wide_numbers)(m));
        w->adapts = f->mode == ADAPT;
        for (int k = 0; k < WIDTH; ++k) { /* so that idle lanes compute with numbers */
            MODEL(wide_load)(&w->p, m->p, k);
            MODEL(idle)(f, w, k);
        }
    }
    for (int n = 0; n < f->places; ++n)
        for (int track = 0; track < f->tracks; ++track) {
            const int own = f->vectors > 1;
            f->place[n].seat[track].w = &f->vector[own ? track : 0];
            f->place[n].seat[track].k = own ? n : f->tracks * n + track;
        }
}

/* As survey, march or adapt of paths.c, with lanes of vectors; `space` has wide_size vectors. */
void MODEL(run_wide)(MODEL(member) *members, long count, const MODEL(block) *b, int mode,
                     real *space);
void MODEL(run_wide)(MODEL(member) *members, long count, const MODEL(block) *b, int mode,
                     real *space)
{
    const int tracks = mode == ADAPT ? TRACKS : 1;
    const int vectors = tracks * count > WIDTH ? tracks : 1, places = WIDTH * vectors / tracks;
    MODEL(fleet) f = {.mode = mode, .tracks = tracks, .vectors = vectors, .places = places, .b = b};
    MODEL(member) *next = members;
    MODEL(furnish)(&f, &members->model, space);
    for (int n = 0; n < places; ++n)
        MODEL(refill)(&f, &f.place[n], &next, members + count);
    for (;;) {
        int some = 0;
        for (int v = 0; v < vectors; ++v)
            some |= MODEL(advance)(&f.vector[v]);
        if (!some)
            return;
        for (int n = 0; n < places; ++n) {
            MODEL(place) *at = &f.place[n];
            if (!at->s || MODEL(all_moved)(&f, at))
                continue;
            MODEL(leave)(&f, at);
            MODEL(refill)(&f, at, &next, members + count);
        }
    }
}
