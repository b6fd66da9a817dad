/*
 * Piezoelectric stack of 3 layers that conduct heat: irreversible port-Hamiltonian system.
 *
 * Source:  Caballeria, Ramirez, Le Gorrec (2021), eqs. (9)-(13), Table 1, cut into layers; conductance between them: a choice
 * Model:   layered_stack, spec sha256 b46e92f413d7be38d2b0d17c8e7e220000a9ea90d48a027e94b79d81ff92ba5e
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, energy, entropy, welldef, continuous, passive, odd, sigma, exergy, environment, invariant, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (q_1, p_1, Q_1, phi_1, S_1, q_2, p_2, Q_2, phi_2, S_2, q_3, p_3, Q_3, phi_3, S_3)
 * u = (F_ext, V_in, T_e)
 * p = pointer to layered_stack_parameters
 */
#include "layered_stack.h"

#include <math.h>

static double pick(int condition, double a, double b)
{
    return condition ? a : b;
}

static double power_2(double z)
{
    return z*z;
}

/* Number of states n. */
long layered_stack_states(const layered_stack_parameters *restrict p)
{
    (void)p;
    return 15;
}

/* Number of processes, which produce entropy; of a bank, one per lane. */
long layered_stack_processes(const layered_stack_parameters *restrict p)
{
    (void)p;
    return 8;
}

/* State at t = 0 [SI], for the inputs u at t = 0. */
void layered_stack_initial_state(const double *restrict u,
                                 const layered_stack_parameters *restrict p,
                                 double *restrict out)
{
    const double T_0 = p->T_0;
    const double c_0 = p->c_0;
    const double T_e = u[2];
    out[0] = 0.0;
    out[1] = 0.0;
    out[2] = 0.0;
    out[3] = 0.0;
    out[4] = c_0*log(T_e/T_0);
    out[5] = 0.0;
    out[6] = 0.0;
    out[7] = 0.0;
    out[8] = 0.0;
    out[9] = c_0*log(T_e/T_0);
    out[10] = 0.0;
    out[11] = 0.0;
    out[12] = 0.0;
    out[13] = 0.0;
    out[14] = c_0*log(T_e/T_0);
}

/* Rates dx/dt, the rows of J_ir dU/dx + g u. */
void layered_stack_rhs(const double *restrict x,
                       const double *restrict u,
                       const layered_stack_parameters *restrict p,
                       double *restrict out)
{
    const double M = p->M;
    const double k = p->k;
    const double d = p->d;
    const double C = p->C;
    const double L = p->L;
    const double rho = p->rho;
    const double i_0 = p->i_0;
    const double a = p->a;
    const double T_0 = p->T_0;
    const double c_0 = p->c_0;
    const double lam = p->lam;
    const double lam_l = p->lam_l;
    const double q_1 = x[0];
    const double p_1 = x[1];
    const double Q_1 = x[2];
    const double phi_1 = x[3];
    const double S_1 = x[4];
    const double q_2 = x[5];
    const double p_2 = x[6];
    const double Q_2 = x[7];
    const double phi_2 = x[8];
    const double S_2 = x[9];
    const double q_3 = x[10];
    const double p_3 = x[11];
    const double Q_3 = x[12];
    const double phi_3 = x[13];
    const double S_3 = x[14];
    const double F_ext = u[0];
    const double V_in = u[1];
    const double T_e = u[2];
    /* co-states dU/dx */
    const double F_spring_1 = k*q_1;
    const double v_mass_1 = p_1/M;
    const double V_capacitor_1 = Q_1/C;
    const double i_hysteron_1 = phi_1/L;
    const double T_body_1_minus_T_0 = T_0*expm1(S_1/c_0);
    const double T_body_1 = T_0 + T_body_1_minus_T_0;
    const double F_spring_2 = k*q_2;
    const double v_mass_2 = p_2/M;
    const double V_capacitor_2 = Q_2/C;
    const double i_hysteron_2 = phi_2/L;
    const double T_body_2_minus_T_0 = T_0*expm1(S_2/c_0);
    const double T_body_2 = T_0 + T_body_2_minus_T_0;
    const double F_spring_3 = k*q_3;
    const double v_mass_3 = p_3/M;
    const double V_capacitor_3 = Q_3/C;
    const double i_hysteron_3 = phi_3/L;
    const double T_body_3_minus_T_0 = T_0*expm1(S_3/c_0);
    const double T_body_3 = T_0 + T_body_3_minus_T_0;
    /* transducer ratios */
    const double alpha_transducer_1 = a*T_body_1/T_0;
    const double alpha_transducer_2 = a*T_body_2/T_0;
    const double alpha_transducer_3 = a*T_body_3/T_0;
    /* dissipative laws */
    const double V_hysteron_1 = pick(
        fabs(i_hysteron_1) <= i_0,
        0.0,
        rho/T_body_1_minus_T_0*(i_hysteron_1 - copysign(i_0, i_hysteron_1)));
    const double F_damper_1 = d*v_mass_1;
    const double V_hysteron_2 = pick(
        fabs(i_hysteron_2) <= i_0,
        0.0,
        rho/T_body_2_minus_T_0*(i_hysteron_2 - copysign(i_0, i_hysteron_2)));
    /* driving forces */
    const double v_damper_2 = -v_mass_1 + v_mass_2;
    /* dissipative laws */
    const double F_damper_2 = d*v_damper_2;
    const double V_hysteron_3 = pick(
        fabs(i_hysteron_3) <= i_0,
        0.0,
        rho/T_body_3_minus_T_0*(i_hysteron_3 - copysign(i_0, i_hysteron_3)));
    /* driving forces */
    const double v_damper_3 = -v_mass_2 + v_mass_3;
    /* dissipative laws */
    const double F_damper_3 = d*v_damper_3;
    const double s_contact_1 = lam_l*(T_body_1 - T_body_2)/T_body_1;
    const double s_contact_2 = lam_l*(T_body_2 - T_body_3)/T_body_2;
    /* heats */
    const double heat_hysteron_1 = V_hysteron_1*i_hysteron_1;
    const double heat_damper_1 = F_damper_1*v_mass_1;
    const double heat_hysteron_2 = V_hysteron_2*i_hysteron_2;
    const double heat_damper_2 = F_damper_2*v_damper_2;
    const double heat_hysteron_3 = V_hysteron_3*i_hysteron_3;
    const double heat_damper_3 = F_damper_3*v_damper_3;
    const double heat_contact_1 = s_contact_1*T_body_1;
    const double heat_contact_2 = s_contact_2*T_body_2;
    /* result */
    out[0] = v_mass_1;
    out[1] = alpha_transducer_1*V_capacitor_1
        - F_spring_1
        + F_spring_2
        - alpha_transducer_2*V_capacitor_2
        - F_damper_1
        + F_damper_2;
    out[2] = i_hysteron_1 - alpha_transducer_1*v_mass_1;
    out[3] = V_in - V_capacitor_1 - V_hysteron_1;
    out[4] = (heat_hysteron_1 + heat_damper_1)/T_body_1
        - s_contact_1
        + lam*(T_e/T_body_1 - 1.0);
    out[5] = v_mass_2 - v_mass_1;
    out[6] = alpha_transducer_2*V_capacitor_2
        - F_spring_2
        + F_spring_3
        - alpha_transducer_3*V_capacitor_3
        - F_damper_2
        + F_damper_3;
    out[7] = alpha_transducer_2*v_mass_1 - alpha_transducer_2*v_mass_2 + i_hysteron_2;
    out[8] = V_in - V_capacitor_2 - V_hysteron_2;
    out[9] = (heat_hysteron_2 + heat_damper_2 + heat_contact_1)/T_body_2 - s_contact_2;
    out[10] = v_mass_3 - v_mass_2;
    out[11] = alpha_transducer_3*V_capacitor_3 - F_spring_3 - F_damper_3 + F_ext;
    out[12] = alpha_transducer_3*v_mass_2 - alpha_transducer_3*v_mass_3 + i_hysteron_3;
    out[13] = V_in - V_capacitor_3 - V_hysteron_3;
    out[14] = (heat_hysteron_3 + heat_damper_3 + heat_contact_2)/T_body_3
        + lam*(T_e/T_body_3 - 1.0);
}

/* Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient. */
void layered_stack_outputs(const double *restrict x,
                           const double *restrict u,
                           const layered_stack_parameters *restrict p,
                           double *restrict out)
{
    (void)u;
    const double M = p->M;
    const double L = p->L;
    const double T_0 = p->T_0;
    const double c_0 = p->c_0;
    const double phi_1 = x[3];
    const double S_1 = x[4];
    const double phi_2 = x[8];
    const double p_3 = x[11];
    const double phi_3 = x[13];
    const double S_3 = x[14];
    /* co-states dU/dx */
    const double i_hysteron_1 = phi_1/L;
    const double T_body_1_minus_T_0 = T_0*expm1(S_1/c_0);
    const double T_body_1 = T_0 + T_body_1_minus_T_0;
    const double i_hysteron_2 = phi_2/L;
    const double v_mass_3 = p_3/M;
    const double i_hysteron_3 = phi_3/L;
    const double T_body_3_minus_T_0 = T_0*expm1(S_3/c_0);
    const double T_body_3 = T_0 + T_body_3_minus_T_0;
    /* result */
    out[0] = v_mass_3;
    out[1] = i_hysteron_1 + i_hysteron_2 + i_hysteron_3;
    out[2] = T_body_1;
    out[3] = T_body_3;
}

/* Power supplied through each port [W]; the sum is dU/dt. */
void layered_stack_supply(const double *restrict x,
                          const double *restrict u,
                          const layered_stack_parameters *restrict p,
                          double *restrict out)
{
    const double M = p->M;
    const double L = p->L;
    const double T_0 = p->T_0;
    const double c_0 = p->c_0;
    const double lam = p->lam;
    const double phi_1 = x[3];
    const double S_1 = x[4];
    const double phi_2 = x[8];
    const double p_3 = x[11];
    const double phi_3 = x[13];
    const double S_3 = x[14];
    const double F_ext = u[0];
    const double V_in = u[1];
    const double T_e = u[2];
    /* co-states dU/dx */
    const double i_hysteron_1 = phi_1/L;
    const double T_body_1_minus_T_0 = T_0*expm1(S_1/c_0);
    const double T_body_1 = T_0 + T_body_1_minus_T_0;
    const double i_hysteron_2 = phi_2/L;
    const double v_mass_3 = p_3/M;
    const double i_hysteron_3 = phi_3/L;
    const double T_body_3_minus_T_0 = T_0*expm1(S_3/c_0);
    const double T_body_3 = T_0 + T_body_3_minus_T_0;
    /* result */
    out[0] = v_mass_3*F_ext;
    out[1] = (i_hysteron_1 + i_hysteron_2 + i_hysteron_3)*V_in;
    out[2] = lam*(T_e - T_body_1);
    out[3] = lam*(T_e - T_body_3);
}

/* Hamiltonian U [J]. */
double layered_stack_energy(const double *restrict x,
                            const layered_stack_parameters *restrict p)
{
    const double M = p->M;
    const double k = p->k;
    const double C = p->C;
    const double L = p->L;
    const double T_0 = p->T_0;
    const double c_0 = p->c_0;
    const double q_1 = x[0];
    const double p_1 = x[1];
    const double Q_1 = x[2];
    const double phi_1 = x[3];
    const double S_1 = x[4];
    const double q_2 = x[5];
    const double p_2 = x[6];
    const double Q_2 = x[7];
    const double phi_2 = x[8];
    const double S_2 = x[9];
    const double q_3 = x[10];
    const double p_3 = x[11];
    const double Q_3 = x[12];
    const double phi_3 = x[13];
    const double S_3 = x[14];
    return k*power_2(q_1)/2.0
        + power_2(p_1)/(2.0*M)
        + power_2(Q_1)/(2.0*C)
        + power_2(phi_1)/(2.0*L)
        + T_0*c_0*exp(S_1/c_0)
        + k*power_2(q_2)/2.0
        + power_2(p_2)/(2.0*M)
        + power_2(Q_2)/(2.0*C)
        + power_2(phi_2)/(2.0*L)
        + T_0*c_0*exp(S_2/c_0)
        + k*power_2(q_3)/2.0
        + power_2(p_3)/(2.0*M)
        + power_2(Q_3)/(2.0*C)
        + power_2(phi_3)/(2.0*L)
        + T_0*c_0*exp(S_3/c_0);
}

