/*
 * Sign changes of switching functions within a step: whether there are any, the first one, and
 * where it is. Comes after trajectory.c.
 */

/* A sign change of a switching function: it lies between two fractions of the step, with these values. */
typedef struct {
    long which;
    double low, high, at_low, at_high;
    int guessed; /* whether the value at `high` is only interpolated */
    int several; /* whether another function changes its sign elsewhere in the step */
} MODEL(crossing);

/* Points of a step at which a switching function is evaluated: its begin, stages, end, and some between. */
enum { LOOKS = 1 + PARTS * (STAGES + 1) };

/* Evaluate switching function k, positive while its branch holds; returns lanes that may switch. */
static mask MODEL(looks)(const MODEL(batch) *b, long k, real *value)
{
    real low = wide(HUGE_VAL), high = wide(-HUGE_VAL);
    const MODEL(block) *m = &b->m;
    const mask on = m->branch[k] > 0.0;
    const real turn = chosen(on, wide(1.0), wide(-1.0));
    for (long i = 0; i <= STAGES + 1; ++i) {
        const real side = i == 0 ? b->side[k]
            : i <= STAGES        ? m->side[(i - 1) * m->branches + k]
                                 : b->end_side[k];
        value[i * PARTS] = turn * side;
        low = least(value[i * PARTS], low);
        high = largest_of(value[i * PARTS], high);
    }
    const mask near = low < high - low; /* else the values are too far from zero */
    if (!any(near))
        return near;
    for (long i = 0; i <= STAGES; ++i)
        for (long part = 1; part < PARTS; ++part) {
            const double *weight = from_others[i * (PARTS - 1) + part - 1];
            real sum = zero;
            for (long j = 0; j <= STAGES + 1; ++j)
                sum += weight[j] * value[j * PARTS];
            value[i * PARTS + part] = sum;
        }
    return near;
}

/* The first sign change of switching function k in a lane; `values` are positive while its branch holds. */
static MODEL(crossing) MODEL(sign_change)(long k, const real *values, int lane)
{
    double at = 0.0, value = MODEL(greater)(LANE(values, 0, lane), 0.0);
    for (long i = 1; i < LOOKS; ++i) {
        const long stage = i / PARTS, part = i % PARTS;
        const double next = part ? between[stage * (PARTS - 1) + part - 1]
            : stage <= STAGES    ? stage_at[stage - 1]
                                 : 1.0;
        const double side = LANE(values, i, lane);
        if (side < 0.0)
            return (MODEL(crossing)){k, at, next, value, side, part != 0, 0};
        at = next, value = side;
    }
    return (MODEL(crossing)){-1, 0.0, 1.0, 0.0, 0.0, 0, 0};
}

/* The fraction of the step at which a sign change is, by linear interpolation. */
static double MODEL(place_of)(const MODEL(crossing) *c)
{
    return c->low + (c->high - c->low) * (c->at_low / (c->at_low - c->at_high));
}

/*
 * The lanes in which a switching function changes its sign within the step, and the first change of each. Changes
 * of functions as small as round-off are left out, and their lanes are in `slight`, unless that is NULL.
 */
static mask MODEL(signs_change)(const MODEL(batch) *b, mask where, MODEL(crossing) *first, mask *slight)
{
    mask found = nowhere;
    for (long k = 0; k < b->m.branches && any(where); ++k) {
        real values[LOOKS], largest = zero;
        mask now = where & MODEL(looks)(b, k, values), changes = nowhere;
        for (long i = 0; i < LOOKS && any(now); ++i) {
            if (i > 0)
                changes |= values[i] < 0.0;
            largest = largest_of(size_of(values[i]), largest);
        }
        now &= changes;
        if (slight && any(now)) {
            const mask small = now & (largest < NO_SWITCH * b->widest[k]);
            *slight |= small;
            now &= none_of(small);
        }
        if (!any(now))
            continue;
        for (int lane = 0; lane < REAL_WIDTH; ++lane) {
            if (!IN(now, lane))
                continue;
            MODEL(crossing) c = MODEL(sign_change)(k, values, lane);
            const double later = IN(found, lane) ? MODEL(place_of)(&c) - MODEL(place_of)(first + lane) : 0.0;
            c.several = IN(found, lane) && (first[lane].several || fabs(later) > AT_END);
            first[lane].several = c.several;
            if (!IN(found, lane) || later < 0.0)
                first[lane] = c;
        }
        found |= now;
    }
    return found;
}

