"""Piezoelectric stack with Maxwell-slip: 40 um at 150 V: irreversible port-Hamiltonian system.

Source:  Goldfarb, Celanovic (1997), Modeling piezoelectric stack actuators; loop measured by Chandra et al. (2023), doi 10.1063/5.0146134
Model:   stack_maxwell, spec sha256 a4fac994b19a17a907de6d8bbc2fec285a640ebfd27501f5fec69ade7095faff
System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
         rows, multiplied out; `piezo-sym show` prints the matrices
Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, rate-independent, sigma, exergy, environment, units, program PROVED
         (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
         parameters in the domain, and for banks of any size)

Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
Arrays have shape (n, *batch); values are in SI units.

x = (Q, p, q, z_1 ... z_slips_count, S)
u = (F_ext, V_in, T_e)
p_ = Parameters(); the underscore tells it from p, a name of the model
bank slips: lanes j = 1 ... Parameters.slips_count
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

NAME = "stack_maxwell"
SPEC_SHA256 = "a4fac994b19a17a907de6d8bbc2fec285a640ebfd27501f5fec69ade7095faff"


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
    Record("Q", "C", "charge of capacitor 'clamped'"),
    Record("p", "kg*m/s", "momentum of mass 'mass'"),
    Record("q", "m", "extension of spring 'spring'"),
    Record("z", "m", "extension of stop 'slips'", "slips"),
    Record("S", "J/K", "entropy of thermal_mass 'body'"),
)
INPUTS = (
    Record("F_ext", "N", "external force on the tip"),
    Record("V_in", "V", "voltage of the amplifier"),
    Record("T_e", "K", "temperature of the air"),
)
INPUT_DEFAULTS = (0.0, 0.0, 296.15)
# rows of outputs() and supply(): ports, named after the elements that have the inputs
OUTPUTS = (
    Record("load", "m/s", "velocity at force_source 'load'"),
    Record("amplifier", "A", "current given by voltage_source 'amplifier'"),
    Record("air", "K", "temperature of thermal_mass 'body'"),
)
# rows of heat() and entropy_production(): processes, with the unit of the second
PROCESSES = (
    Record("leads", "W/K", "resistor 'leads'"),
    Record("slips", "W/K", "stop 'slips'", "slips"),
    Record("damper", "W/K", "damper 'damper'"),
)
# rows of temperatures(), and of elements()
BODIES = (
    Record("body", "K", "temperature of thermal_mass 'body'"),
)
ELEMENTS = (
    Record("amplifier.effort", "V", "voltage of voltage_source 'amplifier'"),
    Record("amplifier.flow", "A", "current of voltage_source 'amplifier'"),
    Record("amplifier.power", "W", "power into voltage_source 'amplifier'"),
    Record("leads.effort", "V", "voltage of resistor 'leads'"),
    Record("leads.flow", "A", "current of resistor 'leads'"),
    Record("leads.power", "W", "power into resistor 'leads'"),
    Record("leads.heat", "W", "heat of resistor 'leads'"),
    Record("clamped.effort", "V", "voltage of capacitor 'clamped'"),
    Record("clamped.flow", "A", "current of capacitor 'clamped'"),
    Record("clamped.power", "W", "power into capacitor 'clamped'"),
    Record("clamped.energy", "J", "energy of capacitor 'clamped'"),
    Record("ceramic.effort_1", "V", "voltage in branch 1 of transducer 'ceramic'"),
    Record("ceramic.flow_1", "A", "current in branch 1 of transducer 'ceramic'"),
    Record("ceramic.effort_2", "N", "force in branch 2 of transducer 'ceramic'"),
    Record("ceramic.flow_2", "m/s", "velocity in branch 2 of transducer 'ceramic'"),
    Record("ceramic.power", "W", "power from branch 1 to branch 2 of transducer 'ceramic'"),
    Record("mass.effort", "N", "force of mass 'mass'"),
    Record("mass.flow", "m/s", "velocity of mass 'mass'"),
    Record("mass.power", "W", "power into mass 'mass'"),
    Record("mass.energy", "J", "energy of mass 'mass'"),
    Record("spring.effort", "N", "force of spring 'spring'"),
    Record("spring.flow", "m/s", "velocity of spring 'spring'"),
    Record("spring.power", "W", "power into spring 'spring'"),
    Record("spring.energy", "J", "energy of spring 'spring'"),
    Record("slips.effort", "N", "force of stop 'slips'", "slips"),
    Record("slips.flow", "m/s", "velocity of stop 'slips'", "slips"),
    Record("slips.power", "W", "power into stop 'slips'", "slips"),
    Record("slips.energy", "J", "energy of stop 'slips'", "slips"),
    Record("slips.heat", "W", "heat of stop 'slips'", "slips"),
    Record("slips.limit", "N", "largest effort of stop 'slips'", "slips"),
    Record("damper.effort", "N", "force of damper 'damper'"),
    Record("damper.flow", "m/s", "velocity of damper 'damper'"),
    Record("damper.power", "W", "power into damper 'damper'"),
    Record("damper.heat", "W", "heat of damper 'damper'"),
    Record("load.effort", "N", "force of force_source 'load'"),
    Record("load.flow", "m/s", "velocity of force_source 'load'"),
    Record("load.power", "W", "power into force_source 'load'"),
    Record("body.effort", "K", "temperature of thermal_mass 'body'"),
    Record("body.flow", "W/K", "entropy flow of thermal_mass 'body'"),
    Record("body.power", "W", "power into thermal_mass 'body'"),
    Record("body.energy", "J", "energy of thermal_mass 'body'"),
    Record("air.effort", "K", "temperature at ambient 'air'"),
    Record("air.flow", "W/K", "entropy flow at ambient 'air'"),
    Record("air.power", "W", "power into ambient 'air'"),
)
# fields of Parameters; elements of many lanes; conditions under which the proofs hold
PARAMETERS = (
    Record("m", "kg", "moving mass"),
    Record("d", "N*s/m", "damping"),
    Record("a", "N/V", "force constant: 50 N/um and 39 um at 150 V"),
    Record("C", "F", "capacitance, clamped"),
    Record("R", "ohm", "resistance of the amplifier and leads"),
    Record("k", "N/m", "stiffness that never yields"),
    Record("k_s", "N/m", "stiffness of each slip", "slips"),
    Record("r", "m", "extension at which each yields", "slips"),
    Record("T_0", "K", "temperature at the start"),
    Record("c_0", "J/K", "heat capacity"),
    Record("lam", "W/K", "heat conductance to the air"),
)
BANKS = ("slips",)
DOMAIN = (
    Condition("T_e > 0", True),
    Condition("R > 0", True),
    Condition("d >= 0", False),
    Condition("lam >= 0", False),
    Condition("C > 0", True),
    Condition("m > 0", True),
    Condition("k > 0", True),
    Condition("k_s > 0", True),
    Condition("k_s*r >= 0", False),
    Condition("T_0 > 0", True),
    Condition("c_0 > 0", True),
)


_Lanes = float | tuple[float, ...]  # a bank's parameter: one value, or one per lane


@dataclass(frozen=True)
class Parameters:
    """Parameters of stack_maxwell in SI units; defaults are the values of the spec."""

    m: float = 0.02
    d: float = 100.0
    a: float = 6.0
    C: float = 6.4e-06
    R: float = 10.0
    k: float = 24560000.0
    k_s: _Lanes = (11270000.0, 1056000.0, 4535000.0, 2234000.0, 744300.0, 4553000.0, 1170000.0, 12980000.0)
    r: _Lanes = (2.35e-06, 4.7e-06, 7.05e-06, 9.4e-06, 1.175e-05, 1.41e-05, 1.645e-05, 1.88e-05)
    T_0: float = 296.15
    c_0: float = 5.0
    lam: float = 0.05
    slips_count: int = 8


def _states(x, p):
    """Return states x, shape (n, *batch), as floats."""
    x = np.asarray(x, dtype=float)
    n = 4 + p.slips_count
    if x.shape[:1] != (n,):
        raise ValueError(f"x has shape {x.shape}, but there are {n} states")
    return x


def _inputs(u):
    """Return inputs u, shape (3, *batch), as floats."""
    u = np.asarray(u, dtype=float)
    if u.shape[:1] != (3,):
        raise ValueError(f"u has shape {u.shape}, but there are 3 inputs")
    return u


def _lanes(value, count, ndim):
    """Return a bank's parameter: a number, or values of shape (count,) or (count, *batch)."""
    if np.ndim(value) == 0:
        return value
    value = np.asarray(value, dtype=float)
    if len(value) != count or value.ndim > ndim:
        raise ValueError(f"a parameter of a bank of {count} lanes has {len(value)} values")
    return value.reshape(*value.shape, *(1,) * (ndim - value.ndim))


