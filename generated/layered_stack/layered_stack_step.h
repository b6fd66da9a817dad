/*
 * Piezoelectric stack of 3 layers that conduct heat: irreversible port-Hamiltonian system.
 *
 * Source:  Caballeria, Ramirez, Le Gorrec (2021), eqs. (9)-(13), Table 1, cut into layers; conductance between them: a choice
 * Model:   layered_stack, spec sha256 b46e92f413d7be38d2b0d17c8e7e220000a9ea90d48a027e94b79d81ff92ba5e
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, energy, entropy, welldef, continuous, passive, odd, sigma, exergy, environment, invariant, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (q_1, p_1, Q_1, phi_1, S_1, q_2, p_2, Q_2, phi_2, S_2, q_3, p_3, Q_3, phi_3, S_3)
 * u = (F_ext, V_in, T_e)
 * p = pointer to layered_stack_parameters
 */
#ifndef PIEZO_SYM_layered_stack_STEP_H
#define PIEZO_SYM_layered_stack_STEP_H

#include "layered_stack.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Size of `space`, the working memory of a step, in numbers.
 */
long layered_stack_step_size(const layered_stack_parameters *p);

/*
 * Takes a step of order two: energy-preserving Gauss collocation of one stage, by Newton's
 *     method. The booked energies and entropies close both balances to round-off. Returns 1 if
 *     the step was taken. Returns 0, and leaves x unchanged, if no step that stays in the
 *     domain was found: a shorter one may exist. Most steps take two or three iterations, the
 *     hardest some thousand.
 * x[n], read and written: q_1 [m], p_1 [kg*m/s], Q_1 [C], phi_1 [Wb], S_1 [J/K], q_2 [m], p_2
 *     [kg*m/s], Q_2 [C], phi_2 [Wb], S_2 [J/K], q_3 [m], p_3 [kg*m/s], Q_3 [C], phi_3 [Wb],
 *     S_3 [J/K]
 * u[layered_stack_input_count], read: F_ext [N], V_in [V], T_e [K]; constant during the step
 * h, read: the length of the step [s]
 * booked, written: energy supplied [J] by load, supply, base, top; then heat [J], and then
 *     entropy produced [J/K], by hysteron_1, damper_1, hysteron_2, damper_2, hysteron_3,
 *     damper_3, contact_1, contact_2; then entropy [J/K] that heat exchange brings to body_1,
 *     body_3
 * space[layered_stack_step_size(p)], read and written: set it to zero before the first step,
 *     then leave it as it is; it keeps the largest magnitude of each state, with which
 *     rounding errors are compared
 *
 * Example: cc -O3 -fopenmp-simd example.c layered_stack.c layered_stack_step.c -lm
 *
 *     #include <stdio.h>
 *     #include <stdlib.h>
 *
 *     #include "layered_stack_step.h"
 *
 *     int main(void)
 *     {
 *         const layered_stack_parameters p = layered_stack_DEFAULTS;
 *         const double u[] = {0.0, 0.0, 298.15};
 *         const size_t size = (size_t)layered_stack_step_size(&p);
 *         double x[15], booked[22], *space = calloc(size, sizeof *space);
 *
 *         if (!space)
 *             return 1;
 *         layered_stack_initial_state(u, &p, x);
 *         for (int step = 0; step < 1000; ++step)
 *             if (!layered_stack_step(x, u, 1e-6, &p, booked, space))
 *                 return 1;
 *         printf("U = %.17g J\n", layered_stack_energy(x, &p));
 *         free(space);
 *         return 0;
 *     }
 */
int layered_stack_step(double *x,
                       const double *u,
                       double h,
                       const layered_stack_parameters *p,
                       double *booked,
                       double *space);

#ifdef __cplusplus
}
#endif

#endif /* PIEZO_SYM_layered_stack_STEP_H */
