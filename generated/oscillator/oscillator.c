/*
 * Damped oscillator that heats itself: irreversible port-Hamiltonian system.
 *
 * Source:  Ramirez, Maschke, Sbarbaro (2013), Eur. J. Control 19, 513-520, the mass-spring-damper
 * Model:   oscillator, spec sha256 98f74415ae4d927ffd7693687e1755d27c6ee4baa18ca60809e3c3d10d605268
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, sigma, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (q, p, S)
 * u = (F)
 * p_ = pointer to oscillator_parameters; the underscore tells it from p, a name of the model
 */
#include "oscillator.h"

#include <math.h>

static double power_2(double z)
{
    return z*z;
}

/* Number of states n. */
long oscillator_states(const oscillator_parameters *restrict p_)
{
    (void)p_;
    return 3;
}

/* Number of processes, which produce entropy; of a bank, one per lane. */
long oscillator_processes(const oscillator_parameters *restrict p_)
{
    (void)p_;
    return 1;
}

/* State at t = 0 [SI], for the inputs u at t = 0. */
void oscillator_initial_state(const double *restrict u,
                              const oscillator_parameters *restrict p_,
                              double *restrict out)
{
    (void)u;
    (void)p_;
    out[0] = 1.0;
    out[1] = 0.0;
    out[2] = 0.0;
}

/* Rates dx/dt, the rows of J_ir dU/dx + g u. */
void oscillator_rhs(const double *restrict x,
                    const double *restrict u,
                    const oscillator_parameters *restrict p_,
                    double *restrict out)
{
    const double m = p_->m;
    const double k = p_->k;
    const double d = p_->d;
    const double T_0 = p_->T_0;
    const double c = p_->c;
    const double q = x[0];
    const double p = x[1];
    const double S = x[2];
    const double F = u[0];
    /* co-states dU/dx */
    const double F_spring = k*q;
    const double v_mass = p/m;
    const double T = T_0*exp(S/c);
    /* dissipative laws */
    const double F_damper = d*v_mass;
    /* heats */
    const double heat_damper = F_damper*v_mass;
    /* result */
    out[0] = v_mass;
    out[1] = F - F_spring - F_damper;
    out[2] = heat_damper/T;
}

/* Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient. */
void oscillator_outputs(const double *restrict x,
                        const double *restrict u,
                        const oscillator_parameters *restrict p_,
                        double *restrict out)
{
    (void)u;
    const double m = p_->m;
    const double p = x[1];
    /* co-states dU/dx */
    const double v_mass = p/m;
    /* result */
    out[0] = v_mass;
}

/* Power supplied through each port [W]; the sum is dU/dt. */
void oscillator_supply(const double *restrict x,
                       const double *restrict u,
                       const oscillator_parameters *restrict p_,
                       double *restrict out)
{
    const double m = p_->m;
    const double p = x[1];
    const double F = u[0];
    /* co-states dU/dx */
    const double v_mass = p/m;
    /* result */
    out[0] = v_mass*F;
}

/* Hamiltonian U [J]. */
double oscillator_energy(const double *restrict x, const oscillator_parameters *restrict p_)
{
    const double m = p_->m;
    const double k = p_->k;
    const double T_0 = p_->T_0;
    const double c = p_->c;
    const double q = x[0];
    const double p = x[1];
    const double S = x[2];
    return k*power_2(q)/2.0 + power_2(p)/(2.0*m) + T_0*c*exp(S/c);
}

/* Total entropy S [J/K]. */
double oscillator_entropy(const double *restrict x, const oscillator_parameters *restrict p_)
{
    (void)p_;
    const double S = x[2];
    return S;
}

/* Temperature of each body [K]. */
void oscillator_temperatures(const double *restrict x,
                             const oscillator_parameters *restrict p_,
                             double *restrict out)
{
    const double T_0 = p_->T_0;
    const double c = p_->c;
    const double S = x[2];
    /* co-states dU/dx */
    const double T = T_0*exp(S/c);
    /* result */
    out[0] = T;
}

