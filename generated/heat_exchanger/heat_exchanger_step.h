/*
 * Heat exchanger: two bodies in contact: irreversible port-Hamiltonian system.
 *
 * Source:  Ramirez, Maschke, Sbarbaro (2013), Chem. Eng. Sci. 89, 223-234, the heat exchanger
 * Model:   heat_exchanger, spec sha256 81da265b96a9585ebb1056051f48674761b82597e707def9ebb654e693d5bec0
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, sigma, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (S_hot, S_cold)
 * u = ()
 * p = pointer to heat_exchanger_parameters
 */
#ifndef PIEZO_SYM_heat_exchanger_STEP_H
#define PIEZO_SYM_heat_exchanger_STEP_H

#include "heat_exchanger.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Size of `space`, the working memory of a step, in numbers.
 */
long heat_exchanger_step_size(const heat_exchanger_parameters *p);

/*
 * Takes a step of order two: energy-preserving Gauss collocation of one stage, by Newton's
 *     method. The booked energies and entropies close both balances to round-off. Returns 1 if
 *     the step was taken. Returns 0, and leaves x unchanged, if no step that stays in the
 *     domain was found: a shorter one may exist. Most steps take two or three iterations, the
 *     hardest some thousand.
 * x[n], read and written: S_hot [J/K], S_cold [J/K]
 * u[heat_exchanger_input_count], read: none; constant during the step
 * h, read: the length of the step [s]
 * booked, written: energy supplied [J] by no port; then heat [J], and then entropy produced
 *     [J/K], by contact
 * space[heat_exchanger_step_size(p)], read and written: set it to zero before the first step,
 *     then leave it as it is; it keeps the largest magnitude of each state, with which
 *     rounding errors are compared
 *
 * Example: cc -O3 -fopenmp-simd example.c heat_exchanger.c heat_exchanger_step.c -lm
 *
 *     #include <stdio.h>
 *     #include <stdlib.h>
 *
 *     #include "heat_exchanger_step.h"
 *
 *     int main(void)
 *     {
 *         const heat_exchanger_parameters p = heat_exchanger_DEFAULTS;
 *         const double u[] = {0.0};
 *         const size_t size = (size_t)heat_exchanger_step_size(&p);
 *         double x[2], booked[2], *space = calloc(size, sizeof *space);
 *
 *         if (!space)
 *             return 1;
 *         heat_exchanger_initial_state(u, &p, x);
 *         for (int step = 0; step < 1000; ++step)
 *             if (!heat_exchanger_step(x, u, 1e-6, &p, booked, space))
 *                 return 1;
 *         printf("U = %.17g J\n", heat_exchanger_energy(x, &p));
 *         free(space);
 *         return 0;
 *     }
 */
int heat_exchanger_step(double *x,
                        const double *u,
                        double h,
                        const heat_exchanger_parameters *p,
                        double *booked,
                        double *space);

#ifdef __cplusplus
}
#endif

#endif /* PIEZO_SYM_heat_exchanger_STEP_H */
