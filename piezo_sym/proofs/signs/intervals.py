"""Rigorous interval arithmetic, with the functions of laws.

Input: intervals.  Output: an interval that contains the result, or None where the function is not
defined on all of it.  Endpoints are doubles; each operation steps one double outward from the
rounded result unless that is exact (IEEE 754: its error is less than the step to its neighbour).
Functions are evaluated at endpoints by FLINT's ball arithmetic, and are monotone in between.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, final

from flint import arb, fmpq

from piezo_sym.expressions.functions import RECORDS, LawFunction

INF = math.inf
#: Exact values with more bits are dropped.
EXACT_BITS = 256


@final
@dataclass(frozen=True, slots=True)
class Interval:
    """All values of a quantity lie in [lo, hi]; values are real numbers, never infinite."""

    #: lo, hi: the ends, which may be infinite.
    lo: float
    hi: float
    nonzero: bool = False  # the quantity is never zero (though the interval may reach zero)
    exact: Fraction | None = None  # the quantity is this one number

    def __post_init__(self) -> None:
        """Raise on an empty interval or NaN, which no sound computation gives."""
        ordered = self.lo <= self.hi and self.lo < INF and self.hi > -INF
        if not ordered or (self.nonzero and self.lo == self.hi == 0):
            raise ArithmeticError(f"[{self.lo}, {self.hi}] is no interval")


def interval(lo: float, hi: float, nonzero: bool = False) -> Interval:
    """Return [lo, hi], with `nonzero` and `exact` where the ends imply them."""
    exact = Fraction(lo) if lo == hi else None
    return Interval(lo, hi, nonzero or lo > 0 or hi < 0, exact)


def rational(value: Fraction) -> Interval:
    """Return the interval of one exact number."""
    long = max(value.numerator.bit_length(), value.denominator.bit_length()) > EXACT_BITS
    return Interval(*_ends(value), value.numerator != 0, None if long else value)


def _ends(value: Fraction) -> tuple[float, float]:
    """Return the nearest doubles below and above a number; integers compare faster."""
    top, bottom = value.numerator, value.denominator
    try:
        near = top / bottom
    except OverflowError:
        return (math.nextafter(INF, 0), INF) if top > 0 else (-INF, math.nextafter(-INF, 0))
    up, down = near.as_integer_ratio()
    left, right = up * bottom, top * down
    low = near if left <= right else math.nextafter(near, -INF)
    return low, near if left >= right else math.nextafter(near, INF)


EVERYTHING = Interval(-INF, INF)
ZERO, ONE = rational(Fraction(0)), rational(Fraction(1))


def hull(a: Interval, b: Interval) -> Interval:
    """Return the smallest interval that contains both."""
    return interval(min(a.lo, b.lo), max(a.hi, b.hi), a.nonzero and b.nonzero)


def narrowed(a: Interval, lo: float, hi: float, nonzero: bool = False) -> Interval:
    """Return `a` cut to [lo, hi], for a quantity known to lie there, too."""
    if a.exact is not None:
        return a
    return interval(max(a.lo, lo), min(a.hi, hi), a.nonzero or nonzero)


def minus(a: Interval) -> Interval:
    """Return -a."""
    return Interval(-a.hi, -a.lo, a.nonzero, None if a.exact is None else -a.exact)


def plus(a: Interval, b: Interval) -> Interval:
    """Return a + b."""
    if a.exact is not None and b.exact is not None:
        return rational(a.exact + b.exact)
    one_side = (a.lo >= 0 and b.lo >= 0) or (a.hi <= 0 and b.hi <= 0)
    apart = one_side and (a.nonzero or b.nonzero)
    return interval(_sum(a.lo, b.lo, -INF), _sum(a.hi, b.hi, INF), apart)


def _sum(x: float, y: float, outward: float) -> float:
    """Return x + y, rounded outward; Knuth's TwoSum gives the rounding error exactly."""
    total = x + y
    if math.isinf(x) or math.isinf(y):
        return total
    rounded = total - x
    error = (x - (total - rounded)) + (y - rounded)
    return total if error == 0 else math.nextafter(total, outward)


def times(a: Interval, b: Interval) -> Interval:
    """Return a*b."""
    if a.lo == a.hi == 0 or b.lo == b.hi == 0:
        return ZERO
    if a.exact is not None and b.exact is not None:
        return rational(a.exact * b.exact)
    corners = [(x, y) for x in (a.lo, a.hi) for y in (b.lo, b.hi)]
    low = min(_product(x, y, -INF) for x, y in corners)
    high = max(_product(x, y, INF) for x, y in corners)
    return interval(low, high, a.nonzero and b.nonzero)


def _product(x: float, y: float, outward: float) -> float:
    """Return x*y, rounded outward but not past zero; 0 times an end at infinity is 0.

    An infinite end is never a value: the products of 0 with the values below it are all 0.
    """
    if x == 0 or y == 0:
        return 0.0
    product = x * y
    if math.isinf(x) or math.isinf(y) or abs(x) == 1 or abs(y) == 1:
        return product
    stepped = math.nextafter(product, outward)
    positive = (x > 0) == (y > 0)
    return max(stepped, 0.0) if positive else min(stepped, 0.0)


