/*
 * The path of a coordinate C in a step, whose rates at the stages are the drive of path functionals.
 * Comes after gauss.c, for models that have PATHS.
 */

/*
 * The coefficients of C(tau) - C(0) and of dC/dtau; its change up to each stage and its rate there; a
 * bound on |C(tau) - C(0)|. C is monotonic between turn[k] and turn[k + 1]. `yields` is the first part
 * of the step where z begins, or ceases, to yield, as it does `times` times.
 */
typedef struct {
    double gone[STAGES + 1], speed[STAGES], at_stage[STAGES], rate[STAGES], turn[STAGES + 1];
    double h, most, yields, times;
    long pieces;
} MODEL(coordinate);

static double MODEL(polynomial)(const double *a, long degree, double at)
{
    double sum = a[degree];
    for (long n = degree; n-- > 0;)
        sum = a[n] + at * sum;
    return sum;
}

/* Where a polynomial, monotonic from low to high, has a value: by Newton's method and bisection. */
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
static void MODEL(find_turns)(MODEL(coordinate) *w)
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
static void MODEL(find_coordinate)(const MODEL(block) *m, double h, long i, int lane, MODEL(coordinate) *w)
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
