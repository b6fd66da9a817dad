"""Functions with kinks inside each other: to SymPy with the right values, and to an end."""

import sys
from pathlib import Path

import pytest
import sympy as sp
from hypothesis import assume, given

from piezo_sym import derive
from piezo_sym.algebra.symbols import to_sympy
from piezo_sym.errors import SpecError
from piezo_sym.expressions.exact_eval import evaluate
from piezo_sym.expressions.parse import parse_law
from piezo_sym.expressions.tree import names
from piezo_sym.spec.load import parse
from piezo_sym.spec.source import MODELS

sys.path.append(str(Path(__file__).parents[1] / "spec"))
from spec_laws import laws, steady

#: Each once ran into SymPy's recursion limit, or its solver of inequalities.
FOUND = [
    "abs(abs(x) - 1)",
    "min(w - x, x - y)",
    "min(y - x/(x - 1), x**2 + x*y - y)",
    "abs(abs(abs(x - 1) - 1) - 1)",
    "min(y*w, min(y*w, x)*x)",
    "min(x*min(w, x*min(y, x)), w)",
    "(x if abs(x) < abs(y) else w) if (x if x < 3 else w) < 1 else (y if x < 5 else w)",
    "max(-y + w, x - w) + min(y - w, w - x)",
    "deadzone(deadzone(x, y), w)",
    "saturate(saturate(x + y, w), y)",
]
POINTS = [(x, y, w) for x in (-2.5, 0.25, 4.5) for y in (0.75, 2.0) for w in (0.5, 3.5)]


def table():
    return {name: sp.Symbol(name, real=True) for name in "xyw"}


def value_of(expr, values):
    """Return a value, branch by branch: one that is not taken need not have any."""
    if isinstance(expr, sp.Piecewise):
        taken = next(e for e, c in expr.args if value_of(c, values) == sp.true)
        return value_of(taken, values)
    return (
        expr.func(*(value_of(a, values) for a in expr.args))
        if expr.args
        else values.get(expr, expr)
    )


def same(tree, point):
    symbols = table()
    values = dict(zip("xyw", point, strict=True))
    expr = to_sympy(tree, symbols)
    there = value_of(expr, {symbols[n]: sp.Rational(v) for n, v in values.items()})
    return sp.N(there, 30) == pytest.approx(evaluate(tree, values), rel=1e-9, abs=1e-9)


def conditions(expr):
    return [condition for choice in expr.atoms(sp.Piecewise) for _, condition in choice.args]


@pytest.mark.parametrize("text", FOUND)
def test_kinks_in_kinks_have_their_values(text):
    tree = parse_law(text, "law")
    assert all(same(tree, point) for point in POINTS)


@pytest.mark.parametrize("text", FOUND)
def test_no_condition_chooses(text):
    found = conditions(to_sympy(parse_law(text, "law"), table()))
    assert found
    assert not any(condition.has(sp.Piecewise) for condition in found)


@steady
@given(laws(exponents=(2, 3)).filter(lambda tree: set(names(tree)) == set("xyw")))
def test_random_laws_have_their_values(tree):
    for point in POINTS[::8]:
        values = dict(zip("xyw", point, strict=True))
        try:
            value = evaluate(tree, values)
        except (ArithmeticError, ValueError):
            assume(False)
        assume(1e-6 < abs(value) < 1e6)
        assert same(tree, point)


def test_a_comparison_of_what_is_not_real_is_refused():
    text = (MODELS / "piezo_stack.toml").read_text(encoding="utf-8")
    model = parse(text.replace('"d*v"', '"abs(log(sign(v)))"'))
    with pytest.raises(SpecError, match="compares what has no real value") as caught:
        derive(model)
    assert "'abs(log(sign(v)))'" in str(caught.value)
    assert caught.value.remedy
