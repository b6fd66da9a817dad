"""Which names a law may use: letters, parameters, states, temperatures; and what is refused."""

import re

import pytest
from spec_tools import edited, refused_edit

from piezo_sym import PiezoError, derive
from piezo_sym.proofs import decide
from piezo_sym.spec.load import parse

VOLTAGE = 'voltage = "rho/(T - T_0)*deadzone(i, i_0)"'
BODY = "[elements.ambient]\n"
SECOND = '[elements.mount]\nkind = "thermal_mass"\ntemperature = "T_0*exp(S/c_0)"\n\n'
OHM = '{ value = 1, unit = "ohm" }'
RESISTOR = """[elements.leak]
kind = "resistor"
between = ["cap", "gnd"]
voltage = "LAW"
heats = "body"

"""


def leak(law):
    return (BODY, RESISTOR.replace("LAW", law) + BODY)


def parameter(name, unit="1"):
    return ("[inputs]", f'{name} = {{ value = 1, unit = "{unit}" }}\n[inputs]')


@pytest.mark.parametrize(
    ("law", "name", "unit"),
    [("R*i", "i", "A"), ("R*i*T/T_0", "T", "K")],
)
def test_a_letter_that_is_a_symbol_too_is_refused_where_both_meet(law, name, unit):
    without = [(VOLTAGE, 'voltage = "0*i_0*rho/T_0"'), ('ratio = "a*T/T_0"', 'ratio = "a"')]
    domain = ('"T > T_0"', '"T > 0"')
    new = ("[inputs]", f'{name} = {{ value = 1, unit = "{unit}" }}\nR = {OHM}\n[inputs]')
    message = refused_edit(new, domain, *without, leak(law))
    assert message.startswith(f"spec: elements.leak.voltage: '{name}' is a letter of this law, and")


@pytest.mark.parametrize("letter", ["i", "v", "f", "q", "p", "Q", "phi", "tau", "S_1"])
def test_letters_are_free_elsewhere(letter):
    """A parameter with a letter's name stands in a law that has no such letter."""
    model = edited(
        parameter(letter, "m"),
        ('rest = "q_l"', f'rest = "q_l + {letter}"'),
        ('force = "d*v"', 'velocity = "f/d"') if letter == "v" else ("M ", "M "),
        ('state = "q"', 'state = "x_1"'),
        ('state = "p"', 'state = "p_1"'),
        ('state = "phi"', 'state = "phi_1"'),
        (VOLTAGE, 'voltage = "0*rho*i_0/T_0"') if letter == "i" else ("M ", "M "),
    )
    iphs = derive(model)
    force = iphs.symbols
    assert iphs.E["x_1"].free_symbols == {force[n] for n in ("k", "x_1", "q_l", letter)}


def test_a_state_with_its_kinds_letter_is_the_same_quantity():
    edited(('stiffness = "k"', 'stiffness = "k*(1 + q**2/q_1**2)"'), parameter("q_1", "m"))


def test_t_is_a_parameter_where_the_spec_says_so():
    """Then the only body's temperature goes by its element in [domain], too."""
    plain = [
        (VOLTAGE, 'voltage = "rho/(T_body - T_0)*deadzone(i, i_0)"'),
        ('ratio = "a*T/T_0"', 'ratio = "a*T_body/T_0"'),
        ('"T > T_0"', '"T_body > T_0", "T > 0"'),
    ]
    iphs = derive(edited(parameter("T", "s"), *plain))
    assert str(iphs.circuit.bodies["body"].temperature) == "T_body"
    assert {row.verdict.value for row in decide(iphs).rows} == {"PROVED"}


def test_the_only_body_has_both_names():
    named = edited(
        (VOLTAGE, 'voltage = "rho/(T_body - T_0)*deadzone(i, i_0)"'),
        ('"T > T_0"', '"T_body > T_0"'),
    )
    assert derive(named).rhs == derive(edited()).rhs
    assert decide(derive(named)).rows == decide(derive(edited())).rows


def test_a_law_of_a_store_sees_no_other_state():
    message = refused_edit(('capacitance = "C"', 'capacitance = "C*(1 + q/q_l)"'))
    assert "the capacitance depends on 'q', and then is no energy of Q" in message
    assert "in place of 'capacitor' and 'spring'" in message


def test_a_law_sees_no_lane_of_a_bank():
    message = refused_edit(('force = "d*v"', 'force = "d*v*(1 + phi**2)"'))
    where = "spec: elements.damper.force: unknown name 'phi'"
    assert message.startswith(where) or "'phi' has no meaning here" in message
    assert "it is a state of bank 'hysteron', whose own laws alone have its lane" in message


def test_a_law_sees_no_single_lane_of_a_bank():
    message = refused_edit(('force = "d*v"', 'force = "d*v*(1 + phi_1**2)"'))
    assert "elements.damper.force: unknown name 'phi_1'; it is one lane of a state of" in message
    assert "put 'hysteron' and 'damper' into one cell" in message
    own = refused_edit((VOLTAGE, 'voltage = "rho/T_0*i*(1 + phi_1**2)"'))
    assert "a law in a bank writes the state of its own lane, 'phi'" in own


