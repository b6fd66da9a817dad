"""Today's usual way: lambdified SymPy, integrated by SciPy's solve_ivp.

Input: a problem.  Output: `LSODA` and `RK45`, with the rates as `lambdify` prints them for NumPy,
its default; and `LSODA_MATH`, with Python's own floats and common subexpressions, which few people
write and which is several times faster.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
import sympy as sp
from scipy.integrate import solve_ivp

from piezo_sym.bench.peers.peer import Peer, at_instant
from piezo_sym.bench.problem import TIME

if TYPE_CHECKING:
    from piezo_sym.bench.peers.peer import Rates, Solver
    from piezo_sym.bench.problem import Problem


def field(problem: Problem, modules: str = "numpy", cse: bool = False) -> Callable[..., Any]:
    """Return dx/dt as a function of t and x, lambdified."""
    made: Callable[..., Any] = sp.lambdify(
        [TIME, list(problem.states)], list(problem.rates), modules, cse=cse
    )
    return made


def solver(method: str, modules: str, cse: bool, problem: Problem) -> Solver:
    """Return solve_ivp over the whole run, its error bound rtol (|x| + scale)."""
    rates = field(problem, modules, cse)
    return partial(integrated, rates, problem, method)


def integrated(rates: Callable[..., Any], problem: Problem, method: Any, rtol: float) -> Any:
    """Return the state at the end, by solve_ivp.

    Raises
    ------
    RuntimeError
        If it gives up; with its reason.
    """
    span = (0.0, problem.duration)
    atol: Any = rtol * problem.scale
    found = solve_ivp(
        rates, span, problem.start, method=method, t_eval=span[1:], rtol=rtol, atol=atol
    )
    if not found.success:
        raise RuntimeError(found.message)
    return found.y[:, -1]


def batch(problem: Problem) -> Rates:
    """Return the rates of many states at once, as an array (n, columns)."""
    rates = sp.lambdify([list(problem.states)], list(at_instant(problem)), "numpy")

    def many(x: Any) -> Any:
        out = np.empty_like(x)
        with np.errstate(all="ignore"):  # select computes every branch
            for row, rate in zip(out, rates(x), strict=True):
                row[:] = rate
        return out

    return many


LSODA = Peer("LSODA on lambdified SymPy", "sympy", partial(solver, "LSODA", "numpy", False), batch)
RK45 = Peer("RK45 on lambdified SymPy", "sympy", partial(solver, "RK45", "numpy", False))
LSODA_MATH = Peer(
    "LSODA on lambdified SymPy, math and cse", "sympy", partial(solver, "LSODA", "math", True)
)
