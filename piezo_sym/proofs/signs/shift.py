"""A law recentred at a rational point, so that zeros and kinks there are exact.

Input: a tree in one name x, a rational point c, a side.  Output: the tree in t, for x = c + t or
x = c - t.  Parts that are affine in t with rational coefficients are written as such: x - 300 at
c = 300 is t itself, not a difference of rounded numbers.  Where intervals are too wide, `vanishes`
shows by SymPy that a value such as ``log(1 + exp(0)) - log(2)`` is exactly zero; each part must
have a value there, and none may jump.
"""

from fractions import Fraction
from functools import lru_cache
from typing import TypeAlias

import sympy as sp

from piezo_sym.algebra.symbols import to_sympy
from piezo_sym.expressions.calculus import derivative, inserted
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
    Num,
    Sym,
    children,
    rebuild,
    walk,
)

#: The coefficients of constant + slope*t.
Affine: TypeAlias = tuple[Fraction, Fraction]

T = Sym("t")


def recentred(tree: Expr, centre: Fraction, side: int) -> Expr:
    """Return a tree in one name with ``centre + side*t`` for that name.

    Comparisons get zero on the right.
    """
    match tree:
        case Sym():
            return _written((centre, Fraction(side)))
        case If(then, Cmp(op, left, right), other):
            difference = recentred(Add((left, Neg(right))), centre, side)
            branches = recentred(then, centre, side), recentred(other, centre, side)
            return If(branches[0], Cmp(op, difference, ZERO), branches[1])
    moved = rebuild(tree, lambda part: recentred(part, centre, side))
    if isinstance(moved, Add):
        return _collected(moved)
    affine = _affine(moved)
    return moved if affine is None else _written(affine)


def _collected(tree: Add) -> Expr:
    """Return a sum with its affine terms collected in front."""
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


def _written(affine: Affine) -> Expr:
    constant, slope = affine
    if slope == 0:
        return Num(constant)
    moving = T if slope == 1 else Mul(Num(slope), T)
    return moving if constant == 0 else Add((Num(constant), moving))


def _affine(tree: Expr) -> Affine | None:
    """Return the coefficients of an affine polynomial; None for other trees."""
    for part in walk(tree):
        if not isinstance(part, Num | Sym | Neg | Add | Mul):
            match part:
                case Div(_, Num(value)) if value != 0:
                    continue
            return None
    slope, constant = derivative(tree, T.name), inserted(tree, {T.name: ZERO})
    if isinstance(slope, Num) and isinstance(constant, Num):
        return constant.value, slope.value
    return None


#: A function of larger or irrational numbers is kept as a symbol.
LARGEST = 1000


def vanishes(tree: Expr, at: Fraction) -> bool:
    """Return whether a tree is certainly zero at a number, and continuous there if defined."""
    return _value(tree, at) == 0


def rational_at(tree: Expr, at: Fraction) -> Fraction | None:
    """Return the value of a tree at a number if it is certainly rational, else None."""
    value = _value(tree, at)
    return Fraction(int(value.p), int(value.q)) if isinstance(value, sp.Rational) else None


@lru_cache(maxsize=4096)
def _value(node: Expr, at: Fraction) -> sp.Expr | None:
    """Return an exact value; None if there may be a jump, or no finite value."""
    match node:
        case Sym():
            return sp.Rational(at.numerator, at.denominator)
        case If():
            return None
        case Call(function) if RECORDS[function].jumps:
            return None
    parts = {f"part_{n}": _value(part, at) for n, part in enumerate(children(node))}
    if None in parts.values():
        return None
    plain = all(isinstance(part, sp.Rational) and abs(part) < LARGEST for part in parts.values())
    if isinstance(node, Call) and not plain:
        return sp.Function(node.function)(*parts.values())
    words = iter(parts)
    value = sp.expand(to_sympy(rebuild(node, lambda _: Sym(next(words))), parts))
    return None if value.has(sp.zoo, sp.nan, sp.oo) else value
