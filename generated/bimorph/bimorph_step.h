/*
 * Piezoelectric bender: two layers in opposition on one beam: irreversible port-Hamiltonian system.
 *
 * Source:  Smits, Dalke, Cooney (1991), Sensors and Actuators A 28, 41-61; PiezoDrive BA6020
 * Model:   bimorph, spec sha256 e1bdc157e28404f3e3f2a5e6ecbc555574e7dfbd87761b8afc1f5ffdda416572
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, welldef, energy, entropy, passive, odd, sigma, exergy, environment, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (x, p, S, Q_u, Q_l)
 * u = (F, V_b, V, T_e)
 * p_ = pointer to bimorph_parameters; the underscore tells it from p, a name of the model
 */
#ifndef PIEZO_SYM_bimorph_STEP_H
#define PIEZO_SYM_bimorph_STEP_H

#include "bimorph.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Size of `space`, the working memory of a step, in numbers.
 */
long bimorph_step_size(const bimorph_parameters *p_);

/*
 * Takes a step of order two: energy-preserving Gauss collocation of one stage, by Newton's
 *     method. The booked energies and entropies close both balances to round-off. Returns 1 if
 *     the step was taken. Returns 0, and leaves x unchanged, if no step that stays in the
 *     domain was found: a shorter one may exist. Most steps take two or three iterations, the
 *     hardest some thousand.
 * x[n], read and written: x [m], p [kg*m/s], S [J/K], Q_u [C], Q_l [C]
 * u[bimorph_input_count], read: F [N], V_b [V], V [V], T_e [K]; constant during the step
 * h, read: the length of the step [s]
 * booked, written: energy supplied [J] by load, bias, supply, air; then heat [J], and then
 *     entropy produced [J/K], by output, input, losses; then entropy [J/K] that heat exchange
 *     brings to beam
 * space[bimorph_step_size(p_)], read and written: set it to zero before the first step, then
 *     leave it as it is; it keeps the largest magnitude of each state, with which rounding
 *     errors are compared
 *
 * Example: cc -O3 -fopenmp-simd example.c bimorph.c bimorph_step.c -lm
 *
 *     #include <stdio.h>
 *     #include <stdlib.h>
 *
 *     #include "bimorph_step.h"
 *
 *     int main(void)
 *     {
 *         const bimorph_parameters p = bimorph_DEFAULTS;
 *         const double u[] = {0.0, 150.0, 75.0, 293.15};
 *         const size_t size = (size_t)bimorph_step_size(&p);
 *         double x[5], booked[11], *space = calloc(size, sizeof *space);
 *
 *         if (!space)
 *             return 1;
 *         bimorph_initial_state(u, &p, x);
 *         for (int step = 0; step < 1000; ++step)
 *             if (!bimorph_step(x, u, 1e-6, &p, booked, space))
 *                 return 1;
 *         printf("U = %.17g J\n", bimorph_energy(x, &p));
 *         free(space);
 *         return 0;
 *     }
 */
int bimorph_step(double *x,
                 const double *u,
                 double h,
                 const bimorph_parameters *p_,
                 double *booked,
                 double *space);

#ifdef __cplusplus
}
#endif

#endif /* PIEZO_SYM_bimorph_STEP_H */
