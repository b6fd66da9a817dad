/*
 * Piezoelectric bender: two layers in opposition on one beam: irreversible port-Hamiltonian system.
 *
 * Source:  Smits, Dalke, Cooney (1991), Sensors and Actuators A 28, 41-61; PiezoDrive BA6020
 * Model:   bimorph, spec sha256 e1bdc157e28404f3e3f2a5e6ecbc555574e7dfbd87761b8afc1f5ffdda416572
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, welldef, energy, entropy, passive, odd, sigma, exergy, environment, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (x, p, S, Q_u, Q_l)
 * u = (F, V_b, V, T_e)
 * p_ = pointer to bimorph_parameters; the underscore tells it from p, a name of the model
 */
#include "bimorph.h"

#include <math.h>

static double power_2(double z)
{
    return z*z;
}

static double power_3(double z)
{
    return z*z*z;
}

/* Number of states n. */
long bimorph_states(const bimorph_parameters *restrict p_)
{
    (void)p_;
    return 5;
}

/* Number of processes, which produce entropy; of a bank, one per lane. */
long bimorph_processes(const bimorph_parameters *restrict p_)
{
    (void)p_;
    return 3;
}

/* State at t = 0 [SI], for the inputs u at t = 0. */
void bimorph_initial_state(const double *restrict u,
                           const bimorph_parameters *restrict p_,
                           double *restrict out)
{
    const double l = p_->l;
    const double w = p_->w;
    const double h = p_->h;
    const double s = p_->s;
    const double d = p_->d;
    const double eps = p_->eps;
    const double F = u[0];
    const double V_b = u[1];
    const double V = u[2];
    out[0] = 3.0*d*power_2(l)*(V_b - 2.0*V)/(8.0*power_2(h))
        + s*power_3(l)*F/(2.0*w*power_3(h));
    out[1] = 0.0;
    out[2] = 0.0;
    out[3] = w*l/h*(eps*(V_b - V) - 13.0*power_2(d)/(32.0*s)*(V_b - 2.0*V));
    out[4] = w*l/h*(eps*V + 13.0*power_2(d)/(32.0*s)*(V_b - 2.0*V));
}

/* Rates dx/dt, the rows of J_ir dU/dx + g u. */
void bimorph_rhs(const double *restrict x_,
                 const double *restrict u,
                 const bimorph_parameters *restrict p_,
                 double *restrict out)
{
    const double l = p_->l;
    const double w = p_->w;
    const double h = p_->h;
    const double s = p_->s;
    const double d = p_->d;
    const double eps = p_->eps;
    const double m = p_->m;
    const double b = p_->b;
    const double R = p_->R;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double lam = p_->lam;
    const double x = x_[0];
    const double p = x_[1];
    const double S = x_[2];
    const double Q_u = x_[3];
    const double Q_l = x_[4];
    const double F = u[0];
    const double V_b = u[1];
    const double V = u[2];
    const double T_e = u[3];
    /* co-states dU/dx */
    const double F_bending = 2.0*w*power_3(h)/(s*power_3(l))*x;
    const double v_tip = p/m;
    const double T = T_0*exp(S/c_0);
    const double V_Q_u = h/(4.0*w*l)*(2.0*(Q_u + Q_l)/eps + 2.0*(Q_u - Q_l)/(eps - 13.0*power_2(d)/(16.0*s)));
    const double V_Q_l = h/(4.0*w*l)*(2.0*(Q_u + Q_l)/eps - 2.0*(Q_u - Q_l)/(eps - 13.0*power_2(d)/(16.0*s)));
    /* transducer ratios */
    const double alpha_upper = 3.0*w*h*d/(4.0*s*l);
    const double alpha_lower = 3.0*w*h*d/(4.0*s*l);
    /* driving forces */
    const double V_output = -V_Q_u - V_Q_l + V_b;
    /* dissipative laws */
    const double i_output = V_output/R;
    /* driving forces */
    const double V_input = -V_Q_l + V;
    /* dissipative laws */
    const double i_input = V_input/R;
    const double F_losses = b*v_tip;
    /* heats */
    const double heat_output = i_output*V_output;
    const double heat_input = i_input*V_input;
    const double heat_losses = F_losses*v_tip;
    /* result */
    out[0] = v_tip;
    out[1] = alpha_upper*V_Q_u - F_bending - alpha_lower*V_Q_l - F_losses + F;
    out[2] = (heat_output + heat_input + heat_losses)/T + lam*(T_e/T - 1.0);
    out[3] = i_output - alpha_upper*v_tip;
    out[4] = alpha_lower*v_tip + i_output + i_input;
}

/* Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient. */
void bimorph_outputs(const double *restrict x_,
                     const double *restrict u,
                     const bimorph_parameters *restrict p_,
                     double *restrict out)
{
    const double l = p_->l;
    const double w = p_->w;
    const double h = p_->h;
    const double s = p_->s;
    const double d = p_->d;
    const double eps = p_->eps;
    const double m = p_->m;
    const double R = p_->R;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double p = x_[1];
    const double S = x_[2];
    const double Q_u = x_[3];
    const double Q_l = x_[4];
    const double V_b = u[1];
    const double V = u[2];
    /* co-states dU/dx */
    const double v_tip = p/m;
    const double T = T_0*exp(S/c_0);
    const double V_Q_u = h/(4.0*w*l)*(2.0*(Q_u + Q_l)/eps + 2.0*(Q_u - Q_l)/(eps - 13.0*power_2(d)/(16.0*s)));
    const double V_Q_l = h/(4.0*w*l)*(2.0*(Q_u + Q_l)/eps - 2.0*(Q_u - Q_l)/(eps - 13.0*power_2(d)/(16.0*s)));
    /* driving forces */
    const double V_output = -V_Q_u - V_Q_l + V_b;
    /* dissipative laws */
    const double i_output = V_output/R;
    /* driving forces */
    const double V_input = -V_Q_l + V;
    /* dissipative laws */
    const double i_input = V_input/R;
    /* result */
    out[0] = v_tip;
    out[1] = i_output;
    out[2] = i_input;
    out[3] = T;
}

/* Power supplied through each port [W]; the sum is dU/dt. */
void bimorph_supply(const double *restrict x_,
                    const double *restrict u,
                    const bimorph_parameters *restrict p_,
                    double *restrict out)
{
    const double l = p_->l;
    const double w = p_->w;
    const double h = p_->h;
    const double s = p_->s;
    const double d = p_->d;
    const double eps = p_->eps;
    const double m = p_->m;
    const double R = p_->R;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double lam = p_->lam;
    const double p = x_[1];
    const double S = x_[2];
    const double Q_u = x_[3];
    const double Q_l = x_[4];
    const double F = u[0];
    const double V_b = u[1];
    const double V = u[2];
    const double T_e = u[3];
    /* co-states dU/dx */
    const double v_tip = p/m;
    const double T = T_0*exp(S/c_0);
    const double V_Q_u = h/(4.0*w*l)*(2.0*(Q_u + Q_l)/eps + 2.0*(Q_u - Q_l)/(eps - 13.0*power_2(d)/(16.0*s)));
    const double V_Q_l = h/(4.0*w*l)*(2.0*(Q_u + Q_l)/eps - 2.0*(Q_u - Q_l)/(eps - 13.0*power_2(d)/(16.0*s)));
    /* driving forces */
    const double V_output = -V_Q_u - V_Q_l + V_b;
    /* dissipative laws */
    const double i_output = V_output/R;
    /* driving forces */
    const double V_input = -V_Q_l + V;
    /* dissipative laws */
    const double i_input = V_input/R;
    /* result */
    out[0] = v_tip*F;
    out[1] = i_output*V_b;
    out[2] = i_input*V;
    out[3] = lam*(T_e - T);
}

