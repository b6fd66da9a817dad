/*
 * Piezoelectric stack actuator with hysterons: irreversible port-Hamiltonian system.
 *
 * Source:  Caballeria, Ramirez, Le Gorrec (2021), eqs. (9)-(13), Table 1
 * Model:   piezo_stack, spec sha256 9c0235a60e02072bc451611ffa723f273272c8e4536a3089081866f47c89389c
 * Proofs:  skew, casimir, temperature, energy, entropy, welldef, continuous, passive, odd, sigma, exergy, environment, invariant, units, program PROVED
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (q, p, Q_C, phi_1 ... phi_hysteron_count, S)
 * u = (F_ext, V_in, T_e)
 * hysteron: lanes j = 1 ... hysteron_count
 */
#include "piezo_stack.h"

#include <math.h>

static double pick(int condition, double a, double b)
{
    return condition ? a : b;
}

static double min(double a, double b)
{
    return a < b || a != a ? a : b; /* not a number stays so */
}

static double power_2(double z)
{
    return z*z;
}

/* Number of states n. */
long piezo_stack_states(const piezo_stack_parameters *restrict p_)
{
    const long hysteron_count = p_->hysteron_count;
    return 4 + hysteron_count;
}

/* Number of rows of processes, a bank's one a lane. */
long piezo_stack_processes(const piezo_stack_parameters *restrict p_)
{
    const long hysteron_count = p_->hysteron_count;
    return 1 + hysteron_count;
}

/* State at t = 0 [SI], for the inputs u at t = 0. */
void piezo_stack_initial_state(const double *restrict u,
                               const piezo_stack_parameters *restrict p_,
                               double *restrict out)
{
    const long hysteron_count = p_->hysteron_count;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double T_e = u[2];
    /* hysteron: rows */
#pragma omp simd
    for (long j = 0; j < hysteron_count; ++j) {
        out[3 + j] = 0.0;
    }
    /* rows */
    out[0] = 0.0;
    out[1] = 0.0;
    out[2] = 0.0;
    out[3 + hysteron_count] = c_0*log(T_e/T_0);
}

/* Rates dx/dt = J_ir dU/dx + g u. */
void piezo_stack_rhs(const double *restrict x,
                     const double *restrict u,
                     const piezo_stack_parameters *restrict p_,
                     double *restrict out)
{
    const long hysteron_count = p_->hysteron_count;
    const double M = p_->M;
    const double k = p_->k;
    const double q_l = p_->q_l;
    const double d = p_->d;
    const double C = p_->C;
    const double *restrict L = p_->L;
    const double *restrict rho = p_->rho;
    const double *restrict i_0 = p_->i_0;
    const double a = p_->a;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double lam = p_->lam;
    const double q = x[0];
    const double p = x[1];
    const double Q_C = x[2];
    const double *phi = x + 3;
    const double S = x[3 + hysteron_count];
    const double F_ext = u[0];
    const double V_in = u[1];
    const double T_e = u[2];
    /* co-states dU/dx */
    const double F_spring = k*(q - q_l);
    const double v_mass = p/M;
    const double V_capacitor = Q_C/C;
    const double T_minus_T_0 = T_0*expm1(S/c_0);
    const double T = T_0 + T_minus_T_0;
    /* transducer ratios */
    const double alpha_transducer = a*T/T_0;
    /* dissipative laws */
    const double F_damper = d*v_mass;
    /* heats */
    const double heat_damper = F_damper*v_mass;
    /* hysteron: sums over lanes and rows */
    double sum_i_hysteron = 0.0;
    double heat_hysteron = 0.0;
#pragma omp simd reduction(+:sum_i_hysteron, heat_hysteron)
    for (long j = 0; j < hysteron_count; ++j) {
        const double i_hysteron = phi[j]/L[j];
        const double V_hysteron = pick(
            fabs(i_hysteron) <= i_0[j],
            0.0,
            rho[j]/T_minus_T_0*(i_hysteron - copysign(i_0[j], i_hysteron)));
        sum_i_hysteron += i_hysteron;
        heat_hysteron += V_hysteron*i_hysteron;
        out[3 + j] = V_in - V_capacitor - V_hysteron;
    }
    /* rows */
    out[0] = v_mass;
    out[1] = alpha_transducer*V_capacitor - F_spring - F_damper + F_ext;
    out[2] = sum_i_hysteron - alpha_transducer*v_mass;
    out[3 + hysteron_count] = (heat_hysteron + heat_damper)/T + lam*(T_e/T - 1.0);
}

/* Outputs y, one a port, conjugate to its input. */
void piezo_stack_outputs(const double *restrict x,
                         const double *restrict u,
                         const piezo_stack_parameters *restrict p_,
                         double *restrict out)
{
    (void)u;
    const long hysteron_count = p_->hysteron_count;
    const double M = p_->M;
    const double *restrict L = p_->L;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double p = x[1];
    const double *phi = x + 3;
    const double S = x[3 + hysteron_count];
    /* co-states dU/dx */
    const double v_mass = p/M;
    const double T_minus_T_0 = T_0*expm1(S/c_0);
    const double T = T_0 + T_minus_T_0;
    /* hysteron: sums over lanes */
    double sum_i_hysteron = 0.0;
#pragma omp simd reduction(+:sum_i_hysteron)
    for (long j = 0; j < hysteron_count; ++j) {
        const double i_hysteron = phi[j]/L[j];
        sum_i_hysteron += i_hysteron;
    }
    /* rows */
    out[0] = v_mass;
    out[1] = sum_i_hysteron;
    out[2] = T;
}

