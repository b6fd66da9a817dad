/*
 * A path functional: what an element with an inner state z does while its coordinate C, whose rates
 * at the stages are its drive, follows a polynomial. Comes after gauss.c, for models that have
 * PATHS.
 *
 * Stage i is given the means int_0^1 (l_i/b_i) ... dtau of the effort F, of the slip's rate
 * dC/dt - dz/dt and of the heat. So h sum_i b_i F_i C'_i is the work int F dC, and z ends where its
 * path ends, wherever it begins or ceases to yield.
 */

/* Parts of a step: what happens before this is at its begin. */
#define BEGUN 1e-6
/* An inner state so near to its limit, relative to it, was put there by the step before. */
#define PUT_THERE 1e-14

/*
 * The path of a coordinate in a step: the coefficients of C(tau) - C(0) and of dC/dtau; its change
 * up to each stage and its rate there; a bound on |C(tau) - C(0)|. C is monotonic between turn[k]
 * and turn[k + 1]. `yields` is the first part of the step where z begins, or ceases, to yield, as it
 * does `times` times.
 */
typedef struct {
    double gone[STAGES + 1], speed[STAGES], at_stage[STAGES], rate[STAGES], turn[STAGES + 1];
    double h, most, yields, times;
    long pieces;
} MODEL(way);

/* Means for the stages: effort, rate of the slip and heat. */
typedef double MODEL(means)[SHARE][STAGES];

static double MODEL(polynomial)(const double *a, long degree, double at)
{
    double sum = a[degree];
    for (long n = degree; n-- > 0;)
        sum = a[n] + at * sum;
    return sum;
}

/*
 * Where a polynomial that is monotonic between two points has a value: Newton's method and
 * bisection.
 */
static double MODEL(meets)(const double *a, long degree, double value, double low, double high)
{
    const int rises = MODEL(polynomial)(a, degree, low) < MODEL(polynomial)(a, degree, high);
    double at = 0.5 * (low + high);
    for (int again = 0; again < 100; ++again) {
        double sum = a[degree], slope = 0.0;
        for (long n = degree; n-- > 0;) {
            slope = sum + at * slope;
            sum = a[n] + at * sum;
        }
        const double before = at;
        if ((sum < value) == rises)
            low = at;
        else
            high = at;
        at -= (sum - value) / slope;
        if (!(at > low && at < high))
            at = 0.5 * (low + high);
        if (fabs(at - before) <= 4e-16)
            break;
    }
    return at;
}

/* Find where a coordinate turns: zeros of its speed lie between those of the speed's derivative. */
static void MODEL(find_turns)(MODEL(way) *w)
{
    w->turn[0] = 0.0, w->turn[1] = 1.0, w->pieces = 1;
    for (long order = STAGES - 2; order >= 0; --order) {
        double a[STAGES], found[STAGES + 1] = {0.0};
        const long degree = STAGES - 1 - order;
        long pieces = 0;
        for (long n = 0; n <= degree; ++n) {
            a[n] = w->speed[n + order];
            for (long k = 1; k <= order; ++k)
                a[n] *= (double)(n + k);
        }
        for (long k = 0; k < w->pieces; ++k) {
            const double low = w->turn[k], high = w->turn[k + 1];
            const double at_low = MODEL(polynomial)(a, degree, low);
            if ((at_low < 0.0) != (MODEL(polynomial)(a, degree, high) < 0.0))
                found[++pieces] = MODEL(meets)(a, degree, 0.0, low, high);
        }
        found[++pieces] = 1.0;
        memcpy(w->turn, found, sizeof found);
        w->pieces = pieces;
    }
}

/* The path of a coordinate that has drive number i, in one lane's step. */
static void MODEL(find_way)(const MODEL(block) *m, double h, long i, int lane, MODEL(way) *w)
{
    double square = 0.0;
    (void)lane; /* a number has no lanes */
    w->h = h;
    w->gone[0] = 0.0;
    for (long j = 0; j < STAGES; ++j) {
        w->rate[j] = LANE(m->drive, j * m->drives + i, lane);
        square += stage_weight[j] * w->rate[j] * w->rate[j];
    }
    w->most = h * sqrt(square); /* the mean of |dC/dt| is at most its root mean square */
    for (long n = 0; n < STAGES; ++n) {
        double sum = 0.0, at_stage = 0.0;
        for (long j = 0; j < STAGES; ++j) {
            sum += along[j][n] * w->rate[j];
            at_stage += stage_reach[n][j] * w->rate[j];
        }
        w->gone[n + 1] = h * sum;
        w->speed[n] = (double)(n + 1) * h * sum;
        w->at_stage[n] = h * at_stage;
    }
    w->pieces = 0; /* found when needed */
}

