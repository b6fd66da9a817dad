"""heyoka: Taylor's method compiled by LLVM, with kinks as events that flip switches.

Input: a problem.  Output: `HEYOKA`.  Each comparison in a law is a terminal event: the step ends
at the kink to round-off, and its switch, a parameter of the equations, changes there.  Equal
hysterons meet their kinks at one instant, which a root finder cannot order: such events are tied,
the first one's switch serving all (`kinks.twins`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any, final

import numpy as np
import sympy as sp

from piezo_sym.bench.kinks import Switched, positive, switched, twins
from piezo_sym.bench.peers.peer import Peer, at_instant
from piezo_sym.bench.problem import TIME

if TYPE_CHECKING:
    from piezo_sym.bench.peers.peer import Rates, Solver
    from piezo_sym.bench.problem import Problem

FUNCTIONS = ("exp", "log", "sqrt", "sin", "cos", "tanh")


@final
@dataclass(frozen=True)
class Equations:
    """The scaled equations in heyoka's words.

    Attributes
    ----------
    variables, rates : z and its rates, which hold a parameter for each switch.
    gaps, start : of each switch that is tied to no other; its value at t = 0.
    """

    variables: tuple[Any, ...]
    rates: tuple[Any, ...]
    gaps: tuple[Any, ...]
    start: tuple[float, ...]


def solver(problem: Problem) -> Solver:
    """Return Taylor's method over the whole run; a tolerance's integrator is made once."""
    equations = equations_of(problem)
    start = problem.start / problem.scale
    made = lru_cache(maxsize=2)(lambda tolerance: integrator(equations, start, tolerance))

    def solve(tolerance: float) -> Any:
        run = made(tolerance)
        run.time, run.state[:], run.pars[:] = 0.0, start, equations.start
        if equations.gaps:
            run.reset_cooldowns()
        outcome = run.propagate_until(problem.duration)[0]
        if "time_limit" not in str(outcome):
            raise RuntimeError(str(outcome))
        return run.state * problem.scale

    return solve


def equations_of(problem: Problem) -> Equations:
    """Return a problem's equations, its equal kinks tied."""
    import heyoka

    smooth = switched(problem.scaled)
    start = problem.start / problem.scale
    tie = twins(problem.states, problem.scaled, start.tolist())
    places: dict[sp.Expr, int] = {}
    for gap in smooth.gaps.values():
        places.setdefault(gap.xreplace(tie), len(places))
    switches = [heyoka.par[places[gap.xreplace(tie)]] for gap in smooth.gaps.values()]
    variables = heyoka.make_vars(*(f"z_{n}" for n in range(len(problem.states))))
    variables = tuple(np.atleast_1d(variables).tolist())
    known = (heyoka.time, *variables)
    rates = worded([TIME, *problem.states, *smooth.gaps], smooth.rates)(*known, *switches)
    gaps = worded([TIME, *problem.states], tuple(places))(*known)
    first = sp.lambdify([TIME, *problem.states], list(places), "math")(0.0, *start)
    return Equations(variables, tuple(rates), tuple(gaps), tuple(positive(first)))


def worded(arguments: list[sp.Symbol], expressions: tuple[sp.Expr, ...]) -> Callable[..., Any]:
    """Return expressions as a function of heyoka's own."""
    import heyoka

    words = [{name: getattr(heyoka, name) for name in FUNCTIONS}]
    made = sp.lambdify(arguments, list(expressions), words, cse=True)
    return lambda *values: [heyoka.expression(e) if _plain(e) else e for e in made(*values)]


def _plain(value: Any) -> bool:
    return isinstance(value, int | float)


def integrator(equations: Equations, start: Any, tolerance: float) -> Any:
    """Return a compiled integrator of a tolerance, with an event for each gap."""
    import heyoka

    def flip(number: int) -> Callable[[Any, int], bool]:
        def turned(run: Any, sign: int) -> bool:
            run.pars[number] = 1.0 if sign > 0 else 0.0
            return True

        return turned

    events = [heyoka.t_event(gap, callback=flip(n)) for n, gap in enumerate(equations.gaps)]
    rates = list(zip(equations.variables, equations.rates, strict=True))
    pars = list(equations.start)
    return heyoka.taylor_adaptive(rates, list(start), tol=tolerance, pars=pars, t_events=events)


def batch(problem: Problem) -> Rates:
    """Return the rates of many states at once, kinks as `select`."""
    import heyoka

    smooth: Switched = switched(at_instant(problem))
    variables = heyoka.make_vars(*(f"x_{n}" for n in range(len(problem.states))))
    variables = tuple(np.atleast_1d(variables).tolist())
    zero, one = heyoka.expression(0.0), heyoka.expression(1.0)
    gaps = worded(list(problem.states), tuple(smooth.gaps.values()))(*variables)
    switches = [heyoka.select(heyoka.gt(gap, zero), one, zero) for gap in gaps]
    rates = worded([*problem.states, *smooth.gaps], smooth.rates)(*variables, *switches)
    call = heyoka.cfunc(rates, list(variables))
    return lambda x: call(inputs=x)


HEYOKA = Peer("heyoka, kinks as events", "heyoka", solver, batch, jumps=False)
