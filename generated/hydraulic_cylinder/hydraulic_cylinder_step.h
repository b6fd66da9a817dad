/*
 * Hydraulic cylinder behind an orifice, with a load and an end stop: irreversible port-Hamiltonian system.
 *
 * Source:  Merritt (1967), Hydraulic Control Systems, ch. 3 and 6
 * Model:   hydraulic_cylinder, spec sha256 9f77f306d723282ed74a083c6c8af89eb009af63f004a1308f102f81527e5387
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, continuous, sigma, exergy, environment, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (V, p, q, S)
 * u = (p_in, F, T_e)
 * p_ = pointer to hydraulic_cylinder_parameters; the underscore tells it from p, a name of the model
 */
#ifndef PIEZO_SYM_hydraulic_cylinder_STEP_H
#define PIEZO_SYM_hydraulic_cylinder_STEP_H

#include "hydraulic_cylinder.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Size of `space`, the working memory of a step, in numbers.
 */
long hydraulic_cylinder_step_size(const hydraulic_cylinder_parameters *p_);

/*
 * Takes a step of order two: energy-preserving Gauss collocation of one stage, by Newton's
 *     method. The booked energies and entropies close both balances to round-off. Returns 1 if
 *     the step was taken. Returns 0, and leaves x unchanged, if no step that stays in the
 *     domain was found: a shorter one may exist. Most steps take two or three iterations, the
 *     hardest some thousand.
 * x[n], read and written: V [m**3], p [kg*m/s], q [m], S [J/K]
 * u[hydraulic_cylinder_input_count], read: p_in [Pa], F [N], T_e [K]; constant during the step
 * h, read: the length of the step [s]
 * booked, written: energy supplied [J] by supply, push, air; then heat [J], and then entropy
 *     produced [J/K], by orifice, friction; then entropy [J/K] that heat exchange brings to
 *     oil
 * space[hydraulic_cylinder_step_size(p_)], read and written: set it to zero before the first
 *     step, then leave it as it is; it keeps the largest magnitude of each state, with which
 *     rounding errors are compared
 *
 * Example: cc -O3 -fopenmp-simd example.c hydraulic_cylinder.c hydraulic_cylinder_step.c -lm
 *
 *     #include <stdio.h>
 *     #include <stdlib.h>
 *
 *     #include "hydraulic_cylinder_step.h"
 *
 *     int main(void)
 *     {
 *         const hydraulic_cylinder_parameters p = hydraulic_cylinder_DEFAULTS;
 *         const double u[] = {0.0, 0.0, 313.15};
 *         const size_t size = (size_t)hydraulic_cylinder_step_size(&p);
 *         double x[4], booked[8], *space = calloc(size, sizeof *space);
 *
 *         if (!space)
 *             return 1;
 *         hydraulic_cylinder_initial_state(u, &p, x);
 *         for (int step = 0; step < 1000; ++step)
 *             if (!hydraulic_cylinder_step(x, u, 1e-6, &p, booked, space))
 *                 return 1;
 *         printf("U = %.17g J\n", hydraulic_cylinder_energy(x, &p));
 *         free(space);
 *         return 0;
 *     }
 */
int hydraulic_cylinder_step(double *x,
                            const double *u,
                            double h,
                            const hydraulic_cylinder_parameters *p_,
                            double *booked,
                            double *space);

#ifdef __cplusplus
}
#endif

#endif /* PIEZO_SYM_hydraulic_cylinder_STEP_H */
