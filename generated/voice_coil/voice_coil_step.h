/*
 * Voice coil of a loudspeaker, with the heat of its winding: irreversible port-Hamiltonian system.
 *
 * Source:  Small (1972), J. Audio Eng. Soc. 20 (5), 383-395; values of a 165 mm driver
 * Model:   voice_coil, spec sha256 b17a1309ca30712ebd0993cb3dcdd961cc3539b78aa3f80bce5bbdfa54c8bfcf
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, sigma, exergy, environment, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (q, p, phi, S_w, S_m)
 * u = (V_in, T_e)
 * p_ = pointer to voice_coil_parameters; the underscore tells it from p, a name of the model
 */
#ifndef PIEZO_SYM_voice_coil_STEP_H
#define PIEZO_SYM_voice_coil_STEP_H

#include "voice_coil.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Size of `space`, the working memory of a step, in numbers.
 */
long voice_coil_step_size(const voice_coil_parameters *p_);

/*
 * Takes a step of order two: energy-preserving Gauss collocation of one stage, by Newton's
 *     method. The booked energies and entropies close both balances to round-off. Returns 1 if
 *     the step was taken. Returns 0, and leaves x unchanged, if no step that stays in the
 *     domain was found: a shorter one may exist. Most steps take two or three iterations, the
 *     hardest some thousand.
 * x[n], read and written: q [m], p [kg*m/s], phi [Wb], S_w [J/K], S_m [J/K]
 * u[voice_coil_input_count], read: V_in [V], T_e [K]; constant during the step
 * h, read: the length of the step [s]
 * booked, written: energy supplied [J] by amplifier, air; then heat [J], and then entropy
 *     produced [J/K], by losses, copper, contact; then entropy [J/K] that heat exchange brings
 *     to magnet
 * space[voice_coil_step_size(p_)], read and written: set it to zero before the first step,
 *     then leave it as it is; it keeps the largest magnitude of each state, with which
 *     rounding errors are compared
 *
 * Example: cc -O3 -fopenmp-simd example.c voice_coil.c voice_coil_step.c -lm
 *
 *     #include <stdio.h>
 *     #include <stdlib.h>
 *
 *     #include "voice_coil_step.h"
 *
 *     int main(void)
 *     {
 *         const voice_coil_parameters p = voice_coil_DEFAULTS;
 *         const double u[] = {0.0, 293.15};
 *         const size_t size = (size_t)voice_coil_step_size(&p);
 *         double x[5], booked[9], *space = calloc(size, sizeof *space);
 *
 *         if (!space)
 *             return 1;
 *         voice_coil_initial_state(u, &p, x);
 *         for (int step = 0; step < 1000; ++step)
 *             if (!voice_coil_step(x, u, 1e-6, &p, booked, space))
 *                 return 1;
 *         printf("U = %.17g J\n", voice_coil_energy(x, &p));
 *         free(space);
 *         return 0;
 *     }
 */
int voice_coil_step(double *x,
                    const double *u,
                    double h,
                    const voice_coil_parameters *p_,
                    double *booked,
                    double *space);

#ifdef __cplusplus
}
#endif

#endif /* PIEZO_SYM_voice_coil_STEP_H */
