"""Runs by SciPy's solvers: for `simulate`, for the scales of states, and to explain errors in C.

Input: a `DrivenModule` and the state x (n,) at t = 0.  Output: a `Trajectory` and its work; the
largest magnitude of each state, for absolute tolerances; or the error that says why a run in C
stopped.

The ledger is integrated by Gauss-Legendre quadrature on the solver's interpolants, between
neighbouring ends of steps and samples.  Steps are evaluated in groups, so memory grows with the
samples, not with the steps.
"""

from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from itertools import islice
from typing import final

import numpy as np

from piezo_sym.errors import PiezoError, RunError
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.collocation import Ended, Watch
from piezo_sym.run.dataset import Trajectory
from piezo_sym.run.guard import crossing, domain_error, rate_error
from piezo_sym.run.inputs import Segment
from piezo_sym.run.integrate import NEAR, Tolerance, accepted_steps
from piezo_sym.run.system import DrivenModule

#: Absolute tolerances: this part of rtol times the scale of each state.
ATOL_FACTOR = 1e-3
NODES = 4  # of the quadrature, exact to degree 7: above the order of every interpolant
#: The most times, and numbers of states, in a group.
MOST_STOPS, MOST_NUMBERS = 512, 100_000
#: The tolerances of the coarse run; ATOL is a fraction of the scale found so far.
RTOL, ATOL = 1e-3, 1e-2
GROWTH = 10.0  # of a state over its scale, at which the coarse run restarts with a new scale
MOST_STEPS = 50_000
TRUSTED = 0.9
#: Tolerances and steps of the run that explains why a run in C stopped.
LOOK_RTOL, LOOK_ATOL = 1e-8, 1e-11
MOST_LOOKED = 20_000


@final
@dataclass(frozen=True)
class Path:
    """Accepted steps in one segment, with ends `edges`; or its start, the only edge."""

    segment: Segment
    edges: FloatArray
    states: Callable[[FloatArray], FloatArray]  # times (k,) to states (n, k)
    steps: int = 0
    evaluations: int = 0

    def groups(self, times: FloatArray, most: int) -> list[FloatArray]:
        """Return the ends of its steps, and the times that lie in them, at most so many in each."""
        inner = times[(times > self.edges[0]) & (times <= self.edges[-1])]
        stops = np.union1d(self.edges[1:], inner) if self.edges.size > 1 else self.edges
        return np.split(stops, range(most, stops.size, most))

    def point(self, t: float) -> tuple[FloatArray, FloatArray]:
        """Return the state (n,) and the inputs (m,) at one time."""
        return self.states(np.array([t]))[:, 0], self.segment.at(t)


def by_scipy(
    system: DrivenModule,
    x: FloatArray,
    samples: FloatArray,
    method: str,
    rtol: float,
    watch: Watch | None = None,
    ended: Ended | None = None,
) -> tuple[Trajectory, dict[str, object]]:
    """Return a run of one of SciPy's methods, and its work."""
    scale, spent = magnitudes(system, x)
    tolerance = Tolerance(method, rtol, rtol * ATOL_FACTOR * scale)
    trajectory = record(system, x, solver_paths(system, x, tolerance), samples, watch, ended)
    work = {
        "method": method,
        "rtol": rtol,
        "accepted_steps": trajectory.steps,
        "rhs_evaluations": trajectory.evaluations,
        "scale_evaluations": spent,
    }
    return trajectory, work


def record(
    system: DrivenModule,
    start: FloatArray,
    run: Iterator[Path],
    times: FloatArray,
    watch: Watch | None = None,
    ended: Ended | None = None,
) -> Trajectory:
    """Return the trajectory at `times` (nt,) of a run from `start` (n,); nan where it has `ended`.

    An error has the samples reached, and the last time of a step or a sample; `watch` gets the time
    [s] at which each path begins.
    """
    result = Trajectory.blank(system, start, times.size)
    total, most = np.zeros(len(result.integrals)), group_size(start)
    since, x = system.inputs.start, start
    try:
        for path in run:
            if ended and ended(since, partial(result.later, times, since)):
                break
            if watch:
                watch(since)
            steps, evaluations = result.steps + path.steps, result.evaluations + path.evaluations
            result = replace(result, steps=steps, evaluations=evaluations)
            for at in path.groups(times, most):
                sums = total[:, None] + np.cumsum(increments(system, path, since, at), axis=1)
                states, u = path.states(at), path.segment.over(at)
                valid = ~np.any(system.violated(states, u), axis=0)
                valid &= np.all(system.finite(states, u), axis=0)
                kept = np.isin(at, times) & (np.cumsum(~valid) == 0)
                places = np.searchsorted(times, at[kept])
                result.states[:, places] = states[:, kept]
                result.inputs[:, places] = system.inputs.at_samples(at[kept])
                result.integrals[:, places] = sums[:, kept]
                good = valid.size if valid.all() else int(np.argmin(valid))
                if good:
                    since, x, total = float(at[good - 1]), states[:, good - 1], sums[:, good - 1]
                if good < valid.size:
                    raise exit_error(system, path, since, float(at[good]))
    except (RunError, KeyboardInterrupt) as stopped:
        u = system.inputs.at_samples(np.array([since]))
        last = replace(result, states=x[:, None], inputs=u, integrals=total[:, None])
        vars(stopped)["reached"] = result.until(times, since, last)
        raise
    return result


