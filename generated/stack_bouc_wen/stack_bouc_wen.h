/*
 * Piezoelectric stack with a Bouc-Wen hysteresis of its voltage: irreversible port-Hamiltonian system.
 *
 * Source:  Goldfarb, Celanovic (1997), IEEE Control Systems 17 (3), 69-79; Low, Guo (1995), J. Microelectromech. Syst. 4 (4), 230-237; PiezoDrive SA050536
 * Model:   stack_bouc_wen, spec sha256 cb2f5eb9e9a940796689ce0b466f2aabc3f9c62f14ebd031e4298cc6395703ff
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, continuous, rate-independent, sigma, exergy, environment, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (q, p, Q, Q_h, S)
 * u = (F_ext, V_in, T_e)
 * p_ = pointer to stack_bouc_wen_parameters; the underscore tells it from p, a name of the model
 */
#ifndef PIEZO_SYM_stack_bouc_wen_H
#define PIEZO_SYM_stack_bouc_wen_H

#ifdef __cplusplus
extern "C" {
#endif

/* Parameters in SI units. The caller sets all; comments show the values of the spec. */
typedef struct {
    double m; /* moving mass, 4/pi^2 of the stack's [kg]; spec: 0.0029 */
    double k; /* stiffness [N/m]; spec: 28000000.0 */
    double d; /* damping, a quality of about 30 [N*s/m]; spec: 10.0 */
    double a; /* transducer ratio, 28 N/um times 56 um over 180 V [C/m]; spec: 8.7 */
    double C; /* capacitance of the clamped ceramic: 8 uF in large signals, less a^2/k [F]; spec: 5.3e-06 */
    double C_h; /* capacitance of what slips: in series with 8 uF, 4.3 uF in small signals [F]; spec: 9.3e-06 */
    double V_h; /* voltage at which it slips as fast as charge comes [V]; spec: 10.0 */
    double beta; /* share of the slip that opposes its voltage [1]; spec: 0.6 */
    double gam; /* share of the slip that goes with the current [1]; spec: 0.4 */
    double n; /* how sharply it begins to slip [1]; spec: 1.0 */
    double R; /* resistance of leads and electrodes [ohm]; spec: 2.0 */
    double c_0; /* heat capacity, 7.1 g of 370 J/(kg K) [J/K]; spec: 2.6 */
    double lam; /* heat conductance to the air [W/K]; spec: 0.02 */
    double T_0; /* temperature at the start [K]; spec: 293.15 */
} stack_bouc_wen_parameters;

/* An initializer for parameters: the values of the spec. */
#define stack_bouc_wen_DEFAULTS { \
    .m = 0.0029, \
    .k = 28000000.0, \
    .d = 10.0, \
    .a = 8.7, \
    .C = 5.3e-06, \
    .C_h = 9.3e-06, \
    .V_h = 10.0, \
    .beta = 0.6, \
    .gam = 0.4, \
    .n = 1.0, \
    .R = 2.0, \
    .c_0 = 2.6, \
    .lam = 0.02, \
    .T_0 = 293.15, \
}

/* Numbers of inputs, outputs, thermal bodies and conditions of the domain. */
enum {
    stack_bouc_wen_input_count = 3,
    stack_bouc_wen_output_count = 3,
    stack_bouc_wen_body_count = 1,
    stack_bouc_wen_condition_count = 13,
};

/*
 * Number of states n.
 */
long stack_bouc_wen_states(const stack_bouc_wen_parameters *p_);

/*
 * Number of processes, which produce entropy; of a bank, one per lane.
 */
long stack_bouc_wen_processes(const stack_bouc_wen_parameters *p_);

/*
 * State at t = 0 [SI], for the inputs u at t = 0.
 * u[stack_bouc_wen_input_count], read: F_ext [N], V_in [V], T_e [K]
 * out[n], written; must not overlap another argument: q [m], p [kg*m/s], Q [C], Q_h [C], S
 *     [J/K]
 */
void stack_bouc_wen_initial_state(const double *u,
                                  const stack_bouc_wen_parameters *p_,
                                  double *out);

/*
 * Rates dx/dt, the rows of J_ir dU/dx + g u.
 * x[n], read: q [m], p [kg*m/s], Q [C], Q_h [C], S [J/K]
 * u[stack_bouc_wen_input_count], read: F_ext [N], V_in [V], T_e [K]
 * out[n], written; must not overlap another argument
 */
void stack_bouc_wen_rhs(const double *x,
                        const double *u,
                        const stack_bouc_wen_parameters *p_,
                        double *out);

/*
 * Jacobian of rhs, n x n, row after row: d rhs[i]/d x[j] at out[i*n + j].
 * x[n], read: q [m], p [kg*m/s], Q [C], Q_h [C], S [J/K]
 * u[stack_bouc_wen_input_count], read: F_ext [N], V_in [V], T_e [K]
 * out[n*n], written; must not overlap another argument
 */
void stack_bouc_wen_jacobian(const double *x,
                             const double *u,
                             const stack_bouc_wen_parameters *p_,
                             double *out);

/*
 * Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient.
 * x[n], read: q [m], p [kg*m/s], Q [C], Q_h [C], S [J/K]
 * u[stack_bouc_wen_input_count], read: F_ext [N], V_in [V], T_e [K]
 * out[stack_bouc_wen_output_count], written; must not overlap another argument: load [m/s],
 *     supply [A], ambient [K]
 */
