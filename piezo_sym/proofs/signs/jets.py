"""Jets: truncated Taylor series with interval coefficients, of a function on a set.

A jet is (c_0, c_1, ...) with f^(k)/k! in c_k at every point of the set.  Its length is the known
smoothness: 0 where f may be undefined, 1 where only values are known, 2 where f is Lipschitz and
c_1 contains f' almost everywhere, k + 1 where f has k continuous derivatives.  Operations keep the
shorter length.
"""

from fractions import Fraction
from functools import reduce
from typing import TypeAlias

from piezo_sym.expressions.functions import RECORDS
from piezo_sym.expressions.grammar import parse_rule
from piezo_sym.expressions.tree import Add, Call, Div, Mul, Neg, Node, Num, Pow, Sym, children
from piezo_sym.proofs.signs import intervals as iv
from piezo_sym.proofs.signs.intervals import Interval

Jet: TypeAlias = tuple[Interval, ...]


def constant(value: Fraction, order: int) -> Jet:
    """Return the jet of a constant."""
    return (iv.rational(value), *(iv.ZERO for _ in range(order)))


def minus(a: Jet) -> Jet:
    """Return -a."""
    return tuple(iv.minus(part) for part in a)


def plus(a: Jet, b: Jet) -> Jet:
    """Return a + b."""
    return tuple(iv.plus(x, y) for x, y in zip(a, b, strict=False))


def times(a: Jet, b: Jet) -> Jet:
    """Return a*b by Leibniz's rule: (ab)_k = sum_j a_j b_(k-j)."""
    return tuple(
        reduce(iv.plus, (iv.times(a[j], b[k - j]) for j in range(k + 1)))
        for k in range(min(len(a), len(b)))
    )


def composed(outer: Jet, inner: Jet) -> Jet:
    """Return the jet of F(a) from the jet `outer` of F on the values of a.

    F(a) = sum_m F_m (a - a_0)^m by Horner's rule, truncated at the shorter length.
    """
    length = min(len(outer), len(inner))
    if length == 0:
        return ()
    shift = (iv.ZERO, *inner[1:length])
    result = constant(Fraction(0), length - 1)
    for m in reversed(range(length)):
        moved = times(result, shift)
        result = (iv.plus(moved[0], outer[m]), *moved[1:])
    return result


def applied(function: str, a: Jet) -> Jet:
    """Return the jet of a smooth function of the law language."""
    return composed(of(function, a[0], len(a)), a) if a else ()


def power(a: Jet, exponent: Fraction) -> Jet:
    """Return the jet of a**exponent."""
    return composed(_power(a[0], len(a), exponent), a) if a else ()


def _power(a: Interval, length: int, exponent: Fraction) -> Jet:
    """Return binomial(e, m) a**(e - m) for m = 0, 1, ... as long as it is defined."""
    found: list[Interval] = []
    binomial = Fraction(1)
    for m in range(length):
        part = iv.ZERO if binomial == 0 else iv.power(a, exponent - m)
        if part is None:
            break
        found.append(iv.times(iv.rational(binomial), part))
        binomial *= (exponent - m) / (m + 1)
    return tuple(found)


def of(function: str, a: Interval, length: int) -> Jet:
    """Return f^(m)/m! of a smooth function from its derivative: f_(m+1) = f'_m/(m + 1)."""
    record, value = RECORDS[function], iv.of(function, a)
    if record.power is not None:
        return _power(a, length, record.power)
    if value is None or length <= 1:
        return () if value is None else (value,)
    slopes = _rule(parse_rule(record.slopes[0]), function, a, length - 1)
    parts = (iv.times(iv.rational(Fraction(1, m)), s) for m, s in enumerate(slopes, start=1))
    return (value, *parts)


def _rule(node: Node, function: str, a: Interval, length: int) -> Jet:
    """Return the jet of a record's rule, for x in `a` and y = function(x)."""
    match node:
        case Num(number):
            return constant(number, length - 1)
        case Sym("x"):
            return (a, *constant(Fraction(1), length - 2))[:length]
        case Sym():
            return of(function, a, length)
    parts = [_rule(part, function, a, length) for part in children(node)]
    match node:
        case Neg():
            return minus(parts[0])
        case Add():
            return reduce(plus, parts)
        case Mul():
            return times(*parts)
        case Div():
            return times(parts[0], power(parts[1], Fraction(-1)))
        case Pow(_, exponent):
            return power(parts[0], exponent)
        case Call(inner):
            return applied(inner, parts[0])
    raise TypeError(f"{type(node).__name__} is in no derivative")