/* Power put in [W], one a port; the sum is dU/dt. */
void piezo_stack_supply(const double *restrict x,
                        const double *restrict u,
                        const piezo_stack_parameters *restrict p_,
                        double *restrict out)
{
    const long hysteron_count = p_->hysteron_count;
    const double M = p_->M;
    const double *restrict L = p_->L;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double lam = p_->lam;
    const double p = x[1];
    const double *phi = x + 3;
    const double S = x[3 + hysteron_count];
    const double F_ext = u[0];
    const double V_in = u[1];
    const double T_e = u[2];
    /* co-states dU/dx */
    const double v_mass = p/M;
    const double T_minus_T_0 = T_0*expm1(S/c_0);
    const double T = T_0 + T_minus_T_0;
    /* hysteron: sums over lanes */
    double sum_i_hysteron = 0.0;
#pragma omp simd reduction(+:sum_i_hysteron)
    for (long j = 0; j < hysteron_count; ++j) {
        const double i_hysteron = phi[j]/L[j];
        sum_i_hysteron += i_hysteron;
    }
    /* rows */
    out[0] = v_mass*F_ext;
    out[1] = sum_i_hysteron*V_in;
    out[2] = lam*(T_e - T);
}

/* Hamiltonian U [J]. */
double piezo_stack_energy(const double *restrict x, const piezo_stack_parameters *restrict p_)
{
    const long hysteron_count = p_->hysteron_count;
    const double M = p_->M;
    const double k = p_->k;
    const double q_l = p_->q_l;
    const double C = p_->C;
    const double *restrict L = p_->L;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double q = x[0];
    const double p = x[1];
    const double Q_C = x[2];
    const double *phi = x + 3;
    const double S = x[3 + hysteron_count];
    /* hysteron: sums over lanes */
    double energy_phi = 0.0;
#pragma omp simd reduction(+:energy_phi)
    for (long j = 0; j < hysteron_count; ++j) {
        energy_phi += power_2(phi[j])/(2.0*L[j]);
    }
    return k*power_2(q - q_l)/2.0
        + power_2(p)/(2.0*M)
        + power_2(Q_C)/(2.0*C)
        + energy_phi
        + T_0*c_0*exp(S/c_0);
}

/* Total entropy S [J/K]. */
double piezo_stack_entropy(const double *restrict x, const piezo_stack_parameters *restrict p_)
{
    const long hysteron_count = p_->hysteron_count;
    const double S = x[3 + hysteron_count];
    return S;
}

/* Temperature of each body [K]. */
void piezo_stack_temperatures(const double *restrict x,
                              const piezo_stack_parameters *restrict p_,
                              double *restrict out)
{
    const long hysteron_count = p_->hysteron_count;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double S = x[3 + hysteron_count];
    /* co-states dU/dx */
    const double T_minus_T_0 = T_0*expm1(S/c_0);
    const double T = T_0 + T_minus_T_0;
    /* rows */
    out[0] = T;
}

/* Power that each process turns into heat [W], a bank's a row a lane. */
void piezo_stack_heat(const double *restrict x,
                      const double *restrict u,
                      const piezo_stack_parameters *restrict p_,
                      double *restrict out)
{
    (void)u;
    const long hysteron_count = p_->hysteron_count;
    const double M = p_->M;
    const double d = p_->d;
    const double *restrict L = p_->L;
    const double *restrict rho = p_->rho;
    const double *restrict i_0 = p_->i_0;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double p = x[1];
    const double *phi = x + 3;
    const double S = x[3 + hysteron_count];
    /* co-states dU/dx */
    const double v_mass = p/M;
    const double T_minus_T_0 = T_0*expm1(S/c_0);
    /* dissipative laws */
    const double F_damper = d*v_mass;
    /* hysteron: rows */
#pragma omp simd
    for (long j = 0; j < hysteron_count; ++j) {
        const double i_hysteron = phi[j]/L[j];
        const double V_hysteron = pick(
            fabs(i_hysteron) <= i_0[j],
            0.0,
            rho[j]/T_minus_T_0*(i_hysteron - copysign(i_0[j], i_hysteron)));
        out[j] = V_hysteron*i_hysteron;
    }
    /* rows */
    out[hysteron_count] = F_damper*v_mass;
}

/* Entropy that each process produces [W/K], a bank's a row a lane. */
void piezo_stack_entropy_production(const double *restrict x,
                                    const double *restrict u,
                                    const piezo_stack_parameters *restrict p_,
                                    double *restrict out)
{
    (void)u;
    const long hysteron_count = p_->hysteron_count;
    const double M = p_->M;
    const double d = p_->d;
    const double *restrict L = p_->L;
    const double *restrict rho = p_->rho;
    const double *restrict i_0 = p_->i_0;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double p = x[1];
    const double *phi = x + 3;
    const double S = x[3 + hysteron_count];
    /* co-states dU/dx */
    const double v_mass = p/M;
    const double T_minus_T_0 = T_0*expm1(S/c_0);
    const double T = T_0 + T_minus_T_0;
    /* dissipative laws */
    const double F_damper = d*v_mass;
    /* hysteron: rows */
#pragma omp simd
    for (long j = 0; j < hysteron_count; ++j) {
        const double i_hysteron = phi[j]/L[j];
        const double V_hysteron = pick(
            fabs(i_hysteron) <= i_0[j],
            0.0,
            rho[j]/T_minus_T_0*(i_hysteron - copysign(i_0[j], i_hysteron)));
        out[j] = V_hysteron*i_hysteron/T;
    }
    /* rows */
    out[hysteron_count] = F_damper*v_mass/T;
}

