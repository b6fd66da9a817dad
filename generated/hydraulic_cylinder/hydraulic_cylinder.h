/*
 * Hydraulic cylinder behind an orifice, with a load and an end stop: irreversible port-Hamiltonian system.
 *
 * Source:  Merritt (1967), Hydraulic Control Systems, ch. 3 and 6
 * Model:   hydraulic_cylinder, spec sha256 9f77f306d723282ed74a083c6c8af89eb009af63f004a1308f102f81527e5387
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, continuous, sigma, exergy, environment, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (V, p, q, S)
 * u = (p_in, F, T_e)
 * p_ = pointer to hydraulic_cylinder_parameters; the underscore tells it from p, a name of the model
 */
#ifndef PIEZO_SYM_hydraulic_cylinder_H
#define PIEZO_SYM_hydraulic_cylinder_H

#ifdef __cplusplus
extern "C" {
#endif

/* Parameters in SI units. The caller sets all; comments show the values of the spec. */
typedef struct {
    double C_d; /* discharge coefficient [1]; spec: 0.6 */
    double a; /* area of the orifice [m**2]; spec: 2e-06 */
    double rho; /* density of the oil [kg/m**3]; spec: 870.0 */
    double p_t; /* pressure below which the flow is laminar [Pa]; spec: 10000.0 */
    double A; /* area of the piston [m**2]; spec: 0.001 */
    double C_h; /* capacitance of the oil in the cylinder, V/beta [m**3/Pa]; spec: 5e-13 */
    double m; /* load [kg]; spec: 50.0 */
    double d; /* friction [N*s/m]; spec: 500.0 */
    double k_s; /* stiffness of the end stop [N/m]; spec: 10000000.0 */
    double x_s; /* stroke up to the end stop [m]; spec: 0.05 */
    double c; /* heat capacity of oil and cylinder [J/K]; spec: 500.0 */
    double lam; /* heat conductance to the air [W/K]; spec: 5.0 */
    double T_0; /* temperature at the start [K]; spec: 313.15 */
} hydraulic_cylinder_parameters;

/* An initializer for parameters: the values of the spec. */
#define hydraulic_cylinder_DEFAULTS { \
    .C_d = 0.6, \
    .a = 2e-06, \
    .rho = 870.0, \
    .p_t = 10000.0, \
    .A = 0.001, \
    .C_h = 5e-13, \
    .m = 50.0, \
    .d = 500.0, \
    .k_s = 10000000.0, \
    .x_s = 0.05, \
    .c = 500.0, \
    .lam = 5.0, \
    .T_0 = 313.15, \
}

/* Numbers of inputs, outputs, thermal bodies and conditions of the domain. */
enum {
    hydraulic_cylinder_input_count = 3,
    hydraulic_cylinder_output_count = 3,
    hydraulic_cylinder_body_count = 1,
    hydraulic_cylinder_condition_count = 13,
};

/*
 * Number of states n.
 */
long hydraulic_cylinder_states(const hydraulic_cylinder_parameters *p_);

/*
 * Number of processes, which produce entropy; of a bank, one per lane.
 */
long hydraulic_cylinder_processes(const hydraulic_cylinder_parameters *p_);

/*
 * State at t = 0 [SI], for the inputs u at t = 0.
 * u[hydraulic_cylinder_input_count], read: p_in [Pa], F [N], T_e [K]
 * out[n], written; must not overlap another argument: V [m**3], p [kg*m/s], q [m], S [J/K]
 */
void hydraulic_cylinder_initial_state(const double *u,
                                      const hydraulic_cylinder_parameters *p_,
                                      double *out);

/*
 * Rates dx/dt, the rows of J_ir dU/dx + g u.
 * x[n], read: V [m**3], p [kg*m/s], q [m], S [J/K]
 * u[hydraulic_cylinder_input_count], read: p_in [Pa], F [N], T_e [K]
 * out[n], written; must not overlap another argument
 */
void hydraulic_cylinder_rhs(const double *x,
                            const double *u,
                            const hydraulic_cylinder_parameters *p_,
                            double *out);

/*
 * Jacobian of rhs, n x n, row after row: d rhs[i]/d x[j] at out[i*n + j].
 * x[n], read: V [m**3], p [kg*m/s], q [m], S [J/K]
 * u[hydraulic_cylinder_input_count], read: p_in [Pa], F [N], T_e [K]
 * out[n*n], written; must not overlap another argument
 */
void hydraulic_cylinder_jacobian(const double *x,
                                 const double *u,
                                 const hydraulic_cylinder_parameters *p_,
                                 double *out);

/*
 * Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient.
 * x[n], read: V [m**3], p [kg*m/s], q [m], S [J/K]
 * u[hydraulic_cylinder_input_count], read: p_in [Pa], F [N], T_e [K]
 * out[hydraulic_cylinder_output_count], written; must not overlap another argument: supply
 *     [m**3/s], push [m/s], air [K]
 */
void hydraulic_cylinder_outputs(const double *x,
                                const double *u,
                                const hydraulic_cylinder_parameters *p_,
                                double *out);

