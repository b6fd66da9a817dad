"""The shipped model as a value: what it says, that it is frozen, what equals what."""

from copy import deepcopy

import pytest
from pydantic import ValidationError
from spec_tools import MINIMAL, SHIPPED, edited, refusal, refused_edit

from piezo_sym import Model, derive, load
from piezo_sym.errors import SpecError
from piezo_sym.spec.elements import KINDS
from piezo_sym.spec.fields import Header, Input, Parameter
from piezo_sym.spec.load import parse
from piezo_sym.spec.table import Table
from piezo_sym.spec.tables import (
    banks,
    bodies,
    condition_text,
    conditions,
    lane_parameters,
    states,
    temperatures,
)

PAPER = {
    "model": {
        "name": "piezo_stack",
        "title": "Piezoelectric stack actuator with hysterons",
        "source": "Caballeria, Ramirez, Le Gorrec (2021), eqs. (9)-(13), Table 1",
    },
    "parameters": {
        "M": {"value": 3.5e-3, "unit": "kg", "doc": "moving mass"},
        "k": {"value": 5e5, "unit": "N/m", "doc": "stiffness"},
        "q_l": {"value": 0.0, "unit": "m", "doc": "rest position of the spring"},
        "d": {"value": 4e2, "unit": "N*s/m", "doc": "damping"},
        "C": {"value": 5e-6, "unit": "F", "doc": "capacitance"},
        "L": {"value": 1e-3, "unit": "H", "doc": "inductance of one hysteron"},
        "rho": {"value": 10, "unit": "ohm*K", "doc": "resistance law: slope rho/(T - T_0)"},
        "i_0": {"value": 0.5, "unit": "A", "doc": "half width of the dead zone"},
        "a": {"value": 10.0, "unit": "C/m", "doc": "transducer ratio at T_0"},
        "T_0": {"value": 296.15, "unit": "K", "doc": "reference temperature"},
        "c_0": {"value": 5, "unit": "J/K", "doc": "heat capacity"},
        "lam": {"value": 2.0, "unit": "W/K", "doc": "heat conductance to the environment"},
    },
    "inputs": {
        "F_ext": {"unit": "N", "default": 0.0, "doc": "external force on the tip"},
        "V_in": {"unit": "V", "doc": "supply voltage"},
        "T_e": {"unit": "K", "default": 298.15, "doc": "temperature of the environment"},
    },
    "domain": {
        "assume": [
            "T > T_0",
            "T_e > T_0",
            "d >= 0",
            "rho >= 0",
            "i_0 >= 0",
            "lam >= 0",
        ]
    },
    "initial": {"S": "c_0*log(T_e/T_0)"},
    "elements": {
        "spring": {
            "kind": "spring",
            "between": ["tip", "wall"],
            "stiffness": "k",
            "rest": "q_l",
            "state": "q",
        },
        "mass": {"kind": "mass", "at": "tip", "mass": "M", "state": "p"},
        "capacitor": {
            "kind": "capacitor",
            "between": ["cap", "gnd"],
            "capacitance": "C",
            "state": "Q_C",
        },
        "hysteron": {
            "kind": "hysteron",
            "between": ["in", "cap"],
            "count": 2,
            "inductance": "L",
            "voltage": "rho/(T - T_0)*deadzone(i, i_0)",
            "heats": "body",
            "state": "phi",
        },
        "damper": {"kind": "damper", "between": ["tip", "wall"], "force": "d*v", "heats": "body"},
        "transducer": {
            "kind": "transducer",
            "electrical": ["cap", "gnd"],
            "mechanical": ["tip", "wall"],
            "ratio": "a*T/T_0",
            "temperature": "body",
        },
        "body": {"kind": "thermal_mass", "temperature": "T_0*exp(S/c_0)", "state": "S"},
        "ambient": {"kind": "ambient", "body": "body", "conductance": "lam", "input": "T_e"},
        "load": {"kind": "force_source", "at": "tip", "input": "F_ext"},
        "supply": {"kind": "voltage_source", "between": ["in", "gnd"], "input": "V_in"},
    },
}


@pytest.fixture(scope="module")
def model():
    return load("piezo_stack")


def test_the_shipped_spec_is_the_papers(model):
    assert model == Model(**PAPER)


