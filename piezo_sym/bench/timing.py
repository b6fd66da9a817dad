"""Times of calls, measured in turns so that all are exposed to the same noise.

Input: calls without arguments.  Output: one `Times` per call; medians with quartiles, and ratios
of times measured in the same round.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from time import perf_counter
from typing import final

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


@final
@dataclass(frozen=True)
class Times:
    """Seconds per call, one for each round in which it was measured."""

    seconds: tuple[float, ...]

    @property
    def spread(self) -> Spread:
        """The median with its quartiles."""
        return spread(self.seconds)

    def over(self, other: Times) -> Spread:
        """Return the ratio of these times to another call's, round by round."""
        return spread([a / b for a, b in zip(self.seconds, other.seconds, strict=False)])


def spread(values: Sequence[float]) -> Spread:
    """Return the median of values with its quartiles."""
    low, median, high = np.quantile(values, [0.25, 0.5, 0.75])
    return Spread(float(median), float(low), float(high))


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
    return tuple(Times(tuple(times)) for times in found)


def _seconds(call: Callable[[], object], number: int) -> float:
    start = perf_counter()
    for _ in range(number):
        call()
    return (perf_counter() - start) / number


def _number(call: Callable[[], object], once: float) -> int:
    """Return the calls per measurement; a short one is timed again, for the first may be slow."""
    again = _seconds(call, 1) if once < SHORTEST else once
    return max(1, int(np.ceil(SHORTEST / max(again, 1e-9))))
