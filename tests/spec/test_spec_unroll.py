"""Banks written out: every lane an element of its own."""

import pytest
from spec_tools import MINIMAL, edited, refusal

from piezo_sym import derive, load
from piezo_sym.errors import UsageError
from piezo_sym.spec.circuit import circuit_of
from piezo_sym.spec.elements.ports import DissipativePort, Storage
from piezo_sym.spec.load import parse
from piezo_sym.spec.tables import banks, condition_text, conditions, states
from piezo_sym.spec.unroll import unroll

TWO_VALUES = ("value = 1e-3,", "value = [1e-3, 2e-3],")


@pytest.fixture(scope="module")
def lanes():
    return unroll(load("piezo_stack"), {})


def test_lanes_are_elements(lanes):
    assert list(lanes.elements)[2:6] == ["capacitor", "hysteron_1", "hysteron_2", "damper"]
    assert banks(lanes) == {}


def test_lanes_have_states_in_the_banks_place(lanes):
    assert list(states(lanes)) == ["q", "p", "Q_C", "phi_1", "phi_2", "S"]


def test_lanes_keep_their_laws(lanes):
    bank = load("piezo_stack").elements["hysteron"]
    for name in ("hysteron_1", "hysteron_2"):
        lane = lanes.elements[name]
        assert lane.model_copy(update={"count": 2, "state": "phi"}) == bank


def test_everything_else_stays(lanes):
    model = load("piezo_stack")
    assert lanes.parameters == model.parameters
    assert lanes.inputs == model.inputs
    assert lanes.domain == model.domain
    assert lanes.initial == model.initial
    for name in set(model.elements) - {"hysteron"}:
        assert lanes.elements[name] == model.elements[name]


@pytest.mark.parametrize("count", [1, 2, 5])
def test_the_size_may_be_another(count):
    lanes = unroll(load("piezo_stack"), {"hysteron": count})
    assert [n for n in lanes.elements if n.startswith("hyst")] == [
        f"hysteron_{n}" for n in range(1, count + 1)
    ]


def test_a_list_becomes_a_parameter_a_lane():
    lanes = unroll(edited(TWO_VALUES), {})
    assert "L" not in lanes.parameters
    assert [lanes.parameters[name].value for name in ("L_1", "L_2")] == [1e-3, 2e-3]
    assert [lanes.elements[f"hysteron_{n}"].inductance for n in (1, 2)] == ["L_1", "L_2"]


def test_parameters_of_lanes_stand_in_the_lists_place():
    assert list(unroll(edited(TWO_VALUES), {}).parameters)[4:8] == ["C", "L_1", "L_2", "rho"]


def test_a_list_of_another_length_gives_its_first_value():
    lanes = unroll(edited(TWO_VALUES), {"hysteron": 3})
    assert [lanes.parameters[f"L_{n}"].value for n in (1, 2, 3)] == [1e-3] * 3


def test_laws_are_renamed_inside():
    lanes = unroll(edited(("value = 0.5", "value = [0.5, 0.6]")), {})
    assert lanes.elements["hysteron_2"].voltage == "rho/(T - T_0)*deadzone(i, i_0_2)"


def test_conditions_of_a_list_become_one_a_lane():
    lanes = unroll(edited(("value = 0.5", "value = [0.5, 0.6]")), {})
    assert lanes.domain.assume == (
        "T > T_0",
        "T_e > T_0",
        "d >= 0",
        "rho >= 0",
        "i_0_1 >= 0",
        "i_0_2 >= 0",
        "lam >= 0",
    )


CONDITION = '"lam >= 0"', '"lam >= 0", "{}"'


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("phi < 1", "phi_{0} < 1"),
        ("phi*q < T", "phi_{0}*q < T"),
        ("phi <= L", "phi_{0} <= L_{0}"),
        ("(phi if phi > 0 else -phi) < 2", "(phi_{0} if phi_{0} > 0 else -phi_{0}) < 2"),
    ],
)
@pytest.mark.parametrize("count", [1, 2, 3])
def test_conditions_on_a_banks_state_become_one_a_lane(text, expected, count):
    model = edited(TWO_VALUES, (CONDITION[0], CONDITION[1].format(text)))
    lanes = unroll(model, {"hysteron": count})
    assert lanes.domain.assume[6:] == tuple(expected.format(n + 1) for n in range(count))


def test_a_system_with_a_condition_on_a_banks_state_is_written_out():
    model = edited((CONDITION[0], CONDITION[1].format("phi**2 < 1")))
    assert "phi_2" in {str(symbol) for symbol in derive(model).expand().x}