/* The lanes in which the branches by the signs at the stages would change the step by less than NO_DIFFERENCE. */
static mask MODEL(same_on_both)(MODEL(batch) *b, mask where, real begin, real h)
{
    const MODEL(block) *m = &b->m;
    real worst = zero;
    for (long i = 0; i <= STAGES; ++i) {
        const real *const side = i < STAGES ? m->side + i * m->branches : b->end_side;
        const double *const weight = i < STAGES ? stage_reach[i] : stage_weight;
        real *const old = b->some_left;
        MODEL(reach_of)(m, h, weight, m->reached);
        MODEL(inputs_at)(b, where, begin + (i < STAGES ? stage_at[i] : 1.0) * h, b->some_inputs);
        MODEL(point)(b, m->reached, m->branch, stage_end, old, b->some_side);
        memcpy(b->end_branch, m->branch, (size_t)m->branches * sizeof(real));
        MODEL(choose)(m->branches, side, b->end_branch, where);
        MODEL(point)(b, m->reached, b->end_branch, stage_end, b->some_rate, b->some_side);
        for (long k = 0; k < m->n; ++k) {
            const real size = largest_of(m->largest[k], size_of(m->reached[k])) + 1e-300;
            worst = largest_of(size_of(b->some_rate[k] - old[k]) * h / size, worst);
        }
    }
    return where & (worst <= wide(NO_DIFFERENCE * b->tolerance));
}

/*
 * The lanes in which a switching function changes its sign within the step; the first change of each. No change
 * is left out in lanes whose step is not `good`: it may be on the wrong branch for that change.
 */
static mask MODEL(crossed)(MODEL(batch) *b, mask where, mask good, real begin, real h, MODEL(crossing) *first)
{
    mask slight = nowhere;
    if (b->fixed > 0.0)
        return MODEL(signs_change)(b, where, first, NULL);
    mask found = MODEL(signs_change)(b, where, first, &slight);
    if (any(slight)) {
        slight &= none_of(good & MODEL(same_on_both)(b, slight, begin, h));
        found |= MODEL(signs_change)(b, slight, first, NULL);
    }
    return found;
}

/*
 * A switch is looked for up to AHEAD lengths of a step after its end; it may come sooner, by the factor ROUGHLY,
 * than the straight line through the last two values predicts.
 */
enum { AHEAD = 3, ROUGHLY = 2 };

/*
 * The time from the end of each lane's step to the next sign change of a switching function that approaches
 * zero there, or HUGE_VAL: where the polynomial through its values is zero, if within AHEAD steps. Only
 * the lengths of steps follow from it. `which` is written where there is one.
 */
static real MODEL(until_switch)(const MODEL(batch) *b, real h, mask where, real *which)
{
    enum { LAST = STAGES + 2 };
    const MODEL(block) *m = &b->m;
    real first = wide(AHEAD);
    for (long k = 0; k < m->branches; ++k) {
        const real end = b->end_side[k], stage = m->side[(STAGES - 1) * m->branches + k];
        real ahead = (1.0 - stage_at[STAGES - 1]) * (end / (stage - end)); /* by the last two values */
        mask near = where & (size_of(end) > NO_SWITCH * b->widest[k]);
        near &= (ahead > 0.0) & (ahead < AHEAD) & (ahead < ROUGHLY * first);
        if (!any(near))
            continue;
        double at[LAST] = {0.0};
        real value[LAST] = {b->side[k]};
        for (long i = 1; i < LAST; ++i) {
            at[i] = i <= STAGES ? stage_at[i - 1] : 1.0;
            value[i] = i <= STAGES ? m->side[(i - 1) * m->branches + k] : end;
        }
        for (long order = 1; order < LAST; ++order) /* divided differences */
            for (long j = 0; j < LAST - order; ++j)
                value[j] = (value[j + 1] - value[j]) * (1.0 / (at[j + order] - at[j]));
        for (int again = 0; again < 3; ++again) { /* Newton's method */
            real there = value[0], slope = zero;
            for (long j = 1; j < LAST; ++j) {
                const real step = 1.0 + ahead - at[j];
                slope = there + step * slope;
                there = value[j] + step * there;
            }
            ahead -= there / slope;
            near &= (ahead > 0.0) & (ahead < first);
        }
        first = chosen(near, ahead, first);
        *which = chosen(near, wide((double)k), *which);
    }
    return chosen(first < AHEAD, first * h, wide(HUGE_VAL));
}

