/*
 * Piezoelectric stack with a lever, a load and an end stop: irreversible port-Hamiltonian system.
 *
 * Source:  Scire, Teague (1978), Rev. Sci. Instrum. 49 (12), 1735-1740 (levers); Hunt, Crossley (1975), J. Appl. Mech. 42 (2), 440-445 (end stop); PiezoDrive SA050536
 * Model:   amplified_stack, spec sha256 f97db543e4f43ea0e60de47bf6de8bd925540145e93c475ce6262cae7eb13898
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, welldef, energy, entropy, passive, odd, continuous, sigma, exergy, environment, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (Q, q, p, x, x_e, S)
 * u = (F, V, T_e)
 * p_ = pointer to amplified_stack_parameters; the underscore tells it from p, a name of the model
 */
#include "amplified_stack.h"

#include <math.h>

static double pick(int condition, double a, double b)
{
    return condition ? a : b;
}

static double max(double a, double b)
{
    return a > b || a != a ? a : b; /* not a number stays so */
}

static double power_2(double z)
{
    return z*z;
}

/* Number of states n. */
long amplified_stack_states(const amplified_stack_parameters *restrict p_)
{
    (void)p_;
    return 6;
}

/* Number of processes, which produce entropy; of a bank, one per lane. */
long amplified_stack_processes(const amplified_stack_parameters *restrict p_)
{
    (void)p_;
    return 3;
}

/* State at t = 0 [SI], for the inputs u at t = 0. */
void amplified_stack_initial_state(const double *restrict u,
                                   const amplified_stack_parameters *restrict p_,
                                   double *restrict out)
{
    (void)u;
    (void)p_;
    out[0] = 0.0;
    out[1] = 0.0;
    out[2] = 0.0;
    out[3] = 0.0;
    out[4] = 0.0;
    out[5] = 0.0;
}

/* Rates dx/dt, the rows of J_ir dU/dx + g u. */
void amplified_stack_rhs(const double *restrict x_,
                         const double *restrict u,
                         const amplified_stack_parameters *restrict p_,
                         double *restrict out)
{
    const double k = p_->k;
    const double m_s = p_->m_s;
    const double a = p_->a;
    const double C = p_->C;
    const double R = p_->R;
    const double n = p_->n;
    const double m = p_->m;
    const double k_l = p_->k_l;
    const double d = p_->d;
    const double g = p_->g;
    const double k_e = p_->k_e;
    const double d_e = p_->d_e;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double lam = p_->lam;
    const double Q = x_[0];
    const double q = x_[1];
    const double p = x_[2];
    const double x = x_[3];
    const double x_e = x_[4];
    const double S = x_[5];
    const double F = u[0];
    const double V = u[1];
    const double T_e = u[2];
    /* co-states dU/dx */
    const double V_clamped = Q/C;
    const double F_stack = k*q;
    const double v_load = p/(m + m_s/power_2(n));
    const double F_spring = k_l*x;
    const double F_end_stop = k_e*max(x_e - g, 0.0);
    const double T = T_0*exp(S/c_0);
    /* transducer ratios */
    const double alpha_ceramic = a;
    const double n_lever = n;
    /* driving forces */
    const double V_leads = -V_clamped + V;
    /* dissipative laws */
    const double i_leads = V_leads/R;
    const double F_losses = d*v_load;
    const double F_bumper = d_e*max(x_e - g, 0.0)*v_load;
    /* heats */
    const double heat_leads = i_leads*V_leads;
    const double heat_losses = F_losses*v_load;
    const double heat_bumper = F_bumper*v_load;
    /* result */
    out[0] = i_leads - alpha_ceramic/n_lever*v_load;
    out[1] = v_load/n_lever;
    out[2] = alpha_ceramic/n_lever*V_clamped
        - F_stack/n_lever
        - F_spring
        - F_end_stop
        - F_losses
        - F_bumper
        + F;
    out[3] = v_load;
    out[4] = v_load;
    out[5] = (heat_leads + heat_losses + heat_bumper)/T + lam*(T_e/T - 1.0);
}

/* Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient. */
void amplified_stack_outputs(const double *restrict x_,
                             const double *restrict u,
                             const amplified_stack_parameters *restrict p_,
                             double *restrict out)
{
    const double m_s = p_->m_s;
    const double C = p_->C;
    const double R = p_->R;
    const double n = p_->n;
    const double m = p_->m;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double Q = x_[0];
    const double p = x_[2];
    const double S = x_[5];
    const double V = u[1];
    /* co-states dU/dx */
    const double V_clamped = Q/C;
    const double v_load = p/(m + m_s/power_2(n));
    const double T = T_0*exp(S/c_0);
    /* driving forces */
    const double V_leads = -V_clamped + V;
    /* dissipative laws */
    const double i_leads = V_leads/R;
    /* result */
    out[0] = v_load;
    out[1] = i_leads;
    out[2] = T;
}

/* Power supplied through each port [W]; the sum is dU/dt. */
void amplified_stack_supply(const double *restrict x_,
                            const double *restrict u,
                            const amplified_stack_parameters *restrict p_,
                            double *restrict out)
{
    const double m_s = p_->m_s;
    const double C = p_->C;
    const double R = p_->R;
    const double n = p_->n;
    const double m = p_->m;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double lam = p_->lam;
    const double Q = x_[0];
    const double p = x_[2];
    const double S = x_[5];
    const double F = u[0];
    const double V = u[1];
    const double T_e = u[2];
    /* co-states dU/dx */
    const double V_clamped = Q/C;
    const double v_load = p/(m + m_s/power_2(n));
    const double T = T_0*exp(S/c_0);
    /* driving forces */
    const double V_leads = -V_clamped + V;
    /* dissipative laws */
    const double i_leads = V_leads/R;
    /* result */
    out[0] = v_load*F;
    out[1] = i_leads*V;
    out[2] = lam*(T_e - T);
}

/* Hamiltonian U [J]. */
double amplified_stack_energy(const double *restrict x_,
                              const amplified_stack_parameters *restrict p_)
{
    const double k = p_->k;
    const double m_s = p_->m_s;
    const double C = p_->C;
    const double n = p_->n;
    const double m = p_->m;
    const double k_l = p_->k_l;
    const double g = p_->g;
    const double k_e = p_->k_e;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double Q = x_[0];
    const double q = x_[1];
    const double p = x_[2];
    const double x = x_[3];
    const double x_e = x_[4];
    const double S = x_[5];
    return power_2(Q)/(2.0*C)
        + k*power_2(q)/2.0
        + power_2(p)/(2.0*(m + m_s/power_2(n)))
        + k_l*power_2(x)/2.0
        + 0.5*(k_e*power_2(max(x_e - g, 0.0)))
        + T_0*c_0*exp(S/c_0);
}

/* Total entropy S [J/K]. */
double amplified_stack_entropy(const double *restrict x_,
                               const amplified_stack_parameters *restrict p_)
{
    (void)p_;
    const double S = x_[5];
    return S;
}

/* Temperature of each body [K]. */
void amplified_stack_temperatures(const double *restrict x_,
                                  const amplified_stack_parameters *restrict p_,
                                  double *restrict out)
{
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double S = x_[5];
    /* co-states dU/dx */
    const double T = T_0*exp(S/c_0);
    /* result */
    out[0] = T;
}

