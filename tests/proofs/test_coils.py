"""Coils, capacitors and bodies as users write them: what holds is PROVED, near misses are not."""

import dataclasses

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from piezo_sym import derive, simulate, verify
from piezo_sym.codegen import template_of
from piezo_sym.expressions.parse import parse_law
from piezo_sym.proofs import Verdict, decide
from piezo_sym.spec.load import parse
from piezo_sym.translation import program_row

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
a = {{ value = 1.0, unit = "1/Wb**2" }}
[domain]
assume = {assumed}
[initial]
phi = {phi}
[elements]
coil = {{ kind = "inductor", between = ["a", "gnd"], {coil}, state = "phi" }}
cap = {{ kind = "capacitor", between = ["a", "b"], capacitance = "C", state = "Q" }}
res = {{ kind = "resistor", between = ["b", "gnd"], voltage = "R*i", heats = "body" }}
body = {{ kind = "thermal_mass", temperature = "{body}", state = "S" }}
"""


def circuit(*assumed, coil='inductance = "L"', body="T_0*exp(S/c)", phi=0.9):
    return parse(SPEC.format(assumed=["R >= 0", *assumed], coil=coil, body=body, phi=phi))


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


@pytest.mark.some(2)
@pytest.mark.parametrize(
    "law",
    [
        'inductance = "L/(1 + (phi/phi_s)**6)"',
        'inductance = "L/(1 + a*phi**2)"',
        'inductance = "L*(1/(1 + (phi/phi_s)**10))"',
        'current = "phi/(L/(1 + a*phi**2))"',
    ],
)
def test_coils_that_saturate_are_proved(law):
    verify(derive(circuit("phi_s > 0", "a > 0", "L > 0", coil=law))).raise_if_not_proved()


@pytest.mark.some(1)
@pytest.mark.parametrize("size", ["L/(1 - (phi/phi_s)**6)", "L/(1 + a*phi**2)"])
def test_a_size_that_may_have_no_value_or_sign_is_not_proved(size):
    model = circuit("phi_s > 0", coil=f'inductance = "{size}"')
    ids = [row.id for row in verify(derive(model)).rows if row.verdict is not Verdict.PROVED]
    assert "welldef" in ids


@pytest.mark.parametrize(
    ("old", "new"), [("power_6_of(phi/phi_s)", "power_6_of(phi)"), ("phi/(L", "phi*phi/phi/(L")]
)
def test_a_step_of_another_coil_is_not_proved(old, new):
    iphs = derive(circuit("phi_s > 0", coil='inductance = "L/(1 + (phi/phi_s)**6)"'))
    texts = dict(template_of(iphs).filled(iphs.model.model_dump()))
    assert program_row(iphs, texts, ["_step.c"]).verdict is Verdict.PROVED
    wanted = texts["_step.c"]
    place = wanted.index(old, wanted.index("_integrands(const real"))
    texts["_step.c"] = wanted[:place] + wanted[place:].replace(old, new, 1)
    assert program_row(iphs, texts, ["_step.c"]).verdict is not Verdict.PROVED


def test_a_coil_that_saturates_runs_as_rates_by_hand():
    def rates(_, x):
        phi, Q, S = x
        i = phi * (1 + phi**6) / 0.5
        return [Q / 0.1 - 2 * i, -i, 2 * i * i / (300 * np.exp(S / 2))]

    model = circuit("phi_s > 0", coil='inductance = "L/(1 + (phi/phi_s)**6)"')
    run = simulate(model, duration=1.0, rtol=1e-10, times=[0.0, 1.0])
    own = [float(run[name][-1]) for name in ("phi", "Q", "S")]
    by_hand = solve_ivp(rates, (0, 1), (0.9, 0, 0), "Radau", rtol=1e-10, atol=1e-13)
    assert np.allclose(own, by_hand.y[:, -1], rtol=1e-8, atol=1e-9)
    assert float(np.abs(run.energy_residual).max()) <= 1e-14 * 600
    assert float(np.abs(run.entropy_residual).max()) <= 1e-14


@pytest.mark.some(1)
@pytest.mark.parametrize(
    ("law", "assumed"),
    [
        ("i_s*phi/(phi_s - abs(phi))", ("phi_s - abs(phi) > 0",)),
        ("i_s*log((phi_s + phi)/(phi_s - phi))", ("phi_s - abs(phi) > 0",)),
        ("i_s*log((phi_s + phi)/(phi_s - phi))", ("phi_s - phi > 0", "phi_s + phi > 0")),
        ("i_s*phi/(phi_s - phi)", ("phi < phi_s",)),
        ("i_s*phi_s/(2*phi_s + phi)", ("phi > -2*phi_s",)),
        ("i_s*phi/sqrt(phi_s**2 - phi**2)", ("phi_s > abs(phi)",)),
    ],
)
def test_an_energy_with_logarithms_has_them_of_what_is_positive(law, assumed):
    report = verify(derive(circuit(*assumed, "i_s > 0", coil=f'current = "{law}"')))
    report.raise_if_not_proved()


@pytest.mark.some(2)
@pytest.mark.parametrize("phi", [-2.0, 0.0, 3.0])
@pytest.mark.parametrize(
    "law",
    [
        "i_s*log(1 + max(phi, 0)/phi_s)",
        "i_s*phi_s/(phi_s + phi) if phi > 0 else i_s*phi_s/(phi_s - 2*phi)",
        "i_s*phi/(phi_s + max(phi, -phi_s/2))",
        "i_s*phi_s/(phi_s - phi) if phi < phi_s/2 else 4*i_s*phi/phi_s",
    ],
)
def test_logarithms_of_a_branch_are_those_of_what_is_positive_on_it(law, phi):
    """Whatever branch the spec's own values are on."""
    found = rows(circuit("phi_s > 0", coil=f'current = "{law}"', phi=phi)).values()
    assert {row.verdict for row in found if row.id in {"energy", "welldef"}} == {Verdict.PROVED}


