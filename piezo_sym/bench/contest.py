"""Comparisons: pairs of calls, timed in turns so that noise affects all of them equally.

Input: pairs of contestants.  Output: `Comparison` rows, with medians, quartiles, ratios of times
from the same round, and the errors of results; and their cells as text.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from time import perf_counter
from typing import TypeAlias, final

import numpy as np

#: Least duration of a measurement [s]; short calls are repeated to reach it, behind one that is not
#: measured: the call before it, of another contestant, has left its own code and numbers in caches.
SHORTEST = 0.02
#: Total time of a call [s] after which it is not measured again.
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

    A call that has taken `patience` seconds in all is not measured again.
    """
    first = [_seconds(call, 1) for call in calls]
    numbers = [_number(call, once) for call, once in zip(calls, first, strict=True)]
    measured = [[once] if 2 * once > patience else [] for once in first]
    for _ in range(rounds):
        for call, number, times in zip(calls, numbers, measured, strict=True):
            if not times or (sum(times) + times[-1]) * number <= patience:
                if number > 1:
                    call()
                times.append(_seconds(call, number))
    return tuple(map(tuple, measured))


def _seconds(call: Callable[[], object], number: int) -> float:
    start = perf_counter()
    for _ in range(number):
        call()
    return (perf_counter() - start) / number


def _number(call: Callable[[], object], once: float) -> int:
    """Return the calls per measurement; short ones are timed again, as the first may be slow."""
    seconds = _seconds(call, 1) if once < SHORTEST else once
    return max(1, int(np.ceil(SHORTEST / max(seconds, 1e-9))))


COLUMNS = ("group", "compared with", "time", "error", "ours", "time", "error", "ratio", "quartiles")
UNITS = ((1.0, "s"), (1e-3, "ms"), (1e-6, "us"), (1e-9, "ns"))


@final
@dataclass(frozen=True, eq=False)
class Contestant:
    """A call to be timed, which computes `per` results."""

    name: str
    call: Callable[[], object]
    per: int = 1
    error: float | None = None  # of a result, None if there is no measure
    note: str = ""  # tolerance, time of compilation


@final
@dataclass(frozen=True, eq=False)
class Pair:
    """A contestant of this package, and another one or None."""

    other: Contestant | None
    ours: Contestant


@final
@dataclass(frozen=True)
class Comparison:
    """A row: a contestant of this package compared with another, or alone."""

    group: str
    other: str
    ours: str
    other_time: Spread | None  # seconds per result
    ours_time: Spread
    ratio: Spread | None  # of times measured in turns: above 1, ours is faster
    other_error: float | None = None  # as defined by `measure`
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
    contestants = dict.fromkeys(c for pair in pairs for c in (pair.other, pair.ours) if c)
    timed = zip(contestants, interleaved([c.call for c in contestants], rounds), strict=True)
    times = {c: tuple(seconds / c.per for seconds in measured) for c, measured in timed}
    return tuple(_row(group, pair, times, measure) for pair in pairs)


def _row(group: str, pair: Pair, times: dict[Contestant, Times], measure: str) -> Comparison:
    other, ours = pair.other, pair.ours
    sides = (("its", other), ("our", ours))
    note = "; ".join(f"{whose} {side.note}" for whose, side in sides if side and side.note)
    return Comparison(
        group,
        other=other.name if other else "",
        ours=ours.name,
        other_time=spread(times[other]) if other else None,
        ours_time=spread(times[ours]),
        ratio=ratio(times[other], times[ours]) if other else None,
        other_error=other.error if other else None,
        ours_error=ours.error,
        measure=measure,
        note=note,
    )


def _duration(spread: Spread | None) -> str:
    if spread is None:
        return "-"
    size, unit = next((pair for pair in UNITS if spread.median >= pair[0]), UNITS[-1])
    return f"{spread.median / size:.3g} {unit}"


def _error(value: float | None) -> str:
    return "-" if value is None else f"{value:.0e}"
