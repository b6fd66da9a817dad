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
/*
 * One step of energy-preserving Gauss collocation. The row `program` of the proofs covers the
 * functions `integrands` and `stage`, and `costates`; the others and the tables serve Newton's method.
 */
#include "stack_maxwell.h"

#include <math.h>

#if !defined(REAL_WIDTH) /* numbers of one run; run/engine has vectors of many */
#define REAL_WIDTH 1
#define ALONE
#if !defined(REAL)
#define REAL double /* or float */
#endif
typedef REAL real;
#define zero 0.0
#define wide(value) (value)
#define chosen(condition, then, other) ((condition) ? (then) : (other))
#define exp_of exp
#define is_above(a, b) ((a) > (b))
#define is_at_least(a, b) ((a) >= (b))
#define least(a, b) ((a) < (b) || (a) != (a) ? (a) : (b))
#define OF(value, lane) (value)
#endif

/* The parameters as `real`: of one run, or in vectors of one run per lane. */
typedef struct {
    real m;
    real d;
    real a;
    real C;
    real R;
    real k;
    real *k_s;
    real *r;
    real T_0;
    real c_0;
    real lam;
    long slips_count;
} stack_maxwell_reals;

#if !defined(LAWS_APART) /* the functions of laws, which run/engine compiles apart */

static inline real power_2_of(real z)
{
    return z*z;
}

/* Functions of the state whose weighted means over a step are the means g of a stage. */
static void stack_maxwell_integrands(const real *restrict x,
                                     const stack_maxwell_reals *restrict p_,
                                     real *restrict out)
{
    const long slips_count = p_->slips_count;
    const real T_0 = p_->T_0;
    const real c_0 = p_->c_0;
    const real S = x[3 + slips_count];
    out[0] = T_0*exp_of(S/c_0);
}

/*
 * A stage, for the state x, means g, branches b of laws, and inputs u. Writes the rates of the
 * state to out; to rows, for the ledger, the power of ports, heat and entropy production of
 * processes, and entropy rate of heat exchanges; to s the switching functions, whose signs
 * decide the branches; to m the margins of those conditions of the domain that depend on the
 * state.
 */
static void stack_maxwell_stage(const real *restrict x,
                                const real *restrict g,
                                const real *restrict b,
                                const real *restrict u,
                                const stack_maxwell_reals *restrict p_,
                                real *restrict out,
                                real *restrict rows,
                                real *restrict s,
                                real *restrict m_)
{
    (void)b;
    (void)s;
    (void)m_;
    const long slips_count = p_->slips_count;
    const real m = p_->m;
    const real d = p_->d;
    const real a = p_->a;
    const real C = p_->C;
    const real R = p_->R;
    const real k = p_->k;
    const real lam = p_->lam;
    const real Q = x[0];
    const real p = x[1];
    const real q = x[2];
    const long end_g_F_slips = 1 + slips_count;
    const long end_g_slip_slips = end_g_F_slips + slips_count;
    const real T = g[0];
    const real *restrict F_slips = g + 1;
    const real *restrict slip_slips = g + end_g_F_slips;
    const real *restrict heat_slip_slips = g + end_g_slip_slips;
    const real F_ext = u[0];
    const real V_in = u[1];
    const real T_e = u[2];
    /* co-states dU/dx */
    const real V_clamped = Q/C;
    const real v_mass = p/m;
    const real F_spring = k*q;
    /* transducer ratios */
    const real alpha_ceramic = a;
    /* driving forces */
    const real V_leads = -V_clamped + V_in;
    /* dissipative laws */
    const real i_leads = V_leads/R;
    const real F_damper = d*v_mass;
    /* heats */
    const real heat_leads = i_leads*V_leads;
    const real heat_damper = F_damper*v_mass;
    /* each lane of slips: sums over lanes and result */
    real sum_F_slips = zero;
    real heat_slips = zero;
#pragma omp simd reduction(+:sum_F_slips, heat_slips)
    for (long j = 0; j < slips_count; ++j) {
        sum_F_slips += F_slips[j];
        heat_slips += heat_slip_slips[j];
        out[3 + j] = v_mass - slip_slips[j];
        rows[4 + j] = heat_slip_slips[j];
        rows[6 + slips_count + j] = heat_slip_slips[j]/T;
    }
    /* result */
    out[0] = i_leads - alpha_ceramic*v_mass;
    out[1] = alpha_ceramic*V_clamped - F_spring - sum_F_slips - F_damper + F_ext;
    out[2] = v_mass;
    out[3 + slips_count] = (heat_leads + heat_slips + heat_damper)/T + lam*(T_e/T - 1.0);
    rows[0] = v_mass*F_ext;
    rows[1] = i_leads*V_in;
    rows[2] = lam*(T_e - T);
    rows[3] = i_leads*V_leads;
    rows[4 + slips_count] = F_damper*v_mass;
    rows[5 + slips_count] = i_leads*V_leads/T;
    rows[6 + slips_count + slips_count] = F_damper*v_mass/T;
    rows[7 + slips_count + slips_count] = lam*(T_e/T - 1.0);
}

#if !defined(ALONE) /* the step alone solves its equations to round-off */
/* Co-states dU/dx of a stage, of all states; then the rows of entropies. */
static void stack_maxwell_costates(const real *restrict x,
                                   const real *restrict g,
                                   const stack_maxwell_reals *restrict p_,
                                   real *restrict out)
{
    const long slips_count = p_->slips_count;
    const real m = p_->m;
    const real C = p_->C;
    const real k = p_->k;
    const real Q = x[0];
    const real p = x[1];
    const real q = x[2];
    const real T = g[0];
    const real *restrict F_slips = g + 1;
    /* co-states dU/dx */
    const real V_clamped = Q/C;
    const real v_mass = p/m;
    const real F_spring = k*q;
    /* each lane of slips: result */
#pragma omp simd
    for (long j = 0; j < slips_count; ++j) {
        out[3 + j] = F_slips[j];
    }
    /* result */
    out[0] = V_clamped;
    out[1] = v_mass;
    out[2] = F_spring;
    out[3 + slips_count] = T;
}
#endif /* of what run/engine takes */

/* Derivative of the rates by the state, on branches b; the tables tell its entries. */
static void stack_maxwell_slopes(const real *restrict x,
                                 const real *restrict g,
                                 const real *restrict b,
                                 const real *restrict u,
                                 const stack_maxwell_reals *restrict p_,
                                 real *restrict out)
{
    (void)b;
    const long slips_count = p_->slips_count;
    const real m = p_->m;
    const real d = p_->d;
    const real a = p_->a;
    const real C = p_->C;
    const real R = p_->R;
    const real k = p_->k;
    const real *restrict k_s = p_->k_s;
    const real T_0 = p_->T_0;
    const real c_0 = p_->c_0;
    const real lam = p_->lam;
    const real Q = x[0];
    const real p = x[1];
    const real *restrict z = x + 3;
    const real S = x[3 + slips_count];
    const long end_g_F_slips = 1 + slips_count;
    const long end_g_slip_slips = end_g_F_slips + slips_count;
    const long end_g_heat_slip_slips = end_g_slip_slips + slips_count;
    const real *restrict share_slip_slips = g + end_g_heat_slip_slips;
    const real V_in = u[1];
    const real T_e = u[2];
    /* co-states dU/dx */
    const real V_clamped = Q/C;
    const real v_mass = p/m;
    const real T = T_0*exp_of(S/c_0);
    /* transducer ratios */
    const real alpha_ceramic = a;
    /* driving forces */
    const real V_leads = -V_clamped + V_in;
    /* dissipative laws */
    const real i_leads = V_leads/R;
    const real F_damper = d*v_mass;
    /* heats */
    const real heat_leads = i_leads*V_leads;
    const real heat_damper = F_damper*v_mass;
    /* derivatives */
    const real di_leads_dQ = -1.0/R/C;
    const real dheat_leads_dQ = V_leads*di_leads_dQ - i_leads/C;
    const real dF_damper_dp = d/m;
    const real dheat_damper_dp = v_mass*dF_damper_dp + F_damper/m;
    const real dT_dS = T/c_0;
    /* each lane of slips: sums over lanes and result */
    real heat_slips = zero;
    real dheat_slips_dp = zero;
#pragma omp simd reduction(+:heat_slips, dheat_slips_dp)
    for (long j = 0; j < slips_count; ++j) {
        const real F_slips = k_s[j]*z[j];
        const real slip_slips = (1.0 - share_slip_slips[j])*v_mass;
        const real dslip_slips_dp = (1.0 - share_slip_slips[j])/m;
        const real dheat_slips_dz = slip_slips*k_s[j];
        heat_slips += slip_slips*F_slips;
        dheat_slips_dp += F_slips*dslip_slips_dp;
        out[9 + j] = wide(0.0);
        out[9 + slips_count + j] = 1.0/m - dslip_slips_dp;
        out[9 + 2*slips_count + j] = -k_s[j];
        out[9 + 3*slips_count + j] = dheat_slips_dz/T;
    }
    /* result */
    out[0] = di_leads_dQ;
    out[1] = -alpha_ceramic/m;
    out[2] = alpha_ceramic/C;
    out[3] = -dF_damper_dp;
    out[4] = -k;
    out[5] = 1.0/m;
    out[6] = dheat_leads_dQ/T;
    out[7] = dheat_slips_dp/T + dheat_damper_dp/T;
    out[8] = (-(heat_leads + heat_slips + heat_damper)/power_2_of(T) - lam*T_e/power_2_of(T))*dT_dS;
}

/* Stiffness and limit of each path functional. */
static void stack_maxwell_path_parameters(const real *restrict x,
                                          const stack_maxwell_reals *restrict p_,
                                          real *restrict out)
{
    (void)x;
    const long slips_count = p_->slips_count;
    const real *restrict k_s = p_->k_s;
    const real *restrict r = p_->r;
    /* each lane of slips: result */
#pragma omp simd
    for (long j = 0; j < slips_count; ++j) {
        out[j] = k_s[j];
        out[slips_count + j] = k_s[j]*r[j]/k_s[j];
    }
}

/* Drives of path functionals: the rates of their coordinates. */
static void stack_maxwell_drives(const real *restrict x,
                                 const real *restrict g,
                                 const real *restrict b,
                                 const real *restrict u,
                                 const stack_maxwell_reals *restrict p_,
                                 real *restrict out)
{
    (void)g;
    (void)b;
    (void)u;
    const real m = p_->m;
    const real p = x[1];
    /* co-states dU/dx */
    const real v_mass = p/m;
    /* result */
    out[0] = v_mass;
}

#endif /* of the functions of laws */

/* How many numbers there are of each kind; lanes of each bank; first row of each state. */
static void stack_maxwell_sizes(const stack_maxwell_reals *p_, long *out)
{
    const long slips_count = p_->slips_count;
    out[0] = 4 + slips_count; /* states */
    out[1] = 1; /* means */
    out[2] = 0; /* branches */
    out[3] = 8 + slips_count + slips_count; /* booked */
    out[4] = 2 + slips_count; /* processes */
    out[5] = 9 + 4*slips_count; /* slopes */
    out[6] = slips_count; /* lanes */
    out[7] = 0; /* first row */
    out[8] = 1; /* first row */
    out[9] = 2; /* first row */
    out[10] = 3; /* first row */
    out[11] = 3 + slips_count; /* first row */
}

