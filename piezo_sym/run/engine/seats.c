/*
 * A member's place in vectors: its lanes, and what goes to and fro between them and its record.
 * Behind wide.c and paths.c; fleet.c says what lanes do.
 */

/*
 * Surveys and marches give a member one lane.  A mesh gives it two, a track each, that end an
 * interval together: the first takes the fine path, four steps a step; the other the trial and the
 * coarse path, one each, and the middle one, two.
 */
enum { FIRST, SECOND, TRACKS };

/* A track of a member: its lane, which of its paths it is on, the steps left of that. */
typedef struct {
    MODEL(wide) *w;
    int k, slot;
    long left;
} MODEL(seat);

/* Where a member is, or none. */
typedef struct {
    MODEL(member) *s;
    MODEL(seat) seat[TRACKS];
} MODEL(place);

static int MODEL(slots_of)(int track)
{
    return track == SECOND ? SLOTS : 1;
}

static void MODEL(put_path)(const MODEL(path) *of, const MODEL(seat) *seat, int slot)
{
    MODEL(wide) *w = seat->w;
    MODEL(wide_path) *to = &w->path[slot];
    const int k = seat->k;
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

static void MODEL(take_path)(const MODEL(seat) *seat, MODEL(path) *of, int slot)
{
    const MODEL(wide) *w = seat->w;
    const MODEL(wide_path) *from = &w->path[slot];
    const int k = seat->k;
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
static void MODEL(keep_wide)(MODEL(place) *at)
{
    for (int track = 0; track < TRACKS; ++track) {
        MODEL(wide) *w = at->seat[track].w;
        const mask where = lane_of(at->seat[track].k);
        for (int slot = 0; slot < MODEL(slots_of)(track); ++slot)
            MODEL(copy)(where, w->path[slot].x, w->kept[slot], w->n);
        if (track == FIRST) {
            MODEL(copy)(where, w->sums, w->kept_sums, w->rows);
            MODEL(copy)(where, w->lost, w->kept_lost, w->rows);
        }
    }
}

static void MODEL(undo)(MODEL(place) *at)
{
    for (int track = 0; track < TRACKS; ++track) {
        MODEL(wide) *w = at->seat[track].w;
        const mask where = lane_of(at->seat[track].k);
        for (int slot = 0; slot < MODEL(slots_of)(track); ++slot) {
            MODEL(wide_path) *path = &w->path[slot];
            MODEL(copy)(where, w->kept[slot], path->x, w->n);
            path->since = chosen(where, zero, path->since);
            path->before = chosen(where, zero, path->before);
        }
        if (track == FIRST) {
            MODEL(copy)(where, w->kept_sums, w->sums, w->rows);
            MODEL(copy)(where, w->kept_lost, w->lost, w->rows);
        }
    }
}

/* The error of an interval, in parts of what is allowed. */
static double MODEL(apart)(const MODEL(place) *at)
{
    const MODEL(seat) first = at->seat[FIRST], second = at->seat[SECOND];
    const real *fine = first.w->path[0].x, *trial = second.w->path[0].x;
    const double strange =
        MODEL(strange)(first.w->surprise[first.k], second.w->surprise[second.k]);
    double worst = 0.0;
    for (long i = 0; i < first.w->n; ++i) {
        const double distance = fabs(fine[i][first.k] - trial[i][second.k]);
        const double ratio = distance / (FINEST * at->s->tolerance[i]);
        worst = worst != worst || ratio <= worst ? worst : ratio;
    }
    return strange > worst ? strange : worst;
}
