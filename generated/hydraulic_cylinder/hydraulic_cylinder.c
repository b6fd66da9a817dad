/*
 * Hydraulic cylinder behind an orifice, with a load and an end stop: irreversible port-Hamiltonian system.
 *
 * Source:  Merritt (1967), Hydraulic Control Systems, ch. 3 and 6
 * Model:   hydraulic_cylinder, spec sha256 9f77f306d723282ed74a083c6c8af89eb009af63f004a1308f102f81527e5387
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, continuous, sigma, exergy, environment, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (V, p, q, S)
 * u = (p_in, F, T_e)
 * p_ = pointer to hydraulic_cylinder_parameters; the underscore tells it from p, a name of the model
 */
#include "hydraulic_cylinder.h"

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
long hydraulic_cylinder_states(const hydraulic_cylinder_parameters *restrict p_)
{
    (void)p_;
    return 4;
}

/* Number of processes, which produce entropy; of a bank, one per lane. */
long hydraulic_cylinder_processes(const hydraulic_cylinder_parameters *restrict p_)
{
    (void)p_;
    return 2;
}

/* State at t = 0 [SI], for the inputs u at t = 0. */
void hydraulic_cylinder_initial_state(const double *restrict u,
                                      const hydraulic_cylinder_parameters *restrict p_,
                                      double *restrict out)
{
    (void)u;
    (void)p_;
    out[0] = 0.0;
    out[1] = 0.0;
    out[2] = 0.0;
    out[3] = 0.0;
}

/* Rates dx/dt, the rows of J_ir dU/dx + g u. */
void hydraulic_cylinder_rhs(const double *restrict x,
                            const double *restrict u,
                            const hydraulic_cylinder_parameters *restrict p_,
                            double *restrict out)
{
    const double C_d = p_->C_d;
    const double a = p_->a;
    const double rho = p_->rho;
    const double p_t = p_->p_t;
    const double A = p_->A;
    const double C_h = p_->C_h;
    const double m = p_->m;
    const double d = p_->d;
    const double k_s = p_->k_s;
    const double x_s = p_->x_s;
    const double c = p_->c;
    const double lam = p_->lam;
    const double T_0 = p_->T_0;
    const double V = x[0];
    const double p = x[1];
    const double q = x[2];
    const double S = x[3];
    const double p_in = u[0];
    const double F = u[1];
    const double T_e = u[2];
    /* co-states dU/dx */
    const double dp_chamber = V/C_h;
    const double v_load = p/m;
    const double F_stop = k_s*max(q - x_s, 0.0);
    const double T = T_0*exp(S/c);
    /* transducer ratios */
    const double alpha_cylinder = A;
    /* driving forces */
    const double dp_orifice = -dp_chamber + p_in;
    /* dissipative laws */
    const double flow_orifice = C_d*a*sqrt(2.0/rho)*dp_orifice/pow(power_2(dp_orifice) + power_2(p_t), 0.25);
    const double F_friction = d*v_load;
    /* heats */
    const double heat_orifice = flow_orifice*dp_orifice;
    const double heat_friction = F_friction*v_load;
    /* result */
    out[0] = flow_orifice - alpha_cylinder*v_load;
    out[1] = alpha_cylinder*dp_chamber - F_stop - F_friction + F;
    out[2] = v_load;
    out[3] = (heat_orifice + heat_friction)/T + lam*(T_e/T - 1.0);
}

/* Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient. */
void hydraulic_cylinder_outputs(const double *restrict x,
                                const double *restrict u,
                                const hydraulic_cylinder_parameters *restrict p_,
                                double *restrict out)
{
    const double C_d = p_->C_d;
    const double a = p_->a;
    const double rho = p_->rho;
    const double p_t = p_->p_t;
    const double C_h = p_->C_h;
    const double m = p_->m;
    const double c = p_->c;
    const double T_0 = p_->T_0;
    const double V = x[0];
    const double p = x[1];
    const double S = x[3];
    const double p_in = u[0];
    /* co-states dU/dx */
    const double dp_chamber = V/C_h;
    const double v_load = p/m;
    const double T = T_0*exp(S/c);
    /* driving forces */
    const double dp_orifice = -dp_chamber + p_in;
    /* dissipative laws */
    const double flow_orifice = C_d*a*sqrt(2.0/rho)*dp_orifice/pow(power_2(dp_orifice) + power_2(p_t), 0.25);
    /* result */
    out[0] = flow_orifice;
    out[1] = v_load;
    out[2] = T;
}

