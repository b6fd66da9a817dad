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
#include "thermistor.h"

#include <math.h>

static double power_2(double z)
{
    return z*z;
}

/* Number of states n. */
long thermistor_states(const thermistor_parameters *restrict p)
{
    (void)p;
    return 3;
}

/* Number of processes, which produce entropy; of a bank, one per lane. */
long thermistor_processes(const thermistor_parameters *restrict p)
{
    (void)p;
    return 1;
}

/* State at t = 0 [SI], for the inputs u at t = 0. */
void thermistor_initial_state(const double *restrict u,
                              const thermistor_parameters *restrict p,
                              double *restrict out)
{
    (void)u;
    (void)p;
    out[0] = 0.0;
    out[1] = 0.00002;
    out[2] = 0.0;
}

/* Rates dx/dt, the rows of J_ir dU/dx + g u. */
void thermistor_rhs(const double *restrict x,
                    const double *restrict u,
                    const thermistor_parameters *restrict p,
                    double *restrict out)
{
    (void)u;
    const double L = p->L;
    const double C = p->C;
    const double R_0 = p->R_0;
    const double B = p->B;
    const double c = p->c;
    const double T_0 = p->T_0;
    const double phi = x[0];
    const double Q = x[1];
    const double S = x[2];
    /* co-states dU/dx */
    const double i_coil = phi/L;
    const double V_cap = Q/C;
    const double T = T_0*exp(S/c);
    /* dissipative laws */
    const double V_bead = R_0*exp(B*(1.0/T - 1.0/T_0))*i_coil;
    /* heats */
    const double heat_bead = V_bead*i_coil;
    /* result */
    out[0] = V_cap - V_bead;
    out[1] = -i_coil;
    out[2] = heat_bead/T;
}

/* Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient. */
void thermistor_outputs(const double *restrict x,
                        const double *restrict u,
                        const thermistor_parameters *restrict p,
                        double *restrict out)
{
    (void)x;
    (void)u;
    (void)p;
    (void)out;
}

/* Power supplied through each port [W]; the sum is dU/dt. */
void thermistor_supply(const double *restrict x,
                       const double *restrict u,
                       const thermistor_parameters *restrict p,
                       double *restrict out)
{
    (void)x;
    (void)u;
    (void)p;
    (void)out;
}

/* Hamiltonian U [J]. */
double thermistor_energy(const double *restrict x, const thermistor_parameters *restrict p)
{
    const double L = p->L;
    const double C = p->C;
    const double c = p->c;
    const double T_0 = p->T_0;
    const double phi = x[0];
    const double Q = x[1];
    const double S = x[2];
    return power_2(phi)/(2.0*L) + power_2(Q)/(2.0*C) + T_0*c*exp(S/c);
}

/* Total entropy S [J/K]. */
double thermistor_entropy(const double *restrict x, const thermistor_parameters *restrict p)
{
    (void)p;
    const double S = x[2];
    return S;
}

/* Temperature of each body [K]. */
void thermistor_temperatures(const double *restrict x,
                             const thermistor_parameters *restrict p,
                             double *restrict out)
{
    const double c = p->c;
    const double T_0 = p->T_0;
    const double S = x[2];
    /* co-states dU/dx */
    const double T = T_0*exp(S/c);
    /* result */
    out[0] = T;
}

/* Power that each process turns into heat [W]; of a bank, one row per lane. */
void thermistor_heat(const double *restrict x,
                     const double *restrict u,
                     const thermistor_parameters *restrict p,
                     double *restrict out)
{
    (void)u;
    const double L = p->L;
    const double R_0 = p->R_0;
    const double B = p->B;
    const double c = p->c;
    const double T_0 = p->T_0;
    const double phi = x[0];
    const double S = x[2];
    /* co-states dU/dx */
    const double i_coil = phi/L;
    const double T = T_0*exp(S/c);
    /* dissipative laws */
    const double V_bead = R_0*exp(B*(1.0/T - 1.0/T_0))*i_coil;
    /* result */
    out[0] = V_bead*i_coil;
}

/*
 * Entropy production of each process [W/K], heat exchange with ambients not included; of a
 * bank, one row per lane.
 */
