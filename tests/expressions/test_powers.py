"""Powers whose exponent is no number: of a base that may be zero, and of one that is positive."""

from fractions import Fraction

import numpy as np
import pytest
import sympy as sp

from piezo_sym.algebra.symbols import to_sympy
from piezo_sym.codegen.numpy.style import numpy_text
from piezo_sym.expressions.calculus import derivative
from piezo_sym.expressions.exact_eval import evaluate, value_of
from piezo_sym.expressions.floats import Floats
from piezo_sym.expressions.parse import parse_law
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import Call, Sym

POWER = Call("pow", (Sym("x"), Sym("w")))
OF_ZERO = ("abs(x)**n", "(2*abs(x)/a)**(n + 1)", "max(x, 0)**(2*n)", "(x if x > 0 else -x)**n")
POSITIVE = ("x**n", "(1 + abs(x))**n", "(a/abs(x))**n", "abs(x)**(-n)", "(x**2)**n")


@pytest.mark.parametrize("text", OF_ZERO)
def test_a_power_of_what_may_be_zero_is_one_function_and_is_spelled_as_it_is_written(text):
    tree = parse_law(text, "here")
    assert tree.function == "pow"
    assert spell(tree) == text
    assert parse_law(spell(tree), "here") == tree


@pytest.mark.parametrize("text", POSITIVE)
def test_a_power_of_what_is_positive_is_exp_and_log(text):
    assert parse_law(text, "here").function == "exp"


def test_a_power_of_a_power_is_one_of_what_may_be_zero():
    assert parse_law("(abs(x)**n)**m", "here").function == "pow"


@pytest.mark.parametrize(("x", "w"), [(-1, 2), (-1, 1), (0, 0), (0, -1), (2, 0), (2, -3)])
def test_a_power_of_a_negative_number_or_with_no_positive_exponent_has_no_value(x, w):
    values = {"x": Fraction(x), "w": Fraction(w)}
    for found in (value_of, evaluate):
        with pytest.raises((ArithmeticError, ValueError)):
            found(POWER, values)
    given = {name: np.array([float(value)]) for name, value in values.items()}
    with np.errstate(all="ignore"):
        assert Floats(given.get, {}, {})[POWER].lost.all()
    assert to_sympy(POWER, {"x": sp.Integer(x), "w": sp.Integer(w)}) is sp.nan


@pytest.mark.parametrize("w", [0.2, 0.5, 1.0, 1.5, 2.0])
def test_at_zero_a_power_is_zero_and_so_are_its_slopes(w):
    words = {"x": np.array([0.0, 4.0]), "w": w, "np": np}
    with np.errstate(all="ignore"):
        value, slope, by_exponent = (
            eval(numpy_text(tree), words)
            for tree in (POWER, derivative(POWER, "x"), derivative(POWER, "w"))
        )
    assert value_of(POWER, {"x": Fraction(0), "w": Fraction(w)}) == value[0] == 0
    assert slope[0] == by_exponent[0] == 0
    assert np.allclose((value[1], slope[1]), (4**w, w * 4 ** (w - 1)), rtol=1e-14)
    assert np.isclose(by_exponent[1], 4**w * np.log(4), rtol=1e-14)
