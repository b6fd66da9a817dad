"""Numbers and lists of a spec that are refused, each at its place."""

import pytest
from spec_tools import edited, refused_edit

TWO_VALUES = ("value = 1e-3,", "value = [1e-3, 2e-3],")
SECOND_BANK = """
[elements.other]
kind = "hysteron"
between = ["in", "cap"]
count = 3
inductance = "L2"
voltage = "10*i"
heats = "body"
state = "psi"

[elements.damper]"""
WITH_SECOND_BANK = (
    ("[inputs]", 'L2 = { value = [1, 2, 3], unit = "H" }\n[inputs]'),
    ("[elements.damper]", SECOND_BANK),
)


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        ("nan", "expected a finite number"),
        ("inf", "expected a finite number"),
        ("-inf", "expected a finite number"),
        ("true", "expected a plain number"),
        ('"3.5e-3"', "expected a plain number"),
        ("1979-05-27", "expected a plain number"),
        ("{}", "expected a plain number"),
        ("[]", "expected a plain number"),
        ("[[1]]", "expected a plain number"),
        ("1e301", "expected a number up to 1e300"),
        ("1" + "0" * 400, "expected a number up to 1e300"),
    ],
)
def test_values_that_are_no_numbers(value, expected):
    message = refused_edit(("value = 3.5e-3", f"value = {value}"))
    assert message.startswith("spec: parameters.M.value: ")
    assert expected in message


@pytest.mark.parametrize("value", ["nan", "inf", "true", '"0"', "[1.0]"])
def test_defaults_that_are_no_numbers(value):
    message = refused_edit(("default = 298.15", f"default = {value}"))
    assert message.startswith("spec: inputs.T_e.default: ")


@pytest.mark.parametrize("value", ["nan", "inf", "true", "{}", "[]", "[true, 1]"])
def test_starts_that_are_no_numbers(value):
    message = refused_edit(("[initial]", f"[initial]\nphi = {value}"))
    assert message.startswith("spec: initial.phi: ")


@pytest.mark.parametrize(
    ("name", "old", "new", "condition"),
    [
        ("L", "value = 1e-3", "value = 0", "L > 0"),
        ("d", "value = 4e2", "value = -1", "d >= 0"),
        ("rho", 'value = 10.0,   unit = "ohm', 'value = -10.0, unit = "ohm', "rho >= 0"),
        ("i_0", "value = 0.5", "value = -0.5", "i_0 >= 0"),
        ("lam", "value = 2.0", "value = -2", "lam >= 0"),
    ],
)
def test_values_outside_the_domain(name, old, new, condition):
    message = refused_edit((old, new))
    assert f"the values given are outside the domain: {name} = " in message
    assert f"expected '{condition}'; change a value or the domain" in message


@pytest.mark.parametrize(
    ("old", "new", "condition", "size"),
    [
        ("value = 3.5e-3", "value = 0", "M > 0", "mass"),
        ("value = 3.5e-3", "value = -1", "M > 0", "mass"),
        ("value = 5e-6", "value = 0", "C > 0", "capacitance"),
        ("value = 5e5", "value = -5e5", "k > 0", "stiffness"),
        ('stiffness = "k"', 'stiffness = "-k"', "-k > 0", "stiffness"),
    ],
)
def test_a_store_of_the_wrong_sign_is_told_so(old, new, condition, size):
    message = refused_edit((old, new))
    assert "the values given are outside the domain" in message
    assert message.endswith(f"expected '{condition}'; check its sign: {size} has to be above 0")


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("value = 296.15", "value = 0"),
        ("value = 296.15", "value = -1"),
        ("value = 5.0", "value = 0"),
        ("value = 5.0", "value = -5"),
    ],
)
def test_temperatures_and_heat_capacities_are_positive(old, new):
    refused_edit((old, new))


@pytest.mark.parametrize("value", ["296.15", "290", "0", "-1"])
def test_the_environment_is_above_the_reference(value):
    message = refused_edit(("default = 298.15", f"default = {value}"))
    assert "initial.S: has no finite real value" in message or "expected 'T_e > T_0'" in message


def test_a_condition_of_the_spec_is_named_by_its_place():
    message = refused_edit(("value = 4e2", "value = -1"))
    assert message.startswith("spec: domain.assume[2]: ")


def test_a_condition_of_a_kind_is_named_by_its_element():
    message = refused_edit(("value = 3.5e-3", "value = 0"))
    assert message.startswith("spec: elements.mass: ")


@pytest.mark.parametrize(
    "count", ["0", "-1", "2.0", "true", '"2"', "[2]", "nan", "1000001", "1" + "0" * 30]
)
def test_sizes_of_banks(count):
    message = refused_edit(("count = 2", f"count = {count}"))
    assert message.startswith("spec: elements.hysteron.count: ")
    assert "expected" in message