/* Derivative of rhs by the state, n x n, row after row. */
void piezo_stack_jacobian(const double *restrict x,
                          const double *restrict u,
                          const piezo_stack_parameters *restrict p_,
                          double *restrict out)
{
    const long hysteron_count = p_->hysteron_count;
    const long n = 4 + hysteron_count;
    const double M = p_->M;
    const double k = p_->k;
    const double d = p_->d;
    const double C = p_->C;
    const double *restrict L = p_->L;
    const double *restrict rho = p_->rho;
    const double *restrict i_0 = p_->i_0;
    const double a = p_->a;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double lam = p_->lam;
    const double p = x[1];
    const double Q_C = x[2];
    const double *phi = x + 3;
    const double S = x[3 + hysteron_count];
    const double T_e = u[2];
    for (long j = 0; j < n*n; ++j) {
        out[j] = 0.0;
    }
    /* co-states dU/dx */
    const double v_mass = p/M;
    const double V_capacitor = Q_C/C;
    const double T_minus_T_0 = T_0*expm1(S/c_0);
    const double T = T_0 + T_minus_T_0;
    /* transducer ratios */
    const double alpha_transducer = a*T/T_0;
    /* dissipative laws */
    const double F_damper = d*v_mass;
    /* heats */
    const double heat_damper = F_damper*v_mass;
    /* derivatives */
    const double dF_damper_dp = d/M;
    const double dheat_damper_dp = v_mass*dF_damper_dp + F_damper/M;
    const double dT_minus_T_0_dS = T/c_0;
    const double dalpha_transducer_dS = a/T_0*dT_minus_T_0_dS;
    /* hysteron: sums over lanes and rows */
    double heat_hysteron = 0.0;
    double dheat_hysteron_dS = 0.0;
#pragma omp simd reduction(+:heat_hysteron, dheat_hysteron_dS)
    for (long j = 0; j < hysteron_count; ++j) {
        const double i_hysteron = phi[j]/L[j];
        const double V_hysteron = pick(
            fabs(i_hysteron) <= i_0[j],
            0.0,
            rho[j]/T_minus_T_0*(i_hysteron - copysign(i_0[j], i_hysteron)));
        const double dV_hysteron_dphi = pick(fabs(i_hysteron) > i_0[j], rho[j]/T_minus_T_0, 0.0)/L[j];
        const double dheat_hysteron_dphi = i_hysteron*dV_hysteron_dphi + V_hysteron/L[j];
        const double dV_hysteron_dS = pick(
            fabs(i_hysteron) <= i_0[j],
            0.0,
            -rho[j]/power_2(T_minus_T_0)*(i_hysteron - copysign(i_0[j], i_hysteron))*dT_minus_T_0_dS);
        heat_hysteron += V_hysteron*i_hysteron;
        dheat_hysteron_dS += i_hysteron*dV_hysteron_dS;
        out[2*n + 3 + j] = 1.0/L[j];
        out[(3 + j)*n + 2] = -1.0/C;
        out[(3 + j)*n + 3 + j] = -dV_hysteron_dphi;
        out[(3 + j)*n + 3 + hysteron_count] = -dV_hysteron_dS;
        out[(3 + hysteron_count)*n + 3 + j] = dheat_hysteron_dphi/T;
    }
    /* rows */
    out[1] = 1.0/M;
    out[n + 0] = -k;
    out[n + 1] = -dF_damper_dp;
    out[n + 2] = alpha_transducer/C;
    out[n + 3 + hysteron_count] = V_capacitor*dalpha_transducer_dS;
    out[2*n + 1] = -alpha_transducer/M;
    out[2*n + 3 + hysteron_count] = -v_mass*dalpha_transducer_dS;
    out[(3 + hysteron_count)*n + 1] = dheat_damper_dp/T;
    out[(3 + hysteron_count)*n + 3 + hysteron_count] = dheat_hysteron_dS/T
        + (-(heat_hysteron + heat_damper)/power_2(T) - lam*T_e/power_2(T))*dT_minus_T_0_dS;
}

/* Margin of each condition of the domain, least over lanes. */
void piezo_stack_margins(const double *restrict x,
                         const double *restrict u,
                         const piezo_stack_parameters *restrict p_,
                         double *restrict out)
{
    const long hysteron_count = p_->hysteron_count;
    const double M = p_->M;
    const double k = p_->k;
    const double d = p_->d;
    const double C = p_->C;
    const double *restrict L = p_->L;
    const double *restrict rho = p_->rho;
    const double *restrict i_0 = p_->i_0;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double lam = p_->lam;
    const double S = x[3 + hysteron_count];
    const double T_e = u[2];
    /* co-states dU/dx */
    const double T_minus_T_0 = T_0*expm1(S/c_0);
    /* hysteron: rows */
    out[3] = HUGE_VAL;
    out[4] = HUGE_VAL;
    out[9] = HUGE_VAL;
    for (long j = 0; j < hysteron_count; ++j) {
        out[3] = min(out[3], rho[j]);
        out[4] = min(out[4], i_0[j]);
        out[9] = min(out[9], L[j]);
    }
    /* rows */
    out[0] = T_minus_T_0;
    out[1] = T_e - T_0;
    out[2] = d;
    out[5] = lam;
    out[6] = k;
    out[7] = M;
    out[8] = C;
    out[10] = T_0;
    out[11] = c_0;
}

/* (exp(d) - 1 - d - d^2/2)/d^3, by its series where that would cancel. */
static double phi3(double d)
{
    const double size = fabs(d);
    double sum = 0.0;
    if (size < 0x1p-10)
        return 1.0/6.0 + d*(1.0/24.0 + d*(1.0/120.0 + d*(1.0/720.0 + d/5040.0)));
    if (size >= 1.0)
        return (((exp(d) - 1.0)/d - 1.0)/d - 0.5)/d;
    for (int k = 19; k > 2; --k)
        sum = (1.0 + sum)*d/(k + 1);
    return (1.0 + sum)/6.0;
}

/* Mean of deadzone(s, w) for s from a to b, w >= 0. */
static double mean_deadzone(double a, double b, double w)
{
    const double from = a > w ? a - w : a < -w ? a + w : 0.0;
    const double to = b > w ? b - w : b < -w ? b + w : 0.0;
    const double way = fabs(b - a) > 0x1p-1000 ? b - a : 1.0;
    return 0.5 * (from + to) * (from * to > 0.0 ? 1.0 : (to - from) / way);
}

