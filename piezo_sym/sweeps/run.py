"""Run one box of a sweep: the work of one task, in a thread or in another process.

Input: the `Plan` of a box, its module.  Output: a `Result`: the quantities of each run, and the
error of each that failed.  Runs with equal inputs and sizes form a `Group`.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any, final

import numpy as np
import xarray
from numpy.typing import NDArray

from piezo_sym.errors import PiezoError, RunError
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.collocation import METHOD, Watch, collocate
from piezo_sym.run.dataset import coordinates, lane_counts, named_rows
from piezo_sym.run.engine.engine import Engine, Members, engine_of
from piezo_sym.run.guard import check_inputs, check_start, inputs_vary, limited
from piezo_sym.run.module import GeneratedModule, row_count
from piezo_sym.run.parameters import own_initial, read_initial
from piezo_sym.run.scipy_runs import by_scipy, stop_cause
from piezo_sym.run.system import DrivenModule
from piezo_sym.sweeps.plan import Plan
from piezo_sym.sweeps.reduce import (
    MEMBER,
    Quantities,
    all_at_once,
    as_quantities,
    layout,
    of_runs,
    of_trajectory,
    over_time,
    refuse_names,
    refuse_other_names,
    refuse_other_sizes,
    run_by_run,
    weights,
)


@final
@dataclass(frozen=True)
class Result:
    """The results of a box, over the axes of the sweep."""

    errors: NDArray[Any]  # why each run failed, or ""
    quantities: Quantities  # nan where a run failed; none if a function's runs all failed
    coords: Quantities  # of dimensions that a function added


@final
@dataclass(frozen=True)
class Group:
    """Runs with equal inputs and sizes."""

    systems: Sequence[DrivenModule]
    start: FloatArray  # states (runs, n) at t = 0, nan where there is none
    errors: list[str]  # why each run failed, or ""


def group_at(
    plan: Plan, module: GeneratedModule, engine: Engine | None, points: NDArray[np.intp]
) -> Group:
    """Return the runs at points (runs, axes), which have equal inputs and sizes.

    A run that cannot start has the same error as from `simulate`.
    """
    inputs, base = plan.inputs_at(module, points[0]), plan.base_at(module, points[0])
    changed = plan.values_at("parameters", points)
    own, parameters = {f.name: getattr(base, f.name) for f in fields(base)}, type(base)
    systems = [DrivenModule(module, parameters(**(own | values)), inputs) for values in changed]
    u = inputs.segments[0].at(0.0)
    start = np.full((len(points), row_count(module.STATES, base)), np.nan)
    errors = [""] * len(points)
    with np.errstate(all="ignore"):
        for k, swept in enumerate(plan.values_at("initial", points)):
            p, given = systems[k].parameters, {**plan.initial, **swept}
            try:
                start[k] = read_initial(module, p, u, given) if given else own_initial(module, p, u)
            except PiezoError as error:
                errors[k] = str(error)
    check_starts(systems, engine, start, errors)
    return Group(systems, start, errors)


def check_starts(
    systems: Sequence[DrivenModule], engine: Engine | None, start: FloatArray, errors: list[str]
) -> None:
    """Fill in the errors of runs whose start is outside the domain.

    C finds the starts inside, but does not check the limits of stops.
    """
    inside = np.zeros(len(systems), dtype=bool)
    if engine and not limited(systems[0].module):
        first = systems[0].inputs.segments[0]
        u = np.ascontiguousarray(first.at(first.start)[None])
        x = np.ascontiguousarray(start[:, None])
        inside = Members(engine, [one.parameters for one in systems]).inside(x, u)[:, 0]
    for k in np.flatnonzero(~inside).tolist():
        if not errors[k]:
            try:
                check_start(systems[k], start[k])
            except PiezoError as error:
                errors[k] = str(error)


def run_box(plan: Plan, module: GeneratedModule, watch: Watch) -> Result:
    """Return the result of the box with this plan; an exception of `watch` ends the work."""
    engine = engine_of(module) if plan.method == METHOD else None
    errors = np.full(plan.size, "", dtype=object)
    all_quantities: Quantities = {}
    all_coords: Quantities = {}
    for runs in plan.groups():
        group = group_at(plan, module, engine, plan.points[runs])
        quantities, coords = group_result(plan, group, engine, plan.points[runs], watch)
        errors[runs] = np.array(group.errors, dtype=object)
        if all_quantities and quantities:
            refuse_other_names(all_quantities, quantities)
        for name, variable in quantities.items():
            fill_in(plan, name, all_quantities, runs, variable)
        all_coords |= {name: c for name, c in coords.items() if name not in plan.largest_banks}
    grids = {}
    for name, variable in all_quantities.items():
        values = variable.values.reshape(*plan.shape, *variable.shape[1:])
        dims = *plan.dims, *variable.dims[1:]
        grids[name] = xarray.Variable(dims, values, variable.attrs)
    return Result(errors.reshape(plan.shape), grids, all_coords)


def fill_in(
    plan: Plan, name: str, box: Quantities, runs: NDArray[np.intp], part: xarray.Variable
) -> None:
    """Fill in a quantity of a box at some of its runs; lanes that these do not have stay nan."""
    sizes = zip(part.dims[1:], part.shape[1:], strict=True)
    shape = (plan.size, *(plan.largest_banks.get(str(dim), size) for dim, size in sizes))
    if name not in box:
        if shape == part.shape:
            box[name] = part
            return
        box[name] = xarray.Variable(part.dims, np.full(shape, np.nan), part.attrs)
    refuse_other_sizes(name, box[name].shape[1:], shape[1:])
    where: Any = (runs, *(slice(size) for size in part.shape[1:]))
    box[name].values[where] = part.values


def group_result(
    plan: Plan, group: Group, engine: Engine | None, points: NDArray[np.intp], watch: Watch
) -> tuple[Quantities, Quantities]:
    """Return a group's quantities, and coordinates from a reducing function; fill in its errors."""
    u = group.systems[0].inputs.at_samples(plan.samples)
    if engine:
        quantities = run_in_c(plan, group, engine, u, watch)
    else:
        quantities = run_by_scipy(plan, group, watch)
    if plan.reduce is None:
        return quantities, {}
    if isinstance(plan.reduce, str):
        return over_time(quantities, weights(plan.samples[plan.kept])), {}
    runs = dataset(plan, group, quantities, u, points)
    reduced = (run_by_run if plan.each else all_at_once)(plan.reduce, runs, group.errors)
    if reduced is None:
        return {}, {}
    refuse_names(map(str, reduced.variables), (*plan.names(), "error"))
    return as_quantities(reduced)


