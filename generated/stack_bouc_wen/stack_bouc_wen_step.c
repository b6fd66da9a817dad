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
/*
 * One step of energy-preserving Gauss collocation. The row `program` of the proofs covers the
 * functions `integrands` and `stage`, and `costates`; the others and the tables serve Newton's method.
 */
#include "stack_bouc_wen.h"

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
#define pow_of pow
#define is_above(a, b) ((a) > (b))
#define is_at_least(a, b) ((a) >= (b))
#define least(a, b) ((a) < (b) || (a) != (a) ? (a) : (b))
#define OF(value, lane) (value)
#endif

/* The parameters as `real`: of one run, or in vectors of one run per lane. */
typedef struct {
    real m;
    real k;
    real d;
    real a;
    real C;
    real C_h;
    real V_h;
    real beta;
    real gam;
    real n;
    real R;
    real c_0;
    real lam;
    real T_0;
} stack_bouc_wen_reals;

#if !defined(LAWS_APART) /* the functions of laws, which run/engine compiles apart */

static inline real power_2_of(real z)
{
    return z*z;
}

/* Functions of the state whose weighted means over a step are the means g of a stage. */
static void stack_bouc_wen_integrands(const real *restrict x,
                                      const stack_bouc_wen_reals *restrict p_,
                                      real *restrict out)
{
    const real c_0 = p_->c_0;
    const real T_0 = p_->T_0;
    const real S = x[4];
    out[0] = T_0*exp_of(S/c_0);
}

/*
 * A stage, for the state x, means g, branches b of laws, and inputs u. Writes the rates of the
 * state to out; to rows, for the ledger, the power of ports, heat and entropy production of
 * processes, and entropy rate of heat exchanges; to s the switching functions, whose signs
 * decide the branches; to m the margins of those conditions of the domain that depend on the
 * state.
 */
static void stack_bouc_wen_stage(const real *restrict x,
                                 const real *restrict g,
                                 const real *restrict b,
                                 const real *restrict u,
                                 const stack_bouc_wen_reals *restrict p_,
                                 real *restrict out,
                                 real *restrict rows,
                                 real *restrict s,
                                 real *restrict m_)
{
    (void)m_;
    const real m = p_->m;
    const real k = p_->k;
    const real d = p_->d;
    const real a = p_->a;
    const real C = p_->C;
    const real C_h = p_->C_h;
    const real V_h = p_->V_h;
    const real beta = p_->beta;
    const real gam = p_->gam;
    const real n = p_->n;
    const real R = p_->R;
    const real lam = p_->lam;
    const real q = x[0];
    const real p = x[1];
    const real Q = x[2];
    const real Q_h = x[3];
    const real T = g[0];
    const real branch_1 = b[0];
    const real branch_2 = b[1];
    const real branch_3 = b[2];
    const real branch_4 = b[3];
    const real F_ext = u[0];
    const real V_in = u[1];
    const real T_e = u[2];
    /* co-states dU/dx */
    const real F_spring = k*q;
    const real v_mass = p/m;
    const real V_ceramic = Q/C;
    const real V_hysteresis = Q_h/C_h;
    /* transducer ratios */
    const real alpha_transducer = a;
    /* dissipative laws */
    const real F_damper = d*v_mass;
    /* driving forces */
    const real V_leads = -V_ceramic - V_hysteresis + V_in;
    /* dissipative laws */
    const real i_leads = V_leads/R;
    /* switching functions */
    const real switch_1 = i_leads;
    const real switch_2 = -V_hysteresis;
    const real switch_3 = V_hysteresis;
    const real switch_4 = V_hysteresis;
    /* dissipative laws */
    const real chosen_slip_hysteresis = chosen(is_above(branch_1, 0.0), i_leads, -i_leads);
    const real chosen_slip_hysteresis_ = chosen(
        is_above(branch_3, 0.0),
        wide(1.0),
        chosen(is_above(branch_2, 0.0), wide(-1.0), wide(0.0)));
    const real chosen_slip_hysteresis__ = chosen(
        is_above(branch_4, 0.0),
        V_hysteresis,
        -V_hysteresis);
    const real slip_hysteresis = (beta*chosen_slip_hysteresis*chosen_slip_hysteresis_ + gam*i_leads)*pow_of(chosen_slip_hysteresis__/V_h, n);
    /* heats */
    const real heat_damper = F_damper*v_mass;
    const real heat_hysteresis = slip_hysteresis*V_hysteresis;
    const real heat_leads = i_leads*V_leads;
    /* result */
    s[0] = switch_1;
    s[1] = switch_2;
    s[2] = switch_3;
    s[3] = switch_4;
    out[0] = v_mass;
    out[1] = alpha_transducer*V_ceramic - F_spring - F_damper + F_ext;
    out[2] = i_leads - alpha_transducer*v_mass;
    out[3] = i_leads - slip_hysteresis;
    out[4] = (heat_damper + heat_hysteresis + heat_leads)/T + lam*(T_e/T - 1.0);
    rows[0] = v_mass*F_ext;
    rows[1] = i_leads*V_in;
    rows[2] = lam*(T_e - T);
    rows[3] = F_damper*v_mass;
    rows[4] = slip_hysteresis*V_hysteresis;
    rows[5] = i_leads*V_leads;
    rows[6] = F_damper*v_mass/T;
    rows[7] = slip_hysteresis*V_hysteresis/T;
    rows[8] = i_leads*V_leads/T;
    rows[9] = lam*(T_e/T - 1.0);
}