def initial_state(u, p_, /):
    """State at t = 0 [SI], for the inputs u at t = 0; shape (n,)."""
    u = _inputs(u)
    slips_count = p_.slips_count
    T_0 = p_.T_0
    c_0 = p_.c_0
    T_e = u[2]
    out = np.zeros(4 + slips_count)
    out[3 + slips_count] = c_0*np.log(T_e/T_0)
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


def _rates(x, u, p_, out, /):
    """Write the rates dx/dt into `out`."""
    slips_count = p_.slips_count
    m = p_.m
    d = p_.d
    a = p_.a
    C = p_.C
    R = p_.R
    k = p_.k
    k_s = _lanes(p_.k_s, slips_count, x.ndim)
    r = _lanes(p_.r, slips_count, x.ndim)
    T_0 = p_.T_0
    c_0 = p_.c_0
    lam = p_.lam
    Q = x[0]
    p = x[1]
    q = x[2]
    z = x[3 : 3 + slips_count]
    S = x[3 + slips_count]
    F_ext = u[0]
    V_in = u[1]
    T_e = u[2]
    # co-states dU/dx
    V_clamped = Q/C
    v_mass = p/m
    F_spring = k*q
    F_slips = k_s*z
    T = T_0*np.exp(S/c_0)
    # sums over lanes
    sum_F_slips = np.sum(F_slips, axis=0)
    # transducer ratios
    alpha_ceramic = a
    # driving forces
    V_leads = -V_clamped + V_in
    # dissipative laws
    i_leads = V_leads/R
    F_damper = d*v_mass
    slip_slips = np.where(v_mass > 0, np.where(F_slips >= k_s*r, v_mass, 0), np.where(F_slips <= -k_s*r, v_mass, 0))
    # heats
    heat_leads = i_leads*V_leads
    # sums over lanes
    heat_slips = np.sum(slip_slips*F_slips, axis=0)
    # heats
    heat_damper = F_damper*v_mass
    # result
    out[0] = i_leads - alpha_ceramic*v_mass
    out[1] = alpha_ceramic*V_clamped - F_spring - sum_F_slips - F_damper + F_ext
    out[2] = v_mass
    out[3 : 3 + slips_count] = v_mass - slip_slips
    out[3 + slips_count] = (heat_leads + heat_slips + heat_damper)/T + lam*(T_e/T - 1)