/* Total entropy S [J/K]. */
double layered_stack_entropy(const double *restrict x,
                             const layered_stack_parameters *restrict p)
{
    (void)p;
    const double S_1 = x[4];
    const double S_2 = x[9];
    const double S_3 = x[14];
    return S_1 + S_2 + S_3;
}

/* Temperature of each body [K]. */
void layered_stack_temperatures(const double *restrict x,
                                const layered_stack_parameters *restrict p,
                                double *restrict out)
{
    const double T_0 = p->T_0;
    const double c_0 = p->c_0;
    const double S_1 = x[4];
    const double S_2 = x[9];
    const double S_3 = x[14];
    /* co-states dU/dx */
    const double T_body_1_minus_T_0 = T_0*expm1(S_1/c_0);
    const double T_body_1 = T_0 + T_body_1_minus_T_0;
    const double T_body_2_minus_T_0 = T_0*expm1(S_2/c_0);
    const double T_body_2 = T_0 + T_body_2_minus_T_0;
    const double T_body_3_minus_T_0 = T_0*expm1(S_3/c_0);
    const double T_body_3 = T_0 + T_body_3_minus_T_0;
    /* result */
    out[0] = T_body_1;
    out[1] = T_body_2;
    out[2] = T_body_3;
}

/* Power that each process turns into heat [W]; of a bank, one row per lane. */
void layered_stack_heat(const double *restrict x,
                        const double *restrict u,
                        const layered_stack_parameters *restrict p,
                        double *restrict out)
{
    (void)u;
    const double M = p->M;
    const double d = p->d;
    const double L = p->L;
    const double rho = p->rho;
    const double i_0 = p->i_0;
    const double T_0 = p->T_0;
    const double c_0 = p->c_0;
    const double lam_l = p->lam_l;
    const double p_1 = x[1];
    const double phi_1 = x[3];
    const double S_1 = x[4];
    const double p_2 = x[6];
    const double phi_2 = x[8];
    const double S_2 = x[9];
    const double p_3 = x[11];
    const double phi_3 = x[13];
    const double S_3 = x[14];
    /* co-states dU/dx */
    const double v_mass_1 = p_1/M;
    const double i_hysteron_1 = phi_1/L;
    const double T_body_1_minus_T_0 = T_0*expm1(S_1/c_0);
    const double T_body_1 = T_0 + T_body_1_minus_T_0;
    const double v_mass_2 = p_2/M;
    const double i_hysteron_2 = phi_2/L;
    const double T_body_2_minus_T_0 = T_0*expm1(S_2/c_0);
    const double T_body_2 = T_0 + T_body_2_minus_T_0;
    const double v_mass_3 = p_3/M;
    const double i_hysteron_3 = phi_3/L;
    const double T_body_3_minus_T_0 = T_0*expm1(S_3/c_0);
    const double T_body_3 = T_0 + T_body_3_minus_T_0;
    /* dissipative laws */
    const double V_hysteron_1 = pick(
        fabs(i_hysteron_1) <= i_0,
        0.0,
        rho/T_body_1_minus_T_0*(i_hysteron_1 - copysign(i_0, i_hysteron_1)));
    const double F_damper_1 = d*v_mass_1;
    const double V_hysteron_2 = pick(
        fabs(i_hysteron_2) <= i_0,
        0.0,
        rho/T_body_2_minus_T_0*(i_hysteron_2 - copysign(i_0, i_hysteron_2)));
    /* driving forces */
    const double v_damper_2 = -v_mass_1 + v_mass_2;
    /* dissipative laws */
    const double F_damper_2 = d*v_damper_2;
    const double V_hysteron_3 = pick(
        fabs(i_hysteron_3) <= i_0,
        0.0,
        rho/T_body_3_minus_T_0*(i_hysteron_3 - copysign(i_0, i_hysteron_3)));
    /* driving forces */
    const double v_damper_3 = -v_mass_2 + v_mass_3;
    /* dissipative laws */
    const double F_damper_3 = d*v_damper_3;
    const double s_contact_1 = lam_l*(T_body_1 - T_body_2)/T_body_1;
    const double s_contact_2 = lam_l*(T_body_2 - T_body_3)/T_body_2;
    /* result */
    out[0] = V_hysteron_1*i_hysteron_1;
    out[1] = F_damper_1*v_mass_1;
    out[2] = V_hysteron_2*i_hysteron_2;
    out[3] = F_damper_2*v_damper_2;
    out[4] = V_hysteron_3*i_hysteron_3;
    out[5] = F_damper_3*v_damper_3;
    out[6] = s_contact_1*T_body_1;
    out[7] = s_contact_2*T_body_2;
}

/*
 * Entropy production of each process [W/K], heat exchange with ambients not included; of a
 * bank, one row per lane.
 */
