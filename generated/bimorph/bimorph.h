/*
 * Piezoelectric bender: two layers in opposition on one beam: irreversible port-Hamiltonian system.
 *
 * Source:  Smits, Dalke, Cooney (1991), Sensors and Actuators A 28, 41-61; PiezoDrive BA6020
 * Model:   bimorph, spec sha256 e1bdc157e28404f3e3f2a5e6ecbc555574e7dfbd87761b8afc1f5ffdda416572
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, welldef, energy, entropy, passive, odd, sigma, exergy, environment, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (x, p, S, Q_u, Q_l)
 * u = (F, V_b, V, T_e)
 * p_ = pointer to bimorph_parameters; the underscore tells it from p, a name of the model
 */
#ifndef PIEZO_SYM_bimorph_H
#define PIEZO_SYM_bimorph_H

#ifdef __cplusplus
extern "C" {
#endif

/* Parameters in SI units. The caller sets all; comments show the values of the spec. */
typedef struct {
    double l; /* free length [m]; spec: 0.053 */
    double w; /* width [m]; spec: 0.02 */
    double h; /* thickness of a layer [m]; spec: 0.00026 */
    double s; /* compliance of a layer along the beam [m**2/N]; spec: 2.053e-11 */
    double d; /* piezoelectric coefficient: a layer shortens by d times the field [C/N]; spec: 5.562e-10 */
    double eps; /* permittivity of a layer that is free [F/m]; spec: 4.056e-08 */
    double m; /* mass that moves with the tip [kg]; spec: 0.001618 */
    double b; /* damping, a quality of about 30 [N*s/m]; spec: 0.02 */
    double R; /* resistance of each output of the amplifier [ohm]; spec: 1000.0 */
    double T_0; /* temperature at the start [K]; spec: 293.15 */
    double c_0; /* heat capacity, 5 g of 400 J/(kg K) [J/K]; spec: 2.0 */
    double lam; /* heat conductance to the air [W/K]; spec: 0.02 */
} bimorph_parameters;

/* An initializer for parameters: the values of the spec. */
#define bimorph_DEFAULTS { \
    .l = 0.053, \
    .w = 0.02, \
    .h = 0.00026, \
    .s = 2.053e-11, \
    .d = 5.562e-10, \
    .eps = 4.056e-08, \
    .m = 0.001618, \
    .b = 0.02, \
    .R = 1000.0, \
    .T_0 = 293.15, \
    .c_0 = 2.0, \
    .lam = 0.02, \
}

/* Numbers of inputs, outputs, thermal bodies and conditions of the domain. */
enum {
    bimorph_input_count = 4,
    bimorph_output_count = 4,
    bimorph_body_count = 1,
    bimorph_condition_count = 13,
};

/*
 * Number of states n.
 */
long bimorph_states(const bimorph_parameters *p_);

/*
 * Number of processes, which produce entropy; of a bank, one per lane.
 */
long bimorph_processes(const bimorph_parameters *p_);

/*
 * State at t = 0 [SI], for the inputs u at t = 0.
 * u[bimorph_input_count], read: F [N], V_b [V], V [V], T_e [K]
 * out[n], written; must not overlap another argument: x [m], p [kg*m/s], S [J/K], Q_u [C], Q_l
 *     [C]
 */
void bimorph_initial_state(const double *u, const bimorph_parameters *p_, double *out);

/*
 * Rates dx/dt, the rows of J_ir dU/dx + g u.
 * x_[n], read: x [m], p [kg*m/s], S [J/K], Q_u [C], Q_l [C]
 * u[bimorph_input_count], read: F [N], V_b [V], V [V], T_e [K]
 * out[n], written; must not overlap another argument
 */
void bimorph_rhs(const double *x_, const double *u, const bimorph_parameters *p_, double *out);

/*
 * Jacobian of rhs, n x n, row after row: d rhs[i]/d x[j] at out[i*n + j].
 * x_[n], read: x [m], p [kg*m/s], S [J/K], Q_u [C], Q_l [C]
 * u[bimorph_input_count], read: F [N], V_b [V], V [V], T_e [K]
 * out[n*n], written; must not overlap another argument
 */
void bimorph_jacobian(const double *x_,
                      const double *u,
                      const bimorph_parameters *p_,
                      double *out);

/*
 * Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient.
 * x_[n], read: x [m], p [kg*m/s], S [J/K], Q_u [C], Q_l [C]
 * u[bimorph_input_count], read: F [N], V_b [V], V [V], T_e [K]
 * out[bimorph_output_count], written; must not overlap another argument: load [m/s], bias [A],
 *     supply [A], air [K]
 */
void bimorph_outputs(const double *x_,
                     const double *u,
                     const bimorph_parameters *p_,
                     double *out);

/*
 * Power supplied through each port [W]; the sum is dU/dt.
 * x_[n], read: x [m], p [kg*m/s], S [J/K], Q_u [C], Q_l [C]
 * u[bimorph_input_count], read: F [N], V_b [V], V [V], T_e [K]
 * out[bimorph_output_count], written; must not overlap another argument
 */
