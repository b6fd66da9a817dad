/*
 * Heat exchanger: two bodies in contact: irreversible port-Hamiltonian system.
 *
 * Source:  Ramirez, Maschke, Sbarbaro (2013), Chem. Eng. Sci. 89, 223-234, the heat exchanger
 * Model:   heat_exchanger, spec sha256 81da265b96a9585ebb1056051f48674761b82597e707def9ebb654e693d5bec0
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, sigma, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (S_hot, S_cold)
 * u = ()
 * p = pointer to heat_exchanger_parameters
 */
#include "heat_exchanger.h"

#include <math.h>

static double power_2(double z)
{
    return z*z;
}

/* Number of states n. */
long heat_exchanger_states(const heat_exchanger_parameters *restrict p)
{
    (void)p;
    return 2;
}

/* Number of processes, which produce entropy; of a bank, one per lane. */
long heat_exchanger_processes(const heat_exchanger_parameters *restrict p)
{
    (void)p;
    return 1;
}

/* State at t = 0 [SI], for the inputs u at t = 0. */
void heat_exchanger_initial_state(const double *restrict u,
                                  const heat_exchanger_parameters *restrict p,
                                  double *restrict out)
{
    (void)u;
    const double c_1 = p->c_1;
    const double c_2 = p->c_2;
    const double T_0 = p->T_0;
    const double T_1 = p->T_1;
    const double T_2 = p->T_2;
    out[0] = c_1*log(T_1/T_0);
    out[1] = c_2*log(T_2/T_0);
}

/* Rates dx/dt, the rows of J_ir dU/dx + g u. */
void heat_exchanger_rhs(const double *restrict x,
                        const double *restrict u,
                        const heat_exchanger_parameters *restrict p,
                        double *restrict out)
{
    (void)u;
    const double c_1 = p->c_1;
    const double c_2 = p->c_2;
    const double lam = p->lam;
    const double T_0 = p->T_0;
    const double S_hot = x[0];
    const double S_cold = x[1];
    /* co-states dU/dx */
    const double T_hot = T_0*exp(S_hot/c_1);
    const double T_cold = T_0*exp(S_cold/c_2);
    /* dissipative laws */
    const double s_contact = lam*(T_hot - T_cold)/T_hot;
    /* heats */
    const double heat_contact = s_contact*T_hot;
    /* result */
    out[0] = -s_contact;
    out[1] = heat_contact/T_cold;
}

/* Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient. */
void heat_exchanger_outputs(const double *restrict x,
                            const double *restrict u,
                            const heat_exchanger_parameters *restrict p,
                            double *restrict out)
{
    (void)x;
    (void)u;
    (void)p;
    (void)out;
}

/* Power supplied through each port [W]; the sum is dU/dt. */
void heat_exchanger_supply(const double *restrict x,
                           const double *restrict u,
                           const heat_exchanger_parameters *restrict p,
                           double *restrict out)
{
    (void)x;
    (void)u;
    (void)p;
    (void)out;
}

/* Hamiltonian U [J]. */
double heat_exchanger_energy(const double *restrict x,
                             const heat_exchanger_parameters *restrict p)
{
    const double c_1 = p->c_1;
    const double c_2 = p->c_2;
    const double T_0 = p->T_0;
    const double S_hot = x[0];
    const double S_cold = x[1];
    return T_0*c_1*exp(S_hot/c_1) + T_0*c_2*exp(S_cold/c_2);
}

/* Total entropy S [J/K]. */
double heat_exchanger_entropy(const double *restrict x,
                              const heat_exchanger_parameters *restrict p)
{
    (void)p;
    const double S_hot = x[0];
    const double S_cold = x[1];
    return S_hot + S_cold;
}

/* Temperature of each body [K]. */
void heat_exchanger_temperatures(const double *restrict x,
                                 const heat_exchanger_parameters *restrict p,
                                 double *restrict out)
{
    const double c_1 = p->c_1;
    const double c_2 = p->c_2;
    const double T_0 = p->T_0;
    const double S_hot = x[0];
    const double S_cold = x[1];
    /* co-states dU/dx */
    const double T_hot = T_0*exp(S_hot/c_1);
    const double T_cold = T_0*exp(S_cold/c_2);
    /* result */
    out[0] = T_hot;
    out[1] = T_cold;
}

/* Power that each process turns into heat [W]; of a bank, one row per lane. */
void heat_exchanger_heat(const double *restrict x,
                         const double *restrict u,
                         const heat_exchanger_parameters *restrict p,
                         double *restrict out)
{
    (void)u;
    const double c_1 = p->c_1;
    const double c_2 = p->c_2;
    const double lam = p->lam;
    const double T_0 = p->T_0;
    const double S_hot = x[0];
    const double S_cold = x[1];
    /* co-states dU/dx */
    const double T_hot = T_0*exp(S_hot/c_1);
    const double T_cold = T_0*exp(S_cold/c_2);
    /* dissipative laws */
    const double s_contact = lam*(T_hot - T_cold)/T_hot;
    /* result */
    out[0] = s_contact*T_hot;
}