void layered_stack_entropy_production(const double *restrict x,
                                      const double *restrict u,
                                      const layered_stack_parameters *restrict p,
                                      double *restrict out)
{
    (void)u;
    const double M = p->M;
    const double d = p->d;
    const double L = p->L;
    const double rho = p->rho;
    const double i_0 = p->i_0;
    const double T_0 = p->T_0;
    const double c_0 = p->c_0;
    const double lam_l = p->lam_l;
    const double p_1 = x[1];
    const double phi_1 = x[3];
    const double S_1 = x[4];
    const double p_2 = x[6];
    const double phi_2 = x[8];
    const double S_2 = x[9];
    const double p_3 = x[11];
    const double phi_3 = x[13];
    const double S_3 = x[14];
    /* co-states dU/dx */
    const double v_mass_1 = p_1/M;
    const double i_hysteron_1 = phi_1/L;
    const double T_body_1_minus_T_0 = T_0*expm1(S_1/c_0);
    const double T_body_1 = T_0 + T_body_1_minus_T_0;
    const double v_mass_2 = p_2/M;
    const double i_hysteron_2 = phi_2/L;
    const double T_body_2_minus_T_0 = T_0*expm1(S_2/c_0);
    const double T_body_2 = T_0 + T_body_2_minus_T_0;
    const double v_mass_3 = p_3/M;
    const double i_hysteron_3 = phi_3/L;
    const double T_body_3_minus_T_0 = T_0*expm1(S_3/c_0);
    const double T_body_3 = T_0 + T_body_3_minus_T_0;
    /* dissipative laws */
    const double V_hysteron_1 = pick(
        fabs(i_hysteron_1) <= i_0,
        0.0,
        rho/T_body_1_minus_T_0*(i_hysteron_1 - copysign(i_0, i_hysteron_1)));
    const double F_damper_1 = d*v_mass_1;
    const double V_hysteron_2 = pick(
        fabs(i_hysteron_2) <= i_0,
        0.0,
        rho/T_body_2_minus_T_0*(i_hysteron_2 - copysign(i_0, i_hysteron_2)));
    /* driving forces */
    const double v_damper_2 = -v_mass_1 + v_mass_2;
    /* dissipative laws */
    const double F_damper_2 = d*v_damper_2;
    const double V_hysteron_3 = pick(
        fabs(i_hysteron_3) <= i_0,
        0.0,
        rho/T_body_3_minus_T_0*(i_hysteron_3 - copysign(i_0, i_hysteron_3)));
    /* driving forces */
    const double v_damper_3 = -v_mass_2 + v_mass_3;
    /* dissipative laws */
    const double F_damper_3 = d*v_damper_3;
    const double s_contact_1 = lam_l*(T_body_1 - T_body_2)/T_body_1;
    const double s_contact_2 = lam_l*(T_body_2 - T_body_3)/T_body_2;
    /* result */
    out[0] = V_hysteron_1*i_hysteron_1/T_body_1;
    out[1] = F_damper_1*v_mass_1/T_body_1;
    out[2] = V_hysteron_2*i_hysteron_2/T_body_2;
    out[3] = F_damper_2*v_damper_2/T_body_2;
    out[4] = V_hysteron_3*i_hysteron_3/T_body_3;
    out[5] = F_damper_3*v_damper_3/T_body_3;
    out[6] = s_contact_1*(T_body_1 - T_body_2)/T_body_2;
    out[7] = s_contact_2*(T_body_2 - T_body_3)/T_body_3;
}

