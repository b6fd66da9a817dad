/*
 * The outcome of a lane's step: it is refused, accepted, cut at a switch, or booked; and the lane's next
 * step.  Comes after lengths.c.
 */

/* End a run, `failed` if no step succeeds. */
static void MODEL(end_run)(MODEL(batch) *b, int lane, int failed)
{
    MODEL(lane) *l = b->lane + lane;
    for (long k = 0; k < b->m.n; ++k) {
        l->run->x[k] = LANE(b->m.x, k, lane);
        l->run->largest[k] = LANE(b->m.largest, k, lane);
    }
    for (long k = 0; k < b->m.booked; ++k) {
        l->run->ledger[k] = LANE(b->sums, k, lane);
        l->run->ledger[b->m.booked + k] = LANE(b->lost, k, lane);
    }
    l->run->failed = failed;
    l->phase = IDLE;
}

/*
 * No step of a run succeeds: the run ends, unless steps over kinks have not been tried.  Where states begin at
 * rest and kinks meet, switching functions may be mere noise of an input.  Steps over kinks are not tried
 * where laws jump: such a law may hold the state.
 */
static void MODEL(stuck)(MODEL(batch) *b, int lane)
{
    MODEL(lane) *l = b->lane + lane;
    if (LOSSY || MODEL(jumps) || b->fixed > 0.0 || b->m.branches == 0 || IN(b->m.over, lane)) {
        MODEL(end_run)(b, lane, 1);
        return;
    }
    SET(b->m.over, lane, 1);
    l->stuck = 1;
    l->solves = 0;
    l->refused = l->idle = 0;
    l->aimed = 0.0;
    l->known = 0.0;
    l->h = b->first;
    l->which = -1;
    l->phase = STEP;
}

/* Refuse a step: a shorter one is tried. */
static void MODEL(refuse)(MODEL(batch) *b, int lane, double h)
{
    MODEL(lane) *l = b->lane + lane;
    ++l->run->rejected;
    l->h = h;
    l->aimed = 0.0;
    l->settled = 0;
    l->phase = STEP;
    if (LOSSY || ++l->refused > MOST_REFUSED || l->t + h <= l->t || h < SHORTEST_PART * b->fixed)
        MODEL(stuck)(b, lane);
}

/* Refuse a fixed step: it is repeated without a prediction, and then halved. */
static void MODEL(refuse_fixed)(MODEL(batch) *b, int lane)
{
    MODEL(lane) *l = b->lane + lane;
    const int predicted = l->predicted;
    l->known = 0.0;
    if (predicted)
        l->phase = STEP;
    else if (++l->halved > MOST_HALVED)
        MODEL(end_run)(b, lane, 1);
    else
        MODEL(refuse)(b, lane, 0.5 * l->whole);
}

/* Accept a step; samples within it come first.  Returns whether to book it now. */
static int MODEL(accept)(MODEL(batch) *b, int lane)
{
    MODEL(lane) *l = b->lane + lane;
    l->step = l->length;
    return MODEL(all_sampled)(b, lane);
}

/*
 * Choose between steps that end at kinks and steps over them: each is tried for some solves, and the one
 * that covers more time with as many solves is kept.  Returns whether a lane changes to ending at kinks.
 */
static int MODEL(choose_kinks)(MODEL(batch) *b, int lane)
{
    MODEL(lane) *l = b->lane + lane;
    const int over = IN(b->m.over, lane) != 0;
    if (!(b->either || l->stuck) || l->solves < TRIED)
        return 0;
    if (!b->either) {
        SET(b->m.over, lane, 0);
        l->stuck = 0;
        l->known = 0.0;
        return 1;
    }
    l->pace[over] = (l->t - l->since) / l->solves;
    l->since = l->t;
    l->solves = 0;
    ++l->comparisons;
    const int other = l->pace[!over] == 0.0 || l->comparisons >= AGAIN || l->pace[!over] > l->pace[over];
    if (!other)
        return 0;
    l->comparisons = 0;
    SET(b->m.over, lane, !over);
    l->known = 0.0;
    return over;
}

