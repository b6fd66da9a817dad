/*
 * Damped oscillator that heats itself: irreversible port-Hamiltonian system.
 *
 * Source:  Ramirez, Maschke, Sbarbaro (2013), Eur. J. Control 19, 513-520, the mass-spring-damper
 * Model:   oscillator, spec sha256 98f74415ae4d927ffd7693687e1755d27c6ee4baa18ca60809e3c3d10d605268
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, sigma, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (q, p, S)
 * u = (F)
 * p_ = pointer to oscillator_parameters; the underscore tells it from p, a name of the model
 */
#ifndef PIEZO_SYM_oscillator_STEP_H
#define PIEZO_SYM_oscillator_STEP_H

#include "oscillator.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Size of `space`, the working memory of a step, in numbers.
 */
long oscillator_step_size(const oscillator_parameters *p_);

/*
 * Takes a step of order two: energy-preserving Gauss collocation of one stage, by Newton's
 *     method. The booked energies and entropies close both balances to round-off. Returns 1 if
 *     the step was taken. Returns 0, and leaves x unchanged, if no step that stays in the
 *     domain was found: a shorter one may exist. Most steps take two or three iterations, the
 *     hardest some thousand.
 * x[n], read and written: q [m], p [kg*m/s], S [J/K]
 * u[oscillator_input_count], read: F [N]; constant during the step
 * h, read: the length of the step [s]
 * booked, written: energy supplied [J] by hand; then heat [J], and then entropy produced
 *     [J/K], by damper
 * space[oscillator_step_size(p_)], read and written: set it to zero before the first step,
 *     then leave it as it is; it keeps the largest magnitude of each state, with which
 *     rounding errors are compared
 *
 * Example: cc -O3 -fopenmp-simd example.c oscillator.c oscillator_step.c -lm
 *
 *     #include <stdio.h>
 *     #include <stdlib.h>
 *
 *     #include "oscillator_step.h"
 *
 *     int main(void)
 *     {
 *         const oscillator_parameters p = oscillator_DEFAULTS;
 *         const double u[] = {0.0};
 *         const size_t size = (size_t)oscillator_step_size(&p);
 *         double x[3], booked[3], *space = calloc(size, sizeof *space);
 *
 *         if (!space)
 *             return 1;
 *         oscillator_initial_state(u, &p, x);
 *         for (int step = 0; step < 1000; ++step)
 *             if (!oscillator_step(x, u, 1e-6, &p, booked, space))
 *                 return 1;
 *         printf("U = %.17g J\n", oscillator_energy(x, &p));
 *         free(space);
 *         return 0;
 *     }
 */
int oscillator_step(double *x,
                    const double *u,
                    double h,
                    const oscillator_parameters *p_,
                    double *booked,
                    double *space);

#ifdef __cplusplus
}
#endif

#endif /* PIEZO_SYM_oscillator_STEP_H */
