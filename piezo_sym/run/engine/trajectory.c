/*
 * Runs of collocation steps, one in each lane.  Behind gauss.c; batch.c says which runs there are.
 *
 * A step keeps the branches that hold where it begins; if a switching function changes its sign on
 * the way, the step is taken again to end there, and the next begins on the other branch.  The first
 * time it is solved no further than it takes to find the place.  Lanes of many switches may step over
 * them instead: then each stage chooses its branches.
 *
 * In a tick each lane takes one step: what it is for differs from lane to lane, how it is solved
 * does not.
 */

/*
 * An input between its breaks: a wave whose frequency may move; polynomials of Chebyshev, so many
 * terms each, between edges; or a function to call.
 */
typedef struct {
    double amplitude, frequency, rate, phase, offset;
    const double *edges, *coefficients;
    long pieces, terms;
    double (*called)(double);
} MODEL(signal);

/* Inputs until a time. */
typedef struct {
    double stop;
    const MODEL(signal) *signals;
} MODEL(segment);

/* A run: what it is given, where it stands, and what it leaves at samples. */
typedef struct {
    const MODEL(parameters) *p;
    const MODEL(segment) *segments;  /* from the one that t lies in */
    double *x;                       /* n: at t */
    double *largest;                 /* n: the largest magnitude of each state */
    double *ledger;                  /* (2, booked): sums until t, and what rounding lost of them */
    double *states, *sums;           /* (samples, n), (samples, booked) */
    double t;
    long sample, steps, rejected, switched, iterations, failed;
} MODEL(run);

/* What a lane's step is for: the run's next, the same up to a switch, or a sample; see samples.c. */
enum { IDLE, BEGIN, STEP, CUT, SAMPLE, RESUME };

/*
 * Where a lane is.  `known` is the length of the step whose rates are known: it begins at t, or lies
 * behind t and ends there; 0 if there is none.
 */
typedef struct {
    MODEL(run) *run;
    const MODEL(segment) *segment;
    double t, h;
    double length, whole, step, part; /* at hand, before cuts, accepted; part of it for a cut */
    double known, longer, after_switch;
    double kept;   /* when the last sample was, or -HUGE_VAL */
    int written;   /* whether the sample at hand is, though its step is taken again */
    double steady; /* the step that the errors of the step before ask for */
    int phase, behind, predicted, fresh, last, cuts, refused, halved;
    int settled; /* whether there is no switch in the step after all, so that it is solved to its end */
    long which; /* the switch at the end of the step; -1 if none */
    double since, pace[2]; /* when the way over kinks was chosen; how fast each way was */
    long ticks, looks;     /* steps solved since then; how often the ways were compared */
} MODEL(lane);

/* What the steps of a run begin with, from the first on; see replay.c. */
typedef struct {
    const MODEL(segment) *segments; /* of the run, from its begin */
    real *scale;                    /* n: by which changes of states count as noise */
    double *t, *h, *x, *branch;     /* steps; (steps, n); (steps, STAGES, branches) */
    long count;
} MODEL(tape);

/* Runs on their way. */
typedef struct {
    MODEL(block) m;
    MODEL(tape) *tape; /* of one run, or NULL */
    MODEL(lane) lane[REAL_WIDTH];
    MODEL(run) *runs;
    const double *times; /* of samples */
    long count, next, samples, either; /* `either`: steps end at kinks, or go over them */
    double stop, tolerance, first, longest, fixed;
    double beyond; /* so much of a step may lie beyond the switch at its end: no stage does */
    real *rate, *side, *sums, *lost, *known;       /* at the begin of a step; of the step before */
    real *kept, *kept_sums, *kept_lost; /* at the last sample */
    real *kept_branch;                  /* of the run, while a step begins there */
    real *end_rate, *end_side, *end_branch, *part; /* at its end; what it adds to sums */
    real *some_rate, *some_share, *some_side, *some_rows, *some_margin, *some_inputs;
    long sizes[SIZES];
} MODEL(batch);

enum { MOST_REFUSED = 200, MOST_CUTS = 4 };
/* So often a fixed step may be halved in all before one of full length succeeds: else a run creeps. */
enum { MOST_HALVED = 1000 };
/* No part of a fixed step is shorter. */
#define SHORTEST_PART 1e-15
/* A way is tried for so many solves; the slower one again after so many trials of the faster. */
enum { TRIED = 32, AGAIN = 12 };
/* With kinks within, the error of a step falls about as this power tells. */
#define OVER_KINKS (-1.0 / 3.0)
/*
 * The next step is this part of the one whose estimated error would be just what it may be: estimates
 * of smooth steps are of high powers of their lengths, and a step may find what the last did not.
 */
