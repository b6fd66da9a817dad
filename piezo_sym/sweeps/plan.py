"""The plan of a sweep: the runs, their points in the grid, and the boxes into which it is divided.

Input: the arguments of `sweep`.  Output: `Plan`, or a `UsageError`.  A box is a region of the grid
that one task runs, as a `Plan` of its own.  Within a box, runs with equal inputs and bank sizes
form a group, one call of C; so boxes are divided along axes of inputs and sizes first.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import product
from math import prod
from typing import Any, Literal, Self, TypeAlias, final

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
    refuse_run,
    sample_times,
)
from piezo_sym.run.signals import Constant, Signal
from piezo_sym.run.simulate import read_rtol, read_step
from piezo_sym.sweeps.axes import Axis, Target, read_axes, single_numbers

Reduction: TypeAlias = Literal["last", "mean"] | Callable[[Any], object]
#: Where a box is in the grid: a slice for each axis.
Region: TypeAlias = tuple[slice, ...]

#: The most runs in one call of C, and by SciPy in one box; the most numbers that one call returns.
MOST_TOGETHER, MOST_BY_SCIPY = 512, 32
MOST_NUMBERS = 8_000_000
#: With a reduction: the most runs in a box, if at least `ENOUGH_BOXES` boxes remain.
MOST_REDUCED = 512
ENOUGH_BOXES = 256


@final
@dataclass(frozen=True, eq=False)
class Plan:
    """The runs of a sweep, or of one of its boxes."""

    axes: tuple[Axis, ...]  # in the user's order
    signals: tuple[Signal, ...]  # of each input, where it is not swept
    duration: float
    #: What the user gave and is not swept, and one number for each swept parameter of a bank, as a
    #: list in the spec may not fit the swept sizes.
    parameters: Mapping[str, LaneValue]
    initial: Mapping[str, LaneValue]
    samples: FloatArray  # their times (nt,) [s]
    method: str
    rtol: float
    step: FixedStep | None  # None for steps by rtol
    reduce: Reduction | None
    each: bool  # whether the reducing function takes one run, not many
    largest_banks: Mapping[str, int]  # the largest size of each bank whose size is swept
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
        """The samples that are evaluated: all, or the last."""
        return slice(-1, None) if self.reduce == "last" else slice(None)

    @cached_property
    def box_shape(self) -> tuple[int, ...]:
        """The shape of a box; boxes at the edges of the grid may be smaller."""
        room, shape = self.most, list(self.shape)
        for n in reversed(sorted(range(len(shape)), key=lambda n: not self.axes[n].divides)):
            parts = -(-shape[n] // max(1, min(shape[n], room)))
            room = room // shape[n] if parts == 1 else 1
            shape[n] = -(-shape[n] // parts)  # as equal as possible
        return tuple(shape)

    def regions(self) -> Iterator[Region]:
        """Yield the region of each box."""
        slices = (
            [slice(first, min(first + part, size)) for first in range(0, size, part)]
            for size, part in zip(self.shape, self.box_shape, strict=True)
        )
        return product(*slices)

    def part(self, region: Region) -> Self:
        """Return the plan of one box."""
        axes = zip(self.axes, region, strict=True)
        return replace(self, axes=tuple(axis.part(points) for axis, points in axes))

    @cached_property
    def points(self) -> NDArray[np.intp]:
        """The points of the grid (runs, axes), the last axis fastest."""
        return np.indices(self.shape).reshape(len(self.shape), -1).T

    def groups(self) -> Iterator[NDArray[np.intp]]:
        """Yield the numbers of the runs of each group."""
        divides = np.array([axis.divides for axis in self.axes])
        key = np.ravel_multi_index(tuple((self.points * divides).T), self.shape)
        for value in np.unique(key):
            runs = np.flatnonzero(key == value)
            for first in range(0, runs.size, self.together):
                yield runs[first : first + self.together]

    def swept(self) -> Iterator[tuple[int, Target]]:
        """Yield each target and the number of its axis."""
        for n, axis in enumerate(self.axes):
            for target in axis.targets:
                yield n, target

    def values_at(self, kind: str, points: NDArray[np.intp]) -> Iterator[dict[str, Any]]:
        """Yield the swept values of one kind, without sizes of banks, at each point."""
        swept = [(n, t) for n, t in self.swept() if t.kind == kind and not t.is_size]
        for point in points.tolist():
            yield {target.name: target.values[point[n]] for n, target in swept}

    def inputs_at(self, module: GeneratedModule, point: NDArray[np.intp]) -> Inputs:
        """Return the inputs of the runs at a point."""
        (swept,) = self.values_at("inputs", point[None])
        named = zip(module.INPUTS, self.signals, strict=True)
        values = (swept.get(record.name, signal) for record, signal in named)
        signals = (v if isinstance(v, Signal) else Constant(float(v)) for v in values)
        return Inputs(tuple(signals), self.duration)

    def base_at(self, module: GeneratedModule, point: NDArray[np.intp]) -> Any:
        """Return the parameters of the runs at a point, with swept sizes but no other values."""
        sizes = {t.name: int(t.values[point[n]]) for n, t in self.swept() if t.is_size}
        return read_parameters(module, {**self.parameters, **sizes})


def largest_banks(axes: Iterable[Axis]) -> dict[str, int]:
    """Return the largest size of each bank whose size is swept."""
    sizes = [target for axis in axes for target in axis.targets if target.is_size]
    return {str(t.bank): max(int(v) for v in t.values) for t in sizes}  # type: ignore[arg-type]


WAYS = ("run", "chunk")
REDUCTIONS = ("last", "mean")


def read_plan(
    module: GeneratedModule, over: object, runs: tuple[Any, ...], reduce: Any, reduce_by: object
) -> Plan:
    """Return the plan of a sweep; `runs` are arguments of `simulate`, in the order of `sweep`."""
    inputs, duration, rtol, step, order, parameters, initial, method, times = runs
    with calling("sweep"):
        named, bound = checked_method(method), read_rtol(rtol)
        fixed, end = read_step(step, order, named, rtol), positive(duration, "sweep.duration")
        only_end = reduce == "last" and times is step is None
        samples = sample_times(2 if only_end else times, step, end)
        signals = read_inputs(module, inputs, end)
        refuse_run(module, initial)
        axes = read_axes(module, over, end, read_sizes(module, parameters))
        for target in (target for axis in axes for target in axis.targets):
            given = {"parameters": parameters, "initial": initial, "inputs": inputs}[target.kind]
            if target.name in (given or {}):
                what = f"'{target.name}' is swept and also given in '{target.kind}'"
                raise UsageError(what, "sweep.over", remedy="give it once")
        fixed_values = {**(parameters or {}), **single_numbers(axes)}, dict(initial or {})
        base = read_parameters(module, fixed_values[0])
        refuse_sizes(module, axes, *fixed_values, signals.segments[0].at(0.0))
        refuse_reduction(reduce, reduce_by)
        chosen = choose_method(module, named, step)
        most = MOST_TOGETHER if chosen.method == METHOD else MOST_BY_SCIPY
        numbers = samples.size * row_numbers(module, base, axes)
        together = boxes = max(1, min(most, MOST_NUMBERS // numbers))
        if reduce is not None:  # results are small
            size = prod(axis.size for axis in axes)
            boxes = max(together, min(MOST_REDUCED, size // ENOUGH_BOXES))
        how = (chosen.method, bound, fixed, reduce, reduce_by == "run", largest_banks(axes))
        sizes = (together, boxes, chosen.note)
        return Plan(axes, signals.signals, end, *fixed_values, samples, *how, *sizes)  # type: ignore[arg-type]  # reduce is checked


def refuse_sizes(
    module: GeneratedModule,
    axes: tuple[Axis, ...],
    parameters: Mapping[str, Any],
    initial: Mapping[str, Any],
    u: FloatArray,
) -> None:
    """Raise `UsageError` where a list that is not swept does not fit every size of its bank."""
    swept = {t.name: t.values for axis in axes for t in axis.targets if t.is_size}
    sizes: list[dict[str, Any]] = [{k: n} for k, v in swept.items() for n in dict.fromkeys(v)]
    for size in sizes or [{}]:
        p = read_parameters(module, {**parameters, **size})
        try:
            with np.errstate(all="ignore"):
                own_initial(module, p, u)
        except PiezoError:  # a swept value may replace the invalid one; each run is checked
            continue
        read_initial(module, p, u, initial)


def refuse_reduction(reduce: object, reduce_by: object) -> None:
    """Raise `UsageError` if there is no such reduction."""
    if not (reduce is None or reduce in REDUCTIONS or callable(reduce)):
        expected = f"{listing(map(repr, REDUCTIONS))}, or a function of a Dataset"
        raise UsageError(f"{quote(reduce)} is no reduction", "sweep.reduce", expected)
    if reduce_by not in WAYS:
        what = f"{quote(reduce_by)} is not known"
        raise UsageError(what, "sweep.reduce_by", listing(map(repr, WAYS)))


def row_numbers(module: GeneratedModule, base: Any, axes: tuple[Axis, ...]) -> int:
    """Return the approximate number of values per sample of a run, at the largest sizes."""
    sizes = {bank: lanes(base, bank) for bank in module.BANKS} | largest_banks(axes)
    records = (*module.STATES, *module.PROCESSES, *module.OUTPUTS)
    return 4 * sum(sizes[record.bank] if record.bank else 1 for record in records) + 8
