"""Antiderivatives of laws without choices, by rules.

Input: a tree and a name.  Output: a tree, or a `NoFormError` where there is none of a simple form.
"""

from collections.abc import Iterable
from contextlib import suppress
from fractions import Fraction
from functools import reduce
from math import comb

from piezo_sym.expressions.calculus import add, derivative, div, mul, neg, power, rule
from piezo_sym.expressions.functions import RECORDS
from piezo_sym.expressions.tidying import collected
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
    Num,
    Pow,
    Sym,
    names,
    walk,
)

#: The coefficients of a polynomial, by power.
Polynomial = dict[int, Expr]

#: The most nodes to which products of polynomials are expanded; beyond, no energy is found.
MAX_PARTS = 20_000


class NoFormError(Exception):
    """The rules find no antiderivative of a law, or it is no polynomial."""


def by_rules(node: Expr, name: str) -> Expr:
    """Return an antiderivative of `node` by `name`.

    Known forms: polynomials, also as x/(a/(1 + x**2)), and sums of c*(a*x + b)**n, n a number or a
    law free of x, also as (c/(a*x + b))**n, and of c*f(a*x + b); c, a, b free of x.  Raises
    `NoFormError` if the law has none of these forms.
    """
    if name not in names(node):
        return mul(node, Sym(name))
    match node:
        case Neg(arg):
            return neg(by_rules(arg, name))
        case Add(terms) if not _divides_well(slope_of(node, name)):
            return add(*(by_rules(term, name) for term in terms))
        case Mul(left, right) if name not in names(left):
            return mul(left, by_rules(right, name))
        case Mul(left, right) if name not in names(right):
            return mul(right, by_rules(left, name))
        case Div(left, right) if name not in names(right):
            return _over(by_rules(left, name), right)
        case Div(left, Div(top, bottom)) if name not in names(top):  # phi/(L/(1 + phi**2))
            return by_rules(div(mul(left, bottom), top), name)
        case Call(function, (arg, *rest)) if RECORDS[function].integral:
            if function in {"min", "max"} and name not in names(arg):
                arg, *rest = (*rest, arg)
            slope = None if any(name in names(w) for w in rest) else slope_of(arg, name)
            if slope is not None:
                integral = rule(RECORDS[function].integral, arg, rest[0] if rest else ZERO, node)
                return divided(integral, slope)
    with suppress(NoFormError):
        return _power_rule(node, name)
    with suppress(NoFormError):
        return _of_degree(node, name, Sym(name))
    slopes = ((part, slope_of(part, name)) for part in walk(node) if isinstance(part, Add))
    base = next((part for part, slope in slopes if slope), None)
    if base is None:
        raise NoFormError
    return _of_degree(node, name, base)


def _of_degree(node: Expr, name: str, base: Expr) -> Expr:
    """Return the integral of a product c*b**n of powers of one base b = a*x + d.

    With b' = a and w the exponent in all, (b*f)' = a*f + b*f*w*a/b = (w + 1)*a*f: it is an integral
    for each sign of b for which the law f has a value.
    """
    degree, raised = _degree(node, name, base)
    slope = slope_of(base, name)
    exponent = add(*raised, Num(degree + 1))
    if slope is None or (degree < -1 and base == Sym(name)) or collected(exponent) == ZERO:
        raise NoFormError
    return div(divided(mul(base, node), slope), exponent)


def _degree(node: Expr, name: str, base: Expr) -> tuple[Fraction, tuple[Expr, ...]]:
    """Return the exponent n of a product c*b**n of a base b: a number, and its terms with names.

    Raises `NoFormError` if it is no such product.
    """
    if name not in names(node):
        return Fraction(0), ()
    if node == base:
        return Fraction(1), ()
    match node:
        case Neg(arg):
            return _degree(arg, name, base)
        case Mul(left, right):
            (one, more), (two, others) = _degree(left, name, base), _degree(right, name, base)
            return one + two, more + others
        case Div(left, right):
            (one, more), (two, others) = _degree(left, name, base), _degree(right, name, base)
            if not others:
                return one - two, more
        case Pow(arg, exponent):
            one, more = _degree(arg, name, base)
            if not more:
                return one * exponent, ()
        case Call("exp", (Mul(w, Call("log", (arg,))),)) | Call("pow", (arg, w)):
            one, more = _degree(arg, name, base)
            if not more and name not in names(w):
                return Fraction(0), (mul(Num(one), w),)
        case Call(function, (arg,)) if RECORDS[function].power:
            one, more = _degree(arg, name, base)
            if not more:
                return one * (RECORDS[function].power or 1), ()
    raise NoFormError


