/*
 * Piezoelectric stack with Maxwell-slip: 40 um at 150 V: irreversible port-Hamiltonian system.
 *
 * Source:  Goldfarb, Celanovic (1997), Modeling piezoelectric stack actuators; loop measured by Chandra et al. (2023), doi 10.1063/5.0146134
 * Model:   stack_maxwell, spec sha256 a4fac994b19a17a907de6d8bbc2fec285a640ebfd27501f5fec69ade7095faff
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, rate-independent, sigma, exergy, environment, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (Q, p, q, z_1 ... z_slips_count, S)
 * u = (F_ext, V_in, T_e)
 * p_ = pointer to stack_maxwell_parameters; the underscore tells it from p, a name of the model
 * bank slips: lanes j = 1 ... slips_count
 */
#include "stack_maxwell.h"

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
long stack_maxwell_states(const stack_maxwell_parameters *restrict p_)
{
    const long slips_count = p_->slips_count;
    return 4 + slips_count;
}

/* Number of processes, which produce entropy; of a bank, one per lane. */
long stack_maxwell_processes(const stack_maxwell_parameters *restrict p_)
{
    const long slips_count = p_->slips_count;
    return 2 + slips_count;
}

/* State at t = 0 [SI], for the inputs u at t = 0. */
void stack_maxwell_initial_state(const double *restrict u,
                                 const stack_maxwell_parameters *restrict p_,
                                 double *restrict out)
{
    const long slips_count = p_->slips_count;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double T_e = u[2];
    /* each lane of slips: result */
#pragma omp simd
    for (long j = 0; j < slips_count; ++j) {
        out[3 + j] = 0.0;
    }
    /* result */
    out[0] = 0.0;
    out[1] = 0.0;
    out[2] = 0.0;
    out[3 + slips_count] = c_0*log(T_e/T_0);
}

/* Rates dx/dt, the rows of J_ir dU/dx + g u. */
void stack_maxwell_rhs(const double *restrict x,
                       const double *restrict u,
                       const stack_maxwell_parameters *restrict p_,
                       double *restrict out)
{
    const long slips_count = p_->slips_count;
    const double m = p_->m;
    const double d = p_->d;
    const double a = p_->a;
    const double C = p_->C;
    const double R = p_->R;
    const double k = p_->k;
    const double *restrict k_s = p_->k_s;
    const double *restrict r = p_->r;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double lam = p_->lam;
    const double Q = x[0];
    const double p = x[1];
    const double q = x[2];
    const double *restrict z = x + 3;
    const double S = x[3 + slips_count];
    const double F_ext = u[0];
    const double V_in = u[1];
    const double T_e = u[2];
    /* co-states dU/dx */
    const double V_clamped = Q/C;
    const double v_mass = p/m;
    const double F_spring = k*q;
    const double T = T_0*exp(S/c_0);
    /* transducer ratios */
    const double alpha_ceramic = a;
    /* driving forces */
    const double V_leads = -V_clamped + V_in;
    /* dissipative laws */
    const double i_leads = V_leads/R;
    const double F_damper = d*v_mass;
    /* heats */
    const double heat_leads = i_leads*V_leads;
    const double heat_damper = F_damper*v_mass;
    /* each lane of slips: sums over lanes and result */
    double sum_F_slips = 0.0;
    double heat_slips = 0.0;
#pragma omp simd reduction(+:sum_F_slips, heat_slips)
    for (long j = 0; j < slips_count; ++j) {
        const double F_slips = k_s[j]*z[j];
        const double slip_slips = pick(
            v_mass > 0.0,
            pick(F_slips >= k_s[j]*r[j], v_mass, 0.0),
            pick(F_slips <= -k_s[j]*r[j], v_mass, 0.0));
        sum_F_slips += F_slips;
        heat_slips += slip_slips*F_slips;
        out[3 + j] = v_mass - slip_slips;
    }
    /* result */
    out[0] = i_leads - alpha_ceramic*v_mass;
    out[1] = alpha_ceramic*V_clamped - F_spring - sum_F_slips - F_damper + F_ext;
    out[2] = v_mass;
    out[3 + slips_count] = (heat_leads + heat_slips + heat_damper)/T + lam*(T_e/T - 1.0);
}

/* Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient. */
void stack_maxwell_outputs(const double *restrict x,
                           const double *restrict u,
                           const stack_maxwell_parameters *restrict p_,
                           double *restrict out)
{
    const long slips_count = p_->slips_count;
    const double m = p_->m;
    const double C = p_->C;
    const double R = p_->R;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double Q = x[0];
    const double p = x[1];
    const double S = x[3 + slips_count];
    const double V_in = u[1];
    /* co-states dU/dx */
    const double V_clamped = Q/C;
    const double v_mass = p/m;
    const double T = T_0*exp(S/c_0);
    /* driving forces */
    const double V_leads = -V_clamped + V_in;
    /* dissipative laws */
    const double i_leads = V_leads/R;
    /* result */
    out[0] = v_mass;
    out[1] = i_leads;
    out[2] = T;
}

/* Power supplied through each port [W]; the sum is dU/dt. */
void stack_maxwell_supply(const double *restrict x,
                          const double *restrict u,
                          const stack_maxwell_parameters *restrict p_,
                          double *restrict out)
{
    const long slips_count = p_->slips_count;
    const double m = p_->m;
    const double C = p_->C;
    const double R = p_->R;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double lam = p_->lam;
    const double Q = x[0];
    const double p = x[1];
    const double S = x[3 + slips_count];
    const double F_ext = u[0];
    const double V_in = u[1];
    const double T_e = u[2];
    /* co-states dU/dx */
    const double V_clamped = Q/C;
    const double v_mass = p/m;
    const double T = T_0*exp(S/c_0);
    /* driving forces */
    const double V_leads = -V_clamped + V_in;
    /* dissipative laws */
    const double i_leads = V_leads/R;
    /* result */
    out[0] = v_mass*F_ext;
    out[1] = i_leads*V_in;
    out[2] = lam*(T_e - T);
}

/* Hamiltonian U [J]. */
double stack_maxwell_energy(const double *restrict x,
                            const stack_maxwell_parameters *restrict p_)
{
    const long slips_count = p_->slips_count;
    const double m = p_->m;
    const double C = p_->C;
    const double k = p_->k;
    const double *restrict k_s = p_->k_s;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double Q = x[0];
    const double p = x[1];
    const double q = x[2];
    const double *restrict z = x + 3;
    const double S = x[3 + slips_count];
    /* each lane of slips: sums over lanes */
    double energy_z = 0.0;
#pragma omp simd reduction(+:energy_z)
    for (long j = 0; j < slips_count; ++j) {
        energy_z += k_s[j]*power_2(z[j])/2.0;
    }
    return power_2(Q)/(2.0*C)
        + power_2(p)/(2.0*m)
        + k*power_2(q)/2.0
        + energy_z
        + T_0*c_0*exp(S/c_0);
}

/* Total entropy S [J/K]. */
double stack_maxwell_entropy(const double *restrict x,
                             const stack_maxwell_parameters *restrict p_)
{
    const long slips_count = p_->slips_count;
    const double S = x[3 + slips_count];
    return S;
}

/* Temperature of each body [K]. */
void stack_maxwell_temperatures(const double *restrict x,
                                const stack_maxwell_parameters *restrict p_,
                                double *restrict out)
{
    const long slips_count = p_->slips_count;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double S = x[3 + slips_count];
    /* co-states dU/dx */
    const double T = T_0*exp(S/c_0);
    /* result */
    out[0] = T;
}

