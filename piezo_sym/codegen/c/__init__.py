"""C99: a module's functions, and the step that `run/engine` drives."""

from piezo_sym.codegen.c.head import c_header
from piezo_sym.codegen.c.module import c_source
from piezo_sym.codegen.c.step import c_step
from piezo_sym.codegen.c.step_header import c_step_header
from piezo_sym.codegen.collocation import Collocation
from piezo_sym.codegen.program import Program


def files(program: Program, step: Collocation) -> dict[str, str]:
    """Return the text of each file, by how its name ends after the model's."""
    return {
        ".h": c_header(program),
        ".c": c_source(program),
        "_step.h": c_step_header(program, step),
        "_step.c": c_step(program, step),
    }
