"""numba: the lambdified rates compiled by LLVM, integrated by SciPy's LSODA.

Input: a problem.  Output: `NUMBA`.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
import sympy as sp

from piezo_sym.bench.problem import INSTANT, TIME, integrated
from tests.benchmarks.peers.peer import Peer

if TYPE_CHECKING:
    from piezo_sym.bench.problem import Problem
    from tests.benchmarks.peers.peer import Rates, Solver


def compiled(problem: Problem) -> Callable[..., Any]:
    """Return a compiled function that writes the rates of the columns of x (n, columns)."""
    from numba import njit
    from numba.np.unsafe.ndarray import to_fixed_tuple

    one = tuple(rate + sp.Float(0) for rate in problem.rates)
    core = njit(sp.lambdify([TIME, *problem.states], one, "math", cse=True))
    n = len(problem.states)

    def write(t: Any, x: Any, out: Any) -> None:
        for k in range(x.shape[1]):
            found = core(t, *to_fixed_tuple(x[:, k], n))
            for row in range(n):
                out[row, k] = found[row]

    made: Callable[..., Any] = njit(write)
    return made


def solver(problem: Problem) -> Solver:
    """Return LSODA through solve_ivp, with compiled rates."""
    write = compiled(problem)
    out = np.empty((problem.start.size, 1))

    def rates(t: float, x: Any) -> Any:
        write(t, x.reshape(-1, 1), out)
        return out[:, 0].copy()

    return partial(integrated, rates, problem, "LSODA")


def batch(problem: Problem) -> Rates:
    """Return the rates of many states, one after another in a compiled loop."""
    write = compiled(problem)

    def many(x: Any) -> Any:
        out = np.empty_like(x)
        write(INSTANT, x, out)
        return out

    return many


NUMBA = Peer("LSODA on rates compiled by numba", "numba", solver, batch)
