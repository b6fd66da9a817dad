"""What a peer is.

Input: a problem.  Output: `Peer`, the record that each peer's file gives, and what it needs to
know of a problem's expressions.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, TypeAlias, final

import sympy as sp

if TYPE_CHECKING:
    from piezo_sym.bench.problem import Problem
    from piezo_sym.run.checks import FloatArray
    from tests.benchmarks.family import Family

    Solver: TypeAlias = Callable[[float], FloatArray]
    Rates: TypeAlias = Callable[[FloatArray], object]


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
    many : names of ways to run a family, and each as a function from a tolerance to the states
        (members, n) at the end, compiled once for all members.
    """

    name: str
    package: str
    solver: Callable[[Problem], Solver]
    rates: Callable[[Problem], Rates] | None = None
    jumps: bool = True
    many: Mapping[str, Callable[[Family], Solver]] = field(default_factory=dict)


def scaled(problem: Problem) -> tuple[sp.Expr, ...]:
    """Return the rates of z = x/scale as expressions of z, whose symbols are `states` as well."""
    pairs = zip(problem.states, problem.scale, strict=True)
    change = {state: sp.Float(size) * state for state, size in pairs}
    rates = zip(problem.rates, problem.scale, strict=True)
    return tuple(rate.xreplace(change) / sp.Float(size) for rate, size in rates)
