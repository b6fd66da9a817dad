"""The groups of `piezo-sym bench`: rates of one state and of many, and runs at equal error.

Input: a `Model` and its inputs.  Output: a `BenchReport`.  The error of a rate is its difference
from SymPy in 30 digits, over the largest value of its row.  That of a run is its difference at the
end from a run with a tight tolerance, confirmed by a second solver, over the largest magnitude of
each state.  All calls are timed in one process, in turns, so that the ratios hold on a busy
machine, too.
"""

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from time import perf_counter
from typing import Any, final

import numpy as np
import sympy as sp

from piezo_sym.bench.contest import Comparison, Contestant, Pair, compared
from piezo_sym.bench.problem import INSTANT, Problem, batch, field, problem_of, solver
from piezo_sym.errors import EngineError, PiezoError, RunError, UsageError, nearest, quote
from piezo_sym.run import simulate
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.collocation import METHOD
from piezo_sym.run.engine.engine import engine_of
from piezo_sym.run.inputs import InputValue
from piezo_sym.run.signals import Constant
from piezo_sym.spec.model import Model

MANY, CHECKED, DIGITS = 10_000, 8, 30
#: The error to which runs are tuned, the tolerances that are tried, and for how long [s].
TARGET, LADDER, PATIENCE = 1e-6, tuple(float(f"1e-{n}") for n in range(2, 13)), 60.0
#: A reference and the run that confirms it; SCIPY where the discrete gradient fails.
OWN, SCIPY = ((METHOD, 1e-9), ("LSODA", 1e-10)), (("LSODA", 1e-12), ("LSODA", 1e-10))
MEASURE = "of a rate, against 30 digits, in units of the row's largest"


@final
@dataclass(frozen=True)
class BenchReport:
    """The comparisons, and the reason for each that was left out."""

    model: str
    rows: tuple[Comparison, ...] = ()
    left_out: tuple[str, ...] = ()

    @property
    def notes(self) -> tuple[str, ...]:
        """How errors are measured, the tolerances, and what was left out: one line each."""
        measures = {f"errors of {row.group}: {row.measure}": None for row in self.rows}
        noted = {f"{row.group}, {row.other}: {row.note}": None for row in self.rows if row.note}
        return (*measures, *noted, *(f"left out: {line}" for line in self.left_out))


def bench(
    model: Model,
    *,
    inputs: Mapping[str, InputValue] | None = None,
    duration: float = 0.1,
    only: Sequence[str] = (),
    rounds: int = 5,
    say: Callable[[str], None] = lambda _: None,
) -> BenchReport:
    """Measure a model, and return the report.

    Parameters
    ----------
    inputs : constants and sines; those left out have the spec's defaults, but the shipped actuator
        100 V at 100 Hz.
    duration : of a run [s].
    only : names of groups; all when empty.
    rounds : the number of times that every call is timed.
    say : called with the name of each group before it is measured.
    """
    names = tuple(dict.fromkeys(only)) or tuple(GROUPS)
    for name in names:
        if name not in GROUPS:
            raise UsageError(f"no group {quote(name)}", "--only", remedy=nearest(name, GROUPS))
    problem = problem_of(model, inputs or {}, duration)
    rows: list[Comparison] = []
    left_out: list[str] = []
    signals = problem.system.inputs.signals
    if "run" in names and signals and all(isinstance(signal, Constant) for signal in signals):
        left_out.append("a drive of the run: its inputs are constant; give sines (-i)")
    for name in names:
        say(name)
        try:
            rows += GROUPS[name](problem, rounds, left_out)
        except (EngineError, RunError) as error:
            left_out.append(f"{name}: {error}")
    return BenchReport(model.name, tuple(rows), tuple(left_out))


def _rhs(problem: Problem, rounds: int, left_out: list[str]) -> tuple[Comparison, ...]:
    x = _path(problem, ("LSODA", 1e-5), 201)[:, 100]
    usual = {
        "lambdified SymPy (numpy)": partial(field(problem), INSTANT),
        "lambdified SymPy (math, cse)": partial(field(problem, "math", cse=True), INSTANT),
    }
    return _rates("rhs", problem, x, usual, rounds, left_out)


def _batch(problem: Problem, rounds: int, left_out: list[str]) -> tuple[Comparison, ...]:
    path = _path(problem, ("LSODA", 1e-5), 201)
    x = path[:, np.random.default_rng(0).integers(path.shape[1], size=MANY)]
    usual = {"lambdified SymPy (numpy)": batch(problem)}
    return _rates(f"batch of {MANY}", problem, x, usual, rounds, left_out)