def test_a_bank_sees_no_lane_of_another():
    other = """[elements.second]
kind = "hysteron"
between = ["in", "cap"]
count = 2
inductance = "L"
voltage = "rho/T_0*i*(1 + phi**2)"
heats = "body"
state = "psi"

"""
    message = refused_edit((BODY, other + BODY))
    assert "elements.second.voltage" in message
    assert "it is a state of bank 'hysteron', whose own laws alone have its lane" in message


CELLS = """
[model]
name = "cells"
[parameters]
k = { value = 1.0, unit = "N/m" }
m = { value = 1.0, unit = "kg" }
d = { value = 1.0, unit = "N*s/m" }
a = { value = 1.0, unit = "m" }
T_0 = { value = 300.0, unit = "K" }
[domain]
assume = ["d >= 0", "a > 0"]
[elements]
ELEMENTS
block = { kind = "mass", at = "tip", mass = "m" }
body = { kind = "thermal_mass", temperature = "T_0*exp(S)" }
[banks.creep]
count = 3
[banks.creep.elements]
k_c = { kind = "spring", between = ["tip", "inner"], stiffness = "k", state = "s" }
d_c = { kind = "damper", between = ["inner", "wall"], force = "d*v", heats = "body" }
LANES
"""
DAMPER = """
d_2 = { kind = "damper", between = ["tip", "wall"], force = "d*v*(1 + LAW**2)", heats = "body" }
"""
SPRING = 'k_2 = { kind = "spring", between = ["tip", "wall"], stiffness = "k", state = "z" }'


def cells(elements, lanes=""):
    return parse(CELLS.replace("ELEMENTS", elements).replace("LANES", lanes))


def test_what_to_write_for_a_law_of_a_lane_does():
    alone = "so that each lane has its own; or write the lanes as elements of their own"
    damper = DAMPER.replace("LAW", "(s/a)")
    with pytest.raises(PiezoError, match=r"move 'd_2' to \[banks\.creep\.elements\], " + alone):
        cells(damper)
    assert derive(cells("", damper)).model.elements["creep_d_2"].count == 3
    damper, spring = DAMPER.replace("LAW", "(z/a)"), SPRING.replace("}", ", count = 2 }")
    said = (
        "put 'k_2' and 'd_2' into one cell, as the elements of [banks.k_2_cells] with count = 2, "
    )
    with pytest.raises(PiezoError, match=re.escape(said + alone)):
        cells(damper + spring)
    both = f"[banks.k_2_cells]\ncount = 2\n[banks.k_2_cells.elements]\n{SPRING}{damper}"
    assert derive(cells("", both)).model.elements["k_2_cells_d_2"].count == 2


def test_a_law_that_has_no_lanes_is_not_moved_into_a_cell():
    lever = 'l = { kind = "lever", first = ["tip", "wall"], second = ["x", "wall"], ratio = "s/a" }'
    with pytest.raises(PiezoError, match="lane; write the lanes as elements of their own") as error:
        cells(lever)
    assert "elements.l.ratio" in str(error.value)


def test_a_lane_sees_its_own_state():
    model = edited(
        (VOLTAGE, 'voltage = "rho/(T - T_0)*deadzone(i, i_0)*(1 + phi**2/flux_0**2)"'),
        parameter("flux_0", "Wb"),
        ('"d >= 0"', '"d >= 0", "flux_0 > 0"'),
    )
    assert {row.verdict.value for row in decide(derive(model)).rows} == {"PROVED"}
    lanes = derive(model).expand({"hysteron": 2})
    assert "phi_2**2/flux_0**2" in lanes.model.elements["hysteron_2"].voltage


@pytest.mark.parametrize(
    ("law", "part"),
    [
        ("rho/T_0*i*(1 + F_ext)", "'F_ext' is an input, and this law sees none"),
        ("rho/T_0*i*T_mount", "'T_mount'"),
    ],
)
def test_inputs_and_bodies_that_are_not_there_are_unknown(law, part):
    assert part in refused_edit((VOLTAGE, f'voltage = "{law}"'))


def test_the_units_of_what_a_law_sees_count():
    """q is in metres: 1 + q is refused by row units."""
    rows = decide(derive(edited(('force = "d*v"', 'force = "d*v*(1 + q)"')))).rows
    (units,) = (row for row in rows if row.id == "units")
    assert units.verdict.value == "REFUTED"
    assert "elements.damper.force" in units.reason


def test_two_bodies_have_a_name_each():
    model = edited(
        (BODY, SECOND + BODY),
        (VOLTAGE, 'voltage = "rho/(T_mount - T_0)*deadzone(i, i_0)"'),
        ('"T > T_0"', '"T_body > T_0", "T_mount > T_0"'),
        ("[initial]", '[initial]\nS_mount = "c_0"'),
    )
    assert {row.verdict.value for row in decide(derive(model)).rows} == {"PROVED"}