/* Effort, flow, power, energy and heat of elements; of a bank, one row per lane. */
void layered_stack_elements(const double *restrict x,
                            const double *restrict u,
                            const layered_stack_parameters *restrict p,
                            double *restrict out)
{
    const double M = p->M;
    const double k = p->k;
    const double d = p->d;
    const double C = p->C;
    const double L = p->L;
    const double rho = p->rho;
    const double i_0 = p->i_0;
    const double a = p->a;
    const double T_0 = p->T_0;
    const double c_0 = p->c_0;
    const double lam = p->lam;
    const double lam_l = p->lam_l;
    const double q_1 = x[0];
    const double p_1 = x[1];
    const double Q_1 = x[2];
    const double phi_1 = x[3];
    const double S_1 = x[4];
    const double q_2 = x[5];
    const double p_2 = x[6];
    const double Q_2 = x[7];
    const double phi_2 = x[8];
    const double S_2 = x[9];
    const double q_3 = x[10];
    const double p_3 = x[11];
    const double Q_3 = x[12];
    const double phi_3 = x[13];
    const double S_3 = x[14];
    const double F_ext = u[0];
    const double V_in = u[1];
    const double T_e = u[2];
    /* co-states dU/dx */
    const double F_spring_1 = k*q_1;
    const double v_mass_1 = p_1/M;
    const double V_capacitor_1 = Q_1/C;
    const double i_hysteron_1 = phi_1/L;
    const double T_body_1_minus_T_0 = T_0*expm1(S_1/c_0);
    const double T_body_1 = T_0 + T_body_1_minus_T_0;
    const double F_spring_2 = k*q_2;
    const double v_mass_2 = p_2/M;
    const double V_capacitor_2 = Q_2/C;
    const double i_hysteron_2 = phi_2/L;
    const double T_body_2_minus_T_0 = T_0*expm1(S_2/c_0);
    const double T_body_2 = T_0 + T_body_2_minus_T_0;
    const double F_spring_3 = k*q_3;
    const double v_mass_3 = p_3/M;
    const double V_capacitor_3 = Q_3/C;
    const double i_hysteron_3 = phi_3/L;
    const double T_body_3_minus_T_0 = T_0*expm1(S_3/c_0);
    const double T_body_3 = T_0 + T_body_3_minus_T_0;
    /* transducer ratios */
    const double alpha_transducer_1 = a*T_body_1/T_0;
    const double alpha_transducer_2 = a*T_body_2/T_0;
    const double alpha_transducer_3 = a*T_body_3/T_0;
    /* dissipative laws */
    const double V_hysteron_1 = pick(
        fabs(i_hysteron_1) <= i_0,
        0.0,
        rho/T_body_1_minus_T_0*(i_hysteron_1 - copysign(i_0, i_hysteron_1)));
    const double F_damper_1 = d*v_mass_1;
    const double V_hysteron_2 = pick(
        fabs(i_hysteron_2) <= i_0,
        0.0,
        rho/T_body_2_minus_T_0*(i_hysteron_2 - copysign(i_0, i_hysteron_2)));
    /* driving forces */
    const double v_damper_2 = -v_mass_1 + v_mass_2;
    /* dissipative laws */
    const double F_damper_2 = d*v_damper_2;
    const double V_hysteron_3 = pick(
        fabs(i_hysteron_3) <= i_0,
        0.0,
        rho/T_body_3_minus_T_0*(i_hysteron_3 - copysign(i_0, i_hysteron_3)));
    /* driving forces */
    const double v_damper_3 = -v_mass_2 + v_mass_3;
    /* dissipative laws */
    const double F_damper_3 = d*v_damper_3;
    const double s_contact_1 = lam_l*(T_body_1 - T_body_2)/T_body_1;
    const double s_contact_2 = lam_l*(T_body_2 - T_body_3)/T_body_2;
    /* heats */
    const double heat_hysteron_1 = V_hysteron_1*i_hysteron_1;
    const double heat_damper_1 = F_damper_1*v_mass_1;
    const double heat_hysteron_2 = V_hysteron_2*i_hysteron_2;
    const double heat_damper_2 = F_damper_2*v_damper_2;
    const double heat_hysteron_3 = V_hysteron_3*i_hysteron_3;
    const double heat_damper_3 = F_damper_3*v_damper_3;
    const double heat_contact_1 = s_contact_1*T_body_1;
    const double heat_contact_2 = s_contact_2*T_body_2;
    /* rates */
    const double rate_p_1 = alpha_transducer_1*V_capacitor_1
        - F_spring_1
        + F_spring_2
        - alpha_transducer_2*V_capacitor_2
        - F_damper_1
        + F_damper_2;
    const double rate_Q_1 = i_hysteron_1 - alpha_transducer_1*v_mass_1;
    const double rate_phi_1 = V_in - V_capacitor_1 - V_hysteron_1;
    const double rate_S_1 = (heat_hysteron_1 + heat_damper_1)/T_body_1
        - s_contact_1
        + lam*(T_e/T_body_1 - 1.0);
    const double rate_q_2 = v_mass_2 - v_mass_1;
    const double rate_p_2 = alpha_transducer_2*V_capacitor_2
        - F_spring_2
        + F_spring_3
        - alpha_transducer_3*V_capacitor_3
        - F_damper_2
        + F_damper_3;
    const double rate_Q_2 = alpha_transducer_2*v_mass_1
        - alpha_transducer_2*v_mass_2
        + i_hysteron_2;
    const double rate_phi_2 = V_in - V_capacitor_2 - V_hysteron_2;
    const double rate_S_2 = (heat_hysteron_2 + heat_damper_2 + heat_contact_1)/T_body_2
        - s_contact_2;
    const double rate_q_3 = v_mass_3 - v_mass_2;
    const double rate_p_3 = alpha_transducer_3*V_capacitor_3
        - F_spring_3
        - F_damper_3
        + F_ext;
    const double rate_Q_3 = alpha_transducer_3*v_mass_2
        - alpha_transducer_3*v_mass_3
        + i_hysteron_3;
    const double rate_phi_3 = V_in - V_capacitor_3 - V_hysteron_3;
    const double rate_S_3 = (heat_hysteron_3 + heat_damper_3 + heat_contact_2)/T_body_3
        + lam*(T_e/T_body_3 - 1.0);
    /* result */
    out[0] = F_spring_1;
    out[1] = v_mass_1;
    out[2] = F_spring_1*v_mass_1;
    out[3] = k*power_2(q_1)/2.0;
    out[4] = rate_p_1;
    out[5] = v_mass_1;
    out[6] = rate_p_1*v_mass_1;
    out[7] = power_2(p_1)/(2.0*M);
    out[8] = V_capacitor_1;
    out[9] = rate_Q_1;
    out[10] = V_capacitor_1*rate_Q_1;
    out[11] = power_2(Q_1)/(2.0*C);
    out[12] = rate_phi_1 + V_hysteron_1;
    out[13] = i_hysteron_1;
    out[14] = (rate_phi_1 + V_hysteron_1)*i_hysteron_1;
    out[15] = power_2(phi_1)/(2.0*L);
    out[16] = V_hysteron_1*i_hysteron_1;
    out[17] = F_damper_1;
    out[18] = v_mass_1;
    out[19] = F_damper_1*v_mass_1;
    out[20] = F_damper_1*v_mass_1;
    out[21] = V_capacitor_1;
    out[22] = alpha_transducer_1*v_mass_1;
    out[23] = -alpha_transducer_1*V_capacitor_1;
    out[24] = v_mass_1;
    out[25] = V_capacitor_1*alpha_transducer_1*v_mass_1;
    out[26] = T_body_1;
    out[27] = rate_S_1;
    out[28] = T_body_1*rate_S_1;
    out[29] = T_0*c_0*exp(S_1/c_0);
    out[30] = F_spring_2;
    out[31] = rate_q_2;
    out[32] = F_spring_2*rate_q_2;
    out[33] = k*power_2(q_2)/2.0;
    out[34] = rate_p_2;
    out[35] = v_mass_2;
    out[36] = rate_p_2*v_mass_2;
    out[37] = power_2(p_2)/(2.0*M);
    out[38] = V_capacitor_2;
    out[39] = rate_Q_2;
    out[40] = V_capacitor_2*rate_Q_2;
    out[41] = power_2(Q_2)/(2.0*C);
    out[42] = rate_phi_2 + V_hysteron_2;
    out[43] = i_hysteron_2;
    out[44] = (rate_phi_2 + V_hysteron_2)*i_hysteron_2;
    out[45] = power_2(phi_2)/(2.0*L);
    out[46] = V_hysteron_2*i_hysteron_2;
    out[47] = F_damper_2;
    out[48] = v_damper_2;
    out[49] = F_damper_2*v_damper_2;
    out[50] = F_damper_2*v_damper_2;
    out[51] = V_capacitor_2;
    out[52] = alpha_transducer_2*(-v_mass_1 + v_mass_2);
    out[53] = -alpha_transducer_2*V_capacitor_2;
    out[54] = -v_mass_1 + v_mass_2;
    out[55] = V_capacitor_2*alpha_transducer_2*(-v_mass_1 + v_mass_2);
    out[56] = T_body_2;
    out[57] = rate_S_2;
    out[58] = T_body_2*rate_S_2;
    out[59] = T_0*c_0*exp(S_2/c_0);
    out[60] = F_spring_3;
    out[61] = rate_q_3;
    out[62] = F_spring_3*rate_q_3;
    out[63] = k*power_2(q_3)/2.0;
    out[64] = rate_p_3;
    out[65] = v_mass_3;
    out[66] = rate_p_3*v_mass_3;
    out[67] = power_2(p_3)/(2.0*M);
    out[68] = V_capacitor_3;
    out[69] = rate_Q_3;
    out[70] = V_capacitor_3*rate_Q_3;
    out[71] = power_2(Q_3)/(2.0*C);
    out[72] = rate_phi_3 + V_hysteron_3;
    out[73] = i_hysteron_3;
    out[74] = (rate_phi_3 + V_hysteron_3)*i_hysteron_3;
    out[75] = power_2(phi_3)/(2.0*L);
    out[76] = V_hysteron_3*i_hysteron_3;
    out[77] = F_damper_3;
    out[78] = v_damper_3;
    out[79] = F_damper_3*v_damper_3;
    out[80] = F_damper_3*v_damper_3;
    out[81] = V_capacitor_3;
    out[82] = alpha_transducer_3*(-v_mass_2 + v_mass_3);
    out[83] = -alpha_transducer_3*V_capacitor_3;
    out[84] = -v_mass_2 + v_mass_3;
    out[85] = V_capacitor_3*alpha_transducer_3*(-v_mass_2 + v_mass_3);
    out[86] = T_body_3;
    out[87] = rate_S_3;
    out[88] = T_body_3*rate_S_3;
    out[89] = T_0*c_0*exp(S_3/c_0);
    out[90] = T_body_1 - T_body_2;
    out[91] = s_contact_1*T_body_1;
    out[92] = T_body_2 - T_body_3;
    out[93] = s_contact_2*T_body_2;
    out[94] = T_body_1;
    out[95] = -lam*(T_e/T_body_1 - 1.0);
    out[96] = -lam*(T_e - T_body_1);
    out[97] = T_body_3;
    out[98] = -lam*(T_e/T_body_3 - 1.0);
    out[99] = -lam*(T_e - T_body_3);
    out[100] = -F_ext;
    out[101] = v_mass_3;
    out[102] = -v_mass_3*F_ext;
    out[103] = V_in;
    out[104] = -(i_hysteron_1 + i_hysteron_2 + i_hysteron_3);
    out[105] = -(i_hysteron_1 + i_hysteron_2 + i_hysteron_3)*V_in;
}