def _rates(
    group: str,
    problem: Problem,
    x: FloatArray,
    usual: Mapping[str, Callable[[FloatArray], object]],
    rounds: int,
    left_out: list[str],
) -> tuple[Comparison, ...]:
    """Return the rows for rates of x (n,) or (n, columns), compared with the usual functions."""
    u = np.array([float(signal(INSTANT)) for signal in problem.system.inputs.signals])
    ours: dict[str, Any] = {"generated NumPy": problem.module.rhs}
    try:
        ours["generated C"] = engine_of(problem.module).rhs
    except EngineError as error:
        left_out.append(f"{group}, generated C: {error}")
    columns = x.reshape(len(x), -1)
    exact = np.array([_precise(problem, column) for column in columns.T[:CHECKED]]).T
    p = problem.system.parameters
    size = np.max(np.abs(problem.module.rhs(columns, u, p)), axis=1, keepdims=True)

    def contestant(name: str, call: Callable[[], object]) -> Contestant:
        rates = np.asarray(call()).reshape(columns.shape)[:, :CHECKED]
        error = float(np.max(np.abs(rates - exact) / np.where(size > 0, size, 1.0)))
        return Contestant(name, call, columns.shape[1], error)

    mine = [contestant(name, partial(rhs, x, u, p)) for name, rhs in ours.items()]
    others = [contestant(name, partial(rates, x)) for name, rates in usual.items()]
    return compared(group, [Pair(o, m) for o in others for m in mine], rounds, MEASURE)


def _precise(problem: Problem, x: FloatArray) -> list[float]:
    """Return the rates of x (n,), computed by SymPy in `DIGITS` digits."""
    values = zip(problem.states, x, strict=True)
    known = {state: sp.Float(float(value), DIGITS) for state, value in values}
    return [float(rate.xreplace(known).evalf(DIGITS)) for rate in problem.at_instant]


def _run(problem: Problem, rounds: int, left_out: list[str]) -> tuple[Comparison, ...]:
    """Return the rows for runs, each at the loosest tolerance that reaches `TARGET`."""
    problem, exact, measure = reference_of(problem)
    usual = "on lambdified SymPy"
    solvers: dict[str, Callable[[float], FloatArray]] = {
        "simulate()": lambda rtol: _path(problem, (METHOD, rtol), [problem.duration])[:, -1],
        f"LSODA {usual}": solver("LSODA", "numpy", False, problem),
        f"RK45 {usual}": solver("RK45", "numpy", False, problem),
        f"LSODA {usual}, math and cse": solver("LSODA", "math", True, problem),
    }
    error = partial(problem.error, exact=exact)
    ours, *others = (tuned(name, solve, error) for name, solve in solvers.items())
    left_out += [f"run, {reason}" for reason in (ours, *others) if isinstance(reason, str)]
    if isinstance(ours, str):
        return ()
    pairs = [Pair(other, ours) for other in others if isinstance(other, Contestant)]
    return compared("run", pairs, rounds, measure)


def reference_of(problem: Problem) -> tuple[Problem, FloatArray, str]:
    """Return a problem with its scale, its state (n,) at the end, and the accuracy of that."""
    how = OWN
    try:
        path = _path(problem, how[0], 201)
    except RunError:
        how = SCIPY
        path = _path(problem, how[0], 201)
    scaled = replace(problem, scale=problem.system.scale(np.max(np.abs(path), axis=1)))
    error = scaled.error(_path(problem, how[1], [problem.duration])[:, -1], path[:, -1])
    (method, rtol), (other, looser) = how
    line = f"at the end, against {method} at rtol {rtol:g}, "
    return scaled, path[:, -1], f"{line}good to {error:.0e} by {other} at {looser:g}"


def tuned(
    name: str, solve: Callable[[float], FloatArray], error: Callable[[FloatArray], float]
) -> Contestant | str:
    """Return a solver at the loosest tolerance with which, and with the next, it reaches `TARGET`.

    Where there is no such tolerance, return the reason. A solver that fails has not reached it.
    """
    start, best = perf_counter(), None
    for rtol in LADDER:
        size = np.inf
        with suppress(ArithmeticError, RuntimeError, ValueError, PiezoError):
            size = error(solve(rtol))
        if size <= TARGET and best:
            return best
        call = partial(solve, rtol)
        best = Contestant(name, call, 1, size, f"rtol {rtol:g}") if size <= TARGET else None
        if perf_counter() - start > PATIENCE:
            break
    return best or f"{name}: does not reach an error of {TARGET:g} in {PATIENCE:g} s"


def _path(problem: Problem, how: tuple[str, float], times: Any) -> FloatArray:
    """Return the states (n, nt) of a run by a method with an rtol."""
    given: Any = {"inputs": problem.inputs, "parameters": problem.counts, "times": times}
    method, rtol = how
    run = simulate(problem.module, duration=problem.duration, method=method, rtol=rtol, **given)
    names = [record.name for record in problem.module.STATES]
    return np.concatenate([np.atleast_2d(run[name].values.T) for name in names])


GROUPS: Mapping[str, Callable[[Problem, int, list[str]], Sequence[Comparison]]] = {
    "rhs": _rhs,
    "batch": _batch,
    "run": _run,
}
