"""A problem in heyoka's words: its equations, smooth but for switches, and the gaps that flip them.

Input: a problem.  Output: `Equations`.  Switches and free parameters are heyoka's `par`, switches
first.  Equal hysterons meet their kinks at one instant, which a root finder cannot order: such
events are tied, the first one's switch serving all (`kinks.twins`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, final

import numpy as np
import sympy as sp

from piezo_sym.bench.problem import TIME
from tests.benchmarks.kinks import positive, switched, twins
from tests.benchmarks.peers.peer import scaled

if TYPE_CHECKING:
    from piezo_sym.bench.problem import Problem

FUNCTIONS = ("exp", "log", "sqrt", "sin", "cos", "tanh")


@final
@dataclass(frozen=True)
class Equations:
    """The scaled equations in heyoka's words.

    Attributes
    ----------
    variables, rates : z and its rates, which hold a parameter for each switch.
    gaps : of each switch that is tied to no other.
    values : the gaps as a function of t, z, and free parameters.
    """

    variables: tuple[Any, ...]
    rates: tuple[Any, ...]
    gaps: tuple[Any, ...]
    values: Callable[..., Any]

    @property
    def pairs(self) -> list[tuple[Any, Any]]:
        """The variables with their rates, as heyoka takes them."""
        return list(zip(self.variables, self.rates, strict=True))

    def parameters(self, start: Sequence[float], *free: float) -> list[float]:
        """Return the switches at t = 0 from a start z, and after them the free parameters."""
        return [*positive(self.values(0.0, *start, *free)), *free]


def equations_of(problem: Problem, free: tuple[sp.Symbol, ...] = ()) -> Equations:
    """Return a problem's equations, its equal kinks tied.

    Parameters
    ----------
    free : symbols in the rates that get their numbers from run to run.
    """
    import heyoka

    smooth = switched(scaled(problem))
    start = problem.start / problem.scale
    tie = twins(problem.states, scaled(problem), start.tolist())
    places: dict[sp.Expr, int] = {}
    for gap in smooth.gaps.values():
        places.setdefault(gap.xreplace(tie), len(places))
    switches = [heyoka.par[places[gap.xreplace(tie)]] for gap in smooth.gaps.values()]
    variables = heyoka.make_vars(*(f"z_{n}" for n in range(len(problem.states))))
    variables = tuple(np.atleast_1d(variables).tolist())
    arguments = [TIME, *problem.states, *free]
    numbers = (heyoka.par[len(places) + n] for n in range(len(free)))
    known = (heyoka.time, *variables, *numbers)
    rates = worded([*arguments, *smooth.gaps], smooth.rates)(*known, *switches)
    gaps = worded(arguments, tuple(places))(*known)
    return Equations(
        variables, tuple(rates), tuple(gaps), sp.lambdify(arguments, list(places), "math")
    )


def worded(arguments: list[sp.Symbol], expressions: tuple[sp.Expr, ...]) -> Callable[..., Any]:
    """Return expressions as a function of heyoka's own."""
    import heyoka

    words = [{name: getattr(heyoka, name) for name in FUNCTIONS}]
    made = sp.lambdify(arguments, list(expressions), words, cse=True)
    return lambda *values: [heyoka.expression(e) if _plain(e) else e for e in made(*values)]


def _plain(value: Any) -> bool:
    return isinstance(value, int | float)
