"""NumPy: a module that says all about a model, and computes its functions of many states."""

from piezo_sym.codegen.collocation import Collocation
from piezo_sym.codegen.numpy.module import numpy_module
from piezo_sym.codegen.program import Program


def files(program: Program, step: Collocation) -> dict[str, str]:
    """Return the text of each file, by how its name ends after the model's."""
    del step  # steps are taken in C
    return {".py": numpy_module(program)}