/*
 * Add the means over a piece of a step in which F = at_begin + k (C - C(0)): z follows C, or
 * yields.
 */
static void MODEL(add_piece)(const MODEL(way) *w, double low, double high, double at_begin, double k,
                             int yields, MODEL(means) mean)
{
    for (long q = 0; q < STAGES; ++q) { /* exact: all integrands are of degree < 2s */
        const double at = low + (high - low) * stage_at[q];
        const double effort = at_begin + k * MODEL(polynomial)(w->gone, STAGES, at);
        const double rate = MODEL(polynomial)(w->speed, STAGES - 1, at) / w->h;
        for (long i = 0; i < STAGES; ++i) {
            double part = (high - low) * stage_weight[q] * (stage_lead[i] / stage_weight[i]);
            for (long j = 0; j < STAGES; ++j)
                part *= j == i ? 1.0 : at - stage_at[j];
            mean[EFFORT][i] += part * effort;
            if (yields) {
                mean[SLIP][i] += part * rate;
                mean[HEAT][i] += part * effort * rate;
            }
        }
    }
}

/*
 * A stop element: F = k z; z follows C, but stays at -r or r while C goes further. Returns the part
 * of the step in which z follows C.
 */
static double MODEL(stop)(MODEL(way) *w, double z, double k, double r, MODEL(means) mean)
{
    const double begin = z > r ? r : z < -r ? -r : z; /* r may have become less */
    double now = begin, heat = 0.5 * k * (z - begin) * (z + begin), moving = 0.0;
    double yielded = 0.0, slipped = 0.0;
    int yielding = 0;
    memset(mean, 0, sizeof(MODEL(means)));
    if (fabs(z) + w->most <= r) {
        for (long i = 0; i < STAGES; ++i)
            mean[EFFORT][i] = k * (z + w->at_stage[i]);
        return 1.0;
    }
    if (!w->pieces)
        MODEL(find_turns)(w);
    for (long n = 0; n < w->pieces; ++n) {
        const double low = w->turn[n], high = w->turn[n + 1];
        const double from = MODEL(polynomial)(w->gone, STAGES, low);
        const double more = MODEL(polynomial)(w->gone, STAGES, high) - from;
        const double limit = more > 0.0 ? r : -r, left = limit - now;
        const double room = fabs(left) <= PUT_THERE * r ? 0.0 : left;
        const int yields = fabs(more) > fabs(room);
        const double until = !yields ? high
            : room == 0.0            ? low
                                     : MODEL(meets)(w->gone, STAGES, from + room, low, high);
        MODEL(add_piece)(w, low, until, k * (now - from), k, 0, mean);
        const double place = yielding && until > low ? low : yields ? until : 1.0;
        if (place > BEGUN && place < 1.0) {
            w->yields = place < w->yields ? place : w->yields;
            ++w->times;
        }
        yielding = yields;
        moving += until - low;
        now = yields ? limit : now + more;
        if (yields) {
            MODEL(add_piece)(w, until, high, k * limit, 0.0, 1, mean);
            heat += k * r * (fabs(more) - fabs(room));
        }
    }
    /*
     * a stage's mean of the heat may be negative: it becomes 0, the others are scaled to the total
     */
    for (long i = 0; i < STAGES; ++i) {
        mean[HEAT][i] = fmax(mean[HEAT][i], 0.0);
        yielded += stage_weight[i] * mean[HEAT][i];
        slipped += stage_weight[i] * mean[SLIP][i];
    }
    const double rest = (MODEL(polynomial)(w->gone, STAGES, 1.0) - (now - z)) / w->h - slipped;
    for (long i = 0; i < STAGES; ++i) {
        mean[HEAT][i] = heat / w->h * (yielded > 0.0 ? mean[HEAT][i] / yielded : 1.0);
        mean[SLIP][i] += rest;
#if LOSSY
        mean[EFFORT][i] = k * now; /* as all co-states of a dissipative step, at its end */
#endif
    }
    return moving;
}
