"""The usual way without this package: lambdified SymPy, integrated by SciPy's solve_ivp.

Input: a `Problem`.  Output: its rates as functions, and the state at the end of a run.
"""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import sympy as sp
from scipy.integrate import solve_ivp

from piezo_sym.bench.problem import TIME, Problem
from piezo_sym.run.checks import FloatArray


def field(problem: Problem, modules: str = "numpy", cse: bool = False) -> Callable[..., Any]:
    """Return dx/dt as a function of t and x, lambdified."""
    arguments, rates = [TIME, list(problem.states)], list(problem.rates)
    made: Callable[..., Any] = sp.lambdify(arguments, rates, modules, cse=cse)
    return made


def solver(method: str, modules: str, cse: bool, problem: Problem) -> Callable[[float], FloatArray]:
    """Return solve_ivp over the whole run, its error bound rtol (|x| + scale)."""
    return partial(integrated, field(problem, modules, cse), problem, method)


def integrated(rates: Callable[..., Any], problem: Problem, method: Any, rtol: float) -> FloatArray:
    """Return the state at the end, by solve_ivp; raise `RuntimeError` if it gives up."""
    end, how = problem.duration, {"method": method, "rtol": rtol, "atol": rtol * problem.scale}
    found = solve_ivp(rates, (0.0, end), problem.start, t_eval=(end,), **how)
    if not found.success:
        raise RuntimeError(found.message)
    state: FloatArray = found.y[:, -1]
    return state


def batch(problem: Problem) -> Callable[[FloatArray], FloatArray]:
    """Return the rates of many states at once, as an array (n, columns)."""
    rates = sp.lambdify([list(problem.states)], list(problem.at_instant), "numpy")

    def many(x: FloatArray) -> FloatArray:
        out = np.empty_like(x)
        with np.errstate(all="ignore"):  # select computes every branch
            for row, rate in zip(out, rates(x), strict=True):
                row[:] = rate
        return out

    return many
