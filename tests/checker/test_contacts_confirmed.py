"""Contacts whose force is a power with a parameter as exponent, k*(max(q - g, 0)/x_o)**n.

The oracle is numeric: quadrature of the force, written here in NumPy.
"""

from functools import cache

import numpy as np
import pytest
from scipy.integrate import quad
from stated import refused, stated

from piezo_sym import derive, verify
from piezo_sym.expressions.exact_eval import evaluate
from piezo_sym.proofs import Verdict
from piezo_sym.spec.load import parse

SPEC = """
[model]
name = "contact"
[parameters]
m = {{ value = 1.0, unit = "kg" }}
k = {{ value = 1e4, unit = "N" }}
g = {{ value = 0.1, unit = "m" }}
x_o = {{ value = {x_o}, unit = "m" }}
n = {{ value = {n}, unit = "1" }}
[domain]
assume = ["k >= 0", "{domain}"]
[elements]
mass = {{ kind = "mass", at = "tip", mass = "m", state = "p" }}
ball = {{ kind = "spring", between = ["tip", "wall"], force = "{law}", state = "q" }}
"""
HERTZ = "k*(max(q - g, 0)/x_o)**n"
FORCES = {
    HERTZ: lambda q, n: max(q - 0.1, 0) ** n,
    "k*sign(q)*(abs(q)/x_o)**n": lambda q, n: np.sign(q) * abs(q) ** n,
    "k*(max(deadzone(q, g), 0)/x_o)**n": lambda q, n: max(q - 0.1, 0) ** n,
}
KEPT = 'n {}", "x_o > 0'


def spec(law, domain, n=1.5, x_o=1.0):
    return SPEC.format(law=law, domain=domain, n=n, x_o=x_o)


@cache
def rows(text):
    return {(row.id, row.element): row for row in verify(derive(parse(text))).rows}


@pytest.mark.some(1)
@pytest.mark.parametrize("law", FORCES)
@pytest.mark.parametrize("domain", [">= 1", "> 0", ">= 0.5"])
def test_a_force_that_is_a_power_is_proved_and_confirmed(law, domain):
    text = spec(law, KEPT.format(domain))
    assert {row.verdict for row in rows(text).values()} == {Verdict.PROVED}
    assert refused(text, stated(text)) == {}


@pytest.mark.parametrize("law", FORCES)
@pytest.mark.parametrize("n", [0.3, 1.0, 1.5, 2.0])
def test_its_energy_is_the_integral_of_the_force(law, n):
    iphs = derive(parse(spec(law, KEPT.format("> 0"))))
    energy = next(
        e.law
        for e in iphs.energies
        if "q" in {s.name for s in iphs.symbols.law(e.law, {}).free_symbols}
    )
    values = {"k": 1e4, "g": 0.1, "x_o": 1.0, "n": n}
    ends = [float(evaluate(energy, {**values, "q": q})) for q in (-0.7, 0.1, 0.9)]
    for (a, b), rise in zip(((-0.7, 0.1), (0.1, 0.9)), np.diff(ends), strict=True):
        assert rise == pytest.approx(1e4 * quad(FORCES[law], a, b, args=(n,), points=[0.0])[0])


@pytest.mark.some(2)
@pytest.mark.parametrize(
    ("law", "domain", "values"),
    [
        (HERTZ, KEPT.format(">= -1"), {}),
        (HERTZ, KEPT.format("<= 0"), {"n": -1.0}),  # infinite where the gap closes
        (HERTZ, "n >= 1", {}),  # x_o may be 0
        (HERTZ, 'n >= 1", "x_o < 0', {"x_o": -1.0}),  # of negative numbers
        ("k*(max(q, -g)/x_o)**n", KEPT.format(">= 1"), {}),
        ("k*(saturate(q, g)/x_o)**n", KEPT.format("> 0"), {}),
        ("k*(max(q - g, 0)/x_o)**(n - 1)", KEPT.format(">= 1"), {}),
        ("k*((q if q > g else 0*q)/x_o)**n", KEPT.format("> 0"), {}),  # it jumps, if q > g > 0
    ],
)
def test_a_power_that_has_no_value_somewhere_is_not_proved(law, domain, values):
    found = rows(spec(law, domain, **values))
    assert found["welldef", "ball"].verdict is Verdict.REFUTED
    assert found["energy", ""].verdict is not Verdict.PROVED


def test_zero_to_the_power_of_zero_is_open():
    """It has a value by convention, and no law is continuous in it."""
    found = rows(spec(HERTZ, KEPT.format(">= 0")))["welldef", "ball"]
    assert found.verdict is Verdict.OPEN
    assert "the condition 'n > 0' in [domain] mends it" in found.reason


def test_a_jump_of_a_power_is_not_proved():
    law, domain = "k*((q if q > g else 0*q)/x_o)**n", KEPT.format('> 0", "g > 0')
    found = rows(spec(law, domain))
    assert found["welldef", "ball"].verdict is Verdict.PROVED
    assert found["continuous", "ball"].verdict is Verdict.REFUTED