@pytest.mark.parametrize(("start", "second"), [('"L"', "L_2"), ('["L", "L/2"]', "L_2/2")])
def test_starts_in_a_banks_list_become_one_a_lane(start, second):
    lanes = unroll(edited(TWO_VALUES, ("[initial]", f"[initial]\nphi = {start}")), {})
    assert (lanes.initial["phi_1"], lanes.initial["phi_2"]) == ("L_1", second)


def test_a_letter_is_no_parameter_of_the_same_name():
    model = edited(
        ("[inputs]", 'phi = { value = [1, 2], unit = "1" }\n[inputs]'),
        ('state = "phi"', 'state = "flux"'),
        ('"rho/(T - T_0)*deadzone(i, i_0)"', '"phi*rho/(T - T_0)*deadzone(i, i_0)"'),
    )
    lane = unroll(model, {}).elements["hysteron_2"]
    assert (lane.inductance, lane.voltage[:5]) == ("L", "phi_2")


def test_conditions_of_the_kind_are_one_a_lane():
    found = [condition_text(c.tree) for c in conditions(unroll(edited(TWO_VALUES), {}))]
    assert {"L_1 > 0", "L_2 > 0"} <= set(found)


@pytest.mark.parametrize(
    ("start", "first", "second"), [("3e-3", 3e-3, 3e-3), ("[1e-3, 2e-3]", 1e-3, 2e-3)]
)
def test_starts_become_one_a_lane(start, first, second):
    lanes = unroll(edited(("[initial]", f"[initial]\nphi = {start}")), {})
    assert (lanes.initial["phi_1"], lanes.initial["phi_2"]) == (first, second)


def test_a_bank_without_a_state_name_gets_one_a_lane():
    lanes = unroll(edited(('state = "phi"\n', "\n")), {})
    assert list(states(lanes))[3:5] == ["phi_hysteron_1", "phi_hysteron_2"]


def test_a_bank_of_one_is_written_out_too():
    assert "hysteron_1" in unroll(edited(("count = 2", "count = 1")), {}).elements


def test_a_model_without_banks_stays():
    assert unroll(parse(MINIMAL), {}) == parse(MINIMAL)


def test_unrolling_twice_changes_nothing(lanes):
    assert unroll(lanes, {}) == lanes


@pytest.mark.parametrize("law", ["1e-300*i", "6.62607015e-34*i", "1e25*i", "+".join(["i"] * 500)])
@pytest.mark.parametrize("values", ["1e-3", "[1e-3, 2e-3]"])
def test_any_law_can_be_written_out(law, values):
    model = edited(
        ("value = 1e-3,", f"value = {values},"),
        ('"rho/(T - T_0)*deadzone(i, i_0)"', f'"{law}"'),
    )
    assert list(unroll(model, {}).elements)[3] == "hysteron_1"


@pytest.mark.parametrize(
    ("counts", "answer"),
    [
        ({"hysteren": 2}, "'hysteren' is no bank of 'piezo_stack'; did you mean 'hysteron'?"),
        ({"mass": 2}, "'mass' is no bank of 'piezo_stack'"),
        ({"hysteron": 0}, "0 is no size"),
        ({"hysteron": True}, "'True' is no size"),
        ({"hysteron": 2.0}, "2.0 is no size"),
    ],
)
def test_sizes_that_are_refused(counts, answer):
    assert answer in str(refusal(unroll, load("piezo_stack"), counts))


def test_a_lane_cannot_take_another_elements_name():
    model = edited(("[elements.damper]", "[elements.hysteron_2]"))
    error = refusal(unroll, model, {})
    assert isinstance(error, UsageError)
    assert "a lane would be called 'hysteron_2', and that name is taken" in str(error)


def test_a_circuit_has_the_quantities_of_each_lane(lanes):
    circuit = circuit_of(lanes)
    costates = [port.costate for _, port in circuit.of(Storage)]
    assert costates == ["F_spring", "v_mass", "V_capacitor", "i_hysteron_1", "i_hysteron_2"]


def test_a_circuit_names_a_banks_quantities_once():
    circuit = circuit_of(load("piezo_stack"))
    assert [(p.bank, r.output) for p, r in circuit.of(DissipativePort)] == [
        ("hysteron", "V_hysteron"),
        (None, "F_damper"),
    ]


def test_quantities_are_named_apart_from_the_specs_symbols():
    model = edited(("[inputs]", 'v_mass = { value = 1, unit = "m/s" }\n[inputs]'))
    assert "v_mass_" in [port.costate for _, port in circuit_of(model).of(Storage)]
