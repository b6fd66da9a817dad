"""Units: exact factors, coherent spellings, and what is no unit."""

import math
from fractions import Fraction

import pint
import pytest
from hypothesis import given
from hypothesis import strategies as st
from spec_laws import steady
from spec_tools import edited, refusal, refused_edit

from piezo_sym.errors import SpecError
from piezo_sym.expressions.si_units import EXACT, PREFIXES
from piezo_sym.expressions.units import base_units, parse_unit, to_si


@pytest.mark.parametrize(
    ("value", "unit", "si"),
    [
        (5, "uF", 5e-06),
        (1, "mH", 1e-3),
        (3.3, "kohm", 3300.0),
        (3.5, "g", 3.5e-3),
        (25.4, "mm", 0.0254),
        (0.1, "N/mm", 100.0),
        (7, "N*s/m", 7.0),
        (1, "h", 3600.0),
        (2, "bar", 2e5),
        (1, "mm**3", 1e-9),
        (1, "1/ms", 1e3),
        (1, "kg*m/s^2", 1.0),
        (4, "uC/um", 4.0),
        (30, "percent", 0.3),
        (-1.5, "kV", -1500.0),
        (0.0, "kV", 0.0),
        (96.15, "kN/m", 96150.0),
        (0.07, "mA", 7e-05),
        (2, "N/(m/s)**(1/2)", 2.0),
        (3, "um**(1/2)", 3e-3),
        (3, "kN/(mm**2/s)^(1/2)", 3e6),
        (2, "liter**2", 2e-6),
        (3, "mJ/(kg*K)", 3e-3),
        (2, "in*(m)", 0.0508),
    ],
)
def test_values_in_si(value, unit, si):
    assert to_si(value, parse_unit(unit)) == si


def test_units_known_by_heart_are_those_of_pint():
    """Each unit, with each letter before it that is a prefix, and no other."""
    registry = pint.UnitRegistry(non_int_type=Fraction)
    for name in EXACT.keys() - {"1"}:
        for letter in ("", *PREFIXES) if name != "kg" else ("",):
            factor, base = registry.get_base_units(letter + name)
            unit = parse_unit(letter + name)
            assert (unit.factor, unit.si) == (factor, EXACT[name][0])
            own = registry.get_base_units(base_units(unit.dimension))
            assert (own[0], own[1].dimensionality) == (1, base.dimensionality)


def test_turns_a_minute():
    assert to_si(60.0, parse_unit("rpm")) == pytest.approx(2 * math.pi, rel=1e-16)


@pytest.mark.parametrize(
    ("unit", "factor"),
    [
        ("uF", Fraction(1, 10**6)),
        ("mH", Fraction(1, 1000)),
        ("kohm", Fraction(1000)),
        ("g", Fraction(1, 1000)),
        ("in", Fraction(254, 10**4)),
        ("N/mm", Fraction(1000)),
        ("pF**-1", Fraction(10**12)),
        ("1", Fraction(1)),
        ("eV", Fraction("1.602176634e-19")),
    ],
)
def test_factors_are_exact(unit, factor):
    assert parse_unit(unit).factor == factor


@pytest.mark.parametrize(
    ("unit", "si"),
    [
        ("uF", "F"),
        ("mH", "H"),
        ("kohm", "ohm"),
        ("g", "kg"),
        ("N*s/m", "N*s/m"),
        ("N*m/deg", "N*m"),
        ("m**3/deg", "m**3"),
        ("m/1", "m"),
        ("1/(deg*mm)", "1/m"),
        ("1/percent", "1"),
        ("N/mm", "N/m"),
        ("mm**2", "m**2"),
        ("1", "1"),
        ("mWb", "Wb"),
        ("kg*m/s", "kg*m/s"),
        ("1/ms", "1/s"),
        ("h", "s"),
        ("ohm*K", "ohm*K"),
        ("MPa", "Pa"),
    ],
)
def test_coherent_spellings(unit, si):
    assert parse_unit(unit).si == si


@pytest.mark.parametrize(
    "unit", ["uF", "kohm*K", "N/mm", "g*mm/ms", "rpm", "mH**2/uC", "bar", "eV"]
)
def test_the_coherent_spelling_is_coherent_and_of_the_same_dimension(unit):
    given_unit = parse_unit(unit)
    coherent = parse_unit(given_unit.si)
    assert coherent.factor == 1
    assert coherent.dimension == given_unit.dimension


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("N*s/m", "kg/s"),
        ("V*s", "Wb"),
        ("C/m", "N/V"),
        ("W/K", "J/s/K"),
        ("ohm", "V/A"),
        ("F", "C/V"),
        ("Wb/A", "H"),
        ("J/N", "m"),
        ("A*s", "C"),
        ("m/m", "1"),
        ("rad", "1"),
    ],
)
def test_equal_dimensions(one, other):
    assert parse_unit(one).dimension == parse_unit(other).dimension


@pytest.mark.parametrize(("one", "other"), [("J/K", "K/J"), ("W/K", "W/m**2/K"), ("C", "F")])
def test_different_dimensions(one, other):
    assert parse_unit(one).dimension != parse_unit(other).dimension


