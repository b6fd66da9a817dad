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
/* A step of Gauss collocation; row program of the proofs covers integrands and stage. */
#include "piezo_stack.h"

#include <math.h>

#if !defined(REAL_WIDTH) /* numbers of one run; run/engine has vectors of many */
#define REAL_WIDTH 1
typedef double real;
#define zero 0.0
#define wide(value) (value)
#define chosen(condition, then, other) ((condition) ? (then) : (other))
#define exp_of exp
#define expm1_of expm1
#define log_of log
#define sqrt_of sqrt
#define sin_of sin
#define cos_of cos
#define tanh_of tanh
#define atan_of atan
#define sinh_of sinh
#define cosh_of cosh
#define erf_of erf
#define pow_of pow
#define least(a, b) ((a) < (b) || (a) != (a) ? (a) : (b))
#define OF(value, lane) (value)
#endif

/* The parameters of piezo_stack_parameters, of as many runs as real holds. */
typedef struct {
    real M;
    real k;
    real q_l;
    real d;
    real C;
    real *L;
    real *rho;
    real *i_0;
    real a;
    real T_0;
    real c_0;
    real lam;
    long hysteron_count;
} piezo_stack_reals;

static inline real power_2_of(real z)
{
    return z*z;
}

/* Functions of the state whose weighted means over a step its stages are given. */
static void piezo_stack_integrands(const real *restrict x,
                                   const piezo_stack_reals *restrict p_,
                                   real *restrict out)
{
    const long hysteron_count = p_->hysteron_count;
    const real T_0 = p_->T_0;
    const real c_0 = p_->c_0;
    const real S = x[3 + hysteron_count];
    out[0] = T_0*expm1_of(S/c_0);
}

/*
 * Rates of the state at a stage, for means g and branches b; rows for the ledger: power of
 * ports, heat and entropy production of processes, entropy rate of exchanges; switching
 * functions s; margins m of what a state can leave.
 */
static void piezo_stack_stage(const real *restrict x,
                              const real *restrict g,
                              const real *restrict b,
                              const real *restrict u,
                              const piezo_stack_reals *restrict p_,
                              real *restrict out,
                              real *restrict rows,
                              real *restrict s,
                              real *restrict m)
{
    const long hysteron_count = p_->hysteron_count;
    const real M = p_->M;
    const real k = p_->k;
    const real q_l = p_->q_l;
    const real d = p_->d;
    const real C = p_->C;
    const real *restrict L = p_->L;
    const real *restrict rho = p_->rho;
    const real *restrict i_0 = p_->i_0;
    const real a = p_->a;
    const real T_0 = p_->T_0;
    const real lam = p_->lam;
    const real q = x[0];
    const real p = x[1];
    const real Q_C = x[2];
    const real *restrict phi = x + 3;
    const real T_minus_T_0 = g[0];
    const real *restrict branch_1 = b + 0;
    const real *restrict branch_2 = b + hysteron_count;
    const real F_ext = u[0];
    const real V_in = u[1];
    const real T_e = u[2];
    /* co-states dU/dx */
    const real T = T_0 + T_minus_T_0;
    const real F_spring = k*(q - q_l);
    const real v_mass = p/M;
    const real V_capacitor = Q_C/C;
    /* transducer ratios */
    const real alpha_transducer = a*T/T_0;
    /* dissipative laws */
    const real F_damper = d*v_mass;
    /* heats */
    const real heat_damper = F_damper*v_mass;
    /* hysteron: sums over lanes and rows */
    real sum_i_hysteron = zero;
    real heat_hysteron = zero;
#pragma omp simd reduction(+:sum_i_hysteron, heat_hysteron)
    for (long j = 0; j < hysteron_count; ++j) {
        const real i_hysteron = phi[j]/L[j];
        const real switch_1 = -i_0[j] - i_hysteron;
        const real switch_2 = i_hysteron - i_0[j];
        const real chosen_V_hysteron = chosen(
            branch_2[j] > 0.0,
            i_hysteron - i_0[j],
            chosen(branch_1[j] > 0.0, i_hysteron + i_0[j], wide(0.0)));
        const real V_hysteron = rho[j]/T_minus_T_0*chosen_V_hysteron;
        sum_i_hysteron += i_hysteron;
        heat_hysteron += V_hysteron*i_hysteron;
        s[j] = switch_1;
        s[hysteron_count + j] = switch_2;
        out[3 + j] = V_in - V_capacitor - V_hysteron;
        rows[3 + j] = V_hysteron*i_hysteron;
        rows[4 + hysteron_count + j] = V_hysteron*i_hysteron/T;
    }
    out[0] = v_mass;
    out[1] = alpha_transducer*V_capacitor - F_spring - F_damper + F_ext;
    out[2] = sum_i_hysteron - alpha_transducer*v_mass;
    out[3 + hysteron_count] = (heat_hysteron + heat_damper)/T + lam*(T_e/T - 1.0);
    rows[0] = v_mass*F_ext;
    rows[1] = sum_i_hysteron*V_in;
    rows[2] = lam*(T_e - T);
    rows[3 + hysteron_count] = F_damper*v_mass;
    rows[4 + hysteron_count + hysteron_count] = F_damper*v_mass/T;
    rows[5 + hysteron_count + hysteron_count] = lam*(T_e/T - 1.0);
    m[0] = T_minus_T_0;
}

