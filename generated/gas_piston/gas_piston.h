/*
 * Ideal gas under a piston, with heat exchanged: irreversible port-Hamiltonian system.
 *
 * Source:  Ruechhardt (1929), Physikalische Zeitschrift 30, 58-59, the period; van der Schaft, Maschke (2018), Entropy 20, 925
 * Model:   gas_piston, spec sha256 0a9d53c8700ddf1bb0d85a7756da7a071b3f29cf0a98843810acd07ee683352b
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, sigma, exergy, environment, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (p, q, S)
 * u = (F, T_e)
 * p_ = pointer to gas_piston_parameters; the underscore tells it from p, a name of the model
 */
#ifndef PIEZO_SYM_gas_piston_H
#define PIEZO_SYM_gas_piston_H

#ifdef __cplusplus
extern "C" {
#endif

/* Parameters in SI units. The caller sets all; comments show the values of the spec. */
typedef struct {
    double V_0; /* volume at q = 0 [m**3]; spec: 0.01 */
    double A; /* area of the piston [m**2]; spec: 0.0002 */
    double N; /* amount of gas [mol]; spec: 0.41 */
    double c_v; /* molar heat capacity at constant volume [J/mol/K]; spec: 20.786 */
    double R; /* gas constant [J/mol/K]; spec: 8.314463 */
    double T_0; /* temperature at S = 0 and q = 0 [K]; spec: 293.15 */
    double m; /* mass of the piston [kg]; spec: 0.0165 */
    double d; /* friction of the piston [N*s/m]; spec: 0.005 */
    double lam; /* heat conductance through the vessel [W/K]; spec: 0.05 */
} gas_piston_parameters;

/* An initializer for parameters: the values of the spec. */
#define gas_piston_DEFAULTS { \
    .V_0 = 0.01, \
    .A = 0.0002, \
    .N = 0.41, \
    .c_v = 20.786, \
    .R = 8.314463, \
    .T_0 = 293.15, \
    .m = 0.0165, \
    .d = 0.005, \
    .lam = 0.05, \
}

/* Numbers of inputs, outputs, thermal bodies and conditions of the domain. */
enum {
    gas_piston_input_count = 2,
    gas_piston_output_count = 2,
    gas_piston_body_count = 1,
    gas_piston_condition_count = 11,
};

/*
 * Number of states n.
 */
long gas_piston_states(const gas_piston_parameters *p_);

/*
 * Number of processes, which produce entropy; of a bank, one per lane.
 */
long gas_piston_processes(const gas_piston_parameters *p_);

/*
 * State at t = 0 [SI], for the inputs u at t = 0.
 * u[gas_piston_input_count], read: F [N], T_e [K]
 * out[n], written; must not overlap another argument: p [kg*m/s], q [m], S [J/K]
 */
void gas_piston_initial_state(const double *u, const gas_piston_parameters *p_, double *out);

/*
 * Rates dx/dt, the rows of J_ir dU/dx + g u.
 * x[n], read: p [kg*m/s], q [m], S [J/K]
 * u[gas_piston_input_count], read: F [N], T_e [K]
 * out[n], written; must not overlap another argument
 */
void gas_piston_rhs(const double *x,
                    const double *u,
                    const gas_piston_parameters *p_,
                    double *out);

/*
 * Jacobian of rhs, n x n, row after row: d rhs[i]/d x[j] at out[i*n + j].
 * x[n], read: p [kg*m/s], q [m], S [J/K]
 * u[gas_piston_input_count], read: F [N], T_e [K]
 * out[n*n], written; must not overlap another argument
 */
void gas_piston_jacobian(const double *x,
                         const double *u,
                         const gas_piston_parameters *p_,
                         double *out);

/*
 * Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient.
 * x[n], read: p [kg*m/s], q [m], S [J/K]
 * u[gas_piston_input_count], read: F [N], T_e [K]
 * out[gas_piston_output_count], written; must not overlap another argument: load [m/s], vessel
 *     [K]
 */
