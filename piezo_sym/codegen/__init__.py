"""Code generation: IPHS to program, program to text."""

from typing import Protocol

from piezo_sym.codegen import c, numpy
from piezo_sym.codegen.collocation import Collocation, collocation_of
from piezo_sym.codegen.lower import lower
from piezo_sym.codegen.numpy.module import numpy_module
from piezo_sym.codegen.program import MARK, Program


class Backend(Protocol):
    """A folder of this package that prints programs in one language."""

    def files(self, program: Program, step: Collocation) -> dict[str, str]:
        """Return the text of each file, by how its name ends after the model's."""


#: Every language that is printed.
BACKENDS: tuple[Backend, ...] = (numpy, c)


def printed(program: Program, step: Collocation) -> dict[str, str]:
    """Return the text of each file of a module, by how its name ends after the model's."""
    return {end: text for b in BACKENDS for end, text in b.files(program, step).items()}


__all__ = ["MARK", "collocation_of", "lower", "numpy_module", "printed"]
