/*
 * A survey of runs by rough midpoint steps finds the largest magnitude of each state, by which errors are
 * measured. Comes after batch.c.
 */

enum { ROUGH_ITERATIONS = 8 };
/*
 * The relative change after which Newton's method is done in a survey, as the next would be its square; and the
 * shortest step of a survey, as a fraction of the longest.
 */
#define ROUGH 3e-2
#define SHORTEST 1e-6
/* The most steps of a survey; later magnitudes count when the run itself reaches them. */
enum { MOST_SURVEYED = 10000 };
/*
 * Under sines of one frequency motions settle: after so many periods, once no magnitude has grown by more than GROWTH
 * in the second half of the time, a survey leaps over periods. Entropies of bodies do not count, as they grow as long
 * as there is heat: a leap adds what they gained in the period before, for each of its periods, but no more than the
 * part MOST_GAINED of all that they have gained. So where they stop growing, no leap goes much farther.
 */
#define PERIODS 4.0
#define GROWTH 0.01
#define MOST_GAINED 0.5

/* Midpoint steps of length h by Newton's method, midpoints in m->reached; returns the lanes that succeed. */
static mask MODEL(midpoint)(MODEL(batch) *b, real h, mask where)
{
    MODEL(block) *m = &b->m;
    mask going = where;
    memcpy(m->reached, m->x, (size_t)m->n * sizeof(real));
#if defined(PATHS)
    m->surveyed = h;
#endif
    for (int iteration = 0; iteration < ROUGH_ITERATIONS && any(going); ++iteration) {
        real worst = zero;
        m->iterations += chosen(going, wide(1.0), zero);
        for (int again = 0; again < 3; ++again) {
            MODEL(point)(b, m->reached, m->branch, NULL, b->some_rate, b->some_side);
            if (!any(MODEL(choose)(m->branches, b->some_side, m->branch, going)))
                break;
        }
        MODEL(slopes)(m->reached, m->node, m->branch, b->some_inputs, &m->p, m->slope);
        MODEL(factorise_real)(m, 0.5 * h, m->slope, m->real_factor);
        for (long k = 0; k < m->n; ++k)
            b->some_rate[k] = m->x[k] + 0.5 * h * b->some_rate[k] - m->reached[k];
        MODEL(solve_real)(m, 0.5 * h, m->slope, m->real_factor, ALL, b->some_rate);
        for (long k = 0; k < m->n; ++k) {
            const real change = chosen(going, b->some_rate[k], zero);
            m->reached[k] += change;
            worst = largest_of(size_of(change) / (m->largest[k] + size_of(m->reached[k]) + 1e-300), worst);
        }
        const mask far = worst > ROUGH, lost = worst != worst;
        where &= none_of(lost & going);
        going &= far;
    }
#if defined(PATHS)
    m->surveyed = zero;
#endif
    return where & MODEL(within)(b->some_margin) & none_of(going);
}

/*
 * Prepare a lane for the next step of its survey; returns whether there is one. After a failed step, a shorter
 * one begins at the midpoint of the step before: there fast modes do not ring. At the ends of steps too long for
 * them they do, with an amplitude that short steps would take for a motion.
 */
static int MODEL(go_on_surveying)(MODEL(batch) *b, int lane, double longest, int good)
{
    MODEL(lane) *l = b->lane + lane;
    const double stop = MODEL(until)(b, l);
    if (!good) {
        l->t -= 0.5 * l->known;
        l->known = 0.0;
        l->h *= 0.25;
        return l->h > longest * SHORTEST;
    }
    l->known = l->h;
    l->t = l->t + l->h < stop - 1e-9 * l->h ? l->t + l->h : stop;
    l->h = MODEL(lesser)(2.0 * l->h, longest);
    if (l->t >= stop && l->t < b->stop) {
        MODEL(enter)(b->waves, ++l->segment, b->m.inputs, lane);
        l->known = 0.0;
    }
    return l->t < b->stop;
}

/* The period of a lane's inputs [s]: sines of one frequency up to the end of the run; else HUGE_VAL. */
static double MODEL(period)(const MODEL(batch) *b, int lane)
{
    double frequency = 0.0;
    int one = b->lane[lane].segment->stop >= b->stop;
    for (long k = 0; k < b->m.inputs; ++k) {
        const MODEL(wave) *const w = b->waves + k;
        const double its = fabs(LANE(&w->frequency, 0, lane));
        if (LANE(&w->amplitude, 0, lane) != 0.0) {
            one &= frequency == 0.0 || frequency == its;
            frequency = its;
        }
        one &= LANE(&w->others, 0, lane) == 0.0 && LANE(&w->rate, 0, lane) == 0.0;
    }
    return one && frequency > 0.0 ? 1.0 / frequency : HUGE_VAL;
}

/* Whether a state is the entropy of a body. */
static int MODEL(is_entropy)(const MODEL(block) *m, long k)
{
    int found = 0;
    (void)m, (void)k;
#if defined(COSTATES)
    for (long j = 0; j < MODEL(bodies); ++j) {
        const long record = MODEL(body)[j];
        found |= k >= m->first[record] && k < (record + 1 < MODEL(records) ? m->first[record + 1] : m->n);
    }
#endif
    return found;
}

/* When the magnitude of a state last grew: since `counted`, which follows, by more than GROWTH. */
static void MODEL(watch_growth)(mask where, real t, real size, real *counted, real *grew_at)
{
    const mask grows = where & (size > (1.0 + GROWTH) * *counted);
    *counted = chosen(grows, size, *counted);
    *grew_at = chosen(grows, t, *grew_at);
}