/* Copy the sizes of banks; place arrays for their parameters from `at` on, return their size. */
static long stack_maxwell_place_reals(stack_maxwell_reals *to, const stack_maxwell_parameters *from, real *at)
{
    real *const begin = at;
    to->slips_count = from->slips_count;
    to->k_s = at;
    at += from->slips_count;
    to->r = at;
    at += from->slips_count;
    return at - begin;
}

/* Copy the parameters of a run into one lane of the vectors. */
static void stack_maxwell_give(stack_maxwell_reals *to, const stack_maxwell_parameters *from, int lane)
{
    (void)lane;
    OF(to->m, lane) = from->m;
    OF(to->d, lane) = from->d;
    OF(to->a, lane) = from->a;
    OF(to->C, lane) = from->C;
    OF(to->R, lane) = from->R;
    OF(to->k, lane) = from->k;
    for (long j = 0; j < from->slips_count; ++j)
        OF(to->k_s[j], lane) = from->k_s[j];
    for (long j = 0; j < from->slips_count; ++j)
        OF(to->r[j], lane) = from->r[j];
    OF(to->T_0, lane) = from->T_0;
    OF(to->c_0, lane) = from->c_0;
    OF(to->lam, lane) = from->lam;
}

/* Path functionals: bank or -1, drives of lanes, inner state, if drives depend on it. */
#define PATHS 1
static const int stack_maxwell_path[PATHS][4] = {
    {0, 0, 3, 0},
};
#if !defined(ALONE) /* there are co-states for run/engine */
#define COSTATES
enum { stack_maxwell_bodies = 1 };
static const int stack_maxwell_body[] = {
    4,
};
#endif /* of what tells of co-states */
enum {
    stack_maxwell_limits = 0, /* margins of a stage */
    stack_maxwell_reads = 1, /* states that integrands read */
    stack_maxwell_records = 5, /* states, a bank's counted once */
    stack_maxwell_heated = 4, /* the state that takes a dissipative step's loss */
    stack_maxwell_jumps = 0 /* whether a law jumps */
};
static const int stack_maxwell_strict[] = {
    0,
};
static const int stack_maxwell_read[] = {
    4,
};
/* The equations of a step: shared unknowns, those of lanes, their elimination. */
enum {
    stack_maxwell_shared = 4, /* shared states */
    stack_maxwell_unknowns = 4, /* and sums between lanes */
    stack_maxwell_slots = 10, /* entries between them, fill-in included */
    stack_maxwell_entries = 9, /* slopes between shared states */
    stack_maxwell_banks = 1,
    stack_maxwell_most_states = 1 /* that a lane has */
};
static const int stack_maxwell_place[] = {
    0, 1, 2, 3, 4, 5, 7, 8, 9,
};
static const int stack_maxwell_state[] = {
    0, 1, 2, 4,
};
static const int stack_maxwell_order[] = {
    3, 0, 1, 2,
};
static const int stack_maxwell_pivot[] = {
    9, 0, 3, 6,
};
static const int stack_maxwell_below_at[] = {
    0, 0, 2, 4, 4,
};
static const int stack_maxwell_below[] = {
    1, 2, 2, 5,
};
static const int stack_maxwell_right_at[] = {
    0, 4, 6, 8, 8,
};
static const int stack_maxwell_right[] = {
    0, 7, 1, 8, 1, 1, 2, 4,
};
static const int stack_maxwell_update[] = {
    3, 6,
};
static const int stack_maxwell_lane_states_at[] = {
    0, 1,
};
static const int stack_maxwell_lane_states[] = {
    3,
};
static const int stack_maxwell_lane_columns_at[] = {
    0, 1,
};
static const int stack_maxwell_lane_columns[] = {
    1,
};
static const int stack_maxwell_lane_rows_at[] = {
    0, 2,
};
static const int stack_maxwell_lane_rows[] = {
    1, 3,
};
static const int stack_maxwell_first[] = {
    0,
};
static const int stack_maxwell_meet[] = {
    3, 8,
};

#if defined(ALONE) /* the engine has a step of its own, of any order and for vectors */
#include "stack_maxwell_step.h"

#include <string.h>

#define MODEL(name) stack_maxwell_##name
#define LANE(array, k, lane) ((array)[(k) + (lane)])
#define any(where) (where)
#define none_of(where) (!(where))
#define size_of fabs
#define nowhere 0
typedef int mask; /* 0 or 1 */

static inline real largest_of(real a, real b)
{
    return a > b || a != a ? a : b;
}

#define STAGES 1
#define NODES 3
#define PAIRS 0
#define PARTS 3
#define FINE 16
#define LOSSY 0
static const double filter = 5.0e-1;
#define COARSE 1.0e-5
#define TOO_COARSE 9.3057204092969898e-8
static const double stage_at[1] = {5.0e-1};
static const double stage_weight[1] = {1.0};
static const double stage_lead[1] = {1.0};
static const double along[1][1] = {
    {1.0}};
static const double stage_reach[1][1] = {
    {5.0e-1}};
static const double node_last[2][3] = {
    {5.5555555555555556e-1, -1.1111111111111111, 5.5555555555555556e-1},
    {-2.0412414523193151e-5, 0.0, 2.0412414523193151e-5}};
static const double fine_last[2][16] = {
    {-3.2781304863961739e-2, 1.122209124505884e-1, -2.1159853063188444e-1, 3.1691961779722083e-1, -4.1664037702596137e-1, 5.0089334971596444e-1, -5.6174614482927911e-1, 5.9361592894280181e-1, -5.9361592894280181e-1, 5.6174614482927911e-1, -5.0089334971596444e-1, 4.1664037702596137e-1, -3.1691961779722083e-1, 2.1159853063188444e-1, -1.122209124505884e-1, 3.2781304863961739e-2},
    {2.1308618399989913e-4, -6.9641319632671669e-4, 1.2033786136163721e-3, -1.5728430124492439e-3, 1.6912958862630305e-3, -1.5072434022893198e-3, 1.0392857343763955e-3, -3.705468071904169e-4, -3.705468071904169e-4, 1.0392857343763955e-3, -1.5072434022893198e-3, 1.6912958862630305e-3, -1.5728430124492439e-3, 1.2033786136163721e-3, -6.9641319632671669e-4, 2.1308618399989913e-4}};
static const double node_reach[3][1] = {
    {1.1270166537925831e-1},
    {5.0e-1},
    {8.8729833462074169e-1}};
static const double node_mean[1][3] = {
    {2.7777777777777778e-1, 4.4444444444444444e-1, 2.7777777777777778e-1}};
static const double fine_reach[16][1] = {
    {5.2995325041750337e-3},
    {2.7712488463383712e-2},
    {6.7184398806084128e-2},
    {1.2229779582249848e-1},
    {1.9106187779867813e-1},
    {2.7099161117138631e-1},
    {3.5919822461037054e-1},
    {4.5249374508118128e-1},
    {5.4750625491881872e-1},
    {6.4080177538962946e-1},
    {7.2900838882861369e-1},
    {8.0893812220132187e-1},
    {8.7770220417750152e-1},
    {9.3281560119391587e-1},
    {9.7228751153661629e-1},
    {9.9470046749582497e-1}};
static const double fine_mean[1][16] = {
    {1.3576229705877047e-2, 3.1126761969323946e-2, 4.7579255841246392e-2, 6.2314485627766936e-2, 7.4797994408288366e-2, 8.4578259697501269e-2, 9.1301707522461794e-2, 9.4725305227534248e-2, 9.4725305227534248e-2, 9.1301707522461794e-2, 8.4578259697501269e-2, 7.4797994408288366e-2, 6.2314485627766936e-2, 4.7579255841246392e-2, 3.1126761969323946e-2, 1.3576229705877047e-2}};
static const double stage_basis[1][1] = {
    {1.0}};
static const double basis_inverse[1][1] = {
    {1.0}};

/*
 * Steps of Gauss collocation that keep both balances: their work space, and states within them.
 * newton.c solves for the rates at the stages, in all lanes at once.
 *
 * Comes after real.h, a generated <model>_step.c and the tables for a number of stages. With rates
 * K_j at the stages, the state follows X(tau) = x + h sum_j K_j int_0^tau l_j. Stage i uses means
 * of the co-states, int_0^1 (l_i/b_i) dU/dx(X) dtau, by Gauss quadrature with NODES nodes, or with
 * FINE where these are too few, and piece by piece where energies have kinks. A root is accepted
 * only if it solves the equations, the quadrature is accurate, all numbers are finite, each stage
 * lies in the domain and no process consumes entropy.
 */

#include <stddef.h>

/*
 * NOISE is the round-off of a change, relative to the size of a state; up to MOST_NOISE times as
 * much is accepted where rates are sums of much larger numbers. NO_SIZE keeps divisors above 0.
 */
#define NOISE (sizeof(real) < sizeof(double) ? 1e-7 : 1e-16)
#define MOST_NOISE (sizeof(real) < sizeof(double) ? 1e5 : 1e4)
#define NO_SIZE (sizeof(real) < sizeof(double) ? 1e-30 : 1e-300)


#if defined(PATHS)
/*
 * Columns of a path functional's row: its bank (-1: none), whether each lane of the bank has a drive
 * of its own, its inner state, and whether a drive depends on it. Then what it gives to a stage, and what its parameters are.
 */
enum { BANK, OWN, INNER, IN_DRIVE };
enum { EFFORT, SLIP, HEAT, SHARE, GIVEN };
enum { STIFFNESS, LIMIT, PARAMETERS };
/* Where in a step, as a fraction, a path functional first begins or ceases to yield; how often some do. */
enum { EARLIEST, HOW_OFTEN, YIELD };
#endif /* PATHS */

/* The work space of a step in all lanes: sizes, states, and intermediate results. */
typedef struct {
    MODEL(reals) p;
    const MODEL(parameters) *own; /* the parameters that were loaded last into a lane of p */
    long n, inputs, means, branches, booked, slopes, processes;
    long given; /* values given to a stage: means, and those of path functionals */
    const long *lanes, *first; /* lanes of each bank; first row of each state */
    real *x, *end;             /* n: states at the begin and the end of the step */
    real *rates;               /* STAGES*n */
    real *branch;              /* STAGES*branches */
    real *u;                   /* STAGES*inputs */
    real *largest;             /* n: largest magnitude of each state, the scale of its errors */
    real *noise;               /* n: how far round-off moves a state that is at rest; else 0 */
    real *reached, *gap, *prior, *node, *mean, *side, *margin, *rows, *slope, *fresh, *real_factor;
#if defined(PATHS)
    long drives;
    real *path, *drive; /* parameters of path functionals; drives at stages and at a point */
    real *follows;      /* the fraction of the step in which each inner state follows its coordinate */
    real *yield;
    real surveyed; /* the length of a survey's step; else 0 */
    long solved[PATHS + 1][2]; /* see FOR_SOLVED */
#endif /* PATHS */
    mask fine;                 /* lanes whose means are taken at FINE nodes */
    mask over;                 /* lanes that step over kinks: each stage chooses its branches */
    mask sketch, sketched;     /* lanes that may stop early, beyond a switch; lanes that did */
    double enough;             /* in units of noise: they stop when a change is below this */
    real iterations;           /* of Newton's method */
    int most, late;            /* iterations in a step; after `late` it may be given up */
    double stays;              /* changes that shrink by no more than this factor stagnate */
} MODEL(block);

#if defined(PATHS)
/* Whether a record of states is the inner states of a bank's path functional. */
static int MODEL(is_inner)(long record, long bank)
{
    int found = 0;
    for (long n = 0; n < PATHS; ++n)
        found |= MODEL(path)[n][INNER] == record && MODEL(path)[n][BANK] == bank;
    return found;
}

