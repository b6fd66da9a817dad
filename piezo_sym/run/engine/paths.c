/* The values of path functionals at the stages of a step, and at a point. Comes after stop.c. */

/* At a single point, an inner state this close to its limit, relative to it, counts as at it. */
#define AT_LIMIT 1e-9

/*
 * The course of a coordinate that lanes of a bank share: its rates at the stages, its change up to
 * each stage, its least and largest change; whether it turns, and if not, whether it rises.
 */
typedef struct {
    real h, rate[STAGES], at_stage[STAGES], least, largest;
    mask turns, rises;
} MODEL(course);

/* The course of a coordinate, given in each lane of a number. */
static MODEL(course) MODEL(course_of)(MODEL(coordinate) *w, real h)
{
    MODEL(course) c = {.h = h, .least = zero, .largest = zero};
    real pieces = zero;
    for (int lane = 0; lane < REAL_WIDTH; ++lane, ++w) {
        MODEL(find_turns)(w);
        for (long i = 0; i < STAGES; ++i) {
            OF(c.rate[i], lane) = w->rate[i];
            OF(c.at_stage[i], lane) = w->at_stage[i];
        }
        for (long k = 1; k <= w->pieces; ++k) {
            const double at = MODEL(polynomial)(w->gone, STAGES, w->turn[k]);
            OF(c.least, lane) = at < OF(c.least, lane) ? at : OF(c.least, lane);
            OF(c.largest, lane) = at > OF(c.largest, lane) ? at : OF(c.largest, lane);
        }
        OF(pieces, lane) = (double)w->pieces;
    }
    c.turns = pieces > 1.0;
    c.rises = c.largest > 0.0;
    return c;
}

/* The share, as in stop.c: 1 where z follows C all the way, 0 where it yields all the way, else -1. */
static inline real MODEL(share_of)(const MODEL(course) *c, real limit, real z, real r)
{
    const real neither = wide(-1.0), far = chosen(c->turns, neither, wide(PUT_THERE));
    const real outside = chosen(size_of(z - limit) <= far * r, zero, neither);
    const real above = chosen(z + c->largest <= r, wide(1.0), outside);
    return chosen(z + c->least >= -r, above, outside);
}

/*
 * What lanes of a bank give to stage i, where z follows C all the way, or yields all the way: in closed form.
 * Returns how many other lanes there are; their share becomes negative. The first stage finds the shares.
 */
static inline real MODEL(stage_in_closed_form)(const MODEL(block) *m, const MODEL(course) *c, long lanes, long i,
                                               const real *restrict z, const real *restrict parameter,
                                               real *first_given, real *restrict rate,
                                               real *restrict follows)
{
    const real *restrict const k = parameter + STIFFNESS * lanes;
    const real *restrict const r = parameter + LIMIT * lanes;
    real *restrict const effort = first_given + i * m->given + EFFORT * lanes;
    real *restrict const slip = first_given + i * m->given + SLIP * lanes;
    real *restrict const heat = first_given + i * m->given + HEAT * lanes;
    real *restrict const share = first_given + i * m->given + SHARE * lanes;
    const real *const found = first_given + SHARE * lanes;
    const real side = chosen(c->rises, wide(1.0), wide(-1.0)), per = 1.0 / c->h;
    const real drive = c->rate[i], at_stage = c->at_stage[i];
    real others = zero;
#pragma omp simd reduction(+ : others)
    for (long j = 0; j < lanes; ++j) {
        const real limit = side * r[j], put = (limit - z[j]) * per;
        const real part = i ? found[j] : MODEL(share_of)(c, limit, z[j], r[j]);
        const real there = z[j] + at_stage, yields = chosen(part == 0.0, wide(1.0), zero);
        const real force = k[j] * chosen(part == 0.0, limit, there);
        share[j] = part;
        if (!i)
            follows[j] = part;
        effort[j] = force;
        slip[j] = yields * (drive - put);
        heat[j] = yields * (force * drive);
        rate[j] = chosen(part == 0.0, put, drive);
        others += chosen(part < 0.0, wide(1.0), zero);
    }
    return others;
}

/* The same for all stages. */
static real MODEL(in_closed_form)(const MODEL(block) *m, const MODEL(course) *c, long lanes, const real *z,
                                  const real *parameter, real *given, real *rates, real *follows)
{
    const real others = MODEL(stage_in_closed_form)(m, c, lanes, 0, z, parameter, given, rates, follows);
    for (long i = 1; i < STAGES; ++i)
        MODEL(stage_in_closed_form)(m, c, lanes, i, z, parameter, given, rates + i * m->n, follows);
    return others;
}

