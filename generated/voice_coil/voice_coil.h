/*
 * Voice coil of a loudspeaker, with the heat of its winding: irreversible port-Hamiltonian system.
 *
 * Source:  Small (1972), J. Audio Eng. Soc. 20 (5), 383-395; values of a 165 mm driver
 * Model:   voice_coil, spec sha256 b17a1309ca30712ebd0993cb3dcdd961cc3539b78aa3f80bce5bbdfa54c8bfcf
 * System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
 *          rows, multiplied out; `piezo-sym show` prints the matrices
 * Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, sigma, exergy, environment, units, program PROVED
 *          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
 *          parameters in the domain, and for banks of any size)
 *
 * Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
 * C99; values are in SI units; build with -O3 -fopenmp-simd -fno-math-errno.
 *
 * x = (q, p, phi, S_w, S_m)
 * u = (V_in, T_e)
 * p_ = pointer to voice_coil_parameters; the underscore tells it from p, a name of the model
 */
#ifndef PIEZO_SYM_voice_coil_H
#define PIEZO_SYM_voice_coil_H

#ifdef __cplusplus
extern "C" {
#endif

/* Parameters in SI units. The caller sets all; comments show the values of the spec. */
typedef struct {
    double m; /* moving mass [kg]; spec: 0.014 */
    double k; /* stiffness of the suspension [N/m]; spec: 1100.0 */
    double d; /* damping of the suspension [N*s/m]; spec: 1.2 */
    double Bl; /* force factor [N/A]; spec: 6.5 */
    double R_0; /* resistance of the winding at T_0 [ohm]; spec: 5.6 */
    double al; /* temperature coefficient of copper [1/K]; spec: 0.00393 */
    double L; /* inductance of the winding [H]; spec: 0.0005 */
    double c_w; /* heat capacity of the winding [J/K]; spec: 4.0 */
    double c_m; /* heat capacity of the magnet and the frame [J/K]; spec: 400.0 */
    double lam; /* heat conductance from winding to magnet [W/K]; spec: 0.4 */
    double h; /* heat conductance from magnet to air [W/K]; spec: 0.5 */
    double T_0; /* temperature at the start [K]; spec: 293.15 */
} voice_coil_parameters;

/* An initializer for parameters: the values of the spec. */
#define voice_coil_DEFAULTS { \
    .m = 0.014, \
    .k = 1100.0, \
    .d = 1.2, \
    .Bl = 6.5, \
    .R_0 = 5.6, \
    .al = 0.00393, \
    .L = 0.0005, \
    .c_w = 4.0, \
    .c_m = 400.0, \
    .lam = 0.4, \
    .h = 0.5, \
    .T_0 = 293.15, \
}

/* Numbers of inputs, outputs, thermal bodies and conditions of the domain. */
enum {
    voice_coil_input_count = 2,
    voice_coil_output_count = 2,
    voice_coil_body_count = 2,
    voice_coil_condition_count = 13,
};

/*
 * Number of states n.
 */
long voice_coil_states(const voice_coil_parameters *p_);

/*
 * Number of processes, which produce entropy; of a bank, one per lane.
 */
long voice_coil_processes(const voice_coil_parameters *p_);

/*
 * State at t = 0 [SI], for the inputs u at t = 0.
 * u[voice_coil_input_count], read: V_in [V], T_e [K]
 * out[n], written; must not overlap another argument: q [m], p [kg*m/s], phi [Wb], S_w [J/K],
 *     S_m [J/K]
 */
void voice_coil_initial_state(const double *u, const voice_coil_parameters *p_, double *out);

/*
 * Rates dx/dt, the rows of J_ir dU/dx + g u.
 * x[n], read: q [m], p [kg*m/s], phi [Wb], S_w [J/K], S_m [J/K]
 * u[voice_coil_input_count], read: V_in [V], T_e [K]
 * out[n], written; must not overlap another argument
 */
void voice_coil_rhs(const double *x,
                    const double *u,
                    const voice_coil_parameters *p_,
                    double *out);

/*
 * Jacobian of rhs, n x n, row after row: d rhs[i]/d x[j] at out[i*n + j].
 * x[n], read: q [m], p [kg*m/s], phi [Wb], S_w [J/K], S_m [J/K]
 * u[voice_coil_input_count], read: V_in [V], T_e [K]
 * out[n*n], written; must not overlap another argument
 */
void voice_coil_jacobian(const double *x,
                         const double *u,
                         const voice_coil_parameters *p_,
                         double *out);

/*
 * Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient.
 * x[n], read: q [m], p [kg*m/s], phi [Wb], S_w [J/K], S_m [J/K]
 * u[voice_coil_input_count], read: V_in [V], T_e [K]
 * out[voice_coil_output_count], written; must not overlap another argument: amplifier [A], air
 *     [K]
 */
void voice_coil_outputs(const double *x,
                        const double *u,
                        const voice_coil_parameters *p_,
                        double *out);

