/*
 * Piezoelectric stack actuator with hysterons: irreversible port-Hamiltonian system.
 *
 * Source:  Caballeria, Ramirez, Le Gorrec (2021), eqs. (9)-(13), Table 1
 * Model:   piezo_stack, spec sha256 9c0235a60e02072bc451611ffa723f273272c8e4536a3089081866f47c89389c
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, energy, entropy, welldef, continuous, passive, odd, sigma, exergy, environment, invariant, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (q, p, Q_C, phi_1 ... phi_hysteron_count, S)
 * u = (F_ext, V_in, T_e)
 * p_ = pointer to piezo_stack_parameters; the underscore tells it from p, a name of the model
 * bank hysteron: lanes j = 1 ... hysteron_count
 */
#ifndef PIEZO_SYM_piezo_stack_STEP_H
#define PIEZO_SYM_piezo_stack_STEP_H

#include "piezo_stack.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Size of `space`, the working memory of a step, in numbers.
 */
long piezo_stack_step_size(const piezo_stack_parameters *p_);

/*
 * Takes a step of order two: energy-preserving Gauss collocation of one stage, by Newton's
 *     method. The booked energies and entropies close both balances to round-off. Returns 1 if
 *     the step was taken. Returns 0, and leaves x unchanged, if no step that stays in the
 *     domain was found: a shorter one may exist. Most steps take two or three iterations, the
 *     hardest some thousand.
 * x[n], read and written: q [m], p [kg*m/s], Q_C [C], phi_1 ... phi_hysteron_count [Wb], S
 *     [J/K]
 * u[piezo_stack_input_count], read: F_ext [N], V_in [V], T_e [K]; constant during the step
 * h, read: the length of the step [s]
 * booked, written: energy supplied [J] by load, supply, ambient; then heat [J], and then
 *     entropy produced [J/K], by hysteron_1 ... hysteron_hysteron_count, damper; then entropy
 *     [J/K] that heat exchange brings to body
 * space[piezo_stack_step_size(p_)], read and written: set it to zero before the first step,
 *     then leave it as it is; it keeps the largest magnitude of each state, with which
 *     rounding errors are compared
 *
 * Example: cc -O3 -fopenmp-simd example.c piezo_stack.c piezo_stack_step.c -lm
 *
 *     #include <stdio.h>
 *     #include <stdlib.h>
 *
 *     #include "piezo_stack_step.h"
 *
 *     int main(void)
 *     {
 *         const piezo_stack_parameters p = piezo_stack_DEFAULTS;
 *         const double u[] = {0.0, 0.0, 298.15};
 *         const size_t size = (size_t)piezo_stack_step_size(&p);
 *         double x[6], booked[10], *space = calloc(size, sizeof *space);
 *
 *         if (!space)
 *             return 1;
 *         piezo_stack_initial_state(u, &p, x);
 *         for (int step = 0; step < 1000; ++step)
 *             if (!piezo_stack_step(x, u, 1e-6, &p, booked, space))
 *                 return 1;
 *         printf("U = %.17g J\n", piezo_stack_energy(x, &p));
 *         free(space);
 *         return 0;
 *     }
 */
int piezo_stack_step(double *x,
                     const double *u,
                     double h,
                     const piezo_stack_parameters *p_,
                     double *booked,
                     double *space);

#ifdef __cplusplus
}
#endif

#endif /* PIEZO_SYM_piezo_stack_STEP_H */
