"""Events of a run: times at which expressions change sign, to round-off; and when it stops.

Input: what is watched, and a function that samples the run at any times.  Output: the times of
each event, and when the run stops.

A sample is a step of its own from the last accepted state, so more samples do not change the run:
it is sampled at the user's times, until the first of them at which it stops; then four times per
step, and again where signs change.  None of these runs goes on for long behind what is looked for.
"""

import warnings
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from math import inf
from typing import Any, Self, TypeAlias, final

import numpy as np

from piezo_sym.errors import InputWarning, UsageError, quote
from piezo_sym.expressions.floats import Floats
from piezo_sym.expressions.tree import Expr, names
from piezo_sym.run.checks import BoolArray, FloatArray
from piezo_sym.run.collocation import Ended, Later
from piezo_sym.run.dataset import Evaluation, Trajectory, attributes
from piezo_sym.run.module import rows
from piezo_sym.run.system import DrivenModule
from piezo_sym.run.watched import Watched, quantities

#: Returns the given times that the run reaches, and the run there.
Sampler: TypeAlias = Callable[[FloatArray, Ended | None], tuple[FloatArray, Trajectory]]
#: Samples to find changes of sign: per step, and the least number of them; the greatest is MOST, or
#: as many as have so many NUMBERS.
PER_STEP, LEAST, MOST, NUMBERS = 4, 1000, 20_000, 50_000_000
#: How the description of the times of an event begins.
EVENT = "times of event"
#: Samples inside a bracket in one pass: around the zero of the chord, at these fractions of the
#: bracket to either side; or evenly, where that did not narrow it by LITTLE. The most passes.
AROUND = np.array([side * 2.0**power for side in (-1, 1) for power in (-4, -12, -24, -40)] + [0.0])
AROUND.sort()
EVEN, LITTLE, ROUNDS = 63, 1 / 16, 24


@final
@dataclass(frozen=True)
class Located:
    """The times [s] of each event, and when the run ends early (None: it does not)."""

    times: Mapping[str, FloatArray]
    end: float | None


def values_of(system: DrivenModule, tree: Expr, trajectory: Trajectory) -> FloatArray:
    """Return the values (nt,) of an expression at the samples of a run; nan where it has none."""
    module, p, x, u = system.module, system.parameters, trajectory.states, trajectory.inputs
    given = zip(module.PARAMETERS, rows(module.PARAMETERS, p), strict=True)
    fixed = [
        value
        for record, row in given
        for value in np.broadcast_to(getattr(p, record.name), row.stop - row.start)
    ]
    values = [*x, *u, *module.outputs(x, u, p), *module.temperatures(x, p), *fixed]
    values += [*module.elements(x, u, p)] if any("." in name for name in names(tree)) else []
    known = dict(zip(quantities(system), values, strict=False))
    with np.errstate(all="ignore"):
        found = Floats(known.get, {}, {})[tree]
    return np.broadcast_to(np.where(found.lost, np.nan, found.value), x.shape[1:])


def at_last(times: FloatArray) -> Ended:
    """Return what ends a run behind the last of some samples."""
    return lambda t, _: t >= times[-1]


@final
class _Scout:
    """Looks among the samples of a run, as it goes on, for the first at which it stops.

    Attributes
    ----------
    looked : the time [s] of the last sample that it has looked at.
    end : the time of the first at which the run stops [s]; infinity so far.
    next : the time [s] from which it looks again.
    """

    def __init__(self, system: DrivenModule, watched: Watched) -> None:
        self.system, self.watched = system, watched
        self.looked, self.end, self.next = -inf, inf, -inf

    def ended(self, t: float, later: Later) -> bool:
        """Return whether the run stops at one of the samples that it has reached by t [s].

        It looks again when the run is a quarter longer.
        """
        if t >= self.next:
            self.next = t + (t - self.system.inputs.start) / 4
            self.look(*later(self.looked))
        return self.end < inf

    def look(self, times: FloatArray, seen: Trajectory) -> None:
        """Look at later samples than those before."""
        holds = np.flatnonzero(stop_margin(self.system, self.watched, seen) > 0)
        if holds.size:
            self.end = min(self.end, float(times[holds[0]]))
        self.looked = float(times[-1]) if times.size else self.looked


def stop_margin(system: DrivenModule, watched: Watched, seen: Trajectory) -> FloatArray:
    """Return at the samples of a run what is positive where it stops."""
    assert watched.stop is not None
    return _at_edge(values_of(system, watched.stop, seen), closed=watched.closed)