def outputs(x, u, p_, /):
    """Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient; shape (3, *batch)."""
    x = _states(x, p_)
    u = _inputs(u)
    slips_count = p_.slips_count
    m = p_.m
    C = p_.C
    R = p_.R
    T_0 = p_.T_0
    c_0 = p_.c_0
    Q = x[0]
    p = x[1]
    S = x[3 + slips_count]
    V_in = u[1]
    # co-states dU/dx
    V_clamped = Q/C
    v_mass = p/m
    T = T_0*np.exp(S/c_0)
    # driving forces
    V_leads = -V_clamped + V_in
    # dissipative laws
    i_leads = V_leads/R
    # result
    out = np.empty((3, *x.shape[1:]))
    out[0] = v_mass
    out[1] = i_leads
    out[2] = T
    return out


def supply(x, u, p_, /):
    """Power supplied through each port [W]; the sum is dU/dt; shape (3, *batch)."""
    x = _states(x, p_)
    u = _inputs(u)
    slips_count = p_.slips_count
    m = p_.m
    C = p_.C
    R = p_.R
    T_0 = p_.T_0
    c_0 = p_.c_0
    lam = p_.lam
    Q = x[0]
    p = x[1]
    S = x[3 + slips_count]
    F_ext = u[0]
    V_in = u[1]
    T_e = u[2]
    # co-states dU/dx
    V_clamped = Q/C
    v_mass = p/m
    T = T_0*np.exp(S/c_0)
    # driving forces
    V_leads = -V_clamped + V_in
    # dissipative laws
    i_leads = V_leads/R
    # result
    out = np.empty((3, *x.shape[1:]))
    out[0] = v_mass*F_ext
    out[1] = i_leads*V_in
    out[2] = lam*(T_e - T)
    return out


