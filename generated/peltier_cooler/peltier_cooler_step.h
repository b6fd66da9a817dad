/*
 * Peltier cooler: cold plate, thermoelectric couples, heat sink: irreversible port-Hamiltonian system.
 *
 * Source:  Ioffe (1957), Semiconductor Thermoelements; values of a module of 127 couples
 * Model:   peltier_cooler, spec sha256 e97f90f757f77de747011f7a983b38c3f53075a795fa19e001fa2cd5567cc5f1
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, sigma, exergy, environment, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (phi, S_c, S_h)
 * u = (V_in, P, T_e)
 * p = pointer to peltier_cooler_parameters
 */
#ifndef PIEZO_SYM_peltier_cooler_STEP_H
#define PIEZO_SYM_peltier_cooler_STEP_H

#include "peltier_cooler.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Size of `space`, the working memory of a step, in numbers.
 */
long peltier_cooler_step_size(const peltier_cooler_parameters *p);

/*
 * Takes a step of order two: energy-preserving Gauss collocation of one stage, by Newton's
 *     method. The booked energies and entropies close both balances to round-off. Returns 1 if
 *     the step was taken. Returns 0, and leaves x unchanged, if no step that stays in the
 *     domain was found: a shorter one may exist. Most steps take two or three iterations, the
 *     hardest some thousand.
 * x[n], read and written: phi [Wb], S_c [J/K], S_h [J/K]
 * u[peltier_cooler_input_count], read: V_in [V], P [W], T_e [K]; constant during the step
 * h, read: the length of the step [s]
 * booked, written: energy supplied [J] by supply, load, air; then heat [J], and then entropy
 *     produced [J/K], by warm, cool, legs; then entropy [J/K] that heat exchange brings to
 *     plate, sink
 * space[peltier_cooler_step_size(p)], read and written: set it to zero before the first step,
 *     then leave it as it is; it keeps the largest magnitude of each state, with which
 *     rounding errors are compared
 *
 * Example: cc -O3 -fopenmp-simd example.c peltier_cooler.c peltier_cooler_step.c -lm
 *
 *     #include <stdio.h>
 *     #include <stdlib.h>
 *
 *     #include "peltier_cooler_step.h"
 *
 *     int main(void)
 *     {
 *         const peltier_cooler_parameters p = peltier_cooler_DEFAULTS;
 *         const double u[] = {0.0, 0.0, 300.0};
 *         const size_t size = (size_t)peltier_cooler_step_size(&p);
 *         double x[3], booked[11], *space = calloc(size, sizeof *space);
 *
 *         if (!space)
 *             return 1;
 *         peltier_cooler_initial_state(u, &p, x);
 *         for (int step = 0; step < 1000; ++step)
 *             if (!peltier_cooler_step(x, u, 1e-6, &p, booked, space))
 *                 return 1;
 *         printf("U = %.17g J\n", peltier_cooler_energy(x, &p));
 *         free(space);
 *         return 0;
 *     }
 */
int peltier_cooler_step(double *x,
                        const double *u,
                        double h,
                        const peltier_cooler_parameters *p,
                        double *booked,
                        double *space);

#ifdef __cplusplus
}
#endif

#endif /* PIEZO_SYM_peltier_cooler_STEP_H */
