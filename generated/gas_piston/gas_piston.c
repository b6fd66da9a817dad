/*
 * Ideal gas under a piston, with heat exchanged: irreversible port-Hamiltonian system.
 *
 * Source:  Ruechhardt (1929), Physikalische Zeitschrift 30, 58-59, the period; van der Schaft, Maschke (2018), Entropy 20, 925
 * Model:   gas_piston, spec sha256 0a9d53c8700ddf1bb0d85a7756da7a071b3f29cf0a98843810acd07ee683352b
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, sigma, exergy, environment, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (p, q, S)
 * u = (F, T_e)
 * p_ = pointer to gas_piston_parameters; the underscore tells it from p, a name of the model
 */
#include "gas_piston.h"

#include <math.h>

static double power_2(double z)
{
    return z*z;
}

/* Number of states n. */
long gas_piston_states(const gas_piston_parameters *restrict p_)
{
    (void)p_;
    return 3;
}

/* Number of processes, which produce entropy; of a bank, one per lane. */
long gas_piston_processes(const gas_piston_parameters *restrict p_)
{
    (void)p_;
    return 1;
}

/* State at t = 0 [SI], for the inputs u at t = 0. */
void gas_piston_initial_state(const double *restrict u,
                              const gas_piston_parameters *restrict p_,
                              double *restrict out)
{
    (void)u;
    (void)p_;
    out[0] = 0.0;
    out[1] = 0.0;
    out[2] = 0.0;
}

/* Rates dx/dt, the rows of J_ir dU/dx + g u. */
void gas_piston_rhs(const double *restrict x,
                    const double *restrict u,
                    const gas_piston_parameters *restrict p_,
                    double *restrict out)
{
    const double V_0 = p_->V_0;
    const double A = p_->A;
    const double N = p_->N;
    const double c_v = p_->c_v;
    const double R = p_->R;
    const double T_0 = p_->T_0;
    const double m = p_->m;
    const double d = p_->d;
    const double lam = p_->lam;
    const double p = x[0];
    const double q = x[1];
    const double S = x[2];
    const double F = u[0];
    const double T_e = u[1];
    /* co-states dU/dx */
    const double v_piston = p/m;
    const double F_q = -N*c_v*T_0*exp(S/(N*c_v))*exp((-R)/c_v*log(1.0 + A*q/V_0))*R/c_v*A/(1.0 + A*q/V_0)/V_0;
    const double T = N*c_v*T_0*exp(S/(N*c_v))/(N*c_v)*exp((-R)/c_v*log(1.0 + A*q/V_0));
    /* dissipative laws */
    const double F_friction = d*v_piston;
    /* heats */
    const double heat_friction = F_friction*v_piston;
    /* result */
    out[0] = F - F_q - F_friction;
    out[1] = v_piston;
    out[2] = heat_friction/T + lam*(T_e/T - 1.0);
}

/* Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient. */
void gas_piston_outputs(const double *restrict x,
                        const double *restrict u,
                        const gas_piston_parameters *restrict p_,
                        double *restrict out)
{
    (void)u;
    const double V_0 = p_->V_0;
    const double A = p_->A;
    const double N = p_->N;
    const double c_v = p_->c_v;
    const double R = p_->R;
    const double T_0 = p_->T_0;
    const double m = p_->m;
    const double p = x[0];
    const double q = x[1];
    const double S = x[2];
    /* co-states dU/dx */
    const double v_piston = p/m;
    const double T = N*c_v*T_0*exp(S/(N*c_v))/(N*c_v)*exp((-R)/c_v*log(1.0 + A*q/V_0));
    /* result */
    out[0] = v_piston;
    out[1] = T;
}

/* Power supplied through each port [W]; the sum is dU/dt. */
void gas_piston_supply(const double *restrict x,
                       const double *restrict u,
                       const gas_piston_parameters *restrict p_,
                       double *restrict out)
{
    const double V_0 = p_->V_0;
    const double A = p_->A;
    const double N = p_->N;
    const double c_v = p_->c_v;
    const double R = p_->R;
    const double T_0 = p_->T_0;
    const double m = p_->m;
    const double lam = p_->lam;
    const double p = x[0];
    const double q = x[1];
    const double S = x[2];
    const double F = u[0];
    const double T_e = u[1];
    /* co-states dU/dx */
    const double v_piston = p/m;
    const double T = N*c_v*T_0*exp(S/(N*c_v))/(N*c_v)*exp((-R)/c_v*log(1.0 + A*q/V_0));
    /* result */
    out[0] = v_piston*F;
    out[1] = lam*(T_e - T);
}

