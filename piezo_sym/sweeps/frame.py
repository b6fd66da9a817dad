"""What surrounds the results of a sweep: coordinates, inputs, attributes, errors.

Input: a `Plan` and its module.  Output: a `Frame`, and from it a Dataset with all but the results.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias, final

import numpy as np

from piezo_sym.errors import UsageError
from piezo_sym.run.dataset import coordinates, described, model_attrs
from piezo_sym.run.parameters import read_parameters
from piezo_sym.run.system import System
from piezo_sym.sweeps.group import inputs_at_point
from piezo_sym.sweeps.quantities import RunQuantity, layout
from piezo_sym.sweeps.reduce import weights

if TYPE_CHECKING:
    from collections.abc import Iterator

    import xarray
    from numpy.typing import NDArray

    from piezo_sym.run.module import GeneratedModule
    from piezo_sym.sweeps.plan import Plan

NOT_RUN = "not run"

Variable: TypeAlias = tuple[tuple[str, ...], Any, dict[str, Any]]


@final
@dataclass(frozen=True)
class Frame:
    """All of a sweep's Dataset but its results.

    Attributes
    ----------
    dims : the swept dimensions, in the user's order.
    shape : their sizes.
    coords : coordinates, those of time and banks among them.
    inputs : waveforms, along the axes that sweep them only.
    names : of the results, in order; none where a function makes them.
    attrs : what was run.
    """

    dims: tuple[str, ...]
    shape: tuple[int, ...]
    coords: dict[str, Variable]
    inputs: dict[str, Variable]
    names: tuple[str, ...]
    attrs: dict[str, Any]

    def dataset(self, data: dict[str, Variable], own: dict[str, RunQuantity]) -> xarray.Dataset:
        """Return a Dataset of results and inputs; `own`: coordinates that a function made."""
        import pandas
        import xarray

        used = {dim for dims, _, _ in data.values() for dim in dims}
        coords = {
            name: variable
            for name, variable in self.coords.items()
            if name in used or name not in ("time", *self.banks)
        }
        made = {name: (one.dims, pandas.Index(one.values), one.attrs) for name, one in own.items()}
        return xarray.Dataset(data, {**coords, **made}, self.attrs)

    @property
    def banks(self) -> tuple[str, ...]:
        """The dimensions of banks."""
        return tuple(n for n, (dims, _, _) in self.coords.items() if dims == (n,) and n != "time")


def frame_of(plan: Plan, module: GeneratedModule) -> Frame:
    """Return the frame of a sweep.

    Raises
    ------
    UsageError : two quantities would have one name.
    """
    system = widest(plan, module)
    known = layout(system)
    inputs = dict(inputs_of(plan, module, system, known))
    results = [name for name in known if name not in {r.name for r in module.INPUTS}]
    coords: dict[str, Variable] = dict(coordinates(system, plan.samples))
    taken = [*coords, *inputs, *(results if not callable(plan.reduce) else ()), "error"]
    for axis in plan.axes:
        for name, (values, attrs) in axis.coordinates():
            if name in taken:
                what = f"the coordinate '{name}' has the name of another quantity"
                raise UsageError(what, "sweep.over", remedy="rename one in the spec")
            taken.append(name)
            coords[name] = ((axis.dim,), index(values), attrs)
    return Frame(
        tuple(axis.dim for axis in plan.axes),
        plan.shape,
        coords,
        inputs if not callable(plan.reduce) else {},
        tuple(results),
        attrs_of(plan, system),
    )


def index(values: Any) -> Any:
    """Return labels as xarray takes them without a try of other libraries."""
    import pandas

    return pandas.Index(values)


def widest(plan: Plan, module: GeneratedModule) -> System:
    """Return a system whose banks have the most lanes that the sweep gives them."""
    sizes = {f"{bank}_count": size for bank, size in plan.largest_banks.items()}
    base = read_parameters(module, {**plan.parameters, **sizes})
    return System(module, base, inputs_at_point(plan, module, first_point(plan)))


def first_point(plan: Plan) -> NDArray[np.intp]:
    """Return the first point of the grid."""
    return np.zeros(len(plan.axes), dtype=np.intp)


def inputs_of(
    plan: Plan, module: GeneratedModule, system: System, known: dict[str, Any]
) -> Iterator[tuple[str, Variable]]:
    """Yield each input over time, or its last or mean value; swept ones are named `u_<input>`."""
    swept = {target.name: n for n, target in plan.swept() if target.kind == "inputs"}
    for row, record in enumerate(module.INPUTS):
        attrs = known[record.name][1]
        if record.name not in swept:
            wave = reduced(plan, system.inputs.at_samples(plan.samples)[row])
            yield record.name, (("time",)[: wave.ndim], wave, attrs)
            continue
        n = swept[record.name]
        waves = []
        for k in range(plan.axes[n].size):
            point = first_point(plan)
            point[n] = k
            here = System(module, system.parameters, inputs_at_point(plan, module, point))
            waves.append(reduced(plan, here.inputs.at_samples(plan.samples)[row]))
        dims = (plan.axes[n].dim, *("time",)[: waves[0].ndim])
        yield f"u_{record.name}", (dims, np.array(waves), attrs)


def reduced(plan: Plan, wave: Any) -> Any:
    """Return a waveform (nt,) as the plan's reduction keeps it."""
    if plan.reduce == "last":
        return wave[-1]
    return np.asarray(wave @ weights(plan.samples)) if plan.reduce == "mean" else wave


def attrs_of(plan: Plan, system: System) -> dict[str, Any]:
    """Return the attributes of the Dataset: model, parameters that are not swept, method."""
    swept = {f"parameter_{t.name}" for _, t in plan.swept() if t.kind == "parameters"}
    attrs = {name: value for name, value in model_attrs(system).items() if name not in swept}
    accuracy: dict[str, Any] = {"rtol": plan.rtol}
    if plan.step:
        accuracy = {"step": plan.step.length, "order": plan.step.order}
    kept = plan.reduce if isinstance(plan.reduce, str) else ""
    reduction = {"reduction": kept} if kept else {}
    done = {"method": plan.method, **accuracy, **reduction, "duration": plan.duration}
    return {**attrs, **done, "engine": plan.engine}


ERROR_ATTRS = described("1", "why a run failed; empty where it did not") | {"missing": NOT_RUN}
