"""The deepest and longest laws that are read have names, a value, a slope and a text."""

import pytest
import sympy as sp
from spec_tools import refused_edit, refused_law

from piezo_sym.algebra.symbols import to_sympy
from piezo_sym.expressions.calculus import derivative
from piezo_sym.expressions.exact_eval import evaluate
from piezo_sym.expressions.parse import parse_law
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import names

DEEP = {
    "functions": "tanh(" * 8 + "x" + ")" * 8,
    "functions of two": "min(" * 4 + "x" + ", y)" * 4,
    "dead zones": "deadzone(" * 2 + "x" + ", y)" * 2,
    "signs": "-(" * 38 + "x" + ")" * 38,
    "quotients": "1/(" * 38 + "x" + ")" * 38,
    "powers": "(" * 38 + "x" + ")**1" * 38,
    "choices": "x if x < 1 else " * 38 + "y",
    "a sum of sums": "y + (" * 38 + "x" + ")" * 38,
    "a long sum": "x" + "+x" * 499,
    "a long sum of functions": "+".join(["tanh(x)"] * 125),
    "a long product": "*".join(["x"] * 32),
    "a product of sums": "*".join(f"(x+{n})" for n in range(9)),
}


@pytest.mark.parametrize("text", DEEP.values(), ids=DEEP)
def test_the_deepest_laws_have_names_text_and_value(text):
    tree = parse_law(text, "law")
    assert set(names(tree)) <= {"x", "y"}
    assert len(spell(tree)) >= len(text.replace("+", "")) / 3
    assert isinstance(evaluate(tree, {"x": 0.7, "y": 0.9}), float)


@pytest.mark.parametrize("text", DEEP.values(), ids=DEEP)
def test_the_deepest_laws_have_a_slope(text):
    slope = derivative(parse_law(text, "law"), "x")
    assert isinstance(evaluate(slope, {"x": 0.7, "y": 0.9}), float)
    assert spell(slope)


@pytest.mark.parametrize("text", DEEP.values(), ids=DEEP)
def test_the_deepest_laws_go_to_sympy(text):
    symbols = dict(zip("xy", sp.symbols("x y", positive=True), strict=True))
    free = to_sympy(parse_law(text, "law"), symbols).free_symbols
    assert free <= set(symbols.values())
    assert free


@pytest.mark.parametrize(
    "text",
    ["exp(" * 40 + "x" + ")" * 40, "x if x < 1 else " * 41 + "y", "1/(" * 40 + "x" + ")" * 40],
)
def test_one_step_deeper_is_refused(text):
    assert "nested too deeply" in refused_law(f"1 + ({text})")


@pytest.mark.parametrize(
    "text", ["min(" * 5 + "x" + ", y)" * 5, "deadzone(" * 3 + "x" + ", y)" * 3]
)
def test_kinks_within_kinks_are_refused_before_they_explode(text):
    assert "nests functions with kinks too deeply" in refused_law(text)


def test_a_width_that_may_be_negative_is_kept_out_of_the_domain():
    law = '"rho/(T - T_0)*deadzone(i, i_0)"'
    assert "'d/2 - 1000 >= 0'" in refused_edit((law, '"rho*deadzone(i, d/2 - 1000)/T"'))
    assert "'T/T_0 - 2 >= 0'" in refused_edit((law, '"rho*deadzone(i, T/T_0 - 2)/T"'))
