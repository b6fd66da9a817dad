/*
 * The predictors of Newton's method: the rates of the step before, or recorded ones. Comes after trajectory.c.
 *
 * Many motions repeat, as under periodic inputs. What follows a switch is then much like what followed the same
 * switch the last time: the rates recorded there, with their change from one time to the next, predict those of
 * new steps better than the step before does. Which prediction was better in a step decides for the next one.
 */

/* Steps are recorded if those of a run take more iterations than this: few are not worth the copies of rates. */
#define LABORIOUS 2.5
/* The fraction of its length by which a recorded step may be extrapolated at either end. */
#define EXTENDED 0.25
/* The most by which the change from one time to the next may grow, as a factor. */
#define FASTEST_DRIFT 2.0
/* A recorded step predicts better if it is off by less than this part of the other prediction: chance is left out. */
#define BETTER 0.1
/* It is as good as the other if it is off by less than this part of the tolerance. */
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

/* A state that rings takes the same course in a step of any length, from the other side if STAGES is odd. */
static void MODEL(predict_ringing)(const MODEL(batch) *b, real behind, real slope, mask known)
{
    const MODEL(block) *m = &b->m;
    const mask turns = STAGES % 2 ? (mask)(behind > 0.5) : nowhere;
    const real ratio = chosen(turns, wide(-1.0), wide(1.0)) / slope;
    for (long i = 0; i < STAGES; ++i)
        for (long k = 0; k < m->n; ++k) {
            const mask rings = known & b->ringing & (b->rings[k] > 0.0);
            m->rates[i * m->n + k] = chosen(rings, ratio * b->known[i * m->n + k], m->rates[i * m->n + k]);
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
    if (any(known & b->ringing))
        MODEL(predict_ringing)(b, behind, slope, known);
}

/* The place of a recorded step, by its number in the run. */
static long MODEL(place_of_step)(const MODEL(history) *past, long number)
{
    return number % past->steps;
}

/* A lane's run passes a switch: tell whether steps are recorded from now on, and which are to be recalled. */
static void MODEL(recall_passage)(MODEL(batch) *b, MODEL(lane) *l, int lane)
{
    double *const first = &LANE(b->past.first, l->passing, lane);
    if (b->past.steps && !b->tape && l->iterations > LABORIOUS * (double)(l->run->steps + l->run->rejected))
        l->records = 1; /* until the run ends */
    l->recalled = l->records && *first >= 0.0 && *first < (double)l->recorded ? (long)*first : -1;
    *first = l->records ? (double)l->recorded : -1.0;
}

/* Record the step that ends now. */
static void MODEL(record_step)(MODEL(batch) *b, int lane)
{
    const MODEL(history) *const past = &b->past;
    MODEL(lane) *l = b->lane + lane;
    if (!l->records)
        return;
    const long place = MODEL(place_of_step)(past, l->recorded++), size = STAGES * b->m.n;
    real *const rates = past->rates + place * size, *const change = past->change + place * size;
    LANE(past->begin, place, lane) = l->t - l->passed;
    LANE(past->length, place, lane) = l->step;
    for (long k = 0; k < size; ++k) {
        const double found = LANE(b->known, k, lane);
        LANE(rates, k, lane) = found;
        LANE(change, k, lane) = l->recalls ? found - LANE(past->aligned, k, lane) : 0.0;
    }
}

/* Go on to the recorded step of the same passage in which a time after the switch lies, or to the last one. */
static long MODEL(seek_recorded)(const MODEL(history) *past, MODEL(lane) *l, int lane, double time)
{
    long place = MODEL(place_of_step)(past, l->recalled);
    while (l->recalled + 1 < l->recorded) {
        const double begin = LANE(past->begin, place, lane), length = LANE(past->length, place, lane);
        const long next = MODEL(place_of_step)(past, l->recalled + 1);
        if (begin + length >= time || LANE(past->begin, next, lane) < begin + 0.5 * length)
            break; /* the next one follows another switch */
        place = next;
        ++l->recalled;
    }
    return place;
}

/*
 * Whether a lane's next step recalls a recorded one, which lies likewise after the same switch. `ahead` and `ratio`
 * are where the new step begins and how long it is, in lengths of the recorded one.
 */
static int MODEL(recalls)(MODEL(batch) *b, int lane, double *ahead, double *ratio)
{
    const MODEL(history) *const past = &b->past;
    MODEL(lane) *l = b->lane + lane;
    if (l->recalled < 0 || l->phase != STEP || l->refused || l->settled || IN(b->m.over, lane))
        return 0;
    if (l->recorded - l->recalled > past->steps) /* it has been overwritten */
        return 0;
    const double begin = l->t - l->passed;
    const long place = MODEL(seek_recorded)(past, l, lane, begin + 0.5 * l->length);
    const double length = LANE(past->length, place, lane);
    *ahead = (begin - LANE(past->begin, place, lane)) / length;
    *ratio = l->length / length;
    return *ahead >= -EXTENDED && *ahead + *ratio <= 1.0 + EXTENDED;
}

/* The stage rates of one state in the steps that lanes recall, and how they changed from one passage to the next. */
static void MODEL(recalled_rates)(const MODEL(batch) *b, mask recalling, long k, real *rates, real *change)
{
    const MODEL(history) *const past = &b->past;
    const long n = b->m.n;
    for (int lane = 0; lane < REAL_WIDTH; ++lane) {
        if (!IN(recalling, lane))
            continue;
        const long first = MODEL(place_of_step)(past, b->lane[lane].recalled) * STAGES * n + k;
        for (long j = 0; j < STAGES; ++j) {
            LANE(rates, j, lane) = LANE(past->rates, first + j * n, lane);
            LANE(change, j, lane) = LANE(past->change, first + j * n, lane);
        }
    }
}

/*
 * The rates of steps by those that they recall: predictions in lanes where `better`; in the others, m.rates stay,
 * and both are compared later. The change from one time to the next grows as it did in the step before.
 */
static void MODEL(predict_by_history)(MODEL(batch) *b, real ahead, real ratio, mask recalling, mask better)
{
    const MODEL(block) *m = &b->m;
    const MODEL(history) *const past = &b->past;
    const long n = m->n;
    real weight[STAGES][STAGES], drift = zero;
    for (int lane = 0; lane < REAL_WIDTH; ++lane)
        LANE(&drift, 0, lane) = b->lane[lane].drift;
    for (long i = 0; i < STAGES; ++i)
        MODEL(rate_weights)(ahead + ratio * stage_at[i], weight[i]);
    for (long k = 0; k < n; ++k) {
        real rates[STAGES], change[STAGES], last_change = zero;
        memset(rates, 0, sizeof rates);
        memset(change, 0, sizeof change);
        MODEL(recalled_rates)(b, recalling, k, rates, change);
        past->by_step[k] = m->rates[(STAGES - 1) * n + k];
        for (long i = 0; i < STAGES; ++i) {
            real aligned = zero, more = zero;
            for (long j = 0; j < STAGES; ++j) {
                aligned += weight[i][j] * rates[j];
                more += weight[i][j] * change[j];
            }
            past->aligned[i * n + k] = chosen(recalling, aligned, past->aligned[i * n + k]);
            m->rates[i * n + k] = chosen(better, aligned + drift * more, m->rates[i * n + k]);
            last_change = more;
        }
        past->last_change[k] = last_change;
    }
}

/*
 * Learn in some lanes which prediction of the last stage was better, and by how much the change from one time to
 * the next has grown.
 */
static void MODEL(compare_predictions)(MODEL(batch) *b, real h, mask where)
{
    const MODEL(block) *m = &b->m;
    const MODEL(history) *const past = &b->past;
    const long last = (STAGES - 1) * m->n;
    real by_history = zero, by_step = zero, both = zero, before = zero, drift = zero;
    if (!any(where))
        return;
    for (int lane = 0; lane < REAL_WIDTH; ++lane)
        LANE(&drift, 0, lane) = b->lane[lane].drift;
    for (long k = 0; k < m->n; ++k) {
        const real found = m->rates[last + k], per = 1.0 / (m->largest[k] + size_of(m->x[k]) + 1e-300);
        const real changed = per * (found - past->aligned[last + k]), expected = per * past->last_change[k];
        by_history = largest_of(size_of(changed - drift * expected), by_history);
        by_step = largest_of(size_of(per * (found - past->by_step[k])), by_step);
        both += changed * expected;
        before += expected * expected;
    }
    const mask better = (by_history < BETTER * by_step) | (h * by_history <= wide(NO_MATTER * b->tolerance));
    for (int lane = 0; lane < REAL_WIDTH; ++lane) {
        if (!IN(where, lane))
            continue;
        const double grown = LANE(&both, 0, lane) / LANE(&before, 0, lane); /* nan without a change */
        b->lane[lane].repeats = IN(better, lane) != 0;
        b->lane[lane].drift = grown >= 0.0 ? MODEL(lesser)(grown, FASTEST_DRIFT) : grown < 0.0 ? 0.0 : 1.0;
    }
}
