"""Piezoelectric stack of 3 layers that conduct heat: irreversible port-Hamiltonian system.

Source:  Caballeria, Ramirez, Le Gorrec (2021), eqs. (9)-(13), Table 1, cut into layers; conductance between them: a choice
Model:   layered_stack, spec sha256 b46e92f413d7be38d2b0d17c8e7e220000a9ea90d48a027e94b79d81ff92ba5e
System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
         rows, multiplied out; `piezo-sym show` prints the matrices
Proofs:  skew, casimir, temperature, energy, entropy, welldef, continuous, passive, odd, sigma, exergy, environment, invariant, units, program PROVED
         (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
         parameters in the domain, and for banks of any size)

Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
Arrays have shape (n, *batch); values are in SI units.

x = (q_1, p_1, Q_1, phi_1, S_1, q_2, p_2, Q_2, phi_2, S_2, q_3, p_3, Q_3, phi_3, S_3)
u = (F_ext, V_in, T_e)
p = Parameters()
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

NAME = "layered_stack"
SPEC_SHA256 = "b46e92f413d7be38d2b0d17c8e7e220000a9ea90d48a027e94b79d81ff92ba5e"


class Record(NamedTuple):
    """One row of an array, or of a bank one row per lane: its name, SI unit and meaning."""

    name: str
    unit: str
    doc: str
    bank: str | None = None


class Condition(NamedTuple):
    """A condition of the domain: its margin is > 0 inside, or >= 0 if it is not strict."""

    text: str
    strict: bool


# rows of x; rows of u, and their default values
STATES = (
    Record("q_1", "m", "extension of spring 'spring_1'"),
    Record("p_1", "kg*m/s", "momentum of mass 'mass_1'"),
    Record("Q_1", "C", "charge of capacitor 'capacitor_1'"),
    Record("phi_1", "Wb", "flux linkage of hysteron 'hysteron_1'"),
    Record("S_1", "J/K", "entropy of thermal_mass 'body_1'"),
    Record("q_2", "m", "extension of spring 'spring_2'"),
    Record("p_2", "kg*m/s", "momentum of mass 'mass_2'"),
    Record("Q_2", "C", "charge of capacitor 'capacitor_2'"),
    Record("phi_2", "Wb", "flux linkage of hysteron 'hysteron_2'"),
    Record("S_2", "J/K", "entropy of thermal_mass 'body_2'"),
    Record("q_3", "m", "extension of spring 'spring_3'"),
    Record("p_3", "kg*m/s", "momentum of mass 'mass_3'"),
    Record("Q_3", "C", "charge of capacitor 'capacitor_3'"),
    Record("phi_3", "Wb", "flux linkage of hysteron 'hysteron_3'"),
    Record("S_3", "J/K", "entropy of thermal_mass 'body_3'"),
)
INPUTS = (
    Record("F_ext", "N", "external force on the tip"),
    Record("V_in", "V", "supply voltage"),
    Record("T_e", "K", "temperature of the environment"),
)
INPUT_DEFAULTS = (0.0, 0.0, 298.15)
# rows of outputs() and supply(): ports, named after the elements that have the inputs
OUTPUTS = (
    Record("load", "m/s", "velocity at force_source 'load'"),
    Record("supply", "A", "current given by voltage_source 'supply'"),
    Record("base", "K", "temperature of thermal_mass 'body_1'"),
    Record("top", "K", "temperature of thermal_mass 'body_3'"),
)
# rows of heat() and entropy_production(): processes, with the unit of the second
PROCESSES = (
    Record("hysteron_1", "W/K", "hysteron 'hysteron_1'"),
    Record("damper_1", "W/K", "damper 'damper_1'"),
    Record("hysteron_2", "W/K", "hysteron 'hysteron_2'"),
    Record("damper_2", "W/K", "damper 'damper_2'"),
    Record("hysteron_3", "W/K", "hysteron 'hysteron_3'"),
    Record("damper_3", "W/K", "damper 'damper_3'"),
    Record("contact_1", "W/K", "conduction 'contact_1'"),
    Record("contact_2", "W/K", "conduction 'contact_2'"),
)
# rows of temperatures(), and of elements()
BODIES = (
    Record("body_1", "K", "temperature of thermal_mass 'body_1'"),
    Record("body_2", "K", "temperature of thermal_mass 'body_2'"),
    Record("body_3", "K", "temperature of thermal_mass 'body_3'"),
)
ELEMENTS = (
    Record("spring_1.effort", "N", "force of spring 'spring_1'"),
    Record("spring_1.flow", "m/s", "velocity of spring 'spring_1'"),
    Record("spring_1.power", "W", "power into spring 'spring_1'"),
    Record("spring_1.energy", "J", "energy of spring 'spring_1'"),
    Record("mass_1.effort", "N", "force of mass 'mass_1'"),
    Record("mass_1.flow", "m/s", "velocity of mass 'mass_1'"),
    Record("mass_1.power", "W", "power into mass 'mass_1'"),
    Record("mass_1.energy", "J", "energy of mass 'mass_1'"),
    Record("capacitor_1.effort", "V", "voltage of capacitor 'capacitor_1'"),
    Record("capacitor_1.flow", "A", "current of capacitor 'capacitor_1'"),
    Record("capacitor_1.power", "W", "power into capacitor 'capacitor_1'"),
    Record("capacitor_1.energy", "J", "energy of capacitor 'capacitor_1'"),
    Record("hysteron_1.effort", "V", "voltage of hysteron 'hysteron_1'"),
    Record("hysteron_1.flow", "A", "current of hysteron 'hysteron_1'"),
    Record("hysteron_1.power", "W", "power into hysteron 'hysteron_1'"),
    Record("hysteron_1.energy", "J", "energy of hysteron 'hysteron_1'"),
    Record("hysteron_1.heat", "W", "heat of hysteron 'hysteron_1'"),
    Record("damper_1.effort", "N", "force of damper 'damper_1'"),
    Record("damper_1.flow", "m/s", "velocity of damper 'damper_1'"),
    Record("damper_1.power", "W", "power into damper 'damper_1'"),
    Record("damper_1.heat", "W", "heat of damper 'damper_1'"),
    Record("transducer_1.effort_1", "V", "voltage in branch 1 of transducer 'transducer_1'"),
    Record("transducer_1.flow_1", "A", "current in branch 1 of transducer 'transducer_1'"),
    Record("transducer_1.effort_2", "N", "force in branch 2 of transducer 'transducer_1'"),
    Record("transducer_1.flow_2", "m/s", "velocity in branch 2 of transducer 'transducer_1'"),
    Record("transducer_1.power", "W", "power from branch 1 to branch 2 of transducer 'transducer_1'"),
    Record("body_1.effort", "K", "temperature of thermal_mass 'body_1'"),
    Record("body_1.flow", "W/K", "entropy flow of thermal_mass 'body_1'"),
    Record("body_1.power", "W", "power into thermal_mass 'body_1'"),
    Record("body_1.energy", "J", "energy of thermal_mass 'body_1'"),
    Record("spring_2.effort", "N", "force of spring 'spring_2'"),
    Record("spring_2.flow", "m/s", "velocity of spring 'spring_2'"),
    Record("spring_2.power", "W", "power into spring 'spring_2'"),
    Record("spring_2.energy", "J", "energy of spring 'spring_2'"),
    Record("mass_2.effort", "N", "force of mass 'mass_2'"),
    Record("mass_2.flow", "m/s", "velocity of mass 'mass_2'"),
    Record("mass_2.power", "W", "power into mass 'mass_2'"),
    Record("mass_2.energy", "J", "energy of mass 'mass_2'"),
    Record("capacitor_2.effort", "V", "voltage of capacitor 'capacitor_2'"),
    Record("capacitor_2.flow", "A", "current of capacitor 'capacitor_2'"),
    Record("capacitor_2.power", "W", "power into capacitor 'capacitor_2'"),
    Record("capacitor_2.energy", "J", "energy of capacitor 'capacitor_2'"),
    Record("hysteron_2.effort", "V", "voltage of hysteron 'hysteron_2'"),
    Record("hysteron_2.flow", "A", "current of hysteron 'hysteron_2'"),
    Record("hysteron_2.power", "W", "power into hysteron 'hysteron_2'"),
    Record("hysteron_2.energy", "J", "energy of hysteron 'hysteron_2'"),
    Record("hysteron_2.heat", "W", "heat of hysteron 'hysteron_2'"),
    Record("damper_2.effort", "N", "force of damper 'damper_2'"),
    Record("damper_2.flow", "m/s", "velocity of damper 'damper_2'"),
    Record("damper_2.power", "W", "power into damper 'damper_2'"),
    Record("damper_2.heat", "W", "heat of damper 'damper_2'"),
    Record("transducer_2.effort_1", "V", "voltage in branch 1 of transducer 'transducer_2'"),
    Record("transducer_2.flow_1", "A", "current in branch 1 of transducer 'transducer_2'"),
    Record("transducer_2.effort_2", "N", "force in branch 2 of transducer 'transducer_2'"),
    Record("transducer_2.flow_2", "m/s", "velocity in branch 2 of transducer 'transducer_2'"),
    Record("transducer_2.power", "W", "power from branch 1 to branch 2 of transducer 'transducer_2'"),
    Record("body_2.effort", "K", "temperature of thermal_mass 'body_2'"),
    Record("body_2.flow", "W/K", "entropy flow of thermal_mass 'body_2'"),
    Record("body_2.power", "W", "power into thermal_mass 'body_2'"),
    Record("body_2.energy", "J", "energy of thermal_mass 'body_2'"),
    Record("spring_3.effort", "N", "force of spring 'spring_3'"),
    Record("spring_3.flow", "m/s", "velocity of spring 'spring_3'"),
    Record("spring_3.power", "W", "power into spring 'spring_3'"),
    Record("spring_3.energy", "J", "energy of spring 'spring_3'"),
    Record("mass_3.effort", "N", "force of mass 'mass_3'"),
    Record("mass_3.flow", "m/s", "velocity of mass 'mass_3'"),
    Record("mass_3.power", "W", "power into mass 'mass_3'"),
    Record("mass_3.energy", "J", "energy of mass 'mass_3'"),
    Record("capacitor_3.effort", "V", "voltage of capacitor 'capacitor_3'"),
    Record("capacitor_3.flow", "A", "current of capacitor 'capacitor_3'"),
    Record("capacitor_3.power", "W", "power into capacitor 'capacitor_3'"),
    Record("capacitor_3.energy", "J", "energy of capacitor 'capacitor_3'"),
    Record("hysteron_3.effort", "V", "voltage of hysteron 'hysteron_3'"),
    Record("hysteron_3.flow", "A", "current of hysteron 'hysteron_3'"),
    Record("hysteron_3.power", "W", "power into hysteron 'hysteron_3'"),
    Record("hysteron_3.energy", "J", "energy of hysteron 'hysteron_3'"),
    Record("hysteron_3.heat", "W", "heat of hysteron 'hysteron_3'"),
    Record("damper_3.effort", "N", "force of damper 'damper_3'"),
    Record("damper_3.flow", "m/s", "velocity of damper 'damper_3'"),
    Record("damper_3.power", "W", "power into damper 'damper_3'"),
    Record("damper_3.heat", "W", "heat of damper 'damper_3'"),
    Record("transducer_3.effort_1", "V", "voltage in branch 1 of transducer 'transducer_3'"),
    Record("transducer_3.flow_1", "A", "current in branch 1 of transducer 'transducer_3'"),
    Record("transducer_3.effort_2", "N", "force in branch 2 of transducer 'transducer_3'"),
    Record("transducer_3.flow_2", "m/s", "velocity in branch 2 of transducer 'transducer_3'"),
    Record("transducer_3.power", "W", "power from branch 1 to branch 2 of transducer 'transducer_3'"),
    Record("body_3.effort", "K", "temperature of thermal_mass 'body_3'"),
    Record("body_3.flow", "W/K", "entropy flow of thermal_mass 'body_3'"),
    Record("body_3.power", "W", "power into thermal_mass 'body_3'"),
    Record("body_3.energy", "J", "energy of thermal_mass 'body_3'"),
    Record("contact_1.effort", "K", "temperature difference over conduction 'contact_1'"),
    Record("contact_1.power", "W", "heat from first to second body by conduction 'contact_1'"),
    Record("contact_2.effort", "K", "temperature difference over conduction 'contact_2'"),
    Record("contact_2.power", "W", "heat from first to second body by conduction 'contact_2'"),
    Record("base.effort", "K", "temperature at ambient 'base'"),
    Record("base.flow", "W/K", "entropy flow at ambient 'base'"),
    Record("base.power", "W", "power into ambient 'base'"),
    Record("top.effort", "K", "temperature at ambient 'top'"),
    Record("top.flow", "W/K", "entropy flow at ambient 'top'"),
    Record("top.power", "W", "power into ambient 'top'"),
    Record("load.effort", "N", "force of force_source 'load'"),
    Record("load.flow", "m/s", "velocity of force_source 'load'"),
    Record("load.power", "W", "power into force_source 'load'"),
    Record("supply.effort", "V", "voltage of voltage_source 'supply'"),
    Record("supply.flow", "A", "current of voltage_source 'supply'"),
    Record("supply.power", "W", "power into voltage_source 'supply'"),
)
# fields of Parameters; elements of many lanes; conditions under which the proofs hold
PARAMETERS = (
    Record("M", "kg", "mass of a layer"),
    Record("k", "N/m", "stiffness of a layer"),
    Record("d", "N*s/m", "damping of a layer"),
    Record("C", "F", "capacitance of a layer"),
    Record("L", "H", "inductance of a layer's hysteron"),
    Record("rho", "ohm*K", "resistance law of a layer: slope rho/(T - T_0)"),
    Record("i_0", "A", "half width of a layer's dead zone"),
    Record("a", "C/m", "transducer ratio of a layer at T_0"),
    Record("T_0", "K", "reference temperature"),
    Record("c_0", "J/K", "heat capacity of a layer"),
    Record("lam", "W/K", "heat conductance from an end to the environment"),
    Record("lam_l", "W/K", "heat conductance from a layer to the next"),
)
BANKS = ()
DOMAIN = (
    Condition("T_body_1 > T_0", True),
    Condition("T_body_2 > T_0", True),
    Condition("T_body_3 > T_0", True),
    Condition("T_e > T_0", True),
    Condition("d >= 0", False),
    Condition("rho >= 0", False),
    Condition("i_0 >= 0", False),
    Condition("lam >= 0", False),
    Condition("lam_l >= 0", False),
    Condition("k > 0", True),
    Condition("M > 0", True),
    Condition("C > 0", True),
    Condition("L > 0", True),
    Condition("T_0 > 0", True),
    Condition("c_0 > 0", True),
)


@dataclass(frozen=True)
class Parameters:
    """Parameters of layered_stack in SI units; defaults are the values of the spec."""

    M: float = 0.00225
    k: float = 1500000.0
    d: float = 1200.0
    C: float = 1.6666666666666667e-06
    L: float = 0.0015
    rho: float = 15.0
    i_0: float = 0.3333333333333333
    a: float = 10.0
    T_0: float = 296.15
    c_0: float = 1.6666666666666667
    lam: float = 1.0
    lam_l: float = 6.0


def _states(x, p):
    """Return states x, shape (n, *batch), as floats."""
    x = np.asarray(x, dtype=float)
    n = 15
    if x.shape[:1] != (n,):
        raise ValueError(f"x has shape {x.shape}, but there are {n} states")
    return x


def _inputs(u):
    """Return inputs u, shape (3, *batch), as floats."""
    u = np.asarray(u, dtype=float)
    if u.shape[:1] != (3,):
        raise ValueError(f"u has shape {u.shape}, but there are 3 inputs")
    return u


def initial_state(u, p, /):
    """State at t = 0 [SI], for the inputs u at t = 0; shape (n,)."""
    u = _inputs(u)
    T_0 = p.T_0
    c_0 = p.c_0
    T_e = u[2]
    out = np.zeros(15)
    out[4] = c_0*np.log(T_e/T_0)
    out[9] = c_0*np.log(T_e/T_0)
    out[14] = c_0*np.log(T_e/T_0)
    return out


_BLOCK = 150_000  # numbers in one part of a large batch: they fit in the cache


def rhs(x, u, p, /):
    """Rates dx/dt, the rows of J_ir dU/dx + g u; shape (n, *batch)."""
    x, u = _states(x, p), _inputs(u)
    out = np.empty(x.shape)
    if x.ndim != 2 or x.size <= _BLOCK:
        _rates(x, u, p, out)
        return out
    step = max(1, _BLOCK // len(x))
    for first in range(0, x.shape[1], step):
        part = slice(first, first + step)
        _rates(x[:, part], u[:, part] if u.ndim == 2 else u, p, out[:, part])
    return out


def _rates(x, u, p, out, /):
    """Write the rates dx/dt into `out`."""
    M = p.M
    k = p.k
    d = p.d
    C = p.C
    L = p.L
    rho = p.rho
    i_0 = p.i_0
    a = p.a
    T_0 = p.T_0
    c_0 = p.c_0
    lam = p.lam
    lam_l = p.lam_l
    q_1 = x[0]
    p_1 = x[1]
    Q_1 = x[2]
    phi_1 = x[3]
    S_1 = x[4]
    q_2 = x[5]
    p_2 = x[6]
    Q_2 = x[7]
    phi_2 = x[8]
    S_2 = x[9]
    q_3 = x[10]
    p_3 = x[11]
    Q_3 = x[12]
    phi_3 = x[13]
    S_3 = x[14]
    F_ext = u[0]
    V_in = u[1]
    T_e = u[2]
    # co-states dU/dx
    F_spring_1 = k*q_1
    v_mass_1 = p_1/M
    V_capacitor_1 = Q_1/C
    i_hysteron_1 = phi_1/L
    T_body_1_minus_T_0 = T_0*np.expm1(S_1/c_0)
    T_body_1 = T_0 + T_body_1_minus_T_0
    F_spring_2 = k*q_2
    v_mass_2 = p_2/M
    V_capacitor_2 = Q_2/C
    i_hysteron_2 = phi_2/L
    T_body_2_minus_T_0 = T_0*np.expm1(S_2/c_0)
    T_body_2 = T_0 + T_body_2_minus_T_0
    F_spring_3 = k*q_3
    v_mass_3 = p_3/M
    V_capacitor_3 = Q_3/C
    i_hysteron_3 = phi_3/L
    T_body_3_minus_T_0 = T_0*np.expm1(S_3/c_0)
    T_body_3 = T_0 + T_body_3_minus_T_0
    # transducer ratios
    alpha_transducer_1 = a*T_body_1/T_0
    alpha_transducer_2 = a*T_body_2/T_0
    alpha_transducer_3 = a*T_body_3/T_0
    # dissipative laws
    V_hysteron_1 = rho/T_body_1_minus_T_0*(i_hysteron_1 - np.clip(i_hysteron_1, -i_0, i_0))
    F_damper_1 = d*v_mass_1
    V_hysteron_2 = rho/T_body_2_minus_T_0*(i_hysteron_2 - np.clip(i_hysteron_2, -i_0, i_0))
    # driving forces
    v_damper_2 = -v_mass_1 + v_mass_2
    # dissipative laws
    F_damper_2 = d*v_damper_2
    V_hysteron_3 = rho/T_body_3_minus_T_0*(i_hysteron_3 - np.clip(i_hysteron_3, -i_0, i_0))
    # driving forces
    v_damper_3 = -v_mass_2 + v_mass_3
    # dissipative laws
    F_damper_3 = d*v_damper_3
    s_contact_1 = lam_l*(T_body_1 - T_body_2)/T_body_1
    s_contact_2 = lam_l*(T_body_2 - T_body_3)/T_body_2
    # heats
    heat_hysteron_1 = V_hysteron_1*i_hysteron_1
    heat_damper_1 = F_damper_1*v_mass_1
    heat_hysteron_2 = V_hysteron_2*i_hysteron_2
    heat_damper_2 = F_damper_2*v_damper_2
    heat_hysteron_3 = V_hysteron_3*i_hysteron_3
    heat_damper_3 = F_damper_3*v_damper_3
    heat_contact_1 = s_contact_1*T_body_1
    heat_contact_2 = s_contact_2*T_body_2
    # result
    out[0] = v_mass_1
    out[1] = (
        alpha_transducer_1*V_capacitor_1
        - F_spring_1
        + F_spring_2
        - alpha_transducer_2*V_capacitor_2
        - F_damper_1
        + F_damper_2
    )
    out[2] = i_hysteron_1 - alpha_transducer_1*v_mass_1
    out[3] = V_in - V_capacitor_1 - V_hysteron_1
    out[4] = (heat_hysteron_1 + heat_damper_1)/T_body_1 - s_contact_1 + lam*(T_e/T_body_1 - 1)
    out[5] = v_mass_2 - v_mass_1
    out[6] = (
        alpha_transducer_2*V_capacitor_2
        - F_spring_2
        + F_spring_3
        - alpha_transducer_3*V_capacitor_3
        - F_damper_2
        + F_damper_3
    )
    out[7] = alpha_transducer_2*v_mass_1 - alpha_transducer_2*v_mass_2 + i_hysteron_2
    out[8] = V_in - V_capacitor_2 - V_hysteron_2
    out[9] = (heat_hysteron_2 + heat_damper_2 + heat_contact_1)/T_body_2 - s_contact_2
    out[10] = v_mass_3 - v_mass_2
    out[11] = alpha_transducer_3*V_capacitor_3 - F_spring_3 - F_damper_3 + F_ext
    out[12] = alpha_transducer_3*v_mass_2 - alpha_transducer_3*v_mass_3 + i_hysteron_3
    out[13] = V_in - V_capacitor_3 - V_hysteron_3
    out[14] = (
        (heat_hysteron_3 + heat_damper_3 + heat_contact_2)/T_body_3
        + lam*(T_e/T_body_3 - 1)
    )


def outputs(x, u, p, /):
    """Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient; shape (4, *batch)."""
    x = _states(x, p)
    M = p.M
    L = p.L
    T_0 = p.T_0
    c_0 = p.c_0
    phi_1 = x[3]
    S_1 = x[4]
    phi_2 = x[8]
    p_3 = x[11]
    phi_3 = x[13]
    S_3 = x[14]
    # co-states dU/dx
    i_hysteron_1 = phi_1/L
    T_body_1_minus_T_0 = T_0*np.expm1(S_1/c_0)
    T_body_1 = T_0 + T_body_1_minus_T_0
    i_hysteron_2 = phi_2/L
    v_mass_3 = p_3/M
    i_hysteron_3 = phi_3/L
    T_body_3_minus_T_0 = T_0*np.expm1(S_3/c_0)
    T_body_3 = T_0 + T_body_3_minus_T_0
    # result
    out = np.empty((4, *x.shape[1:]))
    out[0] = v_mass_3
    out[1] = i_hysteron_1 + i_hysteron_2 + i_hysteron_3
    out[2] = T_body_1
    out[3] = T_body_3
    return out


def supply(x, u, p, /):
    """Power supplied through each port [W]; the sum is dU/dt; shape (4, *batch)."""
    x = _states(x, p)
    u = _inputs(u)
    M = p.M
    L = p.L
    T_0 = p.T_0
    c_0 = p.c_0
    lam = p.lam
    phi_1 = x[3]
    S_1 = x[4]
    phi_2 = x[8]
    p_3 = x[11]
    phi_3 = x[13]
    S_3 = x[14]
    F_ext = u[0]
    V_in = u[1]
    T_e = u[2]
    # co-states dU/dx
    i_hysteron_1 = phi_1/L
    T_body_1_minus_T_0 = T_0*np.expm1(S_1/c_0)
    T_body_1 = T_0 + T_body_1_minus_T_0
    i_hysteron_2 = phi_2/L
    v_mass_3 = p_3/M
    i_hysteron_3 = phi_3/L
    T_body_3_minus_T_0 = T_0*np.expm1(S_3/c_0)
    T_body_3 = T_0 + T_body_3_minus_T_0
    # result
    out = np.empty((4, *x.shape[1:]))
    out[0] = v_mass_3*F_ext
    out[1] = (i_hysteron_1 + i_hysteron_2 + i_hysteron_3)*V_in
    out[2] = lam*(T_e - T_body_1)
    out[3] = lam*(T_e - T_body_3)
    return out


def energy(x, p, /):
    """Hamiltonian U [J]; shape (*batch)."""
    x = _states(x, p)
    M = p.M
    k = p.k
    C = p.C
    L = p.L
    T_0 = p.T_0
    c_0 = p.c_0
    q_1 = x[0]
    p_1 = x[1]
    Q_1 = x[2]
    phi_1 = x[3]
    S_1 = x[4]
    q_2 = x[5]
    p_2 = x[6]
    Q_2 = x[7]
    phi_2 = x[8]
    S_2 = x[9]
    q_3 = x[10]
    p_3 = x[11]
    Q_3 = x[12]
    phi_3 = x[13]
    S_3 = x[14]
    return k*q_1**2/2 + p_1**2/(2*M) + Q_1**2/(2*C) + phi_1**2/(2*L) + T_0*c_0*np.exp(S_1/c_0) + k*q_2**2/2 + p_2**2/(2*M) + Q_2**2/(2*C) + phi_2**2/(2*L) + T_0*c_0*np.exp(S_2/c_0) + k*q_3**2/2 + p_3**2/(2*M) + Q_3**2/(2*C) + phi_3**2/(2*L) + T_0*c_0*np.exp(S_3/c_0)


def entropy(x, p, /):
    """Total entropy S [J/K]; shape (*batch)."""
    x = _states(x, p)
    S_1 = x[4]
    S_2 = x[9]
    S_3 = x[14]
    return S_1 + S_2 + S_3


def temperatures(x, p, /):
    """Temperature of each body [K]; shape (3, *batch)."""
    x = _states(x, p)
    T_0 = p.T_0
    c_0 = p.c_0
    S_1 = x[4]
    S_2 = x[9]
    S_3 = x[14]
    # co-states dU/dx
    T_body_1_minus_T_0 = T_0*np.expm1(S_1/c_0)
    T_body_1 = T_0 + T_body_1_minus_T_0
    T_body_2_minus_T_0 = T_0*np.expm1(S_2/c_0)
    T_body_2 = T_0 + T_body_2_minus_T_0
    T_body_3_minus_T_0 = T_0*np.expm1(S_3/c_0)
    T_body_3 = T_0 + T_body_3_minus_T_0
    # result
    out = np.empty((3, *x.shape[1:]))
    out[0] = T_body_1
    out[1] = T_body_2
    out[2] = T_body_3
    return out


def heat(x, u, p, /):
    """Power that each process turns into heat [W]; of a bank, one row per lane; shape (8, *batch)."""
    x = _states(x, p)
    M = p.M
    d = p.d
    L = p.L
    rho = p.rho
    i_0 = p.i_0
    T_0 = p.T_0
    c_0 = p.c_0
    lam_l = p.lam_l
    p_1 = x[1]
    phi_1 = x[3]
    S_1 = x[4]
    p_2 = x[6]
    phi_2 = x[8]
    S_2 = x[9]
    p_3 = x[11]
    phi_3 = x[13]
    S_3 = x[14]
    # co-states dU/dx
    v_mass_1 = p_1/M
    i_hysteron_1 = phi_1/L
    T_body_1_minus_T_0 = T_0*np.expm1(S_1/c_0)
    T_body_1 = T_0 + T_body_1_minus_T_0
    v_mass_2 = p_2/M
    i_hysteron_2 = phi_2/L
    T_body_2_minus_T_0 = T_0*np.expm1(S_2/c_0)
    T_body_2 = T_0 + T_body_2_minus_T_0
    v_mass_3 = p_3/M
    i_hysteron_3 = phi_3/L
    T_body_3_minus_T_0 = T_0*np.expm1(S_3/c_0)
    T_body_3 = T_0 + T_body_3_minus_T_0
    # dissipative laws
    V_hysteron_1 = rho/T_body_1_minus_T_0*(i_hysteron_1 - np.clip(i_hysteron_1, -i_0, i_0))
    F_damper_1 = d*v_mass_1
    V_hysteron_2 = rho/T_body_2_minus_T_0*(i_hysteron_2 - np.clip(i_hysteron_2, -i_0, i_0))
    # driving forces
    v_damper_2 = -v_mass_1 + v_mass_2
    # dissipative laws
    F_damper_2 = d*v_damper_2
    V_hysteron_3 = rho/T_body_3_minus_T_0*(i_hysteron_3 - np.clip(i_hysteron_3, -i_0, i_0))
    # driving forces
    v_damper_3 = -v_mass_2 + v_mass_3
    # dissipative laws
    F_damper_3 = d*v_damper_3
    s_contact_1 = lam_l*(T_body_1 - T_body_2)/T_body_1
    s_contact_2 = lam_l*(T_body_2 - T_body_3)/T_body_2
    # result
    out = np.empty((8, *x.shape[1:]))
    out[0] = V_hysteron_1*i_hysteron_1
    out[1] = F_damper_1*v_mass_1
    out[2] = V_hysteron_2*i_hysteron_2
    out[3] = F_damper_2*v_damper_2
    out[4] = V_hysteron_3*i_hysteron_3
    out[5] = F_damper_3*v_damper_3
    out[6] = s_contact_1*T_body_1
    out[7] = s_contact_2*T_body_2
    return out


def entropy_production(x, u, p, /):
    """Entropy production of each process [W/K], heat exchange with ambients not included; of a bank, one row per lane; shape (8, *batch)."""
    x = _states(x, p)
    M = p.M
    d = p.d
    L = p.L
    rho = p.rho
    i_0 = p.i_0
    T_0 = p.T_0
    c_0 = p.c_0
    lam_l = p.lam_l
    p_1 = x[1]
    phi_1 = x[3]
    S_1 = x[4]
    p_2 = x[6]
    phi_2 = x[8]
    S_2 = x[9]
    p_3 = x[11]
    phi_3 = x[13]
    S_3 = x[14]
    # co-states dU/dx
    v_mass_1 = p_1/M
    i_hysteron_1 = phi_1/L
    T_body_1_minus_T_0 = T_0*np.expm1(S_1/c_0)
    T_body_1 = T_0 + T_body_1_minus_T_0
    v_mass_2 = p_2/M
    i_hysteron_2 = phi_2/L
    T_body_2_minus_T_0 = T_0*np.expm1(S_2/c_0)
    T_body_2 = T_0 + T_body_2_minus_T_0
    v_mass_3 = p_3/M
    i_hysteron_3 = phi_3/L
    T_body_3_minus_T_0 = T_0*np.expm1(S_3/c_0)
    T_body_3 = T_0 + T_body_3_minus_T_0
    # dissipative laws
    V_hysteron_1 = rho/T_body_1_minus_T_0*(i_hysteron_1 - np.clip(i_hysteron_1, -i_0, i_0))
    F_damper_1 = d*v_mass_1
    V_hysteron_2 = rho/T_body_2_minus_T_0*(i_hysteron_2 - np.clip(i_hysteron_2, -i_0, i_0))
    # driving forces
    v_damper_2 = -v_mass_1 + v_mass_2
    # dissipative laws
    F_damper_2 = d*v_damper_2
    V_hysteron_3 = rho/T_body_3_minus_T_0*(i_hysteron_3 - np.clip(i_hysteron_3, -i_0, i_0))
    # driving forces
    v_damper_3 = -v_mass_2 + v_mass_3
    # dissipative laws
    F_damper_3 = d*v_damper_3
    s_contact_1 = lam_l*(T_body_1 - T_body_2)/T_body_1
    s_contact_2 = lam_l*(T_body_2 - T_body_3)/T_body_2
    # result
    out = np.empty((8, *x.shape[1:]))
    out[0] = V_hysteron_1*i_hysteron_1/T_body_1
    out[1] = F_damper_1*v_mass_1/T_body_1
    out[2] = V_hysteron_2*i_hysteron_2/T_body_2
    out[3] = F_damper_2*v_damper_2/T_body_2
    out[4] = V_hysteron_3*i_hysteron_3/T_body_3
    out[5] = F_damper_3*v_damper_3/T_body_3
    out[6] = s_contact_1*(T_body_1 - T_body_2)/T_body_2
    out[7] = s_contact_2*(T_body_2 - T_body_3)/T_body_3
    return out


def elements(x, u, p, /):
    """Effort, flow, power, energy and heat of elements; of a bank, one row per lane; shape (106, *batch)."""
    x = _states(x, p)
    u = _inputs(u)
    M = p.M
    k = p.k
    d = p.d
    C = p.C
    L = p.L
    rho = p.rho
    i_0 = p.i_0
    a = p.a
    T_0 = p.T_0
    c_0 = p.c_0
    lam = p.lam
    lam_l = p.lam_l
    q_1 = x[0]
    p_1 = x[1]
    Q_1 = x[2]
    phi_1 = x[3]
    S_1 = x[4]
    q_2 = x[5]
    p_2 = x[6]
    Q_2 = x[7]
    phi_2 = x[8]
    S_2 = x[9]
    q_3 = x[10]
    p_3 = x[11]
    Q_3 = x[12]
    phi_3 = x[13]
    S_3 = x[14]
    F_ext = u[0]
    V_in = u[1]
    T_e = u[2]
    # co-states dU/dx
    F_spring_1 = k*q_1
    v_mass_1 = p_1/M
    V_capacitor_1 = Q_1/C
    i_hysteron_1 = phi_1/L
    T_body_1_minus_T_0 = T_0*np.expm1(S_1/c_0)
    T_body_1 = T_0 + T_body_1_minus_T_0
    F_spring_2 = k*q_2
    v_mass_2 = p_2/M
    V_capacitor_2 = Q_2/C
    i_hysteron_2 = phi_2/L
    T_body_2_minus_T_0 = T_0*np.expm1(S_2/c_0)
    T_body_2 = T_0 + T_body_2_minus_T_0
    F_spring_3 = k*q_3
    v_mass_3 = p_3/M
    V_capacitor_3 = Q_3/C
    i_hysteron_3 = phi_3/L
    T_body_3_minus_T_0 = T_0*np.expm1(S_3/c_0)
    T_body_3 = T_0 + T_body_3_minus_T_0
    # transducer ratios
    alpha_transducer_1 = a*T_body_1/T_0
    alpha_transducer_2 = a*T_body_2/T_0
    alpha_transducer_3 = a*T_body_3/T_0
    # dissipative laws
    V_hysteron_1 = rho/T_body_1_minus_T_0*(i_hysteron_1 - np.clip(i_hysteron_1, -i_0, i_0))
    F_damper_1 = d*v_mass_1
    V_hysteron_2 = rho/T_body_2_minus_T_0*(i_hysteron_2 - np.clip(i_hysteron_2, -i_0, i_0))
    # driving forces
    v_damper_2 = -v_mass_1 + v_mass_2
    # dissipative laws
    F_damper_2 = d*v_damper_2
    V_hysteron_3 = rho/T_body_3_minus_T_0*(i_hysteron_3 - np.clip(i_hysteron_3, -i_0, i_0))
    # driving forces
    v_damper_3 = -v_mass_2 + v_mass_3
    # dissipative laws
    F_damper_3 = d*v_damper_3
    s_contact_1 = lam_l*(T_body_1 - T_body_2)/T_body_1
    s_contact_2 = lam_l*(T_body_2 - T_body_3)/T_body_2
    # heats
    heat_hysteron_1 = V_hysteron_1*i_hysteron_1
    heat_damper_1 = F_damper_1*v_mass_1
    heat_hysteron_2 = V_hysteron_2*i_hysteron_2
    heat_damper_2 = F_damper_2*v_damper_2
    heat_hysteron_3 = V_hysteron_3*i_hysteron_3
    heat_damper_3 = F_damper_3*v_damper_3
    heat_contact_1 = s_contact_1*T_body_1
    heat_contact_2 = s_contact_2*T_body_2
    # rates
    rate_p_1 = (
        alpha_transducer_1*V_capacitor_1
        - F_spring_1
        + F_spring_2
        - alpha_transducer_2*V_capacitor_2
        - F_damper_1
        + F_damper_2
    )
    rate_Q_1 = i_hysteron_1 - alpha_transducer_1*v_mass_1
    rate_phi_1 = V_in - V_capacitor_1 - V_hysteron_1
    rate_S_1 = (heat_hysteron_1 + heat_damper_1)/T_body_1 - s_contact_1 + lam*(T_e/T_body_1 - 1)
    rate_q_2 = v_mass_2 - v_mass_1
    rate_p_2 = (
        alpha_transducer_2*V_capacitor_2
        - F_spring_2
        + F_spring_3
        - alpha_transducer_3*V_capacitor_3
        - F_damper_2
        + F_damper_3
    )
    rate_Q_2 = alpha_transducer_2*v_mass_1 - alpha_transducer_2*v_mass_2 + i_hysteron_2
    rate_phi_2 = V_in - V_capacitor_2 - V_hysteron_2
    rate_S_2 = (heat_hysteron_2 + heat_damper_2 + heat_contact_1)/T_body_2 - s_contact_2
    rate_q_3 = v_mass_3 - v_mass_2
    rate_p_3 = alpha_transducer_3*V_capacitor_3 - F_spring_3 - F_damper_3 + F_ext
    rate_Q_3 = alpha_transducer_3*v_mass_2 - alpha_transducer_3*v_mass_3 + i_hysteron_3
    rate_phi_3 = V_in - V_capacitor_3 - V_hysteron_3
    rate_S_3 = (
        (heat_hysteron_3 + heat_damper_3 + heat_contact_2)/T_body_3
        + lam*(T_e/T_body_3 - 1)
    )
    # result
    out = np.empty((106, *x.shape[1:]))
    out[0] = F_spring_1
    out[1] = v_mass_1
    out[2] = F_spring_1*v_mass_1
    out[3] = k*q_1**2/2
    out[4] = rate_p_1
    out[5] = v_mass_1
    out[6] = rate_p_1*v_mass_1
    out[7] = p_1**2/(2*M)
    out[8] = V_capacitor_1
    out[9] = rate_Q_1
    out[10] = V_capacitor_1*rate_Q_1
    out[11] = Q_1**2/(2*C)
    out[12] = rate_phi_1 + V_hysteron_1
    out[13] = i_hysteron_1
    out[14] = (rate_phi_1 + V_hysteron_1)*i_hysteron_1
    out[15] = phi_1**2/(2*L)
    out[16] = V_hysteron_1*i_hysteron_1
    out[17] = F_damper_1
    out[18] = v_mass_1
    out[19] = F_damper_1*v_mass_1
    out[20] = F_damper_1*v_mass_1
    out[21] = V_capacitor_1
    out[22] = alpha_transducer_1*v_mass_1
    out[23] = -alpha_transducer_1*V_capacitor_1
    out[24] = v_mass_1
    out[25] = V_capacitor_1*alpha_transducer_1*v_mass_1
    out[26] = T_body_1
    out[27] = rate_S_1
    out[28] = T_body_1*rate_S_1
    out[29] = T_0*c_0*np.exp(S_1/c_0)
    out[30] = F_spring_2
    out[31] = rate_q_2
    out[32] = F_spring_2*rate_q_2
    out[33] = k*q_2**2/2
    out[34] = rate_p_2
    out[35] = v_mass_2
    out[36] = rate_p_2*v_mass_2
    out[37] = p_2**2/(2*M)
    out[38] = V_capacitor_2
    out[39] = rate_Q_2
    out[40] = V_capacitor_2*rate_Q_2
    out[41] = Q_2**2/(2*C)
    out[42] = rate_phi_2 + V_hysteron_2
    out[43] = i_hysteron_2
    out[44] = (rate_phi_2 + V_hysteron_2)*i_hysteron_2
    out[45] = phi_2**2/(2*L)
    out[46] = V_hysteron_2*i_hysteron_2
    out[47] = F_damper_2
    out[48] = v_damper_2
    out[49] = F_damper_2*v_damper_2
    out[50] = F_damper_2*v_damper_2
    out[51] = V_capacitor_2
    out[52] = alpha_transducer_2*(-v_mass_1 + v_mass_2)
    out[53] = -alpha_transducer_2*V_capacitor_2
    out[54] = -v_mass_1 + v_mass_2
    out[55] = V_capacitor_2*alpha_transducer_2*(-v_mass_1 + v_mass_2)
    out[56] = T_body_2
    out[57] = rate_S_2
    out[58] = T_body_2*rate_S_2
    out[59] = T_0*c_0*np.exp(S_2/c_0)
    out[60] = F_spring_3
    out[61] = rate_q_3
    out[62] = F_spring_3*rate_q_3
    out[63] = k*q_3**2/2
    out[64] = rate_p_3
    out[65] = v_mass_3
    out[66] = rate_p_3*v_mass_3
    out[67] = p_3**2/(2*M)
    out[68] = V_capacitor_3
    out[69] = rate_Q_3
    out[70] = V_capacitor_3*rate_Q_3
    out[71] = Q_3**2/(2*C)
    out[72] = rate_phi_3 + V_hysteron_3
    out[73] = i_hysteron_3
    out[74] = (rate_phi_3 + V_hysteron_3)*i_hysteron_3
    out[75] = phi_3**2/(2*L)
    out[76] = V_hysteron_3*i_hysteron_3
    out[77] = F_damper_3
    out[78] = v_damper_3
    out[79] = F_damper_3*v_damper_3
    out[80] = F_damper_3*v_damper_3
    out[81] = V_capacitor_3
    out[82] = alpha_transducer_3*(-v_mass_2 + v_mass_3)
    out[83] = -alpha_transducer_3*V_capacitor_3
    out[84] = -v_mass_2 + v_mass_3
    out[85] = V_capacitor_3*alpha_transducer_3*(-v_mass_2 + v_mass_3)
    out[86] = T_body_3
    out[87] = rate_S_3
    out[88] = T_body_3*rate_S_3
    out[89] = T_0*c_0*np.exp(S_3/c_0)
    out[90] = T_body_1 - T_body_2
    out[91] = s_contact_1*T_body_1
    out[92] = T_body_2 - T_body_3
    out[93] = s_contact_2*T_body_2
    out[94] = T_body_1
    out[95] = -lam*(T_e/T_body_1 - 1)
    out[96] = -lam*(T_e - T_body_1)
    out[97] = T_body_3
    out[98] = -lam*(T_e/T_body_3 - 1)
    out[99] = -lam*(T_e - T_body_3)
    out[100] = -F_ext
    out[101] = v_mass_3
    out[102] = -v_mass_3*F_ext
    out[103] = V_in
    out[104] = -(i_hysteron_1 + i_hysteron_2 + i_hysteron_3)
    out[105] = -(i_hysteron_1 + i_hysteron_2 + i_hysteron_3)*V_in
    return out


@np.errstate(divide="ignore", invalid="ignore")
def jacobian(x, u, p, /):
    """Jacobian of rhs, d rhs[i]/d x[j] at [i, j]; shape (n, n, *batch)."""
    x = _states(x, p)
    u = _inputs(u)
    M = p.M
    k = p.k
    d = p.d
    C = p.C
    L = p.L
    rho = p.rho
    i_0 = p.i_0
    a = p.a
    T_0 = p.T_0
    c_0 = p.c_0
    lam = p.lam
    lam_l = p.lam_l
    p_1 = x[1]
    Q_1 = x[2]
    phi_1 = x[3]
    S_1 = x[4]
    p_2 = x[6]
    Q_2 = x[7]
    phi_2 = x[8]
    S_2 = x[9]
    p_3 = x[11]
    Q_3 = x[12]
    phi_3 = x[13]
    S_3 = x[14]
    T_e = u[2]
    # co-states dU/dx
    v_mass_1 = p_1/M
    V_capacitor_1 = Q_1/C
    i_hysteron_1 = phi_1/L
    T_body_1_minus_T_0 = T_0*np.expm1(S_1/c_0)
    T_body_1 = T_0 + T_body_1_minus_T_0
    v_mass_2 = p_2/M
    V_capacitor_2 = Q_2/C
    i_hysteron_2 = phi_2/L
    T_body_2_minus_T_0 = T_0*np.expm1(S_2/c_0)
    T_body_2 = T_0 + T_body_2_minus_T_0
    v_mass_3 = p_3/M
    V_capacitor_3 = Q_3/C
    i_hysteron_3 = phi_3/L
    T_body_3_minus_T_0 = T_0*np.expm1(S_3/c_0)
    T_body_3 = T_0 + T_body_3_minus_T_0
    # transducer ratios
    alpha_transducer_1 = a*T_body_1/T_0
    alpha_transducer_2 = a*T_body_2/T_0
    alpha_transducer_3 = a*T_body_3/T_0
    # dissipative laws
    V_hysteron_1 = rho/T_body_1_minus_T_0*(i_hysteron_1 - np.clip(i_hysteron_1, -i_0, i_0))
    F_damper_1 = d*v_mass_1
    V_hysteron_2 = rho/T_body_2_minus_T_0*(i_hysteron_2 - np.clip(i_hysteron_2, -i_0, i_0))
    # driving forces
    v_damper_2 = -v_mass_1 + v_mass_2
    # dissipative laws
    F_damper_2 = d*v_damper_2
    V_hysteron_3 = rho/T_body_3_minus_T_0*(i_hysteron_3 - np.clip(i_hysteron_3, -i_0, i_0))
    # driving forces
    v_damper_3 = -v_mass_2 + v_mass_3
    # dissipative laws
    F_damper_3 = d*v_damper_3
    s_contact_1 = lam_l*(T_body_1 - T_body_2)/T_body_1
    s_contact_2 = lam_l*(T_body_2 - T_body_3)/T_body_2
    # heats
    heat_hysteron_1 = V_hysteron_1*i_hysteron_1
    heat_damper_1 = F_damper_1*v_mass_1
    heat_hysteron_2 = V_hysteron_2*i_hysteron_2
    heat_damper_2 = F_damper_2*v_damper_2
    heat_hysteron_3 = V_hysteron_3*i_hysteron_3
    heat_damper_3 = F_damper_3*v_damper_3
    heat_contact_1 = s_contact_1*T_body_1
    heat_contact_2 = s_contact_2*T_body_2
    # derivatives
    dF_damper_1_dp_1 = d/M
    dF_damper_2_dp_1 = -d/M
    dheat_damper_1_dp_1 = v_mass_1*dF_damper_1_dp_1 + F_damper_1/M
    dheat_damper_2_dp_1 = v_damper_2*dF_damper_2_dp_1 - F_damper_2/M
    dV_hysteron_1_dphi_1 = np.where(np.abs(i_hysteron_1) > i_0, rho/T_body_1_minus_T_0, 0)/L
    dheat_hysteron_1_dphi_1 = i_hysteron_1*dV_hysteron_1_dphi_1 + V_hysteron_1/L
    dT_body_1_minus_T_0_dS_1 = T_body_1/c_0
    dalpha_transducer_1_dS_1 = a/T_0*dT_body_1_minus_T_0_dS_1
    dV_hysteron_1_dS_1 = -rho/T_body_1_minus_T_0**2*(i_hysteron_1 - np.clip(i_hysteron_1, -i_0, i_0))*dT_body_1_minus_T_0_dS_1
    ds_contact_1_dS_1 = (lam_l/T_body_1 - lam_l*(T_body_1 - T_body_2)/T_body_1**2)*dT_body_1_minus_T_0_dS_1
    dheat_hysteron_1_dS_1 = i_hysteron_1*dV_hysteron_1_dS_1
    dheat_contact_1_dS_1 = T_body_1*ds_contact_1_dS_1 + s_contact_1*dT_body_1_minus_T_0_dS_1
    dF_damper_2_dp_2 = d/M
    dF_damper_3_dp_2 = -d/M
    dheat_damper_2_dp_2 = v_damper_2*dF_damper_2_dp_2 + F_damper_2/M
    dheat_damper_3_dp_2 = v_damper_3*dF_damper_3_dp_2 - F_damper_3/M
    dV_hysteron_2_dphi_2 = np.where(np.abs(i_hysteron_2) > i_0, rho/T_body_2_minus_T_0, 0)/L
    dheat_hysteron_2_dphi_2 = i_hysteron_2*dV_hysteron_2_dphi_2 + V_hysteron_2/L
    dT_body_2_minus_T_0_dS_2 = T_body_2/c_0
    dalpha_transducer_2_dS_2 = a/T_0*dT_body_2_minus_T_0_dS_2
    dV_hysteron_2_dS_2 = -rho/T_body_2_minus_T_0**2*(i_hysteron_2 - np.clip(i_hysteron_2, -i_0, i_0))*dT_body_2_minus_T_0_dS_2
    ds_contact_1_dS_2 = -lam_l/T_body_1*dT_body_2_minus_T_0_dS_2
    ds_contact_2_dS_2 = (lam_l/T_body_2 - lam_l*(T_body_2 - T_body_3)/T_body_2**2)*dT_body_2_minus_T_0_dS_2
    dheat_hysteron_2_dS_2 = i_hysteron_2*dV_hysteron_2_dS_2
    dheat_contact_1_dS_2 = T_body_1*ds_contact_1_dS_2
    dheat_contact_2_dS_2 = T_body_2*ds_contact_2_dS_2 + s_contact_2*dT_body_2_minus_T_0_dS_2
    dF_damper_3_dp_3 = d/M
    dheat_damper_3_dp_3 = v_damper_3*dF_damper_3_dp_3 + F_damper_3/M
    dV_hysteron_3_dphi_3 = np.where(np.abs(i_hysteron_3) > i_0, rho/T_body_3_minus_T_0, 0)/L
    dheat_hysteron_3_dphi_3 = i_hysteron_3*dV_hysteron_3_dphi_3 + V_hysteron_3/L
    dT_body_3_minus_T_0_dS_3 = T_body_3/c_0
    dalpha_transducer_3_dS_3 = a/T_0*dT_body_3_minus_T_0_dS_3
    dV_hysteron_3_dS_3 = -rho/T_body_3_minus_T_0**2*(i_hysteron_3 - np.clip(i_hysteron_3, -i_0, i_0))*dT_body_3_minus_T_0_dS_3
    ds_contact_2_dS_3 = -lam_l/T_body_2*dT_body_3_minus_T_0_dS_3
    dheat_hysteron_3_dS_3 = i_hysteron_3*dV_hysteron_3_dS_3
    dheat_contact_2_dS_3 = T_body_2*ds_contact_2_dS_3
    # result
    out = np.zeros((x.shape[0], *x.shape))
    out[0, 1] = 1/M
    out[1, 0] = -k
    out[1, 1] = -dF_damper_1_dp_1 + dF_damper_2_dp_1
    out[1, 2] = alpha_transducer_1/C
    out[1, 4] = V_capacitor_1*dalpha_transducer_1_dS_1
    out[1, 5] = k
    out[1, 6] = dF_damper_2_dp_2
    out[1, 7] = -alpha_transducer_2/C
    out[1, 9] = -V_capacitor_2*dalpha_transducer_2_dS_2
    out[2, 1] = -alpha_transducer_1/M
    out[2, 3] = 1/L
    out[2, 4] = -v_mass_1*dalpha_transducer_1_dS_1
    out[3, 2] = -1/C
    out[3, 3] = -dV_hysteron_1_dphi_1
    out[3, 4] = -dV_hysteron_1_dS_1
    out[4, 1] = dheat_damper_1_dp_1/T_body_1
    out[4, 3] = dheat_hysteron_1_dphi_1/T_body_1
    out[4, 4] = (
        dheat_hysteron_1_dS_1/T_body_1
        + (-(heat_hysteron_1 + heat_damper_1)/T_body_1**2 - lam*T_e/T_body_1**2)*dT_body_1_minus_T_0_dS_1
        - ds_contact_1_dS_1
    )
    out[4, 9] = -ds_contact_1_dS_2
    out[5, 1] = -1/M
    out[5, 6] = 1/M
    out[6, 1] = -dF_damper_2_dp_1
    out[6, 5] = -k
    out[6, 6] = -dF_damper_2_dp_2 + dF_damper_3_dp_2
    out[6, 7] = alpha_transducer_2/C
    out[6, 9] = V_capacitor_2*dalpha_transducer_2_dS_2
    out[6, 10] = k
    out[6, 11] = dF_damper_3_dp_3
    out[6, 12] = -alpha_transducer_3/C
    out[6, 14] = -V_capacitor_3*dalpha_transducer_3_dS_3
    out[7, 1] = alpha_transducer_2/M
    out[7, 6] = -alpha_transducer_2/M
    out[7, 8] = 1/L
    out[7, 9] = (v_mass_1 - v_mass_2)*dalpha_transducer_2_dS_2
    out[8, 7] = -1/C
    out[8, 8] = -dV_hysteron_2_dphi_2
    out[8, 9] = -dV_hysteron_2_dS_2
    out[9, 1] = dheat_damper_2_dp_1/T_body_2
    out[9, 4] = dheat_contact_1_dS_1/T_body_2
    out[9, 6] = dheat_damper_2_dp_2/T_body_2
    out[9, 8] = dheat_hysteron_2_dphi_2/T_body_2
    out[9, 9] = (
        dheat_hysteron_2_dS_2/T_body_2
        + dheat_contact_1_dS_2/T_body_2
        - (heat_hysteron_2 + heat_damper_2 + heat_contact_1)/T_body_2**2*dT_body_2_minus_T_0_dS_2
        - ds_contact_2_dS_2
    )
    out[9, 14] = -ds_contact_2_dS_3
    out[10, 6] = -1/M
    out[10, 11] = 1/M
    out[11, 6] = -dF_damper_3_dp_2
    out[11, 10] = -k
    out[11, 11] = -dF_damper_3_dp_3
    out[11, 12] = alpha_transducer_3/C
    out[11, 14] = V_capacitor_3*dalpha_transducer_3_dS_3
    out[12, 6] = alpha_transducer_3/M
    out[12, 11] = -alpha_transducer_3/M
    out[12, 13] = 1/L
    out[12, 14] = (v_mass_2 - v_mass_3)*dalpha_transducer_3_dS_3
    out[13, 12] = -1/C
    out[13, 13] = -dV_hysteron_3_dphi_3
    out[13, 14] = -dV_hysteron_3_dS_3
    out[14, 6] = dheat_damper_3_dp_2/T_body_3
    out[14, 9] = dheat_contact_2_dS_2/T_body_3
    out[14, 11] = dheat_damper_3_dp_3/T_body_3
    out[14, 13] = dheat_hysteron_3_dphi_3/T_body_3
    out[14, 14] = (
        dheat_hysteron_3_dS_3/T_body_3
        + dheat_contact_2_dS_3/T_body_3
        + (-(heat_hysteron_3 + heat_damper_3 + heat_contact_2)/T_body_3**2 - lam*T_e/T_body_3**2)*dT_body_3_minus_T_0_dS_3
    )
    return out


def margins(x, u, p, /):
    """Margin by which each condition of DOMAIN holds; of a bank, the least one; shape (len(DOMAIN), *batch)."""
    x = _states(x, p)
    u = _inputs(u)
    M = p.M
    k = p.k
    d = p.d
    C = p.C
    L = p.L
    rho = p.rho
    i_0 = p.i_0
    T_0 = p.T_0
    c_0 = p.c_0
    lam = p.lam
    lam_l = p.lam_l
    S_1 = x[4]
    S_2 = x[9]
    S_3 = x[14]
    T_e = u[2]
    # co-states dU/dx
    T_body_1_minus_T_0 = T_0*np.expm1(S_1/c_0)
    T_body_2_minus_T_0 = T_0*np.expm1(S_2/c_0)
    T_body_3_minus_T_0 = T_0*np.expm1(S_3/c_0)
    # result
    out = np.empty((15, *x.shape[1:]))
    out[0] = T_body_1_minus_T_0
    out[1] = T_body_2_minus_T_0
    out[2] = T_body_3_minus_T_0
    out[3] = T_e - T_0
    out[4] = d
    out[5] = rho
    out[6] = i_0
    out[7] = lam
    out[8] = lam_l
    out[9] = k
    out[10] = M
    out[11] = C
    out[12] = L
    out[13] = T_0
    out[14] = c_0
    return out
