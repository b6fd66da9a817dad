"""Integration of dx/dt = rhs(x, u(t)) by SciPy's solvers, step by step.

Input: a `DrivenModule`, a segment of its inputs, the state x (n,) at its start and a `Tolerance`.
Output: the solver after each accepted step.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, final

import numpy as np

from piezo_sym.errors import RunError
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.inputs import Segment
from piezo_sym.run.system import DrivenModule

if TYPE_CHECKING:
    from scipy.integrate import OdeSolver

METHODS = ("RK23", "RK45", "DOP853", "Radau", "BDF", "LSODA")
IMPLICIT = ("Radau", "BDF", "LSODA")
MOST_STILL = 20  # the most steps in a row that do not change the time
#: The most steps of equal length in a row; their relative difference; the most that may be left.
MOST_EQUAL, SAME, MOST_LEFT = 200, 1e-3, 2000
NEAR = 1e-9  # fraction of the end time: LSODA cannot start closer to it
SHORTEST = 1e-12  # of a segment: the shortest first step after a failure


@final
@dataclass(frozen=True)
class Tolerance:
    """One of SciPy's methods, and its error bound rtol |x| + atol (n,)."""

    method: str
    rtol: float
    atol: FloatArray


def accepted_steps(
    system: DrivenModule, segment: Segment, x: FloatArray, tolerance: Tolerance
) -> Iterator[OdeSolver]:
    """Yield the solver of one segment after each accepted step; `nfev` includes all restarts.

    LSODA accepts trial states at which the laws are nan, and other solvers give up near one. So a
    step that fails is repeated from the last accepted state, ten times shorter. After a jump of the
    rates LSODA may take the short steps needed there for the rest of the run: then it is restarted.
    """
    span = trial = segment.stop - segment.start
    solver, rest, spent, still, equal = None, segment, 0, 0, 0
    while solver is None or solver.status == "running":
        try:
            solver = advance(solver or new_solver(system, rest, x, tolerance, trial, spent))
        except (ValueError, ArithmeticError, UserWarning) as cause:
            spent, trial, solver = solver.nfev if solver else spent, trial / 10, None
            if trial < SHORTEST * span:
                raise solver_error(system, tolerance, rest.start, str(cause)) from cause
        else:
            x, before, trial = solver.y.copy(), trial, float(solver.t) - rest.start
            equal = equal + 1 if abs(trial - before) < SAME * trial else 0
            still = 0 if trial else still + 1
            if still > MOST_STILL:
                raise solver_error(
                    system, tolerance, rest.start, "its steps are too short for the time"
                )
            rest = replace(segment, start=float(solver.t))
            yield solver
            least = max(MOST_LEFT * trial, NEAR * abs(rest.stop))  # too many more, or the end
            crawls = tolerance.method == "LSODA" and equal > MOST_EQUAL
            if crawls and rest.stop - rest.start > least:
                spent, trial, solver, equal = solver.nfev, span, None, 0


def advance(solver: OdeSolver) -> OdeSolver:
    """Return the solver after one step; raise its exception, or `ArithmeticError` if it fails."""
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
    module, p, more = system.module, system.parameters, dict[str, Any]()
    if tolerance.method in IMPLICIT:
        more["jac"] = lambda t, x: module.jacobian(x, segment.at(t), p)
    span = segment.stop - segment.start
    if trial < span:
        more["first_step"] = trial
    more |= {"rtol": tolerance.rtol, "atol": tolerance.atol}
    more["max_step"] = min(system.inputs.max_step, span)
    with np.errstate(all="ignore"):
        solver: OdeSolver = make(
            lambda t, x: module.rhs(x, segment.at(t), p), segment.start, x, segment.stop, **more
        )
    solver.nfev += evaluations
    return solver


def solver_error(system: DrivenModule, tolerance: Tolerance, t: float, reason: str) -> RunError:
    """Return the error of a solver that cannot go on."""
    what = f"solver {tolerance.method} cannot go on from t = {t:.6g} s: {reason.rstrip('.')}"
    remedy = "look at the inputs and the state there, try another method or rtol"
    return RunError(what, f"model '{system.module.NAME}'", remedy=remedy)