def _power_rule(node: Expr, name: str) -> Expr:
    base, exponent = (node.base, node.exponent) if isinstance(node, Pow) else (node, Fraction(1))
    slope = slope_of(base, name)
    if slope is None or exponent == -1:  # a polynomial that is no sum of powers
        terms = _polynomial(node, name)
        found = {n: mul(terms[n], power(Sym(name), Fraction(n + 1))) for n in sorted(terms)}
        return add(*(_quotient(term, n + 1) for n, term in found.items()))
    raised = power(base, exponent + 1)
    match slope:
        case Div(Num(value), bottom):
            return Div(mul(bottom, raised), Num((exponent + 1) * value))
    return Div(raised, mul(Num(exponent + 1), slope))


def _quotient(term: Expr, number: int) -> Expr:
    """Return ``term/number`` written as a quotient, the sign in front."""
    if isinstance(term, Neg):
        return neg(_quotient(term.arg, number))
    return term if number == 1 else Div(term, Num(Fraction(number)))


def _polynomial(node: Expr, name: str) -> Polynomial:
    """Return the coefficients of a polynomial in `name`, by power."""
    if name not in names(node):
        return {0: node}
    match node:
        case Sym():
            return {1: ONE}
        case Neg(arg):
            return {n: neg(c) for n, c in _polynomial(arg, name).items()}
        case Add(terms):
            return _sum_of(_polynomial(term, name) for term in terms)
        case Mul(left, right):
            return _product_of(_polynomial(left, name), _polynomial(right, name))
        case Div(left, right) if name not in names(right):
            return {n: div(c, right) for n, c in _polynomial(left, name).items()}
        case Pow(base, exponent) if exponent.denominator == 1 and exponent > 0:
            return _raised(_polynomial(base, name), exponent.numerator)
    raise NoFormError


def _raised(part: Polynomial, times: int) -> Polynomial:
    """Return a power of a polynomial; if it has two terms, by the binomial theorem."""
    if len(part) != 2:
        return reduce(_product_of, [part] * times)
    (low, a), (high, b) = part.items()
    return {
        low * (times - k) + high * k: mul(
            Num(Fraction(comb(times, k))),
            mul(power(a, Fraction(times - k)), power(b, Fraction(k))),
        )
        for k in range(times + 1)
    }


def _sum_of(parts: Iterable[Polynomial]) -> Polynomial:
    total: Polynomial = {}
    for part in parts:
        for n, coefficient in part.items():
            total[n] = add(total.get(n, ZERO), coefficient)
    return total


def _product_of(left: Polynomial, right: Polynomial) -> Polynomial:
    if _size(left) * _size(right) > MAX_PARTS:
        raise NoFormError
    return _sum_of({n + m: mul(a, b)} for n, a in left.items() for m, b in right.items())


def _size(polynomial: Polynomial) -> int:
    return sum(1 for coefficient in polynomial.values() for _ in walk(coefficient))


def _over(top: Expr, bottom: Expr) -> Expr:
    """Return ``top/bottom``, with ``a/2/b`` written ``a/(2*b)``."""
    if isinstance(top, Div) and isinstance(top.right, Num):
        return Div(top.left, mul(top.right, bottom))
    return div(top, bottom)


def divided(top: Expr, slope: Expr) -> Expr:
    """Return ``top/slope``, with ``1/(1/c)`` written ``c``."""
    match slope:
        case Div(Num(value), bottom):
            return mul(mul(Num(1 / value), bottom), top)
        case Neg(arg):
            return neg(divided(top, arg))
    return div(top, slope)


def slope_of(node: Expr, name: str) -> Expr | None:
    """Return a != 0 if node = a*x + b with a, b free of x, else None."""
    if any(isinstance(part, If | Call) for part in walk(node)):
        return None
    slope = derivative(node, name)
    return slope if slope != ZERO and name not in names(slope) else None


def _divides_well(slope: Expr | None) -> bool:
    """Return whether a quotient by this slope has no name in its denominator."""
    return isinstance(slope, Num) or (isinstance(slope, Div) and isinstance(slope.left, Num))
