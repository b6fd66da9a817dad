"""The right-hand side of the paper, eqs. (9)-(13), as one would write it in NumPy.

Independent of the generator: the yardstick for the generated ``rhs``.  Any number of hysterons r;
x = (q, p, Q_C, phi_1 ... phi_r, S) has shape (4 + r, *batch), u = (F_ext, V_in, T_e) shape
(3, *batch).
"""

import numpy as np

# Table 1
M, K, Q_L, D = 3.5e-3, 5e5, 0.0, 4e2
C, L, RHO, I_0 = 5e-6, 1e-3, 10.0, 0.5
A, T_0, C_0, LAM = 10.0, 296.15, 5.0, 2.0


def rhs(x, u):
    """Return dx/dt."""
    q, p, charge, flux, entropy = x[0], x[1], x[2], x[3:-1], x[-1]
    force, voltage, environment = u
    warming = T_0 * np.expm1(entropy / C_0)
    temperature = T_0 + warming
    alpha = A * temperature / T_0
    velocity = p / M
    across = charge / C
    current = flux / L
    dead_zone = current - np.clip(current, -I_0, I_0)
    resistance = RHO / warming * dead_zone
    loss = np.sum(resistance * current, axis=0) + D * velocity**2
    rates = np.empty_like(x)
    rates[0] = velocity
    rates[1] = -K * (q - Q_L) - D * velocity + alpha * across + force
    rates[2] = np.sum(current, axis=0) - alpha * velocity
    rates[3:-1] = voltage - across - resistance
    rates[-1] = loss / temperature + LAM * (environment / temperature - 1)
    return rates


def size(x, u):
    """Return the sum of the absolute terms of each row of `rhs`, to measure differences by."""
    q, p, charge, flux, entropy = (np.abs(part) for part in (x[0], x[1], x[2], x[3:-1], x[-1]))
    force, voltage, environment = np.abs(u)
    warming = T_0 * np.expm1(entropy / C_0)
    temperature = T_0 + warming
    alpha = A * temperature / T_0
    resistance = RHO / warming * np.maximum(flux / L - I_0, 0)
    sizes = np.empty_like(x)
    sizes[0] = p / M
    sizes[1] = K * q + D * p / M + alpha * charge / C + force
    sizes[2] = np.sum(flux, axis=0) / L + alpha * p / M
    sizes[3:-1] = voltage + charge / C + resistance
    loss = np.sum(resistance * flux / L, axis=0) + D * (p / M) ** 2
    sizes[-1] = loss / temperature + LAM * (environment / temperature + 1)
    return sizes