/*
 * Entropy production of each process [W/K], heat exchange with ambients not included; of a
 * bank, one row per lane.
 */
void heat_exchanger_entropy_production(const double *restrict x,
                                       const double *restrict u,
                                       const heat_exchanger_parameters *restrict p,
                                       double *restrict out)
{
    (void)u;
    const double c_1 = p->c_1;
    const double c_2 = p->c_2;
    const double lam = p->lam;
    const double T_0 = p->T_0;
    const double S_hot = x[0];
    const double S_cold = x[1];
    /* co-states dU/dx */
    const double T_hot = T_0*exp(S_hot/c_1);
    const double T_cold = T_0*exp(S_cold/c_2);
    /* dissipative laws */
    const double s_contact = lam*(T_hot - T_cold)/T_hot;
    /* result */
    out[0] = s_contact*(T_hot - T_cold)/T_cold;
}

/* Effort, flow, power, energy and heat of elements; of a bank, one row per lane. */
void heat_exchanger_elements(const double *restrict x,
                             const double *restrict u,
                             const heat_exchanger_parameters *restrict p,
                             double *restrict out)
{
    (void)u;
    const double c_1 = p->c_1;
    const double c_2 = p->c_2;
    const double lam = p->lam;
    const double T_0 = p->T_0;
    const double S_hot = x[0];
    const double S_cold = x[1];
    /* co-states dU/dx */
    const double T_hot = T_0*exp(S_hot/c_1);
    const double T_cold = T_0*exp(S_cold/c_2);
    /* dissipative laws */
    const double s_contact = lam*(T_hot - T_cold)/T_hot;
    /* heats */
    const double heat_contact = s_contact*T_hot;
    /* rates */
    const double rate_S_hot = -s_contact;
    const double rate_S_cold = heat_contact/T_cold;
    /* result */
    out[0] = T_hot;
    out[1] = rate_S_hot;
    out[2] = T_hot*rate_S_hot;
    out[3] = T_0*c_1*exp(S_hot/c_1);
    out[4] = T_cold;
    out[5] = rate_S_cold;
    out[6] = T_cold*rate_S_cold;
    out[7] = T_0*c_2*exp(S_cold/c_2);
    out[8] = T_hot - T_cold;
    out[9] = s_contact*T_hot;
}

/* Jacobian of rhs, n x n, row after row: d rhs[i]/d x[j] at out[i*n + j]. */
void heat_exchanger_jacobian(const double *restrict x,
                             const double *restrict u,
                             const heat_exchanger_parameters *restrict p,
                             double *restrict out)
{
    (void)u;
    const long n = 2;
    const double c_1 = p->c_1;
    const double c_2 = p->c_2;
    const double lam = p->lam;
    const double T_0 = p->T_0;
    const double S_hot = x[0];
    const double S_cold = x[1];
    for (long j = 0; j < n*n; ++j) {
        out[j] = 0.0;
    }
    /* co-states dU/dx */
    const double T_hot = T_0*exp(S_hot/c_1);
    const double T_cold = T_0*exp(S_cold/c_2);
    /* dissipative laws */
    const double s_contact = lam*(T_hot - T_cold)/T_hot;
    /* heats */
    const double heat_contact = s_contact*T_hot;
    /* derivatives */
    const double dT_hot_dS_hot = T_hot/c_1;
    const double ds_contact_dS_hot = (lam/T_hot - lam*(T_hot - T_cold)/power_2(T_hot))*dT_hot_dS_hot;
    const double dheat_contact_dS_hot = T_hot*ds_contact_dS_hot + s_contact*dT_hot_dS_hot;
    const double dT_cold_dS_cold = T_cold/c_2;
    const double ds_contact_dS_cold = -lam/T_hot*dT_cold_dS_cold;
    const double dheat_contact_dS_cold = T_hot*ds_contact_dS_cold;
    /* result */
    out[0] = -ds_contact_dS_hot;
    out[1] = -ds_contact_dS_cold;
    out[n + 0] = dheat_contact_dS_hot/T_cold;
    out[n + 1] = dheat_contact_dS_cold/T_cold
        - heat_contact/power_2(T_cold)*dT_cold_dS_cold;
}

/* Margin by which each condition of the domain holds; of a bank, the least one. */
void heat_exchanger_margins(const double *restrict x,
                            const double *restrict u,
                            const heat_exchanger_parameters *restrict p,
                            double *restrict out)
{
    (void)x;
    (void)u;
    const double c_1 = p->c_1;
    const double c_2 = p->c_2;
    const double lam = p->lam;
    const double T_0 = p->T_0;
    const double T_1 = p->T_1;
    const double T_2 = p->T_2;
    out[0] = lam;
    out[1] = T_1;
    out[2] = T_2;
    out[3] = T_0;
    out[4] = c_1;
    out[5] = c_2;
}