def nan_quantities(plan: Plan, group: Group) -> Quantities:
    """Return every quantity of a group's runs, filled with nan."""
    size = len(group.systems), plan.samples[plan.kept].size
    quantities = {}
    for name, one in layout(group.systems[0]).items():
        values = np.full((*size, *one.shape[1:]), np.nan)
        quantities[name] = xarray.Variable((MEMBER, *one.dims), values, one.attrs)
    return quantities


def run_in_c(plan: Plan, group: Group, engine: Engine, u: FloatArray, watch: Watch) -> Quantities:
    """Return every quantity of runs in C; fill in the errors of those that fail.

    As with `simulate`, a run whose inputs leave the domain fails.
    """
    started = [k for k, error in enumerate(group.errors) if not error]
    if not started:
        return nan_quantities(plan, group)
    systems, x = [group.systems[k] for k in started], group.start[started]
    outside = input_errors(systems, x, plan.samples)
    given = systems, engine, x, plan.samples, plan.step or plan.rtol, watch
    runs = collocate(*given, side_by_side=plan.side_by_side)
    for n, k in enumerate(started):
        stopped = runs.errors[n]
        error = outside[n] or (stopped and stop_cause(systems[n], x[n], plan.samples, stopped))
        group.errors[k] = str(error or "")
    quantities = of_runs(runs, engine, u, plan.kept)
    if not any(group.errors):
        return quantities
    kept = np.array([not error for error in group.errors])
    padded = nan_quantities(plan, group)
    for name, variable in quantities.items():
        padded[name].values[kept] = variable.values[kept[started]]
    return padded


def input_errors(
    systems: Sequence[DrivenModule], x: FloatArray, samples: FloatArray
) -> list[RunError | None]:
    """Return the error of each run whose inputs leave the domain after its start."""
    errors: list[RunError | None] = [None] * len(systems)
    for k in range(len(systems)) if inputs_vary(systems[0]) else ():
        try:
            check_inputs(systems[k], x[k], samples)
        except RunError as error:
            errors[k] = error
    return errors


def run_by_scipy(plan: Plan, group: Group, watch: Watch) -> Quantities:
    """Return every quantity of runs by SciPy; fill in the errors of those that fail."""
    quantities = nan_quantities(plan, group)
    for k, system in enumerate(group.systems):
        if group.errors[k]:
            continue
        given = system, group.start[k], plan.samples, plan.method, plan.rtol, watch
        try:
            run, _ = by_scipy(*given)
        except PiezoError as error:
            group.errors[k] = str(error)
        else:
            for name, one in of_trajectory(system, run).items():
                quantities[name].values[k] = one.values[plan.kept]
    return quantities


def dataset(
    plan: Plan, group: Group, quantities: Quantities, u: FloatArray, points: NDArray[np.intp]
) -> xarray.Dataset:
    """Return the runs of a group as a Dataset over `member`, for a user's function."""
    system = group.systems[0]
    module, size = system.module, (len(u), len(points), plan.samples.size)
    waves = np.broadcast_to(u[:, None], size)
    inputs = dict(named_rows(system, (MEMBER, "time"), module.INPUTS, waves))
    coords: dict[str, Any] = dict(coordinates(lane_counts(system), plan.samples))
    for n, axis in enumerate(plan.axes):
        for name, (values, attrs) in axis.coordinates():
            taken = name in quantities or name in inputs or name in coords
            label = f"over_{name}" if taken else name
            coords[label] = (MEMBER, np.asarray(values)[points[:, n]], attrs)
    attrs = {"model": module.NAME, "spec_sha256": module.SPEC_SHA256}
    return xarray.Dataset({**quantities, **inputs}, coords, attrs)
