"""What a peer is.

Input: a problem.  Output: `Peer`, the record that each peer's file gives, and what it needs to
know of a problem's expressions.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias, final

import sympy as sp

from piezo_sym.bench.problem import TIME

if TYPE_CHECKING:
    from piezo_sym.bench.problem import Problem
    from piezo_sym.run.checks import FloatArray

    Solver: TypeAlias = Callable[[float], FloatArray]
    Rates: TypeAlias = Callable[[FloatArray], object]

#: When the rates of many states are computed, so that an input in motion is one number.
INSTANT = 1.25e-3


@final
@dataclass(frozen=True)
class Peer:
    """A way to run a model that does not need this package.

    Attributes
    ----------
    name : in the report.
    package : what has to be installed.
    solver : problem -> function from a tolerance to the state x (n,) at the end of the run.
    rates : problem -> function from states x (n, columns) to their rates at `INSTANT`, or nothing.
    jumps : whether laws that jump on purpose can be run.
    """

    name: str
    package: str
    solver: Callable[[Problem], Solver]
    rates: Callable[[Problem], Rates] | None = None
    jumps: bool = True


def at_instant(problem: Problem) -> tuple[sp.Expr, ...]:
    """Return the rates at `INSTANT`."""
    return tuple(rate.xreplace({TIME: sp.Float(INSTANT)}) for rate in problem.rates)
