/*
 * Piezoelectric stack actuator with hysterons: irreversible port-Hamiltonian system.
 *
 * Source:  Caballeria, Ramirez, Le Gorrec (2021), eqs. (9)-(13), Table 1
 * Model:   piezo_stack, spec sha256 9c0235a60e02072bc451611ffa723f273272c8e4536a3089081866f47c89389c
 * Proofs:  skew, casimir, temperature, energy, entropy, welldef, continuous, passive, odd, sigma, exergy, environment, invariant, units PROVED
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
        const double V_hysteron = fabs(i_hysteron) <= i_0[j]
            ? 0.0
            : rho[j]/T_minus_T_0*(i_hysteron - copysign(i_0[j], i_hysteron));
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
        const double V_hysteron = fabs(i_hysteron) <= i_0[j]
            ? 0.0
            : rho[j]/T_minus_T_0*(i_hysteron - copysign(i_0[j], i_hysteron));
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
        const double V_hysteron = fabs(i_hysteron) <= i_0[j]
            ? 0.0
            : rho[j]/T_minus_T_0*(i_hysteron - copysign(i_0[j], i_hysteron));
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
        const double V_hysteron = fabs(i_hysteron) <= i_0[j]
            ? 0.0
            : rho[j]/T_minus_T_0*(i_hysteron - copysign(i_0[j], i_hysteron));
        const double dV_hysteron_dphi = (fabs(i_hysteron) > i_0[j] ? rho[j]/T_minus_T_0 : 0.0)/L[j];
        const double dheat_hysteron_dphi = i_hysteron*dV_hysteron_dphi + V_hysteron/L[j];
        const double dV_hysteron_dS = fabs(i_hysteron) <= i_0[j]
            ? 0.0
            : -rho[j]/power_2(T_minus_T_0)*(i_hysteron - copysign(i_0[j], i_hysteron))*dT_minus_T_0_dS;
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

/* (exp(d) - 1 - d)/d^2, by its series where that would cancel. */
static double phi2(double d)
{
    double sum = 0.0;
    if (fabs(d) < 0.03125)
        return 0.5 + d*(1.0/6.0 + d*(1.0/24.0 + d*(1.0/120.0 + d*(1.0/720.0 + d*(1.0/5040.0
            + d*(1.0/40320.0 + d*(1.0/362880.0 + d/3628800.0)))))));
    if (fabs(d) >= 1.0)
        return ((exp(d) - 1.0)/d - 1.0)/d;
    for (int k = 19; k > 1; --k)
        sum = (1.0 + sum)*d/(k + 1);
    return 0.5*(1.0 + sum);
}

/* (exp(d) - 1)/d */
static double phi1(double d)
{
    return fabs(d) < 0.03125 ? 1.0 + d*phi2(d) : expm1(d)/d;
}

/* (phi2(d) - 1/2)/d */
static double phi3(double d)
{
    double sum = 0.0;
    if (fabs(d) < 0.03125)
        return 1.0/6.0 + d*(1.0/24.0 + d*(1.0/120.0 + d*(1.0/720.0 + d*(1.0/5040.0
            + d*(1.0/40320.0 + d*(1.0/362880.0 + d/3628800.0))))));
    if (fabs(d) >= 1.0)
        return (phi2(d) - 0.5)/d;
    for (int k = 19; k > 2; --k)
        sum = (1.0 + sum)*d/(k + 1);
    return (1.0 + sum)/6.0;
}

/* Mean of max(s, 0) for s from a to b. */
static double ramp(double a, double b)
{
    const double top = a > b ? a : b, low = a > b ? b : a;
    return low >= 0.0 ? 0.5 * (a + b) : top <= 0.0 ? 0.0 : 0.5 * top * top / (top - low);
}

