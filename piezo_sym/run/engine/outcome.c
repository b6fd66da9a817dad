/*
 * What becomes of the step of a lane: it is refused, accepted, sampled, cut at a switch, or booked, and
 * the lane goes on.  Behind samples.c.
 */

/* A run's end: it came through, or no step stays. */
static void MODEL(leave)(MODEL(batch) *b, int lane, int failed)
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

/* A step is refused: a shorter one is tried. */
static void MODEL(refuse)(MODEL(batch) *b, int lane, double h)
{
    MODEL(lane) *l = b->lane + lane;
    ++l->run->rejected;
    l->h = h;
    l->settled = 0;
    l->phase = STEP;
    if (LOSSY || ++l->refused > MOST_REFUSED || l->t + h <= l->t || h < SHORTEST_PART * b->fixed)
        MODEL(leave)(b, lane, 1);
}

/* A fixed step is refused: it is tried again from no prediction, and then half of it. */
static void MODEL(refuse_fixed)(MODEL(batch) *b, int lane)
{
    MODEL(lane) *l = b->lane + lane;
    const int predicted = l->predicted;
    l->known = 0.0;
    if (predicted)
        l->phase = STEP;
    else if (++l->halved > MOST_HALVED)
        MODEL(leave)(b, lane, 1);
    else
        MODEL(refuse)(b, lane, 0.5 * l->whole);
}

/* A step is accepted: samples within it come first.  Returns whether it is to be booked. */
static int MODEL(accept)(MODEL(batch) *b, int lane)
{
    b->lane[lane].step = b->lane[lane].length;
    return MODEL(all_sampled)(b, lane);
}

/*
 * Choose between steps that end at kinks and steps over them: each way is tried for a while, and the
 * one that gets further with as many solves is taken.  Returns whether a lane is to end at kinks now,
 * and did not before.
 */
static int MODEL(choose_way)(MODEL(batch) *b, int lane)
{
    MODEL(lane) *l = b->lane + lane;
    const int over = IN(b->m.over, lane) != 0;
    if (!b->either || l->ticks < TRIED)
        return 0;
    l->pace[over] = (l->t - l->since) / l->ticks;
    l->since = l->t;
    l->ticks = 0;
    ++l->looks;
    const int other = l->pace[!over] == 0.0 || l->looks >= AGAIN || l->pace[!over] > l->pace[over];
    if (!other)
        return 0;
    l->looks = 0;
    SET(b->m.over, lane, !over);
    l->known = 0.0;
    return over;
}

/* How a lane goes on after a step that was booked; returns whether its branches turn. */
static int MODEL(on)(MODEL(batch) *b, int lane)
{
    MODEL(lane) *l = b->lane + lane;
    MODEL(run) *run = l->run;
    const int last = l->last && l->step == l->whole;
    const double before = l->t;
    l->t = MODEL(step_end)(b, l);
    run->t = l->t;
    ++run->steps;
    run->iterations = (long)LANE(&b->m.iterations, 0, lane);
    const double most = l->refused ? 1.0 : 4.0; /* what was refused just now is not tried again */
    l->refused = l->t > before ? 0 : l->refused + 1; /* between switches that lead back to each other */
    l->phase = STEP;
    if (b->fixed > 0.0) {
        l->halved = l->h < b->fixed ? l->halved : 0;
        l->h = fmin(b->fixed, 2.0 * l->h);
    } else {
        if (l->fresh) /* what its error allowed; switches differ: the shorter steps count */
            l->after_switch = fmin(l->whole * fmin(l->longer, most),
                                   l->after_switch > 0.0 ? 1.5 * l->after_switch : HUGE_VAL);
        l->fresh = l->which >= 0;
        if (l->which >= 0)
            l->h = fmin(l->whole * fmin(l->longer, 2.0),
                        l->after_switch > 0.0 ? l->after_switch : 0.3 * l->whole);
        else if (!last) {
            l->h = fmin(l->step * fmin(l->longer, most), SUDDEN * l->steady);
            l->steady = l->step * l->longer;
        }
    }
    l->behind = 1;
    l->settled = 0;
    if (l->which >= 0)
        l->known = 0.0, l->steady = HUGE_VAL;
    MODEL(sample_here)(b, lane);
    if (l->t >= b->stop)
        MODEL(leave)(b, lane, 0);
    else if (l->refused > MOST_REFUSED)
        MODEL(leave)(b, lane, 1);
    else if (l->t >= l->segment->stop) {
        ++l->segment;
        l->phase = BEGIN;
    }
    return l->which >= 0 && l->phase == STEP;
}

/* Where a step may have to be cut: accept it, or take it again. */
static int MODEL(cut)(MODEL(batch) *b, int lane, const MODEL(crossing) *c, double part, mask *turns)
{
    MODEL(lane) *l = b->lane + lane;
    if (c->which >= 0) {
        l->which = c->which;
        if (part < AT_ONCE) {
            MODEL(turn)(b, lane, c->which, 0);
            SET(*turns, lane, 1);
            l->known = 0.0;
            l->phase = STEP;
            if (++l->refused > MOST_REFUSED)
                MODEL(leave)(b, lane, 1);
            return 0;
        }
        if (1.0 - part < b->beyond)
            return 1;
    } else if (l->which < 0)
        return 1;
    else {
        const double begin = LANE(b->side, l->which, lane), end = LANE(b->end_side, l->which, lane);
        if (fabs(end) <= AT_END * fabs(begin))
            return 1;
        const double stage = LANE(b->m.side, (STAGES - 1) * b->m.branches + l->which, lane);
        /* short of the switch: on by what is missing */
        part = 1.0 + (1.0 - stage_at[STAGES - 1]) * (end / (stage - end));
        if (!(part > 1.0 && part < 1.5))
            return 1;
    }
    if (++l->cuts > MOST_CUTS)
        return 1;
    l->part = part * (1.0 + 0.5 * b->beyond);
    l->phase = CUT;
    return 0;
}
