"""Coils, capacitors and bodies as users write them: what holds is PROVED, near misses are not."""

import pytest

from piezo_sym import derive
from piezo_sym.proofs import Verdict, decide
from piezo_sym.spec.load import parse

SPEC = """
[model]
name = "circuit"
title = "a coil that rings, and a resistor that warms a body"
[parameters]
L = {{ value = 0.5, unit = "H" }}
C = {{ value = 0.1, unit = "F" }}
R = {{ value = 2.0, unit = "ohm" }}
c = {{ value = 2.0, unit = "J/K" }}
T_0 = {{ value = 300.0, unit = "K" }}
phi_s = {{ value = 1.0, unit = "Wb" }}
i_s = {{ value = 1.0, unit = "A" }}
[domain]
assume = {assumed}
[initial]
phi = 0.9
[elements]
coil = {{ kind = "inductor", between = ["a", "gnd"], {coil}, state = "phi" }}
cap = {{ kind = "capacitor", between = ["a", "b"], capacitance = "C", state = "Q" }}
res = {{ kind = "resistor", between = ["b", "gnd"], voltage = "R*i", heats = "body" }}
body = {{ kind = "thermal_mass", temperature = "{body}", state = "S" }}
"""


def circuit(*assumed, coil='inductance = "L"', body="T_0*exp(S/c)"):
    return parse(SPEC.format(assumed=["R >= 0", *assumed], coil=coil, body=body))


def rows(model):
    return {(r.id, r.element): r for r in decide(derive(model)).rows}


@pytest.mark.parametrize("condition", ["1 + S/c > 0", "T_0*(1 + S/c) > T_0/1000"])
def test_conditions_that_divide_may_be_about_an_entropy(condition):
    found = rows(circuit(condition, body="T_0*(1 + S/c)")).values()
    assert {row.verdict for row in found if row.required} == {Verdict.PROVED}


@pytest.mark.parametrize("condition", ["1 + S/(c - 1) > 0", "log(2 + S/c) > 0", "T_0/T < 2"])
def test_a_condition_without_a_value_is_not_proved(condition):
    found = rows(circuit(condition, body="T_0*(1 + S/c)"))
    assert found["welldef", ""].verdict is not Verdict.PROVED


def test_a_condition_rests_on_the_temperatures_in_it():
    found = rows(circuit("2 + S/c > 0", "(S/c)**2 > -1", body="T_0*(1 + S/c)"))
    assert found["temperature", "body"].verdict is Verdict.REFUTED
    assert found["welldef", ""].verdict is Verdict.OPEN
