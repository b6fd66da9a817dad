"""A law split by the choices that its parameters make, whatever its letter is.

Input: a law, its letter, and what is known to be positive.  Output: pairs of guards and the law
where they hold.  Each choice gives a guard and its opposite, so that the pairs cover all; a
condition is decided after those that lead to it, since only then must it have a value.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import islice
from typing import TypeAlias

from piezo_sym.expressions.functions import RECORDS
from piezo_sym.expressions.tree import (
    Call,
    Cmp,
    Div,
    Expr,
    If,
    Node,
    Num,
    Pow,
    children,
    names,
    walk,
)
from piezo_sym.proofs.branches import decided, opposite

#: More cases than these are not looked at.
MOST = 32

Guards: TypeAlias = tuple[Cmp, ...]
Positive: TypeAlias = Callable[[Expr], bool]


def cases(law: Expr, letter: str, positive: Positive) -> tuple[tuple[Guards, Expr], ...] | None:
    """Return guards and the law where they hold, guards in order of evaluation; None if too many.

    A condition below a choice by the letter is decided only if it has a value everywhere.
    """
    found = tuple(islice(_split(law, letter, positive, ()), MOST + 1))
    return found if len(found) <= MOST else None


def _split(
    law: Expr, letter: str, positive: Positive, guards: Guards
) -> Iterator[tuple[Guards, Expr]]:
    choice = _next(law, letter, positive, sure=True)
    if choice is None:
        yield guards, law
        return
    for holds in (True, False):
        guard = choice if holds else opposite(choice)
        yield from _split(decided(law, {choice: holds}), letter, positive, (*guards, guard))


def _next(node: Node, letter: str, positive: Positive, *, sure: bool) -> Cmp | None:
    """Return the comparison to decide next; `sure` says that a tree is evaluated for any letter."""
    if not isinstance(node, If):
        found = (_next(part, letter, positive, sure=sure) for part in children(node))
        return next((choice for choice in found if choice), None)
    condition = node.condition
    if inner := _next(condition, letter, positive, sure=sure):
        return inner
    if letter not in names(condition) and (sure or _total(condition, positive)):
        return condition
    found = (_next(part, letter, positive, sure=False) for part in (node.then, node.other))
    return next((choice for choice in found if choice), None)


def _total(condition: Cmp, positive: Positive) -> bool:
    """Return whether a comparison has a value wherever its names have."""
    for part in walk(condition):
        match part:
            case Num() | Div(_, Num()):
                continue
            case Div(_, arg) if not positive(arg):
                return False
            case Call(function, (arg,)) if RECORDS[function].domain and not positive(arg):
                return False
            case Pow(base, e) if (e < 0 or e.denominator != 1) and not positive(base):
                return False
    return True
