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
#include "dc_motor.h"

#include <math.h>

static double power_2(double z)
{
    return z*z;
}

/* Number of states n. */
long dc_motor_states(const dc_motor_parameters *restrict p)
{
    (void)p;
    return 3;
}

/* Number of processes, which produce entropy; of a bank, one per lane. */
long dc_motor_processes(const dc_motor_parameters *restrict p)
{
    (void)p;
    return 2;
}

/* State at t = 0 [SI], for the inputs u at t = 0. */
void dc_motor_initial_state(const double *restrict u,
                            const dc_motor_parameters *restrict p,
                            double *restrict out)
{
    (void)u;
    (void)p;
    out[0] = 0.0;
    out[1] = 0.0;
    out[2] = 0.0;
}

/* Rates dx/dt, the rows of J_ir dU/dx + g u. */
void dc_motor_rhs(const double *restrict x,
                  const double *restrict u,
                  const dc_motor_parameters *restrict p,
                  double *restrict out)
{
    const double R_0 = p->R_0;
    const double al = p->al;
    const double L = p->L;
    const double K = p->K;
    const double J_m = p->J_m;
    const double b = p->b;
    const double n = p->n;
    const double J_l = p->J_l;
    const double c = p->c;
    const double lam = p->lam;
    const double T_0 = p->T_0;
    const double phi = x[0];
    const double H = x[1];
    const double S = x[2];
    const double V_in = u[0];
    const double tau = u[1];
    const double T_e = u[2];
    /* co-states dU/dx */
    const double i_armature = phi/L;
    const double omega_rotor = H/(J_m + J_l/power_2(n));
    const double T_minus_T_0 = T_0*expm1(S/c);
    const double T = T_0 + T_minus_T_0;
    /* transducer ratios */
    const double n_machine = K;
    const double n_gear = n;
    /* dissipative laws */
    const double V_winding = R_0*(1.0 + al*T_minus_T_0)*i_armature;
    const double tau_bearing = b*omega_rotor;
    /* heats */
    const double heat_winding = V_winding*i_armature;
    const double heat_bearing = tau_bearing*omega_rotor;
    /* result */
    out[0] = V_in - n_machine*omega_rotor - V_winding;
    out[1] = n_machine*i_armature - tau_bearing + tau/n_gear;
    out[2] = (heat_winding + heat_bearing)/T + lam*(T_e/T - 1.0);
}

/* Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient. */
void dc_motor_outputs(const double *restrict x,
                      const double *restrict u,
                      const dc_motor_parameters *restrict p,
                      double *restrict out)
{
    (void)u;
    const double L = p->L;
    const double J_m = p->J_m;
    const double n = p->n;
    const double J_l = p->J_l;
    const double c = p->c;
    const double T_0 = p->T_0;
    const double phi = x[0];
    const double H = x[1];
    const double S = x[2];
    /* co-states dU/dx */
    const double i_armature = phi/L;
    const double omega_rotor = H/(J_m + J_l/power_2(n));
    const double T_minus_T_0 = T_0*expm1(S/c);
    const double T = T_0 + T_minus_T_0;
    /* transducer ratios */
    const double n_gear = n;
    /* result */
    out[0] = i_armature;
    out[1] = omega_rotor/n_gear;
    out[2] = T;
}

/* Power supplied through each port [W]; the sum is dU/dt. */
void dc_motor_supply(const double *restrict x,
                     const double *restrict u,
                     const dc_motor_parameters *restrict p,
                     double *restrict out)
{
    const double L = p->L;
    const double J_m = p->J_m;
    const double n = p->n;
    const double J_l = p->J_l;
    const double c = p->c;
    const double lam = p->lam;
    const double T_0 = p->T_0;
    const double phi = x[0];
    const double H = x[1];
    const double S = x[2];
    const double V_in = u[0];
    const double tau = u[1];
    const double T_e = u[2];
    /* co-states dU/dx */
    const double i_armature = phi/L;
    const double omega_rotor = H/(J_m + J_l/power_2(n));
    const double T_minus_T_0 = T_0*expm1(S/c);
    const double T = T_0 + T_minus_T_0;
    /* transducer ratios */
    const double n_gear = n;
    /* result */
    out[0] = i_armature*V_in;
    out[1] = omega_rotor/n_gear*tau;
    out[2] = lam*(T_e - T);
}

