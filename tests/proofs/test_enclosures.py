"""Enclosures hold the values and the slopes of random laws; exact numbers stay exact."""

import math
from fractions import Fraction

import mpmath
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from piezo_sym.expressions.tree import Add, Call, Neg, Num
from piezo_sym.proofs.signs import intervals as iv
from piezo_sym.proofs.signs.enclosures import Window, enclose, value
from piezo_sym.proofs.signs.shift import recentred, vanishes
from tests.proofs.sign_laws import law, laws, numbers, precise, steady

PLACES = st.sampled_from([0.0, 0.25, 0.3, 1.0, 2.5, 7.0, 1e3, 1e6])
WIDTHS = st.sampled_from([1e-6, 0.1, 1.0, 3.0, 100.0, math.inf])
PARTS = st.lists(st.fractions(Fraction(1, 1000), 1), min_size=2, max_size=2, unique=True)
DIGITS = 60


def inside(number, interval):
    """Return whether an interval holds a number known to `DIGITS` digits or nearly so."""
    with mpmath.workdps(DIGITS):
        slack = mpmath.mpf(10) ** (-DIGITS // 2) * (1 + abs(number))
        return interval.lo - slack <= number <= interval.hi + slack


def points(a, b, parts):
    """Return numbers t with a < t <= b."""
    width = Fraction(10**4) if math.isinf(b) else Fraction(b) - Fraction(a)
    return [Fraction(a) + part * width for part in parts]


@steady
@given(laws(), PLACES, WIDTHS, PARTS, st.sampled_from([0, 1, 2, 4]))
@example(law("sign(x)*exp(-x)"), 0.0, 1.0, [Fraction(1, 2), Fraction(1)], 2)
@example(law("x - 1 if x > 1 else x"), 1.0, 1.0, [Fraction(1, 1000), Fraction(1)], 2)
@example(law("x*exp(-x)"), 7.0, math.inf, [Fraction(1, 1000), Fraction(1)], 2)
@example(law("abs(x - 1)*deadzone(x, 1)"), 0.25, 3.0, [Fraction(1, 3), Fraction(1)], 2)
def test_values_and_slopes_lie_in_their_enclosures(tree, a, width, parts, order):
    """By the mean value theorem a difference quotient is a value, or a mean, of the slope."""
    b = a + width
    found = enclose(tree, Window(a, b, order))
    at = points(a, b, parts)
    values = [precise(tree, t, DIGITS) for t in at]
    if not found.inner:
        return
    assert None not in values or "exp" in str(tree)  # exp of too much is not taken by the oracle
    if None in values:
        return
    assert all(inside(v, found.inner[0]) for v in values)
    if len(found.inner) > 1:
        with mpmath.workdps(DIGITS):
            step = at[1] - at[0]
            quotient = (values[1] - values[0]) / (mpmath.mpf(step.numerator) / step.denominator)
        assert inside(quotient, found.inner[1])


@steady
@given(laws(), PLACES, st.sampled_from([0.1, 1.0, 3.0]))
def test_limits_at_the_ends_are_the_limits(tree, a, width):
    found = enclose(tree, Window(a, a + width, 1))
    tiny = Fraction(1, 10**40)
    for side, at in ((found.left, Fraction(a) + tiny), (found.right, Fraction(a + width) - tiny)):
        near = precise(tree, at, 90) if side and found.inner else None
        if near is not None and abs(near) < 1e6:
            slack = 1e-9  # sqrt near 0 is far from its limit yet
            assert side[0].lo - slack <= near <= side[0].hi + slack


@steady
@given(laws(), numbers())
def test_the_value_at_a_number_lies_in_its_interval(tree, x):
    found, number = value(tree, x), precise(tree, x, DIGITS)
    if found is not None and number is not None:
        assert inside(number, found)
    if found is not None and found.exact is not None:
        assert abs(number - mpmath.mpf(found.exact.numerator) / found.exact.denominator) < 1e-12


@steady
@given(laws(), numbers(), numbers(), st.sampled_from([1, -1]))
def test_a_law_seen_from_a_point_is_the_same_law(tree, centre, t, side):
    x = centre + side * t
    assert value(recentred(tree, centre, side), t) == value(tree, x) or (
        close(precise(tree, x), precise(recentred(tree, centre, side), t))
    )


def close(a, b):
    if a is None or b is None:
        return a is b
    return abs(a - b) <= 1e-20 * (1 + abs(a))


def test_a_difference_that_is_affine_is_seen_exactly():
    assert recentred(law("x - 300"), Fraction(300), 1) == law("t")
    found = enclose(recentred(law("log(x/300)"), Fraction(300), 1), Window(0.0, 1.0, 2)).inner
    assert found[0].lo == 0


@pytest.mark.parametrize(
    "text", ["1/x", "log(x)", "x**(-1/2)", "1/(x - 1)", "sqrt(-1 - x)", "1 if x < log(x) else 2"]
)
def test_what_is_not_defined_has_no_enclosure(text):
    window = Window(0.0, 2.0, 2)
    shifted = recentred(law(text), Fraction(-1), 1)
    assert enclose(shifted, window).inner == ()


@pytest.mark.parametrize("ends", [(1.0, 0.0), (math.nan, 1.0), (math.inf, math.inf)])
def test_what_is_no_interval_is_refused(ends):
    with pytest.raises(ArithmeticError):
        iv.Interval(*ends)


@steady
@given(st.floats(-1e3, 1e3), st.floats(0, 20), st.fractions(0, 1))
def test_waves_know_their_crests(a, width, part):
    box = iv.interval(a, a + width)
    at = Fraction(a) + part * (Fraction(a + width) - Fraction(a))
    assert inside(precise(law("sin(x)"), at, DIGITS), iv.of("sin", box))
    assert inside(precise(law("cos(x)"), at, DIGITS), iv.of("cos", box))


@steady
@given(*[st.floats(allow_nan=False, allow_infinity=False)] * 2)
def test_sums_and_products_of_doubles_are_rounded_outward(a, b):
    x, y = iv.interval(min(a, b), max(a, b)), iv.interval(a, a)
    for exact, found in (
        (Fraction(b) + Fraction(a), iv.plus(x, iv.Interval(a, a))),
        (Fraction(b) * Fraction(a), iv.times(x, iv.Interval(a, a))),
        (Fraction(b) * Fraction(a), iv.times(x, y)),
    ):
        assert found.lo <= exact <= found.hi


SMOOTH = [
    "exp(x)",
    "log(x)",
    "sin(x)",
    "cos(x)",
    "tanh(x)",
    "sqrt(x)",
    "x**5",
    "x**(-2)",
    "3/(1 + x)",
]


@pytest.mark.parametrize("text", SMOOTH)
@pytest.mark.parametrize("at", [0.5, 2.0])
def test_jets_are_the_taylor_series(text, at):
    jet = enclose(law(text), Window(at, at + 1, 5)).left
    with mpmath.workdps(50):
        series = mpmath.taylor(lambda x: precise(law(text), x, mpmath.mp.dps), mpmath.mpf(at), 5)
    assert len(jet) == len(series) == 6
    for part, coefficient in zip(jet, series, strict=True):
        assert part.hi - part.lo < 1e-12
        assert part.lo - 1e-15 <= coefficient <= part.hi + 1e-15


def test_branches_that_are_not_told_apart_are_all_held():
    window = Window(0.0, 2.0, 1)
    corner, jump, choice = (
        enclose(law(text), window).inner
        for text in ("abs(x - 1)", "sign(x - 1)", "3 if x < 1 else 5")
    )
    assert (corner[1].lo, corner[1].hi) == (-1, 1)
    assert [(part.lo, part.hi) for part in jump] == [(-1, 1)]
    assert [(part.lo, part.hi) for part in choice] == [(3, 5)]


@pytest.mark.parametrize("text", ["1/(1 - x)", "1/(1 if x < 0.5 else 0)", "log(1 - x)"])
def test_what_is_zero_at_the_far_end_is_not_divided_by(text):
    assert enclose(law(text), Window(0.0, 1.0, 2)).inner == ()


CANCELS = (
    "log(1 + exp(x)) - log(2); exp(x - 1) - exp(-1); cos(x)*exp(2) - exp(x + 2); abs(x - 2) - 2"
)
REMAINS = "log(1 + exp(x)) - log(3); sign(x)*exp(1) - exp(1); 1/x - 1/x; x**(-1); sin(x) + 1e-30"


@pytest.mark.parametrize("text", CANCELS.split("; "))
def test_terms_that_cancel_at_a_number_are_zero_there(text):
    assert vanishes(law(text), Fraction(0))
    assert value(law(text), Fraction(0)).exact == 0
    jet = enclose(law(text), Window(0.0, 0.5, 2)).left
    assert jet[0].exact == 0


@pytest.mark.parametrize("text", REMAINS.split("; "))
def test_what_jumps_or_does_not_cancel_is_not_zero(text):
    assert not vanishes(law(text), Fraction(0))


@steady
@given(laws(), numbers())
def test_what_vanishes_is_zero(tree, at):
    for f in (tree, Add((tree, Neg(tree))), Add((tree, Call("exp", (tree,)), Num(Fraction(-1))))):
        exact = precise(f, at, DIGITS)
        if vanishes(f, at) and exact is not None:
            assert abs(exact) < 1e-40
