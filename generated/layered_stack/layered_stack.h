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
#ifndef PIEZO_SYM_layered_stack_H
#define PIEZO_SYM_layered_stack_H

#ifdef __cplusplus
extern "C" {
#endif

/* Parameters in SI units. The caller sets all; comments show the values of the spec. */
typedef struct {
    double M; /* mass of a layer [kg]; spec: 0.00225 */
    double k; /* stiffness of a layer [N/m]; spec: 1500000.0 */
    double d; /* damping of a layer [N*s/m]; spec: 1200.0 */
    double C; /* capacitance of a layer [F]; spec: 1.6666666666666667e-06 */
    double L; /* inductance of a layer's hysteron [H]; spec: 0.0015 */
    double rho; /* resistance law of a layer: slope rho/(T - T_0) [ohm*K]; spec: 15.0 */
    double i_0; /* half width of a layer's dead zone [A]; spec: 0.3333333333333333 */
    double a; /* transducer ratio of a layer at T_0 [C/m]; spec: 10.0 */
    double T_0; /* reference temperature [K]; spec: 296.15 */
    double c_0; /* heat capacity of a layer [J/K]; spec: 1.6666666666666667 */
    double lam; /* heat conductance from an end to the environment [W/K]; spec: 1.0 */
    double lam_l; /* heat conductance from a layer to the next [W/K]; spec: 6.0 */
} layered_stack_parameters;

/* An initializer for parameters: the values of the spec. */
#define layered_stack_DEFAULTS { \
    .M = 0.00225, \
    .k = 1500000.0, \
    .d = 1200.0, \
    .C = 1.6666666666666667e-06, \
    .L = 0.0015, \
    .rho = 15.0, \
    .i_0 = 0.3333333333333333, \
    .a = 10.0, \
    .T_0 = 296.15, \
    .c_0 = 1.6666666666666667, \
    .lam = 1.0, \
    .lam_l = 6.0, \
}

/* Numbers of inputs, outputs, thermal bodies and conditions of the domain. */
enum {
    layered_stack_input_count = 3,
    layered_stack_output_count = 4,
    layered_stack_body_count = 3,
    layered_stack_condition_count = 15,
};

/*
 * Number of states n.
 */
long layered_stack_states(const layered_stack_parameters *p);

/*
 * Number of processes, which produce entropy; of a bank, one per lane.
 */
long layered_stack_processes(const layered_stack_parameters *p);

/*
 * State at t = 0 [SI], for the inputs u at t = 0.
 * u[layered_stack_input_count], read: F_ext [N], V_in [V], T_e [K]
 * out[n], written; must not overlap another argument: q_1 [m], p_1 [kg*m/s], Q_1 [C], phi_1
 *     [Wb], S_1 [J/K], q_2 [m], p_2 [kg*m/s], Q_2 [C], phi_2 [Wb], S_2 [J/K], q_3 [m], p_3
 *     [kg*m/s], Q_3 [C], phi_3 [Wb], S_3 [J/K]
 */
void layered_stack_initial_state(const double *u,
                                 const layered_stack_parameters *p,
                                 double *out);

/*
 * Rates dx/dt, the rows of J_ir dU/dx + g u.
 * x[n], read: q_1 [m], p_1 [kg*m/s], Q_1 [C], phi_1 [Wb], S_1 [J/K], q_2 [m], p_2 [kg*m/s],
 *     Q_2 [C], phi_2 [Wb], S_2 [J/K], q_3 [m], p_3 [kg*m/s], Q_3 [C], phi_3 [Wb], S_3 [J/K]
 * u[layered_stack_input_count], read: F_ext [N], V_in [V], T_e [K]
 * out[n], written; must not overlap another argument
 */
void layered_stack_rhs(const double *x,
                       const double *u,
                       const layered_stack_parameters *p,
                       double *out);

/*
 * Jacobian of rhs, n x n, row after row: d rhs[i]/d x[j] at out[i*n + j].
 * x[n], read: q_1 [m], p_1 [kg*m/s], Q_1 [C], phi_1 [Wb], S_1 [J/K], q_2 [m], p_2 [kg*m/s],
 *     Q_2 [C], phi_2 [Wb], S_2 [J/K], q_3 [m], p_3 [kg*m/s], Q_3 [C], phi_3 [Wb], S_3 [J/K]
 * u[layered_stack_input_count], read: F_ext [N], V_in [V], T_e [K]
 * out[n*n], written; must not overlap another argument
 */
void layered_stack_jacobian(const double *x,
                            const double *u,
                            const layered_stack_parameters *p,
                            double *out);

