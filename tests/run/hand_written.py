"""The paper's actuator in the interface of a generated module, written by hand.

Independent of the generator: from eqs. (9)-(13) and Table 1, with
x = (q, p, Q_C, phi_1 ... phi_r, S) and u = (F_ext, V_in, T_e).
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

NAME = "piezo_stack"
SPEC_SHA256 = "0" * 64


class Record(NamedTuple):
    """A row of an array: name, SI unit, one line on it, its bank if it has a row per lane."""

    name: str
    unit: str
    doc: str
    bank: str | None = None


class Condition(NamedTuple):
    """A condition of the domain: its text, and whether its margin must be > 0 (strict) or >= 0."""

    text: str
    strict: bool


STATES = (
    Record("q", "m", "extension of spring 'spring'"),
    Record("p", "kg*m/s", "momentum of mass 'mass'"),
    Record("Q_C", "C", "charge of capacitor 'capacitor'"),
    Record("phi", "Wb", "flux linkage of hysteron 'hysteron'", "hysteron"),
    Record("S", "J/K", "entropy of thermal_mass 'body'"),
)
INPUTS = (
    Record("F_ext", "N", "external force on the tip"),
    Record("V_in", "V", "supply voltage"),
    Record("T_e", "K", "temperature of the environment"),
)
INPUT_DEFAULTS = (0.0, 0.0, 298.15)
OUTPUTS = (  # one per port, conjugate to its input
    Record("load", "m/s", "velocity at force_source 'load'"),
    Record("supply", "A", "current out of voltage_source 'supply'"),
    Record("ambient", "K", "temperature of 'body'"),
)
ELEMENTS = ()
PROCESSES = (
    Record("hysteron", "W/K", "hysteron 'hysteron' heats 'body'", "hysteron"),
    Record("damper", "W/K", "damper 'damper' heats 'body'"),
)
BODIES = (Record("body", "K", "thermal_mass 'body'"),)
BANKS = ("hysteron",)  # sizes: Parameters.<bank>_count
PARAMETERS = (
    Record("M", "kg", "moving mass"),
    Record("k", "N/m", "stiffness"),
    Record("q_l", "m", "rest position of the spring"),
    Record("d", "N*s/m", "damping"),
    Record("C", "F", "capacitance"),
    Record("L", "H", "inductance of one hysteron", "hysteron"),  # bank: a value, or one per lane
    Record("rho", "ohm*K", "resistance law: slope rho/(T - T_0)", "hysteron"),
    Record("i_0", "A", "half width of the dead zone", "hysteron"),
    Record("a", "C/m", "transducer ratio at T_0"),
    Record("T_0", "K", "reference temperature"),
    Record("c_0", "J/K", "heat capacity"),
    Record("lam", "W/K", "heat conductance to the environment"),
)
DOMAIN = (
    Condition("T > T_0", True),
    Condition("T_e > T_0", True),
    Condition("d >= 0", False),
    Condition("rho >= 0", False),
    Condition("i_0 >= 0", False),
    Condition("lam >= 0", False),
    Condition("k > 0", True),
    Condition("M > 0", True),
    Condition("C > 0", True),
    Condition("L > 0", True),
    Condition("T_0 > 0", True),
    Condition("c_0 > 0", True),
)


@dataclass(frozen=True)
class Parameters:
    """Parameters of piezo_stack in SI units, with the spec's values."""

    M: float = 0.0035
    k: float = 500000.0
    q_l: float = 0.0
    d: float = 400.0
    C: float = 5e-06
    L: float | tuple[float, ...] = 0.001
    rho: float | tuple[float, ...] = 10.0
    i_0: float | tuple[float, ...] = 0.5
    a: float = 10.0
    T_0: float = 296.15
    c_0: float = 5.0
    lam: float = 2.0
    hysteron_count: int = 2


def _lanes(value, x):
    """A bank's parameter, one value or one per lane, shaped to meet lanes of shape (r, *batch)."""
    value = np.asarray(value, dtype=float)
    return value if value.ndim == 0 else value.reshape(-1, *(1,) * (x.ndim - 1))