/* Compute stops of one coordinate, lanes `which` of a bank, in one lane of numbers. */
static void MODEL(along_path)(const MODEL(block) *m, MODEL(coordinate) *w, MODEL(stops) *s, const long *which,
                              long lanes, int lane, const real *z, const real *parameter, real *given,
                              real *rates, real *follows)
{
    for (long k = 0; k < s->count; ++k) {
        s->z[k] = LANE(z, which[k], lane);
        s->k[k] = LANE(parameter, STIFFNESS * lanes + which[k], lane);
        s->r[k] = LANE(parameter, LIMIT * lanes + which[k], lane);
    }
    MODEL(stop)(w, s);
    for (long k = 0; k < s->count; ++k)
        LANE(follows, which[k], lane) = s->follows[k];
    for (long i = 0; i < STAGES; ++i)
        for (long k = 0; k < s->count; ++k) {
            const long j = which[k];
            for (long what = 0; what < SHARE; ++what)
                LANE(given + i * m->given, what * lanes + j, lane) = s->mean[what][i][k];
            LANE(given + i * m->given, SHARE * lanes + j, lane) = s->share[k];
            LANE(rates, i * m->n + j, lane) = w->rate[i] - s->mean[SLIP][i][k];
        }
}

/* The same for those of a bank's lanes that are not in closed form: their share is negative. */
static void MODEL(along_others)(const MODEL(block) *m, MODEL(coordinate) *w, long lanes, int lane,
                                const real *z, const real *parameter, real *given, real *rates, real *follows)
{
    const real *const share = given + SHARE * lanes;
    MODEL(stops) some;
    long which[SOME];
    some.count = 0;
    for (long j = 0; j < lanes; j += SEEN) {
        const long end = j + SEEN < lanes ? j + SEEN : lanes;
        double others = 0.0;
#pragma omp simd reduction(+ : others)
        for (long k = j; k < end; ++k)
            others += LANE(share, k, lane) < 0.0 ? 1.0 : 0.0;
        for (long k = j; others > 0.0 && k < end; ++k) {
            which[some.count] = k;
            some.count += LANE(share, k, lane) < 0.0;
        }
        if (some.count + SEEN > SOME || (end == lanes && some.count)) {
            MODEL(along_path)(m, w, &some, which, lanes, lane, z, parameter, given, rates, follows);
            some.count = 0;
        }
    }
}

/* Each lane of a bank by itself, from drive number `drive` on: each has a coordinate of its own if `own`. */
static void MODEL(along_each)(const MODEL(block) *m, MODEL(coordinate) *w, long drive, int own, long lanes,
                              int lane, const real *z, const real *parameter, real *given, real *rates,
                              real *follows)
{
    MODEL(stops) one;
    one.count = 1;
    for (long j = 0; j < lanes; ++j) {
        if (j && own)
            MODEL(find_coordinate)(m, w->h, drive + j, lane, w);
        MODEL(along_path)(m, w, &one, &j, lanes, lane, z, parameter, given, rates, follows);
    }
}

/* The states that Newton's method solves for, at a point of the step. */
static void MODEL(reach_solved)(const MODEL(block) *m, real h, const double *weight, real *restrict out)
{
    FOR_SOLVED (m, begin, end)
        for (long i = begin; i < end; ++i)
            out[i] = MODEL(reached_row)(m, h, weight, i);
}

/* The drives at the stages, which depend on no states but these. */
static void MODEL(find_drives)(const MODEL(block) *m, real h)
{
    for (long i = 0; i < STAGES; ++i) {
        MODEL(reach_solved)(m, h, stage_reach[i], m->reached);
        MODEL(drives)(m->reached, m->mean + i * m->given, m->branch + i * m->branches,
                      m->u + i * m->inputs, &m->p, m->drive + i * m->drives);
    }
}

/*
 * What path functionals give to the stages. Rates of inner states are set, not solved for: they follow
 * from the drives, and Newton's method takes efforts as stiffness * z.
 */
