/*
 * The right-hand side of the paper, eqs. (9)-(13), as one would write it in C.
 *
 * Independent of the generator: the yardstick for the generated rhs.  Any number r of hysterons, each
 * with values of its own; x = (q, p, Q_C, phi_1 ... phi_r, S), u = (F_ext, V_in, T_e).
 */
#include <math.h>

typedef struct {
    double mass, stiffness, rest, damping, capacitance;
    const double *inductance, *slope, *threshold;
    double ratio, reference, heat_capacity, conductance;
    long hysterons;
} stack;

void by_hand(const double *restrict x, const double *restrict u, const stack *restrict s,
             double *restrict rate)
{
    const long r = s->hysterons;
    const double *restrict inductance = s->inductance;
    const double *restrict slope = s->slope;
    const double *restrict threshold = s->threshold;
    const double *restrict flux = x + 3;
    const double warming = s->reference*expm1(x[3 + r]/s->heat_capacity);
    const double temperature = s->reference + warming;
    const double alpha = s->ratio*temperature/s->reference;
    const double velocity = x[1]/s->mass;
    const double across = x[2]/s->capacitance;
    const double drive = u[1] - across;
    double current = 0.0;
    double loss = 0.0;
#pragma omp simd reduction(+:current, loss)
    for (long j = 0; j < r; ++j) {
        const double i = flux[j]/inductance[j];
        const double beyond = fabs(i) - threshold[j];
        const double drop = beyond > 0.0 ? slope[j]/warming*copysign(beyond, i) : 0.0;
        current += i;
        loss += drop*i;
        rate[3 + j] = drive - drop;
    }
    rate[0] = velocity;
    rate[1] = alpha*across - s->stiffness*(x[0] - s->rest) - s->damping*velocity + u[0];
    rate[2] = current - alpha*velocity;
    rate[3 + r] = (loss + s->damping*velocity*velocity)/temperature
        + s->conductance*(u[2]/temperature - 1.0);
}
