"""Peltier cooler: cold plate, thermoelectric couples, heat sink: irreversible port-Hamiltonian system.

Source:  Ioffe (1957), Semiconductor Thermoelements; values of a module of 127 couples
Model:   peltier_cooler, spec sha256 e97f90f757f77de747011f7a983b38c3f53075a795fa19e001fa2cd5567cc5f1
System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
         rows, multiplied out; `piezo-sym show` prints the matrices
Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, sigma, exergy, environment, units, program PROVED
         (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
         parameters in the domain, and for banks of any size)

Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
Arrays have shape (n, *batch); values are in SI units.

x = (phi, S_c, S_h)
u = (V_in, P, T_e)
p = Parameters()
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

NAME = "peltier_cooler"
SPEC_SHA256 = "e97f90f757f77de747011f7a983b38c3f53075a795fa19e001fa2cd5567cc5f1"


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
    Record("phi", "Wb", "flux linkage of inductor 'leads'"),
    Record("S_c", "J/K", "entropy of thermal_mass 'plate'"),
    Record("S_h", "J/K", "entropy of thermal_mass 'sink'"),
)
INPUTS = (
    Record("V_in", "V", "voltage of the supply"),
    Record("P", "W", "heat to be cooled away"),
    Record("T_e", "K", "temperature of the air"),
)
INPUT_DEFAULTS = (0.0, 0.0, 300.0)
# rows of outputs() and supply(): ports, named after the elements that have the inputs
OUTPUTS = (
    Record("supply", "A", "current given by voltage_source 'supply'"),
    Record("load", "K", "temperature of thermal_mass 'plate'"),
    Record("air", "K", "temperature of thermal_mass 'sink'"),
)
# rows of heat() and entropy_production(): processes, with the unit of the second
PROCESSES = (
    Record("warm", "W/K", "resistor 'warm'"),
    Record("cool", "W/K", "resistor 'cool'"),
    Record("legs", "W/K", "conduction 'legs'"),
)
# rows of temperatures(), and of elements()
BODIES = (
    Record("plate", "K", "temperature of thermal_mass 'plate'"),
    Record("sink", "K", "temperature of thermal_mass 'sink'"),
)
ELEMENTS = (
    Record("supply.effort", "V", "voltage of voltage_source 'supply'"),
    Record("supply.flow", "A", "current of voltage_source 'supply'"),
    Record("supply.power", "W", "power into voltage_source 'supply'"),
    Record("leads.effort", "V", "voltage of inductor 'leads'"),
    Record("leads.flow", "A", "current of inductor 'leads'"),
    Record("leads.power", "W", "power into inductor 'leads'"),
    Record("leads.energy", "J", "energy of inductor 'leads'"),
    Record("warm.effort", "V", "voltage of resistor 'warm'"),
    Record("warm.flow", "A", "current of resistor 'warm'"),
    Record("warm.power", "W", "power into resistor 'warm'"),
    Record("warm.heat", "W", "heat of resistor 'warm'"),
    Record("cool.effort", "V", "voltage of resistor 'cool'"),
    Record("cool.flow", "A", "current of resistor 'cool'"),
    Record("cool.power", "W", "power into resistor 'cool'"),
    Record("cool.heat", "W", "heat of resistor 'cool'"),
    Record("couples.effort_1", "V", "voltage in branch 1 of thermoelectric 'couples'"),
    Record("couples.flow_1", "A", "current in branch 1 of thermoelectric 'couples'"),
    Record("couples.effort_2", "K", "temperature in branch 2 of thermoelectric 'couples'"),
    Record("couples.flow_2", "W/K", "entropy flow in branch 2 of thermoelectric 'couples'"),
    Record("couples.power", "W", "power from branch 1 to branch 2 of thermoelectric 'couples'"),
    Record("legs.effort", "K", "temperature difference over conduction 'legs'"),
    Record("legs.power", "W", "heat from first to second body by conduction 'legs'"),
    Record("plate.effort", "K", "temperature of thermal_mass 'plate'"),
    Record("plate.flow", "W/K", "entropy flow of thermal_mass 'plate'"),
    Record("plate.power", "W", "power into thermal_mass 'plate'"),
    Record("plate.energy", "J", "energy of thermal_mass 'plate'"),
    Record("sink.effort", "K", "temperature of thermal_mass 'sink'"),
    Record("sink.flow", "W/K", "entropy flow of thermal_mass 'sink'"),
    Record("sink.power", "W", "power into thermal_mass 'sink'"),
    Record("sink.energy", "J", "energy of thermal_mass 'sink'"),
    Record("load.effort", "K", "temperature at heat_source 'load'"),
    Record("load.flow", "W/K", "entropy flow at heat_source 'load'"),
    Record("load.power", "W", "power into heat_source 'load'"),
    Record("air.effort", "K", "temperature at ambient 'air'"),
    Record("air.flow", "W/K", "entropy flow at ambient 'air'"),
    Record("air.power", "W", "power into ambient 'air'"),
)
# fields of Parameters; elements of many lanes; conditions under which the proofs hold
PARAMETERS = (
    Record("s", "V/K", "Seebeck coefficient of the module"),
    Record("R", "ohm", "resistance of the module"),
    Record("lam", "W/K", "heat conductance of the module"),
    Record("L", "H", "inductance of the leads"),
    Record("c_c", "J/K", "heat capacity of the cold plate"),
    Record("c_h", "J/K", "heat capacity of the heat sink"),
    Record("h", "W/K", "heat conductance from heat sink to air"),
    Record("T_0", "K", "temperature at the start"),
)
BANKS = ()
DOMAIN = (
    Condition("R >= 0", False),
    Condition("lam >= 0", False),
    Condition("h >= 0", False),
    Condition("T_e > 0", True),
    Condition("L > 0", True),
    Condition("T_0 > 0", True),
    Condition("c_c > 0", True),
    Condition("c_h > 0", True),
)


@dataclass(frozen=True)
class Parameters:
    """Parameters of peltier_cooler in SI units; defaults are the values of the spec."""

    s: float = 0.05
    R: float = 2.0
    lam: float = 0.5
    L: float = 0.001
    c_c: float = 20.0
    c_h: float = 200.0
    h: float = 50.0
    T_0: float = 300.0


def _states(x, p):
    """Return states x, shape (n, *batch), as floats."""
    x = np.asarray(x, dtype=float)
    n = 3
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


def _rates(x, u, p, out, /):
    """Write the rates dx/dt into `out`."""
    s = p.s
    R = p.R
    lam = p.lam
    L = p.L
    c_c = p.c_c
    c_h = p.c_h
    h = p.h
    T_0 = p.T_0
    phi = x[0]
    S_c = x[1]
    S_h = x[2]
    V_in = u[0]
    P = u[1]
    T_e = u[2]
    # co-states dU/dx
    i_leads = phi/L
    T_plate = T_0*np.exp(S_c/c_c)
    T_sink = T_0*np.exp(S_h/c_h)
    # transducer ratios
    seebeck_couples = s
    # dissipative laws
    V_warm = R/2*i_leads
    V_cool = R/2*i_leads
    s_legs = lam*(T_plate - T_sink)/T_plate
    # heats
    heat_warm = V_warm*i_leads
    heat_cool = V_cool*i_leads
    heat_legs = s_legs*T_plate
    # result
    out[0] = seebeck_couples*T_plate - seebeck_couples*T_sink - V_warm - V_cool + V_in
    out[1] = heat_cool/T_plate - seebeck_couples*i_leads - s_legs + P/T_plate
    out[2] = (heat_warm + heat_legs)/T_sink + seebeck_couples*i_leads + h*(T_e/T_sink - 1)


def outputs(x, u, p, /):
    """Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient; shape (3, *batch)."""
    x = _states(x, p)
    L = p.L
    c_c = p.c_c
    c_h = p.c_h
    T_0 = p.T_0
    phi = x[0]
    S_c = x[1]
    S_h = x[2]
    # co-states dU/dx
    i_leads = phi/L
    T_plate = T_0*np.exp(S_c/c_c)
    T_sink = T_0*np.exp(S_h/c_h)
    # result
    out = np.empty((3, *x.shape[1:]))
    out[0] = i_leads
    out[1] = T_plate
    out[2] = T_sink
    return out


def supply(x, u, p, /):
    """Power supplied through each port [W]; the sum is dU/dt; shape (3, *batch)."""
    x = _states(x, p)
    u = _inputs(u)
    L = p.L
    c_h = p.c_h
    h = p.h
    T_0 = p.T_0
    phi = x[0]
    S_h = x[2]
    V_in = u[0]
    P = u[1]
    T_e = u[2]
    # co-states dU/dx
    i_leads = phi/L
    T_sink = T_0*np.exp(S_h/c_h)
    # result
    out = np.empty((3, *x.shape[1:]))
    out[0] = i_leads*V_in
    out[1] = P
    out[2] = h*(T_e - T_sink)
    return out


def energy(x, p, /):
    """Hamiltonian U [J]; shape (*batch)."""
    x = _states(x, p)
    L = p.L
    c_c = p.c_c
    c_h = p.c_h
    T_0 = p.T_0
    phi = x[0]
    S_c = x[1]
    S_h = x[2]
    return phi**2/(2*L) + T_0*c_c*np.exp(S_c/c_c) + T_0*c_h*np.exp(S_h/c_h)


def entropy(x, p, /):
    """Total entropy S [J/K]; shape (*batch)."""
    x = _states(x, p)
    S_c = x[1]
    S_h = x[2]
    return S_c + S_h


def temperatures(x, p, /):
    """Temperature of each body [K]; shape (2, *batch)."""
    x = _states(x, p)
    c_c = p.c_c
    c_h = p.c_h
    T_0 = p.T_0
    S_c = x[1]
    S_h = x[2]
    # co-states dU/dx
    T_plate = T_0*np.exp(S_c/c_c)
    T_sink = T_0*np.exp(S_h/c_h)
    # result
    out = np.empty((2, *x.shape[1:]))
    out[0] = T_plate
    out[1] = T_sink
    return out


def heat(x, u, p, /):
    """Power that each process turns into heat [W]; of a bank, one row per lane; shape (3, *batch)."""
    x = _states(x, p)
    R = p.R
    lam = p.lam
    L = p.L
    c_c = p.c_c
    c_h = p.c_h
    T_0 = p.T_0
    phi = x[0]
    S_c = x[1]
    S_h = x[2]
    # co-states dU/dx
    i_leads = phi/L
    T_plate = T_0*np.exp(S_c/c_c)
    T_sink = T_0*np.exp(S_h/c_h)
    # dissipative laws
    V_warm = R/2*i_leads
    V_cool = R/2*i_leads
    s_legs = lam*(T_plate - T_sink)/T_plate
    # result
    out = np.empty((3, *x.shape[1:]))
    out[0] = V_warm*i_leads
    out[1] = V_cool*i_leads
    out[2] = s_legs*T_plate
    return out


def entropy_production(x, u, p, /):
    """Entropy production of each process [W/K], heat exchange with ambients not included; of a bank, one row per lane; shape (3, *batch)."""
    x = _states(x, p)
    R = p.R
    lam = p.lam
    L = p.L
    c_c = p.c_c
    c_h = p.c_h
    T_0 = p.T_0
    phi = x[0]
    S_c = x[1]
    S_h = x[2]
    # co-states dU/dx
    i_leads = phi/L
    T_plate = T_0*np.exp(S_c/c_c)
    T_sink = T_0*np.exp(S_h/c_h)
    # dissipative laws
    V_warm = R/2*i_leads
    V_cool = R/2*i_leads
    s_legs = lam*(T_plate - T_sink)/T_plate
    # result
    out = np.empty((3, *x.shape[1:]))
    out[0] = V_warm*i_leads/T_sink
    out[1] = V_cool*i_leads/T_plate
    out[2] = s_legs*(T_plate - T_sink)/T_sink
    return out


def elements(x, u, p, /):
    """Effort, flow, power, energy and heat of elements; of a bank, one row per lane; shape (36, *batch)."""
    x = _states(x, p)
    u = _inputs(u)
    s = p.s
    R = p.R
    lam = p.lam
    L = p.L
    c_c = p.c_c
    c_h = p.c_h
    h = p.h
    T_0 = p.T_0
    phi = x[0]
    S_c = x[1]
    S_h = x[2]
    V_in = u[0]
    P = u[1]
    T_e = u[2]
    # co-states dU/dx
    i_leads = phi/L
    T_plate = T_0*np.exp(S_c/c_c)
    T_sink = T_0*np.exp(S_h/c_h)
    # transducer ratios
    seebeck_couples = s
    # dissipative laws
    V_warm = R/2*i_leads
    V_cool = R/2*i_leads
    s_legs = lam*(T_plate - T_sink)/T_plate
    # heats
    heat_warm = V_warm*i_leads
    heat_cool = V_cool*i_leads
    heat_legs = s_legs*T_plate
    # rates
    rate_phi = seebeck_couples*T_plate - seebeck_couples*T_sink - V_warm - V_cool + V_in
    rate_S_c = heat_cool/T_plate - seebeck_couples*i_leads - s_legs + P/T_plate
    rate_S_h = (heat_warm + heat_legs)/T_sink + seebeck_couples*i_leads + h*(T_e/T_sink - 1)
    # result
    out = np.empty((36, *x.shape[1:]))
    out[0] = V_in
    out[1] = -i_leads
    out[2] = -i_leads*V_in
    out[3] = rate_phi
    out[4] = i_leads
    out[5] = rate_phi*i_leads
    out[6] = phi**2/(2*L)
    out[7] = V_warm
    out[8] = i_leads
    out[9] = V_warm*i_leads
    out[10] = V_warm*i_leads
    out[11] = V_cool
    out[12] = i_leads
    out[13] = V_cool*i_leads
    out[14] = V_cool*i_leads
    out[15] = seebeck_couples*(-T_plate + T_sink)
    out[16] = i_leads
    out[17] = -T_plate + T_sink
    out[18] = -seebeck_couples*i_leads
    out[19] = seebeck_couples*(-T_plate + T_sink)*i_leads
    out[20] = T_plate - T_sink
    out[21] = s_legs*T_plate
    out[22] = T_plate
    out[23] = rate_S_c
    out[24] = T_plate*rate_S_c
    out[25] = T_0*c_c*np.exp(S_c/c_c)
    out[26] = T_sink
    out[27] = rate_S_h
    out[28] = T_sink*rate_S_h
    out[29] = T_0*c_h*np.exp(S_h/c_h)
    out[30] = T_plate
    out[31] = -P/T_plate
    out[32] = -P
    out[33] = T_sink
    out[34] = -h*(T_e/T_sink - 1)
    out[35] = -h*(T_e - T_sink)
    return out


def jacobian(x, u, p, /):
    """Jacobian of rhs, d rhs[i]/d x[j] at [i, j]; shape (n, n, *batch)."""
    x = _states(x, p)
    u = _inputs(u)
    s = p.s
    R = p.R
    lam = p.lam
    L = p.L
    c_c = p.c_c
    c_h = p.c_h
    h = p.h
    T_0 = p.T_0
    phi = x[0]
    S_c = x[1]
    S_h = x[2]
    P = u[1]
    T_e = u[2]
    # co-states dU/dx
    i_leads = phi/L
    T_plate = T_0*np.exp(S_c/c_c)
    T_sink = T_0*np.exp(S_h/c_h)
    # transducer ratios
    seebeck_couples = s
    # dissipative laws
    V_warm = R/2*i_leads
    V_cool = R/2*i_leads
    s_legs = lam*(T_plate - T_sink)/T_plate
    # heats
    heat_warm = V_warm*i_leads
    heat_cool = V_cool*i_leads
    heat_legs = s_legs*T_plate
    # derivatives
    dV_warm_dphi = R/2/L
    dheat_warm_dphi = i_leads*dV_warm_dphi + V_warm/L
    dheat_cool_dphi = i_leads*dV_warm_dphi + V_cool/L
    dT_plate_dS_c = T_plate/c_c
    ds_legs_dS_c = (lam/T_plate - lam*(T_plate - T_sink)/T_plate**2)*dT_plate_dS_c
    dheat_legs_dS_c = T_plate*ds_legs_dS_c + s_legs*dT_plate_dS_c
    dT_sink_dS_h = T_sink/c_h
    ds_legs_dS_h = -lam/T_plate*dT_sink_dS_h
    dheat_legs_dS_h = T_plate*ds_legs_dS_h
    # result
    out = np.zeros((x.shape[0], *x.shape))
    out[0, 0] = -dV_warm_dphi - dV_warm_dphi
    out[0, 1] = seebeck_couples*dT_plate_dS_c
    out[0, 2] = -seebeck_couples*dT_sink_dS_h
    out[1, 0] = dheat_cool_dphi/T_plate - seebeck_couples/L
    out[1, 1] = (-heat_cool/T_plate**2 - P/T_plate**2)*dT_plate_dS_c - ds_legs_dS_c
    out[1, 2] = -ds_legs_dS_h
    out[2, 0] = dheat_warm_dphi/T_sink + seebeck_couples/L
    out[2, 1] = dheat_legs_dS_c/T_sink
    out[2, 2] = (
        dheat_legs_dS_h/T_sink
        + (-(heat_warm + heat_legs)/T_sink**2 - h*T_e/T_sink**2)*dT_sink_dS_h
    )
    return out


def margins(x, u, p, /):
    """Margin by which each condition of DOMAIN holds; of a bank, the least one; shape (len(DOMAIN), *batch)."""
    x = _states(x, p)
    u = _inputs(u)
    R = p.R
    lam = p.lam
    L = p.L
    c_c = p.c_c
    c_h = p.c_h
    h = p.h
    T_0 = p.T_0
    T_e = u[2]
    out = np.empty((8, *x.shape[1:]))
    out[0] = R
    out[1] = lam
    out[2] = h
    out[3] = T_e
    out[4] = L
    out[5] = T_0
    out[6] = c_c
    out[7] = c_h
    return out
