"""Laws of products that are 0/0 somewhere, with their limit there: sinh(x)/x*x is sinh(x).

Input: a tree and a name.  Output: a tree that is equal where the first has a value.
"""

from contextlib import suppress
from fractions import Fraction
from functools import reduce

from piezo_sym.expressions.calculus import add, derivative, div, mul, neg, rebuilt
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
    children,
    names,
    rebuild,
    walk,
)

#: Whole powers up to this one are split into factors.
MOST_FACTORS = 8


def without_common_factors(node: Expr, name: str, place: Expr = ZERO) -> Expr:
    """Return a product or quotient, common factors in `name` cancelled: (1 + sinh(x)/x)*x.

    Only polynomials are cancelled, since they have a value everywhere: log(x)/log(x) stays.  So
    does what is no multiple of the distance from `place`, as cosh(x)/x*x: there node/x is infinite.
    """
    above, below = factors(node)
    changed = False
    for factor in [f for f in above if name in names(f) and _is_polynomial(f)]:
        others = [*above]
        others.remove(factor)
        found = _without(factor, others, below)
        if found:
            changed, (above, below) = True, found
    law = _quotient(above, below) if changed else node
    with suppress(ZeroDivisionError):
        return law if changed and _vanishes(law, name, place) else node
    return node


def slope_at(node: Expr, name: str, place: Expr) -> Expr | None:
    """Return the slope of a law for one value of a name; None if it has a kink or no value."""
    with suppress(ZeroDivisionError):
        slope = _at(derivative(node, name), name, place)
        return slope if all(map(_has_slope, walk(node))) else None
    return None


def _without(
    factor: Expr, above: list[Expr], below: list[Expr]
) -> tuple[list[Expr], list[Expr]] | None:
    """Return the factors of a quotient times a factor that cancels in it, or in terms of a sum."""
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
    """Return the terms of a sum; nothing of what is no sum."""
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
    kink may be zero or not, as max(x - gap, 0) is: its parameters decide that.
    """
    match node:
        case Neg(arg):
            return _vanishes(arg, name, place)
        case Mul(left, right):
            return _vanishes(left, name, place) or _vanishes(right, name, place)
        case Div(left, right):
            return _at(right, name, place) != ZERO and _vanishes(left, name, place)
        case If():
            return True
        case Call(function) if not RECORDS[function].smooth:
            return True
    return _at(node, name, place) == ZERO and all(map(_has_slope, walk(node)))


def _has_slope(node: Node) -> bool:
    if isinstance(node, Call):
        return RECORDS[node.function].transcendental and node.function != "pow"
    return not isinstance(node, If) and not (isinstance(node, Pow) and node.exponent % 1)


def _at(node: Expr, name: str, place: Expr) -> Expr:
    """Return a law for one value of a name, as far as it is known.

    Raises `ZeroDivisionError` where it divides by zero.
    """
    if node == Sym(name):
        return place
    parts = rebuild(node, lambda part: _at(part, name, place))
    match parts:
        case Div(_, right) if right == ZERO:
            raise ZeroDivisionError
        case Pow(base, exponent) if base == ZERO and exponent < 0:
            raise ZeroDivisionError
        case Call(function, (Num(value), *_)) if known := RECORDS[function].known:
            return Num(Fraction(known[1])) if value == known[0] else parts
    return rebuilt(parts, lambda part: part)


def _is_polynomial(node: Node) -> bool:
    if isinstance(node, Pow) and (node.exponent < 0 or node.exponent.denominator != 1):
        return False
    known = isinstance(node, Num | Sym | Neg | Add | Mul | Pow)
    return known and all(map(_is_polynomial, children(node)))


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
