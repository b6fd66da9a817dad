/*
 * The loss of a dissipative step (comes after gauss.c): one stage, whose rates are those at the step's end.
 *
 * Stores then lose N = h y^T u - (U_1 - U_0) >= 0 beside all processes, if energies are convex. The
 * first body takes it as heat, as no law says which body does: its entropy grows by N/T_1 more.  So
 * the balance of energy stays exact, and N/T_1 is one more term of the entropy that is produced.
 */

/* The round-off of N, as a fraction of the energy. */
#define OF_ENERGY 2e-15

/*
 * Add the loss to rates and rows.  Newton's method for the body's own row: its rate grows by the energy
 * that the balance still lacks, as heat; the part of the rate that processes do not bring is the loss.
 */
static void MODEL(lose)(const MODEL(block) *m, real h, real *rate, real *rows)
{
    const long body = m->first[MODEL(heated)];
    double temperature[MODEL(body_count)], supplied = 0.0;
    const double before = MODEL(energy)(m->x, m->own), after = MODEL(energy)(m->reached, m->own);
    MODEL(temperatures)(m->reached, m->own, temperature);
    for (long k = 0; k < MODEL(output_count); ++k)
        supplied += h * rows[k];
    const double lacking = supplied - (after - before);
    double heat = (m->rates[body] - rate[body]) * temperature[0] + lacking / h;
    if (heat < 0.0 && heat * h > -OF_ENERGY * fabs(after))
        heat = 0.0;
    rows[m->booked - 2] = heat;
    rows[m->booked - 1] = heat / temperature[0];
    rate[body] += heat / temperature[0];
}
