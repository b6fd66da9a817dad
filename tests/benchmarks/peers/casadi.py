"""CasADi: its expression graph as generated C, integrated by SUNDIALS' cvodes.

Input: a problem.  Output: `CASADI`.  States are scaled, for cvodes has one absolute tolerance here.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import chdir, contextmanager
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np
import sympy as sp

from piezo_sym.bench.problem import INSTANT, TIME
from piezo_sym.run.engine.compiler import compilers
from tests.benchmarks.kinks import switched
from tests.benchmarks.peers.peer import Peer, scaled

if TYPE_CHECKING:
    from collections.abc import Iterable

    from piezo_sym.bench.problem import Problem
    from tests.benchmarks.peers.peer import Rates, Solver

FUNCTIONS = ("exp", "log", "sqrt", "sin", "cos", "tanh")


def graph(problem: Problem, rates: Iterable[sp.Expr], t: Any, x: Any) -> Any:
    """Return rates as a CasADi vector of the expressions t and x, kinks as `if_else`."""
    import casadi

    smooth = switched(rates)
    words = [{name: getattr(casadi, name) for name in FUNCTIONS}]
    known = [t, *casadi.vertsplit(x)]
    gaps = sp.lambdify([TIME, *problem.states], list(smooth.gaps.values()), words)(*known)
    switches = [casadi.if_else(gap > 0, 1.0, 0.0) for gap in gaps]
    arguments = [TIME, *problem.states, *smooth.gaps]
    return casadi.vertcat(
        *sp.lambdify(arguments, list(smooth.rates), words, cse=True)(*known, *switches)
    )


@contextmanager
def elsewhere() -> Iterator[None]:
    """Work in a folder of its own for a while: CasADi leaves its C files where it is called."""
    with tempfile.TemporaryDirectory(prefix="piezo_sym-") as folder, chdir(folder):
        yield


def jit() -> dict[str, Any]:
    """Return the options that compile a graph as C, or none without a compiler."""
    compiler = next(compilers(), None)
    if compiler is None:
        return {}
    shell = {
        "compiler": " ".join(compiler.command),
        "flags": ["-O3", "-march=native"],
        "cleanup": False,  # the folder goes as a whole, once the library is loaded
    }
    return {"jit": True, "jit_cleanup": False, "compiler": "shell", "jit_options": shell}


def solver(problem: Problem) -> Solver:
    """Return cvodes over the whole run; a tolerance's integrator is made when it is first used."""
    import casadi

    t, z = casadi.SX.sym("t"), casadi.SX.sym("z", len(problem.states))
    equations = {"t": t, "x": z, "ode": graph(problem, scaled(problem), t, z)}
    start = problem.start / problem.scale

    @lru_cache(maxsize=2)
    def integrator(tolerance: float) -> Any:
        options = {"abstol": tolerance, "reltol": tolerance, "max_num_steps": 10**8}
        options |= jit()
        with elsewhere():
            return casadi.integrator("run", "cvodes", equations, 0.0, problem.duration, options)

    def solve(tolerance: float) -> Any:
        return np.array(integrator(tolerance)(x0=start)["xf"]).ravel() * problem.scale

    return solve


def batch(problem: Problem) -> Rates:
    """Return the rates of many states, one after another in compiled C."""
    import casadi

    x = casadi.SX.sym("x", len(problem.states))
    rates = [graph(problem, problem.rates, INSTANT, x)]

    @lru_cache(maxsize=1)
    def over(columns: int) -> Any:
        with elsewhere():
            return casadi.Function("rates", [x], rates, jit()).map(columns)

    return lambda states: np.array(over(states.shape[1])(states))


CASADI = Peer("CasADi cvodes, generated C", "casadi", solver, batch)
