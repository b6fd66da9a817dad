"""Large functions are printed in parts; the row `program` covers these, and how they are called."""

import re

import numpy as np
import pytest

from piezo_sym import codegen, derive, layered, load
from piezo_sym.codegen import collocation_of, lower
from piezo_sym.codegen.c.lines import Write
from piezo_sym.codegen.c.parts import in_parts
from piezo_sym.codegen.program import Described, Quantity
from piezo_sym.expressions.tree import Sym
from piezo_sym.module_cache import write_module
from piezo_sym.run.engine.engine import engine_of
from piezo_sym.spec.load import parse
from piezo_sym.translation.program import Reference, different
from tests.benchmarks.test_chain import chain
from tests.translation.printed import printed

PARTS = re.compile(r"^static void (\w+_part_\d+)\(", re.MULTILINE)
CALL = "    layered_stack_jacobian_part_2(x, u, p, out);\n"
FIRST = "    layered_stack_jacobian_part_1(x, u, p, out);\n"


@pytest.fixture(scope="module")
def stack():
    iphs = derive(layered(24))
    return printed(iphs), Reference(iphs)


def verdicts(stack, language, text):
    return [row.verdict for row in different(language, text, stack[1])]


@pytest.mark.some(1)
def test_parts_are_proved_together_and_called_once_each(stack):
    texts = stack[0]
    assert {language: verdicts(stack, language, texts[language]) for language in ("C", "step")} == {
        "C": [],
        "step": [],
    }
    for language, names in (("C", {"jacobian", "elements"}), ("step", {"slopes"})):
        found = PARTS.findall(texts[language])
        assert {re.sub(r"layered_stack_|_part_\d+", "", part) for part in found} == names
        assert [texts[language].count(f"    {part}(x") for part in found] == [1] * len(found)


def test_small_functions_are_printed_whole(stack):
    assert not PARTS.search(printed(derive(parse(chain(3))))["C"])
    inner = re.findall(r"^(?:static )?void \w+\((?:.*\n)+?}", stack[0]["C"], re.MULTILINE)
    assert max(text.count(";") for text in inner) < 1100


def test_parts_compute_what_numpy_does(stack, tmp_path):
    texts = codegen.printed(lower(stack[1].iphs, ""), collocation_of(stack[1].iphs))
    module = write_module(tmp_path, "layered_stack", texts)
    engine, rng = engine_of(module), np.random.default_rng(5)
    p, u = module.Parameters(), np.array([3.0, 80.0, 300.0])
    x = (rng.normal(size=(24, 5)) * [1e-5, 1e-2, 1e-4, 1e-4, 1e-3]).ravel()
    x[4::5] += module.initial_state(u, p)[4]
    for name in ("jacobian", "rhs"):
        ours, theirs = (getattr(of, name)(x, u, p) for of in (engine, module))
        assert np.abs(ours - theirs).max() <= 1e-12 * np.abs(theirs).max()


def test_what_cannot_be_divided_is_printed_whole():
    chained = [Quantity(f"a{n}", Sym(f"a{n - 1}"), None, "") for n in range(1, 1500)]
    writes = [Write("out[0]", Sym("a1499"))]
    assert in_parts(chained, writes, [[Described("a0", "", "", None)]]) == ([], writes)


MUTANTS = {
    "a part left out": (CALL, ""),
    "a part called twice": (CALL, 2 * CALL),
    "another part twice": (CALL, FIRST),
    "arguments exchanged": (CALL, CALL.replace("x, u", "u, x")),
    "another argument": (CALL, CALL.replace("u,", "x,")),
    "an argument too few": (CALL, CALL.replace("u, ", "")),
    "a call in a block": (CALL, f"    {{\n    {CALL}    }}\n"),
    "a call of no part": (CALL, CALL.replace("part_2", "part_200")),
    "a call of the function itself": (CALL, CALL.replace("_part_2", "")),
    "parts before the zeros": (
        re.compile(
            r"(    for \(long j = 0; j < n\*n; \+\+j\) \{\n.*\n    \}\n)((?:    layered.*\n)+)"
        ),
        r"\2\1",
    ),
    "a part that calls a part": (
        re.compile(r"(_jacobian_part_2\([^{]*\{\n)"),
        rf"\1{FIRST}",
    ),
    "a part of other arguments": (
        re.compile(
            r"(_jacobian_part_2\(const double \*restrict) x,(\s+const double \*restrict) u,"
        ),
        r"\1 u,\2 x,",
    ),
    "a call with a type": (CALL, CALL.replace("(x", "((void)x")),
    "a part that is not called": (CALL, f"{CALL}    (void)x;\n".replace("part_2", "part_1")),
    "a part of another name": (
        re.compile(r"static void layered_stack_jacobian_part_2\("),
        "static void layered_stack_other(",
    ),
}


@pytest.mark.some(3)
@pytest.mark.parametrize("mutant", MUTANTS)
def test_a_wrong_call_of_a_part_is_not_proved(stack, mutant):
    old, new = MUTANTS[mutant]
    text = stack[0]["C"]
    changed = text.replace(old, new, 1) if isinstance(old, str) else old.sub(new, text, count=1)
    assert changed != text
    assert verdicts(stack, "C", changed)


def test_a_wrong_row_in_a_part_is_not_proved(stack):
    text, wrong = stack[0]["C"], "out[51*n + 57] = alpha_transducer_12/C;"
    assert text.count(wrong.replace("= ", "= -")) == 1
    assert verdicts(stack, "C", text.replace(wrong.replace("= ", "= -"), wrong))


RETURN = "    return k*power_2(q)/2.0 + power_2(p)/(2.0*m) + T_0*c*exp(S/c);"
HEAD = "double oscillator_energy("


def test_a_function_of_one_number_has_no_parts():
    """What it returns would be that of a part, which returns nothing to it."""
    iphs = derive(load("oscillator"))
    text = printed(iphs)["C"]
    start, end = text.index(HEAD), text.index(RETURN) + len(RETURN) + 3
    whole = text[start:end]
    arguments = whole[len(HEAD) : whole.index(")")]
    names = ", ".join(argument.split()[-1].removeprefix("*") for argument in arguments.split(","))
    part = whole.replace(HEAD, "static void oscillator_energy_part_1(")
    call = f"{HEAD}{arguments})\n{{\n    oscillator_energy_part_1({names});\n}}\n"
    assert not different("C", text, Reference(iphs))
    assert different("C", f"{text[:start]}{part}\n{call}{text[end:]}", Reference(iphs))


def test_a_model_may_be_called_like_a_part():
    for name in ("spare_part_list", "x_part_1"):
        iphs = derive(parse(chain(1).replace('name = "chain"', f'name = "{name}"')))
        assert iphs.model.name == name
        texts = printed(iphs)
        assert not [row for key in texts for row in different(key, texts[key], Reference(iphs))]
