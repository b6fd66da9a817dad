/*
 * DC motor with gear, bearing, and a winding that warms: irreversible port-Hamiltonian system.
 *
 * Source:  Messner, Tilbury, Control Tutorials for MATLAB and Simulink: DC motor speed, with gear and heat
 * Model:   dc_motor, spec sha256 96a82a6d03ed86fc2c97e6ac88a26dd86ab244ed2d6fd71b14db35164a855b91
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, welldef, energy, entropy, passive, odd, sigma, exergy, environment, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (phi, H, S)
 * u = (V_in, tau, T_e)
 * p = pointer to dc_motor_parameters
 */
#ifndef PIEZO_SYM_dc_motor_H
#define PIEZO_SYM_dc_motor_H

#ifdef __cplusplus
extern "C" {
#endif

/* Parameters in SI units. The caller sets all; comments show the values of the spec. */
typedef struct {
    double R_0; /* resistance of the armature at T_0 [ohm]; spec: 1.0 */
    double al; /* temperature coefficient of copper [1/K]; spec: 0.00393 */
    double L; /* inductance of the armature [H]; spec: 0.5 */
    double K; /* motor constant [N*m/A]; spec: 0.01 */
    double J_m; /* inertia of the rotor [kg*m**2]; spec: 0.01 */
    double b; /* friction of the bearing [N*m*s]; spec: 0.1 */
    double n; /* speed of the rotor over that of the load [1]; spec: 5.0 */
    double J_l; /* inertia of the load [kg*m**2]; spec: 0.25 */
    double c; /* heat capacity of the motor [J/K]; spec: 50.0 */
    double lam; /* heat conductance to the environment [W/K]; spec: 0.2 */
    double T_0; /* temperature at the start [K]; spec: 293.15 */
} dc_motor_parameters;

/* An initializer for parameters: the values of the spec. */
#define dc_motor_DEFAULTS { \
    .R_0 = 1.0, \
    .al = 0.00393, \
    .L = 0.5, \
    .K = 0.01, \
    .J_m = 0.01, \
    .b = 0.1, \
    .n = 5.0, \
    .J_l = 0.25, \
    .c = 50.0, \
    .lam = 0.2, \
    .T_0 = 293.15, \
}

/* Numbers of inputs, outputs, thermal bodies and conditions of the domain. */
enum {
    dc_motor_input_count = 3,
    dc_motor_output_count = 3,
    dc_motor_body_count = 1,
    dc_motor_condition_count = 12,
};

/*
 * Number of states n.
 */
long dc_motor_states(const dc_motor_parameters *p);

/*
 * Number of processes, which produce entropy; of a bank, one per lane.
 */
long dc_motor_processes(const dc_motor_parameters *p);

/*
 * State at t = 0 [SI], for the inputs u at t = 0.
 * u[dc_motor_input_count], read: V_in [V], tau [N*m], T_e [K]
 * out[n], written; must not overlap another argument: phi [Wb], H [N*m*s], S [J/K]
 */
void dc_motor_initial_state(const double *u, const dc_motor_parameters *p, double *out);

/*
 * Rates dx/dt, the rows of J_ir dU/dx + g u.
 * x[n], read: phi [Wb], H [N*m*s], S [J/K]
 * u[dc_motor_input_count], read: V_in [V], tau [N*m], T_e [K]
 * out[n], written; must not overlap another argument
 */
void dc_motor_rhs(const double *x, const double *u, const dc_motor_parameters *p, double *out);

/*
 * Jacobian of rhs, n x n, row after row: d rhs[i]/d x[j] at out[i*n + j].
 * x[n], read: phi [Wb], H [N*m*s], S [J/K]
 * u[dc_motor_input_count], read: V_in [V], tau [N*m], T_e [K]
 * out[n*n], written; must not overlap another argument
 */
void dc_motor_jacobian(const double *x,
                       const double *u,
                       const dc_motor_parameters *p,
                       double *out);

/*
 * Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient.
 * x[n], read: phi [Wb], H [N*m*s], S [J/K]
 * u[dc_motor_input_count], read: V_in [V], tau [N*m], T_e [K]
 * out[dc_motor_output_count], written; must not overlap another argument: supply [A], torque
 *     [rad/s], air [K]
 */
void dc_motor_outputs(const double *x,
                      const double *u,
                      const dc_motor_parameters *p,
                      double *out);