/* Power supplied through each port [W]; the sum is dU/dt. */
void hydraulic_cylinder_supply(const double *restrict x,
                               const double *restrict u,
                               const hydraulic_cylinder_parameters *restrict p_,
                               double *restrict out)
{
    const double C_d = p_->C_d;
    const double a = p_->a;
    const double rho = p_->rho;
    const double p_t = p_->p_t;
    const double C_h = p_->C_h;
    const double m = p_->m;
    const double c = p_->c;
    const double lam = p_->lam;
    const double T_0 = p_->T_0;
    const double V = x[0];
    const double p = x[1];
    const double S = x[3];
    const double p_in = u[0];
    const double F = u[1];
    const double T_e = u[2];
    /* co-states dU/dx */
    const double dp_chamber = V/C_h;
    const double v_load = p/m;
    const double T = T_0*exp(S/c);
    /* driving forces */
    const double dp_orifice = -dp_chamber + p_in;
    /* dissipative laws */
    const double flow_orifice = C_d*a*sqrt(2.0/rho)*dp_orifice/pow(power_2(dp_orifice) + power_2(p_t), 0.25);
    /* result */
    out[0] = flow_orifice*p_in;
    out[1] = v_load*F;
    out[2] = lam*(T_e - T);
}

/* Hamiltonian U [J]. */
double hydraulic_cylinder_energy(const double *restrict x,
                                 const hydraulic_cylinder_parameters *restrict p_)
{
    const double C_h = p_->C_h;
    const double m = p_->m;
    const double k_s = p_->k_s;
    const double x_s = p_->x_s;
    const double c = p_->c;
    const double T_0 = p_->T_0;
    const double V = x[0];
    const double p = x[1];
    const double q = x[2];
    const double S = x[3];
    return power_2(V)/(2.0*C_h)
        + power_2(p)/(2.0*m)
        + 0.5*(k_s*power_2(max(q - x_s, 0.0)))
        + T_0*c*exp(S/c);
}

/* Total entropy S [J/K]. */
double hydraulic_cylinder_entropy(const double *restrict x,
                                  const hydraulic_cylinder_parameters *restrict p_)
{
    (void)p_;
    const double S = x[3];
    return S;
}

/* Temperature of each body [K]. */
void hydraulic_cylinder_temperatures(const double *restrict x,
                                     const hydraulic_cylinder_parameters *restrict p_,
                                     double *restrict out)
{
    const double c = p_->c;
    const double T_0 = p_->T_0;
    const double S = x[3];
    /* co-states dU/dx */
    const double T = T_0*exp(S/c);
    /* result */
    out[0] = T;
}

/* Power that each process turns into heat [W]; of a bank, one row per lane. */
void hydraulic_cylinder_heat(const double *restrict x,
                             const double *restrict u,
                             const hydraulic_cylinder_parameters *restrict p_,
                             double *restrict out)
{
    const double C_d = p_->C_d;
    const double a = p_->a;
    const double rho = p_->rho;
    const double p_t = p_->p_t;
    const double C_h = p_->C_h;
    const double m = p_->m;
    const double d = p_->d;
    const double V = x[0];
    const double p = x[1];
    const double p_in = u[0];
    /* co-states dU/dx */
    const double dp_chamber = V/C_h;
    const double v_load = p/m;
    /* driving forces */
    const double dp_orifice = -dp_chamber + p_in;
    /* dissipative laws */
    const double flow_orifice = C_d*a*sqrt(2.0/rho)*dp_orifice/pow(power_2(dp_orifice) + power_2(p_t), 0.25);
    const double F_friction = d*v_load;
    /* result */
    out[0] = flow_orifice*dp_orifice;
    out[1] = F_friction*v_load;
}

/*
 * Entropy production of each process [W/K], heat exchange with ambients not included; of a
 * bank, one row per lane.
 */
