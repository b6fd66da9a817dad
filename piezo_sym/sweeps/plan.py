"""A sweep as one frozen value: what runs, at which points, and how the grid is cut into boxes.

Input: what a user asked for, checked.  Output: `Plan` and its `Box` records.  A box is a part of
the grid that one task runs; axes that runs in one call of C cannot differ along come first, so that
a box holds as many equal ones as it can.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from math import prod
from typing import Any, Literal, TypeAlias, final

import numpy as np
from numpy.typing import NDArray

from piezo_sym.run.checks import FloatArray
from piezo_sym.run.discrete import FixedStep
from piezo_sym.run.parameters import LaneValue
from piezo_sym.run.signals import Signal
from piezo_sym.sweeps.axes import Axis
from piezo_sym.sweeps.targets import Target

Reduction: TypeAlias = Literal["last", "mean"] | Callable[[Any], object]

#: Runs that go through C in one call, at most, or one by one through SciPy before they are kept;
#: numbers that they leave there.
MOST_TOGETHER, MOST_BY_SCIPY = 512, 32
MOST_NUMBERS = 8_000_000
#: Boxes hold up to so many runs where only reductions are kept, if so many boxes remain.
MOST_REDUCED = 512
ENOUGH_BOXES = 256


@final
@dataclass(frozen=True)
class Box:
    """A part of the grid.

    Attributes
    ----------
    number : its place in the order of boxes.
    start, shape : along each axis of `Plan.order`.
    """

    number: int
    start: tuple[int, ...]
    shape: tuple[int, ...]

    def __len__(self) -> int:
        """Return the number of runs."""
        return prod(self.shape)


@final
@dataclass(frozen=True, eq=False)
class Plan:
    """What a sweep runs.

    Attributes
    ----------
    axes : in the user's order.
    signals : of each input, where it is not swept.
    parameters, initial : as the user gave them, without those swept; but one number for each
        swept parameter of a bank, for a spec's list need not fit the sizes.
    samples : the sample times (nt,) [s].
    method, rtol, step : of each run; the step is None where rtol counts.
    reduce, each : the reduction, and whether its function takes one run or many.
    largest_banks : the largest size of each bank whose size is swept.
    together : runs in one call of C, at most.
    most : runs in a box, at most.
    engine : what runs them, in words, as an attribute of `simulate` says.
    side_by_side : whether runs in one call of C go in the lanes of vectors, or one by one.
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

    def with_most(self, most: int) -> Plan:
        """Return the same sweep in boxes of other sizes."""
        return replace(self, most=most)

    @property
    def shape(self) -> tuple[int, ...]:
        """The number of points along each axis."""
        return tuple(axis.size for axis in self.axes)

    @property
    def size(self) -> int:
        """The number of runs."""
        return prod(self.shape)

    @cached_property
    def order(self) -> tuple[int, ...]:
        """The axes from the slowest to the fastest."""
        return tuple(sorted(range(len(self.axes)), key=lambda n: not self.axes[n].divides))

    @property
    def dividing(self) -> int:
        """How many of the first axes in `order` divide runs."""
        return sum(axis.divides for axis in self.axes)

    @cached_property
    def box_shape(self) -> tuple[int, ...]:
        """The shape of a box along the axes in `order`; those at the edges may be smaller."""
        room, shape = self.most, []
        for n in reversed(self.order):
            size = self.axes[n].size
            parts = -(-size // max(1, min(size, room)))
            shape.append(-(-size // parts))  # boxes as equal as can be
            room = room // size if parts == 1 else 1
        return tuple(reversed(shape))

    @property
    def boxes_along(self) -> tuple[int, ...]:
        """The number of boxes along each axis in `order`."""
        sizes = (self.axes[n].size for n in self.order)
        return tuple(-(-size // part) for size, part in zip(sizes, self.box_shape, strict=True))

    def boxes(self) -> Iterator[Box]:
        """Yield all boxes."""
        for number, place in enumerate(np.ndindex(*self.boxes_along)):
            start = tuple(k * part for k, part in zip(place, self.box_shape, strict=True))
            sizes = (self.axes[n].size for n in self.order)
            ends = zip(sizes, start, self.box_shape, strict=True)
            shape = tuple(min(size - first, part) for size, first, part in ends)
            yield Box(number, start, shape)

    def points(self, box: Box) -> NDArray[np.intp]:
        """Return the points of a box's runs, a row each, a column an axis in the user's order."""
        grid = np.indices(box.shape).reshape(len(box.shape), -1) + np.array(box.start)[:, None]
        found: NDArray[np.intp] = np.empty_like(grid.T)
        found[:, list(self.order)] = grid.T
        return found

    def region(self, box: Box) -> tuple[slice, ...]:
        """Return where a box is in an array over the axes in the user's order."""
        spans = zip(self.order, box.start, box.shape, strict=True)
        where = {n: slice(first, first + size) for n, first, size in spans}
        return tuple(where[n] for n in range(len(self.axes)))

    def arranged(self, box: Box, values: NDArray[Any]) -> NDArray[Any]:
        """Return values (runs, ...) of a box as an array over the axes in the user's order."""
        grid = values.reshape(*box.shape, *values.shape[1:])
        count = len(box.shape)
        order = [self.order.index(n) for n in range(count)]
        found: NDArray[Any] = grid.transpose(*order, *range(count, grid.ndim))
        return found

    def swept(self) -> Iterator[tuple[int, Target]]:
        """Yield each quantity swept, after the number of its axis."""
        for n, axis in enumerate(self.axes):
            for target in axis.targets:
                yield n, target

    def names(self) -> Iterator[str]:
        """Yield the names of the swept dimensions and their coordinates."""
        for axis in self.axes:
            yield axis.dim
            yield from (name for name, _ in axis.coordinates())

    def part(self, box: Box) -> tuple[Plan, Box]:
        """Return the plan of a box alone, and that box in it: all that its task has to know."""
        cut = zip(self.axes, self.region(box), strict=True)
        axes = tuple(axis.part(points) for axis, points in cut)
        alone = replace(self, axes=axes, most=len(box))
        return alone, Box(box.number, (0,) * len(box.shape), box.shape)


def largest_banks(axes: Iterable[Axis]) -> dict[str, int]:
    """Return the largest size of each bank whose size is swept."""
    sizes = [target for axis in axes for target in axis.targets if target.is_size]
    return {str(t.bank): max(int(v) for v in t.values) for t in sizes}  # type: ignore[arg-type]
