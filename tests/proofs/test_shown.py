"""What rows that are not PROVED show of a law with free parameters: counterexamples, conditions."""

from fractions import Fraction

import pytest

from piezo_sym import derive
from piezo_sym.proofs import Verdict, decide
from piezo_sym.spec.load import parse

SPEC = """
[model]
name = "shown"
[parameters]
m = {{ value = 1.0, unit = "kg" }}
c = {{ value = 2.0, unit = "J/K" }}
T_0 = {{ value = 300.0, unit = "K" }}
d = {{ value = 1.0, unit = "N*s/m" }}
v_0 = {{ value = 1.0, unit = "m/s" }}
n = {{ value = 1.5, unit = "1" }}
[domain]
assume = {domain}
[elements]
mass = {{ kind = "mass", at = "tip", mass = "m" }}
damper = {{ kind = "damper", between = ["tip", "wall"], force = "{law}", heats = "body" }}
body = {{ kind = "thermal_mass", temperature = "T_0*exp(S/c)" }}
"""
POWER = "d*v*abs(v/v_0)**(n - 1)"


def rows(law, *domain):
    report = decide(derive(parse(SPEC.format(law=law, domain=[*domain]))))
    return {r.id: r for r in report.rows if r.element in {"damper", ""}}


@pytest.mark.parametrize("more", [(), ("n > 0",), ("n < 5",)])
def test_a_power_is_refuted_where_mathematics_has_no_value(more):
    """At n = 1, which was shown, the law is d*v: only a negative power of zero has no value."""
    row = rows(POWER, "d >= 0", "v_0 > 0", *more)["welldef"]
    assert row.verdict is Verdict.REFUTED
    at = {name: Fraction(value) for name, value in row.witness.items()}
    with pytest.raises(ZeroDivisionError):
        at["v"] * abs(at["v"] / at["v_0"]) ** (at["n"] - 1)
    found = rows(POWER, "d >= 0", "v_0 > 0", "n > 1", *more)
    assert {r.verdict for r in found.values()} == {Verdict.PROVED}


def test_a_power_that_laws_may_not_have_is_no_counterexample():
    row = rows("d*v*abs(T/T_0)**n", "d >= 0", "T > 0")["welldef"]
    assert row.verdict is Verdict.OPEN
    assert row.witness is None
    assert row.reason.endswith("the condition 'n > 0' in [domain] mends it")
    row = rows("d*v*abs(v/v_0)**max(n - 1, 0)", "d >= 0", "v_0 > 0", "n >= 1")["welldef"]
    assert row.verdict is Verdict.OPEN
    assert row.witness is None


BODY = 'body = {{ kind = "thermal_mass", temperature = "T_0*exp(S/c)" }}'
STORE = """
[elements.body]
kind = "storage"
energy = "ENERGY"
states = {{ S = {{ rate = "entropy" }} }}
"""
HOT = SPEC.replace("[domain]", 'b = {{ value = 1.0, unit = "1" }}\n[domain]').replace(BODY, STORE)


@pytest.mark.parametrize(
    ("energy", "domain", "verdict", "said", "less"),
    [
        ("c*T_0*(1 + S/c)**n", ["S > -c"], Verdict.REFUTED, "n > 1", "n > 0.9"),
        ("c*T_0*(1 + S/c)**n", ["S > -c", "n > 0"], Verdict.OPEN, "n > 1", "n > 0.9"),
        ("c*T_0*(exp(n) - exp(b))*exp(S/c)", [], Verdict.REFUTED, "n > b", "n > b - 0.1"),
        ("c*T_0*(n**2*b - n*b)*exp(S/c)", ["n > 0", "b > 0"], Verdict.REFUTED, "n > 1", "n > 0.9"),
    ],
)
def test_conditions_are_short_and_what_is_less_is_not_enough(energy, domain, verdict, said, less):
    def row(*more):
        text = HOT.format(law="d*v", domain=["c > 0", "T_0 > 0", "d >= 0", *domain, *more])
        report = decide(derive(parse(text.replace("ENERGY", energy))))
        return next(row for row in report.rows if row.id == "temperature")

    assert row().verdict is verdict
    assert f"; the condition '{said}' in [domain]" in row().reason
    assert row(said).verdict is Verdict.PROVED
    assert row(less).verdict is not Verdict.PROVED
