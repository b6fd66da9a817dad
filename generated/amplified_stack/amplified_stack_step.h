/*
 * Piezoelectric stack with a lever, a load and an end stop: irreversible port-Hamiltonian system.
 *
 * Source:  Scire, Teague (1978), Rev. Sci. Instrum. 49 (12), 1735-1740 (levers); Hunt, Crossley (1975), J. Appl. Mech. 42 (2), 440-445 (end stop); PiezoDrive SA050536
 * Model:   amplified_stack, spec sha256 f97db543e4f43ea0e60de47bf6de8bd925540145e93c475ce6262cae7eb13898
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, welldef, energy, entropy, passive, odd, continuous, sigma, exergy, environment, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (Q, q, p, x, x_e, S)
 * u = (F, V, T_e)
 * p_ = pointer to amplified_stack_parameters; the underscore tells it from p, a name of the model
 */
#ifndef PIEZO_SYM_amplified_stack_STEP_H
#define PIEZO_SYM_amplified_stack_STEP_H

#include "amplified_stack.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Size of `space`, the working memory of a step, in numbers.
 */
long amplified_stack_step_size(const amplified_stack_parameters *p_);

/*
 * Takes a step of order two: energy-preserving Gauss collocation of one stage, by Newton's
 *     method. The booked energies and entropies close both balances to round-off. Returns 1 if
 *     the step was taken. Returns 0, and leaves x unchanged, if no step that stays in the
 *     domain was found: a shorter one may exist. Most steps take two or three iterations, the
 *     hardest some thousand.
 * x[n], read and written: Q [C], q [m], p [kg*m/s], x [m], x_e [m], S [J/K]
 * u[amplified_stack_input_count], read: F [N], V [V], T_e [K]; constant during the step
 * h, read: the length of the step [s]
 * booked, written: energy supplied [J] by push, amplifier, air; then heat [J], and then
 *     entropy produced [J/K], by leads, losses, bumper; then entropy [J/K] that heat exchange
 *     brings to body
 * space[amplified_stack_step_size(p_)], read and written: set it to zero before the first
 *     step, then leave it as it is; it keeps the largest magnitude of each state, with which
 *     rounding errors are compared
 *
 * Example: cc -O3 -fopenmp-simd example.c amplified_stack.c amplified_stack_step.c -lm
 *
 *     #include <stdio.h>
 *     #include <stdlib.h>
 *
 *     #include "amplified_stack_step.h"
 *
 *     int main(void)
 *     {
 *         const amplified_stack_parameters p = amplified_stack_DEFAULTS;
 *         const double u[] = {0.0, 0.0, 293.15};
 *         const size_t size = (size_t)amplified_stack_step_size(&p);
 *         double x[6], booked[10], *space = calloc(size, sizeof *space);
 *
 *         if (!space)
 *             return 1;
 *         amplified_stack_initial_state(u, &p, x);
 *         for (int step = 0; step < 1000; ++step)
 *             if (!amplified_stack_step(x, u, 1e-6, &p, booked, space))
 *                 return 1;
 *         printf("U = %.17g J\n", amplified_stack_energy(x, &p));
 *         free(space);
 *         return 0;
 *     }
 */
int amplified_stack_step(double *x,
                         const double *u,
                         double h,
                         const amplified_stack_parameters *p_,
                         double *booked,
                         double *space);

#ifdef __cplusplus
}
#endif

#endif /* PIEZO_SYM_amplified_stack_STEP_H */
