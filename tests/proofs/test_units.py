"""Units of whole specs: what is proved scales, and every fault names its term and its remedy."""

from itertools import product
from pathlib import Path

import pytest

from piezo_sym import PiezoError, derive, load
from piezo_sym.expressions.dimensions import BASES
from piezo_sym.expressions.units import parse_unit
from piezo_sym.modules import module_of
from piezo_sym.proofs import Verdict, decide
from piezo_sym.spec.load import parse
from piezo_sym.spec.places import places, state_dimensions
from piezo_sym.spec.source import shipped

SHIPPED = (Path(__file__).parents[2] / "piezo_sym/models/piezo_stack.toml").read_text("utf-8")
STATEMENT = "every term of every equation has its row's unit"


def edited(*pairs):
    text = SHIPPED
    for old, new in pairs:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return parse(text)


def unit_rows(model):
    return [row for row in decide(derive(model)).rows if row.id == "units"]


def reasons(*pairs):
    rows = unit_rows(edited(*pairs))
    assert {row.verdict for row in rows} == {Verdict.REFUTED}
    assert all(row.required and row.reason.isascii() and row.witness is None for row in rows)
    for row in rows:
        place = row.reason.partition(":")[0].split(".")
        assert row.element == (place[1] if place[0] == "elements" else "")
    return [row.reason for row in rows]


@pytest.mark.some(1)
@pytest.mark.parametrize("name", shipped())
def test_shipped_models_are_proved(name):
    (row,) = unit_rows(load(name))
    assert (row.verdict, row.element, row.statement) == (Verdict.PROVED, "", STATEMENT)
    assert decide(derive(load(name))).rows[-1] == row


def test_a_model_written_out_lane_by_lane_is_proved():
    (row,) = [r for r in decide(derive(load("piezo_stack")).expand()).rows if r.id == "units"]
    assert row.verdict is Verdict.PROVED


