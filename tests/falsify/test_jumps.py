"""A kink beside values of any size: a step is told from a slope there, too."""

from fractions import Fraction

from flint import arb, ctx

from piezo_sym.falsify.exact import BITS
from piezo_sym.falsify.jumps import _gap, _narrowed

#: A rate of heat over a temperature of T_0*exp(-10**13): no rational has so many bits.
HUGE = 10**13
SIDES = Fraction(-1), Fraction(2)


def huge(number):
    """Return a number times exp(HUGE)."""
    with ctx.workprec(BITS):
        return arb(number.numerator) / number.denominator * arb(HUGE).exp()


def test_a_step_among_huge_values_is_found():
    gap, (low, high) = _narrowed(lambda at: [huge(at + (at > Fraction(1, 3)))], *SIDES)
    assert low <= Fraction(1, 3) < high
    assert gap > huge(Fraction(99, 100))


def test_a_slope_among_huge_values_is_no_step():
    assert _narrowed(lambda at: [huge(at), huge(max(at, Fraction(0)))], *SIDES) is None


def test_the_largest_gap_counts():
    small = [arb(1), huge(Fraction(1))]
    assert _gap(small, [arb(9), huge(Fraction(3))]) > huge(Fraction(1))
    assert _gap(small, [arb(9), arb("nan")]) == 8