def group_size(x: FloatArray) -> int:
    """Return the number of times in a group, for states x (n,)."""
    return max(1, min(MOST_STOPS, MOST_NUMBERS // x.size))


def exit_error(system: DrivenModule, path: Path, before: float, t: float) -> RunError:
    """Return the error of a run that leaves the domain between these times [s]."""
    if not np.any(system.violated(*path.point(t))):
        return rate_error(system, t, *path.point(t))
    t = crossing(system, before, t, path.point)
    return domain_error(system, t, *path.point(t))


def increments(system: DrivenModule, path: Path, since: float, stops: FloatArray) -> FloatArray:
    """Return the ledger's integrals (integrals, k) from `since` to the first stop, and so on."""
    nodes, weights = np.polynomial.legendre.leggauss(NODES)
    starts = np.append(since, stops[:-1])
    t = starts[:, None] + (stops - starts)[:, None] * (nodes + 1) / 2
    x = path.states(t.ravel()).reshape(-1, *t.shape)
    mean = np.dot(system.rates(x, path.segment.over(t)), weights / 2)
    return np.asarray((stops - starts) * mean)


def solver_paths(system: DrivenModule, x: FloatArray, tolerance: Tolerance) -> Iterator[Path]:
    """Yield a run from the state x (n,) at t = 0, in groups of steps.

    The start of each segment is a path of its own, so that its state and inputs are checked before
    a solver starts.
    """
    from scipy.integrate import OdeSolution

    most = group_size(x)
    for segment in system.inputs.segments:
        still = partial(lambda x, t: np.repeat(x, t.size, axis=1), x[:, None])
        yield Path(segment, np.array([segment.start]), still)
        solvers = accepted_steps(system, segment, x, tolerance)
        end, spent, failed = segment.start, 0, None
        while end < segment.stop and not failed:
            edges, parts, taken, before = [end], [], 0, spent
            try:
                for solver in islice(solvers, most):
                    x, spent, taken = solver.y.copy(), solver.nfev, taken + 1
                    end = segment.stop if solver.status == "finished" else float(solver.t)
                    if end > edges[-1]:  # not a step that leaves the time as it is
                        edges.append(end)
                        parts.append(solver.dense_output())
            except RunError as error:
                failed = error
            if parts:
                solution = OdeSolution(edges, parts)
                yield Path(segment, np.array(edges), solution, taken, spent - before)
        if failed:
            raise failed


def magnitudes(
    system: DrivenModule, x: FloatArray, most: int = MOST_STEPS
) -> tuple[FloatArray, int]:
    """Return the scale of each state (n,), one for all lanes of a bank, and the evaluations.

    The coarse run takes at most `most` steps. If it stops early, its last states may grow without
    bound: then only the first nine tenths of its time count.
    """
    start, duration = system.inputs.start, system.inputs.duration
    t, scale, evaluations = start, system.scale(x), 0
    known = [(t, scale)]
    with suppress(PiezoError):
        for t, largest, cost in islice(coarse_run(system, x), most):
            scale, evaluations = largest, evaluations + cost
            if np.any(scale > 2 * known[-1][1]):
                known.append((t, scale))
    if t - start < duration * (1 - NEAR):
        trusted = start + TRUSTED * (t - start)
        scale = next(size for early, size in reversed(known) if early <= trusted)
    return scale, evaluations


def coarse_run(system: DrivenModule, x: FloatArray) -> Iterator[tuple[float, FloatArray, int]]:
    """Yield time, scale so far (n,) and evaluations of each step of a coarse run in the domain.

    The scales are unknown at first, so LSODA restarts where a state exceeds ten times the scale of
    its tolerance.
    """
    scale = largest = system.scale(x)
    for segment in system.inputs.segments:
        rest: Segment | None = segment
        while rest:
            solvers = accepted_steps(system, rest, x, Tolerance("LSODA", RTOL, ATOL * scale))
            rest, spent = None, 0
            for solver in solvers:
                t, x = float(solver.t), solver.y.copy()
                cost, spent = solver.nfev - spent, solver.nfev
                if np.any(system.violated(x, segment.at(t))):
                    return
                largest = np.maximum(largest, system.scale(x))
                yield t, largest, cost
                if np.any(largest > GROWTH * scale) and t < segment.stop * (1 - NEAR):
                    scale, rest = largest, replace(segment, start=t)
                    break


def stop_cause(
    system: DrivenModule, x: FloatArray, samples: FloatArray, stopped: RunError
) -> RunError:
    """Return why a run in C stopped: the condition that the state violates, or else `stopped`.

    Steps in C shrink towards the edge of the domain and do not reach it. LSODA goes over the edge,
    and so finds the time and the condition.
    """
    scale, _ = magnitudes(system, x, MOST_LOOKED)
    tolerance = Tolerance("LSODA", LOOK_RTOL, LOOK_ATOL * scale)
    try:
        record(system, x, until_stuck(solver_paths(system, x, tolerance)), samples)
    except RunError as error:
        return error
    return stopped


def until_stuck(run: Iterator[Path]) -> Iterator[Path]:
    """Yield a run until its solver fails, or has taken `MOST_LOOKED` steps."""
    steps = 0
    with suppress(RunError):
        for path in run:
            yield path
            steps += path.steps
            if steps > MOST_LOOKED:
                return