void stack_bouc_wen_outputs(const double *x,
                            const double *u,
                            const stack_bouc_wen_parameters *p_,
                            double *out);

/*
 * Power supplied through each port [W]; the sum is dU/dt.
 * x[n], read: q [m], p [kg*m/s], Q [C], Q_h [C], S [J/K]
 * u[stack_bouc_wen_input_count], read: F_ext [N], V_in [V], T_e [K]
 * out[stack_bouc_wen_output_count], written; must not overlap another argument
 */
void stack_bouc_wen_supply(const double *x,
                           const double *u,
                           const stack_bouc_wen_parameters *p_,
                           double *out);

/*
 * Hamiltonian U [J].
 * x[n], read: q [m], p [kg*m/s], Q [C], Q_h [C], S [J/K]
 */
double stack_bouc_wen_energy(const double *x, const stack_bouc_wen_parameters *p_);

/*
 * Total entropy S [J/K].
 * x[n], read: q [m], p [kg*m/s], Q [C], Q_h [C], S [J/K]
 */
double stack_bouc_wen_entropy(const double *x, const stack_bouc_wen_parameters *p_);

/*
 * Temperature of each body [K].
 * x[n], read: q [m], p [kg*m/s], Q [C], Q_h [C], S [J/K]
 * out[stack_bouc_wen_body_count], written; must not overlap another argument: body [K]
 */
void stack_bouc_wen_temperatures(const double *x,
                                 const stack_bouc_wen_parameters *p_,
                                 double *out);

/*
 * Power that each process turns into heat [W]; of a bank, one row per lane.
 * x[n], read: q [m], p [kg*m/s], Q [C], Q_h [C], S [J/K]
 * u[stack_bouc_wen_input_count], read: F_ext [N], V_in [V], T_e [K]
 * out[stack_bouc_wen_processes(p_)], written; must not overlap another argument
 */
void stack_bouc_wen_heat(const double *x,
                         const double *u,
                         const stack_bouc_wen_parameters *p_,
                         double *out);

/*
 * Entropy production of each process [W/K], heat exchange with ambients not included; of a
 *     bank, one row per lane.
 * x[n], read: q [m], p [kg*m/s], Q [C], Q_h [C], S [J/K]
 * u[stack_bouc_wen_input_count], read: F_ext [N], V_in [V], T_e [K]
 * out[stack_bouc_wen_processes(p_)], written; must not overlap another argument
 */
void stack_bouc_wen_entropy_production(const double *x,
                                       const double *u,
                                       const stack_bouc_wen_parameters *p_,
                                       double *out);

/*
 * Effort, flow, power, energy and heat of elements; of a bank, one row per lane.
 * x[n], read: q [m], p [kg*m/s], Q [C], Q_h [C], S [J/K]
 * u[stack_bouc_wen_input_count], read: F_ext [N], V_in [V], T_e [K]
 * out[43], written; must not overlap another argument: spring.effort [N], spring.flow [m/s],
 *     spring.power [W], spring.energy [J], mass.effort [N], mass.flow [m/s], mass.power [W],
 *     mass.energy [J], damper.effort [N], damper.flow [m/s], damper.power [W], damper.heat
 *     [W], ceramic.effort [V], ceramic.flow [A], ceramic.power [W], ceramic.energy [J],
 *     hysteresis.effort [V], hysteresis.flow [A], hysteresis.power [W], hysteresis.energy [J],
 *     hysteresis.heat [W], transducer.effort_1 [V], transducer.flow_1 [A], transducer.effort_2
 *     [N], transducer.flow_2 [m/s], transducer.power [W], leads.effort [V], leads.flow [A],
 *     leads.power [W], leads.heat [W], body.effort [K], body.flow [W/K], body.power [W],
 *     body.energy [J], ambient.effort [K], ambient.flow [W/K], ambient.power [W], load.effort
 *     [N], load.flow [m/s], load.power [W], supply.effort [V], supply.flow [A], supply.power
 *     [W]
 */
void stack_bouc_wen_elements(const double *x,
                             const double *u,
                             const stack_bouc_wen_parameters *p_,
                             double *out);

/*
 * Margin by which each condition of the domain holds; of a bank, the least one.
 * x[n], read: q [m], p [kg*m/s], Q [C], Q_h [C], S [J/K]
 * u[stack_bouc_wen_input_count], read: F_ext [N], V_in [V], T_e [K]
 * out[stack_bouc_wen_condition_count], written; must not overlap another argument
 * out[0] >= 0 where beta >= abs(gam)
 * out[1] > 0 where n > 0
 * out[2] > 0 where V_h > 0
 * out[3] >= 0 where d >= 0
 * out[4] > 0 where R > 0
 * out[5] >= 0 where lam >= 0
 * out[6] > 0 where T_e > 0
 * out[7] > 0 where k > 0
 * out[8] > 0 where m > 0
 * out[9] > 0 where C > 0
 * out[10] > 0 where C_h > 0
 * out[11] > 0 where T_0 > 0
 * out[12] > 0 where c_0 > 0
 */
void stack_bouc_wen_margins(const double *x,
                            const double *u,
                            const stack_bouc_wen_parameters *p_,
                            double *out);

#ifdef __cplusplus
}
#endif

#endif /* PIEZO_SYM_stack_bouc_wen_H */
