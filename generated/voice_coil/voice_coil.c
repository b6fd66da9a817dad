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
#include "voice_coil.h"

#include <math.h>

static double power_2(double z)
{
    return z*z;
}

/* Number of states n. */
long voice_coil_states(const voice_coil_parameters *restrict p_)
{
    (void)p_;
    return 5;
}

/* Number of processes, which produce entropy; of a bank, one per lane. */
long voice_coil_processes(const voice_coil_parameters *restrict p_)
{
    (void)p_;
    return 3;
}

/* State at t = 0 [SI], for the inputs u at t = 0. */
void voice_coil_initial_state(const double *restrict u,
                              const voice_coil_parameters *restrict p_,
                              double *restrict out)
{
    (void)u;
    (void)p_;
    out[0] = 0.0;
    out[1] = 0.0;
    out[2] = 0.0;
    out[3] = 0.0;
    out[4] = 0.0;
}

/* Rates dx/dt, the rows of J_ir dU/dx + g u. */
void voice_coil_rhs(const double *restrict x,
                    const double *restrict u,
                    const voice_coil_parameters *restrict p_,
                    double *restrict out)
{
    const double m = p_->m;
    const double k = p_->k;
    const double d = p_->d;
    const double Bl = p_->Bl;
    const double R_0 = p_->R_0;
    const double al = p_->al;
    const double L = p_->L;
    const double c_w = p_->c_w;
    const double c_m = p_->c_m;
    const double lam = p_->lam;
    const double h = p_->h;
    const double T_0 = p_->T_0;
    const double q = x[0];
    const double p = x[1];
    const double phi = x[2];
    const double S_w = x[3];
    const double S_m = x[4];
    const double V_in = u[0];
    const double T_e = u[1];
    /* co-states dU/dx */
    const double F_suspension = k*q;
    const double v_cone = p/m;
    const double i_coil = phi/L;
    const double T_winding_minus_T_0 = T_0*expm1(S_w/c_w);
    const double T_winding = T_0 + T_winding_minus_T_0;
    const double T_magnet = T_0*exp(S_m/c_m);
    /* transducer ratios */
    const double n_gap = Bl;
    /* dissipative laws */
    const double F_losses = d*v_cone;
    const double V_copper = R_0*(1.0 + al*T_winding_minus_T_0)*i_coil;
    const double s_contact = lam*(T_winding - T_magnet)/T_winding;
    /* heats */
    const double heat_losses = F_losses*v_cone;
    const double heat_copper = V_copper*i_coil;
    const double heat_contact = s_contact*T_winding;
    /* result */
    out[0] = v_cone;
    out[1] = n_gap*i_coil - F_suspension - F_losses;
    out[2] = V_in - n_gap*v_cone - V_copper;
    out[3] = heat_copper/T_winding - s_contact;
    out[4] = (heat_losses + heat_contact)/T_magnet + h*(T_e/T_magnet - 1.0);
}

/* Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient. */
void voice_coil_outputs(const double *restrict x,
                        const double *restrict u,
                        const voice_coil_parameters *restrict p_,
                        double *restrict out)
{
    (void)u;
    const double L = p_->L;
    const double c_m = p_->c_m;
    const double T_0 = p_->T_0;
    const double phi = x[2];
    const double S_m = x[4];
    /* co-states dU/dx */
    const double i_coil = phi/L;
    const double T_magnet = T_0*exp(S_m/c_m);
    /* result */
    out[0] = i_coil;
    out[1] = T_magnet;
}

/* Power supplied through each port [W]; the sum is dU/dt. */
void voice_coil_supply(const double *restrict x,
                       const double *restrict u,
                       const voice_coil_parameters *restrict p_,
                       double *restrict out)
{
    const double L = p_->L;
    const double c_m = p_->c_m;
    const double h = p_->h;
    const double T_0 = p_->T_0;
    const double phi = x[2];
    const double S_m = x[4];
    const double V_in = u[0];
    const double T_e = u[1];
    /* co-states dU/dx */
    const double i_coil = phi/L;
    const double T_magnet = T_0*exp(S_m/c_m);
    /* result */
    out[0] = i_coil*V_in;
    out[1] = h*(T_e - T_magnet);
}

