"""All quantities of many runs, as arrays computed for a whole group at once.

Input: runs in C, or the `Trajectory` of one run.  Output: quantities over (runs, time, [lanes]),
inputs left out, with the names that `simulate` gives them.
"""

from dataclasses import replace

import numpy as np
import xarray

from piezo_sym.run.checks import FloatArray
from piezo_sym.run.collocation import Runs
from piezo_sym.run.dataset import Known
from piezo_sym.run.engine.engine import Engine, Members
from piezo_sym.run.ledger import Trajectory, row_counts
from piezo_sym.run.system import DrivenModule
from piezo_sym.sweeps.reduce import MEMBER, Quantities


def layout(system: DrivenModule) -> Quantities:
    """Return every quantity of a run, in order, at one sample and without values."""
    n, m, k = row_counts(system)
    states, inputs, integrals = (np.full((size, 1), np.nan) for size in (n, m, k))
    with np.errstate(all="ignore"):
        return of_trajectory(
            system, Trajectory(np.full(n, np.nan), states, inputs, integrals, 0, 0)
        )


def of_trajectory(system: DrivenModule, trajectory: Trajectory) -> Quantities:
    """Return every quantity of one run, over (time, [lanes])."""
    return named(replace(Known.of(system, trajectory), inputs=None))


def named(known: Known) -> Quantities:
    """Return every quantity as a variable."""
    return {name: xarray.Variable(*of) for name, of in (*known.instants(), *known.ledger())}


def of_runs(runs: Runs, engine: Engine, u: FloatArray, kept: slice) -> Quantities:
    """Return every quantity of runs in C; `u` (m, nt) at all samples, of which some are kept."""
    system = runs.systems[0]
    module, call = system.module, Members(engine, runs.systems.parameters)
    x, u = np.ascontiguousarray(runs.states[:, kept]), np.ascontiguousarray(u[:, kept].T)
    first = np.ascontiguousarray(runs.start[:, None])
    with np.errstate(all="ignore"):
        values = {
            "outputs": np.moveaxis(call("outputs", x, len(module.OUTPUTS), u), 2, 0),
            "temperatures": np.moveaxis(call("temperatures", x, len(module.BODIES)), 2, 0),
            "energy": call("energy", x, 1)[..., 0],
            "entropy": call("entropy", x, 1)[..., 0],
        }
        start = call("energy", first, 1)[..., 0], call("entropy", first, 1)[..., 0]
        states, sums = (np.moveaxis(one, 2, 0) for one in (x, runs.sums[:, kept]))
        return named(Known(system, states, None, values, start, sums, dims=(MEMBER, "time")))