/* Hamiltonian U [J]. */
double dc_motor_energy(const double *restrict x, const dc_motor_parameters *restrict p)
{
    const double L = p->L;
    const double J_m = p->J_m;
    const double n = p->n;
    const double J_l = p->J_l;
    const double c = p->c;
    const double T_0 = p->T_0;
    const double phi = x[0];
    const double H = x[1];
    const double S = x[2];
    return power_2(phi)/(2.0*L) + power_2(H)/(2.0*(J_m + J_l/power_2(n))) + T_0*c*exp(S/c);
}

/* Total entropy S [J/K]. */
double dc_motor_entropy(const double *restrict x, const dc_motor_parameters *restrict p)
{
    (void)p;
    const double S = x[2];
    return S;
}

/* Temperature of each body [K]. */
void dc_motor_temperatures(const double *restrict x,
                           const dc_motor_parameters *restrict p,
                           double *restrict out)
{
    const double c = p->c;
    const double T_0 = p->T_0;
    const double S = x[2];
    /* co-states dU/dx */
    const double T_minus_T_0 = T_0*expm1(S/c);
    const double T = T_0 + T_minus_T_0;
    /* result */
    out[0] = T;
}

/* Power that each process turns into heat [W]; of a bank, one row per lane. */
void dc_motor_heat(const double *restrict x,
                   const double *restrict u,
                   const dc_motor_parameters *restrict p,
                   double *restrict out)
{
    (void)u;
    const double R_0 = p->R_0;
    const double al = p->al;
    const double L = p->L;
    const double J_m = p->J_m;
    const double b = p->b;
    const double n = p->n;
    const double J_l = p->J_l;
    const double c = p->c;
    const double T_0 = p->T_0;
    const double phi = x[0];
    const double H = x[1];
    const double S = x[2];
    /* co-states dU/dx */
    const double i_armature = phi/L;
    const double omega_rotor = H/(J_m + J_l/power_2(n));
    const double T_minus_T_0 = T_0*expm1(S/c);
    /* dissipative laws */
    const double V_winding = R_0*(1.0 + al*T_minus_T_0)*i_armature;
    const double tau_bearing = b*omega_rotor;
    /* result */
    out[0] = V_winding*i_armature;
    out[1] = tau_bearing*omega_rotor;
}

/*
 * Entropy production of each process [W/K], heat exchange with ambients not included; of a
 * bank, one row per lane.
 */
void dc_motor_entropy_production(const double *restrict x,
                                 const double *restrict u,
                                 const dc_motor_parameters *restrict p,
                                 double *restrict out)
{
    (void)u;
    const double R_0 = p->R_0;
    const double al = p->al;
    const double L = p->L;
    const double J_m = p->J_m;
    const double b = p->b;
    const double n = p->n;
    const double J_l = p->J_l;
    const double c = p->c;
    const double T_0 = p->T_0;
    const double phi = x[0];
    const double H = x[1];
    const double S = x[2];
    /* co-states dU/dx */
    const double i_armature = phi/L;
    const double omega_rotor = H/(J_m + J_l/power_2(n));
    const double T_minus_T_0 = T_0*expm1(S/c);
    const double T = T_0 + T_minus_T_0;
    /* dissipative laws */
    const double V_winding = R_0*(1.0 + al*T_minus_T_0)*i_armature;
    const double tau_bearing = b*omega_rotor;
    /* result */
    out[0] = V_winding*i_armature/T;
    out[1] = tau_bearing*omega_rotor/T;
}