/*
 * Whether the lanes of a bank have no states but inner ones, which Newton's method then leaves out. It leaves out
 * none if a drive depends on an inner state: rates that are set would lag behind those by which they are.
 */
static int MODEL(is_left_out)(long bank)
{
    int found = 1;
    for (long k = MODEL(lane_states_at)[bank]; k < MODEL(lane_states_at)[bank + 1]; ++k)
        found &= MODEL(is_inner)(MODEL(lane_states)[k], bank);
    for (long n = 0; n < PATHS; ++n)
        found &= !MODEL(path)[n][IN_DRIVE];
    return found;
}

/* Find the ranges of FOR_SOLVED: they end where a bank is left out. */
static void MODEL(find_solved)(MODEL(block) *m)
{
    long range = 0;
    memset(m->solved, 0, sizeof m->solved);
    for (long record = 0; record < MODEL(records); ++record) {
        const long end = record + 1 < MODEL(records) ? m->first[record + 1] : m->n;
        int left_out = 0;
        for (long bank = 0; bank < MODEL(banks); ++bank)
            left_out |= MODEL(is_inner)(record, bank) && MODEL(is_left_out)(bank);
        if (left_out)
            m->solved[++range][0] = end;
        m->solved[range][1] = end;
    }
}

/*
 * The ranges of the states that Newton's method solves for. Those of banks of path functionals are left out:
 * their rates are set by the rates of their coordinates.
 */
#define FOR_SOLVED(m, begin, end) \
    for (long range = 0, begin, end; range <= PATHS \
         && (begin = (m)->solved[range][0], end = (m)->solved[range][1], 1); ++range)
#endif /* PATHS */
#if !defined(PATHS)
#define FOR_SOLVED(m, begin, end) for (long begin = 0, end = (m)->n; begin < end; begin = end)

static int MODEL(is_left_out)(long bank)
{
    (void)bank;
    return 0;
}
#endif

enum { ALL, SOLVED }; /* the states that a system of equations is solved for */

#define NUMBER real
#define NAMED(name) MODEL(name##_real)
#define ONE wide(1.0)
#define NONE zero
#define PER(a) (1.0 / (a))
#define TIMES(a, b) ((a) * (b))
#define BY(a, b) ((a) * (b))
#define MORE(a, b) ((a) + (b))
#define LESS(a, b) ((a) - (b))
/*
 * Solution of (1 - gamma J) d = r: the states of each bank, lane by lane, are eliminated first,
 * then the shared unknowns in the order of the model's tables. Included twice: NUMBER is `real`, or
 * a complex number of reals, and NAMED(name) tells the two apart.
 */

/* The sum of products over lanes, in parts that do not wait for one another. */
static inline NUMBER NAMED(total)(const NUMBER *restrict a, const real *restrict b, long lanes)
{
    NUMBER sum[4] = {NONE, NONE, NONE, NONE};
    long j = 0;
    for (; j + 4 <= lanes; j += 4)
        for (long part = 0; part < 4; ++part)
            sum[part] = MORE(sum[part], BY(a[j + part], b[j + part]));
    for (; j < lanes; ++j)
        sum[0] = MORE(sum[0], BY(a[j], b[j]));
    return MORE(MORE(sum[0], sum[1]), MORE(sum[2], sum[3]));
}

/* How many numbers a factorisation has. */
static long NAMED(factor_size)(const MODEL(block) *m)
{
    long size = MODEL(slots) + MODEL(unknowns);
    for (long k = 0; k < MODEL(banks); ++k) {
        const long states = MODEL(lane_states_at)[k + 1] - MODEL(lane_states_at)[k];
        const long columns = MODEL(lane_columns_at)[k + 1] - MODEL(lane_columns_at)[k];
        size += states * (states + columns) * m->lanes[k];
    }
    return size;
}

/* Invert the block of each lane in place: its entry (a, b) is m[(a*states + b)*lanes + j]. */
static void NAMED(invert)(NUMBER *restrict m, long states, long lanes)
{
    for (long k = 0; k < states; ++k)
        for (long j = 0; j < lanes; ++j) {
            NUMBER *const pivot = m + (k * states + k) * lanes + j;
            const NUMBER per = PER(*pivot);
            *pivot = ONE;
            for (long b = 0; b < states; ++b)
                m[(k * states + b) * lanes + j] = TIMES(m[(k * states + b) * lanes + j], per);
            for (long a = 0; a < states; ++a) {
                NUMBER *const entry = m + (a * states + k) * lanes + j;
                const NUMBER share = *entry;
                if (a == k)
                    continue;
                *entry = NONE;
                for (long b = 0; b < states; ++b) {
                    NUMBER *const other = m + (a * states + b) * lanes + j;
                    *other = LESS(*other, TIMES(share, m[(k * states + b) * lanes + j]));
                }
            }
        }
}

/* Factorise 1 - gamma J. */
static void NAMED(factorise)(const MODEL(block) *m, NUMBER gamma, const real *slopes,
                             NUMBER *restrict f)
{
    NUMBER *restrict const slot = f;
    const real *lane = slopes + MODEL(entries);
    NUMBER *part = f + MODEL(slots) + MODEL(unknowns);
    const int *update = MODEL(update);
    for (long k = 0; k < MODEL(slots); ++k)
        slot[k] = NONE;
    for (long k = 0; k < MODEL(unknowns); ++k)
        slot[MODEL(pivot)[k]] = ONE;
    for (long k = 0; k < MODEL(entries); ++k)
        slot[MODEL(place)[k]] = LESS(slot[MODEL(place)[k]], BY(gamma, slopes[k]));
    for (long k = 0; k < MODEL(banks); ++k) {
        const long lanes = m->lanes[k];
        const long states = MODEL(lane_states_at)[k + 1] - MODEL(lane_states_at)[k];
        const long columns = MODEL(lane_columns_at)[k + 1] - MODEL(lane_columns_at)[k];
        const long rows = MODEL(lane_rows_at)[k + 1] - MODEL(lane_rows_at)[k];
        const int *const column = MODEL(lane_columns) + MODEL(lane_columns_at)[k];
        const real *const by = lane + states * states * lanes;
        const real *const into = by + states * columns * lanes;
        NUMBER *const reaction = part + states * states * lanes;
        for (long a = 0; a < states; ++a)
            for (long b = 0; b < states; ++b)
                for (long j = 0; j < lanes; ++j) {
                    const long at = (a * states + b) * lanes + j;
                    part[at] = LESS(a == b ? ONE : NONE, BY(gamma, lane[at]));
                }
        NAMED(invert)(part, states, lanes);
        for (long a = 0; a < states; ++a)
            for (long c = 0; c < columns; ++c) {
                const NUMBER factor = column[c] < MODEL(shared) ? gamma : ONE; /* borders: 1 */
                for (long j = 0; j < lanes; ++j) {
                    NUMBER sum = NONE;
                    for (long b = 0; b < states; ++b)
                        sum = MORE(sum, BY(part[(a * states + b) * lanes + j],
                                           by[(b * columns + c) * lanes + j]));
                    reaction[(a * columns + c) * lanes + j] = TIMES(factor, sum);
                }
            }
        for (long r = 0; r < rows; ++r)
            for (long c = 0; c < columns; ++c) {
                NUMBER *const meet = slot + MODEL(meet)[MODEL(first)[k] + r * columns + c];
                NUMBER sum = NONE;
                for (long b = 0; b < states; ++b)
                    sum = MORE(sum, NAMED(total)(reaction + (b * columns + c) * lanes,
                                                 into + (r * states + b) * lanes, lanes));
                *meet = LESS(*meet, TIMES(gamma, sum));
            }
        lane = into + rows * states * lanes;
        part = reaction + states * columns * lanes;
    }
    for (long k = 0; k < MODEL(unknowns); ++k) {
        const NUMBER per = PER(slot[MODEL(pivot)[k]]);
        f[MODEL(slots) + k] = per;
        for (long i = MODEL(below_at)[k]; i < MODEL(below_at)[k + 1]; i += 2) {
            NUMBER *const share = slot + MODEL(below)[i + 1];
            *share = TIMES(*share, per);
            for (long c = MODEL(right_at)[k]; c < MODEL(right_at)[k + 1]; c += 2, ++update)
                slot[*update] = LESS(slot[*update], TIMES(*share, slot[MODEL(right)[c + 1]]));
        }
    }
}

/*
 * Replace the right-hand side r (n) by the solution; if `which` is SOLVED, in the states of FOR_SOLVED alone:
 * those of the others are taken as zero, and neither read nor written.
 */
static void NAMED(solve)(const MODEL(block) *m, NUMBER gamma, const real *slopes,
                         const NUMBER *restrict f, int which, NUMBER *restrict r)
{
    NUMBER y[MODEL(unknowns) + 1];
    const real *lane = slopes + MODEL(entries);
    const NUMBER *part = f + MODEL(slots) + MODEL(unknowns);
    for (long k = 0; k < MODEL(unknowns); ++k)
        y[k] = k < MODEL(shared) ? r[m->first[MODEL(state)[k]]] : NONE;
    for (long k = 0; k < MODEL(banks); ++k) {
        const long lanes = m->lanes[k];
        const long states = MODEL(lane_states_at)[k + 1] - MODEL(lane_states_at)[k];
        const long columns = MODEL(lane_columns_at)[k + 1] - MODEL(lane_columns_at)[k];
        const long rows = MODEL(lane_rows_at)[k + 1] - MODEL(lane_rows_at)[k];
        const int *const state = MODEL(lane_states) + MODEL(lane_states_at)[k];
        const int *const row = MODEL(lane_rows) + MODEL(lane_rows_at)[k];
        const real *const into = lane + states * (states + columns) * lanes;
        const int takes_part = which == ALL || !MODEL(is_left_out)(k);
        for (long j = 0; takes_part && j < lanes; ++j) {
            NUMBER free[MODEL(most_states)];
            for (long a = 0; a < states; ++a) {
                free[a] = NONE;
                for (long b = 0; b < states; ++b)
                    free[a] = MORE(free[a], TIMES(part[(a * states + b) * lanes + j],
                                                  r[m->first[state[b]] + j]));
            }
            for (long a = 0; a < states; ++a)
                r[m->first[state[a]] + j] = free[a];
        }
        for (long i = 0; takes_part && i < rows; ++i) {
            NUMBER sum = NONE;
            for (long b = 0; b < states; ++b)
                sum = MORE(sum, NAMED(total)(r + m->first[state[b]], into + (i * states + b) * lanes,
                                             lanes));
            y[row[i]] = MORE(y[row[i]], TIMES(gamma, sum));
        }
        lane = into + rows * states * lanes;
        part += states * (states + columns) * lanes;
    }
    for (long k = 0; k < MODEL(unknowns); ++k)
        for (long i = MODEL(below_at)[k]; i < MODEL(below_at)[k + 1]; i += 2)
            y[MODEL(below)[i]] = LESS(y[MODEL(below)[i]],
                                      TIMES(f[MODEL(below)[i + 1]], y[MODEL(order)[k]]));
    for (long k = MODEL(unknowns) - 1; k >= 0; --k) {
        NUMBER sum = y[MODEL(order)[k]];
        for (long c = MODEL(right_at)[k]; c < MODEL(right_at)[k + 1]; c += 2)
            sum = LESS(sum, TIMES(f[MODEL(right)[c + 1]], y[MODEL(right)[c]]));
        y[MODEL(order)[k]] = TIMES(sum, f[MODEL(slots) + k]);
    }
    for (long k = 0; k < MODEL(shared); ++k)
        r[m->first[MODEL(state)[k]]] = y[k];
    part = f + MODEL(slots) + MODEL(unknowns);
    for (long k = 0; k < MODEL(banks); ++k) {
        const long lanes = m->lanes[k];
        const long states = MODEL(lane_states_at)[k + 1] - MODEL(lane_states_at)[k];
        const long columns = MODEL(lane_columns_at)[k + 1] - MODEL(lane_columns_at)[k];
        const int *const state = MODEL(lane_states) + MODEL(lane_states_at)[k];
        const int *const column = MODEL(lane_columns) + MODEL(lane_columns_at)[k];
        const NUMBER *const reaction = part + states * states * lanes;
        const int takes_part = which == ALL || !MODEL(is_left_out)(k);
        for (long a = 0; takes_part && a < states; ++a)
            for (long c = 0; c < columns; ++c)
                for (long j = 0; j < lanes; ++j) {
                    NUMBER *const d = r + m->first[state[a]] + j;
                    *d = MORE(*d, TIMES(reaction[(a * columns + c) * lanes + j], y[column[c]]));
                }
        part += states * (states + columns) * lanes;
    }
}
#undef NUMBER
#undef NAMED
#undef ONE
#undef NONE
#undef PER
#undef TIMES
#undef BY
#undef MORE
#undef LESS