/*
 * Power supplied through each port [W]; the sum is dU/dt.
 * x[n], read: q [m], p [kg*m/s], phi [Wb], S_w [J/K], S_m [J/K]
 * u[voice_coil_input_count], read: V_in [V], T_e [K]
 * out[voice_coil_output_count], written; must not overlap another argument
 */
void voice_coil_supply(const double *x,
                       const double *u,
                       const voice_coil_parameters *p_,
                       double *out);

/*
 * Hamiltonian U [J].
 * x[n], read: q [m], p [kg*m/s], phi [Wb], S_w [J/K], S_m [J/K]
 */
double voice_coil_energy(const double *x, const voice_coil_parameters *p_);

/*
 * Total entropy S [J/K].
 * x[n], read: q [m], p [kg*m/s], phi [Wb], S_w [J/K], S_m [J/K]
 */
double voice_coil_entropy(const double *x, const voice_coil_parameters *p_);

/*
 * Temperature of each body [K].
 * x[n], read: q [m], p [kg*m/s], phi [Wb], S_w [J/K], S_m [J/K]
 * out[voice_coil_body_count], written; must not overlap another argument: winding [K], magnet
 *     [K]
 */
void voice_coil_temperatures(const double *x, const voice_coil_parameters *p_, double *out);

/*
 * Power that each process turns into heat [W]; of a bank, one row per lane.
 * x[n], read: q [m], p [kg*m/s], phi [Wb], S_w [J/K], S_m [J/K]
 * u[voice_coil_input_count], read: V_in [V], T_e [K]
 * out[voice_coil_processes(p_)], written; must not overlap another argument
 */
void voice_coil_heat(const double *x,
                     const double *u,
                     const voice_coil_parameters *p_,
                     double *out);

/*
 * Entropy production of each process [W/K], heat exchange with ambients not included; of a
 *     bank, one row per lane.
 * x[n], read: q [m], p [kg*m/s], phi [Wb], S_w [J/K], S_m [J/K]
 * u[voice_coil_input_count], read: V_in [V], T_e [K]
 * out[voice_coil_processes(p_)], written; must not overlap another argument
 */
void voice_coil_entropy_production(const double *x,
                                   const double *u,
                                   const voice_coil_parameters *p_,
                                   double *out);

/*
 * Effort, flow, power, energy and heat of elements; of a bank, one row per lane.
 * x[n], read: q [m], p [kg*m/s], phi [Wb], S_w [J/K], S_m [J/K]
 * u[voice_coil_input_count], read: V_in [V], T_e [K]
 * out[41], written; must not overlap another argument: suspension.effort [N], suspension.flow
 *     [m/s], suspension.power [W], suspension.energy [J], cone.effort [N], cone.flow [m/s],
 *     cone.power [W], cone.energy [J], losses.effort [N], losses.flow [m/s], losses.power [W],
 *     losses.heat [W], coil.effort [V], coil.flow [A], coil.power [W], coil.energy [J],
 *     copper.effort [V], copper.flow [A], copper.power [W], copper.heat [W], gap.effort_1 [V],
 *     gap.flow_1 [A], gap.effort_2 [N], gap.flow_2 [m/s], gap.power [W], winding.effort [K],
 *     winding.flow [W/K], winding.power [W], winding.energy [J], magnet.effort [K],
 *     magnet.flow [W/K], magnet.power [W], magnet.energy [J], contact.effort [K],
 *     contact.power [W], air.effort [K], air.flow [W/K], air.power [W], amplifier.effort [V],
 *     amplifier.flow [A], amplifier.power [W]
 */
void voice_coil_elements(const double *x,
                         const double *u,
                         const voice_coil_parameters *p_,
                         double *out);

/*
 * Margin by which each condition of the domain holds; of a bank, the least one.
 * x[n], read: q [m], p [kg*m/s], phi [Wb], S_w [J/K], S_m [J/K]
 * u[voice_coil_input_count], read: V_in [V], T_e [K]
 * out[voice_coil_condition_count], written; must not overlap another argument
 * out[0] >= 0 where d >= 0
 * out[1] >= 0 where R_0 >= 0
 * out[2] >= 0 where al >= 0
 * out[3] >= 0 where lam >= 0
 * out[4] >= 0 where h >= 0
 * out[5] > 0 where 1 + al*(T_winding - T_0) > 0
 * out[6] > 0 where T_e > 0
 * out[7] > 0 where k > 0
 * out[8] > 0 where m > 0
 * out[9] > 0 where L > 0
 * out[10] > 0 where T_0 > 0
 * out[11] > 0 where c_w > 0
 * out[12] > 0 where c_m > 0
 */
void voice_coil_margins(const double *x,
                        const double *u,
                        const voice_coil_parameters *p_,
                        double *out);

#ifdef __cplusplus
}
#endif

#endif /* PIEZO_SYM_voice_coil_H */