/* Hamiltonian U [J]. */
double voice_coil_energy(const double *restrict x, const voice_coil_parameters *restrict p_)
{
    const double m = p_->m;
    const double k = p_->k;
    const double L = p_->L;
    const double c_w = p_->c_w;
    const double c_m = p_->c_m;
    const double T_0 = p_->T_0;
    const double q = x[0];
    const double p = x[1];
    const double phi = x[2];
    const double S_w = x[3];
    const double S_m = x[4];
    return k*power_2(q)/2.0
        + power_2(p)/(2.0*m)
        + power_2(phi)/(2.0*L)
        + T_0*c_w*exp(S_w/c_w)
        + T_0*c_m*exp(S_m/c_m);
}

/* Total entropy S [J/K]. */
double voice_coil_entropy(const double *restrict x, const voice_coil_parameters *restrict p_)
{
    (void)p_;
    const double S_w = x[3];
    const double S_m = x[4];
    return S_w + S_m;
}

/* Temperature of each body [K]. */
void voice_coil_temperatures(const double *restrict x,
                             const voice_coil_parameters *restrict p_,
                             double *restrict out)
{
    const double c_w = p_->c_w;
    const double c_m = p_->c_m;
    const double T_0 = p_->T_0;
    const double S_w = x[3];
    const double S_m = x[4];
    /* co-states dU/dx */
    const double T_winding_minus_T_0 = T_0*expm1(S_w/c_w);
    const double T_winding = T_0 + T_winding_minus_T_0;
    const double T_magnet = T_0*exp(S_m/c_m);
    /* result */
    out[0] = T_winding;
    out[1] = T_magnet;
}

/* Power that each process turns into heat [W]; of a bank, one row per lane. */
void voice_coil_heat(const double *restrict x,
                     const double *restrict u,
                     const voice_coil_parameters *restrict p_,
                     double *restrict out)
{
    (void)u;
    const double m = p_->m;
    const double d = p_->d;
    const double R_0 = p_->R_0;
    const double al = p_->al;
    const double L = p_->L;
    const double c_w = p_->c_w;
    const double c_m = p_->c_m;
    const double lam = p_->lam;
    const double T_0 = p_->T_0;
    const double p = x[1];
    const double phi = x[2];
    const double S_w = x[3];
    const double S_m = x[4];
    /* co-states dU/dx */
    const double v_cone = p/m;
    const double i_coil = phi/L;
    const double T_winding_minus_T_0 = T_0*expm1(S_w/c_w);
    const double T_winding = T_0 + T_winding_minus_T_0;
    const double T_magnet = T_0*exp(S_m/c_m);
    /* dissipative laws */
    const double F_losses = d*v_cone;
    const double V_copper = R_0*(1.0 + al*T_winding_minus_T_0)*i_coil;
    const double s_contact = lam*(T_winding - T_magnet)/T_winding;
    /* result */
    out[0] = F_losses*v_cone;
    out[1] = V_copper*i_coil;
    out[2] = s_contact*T_winding;
}

/*
 * Entropy production of each process [W/K], heat exchange with ambients not included; of a
 * bank, one row per lane.
 */
void voice_coil_entropy_production(const double *restrict x,
                                   const double *restrict u,
                                   const voice_coil_parameters *restrict p_,
                                   double *restrict out)
{
    (void)u;
    const double m = p_->m;
    const double d = p_->d;
    const double R_0 = p_->R_0;
    const double al = p_->al;
    const double L = p_->L;
    const double c_w = p_->c_w;
    const double c_m = p_->c_m;
    const double lam = p_->lam;
    const double T_0 = p_->T_0;
    const double p = x[1];
    const double phi = x[2];
    const double S_w = x[3];
    const double S_m = x[4];
    /* co-states dU/dx */
    const double v_cone = p/m;
    const double i_coil = phi/L;
    const double T_winding_minus_T_0 = T_0*expm1(S_w/c_w);
    const double T_winding = T_0 + T_winding_minus_T_0;
    const double T_magnet = T_0*exp(S_m/c_m);
    /* dissipative laws */
    const double F_losses = d*v_cone;
    const double V_copper = R_0*(1.0 + al*T_winding_minus_T_0)*i_coil;
    const double s_contact = lam*(T_winding - T_magnet)/T_winding;
    /* result */
    out[0] = F_losses*v_cone/T_magnet;
    out[1] = V_copper*i_coil/T_winding;
    out[2] = s_contact*(T_winding - T_magnet)/T_magnet;
}

