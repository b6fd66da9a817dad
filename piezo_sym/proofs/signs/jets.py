"""Truncated Taylor series with interval coefficients: a function and its derivatives on a set.

Input and output: jets.  A jet is (c_0, c_1, ...) with f^(k)/k! in c_k at every point of the set.
Its length says how smooth the function is known to be: empty where f is not known to be defined,
1 where only values are known, 2 where f is Lipschitz and c_1 holds f' almost everywhere, and k + 1
where f has k continuous derivatives.  Operations keep the shorter length.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from math import factorial
from typing import TypeAlias

from piezo_sym.proofs.signs import intervals as iv
from piezo_sym.proofs.signs.intervals import Interval

Jet: TypeAlias = tuple[Interval, ...]


def constant(value: Fraction, order: int) -> Jet:
    """Return the jet of a constant."""
    return (iv.rational(value), *(iv.NOUGHT for _ in range(order)))


def minus(a: Jet) -> Jet:
    """Return -a."""
    return tuple(iv.minus(part) for part in a)


def plus(a: Jet, b: Jet) -> Jet:
    """Return a + b."""
    return tuple(iv.plus(x, y) for x, y in zip(a, b, strict=False))


def times(a: Jet, b: Jet) -> Jet:
    """Return a*b by Leibniz's rule: (ab)_k = sum_j a_j b_(k-j)."""
    return tuple(
        _total([iv.times(a[j], b[k - j]) for j in range(k + 1)]) for k in range(min(len(a), len(b)))
    )


def _total(parts: list[Interval]) -> Interval:
    total = parts[0]
    for part in parts[1:]:
        total = iv.plus(total, part)
    return total


def composed(outer: Jet, inner: Jet) -> Jet:
    """Return the jet of F(a): `outer` is that of F on a's values, and a - a_0 is a series.

    F(a) = sum_m F_m (a - a_0)^m, by Horner's rule; what is beyond the length drops out.
    """
    length = min(len(outer), len(inner))
    if length == 0:
        return ()
    shift = (iv.NOUGHT, *inner[1:length])
    result = constant(Fraction(0), length - 1)
    for m in reversed(range(length)):
        moved = times(result, shift)
        result = (iv.plus(moved[0], outer[m]), *moved[1:])
    return result


def applied(function: str, a: Jet) -> Jet:
    """Return the jet of a smooth function of the law language."""
    return composed(OUTER[function](a[0], len(a)), a) if a else ()


def power(a: Jet, exponent: Fraction) -> Jet:
    """Return the jet of a**exponent."""
    return composed(_power(a[0], len(a), exponent), a) if a else ()


def quotient(a: Jet, b: Jet) -> Jet:
    """Return the jet of a/b."""
    return times(a, power(b, Fraction(-1)))


def _power(a: Interval, length: int, exponent: Fraction) -> Jet:
    """Return binomial(e, m) a**(e - m), as far as a**(e - m) is defined."""
    found: list[Interval] = []
    binomial = Fraction(1)
    for m in range(length):
        part = iv.NOUGHT if binomial == 0 else iv.power(a, exponent - m)
        if part is None:
            break
        found.append(iv.times(iv.rational(binomial), part))
        binomial *= (exponent - m) / (m + 1)
    return tuple(found)


def _exp(a: Interval, length: int) -> Jet:
    return tuple(_part(iv.exp(a), m) for m in range(length))


def _sin(a: Interval, length: int) -> Jet:
    cycle = (iv.sin(a), iv.cos(a), iv.minus(iv.sin(a)), iv.minus(iv.cos(a)))
    return tuple(_part(cycle[m % 4], m) for m in range(length))


def _cos(a: Interval, length: int) -> Jet:
    cycle = (iv.cos(a), iv.minus(iv.sin(a)), iv.minus(iv.cos(a)), iv.sin(a))
    return tuple(_part(cycle[m % 4], m) for m in range(length))


def _part(derivative: Interval, m: int) -> Interval:
    return iv.times(iv.rational(Fraction(1, factorial(m))), derivative)


def _log(a: Interval, length: int) -> Jet:
    """Return log(a), then the series of 1/a integrated: (-1)^(m-1) a^-m / m."""
    value = iv.log(a)
    if value is None:
        return ()
    slopes = _power(a, length - 1, Fraction(-1))
    weights = (iv.rational(Fraction(1, m)) for m in range(1, length))
    return (value, *(iv.times(w, slope) for w, slope in zip(weights, slopes, strict=False)))


def _tanh(a: Interval, length: int) -> Jet:
    """Return the series of y = tanh, from y' = 1 - y^2: (m + 1) y_(m+1) = [m = 0] - (y^2)_m."""
    found = [iv.tanh(a)]
    for m in range(length - 1):
        square = [iv.times(found[j], found[m - j]) for j in range(m + 1)]
        if m == 0:
            square = [iv.times(iv.magnitude(found[0]), iv.magnitude(found[0]))]
        fall = iv.minus(_total(square))
        slope = iv.plus(iv.UNIT, fall) if m == 0 else fall
        found.append(iv.times(iv.rational(Fraction(1, m + 1)), slope))
    return tuple(found)


OUTER: dict[str, Callable[[Interval, int], Jet]] = {
    "exp": _exp,
    "log": _log,
    "sin": _sin,
    "cos": _cos,
    "tanh": _tanh,
    "sqrt": lambda a, length: _power(a, length, Fraction(1, 2)),
}
