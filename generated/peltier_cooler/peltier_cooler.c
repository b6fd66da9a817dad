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
#include "peltier_cooler.h"

#include <math.h>

static double power_2(double z)
{
    return z*z;
}

/* Number of states n. */
long peltier_cooler_states(const peltier_cooler_parameters *restrict p)
{
    (void)p;
    return 3;
}

/* Number of processes, which produce entropy; of a bank, one per lane. */
long peltier_cooler_processes(const peltier_cooler_parameters *restrict p)
{
    (void)p;
    return 3;
}

/* State at t = 0 [SI], for the inputs u at t = 0. */
void peltier_cooler_initial_state(const double *restrict u,
                                  const peltier_cooler_parameters *restrict p,
                                  double *restrict out)
{
    (void)u;
    (void)p;
    out[0] = 0.0;
    out[1] = 0.0;
    out[2] = 0.0;
}

/* Rates dx/dt, the rows of J_ir dU/dx + g u. */
void peltier_cooler_rhs(const double *restrict x,
                        const double *restrict u,
                        const peltier_cooler_parameters *restrict p,
                        double *restrict out)
{
    const double s = p->s;
    const double R = p->R;
    const double lam = p->lam;
    const double L = p->L;
    const double c_c = p->c_c;
    const double c_h = p->c_h;
    const double h = p->h;
    const double T_0 = p->T_0;
    const double phi = x[0];
    const double S_c = x[1];
    const double S_h = x[2];
    const double V_in = u[0];
    const double P = u[1];
    const double T_e = u[2];
    /* co-states dU/dx */
    const double i_leads = phi/L;
    const double T_plate = T_0*exp(S_c/c_c);
    const double T_sink = T_0*exp(S_h/c_h);
    /* transducer ratios */
    const double seebeck_couples = s;
    /* dissipative laws */
    const double V_warm = R/2.0*i_leads;
    const double V_cool = R/2.0*i_leads;
    const double s_legs = lam*(T_plate - T_sink)/T_plate;
    /* heats */
    const double heat_warm = V_warm*i_leads;
    const double heat_cool = V_cool*i_leads;
    const double heat_legs = s_legs*T_plate;
    /* result */
    out[0] = seebeck_couples*T_plate - seebeck_couples*T_sink - V_warm - V_cool + V_in;
    out[1] = heat_cool/T_plate - seebeck_couples*i_leads - s_legs + P/T_plate;
    out[2] = (heat_warm + heat_legs)/T_sink
        + seebeck_couples*i_leads
        + h*(T_e/T_sink - 1.0);
}

/* Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient. */
void peltier_cooler_outputs(const double *restrict x,
                            const double *restrict u,
                            const peltier_cooler_parameters *restrict p,
                            double *restrict out)
{
    (void)u;
    const double L = p->L;
    const double c_c = p->c_c;
    const double c_h = p->c_h;
    const double T_0 = p->T_0;
    const double phi = x[0];
    const double S_c = x[1];
    const double S_h = x[2];
    /* co-states dU/dx */
    const double i_leads = phi/L;
    const double T_plate = T_0*exp(S_c/c_c);
    const double T_sink = T_0*exp(S_h/c_h);
    /* result */
    out[0] = i_leads;
    out[1] = T_plate;
    out[2] = T_sink;
}

/* Power supplied through each port [W]; the sum is dU/dt. */
void peltier_cooler_supply(const double *restrict x,
                           const double *restrict u,
                           const peltier_cooler_parameters *restrict p,
                           double *restrict out)
{
    const double L = p->L;
    const double c_h = p->c_h;
    const double h = p->h;
    const double T_0 = p->T_0;
    const double phi = x[0];
    const double S_h = x[2];
    const double V_in = u[0];
    const double P = u[1];
    const double T_e = u[2];
    /* co-states dU/dx */
    const double i_leads = phi/L;
    const double T_sink = T_0*exp(S_h/c_h);
    /* result */
    out[0] = i_leads*V_in;
    out[1] = P;
    out[2] = h*(T_e - T_sink);
}

/* Hamiltonian U [J]. */
double peltier_cooler_energy(const double *restrict x,
                             const peltier_cooler_parameters *restrict p)
{
    const double L = p->L;
    const double c_c = p->c_c;
    const double c_h = p->c_h;
    const double T_0 = p->T_0;
    const double phi = x[0];
    const double S_c = x[1];
    const double S_h = x[2];
    return power_2(phi)/(2.0*L) + T_0*c_c*exp(S_c/c_c) + T_0*c_h*exp(S_h/c_h);
}

/* Total entropy S [J/K]. */
double peltier_cooler_entropy(const double *restrict x,
                              const peltier_cooler_parameters *restrict p)
{
    (void)p;
    const double S_c = x[1];
    const double S_h = x[2];
    return S_c + S_h;
}