def locate(system: DrivenModule, watched: Watched, samples: FloatArray, run: Sampler) -> Located:
    """Return the times of the events of a run, and of its end."""
    start, end, times, scout = system.inputs.start, system.inputs.end, samples, None
    if watched.stop:
        scout = _Scout(system, watched)
        times = np.union1d(samples, np.linspace(start, end, LEAST))
    times, seen = run(times, scout and scout.ended)
    if scout:
        rest = np.flatnonzero(times > scout.looked)
        scout.look(times[rest], seen.at(rest))
        end = min(end, scout.end)
    even = np.linspace(start, end, _number(seen))
    times, seen = run(np.union1d(samples[samples <= end], even), at_last(even))
    brackets: list[_Brackets] = []
    if watched.stop:
        margin = stop_margin(system, watched, seen)
        goes_on = "" in watched.signs
        watched.signs[""] = float(np.sign(margin[-1]))
        if margin[0] > 0 and goes_on:  # an input jumps where the window before ends
            return Located({name: np.empty(0) for name in watched.event}, float(times[0]))
        if margin[0] > 0:
            what = f"the condition holds at t = {times[0]:g} s already"
            raise UsageError(what, "simulate.stop", "one that does not hold at the start")
        ends = np.flatnonzero(margin > 0)[:1, None] + [-1, 0]
        found = ("", watched.stop, times[ends], margin[ends], np.zeros(len(ends), bool))
        brackets.append(_Brackets(*found, closed=watched.closed))
    for name, tree in watched.event.items():
        values = values_of(system, tree, seen)
        signs = _signs(np.append(watched.signs.get(name, 0.0), values))
        watched.signs[name] = float(signs[-1])
        changed = np.flatnonzero((signs[1:] != signs[:-1]) & (signs[:-1] != 0))
        ends = np.maximum(changed[:, None] + [-1, 0], 0)
        brackets.append(_Brackets(name, tree, times[ends], values[ends], np.zeros(len(ends), bool)))
    located = [(b.name, t) for b in _narrow(system, brackets, run) for t in b.times[:, 1].tolist()]
    stop = next((t for name, t in located if not name), None)
    kept = [(name, t) for name, t in located if stop is None or t <= stop]
    times_of = {name: np.array([t for n, t in kept if n == name]) for name in watched.event}
    return Located(times_of, stop)


def _number(run: Trajectory) -> int:
    """Return at how many times to look for changes of sign in a run."""
    most = max(MOST, NUMBERS // (len(run.states) + len(run.integrals)))
    if most < run.steps:
        text = f"events are looked for at {most} times in {run.steps} steps, so some may be missed"
        warnings.warn(f"{text}; run shorter parts, or into a store", InputWarning, stacklevel=2)
    return min(max(PER_STEP * run.steps, LEAST), most)


def _at_edge(values: FloatArray, *, closed: bool) -> FloatArray:
    """Return values, positive in place of zero if the edge of a condition belongs to it."""
    return np.where(values == 0.0, np.finfo(float).tiny, values) if closed else values


def _signs(values: FloatArray) -> FloatArray:
    """Return the sign of each value (..., n); zero and nan take the sign of the value before."""
    signs: FloatArray = np.nan_to_num(np.sign(values))
    nonzero = np.where(signs != 0, np.arange(signs.shape[-1]), 0)
    return np.take_along_axis(signs, np.maximum.accumulate(nonzero, axis=-1), axis=-1)


@final
@dataclass(frozen=True)
class _Brackets:
    """Pairs of times [s] between which one expression changes its sign.

    Attributes
    ----------
    name, tree : of the event.
    times, values : of the expression, (n, 2).
    evenly : (n,), which of them to sample evenly next.
    closed : whether zero counts as positive.
    """

    name: str
    tree: Expr
    times: FloatArray
    values: FloatArray
    evenly: BoolArray
    closed: bool = False

    def inside(self, times: FloatArray) -> BoolArray:
        """Return which of the times (n, k) are between the two of their bracket."""
        return (times > self.times[:, :1]) & (times < self.times[:, 1:])

    def samples(self) -> FloatArray:
        """Return the times (n, EVEN + 2) in each bracket, its ends among them, to sample next."""
        (first, last), (low, high) = self.times.T[..., None], self.values.T[..., None]
        even = np.linspace(self.times[:, 0], self.times[:, 1], EVEN + 2, axis=1)
        with np.errstate(all="ignore"):
            zero = first + (last - first) * (low / (low - high))
            around = np.clip(zero + (last - first) * AROUND, first, last)
            chord = (low * high < 0) & ~self.evenly[:, None]
        chord &= self.inside(around).any(axis=1, keepdims=True)
        rest = np.repeat(last, EVEN + 1 - AROUND.size, axis=1)
        return np.where(chord, np.concatenate([first, around, rest], axis=1), even)

    def narrow(self, times: FloatArray, values: FloatArray) -> Self:
        """Return the brackets between those two of their times (n, k) where the sign changes."""
        values = _at_edge(values, closed=self.closed)
        signs = _signs(values)
        end = np.argmax(signs == signs[:, -1:], axis=1)
        end = np.where(end == 0, times.shape[1] - 1, end)
        pairs = np.arange(len(end))[:, None], np.stack([end - 1, end], axis=1)
        wide = np.diff(times[pairs]) > LITTLE * np.diff(self.times)
        return replace(self, times=times[pairs], values=values[pairs], evenly=wide[:, 0])


def _narrow(system: DrivenModule, brackets: list[_Brackets], run: Sampler) -> list[_Brackets]:
    """Return brackets narrowed to neighbouring floats or round-off, all with the same runs."""
    for _ in range(ROUNDS):
        each = [(bracket, bracket.samples()) for bracket in brackets]
        if not any(bracket.inside(times).any() for bracket, times in each):
            break
        # a run before got as far as the last of them, so all are reached
        at = np.unique(np.concatenate([times.ravel() for _, times in each]))
        _, seen = run(at, at_last(at))
        brackets = [
            bracket.narrow(times, values_of(system, bracket.tree, seen)[np.searchsorted(at, times)])
            for bracket, times in each
        ]
    return brackets


def event_variables(
    system: DrivenModule, located: Located, times: FloatArray, seen: Trajectory
) -> Iterator[tuple[str, Any]]:
    """Yield each event's times, a coordinate, and the states, inputs, outputs, temperatures."""
    for name, at in located.times.items():
        yield name, ((name,), at, attributes("s", f"{EVENT} {quote(name)}"))
        run = seen.at(np.searchsorted(times, at))
        for quantity, (dims, values, attrs) in Evaluation.of(system, run).instants():
            yield f"{quantity}_at_{name}", ((name, *dims[1:]), values, attrs)
