"""Run one box of a sweep: the work of one task, in a thread or in another process.

Input: the `Plan` of a box, its module.  Output: a `Result`: the quantities kept of each run, and
the error of each that failed.
"""

from dataclasses import dataclass
from typing import Any, final

import numpy as np
import xarray
from numpy.typing import NDArray

from piezo_sym.errors import PiezoError, RunError
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.collocation import METHOD, Watch, collocate
from piezo_sym.run.dataset import coordinates, spread
from piezo_sym.run.engine.engine import Engine, engine_of
from piezo_sym.run.guard import check_inputs, inputs_move
from piezo_sym.run.module import GeneratedModule
from piezo_sym.run.scipy_runs import by_scipy, cause
from piezo_sym.run.system import DrivenModules
from piezo_sym.sweeps.group import Group, group_at
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
    coords: Quantities  # of dimensions that a function created


def run_box(plan: Plan, module: GeneratedModule, watch: Watch) -> Result:
    """Return the result of a box, whose plan this is; what `watch` raises ends the work."""
    engine = engine_of(module) if plan.method == METHOD else None
    errors = np.full(plan.size, "", dtype=object)
    found: Quantities = {}
    coords: Quantities = {}
    for runs in plan.groups():
        group = group_at(plan, module, engine, plan.points[runs])
        made, own = group_result(plan, group, engine, plan.points[runs], watch)
        errors[runs] = np.array(group.errors, dtype=object)
        if found and made:
            refuse_other_names(found, made)
        for name, one in made.items():
            found[name] = filled_in(plan, name, found, runs, one)
        coords |= {name: one for name, one in own.items() if name not in plan.largest_banks}
    grids = {}
    for name, one in found.items():
        values = one.values.reshape(*plan.shape, *one.shape[1:])
        grids[name] = xarray.Variable((*plan.dims, *one.dims[1:]), values, one.attrs)
    return Result(errors.reshape(plan.shape), grids, coords)


def filled_in(
    plan: Plan, name: str, known: Quantities, runs: NDArray[np.intp], part: xarray.Variable
) -> xarray.Variable:
    """Return a quantity of a box with the values of some of its runs filled in.

    Lanes that a bank does not have at these runs are nan.
    """
    sizes = zip(part.dims[1:], part.shape[1:], strict=True)
    shape = (plan.size, *(plan.largest_banks.get(str(dim), size) for dim, size in sizes))
    if name not in known:
        if shape == part.shape:
            return part
        known[name] = xarray.Variable(part.dims, np.full(shape, np.nan), part.attrs)
    whole = known[name]
    refuse_other_sizes(name, whole.shape[1:], shape[1:])
    lanes = [slice(size) for size in part.shape[1:]]
    where: Any = (runs, *lanes)
    whole.values[where] = part.values
    return whole


def group_result(
    plan: Plan, group: Group, engine: Engine | None, points: NDArray[np.intp], watch: Watch
) -> tuple[Quantities, Quantities]:
    """Return the quantities kept of a group, and a function's coordinates; fill in its errors."""
    u = group.systems.inputs.at_samples(plan.samples)
    found = in_c(plan, group, engine, u, watch) if engine else one_by_one(plan, group, watch)
    if any(group.errors):
        found = with_failed(plan, group, found)
    if plan.reduce is None:
        return found, {}
    if isinstance(plan.reduce, str):
        return over_time(found, weights(plan.samples[plan.kept])), {}
    runs = dataset(plan, group, found, u, points)
    made = (run_by_run if plan.each else all_at_once)(plan.reduce, runs, group.errors)
    if made is None:
        return {}, {}
    refuse_names(map(str, made.variables), (*plan.names(), "error"))
    return as_quantities(made)


def with_failed(plan: Plan, group: Group, found: Quantities) -> Quantities:
    """Return quantities of all runs from those of the successful ones; the others are nan."""
    through = [not error for error in group.errors]
    size, whole = (len(through), plan.samples[plan.kept].size), {}
    for name, one in layout(group.systems[0]).items():
        values = np.full((*size, *one.shape[1:]), np.nan)
        if found:
            values[through] = found[name].values
        whole[name] = xarray.Variable((MEMBER, *one.dims), values, one.attrs)
    return whole


def in_c(plan: Plan, group: Group, engine: Engine, u: FloatArray, watch: Watch) -> Quantities:
    """Return every quantity of the runs that succeed in C; fill in the errors of the others.

    As with `simulate`, a run whose inputs leave the domain is an error.
    """
    started = [k for k, error in enumerate(group.errors) if not error]
    if not started:
        return {}
    systems, x = group.systems.some(started), group.start[started]
    outside = input_errors(systems, x, plan.samples)
    given = systems, engine, x, plan.samples, plan.step or plan.rtol, watch
    runs = collocate(*given, side_by_side=plan.side_by_side)
    for n, k in enumerate(started):
        stopped = runs.errors[n]
        error = outside[n] or (stopped and cause(systems[n], x[n], plan.samples, stopped))
        group.errors[k] = str(error or "")
    found = of_runs(runs, engine, u, plan.kept)
    through = [not group.errors[k] for k in started]
    return found if all(through) else {name: one[through] for name, one in found.items()}


def input_errors(
    systems: DrivenModules, x: FloatArray, samples: FloatArray
) -> list[RunError | None]:
    """Return the errors of inputs that leave the domain after t = 0, where starts are checked."""
    found: list[RunError | None] = [None] * len(systems)
    for k in range(len(systems)) if inputs_move(systems[0]) else ():
        try:
            check_inputs(systems[k], x[k], samples)
        except RunError as error:
            found[k] = error
    return found


def one_by_one(plan: Plan, group: Group, watch: Watch) -> Quantities:
    """Return every quantity of the runs that succeed in SciPy; fill in the errors of the others."""
    parts = []
    for k, system in enumerate(group.systems):
        if group.errors[k]:
            continue
        accuracy = (plan.method, plan.rtol, watch)
        try:
            run, _ = by_scipy(system, group.start[k], plan.samples, *accuracy)
        except PiezoError as error:
            group.errors[k] = str(error)
        else:
            parts.append(of_trajectory(system, run))
    found = {}
    for name, one in parts[0].items() if parts else ():
        values = np.stack([part[name].values[plan.kept] for part in parts])
        found[name] = xarray.Variable((MEMBER, *one.dims), values, one.attrs)
    return found


def dataset(
    plan: Plan, group: Group, found: Quantities, u: FloatArray, points: NDArray[np.intp]
) -> xarray.Dataset:
    """Return the runs of a group as a Dataset over `member`, for a user's function."""
    system = group.systems[0]
    module, size = system.module, (len(u), len(points), plan.samples.size)
    waves = np.broadcast_to(u[:, None], size)
    inputs = dict(spread(system, (MEMBER, "time"), module.INPUTS, waves))
    coords: dict[str, Any] = dict(coordinates(system, plan.samples))
    for n, axis in enumerate(plan.axes):
        for name, (values, attrs) in axis.coordinates():
            taken = name in found or name in inputs or name in coords
            label = f"over_{name}" if taken else name
            coords[label] = (MEMBER, np.asarray(values)[points[:, n]], attrs)
    attrs = {"model": module.NAME, "spec_sha256": module.SPEC_SHA256}
    return xarray.Dataset({**found, **inputs}, coords, attrs)
