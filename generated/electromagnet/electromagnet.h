/*
 * Electromagnet with an armature on a spring, and a coil that warms: irreversible port-Hamiltonian system.
 *
 * Source:  Woodson, Melcher (1968), Electromechanical Dynamics I, ch. 3
 * Model:   electromagnet, spec sha256 9b4244be212754305b836d305b67a8844d9eaeab14c345563f9a22957982c0af
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, sigma, exergy, environment, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (q, p, S, phi, x)
 * u = (V_in, T_e)
 * p_ = pointer to electromagnet_parameters; the underscore tells it from p, a name of the model
 */
#ifndef PIEZO_SYM_electromagnet_H
#define PIEZO_SYM_electromagnet_H

#ifdef __cplusplus
extern "C" {
#endif

/* Parameters in SI units. The caller sets all; comments show the values of the spec. */
typedef struct {
    double g; /* gap at rest [m]; spec: 0.002 */
    double A; /* area of the pole [m**2]; spec: 0.0001 */
    double N; /* turns [1]; spec: 500.0 */
    double mu; /* permeability of the gap [H/m]; spec: 1.25663706e-06 */
    double m; /* mass of the armature [kg]; spec: 0.05 */
    double k; /* stiffness of its spring [N/m]; spec: 5000.0 */
    double d; /* damping [N*s/m]; spec: 3.0 */
    double R; /* resistance of the coil [ohm]; spec: 8.0 */
    double c; /* heat capacity of the coil [J/K]; spec: 20.0 */
    double lam; /* heat conductance to the air [W/K]; spec: 0.3 */
    double T_0; /* temperature at the start [K]; spec: 293.15 */
} electromagnet_parameters;

/* An initializer for parameters: the values of the spec. */
#define electromagnet_DEFAULTS { \
    .g = 0.002, \
    .A = 0.0001, \
    .N = 500.0, \
    .mu = 1.25663706e-06, \
    .m = 0.05, \
    .k = 5000.0, \
    .d = 3.0, \
    .R = 8.0, \
    .c = 20.0, \
    .lam = 0.3, \
    .T_0 = 293.15, \
}

/* Numbers of inputs, outputs, thermal bodies and conditions of the domain. */
enum {
    electromagnet_input_count = 2,
    electromagnet_output_count = 2,
    electromagnet_body_count = 1,
    electromagnet_condition_count = 12,
};

/*
 * Number of states n.
 */
long electromagnet_states(const electromagnet_parameters *p_);

/*
 * Number of processes, which produce entropy; of a bank, one per lane.
 */
long electromagnet_processes(const electromagnet_parameters *p_);

/*
 * State at t = 0 [SI], for the inputs u at t = 0.
 * u[electromagnet_input_count], read: V_in [V], T_e [K]
 * out[n], written; must not overlap another argument: q [m], p [kg*m/s], S [J/K], phi [Wb], x
 *     [m]
 */
void electromagnet_initial_state(const double *u,
                                 const electromagnet_parameters *p_,
                                 double *out);

/*
 * Rates dx/dt, the rows of J_ir dU/dx + g u.
 * x_[n], read: q [m], p [kg*m/s], S [J/K], phi [Wb], x [m]
 * u[electromagnet_input_count], read: V_in [V], T_e [K]
 * out[n], written; must not overlap another argument
 */
void electromagnet_rhs(const double *x_,
                       const double *u,
                       const electromagnet_parameters *p_,
                       double *out);

/*
 * Jacobian of rhs, n x n, row after row: d rhs[i]/d x[j] at out[i*n + j].
 * x_[n], read: q [m], p [kg*m/s], S [J/K], phi [Wb], x [m]
 * u[electromagnet_input_count], read: V_in [V], T_e [K]
 * out[n*n], written; must not overlap another argument
 */
void electromagnet_jacobian(const double *x_,
                            const double *u,
                            const electromagnet_parameters *p_,
                            double *out);

/*
 * Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient.
 * x_[n], read: q [m], p [kg*m/s], S [J/K], phi [Wb], x [m]
 * u[electromagnet_input_count], read: V_in [V], T_e [K]
 * out[electromagnet_output_count], written; must not overlap another argument: supply [A], air
 *     [K]
 */
void electromagnet_outputs(const double *x_,
                           const double *u,
                           const electromagnet_parameters *p_,
                           double *out);