@pytest.mark.parametrize("count", ["1", "2", "1000000"])
def test_good_sizes_of_banks(count):
    assert edited(("count = 2", f"count = {count}")).elements["hysteron"].count == int(count)


def test_a_source_has_no_size():
    message = refused_edit(('kind = "force_source"', 'kind = "force_source"\ncount = 2'))
    assert message == ("spec: elements.load.count: unknown key 'count'; known: kind, at, input")


def test_a_list_is_a_value_a_lane():
    assert edited(TWO_VALUES).parameters["L"].si == (1e-3, 2e-3)


def test_a_list_is_converted_to_si():
    model = edited(('value = 1e-3,   unit = "H"', 'value = [1, 2], unit = "mH"'))
    assert model.parameters["L"].si == (1e-3, 2e-3)


@pytest.mark.parametrize("values", ["[1e-3]", "[1e-3, 1e-3, 1e-3]"])
def test_a_list_of_the_wrong_length(values):
    message = refused_edit(("value = 1e-3,", f"value = {values},"))
    assert message.startswith("spec: parameters.L.value: a list of ")
    assert message.endswith("expected 2, one for each lane of bank 'hysteron'")


@pytest.mark.parametrize(
    ("old", "name"),
    [("value = 3.5e-3", "M"), ("value = 296.15", "T_0"), ("value = 4e2", "d")],
)
def test_a_list_outside_a_bank(old, name):
    message = refused_edit((old, "value = [300.0, 300.0]"))
    assert message.startswith(f"spec: parameters.{name}.value: a list is given; expected one numb")


def test_a_list_for_a_hysteron_that_is_no_bank():
    message = refused_edit(TWO_VALUES, ("count = 2  ", ""))
    assert message.startswith("spec: parameters.L.value: a list is given")


def test_a_list_for_a_parameter_that_no_law_uses():
    message = refused_edit(("[inputs]", 'z = { value = [1, 2], unit = "1" }\n[inputs]'))
    assert message.startswith("spec: parameters.z.value: a list is given")


def test_a_list_for_a_parameter_that_another_element_uses_too():
    message = refused_edit(TWO_VALUES, ('"d*v"', '"d*v + 0*L"'))
    assert message.startswith("spec: parameters.L.value: a list is given")


def test_a_lane_outside_the_domain_is_named():
    message = refused_edit(("value = 1e-3,", "value = [1e-3, -2e-3],"))
    assert message.startswith("spec: elements.hysteron: ")
    assert "L = -0.002; expected 'L > 0' in lane 2" in message


@pytest.mark.parametrize("start", ["1e-3", "[1e-3, 2e-3]", '"L"', '["L", "2*L"]', '["L", 0.0]'])
@pytest.mark.parametrize("law", ["L", "L*(1 + phi)", "L + phi**2"])
def test_starts_of_a_bank(start, law):
    model = edited(
        TWO_VALUES,
        ("[initial]", f"[initial]\nphi = {start}"),
        ('inductance = "L"', f'inductance = "{law}"'),
        ('"lam >= 0"', '"lam >= 0", "phi >= 0", "phi <= 2*L + 1"'),
    )
    assert "phi" in model.initial


@pytest.mark.parametrize("start", ["[1.0]", "[1.0, 2.0, 3.0]"])
def test_starts_of_the_wrong_length(start):
    message = refused_edit(("[initial]", f"[initial]\nphi = {start}"))
    assert message.startswith("spec: initial.phi: ")
    assert message.endswith("values are given; expected 2 values, one per lane")


def test_a_list_of_starts_outside_a_bank():
    message = refused_edit(("[initial]", "[initial]\nq = [1.0, 2.0]"))
    assert message.endswith("2 values are given; expected one value: no bank has this state")


def test_a_start_of_a_lane_outside_the_domain():
    message = refused_edit(
        ("[initial]", "[initial]\nphi = [1.0, -1.0]"), ('"lam >= 0"', '"lam >= 0", "phi >= 0"')
    )
    assert message.startswith("spec: domain.assume[6]: ")
    assert "phi = -1; expected 'phi >= 0' in lane 2" in message


@pytest.mark.parametrize(
    "condition",
    ["F_ext > 0", "q > 0", "phi_h > 0", "T > 300", "1 + lam/1e20 <= 1", "T_0*T_0 > T_0**2"],
)
def test_defaults_and_the_start_lie_in_the_domain(condition):
    message = refused_edit(
        ('state = "phi"', 'state = "phi_h"'), ('"lam >= 0"', f'"lam >= 0", "{condition}"')
    )
    assert message.startswith("spec: domain.assume[6]: the values given are outside the domain: ")
    assert "; change a value or the domain" in message