/* Derivative of mean_deadzone by b. */
static double mean_deadzone_by_new(double a, double b, double w)
{
    const double from = a > w ? a - w : a < -w ? a + w : 0.0;
    const double to = b > w ? b - w : b < -w ? b + w : 0.0;
    const double way = fabs(b - a) > 0x1p-1000 ? b - a : 1.0;
    return from * to > 0.0 ? 0.5 : (to - mean_deadzone(a, b, w)) / way;
}

long piezo_stack_newton_size_start(const piezo_stack_parameters *restrict p_)
{
    const long hysteron_count = p_->hysteron_count;
    return 4 + hysteron_count + hysteron_count + hysteron_count;
}

int piezo_stack_newton_start(const double *restrict x,
                             const double *restrict x_new,
                             const double *restrict u,
                             double h,
                             const piezo_stack_parameters *restrict p_,
                             double *restrict out)
{
    const long hysteron_count = p_->hysteron_count;
    const double M = p_->M;
    const double k = p_->k;
    const double q_l = p_->q_l;
    const double d = p_->d;
    const double C = p_->C;
    const double *restrict L = p_->L;
    const double *restrict rho = p_->rho;
    const double *restrict i_0 = p_->i_0;
    const double a = p_->a;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double lam = p_->lam;
    const double q = x[0];
    const double p = x[1];
    const double Q_C = x[2];
    const double *restrict phi = x + 3;
    const double S = x[3 + hysteron_count];
    const double q_new = x_new[0];
    const double p_new = x_new[1];
    const double Q_C_new = x_new[2];
    const double *restrict phi_new = x_new + 3;
    const double S_new = x_new[3 + hysteron_count];
    const double F_ext = u[0];
    const double V_in = u[1];
    const double T_e = u[2];
    double *restrict kept_reaction_phi_3 = out + 4 + hysteron_count;
    double *restrict kept_reaction_phi_4 = kept_reaction_phi_3 + hysteron_count;
    /* reciprocals */
    const double per_C = 1.0/C;
    const double per_M = 1.0/M;
    const double per_T_0 = 1.0/T_0;
    const double per_c_0 = 1.0/c_0;
    const double per_h = 1.0/h;
    /* before the step */
    const double expm1_S = expm1(S*per_c_0);
    /* co-states dU/dx */
    const double F_spring = k*(q_new - q_l);
    const double v_mass = p_new*per_M;
    const double V_capacitor = Q_C_new*per_C;
    /* means of exponentials */
    const double change_T = (S_new - S)*per_c_0;
    const double phi3_T = phi3(change_T);
    const double phi2_T = 0.5 + change_T*phi3_T;
    const double phi1_T = 1.0 + change_T*phi2_T;
    /* co-states dU/dx */
    const double T_minus_T_0 = T_0*expm1_S*phi1_T + T_0*(S_new - S)*per_c_0*phi2_T;
    const double per_T_minus_T_0 = 1.0/T_minus_T_0;
    const double T = T_0 + T_minus_T_0;
    const double per_T = 1.0/T;
    /* transducer ratios */
    const double alpha_transducer = a*T*per_T_0;
    /* dissipative laws */
    const double F_damper = d*v_mass;
    /* heats */
    const double heat_damper = F_damper*v_mass;
    /* numerical losses */
    const double loss_q = 0.5*(k*power_2(q_new - q));
    const double loss_p = 0.5*(power_2(p_new - p)*per_M);
    const double loss_Q_C = 0.5*(power_2(Q_C_new - Q_C)*per_C);
    /* derivatives */
    const double dloss_q_dq_new = k*(q_new - q);
    const double dheat_numerical_dq_new = dloss_q_dq_new*per_h;
    const double dF_damper_dp_new = d*per_M;
    const double dheat_damper_dp_new = v_mass*dF_damper_dp_new + F_damper*per_M;
    const double dloss_p_dp_new = 0.5*(2.0*((p_new - p)*per_M));
    const double dheat_numerical_dp_new = dloss_p_dp_new*per_h;
    const double dloss_Q_C_dQ_C_new = 0.5*(2.0*((Q_C_new - Q_C)*per_C));
    const double dheat_numerical_dQ_C_new = dloss_Q_C_dQ_C_new*per_h;
    const double dphi2_T_dS_new = (phi2_T - 2.0*phi3_T)*per_c_0;
    const double dphi1_T_dS_new = (phi1_T - phi2_T)*per_c_0;
    const double dT_minus_T_0_dS_new = T_0*expm1_S*dphi1_T_dS_new
        + T_0*per_c_0*phi2_T
        + T_0*(S_new - S)*per_c_0*dphi2_T_dS_new;
    const double dalpha_transducer_dS_new = a*per_T_0*dT_minus_T_0_dS_new;
    /* residuals */
    const double gap_q = q_new - q - h*v_mass;
    const double gap_p = p_new
        - p
        - h*(alpha_transducer*V_capacitor - F_spring - F_damper + F_ext);
    /* Newton's equations, solved */
    const double entry_change_q_2 = -h*per_M;
    const double share_change_q_2 = h*k;
    const double share_change_q_4 = -h*dheat_numerical_dq_new*per_T;
    const double pivot_change_p = 1.0
        + h*dF_damper_dp_new
        - share_change_q_2*entry_change_q_2;
    const double per_pivot_change_p = 1.0/pivot_change_p;
    const double entry_change_p_3 = -h*alpha_transducer*per_C;
    const double entry_change_p_4 = -h*V_capacitor*dalpha_transducer_dS_new;
    const double right_change_p = gap_p - share_change_q_2*gap_q;
    const double share_change_p_3 = h*alpha_transducer*per_M*per_pivot_change_p;
    const double share_change_p_4 = (-h*(dheat_damper_dp_new*per_T + dheat_numerical_dp_new*per_T) - share_change_q_4*entry_change_q_2)*per_pivot_change_p;
    /* hysteron: sums over lanes and rows */
    double sum_i_hysteron = 0.0;
    double heat_hysteron = 0.0;
    double sum_loss_phi = 0.0;
    double dheat_hysteron_dS_new = 0.0;
    double sum_share_phi_3 = 0.0;
    double sum_share_phi_3_3 = 0.0;
    double sum_share_phi_3_4 = 0.0;
    double sum_share_phi_4 = 0.0;
    double sum_share_phi_4_3 = 0.0;
    double sum_share_phi_4_4 = 0.0;
#pragma omp simd reduction(+:sum_i_hysteron, heat_hysteron, sum_loss_phi, \
        dheat_hysteron_dS_new, sum_share_phi_3, sum_share_phi_3_3, sum_share_phi_3_4, \
        sum_share_phi_4, sum_share_phi_4_3, sum_share_phi_4_4)
    for (long j = 0; j < hysteron_count; ++j) {
        const double per_L = 1.0/L[j];
        const double i_hysteron = phi_new[j]*per_L;
        const double V_hysteron = pick(
            fabs(i_hysteron) <= i_0[j],
            0.0,
            rho[j]*per_T_minus_T_0*(i_hysteron - copysign(i_0[j], i_hysteron)));
        const double loss_phi = 0.5*(power_2(phi_new[j] - phi[j])*per_L);
        const double dV_hysteron_dphi_new = pick(fabs(i_hysteron) > i_0[j], rho[j]*per_T_minus_T_0, 0.0)*per_L;
        const double dheat_hysteron_dphi_new = i_hysteron*dV_hysteron_dphi_new
            + V_hysteron*per_L;
        const double dloss_phi_dphi_new = 0.5*(2.0*((phi_new[j] - phi[j])*per_L));
        const double dheat_numerical_dphi_new = dloss_phi_dphi_new*per_h;
        const double dV_hysteron_dS_new = -V_hysteron*per_T_minus_T_0*dT_minus_T_0_dS_new;
        const double gap_phi = phi_new[j] - phi[j] - h*(V_in - V_capacitor - V_hysteron);
        const double pivot_phi = 1.0 + h*dV_hysteron_dphi_new;
        const double per_pivot_phi = 1.0/pivot_phi;
        const double free_phi = gap_phi*per_pivot_phi;
        const double reaction_phi_3 = h*per_C*per_pivot_phi;
        const double reaction_phi_4 = h*dV_hysteron_dS_new*per_pivot_phi;
        const double share_phi_3 = -h*per_L;
        const double share_phi_4 = -h*(dheat_hysteron_dphi_new*per_T + dheat_numerical_dphi_new*per_T);
        sum_i_hysteron += i_hysteron;
        heat_hysteron += V_hysteron*i_hysteron;
        sum_loss_phi += loss_phi;
        dheat_hysteron_dS_new += i_hysteron*dV_hysteron_dS_new;
        sum_share_phi_3 += share_phi_3*free_phi;
        sum_share_phi_3_3 += share_phi_3*reaction_phi_3;
        sum_share_phi_3_4 += share_phi_3*reaction_phi_4;
        sum_share_phi_4 += share_phi_4*free_phi;
        sum_share_phi_4_3 += share_phi_4*reaction_phi_3;
        sum_share_phi_4_4 += share_phi_4*reaction_phi_4;
        kept_reaction_phi_3[j] = reaction_phi_3;
        kept_reaction_phi_4[j] = reaction_phi_4;
        out[3 + j] = free_phi;
    }
    /* numerical losses */
    const double heat_numerical = (loss_q + loss_p + loss_Q_C + sum_loss_phi)*per_h;
    /* residuals */
    const double gap_Q_C = Q_C_new - Q_C - h*(sum_i_hysteron - alpha_transducer*v_mass);
    const double gap_S = S_new
        - S
        - h*((heat_hysteron + heat_damper)*per_T + lam*((T_e - T)*per_T) + heat_numerical*per_T);
    /* Newton's equations, solved */
    const double pivot_change_Q_C = 1.0
        - sum_share_phi_3_3
        - share_change_p_3*entry_change_p_3;
    const double per_pivot_change_Q_C = 1.0/pivot_change_Q_C;
    const double entry_change_Q_C_4 = h*v_mass*dalpha_transducer_dS_new
        - sum_share_phi_3_4
        - share_change_p_3*entry_change_p_4;
    const double right_change_Q_C = gap_Q_C
        - sum_share_phi_3
        - share_change_p_3*right_change_p;
    const double share_change_Q_C_4 = (-h*dheat_numerical_dQ_C_new*per_T - sum_share_phi_4_3 - share_change_p_4*entry_change_p_3)*per_pivot_change_Q_C;
    const double pivot_change_S = 1.0
        - h*(dheat_hysteron_dS_new*per_T + (-(heat_hysteron + heat_damper)*per_T*per_T - lam*T_e*per_T*per_T - heat_numerical*per_T*per_T)*dT_minus_T_0_dS_new)
        - sum_share_phi_4_4
        - share_change_p_4*entry_change_p_4
        - share_change_Q_C_4*entry_change_Q_C_4;
    const double right_change_S = gap_S
        - sum_share_phi_4
        - share_change_q_4*gap_q
        - share_change_p_4*right_change_p
        - share_change_Q_C_4*right_change_Q_C;
    const double change_S = right_change_S/pivot_change_S;
    const double change_Q_C = (right_change_Q_C - entry_change_Q_C_4*change_S)*per_pivot_change_Q_C;
    const double change_p = (right_change_p - entry_change_p_3*change_Q_C - entry_change_p_4*change_S)*per_pivot_change_p;
    const double change_q = gap_q - entry_change_q_2*change_p;
    out[0] = change_q;
    out[1] = change_p;
    out[2] = change_Q_C;
    out[3 + hysteron_count] = change_S;
    /* hysteron: reactions */
