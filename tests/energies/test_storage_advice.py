"""A store whose law depends on another's state is told which storage is meant; that is followed."""

import re

import pytest

from piezo_sym import PiezoError, derive, verify
from piezo_sym.proofs import decide
from piezo_sym.spec.load import parse

SPEC = """
[model]
name = "magnet"
[parameters]
m = { value = 1.0, unit = "kg" }
k = { value = 1.0, unit = "N/m" }
x_0 = { value = 1e-3, unit = "m" }
q_0 = { value = 1e-3, unit = "C" }
L_0 = { value = 1e-3, unit = "H" }
C_0 = { value = 1e-3, unit = "F" }
R = { value = 1.0, unit = "ohm" }
T_0 = { value = 300.0, unit = "K" }
c = { value = 2.0, unit = "J/K" }
[inputs]
V_in = { unit = "V" }
[domain]
assume = ["R >= 0", "x > -x_0"]
[elements]
mass = { kind = "mass", at = "tip", mass = "m" }
spring = { kind = "spring", between = ["tip", "wall"], stiffness = "k", state = "x" }
coil = { kind = "inductor", between = ["a", "b"], inductance = "L_0", state = "phi" }
cap = { kind = "capacitor", between = ["b", "gnd"], capacitance = "C_0", state = "Q" }
wire = { kind = "resistor", between = ["in", "a"], voltage = "R*i", heats = "body" }
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
supply = { kind = "voltage_source", between = ["in", "gnd"], input = "V_in" }
"""
GAP = ('inductance = "L_0"', 'inductance = "L_0*x_0/(x_0 + x)"')
BRANCHES = {
    "phi": 'phi = { rate = "voltage", between = ["a", "b"] }',
    "x": 'x = { rate = "velocity", between = ["tip", "wall"] }',
    "Q": 'Q = { rate = "current", between = ["b", "gnd"] }',
    "S": 'S = { rate = "entropy" }',
}
CASES = {
    "an inductance of a gap": (GAP, "coil", "phi**2*(x_0 + x)/(2*L_0*x_0) + k*x**2/2", "phi x"),
    "a current of a gap": (
        ('inductance = "L_0"', 'current = "phi*(x_0 + x)/(L_0*x_0)"'),
        "coil",
        "(x_0 + x)*phi**2/(2*L_0*x_0) + k*x**2/2",
        "phi x",
    ),
    "an energy of a gap": (
        ('inductance = "L_0"', 'energy = "phi**2*(x_0 + x)/(2*L_0*x_0)"'),
        "coil",
        "phi**2*(x_0 + x)/(2*L_0*x_0) + k*x**2/2",
        "phi x",
    ),
    "a stiffness of a charge": (
        ('stiffness = "k"', 'stiffness = "k*(1 + (Q/q_0)**2)"'),
        "spring",
        "k*(1 + (Q/q_0)**2)*x**2/2 + Q**2/(2*C_0)",
        "x Q",
    ),
    "a rest of a charge": (
        ('stiffness = "k"', 'stiffness = "k", rest = "x_0*Q/q_0"'),
        "spring",
        "k*(x - x_0*Q/q_0)**2/2 + Q**2/(2*C_0)",
        "x Q",
    ),
    "a capacitance of a temperature": (
        ('capacitance = "C_0"', 'capacitance = "C_0*T_0/T"'),
        "body",
        "Q**2*T_0*exp(S/c)/(2*C_0*T_0) + T_0*c*exp(S/c)",
        "Q S",
    ),
    "a heat capacity of a gap": (
        ('temperature = "T_0*exp(S/c)"', 'temperature = "T_0*exp(S/c)*(1 + (x/x_0)**2)"'),
        "body",
        "(1 + (x/x_0)**2)*T_0*c*exp(S/c) + k*x**2/2",
        "S x",
    ),
}


def refusal(text):
    with pytest.raises(PiezoError) as caught:
        parse(text)
    return str(caught.value)


def followed(text, said):
    """Return a spec with what was said done to it: elements replaced, and conditions added."""
    *first, last = re.search(r"in place of (.*): \w+ = \{", said)[1].split(" and ")
    made = re.search(r"place of [^:]*: (.* \})(?:, and add to assume in \[domain\]: |$)", said)[1]
    for gone in re.findall(r"\w+", " ".join((*first, last))):
        text = re.sub(rf"(?m)^{gone} = .*\n", "", text)
    conditions = said.partition("add to assume in [domain]: ")[2]
    return (
        text.replace('"R >= 0"', f'"R >= 0", {conditions}' * bool(conditions) or '"R >= 0"') + made
    )


