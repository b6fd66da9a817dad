"""The texts in C that are the same for every model: the files of this folder.

Input: their names.  Output: one text.
"""

from functools import cache
from pathlib import Path

#: Vectors of numbers, and the functions that a step calls on them.
VECTORS = ("wide.h", "wide_laws.h")
#: Steps of one state after another: runs, a step at a time, and runs through intervals.
STEPS = ("kinds.c", "stepper.c", "tick.c", "paths.c")
#: The same in lanes of vectors; behind those two, and the model's step for vectors.
LANES = ("wide.c", "seats.c", "fleet.c")


@cache
def texts(*names: str) -> str:
    """Return files of this folder, one after another."""
    folder = Path(__file__).parent
    return "\n".join(folder.joinpath(name).read_text(encoding="utf-8") for name in names)
