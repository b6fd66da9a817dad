"""Run one box of a sweep: the work of one task, in a thread or in another process.

Input: the `Plan` of a box, its module.  Output: a `Result`: the quantities of each run, and the
error of each that failed.  Runs with equal inputs and sizes form a `Group`.
"""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any, final

import numpy as np
import xarray
from numpy.typing import NDArray

from piezo_sym.errors import PiezoError, RunError, UsageError
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
    WHERE,
    Quantities,
    all_at_once,
    as_quantities,
    layout,
    of_runs,
    of_trajectory,
    over_time,
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
    """Runs of a plan with equal inputs and sizes."""

    plan: Plan
    engine: Engine | None
    points: NDArray[np.intp]  # (runs, axes)
    systems: Sequence[DrivenModule]
    start: FloatArray  # states (runs, n) at t = 0, nan where there is none
    errors: list[str]  # why each run failed, or ""

    @cached_property
    def u(self) -> FloatArray:
        """The inputs (m, nt) at all samples."""
        return self.systems[0].inputs.at_samples(self.plan.samples)

    def result(self, watch: Watch) -> tuple[Quantities, Quantities]:
        """Return the quantities, and coordinates from a reducing function; fill in errors."""
        plan = self.plan
        quantities = self._in_c(self.engine, watch) if self.engine else self._by_scipy(watch)
        if plan.reduce is None:
            return quantities, {}
        if isinstance(plan.reduce, str):
            return over_time(quantities, weights(plan.samples[plan.kept])), {}
        runs = self._dataset(quantities)
        reduced = (run_by_run if plan.each else all_at_once)(plan.reduce, runs, self.errors)
        if reduced is None:
            return {}, {}
        taken = {name for axis in plan.axes for name, _ in axis.coordinates()}
        if both := sorted({*plan.dims, *taken, "error"} & {*map(str, reduced.variables)}):
            what = f"the function gives '{both[0]}', which the sweep has, too"
            raise UsageError(what, WHERE, "a name of its own")
        return as_quantities(reduced)

    def _blank(self) -> Quantities:
        """Return every quantity of the runs, filled with nan."""
        size = len(self.systems), self.plan.samples[self.plan.kept].size
        quantities = {}
        for name, one in layout(self.systems[0]).items():
            values = np.full((*size, *one.shape[1:]), np.nan)
            quantities[name] = xarray.Variable((MEMBER, *one.dims), values, one.attrs)
        return quantities

    def _in_c(self, engine: Engine, watch: Watch) -> Quantities:
        """Return every quantity of runs in C; fill in the errors of those that fail.

        As with `simulate`, a run whose inputs leave the domain after its start fails.
        """
        plan, errors = self.plan, self.errors
        started = [k for k, error in enumerate(errors) if not error]
        if not started:
            return self._blank()
        systems, x = [self.systems[k] for k in started], self.start[started]
        for k in started if inputs_vary(systems[0]) else ():
            with filled_in(errors, k, RunError):
                check_inputs(self.systems[k], self.start[k], plan.samples)
        given = systems, engine, x, plan.samples, plan.step or plan.rtol, watch
        runs = collocate(*given, side_by_side=plan.side_by_side)
        for n, k in enumerate(started):
            if (stopped := runs.errors[n]) and not errors[k]:
                errors[k] = str(stop_cause(systems[n], x[n], plan.samples, stopped))
        quantities = of_runs(runs, engine, self.u, plan.kept)
        if not any(errors):
            return quantities
        kept = np.array([not error for error in errors])
        padded = self._blank()
        for name, variable in quantities.items():
            padded[name].values[kept] = variable.values[kept[started]]
        return padded

    def _by_scipy(self, watch: Watch) -> Quantities:
        """Return every quantity of runs by SciPy; fill in the errors of those that fail."""
        plan, quantities = self.plan, self._blank()
        for k, system in enumerate(self.systems):
            if self.errors[k]:
                continue
            with filled_in(self.errors, k):
                how = plan.method, plan.rtol, watch
                run, _ = by_scipy(system, self.start[k], plan.samples, *how)
                for name, one in of_trajectory(system, run).items():
                    quantities[name].values[k] = one.values[plan.kept]
        return quantities

    def _dataset(self, quantities: Quantities) -> xarray.Dataset:
        """Return the runs as a Dataset over `member`, for a user's function."""
        system, plan = self.systems[0], self.plan
        module, size = system.module, (len(self.u), len(self.points), plan.samples.size)
        waves = np.broadcast_to(self.u[:, None], size)
        inputs = dict(named_rows(system, (MEMBER, "time"), module.INPUTS, waves))
        coords: dict[str, Any] = dict(coordinates(lane_counts(system), plan.samples))
        for n, axis in enumerate(plan.axes):
            for name, (values, attrs) in axis.coordinates():
                taken = name in quantities or name in inputs or name in coords
                label = f"over_{name}" if taken else name
                coords[label] = (MEMBER, np.asarray(values)[self.points[:, n]], attrs)
        attrs = {"model": module.NAME, "spec_sha256": module.SPEC_SHA256}
        return xarray.Dataset({**quantities, **inputs}, coords, attrs)


@contextmanager
def filled_in(errors: list[str], k: int, kind: type[PiezoError] = PiezoError) -> Iterator[None]:
    """Make an error of the block that of run k, as text; the block ends there."""
    try:
        yield
    except kind as error:
        errors[k] = str(error)


def group_at(
    plan: Plan, module: GeneratedModule, engine: Engine | None, points: NDArray[np.intp]
) -> Group:
    """Return the runs at points (runs, axes), which have equal inputs and sizes.

    A run that cannot start has the same error as from `simulate`. C finds the starts inside the
    domain, but does not check the limits of stops.
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
            with filled_in(errors, k):
                start[k] = read_initial(module, p, u, given) if given else own_initial(module, p, u)
    inside = np.zeros(len(points), dtype=bool)
    if engine and not limited(module):
        members = Members(engine, [one.parameters for one in systems])
        inside = members.inside(np.ascontiguousarray(start[:, None]), u[None])[:, 0]
    for k in np.flatnonzero(~inside).tolist():
        if not errors[k]:
            with filled_in(errors, k):
                check_start(systems[k], start[k])
    return Group(plan, engine, points, systems, start, errors)


def run_box(plan: Plan, module: GeneratedModule, watch: Watch) -> Result:
    """Return the result of the box with this plan; an exception of `watch` ends the work."""
    engine = engine_of(module) if plan.method == METHOD else None
    errors = np.full(plan.size, "", dtype=object)
    all_quantities: Quantities = {}
    all_coords: Quantities = {}
    for runs in plan.groups():
        group = group_at(plan, module, engine, plan.points[runs])
        quantities, coords = group.result(watch)
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
