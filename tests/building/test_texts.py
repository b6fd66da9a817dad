"""Texts of a spec in generated code: kept as they are, never read as code."""

import ast
from functools import cache

import pytest

from piezo_sym import Model, PiezoError, derive, load, verify
from piezo_sym.build import files_of
from piezo_sym.codegen import template_of

HOSTILE = [
    'a "quoted" word',
    "an 'apostrophe' word",
    '"""; import os; word = """',
    "'''; import os; word = '''",
    'word"',
    'word"""',
    "word\\",
    "word \\n \\N{BULLET} \\x41 \\",
    "word {0} {x!r} %s $x #",
    "f\N{LATIN SMALL LETTER U WITH DIAERESIS}r word \N{GREEK SMALL LETTER ALPHA} \U0001f600",
]


def outline(text):
    """Return the kinds of a module's statements: what code there is, whatever the strings say."""
    return [ast.dump(node)[:12] for node in ast.parse(text).body]


@cache
def report():
    """Return the verdicts, in which no title has a part."""
    return verify(derive(load("piezo_stack")))


def text_of(spec):
    model = Model(**spec)
    return files_of(model, report(), template_of(derive(model)))["piezo_stack/piezo_stack.py"]


@pytest.mark.some(1)
@pytest.mark.parametrize("words", HOSTILE)
def test_a_text_in_the_head_adds_no_code(spec, words):
    plain = outline(text_of(spec))
    spec["model"] |= {"title": words, "source": words}
    text = text_of(spec)
    assert outline(text) == plain
    assert all(line.isprintable() for line in text.splitlines())
    assert ast.get_docstring(ast.parse(text)).count("word") >= 2


@pytest.mark.some(1)
@pytest.mark.parametrize("words", HOSTILE)
def test_a_text_in_a_record_is_kept_as_it_is(spec, module_from, words):
    spec["parameters"]["M"]["doc"] = words
    spec["inputs"]["V_in"]["doc"] = words
    module = module_from(Model(**spec))
    assert module.PARAMETERS[0].doc == words
    assert module.INPUTS[1].doc == words


@pytest.mark.parametrize("words", ["two\nlines", "a\rb", "a\tb", "nul\0", "a\u2028b", "x" * 401])
@pytest.mark.parametrize("place", ["title", "source", "doc"])
def test_a_text_of_many_lines_is_refused(spec, place, words):
    (spec["parameters"]["M"] if place == "doc" else spec["model"])[place] = words
    with pytest.raises(PiezoError, match=place) as caught:
        Model(**spec)
    assert len(str(caught.value).splitlines()) == 1
