/*
 * Ticks: one step in every lane that has a run, and what becomes of it.  Behind crossings.c.
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

/* Whether samples of a lane lie within its accepted step. */
static int MODEL(samples_left)(const MODEL(batch) *b, const MODEL(lane) *l)
{
    const double end = l->last && l->step == l->whole ? MODEL(until)(b, l) : l->t + l->step;
    return b->fixed == 0.0 && l->run->sample < b->samples && b->times[l->run->sample] < end;
}

/* A step is accepted: samples within it come first.  Returns whether it is to be booked. */
static int MODEL(accept)(MODEL(batch) *b, int lane)
{
    MODEL(lane) *l = b->lane + lane;
    l->step = l->length;
    if (!MODEL(samples_left)(b, l))
        return 1;
    l->phase = SAMPLE;
    return 0;
}

/* Write a row of samples: the state, and sums with what a step adds to them. */
static void MODEL(sample)(MODEL(batch) *b, int lane, const real *x, const real *more)
{
    const long n = b->m.n, booked = b->m.booked;
    MODEL(run) *run = b->lane[lane].run;
    double *const states = run->states + run->sample * n, *const sums = run->sums + run->sample * booked;
    for (long k = 0; k < n; ++k)
        states[k] = LANE(x, k, lane);
    for (long k = 0; k < booked; ++k)
        sums[k] = LANE(b->sums, k, lane) + (more ? LANE(more, k, lane) - LANE(b->lost, k, lane) : 0.0);
    ++run->sample;
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
    if (!b->ways || l->ticks < TRIED)
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
    double until = MODEL(until)(b, l);
    if (b->fixed > 0.0 && run->sample < b->samples && b->times[run->sample] < until)
        until = b->times[run->sample];
    const double before = l->t;
    l->t = last ? until : l->t + l->step;
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
        if (l->fresh) /* switches differ: the shorter steps count */
            l->after_switch = l->after_switch > 0.0 ? fmin(l->step, 1.5 * l->after_switch) : l->step;
        l->fresh = l->which >= 0;
        if (l->which >= 0)
            l->h = fmin(l->whole * fmin(l->longer, 2.0),
                        l->after_switch > 0.0 ? 1.2 * l->after_switch : 0.3 * l->whole);
        else if (!last) {
            l->h = fmin(l->step * fmin(l->longer, most), SUDDEN * l->steady);
            l->steady = l->step * l->longer;
        }
    }
    l->behind = 1;
    if (l->which >= 0)
        l->known = 0.0, l->steady = HUGE_VAL;
    while (run->sample < b->samples && b->times[run->sample] <= l->t)
        MODEL(sample)(b, lane, b->m.x, NULL);
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

/* What a tick is about: the steps of lanes, which lanes they are, and how they came out. */
typedef struct {
    real h, behind, slope;
    mask busy, sampling, steps, known; /* lanes with a step; for samples; others; with a prediction */
    mask found, good;                  /* whose step has rates; and lies in the domain */
    mask search, switched;             /* where a switch has to be located; and a step may be cut */
    mask booked, turns, ends;          /* whose step counts; whose branches turn; who steps to kinks */
    MODEL(crossing) crossing[REAL_WIDTH];
    double part[REAL_WIDTH];
} MODEL(tick);

static MODEL(tick) MODEL(planned)(MODEL(batch) *b)
{
    MODEL(tick) t = {.h = zero, .behind = zero, .slope = zero};
    for (int lane = 0; lane < REAL_WIDTH; ++lane) {
        MODEL(lane) *l = b->lane + lane;
        t.crossing[lane].which = -1;
        t.part[lane] = 1.0;
        if (l->phase == IDLE)
            continue;
        MODEL(plan)(b, l, lane);
        SET(t.busy, lane, 1);
        SET(t.sampling, lane, l->phase == SAMPLE);
        SET(t.known, lane, l->known > 0.0);
        l->ticks += l->phase != SAMPLE;
        LANE(&t.h, 0, lane) = l->length;
        LANE(&t.behind, 0, lane) = l->behind;
        l->predicted = l->known > 0.0;
        LANE(&t.slope, 0, lane) = l->known > 0.0 ? l->length / l->known : 0.0;
    }
    t.steps = t.busy & none_of(t.sampling);
    return t;
}