/* Entries of `sizes`: counts, lanes of banks, first rows of states, and bend functions. */
enum { SIZES = 7 + MODEL(banks) + MODEL(records) };

/*
 * Set up the work space of runs with the sizes of p in `memory`, which may be NULL; returns how
 * many numbers it takes. Ledgers have `more` rows behind the model's own.
 */
static long MODEL(make)(MODEL(block) *m, const MODEL(parameters) *p, long more, long *sizes,
                        real *memory)
{
    long at = MODEL(place_reals)(&m->p, p, memory);
    MODEL(sizes)(&m->p, sizes);
    const long n = m->n = sizes[0];
    m->means = sizes[1], m->branches = sizes[2], m->booked = sizes[3] + more;
    m->processes = sizes[4], m->slopes = sizes[5];
    m->inputs = MODEL(input_count);
    m->lanes = sizes + 6, m->first = sizes + 6 + MODEL(banks);
    m->given = m->means;
#if defined(PATHS)
    long paths = 0;
    m->drives = 0;
    for (long k = 0; k < PATHS; ++k) {
        const long lanes = MODEL(path)[k][BANK] < 0 ? 1 : m->lanes[MODEL(path)[k][BANK]];
        paths += lanes, m->drives += MODEL(path)[k][OWN] ? lanes : 1;
    }
    MODEL(find_solved)(m);
    m->given += GIVEN * paths;
#endif /* PATHS */
#define PLACE(array, size) (m->array = memory ? (void *)(memory + at) : NULL, at += (size))
    PLACE(x, n);
    PLACE(end, n);
    PLACE(rates, STAGES * n);
    PLACE(branch, STAGES * m->branches);
    PLACE(u, STAGES * m->inputs);
    PLACE(largest, n);
    PLACE(noise, n);
    PLACE(reached, n);
    PLACE(gap, STAGES * n);
    PLACE(prior, STAGES * n);
    PLACE(node, FINE * m->means + m->given - m->means);
    PLACE(mean, STAGES * m->given);
    PLACE(side, STAGES * m->branches);
    PLACE(margin, STAGES * MODEL(limits));
    PLACE(rows, STAGES * m->booked);
    PLACE(slope, m->slopes);
#if defined(PATHS)
    PLACE(path, PARAMETERS * paths);
    PLACE(follows, paths);
    PLACE(drive, (STAGES + 1) * m->drives);
    PLACE(yield, YIELD);
#endif /* PATHS */
    m->fresh = m->slope; /* of one run there is no lane that keeps its slopes */
    if (REAL_WIDTH > 1)
        PLACE(fresh, m->slopes);
    PLACE(real_factor, MODEL(factor_size_real)(m));
#undef PLACE
    return at;
}

/* State i at a point of the step, which weights of the stages' rates say. */
static inline real MODEL(reached_row)(const MODEL(block) *m, real h, const double *weight, long i)
{
    real sum = zero;
    for (long j = 0; j < STAGES; ++j)
        sum += weight[j] * m->rates[j * m->n + i];
    return m->x[i] + h * sum;
}

/* All states at a point of the step. */
static void MODEL(reach_of)(const MODEL(block) *m, real h, const double *weight, real *restrict out)
{
    for (long i = 0; i < m->n; ++i)
        out[i] = MODEL(reached_row)(m, h, weight, i);
}

/*
 * Set branches by the signs of their switching functions, in some lanes; returns the lanes with
 * changes.
 */
static mask MODEL(choose)(long branches, const real *side, real *branch, mask where)
{
    mask changed = nowhere;
    for (long k = 0; k < branches; ++k) {
        const mask positive = side[k] > 0.0;
        const real old = branch[k], new = chosen(positive, wide(1.0), zero);
        changed |= where & (new != old);
        branch[k] = chosen(where, new, old);
    }
    return changed;
}

/*
 * The path of a coordinate C in a step, whose rates at the stages are the drive of path functionals.
 * Comes after gauss.c, for models that have PATHS.
 */

/*
 * The coefficients of C(tau) - C(0) and of dC/dtau; its change up to each stage and its rate there; a
 * bound on |C(tau) - C(0)|. C is monotonic between turn[k] and turn[k + 1]. `yields` is the first part
 * of the step where z begins, or ceases, to yield, as it does `times` times.
 */
typedef struct {
    double gone[STAGES + 1], speed[STAGES], at_stage[STAGES], rate[STAGES], turn[STAGES + 1];
    double h, most, yields, times;
    long pieces;
} MODEL(coordinate);

static double MODEL(polynomial)(const double *a, long degree, double at)
{
    double sum = a[degree];
    for (long n = degree; n-- > 0;)
        sum = a[n] + at * sum;
    return sum;
}

/* Where a polynomial, monotonic from low to high, has a value: by Newton's method and bisection. */
static double MODEL(meets)(const double *a, long degree, double value, double low, double high)
{
    const int rises = MODEL(polynomial)(a, degree, low) < MODEL(polynomial)(a, degree, high);
    double at = 0.5 * (low + high);
    for (int again = 0; again < 100; ++again) {
        double sum = a[degree], slope = 0.0;
        for (long n = degree; n-- > 0;) {
            slope = sum + at * slope;
            sum = a[n] + at * sum;
        }
        const double before = at;
        if ((sum < value) == rises)
            low = at;
        else
            high = at;
        at -= (sum - value) / slope;
        if (!(at > low && at < high))
            at = 0.5 * (low + high);
        if (fabs(at - before) <= 4e-16)
            break;
    }
    return at;
}

/* Find where a coordinate turns: zeros of its speed lie between those of the speed's derivative. */
static void MODEL(find_turns)(MODEL(coordinate) *w)
{
    w->turn[0] = 0.0, w->turn[1] = 1.0, w->pieces = 1;
    for (long order = STAGES - 2; order >= 0; --order) {
        double a[STAGES], found[STAGES + 1] = {0.0};
        const long degree = STAGES - 1 - order;
        long pieces = 0;
        for (long n = 0; n <= degree; ++n) {
            a[n] = w->speed[n + order];
            for (long k = 1; k <= order; ++k)
                a[n] *= (double)(n + k);
        }
        for (long k = 0; k < w->pieces; ++k) {
            const double low = w->turn[k], high = w->turn[k + 1];
            const double at_low = MODEL(polynomial)(a, degree, low);
            if ((at_low < 0.0) != (MODEL(polynomial)(a, degree, high) < 0.0))
                found[++pieces] = MODEL(meets)(a, degree, 0.0, low, high);
        }
        found[++pieces] = 1.0;
        memcpy(w->turn, found, sizeof found);
        w->pieces = pieces;
    }
}

/* The path of a coordinate that has drive number i, in one lane's step. */
static void MODEL(find_coordinate)(const MODEL(block) *m, double h, long i, int lane, MODEL(coordinate) *w)
{
    double square = 0.0;
    (void)lane; /* a number has no lanes */
    w->h = h;
    w->gone[0] = 0.0;
    for (long j = 0; j < STAGES; ++j) {
        w->rate[j] = LANE(m->drive, j * m->drives + i, lane);
        square += stage_weight[j] * w->rate[j] * w->rate[j];
    }
    w->most = h * sqrt(square); /* the mean of |dC/dt| is at most its root mean square */
    for (long n = 0; n < STAGES; ++n) {
        double sum = 0.0, at_stage = 0.0;
        for (long j = 0; j < STAGES; ++j) {
            sum += along[j][n] * w->rate[j];
            at_stage += stage_reach[n][j] * w->rate[j];
        }
        w->gone[n + 1] = h * sum;
        w->speed[n] = (double)(n + 1) * h * sum;
        w->at_stage[n] = h * at_stage;
    }
    w->pieces = 0; /* found when needed */
}

/*
 * A path functional: what an element with an inner state z does while its coordinate C, whose rates
 * at the stages are its drive, follows a polynomial. Comes after coordinate.c.
 *
 * Stage i is given the means int_0^1 (l_i/b_i) ... dtau of the effort F, of the slip's rate
 * dC/dt - dz/dt and of the heat. So h sum_i b_i F_i C'_i is the work int F dC, and z ends where its
 * path ends, wherever it begins or ceases to yield.
 *
 * Stops on one coordinate have one polynomial: they are computed side by side, without branches.
 */

/* What happens before this fraction of a step counts as at its beginning. */
#define BEGUN 1e-6
/* An inner state this close to its limit, relative to it, was put there by the step before. */
#define PUT_THERE 1e-14
/* Accuracy of a place, as a fraction of the step: the error of work done there goes with its square. */
#define FOUND 1e-8

/* Stops on one coordinate, side by side: the most at a time, and lanes searched at a time. */
enum { SOME = 64, SEEN = 16 };

/*
 * What they have: inner state, stiffness, limit. What they give: for the stages the means of effort,
 * rate of the slip and heat; the share, and the fraction of the step in which z follows C. On the way:
 * where z is, whether it yields, and since when it follows C; the heat, and where in a piece of the step
 * it comes to its limit.
 *
 * The share is for Newton's method: how the mean effort responds to a constant change of dC/dt, relative
 * to that of a z that follows C all the way. It is a*a if z follows C in one stretch, a fraction a of the
 * step: a change of C that grows from there on acts for a fraction a, and is a/2 on the mean.
 */
typedef struct {
    long count;
    double z[SOME], k[SOME], r[SOME];
    double mean[SHARE][STAGES][SOME], share[SOME], follows[SOME];
    double now[SOME], yields[SOME], since[SOME], heat[SOME], room[SOME], meets[SOME], until[SOME];
    double lead[STAGES][SOME], moved[STAGES][SOME];
} MODEL(stops);

/* A piece of a step, in which C is monotonic: its ends, C there, and the side to which it goes. */
typedef struct {
    double low, high, from, more, side;
} MODEL(piece);

/*
 * The piece's part up to which z follows C: to the end, or to where C has moved by the distance
 * to the limit. By Newton's method and bisection, in all lanes as long as one of them moves.
 */
