/*
 * Runs of collocation steps, one run in each lane of a vector.  Comes after gauss.c; batch.c assigns runs
 * to lanes.
 *
 * A step keeps the branches that hold at its beginning.  If a switching function changes its sign
 * within the step, the step is repeated so that it ends there, and the next one begins on the other
 * branch.  The first solution is only as accurate as it takes to locate the switch.  Runs with many
 * switches may step over them instead: then each stage chooses its branches.
 *
 * All lanes solve one step at a time together (dispatch.c), each for a purpose of its own.
 */

/* A run: what it is given, its current state, and its results at samples. */
typedef struct {
    const MODEL(parameters) *p;
    const MODEL(segment) *segments;  /* from the one that t lies in */
    double *x;                       /* n: at t */
    double *largest;                 /* n: the largest magnitude of each state */
    const double *noise;             /* n: how far round-off moves each state at rest; else 0 */
    double *ledger;                  /* (2, booked): sums until t, and what rounding lost of them */
    double *states, *sums;           /* (samples, n), (samples, booked) */
    double t;
    long sample, steps, rejected, switched, iterations, failed;
} MODEL(run);

/*
 * The purpose of a lane's step: the run's next one (STEP), the same up to a switch (CUT), or a sample
 * (SAMPLE, RESUME; see samples.c).  BEGIN: rates at the current state are not known yet.
 */
enum { IDLE, BEGIN, STEP, CUT, SAMPLE, RESUME };

/*
 * The state of a lane.  `known` is the length of the last step whose stage rates are known, from which
 * rates are predicted: it begins at t, or ends there if `behind` is 1; 0 if there is none.
 */
typedef struct {
    MODEL(run) *run;
    const MODEL(segment) *segment;
    double t, h;
    double length, whole, step, part; /* lengths: this step, before cuts, accepted; the fraction to cut at */
    double known, longer;
    double kept;   /* time of the last sample, or -HUGE_VAL */
    int written;   /* whether the current sample is written, though its step is repeated */
    double steady; /* the length that the step before was allowed by its error, without switches */
    double hard;   /* the length of the last step that Newton's method did not solve, growing since */
    double aimed;  /* the length that a step aimed at a switch would have had without the switch; or 0 */
    double ahead;  /* time from the end of the step to the next switch, or HUGE_VAL */
    long goal;     /* the next switch; -1 if none */
    double beyond; /* by how much time the step ends behind its switch */
    double passed; /* time of the last switch */
    long passing;  /* the row of `interval` of that switch; -1 if there was none */
    int phase, behind, predicted, last, cuts, refused, halved;
    int idle;    /* switches in a row at one time */
    int aims;    /* steps in a row that were to end behind a switch */
    int stuck;   /* whether steps go over kinks because they could not end at them */
    int crawled; /* steps in a row that are hardly longer than round-off of the time */
    int to_round_off; /* how many more steps are solved to round-off: see residual.c */
    int settled; /* whether no switch was located after all: the step is solved to full accuracy */
    long which, turned; /* the switch at the end of the step, and at its beginning; -1 if none */
    long recorded, recalled;   /* how many steps are recorded; the number of the one to recall, or -1 */
    double iterations;         /* of the run's own steps, without those for samples */
    double drift;              /* growth of what changes from one time to the next, in the last step */
    int records, recalls, repeats; /* whether steps are recorded; one is recalled; it predicts best */
    double since, pace[2]; /* when the mode at kinks was chosen; time covered per solve in each mode */
    long solves, comparisons;     /* steps solved since then; how often modes were compared */
} MODEL(lane);

/*
 * The last steps of a run, by which those are predicted that repeat them (predict.c). Switching functions have two
 * rows each, by their sign before the switch.
 */
typedef struct {
    long steps;                  /* how many steps are recorded at most; 0 if none are */
    real *first;                 /* 2*branches: number of the first step after the last such switch, or -1 */
    real *begin, *length;        /* steps: when each began after its switch; its length */
    real *rates, *change;        /* (steps, STAGES, n): rates, and their change since the last time */
    real *aligned;               /* (STAGES, n): rates of the recalled step, at the stages of the current one */
    real *last_change, *by_step; /* n, at the last stage: the change; what the step before predicts */
} MODEL(history);

/* What each step of a run begins with; see replay.c. */
typedef struct {
    const MODEL(segment) *segments; /* of the run, from its begin */
    real *scale;                    /* n: magnitudes of states, by which changes count as round-off */
    double *t, *h, *x, *branch;     /* steps; (steps, n); (steps, STAGES, branches) */
    long count;
} MODEL(tape);

