/*
 * Series RLC circuit with a thermistor: irreversible port-Hamiltonian system.
 *
 * Source:  Becker, Green, Pearson (1946), Bell Syst. Tech. J. 26, 170-212, R = R_0 exp(B (1/T - 1/T_0))
 * Model:   thermistor, spec sha256 b3ce3439410245bed29fbaef5d338f6c046728146ec30a1b29ddd4240ea71ae0
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, sigma, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (phi, Q, S)
 * u = ()
 * p = pointer to thermistor_parameters
 */
#ifndef PIEZO_SYM_thermistor_H
#define PIEZO_SYM_thermistor_H

#ifdef __cplusplus
extern "C" {
#endif

/* Parameters in SI units. The caller sets all; comments show the values of the spec. */
typedef struct {
    double L; /* inductance [H]; spec: 0.05 */
    double C; /* capacitance [F]; spec: 2e-06 */
    double R_0; /* resistance at T_0 [ohm]; spec: 1000.0 */
    double B; /* how steeply the resistance falls [K]; spec: 3000.0 */
    double c; /* heat capacity of the bead [J/K]; spec: 1e-06 */
    double T_0; /* temperature at the start [K]; spec: 300.0 */
} thermistor_parameters;

/* An initializer for parameters: the values of the spec. */
#define thermistor_DEFAULTS { \
    .L = 0.05, \
    .C = 2e-06, \
    .R_0 = 1000.0, \
    .B = 3000.0, \
    .c = 1e-06, \
    .T_0 = 300.0, \
}

/* Numbers of inputs, outputs, thermal bodies and conditions of the domain. */
enum {
    thermistor_input_count = 0,
    thermistor_output_count = 0,
    thermistor_body_count = 1,
    thermistor_condition_count = 5,
};

/*
 * Number of states n.
 */
long thermistor_states(const thermistor_parameters *p);

/*
 * Number of processes, which produce entropy; of a bank, one per lane.
 */
long thermistor_processes(const thermistor_parameters *p);

/*
 * State at t = 0 [SI], for the inputs u at t = 0.
 * u[thermistor_input_count], read
 * out[n], written; must not overlap another argument: phi [Wb], Q [C], S [J/K]
 */
void thermistor_initial_state(const double *u, const thermistor_parameters *p, double *out);

/*
 * Rates dx/dt, the rows of J_ir dU/dx + g u.
 * x[n], read: phi [Wb], Q [C], S [J/K]
 * u[thermistor_input_count], read
 * out[n], written; must not overlap another argument
 */
void thermistor_rhs(const double *x,
                    const double *u,
                    const thermistor_parameters *p,
                    double *out);

/*
 * Jacobian of rhs, n x n, row after row: d rhs[i]/d x[j] at out[i*n + j].
 * x[n], read: phi [Wb], Q [C], S [J/K]
 * u[thermistor_input_count], read
 * out[n*n], written; must not overlap another argument
 */
void thermistor_jacobian(const double *x,
                         const double *u,
                         const thermistor_parameters *p,
                         double *out);

/*
 * Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient.
 * x[n], read: phi [Wb], Q [C], S [J/K]
 * u[thermistor_input_count], read
 * out[thermistor_output_count], written; must not overlap another argument
 */
void thermistor_outputs(const double *x,
                        const double *u,
                        const thermistor_parameters *p,
                        double *out);

/*
 * Power supplied through each port [W]; the sum is dU/dt.
 * x[n], read: phi [Wb], Q [C], S [J/K]
 * u[thermistor_input_count], read
 * out[thermistor_output_count], written; must not overlap another argument
 */
void thermistor_supply(const double *x,
                       const double *u,
                       const thermistor_parameters *p,
                       double *out);

/*
 * Hamiltonian U [J].
 * x[n], read: phi [Wb], Q [C], S [J/K]
 */
double thermistor_energy(const double *x, const thermistor_parameters *p);

/*
 * Total entropy S [J/K].
 * x[n], read: phi [Wb], Q [C], S [J/K]
 */
double thermistor_entropy(const double *x, const thermistor_parameters *p);

/*
 * Temperature of each body [K].
 * x[n], read: phi [Wb], Q [C], S [J/K]
 * out[thermistor_body_count], written; must not overlap another argument: body [K]
 */
void thermistor_temperatures(const double *x, const thermistor_parameters *p, double *out);

/*
 * Power that each process turns into heat [W]; of a bank, one row per lane.
 * x[n], read: phi [Wb], Q [C], S [J/K]
 * u[thermistor_input_count], read
 * out[thermistor_processes(p)], written; must not overlap another argument
 */
void thermistor_heat(const double *x,
                     const double *u,
                     const thermistor_parameters *p,
                     double *out);

/*
 * Entropy production of each process [W/K], heat exchange with ambients not included; of a
 *     bank, one row per lane.
 * x[n], read: phi [Wb], Q [C], S [J/K]
 * u[thermistor_input_count], read
 * out[thermistor_processes(p)], written; must not overlap another argument
 */
void thermistor_entropy_production(const double *x,
                                   const double *u,
                                   const thermistor_parameters *p,
                                   double *out);

/*
 * Effort, flow, power, energy and heat of elements; of a bank, one row per lane.
 * x[n], read: phi [Wb], Q [C], S [J/K]
 * u[thermistor_input_count], read
 * out[16], written; must not overlap another argument: coil.effort [V], coil.flow [A],
 *     coil.power [W], coil.energy [J], cap.effort [V], cap.flow [A], cap.power [W], cap.energy
 *     [J], bead.effort [V], bead.flow [A], bead.power [W], bead.heat [W], body.effort [K],
 *     body.flow [W/K], body.power [W], body.energy [J]
 */
void thermistor_elements(const double *x,
                         const double *u,
                         const thermistor_parameters *p,
                         double *out);

/*
 * Margin by which each condition of the domain holds; of a bank, the least one.
 * x[n], read: phi [Wb], Q [C], S [J/K]
 * u[thermistor_input_count], read
 * out[thermistor_condition_count], written; must not overlap another argument
 * out[0] >= 0 where R_0 >= 0
 * out[1] > 0 where L > 0
 * out[2] > 0 where C > 0
 * out[3] > 0 where T_0 > 0
 * out[4] > 0 where c > 0
 */
void thermistor_margins(const double *x,
                        const double *u,
                        const thermistor_parameters *p,
                        double *out);

#ifdef __cplusplus
}
#endif

#endif /* PIEZO_SYM_thermistor_H */