/* Power that each process turns into heat [W]; of a bank, one row per lane. */
void stack_maxwell_heat(const double *restrict x,
                        const double *restrict u,
                        const stack_maxwell_parameters *restrict p_,
                        double *restrict out)
{
    const long slips_count = p_->slips_count;
    const double m = p_->m;
    const double d = p_->d;
    const double C = p_->C;
    const double R = p_->R;
    const double *restrict k_s = p_->k_s;
    const double *restrict r = p_->r;
    const double Q = x[0];
    const double p = x[1];
    const double *restrict z = x + 3;
    const double V_in = u[1];
    /* co-states dU/dx */
    const double V_clamped = Q/C;
    const double v_mass = p/m;
    /* driving forces */
    const double V_leads = -V_clamped + V_in;
    /* dissipative laws */
    const double i_leads = V_leads/R;
    const double F_damper = d*v_mass;
    /* each lane of slips: result */
#pragma omp simd
    for (long j = 0; j < slips_count; ++j) {
        const double F_slips = k_s[j]*z[j];
        const double slip_slips = pick(
            v_mass > 0.0,
            pick(F_slips >= k_s[j]*r[j], v_mass, 0.0),
            pick(F_slips <= -k_s[j]*r[j], v_mass, 0.0));
        out[1 + j] = slip_slips*F_slips;
    }
    /* result */
    out[0] = i_leads*V_leads;
    out[1 + slips_count] = F_damper*v_mass;
}

/*
 * Entropy production of each process [W/K], heat exchange with ambients not included; of a
 * bank, one row per lane.
 */
void stack_maxwell_entropy_production(const double *restrict x,
                                      const double *restrict u,
                                      const stack_maxwell_parameters *restrict p_,
                                      double *restrict out)
{
    const long slips_count = p_->slips_count;
    const double m = p_->m;
    const double d = p_->d;
    const double C = p_->C;
    const double R = p_->R;
    const double *restrict k_s = p_->k_s;
    const double *restrict r = p_->r;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double Q = x[0];
    const double p = x[1];
    const double *restrict z = x + 3;
    const double S = x[3 + slips_count];
    const double V_in = u[1];
    /* co-states dU/dx */
    const double V_clamped = Q/C;
    const double v_mass = p/m;
    const double T = T_0*exp(S/c_0);
    /* driving forces */
    const double V_leads = -V_clamped + V_in;
    /* dissipative laws */
    const double i_leads = V_leads/R;
    const double F_damper = d*v_mass;
    /* each lane of slips: result */
#pragma omp simd
    for (long j = 0; j < slips_count; ++j) {
        const double F_slips = k_s[j]*z[j];
        const double slip_slips = pick(
            v_mass > 0.0,
            pick(F_slips >= k_s[j]*r[j], v_mass, 0.0),
            pick(F_slips <= -k_s[j]*r[j], v_mass, 0.0));
        out[1 + j] = slip_slips*F_slips/T;
    }
    /* result */
    out[0] = i_leads*V_leads/T;
    out[1 + slips_count] = F_damper*v_mass/T;
}