@pytest.mark.parametrize(
    ("start", "said"),
    [
        ("", "expected 'T_e > T_0'; change a value or the domain"),
        ('S = "c_0*log(T_e/T_0)"', "initial.S: has no finite real value"),
    ],
)
def test_an_ambient_without_a_default_is_told_to_have_one(start, said):
    message = refused_edit(('S = "c_0*log(T_e/T_0)"', start), ("default = 298.15, ", ""))
    assert said in message
    more = "; input T_e is 0, as it has no other default: give it one (default = 293.15)"
    assert message.endswith(more)


def test_a_start_outside_the_domain_is_told_before_its_laws_are_evaluated():
    message = refused_edit(
        ('S = "c_0*log(T_e/T_0)"', "S = -6.0"),
        ('"lam >= 0"', '"lam >= 0", "S > -c_0"'),
        ("T_0*exp(S/c_0)", "T_0*log(2 + S/c_0)*exp(S/c_0)*sqrt(1 + S/c_0)"),
    )
    assert message.startswith(
        "spec: domain.assume[6]: the values given are outside the domain: S ="
    )
    assert message.endswith("expected 'S > -c_0'; change initial.S or the domain")


def test_a_force_in_the_field_of_a_stiffness_is_told_where_it_belongs():
    assert refused_edit(('stiffness = "k"', 'stiffness = "k*q"')) == (
        "spec: elements.spring: the values given are outside the domain: k = 500000, q = 0; "
        "expected 'k*q > 0'; change a value or the domain; a law of the force itself is given as "
        "force, not as stiffness"
    )


@pytest.mark.parametrize("condition", ["1 + lam/1e20 > 1", "exp(1e9*d) > 1", "exp(0 - 1e9*d) > 0"])
def test_what_rounding_hides_is_in_the_domain(condition):
    edited(('"lam >= 0"', f'"lam >= 0", "{condition}"'))


@pytest.mark.parametrize("T_e", [298.15, 297.003, 297.018, 297.002, 297.01])
@pytest.mark.parametrize("condition", ["T >= T_e", "T <= T_e"])
def test_a_start_on_an_edge_of_the_domain_is_not_refused_for_its_rounding(T_e, condition):
    edited(("default = 298.15", f"default = {T_e}"), ('"lam >= 0"', f'"lam >= 0", "{condition}"'))


@pytest.mark.parametrize("start", ["log(0*M - 1*M)", "1/(M - M)", "exp(1e9*M)"])
def test_a_start_without_a_value(start):
    message = refused_edit(('"c_0*log(T_e/T_0)"', f'"{start}"'))
    assert message == (
        "spec: initial.S: has no finite real value: M = 0.0035; check the values of its parameters"
        + ", and the sign inside log" * ("log" in start)
    )


def test_a_temperature_without_a_value():
    message = refused_edit(('"T_0*exp(S/c_0)"', '"T_0*log(S - 1*c_0)"'))
    assert message.startswith("spec: elements.body.temperature: has no finite real value")


def test_lists_of_two_banks_in_one_condition():
    message = refused_edit(*WITH_SECOND_BANK, ('"lam >= 0"', '"lam >= 0", "L < L2 + 9"'))
    assert message.startswith("spec: parameters.L2.value: a list is given")


def test_a_state_of_one_bank_and_a_list_of_another_in_one_condition():
    message = refused_edit(*WITH_SECOND_BANK, ('"lam >= 0"', '"lam >= 0", "phi < L2"'))
    assert message.startswith("spec: parameters.L2.value: a list is given")


def test_states_of_two_banks_in_one_condition():
    message = refused_edit(*WITH_SECOND_BANK, ('"lam >= 0"', '"lam >= 0", "phi < psi + 1"'))
    said = "spec: domain.assume[6]: 'phi < psi + 1': mixes states of the banks hysteron, other"
    assert message.startswith(said)


def test_two_banks_with_lists_of_their_own():
    model = edited(TWO_VALUES, *WITH_SECOND_BANK)
    assert [len(model.parameters[name].si) for name in ("L", "L2")] == [2, 3]


def test_every_body_starts_in_the_domain():
    """Two bodies, so that each has a temperature of its own; the first starts at T_e."""
    second = '[elements.other]\nkind = "thermal_mass"\ntemperature = "T_0*exp(S/c_0)"\n'
    edits = (
        ("[elements.ambient]", f"{second}\n[elements.ambient]"),
        ('"T > T_0"', '"T_body > T_0", "T_other >= T_0"'),
    )
    edited(*edits)
    message = refused_edit(*edits, ("[initial]", '[initial]\nS_other = "-1e-9*c_0"'))
    assert "T_other = 296.15, T_0 = 296.15; expected 'T_other >= T_0'" in message
