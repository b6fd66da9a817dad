"""A law split by the choices that its parameters make, and sums by what one letter reduces to.

Input: a law, its letter, and what is known to be positive.  Output: pairs of guards and the law
where they hold.  Each choice gives a guard and its opposite, so that the pairs cover all; a
condition is decided after those that lead to it, since only then must it have a value.
"""

from collections import Counter
from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import reduce as fold
from itertools import islice
from typing import TypeAlias

from piezo_sym.expressions.calculus import neg
from piezo_sym.expressions.functions import RECORDS
from piezo_sym.expressions.tree import (
    ZERO,
    Add,
    Call,
    Cmp,
    Div,
    Expr,
    If,
    Mul,
    Neg,
    Node,
    Num,
    Pow,
    children,
    decided,
    names,
    walk,
)
from piezo_sym.proofs.branches import opposite
from piezo_sym.proofs.signs.reduce import Positive, factored, reductions, settings
from piezo_sym.proofs.signs.shift import rational_at

#: More cases than these are not looked at.
MOST = 32

Guards: TypeAlias = tuple[Cmp, ...]


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
            case Call(function, args) if RECORDS[function].domain and not all(map(positive, args)):
                return False
            case Pow(base, e) if (e < 0 or e.denominator != 1) and not positive(base):
                return False
    return True


#: Terms of a sum that is multiplied out.
MOST_TERMS = 24


def grouped(terms: Sequence[Expr], letter: str, positive: Positive) -> list[Expr] | None:
    """Return a sum as sums of one scale each, with one product in front; None if it cannot be.

    Terms without the letter go to the first group that has the same in front.
    """
    groups: list[Expr] = []
    left = list(terms)
    plain, divided, single = settings(Add(tuple(terms)), letter, positive)
    for setting in (*divided, plain, *single):
        fronts: dict[frozenset[tuple[Expr, Fraction]], list[Expr]] = {}
        for term in left:
            part = factored(term, setting)
            if {*names(part.bound)} <= {letter}:
                fronts.setdefault(frozenset(part.free.items()), []).append(term)
        made = [found for found in fronts.values() if letter in names(Add(tuple(found)))]
        groups += [found[0] if len(found) == 1 else Add(tuple(found)) for found in made]
        for term in (term for found in made for term in found):
            left.remove(term)
    return None if left else groups


def balanced(groups: Sequence[Expr], letter: str, positive: Positive) -> list[Expr] | None:
    """Return a sum's groups, each less its value where the letter is zero; None if these remain.

    ``F*exp(v/v_1)`` and ``-F*exp(-v/v_2)`` are F and -F there, which cancel.
    """
    total: dict[frozenset[tuple[Expr, int]], Fraction] = {}
    made: list[Expr] = []
    for group in groups:
        reduction = next(iter(reductions(group, letter, positive)), None)
        at_zero = None if reduction is None else rational_at(reduction.f, Fraction(0))
        if reduction is None or at_zero is None:
            return None
        front = frozenset(Counter(reduction.prefactors).items())
        total[front] = total.get(front, Fraction(0)) + at_zero
        constant: Expr = Num(-at_zero)
        constant = fold(Mul, reduction.prefactors, constant)
        made.append(Add((group, constant)) if at_zero else group)
    return None if any(total.values()) else made


def summands(node: Expr) -> list[Expr]:
    """Return a law as a sum, products of sums multiplied out; few terms, or the law itself."""
    match node:
        case Add(terms):
            found = [part for term in terms for part in summands(term)]
        case Neg(arg):
            found = [neg(part) for part in summands(arg)]
        case Mul(left, right):
            found = [Mul(a, b) for a in summands(left) for b in summands(right)]
        case Div(left, right):
            found = [Div(part, right) for part in summands(left)]
        case _:
            return [node]
    return found if len(found) <= MOST_TERMS else [node]


def choice_outside(node: Expr) -> Expr:
    """Return a product with a choice among its factors as a choice of products."""
    match node:
        case Neg(arg) if isinstance(inner := choice_outside(arg), If):
            return If(neg(inner.then), inner.condition, neg(inner.other))
        case Mul(left, right) if isinstance(inner := choice_outside(left), If):
            return If(_product(inner.then, right), inner.condition, _product(inner.other, right))
        case Mul(left, right) if isinstance(inner := choice_outside(right), If):
            return If(_product(left, inner.then), inner.condition, _product(left, inner.other))
        case Div(left, right) if isinstance(inner := choice_outside(left), If):
            return If(Div(inner.then, right), inner.condition, Div(inner.other, right))
    return node


def _product(left: Expr, right: Expr) -> Expr:
    return ZERO if ZERO in (left, right) else Mul(left, right)
