"""The step of the actuator, written by hand from its formulas: no part of the package is used.

Input: a state x = (q, p, Q_C, phi_1 ... phi_r, S), inputs u = (F_ext, V_in, T_e) at the middle of
the step, its length h.  Output: the state after it, and what it books.  With delta = DS/c_0:

    Tbar = T- expm1(delta)/delta        all other co-states at the middle, alpha = a Tbar/T_0
    Dq/h   = v
    Dp/h   = -k (q - q_l) - d v + alpha V_C + F_ext
    DQ_C/h = sum i_j - alpha v
    Dphi/h = V_in - V_C - W_j
    DS/h   = (d v^2 + sum W_j i_j)/Tbar + lam (T_e/Tbar - 1)

W_j is rho/(Tbar - T_0) deadzone(i, i_0) at the middle of the step.
"""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Table1:
    """The numbers of the paper's Table 1."""

    M: float = 3.5e-3
    k: float = 5e5
    q_l: float = 0.0
    d: float = 4e2
    C: float = 5e-6
    L: float = 1e-3
    rho: float = 10.0
    i_0: float = 0.5
    a: float = 10.0
    T_0: float = 296.15
    c_0: float = 5.0
    lam: float = 2.0


def dead_zone(i, width):
    """Return what a current has beyond the dead zone."""
    return np.sign(i) * np.maximum(np.abs(i) - width, 0.0)


def rates(x, new, u, p):
    """Return Dx/h, and the mean heats of damper and hysterons, for a step from x to new."""
    q, momentum, charge = (x[:3] + new[:3]) / 2
    i = (x[3:-1] + new[3:-1]) / 2 / p.L
    delta = (new[-1] - x[-1]) / p.c_0
    growth = np.expm1(delta) / delta if delta else 1.0
    hot = p.T_0 * np.exp(x[-1] / p.c_0) * growth
    v, voltage = momentum / p.M, charge / p.C
    alpha = p.a * hot / p.T_0
    law = p.rho / (hot - p.T_0) * dead_zone(i, p.i_0)
    heats = np.array([p.d * v * v, *(law * i)])
    force, supply, outside = u
    rows = [
        v,
        -p.k * (q - p.q_l) - p.d * v + alpha * voltage + force,
        i.sum() - alpha * v,
        *(supply - voltage - law),
        heats.sum() / hot + p.lam * (outside / hot - 1),
    ]
    return np.array(rows), heats, hot


def slopes(residual, x, scales):
    """Return the derivative of a residual by differences to both sides."""
    columns = []
    for n, size in enumerate(scales):
        ahead, behind = x.copy(), x.copy()
        ahead[n] += 1e-6 * size
        behind[n] -= 1e-6 * size
        columns.append((residual(ahead) - residual(behind)) / (ahead[n] - behind[n]))
    return np.array(columns).T


def step(x, u, h, p, scales, iterations=30):
    """Return the state after a step, the heats [J] and the entropies produced [J/K] in it."""

    def residual(new):
        return (new - x - h * rates(x, new, u, p)[0]) / scales

    new = x.copy()
    for _ in range(iterations):
        new = new - np.linalg.solve(slopes(residual, new, scales), residual(new))
    _, heats, hot = rates(x, new, u, p)
    return new, h * heats, h * heats / hot
