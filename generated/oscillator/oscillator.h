/*
 * Damped oscillator that heats itself: irreversible port-Hamiltonian system.
 *
 * Source:  Ramirez, Maschke, Sbarbaro (2013), Eur. J. Control 19, 513-520, the mass-spring-damper
 * Model:   oscillator, spec sha256 98f74415ae4d927ffd7693687e1755d27c6ee4baa18ca60809e3c3d10d605268
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, sigma, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (q, p, S)
 * u = (F)
 * p_ = pointer to oscillator_parameters; the underscore tells it from p, a name of the model
 */
#ifndef PIEZO_SYM_oscillator_H
#define PIEZO_SYM_oscillator_H

#ifdef __cplusplus
extern "C" {
#endif

/* Parameters in SI units. The caller sets all; comments show the values of the spec. */
typedef struct {
    double m; /* mass [kg]; spec: 1.0 */
    double k; /* stiffness [N/m]; spec: 4.0 */
    double d; /* damping [N*s/m]; spec: 0.4 */
    double T_0; /* temperature at the start [K]; spec: 300.0 */
    double c; /* heat capacity [J/K]; spec: 2.0 */
} oscillator_parameters;

/* An initializer for parameters: the values of the spec. */
#define oscillator_DEFAULTS { \
    .m = 1.0, \
    .k = 4.0, \
    .d = 0.4, \
    .T_0 = 300.0, \
    .c = 2.0, \
}

/* Numbers of inputs, outputs, thermal bodies and conditions of the domain. */
enum {
    oscillator_input_count = 1,
    oscillator_output_count = 1,
    oscillator_body_count = 1,
    oscillator_condition_count = 5,
};

/*
 * Number of states n.
 */
long oscillator_states(const oscillator_parameters *p_);

/*
 * Number of processes, which produce entropy; of a bank, one per lane.
 */
long oscillator_processes(const oscillator_parameters *p_);

/*
 * State at t = 0 [SI], for the inputs u at t = 0.
 * u[oscillator_input_count], read: F [N]
 * out[n], written; must not overlap another argument: q [m], p [kg*m/s], S [J/K]
 */
void oscillator_initial_state(const double *u, const oscillator_parameters *p_, double *out);

/*
 * Rates dx/dt, the rows of J_ir dU/dx + g u.
 * x[n], read: q [m], p [kg*m/s], S [J/K]
 * u[oscillator_input_count], read: F [N]
 * out[n], written; must not overlap another argument
 */
void oscillator_rhs(const double *x,
                    const double *u,
                    const oscillator_parameters *p_,
                    double *out);

/*
 * Jacobian of rhs, n x n, row after row: d rhs[i]/d x[j] at out[i*n + j].
 * x[n], read: q [m], p [kg*m/s], S [J/K]
 * u[oscillator_input_count], read: F [N]
 * out[n*n], written; must not overlap another argument
 */
void oscillator_jacobian(const double *x,
                         const double *u,
                         const oscillator_parameters *p_,
                         double *out);

/*
 * Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient.
 * x[n], read: q [m], p [kg*m/s], S [J/K]
 * u[oscillator_input_count], read: F [N]
 * out[oscillator_output_count], written; must not overlap another argument: hand [m/s]
 */
void oscillator_outputs(const double *x,
                        const double *u,
                        const oscillator_parameters *p_,
                        double *out);

/*
 * Power supplied through each port [W]; the sum is dU/dt.
 * x[n], read: q [m], p [kg*m/s], S [J/K]
 * u[oscillator_input_count], read: F [N]
 * out[oscillator_output_count], written; must not overlap another argument
 */
void oscillator_supply(const double *x,
                       const double *u,
                       const oscillator_parameters *p_,
                       double *out);

/*
 * Hamiltonian U [J].
 * x[n], read: q [m], p [kg*m/s], S [J/K]
 */
double oscillator_energy(const double *x, const oscillator_parameters *p_);

/*
 * Total entropy S [J/K].
 * x[n], read: q [m], p [kg*m/s], S [J/K]
 */
double oscillator_entropy(const double *x, const oscillator_parameters *p_);

/*
 * Temperature of each body [K].
 * x[n], read: q [m], p [kg*m/s], S [J/K]
 * out[oscillator_body_count], written; must not overlap another argument: body [K]
 */
void oscillator_temperatures(const double *x, const oscillator_parameters *p_, double *out);

/*
 * Power that each process turns into heat [W]; of a bank, one row per lane.
 * x[n], read: q [m], p [kg*m/s], S [J/K]
 * u[oscillator_input_count], read: F [N]
 * out[oscillator_processes(p_)], written; must not overlap another argument
 */
void oscillator_heat(const double *x,
                     const double *u,
                     const oscillator_parameters *p_,
                     double *out);

/*
 * Entropy production of each process [W/K], heat exchange with ambients not included; of a
 *     bank, one row per lane.
 * x[n], read: q [m], p [kg*m/s], S [J/K]
 * u[oscillator_input_count], read: F [N]
 * out[oscillator_processes(p_)], written; must not overlap another argument
 */
void oscillator_entropy_production(const double *x,
                                   const double *u,
                                   const oscillator_parameters *p_,
                                   double *out);

/*
 * Effort, flow, power, energy and heat of elements; of a bank, one row per lane.
 * x[n], read: q [m], p [kg*m/s], S [J/K]
 * u[oscillator_input_count], read: F [N]
 * out[19], written; must not overlap another argument: spring.effort [N], spring.flow [m/s],
 *     spring.power [W], spring.energy [J], mass.effort [N], mass.flow [m/s], mass.power [W],
 *     mass.energy [J], damper.effort [N], damper.flow [m/s], damper.power [W], damper.heat
 *     [W], body.effort [K], body.flow [W/K], body.power [W], body.energy [J], hand.effort [N],
 *     hand.flow [m/s], hand.power [W]
 */
void oscillator_elements(const double *x,
                         const double *u,
                         const oscillator_parameters *p_,
                         double *out);

/*
 * Margin by which each condition of the domain holds; of a bank, the least one.
 * x[n], read: q [m], p [kg*m/s], S [J/K]
 * u[oscillator_input_count], read: F [N]
 * out[oscillator_condition_count], written; must not overlap another argument
 * out[0] >= 0 where d >= 0
 * out[1] > 0 where k > 0
 * out[2] > 0 where m > 0
 * out[3] > 0 where T_0 > 0
 * out[4] > 0 where c > 0
 */
void oscillator_margins(const double *x,
                        const double *u,
                        const oscillator_parameters *p_,
                        double *out);

#ifdef __cplusplus
}
#endif

#endif /* PIEZO_SYM_oscillator_H */
