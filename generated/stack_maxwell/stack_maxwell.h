/*
 * Piezoelectric stack with Maxwell-slip: 40 um at 150 V: irreversible port-Hamiltonian system.
 *
 * Source:  Goldfarb, Celanovic (1997), Modeling piezoelectric stack actuators; loop measured by Chandra et al. (2023), doi 10.1063/5.0146134
 * Model:   stack_maxwell, spec sha256 a4fac994b19a17a907de6d8bbc2fec285a640ebfd27501f5fec69ade7095faff
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, rate-independent, sigma, exergy, environment, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (Q, p, q, z_1 ... z_slips_count, S)
 * u = (F_ext, V_in, T_e)
 * p_ = pointer to stack_maxwell_parameters; the underscore tells it from p, a name of the model
 * bank slips: lanes j = 1 ... slips_count
 */
#ifndef PIEZO_SYM_stack_maxwell_H
#define PIEZO_SYM_stack_maxwell_H

#ifdef __cplusplus
extern "C" {
#endif

/* Parameters in SI units. The caller sets all; comments show the values of the spec. */
typedef struct {
    double m; /* moving mass [kg]; spec: 0.02 */
    double d; /* damping [N*s/m]; spec: 100.0 */
    double a; /* force constant: 50 N/um and 39 um at 150 V [N/V]; spec: 6.0 */
    double C; /* capacitance, clamped [F]; spec: 6.4e-06 */
    double R; /* resistance of the amplifier and leads [ohm]; spec: 10.0 */
    double k; /* stiffness that never yields [N/m]; spec: 24560000.0 */
    const double *k_s; /* stiffness of each slip [N/m], one per lane of slips; spec: a list */
    const double *r; /* extension at which each yields [m], one per lane of slips; spec: a list */
    double T_0; /* temperature at the start [K]; spec: 296.15 */
    double c_0; /* heat capacity [J/K]; spec: 5.0 */
    double lam; /* heat conductance to the air [W/K]; spec: 0.05 */
    long slips_count; /* lanes of slips, at least 1; spec: 8 */
} stack_maxwell_parameters;

/* An initializer for parameters: the values of the spec; change a count together with its arrays. */
#define stack_maxwell_DEFAULTS { \
    .m = 0.02, \
    .d = 100.0, \
    .a = 6.0, \
    .C = 6.4e-06, \
    .R = 10.0, \
    .k = 24560000.0, \
    .k_s = (const double[]){11270000.0, 1056000.0, 4535000.0, 2234000.0, 744300.0, 4553000.0, 1170000.0, 12980000.0}, \
    .r = (const double[]){2.35e-06, 4.7e-06, 7.05e-06, 9.4e-06, 1.175e-05, 1.41e-05, 1.645e-05, 1.88e-05}, \
    .T_0 = 296.15, \
    .c_0 = 5.0, \
    .lam = 0.05, \
    .slips_count = 8, \
}

/* Numbers of inputs, outputs, thermal bodies and conditions of the domain. */
enum {
    stack_maxwell_input_count = 3,
    stack_maxwell_output_count = 3,
    stack_maxwell_body_count = 1,
    stack_maxwell_condition_count = 11,
};

/*
 * Number of states n.
 */
long stack_maxwell_states(const stack_maxwell_parameters *p_);

/*
 * Number of processes, which produce entropy; of a bank, one per lane.
 */
long stack_maxwell_processes(const stack_maxwell_parameters *p_);

/*
 * State at t = 0 [SI], for the inputs u at t = 0.
 * u[stack_maxwell_input_count], read: F_ext [N], V_in [V], T_e [K]
 * out[n], written; must not overlap another argument: Q [C], p [kg*m/s], q [m], z_1 ...
 *     z_slips_count [m], S [J/K]
 */
void stack_maxwell_initial_state(const double *u,
                                 const stack_maxwell_parameters *p_,
                                 double *out);

/*
 * Rates dx/dt, the rows of J_ir dU/dx + g u.
 * x[n], read: Q [C], p [kg*m/s], q [m], z_1 ... z_slips_count [m], S [J/K]
 * u[stack_maxwell_input_count], read: F_ext [N], V_in [V], T_e [K]
 * out[n], written; must not overlap another argument
 */
void stack_maxwell_rhs(const double *x,
                       const double *u,
                       const stack_maxwell_parameters *p_,
                       double *out);

/*
 * Jacobian of rhs, n x n, row after row: d rhs[i]/d x[j] at out[i*n + j].
 * x[n], read: Q [C], p [kg*m/s], q [m], z_1 ... z_slips_count [m], S [J/K]
 * u[stack_maxwell_input_count], read: F_ext [N], V_in [V], T_e [K]
 * out[n*n], written; must not overlap another argument
 */
void stack_maxwell_jacobian(const double *x,
                            const double *u,
                            const stack_maxwell_parameters *p_,
                            double *out);

/*
 * Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient.
 * x[n], read: Q [C], p [kg*m/s], q [m], z_1 ... z_slips_count [m], S [J/K]
 * u[stack_maxwell_input_count], read: F_ext [N], V_in [V], T_e [K]
 * out[stack_maxwell_output_count], written; must not overlap another argument: load [m/s],
 *     amplifier [A], air [K]
 */
void stack_maxwell_outputs(const double *x,
                           const double *u,
                           const stack_maxwell_parameters *p_,
                           double *out);

