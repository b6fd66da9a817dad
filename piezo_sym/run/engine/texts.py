"""The texts in C that are the same for every model: the files of this folder.

Input: their names.  Output: one text.
"""

from functools import cache
from pathlib import Path

#: Collocation steps of runs in lanes, behind a model's own and the tables of their stages.
COLLOCATION = (
    *("newton.c", "nodes.c", "trajectory.c", "error.c", "crossings.c", "replay.c"),
    *("samples.c", "outcome.c", "ticks.c", "batch.c", "tick.c"),
)


@cache
def texts(*names: str) -> str:
    """Return files of this folder, one after another."""
    folder = Path(__file__).parent
    return "\n".join(folder.joinpath(name).read_text(encoding="utf-8") for name in names)