def energy(x, p_, /):
    """Hamiltonian U [J]; shape (*batch)."""
    x = _states(x, p_)
    slips_count = p_.slips_count
    m = p_.m
    C = p_.C
    k = p_.k
    k_s = _lanes(p_.k_s, slips_count, x.ndim)
    T_0 = p_.T_0
    c_0 = p_.c_0
    Q = x[0]
    p = x[1]
    q = x[2]
    z = x[3 : 3 + slips_count]
    S = x[3 + slips_count]
    # sums over lanes
    energy_z = np.sum(k_s*z**2/2, axis=0)
    return Q**2/(2*C) + p**2/(2*m) + k*q**2/2 + energy_z + T_0*c_0*np.exp(S/c_0)


def entropy(x, p_, /):
    """Total entropy S [J/K]; shape (*batch)."""
    x = _states(x, p_)
    slips_count = p_.slips_count
    S = x[3 + slips_count]
    return S.copy()


def temperatures(x, p_, /):
    """Temperature of each body [K]; shape (1, *batch)."""
    x = _states(x, p_)
    slips_count = p_.slips_count
    T_0 = p_.T_0
    c_0 = p_.c_0
    S = x[3 + slips_count]
    # co-states dU/dx
    T = T_0*np.exp(S/c_0)
    # result
    out = np.empty((1, *x.shape[1:]))
    out[0] = T
    return out


def heat(x, u, p_, /):
    """Power that each process turns into heat [W]; of a bank, one row per lane; shape (2 + slips_count, *batch)."""
    x = _states(x, p_)
    u = _inputs(u)
    slips_count = p_.slips_count
    m = p_.m
    d = p_.d
    C = p_.C
    R = p_.R
    k_s = _lanes(p_.k_s, slips_count, x.ndim)
    r = _lanes(p_.r, slips_count, x.ndim)
    Q = x[0]
    p = x[1]
    z = x[3 : 3 + slips_count]
    V_in = u[1]
    # co-states dU/dx
    V_clamped = Q/C
    v_mass = p/m
    F_slips = k_s*z
    # driving forces
    V_leads = -V_clamped + V_in
    # dissipative laws
    i_leads = V_leads/R
    F_damper = d*v_mass
    slip_slips = np.where(v_mass > 0, np.where(F_slips >= k_s*r, v_mass, 0), np.where(F_slips <= -k_s*r, v_mass, 0))
    # result
    out = np.empty((2 + slips_count, *x.shape[1:]))
    out[0] = i_leads*V_leads
    out[1 : 1 + slips_count] = slip_slips*F_slips
    out[1 + slips_count] = F_damper*v_mass
    return out


def entropy_production(x, u, p_, /):
    """Entropy production of each process [W/K], heat exchange with ambients not included; of a bank, one row per lane; shape (2 + slips_count, *batch)."""
    x = _states(x, p_)
    u = _inputs(u)
    slips_count = p_.slips_count
    m = p_.m
    d = p_.d
    C = p_.C
    R = p_.R
    k_s = _lanes(p_.k_s, slips_count, x.ndim)
    r = _lanes(p_.r, slips_count, x.ndim)
    T_0 = p_.T_0
    c_0 = p_.c_0
    Q = x[0]
    p = x[1]
    z = x[3 : 3 + slips_count]
    S = x[3 + slips_count]
    V_in = u[1]
    # co-states dU/dx
    V_clamped = Q/C
    v_mass = p/m
    F_slips = k_s*z
    T = T_0*np.exp(S/c_0)
    # driving forces
    V_leads = -V_clamped + V_in
    # dissipative laws
    i_leads = V_leads/R
    F_damper = d*v_mass
    slip_slips = np.where(v_mass > 0, np.where(F_slips >= k_s*r, v_mass, 0), np.where(F_slips <= -k_s*r, v_mass, 0))
    # result
    out = np.empty((2 + slips_count, *x.shape[1:]))
    out[0] = i_leads*V_leads/T
    out[1 : 1 + slips_count] = slip_slips*F_slips/T
    out[1 + slips_count] = F_damper*v_mass/T
    return out


