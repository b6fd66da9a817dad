"""A law as a function of the distance from a point, so that zeros and kinks there are exact.

Input: a tree in one name x, a rational point c, a side.  Output: the tree of t, for x = c + t or
x = c - t.  Parts that are affine in t with rational coefficients are written as such, so that
x - 300 at c = 300 is t itself and not a difference of rounded numbers.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TypeAlias

from piezo_sym.expressions.tree import (
    ZERO,
    Add,
    Cmp,
    Div,
    Expr,
    If,
    Mul,
    Neg,
    Num,
    Sym,
    rebuild,
)

#: The coefficients of constant + slope*t.
Affine: TypeAlias = tuple[Fraction, Fraction]

T = Sym("t")


def recentred(tree: Expr, centre: Fraction, side: int) -> Expr:
    """Return a tree in one name as a tree of t, that name being ``centre + side*t``.

    Comparisons are written with zero on their right.
    """
    match tree:
        case Sym():
            return _written((centre, Fraction(side)))
        case If(then, Cmp(op, left, right), other):
            difference = recentred(Add((left, Neg(right))), centre, side)
            branches = recentred(then, centre, side), recentred(other, centre, side)
            return If(branches[0], Cmp(op, difference, ZERO), branches[1])
    moved = rebuild(tree, lambda part: recentred(part, centre, side))
    return _collected(moved) if isinstance(moved, Add) else _short(moved)


def _collected(tree: Add) -> Expr:
    """Return a sum with all its affine terms added up first."""
    constant, slope, others = Fraction(0), Fraction(0), list[Expr]()
    for term in _terms(tree):
        affine = _affine(term)
        if affine is None:
            others.append(term)
        else:
            constant, slope = constant + affine[0], slope + affine[1]
    if others and constant == slope == 0:
        return others[0] if len(others) == 1 else Add(tuple(others))
    return Add((_written((constant, slope)), *others)) if others else _written((constant, slope))


def _terms(tree: Expr) -> list[Expr]:
    if isinstance(tree, Add):
        return [inner for term in tree.terms for inner in _terms(term)]
    return [tree]


def _short(tree: Expr) -> Expr:
    affine = _affine(tree)
    return tree if affine is None else _written(affine)


def _written(affine: Affine) -> Expr:
    constant, slope = affine
    if slope == 0:
        return Num(constant)
    moving = T if slope == 1 else Mul(Num(slope), T)
    return moving if constant == 0 else Add((Num(constant), moving))


def _affine(tree: Expr) -> Affine | None:
    """Return the coefficients of a tree whose parts are written; None if it is not affine."""
    match tree:
        case Num(value):
            return value, Fraction(0)
        case Sym():
            return Fraction(0), Fraction(1)
        case Neg(arg):
            return _scaled(arg, Fraction(-1))
        case Mul(Num(value), arg) | Mul(arg, Num(value)):
            return _scaled(arg, value)
        case Div(arg, Num(value)) if value != 0:
            return _scaled(arg, 1 / value)
        case Add((left, right)):
            first, second = _affine(left), _affine(right)
            if first is not None and second is not None:
                return first[0] + second[0], first[1] + second[1]
    return None


def _scaled(arg: Expr, factor: Fraction) -> Affine | None:
    affine = _affine(arg)
    return None if affine is None else (affine[0] * factor, affine[1] * factor)