/* Power that each process turns into heat [W]; of a bank, one row per lane. */
void amplified_stack_heat(const double *restrict x_,
                          const double *restrict u,
                          const amplified_stack_parameters *restrict p_,
                          double *restrict out)
{
    const double m_s = p_->m_s;
    const double C = p_->C;
    const double R = p_->R;
    const double n = p_->n;
    const double m = p_->m;
    const double d = p_->d;
    const double g = p_->g;
    const double d_e = p_->d_e;
    const double Q = x_[0];
    const double p = x_[2];
    const double x_e = x_[4];
    const double V = u[1];
    /* co-states dU/dx */
    const double V_clamped = Q/C;
    const double v_load = p/(m + m_s/power_2(n));
    /* driving forces */
    const double V_leads = -V_clamped + V;
    /* dissipative laws */
    const double i_leads = V_leads/R;
    const double F_losses = d*v_load;
    const double F_bumper = d_e*max(x_e - g, 0.0)*v_load;
    /* result */
    out[0] = i_leads*V_leads;
    out[1] = F_losses*v_load;
    out[2] = F_bumper*v_load;
}

/*
 * Entropy production of each process [W/K], heat exchange with ambients not included; of a
 * bank, one row per lane.
 */
void amplified_stack_entropy_production(const double *restrict x_,
                                        const double *restrict u,
                                        const amplified_stack_parameters *restrict p_,
                                        double *restrict out)
{
    const double m_s = p_->m_s;
    const double C = p_->C;
    const double R = p_->R;
    const double n = p_->n;
    const double m = p_->m;
    const double d = p_->d;
    const double g = p_->g;
    const double d_e = p_->d_e;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double Q = x_[0];
    const double p = x_[2];
    const double x_e = x_[4];
    const double S = x_[5];
    const double V = u[1];
    /* co-states dU/dx */
    const double V_clamped = Q/C;
    const double v_load = p/(m + m_s/power_2(n));
    const double T = T_0*exp(S/c_0);
    /* driving forces */
    const double V_leads = -V_clamped + V;
    /* dissipative laws */
    const double i_leads = V_leads/R;
    const double F_losses = d*v_load;
    const double F_bumper = d_e*max(x_e - g, 0.0)*v_load;
    /* result */
    out[0] = i_leads*V_leads/T;
    out[1] = F_losses*v_load/T;
    out[2] = F_bumper*v_load/T;
}

