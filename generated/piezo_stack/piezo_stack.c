/*
 * Piezoelectric stack actuator with hysterons: irreversible port-Hamiltonian system.
 *
 * Source:  Caballeria, Ramirez, Le Gorrec (2021), eqs. (9)-(13), Table 1
 * Model:   piezo_stack, spec sha256 9c0235a60e02072bc451611ffa723f273272c8e4536a3089081866f47c89389c
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, energy, entropy, welldef, continuous, passive, odd, sigma, exergy, environment, invariant, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (q, p, Q_C, phi_1 ... phi_hysteron_count, S)
 * u = (F_ext, V_in, T_e)
 * p_ = pointer to piezo_stack_parameters; the underscore tells it from p, a name of the model
 * bank hysteron: lanes j = 1 ... hysteron_count
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

/* Number of processes, which produce entropy; of a bank, one per lane. */
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
    /* each lane of hysteron: result */
#pragma omp simd
    for (long j = 0; j < hysteron_count; ++j) {
        out[3 + j] = 0.0;
    }
    /* result */
    out[0] = 0.0;
    out[1] = 0.0;
    out[2] = 0.0;
    out[3 + hysteron_count] = c_0*log(T_e/T_0);
}

/* Rates dx/dt, the rows of J_ir dU/dx + g u. */
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
    const double *restrict phi = x + 3;
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
    /* each lane of hysteron: sums over lanes and result */
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
    /* result */
    out[0] = v_mass;
    out[1] = alpha_transducer*V_capacitor - F_spring - F_damper + F_ext;
    out[2] = sum_i_hysteron - alpha_transducer*v_mass;
    out[3 + hysteron_count] = (heat_hysteron + heat_damper)/T + lam*(T_e/T - 1.0);
}

/* Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient. */
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
    const double *restrict phi = x + 3;
    const double S = x[3 + hysteron_count];
    /* co-states dU/dx */
    const double v_mass = p/M;
    const double T_minus_T_0 = T_0*expm1(S/c_0);
    const double T = T_0 + T_minus_T_0;
    /* each lane of hysteron: sums over lanes */
    double sum_i_hysteron = 0.0;
#pragma omp simd reduction(+:sum_i_hysteron)
    for (long j = 0; j < hysteron_count; ++j) {
        const double i_hysteron = phi[j]/L[j];
        sum_i_hysteron += i_hysteron;
    }
    /* result */
    out[0] = v_mass;
    out[1] = sum_i_hysteron;
    out[2] = T;
}

/* Power supplied through each port [W]; the sum is dU/dt. */
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
    const double *restrict phi = x + 3;
    const double S = x[3 + hysteron_count];
    const double F_ext = u[0];
    const double V_in = u[1];
    const double T_e = u[2];
    /* co-states dU/dx */
    const double v_mass = p/M;
    const double T_minus_T_0 = T_0*expm1(S/c_0);
    const double T = T_0 + T_minus_T_0;
    /* each lane of hysteron: sums over lanes */
    double sum_i_hysteron = 0.0;
#pragma omp simd reduction(+:sum_i_hysteron)
    for (long j = 0; j < hysteron_count; ++j) {
        const double i_hysteron = phi[j]/L[j];
        sum_i_hysteron += i_hysteron;
    }
    /* result */
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
    const double *restrict phi = x + 3;
    const double S = x[3 + hysteron_count];
    /* each lane of hysteron: sums over lanes */
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
    /* result */
    out[0] = T;
}

/* Power that each process turns into heat [W]; of a bank, one row per lane. */
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
    const double *restrict phi = x + 3;
    const double S = x[3 + hysteron_count];
    /* co-states dU/dx */
    const double v_mass = p/M;
    const double T_minus_T_0 = T_0*expm1(S/c_0);
    /* dissipative laws */
    const double F_damper = d*v_mass;
    /* each lane of hysteron: result */
#pragma omp simd
    for (long j = 0; j < hysteron_count; ++j) {
        const double i_hysteron = phi[j]/L[j];
        const double V_hysteron = pick(
            fabs(i_hysteron) <= i_0[j],
            0.0,
            rho[j]/T_minus_T_0*(i_hysteron - copysign(i_0[j], i_hysteron)));
        out[j] = V_hysteron*i_hysteron;
    }
    /* result */
    out[hysteron_count] = F_damper*v_mass;
}

/*
 * Entropy production of each process [W/K], heat exchange with ambients not included; of a
 * bank, one row per lane.
 */
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
    const double *restrict phi = x + 3;
    const double S = x[3 + hysteron_count];
    /* co-states dU/dx */
    const double v_mass = p/M;
    const double T_minus_T_0 = T_0*expm1(S/c_0);
    const double T = T_0 + T_minus_T_0;
    /* dissipative laws */
    const double F_damper = d*v_mass;
    /* each lane of hysteron: result */
#pragma omp simd
    for (long j = 0; j < hysteron_count; ++j) {
        const double i_hysteron = phi[j]/L[j];
        const double V_hysteron = pick(
            fabs(i_hysteron) <= i_0[j],
            0.0,
            rho[j]/T_minus_T_0*(i_hysteron - copysign(i_0[j], i_hysteron)));
        out[j] = V_hysteron*i_hysteron/T;
    }
    /* result */
    out[hysteron_count] = F_damper*v_mass/T;
}

