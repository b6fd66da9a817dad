/*
 * Members side by side: what march.c does for one after another.  Each has a lane of a vector until
 * it is done; then the next one takes that.  A lane whose step is not accepted is left to stepper.c,
 * which halves it.
 */

/* The vector, whose each lane is, and the intervals that all go through. */
typedef struct {
    MODEL(wide) w;
    MODEL(member) *of[WIDTH];
    const MODEL(block) *b;
} MODEL(fleet);

extern const long MODEL(width);
const long MODEL(width) = WIDTH;

/* How many vectors `space` of run_wide has to hold. */
long MODEL(wide_size)(const MODEL(model) *m);
long MODEL(wide_size)(const MODEL(model) *m)
{
    return MODEL(wide_numbers)(m);
}

static void MODEL(put_path)(MODEL(wide) *w, const MODEL(path) *of, int k)
{
    MODEL(put)(w->x, of->x, w->n, k);
    MODEL(put)(w->last, of->last, w->n, k);
    MODEL(put)(w->prior, of->prior, w->n, k);
    MODEL(put)(w->sums, of->sums, w->rows, k);
    MODEL(put)(w->lost, of->lost, w->rows, k);
    w->since[k] = of->h;
    w->before[k] = of->h_prior;
}

static void MODEL(take_path)(const MODEL(wide) *w, MODEL(path) *of, int k)
{
    MODEL(take)(w->x, of->x, w->n, k);
    MODEL(take)(w->last, of->last, w->n, k);
    MODEL(take)(w->prior, of->prior, w->n, k);
    MODEL(take)(w->sums, of->sums, w->rows, k);
    MODEL(take)(w->lost, of->lost, w->rows, k);
    of->h = w->since[k];
    of->h_prior = w->before[k];
}

/* A member takes its next interval; 0 if there is none. */
static int MODEL(begin)(MODEL(fleet) *f, int k)
{
    MODEL(member) *s = f->of[k];
    if (s->failed || s->done >= f->b->intervals)
        return 0;
    f->w.next[k] = f->b->u + f->w.inputs * s->done;
    f->w.h[k] = f->b->h[s->done];
    ++s->steps;
    return 1;
}

/* A lane that has no member computes with some inputs, too. */
static void MODEL(idle)(MODEL(fleet) *f, int k)
{
    f->w.next[k] = f->b->u;
    f->w.on[k] = f->w.tries[k] = 0;
    f->of[k] = NULL;
}

/* A member leaves its lane; it keeps what it has done. */
static void MODEL(leave)(MODEL(fleet) *f, int k)
{
    MODEL(member) *s = f->of[k];
    MODEL(take_path)(&f->w, &s->path, k);
    MODEL(take)(f->w.largest, s->model.largest, f->w.n, k);
    s->model.iterations += f->w.tries[k];
    MODEL(idle)(f, k);
}

/* An empty lane is taken by the next member that has something to do. */
static void MODEL(refill)(MODEL(fleet) *f, int k, MODEL(member) **next, const MODEL(member) *end)
{
    for (; !f->of[k] && *next < end; ++*next) {
        MODEL(member) *s = *next;
        if (s->failed || s->done >= f->b->intervals)
            continue;
        f->of[k] = s;
        f->w.on[k] = -1;
        MODEL(wide_load)(&f->w.p, s->model.p, k);
        MODEL(put)(f->w.largest, s->model.largest, f->w.n, k);
        MODEL(put_path)(&f->w, &s->path, k);
        MODEL(begin)(f, k);
    }
}

/* A lane's step by stepper.c, which halves it where it has to; 0 if that does not help. */
static int MODEL(alone)(MODEL(fleet) *f, int k)
{
    MODEL(member) *s = f->of[k];
    MODEL(take_path)(&f->w, &s->path, k);
    if (!MODEL(step)(&s->model, &s->path, f->w.next[k], f->w.h[k], 0))
        return 0;
    MODEL(put_path)(&f->w, &s->path, k);
    return 1;
}

/* A member has made its step, or makes it alone: on; 0 if it is done here. */
static int MODEL(moved)(MODEL(fleet) *f, int k)
{
    MODEL(member) *s = f->of[k];
    const long row = f->b->sample[s->done];
    if (!f->w.good[k] && !MODEL(alone)(f, k)) {
        s->failed = 1;
        return 0;
    }
    if (row >= 0) {
        MODEL(take)(f->w.sums, s->out_sums + row * f->w.rows, f->w.rows, k);
        MODEL(take)(f->w.x, s->out_x + row * f->w.n, f->w.n, k);
    }
    ++s->done;
    return MODEL(begin)(f, k);
}

/* As march of march.c, with lanes of vectors; `space` has wide_size vectors. */
void MODEL(run_wide)(MODEL(member) *members, long count, const MODEL(block) *b, real *space);
void MODEL(run_wide)(MODEL(member) *members, long count, const MODEL(block) *b, real *space)
{
    MODEL(fleet) f = {.b = b};
    MODEL(member) *next = members;
    MODEL(wide_places)(&f.w, &members->model, space);
    for (int k = 0; k < WIDTH; ++k) { /* so that idle lanes compute with numbers */
        MODEL(wide_load)(&f.w.p, members->model.p, k);
        MODEL(idle)(&f, k);
        MODEL(refill)(&f, k, &next, members + count);
    }
    while (MODEL(advance)(&f.w))
        for (int k = 0; k < WIDTH; ++k) {
            if (!f.of[k] || MODEL(moved)(&f, k))
                continue;
            MODEL(leave)(&f, k);
            MODEL(refill)(&f, k, &next, members + count);
        }
}
