/*
 * Ideal gas under a piston, with heat exchanged: irreversible port-Hamiltonian system.
 *
 * Source:  Ruechhardt (1929), Physikalische Zeitschrift 30, 58-59, the period; van der Schaft, Maschke (2018), Entropy 20, 925
 * Model:   gas_piston, spec sha256 0a9d53c8700ddf1bb0d85a7756da7a071b3f29cf0a98843810acd07ee683352b
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, sigma, exergy, environment, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (p, q, S)
 * u = (F, T_e)
 * p_ = pointer to gas_piston_parameters; the underscore tells it from p, a name of the model
 */
#ifndef PIEZO_SYM_gas_piston_STEP_H
#define PIEZO_SYM_gas_piston_STEP_H

#include "gas_piston.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Size of `space`, the working memory of a step, in numbers.
 */
long gas_piston_step_size(const gas_piston_parameters *p_);

/*
 * Takes a step of order two: energy-preserving Gauss collocation of one stage, by Newton's
 *     method. The booked energies and entropies close both balances to round-off. Returns 1 if
 *     the step was taken. Returns 0, and leaves x unchanged, if no step that stays in the
 *     domain was found: a shorter one may exist. Most steps take two or three iterations, the
 *     hardest some thousand.
 * x[n], read and written: p [kg*m/s], q [m], S [J/K]
 * u[gas_piston_input_count], read: F [N], T_e [K]; constant during the step
 * h, read: the length of the step [s]
 * booked, written: energy supplied [J] by load, vessel; then heat [J], and then entropy
 *     produced [J/K], by friction; then entropy [J/K] that heat exchange brings to gas
 * space[gas_piston_step_size(p_)], read and written: set it to zero before the first step,
 *     then leave it as it is; it keeps the largest magnitude of each state, with which
 *     rounding errors are compared
 *
 * Example: cc -O3 -fopenmp-simd example.c gas_piston.c gas_piston_step.c -lm
 *
 *     #include <stdio.h>
 *     #include <stdlib.h>
 *
 *     #include "gas_piston_step.h"
 *
 *     int main(void)
 *     {
 *         const gas_piston_parameters p = gas_piston_DEFAULTS;
 *         const double u[] = {-19.98656, 293.15};
 *         const size_t size = (size_t)gas_piston_step_size(&p);
 *         double x[3], booked[5], *space = calloc(size, sizeof *space);
 *
 *         if (!space)
 *             return 1;
 *         gas_piston_initial_state(u, &p, x);
 *         for (int step = 0; step < 1000; ++step)
 *             if (!gas_piston_step(x, u, 1e-6, &p, booked, space))
 *                 return 1;
 *         printf("U = %.17g J\n", gas_piston_energy(x, &p));
 *         free(space);
 *         return 0;
 *     }
 */
int gas_piston_step(double *x,
                    const double *u,
                    double h,
                    const gas_piston_parameters *p_,
                    double *booked,
                    double *space);

#ifdef __cplusplus
}
#endif

#endif /* PIEZO_SYM_gas_piston_STEP_H */
