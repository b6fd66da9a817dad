"""All quantities of many runs, as arrays computed for a whole group at once.

Input: runs in C, or the `Trajectory` of one run.  Output: arrays (runs, time, [lanes]), with the
names that `simulate` gives them; `layout` gives their dimensions, order and units.
"""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import xarray
from numpy.typing import NDArray

from piezo_sym.run.checks import FloatArray
from piezo_sym.run.collocation import Runs
from piezo_sym.run.dataset import variables
from piezo_sym.run.engine import Engine
from piezo_sym.run.engine.engine import Members
from piezo_sym.run.ledger import Trajectory, row_counts
from piezo_sym.run.module import Record, exchanges
from piezo_sym.run.system import DrivenModule


def layout(system: DrivenModule) -> dict[str, xarray.Variable]:
    """Return every quantity of a run but its inputs, in order, at one sample and without values."""
    n, m, k = row_counts(system)
    states, inputs, integrals = (np.full((size, 1), np.nan) for size in (n, m, k))
    with np.errstate(all="ignore"):
        return of_trajectory(
            system, Trajectory(np.full(n, np.nan), states, inputs, integrals, 0, 0)
        )


def of_trajectory(system: DrivenModule, trajectory: Trajectory) -> dict[str, xarray.Variable]:
    """Return every quantity of one run (time, [lanes]), inputs left out."""
    inputs = {record.name for record in system.module.INPUTS}
    found = variables(system, trajectory)
    return {name: xarray.Variable(*parts) for name, parts in found if name not in inputs}


def of_runs(runs: Runs, engine: Engine, u: FloatArray, kept: slice) -> dict[str, NDArray[Any]]:
    """Return every quantity of runs in C (runs, time, [lanes]), inputs left out.

    Parameters
    ----------
    u : inputs (m, nt) at all samples.
    kept : the samples to return.
    """
    with np.errstate(all="ignore"):
        return dict(quantities(runs, engine, np.ascontiguousarray(u[:, kept].T), kept))


def quantities(
    runs: Runs, engine: Engine, u: FloatArray, kept: slice
) -> Iterator[tuple[str, NDArray[Any]]]:
    """Yield the quantities, in an order of no meaning."""
    system = runs.systems[0]
    module = system.module
    call = Members(engine, runs.systems.parameters)
    x, sums = np.ascontiguousarray(runs.states[:, kept]), runs.sums[:, kept]
    ports, exchanging = len(module.OUTPUTS), exchanges(module)
    processes = sum(part.stop - part.start for part in system.rows(module.PROCESSES))
    ends = np.cumsum([ports, processes, processes, len(exchanging)])
    supplied, heat, produced, exchanged, _ = np.split(sums, ends, axis=2)
    first = np.ascontiguousarray(runs.start[:, None])
    yield from by_record(system, module.STATES, x)
    yield from by_record(system, module.OUTPUTS, call("outputs", x, ports, u), "y_")
    bodies = call("temperatures", x, len(module.BODIES))
    yield from by_record(system, module.BODIES, bodies, "T_")
    for name in ("energy", "entropy"):
        yield name, call(name, x, 1)[..., 0]
    yield from by_record(system, module.OUTPUTS, supplied, "supplied_")
    yield from by_record(system, module.PROCESSES, heat, "heat_")
    yield from by_record(system, module.PROCESSES, produced, "produced_")
    brought = [module.OUTPUTS[n] for n in exchanging]
    yield from by_record(system, brought, exchanged, "entropy_exchanged_")
    made = np.sum(produced, axis=2) + np.sum(exchanged, axis=2)
    for name, booked in (("energy", np.sum(supplied, axis=2)), ("entropy", made)):
        gained = call(name, x, 1)[..., 0] - call(name, first, 1)[..., 0]
        yield f"{name}_residual", gained - booked


def by_record(
    system: DrivenModule, records: Sequence[Record], values: FloatArray, prefix: str = ""
) -> Iterator[tuple[str, FloatArray]]:
    """Yield the columns of values (runs, time, rows) by record."""
    for record, part in zip(records, system.rows(records), strict=True):
        yield f"{prefix}{record.name}", values[..., part if record.bank else part.start]
