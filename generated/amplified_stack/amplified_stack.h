/*
 * Piezoelectric stack with a lever, a load and an end stop: irreversible port-Hamiltonian system.
 *
 * Source:  Scire, Teague (1978), Rev. Sci. Instrum. 49 (12), 1735-1740 (levers); Hunt, Crossley (1975), J. Appl. Mech. 42 (2), 440-445 (end stop); PiezoDrive SA050536
 * Model:   amplified_stack, spec sha256 f97db543e4f43ea0e60de47bf6de8bd925540145e93c475ce6262cae7eb13898
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, welldef, energy, entropy, passive, odd, continuous, sigma, exergy, environment, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (Q, q, p, x, x_e, S)
 * u = (F, V, T_e)
 * p_ = pointer to amplified_stack_parameters; the underscore tells it from p, a name of the model
 */
#ifndef PIEZO_SYM_amplified_stack_H
#define PIEZO_SYM_amplified_stack_H

#ifdef __cplusplus
extern "C" {
#endif

/* Parameters in SI units. The caller sets all; comments show the values of the spec. */
typedef struct {
    double k; /* stiffness of the stack [N/m]; spec: 28000000.0 */
    double m_s; /* moving mass of the stack, 4/pi^2 of it [kg]; spec: 0.0029 */
    double a; /* transducer ratio, 28 N/um times 56 um over 180 V [C/m]; spec: 8.7 */
    double C; /* capacitance of the clamped stack: 4.3 uF less a^2/k [F]; spec: 1.6e-06 */
    double R; /* resistance of the amplifier and leads [ohm]; spec: 10.0 */
    double n; /* lever: way of the load over that of the stack [1]; spec: 8.0 */
    double m; /* mass of the load [kg]; spec: 0.02 */
    double k_l; /* stiffness against which it moves, that of the flexures included [N/m]; spec: 100000.0 */
    double d; /* damping, a quality of about 30 [N*s/m]; spec: 3.5 */
    double g; /* way to the end stop [m]; spec: 0.00025 */
    double k_e; /* stiffness of the end stop [N/m]; spec: 10000000.0 */
    double d_e; /* damping of the end stop over its indentation [N*s/m**2]; spec: 5000000.0 */
    double T_0; /* temperature at the start [K]; spec: 293.15 */
    double c_0; /* heat capacity, 7.1 g of 370 J/(kg K) [J/K]; spec: 2.6 */
    double lam; /* heat conductance to the air [W/K]; spec: 0.02 */
} amplified_stack_parameters;

/* An initializer for parameters: the values of the spec. */
#define amplified_stack_DEFAULTS { \
    .k = 28000000.0, \
    .m_s = 0.0029, \
    .a = 8.7, \
    .C = 1.6e-06, \
    .R = 10.0, \
    .n = 8.0, \
    .m = 0.02, \
    .k_l = 100000.0, \
    .d = 3.5, \
    .g = 0.00025, \
    .k_e = 10000000.0, \
    .d_e = 5000000.0, \
    .T_0 = 293.15, \
    .c_0 = 2.6, \
    .lam = 0.02, \
}

/* Numbers of inputs, outputs, thermal bodies and conditions of the domain. */
enum {
    amplified_stack_input_count = 3,
    amplified_stack_output_count = 3,
    amplified_stack_body_count = 1,
    amplified_stack_condition_count = 14,
};

/*
 * Number of states n.
 */
long amplified_stack_states(const amplified_stack_parameters *p_);

/*
 * Number of processes, which produce entropy; of a bank, one per lane.
 */
long amplified_stack_processes(const amplified_stack_parameters *p_);

/*
 * State at t = 0 [SI], for the inputs u at t = 0.
 * u[amplified_stack_input_count], read: F [N], V [V], T_e [K]
 * out[n], written; must not overlap another argument: Q [C], q [m], p [kg*m/s], x [m], x_e
 *     [m], S [J/K]
 */
void amplified_stack_initial_state(const double *u,
                                   const amplified_stack_parameters *p_,
                                   double *out);

/*
 * Rates dx/dt, the rows of J_ir dU/dx + g u.
 * x_[n], read: Q [C], q [m], p [kg*m/s], x [m], x_e [m], S [J/K]
 * u[amplified_stack_input_count], read: F [N], V [V], T_e [K]
 * out[n], written; must not overlap another argument
 */
void amplified_stack_rhs(const double *x_,
                         const double *u,
                         const amplified_stack_parameters *p_,
                         double *out);

/*
 * Jacobian of rhs, n x n, row after row: d rhs[i]/d x[j] at out[i*n + j].
 * x_[n], read: Q [C], q [m], p [kg*m/s], x [m], x_e [m], S [J/K]
 * u[amplified_stack_input_count], read: F [N], V [V], T_e [K]
 * out[n*n], written; must not overlap another argument
 */
void amplified_stack_jacobian(const double *x_,
                              const double *u,
                              const amplified_stack_parameters *p_,
                              double *out);

/*
 * Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient.
 * x_[n], read: Q [C], q [m], p [kg*m/s], x [m], x_e [m], S [J/K]
 * u[amplified_stack_input_count], read: F [N], V [V], T_e [K]
 * out[amplified_stack_output_count], written; must not overlap another argument: push [m/s],
 *     amplifier [A], air [K]
 */
void amplified_stack_outputs(const double *x_,
                             const double *u,
                             const amplified_stack_parameters *p_,
                             double *out);