def test_base_units():
    assert base_units(parse_unit("V").dimension) == "kg*m**2/s**3/A"
    assert base_units(parse_unit("1/s").dimension) == "1/s"
    assert base_units(parse_unit("1").dimension) == "1"


@pytest.mark.parametrize(
    "text",
    [
        "m**9**9**9",
        "",
        " ",
        "m" * 61,
        "N m",
        " m",
        "m ",
        "N * m",
        "m**10",
        "m**0",
        "m**1.5",
        "m***2",
        "*m",
        "m/",
        "2*m",
        "m2",
        "%",
        "m\n",
        "m\x00",
        "__import__",
        "m.s",
        "m**-",
        "1/1/",
        "m//s",
        "(m/s",
        "m/s)**2",
        "(m**9)**2",
        "m**(1/0)",
        "m**(1/12)",
        "m**1/2)",
        "()**2",
    ],
)
def test_texts_that_are_no_units(text):
    error = refusal(parse_unit, text, "parameters.M.unit")
    assert str(error).startswith("parameters.M.unit: ")
    assert "is not a unit; expected names joined by * and /" in str(error)


@pytest.mark.parametrize(
    ("text", "answer"),
    [
        ("Ohm", "did you mean 'ohm'?"),
        ("Henry", "did you mean 'H'?"),
        ("mHenry", "did you mean 'mH'?"),
        ("uum", "did you mean 'um'?"),
        ("kOhm", "did you mean 'kohm'?"),
        ("uFarad", "did you mean 'uF'?"),
        ("Zoll", "known: m, kg"),
        ("foo", "known: "),
        ("nan", "unknown unit 'nan'"),
        ("inf", "unknown unit 'inf'"),
        ("dimensionless", "unknown unit 'dimensionless'"),
        ("None", "unknown unit 'None'"),
        ("per", "unknown unit 'per'"),
        ("squared", "unknown unit 'squared'"),
        ("dB", "is logarithmic"),
        ("Np", "is logarithmic"),
        ("Nm", "unknown unit 'Nm'; write 'N*m'"),
        ("Ns/m", "unknown unit 'Ns'; write 'N*s/m'"),
        ("J/kgK", "unknown unit 'kgK'; write 'J/(kg*K)'"),
        ("1/(Ns)", "unknown unit 'Ns'; write '1/(N*s)'"),
        ("Pas", "unknown unit 'Pas'; write 'Pa*s'"),
        ("mPas", "unknown unit 'mPas'; write 'mPa*s'"),
        ("kNm", "unknown unit 'kNm'; write 'kN*m'"),
        ("KOhm", "unknown unit 'KOhm'; write 'kohm'"),
        ("KV", "unknown unit 'KV'; write 'kV', or 'K*V'"),
        ("W/Km", "unknown unit 'Km'; write 'W/km', or 'W/(K*m)'"),
        ("amps", "unknown unit 'amps'; did you mean 'A'?"),
        ("gramm", "unknown unit 'gramm'; did you mean 'g'?"),
        ("kgramm", "unknown unit 'kgramm'; known: m, kg, "),
    ],
)
def test_words_that_are_no_units(text, answer):
    assert answer in str(refusal(parse_unit, text, "parameters.M.unit"))


def test_a_root_of_a_factor_that_is_no_exact_number_is_refused():
    error = refusal(parse_unit, "N/(mm/s)**(1/2)", "parameters.d.unit")
    assert "root of 1/1000" in error.what
    assert error.remedy == "give the value, times 31.6227766017, in N/m**(1/2)*s**(1/2)"


@pytest.mark.parametrize(
    ("value", "unit", "number", "meant", "si"),
    [
        ("4", "l/min/bar**(1/2)", "0.0126491106407", "l/min/Pa**(1/2)", 4 / 6e4 / 1e5**0.5),
        ("2.0", "kN/(mm/s)**(1/2)", "63.2455532034", "kN/m**(1/2)*s**(1/2)", 2e3 / 1e-3**0.5),
        ("2.0", "bar**(1/2)*mm**(1/2)/ms", "20", "Pa**(1/2)*m**(1/2)/ms", 2e4),
    ],
)
def test_a_unit_with_a_root_is_refused_with_what_to_write(value, unit, number, meant, si):
    message = refused_edit(('value = 3.5e-3, unit = "kg"', f'value = {value}, unit = "{unit}"'))
    assert message.startswith("spec: parameters.M.unit: ")
    assert message.endswith(f"; give {number} in {meant}")
    assert to_si(float(number), parse_unit(meant)) == pytest.approx(si, rel=1e-11)


@pytest.mark.parametrize(
    ("text", "si", "factor"),
    [
        ("psi", "Pa", Fraction("0.45359237") * Fraction("9.80665") / Fraction("0.0254") ** 2),
        ("lbf*s/inch", "N*s/m", Fraction("0.45359237") * Fraction("9.80665") / Fraction("0.0254")),
        ("bar/L", "Pa/(m**3)", Fraction(10) ** 8),
        ("kgf", "N", Fraction("9.80665")),
        ("atm", "Pa", Fraction(101_325)),
        ("rpm", "1/s", None),
    ],
)
def test_units_that_are_not_coherent_are_spelled_by_common_ones(text, si, factor):
    unit = parse_unit(text)
    assert (unit.si, parse_unit(unit.si).dimension) == (si, unit.dimension)
    assert factor in (None, unit.factor)


