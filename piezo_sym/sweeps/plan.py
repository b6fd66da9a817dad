"""A sweep as one frozen value: what runs, at which points, and how the grid is cut into boxes.

Input: the arguments of `sweep`.  Output: `Plan`, or a `UsageError`.  A box is a region of the grid
that one task runs, as a `Plan` of its own.  Within a box, runs with equal inputs and bank sizes
form a group, which goes through C in one call; boxes are therefore cut across the axes of inputs
and sizes first.
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

from piezo_sym.errors import PiezoError, UsageError, listing, quote
from piezo_sym.run.checks import FloatArray, calling, positive
from piezo_sym.run.collocation import METHOD, FixedStep
from piezo_sym.run.inputs import Inputs, read_inputs
from piezo_sym.run.method import checked_method, choose_method
from piezo_sym.run.module import GeneratedModule, lanes
from piezo_sym.run.parameters import (
    LaneValue,
    own_initial,
    read_initial,
    read_parameters,
    read_sizes,
    sample_times,
)
from piezo_sym.run.signals import Constant, Signal
from piezo_sym.run.simulate import read_rtol, read_step
from piezo_sym.sweeps.axes import Axis, Target, read_axes, single_numbers

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
    """What a sweep runs."""

    axes: tuple[Axis, ...]  # in the user's order
    signals: tuple[Signal, ...]  # of each input, where it is not swept
    duration: float
    #: As the user gave them, without those swept; and one number for each swept parameter of a
    #: bank, since a list in the spec may not fit the swept sizes.
    parameters: Mapping[str, LaneValue]
    initial: Mapping[str, LaneValue]
    samples: FloatArray  # their times (nt,) [s]
    method: str
    rtol: float
    step: FixedStep | None  # None where rtol counts
    reduce: Reduction | None
    each: bool  # whether a function that reduces takes one run, or many
    largest_banks: Mapping[str, int]  # of each bank whose size is swept
    together: int  # the most runs in one call of C
    most: int  # the most runs in a box
    engine: str = ""  # the attribute of the Dataset, as of `simulate`
    side_by_side: bool = True  # whether runs in one call of C share vectors

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

    def values_at(self, kind: str, points: NDArray[np.intp]) -> Iterator[dict[str, Any]]:
        """Yield the values of what is swept of a kind, but for sizes, at each point."""
        swept = [(n, t) for n, t in self.swept() if t.kind == kind and not t.is_size]
        for point in points.tolist():
            yield {target.name: target.values[point[n]] for n, target in swept}

    def inputs_at(self, module: GeneratedModule, point: NDArray[np.intp]) -> Inputs:
        """Return the inputs of the runs at a point."""
        (swept,) = self.values_at("inputs", point[None])
        named = zip(module.INPUTS, self.signals, strict=True)
        values = (swept.get(record.name, signal) for record, signal in named)
        return Inputs(
            tuple(v if isinstance(v, Signal) else Constant(float(v)) for v in values), self.duration
        )

    def base_at(self, module: GeneratedModule, point: NDArray[np.intp]) -> Any:
        """Return the parameters of the runs at a point: swept sizes, but no other swept values."""
        sizes = {t.name: int(t.values[point[n]]) for n, t in self.swept() if t.is_size}
        return read_parameters(module, {**self.parameters, **sizes})

    def names(self) -> Iterator[str]:
        """Yield the names of the swept dimensions and their coordinates."""
        for axis in self.axes:
            yield axis.dim
            yield from (name for name, _ in axis.coordinates())


def largest_banks(axes: Iterable[Axis]) -> dict[str, int]:
    """Return the largest size of each bank whose size is swept."""
    sizes = [target for axis in axes for target in axis.targets if target.is_size]
    return {str(t.bank): max(int(v) for v in t.values) for t in sizes}  # type: ignore[arg-type]


WAYS = ("run", "chunk")
REDUCTIONS = ("last", "mean")


def read_plan(
    module: GeneratedModule, over: object, runs: tuple[Any, ...], reduce: Any, reduce_by: object
) -> Plan:
    """Return what a sweep runs; without a compiler, its method is LSODA.

    `runs` is what `simulate` takes, as `sweep` lists it.
    """
    inputs, duration, rtol, step, order, parameters, initial, method, times = runs
    with calling("sweep"):
        named, bound = checked_method(method), read_rtol(rtol)
        fixed, end = read_step(step, order, named, rtol), positive(duration, "sweep.duration")
        only_end = reduce == "last" and times is step is None
        samples = sample_times(2 if only_end else times, step, end)
        signals = read_inputs(module, inputs, end)
        axes = read_axes(module, over, end, read_sizes(module, parameters))
        for target in (target for axis in axes for target in axis.targets):
            given = {"parameters": parameters, "initial": initial, "inputs": inputs}[target.kind]
            if target.name in (given or {}):
                what = f"'{target.name}' is swept and also given in '{target.kind}'"
                raise UsageError(what, "sweep.over", remedy="give it once")
        own = ({**(parameters or {}), **single_numbers(axes)}, dict(initial or {}))
        base = read_parameters(module, own[0])
        refuse_sizes(module, axes, *own, signals.segments[0].at(0.0))
        refuse_reduction(reduce, reduce_by)
        chosen = choose_method(module, named, step)
        most = MOST_TOGETHER if chosen.method == METHOD else MOST_BY_SCIPY
        numbers = samples.size * row_numbers(module, base, axes)
        together = boxes = max(1, min(most, MOST_NUMBERS // numbers))
        if reduce is not None:  # only reductions are kept; many boxes if possible
            size = prod(axis.size for axis in axes)
            boxes = max(together, min(MOST_REDUCED, size // ENOUGH_BOXES))
        how = (chosen.method, bound, fixed, reduce, reduce_by == "run", largest_banks(axes))
        sizes = (together, boxes, chosen.note)
        return Plan(axes, signals.signals, end, *own, samples, *how, *sizes)  # type: ignore[arg-type]  # reduce is checked


def refuse_sizes(
    module: GeneratedModule,
    axes: tuple[Axis, ...],
    parameters: Mapping[str, Any],
    initial: Mapping[str, Any],
    u: FloatArray,
) -> None:
    """Raise `UsageError` where a list that is not swept does not fit every size of its bank."""
    sizes = {t.name: t.values for axis in axes for t in axis.targets if t.is_size}
    one: list[dict[str, Any]] = [{name: n} for name, v in sizes.items() for n in dict.fromkeys(v)]
    for change in one or [{}]:
        found = read_parameters(module, {**parameters, **change})
        try:
            own_initial(module, found, u)
        except PiezoError:  # a swept value may replace what is wrong; each run is checked
            continue
        read_initial(module, found, u, initial)


def refuse_reduction(reduce: object, reduce_by: object) -> None:
    """Raise `UsageError` if there is no such reduction."""
    if not (reduce is None or reduce in REDUCTIONS or callable(reduce)):
        expected = f"{listing(map(repr, REDUCTIONS))}, or a function of a Dataset"
        raise UsageError(f"{quote(reduce)} is no reduction", "sweep.reduce", expected)
    if reduce_by not in WAYS:
        what = f"{quote(reduce_by)} is not known"
        raise UsageError(what, "sweep.reduce_by", listing(map(repr, WAYS)))


def row_numbers(module: GeneratedModule, base: Any, axes: tuple[Axis, ...]) -> int:
    """Return about how many numbers a run yields at each sample, at the largest sizes."""
    sizes = {bank: lanes(base, bank) for bank in module.BANKS} | largest_banks(axes)
    count: dict[str | None, int] = {None: 1}
    count.update(sizes)
    states: int = sum(count[record.bank] for record in module.STATES)
    processes: int = sum(count[record.bank] for record in module.PROCESSES)
    return 4 * states + 4 * processes + 4 * len(module.OUTPUTS) + 8