static void MODEL(find_limits)(const MODEL(coordinate) *w, const MODEL(piece) *piece, MODEL(stops) *s)
{
    double low[SOME], high[SOME], moving = 0.0;
    for (long j = 0; j < s->count; ++j) {
        const double left = piece->side * s->r[j] - s->now[j];
        const double room = fabs(left) <= PUT_THERE * s->r[j] ? 0.0 : left;
        const double meets = fabs(piece->more) > fabs(room) ? 1.0 : 0.0;
        const double part = meets > 0.0 ? room / piece->more : 1.0;
        s->room[j] = room, s->meets[j] = meets;
        low[j] = piece->low, high[j] = piece->high;
        s->until[j] = piece->low + part * (piece->high - piece->low);
        moving += part > 0.0 && part < 1.0 ? 1.0 : 0.0;
    }
    for (int again = 0; STAGES > 1 && again < 100 && moving > 0.0; ++again) {
        moving = 0.0;
#pragma omp simd reduction(+ : moving)
        for (long j = 0; j < s->count; ++j) {
            const double at = s->until[j];
            double sum = w->gone[STAGES], slope = 0.0;
            for (long n = STAGES; n-- > 0;) {
                slope = sum + at * slope;
                sum = w->gone[n] + at * sum;
            }
            const double over = piece->side * (sum - piece->from - s->room[j]);
            const double below = over < 0.0 ? at : low[j], above = over < 0.0 ? high[j] : at;
            const double next = at - piece->side * over / slope, half = 0.5 * (below + above);
            const double inside = next > below && next < above ? next : half;
            const double search = s->meets[j] > 0.0 && s->room[j] != 0.0 ? 1.0 : 0.0;
            low[j] = below, high[j] = above;
            s->until[j] = search > 0.0 ? inside : at;
            moving += search > 0.0 && fabs(inside - at) > FOUND ? 1.0 : 0.0;
        }
    }
}

/*
 * Add the means of the effort in a piece's part in which z follows C: F = k (now + C - C(low)).
 * Integrals of the stages' weights over that part, and of these times the rate of C, are in `lead`
 * and `moved`. Exact: all integrands are of degree < 2s.
 */
static void MODEL(add_following)(const MODEL(coordinate) *w, const MODEL(piece) *piece, MODEL(stops) *s)
{
    memset(s->lead, 0, sizeof s->lead);
    memset(s->moved, 0, sizeof s->moved);
    for (long q = 0; q < STAGES; ++q)
#pragma omp simd
        for (long j = 0; j < s->count; ++j) {
            const double length = s->until[j] - piece->low, at = piece->low + length * stage_at[q];
            const double gone = MODEL(polynomial)(w->gone, STAGES, at) - piece->from;
            const double effort = s->k[j] * (s->now[j] + gone);
            const double rate = MODEL(polynomial)(w->speed, STAGES - 1, at) / w->h;
            for (long i = 0; i < STAGES; ++i) {
                double part = length * stage_weight[q] * (stage_lead[i] / stage_weight[i]);
                for (long n = 0; n < STAGES; ++n)
                    part *= n == i ? 1.0 : at - stage_at[n];
                s->lead[i][j] += part;
                s->moved[i][j] += part * rate;
                s->mean[EFFORT][i][j] += part * effort;
            }
        }
}

/* Add the means of the piece's rest, in which z stays at its limit: all but the part before. */
static void MODEL(add_yielding)(const MODEL(coordinate) *w, const MODEL(piece) *piece, MODEL(stops) *s)
{
    const double length = piece->high - piece->low;
    for (long i = 0; i < STAGES; ++i) {
        double lead = 0.0, moved = 0.0;
        for (long q = 0; q < STAGES; ++q) {
            const double at = piece->low + length * stage_at[q];
            double part = length * stage_weight[q] * (stage_lead[i] / stage_weight[i]);
            for (long n = 0; n < STAGES; ++n)
                part *= n == i ? 1.0 : at - stage_at[n];
            lead += part;
            moved += part * (MODEL(polynomial)(w->speed, STAGES - 1, at) / w->h);
        }
#pragma omp simd
        for (long j = 0; j < s->count; ++j) {
            const double effort = s->k[j] * (piece->side * s->r[j]);
            const double slip = s->meets[j] > 0.0 ? moved - s->moved[i][j] : 0.0;
            s->mean[EFFORT][i][j] += s->meets[j] > 0.0 ? effort * (lead - s->lead[i][j]) : 0.0;
            s->mean[SLIP][i][j] += slip;
            s->mean[HEAT][i][j] += effort * slip;
        }
    }
}

/* Take stops to the end of a piece, and note where they begin, or cease, to yield. */
static void MODEL(pass)(MODEL(coordinate) *w, const MODEL(piece) *piece, MODEL(stops) *s)
{
    double first = w->yields, times = 0.0;
#pragma omp simd reduction(+ : times) reduction(min : first)
    for (long j = 0; j < s->count; ++j) {
        const double until = s->until[j], limit = piece->side * s->r[j];
        const double begins = s->meets[j] > 0.0 ? until : 1.0;
        const double place = s->yields[j] > 0.0 && until > piece->low ? piece->low : begins;
        const double inside = place > BEGUN && place < 1.0 ? place : 1.0;
        const double beyond = s->k[j] * s->r[j] * (fabs(piece->more) - fabs(s->room[j]));
        times += inside < 1.0 ? 1.0 : 0.0;
        first = inside < first ? inside : first;
        s->heat[j] += s->meets[j] > 0.0 ? beyond : 0.0;
        s->now[j] = s->meets[j] > 0.0 ? limit : s->now[j] + piece->more;
        const double since = s->yields[j] > 0.0 ? piece->low : s->since[j];
        s->follows[j] += until - piece->low;
        s->share[j] += (until - piece->low) * (until + piece->low - 2.0 * since);
        s->since[j] = since;
        s->yields[j] = s->meets[j];
    }
    w->yields = first;
    w->times += times;
}

/*
 * Let the means add up to all of the slip and all of the heat. A stage's mean of the heat may be
 * negative: it becomes 0, the others are scaled to the total.
 */
static void MODEL(settle)(const MODEL(coordinate) *w, MODEL(stops) *s)
{
    const double gone = MODEL(polynomial)(w->gone, STAGES, 1.0);
#pragma omp simd
    for (long j = 0; j < s->count; ++j) {
        double yielded = 0.0, slipped = 0.0;
        for (long i = 0; i < STAGES; ++i) {
            const double heat = s->mean[HEAT][i][j] > 0.0 ? s->mean[HEAT][i][j] : 0.0;
            s->mean[HEAT][i][j] = heat;
            yielded += stage_weight[i] * heat;
            slipped += stage_weight[i] * s->mean[SLIP][i][j];
        }
        const double rest = (gone - (s->now[j] - s->z[j])) / w->h - slipped;
        const double heat = s->heat[j] / w->h, part = yielded > 0.0 ? heat / yielded : 0.0;
        for (long i = 0; i < STAGES; ++i) {
            s->mean[HEAT][i][j] = yielded > 0.0 ? part * s->mean[HEAT][i][j] : heat;
            s->mean[SLIP][i][j] += rest;
        }
    }
}

/* Stop elements: F = k z; z follows C, but stays at -r or r while C goes further. */
static void MODEL(stop)(MODEL(coordinate) *w, MODEL(stops) *s)
{
    memset(s->mean, 0, sizeof s->mean);
    for (long j = 0; j < s->count; ++j) {
        const double z = s->z[j], r = s->r[j];
        const double begin = z > r ? r : z < -r ? -r : z; /* r may have become less */
        s->now[j] = begin;
        s->heat[j] = 0.5 * s->k[j] * (z - begin) * (z + begin);
        s->share[j] = s->follows[j] = s->yields[j] = s->since[j] = 0.0;
    }
    if (!w->pieces)
        MODEL(find_turns)(w);
    for (long n = 0; n < w->pieces; ++n) {
        MODEL(piece) piece = {.low = w->turn[n], .high = w->turn[n + 1]};
        piece.from = MODEL(polynomial)(w->gone, STAGES, piece.low);
        piece.more = MODEL(polynomial)(w->gone, STAGES, piece.high) - piece.from;
        piece.side = piece.more > 0.0 ? 1.0 : -1.0;
        MODEL(find_limits)(w, &piece, s);
        MODEL(add_following)(w, &piece, s);
        MODEL(add_yielding)(w, &piece, s);
        MODEL(pass)(w, &piece, s);
    }
    MODEL(settle)(w, s);
}

/* The values of path functionals at the stages of a step, and at a point. Comes after stop.c. */

/* At a single point, an inner state this close to its limit, relative to it, counts as at it. */
#define AT_LIMIT 1e-9

/*
 * The course of a coordinate that lanes of a bank share: its rates at the stages, its change up to
 * each stage, its least and largest change; whether it turns, and if not, whether it rises.
 */
typedef struct {
    real h, rate[STAGES], at_stage[STAGES], least, largest;
    mask turns, rises;
} MODEL(course);

/* The course of a coordinate, given in each lane of a number. */
static MODEL(course) MODEL(course_of)(MODEL(coordinate) *w, real h)
{
    MODEL(course) c = {.h = h, .least = zero, .largest = zero};
    real pieces = zero;
    for (int lane = 0; lane < REAL_WIDTH; ++lane, ++w) {
        MODEL(find_turns)(w);
        for (long i = 0; i < STAGES; ++i) {
            OF(c.rate[i], lane) = w->rate[i];
            OF(c.at_stage[i], lane) = w->at_stage[i];
        }
        for (long k = 1; k <= w->pieces; ++k) {
            const double at = MODEL(polynomial)(w->gone, STAGES, w->turn[k]);
            OF(c.least, lane) = at < OF(c.least, lane) ? at : OF(c.least, lane);
            OF(c.largest, lane) = at > OF(c.largest, lane) ? at : OF(c.largest, lane);
        }
        OF(pieces, lane) = (double)w->pieces;
    }
    c.turns = pieces > 1.0;
    c.rises = c.largest > 0.0;
    return c;
}

/* The share, as in stop.c: 1 where z follows C all the way, 0 where it yields all the way, else -1. */
static inline real MODEL(share_of)(const MODEL(course) *c, real limit, real z, real r)
{
    const real neither = wide(-1.0), far = chosen(c->turns, neither, wide(PUT_THERE));
    const real outside = chosen(size_of(z - limit) <= far * r, zero, neither);
    const real above = chosen(z + c->largest <= r, wide(1.0), outside);
    return chosen(z + c->least >= -r, above, outside);
}

/*
 * What lanes of a bank give to stage i, where z follows C all the way, or yields all the way: in closed form.
 * Returns how many other lanes there are; their share becomes negative. The first stage finds the shares.
 */
static inline real MODEL(stage_in_closed_form)(const MODEL(block) *m, const MODEL(course) *c, long lanes, long i,
                                               const real *restrict z, const real *restrict parameter,
                                               real *first_given, real *restrict rate,
                                               real *restrict follows)
{
    const real *restrict const k = parameter + STIFFNESS * lanes;
    const real *restrict const r = parameter + LIMIT * lanes;
    real *restrict const effort = first_given + i * m->given + EFFORT * lanes;
    real *restrict const slip = first_given + i * m->given + SLIP * lanes;
    real *restrict const heat = first_given + i * m->given + HEAT * lanes;
    real *restrict const share = first_given + i * m->given + SHARE * lanes;
    const real *const found = first_given + SHARE * lanes;
    const real side = chosen(c->rises, wide(1.0), wide(-1.0)), per = 1.0 / c->h;
    const real drive = c->rate[i], at_stage = c->at_stage[i];
    real others = zero;
#pragma omp simd reduction(+ : others)
    for (long j = 0; j < lanes; ++j) {
        const real limit = side * r[j], put = (limit - z[j]) * per;
        const real part = i ? found[j] : MODEL(share_of)(c, limit, z[j], r[j]);
        const real there = z[j] + at_stage, yields = chosen(part == 0.0, wide(1.0), zero);
        const real force = k[j] * chosen(part == 0.0, limit, there);
        share[j] = part;
        if (!i)
            follows[j] = part;
        effort[j] = force;
        slip[j] = yields * (drive - put);
        heat[j] = yields * (force * drive);
        rate[j] = chosen(part == 0.0, put, drive);
        others += chosen(part < 0.0, wide(1.0), zero);
    }
    return others;
}

