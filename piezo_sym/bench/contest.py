"""Comparisons: pairs of calls, timed in turns so that all are exposed to the same noise.

Input: pairs of contestants.  Output: `Comparison` rows, with medians, quartiles, ratios of times
measured in the same round, and the errors of results; and their cells as text.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from time import perf_counter
from typing import TypeAlias, final

import numpy as np

#: Least duration of a measurement [s]: shorter calls are repeated within it.
SHORTEST = 0.004
#: Total time [s] after which a call is not measured again.
PATIENCE = 20.0


@final
@dataclass(frozen=True)
class Spread:
    """A median with its quartiles."""

    median: float
    low: float
    high: float


#: Seconds per call, one for each round in which it was measured.
Times: TypeAlias = tuple[float, ...]


def spread(values: Sequence[float]) -> Spread:
    """Return the median of values with its quartiles."""
    low, median, high = np.quantile(values, [0.25, 0.5, 0.75])
    return Spread(float(median), float(low), float(high))


def ratio(times: Times, others: Times) -> Spread:
    """Return the ratio of times to another call's, round by round."""
    return spread([a / b for a, b in zip(times, others, strict=False)])


def interleaved(
    calls: Sequence[Callable[[], object]], rounds: int, patience: float = PATIENCE
) -> tuple[Times, ...]:
    """Return the times of calls, measured in turns: every call once in each round.

    A call that has taken `patience` seconds in all is measured no more.
    """
    first = [_seconds(call, 1) for call in calls]
    numbers = [_number(call, once) for call, once in zip(calls, first, strict=True)]
    found = [[once] if 2 * once > patience else [] for once in first]
    for _ in range(rounds):
        for call, number, times in zip(calls, numbers, found, strict=True):
            if not times or (sum(times) + times[-1]) * number <= patience:
                times.append(_seconds(call, number))
    return tuple(map(tuple, found))


def _seconds(call: Callable[[], object], number: int) -> float:
    start = perf_counter()
    for _ in range(number):
        call()
    return (perf_counter() - start) / number


def _number(call: Callable[[], object], once: float) -> int:
    """Return the calls per measurement; a short one is timed again, for the first may be slow."""
    again = _seconds(call, 1) if once < SHORTEST else once
    return max(1, int(np.ceil(SHORTEST / max(again, 1e-9))))


COLUMNS = ("group", "compared with", "time", "error", "ours", "time", "error", "ratio", "quartiles")
UNITS = ((1.0, "s"), (1e-3, "ms"), (1e-6, "us"), (1e-9, "ns"))


@final
@dataclass(frozen=True, eq=False)
class Contestant:
    """A call to be timed, which computes `per` results."""

    name: str
    call: Callable[[], object]
    per: int = 1
    error: float | None = None  # of a result, where there is a measure
    note: str = ""  # tolerance, time of compilation


@final
@dataclass(frozen=True, eq=False)
class Pair:
    """A contestant from elsewhere, if there is one, and one of this package."""

    other: Contestant | None
    ours: Contestant


@final
@dataclass(frozen=True)
class Comparison:
    """One benchmark: this package against something else that does the same, or nothing."""

    group: str
    other: str
    ours: str
    other_time: Spread | None  # seconds per result
    ours_time: Spread
    ratio: Spread | None  # of times measured in turns: above 1, ours is faster
    other_error: float | None = None  # in units of the scale that `measure` names
    ours_error: float | None = None
    measure: str = ""
    note: str = ""

    @property
    def cells(self) -> tuple[str, ...]:
        """Its cells as text, in the order of `COLUMNS`."""
        ratio = self.ratio
        return (
            *(self.group, self.other or "-", _duration(self.other_time), _error(self.other_error)),
            *(self.ours, _duration(self.ours_time), _error(self.ours_error)),
            f"{ratio.median:.3g}" if ratio else "-",
            f"{ratio.low:.3g} - {ratio.high:.3g}" if ratio else "-",
        )


def compared(
    group: str, pairs: Sequence[Pair], rounds: int, measure: str = ""
) -> tuple[Comparison, ...]:
    """Return a row for each pair, every contestant timed in every round."""
    everyone = dict.fromkeys(c for pair in pairs for c in (pair.other, pair.ours) if c)
    found = zip(everyone, interleaved([c.call for c in everyone], rounds), strict=True)
    times = {c: tuple(seconds / c.per for seconds in one) for c, one in found}
    return tuple(_row(group, pair, times, measure) for pair in pairs)


def _row(group: str, pair: Pair, times: dict[Contestant, Times], measure: str) -> Comparison:
    other, ours = pair.other, pair.ours
    sides = (("its", other), ("our", ours))
    note = "; ".join(f"{whose} {side.note}" for whose, side in sides if side and side.note)
    own = spread(times[ours])
    if other is None:
        return Comparison(group, "", ours.name, None, own, None, None, ours.error, measure, note)
    found = group, other.name, ours.name, spread(times[other]), own
    rounds = ratio(times[other], times[ours])
    return Comparison(*found, rounds, other.error, ours.error, measure, note)


def _duration(spread: Spread | None) -> str:
    if spread is None:
        return "-"
    size, unit = next((pair for pair in UNITS if spread.median >= pair[0]), UNITS[-1])
    return f"{spread.median / size:.3g} {unit}"


def _error(value: float | None) -> str:
    return "-" if value is None else f"{value:.0e}"
