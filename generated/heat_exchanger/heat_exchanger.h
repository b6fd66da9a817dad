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
#ifndef PIEZO_SYM_heat_exchanger_H
#define PIEZO_SYM_heat_exchanger_H

#ifdef __cplusplus
extern "C" {
#endif

/* Parameters in SI units. The caller sets all; comments show the values of the spec. */
typedef struct {
    double c_1; /* heat capacity of the hot body [J/K]; spec: 2.0 */
    double c_2; /* heat capacity of the cold body [J/K]; spec: 3.0 */
    double lam; /* heat conductance of the contact [W/K]; spec: 0.5 */
    double T_0; /* temperature at which the entropies are zero [K]; spec: 300.0 */
    double T_1; /* temperature of the hot body at the start [K]; spec: 350.0 */
    double T_2; /* temperature of the cold body at the start [K]; spec: 290.0 */
} heat_exchanger_parameters;

/* An initializer for parameters: the values of the spec. */
#define heat_exchanger_DEFAULTS { \
    .c_1 = 2.0, \
    .c_2 = 3.0, \
    .lam = 0.5, \
    .T_0 = 300.0, \
    .T_1 = 350.0, \
    .T_2 = 290.0, \
}

/* Numbers of inputs, outputs, thermal bodies and conditions of the domain. */
enum {
    heat_exchanger_input_count = 0,
    heat_exchanger_output_count = 0,
    heat_exchanger_body_count = 2,
    heat_exchanger_condition_count = 6,
};

/*
 * Number of states n.
 */
long heat_exchanger_states(const heat_exchanger_parameters *p);

/*
 * Number of processes, which produce entropy; of a bank, one per lane.
 */
long heat_exchanger_processes(const heat_exchanger_parameters *p);

/*
 * State at t = 0 [SI], for the inputs u at t = 0.
 * u[heat_exchanger_input_count], read
 * out[n], written; must not overlap another argument: S_hot [J/K], S_cold [J/K]
 */
void heat_exchanger_initial_state(const double *u,
                                  const heat_exchanger_parameters *p,
                                  double *out);

/*
 * Rates dx/dt, the rows of J_ir dU/dx + g u.
 * x[n], read: S_hot [J/K], S_cold [J/K]
 * u[heat_exchanger_input_count], read
 * out[n], written; must not overlap another argument
 */
void heat_exchanger_rhs(const double *x,
                        const double *u,
                        const heat_exchanger_parameters *p,
                        double *out);

/*
 * Jacobian of rhs, n x n, row after row: d rhs[i]/d x[j] at out[i*n + j].
 * x[n], read: S_hot [J/K], S_cold [J/K]
 * u[heat_exchanger_input_count], read
 * out[n*n], written; must not overlap another argument
 */
void heat_exchanger_jacobian(const double *x,
                             const double *u,
                             const heat_exchanger_parameters *p,
                             double *out);

/*
 * Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient.
 * x[n], read: S_hot [J/K], S_cold [J/K]
 * u[heat_exchanger_input_count], read
 * out[heat_exchanger_output_count], written; must not overlap another argument
 */
void heat_exchanger_outputs(const double *x,
                            const double *u,
                            const heat_exchanger_parameters *p,
                            double *out);

/*
 * Power supplied through each port [W]; the sum is dU/dt.
 * x[n], read: S_hot [J/K], S_cold [J/K]
 * u[heat_exchanger_input_count], read
 * out[heat_exchanger_output_count], written; must not overlap another argument
 */
void heat_exchanger_supply(const double *x,
                           const double *u,
                           const heat_exchanger_parameters *p,
                           double *out);

/*
 * Hamiltonian U [J].
 * x[n], read: S_hot [J/K], S_cold [J/K]
 */
double heat_exchanger_energy(const double *x, const heat_exchanger_parameters *p);

/*
 * Total entropy S [J/K].
 * x[n], read: S_hot [J/K], S_cold [J/K]
 */
double heat_exchanger_entropy(const double *x, const heat_exchanger_parameters *p);

/*
 * Temperature of each body [K].
 * x[n], read: S_hot [J/K], S_cold [J/K]
 * out[heat_exchanger_body_count], written; must not overlap another argument: hot [K], cold
 *     [K]
 */
void heat_exchanger_temperatures(const double *x,
                                 const heat_exchanger_parameters *p,
                                 double *out);

/*
 * Power that each process turns into heat [W]; of a bank, one row per lane.
 * x[n], read: S_hot [J/K], S_cold [J/K]
 * u[heat_exchanger_input_count], read
 * out[heat_exchanger_processes(p)], written; must not overlap another argument
 */
void heat_exchanger_heat(const double *x,
                         const double *u,
                         const heat_exchanger_parameters *p,
                         double *out);

/*
 * Entropy production of each process [W/K], heat exchange with ambients not included; of a
 *     bank, one row per lane.
 * x[n], read: S_hot [J/K], S_cold [J/K]
 * u[heat_exchanger_input_count], read
 * out[heat_exchanger_processes(p)], written; must not overlap another argument
 */
void heat_exchanger_entropy_production(const double *x,
                                       const double *u,
                                       const heat_exchanger_parameters *p,
                                       double *out);

/*
 * Effort, flow, power, energy and heat of elements; of a bank, one row per lane.
 * x[n], read: S_hot [J/K], S_cold [J/K]
 * u[heat_exchanger_input_count], read
 * out[10], written; must not overlap another argument: hot.effort [K], hot.flow [W/K],
 *     hot.power [W], hot.energy [J], cold.effort [K], cold.flow [W/K], cold.power [W],
 *     cold.energy [J], contact.effort [K], contact.power [W]
 */
void heat_exchanger_elements(const double *x,
                             const double *u,
                             const heat_exchanger_parameters *p,
                             double *out);

/*
 * Margin by which each condition of the domain holds; of a bank, the least one.
 * x[n], read: S_hot [J/K], S_cold [J/K]
 * u[heat_exchanger_input_count], read
 * out[heat_exchanger_condition_count], written; must not overlap another argument
 * out[0] >= 0 where lam >= 0
 * out[1] > 0 where T_1 > 0
 * out[2] > 0 where T_2 > 0
 * out[3] > 0 where T_0 > 0
 * out[4] > 0 where c_1 > 0
 * out[5] > 0 where c_2 > 0
 */
void heat_exchanger_margins(const double *x,
                            const double *u,
                            const heat_exchanger_parameters *p,
                            double *out);

#ifdef __cplusplus
}
#endif

#endif /* PIEZO_SYM_heat_exchanger_H */
