"""Laws beyond rational ones, in i/i_1 with any i_1 > 0: each is proved, or refuted by numbers."""

import math
from fractions import Fraction

import pytest

from piezo_sym import derive
from piezo_sym.proofs import Verdict, decide
from piezo_sym.spec.load import parse

SPEC = """
[model]
name = "m"
[parameters]
R = {{ value = 1.0, unit = "V" }}
i_1 = {{ value = 1.0, unit = "A" }}
L = {{ value = 1.0, unit = "H" }}
T_0 = {{ value = 300.0, unit = "K" }}
c = {{ value = 1.0, unit = "J/K" }}
[inputs]
V = {{ unit = "V" }}
[domain]
assume = ["R > 0", "i_1 > 0"]
[elements]
src = {{ kind = "voltage_source", between = ["in", "gnd"], input = "V" }}
h = {{ kind = "hysteron", between = ["in", "gnd"], inductance = "L", voltage = "{}", \
heats = "body" }}
body = {{ kind = "thermal_mass", temperature = "T_0*exp(S/c)" }}
"""
PASSIVE = (
    "tanh(z)",
    "z*exp(-z**2)",
    "z + sin(z)",
    "tanh(4*z)*(1 + sin(3*z)/2)",
    "z/(1 + abs(z))",
    "sign(z)*log(1 + abs(z))",
    "z + 2*sin(z)",
    "z + 4*sin(z)",
    "z*sqrt(1 + z**2)",
    "exp(z) - exp(-z)",
    "z + tanh(z) - sin(z)/2",
    "deadzone(z, 1)*exp(-z**2)",
)
ACTIVE = (
    "z - 1.2*tanh(z)",
    "sin(z)",
    "z*(exp(-z**2) - 0.1)",
    "tanh(z) - 0.4*z",
    "z + 5*sin(z)",
    "z*cos(z)",
    "log(1 + abs(z))",
    "exp(z) - 2",
)
PYTHON = {name: getattr(math, name) for name in ("exp", "log", "sin", "cos", "tanh", "sqrt")}
PYTHON |= {"abs": abs, "sign": lambda z: math.copysign(1, z) if z else 0}


def passive(law):
    text = SPEC.format(f"R*({law.replace('z', '(i/i_1)')})".replace("dead(i/i_1)one", "deadzone"))
    return next(row for row in decide(derive(parse(text))).rows if row.id == "passive")


@pytest.mark.parametrize("law", PASSIVE)
def test_a_passive_law_is_proved(law):
    assert passive(law).verdict is Verdict.PROVED


@pytest.mark.some(4)
@pytest.mark.parametrize("law", ACTIVE)
def test_an_active_law_is_refuted(law):
    row = passive(law)
    assert row.verdict is Verdict.REFUTED
    numbers = {name: float(Fraction(text)) for name, text in row.witness.items()}
    assert numbers["R"] > 0 < numbers["i_1"]
    z = numbers["i"] / numbers["i_1"]
    assert eval(law, PYTHON, {"z": z}) * z < 0
    assert len(row.witness["i"]) <= 5


def test_a_factor_in_front_may_have_kinks():
    assert passive("(z + 4*sin(z))*exp(abs(T/T_0))").verdict is Verdict.PROVED
    assert passive("(z + 5*sin(z))*exp(max(T/T_0, 1))").verdict is Verdict.REFUTED
