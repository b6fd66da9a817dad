"""Run one box of a sweep: the work of one task, in a thread or in another process.

Input: the `Plan` of a box, its module.  Output: a `Result`: the quantities kept of each run, and
the error of each that failed.  Runs with equal inputs and sizes form a `Group`.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, final

import numpy as np
import xarray
from numpy.typing import NDArray

from piezo_sym.errors import PiezoError, RunError
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.collocation import METHOD, Watch, collocate
from piezo_sym.run.dataset import coordinates, spread
from piezo_sym.run.engine.engine import Engine, Members, engine_of
from piezo_sym.run.guard import check_inputs, check_start, inputs_move, limited
from piezo_sym.run.module import GeneratedModule, row_count
from piezo_sym.run.parameters import own_initial, read_initial
from piezo_sym.run.scipy_runs import by_scipy, cause
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
    coords: Quantities  # of dimensions that a function created


@final
@dataclass(frozen=True)
class Group:
    """Runs with equal inputs and sizes."""

    systems: Sequence[DrivenModule]
    start: FloatArray  # states (runs, n) at t = 0, nan where a run has none
    errors: list[str]  # of each run, why it failed, or ""


def group_at(
    plan: Plan, module: GeneratedModule, engine: Engine | None, points: NDArray[np.intp]
) -> Group:
    """Return the runs at points (runs, axes), which have equal inputs and sizes.

    A run that cannot start has the same error as from `simulate`.
    """
    inputs, base = plan.inputs_at(module, points[0]), plan.base_at(module, points[0])
    changed = plan.values_at("parameters", points)
    systems = [DrivenModule(module, replace(base, **values), inputs) for values in changed]
    u = inputs.segments[0].at(0.0)
    start = np.full((len(points), row_count(module.STATES, base)), np.nan)
    errors = [""] * len(points)
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
    """Fill in the errors of runs whose start is outside the domain; C finds them.

    It knows the margins of the domain, not the limits of stops.
    """
    fine = np.zeros(len(systems), dtype=bool)
    if engine and not limited(systems[0].module):
        first = systems[0].inputs.segments[0]
        u = np.ascontiguousarray(first.at(first.start)[None])
        x = np.ascontiguousarray(start[:, None])
        fine = Members(engine, [one.parameters for one in systems]).inside(x, u)[:, 0]
    for k in np.flatnonzero(~fine).tolist():
        if not errors[k]:
            try:
                check_start(systems[k], start[k])
            except PiezoError as error:
                errors[k] = str(error)


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
    u = group.systems[0].inputs.at_samples(plan.samples)
    found = in_c(plan, group, engine, u, watch) if engine else one_by_one(plan, group, watch)
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


def no_results(plan: Plan, group: Group) -> Quantities:
    """Return every quantity of a group's runs, all of them nan."""
    size = len(group.systems), plan.samples[plan.kept].size
    return {
        name: xarray.Variable(
            (MEMBER, *one.dims), np.full((*size, *one.shape[1:]), np.nan), one.attrs
        )
        for name, one in layout(group.systems[0]).items()
    }


def in_c(plan: Plan, group: Group, engine: Engine, u: FloatArray, watch: Watch) -> Quantities:
    """Return every quantity of runs in C; fill in the errors of those that fail.

    As with `simulate`, a run whose inputs leave the domain is an error.
    """
    started = [k for k, error in enumerate(group.errors) if not error]
    if not started:
        return no_results(plan, group)
    systems, x = [group.systems[k] for k in started], group.start[started]
    outside = input_errors(systems, x, plan.samples)
    given = systems, engine, x, plan.samples, plan.step or plan.rtol, watch
    runs = collocate(*given, side_by_side=plan.side_by_side)
    for n, k in enumerate(started):
        stopped = runs.errors[n]
        error = outside[n] or (stopped and cause(systems[n], x[n], plan.samples, stopped))
        group.errors[k] = str(error or "")
    found = of_runs(runs, engine, u, plan.kept)
    if not any(group.errors):
        return found
    whole, good = no_results(plan, group), np.array([not error for error in group.errors])
    for name, one in found.items():
        whole[name].values[good] = one.values[good[started]]
    return whole


def input_errors(
    systems: Sequence[DrivenModule], x: FloatArray, samples: FloatArray
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
    """Return every quantity of runs by SciPy; fill in the errors of those that fail."""
    found = no_results(plan, group)
    for k, system in enumerate(group.systems):
        if group.errors[k]:
            continue
        accuracy = (plan.method, plan.rtol, watch)
        try:
            run, _ = by_scipy(system, group.start[k], plan.samples, *accuracy)
        except PiezoError as error:
            group.errors[k] = str(error)
        else:
            for name, one in of_trajectory(system, run).items():
                found[name].values[k] = one.values[plan.kept]
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