void gas_piston_outputs(const double *x,
                        const double *u,
                        const gas_piston_parameters *p_,
                        double *out);

/*
 * Power supplied through each port [W]; the sum is dU/dt.
 * x[n], read: p [kg*m/s], q [m], S [J/K]
 * u[gas_piston_input_count], read: F [N], T_e [K]
 * out[gas_piston_output_count], written; must not overlap another argument
 */
void gas_piston_supply(const double *x,
                       const double *u,
                       const gas_piston_parameters *p_,
                       double *out);

/*
 * Hamiltonian U [J].
 * x[n], read: p [kg*m/s], q [m], S [J/K]
 */
double gas_piston_energy(const double *x, const gas_piston_parameters *p_);

/*
 * Total entropy S [J/K].
 * x[n], read: p [kg*m/s], q [m], S [J/K]
 */
double gas_piston_entropy(const double *x, const gas_piston_parameters *p_);

/*
 * Temperature of each body [K].
 * x[n], read: p [kg*m/s], q [m], S [J/K]
 * out[gas_piston_body_count], written; must not overlap another argument: gas [K]
 */
void gas_piston_temperatures(const double *x, const gas_piston_parameters *p_, double *out);

/*
 * Power that each process turns into heat [W]; of a bank, one row per lane.
 * x[n], read: p [kg*m/s], q [m], S [J/K]
 * u[gas_piston_input_count], read: F [N], T_e [K]
 * out[gas_piston_processes(p_)], written; must not overlap another argument
 */
void gas_piston_heat(const double *x,
                     const double *u,
                     const gas_piston_parameters *p_,
                     double *out);

/*
 * Entropy production of each process [W/K], heat exchange with ambients not included; of a
 *     bank, one row per lane.
 * x[n], read: p [kg*m/s], q [m], S [J/K]
 * u[gas_piston_input_count], read: F [N], T_e [K]
 * out[gas_piston_processes(p_)], written; must not overlap another argument
 */
void gas_piston_entropy_production(const double *x,
                                   const double *u,
                                   const gas_piston_parameters *p_,
                                   double *out);

/*
 * Effort, flow, power, energy and heat of elements; of a bank, one row per lane.
 * x[n], read: p [kg*m/s], q [m], S [J/K]
 * u[gas_piston_input_count], read: F [N], T_e [K]
 * out[20], written; must not overlap another argument: piston.effort [N], piston.flow [m/s],
 *     piston.power [W], piston.energy [J], friction.effort [N], friction.flow [m/s],
 *     friction.power [W], friction.heat [W], load.effort [N], load.flow [m/s], load.power [W],
 *     vessel.effort [K], vessel.flow [W/K], vessel.power [W], gas.effort_q [N], gas.flow_q
 *     [m/s], gas.effort_S [K], gas.flow_S [W/K], gas.power [W], gas.energy [J]
 */
void gas_piston_elements(const double *x,
                         const double *u,
                         const gas_piston_parameters *p_,
                         double *out);

/*
 * Margin by which each condition of the domain holds; of a bank, the least one.
 * x[n], read: p [kg*m/s], q [m], S [J/K]
 * u[gas_piston_input_count], read: F [N], T_e [K]
 * out[gas_piston_condition_count], written; must not overlap another argument
 * out[0] > 0 where V_0 + A*q > 0
 * out[1] > 0 where V_0 > 0
 * out[2] > 0 where A > 0
 * out[3] > 0 where N > 0
 * out[4] > 0 where c_v > 0
 * out[5] > 0 where R > 0
 * out[6] > 0 where T_0 > 0
 * out[7] >= 0 where d >= 0
 * out[8] >= 0 where lam >= 0
 * out[9] > 0 where T_e > 0
 * out[10] > 0 where m > 0
 */
void gas_piston_margins(const double *x,
                        const double *u,
                        const gas_piston_parameters *p_,
                        double *out);

#ifdef __cplusplus
}
#endif

#endif /* PIEZO_SYM_gas_piston_H */
