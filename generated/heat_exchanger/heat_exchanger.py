"""Heat exchanger: two bodies in contact: irreversible port-Hamiltonian system.

Source:  Ramirez, Maschke, Sbarbaro (2013), Chem. Eng. Sci. 89, 223-234, the heat exchanger
Model:   heat_exchanger, spec sha256 81da265b96a9585ebb1056051f48674761b82597e707def9ebb654e693d5bec0
System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
         rows, multiplied out; `piezo-sym show` prints the matrices
Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, sigma, units, program PROVED
         (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
         parameters in the domain, and for banks of any size)

Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
Arrays have shape (n, *batch); values are in SI units.

x = (S_hot, S_cold)
u = ()
p = Parameters()
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

NAME = "heat_exchanger"
SPEC_SHA256 = "81da265b96a9585ebb1056051f48674761b82597e707def9ebb654e693d5bec0"


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
    Record("S_hot", "J/K", "entropy of thermal_mass 'hot'"),
    Record("S_cold", "J/K", "entropy of thermal_mass 'cold'"),
)
INPUTS = ()
INPUT_DEFAULTS = ()
# rows of outputs() and supply(): ports, named after the elements that have the inputs
OUTPUTS = ()
# rows of heat() and entropy_production(): processes, with the unit of the second
PROCESSES = (
    Record("contact", "W/K", "conduction 'contact'"),
)
# rows of temperatures(), and of elements()
BODIES = (
    Record("hot", "K", "temperature of thermal_mass 'hot'"),
    Record("cold", "K", "temperature of thermal_mass 'cold'"),
)
ELEMENTS = (
    Record("hot.effort", "K", "temperature of thermal_mass 'hot'"),
    Record("hot.flow", "W/K", "entropy flow of thermal_mass 'hot'"),
    Record("hot.power", "W", "power into thermal_mass 'hot'"),
    Record("hot.energy", "J", "energy of thermal_mass 'hot'"),
    Record("cold.effort", "K", "temperature of thermal_mass 'cold'"),
    Record("cold.flow", "W/K", "entropy flow of thermal_mass 'cold'"),
    Record("cold.power", "W", "power into thermal_mass 'cold'"),
    Record("cold.energy", "J", "energy of thermal_mass 'cold'"),
    Record("contact.effort", "K", "temperature difference over conduction 'contact'"),
    Record("contact.power", "W", "heat from first to second body by conduction 'contact'"),
)
# fields of Parameters; elements of many lanes; conditions under which the proofs hold
PARAMETERS = (
    Record("c_1", "J/K", "heat capacity of the hot body"),
    Record("c_2", "J/K", "heat capacity of the cold body"),
    Record("lam", "W/K", "heat conductance of the contact"),
    Record("T_0", "K", "temperature at which the entropies are zero"),
    Record("T_1", "K", "temperature of the hot body at the start"),
    Record("T_2", "K", "temperature of the cold body at the start"),
)
BANKS = ()
DOMAIN = (
    Condition("lam >= 0", False),
    Condition("T_1 > 0", True),
    Condition("T_2 > 0", True),
    Condition("T_0 > 0", True),
    Condition("c_1 > 0", True),
    Condition("c_2 > 0", True),
)


@dataclass(frozen=True)
class Parameters:
    """Parameters of heat_exchanger in SI units; defaults are the values of the spec."""

    c_1: float = 2.0
    c_2: float = 3.0
    lam: float = 0.5
    T_0: float = 300.0
    T_1: float = 350.0
    T_2: float = 290.0


def _states(x, p):
    """Return states x, shape (n, *batch), as floats."""
    x = np.asarray(x, dtype=float)
    n = 2
    if x.shape[:1] != (n,):
        raise ValueError(f"x has shape {x.shape}, but there are {n} states")
    return x


def _inputs(u):
    """Return inputs u, shape (0, *batch), as floats."""
    u = np.asarray(u, dtype=float)
    if u.shape[:1] != (0,):
        raise ValueError(f"u has shape {u.shape}, but there are 0 inputs")
    return u


def initial_state(u, p, /):
    """State at t = 0 [SI], for the inputs u at t = 0; shape (n,)."""
    c_1 = p.c_1
    c_2 = p.c_2
    T_0 = p.T_0
    T_1 = p.T_1
    T_2 = p.T_2
    out = np.zeros(2)
    out[0] = c_1*np.log(T_1/T_0)
    out[1] = c_2*np.log(T_2/T_0)
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
    c_1 = p.c_1
    c_2 = p.c_2
    lam = p.lam
    T_0 = p.T_0
    S_hot = x[0]
    S_cold = x[1]
    # co-states dU/dx
    T_hot = T_0*np.exp(S_hot/c_1)
    T_cold = T_0*np.exp(S_cold/c_2)
    # dissipative laws
    s_contact = lam*(T_hot - T_cold)/T_hot
    # heats
    heat_contact = s_contact*T_hot
    # result
    out[0] = -s_contact
    out[1] = heat_contact/T_cold


def outputs(x, u, p, /):
    """Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient; shape (0, *batch)."""
    x = _states(x, p)
    out = np.empty((0, *x.shape[1:]))
    return out


def supply(x, u, p, /):
    """Power supplied through each port [W]; the sum is dU/dt; shape (0, *batch)."""
    x = _states(x, p)
    out = np.empty((0, *x.shape[1:]))
    return out


def energy(x, p, /):
    """Hamiltonian U [J]; shape (*batch)."""
    x = _states(x, p)
    c_1 = p.c_1
    c_2 = p.c_2
    T_0 = p.T_0
    S_hot = x[0]
    S_cold = x[1]
    return T_0*c_1*np.exp(S_hot/c_1) + T_0*c_2*np.exp(S_cold/c_2)


def entropy(x, p, /):
    """Total entropy S [J/K]; shape (*batch)."""
    x = _states(x, p)
    S_hot = x[0]
    S_cold = x[1]
    return S_hot + S_cold


def temperatures(x, p, /):
    """Temperature of each body [K]; shape (2, *batch)."""
    x = _states(x, p)
    c_1 = p.c_1
    c_2 = p.c_2
    T_0 = p.T_0
    S_hot = x[0]
    S_cold = x[1]
    # co-states dU/dx
    T_hot = T_0*np.exp(S_hot/c_1)
    T_cold = T_0*np.exp(S_cold/c_2)
    # result
    out = np.empty((2, *x.shape[1:]))
    out[0] = T_hot
    out[1] = T_cold
    return out


def heat(x, u, p, /):
    """Power that each process turns into heat [W]; of a bank, one row per lane; shape (1, *batch)."""
    x = _states(x, p)
    c_1 = p.c_1
    c_2 = p.c_2
    lam = p.lam
    T_0 = p.T_0
    S_hot = x[0]
    S_cold = x[1]
    # co-states dU/dx
    T_hot = T_0*np.exp(S_hot/c_1)
    T_cold = T_0*np.exp(S_cold/c_2)
    # dissipative laws
    s_contact = lam*(T_hot - T_cold)/T_hot
    # result
    out = np.empty((1, *x.shape[1:]))
    out[0] = s_contact*T_hot
    return out


def entropy_production(x, u, p, /):
    """Entropy production of each process [W/K], heat exchange with ambients not included; of a bank, one row per lane; shape (1, *batch)."""
    x = _states(x, p)
    c_1 = p.c_1
    c_2 = p.c_2
    lam = p.lam
    T_0 = p.T_0
    S_hot = x[0]
    S_cold = x[1]
    # co-states dU/dx
    T_hot = T_0*np.exp(S_hot/c_1)
    T_cold = T_0*np.exp(S_cold/c_2)
    # dissipative laws
    s_contact = lam*(T_hot - T_cold)/T_hot
    # result
    out = np.empty((1, *x.shape[1:]))
    out[0] = s_contact*(T_hot - T_cold)/T_cold
    return out


def elements(x, u, p, /):
    """Effort, flow, power, energy and heat of elements; of a bank, one row per lane; shape (10, *batch)."""
    x = _states(x, p)
    c_1 = p.c_1
    c_2 = p.c_2
    lam = p.lam
    T_0 = p.T_0
    S_hot = x[0]
    S_cold = x[1]
    # co-states dU/dx
    T_hot = T_0*np.exp(S_hot/c_1)
    T_cold = T_0*np.exp(S_cold/c_2)
    # dissipative laws
    s_contact = lam*(T_hot - T_cold)/T_hot
    # heats
    heat_contact = s_contact*T_hot
    # rates
    rate_S_hot = -s_contact
    rate_S_cold = heat_contact/T_cold
    # result
    out = np.empty((10, *x.shape[1:]))
    out[0] = T_hot
    out[1] = rate_S_hot
    out[2] = T_hot*rate_S_hot
    out[3] = T_0*c_1*np.exp(S_hot/c_1)
    out[4] = T_cold
    out[5] = rate_S_cold
    out[6] = T_cold*rate_S_cold
    out[7] = T_0*c_2*np.exp(S_cold/c_2)
    out[8] = T_hot - T_cold
    out[9] = s_contact*T_hot
    return out


def jacobian(x, u, p, /):
    """Jacobian of rhs, d rhs[i]/d x[j] at [i, j]; shape (n, n, *batch)."""
    x = _states(x, p)
    c_1 = p.c_1
    c_2 = p.c_2
    lam = p.lam
    T_0 = p.T_0
    S_hot = x[0]
    S_cold = x[1]
    # co-states dU/dx
    T_hot = T_0*np.exp(S_hot/c_1)
    T_cold = T_0*np.exp(S_cold/c_2)
    # dissipative laws
    s_contact = lam*(T_hot - T_cold)/T_hot
    # heats
    heat_contact = s_contact*T_hot
    # derivatives
    dT_hot_dS_hot = T_hot/c_1
    ds_contact_dS_hot = (lam/T_hot - lam*(T_hot - T_cold)/T_hot**2)*dT_hot_dS_hot
    dheat_contact_dS_hot = T_hot*ds_contact_dS_hot + s_contact*dT_hot_dS_hot
    dT_cold_dS_cold = T_cold/c_2
    ds_contact_dS_cold = -lam/T_hot*dT_cold_dS_cold
    dheat_contact_dS_cold = T_hot*ds_contact_dS_cold
    # result
    out = np.zeros((x.shape[0], *x.shape))
    out[0, 0] = -ds_contact_dS_hot
    out[0, 1] = -ds_contact_dS_cold
    out[1, 0] = dheat_contact_dS_hot/T_cold
    out[1, 1] = dheat_contact_dS_cold/T_cold - heat_contact/T_cold**2*dT_cold_dS_cold
    return out


def margins(x, u, p, /):
    """Margin by which each condition of DOMAIN holds; of a bank, the least one; shape (len(DOMAIN), *batch)."""
    x = _states(x, p)
    c_1 = p.c_1
    c_2 = p.c_2
    lam = p.lam
    T_0 = p.T_0
    T_1 = p.T_1
    T_2 = p.T_2
    out = np.empty((6, *x.shape[1:]))
    out[0] = lam
    out[1] = T_1
    out[2] = T_2
    out[3] = T_0
    out[4] = c_1
    out[5] = c_2
    return out
