/*
 * One step in every lane that has a run: solved as planned, judged by its error and its switches, and
 * booked.  Comes after plan.c.
 */

/* Solve the steps; where they end is in m.reached, and what they add to sums in some_rows. */
static void MODEL(solved)(MODEL(batch) *b, MODEL(dispatch) *t)
{
    MODEL(block) *m = &b->m;
    const mask over = m->over;
    if (any(t->resumed))
        MODEL(begin_at_samples)(b, t->resumed);
    MODEL(predict_all)(b, t);
    t->iterations = m->iterations;
    t->found = MODEL(solve)(m, t->h, t->busy);
    MODEL(compare_predictions)(b, t->h, t->recalling & t->found);
    t->good = t->found & MODEL(accepted)(m);
    MODEL(reach_of)(m, t->h, stage_weight, m->reached);
    MODEL(increments)(b, t->h, b->some_rows);
#if defined(COSTATES)
    MODEL(add_residual)(m, m->reached, b->some_rows);
    for (int lane = 0; lane < REAL_WIDTH; ++lane) {
        MODEL(lane) *l = b->lane + lane;
        if (!IN(t->steps, lane)) /* a run does not depend on samples */
            continue;
        if (IN(t->loose & none_of(m->loose), lane))
            l->to_round_off = TO_ROUND_OFF;
        else if (l->to_round_off > 0)
            --l->to_round_off;
    }
#endif /* COSTATES */
    if (any(t->resumed))
        MODEL(begin_at_runs)(b, t->resumed, over);
}

/* Write samples; book the steps that have no more samples. */
static void MODEL(sampled)(MODEL(batch) *b, MODEL(dispatch) *t)
{
    for (int lane = 0; lane < REAL_WIDTH; ++lane) {
        if (!IN(t->sampling, lane))
            continue;
        const int good = IN(t->good, lane) != 0;
        if (!good && !MODEL(sample_stands)(b, lane)) {
            if (!MODEL(retake_sample)(b, lane))
                MODEL(refuse)(b, lane, 0.25 * b->lane[lane].step);
        } else if (MODEL(take_sample)(b, lane, good))
            SET(t->booked, lane, MODEL(all_sampled)(b, lane));
    }
}

#if defined(PATHS)
/* The rates where steps with a tolerance began; those of path functionals follow from the stages. */
static void MODEL(as_begun)(MODEL(batch) *b, const MODEL(dispatch) *t)
{
    MODEL(inputs_at)(b, t->steps, t->begin, b->some_inputs);
    MODEL(point)(b, b->m.x, b->m.branch, stage_start, b->some_rate, b->some_side);
    MODEL(copy)(t->steps & t->found, b->some_rate, b->rate, b->m.n);
}
#endif

/* Rates and switching functions where steps end, and the rates of steps that were found. */
static void MODEL(at_ends)(MODEL(batch) *b, MODEL(dispatch) *t)
{
    MODEL(block) *m = &b->m;
    MODEL(take)(t->steps, &m->reached, &m->end, m->n);
    MODEL(take)(t->steps, &b->some_rows, &b->part, m->booked);
    MODEL(copy)(t->steps & t->found, m->rates, b->known, STAGES * m->n);
#if defined(PATHS) /* rates at the begin: those of path functionals follow from the stages */
    if (b->fixed == 0.0)
        MODEL(as_begun)(b, t);
#endif
    if (t->knows_end)
        memcpy(b->some_inputs, b->end_inputs, (size_t)m->inputs * sizeof(real));
    else
        MODEL(inputs_at)(b, t->steps, t->begin + t->h, b->some_inputs);
    memcpy(b->end_branch, m->branch + (STAGES - 1) * m->branches, (size_t)m->branches * sizeof(real));
    for (int again = 0; again < 3; ++again) {
        MODEL(point)(b, m->end, b->end_branch, stage_end, b->some_rate, b->some_side);
        if (!any(MODEL(choose)(m->branches, b->some_side, b->end_branch, m->over)))
            break;
    }
    mask ends_well = MODEL(within)(b->some_margin); /* and rates there are finite */
    for (long k = 0; k < m->n; ++k)
        ends_well &= size_of(b->some_rate[k]) < 1e300;
    t->good &= none_of(t->steps) | ends_well;
    MODEL(take)(t->steps, &b->some_rate, &b->end_rate, m->n);
    MODEL(copy)(t->steps, b->some_side, b->end_side, m->branches);
}

