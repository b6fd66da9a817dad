"""The inputs of a run as signals, and its segments between their breaks.

Input: a mapping of names to numbers, (t, values), functions or signals.  Output: `Inputs`, whose
`segments` cover the run.  The inputs u (m,) do not jump within a segment: at its start they are the
limit from the right, at its end the limit from the left.
"""

import warnings
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property, lru_cache
from inspect import unwrap
from itertools import pairwise
from math import inf, nextafter
from typing import Any, TypeAlias, final

import numpy as np
from numpy.typing import ArrayLike

from piezo_sym.errors import InputWarning, UsageError, quote
from piezo_sym.run.checks import FloatArray, is_number, known_keys, number
from piezo_sym.run.functions import InputFunction
from piezo_sym.run.module import GeneratedModule, names_elsewhere
from piezo_sym.run.samples import ZERO_CELSIUS, Samples, read_samples
from piezo_sym.run.signals import Constant, Signal

InputValue: TypeAlias = float | Signal | tuple[ArrayLike, ArrayLike] | Callable[[float], float]

CLOSE = 1e-12  # fraction of the end time: breaks closer than this are merged
COLD, ROOM = 100.0, 200.0  # temperatures [K] below and above which degC may be meant for K
LEAST_JUMP = 1e-6  # of an input's size nearby: smaller differences are round-off of a corner


@final
@dataclass(frozen=True)
class Segment:
    """The time from start to stop [s], and the inputs in it, evaluated within [low, high]."""

    start: float
    stop: float
    low: float
    high: float
    base: FloatArray  # values of constant inputs (m,)
    varying: tuple[tuple[int, Signal], ...]  # rows and signals of the others

    def at(self, t: float) -> FloatArray:
        """Return the inputs u (m,) at one time."""
        return self.over(np.asarray(t))

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
    """A signal for each input of a module, over [start, start + duration]."""

    signals: tuple[Signal, ...]
    duration: float
    start: float = 0.0

    @property
    def end(self) -> float:
        """When the run ends [s]."""
        return self.start + self.duration

    @cached_property
    def segments(self) -> tuple[Segment, ...]:
        """Segments between breaks, in order; breaks closer than `CLOSE` are one."""
        groups = [[self.start]]
        times = {t for s in self.signals for t in s.breaks(self.end) if t > self.start}
        for t in (*sorted(times), self.end):
            if t - groups[-1][0] > CLOSE * self.end:
                groups.append([])
            groups[-1].append(t)
        return tuple(self.segment(a, b) for a, b in pairwise(groups))

    def segment(self, first: Sequence[float], last: Sequence[float]) -> Segment:
        """Return the segment between two groups of breaks that are each one."""
        stop = self.end if self.end in last else last[0]
        low = nextafter(first[-1], inf) if first[-1] > self.start else self.start
        base = np.array([s.value if isinstance(s, Constant) else 0.0 for s in self.signals])
        rows = enumerate(self.signals)
        varying = tuple((row, signal) for row, signal in rows if not isinstance(signal, Constant))
        return Segment(first[0], stop, low, nextafter(last[0], 0.0), base, varying)

    def at_samples(self, times: FloatArray) -> FloatArray:
        """Return the inputs (m, nt): at a jump those after it, but at the end those before it."""
        starts = np.array([segment.start for segment in self.segments])
        place = np.maximum(np.searchsorted(starts, times, side="right") - 1, 0)
        u = np.empty((len(self.signals), times.size))
        for n in np.unique(place):
            u[:, place == n] = self.segments[n].over(times[place == n])
        u[:, times >= self.end] = self.at_end[:, None]
        return u

    @cached_property
    def at_end(self) -> FloatArray:
        """The inputs (m,) at the end; at a jump, and of functions, at the number before it."""
        last = self.segments[-1]
        u = last.at(self.end)
        size = np.abs(last.over(np.linspace(last.start, last.stop, 5))).max(axis=1)
        for row, signal in last.varying:
            if not isinstance(signal, InputFunction):  # which may have no value at the end
                now = float(signal(self.end))
                u[row] = now if abs(now - u[row]) <= LEAST_JUMP * size[row] else u[row]
        return u

    @cached_property
    def jumps(self) -> frozenset[float]:
        """The start of the run, and of each segment before which an input jumps."""
        found = {self.start}
        for pair in pairwise(self.segments):
            # five times, the ends among them, show the size of the inputs
            before, after = (s.over(np.linspace(s.start, s.stop, 5)) for s in pair)
            size = np.maximum(np.abs(before).max(axis=1), np.abs(after).max(axis=1))
            if np.any(np.abs(after[:, 0] - before[:, -1]) > LEAST_JUMP * size):
                found.add(pair[1].start)
        return frozenset(found)

    @cached_property
    def max_step(self) -> float:
        """Longest step [s] of methods that sample every input once per step."""
        return min((signal.max_step(self.end) for signal in self.signals), default=inf)

    @cached_property
    def longest_step(self) -> float:
        """Longest step [s] of methods with several stages per step."""
        return min((signal.longest_step(self.end) for signal in self.signals), default=inf)


