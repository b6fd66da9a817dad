/*
 * Peltier cooler: cold plate, thermoelectric couples, heat sink: irreversible port-Hamiltonian system.
 *
 * Source:  Ioffe (1957), Semiconductor Thermoelements; values of a module of 127 couples
 * Model:   peltier_cooler, spec sha256 e97f90f757f77de747011f7a983b38c3f53075a795fa19e001fa2cd5567cc5f1
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, sigma, exergy, environment, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (phi, S_c, S_h)
 * u = (V_in, P, T_e)
 * p = pointer to peltier_cooler_parameters
 */
#ifndef PIEZO_SYM_peltier_cooler_H
#define PIEZO_SYM_peltier_cooler_H

#ifdef __cplusplus
extern "C" {
#endif

/* Parameters in SI units. The caller sets all; comments show the values of the spec. */
typedef struct {
    double s; /* Seebeck coefficient of the module [V/K]; spec: 0.05 */
    double R; /* resistance of the module [ohm]; spec: 2.0 */
    double lam; /* heat conductance of the module [W/K]; spec: 0.5 */
    double L; /* inductance of the leads [H]; spec: 0.001 */
    double c_c; /* heat capacity of the cold plate [J/K]; spec: 20.0 */
    double c_h; /* heat capacity of the heat sink [J/K]; spec: 200.0 */
    double h; /* heat conductance from heat sink to air [W/K]; spec: 50.0 */
    double T_0; /* temperature at the start [K]; spec: 300.0 */
} peltier_cooler_parameters;

/* An initializer for parameters: the values of the spec. */
#define peltier_cooler_DEFAULTS { \
    .s = 0.05, \
    .R = 2.0, \
    .lam = 0.5, \
    .L = 0.001, \
    .c_c = 20.0, \
    .c_h = 200.0, \
    .h = 50.0, \
    .T_0 = 300.0, \
}

/* Numbers of inputs, outputs, thermal bodies and conditions of the domain. */
enum {
    peltier_cooler_input_count = 3,
    peltier_cooler_output_count = 3,
    peltier_cooler_body_count = 2,
    peltier_cooler_condition_count = 8,
};

/*
 * Number of states n.
 */
long peltier_cooler_states(const peltier_cooler_parameters *p);

/*
 * Number of processes, which produce entropy; of a bank, one per lane.
 */
long peltier_cooler_processes(const peltier_cooler_parameters *p);

/*
 * State at t = 0 [SI], for the inputs u at t = 0.
 * u[peltier_cooler_input_count], read: V_in [V], P [W], T_e [K]
 * out[n], written; must not overlap another argument: phi [Wb], S_c [J/K], S_h [J/K]
 */
void peltier_cooler_initial_state(const double *u,
                                  const peltier_cooler_parameters *p,
                                  double *out);

/*
 * Rates dx/dt, the rows of J_ir dU/dx + g u.
 * x[n], read: phi [Wb], S_c [J/K], S_h [J/K]
 * u[peltier_cooler_input_count], read: V_in [V], P [W], T_e [K]
 * out[n], written; must not overlap another argument
 */
void peltier_cooler_rhs(const double *x,
                        const double *u,
                        const peltier_cooler_parameters *p,
                        double *out);

/*
 * Jacobian of rhs, n x n, row after row: d rhs[i]/d x[j] at out[i*n + j].
 * x[n], read: phi [Wb], S_c [J/K], S_h [J/K]
 * u[peltier_cooler_input_count], read: V_in [V], P [W], T_e [K]
 * out[n*n], written; must not overlap another argument
 */
void peltier_cooler_jacobian(const double *x,
                             const double *u,
                             const peltier_cooler_parameters *p,
                             double *out);

/*
 * Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient.
 * x[n], read: phi [Wb], S_c [J/K], S_h [J/K]
 * u[peltier_cooler_input_count], read: V_in [V], P [W], T_e [K]
 * out[peltier_cooler_output_count], written; must not overlap another argument: supply [A],
 *     load [K], air [K]
 */
void peltier_cooler_outputs(const double *x,
                            const double *u,
                            const peltier_cooler_parameters *p,
                            double *out);

