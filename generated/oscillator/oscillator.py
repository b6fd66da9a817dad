"""Damped oscillator that heats itself: irreversible port-Hamiltonian system.

Source:  Ramirez, Maschke, Sbarbaro (2013), Eur. J. Control 19, 513-520, the mass-spring-damper
Model:   oscillator, spec sha256 98f74415ae4d927ffd7693687e1755d27c6ee4baa18ca60809e3c3d10d605268
System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
         rows, multiplied out; `piezo-sym show` prints the matrices
Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, sigma, units, program PROVED
         (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
         parameters in the domain, and for banks of any size)

Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
Arrays have shape (n, *batch); values are in SI units.

x = (q, p, S)
u = (F)
p_ = Parameters(); the underscore tells it from p, a name of the model
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

NAME = "oscillator"
SPEC_SHA256 = "98f74415ae4d927ffd7693687e1755d27c6ee4baa18ca60809e3c3d10d605268"


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
    Record("S", "J/K", "entropy of thermal_mass 'body'"),
)
INPUTS = (
    Record("F", "N", "force on the mass"),
)
INPUT_DEFAULTS = (0.0,)
# rows of outputs() and supply(): ports, named after the elements that have the inputs
OUTPUTS = (
    Record("hand", "m/s", "velocity at force_source 'hand'"),
)
# rows of heat() and entropy_production(): processes, with the unit of the second
PROCESSES = (
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
    Record("damper.effort", "N", "force of damper 'damper'"),
    Record("damper.flow", "m/s", "velocity of damper 'damper'"),
    Record("damper.power", "W", "power into damper 'damper'"),
    Record("damper.heat", "W", "heat of damper 'damper'"),
    Record("body.effort", "K", "temperature of thermal_mass 'body'"),
    Record("body.flow", "W/K", "entropy flow of thermal_mass 'body'"),
    Record("body.power", "W", "power into thermal_mass 'body'"),
    Record("body.energy", "J", "energy of thermal_mass 'body'"),
    Record("hand.effort", "N", "force of force_source 'hand'"),
    Record("hand.flow", "m/s", "velocity of force_source 'hand'"),
    Record("hand.power", "W", "power into force_source 'hand'"),
)
# fields of Parameters; elements of many lanes; conditions under which the proofs hold
PARAMETERS = (
    Record("m", "kg", "mass"),
    Record("k", "N/m", "stiffness"),
    Record("d", "N*s/m", "damping"),
    Record("T_0", "K", "temperature at the start"),
    Record("c", "J/K", "heat capacity"),
)
BANKS = ()
DOMAIN = (
    Condition("d >= 0", False),
    Condition("k > 0", True),
    Condition("m > 0", True),
    Condition("T_0 > 0", True),
    Condition("c > 0", True),
)


@dataclass(frozen=True)
class Parameters:
    """Parameters of oscillator in SI units; defaults are the values of the spec."""

    m: float = 1.0
    k: float = 4.0
    d: float = 0.4
    T_0: float = 300.0
    c: float = 2.0


def _states(x, p):
    """Return states x, shape (n, *batch), as floats."""
    x = np.asarray(x, dtype=float)
    n = 3
    if x.shape[:1] != (n,):
        raise ValueError(f"x has shape {x.shape}, but there are {n} states")
    return x


def _inputs(u):
    """Return inputs u, shape (1, *batch), as floats."""
    u = np.asarray(u, dtype=float)
    if u.shape[:1] != (1,):
        raise ValueError(f"u has shape {u.shape}, but there are 1 inputs")
    return u


def initial_state(u, p_, /):
    """State at t = 0 [SI], for the inputs u at t = 0; shape (n,)."""
    out = np.zeros(3)
    out[0] = 1
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
    m = p_.m
    k = p_.k
    d = p_.d
    T_0 = p_.T_0
    c = p_.c
    q = x[0]
    p = x[1]
    S = x[2]
    F = u[0]
    # co-states dU/dx
    F_spring = k*q
    v_mass = p/m
    T = T_0*np.exp(S/c)
    # dissipative laws
    F_damper = d*v_mass
    # heats
    heat_damper = F_damper*v_mass
    # result
    out[0] = v_mass
    out[1] = F - F_spring - F_damper
    out[2] = heat_damper/T


def outputs(x, u, p_, /):
    """Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient; shape (1, *batch)."""
    x = _states(x, p_)
    m = p_.m
    p = x[1]
    # co-states dU/dx
    v_mass = p/m
    # result
    out = np.empty((1, *x.shape[1:]))
    out[0] = v_mass
    return out


def supply(x, u, p_, /):
    """Power supplied through each port [W]; the sum is dU/dt; shape (1, *batch)."""
    x = _states(x, p_)
    u = _inputs(u)
    m = p_.m
    p = x[1]
    F = u[0]
    # co-states dU/dx
    v_mass = p/m
    # result
    out = np.empty((1, *x.shape[1:]))
    out[0] = v_mass*F
    return out


def energy(x, p_, /):
    """Hamiltonian U [J]; shape (*batch)."""
    x = _states(x, p_)
    m = p_.m
    k = p_.k
    T_0 = p_.T_0
    c = p_.c
    q = x[0]
    p = x[1]
    S = x[2]
    return k*q**2/2 + p**2/(2*m) + T_0*c*np.exp(S/c)


def entropy(x, p_, /):
    """Total entropy S [J/K]; shape (*batch)."""
    x = _states(x, p_)
    S = x[2]
    return S.copy()


def temperatures(x, p_, /):
    """Temperature of each body [K]; shape (1, *batch)."""
    x = _states(x, p_)
    T_0 = p_.T_0
    c = p_.c
    S = x[2]
    # co-states dU/dx
    T = T_0*np.exp(S/c)
    # result
    out = np.empty((1, *x.shape[1:]))
    out[0] = T
    return out


def heat(x, u, p_, /):
    """Power that each process turns into heat [W]; of a bank, one row per lane; shape (1, *batch)."""
    x = _states(x, p_)
    m = p_.m
    d = p_.d
    p = x[1]
    # co-states dU/dx
    v_mass = p/m
    # dissipative laws
    F_damper = d*v_mass
    # result
    out = np.empty((1, *x.shape[1:]))
    out[0] = F_damper*v_mass
    return out


def entropy_production(x, u, p_, /):
    """Entropy production of each process [W/K], heat exchange with ambients not included; of a bank, one row per lane; shape (1, *batch)."""
    x = _states(x, p_)
    m = p_.m
    d = p_.d
    T_0 = p_.T_0
    c = p_.c
    p = x[1]
    S = x[2]
    # co-states dU/dx
    v_mass = p/m
    T = T_0*np.exp(S/c)
    # dissipative laws
    F_damper = d*v_mass
    # result
    out = np.empty((1, *x.shape[1:]))
    out[0] = F_damper*v_mass/T
    return out


def elements(x, u, p_, /):
    """Effort, flow, power, energy and heat of elements; of a bank, one row per lane; shape (19, *batch)."""
    x = _states(x, p_)
    u = _inputs(u)
    m = p_.m
    k = p_.k
    d = p_.d
    T_0 = p_.T_0
    c = p_.c
    q = x[0]
    p = x[1]
    S = x[2]
    F = u[0]
    # co-states dU/dx
    F_spring = k*q
    v_mass = p/m
    T = T_0*np.exp(S/c)
    # dissipative laws
    F_damper = d*v_mass
    # heats
    heat_damper = F_damper*v_mass
    # rates
    rate_p = F - F_spring - F_damper
    rate_S = heat_damper/T
    # result
    out = np.empty((19, *x.shape[1:]))
    out[0] = F_spring
    out[1] = v_mass
    out[2] = F_spring*v_mass
    out[3] = k*q**2/2
    out[4] = rate_p
    out[5] = v_mass
    out[6] = rate_p*v_mass
    out[7] = p**2/(2*m)
    out[8] = F_damper
    out[9] = v_mass
    out[10] = F_damper*v_mass
    out[11] = F_damper*v_mass
    out[12] = T
    out[13] = rate_S
    out[14] = T*rate_S
    out[15] = T_0*c*np.exp(S/c)
    out[16] = -F
    out[17] = v_mass
    out[18] = -v_mass*F
    return out


def jacobian(x, u, p_, /):
    """Jacobian of rhs, d rhs[i]/d x[j] at [i, j]; shape (n, n, *batch)."""
    x = _states(x, p_)
    m = p_.m
    k = p_.k
    d = p_.d
    T_0 = p_.T_0
    c = p_.c
    p = x[1]
    S = x[2]
    # co-states dU/dx
    v_mass = p/m
    T = T_0*np.exp(S/c)
    # dissipative laws
    F_damper = d*v_mass
    # heats
    heat_damper = F_damper*v_mass
    # derivatives
    dF_damper_dp = d/m
    dheat_damper_dp = v_mass*dF_damper_dp + F_damper/m
    dT_dS = T/c
    # result
    out = np.zeros((x.shape[0], *x.shape))
    out[0, 1] = 1/m
    out[1, 0] = -k
    out[1, 1] = -dF_damper_dp
    out[2, 1] = dheat_damper_dp/T
    out[2, 2] = -heat_damper/T**2*dT_dS
    return out


def margins(x, u, p_, /):
    """Margin by which each condition of DOMAIN holds; of a bank, the least one; shape (len(DOMAIN), *batch)."""
    x = _states(x, p_)
    m = p_.m
    k = p_.k
    d = p_.d
    T_0 = p_.T_0
    c = p_.c
    out = np.empty((5, *x.shape[1:]))
    out[0] = d
    out[1] = k
    out[2] = m
    out[3] = T_0
    out[4] = c
    return out
