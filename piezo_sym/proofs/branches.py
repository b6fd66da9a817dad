"""Laws with kinks as branches without: what solvers are asked about, one smooth piece at a time.

Input: a law.  Output: its `Branch` records, each a smooth tree and the comparisons under which the
law is that tree; together they cover every point.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import final

from piezo_sym.spec.calculus import add, neg
from piezo_sym.spec.expressions import (
    ONE,
    ZERO,
    Add,
    Call,
    Cmp,
    Div,
    Expr,
    If,
    Node,
    Num,
    Pow,
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

    @property
    def path(self) -> tuple[Cmp, ...]:
        """What holds where the branch is taken and has a value, in the order of evaluation."""
        steps = ((*partial(part), part) for part in self.conditions)
        return (*(claim for step in steps for claim in step), *partial(self.value))


@final
@dataclass(eq=False)
class TooManyBranchesError(Exception):
    """A law has more branches than anybody wants to wait for."""


def branches(law: Expr, known: Iterable[Cmp] = ()) -> tuple[Branch, ...]:
    """Return the branches of a law.

    Parameters
    ----------
    known : comparisons that hold wherever the branches are used, such as those of a domain.

    Raises
    ------
    TooManyBranchesError
        If there are more than `MOST`.
    """
    found: list[Branch] = []
    for branch in _pieces(settled(law, known), ()):
        found.append(branch)
        if len(found) > MOST:
            raise TooManyBranchesError
    return tuple(found)


def settled(law: Expr, known: Iterable[Cmp]) -> Expr:
    """Return a law with choices for its kinks, those taken that `known` comparisons decide."""
    if not bends(law):
        return law
    holding = frozenset(condition for condition in known if condition.op in OPPOSITE)
    facts = {opposite(condition): False for condition in holding}
    return decided(with_choices(law, holding), facts | dict.fromkeys(holding, True))


def bends(node: Node) -> bool:
    """Return whether a tree has choices, or functions with kinks."""
    return any(
        isinstance(n, If) or (isinstance(n, Call) and n.function in KINKED) for n in walk(node)
    )


def cover(found: tuple[Branch, ...]) -> Cmp:
    """Return the claim that at every point the conditions of one of the branches hold."""
    inside = [_indicator(branch.conditions) for branch in found]
    return Cmp(">=", Add(tuple(inside)) if len(inside) > 1 else inside[0], ONE)


def _indicator(conditions: tuple[Cmp, ...]) -> Expr:
    """Return a law that is 1 where all comparisons hold, in the order of evaluation, else 0."""
    if not conditions:
        return ONE
    return If(_indicator(conditions[1:]), conditions[0], ZERO)


def parts(branch: Branch) -> tuple[Expr, ...]:
    """Return the smooth laws of a branch of several laws taken together."""
    if not isinstance(branch.value, Call):
        msg = "a branch of one law has no parts"
        raise TypeError(msg)
    return branch.value.args


def with_choices(node: Expr, known: Container[Cmp] = ()) -> Expr:
    """Return a law with each function that has kinks written as choices; `known` ones hold."""
    inner = rebuild(node, lambda part: with_choices(part, known))
    if isinstance(inner, Call) and inner.function in KINKED:
        return _choices(inner.function, inner.args[0], inner.args[-1], known)
    return inner


def _choices(function: str, z: Expr, w: Expr, known: Container[Cmp] = ()) -> Expr:
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
    above, below = Cmp(">", z, w), Cmp("<", z, neg(w))
    if function == "deadzone":
        inside = If(add(z, neg(w)), above, If(add(z, w), below, ZERO))
    else:
        inside = If(w, above, If(neg(w), below, z))
    wide = Cmp(">=", w, ZERO)  # there, and only there, the formula has these three branches
    if wide in known or (isinstance(w, Num) and w.value >= 0):
        return inside
    if function == "deadzone":
        general = add(If(add(z, neg(w)), above, ZERO), If(add(z, w), below, ZERO))
    else:
        general = _choices("min", _choices("max", z, neg(w)), w)
    return If(inside, wide, general)


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
    """Return the comparison that is decided first where a law is evaluated.

    It is outside all branches: what guards a branch is decided before anything inside it.
    """
    if isinstance(law, If):
        return _first_choice(children(law.condition)) or law.condition
    return _first_choice(children(law))


def _first_choice(parts: Iterable[Node]) -> Cmp | None:
    found = (_next_choice(part) for part in parts if not isinstance(part, Cmp))
    return next((choice for choice in found if choice is not None), None)


def partial(node: Node) -> Iterator[Cmp]:
    """Yield what must hold for a smooth tree to have a value, inner parts first."""
    for part in reversed(tuple(walk(node))):
        match part:
            case Div(_, right) if not isinstance(right, Num) or right == ZERO:
                yield Cmp("!=", right, ZERO)
            case Pow(base, exponent) if exponent.denominator != 1:
                yield Cmp(">=" if exponent > 0 else ">", base, ZERO)
            case Pow(base, exponent) if exponent < 0:
                yield Cmp("!=", base, ZERO)
            case Call("sqrt", (arg,)):
                yield Cmp(">=", arg, ZERO)
            case Call("log", (arg,)):
                yield Cmp(">", arg, ZERO)