/* Derivative of ramp by b. */
static double ramp_by_new(double a, double b)
{
    const double top = a > b ? a : b, low = a > b ? b : a;
    const double share = top <= 0.0 ? 0.0 : top / (top - low);
    return low >= 0.0 ? 0.5 : b > a ? share - 0.5 * share * share : 0.5 * share * share;
}

/* Solve a*y = b for y, in place of b, by elimination with pivots; 0 if a is singular. */
static int piezo_stack_solve_(double *restrict a, double *restrict b)
{
    enum { size = 4 };
    for (int k = 0; k < size; ++k) {
        int best = k;
        for (int i = k + 1; i < size; ++i)
            best = fabs(a[i * size + k]) > fabs(a[best * size + k]) ? i : best;
        const double pivot = a[best * size + k];
        if (!(fabs(pivot) > 0.0))
            return 0;
        if (best != k) {
            for (int j = k; j < size; ++j) {
                const double kept = a[k * size + j];
                a[k * size + j] = a[best * size + j];
                a[best * size + j] = kept;
            }
            const double kept = b[k];
            b[k] = b[best];
            b[best] = kept;
        }
        for (int i = k + 1; i < size; ++i) {
            const double share = a[i * size + k] / pivot;
            for (int j = k + 1; j < size; ++j)
                a[i * size + j] -= share * a[k * size + j];
            b[i] -= share * b[k];
        }
    }
    for (int k = size - 1; k >= 0; --k) {
        for (int j = k + 1; j < size; ++j)
            b[k] -= a[k * size + j] * b[j];
        b[k] /= a[k * size + k];
    }
    return 1;
}

