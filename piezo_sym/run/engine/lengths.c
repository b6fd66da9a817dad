/*
 * The lengths of steps with a tolerance: by their errors, up to switches that are seen before, after switches,
 * and below lengths that could not be solved. Comes after samples.c.
 */

/* The step length is proportional to about this power of the error where steps contain kinks. */
#define OVER_KINKS (-1.0 / 3.0)
/* Safety factor: the next step is this times the one whose estimated error equals the tolerance. */
#define PART_OF(over) ((over) ? 0.9 : 0.82)
/* An error may be small by chance: a step is at most this much longer than the last one allowed. */
#define SUDDEN 1.5
/*
 * Where the error is below SMALL, the power of the length that errors are proportional to is taken from two
 * steps, of which one was longer by LONGER, if it is above LEAST_POWER: by it, a step is at most MOST_LONGER
 * times longer.
 */
#define SMALL 0.1
#define LONGER 1.05
#define LEAST_POWER 3.0
#define MOST_LONGER 3.0
/* Steps are this much shorter than one that could not be solved, and less so with each of them. */
#define BELOW_HARD 0.6
#define LESS_HARD 2.0
/*
 * How many steps in a row may be aimed at a switch, since at rest switches follow each other without end; and
 * how far such a step goes over it.
 */
enum { MOST_AIMS = 2 };
#define OVER_SWITCH 1.1
/* The first step after a switch of which nothing is known yet is this part of the one before. */
#define AFTER_SWITCH 0.3
/* The length after a switch grows by no more than this factor from one time to the next. */
#define MORE_AFTER 1.5

/*
 * How much longer the next step may be. The error of a step is proportional to a known power of its length;
 * but one that earlier steps left in a stiff state depends on no length, as the error of another step shows.
 */
static double MODEL(growth)(const MODEL(lane) *l, double error, int over)
{
    if (!(error > 0.0))
        return error == 0.0 ? 8.0 : 0.25;
    const double usual = PART_OF(over) * pow(error, over ? OVER_KINKS : -0.5 / STAGES);
    const double change = l->length / l->compared;
    if (over || !(error < SMALL && l->error > 0.0 && change > LONGER))
        return usual;
    const double power = fmax(log(error / l->error) / log(change), LEAST_POWER);
    return fmax(usual, fmin(PART_OF(0) * pow(error / SMALL, -1.0 / power), MOST_LONGER));
}

/* Note how long a step may be that begins at the switch at which this one began. */
static void MODEL(keep_after)(MODEL(batch) *b, const MODEL(lane) *l, int lane, double most)
{
    double *const after = &LANE(b->after, l->turned, lane);
    const double allowed = l->whole * fmin(l->longer, most);
    *after = *after > 0.0 ? fmin(allowed, MORE_AFTER * *after) : allowed;
    LANE(b->tried, l->turned, lane) = l->whole;
    LANE(b->tried_error, l->turned, lane) = l->latest;
}

/*
 * The length of the step after one that was accepted; by its error it is at most `most` times longer. One
 * that was aimed at a switch, and did not meet it, says nothing of lengths: the length before counts.
 */
static void MODEL(next_length)(MODEL(batch) *b, MODEL(lane) *l, int lane, double most)
{
    const int switches = l->which >= 0, last = l->last && l->step == l->whole;
    const double missed = switches ? 0.0 : l->aimed;
    if (l->turned >= 0 && l->aimed == 0.0)
        MODEL(keep_after)(b, l, lane, most);
    if (switches) {
        const double after = LANE(b->after, l->which, lane), whole = fmax(l->whole, l->aimed);
        l->compared = LANE(b->tried, l->which, lane);
        l->error = LANE(b->tried_error, l->which, lane);
        l->h = after > 0.0 ? after : fmin(l->longer, AFTER_SWITCH) * whole;
        l->steady = HUGE_VAL;
    } else {
        const double allowed = l->step * l->longer;
        l->compared = l->step;
        l->error = l->latest;
        if (!last) {
            l->h = fmin(l->step * fmin(l->longer, most), SUDDEN * l->steady);
            l->steady = fmax(allowed, missed);
        }
        l->h = fmax(l->h, fmin(allowed, missed));
    }
    l->turned = l->which;
    l->h = fmin(l->h, BELOW_HARD * l->hard);
    l->hard *= LESS_HARD;
    const int aims = missed == 0.0 && l->aims < MOST_AIMS && OVER_SWITCH * l->ahead < l->h;
    l->aimed = aims ? l->h : 0.0;
    l->aims = aims ? l->aims + 1 : 0;
    l->h = aims ? OVER_SWITCH * l->ahead : l->h;
    l->ahead = HUGE_VAL;
}