def elements(x, u, p_, /):
    """Effort, flow, power, energy and heat of elements; of a bank, one row per lane; shape (38 + 6*slips_count, *batch)."""
    x = _states(x, p_)
    u = _inputs(u)
    slips_count = p_.slips_count
    m = p_.m
    d = p_.d
    a = p_.a
    C = p_.C
    R = p_.R
    k = p_.k
    k_s = _lanes(p_.k_s, slips_count, x.ndim)
    r = _lanes(p_.r, slips_count, x.ndim)
    T_0 = p_.T_0
    c_0 = p_.c_0
    lam = p_.lam
    Q = x[0]
    p = x[1]
    q = x[2]
    z = x[3 : 3 + slips_count]
    S = x[3 + slips_count]
    F_ext = u[0]
    V_in = u[1]
    T_e = u[2]
    # co-states dU/dx
    V_clamped = Q/C
    v_mass = p/m
    F_spring = k*q
    F_slips = k_s*z
    T = T_0*np.exp(S/c_0)
    # sums over lanes
    sum_F_slips = np.sum(F_slips, axis=0)
    # transducer ratios
    alpha_ceramic = a
    # driving forces
    V_leads = -V_clamped + V_in
    # dissipative laws
    i_leads = V_leads/R
    F_damper = d*v_mass
    slip_slips = np.where(v_mass > 0, np.where(F_slips >= k_s*r, v_mass, 0), np.where(F_slips <= -k_s*r, v_mass, 0))
    # heats
    heat_leads = i_leads*V_leads
    # sums over lanes
    heat_slips = np.sum(slip_slips*F_slips, axis=0)
    # heats
    heat_damper = F_damper*v_mass
    # rates
    rate_Q = i_leads - alpha_ceramic*v_mass
    rate_p = alpha_ceramic*V_clamped - F_spring - sum_F_slips - F_damper + F_ext
    rate_z = v_mass - slip_slips
    rate_S = (heat_leads + heat_slips + heat_damper)/T + lam*(T_e/T - 1)
    # result
    end_slips_effort = 24 + slips_count
    end_slips_flow = end_slips_effort + slips_count
    end_slips_power = end_slips_flow + slips_count
    end_slips_energy = end_slips_power + slips_count
    end_slips_heat = end_slips_energy + slips_count
    end_slips_limit = end_slips_heat + slips_count
    out = np.empty((14 + end_slips_limit, *x.shape[1:]))
    out[0] = V_in
    out[1] = -i_leads
    out[2] = -i_leads*V_in
    out[3] = V_leads
    out[4] = i_leads
    out[5] = i_leads*V_leads
    out[6] = i_leads*V_leads
    out[7] = V_clamped
    out[8] = rate_Q
    out[9] = V_clamped*rate_Q
    out[10] = Q**2/(2*C)
    out[11] = V_clamped
    out[12] = alpha_ceramic*v_mass
    out[13] = -alpha_ceramic*V_clamped
    out[14] = v_mass
    out[15] = V_clamped*alpha_ceramic*v_mass
    out[16] = rate_p
    out[17] = v_mass
    out[18] = rate_p*v_mass
    out[19] = p**2/(2*m)
    out[20] = F_spring
    out[21] = v_mass
    out[22] = F_spring*v_mass
    out[23] = k*q**2/2
    out[24 : end_slips_effort] = F_slips
    out[end_slips_effort : end_slips_flow] = rate_z + slip_slips
    out[end_slips_flow : end_slips_power] = F_slips*(rate_z + slip_slips)
    out[end_slips_power : end_slips_energy] = k_s*z**2/2
    out[end_slips_energy : end_slips_heat] = slip_slips*F_slips
    out[end_slips_heat : end_slips_limit] = k_s*r
    out[end_slips_limit] = F_damper
    out[1 + end_slips_limit] = v_mass
    out[2 + end_slips_limit] = F_damper*v_mass
    out[3 + end_slips_limit] = F_damper*v_mass
    out[4 + end_slips_limit] = -F_ext
    out[5 + end_slips_limit] = v_mass
    out[6 + end_slips_limit] = -v_mass*F_ext
    out[7 + end_slips_limit] = T
    out[8 + end_slips_limit] = rate_S
    out[9 + end_slips_limit] = T*rate_S
    out[10 + end_slips_limit] = T_0*c_0*np.exp(S/c_0)
    out[11 + end_slips_limit] = T
    out[12 + end_slips_limit] = -lam*(T_e/T - 1)
    out[13 + end_slips_limit] = -lam*(T_e - T)
    return out


