"""All quantities of many runs, as arrays: computed for a whole group at once.

Input: a `Group` and the trajectories that it left in C, or one `Trajectory` after another.  Output:
by name a `RunQuantity` (runs, time, [lanes]); names, order and units are those of a run's Dataset.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeAlias, final

import numpy as np
from numpy.typing import NDArray

from piezo_sym.run.checks import FloatArray
from piezo_sym.run.dataset import variables
from piezo_sym.run.engine import Engine
from piezo_sym.run.engine.members import Members
from piezo_sym.run.ledger import Trajectory, row_counts
from piezo_sym.run.module import Record, exchanges
from piezo_sym.run.runs import Runs
from piezo_sym.run.system import System


@final
@dataclass(frozen=True)
class RunQuantity:
    """One quantity of many runs.

    Attributes
    ----------
    dims : after that of the runs.
    values : (runs, *dims).
    attrs : units and text.
    """

    dims: tuple[str, ...]
    values: NDArray[Any]
    attrs: Mapping[str, Any]


Quantities: TypeAlias = dict[str, RunQuantity]


def layout(system: System) -> dict[str, tuple[tuple[str, ...], dict[str, Any]]]:
    """Return dimensions and attributes of every quantity of a run, inputs among them, in order."""
    n, m, k = row_counts(system)
    states, inputs, integrals = (np.full((size, 1), np.nan) for size in (n, m, k))
    nothing = Trajectory(np.full(n, np.nan), states, inputs, integrals, 0, 0)
    with np.errstate(all="ignore"):
        return {name: (dims, attrs) for name, (dims, _, attrs) in variables(system, nothing)}


def of_trajectory(system: System, trajectory: Trajectory) -> dict[str, NDArray[Any]]:
    """Return every quantity of one run (1, time, [lanes]), inputs left out."""
    inputs = {record.name for record in system.module.INPUTS}
    found = variables(system, trajectory)
    return {name: np.asarray(values)[None] for name, (_, values, _) in found if name not in inputs}


def of_runs(runs: Runs, engine: Engine, u: FloatArray, kept: slice) -> dict[str, NDArray[Any]]:
    """Return every quantity of runs in C (runs, time, [lanes]), inputs left out.

    Parameters
    ----------
    u : inputs (m, nt) at all samples.
    kept : which samples count.
    """
    with np.errstate(all="ignore"):
        return dict(quantities(runs, engine, np.ascontiguousarray(u[:, kept].T), kept))


def quantities(
    runs: Runs, engine: Engine, u: FloatArray, kept: slice
) -> Iterator[tuple[str, NDArray[Any]]]:
    """Yield the quantities in no certain order; rows of a bank stay together."""
    system = runs.systems[0]
    module = system.module
    call = Members(engine, runs.systems.parameters)
    x, sums = np.ascontiguousarray(runs.states[:, kept]), runs.sums[:, kept]
    ports, exchanging = len(module.OUTPUTS), exchanges(module)
    processes = sum(part.stop - part.start for part in system.rows(module.PROCESSES))
    ends = np.cumsum([ports, processes, processes, len(exchanging)])
    supplied, heat, produced, exchanged, _ = np.split(sums, ends, axis=2)
    first = np.ascontiguousarray(runs.start[:, None])
    yield from spread(system, module.STATES, x)
    yield from spread(system, module.OUTPUTS, call("outputs", x, ports, u), "y_")
    bodies = call("temperatures", x, len(module.BODIES))
    yield from spread(system, module.BODIES, bodies, "T_")
    for name in ("energy", "entropy"):
        yield name, call(name, x, 1)[..., 0]
    yield from spread(system, module.OUTPUTS, supplied, "supplied_")
    yield from spread(system, module.PROCESSES, heat, "heat_")
    yield from spread(system, module.PROCESSES, produced, "produced_")
    brought = [module.OUTPUTS[n] for n in exchanging]
    yield from spread(system, brought, exchanged, "entropy_exchanged_")
    made = np.sum(produced, axis=2) + np.sum(exchanged, axis=2)
    for name, booked in (("energy", np.sum(supplied, axis=2)), ("entropy", made)):
        gained = call(name, x, 1)[..., 0] - call(name, first, 1)[..., 0]
        yield f"{name}_residual", gained - booked


def spread(
    system: System, records: Sequence[Record], values: FloatArray, prefix: str = ""
) -> Iterator[tuple[str, FloatArray]]:
    """Yield the columns of values (runs, time, rows) by record."""
    for record, part in zip(records, system.rows(records), strict=True):
        yield f"{prefix}{record.name}", values[..., part if record.bank else part.start]


def widened(quantity: RunQuantity, lanes: Mapping[str, int]) -> RunQuantity:
    """Return a quantity whose banks have the number of lanes given, the new ones nan."""
    shape = quantity.values.shape[1:]
    more = [
        (0, lanes[dim] - size if dim in lanes else 0)
        for dim, size in zip(quantity.dims, shape, strict=True)
    ]
    if not any(after for _, after in more):
        return quantity
    values = np.pad(quantity.values.astype(float), [(0, 0), *more], constant_values=np.nan)
    return replace(quantity, values=values)
