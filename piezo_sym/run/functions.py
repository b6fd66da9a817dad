"""A user's function of time as a signal, and the search for its jumps.

Input: a function of one time [s].  Output: an `InputFunction`, whose breaks are the first times
after the jumps, to the last digit.  A pulse shorter than an interval of the search is found only by
chance.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property
from math import nextafter
from typing import Any, final

import numpy as np

from piezo_sym.errors import UsageError
from piezo_sym.run.checks import FloatArray, number
from piezo_sym.run.signals import Signal

#: So many steps of a run at least: a function says nothing about how fast it moves.
FUNCTION_STEPS = 500
#: Arrays of more times are given to the function at once; so many of its values are checked by
#: calls with one time each, and may differ by so much, as a part of the largest.
MANY, CHECKED, ROUNDING = 16, 40, 1e-12
#: Into how many intervals a run is divided in the search for jumps.
INTERVALS = 2000
#: A change over an interval is searched if it is so many times the median of its neighbours, and
#: more than round-off.
UNUSUAL, LEAST = 4.0, 1e-9
NEARBY = 4
#: Over one half of an interval a smooth function changes by about half as much as over all of it; a
#: jump is all in one half.
SMOOTH = 0.7
#: A change within so small a part of an interval counts as a jump.
STEEP = 1e-6


@final
@dataclass(frozen=True)
class InputFunction(Signal):
    """A user's function of one time, asked from `start` on, with arrays where it takes them."""

    function: Callable[[float], object]
    where: str
    start: float = 0.0

    def _values(self, t: FloatArray | float) -> FloatArray:
        times = np.asarray(t, dtype=float)
        values = self._at_once(times) if times.size > MANY else None
        if values is None:
            values = self._one_by_one(times.ravel().tolist())
        return values.reshape(times.shape)

    def _one_by_one(self, times: list[float]) -> FloatArray:
        """Return the values; `value` raises the error of one that is no finite number."""
        try:
            found = [self.function(time) for time in times]
            plain = {type(value) for value in found} <= {float, int, np.float64}
            values: FloatArray = np.array(found if plain else [], dtype=float)
        except Exception:  # the user's own code: it may raise anything
            plain = False
        if plain and np.all(np.isfinite(values)):
            return values
        return np.array([self.value(time) for time in times])

    def _at_once(self, times: FloatArray) -> FloatArray | None:
        """Return the values of a function that takes arrays; None of one that does not."""
        flat = times.ravel()
        try:
            with np.errstate(all="ignore"):
                given: Any = self.function
                found: FloatArray = np.array(given(flat.copy()), dtype=float)  # it may write there
        except Exception:  # the user's own code: it may raise anything
            return None
        if found.shape != flat.shape or not np.all(np.isfinite(found)):
            return None
        size = np.abs(found).max()
        steepest = int(np.argmax(np.abs(np.diff(found))))
        some = {*np.linspace(0, flat.size - 1, CHECKED).astype(int).tolist()}
        some |= {steepest, steepest + 1, int(np.argmax(found)), int(np.argmin(found))}
        same = (abs(self.value(float(flat[n])) - found[n]) <= ROUNDING * size for n in some)
        return found if all(same) else None

    def value(self, time: float) -> float:
        """Return the value at one time; raise `UsageError` if it is no finite number."""
        try:
            value = self.function(time)
        except Exception as cause:  # the user's own code: it may raise anything
            what = f"the function fails at t = {time:.6g} s: {type(cause).__name__}: {cause}"
            raise UsageError(what, self.where, "a function of the time in s") from cause
        return number(value, f"{self.where}({time:.6g})")

    @cached_property
    def _known(self) -> dict[float, tuple[float, ...]]:
        return {}

    def _corners(self, duration: float) -> Iterable[float]:
        """Return the times of its jumps."""
        if duration not in self._known:
            self._known[duration] = jumps(self, self.start, duration)
        return self._known[duration]

    def max_step(self, duration: float) -> float:
        """Return a small part of the run."""
        return (duration - self.start) / FUNCTION_STEPS


def jumps(function: Callable[[Any], Any], start: float, end: float) -> tuple[float, ...]:
    """Return the times in (start, end) from which on a function has jumped, in order."""
    times = np.linspace(start, nextafter(end, start), INTERVALS + 1)
    values = function(times)
    changes = np.abs(np.diff(values))
    padded = np.pad(changes, NEARBY, mode="reflect")
    usual = np.median(np.lib.stride_tricks.sliding_window_view(padded, 2 * NEARBY + 1), axis=1)
    least = LEAST * np.max(np.abs(values))
    steep = np.flatnonzero((changes > UNUSUAL * usual) & (changes > least)).tolist()
    found = (_jump(function, times[k : k + 2], values[k : k + 2]) for k in steep)
    return tuple(time for time in found if time is not None)


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
