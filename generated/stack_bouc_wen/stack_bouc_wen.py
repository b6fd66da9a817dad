"""Piezoelectric stack with a Bouc-Wen hysteresis of its voltage: irreversible port-Hamiltonian system.

Source:  Goldfarb, Celanovic (1997), IEEE Control Systems 17 (3), 69-79; Low, Guo (1995), J. Microelectromech. Syst. 4 (4), 230-237; PiezoDrive SA050536
Model:   stack_bouc_wen, spec sha256 cb2f5eb9e9a940796689ce0b466f2aabc3f9c62f14ebd031e4298cc6395703ff
System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
         rows, multiplied out; `piezo-sym show` prints the matrices
Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, continuous, rate-independent, sigma, exergy, environment, units, program PROVED
         (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
         parameters in the domain, and for banks of any size)

Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
Arrays have shape (n, *batch); values are in SI units.

x = (q, p, Q, Q_h, S)
u = (F_ext, V_in, T_e)
p_ = Parameters(); the underscore tells it from p, a name of the model
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

NAME = "stack_bouc_wen"
SPEC_SHA256 = "cb2f5eb9e9a940796689ce0b466f2aabc3f9c62f14ebd031e4298cc6395703ff"


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
    Record("Q", "C", "charge of capacitor 'ceramic'"),
    Record("Q_h", "C", "charge of capacitor 'hysteresis'"),
    Record("S", "J/K", "entropy of thermal_mass 'body'"),
)
INPUTS = (
    Record("F_ext", "N", "external force on the tip"),
    Record("V_in", "V", "voltage of the amplifier"),
    Record("T_e", "K", "temperature of the air"),
)
INPUT_DEFAULTS = (0.0, 0.0, 293.15)
# rows of outputs() and supply(): ports, named after the elements that have the inputs
OUTPUTS = (
    Record("load", "m/s", "velocity at force_source 'load'"),
    Record("supply", "A", "current given by voltage_source 'supply'"),
    Record("ambient", "K", "temperature of thermal_mass 'body'"),
)
# rows of heat() and entropy_production(): processes, with the unit of the second
PROCESSES = (
    Record("damper", "W/K", "damper 'damper'"),
    Record("hysteresis", "W/K", "capacitor 'hysteresis'"),
    Record("leads", "W/K", "resistor 'leads'"),
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
    Record("ceramic.effort", "V", "voltage of capacitor 'ceramic'"),
    Record("ceramic.flow", "A", "current of capacitor 'ceramic'"),
    Record("ceramic.power", "W", "power into capacitor 'ceramic'"),
    Record("ceramic.energy", "J", "energy of capacitor 'ceramic'"),
    Record("hysteresis.effort", "V", "voltage of capacitor 'hysteresis'"),
    Record("hysteresis.flow", "A", "current of capacitor 'hysteresis'"),
    Record("hysteresis.power", "W", "power into capacitor 'hysteresis'"),
    Record("hysteresis.energy", "J", "energy of capacitor 'hysteresis'"),
    Record("hysteresis.heat", "W", "heat of capacitor 'hysteresis'"),
    Record("transducer.effort_1", "V", "voltage in branch 1 of transducer 'transducer'"),
    Record("transducer.flow_1", "A", "current in branch 1 of transducer 'transducer'"),
    Record("transducer.effort_2", "N", "force in branch 2 of transducer 'transducer'"),
    Record("transducer.flow_2", "m/s", "velocity in branch 2 of transducer 'transducer'"),
    Record("transducer.power", "W", "power from branch 1 to branch 2 of transducer 'transducer'"),
    Record("leads.effort", "V", "voltage of resistor 'leads'"),
    Record("leads.flow", "A", "current of resistor 'leads'"),
    Record("leads.power", "W", "power into resistor 'leads'"),
    Record("leads.heat", "W", "heat of resistor 'leads'"),
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
    Record("m", "kg", "moving mass, 4/pi^2 of the stack's"),
    Record("k", "N/m", "stiffness"),
    Record("d", "N*s/m", "damping, a quality of about 30"),
    Record("a", "C/m", "transducer ratio, 28 N/um times 56 um over 180 V"),
    Record("C", "F", "capacitance of the clamped ceramic: 8 uF in large signals, less a^2/k"),
    Record("C_h", "F", "capacitance of what slips: in series with 8 uF, 4.3 uF in small signals"),
    Record("V_h", "V", "voltage at which it slips as fast as charge comes"),
    Record("beta", "1", "share of the slip that opposes its voltage"),
    Record("gam", "1", "share of the slip that goes with the current"),
    Record("n", "1", "how sharply it begins to slip"),
    Record("R", "ohm", "resistance of leads and electrodes"),
    Record("c_0", "J/K", "heat capacity, 7.1 g of 370 J/(kg K)"),
    Record("lam", "W/K", "heat conductance to the air"),
    Record("T_0", "K", "temperature at the start"),
)
BANKS = ()
DOMAIN = (
    Condition("beta >= abs(gam)", False),
    Condition("n > 0", True),
    Condition("V_h > 0", True),
    Condition("d >= 0", False),
    Condition("R > 0", True),
    Condition("lam >= 0", False),
    Condition("T_e > 0", True),
    Condition("k > 0", True),
    Condition("m > 0", True),
    Condition("C > 0", True),
    Condition("C_h > 0", True),
    Condition("T_0 > 0", True),
    Condition("c_0 > 0", True),
)


@dataclass(frozen=True)
class Parameters:
    """Parameters of stack_bouc_wen in SI units; defaults are the values of the spec."""

    m: float = 0.0029
    k: float = 28000000.0
    d: float = 10.0
    a: float = 8.7
    C: float = 5.3e-06
    C_h: float = 9.3e-06
    V_h: float = 10.0
    beta: float = 0.6
    gam: float = 0.4
    n: float = 1.0
    R: float = 2.0
    c_0: float = 2.6
    lam: float = 0.02
    T_0: float = 293.15


def _states(x, p):
    """Return states x, shape (n, *batch), as floats."""
    x = np.asarray(x, dtype=float)
    n = 5
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


def _rates(x, u, p_, out, /):
    """Write the rates dx/dt into `out`."""
    m = p_.m
    k = p_.k
    d = p_.d
    a = p_.a
    C = p_.C
    C_h = p_.C_h
    V_h = p_.V_h
    beta = p_.beta
    gam = p_.gam
    n = p_.n
    R = p_.R
    c_0 = p_.c_0
    lam = p_.lam
    T_0 = p_.T_0
    q = x[0]
    p = x[1]
    Q = x[2]
    Q_h = x[3]
    S = x[4]
    F_ext = u[0]
    V_in = u[1]
    T_e = u[2]
    # co-states dU/dx
    F_spring = k*q
    v_mass = p/m
    V_ceramic = Q/C
    V_hysteresis = Q_h/C_h
    T = T_0*np.exp(S/c_0)
    # transducer ratios
    alpha_transducer = a
    # dissipative laws
    F_damper = d*v_mass
    # driving forces
    V_leads = -V_ceramic - V_hysteresis + V_in
    # dissipative laws
    i_leads = V_leads/R
    slip_hysteresis = (beta*np.abs(i_leads)*np.sign(V_hysteresis) + gam*i_leads)*np.power(np.abs(V_hysteresis)/V_h, n)
    # heats
    heat_damper = F_damper*v_mass
    heat_hysteresis = slip_hysteresis*V_hysteresis
    heat_leads = i_leads*V_leads
    # result
    out[0] = v_mass
    out[1] = alpha_transducer*V_ceramic - F_spring - F_damper + F_ext
    out[2] = i_leads - alpha_transducer*v_mass
    out[3] = i_leads - slip_hysteresis
    out[4] = (heat_damper + heat_hysteresis + heat_leads)/T + lam*(T_e/T - 1)


def outputs(x, u, p_, /):
    """Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient; shape (3, *batch)."""
    x = _states(x, p_)
    u = _inputs(u)
    m = p_.m
    C = p_.C
    C_h = p_.C_h
    R = p_.R
    c_0 = p_.c_0
    T_0 = p_.T_0
    p = x[1]
    Q = x[2]
    Q_h = x[3]
    S = x[4]
    V_in = u[1]
    # co-states dU/dx
    v_mass = p/m
    V_ceramic = Q/C
    V_hysteresis = Q_h/C_h
    T = T_0*np.exp(S/c_0)
    # driving forces
    V_leads = -V_ceramic - V_hysteresis + V_in
    # dissipative laws
    i_leads = V_leads/R
    # result
    out = np.empty((3, *x.shape[1:]))
    out[0] = v_mass
    out[1] = i_leads
    out[2] = T
    return out


def supply(x, u, p_, /):
    """Power supplied through each port [W]; the sum is dU/dt; shape (3, *batch)."""
    x = _states(x, p_)
    u = _inputs(u)
    m = p_.m
    C = p_.C
    C_h = p_.C_h
    R = p_.R
    c_0 = p_.c_0
    lam = p_.lam
    T_0 = p_.T_0
    p = x[1]
    Q = x[2]
    Q_h = x[3]
    S = x[4]
    F_ext = u[0]
    V_in = u[1]
    T_e = u[2]
    # co-states dU/dx
    v_mass = p/m
    V_ceramic = Q/C
    V_hysteresis = Q_h/C_h
    T = T_0*np.exp(S/c_0)
    # driving forces
    V_leads = -V_ceramic - V_hysteresis + V_in
    # dissipative laws
    i_leads = V_leads/R
    # result
    out = np.empty((3, *x.shape[1:]))
    out[0] = v_mass*F_ext
    out[1] = i_leads*V_in
    out[2] = lam*(T_e - T)
    return out


def energy(x, p_, /):
    """Hamiltonian U [J]; shape (*batch)."""
    x = _states(x, p_)
    m = p_.m
    k = p_.k
    C = p_.C
    C_h = p_.C_h
    c_0 = p_.c_0
    T_0 = p_.T_0
    q = x[0]
    p = x[1]
    Q = x[2]
    Q_h = x[3]
    S = x[4]
    return k*q**2/2 + p**2/(2*m) + Q**2/(2*C) + Q_h**2/(2*C_h) + T_0*c_0*np.exp(S/c_0)


def entropy(x, p_, /):
    """Total entropy S [J/K]; shape (*batch)."""
    x = _states(x, p_)
    S = x[4]
    return S.copy()


def temperatures(x, p_, /):
    """Temperature of each body [K]; shape (1, *batch)."""
    x = _states(x, p_)
    c_0 = p_.c_0
    T_0 = p_.T_0
    S = x[4]
    # co-states dU/dx
    T = T_0*np.exp(S/c_0)
    # result
    out = np.empty((1, *x.shape[1:]))
    out[0] = T
    return out


def heat(x, u, p_, /):
    """Power that each process turns into heat [W]; of a bank, one row per lane; shape (3, *batch)."""
    x = _states(x, p_)
    u = _inputs(u)
    m = p_.m
    d = p_.d
    C = p_.C
    C_h = p_.C_h
    V_h = p_.V_h
    beta = p_.beta
    gam = p_.gam
    n = p_.n
    R = p_.R
    p = x[1]
    Q = x[2]
    Q_h = x[3]
    V_in = u[1]
    # co-states dU/dx
    v_mass = p/m
    V_ceramic = Q/C
    V_hysteresis = Q_h/C_h
    # dissipative laws
    F_damper = d*v_mass
    # driving forces
    V_leads = -V_ceramic - V_hysteresis + V_in
    # dissipative laws
    i_leads = V_leads/R
    slip_hysteresis = (beta*np.abs(i_leads)*np.sign(V_hysteresis) + gam*i_leads)*np.power(np.abs(V_hysteresis)/V_h, n)
    # result
    out = np.empty((3, *x.shape[1:]))
    out[0] = F_damper*v_mass
    out[1] = slip_hysteresis*V_hysteresis
    out[2] = i_leads*V_leads
    return out


def entropy_production(x, u, p_, /):
    """Entropy production of each process [W/K], heat exchange with ambients not included; of a bank, one row per lane; shape (3, *batch)."""
    x = _states(x, p_)
    u = _inputs(u)
    m = p_.m
    d = p_.d
    C = p_.C
    C_h = p_.C_h
    V_h = p_.V_h
    beta = p_.beta
    gam = p_.gam
    n = p_.n
    R = p_.R
    c_0 = p_.c_0
    T_0 = p_.T_0
    p = x[1]
    Q = x[2]
    Q_h = x[3]
    S = x[4]
    V_in = u[1]
    # co-states dU/dx
    v_mass = p/m
    V_ceramic = Q/C
    V_hysteresis = Q_h/C_h
    T = T_0*np.exp(S/c_0)
    # dissipative laws
    F_damper = d*v_mass
    # driving forces
    V_leads = -V_ceramic - V_hysteresis + V_in
    # dissipative laws
    i_leads = V_leads/R
    slip_hysteresis = (beta*np.abs(i_leads)*np.sign(V_hysteresis) + gam*i_leads)*np.power(np.abs(V_hysteresis)/V_h, n)
    # result
    out = np.empty((3, *x.shape[1:]))
    out[0] = F_damper*v_mass/T
    out[1] = slip_hysteresis*V_hysteresis/T
    out[2] = i_leads*V_leads/T
    return out


def elements(x, u, p_, /):
    """Effort, flow, power, energy and heat of elements; of a bank, one row per lane; shape (43, *batch)."""
    x = _states(x, p_)
    u = _inputs(u)
    m = p_.m
    k = p_.k
    d = p_.d
    a = p_.a
    C = p_.C
    C_h = p_.C_h
    V_h = p_.V_h
    beta = p_.beta
    gam = p_.gam
    n = p_.n
    R = p_.R
    c_0 = p_.c_0
    lam = p_.lam
    T_0 = p_.T_0
    q = x[0]
    p = x[1]
    Q = x[2]
    Q_h = x[3]
    S = x[4]
    F_ext = u[0]
    V_in = u[1]
    T_e = u[2]
    # co-states dU/dx
    F_spring = k*q
    v_mass = p/m
    V_ceramic = Q/C
    V_hysteresis = Q_h/C_h
    T = T_0*np.exp(S/c_0)
    # transducer ratios
    alpha_transducer = a
    # dissipative laws
    F_damper = d*v_mass
    # driving forces
    V_leads = -V_ceramic - V_hysteresis + V_in
    # dissipative laws
    i_leads = V_leads/R
    slip_hysteresis = (beta*np.abs(i_leads)*np.sign(V_hysteresis) + gam*i_leads)*np.power(np.abs(V_hysteresis)/V_h, n)
    # heats
    heat_damper = F_damper*v_mass
    heat_hysteresis = slip_hysteresis*V_hysteresis
    heat_leads = i_leads*V_leads
    # rates
    rate_p = alpha_transducer*V_ceramic - F_spring - F_damper + F_ext
    rate_Q = i_leads - alpha_transducer*v_mass
    rate_Q_h = i_leads - slip_hysteresis
    rate_S = (heat_damper + heat_hysteresis + heat_leads)/T + lam*(T_e/T - 1)
    # result
    out = np.empty((43, *x.shape[1:]))
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
    out[12] = V_ceramic
    out[13] = rate_Q
    out[14] = V_ceramic*rate_Q
    out[15] = Q**2/(2*C)
    out[16] = V_hysteresis
    out[17] = rate_Q_h + slip_hysteresis
    out[18] = V_hysteresis*(rate_Q_h + slip_hysteresis)
    out[19] = Q_h**2/(2*C_h)
    out[20] = slip_hysteresis*V_hysteresis
    out[21] = V_ceramic
    out[22] = alpha_transducer*v_mass
    out[23] = -alpha_transducer*V_ceramic
    out[24] = v_mass
    out[25] = V_ceramic*alpha_transducer*v_mass
    out[26] = V_leads
    out[27] = i_leads
    out[28] = i_leads*V_leads
    out[29] = i_leads*V_leads
    out[30] = T
    out[31] = rate_S
    out[32] = T*rate_S
    out[33] = T_0*c_0*np.exp(S/c_0)
    out[34] = T
    out[35] = -lam*(T_e/T - 1)
    out[36] = -lam*(T_e - T)
    out[37] = -F_ext
    out[38] = v_mass
    out[39] = -v_mass*F_ext
    out[40] = V_in
    out[41] = -i_leads
    out[42] = -i_leads*V_in
    return out


@np.errstate(divide="ignore", invalid="ignore")
def jacobian(x, u, p_, /):
    """Jacobian of rhs, d rhs[i]/d x[j] at [i, j]; shape (n, n, *batch)."""
    x = _states(x, p_)
    u = _inputs(u)
    m = p_.m
    k = p_.k
    d = p_.d
    a = p_.a
    C = p_.C
    C_h = p_.C_h
    V_h = p_.V_h
    beta = p_.beta
    gam = p_.gam
    n = p_.n
    R = p_.R
    c_0 = p_.c_0
    lam = p_.lam
    T_0 = p_.T_0
    p = x[1]
    Q = x[2]
    Q_h = x[3]
    S = x[4]
    V_in = u[1]
    T_e = u[2]
    # co-states dU/dx
    v_mass = p/m
    V_ceramic = Q/C
    V_hysteresis = Q_h/C_h
    T = T_0*np.exp(S/c_0)
    # transducer ratios
    alpha_transducer = a
    # dissipative laws
    F_damper = d*v_mass
    # driving forces
    V_leads = -V_ceramic - V_hysteresis + V_in
    # dissipative laws
    i_leads = V_leads/R
    slip_hysteresis = (beta*np.abs(i_leads)*np.sign(V_hysteresis) + gam*i_leads)*np.power(np.abs(V_hysteresis)/V_h, n)
    # heats
    heat_damper = F_damper*v_mass
    heat_hysteresis = slip_hysteresis*V_hysteresis
    heat_leads = i_leads*V_leads
    # derivatives
    dF_damper_dp = d/m
    dheat_damper_dp = v_mass*dF_damper_dp + F_damper/m
    di_leads_dQ = -1/R/C
    dslip_hysteresis_dQ = (beta*np.sign(i_leads)*np.sign(V_hysteresis) + gam)*np.power(np.abs(V_hysteresis)/V_h, n)*di_leads_dQ
    dheat_hysteresis_dQ = V_hysteresis*dslip_hysteresis_dQ
    dheat_leads_dQ = V_leads*di_leads_dQ - i_leads/C
    di_leads_dQ_h = -1/R/C_h
    dslip_hysteresis_dQ_h = (
        (beta*np.sign(i_leads)*np.sign(V_hysteresis) + gam)*np.power(np.abs(V_hysteresis)/V_h, n)*di_leads_dQ_h
        + (beta*np.abs(i_leads)*np.sign(V_hysteresis) + gam*i_leads)*n*np.power(np.abs(V_hysteresis)/V_h, n)/np.where(np.abs(V_hysteresis)/V_h > 0, np.abs(V_hysteresis)/V_h, 1)*np.sign(V_hysteresis)/V_h/C_h
    )
    dheat_hysteresis_dQ_h = V_hysteresis*dslip_hysteresis_dQ_h + slip_hysteresis/C_h
    dheat_leads_dQ_h = V_leads*di_leads_dQ_h - i_leads/C_h
    dT_dS = T/c_0
    # result
    out = np.zeros((x.shape[0], *x.shape))
    out[0, 1] = 1/m
    out[1, 0] = -k
    out[1, 1] = -dF_damper_dp
    out[1, 2] = alpha_transducer/C
    out[2, 1] = -alpha_transducer/m
    out[2, 2] = di_leads_dQ
    out[2, 3] = di_leads_dQ_h
    out[3, 2] = di_leads_dQ - dslip_hysteresis_dQ
    out[3, 3] = di_leads_dQ_h - dslip_hysteresis_dQ_h
    out[4, 1] = dheat_damper_dp/T
    out[4, 2] = dheat_hysteresis_dQ/T + dheat_leads_dQ/T
    out[4, 3] = dheat_hysteresis_dQ_h/T + dheat_leads_dQ_h/T
    out[4, 4] = (-(heat_damper + heat_hysteresis + heat_leads)/T**2 - lam*T_e/T**2)*dT_dS
    return out


def margins(x, u, p_, /):
    """Margin by which each condition of DOMAIN holds; of a bank, the least one; shape (len(DOMAIN), *batch)."""
    x = _states(x, p_)
    u = _inputs(u)
    m = p_.m
    k = p_.k
    d = p_.d
    C = p_.C
    C_h = p_.C_h
    V_h = p_.V_h
    beta = p_.beta
    gam = p_.gam
    n = p_.n
    R = p_.R
    c_0 = p_.c_0
    lam = p_.lam
    T_0 = p_.T_0
    T_e = u[2]
    out = np.empty((13, *x.shape[1:]))
    out[0] = beta - np.abs(gam)
    out[1] = n
    out[2] = V_h
    out[3] = d
    out[4] = R
    out[5] = lam
    out[6] = T_e
    out[7] = k
    out[8] = m
    out[9] = C
    out[10] = C_h
    out[11] = T_0
    out[12] = c_0
    return out