def test_equal_models_have_equal_hashes(model):
    other = Model(**PAPER)
    assert hash(model) == hash(other)
    assert model.sha256 == other.sha256


def test_tables_keep_their_order(model):
    for table in ("parameters", "inputs", "elements"):
        assert list(getattr(model, table)) == list(PAPER[table])


def test_states_follow_their_elements(model):
    assert states(model) == {
        "q": "spring",
        "p": "mass",
        "Q_C": "capacitor",
        "phi": "hysteron",
        "S": "body",
    }


def test_banks_bodies_and_temperatures(model):
    assert banks(model) == {"hysteron": 2}
    assert bodies(model) == ("body",)
    assert temperatures(model) == {"T": "body"}


def test_parameters_that_may_differ_by_lane(model):
    assert lane_parameters(model, conditions(model)) == {
        "L": "hysteron",
        "rho": "hysteron",
        "i_0": "hysteron",
    }


def test_the_domain_is_what_is_assumed_and_what_kinds_need(model):
    assert [condition_text(c.tree) for c in conditions(model)] == [
        "T > T_0",
        "T_e > T_0",
        "d >= 0",
        "rho >= 0",
        "i_0 >= 0",
        "lam >= 0",
        "k > 0",
        "M > 0",
        "C > 0",
        "L > 0",
        "T_0 > 0",
        "c_0 > 0",
    ]


def test_values_in_si(model):
    assert model.parameters["M"].si == 3.5e-3
    assert model.inputs["T_e"].si == 298.15
    assert model.inputs["V_in"].si == 0.0


def test_a_model_from_typed_parts_equals_one_from_data():
    typed = Model(
        model=Header(name="slider"),
        parameters={"m": Parameter(value=2.0, unit="kg")},
        elements={"body": KINDS["mass"](at="tip", mass="m")},
    )
    assert typed == parse(MINIMAL)


def test_a_model_from_tables_equals_one_from_dicts(model):
    again = Model(
        model=model.model,
        parameters=model.parameters,
        inputs=model.inputs,
        domain=model.domain,
        initial=model.initial,
        elements=model.elements,
    )
    assert again == model


@pytest.mark.parametrize("table", ["parameters", "inputs", "elements"])
def test_order_is_part_of_a_model(model, table):
    turned = dict(reversed(PAPER[table].items()))
    other = Model(**(PAPER | {table: turned}))
    assert other != model
    assert other.sha256 != model.sha256


def test_a_model_cannot_change(model):
    with pytest.raises(ValidationError, match="frozen"):
        model.parameters = {}


def test_a_parameter_cannot_change(model):
    with pytest.raises(ValidationError, match="frozen"):
        model.parameters["M"].value = 1.0


def test_an_element_cannot_change(model):
    with pytest.raises(ValidationError, match="frozen"):
        model.elements["mass"].mass = "k"


def test_a_table_cannot_change(model):
    with pytest.raises(TypeError):
        model.parameters["M"] = model.parameters["k"]
    with pytest.raises(TypeError):
        del model.parameters["M"]


def test_a_models_data_is_not_shared_with_the_caller():
    data = deepcopy(PAPER)
    model = Model(**data)
    del data["parameters"]["M"]
    data["elements"]["mass"]["mass"] = "k"
    assert model.parameters["M"].value == 3.5e-3
    assert model.elements["mass"].mass == "M"


def test_a_name_that_no_table_has_is_told_those_like_it(model):
    for table in (model.parameters, derive(model).symbols):
        with pytest.raises(KeyError) as error:
            table["lamb"]
        assert str(error.value) == "unknown name 'lamb'; did you mean 'lam'?"
        assert "lamb" not in table
        assert table.get("lamb", 3) == 3


def test_tables_compare_their_order():
    assert Table({"a": 1, "b": 2}) == {"a": 1, "b": 2}
    assert Table({"a": 1, "b": 2}) != Table({"b": 2, "a": 1})
    assert hash(Table({"a": 1})) == hash(Table({"a": 1}))
    assert Table({"a": 1}) != [("a", 1)]
    assert repr(Table({"a": 1})) == "Table({'a': 1})"


def test_models_can_be_keys(model):
    assert {model: 1}[Model(**PAPER)] == 1


