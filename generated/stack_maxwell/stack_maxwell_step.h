/*
 * Piezoelectric stack with Maxwell-slip: 40 um at 150 V: irreversible port-Hamiltonian system.
 *
 * Source:  Goldfarb, Celanovic (1997), Modeling piezoelectric stack actuators; loop measured by Chandra et al. (2023), doi 10.1063/5.0146134
 * Model:   stack_maxwell, spec sha256 a4fac994b19a17a907de6d8bbc2fec285a640ebfd27501f5fec69ade7095faff
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, rate-independent, sigma, exergy, environment, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (Q, p, q, z_1 ... z_slips_count, S)
 * u = (F_ext, V_in, T_e)
 * p_ = pointer to stack_maxwell_parameters; the underscore tells it from p, a name of the model
 * bank slips: lanes j = 1 ... slips_count
 */
#ifndef PIEZO_SYM_stack_maxwell_STEP_H
#define PIEZO_SYM_stack_maxwell_STEP_H

#include "stack_maxwell.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Size of `space`, the working memory of a step, in numbers.
 */
long stack_maxwell_step_size(const stack_maxwell_parameters *p_);

/*
 * Takes a step of order two: energy-preserving Gauss collocation of one stage, by Newton's
 *     method. The booked energies and entropies close both balances to round-off. Returns 1 if
 *     the step was taken. Returns 0, and leaves x unchanged, if no step that stays in the
 *     domain was found: a shorter one may exist. Most steps take two or three iterations, the
 *     hardest some thousand.
 * x[n], read and written: Q [C], p [kg*m/s], q [m], z_1 ... z_slips_count [m], S [J/K]
 * u[stack_maxwell_input_count], read: F_ext [N], V_in [V], T_e [K]; constant during the step
 * h, read: the length of the step [s]
 * booked, written: energy supplied [J] by load, amplifier, air; then heat [J], and then
 *     entropy produced [J/K], by leads, slips_1 ... slips_slips_count, damper; then entropy
 *     [J/K] that heat exchange brings to body
 * space[stack_maxwell_step_size(p_)], read and written: set it to zero before the first step,
 *     then leave it as it is; it keeps the largest magnitude of each state, with which
 *     rounding errors are compared
 *
 * Example: cc -O3 -fopenmp-simd example.c stack_maxwell.c stack_maxwell_step.c -lm
 *
 *     #include <stdio.h>
 *     #include <stdlib.h>
 *
 *     #include "stack_maxwell_step.h"
 *
 *     int main(void)
 *     {
 *         const stack_maxwell_parameters p = stack_maxwell_DEFAULTS;
 *         const double u[] = {0.0, 0.0, 296.15};
 *         const size_t size = (size_t)stack_maxwell_step_size(&p);
 *         double x[12], booked[24], *space = calloc(size, sizeof *space);
 *
 *         if (!space)
 *             return 1;
 *         stack_maxwell_initial_state(u, &p, x);
 *         for (int step = 0; step < 1000; ++step)
 *             if (!stack_maxwell_step(x, u, 1e-6, &p, booked, space))
 *                 return 1;
 *         printf("U = %.17g J\n", stack_maxwell_energy(x, &p));
 *         free(space);
 *         return 0;
 *     }
 */
int stack_maxwell_step(double *x,
                       const double *u,
                       double h,
                       const stack_maxwell_parameters *p_,
                       double *booked,
                       double *space);

#ifdef __cplusplus
}
#endif

#endif /* PIEZO_SYM_stack_maxwell_STEP_H */
