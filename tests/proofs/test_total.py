"""The second law is refuted where one active law, driven alone, makes the whole of sigma negative.

What sigma is at the witness is computed here by hand, from the elements of each network.
"""

from fractions import Fraction

import pytest

from piezo_sym import derive
from piezo_sym.proofs import Verdict, decide
from piezo_sym.spec.load import parse
from tests.proofs.test_refuted import DEAD_ZONE, branches, changed

HEAD = """
[model]
name = "m"
[parameters]
d_1 = { value = 1.0, unit = "N*s/m" }
d_2 = { value = 1.0, unit = "N*s/m" }
R = { value = 1.0, unit = "ohm" }
m = { value = 1.0, unit = "kg" }
k = { value = 1.0, unit = "N/m" }
lam = { value = 1.0, unit = "W/K" }
c = { value = 1.0, unit = "J/K" }
T_0 = { value = 300.0, unit = "K" }
[inputs]
V = { unit = "V" }
[domain]
assume = [ASSUME]
[elements]
body = { kind = "thermal_mass", temperature = "TEMPERATURE" }
"""
EXPONENTIAL = "T_0*exp(S/c)"
MASS = 'mass = { kind = "mass", at = "tip", mass = "m" }\n'
SPRING = 'spring = { kind = "spring", between = ["tip", "wall"], stiffness = "k" }\n'


def damper(n, force, between='["tip", "wall"]'):
    text = f'kind = "damper", between = {between}, force = "{force}", heats = "body"'
    return f"damper_{n} = {{ {text} }}\n"


def row(elements, assume="", temperature=EXPONENTIAL, name="sigma", element=""):
    text = HEAD.replace("ASSUME", assume).replace("TEMPERATURE", temperature) + elements
    rows = decide(derive(parse(text))).rows
    return next(r for r in rows if (r.id, r.element) == (name, element))


def numbers(found):
    assert found.verdict is Verdict.REFUTED
    return {name: Fraction(text) for name, text in found.witness.items()}


def test_a_damper_of_any_sign_refutes_the_second_law():
    at = numbers(row(MASS + SPRING + damper(1, "d_1*v")))
    assert at["d_1"] * at["v_mass"] ** 2 / at["T"] < 0 < at["T"]


def test_another_damper_in_parallel_may_be_too_small():
    """d_2 of any size, d_1 of any sign: where only the mass moves, both take part."""
    elements = MASS + SPRING + damper(1, "d_1*v") + damper(2, "d_2*v/4")
    at = numbers(row(elements, '"d_2 >= 0"'))
    assert at["d_2"] >= 0
    assert (at["d_1"] + at["d_2"] / 4) * at["v_mass"] ** 2 / at["T"] < 0


@pytest.mark.parametrize("larger", ["2*abs(d_1)*v", "(abs(d_1) + d_2)*v", "-d_1*v"])
def test_another_damper_in_parallel_may_outweigh_it(larger):
    """The law is active, the whole is not: nothing is refuted, and nothing is proved."""
    elements = MASS + SPRING + damper(1, "d_1*v") + damper(2, larger)
    assert row(elements, '"d_2 >= 0"', name="passive", element="damper_1").verdict is (
        Verdict.REFUTED
    )
    found = row(elements, '"d_2 >= 0"')
    assert found.verdict is Verdict.OPEN
    assert found.reason == "it rests on passive of damper_1, which is REFUTED"


def test_a_source_may_be_what_drives():
    elements = (
        'supply = { kind = "voltage_source", between = ["in", "gnd"], input = "V" }\n'
        'load = { kind = "resistor", between = ["in", "gnd"], current = "v/R", heats = "body" }\n'
    )
    at = numbers(row(elements))
    assert at["V"] ** 2 / at["R"] / at["T"] < 0


def test_a_damper_between_two_masses_is_driven_by_one_of_them():
    other = MASS.replace("mass =", "other =", 1).replace("tip", "top")
    elements = MASS + other + damper(1, "d_1*v", '["tip", "top"]')
    at = numbers(row(elements + damper(2, "d_2*v"), '"d_2 >= 0"'))
    relative = at["v_mass"] - at["v_other"]
    sigma = at["d_1"] * relative**2 + at["d_2"] * at["v_mass"] ** 2
    assert sigma / at["T"] < 0


def test_conduction_from_cold_to_warm_refutes_it():
    elements = (
        f'other = {{ kind = "thermal_mass", temperature = "{EXPONENTIAL}" }}\n'
        'contact = { kind = "conduction", between = ["body", "other"], conductance = "lam" }\n'
    )
    at = numbers(row(elements))
    gap = at["T_body"] - at["T_other"]
    assert at["lam"] * gap**2 / (at["T_body"] * at["T_other"]) < 0


def test_an_input_that_may_not_be_zero_refutes_nothing():
    """The only point looked at, V = 0, lies outside the domain."""
    elements = (
        MASS
        + damper(1, "d_1*v")
        + 'supply = { kind = "voltage_source", between = ["in", "gnd"], input = "V" }\n'
        + 'load = { kind = "resistor", between = ["in", "gnd"], current = "v/R", heats = "body" }\n'
    )
    text = HEAD.replace('unit = "V" }', 'unit = "V", default = 2.0 }')
    text = text.replace("ASSUME", '"R > 0", "V > 1"').replace("TEMPERATURE", EXPONENTIAL)
    rows = {r.id: r for r in decide(derive(parse(text + elements))).rows if r.id == "sigma"}
    assert rows["sigma"].verdict is Verdict.OPEN


def test_a_temperature_that_is_not_reached_refutes_nothing():
    """T = T_0 + T_0 exp(S/c) is above T_0: not every temperature of a witness can occur."""
    elements = MASS + SPRING + damper(1, "d_1*v")
    found = row(elements, temperature=f"T_0 + {EXPONENTIAL}")
    assert found.verdict is Verdict.OPEN


def test_what_is_no_rational_number_refutes_nothing():
    elements = MASS + SPRING + damper(1, "d_1*v*exp(d_1/d_2)")
    assert row(elements, '"d_2 > 0"').verdict is Verdict.OPEN


def deadzone(z, w):
    return max(z - w, 0) + min(z + w, 0)


BANKS = [
    ([('"rho >= 0", ', "")], lambda i, w: deadzone(i, w)),
    (
        [(DEAD_ZONE, branches(lower="-i - i_0"))],
        lambda i, w: i - w if i > w else -i - w if i < -w else 0,
    ),
    ([('"T > T_0", ', "")], deadzone),
]


@pytest.mark.parametrize(("pairs", "law"), BANKS)
def test_a_bank_is_refuted_by_one_lane(pairs, law):
    rows = decide(derive(changed(*pairs))).rows
    at = numbers(next(r for r in rows if r.id == "sigma"))
    assert at["hysteron_count"] == 1
    i, v = at["i_hysteron_1"], at["v_mass"]
    heat = at["rho"] / (at["T"] - at["T_0"]) * law(i, at["i_0"]) * i + at["d"] * v**2
    assert heat / at["T"] < 0 < at["T"]


def test_what_rests_on_it_is_open():
    rows = decide(derive(changed(('"d >= 0", ', "")))).rows
    found = {r.id: r for r in rows if r.id in {"exergy", "environment"}}
    assert {r.verdict for r in found.values()} == {Verdict.OPEN}
    assert {r.reason for r in found.values()} == {"it rests on sigma, which is REFUTED"}