/* Solve the steps; where they end is in m.reached, and what they add to sums in some_rows. */
static void MODEL(solved)(MODEL(batch) *b, MODEL(tick) *t)
{
    MODEL(block) *m = &b->m;
    MODEL(predict)(b, t->behind, t->slope, t->known);
    t->found = MODEL(solve)(m, t->h, t->busy);
    t->good = t->found & MODEL(accepted)(m);
    MODEL(reach)(m, t->h, stage_weight, m->reached);
    MODEL(adds)(b, t->h, b->some_rows);
}

/* Write samples; a run whose step has no more of them books it. */
static void MODEL(sampled)(MODEL(batch) *b, MODEL(tick) *t)
{
    for (int lane = 0; lane < REAL_WIDTH; ++lane) {
        MODEL(lane) *l = b->lane + lane;
        if (!IN(t->sampling, lane))
            continue;
        if (!IN(t->good, lane)) {
            MODEL(refuse)(b, lane, 0.25 * l->step);
            continue;
        }
        MODEL(sample)(b, lane, b->m.reached, b->some_rows);
        SET(t->booked, lane, !MODEL(samples_left)(b, l));
    }
}

/* Rates and switching functions where steps end, and the rates of steps that were found. */
static void MODEL(at_ends)(MODEL(batch) *b, MODEL(tick) *t)
{
    MODEL(block) *m = &b->m;
    MODEL(copy)(t->steps, m->reached, m->end, m->n);
    MODEL(copy)(t->steps, b->some_rows, b->part, m->booked);
    MODEL(copy)(t->steps & t->found, m->rates, b->known, STAGES * m->n);
#if defined(PATHS) /* where it began, as its stages tell */
    for (int lane = 0; lane < REAL_WIDTH; ++lane)
        if (IN(t->steps, lane))
            MODEL(inputs_at)(b->lane[lane].segment, m->inputs, b->lane[lane].t, b->some_inputs, lane);
    MODEL(point)(b, m->x, m->branch, stage_start, b->some_rate, b->some_side);
    MODEL(copy)(t->steps & t->found, b->some_rate, b->rate, m->n);
#endif
    for (int lane = 0; lane < REAL_WIDTH; ++lane) {
        const MODEL(lane) *l = b->lane + lane;
        if (IN(t->steps, lane))
            MODEL(inputs_at)(l->segment, m->inputs, l->t + l->length, b->some_inputs, lane);
    }
    memcpy(b->end_branch, m->branch + (STAGES - 1) * m->branches, (size_t)m->branches * sizeof(real));
    for (int again = 0; again < 3; ++again) {
        MODEL(point)(b, m->end, b->end_branch, stage_end, b->some_rate, b->some_side);
        if (!any(MODEL(choose)(m->branches, b->some_side, b->end_branch, m->over)))
            break;
    }
    mask ends_well = MODEL(within)(b->some_margin); /* and has rates there to go on with */
    for (long k = 0; k < m->n; ++k)
        ends_well &= size_of(b->some_rate[k]) < 1e300;
    t->good &= none_of(t->steps) | ends_well;
    MODEL(copy)(t->steps, b->some_rate, b->end_rate, m->n);
    MODEL(copy)(t->steps, b->some_side, b->end_side, m->branches);
}