def test_a_rational_power_has_the_dimension_of_its_base_to_that_power():
    half = parse_unit("(m/s)**(1/2)").dimension
    assert half == tuple(power / 2 for power in parse_unit("m/s").dimension)
    assert parse_unit(base_units(half)).dimension == half


@pytest.mark.parametrize("unit", ["degC", "celsius", "degF"])
def test_units_with_an_offset_are_refused_with_the_way_to_kelvin(unit):
    message = str(refusal(parse_unit, unit, "parameters.T_0.unit"))
    assert "has an offset" in message
    assert "give the value in K" in message


@pytest.mark.parametrize(
    ("unit", "factor", "si"),
    [("W/degC", 1, "W/K"), ("1/degC", 1, "1/K"), ("J/degF", Fraction(9, 5), "J/K")],
)
def test_per_degree_is_per_kelvin(unit, factor, si):
    found = parse_unit(unit)
    assert (found.factor, found.si, found.dimension) == (factor, si, parse_unit(si).dimension)


@pytest.mark.parametrize(
    ("text", "ascii_text"),
    [("\u00b5F", "uF"), ("\u03a9", "ohm"), ("m\u00b2", "m**2"), ("N\u00b7m", "N*m")],
)
def test_what_is_beyond_ascii_is_shown_in_ascii(text, ascii_text):
    error = refusal(parse_unit, text, "parameters.M.unit")
    assert str(error).endswith(f"is not ASCII; expected a unit; write '{ascii_text}'")
    assert parse_unit(ascii_text)


@pytest.mark.parametrize(
    ("value", "unit", "kelvin"),
    [("23", "degC", "296.15"), ("-40", "degF", "233.15"), ("0.0", "celsius", "273.15")],
)
def test_a_temperature_with_an_offset_is_refused_with_its_kelvin_value(value, unit, kelvin):
    message = refused_edit(('value = 296.15, unit = "K"', f'value = {value}, unit = "{unit}"'))
    assert message.startswith("spec: parameters.T_0.unit: ")
    assert message.endswith(f"give it in K: {kelvin}")


def test_an_inputs_temperature_with_an_offset_is_refused_with_its_kelvin_value():
    message = refused_edit(('unit = "K", default = 298.15', 'unit = "degC", default = 25.0'))
    assert message.startswith("spec: inputs.T_e.unit: ")
    assert message.endswith("give it in K: 298.15")


@pytest.mark.parametrize("unit", ["Ym**9*Ym**9", "ym**9*ym**9"])
def test_values_beyond_all_numbers_are_refused(unit):
    message = refused_edit(('value = 3.5e-3, unit = "kg"', f'value = 3.5e-3, unit = "{unit}"'))
    assert message.startswith("spec: parameters.M: ")
    assert "beyond all numbers in SI" in message


def test_an_input_beyond_all_numbers_is_refused():
    message = refused_edit(
        ('F_ext = { unit = "N", default = 0.0', 'F_ext = { unit = "Ym**9", default = 1e200')
    )
    assert message.startswith("spec: inputs.F_ext: ")


def test_an_unknown_unit_is_refused_at_its_place():
    message = refused_edit(('unit = "ohm*K"', 'unit = "Ohm*K"'))
    assert message == "spec: parameters.rho.unit: unknown unit 'Ohm'; did you mean 'ohm'?"


def test_other_units_give_the_same_values():
    model = edited(
        ('value = 5e-6,   unit = "F"', 'value = 5, unit = "uF"'),
        ('value = 1e-3,   unit = "H"', 'value = 1, unit = "mH"'),
        ('value = 3.5e-3, unit = "kg"', 'value = 3.5, unit = "g"'),
    )
    assert [model.parameters[name].si for name in ("C", "L", "M")] == [5e-06, 1e-3, 3.5e-3]


@steady
@given(st.text("mskgNKVA1*/^-29 .(", max_size=12) | st.text(max_size=8))
def test_any_text_is_a_unit_or_refused(text):
    try:
        unit = parse_unit(text, "parameters.M.unit")
    except SpecError:
        refusal(parse_unit, text, "parameters.M.unit")
    else:
        assert unit.factor > 0


@steady
@given(st.text("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ", min_size=1, max_size=4))
def test_any_word_is_a_unit_or_refused(word):
    try:
        unit = parse_unit(word, "parameters.M.unit")
    except SpecError:
        refusal(parse_unit, word, "parameters.M.unit")
    else:
        assert unit.text == word


@steady
@given(st.floats(-1e6, 1e6), st.sampled_from(["uF", "kohm", "mm", "in", "h", "N/mm"]))
def test_conversion_rounds_once(value, unit):
    exact = Fraction(repr(value)) * parse_unit(unit).factor
    assert to_si(value, parse_unit(unit)) == float(exact)
