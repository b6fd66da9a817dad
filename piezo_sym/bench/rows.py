"""What a benchmark is: two times measured in turns, their ratio, and the error of each.

Input: medians with quartiles.  Output: `Row`, and the `Report` that holds rows and their machine.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, final

if TYPE_CHECKING:
    from piezo_sym.bench.machine import Machine


@final
@dataclass(frozen=True)
class Spread:
    """A median with its quartiles."""

    median: float
    low: float
    high: float


@final
@dataclass(frozen=True)
class Row:
    """One benchmark: this package against something else that does the same.

    Attributes
    ----------
    group : which part of the benchmark it belongs to.
    other, ours : what is compared, in words.
    other_time, ours_time : seconds, of one call each; `other_time` is absent where there is
        nothing to compare with.
    ratio : of the times, measured in turns: above 1, ours is faster.
    other_error, ours_error : in units of the scale that `measure` names; absent without one.
    measure : what the errors are.
    note : what one has to know: tolerances, time of compilation.
    """

    group: str
    other: str
    ours: str
    other_time: Spread | None
    ours_time: Spread
    ratio: Spread | None
    other_error: float | None = None
    ours_error: float | None = None
    measure: str = ""
    note: str = ""


@final
@dataclass(frozen=True)
class Part:
    """What a group of benchmarks gives: rows, and what was left out, each with its reason."""

    rows: tuple[Row, ...] = ()
    left_out: tuple[str, ...] = ()


@final
@dataclass(frozen=True)
class Report:
    """All rows of a benchmark, what was left out and why, and where it was measured."""

    model: str
    machine: Machine
    rows: tuple[Row, ...]
    left_out: tuple[str, ...]