#pragma omp simd
    for (long j = 0; j < hysteron_count; ++j) {
        out[3 + j] -= kept_reaction_phi_3[j]*change_Q_C + kept_reaction_phi_4[j]*change_S;
    }
    return (pivot_change_p > 0.0) & (pivot_change_Q_C > 0.0) & (pivot_change_S > 0.0);
}

void piezo_stack_means_start(const double *restrict x,
                             const double *restrict x_new,
                             const double *restrict u,
                             double h,
                             const piezo_stack_parameters *restrict p_,
                             double *restrict out)
{
    const long hysteron_count = p_->hysteron_count;
    const double M = p_->M;
    const double k = p_->k;
    const double d = p_->d;
    const double C = p_->C;
    const double *restrict L = p_->L;
    const double *restrict rho = p_->rho;
    const double *restrict i_0 = p_->i_0;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double lam = p_->lam;
    const double q = x[0];
    const double p = x[1];
    const double Q_C = x[2];
    const double *restrict phi = x + 3;
    const double S = x[3 + hysteron_count];
    const double q_new = x_new[0];
    const double p_new = x_new[1];
    const double Q_C_new = x_new[2];
    const double *restrict phi_new = x_new + 3;
    const double S_new = x_new[3 + hysteron_count];
    const double F_ext = u[0];
    const double V_in = u[1];
    const double T_e = u[2];
    /* reciprocals */
    const double per_C = 1.0/C;
    const double per_M = 1.0/M;
    const double per_c_0 = 1.0/c_0;
    const double per_h = 1.0/h;
    /* before the step */
    const double expm1_S = expm1(S*per_c_0);
    /* co-states dU/dx */
    const double v_mass = p_new*per_M;
    /* means of exponentials */
    const double change_T = (S_new - S)*per_c_0;
    const double phi3_T = phi3(change_T);
    const double phi2_T = 0.5 + change_T*phi3_T;
    const double phi1_T = 1.0 + change_T*phi2_T;
    /* co-states dU/dx */
    const double T_minus_T_0 = T_0*expm1_S*phi1_T + T_0*(S_new - S)*per_c_0*phi2_T;
    const double per_T_minus_T_0 = 1.0/T_minus_T_0;
    const double T = T_0 + T_minus_T_0;
    const double per_T = 1.0/T;
    /* dissipative laws */
    const double F_damper = d*v_mass;
    /* numerical losses */
    const double loss_q = 0.5*(k*power_2(q_new - q));
    const double loss_p = 0.5*(power_2(p_new - p)*per_M);
    const double loss_Q_C = 0.5*(power_2(Q_C_new - Q_C)*per_C);
    /* hysteron: sums over lanes and rows */
    double sum_i_hysteron = 0.0;
    double sum_loss_phi = 0.0;
#pragma omp simd reduction(+:sum_i_hysteron, sum_loss_phi)
    for (long j = 0; j < hysteron_count; ++j) {
        const double per_L = 1.0/L[j];
        const double i_hysteron = phi_new[j]*per_L;
        const double V_hysteron = pick(
            fabs(i_hysteron) <= i_0[j],
            0.0,
            rho[j]*per_T_minus_T_0*(i_hysteron - copysign(i_0[j], i_hysteron)));
        const double loss_phi = 0.5*(power_2(phi_new[j] - phi[j])*per_L);
        sum_i_hysteron += i_hysteron;
        sum_loss_phi += loss_phi;
        out[3 + j] = V_hysteron*i_hysteron;
        out[4 + hysteron_count + j] = V_hysteron*i_hysteron*per_T;
    }
    /* numerical losses */
    const double heat_numerical = (loss_q + loss_p + loss_Q_C + sum_loss_phi)*per_h;
    out[0] = v_mass*F_ext;
    out[1] = sum_i_hysteron*V_in;
    out[2] = lam*(T_e - T);
    out[3 + hysteron_count] = F_damper*v_mass;
    out[4 + hysteron_count + hysteron_count] = F_damper*v_mass*per_T;
    out[5 + hysteron_count + hysteron_count] = lam*((T_e - T)*per_T);
    out[6 + hysteron_count + hysteron_count] = heat_numerical;
    out[7 + hysteron_count + hysteron_count] = heat_numerical*per_T;
}

