/*
 * Steps with a tolerance are not solved to round-off: what Newton's method leaves of their equations
 * becomes heat. Comes after newton.c.
 *
 * With rates K_i at the stages, and F_i by the laws there, U_1 - U_0 = h sum_i b_i Ebar_i . K_i
 * differs from what the ports supply, h sum_i b_i Ebar_i . F_i, by h sum_i b_i Ebar_i . (F_i - K_i).
 * The first body takes that energy at the end of the step, at its mean temperature while it does. The
 * entropies of all bodies then differ from what processes produce, and exchanges bring, by a small
 * number of either sign; the heat and entropy of every process are scaled by one factor that makes
 * up for it. So both balances are exact.
 *
 * Inner states of path functionals have no residuals: their rates are set, and what they store and
 * release as heat along the path is in both sums.
 *
 * The factor has to be within MOST_SCALED of 1, and the energy so small that the mean temperature is
 * that of half of it. Else the step is solved to round-off.
 */
#if defined(COSTATES)
#define MOST_SCALED 1e-4
/* The largest error of the mean temperature, times the entropy taken, as a fraction of the entropy's round-off. */
#define MOST_BENT 0.03

/* The temperature of the first body after adding the entropy `more` to the state x; writes `x` and `costate`. */
static real MODEL(heated_temperature)(const MODEL(block) *m, real *x, real more)
{
    const long body = m->first[MODEL(heated)];
    x[body] += more;
    MODEL(integrands)(x, &m->p, m->integrand);
    MODEL(costates)(x, m->integrand, &m->p, m->costate);
    return m->costate[body];
}

/*
 * Sums over a step: the energy that its residuals miss, the entropy that they add to bodies, and the entropy
 * that processes produce.
 */
static void MODEL(add_up_residuals)(const MODEL(block) *m, real h, real *energy, real *entropy,
                                    real *produced)
{
    real power[STAGES];
    MODEL(residual_power)(m, h, power);
    *energy = *entropy = *produced = zero;
    for (long i = 0; i < STAGES; ++i) {
        const real *const gap = m->gap + i * m->n, weight = h * stage_weight[i];
        const real *const rows = m->rows + i * m->booked + MODEL(output_count) + m->processes;
        for (long j = 0; j < MODEL(bodies); ++j) {
            const long record = MODEL(body)[j];
            const long end = record + 1 < MODEL(records) ? m->first[record + 1] : m->n;
            for (long k = m->first[record]; k < end; ++k)
                *entropy += weight * gap[k];
        }
        for (long k = 0; k < m->processes; ++k)
            *produced += weight * rows[k];
        *energy += weight * power[i];
    }
}

/*
 * Turn the residuals of some lanes into heat; returns the lanes that need no more iterations: those where it is
 * possible, and those whose step consumes entropy, so that it will be refused or cut at a switch.
 */
static mask MODEL(take_residual)(MODEL(block) *m, real h, mask where)
{
    const long body = m->first[MODEL(heated)];
    real energy, entropy, produced;
    MODEL(add_up_residuals)(m, h, &energy, &entropy, &produced);
    MODEL(reach_of)(m, h, stage_weight, m->reached);
    const real size = m->largest[body] + size_of(m->x[body]);
    const real first = MODEL(heated_temperature)(m, m->reached, zero), about = energy / first;
    const real mean = MODEL(heated_temperature)(m, m->reached, 0.5 * about), taken = energy / mean;
    const real bend = (mean - first) / first, more = taken - entropy;
    const mask is_small = size_of(taken) <= m->allowed * NOISE * size;
    const mask is_straight = size_of(taken) * bend * bend <= MOST_BENT * NOISE * size;
    const mask is_scaled = size_of(more) <= MOST_SCALED * produced;
    const mask fits = where & is_small & is_straight & is_scaled;
    const mask some = produced > 0.0, consumes = produced < 0.0;
    m->taken = chosen(fits, taken, m->taken);
    m->scale = chosen(fits & some, 1.0 + more / produced, m->scale);
    return fits | consumes;
}

/* Take the residuals' energy into the end of a step, and scale what processes book. */
static void MODEL(add_residual)(const MODEL(block) *m, real *end, real *booked)
{
    real *const rows = booked + MODEL(output_count);
    end[m->first[MODEL(heated)]] += m->taken;
    for (long k = 0; k < 2 * m->processes; ++k)
        rows[k] *= m->scale;
}

/* Solve for the rates in some lanes, to round-off where residuals cannot become heat. */
static mask MODEL(iterate_enough)(MODEL(block) *m, real h, mask where)
{
    mask found = MODEL(iterate)(m, h, where);
    const mask early = m->early & found;
    m->taken = chosen(where, zero, m->taken);
    m->scale = chosen(where, wide(1.0), m->scale);
    if (any(early)) {
        const mask again = early & none_of(MODEL(take_residual)(m, h, early));
        if (any(again)) {
            m->loose &= none_of(again);
            found &= none_of(again) | MODEL(iterate)(m, h, again);
        }
    }
    return found;
}
#endif /* COSTATES */
