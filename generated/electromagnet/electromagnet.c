/*
 * Electromagnet with an armature on a spring, and a coil that warms: irreversible port-Hamiltonian system.
 *
 * Source:  Woodson, Melcher (1968), Electromechanical Dynamics I, ch. 3
 * Model:   electromagnet, spec sha256 9b4244be212754305b836d305b67a8844d9eaeab14c345563f9a22957982c0af
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, sigma, exergy, environment, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (q, p, S, phi, x)
 * u = (V_in, T_e)
 * p_ = pointer to electromagnet_parameters; the underscore tells it from p, a name of the model
 */
#include "electromagnet.h"

#include <math.h>

static double power_2(double z)
{
    return z*z;
}

/* Number of states n. */
long electromagnet_states(const electromagnet_parameters *restrict p_)
{
    (void)p_;
    return 5;
}

/* Number of processes, which produce entropy; of a bank, one per lane. */
long electromagnet_processes(const electromagnet_parameters *restrict p_)
{
    (void)p_;
    return 2;
}

/* State at t = 0 [SI], for the inputs u at t = 0. */
void electromagnet_initial_state(const double *restrict u,
                                 const electromagnet_parameters *restrict p_,
                                 double *restrict out)
{
    (void)u;
    (void)p_;
    out[0] = 0.0;
    out[1] = 0.0;
    out[2] = 0.0;
    out[3] = 0.0;
    out[4] = 0.0;
}

/* Rates dx/dt, the rows of J_ir dU/dx + g u. */
void electromagnet_rhs(const double *restrict x_,
                       const double *restrict u,
                       const electromagnet_parameters *restrict p_,
                       double *restrict out)
{
    const double g = p_->g;
    const double A = p_->A;
    const double N = p_->N;
    const double mu = p_->mu;
    const double m = p_->m;
    const double k = p_->k;
    const double d = p_->d;
    const double R = p_->R;
    const double c = p_->c;
    const double lam = p_->lam;
    const double T_0 = p_->T_0;
    const double q = x_[0];
    const double p = x_[1];
    const double S = x_[2];
    const double phi = x_[3];
    const double x = x_[4];
    const double V_in = u[0];
    const double T_e = u[1];
    /* co-states dU/dx */
    const double F_spring = k*q;
    const double v_armature = p/m;
    const double T = T_0*exp(S/c);
    const double i_phi = 2.0*(phi*(g + x))/(2.0*mu*A*power_2(N));
    const double F_x = power_2(phi)/(2.0*mu*A*power_2(N));
    /* dissipative laws */
    const double V_copper = R*i_phi;
    const double F_friction = d*v_armature;
    /* heats */
    const double heat_copper = V_copper*i_phi;
    const double heat_friction = F_friction*v_armature;
    /* result */
    out[0] = v_armature;
    out[1] = -F_spring - F_x - F_friction;
    out[2] = (heat_copper + heat_friction)/T + lam*(T_e/T - 1.0);
    out[3] = V_in - V_copper;
    out[4] = v_armature;
}

/* Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient. */
void electromagnet_outputs(const double *restrict x_,
                           const double *restrict u,
                           const electromagnet_parameters *restrict p_,
                           double *restrict out)
{
    (void)u;
    const double g = p_->g;
    const double A = p_->A;
    const double N = p_->N;
    const double mu = p_->mu;
    const double c = p_->c;
    const double T_0 = p_->T_0;
    const double S = x_[2];
    const double phi = x_[3];
    const double x = x_[4];
    /* co-states dU/dx */
    const double T = T_0*exp(S/c);
    const double i_phi = 2.0*(phi*(g + x))/(2.0*mu*A*power_2(N));
    /* result */
    out[0] = i_phi;
    out[1] = T;
}

/* Power supplied through each port [W]; the sum is dU/dt. */
void electromagnet_supply(const double *restrict x_,
                          const double *restrict u,
                          const electromagnet_parameters *restrict p_,
                          double *restrict out)
{
    const double g = p_->g;
    const double A = p_->A;
    const double N = p_->N;
    const double mu = p_->mu;
    const double c = p_->c;
    const double lam = p_->lam;
    const double T_0 = p_->T_0;
    const double S = x_[2];
    const double phi = x_[3];
    const double x = x_[4];
    const double V_in = u[0];
    const double T_e = u[1];
    /* co-states dU/dx */
    const double T = T_0*exp(S/c);
    const double i_phi = 2.0*(phi*(g + x))/(2.0*mu*A*power_2(N));
    /* result */
    out[0] = i_phi*V_in;
    out[1] = lam*(T_e - T);
}

