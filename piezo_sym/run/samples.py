"""Signals from samples: straight lines between (t, values).

Input: times [s] and values.  Output: a frozen `Samples`, in SI; `sample_files` makes them of files.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from math import inf
from typing import final

import numpy as np
from numpy.typing import ArrayLike

from piezo_sym.errors import UsageError
from piezo_sym.run.checks import FloatArray, increasing, vector
from piezo_sym.run.signals import MOST_CORNERS, Signal

ZERO_CELSIUS = 273.15  # [K]
SLACK = 1e-9  # of the duration: by rounding, samples may span less


@final
@dataclass(frozen=True, eq=False, repr=False)
class Samples(Signal):
    """Straight lines between samples; see `samples`.

    Of samples from a file, `unit` is the SI unit of the values by its header, `assumed` lists the
    units that the header does not give: "t in s and V in the input's SI unit", and `source` is the
    file and the column.
    """

    times: FloatArray
    values: FloatArray
    unit: str = ""
    assumed: str = ""
    source: str = ""

    def __repr__(self) -> str:
        """Return how many samples there are, over which times and values."""
        t, x = self.times, self.values
        span = f"{t.size} from {t[0]:g} s to {t[-1]:g} s"
        return (
            f"<Samples: {span}, values {x.min():g} to {x.max():g}{self.unit and f' {self.unit}'}>"
        )

    def _values(self, t: FloatArray | float) -> FloatArray:
        return np.asarray(np.interp(t, self.times, self.values))

    def knots(self, duration: float) -> FloatArray:
        """Return the times of the samples in (0, duration)."""
        return self.times[(self.times > 0) & (self.times < duration)]

    def _corners(self, duration: float) -> Iterable[float]:
        knots = self.knots(duration)
        if knots.size <= MOST_CORNERS:
            return knots
        jumps: FloatArray = knots[1:][np.nextafter(knots[:-1], inf) == knots[1:]]
        return jumps

    def max_step(self, duration: float) -> float:
        """Return the median distance of samples that are too many for breaks, else infinity."""
        knots = self.knots(duration)
        gaps = np.diff(knots)[np.nextafter(knots[:-1], inf) < knots[1:]]  # jumps take no time
        return float(np.median(gaps)) if knots.size > MOST_CORNERS else inf

    def covers(self, start: float, end: float) -> bool:
        """Return whether the samples span [start, end]."""
        slack = SLACK * (end - start)
        return bool(self.times[0] <= start + slack and self.times[-1] >= end - slack)


def samples(times: ArrayLike, values: ArrayLike) -> Samples:
    """Return the straight lines between the samples (times, values).

    Parameters
    ----------
    times : increasing [s], shape (n,), n >= 2; a time given twice is a jump.
    values : in the SI unit of the input, shape (n,).

    Raises
    ------
    UsageError : an entry is not a finite number, lengths differ, times decrease, or one is given
        three times.
    """
    return read_samples(times, values, "samples")


def read_samples(times: object, values: object, where: str) -> Samples:
    """Return `samples(times, values)`; its errors name `where`."""
    t = vector(times, f"{where}.times")
    twice = np.flatnonzero(t[:-1] == t[1:])
    if t[:2].size == 2 and t[0] == t[1]:
        what = f"the first time, {t[0]:g} s, stands twice"
        raise UsageError(what, f"{where}.times", "a value before a jump", "leave out the first row")
    for n in np.flatnonzero((t[2:] == t[1:-1]) & (t[1:-1] == t[:-2]))[:1] + 2:
        what = f"time {t[n]:g} at entry {n} follows {t[n]:g} twice"
        expected = "increasing times, or one twice for a jump between two values"
        raise UsageError(what, f"{where}.times", expected)
    t[twice] = np.nextafter(t[twice], -inf)  # a jump: from the number before this time
    t = increasing(t, f"{where}.times")
    x = vector(values, f"{where}.values")
    if t.size != x.size or t.size < 2:
        rows = f"{t.size} row{'s' * (t.size != 1)} of a time and a value", "at least two rows"
        sizes = f"{t.size} times and {x.size} values", "as many values as times"
        what, expected = rows if t.size == x.size else sizes
        raise UsageError(what, where, expected)
    return Samples(t, x)