/* Effort, flow, power, energy and heat of elements; of a bank, one row per lane. */
void piezo_stack_elements(const double *restrict x,
                          const double *restrict u,
                          const piezo_stack_parameters *restrict p_,
                          double *restrict out)
{
    const long hysteron_count = p_->hysteron_count;
    const long end_out_hysteron_effort = 12 + hysteron_count;
    const long end_out_hysteron_flow = end_out_hysteron_effort + hysteron_count;
    const long end_out_hysteron_power = end_out_hysteron_flow + hysteron_count;
    const long end_out_hysteron_energy = end_out_hysteron_power + hysteron_count;
    const long end_out_hysteron_heat = end_out_hysteron_energy + hysteron_count;
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
    /* rates */
    const double rate_p = alpha_transducer*V_capacitor - F_spring - F_damper + F_ext;
    /* each lane of hysteron: sums over lanes and result */
    double sum_i_hysteron = 0.0;
    double heat_hysteron = 0.0;
#pragma omp simd reduction(+:sum_i_hysteron, heat_hysteron)
    for (long j = 0; j < hysteron_count; ++j) {
        const double i_hysteron = phi[j]/L[j];
        const double V_hysteron = pick(
            fabs(i_hysteron) <= i_0[j],
            0.0,
            rho[j]/T_minus_T_0*(i_hysteron - copysign(i_0[j], i_hysteron)));
        const double rate_phi = V_in - V_capacitor - V_hysteron;
        sum_i_hysteron += i_hysteron;
        heat_hysteron += V_hysteron*i_hysteron;
        out[12 + j] = rate_phi + V_hysteron;
        out[end_out_hysteron_effort + j] = i_hysteron;
        out[end_out_hysteron_flow + j] = (rate_phi + V_hysteron)*i_hysteron;
        out[end_out_hysteron_power + j] = power_2(phi[j])/(2.0*L[j]);
        out[end_out_hysteron_energy + j] = V_hysteron*i_hysteron;
    }
    /* rates */
    const double rate_Q_C = sum_i_hysteron - alpha_transducer*v_mass;
    const double rate_S = (heat_hysteron + heat_damper)/T + lam*(T_e/T - 1.0);
    /* result */
    out[0] = F_spring;
    out[1] = v_mass;
    out[2] = F_spring*v_mass;
    out[3] = k*power_2(q - q_l)/2.0;
    out[4] = rate_p;
    out[5] = v_mass;
    out[6] = rate_p*v_mass;
    out[7] = power_2(p)/(2.0*M);
    out[8] = V_capacitor;
    out[9] = rate_Q_C;
    out[10] = V_capacitor*rate_Q_C;
    out[11] = power_2(Q_C)/(2.0*C);
    out[end_out_hysteron_heat] = F_damper;
    out[1 + end_out_hysteron_heat] = v_mass;
    out[2 + end_out_hysteron_heat] = F_damper*v_mass;
    out[3 + end_out_hysteron_heat] = F_damper*v_mass;
    out[4 + end_out_hysteron_heat] = V_capacitor;
    out[5 + end_out_hysteron_heat] = alpha_transducer*v_mass;
    out[6 + end_out_hysteron_heat] = -alpha_transducer*V_capacitor;
    out[7 + end_out_hysteron_heat] = v_mass;
    out[8 + end_out_hysteron_heat] = V_capacitor*alpha_transducer*v_mass;
    out[9 + end_out_hysteron_heat] = T;
    out[10 + end_out_hysteron_heat] = rate_S;
    out[11 + end_out_hysteron_heat] = T*rate_S;
    out[12 + end_out_hysteron_heat] = T_0*c_0*exp(S/c_0);
    out[13 + end_out_hysteron_heat] = T;
    out[14 + end_out_hysteron_heat] = -lam*(T_e/T - 1.0);
    out[15 + end_out_hysteron_heat] = -lam*(T_e - T);
    out[16 + end_out_hysteron_heat] = -F_ext;
    out[17 + end_out_hysteron_heat] = v_mass;
    out[18 + end_out_hysteron_heat] = -v_mass*F_ext;
    out[19 + end_out_hysteron_heat] = V_in;
    out[20 + end_out_hysteron_heat] = -sum_i_hysteron;
    out[21 + end_out_hysteron_heat] = -sum_i_hysteron*V_in;
}

/* Jacobian of rhs, n x n, row after row: d rhs[i]/d x[j] at out[i*n + j]. */
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
    const double *restrict phi = x + 3;
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
    /* each lane of hysteron: sums over lanes and result */
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
    /* result */
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

/* Margin by which each condition of the domain holds; of a bank, the least one. */
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
    /* each lane of hysteron: result */
    out[3] = HUGE_VAL;
    out[4] = HUGE_VAL;
    out[9] = HUGE_VAL;
    for (long j = 0; j < hysteron_count; ++j) {
        out[3] = min(out[3], rho[j]);
        out[4] = min(out[4], i_0[j]);
        out[9] = min(out[9], L[j]);
    }
    /* result */
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
