"""The value of a tree: in floats for many points, exactly for one, and to 60 digits.

Exact values are rationals where all is rational, else enclosures of 400 bits (arb).  What cannot be
told is an error of its own: no verdict is ever called false on a doubt.
"""

from fractions import Fraction
from math import isqrt

import mpmath
import numpy as np
from flint import arb, ctx, fmpq

BITS = 400


class NoValueError(ArithmeticError):
    """A law certainly has no value at a point."""


class DoubtError(ArithmeticError):
    """An enclosure does not tell."""


def _chosen(then, test, other):
    return np.where(np.isnan(test), np.nan, np.where(test > 0, then, other))


def _compared(compare):
    return lambda a, b: np.where(np.isnan(a) | np.isnan(b), np.nan, compare(a, b))


ARRAYS = {
    "+": np.add,
    "-": np.subtract,
    "*": np.multiply,
    "/": np.divide,
    "neg": np.negative,
    "if": _chosen,
    "<": _compared(np.less),
    "<=": _compared(np.less_equal),
    ">": _compared(np.greater),
    ">=": _compared(np.greater_equal),
    "abs": np.abs,
    "min": np.minimum,
    "max": np.maximum,
    "deadzone": lambda z, w: np.maximum(z - w, 0) + np.minimum(z + w, 0),
    "saturate": lambda z, w: np.minimum(np.maximum(z, -w), w),
    **{name: getattr(np, name) for name in ("exp", "log", "sqrt", "sin", "cos", "tanh", "sign")},
}


def floats(node, at):
    """Return the values at points, one array per name; nan where there is none."""
    head = node[0]
    if head == "num":
        return float(node[1])
    if head == "name":
        return at[node[1]]
    if head == "**":
        return np.power(floats(node[1], at), float(node[2]))
    return ARRAYS[head](*[floats(part, at) for part in node[1:]])


def rational(value):
    """Return a fraction or a float as an exact rational."""
    top, bottom = value.as_integer_ratio()
    return fmpq(int(top), int(bottom))


def sign(value):
    """Return -1, 0 or 1.

    Raises
    ------
    DoubtError
        If an enclosure holds zero.
    """
    if value > 0:
        return 1
    if value < 0:
        return -1
    if isinstance(value, fmpq) or value.is_zero():
        return 0
    raise DoubtError


def exact(node, at):
    """Return the value at one point.

    Raises
    ------
    NoValueError
        If there certainly is none.
    DoubtError
        If enclosures do not tell.
    """
    ctx.prec = BITS
    return _exact(node, at)


def _exact(node, at):
    head = node[0]
    if head == "num":
        return rational(node[1])
    if head == "name":
        return at[node[1]]
    if head == "if":
        return _exact(node[1] if _exact(node[2], at) else node[3], at)
    if head == "**":
        return _power(_exact(node[1], at), node[2])
    found = EXACT[head](*[_exact(part, at) for part in node[1:]])
    if isinstance(found, arb) and not found.is_finite():
        raise DoubtError
    return found


def _quotient(a, b):
    if sign(b) == 0:
        raise NoValueError
    return a / b


def _power(base, exponent):
    p, q = exponent.numerator, exponent.denominator
    if p < 0 and sign(base) == 0:
        raise NoValueError
    if q == 1:
        return base**p
    if sign(base) < 0:
        raise NoValueError
    if sign(base) == 0:
        return fmpq(0)
    if q == 2 and isinstance(base, fmpq):
        top, bottom = isqrt(int(base.p)), isqrt(int(base.q))
        if top * top == base.p and bottom * bottom == base.q:
            return fmpq(top, bottom) ** p
    return (arb(base).log() * p / q).exp()


def _log(z):
    if sign(z) <= 0:
        raise NoValueError
    return fmpq(0) if z == 1 else arb(z).log()


def _saturate(z, w):
    low = z if sign(z + w) > 0 else -w
    return low if sign(low - w) < 0 else w


def _above(z):
    """Return max(z, 0)."""
    return z if sign(z) > 0 else fmpq(0)


def _smooth(name, at_zero):
    def value(z):
        return fmpq(at_zero) if isinstance(z, fmpq) and z == 0 else getattr(arb(z), name)()

    return value


EXACT = {
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "/": _quotient,
    "neg": lambda a: -a,
    "<": lambda a, b: sign(a - b) < 0,
    "<=": lambda a, b: sign(a - b) <= 0,
    ">": lambda a, b: sign(a - b) > 0,
    ">=": lambda a, b: sign(a - b) >= 0,
    "abs": lambda z: z * sign(z),
    "sign": lambda z: fmpq(sign(z)),
    "min": lambda a, b: a if sign(a - b) < 0 else b,
    "max": lambda a, b: a if sign(a - b) > 0 else b,
    "saturate": _saturate,
    "deadzone": lambda z, w: _above(z - w) - _above(-z - w),
    "sqrt": lambda z: _power(z, Fraction(1, 2)),
    "log": _log,
    "exp": _smooth("exp", 1),
    "sin": _smooth("sin", 0),
    "cos": _smooth("cos", 1),
    "tanh": _smooth("tanh", 0),
}


def digits(node, at):
    """Return the value to 60 digits by mpmath: a second opinion on an enclosure."""
    with mpmath.workdps(60):
        return _digits(node, {n: _number(v) for n, v in at.items()})


def _number(value):
    if isinstance(value, arb):
        return mpmath.mpf(value.mid().str(70, radius=False))
    return mpmath.mpf(int(value.p)) / int(value.q)


def _real(value):
    """Return a value that is real, not the complex one of a root or logarithm."""
    if isinstance(value, mpmath.mpc):
        raise ValueError(value)
    return value


def _digits(node, at):
    head = node[0]
    if head == "num":
        return mpmath.mpf(node[1].numerator) / node[1].denominator
    if head == "name":
        return at[node[1]]
    if head == "if":
        return _digits(node[1] if _digits(node[2], at) else node[3], at)
    if head == "**":
        exponent = mpmath.mpf(node[2].numerator) / node[2].denominator
        return _real(_digits(node[1], at) ** exponent)
    return _real(MPMATH[head](*[_digits(part, at) for part in node[1:]]))


MPMATH = {
    **{name: EXACT[name] for name in ("+", "-", "*", "neg")},
    "/": lambda a, b: a / b,
    "<": lambda a, b: a < b,
    "<=": lambda a, b: a <= b,
    ">": lambda a, b: a > b,
    ">=": lambda a, b: a >= b,
    "abs": abs,
    "min": min,
    "max": max,
    "deadzone": lambda z, w: max(z - w, 0) + min(z + w, 0),
    "saturate": lambda z, w: min(max(z, -w), w),
    **{name: getattr(mpmath, name) for name in ("exp", "log", "sqrt", "sin", "cos", "tanh")},
    "sign": mpmath.sign,
}
