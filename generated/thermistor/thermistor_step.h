/*
 * Series RLC circuit with a thermistor: irreversible port-Hamiltonian system.
 *
 * Source:  Becker, Green, Pearson (1946), Bell Syst. Tech. J. 26, 170-212, R = R_0 exp(B (1/T - 1/T_0))
 * Model:   thermistor, spec sha256 b3ce3439410245bed29fbaef5d338f6c046728146ec30a1b29ddd4240ea71ae0
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, sigma, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (phi, Q, S)
 * u = ()
 * p = pointer to thermistor_parameters
 */
#ifndef PIEZO_SYM_thermistor_STEP_H
#define PIEZO_SYM_thermistor_STEP_H

#include "thermistor.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Size of `space`, the working memory of a step, in numbers.
 */
long thermistor_step_size(const thermistor_parameters *p);

/*
 * Takes a step of order two: energy-preserving Gauss collocation of one stage, by Newton's
 *     method. The booked energies and entropies close both balances to round-off. Returns 1 if
 *     the step was taken. Returns 0, and leaves x unchanged, if no step that stays in the
 *     domain was found: a shorter one may exist. Most steps take two or three iterations, the
 *     hardest some thousand.
 * x[n], read and written: phi [Wb], Q [C], S [J/K]
 * u[thermistor_input_count], read: none; constant during the step
 * h, read: the length of the step [s]
 * booked, written: energy supplied [J] by no port; then heat [J], and then entropy produced
 *     [J/K], by bead
 * space[thermistor_step_size(p)], read and written: set it to zero before the first step, then
 *     leave it as it is; it keeps the largest magnitude of each state, with which rounding
 *     errors are compared
 *
 * Example: cc -O3 -fopenmp-simd example.c thermistor.c thermistor_step.c -lm
 *
 *     #include <stdio.h>
 *     #include <stdlib.h>
 *
 *     #include "thermistor_step.h"
 *
 *     int main(void)
 *     {
 *         const thermistor_parameters p = thermistor_DEFAULTS;
 *         const double u[] = {0.0};
 *         const size_t size = (size_t)thermistor_step_size(&p);
 *         double x[3], booked[2], *space = calloc(size, sizeof *space);
 *
 *         if (!space)
 *             return 1;
 *         thermistor_initial_state(u, &p, x);
 *         for (int step = 0; step < 1000; ++step)
 *             if (!thermistor_step(x, u, 1e-6, &p, booked, space))
 *                 return 1;
 *         printf("U = %.17g J\n", thermistor_energy(x, &p));
 *         free(space);
 *         return 0;
 *     }
 */
int thermistor_step(double *x,
                    const double *u,
                    double h,
                    const thermistor_parameters *p,
                    double *booked,
                    double *space);

#ifdef __cplusplus
}
#endif

#endif /* PIEZO_SYM_thermistor_STEP_H */
