"""Rows on the same laws of the junction: a condition that is missing is named, not a contradiction.

Two resistors of one loop determine each other's current; the law of one divides by a parameter.
"""

import pytest

from piezo_sym import derive, verify
from piezo_sym.proofs import decide
from piezo_sym.report import Verdict
from piezo_sym.spec.load import parse

WELL = "welldef"
LOOP = """
[model]
name = "loop"
[parameters]
r_1 = {{ value = 2.0, unit = "ohm" }}
r_2 = {{ value = 3.0, unit = "ohm" }}
n = {{ value = 1.5, unit = "N/A" }}
a = {{ value = 0.4, unit = "C/m" }}
s_0 = {{ value = 1.0, unit = "J/K" }}
L = {{ value = 2.0, unit = "H" }}
T_0 = {{ value = 300.0, unit = "K" }}
c = {{ value = 2.0, unit = "J/K" }}
[domain]
assume = [{more}"r_1 > 0", "r_2 > 0", "n > 0", "T_b > T_0"]
[initial]
S_b = 0.1
[elements]
one = {{ kind = "resistor", between = ["gnd", "e"], voltage = "{law}", heats = "b" }}
other = {{ kind = "resistor", between = ["gnd", "f"], voltage = "r_2*i*T/T_0", heats = "b" }}
m = {{ kind = "motor", electrical = ["e", "f"], translation = ["wall", "g"], constant = "n" }}
t = {{ kind = "transducer", electrical = ["gnd", "e"], mechanical = ["wall", "g"], ratio = "a" }}
coil = {{ kind = "inductor", between = ["gnd", "e"], inductance = "L" }}
b = {{ kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S_b" }}
"""


def report_on(law, more=""):
    return verify(derive(parse(LOOP.format(law=law, more=more))))


def test_a_condition_that_is_missing_is_named():
    """S = 0, where simple numbers begin, is outside the domain: T > T_0."""
    rows = report_on("r_1*i*(2 + tanh(S_b/s_0))").rows
    refuted = [row for row in rows if row.verdict is Verdict.REFUTED]
    assert {(row.id, row.element) for row in refuted} == {("welldef", ""), ("welldef", "one")}
    for row in refuted:
        assert row.witness == {"s_0": "0"}
        assert row.reason == "s_0 = 0; the condition 's_0 > 0' in [domain] mends it"
    beside = [row for row in rows if row.id == "welldef" and row.statement.startswith("n")]
    assert [row.verdict for row in beside] == [Verdict.OPEN]
    assert beside[0].reason == "its laws are also those of a row that is REFUTED"


def test_with_the_condition_all_is_proved():
    report = report_on("r_1*i*(2 + tanh(S_b/s_0))", more='"s_0 > 0", ')
    assert report.proved, [row.reason for row in report.rows]


DRIVEN = """
more = { kind = "inductor", between = ["gnd", "h"], inductance = "L" }
third = { kind = "resistor", between = ["h", "gnd"], voltage = "LAW", heats = "b" }
"""


@pytest.mark.parametrize(
    "law", ["r_1*(i if i > -1 else i/s_0)", "r_1*i*(2 + (tanh(S_b/s_0) if S_b > 1 else 0))"]
)
def test_what_depends_on_the_drive_or_the_state_is_not_refuted_by_parameters_alone(law):
    """At the start neither law divides by s_0."""
    text = LOOP.format(law="r_1*i", more="") + DRIVEN.replace("LAW", law)
    (row,) = (r for r in decide(derive(parse(text))).rows if r.element == "third" and r.id == WELL)
    assert row.verdict is not Verdict.PROVED
    assert row.witness is None or {"s_0"} < row.witness.keys()


def test_an_energy_without_a_value_refutes_no_law():
    """The integral divides by a; the force k*exp(a*q) has a value at a = 0."""
    spring = """
tip = { kind = "mass", at = "x", mass = "c" }
bend = { kind = "spring", between = ["x", "wall"], force = "n*exp(a*q)", state = "q" }
"""
    text = LOOP.format(law="r_1*i", more="") + spring
    rows = decide(derive(parse(text))).rows
    (row,) = (r for r in rows if (r.id, r.element) == (WELL, "bend"))
    assert row.verdict is Verdict.OPEN
    assert "add 'a > 0' or 'a < 0' to [domain], or give the law's energy" in row.reason
