"""Runs of the discrete gradient in C: both balances to round-off, order two, extrapolated to four.

Input: a `System`, its engine, the state x (n,) at t = 0 and the sample times.  Output: a
`Trajectory`.  With a step, one run of it.  With a tolerance, runs whose steps are halved until the
extrapolated states of two pairs agree: each run starts from the same state and keeps its own, so
its balances stay exact; states are extrapolated, ledger and balances are those of the finest run.
"""

from __future__ import annotations

import ctypes
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, final

import numpy as np

from piezo_sym.errors import RunError
from piezo_sym.run.ledger import Trajectory, row_counts

if TYPE_CHECKING:
    from piezo_sym.run.checks import FloatArray
    from piezo_sym.run.engine import Engine
    from piezo_sym.run.inputs import Segment
    from piezo_sym.run.system import System

METHOD = "discrete_gradient"
#: Steps whose inputs are sampled together: memory stays small, and a run can be stopped.
CHUNK = 32_768
#: Steps of the first run that a tolerance asks for, at least, and the most halvings of them.
FEWEST_STEPS, MOST_LEVELS = 128, 24
MOST_STEPS = 2_000_000_000


@final
@dataclass(frozen=True)
class Interval:
    """A stretch of time with equal steps, and the sample at its end (-1 for none)."""

    segment: Segment
    start: float
    stop: float
    steps: int
    sample: int


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
    run = _run(system, engine, x, times, step)
    return _trajectory(system, x, times, run, run.states, run.steps)


def adaptive(
    system: System,
    engine: Engine,
    x: FloatArray,
    times: FloatArray,
    rtol: float,
    atol: FloatArray,
) -> Trajectory:
    """Return a run whose extrapolated states change by less than the tolerance on halving.

    Raises
    ------
    RunError : a step has no solution inside the domain, or the tolerance cannot be reached.
    """
    span = times[-1]
    step = min(system.inputs.max_step, span / FEWEST_STEPS)
    coarse, last, spent = _run(system, engine, x, times, step), None, 0
    for level in range(1, MOST_LEVELS):
        spent += coarse.steps
        fine = _run(system, engine, x, times, step, 2**level)
        states = fine.states + (fine.states - coarse.states) / 3
        if last is not None:
            most = np.maximum(np.abs(states), np.abs(last))
            if np.all(np.abs(states - last) <= rtol * most + atol[:, None]):
                return _trajectory(system, x, times, fine, states, spent + fine.steps)
        coarse, last = fine, states
        if fine.steps > MOST_STEPS // 2:
            break
    what = f"the tolerance {rtol:g} is not reached with {coarse.steps} steps"
    remedy = "allow a larger rtol, or give a fixed step"
    raise RunError(what, f"model '{system.module.NAME}'", remedy=remedy)


def _trajectory(
    system: System, x: FloatArray, times: FloatArray, run: Run, states: FloatArray, steps: int
) -> Trajectory:
    _, _, rows = row_counts(system)
    inputs = np.stack([_inputs_at(system, float(t)) for t in times], axis=1)
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


def _inputs_at(system: System, t: float) -> FloatArray:
    """Return the inputs at a sample: at a jump those after it, at the end those before."""
    segments = system.inputs.segments
    later = [segment for segment in segments if segment.start <= t]
    return (later or segments)[-1].at(t)


def _run(
    system: System, engine: Engine, x: FloatArray, times: FloatArray, step: float, parts: int = 1
) -> Run:
    """Return one run with steps of at most `step`, each of them cut into `parts`."""
    _, m, rows = row_counts(system)
    ports = len(system.module.OUTPUTS)
    rows += engine.exchanges
    states, sums = np.full((x.size, times.size), np.nan), np.full((rows, times.size), np.nan)
    state, ledger = x.copy(), np.zeros(2 * rows)
    if times[0] == 0:
        states[:, 0], sums[:, 0] = state, 0.0
    counts, steps = (ctypes.c_long * 3)(), 0
    space = np.empty(2 * x.size + rows)
    for part in _chunks(_intervals(system, times, step, parts)):
        u = np.concatenate([_middles(interval, m) for interval in part])
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


def _intervals(system: System, times: FloatArray, step: float, parts: int) -> Iterator[Interval]:
    """Yield intervals between samples and breaks of inputs, none of many more steps than a chunk."""
    for segment in system.inputs.segments:
        inner = times[(times > segment.start) & (times < segment.stop)]
        for start, stop in pairwise([segment.start, *inner, segment.stop]):
            at = int(np.searchsorted(times, stop))
            sample = at if at < times.size and times[at] == stop else -1
            steps = parts * max(1, int(np.ceil((stop - start) / step * (1 - 1e-12))))
            pieces = -(-steps // CHUNK)
            edges = np.linspace(start, stop, pieces + 1)
            for n, (a, b) in enumerate(pairwise(edges)):
                last = n == pieces - 1
                yield Interval(segment, a, b, -(-steps // pieces), sample if last else -1)


def _chunks(intervals: Iterator[Interval]) -> Iterator[list[Interval]]:
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


def _middles(interval: Interval, m: int) -> FloatArray:
    """Return the inputs at the middle of each step, (steps, m)."""
    length = (interval.stop - interval.start) / interval.steps
    t = interval.start + length * (np.arange(interval.steps, dtype=float) + 0.5)
    return np.ascontiguousarray(interval.segment.over(t).T).reshape(interval.steps, m)


def _stuck(system: System, t: float, x: FloatArray) -> RunError:
    """Return the error of a run that cannot go on."""
    names = [record.name for record in system.module.STATES]
    rows = system.rows(system.module.STATES)
    values = ", ".join(f"{n} = {x[row.start]:.6g}" for n, row in zip(names, rows, strict=True))
    what = f"{METHOD} cannot go on from t = {t:.6g} s at {values}: no step stays in the domain"
    remedy = "look at the inputs and the state there, or allow the state more room in [domain]"
    return RunError(what, f"model '{system.module.NAME}'", remedy=remedy)