def initial_state(u, p, /):
    """State at t = 0 for the inputs u (3,); shape (n,)."""
    u = np.asarray(u, dtype=float)
    r = p.hysteron_count
    x = np.zeros(4 + r)
    x[3 + r] = p.c_0 * np.log(u[2] / p.T_0)
    return x


def _unpack(x, u, p):
    x = np.asarray(x, dtype=float)
    u = np.asarray(u, dtype=float)
    r = p.hysteron_count
    return x, u, r


def rhs(x, u, p_, /):
    """dx/dt = J_ir dU/dx + g u, shape (n, *batch)."""
    x, u, r = _unpack(x, u, p_)
    q, p, Q_C, phi, S = x[0], x[1], x[2], x[3 : 3 + r], x[3 + r]
    F_ext, V_in, T_e = u[0], u[1], u[2]
    L = _lanes(p_.L, x)
    rho = _lanes(p_.rho, x)
    i_0 = _lanes(p_.i_0, x)
    F_spring = p_.k * (q - p_.q_l)
    v_mass = p / p_.M
    V_capacitor = Q_C / p_.C
    i_hysteron = phi / L
    T = p_.T_0 * np.exp(S / p_.c_0)
    T_above_T_0 = p_.T_0 * np.expm1(S / p_.c_0)
    ratio = p_.a * T / p_.T_0
    V_hysteron = rho / T_above_T_0 * (i_hysteron - np.clip(i_hysteron, -i_0, i_0))
    F_damper = p_.d * v_mass
    out = np.empty_like(x)
    out[0] = v_mass
    out[1] = -F_spring + ratio * V_capacitor - F_damper + F_ext
    out[2] = np.sum(i_hysteron, axis=0) - ratio * v_mass
    out[3 : 3 + r] = V_in - V_capacitor - V_hysteron
    out[3 + r] = (np.sum(V_hysteron * i_hysteron, axis=0) + F_damper * v_mass) / T + p_.lam * (
        T_e / T - 1
    )
    return out


def jacobian(x, u, p_, /):
    """d rhs/d x, shape (n, n, *batch)."""
    x, u, r = _unpack(x, u, p_)
    p, Q_C, phi, S = x[1], x[2], x[3 : 3 + r], x[3 + r]
    T_e = u[2]
    L = _lanes(p_.L, x)
    rho = _lanes(p_.rho, x)
    i_0 = _lanes(p_.i_0, x)
    v_mass = p / p_.M
    V_capacitor = Q_C / p_.C
    i_hysteron = phi / L
    T = p_.T_0 * np.exp(S / p_.c_0)
    dT = p_.T_0 * np.expm1(S / p_.c_0)
    dT_dS = T / p_.c_0
    ratio = p_.a * T / p_.T_0
    dratio_dS = p_.a * dT_dS / p_.T_0
    z = i_hysteron - np.clip(i_hysteron, -i_0, i_0)
    V_hysteron = rho / dT * z
    dV_di = np.where(np.abs(i_hysteron) > i_0, rho / dT, 0.0)
    dV_dS = -rho / dT**2 * z * dT_dS
    power = np.sum(V_hysteron * i_hysteron, axis=0) + p_.d * v_mass**2
    J = np.zeros((4 + r, *x.shape))
    J[0, 1] = 1 / p_.M
    J[1, 0] = -p_.k
    J[1, 1] = -p_.d / p_.M
    J[1, 2] = ratio / p_.C
    J[1, 3 + r] = dratio_dS * V_capacitor
    J[2, 1] = -ratio / p_.M
    J[2, 3 : 3 + r] = 1 / L
    J[2, 3 + r] = -dratio_dS * v_mass
    J[3 : 3 + r, 2] = -1 / p_.C
    lanes = 3 + np.arange(r)
    J[lanes, lanes] = -dV_di / L
    J[3 : 3 + r, 3 + r] = -dV_dS
    J[3 + r, 1] = 2 * p_.d * v_mass / p_.M / T
    J[3 + r, 3 : 3 + r] = (dV_di * i_hysteron + V_hysteron) / L / T
    J[3 + r, 3 + r] = (
        np.sum(dV_dS * i_hysteron, axis=0) / T - power / T**2 * dT_dS - p_.lam * T_e / T**2 * dT_dS
    )
    return J


