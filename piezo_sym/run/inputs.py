"""The inputs of a run: what a user wrote for each, as signals, and the segments between breaks.

Input: a mapping of names to numbers, (t, values), functions or signals.  Output: `Inputs`, whose
`segments` tile the run so that within each one the inputs u (m,) have no jump: at its start they
are the limit from the right, at its end the limit from the left.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from math import inf, nextafter
from typing import Any, TypeAlias, final

import numpy as np
from numpy.typing import ArrayLike

from piezo_sym.errors import UsageError, quote
from piezo_sym.run.checks import FloatArray, is_number, known_keys, number
from piezo_sym.run.jumps import jumps
from piezo_sym.run.module import GeneratedModule, others
from piezo_sym.run.samples import Samples, read_samples
from piezo_sym.run.signals import Constant, Signal, inside

InputValue: TypeAlias = float | Signal | tuple[ArrayLike, ArrayLike] | Callable[[float], float]

FUNCTION_STEPS = 500  # a function of t says nothing about itself: so many steps at least
CLOSE = 1e-12  # of the duration: breaks nearer than this are one
MANY, LOOKED_AT, ROUNDING = 16, 40, 1e-12  # arrays of so many; where, how well they are checked
LEAST_JUMP = 1e-6  # of an input's size nearby: a smaller difference is a corner's round-off


@final
@dataclass(frozen=True)
class Function(Signal):
    """A user's function of one time; where it takes an array of many, it is given these."""

    function: Callable[[float], object]
    where: str

    def __call__(self, t: FloatArray | float) -> FloatArray:
        """Return the values at the times t; shape of t."""
        times = np.asarray(t, dtype=float)
        values = self._at_once(times) if times.size > MANY else None
        if values is None:
            values = self._one_by_one(times.ravel().tolist())
        return values.reshape(times.shape)[()]

    def _one_by_one(self, times: list[float]) -> FloatArray:
        """Return the values; whatever is odd about one is told by `value`."""
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
        some = {*np.linspace(0, flat.size - 1, LOOKED_AT).astype(int).tolist()}
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

    def breaks(self, duration: float) -> tuple[float, ...]:
        """Return the times of the jumps that are found by asking."""
        if duration not in self._known:
            self._known[duration] = jumps(self, duration)
        return self._known[duration]

    def max_step(self, duration: float) -> float:
        """Return a small part of the run."""
        return duration / FUNCTION_STEPS


@final
@dataclass(frozen=True)
class Segment:
    """A stretch of time [start, stop] and the inputs in it, evaluated within [low, high]."""

    start: float
    stop: float
    low: float
    high: float
    base: FloatArray
    varying: tuple[tuple[int, Signal], ...]

    def at(self, t: float) -> FloatArray:
        """Return the inputs u (m,) at one time."""
        inner = min(max(t, self.low), self.high)
        u = self.base.copy()
        for row, signal in self.varying:
            u[row] = signal(inner)
        return u

    def over(self, t: FloatArray) -> FloatArray:
        """Return the inputs u (m, *shape of t) at many times."""
        inner = np.clip(t, self.low, self.high)
        u = np.empty((self.base.size, *t.shape))
        u[:] = self.base.reshape(-1, *(1,) * t.ndim)
        for row, signal in self.varying:
            u[row] = signal(inner)
        return u


