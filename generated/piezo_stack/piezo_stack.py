"""Piezoelectric stack actuator with hysterons: irreversible port-Hamiltonian system.

Source:  Caballeria, Ramirez, Le Gorrec (2021), eqs. (9)-(13), Table 1
Model:   piezo_stack, spec sha256 9c0235a60e02072bc451611ffa723f273272c8e4536a3089081866f47c89389c
System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
         rows, multiplied out; `piezo-sym show` prints the matrices
Proofs:  skew, casimir, temperature, energy, entropy, welldef, continuous, passive, odd, sigma, exergy, environment, invariant, units, program PROVED
         (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
         parameters in the domain, and for banks of any size)

Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
Arrays have shape (n, *batch); values are in SI units.

x = (q, p, Q_C, phi_1 ... phi_hysteron_count, S)
u = (F_ext, V_in, T_e)
p_ = Parameters(); the underscore tells it from p, a name of the model
bank hysteron: lanes j = 1 ... Parameters.hysteron_count
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

NAME = "piezo_stack"
SPEC_SHA256 = "9c0235a60e02072bc451611ffa723f273272c8e4536a3089081866f47c89389c"


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
    Record("q", "m", "extension of spring 'spring'"),
    Record("p", "kg*m/s", "momentum of mass 'mass'"),
    Record("Q_C", "C", "charge of capacitor 'capacitor'"),
    Record("phi", "Wb", "flux linkage of hysteron 'hysteron'", "hysteron"),
    Record("S", "J/K", "entropy of thermal_mass 'body'"),
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
    Record("ambient", "K", "temperature of thermal_mass 'body'"),
)
# rows of heat() and entropy_production(): processes, with the unit of the second
PROCESSES = (
    Record("hysteron", "W/K", "hysteron 'hysteron'", "hysteron"),
    Record("damper", "W/K", "damper 'damper'"),
)
# rows of temperatures(), and of elements()
BODIES = (
    Record("body", "K", "temperature of thermal_mass 'body'"),
)
ELEMENTS = (
    Record("spring.effort", "N", "force of spring 'spring'"),
    Record("spring.flow", "m/s", "velocity of spring 'spring'"),
    Record("spring.power", "W", "power into spring 'spring'"),
    Record("spring.energy", "J", "energy of spring 'spring'"),
    Record("mass.effort", "N", "force of mass 'mass'"),
    Record("mass.flow", "m/s", "velocity of mass 'mass'"),
    Record("mass.power", "W", "power into mass 'mass'"),
    Record("mass.energy", "J", "energy of mass 'mass'"),
    Record("capacitor.effort", "V", "voltage of capacitor 'capacitor'"),
    Record("capacitor.flow", "A", "current of capacitor 'capacitor'"),
    Record("capacitor.power", "W", "power into capacitor 'capacitor'"),
    Record("capacitor.energy", "J", "energy of capacitor 'capacitor'"),
    Record("hysteron.effort", "V", "voltage of hysteron 'hysteron'", "hysteron"),
    Record("hysteron.flow", "A", "current of hysteron 'hysteron'", "hysteron"),
    Record("hysteron.power", "W", "power into hysteron 'hysteron'", "hysteron"),
    Record("hysteron.energy", "J", "energy of hysteron 'hysteron'", "hysteron"),
    Record("hysteron.heat", "W", "heat of hysteron 'hysteron'", "hysteron"),
    Record("damper.effort", "N", "force of damper 'damper'"),
    Record("damper.flow", "m/s", "velocity of damper 'damper'"),
    Record("damper.power", "W", "power into damper 'damper'"),
    Record("damper.heat", "W", "heat of damper 'damper'"),
    Record("transducer.effort_1", "V", "voltage in branch 1 of transducer 'transducer'"),
    Record("transducer.flow_1", "A", "current in branch 1 of transducer 'transducer'"),
    Record("transducer.effort_2", "N", "force in branch 2 of transducer 'transducer'"),
    Record("transducer.flow_2", "m/s", "velocity in branch 2 of transducer 'transducer'"),
    Record("transducer.power", "W", "power from branch 1 to branch 2 of transducer 'transducer'"),
    Record("body.effort", "K", "temperature of thermal_mass 'body'"),
    Record("body.flow", "W/K", "entropy flow of thermal_mass 'body'"),
    Record("body.power", "W", "power into thermal_mass 'body'"),
    Record("body.energy", "J", "energy of thermal_mass 'body'"),
    Record("ambient.effort", "K", "temperature at ambient 'ambient'"),
    Record("ambient.flow", "W/K", "entropy flow at ambient 'ambient'"),
    Record("ambient.power", "W", "power into ambient 'ambient'"),
    Record("load.effort", "N", "force of force_source 'load'"),
    Record("load.flow", "m/s", "velocity of force_source 'load'"),
    Record("load.power", "W", "power into force_source 'load'"),
    Record("supply.effort", "V", "voltage of voltage_source 'supply'"),
    Record("supply.flow", "A", "current of voltage_source 'supply'"),
    Record("supply.power", "W", "power into voltage_source 'supply'"),
)
# fields of Parameters; elements of many lanes; conditions under which the proofs hold
PARAMETERS = (
    Record("M", "kg", "moving mass"),
    Record("k", "N/m", "stiffness"),
    Record("q_l", "m", "rest position of the spring"),
    Record("d", "N*s/m", "damping"),
    Record("C", "F", "capacitance"),
    Record("L", "H", "inductance of one hysteron", "hysteron"),
    Record("rho", "ohm*K", "resistance law: slope rho/(T - T_0)", "hysteron"),
    Record("i_0", "A", "half width of the dead zone", "hysteron"),
    Record("a", "C/m", "transducer ratio at T_0"),
    Record("T_0", "K", "reference temperature"),
    Record("c_0", "J/K", "heat capacity"),
    Record("lam", "W/K", "heat conductance to the environment"),
)
BANKS = ("hysteron",)
DOMAIN = (
    Condition("T > T_0", True),
    Condition("T_e > T_0", True),
    Condition("d >= 0", False),
    Condition("rho >= 0", False),
    Condition("i_0 >= 0", False),
    Condition("lam >= 0", False),
    Condition("k > 0", True),
    Condition("M > 0", True),
    Condition("C > 0", True),
    Condition("L > 0", True),
    Condition("T_0 > 0", True),
    Condition("c_0 > 0", True),
)


_Lanes = float | tuple[float, ...]  # a bank's parameter: one value, or one per lane


@dataclass(frozen=True)
class Parameters:
    """Parameters of piezo_stack in SI units; defaults are the values of the spec."""

    M: float = 0.0035
    k: float = 500000.0
    q_l: float = 0.0
    d: float = 400.0
    C: float = 5e-06
    L: _Lanes = 0.001
    rho: _Lanes = 10.0
    i_0: _Lanes = 0.5
    a: float = 10.0
    T_0: float = 296.15
    c_0: float = 5.0
    lam: float = 2.0
    hysteron_count: int = 2


def _states(x, p):
    """Return states x, shape (n, *batch), as floats."""
    x = np.asarray(x, dtype=float)
    n = 4 + p.hysteron_count
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
    hysteron_count = p_.hysteron_count
    T_0 = p_.T_0
    c_0 = p_.c_0
    T_e = u[2]
    out = np.zeros(4 + hysteron_count)
    out[3 + hysteron_count] = c_0*np.log(T_e/T_0)
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
    hysteron_count = p_.hysteron_count
    M = p_.M
    k = p_.k
    q_l = p_.q_l
    d = p_.d
    C = p_.C
    L = _lanes(p_.L, hysteron_count, x.ndim)
    rho = _lanes(p_.rho, hysteron_count, x.ndim)
    i_0 = _lanes(p_.i_0, hysteron_count, x.ndim)
    a = p_.a
    T_0 = p_.T_0
    c_0 = p_.c_0
    lam = p_.lam
    q = x[0]
    p = x[1]
    Q_C = x[2]
    phi = x[3 : 3 + hysteron_count]
    S = x[3 + hysteron_count]
    F_ext = u[0]
    V_in = u[1]
    T_e = u[2]
    # co-states dU/dx
    F_spring = k*(q - q_l)
    v_mass = p/M
    V_capacitor = Q_C/C
    i_hysteron = phi/L
    T_minus_T_0 = T_0*np.expm1(S/c_0)
    T = T_0 + T_minus_T_0
    # sums over lanes
    sum_i_hysteron = np.sum(i_hysteron, axis=0)
    # transducer ratios
    alpha_transducer = a*T/T_0
    # dissipative laws
    V_hysteron = rho/T_minus_T_0*(i_hysteron - np.clip(i_hysteron, -i_0, i_0))
    F_damper = d*v_mass
    # sums over lanes
    heat_hysteron = np.sum(V_hysteron*i_hysteron, axis=0)
    # heats
    heat_damper = F_damper*v_mass
    # result
    out[0] = v_mass
    out[1] = alpha_transducer*V_capacitor - F_spring - F_damper + F_ext
    out[2] = sum_i_hysteron - alpha_transducer*v_mass
    out[3 : 3 + hysteron_count] = V_in - V_capacitor - V_hysteron
    out[3 + hysteron_count] = (heat_hysteron + heat_damper)/T + lam*(T_e/T - 1)


def outputs(x, u, p_, /):
    """Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient; shape (3, *batch)."""
    x = _states(x, p_)
    hysteron_count = p_.hysteron_count
    M = p_.M
    L = _lanes(p_.L, hysteron_count, x.ndim)
    T_0 = p_.T_0
    c_0 = p_.c_0
    p = x[1]
    phi = x[3 : 3 + hysteron_count]
    S = x[3 + hysteron_count]
    # co-states dU/dx
    v_mass = p/M
    i_hysteron = phi/L
    T_minus_T_0 = T_0*np.expm1(S/c_0)
    T = T_0 + T_minus_T_0
    # sums over lanes
    sum_i_hysteron = np.sum(i_hysteron, axis=0)
    # result
    out = np.empty((3, *x.shape[1:]))
    out[0] = v_mass
    out[1] = sum_i_hysteron
    out[2] = T
    return out


def supply(x, u, p_, /):
    """Power supplied through each port [W]; the sum is dU/dt; shape (3, *batch)."""
    x = _states(x, p_)
    u = _inputs(u)
    hysteron_count = p_.hysteron_count
    M = p_.M
    L = _lanes(p_.L, hysteron_count, x.ndim)
    T_0 = p_.T_0
    c_0 = p_.c_0
    lam = p_.lam
    p = x[1]
    phi = x[3 : 3 + hysteron_count]
    S = x[3 + hysteron_count]
    F_ext = u[0]
    V_in = u[1]
    T_e = u[2]
    # co-states dU/dx
    v_mass = p/M
    i_hysteron = phi/L
    T_minus_T_0 = T_0*np.expm1(S/c_0)
    T = T_0 + T_minus_T_0
    # sums over lanes
    sum_i_hysteron = np.sum(i_hysteron, axis=0)
    # result
    out = np.empty((3, *x.shape[1:]))
    out[0] = v_mass*F_ext
    out[1] = sum_i_hysteron*V_in
    out[2] = lam*(T_e - T)
    return out


def energy(x, p_, /):
    """Hamiltonian U [J]; shape (*batch)."""
    x = _states(x, p_)
    hysteron_count = p_.hysteron_count
    M = p_.M
    k = p_.k
    q_l = p_.q_l
    C = p_.C
    L = _lanes(p_.L, hysteron_count, x.ndim)
    T_0 = p_.T_0
    c_0 = p_.c_0
    q = x[0]
    p = x[1]
    Q_C = x[2]
    phi = x[3 : 3 + hysteron_count]
    S = x[3 + hysteron_count]
    # sums over lanes
    energy_phi = np.sum(phi**2/(2*L), axis=0)
    return k*(q - q_l)**2/2 + p**2/(2*M) + Q_C**2/(2*C) + energy_phi + T_0*c_0*np.exp(S/c_0)


def entropy(x, p_, /):
    """Total entropy S [J/K]; shape (*batch)."""
    x = _states(x, p_)
    hysteron_count = p_.hysteron_count
    S = x[3 + hysteron_count]
    return S.copy()


def temperatures(x, p_, /):
    """Temperature of each body [K]; shape (1, *batch)."""
    x = _states(x, p_)
    hysteron_count = p_.hysteron_count
    T_0 = p_.T_0
    c_0 = p_.c_0
    S = x[3 + hysteron_count]
    # co-states dU/dx
    T_minus_T_0 = T_0*np.expm1(S/c_0)
    T = T_0 + T_minus_T_0
    # result
    out = np.empty((1, *x.shape[1:]))
    out[0] = T
    return out


def heat(x, u, p_, /):
    """Power that each process turns into heat [W]; of a bank, one row per lane; shape (1 + hysteron_count, *batch)."""
    x = _states(x, p_)
    hysteron_count = p_.hysteron_count
    M = p_.M
    d = p_.d
    L = _lanes(p_.L, hysteron_count, x.ndim)
    rho = _lanes(p_.rho, hysteron_count, x.ndim)
    i_0 = _lanes(p_.i_0, hysteron_count, x.ndim)
    T_0 = p_.T_0
    c_0 = p_.c_0
    p = x[1]
    phi = x[3 : 3 + hysteron_count]
    S = x[3 + hysteron_count]
    # co-states dU/dx
    v_mass = p/M
    i_hysteron = phi/L
    T_minus_T_0 = T_0*np.expm1(S/c_0)
    # dissipative laws
    V_hysteron = rho/T_minus_T_0*(i_hysteron - np.clip(i_hysteron, -i_0, i_0))
    F_damper = d*v_mass
    # result
    out = np.empty((1 + hysteron_count, *x.shape[1:]))
    out[0 : hysteron_count] = V_hysteron*i_hysteron
    out[hysteron_count] = F_damper*v_mass
    return out


def entropy_production(x, u, p_, /):
    """Entropy production of each process [W/K], heat exchange with ambients not included; of a bank, one row per lane; shape (1 + hysteron_count, *batch)."""
    x = _states(x, p_)
    hysteron_count = p_.hysteron_count
    M = p_.M
    d = p_.d
    L = _lanes(p_.L, hysteron_count, x.ndim)
    rho = _lanes(p_.rho, hysteron_count, x.ndim)
    i_0 = _lanes(p_.i_0, hysteron_count, x.ndim)
    T_0 = p_.T_0
    c_0 = p_.c_0
    p = x[1]
    phi = x[3 : 3 + hysteron_count]
    S = x[3 + hysteron_count]
    # co-states dU/dx
    v_mass = p/M
    i_hysteron = phi/L
    T_minus_T_0 = T_0*np.expm1(S/c_0)
    T = T_0 + T_minus_T_0
    # dissipative laws
    V_hysteron = rho/T_minus_T_0*(i_hysteron - np.clip(i_hysteron, -i_0, i_0))
    F_damper = d*v_mass
    # result
    out = np.empty((1 + hysteron_count, *x.shape[1:]))
    out[0 : hysteron_count] = V_hysteron*i_hysteron/T
    out[hysteron_count] = F_damper*v_mass/T
    return out


def elements(x, u, p_, /):
    """Effort, flow, power, energy and heat of elements; of a bank, one row per lane; shape (34 + 5*hysteron_count, *batch)."""
    x = _states(x, p_)
    u = _inputs(u)
    hysteron_count = p_.hysteron_count
    M = p_.M
    k = p_.k
    q_l = p_.q_l
    d = p_.d
    C = p_.C
    L = _lanes(p_.L, hysteron_count, x.ndim)
    rho = _lanes(p_.rho, hysteron_count, x.ndim)
    i_0 = _lanes(p_.i_0, hysteron_count, x.ndim)
    a = p_.a
    T_0 = p_.T_0
    c_0 = p_.c_0
    lam = p_.lam
    q = x[0]
    p = x[1]
    Q_C = x[2]
    phi = x[3 : 3 + hysteron_count]
    S = x[3 + hysteron_count]
    F_ext = u[0]
    V_in = u[1]
    T_e = u[2]
    # co-states dU/dx
    F_spring = k*(q - q_l)
    v_mass = p/M
    V_capacitor = Q_C/C
    i_hysteron = phi/L
    T_minus_T_0 = T_0*np.expm1(S/c_0)
    T = T_0 + T_minus_T_0
    # sums over lanes
    sum_i_hysteron = np.sum(i_hysteron, axis=0)
    # transducer ratios
    alpha_transducer = a*T/T_0
    # dissipative laws
    V_hysteron = rho/T_minus_T_0*(i_hysteron - np.clip(i_hysteron, -i_0, i_0))
    F_damper = d*v_mass
    # sums over lanes
    heat_hysteron = np.sum(V_hysteron*i_hysteron, axis=0)
    # heats
    heat_damper = F_damper*v_mass
    # rates
    rate_p = alpha_transducer*V_capacitor - F_spring - F_damper + F_ext
    rate_Q_C = sum_i_hysteron - alpha_transducer*v_mass
    rate_phi = V_in - V_capacitor - V_hysteron
    rate_S = (heat_hysteron + heat_damper)/T + lam*(T_e/T - 1)
    # result
    end_hysteron_effort = 12 + hysteron_count
    end_hysteron_flow = end_hysteron_effort + hysteron_count
    end_hysteron_power = end_hysteron_flow + hysteron_count
    end_hysteron_energy = end_hysteron_power + hysteron_count
    end_hysteron_heat = end_hysteron_energy + hysteron_count
    out = np.empty((22 + end_hysteron_heat, *x.shape[1:]))
    out[0] = F_spring
    out[1] = v_mass
    out[2] = F_spring*v_mass
    out[3] = k*(q - q_l)**2/2
    out[4] = rate_p
    out[5] = v_mass
    out[6] = rate_p*v_mass
    out[7] = p**2/(2*M)
    out[8] = V_capacitor
    out[9] = rate_Q_C
    out[10] = V_capacitor*rate_Q_C
    out[11] = Q_C**2/(2*C)
    out[12 : end_hysteron_effort] = rate_phi + V_hysteron
    out[end_hysteron_effort : end_hysteron_flow] = i_hysteron
    out[end_hysteron_flow : end_hysteron_power] = (rate_phi + V_hysteron)*i_hysteron
    out[end_hysteron_power : end_hysteron_energy] = phi**2/(2*L)
    out[end_hysteron_energy : end_hysteron_heat] = V_hysteron*i_hysteron
    out[end_hysteron_heat] = F_damper
    out[1 + end_hysteron_heat] = v_mass
    out[2 + end_hysteron_heat] = F_damper*v_mass
    out[3 + end_hysteron_heat] = F_damper*v_mass
    out[4 + end_hysteron_heat] = V_capacitor
    out[5 + end_hysteron_heat] = alpha_transducer*v_mass
    out[6 + end_hysteron_heat] = -alpha_transducer*V_capacitor
    out[7 + end_hysteron_heat] = v_mass
    out[8 + end_hysteron_heat] = V_capacitor*alpha_transducer*v_mass
    out[9 + end_hysteron_heat] = T
    out[10 + end_hysteron_heat] = rate_S
    out[11 + end_hysteron_heat] = T*rate_S
    out[12 + end_hysteron_heat] = T_0*c_0*np.exp(S/c_0)
    out[13 + end_hysteron_heat] = T
    out[14 + end_hysteron_heat] = -lam*(T_e/T - 1)
    out[15 + end_hysteron_heat] = -lam*(T_e - T)
    out[16 + end_hysteron_heat] = -F_ext
    out[17 + end_hysteron_heat] = v_mass
    out[18 + end_hysteron_heat] = -v_mass*F_ext
    out[19 + end_hysteron_heat] = V_in
    out[20 + end_hysteron_heat] = -sum_i_hysteron
    out[21 + end_hysteron_heat] = -sum_i_hysteron*V_in
    return out


@np.errstate(divide="ignore", invalid="ignore")
def jacobian(x, u, p_, /):
    """Jacobian of rhs, d rhs[i]/d x[j] at [i, j]; shape (n, n, *batch)."""
    x = _states(x, p_)
    u = _inputs(u)
    hysteron_count = p_.hysteron_count
    M = p_.M
    k = p_.k
    d = p_.d
    C = p_.C
    L = _lanes(p_.L, hysteron_count, x.ndim)
    rho = _lanes(p_.rho, hysteron_count, x.ndim)
    i_0 = _lanes(p_.i_0, hysteron_count, x.ndim)
    a = p_.a
    T_0 = p_.T_0
    c_0 = p_.c_0
    lam = p_.lam
    p = x[1]
    Q_C = x[2]
    phi = x[3 : 3 + hysteron_count]
    S = x[3 + hysteron_count]
    T_e = u[2]
    # co-states dU/dx
    v_mass = p/M
    V_capacitor = Q_C/C
    i_hysteron = phi/L
    T_minus_T_0 = T_0*np.expm1(S/c_0)
    T = T_0 + T_minus_T_0
    # transducer ratios
    alpha_transducer = a*T/T_0
    # dissipative laws
    V_hysteron = rho/T_minus_T_0*(i_hysteron - np.clip(i_hysteron, -i_0, i_0))
    F_damper = d*v_mass
    # sums over lanes
    heat_hysteron = np.sum(V_hysteron*i_hysteron, axis=0)
    # heats
    heat_damper = F_damper*v_mass
    # derivatives
    dF_damper_dp = d/M
    dheat_damper_dp = v_mass*dF_damper_dp + F_damper/M
    dV_hysteron_dphi = np.where(np.abs(i_hysteron) > i_0, rho/T_minus_T_0, 0)/L
    dheat_hysteron_dphi = i_hysteron*dV_hysteron_dphi + V_hysteron/L
    dT_minus_T_0_dS = T/c_0
    dalpha_transducer_dS = a/T_0*dT_minus_T_0_dS
    dV_hysteron_dS = -rho/T_minus_T_0**2*(i_hysteron - np.clip(i_hysteron, -i_0, i_0))*dT_minus_T_0_dS
    # sums over lanes
    dheat_hysteron_dS = np.sum(i_hysteron*dV_hysteron_dS, axis=0)
    # result
    out = np.zeros((x.shape[0], *x.shape))
    out[0, 1] = 1/M
    out[1, 0] = -k
    out[1, 1] = -dF_damper_dp
    out[1, 2] = alpha_transducer/C
    out[1, 3 + hysteron_count] = V_capacitor*dalpha_transducer_dS
    out[2, 1] = -alpha_transducer/M
    out[2, 3 : 3 + hysteron_count] = 1/L
    out[2, 3 + hysteron_count] = -v_mass*dalpha_transducer_dS
    out[3 : 3 + hysteron_count, 2] = -1/C
    lanes = np.arange(3, 3 + hysteron_count)
    out[lanes, lanes] = -dV_hysteron_dphi
    out[3 : 3 + hysteron_count, 3 + hysteron_count] = -dV_hysteron_dS
    out[3 + hysteron_count, 1] = dheat_damper_dp/T
    out[3 + hysteron_count, 3 : 3 + hysteron_count] = dheat_hysteron_dphi/T
    out[3 + hysteron_count, 3 + hysteron_count] = (
        dheat_hysteron_dS/T
        + (-(heat_hysteron + heat_damper)/T**2 - lam*T_e/T**2)*dT_minus_T_0_dS
    )
    return out


def margins(x, u, p_, /):
    """Margin by which each condition of DOMAIN holds; of a bank, the least one; shape (len(DOMAIN), *batch)."""
    x = _states(x, p_)
    u = _inputs(u)
    hysteron_count = p_.hysteron_count
    M = p_.M
    k = p_.k
    d = p_.d
    C = p_.C
    L = _lanes(p_.L, hysteron_count, x.ndim)
    rho = _lanes(p_.rho, hysteron_count, x.ndim)
    i_0 = _lanes(p_.i_0, hysteron_count, x.ndim)
    T_0 = p_.T_0
    c_0 = p_.c_0
    lam = p_.lam
    S = x[3 + hysteron_count]
    T_e = u[2]
    # co-states dU/dx
    T_minus_T_0 = T_0*np.expm1(S/c_0)
    # result
    out = np.empty((12, *x.shape[1:]))
    out[0] = T_minus_T_0
    out[1] = T_e - T_0
    out[2] = d
    out[3] = np.min(rho, axis=0)
    out[4] = np.min(i_0, axis=0)
    out[5] = lam
    out[6] = k
    out[7] = M
    out[8] = C
    out[9] = np.min(L, axis=0)
    out[10] = T_0
    out[11] = c_0
    return out