/* Effort, flow, power, energy and heat of elements; of a bank, one row per lane. */
void amplified_stack_elements(const double *restrict x_,
                              const double *restrict u,
                              const amplified_stack_parameters *restrict p_,
                              double *restrict out)
{
    const double k = p_->k;
    const double m_s = p_->m_s;
    const double a = p_->a;
    const double C = p_->C;
    const double R = p_->R;
    const double n = p_->n;
    const double m = p_->m;
    const double k_l = p_->k_l;
    const double d = p_->d;
    const double g = p_->g;
    const double k_e = p_->k_e;
    const double d_e = p_->d_e;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double lam = p_->lam;
    const double Q = x_[0];
    const double q = x_[1];
    const double p = x_[2];
    const double x = x_[3];
    const double x_e = x_[4];
    const double S = x_[5];
    const double F = u[0];
    const double V = u[1];
    const double T_e = u[2];
    /* co-states dU/dx */
    const double V_clamped = Q/C;
    const double F_stack = k*q;
    const double v_load = p/(m + m_s/power_2(n));
    const double F_spring = k_l*x;
    const double F_end_stop = k_e*max(x_e - g, 0.0);
    const double T = T_0*exp(S/c_0);
    /* transducer ratios */
    const double alpha_ceramic = a;
    const double n_lever = n;
    /* driving forces */
    const double V_leads = -V_clamped + V;
    /* dissipative laws */
    const double i_leads = V_leads/R;
    const double F_losses = d*v_load;
    const double F_bumper = d_e*max(x_e - g, 0.0)*v_load;
    /* heats */
    const double heat_leads = i_leads*V_leads;
    const double heat_losses = F_losses*v_load;
    const double heat_bumper = F_bumper*v_load;
    /* rates */
    const double rate_Q = i_leads - alpha_ceramic/n_lever*v_load;
    const double rate_q = v_load/n_lever;
    const double rate_p = alpha_ceramic/n_lever*V_clamped
        - F_stack/n_lever
        - F_spring
        - F_end_stop
        - F_losses
        - F_bumper
        + F;
    const double rate_S = (heat_leads + heat_losses + heat_bumper)/T + lam*(T_e/T - 1.0);
    /* result */
    out[0] = V;
    out[1] = -i_leads;
    out[2] = -i_leads*V;
    out[3] = V_leads;
    out[4] = i_leads;
    out[5] = i_leads*V_leads;
    out[6] = i_leads*V_leads;
    out[7] = V_clamped;
    out[8] = rate_Q;
    out[9] = V_clamped*rate_Q;
    out[10] = power_2(Q)/(2.0*C);
    out[11] = V_clamped;
    out[12] = alpha_ceramic*v_load/n_lever;
    out[13] = -alpha_ceramic*V_clamped;
    out[14] = v_load/n_lever;
    out[15] = V_clamped*alpha_ceramic*v_load/n_lever;
    out[16] = F_stack;
    out[17] = rate_q;
    out[18] = F_stack*rate_q;
    out[19] = k*power_2(q)/2.0;
    out[20] = m/(m + m_s/power_2(n))*rate_p;
    out[21] = v_load;
    out[22] = m/(m + m_s/power_2(n))*rate_p*v_load;
    out[23] = 0.5*(m*power_2(v_load));
    out[24] = m_s/n/(m + m_s/power_2(n))*rate_p;
    out[25] = v_load/n;
    out[26] = m_s/n/(m + m_s/power_2(n))*rate_p*v_load/n;
    out[27] = 0.5*(m_s*power_2(v_load/n));
    out[28] = -alpha_ceramic/n_lever*V_clamped
        + F_stack/n_lever
        + m_s/n/(m + m_s/power_2(n))*rate_p/n_lever;
    out[29] = n_lever*v_load/n_lever;
    out[30] = -n_lever*(-alpha_ceramic/n_lever*V_clamped + F_stack/n_lever + m_s/n/(m + m_s/power_2(n))*rate_p/n_lever);
    out[31] = v_load/n_lever;
    out[32] = n_lever*v_load/n_lever*(-alpha_ceramic/n_lever*V_clamped + F_stack/n_lever + m_s/n/(m + m_s/power_2(n))*rate_p/n_lever);
    out[33] = F_spring;
    out[34] = v_load;
    out[35] = F_spring*v_load;
    out[36] = k_l*power_2(x)/2.0;
    out[37] = F_losses;
    out[38] = v_load;
    out[39] = F_losses*v_load;
    out[40] = F_losses*v_load;
    out[41] = F_end_stop;
    out[42] = v_load;
    out[43] = F_end_stop*v_load;
    out[44] = 0.5*(k_e*power_2(max(x_e - g, 0.0)));
    out[45] = F_bumper;
    out[46] = v_load;
    out[47] = F_bumper*v_load;
    out[48] = F_bumper*v_load;
    out[49] = -F;
    out[50] = v_load;
    out[51] = -v_load*F;
    out[52] = T;
    out[53] = rate_S;
    out[54] = T*rate_S;
    out[55] = T_0*c_0*exp(S/c_0);
    out[56] = T;
    out[57] = -lam*(T_e/T - 1.0);
    out[58] = -lam*(T_e - T);
}