/* Hamiltonian U [J]. */
double gas_piston_energy(const double *restrict x, const gas_piston_parameters *restrict p_)
{
    const double V_0 = p_->V_0;
    const double A = p_->A;
    const double N = p_->N;
    const double c_v = p_->c_v;
    const double R = p_->R;
    const double T_0 = p_->T_0;
    const double m = p_->m;
    const double p = x[0];
    const double q = x[1];
    const double S = x[2];
    return power_2(p)/(2.0*m) + N*c_v*T_0*exp(S/(N*c_v))*exp((-R)/c_v*log(1.0 + A*q/V_0));
}

/* Total entropy S [J/K]. */
double gas_piston_entropy(const double *restrict x, const gas_piston_parameters *restrict p_)
{
    (void)p_;
    const double S = x[2];
    return S;
}

/* Temperature of each body [K]. */
void gas_piston_temperatures(const double *restrict x,
                             const gas_piston_parameters *restrict p_,
                             double *restrict out)
{
    const double V_0 = p_->V_0;
    const double A = p_->A;
    const double N = p_->N;
    const double c_v = p_->c_v;
    const double R = p_->R;
    const double T_0 = p_->T_0;
    const double q = x[1];
    const double S = x[2];
    /* co-states dU/dx */
    const double T = N*c_v*T_0*exp(S/(N*c_v))/(N*c_v)*exp((-R)/c_v*log(1.0 + A*q/V_0));
    /* result */
    out[0] = T;
}

/* Power that each process turns into heat [W]; of a bank, one row per lane. */
void gas_piston_heat(const double *restrict x,
                     const double *restrict u,
                     const gas_piston_parameters *restrict p_,
                     double *restrict out)
{
    (void)u;
    const double m = p_->m;
    const double d = p_->d;
    const double p = x[0];
    /* co-states dU/dx */
    const double v_piston = p/m;
    /* dissipative laws */
    const double F_friction = d*v_piston;
    /* result */
    out[0] = F_friction*v_piston;
}

/*
 * Entropy production of each process [W/K], heat exchange with ambients not included; of a
 * bank, one row per lane.
 */
void gas_piston_entropy_production(const double *restrict x,
                                   const double *restrict u,
                                   const gas_piston_parameters *restrict p_,
                                   double *restrict out)
{
    (void)u;
    const double V_0 = p_->V_0;
    const double A = p_->A;
    const double N = p_->N;
    const double c_v = p_->c_v;
    const double R = p_->R;
    const double T_0 = p_->T_0;
    const double m = p_->m;
    const double d = p_->d;
    const double p = x[0];
    const double q = x[1];
    const double S = x[2];
    /* co-states dU/dx */
    const double v_piston = p/m;
    const double T = N*c_v*T_0*exp(S/(N*c_v))/(N*c_v)*exp((-R)/c_v*log(1.0 + A*q/V_0));
    /* dissipative laws */
    const double F_friction = d*v_piston;
    /* result */
    out[0] = F_friction*v_piston/T;
}

/* Effort, flow, power, energy and heat of elements; of a bank, one row per lane. */
void gas_piston_elements(const double *restrict x,
                         const double *restrict u,
                         const gas_piston_parameters *restrict p_,
                         double *restrict out)
{
    const double V_0 = p_->V_0;
    const double A = p_->A;
    const double N = p_->N;
    const double c_v = p_->c_v;
    const double R = p_->R;
    const double T_0 = p_->T_0;
    const double m = p_->m;
    const double d = p_->d;
    const double lam = p_->lam;
    const double p = x[0];
    const double q = x[1];
    const double S = x[2];
    const double F = u[0];
    const double T_e = u[1];
    /* co-states dU/dx */
    const double v_piston = p/m;
    const double F_q = -N*c_v*T_0*exp(S/(N*c_v))*exp((-R)/c_v*log(1.0 + A*q/V_0))*R/c_v*A/(1.0 + A*q/V_0)/V_0;
    const double T = N*c_v*T_0*exp(S/(N*c_v))/(N*c_v)*exp((-R)/c_v*log(1.0 + A*q/V_0));
    /* dissipative laws */
    const double F_friction = d*v_piston;
    /* heats */
    const double heat_friction = F_friction*v_piston;
    /* rates */
    const double rate_p = F - F_q - F_friction;
    const double rate_S = heat_friction/T + lam*(T_e/T - 1.0);
    /* result */
    out[0] = rate_p;
    out[1] = v_piston;
    out[2] = rate_p*v_piston;
    out[3] = power_2(p)/(2.0*m);
    out[4] = F_friction;
    out[5] = v_piston;
    out[6] = F_friction*v_piston;
    out[7] = F_friction*v_piston;
    out[8] = -F;
    out[9] = v_piston;
    out[10] = -v_piston*F;
    out[11] = T;
    out[12] = -lam*(T_e/T - 1.0);
    out[13] = -lam*(T_e - T);
    out[14] = F_q;
    out[15] = v_piston;
    out[16] = T;
    out[17] = rate_S;
    out[18] = F_q*v_piston + T*rate_S;
    out[19] = N*c_v*T_0*exp(S/(N*c_v))*exp((-R)/c_v*log(1.0 + A*q/V_0));
}

