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
from piezo_sym.run.checks import FloatArray
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
AROUND = 2.0 ** np.array([-4.0, -12.0, -24.0, -40.0])
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
    brackets: list[_Bracket] = []
    if watched.stop:
        margin = stop_margin(system, watched, seen)
        goes_on = "" in watched.signs
        watched.signs[""] = float(np.sign(margin[-1]))
        if margin[0] > 0 and goes_on:  # an input jumps where the window before ends
            return Located({name: np.empty(0) for name in watched.event}, float(times[0]))
        if margin[0] > 0:
            what = f"the condition holds at t = {times[0]:g} s already"
            raise UsageError(what, "simulate.stop", "one that does not hold at the start")
        first = np.flatnonzero(margin > 0)[:1].tolist()
        pairs = (slice(k - 1, k + 1) for k in first)
        found = (("", watched.stop, times[pair], margin[pair]) for pair in pairs)
        brackets += [_Bracket(*values, closed=watched.closed) for values in found]
    for name, tree in watched.event.items():
        values = values_of(system, tree, seen)
        signs = _signs(np.append(watched.signs.get(name, 0.0), values))
        watched.signs[name] = float(signs[-1])
        changed = np.flatnonzero((signs[1:] != signs[:-1]) & (signs[:-1] != 0))
        ends = np.stack([np.maximum(changed - 1, 0), changed], axis=1)
        brackets += [_Bracket(name, tree, times[pair], values[pair]) for pair in ends]
    located = [(b.name, float(b.times[1])) for b in _narrow(system, brackets, run)]
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
    """Return the sign of each value; zero and nan take the sign of the value before."""
    signs: FloatArray = np.nan_to_num(np.sign(values))
    return signs[np.maximum.accumulate(np.where(signs != 0, np.arange(signs.size), 0))]


@final
@dataclass(frozen=True)
class _Bracket:
    """Two times [s] between which an expression changes its sign, and its values there."""

    name: str
    tree: Expr
    times: FloatArray
    values: FloatArray
    evenly: bool = False
    closed: bool = False

    def inner(self) -> FloatArray:
        """Return the times between the two to sample next."""
        first, last = self.times.tolist()
        low, high = self.values.tolist()
        ways = [np.linspace(first, last, EVEN + 2)]
        if not self.evenly and low * high < 0:
            zero = first + (last - first) * (low / (low - high))
            apart = (last - first) * AROUND
            ways.insert(0, np.concatenate([[zero], zero - apart, zero + apart]))
        inside = (np.unique(times[(times > first) & (times < last)]) for times in ways)
        return next((times for times in inside if times.size), np.empty(0))

    def narrow(self, times: FloatArray, values: FloatArray) -> Self:
        """Return the bracket between the two of these times where the sign changes."""
        first, last = np.searchsorted(times, self.times)
        times, values = times[first : last + 1], values[first : last + 1]
        values = _at_edge(values, closed=self.closed)
        signs = _signs(values)
        k = int(np.argmax(signs == signs[-1])) or times.size - 1
        evenly = times[k] - times[k - 1] > LITTLE * (times[-1] - times[0])
        pair = slice(k - 1, k + 1)
        return replace(self, times=times[pair], values=values[pair], evenly=bool(evenly))


def _narrow(system: DrivenModule, brackets: list[_Bracket], run: Sampler) -> list[_Bracket]:
    """Return brackets narrowed to neighbouring floats or round-off, all with the same runs."""
    for _ in range(ROUNDS):
        inner = [bracket.inner() for bracket in brackets]
        if not any(times.size for times in inner):
            break
        at = np.unique(np.concatenate([*inner, *(b.times for b in brackets)]))
        times, seen = run(at, at_last(at))
        values = {tree: values_of(system, tree, seen) for tree in {b.tree for b in brackets}}
        brackets = [b.narrow(times, values[b.tree]) for b in brackets]
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