void bimorph_supply(const double *x_,
                    const double *u,
                    const bimorph_parameters *p_,
                    double *out);

/*
 * Hamiltonian U [J].
 * x_[n], read: x [m], p [kg*m/s], S [J/K], Q_u [C], Q_l [C]
 */
double bimorph_energy(const double *x_, const bimorph_parameters *p_);

/*
 * Total entropy S [J/K].
 * x_[n], read: x [m], p [kg*m/s], S [J/K], Q_u [C], Q_l [C]
 */
double bimorph_entropy(const double *x_, const bimorph_parameters *p_);

/*
 * Temperature of each body [K].
 * x_[n], read: x [m], p [kg*m/s], S [J/K], Q_u [C], Q_l [C]
 * out[bimorph_body_count], written; must not overlap another argument: beam [K]
 */
void bimorph_temperatures(const double *x_, const bimorph_parameters *p_, double *out);

/*
 * Power that each process turns into heat [W]; of a bank, one row per lane.
 * x_[n], read: x [m], p [kg*m/s], S [J/K], Q_u [C], Q_l [C]
 * u[bimorph_input_count], read: F [N], V_b [V], V [V], T_e [K]
 * out[bimorph_processes(p_)], written; must not overlap another argument
 */
void bimorph_heat(const double *x_, const double *u, const bimorph_parameters *p_, double *out);

/*
 * Entropy production of each process [W/K], heat exchange with ambients not included; of a
 *     bank, one row per lane.
 * x_[n], read: x [m], p [kg*m/s], S [J/K], Q_u [C], Q_l [C]
 * u[bimorph_input_count], read: F [N], V_b [V], V [V], T_e [K]
 * out[bimorph_processes(p_)], written; must not overlap another argument
 */
void bimorph_entropy_production(const double *x_,
                                const double *u,
                                const bimorph_parameters *p_,
                                double *out);

/*
 * Effort, flow, power, energy and heat of elements; of a bank, one row per lane.
 * x_[n], read: x [m], p [kg*m/s], S [J/K], Q_u [C], Q_l [C]
 * u[bimorph_input_count], read: F [N], V_b [V], V [V], T_e [K]
 * out[52], written; must not overlap another argument: bias.effort [V], bias.flow [A],
 *     bias.power [W], supply.effort [V], supply.flow [A], supply.power [W], output.effort [V],
 *     output.flow [A], output.power [W], output.heat [W], input.effort [V], input.flow [A],
 *     input.power [W], input.heat [W], upper.effort_1 [V], upper.flow_1 [A], upper.effort_2
 *     [N], upper.flow_2 [m/s], upper.power [W], lower.effort_1 [V], lower.flow_1 [A],
 *     lower.effort_2 [N], lower.flow_2 [m/s], lower.power [W], bending.effort [N],
 *     bending.flow [m/s], bending.power [W], bending.energy [J], tip.effort [N], tip.flow
 *     [m/s], tip.power [W], tip.energy [J], losses.effort [N], losses.flow [m/s], losses.power
 *     [W], losses.heat [W], load.effort [N], load.flow [m/s], load.power [W], beam.effort [K],
 *     beam.flow [W/K], beam.power [W], beam.energy [J], air.effort [K], air.flow [W/K],
 *     air.power [W], layers.effort_Q_u [V], layers.flow_Q_u [A], layers.effort_Q_l [V],
 *     layers.flow_Q_l [A], layers.power [W], layers.energy [J]
 */
void bimorph_elements(const double *x_,
                      const double *u,
                      const bimorph_parameters *p_,
                      double *out);

/*
 * Margin by which each condition of the domain holds; of a bank, the least one.
 * x_[n], read: x [m], p [kg*m/s], S [J/K], Q_u [C], Q_l [C]
 * u[bimorph_input_count], read: F [N], V_b [V], V [V], T_e [K]
 * out[bimorph_condition_count], written; must not overlap another argument
 * out[0] > 0 where l > 0
 * out[1] > 0 where w > 0
 * out[2] > 0 where h > 0
 * out[3] > 0 where s > 0
 * out[4] > 0 where 13*d**2 < 16*s*eps
 * out[5] >= 0 where b >= 0
 * out[6] > 0 where R > 0
 * out[7] >= 0 where lam >= 0
 * out[8] > 0 where T_e > 0
 * out[9] > 0 where 2*w*h**3/(s*l**3) > 0
 * out[10] > 0 where m > 0
 * out[11] > 0 where T_0 > 0
 * out[12] > 0 where c_0 > 0
 */
void bimorph_margins(const double *x_,
                     const double *u,
                     const bimorph_parameters *p_,
                     double *out);

#ifdef __cplusplus
}
#endif

#endif /* PIEZO_SYM_bimorph_H */