/*
 * Power supplied through each port [W]; the sum is dU/dt.
 * x[n], read: phi [Wb], S_c [J/K], S_h [J/K]
 * u[peltier_cooler_input_count], read: V_in [V], P [W], T_e [K]
 * out[peltier_cooler_output_count], written; must not overlap another argument
 */
void peltier_cooler_supply(const double *x,
                           const double *u,
                           const peltier_cooler_parameters *p,
                           double *out);

/*
 * Hamiltonian U [J].
 * x[n], read: phi [Wb], S_c [J/K], S_h [J/K]
 */
double peltier_cooler_energy(const double *x, const peltier_cooler_parameters *p);

/*
 * Total entropy S [J/K].
 * x[n], read: phi [Wb], S_c [J/K], S_h [J/K]
 */
double peltier_cooler_entropy(const double *x, const peltier_cooler_parameters *p);

/*
 * Temperature of each body [K].
 * x[n], read: phi [Wb], S_c [J/K], S_h [J/K]
 * out[peltier_cooler_body_count], written; must not overlap another argument: plate [K], sink
 *     [K]
 */
void peltier_cooler_temperatures(const double *x,
                                 const peltier_cooler_parameters *p,
                                 double *out);

/*
 * Power that each process turns into heat [W]; of a bank, one row per lane.
 * x[n], read: phi [Wb], S_c [J/K], S_h [J/K]
 * u[peltier_cooler_input_count], read: V_in [V], P [W], T_e [K]
 * out[peltier_cooler_processes(p)], written; must not overlap another argument
 */
void peltier_cooler_heat(const double *x,
                         const double *u,
                         const peltier_cooler_parameters *p,
                         double *out);

/*
 * Entropy production of each process [W/K], heat exchange with ambients not included; of a
 *     bank, one row per lane.
 * x[n], read: phi [Wb], S_c [J/K], S_h [J/K]
 * u[peltier_cooler_input_count], read: V_in [V], P [W], T_e [K]
 * out[peltier_cooler_processes(p)], written; must not overlap another argument
 */
void peltier_cooler_entropy_production(const double *x,
                                       const double *u,
                                       const peltier_cooler_parameters *p,
                                       double *out);

/*
 * Effort, flow, power, energy and heat of elements; of a bank, one row per lane.
 * x[n], read: phi [Wb], S_c [J/K], S_h [J/K]
 * u[peltier_cooler_input_count], read: V_in [V], P [W], T_e [K]
 * out[36], written; must not overlap another argument: supply.effort [V], supply.flow [A],
 *     supply.power [W], leads.effort [V], leads.flow [A], leads.power [W], leads.energy [J],
 *     warm.effort [V], warm.flow [A], warm.power [W], warm.heat [W], cool.effort [V],
 *     cool.flow [A], cool.power [W], cool.heat [W], couples.effort_1 [V], couples.flow_1 [A],
 *     couples.effort_2 [K], couples.flow_2 [W/K], couples.power [W], legs.effort [K],
 *     legs.power [W], plate.effort [K], plate.flow [W/K], plate.power [W], plate.energy [J],
 *     sink.effort [K], sink.flow [W/K], sink.power [W], sink.energy [J], load.effort [K],
 *     load.flow [W/K], load.power [W], air.effort [K], air.flow [W/K], air.power [W]
 */
void peltier_cooler_elements(const double *x,
                             const double *u,
                             const peltier_cooler_parameters *p,
                             double *out);

/*
 * Margin by which each condition of the domain holds; of a bank, the least one.
 * x[n], read: phi [Wb], S_c [J/K], S_h [J/K]
 * u[peltier_cooler_input_count], read: V_in [V], P [W], T_e [K]
 * out[peltier_cooler_condition_count], written; must not overlap another argument
 * out[0] >= 0 where R >= 0
 * out[1] >= 0 where lam >= 0
 * out[2] >= 0 where h >= 0
 * out[3] > 0 where T_e > 0
 * out[4] > 0 where L > 0
 * out[5] > 0 where T_0 > 0
 * out[6] > 0 where c_c > 0
 * out[7] > 0 where c_h > 0
 */
void peltier_cooler_margins(const double *x,
                            const double *u,
                            const peltier_cooler_parameters *p,
                            double *out);

#ifdef __cplusplus
}
#endif

#endif /* PIEZO_SYM_peltier_cooler_H */
