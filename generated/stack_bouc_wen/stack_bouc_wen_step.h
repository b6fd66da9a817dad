/*
 * Piezoelectric stack with a Bouc-Wen hysteresis of its voltage: irreversible port-Hamiltonian system.
 *
 * Source:  Goldfarb, Celanovic (1997), IEEE Control Systems 17 (3), 69-79; Low, Guo (1995), J. Microelectromech. Syst. 4 (4), 230-237; PiezoDrive SA050536
 * Model:   stack_bouc_wen, spec sha256 cb2f5eb9e9a940796689ce0b466f2aabc3f9c62f14ebd031e4298cc6395703ff
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, continuous, rate-independent, sigma, exergy, environment, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (q, p, Q, Q_h, S)
 * u = (F_ext, V_in, T_e)
 * p_ = pointer to stack_bouc_wen_parameters; the underscore tells it from p, a name of the model
 */
#ifndef PIEZO_SYM_stack_bouc_wen_STEP_H
#define PIEZO_SYM_stack_bouc_wen_STEP_H

#include "stack_bouc_wen.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Size of `space`, the working memory of a step, in numbers.
 */
long stack_bouc_wen_step_size(const stack_bouc_wen_parameters *p_);

/*
 * Takes a step of order two: energy-preserving Gauss collocation of one stage, by Newton's
 *     method. The booked energies and entropies close both balances to round-off. Returns 1 if
 *     the step was taken. Returns 0, and leaves x unchanged, if no step that stays in the
 *     domain was found: a shorter one may exist. Most steps take two or three iterations, the
 *     hardest some thousand.
 * x[n], read and written: q [m], p [kg*m/s], Q [C], Q_h [C], S [J/K]
 * u[stack_bouc_wen_input_count], read: F_ext [N], V_in [V], T_e [K]; constant during the step
 * h, read: the length of the step [s]
 * booked, written: energy supplied [J] by load, supply, ambient; then heat [J], and then
 *     entropy produced [J/K], by damper, hysteresis, leads; then entropy [J/K] that heat
 *     exchange brings to body
 * space[stack_bouc_wen_step_size(p_)], read and written: set it to zero before the first step,
 *     then leave it as it is; it keeps the largest magnitude of each state, with which
 *     rounding errors are compared
 *
 * Example: cc -O3 -fopenmp-simd example.c stack_bouc_wen.c stack_bouc_wen_step.c -lm
 *
 *     #include <stdio.h>
 *     #include <stdlib.h>
 *
 *     #include "stack_bouc_wen_step.h"
 *
 *     int main(void)
 *     {
 *         const stack_bouc_wen_parameters p = stack_bouc_wen_DEFAULTS;
 *         const double u[] = {0.0, 0.0, 293.15};
 *         const size_t size = (size_t)stack_bouc_wen_step_size(&p);
 *         double x[5], booked[10], *space = calloc(size, sizeof *space);
 *
 *         if (!space)
 *             return 1;
 *         stack_bouc_wen_initial_state(u, &p, x);
 *         for (int step = 0; step < 1000; ++step)
 *             if (!stack_bouc_wen_step(x, u, 1e-6, &p, booked, space))
 *                 return 1;
 *         printf("U = %.17g J\n", stack_bouc_wen_energy(x, &p));
 *         free(space);
 *         return 0;
 *     }
 */
int stack_bouc_wen_step(double *x,
                        const double *u,
                        double h,
                        const stack_bouc_wen_parameters *p_,
                        double *booked,
                        double *space);

#ifdef __cplusplus
}
#endif

#endif /* PIEZO_SYM_stack_bouc_wen_STEP_H */
