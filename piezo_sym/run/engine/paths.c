/*
 * Runs through intervals: a survey, a march of equal steps, or, with a tolerance, four paths side
 * by side.  Behind stepper.c, whose steps they take; fleet.c does the same with lanes of vectors.
 */

/* The error of a step, to second order, is that of its quarters, and this many times more. */
#define FINEST 15.0
/* A step may end so many tolerances from its prediction, unless shorter ones end much closer. */
#define STRANGE 5.0
/* An interval whose error is below this share of the tolerance: the next takes half the steps. */
#define MUCH_TOO_FINE 0.05

/*
 * A run among others: paths through one mesh, `fine`, `middle` with half its steps, `coarse` with a
 * quarter, and `trial`, as coarse but from the fine one; arrays for results at samples, a row each.
 */
typedef struct {
    MODEL(model) model;
    MODEL(path) fine, middle, coarse, trial;
    double *kept;      /* of n and of 2 rows: state and ledger of `fine` before an interval */
    double *tolerance; /* of n: for the error of an interval */
    double *out_x, *out_fine, *out_sums;
    long level, done, steps, failed;
} MODEL(member);

/*
 * Intervals that members go through: of lengths h[k]; u[level - lowest] holds, for levels lowest to
 * highest, the inputs at the middles of all steps of all intervals, or nothing; those of the lowest
 * are there.  Results after interval k go to row sample[k], if it is not negative.  If inputs jump
 * before interval 0, and starts are asked for, first[level - lowest] holds those of the quarters of
 * its first step.
 */
typedef struct {
    long intervals, lowest, highest;
    const double *h;
    const double *const *u;
    const long *sample;
    const double *const *first;
} MODEL(block);

/* The inputs of the quarters of an interval's first step, or none. */
static const double *MODEL(first)(const MODEL(block) *b, long interval, long level)
{
    return b->first && interval == 0 ? b->first[level - b->lowest] : NULL;
}

/* How many steps a level has: 1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 14, 16, 20 ... */
static long MODEL(steps_at)(long level)
{
    return level < 3 ? level + 1 : (4 + (level - 3) % 4) << ((level - 3) / 4);
}

/* One step over each interval, on the trial path: tolerance[n] becomes the largest |x[n]| met. */
void MODEL(survey)(MODEL(member) *members, long count, const MODEL(block) *b);
void MODEL(survey)(MODEL(member) *members, long count, const MODEL(block) *b)
{
    for (MODEL(member) *s = members; s < members + count; ++s) {
        for (; s->done < b->intervals && !s->failed; ++s->done) {
            const double *x = s->trial.x, *u = b->u[0] + s->done * s->model.inputs;
            const double *first = MODEL(first)(b, s->done, b->lowest);
            s->failed = !MODEL(across)(&s->model, &s->trial, u, b->h[s->done], 1, first);
            if (s->failed)
                break;
            for (long i = 0; i < s->model.n; ++i)
                s->tolerance[i] = fabs(x[i]) > s->tolerance[i] ? fabs(x[i]) : s->tolerance[i];
        }
    }
}

/* One step over each interval, on the fine path. */
void MODEL(march)(MODEL(member) *members, long count, const MODEL(block) *b);
void MODEL(march)(MODEL(member) *members, long count, const MODEL(block) *b)
{
    for (MODEL(member) *s = members; s < members + count; ++s) {
        const MODEL(model) *m = &s->model;
        for (; s->done < b->intervals; ++s->done, ++s->steps) {
            const double *u = b->u[0] + s->done * m->inputs;
            const double *first = MODEL(first)(b, s->done, b->lowest);
            const long row = b->sample[s->done];
            if (s->failed || !MODEL(across)(&s->model, &s->fine, u, b->h[s->done], 1, first)) {
                s->failed = 1;
                break;
            }
            if (row < 0)
                continue;
            memcpy(s->out_x + row * m->n, s->fine.x, (size_t)m->n * sizeof(double));
            memcpy(s->out_sums + row * m->rows, s->fine.sums, (size_t)m->rows * sizeof(double));
        }
    }
}

/* The level with twice the steps of a level. */
static long MODEL(twice)(long level)
{
    return level > 2 ? level + 4 : 2 * level + 1;
}

/* The level with half the steps of a level, or the next below. */
static long MODEL(coarser)(long level)
{
    return level > 6 ? level - 4 : level > 0 ? (level - 1) / 2 : 0;
}