/* Effort, flow, power, energy and heat of elements; of a bank, one row per lane. */
void voice_coil_elements(const double *restrict x,
                         const double *restrict u,
                         const voice_coil_parameters *restrict p_,
                         double *restrict out)
{
    const double m = p_->m;
    const double k = p_->k;
    const double d = p_->d;
    const double Bl = p_->Bl;
    const double R_0 = p_->R_0;
    const double al = p_->al;
    const double L = p_->L;
    const double c_w = p_->c_w;
    const double c_m = p_->c_m;
    const double lam = p_->lam;
    const double h = p_->h;
    const double T_0 = p_->T_0;
    const double q = x[0];
    const double p = x[1];
    const double phi = x[2];
    const double S_w = x[3];
    const double S_m = x[4];
    const double V_in = u[0];
    const double T_e = u[1];
    /* co-states dU/dx */
    const double F_suspension = k*q;
    const double v_cone = p/m;
    const double i_coil = phi/L;
    const double T_winding_minus_T_0 = T_0*expm1(S_w/c_w);
    const double T_winding = T_0 + T_winding_minus_T_0;
    const double T_magnet = T_0*exp(S_m/c_m);
    /* transducer ratios */
    const double n_gap = Bl;
    /* dissipative laws */
    const double F_losses = d*v_cone;
    const double V_copper = R_0*(1.0 + al*T_winding_minus_T_0)*i_coil;
    const double s_contact = lam*(T_winding - T_magnet)/T_winding;
    /* heats */
    const double heat_losses = F_losses*v_cone;
    const double heat_copper = V_copper*i_coil;
    const double heat_contact = s_contact*T_winding;
    /* rates */
    const double rate_p = n_gap*i_coil - F_suspension - F_losses;
    const double rate_phi = V_in - n_gap*v_cone - V_copper;
    const double rate_S_w = heat_copper/T_winding - s_contact;
    const double rate_S_m = (heat_losses + heat_contact)/T_magnet + h*(T_e/T_magnet - 1.0);
    /* result */
    out[0] = F_suspension;
    out[1] = v_cone;
    out[2] = F_suspension*v_cone;
    out[3] = k*power_2(q)/2.0;
    out[4] = rate_p;
    out[5] = v_cone;
    out[6] = rate_p*v_cone;
    out[7] = power_2(p)/(2.0*m);
    out[8] = F_losses;
    out[9] = v_cone;
    out[10] = F_losses*v_cone;
    out[11] = F_losses*v_cone;
    out[12] = rate_phi;
    out[13] = i_coil;
    out[14] = rate_phi*i_coil;
    out[15] = power_2(phi)/(2.0*L);
    out[16] = V_copper;
    out[17] = i_coil;
    out[18] = V_copper*i_coil;
    out[19] = V_copper*i_coil;
    out[20] = n_gap*v_cone;
    out[21] = i_coil;
    out[22] = -n_gap*i_coil;
    out[23] = v_cone;
    out[24] = n_gap*v_cone*i_coil;
    out[25] = T_winding;
    out[26] = rate_S_w;
    out[27] = T_winding*rate_S_w;
    out[28] = T_0*c_w*exp(S_w/c_w);
    out[29] = T_magnet;
    out[30] = rate_S_m;
    out[31] = T_magnet*rate_S_m;
    out[32] = T_0*c_m*exp(S_m/c_m);
    out[33] = T_winding - T_magnet;
    out[34] = s_contact*T_winding;
    out[35] = T_magnet;
    out[36] = -h*(T_e/T_magnet - 1.0);
    out[37] = -h*(T_e - T_magnet);
    out[38] = V_in;
    out[39] = -i_coil;
    out[40] = -i_coil*V_in;
}