/*
 * Power supplied through each port [W]; the sum is dU/dt.
 * x_[n], read: q [m], p [kg*m/s], S [J/K], phi [Wb], x [m]
 * u[electromagnet_input_count], read: V_in [V], T_e [K]
 * out[electromagnet_output_count], written; must not overlap another argument
 */
void electromagnet_supply(const double *x_,
                          const double *u,
                          const electromagnet_parameters *p_,
                          double *out);

/*
 * Hamiltonian U [J].
 * x_[n], read: q [m], p [kg*m/s], S [J/K], phi [Wb], x [m]
 */
double electromagnet_energy(const double *x_, const electromagnet_parameters *p_);

/*
 * Total entropy S [J/K].
 * x_[n], read: q [m], p [kg*m/s], S [J/K], phi [Wb], x [m]
 */
double electromagnet_entropy(const double *x_, const electromagnet_parameters *p_);

/*
 * Temperature of each body [K].
 * x_[n], read: q [m], p [kg*m/s], S [J/K], phi [Wb], x [m]
 * out[electromagnet_body_count], written; must not overlap another argument: winding [K]
 */
void electromagnet_temperatures(const double *x_,
                                const electromagnet_parameters *p_,
                                double *out);

/*
 * Power that each process turns into heat [W]; of a bank, one row per lane.
 * x_[n], read: q [m], p [kg*m/s], S [J/K], phi [Wb], x [m]
 * u[electromagnet_input_count], read: V_in [V], T_e [K]
 * out[electromagnet_processes(p_)], written; must not overlap another argument
 */
void electromagnet_heat(const double *x_,
                        const double *u,
                        const electromagnet_parameters *p_,
                        double *out);

/*
 * Entropy production of each process [W/K], heat exchange with ambients not included; of a
 *     bank, one row per lane.
 * x_[n], read: q [m], p [kg*m/s], S [J/K], phi [Wb], x [m]
 * u[electromagnet_input_count], read: V_in [V], T_e [K]
 * out[electromagnet_processes(p_)], written; must not overlap another argument
 */
void electromagnet_entropy_production(const double *x_,
                                      const double *u,
                                      const electromagnet_parameters *p_,
                                      double *out);

/*
 * Effort, flow, power, energy and heat of elements; of a bank, one row per lane.
 * x_[n], read: q [m], p [kg*m/s], S [J/K], phi [Wb], x [m]
 * u[electromagnet_input_count], read: V_in [V], T_e [K]
 * out[32], written; must not overlap another argument: supply.effort [V], supply.flow [A],
 *     supply.power [W], copper.effort [V], copper.flow [A], copper.power [W], copper.heat [W],
 *     spring.effort [N], spring.flow [m/s], spring.power [W], spring.energy [J],
 *     armature.effort [N], armature.flow [m/s], armature.power [W], armature.energy [J],
 *     friction.effort [N], friction.flow [m/s], friction.power [W], friction.heat [W],
 *     winding.effort [K], winding.flow [W/K], winding.power [W], winding.energy [J],
 *     air.effort [K], air.flow [W/K], air.power [W], magnet.effort_phi [V], magnet.flow_phi
 *     [A], magnet.effort_x [N], magnet.flow_x [m/s], magnet.power [W], magnet.energy [J]
 */
void electromagnet_elements(const double *x_,
                            const double *u,
                            const electromagnet_parameters *p_,
                            double *out);

/*
 * Margin by which each condition of the domain holds; of a bank, the least one.
 * x_[n], read: q [m], p [kg*m/s], S [J/K], phi [Wb], x [m]
 * u[electromagnet_input_count], read: V_in [V], T_e [K]
 * out[electromagnet_condition_count], written; must not overlap another argument
 * out[0] > 0 where g + x > 0
 * out[1] > 0 where A > 0
 * out[2] > 0 where N > 0
 * out[3] > 0 where mu > 0
 * out[4] >= 0 where d >= 0
 * out[5] >= 0 where R >= 0
 * out[6] >= 0 where lam >= 0
 * out[7] > 0 where T_e > 0
 * out[8] > 0 where k > 0
 * out[9] > 0 where m > 0
 * out[10] > 0 where T_0 > 0
 * out[11] > 0 where c > 0
 */
void electromagnet_margins(const double *x_,
                           const double *u,
                           const electromagnet_parameters *p_,
                           double *out);

#ifdef __cplusplus
}
#endif

#endif /* PIEZO_SYM_electromagnet_H */