int piezo_stack_newton(const double *x,
                       const double *x_new,
                       const double *u,
                       double h,
                       const piezo_stack_parameters *p_,
                       double *out)
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
    /* mean co-states */
    const double F_spring = k*(0.5*(q + q_new) - q_l);
    const double v_mass = 0.5*(p + p_new)/M;
    const double V_capacitor = 0.5*(Q_C + Q_C_new)/C;
    /* means of exponentials */
    const double change_T = (S_new - S)/c_0;
    const double phi1_T = phi1(change_T);
    const double phi2_T = phi2(change_T);
    const double phi3_T = phi3(change_T);
    /* co-states dU/dx */
    const double T_minus_T_0 = T_0*expm1(S/c_0)*phi1_T + T_0*(S_new - S)/c_0*phi2_T;
    /* mean co-states */
    const double T = T_0 + T_minus_T_0;
    /* transducer ratios */
    const double alpha_transducer = a*T/T_0;
    /* dissipative laws */
    const double F_damper = d*v_mass;
    /* heats */
    const double heat_damper = F_damper*v_mass;
    /* derivatives */
    const double dF_damper_dp_new = 0.5*d/M;
    const double dheat_damper_dp_new = v_mass*dF_damper_dp_new + 0.5*F_damper/M;
    const double dphi1_T_dS_new = (phi1_T - phi2_T)/c_0;
    const double dphi2_T_dS_new = (phi2_T - 2.0*phi3_T)/c_0;
    const double dT_minus_T_0_dS_new = T_0*expm1(S/c_0)*dphi1_T_dS_new
        + T_0/c_0*phi2_T
        + T_0*(S_new - S)/c_0*dphi2_T_dS_new;
    const double dalpha_transducer_dS_new = a/T_0*dT_minus_T_0_dS_new;
    /* residuals */
    const double gap_q = q_new - q - h*v_mass;
    const double gap_p = p_new
        - p
        - h*(alpha_transducer*V_capacitor - F_spring - F_damper + F_ext);
    /* hysteron: sums over lanes */
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
        const double i_hysteron = 0.5*(phi[j] + phi_new[j])/L[j];
        const double i_hysteron_old = phi[j]/L[j];
        const double i_hysteron_new = phi_new[j]/L[j];
        const double V_hysteron = rho[j]/T_minus_T_0*(ramp(i_hysteron_old - i_0[j], i_hysteron_new - i_0[j]) - ramp(-(i_hysteron_old + i_0[j]), -(i_hysteron_new + i_0[j])));
        const double dV_hysteron_dphi_new = rho[j]/T_minus_T_0*(ramp_by_new(i_hysteron_old - i_0[j], i_hysteron_new - i_0[j]) + ramp_by_new(-(i_hysteron_old + i_0[j]), -(i_hysteron_new + i_0[j])))/L[j];
        const double dheat_hysteron_dphi_new = i_hysteron*dV_hysteron_dphi_new
            + 0.5*V_hysteron/L[j];
        const double dV_hysteron_dS_new = -rho[j]/power_2(T_minus_T_0)*(ramp(i_hysteron_old - i_0[j], i_hysteron_new - i_0[j]) - ramp(-(i_hysteron_old + i_0[j]), -(i_hysteron_new + i_0[j])))*dT_minus_T_0_dS_new;
        const double gap_phi = phi_new[j] - phi[j] - h*(V_in - V_capacitor - V_hysteron);
        const double pivot_phi = 1.0 + h*dV_hysteron_dphi_new;
        const double share_phi_3 = -0.5*h/L[j]/pivot_phi;
        const double share_phi_4 = -h*dheat_hysteron_dphi_new/T/pivot_phi;
        sum_i_hysteron += i_hysteron;
        heat_hysteron += V_hysteron*i_hysteron;
        dheat_hysteron_dS_new += i_hysteron*dV_hysteron_dS_new;
        sum_share_phi_3 += share_phi_3*gap_phi;
        sum_share_phi_3_3 += 0.5*(share_phi_3*h)/C;
        sum_share_phi_3_4 += share_phi_3*h*dV_hysteron_dS_new;
        sum_share_phi_4 += share_phi_4*gap_phi;
        sum_share_phi_4_3 += 0.5*(share_phi_4*h)/C;
        sum_share_phi_4_4 += share_phi_4*h*dV_hysteron_dS_new;
    }
    /* residuals */
    const double gap_Q_C = Q_C_new - Q_C - h*(sum_i_hysteron - alpha_transducer*v_mass);
    const double gap_S = S_new
        - S
        - h*((heat_hysteron + heat_damper)/T + lam*(T_e/T - 1.0));
    double matrix[16] = {0.0};
    matrix[0] = 1.0;
    matrix[1] = -0.5*h/M;
    matrix[4] = 0.5*(h*k);
    matrix[5] = 1.0 + h*dF_damper_dp_new;
    matrix[6] = -0.5*(h*alpha_transducer)/C;
    matrix[7] = -h*V_capacitor*dalpha_transducer_dS_new;
    matrix[9] = 0.5*(h*alpha_transducer)/M;
    matrix[10] = 1.0 - sum_share_phi_3_3;
    matrix[11] = h*v_mass*dalpha_transducer_dS_new - sum_share_phi_3_4;
    matrix[13] = -h*dheat_damper_dp_new/T;
    matrix[14] = -sum_share_phi_4_3;
    matrix[15] = 1.0
        - h*(dheat_hysteron_dS_new/T + (-(heat_hysteron + heat_damper)/power_2(T) - lam*T_e/power_2(T))*dT_minus_T_0_dS_new)
        - sum_share_phi_4_4;
    double right[4];
    right[0] = gap_q;
    right[1] = gap_p;
    right[2] = gap_Q_C - sum_share_phi_3;
    right[3] = gap_S - sum_share_phi_4;
    if (!piezo_stack_solve_(matrix, right))
        return 0;
    const double change_q = right[0];
    const double change_p = right[1];
    const double change_Q_C = right[2];
    const double change_S = right[3];
    out[0] = change_q;
    out[1] = change_p;
    out[2] = change_Q_C;
    out[3 + hysteron_count] = change_S;
    /* hysteron: rows */