#if !defined(ALONE) /* the step alone solves its equations to round-off */
/* Co-states dU/dx of a stage, of all states; then the rows of entropies. */
static void stack_bouc_wen_costates(const real *restrict x,
                                    const real *restrict g,
                                    const stack_bouc_wen_reals *restrict p_,
                                    real *restrict out)
{
    const real m = p_->m;
    const real k = p_->k;
    const real C = p_->C;
    const real C_h = p_->C_h;
    const real q = x[0];
    const real p = x[1];
    const real Q = x[2];
    const real Q_h = x[3];
    const real T = g[0];
    /* co-states dU/dx */
    const real F_spring = k*q;
    const real v_mass = p/m;
    const real V_ceramic = Q/C;
    const real V_hysteresis = Q_h/C_h;
    /* result */
    out[0] = F_spring;
    out[1] = v_mass;
    out[2] = V_ceramic;
    out[3] = V_hysteresis;
    out[4] = T;
}
#endif /* of what run/engine takes */

/* Derivative of the rates by the state, on branches b; the tables tell its entries. */
static void stack_bouc_wen_slopes(const real *restrict x,
                                  const real *restrict g,
                                  const real *restrict b,
                                  const real *restrict u,
                                  const stack_bouc_wen_reals *restrict p_,
                                  real *restrict out)
{
    (void)g;
    const real m = p_->m;
    const real k = p_->k;
    const real d = p_->d;
    const real a = p_->a;
    const real C = p_->C;
    const real C_h = p_->C_h;
    const real V_h = p_->V_h;
    const real beta = p_->beta;
    const real gam = p_->gam;
    const real n = p_->n;
    const real R = p_->R;
    const real c_0 = p_->c_0;
    const real lam = p_->lam;
    const real T_0 = p_->T_0;
    const real p = x[1];
    const real Q = x[2];
    const real Q_h = x[3];
    const real S = x[4];
    const real branch_1 = b[0];
    const real branch_2 = b[1];
    const real branch_3 = b[2];
    const real branch_4 = b[3];
    const real V_in = u[1];
    const real T_e = u[2];
    /* co-states dU/dx */
    const real v_mass = p/m;
    const real V_ceramic = Q/C;
    const real V_hysteresis = Q_h/C_h;
    const real T = T_0*exp_of(S/c_0);
    /* transducer ratios */
    const real alpha_transducer = a;
    /* dissipative laws */
    const real F_damper = d*v_mass;
    /* driving forces */
    const real V_leads = -V_ceramic - V_hysteresis + V_in;
    /* dissipative laws */
    const real i_leads = V_leads/R;
    const real chosen_slip_hysteresis = chosen(is_above(branch_1, 0.0), i_leads, -i_leads);
    const real chosen_slip_hysteresis_ = chosen(
        is_above(branch_3, 0.0),
        wide(1.0),
        chosen(is_above(branch_2, 0.0), wide(-1.0), wide(0.0)));
    const real chosen_slip_hysteresis__ = chosen(
        is_above(branch_4, 0.0),
        V_hysteresis,
        -V_hysteresis);
    const real slip_hysteresis = (beta*chosen_slip_hysteresis*chosen_slip_hysteresis_ + gam*i_leads)*pow_of(chosen_slip_hysteresis__/V_h, n);
    /* heats */
    const real heat_damper = F_damper*v_mass;
    const real heat_hysteresis = slip_hysteresis*V_hysteresis;
    const real heat_leads = i_leads*V_leads;
    /* derivatives */
    const real dF_damper_dp = d/m;
    const real dheat_damper_dp = v_mass*dF_damper_dp + F_damper/m;
    const real di_leads_dQ = -1.0/R/C;
    const real dchosen_slip_hysteresis_dQ = chosen(
        is_above(branch_1, 0.0),
        di_leads_dQ,
        -di_leads_dQ);
    const real dslip_hysteresis_dQ = beta*chosen_slip_hysteresis_*pow_of(chosen_slip_hysteresis__/V_h, n)*dchosen_slip_hysteresis_dQ
        + gam*pow_of(chosen_slip_hysteresis__/V_h, n)*di_leads_dQ;
    const real dheat_hysteresis_dQ = V_hysteresis*dslip_hysteresis_dQ;
    const real dheat_leads_dQ = V_leads*di_leads_dQ - i_leads/C;
    const real di_leads_dQ_h = -1.0/R/C_h;
    const real dchosen_slip_hysteresis_dQ_h = chosen(
        is_above(branch_1, 0.0),
        di_leads_dQ_h,
        -di_leads_dQ_h);
    const real dchosen_slip_hysteresis___dQ_h = chosen(
        is_above(branch_4, 0.0),
        1.0/C_h,
        -1.0/C_h);
    const real dslip_hysteresis_dQ_h = beta*chosen_slip_hysteresis_*pow_of(chosen_slip_hysteresis__/V_h, n)*dchosen_slip_hysteresis_dQ_h
        + gam*pow_of(chosen_slip_hysteresis__/V_h, n)*di_leads_dQ_h
        + (beta*chosen_slip_hysteresis*chosen_slip_hysteresis_ + gam*i_leads)*n*pow_of(chosen_slip_hysteresis__/V_h, n)/chosen(is_above(chosen_slip_hysteresis__/V_h, 0.0), chosen_slip_hysteresis__/V_h, wide(1.0))/V_h*dchosen_slip_hysteresis___dQ_h;
    const real dheat_hysteresis_dQ_h = V_hysteresis*dslip_hysteresis_dQ_h
        + slip_hysteresis/C_h;
    const real dheat_leads_dQ_h = V_leads*di_leads_dQ_h - i_leads/C_h;
    const real dT_dS = T/c_0;
    /* result */
    out[0] = 1.0/m;
    out[1] = -k;
    out[2] = -dF_damper_dp;
    out[3] = alpha_transducer/C;
    out[4] = -alpha_transducer/m;
    out[5] = di_leads_dQ;
    out[6] = di_leads_dQ_h;
    out[7] = di_leads_dQ - dslip_hysteresis_dQ;
    out[8] = di_leads_dQ_h - dslip_hysteresis_dQ_h;
    out[9] = dheat_damper_dp/T;
    out[10] = dheat_hysteresis_dQ/T + dheat_leads_dQ/T;
    out[11] = dheat_hysteresis_dQ_h/T + dheat_leads_dQ_h/T;
    out[12] = (-(heat_damper + heat_hysteresis + heat_leads)/power_2_of(T) - lam*T_e/power_2_of(T))*dT_dS;
}