/* Derivative of the rates by the state, on branches b; entries as the tables say. */
static void piezo_stack_slopes(const real *restrict x,
                               const real *restrict b,
                               const real *restrict u,
                               const piezo_stack_reals *restrict p_,
                               real *restrict out)
{
    const long hysteron_count = p_->hysteron_count;
    const real M = p_->M;
    const real k = p_->k;
    const real d = p_->d;
    const real C = p_->C;
    const real *restrict L = p_->L;
    const real *restrict rho = p_->rho;
    const real *restrict i_0 = p_->i_0;
    const real a = p_->a;
    const real T_0 = p_->T_0;
    const real c_0 = p_->c_0;
    const real lam = p_->lam;
    const real p = x[1];
    const real Q_C = x[2];
    const real *restrict phi = x + 3;
    const real S = x[3 + hysteron_count];
    const real *restrict branch_1 = b + 0;
    const real *restrict branch_2 = b + hysteron_count;
    const real T_e = u[2];
    /* co-states dU/dx */
    const real v_mass = p/M;
    const real V_capacitor = Q_C/C;
    const real T_minus_T_0 = T_0*expm1_of(S/c_0);
    const real T = T_0 + T_minus_T_0;
    /* transducer ratios */
    const real alpha_transducer = a*T/T_0;
    /* dissipative laws */
    const real F_damper = d*v_mass;
    /* heats */
    const real heat_damper = F_damper*v_mass;
    /* derivatives */
    const real dF_damper_dp = d/M;
    const real dheat_damper_dp = v_mass*dF_damper_dp + F_damper/M;
    const real dT_minus_T_0_dS = T/c_0;
    const real dalpha_transducer_dS = a/T_0*dT_minus_T_0_dS;
    /* hysteron: sums over lanes and rows */
    real heat_hysteron = zero;
    real dheat_hysteron_dS = zero;
#pragma omp simd reduction(+:heat_hysteron, dheat_hysteron_dS)
    for (long j = 0; j < hysteron_count; ++j) {
        const real i_hysteron = phi[j]/L[j];
        const real chosen_V_hysteron = chosen(
            branch_2[j] > 0.0,
            i_hysteron - i_0[j],
            chosen(branch_1[j] > 0.0, i_hysteron + i_0[j], wide(0.0)));
        const real V_hysteron = rho[j]/T_minus_T_0*chosen_V_hysteron;
        const real dchosen_V_hysteron_dphi = chosen(
            branch_2[j] > 0.0,
            1.0/L[j],
            chosen(branch_1[j] > 0.0, 1.0/L[j], wide(0.0)));
        const real dV_hysteron_dphi = rho[j]/T_minus_T_0*dchosen_V_hysteron_dphi;
        const real dheat_hysteron_dphi = i_hysteron*dV_hysteron_dphi + V_hysteron/L[j];
        const real dV_hysteron_dS = -rho[j]/power_2_of(T_minus_T_0)*chosen_V_hysteron*dT_minus_T_0_dS;
        heat_hysteron += V_hysteron*i_hysteron;
        dheat_hysteron_dS += i_hysteron*dV_hysteron_dS;
        out[9 + j] = -dV_hysteron_dphi;
        out[9 + hysteron_count + j] = -1.0/C;
        out[9 + 2*hysteron_count + j] = -dV_hysteron_dS;
        out[9 + 3*hysteron_count + j] = 1.0/L[j];
        out[9 + 4*hysteron_count + j] = dheat_hysteron_dphi/T;
    }
    out[0] = 1.0/M;
    out[1] = -k;
    out[2] = -dF_damper_dp;
    out[3] = alpha_transducer/C;
    out[4] = V_capacitor*dalpha_transducer_dS;
    out[5] = -alpha_transducer/M;
    out[6] = -v_mass*dalpha_transducer_dS;
    out[7] = dheat_damper_dp/T;
    out[8] = dheat_hysteron_dS/T
        + (-(heat_hysteron + heat_damper)/power_2_of(T) - lam*T_e/power_2_of(T))*dT_minus_T_0_dS;
}

