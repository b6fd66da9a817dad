"""Runs by SciPy's solvers: as `simulate` gives them, coarse ones for scales, and to find causes.

Input: a `DrivenModule` and the state x (n,) at t = 0.  Output: a `Trajectory` and what it took; the
largest magnitude of each state, so that absolute tolerances fit its unit; or the error that says
why a run in C stopped.
"""

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from itertools import islice

import numpy as np

from piezo_sym.errors import PiezoError, RunError
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.collocation import Watch
from piezo_sym.run.inputs import Segment
from piezo_sym.run.integrate import Stretches, Tolerance, accepted, batches
from piezo_sym.run.ledger import Trajectory, record
from piezo_sym.run.system import DrivenModule

#: Absolute tolerances: this part of rtol times the scale of each state.
ATOL_FACTOR = 1e-3
#: Of the coarse run; ATOL is a part of the scale known so far.
RTOL, ATOL = 1e-3, 1e-2
GROWTH = 10.0  # a state that outgrows its scale so much gets a new one
NEAR = 1e-9  # of a time: LSODA cannot start so near to its end
MOST_STEPS = 50_000
TRUSTED = 0.9
#: How a run in C that stopped is looked at again: to find the cause, not to take its place.
LOOK_RTOL, LOOK_ATOL = 1e-8, 1e-11
MOST_LOOKED = 20_000


def by_scipy(
    system: DrivenModule,
    x: FloatArray,
    samples: FloatArray,
    method: str,
    rtol: float,
    watch: Watch | None = None,
) -> tuple[Trajectory, dict[str, object]]:
    """Return a run of one of SciPy's methods, and what it took; `watch` is told the time."""
    scale, spent = magnitudes(system, x)
    tolerance = Tolerance(method, rtol, rtol * ATOL_FACTOR * scale)
    trajectory = record(system, x, batches(system, x, samples, tolerance), samples, watch)
    work = {
        "method": method,
        "rtol": rtol,
        "accepted_steps": trajectory.steps,
        "rhs_evaluations": trajectory.evaluations,
        "scale_evaluations": spent,
    }
    return trajectory, work


def magnitudes(
    system: DrivenModule, x: FloatArray, most: int = MOST_STEPS
) -> tuple[FloatArray, int]:
    """Return the scale of each state (n,), lanes of a bank sharing theirs, and the evaluations.

    The coarse run takes at most `most` steps. Where it stops early, its last states may be on
    their way to infinity: then only the first nine tenths of the time it reached count.
    """
    start, duration = system.inputs.start, system.inputs.duration
    t, scale, evaluations = start, system.scale(x), 0
    known = [(t, scale)]
    with suppress(PiezoError):
        for t, met, cost in islice(coarse_run(system, x), most):
            scale, evaluations = met, evaluations + cost
            if np.any(scale > 2 * known[-1][1]):
                known.append((t, scale))
    if t - start < duration * (1 - NEAR):
        trusted = start + TRUSTED * (t - start)
        scale = next(size for early, size in reversed(known) if early <= trusted)
    return scale, evaluations


def coarse_run(system: DrivenModule, x: FloatArray) -> Iterator[tuple[float, FloatArray, int]]:
    """Yield time, scale met so far (n,) and cost of each step of a coarse run in the domain.

    Nothing is known about the scales at first, so LSODA starts again where a state has outgrown
    ten times the scale that its tolerance was made for.
    """
    scale = met = system.scale(x)
    for segment in system.inputs.segments:
        rest: Segment | None = segment
        while rest:
            solvers = accepted(system, rest, x, Tolerance("LSODA", RTOL, ATOL * scale))
            rest, spent = None, 0
            for solver in solvers:
                t, x = float(solver.t), solver.y.copy()
                cost, spent = solver.nfev - spent, solver.nfev
                if np.any(system.violated(x, segment.at(t))):
                    return
                met = np.maximum(met, system.scale(x))
                yield t, met, cost
                if np.any(met > GROWTH * scale) and t < segment.stop * (1 - NEAR):
                    scale, rest = met, replace(segment, start=t)
                    break


def cause(system: DrivenModule, x: FloatArray, samples: FloatArray, stopped: RunError) -> RunError:
    """Return why a run stopped: the condition that the state leaves, or else what it said itself.

    Steps shrink towards the edge of the domain and do not reach it.  LSODA goes over the edge, and
    so finds time and condition; where it finds none in its first steps, the run's own error stands.
    """
    scale, _ = magnitudes(system, x, MOST_LOOKED)
    tolerance = Tolerance("LSODA", LOOK_RTOL, LOOK_ATOL * scale)
    try:
        record(system, x, going(batches(system, x, samples, tolerance)), samples)
    except RunError as found:
        return found
    return stopped


def going(parts: Iterator[Stretches]) -> Iterator[Stretches]:
    """Yield batches for as long as a solver goes on, and not too long."""
    steps = 0
    try:
        for part in parts:
            yield part
            steps += part.steps
            if steps > MOST_LOOKED:
                return
    except RunError:
        return
