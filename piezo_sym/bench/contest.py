"""Things that are compared: each a call, and the error of what it computes.

Input: contestants, paired.  Output: rows with times taken in turns.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import final

from piezo_sym.bench.rows import Row, Spread
from piezo_sym.bench.timing import Times, interleaved


@final
@dataclass(frozen=True, eq=False)
class Contestant:
    """A call to be timed.

    Attributes
    ----------
    name : in the report.
    call : what is timed; it computes `per` results.
    error : of a result, where there is a measure.
    note : tolerance, time of compilation.
    """

    name: str
    call: Callable[[], object]
    per: int = 1
    error: float | None = None
    note: str = ""


@final
@dataclass(frozen=True, eq=False)
class Pair:
    """Something else, and what is ours; there may be nothing to compare with."""

    other: Contestant | None
    ours: Contestant


def compared(group: str, pairs: Sequence[Pair], rounds: int, measure: str = "") -> tuple[Row, ...]:
    """Return a row for each pair, every contestant timed in every round."""
    everyone = dict.fromkeys(c for pair in pairs for c in (pair.other, pair.ours) if c)
    times = interleaved([contestant.call for contestant in everyone], rounds)
    one = {c: per(t, c.per) for c, t in zip(everyone, times, strict=True)}
    return tuple(_row(group, pair, one, measure) for pair in pairs)


def per(times: Times, number: int) -> Times:
    """Return the times of one result."""
    return Times(tuple(seconds / number for seconds in times.seconds))


def _row(group: str, pair: Pair, times: dict[Contestant, Times], measure: str) -> Row:
    other, ours = pair.other, pair.ours
    ratio: Spread | None = times[other].over(times[ours]) if other else None
    sides = (("its", other), ("our", ours))
    notes = [f"{whose} {side.note}" for whose, side in sides if side and side.note]
    return Row(
        group=group,
        other=other.name if other else "",
        ours=ours.name,
        other_time=times[other].spread if other else None,
        ours_time=times[ours].spread,
        ratio=ratio,
        other_error=other.error if other else None,
        ours_error=ours.error,
        measure=measure,
        note="; ".join(notes),
    )