/* Refuse steps without rates, or with large errors; find the switches in the others. */
static void MODEL(judged)(MODEL(batch) *b, MODEL(dispatch) *t)
{
    const real worst = any(t->planned) ? MODEL(error)(b, t->h, t->planned & t->found) : (real)zero;
    const real longer = MODEL(growth)(b, worst);
    const mask may_cross = t->steps & t->found & none_of(b->m.over);
    const mask across = MODEL(crossed)(b, may_cross, t->good, t->begin, t->h, t->crossing);
    for (int lane = 0; lane < REAL_WIDTH; ++lane) {
        MODEL(lane) *l = b->lane + lane;
        if (!IN(t->steps, lane))
            continue;
        l->iterations += LANE(&b->m.iterations, 0, lane) - LANE(&t->iterations, 0, lane);
        if (!IN(t->found, lane) && l->recalls && l->repeats) { /* once more, predicted by the step before */
            l->repeats = 0;
            l->recalled = -1;
            continue;
        }
        if (!IN(t->found, lane)) { /* a shorter step is predicted as this one was, but the next one is not */
            l->known = l->predicted && !l->refused && b->fixed == 0.0 ? l->known : 0.0;
            if (b->fixed > 0.0)
                MODEL(refuse_fixed)(b, lane);
            else {
                l->hard = l->length;
                MODEL(refuse)(b, lane, 0.25 * l->length);
            }
            continue;
        }
        l->known = l->length;
        l->behind = 0;
        if (l->phase == STEP && b->fixed == 0.0) {
            const double error = LANE(&worst, 0, lane);
            l->longer = LANE(&longer, 0, lane);
            if (!(error <= 1.0)) {
                double part = MODEL(greater)(0.1, l->refused > 1 ? MODEL(lesser)(l->longer, 0.5) : l->longer);
#if defined(PATHS) /* most of the error may come from it */
                const double first = LANE(b->m.yield, EARLIEST, lane);
                if (first < YIELDS && first > 0.1 * part)
                    part = first;
#endif
#if defined(BENDS)
                if (IN(across, lane) && !l->refused)
                    part = MODEL(to_kink)(b, t->crossing + lane, part);
#endif
                MODEL(refuse)(b, lane, l->length * part);
                continue;
            }
        }
        const int crosses = IN(across, lane) != 0;
        const int aims = l->aimed > 0.0 && l->phase == STEP && !crosses;
        l->which = aims ? l->goal : l->which;
        SET(t->search, lane, crosses);
        SET(t->switched, lane, crosses || aims || l->phase == CUT);
        SET(t->booked, lane, !IN(t->switched, lane) && l->phase == STEP);
    }
}

/* Predict for each lane which switch comes next after its step, and when. */
static void MODEL(look_ahead)(MODEL(batch) *b, const MODEL(dispatch) *t)
{
    const mask where = t->steps & t->found & none_of(b->m.over);
    real goal = wide(-1.0);
    const real ahead = MODEL(until_switch)(b, t->h, where, &goal);
    for (int lane = 0; lane < REAL_WIDTH; ++lane)
        if (IN(where, lane)) {
            b->lane[lane].ahead = LANE(&ahead, 0, lane);
            b->lane[lane].goal = (long)LANE(&goal, 0, lane);
        }
}

/* Cut steps at switches, refuse those that leave the domain, and wait for samples. */
static void MODEL(cut_and_accepted)(MODEL(batch) *b, MODEL(dispatch) *t)
{
    if (any(t->search)) {
        MODEL(locate)(b, t->search, t->h, t->crossing, t->part);
        t->fits = MODEL(ends_behind)(b, t->search, t->begin, t->h, t->crossing, t->part);
    }
    MODEL(look_ahead)(b, t);
    for (int lane = 0; lane < REAL_WIDTH; ++lane) {
        const long which = t->crossing[lane].which;
        if (IN(t->switched, lane))
            SET(t->booked, lane, MODEL(ends)(b, lane, which, t->part[lane], IN(t->fits, lane) != 0, &t->turns));
        if (IN(t->booked, lane) && IN(b->m.sketched, lane)) { /* no switch after all: solve it fully */
            b->lane[lane].settled = 1;
            b->lane[lane].phase = STEP;
            SET(t->booked, lane, 0);
        }
    }
    const mask to_end = t->steps & t->booked;
    for (int lane = 0; lane < REAL_WIDTH; ++lane) {
        if (!IN(to_end, lane))
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

/* Book steps, and move lanes to their ends. */
static void MODEL(book)(MODEL(batch) *b, MODEL(dispatch) *t)
{
    MODEL(block) *m = &b->m;
#if REAL_WIDTH == 1
    if (b->tape && !MODEL(keep_on_tape)(b)) {
        b->lane->known = 0.0;
        b->lane->predicted = 0;
        if (b->fixed > 0.0)
            MODEL(refuse_fixed)(b, 0);
        else
            MODEL(refuse)(b, 0, 0.25 * b->lane->step);
        return;
    }
#endif
    MODEL(take)(t->booked, &m->end, &m->x, m->n);
    MODEL(take)(t->booked, &b->end_rate, &b->rate, m->n);
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
        MODEL(record_step)(b, lane);
        if (MODEL(go_on)(b, lane)) {
            MODEL(turn)(b, lane, l->which, 1);
            SET(t->turns, lane, 1);
        }
        if (l->phase == STEP && MODEL(choose_kinks)(b, lane))
            SET(t->ends, lane, 1);
    }
    MODEL(copy)(t->booked, b->end_side, b->side, m->branches);
    for (long k = 0; k < m->branches; ++k) {
        const real size = size_of(b->side[k]);
        const mask more = t->booked & (size > b->widest[k]);
        b->widest[k] = chosen(more, size, b->widest[k]);
    }
}

/* One step in every lane that has a run. */
static void MODEL(step_lanes)(MODEL(batch) *b)
{
    MODEL(dispatch) t = MODEL(planned)(b);
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
        MODEL(rates_here)(b, t.turns | t.ends, t.ends);
}