/* The same for all stages. */
static real MODEL(in_closed_form)(const MODEL(block) *m, const MODEL(course) *c, long lanes, const real *z,
                                  const real *parameter, real *given, real *rates, real *follows)
{
    const real others = MODEL(stage_in_closed_form)(m, c, lanes, 0, z, parameter, given, rates, follows);
    for (long i = 1; i < STAGES; ++i)
        MODEL(stage_in_closed_form)(m, c, lanes, i, z, parameter, given, rates + i * m->n, follows);
    return others;
}

/* Compute stops of one coordinate, lanes `which` of a bank, in one lane of numbers. */
static void MODEL(along_path)(const MODEL(block) *m, MODEL(coordinate) *w, MODEL(stops) *s, const long *which,
                              long lanes, int lane, const real *z, const real *parameter, real *given,
                              real *rates, real *follows)
{
    for (long k = 0; k < s->count; ++k) {
        s->z[k] = LANE(z, which[k], lane);
        s->k[k] = LANE(parameter, STIFFNESS * lanes + which[k], lane);
        s->r[k] = LANE(parameter, LIMIT * lanes + which[k], lane);
    }
    MODEL(stop)(w, s);
    for (long k = 0; k < s->count; ++k)
        LANE(follows, which[k], lane) = s->follows[k];
    for (long i = 0; i < STAGES; ++i)
        for (long k = 0; k < s->count; ++k) {
            const long j = which[k];
            for (long what = 0; what < SHARE; ++what)
                LANE(given + i * m->given, what * lanes + j, lane) = s->mean[what][i][k];
            LANE(given + i * m->given, SHARE * lanes + j, lane) = s->share[k];
            LANE(rates, i * m->n + j, lane) = w->rate[i] - s->mean[SLIP][i][k];
        }
}

/* The same for those of a bank's lanes that are not in closed form: their share is negative. */
static void MODEL(along_others)(const MODEL(block) *m, MODEL(coordinate) *w, long lanes, int lane,
                                const real *z, const real *parameter, real *given, real *rates, real *follows)
{
    const real *const share = given + SHARE * lanes;
    MODEL(stops) some;
    long which[SOME];
    some.count = 0;
    for (long j = 0; j < lanes; j += SEEN) {
        const long end = j + SEEN < lanes ? j + SEEN : lanes;
        double others = 0.0;
#pragma omp simd reduction(+ : others)
        for (long k = j; k < end; ++k)
            others += LANE(share, k, lane) < 0.0 ? 1.0 : 0.0;
        for (long k = j; others > 0.0 && k < end; ++k) {
            which[some.count] = k;
            some.count += LANE(share, k, lane) < 0.0;
        }
        if (some.count + SEEN > SOME || (end == lanes && some.count)) {
            MODEL(along_path)(m, w, &some, which, lanes, lane, z, parameter, given, rates, follows);
            some.count = 0;
        }
    }
}

/* Each lane of a bank by itself, from drive number `drive` on: each has a coordinate of its own if `own`. */
static void MODEL(along_each)(const MODEL(block) *m, MODEL(coordinate) *w, long drive, int own, long lanes,
                              int lane, const real *z, const real *parameter, real *given, real *rates,
                              real *follows)
{
    MODEL(stops) one;
    one.count = 1;
    for (long j = 0; j < lanes; ++j) {
        if (j && own)
            MODEL(find_coordinate)(m, w->h, drive + j, lane, w);
        MODEL(along_path)(m, w, &one, &j, lanes, lane, z, parameter, given, rates, follows);
    }
}

/* The states that Newton's method solves for, at a point of the step. */
static void MODEL(reach_solved)(const MODEL(block) *m, real h, const double *weight, real *restrict out)
{
    FOR_SOLVED (m, begin, end)
        for (long i = begin; i < end; ++i)
            out[i] = MODEL(reached_row)(m, h, weight, i);
}

/* The drives at the stages, which depend on no states but these. */
static void MODEL(find_drives)(const MODEL(block) *m, real h)
{
    for (long i = 0; i < STAGES; ++i) {
        MODEL(reach_solved)(m, h, stage_reach[i], m->reached);
        MODEL(drives)(m->reached, m->mean + i * m->given, m->branch + i * m->branches,
                      m->u + i * m->inputs, &m->p, m->drive + i * m->drives);
    }
}

/*
 * What path functionals give to the stages. Rates of inner states are set, not solved for: they follow
 * from the drives, and Newton's method takes efforts as stiffness * z.
 */
static void MODEL(along_paths)(const MODEL(block) *m, real h)
{
    const real *parameter = m->path;
    real *given = m->mean + m->means, *follows = m->follows;
    long drive = 0;
    m->yield[EARLIEST] = wide(1.0);
    m->yield[HOW_OFTEN] = zero;
    MODEL(find_drives)(m, h);
    for (long n = 0; n < PATHS; ++n) {
        const int *path = MODEL(path)[n];
        const long lanes = path[BANK] < 0 ? 1 : m->lanes[path[BANK]], first = m->first[path[INNER]];
        const real *const z = m->x + first;
        real *const rates = m->rates + first;
        const int together = !path[OWN] && lanes > 1;
        MODEL(coordinate) w[REAL_WIDTH];
        for (int lane = 0; lane < REAL_WIDTH; ++lane) {
            MODEL(find_coordinate)(m, OF(h, lane), drive, lane, w + lane);
            w[lane].yields = LANE(m->yield, EARLIEST, lane);
            w[lane].times = LANE(m->yield, HOW_OFTEN, lane);
        }
        real others = zero;
        if (together) {
            const MODEL(course) c = MODEL(course_of)(w, h);
            others = MODEL(in_closed_form)(m, &c, lanes, z, parameter, given, rates, follows);
        }
        for (int lane = 0; lane < REAL_WIDTH; ++lane) {
            MODEL(coordinate) *const coordinate = w + lane;
            if (OF(others, lane) > 0.0)
                MODEL(along_others)(m, coordinate, lanes, lane, z, parameter, given, rates, follows);
            else if (!together)
                MODEL(along_each)(m, coordinate, drive, path[OWN], lanes, lane, z, parameter, given, rates,
                                  follows);
            LANE(m->yield, EARLIEST, lane) = coordinate->yields;
            LANE(m->yield, HOW_OFTEN, lane) = coordinate->times;
        }
        given += GIVEN * lanes, parameter += PARAMETERS * lanes, follows += lanes;
        drive += path[OWN] ? lanes : 1;
    }
}

/*
 * Slip and heat at an end of a step, extrapolated from the stages' means; but for the part of the step in
 * which it yields, slip follows the drive there: an inner state that does not move has no misfit.
 */
static void MODEL(of_stages)(const MODEL(block) *m, const double *weight, long lanes, const real *drives,
                             const real *follows, int own, real *restrict given)
{
    const real *const mean = m->mean + (given - m->node);
#pragma omp simd
    for (long j = 0; j < lanes; ++j) {
        const real *const drive = drives + own * j;
        const real yields = 1.0 - follows[j];
        real slip = yields * drive[STAGES * m->drives], heat = zero;
        for (long i = 0; i < STAGES; ++i) {
            const real *const stage = mean + i * m->given + j;
            slip += weight[i] * (stage[SLIP * lanes] - yields * drive[i * m->drives]);
            heat += weight[i] * stage[HEAT * lanes];
        }
        given[SLIP * lanes + j] = slip;
        given[HEAT * lanes + j] = heat;
    }
}

/*
 * Stops where they stand: at its limit one yields if its coordinate goes on outward. In the middle of a
 * survey's step, which begins at m->x: halfway to where the present rate leads it.
 */
static void MODEL(stand)(const MODEL(block) *m, const real *restrict begin, const real *restrict parameter,
                         const real *drives, int own, long lanes, real *restrict given)
{
    const real h = m->surveyed, per = chosen(h > 0.0, 1.0 / h, zero), part = chosen(h > 0.0, wide(0.5), zero);
    real *restrict const slip = given + SLIP * lanes;
    for (long j = 0; j < lanes; ++j)
        slip[j] = drives[own * j];
#pragma omp simd
    for (long j = 0; j < lanes; ++j) {
        const real k = parameter[STIFFNESS * lanes + j], r = parameter[LIMIT * lanes + j], rate = slip[j];
        const real went = begin[j] + h * rate, below = chosen(went > r, r, went);
        const real end = chosen(below < -r, -r, below);
        const real z = part * begin[j] + (1.0 - part) * end;
        const real ahead = end * rate, outward = chosen(r > 0.0, ahead, wide(1.0));
        const real near = r * (1.0 - AT_LIMIT), out = chosen(size_of(end) >= near, outward, zero);
        const real yields = chosen(out > 0.0, wide(1.0), zero);
        const real slips = yields * (rate - (end - begin[j]) * per);
        given[EFFORT * lanes + j] = k * z;
        slip[j] = slips;
        given[HEAT * lanes + j] = k * z * slips;
        given[SHARE * lanes + j] = 1.0 - yields;
    }
}

/* What path functionals give at a point: it follows from the drives there, or `of_stages` (`weight`). */
static void MODEL(standing)(const MODEL(block) *m, const real *x, const real *branch, const real *u,
                            const double *weight)
{
    const real *parameter = m->path, *drives = m->drive, *follows = m->follows;
    real *given = m->node + m->means;
    MODEL(path_parameters)(x, &m->p, m->path);
    MODEL(drives)(x, m->node, branch, u, &m->p, m->drive + STAGES * m->drives);
    for (long n = 0; n < PATHS; ++n) {
        const int *path = MODEL(path)[n], own = path[OWN];
        const long lanes = path[BANK] < 0 ? 1 : m->lanes[path[BANK]], first = m->first[path[INNER]];
        const real *const begin = (any(m->surveyed > 0.0) ? m->x : x) + first;
        MODEL(stand)(m, begin, parameter, drives + STAGES * m->drives, own, lanes, given);
        if (weight)
            MODEL(of_stages)(m, weight, lanes, drives, follows, own, given);
        given += GIVEN * lanes, parameter += PARAMETERS * lanes, follows += lanes;
        drives += own ? lanes : 1;
    }
}

/*
 * The residuals (gaps) of a step's equations, stage by stage, and the means in them. Comes after
 * gauss.c.
 */

/* Tables: weights for the states at nodes; matrices into and out of the basis of decoupled stages. */
#define NODE_REACH node_reach
#define FINE_REACH fine_reach
#define BASIS_STAGE basis_inverse
#define STAGE_BASIS stage_basis

/* The states, at a point of the step, that integrands read. */
static void MODEL(reach_read)(const MODEL(block) *m, real h, const double *weight)
{
    for (long r = 0; r < MODEL(reads); ++r) {
        const long record = MODEL(read)[r];
        const long end = record + 1 < MODEL(records) ? m->first[record + 1] : m->n;
        for (long i = m->first[record]; i < end; ++i)
            m->reached[i] = MODEL(reached_row)(m, h, weight, i);
    }
}

