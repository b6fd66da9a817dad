/*
 * Piezoelectric stack actuator with hysterons: irreversible port-Hamiltonian system.
 *
 * Source:  Caballeria, Ramirez, Le Gorrec (2021), eqs. (9)-(13), Table 1
 * Model:   piezo_stack, spec sha256 9c0235a60e02072bc451611ffa723f273272c8e4536a3089081866f47c89389c
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, energy, entropy, welldef, continuous, passive, odd, sigma, exergy, environment, invariant, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (q, p, Q_C, phi_1 ... phi_hysteron_count, S)
 * u = (F_ext, V_in, T_e)
 * p_ = pointer to piezo_stack_parameters; the underscore tells it from p, a name of the model
 * bank hysteron: lanes j = 1 ... hysteron_count
 */
#ifndef PIEZO_SYM_piezo_stack_H
#define PIEZO_SYM_piezo_stack_H

#ifdef __cplusplus
extern "C" {
#endif

/* Parameters in SI units. The caller sets all; comments show the values of the spec. */
typedef struct {
    double M; /* moving mass [kg]; spec: 0.0035 */
    double k; /* stiffness [N/m]; spec: 500000.0 */
    double q_l; /* rest position of the spring [m]; spec: 0.0 */
    double d; /* damping [N*s/m]; spec: 400.0 */
    double C; /* capacitance [F]; spec: 5e-06 */
    const double *L; /* inductance of one hysteron [H], one per lane of hysteron; spec: 0.001 */
    const double *rho; /* resistance law: slope rho/(T - T_0) [ohm*K], one per lane of hysteron; spec: 10.0 */
    const double *i_0; /* half width of the dead zone [A], one per lane of hysteron; spec: 0.5 */
    double a; /* transducer ratio at T_0 [C/m]; spec: 10.0 */
    double T_0; /* reference temperature [K]; spec: 296.15 */
    double c_0; /* heat capacity [J/K]; spec: 5.0 */
    double lam; /* heat conductance to the environment [W/K]; spec: 2.0 */
    long hysteron_count; /* lanes of hysteron, at least 1; spec: 2 */
} piezo_stack_parameters;

/* An initializer for parameters: the values of the spec; change a count together with its arrays. */
#define piezo_stack_DEFAULTS { \
    .M = 0.0035, \
    .k = 500000.0, \
    .q_l = 0.0, \
    .d = 400.0, \
    .C = 5e-06, \
    .L = (const double[]){0.001, 0.001}, \
    .rho = (const double[]){10.0, 10.0}, \
    .i_0 = (const double[]){0.5, 0.5}, \
    .a = 10.0, \
    .T_0 = 296.15, \
    .c_0 = 5.0, \
    .lam = 2.0, \
    .hysteron_count = 2, \
}

/* Numbers of inputs, outputs, thermal bodies and conditions of the domain. */
enum {
    piezo_stack_input_count = 3,
    piezo_stack_output_count = 3,
    piezo_stack_body_count = 1,
    piezo_stack_condition_count = 12,
};

/*
 * Number of states n.
 */
long piezo_stack_states(const piezo_stack_parameters *p_);

/*
 * Number of processes, which produce entropy; of a bank, one per lane.
 */
long piezo_stack_processes(const piezo_stack_parameters *p_);

/*
 * State at t = 0 [SI], for the inputs u at t = 0.
 * u[piezo_stack_input_count], read: F_ext [N], V_in [V], T_e [K]
 * out[n], written; must not overlap another argument: q [m], p [kg*m/s], Q_C [C], phi_1 ...
 *     phi_hysteron_count [Wb], S [J/K]
 */
void piezo_stack_initial_state(const double *u, const piezo_stack_parameters *p_, double *out);

/*
 * Rates dx/dt, the rows of J_ir dU/dx + g u.
 * x[n], read: q [m], p [kg*m/s], Q_C [C], phi_1 ... phi_hysteron_count [Wb], S [J/K]
 * u[piezo_stack_input_count], read: F_ext [N], V_in [V], T_e [K]
 * out[n], written; must not overlap another argument
 */
void piezo_stack_rhs(const double *x,
                     const double *u,
                     const piezo_stack_parameters *p_,
                     double *out);

/*
 * Jacobian of rhs, n x n, row after row: d rhs[i]/d x[j] at out[i*n + j].
 * x[n], read: q [m], p [kg*m/s], Q_C [C], phi_1 ... phi_hysteron_count [Wb], S [J/K]
 * u[piezo_stack_input_count], read: F_ext [N], V_in [V], T_e [K]
 * out[n*n], written; must not overlap another argument
 */
void piezo_stack_jacobian(const double *x,
                          const double *u,
                          const piezo_stack_parameters *p_,
                          double *out);

/*
 * Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient.
 * x[n], read: q [m], p [kg*m/s], Q_C [C], phi_1 ... phi_hysteron_count [Wb], S [J/K]
 * u[piezo_stack_input_count], read: F_ext [N], V_in [V], T_e [K]
 * out[piezo_stack_output_count], written; must not overlap another argument: load [m/s],
 *     supply [A], ambient [K]
 */
void piezo_stack_outputs(const double *x,
                         const double *u,
                         const piezo_stack_parameters *p_,
                         double *out);