@pytest.mark.parametrize(
    ("missing", "said"), [("model", "is missing"), ("elements", "has no elements")]
)
def test_tables_that_must_be_there(missing, said):
    error = refusal(lambda: Model(**{k: v for k, v in PAPER.items() if k != missing}))
    assert f"{missing}: {said}" in str(error)


def test_the_smallest_model():
    assert states(parse(MINIMAL)) == {"p_body": "body"}


@pytest.mark.parametrize("key", ["self", "data", "cls", "name", "model_config", "_checked"])
def test_any_unknown_top_key_is_refused(key):
    assert f"unknown key '{key}'" in str(refusal(parse, f"{key} = 1\n{SHIPPED}"))


def test_a_typed_element_is_checked_like_data():
    parts = dict(PAPER["elements"]) | {
        "other": KINDS["capacitor"](between=("a", "gnd"), capacitance="CC")
    }
    with pytest.raises(SpecError, match=r"elements\.other\.capacitance: unknown name 'CC'"):
        Model(**(PAPER | {"elements": parts}))


def test_inputs_have_the_default_zero():
    assert Input(unit="N").si == 0.0


def test_two_bodies_have_two_temperatures():
    second = """
[elements.shell]
kind = "thermal_mass"
temperature = "T_0*exp(S/c_0)"
"""
    model = edited(
        ("[elements.ambient]", f"{second}\n[elements.ambient]"),
        ('"T > T_0"', '"T_body > T_0", "T_shell >= T_0"'),
    )
    assert temperatures(model) == {"T_body": "body", "T_shell": "shell"}


WIDTH = "[inputs]", 'b = { value = 1, unit = "m" }\n[inputs]'
BREADTH = "[inputs]", 'b = { value = -1, unit = "m" }\n[inputs]'
#: Where a half width may stand besides in laws.
WIDE = {
    "in a condition": ('"lam >= 0"', '"lam >= 0", "saturate(q, b) < 2"'),
    "in a width": ('"lam >= 0"', '"lam >= 0", "deadzone(q, saturate(1, b)) < 2"'),
    "in the condition of a choice": (
        '"lam >= 0"',
        '"lam >= 0", "(q if q < saturate(q, b) else 0) <= 0"',
    ),
    "in the start": ("[initial]", '[initial]\nq = "deadzone(q_l, b)"'),
    "in the start of lanes": ("[initial]", '[initial]\nphi = [0, "0*deadzone(q_l, b)"]'),
}


@pytest.mark.parametrize("edit", WIDE.values(), ids=WIDE)
def test_half_widths_are_not_negative_wherever_they_stand(edit):
    assert "b >= 0" in [condition_text(c.tree) for c in conditions(edited(WIDTH, edit))]
    assert "outside the domain: b = -1; expected" in refused_edit(BREADTH, edit)


def test_a_half_width_is_the_parameter_where_the_letter_of_that_name_is_not_the_laws():
    model = edited(
        ("[inputs]", 'phi = { value = 1, unit = "A" }\n[inputs]'),
        ('state = "phi"', 'state = "flux"'),
        ("deadzone(i, i_0)", "deadzone(i, phi)"),
    )
    found = [condition_text(c.tree) for c in conditions(model)]
    assert "phi >= 0" in found
    assert "flux >= 0" not in found


def test_plain_half_widths_add_no_condition_unless_they_are_negative():
    before = len(conditions(load("piezo_stack")))
    edit = ('"lam >= 0"', '"lam >= 0", "saturate(q, {}) < 2"')
    assert len(conditions(edited((edit[0], edit[1].format(1))))) == before + 1
    assert "expected '-1 >= 0'" in refused_edit((edit[0], edit[1].format(-1)))


def test_conditions_with_choices_are_spelled_as_they_are_read():
    text = "(q if q < 1 else 2) < (3 if q < 1 else 4)"
    model = edited(('"lam >= 0"', f'"lam >= 0", "{text}"'))
    assert text in [condition_text(c.tree) for c in conditions(model)]


def test_laws_keep_their_letters_whatever_the_state_is_called():
    model = edited(('stiffness = "k"', 'stiffness = "k + 0*q**2"'), ('state = "q"', 'state = "x"'))
    assert "k + 0*x**2 > 0" in [condition_text(c.tree) for c in conditions(model)]