@final
@dataclass(frozen=True)
class Inputs:
    """A signal for each input of a module, over [0, duration]."""

    signals: tuple[Signal, ...]
    duration: float

    @cached_property
    def segments(self) -> tuple[Segment, ...]:
        """Segments between breaks, in order; breaks that round to one another are one."""
        groups = [[0.0]]
        end = self.duration
        times = {t for signal in self.signals for t in inside(signal.breaks(end), end)}
        for t in (*sorted(times), end):
            if t - groups[-1][0] > CLOSE * end:
                groups.append([])
            groups[-1].append(t)
        return tuple(self.segment(a, b) for a, b in pairwise(groups))

    def segment(self, first: Sequence[float], last: Sequence[float]) -> Segment:
        """Return the segment between two groups of breaks."""
        stop = self.duration if self.duration in last else last[0]
        low = nextafter(first[-1], inf) if first[-1] > 0 else 0.0
        base = np.array([s.value if isinstance(s, Constant) else 0.0 for s in self.signals])
        varying = tuple(
            (row, s) for row, s in enumerate(self.signals) if not isinstance(s, Constant)
        )
        return Segment(first[0], stop, low, nextafter(last[0], 0.0), base, varying)

    def at_samples(self, times: FloatArray) -> FloatArray:
        """Return the inputs (m, nt): at a jump those after it, at the end those before."""
        starts = np.array([segment.start for segment in self.segments])
        place = np.maximum(np.searchsorted(starts, times, side="right") - 1, 0)
        found = np.empty((len(self.signals), times.size))
        for n in np.unique(place):
            found[:, place == n] = self.segments[n].over(times[place == n])
        return found

    @cached_property
    def jumps(self) -> frozenset[float]:
        """Starts of the segments before which an input jumps; 0, for a run starts anywhere."""
        pairs = pairwise(self.segments)
        return frozenset({0.0, *(later.start for first, later in pairs if jump(first, later))})

    @cached_property
    def max_step(self) -> float:
        """Longest step [s] that resolves every input."""
        return min((signal.max_step(self.duration) for signal in self.signals), default=inf)

    @cached_property
    def longest_step(self) -> float:
        """Longest step [s] that resolves every input by looking at it in several places."""
        return min((signal.longest_step(self.duration) for signal in self.signals), default=inf)


def jump(first: Segment, later: Segment) -> bool:
    """Return whether an input jumps between two segments, one after the other."""
    before, after = first.over(_places(first)), later.over(_places(later))
    size = np.maximum(np.abs(before).max(axis=1), np.abs(after).max(axis=1))
    return bool(np.any(np.abs(after[:, 0] - before[:, -1]) > LEAST_JUMP * size))


def _places(segment: Segment) -> FloatArray:
    """Return a few times that show how large the inputs of a segment are, its ends among them."""
    return np.linspace(segment.start, segment.stop, 5)


def read_inputs(
    module: GeneratedModule, given: Mapping[str, InputValue] | None, duration: float
) -> Inputs:
    """Return the inputs of a run; those not given keep the module's defaults.

    Raises
    ------
    UsageError : a name is unknown, or a value is not usable or does not cover [0, duration].
    """
    names = [record.name for record in module.INPUTS]
    defaults = dict(zip(names, module.INPUT_DEFAULTS, strict=True))
    values = defaults | known_keys(given, names, "simulate.inputs", others(module, "inputs"))
    signals = [read_signal(values[name], f"simulate.inputs.{name}", duration) for name in names]
    return Inputs(tuple(signals), duration)


def read_signal(value: object, where: str, duration: float) -> Signal:
    """Return what a user wrote for one input as a signal."""
    signal = as_signal(value, where)
    if isinstance(signal, Samples) and not signal.covers(duration):
        what = f"samples span {signal.times[0]:g} s to {signal.times[-1]:g} s"
        raise UsageError(what, where, f"samples that cover 0 s to {duration:g} s")
    return signal


def as_signal(value: object, where: str) -> Signal:
    """Return a number, (t, values), function or signal as a signal."""
    if isinstance(value, Signal):
        return value
    if is_number(value):
        return Constant(number(value, where))
    if isinstance(value, tuple | list) and len(value) == 2:
        return read_samples(value[0], value[1], where)
    if callable(value) and not isinstance(value, type):
        return Function(value, where)
    expected = "a number, (t, values), a function of t or a signal"
    what = f"{quote(value)} is no input"
    raise UsageError(what, where, expected)