/* Hamiltonian U [J]. */
double electromagnet_energy(const double *restrict x_,
                            const electromagnet_parameters *restrict p_)
{
    const double g = p_->g;
    const double A = p_->A;
    const double N = p_->N;
    const double mu = p_->mu;
    const double m = p_->m;
    const double k = p_->k;
    const double c = p_->c;
    const double T_0 = p_->T_0;
    const double q = x_[0];
    const double p = x_[1];
    const double S = x_[2];
    const double phi = x_[3];
    const double x = x_[4];
    return k*power_2(q)/2.0
        + power_2(p)/(2.0*m)
        + T_0*c*exp(S/c)
        + power_2(phi)*(g + x)/(2.0*mu*A*power_2(N));
}

/* Total entropy S [J/K]. */
double electromagnet_entropy(const double *restrict x_,
                             const electromagnet_parameters *restrict p_)
{
    (void)p_;
    const double S = x_[2];
    return S;
}

/* Temperature of each body [K]. */
void electromagnet_temperatures(const double *restrict x_,
                                const electromagnet_parameters *restrict p_,
                                double *restrict out)
{
    const double c = p_->c;
    const double T_0 = p_->T_0;
    const double S = x_[2];
    /* co-states dU/dx */
    const double T = T_0*exp(S/c);
    /* result */
    out[0] = T;
}

/* Power that each process turns into heat [W]; of a bank, one row per lane. */
void electromagnet_heat(const double *restrict x_,
                        const double *restrict u,
                        const electromagnet_parameters *restrict p_,
                        double *restrict out)
{
    (void)u;
    const double g = p_->g;
    const double A = p_->A;
    const double N = p_->N;
    const double mu = p_->mu;
    const double m = p_->m;
    const double d = p_->d;
    const double R = p_->R;
    const double p = x_[1];
    const double phi = x_[3];
    const double x = x_[4];
    /* co-states dU/dx */
    const double v_armature = p/m;
    const double i_phi = 2.0*(phi*(g + x))/(2.0*mu*A*power_2(N));
    /* dissipative laws */
    const double V_copper = R*i_phi;
    const double F_friction = d*v_armature;
    /* result */
    out[0] = V_copper*i_phi;
    out[1] = F_friction*v_armature;
}

/*
 * Entropy production of each process [W/K], heat exchange with ambients not included; of a
 * bank, one row per lane.
 */
void electromagnet_entropy_production(const double *restrict x_,
                                      const double *restrict u,
                                      const electromagnet_parameters *restrict p_,
                                      double *restrict out)
{
    (void)u;
    const double g = p_->g;
    const double A = p_->A;
    const double N = p_->N;
    const double mu = p_->mu;
    const double m = p_->m;
    const double d = p_->d;
    const double R = p_->R;
    const double c = p_->c;
    const double T_0 = p_->T_0;
    const double p = x_[1];
    const double S = x_[2];
    const double phi = x_[3];
    const double x = x_[4];
    /* co-states dU/dx */
    const double v_armature = p/m;
    const double T = T_0*exp(S/c);
    const double i_phi = 2.0*(phi*(g + x))/(2.0*mu*A*power_2(N));
    /* dissipative laws */
    const double V_copper = R*i_phi;
    const double F_friction = d*v_armature;
    /* result */
    out[0] = V_copper*i_phi/T;
    out[1] = F_friction*v_armature/T;
}

/* Effort, flow, power, energy and heat of elements; of a bank, one row per lane. */
void electromagnet_elements(const double *restrict x_,
                            const double *restrict u,
                            const electromagnet_parameters *restrict p_,
                            double *restrict out)
{
    const double g = p_->g;
    const double A = p_->A;
    const double N = p_->N;
    const double mu = p_->mu;
    const double m = p_->m;
    const double k = p_->k;
    const double d = p_->d;
    const double R = p_->R;
    const double c = p_->c;
    const double lam = p_->lam;
    const double T_0 = p_->T_0;
    const double q = x_[0];
    const double p = x_[1];
    const double S = x_[2];
    const double phi = x_[3];
    const double x = x_[4];
    const double V_in = u[0];
    const double T_e = u[1];
    /* co-states dU/dx */
    const double F_spring = k*q;
    const double v_armature = p/m;
    const double T = T_0*exp(S/c);
    const double i_phi = 2.0*(phi*(g + x))/(2.0*mu*A*power_2(N));
    const double F_x = power_2(phi)/(2.0*mu*A*power_2(N));
    /* dissipative laws */
    const double V_copper = R*i_phi;
    const double F_friction = d*v_armature;
    /* heats */
    const double heat_copper = V_copper*i_phi;
    const double heat_friction = F_friction*v_armature;
    /* rates */
    const double rate_p = -F_spring - F_x - F_friction;
    const double rate_S = (heat_copper + heat_friction)/T + lam*(T_e/T - 1.0);
    const double rate_phi = V_in - V_copper;
    /* result */
    out[0] = V_in;
    out[1] = -i_phi;
    out[2] = -i_phi*V_in;
    out[3] = V_copper;
    out[4] = i_phi;
    out[5] = V_copper*i_phi;
    out[6] = V_copper*i_phi;
    out[7] = F_spring;
    out[8] = v_armature;
    out[9] = F_spring*v_armature;
    out[10] = k*power_2(q)/2.0;
    out[11] = rate_p;
    out[12] = v_armature;
    out[13] = rate_p*v_armature;
    out[14] = power_2(p)/(2.0*m);
    out[15] = F_friction;
    out[16] = v_armature;
    out[17] = F_friction*v_armature;
    out[18] = F_friction*v_armature;
    out[19] = T;
    out[20] = rate_S;
    out[21] = T*rate_S;
    out[22] = T_0*c*exp(S/c);
    out[23] = T;
    out[24] = -lam*(T_e/T - 1.0);
    out[25] = -lam*(T_e - T);
    out[26] = rate_phi;
    out[27] = i_phi;
    out[28] = F_x;
    out[29] = v_armature;
    out[30] = i_phi*rate_phi + F_x*v_armature;
    out[31] = power_2(phi)*(g + x)/(2.0*mu*A*power_2(N));
}

