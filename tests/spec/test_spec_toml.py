"""Specs out and in again, and the hash that modules carry."""

import tomllib

import pytest
from hypothesis import given
from hypothesis import strategies as st
from spec_laws import steady
from spec_tools import MINIMAL, SHIPPED, edited, edited_text

from piezo_sym import Model, load
from piezo_sym.spec.load import parse
from piezo_sym.spec.source import shipped
from piezo_sym.spec.write import spec_hash

VARIANTS = {
    "shipped": SHIPPED,
    "minimal": MINIMAL,
    "a list": edited_text(("value = 1e-3,", "value = [1e-3, 2e-3],")),
    "starts": edited_text(("[initial]", '[initial]\nphi = [1, "2*L"]\nq = 1e-6')),
    "marked": edited_text(('force = "d*v"', 'force = "d*sign(v)"\ndiscontinuous = true')),
    "units": edited_text(('value = 5e-6,   unit = "F"', 'value = 5, unit = "uF"')),
    "texts": edited_text(('"moving mass"', "'quote \" back \\ \u03bb'")),
    "no rest": edited_text(('rest = "q_l"\n', "")),
    "a bank of one": edited_text(("count = 2", "count = 1")),
    "no bank": edited_text(("count = 2  ", "")),
    "no states": edited_text(('state = "q"', ""), ('state = "p"', "")),
}


@pytest.mark.parametrize("text", VARIANTS.values(), ids=VARIANTS)
def test_a_model_written_is_read_back(text):
    model = parse(text)
    again = parse(model.to_toml())
    assert again == model
    assert hash(again) == hash(model)
    assert again.sha256 == model.sha256


@pytest.mark.parametrize("text", VARIANTS.values(), ids=VARIANTS)
def test_writing_settles_at_once(text):
    written = parse(text).to_toml()
    assert parse(written).to_toml() == written


@pytest.mark.parametrize("text", VARIANTS.values(), ids=VARIANTS)
def test_the_hash_of_a_file_is_that_of_its_model(text):
    assert spec_hash(tomllib.loads(text)) == parse(text).sha256


def test_every_variant_has_a_hash_of_its_own():
    assert len({parse(text).sha256 for text in VARIANTS.values()}) == len(VARIANTS)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('default = 0.0,    doc = "supply voltage"', 'doc = "supply voltage"'),
        ('value = 10.0,   unit = "C/m"', 'value = 10, unit = "C/m"'),
        ("value = 5e5,", "value = 500000,"),
        ('rest = "q_l"', 'rest = "q_l"\n# a note'),
        ('force = "d*v"', 'force = "d*v"\ndiscontinuous = false'),
        ("[initial]", "[initial]\nq = 0"),
        ('S = "c_0*log(T_e/T_0)"', 'S = "c_0*log(T_e/T_0)"\np = 0.0'),
        ('kind = "mass"\nat = "tip"', 'at = "tip"\nkind = "mass"'),
    ],
)
def test_what_says_the_same_has_the_same_hash(old, new):
    text = edited_text((old, new))
    assert spec_hash(tomllib.loads(text)) == load("piezo_stack").sha256
    assert parse(text).sha256 == load("piezo_stack").sha256


def test_tables_left_out_and_tables_left_empty_have_one_hash():
    text = MINIMAL + "\n[inputs]\n[domain]\nassume = []\n[initial]\n"
    assert spec_hash(tomllib.loads(text)) == parse(MINIMAL).sha256
    assert parse(text).sha256 == parse(MINIMAL).sha256
    assert parse(text) == parse(MINIMAL)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('name   = "piezo_stack"', 'name   = "piezo_stick"'),
        ("value = 3.5e-3", "value = 3.6e-3"),
        ('unit = "C/m"', 'unit = "N/V"'),
        ('doc = "damping"', 'doc = "damp"'),
        ("default = 298.15", "default = 299.15"),
        ('"T > T_0"', '"T >= T_0"'),
        ('S = "c_0*log(T_e/T_0)"', "S = 1"),
        ('stiffness = "k"', 'stiffness = "2*k"'),
        ('between = ["in", "cap"]', 'between = ["cap", "in"]'),
        ("count = 2", "count = 3"),
        ('force = "d*v"', 'force = "v*d"'),
        ('state = "phi"', 'state = "psi"'),
        ("[elements.load]", "[elements.push]"),
    ],
)
def test_every_change_changes_the_hash(old, new):
    changed = edited((old, new))
    assert changed != load("piezo_stack")
    assert changed.sha256 != load("piezo_stack").sha256


def test_the_hash_is_a_sha256():
    assert len(bytes.fromhex(load("piezo_stack").sha256)) == 32


@pytest.mark.parametrize("value", ["nan", "inf", "1979-05-27", "1" + "0" * 400])
def test_hashing_needs_no_valid_spec(value):
    text = edited_text(("value = 3.5e-3", f"value = {value}"))
    assert spec_hash(tomllib.loads(text)) != load("piezo_stack").sha256


def test_the_layout_is_that_of_the_shipped_spec():
    written = load("piezo_stack").to_toml().splitlines()
    assert "[model]" in written
    assert 'M = { value = 0.0035, unit = "kg", doc = "moving mass" }' in written
    assert "[elements.spring]" in written
    assert 'between = ["tip", "wall"]' in written
    assert not [line for line in written if "discontinuous" in line]


@pytest.mark.parametrize("name", shipped())
def test_shipped_specs_are_called_by_their_file_name(name):
    assert load(name).name == name


@steady
@given(st.text(st.characters(exclude_categories=["Cs"]), max_size=40).filter(str.isprintable))
def test_any_printable_text_goes_out_and_in(title):
    data = tomllib.loads(MINIMAL)
    data["model"]["title"] = title
    model = Model(**data)
    assert parse(model.to_toml()) == model


@steady
@given(st.floats(1e-300, 1e300))
def test_any_number_goes_out_and_in(value):
    data = tomllib.loads(MINIMAL)
    data["parameters"]["m"]["value"] = value
    model = Model(**data)
    assert parse(model.to_toml()).parameters["m"].value == value