/* Runs, and the working arrays of lanes. */
typedef struct {
    MODEL(block) m;
    MODEL(tape) *tape; /* of one run, or NULL */
    MODEL(lane) lane[REAL_WIDTH];
    MODEL(run) *runs;
    MODEL(wave) *waves;  /* of each input */
    const double *times; /* of samples */
    long count, next, samples;
    int over_kinks, either; /* whether steps go over kinks, or, in turn, end at them or go over */
    double stop, tolerance, first, longest, fixed;
    double beyond; /* part of a step that may lie beyond the switch at its end, where no stage lies */
    real *rate, *side, *sums, *lost, *known;       /* at the beginning of a step; of the step before */
    real *rings; /* n: whether a state is so stiff that it rings undamped; see error.c */
    mask ringing; /* lanes with such states */
    real *after; /* branches: the length for a step after each switch; 0: not known */
    real *widest; /* branches: the largest magnitude of each switching function so far */
    real *interval, *successor; /* 2*branches: see learn_interval */
    MODEL(history) past;
    real *slack; /* branches: by how much time a step may end behind each switch; 0: not known */
    real *kept, *kept_sums, *kept_lost; /* at the last sample */
    real *kept_branch;                  /* branches of the run, while a step begins at the last sample */
    real *end_rate, *end_side, *end_branch, *part; /* at its end; what it adds to sums */
    real *some_rate, *some_left, *some_side, *some_rows, *some_margin, *some_inputs;
    real *end_inputs; /* of the current step, where it is known */
    long sizes[SIZES];
} MODEL(batch);

enum { MOST_REFUSED = 200, MOST_CUTS = 4 };
/* How many steps are recorded, of models with at most so many states. */
enum { MOST_RECORDED = 64, MOST_STATES_RECORDED = 64 };
/* Steps, with their samples, that are solved to round-off after a step of the run whose residuals cannot be heat. */
enum { TO_ROUND_OFF = 20 };
/*
 * A run ends after this many steps in a row that are at most CRAWL times the time at its end: at the edge
 * of the domain a law may grow without bound, and 10^15 steps would not lead it over.
 */
enum { MOST_CRAWLED = 1000 };
#define CRAWL 4e-16
/* Halvings of a fixed step in all, until one of full length succeeds: a run with more fails. */
enum { MOST_HALVED = 1000 };
/* The shortest fraction of a fixed step. */
#define SHORTEST_PART 1e-15
/* A mode at kinks is kept for TRIED solves; the slower one is tried anew after AGAIN comparisons. */
enum { TRIED = 32, AGAIN = 12 };
/* Rates before a switch predict those after it, in a step at most this much longer than theirs. */
#define LIKE_BEFORE 2.0
/* A refused step is repeated up to where a path functional begins to yield, if before this part. */
#define YIELDS 0.999
/*
 * A switching function below this fraction of its largest magnitude may be round-off, as at rest. Its sign change
 * is ignored if it alters the step by less than NO_DIFFERENCE tolerances: else many short steps might follow.
 */
#define NO_SWITCH 1e-13
#define NO_DIFFERENCE 1e-5
/* A switch within this fraction of a step from its end, or its beginning, counts as there. */
#define AT_END 1e-9
#define AT_ONCE 1e-12
/*
 * A step may end somewhat beyond its switch, where no stage lies: by at most the fraction BEHIND of its length, and
 * so that the error, by the rates on both sides, is at most KINK_ERROR of the tolerance. Such errors have one sign
 * and add up: the bound falls with the number of switches of the run, to half of it after MANY_KINKS.
 */
#define BEHIND (0.99 * (1.0 - stage_at[STAGES - 1]) < 0.05 ? 0.99 * (1.0 - stage_at[STAGES - 1]) : 0.05)
#define KINK_ERROR 0.1
#define MANY_KINKS 50.0
/*
 * The error, as a fraction of the tolerance, by which a step may end beyond a switch if the step is fixed or nothing
 * is known of the switch yet. It is proportional to the distance at a jump, and to its square at a kink.
 */
#define BEYOND 0.01

/* The inputs of some lanes at the times t. */
static void MODEL(inputs_at)(const MODEL(batch) *b, mask where, real t, real *u)
{
    for (long k = 0; k < b->m.inputs; ++k) {
        real value = MODEL(sines)(b->waves + k, t);
        if (any(where & (b->waves[k].others > 0.0)))
            for (int lane = 0; lane < REAL_WIDTH; ++lane)
                if (IN(where, lane) && LANE(&b->waves[k].others, 0, lane) > 0.0)
                    LANE(&value, 0, lane) =
                        MODEL(other_at)(b->lane[lane].segment->signals + k, LANE(&t, 0, lane));
        u[k] = chosen(where, value, u[k]);
    }
}

/* The current time of the run in each lane. */
static real MODEL(now)(const MODEL(batch) *b)
{
    real t = zero;
    for (int lane = 0; lane < REAL_WIDTH; ++lane)
        LANE(&t, 0, lane) = b->lane[lane].t;
    return t;
}

/* As fmin and fmax, but no calls, and without their answer to nan. */
static inline double MODEL(lesser)(double a, double b)
{
    return a < b ? a : b;
}