#pragma omp simd
    for (long j = 0; j < hysteron_count; ++j) {
        const double i_hysteron_old = phi[j]/L[j];
        const double i_hysteron_new = phi_new[j]/L[j];
        const double V_hysteron = rho[j]/T_minus_T_0*(ramp(i_hysteron_old - i_0[j], i_hysteron_new - i_0[j]) - ramp(-(i_hysteron_old + i_0[j]), -(i_hysteron_new + i_0[j])));
        const double dV_hysteron_dphi_new = rho[j]/T_minus_T_0*(ramp_by_new(i_hysteron_old - i_0[j], i_hysteron_new - i_0[j]) + ramp_by_new(-(i_hysteron_old + i_0[j]), -(i_hysteron_new + i_0[j])))/L[j];
        const double dV_hysteron_dS_new = -rho[j]/power_2(T_minus_T_0)*(ramp(i_hysteron_old - i_0[j], i_hysteron_new - i_0[j]) - ramp(-(i_hysteron_old + i_0[j]), -(i_hysteron_new + i_0[j])))*dT_minus_T_0_dS_new;
        const double gap_phi = phi_new[j] - phi[j] - h*(V_in - V_capacitor - V_hysteron);
        const double pivot_phi = 1.0 + h*dV_hysteron_dphi_new;
        out[3 + j] = (gap_phi - 0.5*h/C*change_Q_C - h*dV_hysteron_dS_new*change_S)/pivot_phi;
    }
    return 1;
}

void piezo_stack_means(const double *x,
                       const double *x_new,
                       const double *u,
                       const piezo_stack_parameters *p_,
                       double *out)
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
    /* mean co-states */
    const double v_mass = 0.5*(p + p_new)/M;
    /* means of exponentials */
    const double change_T = (S_new - S)/c_0;
    const double phi1_T = phi1(change_T);
    const double phi2_T = phi2(change_T);
    /* co-states dU/dx */
    const double T_minus_T_0 = T_0*expm1(S/c_0)*phi1_T + T_0*(S_new - S)/c_0*phi2_T;
    /* mean co-states */
    const double T = T_0 + T_minus_T_0;
    /* dissipative laws */
    const double F_damper = d*v_mass;
    /* hysteron: sums over lanes and rows */
    double sum_i_hysteron = 0.0;
#pragma omp simd reduction(+:sum_i_hysteron)
    for (long j = 0; j < hysteron_count; ++j) {
        const double i_hysteron = 0.5*(phi[j] + phi_new[j])/L[j];
        const double i_hysteron_old = phi[j]/L[j];
        const double i_hysteron_new = phi_new[j]/L[j];
        const double V_hysteron = rho[j]/T_minus_T_0*(ramp(i_hysteron_old - i_0[j], i_hysteron_new - i_0[j]) - ramp(-(i_hysteron_old + i_0[j]), -(i_hysteron_new + i_0[j])));
        sum_i_hysteron += i_hysteron;
        out[3 + j] = V_hysteron*i_hysteron;
        out[4 + hysteron_count + j] = V_hysteron*i_hysteron/T;
    }
    out[0] = v_mass*F_ext;
    out[1] = sum_i_hysteron*V_in;
    out[2] = lam*(T_e - T);
    out[3 + hysteron_count] = F_damper*v_mass;
    out[4 + hysteron_count + hysteron_count] = F_damper*v_mass/T;
    out[5 + hysteron_count + hysteron_count] = lam*(T_e/T - 1.0);
}

int piezo_stack_inside(const double *x,
                       const double *u,
                       const piezo_stack_parameters *p_)
{
    (void)u;
    const long hysteron_count = p_->hysteron_count;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double S = x[3 + hysteron_count];
    /* co-states dU/dx */
    const double T_minus_T_0 = T_0*expm1(S/c_0);
    const double margin_1_ = T_minus_T_0;
    return margin_1_ > 0.0;
}
