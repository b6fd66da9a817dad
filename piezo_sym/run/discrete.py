"""Runs of the discrete gradient in C: both balances to round-off, order two, extrapolated to four.

Input: a `System`, its engine, the state x (n,) at t = 0 and the sample times.  Output: a
`Trajectory`.  With a step, one run of it.  With a tolerance, a mesh is fixed first; then two runs,
on the mesh and on its halves, each with a state of its own, so that its balances stay exact.
States are extrapolated from both; ledger and balances are those of the finer run.
"""

from __future__ import annotations

import ctypes
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import groupby, pairwise
from typing import TYPE_CHECKING, final

import numpy as np

from piezo_sym.errors import RunError
from piezo_sym.run.ledger import Trajectory, row_counts
from piezo_sym.run.scales import shared

if TYPE_CHECKING:
    from piezo_sym.run.checks import FloatArray
    from piezo_sym.run.engine import Engine
    from piezo_sym.run.inputs import Segment
    from piezo_sym.run.system import System

METHOD = "discrete_gradient"
#: Steps whose inputs are sampled together: memory stays small, and a run can be stopped.
CHUNK = 32_768
#: Intervals that a tolerance starts from, at least; how often one may be halved, first and at most.
FEWEST_STEPS = 128
FIRST_DEPTH, MOST_DEPTH = 4, 20
#: The finer run may be so much less accurate than the states extrapolated from it.
LOOSER = 5.0


