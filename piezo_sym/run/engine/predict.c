/*
 * The predictors of Newton's method: the step before, or a kept one. Comes after trajectory.c.
 *
 * Many motions repeat, as under periodic inputs. What follows a switch is then much like what followed the same
 * switch the last time, and the rates of those steps, with their change from time to time, predict the new ones
 * better than those of the step before. Each step decides which prediction the next one uses.
 */

/* Steps are kept if those of the run take more Newton iterations than this on average: else it does not pay. */
#define LABORIOUS 2.5
/* The fraction of its length by which a kept step may be extrapolated at either end. */
#define EXTENDED 0.25
/* By how much the change from time to time may grow at most, as a factor. */
#define FASTEST_GROWTH 2.0
/* A kept step counts as better if its prediction is off by less than this part of the other: that may be by chance. */
#define BETTER 0.1
/* A kept step is as good as the one before where it is off by less than this part of the tolerance. */
#define NO_MATTER 0.03

/* The polynomial through a step's stage rates, at a fraction of the step. */
static void MODEL(rates_at)(const MODEL(block) *m, const real *rates, real at, real *out)
{
    real weight[STAGES];
    MODEL(rate_weights)(at, weight);
    for (long k = 0; k < m->n; ++k) {
        real sum = zero;
        for (long j = 0; j < STAGES; ++j)
            sum += weight[j] * rates[j * m->n + k];
        out[k] = sum;
    }
}

/* Predict rates at stages, from the first one on: by the known step's polynomial, or as at the beginning. */
static void MODEL(predict)(MODEL(batch) *b, real behind, real slope, mask known, mask turned, long first)
{
    const MODEL(block) *m = &b->m;
    real *const jump = b->some_rate;
    memset(jump, 0, (size_t)m->n * sizeof(real));
    if (any(turned)) {
        MODEL(rates_at)(m, b->known, behind, jump);
        for (long k = 0; k < m->n; ++k)
            jump[k] = chosen(turned, b->rate[k] - jump[k], zero);
    }
    for (long i = first; i < STAGES; ++i) {
        real *const rates = m->rates + i * m->n;
        MODEL(rates_at)(m, b->known, behind + slope * stage_at[i], rates);
        for (long k = 0; k < m->n; ++k) /* zero for a fixed step, which may be much longer than the fastest time constant */
            rates[k] = chosen(known, rates[k] + jump[k], b->fixed > 0.0 ? zero : b->rate[k]);
    }
}

/* The place of a kept step, by its number in the run. */
static long MODEL(kept_place)(const MODEL(repeats) *r, long number)
{
    return number % r->steps;
}

/* A lane's run passes a switch: decide whether steps are kept from now on, and from which on they are recalled. */
static void MODEL(recall_passage)(MODEL(batch) *b, MODEL(lane) *l, int lane)
{
    const MODEL(repeats) *const r = &b->repeats;
    double *const number = &LANE(r->number, l->passing, lane);
    l->keeps |= l->iterations > LABORIOUS * (double)(l->run->steps + l->run->rejected);
    l->keeps &= r->steps && !b->tape;
    l->recalled = l->keeps && *number >= 0.0 && *number < (double)l->steps_kept ? (long)*number : -1;
    *number = l->keeps ? (double)l->steps_kept : -1.0;
}

/* Keep the step that ends now. */
static void MODEL(keep_step)(MODEL(batch) *b, int lane)
{
    const MODEL(repeats) *const r = &b->repeats;
    MODEL(lane) *l = b->lane + lane;
    if (!l->keeps)
        return;
    const long place = MODEL(kept_place)(r, l->steps_kept++), size = STAGES * b->m.n;
    real *const rates = r->rates + place * size, *const change = r->change + place * size;
    LANE(r->since, place, lane) = l->t - l->passed;
    LANE(r->lasted, place, lane) = l->step;
    for (long k = 0; k < size; ++k) {
        const double found = LANE(b->known, k, lane);
        LANE(rates, k, lane) = found;
        LANE(change, k, lane) = l->recalls ? found - LANE(r->guess, k, lane) : 0.0;
    }
}

/*
 * Whether a kept step covers the time after its switch that the lane's next step covers after the same switch.
 * `ahead` and `ratio` are begin and length of the new step, in lengths of the kept one.
 */
