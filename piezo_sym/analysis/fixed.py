"""The fixed point of a period near a state: Newton's method on the whole state.

Input: a `Stroboscope`, a frequency, a state x (n,) nearby.  Output: dP/dx, and the state for which

    P(x; f) = x
"""

import numpy as np

from piezo_sym.analysis.balance import NUDGE, solved
from piezo_sym.analysis.stroboscope import Stroboscope
from piezo_sym.run.checks import FloatArray

MOST_MOVES = 12


def whole_slope(strobe: Stroboscope, frequency: float, x: FloatArray) -> FloatArray:
    """Return dP/dx (n, n) in units of the states' sizes, by central differences."""
    size = strobe.look(x, frequency).size
    columns = []
    for row in range(x.size):
        step = np.zeros(x.size)
        step[row] = NUDGE * size[row]
        rise = strobe.look(x + step, frequency).end - strobe.look(x - step, frequency).end
        columns.append(rise / size / (2 * NUDGE))
    return np.array(columns).T


def closed(strobe: Stroboscope, frequency: float, x: FloatArray, slope: FloatArray) -> FloatArray:
    """Return the fixed point (n,) of a period near x, by Newton's method with one derivative."""
    matrix = slope - np.eye(x.size)
    error = np.inf
    for _ in range(MOST_MOVES):
        period = strobe.look(x, frequency)
        move = solved(matrix, (period.end - x) / period.size)
        if np.max(np.abs(move)) >= error:  # no better: at round-off
            break
        error = float(np.max(np.abs(move)))
        x = x - move * period.size
    return x
