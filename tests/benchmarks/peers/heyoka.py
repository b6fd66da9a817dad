"""heyoka: Taylor's method compiled by LLVM, with kinks as events that flip switches.

Input: a problem.  Output: `HEYOKA`.  Each comparison in a law is a terminal event: the step ends
at the kink to round-off, and its switch, a parameter of the equations, changes there.
"""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from tests.benchmarks.kinks import Switched, switched
from tests.benchmarks.peers.heyoka_many import ended, in_batches, integrator, one_by_one
from tests.benchmarks.peers.heyoka_words import equations_of, worded
from tests.benchmarks.peers.peer import Peer

if TYPE_CHECKING:
    from piezo_sym.bench.problem import Problem
    from tests.benchmarks.peers.peer import Rates, Solver


def solver(problem: Problem) -> Solver:
    """Return Taylor's method over the whole run; a tolerance's integrator is made once."""
    equations = equations_of(problem)
    start = problem.start / problem.scale
    pars = equations.parameters(start.tolist())
    made = lru_cache(maxsize=2)(lambda tolerance: integrator(equations, start, pars, tolerance))

    def solve(tolerance: float) -> Any:
        return ended(made(tolerance), start, pars, problem.duration) * problem.scale

    return solve


def batch(problem: Problem) -> Rates:
    """Return the rates of many states at once, kinks as `select`."""
    import heyoka

    smooth: Switched = switched(problem.at_instant)
    variables = heyoka.make_vars(*(f"x_{n}" for n in range(len(problem.states))))
    variables = tuple(np.atleast_1d(variables).tolist())
    zero, one = heyoka.expression(0.0), heyoka.expression(1.0)
    gaps = worded(list(problem.states), tuple(smooth.gaps.values()))(*variables)
    switches = [heyoka.select(heyoka.gt(gap, zero), one, zero) for gap in gaps]
    rates = worded([*problem.states, *smooth.gaps], smooth.rates)(*variables, *switches)
    call = heyoka.cfunc(rates, list(variables))
    return lambda x: call(inputs=x)


HEYOKA = Peer(
    "heyoka, kinks as events",
    "heyoka",
    solver,
    batch,
    jumps=False,
    many={"one by one": one_by_one, "side by side": in_batches},
)
