"""What the groups of benchmarks give: rows, and what was left out; and the report of them all.

Input: `Comparison`s.  Output: `Part`, and the `Report` that holds rows and their machine.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, final

if TYPE_CHECKING:
    from piezo_sym.bench.contest import Comparison
    from tests.benchmarks.machine import Machine


@final
@dataclass(frozen=True)
class Part:
    """What a group of benchmarks gives: rows, and what was left out, each with its reason."""

    rows: tuple[Comparison, ...] = ()
    left_out: tuple[str, ...] = ()


@final
@dataclass(frozen=True)
class Report:
    """All rows of a benchmark, what was left out and why, and where it was measured."""

    model: str
    machine: Machine
    rows: tuple[Comparison, ...]
    left_out: tuple[str, ...]