/* Jacobian of rhs, n x n, row after row: d rhs[i]/d x[j] at out[i*n + j]. */
void gas_piston_jacobian(const double *restrict x,
                         const double *restrict u,
                         const gas_piston_parameters *restrict p_,
                         double *restrict out)
{
    const long n = 3;
    const double V_0 = p_->V_0;
    const double A = p_->A;
    const double N = p_->N;
    const double c_v = p_->c_v;
    const double R = p_->R;
    const double T_0 = p_->T_0;
    const double m = p_->m;
    const double d = p_->d;
    const double lam = p_->lam;
    const double p = x[0];
    const double q = x[1];
    const double S = x[2];
    const double T_e = u[1];
    for (long j = 0; j < n*n; ++j) {
        out[j] = 0.0;
    }
    /* co-states dU/dx */
    const double v_piston = p/m;
    const double T = N*c_v*T_0*exp(S/(N*c_v))/(N*c_v)*exp((-R)/c_v*log(1.0 + A*q/V_0));
    /* dissipative laws */
    const double F_friction = d*v_piston;
    /* heats */
    const double heat_friction = F_friction*v_piston;
    /* derivatives */
    const double dF_friction_dp = d/m;
    const double dheat_friction_dp = v_piston*dF_friction_dp + F_friction/m;
    const double dF_q_dq = -(-N*c_v*T_0*exp(S/(N*c_v))*exp((-R)/c_v*log(1.0 + A*q/V_0))*R/c_v*A/(1.0 + A*q/V_0)/V_0*R/c_v*A/(1.0 + A*q/V_0) - N*c_v*T_0*exp(S/(N*c_v))*exp((-R)/c_v*log(1.0 + A*q/V_0))*R/c_v*A*A/V_0/power_2(1.0 + A*q/V_0))/V_0;
    const double dT_dq = -T*R/c_v*A/(1.0 + A*q/V_0)/V_0;
    const double dF_q_dS = -T*R/c_v*A/(1.0 + A*q/V_0)/V_0;
    const double dT_dS = N*c_v*T_0*exp(S/(N*c_v))/power_2(N*c_v)*exp((-R)/c_v*log(1.0 + A*q/V_0));
    /* result */
    out[0] = -dF_friction_dp;
    out[1] = -dF_q_dq;
    out[2] = -dF_q_dS;
    out[n + 0] = 1.0/m;
    out[2*n + 0] = dheat_friction_dp/T;
    out[2*n + 1] = (-heat_friction/power_2(T) - lam*T_e/power_2(T))*dT_dq;
    out[2*n + 2] = (-heat_friction/power_2(T) - lam*T_e/power_2(T))*dT_dS;
}

/* Margin by which each condition of the domain holds; of a bank, the least one. */
void gas_piston_margins(const double *restrict x,
                        const double *restrict u,
                        const gas_piston_parameters *restrict p_,
                        double *restrict out)
{
    const double V_0 = p_->V_0;
    const double A = p_->A;
    const double N = p_->N;
    const double c_v = p_->c_v;
    const double R = p_->R;
    const double T_0 = p_->T_0;
    const double m = p_->m;
    const double d = p_->d;
    const double lam = p_->lam;
    const double q = x[1];
    const double T_e = u[1];
    out[0] = V_0 + A*q;
    out[1] = V_0;
    out[2] = A;
    out[3] = N;
    out[4] = c_v;
    out[5] = R;
    out[6] = T_0;
    out[7] = d;
    out[8] = lam;
    out[9] = T_e;
    out[10] = m;
}
