/*
 * Electromagnet with an armature on a spring, and a coil that warms: irreversible port-Hamiltonian system.
 *
 * Source:  Woodson, Melcher (1968), Electromechanical Dynamics I, ch. 3
 * Model:   electromagnet, spec sha256 9b4244be212754305b836d305b67a8844d9eaeab14c345563f9a22957982c0af
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, sigma, exergy, environment, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (q, p, S, phi, x)
 * u = (V_in, T_e)
 * p_ = pointer to electromagnet_parameters; the underscore tells it from p, a name of the model
 */
#ifndef PIEZO_SYM_electromagnet_STEP_H
#define PIEZO_SYM_electromagnet_STEP_H

#include "electromagnet.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Size of `space`, the working memory of a step, in numbers.
 */
long electromagnet_step_size(const electromagnet_parameters *p_);

/*
 * Takes a step of order two: energy-preserving Gauss collocation of one stage, by Newton's
 *     method. The booked energies and entropies close both balances to round-off. Returns 1 if
 *     the step was taken. Returns 0, and leaves x unchanged, if no step that stays in the
 *     domain was found: a shorter one may exist. Most steps take two or three iterations, the
 *     hardest some thousand.
 * x[n], read and written: q [m], p [kg*m/s], S [J/K], phi [Wb], x [m]
 * u[electromagnet_input_count], read: V_in [V], T_e [K]; constant during the step
 * h, read: the length of the step [s]
 * booked, written: energy supplied [J] by supply, air; then heat [J], and then entropy
 *     produced [J/K], by copper, friction; then entropy [J/K] that heat exchange brings to
 *     winding
 * space[electromagnet_step_size(p_)], read and written: set it to zero before the first step,
 *     then leave it as it is; it keeps the largest magnitude of each state, with which
 *     rounding errors are compared
 *
 * Example: cc -O3 -fopenmp-simd example.c electromagnet.c electromagnet_step.c -lm
 *
 *     #include <stdio.h>
 *     #include <stdlib.h>
 *
 *     #include "electromagnet_step.h"
 *
 *     int main(void)
 *     {
 *         const electromagnet_parameters p = electromagnet_DEFAULTS;
 *         const double u[] = {0.0, 293.15};
 *         const size_t size = (size_t)electromagnet_step_size(&p);
 *         double x[5], booked[7], *space = calloc(size, sizeof *space);
 *
 *         if (!space)
 *             return 1;
 *         electromagnet_initial_state(u, &p, x);
 *         for (int step = 0; step < 1000; ++step)
 *             if (!electromagnet_step(x, u, 1e-6, &p, booked, space))
 *                 return 1;
 *         printf("U = %.17g J\n", electromagnet_energy(x, &p));
 *         free(space);
 *         return 0;
 *     }
 */
int electromagnet_step(double *x,
                       const double *u,
                       double h,
                       const electromagnet_parameters *p_,
                       double *booked,
                       double *space);

#ifdef __cplusplus
}
#endif

#endif /* PIEZO_SYM_electromagnet_STEP_H */
