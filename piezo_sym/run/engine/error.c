/*
 * The errors of steps, as they are estimated.  Behind trajectory.c.
 *
 * The misfit of a step is how far the polynomial of rates is from the rate at either end, or what
 * comes next after its last term, if that is more.  Seen through the equations of the step it is an
 * error of order s + 1.  The end is of order 2s: what a misfit leaves there is orthogonal to all
 * polynomials of less than s, so that it counts only by what is left of itself after s more terms
 * (`smooth`), and by what the equations make of it when they act on it s times (`pull`).
 */

/* About what comes after the last term of a series, as a part of that, by how much smaller it is. */
#if STAGES == 3
#define LIKE_THE_LAST(smooth) (smooth)
#elif STAGES == 4
#define LIKE_THE_LAST(smooth) sqrt_of(smooth)
#else
#define LIKE_THE_LAST(smooth) sqrt_of(sqrt_of(smooth))
#endif
/*
 * What of an error of order s + 1 is left at the end.  SMOOTH: of a sum over time, from the misfit's
 * part of what the rate changes by.  PULL: of a state that goes round or falls by z in a step.  The
 * term of the root of a root, and the highest power, are about those of Gauss's rule and of its
 * function of stability.  The others are calibrated on test models: series that hardly fall yet get
 * no more than their last part says, and what oscillates damps no error of the steps before.
 */
#define FALLS(part) ((part) * least(300.0 * (part) * (part), wide(1.0)))
#if STAGES == 4
#define SMOOTH(part) (FALLS(part) + 7.5e-3 * (part) * sqrt_of(sqrt_of(part)))
#define PULL(z) ((z) * (z) * (z) * (3.5e-3 / (1.0 + (z)) + 8e-5 * (z)))
#elif STAGES == 5
#define SMOOTH(part) (FALLS(part) + 2e-3 * (part) * sqrt_of(sqrt_of(part)))
#define PULL(z) ((z) * (z) * (z) * (6.4e-4 / (1.0 + (z)) + 4e-6 * (z) * (z)))
#else
#define SMOOTH(part) (part)
#define PULL(z) (1e-2 * (z) * (z))
#endif
/* A state is fast if the equations reduce its misfit by more than this factor, twice. */
#define REDUCED 2.5
/* Factor on errors of steps that contain kinks, whose errors add up over a run. */
#define KINKS_WITHIN (STAGES > 4 ? 1.3 : 1.8)

/* The one that is further from zero. */
static inline real further(real a, real b)
{
    const mask first = size_of(a) > size_of(b);
    return chosen(first, a, b);
}

/*
 * The misfits of a step times its length and the filter, in some_rate; in some_share, as parts of
 * what the rate changes by over the step.
 */
static void MODEL(misfits)(const MODEL(batch) *b, real gamma)
{
    const MODEL(block) *m = &b->m;
    for (long k = 0; k < m->n; ++k) {
        real low = -b->rate[k], high = -b->end_rate[k], mean = zero, last = zero, most = 1e-300 + zero;
        for (long j = 0; j < STAGES; ++j) {
            const real rate = m->rates[j * m->n + k];
            low += stage_start[j] * rate;
            high += stage_end[j] * rate;
            last += stage_last[j] * rate;
            mean += stage_weight[j] * rate;
        }
        for (long j = 0; j < STAGES; ++j)
            most = largest_of(size_of(m->rates[j * m->n + k] - mean), most);
        const real smooth = least(size_of(last) / most, wide(1.0));
        const real next = STAGES > 2 ? (real)(last * LIKE_THE_LAST(smooth)) : (real)zero;
        const real misfit = further(further(low, high), next);
        b->some_share[k] = least(size_of(misfit) / most, wide(1.0));
        b->some_rate[k] = gamma * misfit;
    }
}

/*
 * The errors of steps, in tolerances of each state's scale.
 *
 * How fast a state is, the equations tell by how much they reduce its misfit.  Once is not enough:
 * of what oscillates, one state or another has no error just now.
 */
static real MODEL(error)(const MODEL(batch) *b, real h)
{
    const MODEL(block) *m = &b->m;
    const real gamma = h * filter;
    real *const once = m->gap, *const twice = m->prior; /* of Newton's method, which is done */
    MODEL(misfits)(b, gamma);
    memcpy(once, b->some_rate, (size_t)m->n * sizeof(real));
    MODEL(solve_real)(m, gamma, m->slope, m->real_factor, once);
    memcpy(twice, once, (size_t)m->n * sizeof(real));
    MODEL(solve_real)(m, gamma, m->slope, m->real_factor, twice);
    const real per_tolerance = 1.0 / wide(b->tolerance);
    real pulled = zero, slow = 1e-300 + zero, worst = zero;
    for (long k = 0; k < m->n; ++k) {
        const real scale = largest_of(size_of(m->x[k]), size_of(m->end[k]));
        const real size = 1e-300 + largest_of(m->largest[k], scale);
        const real misfit = size_of(b->some_rate[k]), error = size_of(once[k]);
        const real change = size_of(b->some_rate[k] - once[k]);
        const real first = misfit / (error + 1e-300), second = error / (size_of(twice[k]) + 1e-300);
        const real reduced = least(first, second);
        const mask is_fast = reduced > REDUCED;
        b->some_rate[k] = chosen(is_fast, (reduced - 1.0) / filter, zero);
        once[k] = error / size;
        pulled = largest_of(chosen(is_fast, zero, change / size), pulled);
        slow = largest_of(chosen(is_fast, zero, once[k]), slow);
    }
    const real pull = pulled / (filter * slow);
    for (long k = 0; k < m->n; ++k) {
        const real fast = b->some_rate[k], z = largest_of(fast, pull);
        const real left = least(SMOOTH(b->some_share[k]) + PULL(z), wide(1.0));
        const real counts = chosen(m->over, wide(KINKS_WITHIN), left);
        worst = largest_of(counts * once[k] * per_tolerance, worst);
    }
    return worst;
}
