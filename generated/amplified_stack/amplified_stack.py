"""Piezoelectric stack with a lever, a load and an end stop: irreversible port-Hamiltonian system.

Source:  Scire, Teague (1978), Rev. Sci. Instrum. 49 (12), 1735-1740 (levers); Hunt, Crossley (1975), J. Appl. Mech. 42 (2), 440-445 (end stop); PiezoDrive SA050536
Model:   amplified_stack, spec sha256 f97db543e4f43ea0e60de47bf6de8bd925540145e93c475ce6262cae7eb13898
System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
         rows, multiplied out; `piezo-sym show` prints the matrices
Proofs:  skew, casimir, temperature, welldef, energy, entropy, passive, odd, continuous, sigma, exergy, environment, units, program PROVED
         (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
         parameters in the domain, and for banks of any size)

Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
Arrays have shape (n, *batch); values are in SI units.

x = (Q, q, p, x, x_e, S)
u = (F, V, T_e)
p_ = Parameters(); the underscore tells it from p, a name of the model
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

NAME = "amplified_stack"
SPEC_SHA256 = "f97db543e4f43ea0e60de47bf6de8bd925540145e93c475ce6262cae7eb13898"


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
    Record("q", "m", "extension of spring 'stack'"),
    Record("p", "kg*m/s", "momentum of mass 'load', joined with 'end'"),
    Record("x", "m", "extension of spring 'spring'"),
    Record("x_e", "m", "extension of spring 'end_stop'"),
    Record("S", "J/K", "entropy of thermal_mass 'body'"),
)
INPUTS = (
    Record("F", "N", "external force on the load"),
    Record("V", "V", "voltage of the amplifier"),
    Record("T_e", "K", "temperature of the air"),
)
INPUT_DEFAULTS = (0.0, 0.0, 293.15)
# rows of outputs() and supply(): ports, named after the elements that have the inputs
OUTPUTS = (
    Record("push", "m/s", "velocity at force_source 'push'"),
    Record("amplifier", "A", "current given by voltage_source 'amplifier'"),
    Record("air", "K", "temperature of thermal_mass 'body'"),
)
# rows of heat() and entropy_production(): processes, with the unit of the second
PROCESSES = (
    Record("leads", "W/K", "resistor 'leads'"),
    Record("losses", "W/K", "damper 'losses'"),
    Record("bumper", "W/K", "damper 'bumper'"),
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
    Record("stack.effort", "N", "force of spring 'stack'"),
    Record("stack.flow", "m/s", "velocity of spring 'stack'"),
    Record("stack.power", "W", "power into spring 'stack'"),
    Record("stack.energy", "J", "energy of spring 'stack'"),
    Record("load.effort", "N", "force of mass 'load'"),
    Record("load.flow", "m/s", "velocity of mass 'load'"),
    Record("load.power", "W", "power into mass 'load'"),
    Record("load.energy", "J", "energy of mass 'load'"),
    Record("end.effort", "N", "force of mass 'end'"),
    Record("end.flow", "m/s", "velocity of mass 'end'"),
    Record("end.power", "W", "power into mass 'end'"),
    Record("end.energy", "J", "energy of mass 'end'"),
    Record("lever.effort_1", "N", "force in branch 1 of lever 'lever'"),
    Record("lever.flow_1", "m/s", "velocity in branch 1 of lever 'lever'"),
    Record("lever.effort_2", "N", "force in branch 2 of lever 'lever'"),
    Record("lever.flow_2", "m/s", "velocity in branch 2 of lever 'lever'"),
    Record("lever.power", "W", "power from branch 1 to branch 2 of lever 'lever'"),
    Record("spring.effort", "N", "force of spring 'spring'"),
    Record("spring.flow", "m/s", "velocity of spring 'spring'"),
    Record("spring.power", "W", "power into spring 'spring'"),
    Record("spring.energy", "J", "energy of spring 'spring'"),
    Record("losses.effort", "N", "force of damper 'losses'"),
    Record("losses.flow", "m/s", "velocity of damper 'losses'"),
    Record("losses.power", "W", "power into damper 'losses'"),
    Record("losses.heat", "W", "heat of damper 'losses'"),
    Record("end_stop.effort", "N", "force of spring 'end_stop'"),
    Record("end_stop.flow", "m/s", "velocity of spring 'end_stop'"),
    Record("end_stop.power", "W", "power into spring 'end_stop'"),
    Record("end_stop.energy", "J", "energy of spring 'end_stop'"),
    Record("bumper.effort", "N", "force of damper 'bumper'"),
    Record("bumper.flow", "m/s", "velocity of damper 'bumper'"),
    Record("bumper.power", "W", "power into damper 'bumper'"),
    Record("bumper.heat", "W", "heat of damper 'bumper'"),
    Record("push.effort", "N", "force of force_source 'push'"),
    Record("push.flow", "m/s", "velocity of force_source 'push'"),
    Record("push.power", "W", "power into force_source 'push'"),
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
    Record("k", "N/m", "stiffness of the stack"),
    Record("m_s", "kg", "moving mass of the stack, 4/pi^2 of it"),
    Record("a", "C/m", "transducer ratio, 28 N/um times 56 um over 180 V"),
    Record("C", "F", "capacitance of the clamped stack: 4.3 uF less a^2/k"),
    Record("R", "ohm", "resistance of the amplifier and leads"),
    Record("n", "1", "lever: way of the load over that of the stack"),
    Record("m", "kg", "mass of the load"),
    Record("k_l", "N/m", "stiffness against which it moves, that of the flexures included"),
    Record("d", "N*s/m", "damping, a quality of about 30"),
    Record("g", "m", "way to the end stop"),
    Record("k_e", "N/m", "stiffness of the end stop"),
    Record("d_e", "N*s/m**2", "damping of the end stop over its indentation"),
    Record("T_0", "K", "temperature at the start"),
    Record("c_0", "J/K", "heat capacity, 7.1 g of 370 J/(kg K)"),
    Record("lam", "W/K", "heat conductance to the air"),
)
BANKS = ()
DOMAIN = (
    Condition("n > 0", True),
    Condition("R > 0", True),
    Condition("d >= 0", False),
    Condition("k_e >= 0", False),
    Condition("d_e >= 0", False),
    Condition("lam >= 0", False),
    Condition("T_e > 0", True),
    Condition("C > 0", True),
    Condition("k > 0", True),
    Condition("m > 0", True),
    Condition("m_s > 0", True),
    Condition("k_l > 0", True),
    Condition("T_0 > 0", True),
    Condition("c_0 > 0", True),
)


@dataclass(frozen=True)
class Parameters:
    """Parameters of amplified_stack in SI units; defaults are the values of the spec."""

    k: float = 28000000.0
    m_s: float = 0.0029
    a: float = 8.7
    C: float = 1.6e-06
    R: float = 10.0
    n: float = 8.0
    m: float = 0.02
    k_l: float = 100000.0
    d: float = 3.5
    g: float = 0.00025
    k_e: float = 10000000.0
    d_e: float = 5000000.0
    T_0: float = 293.15
    c_0: float = 2.6
    lam: float = 0.02


def _states(x, p):
    """Return states x, shape (n, *batch), as floats."""
    x = np.asarray(x, dtype=float)
    n = 6
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
    out = np.zeros(6)
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
    k = p_.k
    m_s = p_.m_s
    a = p_.a
    C = p_.C
    R = p_.R
    n = p_.n
    m = p_.m
    k_l = p_.k_l
    d = p_.d
    g = p_.g
    k_e = p_.k_e
    d_e = p_.d_e
    T_0 = p_.T_0
    c_0 = p_.c_0
    lam = p_.lam
    Q = x_[0]
    q = x_[1]
    p = x_[2]
    x = x_[3]
    x_e = x_[4]
    S = x_[5]
    F = u[0]
    V = u[1]
    T_e = u[2]
    # co-states dU/dx
    V_clamped = Q/C
    F_stack = k*q
    v_load = p/(m + m_s/n**2)
    F_spring = k_l*x
    F_end_stop = k_e*np.maximum(x_e - g, 0)
    T = T_0*np.exp(S/c_0)
    # transducer ratios
    alpha_ceramic = a
    n_lever = n
    # driving forces
    V_leads = -V_clamped + V
    # dissipative laws
    i_leads = V_leads/R
    F_losses = d*v_load
    F_bumper = d_e*np.maximum(x_e - g, 0)*v_load
    # heats
    heat_leads = i_leads*V_leads
    heat_losses = F_losses*v_load
    heat_bumper = F_bumper*v_load
    # result
    out[0] = i_leads - alpha_ceramic/n_lever*v_load
    out[1] = v_load/n_lever
    out[2] = (
        alpha_ceramic/n_lever*V_clamped
        - F_stack/n_lever
        - F_spring
        - F_end_stop
        - F_losses
        - F_bumper
        + F
    )
    out[3] = v_load
    out[4] = v_load
    out[5] = (heat_leads + heat_losses + heat_bumper)/T + lam*(T_e/T - 1)


def outputs(x_, u, p_, /):
    """Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient; shape (3, *batch)."""
    x_ = _states(x_, p_)
    u = _inputs(u)
    m_s = p_.m_s
    C = p_.C
    R = p_.R
    n = p_.n
    m = p_.m
    T_0 = p_.T_0
    c_0 = p_.c_0
    Q = x_[0]
    p = x_[2]
    S = x_[5]
    V = u[1]
    # co-states dU/dx
    V_clamped = Q/C
    v_load = p/(m + m_s/n**2)
    T = T_0*np.exp(S/c_0)
    # driving forces
    V_leads = -V_clamped + V
    # dissipative laws
    i_leads = V_leads/R
    # result
    out = np.empty((3, *x_.shape[1:]))
    out[0] = v_load
    out[1] = i_leads
    out[2] = T
    return out


def supply(x_, u, p_, /):
    """Power supplied through each port [W]; the sum is dU/dt; shape (3, *batch)."""
    x_ = _states(x_, p_)
    u = _inputs(u)
    m_s = p_.m_s
    C = p_.C
    R = p_.R
    n = p_.n
    m = p_.m
    T_0 = p_.T_0
    c_0 = p_.c_0
    lam = p_.lam
    Q = x_[0]
    p = x_[2]
    S = x_[5]
    F = u[0]
    V = u[1]
    T_e = u[2]
    # co-states dU/dx
    V_clamped = Q/C
    v_load = p/(m + m_s/n**2)
    T = T_0*np.exp(S/c_0)
    # driving forces
    V_leads = -V_clamped + V
    # dissipative laws
    i_leads = V_leads/R
    # result
    out = np.empty((3, *x_.shape[1:]))
    out[0] = v_load*F
    out[1] = i_leads*V
    out[2] = lam*(T_e - T)
    return out


def energy(x_, p_, /):
    """Hamiltonian U [J]; shape (*batch)."""
    x_ = _states(x_, p_)
    k = p_.k
    m_s = p_.m_s
    C = p_.C
    n = p_.n
    m = p_.m
    k_l = p_.k_l
    g = p_.g
    k_e = p_.k_e
    T_0 = p_.T_0
    c_0 = p_.c_0
    Q = x_[0]
    q = x_[1]
    p = x_[2]
    x = x_[3]
    x_e = x_[4]
    S = x_[5]
    return Q**2/(2*C) + k*q**2/2 + p**2/(2*(m + m_s/n**2)) + k_l*x**2/2 + 0.5*(k_e*np.maximum(x_e - g, 0)**2) + T_0*c_0*np.exp(S/c_0)


def entropy(x_, p_, /):
    """Total entropy S [J/K]; shape (*batch)."""
    x_ = _states(x_, p_)
    S = x_[5]
    return S.copy()


def temperatures(x_, p_, /):
    """Temperature of each body [K]; shape (1, *batch)."""
    x_ = _states(x_, p_)
    T_0 = p_.T_0
    c_0 = p_.c_0
    S = x_[5]
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
    m_s = p_.m_s
    C = p_.C
    R = p_.R
    n = p_.n
    m = p_.m
    d = p_.d
    g = p_.g
    d_e = p_.d_e
    Q = x_[0]
    p = x_[2]
    x_e = x_[4]
    V = u[1]
    # co-states dU/dx
    V_clamped = Q/C
    v_load = p/(m + m_s/n**2)
    # driving forces
    V_leads = -V_clamped + V
    # dissipative laws
    i_leads = V_leads/R
    F_losses = d*v_load
    F_bumper = d_e*np.maximum(x_e - g, 0)*v_load
    # result
    out = np.empty((3, *x_.shape[1:]))
    out[0] = i_leads*V_leads
    out[1] = F_losses*v_load
    out[2] = F_bumper*v_load
    return out


def entropy_production(x_, u, p_, /):
    """Entropy production of each process [W/K], heat exchange with ambients not included; of a bank, one row per lane; shape (3, *batch)."""
    x_ = _states(x_, p_)
    u = _inputs(u)
    m_s = p_.m_s
    C = p_.C
    R = p_.R
    n = p_.n
    m = p_.m
    d = p_.d
    g = p_.g
    d_e = p_.d_e
    T_0 = p_.T_0
    c_0 = p_.c_0
    Q = x_[0]
    p = x_[2]
    x_e = x_[4]
    S = x_[5]
    V = u[1]
    # co-states dU/dx
    V_clamped = Q/C
    v_load = p/(m + m_s/n**2)
    T = T_0*np.exp(S/c_0)
    # driving forces
    V_leads = -V_clamped + V
    # dissipative laws
    i_leads = V_leads/R
    F_losses = d*v_load
    F_bumper = d_e*np.maximum(x_e - g, 0)*v_load
    # result
    out = np.empty((3, *x_.shape[1:]))
    out[0] = i_leads*V_leads/T
    out[1] = F_losses*v_load/T
    out[2] = F_bumper*v_load/T
    return out


def elements(x_, u, p_, /):
    """Effort, flow, power, energy and heat of elements; of a bank, one row per lane; shape (59, *batch)."""
    x_ = _states(x_, p_)
    u = _inputs(u)
    k = p_.k
    m_s = p_.m_s
    a = p_.a
    C = p_.C
    R = p_.R
    n = p_.n
    m = p_.m
    k_l = p_.k_l
    d = p_.d
    g = p_.g
    k_e = p_.k_e
    d_e = p_.d_e
    T_0 = p_.T_0
    c_0 = p_.c_0
    lam = p_.lam
    Q = x_[0]
    q = x_[1]
    p = x_[2]
    x = x_[3]
    x_e = x_[4]
    S = x_[5]
    F = u[0]
    V = u[1]
    T_e = u[2]
    # co-states dU/dx
    V_clamped = Q/C
    F_stack = k*q
    v_load = p/(m + m_s/n**2)
    F_spring = k_l*x
    F_end_stop = k_e*np.maximum(x_e - g, 0)
    T = T_0*np.exp(S/c_0)
    # transducer ratios
    alpha_ceramic = a
    n_lever = n
    # driving forces
    V_leads = -V_clamped + V
    # dissipative laws
    i_leads = V_leads/R
    F_losses = d*v_load
    F_bumper = d_e*np.maximum(x_e - g, 0)*v_load
    # heats
    heat_leads = i_leads*V_leads
    heat_losses = F_losses*v_load
    heat_bumper = F_bumper*v_load
    # rates
    rate_Q = i_leads - alpha_ceramic/n_lever*v_load
    rate_q = v_load/n_lever
    rate_p = (
        alpha_ceramic/n_lever*V_clamped
        - F_stack/n_lever
        - F_spring
        - F_end_stop
        - F_losses
        - F_bumper
        + F
    )
    rate_S = (heat_leads + heat_losses + heat_bumper)/T + lam*(T_e/T - 1)
    # result
    out = np.empty((59, *x_.shape[1:]))
    out[0] = V
    out[1] = -i_leads
    out[2] = -i_leads*V
    out[3] = V_leads
    out[4] = i_leads
    out[5] = i_leads*V_leads
    out[6] = i_leads*V_leads
    out[7] = V_clamped
    out[8] = rate_Q
    out[9] = V_clamped*rate_Q
    out[10] = Q**2/(2*C)
    out[11] = V_clamped
    out[12] = alpha_ceramic*v_load/n_lever
    out[13] = -alpha_ceramic*V_clamped
    out[14] = v_load/n_lever
    out[15] = V_clamped*alpha_ceramic*v_load/n_lever
    out[16] = F_stack
    out[17] = rate_q
    out[18] = F_stack*rate_q
    out[19] = k*q**2/2
    out[20] = m/(m + m_s/n**2)*rate_p
    out[21] = v_load
    out[22] = m/(m + m_s/n**2)*rate_p*v_load
    out[23] = 0.5*(m*v_load**2)
    out[24] = m_s/n/(m + m_s/n**2)*rate_p
    out[25] = v_load/n
    out[26] = m_s/n/(m + m_s/n**2)*rate_p*v_load/n
    out[27] = 0.5*(m_s*(v_load/n)**2)
    out[28] = (
        -alpha_ceramic/n_lever*V_clamped
        + F_stack/n_lever
        + m_s/n/(m + m_s/n**2)*rate_p/n_lever
    )
    out[29] = n_lever*v_load/n_lever
    out[30] = -n_lever*(-alpha_ceramic/n_lever*V_clamped + F_stack/n_lever + m_s/n/(m + m_s/n**2)*rate_p/n_lever)
    out[31] = v_load/n_lever
    out[32] = n_lever*v_load/n_lever*(-alpha_ceramic/n_lever*V_clamped + F_stack/n_lever + m_s/n/(m + m_s/n**2)*rate_p/n_lever)
    out[33] = F_spring
    out[34] = v_load
    out[35] = F_spring*v_load
    out[36] = k_l*x**2/2
    out[37] = F_losses
    out[38] = v_load
    out[39] = F_losses*v_load
    out[40] = F_losses*v_load
    out[41] = F_end_stop
    out[42] = v_load
    out[43] = F_end_stop*v_load
    out[44] = 0.5*(k_e*np.maximum(x_e - g, 0)**2)
    out[45] = F_bumper
    out[46] = v_load
    out[47] = F_bumper*v_load
    out[48] = F_bumper*v_load
    out[49] = -F
    out[50] = v_load
    out[51] = -v_load*F
    out[52] = T
    out[53] = rate_S
    out[54] = T*rate_S
    out[55] = T_0*c_0*np.exp(S/c_0)
    out[56] = T
    out[57] = -lam*(T_e/T - 1)
    out[58] = -lam*(T_e - T)
    return out


def jacobian(x_, u, p_, /):
    """Jacobian of rhs, d rhs[i]/d x[j] at [i, j]; shape (n, n, *batch)."""
    x_ = _states(x_, p_)
    u = _inputs(u)
    k = p_.k
    m_s = p_.m_s
    a = p_.a
    C = p_.C
    R = p_.R
    n = p_.n
    m = p_.m
    k_l = p_.k_l
    d = p_.d
    g = p_.g
    k_e = p_.k_e
    d_e = p_.d_e
    T_0 = p_.T_0
    c_0 = p_.c_0
    lam = p_.lam
    Q = x_[0]
    p = x_[2]
    x_e = x_[4]
    S = x_[5]
    V = u[1]
    T_e = u[2]
    # co-states dU/dx
    V_clamped = Q/C
    v_load = p/(m + m_s/n**2)
    T = T_0*np.exp(S/c_0)
    # transducer ratios
    alpha_ceramic = a
    n_lever = n
    # driving forces
    V_leads = -V_clamped + V
    # dissipative laws
    i_leads = V_leads/R
    F_losses = d*v_load
    F_bumper = d_e*np.maximum(x_e - g, 0)*v_load
    # heats
    heat_leads = i_leads*V_leads
    heat_losses = F_losses*v_load
    heat_bumper = F_bumper*v_load
    # derivatives
    di_leads_dQ = -1/R/C
    dheat_leads_dQ = V_leads*di_leads_dQ - i_leads/C
    dv_load_dp = 1/(m + m_s/n**2)
    dF_losses_dp = d*dv_load_dp
    dF_bumper_dp = d_e*np.maximum(x_e - g, 0)*dv_load_dp
    dheat_losses_dp = v_load*dF_losses_dp + F_losses*dv_load_dp
    dheat_bumper_dp = v_load*dF_bumper_dp + F_bumper*dv_load_dp
    dF_end_stop_dx_e = np.where(x_e - g >= 0, k_e, 0)
    dF_bumper_dx_e = np.where(x_e - g >= 0, d_e, 0)*v_load
    dheat_bumper_dx_e = v_load*dF_bumper_dx_e
    dT_dS = T/c_0
    # result
    out = np.zeros((x_.shape[0], *x_.shape))
    out[0, 0] = di_leads_dQ
    out[0, 2] = -alpha_ceramic/n_lever*dv_load_dp
    out[1, 2] = dv_load_dp/n_lever
    out[2, 0] = alpha_ceramic/n_lever/C
    out[2, 1] = -k/n_lever
    out[2, 2] = -dF_losses_dp - dF_bumper_dp
    out[2, 3] = -k_l
    out[2, 4] = -dF_end_stop_dx_e - dF_bumper_dx_e
    out[3, 2] = dv_load_dp
    out[4, 2] = dv_load_dp
    out[5, 0] = dheat_leads_dQ/T
    out[5, 2] = dheat_losses_dp/T + dheat_bumper_dp/T
    out[5, 4] = dheat_bumper_dx_e/T
    out[5, 5] = (-(heat_leads + heat_losses + heat_bumper)/T**2 - lam*T_e/T**2)*dT_dS
    return out


def margins(x_, u, p_, /):
    """Margin by which each condition of DOMAIN holds; of a bank, the least one; shape (len(DOMAIN), *batch)."""
    x_ = _states(x_, p_)
    u = _inputs(u)
    k = p_.k
    m_s = p_.m_s
    C = p_.C
    R = p_.R
    n = p_.n
    m = p_.m
    k_l = p_.k_l
    d = p_.d
    k_e = p_.k_e
    d_e = p_.d_e
    T_0 = p_.T_0
    c_0 = p_.c_0
    lam = p_.lam
    T_e = u[2]
    out = np.empty((14, *x_.shape[1:]))
    out[0] = n
    out[1] = R
    out[2] = d
    out[3] = k_e
    out[4] = d_e
    out[5] = lam
    out[6] = T_e
    out[7] = C
    out[8] = k
    out[9] = m
    out[10] = m_s
    out[11] = k_l
    out[12] = T_0
    out[13] = c_0
    return out
