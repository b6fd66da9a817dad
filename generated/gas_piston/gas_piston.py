"""Ideal gas under a piston, with heat exchanged: irreversible port-Hamiltonian system.

Source:  Ruechhardt (1929), Physikalische Zeitschrift 30, 58-59, the period; van der Schaft, Maschke (2018), Entropy 20, 925
Model:   gas_piston, spec sha256 0a9d53c8700ddf1bb0d85a7756da7a071b3f29cf0a98843810acd07ee683352b
System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
         rows, multiplied out; `piezo-sym show` prints the matrices
Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, sigma, exergy, environment, units, program PROVED
         (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
         parameters in the domain, and for banks of any size)

Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
Arrays have shape (n, *batch); values are in SI units.

x = (p, q, S)
u = (F, T_e)
p_ = Parameters(); the underscore tells it from p, a name of the model
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

NAME = "gas_piston"
SPEC_SHA256 = "0a9d53c8700ddf1bb0d85a7756da7a071b3f29cf0a98843810acd07ee683352b"


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
    Record("p", "kg*m/s", "momentum of mass 'piston'"),
    Record("q", "m", "extension of storage 'gas'"),
    Record("S", "J/K", "entropy of storage 'gas'"),
)
INPUTS = (
    Record("F", "N", "force on the piston: the atmosphere and its weight"),
    Record("T_e", "K", "temperature of the environment"),
)
INPUT_DEFAULTS = (-19.98656, 293.15)
# rows of outputs() and supply(): ports, named after the elements that have the inputs
OUTPUTS = (
    Record("load", "m/s", "velocity at force_source 'load'"),
    Record("vessel", "K", "temperature of thermal_mass 'gas'"),
)
# rows of heat() and entropy_production(): processes, with the unit of the second
PROCESSES = (
    Record("friction", "W/K", "damper 'friction'"),
)
# rows of temperatures(), and of elements()
BODIES = (
    Record("gas", "K", "temperature of thermal_mass 'gas'"),
)
ELEMENTS = (
    Record("piston.effort", "N", "force of mass 'piston'"),
    Record("piston.flow", "m/s", "velocity of mass 'piston'"),
    Record("piston.power", "W", "power into mass 'piston'"),
    Record("piston.energy", "J", "energy of mass 'piston'"),
    Record("friction.effort", "N", "force of damper 'friction'"),
    Record("friction.flow", "m/s", "velocity of damper 'friction'"),
    Record("friction.power", "W", "power into damper 'friction'"),
    Record("friction.heat", "W", "heat of damper 'friction'"),
    Record("load.effort", "N", "force of force_source 'load'"),
    Record("load.flow", "m/s", "velocity of force_source 'load'"),
    Record("load.power", "W", "power into force_source 'load'"),
    Record("vessel.effort", "K", "temperature at ambient 'vessel'"),
    Record("vessel.flow", "W/K", "entropy flow at ambient 'vessel'"),
    Record("vessel.power", "W", "power into ambient 'vessel'"),
    Record("gas.effort_q", "N", "force of storage 'gas'"),
    Record("gas.flow_q", "m/s", "velocity of storage 'gas'"),
    Record("gas.effort_S", "K", "temperature of storage 'gas'"),
    Record("gas.flow_S", "W/K", "entropy flow of storage 'gas'"),
    Record("gas.power", "W", "power into storage 'gas'"),
    Record("gas.energy", "J", "energy of storage 'gas'"),
)
# fields of Parameters; elements of many lanes; conditions under which the proofs hold
PARAMETERS = (
    Record("V_0", "m**3", "volume at q = 0"),
    Record("A", "m**2", "area of the piston"),
    Record("N", "mol", "amount of gas"),
    Record("c_v", "J/mol/K", "molar heat capacity at constant volume"),
    Record("R", "J/mol/K", "gas constant"),
    Record("T_0", "K", "temperature at S = 0 and q = 0"),
    Record("m", "kg", "mass of the piston"),
    Record("d", "N*s/m", "friction of the piston"),
    Record("lam", "W/K", "heat conductance through the vessel"),
)
BANKS = ()
DOMAIN = (
    Condition("V_0 + A*q > 0", True),
    Condition("V_0 > 0", True),
    Condition("A > 0", True),
    Condition("N > 0", True),
    Condition("c_v > 0", True),
    Condition("R > 0", True),
    Condition("T_0 > 0", True),
    Condition("d >= 0", False),
    Condition("lam >= 0", False),
    Condition("T_e > 0", True),
    Condition("m > 0", True),
)


@dataclass(frozen=True)
class Parameters:
    """Parameters of gas_piston in SI units; defaults are the values of the spec."""

    V_0: float = 0.01
    A: float = 0.0002
    N: float = 0.41
    c_v: float = 20.786
    R: float = 8.314463
    T_0: float = 293.15
    m: float = 0.0165
    d: float = 0.005
    lam: float = 0.05


def _states(x, p):
    """Return states x, shape (n, *batch), as floats."""
    x = np.asarray(x, dtype=float)
    n = 3
    if x.shape[:1] != (n,):
        raise ValueError(f"x has shape {x.shape}, but there are {n} states")
    return x


def _inputs(u):
    """Return inputs u, shape (2, *batch), as floats."""
    u = np.asarray(u, dtype=float)
    if u.shape[:1] != (2,):
        raise ValueError(f"u has shape {u.shape}, but there are 2 inputs")
    return u


def initial_state(u, p_, /):
    """State at t = 0 [SI], for the inputs u at t = 0; shape (n,)."""
    out = np.zeros(3)
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
    V_0 = p_.V_0
    A = p_.A
    N = p_.N
    c_v = p_.c_v
    R = p_.R
    T_0 = p_.T_0
    m = p_.m
    d = p_.d
    lam = p_.lam
    p = x[0]
    q = x[1]
    S = x[2]
    F = u[0]
    T_e = u[1]
    # co-states dU/dx
    v_piston = p/m
    F_q = -N*c_v*T_0*np.exp(S/(N*c_v))*np.exp((-R)/c_v*np.log(1 + A*q/V_0))*R/c_v*A/(1 + A*q/V_0)/V_0
    T = N*c_v*T_0*np.exp(S/(N*c_v))/(N*c_v)*np.exp((-R)/c_v*np.log(1 + A*q/V_0))
    # dissipative laws
    F_friction = d*v_piston
    # heats
    heat_friction = F_friction*v_piston
    # result
    out[0] = F - F_q - F_friction
    out[1] = v_piston
    out[2] = heat_friction/T + lam*(T_e/T - 1)


def outputs(x, u, p_, /):
    """Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient; shape (2, *batch)."""
    x = _states(x, p_)
    V_0 = p_.V_0
    A = p_.A
    N = p_.N
    c_v = p_.c_v
    R = p_.R
    T_0 = p_.T_0
    m = p_.m
    p = x[0]
    q = x[1]
    S = x[2]
    # co-states dU/dx
    v_piston = p/m
    T = N*c_v*T_0*np.exp(S/(N*c_v))/(N*c_v)*np.exp((-R)/c_v*np.log(1 + A*q/V_0))
    # result
    out = np.empty((2, *x.shape[1:]))
    out[0] = v_piston
    out[1] = T
    return out


def supply(x, u, p_, /):
    """Power supplied through each port [W]; the sum is dU/dt; shape (2, *batch)."""
    x = _states(x, p_)
    u = _inputs(u)
    V_0 = p_.V_0
    A = p_.A
    N = p_.N
    c_v = p_.c_v
    R = p_.R
    T_0 = p_.T_0
    m = p_.m
    lam = p_.lam
    p = x[0]
    q = x[1]
    S = x[2]
    F = u[0]
    T_e = u[1]
    # co-states dU/dx
    v_piston = p/m
    T = N*c_v*T_0*np.exp(S/(N*c_v))/(N*c_v)*np.exp((-R)/c_v*np.log(1 + A*q/V_0))
    # result
    out = np.empty((2, *x.shape[1:]))
    out[0] = v_piston*F
    out[1] = lam*(T_e - T)
    return out


def energy(x, p_, /):
    """Hamiltonian U [J]; shape (*batch)."""
    x = _states(x, p_)
    V_0 = p_.V_0
    A = p_.A
    N = p_.N
    c_v = p_.c_v
    R = p_.R
    T_0 = p_.T_0
    m = p_.m
    p = x[0]
    q = x[1]
    S = x[2]
    return p**2/(2*m) + N*c_v*T_0*np.exp(S/(N*c_v))*np.exp((-R)/c_v*np.log(1 + A*q/V_0))


def entropy(x, p_, /):
    """Total entropy S [J/K]; shape (*batch)."""
    x = _states(x, p_)
    S = x[2]
    return S.copy()


def temperatures(x, p_, /):
    """Temperature of each body [K]; shape (1, *batch)."""
    x = _states(x, p_)
    V_0 = p_.V_0
    A = p_.A
    N = p_.N
    c_v = p_.c_v
    R = p_.R
    T_0 = p_.T_0
    q = x[1]
    S = x[2]
    # co-states dU/dx
    T = N*c_v*T_0*np.exp(S/(N*c_v))/(N*c_v)*np.exp((-R)/c_v*np.log(1 + A*q/V_0))
    # result
    out = np.empty((1, *x.shape[1:]))
    out[0] = T
    return out


def heat(x, u, p_, /):
    """Power that each process turns into heat [W]; of a bank, one row per lane; shape (1, *batch)."""
    x = _states(x, p_)
    m = p_.m
    d = p_.d
    p = x[0]
    # co-states dU/dx
    v_piston = p/m
    # dissipative laws
    F_friction = d*v_piston
    # result
    out = np.empty((1, *x.shape[1:]))
    out[0] = F_friction*v_piston
    return out


def entropy_production(x, u, p_, /):
    """Entropy production of each process [W/K], heat exchange with ambients not included; of a bank, one row per lane; shape (1, *batch)."""
    x = _states(x, p_)
    V_0 = p_.V_0
    A = p_.A
    N = p_.N
    c_v = p_.c_v
    R = p_.R
    T_0 = p_.T_0
    m = p_.m
    d = p_.d
    p = x[0]
    q = x[1]
    S = x[2]
    # co-states dU/dx
    v_piston = p/m
    T = N*c_v*T_0*np.exp(S/(N*c_v))/(N*c_v)*np.exp((-R)/c_v*np.log(1 + A*q/V_0))
    # dissipative laws
    F_friction = d*v_piston
    # result
    out = np.empty((1, *x.shape[1:]))
    out[0] = F_friction*v_piston/T
    return out


def elements(x, u, p_, /):
    """Effort, flow, power, energy and heat of elements; of a bank, one row per lane; shape (20, *batch)."""
    x = _states(x, p_)
    u = _inputs(u)
    V_0 = p_.V_0
    A = p_.A
    N = p_.N
    c_v = p_.c_v
    R = p_.R
    T_0 = p_.T_0
    m = p_.m
    d = p_.d
    lam = p_.lam
    p = x[0]
    q = x[1]
    S = x[2]
    F = u[0]
    T_e = u[1]
    # co-states dU/dx
    v_piston = p/m
    F_q = -N*c_v*T_0*np.exp(S/(N*c_v))*np.exp((-R)/c_v*np.log(1 + A*q/V_0))*R/c_v*A/(1 + A*q/V_0)/V_0
    T = N*c_v*T_0*np.exp(S/(N*c_v))/(N*c_v)*np.exp((-R)/c_v*np.log(1 + A*q/V_0))
    # dissipative laws
    F_friction = d*v_piston
    # heats
    heat_friction = F_friction*v_piston
    # rates
    rate_p = F - F_q - F_friction
    rate_S = heat_friction/T + lam*(T_e/T - 1)
    # result
    out = np.empty((20, *x.shape[1:]))
    out[0] = rate_p
    out[1] = v_piston
    out[2] = rate_p*v_piston
    out[3] = p**2/(2*m)
    out[4] = F_friction
    out[5] = v_piston
    out[6] = F_friction*v_piston
    out[7] = F_friction*v_piston
    out[8] = -F
    out[9] = v_piston
    out[10] = -v_piston*F
    out[11] = T
    out[12] = -lam*(T_e/T - 1)
    out[13] = -lam*(T_e - T)
    out[14] = F_q
    out[15] = v_piston
    out[16] = T
    out[17] = rate_S
    out[18] = F_q*v_piston + T*rate_S
    out[19] = N*c_v*T_0*np.exp(S/(N*c_v))*np.exp((-R)/c_v*np.log(1 + A*q/V_0))
    return out


def jacobian(x, u, p_, /):
    """Jacobian of rhs, d rhs[i]/d x[j] at [i, j]; shape (n, n, *batch)."""
    x = _states(x, p_)
    u = _inputs(u)
    V_0 = p_.V_0
    A = p_.A
    N = p_.N
    c_v = p_.c_v
    R = p_.R
    T_0 = p_.T_0
    m = p_.m
    d = p_.d
    lam = p_.lam
    p = x[0]
    q = x[1]
    S = x[2]
    T_e = u[1]
    # co-states dU/dx
    v_piston = p/m
    T = N*c_v*T_0*np.exp(S/(N*c_v))/(N*c_v)*np.exp((-R)/c_v*np.log(1 + A*q/V_0))
    # dissipative laws
    F_friction = d*v_piston
    # heats
    heat_friction = F_friction*v_piston
    # derivatives
    dF_friction_dp = d/m
    dheat_friction_dp = v_piston*dF_friction_dp + F_friction/m
    dF_q_dq = -(-N*c_v*T_0*np.exp(S/(N*c_v))*np.exp((-R)/c_v*np.log(1 + A*q/V_0))*R/c_v*A/(1 + A*q/V_0)/V_0*R/c_v*A/(1 + A*q/V_0) - N*c_v*T_0*np.exp(S/(N*c_v))*np.exp((-R)/c_v*np.log(1 + A*q/V_0))*R/c_v*A*A/V_0/(1 + A*q/V_0)**2)/V_0
    dT_dq = -T*R/c_v*A/(1 + A*q/V_0)/V_0
    dF_q_dS = -T*R/c_v*A/(1 + A*q/V_0)/V_0
    dT_dS = N*c_v*T_0*np.exp(S/(N*c_v))/(N*c_v)**2*np.exp((-R)/c_v*np.log(1 + A*q/V_0))
    # result
    out = np.zeros((x.shape[0], *x.shape))
    out[0, 0] = -dF_friction_dp
    out[0, 1] = -dF_q_dq
    out[0, 2] = -dF_q_dS
    out[1, 0] = 1/m
    out[2, 0] = dheat_friction_dp/T
    out[2, 1] = (-heat_friction/T**2 - lam*T_e/T**2)*dT_dq
    out[2, 2] = (-heat_friction/T**2 - lam*T_e/T**2)*dT_dS
    return out


def margins(x, u, p_, /):
    """Margin by which each condition of DOMAIN holds; of a bank, the least one; shape (len(DOMAIN), *batch)."""
    x = _states(x, p_)
    u = _inputs(u)
    V_0 = p_.V_0
    A = p_.A
    N = p_.N
    c_v = p_.c_v
    R = p_.R
    T_0 = p_.T_0
    m = p_.m
    d = p_.d
    lam = p_.lam
    q = x[1]
    T_e = u[1]
    out = np.empty((11, *x.shape[1:]))
    out[0] = V_0 + A*q
    out[1] = V_0
    out[2] = A
    out[3] = N
    out[4] = c_v
    out[5] = R
    out[6] = T_0
    out[7] = d
    out[8] = lam
    out[9] = T_e
    out[10] = m
    return out