/*
 * Power supplied through each port [W]; the sum is dU/dt.
 * x[n], read: phi [Wb], H [N*m*s], S [J/K]
 * u[dc_motor_input_count], read: V_in [V], tau [N*m], T_e [K]
 * out[dc_motor_output_count], written; must not overlap another argument
 */
void dc_motor_supply(const double *x,
                     const double *u,
                     const dc_motor_parameters *p,
                     double *out);

/*
 * Hamiltonian U [J].
 * x[n], read: phi [Wb], H [N*m*s], S [J/K]
 */
double dc_motor_energy(const double *x, const dc_motor_parameters *p);

/*
 * Total entropy S [J/K].
 * x[n], read: phi [Wb], H [N*m*s], S [J/K]
 */
double dc_motor_entropy(const double *x, const dc_motor_parameters *p);

/*
 * Temperature of each body [K].
 * x[n], read: phi [Wb], H [N*m*s], S [J/K]
 * out[dc_motor_body_count], written; must not overlap another argument: body [K]
 */
void dc_motor_temperatures(const double *x, const dc_motor_parameters *p, double *out);

/*
 * Power that each process turns into heat [W]; of a bank, one row per lane.
 * x[n], read: phi [Wb], H [N*m*s], S [J/K]
 * u[dc_motor_input_count], read: V_in [V], tau [N*m], T_e [K]
 * out[dc_motor_processes(p)], written; must not overlap another argument
 */
void dc_motor_heat(const double *x, const double *u, const dc_motor_parameters *p, double *out);

/*
 * Entropy production of each process [W/K], heat exchange with ambients not included; of a
 *     bank, one row per lane.
 * x[n], read: phi [Wb], H [N*m*s], S [J/K]
 * u[dc_motor_input_count], read: V_in [V], tau [N*m], T_e [K]
 * out[dc_motor_processes(p)], written; must not overlap another argument
 */
void dc_motor_entropy_production(const double *x,
                                 const double *u,
                                 const dc_motor_parameters *p,
                                 double *out);

/*
 * Effort, flow, power, energy and heat of elements; of a bank, one row per lane.
 * x[n], read: phi [Wb], H [N*m*s], S [J/K]
 * u[dc_motor_input_count], read: V_in [V], tau [N*m], T_e [K]
 * out[43], written; must not overlap another argument: supply.effort [V], supply.flow [A],
 *     supply.power [W], winding.effort [V], winding.flow [A], winding.power [W], winding.heat
 *     [W], armature.effort [V], armature.flow [A], armature.power [W], armature.energy [J],
 *     machine.effort_1 [V], machine.flow_1 [A], machine.effort_2 [N*m], machine.flow_2
 *     [rad/s], machine.power [W], rotor.effort [N*m], rotor.flow [rad/s], rotor.power [W],
 *     rotor.energy [J], bearing.effort [N*m], bearing.flow [rad/s], bearing.power [W],
 *     bearing.heat [W], gear.effort_1 [N*m], gear.flow_1 [rad/s], gear.effort_2 [N*m],
 *     gear.flow_2 [rad/s], gear.power [W], load.effort [N*m], load.flow [rad/s], load.power
 *     [W], load.energy [J], torque.effort [N*m], torque.flow [rad/s], torque.power [W],
 *     body.effort [K], body.flow [W/K], body.power [W], body.energy [J], air.effort [K],
 *     air.flow [W/K], air.power [W]
 */
void dc_motor_elements(const double *x,
                       const double *u,
                       const dc_motor_parameters *p,
                       double *out);

/*
 * Margin by which each condition of the domain holds; of a bank, the least one.
 * x[n], read: phi [Wb], H [N*m*s], S [J/K]
 * u[dc_motor_input_count], read: V_in [V], tau [N*m], T_e [K]
 * out[dc_motor_condition_count], written; must not overlap another argument
 * out[0] >= 0 where R_0 >= 0
 * out[1] >= 0 where al >= 0
 * out[2] >= 0 where b >= 0
 * out[3] >= 0 where lam >= 0
 * out[4] > 0 where n > 0
 * out[5] > 0 where 1 + al*(T - T_0) > 0
 * out[6] > 0 where T_e > 0
 * out[7] > 0 where L > 0
 * out[8] > 0 where J_m > 0
 * out[9] > 0 where J_l > 0
 * out[10] > 0 where T_0 > 0
 * out[11] > 0 where c > 0
 */
void dc_motor_margins(const double *x,
                      const double *u,
                      const dc_motor_parameters *p,
                      double *out);

#ifdef __cplusplus
}
#endif

#endif /* PIEZO_SYM_dc_motor_H */