/* The step of the discrete gradient, of one state or of many side by side. */

long piezo_stack_newton_size(const piezo_stack_parameters *restrict p_)
{
    const long hysteron_count = p_->hysteron_count;
    return 4 + hysteron_count + hysteron_count + hysteron_count;
}

int piezo_stack_newton(const double *restrict x,
                       const double *restrict x_new,
                       const double *restrict u,
                       double h,
                       const piezo_stack_parameters *restrict p_,
                       double *restrict out)
{
    const long hysteron_count = p_->hysteron_count;
    const double M = p_->M;
    const double k = p_->k;
    const double q_l = p_->q_l;
    const double d = p_->d;
    const double C = p_->C;
    const double *restrict L = p_->L;
    const double *restrict rho = p_->rho;
    const double *restrict i_0 = p_->i_0;
    const double a = p_->a;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double lam = p_->lam;
    const double q = x[0];
    const double p = x[1];
    const double Q_C = x[2];
    const double *restrict phi = x + 3;
    const double S = x[3 + hysteron_count];
    const double q_new = x_new[0];
    const double p_new = x_new[1];
    const double Q_C_new = x_new[2];
    const double *restrict phi_new = x_new + 3;
    const double S_new = x_new[3 + hysteron_count];
    const double F_ext = u[0];
    const double V_in = u[1];
    const double T_e = u[2];
    double *restrict kept_reaction_phi_3 = out + 4 + hysteron_count;
    double *restrict kept_reaction_phi_4 = kept_reaction_phi_3 + hysteron_count;
    /* reciprocals */
    const double per_C = 1.0/C;
    const double per_M = 1.0/M;
    const double per_T_0 = 1.0/T_0;
    const double per_c_0 = 1.0/c_0;
    /* before the step */
    const double expm1_S = expm1(S*per_c_0);
    /* mean co-states */
    const double F_spring = k*(0.5*(q + q_new) - q_l);
    const double v_mass = 0.5*((p + p_new)*per_M);
    const double V_capacitor = 0.5*((Q_C + Q_C_new)*per_C);
    /* means of exponentials */
    const double change_T = (S_new - S)*per_c_0;
    const double phi3_T = phi3(change_T);
    const double phi2_T = 0.5 + change_T*phi3_T;
    const double phi1_T = 1.0 + change_T*phi2_T;
    /* co-states dU/dx */
    const double T_minus_T_0 = T_0*expm1_S*phi1_T + T_0*(S_new - S)*per_c_0*phi2_T;
    const double per_T_minus_T_0 = 1.0/T_minus_T_0;
    /* mean co-states */
    const double T = T_0 + T_minus_T_0;
    const double per_T = 1.0/T;
    /* transducer ratios */
    const double alpha_transducer = a*T*per_T_0;
    /* dissipative laws */
    const double F_damper = d*v_mass;
    /* heats */
    const double heat_damper = F_damper*v_mass;
    /* derivatives */
    const double dF_damper_dp_new = 0.5*(d*per_M);
    const double dheat_damper_dp_new = v_mass*dF_damper_dp_new + 0.5*(F_damper*per_M);
    const double dphi2_T_dS_new = (phi2_T - 2.0*phi3_T)*per_c_0;
    const double dphi1_T_dS_new = (phi1_T - phi2_T)*per_c_0;
    const double dT_minus_T_0_dS_new = T_0*expm1_S*dphi1_T_dS_new
        + T_0*per_c_0*phi2_T
        + T_0*(S_new - S)*per_c_0*dphi2_T_dS_new;
    const double dalpha_transducer_dS_new = a*per_T_0*dT_minus_T_0_dS_new;
    /* residuals */
    const double gap_q = q_new - q - h*v_mass;
    const double gap_p = p_new
        - p
        - h*(alpha_transducer*V_capacitor - F_spring - F_damper + F_ext);
    /* Newton's equations, solved */
    const double entry_change_q_2 = -0.5*(h*per_M);
    const double share_change_q_2 = 0.5*(h*k);
    const double pivot_change_p = 1.0
        + h*dF_damper_dp_new
        - share_change_q_2*entry_change_q_2;
    const double per_pivot_change_p = 1.0/pivot_change_p;
    const double entry_change_p_3 = -0.5*(h*alpha_transducer*per_C);
    const double entry_change_p_4 = -h*V_capacitor*dalpha_transducer_dS_new;
    const double right_change_p = gap_p - share_change_q_2*gap_q;
    const double share_change_p_3 = 0.5*(h*alpha_transducer*per_M*per_pivot_change_p);
    const double share_change_p_4 = -h*dheat_damper_dp_new*per_T*per_pivot_change_p;
    /* hysteron: sums over lanes and rows */
    double sum_i_hysteron = 0.0;
    double heat_hysteron = 0.0;
    double dheat_hysteron_dS_new = 0.0;
    double sum_share_phi_3 = 0.0;
    double sum_share_phi_3_3 = 0.0;
    double sum_share_phi_3_4 = 0.0;
    double sum_share_phi_4 = 0.0;
    double sum_share_phi_4_3 = 0.0;
    double sum_share_phi_4_4 = 0.0;
#pragma omp simd reduction(+:sum_i_hysteron, heat_hysteron, dheat_hysteron_dS_new, \
        sum_share_phi_3, sum_share_phi_3_3, sum_share_phi_3_4, sum_share_phi_4, sum_share_phi_4_3, sum_share_phi_4_4)
    for (long j = 0; j < hysteron_count; ++j) {
        const double per_L = 1.0/L[j];
        const double i_hysteron = 0.5*((phi[j] + phi_new[j])*per_L);
        const double i_hysteron_old = phi[j]*per_L;
        const double i_hysteron_new = phi_new[j]*per_L;
        const double V_hysteron = rho[j]*per_T_minus_T_0*mean_deadzone(i_hysteron_old, i_hysteron_new, i_0[j]);
        const double dV_hysteron_dphi_new = rho[j]*per_T_minus_T_0*mean_deadzone_by_new(i_hysteron_old, i_hysteron_new, i_0[j])*per_L;
        const double dheat_hysteron_dphi_new = i_hysteron*dV_hysteron_dphi_new
            + 0.5*(V_hysteron*per_L);
        const double dV_hysteron_dS_new = -V_hysteron*per_T_minus_T_0*dT_minus_T_0_dS_new;
        const double gap_phi = phi_new[j] - phi[j] - h*(V_in - V_capacitor - V_hysteron);
        const double pivot_phi = 1.0 + h*dV_hysteron_dphi_new;
        const double per_pivot_phi = 1.0/pivot_phi;
        const double free_phi = gap_phi*per_pivot_phi;
        const double reaction_phi_3 = 0.5*(h*per_C*per_pivot_phi);
        const double reaction_phi_4 = h*dV_hysteron_dS_new*per_pivot_phi;
        const double share_phi_3 = -0.5*(h*per_L);
        const double share_phi_4 = -h*dheat_hysteron_dphi_new*per_T;
        sum_i_hysteron += i_hysteron;
        heat_hysteron += V_hysteron*i_hysteron;
        dheat_hysteron_dS_new += i_hysteron*dV_hysteron_dS_new;
        sum_share_phi_3 += share_phi_3*free_phi;
        sum_share_phi_3_3 += share_phi_3*reaction_phi_3;
        sum_share_phi_3_4 += share_phi_3*reaction_phi_4;
        sum_share_phi_4 += share_phi_4*free_phi;
        sum_share_phi_4_3 += share_phi_4*reaction_phi_3;
        sum_share_phi_4_4 += share_phi_4*reaction_phi_4;
        kept_reaction_phi_3[j] = reaction_phi_3;
        kept_reaction_phi_4[j] = reaction_phi_4;
        out[3 + j] = free_phi;
    }
    /* residuals */
    const double gap_Q_C = Q_C_new - Q_C - h*(sum_i_hysteron - alpha_transducer*v_mass);
    const double gap_S = S_new
        - S
        - h*((heat_hysteron + heat_damper)*per_T + lam*((T_e - T)*per_T));
    /* Newton's equations, solved */
    const double pivot_change_Q_C = 1.0
        - sum_share_phi_3_3
        - share_change_p_3*entry_change_p_3;
    const double per_pivot_change_Q_C = 1.0/pivot_change_Q_C;
    const double entry_change_Q_C_4 = h*v_mass*dalpha_transducer_dS_new
        - sum_share_phi_3_4
        - share_change_p_3*entry_change_p_4;
    const double right_change_Q_C = gap_Q_C
        - sum_share_phi_3
        - share_change_p_3*right_change_p;
    const double share_change_Q_C_4 = (-sum_share_phi_4_3 - share_change_p_4*entry_change_p_3)*per_pivot_change_Q_C;
    const double pivot_change_S = 1.0
        - h*(dheat_hysteron_dS_new*per_T + (-(heat_hysteron + heat_damper)*per_T*per_T - lam*T_e*per_T*per_T)*dT_minus_T_0_dS_new)
        - sum_share_phi_4_4
        - share_change_p_4*entry_change_p_4
        - share_change_Q_C_4*entry_change_Q_C_4;
    const double right_change_S = gap_S
        - sum_share_phi_4
        - share_change_p_4*right_change_p
        - share_change_Q_C_4*right_change_Q_C;
    const double change_S = right_change_S/pivot_change_S;
    const double change_Q_C = (right_change_Q_C - entry_change_Q_C_4*change_S)*per_pivot_change_Q_C;
    const double change_p = (right_change_p - entry_change_p_3*change_Q_C - entry_change_p_4*change_S)*per_pivot_change_p;
    const double change_q = gap_q - entry_change_q_2*change_p;
    out[0] = change_q;
    out[1] = change_p;
    out[2] = change_Q_C;
    out[3 + hysteron_count] = change_S;
    /* hysteron: reactions */