def inverse(a: Interval) -> Interval | None:
    """Return 1/a, or None if a may be zero or have both signs."""
    if a.exact:
        return rational(1 / a.exact)
    if not a.nonzero or a.lo < 0 < a.hi:
        return None
    if a.hi <= 0:
        below = inverse(minus(a))
        return None if below is None else minus(below)
    low = 0.0 if a.hi == INF else max(0.0, math.nextafter(1 / a.hi, -INF))
    high = INF if a.lo == 0 or math.isinf(1 / a.lo) else math.nextafter(1 / a.lo, INF)
    return interval(low, high, nonzero=True)


def magnitude(a: Interval) -> Interval:
    """Return abs(a)."""
    if a.lo >= 0:
        return a
    return minus(a) if a.hi <= 0 else interval(0.0, max(-a.lo, a.hi), a.nonzero)


def power(a: Interval, exponent: Fraction) -> Interval | None:
    """Return a**exponent; None for a fractional power if a may be negative."""
    if exponent == 0:
        return ONE
    if exponent < 0:
        below = power(a, -exponent)
        return None if below is None else inverse(below)
    integer = exponent.denominator == 1
    if integer and a.exact is not None and exponent <= EXACT_BITS:
        return rational(a.exact**exponent.numerator)
    if not integer and a.lo < 0:
        return None
    if a.exact == 0:
        return ZERO
    base = magnitude(a) if integer and exponent.numerator % 2 == 0 else a  # now x**e is increasing
    return _increasing(base, lambda x: x.root(exponent.denominator) ** exponent.numerator)


def of(function: str, a: Interval) -> Interval | None:
    """Return the values of a smooth function; None if it is not defined on all of a."""
    record = RECORDS[function]
    if record.power is not None:
        return power(a, record.power)
    if record.domain and (a.lo < 0 or not a.nonzero):
        return None
    if record.known and a.exact == record.known[0]:
        return rational(Fraction(record.known[1]))
    if not record.rises:
        return _wave(a, record)
    if record.parity == "even":
        a = magnitude(a)
    zero_at_zero = record.parity == "odd" and a.nonzero
    return interval(*_rising(a, record), record.sign == ">" or zero_at_zero)


def _rising(a: Interval, record: LawFunction) -> tuple[float, float]:
    """Return bounds on an increasing function, from its values at the ends."""
    (low, high), most = map(float, record.bounds), record.largest
    if a.lo != (0.0 if record.domain else -INF) and a.lo >= -most:
        low = max(low, _down(_at(min(a.lo, most), record)))
    if a.hi != INF and a.hi <= most:
        high = min(high, _up(_at(max(a.hi, -most), record)))
    return low, high


def _wave(a: Interval, record: LawFunction) -> Interval:
    """Return sine or cosine, which is 1 at `crest` + k turns and -1 half a turn later.

    Without a crest between the ends, it is at most the larger value at the ends; likewise below.
    """
    if math.isinf(a.lo) or math.isinf(a.hi):
        return interval(-1.0, 1.0)
    crest = Fraction(0) if record.parity == "even" else Fraction(1, 4)
    ends = _at(a.lo, record), _at(a.hi, record)
    low = -1.0 if _meets(a, crest + Fraction(1, 2)) else max(-1.0, min(map(_down, ends)))
    return interval(low, 1.0 if _meets(a, crest) else min(1.0, max(map(_up, ends))))


def _at(x: float, record: LawFunction) -> Any:
    return getattr(arb(x), record.name)()


def _meets(a: Interval, offset: Fraction) -> bool:
    """Return whether some 2*pi*(offset + k), k an integer, may lie in a; False is certain."""
    turn, start = 2 * arb.pi(), arb(fmpq(offset.numerator, offset.denominator))
    first, last = _down(arb(a.lo) / turn - start), _up(arb(a.hi) / turn - start)
    return math.ceil(first) <= math.floor(last)


def _increasing(a: Interval, function: Callable[[Any], Any]) -> Interval:
    """Return an increasing power from its values at the ends; zero and infinity are exact."""
    low = a.lo if a.lo in (0, -INF) else _down(function(arb(a.lo)))
    high = a.hi if a.hi in (0, INF) else _up(function(arb(a.hi)))
    return interval(max(low, 0.0) if a.lo >= 0 else low, high, a.nonzero)


def _down(ball: Any) -> float:
    """Return a double that is not above the ball; `<=` of balls is True only if certain."""
    low = ball.lower()
    near = float(low)
    if math.isnan(near):
        raise ArithmeticError("a function was taken where it is not defined")
    return near if arb(near) <= low else math.nextafter(near, -INF)


def _up(ball: Any) -> float:
    """Return a double that is not below the ball."""
    return -_down(-ball)