/* Effort, flow, power, energy and heat of elements; of a bank, one row per lane. */
void stack_maxwell_elements(const double *restrict x,
                            const double *restrict u,
                            const stack_maxwell_parameters *restrict p_,
                            double *restrict out)
{
    const long slips_count = p_->slips_count;
    const long end_out_slips_effort = 24 + slips_count;
    const long end_out_slips_flow = end_out_slips_effort + slips_count;
    const long end_out_slips_power = end_out_slips_flow + slips_count;
    const long end_out_slips_energy = end_out_slips_power + slips_count;
    const long end_out_slips_heat = end_out_slips_energy + slips_count;
    const long end_out_slips_limit = end_out_slips_heat + slips_count;
    const double m = p_->m;
    const double d = p_->d;
    const double a = p_->a;
    const double C = p_->C;
    const double R = p_->R;
    const double k = p_->k;
    const double *restrict k_s = p_->k_s;
    const double *restrict r = p_->r;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double lam = p_->lam;
    const double Q = x[0];
    const double p = x[1];
    const double q = x[2];
    const double *restrict z = x + 3;
    const double S = x[3 + slips_count];
    const double F_ext = u[0];
    const double V_in = u[1];
    const double T_e = u[2];
    /* co-states dU/dx */
    const double V_clamped = Q/C;
    const double v_mass = p/m;
    const double F_spring = k*q;
    const double T = T_0*exp(S/c_0);
    /* transducer ratios */
    const double alpha_ceramic = a;
    /* driving forces */
    const double V_leads = -V_clamped + V_in;
    /* dissipative laws */
    const double i_leads = V_leads/R;
    const double F_damper = d*v_mass;
    /* heats */
    const double heat_leads = i_leads*V_leads;
    const double heat_damper = F_damper*v_mass;
    /* rates */
    const double rate_Q = i_leads - alpha_ceramic*v_mass;
    /* each lane of slips: sums over lanes and result */
    double sum_F_slips = 0.0;
    double heat_slips = 0.0;
#pragma omp simd reduction(+:sum_F_slips, heat_slips)
    for (long j = 0; j < slips_count; ++j) {
        const double F_slips = k_s[j]*z[j];
        const double slip_slips = pick(
            v_mass > 0.0,
            pick(F_slips >= k_s[j]*r[j], v_mass, 0.0),
            pick(F_slips <= -k_s[j]*r[j], v_mass, 0.0));
        const double rate_z = v_mass - slip_slips;
        sum_F_slips += F_slips;
        heat_slips += slip_slips*F_slips;
        out[24 + j] = F_slips;
        out[end_out_slips_effort + j] = rate_z + slip_slips;
        out[end_out_slips_flow + j] = F_slips*(rate_z + slip_slips);
        out[end_out_slips_power + j] = k_s[j]*power_2(z[j])/2.0;
        out[end_out_slips_energy + j] = slip_slips*F_slips;
        out[end_out_slips_heat + j] = k_s[j]*r[j];
    }
    /* rates */
    const double rate_p = alpha_ceramic*V_clamped
        - F_spring
        - sum_F_slips
        - F_damper
        + F_ext;
    const double rate_S = (heat_leads + heat_slips + heat_damper)/T + lam*(T_e/T - 1.0);
    /* result */
    out[0] = V_in;
    out[1] = -i_leads;
    out[2] = -i_leads*V_in;
    out[3] = V_leads;
    out[4] = i_leads;
    out[5] = i_leads*V_leads;
    out[6] = i_leads*V_leads;
    out[7] = V_clamped;
    out[8] = rate_Q;
    out[9] = V_clamped*rate_Q;
    out[10] = power_2(Q)/(2.0*C);
    out[11] = V_clamped;
    out[12] = alpha_ceramic*v_mass;
    out[13] = -alpha_ceramic*V_clamped;
    out[14] = v_mass;
    out[15] = V_clamped*alpha_ceramic*v_mass;
    out[16] = rate_p;
    out[17] = v_mass;
    out[18] = rate_p*v_mass;
    out[19] = power_2(p)/(2.0*m);
    out[20] = F_spring;
    out[21] = v_mass;
    out[22] = F_spring*v_mass;
    out[23] = k*power_2(q)/2.0;
    out[end_out_slips_limit] = F_damper;
    out[1 + end_out_slips_limit] = v_mass;
    out[2 + end_out_slips_limit] = F_damper*v_mass;
    out[3 + end_out_slips_limit] = F_damper*v_mass;
    out[4 + end_out_slips_limit] = -F_ext;
    out[5 + end_out_slips_limit] = v_mass;
    out[6 + end_out_slips_limit] = -v_mass*F_ext;
    out[7 + end_out_slips_limit] = T;
    out[8 + end_out_slips_limit] = rate_S;
    out[9 + end_out_slips_limit] = T*rate_S;
    out[10 + end_out_slips_limit] = T_0*c_0*exp(S/c_0);
    out[11 + end_out_slips_limit] = T;
    out[12 + end_out_slips_limit] = -lam*(T_e/T - 1.0);
    out[13 + end_out_slips_limit] = -lam*(T_e - T);
}