/* How far a lane may leap [s], after a period from the time `since`, when its states were those in `b->known`. */
static double MODEL(leap_length)(const MODEL(batch) *b, int lane, double since)
{
    const MODEL(lane) *l = b->lane + lane;
    double most = b->stop - l->t;
    for (long k = 0; k < b->m.n; ++k) {
        const double x = LANE(b->m.x, k, lane), gained = fabs(x - LANE(b->known, k, lane));
        if (MODEL(is_entropy)(&b->m, k) && gained > 0.0)
            most = MODEL(lesser)(most, MOST_GAINED * fabs(x - l->run->x[k]) / gained * (l->t - since));
    }
    return most;
}

/* Let a lane leap over periods once it has gone through one from the time `since` on; -HUGE_VAL: it has not begun. */
static void MODEL(leap)(MODEL(batch) *b, int lane, double period, double *since)
{
    MODEL(block) *m = &b->m;
    MODEL(lane) *l = b->lane + lane;
    const double took = l->t - *since;
    double leap = 0.0;
    if (took < (1.0 - 1e-9) * period)
        return;
    if (took < HUGE_VAL)
        leap = floor(MODEL(leap_length)(b, lane, *since) / period) * period;
    for (long k = 0; k < m->n; ++k) {
        double *const x = &LANE(m->x, k, lane), *const largest = &LANE(m->largest, k, lane);
        if (leap > 0.0 && MODEL(is_entropy)(m, k)) {
            *x += leap / took * (*x - LANE(b->known, k, lane));
            *largest = MODEL(greater)(fabs(*x), *largest);
        }
        LANE(b->known, k, lane) = *x;
    }
    l->t = MODEL(lesser)(l->t + leap, b->stop);
    l->known = leap > 0.0 ? 0.0 : l->known; /* no step goes back before it */
    *since = l->t;
}

/* Survey as many runs as there are lanes, from `first` on, by steps of at most this length. */
static void MODEL(survey_some)(MODEL(batch) *b, long first, double longest)
{
    MODEL(block) *m = &b->m;
    mask going = nowhere;
    double period[REAL_WIDTH], since[REAL_WIDTH], begin[REAL_WIDTH]; /* since when a lane goes through a period */
    real *const counted = b->some_left, grew_at = zero;
    for (int lane = 0; lane < REAL_WIDTH && first + lane < b->count; ++lane) {
        MODEL(load)(b, lane, b->runs + first + lane);
        b->lane[lane].h = longest;
        period[lane] = MODEL(period)(b, lane);
        since[lane] = -HUGE_VAL;
        begin[lane] = LANE(&grew_at, 0, lane) = b->lane[lane].t;
        SET(going, lane, 1);
    }
    memcpy(counted, m->largest, (size_t)m->n * sizeof(real));
    for (long step = 0; step < MOST_SURVEYED && any(going); ++step) {
        real h = zero;
        for (int lane = 0; lane < REAL_WIDTH; ++lane) {
            MODEL(lane) *l = b->lane + lane;
            if (!IN(going, lane))
                continue;
            l->h = MODEL(lesser)(l->h, MODEL(until)(b, l) - l->t);
            LANE(&h, 0, lane) = l->h;
        }
        const real t = MODEL(now)(b);
        MODEL(inputs_at)(b, going, t + 0.5 * h, b->some_inputs);
        const mask good = MODEL(midpoint)(b, h, going);
        mask back = nowhere;
        for (int lane = 0; lane < REAL_WIDTH; ++lane)
            SET(back, lane, IN(going, lane) && !IN(good, lane) && b->lane[lane].known > 0.0);
        for (long k = 0; k < m->n; ++k) {
            const real middle = m->reached[k];
            if (!MODEL(is_entropy)(m, k))
                MODEL(watch_growth)(good, t, size_of(middle), counted + k, &grew_at);
            m->largest[k] = chosen(good, largest_of(size_of(middle), m->largest[k]), m->largest[k]);
            m->x[k] = chosen(good, 2.0 * middle - m->x[k], chosen(back, b->kept[k], m->x[k]));
            b->kept[k] = chosen(good, middle, b->kept[k]);
        }
        for (int lane = 0; lane < REAL_WIDTH; ++lane)
            if (IN(going, lane)) {
                int more = MODEL(go_on_surveying)(b, lane, longest, IN(good, lane) != 0);
                const double took = b->lane[lane].t - begin[lane], grew_for = LANE(&grew_at, 0, lane) - begin[lane];
                if (more && IN(good, lane) && took > PERIODS * period[lane] && took > 2.0 * grew_for) {
                    MODEL(leap)(b, lane, period[lane], since + lane);
                    more = b->lane[lane].t < b->stop;
                }
                SET(going, lane, more);
            }
    }
    for (int lane = 0; lane < REAL_WIDTH && first + lane < b->count; ++lane) {
        for (long k = 0; k < m->n; ++k)
            b->runs[first + lane].largest[k] = LANE(m->largest, k, lane);
        b->lane[lane].phase = IDLE;
    }
}

/* Find how large the states of all runs become, by steps of at most this length. */
void MODEL(survey)(MODEL(batch) *b, double longest);
void MODEL(survey)(MODEL(batch) *b, double longest)
{
    for (long first = 0; first < b->count; first += REAL_WIDTH)
        MODEL(survey_some)(b, first, longest);
}
