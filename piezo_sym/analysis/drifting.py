"""States that do not repeat after a period, for the messages of a search for steady states.

Input: a `Stroboscope`.  Output: which state drifts, and how far in a period.
"""

import warnings

import numpy as np

from piezo_sym.analysis.balance import TOLERANCE, SteadyWarning
from piezo_sym.analysis.stroboscope import Stroboscope
from piezo_sym.errors import RunError
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.module import row_name

PERIODS = 100  # from the start, after which a state that still changes is said to drift


def unsettled(strobe: Stroboscope) -> str:
    """Return which state changes most in a period, over its size, after `PERIODS` periods."""
    x = change = size = strobe.start
    for count in range(PERIODS):
        try:
            period = strobe.look(x)
        except RunError as error:
            return f"in period {count + 1} from the start, {error.what}"
        change, size, x = period.end - x, period.size, period.end
    row = int(np.argmax(np.abs(change) / size))
    return f"after {PERIODS} periods from the start, {_drift(strobe, row, change)}"


def warn_of_drift(strobe: Stroboscope, x: FloatArray) -> None:
    """Warn of each state that moves nothing and does not repeat, from the state x (n,)."""
    period = strobe.look(x)
    change = period.end - x
    for row in np.flatnonzero(~strobe.repeating & (np.abs(change) > TOLERANCE * period.size)):
        text = f"{_drift(strobe, int(row), change)}; no rate depends on it here, and all other"
        text = f"{text} states repeat: a run goes on so until a law depends on it"
        warnings.warn(text, SteadyWarning, stacklevel=4)


def _drift(strobe: Stroboscope, row: int, change: FloatArray) -> str:
    """Return how far a state drifts in a period, `change` being that of the states (n,)."""
    name = row_name(strobe.module.STATES, strobe.values, row)
    units = {record.name: record.unit for record in strobe.module.STATES}
    return f"'{name}' drifts by {change[row]:.6g} {units[name.partition('[')[0]]} a period"
