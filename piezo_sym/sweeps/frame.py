"""The Dataset of a sweep: its coordinates, inputs and attributes, and its results.

Input: a `Plan`, its module; `Result` records.  Output: the frame, a Dataset without results and
errors; and `Results`, which add them, in `Memory` or in a store on disk (`store`).
"""

from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator
from typing import Any, TypeAlias, final

import numpy as np
import pandas
import xarray

from piezo_sym.errors import UsageError
from piezo_sym.run.dataset import attributes, coordinates, lane_counts, model_attrs, named_rows
from piezo_sym.run.module import GeneratedModule
from piezo_sym.run.parameters import read_parameters
from piezo_sym.run.system import DrivenModule
from piezo_sym.sweeps.plan import Plan, Region
from piezo_sym.sweeps.reduce import layout, refuse_other_names, refuse_other_sizes, weights
from piezo_sym.sweeps.run import Result

Shape: TypeAlias = tuple[int, ...]
NOT_RUN = "not run"
ERROR_ATTRS = attributes("1", "why a run failed; empty where it did not") | {"missing": NOT_RUN}


def frame_of(plan: Plan, module: GeneratedModule) -> xarray.Dataset:
    """Return the frame of a sweep; without time and banks where the reduction removes them."""
    sizes = {f"{bank}_count": size for bank, size in plan.largest_banks.items()}
    base = read_parameters(module, {**plan.parameters, **sizes})
    system = DrivenModule(module, base, plan.inputs_at(module, plan.points[0]))
    by_function = callable(plan.reduce)
    inputs = dict(inputs_of(plan, system))
    coords = dict(coordinates(lane_counts(system), plan.samples))
    taken = {*coords, *inputs, "error", *(() if by_function else layout(system))}
    for axis in plan.axes:
        for name, (values, attrs) in axis.coordinates():
            if name in taken:
                what = f"the coordinate '{name}' has the name of another quantity"
                raise UsageError(what, "sweep.over", remedy="rename one in the spec")
            taken.add(name)
            # as an index: of an array, xarray first tries to import other array libraries
            coords[name] = ((axis.dim,), pandas.Index(values), attrs)
    if plan.reduce is not None:
        del coords["time"]
    for bank in set(module.BANKS) - {*plan.largest_banks} if by_function else ():
        del coords[bank]
    return xarray.Dataset({} if by_function else inputs, coords, attrs_of(plan, system))


def inputs_of(plan: Plan, system: DrivenModule) -> Iterator[tuple[str, xarray.Variable]]:
    """Yield each input over time, or its last or mean value; swept ones are named `u_<input>`."""
    module = system.module
    swept = {target.name: n for n, target in plan.swept() if target.kind == "inputs"}
    u = system.inputs.at_samples(plan.samples)
    named = enumerate(named_rows(system, ("time",), module.INPUTS, u))
    for row, (name, (dims, wave, attrs)) in named:
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
    attrs["method"] = plan.method
    if plan.step:
        attrs |= {"step": plan.step.length, "order": plan.step.order}
    else:
        attrs["rtol"] = plan.rtol
    if isinstance(plan.reduce, str):
        attrs["reduction"] = plan.reduce
    return {**attrs, "duration": plan.duration, "engine": plan.engine}


class Results(ABC):
    """Collects the results of boxes in arrays over the grid."""

    _arrays: Any  # by name, with the errors

    def __init__(self, plan: Plan) -> None:
        self._plan = plan
        self._names: list[str] = []  # of quantities, after the first result with some

    def take(self, region: Region, result: Result) -> None:
        """Store the result of a box; its errors last."""
        grid, quantities = len(region), result.quantities
        if self._names and quantities:
            refuse_other_names(self._names, quantities)
        for name, variable in result.coords.items():
            if name not in self._arrays:
                self._add(name, variable, variable.shape, variable.shape)
                self._arrays[name][...] = variable.values
        for name, variable in quantities.items():
            sizes = variable.shape[grid:]
            if name not in self._arrays:
                shapes = self._plan.shape, self._plan.box_shape
                self._add(name, variable, *((*shape, *sizes) for shape in shapes))
            refuse_other_sizes(name, self._arrays[name].shape[grid:], sizes)
            self._arrays[name][region] = variable.values
        self._names = self._names or list(quantities)
        self._arrays["error"][region] = result.errors

    @abstractmethod
    def _add(self, name: str, like: xarray.Variable, shape: Shape, chunks: Shape) -> None:
        """Add an array with the dimensions, type and attributes of `like`, nan if not written."""

    @abstractmethod
    def missing(self) -> Iterable[Region]:
        """Return the boxes without results."""

    @abstractmethod
    def dataset(self) -> xarray.Dataset:
        """Return all results; only errors, if every run failed."""


@final
class Memory(Results):
    """Keeps results in memory."""

    def __init__(self, plan: Plan, frame: xarray.Dataset) -> None:
        super().__init__(plan)
        self._frame = frame
        errors = np.full(plan.shape, NOT_RUN, dtype=object)
        self._arrays = {"error": errors}
        self._variables = {"error": xarray.Variable(plan.dims, errors, ERROR_ATTRS)}

    def _add(self, name: str, like: xarray.Variable, shape: Shape, chunks: Shape) -> None:  # noqa: ARG002
        array = np.full(shape, np.nan if like.dtype.kind == "f" else 0, like.dtype)
        self._arrays[name] = array
        self._variables[name] = xarray.Variable(like.dims, array, like.attrs)

    def missing(self) -> Iterable[Region]:
        """Return all boxes."""
        return self._plan.regions()

    def dataset(self) -> xarray.Dataset:
        """Return all results."""
        names = *self._names, "error"
        coords = {name: v for name, v in self._variables.items() if name not in names}
        quantities = {name: self._variables[name] for name in names}
        dataset = self._frame.assign_coords(coords).assign(quantities)
        return dataset[[*self._names, *self._frame.data_vars, "error"]]