/* Jacobian of rhs, n x n, row after row: d rhs[i]/d x[j] at out[i*n + j]. */
void electromagnet_jacobian(const double *restrict x_,
                            const double *restrict u,
                            const electromagnet_parameters *restrict p_,
                            double *restrict out)
{
    const long n = 5;
    const double g = p_->g;
    const double A = p_->A;
    const double N = p_->N;
    const double mu = p_->mu;
    const double m = p_->m;
    const double k = p_->k;
    const double d = p_->d;
    const double R = p_->R;
    const double c = p_->c;
    const double lam = p_->lam;
    const double T_0 = p_->T_0;
    const double p = x_[1];
    const double S = x_[2];
    const double phi = x_[3];
    const double x = x_[4];
    const double T_e = u[1];
    for (long j = 0; j < n*n; ++j) {
        out[j] = 0.0;
    }
    /* co-states dU/dx */
    const double v_armature = p/m;
    const double T = T_0*exp(S/c);
    const double i_phi = 2.0*(phi*(g + x))/(2.0*mu*A*power_2(N));
    /* dissipative laws */
    const double V_copper = R*i_phi;
    const double F_friction = d*v_armature;
    /* heats */
    const double heat_copper = V_copper*i_phi;
    const double heat_friction = F_friction*v_armature;
    /* derivatives */
    const double dF_friction_dp = d/m;
    const double dheat_friction_dp = v_armature*dF_friction_dp + F_friction/m;
    const double dT_dS = T/c;
    const double di_phi_dphi = 2.0*(g + x)/(2.0*mu*A*power_2(N));
    const double dF_x_dphi = 2.0*phi/(2.0*mu*A*power_2(N));
    const double dV_copper_dphi = R*di_phi_dphi;
    const double dheat_copper_dphi = i_phi*dV_copper_dphi + V_copper*di_phi_dphi;
    const double di_phi_dx = 2.0*phi/(2.0*mu*A*power_2(N));
    const double dV_copper_dx = R*di_phi_dx;
    const double dheat_copper_dx = i_phi*dV_copper_dx + V_copper*di_phi_dx;
    /* result */
    out[1] = 1.0/m;
    out[n + 0] = -k;
    out[n + 1] = -dF_friction_dp;
    out[n + 3] = -dF_x_dphi;
    out[2*n + 1] = dheat_friction_dp/T;
    out[2*n + 2] = (-(heat_copper + heat_friction)/power_2(T) - lam*T_e/power_2(T))*dT_dS;
    out[2*n + 3] = dheat_copper_dphi/T;
    out[2*n + 4] = dheat_copper_dx/T;
    out[3*n + 3] = -dV_copper_dphi;
    out[3*n + 4] = -dV_copper_dx;
    out[4*n + 1] = 1.0/m;
}

/* Margin by which each condition of the domain holds; of a bank, the least one. */
void electromagnet_margins(const double *restrict x_,
                           const double *restrict u,
                           const electromagnet_parameters *restrict p_,
                           double *restrict out)
{
    const double g = p_->g;
    const double A = p_->A;
    const double N = p_->N;
    const double mu = p_->mu;
    const double m = p_->m;
    const double k = p_->k;
    const double d = p_->d;
    const double R = p_->R;
    const double c = p_->c;
    const double lam = p_->lam;
    const double T_0 = p_->T_0;
    const double x = x_[4];
    const double T_e = u[1];
    out[0] = g + x;
    out[1] = A;
    out[2] = N;
    out[3] = mu;
    out[4] = d;
    out[5] = R;
    out[6] = lam;
    out[7] = T_e;
    out[8] = k;
    out[9] = m;
    out[10] = T_0;
    out[11] = c;
}