/* Jacobian of rhs, n x n, row after row: d rhs[i]/d x[j] at out[i*n + j]. */
void amplified_stack_jacobian(const double *restrict x_,
                              const double *restrict u,
                              const amplified_stack_parameters *restrict p_,
                              double *restrict out)
{
    const long n_ = 6;
    const double k = p_->k;
    const double m_s = p_->m_s;
    const double a = p_->a;
    const double C = p_->C;
    const double R = p_->R;
    const double n = p_->n;
    const double m = p_->m;
    const double k_l = p_->k_l;
    const double d = p_->d;
    const double g = p_->g;
    const double k_e = p_->k_e;
    const double d_e = p_->d_e;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double lam = p_->lam;
    const double Q = x_[0];
    const double p = x_[2];
    const double x_e = x_[4];
    const double S = x_[5];
    const double V = u[1];
    const double T_e = u[2];
    for (long j = 0; j < n_*n_; ++j) {
        out[j] = 0.0;
    }
    /* co-states dU/dx */
    const double V_clamped = Q/C;
    const double v_load = p/(m + m_s/power_2(n));
    const double T = T_0*exp(S/c_0);
    /* transducer ratios */
    const double alpha_ceramic = a;
    const double n_lever = n;
    /* driving forces */
    const double V_leads = -V_clamped + V;
    /* dissipative laws */
    const double i_leads = V_leads/R;
    const double F_losses = d*v_load;
    const double F_bumper = d_e*max(x_e - g, 0.0)*v_load;
    /* heats */
    const double heat_leads = i_leads*V_leads;
    const double heat_losses = F_losses*v_load;
    const double heat_bumper = F_bumper*v_load;
    /* derivatives */
    const double di_leads_dQ = -1.0/R/C;
    const double dheat_leads_dQ = V_leads*di_leads_dQ - i_leads/C;
    const double dv_load_dp = 1.0/(m + m_s/power_2(n));
    const double dF_losses_dp = d*dv_load_dp;
    const double dF_bumper_dp = d_e*max(x_e - g, 0.0)*dv_load_dp;
    const double dheat_losses_dp = v_load*dF_losses_dp + F_losses*dv_load_dp;
    const double dheat_bumper_dp = v_load*dF_bumper_dp + F_bumper*dv_load_dp;
    const double dF_end_stop_dx_e = pick(x_e - g >= 0.0, k_e, 0.0);
    const double dF_bumper_dx_e = pick(x_e - g >= 0.0, d_e, 0.0)*v_load;
    const double dheat_bumper_dx_e = v_load*dF_bumper_dx_e;
    const double dT_dS = T/c_0;
    /* result */
    out[0] = di_leads_dQ;
    out[2] = -alpha_ceramic/n_lever*dv_load_dp;
    out[n_ + 2] = dv_load_dp/n_lever;
    out[2*n_ + 0] = alpha_ceramic/n_lever/C;
    out[2*n_ + 1] = -k/n_lever;
    out[2*n_ + 2] = -dF_losses_dp - dF_bumper_dp;
    out[2*n_ + 3] = -k_l;
    out[2*n_ + 4] = -dF_end_stop_dx_e - dF_bumper_dx_e;
    out[3*n_ + 2] = dv_load_dp;
    out[4*n_ + 2] = dv_load_dp;
    out[5*n_ + 0] = dheat_leads_dQ/T;
    out[5*n_ + 2] = dheat_losses_dp/T + dheat_bumper_dp/T;
    out[5*n_ + 4] = dheat_bumper_dx_e/T;
    out[5*n_ + 5] = (-(heat_leads + heat_losses + heat_bumper)/power_2(T) - lam*T_e/power_2(T))*dT_dS;
}

/* Margin by which each condition of the domain holds; of a bank, the least one. */
void amplified_stack_margins(const double *restrict x_,
                             const double *restrict u,
                             const amplified_stack_parameters *restrict p_,
                             double *restrict out)
{
    (void)x_;
    const double k = p_->k;
    const double m_s = p_->m_s;
    const double C = p_->C;
    const double R = p_->R;
    const double n = p_->n;
    const double m = p_->m;
    const double k_l = p_->k_l;
    const double d = p_->d;
    const double k_e = p_->k_e;
    const double d_e = p_->d_e;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double lam = p_->lam;
    const double T_e = u[2];
    out[0] = n;
    out[1] = R;
    out[2] = d;
    out[3] = k_e;
    out[4] = d_e;
    out[5] = lam;
    out[6] = T_e;
    out[7] = C;
    out[8] = k;
    out[9] = m;
    out[10] = m_s;
    out[11] = k_l;
    out[12] = T_0;
    out[13] = c_0;
}
