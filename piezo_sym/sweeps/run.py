"""One box of a sweep, run: the work of one task, in a thread or in another process.

Input: a `Plan`, its module, a `Box`.  Output: a `Result`: what is kept of each run, and why those
that failed did.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import groupby
from typing import TYPE_CHECKING, Any, TypeAlias, final

import numpy as np

from piezo_sym.errors import PiezoError, RunError
from piezo_sym.run.collocation import with_tolerance
from piezo_sym.run.compiled import cause, check_inputs, inputs_move
from piezo_sym.run.dataset import coordinates
from piezo_sym.run.discrete import fixed
from piezo_sym.run.engine.engine import engine_of
from piezo_sym.run.module import lanes
from piezo_sym.run.runs import METHOD, Runs
from piezo_sym.run.simulate import by_scipy
from piezo_sym.sweeps.group import Group, group_at
from piezo_sym.sweeps.quantities import (
    Quantities,
    RunQuantity,
    layout,
    of_runs,
    of_trajectory,
    widened,
)
from piezo_sym.sweeps.reduce import (
    MEMBER,
    all_at_once,
    as_quantities,
    over_time,
    refuse_names,
    run_by_run,
    weights,
)

if TYPE_CHECKING:
    import xarray
    from numpy.typing import NDArray

    from piezo_sym.run.checks import FloatArray
    from piezo_sym.run.engine import Engine
    from piezo_sym.run.module import GeneratedModule
    from piezo_sym.run.system import System, Systems
    from piezo_sym.sweeps.plan import Box, Plan

Watch: TypeAlias = Callable[[float], object]


@final
@dataclass(frozen=True)
class Result:
    """What is left of the runs of a box, in its order.

    Attributes
    ----------
    errors : why each run failed, or "".
    quantities : nan where a run failed; none where no run is left for a function to reduce.
    coords : of dimensions that a reduction's function made.
    """

    box: Box
    errors: tuple[str, ...]
    quantities: Quantities
    coords: dict[str, RunQuantity]


def run_box(plan: Plan, module: GeneratedModule, box: Box, watch: Watch) -> Result:
    """Return the result of a box.

    Parameters
    ----------
    watch : told the time that runs have reached, now and then; what it raises ends the work.

    Raises
    ------
    EngineError : there is no compiler here.
    UsageError : the reduction gives something of no use.
    """
    engine = engine_for(plan, module)
    points = plan.points(box)
    parts: list[Quantities] = []
    coords: dict[str, RunQuantity] = {}
    errors: list[str] = []
    for some in together(plan, points):
        group = group_at(plan, module, engine, points[some])
        found, made = group_result(plan, group, engine, points[some], watch)
        parts.append({name: widened(one, plan.largest_banks) for name, one in found.items()})
        coords |= {name: one for name, one in made.items() if name not in plan.largest_banks}
        errors += group.errors
    return Result(box, tuple(errors), joined(parts, points, plan), coords)


def engine_for(plan: Plan, module: GeneratedModule) -> Engine | None:
    """Return the engine that a plan's runs go through, or None if they go by SciPy."""
    return engine_of(module) if plan.method == METHOD else None


def together(plan: Plan, points: NDArray[np.intp]) -> Iterator[slice]:
    """Yield the runs of a box that go through C in one call."""
    dividing = list(plan.order[: plan.dividing])
    start = 0
    for _, same in groupby(points[:, dividing].tolist()):
        stop = start + sum(1 for _ in same)
        for first in range(start, stop, plan.together):
            yield slice(first, min(first + plan.together, stop))
        start = stop


def joined(parts: list[Quantities], points: NDArray[np.intp], plan: Plan) -> Quantities:
    """Return the parts of a box as one, nan for a part of which nothing is left."""
    if len(parts) == 1:
        return parts[0]
    sizes = [some.stop - some.start for some in together(plan, points)]
    model = next((part for part in parts if part), {})
    found: Quantities = {}
    for name, one in model.items():
        shape = one.values.shape[1:]
        arrays = [
            part[name].values if part else np.full((size, *shape), np.nan)
            for part, size in zip(parts, sizes, strict=True)
        ]
        found[name] = replace(one, values=np.concatenate(arrays))
    return found


def group_result(
    plan: Plan, group: Group, engine: Engine | None, points: NDArray[np.intp], watch: Watch
) -> tuple[Quantities, dict[str, RunQuantity]]:
    """Return what is kept of a group, its errors filled in, and a function's coordinates."""
    kept = slice(-1, None) if plan.reduce == "last" else slice(None)
    system = group.systems[0]
    u = system.inputs.at_samples(plan.samples)
    arrays = in_c(plan, group, engine, u, kept, watch) if engine else one_by_one(plan, group, watch)
    if not engine:
        arrays = {name: values[:, kept] for name, values in arrays.items()}
    known = layout(system)
    found = {n: RunQuantity(d, arrays[n], a) for n, (d, a) in known.items() if n in arrays}
    if plan.reduce is None:
        return found, {}
    if plan.reduce == "last":
        return over_time(found, np.ones(1)), {}
    if plan.reduce == "mean":
        return over_time(found, weights(plan.samples)), {}
    names = [record.name for record in system.module.INPUTS]
    size = (len(group.errors), plan.samples.size)
    waves = {n: RunQuantity(*of) for n, of in inputs(known, names, u, size)}
    runs = dataset(plan, group, {**found, **waves}, points)
    made = (run_by_run if plan.each else all_at_once)(plan.reduce, runs, group.errors)
    if made is None:
        return {}, {}
    refuse_names(map(str, made.variables), (*plan.names(), "error"))
    return as_quantities(made)