/*
 * Power supplied through each port [W]; the sum is dU/dt.
 * x[n], read: V [m**3], p [kg*m/s], q [m], S [J/K]
 * u[hydraulic_cylinder_input_count], read: p_in [Pa], F [N], T_e [K]
 * out[hydraulic_cylinder_output_count], written; must not overlap another argument
 */
void hydraulic_cylinder_supply(const double *x,
                               const double *u,
                               const hydraulic_cylinder_parameters *p_,
                               double *out);

/*
 * Hamiltonian U [J].
 * x[n], read: V [m**3], p [kg*m/s], q [m], S [J/K]
 */
double hydraulic_cylinder_energy(const double *x, const hydraulic_cylinder_parameters *p_);

/*
 * Total entropy S [J/K].
 * x[n], read: V [m**3], p [kg*m/s], q [m], S [J/K]
 */
double hydraulic_cylinder_entropy(const double *x, const hydraulic_cylinder_parameters *p_);

/*
 * Temperature of each body [K].
 * x[n], read: V [m**3], p [kg*m/s], q [m], S [J/K]
 * out[hydraulic_cylinder_body_count], written; must not overlap another argument: oil [K]
 */
void hydraulic_cylinder_temperatures(const double *x,
                                     const hydraulic_cylinder_parameters *p_,
                                     double *out);

/*
 * Power that each process turns into heat [W]; of a bank, one row per lane.
 * x[n], read: V [m**3], p [kg*m/s], q [m], S [J/K]
 * u[hydraulic_cylinder_input_count], read: p_in [Pa], F [N], T_e [K]
 * out[hydraulic_cylinder_processes(p_)], written; must not overlap another argument
 */
void hydraulic_cylinder_heat(const double *x,
                             const double *u,
                             const hydraulic_cylinder_parameters *p_,
                             double *out);

/*
 * Entropy production of each process [W/K], heat exchange with ambients not included; of a
 *     bank, one row per lane.
 * x[n], read: V [m**3], p [kg*m/s], q [m], S [J/K]
 * u[hydraulic_cylinder_input_count], read: p_in [Pa], F [N], T_e [K]
 * out[hydraulic_cylinder_processes(p_)], written; must not overlap another argument
 */
void hydraulic_cylinder_entropy_production(const double *x,
                                           const double *u,
                                           const hydraulic_cylinder_parameters *p_,
                                           double *out);

/*
 * Effort, flow, power, energy and heat of elements; of a bank, one row per lane.
 * x[n], read: V [m**3], p [kg*m/s], q [m], S [J/K]
 * u[hydraulic_cylinder_input_count], read: p_in [Pa], F [N], T_e [K]
 * out[38], written; must not overlap another argument: supply.effort [Pa], supply.flow
 *     [m**3/s], supply.power [W], orifice.effort [Pa], orifice.flow [m**3/s], orifice.power
 *     [W], orifice.heat [W], chamber.effort [Pa], chamber.flow [m**3/s], chamber.power [W],
 *     chamber.energy [J], cylinder.effort_1 [Pa], cylinder.flow_1 [m**3/s], cylinder.effort_2
 *     [N], cylinder.flow_2 [m/s], cylinder.power [W], load.effort [N], load.flow [m/s],
 *     load.power [W], load.energy [J], friction.effort [N], friction.flow [m/s],
 *     friction.power [W], friction.heat [W], stop.effort [N], stop.flow [m/s], stop.power [W],
 *     stop.energy [J], push.effort [N], push.flow [m/s], push.power [W], oil.effort [K],
 *     oil.flow [W/K], oil.power [W], oil.energy [J], air.effort [K], air.flow [W/K], air.power
 *     [W]
 */
void hydraulic_cylinder_elements(const double *x,
                                 const double *u,
                                 const hydraulic_cylinder_parameters *p_,
                                 double *out);

/*
 * Margin by which each condition of the domain holds; of a bank, the least one.
 * x[n], read: V [m**3], p [kg*m/s], q [m], S [J/K]
 * u[hydraulic_cylinder_input_count], read: p_in [Pa], F [N], T_e [K]
 * out[hydraulic_cylinder_condition_count], written; must not overlap another argument
 * out[0] >= 0 where C_d >= 0
 * out[1] >= 0 where a >= 0
 * out[2] > 0 where rho > 0
 * out[3] > 0 where p_t > 0
 * out[4] >= 0 where d >= 0
 * out[5] > 0 where k_s > 0
 * out[6] > 0 where x_s > 0
 * out[7] >= 0 where lam >= 0
 * out[8] > 0 where T_e > 0
 * out[9] > 0 where C_h > 0
 * out[10] > 0 where m > 0
 * out[11] > 0 where T_0 > 0
 * out[12] > 0 where c > 0
 */
void hydraulic_cylinder_margins(const double *x,
                                const double *u,
                                const hydraulic_cylinder_parameters *p_,
                                double *out);

#ifdef __cplusplus
}
#endif

#endif /* PIEZO_SYM_hydraulic_cylinder_H */
