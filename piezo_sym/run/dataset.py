"""The Dataset of a run: every quantity by name, with units, ready for netCDF.

Input: a `DrivenModule`, the sample times (nt,), a `Trajectory`.  Output: an `xarray.Dataset` with
coordinate `time` [s] and, for each bank, its lanes 1..r under the element's name.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from piezo_sym.errors import UsageError, quote
from piezo_sym.run.module import exchanges, lanes, verdict_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    import pandas
    import xarray
    from numpy.typing import NDArray

    from piezo_sym.run.checks import FloatArray
    from piezo_sym.run.ledger import Trajectory
    from piezo_sym.run.module import Record
    from piezo_sym.run.system import DrivenModule

Variable: TypeAlias = tuple[tuple[str, ...], "NDArray[Any] | pandas.Index[Any]", dict[str, Any]]
Named: TypeAlias = tuple[str, Variable]

ENERGY_LEFT = "U - U(0) - energy put in"
ENTROPY_LEFT = "S - S(0) - entropy produced - entropy exchanged"


def to_dataset(
    system: DrivenModule, times: FloatArray, trajectory: Trajectory, attrs: Mapping[str, Any]
) -> xarray.Dataset:
    """Return a run as a Dataset; `attrs` are added to its own attributes."""
    import xarray

    coords = dict(coordinates(system, times))
    data: dict[str, Variable] = {}
    for name, variable in variables(system, trajectory):
        if name in data or name in coords:
            what = f"two quantities are named '{name}'"
            raise UsageError(what, f"model '{system.module.NAME}'", remedy="rename one in the spec")
        data[name] = variable
    return xarray.Dataset(data, coords, model_attrs(system) | dict(attrs))


def model_attrs(system: DrivenModule) -> dict[str, Any]:
    """Return the attributes that say what was run: the model and the parameters used."""
    used = vars(system.parameters).items()
    parameters = {f"parameter_{name}": np.asarray(value)[()] for name, value in used}
    module = system.module
    told = {"model": module.NAME, "spec_sha256": module.SPEC_SHA256, "proofs": verdict_of(module)}
    return {**told, **parameters}


def coordinates(system: DrivenModule, times: FloatArray) -> Iterator[Named]:
    """Yield the time and the lanes of each bank.

    As pandas indexes: xarray makes them of arrays only after trying to import pint.
    """
    import pandas

    yield "time", (("time",), pandas.Index(times), described("s", "time"))
    for bank in system.module.BANKS:
        numbers = pandas.RangeIndex(1, lanes(system.parameters, bank) + 1)
        yield bank, ((bank,), numbers, described("1", f"lane of bank '{bank}'"))


def variables(system: DrivenModule, trajectory: Trajectory) -> Iterator[Named]:
    """Yield every variable of the Dataset, in order."""
    yield from instants(system, trajectory)
    yield from ledger(system, trajectory)


def instants(system: DrivenModule, trajectory: Trajectory) -> Iterator[Named]:
    """Yield what states and inputs at one time decide, over time."""
    module, p = system.module, system.parameters
    x, u = trajectory.states, trajectory.inputs
    yield from spread(system, module.STATES, x)
    yield from spread(system, module.INPUTS, u)
    yield from spread(system, module.OUTPUTS, module.outputs(x, u, p), "y_")
    yield from spread(system, module.BODIES, module.temperatures(x, p), "T_")
    yield "energy", (("time",), module.energy(x, p), described("J", "energy U"))
    yield "entropy", (("time",), module.entropy(x, p), described("J/K", "entropy S"))


def ledger(system: DrivenModule, trajectory: Trajectory) -> Iterator[Named]:
    """Yield what the ports and processes did since t = 0, and what the two balances leave over."""
    module, p, start = system.module, system.parameters, trajectory.start
    x = trajectory.states
    supplied, heat, produced, exchanged = integrals(system, trajectory)
    made = np.sum(produced, axis=0) + np.sum(exchanged, axis=0)
    brought = [module.OUTPUTS[n] for n in exchanges(module)]
    yield from spread(system, module.OUTPUTS, supplied, "supplied_", ("J", "energy put in by {}"))
    yield from spread(system, module.PROCESSES, heat, "heat_", ("J", "heat released by {}"))
    yield from spread(
        system, module.PROCESSES, produced, "produced_", ("J/K", "entropy produced by {}")
    )
    yield from spread(
        system, brought, exchanged, "entropy_exchanged_", ("J/K", "entropy brought by {}")
    )
    if trajectory.numerical is not None:
        yield from numerical(trajectory.numerical, system.inputs.start)
        made = made + trajectory.numerical[1]
    energy = module.energy(x, p) - module.energy(start, p) - np.sum(supplied, axis=0)
    entropy = module.entropy(x, p) - module.entropy(start, p) - made
    yield "energy_residual", (("time",), energy, described("J", f"{ENERGY_LEFT}"))
    yield "entropy_residual", (("time",), entropy, described("J/K", f"{ENTROPY_LEFT}"))


def integrals(system: DrivenModule, trajectory: Trajectory) -> list[FloatArray]:
    """Return what was supplied, released as heat, produced and exchanged, rows (., nt) each."""
    module = system.module
    processes = system.rows(module.PROCESSES)
    ports, size = len(module.OUTPUTS), processes[-1].stop if processes else 0
    return np.split(trajectory.integrals, np.cumsum([ports, size, size]))


def numerical(rows: FloatArray, start: float) -> Iterator[Named]:
    """Yield heat and entropy production of dissipative starts."""
    about = f"by dissipative starts since t = {start:g}"
    yield "heat_numerical", (("time",), rows[0], described("J", f"heat released {about}"))
    text = f"entropy produced {about}"
    yield "produced_numerical", (("time",), rows[1], described("J/K", text))


def spread(
    system: DrivenModule,
    records: Sequence[Record],
    values: FloatArray,
    prefix: str = "",
    integral: tuple[str, str] | None = None,
) -> Iterator[Named]:
    """Yield the rows of `values` (rows, nt) by record; `integral`: its unit and text."""
    for record, part in zip(records, system.rows(records), strict=True):
        attrs = described(record.unit, record.doc or record.name)
        if integral:
            unit, text = integral[0], integral[1].format(quote(record.name))
            attrs = described(unit, f"{text} since t = {system.inputs.start:g}")
        dims = ("time", record.bank) if record.bank else ("time",)
        yield (
            f"{prefix}{record.name}",
            (dims, values[part].T if record.bank else values[part.start], attrs),
        )


def described(unit: str, long_name: str) -> dict[str, Any]:
    """Return the attributes of a variable."""
    return {"units": unit, "long_name": long_name}
