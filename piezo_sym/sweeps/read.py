"""The arguments of a sweep, checked before anything runs.

Input: the arguments of `sweep`.  Output: a `Plan`, or a `UsageError`.
"""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from math import prod
from typing import Any

from piezo_sym.errors import PiezoError, UsageError, listing, quote
from piezo_sym.run.checks import FloatArray, positive
from piezo_sym.run.collocation import METHOD
from piezo_sym.run.inputs import read_inputs
from piezo_sym.run.method import checked_method, choose_method
from piezo_sym.run.module import GeneratedModule, lanes
from piezo_sym.run.parameters import (
    own_initial,
    read_initial,
    read_parameters,
    read_sizes,
    sample_times,
)
from piezo_sym.run.simulate import read_rtol, read_step
from piezo_sym.sweeps.axes import Axis, read_axes, single_numbers
from piezo_sym.sweeps.plan import (
    ENOUGH_BOXES,
    MOST_BY_SCIPY,
    MOST_NUMBERS,
    MOST_REDUCED,
    MOST_TOGETHER,
    Plan,
    largest_banks,
)

WAYS = ("run", "chunk")
REDUCTIONS = ("last", "mean")


def read_plan(
    module: GeneratedModule, over: object, runs: tuple[Any, ...], reduce: Any, reduce_by: object
) -> Plan:
    """Return what a sweep runs; without a compiler, its method is LSODA.

    `runs` is what `simulate` takes, as `sweep` lists it.
    """
    inputs, duration, rtol, step, order, parameters, initial, method, times, every = runs
    with named_sweep():
        named, bound = checked_method(method), read_rtol(rtol)
        fixed, end = read_step(step, order, named, rtol), positive(duration, "sweep.duration")
        only_end = reduce == "last" and times is every is step is None
        samples = sample_times(2 if only_end else times, every, step, end)
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


@contextmanager
def named_sweep() -> Iterator[None]:
    """Let errors of shared checks name the function that was called."""
    try:
        yield
    except PiezoError as error:
        error.where = error.where.replace("simulate.", "sweep.", 1)
        raise


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
