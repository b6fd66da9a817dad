"""What is printed of a system, by the name that the row `program` gives to the text."""

import re

from piezo_sym import codegen
from piezo_sym.codegen import collocation_of, lower
from piezo_sym.codegen.c.style import REALS
from piezo_sym.translation import program_row
from piezo_sym.translation.program import READ

TEXTS = tuple(READ.values())
CALLED = tuple(name.removesuffix("_of") for name in REALS.values())
LINES = "".join(f"#define {name}_of {name}\n" for name in CALLED)


def printed(iphs, program=None):
    """Return each text of a system; the first two of another program, if there is one."""
    step = collocation_of(iphs)
    texts = codegen.printed(program or lower(iphs, ""), step)
    texts["_step.c"] = with_functions(codegen.printed(lower(iphs, ""), step)["_step.c"])
    return {language: texts[ending] for ending, language in READ.items()}


def with_functions(step):
    """Return a step that names every function of C, so that its mutants may call them."""
    step = re.sub(r"#define (\w+)_of \1\n", "", step)
    return step.replace("#define is_above", f"{LINES}#define is_above", 1)


def rows(iphs, texts):
    """Return the rows `program` of a system and texts, by the names of `printed`."""
    return (program_row(iphs, {end: texts[language] for end, language in READ.items()}),)