/* The integrands of the means, at nodes of a step. */
static void MODEL(integrate)(const MODEL(block) *m, real h, const double reach[][STAGES], long nodes)
{
    for (long q = 0; q < nodes; ++q) {
        MODEL(reach_read)(m, h, reach[q]);
        MODEL(integrands)(m->reached, &m->p, m->node + q * m->means);
    }
}

/* Means over the step, with as many nodes as each lane needs. */
static void MODEL(average)(const MODEL(block) *m, real h)
{
    MODEL(integrate)(m, h, node_reach, NODES);
    for (long i = 0; i < STAGES; ++i)
        for (long k = 0; k < m->means; ++k) {
            real *const mean = m->mean + i * m->given + k;
            *mean = zero;
            for (long q = 0; q < NODES; ++q)
                *mean += node_mean[i][q] * m->node[q * m->means + k];
        }
    if (!any(m->fine))
        return;
    MODEL(integrate)(m, h, fine_reach, FINE);
    for (long i = 0; i < STAGES; ++i)
        for (long k = 0; k < m->means; ++k) {
            real *const mean = m->mean + i * m->given + k, sum = zero;
            for (long q = 0; q < FINE; ++q)
                sum += fine_mean[i][q] * m->node[q * m->means + k];
            *mean = chosen(m->fine, sum, *mean);
        }
}


/* Residuals: the rates by the laws at the stages less `rates`; returns where branches change. */
static mask MODEL(gaps)(const MODEL(block) *m, real h, mask going)
{
    const mask over = m->over & going;
    mask changed = nowhere;
    if (m->means)
        MODEL(average)(m, h);
#if defined(PATHS)
    MODEL(along_paths)(m, h);
#endif /* PATHS */
    for (long i = 0; i < STAGES; ++i) {
        real *gap = m->gap + i * m->n, *mean = m->mean + i * m->given;
        real *side = m->side + i * m->branches, *branch = m->branch + i * m->branches;
        MODEL(reach_of)(m, h, stage_reach[i], m->reached);
        for (int again = 0; again < 3; ++again) {
            MODEL(stage)(m->reached, mean, branch, m->u + i * m->inputs, &m->p, gap,
                         m->rows + i * m->booked, side, m->margin + i * MODEL(limits));
            if (!any(over))
                break;
            const mask other = MODEL(choose)(m->branches, side, branch, over);
            if (!any(other))
                break;
            changed |= other;
        }
        FOR_SOLVED (m, begin, end)
            for (long k = begin; k < end; ++k)
                gap[k] -= m->rates[i * m->n + k];
    }
    return changed;
}

/* Multiply the residuals of each state, a vector over the stages, by a matrix. */
static void MODEL(transform)(const MODEL(block) *m, const double matrix[][STAGES])
{
    const long n = m->n;
    real *const gap = m->gap;
    FOR_SOLVED (m, begin, end) {
#pragma omp simd
        for (long k = begin; k < end; ++k) {
            real one[STAGES];
            for (long i = 0; i < STAGES; ++i) {
                one[i] = zero;
                for (long j = 0; j < STAGES; ++j)
                    one[i] += matrix[i][j] * gap[j * n + k];
            }
            for (long i = 0; i < STAGES; ++i)
                gap[i * n + k] = one[i];
        }
    }
}

/* Newton's method for the rates at the stages of a step. Comes after gauss.c. */

/*
 * The rates at a single point, with its own co-states in place of means. Path functionals may jump
 * within a step, which knows only their means: at an end of it (`weight`), their rates are
 * extrapolated from those of its stages.
 */
static void MODEL(at_point)(const MODEL(block) *m, const real *x, const real *branch, const real *u,
                            const double *weight, real *rate, real *rows, real *side, real *margin)
{
    (void)weight;
    MODEL(integrands)(x, &m->p, m->node);
#if defined(PATHS)
    MODEL(standing)(m, x, branch, u, weight);
#endif /* PATHS */
    MODEL(stage)(x, m->node, branch, u, &m->p, rate, rows, side, margin);
}

/* Most iterations of a step, and after how many it is given up if changes stagnate. */
enum { MOST_ITERATIONS = 12, SOON = 1 };
/*
 * The same for a fixed step, which may start far from its root: on the steep side of an exponential
 * law an iteration moves by one width of it, however short the step. After NOISY iterations,
 * changes that stagnate may be as large as MOST_NOISE.
 */
enum { MOST_OF_FIXED = 1000, LATE = 900, NOISY = 300 };
/* Slopes are computed anew where a change is more than this part of the one before. */
#define SLOW 0.1
/* Below this change, in units of noise, the next one is expected to shrink by the same factor. */
#define NEAR 1e8
/* Largest residual of a root, relative to the state: round-off of a stiff state leaves as much. */
#define LEFT 0.01
/* If the second change is more than this, in units of noise, more nodes are considered at once. */
#define FAR 1e9
/* Changes oscillate where at least this part of one comes back with the other sign. */
#define TO_AND_FRO 0.5


/* Newton's change of the rates, which replaces the residuals in `gap`. */
static void MODEL(change)(const MODEL(block) *m, real h)
{
    if (STAGES > 1)
        MODEL(transform)(m, BASIS_STAGE);
#if STAGES % 2
    MODEL(solve_real)(m, h * filter, m->slope, m->real_factor, SOLVED, m->gap);
#endif
    if (STAGES > 1)
        MODEL(transform)(m, STAGE_BASIS);
}

/*
 * Slopes in the middle of the step, on the branches of its middle stage, and their factorisations;
 * lanes that are not in `where` keep their slopes.
 */
static void MODEL(prepare)(const MODEL(block) *m, real h, mask where)
{
    const long middle = STAGES / 2;
    MODEL(reach_of)(m, h, stage_reach[middle], m->reached);
    MODEL(slopes)(m->reached, m->mean + middle * m->given, m->branch + middle * m->branches,
                  m->u + middle * m->inputs, &m->p, m->fresh);
    for (long k = 0; m->fresh != m->slope && k < m->slopes; ++k)
        m->slope[k] = chosen(where, m->fresh[k], m->slope[k]);
    MODEL(factorise_real)(m, h * filter, m->slope, m->real_factor);
}

/* The lanes in which all conditions of the domain hold. */
static mask MODEL(within)(const real *margin)
{
    mask good = none_of(nowhere);
    for (long k = 0; k < MODEL(limits); ++k) {
        const mask inside = margin[k] > 0.0, edge = margin[k] == 0.0;
        good &= MODEL(strict)[k] ? inside : (mask)(inside | edge);
    }
    return good;
}

/* The lanes whose stages all lie in the domain, and in which no process consumes entropy. */
static mask MODEL(accepted)(const MODEL(block) *m)
{
    const long processes = m->processes, ports = MODEL(output_count);
    mask good = none_of(nowhere);
    for (long i = 0; i < STAGES; ++i) {
        const real *rows = m->rows + i * m->booked + ports + processes;
        real total = zero, lowest = zero;
        good &= MODEL(within)(m->margin + i * MODEL(limits));
#pragma omp simd reduction(+ : total) reduction(min : lowest)
        for (long k = 0; k < processes; ++k) {
            total += size_of(rows[k]);
            lowest = chosen(rows[k] < lowest, rows[k], lowest);
        }
        good &= lowest >= -1e-14 * total;
    }
    return good;
}

/*
 * The part of a change to take where changes oscillate. Slopes are those at one point of a step,
 * and differ along a long one, so that changes overshoot. The component of the new change along the
 * last one says by how much.
 */
static real MODEL(damping)(const MODEL(block) *m)
{
    const long n = m->n;
    const real *const largest = m->largest, *const x = m->x, *const before = m->prior, *const gap = m->gap;
    real both = zero, prior = NO_SIZE + zero;
    FOR_SOLVED (m, begin, end) {
#pragma omp simd reduction(+ : both, prior)
        for (long k = begin; k < end; ++k) {
            const real per = 1.0 / (largest[k] + size_of(x[k]) + NO_SIZE);
            for (long j = 0; j < STAGES; ++j) {
                const real last = before[j * n + k] * per;
                both += last * (gap[j * n + k] * per);
                prior += last * last;
            }
        }
    }
    const real left = both / prior;
    const mask fro = left < -TO_AND_FRO;
    return chosen(fro, 1.0 / (1.0 - left), wide(1.0));
}

/*
 * The lanes whose rates solve the equations, and their largest residual as a change of a state, in units of
 * noise. A small change does not show that: changes are small, too, where slopes are far too large.
 */
static mask MODEL(solves)(const MODEL(block) *m, real h, real *residual)
{
    const long n = m->n;
    const real *const largest = m->largest, *const x = m->x, *const rates = m->rates, *const gap = m->gap;
    real most = zero, unsolved = zero; /* how many states are */
    FOR_SOLVED (m, begin, end) {
#pragma omp simd reduction(max : most) reduction(+ : unsolved)
        for (long k = begin; k < end; ++k) {
            real moved = zero, sum = zero;
            for (long j = 0; j < STAGES; ++j) {
                moved = largest_of(moved, size_of(rates[j * n + k]));
                sum += size_of(gap[j * n + k]);
            }
            const real size = largest[k] + size_of(x[k]) + h * moved + NO_SIZE;
            const real noises = h * sum / (NOISE * size + m->noise[k]);
            most = chosen(noises > most, noises, most);
            unsolved += chosen(h * sum <= LEFT * size, zero, wide(1.0));
        }
    }
    *residual = most;
    return unsolved == 0.0;
}

/* The lanes whose means need more nodes, by the rates at hand; see nodes.c. */
static mask MODEL(coarse_by_now)(MODEL(block) *m, real h);

/*
 * The lanes in which a stage lies beyond a switch, by the rates at hand. Their steps will be cut
 * there, and to locate that place rates need not be exact to round-off.
 */
static mask MODEL(strayed)(const MODEL(block) *m)
{
    mask found = nowhere;
    for (long k = 0; k < STAGES * m->branches; ++k) {
        const mask above = m->side[k] > 0.0, on = m->branch[k] > 0.0;
        found |= (above & none_of(on)) | (on & none_of(above));
    }
    return found;
}

/* Add part of the change to the rates; returns the largest change of a state, in units of noise. */
static real MODEL(changed)(const MODEL(block) *m, real h, real part, mask where)
{
    const long n = m->n;
    const real *restrict const gap = m->gap, *restrict const largest = m->largest, *restrict const x = m->x;
    real *restrict const rates = m->rates, *restrict const prior = m->prior;
    real worst = zero, lost = zero; /* nan, where a change is none */
    FOR_SOLVED (m, begin, end) {
#pragma omp simd reduction(max : worst) reduction(+ : lost)
        for (long k = begin; k < end; ++k) {
            real moved = zero, sum = zero;
            for (long j = 0; j < STAGES; ++j) {
                const real all = part * gap[j * n + k], change = chosen(where, all, zero);
                const real rate = rates[j * n + k] + change;
                prior[j * n + k] = change;
                rates[j * n + k] = rate;
                moved = largest_of(moved, size_of(rate));
                sum += size_of(change);
            }
            const real size = NOISE * (largest[k] + size_of(x[k]) + h * moved) + m->noise[k] + NO_SIZE;
            const real noises = h * sum / size;
            worst = chosen(noises > worst, noises, worst);
            lost += 0.0 * noises;
        }
    }
    return worst + lost;
}