@pytest.mark.parametrize(("edit", "name", "energy", "states"), CASES.values(), ids=CASES)
def test_the_storage_that_is_meant_is_shown(edit, name, energy, states):
    text = SPEC.replace(*edit)
    said = refusal(text)
    listed = ", ".join(BRANCHES[state] for state in states.split())
    made = f'{name} = {{ kind = "storage", energy = "{energy}", states = {{ {listed} }} }}'
    assert f": {made}" in said
    model = parse(followed(text, said))
    (units,) = (row for row in decide(derive(model)).rows if row.id == "units")
    assert units.verdict.value == "PROVED"


def test_a_magnet_that_was_made_of_the_advice_is_proved():
    text = SPEC.replace(*GAP)
    said = refusal(text)
    assert said.startswith("spec: elements.coil.inductance: the inductance depends on 'x', and ")
    assert said.endswith('add to assume in [domain]: "L_0*x_0/(x_0 + x) > 0", "k > 0"')
    assert verify(derive(parse(followed(text, said)))).proved


@pytest.mark.some(1)
@pytest.mark.parametrize(
    ("old", "new", "needed"),
    [
        ('inductance = "L_0"', 'inductance = "L_0*(1 + x/x_0)"', "x_0"),
        ('stiffness = "k"', 'force = "k*x_0*tanh(q/x_0)*T_0/T"', "k"),
        ('stiffness = "k"', 'force = "k*q*(T_0/T) + k*q**3/x_0**2"', "k"),
    ],
)
def test_all_conditions_that_the_proof_needs_are_said(old, new, needed):
    text = SPEC.replace(', "x > -x_0"', "").replace(old, new)
    said = refusal(text)
    assert verify(derive(parse(followed(text, said)))).proved
    fewer = said.replace(f', "{needed} > 0"', "")
    assert fewer != said
    assert not decide(derive(parse(followed(text, fewer)))).proved


def test_two_states_of_others_are_in_one_storage():
    law = 'inductance = "L_0*x_0/(x_0 + x)*(1 + (Q/q_0)**2)"'
    said = refusal(SPEC.replace('inductance = "L_0"', law))
    assert "depends on 'x' and 'Q'" in said
    assert "in place of 'coil', 'spring' and 'cap': coil = {" in said


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('"spring", between', '"spring", count = 2, between'),
        ('"inductor",', '"hysteron", voltage = "R*i", heats = "body",'),
    ],
)
def test_lanes_and_dissipation_are_no_part_of_a_storage(old, new):
    said = refusal(SPEC.replace(*GAP).replace(old, new))
    assert "kind = " not in said
    assert "write lanes and dissipation apart from the store" in said


def test_an_energy_of_two_entropies_is_no_storage():
    two = 'other = { kind = "thermal_mass", temperature = "T_0*exp(S_o/c)", state = "S_o" }\n'
    text = SPEC.replace("body = {", f"{two}body = {{")
    said = refusal(text.replace('capacitance = "C_0"', 'capacitance = "C_0*T_body/T_other"'))
    assert said.endswith("let it depend on parameters and its own state")
    assert "lanes" not in said


def test_a_state_by_its_letter_is_told_its_symbol():
    said = refusal(SPEC.replace('"R*i"', '"R*i*(1 + (q/x_0)**2)"'))
    assert "'q' has no meaning here" in said
    assert said.endswith("states go by their own symbols: x")


TWINS = """
beside = { kind = "spring", between = ["tip", "wall"], force = "k*max(x - x_0, 0)", state = "y" }
"""


def test_a_state_that_moves_as_its_own_is_told_its_own_name():
    said = refusal(SPEC + TWINS)
    assert said.endswith("write q for x: it has the same rate between the same nodes")
    assert derive(parse(SPEC + TWINS.replace("x - x_0", "q - x_0"))).x
    turned = refusal(SPEC + TWINS.replace('"tip", "wall"', '"wall", "tip"'))
    assert "give one energy of all their states in place of" in turned  # it moves the other way
    shared = (
        SPEC + 'more = { kind = "capacitor", between = ["b", "gnd"], voltage = "Q_2*Q/C_0/q_0" }\n'
    )
    shared = shared.replace('state = "Q"', 'state = "Q_2"')
    assert "give one energy of all" in refusal(shared)  # in parallel, each has a charge of its own


def test_a_limit_that_changes_is_told_to_be_a_parameter():
    dry = 'dry = { kind = "stop", between = ["tip", "wall"], stiffness = "k", limit = "LIMIT", '
    text = SPEC + dry + 'heats = "body", state = "z" }\n'
    said = refusal(text.replace("LIMIT", "k*x_0*T/T_0"))
    assert said.endswith(
        "the limit depends on 'T'; expected parameters alone: it is constant in a run; write "
        "limit = 'a', a parameter in N"
    )
    assert parse(text.replace("LIMIT", "k*x_0"))
