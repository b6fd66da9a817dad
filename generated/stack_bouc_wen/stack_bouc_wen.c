/*
 * Piezoelectric stack with a Bouc-Wen hysteresis of its voltage: irreversible port-Hamiltonian system.
 *
 * Source:  Goldfarb, Celanovic (1997), IEEE Control Systems 17 (3), 69-79; Low, Guo (1995), J. Microelectromech. Syst. 4 (4), 230-237; PiezoDrive SA050536
 * Model:   stack_bouc_wen, spec sha256 cb2f5eb9e9a940796689ce0b466f2aabc3f9c62f14ebd031e4298cc6395703ff
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, continuous, rate-independent, sigma, exergy, environment, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (q, p, Q, Q_h, S)
 * u = (F_ext, V_in, T_e)
 * p_ = pointer to stack_bouc_wen_parameters; the underscore tells it from p, a name of the model
 */
#include "stack_bouc_wen.h"

#include <math.h>

static double pick(int condition, double a, double b)
{
    return condition ? a : b;
}

static double sign(double z)
{
    return z > 0.0 ? 1.0 : z < 0.0 ? -1.0 : z;
}

static double power_2(double z)
{
    return z*z;
}

/* Number of states n. */
long stack_bouc_wen_states(const stack_bouc_wen_parameters *restrict p_)
{
    (void)p_;
    return 5;
}

/* Number of processes, which produce entropy; of a bank, one per lane. */
long stack_bouc_wen_processes(const stack_bouc_wen_parameters *restrict p_)
{
    (void)p_;
    return 3;
}