/* Power that each process turns into heat [W]; of a bank, one row per lane. */
void oscillator_heat(const double *restrict x,
                     const double *restrict u,
                     const oscillator_parameters *restrict p_,
                     double *restrict out)
{
    (void)u;
    const double m = p_->m;
    const double d = p_->d;
    const double p = x[1];
    /* co-states dU/dx */
    const double v_mass = p/m;
    /* dissipative laws */
    const double F_damper = d*v_mass;
    /* result */
    out[0] = F_damper*v_mass;
}

/*
 * Entropy production of each process [W/K], heat exchange with ambients not included; of a
 * bank, one row per lane.
 */
void oscillator_entropy_production(const double *restrict x,
                                   const double *restrict u,
                                   const oscillator_parameters *restrict p_,
                                   double *restrict out)
{
    (void)u;
    const double m = p_->m;
    const double d = p_->d;
    const double T_0 = p_->T_0;
    const double c = p_->c;
    const double p = x[1];
    const double S = x[2];
    /* co-states dU/dx */
    const double v_mass = p/m;
    const double T = T_0*exp(S/c);
    /* dissipative laws */
    const double F_damper = d*v_mass;
    /* result */
    out[0] = F_damper*v_mass/T;
}

/* Effort, flow, power, energy and heat of elements; of a bank, one row per lane. */
void oscillator_elements(const double *restrict x,
                         const double *restrict u,
                         const oscillator_parameters *restrict p_,
                         double *restrict out)
{
    const double m = p_->m;
    const double k = p_->k;
    const double d = p_->d;
    const double T_0 = p_->T_0;
    const double c = p_->c;
    const double q = x[0];
    const double p = x[1];
    const double S = x[2];
    const double F = u[0];
    /* co-states dU/dx */
    const double F_spring = k*q;
    const double v_mass = p/m;
    const double T = T_0*exp(S/c);
    /* dissipative laws */
    const double F_damper = d*v_mass;
    /* heats */
    const double heat_damper = F_damper*v_mass;
    /* rates */
    const double rate_p = F - F_spring - F_damper;
    const double rate_S = heat_damper/T;
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
    out[12] = T;
    out[13] = rate_S;
    out[14] = T*rate_S;
    out[15] = T_0*c*exp(S/c);
    out[16] = -F;
    out[17] = v_mass;
    out[18] = -v_mass*F;
}

/* Jacobian of rhs, n x n, row after row: d rhs[i]/d x[j] at out[i*n + j]. */
void oscillator_jacobian(const double *restrict x,
                         const double *restrict u,
                         const oscillator_parameters *restrict p_,
                         double *restrict out)
{
    (void)u;
    const long n = 3;
    const double m = p_->m;
    const double k = p_->k;
    const double d = p_->d;
    const double T_0 = p_->T_0;
    const double c = p_->c;
    const double p = x[1];
    const double S = x[2];
    for (long j = 0; j < n*n; ++j) {
        out[j] = 0.0;
    }
    /* co-states dU/dx */
    const double v_mass = p/m;
    const double T = T_0*exp(S/c);
    /* dissipative laws */
    const double F_damper = d*v_mass;
    /* heats */
    const double heat_damper = F_damper*v_mass;
    /* derivatives */
    const double dF_damper_dp = d/m;
    const double dheat_damper_dp = v_mass*dF_damper_dp + F_damper/m;
    const double dT_dS = T/c;
    /* result */
    out[1] = 1.0/m;
    out[n + 0] = -k;
    out[n + 1] = -dF_damper_dp;
    out[2*n + 1] = dheat_damper_dp/T;
    out[2*n + 2] = -heat_damper/power_2(T)*dT_dS;
}

/* Margin by which each condition of the domain holds; of a bank, the least one. */
void oscillator_margins(const double *restrict x,
                        const double *restrict u,
                        const oscillator_parameters *restrict p_,
                        double *restrict out)
{
    (void)x;
    (void)u;
    const double m = p_->m;
    const double k = p_->k;
    const double d = p_->d;
    const double T_0 = p_->T_0;
    const double c = p_->c;
    out[0] = d;
    out[1] = k;
    out[2] = m;
    out[3] = T_0;
    out[4] = c;
}
