"""Magnitudes, signs, maxima and choices are read as in laws, not as they are derived."""

import math

import pytest
import sympy as sp

from piezo_sym import derive
from piezo_sym.algebra.notation import latex, text
from piezo_sym.spec.load import parse

SPEC = """
[model]
name = "jaw"
[parameters]
m   = {{ value = 0.5, unit = "kg" }}
k   = {{ value = 20.0, unit = "N/m" }}
s   = {{ value = 0.3, unit = "m" }}
r   = {{ value = 0.7, unit = "m" }}
F_0 = {{ value = 0.9, unit = "N" }}
[domain]
assume = ["m > 0", "k > 0", "r > 0", "F_0 > 0"]
[elements]
jaw = {{ kind = "mass", at = "tip", mass = "m", state = "p" }}
contact = {{ kind = "spring", between = ["tip", "wall"], force = "{}", state = "q" }}
"""
VALUES = {"m": 0.5, "k": 20.0, "s": 0.3, "r": 0.7, "F_0": 0.9, "p": 0.2}
KNOWN = {
    "abs": abs,
    "log": math.log,
    "sign": lambda x: (x > 0) - (x < 0),
    "max": max,
    "min": min,
}


@pytest.mark.some(3)
@pytest.mark.parametrize(
    ("law", "read", "branches"),
    [
        ("k*(q - s)/(1 + abs(q - s)/r)", "abs(q - s)", False),
        ("k*q*abs(q/r)", "abs(q/r)", False),
        ("F_0*sign(q)*abs(q/r)", "sign(q)", False),
        ("k*max(q, s)", "max(q, s)", True),
        ("k*min(q - s, 0)", "min(q - s, 0)", True),
        ("k*(q - s if q < s else 0)", "min(q - s, 0)", True),
        ("k*max(q, 0)**2/r", "max(q, 0)**2", True),
        ("k*(0 if q < s else (q - s)**3)/r**2", "max(0, q - s)**3", True),
        ("k*min(max(q, 0), s)", "min(q, s)", True),
        ("k*(q if q > 0 else -2*q)", "(q if q > 0 else -2*q)", True),
        ("k*(q if q < 0 else 2*q)", "max(q, 2*q)", True),
        ("k*(r if q > 0 else 0)*q/s", "(r if q > 0 else 0)", True),
        ("F_0*(1 if q > s else (-1 if q < 0 else 0*q))*q/r", " if q < 0 else 0)", True),
    ],
)
def test_what_is_read_is_what_is_derived(law, read, branches):
    iphs = derive(parse(SPEC.format(law)))
    exact = dict(zip(iphs.x, iphs.rhs, strict=True))
    q, rate = next((x, exact[y]) for x in iphs.x for y in iphs.x if (str(x), str(y)) == ("q", "p"))
    assert read in text(rate)
    assert "Piecewise" not in text(rate)
    assert branches == ("cases" in latex(rate))
    for place in (-1.1, -0.3, 0.0, 0.1, 0.3, 0.9):
        numbers = {s: sp.Float({**VALUES, "q": place}[str(s)], 30) for s in rate.free_symbols}
        names = {**KNOWN, **VALUES, "q": place, "True": True}
        seen = eval(text(rate), {"__builtins__": {}}, names)
        assert seen == pytest.approx(float(rate.xreplace(numbers)), abs=1e-12), (q, place)


@pytest.mark.parametrize(
    "cases",
    [
        [("x", "x > 1"), ("-x", True)],
        [("x", "x < 0"), ("-x", True)],
        [("x", "x > 0"), ("-2*x", True)],
        [("1", "x > 0"), ("-1", "x < 1"), ("0", True)],
        [("1", "x > 0"), ("-1", "x < 0"), ("2", True)],
        [("1", "x > 0"), ("-1", True)],
    ],
)
def test_what_is_nearly_a_magnitude_is_read_by_its_branches(cases):
    x = sp.Symbol("x", real=True)
    ways = {"x > 1": x > 1, "x > 0": x > 0, "x < 0": x < 0, "x < 1": x < 1, True: True}
    values = {"x": x, "-x": -x, "-2*x": -2 * x, "1": 1, "-1": -1, "0": 0, "2": 2}
    choice = sp.Piecewise(*((values[value], ways[way]) for value, way in cases))
    assert " if " in text(choice)
    assert "cases" in latex(choice)


def test_other_choices_are_read_as_choices():
    x = sp.Symbol("x", real=True)
    assert text(sp.Piecewise((1, sp.Ne(x, 0)), (2, True))) == "(1 if x != 0 else 2)"
    assert text(sp.Piecewise((x, (x > 0) & (x < 3)), (0, True))) == "(x if x > 0 and x < 3 else 0)"


def test_a_power_is_shown_as_a_power():
    """Powers with letters in their exponents are exponentials to SymPy, once they are positive."""
    x, n = sp.Symbol("x", real=True), sp.Symbol("n", real=True)
    value = sp.exp((1 - n) * sp.log(1 - x)) * sp.exp(x)
    assert text(value) == "(1 - x)**(1 - n)*exp(x)"
    assert latex(value) == r"\left(1 - x\right)^{1 - n} e^{x}"
    assert text(sp.exp(sp.log(x) * sp.log(n))) == "exp(log(n)*log(x))"
