"""DC motor with gear, bearing, and a winding that warms: irreversible port-Hamiltonian system.

Source:  Messner, Tilbury, Control Tutorials for MATLAB and Simulink: DC motor speed, with gear and heat
Model:   dc_motor, spec sha256 96a82a6d03ed86fc2c97e6ac88a26dd86ab244ed2d6fd71b14db35164a855b91
System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
         rows, multiplied out; `piezo-sym show` prints the matrices
Proofs:  skew, casimir, temperature, welldef, energy, entropy, passive, odd, sigma, exergy, environment, units, program PROVED
         (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
         parameters in the domain, and for banks of any size)

Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
Arrays have shape (n, *batch); values are in SI units.

x = (phi, H, S)
u = (V_in, tau, T_e)
p = Parameters()
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

NAME = "dc_motor"
SPEC_SHA256 = "96a82a6d03ed86fc2c97e6ac88a26dd86ab244ed2d6fd71b14db35164a855b91"


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
    Record("phi", "Wb", "flux linkage of inductor 'armature'"),
    Record("H", "N*m*s", "angular momentum of inertia 'rotor', joined with 'load'"),
    Record("S", "J/K", "entropy of thermal_mass 'body'"),
)
INPUTS = (
    Record("V_in", "V", "voltage of the armature"),
    Record("tau", "N*m", "torque on the load"),
    Record("T_e", "K", "temperature of the environment"),
)
INPUT_DEFAULTS = (0.0, 0.0, 293.15)
# rows of outputs() and supply(): ports, named after the elements that have the inputs
OUTPUTS = (
    Record("supply", "A", "current given by voltage_source 'supply'"),
    Record("torque", "rad/s", "angular velocity at torque_source 'torque'"),
    Record("air", "K", "temperature of thermal_mass 'body'"),
)
# rows of heat() and entropy_production(): processes, with the unit of the second
PROCESSES = (
    Record("winding", "W/K", "resistor 'winding'"),
    Record("bearing", "W/K", "rotational_damper 'bearing'"),
)
# rows of temperatures(), and of elements()
BODIES = (
    Record("body", "K", "temperature of thermal_mass 'body'"),
)
ELEMENTS = (
    Record("supply.effort", "V", "voltage of voltage_source 'supply'"),
    Record("supply.flow", "A", "current of voltage_source 'supply'"),
    Record("supply.power", "W", "power into voltage_source 'supply'"),
    Record("winding.effort", "V", "voltage of resistor 'winding'"),
    Record("winding.flow", "A", "current of resistor 'winding'"),
    Record("winding.power", "W", "power into resistor 'winding'"),
    Record("winding.heat", "W", "heat of resistor 'winding'"),
    Record("armature.effort", "V", "voltage of inductor 'armature'"),
    Record("armature.flow", "A", "current of inductor 'armature'"),
    Record("armature.power", "W", "power into inductor 'armature'"),
    Record("armature.energy", "J", "energy of inductor 'armature'"),
    Record("machine.effort_1", "V", "voltage in branch 1 of motor 'machine'"),
    Record("machine.flow_1", "A", "current in branch 1 of motor 'machine'"),
    Record("machine.effort_2", "N*m", "torque in branch 2 of motor 'machine'"),
    Record("machine.flow_2", "rad/s", "angular velocity in branch 2 of motor 'machine'"),
    Record("machine.power", "W", "power from branch 1 to branch 2 of motor 'machine'"),
    Record("rotor.effort", "N*m", "torque of inertia 'rotor'"),
    Record("rotor.flow", "rad/s", "angular velocity of inertia 'rotor'"),
    Record("rotor.power", "W", "power into inertia 'rotor'"),
    Record("rotor.energy", "J", "energy of inertia 'rotor'"),
    Record("bearing.effort", "N*m", "torque of rotational_damper 'bearing'"),
    Record("bearing.flow", "rad/s", "angular velocity of rotational_damper 'bearing'"),
    Record("bearing.power", "W", "power into rotational_damper 'bearing'"),
    Record("bearing.heat", "W", "heat of rotational_damper 'bearing'"),
    Record("gear.effort_1", "N*m", "torque in branch 1 of gear 'gear'"),
    Record("gear.flow_1", "rad/s", "angular velocity in branch 1 of gear 'gear'"),
    Record("gear.effort_2", "N*m", "torque in branch 2 of gear 'gear'"),
    Record("gear.flow_2", "rad/s", "angular velocity in branch 2 of gear 'gear'"),
    Record("gear.power", "W", "power from branch 1 to branch 2 of gear 'gear'"),
    Record("load.effort", "N*m", "torque of inertia 'load'"),
    Record("load.flow", "rad/s", "angular velocity of inertia 'load'"),
    Record("load.power", "W", "power into inertia 'load'"),
    Record("load.energy", "J", "energy of inertia 'load'"),
    Record("torque.effort", "N*m", "torque of torque_source 'torque'"),
    Record("torque.flow", "rad/s", "angular velocity of torque_source 'torque'"),
    Record("torque.power", "W", "power into torque_source 'torque'"),
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
    Record("R_0", "ohm", "resistance of the armature at T_0"),
    Record("al", "1/K", "temperature coefficient of copper"),
    Record("L", "H", "inductance of the armature"),
    Record("K", "N*m/A", "motor constant"),
    Record("J_m", "kg*m**2", "inertia of the rotor"),
    Record("b", "N*m*s", "friction of the bearing"),
    Record("n", "1", "speed of the rotor over that of the load"),
    Record("J_l", "kg*m**2", "inertia of the load"),
    Record("c", "J/K", "heat capacity of the motor"),
    Record("lam", "W/K", "heat conductance to the environment"),
    Record("T_0", "K", "temperature at the start"),
)
BANKS = ()
DOMAIN = (
    Condition("R_0 >= 0", False),
    Condition("al >= 0", False),
    Condition("b >= 0", False),
    Condition("lam >= 0", False),
    Condition("n > 0", True),
    Condition("1 + al*(T - T_0) > 0", True),
    Condition("T_e > 0", True),
    Condition("L > 0", True),
    Condition("J_m > 0", True),
    Condition("J_l > 0", True),
    Condition("T_0 > 0", True),
    Condition("c > 0", True),
)


@dataclass(frozen=True)
class Parameters:
    """Parameters of dc_motor in SI units; defaults are the values of the spec."""

    R_0: float = 1.0
    al: float = 0.00393
    L: float = 0.5
    K: float = 0.01
    J_m: float = 0.01
    b: float = 0.1
    n: float = 5.0
    J_l: float = 0.25
    c: float = 50.0
    lam: float = 0.2
    T_0: float = 293.15


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
    R_0 = p.R_0
    al = p.al
    L = p.L
    K = p.K
    J_m = p.J_m
    b = p.b
    n = p.n
    J_l = p.J_l
    c = p.c
    lam = p.lam
    T_0 = p.T_0
    phi = x[0]
    H = x[1]
    S = x[2]
    V_in = u[0]
    tau = u[1]
    T_e = u[2]
    # co-states dU/dx
    i_armature = phi/L
    omega_rotor = H/(J_m + J_l/n**2)
    T_minus_T_0 = T_0*np.expm1(S/c)
    T = T_0 + T_minus_T_0
    # transducer ratios
    n_machine = K
    n_gear = n
    # dissipative laws
    V_winding = R_0*(1 + al*T_minus_T_0)*i_armature
    tau_bearing = b*omega_rotor
    # heats
    heat_winding = V_winding*i_armature
    heat_bearing = tau_bearing*omega_rotor
    # result
    out[0] = V_in - n_machine*omega_rotor - V_winding
    out[1] = n_machine*i_armature - tau_bearing + tau/n_gear
    out[2] = (heat_winding + heat_bearing)/T + lam*(T_e/T - 1)


def outputs(x, u, p, /):
    """Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient; shape (3, *batch)."""
    x = _states(x, p)
    L = p.L
    J_m = p.J_m
    n = p.n
    J_l = p.J_l
    c = p.c
    T_0 = p.T_0
    phi = x[0]
    H = x[1]
    S = x[2]
    # co-states dU/dx
    i_armature = phi/L
    omega_rotor = H/(J_m + J_l/n**2)
    T_minus_T_0 = T_0*np.expm1(S/c)
    T = T_0 + T_minus_T_0
    # transducer ratios
    n_gear = n
    # result
    out = np.empty((3, *x.shape[1:]))
    out[0] = i_armature
    out[1] = omega_rotor/n_gear
    out[2] = T
    return out


def supply(x, u, p, /):
    """Power supplied through each port [W]; the sum is dU/dt; shape (3, *batch)."""
    x = _states(x, p)
    u = _inputs(u)
    L = p.L
    J_m = p.J_m
    n = p.n
    J_l = p.J_l
    c = p.c
    lam = p.lam
    T_0 = p.T_0
    phi = x[0]
    H = x[1]
    S = x[2]
    V_in = u[0]
    tau = u[1]
    T_e = u[2]
    # co-states dU/dx
    i_armature = phi/L
    omega_rotor = H/(J_m + J_l/n**2)
    T_minus_T_0 = T_0*np.expm1(S/c)
    T = T_0 + T_minus_T_0
    # transducer ratios
    n_gear = n
    # result
    out = np.empty((3, *x.shape[1:]))
    out[0] = i_armature*V_in
    out[1] = omega_rotor/n_gear*tau
    out[2] = lam*(T_e - T)
    return out


def energy(x, p, /):
    """Hamiltonian U [J]; shape (*batch)."""
    x = _states(x, p)
    L = p.L
    J_m = p.J_m
    n = p.n
    J_l = p.J_l
    c = p.c
    T_0 = p.T_0
    phi = x[0]
    H = x[1]
    S = x[2]
    return phi**2/(2*L) + H**2/(2*(J_m + J_l/n**2)) + T_0*c*np.exp(S/c)


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
    T_minus_T_0 = T_0*np.expm1(S/c)
    T = T_0 + T_minus_T_0
    # result
    out = np.empty((1, *x.shape[1:]))
    out[0] = T
    return out


def heat(x, u, p, /):
    """Power that each process turns into heat [W]; of a bank, one row per lane; shape (2, *batch)."""
    x = _states(x, p)
    R_0 = p.R_0
    al = p.al
    L = p.L
    J_m = p.J_m
    b = p.b
    n = p.n
    J_l = p.J_l
    c = p.c
    T_0 = p.T_0
    phi = x[0]
    H = x[1]
    S = x[2]
    # co-states dU/dx
    i_armature = phi/L
    omega_rotor = H/(J_m + J_l/n**2)
    T_minus_T_0 = T_0*np.expm1(S/c)
    # dissipative laws
    V_winding = R_0*(1 + al*T_minus_T_0)*i_armature
    tau_bearing = b*omega_rotor
    # result
    out = np.empty((2, *x.shape[1:]))
    out[0] = V_winding*i_armature
    out[1] = tau_bearing*omega_rotor
    return out


def entropy_production(x, u, p, /):
    """Entropy production of each process [W/K], heat exchange with ambients not included; of a bank, one row per lane; shape (2, *batch)."""
    x = _states(x, p)
    R_0 = p.R_0
    al = p.al
    L = p.L
    J_m = p.J_m
    b = p.b
    n = p.n
    J_l = p.J_l
    c = p.c
    T_0 = p.T_0
    phi = x[0]
    H = x[1]
    S = x[2]
    # co-states dU/dx
    i_armature = phi/L
    omega_rotor = H/(J_m + J_l/n**2)
    T_minus_T_0 = T_0*np.expm1(S/c)
    T = T_0 + T_minus_T_0
    # dissipative laws
    V_winding = R_0*(1 + al*T_minus_T_0)*i_armature
    tau_bearing = b*omega_rotor
    # result
    out = np.empty((2, *x.shape[1:]))
    out[0] = V_winding*i_armature/T
    out[1] = tau_bearing*omega_rotor/T
    return out


def elements(x, u, p, /):
    """Effort, flow, power, energy and heat of elements; of a bank, one row per lane; shape (43, *batch)."""
    x = _states(x, p)
    u = _inputs(u)
    R_0 = p.R_0
    al = p.al
    L = p.L
    K = p.K
    J_m = p.J_m
    b = p.b
    n = p.n
    J_l = p.J_l
    c = p.c
    lam = p.lam
    T_0 = p.T_0
    phi = x[0]
    H = x[1]
    S = x[2]
    V_in = u[0]
    tau = u[1]
    T_e = u[2]
    # co-states dU/dx
    i_armature = phi/L
    omega_rotor = H/(J_m + J_l/n**2)
    T_minus_T_0 = T_0*np.expm1(S/c)
    T = T_0 + T_minus_T_0
    # transducer ratios
    n_machine = K
    n_gear = n
    # dissipative laws
    V_winding = R_0*(1 + al*T_minus_T_0)*i_armature
    tau_bearing = b*omega_rotor
    # heats
    heat_winding = V_winding*i_armature
    heat_bearing = tau_bearing*omega_rotor
    # rates
    rate_phi = V_in - n_machine*omega_rotor - V_winding
    rate_H = n_machine*i_armature - tau_bearing + tau/n_gear
    rate_S = (heat_winding + heat_bearing)/T + lam*(T_e/T - 1)
    # result
    out = np.empty((43, *x.shape[1:]))
    out[0] = V_in
    out[1] = -i_armature
    out[2] = -i_armature*V_in
    out[3] = V_winding
    out[4] = i_armature
    out[5] = V_winding*i_armature
    out[6] = V_winding*i_armature
    out[7] = rate_phi
    out[8] = i_armature
    out[9] = rate_phi*i_armature
    out[10] = phi**2/(2*L)
    out[11] = n_machine*omega_rotor
    out[12] = i_armature
    out[13] = -n_machine*i_armature
    out[14] = omega_rotor
    out[15] = n_machine*omega_rotor*i_armature
    out[16] = J_m/(J_m + J_l/n**2)*rate_H
    out[17] = omega_rotor
    out[18] = J_m/(J_m + J_l/n**2)*rate_H*omega_rotor
    out[19] = 0.5*(J_m*omega_rotor**2)
    out[20] = tau_bearing
    out[21] = omega_rotor
    out[22] = tau_bearing*omega_rotor
    out[23] = tau_bearing*omega_rotor
    out[24] = -tau/n_gear + J_l/n/(J_m + J_l/n**2)*rate_H/n_gear
    out[25] = n_gear*omega_rotor/n_gear
    out[26] = -n_gear*(-tau/n_gear + J_l/n/(J_m + J_l/n**2)*rate_H/n_gear)
    out[27] = omega_rotor/n_gear
    out[28] = n_gear*omega_rotor/n_gear*(-tau/n_gear + J_l/n/(J_m + J_l/n**2)*rate_H/n_gear)
    out[29] = J_l/n/(J_m + J_l/n**2)*rate_H
    out[30] = omega_rotor/n
    out[31] = J_l/n/(J_m + J_l/n**2)*rate_H*omega_rotor/n
    out[32] = 0.5*(J_l*(omega_rotor/n)**2)
    out[33] = -tau
    out[34] = omega_rotor/n_gear
    out[35] = -omega_rotor/n_gear*tau
    out[36] = T
    out[37] = rate_S
    out[38] = T*rate_S
    out[39] = T_0*c*np.exp(S/c)
    out[40] = T
    out[41] = -lam*(T_e/T - 1)
    out[42] = -lam*(T_e - T)
    return out


def jacobian(x, u, p, /):
    """Jacobian of rhs, d rhs[i]/d x[j] at [i, j]; shape (n, n, *batch)."""
    x = _states(x, p)
    u = _inputs(u)
    R_0 = p.R_0
    al = p.al
    L = p.L
    K = p.K
    J_m = p.J_m
    b = p.b
    n = p.n
    J_l = p.J_l
    c = p.c
    lam = p.lam
    T_0 = p.T_0
    phi = x[0]
    H = x[1]
    S = x[2]
    T_e = u[2]
    # co-states dU/dx
    i_armature = phi/L
    omega_rotor = H/(J_m + J_l/n**2)
    T_minus_T_0 = T_0*np.expm1(S/c)
    T = T_0 + T_minus_T_0
    # transducer ratios
    n_machine = K
    # dissipative laws
    V_winding = R_0*(1 + al*T_minus_T_0)*i_armature
    tau_bearing = b*omega_rotor
    # heats
    heat_winding = V_winding*i_armature
    heat_bearing = tau_bearing*omega_rotor
    # derivatives
    dV_winding_dphi = R_0*(1 + al*T_minus_T_0)/L
    dheat_winding_dphi = i_armature*dV_winding_dphi + V_winding/L
    domega_rotor_dH = 1/(J_m + J_l/n**2)
    dtau_bearing_dH = b*domega_rotor_dH
    dheat_bearing_dH = omega_rotor*dtau_bearing_dH + tau_bearing*domega_rotor_dH
    dT_minus_T_0_dS = T/c
    dV_winding_dS = R_0*al*i_armature*dT_minus_T_0_dS
    dheat_winding_dS = i_armature*dV_winding_dS
    # result
    out = np.zeros((x.shape[0], *x.shape))
    out[0, 0] = -dV_winding_dphi
    out[0, 1] = -n_machine*domega_rotor_dH
    out[0, 2] = -dV_winding_dS
    out[1, 0] = n_machine/L
    out[1, 1] = -dtau_bearing_dH
    out[2, 0] = dheat_winding_dphi/T
    out[2, 1] = dheat_bearing_dH/T
    out[2, 2] = (
        dheat_winding_dS/T
        + (-(heat_winding + heat_bearing)/T**2 - lam*T_e/T**2)*dT_minus_T_0_dS
    )
    return out


def margins(x, u, p, /):
    """Margin by which each condition of DOMAIN holds; of a bank, the least one; shape (len(DOMAIN), *batch)."""
    x = _states(x, p)
    u = _inputs(u)
    R_0 = p.R_0
    al = p.al
    L = p.L
    J_m = p.J_m
    b = p.b
    n = p.n
    J_l = p.J_l
    c = p.c
    lam = p.lam
    T_0 = p.T_0
    S = x[2]
    T_e = u[2]
    # co-states dU/dx
    T_minus_T_0 = T_0*np.expm1(S/c)
    # result
    out = np.empty((12, *x.shape[1:]))
    out[0] = R_0
    out[1] = al
    out[2] = b
    out[3] = lam
    out[4] = n
    out[5] = 1 + al*T_minus_T_0
    out[6] = T_e
    out[7] = L
    out[8] = J_m
    out[9] = J_l
    out[10] = T_0
    out[11] = c
    return out
