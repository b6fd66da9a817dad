"""Laws with kinks as smooth branches, which solvers are asked about one at a time.

Input: a law.  Output: its `Branch` records, each a smooth tree and the comparisons under which the
law is that tree; together they cover every point.
"""

from collections.abc import Container, Iterable, Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import final

from piezo_sym.expressions.calculus import choices, clause, rule
from piezo_sym.expressions.functions import RECORDS
from piezo_sym.expressions.tree import (
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
    decided,
    first_choice,
    knots,
    rebuild,
    walk,
)

#: A law with more branches than these is left open.
MOST = 400
OPPOSITE = {"<": ">=", "<=": ">", ">": "<=", ">=": "<"}
KINKED = frozenset(name for name, record in RECORDS.items() if not record.smooth)


@final
@dataclass(frozen=True)
class Branch:
    """A smooth piece of a law: `value` where all of `conditions` hold."""

    conditions: tuple[Cmp, ...]
    value: Expr

    @property
    def path(self) -> tuple[Cmp, ...]:
        """Its conditions, each after what must hold for it to have a value; the value's last."""
        steps = ((*value_conditions(part), part) for part in self.conditions)
        return (*(claim for step in steps for claim in step), *value_conditions(self.value))


@final
@dataclass(eq=False)
class TooManyBranchesError(Exception):
    """A law has more than `most` branches."""

    most: int


def branches(law: Expr, known: Iterable[Cmp] = ()) -> tuple[Branch, ...]:
    """Return the branches of a law where the `known` comparisons of a domain hold.

    Raises `TooManyBranchesError` if there are more than `MOST`.
    """
    found: list[Branch] = []
    for branch in _pieces(settled(law, known), ()):
        found.append(branch)
        if len(found) > MOST:
            raise TooManyBranchesError(MOST)
    return tuple(found)


def settled(law: Expr, known: Iterable[Cmp]) -> Expr:
    """Return a law with its kinks as choices, those on `known` comparisons decided."""
    if not has_kinks(law):
        return law
    holding, facts = _facts(tuple(known))
    return decided(with_choices(law, holding), facts)


@lru_cache(8)
def _facts(known: tuple[Cmp, ...]) -> tuple[frozenset[Cmp], dict[Cmp, bool]]:
    """Return the comparisons among some that have an opposite; these hold, the opposites do not."""
    holding = frozenset(condition for condition in known if condition.op in OPPOSITE)
    opposites = {opposite(condition): False for condition in holding}
    return holding, opposites | dict.fromkeys(holding, True)


def has_kinks(node: Node) -> bool:
    """Return whether a tree has choices, or functions with kinks."""
    return any(
        isinstance(n, If) or (isinstance(n, Call) and n.function in KINKED) for n in walk(node)
    )


def cover(found: tuple[Branch, ...]) -> Cmp:
    """Return the claim that at every point the conditions of some branch hold."""
    inside = tuple(_indicator(branch.conditions) for branch in found)
    return Cmp(">=", Add(inside) if len(inside) > 1 else inside[0], ONE)


def _indicator(conditions: tuple[Cmp, ...]) -> Expr:
    """Return a law that is 1 where all comparisons hold, evaluated in order, and else 0."""
    if not conditions:
        return ONE
    return If(_indicator(conditions[1:]), conditions[0], ZERO)


def parts(branch: Branch) -> tuple[Expr, ...]:
    """Return the smooth laws of a branch of ``together``, which takes several laws."""
    if not isinstance(branch.value, Call):
        raise TypeError("a branch of one law has no parts")
    return branch.value.args


def with_choices(node: Expr, known: Container[Cmp] = ()) -> Expr:
    """Return a law with kinked functions as choices; `known` comparisons hold."""
    inner = rebuild(node, lambda part: with_choices(part, known))
    if not isinstance(inner, Call) or inner.function not in KINKED:
        return inner
    if knots(inner):
        return choices(inner)
    record, (z, *_), w = RECORDS[inner.function], inner.args, inner.args[-1]
    pieces, wide = rule(record.choices, z, w), Cmp(">=", w, ZERO)
    if not record.width or wide in known or (isinstance(w, Num) and w.value >= 0):
        return pieces
    return If(pieces, wide, with_choices(rule(record.formula, z, w)))


def choice_conditions(node: Node) -> tuple[Cmp, ...]:
    """Return the distinct comparisons of a law's choices, outermost first."""
    return tuple(dict.fromkeys(n.condition for n in walk(node) if isinstance(n, If)))


def opposite(condition: Cmp) -> Cmp:
    """Return the comparison that holds where `condition` does not."""
    return Cmp(OPPOSITE[condition.op], condition.left, condition.right)


def _pieces(law: Expr, path: tuple[Cmp, ...]) -> Iterator[Branch]:
    """Yield the branches of a law after the comparisons decided so far."""
    choice = first_choice(law)
    if choice is None:
        yield Branch(path, law)
        return
    for holds in (True, False):
        taken = decided(law, {choice: holds, opposite(choice): not holds})
        condition = choice if holds else opposite(choice)
        yield from _pieces(taken, (*path, condition))


def value_conditions(node: Node) -> Iterator[Cmp]:
    """Yield the conditions under which a smooth tree has a value, inner parts first."""
    for part in reversed(tuple(walk(node))):
        match part:
            case Div(_, right) if not isinstance(right, Num) or right == ZERO:
                yield Cmp("!=", right, ZERO)
            case Pow(base, exponent) if exponent.denominator != 1:
                yield Cmp(">=" if exponent > 0 else ">", base, ZERO)
            case Pow(base, exponent) if exponent < 0:
                yield Cmp("!=", base, ZERO)
            case Call(function, (arg, *more)) if function in RECORDS and RECORDS[function].domain:
                yield from clause(RECORDS[function].domain, arg, part)
                yield from (Cmp(">", w, ZERO) for w in more)
