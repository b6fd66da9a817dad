/*
 * Error estimates of steps. Comes after trajectory.c.
 *
 * The misfit of a step is the difference of the polynomial of its rates and the true rate at either
 * end, or the estimated next term of the series, if that is larger. Filtered by the step's
 * linearised equations, it is an error of order s + 1. At its end a step is of order 2s: what a
 * misfit leaves there is orthogonal to all polynomials of degree below s. Two factors tell how much
 * less that is: how far the series decays over s more terms (SMOOTH), and what the equations do
 * when they are applied s times (PULL).
 */

/* The ratio of the next term of a series to its last: the mean ratio of its terms so far. */
#if STAGES == 3
#define LIKE_THE_LAST(smooth) (smooth)
#elif STAGES == 4
#define LIKE_THE_LAST(smooth) sqrt_of(smooth)
#else
#define LIKE_THE_LAST(smooth) sqrt_of(sqrt_of(smooth))
#endif
/*
 * The fraction of an error of order s + 1 that is left at the end of the step. SMOOTH: in an integral
 * over time, for the ratio of the misfit to the change of the rate. PULL: in a state that oscillates
 * or decays at the rate z/h. The fourth root and the highest power approximate the errors of Gauss
 * quadrature and of the stability function. The other constants are calibrated on test models: FALLS
 * bounds series that hardly decay yet, and oscillations do not damp errors of earlier steps.
 */
#define FALLS(part) ((part) * least(300.0 * (part) * (part), wide(1.0)))
#if STAGES == 4
#define SMOOTH(part) (FALLS(part) + 7.5e-3 * (part) * sqrt_of(sqrt_of(part)))
#define PULL(z) ((z) * (z) * (z) * (3.5e-3 / (1.0 + (z)) + 8e-5 * (z)))
#elif STAGES == 5
#define SMOOTH(part) (FALLS(part) + 2e-3 * (part) * sqrt_of(sqrt_of(part)))
#define PULL(z) ((z) * (z) * (z) * (6.4e-4 / (1.0 + (z)) + 4e-6 * (z) * (z)))
#elif STAGES == 6
#define SMOOTH(part) (FALLS(part) + 5e-4 * (part) * sqrt_of(sqrt_of(part)))
#define PULL(z) ((z) * (z) * (z) * (1.2e-4 / (1.0 + (z)) + 1.5e-7 * (z) * (z) * (z)))
#else
#define SMOOTH(part) (part)
#define PULL(z) (1e-2 * (z) * (z))
#endif
/*
 * The part of the error left at the end if the series decays more slowly than SMOOTH assumes, as near a steep
 * part of a law. GEOMETRIC: the factor of the squared ratio of the misfit to the last two terms. LOCAL: the part
 * for a misfit whose term of order s + 1 is as large as that of order s, since the rate turns between two
 * stages; it is reduced if the last term is more than ONE_OF times the misfit.
 */
#define GEOMETRIC 0.5
#define LOCAL 0.05
#define ONE_OF 3.0
/* The weight of LOCAL, by the ratio of these two terms: 0 up to 0.6, 1 from 1 on. */
#define TURNS(ratio) largest_of(least(2.5 * (ratio) - 1.5, wide(1.0)), zero)
/* A state is stiff if the equations reduce its misfit by more than this factor, twice in a row. */
#define REDUCED 2.5
/* The same for one so stiff that Gauss steps do not damp what it starts with: it rings at their ends. */
#define RINGS 1e5
/* Factor on errors of steps that contain kinks, whose errors add up over a run. */
#define KINKS_WITHIN (STAGES > 4 ? 1.3 : 1.8)
/*
 * The least part of an error that is left where path functionals begin, or cease, to yield in the step:
 * at a kink no series decays. Their misfits add up; errors at the end have either sign.
 */
#define YIELDS_WITHIN(times) (1.0 / sqrt_of(times))

/* The number of larger magnitude. */
static inline real further(real a, real b)
{
    const mask first = size_of(a) > size_of(b);
    return chosen(first, a, b);
}

/* The part of the misfits at both ends that is left if their series decays slowly, by its last two terms. */
static inline real MODEL(slow_part)(real low, real high, real last, real before)
{
    const real tiny = 1e-300 + zero, misfit = largest_of(size_of(low), size_of(high));
    const real next = size_of(STAGES % 2 ? high - low : high + low) + tiny;
    const real after = size_of(STAGES % 2 ? high + low : high - low);
    const real ratio = least(misfit / (largest_of(size_of(last), size_of(before)) + tiny), wide(1.0));
    const real sudden = least(ONE_OF * misfit / (size_of(last) + tiny), wide(1.0));
    return largest_of(GEOMETRIC * ratio * ratio, LOCAL * TURNS(after / next) * sudden);
}

/*
 * The misfits of some states' rates, times `gamma`, in some_rate; and the fractions of them that are left at the
 * end of the step, in some_left. The rates at its ends are not used where `ends` is 0, nor the series of the rates
 * where `series` is 0.
 */
