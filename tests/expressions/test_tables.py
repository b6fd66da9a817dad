"""Tables in laws: their values against NumPy's interpolation, their slopes, units and refusals."""

from fractions import Fraction

import numpy as np
import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from piezo_sym.algebra.symbols import to_sympy
from piezo_sym.errors import SpecError
from piezo_sym.expressions.calculus import choices, derivative, increasing
from piezo_sym.expressions.dimensions import faults, matches
from piezo_sym.expressions.exact_eval import evaluate, value_of
from piezo_sym.expressions.parse import parse_law
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import Cmp, If, Sym, walk

V = sp.Symbol("v", real=True)
QUARTERS = st.integers(-200, 200).map(lambda n: n / 4)


@st.composite
def knots(draw, most=64):
    x = sorted(draw(st.lists(QUARTERS, min_size=2, max_size=most, unique=True)))
    return x, draw(st.lists(QUARTERS, min_size=len(x), max_size=len(x)))


def interpolated(z, x, y):
    """Return NumPy's interpolation, continued by the slopes at both ends."""
    if z < x[0]:
        return y[0] + (y[1] - y[0]) / (x[1] - x[0]) * (z - x[0])
    if z > x[-1]:
        return y[-1] + (y[-1] - y[-2]) / (x[-1] - x[-2]) * (z - x[-1])
    return np.interp(z, x, y)


def law(x, y):
    return parse_law(f"table(v, {', '.join(f'{a}, {b}' for a, b in zip(x, y, strict=True))})", "")


@given(knots(), QUARTERS | st.floats(-1e3, 1e3))
def test_a_table_interpolates_and_goes_on_straight(drawn, z):
    tree, wanted = law(*drawn), interpolated(z, *drawn)
    exact = value_of(tree, {"v": Fraction(z)})
    found = [evaluate(t, {"v": z}) for t in (tree, choices(tree))]
    assert np.allclose([float(exact), *found], wanted, rtol=1e-10, atol=1e-9)
    assert value_of(choices(tree), {"v": Fraction(z)}) == exact


@given(knots(most=9), QUARTERS)
def test_its_slope_is_that_of_the_piece(drawn, z):
    x, y = drawn
    k = min(max(np.searchsorted(x, z + 1e-3) - 1, 0), len(x) - 2)
    wanted = (y[k + 1] - y[k]) / (x[k + 1] - x[k])
    assert np.isclose(evaluate(derivative(law(*drawn), "v"), {"v": z + 1e-3}), wanted)


@given(knots(most=9), QUARTERS)
def test_sympy_has_the_same_function(drawn, z):
    expr = to_sympy(law(*drawn), {"v": V}).subs(V, sp.Rational(z))
    assert np.isclose(float(expr), interpolated(z, *drawn), atol=1e-9)


@given(knots(most=12))
def test_its_text_gives_it_back(drawn):
    assert parse_law(spell(law(*drawn)), "") == law(*drawn)


def test_no_piece_of_64_knots_is_deep():
    def depth(node):
        return 1 + max(map(depth, (node.then, node.other))) if isinstance(node, If) else 0

    pieces = choices(law(range(64), range(64)))
    assert depth(pieces) == 6
    assert sum(isinstance(node, Cmp) for node in walk(pieces)) == 62


def test_the_order_of_plain_numbers_is_known():
    assert list(increasing(law([-2.5, -1, 0, 3], [0, 0, 0, 0]))) == []
    assert list(increasing(parse_law("1 + v*table(v, 0, 1, a, 2)", ""))) == [
        Cmp("<", parse_law("0", ""), Sym("a"))
    ]


@pytest.mark.parametrize(
    ("text", "bad"),
    [
        ("table(v, a, F, 2*a, F)", 0),
        ("table(v, 0, 0, a, F)", 0),
        ("table(v, a, F, F, F)", 1),
        ("table(v, a, F, 2*a, a)", 1),
        ("table(F, a, F, 2*a, 0)", 1),
        ("table(v, 1, F, 2, F)", 1),
    ],
)
def test_units_of_x_and_of_y_are_equal(text, bad):
    zero = Fraction(0)
    words = {"v": (zero, Fraction(1), *[zero] * 5), "F": (Fraction(1), *[zero] * 6)}
    words["a"] = words["v"]
    assert len(faults(matches(parse_law(text, "")), words)) == bad


@pytest.mark.parametrize("count", [0, 1, 2, 3, 4, 6, 130, 131])
def test_other_numbers_of_arguments_are_refused(count):
    with pytest.raises(SpecError, match=f"gives table {count} arguments; expected .*2 to 64 knots"):
        parse_law(f"table({', '.join(['1'] * count)})", "here")


@pytest.mark.parametrize("text", ["table(1, 2, 0, 1, 0)", "table(1, 2, 0, 2, 1)"])
def test_constant_knots_out_of_order_have_no_value(text):
    with pytest.raises(SpecError, match="without a finite real value"):
        parse_law(text, "here")


def test_tables_in_functions_with_kinks_count_their_pieces():
    inner = ", ".join(f"{k}, {k}" for k in range(30))
    parse_law(f"table(v, {inner})*table(v, {inner})", "")
    for text in (f"deadzone(table(v, {inner}), 1)", f"table(table(v, {inner}), {inner})"):
        with pytest.raises(SpecError, match="nests functions with kinks too deeply"):
            parse_law(text, "here")