/* Hamiltonian U [J]. */
double bimorph_energy(const double *restrict x_, const bimorph_parameters *restrict p_)
{
    const double l = p_->l;
    const double w = p_->w;
    const double h = p_->h;
    const double s = p_->s;
    const double d = p_->d;
    const double eps = p_->eps;
    const double m = p_->m;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double x = x_[0];
    const double p = x_[1];
    const double S = x_[2];
    const double Q_u = x_[3];
    const double Q_l = x_[4];
    return 2.0*w*power_3(h)/(s*power_3(l))*power_2(x)/2.0
        + power_2(p)/(2.0*m)
        + T_0*c_0*exp(S/c_0)
        + h/(4.0*w*l)*(power_2(Q_u + Q_l)/eps + power_2(Q_u - Q_l)/(eps - 13.0*power_2(d)/(16.0*s)));
}

/* Total entropy S [J/K]. */
double bimorph_entropy(const double *restrict x_, const bimorph_parameters *restrict p_)
{
    (void)p_;
    const double S = x_[2];
    return S;
}

/* Temperature of each body [K]. */
void bimorph_temperatures(const double *restrict x_,
                          const bimorph_parameters *restrict p_,
                          double *restrict out)
{
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double S = x_[2];
    /* co-states dU/dx */
    const double T = T_0*exp(S/c_0);
    /* result */
    out[0] = T;
}

/* Power that each process turns into heat [W]; of a bank, one row per lane. */
void bimorph_heat(const double *restrict x_,
                  const double *restrict u,
                  const bimorph_parameters *restrict p_,
                  double *restrict out)
{
    const double l = p_->l;
    const double w = p_->w;
    const double h = p_->h;
    const double s = p_->s;
    const double d = p_->d;
    const double eps = p_->eps;
    const double m = p_->m;
    const double b = p_->b;
    const double R = p_->R;
    const double p = x_[1];
    const double Q_u = x_[3];
    const double Q_l = x_[4];
    const double V_b = u[1];
    const double V = u[2];
    /* co-states dU/dx */
    const double v_tip = p/m;
    const double V_Q_u = h/(4.0*w*l)*(2.0*(Q_u + Q_l)/eps + 2.0*(Q_u - Q_l)/(eps - 13.0*power_2(d)/(16.0*s)));
    const double V_Q_l = h/(4.0*w*l)*(2.0*(Q_u + Q_l)/eps - 2.0*(Q_u - Q_l)/(eps - 13.0*power_2(d)/(16.0*s)));
    /* driving forces */
    const double V_output = -V_Q_u - V_Q_l + V_b;
    /* dissipative laws */
    const double i_output = V_output/R;
    /* driving forces */
    const double V_input = -V_Q_l + V;
    /* dissipative laws */
    const double i_input = V_input/R;
    const double F_losses = b*v_tip;
    /* result */
    out[0] = i_output*V_output;
    out[1] = i_input*V_input;
    out[2] = F_losses*v_tip;
}

/*
 * Entropy production of each process [W/K], heat exchange with ambients not included; of a
 * bank, one row per lane.
 */
void bimorph_entropy_production(const double *restrict x_,
                                const double *restrict u,
                                const bimorph_parameters *restrict p_,
                                double *restrict out)
{
    const double l = p_->l;
    const double w = p_->w;
    const double h = p_->h;
    const double s = p_->s;
    const double d = p_->d;
    const double eps = p_->eps;
    const double m = p_->m;
    const double b = p_->b;
    const double R = p_->R;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double p = x_[1];
    const double S = x_[2];
    const double Q_u = x_[3];
    const double Q_l = x_[4];
    const double V_b = u[1];
    const double V = u[2];
    /* co-states dU/dx */
    const double v_tip = p/m;
    const double T = T_0*exp(S/c_0);
    const double V_Q_u = h/(4.0*w*l)*(2.0*(Q_u + Q_l)/eps + 2.0*(Q_u - Q_l)/(eps - 13.0*power_2(d)/(16.0*s)));
    const double V_Q_l = h/(4.0*w*l)*(2.0*(Q_u + Q_l)/eps - 2.0*(Q_u - Q_l)/(eps - 13.0*power_2(d)/(16.0*s)));
    /* driving forces */
    const double V_output = -V_Q_u - V_Q_l + V_b;
    /* dissipative laws */
    const double i_output = V_output/R;
    /* driving forces */
    const double V_input = -V_Q_l + V;
    /* dissipative laws */
    const double i_input = V_input/R;
    const double F_losses = b*v_tip;
    /* result */
    out[0] = i_output*V_output/T;
    out[1] = i_input*V_input/T;
    out[2] = F_losses*v_tip/T;
}

