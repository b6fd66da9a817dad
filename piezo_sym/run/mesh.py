"""The intervals that a run steps through, in blocks, and the inputs at the middles of their steps.

Input: a `System`, the sample times (nt,), the longest interval.  Output: `Block` records, made one
at a time, so that memory does not grow with the steps.  Intervals end at samples and at breaks of
inputs.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from piezo_sym.errors import RunError
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.inputs import Segment
from piezo_sym.run.system import System

#: A run of more intervals would take days, and lengths below round-off.
MOST_INTERVALS = 1e12


@final
@dataclass(frozen=True)
class Block:
    """Some intervals of one segment, one after another.

    Attributes
    ----------
    segment : the inputs in it.
    starts, lengths : of each interval [s], (k,).
    samples : of each interval, which sample time is its end; -1 for none.
    """

    segment: Segment
    starts: FloatArray
    lengths: FloatArray
    samples: NDArray[np.int_]

    def __len__(self) -> int:
        """Return the number of intervals."""
        return self.starts.size

    def middles(self) -> FloatArray:
        """Return the inputs at the middles of the intervals, (k, m)."""
        return np.ascontiguousarray(self.segment.over(self.starts + 0.5 * self.lengths).T)

    def quarters(self) -> FloatArray:
        """Return the inputs at the middles of the quarters of the first interval, (4, m)."""
        times = self.starts[0] + self.lengths[0] * (np.arange(4) + 0.5) / 4
        return np.ascontiguousarray(self.segment.over(times).T)


def blocks(
    system: System, times: FloatArray, longest: float, size: Callable[[], int]
) -> Iterator[Block]:
    """Yield the intervals of a run, in order.

    Parameters
    ----------
    longest : no interval is longer [s].
    size : asked before each block: how many intervals it may have.

    Raises
    ------
    RunError : there would be more intervals than any run can have.
    """
    duration = system.inputs.duration
    if not duration / longest <= MOST_INTERVALS:
        what = f"a run of {duration:g} s would take steps of {longest:g} s, over 10^12 of them"
        remedy = "a longer step, a shorter run, or slower inputs"
        raise RunError(what, f"model '{system.module.NAME}'", remedy=remedy)
    for segment in system.inputs.segments:
        inner = times[(times > segment.start) & (times < segment.stop)]
        edges = np.array([segment.start, *inner, segment.stop])
        samples = np.searchsorted(times, edges[1:])
        hit = samples < times.size
        hit[hit] = times[samples[hit]] == edges[1:][hit]
        samples = np.where(hit, samples, -1)
        widths = np.diff(edges)
        rounding = 4 * np.finfo(float).eps * segment.stop / longest
        counts = np.maximum(1, np.ceil(widths / longest - rounding)).astype(int)
        ends = np.cumsum(counts)
        first = 0
        while first < ends[-1]:
            place = np.arange(first, min(first + size(), ends[-1]))
            stretch = np.searchsorted(ends, place, side="right")
            local = place - (ends - counts)[stretch]
            lengths = (widths / counts)[stretch]
            starts = edges[stretch] + local * lengths
            last = local == counts[stretch] - 1
            yield Block(segment, starts, lengths, np.where(last, samples[stretch], -1))
            first += place.size


def inputs_at(system: System, times: FloatArray) -> FloatArray:
    """Return the inputs at samples (m, nt): at a jump those after it, at the end those before."""
    segments = system.inputs.segments
    starts = np.array([segment.start for segment in segments])
    place = np.maximum(np.searchsorted(starts, times, side="right") - 1, 0)
    found = np.empty((len(system.module.INPUTS), times.size))
    for n in np.unique(place):
        found[:, place == n] = segments[n].over(times[place == n])
    return found