@np.errstate(divide="ignore", invalid="ignore")
def jacobian(x, u, p_, /):
    """Jacobian of rhs, d rhs[i]/d x[j] at [i, j]; shape (n, n, *batch)."""
    x = _states(x, p_)
    u = _inputs(u)
    slips_count = p_.slips_count
    m = p_.m
    d = p_.d
    a = p_.a
    C = p_.C
    R = p_.R
    k = p_.k
    k_s = _lanes(p_.k_s, slips_count, x.ndim)
    r = _lanes(p_.r, slips_count, x.ndim)
    T_0 = p_.T_0
    c_0 = p_.c_0
    lam = p_.lam
    Q = x[0]
    p = x[1]
    z = x[3 : 3 + slips_count]
    S = x[3 + slips_count]
    V_in = u[1]
    T_e = u[2]
    # co-states dU/dx
    V_clamped = Q/C
    v_mass = p/m
    F_slips = k_s*z
    T = T_0*np.exp(S/c_0)
    # transducer ratios
    alpha_ceramic = a
    # driving forces
    V_leads = -V_clamped + V_in
    # dissipative laws
    i_leads = V_leads/R
    F_damper = d*v_mass
    slip_slips = np.where(v_mass > 0, np.where(F_slips >= k_s*r, v_mass, 0), np.where(F_slips <= -k_s*r, v_mass, 0))
    # heats
    heat_leads = i_leads*V_leads
    # sums over lanes
    heat_slips = np.sum(slip_slips*F_slips, axis=0)
    # heats
    heat_damper = F_damper*v_mass
    # derivatives
    di_leads_dQ = -1/R/C
    dheat_leads_dQ = V_leads*di_leads_dQ - i_leads/C
    dF_damper_dp = d/m
    dslip_slips_dp = np.where(v_mass > 0, np.where(F_slips >= k_s*r, 1/m, 0), np.where(F_slips <= -k_s*r, 1/m, 0))
    # sums over lanes
    dheat_slips_dp = np.sum(F_slips*dslip_slips_dp, axis=0)
    # derivatives
    dheat_damper_dp = v_mass*dF_damper_dp + F_damper/m
    dheat_slips_dz = slip_slips*k_s
    dT_dS = T/c_0
    # result
    out = np.zeros((x.shape[0], *x.shape))
    out[0, 0] = di_leads_dQ
    out[0, 1] = -alpha_ceramic/m
    out[1, 0] = alpha_ceramic/C
    out[1, 1] = -dF_damper_dp
    out[1, 2] = -k
    out[1, 3 : 3 + slips_count] = -k_s
    out[2, 1] = 1/m
    out[3 : 3 + slips_count, 1] = 1/m - dslip_slips_dp
    out[3 + slips_count, 0] = dheat_leads_dQ/T
    out[3 + slips_count, 1] = dheat_slips_dp/T + dheat_damper_dp/T
    out[3 + slips_count, 3 : 3 + slips_count] = dheat_slips_dz/T
    out[3 + slips_count, 3 + slips_count] = (-(heat_leads + heat_slips + heat_damper)/T**2 - lam*T_e/T**2)*dT_dS
    return out


def margins(x, u, p_, /):
    """Margin by which each condition of DOMAIN holds; of a bank, the least one; shape (len(DOMAIN), *batch)."""
    x = _states(x, p_)
    u = _inputs(u)
    slips_count = p_.slips_count
    m = p_.m
    d = p_.d
    C = p_.C
    R = p_.R
    k = p_.k
    k_s = _lanes(p_.k_s, slips_count, x.ndim)
    r = _lanes(p_.r, slips_count, x.ndim)
    T_0 = p_.T_0
    c_0 = p_.c_0
    lam = p_.lam
    T_e = u[2]
    out = np.empty((11, *x.shape[1:]))
    out[0] = T_e
    out[1] = R
    out[2] = d
    out[3] = lam
    out[4] = C
    out[5] = m
    out[6] = k
    out[7] = np.min(k_s, axis=0)
    out[8] = np.min(k_s*r, axis=0)
    out[9] = T_0
    out[10] = c_0
    return out