/*
 * Newton's method for the rates in some lanes, from those at hand; returns the lanes that converge.
 * A lane that has converged does not change while others go on.
 */
static mask MODEL(iterate)(MODEL(block) *m, real h, mask where)
{
    mask going = where, found = nowhere;
    mask renewed = nowhere; /* lanes that got more nodes: earlier changes predict nothing */
    /* with fixed steps the larger of two ratios counts: new slopes may help once, not again */
    real before = zero, left_before = zero;
#if defined(PATHS)
    MODEL(path_parameters)(m->x, &m->p, m->path);
#endif /* PATHS */
    MODEL(gaps)(m, h, going);
    MODEL(prepare)(m, h, going);
    for (int iteration = 0; iteration < m->most && any(going); ++iteration) {
        m->iterations += chosen(going, wide(1.0), zero);
        MODEL(change)(m, h);
        const real part = iteration && m->late > SOON ? MODEL(damping)(m) : (real)wide(1.0);
        const real worst = MODEL(changed)(m, h, part, going);
        const mask far = going & (worst > FAR) & none_of(m->fine);
        if (iteration == 1 && !LOSSY && any(far))
            m->fine |= renewed = far & MODEL(coarse_by_now)(m, h);
        else if (iteration > 2)
            renewed = nowhere;
        const mask switched = MODEL(gaps)(m, h, going);
        const mask smaller = (worst < before) & none_of(renewed), lost = none_of(worst < 1e300);
        const mask near = smaller & (worst < NEAR);
        const real left = worst / (before + NO_SIZE);
        real residual;
        const mask solved = MODEL(solves)(m, h, &residual);
        mask good = near & (worst * largest_of(left, left_before) <= 4.0);
        good |= (worst <= 4.0) & none_of(renewed);
        if (iteration > 1) { /* stagnation: round-off, or no root */
            const mask stays = (worst > m->stays * before) & none_of(good | renewed);
            good |= stays & (worst < (m->late == SOON || iteration > NOISY ? MOST_NOISE : 100.0));
            if (iteration > m->late)
                going &= none_of(stays & none_of(good));
        }
        good &= solved & none_of(lost);
        const mask enough = m->sketch & (worst < m->enough) & going & none_of(good | lost);
        if (any(enough)) {
            m->sketched |= enough & MODEL(strayed)(m);
            good |= m->sketched;
        }
        found |= going & good;
        going &= none_of(good | lost);
        const mask slow = (worst > SLOW * before) & (before > 0.0);
        if (any((switched | slow) & going))
            MODEL(prepare)(m, h, (switched | slow) & going);
        before = worst;
        left_before = iteration && m->late > SOON ? left : (real)zero;
    }
    return found;
}

/*
 * The number of nodes that means over a step need, and a step solved with as many. Comes after
 * newton.c.
 */

/*
 * States are moved by ASIDE of their scales to estimate the round-off of their co-states, and by steps of
 * NEAREST to FARTHEST; what exceeds it by the factor MUCH_NOISE is no round-off.
 */
#define ASIDE 1e-3
#define NEAREST (sizeof(real) < sizeof(double) ? 1e-5 : 1e-9)
#define FARTHEST (sizeof(real) < sizeof(double) ? 1e-4 : 1e-8)
#define FARTHER 1.6
#define ROUND_OFF_IN_IT 8.0 /* how often a fourth difference has that of a single value */
#define MUCH_NOISE 100.0
/* A relative bound, but not below the round-off of sums over nodes. */
#define ABOVE_NOISE(part) ((part) > MUCH_NOISE * NOISE ? (part) : MUCH_NOISE * NOISE)

/* A quadrature rule, and how it tells that an integrand needs more nodes. */
typedef struct {
    long nodes;
    const double *last, *other; /* weights for the last two Legendre coefficients */
    double part;                /* how large these may be, relative to the integrand */
} MODEL(rule);

static const MODEL(rule) MODEL(few) = {NODES, node_last[0], node_last[1], ABOVE_NOISE(COARSE)};
static const MODEL(rule) MODEL(many) = {FINE, fine_last[0], fine_last[1], ABOVE_NOISE(TOO_COARSE)};

/*
 * The lanes in which an integrand needs more nodes: the last two coefficients of its Legendre
 * series are not small. Two of them, for every other one of an even or odd function is zero.
 * Coefficients within `noise` of an integrand do not count.
 */
static mask MODEL(rough)(const MODEL(block) *m, const MODEL(rule) *rule, const real *noise)
{
    mask found = nowhere;
    for (long k = 0; k < m->means; ++k) {
        real last = zero, other = zero, size = NO_SIZE + zero;
        for (long q = 0; q < rule->nodes; ++q) {
            const real value = m->node[q * m->means + k];
            last += rule->last[q] * value;
            other += rule->other[q] * value;
            size = largest_of(size_of(value), size);
        }
        const real left = largest_of(size_of(last), size_of(other));
        mask bad = left > rule->part * size;
        if (noise)
            bad &= left > MUCH_NOISE * noise[k];
        found |= bad;
    }
    return found;
}

/* The lanes where means are rough in a step, or in a piece of a step that is split. */
static mask MODEL(rough_parts)(const MODEL(block) *m, real h, const MODEL(rule) *rule, const real *noise)
{
    MODEL(integrate)(m, h, rule->nodes == FINE ? FINE_REACH : NODE_REACH, rule->nodes);
    mask found = MODEL(rough)(m, rule, noise);
    return found;
}

static mask MODEL(coarse_by_now)(MODEL(block) *m, real h)
{
    return m->means ? MODEL(rough_parts)(m, h, &MODEL(few), NULL) : nowhere;
}

/* The lanes that need more than NODES nodes for balances exact to round-off. */
static mask MODEL(coarse)(const MODEL(block) *m, real h)
{
    mask other = m->fine; /* lanes where `node` is not at the NODES of a whole step */
    if (m->means && any(other))
        return MODEL(rough_parts)(m, h, &MODEL(few), NULL);
    return MODEL(rough)(m, &MODEL(few), NULL);
}

/* The integrands of the means, with each state moved away from zero by a fraction of its scale. */
static void MODEL(integrands_aside)(const MODEL(block) *m, double fraction, real *value)
{
    for (long k = 0; k < m->n; ++k) {
        const real by = fraction * (m->largest[k] + size_of(m->x[k]));
        m->reached[k] = m->x[k] + chosen(m->x[k] < 0.0, -by, by);
    }
    MODEL(integrands)(m->reached, &m->p, value);
}

/*
 * The round-off of integrands. One that tends to zero as a difference of larger terms, such as a length
 * and a rest length, ends as their round-off. How large these are shows when the states are moved; or,
 * where they have nothing to do with the states' scales, as in (1 + q/g)**n - 1 for q far below g, in the
 * fourth difference of five points so near to each other that it is nothing else, even in a steep law.
 */
static void MODEL(find_noise)(const MODEL(block) *m, real *noise)
{
    real *const first = m->node, *const second = first + m->means;
    MODEL(integrands)(m->x, &m->p, first);
    MODEL(integrands_aside)(m, ASIDE, second);
    for (long k = 0; k < m->means; ++k) {
        const real change = size_of(second[k] - first[k]);
        noise[k] = chosen(change < 1e300, (NOISE / ASIDE) * change, zero);
    }
    static const double binomial[] = {1.0, -4.0, 6.0, -4.0, 1.0};
    for (double apart = NEAREST; apart < FARTHEST; apart *= FARTHER) {
        real *const sum = second + m->means;
        for (long k = 0; k < m->means; ++k)
            sum[k] = first[k];
        for (int point = 1; point < 5; ++point) {
            MODEL(integrands_aside)(m, point * apart, second);
            for (long k = 0; k < m->means; ++k)
                sum[k] += binomial[point] * second[k];
        }
        for (long k = 0; k < m->means; ++k) {
            const real left = size_of(sum[k]) / ROUND_OFF_IN_IT;
            noise[k] = largest_of(noise[k], chosen(left < 1e300, left, zero));
        }
    }
}

/* The lanes in which FINE nodes are too few: the step is too long. */
static mask MODEL(too_coarse)(const MODEL(block) *m, real h)
{
    const mask bad = m->fine & MODEL(rough_parts)(m, h, &MODEL(many), NULL);
    if (!any(bad))
        return bad;
    real *const noise = m->gap; /* no longer needed by Newton's method */
    MODEL(find_noise)(m, noise);
    return bad & MODEL(rough_parts)(m, h, &MODEL(many), noise);
}

#if !defined(COSTATES) /* else see residual.c */
static mask MODEL(iterate_enough)(MODEL(block) *m, real h, mask where)
{
    return MODEL(iterate)(m, h, where);
}
#endif

/*
 * Solve for the rates in some lanes, with as many nodes as they need; returns the lanes that
 * succeed.
 */
static mask MODEL(solve)(MODEL(block) *m, real h, mask where)
{
    m->fine &= none_of(where);
    m->sketched = nowhere;
    mask found = MODEL(iterate_enough)(m, h, where);
    if (LOSSY) /* a dissipative step has no means */
        return found;
    const mask more = MODEL(coarse)(m, h) & found & none_of(m->sketched | m->fine);
    if (any(more)) {
        m->fine |= more;
        found &= none_of(more) | MODEL(iterate_enough)(m, h, more);
    }
    const mask fine = m->fine & found & none_of(m->sketched);
    if (any(fine))
        found &= none_of(fine & MODEL(too_coarse)(m, h));
    return found;
}

/* A step of order two by itself, for programs in C; see <model>_step.h. */

static long MODEL(made)(MODEL(block) *m, const MODEL(parameters) *p, long *sizes, real *space)
{
    m->over = 1, m->most = MOST_OF_FIXED, m->late = LATE, m->stays = 0.7;
    return MODEL(make)(m, p, 0, sizes, space);
}

long MODEL(step_size)(const MODEL(parameters) *p)
{
    MODEL(block) block;
    long sizes[SIZES];
    const long size = MODEL(made)(&block, p, sizes, NULL);
    return size + block.n; /* the largest magnitudes stay from step to step */
}

int MODEL(step)(double *x, const double *u, double h, const MODEL(parameters) *p, double *booked,
                double *space)
{
    MODEL(block) block = {0}, *const m = &block;
    long sizes[SIZES];
    const long size = MODEL(made)(m, p, sizes, (real *)space);
    real *const largest = (real *)space + size;
    memset(space, 0, (size_t)size * sizeof(real));
    MODEL(give)(&m->p, p, 0);
    for (long k = 0; k < m->n; ++k) {
        m->x[k] = x[k];
        m->largest[k] = largest_of(size_of(x[k]), largest[k]);
    }
    for (long k = 0; k < m->inputs; ++k)
        m->u[k] = u[k];
    if (!MODEL(solve)(m, h, 1) || !MODEL(accepted)(m))
        return 0;
    for (long k = 0; k < m->booked; ++k)
        booked[k] = h * m->rows[k];
    MODEL(reach_of)(m, h, stage_weight, m->end);
    MODEL(at_point)(m, m->end, m->branch, m->u, NULL, m->gap, m->rows, m->side, m->margin);
    int good = MODEL(within)(m->margin);
    for (long k = 0; k < m->n; ++k)
        good &= size_of(m->gap[k]) < 1e300;
    if (!good)
        return 0;
    for (long k = 0; k < m->n; ++k) {
        x[k] = m->end[k];
        largest[k] = m->largest[k];
    }
    return 1;
}

#endif /* ALONE */