/* Temperature of each body [K]. */
void peltier_cooler_temperatures(const double *restrict x,
                                 const peltier_cooler_parameters *restrict p,
                                 double *restrict out)
{
    const double c_c = p->c_c;
    const double c_h = p->c_h;
    const double T_0 = p->T_0;
    const double S_c = x[1];
    const double S_h = x[2];
    /* co-states dU/dx */
    const double T_plate = T_0*exp(S_c/c_c);
    const double T_sink = T_0*exp(S_h/c_h);
    /* result */
    out[0] = T_plate;
    out[1] = T_sink;
}

/* Power that each process turns into heat [W]; of a bank, one row per lane. */
void peltier_cooler_heat(const double *restrict x,
                         const double *restrict u,
                         const peltier_cooler_parameters *restrict p,
                         double *restrict out)
{
    (void)u;
    const double R = p->R;
    const double lam = p->lam;
    const double L = p->L;
    const double c_c = p->c_c;
    const double c_h = p->c_h;
    const double T_0 = p->T_0;
    const double phi = x[0];
    const double S_c = x[1];
    const double S_h = x[2];
    /* co-states dU/dx */
    const double i_leads = phi/L;
    const double T_plate = T_0*exp(S_c/c_c);
    const double T_sink = T_0*exp(S_h/c_h);
    /* dissipative laws */
    const double V_warm = R/2.0*i_leads;
    const double V_cool = R/2.0*i_leads;
    const double s_legs = lam*(T_plate - T_sink)/T_plate;
    /* result */
    out[0] = V_warm*i_leads;
    out[1] = V_cool*i_leads;
    out[2] = s_legs*T_plate;
}

/*
 * Entropy production of each process [W/K], heat exchange with ambients not included; of a
 * bank, one row per lane.
 */
void peltier_cooler_entropy_production(const double *restrict x,
                                       const double *restrict u,
                                       const peltier_cooler_parameters *restrict p,
                                       double *restrict out)
{
    (void)u;
    const double R = p->R;
    const double lam = p->lam;
    const double L = p->L;
    const double c_c = p->c_c;
    const double c_h = p->c_h;
    const double T_0 = p->T_0;
    const double phi = x[0];
    const double S_c = x[1];
    const double S_h = x[2];
    /* co-states dU/dx */
    const double i_leads = phi/L;
    const double T_plate = T_0*exp(S_c/c_c);
    const double T_sink = T_0*exp(S_h/c_h);
    /* dissipative laws */
    const double V_warm = R/2.0*i_leads;
    const double V_cool = R/2.0*i_leads;
    const double s_legs = lam*(T_plate - T_sink)/T_plate;
    /* result */
    out[0] = V_warm*i_leads/T_sink;
    out[1] = V_cool*i_leads/T_plate;
    out[2] = s_legs*(T_plate - T_sink)/T_sink;
}

/* Effort, flow, power, energy and heat of elements; of a bank, one row per lane. */
void peltier_cooler_elements(const double *restrict x,
                             const double *restrict u,
                             const peltier_cooler_parameters *restrict p,
                             double *restrict out)
{
    const double s = p->s;
    const double R = p->R;
    const double lam = p->lam;
    const double L = p->L;
    const double c_c = p->c_c;
    const double c_h = p->c_h;
    const double h = p->h;
    const double T_0 = p->T_0;
    const double phi = x[0];
    const double S_c = x[1];
    const double S_h = x[2];
    const double V_in = u[0];
    const double P = u[1];
    const double T_e = u[2];
    /* co-states dU/dx */
    const double i_leads = phi/L;
    const double T_plate = T_0*exp(S_c/c_c);
    const double T_sink = T_0*exp(S_h/c_h);
    /* transducer ratios */
    const double seebeck_couples = s;
    /* dissipative laws */
    const double V_warm = R/2.0*i_leads;
    const double V_cool = R/2.0*i_leads;
    const double s_legs = lam*(T_plate - T_sink)/T_plate;
    /* heats */
    const double heat_warm = V_warm*i_leads;
    const double heat_cool = V_cool*i_leads;
    const double heat_legs = s_legs*T_plate;
    /* rates */
    const double rate_phi = seebeck_couples*T_plate
        - seebeck_couples*T_sink
        - V_warm
        - V_cool
        + V_in;
    const double rate_S_c = heat_cool/T_plate
        - seebeck_couples*i_leads
        - s_legs
        + P/T_plate;
    const double rate_S_h = (heat_warm + heat_legs)/T_sink
        + seebeck_couples*i_leads
        + h*(T_e/T_sink - 1.0);
    /* result */
    out[0] = V_in;
    out[1] = -i_leads;
    out[2] = -i_leads*V_in;
    out[3] = rate_phi;
    out[4] = i_leads;
    out[5] = rate_phi*i_leads;
    out[6] = power_2(phi)/(2.0*L);
    out[7] = V_warm;
    out[8] = i_leads;
    out[9] = V_warm*i_leads;
    out[10] = V_warm*i_leads;
    out[11] = V_cool;
    out[12] = i_leads;
    out[13] = V_cool*i_leads;
    out[14] = V_cool*i_leads;
    out[15] = seebeck_couples*(-T_plate + T_sink);
    out[16] = i_leads;
    out[17] = -T_plate + T_sink;
    out[18] = -seebeck_couples*i_leads;
    out[19] = seebeck_couples*(-T_plate + T_sink)*i_leads;
    out[20] = T_plate - T_sink;
    out[21] = s_legs*T_plate;
    out[22] = T_plate;
    out[23] = rate_S_c;
    out[24] = T_plate*rate_S_c;
    out[25] = T_0*c_c*exp(S_c/c_c);
    out[26] = T_sink;
    out[27] = rate_S_h;
    out[28] = T_sink*rate_S_h;
    out[29] = T_0*c_h*exp(S_h/c_h);
    out[30] = T_plate;
    out[31] = -P/T_plate;
    out[32] = -P;
    out[33] = T_sink;
    out[34] = -h*(T_e/T_sink - 1.0);
    out[35] = -h*(T_e - T_sink);
}