/* State at t = 0 [SI], for the inputs u at t = 0. */
void stack_bouc_wen_initial_state(const double *restrict u,
                                  const stack_bouc_wen_parameters *restrict p_,
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
void stack_bouc_wen_rhs(const double *restrict x,
                        const double *restrict u,
                        const stack_bouc_wen_parameters *restrict p_,
                        double *restrict out)
{
    const double m = p_->m;
    const double k = p_->k;
    const double d = p_->d;
    const double a = p_->a;
    const double C = p_->C;
    const double C_h = p_->C_h;
    const double V_h = p_->V_h;
    const double beta = p_->beta;
    const double gam = p_->gam;
    const double n = p_->n;
    const double R = p_->R;
    const double c_0 = p_->c_0;
    const double lam = p_->lam;
    const double T_0 = p_->T_0;
    const double q = x[0];
    const double p = x[1];
    const double Q = x[2];
    const double Q_h = x[3];
    const double S = x[4];
    const double F_ext = u[0];
    const double V_in = u[1];
    const double T_e = u[2];
    /* co-states dU/dx */
    const double F_spring = k*q;
    const double v_mass = p/m;
    const double V_ceramic = Q/C;
    const double V_hysteresis = Q_h/C_h;
    const double T = T_0*exp(S/c_0);
    /* transducer ratios */
    const double alpha_transducer = a;
    /* dissipative laws */
    const double F_damper = d*v_mass;
    /* driving forces */
    const double V_leads = -V_ceramic - V_hysteresis + V_in;
    /* dissipative laws */
    const double i_leads = V_leads/R;
    const double slip_hysteresis = (beta*fabs(i_leads)*sign(V_hysteresis) + gam*i_leads)*pow(fabs(V_hysteresis)/V_h, n);
    /* heats */
    const double heat_damper = F_damper*v_mass;
    const double heat_hysteresis = slip_hysteresis*V_hysteresis;
    const double heat_leads = i_leads*V_leads;
    /* result */
    out[0] = v_mass;
    out[1] = alpha_transducer*V_ceramic - F_spring - F_damper + F_ext;
    out[2] = i_leads - alpha_transducer*v_mass;
    out[3] = i_leads - slip_hysteresis;
    out[4] = (heat_damper + heat_hysteresis + heat_leads)/T + lam*(T_e/T - 1.0);
}

/* Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient. */
void stack_bouc_wen_outputs(const double *restrict x,
                            const double *restrict u,
                            const stack_bouc_wen_parameters *restrict p_,
                            double *restrict out)
{
    const double m = p_->m;
    const double C = p_->C;
    const double C_h = p_->C_h;
    const double R = p_->R;
    const double c_0 = p_->c_0;
    const double T_0 = p_->T_0;
    const double p = x[1];
    const double Q = x[2];
    const double Q_h = x[3];
    const double S = x[4];
    const double V_in = u[1];
    /* co-states dU/dx */
    const double v_mass = p/m;
    const double V_ceramic = Q/C;
    const double V_hysteresis = Q_h/C_h;
    const double T = T_0*exp(S/c_0);
    /* driving forces */
    const double V_leads = -V_ceramic - V_hysteresis + V_in;
    /* dissipative laws */
    const double i_leads = V_leads/R;
    /* result */
    out[0] = v_mass;
    out[1] = i_leads;
    out[2] = T;
}

/* Power supplied through each port [W]; the sum is dU/dt. */
void stack_bouc_wen_supply(const double *restrict x,
                           const double *restrict u,
                           const stack_bouc_wen_parameters *restrict p_,
                           double *restrict out)
{
    const double m = p_->m;
    const double C = p_->C;
    const double C_h = p_->C_h;
    const double R = p_->R;
    const double c_0 = p_->c_0;
    const double lam = p_->lam;
    const double T_0 = p_->T_0;
    const double p = x[1];
    const double Q = x[2];
    const double Q_h = x[3];
    const double S = x[4];
    const double F_ext = u[0];
    const double V_in = u[1];
    const double T_e = u[2];
    /* co-states dU/dx */
    const double v_mass = p/m;
    const double V_ceramic = Q/C;
    const double V_hysteresis = Q_h/C_h;
    const double T = T_0*exp(S/c_0);
    /* driving forces */
    const double V_leads = -V_ceramic - V_hysteresis + V_in;
    /* dissipative laws */
    const double i_leads = V_leads/R;
    /* result */
    out[0] = v_mass*F_ext;
    out[1] = i_leads*V_in;
    out[2] = lam*(T_e - T);
}

/* Hamiltonian U [J]. */
double stack_bouc_wen_energy(const double *restrict x,
                             const stack_bouc_wen_parameters *restrict p_)
{
    const double m = p_->m;
    const double k = p_->k;
    const double C = p_->C;
    const double C_h = p_->C_h;
    const double c_0 = p_->c_0;
    const double T_0 = p_->T_0;
    const double q = x[0];
    const double p = x[1];
    const double Q = x[2];
    const double Q_h = x[3];
    const double S = x[4];
    return k*power_2(q)/2.0
        + power_2(p)/(2.0*m)
        + power_2(Q)/(2.0*C)
        + power_2(Q_h)/(2.0*C_h)
        + T_0*c_0*exp(S/c_0);
}

/* Total entropy S [J/K]. */
double stack_bouc_wen_entropy(const double *restrict x,
                              const stack_bouc_wen_parameters *restrict p_)
{
    (void)p_;
    const double S = x[4];
    return S;
}

/* Temperature of each body [K]. */
void stack_bouc_wen_temperatures(const double *restrict x,
                                 const stack_bouc_wen_parameters *restrict p_,
                                 double *restrict out)
{
    const double c_0 = p_->c_0;
    const double T_0 = p_->T_0;
    const double S = x[4];
    /* co-states dU/dx */
    const double T = T_0*exp(S/c_0);
    /* result */
    out[0] = T;
}

/* Power that each process turns into heat [W]; of a bank, one row per lane. */
void stack_bouc_wen_heat(const double *restrict x,
                         const double *restrict u,
                         const stack_bouc_wen_parameters *restrict p_,
                         double *restrict out)
{
    const double m = p_->m;
    const double d = p_->d;
    const double C = p_->C;
    const double C_h = p_->C_h;
    const double V_h = p_->V_h;
    const double beta = p_->beta;
    const double gam = p_->gam;
    const double n = p_->n;
    const double R = p_->R;
    const double p = x[1];
    const double Q = x[2];
    const double Q_h = x[3];
    const double V_in = u[1];
    /* co-states dU/dx */
    const double v_mass = p/m;
    const double V_ceramic = Q/C;
    const double V_hysteresis = Q_h/C_h;
    /* dissipative laws */
    const double F_damper = d*v_mass;
    /* driving forces */
    const double V_leads = -V_ceramic - V_hysteresis + V_in;
    /* dissipative laws */
    const double i_leads = V_leads/R;
    const double slip_hysteresis = (beta*fabs(i_leads)*sign(V_hysteresis) + gam*i_leads)*pow(fabs(V_hysteresis)/V_h, n);
    /* result */
    out[0] = F_damper*v_mass;
    out[1] = slip_hysteresis*V_hysteresis;
    out[2] = i_leads*V_leads;
}

/*
 * Entropy production of each process [W/K], heat exchange with ambients not included; of a
 * bank, one row per lane.
 */
void stack_bouc_wen_entropy_production(const double *restrict x,
                                       const double *restrict u,
                                       const stack_bouc_wen_parameters *restrict p_,
                                       double *restrict out)
{
    const double m = p_->m;
    const double d = p_->d;
    const double C = p_->C;
    const double C_h = p_->C_h;
    const double V_h = p_->V_h;
    const double beta = p_->beta;
    const double gam = p_->gam;
    const double n = p_->n;
    const double R = p_->R;
    const double c_0 = p_->c_0;
    const double T_0 = p_->T_0;
    const double p = x[1];
    const double Q = x[2];
    const double Q_h = x[3];
    const double S = x[4];
    const double V_in = u[1];
    /* co-states dU/dx */
    const double v_mass = p/m;
    const double V_ceramic = Q/C;
    const double V_hysteresis = Q_h/C_h;
    const double T = T_0*exp(S/c_0);
    /* dissipative laws */
    const double F_damper = d*v_mass;
    /* driving forces */
    const double V_leads = -V_ceramic - V_hysteresis + V_in;
    /* dissipative laws */
    const double i_leads = V_leads/R;
    const double slip_hysteresis = (beta*fabs(i_leads)*sign(V_hysteresis) + gam*i_leads)*pow(fabs(V_hysteresis)/V_h, n);
    /* result */
    out[0] = F_damper*v_mass/T;
    out[1] = slip_hysteresis*V_hysteresis/T;
    out[2] = i_leads*V_leads/T;
}

/* Effort, flow, power, energy and heat of elements; of a bank, one row per lane. */
void stack_bouc_wen_elements(const double *restrict x,
                             const double *restrict u,
                             const stack_bouc_wen_parameters *restrict p_,
                             double *restrict out)
{
    const double m = p_->m;
    const double k = p_->k;
    const double d = p_->d;
    const double a = p_->a;
    const double C = p_->C;
    const double C_h = p_->C_h;
    const double V_h = p_->V_h;
    const double beta = p_->beta;
    const double gam = p_->gam;
    const double n = p_->n;
    const double R = p_->R;
    const double c_0 = p_->c_0;
    const double lam = p_->lam;
    const double T_0 = p_->T_0;
    const double q = x[0];
    const double p = x[1];
    const double Q = x[2];
    const double Q_h = x[3];
    const double S = x[4];
    const double F_ext = u[0];
    const double V_in = u[1];
    const double T_e = u[2];
    /* co-states dU/dx */
    const double F_spring = k*q;
    const double v_mass = p/m;
    const double V_ceramic = Q/C;
    const double V_hysteresis = Q_h/C_h;
    const double T = T_0*exp(S/c_0);
    /* transducer ratios */
    const double alpha_transducer = a;
    /* dissipative laws */
    const double F_damper = d*v_mass;
    /* driving forces */
    const double V_leads = -V_ceramic - V_hysteresis + V_in;
    /* dissipative laws */
    const double i_leads = V_leads/R;
    const double slip_hysteresis = (beta*fabs(i_leads)*sign(V_hysteresis) + gam*i_leads)*pow(fabs(V_hysteresis)/V_h, n);
    /* heats */
    const double heat_damper = F_damper*v_mass;
    const double heat_hysteresis = slip_hysteresis*V_hysteresis;
    const double heat_leads = i_leads*V_leads;
    /* rates */
    const double rate_p = alpha_transducer*V_ceramic - F_spring - F_damper + F_ext;
    const double rate_Q = i_leads - alpha_transducer*v_mass;
    const double rate_Q_h = i_leads - slip_hysteresis;
    const double rate_S = (heat_damper + heat_hysteresis + heat_leads)/T
        + lam*(T_e/T - 1.0);
    /* result */
    out[0] = F_spring;
    out[1] = v_mass;
    out[2] = F_spring*v_mass;
    out[3] = k*power_2(q)/2.0;
    out[4] = rate_p;
    out[5] = v_mass;
    out[6] = rate_p*v_mass;
    out[7] = power_2(p)/(2.0*m);
    out[8] = F_damper;
    out[9] = v_mass;
    out[10] = F_damper*v_mass;
    out[11] = F_damper*v_mass;
    out[12] = V_ceramic;
    out[13] = rate_Q;
    out[14] = V_ceramic*rate_Q;
    out[15] = power_2(Q)/(2.0*C);
    out[16] = V_hysteresis;
    out[17] = rate_Q_h + slip_hysteresis;
    out[18] = V_hysteresis*(rate_Q_h + slip_hysteresis);
    out[19] = power_2(Q_h)/(2.0*C_h);
    out[20] = slip_hysteresis*V_hysteresis;
    out[21] = V_ceramic;
    out[22] = alpha_transducer*v_mass;
    out[23] = -alpha_transducer*V_ceramic;
    out[24] = v_mass;
    out[25] = V_ceramic*alpha_transducer*v_mass;
    out[26] = V_leads;
    out[27] = i_leads;
    out[28] = i_leads*V_leads;
    out[29] = i_leads*V_leads;
    out[30] = T;
    out[31] = rate_S;
    out[32] = T*rate_S;
    out[33] = T_0*c_0*exp(S/c_0);
    out[34] = T;
    out[35] = -lam*(T_e/T - 1.0);
    out[36] = -lam*(T_e - T);
    out[37] = -F_ext;
    out[38] = v_mass;
    out[39] = -v_mass*F_ext;
    out[40] = V_in;
    out[41] = -i_leads;
    out[42] = -i_leads*V_in;
}

/* Jacobian of rhs, n x n, row after row: d rhs[i]/d x[j] at out[i*n + j]. */
void stack_bouc_wen_jacobian(const double *restrict x,
                             const double *restrict u,
                             const stack_bouc_wen_parameters *restrict p_,
                             double *restrict out)
{
    const long n_ = 5;
    const double m = p_->m;
    const double k = p_->k;
    const double d = p_->d;
    const double a = p_->a;
    const double C = p_->C;
    const double C_h = p_->C_h;
    const double V_h = p_->V_h;
    const double beta = p_->beta;
    const double gam = p_->gam;
    const double n = p_->n;
    const double R = p_->R;
    const double c_0 = p_->c_0;
    const double lam = p_->lam;
    const double T_0 = p_->T_0;
    const double p = x[1];
    const double Q = x[2];
    const double Q_h = x[3];
    const double S = x[4];
    const double V_in = u[1];
    const double T_e = u[2];
    for (long j = 0; j < n_*n_; ++j) {
        out[j] = 0.0;
    }
    /* co-states dU/dx */
    const double v_mass = p/m;
    const double V_ceramic = Q/C;
    const double V_hysteresis = Q_h/C_h;
    const double T = T_0*exp(S/c_0);
    /* transducer ratios */
    const double alpha_transducer = a;
    /* dissipative laws */
    const double F_damper = d*v_mass;
    /* driving forces */
    const double V_leads = -V_ceramic - V_hysteresis + V_in;
    /* dissipative laws */
    const double i_leads = V_leads/R;
    const double slip_hysteresis = (beta*fabs(i_leads)*sign(V_hysteresis) + gam*i_leads)*pow(fabs(V_hysteresis)/V_h, n);
    /* heats */
    const double heat_damper = F_damper*v_mass;
    const double heat_hysteresis = slip_hysteresis*V_hysteresis;
    const double heat_leads = i_leads*V_leads;
    /* derivatives */
    const double dF_damper_dp = d/m;
    const double dheat_damper_dp = v_mass*dF_damper_dp + F_damper/m;
    const double di_leads_dQ = -1.0/R/C;
    const double dslip_hysteresis_dQ = (beta*sign(i_leads)*sign(V_hysteresis) + gam)*pow(fabs(V_hysteresis)/V_h, n)*di_leads_dQ;
    const double dheat_hysteresis_dQ = V_hysteresis*dslip_hysteresis_dQ;
    const double dheat_leads_dQ = V_leads*di_leads_dQ - i_leads/C;
    const double di_leads_dQ_h = -1.0/R/C_h;
    const double dslip_hysteresis_dQ_h = (beta*sign(i_leads)*sign(V_hysteresis) + gam)*pow(fabs(V_hysteresis)/V_h, n)*di_leads_dQ_h
        + (beta*fabs(i_leads)*sign(V_hysteresis) + gam*i_leads)*n*pow(fabs(V_hysteresis)/V_h, n)/pick(fabs(V_hysteresis)/V_h > 0.0, fabs(V_hysteresis)/V_h, 1.0)*sign(V_hysteresis)/V_h/C_h;
    const double dheat_hysteresis_dQ_h = V_hysteresis*dslip_hysteresis_dQ_h
        + slip_hysteresis/C_h;
    const double dheat_leads_dQ_h = V_leads*di_leads_dQ_h - i_leads/C_h;
    const double dT_dS = T/c_0;
    /* result */
    out[1] = 1.0/m;
    out[n_ + 0] = -k;
    out[n_ + 1] = -dF_damper_dp;
    out[n_ + 2] = alpha_transducer/C;
    out[2*n_ + 1] = -alpha_transducer/m;
    out[2*n_ + 2] = di_leads_dQ;
    out[2*n_ + 3] = di_leads_dQ_h;
    out[3*n_ + 2] = di_leads_dQ - dslip_hysteresis_dQ;
    out[3*n_ + 3] = di_leads_dQ_h - dslip_hysteresis_dQ_h;
    out[4*n_ + 1] = dheat_damper_dp/T;
    out[4*n_ + 2] = dheat_hysteresis_dQ/T + dheat_leads_dQ/T;
    out[4*n_ + 3] = dheat_hysteresis_dQ_h/T + dheat_leads_dQ_h/T;
    out[4*n_ + 4] = (-(heat_damper + heat_hysteresis + heat_leads)/power_2(T) - lam*T_e/power_2(T))*dT_dS;
}

/* Margin by which each condition of the domain holds; of a bank, the least one. */
void stack_bouc_wen_margins(const double *restrict x,
                            const double *restrict u,
                            const stack_bouc_wen_parameters *restrict p_,
                            double *restrict out)
{
    (void)x;
    const double m = p_->m;
    const double k = p_->k;
    const double d = p_->d;
    const double C = p_->C;
    const double C_h = p_->C_h;
    const double V_h = p_->V_h;
    const double beta = p_->beta;
    const double gam = p_->gam;
    const double n = p_->n;
    const double R = p_->R;
    const double c_0 = p_->c_0;
    const double lam = p_->lam;
    const double T_0 = p_->T_0;
    const double T_e = u[2];
    out[0] = beta - fabs(gam);
    out[1] = n;
    out[2] = V_h;
    out[3] = d;
    out[4] = R;
    out[5] = lam;
    out[6] = T_e;
    out[7] = k;
    out[8] = m;
    out[9] = C;
    out[10] = C_h;
    out[11] = T_0;
    out[12] = c_0;
}
