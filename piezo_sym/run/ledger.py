"""The ledger of a run: power supplied, heat and entropy, integrated along the steps.

Input: batches of accepted steps.  Output: a `Trajectory`: states, inputs and the integrals

    supplied_port(t) = int_0^t y u dt
    heat_k(t) = int_0^t W_k z_k dt        produced_k(t) = int_0^t W_k z_k/T dt
    entropy_exchanged_a(t) = int_0^t lam (T_e - T)/T dt

at the sample times, by Gauss-Legendre quadrature on the interpolants between any two stops.
Batches pass through one at a time, so memory grows with the samples, not with the steps.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import final

import numpy as np
from numpy.typing import NDArray

from piezo_sym.errors import RunError
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.guard import crossing, domain_error, rate_error
from piezo_sym.run.inputs import Segment
from piezo_sym.run.integrate import Stretch, Stretches
from piezo_sym.run.module import exchanges, row_count
from piezo_sym.run.system import DrivenModule

NODES = 4  # exact to degree 7: above every interpolant's own order


@final
@dataclass(frozen=True)
class Trajectory:
    """A run at its sample times (nt,), and what it took."""

    start: FloatArray  # (n,): the state at t = 0
    states: FloatArray  # (n, nt)
    inputs: FloatArray  # (m, nt)
    #: (ports + 2 processes + exchanges, nt): supplied, heat, produced, exchanged
    integrals: FloatArray
    steps: int
    evaluations: int
    halvings: int = 0
    numerical: FloatArray | None = None  # (2, nt): heat and entropy that dissipative starts produce

    def at(self, places: NDArray[np.intp]) -> Trajectory:
        """Return some of the samples."""
        return replace(
            self,
            states=self.states[:, places],
            inputs=self.inputs[:, places],
            integrals=self.integrals[:, places],
            numerical=None if self.numerical is None else self.numerical[:, places],
        )

    def until(self, times: FloatArray) -> tuple[FloatArray, Trajectory]:
        """Return the times and samples of a run that has no more states."""
        missing = np.isnan(self.states).any(axis=0)
        count = int(np.argmax(missing)) if missing.any() else missing.size
        return times[:count], self.at(np.arange(count))


def record(
    system: DrivenModule,
    start: FloatArray,
    batches: Iterable[Stretches],
    times: FloatArray,
    watch: Callable[[float], object] | None = None,
) -> Trajectory:
    """Return the trajectory at `times` (nt,) of a run from `start` (n,) that comes in batches.

    `watch` is told the time that each begins from.
    """
    n, m, k = row_counts(system)
    states, inputs, integrals = (np.full((size, times.size), np.nan) for size in (n, m, k))
    total, steps, evaluations = np.zeros(k), 0, 0
    try:
        for batch in batches:
            steps, evaluations = steps + batch.steps, evaluations + batch.evaluations
            if not batch.stretches:
                continue
            if watch:
                watch(batch.stretches[0].start)
            x, u, error = looked_at(system, batch)
            run = total[:, None] + np.cumsum(increments(system, batch), axis=1)
            total = run[:, -1]
            places = np.concatenate([stretch.samples for stretch in batch.stretches])[: x.shape[1]]
            kept, at = places >= 0, places[places >= 0]
            states[:, at], inputs[:, at] = x[:, kept], u[:, kept]
            integrals[:, at] = run[:, : x.shape[1]][:, kept]
            if error:
                raise error
    except (RunError, KeyboardInterrupt) as stopped:
        found = Trajectory(start, states, inputs, integrals, steps, evaluations)
        vars(stopped)["reached"] = found.until(times)
        raise
    return Trajectory(start, states, inputs, integrals, steps, evaluations)


def row_counts(system: DrivenModule) -> tuple[int, int, int]:
    """Return the numbers of states, inputs and integrals."""
    module, p = system.module, system.parameters
    integrals = len(module.OUTPUTS) + 2 * row_count(module.PROCESSES, p) + len(exchanges(module))
    return row_count(module.STATES, p), len(module.INPUTS), integrals


def looked_at(
    system: DrivenModule, batch: Stretches
) -> tuple[FloatArray, FloatArray, RunError | None]:
    """Return states (n, k) and inputs (m, k) at a batch's stops in the domain, and why no more."""
    x = np.concatenate([stretch.path(stretch.stops) for stretch in batch.stretches], axis=1)
    stops = np.concatenate([stretch.stops for stretch in batch.stretches])
    u = batch.segment.over(stops)
    left = np.any(system.violated(x, u), axis=0)
    lost = ~np.all(system.finite(x, u), axis=0)
    if np.any(left | lost):
        k = int(np.argmax(left | lost))
        at = float(stops[k]), x[:, k], u[:, k]
        error = leaving(system, batch, k) if left[k] else rate_error(system, *at)
        return x[:, :k], u[:, :k], error
    return x, u, None


def leaving(system: DrivenModule, batch: Stretches, stop: int) -> RunError:
    """Return the error of a batch whose stop number `stop` is the first outside the domain."""
    for stretch in batch.stretches:
        if stop < stretch.stops.size:
            break
        stop -= stretch.stops.size
    left = float(stretch.stops[stop - 1]) if stop else stretch.start
    right = float(stretch.stops[stop])
    t = crossing(system, left, right, lambda t: point(stretch, batch.segment, t))
    return domain_error(system, t, *point(stretch, batch.segment, t))


def point(stretch: Stretch, segment: Segment, t: float) -> tuple[FloatArray, FloatArray]:
    """Return the state (n,) and the inputs (m,) at one time of a stretch."""
    return stretch.path(np.array([t]))[:, 0], segment.at(t)


def increments(system: DrivenModule, batch: Stretches) -> FloatArray:
    """Return the integrals between one stop and the next, (integrals, k)."""
    nodes, weights = np.polynomial.legendre.leggauss(NODES)
    states, times, lengths = [], [], []
    for stretch in batch.stretches:
        starts = np.concatenate([[stretch.start], stretch.stops[:-1]])
        length = stretch.stops - starts
        t = starts[:, None] + length[:, None] * (nodes + 1) / 2
        states.append(stretch.path(t.ravel()).reshape(-1, *t.shape))
        times.append(t)
        lengths.append(length)
    x, u = np.concatenate(states, axis=1), batch.segment.over(np.concatenate(times))
    mean: FloatArray = np.dot(system.rates(x, u), weights / 2)
    return np.concatenate(lengths) * mean
