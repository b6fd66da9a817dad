"""Runs with equal inputs and sizes: their systems and initial states.

Input: a `Plan`, its module, points of the grid.  Output: a `Group`.  A run that cannot start has
the same error as from `simulate`.
"""

from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from piezo_sym.errors import PiezoError, RunError
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.engine.engine import Engine, Members
from piezo_sym.run.guard import check_start
from piezo_sym.run.inputs import Inputs
from piezo_sym.run.module import GeneratedModule, rows
from piezo_sym.run.parameters import own_initial, read_parameters
from piezo_sym.run.signals import Constant, Signal
from piezo_sym.run.system import Column, DrivenModules, ParameterTable
from piezo_sym.sweeps.plan import Plan
from piezo_sym.sweeps.targets import Target


@final
@dataclass(frozen=True)
class Group:
    """Runs with equal inputs and sizes."""

    systems: DrivenModules
    start: FloatArray  # states (runs, n) at t = 0
    errors: list[str]  # of each run, why it cannot start, or ""


def group_at(
    plan: Plan, module: GeneratedModule, engine: Engine | None, points: NDArray[np.intp]
) -> Group:
    """Return the runs at points (runs, axes), which have equal inputs and sizes."""
    inputs = inputs_at_point(plan, module, points[0])
    base = base_at_point(plan, module, points[0])
    columns = {
        target.name: along(target, points[:, n])
        for n, target in plan.swept()
        if target.kind == "parameters" and not target.is_size
    }
    systems = DrivenModules(module, ParameterTable(base, len(points), columns), inputs)
    start, errors = starts(plan, systems, points)
    check_starts(systems, engine, start, errors)
    return Group(systems, start, errors)


@final
class Read:
    """Parameters that record which of them are read."""

    def __init__(self, parameters: Any) -> None:
        self.parameters, self.names = parameters, set[str]()

    def __getattr__(self, name: str) -> Any:
        """Return a parameter."""
        self.names.add(name)
        return getattr(self.parameters, name)


def along(target: Target, points: NDArray[np.intp]) -> Column:
    """Return a target's values at points of its axis."""
    if isinstance(target.values, np.ndarray):
        return target.values[points]
    return [target.values[n] for n in points]


def inputs_at_point(plan: Plan, module: GeneratedModule, point: NDArray[np.intp]) -> Inputs:
    """Return the inputs of the runs at a point."""
    names = [record.name for record in module.INPUTS]
    signals = list(plan.signals)
    for n, target in plan.swept():
        if target.kind == "inputs":
            value = target.values[point[n]]
            signal = value if isinstance(value, Signal) else Constant(float(value))
            signals[names.index(target.name)] = signal
    return Inputs(tuple(signals), plan.duration)


def base_at_point(plan: Plan, module: GeneratedModule, point: NDArray[np.intp]) -> Any:
    """Return the parameters of the runs at a point: swept sizes, but no other swept values."""
    sizes = {t.name: int(t.values[point[n]]) for n, t in plan.swept() if t.is_size}
    return read_parameters(module, {**plan.parameters, **sizes})


def starts(
    plan: Plan, systems: DrivenModules, points: NDArray[np.intp]
) -> tuple[FloatArray, list[str]]:
    """Return the states (runs, n) at t = 0, nan where there is none, and the errors.

    If the initial state reads no swept parameter, it is computed once for all runs.
    """
    first = systems[0]
    module, u = first.module, first.inputs.segments[0].at(0.0)
    read = Read(first.parameters)
    own = started(module, read, u)
    found = [own] * len(systems)
    if not read.names.isdisjoint(systems.parameters.columns):
        found = [started(module, p, u) for p in systems.parameters]
    parts = dict(zip((r.name for r in module.STATES), first.rows(module.STATES), strict=True))
    size = rows(module.STATES, first.parameters)[-1].stop if module.STATES else 0
    start = np.array([np.full(size, np.nan) if isinstance(x, str) else x for x in found])
    for name, value in plan.initial.items():
        start[:, parts[name]] = value
    for n, target in plan.swept():
        if target.kind == "initial":
            for k, one in enumerate(along(target, points[:, n])):
                start[k, parts[target.name]] = one
    return start, [x if isinstance(x, str) else "" for x in found]


def started(module: GeneratedModule, parameters: Any, u: FloatArray) -> FloatArray | str:
    """Return the module's state (n,) at t = 0, or why it has none."""
    try:
        return own_initial(module, parameters, u)
    except RunError as error:
        return str(error)


def check_starts(
    systems: DrivenModules, engine: Engine | None, start: FloatArray, errors: list[str]
) -> None:
    """Fill in the errors of runs whose start is outside the domain; C finds them."""
    fine = np.zeros(len(systems), dtype=bool)
    if engine:
        first = systems.inputs.segments[0]
        u = np.ascontiguousarray(first.at(first.start)[None])
        x = np.ascontiguousarray(start[:, None])
        fine = Members(engine, systems.parameters).inside(x, u)[:, 0]
    for k in np.flatnonzero(~fine).tolist():
        if not errors[k]:
            try:
                check_start(systems[k], start[k])
            except PiezoError as error:
                errors[k] = str(error)