/*
 * Power supplied through each port [W]; the sum is dU/dt.
 * x[n], read: q [m], p [kg*m/s], Q_C [C], phi_1 ... phi_hysteron_count [Wb], S [J/K]
 * u[piezo_stack_input_count], read: F_ext [N], V_in [V], T_e [K]
 * out[piezo_stack_output_count], written; must not overlap another argument
 */
void piezo_stack_supply(const double *x,
                        const double *u,
                        const piezo_stack_parameters *p_,
                        double *out);

/*
 * Hamiltonian U [J].
 * x[n], read: q [m], p [kg*m/s], Q_C [C], phi_1 ... phi_hysteron_count [Wb], S [J/K]
 */
double piezo_stack_energy(const double *x, const piezo_stack_parameters *p_);

/*
 * Total entropy S [J/K].
 * x[n], read: q [m], p [kg*m/s], Q_C [C], phi_1 ... phi_hysteron_count [Wb], S [J/K]
 */
double piezo_stack_entropy(const double *x, const piezo_stack_parameters *p_);

/*
 * Temperature of each body [K].
 * x[n], read: q [m], p [kg*m/s], Q_C [C], phi_1 ... phi_hysteron_count [Wb], S [J/K]
 * out[piezo_stack_body_count], written; must not overlap another argument: body [K]
 */
void piezo_stack_temperatures(const double *x, const piezo_stack_parameters *p_, double *out);

/*
 * Power that each process turns into heat [W]; of a bank, one row per lane.
 * x[n], read: q [m], p [kg*m/s], Q_C [C], phi_1 ... phi_hysteron_count [Wb], S [J/K]
 * u[piezo_stack_input_count], read: F_ext [N], V_in [V], T_e [K]
 * out[piezo_stack_processes(p_)], written; must not overlap another argument
 */
void piezo_stack_heat(const double *x,
                      const double *u,
                      const piezo_stack_parameters *p_,
                      double *out);

/*
 * Entropy production of each process [W/K], heat exchange with ambients not included; of a
 *     bank, one row per lane.
 * x[n], read: q [m], p [kg*m/s], Q_C [C], phi_1 ... phi_hysteron_count [Wb], S [J/K]
 * u[piezo_stack_input_count], read: F_ext [N], V_in [V], T_e [K]
 * out[piezo_stack_processes(p_)], written; must not overlap another argument
 */
void piezo_stack_entropy_production(const double *x,
                                    const double *u,
                                    const piezo_stack_parameters *p_,
                                    double *out);

/*
 * Effort, flow, power, energy and heat of elements; of a bank, one row per lane.
 * x[n], read: q [m], p [kg*m/s], Q_C [C], phi_1 ... phi_hysteron_count [Wb], S [J/K]
 * u[piezo_stack_input_count], read: F_ext [N], V_in [V], T_e [K]
 * out[34 + 5*hysteron_count], written; must not overlap another argument: spring.effort [N],
 *     spring.flow [m/s], spring.power [W], spring.energy [J], mass.effort [N], mass.flow
 *     [m/s], mass.power [W], mass.energy [J], capacitor.effort [V], capacitor.flow [A],
 *     capacitor.power [W], capacitor.energy [J], hysteron.effort_1 ...
 *     hysteron.effort_hysteron_count [V], hysteron.flow_1 ... hysteron.flow_hysteron_count
 *     [A], hysteron.power_1 ... hysteron.power_hysteron_count [W], hysteron.energy_1 ...
 *     hysteron.energy_hysteron_count [J], hysteron.heat_1 ... hysteron.heat_hysteron_count
 *     [W], damper.effort [N], damper.flow [m/s], damper.power [W], damper.heat [W],
 *     transducer.effort_1 [V], transducer.flow_1 [A], transducer.effort_2 [N],
 *     transducer.flow_2 [m/s], transducer.power [W], body.effort [K], body.flow [W/K],
 *     body.power [W], body.energy [J], ambient.effort [K], ambient.flow [W/K], ambient.power
 *     [W], load.effort [N], load.flow [m/s], load.power [W], supply.effort [V], supply.flow
 *     [A], supply.power [W]
 */
void piezo_stack_elements(const double *x,
                          const double *u,
                          const piezo_stack_parameters *p_,
                          double *out);

/*
 * Margin by which each condition of the domain holds; of a bank, the least one.
 * x[n], read: q [m], p [kg*m/s], Q_C [C], phi_1 ... phi_hysteron_count [Wb], S [J/K]
 * u[piezo_stack_input_count], read: F_ext [N], V_in [V], T_e [K]
 * out[piezo_stack_condition_count], written; must not overlap another argument
 * out[0] > 0 where T > T_0
 * out[1] > 0 where T_e > T_0
 * out[2] >= 0 where d >= 0
 * out[3] >= 0 where rho >= 0
 * out[4] >= 0 where i_0 >= 0
 * out[5] >= 0 where lam >= 0
 * out[6] > 0 where k > 0
 * out[7] > 0 where M > 0
 * out[8] > 0 where C > 0
 * out[9] > 0 where L > 0
 * out[10] > 0 where T_0 > 0
 * out[11] > 0 where c_0 > 0
 */
void piezo_stack_margins(const double *x,
                         const double *u,
                         const piezo_stack_parameters *p_,
                         double *out);

#ifdef __cplusplus
}
#endif

#endif /* PIEZO_SYM_piezo_stack_H */