/* Jacobian of rhs, n x n, row after row: d rhs[i]/d x[j] at out[i*n + j]. */
void peltier_cooler_jacobian(const double *restrict x,
                             const double *restrict u,
                             const peltier_cooler_parameters *restrict p,
                             double *restrict out)
{
    const long n = 3;
    const double s = p->s;
    const double R = p->R;
    const double lam = p->lam;
    const double L = p->L;
    const double c_c = p->c_c;
    const double c_h = p->c_h;
    const double h = p->h;
    const double T_0 = p->T_0;
    const double phi = x[0];
    const double S_c = x[1];
    const double S_h = x[2];
    const double P = u[1];
    const double T_e = u[2];
    for (long j = 0; j < n*n; ++j) {
        out[j] = 0.0;
    }
    /* co-states dU/dx */
    const double i_leads = phi/L;
    const double T_plate = T_0*exp(S_c/c_c);
    const double T_sink = T_0*exp(S_h/c_h);
    /* transducer ratios */
    const double seebeck_couples = s;
    /* dissipative laws */
    const double V_warm = R/2.0*i_leads;
    const double V_cool = R/2.0*i_leads;
    const double s_legs = lam*(T_plate - T_sink)/T_plate;
    /* heats */
    const double heat_warm = V_warm*i_leads;
    const double heat_cool = V_cool*i_leads;
    const double heat_legs = s_legs*T_plate;
    /* derivatives */
    const double dV_warm_dphi = R/2.0/L;
    const double dheat_warm_dphi = i_leads*dV_warm_dphi + V_warm/L;
    const double dheat_cool_dphi = i_leads*dV_warm_dphi + V_cool/L;
    const double dT_plate_dS_c = T_plate/c_c;
    const double ds_legs_dS_c = (lam/T_plate - lam*(T_plate - T_sink)/power_2(T_plate))*dT_plate_dS_c;
    const double dheat_legs_dS_c = T_plate*ds_legs_dS_c + s_legs*dT_plate_dS_c;
    const double dT_sink_dS_h = T_sink/c_h;
    const double ds_legs_dS_h = -lam/T_plate*dT_sink_dS_h;
    const double dheat_legs_dS_h = T_plate*ds_legs_dS_h;
    /* result */
    out[0] = -dV_warm_dphi - dV_warm_dphi;
    out[1] = seebeck_couples*dT_plate_dS_c;
    out[2] = -seebeck_couples*dT_sink_dS_h;
    out[n + 0] = dheat_cool_dphi/T_plate - seebeck_couples/L;
    out[n + 1] = (-heat_cool/power_2(T_plate) - P/power_2(T_plate))*dT_plate_dS_c
        - ds_legs_dS_c;
    out[n + 2] = -ds_legs_dS_h;
    out[2*n + 0] = dheat_warm_dphi/T_sink + seebeck_couples/L;
    out[2*n + 1] = dheat_legs_dS_c/T_sink;
    out[2*n + 2] = dheat_legs_dS_h/T_sink
        + (-(heat_warm + heat_legs)/power_2(T_sink) - h*T_e/power_2(T_sink))*dT_sink_dS_h;
}

/* Margin by which each condition of the domain holds; of a bank, the least one. */
void peltier_cooler_margins(const double *restrict x,
                            const double *restrict u,
                            const peltier_cooler_parameters *restrict p,
                            double *restrict out)
{
    (void)x;
    const double R = p->R;
    const double lam = p->lam;
    const double L = p->L;
    const double c_c = p->c_c;
    const double c_h = p->c_h;
    const double h = p->h;
    const double T_0 = p->T_0;
    const double T_e = u[2];
    out[0] = R;
    out[1] = lam;
    out[2] = h;
    out[3] = T_e;
    out[4] = L;
    out[5] = T_0;
    out[6] = c_c;
    out[7] = c_h;
}