#endif /* of the functions of laws */

/* How many numbers there are of each kind; lanes of each bank; first row of each state. */
static void stack_bouc_wen_sizes(const stack_bouc_wen_reals *p_, long *out)
{
    (void)p_;
    out[0] = 5; /* states */
    out[1] = 1; /* means */
    out[2] = 4; /* branches */
    out[3] = 10; /* booked */
    out[4] = 3; /* processes */
    out[5] = 13; /* slopes */
    out[6] = 0; /* first row */
    out[7] = 1; /* first row */
    out[8] = 2; /* first row */
    out[9] = 3; /* first row */
    out[10] = 4; /* first row */
}

/* Copy the sizes of banks; place arrays for their parameters from `at` on, return their size. */
static long stack_bouc_wen_place_reals(stack_bouc_wen_reals *to, const stack_bouc_wen_parameters *from, real *at)
{
    (void)to;
    (void)from;
    real *const begin = at;
    return at - begin;
}

/* Copy the parameters of a run into one lane of the vectors. */
static void stack_bouc_wen_give(stack_bouc_wen_reals *to, const stack_bouc_wen_parameters *from, int lane)
{
    (void)lane;
    OF(to->m, lane) = from->m;
    OF(to->k, lane) = from->k;
    OF(to->d, lane) = from->d;
    OF(to->a, lane) = from->a;
    OF(to->C, lane) = from->C;
    OF(to->C_h, lane) = from->C_h;
    OF(to->V_h, lane) = from->V_h;
    OF(to->beta, lane) = from->beta;
    OF(to->gam, lane) = from->gam;
    OF(to->n, lane) = from->n;
    OF(to->R, lane) = from->R;
    OF(to->c_0, lane) = from->c_0;
    OF(to->lam, lane) = from->lam;
    OF(to->T_0, lane) = from->T_0;
}