/*
 * Sizes of states, means, branches, rows for the ledger, processes and slopes; lanes of each
 * bank; first row of each state.
 */
static void piezo_stack_sizes(const piezo_stack_reals *p_, long *out)
{
    const long hysteron_count = p_->hysteron_count;
    out[0] = 4 + hysteron_count; /* states */
    out[1] = 1; /* means */
    out[2] = hysteron_count + hysteron_count; /* branches */
    out[3] = 6 + hysteron_count + hysteron_count; /* booked */
    out[4] = 1 + hysteron_count; /* processes */
    out[5] = 9 + 5*hysteron_count; /* slopes */
    out[6] = hysteron_count; /* lanes */
    out[7] = 0; /* first row */
    out[8] = 1; /* first row */
    out[9] = 2; /* first row */
    out[10] = 3; /* first row */
    out[11] = 3 + hysteron_count; /* first row */
}

/* Sizes of banks, and room from `at` on for their parameters; how much that takes. */
static long piezo_stack_place_reals(piezo_stack_reals *to, const piezo_stack_parameters *from, real *at)
{
    real *const begin = at;
    to->hysteron_count = from->hysteron_count;
    to->L = at;
    at += from->hysteron_count;
    to->rho = at;
    at += from->hysteron_count;
    to->i_0 = at;
    at += from->hysteron_count;
    return at - begin;
}

/* Give a lane the parameters of a run. */
static void piezo_stack_give(piezo_stack_reals *to, const piezo_stack_parameters *from, int lane)
{
    (void)lane;
    OF(to->M, lane) = from->M;
    OF(to->k, lane) = from->k;
    OF(to->q_l, lane) = from->q_l;
    OF(to->d, lane) = from->d;
    OF(to->C, lane) = from->C;
    for (long j = 0; j < from->hysteron_count; ++j)
        OF(to->L[j], lane) = from->L[j];
    for (long j = 0; j < from->hysteron_count; ++j)
        OF(to->rho[j], lane) = from->rho[j];
    for (long j = 0; j < from->hysteron_count; ++j)
        OF(to->i_0[j], lane) = from->i_0[j];
    OF(to->a, lane) = from->a;
    OF(to->T_0, lane) = from->T_0;
    OF(to->c_0, lane) = from->c_0;
    OF(to->lam, lane) = from->lam;
}

enum {
    piezo_stack_limits = 1, /* margins of a stage */
    piezo_stack_reads = 1, /* states that integrands read */
    piezo_stack_records = 5, /* states, a bank's counted once */
    piezo_stack_heated = 4 /* the state that takes a dissipative step's loss */
};
static const int piezo_stack_strict[] = {
    1,
};
static const int piezo_stack_read[] = {
    4,
};
/* The equations of a step: shared unknowns, those of lanes, their elimination. */
enum {
    piezo_stack_shared = 4, /* shared states */
    piezo_stack_unknowns = 4, /* and sums between lanes */
    piezo_stack_slots = 12, /* entries between them, fill-in included */
    piezo_stack_entries = 9, /* slopes between shared states */
    piezo_stack_banks = 1,
    piezo_stack_most_states = 1 /* that a lane has */
};
static const int piezo_stack_place[] = {
    1, 2, 3, 4, 5, 6, 8, 9, 11,
};
static const int piezo_stack_state[] = {
    0, 1, 2, 4,
};
static const int piezo_stack_order[] = {
    0, 1, 2, 3,
};
static const int piezo_stack_pivot[] = {
    0, 3, 7, 11,
};
static const int piezo_stack_below_at[] = {
    0, 2, 6, 8, 8,
};
static const int piezo_stack_below[] = {
    1, 2, 2, 6, 3, 9, 3, 10,
};
static const int piezo_stack_right_at[] = {
    0, 2, 6, 8, 8,
};
static const int piezo_stack_right[] = {
    1, 1, 2, 4, 3, 5, 3, 8,
};
static const int piezo_stack_update[] = {
    3, 7, 8, 10, 11, 11,
};
static const int piezo_stack_lane_states_at[] = {
    0, 1,
};
static const int piezo_stack_lane_states[] = {
    3,
};
static const int piezo_stack_lane_columns_at[] = {
    0, 2,
};
static const int piezo_stack_lane_columns[] = {
    2, 3,
};
static const int piezo_stack_lane_rows_at[] = {
    0, 2,
};
static const int piezo_stack_lane_rows[] = {
    2, 3,
};
static const int piezo_stack_first[] = {
    0,
};
static const int piezo_stack_meet[] = {
    7, 8, 10, 11,
};