def inputs(
    known: dict[str, Any], names: list[str], u: FloatArray, size: tuple[int, int]
) -> Iterator[tuple[str, tuple[tuple[str, ...], NDArray[Any], Any]]]:
    """Yield each input as the same numbers for every run."""
    for name, row in zip(names, u, strict=True):
        dims, attrs = known[name]
        yield name, (dims, np.broadcast_to(row, size), attrs)


def in_c(
    plan: Plan, group: Group, engine: Engine, u: FloatArray, kept: slice, watch: Watch
) -> dict[str, NDArray[Any]]:
    """Return every quantity of a group run in C; runs that fail get their errors, and nan."""
    good = [k for k, error in enumerate(group.errors) if not error]
    found: dict[str, NDArray[Any]] = {}
    if good:
        systems = group.systems.some(good)
        runs = stopped_runs_explained(plan, systems, engine, group.start[good], watch)
        for k, error in zip(good, runs.errors, strict=True):
            group.errors[k] = str(error or "")
        found = of_runs(runs, engine, u, kept)
    failed = np.array([bool(error) for error in group.errors])
    return spread_out(plan, group, found, good, failed, kept)


def stopped_runs_explained(
    plan: Plan, systems: Systems, engine: Engine, x: FloatArray, watch: Watch
) -> Runs:
    """Return runs in C; those whose inputs leave the domain stop there, as with `simulate`."""
    outside = input_errors(systems, x, plan.samples)
    runs = stepped(plan, systems, engine, x, watch)
    errors = [
        left or (stopped and cause(systems[k], x[k], plan.samples, stopped))
        for k, (left, stopped) in enumerate(zip(outside, runs.errors, strict=True))
    ]
    return replace(runs, errors=errors)


def input_errors(systems: Systems, x: FloatArray, samples: FloatArray) -> list[RunError | None]:
    """Return the errors of inputs that leave the domain after t = 0, where starts are checked."""
    if not inputs_move(systems[0]):
        return [None] * len(systems)
    return [input_error(*one, samples) for one in zip(systems, x, strict=True)]


def input_error(system: System, x: FloatArray, samples: FloatArray) -> RunError | None:
    """Return the error of inputs that leave the domain, or None."""
    try:
        check_inputs(system, x, samples)
    except RunError as error:
        return error
    return None


def stepped(plan: Plan, systems: Systems, engine: Engine, x: FloatArray, watch: Watch) -> Runs:
    """Return runs in C, with the plan's step or tolerance."""
    given, side_by_side = (systems, engine, x, plan.samples), plan.side_by_side
    if plan.step is None:
        return with_tolerance(*given, plan.rtol, watch, side_by_side=side_by_side)
    return fixed(*given, plan.step, watch, side_by_side=side_by_side)


def spread_out(
    plan: Plan,
    group: Group,
    found: dict[str, NDArray[Any]],
    good: list[int],
    failed: np.ndarray[Any, np.dtype[np.bool_]],
    kept: slice,
) -> dict[str, NDArray[Any]]:
    """Return the quantities of all runs of a group, nan for those that failed."""
    if not failed.any():
        return found
    system = group.systems[0]
    times = plan.samples[kept].size
    names = {record.name for record in system.module.INPUTS}
    whole = {}
    for name, (dims, _) in layout(system).items():
        if name not in names:
            sizes = (times, *(lanes(system.parameters, bank) for bank in dims[1:]))
            whole[name] = np.full((len(failed), *sizes), np.nan)
            if found:
                whole[name][good] = found[name]
                whole[name][failed] = np.nan
    return whole


def one_by_one(plan: Plan, group: Group, watch: Watch) -> dict[str, NDArray[Any]]:
    """Return every quantity of a group run by SciPy."""
    parts, good = [], []
    for k, system in enumerate(group.systems):
        if group.errors[k]:
            continue
        accuracy = (plan.method, plan.rtol, watch)
        try:
            run, _ = by_scipy(system, group.start[k], plan.samples, *accuracy)
        except PiezoError as error:
            group.errors[k] = str(error)
        else:
            good.append(k)
            parts.append(of_trajectory(system, run))
    names = list(parts[0]) if parts else []
    found = {name: np.concatenate([part[name] for part in parts]) for name in names}
    failed = np.array([bool(error) for error in group.errors])
    return spread_out(plan, group, found, good, failed, slice(None))


def dataset(
    plan: Plan, group: Group, found: Quantities, points: NDArray[np.intp]
) -> xarray.Dataset:
    """Return the runs of a group as a Dataset over `member`, for a user's function."""
    import xarray

    system = group.systems[0]
    coords: dict[str, Any] = dict(coordinates(system, plan.samples))
    for n, axis in enumerate(plan.axes):
        for name, (values, attrs) in axis.coordinates():
            label = f"over_{name}" if name in found or name in coords else name
            coords[label] = (MEMBER, np.asarray(values)[points[:, n]], attrs)
    known = layout(system)
    order: Iterable[str] = [name for name in known if name in found]
    data = {n: ((MEMBER, *found[n].dims), found[n].values, found[n].attrs) for n in order}
    module = system.module
    attrs = {"model": module.NAME, "spec_sha256": module.SPEC_SHA256}
    return xarray.Dataset(data, coords, attrs)
