"""Temperatures that a user gives: entropies are the states, temperatures are what is known.

Input: a state, and the temperature of a body.  Output: the entropy at which the body has it.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from piezo_sym.errors import UsageError
from piezo_sym.run.checks import FloatArray, positive
from piezo_sym.run.module import GeneratedModule


def put_temperature(
    module: GeneratedModule, p: Any, x: FloatArray, body: int, value: object, where: str
) -> int:
    """Put the entropy at which a body has a temperature [K] into x (n,), and return its row.

    Raises
    ------
    UsageError
        If the temperature is not positive, or no entropy gives it.
    """
    T = positive(value, where)
    row = entropy_row(module, p, x, body)
    x[row] = _entropy_at(module, p, x, body, row, T, where)
    return row


def entropy_row(module: GeneratedModule, p: Any, x: FloatArray, body: int) -> int:
    """Return the row that moves a body's temperature most, for equal relative moves."""
    step = 1e-6 * np.maximum(np.abs(x), 1.0)
    moved = module.temperatures(x[:, None] + np.diag(step), p)[body]
    return int(np.argmax(np.abs(moved - module.temperatures(x, p)[body])))


def _entropy_at(
    module: GeneratedModule, p: Any, x: FloatArray, body: int, row: int, T: float, where: str
) -> float:
    """Return the entropy [J/K] at which a body has the temperature T; it rises with the entropy."""
    from scipy.optimize import brentq  # loads slowly, and few runs ask for it

    def excess(entropy: float) -> float:
        y = x.copy()
        y[row] = entropy
        with np.errstate(over="ignore"):
            return float(np.log(module.temperatures(y, p)[body] / T))

    middle, reach = float(x[row]), 1e-3 * max(1.0, abs(float(x[row])))
    while excess(middle - reach) > 0 or excess(middle + reach) < 0:
        reach *= 2
        if not np.isfinite(reach):
            raise UsageError(f"{T:g} K is out of the body's reach", where)
    return float(brentq(excess, middle - reach, middle + reach, xtol=1e-300, rtol=1e-15))
