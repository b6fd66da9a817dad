/*
 * What path functionals give to the stages of a step, and at a point. Comes after stop.c.
 */

/* At a single point, an inner state so near to its limit, relative to it, has reached it. */
#define AT_LIMIT 1e-9

/*
 * What lanes of a bank with one drive have in common: the rates of their coordinate at the stages, its
 * change up to each, and its least and its largest; where it does not turn, whether it rises.
 */
typedef struct {
    real h, rate[STAGES], at_stage[STAGES], least, largest;
    mask turns, rises;
} MODEL(course);

/* The course of a coordinate, whose ways are given in each lane of a number. */
static MODEL(course) MODEL(course_of)(MODEL(way) *w, real h)
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

/*
 * The lanes of a bank in which z follows C all the way, or yields all the way: in closed form. The share
 * of others becomes negative.
 */
static void MODEL(in_closed_form)(const MODEL(block) *m, const MODEL(course) *c, long lanes,
                                  const real *restrict z, const real *restrict parameter,
                                  real *restrict given, real *restrict rates)
{
    const real *const k = parameter + STIFFNESS * lanes, *const r = parameter + LIMIT * lanes;
    const real side = chosen(c->rises, wide(1.0), wide(-1.0));
    real *const share = given + SHARE * lanes;
    for (long j = 0; j < lanes; ++j) {
        const mask follows = (z[j] + c->largest <= r[j]) & (z[j] + c->least >= -r[j]);
        const mask yields = (size_of(z[j] - side * r[j]) <= PUT_THERE * r[j]) & none_of(c->turns);
        share[j] = chosen(follows, wide(1.0), chosen(yields, zero, wide(-1.0)));
    }
    for (long i = 0; i < STAGES; ++i) {
        real *const row = given + i * m->given, *const rate = rates + i * m->n;
        for (long j = 0; j < lanes; ++j) {
            const mask yields = share[j] == 0.0;
            const real limit = side * r[j], put = (limit - z[j]) / c->h;
            const real effort = k[j] * chosen(yields, limit, z[j] + c->at_stage[i]);
            row[EFFORT * lanes + j] = effort;
            row[SLIP * lanes + j] = chosen(yields, c->rate[i] - put, zero);
            row[HEAT * lanes + j] = chosen(yields, effort * c->rate[i], zero);
            row[SHARE * lanes + j] = share[j];
            rate[j] = chosen(yields, put, c->rate[i]);
        }
    }
}

/* Compute stops of one coordinate, lanes `which` of a bank, in one lane of numbers. */
static void MODEL(along_path)(const MODEL(block) *m, MODEL(way) *w, MODEL(stops) *s, const long *which,
                              long lanes, int lane, const real *z, const real *parameter, real *given,
                              real *rates)
{
    for (long k = 0; k < s->count; ++k) {
        s->z[k] = LANE(z, which[k], lane);
        s->k[k] = LANE(parameter, STIFFNESS * lanes + which[k], lane);
        s->r[k] = LANE(parameter, LIMIT * lanes + which[k], lane);
    }
    MODEL(stop)(w, s);
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
static void MODEL(along_others)(const MODEL(block) *m, MODEL(way) *w, long lanes, int lane,
                                const real *z, const real *parameter, real *given, real *rates)
{
    MODEL(stops) some;
    long which[SOME];
    some.count = 0;
    for (long j = 0; j < lanes; ++j) {
        which[some.count] = j;
        some.count += LANE(given, SHARE * lanes + j, lane) < 0.0;
        if (some.count == SOME || (j + 1 == lanes && some.count)) {
            MODEL(along_path)(m, w, &some, which, lanes, lane, z, parameter, given, rates);
            some.count = 0;
        }
    }
}

/* Each lane of a bank by itself, from drive number `drive` on: each has a way of its own if `own`. */
static void MODEL(along_each)(const MODEL(block) *m, MODEL(way) *w, long drive, int own, long lanes,
                              int lane, const real *z, const real *parameter, real *given, real *rates)
{
    MODEL(stops) one;
    one.count = 1;
    for (long j = 0; j < lanes; ++j) {
        if (j && own)
            MODEL(find_way)(m, w->h, drive + j, lane, w);
        MODEL(along_path)(m, w, &one, &j, lanes, lane, z, parameter, given, rates);
    }
}

/* The drives at the stages. */
static void MODEL(find_drives)(const MODEL(block) *m, real h)
{
    for (long i = 0; i < STAGES; ++i) {
        MODEL(reach_of)(m, h, stage_reach[i], m->reached);
        MODEL(drives)(m->reached, m->mean + i * m->given, m->branch + i * m->branches,
                      m->u + i * m->inputs, &m->p, m->drive + i * m->drives);
    }
}

/*
 * What path functionals give to the stages. Rates of inner states are set, not solved for: efforts
 * follow from the drives alone, and Newton's method takes them as stiffness * z.
 */
static void MODEL(along_paths)(const MODEL(block) *m, real h)
{
    const real *parameter = m->path;
    real *given = m->mean + m->means;
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
        MODEL(way) w[REAL_WIDTH];
        for (int lane = 0; lane < REAL_WIDTH; ++lane) {
            MODEL(find_way)(m, OF(h, lane), drive, lane, w + lane);
            w[lane].yields = LANE(m->yield, EARLIEST, lane);
            w[lane].times = LANE(m->yield, HOW_OFTEN, lane);
        }
        if (together) {
            const MODEL(course) c = MODEL(course_of)(w, h);
            MODEL(in_closed_form)(m, &c, lanes, z, parameter, given, rates);
        }
        for (int lane = 0; lane < REAL_WIDTH; ++lane) {
            MODEL(way) *const way = w + lane;
            if (together)
                MODEL(along_others)(m, way, lanes, lane, z, parameter, given, rates);
            else
                MODEL(along_each)(m, way, drive, path[OWN], lanes, lane, z, parameter, given, rates);
            LANE(m->yield, EARLIEST, lane) = way->yields;
            LANE(m->yield, HOW_OFTEN, lane) = way->times;
        }
        given += GIVEN * lanes, parameter += PARAMETERS * lanes;
        drive += path[OWN] ? lanes : 1;
    }
}

