"""A law split into cases by the choices on its parameters, and a sum into terms of one scale.

Input: a law, its letter, and a test of positivity.  Output: pairs of guards and the law where they
hold.  Each choice gives a guard and its opposite, so the pairs cover all points.  A condition is
decided after those around it, as only then must it have a value.
"""

from collections import Counter
from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import reduce as fold
from itertools import islice
from typing import TypeAlias

from piezo_sym.expressions.calculus import neg
from piezo_sym.expressions.tree import (
    ZERO,
    Add,
    Cmp,
    Div,
    Expr,
    If,
    Mul,
    Neg,
    Node,
    Num,
    children,
    decided,
    names,
)
from piezo_sym.proofs.branches import opposite, value_conditions
from piezo_sym.proofs.signs.reduce import Positive, factored, reductions, settings
from piezo_sym.proofs.signs.shift import rational_at

#: A law with more cases is left open.
MOST = 32

Guards: TypeAlias = tuple[Cmp, ...]


def cases(law: Expr, letter: str, positive: Positive) -> tuple[tuple[Guards, Expr], ...] | None:
    """Return a law's cases: (guards in order of evaluation, law there); None if too many.

    A condition inside a choice by the letter is decided only if it has a value everywhere.
    """
    found = tuple(islice(_split(law, letter, positive, ()), MOST + 1))
    return found if len(found) <= MOST else None


def _split(
    law: Expr, letter: str, positive: Positive, guards: Guards
) -> Iterator[tuple[Guards, Expr]]:
    choice = _next_choice(law, letter, positive, sure=True)
    if choice is None:
        yield guards, law
        return
    for holds in (True, False):
        guard = choice if holds else opposite(choice)
        yield from _split(decided(law, {choice: holds}), letter, positive, (*guards, guard))


def _next_choice(node: Node, letter: str, positive: Positive, *, sure: bool) -> Cmp | None:
    """Return the comparison to decide next; `sure`: the tree is evaluated for every letter."""
    if not isinstance(node, If):
        found = (_next_choice(part, letter, positive, sure=sure) for part in children(node))
        return next((choice for choice in found if choice), None)
    condition = node.condition
    if inner := _next_choice(condition, letter, positive, sure=sure):
        return inner
    if letter not in names(condition) and (sure or _is_total(condition, positive)):
        return condition
    found = (_next_choice(part, letter, positive, sure=False) for part in (node.then, node.other))
    return next((choice for choice in found if choice), None)


def _is_total(condition: Cmp, positive: Positive) -> bool:
    """Return whether a comparison has a value for all values of its names."""
    return all(positive(claim.left) for claim in value_conditions(condition))


#: Most terms of an expanded sum.
MOST_TERMS = 24


def grouped(terms: Sequence[Expr], letter: str, positive: Positive) -> list[Expr] | None:
    """Return a sum as groups of terms with one scale and one prefactor each; None if impossible.

    Terms without the letter go to the first group with their prefactor.
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
        found = [group for group in fronts.values() if letter in names(Add(tuple(group)))]
        groups += [group[0] if len(group) == 1 else Add(tuple(group)) for group in found]
        for term in (term for group in found for term in group):
            left.remove(term)
    return None if left else groups


def balanced(groups: Sequence[Expr], letter: str, positive: Positive) -> list[Expr] | None:
    """Return a sum's groups, each less its value at letter 0; None if these values do not cancel.

    ``F*exp(v/v_1)`` and ``-F*exp(-v/v_2)`` have the values F and -F, which cancel.
    """
    total: dict[frozenset[tuple[Expr, int]], Fraction] = {}
    shifted: list[Expr] = []
    for group in groups:
        reduction = next(iter(reductions(group, letter, positive)), None)
        at_zero = None if reduction is None else rational_at(reduction.f, Fraction(0))
        if reduction is None or at_zero is None:
            return None
        front = frozenset(Counter(reduction.prefactors).items())
        total[front] = total.get(front, Fraction(0)) + at_zero
        constant: Expr = Num(-at_zero)
        constant = fold(Mul, reduction.prefactors, constant)
        shifted.append(Add((group, constant)) if at_zero else group)
    return None if any(total.values()) else shifted


def summands(node: Expr) -> list[Expr]:
    """Return the terms of a law with products of sums expanded, or the law if they are too many."""
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
    """Return a product that has a choice as a factor as a choice of products."""
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