/* Jacobian of rhs, n x n, row after row: d rhs[i]/d x[j] at out[i*n + j]. */
void layered_stack_jacobian(const double *restrict x,
                            const double *restrict u,
                            const layered_stack_parameters *restrict p,
                            double *restrict out)
{
    const long n = 15;
    const double M = p->M;
    const double k = p->k;
    const double d = p->d;
    const double C = p->C;
    const double L = p->L;
    const double rho = p->rho;
    const double i_0 = p->i_0;
    const double a = p->a;
    const double T_0 = p->T_0;
    const double c_0 = p->c_0;
    const double lam = p->lam;
    const double lam_l = p->lam_l;
    const double p_1 = x[1];
    const double Q_1 = x[2];
    const double phi_1 = x[3];
    const double S_1 = x[4];
    const double p_2 = x[6];
    const double Q_2 = x[7];
    const double phi_2 = x[8];
    const double S_2 = x[9];
    const double p_3 = x[11];
    const double Q_3 = x[12];
    const double phi_3 = x[13];
    const double S_3 = x[14];
    const double T_e = u[2];
    for (long j = 0; j < n*n; ++j) {
        out[j] = 0.0;
    }
    /* co-states dU/dx */
    const double v_mass_1 = p_1/M;
    const double V_capacitor_1 = Q_1/C;
    const double i_hysteron_1 = phi_1/L;
    const double T_body_1_minus_T_0 = T_0*expm1(S_1/c_0);
    const double T_body_1 = T_0 + T_body_1_minus_T_0;
    const double v_mass_2 = p_2/M;
    const double V_capacitor_2 = Q_2/C;
    const double i_hysteron_2 = phi_2/L;
    const double T_body_2_minus_T_0 = T_0*expm1(S_2/c_0);
    const double T_body_2 = T_0 + T_body_2_minus_T_0;
    const double v_mass_3 = p_3/M;
    const double V_capacitor_3 = Q_3/C;
    const double i_hysteron_3 = phi_3/L;
    const double T_body_3_minus_T_0 = T_0*expm1(S_3/c_0);
    const double T_body_3 = T_0 + T_body_3_minus_T_0;
    /* transducer ratios */
    const double alpha_transducer_1 = a*T_body_1/T_0;
    const double alpha_transducer_2 = a*T_body_2/T_0;
    const double alpha_transducer_3 = a*T_body_3/T_0;
    /* dissipative laws */
    const double V_hysteron_1 = pick(
        fabs(i_hysteron_1) <= i_0,
        0.0,
        rho/T_body_1_minus_T_0*(i_hysteron_1 - copysign(i_0, i_hysteron_1)));
    const double F_damper_1 = d*v_mass_1;
    const double V_hysteron_2 = pick(
        fabs(i_hysteron_2) <= i_0,
        0.0,
        rho/T_body_2_minus_T_0*(i_hysteron_2 - copysign(i_0, i_hysteron_2)));
    /* driving forces */
    const double v_damper_2 = -v_mass_1 + v_mass_2;
    /* dissipative laws */
    const double F_damper_2 = d*v_damper_2;
    const double V_hysteron_3 = pick(
        fabs(i_hysteron_3) <= i_0,
        0.0,
        rho/T_body_3_minus_T_0*(i_hysteron_3 - copysign(i_0, i_hysteron_3)));
    /* driving forces */
    const double v_damper_3 = -v_mass_2 + v_mass_3;
    /* dissipative laws */
    const double F_damper_3 = d*v_damper_3;
    const double s_contact_1 = lam_l*(T_body_1 - T_body_2)/T_body_1;
    const double s_contact_2 = lam_l*(T_body_2 - T_body_3)/T_body_2;
    /* heats */
    const double heat_hysteron_1 = V_hysteron_1*i_hysteron_1;
    const double heat_damper_1 = F_damper_1*v_mass_1;
    const double heat_hysteron_2 = V_hysteron_2*i_hysteron_2;
    const double heat_damper_2 = F_damper_2*v_damper_2;
    const double heat_hysteron_3 = V_hysteron_3*i_hysteron_3;
    const double heat_damper_3 = F_damper_3*v_damper_3;
    const double heat_contact_1 = s_contact_1*T_body_1;
    const double heat_contact_2 = s_contact_2*T_body_2;
    /* derivatives */
    const double dF_damper_1_dp_1 = d/M;
    const double dF_damper_2_dp_1 = -d/M;
    const double dheat_damper_1_dp_1 = v_mass_1*dF_damper_1_dp_1 + F_damper_1/M;
    const double dheat_damper_2_dp_1 = v_damper_2*dF_damper_2_dp_1 - F_damper_2/M;
    const double dV_hysteron_1_dphi_1 = pick(fabs(i_hysteron_1) > i_0, rho/T_body_1_minus_T_0, 0.0)/L;
    const double dheat_hysteron_1_dphi_1 = i_hysteron_1*dV_hysteron_1_dphi_1
        + V_hysteron_1/L;
    const double dT_body_1_minus_T_0_dS_1 = T_body_1/c_0;
    const double dalpha_transducer_1_dS_1 = a/T_0*dT_body_1_minus_T_0_dS_1;
    const double dV_hysteron_1_dS_1 = pick(
        fabs(i_hysteron_1) <= i_0,
        0.0,
        -rho/power_2(T_body_1_minus_T_0)*(i_hysteron_1 - copysign(i_0, i_hysteron_1))*dT_body_1_minus_T_0_dS_1);
    const double ds_contact_1_dS_1 = (lam_l/T_body_1 - lam_l*(T_body_1 - T_body_2)/power_2(T_body_1))*dT_body_1_minus_T_0_dS_1;
    const double dheat_hysteron_1_dS_1 = i_hysteron_1*dV_hysteron_1_dS_1;
    const double dheat_contact_1_dS_1 = T_body_1*ds_contact_1_dS_1
        + s_contact_1*dT_body_1_minus_T_0_dS_1;
    const double dF_damper_2_dp_2 = d/M;
    const double dF_damper_3_dp_2 = -d/M;
    const double dheat_damper_2_dp_2 = v_damper_2*dF_damper_2_dp_2 + F_damper_2/M;
    const double dheat_damper_3_dp_2 = v_damper_3*dF_damper_3_dp_2 - F_damper_3/M;
    const double dV_hysteron_2_dphi_2 = pick(fabs(i_hysteron_2) > i_0, rho/T_body_2_minus_T_0, 0.0)/L;
    const double dheat_hysteron_2_dphi_2 = i_hysteron_2*dV_hysteron_2_dphi_2
        + V_hysteron_2/L;
    const double dT_body_2_minus_T_0_dS_2 = T_body_2/c_0;
    const double dalpha_transducer_2_dS_2 = a/T_0*dT_body_2_minus_T_0_dS_2;
    const double dV_hysteron_2_dS_2 = pick(
        fabs(i_hysteron_2) <= i_0,
        0.0,
        -rho/power_2(T_body_2_minus_T_0)*(i_hysteron_2 - copysign(i_0, i_hysteron_2))*dT_body_2_minus_T_0_dS_2);
    const double ds_contact_1_dS_2 = -lam_l/T_body_1*dT_body_2_minus_T_0_dS_2;
    const double ds_contact_2_dS_2 = (lam_l/T_body_2 - lam_l*(T_body_2 - T_body_3)/power_2(T_body_2))*dT_body_2_minus_T_0_dS_2;
    const double dheat_hysteron_2_dS_2 = i_hysteron_2*dV_hysteron_2_dS_2;
    const double dheat_contact_1_dS_2 = T_body_1*ds_contact_1_dS_2;
    const double dheat_contact_2_dS_2 = T_body_2*ds_contact_2_dS_2
        + s_contact_2*dT_body_2_minus_T_0_dS_2;
    const double dF_damper_3_dp_3 = d/M;
    const double dheat_damper_3_dp_3 = v_damper_3*dF_damper_3_dp_3 + F_damper_3/M;
    const double dV_hysteron_3_dphi_3 = pick(fabs(i_hysteron_3) > i_0, rho/T_body_3_minus_T_0, 0.0)/L;
    const double dheat_hysteron_3_dphi_3 = i_hysteron_3*dV_hysteron_3_dphi_3
        + V_hysteron_3/L;
    const double dT_body_3_minus_T_0_dS_3 = T_body_3/c_0;
    const double dalpha_transducer_3_dS_3 = a/T_0*dT_body_3_minus_T_0_dS_3;
    const double dV_hysteron_3_dS_3 = pick(
        fabs(i_hysteron_3) <= i_0,
        0.0,
        -rho/power_2(T_body_3_minus_T_0)*(i_hysteron_3 - copysign(i_0, i_hysteron_3))*dT_body_3_minus_T_0_dS_3);
    const double ds_contact_2_dS_3 = -lam_l/T_body_2*dT_body_3_minus_T_0_dS_3;
    const double dheat_hysteron_3_dS_3 = i_hysteron_3*dV_hysteron_3_dS_3;
    const double dheat_contact_2_dS_3 = T_body_2*ds_contact_2_dS_3;
    /* result */
    out[1] = 1.0/M;
    out[n + 0] = -k;
    out[n + 1] = -dF_damper_1_dp_1 + dF_damper_2_dp_1;
    out[n + 2] = alpha_transducer_1/C;
    out[n + 4] = V_capacitor_1*dalpha_transducer_1_dS_1;
    out[n + 5] = k;
    out[n + 6] = dF_damper_2_dp_2;
    out[n + 7] = -alpha_transducer_2/C;
    out[n + 9] = -V_capacitor_2*dalpha_transducer_2_dS_2;
    out[2*n + 1] = -alpha_transducer_1/M;
    out[2*n + 3] = 1.0/L;
    out[2*n + 4] = -v_mass_1*dalpha_transducer_1_dS_1;
    out[3*n + 2] = -1.0/C;
    out[3*n + 3] = -dV_hysteron_1_dphi_1;
    out[3*n + 4] = -dV_hysteron_1_dS_1;
    out[4*n + 1] = dheat_damper_1_dp_1/T_body_1;
    out[4*n + 3] = dheat_hysteron_1_dphi_1/T_body_1;
    out[4*n + 4] = dheat_hysteron_1_dS_1/T_body_1
        + (-(heat_hysteron_1 + heat_damper_1)/power_2(T_body_1) - lam*T_e/power_2(T_body_1))*dT_body_1_minus_T_0_dS_1
        - ds_contact_1_dS_1;
    out[4*n + 9] = -ds_contact_1_dS_2;
    out[5*n + 1] = -1.0/M;
    out[5*n + 6] = 1.0/M;
    out[6*n + 1] = -dF_damper_2_dp_1;
    out[6*n + 5] = -k;
    out[6*n + 6] = -dF_damper_2_dp_2 + dF_damper_3_dp_2;
    out[6*n + 7] = alpha_transducer_2/C;
    out[6*n + 9] = V_capacitor_2*dalpha_transducer_2_dS_2;
    out[6*n + 10] = k;
    out[6*n + 11] = dF_damper_3_dp_3;
    out[6*n + 12] = -alpha_transducer_3/C;
    out[6*n + 14] = -V_capacitor_3*dalpha_transducer_3_dS_3;
    out[7*n + 1] = alpha_transducer_2/M;
    out[7*n + 6] = -alpha_transducer_2/M;
    out[7*n + 8] = 1.0/L;
    out[7*n + 9] = (v_mass_1 - v_mass_2)*dalpha_transducer_2_dS_2;
    out[8*n + 7] = -1.0/C;
    out[8*n + 8] = -dV_hysteron_2_dphi_2;
    out[8*n + 9] = -dV_hysteron_2_dS_2;
    out[9*n + 1] = dheat_damper_2_dp_1/T_body_2;
    out[9*n + 4] = dheat_contact_1_dS_1/T_body_2;
    out[9*n + 6] = dheat_damper_2_dp_2/T_body_2;
    out[9*n + 8] = dheat_hysteron_2_dphi_2/T_body_2;
    out[9*n + 9] = dheat_hysteron_2_dS_2/T_body_2
        + dheat_contact_1_dS_2/T_body_2
        - (heat_hysteron_2 + heat_damper_2 + heat_contact_1)/power_2(T_body_2)*dT_body_2_minus_T_0_dS_2
        - ds_contact_2_dS_2;
    out[9*n + 14] = -ds_contact_2_dS_3;
    out[10*n + 6] = -1.0/M;
    out[10*n + 11] = 1.0/M;
    out[11*n + 6] = -dF_damper_3_dp_2;
    out[11*n + 10] = -k;
    out[11*n + 11] = -dF_damper_3_dp_3;
    out[11*n + 12] = alpha_transducer_3/C;
    out[11*n + 14] = V_capacitor_3*dalpha_transducer_3_dS_3;
    out[12*n + 6] = alpha_transducer_3/M;
    out[12*n + 11] = -alpha_transducer_3/M;
    out[12*n + 13] = 1.0/L;
    out[12*n + 14] = (v_mass_2 - v_mass_3)*dalpha_transducer_3_dS_3;
    out[13*n + 12] = -1.0/C;
    out[13*n + 13] = -dV_hysteron_3_dphi_3;
    out[13*n + 14] = -dV_hysteron_3_dS_3;
    out[14*n + 6] = dheat_damper_3_dp_2/T_body_3;
    out[14*n + 9] = dheat_contact_2_dS_2/T_body_3;
    out[14*n + 11] = dheat_damper_3_dp_3/T_body_3;
    out[14*n + 13] = dheat_hysteron_3_dphi_3/T_body_3;
    out[14*n + 14] = dheat_hysteron_3_dS_3/T_body_3
        + dheat_contact_2_dS_3/T_body_3
        + (-(heat_hysteron_3 + heat_damper_3 + heat_contact_2)/power_2(T_body_3) - lam*T_e/power_2(T_body_3))*dT_body_3_minus_T_0_dS_3;
}