def test_what_a_piece_of_a_table_divides_by_is_not_what_all_do():
    law = 'current = "table(phi, 0, 0, phi_s, i_s, 2*phi_s, i_s*a*L/(1/(a - 1)))"'
    iphs = derive(circuit("phi < phi_s", "phi_s > 0", "a >= 1", coil=law, phi=0.5))
    texts = dict(template_of(iphs).filled(iphs.model.model_dump()))
    found = program_row(iphs, texts)
    assert found.verdict is Verdict.OPEN
    assert "needs a value to be nonzero" in found.reason


@pytest.mark.parametrize(
    ("law", "assumed", "needed"),
    [
        ("i_s*phi/(phi_s - phi)", "(phi_s - phi)**2 > 0", "-phi + phi_s > 0"),
        (
            "i_s*phi*phi_s/(phi_s**2 - phi**2)",
            "abs(phi_s**2 - phi**2) > 0",
            "-phi**2 + phi_s**2 > 0",
        ),
    ],
)
def test_an_energy_without_a_value_says_what_to_write(law, assumed, needed):
    row = rows(circuit(assumed, coil=f'current = "{law}"'))["welldef", "coil"]
    assert row.verdict is Verdict.OPEN
    assert f"add '{needed}' to [domain], or give the law's energy" in row.reason
    assert "has no value at phi_s = " in row.reason


@pytest.mark.parametrize(
    "energy", ["-i_s*(phi + phi_s*log(phi_s - phi/2))", "-i_s*(2*phi + phi_s*log(phi_s - phi))"]
)
def test_a_wrong_energy_is_not_that_of_its_law(energy):
    """The integral is replaced in the derived system, as SymPy's might be wrong."""
    iphs = derive(circuit("phi < phi_s", coil='current = "i_s*phi/(phi_s - phi)"'))
    first, *others = iphs.energies
    wrong = dataclasses.replace(first, law=parse_law(energy, "energy"))
    found = {
        row.id: row for row in decide(dataclasses.replace(iphs, energies=(wrong, *others))).rows
    }
    assert found["energy"].verdict is Verdict.OPEN


@pytest.mark.parametrize(("by", "verdict"), [("phi_s + phi", "PROVED"), ("phi_s + 2*phi", "OPEN")])
def test_printed_text_may_divide_by_a_factor_of_what_the_law_divides_by(by, verdict):
    law = 'current = "i_s*phi/sqrt(phi_s**2 - phi**2)"'
    iphs = derive(circuit("phi_s > abs(phi)", "i_s > 0", coil=law))
    texts = dict(template_of(iphs).filled(iphs.model.model_dump()))
    old = "i_coil = i_s*phi/"
    assert old in texts[".py"]
    texts[".py"] = texts[".py"].replace(old, f"i_coil = i_s*phi*({by})/({by})/")
    assert program_row(iphs, texts, [".py"]).verdict.value == verdict