void thermistor_entropy_production(const double *restrict x,
                                   const double *restrict u,
                                   const thermistor_parameters *restrict p,
                                   double *restrict out)
{
    (void)u;
    const double L = p->L;
    const double R_0 = p->R_0;
    const double B = p->B;
    const double c = p->c;
    const double T_0 = p->T_0;
    const double phi = x[0];
    const double S = x[2];
    /* co-states dU/dx */
    const double i_coil = phi/L;
    const double T = T_0*exp(S/c);
    /* dissipative laws */
    const double V_bead = R_0*exp(B*(1.0/T - 1.0/T_0))*i_coil;
    /* result */
    out[0] = V_bead*i_coil/T;
}

/* Effort, flow, power, energy and heat of elements; of a bank, one row per lane. */
void thermistor_elements(const double *restrict x,
                         const double *restrict u,
                         const thermistor_parameters *restrict p,
                         double *restrict out)
{
    (void)u;
    const double L = p->L;
    const double C = p->C;
    const double R_0 = p->R_0;
    const double B = p->B;
    const double c = p->c;
    const double T_0 = p->T_0;
    const double phi = x[0];
    const double Q = x[1];
    const double S = x[2];
    /* co-states dU/dx */
    const double i_coil = phi/L;
    const double V_cap = Q/C;
    const double T = T_0*exp(S/c);
    /* dissipative laws */
    const double V_bead = R_0*exp(B*(1.0/T - 1.0/T_0))*i_coil;
    /* heats */
    const double heat_bead = V_bead*i_coil;
    /* rates */
    const double rate_phi = V_cap - V_bead;
    const double rate_Q = -i_coil;
    const double rate_S = heat_bead/T;
    /* result */
    out[0] = rate_phi;
    out[1] = i_coil;
    out[2] = rate_phi*i_coil;
    out[3] = power_2(phi)/(2.0*L);
    out[4] = V_cap;
    out[5] = rate_Q;
    out[6] = V_cap*rate_Q;
    out[7] = power_2(Q)/(2.0*C);
    out[8] = V_bead;
    out[9] = i_coil;
    out[10] = V_bead*i_coil;
    out[11] = V_bead*i_coil;
    out[12] = T;
    out[13] = rate_S;
    out[14] = T*rate_S;
    out[15] = T_0*c*exp(S/c);
}

/* Jacobian of rhs, n x n, row after row: d rhs[i]/d x[j] at out[i*n + j]. */
void thermistor_jacobian(const double *restrict x,
                         const double *restrict u,
                         const thermistor_parameters *restrict p,
                         double *restrict out)
{
    (void)u;
    const long n = 3;
    const double L = p->L;
    const double C = p->C;
    const double R_0 = p->R_0;
    const double B = p->B;
    const double c = p->c;
    const double T_0 = p->T_0;
    const double phi = x[0];
    const double S = x[2];
    for (long j = 0; j < n*n; ++j) {
        out[j] = 0.0;
    }
    /* co-states dU/dx */
    const double i_coil = phi/L;
    const double T = T_0*exp(S/c);
    /* dissipative laws */
    const double V_bead = R_0*exp(B*(1.0/T - 1.0/T_0))*i_coil;
    /* heats */
    const double heat_bead = V_bead*i_coil;
    /* derivatives */
    const double dV_bead_dphi = R_0*exp(B*(1.0/T - 1.0/T_0))/L;
    const double dheat_bead_dphi = i_coil*dV_bead_dphi + V_bead/L;
    const double dT_dS = T/c;
    const double dV_bead_dS = -R_0*exp(B*(1.0/T - 1.0/T_0))*B/power_2(T)*i_coil*dT_dS;
    const double dheat_bead_dS = i_coil*dV_bead_dS;
    /* result */
    out[0] = -dV_bead_dphi;
    out[1] = 1.0/C;
    out[2] = -dV_bead_dS;
    out[n + 0] = -1.0/L;
    out[2*n + 0] = dheat_bead_dphi/T;
    out[2*n + 2] = dheat_bead_dS/T - heat_bead/power_2(T)*dT_dS;
}

/* Margin by which each condition of the domain holds; of a bank, the least one. */
void thermistor_margins(const double *restrict x,
                        const double *restrict u,
                        const thermistor_parameters *restrict p,
                        double *restrict out)
{
    (void)x;
    (void)u;
    const double L = p->L;
    const double C = p->C;
    const double R_0 = p->R_0;
    const double c = p->c;
    const double T_0 = p->T_0;
    out[0] = R_0;
    out[1] = L;
    out[2] = C;
    out[3] = T_0;
    out[4] = c;
}