static void MODEL(misfits)(const MODEL(batch) *b, real gamma, real ends, real series, long first, long end)
{
    const long n = b->m.n;
    const real *const rates = b->m.rates, *const begin = b->rate, *const end_rate = b->end_rate;
    real *restrict const left = b->some_left, *restrict const found = b->some_rate;
#pragma omp simd
    for (long k = first; k < end; ++k) {
        real low = -begin[k], high = -end_rate[k], mean = zero, last = zero, before = zero;
        real most = 1e-300 + zero;
        for (long j = 0; j < STAGES; ++j) {
            const real rate = rates[j * n + k];
            low += stage_start[j] * rate;
            high += stage_end[j] * rate;
            last += stage_last[0][j] * rate;
            before += stage_last[1][j] * rate;
            mean += stage_weight[j] * rate;
        }
        for (long j = 0; j < STAGES; ++j)
            most = largest_of(size_of(rates[j * n + k] - mean), most);
        const real per_most = 1.0 / most;
        const real smooth = least(size_of(last) * per_most, wide(1.0));
        const real next = STAGES > 2 ? (real)(series * last * LIKE_THE_LAST(smooth)) : (real)zero;
        low = chosen(ends > 0.0, low, zero);
        high = chosen(ends > 0.0, high, zero);
        const real misfit = further(further(low, high), next);
        const real share = least(size_of(misfit) * per_most, wide(1.0));
        const real slow = MODEL(slow_part)(low, high, last, before);
        /* the rate at an end beyond a switch may have no value */
        const real more = chosen(slow == slow, series * slow, zero);
        left[k] = STAGES > 3 ? (real)largest_of(SMOOTH(share), more) : (real)SMOOTH(share);
        found[k] = gamma * misfit;
    }
}

/* The misfits of all states; where stops yield, no series is used for their inner states. */
static void MODEL(all_misfits)(const MODEL(batch) *b, real gamma, real ends)
{
    FOR_SOLVED (&b->m, begin, end)
        MODEL(misfits)(b, gamma, ends, wide(1.0), begin, end);
#if defined(PATHS)
    const real series = chosen(b->m.yield[HOW_OFTEN] > 0.0, zero, wide(1.0));
    for (long n = 0; n < PATHS; ++n) {
        const int *path = MODEL(path)[n];
        const long first = b->m.first[path[INNER]], lanes = path[BANK] < 0 ? 1 : b->m.lanes[path[BANK]];
        MODEL(misfits)(b, gamma, ends, series, first, first + lanes);
    }
#endif
}

/* The misfits, once and twice filtered by the equations; `ends` as in misfits. */
static void MODEL(filter_misfits)(const MODEL(batch) *b, real gamma, real ends, real *once, real *twice)
{
    const MODEL(block) *m = &b->m;
    MODEL(all_misfits)(b, gamma, ends);
    memcpy(once, b->some_rate, (size_t)m->n * sizeof(real));
    MODEL(solve_real)(m, gamma, m->slope, m->real_factor, ALL, once);
    memcpy(twice, once, (size_t)m->n * sizeof(real));
    MODEL(solve_real)(m, gamma, m->slope, m->real_factor, ALL, twice);
}

#if STAGES > 2
/* Learn in some lanes which states ring, by their filtered misfits. */
static void MODEL(learn_ringing)(MODEL(batch) *b, const real *once, const real *twice, mask where)
{
    mask some = nowhere;
    for (long k = 0; k < b->m.n; ++k) {
        const real misfit = size_of(b->some_rate[k]), error = size_of(once[k]);
        const mask rings = where & (misfit > RINGS * error) & (error > RINGS * size_of(twice[k]));
        b->rings[k] = chosen(where, chosen(rings, wide(1.0), zero), b->rings[k]);
        some |= rings;
    }
    b->ringing = (b->ringing & none_of(where)) | some;
}
#endif

/*
 * The error of each lane's step, in tolerances of each state's scale; lanes in `where` learn which states ring.
 *
 * How stiff a state is shows in how much the equations reduce its misfit. They are applied twice,
 * for in an oscillation one state or another has no error at the moment.
 */
static real MODEL(error)(MODEL(batch) *b, real h, mask where)
{
    const MODEL(block) *m = &b->m;
    const real gamma = h * filter;
    real *const once = m->gap, *const twice = m->prior; /* no longer needed by Newton's method */
    MODEL(filter_misfits)(b, gamma, wide(1.0), once, twice);
#if STAGES > 2 /* rates at the ends tell of what rings alone; at the stages it is in equilibrium */
    MODEL(learn_ringing)(b, once, twice, where);
    const mask rings = where & b->ringing;
    if (any(rings))
        MODEL(filter_misfits)(b, gamma, chosen(rings, zero, wide(1.0)), once, twice);
#endif
    const real per_tolerance = 1.0 / wide(b->tolerance);
    real pulled = zero, slow = 1e-300 + zero, worst = zero;
    for (long k = 0; k < m->n; ++k) {
        const real scale = largest_of(size_of(m->x[k]), size_of(m->end[k]));
        const real per_size = 1.0 / (1e-300 + largest_of(m->largest[k], scale));
        const real misfit = size_of(b->some_rate[k]), error = size_of(once[k]);
        const real change = size_of(b->some_rate[k] - once[k]);
        const real first = misfit / (error + 1e-300), second = error / (size_of(twice[k]) + 1e-300);
        const real reduced = least(first, second);
        const mask is_fast = reduced > REDUCED;
        b->some_rate[k] = chosen(is_fast, (reduced - 1.0) * (1.0 / filter), zero);
        once[k] = error * per_size;
        pulled = largest_of(chosen(is_fast, zero, change * per_size), pulled);
        slow = largest_of(chosen(is_fast, zero, once[k]), slow);
    }
    const real pull = pulled / (filter * slow);
#if defined(PATHS)
    const real times = m->yield[HOW_OFTEN];
    const real least_part = chosen(times > 0.0, YIELDS_WITHIN(times), zero);
#else
    const real least_part = zero;
#endif
    for (long k = 0; k < m->n; ++k) {
        const real fast = b->some_rate[k], z = largest_of(fast, pull);
        const real left = least(b->some_left[k] + PULL(z), wide(1.0));
        const real counts = chosen(m->over, wide(KINKS_WITHIN), largest_of(left, least_part));
        worst = largest_of(counts * once[k] * per_tolerance, worst);
    }
    return worst;
}