#pragma omp simd
    for (long j = 0; j < hysteron_count; ++j) {
        out[3 + j] -= kept_reaction_phi_3[j]*change_Q_C + kept_reaction_phi_4[j]*change_S;
    }
    return (pivot_change_p > 0.0) & (pivot_change_Q_C > 0.0) & (pivot_change_S > 0.0);
}

void piezo_stack_means(const double *restrict x,
                       const double *restrict x_new,
                       const double *restrict u,
                       const piezo_stack_parameters *restrict p_,
                       double *restrict out)
{
    const long hysteron_count = p_->hysteron_count;
    const double M = p_->M;
    const double d = p_->d;
    const double *restrict L = p_->L;
    const double *restrict rho = p_->rho;
    const double *restrict i_0 = p_->i_0;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double lam = p_->lam;
    const double p = x[1];
    const double *restrict phi = x + 3;
    const double S = x[3 + hysteron_count];
    const double p_new = x_new[1];
    const double *restrict phi_new = x_new + 3;
    const double S_new = x_new[3 + hysteron_count];
    const double F_ext = u[0];
    const double V_in = u[1];
    const double T_e = u[2];
    /* reciprocals */
    const double per_M = 1.0/M;
    const double per_c_0 = 1.0/c_0;
    /* before the step */
    const double expm1_S = expm1(S*per_c_0);
    /* mean co-states */
    const double v_mass = 0.5*((p + p_new)*per_M);
    /* means of exponentials */
    const double change_T = (S_new - S)*per_c_0;
    const double phi3_T = phi3(change_T);
    const double phi2_T = 0.5 + change_T*phi3_T;
    const double phi1_T = 1.0 + change_T*phi2_T;
    /* co-states dU/dx */
    const double T_minus_T_0 = T_0*expm1_S*phi1_T + T_0*(S_new - S)*per_c_0*phi2_T;
    const double per_T_minus_T_0 = 1.0/T_minus_T_0;
    /* mean co-states */
    const double T = T_0 + T_minus_T_0;
    const double per_T = 1.0/T;
    /* dissipative laws */
    const double F_damper = d*v_mass;
    /* hysteron: sums over lanes and rows */
    double sum_i_hysteron = 0.0;
#pragma omp simd reduction(+:sum_i_hysteron)
    for (long j = 0; j < hysteron_count; ++j) {
        const double per_L = 1.0/L[j];
        const double i_hysteron = 0.5*((phi[j] + phi_new[j])*per_L);
        const double i_hysteron_old = phi[j]*per_L;
        const double i_hysteron_new = phi_new[j]*per_L;
        const double V_hysteron = rho[j]*per_T_minus_T_0*mean_deadzone(i_hysteron_old, i_hysteron_new, i_0[j]);
        sum_i_hysteron += i_hysteron;
        out[3 + j] = V_hysteron*i_hysteron;
        out[4 + hysteron_count + j] = V_hysteron*i_hysteron*per_T;
    }
    out[0] = v_mass*F_ext;
    out[1] = sum_i_hysteron*V_in;
    out[2] = lam*(T_e - T);
    out[3 + hysteron_count] = F_damper*v_mass;
    out[4 + hysteron_count + hysteron_count] = F_damper*v_mass*per_T;
    out[5 + hysteron_count + hysteron_count] = lam*((T_e - T)*per_T);
}

int piezo_stack_inside(const double *restrict x,
                       const double *restrict u,
                       const piezo_stack_parameters *restrict p_)
{
    (void)u;
    const long hysteron_count = p_->hysteron_count;
    const double S = x[3 + hysteron_count];
    const double margin_1_ = S;
    return (margin_1_ > 0.0);
}