/* Effort, flow, power, energy and heat of elements; of a bank, one row per lane. */
void bimorph_elements(const double *restrict x_,
                      const double *restrict u,
                      const bimorph_parameters *restrict p_,
                      double *restrict out)
{
    const double l = p_->l;
    const double w = p_->w;
    const double h = p_->h;
    const double s = p_->s;
    const double d = p_->d;
    const double eps = p_->eps;
    const double m = p_->m;
    const double b = p_->b;
    const double R = p_->R;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double lam = p_->lam;
    const double x = x_[0];
    const double p = x_[1];
    const double S = x_[2];
    const double Q_u = x_[3];
    const double Q_l = x_[4];
    const double F = u[0];
    const double V_b = u[1];
    const double V = u[2];
    const double T_e = u[3];
    /* co-states dU/dx */
    const double F_bending = 2.0*w*power_3(h)/(s*power_3(l))*x;
    const double v_tip = p/m;
    const double T = T_0*exp(S/c_0);
    const double V_Q_u = h/(4.0*w*l)*(2.0*(Q_u + Q_l)/eps + 2.0*(Q_u - Q_l)/(eps - 13.0*power_2(d)/(16.0*s)));
    const double V_Q_l = h/(4.0*w*l)*(2.0*(Q_u + Q_l)/eps - 2.0*(Q_u - Q_l)/(eps - 13.0*power_2(d)/(16.0*s)));
    /* transducer ratios */
    const double alpha_upper = 3.0*w*h*d/(4.0*s*l);
    const double alpha_lower = 3.0*w*h*d/(4.0*s*l);
    /* driving forces */
    const double V_output = -V_Q_u - V_Q_l + V_b;
    /* dissipative laws */
    const double i_output = V_output/R;
    /* driving forces */
    const double V_input = -V_Q_l + V;
    /* dissipative laws */
    const double i_input = V_input/R;
    const double F_losses = b*v_tip;
    /* heats */
    const double heat_output = i_output*V_output;
    const double heat_input = i_input*V_input;
    const double heat_losses = F_losses*v_tip;
    /* rates */
    const double rate_p = alpha_upper*V_Q_u - F_bending - alpha_lower*V_Q_l - F_losses + F;
    const double rate_S = (heat_output + heat_input + heat_losses)/T + lam*(T_e/T - 1.0);
    const double rate_Q_u = i_output - alpha_upper*v_tip;
    const double rate_Q_l = alpha_lower*v_tip + i_output + i_input;
    /* result */
    out[0] = V_b;
    out[1] = -i_output;
    out[2] = -i_output*V_b;
    out[3] = V;
    out[4] = -i_input;
    out[5] = -i_input*V;
    out[6] = V_output;
    out[7] = i_output;
    out[8] = i_output*V_output;
    out[9] = i_output*V_output;
    out[10] = V_input;
    out[11] = i_input;
    out[12] = i_input*V_input;
    out[13] = i_input*V_input;
    out[14] = V_Q_u;
    out[15] = alpha_upper*v_tip;
    out[16] = -alpha_upper*V_Q_u;
    out[17] = v_tip;
    out[18] = V_Q_u*alpha_upper*v_tip;
    out[19] = V_Q_l;
    out[20] = -alpha_lower*v_tip;
    out[21] = -alpha_lower*V_Q_l;
    out[22] = -v_tip;
    out[23] = -V_Q_l*alpha_lower*v_tip;
    out[24] = F_bending;
    out[25] = v_tip;
    out[26] = F_bending*v_tip;
    out[27] = 2.0*w*power_3(h)/(s*power_3(l))*power_2(x)/2.0;
    out[28] = rate_p;
    out[29] = v_tip;
    out[30] = rate_p*v_tip;
    out[31] = power_2(p)/(2.0*m);
    out[32] = F_losses;
    out[33] = v_tip;
    out[34] = F_losses*v_tip;
    out[35] = F_losses*v_tip;
    out[36] = -F;
    out[37] = v_tip;
    out[38] = -v_tip*F;
    out[39] = T;
    out[40] = rate_S;
    out[41] = T*rate_S;
    out[42] = T_0*c_0*exp(S/c_0);
    out[43] = T;
    out[44] = -lam*(T_e/T - 1.0);
    out[45] = -lam*(T_e - T);
    out[46] = V_Q_u;
    out[47] = rate_Q_u;
    out[48] = V_Q_l;
    out[49] = rate_Q_l;
    out[50] = V_Q_u*rate_Q_u + V_Q_l*rate_Q_l;
    out[51] = h/(4.0*w*l)*(power_2(Q_u + Q_l)/eps + power_2(Q_u - Q_l)/(eps - 13.0*power_2(d)/(16.0*s)));
}

