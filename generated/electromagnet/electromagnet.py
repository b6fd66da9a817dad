"""Electromagnet with an armature on a spring, and a coil that warms: irreversible port-Hamiltonian system.

Source:  Woodson, Melcher (1968), Electromechanical Dynamics I, ch. 3
Model:   electromagnet, spec sha256 9b4244be212754305b836d305b67a8844d9eaeab14c345563f9a22957982c0af
System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
         rows, multiplied out; `piezo-sym show` prints the matrices
Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, sigma, exergy, environment, units, program PROVED
         (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
         parameters in the domain, and for banks of any size)

Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
Arrays have shape (n, *batch); values are in SI units.

x = (q, p, S, phi, x)
u = (V_in, T_e)
p_ = Parameters(); the underscore tells it from p, a name of the model
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

NAME = "electromagnet"
SPEC_SHA256 = "9b4244be212754305b836d305b67a8844d9eaeab14c345563f9a22957982c0af"


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
    Record("p", "kg*m/s", "momentum of mass 'armature'"),
    Record("S", "J/K", "entropy of thermal_mass 'winding'"),
    Record("phi", "Wb", "flux linkage of storage 'magnet'"),
    Record("x", "m", "extension of storage 'magnet'"),
)
INPUTS = (
    Record("V_in", "V", "voltage of the coil"),
    Record("T_e", "K", "temperature of the air"),
)
INPUT_DEFAULTS = (0.0, 293.15)
# rows of outputs() and supply(): ports, named after the elements that have the inputs
OUTPUTS = (
    Record("supply", "A", "current given by voltage_source 'supply'"),
    Record("air", "K", "temperature of thermal_mass 'winding'"),
)
# rows of heat() and entropy_production(): processes, with the unit of the second
PROCESSES = (
    Record("copper", "W/K", "resistor 'copper'"),
    Record("friction", "W/K", "damper 'friction'"),
)
# rows of temperatures(), and of elements()
BODIES = (
    Record("winding", "K", "temperature of thermal_mass 'winding'"),
)
ELEMENTS = (
    Record("supply.effort", "V", "voltage of voltage_source 'supply'"),
    Record("supply.flow", "A", "current of voltage_source 'supply'"),
    Record("supply.power", "W", "power into voltage_source 'supply'"),
    Record("copper.effort", "V", "voltage of resistor 'copper'"),
    Record("copper.flow", "A", "current of resistor 'copper'"),
    Record("copper.power", "W", "power into resistor 'copper'"),
    Record("copper.heat", "W", "heat of resistor 'copper'"),
    Record("spring.effort", "N", "force of spring 'spring'"),
    Record("spring.flow", "m/s", "velocity of spring 'spring'"),
    Record("spring.power", "W", "power into spring 'spring'"),
    Record("spring.energy", "J", "energy of spring 'spring'"),
    Record("armature.effort", "N", "force of mass 'armature'"),
    Record("armature.flow", "m/s", "velocity of mass 'armature'"),
    Record("armature.power", "W", "power into mass 'armature'"),
    Record("armature.energy", "J", "energy of mass 'armature'"),
    Record("friction.effort", "N", "force of damper 'friction'"),
    Record("friction.flow", "m/s", "velocity of damper 'friction'"),
    Record("friction.power", "W", "power into damper 'friction'"),
    Record("friction.heat", "W", "heat of damper 'friction'"),
    Record("winding.effort", "K", "temperature of thermal_mass 'winding'"),
    Record("winding.flow", "W/K", "entropy flow of thermal_mass 'winding'"),
    Record("winding.power", "W", "power into thermal_mass 'winding'"),
    Record("winding.energy", "J", "energy of thermal_mass 'winding'"),
    Record("air.effort", "K", "temperature at ambient 'air'"),
    Record("air.flow", "W/K", "entropy flow at ambient 'air'"),
    Record("air.power", "W", "power into ambient 'air'"),
    Record("magnet.effort_phi", "V", "voltage of storage 'magnet'"),
    Record("magnet.flow_phi", "A", "current of storage 'magnet'"),
    Record("magnet.effort_x", "N", "force of storage 'magnet'"),
    Record("magnet.flow_x", "m/s", "velocity of storage 'magnet'"),
    Record("magnet.power", "W", "power into storage 'magnet'"),
    Record("magnet.energy", "J", "energy of storage 'magnet'"),
)
# fields of Parameters; elements of many lanes; conditions under which the proofs hold
PARAMETERS = (
    Record("g", "m", "gap at rest"),
    Record("A", "m**2", "area of the pole"),
    Record("N", "1", "turns"),
    Record("mu", "H/m", "permeability of the gap"),
    Record("m", "kg", "mass of the armature"),
    Record("k", "N/m", "stiffness of its spring"),
    Record("d", "N*s/m", "damping"),
    Record("R", "ohm", "resistance of the coil"),
    Record("c", "J/K", "heat capacity of the coil"),
    Record("lam", "W/K", "heat conductance to the air"),
    Record("T_0", "K", "temperature at the start"),
)
BANKS = ()
DOMAIN = (
    Condition("g + x > 0", True),
    Condition("A > 0", True),
    Condition("N > 0", True),
    Condition("mu > 0", True),
    Condition("d >= 0", False),
    Condition("R >= 0", False),
    Condition("lam >= 0", False),
    Condition("T_e > 0", True),
    Condition("k > 0", True),
    Condition("m > 0", True),
    Condition("T_0 > 0", True),
    Condition("c > 0", True),
)


@dataclass(frozen=True)
class Parameters:
    """Parameters of electromagnet in SI units; defaults are the values of the spec."""

    g: float = 0.002
    A: float = 0.0001
    N: float = 500.0
    mu: float = 1.25663706e-06
    m: float = 0.05
    k: float = 5000.0
    d: float = 3.0
    R: float = 8.0
    c: float = 20.0
    lam: float = 0.3
    T_0: float = 293.15


def _states(x, p):
    """Return states x, shape (n, *batch), as floats."""
    x = np.asarray(x, dtype=float)
    n = 5
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
    out = np.zeros(5)
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


def _rates(x_, u, p_, out, /):
    """Write the rates dx/dt into `out`."""
    g = p_.g
    A = p_.A
    N = p_.N
    mu = p_.mu
    m = p_.m
    k = p_.k
    d = p_.d
    R = p_.R
    c = p_.c
    lam = p_.lam
    T_0 = p_.T_0
    q = x_[0]
    p = x_[1]
    S = x_[2]
    phi = x_[3]
    x = x_[4]
    V_in = u[0]
    T_e = u[1]
    # co-states dU/dx
    F_spring = k*q
    v_armature = p/m
    T = T_0*np.exp(S/c)
    i_phi = 2*(phi*(g + x))/(2*mu*A*N**2)
    F_x = phi**2/(2*mu*A*N**2)
    # dissipative laws
    V_copper = R*i_phi
    F_friction = d*v_armature
    # heats
    heat_copper = V_copper*i_phi
    heat_friction = F_friction*v_armature
    # result
    out[0] = v_armature
    out[1] = -F_spring - F_x - F_friction
    out[2] = (heat_copper + heat_friction)/T + lam*(T_e/T - 1)
    out[3] = V_in - V_copper
    out[4] = v_armature


def outputs(x_, u, p_, /):
    """Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient; shape (2, *batch)."""
    x_ = _states(x_, p_)
    g = p_.g
    A = p_.A
    N = p_.N
    mu = p_.mu
    c = p_.c
    T_0 = p_.T_0
    S = x_[2]
    phi = x_[3]
    x = x_[4]
    # co-states dU/dx
    T = T_0*np.exp(S/c)
    i_phi = 2*(phi*(g + x))/(2*mu*A*N**2)
    # result
    out = np.empty((2, *x_.shape[1:]))
    out[0] = i_phi
    out[1] = T
    return out


def supply(x_, u, p_, /):
    """Power supplied through each port [W]; the sum is dU/dt; shape (2, *batch)."""
    x_ = _states(x_, p_)
    u = _inputs(u)
    g = p_.g
    A = p_.A
    N = p_.N
    mu = p_.mu
    c = p_.c
    lam = p_.lam
    T_0 = p_.T_0
    S = x_[2]
    phi = x_[3]
    x = x_[4]
    V_in = u[0]
    T_e = u[1]
    # co-states dU/dx
    T = T_0*np.exp(S/c)
    i_phi = 2*(phi*(g + x))/(2*mu*A*N**2)
    # result
    out = np.empty((2, *x_.shape[1:]))
    out[0] = i_phi*V_in
    out[1] = lam*(T_e - T)
    return out


def energy(x_, p_, /):
    """Hamiltonian U [J]; shape (*batch)."""
    x_ = _states(x_, p_)
    g = p_.g
    A = p_.A
    N = p_.N
    mu = p_.mu
    m = p_.m
    k = p_.k
    c = p_.c
    T_0 = p_.T_0
    q = x_[0]
    p = x_[1]
    S = x_[2]
    phi = x_[3]
    x = x_[4]
    return k*q**2/2 + p**2/(2*m) + T_0*c*np.exp(S/c) + phi**2*(g + x)/(2*mu*A*N**2)


def entropy(x_, p_, /):
    """Total entropy S [J/K]; shape (*batch)."""
    x_ = _states(x_, p_)
    S = x_[2]
    return S.copy()


def temperatures(x_, p_, /):
    """Temperature of each body [K]; shape (1, *batch)."""
    x_ = _states(x_, p_)
    c = p_.c
    T_0 = p_.T_0
    S = x_[2]
    # co-states dU/dx
    T = T_0*np.exp(S/c)
    # result
    out = np.empty((1, *x_.shape[1:]))
    out[0] = T
    return out


def heat(x_, u, p_, /):
    """Power that each process turns into heat [W]; of a bank, one row per lane; shape (2, *batch)."""
    x_ = _states(x_, p_)
    g = p_.g
    A = p_.A
    N = p_.N
    mu = p_.mu
    m = p_.m
    d = p_.d
    R = p_.R
    p = x_[1]
    phi = x_[3]
    x = x_[4]
    # co-states dU/dx
    v_armature = p/m
    i_phi = 2*(phi*(g + x))/(2*mu*A*N**2)
    # dissipative laws
    V_copper = R*i_phi
    F_friction = d*v_armature
    # result
    out = np.empty((2, *x_.shape[1:]))
    out[0] = V_copper*i_phi
    out[1] = F_friction*v_armature
    return out


def entropy_production(x_, u, p_, /):
    """Entropy production of each process [W/K], heat exchange with ambients not included; of a bank, one row per lane; shape (2, *batch)."""
    x_ = _states(x_, p_)
    g = p_.g
    A = p_.A
    N = p_.N
    mu = p_.mu
    m = p_.m
    d = p_.d
    R = p_.R
    c = p_.c
    T_0 = p_.T_0
    p = x_[1]
    S = x_[2]
    phi = x_[3]
    x = x_[4]
    # co-states dU/dx
    v_armature = p/m
    T = T_0*np.exp(S/c)
    i_phi = 2*(phi*(g + x))/(2*mu*A*N**2)
    # dissipative laws
    V_copper = R*i_phi
    F_friction = d*v_armature
    # result
    out = np.empty((2, *x_.shape[1:]))
    out[0] = V_copper*i_phi/T
    out[1] = F_friction*v_armature/T
    return out


def elements(x_, u, p_, /):
    """Effort, flow, power, energy and heat of elements; of a bank, one row per lane; shape (32, *batch)."""
    x_ = _states(x_, p_)
    u = _inputs(u)
    g = p_.g
    A = p_.A
    N = p_.N
    mu = p_.mu
    m = p_.m
    k = p_.k
    d = p_.d
    R = p_.R
    c = p_.c
    lam = p_.lam
    T_0 = p_.T_0
    q = x_[0]
    p = x_[1]
    S = x_[2]
    phi = x_[3]
    x = x_[4]
    V_in = u[0]
    T_e = u[1]
    # co-states dU/dx
    F_spring = k*q
    v_armature = p/m
    T = T_0*np.exp(S/c)
    i_phi = 2*(phi*(g + x))/(2*mu*A*N**2)
    F_x = phi**2/(2*mu*A*N**2)
    # dissipative laws
    V_copper = R*i_phi
    F_friction = d*v_armature
    # heats
    heat_copper = V_copper*i_phi
    heat_friction = F_friction*v_armature
    # rates
    rate_p = -F_spring - F_x - F_friction
    rate_S = (heat_copper + heat_friction)/T + lam*(T_e/T - 1)
    rate_phi = V_in - V_copper
    # result
    out = np.empty((32, *x_.shape[1:]))
    out[0] = V_in
    out[1] = -i_phi
    out[2] = -i_phi*V_in
    out[3] = V_copper
    out[4] = i_phi
    out[5] = V_copper*i_phi
    out[6] = V_copper*i_phi
    out[7] = F_spring
    out[8] = v_armature
    out[9] = F_spring*v_armature
    out[10] = k*q**2/2
    out[11] = rate_p
    out[12] = v_armature
    out[13] = rate_p*v_armature
    out[14] = p**2/(2*m)
    out[15] = F_friction
    out[16] = v_armature
    out[17] = F_friction*v_armature
    out[18] = F_friction*v_armature
    out[19] = T
    out[20] = rate_S
    out[21] = T*rate_S
    out[22] = T_0*c*np.exp(S/c)
    out[23] = T
    out[24] = -lam*(T_e/T - 1)
    out[25] = -lam*(T_e - T)
    out[26] = rate_phi
    out[27] = i_phi
    out[28] = F_x
    out[29] = v_armature
    out[30] = i_phi*rate_phi + F_x*v_armature
    out[31] = phi**2*(g + x)/(2*mu*A*N**2)
    return out


def jacobian(x_, u, p_, /):
    """Jacobian of rhs, d rhs[i]/d x[j] at [i, j]; shape (n, n, *batch)."""
    x_ = _states(x_, p_)
    u = _inputs(u)
    g = p_.g
    A = p_.A
    N = p_.N
    mu = p_.mu
    m = p_.m
    k = p_.k
    d = p_.d
    R = p_.R
    c = p_.c
    lam = p_.lam
    T_0 = p_.T_0
    p = x_[1]
    S = x_[2]
    phi = x_[3]
    x = x_[4]
    T_e = u[1]
    # co-states dU/dx
    v_armature = p/m
    T = T_0*np.exp(S/c)
    i_phi = 2*(phi*(g + x))/(2*mu*A*N**2)
    # dissipative laws
    V_copper = R*i_phi
    F_friction = d*v_armature
    # heats
    heat_copper = V_copper*i_phi
    heat_friction = F_friction*v_armature
    # derivatives
    dF_friction_dp = d/m
    dheat_friction_dp = v_armature*dF_friction_dp + F_friction/m
    dT_dS = T/c
    di_phi_dphi = 2*(g + x)/(2*mu*A*N**2)
    dF_x_dphi = 2*phi/(2*mu*A*N**2)
    dV_copper_dphi = R*di_phi_dphi
    dheat_copper_dphi = i_phi*dV_copper_dphi + V_copper*di_phi_dphi
    di_phi_dx = 2*phi/(2*mu*A*N**2)
    dV_copper_dx = R*di_phi_dx
    dheat_copper_dx = i_phi*dV_copper_dx + V_copper*di_phi_dx
    # result
    out = np.zeros((x_.shape[0], *x_.shape))
    out[0, 1] = 1/m
    out[1, 0] = -k
    out[1, 1] = -dF_friction_dp
    out[1, 3] = -dF_x_dphi
    out[2, 1] = dheat_friction_dp/T
    out[2, 2] = (-(heat_copper + heat_friction)/T**2 - lam*T_e/T**2)*dT_dS
    out[2, 3] = dheat_copper_dphi/T
    out[2, 4] = dheat_copper_dx/T
    out[3, 3] = -dV_copper_dphi
    out[3, 4] = -dV_copper_dx
    out[4, 1] = 1/m
    return out


def margins(x_, u, p_, /):
    """Margin by which each condition of DOMAIN holds; of a bank, the least one; shape (len(DOMAIN), *batch)."""
    x_ = _states(x_, p_)
    u = _inputs(u)
    g = p_.g
    A = p_.A
    N = p_.N
    mu = p_.mu
    m = p_.m
    k = p_.k
    d = p_.d
    R = p_.R
    c = p_.c
    lam = p_.lam
    T_0 = p_.T_0
    x = x_[4]
    T_e = u[1]
    out = np.empty((12, *x_.shape[1:]))
    out[0] = g + x
    out[1] = A
    out[2] = N
    out[3] = mu
    out[4] = d
    out[5] = R
    out[6] = lam
    out[7] = T_e
    out[8] = k
    out[9] = m
    out[10] = T_0
    out[11] = c
    return out