#define PART_OF(over) ((over) ? 0.9 : 0.82)
/* An error may be small by chance: steps grow to no more than this, in what the one before asks for. */
#define SUDDEN 1.5
/* A refused step is tried again up to where a path bends, if that is before this part of it. */
#define YIELDS 0.999
/* Parts of a step: so near to its end a switch is at its end; so near to its begin, at its begin. */
#define AT_END 1e-9
#define AT_ONCE 1e-12
/*
 * How far a step may go beyond its switch, where no stage lies.  What a kink adds to the error goes
 * with the square of that, about this part of the tolerance; what a jump adds, in proportion.
 */
#define BEYOND 0.01

/* The value of a signal in pieces. */
static double MODEL(piece_at)(const MODEL(signal) *s, double t)
{
    long low = 0, high = s->pieces;
    double last = 0.0, before = 0.0;
    while (high - low > 1) {
        const long middle = (low + high) / 2;
        if (t < s->edges[middle])
            high = middle;
        else
            low = middle;
    }
    const double begin = s->edges[low], end = s->edges[low + 1];
    const double z = fmin(fmax((2.0 * t - begin - end) / (end - begin), -1.0), 1.0);
    const double *const term = s->coefficients + low * s->terms;
    for (long k = s->terms - 1; k > 0; --k) {
        const double now = term[k] + 2.0 * z * last - before;
        before = last, last = now;
    }
    return term[0] + z * last - before;
}

static void MODEL(inputs_at)(const MODEL(segment) *segment, long inputs, double t, real *u, int lane)
{
    for (long k = 0; k < inputs; ++k) {
        const MODEL(signal) *s = segment->signals + k;
        const double turns = (s->frequency + 0.5 * s->rate * t) * t;
        double value = s->offset;
        if (s->called)
            value = s->called(t);
        else if (s->pieces)
            value = MODEL(piece_at)(s, t);
        else if (s->amplitude != 0.0)
            value += s->amplitude * sin(6.283185307179586476925 * turns + s->phase);
        LANE(u, k, lane) = value;
    }
}

/* Rates, switching functions and margins at a point; `weight` as in newton.c. */
static void MODEL(point)(MODEL(batch) *b, const real *x, const real *branch, const double *weight,
                         real *rate, real *side)
{
    MODEL(at_point)(&b->m, x, branch, b->some_inputs, weight, rate, b->some_rows, side,
                    b->some_margin);
}

static void MODEL(copy)(mask where, const real *from, real *to, long size)
{
    for (long k = 0; k < size; ++k)
        to[k] = chosen(where, from[k], to[k]);
}

/* Rates and switching functions where lanes stand; those of `choosing` take the branches that hold. */
static void MODEL(stand)(MODEL(batch) *b, mask where, mask choosing)
{
    MODEL(block) *m = &b->m;
    for (int lane = 0; lane < REAL_WIDTH; ++lane)
        if (IN(where, lane))
            MODEL(inputs_at)(b->lane[lane].segment, m->inputs, b->lane[lane].t, b->some_inputs, lane);
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

/* Until when inputs have no break, and the run goes on. */
static double MODEL(until)(const MODEL(batch) *b, const MODEL(lane) *l)
{
    return fmin(l->segment->stop, b->stop);
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

/* What a lane's next step is: its length, and the inputs at its stages. */
static void MODEL(plan)(const MODEL(batch) *b, MODEL(lane) *l, int lane)
{
    double until = MODEL(until)(b, l), longest = fmin(l->h, b->longest);
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
    for (long i = 0; i < STAGES; ++i)
        MODEL(inputs_at)(l->segment, b->m.inputs, MODEL(begin)(l) + stage_at[i] * l->length,
                         b->m.u + i * b->m.inputs, lane);
}

/* What a step adds to the sums of a ledger. */
static void MODEL(adds)(const MODEL(batch) *b, real h, real *out)
{
    const MODEL(block) *m = &b->m;
    for (long k = 0; k < m->booked; ++k) {
        real sum = zero;
        for (long i = 0; i < STAGES; ++i)
            sum += stage_weight[i] * m->rows[i * m->booked + k];
        out[k] = h * sum;
    }
}

/* Rates on the polynomial through those of a step, at a part of the step. */
static void MODEL(carry)(const MODEL(block) *m, const real *rates, real at, real *out)
{
    real weight[STAGES];
    MODEL(rate_weights)(at, weight);
    for (long k = 0; k < m->n; ++k) {
        real sum = zero;
        for (long j = 0; j < STAGES; ++j)
            sum += weight[j] * rates[j * m->n + k];
        out[k] = sum;
    }
}

/* Rates to begin Newton's method with: along the known step, or as they are at the begin. */
static void MODEL(predict)(MODEL(batch) *b, real behind, real slope, mask known)
{
    const MODEL(block) *m = &b->m;
    for (long i = 0; i < STAGES; ++i) {
        real *const rates = m->rates + i * m->n;
        MODEL(carry)(m, b->known, behind + slope * stage_at[i], rates);
        for (long k = 0; k < m->n; ++k) /* a fixed step may be much longer than what is fast */
            rates[k] = chosen(known, rates[k], b->fixed > 0.0 ? zero : b->rate[k]);
    }
}
