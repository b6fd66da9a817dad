"""Exact values of laws: rationals where all is rational, else intervals that hold the value.

Input: a tree and exact numbers.  Output: a `Fraction`, or an interval of mpmath's whose ends are
rounded outward.  A witness is shown only after its law has been evaluated here.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, final

from mpmath import iv

from piezo_sym.expressions.calculus import choices, increasing
from piezo_sym.expressions.functions import RECORDS, Function
from piezo_sym.expressions.parse import parse_rule
from piezo_sym.expressions.tree import (
    Add,
    Call,
    Cmp,
    Div,
    Expr,
    If,
    LaneSum,
    Mul,
    Neg,
    Num,
    Pow,
    Sym,
    knots,
)
from piezo_sym.proofs.balls import smooth

DIGITS = 40
#: Beyond this the argument of a function is not looked at, nor a rational power of more bits.
LARGEST_ARGUMENT, MOST_BITS = 10**6, 10**5

#: Whether a comparison holds, by the sign of left - right; proofs also use = and !=.
OUTCOMES: Mapping[str, Callable[[int], bool]] = {
    "<": lambda sign: sign < 0,
    "<=": lambda sign: sign <= 0,
    ">": lambda sign: sign > 0,
    ">=": lambda sign: sign >= 0,
    "=": lambda sign: sign == 0,
    "!=": lambda sign: sign != 0,
}


@final
@dataclass(eq=False)
class TooCloseError(ArithmeticError):
    """A sign that 40 digits do not tell, or a number too large to be looked at."""


Value = Any  # Fraction, or an interval of mpmath


def value_of(node: Expr, values: Mapping[str, Fraction]) -> Value:
    """Return the value of a law.

    Raises
    ------
    ArithmeticError, ValueError
        Where the law has no value (1/0, log(0)).
    TooCloseError
        Where that, or a comparison, cannot be decided.
    """
    before = iv.dps
    iv.dps = DIGITS
    try:
        return _value(node, values)
    finally:
        iv.dps = before


def sign_of(value: Value) -> int | None:
    """Return -1, 0 or 1, or None for an interval around zero."""
    if isinstance(value, Fraction):
        return (value > 0) - (value < 0)
    return -1 if value.b < 0 else 1 if value.a > 0 else None


def holds(condition: Cmp, values: Mapping[str, Fraction]) -> bool:
    """Return whether a comparison holds.

    Raises
    ------
    TooCloseError
        If it cannot be decided.
    ArithmeticError, ValueError
        If a side has no value.
    """
    difference = minus(value_of(condition.left, values), value_of(condition.right, values))
    return OUTCOMES[condition.op](_certain(difference))


def minus(left: Value, right: Value) -> Value:
    """Return the difference of two values."""
    a, b = _alike([left, right])
    return a - b


def _interval(value: Value) -> Value:
    if not isinstance(value, Fraction):
        return value
    return iv.mpf(value.numerator) / iv.mpf(value.denominator)


def _value(node: Expr, values: Mapping[str, Value]) -> Value:
    match node:
        case Num(value):
            return value
        case Sym(name):
            return values[name]
        case Neg(arg):
            return -_value(arg, values)
        case Add(terms):
            first, *rest = _alike([_value(term, values) for term in terms])
            return sum(rest, start=first)
        case Mul(left, right):
            a, b = _alike([_value(left, values), _value(right, values)])
            return a * b
        case Div(left, right):
            a, b = _alike([_value(left, values), _value(right, values)])
            return _quotient(a, b)
        case Pow(base, exponent):
            return _power(_value(base, values), exponent)
        case Call() if knots(node):
            if not all(holds(order, values) for order in increasing(node)):
                msg = "the knots of a table do not increase"
                raise ValueError(msg)
            return _value(choices(node), values)
        case Call(function, args):
            return _call(function, [_value(arg, values) for arg in args])
        case If(then, condition, other):
            return _value(then if holds(condition, values) else other, values)
        case LaneSum():
            msg = "a sum over lanes has no value outside a program"
            raise TypeError(msg)


def _alike(parts: list[Value]) -> list[Value]:
    """Return values of one type: rationals if all are."""
    if all(isinstance(part, Fraction) for part in parts):
        return parts
    return [_interval(part) for part in parts]


def _quotient(a: Value, b: Value) -> Value:
    if _certain(b) == 0:
        msg = "division by zero"
        raise ZeroDivisionError(msg)
    return a / b


def _power(base: Value, exponent: Fraction) -> Value:
    if exponent.denominator == 1:
        size = abs(exponent.numerator)
        if isinstance(base, Fraction) and size * _bits(base) > MOST_BITS:
            base = _interval(base)
        whole = base**size
        one = Fraction(1) if isinstance(base, Fraction) else iv.mpf(1)
        return whole if exponent > 0 else _quotient(one, whole)
    sign = _certain(base)
    if sign < 0 or (sign == 0 and exponent < 0):
        msg = "root of a negative number"
        raise ValueError(msg)
    if sign == 0:
        return Fraction(0)
    return iv.exp(iv.log(_interval(base)) * _interval(exponent))


def _bits(value: Fraction) -> int:
    return max(value.numerator.bit_length(), value.denominator.bit_length())


def _large(z: Value) -> bool:
    """Return whether a number is, or may be, too large for a function."""
    if isinstance(z, Fraction):
        return abs(z) > LARGEST_ARGUMENT
    return not (z.a >= -LARGEST_ARGUMENT and z.b <= LARGEST_ARGUMENT)


def _call(function: str, args: list[Value]) -> Value:
    record, z = RECORDS[function], args[0]
    if not record.smooth:  # as the contracts have it, whatever the sign of a width
        return _value(parse_rule(record.formula or record.choices), {"x": z, "w": args[-1]})
    if record.power is not None:
        return _power(z, record.power)
    if record.domain and _certain(z) != 1:
        raise ValueError(f"{function} of a number that is not positive")
    if not record.domain and _large(z):
        return _far(record, _interval(z))
    if record.known and isinstance(z, Fraction) and z == record.known[0]:
        return Fraction(record.known[1])
    return smooth(function, _interval(z), iv)


def _far(record: Function, z: Value) -> Value:
    """Return bounds on a function of a large number; some have none."""
    low, high = (_interval(b) if isinstance(b, Fraction) else None for b in record.bounds)
    edge = iv.mpf(LARGEST_ARGUMENT)
    if record.monotone and z.a > LARGEST_ARGUMENT:
        low = smooth(record.name, edge, iv)
    elif record.monotone and z.b < -LARGEST_ARGUMENT:
        high = smooth(record.name, -edge, iv)
    if low is None or high is None:
        raise TooCloseError
    return iv.mpf([low.a, high.b])


def _certain(value: Value) -> int:
    sign = sign_of(value)
    if sign is None:
        raise TooCloseError
    return sign