/*
 * The level after one whose error was `worst` times as large as it may be, or not even a number.
 * Four levels halve the steps, and the error falls by four.
 */
static long MODEL(raised)(long level, double worst)
{
    if (worst < 12.0)
        return level + (worst < 1.6 ? 1 : worst < 2.3 ? 2 : worst < 3.1 ? 3 : 4);
    return level + (worst < 50.0 ? 6 : 8);
}

/* The level after one whose error was `worst`: half the steps, up to thrice, if that is small. */
static long MODEL(lowered)(long level, double worst)
{
    for (int k = 0; k < 3 && worst < MUCH_TOO_FINE; ++k, worst *= 4.0)
        level = MODEL(coarser)(level);
    return level;
}

static int MODEL(has)(const MODEL(block) *b, long level)
{
    return level >= b->lowest && level <= b->highest && b->u[level - b->lowest];
}

/* Whether a block has the inputs of the three levels that a member's next interval needs. */
static int MODEL(levels_there)(const MODEL(member) *s, const MODEL(block) *b)
{
    const long half = MODEL(twice)(s->level), quarter = MODEL(twice)(half);
    return MODEL(has)(b, s->level) && MODEL(has)(b, half) && MODEL(has)(b, quarter);
}

/* Remember where the fine path is: its state and its ledger. */
static void MODEL(keep)(const MODEL(member) *s)
{
    const size_t n = (size_t)s->model.n, rows = (size_t)s->model.rows;
    memcpy(s->kept, s->fine.x, n * sizeof(double));
    memcpy(s->kept + n, s->fine.sums, rows * sizeof(double));
    memcpy(s->kept + n + rows, s->fine.lost, rows * sizeof(double));
}

static void MODEL(back)(MODEL(member) *s)
{
    const size_t n = (size_t)s->model.n, rows = (size_t)s->model.rows;
    memcpy(s->fine.x, s->kept, n * sizeof(double));
    memcpy(s->fine.sums, s->kept + n, rows * sizeof(double));
    memcpy(s->fine.lost, s->kept + n + rows, rows * sizeof(double));
    s->fine.h = s->middle.h = s->coarse.h = s->trial.h = 0.0;
    s->fine.h_prior = s->middle.h_prior = s->coarse.h_prior = s->trial.h_prior = 0.0;
}

/* A path's steps over the interval at hand, as many as a level has. */
static int MODEL(along)(MODEL(member) *s, MODEL(path) *path, const MODEL(block) *b, long level)
{
    const long steps = MODEL(steps_at)(level);
    const double *u = b->u[level - b->lowest] + s->model.inputs * steps * s->done;
    const double h = b->h[s->done] / (double)steps;
    s->steps += steps;
    return MODEL(across)(&s->model, path, u, h, steps, MODEL(first)(b, s->done, level));
}

/* The fine path and the trial one, which begins from its state, are to tell how far they stray. */
static void MODEL(watch)(MODEL(member) *s)
{
    s->fine.tolerance = s->trial.tolerance = s->tolerance;
    s->fine.surprise = s->trial.surprise = 0.0;
}

/*
 * What the surprises of steps, `fine`, and of four times as long ones, `coarse`, say of an error,
 * in parts of what is allowed.  A law that all but jumps within a step leaves an error in proportion
 * to it.  All paths make the same one where the jump comes soon after an end that they share, and
 * their distances tell nothing; but none expects it.  The surprise of shorter steps is a quarter
 * then.  It is a sixteenth at a kink, a 64th where all is smooth: distances tell more there.  Fast
 * modes that ring surprise all steps alike.
 */
static double MODEL(strange)(double fine, double coarse)
{
    const double of_a_jump = fmin(1.0, 4.0 * fine / fmax(coarse, 1e-300));
    return fine * of_a_jump * of_a_jump / STRANGE;
}

/*
 * One interval: as many steps as its level says, and twice and four times as many.  Returns its
 * error in parts of what is allowed: how far steps and quarter steps from the finest state end
 * apart, in FINEST times the tolerance, or, if that is more, how strange they are.  Negative if
 * there is no step.
 */