static int MODEL(recalls)(const MODEL(batch) *b, int lane, double *ahead, double *ratio)
{
    const MODEL(repeats) *const r = &b->repeats;
    MODEL(lane) *l = b->lane + lane;
    if (l->recalled < 0 || l->phase != STEP || l->refused || l->settled || IN(b->m.over, lane))
        return 0;
    if (l->steps_kept - l->recalled > r->steps) /* it has been overwritten */
        return 0;
    const double begin = l->t - l->passed, middle = begin + 0.5 * l->length;
    long place = MODEL(kept_place)(r, l->recalled);
    while (LANE(r->since, place, lane) + LANE(r->lasted, place, lane) < middle) {
        const long next = MODEL(kept_place)(r, l->recalled + 1);
        if (l->recalled + 1 >= l->steps_kept || LANE(r->since, next, lane) <= LANE(r->since, place, lane))
            break; /* it follows another switch */
        place = next;
        ++l->recalled;
    }
    const double lasted = LANE(r->lasted, place, lane);
    *ahead = (begin - LANE(r->since, place, lane)) / lasted;
    *ratio = l->length / lasted;
    return *ahead >= -EXTENDED && *ahead + *ratio <= 1.0 + EXTENDED;
}

/* The stage rates of one state in the steps that lanes recall, and how they changed from one passage to the next. */
static void MODEL(recalled_rates)(const MODEL(batch) *b, mask recalling, long k, real *rates, real *change)
{
    const MODEL(repeats) *const r = &b->repeats;
    const long n = b->m.n;
    for (int lane = 0; lane < REAL_WIDTH; ++lane) {
        if (!IN(recalling, lane))
            continue;
        const long first = MODEL(kept_place)(r, b->lane[lane].recalled) * STAGES * n + k;
        for (long j = 0; j < STAGES; ++j) {
            LANE(rates, j, lane) = LANE(r->rates, first + j * n, lane);
            LANE(change, j, lane) = LANE(r->change, first + j * n, lane);
        }
    }
}

/*
 * The rates of steps by those of the steps that they recall: predictions in lanes that are `repeating`, in the others
 * only compared with m.rates later. The change from passage to passage grows as it did in the step before.
 */
static void MODEL(predict_by_kept)(MODEL(batch) *b, real ahead, real ratio, mask recalling, mask repeating)
{
    const MODEL(block) *m = &b->m;
    const MODEL(repeats) *const r = &b->repeats;
    const long n = m->n;
    real weight[STAGES][STAGES], growth = zero;
    for (int lane = 0; lane < REAL_WIDTH; ++lane)
        LANE(&growth, 0, lane) = b->lane[lane].growth;
    for (long i = 0; i < STAGES; ++i)
        MODEL(rate_weights)(ahead + ratio * stage_at[i], weight[i]);
    for (long k = 0; k < n; ++k) {
        real rates[STAGES], change[STAGES];
        memset(rates, 0, sizeof rates);
        memset(change, 0, sizeof change);
        MODEL(recalled_rates)(b, recalling, k, rates, change);
        r->by_step[k] = m->rates[(STAGES - 1) * n + k];
        for (long i = 0; i < STAGES; ++i) {
            real guess = zero, more = zero;
            for (long j = 0; j < STAGES; ++j) {
                guess += weight[i][j] * rates[j];
                more += weight[i][j] * change[j];
            }
            r->guess[i * n + k] = chosen(recalling, guess, r->guess[i * n + k]);
            m->rates[i * n + k] = chosen(repeating, guess + growth * more, m->rates[i * n + k]);
            r->more[k] = more; /* at last that of the last stage */
        }
    }
}

/*
 * Decide in some lanes which prediction of the last stage's rates was better; and by which factor the change from
 * passage to passage has grown.
 */
static void MODEL(compare_predictions)(MODEL(batch) *b, real h, mask where)
{
    const MODEL(block) *m = &b->m;
    const MODEL(repeats) *const r = &b->repeats;
    const long last = (STAGES - 1) * m->n;
    real by_kept = zero, by_step = zero, both = zero, before = zero, growth = zero;
    for (int lane = 0; lane < REAL_WIDTH; ++lane)
        LANE(&growth, 0, lane) = b->lane[lane].growth;
    for (long k = 0; k < m->n && any(where); ++k) {
        const real found = m->rates[last + k], per = 1.0 / (m->largest[k] + size_of(m->x[k]) + 1e-300);
        const real changed = per * (found - r->guess[last + k]), expected = per * r->more[k];
        by_kept = largest_of(size_of(changed - growth * expected), by_kept);
        by_step = largest_of(size_of(per * (found - r->by_step[k])), by_step);
        both += changed * expected;
        before += expected * expected;
    }
    const mask better = (by_kept < BETTER * by_step) | (h * by_kept <= wide(NO_MATTER * b->tolerance));
    for (int lane = 0; lane < REAL_WIDTH; ++lane) {
        if (!IN(where, lane))
            continue;
        const double grown = LANE(&both, 0, lane) / LANE(&before, 0, lane);
        b->lane[lane].repeats = IN(better, lane) != 0;
        b->lane[lane].growth = grown >= 0.0 ? MODEL(lesser)(grown, FASTEST_GROWTH) : grown < 0.0 ? 0.0 : 1.0;
    }
}