def outputs(x, u, p_, /):
    """Conjugate outputs y, one per port, shape (3, *batch)."""
    x, u, r = _unpack(x, u, p_)
    y = np.empty((3, *x.shape[1:]))
    y[0] = x[1] / p_.M
    y[1] = np.sum(x[3 : 3 + r] / _lanes(p_.L, x), axis=0)
    y[2] = p_.T_0 * np.exp(x[3 + r] / p_.c_0)
    return y


def supply(x, u, p_, /):
    """Power put in through each port [W], shape (3, *batch)."""
    x, u, _ = _unpack(x, u, p_)
    y = outputs(x, u, p_)
    y[0] *= u[0]
    y[1] *= u[1]
    y[2] = p_.lam * (u[2] - y[2])
    return y


def energy(x, p_, /):
    """Hamiltonian U [J], shape (*batch)."""
    x, _, r = _unpack(x, (0, 0, 0), p_)
    q, p, Q_C, phi, S = x[0], x[1], x[2], x[3 : 3 + r], x[3 + r]
    return (
        p_.k * (q - p_.q_l) ** 2 / 2
        + p**2 / (2 * p_.M)
        + Q_C**2 / (2 * p_.C)
        + np.sum(phi**2 / (2 * _lanes(p_.L, x)), axis=0)
        + p_.T_0 * p_.c_0 * np.exp(S / p_.c_0)
    )


def entropy(x, p_, /):
    """Total entropy S [J/K], shape (*batch)."""
    x, _, r = _unpack(x, (0, 0, 0), p_)
    return x[3 + r]


def temperatures(x, p_, /):
    """Temperature of each body [K], shape (1, *batch)."""
    x, _, r = _unpack(x, (0, 0, 0), p_)
    return p_.T_0 * np.exp(x[3 + r : 4 + r] / p_.c_0)


def heat(x, u, p_, /):
    """Power W_k z_k [W] each process turns into heat; shape (r + 1, *batch)."""
    x, u, r = _unpack(x, u, p_)
    i = x[3 : 3 + r] / _lanes(p_.L, x)
    i_0 = _lanes(p_.i_0, x)
    dT = p_.T_0 * np.expm1(x[3 + r] / p_.c_0)
    out = np.empty((r + 1, *x.shape[1:]))
    out[:r] = _lanes(p_.rho, x) / dT * (i - np.clip(i, -i_0, i_0)) * i
    out[r] = p_.d * (x[1] / p_.M) ** 2
    return out


def entropy_production(x, u, p_, /):
    """Entropy that each process produces [W/K], of a bank a row per lane; shape (r + 1, *batch)."""
    return heat(x, u, p_) / temperatures(x, p_)


def elements(x, u, p_, /):
    """No quantities of elements."""
    del u, p_
    return np.empty((0, *np.shape(x)[1:]))


def margins(x, u, p_, /):
    """Left minus right side of each condition (least over lanes), shape (len(DOMAIN), *batch)."""
    x, u, r = _unpack(x, u, p_)
    out = np.empty((len(DOMAIN), *x.shape[1:]))
    out[0] = p_.T_0 * np.expm1(x[3 + r] / p_.c_0)
    out[1] = u[2] - p_.T_0
    out[2] = p_.d
    out[3] = np.min(p_.rho)
    out[4] = np.min(p_.i_0)
    out[5] = p_.lam
    out[6] = p_.k
    out[7] = p_.M
    out[8] = p_.C
    out[9] = np.min(p_.L)
    out[10] = p_.T_0
    out[11] = p_.c_0
    return out
