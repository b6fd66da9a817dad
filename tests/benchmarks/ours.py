"""What this package does, as calls to be timed.

Input: a `Problem`.  Output: runs as functions of rtol, and rates of many states.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from piezo_sym.bench.problem import INSTANT
from piezo_sym.run import simulate
from piezo_sym.run.collocation import METHOD, advance, layout_of, set_scales, stepping
from piezo_sym.run.engine.batch import Batch, Stepping
from piezo_sym.run.engine.engine import engine_of
from piezo_sym.run.module import GeneratedModule

if TYPE_CHECKING:
    import xarray

    from piezo_sym.bench.problem import Problem
    from piezo_sym.run.checks import FloatArray
    from tests.benchmarks.peers.peer import Rates, Solver

RUN = "discrete gradient in C"
WHOLE = "simulate(), Dataset of the end"
SAMPLED = "simulate(), Dataset of 1001 samples"


def run_in_c(problem: Problem) -> Solver:
    """Return the run alone, from rtol to the state at its end; nothing is recorded but that.

    What a tolerance needs is made once, as for the other solvers.

    Raises
    ------
    EngineError
        If there is no compiler.
    """
    engine, system = engine_of(problem.module), problem.system
    start, times = problem.start[None], np.array([problem.duration])

    @lru_cache(maxsize=2)
    def made(rtol: float) -> tuple[Batch, Stepping]:
        how = stepping(system, rtol, None)
        layout = layout_of(*start.shape)
        return Batch(engine, [system.parameters], start, system.inputs, times, how, layout), how

    def solve(rtol: float) -> FloatArray:
        batch, how = made(rtol)
        batch.begin(start, how)
        set_scales(batch, [system], start, how.tolerance)
        advance(batch)
        return batch.states[0, -1].copy()

    return solve


def whole(problem: Problem, rtol: float, times: Any, method: str = METHOD) -> xarray.Dataset:
    """Return what `simulate` returns."""
    return simulate(
        problem.module,
        inputs=problem.inputs,
        duration=problem.duration,
        parameters=problem.counts,
        rtol=rtol,
        times=times,
        method=method,
    )


def states(problem: Problem, found: xarray.Dataset) -> FloatArray:
    """Return the states (n, nt) of a Dataset."""
    names = [record.name for record in problem.module.STATES]
    return np.concatenate([np.atleast_2d(found[name].values.T) for name in names])


def inputs_at_instant(problem: Problem) -> FloatArray:
    """Return the inputs (m,) at `INSTANT`."""
    return np.array([float(signal(INSTANT)) for signal in problem.system.inputs.signals])


def rates_of(problem: Problem, module: Any = None) -> Rates:
    """Return the rates of states x (n, columns), of the module or of its engine."""
    source: GeneratedModule = module or problem.module
    u, p = inputs_at_instant(problem), problem.system.parameters
    return lambda x: source.rhs(x, u, p)


def rates_into(problem: Problem, x: FloatArray) -> tuple[Callable[[], FloatArray], FloatArray]:
    """Return a call of the engine's rates of x (n, columns), and the array where they go."""
    engine, out = engine_of(problem.module), np.zeros_like(x)
    u, p = inputs_at_instant(problem), problem.system.parameters
    return lambda: engine.rhs(x, u, p, out=out), out


def rates_in_place(problem: Problem, x: FloatArray) -> tuple[Callable[[], object], FloatArray]:
    """Return a call of the compiled loop over columns of x (n, columns), and where rates go.

    States stand one after another, as the loop takes them, so that nothing but it is timed; the
    rates (columns, n) too.
    """
    engine = engine_of(problem.module)
    columns, u = np.ascontiguousarray(x.T), inputs_at_instant(problem)
    out = np.empty_like(columns)
    structure = engine.structure(problem.system.parameters)
    function = getattr(engine.library, f"{problem.module.NAME}_rhs_columns")
    sizes = [ctypes.c_long(n) for n in (columns.shape[0], x.shape[0], 0, x.shape[0])]
    ends = [ctypes.c_void_p(array.ctypes.data) for array in (columns, u, out)]

    def call() -> object:
        function(ends[0], ends[1], ctypes.byref(structure.value), ends[2], *sizes)
        return columns, u, out  # they live as long as their addresses are used

    return call, out
