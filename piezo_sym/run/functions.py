"""A user's function of time as a signal, and the search for its jumps.

Input: a function of one time [s].  Output: an `InputFunction`, whose breaks are the first floats
after the jumps.  A pulse shorter than an interval of the search is found only by chance.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property
from math import isfinite, nextafter
from typing import Any, final

import numpy as np

from piezo_sym.errors import UsageError
from piezo_sym.run.checks import FloatArray, number
from piezo_sym.run.signals import Signal

#: The fewest steps of a run: how fast a function varies is unknown.
FUNCTION_STEPS = 500
#: An array of more times is passed to the function; this many of its values are compared with
#: calls for single times, and may differ by this part of the largest.
MANY, CHECKED, ROUNDING = 16, 40, 1e-12
#: Intervals of a run in the search for jumps.
INTERVALS = 2000
#: An interval is searched if the function changes in it by more than round-off (a part of its
#: largest value), and by more than 4 times the median of the changes nearby.
UNUSUAL, LEAST = 4.0, 1e-9
NEARBY = 4  # intervals on each side
#: A smooth function changes about equally in both halves of an interval; a jump lies in one.
SMOOTH = 0.7
#: A change within this part of an interval counts as a jump.
STEEP = 1e-6


@final
@dataclass(frozen=True)
class InputFunction(Signal):
    """A user's function of one time, called from `start` on, with arrays if it takes them."""

    function: Callable[[float], object]
    where: str
    start: float = 0.0

    def _values(self, t: FloatArray | float) -> FloatArray:
        times = np.asarray(t, dtype=float)
        values = self._at_once(times) if times.size > MANY else None
        if values is None:
            values = np.array([self.value(time) for time in times.ravel().tolist()])
        return values.reshape(times.shape)

    def _at_once(self, times: FloatArray) -> FloatArray | None:
        """Return the values of a function that takes arrays; None if it does not."""
        flat = times.ravel()
        try:
            with np.errstate(all="ignore"):
                function: Any = self.function
                values: FloatArray = np.array(function(flat.copy()), dtype=float)  # it may write
        except Exception:  # the user's own code: it may raise anything
            return None
        if values.shape != flat.shape or not np.all(np.isfinite(values)):
            return None
        size = np.abs(values).max()
        steepest = int(np.argmax(np.abs(np.diff(values))))
        some = {*np.linspace(0, flat.size - 1, CHECKED).astype(int).tolist()}
        some |= {steepest, steepest + 1, int(np.argmax(values)), int(np.argmin(values))}
        same = (abs(self.value(float(flat[n])) - values[n]) <= ROUNDING * size for n in some)
        return values if all(same) else None

    def value(self, time: float) -> float:
        """Return the value at one time; raise `UsageError` if it is no finite number."""
        try:
            value = self.function(time)
        except Exception as cause:  # the user's own code: it may raise anything
            what = f"the function fails at t = {time:.6g} s: {type(cause).__name__}: {cause}"
            raise UsageError(what, self.where, "a function of the time in s") from cause
        if type(value) is float and isfinite(value):  # which needs no name of its place
            return value
        return number(value, f"{self.where}({time:.6g})")

    @cached_property
    def _jumps(self) -> dict[float, tuple[float, ...]]:
        """The jumps found so far, by the end of the run."""
        return {}

    def _corners(self, duration: float) -> Iterable[float]:
        """Return the times of its jumps."""
        if duration not in self._jumps:
            self._jumps[duration] = jumps(self, self.start, duration)
        return self._jumps[duration]

    def max_step(self, duration: float) -> float:
        """Return the longest step [s]."""
        return (duration - self.start) / FUNCTION_STEPS


def jumps(function: Callable[[Any], Any], start: float, end: float) -> tuple[float, ...]:
    """Return the first times after the jumps of a function in (start, end), in order."""
    times = np.linspace(start, nextafter(end, start), INTERVALS + 1)
    values = function(times)
    changes = np.abs(np.diff(values))
    padded = np.pad(changes, NEARBY, mode="reflect")
    usual = np.median(np.lib.stride_tricks.sliding_window_view(padded, 2 * NEARBY + 1), axis=1)
    least = LEAST * np.max(np.abs(values))
    steep = np.flatnonzero((changes > UNUSUAL * usual) & (changes > least)).tolist()
    after = (_jump(function, times[k : k + 2], values[k : k + 2]) for k in steep)
    return tuple(time for time in after if time is not None)


def _jump(function: Callable[[Any], Any], ends: FloatArray, values: FloatArray) -> float | None:
    """Return the first time after a jump between two times, or None if there is none."""
    (a, b), (at_a, at_b) = map(float, ends), map(float, values)
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
