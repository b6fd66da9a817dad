"""Units in words, and the units that the kinds give their laws."""

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st
from spec_laws import steady

from piezo_sym.expressions.dimensions import NONE, times
from piezo_sym.expressions.units import parse_unit
from piezo_sym.spec.elements import KINDS, kind_of
from piezo_sym.spec.elements.domains import DOMAINS, PowerVariable
from piezo_sym.spec.elements.marks import Letters
from piezo_sym.spec.unit_text import PARTS, QUANTITIES, quantity, unit_text


@steady
@given(powers=st.lists(st.integers(-4, 4), min_size=7, max_size=7))
def test_the_text_of_a_unit_is_that_unit(powers):
    size = tuple(Fraction(p) for p in powers)
    assert parse_unit(unit_text(size)).dimension == size


@pytest.mark.parametrize(
    "text",
    ["A/K", "ohm*K", "W/K", "J/K", "W/m**2/K", "N*s/m", "C/m", "K/J", "m/s", "kg*m/s", "1/s", "1"],
)
def test_units_people_use_are_spelled_as_people_do(text):
    assert unit_text(parse_unit(text).dimension) == text


@pytest.mark.parametrize("text", PARTS)
def test_a_named_unit_is_spelled_by_its_name(text):
    assert unit_text(parse_unit(text).dimension) == text


def test_quantities_have_names_with_their_units():
    assert quantity(parse_unit("kg*m**2/s**3/A").dimension) == "a voltage [V]"
    assert quantity(NONE) == "a number without unit"
    assert quantity(parse_unit("A/K").dimension) == "a quantity in A/K"
    assert quantity(parse_unit("N*m").dimension) == "an energy [J]"
    assert quantity(parse_unit("N*m").dimension, "N*m") == "a torque [N*m]"


# What the kinds say of their laws.

LETTERS = {"i": "A", "f": "N", "T": "K", "S": "J/K", "phi": "Wb", "q": "m", "Q": "C", "p": "kg*m/s"}
LETTERS |= {"T_1": "K", "T_2": "K", "T_e": "K"}
LETTERS |= {"omega": "rad/s", "tau": "N*m", "L": "N*m*s", "theta": "rad"}
LETTERS |= {"dp": "Pa", "flow": "m**3/s", "V": "m**3", "G": "Pa*s"}


def marks(kind):
    fields = KINDS[kind].model_fields.items()
    return {f: m for f, info in fields for m in info.metadata if isinstance(m, Letters)}


@pytest.mark.parametrize("kind", KINDS)
def test_a_kind_gives_its_laws_and_letters_known_units(kind):
    for field, mark in marks(kind).items():
        for unit in (mark.unit, *(unit for _, unit in mark.instead)):
            words = QUANTITIES[unit]
            named = words if unit == "1" else f"{words} [{unit}]"
            assert quantity(parse_unit(unit).dimension, unit) == named, field
        for letter, unit in mark.units.items():
            assert unit == LETTERS.get(letter) or (letter == "v" and unit in {"V", "m/s"})
    if KINDS[kind].form.letter and any(mark.units for mark in marks(kind).values()):
        assert any(KINDS[kind].form.letter in mark.units for mark in marks(kind).values())


def test_the_product_of_a_dissipative_law_and_its_letter_is_a_power():
    watt = parse_unit("W").dimension
    for kind in ("damper", "resistor", "hysteron", "rotational_damper", "orifice"):
        for mark in marks(kind).values():
            (letter,) = set(mark.units) - {"T", "phi"} or {""}
            if letter:
                sizes = parse_unit(mark.unit).dimension, parse_unit(mark.units[letter]).dimension
                assert times(*sizes) == watt


def test_the_product_of_a_co_state_and_a_state_is_an_energy():
    joule = parse_unit("J").dimension
    for domain in DOMAINS:
        for variable in (domain.across, domain.through):
            sizes = [parse_unit(unit).dimension for unit in (variable.unit, variable.state_unit)]
            assert times(*sizes) == joule


@pytest.mark.parametrize("domain", DOMAINS, ids=lambda domain: domain.name)
def test_the_size_of_a_store_has_the_unit_of_its_law(domain):
    for imposes in PowerVariable:
        kind, costate = kind_of("store", domain, imposes), domain.variable(imposes)
        state, out = (parse_unit(u).dimension for u in (costate.state_unit, costate.unit))
        size = (
            times(out, state, -1) if "rest" in KINDS[kind].model_fields else times(state, out, -1)
        )
        own = marks(kind)[KINDS[kind].form.one_of[0]]
        assert parse_unit(own.unit).dimension == size


def test_a_ratio_has_the_unit_of_its_domains():
    assert sum(len(kind.form.ratios) for kind in KINDS.values()) == 9
    for kind in KINDS.values():
        for first, second, unit in kind.form.ratios:
            given = first.through if kind.form.role == ("gyrator",) else first.across
            sizes = [parse_unit(u).dimension for u in (given.unit, second.across.unit)]
            assert parse_unit(unit).dimension == times(*sizes, -1)
