"""Piezoelectric bender: two layers in opposition on one beam: irreversible port-Hamiltonian system.

Source:  Smits, Dalke, Cooney (1991), Sensors and Actuators A 28, 41-61; PiezoDrive BA6020
Model:   bimorph, spec sha256 e1bdc157e28404f3e3f2a5e6ecbc555574e7dfbd87761b8afc1f5ffdda416572
System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
         rows, multiplied out; `piezo-sym show` prints the matrices
Proofs:  skew, casimir, temperature, welldef, energy, entropy, passive, odd, sigma, exergy, environment, units, program PROVED
         (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
         parameters in the domain, and for banks of any size)

Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
Arrays have shape (n, *batch); values are in SI units.

x = (x, p, S, Q_u, Q_l)
u = (F, V_b, V, T_e)
p_ = Parameters(); the underscore tells it from p, a name of the model
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

NAME = "bimorph"
SPEC_SHA256 = "e1bdc157e28404f3e3f2a5e6ecbc555574e7dfbd87761b8afc1f5ffdda416572"


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
    Record("x", "m", "extension of spring 'bending'"),
    Record("p", "kg*m/s", "momentum of mass 'tip'"),
    Record("S", "J/K", "entropy of thermal_mass 'beam'"),
    Record("Q_u", "C", "charge of storage 'layers'"),
    Record("Q_l", "C", "charge of storage 'layers'"),
)
INPUTS = (
    Record("F", "N", "external force on the tip"),
    Record("V_b", "V", "bias: voltage of the upper electrode"),
    Record("V", "V", "voltage of the electrode between the layers; the lower one is at 0"),
    Record("T_e", "K", "temperature of the air"),
)
INPUT_DEFAULTS = (0.0, 150.0, 75.0, 293.15)
# rows of outputs() and supply(): ports, named after the elements that have the inputs
OUTPUTS = (
    Record("load", "m/s", "velocity at force_source 'load'"),
    Record("bias", "A", "current given by voltage_source 'bias'"),
    Record("supply", "A", "current given by voltage_source 'supply'"),
    Record("air", "K", "temperature of thermal_mass 'beam'"),
)
# rows of heat() and entropy_production(): processes, with the unit of the second
PROCESSES = (
    Record("output", "W/K", "resistor 'output'"),
    Record("input", "W/K", "resistor 'input'"),
    Record("losses", "W/K", "damper 'losses'"),
)
# rows of temperatures(), and of elements()
BODIES = (
    Record("beam", "K", "temperature of thermal_mass 'beam'"),
)
ELEMENTS = (
    Record("bias.effort", "V", "voltage of voltage_source 'bias'"),
    Record("bias.flow", "A", "current of voltage_source 'bias'"),
    Record("bias.power", "W", "power into voltage_source 'bias'"),
    Record("supply.effort", "V", "voltage of voltage_source 'supply'"),
    Record("supply.flow", "A", "current of voltage_source 'supply'"),
    Record("supply.power", "W", "power into voltage_source 'supply'"),
    Record("output.effort", "V", "voltage of resistor 'output'"),
    Record("output.flow", "A", "current of resistor 'output'"),
    Record("output.power", "W", "power into resistor 'output'"),
    Record("output.heat", "W", "heat of resistor 'output'"),
    Record("input.effort", "V", "voltage of resistor 'input'"),
    Record("input.flow", "A", "current of resistor 'input'"),
    Record("input.power", "W", "power into resistor 'input'"),
    Record("input.heat", "W", "heat of resistor 'input'"),
    Record("upper.effort_1", "V", "voltage in branch 1 of transducer 'upper'"),
    Record("upper.flow_1", "A", "current in branch 1 of transducer 'upper'"),
    Record("upper.effort_2", "N", "force in branch 2 of transducer 'upper'"),
    Record("upper.flow_2", "m/s", "velocity in branch 2 of transducer 'upper'"),
    Record("upper.power", "W", "power from branch 1 to branch 2 of transducer 'upper'"),
    Record("lower.effort_1", "V", "voltage in branch 1 of transducer 'lower'"),
    Record("lower.flow_1", "A", "current in branch 1 of transducer 'lower'"),
    Record("lower.effort_2", "N", "force in branch 2 of transducer 'lower'"),
    Record("lower.flow_2", "m/s", "velocity in branch 2 of transducer 'lower'"),
    Record("lower.power", "W", "power from branch 1 to branch 2 of transducer 'lower'"),
    Record("bending.effort", "N", "force of spring 'bending'"),
    Record("bending.flow", "m/s", "velocity of spring 'bending'"),
    Record("bending.power", "W", "power into spring 'bending'"),
    Record("bending.energy", "J", "energy of spring 'bending'"),
    Record("tip.effort", "N", "force of mass 'tip'"),
    Record("tip.flow", "m/s", "velocity of mass 'tip'"),
    Record("tip.power", "W", "power into mass 'tip'"),
    Record("tip.energy", "J", "energy of mass 'tip'"),
    Record("losses.effort", "N", "force of damper 'losses'"),
    Record("losses.flow", "m/s", "velocity of damper 'losses'"),
    Record("losses.power", "W", "power into damper 'losses'"),
    Record("losses.heat", "W", "heat of damper 'losses'"),
    Record("load.effort", "N", "force of force_source 'load'"),
    Record("load.flow", "m/s", "velocity of force_source 'load'"),
    Record("load.power", "W", "power into force_source 'load'"),
    Record("beam.effort", "K", "temperature of thermal_mass 'beam'"),
    Record("beam.flow", "W/K", "entropy flow of thermal_mass 'beam'"),
    Record("beam.power", "W", "power into thermal_mass 'beam'"),
    Record("beam.energy", "J", "energy of thermal_mass 'beam'"),
    Record("air.effort", "K", "temperature at ambient 'air'"),
    Record("air.flow", "W/K", "entropy flow at ambient 'air'"),
    Record("air.power", "W", "power into ambient 'air'"),
    Record("layers.effort_Q_u", "V", "voltage of storage 'layers'"),
    Record("layers.flow_Q_u", "A", "current of storage 'layers'"),
    Record("layers.effort_Q_l", "V", "voltage of storage 'layers'"),
    Record("layers.flow_Q_l", "A", "current of storage 'layers'"),
    Record("layers.power", "W", "power into storage 'layers'"),
    Record("layers.energy", "J", "energy of storage 'layers'"),
)
# fields of Parameters; elements of many lanes; conditions under which the proofs hold
PARAMETERS = (
    Record("l", "m", "free length"),
    Record("w", "m", "width"),
    Record("h", "m", "thickness of a layer"),
    Record("s", "m**2/N", "compliance of a layer along the beam"),
    Record("d", "C/N", "piezoelectric coefficient: a layer shortens by d times the field"),
    Record("eps", "F/m", "permittivity of a layer that is free"),
    Record("m", "kg", "mass that moves with the tip"),
    Record("b", "N*s/m", "damping, a quality of about 30"),
    Record("R", "ohm", "resistance of each output of the amplifier"),
    Record("T_0", "K", "temperature at the start"),
    Record("c_0", "J/K", "heat capacity, 5 g of 400 J/(kg K)"),
    Record("lam", "W/K", "heat conductance to the air"),
)
BANKS = ()
DOMAIN = (
    Condition("l > 0", True),
    Condition("w > 0", True),
    Condition("h > 0", True),
    Condition("s > 0", True),
    Condition("13*d**2 < 16*s*eps", True),
    Condition("b >= 0", False),
    Condition("R > 0", True),
    Condition("lam >= 0", False),
    Condition("T_e > 0", True),
    Condition("2*w*h**3/(s*l**3) > 0", True),
    Condition("m > 0", True),
    Condition("T_0 > 0", True),
    Condition("c_0 > 0", True),
)


@dataclass(frozen=True)
class Parameters:
    """Parameters of bimorph in SI units; defaults are the values of the spec."""

    l: float = 0.053
    w: float = 0.02
    h: float = 0.00026
    s: float = 2.053e-11
    d: float = 5.562e-10
    eps: float = 4.056e-08
    m: float = 0.001618
    b: float = 0.02
    R: float = 1000.0
    T_0: float = 293.15
    c_0: float = 2.0
    lam: float = 0.02


def _states(x, p):
    """Return states x, shape (n, *batch), as floats."""
    x = np.asarray(x, dtype=float)
    n = 5
    if x.shape[:1] != (n,):
        raise ValueError(f"x has shape {x.shape}, but there are {n} states")
    return x


def _inputs(u):
    """Return inputs u, shape (4, *batch), as floats."""
    u = np.asarray(u, dtype=float)
    if u.shape[:1] != (4,):
        raise ValueError(f"u has shape {u.shape}, but there are 4 inputs")
    return u


def initial_state(u, p_, /):
    """State at t = 0 [SI], for the inputs u at t = 0; shape (n,)."""
    u = _inputs(u)
    l = p_.l
    w = p_.w
    h = p_.h
    s = p_.s
    d = p_.d
    eps = p_.eps
    F = u[0]
    V_b = u[1]
    V = u[2]
    out = np.zeros(5)
    out[0] = 3*d*l**2*(V_b - 2*V)/(8*h**2) + s*l**3*F/(2*w*h**3)
    out[3] = w*l/h*(eps*(V_b - V) - 13*d**2/(32*s)*(V_b - 2*V))
    out[4] = w*l/h*(eps*V + 13*d**2/(32*s)*(V_b - 2*V))
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
    l = p_.l
    w = p_.w
    h = p_.h
    s = p_.s
    d = p_.d
    eps = p_.eps
    m = p_.m
    b = p_.b
    R = p_.R
    T_0 = p_.T_0
    c_0 = p_.c_0
    lam = p_.lam
    x = x_[0]
    p = x_[1]
    S = x_[2]
    Q_u = x_[3]
    Q_l = x_[4]
    F = u[0]
    V_b = u[1]
    V = u[2]
    T_e = u[3]
    # co-states dU/dx
    F_bending = 2*w*h**3/(s*l**3)*x
    v_tip = p/m
    T = T_0*np.exp(S/c_0)
    V_Q_u = h/(4*w*l)*(2*(Q_u + Q_l)/eps + 2*(Q_u - Q_l)/(eps - 13*d**2/(16*s)))
    V_Q_l = h/(4*w*l)*(2*(Q_u + Q_l)/eps - 2*(Q_u - Q_l)/(eps - 13*d**2/(16*s)))
    # transducer ratios
    alpha_upper = 3*w*h*d/(4*s*l)
    alpha_lower = 3*w*h*d/(4*s*l)
    # driving forces
    V_output = -V_Q_u - V_Q_l + V_b
    # dissipative laws
    i_output = V_output/R
    # driving forces
    V_input = -V_Q_l + V
    # dissipative laws
    i_input = V_input/R
    F_losses = b*v_tip
    # heats
    heat_output = i_output*V_output
    heat_input = i_input*V_input
    heat_losses = F_losses*v_tip
    # result
    out[0] = v_tip
    out[1] = alpha_upper*V_Q_u - F_bending - alpha_lower*V_Q_l - F_losses + F
    out[2] = (heat_output + heat_input + heat_losses)/T + lam*(T_e/T - 1)
    out[3] = i_output - alpha_upper*v_tip
    out[4] = alpha_lower*v_tip + i_output + i_input


def outputs(x_, u, p_, /):
    """Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient; shape (4, *batch)."""
    x_ = _states(x_, p_)
    u = _inputs(u)
    l = p_.l
    w = p_.w
    h = p_.h
    s = p_.s
    d = p_.d
    eps = p_.eps
    m = p_.m
    R = p_.R
    T_0 = p_.T_0
    c_0 = p_.c_0
    p = x_[1]
    S = x_[2]
    Q_u = x_[3]
    Q_l = x_[4]
    V_b = u[1]
    V = u[2]
    # co-states dU/dx
    v_tip = p/m
    T = T_0*np.exp(S/c_0)
    V_Q_u = h/(4*w*l)*(2*(Q_u + Q_l)/eps + 2*(Q_u - Q_l)/(eps - 13*d**2/(16*s)))
    V_Q_l = h/(4*w*l)*(2*(Q_u + Q_l)/eps - 2*(Q_u - Q_l)/(eps - 13*d**2/(16*s)))
    # driving forces
    V_output = -V_Q_u - V_Q_l + V_b
    # dissipative laws
    i_output = V_output/R
    # driving forces
    V_input = -V_Q_l + V
    # dissipative laws
    i_input = V_input/R
    # result
    out = np.empty((4, *x_.shape[1:]))
    out[0] = v_tip
    out[1] = i_output
    out[2] = i_input
    out[3] = T
    return out


def supply(x_, u, p_, /):
    """Power supplied through each port [W]; the sum is dU/dt; shape (4, *batch)."""
    x_ = _states(x_, p_)
    u = _inputs(u)
    l = p_.l
    w = p_.w
    h = p_.h
    s = p_.s
    d = p_.d
    eps = p_.eps
    m = p_.m
    R = p_.R
    T_0 = p_.T_0
    c_0 = p_.c_0
    lam = p_.lam
    p = x_[1]
    S = x_[2]
    Q_u = x_[3]
    Q_l = x_[4]
    F = u[0]
    V_b = u[1]
    V = u[2]
    T_e = u[3]
    # co-states dU/dx
    v_tip = p/m
    T = T_0*np.exp(S/c_0)
    V_Q_u = h/(4*w*l)*(2*(Q_u + Q_l)/eps + 2*(Q_u - Q_l)/(eps - 13*d**2/(16*s)))
    V_Q_l = h/(4*w*l)*(2*(Q_u + Q_l)/eps - 2*(Q_u - Q_l)/(eps - 13*d**2/(16*s)))
    # driving forces
    V_output = -V_Q_u - V_Q_l + V_b
    # dissipative laws
    i_output = V_output/R
    # driving forces
    V_input = -V_Q_l + V
    # dissipative laws
    i_input = V_input/R
    # result
    out = np.empty((4, *x_.shape[1:]))
    out[0] = v_tip*F
    out[1] = i_output*V_b
    out[2] = i_input*V
    out[3] = lam*(T_e - T)
    return out


def energy(x_, p_, /):
    """Hamiltonian U [J]; shape (*batch)."""
    x_ = _states(x_, p_)
    l = p_.l
    w = p_.w
    h = p_.h
    s = p_.s
    d = p_.d
    eps = p_.eps
    m = p_.m
    T_0 = p_.T_0
    c_0 = p_.c_0
    x = x_[0]
    p = x_[1]
    S = x_[2]
    Q_u = x_[3]
    Q_l = x_[4]
    return 2*w*h**3/(s*l**3)*x**2/2 + p**2/(2*m) + T_0*c_0*np.exp(S/c_0) + h/(4*w*l)*((Q_u + Q_l)**2/eps + (Q_u - Q_l)**2/(eps - 13*d**2/(16*s)))


def entropy(x_, p_, /):
    """Total entropy S [J/K]; shape (*batch)."""
    x_ = _states(x_, p_)
    S = x_[2]
    return S.copy()


def temperatures(x_, p_, /):
    """Temperature of each body [K]; shape (1, *batch)."""
    x_ = _states(x_, p_)
    T_0 = p_.T_0
    c_0 = p_.c_0
    S = x_[2]
    # co-states dU/dx
    T = T_0*np.exp(S/c_0)
    # result
    out = np.empty((1, *x_.shape[1:]))
    out[0] = T
    return out


def heat(x_, u, p_, /):
    """Power that each process turns into heat [W]; of a bank, one row per lane; shape (3, *batch)."""
    x_ = _states(x_, p_)
    u = _inputs(u)
    l = p_.l
    w = p_.w
    h = p_.h
    s = p_.s
    d = p_.d
    eps = p_.eps
    m = p_.m
    b = p_.b
    R = p_.R
    p = x_[1]
    Q_u = x_[3]
    Q_l = x_[4]
    V_b = u[1]
    V = u[2]
    # co-states dU/dx
    v_tip = p/m
    V_Q_u = h/(4*w*l)*(2*(Q_u + Q_l)/eps + 2*(Q_u - Q_l)/(eps - 13*d**2/(16*s)))
    V_Q_l = h/(4*w*l)*(2*(Q_u + Q_l)/eps - 2*(Q_u - Q_l)/(eps - 13*d**2/(16*s)))
    # driving forces
    V_output = -V_Q_u - V_Q_l + V_b
    # dissipative laws
    i_output = V_output/R
    # driving forces
    V_input = -V_Q_l + V
    # dissipative laws
    i_input = V_input/R
    F_losses = b*v_tip
    # result
    out = np.empty((3, *x_.shape[1:]))
    out[0] = i_output*V_output
    out[1] = i_input*V_input
    out[2] = F_losses*v_tip
    return out


def entropy_production(x_, u, p_, /):
    """Entropy production of each process [W/K], heat exchange with ambients not included; of a bank, one row per lane; shape (3, *batch)."""
    x_ = _states(x_, p_)
    u = _inputs(u)
    l = p_.l
    w = p_.w
    h = p_.h
    s = p_.s
    d = p_.d
    eps = p_.eps
    m = p_.m
    b = p_.b
    R = p_.R
    T_0 = p_.T_0
    c_0 = p_.c_0
    p = x_[1]
    S = x_[2]
    Q_u = x_[3]
    Q_l = x_[4]
    V_b = u[1]
    V = u[2]
    # co-states dU/dx
    v_tip = p/m
    T = T_0*np.exp(S/c_0)
    V_Q_u = h/(4*w*l)*(2*(Q_u + Q_l)/eps + 2*(Q_u - Q_l)/(eps - 13*d**2/(16*s)))
    V_Q_l = h/(4*w*l)*(2*(Q_u + Q_l)/eps - 2*(Q_u - Q_l)/(eps - 13*d**2/(16*s)))
    # driving forces
    V_output = -V_Q_u - V_Q_l + V_b
    # dissipative laws
    i_output = V_output/R
    # driving forces
    V_input = -V_Q_l + V
    # dissipative laws
    i_input = V_input/R
    F_losses = b*v_tip
    # result
    out = np.empty((3, *x_.shape[1:]))
    out[0] = i_output*V_output/T
    out[1] = i_input*V_input/T
    out[2] = F_losses*v_tip/T
    return out


def elements(x_, u, p_, /):
    """Effort, flow, power, energy and heat of elements; of a bank, one row per lane; shape (52, *batch)."""
    x_ = _states(x_, p_)
    u = _inputs(u)
    l = p_.l
    w = p_.w
    h = p_.h
    s = p_.s
    d = p_.d
    eps = p_.eps
    m = p_.m
    b = p_.b
    R = p_.R
    T_0 = p_.T_0
    c_0 = p_.c_0
    lam = p_.lam
    x = x_[0]
    p = x_[1]
    S = x_[2]
    Q_u = x_[3]
    Q_l = x_[4]
    F = u[0]
    V_b = u[1]
    V = u[2]
    T_e = u[3]
    # co-states dU/dx
    F_bending = 2*w*h**3/(s*l**3)*x
    v_tip = p/m
    T = T_0*np.exp(S/c_0)
    V_Q_u = h/(4*w*l)*(2*(Q_u + Q_l)/eps + 2*(Q_u - Q_l)/(eps - 13*d**2/(16*s)))
    V_Q_l = h/(4*w*l)*(2*(Q_u + Q_l)/eps - 2*(Q_u - Q_l)/(eps - 13*d**2/(16*s)))
    # transducer ratios
    alpha_upper = 3*w*h*d/(4*s*l)
    alpha_lower = 3*w*h*d/(4*s*l)
    # driving forces
    V_output = -V_Q_u - V_Q_l + V_b
    # dissipative laws
    i_output = V_output/R
    # driving forces
    V_input = -V_Q_l + V
    # dissipative laws
    i_input = V_input/R
    F_losses = b*v_tip
    # heats
    heat_output = i_output*V_output
    heat_input = i_input*V_input
    heat_losses = F_losses*v_tip
    # rates
    rate_p = alpha_upper*V_Q_u - F_bending - alpha_lower*V_Q_l - F_losses + F
    rate_S = (heat_output + heat_input + heat_losses)/T + lam*(T_e/T - 1)
    rate_Q_u = i_output - alpha_upper*v_tip
    rate_Q_l = alpha_lower*v_tip + i_output + i_input
    # result
    out = np.empty((52, *x_.shape[1:]))
    out[0] = V_b
    out[1] = -i_output
    out[2] = -i_output*V_b
    out[3] = V
    out[4] = -i_input
    out[5] = -i_input*V
    out[6] = V_output
    out[7] = i_output
    out[8] = i_output*V_output
    out[9] = i_output*V_output
    out[10] = V_input
    out[11] = i_input
    out[12] = i_input*V_input
    out[13] = i_input*V_input
    out[14] = V_Q_u
    out[15] = alpha_upper*v_tip
    out[16] = -alpha_upper*V_Q_u
    out[17] = v_tip
    out[18] = V_Q_u*alpha_upper*v_tip
    out[19] = V_Q_l
    out[20] = -alpha_lower*v_tip
    out[21] = -alpha_lower*V_Q_l
    out[22] = -v_tip
    out[23] = -V_Q_l*alpha_lower*v_tip
    out[24] = F_bending
    out[25] = v_tip
    out[26] = F_bending*v_tip
    out[27] = 2*w*h**3/(s*l**3)*x**2/2
    out[28] = rate_p
    out[29] = v_tip
    out[30] = rate_p*v_tip
    out[31] = p**2/(2*m)
    out[32] = F_losses
    out[33] = v_tip
    out[34] = F_losses*v_tip
    out[35] = F_losses*v_tip
    out[36] = -F
    out[37] = v_tip
    out[38] = -v_tip*F
    out[39] = T
    out[40] = rate_S
    out[41] = T*rate_S
    out[42] = T_0*c_0*np.exp(S/c_0)
    out[43] = T
    out[44] = -lam*(T_e/T - 1)
    out[45] = -lam*(T_e - T)
    out[46] = V_Q_u
    out[47] = rate_Q_u
    out[48] = V_Q_l
    out[49] = rate_Q_l
    out[50] = V_Q_u*rate_Q_u + V_Q_l*rate_Q_l
    out[51] = h/(4*w*l)*((Q_u + Q_l)**2/eps + (Q_u - Q_l)**2/(eps - 13*d**2/(16*s)))
    return out


def jacobian(x_, u, p_, /):
    """Jacobian of rhs, d rhs[i]/d x[j] at [i, j]; shape (n, n, *batch)."""
    x_ = _states(x_, p_)
    u = _inputs(u)
    l = p_.l
    w = p_.w
    h = p_.h
    s = p_.s
    d = p_.d
    eps = p_.eps
    m = p_.m
    b = p_.b
    R = p_.R
    T_0 = p_.T_0
    c_0 = p_.c_0
    lam = p_.lam
    p = x_[1]
    S = x_[2]
    Q_u = x_[3]
    Q_l = x_[4]
    V_b = u[1]
    V = u[2]
    T_e = u[3]
    # co-states dU/dx
    v_tip = p/m
    T = T_0*np.exp(S/c_0)
    V_Q_u = h/(4*w*l)*(2*(Q_u + Q_l)/eps + 2*(Q_u - Q_l)/(eps - 13*d**2/(16*s)))
    V_Q_l = h/(4*w*l)*(2*(Q_u + Q_l)/eps - 2*(Q_u - Q_l)/(eps - 13*d**2/(16*s)))
    # transducer ratios
    alpha_upper = 3*w*h*d/(4*s*l)
    alpha_lower = 3*w*h*d/(4*s*l)
    # driving forces
    V_output = -V_Q_u - V_Q_l + V_b
    # dissipative laws
    i_output = V_output/R
    # driving forces
    V_input = -V_Q_l + V
    # dissipative laws
    i_input = V_input/R
    F_losses = b*v_tip
    # heats
    heat_output = i_output*V_output
    heat_input = i_input*V_input
    heat_losses = F_losses*v_tip
    # derivatives
    dF_bending_dx = 2*w*h**3/(s*l**3)
    dF_losses_dp = b/m
    dheat_losses_dp = v_tip*dF_losses_dp + F_losses/m
    dT_dS = T/c_0
    dV_Q_u_dQ_u = h/(4*w*l)*(2/eps + 2/(eps - 13*d**2/(16*s)))
    dV_Q_l_dQ_u = h/(4*w*l)*(2/eps - 2/(eps - 13*d**2/(16*s)))
    dV_output_dQ_u = -dV_Q_u_dQ_u - dV_Q_l_dQ_u
    di_output_dQ_u = dV_output_dQ_u/R
    di_input_dQ_u = -dV_Q_l_dQ_u/R
    dheat_output_dQ_u = V_output*di_output_dQ_u + i_output*dV_output_dQ_u
    dheat_input_dQ_u = V_input*di_input_dQ_u - i_input*dV_Q_l_dQ_u
    dV_Q_u_dQ_l = h/(4*w*l)*(2/eps + (-2)/(eps - 13*d**2/(16*s)))
    dV_Q_l_dQ_l = h/(4*w*l)*(2/eps - (-2)/(eps - 13*d**2/(16*s)))
    dV_output_dQ_l = -dV_Q_u_dQ_l - dV_Q_l_dQ_l
    di_output_dQ_l = dV_output_dQ_l/R
    di_input_dQ_l = -dV_Q_l_dQ_l/R
    dheat_output_dQ_l = V_output*di_output_dQ_l + i_output*dV_output_dQ_l
    dheat_input_dQ_l = V_input*di_input_dQ_l - i_input*dV_Q_l_dQ_l
    # result
    out = np.zeros((x_.shape[0], *x_.shape))
    out[0, 1] = 1/m
    out[1, 0] = -dF_bending_dx
    out[1, 1] = -dF_losses_dp
    out[1, 3] = alpha_upper*dV_Q_u_dQ_u - alpha_lower*dV_Q_l_dQ_u
    out[1, 4] = alpha_upper*dV_Q_u_dQ_l - alpha_lower*dV_Q_l_dQ_l
    out[2, 1] = dheat_losses_dp/T
    out[2, 2] = (-(heat_output + heat_input + heat_losses)/T**2 - lam*T_e/T**2)*dT_dS
    out[2, 3] = dheat_output_dQ_u/T + dheat_input_dQ_u/T
    out[2, 4] = dheat_output_dQ_l/T + dheat_input_dQ_l/T
    out[3, 1] = -alpha_upper/m
    out[3, 3] = di_output_dQ_u
    out[3, 4] = di_output_dQ_l
    out[4, 1] = alpha_lower/m
    out[4, 3] = di_output_dQ_u + di_input_dQ_u
    out[4, 4] = di_output_dQ_l + di_input_dQ_l
    return out


def margins(x_, u, p_, /):
    """Margin by which each condition of DOMAIN holds; of a bank, the least one; shape (len(DOMAIN), *batch)."""
    x_ = _states(x_, p_)
    u = _inputs(u)
    l = p_.l
    w = p_.w
    h = p_.h
    s = p_.s
    d = p_.d
    eps = p_.eps
    m = p_.m
    b = p_.b
    R = p_.R
    T_0 = p_.T_0
    c_0 = p_.c_0
    lam = p_.lam
    T_e = u[3]
    out = np.empty((13, *x_.shape[1:]))
    out[0] = l
    out[1] = w
    out[2] = h
    out[3] = s
    out[4] = 16*s*eps - 13*d**2
    out[5] = b
    out[6] = R
    out[7] = lam
    out[8] = T_e
    out[9] = 2*w*h**3/(s*l**3)
    out[10] = m
    out[11] = T_0
    out[12] = c_0
    return out