/* Prepare a lane for the step after one that was booked; returns whether a branch changes. */
static int MODEL(go_on)(MODEL(batch) *b, int lane)
{
    MODEL(lane) *l = b->lane + lane;
    MODEL(run) *run = l->run;
    const double before = l->t;
    l->t = MODEL(step_end)(b, l);
    run->t = l->t;
    ++run->steps;
    run->iterations = (long)LANE(&b->m.iterations, 0, lane);
    const double most = l->refused ? 1.0 : 4.0; /* a length that was just refused is not tried again */
    l->refused = 0;
    l->idle = l->t > before ? 0 : l->idle + 1; /* switches may lead back to each other at one time */
    l->crawled = l->t - before > CRAWL * fabs(b->stop) ? 0 : l->crawled + 1;
    l->phase = STEP;
    if (b->fixed > 0.0) {
        l->halved = l->h < b->fixed ? l->halved : 0;
        l->h = MODEL(lesser)(b->fixed, 2.0 * l->h);
        l->known = l->which >= 0 ? 0.0 : l->known;
    } else
        MODEL(next_length)(b, l, lane, most);
    l->behind = 1;
    l->settled = 0;
    MODEL(sample_here)(b, lane);
    if (l->t >= b->stop)
        MODEL(end_run)(b, lane, 0);
    else if (l->crawled > MOST_CRAWLED && b->fixed == 0.0)
        MODEL(end_run)(b, lane, 1);
    else if (l->idle > MOST_REFUSED)
        MODEL(stuck)(b, lane);
    else if (l->t >= l->segment->stop) {
        MODEL(enter)(b->waves, ++l->segment, b->m.inputs, lane);
        l->phase = BEGIN;
    }
    return l->which >= 0 && l->phase == STEP;
}

/*
 * Let a lane repeat its step so that it ends a little behind a switch at `part` of it, but not beyond `most`;
 * returns 0 if it is not repeated, or was repeated too often.
 */
static int MODEL(cut)(MODEL(batch) *b, int lane, double part, double most)
{
    MODEL(lane) *l = b->lane + lane;
    const double over = MODEL(over_switch)(b, lane, l->which, part * l->length, 0.5 * b->beyond);
    if (!(part * (1.0 + over) <= most) || ++l->cuts > MOST_CUTS)
        return 0;
    l->part = part * (1.0 + over);
    l->phase = CUT;
    return 1;
}

/* A step that was aimed at a switch but ends before it is repeated up to it, at most this much longer. */
#define SHORT 1.1
/* The same for a step that was cut. */
#define SHORT_CUT 1.5

/* Whether to keep a lane's step that was to end at a switch and does not cross it; else it is repeated longer. */
static int MODEL(reaches)(MODEL(batch) *b, int lane)
{
    MODEL(lane) *l = b->lane + lane;
    const double begin = LANE(b->side, l->which, lane), end = LANE(b->end_side, l->which, lane);
    if (fabs(end) <= AT_END * fabs(begin))
        return 1;
    const double longest = (MODEL(until)(b, l) - l->t) / l->length;
    const double part = 1.0 + (l->goal == l->which ? l->ahead / l->length : 0.0);
    const double most = MODEL(lesser)(longest, l->phase == CUT ? SHORT_CUT : SHORT);
    if (part > 1.0 && MODEL(cut)(b, lane, part, most))
        return 0;
    l->which = -1;
    return 1;
}

/*
 * Whether a lane's step ends at a switch, or without one; else it is cut, or begins on another branch. `which`:
 * the switch that was located at `part`, or -1; `fits`: whether the step may end as far behind it as it does.
 */
static int MODEL(ends)(MODEL(batch) *b, int lane, long which, double part, int fits, mask *turns)
{
    MODEL(lane) *l = b->lane + lane;
    l->beyond = which < 0 ? 0.0 : (1.0 - part) * l->length;
    if (which < 0)
        return l->which < 0 || MODEL(reaches)(b, lane);
    l->which = which;
    if (part >= AT_ONCE)
        return fits || !MODEL(cut)(b, lane, part, HUGE_VAL);
    MODEL(turn)(b, lane, which, 0);
    SET(*turns, lane, 1);
    l->known = 0.0;
    l->phase = STEP;
    if (++l->idle > MOST_REFUSED)
        MODEL(stuck)(b, lane);
    return 0;
}
