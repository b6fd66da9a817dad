/*
 * Samples of runs. Comes after replay.c.
 *
 * A sample within a step is the end of a separate step with the same beginning, so that its
 * balances close, too. The run goes on from its own step: it does not depend on samples.
 *
 * Each such step has its own error. Where little is produced between two samples, the
 * later one might show less heat or entropy produced than the one before. Then its step is repeated
 * from the sample before (RESUME), and so are the steps of the samples that follow, until the run
 * itself has produced as much. The same is done for a sample whose step has no solution.
 */

/* Exchange the states of runs with those of their last samples. */
static void MODEL(swap_begins)(MODEL(batch) *b, mask where)
{
    for (long k = 0; k < b->m.n; ++k) {
        const real x = b->m.x[k];
        b->m.x[k] = chosen(where, b->kept[k], x);
        b->kept[k] = chosen(where, x, b->kept[k]);
    }
}

/*
 * Let the steps of some lanes begin at their last samples. Their stages choose branches: the run's
 * step may end a little beyond a switch without a stage there, but these steps may have one.
 */
static void MODEL(begin_at_samples)(MODEL(batch) *b, mask where)
{
    MODEL(swap_begins)(b, where);
    MODEL(copy)(where, b->m.branch, b->kept_branch, STAGES * b->m.branches);
    b->m.over |= where;
}

/* Undo begin_at_samples; `over`: the lanes whose runs step over kinks. */
static void MODEL(begin_at_runs)(MODEL(batch) *b, mask where, mask over)
{
    MODEL(swap_begins)(b, where);
    MODEL(copy)(where, b->kept_branch, b->m.branch, STAGES * b->m.branches);
    b->m.over = over;
}

/* An entry of a lane's ledger; with `more`, what it is after a step that adds that. */
static double MODEL(total)(const real *sums, const real *lost, const real *more, long k, int lane)
{
    return LANE(sums, k, lane) + (more ? LANE(more, k, lane) - LANE(lost, k, lane) : 0.0);
}

/*
 * Whether a lane's ledger, with what a step adds, has less heat or entropy produced than its last
 * sample.
 */
static int MODEL(production_falls)(const MODEL(batch) *b, int lane, const real *more)
{
    const long first = MODEL(output_count), last = first + 2 * b->m.processes;
    if (b->lane[lane].kept < b->lane[lane].t)
        return 0;
    for (long k = first; k < last; ++k)
        if (MODEL(total)(b->sums, b->lost, more, k, lane) < LANE(b->kept_sums, k, lane))
            return 1;
    return 0;
}

/* Write a sample: the state, and the ledger with what a step adds. */
static void MODEL(write_sample)(const MODEL(batch) *b, int lane, const real *x, const real *sums,
                                const real *lost, const real *more)
{
    const long n = b->m.n, booked = b->m.booked;
    const MODEL(run) *run = b->lane[lane].run;
    for (long k = 0; k < n; ++k)
        run->states[run->sample * n + k] = LANE(x, k, lane);
    for (long k = 0; k < booked; ++k)
        run->sums[run->sample * booked + k] = MODEL(total)(sums, lost, more, k, lane);
}

/* Keep the state and the ledger of a sample: the next sample's step may begin there. */
static void MODEL(keep_sample)(MODEL(batch) *b, int lane, const real *sums, const real *lost)
{
    for (long k = 0; k < b->m.n; ++k)
        LANE(b->kept, k, lane) = LANE(b->m.reached, k, lane);
    for (long k = 0; k < b->m.booked; ++k) {
        const double before = LANE(sums, k, lane);
        const double more = LANE(b->some_rows, k, lane) - LANE(lost, k, lane), now = before + more;
        LANE(b->kept_lost, k, lane) = (now - before) - more;
        LANE(b->kept_sums, k, lane) = now;
    }
}

/*
 * Whether a failed step for a sample may be ignored: the sample is already written, or none is due.
 */
static int MODEL(sample_stands)(const MODEL(batch) *b, int lane)
{
    const MODEL(lane) *l = b->lane + lane;
    return l->phase == RESUME && (l->written || !MODEL(samples_left)(b, l));
}

/*
 * A step for a sample has no solution or leaves the domain: stages may lie beyond a switch. It is
 * repeated, with branches that stages choose, from the last sample or from where the run is.
 * Returns whether that is still to be tried.
 */
static int MODEL(retake_sample)(MODEL(batch) *b, int lane)
{
    MODEL(lane) *l = b->lane + lane;
    if (l->phase == RESUME)
        return 0;
    l->phase = RESUME;
    l->written = 0;
    if (l->kept >= l->t)
        return 1;
    l->kept = l->t;
    for (long k = 0; k < b->m.n; ++k)
        LANE(b->kept, k, lane) = LANE(b->m.x, k, lane);
    for (long k = 0; k < b->m.booked; ++k) {
        LANE(b->kept_sums, k, lane) = LANE(b->sums, k, lane);
        LANE(b->kept_lost, k, lane) = LANE(b->lost, k, lane);
    }
    return 1;
}

/*
 * A step for a sample is solved: write the sample. `good`: the step is acceptable, which one from
 * the last sample may not be. Returns whether the sample stays, or its step is to be repeated.
 */
static int MODEL(take_sample)(MODEL(batch) *b, int lane, int good)
{
    MODEL(lane) *l = b->lane + lane;
    const int within = MODEL(samples_left)(b, l);
    const double t = MODEL(target)(b, l);
    if (l->phase == SAMPLE) {
        l->written = 1;
        MODEL(write_sample)(b, lane, b->m.reached, b->sums, b->lost, b->some_rows);
        if (MODEL(production_falls)(b, lane, b->some_rows)) {
            l->phase = RESUME;
            return 0;
        }
        MODEL(keep_sample)(b, lane, b->sums, b->lost);
    } else if (good) {
        MODEL(keep_sample)(b, lane, b->kept_sums, b->kept_lost);
        if (within)
            MODEL(write_sample)(b, lane, b->kept, b->kept_sums, b->kept_lost, NULL);
    }
    l->kept = good ? t : -HUGE_VAL;
    l->run->sample += within;
    return 1;
}

/*
 * Whether an accepted step needs no more steps for samples: none is due within it, and its ledger
 * is not behind that of the last sample.
 */
static int MODEL(all_sampled)(MODEL(batch) *b, int lane)
{
    MODEL(lane) *l = b->lane + lane;
    if (MODEL(samples_left)(b, l))
        l->phase = SAMPLE;
    else if (MODEL(production_falls)(b, lane, b->part) && MODEL(step_end)(b, l) > l->kept)
        l->phase = RESUME;
    else
        return 1;
    return 0;
}

/* Write the samples that are due at the time of a lane's run. */
static void MODEL(sample_here)(MODEL(batch) *b, int lane)
{
    MODEL(lane) *l = b->lane + lane;
    for (; l->run->sample < b->samples && b->times[l->run->sample] <= l->t; ++l->run->sample)
        if (MODEL(production_falls)(b, lane, NULL))
            MODEL(write_sample)(b, lane, b->kept, b->kept_sums, b->kept_lost, NULL);
        else
            MODEL(write_sample)(b, lane, b->m.x, b->sums, b->lost, NULL);
}
