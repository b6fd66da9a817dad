"""The JSON Schema of specs: it takes what `load` takes, and refuses what no field can be."""

import ast
import copy
import re
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator
from pydantic import ValidationError
from spec_tools import edited_text
from test_spec_toml import VARIANTS

from piezo_sym.errors import SpecError
from piezo_sym.spec.elements import KINDS
from piezo_sym.spec.elements.marks import Letters, Refers
from piezo_sym.spec.fields import Tables
from piezo_sym.spec.load import STARTER, parse
from piezo_sym.spec.schema import schema
from piezo_sym.spec.source import MODELS, data

ROOT = Path(__file__).parents[2]
SCHEMA = schema()
CHECK = Draft202012Validator(SCHEMA)


def faults(spec):
    return [error.message for error in CHECK.iter_errors(spec)]


def literals():
    """Yield the spec texts that stand in the tests and in the README."""
    for path in sorted((ROOT / "tests").rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Constant) and isinstance(node.value, str):
                yield node.value
    for path in ROOT.glob("*.md"):
        yield from re.findall(r"```toml\n(.*?)```", path.read_text(encoding="utf-8"), re.DOTALL)


def loaded(text):
    try:
        return parse(text)
    except SpecError:
        return None


FILES = [*MODELS.glob("*.toml"), STARTER, *sorted((ROOT / "tests").rglob("*.toml"))]


def sample(kind):
    """Return an element with every key that its kind needs, and the first of its inverse laws."""
    fields = {"kind": kind}
    for name, info in KINDS[kind].model_fields.items():
        pair = "tuple" in str(info.annotation)
        if info.is_required() or name in KINDS[kind].form.one_of[:1]:
            fields[name] = ["a", "b"] if pair else "body"
    if kind == "storage":
        fields["states"] = {"q": {"rate": "force", "between": ["a", "b"]}}
    return fields


ELEMENTS = {kind: sample(kind) for kind in KINDS}


def test_the_schema_is_one():
    Draft202012Validator.check_schema(SCHEMA)
    assert SCHEMA["$schema"] == Draft202012Validator.META_SCHEMA["$id"]
    assert schema() == SCHEMA


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_spec_files_of_this_repository_pass(path):
    assert faults(data(path.read_text(encoding="utf-8"))) == []


def test_specs_of_tests_and_documents_pass():
    texts = [text for text in literals() if "[elements" in text and loaded(text)]
    assert len(texts) >= 4
    assert [faults(data(text)) for text in texts] == [[]] * len(texts)


@pytest.mark.parametrize("text", VARIANTS.values(), ids=VARIANTS)
def test_every_way_to_write_a_spec_passes(text):
    assert faults(data(text)) == []
    assert faults(data(parse(text).to_toml())) == []


WRONG = {
    "a key of an element": ('stiffness = "k"', 'stiffness = "k"\nstifness = "k"', "'stifness' was"),
    "a key of a parameter": ('unit = "kg",', 'unit = "kg", units = "kg",', "'units' was"),
    "a key of the header": ("title  =", "titel =", "'titel' was"),
    "a table": ("[domain]", "[domian]", "'domian' was"),
    "a kind": ('kind = "spring"', 'kind = "sprin"', "'sprin' is not one of ['spring', 'mass', "),
    "no kind": ('kind = "spring"', "", "'kind' is a required property"),
    "no law": ('mass = "M"', "", "is not valid under any of the given schemas"),
    "no unit": ('unit = "kg", ', "", "'unit' is a required property"),
    "no inverse law": ('force = "d*v"', "", "is not valid under any of the given schemas"),
    "both laws": ('force = "d*v"', 'force = "d*v"\nvelocity = "f/d"', "is valid under each of"),
    "a number for a law": ('mass = "M"', "mass = 3", "3 is not of type 'string'"),
    "a text for a number": ("value = 3.5e-3", 'value = "3.5"', "'3.5' is not of type"),
    "one node of two": ('between = ["in", "cap"]', 'between = ["in"]', "['in'] is too short"),
    "no label": ('at = "tip"\nmass', 'at = "t i p"\nmass', "'t i p' does not match"),
    "no lanes": ("count = 2", "count = 0", "0 is less than the minimum of 1"),
    "a name": ('"piezo_stack"', '"../piezo_stack"', "'../piezo_stack' does not match"),
}


