"""Conductances with kinks: each branch is asked about, and the row says what holds."""

import re

import pytest

from piezo_sym import derive
from piezo_sym.proofs import Verdict, decide
from piezo_sym.spec.elements import KINDS
from piezo_sym.spec.load import parse

SPEC = """
[model]
name = "m"
[parameters]
lam = {{ value = 1.0, unit = "W/K" }}
c = {{ value = 1.0, unit = "J/K" }}
T_0 = {{ value = 300.0, unit = "K" }}
[inputs]
T_e = {{ unit = "K", default = 300.0 }}
[domain]
assume = ["T_e > 0"]
[elements]
a = {{ kind = "thermal_mass", temperature = "T_0*exp(S/c)" }}
b = {{ kind = "thermal_mass", temperature = "T_0*exp(S/c)" }}
contact = {{ kind = "conduction", between = ["a", "b"], conductance = "{0}" }}
outside = {{ kind = "ambient", body = "a", conductance = "{0}", input = "T_e" }}
"""
ROWS = [("passive", "contact"), ("exergy", ""), ("environment", "")]


def rows(law):
    return decided(SPEC.format(law))


def decided(text):
    found = {(r.id, r.element): r for r in decide(derive(parse(text))).rows}
    return [found[name] for name in ROWS]


@pytest.mark.parametrize("law", ["max(lam, 0)", "abs(lam)", "lam if lam > 0 else 0*lam"])
def test_a_conductance_that_is_never_negative_is_proved(law):
    assert {row.verdict for row in rows(law)} == {Verdict.PROVED}


def test_one_without_a_value_is_refuted():
    passive, *_ = rows("lam**2/lam*sign(lam)")
    assert passive.verdict is Verdict.REFUTED
    assert passive.witness["lam"] == "0"


@pytest.mark.parametrize("law", ["min(lam, 0)", "lam if lam > -1 else 0*lam", "lam - abs(lam)"])
def test_one_that_may_be_negative_is_refuted(law):
    passive, *others = rows(law.replace("-1", "-abs(lam) - abs(lam)"))
    assert passive.verdict is Verdict.REFUTED
    assert float(passive.witness["lam"]) < 0
    assert Verdict.PROVED not in {row.verdict for row in others}


@pytest.mark.long
def test_too_many_kinks_are_open():
    law = " + ".join(f"abs(lam - {n}*lam/T_0*T_0)" for n in range(2, 12))
    assert {row.verdict for row in rows(law)} == {Verdict.OPEN}


@pytest.mark.parametrize(
    ("law", "said"),
    [
        ("lam", "; the conditions 'lam >= 0' and 'T_e > 0' in [domain] mend it"),
        ("lam**2/lam", "; the conditions 'lam > 0' and 'T_e > 0' in [domain] mend it"),
        ("abs(lam)", "; the condition 'T_e > 0' in [domain] mends it"),
        (
            "lam*(c*T_0 - 2*c*T_a)/(c*T_0)",
            "; the conditions 'T_e > 0' and 'lam*(T_0 - 2*T_a) >= 0' in [domain] would mend it, "
            "but the values of the spec do not satisfy them",
        ),
    ],
)
def test_what_mends_heat_exchange_with_an_environment_is_said(law, said):
    text = SPEC.format(law).replace('"T_e > 0"', "")
    for row in decided(text)[1:]:
        assert row.verdict is Verdict.REFUTED
        assert row.reason.endswith(said)
    if "would" not in said:
        conditions = ", ".join(f'"{condition}"' for condition in said.split("'")[1::2])
        mended = decided(text.replace("assume = []", f"assume = [{conditions}]"))
        assert {row.verdict for row in mended} == {Verdict.PROVED}


@pytest.mark.parametrize(
    ("element", "law"),
    [
        ("outside", "lam*(T_e - T)/T_e"),
        ("outside", "lam*(T - T_e)"),
        ("contact", "lam*(T_1 - T_2)"),
    ],
)
def test_no_condition_forbids_a_body_to_be_warmer_than_what_is_around_it(element, law):
    text = SPEC.format("lam").replace('"T_e > 0"', '"T_e > 0", "lam >= 0"')
    head, tail = text.split(f"{element} = ")
    text = head + f"{element} = " + tail.replace('conductance = "lam"', f'conductance = "{law}"', 1)
    refuted = [row for row in decided(text) if row.verdict is Verdict.REFUTED]
    assert refuted
    for row in refuted:
        assert "changes its sign with the temperature difference: change the law" in row.reason
        assert "[domain]" not in row.reason


def test_no_condition_mends_a_power_whose_sign_is_that_of_its_letter():
    text = SPEC.format("lam").replace("[inputs]", 'W = { value = 1.0, unit = "N" }\n[inputs]')
    damper = 'damper = { kind = "damper", between = ["tip", "wall"], force = "W", heats = "a" }'
    mass = 'mass = { kind = "mass", at = "tip", mass = "lam" }'
    found = decide(derive(parse(f"{text}{damper}\n{mass}\n"))).rows
    (row,) = (row for row in found if (row.id, row.element) == ("passive", "damper"))
    assert row.verdict is Verdict.REFUTED
    assert "mend" not in row.reason


def test_the_laws_that_the_pages_of_kinds_show_are_proved():
    text = SPEC.format("lam").replace('"T_e > 0"', '"T_e > 0", "lam >= 0", "T_0 > 0", "sigma >= 0"')
    text = text.replace("[inputs]", 'sigma = { value = 1e-9, unit = "W/K**4" }\n[inputs]')
    for kind in ("conduction", "ambient"):
        law = re.search(r", as (.*?)(?: for radiation)?, but must not jump", KINDS[kind].__doc__)[1]
        line = next(line for line in text.splitlines() if f'kind = "{kind}"' in line)
        text = text.replace(line, line.replace('conductance = "lam"', f'conductance = "{law}"'))
    found = decide(derive(parse(text)))
    assert found.proved
    assert all(word in text for word in ("**(1/2)", "**2 + T_e**2"))