#if !defined(ALONE) /* there are co-states for run/engine */
#define COSTATES
enum { stack_bouc_wen_bodies = 1 };
static const int stack_bouc_wen_body[] = {
    4,
};
#endif /* of what tells of co-states */
enum {
    stack_bouc_wen_limits = 0, /* margins of a stage */
    stack_bouc_wen_reads = 1, /* states that integrands read */
    stack_bouc_wen_records = 5, /* states, a bank's counted once */
    stack_bouc_wen_heated = 4, /* the state that takes a dissipative step's loss */
    stack_bouc_wen_jumps = 0 /* whether a law jumps */
};
static const int stack_bouc_wen_strict[] = {
    0,
};
static const int stack_bouc_wen_read[] = {
    4,
};
/* The equations of a step: shared unknowns, those of lanes, their elimination. */
enum {
    stack_bouc_wen_shared = 5, /* shared states */
    stack_bouc_wen_unknowns = 5, /* and sums between lanes */
    stack_bouc_wen_slots = 14, /* entries between them, fill-in included */
    stack_bouc_wen_entries = 13, /* slopes between shared states */
    stack_bouc_wen_banks = 0,
    stack_bouc_wen_most_states = 1 /* that a lane has */
};
static const int stack_bouc_wen_place[] = {
    1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13,
};
static const int stack_bouc_wen_state[] = {
    0, 1, 2, 3, 4,
};
static const int stack_bouc_wen_order[] = {
    4, 0, 1, 2, 3,
};
static const int stack_bouc_wen_pivot[] = {
    13, 0, 3, 6, 9,
};
static const int stack_bouc_wen_below_at[] = {
    0, 0, 2, 4, 6, 6,
};
static const int stack_bouc_wen_below[] = {
    1, 2, 2, 5, 3, 8,
};
static const int stack_bouc_wen_right_at[] = {
    0, 6, 8, 10, 12, 12,
};
static const int stack_bouc_wen_right[] = {
    1, 10, 2, 11, 3, 12, 1, 1, 2, 4, 3, 7,
};
static const int stack_bouc_wen_update[] = {
    3, 6, 9,
};
static const int stack_bouc_wen_lane_states_at[] = {
    0,
};
static const int stack_bouc_wen_lane_states[] = {
    0,
};
static const int stack_bouc_wen_lane_columns_at[] = {
    0,
};
static const int stack_bouc_wen_lane_columns[] = {
    0,
};
static const int stack_bouc_wen_lane_rows_at[] = {
    0,
};
static const int stack_bouc_wen_lane_rows[] = {
    0,
};
static const int stack_bouc_wen_first[] = {
    0,
};
static const int stack_bouc_wen_meet[] = {
    0,
};

#if defined(ALONE) /* the engine has a step of its own, of any order and for vectors */
#include "stack_bouc_wen_step.h"

#include <string.h>

#define MODEL(name) stack_bouc_wen_##name
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
static const double stage_weight[1] = {1.0};
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
    mask fine;                 /* lanes whose means are taken at FINE nodes */
    mask over;                 /* lanes that step over kinks: each stage chooses its branches */
    mask sketch, sketched;     /* lanes that may stop early, beyond a switch; lanes that did */
    double enough;             /* in units of noise: they stop when a change is below this */
    real iterations;           /* of Newton's method */
    int most, late;            /* iterations in a step; after `late` it may be given up */
    double stays;              /* changes that shrink by no more than this factor stagnate */
} MODEL(block);

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