/* Jacobian of rhs, n x n, row after row: d rhs[i]/d x[j] at out[i*n + j]. */
void stack_maxwell_jacobian(const double *restrict x,
                            const double *restrict u,
                            const stack_maxwell_parameters *restrict p_,
                            double *restrict out)
{
    const long slips_count = p_->slips_count;
    const long n = 4 + slips_count;
    const double m = p_->m;
    const double d = p_->d;
    const double a = p_->a;
    const double C = p_->C;
    const double R = p_->R;
    const double k = p_->k;
    const double *restrict k_s = p_->k_s;
    const double *restrict r = p_->r;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double lam = p_->lam;
    const double Q = x[0];
    const double p = x[1];
    const double *restrict z = x + 3;
    const double S = x[3 + slips_count];
    const double V_in = u[1];
    const double T_e = u[2];
    for (long j = 0; j < n*n; ++j) {
        out[j] = 0.0;
    }
    /* co-states dU/dx */
    const double V_clamped = Q/C;
    const double v_mass = p/m;
    const double T = T_0*exp(S/c_0);
    /* transducer ratios */
    const double alpha_ceramic = a;
    /* driving forces */
    const double V_leads = -V_clamped + V_in;
    /* dissipative laws */
    const double i_leads = V_leads/R;
    const double F_damper = d*v_mass;
    /* heats */
    const double heat_leads = i_leads*V_leads;
    const double heat_damper = F_damper*v_mass;
    /* derivatives */
    const double di_leads_dQ = -1.0/R/C;
    const double dheat_leads_dQ = V_leads*di_leads_dQ - i_leads/C;
    const double dF_damper_dp = d/m;
    const double dheat_damper_dp = v_mass*dF_damper_dp + F_damper/m;
    const double dT_dS = T/c_0;
    /* each lane of slips: sums over lanes and result */
    double heat_slips = 0.0;
    double dheat_slips_dp = 0.0;
#pragma omp simd reduction(+:heat_slips, dheat_slips_dp)
    for (long j = 0; j < slips_count; ++j) {
        const double F_slips = k_s[j]*z[j];
        const double slip_slips = pick(
            v_mass > 0.0,
            pick(F_slips >= k_s[j]*r[j], v_mass, 0.0),
            pick(F_slips <= -k_s[j]*r[j], v_mass, 0.0));
        const double dslip_slips_dp = pick(
            v_mass > 0.0,
            pick(F_slips >= k_s[j]*r[j], 1.0/m, 0.0),
            pick(F_slips <= -k_s[j]*r[j], 1.0/m, 0.0));
        const double dheat_slips_dz = slip_slips*k_s[j];
        heat_slips += slip_slips*F_slips;
        dheat_slips_dp += F_slips*dslip_slips_dp;
        out[n + 3 + j] = -k_s[j];
        out[(3 + j)*n + 1] = 1.0/m - dslip_slips_dp;
        out[(3 + slips_count)*n + 3 + j] = dheat_slips_dz/T;
    }
    /* result */
    out[0] = di_leads_dQ;
    out[1] = -alpha_ceramic/m;
    out[n + 0] = alpha_ceramic/C;
    out[n + 1] = -dF_damper_dp;
    out[n + 2] = -k;
    out[2*n + 1] = 1.0/m;
    out[(3 + slips_count)*n + 0] = dheat_leads_dQ/T;
    out[(3 + slips_count)*n + 1] = dheat_slips_dp/T + dheat_damper_dp/T;
    out[(3 + slips_count)*n + 3 + slips_count] = (-(heat_leads + heat_slips + heat_damper)/power_2(T) - lam*T_e/power_2(T))*dT_dS;
}

/* Margin by which each condition of the domain holds; of a bank, the least one. */
void stack_maxwell_margins(const double *restrict x,
                           const double *restrict u,
                           const stack_maxwell_parameters *restrict p_,
                           double *restrict out)
{
    (void)x;
    const long slips_count = p_->slips_count;
    const double m = p_->m;
    const double d = p_->d;
    const double C = p_->C;
    const double R = p_->R;
    const double k = p_->k;
    const double *restrict k_s = p_->k_s;
    const double *restrict r = p_->r;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double lam = p_->lam;
    const double T_e = u[2];
    /* each lane of slips: result */
    out[7] = HUGE_VAL;
    out[8] = HUGE_VAL;
    for (long j = 0; j < slips_count; ++j) {
        out[7] = min(out[7], k_s[j]);
        out[8] = min(out[8], k_s[j]*r[j]);
    }
    /* result */
    out[0] = T_e;
    out[1] = R;
    out[2] = d;
    out[3] = lam;
    out[4] = C;
    out[5] = m;
    out[6] = k;
    out[9] = T_0;
    out[10] = c_0;
}