/*
 * Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient.
 * x[n], read: q_1 [m], p_1 [kg*m/s], Q_1 [C], phi_1 [Wb], S_1 [J/K], q_2 [m], p_2 [kg*m/s],
 *     Q_2 [C], phi_2 [Wb], S_2 [J/K], q_3 [m], p_3 [kg*m/s], Q_3 [C], phi_3 [Wb], S_3 [J/K]
 * u[layered_stack_input_count], read: F_ext [N], V_in [V], T_e [K]
 * out[layered_stack_output_count], written; must not overlap another argument: load [m/s],
 *     supply [A], base [K], top [K]
 */
void layered_stack_outputs(const double *x,
                           const double *u,
                           const layered_stack_parameters *p,
                           double *out);

/*
 * Power supplied through each port [W]; the sum is dU/dt.
 * x[n], read: q_1 [m], p_1 [kg*m/s], Q_1 [C], phi_1 [Wb], S_1 [J/K], q_2 [m], p_2 [kg*m/s],
 *     Q_2 [C], phi_2 [Wb], S_2 [J/K], q_3 [m], p_3 [kg*m/s], Q_3 [C], phi_3 [Wb], S_3 [J/K]
 * u[layered_stack_input_count], read: F_ext [N], V_in [V], T_e [K]
 * out[layered_stack_output_count], written; must not overlap another argument
 */
void layered_stack_supply(const double *x,
                          const double *u,
                          const layered_stack_parameters *p,
                          double *out);

/*
 * Hamiltonian U [J].
 * x[n], read: q_1 [m], p_1 [kg*m/s], Q_1 [C], phi_1 [Wb], S_1 [J/K], q_2 [m], p_2 [kg*m/s],
 *     Q_2 [C], phi_2 [Wb], S_2 [J/K], q_3 [m], p_3 [kg*m/s], Q_3 [C], phi_3 [Wb], S_3 [J/K]
 */
double layered_stack_energy(const double *x, const layered_stack_parameters *p);

/*
 * Total entropy S [J/K].
 * x[n], read: q_1 [m], p_1 [kg*m/s], Q_1 [C], phi_1 [Wb], S_1 [J/K], q_2 [m], p_2 [kg*m/s],
 *     Q_2 [C], phi_2 [Wb], S_2 [J/K], q_3 [m], p_3 [kg*m/s], Q_3 [C], phi_3 [Wb], S_3 [J/K]
 */
double layered_stack_entropy(const double *x, const layered_stack_parameters *p);

/*
 * Temperature of each body [K].
 * x[n], read: q_1 [m], p_1 [kg*m/s], Q_1 [C], phi_1 [Wb], S_1 [J/K], q_2 [m], p_2 [kg*m/s],
 *     Q_2 [C], phi_2 [Wb], S_2 [J/K], q_3 [m], p_3 [kg*m/s], Q_3 [C], phi_3 [Wb], S_3 [J/K]
 * out[layered_stack_body_count], written; must not overlap another argument: body_1 [K],
 *     body_2 [K], body_3 [K]
 */
void layered_stack_temperatures(const double *x, const layered_stack_parameters *p, double *out);

/*
 * Power that each process turns into heat [W]; of a bank, one row per lane.
 * x[n], read: q_1 [m], p_1 [kg*m/s], Q_1 [C], phi_1 [Wb], S_1 [J/K], q_2 [m], p_2 [kg*m/s],
 *     Q_2 [C], phi_2 [Wb], S_2 [J/K], q_3 [m], p_3 [kg*m/s], Q_3 [C], phi_3 [Wb], S_3 [J/K]
 * u[layered_stack_input_count], read: F_ext [N], V_in [V], T_e [K]
 * out[layered_stack_processes(p)], written; must not overlap another argument
 */
void layered_stack_heat(const double *x,
                        const double *u,
                        const layered_stack_parameters *p,
                        double *out);

/*
 * Entropy production of each process [W/K], heat exchange with ambients not included; of a
 *     bank, one row per lane.
 * x[n], read: q_1 [m], p_1 [kg*m/s], Q_1 [C], phi_1 [Wb], S_1 [J/K], q_2 [m], p_2 [kg*m/s],
 *     Q_2 [C], phi_2 [Wb], S_2 [J/K], q_3 [m], p_3 [kg*m/s], Q_3 [C], phi_3 [Wb], S_3 [J/K]
 * u[layered_stack_input_count], read: F_ext [N], V_in [V], T_e [K]
 * out[layered_stack_processes(p)], written; must not overlap another argument
 */
void layered_stack_entropy_production(const double *x,
                                      const double *u,
                                      const layered_stack_parameters *p,
                                      double *out);