/*
 * Power supplied through each port [W]; the sum is dU/dt.
 * x_[n], read: Q [C], q [m], p [kg*m/s], x [m], x_e [m], S [J/K]
 * u[amplified_stack_input_count], read: F [N], V [V], T_e [K]
 * out[amplified_stack_output_count], written; must not overlap another argument
 */
void amplified_stack_supply(const double *x_,
                            const double *u,
                            const amplified_stack_parameters *p_,
                            double *out);

/*
 * Hamiltonian U [J].
 * x_[n], read: Q [C], q [m], p [kg*m/s], x [m], x_e [m], S [J/K]
 */
double amplified_stack_energy(const double *x_, const amplified_stack_parameters *p_);

/*
 * Total entropy S [J/K].
 * x_[n], read: Q [C], q [m], p [kg*m/s], x [m], x_e [m], S [J/K]
 */
double amplified_stack_entropy(const double *x_, const amplified_stack_parameters *p_);

/*
 * Temperature of each body [K].
 * x_[n], read: Q [C], q [m], p [kg*m/s], x [m], x_e [m], S [J/K]
 * out[amplified_stack_body_count], written; must not overlap another argument: body [K]
 */
void amplified_stack_temperatures(const double *x_,
                                  const amplified_stack_parameters *p_,
                                  double *out);

/*
 * Power that each process turns into heat [W]; of a bank, one row per lane.
 * x_[n], read: Q [C], q [m], p [kg*m/s], x [m], x_e [m], S [J/K]
 * u[amplified_stack_input_count], read: F [N], V [V], T_e [K]
 * out[amplified_stack_processes(p_)], written; must not overlap another argument
 */
void amplified_stack_heat(const double *x_,
                          const double *u,
                          const amplified_stack_parameters *p_,
                          double *out);

/*
 * Entropy production of each process [W/K], heat exchange with ambients not included; of a
 *     bank, one row per lane.
 * x_[n], read: Q [C], q [m], p [kg*m/s], x [m], x_e [m], S [J/K]
 * u[amplified_stack_input_count], read: F [N], V [V], T_e [K]
 * out[amplified_stack_processes(p_)], written; must not overlap another argument
 */
void amplified_stack_entropy_production(const double *x_,
                                        const double *u,
                                        const amplified_stack_parameters *p_,
                                        double *out);

/*
 * Effort, flow, power, energy and heat of elements; of a bank, one row per lane.
 * x_[n], read: Q [C], q [m], p [kg*m/s], x [m], x_e [m], S [J/K]
 * u[amplified_stack_input_count], read: F [N], V [V], T_e [K]
 * out[59], written; must not overlap another argument: amplifier.effort [V], amplifier.flow
 *     [A], amplifier.power [W], leads.effort [V], leads.flow [A], leads.power [W], leads.heat
 *     [W], clamped.effort [V], clamped.flow [A], clamped.power [W], clamped.energy [J],
 *     ceramic.effort_1 [V], ceramic.flow_1 [A], ceramic.effort_2 [N], ceramic.flow_2 [m/s],
 *     ceramic.power [W], stack.effort [N], stack.flow [m/s], stack.power [W], stack.energy
 *     [J], load.effort [N], load.flow [m/s], load.power [W], load.energy [J], end.effort [N],
 *     end.flow [m/s], end.power [W], end.energy [J], lever.effort_1 [N], lever.flow_1 [m/s],
 *     lever.effort_2 [N], lever.flow_2 [m/s], lever.power [W], spring.effort [N], spring.flow
 *     [m/s], spring.power [W], spring.energy [J], losses.effort [N], losses.flow [m/s],
 *     losses.power [W], losses.heat [W], end_stop.effort [N], end_stop.flow [m/s],
 *     end_stop.power [W], end_stop.energy [J], bumper.effort [N], bumper.flow [m/s],
 *     bumper.power [W], bumper.heat [W], push.effort [N], push.flow [m/s], push.power [W],
 *     body.effort [K], body.flow [W/K], body.power [W], body.energy [J], air.effort [K],
 *     air.flow [W/K], air.power [W]
 */
void amplified_stack_elements(const double *x_,
                              const double *u,
                              const amplified_stack_parameters *p_,
                              double *out);

/*
 * Margin by which each condition of the domain holds; of a bank, the least one.
 * x_[n], read: Q [C], q [m], p [kg*m/s], x [m], x_e [m], S [J/K]
 * u[amplified_stack_input_count], read: F [N], V [V], T_e [K]
 * out[amplified_stack_condition_count], written; must not overlap another argument
 * out[0] > 0 where n > 0
 * out[1] > 0 where R > 0
 * out[2] >= 0 where d >= 0
 * out[3] >= 0 where k_e >= 0
 * out[4] >= 0 where d_e >= 0
 * out[5] >= 0 where lam >= 0
 * out[6] > 0 where T_e > 0
 * out[7] > 0 where C > 0
 * out[8] > 0 where k > 0
 * out[9] > 0 where m > 0
 * out[10] > 0 where m_s > 0
 * out[11] > 0 where k_l > 0
 * out[12] > 0 where T_0 > 0
 * out[13] > 0 where c_0 > 0
 */
void amplified_stack_margins(const double *x_,
                             const double *u,
                             const amplified_stack_parameters *p_,
                             double *out);

#ifdef __cplusplus
}
#endif

#endif /* PIEZO_SYM_amplified_stack_H */