void hydraulic_cylinder_entropy_production(const double *restrict x,
                                           const double *restrict u,
                                           const hydraulic_cylinder_parameters *restrict p_,
                                           double *restrict out)
{
    const double C_d = p_->C_d;
    const double a = p_->a;
    const double rho = p_->rho;
    const double p_t = p_->p_t;
    const double C_h = p_->C_h;
    const double m = p_->m;
    const double d = p_->d;
    const double c = p_->c;
    const double T_0 = p_->T_0;
    const double V = x[0];
    const double p = x[1];
    const double S = x[3];
    const double p_in = u[0];
    /* co-states dU/dx */
    const double dp_chamber = V/C_h;
    const double v_load = p/m;
    const double T = T_0*exp(S/c);
    /* driving forces */
    const double dp_orifice = -dp_chamber + p_in;
    /* dissipative laws */
    const double flow_orifice = C_d*a*sqrt(2.0/rho)*dp_orifice/pow(power_2(dp_orifice) + power_2(p_t), 0.25);
    const double F_friction = d*v_load;
    /* result */
    out[0] = flow_orifice*dp_orifice/T;
    out[1] = F_friction*v_load/T;
}

/* Effort, flow, power, energy and heat of elements; of a bank, one row per lane. */
void hydraulic_cylinder_elements(const double *restrict x,
                                 const double *restrict u,
                                 const hydraulic_cylinder_parameters *restrict p_,
                                 double *restrict out)
{
    const double C_d = p_->C_d;
    const double a = p_->a;
    const double rho = p_->rho;
    const double p_t = p_->p_t;
    const double A = p_->A;
    const double C_h = p_->C_h;
    const double m = p_->m;
    const double d = p_->d;
    const double k_s = p_->k_s;
    const double x_s = p_->x_s;
    const double c = p_->c;
    const double lam = p_->lam;
    const double T_0 = p_->T_0;
    const double V = x[0];
    const double p = x[1];
    const double q = x[2];
    const double S = x[3];
    const double p_in = u[0];
    const double F = u[1];
    const double T_e = u[2];
    /* co-states dU/dx */
    const double dp_chamber = V/C_h;
    const double v_load = p/m;
    const double F_stop = k_s*max(q - x_s, 0.0);
    const double T = T_0*exp(S/c);
    /* transducer ratios */
    const double alpha_cylinder = A;
    /* driving forces */
    const double dp_orifice = -dp_chamber + p_in;
    /* dissipative laws */
    const double flow_orifice = C_d*a*sqrt(2.0/rho)*dp_orifice/pow(power_2(dp_orifice) + power_2(p_t), 0.25);
    const double F_friction = d*v_load;
    /* heats */
    const double heat_orifice = flow_orifice*dp_orifice;
    const double heat_friction = F_friction*v_load;
    /* rates */
    const double rate_V = flow_orifice - alpha_cylinder*v_load;
    const double rate_p = alpha_cylinder*dp_chamber - F_stop - F_friction + F;
    const double rate_S = (heat_orifice + heat_friction)/T + lam*(T_e/T - 1.0);
    /* result */
    out[0] = p_in;
    out[1] = -flow_orifice;
    out[2] = -flow_orifice*p_in;
    out[3] = dp_orifice;
    out[4] = flow_orifice;
    out[5] = flow_orifice*dp_orifice;
    out[6] = flow_orifice*dp_orifice;
    out[7] = dp_chamber;
    out[8] = rate_V;
    out[9] = dp_chamber*rate_V;
    out[10] = power_2(V)/(2.0*C_h);
    out[11] = dp_chamber;
    out[12] = alpha_cylinder*v_load;
    out[13] = -alpha_cylinder*dp_chamber;
    out[14] = v_load;
    out[15] = dp_chamber*alpha_cylinder*v_load;
    out[16] = rate_p;
    out[17] = v_load;
    out[18] = rate_p*v_load;
    out[19] = power_2(p)/(2.0*m);
    out[20] = F_friction;
    out[21] = v_load;
    out[22] = F_friction*v_load;
    out[23] = F_friction*v_load;
    out[24] = F_stop;
    out[25] = v_load;
    out[26] = F_stop*v_load;
    out[27] = 0.5*(k_s*power_2(max(q - x_s, 0.0)));
    out[28] = -F;
    out[29] = v_load;
    out[30] = -v_load*F;
    out[31] = T;
    out[32] = rate_S;
    out[33] = T*rate_S;
    out[34] = T_0*c*exp(S/c);
    out[35] = T;
    out[36] = -lam*(T_e/T - 1.0);
    out[37] = -lam*(T_e - T);
}