#if defined(BENDS)
/*
 * The fraction of a step to try next when its error is too large; the error suggests `part`.
 * Steps may cross kinks of energies, which have no branches. If such a kink within the step is the
 * cause, a step that ends just behind it suffices.
 */
static double MODEL(to_kink)(const MODEL(batch) *b, const MODEL(crossing) *c, double part)
{
    const double place = MODEL(place_of)(c);
    const int inside = place > AT_ONCE && place < 1.0 - b->beyond;
    return inside ? place * (1.0 + 0.5 * b->beyond) : part;
}
#endif

/* The fraction of its length by which a lane's step is to end behind a switch; `most` if none is known. */
static double MODEL(over_switch)(const MODEL(batch) *b, int lane, long which, double length, double most)
{
    const double slack = LANE(b->slack, which, lane);
    if (b->fixed > 0.0 || !(slack > 0.0))
        return most;
    return MODEL(lesser)(MODEL(greater)(0.5 * slack / length, AT_END), 0.5 * BEHIND);
}

/* The errors, in tolerances, of steps that end some time `behind` a switch with the rates from before it. */
static real MODEL(kink_error)(MODEL(batch) *b, real begin, real h, real behind, mask where)
{
    const MODEL(block) *m = &b->m;
    real worst = zero;
    memcpy(b->end_branch, m->branch + (STAGES - 1) * m->branches, (size_t)m->branches * sizeof(real));
    MODEL(choose)(m->branches, b->end_side, b->end_branch, where);
    MODEL(inputs_at)(b, where, begin + h, b->some_inputs);
    MODEL(point)(b, m->end, b->end_branch, stage_end, b->some_rate, b->some_side);
    for (long k = 0; k < m->n; ++k) {
        const real size = largest_of(m->largest[k], size_of(m->end[k])) + 1e-300;
        worst = largest_of(size_of(b->some_rate[k] - b->end_rate[k]) * behind / size, worst);
    }
    return worst / wide(b->tolerance);
}

/*
 * The lanes whose steps may end where they do, behind the switches located in them; `slack` keeps how far behind
 * each switch a step may end. If several switches lie in a step, their errors may cancel at its end: none is kept.
 */
static mask MODEL(ends_behind)(MODEL(batch) *b, mask where, real begin, real h,
                               const MODEL(crossing) *crossing, const double *part)
{
    mask near = nowhere;
    real behind = zero, most_error = wide(KINK_ERROR);
    for (int lane = 0; lane < REAL_WIDTH; ++lane) {
        if (!IN(where, lane) || crossing[lane].which < 0)
            continue;
        const double most = b->fixed > 0.0 || crossing[lane].several ? b->beyond : BEHIND;
        LANE(&behind, 0, lane) = (1.0 - part[lane]) * LANE(&h, 0, lane);
        LANE(&most_error, 0, lane) = KINK_ERROR / (1.0 + (double)b->lane[lane].run->switched / MANY_KINKS);
        SET(near, lane, 1.0 - part[lane] < most);
    }
    if (b->fixed > 0.0 || !any(near))
        return near;
    const real error = MODEL(kink_error)(b, begin, h, behind, near) / most_error;
    const mask fits = near & (error <= 1.0);
    for (int lane = 0; lane < REAL_WIDTH; ++lane) {
        const double times = LANE(&error, 0, lane), time = LANE(&behind, 0, lane);
        if (IN(near, lane) && crossing[lane].several)
            LANE(b->slack, crossing[lane].which, lane) = 0.0;
        else if (IN(near, lane) && times > 0.0)
            LANE(b->slack, crossing[lane].which, lane) = time * (times < 1.0 ? sqrt(1.0 / times) : 1.0 / times);
    }
    return fits;
}

