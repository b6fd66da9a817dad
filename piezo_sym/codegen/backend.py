"""What a back end is: a folder of this package that prints programs in one language."""

from __future__ import annotations

from typing import Protocol

from piezo_sym.codegen.collocation import Collocation
from piezo_sym.codegen.program import Program


class Backend(Protocol):
    """The one function that is called of a back end."""

    def files(self, program: Program, step: Collocation) -> dict[str, str]:
        """Return the text of each file, by how its name ends after the model's."""
