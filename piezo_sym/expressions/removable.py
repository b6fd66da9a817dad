"""Laws of products that are 0/0 somewhere, with their limit there: sinh(x)/x*x is sinh(x).

Input: a tree and a name.  Output: a tree that is equal where the first has a value.
"""

from contextlib import suppress
from fractions import Fraction
from functools import reduce

from piezo_sym.expressions.calculus import add, derivative, div, mul, neg, rebuilt
from piezo_sym.expressions.exact_eval import value_of
from piezo_sym.expressions.functions import RECORDS
from piezo_sym.expressions.tree import (
    ONE,
    ZERO,
    Add,
    Call,
    Div,
    Expr,
    If,
    Mul,
    Neg,
    Node,
    Num,
    Pow,
    Sym,
    names,
    rebuild,
    walk,
)

#: Whole powers up to this one are split into factors.
MOST_FACTORS = 8


def without_common_factors(node: Expr, name: str, place: Expr = ZERO) -> Expr:
    """Return products and quotients, their distance from `place` cancelled: (1 + sinh(x)/x)*x.

    Another factor stays, as (n*x + n)/(n*x + n) has no value for n = 0.  So does what is no
    multiple of the distance, as cosh(x)/x*x: there node/x is infinite.  Of kinks see `value_at`.
    """
    if isinstance(node, Add):
        return rebuild(node, lambda term: without_common_factors(term, name, place))
    above, below = factors(node)
    moved, changed = add(Sym(name), neg(place)), False
    for _ in range(above.count(moved)):
        others = [*above]
        others.remove(moved)
        found = _without(moved, others, below)
        if found:
            changed, (above, below) = True, found
    law = _quotient(above, below) if changed else node
    with suppress(ArithmeticError, ValueError):
        return law if changed and _vanishes(law, name, place) else node
    return node


def at_rest(law: Expr, name: str) -> Expr:
    """Return a law with its limit where `name` is 0, if that is known to be zero."""
    limit = without_common_factors(law, name)
    return limit if value_at(limit, name, ZERO) == ZERO else law


def value_at(node: Expr, name: str, place: Expr) -> Expr | None:
    """Return a law for one value of a name, as far as it is known; None where it has no value.

    Parameters decide whether max(x - gap, 0) is zero there: then (1/x)*max(x - gap, 0) is
    bounded, and else infinite.
    """
    with suppress(ArithmeticError, ValueError):
        return _at(node, name, place)
    return None


def slope_at(node: Expr, name: str, place: Expr) -> Expr | None:
    """Return the slope of a law for one value of a name; None if it has a kink or no value."""
    with suppress(ArithmeticError, ValueError):
        slope = _at(derivative(node, name), name, place)
        return slope if all(map(_has_slope, walk(node))) else None
    return None


def _without(
    factor: Expr, above: list[Expr], below: list[Expr]
) -> tuple[list[Expr], list[Expr]] | None:
    """Return numerator and denominator of a quotient times `factor`, which cancels, or None."""
    if factor in below:
        below = [*below]
        below.remove(factor)
        return above, below
    for n, part in enumerate(above):
        terms = [(term, _without(factor, *factors(term))) for term in _terms(part)]
        if any(found for _, found in terms):
            whole = (_quotient(*found) if found else mul(term, factor) for term, found in terms)
            return [*above[:n], add(*whole), *above[n + 1 :]], below
    return None


def _terms(node: Expr) -> tuple[Expr, ...]:
    """Return the terms of a sum; an empty tuple for any other tree."""
    if isinstance(node, Neg):
        return tuple(map(neg, _terms(node.arg)))
    return node.terms if isinstance(node, Add) else ()


def _quotient(above: list[Expr], below: list[Expr]) -> Expr:
    """Return the quotient of two products."""
    one: Expr = ONE
    top, bottom = (reduce(mul, factors, one) for factors in (above, below))
    return div(top, bottom)


def _vanishes(node: Expr, name: str, place: Expr) -> bool:
    """Return whether a law is at most a multiple of the distance from `place`, close to it.

    It is zero there, and has a slope: it is made of functions with derivatives.  A factor with a
    kink is so if it is zero there, see `value_at`.  Raises where it has no value there.
    """
    match node:
        case Neg(arg):
            return _vanishes(arg, name, place)
        case Mul(left, right):
            return _vanishes(left, name, place) or _vanishes(right, name, place)
        case Div(left, right):
            return _at(right, name, place) != ZERO and _vanishes(left, name, place)
    if _has_kink(node) and name in names(node):
        _at(node, name, place)
        return all(_has_slope(part) or _has_kink(part) for part in walk(node))
    return _at(node, name, place) == ZERO and all(map(_has_slope, walk(node)))


def _has_kink(node: Node) -> bool:
    return isinstance(node, If) or (isinstance(node, Call) and not RECORDS[node.function].smooth)


def _has_slope(node: Node) -> bool:
    if isinstance(node, Call):
        return RECORDS[node.function].transcendental and node.function != "pow"
    return not isinstance(node, If) and not (isinstance(node, Pow) and node.exponent % 1)


def _at(node: Expr, name: str, place: Expr) -> Expr:
    """Return a law for one value of a name, as far as it is known.

    Raises `ArithmeticError` or `ValueError` where it has no value.
    """
    if node == Sym(name):
        return place
    parts = rebuild(node, lambda part: _at(part, name, place))
    match parts:
        case Div(_, right) if right == ZERO:
            raise ZeroDivisionError
        case Pow(base, exponent) if base == ZERO and exponent < 0:
            raise ZeroDivisionError
        case If() | Call() if _has_kink(parts) and not names(parts):
            value = value_of(parts, {})
            return Num(value) if isinstance(value, Fraction) else parts
        case Call(function, (Num(value), *_)) if known := RECORDS[function].known:
            return Num(Fraction(known[1])) if value == known[0] else parts
    return rebuilt(parts, lambda part: part)


def factors(node: Expr, most: int = MOST_FACTORS) -> tuple[list[Expr], list[Expr]]:
    """Return the factors of numerator and denominator, those of powers up to `most` one by one."""
    match node:
        case Mul(left, right) | Div(left, right):
            (above, below), (more, less) = factors(left, most), factors(right, most)
            if isinstance(node, Div):
                more, less = less, more
            return [*above, *more], [*below, *less]
        case Pow(base, exponent) if exponent.denominator == 1 and 0 < exponent <= most:
            above, below = factors(base, most)
            return above * exponent.numerator, below * exponent.numerator
        case Neg(arg):
            above, below = factors(arg, most)
            return [Num(Fraction(-1)), *above], below
    return [node], []