FAULTS = {
    "c_0 in K/J": (
        ('unit = "J/K"', 'unit = "K/J"'),
        "elements.body.temperature: S/c_0 is J**2/K**2 in exp(S/c_0), a number without unit is "
        "needed; check the unit of c_0: J/K would fit",
        "initial.S: c_0*log(T_e/T_0) is K/J, an entropy [J/K] is needed; check the unit of c_0: "
        "J/K would fit",
    ),
    "lam in W/m**2/K": (
        ('unit = "W/K"', 'unit = "W/m**2/K"'),
        "elements.ambient.conductance: lam is W/m**2/K, a heat conductance [W/K] is needed; check "
        "the unit of lam: W/K would fit",
    ),
    "a in C/s/kg": (
        ('unit = "C/m"', 'unit = "C/s/kg"'),
        "elements.transducer.ratio: a*T/T_0 is A/kg, a transducer ratio [C/m] is needed; check the "
        "unit of a: C/m would fit",
    ),
    "rho without unit": (
        ('unit = "ohm*K"', 'unit = "1"'),
        "elements.hysteron.voltage: rho/(T - T_0)*deadzone(i, i_0) is A/K, a voltage [V] is "
        "needed; check the unit of rho: ohm*K would fit",
    ),
    "i_0 in V": (
        ('unit = "A"', 'unit = "V"'),
        "elements.hysteron.voltage: i is A and i_0 is V in deadzone(i, i_0), equal units are "
        "needed; check the unit of i_0: A would fit",
    ),
    "d in N*s": (
        ('unit = "N*s/m"', 'unit = "N*s"'),
        "elements.damper.force: d*v is J, a force [N] is needed; check the unit of d: N*s/m would "
        "fit",
    ),
    "V_in in A": (
        ('V_in  = { unit = "V"', 'V_in  = { unit = "A"'),
        "elements.supply.input: V_in is A, a voltage [V] is needed; check the unit of V_in: V "
        "would fit",
    ),
    "tanh of a current": (
        ("deadzone(i, i_0)", "i_0*tanh(i)"),
        "elements.hysteron.voltage: i is A in tanh(i), a number without unit is needed; divide i "
        "by a current [A]",
    ),
    "v + 2": (
        ('force = "d*v"', 'force = "v + 2"'),
        "elements.damper.force: v is m/s and 2 has no unit in v + 2, equal units are needed; make "
        "2 a parameter in m/s",
    ),
    "a number as a force": (
        ('force = "d*v"', 'force = "2"'),
        "elements.damper.force: 2 has no unit, a force [N] is needed; make 2 a parameter in N",
    ),
    "a letter as a force": (
        ('force = "d*v"', 'force = "-v"'),
        "elements.damper.force: v is m/s, a force [N] is needed; multiply v by a quantity in N*s/m",
    ),
    "a number of kelvin": (
        ("log(T_e/T_0)", "log(350/T_0)"),
        "initial.S: 350/T_0 is 1/K in log(350/T_0), a number without unit is needed; divide "
        "350/T_0 by a quantity in 1/K, or make 350 a parameter with its unit",
    ),
    "a condition on a number": (
        ('"T > T_0"', '"T > 290"'),
        "domain.assume[0]: T is K and 290 has no unit in T > 290, equal units are needed; make 290 "
        "a parameter in K",
    ),
    "a condition on a state": (
        ('"lam >= 0"', '"lam >= 0", "Q_C <= q_l"'),
        "domain.assume[6]: Q_C is C and q_l is m in Q_C <= q_l, equal units are needed; multiply "
        "q_l by a transducer ratio [C/m]",
    ),
    "a sum of a stiffness and a mass": (
        ('stiffness = "k"', 'stiffness = "k + M"'),
        "elements.spring.stiffness: k is N/m and M is kg in k + M, equal units are needed; "
        "multiply M by a quantity in 1/s**2",
    ),
    "a list of initial values": (
        ("[initial]", '[initial]\nphi = [0.0, "2*L"]'),
        "initial.phi: 2*L is H, a flux linkage [Wb] is needed; multiply 2*L by a current [A], or "
        "make 2 a parameter with its unit",
    ),
    "one input for a force and a voltage": (
        ('input = "V_in"', 'input = "F_ext"'),
        "elements.supply.input: F_ext is N, a voltage [V] is needed; F_ext is used in "
        "elements.load.input with another unit; give one in V of its own here",
    ),
    "one parameter for a mass and an inductance": (
        ('inductance = "L"', 'inductance = "M"'),
        "elements.hysteron.inductance: M is kg, an inductance [H] is needed; M is used in "
        "elements.mass.mass with another unit; give one in H of its own here",
    ),
}


@pytest.mark.some(6)
@pytest.mark.parametrize(("edit", "expected"), [(e, r) for e, *r in FAULTS.values()], ids=FAULTS)
def test_a_fault_names_place_term_unit_need_and_remedy(edit, expected):
    assert reasons(edit) == expected


def test_a_force_in_the_field_of_a_stiffness_is_told_the_field_that_is_meant():
    found = reasons(('stiffness = "k"', 'stiffness = "k*q"'), ('S = "c_0', 'q = 1.0\nS = "c_0'))
    assert found == [
        "elements.spring.stiffness: k*q is N, a stiffness [N/m] is needed; check the unit of k: Pa "
        'would fit; or is it the force itself? then force = "k*q" instead of stiffness'
    ]


@pytest.mark.parametrize(
    ("law", "said"),
    [
        ("k if q > q_l else 0", '; or is it a contact? then force = "k*max(q - q_l, 0)"'),
        ("k if q > q_l else 2*k", ""),
    ],
)
def test_a_stiffness_that_jumps_is_not_offered_for_a_force(law, said):
    (found,) = reasons(('stiffness = "k"\nrest = "q_l"', f'force = "{law}"'))
    assert found.endswith(f"would fit{said}")


def test_a_wrong_reference_temperature_is_the_one_culprit_everywhere():
    found = reasons(('value = 296.15, unit = "K"', 'value = 296.15, unit = "m"'))
    assert len(found) == 6
    assert all(reason.endswith("; check the unit of T_0: K would fit") for reason in found)
    assert found[0].startswith("elements.hysteron.voltage: T is K and T_0 is m in T - T_0, ")


