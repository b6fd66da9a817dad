"""The texts in C that are the same for every model: the files of this folder.

Input: their names.  Output: one text.
"""

from functools import cache
from pathlib import Path

#: Vectors of numbers, and the functions that a step calls on them.
VECTORS = ("real.h", "wide.h", "wide_laws.h")
#: Fixed steps of one state after another, a step at a time or through a mesh.
STEPS = ("kinds.c", "stepper.c", "tick.c", "march.c")
#: The same in lanes of vectors; behind those two, and the model's step for vectors.
LANES = ("wide.c", "fleet.c")
#: Collocation steps of runs in lanes, behind a model's own and the tables of their stages.
COLLOCATION = ("gauss.c", "trajectory.c", "crossings.c", "ticks.c", "batch.c")


@cache
def texts(*names: str) -> str:
    """Return files of this folder, one after another."""
    folder = Path(__file__).parent
    return "\n".join(folder.joinpath(name).read_text(encoding="utf-8") for name in names)