/*
 * Effort, flow, power, energy and heat of elements; of a bank, one row per lane.
 * x[n], read: q_1 [m], p_1 [kg*m/s], Q_1 [C], phi_1 [Wb], S_1 [J/K], q_2 [m], p_2 [kg*m/s],
 *     Q_2 [C], phi_2 [Wb], S_2 [J/K], q_3 [m], p_3 [kg*m/s], Q_3 [C], phi_3 [Wb], S_3 [J/K]
 * u[layered_stack_input_count], read: F_ext [N], V_in [V], T_e [K]
 * out[106], written; must not overlap another argument: spring_1.effort [N], spring_1.flow
 *     [m/s], spring_1.power [W], spring_1.energy [J], mass_1.effort [N], mass_1.flow [m/s],
 *     mass_1.power [W], mass_1.energy [J], capacitor_1.effort [V], capacitor_1.flow [A],
 *     capacitor_1.power [W], capacitor_1.energy [J], hysteron_1.effort [V], hysteron_1.flow
 *     [A], hysteron_1.power [W], hysteron_1.energy [J], hysteron_1.heat [W], damper_1.effort
 *     [N], damper_1.flow [m/s], damper_1.power [W], damper_1.heat [W], transducer_1.effort_1
 *     [V], transducer_1.flow_1 [A], transducer_1.effort_2 [N], transducer_1.flow_2 [m/s],
 *     transducer_1.power [W], body_1.effort [K], body_1.flow [W/K], body_1.power [W],
 *     body_1.energy [J], spring_2.effort [N], spring_2.flow [m/s], spring_2.power [W],
 *     spring_2.energy [J], mass_2.effort [N], mass_2.flow [m/s], mass_2.power [W],
 *     mass_2.energy [J], capacitor_2.effort [V], capacitor_2.flow [A], capacitor_2.power [W],
 *     capacitor_2.energy [J], hysteron_2.effort [V], hysteron_2.flow [A], hysteron_2.power
 *     [W], hysteron_2.energy [J], hysteron_2.heat [W], damper_2.effort [N], damper_2.flow
 *     [m/s], damper_2.power [W], damper_2.heat [W], transducer_2.effort_1 [V],
 *     transducer_2.flow_1 [A], transducer_2.effort_2 [N], transducer_2.flow_2 [m/s],
 *     transducer_2.power [W], body_2.effort [K], body_2.flow [W/K], body_2.power [W],
 *     body_2.energy [J], spring_3.effort [N], spring_3.flow [m/s], spring_3.power [W],
 *     spring_3.energy [J], mass_3.effort [N], mass_3.flow [m/s], mass_3.power [W],
 *     mass_3.energy [J], capacitor_3.effort [V], capacitor_3.flow [A], capacitor_3.power [W],
 *     capacitor_3.energy [J], hysteron_3.effort [V], hysteron_3.flow [A], hysteron_3.power
 *     [W], hysteron_3.energy [J], hysteron_3.heat [W], damper_3.effort [N], damper_3.flow
 *     [m/s], damper_3.power [W], damper_3.heat [W], transducer_3.effort_1 [V],
 *     transducer_3.flow_1 [A], transducer_3.effort_2 [N], transducer_3.flow_2 [m/s],
 *     transducer_3.power [W], body_3.effort [K], body_3.flow [W/K], body_3.power [W],
 *     body_3.energy [J], contact_1.effort [K], contact_1.power [W], contact_2.effort [K],
 *     contact_2.power [W], base.effort [K], base.flow [W/K], base.power [W], top.effort [K],
 *     top.flow [W/K], top.power [W], load.effort [N], load.flow [m/s], load.power [W],
 *     supply.effort [V], supply.flow [A], supply.power [W]
 */
void layered_stack_elements(const double *x,
                            const double *u,
                            const layered_stack_parameters *p,
                            double *out);

/*
 * Margin by which each condition of the domain holds; of a bank, the least one.
 * x[n], read: q_1 [m], p_1 [kg*m/s], Q_1 [C], phi_1 [Wb], S_1 [J/K], q_2 [m], p_2 [kg*m/s],
 *     Q_2 [C], phi_2 [Wb], S_2 [J/K], q_3 [m], p_3 [kg*m/s], Q_3 [C], phi_3 [Wb], S_3 [J/K]
 * u[layered_stack_input_count], read: F_ext [N], V_in [V], T_e [K]
 * out[layered_stack_condition_count], written; must not overlap another argument
 * out[0] > 0 where T_body_1 > T_0
 * out[1] > 0 where T_body_2 > T_0
 * out[2] > 0 where T_body_3 > T_0
 * out[3] > 0 where T_e > T_0
 * out[4] >= 0 where d >= 0
 * out[5] >= 0 where rho >= 0
 * out[6] >= 0 where i_0 >= 0
 * out[7] >= 0 where lam >= 0
 * out[8] >= 0 where lam_l >= 0
 * out[9] > 0 where k > 0
 * out[10] > 0 where M > 0
 * out[11] > 0 where C > 0
 * out[12] > 0 where L > 0
 * out[13] > 0 where T_0 > 0
 * out[14] > 0 where c_0 > 0
 */
void layered_stack_margins(const double *x,
                           const double *u,
                           const layered_stack_parameters *p,
                           double *out);

#ifdef __cplusplus
}
#endif

#endif /* PIEZO_SYM_layered_stack_H */
