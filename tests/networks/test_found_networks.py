"""Networks that random ones, or thoughts about them, have shown to be handled wrongly."""

import pytest
from agreement import DERIVED, REFUSED, check

from piezo_sym import derive
from piezo_sym.errors import NetworkError
from piezo_sym.spec.model import Model

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
