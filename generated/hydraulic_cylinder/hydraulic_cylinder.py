"""Hydraulic cylinder behind an orifice, with a load and an end stop: irreversible port-Hamiltonian system.

Source:  Merritt (1967), Hydraulic Control Systems, ch. 3 and 6
Model:   hydraulic_cylinder, spec sha256 9f77f306d723282ed74a083c6c8af89eb009af63f004a1308f102f81527e5387
System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
         rows, multiplied out; `piezo-sym show` prints the matrices
Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, continuous, sigma, exergy, environment, units, program PROVED
         (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
         parameters in the domain, and for banks of any size)

Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
Arrays have shape (n, *batch); values are in SI units.

x = (V, p, q, S)
u = (p_in, F, T_e)
p_ = Parameters(); the underscore tells it from p, a name of the model
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

NAME = "hydraulic_cylinder"
SPEC_SHA256 = "9f77f306d723282ed74a083c6c8af89eb009af63f004a1308f102f81527e5387"


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
    Record("V", "m**3", "volume of accumulator 'chamber'"),
    Record("p", "kg*m/s", "momentum of mass 'load'"),
    Record("q", "m", "extension of spring 'stop'"),
    Record("S", "J/K", "entropy of thermal_mass 'oil'"),
)
INPUTS = (
    Record("p_in", "Pa", "pressure of the supply"),
    Record("F", "N", "force on the load"),
    Record("T_e", "K", "temperature of the air"),
)
INPUT_DEFAULTS = (0.0, 0.0, 313.15)
# rows of outputs() and supply(): ports, named after the elements that have the inputs
OUTPUTS = (
    Record("supply", "m**3/s", "flow given by pressure_source 'supply'"),
    Record("push", "m/s", "velocity at force_source 'push'"),
    Record("air", "K", "temperature of thermal_mass 'oil'"),
)
# rows of heat() and entropy_production(): processes, with the unit of the second
PROCESSES = (
    Record("orifice", "W/K", "orifice 'orifice'"),
    Record("friction", "W/K", "damper 'friction'"),
)
# rows of temperatures(), and of elements()
BODIES = (
    Record("oil", "K", "temperature of thermal_mass 'oil'"),
)
ELEMENTS = (
    Record("supply.effort", "Pa", "pressure of pressure_source 'supply'"),
    Record("supply.flow", "m**3/s", "flow of pressure_source 'supply'"),
    Record("supply.power", "W", "power into pressure_source 'supply'"),
    Record("orifice.effort", "Pa", "pressure of orifice 'orifice'"),
    Record("orifice.flow", "m**3/s", "flow of orifice 'orifice'"),
    Record("orifice.power", "W", "power into orifice 'orifice'"),
    Record("orifice.heat", "W", "heat of orifice 'orifice'"),
    Record("chamber.effort", "Pa", "pressure of accumulator 'chamber'"),
    Record("chamber.flow", "m**3/s", "flow of accumulator 'chamber'"),
    Record("chamber.power", "W", "power into accumulator 'chamber'"),
    Record("chamber.energy", "J", "energy of accumulator 'chamber'"),
    Record("cylinder.effort_1", "Pa", "pressure in branch 1 of cylinder 'cylinder'"),
    Record("cylinder.flow_1", "m**3/s", "flow in branch 1 of cylinder 'cylinder'"),
    Record("cylinder.effort_2", "N", "force in branch 2 of cylinder 'cylinder'"),
    Record("cylinder.flow_2", "m/s", "velocity in branch 2 of cylinder 'cylinder'"),
    Record("cylinder.power", "W", "power from branch 1 to branch 2 of cylinder 'cylinder'"),
    Record("load.effort", "N", "force of mass 'load'"),
    Record("load.flow", "m/s", "velocity of mass 'load'"),
    Record("load.power", "W", "power into mass 'load'"),
    Record("load.energy", "J", "energy of mass 'load'"),
    Record("friction.effort", "N", "force of damper 'friction'"),
    Record("friction.flow", "m/s", "velocity of damper 'friction'"),
    Record("friction.power", "W", "power into damper 'friction'"),
    Record("friction.heat", "W", "heat of damper 'friction'"),
    Record("stop.effort", "N", "force of spring 'stop'"),
    Record("stop.flow", "m/s", "velocity of spring 'stop'"),
    Record("stop.power", "W", "power into spring 'stop'"),
    Record("stop.energy", "J", "energy of spring 'stop'"),
    Record("push.effort", "N", "force of force_source 'push'"),
    Record("push.flow", "m/s", "velocity of force_source 'push'"),
    Record("push.power", "W", "power into force_source 'push'"),
    Record("oil.effort", "K", "temperature of thermal_mass 'oil'"),
    Record("oil.flow", "W/K", "entropy flow of thermal_mass 'oil'"),
    Record("oil.power", "W", "power into thermal_mass 'oil'"),
    Record("oil.energy", "J", "energy of thermal_mass 'oil'"),
    Record("air.effort", "K", "temperature at ambient 'air'"),
    Record("air.flow", "W/K", "entropy flow at ambient 'air'"),
    Record("air.power", "W", "power into ambient 'air'"),
)
# fields of Parameters; elements of many lanes; conditions under which the proofs hold
PARAMETERS = (
    Record("C_d", "1", "discharge coefficient"),
    Record("a", "m**2", "area of the orifice"),
    Record("rho", "kg/m**3", "density of the oil"),
    Record("p_t", "Pa", "pressure below which the flow is laminar"),
    Record("A", "m**2", "area of the piston"),
    Record("C_h", "m**3/Pa", "capacitance of the oil in the cylinder, V/beta"),
    Record("m", "kg", "load"),
    Record("d", "N*s/m", "friction"),
    Record("k_s", "N/m", "stiffness of the end stop"),
    Record("x_s", "m", "stroke up to the end stop"),
    Record("c", "J/K", "heat capacity of oil and cylinder"),
    Record("lam", "W/K", "heat conductance to the air"),
    Record("T_0", "K", "temperature at the start"),
)
BANKS = ()
DOMAIN = (
    Condition("C_d >= 0", False),
    Condition("a >= 0", False),
    Condition("rho > 0", True),
    Condition("p_t > 0", True),
    Condition("d >= 0", False),
    Condition("k_s > 0", True),
    Condition("x_s > 0", True),
    Condition("lam >= 0", False),
    Condition("T_e > 0", True),
    Condition("C_h > 0", True),
    Condition("m > 0", True),
    Condition("T_0 > 0", True),
    Condition("c > 0", True),
)


@dataclass(frozen=True)
class Parameters:
    """Parameters of hydraulic_cylinder in SI units; defaults are the values of the spec."""

    C_d: float = 0.6
    a: float = 2e-06
    rho: float = 870.0
    p_t: float = 10000.0
    A: float = 0.001
    C_h: float = 5e-13
    m: float = 50.0
    d: float = 500.0
    k_s: float = 10000000.0
    x_s: float = 0.05
    c: float = 500.0
    lam: float = 5.0
    T_0: float = 313.15


def _states(x, p):
    """Return states x, shape (n, *batch), as floats."""
    x = np.asarray(x, dtype=float)
    n = 4
    if x.shape[:1] != (n,):
        raise ValueError(f"x has shape {x.shape}, but there are {n} states")
    return x


def _inputs(u):
    """Return inputs u, shape (3, *batch), as floats."""
    u = np.asarray(u, dtype=float)
    if u.shape[:1] != (3,):
        raise ValueError(f"u has shape {u.shape}, but there are 3 inputs")
    return u


def initial_state(u, p_, /):
    """State at t = 0 [SI], for the inputs u at t = 0; shape (n,)."""
    out = np.zeros(4)
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
    C_d = p_.C_d
    a = p_.a
    rho = p_.rho
    p_t = p_.p_t
    A = p_.A
    C_h = p_.C_h
    m = p_.m
    d = p_.d
    k_s = p_.k_s
    x_s = p_.x_s
    c = p_.c
    lam = p_.lam
    T_0 = p_.T_0
    V = x[0]
    p = x[1]
    q = x[2]
    S = x[3]
    p_in = u[0]
    F = u[1]
    T_e = u[2]
    # co-states dU/dx
    dp_chamber = V/C_h
    v_load = p/m
    F_stop = k_s*np.maximum(q - x_s, 0)
    T = T_0*np.exp(S/c)
    # transducer ratios
    alpha_cylinder = A
    # driving forces
    dp_orifice = -dp_chamber + p_in
    # dissipative laws
    flow_orifice = C_d*a*np.sqrt(2/rho)*dp_orifice/(dp_orifice**2 + p_t**2)**(0.25)
    F_friction = d*v_load
    # heats
    heat_orifice = flow_orifice*dp_orifice
    heat_friction = F_friction*v_load
    # result
    out[0] = flow_orifice - alpha_cylinder*v_load
    out[1] = alpha_cylinder*dp_chamber - F_stop - F_friction + F
    out[2] = v_load
    out[3] = (heat_orifice + heat_friction)/T + lam*(T_e/T - 1)


def outputs(x, u, p_, /):
    """Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient; shape (3, *batch)."""
    x = _states(x, p_)
    u = _inputs(u)
    C_d = p_.C_d
    a = p_.a
    rho = p_.rho
    p_t = p_.p_t
    C_h = p_.C_h
    m = p_.m
    c = p_.c
    T_0 = p_.T_0
    V = x[0]
    p = x[1]
    S = x[3]
    p_in = u[0]
    # co-states dU/dx
    dp_chamber = V/C_h
    v_load = p/m
    T = T_0*np.exp(S/c)
    # driving forces
    dp_orifice = -dp_chamber + p_in
    # dissipative laws
    flow_orifice = C_d*a*np.sqrt(2/rho)*dp_orifice/(dp_orifice**2 + p_t**2)**(0.25)
    # result
    out = np.empty((3, *x.shape[1:]))
    out[0] = flow_orifice
    out[1] = v_load
    out[2] = T
    return out


def supply(x, u, p_, /):
    """Power supplied through each port [W]; the sum is dU/dt; shape (3, *batch)."""
    x = _states(x, p_)
    u = _inputs(u)
    C_d = p_.C_d
    a = p_.a
    rho = p_.rho
    p_t = p_.p_t
    C_h = p_.C_h
    m = p_.m
    c = p_.c
    lam = p_.lam
    T_0 = p_.T_0
    V = x[0]
    p = x[1]
    S = x[3]
    p_in = u[0]
    F = u[1]
    T_e = u[2]
    # co-states dU/dx
    dp_chamber = V/C_h
    v_load = p/m
    T = T_0*np.exp(S/c)
    # driving forces
    dp_orifice = -dp_chamber + p_in
    # dissipative laws
    flow_orifice = C_d*a*np.sqrt(2/rho)*dp_orifice/(dp_orifice**2 + p_t**2)**(0.25)
    # result
    out = np.empty((3, *x.shape[1:]))
    out[0] = flow_orifice*p_in
    out[1] = v_load*F
    out[2] = lam*(T_e - T)
    return out


def energy(x, p_, /):
    """Hamiltonian U [J]; shape (*batch)."""
    x = _states(x, p_)
    C_h = p_.C_h
    m = p_.m
    k_s = p_.k_s
    x_s = p_.x_s
    c = p_.c
    T_0 = p_.T_0
    V = x[0]
    p = x[1]
    q = x[2]
    S = x[3]
    return V**2/(2*C_h) + p**2/(2*m) + 0.5*(k_s*np.maximum(q - x_s, 0)**2) + T_0*c*np.exp(S/c)


def entropy(x, p_, /):
    """Total entropy S [J/K]; shape (*batch)."""
    x = _states(x, p_)
    S = x[3]
    return S.copy()


def temperatures(x, p_, /):
    """Temperature of each body [K]; shape (1, *batch)."""
    x = _states(x, p_)
    c = p_.c
    T_0 = p_.T_0
    S = x[3]
    # co-states dU/dx
    T = T_0*np.exp(S/c)
    # result
    out = np.empty((1, *x.shape[1:]))
    out[0] = T
    return out


def heat(x, u, p_, /):
    """Power that each process turns into heat [W]; of a bank, one row per lane; shape (2, *batch)."""
    x = _states(x, p_)
    u = _inputs(u)
    C_d = p_.C_d
    a = p_.a
    rho = p_.rho
    p_t = p_.p_t
    C_h = p_.C_h
    m = p_.m
    d = p_.d
    V = x[0]
    p = x[1]
    p_in = u[0]
    # co-states dU/dx
    dp_chamber = V/C_h
    v_load = p/m
    # driving forces
    dp_orifice = -dp_chamber + p_in
    # dissipative laws
    flow_orifice = C_d*a*np.sqrt(2/rho)*dp_orifice/(dp_orifice**2 + p_t**2)**(0.25)
    F_friction = d*v_load
    # result
    out = np.empty((2, *x.shape[1:]))
    out[0] = flow_orifice*dp_orifice
    out[1] = F_friction*v_load
    return out


def entropy_production(x, u, p_, /):
    """Entropy production of each process [W/K], heat exchange with ambients not included; of a bank, one row per lane; shape (2, *batch)."""
    x = _states(x, p_)
    u = _inputs(u)
    C_d = p_.C_d
    a = p_.a
    rho = p_.rho
    p_t = p_.p_t
    C_h = p_.C_h
    m = p_.m
    d = p_.d
    c = p_.c
    T_0 = p_.T_0
    V = x[0]
    p = x[1]
    S = x[3]
    p_in = u[0]
    # co-states dU/dx
    dp_chamber = V/C_h
    v_load = p/m
    T = T_0*np.exp(S/c)
    # driving forces
    dp_orifice = -dp_chamber + p_in
    # dissipative laws
    flow_orifice = C_d*a*np.sqrt(2/rho)*dp_orifice/(dp_orifice**2 + p_t**2)**(0.25)
    F_friction = d*v_load
    # result
    out = np.empty((2, *x.shape[1:]))
    out[0] = flow_orifice*dp_orifice/T
    out[1] = F_friction*v_load/T
    return out


def elements(x, u, p_, /):
    """Effort, flow, power, energy and heat of elements; of a bank, one row per lane; shape (38, *batch)."""
    x = _states(x, p_)
    u = _inputs(u)
    C_d = p_.C_d
    a = p_.a
    rho = p_.rho
    p_t = p_.p_t
    A = p_.A
    C_h = p_.C_h
    m = p_.m
    d = p_.d
    k_s = p_.k_s
    x_s = p_.x_s
    c = p_.c
    lam = p_.lam
    T_0 = p_.T_0
    V = x[0]
    p = x[1]
    q = x[2]
    S = x[3]
    p_in = u[0]
    F = u[1]
    T_e = u[2]
    # co-states dU/dx
    dp_chamber = V/C_h
    v_load = p/m
    F_stop = k_s*np.maximum(q - x_s, 0)
    T = T_0*np.exp(S/c)
    # transducer ratios
    alpha_cylinder = A
    # driving forces
    dp_orifice = -dp_chamber + p_in
    # dissipative laws
    flow_orifice = C_d*a*np.sqrt(2/rho)*dp_orifice/(dp_orifice**2 + p_t**2)**(0.25)
    F_friction = d*v_load
    # heats
    heat_orifice = flow_orifice*dp_orifice
    heat_friction = F_friction*v_load
    # rates
    rate_V = flow_orifice - alpha_cylinder*v_load
    rate_p = alpha_cylinder*dp_chamber - F_stop - F_friction + F
    rate_S = (heat_orifice + heat_friction)/T + lam*(T_e/T - 1)
    # result
    out = np.empty((38, *x.shape[1:]))
    out[0] = p_in
    out[1] = -flow_orifice
    out[2] = -flow_orifice*p_in
    out[3] = dp_orifice
    out[4] = flow_orifice
    out[5] = flow_orifice*dp_orifice
    out[6] = flow_orifice*dp_orifice
    out[7] = dp_chamber
    out[8] = rate_V
    out[9] = dp_chamber*rate_V
    out[10] = V**2/(2*C_h)
    out[11] = dp_chamber
    out[12] = alpha_cylinder*v_load
    out[13] = -alpha_cylinder*dp_chamber
    out[14] = v_load
    out[15] = dp_chamber*alpha_cylinder*v_load
    out[16] = rate_p
    out[17] = v_load
    out[18] = rate_p*v_load
    out[19] = p**2/(2*m)
    out[20] = F_friction
    out[21] = v_load
    out[22] = F_friction*v_load
    out[23] = F_friction*v_load
    out[24] = F_stop
    out[25] = v_load
    out[26] = F_stop*v_load
    out[27] = 0.5*(k_s*np.maximum(q - x_s, 0)**2)
    out[28] = -F
    out[29] = v_load
    out[30] = -v_load*F
    out[31] = T
    out[32] = rate_S
    out[33] = T*rate_S
    out[34] = T_0*c*np.exp(S/c)
    out[35] = T
    out[36] = -lam*(T_e/T - 1)
    out[37] = -lam*(T_e - T)
    return out


def jacobian(x, u, p_, /):
    """Jacobian of rhs, d rhs[i]/d x[j] at [i, j]; shape (n, n, *batch)."""
    x = _states(x, p_)
    u = _inputs(u)
    C_d = p_.C_d
    a = p_.a
    rho = p_.rho
    p_t = p_.p_t
    A = p_.A
    C_h = p_.C_h
    m = p_.m
    d = p_.d
    k_s = p_.k_s
    x_s = p_.x_s
    c = p_.c
    lam = p_.lam
    T_0 = p_.T_0
    V = x[0]
    p = x[1]
    q = x[2]
    S = x[3]
    p_in = u[0]
    T_e = u[2]
    # co-states dU/dx
    dp_chamber = V/C_h
    v_load = p/m
    T = T_0*np.exp(S/c)
    # transducer ratios
    alpha_cylinder = A
    # driving forces
    dp_orifice = -dp_chamber + p_in
    # dissipative laws
    flow_orifice = C_d*a*np.sqrt(2/rho)*dp_orifice/(dp_orifice**2 + p_t**2)**(0.25)
    F_friction = d*v_load
    # heats
    heat_orifice = flow_orifice*dp_orifice
    heat_friction = F_friction*v_load
    # derivatives
    dflow_orifice_dV = -(C_d*a*np.sqrt(2/rho)/(dp_orifice**2 + p_t**2)**(0.25) - 0.5*(C_d*a*np.sqrt(2/rho)*dp_orifice*(dp_orifice**2 + p_t**2)**(-0.75)*dp_orifice)/((dp_orifice**2 + p_t**2)**(0.25))**2)/C_h
    dheat_orifice_dV = dp_orifice*dflow_orifice_dV - flow_orifice/C_h
    dF_friction_dp = d/m
    dheat_friction_dp = v_load*dF_friction_dp + F_friction/m
    dF_stop_dq = np.where(q - x_s >= 0, k_s, 0)
    dT_dS = T/c
    # result
    out = np.zeros((x.shape[0], *x.shape))
    out[0, 0] = dflow_orifice_dV
    out[0, 1] = -alpha_cylinder/m
    out[1, 0] = alpha_cylinder/C_h
    out[1, 1] = -dF_friction_dp
    out[1, 2] = -dF_stop_dq
    out[2, 1] = 1/m
    out[3, 0] = dheat_orifice_dV/T
    out[3, 1] = dheat_friction_dp/T
    out[3, 3] = (-(heat_orifice + heat_friction)/T**2 - lam*T_e/T**2)*dT_dS
    return out


def margins(x, u, p_, /):
    """Margin by which each condition of DOMAIN holds; of a bank, the least one; shape (len(DOMAIN), *batch)."""
    x = _states(x, p_)
    u = _inputs(u)
    C_d = p_.C_d
    a = p_.a
    rho = p_.rho
    p_t = p_.p_t
    C_h = p_.C_h
    m = p_.m
    d = p_.d
    k_s = p_.k_s
    x_s = p_.x_s
    c = p_.c
    lam = p_.lam
    T_0 = p_.T_0
    T_e = u[2]
    out = np.empty((13, *x.shape[1:]))
    out[0] = C_d
    out[1] = a
    out[2] = rho
    out[3] = p_t
    out[4] = d
    out[5] = k_s
    out[6] = x_s
    out[7] = lam
    out[8] = T_e
    out[9] = C_h
    out[10] = m
    out[11] = T_0
    out[12] = c
    return out