/* Jacobian of rhs, n x n, row after row: d rhs[i]/d x[j] at out[i*n + j]. */
void hydraulic_cylinder_jacobian(const double *restrict x,
                                 const double *restrict u,
                                 const hydraulic_cylinder_parameters *restrict p_,
                                 double *restrict out)
{
    const long n = 4;
    const double C_d = p_->C_d;
    const double a = p_->a;
    const double rho = p_->rho;
    const double p_t = p_->p_t;
    const double A = p_->A;
    const double C_h = p_->C_h;
    const double m = p_->m;
    const double d = p_->d;
    const double k_s = p_->k_s;
    const double x_s = p_->x_s;
    const double c = p_->c;
    const double lam = p_->lam;
    const double T_0 = p_->T_0;
    const double V = x[0];
    const double p = x[1];
    const double q = x[2];
    const double S = x[3];
    const double p_in = u[0];
    const double T_e = u[2];
    for (long j = 0; j < n*n; ++j) {
        out[j] = 0.0;
    }
    /* co-states dU/dx */
    const double dp_chamber = V/C_h;
    const double v_load = p/m;
    const double T = T_0*exp(S/c);
    /* transducer ratios */
    const double alpha_cylinder = A;
    /* driving forces */
    const double dp_orifice = -dp_chamber + p_in;
    /* dissipative laws */
    const double flow_orifice = C_d*a*sqrt(2.0/rho)*dp_orifice/pow(power_2(dp_orifice) + power_2(p_t), 0.25);
    const double F_friction = d*v_load;
    /* heats */
    const double heat_orifice = flow_orifice*dp_orifice;
    const double heat_friction = F_friction*v_load;
    /* derivatives */
    const double dflow_orifice_dV = -(C_d*a*sqrt(2.0/rho)/pow(power_2(dp_orifice) + power_2(p_t), 0.25) - 0.5*(C_d*a*sqrt(2.0/rho)*dp_orifice*pow(power_2(dp_orifice) + power_2(p_t), -0.75)*dp_orifice)/power_2(pow(power_2(dp_orifice) + power_2(p_t), 0.25)))/C_h;
    const double dheat_orifice_dV = dp_orifice*dflow_orifice_dV - flow_orifice/C_h;
    const double dF_friction_dp = d/m;
    const double dheat_friction_dp = v_load*dF_friction_dp + F_friction/m;
    const double dF_stop_dq = pick(q - x_s >= 0.0, k_s, 0.0);
    const double dT_dS = T/c;
    /* result */
    out[0] = dflow_orifice_dV;
    out[1] = -alpha_cylinder/m;
    out[n + 0] = alpha_cylinder/C_h;
    out[n + 1] = -dF_friction_dp;
    out[n + 2] = -dF_stop_dq;
    out[2*n + 1] = 1.0/m;
    out[3*n + 0] = dheat_orifice_dV/T;
    out[3*n + 1] = dheat_friction_dp/T;
    out[3*n + 3] = (-(heat_orifice + heat_friction)/power_2(T) - lam*T_e/power_2(T))*dT_dS;
}

/* Margin by which each condition of the domain holds; of a bank, the least one. */
void hydraulic_cylinder_margins(const double *restrict x,
                                const double *restrict u,
                                const hydraulic_cylinder_parameters *restrict p_,
                                double *restrict out)
{
    (void)x;
    const double C_d = p_->C_d;
    const double a = p_->a;
    const double rho = p_->rho;
    const double p_t = p_->p_t;
    const double C_h = p_->C_h;
    const double m = p_->m;
    const double d = p_->d;
    const double k_s = p_->k_s;
    const double x_s = p_->x_s;
    const double c = p_->c;
    const double lam = p_->lam;
    const double T_0 = p_->T_0;
    const double T_e = u[2];
    out[0] = C_d;
    out[1] = a;
    out[2] = rho;
    out[3] = p_t;
    out[4] = d;
    out[5] = k_s;
    out[6] = x_s;
    out[7] = lam;
    out[8] = T_e;
    out[9] = C_h;
    out[10] = m;
    out[11] = T_0;
    out[12] = c;
}