/*
 * Power supplied through each port [W]; the sum is dU/dt.
 * x[n], read: Q [C], p [kg*m/s], q [m], z_1 ... z_slips_count [m], S [J/K]
 * u[stack_maxwell_input_count], read: F_ext [N], V_in [V], T_e [K]
 * out[stack_maxwell_output_count], written; must not overlap another argument
 */
void stack_maxwell_supply(const double *x,
                          const double *u,
                          const stack_maxwell_parameters *p_,
                          double *out);

/*
 * Hamiltonian U [J].
 * x[n], read: Q [C], p [kg*m/s], q [m], z_1 ... z_slips_count [m], S [J/K]
 */
double stack_maxwell_energy(const double *x, const stack_maxwell_parameters *p_);

/*
 * Total entropy S [J/K].
 * x[n], read: Q [C], p [kg*m/s], q [m], z_1 ... z_slips_count [m], S [J/K]
 */
double stack_maxwell_entropy(const double *x, const stack_maxwell_parameters *p_);

/*
 * Temperature of each body [K].
 * x[n], read: Q [C], p [kg*m/s], q [m], z_1 ... z_slips_count [m], S [J/K]
 * out[stack_maxwell_body_count], written; must not overlap another argument: body [K]
 */
void stack_maxwell_temperatures(const double *x,
                                const stack_maxwell_parameters *p_,
                                double *out);

/*
 * Power that each process turns into heat [W]; of a bank, one row per lane.
 * x[n], read: Q [C], p [kg*m/s], q [m], z_1 ... z_slips_count [m], S [J/K]
 * u[stack_maxwell_input_count], read: F_ext [N], V_in [V], T_e [K]
 * out[stack_maxwell_processes(p_)], written; must not overlap another argument
 */
void stack_maxwell_heat(const double *x,
                        const double *u,
                        const stack_maxwell_parameters *p_,
                        double *out);

/*
 * Entropy production of each process [W/K], heat exchange with ambients not included; of a
 *     bank, one row per lane.
 * x[n], read: Q [C], p [kg*m/s], q [m], z_1 ... z_slips_count [m], S [J/K]
 * u[stack_maxwell_input_count], read: F_ext [N], V_in [V], T_e [K]
 * out[stack_maxwell_processes(p_)], written; must not overlap another argument
 */
void stack_maxwell_entropy_production(const double *x,
                                      const double *u,
                                      const stack_maxwell_parameters *p_,
                                      double *out);

/*
 * Effort, flow, power, energy and heat of elements; of a bank, one row per lane.
 * x[n], read: Q [C], p [kg*m/s], q [m], z_1 ... z_slips_count [m], S [J/K]
 * u[stack_maxwell_input_count], read: F_ext [N], V_in [V], T_e [K]
 * out[38 + 6*slips_count], written; must not overlap another argument: amplifier.effort [V],
 *     amplifier.flow [A], amplifier.power [W], leads.effort [V], leads.flow [A], leads.power
 *     [W], leads.heat [W], clamped.effort [V], clamped.flow [A], clamped.power [W],
 *     clamped.energy [J], ceramic.effort_1 [V], ceramic.flow_1 [A], ceramic.effort_2 [N],
 *     ceramic.flow_2 [m/s], ceramic.power [W], mass.effort [N], mass.flow [m/s], mass.power
 *     [W], mass.energy [J], spring.effort [N], spring.flow [m/s], spring.power [W],
 *     spring.energy [J], slips.effort_1 ... slips.effort_slips_count [N], slips.flow_1 ...
 *     slips.flow_slips_count [m/s], slips.power_1 ... slips.power_slips_count [W],
 *     slips.energy_1 ... slips.energy_slips_count [J], slips.heat_1 ... slips.heat_slips_count
 *     [W], slips.limit_1 ... slips.limit_slips_count [N], damper.effort [N], damper.flow
 *     [m/s], damper.power [W], damper.heat [W], load.effort [N], load.flow [m/s], load.power
 *     [W], body.effort [K], body.flow [W/K], body.power [W], body.energy [J], air.effort [K],
 *     air.flow [W/K], air.power [W]
 */
void stack_maxwell_elements(const double *x,
                            const double *u,
                            const stack_maxwell_parameters *p_,
                            double *out);

/*
 * Margin by which each condition of the domain holds; of a bank, the least one.
 * x[n], read: Q [C], p [kg*m/s], q [m], z_1 ... z_slips_count [m], S [J/K]
 * u[stack_maxwell_input_count], read: F_ext [N], V_in [V], T_e [K]
 * out[stack_maxwell_condition_count], written; must not overlap another argument
 * out[0] > 0 where T_e > 0
 * out[1] > 0 where R > 0
 * out[2] >= 0 where d >= 0
 * out[3] >= 0 where lam >= 0
 * out[4] > 0 where C > 0
 * out[5] > 0 where m > 0
 * out[6] > 0 where k > 0
 * out[7] > 0 where k_s > 0
 * out[8] >= 0 where k_s*r >= 0
 * out[9] > 0 where T_0 > 0
 * out[10] > 0 where c_0 > 0
 */
void stack_maxwell_margins(const double *x,
                           const double *u,
                           const stack_maxwell_parameters *p_,
                           double *out);

#ifdef __cplusplus
}
#endif

#endif /* PIEZO_SYM_stack_maxwell_H */