def read_inputs(
    module: GeneratedModule,
    given: Mapping[str, InputValue] | None,
    duration: float,
    start: float = 0.0,
) -> Inputs:
    """Return the inputs of a run; those not given keep the module's defaults."""
    names = [record.name for record in module.INPUTS]
    defaults = dict(zip(names, module.INPUT_DEFAULTS, strict=True))
    values = defaults | known_keys(
        given, names, "simulate.inputs", names_elsewhere(module, "inputs")
    )
    span = start, start + duration
    named = ((record, f"simulate.inputs.{record.name}") for record in module.INPUTS)
    signals = (read_signal(values[r.name], where, span, r.unit) for r, where in named)
    return Inputs(tuple(signals), duration, start)


def read_signal(value: object, where: str, span: tuple[float, float], unit: str) -> Signal:
    """Return a user's value of one input, in `unit`, as a signal over a span of time [s]."""
    signal = as_signal(value, where, span[0])
    if isinstance(signal, Samples) and signal.unit not in ("", unit):
        from piezo_sym.expressions.units import parse_unit

        if parse_unit(signal.unit).dimension != parse_unit(unit).dimension:
            what = f"the samples are in {signal.unit}{signal.source and f' ({signal.source})'}"
            raise UsageError(what, where, f"samples in {unit}")
    if isinstance(signal, Samples) and not signal.covers(*span):
        what = f"samples span {signal.times[0]:g} s to {signal.times[-1]:g} s"
        expected = f"samples that cover {span[0]:g} s to {span[1]:g} s"
        remedy = "no value is held before the first or after the last: add samples at both ends"
        raise UsageError(what, where, expected, f"{remedy}, or run within them (duration, t0)")
    return signal


def warn_undriven(module: GeneratedModule, before: Any, given: object) -> None:
    """Warn of inputs that are not given, if those of the run before differ from their defaults."""
    if not hasattr(before, "data_vars"):
        return
    left = [
        (r, default)
        for r, default in zip(module.INPUTS, module.INPUT_DEFAULTS, strict=True)
        if r.name not in (given if isinstance(given, Mapping) else ())
        and r.name in before  # the Dataset may have states alone
        and np.any(before[r.name] != default)
    ]
    for record, default in left:
        value = f"{default:g} {record.unit}, its default, from here on"
        text = f"input '{record.name}' is not given, so it is {value}"
        text += ": the run that goes on had other values; give it again to keep it"
        warnings.warn(text, InputWarning, stacklevel=6)


@lru_cache(maxsize=64)
def _unused(module: GeneratedModule) -> frozenset[str]:
    """Return the inputs that no port, condition or start has: nan for one changes nothing."""
    p, u = module.Parameters(), np.array(module.INPUT_DEFAULTS)
    used = set[str]()
    with np.errstate(all="ignore"), suppress(ArithmeticError):
        x = module.initial_state(u, p)
        for n, record in enumerate(module.INPUTS):
            v = np.where(np.arange(u.size) == n, np.nan, u)
            rows = module.supply(x, v, p), module.margins(x, v, p), module.initial_state(v, p)
            if np.isnan(np.concatenate(rows)).any():
                used.add(record.name)
        return frozenset(record.name for record in module.INPUTS) - used
    return frozenset()


def warn_given(module: GeneratedModule, given: object) -> None:
    """Warn of inputs that no element uses, and of temperatures that are meant in degC."""
    if not isinstance(given, Mapping):
        return
    unused = _unused(module)  # type: ignore[arg-type]  # modules are hashable
    defaults = dict(zip((r.name for r in module.INPUTS), module.INPUT_DEFAULTS, strict=True))
    for record in (record for record in module.INPUTS if record.name in given):
        name, value, text = record.name, given[record.name], ""
        if name in unused:
            text = f"{name}: no element uses this input"
        elif record.unit == "K" and is_number(value) and value < COLD and defaults[name] > ROOM:
            text = f"{name} = {value:g} K is {value - ZERO_CELSIUS:g} degC; "
            text += f"{value:g} degC is {value + ZERO_CELSIUS:g}"
        if text:
            warnings.warn(text, InputWarning, stacklevel=4)


def as_signal(value: object, where: str, start: float = 0.0) -> Signal:
    """Return a number, (t, values), function or signal as a signal of a run from `start` [s]."""
    if isinstance(value, Signal):
        return value
    if is_number(value):
        return Constant(number(value, where))
    if isinstance(value, tuple | list) and len(value) == 2:
        return read_samples(value[0], value[1], where)
    if callable(value) and not isinstance(unwrap(value), type):  # sine without its numbers
        return InputFunction(value, where, start)
    expected = "a number, (t, values), a function of t or a signal, such as sine(100.0, 50.0)"
    labels = "index" if hasattr(value, "iloc") else "time"  # of pandas, and of xarray
    remedy = f"give (x.{labels}, x.values)" if hasattr(value, "to_numpy") else ""
    raise UsageError(f"{quote(value)} is no input", where, expected, remedy)