@pytest.mark.parametrize(("old", "new", "message"), WRONG.values(), ids=WRONG)
def test_a_wrong_spec_is_told_what_is_wrong(old, new, message):
    wrong = edited_text((old, new))
    assert loaded(wrong) is None
    assert [fault for fault in faults(data(wrong)) if message in fault]


def test_each_kind_is_described_by_its_docstring():
    for kind in KINDS.values():
        first = kind.__doc__.strip().splitlines()[0]
        assert SCHEMA["$defs"][kind.__name__]["description"].startswith(first)


def test_every_key_is_described():
    for name, definition in {"spec": SCHEMA, **SCHEMA["$defs"]}.items():
        for key, field in definition["properties"].items():
            described = "description" in field or "$ref" in field or "enum" in field
            assert described or "description" in field["items"], f"{name}.{key}"


def test_a_law_names_its_letters_and_a_reference_what_it_names():
    for kind in KINDS.values():
        fields = SCHEMA["$defs"][kind.__name__]["properties"]
        for field, info in kind.model_fields.items():
            laws = [mark for mark in info.metadata if isinstance(mark, Letters)]
            words = [mark.to for mark in info.metadata if isinstance(mark, Refers)]
            words += [f"in {law.unit}" for law in laws]
            words += [f"{name} [{unit}]" for law in laws for name, unit in law.units.items()]
            assert [w for w in words if w not in fields[field]["description"]] == []


OTHER = [1, -1, 0, 1.5, 1e301, True, "text", "two words", [], ["a", "b"], [1.5], ["a", 2], {}]


def places(node, path=()):
    """Yield the path of everything in some data but its root."""
    items = node.items() if isinstance(node, dict) else enumerate(node)
    for key, value in items:
        yield (*path, key)
        if isinstance(value, dict | list):
            yield from places(value, (*path, key))


def changed(spec, path, change):
    """Return data with one place left out, renamed or given another value."""
    spec = copy.deepcopy(spec)
    home = spec
    for key in path[:-1]:
        home = home[key]
    key, value = path[-1], home[path[-1]]
    if change == "leave out":
        del home[key]
    elif change == "rename" and isinstance(home, dict):
        del home[key]
        home[f"{key}x"] = value
    elif change != "rename":
        home[key] = change
    return spec


BASES = [data(STARTER.read_text(encoding="utf-8"))]
BASES += [{"model": {"name": "m"}, "elements": {kind: fields}} for kind, fields in ELEMENTS.items()]
PLACES = [(base, path) for base in BASES for path in places(base) if path != ("model", "name")]


def fields_fit(spec):
    """Return whether each table is right in itself; what holds between tables is left out."""
    try:
        Tables(**spec)
    except ValidationError:
        return False
    return True


@pytest.mark.parametrize("kind", KINDS)
def test_the_sample_of_each_kind_is_right(kind):
    spec = {"model": {"name": "m"}, "elements": {kind: ELEMENTS[kind]}}
    assert fields_fit(spec)
    assert faults(spec) == []


@pytest.mark.some(1)
@pytest.mark.parametrize("change", ["leave out", "rename", *OTHER], ids=str)
def test_a_change_is_taken_exactly_if_the_fields_take_it(change):
    """All places of all bases: the schema and pydantic are two readings of the same fields."""
    for base, path in PLACES:
        spec = changed(base, path, change)
        assert fields_fit(spec) == CHECK.is_valid(spec), path
