"""Whether an energy's slope is a co-state law, branch by branch.

Input: the slope and the law, as trees in states and parameters.  Output: whether they are shown to
be equal wherever both have a value.  On a branch that is an edge, a = b, they are compared there: a
slope of one side is as good as that of the other, for rows ``continuous`` say that neither energy
nor law jumps.
"""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp

from piezo_sym.algebra.integrals import vanishes
from piezo_sym.expressions.tree import Call, Cmp, Expr
from piezo_sym.iphs import IPHS
from piezo_sym.proofs.branches import TooManyBranchesError, branches, parts
from piezo_sym.spec.tables import conditions


def same(iphs: IPHS, slope: Expr, law: Expr, state: str) -> bool:
    """Return whether a slope by a state is shown to be a law."""
    known = tuple(condition.tree for condition in conditions(iphs.model))
    try:
        found = branches(Call("together", (slope, law)), known)
    except TooManyBranchesError:
        return False
    for branch in found:
        left, right = (iphs.symbols.law(part, {}) for part in parts(branch))
        at = dict(_edges(iphs, branch.conditions, iphs.symbols[state]))
        if not vanishes((left - right).xreplace(at)):
            return False
    return True


def _edges(
    iphs: IPHS, where: tuple[Cmp, ...], state: sp.Symbol
) -> Iterator[tuple[sp.Symbol, sp.Expr]]:
    """Yield what the state is where a branch is no more than an edge."""
    for condition in where:
        if condition.op == ">=" and Cmp("<=", condition.left, condition.right) in where:
            left, right = (iphs.symbols.law(e, {}) for e in (condition.left, condition.right))
            slope = sp.diff(left - right, state)
            if state not in slope.free_symbols and slope.is_nonzero:
                yield state, sp.expand(state - (left - right) / slope)
                return
