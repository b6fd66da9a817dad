"""Where a function of time jumps: it says nothing of itself, so it is asked.

Input: a function of time, and the length of a run.  Output: the first times after its jumps,
to the last digit, so that steps may end there.  A pulse shorter than the time between two questions
is seen only by chance.
"""

from collections.abc import Callable, Iterator
from math import nextafter
from typing import Any, TypeAlias

import numpy as np

from piezo_sym.run.checks import FloatArray

#: Of a time, or of many.
Asked: TypeAlias = Callable[[Any], Any]
#: How often the function is asked before a run.
QUESTIONS = 2000
#: A change is looked into if it is so many times the usual one nearby, and more than round-off.
UNUSUAL, LEAST = 4.0, 1e-9
NEARBY = 4
#: In the half of an interval that changes more, a smooth function changes by half as much.
SMOOTH = 0.7
#: What changes within so small a share of the time between two questions jumps, for all purposes.
STEEP = 1e-6


def jumps(function: Asked, duration: float) -> tuple[float, ...]:
    """Return the times in (0, duration) from which on a function has jumped, in order."""
    times = np.linspace(0.0, nextafter(duration, 0.0), QUESTIONS + 1)
    values = function(times)
    return tuple(_found(function, times, values))


def _found(function: Asked, times: FloatArray, values: FloatArray) -> Iterator[float]:
    changes = np.abs(np.diff(values))
    wide = np.pad(changes, NEARBY, mode="reflect")
    usual = np.median(np.lib.stride_tricks.sliding_window_view(wide, 2 * NEARBY + 1), axis=1)
    least = LEAST * np.max(np.abs(values))
    for k in np.flatnonzero((changes > UNUSUAL * usual) & (changes > least)).tolist():
        ends = (float(times[k]), float(times[k + 1]))
        found = _jump(function, ends, (float(values[k]), float(values[k + 1])))
        if found is not None:
            yield found


def _jump(function: Asked, ends: tuple[float, float], values: tuple[float, float]) -> float | None:
    """Return the first time after a jump between two times, or None if there is none."""
    (a, b), (at_a, at_b) = ends, values
    steep, change = STEEP * (b - a), abs(at_b - at_a)
    while a < (middle := 0.5 * (a + b)) < b:
        at_middle = float(function(middle))
        first, second = abs(at_middle - at_a), abs(at_b - at_middle)
        if max(first, second) < SMOOTH * change:
            return b if b - a < steep else None
        change = max(first, second)
        if first > second:
            b, at_b = middle, at_middle
        else:
            a, at_a = middle, at_middle
    return b
