"""A sweep as one frozen value: what runs, at which points, and how the grid is cut into boxes.

Input: what a user asked for, checked.  Output: `Plan`.  A box is a region of the grid that one task
runs, as a `Plan` of its own.  Within a box, runs with equal inputs and bank sizes form a group,
which goes through C in one call; boxes are therefore cut across the axes of inputs and sizes first.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import product
from math import prod
from typing import Any, Literal, TypeAlias, final

import numpy as np
from numpy.typing import NDArray

from piezo_sym.run.checks import FloatArray
from piezo_sym.run.collocation import FixedStep
from piezo_sym.run.parameters import LaneValue
from piezo_sym.run.signals import Signal
from piezo_sym.sweeps.axes import Axis
from piezo_sym.sweeps.targets import Target

Reduction: TypeAlias = Literal["last", "mean"] | Callable[[Any], object]
#: Where a box is in the grid: a slice for each axis.
Region: TypeAlias = tuple[slice, ...]

#: The most runs in one call of C, and by SciPy before results are kept; and the most numbers that
#: one call may return.
MOST_TOGETHER, MOST_BY_SCIPY = 512, 32
MOST_NUMBERS = 8_000_000
#: Where only reductions are kept: the most runs in a box, if at least `ENOUGH_BOXES` remain.
MOST_REDUCED = 512
ENOUGH_BOXES = 256


@final
@dataclass(frozen=True, eq=False)
class Plan:
    """What a sweep runs.

    Attributes
    ----------
    axes : in the user's order.
    signals : of each input, where it is not swept.
    parameters, initial : as the user gave them, without those swept; and one number for each
        swept parameter of a bank, since a list in the spec may not fit the swept sizes.
    samples : the sample times (nt,) [s].
    method, rtol, step : of each run; the step is None where rtol counts.
    reduce, each : the reduction, and whether its function takes one run or many.
    largest_banks : the largest size of each bank whose size is swept.
    together : the most runs in one call of C.
    most : the most runs in a box.
    engine : the `engine` attribute of the Dataset, as of `simulate`.
    side_by_side : whether runs in one call of C share vectors, or are computed one by one.
    """

    axes: tuple[Axis, ...]
    signals: tuple[Signal, ...]
    duration: float
    parameters: Mapping[str, LaneValue]
    initial: Mapping[str, LaneValue]
    samples: FloatArray
    method: str
    rtol: float
    step: FixedStep | None
    reduce: Reduction | None
    each: bool
    largest_banks: Mapping[str, int]
    together: int
    most: int
    engine: str = ""
    side_by_side: bool = True

    @property
    def dims(self) -> tuple[str, ...]:
        """The name of each axis."""
        return tuple(axis.dim for axis in self.axes)

    @property
    def shape(self) -> tuple[int, ...]:
        """The number of points along each axis."""
        return tuple(axis.size for axis in self.axes)

    @property
    def size(self) -> int:
        """The number of runs."""
        return prod(self.shape)

    @property
    def kept(self) -> slice:
        """The samples that count: all, or the last."""
        return slice(-1, None) if self.reduce == "last" else slice(None)

    @cached_property
    def box_shape(self) -> tuple[int, ...]:
        """The shape of a box; those at the edges of the grid may be smaller."""
        room, shape = self.most, list(self.shape)
        for n in reversed(sorted(range(len(shape)), key=lambda n: not self.axes[n].divides)):
            parts = -(-shape[n] // max(1, min(shape[n], room)))
            room = room // shape[n] if parts == 1 else 1
            shape[n] = -(-shape[n] // parts)  # boxes as equal as can be
        return tuple(shape)

    def regions(self) -> Iterator[Region]:
        """Yield the region of each box."""
        along = zip(self.shape, self.box_shape, strict=True)
        yield from product(
            *(
                [slice(first, min(first + part, size)) for first in range(0, size, part)]
                for size, part in along
            )
        )

    def part(self, region: Region) -> Plan:
        """Return the plan of one box, which is all that its task needs."""
        cut = zip(self.axes, region, strict=True)
        return replace(self, axes=tuple(axis.part(points) for axis, points in cut))

    @cached_property
    def points(self) -> NDArray[np.intp]:
        """The points of the grid (runs, axes), the last axis fastest."""
        return np.indices(self.shape).reshape(len(self.shape), -1).T

    def groups(self) -> Iterator[NDArray[np.intp]]:
        """Yield the numbers of the runs in each group."""
        divides = np.array([axis.divides for axis in self.axes])
        key = np.ravel_multi_index(tuple((self.points * divides).T), self.shape)
        for value in np.unique(key):
            runs = np.flatnonzero(key == value)
            for first in range(0, runs.size, self.together):
                yield runs[first : first + self.together]

    def swept(self) -> Iterator[tuple[int, Target]]:
        """Yield the number of the axis and the target, for each quantity swept."""
        for n, axis in enumerate(self.axes):
            for target in axis.targets:
                yield n, target

    def names(self) -> Iterator[str]:
        """Yield the names of the swept dimensions and their coordinates."""
        for axis in self.axes:
            yield axis.dim
            yield from (name for name, _ in axis.coordinates())


def largest_banks(axes: Iterable[Axis]) -> dict[str, int]:
    """Return the largest size of each bank whose size is swept."""
    sizes = [target for axis in axes for target in axis.targets if target.is_size]
    return {str(t.bank): max(int(v) for v in t.values) for t in sizes}  # type: ignore[arg-type]
