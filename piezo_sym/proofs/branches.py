"""Laws with kinks as branches without: what solvers are asked about, one smooth piece at a time.

Input: a law.  Output: its `Branch` records, each a smooth tree and the comparisons under which the
law is that tree; together they cover every point.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import final

from piezo_sym.spec.calculus import add, neg
from piezo_sym.spec.expressions import (
    ONE,
    ZERO,
    Call,
    Cmp,
    Expr,
    If,
    Node,
    Num,
    children,
    rebuild,
    walk,
)

#: More branches than these are not looked at: the law is left open.
MOST = 400
OPPOSITE = {"<": ">=", "<=": ">", ">": "<=", ">=": "<"}
KINKED = frozenset({"abs", "sign", "min", "max", "deadzone", "saturate"})


@final
@dataclass(frozen=True)
class Branch:
    """A smooth piece of a law: `value` where all of `conditions` hold."""

    conditions: tuple[Cmp, ...]
    value: Expr


@final
@dataclass(eq=False)
class TooManyBranchesError(Exception):
    """A law has more branches than anybody wants to wait for."""


def branches(law: Expr) -> tuple[Branch, ...]:
    """Return the branches of a law.

    Raises
    ------
    TooManyBranchesError
        If there are more than `MOST`.
    """
    found: list[Branch] = []
    for branch in _pieces(with_choices(law), ()):
        found.append(branch)
        if len(found) > MOST:
            raise TooManyBranchesError
    return tuple(found)


def smooth_clauses(condition: Cmp) -> Iterator[tuple[Cmp, ...]]:
    """Yield a comparison of laws with kinks as clauses of smooth ones, one a branch."""
    for branch in branches(Call("together", (condition.left, condition.right))):
        left, right = parts(branch)
        yield (*map(opposite, branch.conditions), Cmp(condition.op, left, right))


def parts(branch: Branch) -> tuple[Expr, ...]:
    """Return the smooth laws of a branch of several laws taken together."""
    if not isinstance(branch.value, Call):
        msg = "a branch of one law has no parts"
        raise TypeError(msg)
    return branch.value.args


def with_choices(node: Expr) -> Expr:
    """Return a law with each function that has kinks written as choices."""
    inner = rebuild(node, with_choices)
    if isinstance(inner, Call) and inner.function in KINKED:
        return _choices(inner.function, inner.args[0], inner.args[-1])
    return inner


def _choices(function: str, z: Expr, w: Expr) -> Expr:
    """Return a function with kinks as choices; the edges are those of the contracts' formulas."""
    match function:
        case "abs":
            return If(z, Cmp(">=", z, ZERO), neg(z))
        case "sign":
            return If(ONE, Cmp(">", z, ZERO), If(Num(Fraction(-1)), Cmp("<", z, ZERO), ZERO))
        case "min":
            return If(z, Cmp("<=", z, w), w)
        case "max":
            return If(z, Cmp(">=", z, w), w)
        case "deadzone":  # its width is >= 0: the domain says so
            low = If(add(z, w), Cmp("<", z, neg(w)), ZERO)
            return If(add(z, neg(w)), Cmp(">", z, w), low)
    return If(w, Cmp(">", z, w), If(neg(w), Cmp("<", z, neg(w)), z))  # saturate


def choices(node: Node) -> tuple[Cmp, ...]:
    """Return the comparisons of a law's choices, each once, outermost first."""
    return tuple(dict.fromkeys(n.condition for n in walk(node) if isinstance(n, If)))


def decided(node: Expr, known: dict[Cmp, bool]) -> Expr:
    """Return a law with the choices taken whose comparison is `known`."""
    if isinstance(node, If) and node.condition in known:
        return decided(node.then if known[node.condition] else node.other, known)
    return rebuild(node, lambda part: decided(part, known))


def opposite(condition: Cmp) -> Cmp:
    """Return the comparison that holds where `condition` does not."""
    return Cmp(OPPOSITE[condition.op], condition.left, condition.right)


def _pieces(law: Expr, path: tuple[Cmp, ...]) -> Iterator[Branch]:
    """Yield the branches of a law below the comparisons decided so far."""
    choice = _next_choice(law)
    if choice is None:
        yield Branch(path, law)
        return
    for holds in (True, False):
        taken = decided(law, {choice: holds, opposite(choice): not holds})
        condition = choice if holds else opposite(choice)
        yield from _pieces(taken, (*path, condition))


def _next_choice(law: Expr) -> Cmp | None:
    """Return a comparison to decide next: the first one whose sides have no choice in them."""
    for node in walk(law):
        if isinstance(node, If):
            inner = children(node.condition)
            if not any(isinstance(part, If) for side in inner for part in walk(side)):
                return node.condition
    return None
