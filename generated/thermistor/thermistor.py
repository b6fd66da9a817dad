"""Series RLC circuit with a thermistor: irreversible port-Hamiltonian system.

Source:  Becker, Green, Pearson (1946), Bell Syst. Tech. J. 26, 170-212, R = R_0 exp(B (1/T - 1/T_0))
Model:   thermistor, spec sha256 b3ce3439410245bed29fbaef5d338f6c046728146ec30a1b29ddd4240ea71ae0
System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
         rows, multiplied out; `piezo-sym show` prints the matrices
Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, sigma, units, program PROVED
         (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
         parameters in the domain, and for banks of any size)

Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
Arrays have shape (n, *batch); values are in SI units.

x = (phi, Q, S)
u = ()
p = Parameters()
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

NAME = "thermistor"
SPEC_SHA256 = "b3ce3439410245bed29fbaef5d338f6c046728146ec30a1b29ddd4240ea71ae0"


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
    Record("phi", "Wb", "flux linkage of inductor 'coil'"),
    Record("Q", "C", "charge of capacitor 'cap'"),
    Record("S", "J/K", "entropy of thermal_mass 'body'"),
)
INPUTS = ()
INPUT_DEFAULTS = ()
# rows of outputs() and supply(): ports, named after the elements that have the inputs
OUTPUTS = ()
# rows of heat() and entropy_production(): processes, with the unit of the second
PROCESSES = (
    Record("bead", "W/K", "resistor 'bead'"),
)
# rows of temperatures(), and of elements()
BODIES = (
    Record("body", "K", "temperature of thermal_mass 'body'"),
)
ELEMENTS = (
    Record("coil.effort", "V", "voltage of inductor 'coil'"),
    Record("coil.flow", "A", "current of inductor 'coil'"),
    Record("coil.power", "W", "power into inductor 'coil'"),
    Record("coil.energy", "J", "energy of inductor 'coil'"),
    Record("cap.effort", "V", "voltage of capacitor 'cap'"),
    Record("cap.flow", "A", "current of capacitor 'cap'"),
    Record("cap.power", "W", "power into capacitor 'cap'"),
    Record("cap.energy", "J", "energy of capacitor 'cap'"),
    Record("bead.effort", "V", "voltage of resistor 'bead'"),
    Record("bead.flow", "A", "current of resistor 'bead'"),
    Record("bead.power", "W", "power into resistor 'bead'"),
    Record("bead.heat", "W", "heat of resistor 'bead'"),
    Record("body.effort", "K", "temperature of thermal_mass 'body'"),
    Record("body.flow", "W/K", "entropy flow of thermal_mass 'body'"),
    Record("body.power", "W", "power into thermal_mass 'body'"),
    Record("body.energy", "J", "energy of thermal_mass 'body'"),
)
# fields of Parameters; elements of many lanes; conditions under which the proofs hold
PARAMETERS = (
    Record("L", "H", "inductance"),
    Record("C", "F", "capacitance"),
    Record("R_0", "ohm", "resistance at T_0"),
    Record("B", "K", "how steeply the resistance falls"),
    Record("c", "J/K", "heat capacity of the bead"),
    Record("T_0", "K", "temperature at the start"),
)
BANKS = ()
DOMAIN = (
    Condition("R_0 >= 0", False),
    Condition("L > 0", True),
    Condition("C > 0", True),
    Condition("T_0 > 0", True),
    Condition("c > 0", True),
)


@dataclass(frozen=True)
class Parameters:
    """Parameters of thermistor in SI units; defaults are the values of the spec."""

    L: float = 0.05
    C: float = 2e-06
    R_0: float = 1000.0
    B: float = 3000.0
    c: float = 1e-06
    T_0: float = 300.0


def _states(x, p):
    """Return states x, shape (n, *batch), as floats."""
    x = np.asarray(x, dtype=float)
    n = 3
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
    out = np.zeros(3)
    out[1] = 0.00002
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
    L = p.L
    C = p.C
    R_0 = p.R_0
    B = p.B
    c = p.c
    T_0 = p.T_0
    phi = x[0]
    Q = x[1]
    S = x[2]
    # co-states dU/dx
    i_coil = phi/L
    V_cap = Q/C
    T = T_0*np.exp(S/c)
    # dissipative laws
    V_bead = R_0*np.exp(B*(1/T - 1/T_0))*i_coil
    # heats
    heat_bead = V_bead*i_coil
    # result
    out[0] = V_cap - V_bead
    out[1] = -i_coil
    out[2] = heat_bead/T


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
    L = p.L
    C = p.C
    c = p.c
    T_0 = p.T_0
    phi = x[0]
    Q = x[1]
    S = x[2]
    return phi**2/(2*L) + Q**2/(2*C) + T_0*c*np.exp(S/c)


def entropy(x, p, /):
    """Total entropy S [J/K]; shape (*batch)."""
    x = _states(x, p)
    S = x[2]
    return S.copy()


def temperatures(x, p, /):
    """Temperature of each body [K]; shape (1, *batch)."""
    x = _states(x, p)
    c = p.c
    T_0 = p.T_0
    S = x[2]
    # co-states dU/dx
    T = T_0*np.exp(S/c)
    # result
    out = np.empty((1, *x.shape[1:]))
    out[0] = T
    return out


def heat(x, u, p, /):
    """Power that each process turns into heat [W]; of a bank, one row per lane; shape (1, *batch)."""
    x = _states(x, p)
    L = p.L
    R_0 = p.R_0
    B = p.B
    c = p.c
    T_0 = p.T_0
    phi = x[0]
    S = x[2]
    # co-states dU/dx
    i_coil = phi/L
    T = T_0*np.exp(S/c)
    # dissipative laws
    V_bead = R_0*np.exp(B*(1/T - 1/T_0))*i_coil
    # result
    out = np.empty((1, *x.shape[1:]))
    out[0] = V_bead*i_coil
    return out


def entropy_production(x, u, p, /):
    """Entropy production of each process [W/K], heat exchange with ambients not included; of a bank, one row per lane; shape (1, *batch)."""
    x = _states(x, p)
    L = p.L
    R_0 = p.R_0
    B = p.B
    c = p.c
    T_0 = p.T_0
    phi = x[0]
    S = x[2]
    # co-states dU/dx
    i_coil = phi/L
    T = T_0*np.exp(S/c)
    # dissipative laws
    V_bead = R_0*np.exp(B*(1/T - 1/T_0))*i_coil
    # result
    out = np.empty((1, *x.shape[1:]))
    out[0] = V_bead*i_coil/T
    return out


def elements(x, u, p, /):
    """Effort, flow, power, energy and heat of elements; of a bank, one row per lane; shape (16, *batch)."""
    x = _states(x, p)
    L = p.L
    C = p.C
    R_0 = p.R_0
    B = p.B
    c = p.c
    T_0 = p.T_0
    phi = x[0]
    Q = x[1]
    S = x[2]
    # co-states dU/dx
    i_coil = phi/L
    V_cap = Q/C
    T = T_0*np.exp(S/c)
    # dissipative laws
    V_bead = R_0*np.exp(B*(1/T - 1/T_0))*i_coil
    # heats
    heat_bead = V_bead*i_coil
    # rates
    rate_phi = V_cap - V_bead
    rate_Q = -i_coil
    rate_S = heat_bead/T
    # result
    out = np.empty((16, *x.shape[1:]))
    out[0] = rate_phi
    out[1] = i_coil
    out[2] = rate_phi*i_coil
    out[3] = phi**2/(2*L)
    out[4] = V_cap
    out[5] = rate_Q
    out[6] = V_cap*rate_Q
    out[7] = Q**2/(2*C)
    out[8] = V_bead
    out[9] = i_coil
    out[10] = V_bead*i_coil
    out[11] = V_bead*i_coil
    out[12] = T
    out[13] = rate_S
    out[14] = T*rate_S
    out[15] = T_0*c*np.exp(S/c)
    return out


def jacobian(x, u, p, /):
    """Jacobian of rhs, d rhs[i]/d x[j] at [i, j]; shape (n, n, *batch)."""
    x = _states(x, p)
    L = p.L
    C = p.C
    R_0 = p.R_0
    B = p.B
    c = p.c
    T_0 = p.T_0
    phi = x[0]
    S = x[2]
    # co-states dU/dx
    i_coil = phi/L
    T = T_0*np.exp(S/c)
    # dissipative laws
    V_bead = R_0*np.exp(B*(1/T - 1/T_0))*i_coil
    # heats
    heat_bead = V_bead*i_coil
    # derivatives
    dV_bead_dphi = R_0*np.exp(B*(1/T - 1/T_0))/L
    dheat_bead_dphi = i_coil*dV_bead_dphi + V_bead/L
    dT_dS = T/c
    dV_bead_dS = -R_0*np.exp(B*(1/T - 1/T_0))*B/T**2*i_coil*dT_dS
    dheat_bead_dS = i_coil*dV_bead_dS
    # result
    out = np.zeros((x.shape[0], *x.shape))
    out[0, 0] = -dV_bead_dphi
    out[0, 1] = 1/C
    out[0, 2] = -dV_bead_dS
    out[1, 0] = -1/L
    out[2, 0] = dheat_bead_dphi/T
    out[2, 2] = dheat_bead_dS/T - heat_bead/T**2*dT_dS
    return out


def margins(x, u, p, /):
    """Margin by which each condition of DOMAIN holds; of a bank, the least one; shape (len(DOMAIN), *batch)."""
    x = _states(x, p)
    L = p.L
    C = p.C
    R_0 = p.R_0
    c = p.c
    T_0 = p.T_0
    out = np.empty((5, *x.shape[1:]))
    out[0] = R_0
    out[1] = L
    out[2] = C
    out[3] = T_0
    out[4] = c
    return out
