"""Exact values: the fractions of Python's own arithmetic, or balls that contain mpmath's value."""

from fractions import Fraction

import mpmath
import pytest
from flint import ctx
from hypothesis import assume, given
from hypothesis import strategies as st

from piezo_sym.expressions.exact_eval import TooCloseError, holds, value_of
from piezo_sym.expressions.parse import parse_law
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import Cmp
from tests.proofs import law_oracle as oracle
from tests.spec.spec_laws import laws, precise, steady

NUMBERS = st.builds(Fraction, st.integers(-12, 12), st.sampled_from([1, 2, 3, 4, 7]))
VALUES = st.fixed_dictionaries({"x": NUMBERS, "y": NUMBERS, "w": NUMBERS.map(abs)})
#: The radius of a ball that touches a bound is rounded up.
ROUNDING = mpmath.mpf(10) ** -45
FAULTS = (ArithmeticError, ValueError, TypeError, OverflowError)


def found(tree, values):
    try:
        return value_of(tree, values)
    except (ArithmeticError, ValueError):
        return None


def mpf(value):
    return mpmath.mpf(value.numerator) / value.denominator


def ends(ball):
    """Return the ends of a ball as numbers of mpmath's."""
    with ctx.workprec(200), mpmath.workdps(80):
        exact = (end.man_exp() for end in (ball.lower(), ball.upper()))
        return [mpmath.ldexp(int(mantissa), int(exponent)) for mantissa, exponent in exact]


@steady
@given(laws(), VALUES)
def test_the_value_holds_what_mpmath_finds(tree, values):
    with mpmath.workdps(80):
        try:
            wanted = precise(spell(tree), {name: mpf(v) for name, v in values.items()})
        except FAULTS:
            wanted = None
        got = found(tree, values)
        assume(wanted is not None and got is not None)
        if isinstance(got, Fraction):
            assert abs(mpf(got) - wanted) <= mpmath.mpf(10) ** -60 * (1 + abs(wanted))
        else:
            slack = mpmath.mpf(10) ** -60 * (1 + abs(wanted))
            low, high = ends(got)
            assert low - slack <= wanted <= high + slack


@steady
@given(laws(), VALUES)
def test_a_rational_law_is_exact(tree, values):
    text = oracle.tree_of(spell(tree))
    try:
        wanted = oracle.rational(text, values)
    except ZeroDivisionError:
        assert found(tree, values) is None
        return
    assume(wanted is not None)
    assert value_of(tree, values) == wanted


NONE = [
    ("1/x", {"x": "0"}, ZeroDivisionError),
    ("x**(-2)", {"x": "0"}, ZeroDivisionError),
    ("1/(x - exp(0*y))", {"x": "1", "y": "2"}, ZeroDivisionError),
    ("sqrt(x)", {"x": "-1/1000000"}, ValueError),
    ("x**(-1/2)", {"x": "0"}, ValueError),
    ("log(x)", {"x": "0"}, ValueError),
    ("log(exp(x))", {"x": "-1"}, None),
    ("sqrt(x)", {"x": "0"}, None),
    ("1/(exp(x)*exp(-x) - 1)", {"x": "1"}, TooCloseError),
    ("log(1 - exp(x)*exp(-x))", {"x": "1"}, TooCloseError),
    ("sign(sin(x)**2 + cos(x)**2 - 1)", {"x": "1"}, TooCloseError),
    ("1 if sin(x)**2 + cos(x)**2 > 1 else 2", {"x": "1"}, TooCloseError),
]


@pytest.mark.parametrize(("text", "numbers", "error"), NONE)
def test_what_has_no_value_and_what_is_not_told_are_two_things(text, numbers, error):
    values = {name: Fraction(number) for name, number in numbers.items()}
    tree = parse_law(text, "test")
    if error is None:
        assert value_of(tree, values) <= 0
        return
    with pytest.raises(error) as caught:
        value_of(tree, values)
    assert caught.type is error


@steady
@given(laws(), laws(), st.sampled_from(["<", "<=", ">", ">="]), VALUES)
def test_a_comparison_is_decided_as_by_mpmath_or_not_at_all(left, right, op, values):
    with mpmath.workdps(80):
        exact = {name: mpf(v) for name, v in values.items()}
        try:
            sides = precise(spell(left), exact), precise(spell(right), exact)
        except FAULTS:
            return
        assume(abs(sides[0] - sides[1]) > mpmath.mpf(10) ** -30 or sides[0] == sides[1])
        wanted = oracle.HOLDS[op](*sides)
    try:
        assert holds(Cmp(op, left, right), values) == wanted
    except (ArithmeticError, ValueError):
        return


@pytest.mark.parametrize(
    "text",
    [
        "exp(exp(exp(exp(exp(x)))))",
        "-x*exp(exp(1e9*x))",
        "exp(1e7*x) - exp(1e6*x)",
        "1/sin(exp(exp(9*x)))",
    ],
)
def test_numbers_too_large_to_be_looked_at_are_not_told(text):
    with pytest.raises(TooCloseError):
        value_of(parse_law(text, "test"), {"x": Fraction(3)})


@pytest.mark.parametrize(
    ("text", "low", "high"),
    [
        ("exp(-1e12*x)", 0, 1e-300),
        ("1 + exp(-1e12*x)", 1, 1 + 1e-15),
        ("1 - tanh(1e12*x)", 0, 1e-15),
        ("1 + tanh(-1e12*x)", 0, 1e-15),
        ("tanh(1e12*sin(x))", 1 - 1e-15, 1),
        ("sin(1e30*x)", -1, 1),
        ("tanh(exp(1e5*x))", 1 - 1e-15, 1),
        ("log(exp(1e5*x))", 3e5 - 1e-9, 3e5 + 1e-9),
    ],
)
def test_functions_of_large_numbers_have_bounds(text, low, high):
    found = value_of(parse_law(text, "test"), {"x": Fraction(3)})
    with mpmath.workdps(80):
        least, most = ends(found)
        assert low - ROUNDING <= least <= most <= high + ROUNDING


NEGATIVE = st.fractions(-9, 9, max_denominator=4)


@steady
@given(NEGATIVE, NEGATIVE)
def test_a_width_may_have_any_sign(z, w):
    """The formulas are the contracts'; deadzone is z - saturate only for a width >= 0."""
    at = {"z": z, "w": w}
    assert value_of(parse_law("saturate(z, w)", "test"), at) == min(max(z, -w), w)
    assert value_of(parse_law("deadzone(z, w)", "test"), at) == max(z - w, 0) + min(z + w, 0)