/* Effort, flow, power, energy and heat of elements; of a bank, one row per lane. */
void dc_motor_elements(const double *restrict x,
                       const double *restrict u,
                       const dc_motor_parameters *restrict p,
                       double *restrict out)
{
    const double R_0 = p->R_0;
    const double al = p->al;
    const double L = p->L;
    const double K = p->K;
    const double J_m = p->J_m;
    const double b = p->b;
    const double n = p->n;
    const double J_l = p->J_l;
    const double c = p->c;
    const double lam = p->lam;
    const double T_0 = p->T_0;
    const double phi = x[0];
    const double H = x[1];
    const double S = x[2];
    const double V_in = u[0];
    const double tau = u[1];
    const double T_e = u[2];
    /* co-states dU/dx */
    const double i_armature = phi/L;
    const double omega_rotor = H/(J_m + J_l/power_2(n));
    const double T_minus_T_0 = T_0*expm1(S/c);
    const double T = T_0 + T_minus_T_0;
    /* transducer ratios */
    const double n_machine = K;
    const double n_gear = n;
    /* dissipative laws */
    const double V_winding = R_0*(1.0 + al*T_minus_T_0)*i_armature;
    const double tau_bearing = b*omega_rotor;
    /* heats */
    const double heat_winding = V_winding*i_armature;
    const double heat_bearing = tau_bearing*omega_rotor;
    /* rates */
    const double rate_phi = V_in - n_machine*omega_rotor - V_winding;
    const double rate_H = n_machine*i_armature - tau_bearing + tau/n_gear;
    const double rate_S = (heat_winding + heat_bearing)/T + lam*(T_e/T - 1.0);
    /* result */
    out[0] = V_in;
    out[1] = -i_armature;
    out[2] = -i_armature*V_in;
    out[3] = V_winding;
    out[4] = i_armature;
    out[5] = V_winding*i_armature;
    out[6] = V_winding*i_armature;
    out[7] = rate_phi;
    out[8] = i_armature;
    out[9] = rate_phi*i_armature;
    out[10] = power_2(phi)/(2.0*L);
    out[11] = n_machine*omega_rotor;
    out[12] = i_armature;
    out[13] = -n_machine*i_armature;
    out[14] = omega_rotor;
    out[15] = n_machine*omega_rotor*i_armature;
    out[16] = J_m/(J_m + J_l/power_2(n))*rate_H;
    out[17] = omega_rotor;
    out[18] = J_m/(J_m + J_l/power_2(n))*rate_H*omega_rotor;
    out[19] = 0.5*(J_m*power_2(omega_rotor));
    out[20] = tau_bearing;
    out[21] = omega_rotor;
    out[22] = tau_bearing*omega_rotor;
    out[23] = tau_bearing*omega_rotor;
    out[24] = -tau/n_gear + J_l/n/(J_m + J_l/power_2(n))*rate_H/n_gear;
    out[25] = n_gear*omega_rotor/n_gear;
    out[26] = -n_gear*(-tau/n_gear + J_l/n/(J_m + J_l/power_2(n))*rate_H/n_gear);
    out[27] = omega_rotor/n_gear;
    out[28] = n_gear*omega_rotor/n_gear*(-tau/n_gear + J_l/n/(J_m + J_l/power_2(n))*rate_H/n_gear);
    out[29] = J_l/n/(J_m + J_l/power_2(n))*rate_H;
    out[30] = omega_rotor/n;
    out[31] = J_l/n/(J_m + J_l/power_2(n))*rate_H*omega_rotor/n;
    out[32] = 0.5*(J_l*power_2(omega_rotor/n));
    out[33] = -tau;
    out[34] = omega_rotor/n_gear;
    out[35] = -omega_rotor/n_gear*tau;
    out[36] = T;
    out[37] = rate_S;
    out[38] = T*rate_S;
    out[39] = T_0*c*exp(S/c);
    out[40] = T;
    out[41] = -lam*(T_e/T - 1.0);
    out[42] = -lam*(T_e - T);
}