/* Margin by which each condition of the domain holds; of a bank, the least one. */
void layered_stack_margins(const double *restrict x,
                           const double *restrict u,
                           const layered_stack_parameters *restrict p,
                           double *restrict out)
{
    const double M = p->M;
    const double k = p->k;
    const double d = p->d;
    const double C = p->C;
    const double L = p->L;
    const double rho = p->rho;
    const double i_0 = p->i_0;
    const double T_0 = p->T_0;
    const double c_0 = p->c_0;
    const double lam = p->lam;
    const double lam_l = p->lam_l;
    const double S_1 = x[4];
    const double S_2 = x[9];
    const double S_3 = x[14];
    const double T_e = u[2];
    /* co-states dU/dx */
    const double T_body_1_minus_T_0 = T_0*expm1(S_1/c_0);
    const double T_body_2_minus_T_0 = T_0*expm1(S_2/c_0);
    const double T_body_3_minus_T_0 = T_0*expm1(S_3/c_0);
    /* result */
    out[0] = T_body_1_minus_T_0;
    out[1] = T_body_2_minus_T_0;
    out[2] = T_body_3_minus_T_0;
    out[3] = T_e - T_0;
    out[4] = d;
    out[5] = rho;
    out[6] = i_0;
    out[7] = lam;
    out[8] = lam_l;
    out[9] = k;
    out[10] = M;
    out[11] = C;
    out[12] = L;
    out[13] = T_0;
    out[14] = c_0;
}
