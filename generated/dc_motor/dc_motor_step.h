/*
 * DC motor with gear, bearing, and a winding that warms: irreversible port-Hamiltonian system.
 *
 * Source:  Messner, Tilbury, Control Tutorials for MATLAB and Simulink: DC motor speed, with gear and heat
 * Model:   dc_motor, spec sha256 96a82a6d03ed86fc2c97e6ac88a26dd86ab244ed2d6fd71b14db35164a855b91
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, welldef, energy, entropy, passive, odd, sigma, exergy, environment, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (phi, H, S)
 * u = (V_in, tau, T_e)
 * p = pointer to dc_motor_parameters
 */
#ifndef PIEZO_SYM_dc_motor_STEP_H
#define PIEZO_SYM_dc_motor_STEP_H

#include "dc_motor.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Size of `space`, the working memory of a step, in numbers.
 */
long dc_motor_step_size(const dc_motor_parameters *p);

/*
 * Takes a step of order two: energy-preserving Gauss collocation of one stage, by Newton's
 *     method. The booked energies and entropies close both balances to round-off. Returns 1 if
 *     the step was taken. Returns 0, and leaves x unchanged, if no step that stays in the
 *     domain was found: a shorter one may exist. Most steps take two or three iterations, the
 *     hardest some thousand.
 * x[n], read and written: phi [Wb], H [N*m*s], S [J/K]
 * u[dc_motor_input_count], read: V_in [V], tau [N*m], T_e [K]; constant during the step
 * h, read: the length of the step [s]
 * booked, written: energy supplied [J] by supply, torque, air; then heat [J], and then entropy
 *     produced [J/K], by winding, bearing; then entropy [J/K] that heat exchange brings to
 *     body
 * space[dc_motor_step_size(p)], read and written: set it to zero before the first step, then
 *     leave it as it is; it keeps the largest magnitude of each state, with which rounding
 *     errors are compared
 *
 * Example: cc -O3 -fopenmp-simd example.c dc_motor.c dc_motor_step.c -lm
 *
 *     #include <stdio.h>
 *     #include <stdlib.h>
 *
 *     #include "dc_motor_step.h"
 *
 *     int main(void)
 *     {
 *         const dc_motor_parameters p = dc_motor_DEFAULTS;
 *         const double u[] = {0.0, 0.0, 293.15};
 *         const size_t size = (size_t)dc_motor_step_size(&p);
 *         double x[3], booked[8], *space = calloc(size, sizeof *space);
 *
 *         if (!space)
 *             return 1;
 *         dc_motor_initial_state(u, &p, x);
 *         for (int step = 0; step < 1000; ++step)
 *             if (!dc_motor_step(x, u, 1e-6, &p, booked, space))
 *                 return 1;
 *         printf("U = %.17g J\n", dc_motor_energy(x, &p));
 *         free(space);
 *         return 0;
 *     }
 */
int dc_motor_step(double *x,
                  const double *u,
                  double h,
                  const dc_motor_parameters *p,
                  double *booked,
                  double *space);

#ifdef __cplusplus
}
#endif

#endif /* PIEZO_SYM_dc_motor_STEP_H */
