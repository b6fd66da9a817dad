"""Networks that random ones, or thoughts about them, have shown to be handled wrongly."""

import pytest
from agreement import DERIVED, REFUSED, check

from piezo_sym import Model, PiezoError, derive
from piezo_sym.errors import NetworkError
from piezo_sym.spec.load import parse

BODY = {"kind": "thermal_mass", "temperature": "T_0*exp(S/c)"}
CAPACITOR = {"kind": "capacitor", "between": ["b", "gnd"], "capacitance": "C"}


def spec(elements, **inputs):
    """Return a spec with a body, the elements given, and inputs with their units."""
    return {
        "model": {"name": "network"},
        "parameters": {
            "R": {"value": 2.5, "unit": "ohm"},
            "C": {"value": 1.5, "unit": "F"},
            "n": {"value": 1.0, "unit": "1"},
            "T_0": {"value": 2.5, "unit": "K"},
            "c": {"value": 1.5, "unit": "J/K"},
        },
        "inputs": {name: {"unit": unit} for name, unit in inputs.items()},
        "domain": {"assume": ["R > 0"]},
        "initial": {},
        "elements": {"body": BODY, **elements},
    }


@pytest.mark.parametrize("law", ["0*i", "(R - R)*i", "(R - R/2*2)*i", "i - i", "0"])
def test_a_resistor_without_resistance_is_not_turned_round(law):
    elements = {
        "source": {"kind": "voltage_source", "between": ["a", "gnd"], "input": "V"},
        "wire": {"kind": "resistor", "between": ["a", "b"], "voltage": law, "heats": "body"},
        "store": CAPACITOR,
    }
    given = spec(elements, V="V")
    with pytest.raises(NetworkError, match="'source', 'wire', 'store' fix each other"):
        derive(Model(**given))


def test_a_resistor_without_resistance_works_where_its_current_is_given():
    elements = {
        "coil": {"kind": "inductor", "between": ["a", "b"], "inductance": "C"},
        "wire": {"kind": "resistor", "between": ["a", "gnd"], "voltage": "0*i", "heats": "body"},
        "store": CAPACITOR,
    }
    assert check(spec(elements)) == DERIVED


def test_a_law_that_jumps_where_two_sources_of_one_input_cancel():
    jump = {"voltage": "R*sign(i)", "heats": "body", "discontinuous": True}
    elements = {
        "push": {"kind": "current_source", "between": ["b", "gnd"], "input": "I"},
        "pull": {"kind": "current_source", "between": ["gnd", "b"], "input": "I"},
        "rub": {"kind": "resistor", "between": ["b", "gnd"], **jump},
    }
    assert check(spec(elements, I="A")) == DERIVED


def test_a_network_without_a_reference_is_refused():
    elements = {
        "store": {**CAPACITOR, "between": ["a", "b"]},
        "coil": {"kind": "inductor", "between": ["a", "b"], "inductance": "C"},
    }
    assert check(spec(elements)) == REFUSED


JUMP = """
[model]
name = "jump"
[parameters]
R = { value = 2.0, unit = "ohm" }
V_c = { value = 1.0, unit = "V" }
C = { value = 0.1, unit = "F" }
T_0 = { value = 300.0, unit = "K" }
c = { value = 2.0, unit = "J/K" }
[inputs]
V = { unit = "V" }
[elements]
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)" }
supply = { kind = "voltage_source", between = ["in", "gnd"], input = "V" }
store = { kind = "capacitor", between = ["n", "gnd"], capacitance = "C" }
"""


@pytest.mark.parametrize("law", ["R*i + V_c*sign(i)", "R*i + V_c if i > 0 else R*i"])
def test_a_law_with_a_jump_is_not_turned_round_as_if_it_were_linear(law):
    text = (
        f'r = {{ kind = "resistor", between = ["in", "n"], voltage = "{law}", heats = "body" }}\n'
    )
    with pytest.raises(PiezoError, match="give"):
        derive(parse(JUMP + text))


@pytest.mark.parametrize("law", ["R*i + V_c*sign(i)", "R*i + V_c if i > 0 else R*i"])
def test_a_law_with_a_jump_is_not_solved_in_a_loop_as_if_it_were_linear(law):
    text = f"""
first = {{ kind = "resistor", between = ["in", "n"], current = "v/R", heats = "body" }}
second = {{ kind = "resistor", between = ["n", "m"], current = "v/R", heats = "body" }}
third = {{ kind = "resistor", between = ["m", "gnd"], voltage = "{law}", heats = "body" }}
"""
    with pytest.raises(PiezoError, match="determine each other's flow"):
        derive(parse(JUMP + text))


def test_a_current_that_is_zero_has_a_kink_of_its_voltage():
    """The printed slope chooses between integers: minus the sign of 0, and 0."""
    law = {"voltage": "R*deadzone(i, n*T/T_0)", "heats": "body"}
    elements = {
        "store": {**CAPACITOR, "between": ["a", "b"]},
        "coil": {"kind": "inductor", "between": ["b", "a"], "inductance": "C"},
        "wire": {"kind": "resistor", "between": ["a", "gnd"], **law},
    }
    assert check(spec(elements)) == DERIVED


@pytest.mark.long
def test_a_kink_of_what_springs_without_a_sign_give():
    """On the kink the two branches differ by a multiple of the difference that is zero there."""
    elements = {
        "one": {"kind": "spring", "between": ["m", "wall"], "force": "k*sinh(q)"},
        "two": {"kind": "spring", "between": ["m", "tip"], "energy": "k*cosh(q)"},
        "load": {"kind": "mass", "at": "tip", "mass": "n"},
        "rub": {
            "kind": "damper",
            "between": ["wall", "m"],
            "velocity": "(R*max(f, 0) + C*min(f, 0))*(1 + S_body**2)",
            "heats": "body",
        },
    }
    given = spec(elements)
    given["parameters"]["k"] = {"value": 1.5, "unit": "N/m"}
    given["domain"]["assume"] += ["C > 0"]
    assert check(given) == DERIVED


def test_signs_of_products_decide_between_the_branches_behind_a_gear():
    elements = {
        "gear": {
            "kind": "gear",
            "first": ["shaft", "rotor"],
            "second": ["frame", "rotor"],
            "ratio": "n",
        },
        "shaft": {"kind": "torsion_spring", "between": ["shaft", "frame"], "stiffness": "k"},
        "rub": {
            "kind": "rotational_damper",
            "between": ["frame", "rotor"],
            "angular_velocity": "R*deadzone(tau, C*T/T_0)",
            "heats": "body",
        },
    }
    given = spec(elements)
    given["parameters"]["k"] = {"value": 1.5, "unit": "N*m/rad"}
    given["domain"]["assume"] += ["C > 0", "n > 0"]
    assert check(given) == DERIVED
