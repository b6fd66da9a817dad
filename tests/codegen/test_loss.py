"""How far a co-state leads its mean over a step: to round-off, and of one sign where convex."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from piezo_sym.codegen.mean import lead
from piezo_sym.expressions.parse import parse_law
from piezo_sym.expressions.tree import Sym
from tests.codegen.evaluated import value

numbers = st.fractions(-3, 3, max_denominator=64)


def found(law, old, new):
    tree = lead(parse_law(law, "law"), "q", Sym("a"), Sym("b"))
    return float(value(tree, {"a": float(old), "b": float(new), "k": 2.0}))


@given(numbers, numbers, st.integers(1, 9))
def test_of_a_power_it_is_the_lead_over_the_mean(old, new, n):
    powers = [old**i * new ** (n - i) for i in range(n + 1)]
    mean = sum(powers, Fraction(0)) / (n + 1)
    wanted = 2 * float(new**n - mean)
    moved = float(new - old)
    size = 2 * max(abs(float(old)), abs(float(new))) ** n
    assert found(f"k*q**{n}", old, new) * moved == pytest.approx(wanted, abs=1e-13 * size + 1e-300)


@given(st.fractions(-1, 1, max_denominator=64), st.fractions(-1, 1, max_denominator=64))
def test_of_an_exponential_too(old, new):
    a, b = float(old), float(new)
    moved = b - a
    mean = np.exp(a) * (np.expm1(moved) / moved if moved else 1.0)
    wanted = 2 * (np.exp(b) - mean)
    assert found("k*exp(q)", old, new) * moved == pytest.approx(
        wanted, abs=1e-13 * np.exp(max(a, b))
    )


@given(st.floats(-1e3, 1e3), st.floats(-1e-9, 1e-9))
def test_rounding_never_makes_a_loss_negative(old, moved):
    for law in ("k*q", "k*q*(1 + q**2)", "k*q + exp(q/1000)"):
        assert found(law, old, old + moved) >= 0