@final
@dataclass(frozen=True)
class Interval:
    """A stretch of time with equal steps, and the sample at its end (-1 for none)."""

    segment: Segment
    start: float
    stop: float
    steps: int
    sample: int

    def cut(self, parts: int) -> Interval:
        """Return the interval with each step cut into parts."""
        return replace(self, steps=self.steps * parts)

    def pieces(self, number: int = 0) -> Iterator[Interval]:
        """Yield the interval in pieces: so many, or one a step; the sample is at the last."""
        number = number or self.steps
        if number == 1:
            yield self
            return
        edges = np.linspace(self.start, self.stop, number + 1)
        for n, (a, b) in enumerate(pairwise(edges)):
            sample = self.sample if n == number - 1 else -1
            yield Interval(self.segment, a, b, -(-self.steps // number), sample)


@final
@dataclass(frozen=True)
class Run:
    """One run at the sample times: states (n, nt), ledger (rows, nt), and its work."""

    states: FloatArray
    sums: FloatArray
    steps: int
    halvings: int
    iterations: int


def fixed(
    system: System, engine: Engine, x: FloatArray, times: FloatArray, step: float
) -> Trajectory:
    """Return a run with steps of at most `step`; they end at samples and at breaks of inputs.

    Raises
    ------
    RunError : a step has no solution inside the domain; the message says when.
    """
    run = _run(system, engine, x, times, _intervals(system, times, step))
    return _trajectory(system, x, times, run, run.states, run.steps)


def adaptive(
    system: System, engine: Engine, x: FloatArray, times: FloatArray, rtol: float
) -> Trajectory:
    """Return a run on a mesh that holds the error of each interval below rtol times a scale.

    A coarse run gives the scale of each state, its largest magnitude.  A pass from interval to
    interval then fixes the mesh by step doubling, and the pair runs on the mesh and on its halves.

    Raises
    ------
    RunError : a step has no solution inside the domain; the message says when.
    """
    base = _intervals(system, times, min(system.inputs.max_step, times[-1] / FEWEST_STEPS))
    intervals = [piece for interval in base for piece in interval.pieces()]
    rough = _run(system, engine, x, times, intervals)
    scale = shared(system, np.nanmax(np.abs(rough.states), axis=1))
    mesh = _mesh(system, engine, x, intervals, LOOSER * rtol * scale)
    coarse = _run(system, engine, x, times, mesh)
    fine = _run(system, engine, x, times, [interval.cut(2) for interval in mesh])
    states = fine.states + (fine.states - coarse.states) / 3
    return _trajectory(system, x, times, fine, states, coarse.steps + fine.steps)


def _mesh(
    system: System,
    engine: Engine,
    x: FloatArray,
    intervals: list[Interval],
    tolerance: FloatArray,
) -> list[Interval]:
    """Return intervals with as many steps as the tolerance asks for."""
    _, m, rows = row_counts(system)
    ports, rows = len(system.module.OUTPUTS), rows + engine.exchanges
    mesh: list[Interval] = []
    state, first, deepest = x.copy(), 0, FIRST_DEPTH
    while len(mesh) < len(intervals):
        part = intervals[len(mesh) : len(mesh) + max(1, CHUNK >> deepest)]
        cuts = [1 << level for level in range(deepest + 1)]
        u = np.concatenate([_middles(part, m, cut) for cut in cuts])
        lengths = np.array([interval.stop - interval.start for interval in part])
        levels = np.full(len(part), first, dtype=np.intc)
        done, failed = engine.plan(
            system.parameters, deepest, lengths, u, state, tolerance, levels, rows, ports
        )
        mesh += [i.cut(1 << int(n)) for i, n in zip(part, levels[:done], strict=False)]
        if failed:
            raise _stuck(system, part[done].start, state)
        first = int(levels[done - 1]) if done else first
        if done < len(part):
            deepest += 2
            if deepest > MOST_DEPTH:
                raise _stuck(system, part[done].start, state)
    return mesh


def _trajectory(
    system: System, x: FloatArray, times: FloatArray, run: Run, states: FloatArray, steps: int
) -> Trajectory:
    _, _, rows = row_counts(system)
    inputs = _inputs_at(system, times)
    return Trajectory(
        start=x,
        states=states,
        inputs=inputs,
        integrals=run.sums[:rows],
        steps=steps,
        evaluations=run.iterations,
        balanced=run.states,
        halvings=run.halvings,
    )


def _inputs_at(system: System, times: FloatArray) -> FloatArray:
    """Return the inputs at samples (m, nt): at a jump those after it, at the end those before."""
    segments = system.inputs.segments
    starts = np.array([segment.start for segment in segments])
    place = np.maximum(np.searchsorted(starts, times, side="right") - 1, 0)
    found = np.empty((len(system.module.INPUTS), times.size))
    for n in np.unique(place):
        found[:, place == n] = segments[n].over(times[place == n])
    return found


def _run(
    system: System,
    engine: Engine,
    x: FloatArray,
    times: FloatArray,
    intervals: Iterable[Interval],
) -> Run:
    """Return one run through intervals, from the state x (n,)."""
    _, m, rows = row_counts(system)
    ports = len(system.module.OUTPUTS)
    rows += engine.exchanges
    states, sums = np.full((x.size, times.size), np.nan), np.full((rows, times.size), np.nan)
    state, ledger = x.copy(), np.zeros(2 * rows)
    if times[0] == 0:
        states[:, 0], sums[:, 0] = state, 0.0
    counts, steps = (ctypes.c_long * 3)(), 0
    space = np.empty(2 * x.size + rows)
    for part in _chunks(intervals):
        u = _middles(part, m)
        sizes = np.array([interval.steps for interval in part], dtype=np.int_)
        lengths = np.array([(i.stop - i.start) / i.steps for i in part])
        ends, totals = np.empty((len(part), x.size)), np.empty((len(part), rows))
        done = engine.run(
            system.parameters, sizes, lengths, u, state, ledger, ends, totals, space, ports, counts
        )
        if done < len(part):
            failed = part[done]
            raise _stuck(system, failed.start + counts[2] * float(lengths[done]), state)
        kept = [n for n, interval in enumerate(part) if interval.sample >= 0]
        at = [part[n].sample for n in kept]
        states[:, at], sums[:, at] = ends[kept].T, totals[kept].T
        steps += int(sizes.sum())
    return Run(states, sums, steps, counts[0], counts[1])


def _intervals(system: System, times: FloatArray, step: float) -> Iterator[Interval]:
    """Yield intervals between samples and breaks of inputs, none much longer than a chunk."""
    for segment in system.inputs.segments:
        inner = times[(times > segment.start) & (times < segment.stop)]
        for start, stop in pairwise([segment.start, *inner, segment.stop]):
            at = int(np.searchsorted(times, stop))
            sample = at if at < times.size and times[at] == stop else -1
            steps = max(1, int(np.ceil((stop - start) / step * (1 - 1e-12))))
            whole = Interval(segment, start, stop, steps, sample)
            yield from whole.pieces(-(-steps // CHUNK))


def _chunks(intervals: Iterable[Interval]) -> Iterator[list[Interval]]:
    """Yield intervals in lists of about `CHUNK` steps."""
    part: list[Interval] = []
    held = 0
    for interval in intervals:
        part.append(interval)
        held += interval.steps
        if held >= CHUNK:
            yield part
            part, held = [], 0
    if part:
        yield part


def _middles(intervals: Sequence[Interval], m: int, cut: int = 1) -> FloatArray:
    """Return the inputs at the middle of each step, (steps, m), each step cut into equal parts."""
    parts = []
    for segment, group in groupby(intervals, key=lambda interval: interval.segment):
        own = list(group)
        steps = np.array([interval.steps * cut for interval in own])
        starts = np.array([interval.start for interval in own])
        lengths = np.array([interval.stop - interval.start for interval in own]) / steps
        first = np.repeat(np.cumsum(steps) - steps, steps)
        place = np.arange(steps.sum(), dtype=float) - first + 0.5
        times = np.repeat(starts, steps) + np.repeat(lengths, steps) * place
        parts.append(segment.over(times).T)
    return np.ascontiguousarray(np.concatenate(parts).reshape(sum(map(len, parts)), m))


def _stuck(system: System, t: float, x: FloatArray) -> RunError:
    """Return the error of a run that cannot go on."""
    names = [record.name for record in system.module.STATES]
    rows = system.rows(system.module.STATES)
    values = ", ".join(f"{n} = {x[row.start]:.6g}" for n, row in zip(names, rows, strict=True))
    what = f"{METHOD} cannot go on from t = {t:.6g} s at {values}: no step stays in the domain"
    remedy = "look at the inputs and the state there, or allow the state more room in [domain]"
    return RunError(what, f"model '{system.module.NAME}'", remedy=remedy)