/* Jacobian of rhs, n x n, row after row: d rhs[i]/d x[j] at out[i*n + j]. */
void dc_motor_jacobian(const double *restrict x,
                       const double *restrict u,
                       const dc_motor_parameters *restrict p,
                       double *restrict out)
{
    const long n_ = 3;
    const double R_0 = p->R_0;
    const double al = p->al;
    const double L = p->L;
    const double K = p->K;
    const double J_m = p->J_m;
    const double b = p->b;
    const double n = p->n;
    const double J_l = p->J_l;
    const double c = p->c;
    const double lam = p->lam;
    const double T_0 = p->T_0;
    const double phi = x[0];
    const double H = x[1];
    const double S = x[2];
    const double T_e = u[2];
    for (long j = 0; j < n_*n_; ++j) {
        out[j] = 0.0;
    }
    /* co-states dU/dx */
    const double i_armature = phi/L;
    const double omega_rotor = H/(J_m + J_l/power_2(n));
    const double T_minus_T_0 = T_0*expm1(S/c);
    const double T = T_0 + T_minus_T_0;
    /* transducer ratios */
    const double n_machine = K;
    /* dissipative laws */
    const double V_winding = R_0*(1.0 + al*T_minus_T_0)*i_armature;
    const double tau_bearing = b*omega_rotor;
    /* heats */
    const double heat_winding = V_winding*i_armature;
    const double heat_bearing = tau_bearing*omega_rotor;
    /* derivatives */
    const double dV_winding_dphi = R_0*(1.0 + al*T_minus_T_0)/L;
    const double dheat_winding_dphi = i_armature*dV_winding_dphi + V_winding/L;
    const double domega_rotor_dH = 1.0/(J_m + J_l/power_2(n));
    const double dtau_bearing_dH = b*domega_rotor_dH;
    const double dheat_bearing_dH = omega_rotor*dtau_bearing_dH
        + tau_bearing*domega_rotor_dH;
    const double dT_minus_T_0_dS = T/c;
    const double dV_winding_dS = R_0*al*i_armature*dT_minus_T_0_dS;
    const double dheat_winding_dS = i_armature*dV_winding_dS;
    /* result */
    out[0] = -dV_winding_dphi;
    out[1] = -n_machine*domega_rotor_dH;
    out[2] = -dV_winding_dS;
    out[n_ + 0] = n_machine/L;
    out[n_ + 1] = -dtau_bearing_dH;
    out[2*n_ + 0] = dheat_winding_dphi/T;
    out[2*n_ + 1] = dheat_bearing_dH/T;
    out[2*n_ + 2] = dheat_winding_dS/T
        + (-(heat_winding + heat_bearing)/power_2(T) - lam*T_e/power_2(T))*dT_minus_T_0_dS;
}

/* Margin by which each condition of the domain holds; of a bank, the least one. */
void dc_motor_margins(const double *restrict x,
                      const double *restrict u,
                      const dc_motor_parameters *restrict p,
                      double *restrict out)
{
    const double R_0 = p->R_0;
    const double al = p->al;
    const double L = p->L;
    const double J_m = p->J_m;
    const double b = p->b;
    const double n = p->n;
    const double J_l = p->J_l;
    const double c = p->c;
    const double lam = p->lam;
    const double T_0 = p->T_0;
    const double S = x[2];
    const double T_e = u[2];
    /* co-states dU/dx */
    const double T_minus_T_0 = T_0*expm1(S/c);
    /* result */
    out[0] = R_0;
    out[1] = al;
    out[2] = b;
    out[3] = lam;
    out[4] = n;
    out[5] = 1.0 + al*T_minus_T_0;
    out[6] = T_e;
    out[7] = L;
    out[8] = J_m;
    out[9] = J_l;
    out[10] = T_0;
    out[11] = c;
}