/* Jacobian of rhs, n x n, row after row: d rhs[i]/d x[j] at out[i*n + j]. */
void voice_coil_jacobian(const double *restrict x,
                         const double *restrict u,
                         const voice_coil_parameters *restrict p_,
                         double *restrict out)
{
    const long n = 5;
    const double m = p_->m;
    const double k = p_->k;
    const double d = p_->d;
    const double Bl = p_->Bl;
    const double R_0 = p_->R_0;
    const double al = p_->al;
    const double L = p_->L;
    const double c_w = p_->c_w;
    const double c_m = p_->c_m;
    const double lam = p_->lam;
    const double h = p_->h;
    const double T_0 = p_->T_0;
    const double p = x[1];
    const double phi = x[2];
    const double S_w = x[3];
    const double S_m = x[4];
    const double T_e = u[1];
    for (long j = 0; j < n*n; ++j) {
        out[j] = 0.0;
    }
    /* co-states dU/dx */
    const double v_cone = p/m;
    const double i_coil = phi/L;
    const double T_winding_minus_T_0 = T_0*expm1(S_w/c_w);
    const double T_winding = T_0 + T_winding_minus_T_0;
    const double T_magnet = T_0*exp(S_m/c_m);
    /* transducer ratios */
    const double n_gap = Bl;
    /* dissipative laws */
    const double F_losses = d*v_cone;
    const double V_copper = R_0*(1.0 + al*T_winding_minus_T_0)*i_coil;
    const double s_contact = lam*(T_winding - T_magnet)/T_winding;
    /* heats */
    const double heat_losses = F_losses*v_cone;
    const double heat_copper = V_copper*i_coil;
    const double heat_contact = s_contact*T_winding;
    /* derivatives */
    const double dF_losses_dp = d/m;
    const double dheat_losses_dp = v_cone*dF_losses_dp + F_losses/m;
    const double dV_copper_dphi = R_0*(1.0 + al*T_winding_minus_T_0)/L;
    const double dheat_copper_dphi = i_coil*dV_copper_dphi + V_copper/L;
    const double dT_winding_minus_T_0_dS_w = T_winding/c_w;
    const double dV_copper_dS_w = R_0*al*i_coil*dT_winding_minus_T_0_dS_w;
    const double ds_contact_dS_w = (lam/T_winding - lam*(T_winding - T_magnet)/power_2(T_winding))*dT_winding_minus_T_0_dS_w;
    const double dheat_copper_dS_w = i_coil*dV_copper_dS_w;
    const double dheat_contact_dS_w = T_winding*ds_contact_dS_w
        + s_contact*dT_winding_minus_T_0_dS_w;
    const double dT_magnet_dS_m = T_magnet/c_m;
    const double ds_contact_dS_m = -lam/T_winding*dT_magnet_dS_m;
    const double dheat_contact_dS_m = T_winding*ds_contact_dS_m;
    /* result */
    out[1] = 1.0/m;
    out[n + 0] = -k;
    out[n + 1] = -dF_losses_dp;
    out[n + 2] = n_gap/L;
    out[2*n + 1] = -n_gap/m;
    out[2*n + 2] = -dV_copper_dphi;
    out[2*n + 3] = -dV_copper_dS_w;
    out[3*n + 2] = dheat_copper_dphi/T_winding;
    out[3*n + 3] = dheat_copper_dS_w/T_winding
        - heat_copper/power_2(T_winding)*dT_winding_minus_T_0_dS_w
        - ds_contact_dS_w;
    out[3*n + 4] = -ds_contact_dS_m;
    out[4*n + 1] = dheat_losses_dp/T_magnet;
    out[4*n + 3] = dheat_contact_dS_w/T_magnet;
    out[4*n + 4] = dheat_contact_dS_m/T_magnet
        + (-(heat_losses + heat_contact)/power_2(T_magnet) - h*T_e/power_2(T_magnet))*dT_magnet_dS_m;
}

/* Margin by which each condition of the domain holds; of a bank, the least one. */
void voice_coil_margins(const double *restrict x,
                        const double *restrict u,
                        const voice_coil_parameters *restrict p_,
                        double *restrict out)
{
    const double m = p_->m;
    const double k = p_->k;
    const double d = p_->d;
    const double R_0 = p_->R_0;
    const double al = p_->al;
    const double L = p_->L;
    const double c_w = p_->c_w;
    const double c_m = p_->c_m;
    const double lam = p_->lam;
    const double h = p_->h;
    const double T_0 = p_->T_0;
    const double S_w = x[3];
    const double T_e = u[1];
    /* co-states dU/dx */
    const double T_winding_minus_T_0 = T_0*expm1(S_w/c_w);
    /* result */
    out[0] = d;
    out[1] = R_0;
    out[2] = al;
    out[3] = lam;
    out[4] = h;
    out[5] = 1.0 + al*T_winding_minus_T_0;
    out[6] = T_e;
    out[7] = k;
    out[8] = m;
    out[9] = L;
    out[10] = T_0;
    out[11] = c_w;
    out[12] = c_m;
}
