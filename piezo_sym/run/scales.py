"""The scale of each state, met in a coarse run, so that absolute tolerances fit their units.

Input: a `System` and the state x (n,) at t = 0.  Output: the largest magnitude of each state, and
the evaluations this took.  The coarse run never fails: where it stops, what it met counts.
"""

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from itertools import islice

import numpy as np

from piezo_sym.errors import PiezoError
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.inputs import Segment
from piezo_sym.run.integrate import Tolerance, accepted
from piezo_sym.run.system import System

FLOOR = 1e-15  # so that no tolerance is 0
RTOL, ATOL = 1e-3, 1e-2  # of the coarse run; ATOL is a part of the scale known so far
GROWTH = 10.0  # a state that outgrows its scale so much gets a new one
NEAR = 1e-9  # of a time: LSODA cannot start so near to its end
MOST_STEPS = 50_000
TRUSTED = 0.9


def magnitudes(system: System, x: FloatArray, most: int = MOST_STEPS) -> tuple[FloatArray, int]:
    """Return the scale of each state (n,), lanes of a bank sharing theirs, and the evaluations.

    The coarse run takes at most `most` steps. Where it stops early, its last states may be on
    their way to infinity: then only the first nine tenths of the time it reached count.
    """
    t, scale, evaluations = 0.0, shared(system, x), 0
    known = [(t, scale)]
    with suppress(PiezoError):
        for t, met, cost in islice(coarse_run(system, x), most):
            scale, evaluations = met, evaluations + cost
            if np.any(scale > 2 * known[-1][1]):
                known.append((t, scale))
    if t < system.inputs.duration * (1 - NEAR):
        scale = next(size for early, size in reversed(known) if early <= TRUSTED * t)
    return scale, evaluations


def shared(system: System, x: FloatArray) -> FloatArray:
    """Return the magnitudes of x (*batch, n), lanes of a bank at their maximum, none at 0."""
    scale = np.maximum(np.abs(x), FLOOR)
    for part in system.rows(system.module.STATES):
        scale[..., part] = np.max(scale[..., part], axis=-1, keepdims=True)
    return scale


def coarse_run(system: System, x: FloatArray) -> Iterator[tuple[float, FloatArray, int]]:
    """Yield time, scale met so far (n,) and cost of each step of a coarse run in the domain.

    Nothing is known about the scales at first, so LSODA starts again where a state has outgrown
    ten times the scale that its tolerance was made for.
    """
    scale = met = shared(system, x)
    for segment in system.inputs.segments:
        rest: Segment | None = segment
        while rest:
            solvers = accepted(system, rest, x, Tolerance("LSODA", RTOL, ATOL * scale))
            rest, spent = None, 0
            for solver in solvers:
                t, x, cost, spent = (
                    float(solver.t),
                    solver.y.copy(),
                    solver.nfev - spent,
                    solver.nfev,
                )
                if np.any(system.violated(x, segment.at(t))):
                    return
                met = np.maximum(met, shared(system, x))
                yield t, met, cost
                if np.any(met > GROWTH * scale) and t < segment.stop * (1 - NEAR):
                    scale, rest = met, replace(segment, start=t)
                    break
