"""A structure that divides by a ratio is proved only if the ratio is shown not to be zero."""

import pytest

from piezo_sym import derive
from piezo_sym.proofs import Verdict, decide
from piezo_sym.spec.load import parse

WHERE = {("welldef", ""), ("temperature", "body")}
LEVER = """
[model]
name = "lever"
[parameters]
n = {{ value = 2.0, unit = "1" }}
k = {{ value = 3.0, unit = "N/m" }}
m = {{ value = 1.0, unit = "kg" }}
T_0 = {{ value = 300.0, unit = "K" }}
c = {{ value = 2.0, unit = "J/K" }}
[domain]
assume = [{assume}]
[elements]
body = {{ kind = "thermal_mass", temperature = "{law}" }}
mass = {{ kind = "mass", at = "a", mass = "m" }}
spring = {{ kind = "spring", between = ["b", "wall"], stiffness = "k" }}
lever = {{ kind = "lever", first = ["a", "wall"], second = ["b", "wall"], ratio = "{ratio}" }}
"""


def rows(assume="", ratio="n", law="T_0*exp(S/c)"):
    report = decide(derive(parse(LEVER.format(assume=assume, ratio=ratio, law=law))))
    return {row.id: row for row in reversed(report.rows) if (row.id, row.element) in WHERE}


def test_a_ratio_of_known_sign_is_proved():
    assert rows(assume='"n > 0"')["welldef"].verdict is Verdict.PROVED


def test_a_ratio_of_unknown_sign_may_be_zero():
    row = rows()["welldef"]
    assert row.verdict is Verdict.REFUTED
    assert row.witness == {"n": "0"}


def test_a_ratio_that_is_zero_is_refuted():
    assert rows(ratio="n - n")["welldef"].verdict is Verdict.REFUTED


@pytest.mark.parametrize("law", ["T_0*exp(-S/c)", "T_0"])
def test_a_temperature_that_does_not_rise_is_refuted(law):
    assert rows(assume='"n > 0"', law=law)["temperature"].verdict is Verdict.REFUTED
