/*
 * The lengths of steps with a tolerance: by their errors, up to switches that are foreseen, after switches, and
 * below lengths at which Newton's method failed. Comes after samples.c.
 */

/* The step length is proportional to about this power of the error where steps contain kinks. */
#define OVER_KINKS (-1.0 / 3.0)
/* Safety factors: the next step is this times the one whose estimated error equals the tolerance. */
#define PART 0.82
#define PART_OVER 0.9
/* An error may be small by chance: a step is at most this much longer than the last one allowed. */
#define SUDDEN 1.5
/* Steps stay below this part of a length that could not be solved; that length grows by LESS_HARD each step. */
#define BELOW_HARD 0.6
#define LESS_HARD 2.0
/*
 * The most steps in a row that are aimed at a switch, since at rest switches follow each other without end; and
 * the fraction of its length by which such a step is to end behind a switch of which nothing is known.
 */
enum { MOST_AIMS = 2 };
#define OVER_SWITCH (0.5 * BEHIND)
/* The first step after a switch of which nothing is known yet is this part of the one before. */
#define AFTER_SWITCH 0.3
/* The length kept for steps after a switch grows by at most this factor from one passage to the next. */
#define MORE_AFTER 1.5

/* Intervals between switches are alike if they differ by less than this part, as in periodic motions. */
#define ALIKE 0.02

/* The factor by which the next steps may be longer than these, by the errors of these. */
static real MODEL(growth)(const MODEL(batch) *b, real error)
{
    const mask over = b->m.over, positive = error > 0.0, none = error == 0.0;
    const real power = chosen(over, wide(OVER_KINKS), wide(-0.5 / STAGES));
    const real more = chosen(over, wide(PART_OVER), wide(PART)) * exp_of(power * log_of(error));
    return chosen(positive, more, chosen(none, wide(8.0), wide(0.25)));
}

/* Keep how long a step may be after the switch at which this step began. */
static void MODEL(keep_after)(MODEL(batch) *b, const MODEL(lane) *l, int lane, double most)
{
    double *const after = &LANE(b->after, l->turned, lane);
    const double allowed = l->whole * MODEL(lesser)(l->longer, most);
    *after = *after > 0.0 ? MODEL(lesser)(allowed, MORE_AFTER * *after) : allowed;
}

/*
 * Keep the interval between the last switch and the one at which a step ended, and which switch that is. A
 * function has two rows of `interval`, one per sign at the step's begin. An interval unlike the previous one is
 * kept as negative: no switch is expected from it, but the next interval is compared with it.
 */
static void MODEL(learn_interval)(MODEL(batch) *b, MODEL(lane) *l, int lane)
{
    if (l->passing >= 0) {
        double *const interval = &LANE(b->interval, l->passing, lane);
        const double found = l->t - l->beyond - l->passed, before = fabs(*interval);
        *interval = fabs(found - before) <= ALIKE * before ? found : -found;
        LANE(b->successor, l->passing, lane) = (double)l->which;
    }
    l->passed = l->t - l->beyond;
    l->passing = 2 * l->which + (LANE(b->side, l->which, lane) > 0.0);
    MODEL(recall_passage)(b, l, lane);
}

/* If no switch is foreseen, expect the one that followed the last switch before, after the same interval. */
static void MODEL(expect_switch)(const MODEL(batch) *b, MODEL(lane) *l, int lane)
{
    if (l->goal >= 0 || l->passing < 0 || IN(b->m.over, lane))
        return;
    const double ahead = l->passed + LANE(b->interval, l->passing, lane) - l->t;
    if (ahead > 0.0) {
        l->ahead = ahead;
        l->goal = (long)LANE(b->successor, l->passing, lane);
    }
}

/*
 * The length of the step after an accepted one, at most `most` times longer by its error. A step that was aimed
 * at a switch and did not meet it was too short to judge by: the length it would have had counts.
 */
static void MODEL(next_length)(MODEL(batch) *b, MODEL(lane) *l, int lane, double most)
{
    const int switches = l->which >= 0, last = l->last && l->step == l->whole;
    const double missed = switches ? 0.0 : l->aimed;
    if (l->turned >= 0 && l->aimed == 0.0)
        MODEL(keep_after)(b, l, lane, most);
    if (switches) {
        const double after = LANE(b->after, l->which, lane), whole = MODEL(greater)(l->whole, l->aimed);
        l->h = after > 0.0 ? after : MODEL(lesser)(l->longer, AFTER_SWITCH) * whole;
        l->steady = HUGE_VAL;
    } else {
        const double allowed = l->step * l->longer;
        if (!last) {
            l->h = MODEL(lesser)(l->step * MODEL(lesser)(l->longer, most), SUDDEN * l->steady);
            l->steady = MODEL(greater)(allowed, missed);
        }
        l->h = MODEL(greater)(l->h, MODEL(lesser)(allowed, missed));
    }
    if (switches)
        MODEL(learn_interval)(b, l, lane);
    MODEL(expect_switch)(b, l, lane);
    l->turned = l->which;
    l->h = MODEL(lesser)(l->h, BELOW_HARD * l->hard);
    l->hard *= LESS_HARD;
    const double over = l->goal < 0 ? 0.0 : MODEL(over_switch)(b, lane, l->goal, l->ahead, OVER_SWITCH);
    const double to_switch = l->ahead * (1.0 + over);
    const int aims = missed == 0.0 && l->aims < MOST_AIMS && to_switch < l->h;
    l->aimed = aims ? l->h : 0.0;
    l->aims = aims ? l->aims + 1 : 0;
    l->h = aims ? to_switch : l->h;
    l->ahead = HUGE_VAL;
}
