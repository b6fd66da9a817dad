"""Code generation: IPHS to program, program to text."""

from collections.abc import Callable, Mapping
from typing import TypeAlias

from piezo_sym.codegen.c.head import c_header
from piezo_sym.codegen.c.module import c_source
from piezo_sym.codegen.c.step import c_step
from piezo_sym.codegen.c.step_header import c_step_header
from piezo_sym.codegen.collocation import Collocation, collocation_of
from piezo_sym.codegen.lower import lower
from piezo_sym.codegen.numpy.module import numpy_module
from piezo_sym.codegen.program import Program, blank
from piezo_sym.codegen.quantities import quantities_of
from piezo_sym.iphs import IPHS
from piezo_sym.spec.checks.values import are_all_margins
from piezo_sym.spec.values import Template

Printer: TypeAlias = Callable[[Program, Collocation], str]
#: The printer of each file of a module, by the ending of its name after the model's.
PRINTERS: Mapping[str, Printer] = {
    ".py": lambda program, _: numpy_module(program),
    ".h": lambda program, _: c_header(program),
    ".c": lambda program, _: c_source(program),
    "_step.h": c_step_header,
    "_step.c": c_step,
}


def printed(program: Program, step: Collocation) -> dict[str, str]:
    """Return the text of each file of a module, by the ending of its name after the model's."""
    return {ending: write(program, step) for ending, write in PRINTERS.items()}


def template_of(iphs: IPHS) -> Template:
    """Return the texts that are proved and written for a system, whatever its values are."""
    q = quantities_of(iphs)
    texts = printed(blank(lower(iphs, "", q)), collocation_of(iphs, q))
    tables = iphs.model.parameters, iphs.model.inputs
    factors = {n: str(entry.dimension.factor) for table in tables for n, entry in table.items()}
    joined = bool(iphs.junction.joints)
    return Template(texts, factors, not joined and are_all_margins(iphs.model), joined)


__all__ = ["PRINTERS", "collocation_of", "lower", "numpy_module", "printed", "template_of"]
