"""The Dataset of a sweep: coordinates, inputs, attributes, and results as they come in memory.

Input: a `Plan`, its module; `Result` records.  Output: a Dataset with all but the results and their
errors; and `Results`, which give it with them: in `Memory`, or in a store on disk (`store`).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator
from typing import Any, TypeAlias, final

import numpy as np
import pandas
import xarray

from piezo_sym.errors import UsageError
from piezo_sym.run.dataset import coordinates, described, model_attrs, spread
from piezo_sym.run.module import GeneratedModule
from piezo_sym.run.parameters import read_parameters
from piezo_sym.run.system import DrivenModule
from piezo_sym.sweeps.plan import Plan, Region
from piezo_sym.sweeps.reduce import layout, refuse_other_names, refuse_other_sizes, weights
from piezo_sym.sweeps.run import Result

Shape: TypeAlias = tuple[int, ...]
NOT_RUN = "not run"
ERROR_ATTRS = described("1", "why a run failed; empty where it did not") | {"missing": NOT_RUN}


def frame_of(plan: Plan, module: GeneratedModule) -> xarray.Dataset:
    """Return the frame of a sweep; time and banks only where its results have them."""
    sizes = {f"{bank}_count": size for bank, size in plan.largest_banks.items()}
    base = read_parameters(module, {**plan.parameters, **sizes})
    system = DrivenModule(module, base, plan.inputs_at(module, plan.points[0]))
    own = callable(plan.reduce)
    inputs = dict(inputs_of(plan, module, system))
    coords = dict(coordinates(system, plan.samples))
    taken = {*coords, *inputs, "error", *(() if own else layout(system))}
    for axis in plan.axes:
        for name, (values, attrs) in axis.coordinates():
            if name in taken:
                what = f"the coordinate '{name}' has the name of another quantity"
                raise UsageError(what, "sweep.over", remedy="rename one in the spec")
            taken.add(name)
            # as an index: of an array, xarray first tries to import other array libraries
            coords[name] = ((axis.dim,), pandas.Index(values), attrs)
    left_out = {*(() if plan.reduce is None else ("time",))}
    left_out |= {bank for bank in module.BANKS if own and bank not in plan.largest_banks}
    needed = {name: variable for name, variable in coords.items() if name not in left_out}
    return xarray.Dataset({} if own else inputs, needed, attrs_of(plan, system))


def inputs_of(
    plan: Plan, module: GeneratedModule, system: DrivenModule
) -> Iterator[tuple[str, xarray.Variable]]:
    """Yield each input over time, or its last or mean value; swept ones are named `u_<input>`."""
    swept = {target.name: n for n, target in plan.swept() if target.kind == "inputs"}
    waves = system.inputs.at_samples(plan.samples)
    for row, (name, (dims, wave, attrs)) in enumerate(
        spread(system, ("time",), module.INPUTS, waves)
    ):
        if name not in swept:
            yield name, reduced(plan, xarray.Variable(dims, wave, attrs))
            continue
        axis = swept[name]
        points = np.arange(plan.shape[axis])[:, None] * np.eye(len(plan.axes), dtype=int)[axis]
        along = [plan.inputs_at(module, point).at_samples(plan.samples)[row] for point in points]
        over = (plan.dims[axis], *dims)
        yield f"u_{name}", reduced(plan, xarray.Variable(over, np.array(along), attrs))


def reduced(plan: Plan, wave: xarray.Variable) -> xarray.Variable:
    """Return an input (..., nt) reduced over time as the plan says."""
    if not isinstance(plan.reduce, str):
        return wave
    mean = np.asarray(wave.values[..., plan.kept] @ weights(plan.samples[plan.kept]))
    return xarray.Variable(wave.dims[:-1], mean, wave.attrs)


def attrs_of(plan: Plan, system: DrivenModule) -> dict[str, Any]:
    """Return the attributes of the Dataset: model, parameters that are not swept, method."""
    swept = {f"parameter_{t.name}" for _, t in plan.swept() if t.kind == "parameters"}
    attrs = {name: value for name, value in model_attrs(system).items() if name not in swept}
    accuracy: dict[str, Any] = {"rtol": plan.rtol}
    if plan.step:
        accuracy = {"step": plan.step.length, "order": plan.step.order}
    reduction = {"reduction": plan.reduce} if isinstance(plan.reduce, str) else {}
    done = {"method": plan.method, **accuracy, **reduction, "duration": plan.duration}
    return {**attrs, **done, "engine": plan.engine}


class Results(ABC):
    """Results of a sweep as they come, in arrays over the grid."""

    _arrays: Any  # by name, the errors among them

    def __init__(self, plan: Plan) -> None:
        self._plan = plan
        self._names: list[str] = []  # of quantities, once there are some

    def take(self, region: Region, result: Result) -> None:
        """Keep the result of a box; its errors last."""
        grid, found = len(region), result.quantities
        if self._names and found:
            refuse_other_names(self._names, found)
        for name, one in result.coords.items():
            if name not in self._arrays:
                self._add(name, one, one.shape, one.shape)
                self._arrays[name][...] = one.values
        for name, one in found.items():
            own = one.shape[grid:]
            if name not in self._arrays:
                shapes = self._plan.shape, self._plan.box_shape
                self._add(name, one, *((*shape, *own) for shape in shapes))
            refuse_other_sizes(name, self._arrays[name].shape[grid:], own)
            self._arrays[name][region] = one.values
        self._names = self._names or list(found)
        self._arrays["error"][region] = result.errors

    @abstractmethod
    def _add(self, name: str, one: xarray.Variable, shape: Shape, chunks: Shape) -> None:
        """Add an array for a quantity like this one, nan where nothing is written."""

    @abstractmethod
    def missing(self) -> Iterable[Region]:
        """Return the boxes without results."""

    @abstractmethod
    def dataset(self) -> xarray.Dataset:
        """Return all results; only errors, if the reduction never ran."""


@final
class Memory(Results):
    """Keeps results in memory."""

    def __init__(self, plan: Plan, frame: xarray.Dataset) -> None:
        super().__init__(plan)
        self._frame = frame
        errors = np.full(plan.shape, "", dtype=object)
        self._arrays = {"error": errors}
        self._variables = {"error": xarray.Variable(plan.dims, errors, ERROR_ATTRS)}

    def _add(self, name: str, one: xarray.Variable, shape: Shape, chunks: Shape) -> None:  # noqa: ARG002
        room = np.full(shape, np.nan if one.dtype.kind == "f" else 0, one.dtype)
        self._arrays[name] = room
        self._variables[name] = xarray.Variable(one.dims, room, one.attrs)

    def missing(self) -> Iterable[Region]:
        """Return all boxes."""
        return self._plan.regions()

    def dataset(self) -> xarray.Dataset:
        """Return all results."""
        coords = {n: v for n, v in self._variables.items() if n not in (*self._names, "error")}
        found = {name: self._variables[name] for name in (*self._names, "error")}
        whole = self._frame.assign_coords(coords).assign(found)
        return whole[[*self._names, *self._frame.data_vars, "error"]]
