"""Integration of dx/dt = rhs(x, u(t)) by SciPy's solvers, step by step, restarted at input breaks.

Input: a `DrivenModule`, the state x (n,) at t = 0, the sample times and a `Tolerance`.  Output:
batches of accepted steps, each with its interpolant, the samples that lie in it, and its end.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Generator, Iterator
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any, final

import numpy as np
from numpy.typing import NDArray

from piezo_sym.errors import PiezoError, RunError
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.inputs import Segment
from piezo_sym.run.system import DrivenModule

if TYPE_CHECKING:
    from scipy.integrate import OdeSolver

METHODS = ("RK23", "RK45", "DOP853", "Radau", "BDF", "LSODA")
IMPLICIT = ("Radau", "BDF", "LSODA")
BATCH_NUMBERS = 100_000  # numbers of state that one batch may hold at its stops
MOST_STOPS = 512
MOST_STILL = 20  # steps in a row that do not change the time
SHORTEST = 1e-12  # of a segment: no step shorter than this is tried again


@final
@dataclass(frozen=True)
class Tolerance:
    """How a run is integrated: SciPy's method, and its error bound rtol |x| + atol (n,)."""

    method: str
    rtol: float
    atol: FloatArray


@final
@dataclass(frozen=True)
class Stretch:
    """Part of an accepted step: from `start` through its `stops` (k,), the samples and the end.

    `samples` (k,) is the place of each stop among the sample times, -1 for none; `path` maps
    times (k,) to states (n, k).
    """

    start: float
    stops: FloatArray
    samples: NDArray[np.intp]
    path: Callable[[FloatArray], FloatArray]

    def cut(self, most: int) -> Iterator[Stretch]:
        """Yield this stretch in pieces of at most `most` stops."""
        edges = [*range(0, self.stops.size, most), self.stops.size]
        for i, j in pairwise(edges):
            start = self.stops[i - 1] if i else self.start
            yield Stretch(start, self.stops[i:j], self.samples[i:j], self.path)


@final
@dataclass(frozen=True)
class Stretches:
    """Consecutive stretches of one segment, and the work they took."""

    segment: Segment
    stretches: tuple[Stretch, ...]
    steps: int
    evaluations: int


def batches(
    system: DrivenModule, x: FloatArray, times: FloatArray, tolerance: Tolerance
) -> Iterator[Stretches]:
    """Yield the run from the state x (n,) at t = 0, batch by batch.

    The start of each segment is a batch of its own, so that its state and inputs are looked at
    before a solver is.
    """
    for segment in system.inputs.segments:
        yield Stretches(segment, (start_stretch(segment, x, times),), 0, 0)
        x = yield from segment_batches(system, segment, x, times, tolerance)


def segment_batches(
    system: DrivenModule, segment: Segment, x: FloatArray, times: FloatArray, tolerance: Tolerance
) -> Generator[Stretches, None, FloatArray]:
    """Yield the accepted steps of one segment in batches; return the state at its end."""
    most = max(1, min(MOST_STOPS, BATCH_NUMBERS // x.size))
    pending: list[Stretch] = []
    steps = held = counted = spent = 0
    try:
        for solver in accepted(system, segment, x, tolerance):
            x, spent, steps = solver.y.copy(), solver.nfev, steps + 1
            for stretch in step_stretch(segment, solver, times).cut(most):
                pending.append(stretch)
                held += stretch.stops.size
                if held >= most:
                    yield Stretches(segment, tuple(pending), steps, spent - counted)
                    pending, held, steps, counted = [], 0, 0, spent
    except PiezoError:
        yield Stretches(segment, tuple(pending), steps, spent - counted)
        raise
    yield Stretches(segment, tuple(pending), steps, spent - counted)
    return x


def start_stretch(segment: Segment, x: FloatArray, times: FloatArray) -> Stretch:
    """Return the start of a segment as a stretch of no length."""
    at = int(np.searchsorted(times, segment.start))
    sampled = at < times.size and times[at] == segment.start
    stops, samples = np.array([segment.start]), np.array([at if sampled else -1])
    return Stretch(segment.start, stops, samples, lambda t: np.tile(x[:, None], t.size))


def step_stretch(segment: Segment, solver: OdeSolver, times: FloatArray) -> Stretch:
    """Return the solver's last step: samples in it, then its end.

    A sample at the end of a segment is taken again at the next one's start, with its inputs.
    """
    end = segment.stop if solver.status == "finished" else float(solver.t)
    first, last = np.searchsorted(times, [solver.t_old, end], side="right")
    inner = times[first:last]
    samples = np.arange(first, last)
    if not inner.size or inner[-1] < end:
        inner, samples = np.append(inner, end), np.append(samples, -1)
    return Stretch(float(solver.t_old), inner, samples, solver.dense_output())


def accepted(
    system: DrivenModule, segment: Segment, x: FloatArray, tolerance: Tolerance
) -> Iterator[OdeSolver]:
    """Yield the solver of one segment after each step it accepts; `nfev` counts on over restarts.

    LSODA takes a trial state where the laws give nan for an answer, and other solvers give up
    near one. So a step that fails is tried again from the last good state, ten times shorter.
    """
    span = trial = segment.stop - segment.start
    solver, rest, spent, still = None, segment, 0, 0
    while solver is None or solver.status == "running":
        try:
            solver = advanced(solver or new_solver(system, rest, x, tolerance, trial, spent))
        except (ValueError, ArithmeticError, UserWarning) as cause:
            spent, trial, solver = solver.nfev if solver else spent, trial / 10, None
            if trial < SHORTEST * span:
                raise stopped(system, tolerance, rest.start, str(cause)) from cause
        else:
            x, trial = solver.y.copy(), float(solver.t) - rest.start
            still = 0 if trial else still + 1
            if still > MOST_STILL:
                raise stopped(system, tolerance, rest.start, "its steps are too short for the time")
            rest = replace(segment, start=float(solver.t))
            yield solver


def advanced(solver: OdeSolver) -> OdeSolver:
    """Return the solver one step on; raise what it raises, or `ArithmeticError` with its reason."""
    with np.errstate(all="ignore"), warnings.catch_warnings():
        warnings.filterwarnings("error", message="lsoda")
        reason = solver.step()
    if reason or not np.all(np.isfinite(solver.y)):
        raise ArithmeticError(reason or "the next state is not finite")
    return solver


def new_solver(
    system: DrivenModule,
    segment: Segment,
    x: FloatArray,
    tolerance: Tolerance,
    trial: float,
    evaluations: int,
) -> OdeSolver:
    """Return SciPy's solver at the start of a segment, its first step no longer than `trial`."""
    import scipy.integrate

    make: Any = getattr(scipy.integrate, tolerance.method)
    more: dict[str, Any] = {"jac": system.slope(segment)} if tolerance.method in IMPLICIT else {}
    span = segment.stop - segment.start
    if trial < span:
        more["first_step"] = trial
    more |= {"rtol": tolerance.rtol, "atol": tolerance.atol}
    more["max_step"] = min(system.inputs.max_step, span)
    with np.errstate(all="ignore"):
        solver: OdeSolver = make(system.field(segment), segment.start, x, segment.stop, **more)
    solver.nfev += evaluations
    return solver


def stopped(system: DrivenModule, tolerance: Tolerance, t: float, reason: str) -> RunError:
    """Return the error of a solver that cannot go on."""
    what = f"solver {tolerance.method} cannot go on from t = {t:.6g} s: {reason.rstrip('.')}"
    remedy = "look at the inputs and the state there, try another method or rtol"
    return RunError(what, f"model '{system.module.NAME}'", remedy=remedy)
