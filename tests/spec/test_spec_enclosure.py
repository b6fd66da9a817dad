"""Intervals that a law's values are said to lie in, against values of 80 digits."""

from contextlib import suppress
from fractions import Fraction

import mpmath
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from spec_laws import laws, precise, steady

from piezo_sym.expressions.enclosure import UndecidedError, holds_surely, interval_of
from piezo_sym.expressions.parse import parse_condition, parse_law
from piezo_sym.expressions.text import spell

WIDTH = {"x": Fraction(1, 7), "y": Fraction(0), "w": Fraction(1, 3)}
ENDS = st.tuples(st.floats(-3, 3), st.floats(-3, 3), st.floats(0, 3))
PLACES = st.tuples(*[st.fractions(0, 1, max_denominator=9)] * 3)
#: The oracle's own error; far less than the intervals' slack.
ERROR = Fraction(1, 10**60)


def point(value):
    return Fraction(value), Fraction(value)


def exact(number):
    """Return an mpmath number as a rational."""
    sign, mantissa, exponent, _ = number._mpf_
    return (-1) ** sign * Fraction(mantissa) * Fraction(2) ** exponent


def value_of(text, values):
    """Return the value of a law to 80 digits; an error where it has none."""
    with mpmath.workdps(80):
        given = {name: mpmath.mpf(v.numerator) / v.denominator for name, v in values.items()}
        return precise(text, given)


@steady
@given(laws(), ENDS, PLACES)
def test_values_lie_in_their_intervals(tree, ends, places):
    low = {name: Fraction(end) for name, end in zip("xyw", ends, strict=True)}
    intervals = {name: (end, end + WIDTH[name]) for name, end in low.items()}
    inside = {n: end + WIDTH[n] * at for (n, end), at in zip(low.items(), places, strict=True)}
    try:
        value = value_of(spell(tree), inside)
    except (ArithmeticError, ValueError, TypeError):  # no value, or a complex one
        return
    assume(mpmath.isfinite(value))
    with suppress(UndecidedError):
        least, most = interval_of(tree, intervals)
        slack = ERROR * (1 + abs(exact(value)))
        assert least - slack <= exact(value) <= most + slack


@pytest.mark.parametrize(
    ("text", "answer"),
    [
        ("1 + x/1e20 > 1", True),
        ("1 + x/1e20 <= 1", False),
        ("sqrt(x*x) <= x", True),
        ("(x*x*x)**(1/3) < x", False),
        ("exp(x - 2) >= 1", True),
        ("log(x/2) < 0", False),
        ("cos(x - 2) < 1", False),
        ("exp(log(x)) >= x", None),
        ("exp(log(x)) > 1.999999999", True),
        ("exp(1e9*x) > 1", None),
        ("exp(0 - 1e9*x) > 0", None),
        ("log(exp(x) - exp(x)) < 0", None),
        ("1/(exp(x) - exp(x)) < 0", None),
        ("(1 if exp(log(x)) < x else 2) > 0", True),
        ("(1 if exp(log(x)) < x else 2) > 1", None),
        ("(1/(x - 2) if exp(log(x)) < x else 2) > 1", None),
        ("abs(0 - x) > 2", False),
        ("sign(0 - x) < 0", True),
        ("deadzone(x, 0.5) > 1", True),
        ("saturate(x, 0.5) >= 0.5", True),
    ],
)
def test_conditions_at_two(text, answer):
    assert holds_surely(parse_condition(text, "law"), {"x": point(2)}) is answer


@pytest.mark.parametrize("text", ["1/(x - 2)", "log(x - 2)", "sqrt(1 - x)", "(1 - x)**(-1/2)"])
def test_laws_without_a_value(text):
    with pytest.raises((ArithmeticError, ValueError)):
        interval_of(parse_law(text, "law"), {"x": point(2)})


@pytest.mark.parametrize(
    ("value", "answer"), [(Fraction(9, 4), False), (2 + Fraction(1, 2**3000), None)]
)
def test_long_numbers_are_rounded_outward(value, answer):
    assert holds_surely(parse_condition("x*x < x**2", "law"), {"x": point(value)}) is answer
