"""Slopes and integrals of laws, against differences taken with 80 digits."""

from fractions import Fraction

import mpmath
import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from spec_laws import laws, precise, steady

from piezo_sym.expressions.calculus import derivative
from piezo_sym.expressions.energies import antiderivative
from piezo_sym.expressions.exact_eval import evaluate
from piezo_sym.expressions.parse import parse_law
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import ZERO, names

STEP = mpmath.mpf("1e-20")
ODD = st.integers(-3000, 3000).map(lambda n: mpmath.mpf(2 * n + 1) / 1999)
ODDER = ODD.map(lambda x: x * mpmath.sqrt(2))
ODD_WIDTH = st.integers(1, 2000).map(lambda n: n * mpmath.sqrt(3) / 1009)


def read(text):
    return parse_law(text, "law")


def value(text, values):
    try:
        return precise(text, values)
    except (ArithmeticError, ValueError):
        assume(False)


def difference(text, name, values):
    with mpmath.workdps(80):
        above = value(text, values | {name: values[name] + STEP})
        below = value(text, values | {name: values[name] - STEP})
        return (above - below) / (2 * STEP)


def close(a, b, scale=0):
    return abs(a - b) <= mpmath.mpf("1e-9") * (1 + abs(a) + abs(b) + abs(scale))


@pytest.mark.parametrize("name", ["x", "w"])
@steady
@given(tree=laws(exponents=(2, 3, -1)), x=ODD, y=ODDER, w=ODD_WIDTH)
def test_slopes_are_those_of_differences(name, tree, x, y, w):
    values = {"x": x, "y": y, "w": w}
    text = spell(tree)
    here, rise = value(text, values), difference(text, name, values)
    assert close(value(spell(derivative(tree, name)), values), rise, here)


@pytest.mark.parametrize(
    ("text", "slope"),
    [
        ("x**(1/3)", "(1/3)*x**(-2/3)"),
        ("sqrt(x)", "0.5/sqrt(x)"),
        ("log(a*x)", "1/x"),
        ("tanh(x)", "1 - tanh(x)**2"),
        ("deadzone(x, w)", "1 if abs(x) > w else 0"),
        ("saturate(x, w)", "0 if abs(x) > w else 1"),
        ("rho/(T - T_0)*deadzone(x, w)", "rho/(T - T_0) if abs(x) > w else 0"),
        ("a*x/T_0", "a/T_0"),
        ("x if x > 1 else 2*x", "1 if x > 1 else 2"),
    ],
)
def test_slopes_of_common_laws(text, slope):
    values = {"a": 2.0, "w": 0.5, "rho": 10.0, "T": 300.0, "T_0": 290.0}
    found = derivative(read(text), "x")
    for x in (0.1, 0.4, 0.6, 1.7, 9.0):
        here = values | {"x": x}
        assert evaluate(found, here) == pytest.approx(evaluate(read(slope), here), rel=1e-12)


@pytest.mark.parametrize("text", ["deadzone(x, w)", "saturate(x, w)"])
@pytest.mark.parametrize("x", [-2.0, -0.2, 0.2, 2.0])
def test_slopes_by_the_width(text, x):
    expected = {"deadzone(x, w)": -1.0, "saturate(x, w)": 1.0}[text] * (abs(x) > 0.5)
    found = evaluate(derivative(read(text), "w"), {"x": x, "w": 0.5})
    assert found == (expected if x > 0 else -expected)


@pytest.mark.parametrize(
    ("text", "sides"),
    [
        ("abs(x)", {-1, 0, 1}),
        ("min(x, 0)", {0, 1}),
        ("max(x, 0)", {0, 1}),
        ("deadzone(x, 0)", {0, 1}),
        ("x if x < 0 else 2*x", {1, 2}),
    ],
)
def test_the_slope_at_a_kink_is_between_those_beside_it(text, sides):
    assert evaluate(derivative(read(text), "x"), {"x": 0.0}) in sides


@steady
@given(laws())
def test_the_slope_by_another_name_is_zero(tree):
    assert derivative(tree, "elsewhere") == ZERO


@steady
@given(laws())
def test_slopes_have_no_new_names(tree):
    assert set(names(derivative(tree, "x"))) <= set(names(tree))


a_law = st.builds(
    lambda parts: " + ".join(parts),
    st.lists(
        st.sampled_from(
            [
                "a*x",
                "x/b",
                "x**2/a",
                "3*(a*x + b)**3",
                "b*exp(x/a)",
                "exp(a*x - b)/2",
                "a*b",
                "7",
                "(x - 1)**(-2)",
                "-a*(x - b)",
                "2*(1 - 0.5*x)**4",
                "(x/a)**(1/2)",
                "a*exp(2*x)*b",
                "x/(a/(1 + (x/b)**6))",
                "x/(1/(1/a + x**4/b))",
            ]
        ),
        min_size=1,
        max_size=4,
    ),
)