/* A sign change is located once its place moves by less than this fraction of how far the step ends behind it. */
#define LOCATED 0.02

/* Locate the sign changes of some lanes on the polynomials of their steps' rates, as fractions of the steps. */
static void MODEL(locate)(MODEL(batch) *b, mask where, real h, MODEL(crossing) *crossing, double *part)
{
    MODEL(block) *m = &b->m;
    int before[REAL_WIDTH] = {0};
    real at = zero;
    for (int again = 0; again < 60 && any(where); ++again) {
        for (int lane = 0; lane < REAL_WIDTH; ++lane) {
            const MODEL(crossing) *c = crossing + lane;
            if (!IN(where, lane))
                continue;
            part[lane] = c->guessed ? c->high : MODEL(place_of)(c);
            LANE(&at, 0, lane) = part[lane];
        }
        MODEL(inputs_at)(b, where, MODEL(now)(b) + at * h, b->some_inputs);
        MODEL(reach_part)(m, h, b->known, at);
        MODEL(point)(b, m->reached, m->branch, NULL, b->some_rate, b->some_side);
        for (int lane = 0; lane < REAL_WIDTH; ++lane) {
            MODEL(crossing) *c = crossing + lane;
            if (!IN(where, lane))
                continue;
            const double turn = LANE(m->branch, c->which, lane) > 0.0 ? 1.0 : -1.0;
            const double value = turn * LANE(b->some_side, c->which, lane);
            if (c->guessed) {
                c->guessed = 0;
                c->at_high = value;
                const double end = turn * LANE(b->end_side, c->which, lane);
                if (value >= 0.0 && end < 0.0) { /* it comes later */
                    c->low = c->high, c->at_low = value;
                    c->high = 1.0, c->at_high = end;
                } else if (value >= 0.0) { /* there is no sign change */
                    c->which = -1;
                    SET(where, lane, 0);
                }
                continue;
            }
            if (value == 0.0 || part[lane] == c->low || part[lane] == c->high) {
                SET(where, lane, 0);
                continue;
            }
            if (value > 0.0) { /* Illinois method: halve the value at an end that stays twice */
                c->low = part[lane], c->at_low = value;
                c->at_high *= before[lane] < 0 ? 0.5 : 1.0;
                before[lane] = -1;
            } else {
                c->high = part[lane], c->at_high = value;
                c->at_low *= before[lane] > 0 ? 0.5 : 1.0;
                before[lane] = 1;
            }
            const double next = MODEL(place_of)(c);
            const double over = MODEL(over_switch)(b, lane, c->which, b->lane[lane].length, b->beyond);
            if (c->high - c->low <= AT_ONCE || fabs(next - part[lane]) <= LOCATED * over * next) {
                part[lane] = next;
                SET(where, lane, 0);
            }
        }
    }
}

/*
 * Change the branch of switch `which` in a lane; with `others`, of all switches that the step has
 * reached at its end.
 */
static void MODEL(turn)(MODEL(batch) *b, int lane, long which, int others)
{
    MODEL(block) *m = &b->m;
    for (long k = 0; k < m->branches; ++k) {
        const double branch = LANE(m->branch, k, lane), end = LANE(b->end_side, k, lane);
        const int there = fabs(end) <= 1e-8 * fabs(LANE(b->side, k, lane));
        const int beyond = (end > 0.0) != (branch > 0.0);
        if (k == which || (others && (there || beyond)))
            for (long i = 0; i < STAGES; ++i)
                LANE(m->branch, i * m->branches + k, lane) = 1.0 - branch;
    }
    ++b->lane[lane].run->switched;
}