/* Refuse steps without rates, or with large errors; of the others tell where switches have changed. */
static void MODEL(judged)(MODEL(batch) *b, MODEL(tick) *t)
{
    const real worst = b->fixed == 0.0 ? MODEL(error)(b, t->h) : (real)zero;
    const mask across = MODEL(crossed)(b, t->steps & t->found & none_of(b->m.over));
    for (int lane = 0; lane < REAL_WIDTH; ++lane) {
        MODEL(lane) *l = b->lane + lane;
        if (!IN(t->steps, lane))
            continue;
        if (!IN(t->found, lane)) {
            l->known = 0.0;
            if (b->fixed > 0.0)
                MODEL(refuse_fixed)(b, lane);
            else
                MODEL(refuse)(b, lane, 0.25 * l->length);
            continue;
        }
        l->known = l->length;
        l->behind = 0;
        if (l->phase == STEP && b->fixed == 0.0) {
            const double error = LANE(&worst, 0, lane);
            const int over = IN(b->m.over, lane) != 0;
            const double grown = PART_OF(over) * pow(error, over ? OVER_KINKS : -0.5 / STAGES);
            l->longer = error > 0.0 ? grown : error == 0.0 ? 8.0 : 0.25;
            if (!(error <= 1.0)) {
                double part = fmax(0.1, l->refused > 1 ? fmin(l->longer, 0.5) : l->longer);
#if defined(PATHS) /* most of the error may come from it */
                if (LANE(b->m.yield, 0, lane) < YIELDS)
                    part = LANE(b->m.yield, 0, lane);
#endif
#if defined(BENDS)
                if (IN(across, lane) && !l->refused)
                    part = MODEL(to_kink)(b, lane, part);
#endif
                MODEL(refuse)(b, lane, l->length * part);
                continue;
            }
        }
        if (IN(across, lane))
            t->crossing[lane] = MODEL(first_switch)(b, lane);
        const int crosses = t->crossing[lane].which >= 0;
        SET(t->search, lane, crosses);
        SET(t->switched, lane, crosses || l->phase == CUT);
        SET(t->booked, lane, !crosses && l->phase == STEP);
    }
}

/* Cut steps at switches, refuse those that leave the domain, and wait for samples. */
static void MODEL(cut_and_accepted)(MODEL(batch) *b, MODEL(tick) *t)
{
    if (any(t->search))
        MODEL(locate)(b, t->search, t->h, t->crossing, t->part);
    for (int lane = 0; lane < REAL_WIDTH; ++lane) {
        if (IN(t->switched, lane))
            SET(t->booked, lane, MODEL(cut)(b, lane, t->crossing + lane, t->part[lane], &t->turns));
        if (!IN(t->booked, lane) || !IN(t->steps, lane))
            continue;
        const int good = IN(t->good, lane) != 0;
        SET(t->booked, lane, good && MODEL(accept)(b, lane));
        if (good)
            continue;
        if (b->fixed > 0.0)
            MODEL(refuse_fixed)(b, lane);
        else
            MODEL(refuse)(b, lane, 0.25 * b->lane[lane].length);
    }
}

/* Book steps, and go to their ends. */
static void MODEL(book)(MODEL(batch) *b, MODEL(tick) *t)
{
    MODEL(block) *m = &b->m;
#if REAL_WIDTH == 1
    if (b->tape && !MODEL(taped)(b)) {
        b->lane->known = 0.0;
        MODEL(refuse)(b, 0, 0.25 * b->lane->step);
        return;
    }
#endif
    MODEL(copy)(t->booked, m->end, m->x, m->n);
    MODEL(copy)(t->booked, b->end_rate, b->rate, m->n);
    for (long k = 0; k < m->n; ++k)
        m->largest[k] =
            chosen(t->booked, largest_of(size_of(m->x[k]), m->largest[k]), m->largest[k]);
    for (long k = 0; k < m->booked; ++k) {
        const real more = b->part[k] - b->lost[k], total = b->sums[k] + more;
        b->lost[k] = chosen(t->booked, (total - b->sums[k]) - more, b->lost[k]);
        b->sums[k] = chosen(t->booked, total, b->sums[k]);
    }
    for (int lane = 0; lane < REAL_WIDTH; ++lane) {
        MODEL(lane) *l = b->lane + lane;
        if (!IN(t->booked, lane))
            continue;
        if (MODEL(on)(b, lane)) {
            MODEL(turn)(b, lane, l->which, 1);
            SET(t->turns, lane, 1);
        }
        if (l->phase == STEP && MODEL(choose_way)(b, lane))
            SET(t->ends, lane, 1);
    }
    MODEL(copy)(t->booked, b->end_side, b->side, m->branches);
}

/* One step in every lane that has a run. */
static void MODEL(tick_once)(MODEL(batch) *b)
{
    MODEL(tick) t = MODEL(planned)(b);
    MODEL(solved)(b, &t);
    if (any(t.sampling))
        MODEL(sampled)(b, &t);
    if (any(t.steps)) {
        MODEL(at_ends)(b, &t);
        MODEL(judged)(b, &t);
        MODEL(cut_and_accepted)(b, &t);
    }
    if (any(t.booked))
        MODEL(book)(b, &t);
    if (any(t.turns | t.ends))
        MODEL(stand)(b, t.turns | t.ends, t.ends);
}