@steady
@given(a_law, ODD_WIDTH)
def test_integrals_of_known_forms_have_the_law_as_slope(text, x):
    values = {"a": mpmath.mpf("1.7"), "b": mpmath.mpf("0.6"), "x": x}
    integral = antiderivative(read(text), "x")
    assert close(difference(spell(integral), "x", values), value(text, values))


@steady
@given(laws(exponents=(2, 3, -1)), ODD, ODDER, ODD_WIDTH)
def test_an_integral_of_any_law_has_the_law_as_slope(tree, x, y, w):
    integral = antiderivative(tree, "x")
    assume(integral is not None)
    values = {"x": x, "y": y, "w": w}
    text = spell(integral)
    here = value(text, values)
    assert close(difference(text, "x", values), value(spell(tree), values), here)


@pytest.mark.parametrize(
    "text",
    [
        "1/x",
        "x*exp(x)",
        "x*exp(x) + 1/x",
        "x*exp(x) + (1 if x < 1 else x)",
        "exp(x**2)",
        "x/(x + 1)",
        "1/(x**2 + 1)",
        "x if x**2 < 1 else 2",
        "x if a*x < sin(x) else 2",
        "exp(x**2) if x < 1 else x",
    ],
)
def test_laws_without_a_simple_integral(text):
    assert antiderivative(read(text), "x") is None


@pytest.mark.some(7)
@pytest.mark.parametrize(
    "text",
    [
        *("a*sin(x/b)", "tanh(x + a)", "a*x + cos(b*x)", "atan(a*x)", "log(x + 3)"),
        *("abs(x)*x", "a*deadzone(x - 0.1, b)", "saturate(b*x, a)", "a*max(x, b)", "min(-a, x/b)"),
        *("a*x if x < b else a*x + b*(x - b)", "x if abs(x) < a else 3*(x - a)", "sign(x)*x**2"),
        *("x if a > b else x**3", "x if b*x < a else 2", "table(x, -1, -3, 0, 0, a, 2, 3, b)"),
        "x**2 if x > a else (b if x >= -a else (sin(x) if x < -b else 1))",
    ],
)
def test_integrals_of_branches_do_not_jump_and_have_the_law_as_slope(text):
    found = antiderivative(read(text), "x")
    places = np.linspace(-2.5, 2.5, 2001).tolist()
    at = {"a": 1.7, "b": 0.6}
    energies = np.array([evaluate(found, at | {"x": x}) for x in places])
    laws = np.array([evaluate(read(text), at | {"x": x}) for x in places])
    step, size = places[1] - places[0], np.abs(laws).max()
    assert np.abs(np.diff(energies)).max() <= 1.01 * step * size
    slopes, inner = (energies[2:] - energies[:-2]) / (2 * step), laws[1:-1]
    off = np.abs(slopes - inner) > 1e-4 * (1 + size)
    assert off.sum() <= 8  # beside edges at which the law jumps


@pytest.mark.parametrize(
    ("law", "energy"),
    [
        ("k*(q - q_l)", "k*(q - q_l)**2/2"),
        ("p/M", "p**2/(2*M)"),
        ("T_0*exp(S/c_0)", "T_0*c_0*exp(S/c_0)"),
    ],
)
def test_energies_of_the_paper(law, energy):
    letter = law.strip("k*()")[0] if law.startswith("k") else {"p": "p", "T": "S"}[law[0]]
    values = dict.fromkeys(["k", "q", "q_l", "p", "M", "T_0", "S", "c_0"], 1.0)
    values |= {"q": 0.3, "q_l": 0.1, "k": 5.0, "p": 0.7, "M": 0.4, "T_0": 290.0, "S": 0.2}
    found = antiderivative(read(law), letter)
    assert evaluate(found, values) == pytest.approx(evaluate(read(energy), values), rel=1e-14)


def test_integrals_are_as_short_as_by_hand():
    assert spell(antiderivative(read("Q/C"), "Q")) == "Q**2/(2*C)"


def test_a_constant_has_the_slope_zero():
    assert derivative(read("3"), "x") == ZERO


def test_constant_factors_are_exact():
    slope = derivative(read("x**2/3"), "x")
    assert evaluate(slope, {"x": 3.0}) == 2.0
    assert Fraction(2, 3) in {getattr(part, "value", None) for part in (slope.left, slope.right)}