/*
 * Slip and heat at an end of a step, extrapolated from the stages' means; but for the part of the step in
 * which it yields, slip follows the drive there: an inner state that does not move has no misfit.
 */
static void MODEL(of_stages)(const MODEL(block) *m, const double *weight, long lanes, const real *drives,
                             real *given)
{
    const real *mean = m->mean + (given - m->node);
    const real yields = 1.0 - mean[SHARE * lanes];
    real slip = yields * drives[STAGES * m->drives], heat = zero;
    for (long i = 0; i < STAGES; ++i, mean += m->given) {
        slip += weight[i] * (mean[SLIP * lanes] - yields * drives[i * m->drives]);
        heat += weight[i] * mean[HEAT * lanes];
    }
    given[SLIP * lanes] = slip;
    given[HEAT * lanes] = heat;
}

/*
 * A stop where it stands: at its limit it yields if its coordinate goes on outward. In the middle of a
 * survey's step, which begins at `begin`: halfway to where the present rate leads it.
 */
static inline void MODEL(stand)(const MODEL(block) *m, real inner, real begin, real rate, real k, real r,
                                long lanes, real *given)
{
    const mask on = m->surveyed > 0.0;
    const real went = chosen(on, begin + m->surveyed * rate, inner);
    const real end = least(largest_of(went, -r), r), z = chosen(on, 0.5 * (begin + end), end);
    const mask at_limit = (size_of(z) >= r * (1.0 - AT_LIMIT)) & ((z * rate > 0.0) | (r <= 0.0));
    const mask beyond = size_of(went) > r;
    const mask yields = (on & beyond) | (none_of(on) & at_limit);
    const real slip = chosen(on, rate - (end - begin) / m->surveyed, rate);
    given[EFFORT * lanes] = k * z;
    given[SLIP * lanes] = chosen(yields, slip, zero);
    given[HEAT * lanes] = chosen(yields, k * z * slip, zero);
    given[SHARE * lanes] = chosen(yields, zero, wide(1.0));
}

/* What path functionals give at a point: it follows from the drives there, or `of_stages` (`weight`). */
static void MODEL(standing)(const MODEL(block) *m, const real *x, const real *branch, const real *u,
                            const double *weight)
{
    const real *parameter = m->path;
    real *given = m->node + m->means;
    long drive = 0;
    MODEL(path_parameters)(x, &m->p, m->path);
    MODEL(drives)(x, m->node, branch, u, &m->p, m->drive + STAGES * m->drives);
    for (long n = 0; n < PATHS; ++n) {
        const int *path = MODEL(path)[n];
        const long lanes = path[BANK] < 0 ? 1 : m->lanes[path[BANK]];
        for (long j = 0; j < lanes; ++j) {
            const long row = m->first[path[INNER]] + j;
            const real k = parameter[STIFFNESS * lanes + j], r = parameter[LIMIT * lanes + j];
            const real *const drives = m->drive + drive + path[OWN] * j;
            MODEL(stand)(m, x[row], m->x[row], drives[STAGES * m->drives], k, r, lanes, given + j);
            if (weight)
                MODEL(of_stages)(m, weight, lanes, drives, given + j);
        }
        given += GIVEN * lanes, parameter += PARAMETERS * lanes;
        drive += path[OWN] ? lanes : 1;
    }
}