static void MODEL(along_paths)(const MODEL(block) *m, real h)
{
    const real *parameter = m->path;
    real *given = m->mean + m->means, *follows = m->follows;
    long drive = 0;
    m->yield[EARLIEST] = wide(1.0);
    m->yield[HOW_OFTEN] = zero;
    MODEL(find_drives)(m, h);
    for (long n = 0; n < PATHS; ++n) {
        const int *path = MODEL(path)[n];
        const long lanes = path[BANK] < 0 ? 1 : m->lanes[path[BANK]], first = m->first[path[INNER]];
        const real *const z = m->x + first;
        real *const rates = m->rates + first;
        const int together = !path[OWN] && lanes > 1;
        MODEL(coordinate) w[REAL_WIDTH];
        for (int lane = 0; lane < REAL_WIDTH; ++lane) {
            MODEL(find_coordinate)(m, OF(h, lane), drive, lane, w + lane);
            w[lane].yields = LANE(m->yield, EARLIEST, lane);
            w[lane].times = LANE(m->yield, HOW_OFTEN, lane);
        }
        real others = zero;
        if (together) {
            const MODEL(course) c = MODEL(course_of)(w, h);
            others = MODEL(in_closed_form)(m, &c, lanes, z, parameter, given, rates, follows);
        }
        for (int lane = 0; lane < REAL_WIDTH; ++lane) {
            MODEL(coordinate) *const coordinate = w + lane;
            if (OF(others, lane) > 0.0)
                MODEL(along_others)(m, coordinate, lanes, lane, z, parameter, given, rates, follows);
            else if (!together)
                MODEL(along_each)(m, coordinate, drive, path[OWN], lanes, lane, z, parameter, given, rates,
                                  follows);
            LANE(m->yield, EARLIEST, lane) = coordinate->yields;
            LANE(m->yield, HOW_OFTEN, lane) = coordinate->times;
        }
        given += GIVEN * lanes, parameter += PARAMETERS * lanes, follows += lanes;
        drive += path[OWN] ? lanes : 1;
    }
}

/*
 * Slip and heat at an end of a step, extrapolated from the stages' means; but for the part of the step in
 * which it yields, slip follows the drive there: an inner state that does not move has no misfit.
 */
static void MODEL(of_stages)(const MODEL(block) *m, const double *weight, long lanes, const real *drives,
                             const real *follows, int own, real *restrict given)
{
    const real *const mean = m->mean + (given - m->node);
#pragma omp simd
    for (long j = 0; j < lanes; ++j) {
        const real *const drive = drives + own * j;
        const real yields = 1.0 - follows[j];
        real slip = yields * drive[STAGES * m->drives], heat = zero;
        for (long i = 0; i < STAGES; ++i) {
            const real *const stage = mean + i * m->given + j;
            slip += weight[i] * (stage[SLIP * lanes] - yields * drive[i * m->drives]);
            heat += weight[i] * stage[HEAT * lanes];
        }
        given[SLIP * lanes + j] = slip;
        given[HEAT * lanes + j] = heat;
    }
}

/*
 * Stops where they stand: at its limit one yields if its coordinate goes on outward. In the middle of a
 * survey's step, which begins at m->x: halfway to where the present rate leads it.
 */
static void MODEL(stand)(const MODEL(block) *m, const real *restrict begin, const real *restrict parameter,
                         const real *drives, int own, long lanes, real *restrict given)
{
    const real h = m->surveyed, per = chosen(h > 0.0, 1.0 / h, zero), part = chosen(h > 0.0, wide(0.5), zero);
    real *restrict const slip = given + SLIP * lanes;
    for (long j = 0; j < lanes; ++j)
        slip[j] = drives[own * j];
#pragma omp simd
    for (long j = 0; j < lanes; ++j) {
        const real k = parameter[STIFFNESS * lanes + j], r = parameter[LIMIT * lanes + j], rate = slip[j];
        const real went = begin[j] + h * rate, below = chosen(went > r, r, went);
        const real end = chosen(below < -r, -r, below);
        const real z = part * begin[j] + (1.0 - part) * end;
        const real ahead = end * rate, outward = chosen(r > 0.0, ahead, wide(1.0));
        const real near = r * (1.0 - AT_LIMIT), out = chosen(size_of(end) >= near, outward, zero);
        const real yields = chosen(out > 0.0, wide(1.0), zero);
        const real slips = yields * (rate - (end - begin[j]) * per);
        given[EFFORT * lanes + j] = k * z;
        slip[j] = slips;
        given[HEAT * lanes + j] = k * z * slips;
        given[SHARE * lanes + j] = 1.0 - yields;
    }
}

/* What path functionals give at a point: it follows from the drives there, or `of_stages` (`weight`). */
static void MODEL(standing)(const MODEL(block) *m, const real *x, const real *branch, const real *u,
                            const double *weight)
{
    const real *parameter = m->path, *drives = m->drive, *follows = m->follows;
    real *given = m->node + m->means;
    MODEL(path_parameters)(x, &m->p, m->path);
    MODEL(drives)(x, m->node, branch, u, &m->p, m->drive + STAGES * m->drives);
    for (long n = 0; n < PATHS; ++n) {
        const int *path = MODEL(path)[n], own = path[OWN];
        const long lanes = path[BANK] < 0 ? 1 : m->lanes[path[BANK]], first = m->first[path[INNER]];
        const real *const begin = (any(m->surveyed > 0.0) ? m->x : x) + first;
        MODEL(stand)(m, begin, parameter, drives + STAGES * m->drives, own, lanes, given);
        if (weight)
            MODEL(of_stages)(m, weight, lanes, drives, follows, own, given);
        given += GIVEN * lanes, parameter += PARAMETERS * lanes, follows += lanes;
        drives += own ? lanes : 1;
    }
}
