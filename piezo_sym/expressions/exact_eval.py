"""Exact values of laws: rationals if all operands are rational, else balls that contain the value.

Input: a tree and exact numbers.  Output: a `Fraction`, or a ball of FLINT's (``arb``), whose
arithmetic is rigorous.  A witness is shown only after its law has been evaluated here.
"""

import math
from collections.abc import Iterable, Mapping
from fractions import Fraction
from typing import Any

from flint import arb, ctx, fmpq, fmpz

from piezo_sym.expressions.calculus import choices, increasing
from piezo_sym.expressions.functions import RECORDS
from piezo_sym.expressions.grammar import MAX_POWER, parse_rule
from piezo_sym.expressions.tree import (
    COMPARED,
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

#: Precision of balls.
BITS = 160
#: Functions are not evaluated at larger arguments; rational powers of more bits become balls.
LARGEST_ARGUMENT, MOST_BITS = 10**6, 10**5


class TooCloseError(ArithmeticError):
    """A sign that the precision does not decide, or a number too large to evaluate."""


class RefusedPowerError(ValueError):
    """A power that laws may not have, as x**(n - 1) where n = 1, although mathematics has it."""


Value = Any  # a Fraction or an arb; inside this module fmpq takes the Fraction's place


def value_of(node: Expr, values: Mapping[str, Value]) -> Value:
    """Return the value of a law as a Fraction or a ball; see `evaluated`."""
    value = evaluated(node, values)
    return Fraction(int(value.p), int(value.q)) if isinstance(value, fmpq) else value


def evaluate(node: Expr, values: Mapping[str, float]) -> float:
    """Return the value of a law in floating point.

    Raises `ArithmeticError` or `ValueError` where the law has no finite real value (1/0, log(0), an
    overflow).
    """
    value = float(value_of(node, values))
    if not math.isfinite(value):
        raise OverflowError("no finite value")
    return value


def evaluated(node: Expr, values: Mapping[Any, Value], bits: int = BITS) -> Value:
    """Return the value of a law as a number of FLINT's, from those of names and sums over lanes.

    Raises `ArithmeticError` or `ValueError` where the law has no value (1/0, log(0)). Raises
    `TooCloseError` if the precision of balls does not decide that, or a comparison.
    """
    with ctx.workprec(bits):
        value = _value(node, values)
    if not (isinstance(value, fmpq) or value.is_finite()):
        raise TooCloseError
    return value


def holds(condition: Cmp, values: Mapping[Any, Value], bits: int = BITS) -> bool:
    """Return whether a comparison holds.

    Raises `TooCloseError` if it cannot be decided.  Raises `ArithmeticError` or `ValueError` if a
    side has no value.
    """
    with ctx.workprec(bits):
        return _holds(condition, values)


def all_hold(conditions: Iterable[Cmp], values: Mapping[str, Value]) -> bool | None:
    """Return whether all of some comparisons hold; None if that cannot be decided."""
    try:
        return all(holds(condition, values) for condition in conditions)
    except (ArithmeticError, ValueError, KeyError):
        return None


def differ(left: Value, right: Value) -> bool:
    """Return whether two values are certainly different."""
    with ctx.workprec(BITS):
        return bool(exact(left) != exact(right))


def exact(number: Value) -> Value:
    """Return a Python number as a rational of FLINT's; FLINT's numbers stay."""
    if not isinstance(number, int | float | Fraction):
        return number
    return fmpq(*number.as_integer_ratio())


def _holds(condition: Cmp, values: Mapping[Any, Value]) -> bool:
    difference = _value(condition.left, values) - _value(condition.right, values)
    return bool(COMPARED[condition.op](_sign(difference), 0))


def _value(node: Expr, values: Mapping[Any, Value]) -> Value:
    match node:
        case Num(value):
            return exact(value)
        case Sym(name):
            return exact(values[name])
        case Neg(arg):
            return -_value(arg, values)
        case Add(terms):
            return sum((_value(term, values) for term in terms), start=fmpq(0))
        case Mul(left, right):
            return _value(left, values) * _value(right, values)
        case Div(left, right):
            return _quotient(_value(left, values), _value(right, values))
        case Pow(base, exponent):
            return _power(_value(base, values), exponent)
        case Call() if knots(node):
            if not all(_holds(order, values) for order in increasing(node)):
                raise ValueError("the knots of a table do not increase")
            return _value(choices(node), values)
        case Call(function, args):
            return _call(function, [_value(arg, values) for arg in args])
        case If(then, condition, other):
            return _value(then if _holds(condition, values) else other, values)
        case LaneSum():
            return values[node]


def _quotient(a: Value, b: Value) -> Value:
    if _sign(b) == 0:
        raise ZeroDivisionError("division by zero")
    return a / b


def _power(base: Value, exponent: Fraction) -> Value:
    if exponent.denominator == 1:
        size = abs(exponent.numerator)
        if isinstance(base, fmpq) and size * base.height_bits() > MOST_BITS:
            base = arb(base)
        power = base**size
        return power if exponent > 0 else _quotient(fmpq(1), power)
    sign = _sign(base)
    if sign < 0 or (sign == 0 and exponent < 0):
        raise ValueError("root of a negative number")
    if not sign:
        return fmpq(0)
    if isinstance(base, fmpq):
        root = fmpq(*(fmpz(part).root(exponent.denominator) for part in (base.p, base.q)))
        if root**exponent.denominator == base:
            return root**exponent.numerator
    return arb(base) ** arb(exact(exponent))


def _raised(base: Value, exponent: Value) -> Value:
    """Return a power of a number >= 0 with a positive exponent."""
    if _sign(base) < 0:
        raise ValueError("a power of a negative number")
    if (sign := _sign(exponent)) != 1:
        if sign and base == 0:
            raise ZeroDivisionError("zero to a negative power")
        raise RefusedPowerError("a power whose exponent is not positive")
    if isinstance(exponent, fmpq) and max(exponent.p, exponent.q) <= MAX_POWER:
        return _power(base, Fraction(int(exponent.p), int(exponent.q)))
    return arb(base) ** arb(exponent) if base != 0 else fmpq(0)


def _call(function: str, args: list[Value]) -> Value:
    record, z = RECORDS[function], args[0]
    if function in {"min", "max"} and not all(isinstance(arg, fmpq) for arg in args):
        return getattr(arb(z), function)(arb(args[-1]))
    if not record.smooth:  # the formula holds for widths of either sign
        return _value(parse_rule(record.formula or record.choices), {"x": z, "w": args[-1]})
    if record.power is not None:
        return _power(z, record.power)
    if function == "pow":
        return _raised(z, args[1])
    if record.domain and _sign(z) != 1:
        raise ValueError(f"{function} of a number that is not positive")
    low, high = (isinstance(bound, Fraction) for bound in record.bounds)
    below, above = record.monotone and z > 0, record.monotone and z < 0
    bounded = (low or below) and (high or above)  # on the side of z: a large z is no problem
    if not (record.domain or abs(z) <= LARGEST_ARGUMENT or bounded):
        raise TooCloseError
    if record.known and isinstance(z, fmpq) and z == record.known[0]:
        return fmpq(record.known[1])
    return getattr(arb(z), function)()


def _sign(value: Value) -> int:
    """Return the sign of a number; comparisons of balls are True only if they are certain."""
    if value == 0:
        return 0
    if value > 0:
        return 1
    if value < 0:
        return -1
    raise TooCloseError