static double MODEL(try)(MODEL(member) *s, const MODEL(block) *b)
{
    const long level = s->level, half = MODEL(twice)(level), quarter = MODEL(twice)(half);
    double worst = 0.0;
    MODEL(watch)(s);
    memcpy(s->trial.x, s->fine.x, (size_t)s->model.n * sizeof(double));
    if (!MODEL(along)(s, &s->trial, b, level) || !MODEL(along)(s, &s->fine, b, quarter))
        return -1.0;
    for (long i = 0; i < s->model.n; ++i) {
        const double ratio = fabs(s->fine.x[i] - s->trial.x[i]) / (FINEST * s->tolerance[i]);
        worst = worst != worst || ratio <= worst ? worst : ratio;
    }
    const double strange = MODEL(strange)(s->fine.surprise, s->trial.surprise);
    worst = strange > worst ? strange : worst; /* which may be no number */
    if (!(worst <= 1.0))
        return worst;
    if (!MODEL(along)(s, &s->coarse, b, level) || !MODEL(along)(s, &s->middle, b, half))
        return -1.0;
    return worst;
}

/*
 * How much of the extrapolation counts.  Where the error falls with the step, the finer two of the
 * paths lie closer by four: all.  Where they are hardly closer, or not at all, the coarser ones have
 * lost their way, and to draw conclusions from them would do harm: none.
 */
static double MODEL(trust)(const MODEL(member) *s)
{
    const double *fine = s->fine.x, *middle = s->middle.x, *coarse = s->coarse.x;
    double apart = 0.0, closer = 0.0;
    for (long i = 0; i < s->model.n; ++i) {
        apart = fmax(apart, fabs(middle[i] - coarse[i]) / s->tolerance[i]);
        closer = fmax(closer, fabs(fine[i] - middle[i]) / s->tolerance[i]);
    }
    return closer <= 0.75 * apart ? fmin(1.0, 3.0 - 4.0 * closer / fmax(apart, 1e-300)) : 0.0;
}

/*
 * What the three paths tell of one state's error: a third of the finer two's distance, `then`,
 * mends order two.  Where the error is even in the step, that of the coarser two, `first`, is four
 * times as large, and what is missing mends order four as well.  Steps that meet kinks or fast modes
 * leave errors that are not: there the missing part tells nothing.
 */
static double MODEL(mended)(double first, double then)
{
    const double missing = 4.0 * then - first;
    const double even = fmin(1.0, 2.0 - 5.0 * fabs(missing) / fmax(fabs(then), 1e-300));
    return then + fmax(0.0, even) * missing / 15.0;
}

/* Writes the state extrapolated from the three paths, the finest one and its ledger. */
static void MODEL(write)(const MODEL(member) *s, long row)
{
    const long n = s->model.n, rows = s->model.rows;
    double *restrict best = s->out_x + row * n;
    const double *fine = s->fine.x, *middle = s->middle.x, *coarse = s->coarse.x;
    const double trust = MODEL(trust)(s);
    for (long i = 0; i < n; ++i) {
        const double first = (middle[i] - coarse[i]) / 3.0, then = (fine[i] - middle[i]) / 3.0;
        best[i] = fine[i] + trust * MODEL(mended)(first, then);
    }
    memcpy(s->out_fine + row * n, fine, (size_t)n * sizeof(double));
    memcpy(s->out_sums + row * rows, s->fine.sums, (size_t)rows * sizeof(double));
}

/*
 * Runs a mesh, its halves and its quarters side by side, each with a state of its own.  How finely
 * an interval is divided is chosen on the way, so that steps and quarter steps from the finest
 * state end within FINEST times the tolerance of each other, and none ends where it is strange.  A
 * member stops before an interval that needs a level that is not there, and for good where a step
 * has no solution.
 */
void MODEL(adapt)(MODEL(member) *members, long count, const MODEL(block) *b);
void MODEL(adapt)(MODEL(member) *members, long count, const MODEL(block) *b)
{
    for (MODEL(member) *s = members; s < members + count; ++s) {
        while (s->done < b->intervals && !s->failed) {
            if (!MODEL(levels_there)(s, b))
                break;
            MODEL(keep)(s);
            const double worst = MODEL(try)(s, b);
            if (worst < 0.0) {
                MODEL(back)(s);
                s->failed = 1;
            } else if (!(worst <= 1.0)) {
                MODEL(back)(s);
                s->level = MODEL(raised)(s->level, worst);
            } else {
                if (b->sample[s->done] >= 0)
                    MODEL(write)(s, b->sample[s->done]);
                s->level = MODEL(lowered)(s->level, worst);
                ++s->done;
            }
        }
    }
}
