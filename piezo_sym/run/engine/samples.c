/*
 * Samples of runs.  Behind replay.c.
 *
 * A sample within a step is the end of a step of its own, which begins where the run's step begins, so
 * that its balances close, too.  The run itself does not depend on samples.
 *
 * Each of these steps has an error of its own: where little is produced between two samples, the later
 * one might show less heat or entropy than the one before.  Then its step is repeated from the sample
 * before (RESUME); and so are the following ones, from sample to sample, until the run itself has
 * produced as much.  A sample whose step finds no rates is repeated in the same way.
 */

/* Exchange the states of runs and of their last samples. */
static void MODEL(swap_begins)(MODEL(batch) *b, mask where)
{
    for (long k = 0; k < b->m.n; ++k) {
        const real x = b->m.x[k];
        b->m.x[k] = chosen(where, b->kept[k], x);
        b->kept[k] = chosen(where, x, b->kept[k]);
    }
}

/*
 * Let some lanes' steps begin at their last samples. Their stages choose branches: the run's step may end
 * a little beyond a switch, and where it has no stage these may have one.
 */
static void MODEL(begin_at_samples)(MODEL(batch) *b, mask where)
{
    MODEL(swap_begins)(b, where);
    MODEL(copy)(where, b->m.branch, b->kept_branch, STAGES * b->m.branches);
    b->m.over |= where;
}

/* Undo begin_at_samples; `over`: the lanes that step over kinks. */
static void MODEL(begin_at_runs)(MODEL(batch) *b, mask where, mask over)
{
    MODEL(swap_begins)(b, where);
    MODEL(copy)(where, b->kept_branch, b->m.branch, STAGES * b->m.branches);
    b->m.over = over;
}

/* An entry of a lane's ledger, after a step if `more` is given. */
static double MODEL(total)(const real *sums, const real *lost, const real *more, long k, int lane)
{
    return LANE(sums, k, lane) + (more ? LANE(more, k, lane) - LANE(lost, k, lane) : 0.0);
}

/* Whether a lane's sums, with what a step adds, have less heat or entropy produced than its last sample. */
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

/* Write a row of samples: the state, and sums with what a step adds to them. */
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

/* Keep the state and ledger of a sample, where the next sample's step may begin. */
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

/* Whether a failed step for a sample can be left out: the sample is written, or there is none. */
static int MODEL(sample_stands)(const MODEL(batch) *b, int lane)
{
    const MODEL(lane) *l = b->lane + lane;
    return l->phase == RESUME && (l->written || !MODEL(samples_left)(b, l));
}

/*
 * A step for a sample has no rates, or leaves the domain: stages may lie beyond a switch.  It is taken
 * again, with branches that stages choose, from the last sample or from where the run is.  Returns
 * whether there is that way.
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
 * A step for a sample is solved (`good`: as it has to be, which it may not be if it begins at the last
 * one): write the sample.  Returns whether it stays so, or is to be taken again.
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
 * Whether an accepted step has no sample left to take: none lies within, and its end, where a lane keeps a
 * sample ahead of its run, has one, too.
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

/* Write the samples of where a lane is. */
static void MODEL(sample_here)(MODEL(batch) *b, int lane)
{
    MODEL(lane) *l = b->lane + lane;
    for (; l->run->sample < b->samples && b->times[l->run->sample] <= l->t; ++l->run->sample)
        if (MODEL(production_falls)(b, lane, NULL))
            MODEL(write_sample)(b, lane, b->kept, b->kept_sums, b->kept_lost, NULL);
        else
            MODEL(write_sample)(b, lane, b->m.x, b->sums, b->lost, NULL);
}
