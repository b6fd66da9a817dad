"""The Dataset of a sweep: coordinates, inputs, attributes, and results as they come in memory.

Input: a `Plan`, its module; `Result` records.  Output: a Dataset with all but the results and their
errors; and with them.  `store` collects results on disk: it has the three methods of `Memory`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any, final

import numpy as np
import pandas
import xarray
from numpy.typing import NDArray

from piezo_sym.errors import UsageError
from piezo_sym.run.dataset import coordinates, described, model_attrs, spread
from piezo_sym.run.module import GeneratedModule
from piezo_sym.run.parameters import read_parameters
from piezo_sym.run.system import DrivenModule
from piezo_sym.sweeps.group import inputs_at_point
from piezo_sym.sweeps.plan import Plan, Region
from piezo_sym.sweeps.reduce import layout, refuse_other_names, refuse_other_sizes, weights
from piezo_sym.sweeps.run import Result

NOT_RUN = "not run"
ERROR_ATTRS = described("1", "why a run failed; empty where it did not") | {"missing": NOT_RUN}


def frame_of(plan: Plan, module: GeneratedModule) -> xarray.Dataset:
    """Return the frame of a sweep; time and banks only where its results have them."""
    system, own = widest(plan, module), callable(plan.reduce)
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


def widest(plan: Plan, module: GeneratedModule) -> DrivenModule:
    """Return a system whose banks have the most lanes that the sweep gives them."""
    sizes = {f"{bank}_count": size for bank, size in plan.largest_banks.items()}
    base = read_parameters(module, {**plan.parameters, **sizes})
    return DrivenModule(module, base, inputs_at_point(plan, module, origin(plan)))


def origin(plan: Plan) -> NDArray[np.intp]:
    """Return the first point of the grid."""
    return np.zeros(len(plan.axes), dtype=np.intp)


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
        step = origin(plan)
        step[swept[name]] = 1
        along = [
            inputs_at_point(plan, module, k * step).at_samples(plan.samples)[row]
            for k in range(plan.shape[swept[name]])
        ]
        over = (plan.dims[swept[name]], *dims)
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


def write(array: Any, region: Region, name: str, one: xarray.Variable) -> None:
    """Write a quantity of a box into an array over the grid."""
    refuse_other_sizes(name, array.shape[len(region) :], one.shape[len(region) :])
    array[region] = one.values


@final
class Memory:
    """Keeps results in arrays over the grid."""

    def __init__(self, plan: Plan, frame: xarray.Dataset) -> None:
        self._plan, self._frame = plan, frame
        self._errors = np.full(plan.shape, "", dtype=object)
        self._found: dict[str, xarray.Variable] = {}
        self._coords: dict[str, xarray.Variable] = {}

    def missing(self) -> Iterable[Region]:
        """Return all boxes."""
        return self._plan.regions()

    def take(self, region: Region, result: Result) -> None:
        """Keep the result of a box."""
        self._errors[region] = result.errors
        self._coords = result.coords or self._coords
        if self._found and result.quantities:
            refuse_other_names(self._found, result.quantities)
        for name, one in result.quantities.items():
            if name not in self._found:
                shape = (*self._plan.shape, *one.shape[len(region) :])
                # a function that fails for a whole box leaves nan
                room = np.full(shape, np.nan) if callable(self._plan.reduce) else np.empty(shape)
                self._found[name] = xarray.Variable(one.dims, room, one.attrs)
            write(self._found[name].values, region, name, one)

    def dataset(self) -> xarray.Dataset:
        """Return all results; only errors, if the reduction never ran."""
        errors = xarray.Variable(self._plan.dims, self._errors, ERROR_ATTRS)
        found = self._frame.assign_coords(self._coords).assign({**self._found, "error": errors})
        return found[[*self._found, *self._frame.data_vars, "error"]]
