"""Interval arithmetic: two rationals between which the exact value of a law lies.

Input: a law's tree and an interval for each of its names.  Output: an interval that contains every
value of the law, or, for a comparison, whether it holds: True, False, or None where the intervals
do not tell.  Rational arithmetic is exact up to LONGEST bits, beyond which bounds are rounded
outward to doubles; the C library's functions are taken to err by less than SLACK.  arb is not used:
comparisons of rationals are exact here, and loading a spec does not import python-flint.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Mapping
from fractions import Fraction
from itertools import product
from typing import TypeAlias, final

from piezo_sym.expressions.calculus import choices, increasing, rule
from piezo_sym.expressions.functions import RECORDS, LawFunction
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
)

Interval: TypeAlias = tuple[Fraction, Fraction]

LONGEST = 4096  # bits of a bound
LARGEST, TINY = Fraction(sys.float_info.max), Fraction(sys.float_info.min)
SLACK = Fraction(1, 2**40)


_BY_LOG = parse_rule("exp(w*log(x))")


@final
class UndecidedError(Exception):
    """A law has values in a part of the interval only, or values beyond all doubles."""


def holds_surely(condition: Cmp, values: Mapping[str, Interval]) -> bool | None:
    """Return whether a comparison holds, or None where that is not certain.

    Raises
    ------
    ArithmeticError, ValueError
        Where one of its sides has no real value.
    """
    try:
        left, right = interval_of(condition.left, values), interval_of(condition.right, values)
    except UndecidedError:
        return None
    if condition.op in {"<", "<="}:
        left, right = right, left
    if condition.op in {">", "<"}:
        return True if left[0] > right[1] else False if left[1] <= right[0] else None
    return True if left[0] >= right[1] else False if left[1] < right[0] else None


def interval_of(node: Expr, values: Mapping[str, Interval]) -> Interval:
    """Return an interval that contains the value of `node`.

    Raises
    ------
    ArithmeticError, ValueError
        Where the law has no real value (1/0, log(0)), whatever its names are in their intervals.
    UndecidedError
        Where that depends on what they are.
    """
    match node:
        case Num(value):
            return value, value
        case Sym(name):
            return values[name]
        case Neg(arg):
            low, high = interval_of(arg, values)
            return -high, -low
        case Add(terms):
            lows, highs = zip(*(interval_of(term, values) for term in terms), strict=True)
            return _short(sum(lows, Fraction(0)), sum(highs, Fraction(0)))
        case Mul(left, right):
            return _product(interval_of(left, values), interval_of(right, values))
        case Div(left, right):
            return _product(interval_of(left, values), _inverse(interval_of(right, values)))
        case Pow(base, exponent):
            return _power(interval_of(base, values), exponent)
        case Call(function, args):
            return _call(function, args, values)
        case If(then, condition, other):
            chosen = holds_surely(condition, values)
            if chosen is not None:
                return interval_of(then if chosen else other, values)
            return _either(then, other, values)
        case LaneSum():
            msg = "a sum over lanes has no value outside a program"
            raise TypeError(msg)


def _either(then: Expr, other: Expr, values: Mapping[str, Interval]) -> Interval:
    """Return what contains both branches of a choice that is not certain."""
    try:
        parts = interval_of(then, values), interval_of(other, values)
    except (ArithmeticError, ValueError) as cause:  # of a branch that is perhaps not taken
        raise UndecidedError from cause
    return min(parts[0][0], parts[1][0]), max(parts[0][1], parts[1][1])


def _call(function: str, args: tuple[Expr, ...], values: Mapping[str, Interval]) -> Interval:
    record = RECORDS[function]
    if record.formula:
        return interval_of(rule(record.formula, args[0], args[-1]), values)
    if record.jumps or record.knots:
        node = Call(function, args)
        for found in (holds_surely(order, values) for order in increasing(node)):
            if not found:
                raise UndecidedError if found is None else ArithmeticError
        return interval_of(choices(node), values)
    lows, highs = zip(*(interval_of(arg, values) for arg in args), strict=True)
    if record.choices:  # min, max
        return Fraction(record.value(*lows)), Fraction(record.value(*highs))
    if record.power is not None:
        return _power((lows[0], highs[0]), record.power)
    if function == "pow":
        return _raised((lows[0], highs[0]), (lows[1], highs[1]))
    return _library(record, lows[0], highs[0])


def _raised(base: Interval, exponent: Interval) -> Interval:
    """Return the interval of powers of numbers >= 0 with positive exponents."""
    if base[1] < 0 or exponent[1] <= 0:
        msg = "a power of a negative number, or whose exponent is not positive"
        raise ArithmeticError(msg)
    if base[0] < 0 or exponent[0] <= 0:
        raise UndecidedError
    ends = ({"x": (end, end), "w": exponent} for end in base)
    both = [interval_of(_BY_LOG, e) if e["x"][0] else (Fraction(0),) * 2 for e in ends]
    return both[0][0], both[1][1]


def _library(record: LawFunction, low: Fraction, high: Fraction) -> Interval:
    """Return the interval of a function of the C library."""
    if record.known and low == high == record.known[0]:
        return Fraction(record.known[1]), Fraction(record.known[1])
    if record.domain and low <= 0 < high:
        raise UndecidedError
    if not record.rises:  # sin, cos: neither changes faster than its argument
        near, off = Fraction(record.value(_beside(low, -1))), high - low + SLACK + abs(low) / 2**52
        return near - off, near + off
    if record.parity == "even":
        low, high = (
            (Fraction(0), max(-low, high)) if low < 0 < high else sorted(map(abs, (low, high)))
        )
    return _near(record.value, low, -1), _near(record.value, high, 1)


def _near(function: Callable[[float], float], bound: Fraction, side: int) -> Fraction:
    """Return a bound of a rising function, safely to a side of its value."""
    try:
        value = Fraction(function(_beside(bound, side)))
    except OverflowError as cause:
        raise UndecidedError from cause
    return value + side * (SLACK * abs(value) + TINY)


def _short(low: Fraction, high: Fraction) -> Interval:
    """Return two bounds, each rounded outward if it is too long."""
    bits = max(n.bit_length() for end in (low, high) for n in end.as_integer_ratio())
    return (low, high) if bits <= LONGEST else (_double(low, -1), _double(high, 1))


def _double(bound: Fraction, side: int) -> Fraction:
    return Fraction(_beside(bound, side))


def _beside(bound: Fraction, side: int) -> float:
    """Return the double at a bound, or else the next one to a side of it."""
    if abs(bound) >= LARGEST:
        raise UndecidedError
    near = float(bound)
    outside = near >= bound if side > 0 else near <= bound
    return near if outside else math.nextafter(near, side * math.inf)


def _product(left: Interval, right: Interval) -> Interval:
    ends = [a * b for a, b in product(left, right)]
    return _short(min(ends), max(ends))


def _inverse(divisor: Interval) -> Interval:
    """Return the interval of 1/divisor."""
    low, high = divisor
    if low == high == 0:
        raise ZeroDivisionError
    if low <= 0 <= high:
        raise UndecidedError
    return 1 / high, 1 / low


def _power(base: Interval, exponent: Fraction) -> Interval:
    low, high = base
    if exponent < 0:
        return _inverse(_power(base, -exponent))
    if exponent.denominator == 1:
        return _whole_power(low, high, exponent.numerator)
    if high < 0:
        msg = "fractional power of a negative number"
        raise ArithmeticError(msg)
    if low < 0:
        raise UndecidedError
    return _root(low, exponent, -1), _root(high, exponent, 1)


def _whole_power(low: Fraction, high: Fraction, power: int) -> Interval:
    if power % 2 == 0 and low < 0:
        low, high = (-high, -low) if high <= 0 else (Fraction(0), max(-low, high))
    return _short(low**power, high**power)


def _root(bound: Fraction, exponent: Fraction, side: int) -> Fraction:
    """Return a fractional power of a bound; exactly, if it is a double."""
    power = float(exponent)
    near = Fraction(_beside(bound, side) ** power)
    if near**exponent.denominator == bound**exponent.numerator:
        return near
    return _near(lambda z: z**power, bound, side)
