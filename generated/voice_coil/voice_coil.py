"""Voice coil of a loudspeaker, with the heat of its winding: irreversible port-Hamiltonian system.

Source:  Small (1972), J. Audio Eng. Soc. 20 (5), 383-395; values of a 165 mm driver
Model:   voice_coil, spec sha256 b17a1309ca30712ebd0993cb3dcdd961cc3539b78aa3f80bce5bbdfa54c8bfcf
System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
         rows, multiplied out; `piezo-sym show` prints the matrices
Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, sigma, exergy, environment, units, program PROVED
         (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
         parameters in the domain, and for banks of any size)

Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
Arrays have shape (n, *batch); values are in SI units.

x = (q, p, phi, S_w, S_m)
u = (V_in, T_e)
p_ = Parameters(); the underscore tells it from p, a name of the model
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

NAME = "voice_coil"
SPEC_SHA256 = "b17a1309ca30712ebd0993cb3dcdd961cc3539b78aa3f80bce5bbdfa54c8bfcf"


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
    Record("q", "m", "extension of spring 'suspension'"),
    Record("p", "kg*m/s", "momentum of mass 'cone'"),
    Record("phi", "Wb", "flux linkage of inductor 'coil'"),
    Record("S_w", "J/K", "entropy of thermal_mass 'winding'"),
    Record("S_m", "J/K", "entropy of thermal_mass 'magnet'"),
)
INPUTS = (
    Record("V_in", "V", "voltage of the amplifier"),
    Record("T_e", "K", "temperature of the air"),
)
INPUT_DEFAULTS = (0.0, 293.15)
# rows of outputs() and supply(): ports, named after the elements that have the inputs
OUTPUTS = (
    Record("amplifier", "A", "current given by voltage_source 'amplifier'"),
    Record("air", "K", "temperature of thermal_mass 'magnet'"),
)
# rows of heat() and entropy_production(): processes, with the unit of the second
PROCESSES = (
    Record("losses", "W/K", "damper 'losses'"),
    Record("copper", "W/K", "resistor 'copper'"),
    Record("contact", "W/K", "conduction 'contact'"),
)
# rows of temperatures(), and of elements()
BODIES = (
    Record("winding", "K", "temperature of thermal_mass 'winding'"),
    Record("magnet", "K", "temperature of thermal_mass 'magnet'"),
)
ELEMENTS = (
    Record("suspension.effort", "N", "force of spring 'suspension'"),
    Record("suspension.flow", "m/s", "velocity of spring 'suspension'"),
    Record("suspension.power", "W", "power into spring 'suspension'"),
    Record("suspension.energy", "J", "energy of spring 'suspension'"),
    Record("cone.effort", "N", "force of mass 'cone'"),
    Record("cone.flow", "m/s", "velocity of mass 'cone'"),
    Record("cone.power", "W", "power into mass 'cone'"),
    Record("cone.energy", "J", "energy of mass 'cone'"),
    Record("losses.effort", "N", "force of damper 'losses'"),
    Record("losses.flow", "m/s", "velocity of damper 'losses'"),
    Record("losses.power", "W", "power into damper 'losses'"),
    Record("losses.heat", "W", "heat of damper 'losses'"),
    Record("coil.effort", "V", "voltage of inductor 'coil'"),
    Record("coil.flow", "A", "current of inductor 'coil'"),
    Record("coil.power", "W", "power into inductor 'coil'"),
    Record("coil.energy", "J", "energy of inductor 'coil'"),
    Record("copper.effort", "V", "voltage of resistor 'copper'"),
    Record("copper.flow", "A", "current of resistor 'copper'"),
    Record("copper.power", "W", "power into resistor 'copper'"),
    Record("copper.heat", "W", "heat of resistor 'copper'"),
    Record("gap.effort_1", "V", "voltage in branch 1 of motor 'gap'"),
    Record("gap.flow_1", "A", "current in branch 1 of motor 'gap'"),
    Record("gap.effort_2", "N", "force in branch 2 of motor 'gap'"),
    Record("gap.flow_2", "m/s", "velocity in branch 2 of motor 'gap'"),
    Record("gap.power", "W", "power from branch 1 to branch 2 of motor 'gap'"),
    Record("winding.effort", "K", "temperature of thermal_mass 'winding'"),
    Record("winding.flow", "W/K", "entropy flow of thermal_mass 'winding'"),
    Record("winding.power", "W", "power into thermal_mass 'winding'"),
    Record("winding.energy", "J", "energy of thermal_mass 'winding'"),
    Record("magnet.effort", "K", "temperature of thermal_mass 'magnet'"),
    Record("magnet.flow", "W/K", "entropy flow of thermal_mass 'magnet'"),
    Record("magnet.power", "W", "power into thermal_mass 'magnet'"),
    Record("magnet.energy", "J", "energy of thermal_mass 'magnet'"),
    Record("contact.effort", "K", "temperature difference over conduction 'contact'"),
    Record("contact.power", "W", "heat from first to second body by conduction 'contact'"),
    Record("air.effort", "K", "temperature at ambient 'air'"),
    Record("air.flow", "W/K", "entropy flow at ambient 'air'"),
    Record("air.power", "W", "power into ambient 'air'"),
    Record("amplifier.effort", "V", "voltage of voltage_source 'amplifier'"),
    Record("amplifier.flow", "A", "current of voltage_source 'amplifier'"),
    Record("amplifier.power", "W", "power into voltage_source 'amplifier'"),
)
# fields of Parameters; elements of many lanes; conditions under which the proofs hold
PARAMETERS = (
    Record("m", "kg", "moving mass"),
    Record("k", "N/m", "stiffness of the suspension"),
    Record("d", "N*s/m", "damping of the suspension"),
    Record("Bl", "N/A", "force factor"),
    Record("R_0", "ohm", "resistance of the winding at T_0"),
    Record("al", "1/K", "temperature coefficient of copper"),
    Record("L", "H", "inductance of the winding"),
    Record("c_w", "J/K", "heat capacity of the winding"),
    Record("c_m", "J/K", "heat capacity of the magnet and the frame"),
    Record("lam", "W/K", "heat conductance from winding to magnet"),
    Record("h", "W/K", "heat conductance from magnet to air"),
    Record("T_0", "K", "temperature at the start"),
)
BANKS = ()
DOMAIN = (
    Condition("d >= 0", False),
    Condition("R_0 >= 0", False),
    Condition("al >= 0", False),
    Condition("lam >= 0", False),
    Condition("h >= 0", False),
    Condition("1 + al*(T_winding - T_0) > 0", True),
    Condition("T_e > 0", True),
    Condition("k > 0", True),
    Condition("m > 0", True),
    Condition("L > 0", True),
    Condition("T_0 > 0", True),
    Condition("c_w > 0", True),
    Condition("c_m > 0", True),
)


@dataclass(frozen=True)
class Parameters:
    """Parameters of voice_coil in SI units; defaults are the values of the spec."""

    m: float = 0.014
    k: float = 1100.0
    d: float = 1.2
    Bl: float = 6.5
    R_0: float = 5.6
    al: float = 0.00393
    L: float = 0.0005
    c_w: float = 4.0
    c_m: float = 400.0
    lam: float = 0.4
    h: float = 0.5
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


def _rates(x, u, p_, out, /):
    """Write the rates dx/dt into `out`."""
    m = p_.m
    k = p_.k
    d = p_.d
    Bl = p_.Bl
    R_0 = p_.R_0
    al = p_.al
    L = p_.L
    c_w = p_.c_w
    c_m = p_.c_m
    lam = p_.lam
    h = p_.h
    T_0 = p_.T_0
    q = x[0]
    p = x[1]
    phi = x[2]
    S_w = x[3]
    S_m = x[4]
    V_in = u[0]
    T_e = u[1]
    # co-states dU/dx
    F_suspension = k*q
    v_cone = p/m
    i_coil = phi/L
    T_winding_minus_T_0 = T_0*np.expm1(S_w/c_w)
    T_winding = T_0 + T_winding_minus_T_0
    T_magnet = T_0*np.exp(S_m/c_m)
    # transducer ratios
    n_gap = Bl
    # dissipative laws
    F_losses = d*v_cone
    V_copper = R_0*(1 + al*T_winding_minus_T_0)*i_coil
    s_contact = lam*(T_winding - T_magnet)/T_winding
    # heats
    heat_losses = F_losses*v_cone
    heat_copper = V_copper*i_coil
    heat_contact = s_contact*T_winding
    # result
    out[0] = v_cone
    out[1] = n_gap*i_coil - F_suspension - F_losses
    out[2] = V_in - n_gap*v_cone - V_copper
    out[3] = heat_copper/T_winding - s_contact
    out[4] = (heat_losses + heat_contact)/T_magnet + h*(T_e/T_magnet - 1)


def outputs(x, u, p_, /):
    """Outputs y, one per port, conjugate to its input, or to the entropy flow of an ambient; shape (2, *batch)."""
    x = _states(x, p_)
    L = p_.L
    c_m = p_.c_m
    T_0 = p_.T_0
    phi = x[2]
    S_m = x[4]
    # co-states dU/dx
    i_coil = phi/L
    T_magnet = T_0*np.exp(S_m/c_m)
    # result
    out = np.empty((2, *x.shape[1:]))
    out[0] = i_coil
    out[1] = T_magnet
    return out


def supply(x, u, p_, /):
    """Power supplied through each port [W]; the sum is dU/dt; shape (2, *batch)."""
    x = _states(x, p_)
    u = _inputs(u)
    L = p_.L
    c_m = p_.c_m
    h = p_.h
    T_0 = p_.T_0
    phi = x[2]
    S_m = x[4]
    V_in = u[0]
    T_e = u[1]
    # co-states dU/dx
    i_coil = phi/L
    T_magnet = T_0*np.exp(S_m/c_m)
    # result
    out = np.empty((2, *x.shape[1:]))
    out[0] = i_coil*V_in
    out[1] = h*(T_e - T_magnet)
    return out


def energy(x, p_, /):
    """Hamiltonian U [J]; shape (*batch)."""
    x = _states(x, p_)
    m = p_.m
    k = p_.k
    L = p_.L
    c_w = p_.c_w
    c_m = p_.c_m
    T_0 = p_.T_0
    q = x[0]
    p = x[1]
    phi = x[2]
    S_w = x[3]
    S_m = x[4]
    return k*q**2/2 + p**2/(2*m) + phi**2/(2*L) + T_0*c_w*np.exp(S_w/c_w) + T_0*c_m*np.exp(S_m/c_m)


def entropy(x, p_, /):
    """Total entropy S [J/K]; shape (*batch)."""
    x = _states(x, p_)
    S_w = x[3]
    S_m = x[4]
    return S_w + S_m


def temperatures(x, p_, /):
    """Temperature of each body [K]; shape (2, *batch)."""
    x = _states(x, p_)
    c_w = p_.c_w
    c_m = p_.c_m
    T_0 = p_.T_0
    S_w = x[3]
    S_m = x[4]
    # co-states dU/dx
    T_winding_minus_T_0 = T_0*np.expm1(S_w/c_w)
    T_winding = T_0 + T_winding_minus_T_0
    T_magnet = T_0*np.exp(S_m/c_m)
    # result
    out = np.empty((2, *x.shape[1:]))
    out[0] = T_winding
    out[1] = T_magnet
    return out


def heat(x, u, p_, /):
    """Power that each process turns into heat [W]; of a bank, one row per lane; shape (3, *batch)."""
    x = _states(x, p_)
    m = p_.m
    d = p_.d
    R_0 = p_.R_0
    al = p_.al
    L = p_.L
    c_w = p_.c_w
    c_m = p_.c_m
    lam = p_.lam
    T_0 = p_.T_0
    p = x[1]
    phi = x[2]
    S_w = x[3]
    S_m = x[4]
    # co-states dU/dx
    v_cone = p/m
    i_coil = phi/L
    T_winding_minus_T_0 = T_0*np.expm1(S_w/c_w)
    T_winding = T_0 + T_winding_minus_T_0
    T_magnet = T_0*np.exp(S_m/c_m)
    # dissipative laws
    F_losses = d*v_cone
    V_copper = R_0*(1 + al*T_winding_minus_T_0)*i_coil
    s_contact = lam*(T_winding - T_magnet)/T_winding
    # result
    out = np.empty((3, *x.shape[1:]))
    out[0] = F_losses*v_cone
    out[1] = V_copper*i_coil
    out[2] = s_contact*T_winding
    return out


def entropy_production(x, u, p_, /):
    """Entropy production of each process [W/K], heat exchange with ambients not included; of a bank, one row per lane; shape (3, *batch)."""
    x = _states(x, p_)
    m = p_.m
    d = p_.d
    R_0 = p_.R_0
    al = p_.al
    L = p_.L
    c_w = p_.c_w
    c_m = p_.c_m
    lam = p_.lam
    T_0 = p_.T_0
    p = x[1]
    phi = x[2]
    S_w = x[3]
    S_m = x[4]
    # co-states dU/dx
    v_cone = p/m
    i_coil = phi/L
    T_winding_minus_T_0 = T_0*np.expm1(S_w/c_w)
    T_winding = T_0 + T_winding_minus_T_0
    T_magnet = T_0*np.exp(S_m/c_m)
    # dissipative laws
    F_losses = d*v_cone
    V_copper = R_0*(1 + al*T_winding_minus_T_0)*i_coil
    s_contact = lam*(T_winding - T_magnet)/T_winding
    # result
    out = np.empty((3, *x.shape[1:]))
    out[0] = F_losses*v_cone/T_magnet
    out[1] = V_copper*i_coil/T_winding
    out[2] = s_contact*(T_winding - T_magnet)/T_magnet
    return out


def elements(x, u, p_, /):
    """Effort, flow, power, energy and heat of elements; of a bank, one row per lane; shape (41, *batch)."""
    x = _states(x, p_)
    u = _inputs(u)
    m = p_.m
    k = p_.k
    d = p_.d
    Bl = p_.Bl
    R_0 = p_.R_0
    al = p_.al
    L = p_.L
    c_w = p_.c_w
    c_m = p_.c_m
    lam = p_.lam
    h = p_.h
    T_0 = p_.T_0
    q = x[0]
    p = x[1]
    phi = x[2]
    S_w = x[3]
    S_m = x[4]
    V_in = u[0]
    T_e = u[1]
    # co-states dU/dx
    F_suspension = k*q
    v_cone = p/m
    i_coil = phi/L
    T_winding_minus_T_0 = T_0*np.expm1(S_w/c_w)
    T_winding = T_0 + T_winding_minus_T_0
    T_magnet = T_0*np.exp(S_m/c_m)
    # transducer ratios
    n_gap = Bl
    # dissipative laws
    F_losses = d*v_cone
    V_copper = R_0*(1 + al*T_winding_minus_T_0)*i_coil
    s_contact = lam*(T_winding - T_magnet)/T_winding
    # heats
    heat_losses = F_losses*v_cone
    heat_copper = V_copper*i_coil
    heat_contact = s_contact*T_winding
    # rates
    rate_p = n_gap*i_coil - F_suspension - F_losses
    rate_phi = V_in - n_gap*v_cone - V_copper
    rate_S_w = heat_copper/T_winding - s_contact
    rate_S_m = (heat_losses + heat_contact)/T_magnet + h*(T_e/T_magnet - 1)
    # result
    out = np.empty((41, *x.shape[1:]))
    out[0] = F_suspension
    out[1] = v_cone
    out[2] = F_suspension*v_cone
    out[3] = k*q**2/2
    out[4] = rate_p
    out[5] = v_cone
    out[6] = rate_p*v_cone
    out[7] = p**2/(2*m)
    out[8] = F_losses
    out[9] = v_cone
    out[10] = F_losses*v_cone
    out[11] = F_losses*v_cone
    out[12] = rate_phi
    out[13] = i_coil
    out[14] = rate_phi*i_coil
    out[15] = phi**2/(2*L)
    out[16] = V_copper
    out[17] = i_coil
    out[18] = V_copper*i_coil
    out[19] = V_copper*i_coil
    out[20] = n_gap*v_cone
    out[21] = i_coil
    out[22] = -n_gap*i_coil
    out[23] = v_cone
    out[24] = n_gap*v_cone*i_coil
    out[25] = T_winding
    out[26] = rate_S_w
    out[27] = T_winding*rate_S_w
    out[28] = T_0*c_w*np.exp(S_w/c_w)
    out[29] = T_magnet
    out[30] = rate_S_m
    out[31] = T_magnet*rate_S_m
    out[32] = T_0*c_m*np.exp(S_m/c_m)
    out[33] = T_winding - T_magnet
    out[34] = s_contact*T_winding
    out[35] = T_magnet
    out[36] = -h*(T_e/T_magnet - 1)
    out[37] = -h*(T_e - T_magnet)
    out[38] = V_in
    out[39] = -i_coil
    out[40] = -i_coil*V_in
    return out


def jacobian(x, u, p_, /):
    """Jacobian of rhs, d rhs[i]/d x[j] at [i, j]; shape (n, n, *batch)."""
    x = _states(x, p_)
    u = _inputs(u)
    m = p_.m
    k = p_.k
    d = p_.d
    Bl = p_.Bl
    R_0 = p_.R_0
    al = p_.al
    L = p_.L
    c_w = p_.c_w
    c_m = p_.c_m
    lam = p_.lam
    h = p_.h
    T_0 = p_.T_0
    p = x[1]
    phi = x[2]
    S_w = x[3]
    S_m = x[4]
    T_e = u[1]
    # co-states dU/dx
    v_cone = p/m
    i_coil = phi/L
    T_winding_minus_T_0 = T_0*np.expm1(S_w/c_w)
    T_winding = T_0 + T_winding_minus_T_0
    T_magnet = T_0*np.exp(S_m/c_m)
    # transducer ratios
    n_gap = Bl
    # dissipative laws
    F_losses = d*v_cone
    V_copper = R_0*(1 + al*T_winding_minus_T_0)*i_coil
    s_contact = lam*(T_winding - T_magnet)/T_winding
    # heats
    heat_losses = F_losses*v_cone
    heat_copper = V_copper*i_coil
    heat_contact = s_contact*T_winding
    # derivatives
    dF_losses_dp = d/m
    dheat_losses_dp = v_cone*dF_losses_dp + F_losses/m
    dV_copper_dphi = R_0*(1 + al*T_winding_minus_T_0)/L
    dheat_copper_dphi = i_coil*dV_copper_dphi + V_copper/L
    dT_winding_minus_T_0_dS_w = T_winding/c_w
    dV_copper_dS_w = R_0*al*i_coil*dT_winding_minus_T_0_dS_w
    ds_contact_dS_w = (lam/T_winding - lam*(T_winding - T_magnet)/T_winding**2)*dT_winding_minus_T_0_dS_w
    dheat_copper_dS_w = i_coil*dV_copper_dS_w
    dheat_contact_dS_w = T_winding*ds_contact_dS_w + s_contact*dT_winding_minus_T_0_dS_w
    dT_magnet_dS_m = T_magnet/c_m
    ds_contact_dS_m = -lam/T_winding*dT_magnet_dS_m
    dheat_contact_dS_m = T_winding*ds_contact_dS_m
    # result
    out = np.zeros((x.shape[0], *x.shape))
    out[0, 1] = 1/m
    out[1, 0] = -k
    out[1, 1] = -dF_losses_dp
    out[1, 2] = n_gap/L
    out[2, 1] = -n_gap/m
    out[2, 2] = -dV_copper_dphi
    out[2, 3] = -dV_copper_dS_w
    out[3, 2] = dheat_copper_dphi/T_winding
    out[3, 3] = (
        dheat_copper_dS_w/T_winding
        - heat_copper/T_winding**2*dT_winding_minus_T_0_dS_w
        - ds_contact_dS_w
    )
    out[3, 4] = -ds_contact_dS_m
    out[4, 1] = dheat_losses_dp/T_magnet
    out[4, 3] = dheat_contact_dS_w/T_magnet
    out[4, 4] = (
        dheat_contact_dS_m/T_magnet
        + (-(heat_losses + heat_contact)/T_magnet**2 - h*T_e/T_magnet**2)*dT_magnet_dS_m
    )
    return out


def margins(x, u, p_, /):
    """Margin by which each condition of DOMAIN holds; of a bank, the least one; shape (len(DOMAIN), *batch)."""
    x = _states(x, p_)
    u = _inputs(u)
    m = p_.m
    k = p_.k
    d = p_.d
    R_0 = p_.R_0
    al = p_.al
    L = p_.L
    c_w = p_.c_w
    c_m = p_.c_m
    lam = p_.lam
    h = p_.h
    T_0 = p_.T_0
    S_w = x[3]
    T_e = u[1]
    # co-states dU/dx
    T_winding_minus_T_0 = T_0*np.expm1(S_w/c_w)
    # result
    out = np.empty((13, *x.shape[1:]))
    out[0] = d
    out[1] = R_0
    out[2] = al
    out[3] = lam
    out[4] = h
    out[5] = 1 + al*T_winding_minus_T_0
    out[6] = T_e
    out[7] = k
    out[8] = m
    out[9] = L
    out[10] = T_0
    out[11] = c_w
    out[12] = c_m
    return out