/* Jacobian of rhs, n x n, row after row: d rhs[i]/d x[j] at out[i*n + j]. */
void bimorph_jacobian(const double *restrict x_,
                      const double *restrict u,
                      const bimorph_parameters *restrict p_,
                      double *restrict out)
{
    const long n = 5;
    const double l = p_->l;
    const double w = p_->w;
    const double h = p_->h;
    const double s = p_->s;
    const double d = p_->d;
    const double eps = p_->eps;
    const double m = p_->m;
    const double b = p_->b;
    const double R = p_->R;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double lam = p_->lam;
    const double p = x_[1];
    const double S = x_[2];
    const double Q_u = x_[3];
    const double Q_l = x_[4];
    const double V_b = u[1];
    const double V = u[2];
    const double T_e = u[3];
    for (long j = 0; j < n*n; ++j) {
        out[j] = 0.0;
    }
    /* co-states dU/dx */
    const double v_tip = p/m;
    const double T = T_0*exp(S/c_0);
    const double V_Q_u = h/(4.0*w*l)*(2.0*(Q_u + Q_l)/eps + 2.0*(Q_u - Q_l)/(eps - 13.0*power_2(d)/(16.0*s)));
    const double V_Q_l = h/(4.0*w*l)*(2.0*(Q_u + Q_l)/eps - 2.0*(Q_u - Q_l)/(eps - 13.0*power_2(d)/(16.0*s)));
    /* transducer ratios */
    const double alpha_upper = 3.0*w*h*d/(4.0*s*l);
    const double alpha_lower = 3.0*w*h*d/(4.0*s*l);
    /* driving forces */
    const double V_output = -V_Q_u - V_Q_l + V_b;
    /* dissipative laws */
    const double i_output = V_output/R;
    /* driving forces */
    const double V_input = -V_Q_l + V;
    /* dissipative laws */
    const double i_input = V_input/R;
    const double F_losses = b*v_tip;
    /* heats */
    const double heat_output = i_output*V_output;
    const double heat_input = i_input*V_input;
    const double heat_losses = F_losses*v_tip;
    /* derivatives */
    const double dF_bending_dx = 2.0*w*power_3(h)/(s*power_3(l));
    const double dF_losses_dp = b/m;
    const double dheat_losses_dp = v_tip*dF_losses_dp + F_losses/m;
    const double dT_dS = T/c_0;
    const double dV_Q_u_dQ_u = h/(4.0*w*l)*(2.0/eps + 2.0/(eps - 13.0*power_2(d)/(16.0*s)));
    const double dV_Q_l_dQ_u = h/(4.0*w*l)*(2.0/eps - 2.0/(eps - 13.0*power_2(d)/(16.0*s)));
    const double dV_output_dQ_u = -dV_Q_u_dQ_u - dV_Q_l_dQ_u;
    const double di_output_dQ_u = dV_output_dQ_u/R;
    const double di_input_dQ_u = -dV_Q_l_dQ_u/R;
    const double dheat_output_dQ_u = V_output*di_output_dQ_u + i_output*dV_output_dQ_u;
    const double dheat_input_dQ_u = V_input*di_input_dQ_u - i_input*dV_Q_l_dQ_u;
    const double dV_Q_u_dQ_l = h/(4.0*w*l)*(2.0/eps + (-2.0)/(eps - 13.0*power_2(d)/(16.0*s)));
    const double dV_Q_l_dQ_l = h/(4.0*w*l)*(2.0/eps - (-2.0)/(eps - 13.0*power_2(d)/(16.0*s)));
    const double dV_output_dQ_l = -dV_Q_u_dQ_l - dV_Q_l_dQ_l;
    const double di_output_dQ_l = dV_output_dQ_l/R;
    const double di_input_dQ_l = -dV_Q_l_dQ_l/R;
    const double dheat_output_dQ_l = V_output*di_output_dQ_l + i_output*dV_output_dQ_l;
    const double dheat_input_dQ_l = V_input*di_input_dQ_l - i_input*dV_Q_l_dQ_l;
    /* result */
    out[1] = 1.0/m;
    out[n + 0] = -dF_bending_dx;
    out[n + 1] = -dF_losses_dp;
    out[n + 3] = alpha_upper*dV_Q_u_dQ_u - alpha_lower*dV_Q_l_dQ_u;
    out[n + 4] = alpha_upper*dV_Q_u_dQ_l - alpha_lower*dV_Q_l_dQ_l;
    out[2*n + 1] = dheat_losses_dp/T;
    out[2*n + 2] = (-(heat_output + heat_input + heat_losses)/power_2(T) - lam*T_e/power_2(T))*dT_dS;
    out[2*n + 3] = dheat_output_dQ_u/T + dheat_input_dQ_u/T;
    out[2*n + 4] = dheat_output_dQ_l/T + dheat_input_dQ_l/T;
    out[3*n + 1] = -alpha_upper/m;
    out[3*n + 3] = di_output_dQ_u;
    out[3*n + 4] = di_output_dQ_l;
    out[4*n + 1] = alpha_lower/m;
    out[4*n + 3] = di_output_dQ_u + di_input_dQ_u;
    out[4*n + 4] = di_output_dQ_l + di_input_dQ_l;
}

/* Margin by which each condition of the domain holds; of a bank, the least one. */
void bimorph_margins(const double *restrict x_,
                     const double *restrict u,
                     const bimorph_parameters *restrict p_,
                     double *restrict out)
{
    (void)x_;
    const double l = p_->l;
    const double w = p_->w;
    const double h = p_->h;
    const double s = p_->s;
    const double d = p_->d;
    const double eps = p_->eps;
    const double m = p_->m;
    const double b = p_->b;
    const double R = p_->R;
    const double T_0 = p_->T_0;
    const double c_0 = p_->c_0;
    const double lam = p_->lam;
    const double T_e = u[3];
    out[0] = l;
    out[1] = w;
    out[2] = h;
    out[3] = s;
    out[4] = 16.0*s*eps - 13.0*power_2(d);
    out[5] = b;
    out[6] = R;
    out[7] = lam;
    out[8] = T_e;
    out[9] = 2.0*w*power_3(h)/(s*power_3(l));
    out[10] = m;
    out[11] = T_0;
    out[12] = c_0;
}
