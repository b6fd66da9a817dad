"""Sweeps of parameters: many runs of one model.

Input: a problem.  Output: the rows of this group.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from piezo_sym.bench.rows import Part

if TYPE_CHECKING:
    from piezo_sym.bench.problem import Problem
    from piezo_sym.bench.settings import Settings


def sweep_rows(problem: Problem, settings: Settings) -> Part:
    """Return the rows of the group `sweep`."""
    del problem, settings
    return Part(left_out=("sweep: not measured yet",))