static inline double MODEL(greater)(double a, double b)
{
    return a > b ? a : b;
}

/* Rates, switching functions and margins at a point; `weight` as in newton.c. */
static void MODEL(point)(MODEL(batch) *b, const real *x, const real *branch, const double *weight,
                         real *rate, real *side)
{
    MODEL(at_point)(&b->m, x, branch, b->some_inputs, weight, rate, b->some_rows, side,
                    b->some_margin);
}

/* Copy numbers in some lanes. */
static void MODEL(copy)(mask where, const real *from, real *to, long size)
{
#if REAL_WIDTH == 1
    if (where)
        memcpy(to, from, (size_t)size * sizeof(real));
#else
    for (long k = 0; k < size; ++k)
        to[k] = chosen(where, from[k], to[k]);
#endif
}

/* The same from an array that is not needed any more: for all lanes, the two change places. */
static void MODEL(take)(mask where, real **from, real **to, long size)
{
    if (any(none_of(where))) {
        MODEL(copy)(where, *from, *to, size);
        return;
    }
    real *const taken = *from;
    *from = *to;
    *to = taken;
}

/* Rates and switching functions at the current states; lanes in `choosing` choose branches, too. */
static void MODEL(rates_here)(MODEL(batch) *b, mask where, mask choosing)
{
    MODEL(block) *m = &b->m;
    MODEL(inputs_at)(b, where, MODEL(now)(b), b->some_inputs);
    for (int again = 0; again < 3; ++again) {
        MODEL(point)(b, m->x, m->branch, NULL, b->some_rate, b->some_side);
        if (!any(MODEL(choose)(m->branches, b->some_side, m->branch, choosing)))
            break;
    }
    for (long i = 1; i < STAGES; ++i)
        MODEL(copy)(choosing, m->branch, m->branch + i * m->branches, m->branches);
    MODEL(copy)(where, b->some_rate, b->rate, m->n);
    MODEL(copy)(where, b->some_side, b->side, m->branches);
}

/* The next break of the inputs, or the end of the run. */
static double MODEL(until)(const MODEL(batch) *b, const MODEL(lane) *l)
{
    return MODEL(lesser)(l->segment->stop, b->stop);
}

/* Where the accepted step of a lane ends. */
static double MODEL(step_end)(const MODEL(batch) *b, const MODEL(lane) *l)
{
    double until = MODEL(until)(b, l);
    if (!(l->last && l->step == l->whole))
        return l->t + l->step;
    if (b->fixed > 0.0 && l->run->sample < b->samples && b->times[l->run->sample] < until)
        until = b->times[l->run->sample];
    return until;
}

/* Whether samples of a lane lie within its accepted step. */
static int MODEL(samples_left)(const MODEL(batch) *b, const MODEL(lane) *l)
{
    return b->fixed == 0.0 && l->run->sample < b->samples
        && b->times[l->run->sample] < MODEL(step_end)(b, l);
}

/*
 * Where the step for a sample begins, and where it ends: one that begins at a sample may go on to
 * the end of the run's step.
 */
static double MODEL(begin)(const MODEL(lane) *l)
{
    return l->phase == RESUME ? l->kept : l->t;
}

static double MODEL(target)(const MODEL(batch) *b, const MODEL(lane) *l)
{
    return MODEL(samples_left)(b, l) ? b->times[l->run->sample] : MODEL(step_end)(b, l);
}

/* Plan a lane's next step: its length. */
static void MODEL(plan)(const MODEL(batch) *b, MODEL(lane) *l)
{
    double until = MODEL(until)(b, l), longest = MODEL(lesser)(l->h, b->longest);
    if (l->phase == STEP) {
        if (b->fixed > 0.0) {
            if (l->run->sample < b->samples && b->times[l->run->sample] < until)
                until = b->times[l->run->sample];
            const double left = until - l->t, steps = ceil(left / longest * (1.0 - 1e-9));
            l->last = steps <= 1.0;
            l->whole = l->last ? left : left / steps;
        } else {
            const double left = until - l->t;
            l->last = longest >= left;
            l->whole = l->last ? left : longest > 0.5 * left ? 0.5 * left : longest;
        }
        l->length = l->whole;
        l->cuts = 0;
        l->which = -1;
    } else if (l->phase == CUT)
        l->length = l->part * l->known;
    else
        l->length = MODEL(target)(b, l) - MODEL(begin)(l);
}

/* What a step adds to the ledger. */
static void MODEL(increments)(const MODEL(batch) *b, real h, real *out)
{
    const MODEL(block) *m = &b->m;
    for (long k = 0; k < m->booked; ++k) {
        real sum = zero;
        for (long i = 0; i < STAGES; ++i)
            sum += stage_weight[i] * m->rows[i * m->booked + k];
        out[k] = h * sum;
    }
}
