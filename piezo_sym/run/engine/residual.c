/*
 * Newton's method may stop short of round-off in steps with a tolerance: what it leaves of the
 * equations becomes heat. Comes after newton.c.
 *
 * With rates K_i at the stages, and F_i by the laws there, U_1 - U_0 = h sum_i b_i Ebar_i . K_i
 * differs from what the ports supply, h sum_i b_i Ebar_i . F_i, by h sum_i b_i Ebar_i . (F_i - K_i).
 * The first body takes that from or to its entropy at the end of the step, at the temperature T_1
 * there, so that the energy is exact; the second order in it is far below round-off. The entropy of
 * all bodies then exceeds what the processes produce, and what is exchanged, by a small number of
 * either sign. All processes produce, and heat, in proportion more or less, so that this balance is
 * exact, too. It has to be so little that none changes its sign or its leading digits: else the
 * iteration goes on to round-off.
 */
#if defined(COSTATES)
/* The largest part of the entropy produced in a step that residuals may add to it. */
#define LITTLE 1e-4

/* Take the residuals of some lanes as heat; returns the lanes where that is little. */
static mask MODEL(take_residual)(MODEL(block) *m, real h, mask where)
{
    const long n = m->n, body = m->first[MODEL(heated)], ports = MODEL(output_count);
    real power[STAGES], left = zero, gained = zero, produced = zero;
    MODEL(residual_power)(m, h, power);
    for (long i = 0; i < STAGES; ++i) {
        const real *const gap = m->gap + i * n;
        const real *const rows = m->rows + i * m->booked + ports + m->processes;
        real entropy = zero, made = zero;
        for (long j = 0; j < MODEL(bodies); ++j) {
            const long record = MODEL(body)[j];
            const long end = record + 1 < MODEL(records) ? m->first[record + 1] : n;
            for (long k = m->first[record]; k < end; ++k)
                entropy += gap[k];
        }
        for (long k = 0; k < m->processes; ++k)
            made += rows[k];
        left += stage_weight[i] * power[i];
        gained += stage_weight[i] * entropy;
        produced += stage_weight[i] * made;
    }
    MODEL(reach_of)(m, h, stage_weight, m->reached);
    MODEL(integrands)(m->reached, &m->p, m->end_mean);
    MODEL(costates)(m->reached, m->end_mean, &m->p, m->costate);
    const real taken = h * left / m->costate[body], more = taken - h * gained, made = h * produced;
    const real most = m->little * NOISE * (m->largest[body] + size_of(m->x[body]));
    const mask few = size_of(more) <= LITTLE * made, small = size_of(taken) <= most;
    const mask fits = where & few & small, some = made > 0.0, beyond = made < 0.0;
    m->taken = chosen(fits, taken, m->taken);
    m->scale = chosen(fits & some, 1.0 + more / made, m->scale);
    return fits | beyond; /* a switch lies within a step that consumes entropy: it will be cut */
}

/* Take what was left of the equations into the end of a step, and into what it books. */
static void MODEL(add_residual)(const MODEL(block) *m, real *end, real *booked)
{
    real *const rows = booked + MODEL(output_count);
    end[m->first[MODEL(heated)]] += m->taken;
    for (long k = 0; k < 2 * m->processes; ++k)
        rows[k] *= m->scale;
}
#endif /* COSTATES */

/* Solve for the rates in some lanes, to round-off where the rest cannot become heat. */
static mask MODEL(iterate_enough)(MODEL(block) *m, real h, mask where)
{
    mask found = MODEL(iterate)(m, h, where);
#if defined(COSTATES)
    const mask early = m->early & found;
    m->taken = chosen(where, zero, m->taken);
    m->scale = chosen(where, wide(1.0), m->scale);
    if (any(early)) {
        const mask again = early & none_of(MODEL(take_residual)(m, h, early));
        if (any(again)) {
            m->loose &= none_of(again);
            m->early &= none_of(again);
            found &= none_of(again) | MODEL(iterate)(m, h, again);
        }
    }
#endif /* COSTATES */
    return found;
}
