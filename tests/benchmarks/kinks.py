"""Kinks as switches: laws in pieces become smooth laws that switches of 0 and 1 select from.

Input: expressions with `Piecewise`.  Output: `Switched`: the same with a symbol for the truth of
each comparison, and for each symbol its gap, which is positive where the comparison holds.  A
solver with events finds where gaps are zero; others compute the switches from the gaps.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import final

import numpy as np
import sympy as sp
from sympy.core.relational import Relational
from sympy.logic.boolalg import And, Not, Or


@final
@dataclass(frozen=True)
class Switched:
    """Smooth rates, and the switches in them: symbol -> gap."""

    rates: tuple[sp.Expr, ...]
    gaps: Mapping[sp.Symbol, sp.Expr]


def switched(rates: Iterable[sp.Expr]) -> Switched:
    """Return rates without `Piecewise`, and the gaps of their switches."""
    made: dict[sp.Expr, sp.Symbol] = {}

    def smooth(piecewise: sp.Expr) -> sp.Expr:
        total, rest = sp.S.Zero, sp.S.One
        for value, condition in piecewise.args:
            holds = truth(condition, made)
            total, rest = total + value * holds * rest, rest * (1 - holds)
        return total

    found = tuple(rate.replace(lambda e: isinstance(e, sp.Piecewise), smooth) for rate in rates)
    return Switched(found, {symbol: gap for gap, symbol in made.items()})


def truth(condition: sp.Basic, made: dict[sp.Expr, sp.Symbol]) -> sp.Expr:
    """Return a condition's truth, 0 or 1, as an expression of switches; new ones go to `made`.

    Where a gap is exactly 0, so is its switch, also for `<=`: the laws are the same on both sides.
    """
    if condition in (sp.true, sp.false):
        return sp.S.One if condition == sp.true else sp.S.Zero
    if isinstance(condition, Relational):
        gap = condition.gts - condition.lts
        return made.setdefault(gap, sp.Symbol(f"switch_{len(made)}", real=True))
    parts = [truth(part, made) for part in condition.args]
    if isinstance(condition, And):
        return sp.Mul(*parts)
    if isinstance(condition, Or):
        return 1 - sp.Mul(*(1 - part for part in parts))
    if isinstance(condition, Not):
        return 1 - parts[0]
    raise TypeError(condition)


def twins(
    states: Sequence[sp.Symbol], rates: Sequence[sp.Expr], start: Sequence[float]
) -> dict[sp.Symbol, sp.Symbol]:
    """Return states that stay equal for ever to an earlier one, which is given for each.

    Two states are twins if they start equal and exchanging them changes the system in nothing but
    their names: equal hysterons.  By symmetry their kinks come at the same instant.
    """
    found: dict[sp.Symbol, sp.Symbol] = {}
    for n, state in enumerate(states):
        for m in range(n):
            if states[m] not in found and start[m] == start[n] and _alike(states, rates, m, n):
                found[state] = states[m]
                break
    return found


def _alike(states: Sequence[sp.Symbol], rates: Sequence[sp.Expr], m: int, n: int) -> bool:
    if rates[m].xreplace({states[m]: states[n]}).free_symbols != rates[n].free_symbols:
        return False  # cheap, and enough for most pairs
    swap = {states[m]: states[n], states[n]: states[m]}
    order = list(range(len(rates)))
    order[m], order[n] = n, m
    return all(rates[k].xreplace(swap) == rates[order[k]] for k in range(len(rates)))


def positive(gaps: Iterable[float]) -> list[float]:
    """Return the switches at given gaps: 1 where a gap is positive."""
    return [float(np.asarray(gap) > 0) for gap in gaps]