def test_two_wrong_parameters_are_found_apart():
    found = reasons(('unit = "ohm*K"', 'unit = "V"'), ('unit = "A"', 'unit = "V"'))
    assert [reason.rpartition("; ")[2] for reason in found] == [
        "check the unit of i_0: A would fit"
    ]
    found = reasons(('unit = "ohm*K"', 'unit = "V"'), ('unit = "W/K"', 'unit = "W"'))
    assert [reason.rpartition("; ")[2] for reason in found] == [
        "check the unit of rho: ohm*K would fit",
        "check the unit of lam: W/K would fit",
    ]


def test_where_two_parameters_could_be_meant_both_are_offered():
    law = ('resistance law: slope rho/(T - T_0)" }', 'x" }\nb = { value = 1, unit = "1" }')
    (reason,) = reasons(law, ("rho/(T - T_0)*", "b*rho/(T - T_0)**2*"))
    offers = "check the unit of rho: ohm*K**2 would fit, or of b: K would fit"
    assert reason.endswith(f"; {offers}")


def test_a_law_s_letter_is_no_parameter_of_that_name():
    named = 'q = { value = 1, unit = "s" }\nb = { value = 1, unit = "N/m" }\n[inputs]'
    stiff = ('state = "q"', 'state = "x"'), ('stiffness = "k"', 'stiffness = "k + b*q"')
    with pytest.raises(PiezoError, match="'q' is a letter of this law, and a name of this spec"):
        edited(("[inputs]", named), *stiff)


def test_the_error_is_one_line_and_names_the_element():
    report = decide(derive(edited(('unit = "ohm*K"', 'unit = "1"'))))
    with pytest.raises(PiezoError, match=r"ohm\*K would fit") as caught:
        report.raise_if_not_proved()
    assert str(caught.value).startswith("piezo_stack.hysteron: units is REFUTED: elements.hyst")


def test_the_unit_of_an_unused_parameter_cannot_matter():
    for unit in ("1", "V", "kg**3"):
        (row,) = unit_rows(edited(("[inputs]", f'x = {{ value = 1, unit = "{unit}" }}\n[inputs]')))
        assert row.verdict is Verdict.PROVED


def test_prefixes_do_not_matter():
    (row,) = unit_rows(edited(('value = 5e-6,   unit = "F"', 'value = 5, unit = "uF"')))
    assert row.verdict is Verdict.PROVED


PIEZO = load("piezo_stack")


def factors():
    """Each factor at each name; in the fast tier a seventh of them."""
    found = product((*PIEZO.parameters, *PIEZO.inputs), (*BASES, "1/m", "1/K", "V", "N/m", "s**2"))
    for n, pair in enumerate(found):
        yield pytest.param(*pair, marks=[pytest.mark.long] if n % 7 else [])


@pytest.mark.some(2)
@pytest.mark.parametrize(("name", "factor"), [*factors()])
def test_any_other_unit_of_a_parameter_or_input_is_refuted(name, factor):
    """Without exception: piezo_stack has no parameter or input whose unit cannot matter."""
    data = PIEZO.model_dump()
    table = "parameters" if name in PIEZO.parameters else "inputs"
    own = data[table][name]["unit"]
    data[table][name]["unit"] = f"{own}*{factor}".replace("*1/", "/")
    rows = unit_rows(type(PIEZO)(**data))
    assert {row.verdict for row in rows} == {Verdict.REFUTED}
    fitting = parse_unit(own).dimension
    for row in rows:
        culprit, _, rest = row.reason.rpartition("check the unit of ")[2].partition(": ")
        assert culprit == name
        assert parse_unit(rest.partition(" would fit")[0]).dimension == fitting


def test_every_law_of_a_spec_is_a_place():
    found = [place.where for place in places(PIEZO)]
    assert found[:4] == [
        "elements.spring.stiffness",
        "elements.spring.rest",
        "elements.mass.mass",
        "elements.capacitor.capacitance",
    ]
    assert {"elements.ambient.input", "elements.load.input", "elements.supply.input"} <= set(found)
    assert found[-7:] == [*(f"domain.assume[{n}]" for n in range(6)), "initial.S"]


def test_the_states_units_are_those_the_generated_module_gives():
    module = module_of(PIEZO)
    sizes = state_dimensions(PIEZO)
    assert {s.name: parse_unit(s.unit).dimension for s in module.STATES} == sizes
