"""Messages say where: the element and field of a law, and the values that leave it without one."""

import pytest

from piezo_sym import PiezoError, load
from piezo_sym.spec.load import parse

PIEZO = load("piezo_stack").to_toml()
STORAGE = """
[model]
name = "stored"
[parameters]
m = { value = 1.0, unit = "kg" }
[elements.block]
kind = "mass"
at = "tip"
mass = "m"
[elements.gas]
kind = "storage"
energy = "q.real"
[elements.gas.states]
q = { rate = "velocity", between = ["tip", "wall"] }
"""
CELLS = """
[banks.creep]
count = 2
[banks.creep.elements]
s = { kind = "spring", between = ["tip", "inside"], stiffness = "k.real", state = "q_c" }
d = { kind = "damper", between = ["inside", "wall"], force = "d*v", heats = "body" }
"""


def refusal(text):
    with pytest.raises(PiezoError) as caught:
        parse(text)
    assert str(caught.value).isprintable()
    return str(caught.value).removeprefix("spec: ")


@pytest.mark.parametrize(
    ("field", "law"),
    [("voltage", "rho/(T - T_0)*deadzone(i, i_0)"), ("inductance", "L"), ("ratio", "a*T/T_0")],
)
def test_a_law_that_cannot_be_read_is_named_with_its_element(field, law):
    element = "transducer" if field == "ratio" else "hysteron"
    text = PIEZO.replace(f'{field} = "{law}"', f'{field} = "T.real"')
    assert text != PIEZO
    assert refusal(text).startswith(f"elements.{element}.{field}: 'T.real' has '.' at column 2")


def test_an_energy_that_cannot_be_read_is_named_with_its_element():
    assert refusal(STORAGE).startswith("elements.gas.energy: 'q.real' has '.' at column 2")


def test_a_law_of_a_cell_that_cannot_be_read_is_named_as_it_is_written():
    assert refusal(PIEZO + CELLS).startswith("banks.creep.elements.s.stiffness: 'k.real' has '.'")


@pytest.mark.parametrize(
    ("name", "value", "said"),
    [
        ("T_0", "296.15", "initial.S: has no finite real value: c_0 = 5, T_e = 298.15, T_0 = 0;"),
        ("c_0", "5.0", "elements.body: the values given are outside the domain: c_0 = 0; expected"),
    ],
)
def test_what_has_no_value_is_said_with_the_values_it_is_made_of(name, value, said):
    text = PIEZO.replace(f"{name} = {{ value = {value}", f"{name} = {{ value = 0.0")
    assert text != PIEZO
    assert refusal(text).startswith(said)


@pytest.mark.parametrize("given", ["[parameters]\nT = { value", "[inputs]\nT = { default"])
def test_a_condition_on_a_temperature_that_is_called_as_the_bodys_is_refused(given):
    table = given.splitlines()[0]
    named = PIEZO.replace("(T - T_0)", "(T_body - T_0)").replace("a*T/T_0", "a*T_body/T_0")
    text = named.replace(table, f'{given} = 400.0, unit = "K" }}', 1)
    said = "'T' is the temperature of the only body, and a name of this spec; expected one meaning"
    assert refusal(text).startswith(f"domain.assume[0]: 'T > T_0': {said}")
    fine = text.replace('"T > T_0"', '"T_body > T_0"')
    assert "T" in parse(fine).to_toml()
    if "value" in given:  # the body's kind needs T > 0, and means the parameter
        assert parse(fine.replace('"T_0*exp(S/c_0)"', '"T*exp(S/c_0)"'))
