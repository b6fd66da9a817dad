"""The quantities of many runs, and their reductions, so that a sweep need not keep trajectories.

Input: runs in C, or the `Trajectory` of one run.  Output: quantities over (runs, time, [lanes]) by
the names of `simulate`, without inputs; the same without time; or the results of a user's function
for the Dataset of one run, or of many runs over the dimension `member`.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from typing import Any, TypeAlias

import numpy as np
import xarray

from piezo_sym.errors import UsageError, listing, quote
from piezo_sym.run.checks import FloatArray, is_number
from piezo_sym.run.collocation import Runs
from piezo_sym.run.dataset import Evaluation, Trajectory
from piezo_sym.run.engine.engine import Engine, Members
from piezo_sym.run.module import row_count
from piezo_sym.run.system import DrivenModule

#: Quantities of many runs by name, over `MEMBER` first.
Quantities: TypeAlias = dict[str, xarray.Variable]

MEMBER = "member"
WHERE = "sweep.reduce"
KINDS = "a Dataset, a DataArray, a number, or a mapping of names to DataArrays and numbers"


def layout(system: DrivenModule) -> Quantities:
    """Return every quantity of a run, in order, at one sample, with nan for its values."""
    start = np.full(row_count(system.module.STATES, system.parameters), np.nan)
    with np.errstate(all="ignore"):
        return of_trajectory(system, Trajectory.blank(system, start, 1))


def of_trajectory(system: DrivenModule, trajectory: Trajectory) -> Quantities:
    """Return every quantity of one run, over (time, [lanes])."""
    return as_variables(replace(Evaluation.of(system, trajectory), inputs=None))


def as_variables(evaluation: Evaluation) -> Quantities:
    """Return every quantity as a variable."""
    quantities = *evaluation.instants(), *evaluation.ledger()
    return {name: xarray.Variable(*variable) for name, variable in quantities}


def of_runs(runs: Runs, engine: Engine, u: FloatArray, kept: slice) -> Quantities:
    """Return every quantity of runs in C at the samples `kept`; `u` (m, nt) is at all samples."""
    system = runs.systems[0]
    call = Members(engine, [one.parameters for one in runs.systems])
    x, u = np.ascontiguousarray(runs.states[:, kept]), np.ascontiguousarray(u[:, kept].T)
    first = np.ascontiguousarray(runs.start[:, None])
    with np.errstate(all="ignore"):
        values = {
            "outputs": call("outputs", x, u),
            "temperatures": call("temperatures", x),
            "energy": call("energy", x),
            "entropy": call("entropy", x),
        }
        start = call("energy", first), call("entropy", first)
        states, sums = (np.moveaxis(one, 2, 0) for one in (x, runs.sums[:, kept]))
        return as_variables(
            Evaluation(system, states, None, values, start, sums, dims=(MEMBER, "time"))
        )


def weights(samples: FloatArray) -> FloatArray:
    """Return the weights (nt,) of the mean over time: of trapezoids, over the duration."""
    if samples.size == 1:
        return np.ones(1)
    halves = np.diff(samples) / 2
    mean: FloatArray = np.append(halves, 0.0) + np.append(0.0, halves)
    mean /= samples[-1] - samples[0]
    return mean


def over_time(quantities: Quantities, weight: FloatArray) -> Quantities:
    """Return quantities (runs, time, ...) summed over time with weights (nt,)."""
    sums = {}
    for name, variable in quantities.items():
        values = np.einsum("kt...,t->k...", variable.values, weight)
        sums[name] = xarray.Variable((MEMBER, *variable.dims[2:]), values, variable.attrs)
    return sums


def run_by_run(
    function: Callable[[Any], object], runs: xarray.Dataset, errors: list[str]
) -> xarray.Dataset | None:
    """Return a function's results for each run, over `member`; None if all runs failed.

    An exception of the function becomes the error of its run.
    """
    results: dict[int, xarray.Dataset] = {}
    for k in (k for k, error in enumerate(errors) if not error):
        try:
            results[k] = as_dataset(function(runs.isel({MEMBER: k})))
        except UsageError:
            raise
        except Exception as cause:  # the user's own code: it may raise anything
            errors[k] = f"{WHERE}: the function fails: {type(cause).__name__}: {cause}"
    if not results:
        return None
    refuse_other_names(*results.values())
    try:
        blank = xarray.full_like(next(iter(results.values())).astype(float), np.nan)
        parts = [results.get(k, blank) for k in range(len(errors))]
        return xarray.concat(parts, MEMBER, join="exact", compat="override", coords="minimal")
    except (ValueError, TypeError) as cause:
        what = "the function gives other sizes for one run than for another"
        raise UsageError(what, WHERE, "the same for every run") from cause


def refuse_other_names(first: Iterable[Any], *others: Iterable[Any]) -> None:
    """Raise `UsageError` if a function returns different names for different runs."""
    for other in others:
        if set(other) != set(first):
            one, another = (listing(map(str, names)) for names in (first, other))
            what = f"the function gives {one} for one run, {another} for another"
            raise UsageError(what, WHERE, "the same for every run")


def refuse_other_sizes(name: str, known: tuple[int, ...], given: tuple[int, ...]) -> None:
    """Raise `UsageError` if a quantity has another shape than for the runs before."""
    if given != known:
        what = f"the function gives '{name}' other sizes for one run than for another"
        raise UsageError(what, WHERE, "the same for every run")


def all_at_once(
    function: Callable[[Any], object], runs: xarray.Dataset, errors: list[str]
) -> xarray.Dataset:
    """Return a function's results for many runs, over `member`."""
    results = as_dataset(function(runs))
    for name, variable in results.data_vars.items():
        if variable.sizes.get(MEMBER) != len(errors):
            what = f"the function gives '{name}' over {listing(map(str, variable.dims))}"
            remedy = f"keep the dimension '{MEMBER}', or leave out reduce_by"
            raise UsageError(what, WHERE, f"one value a '{MEMBER}'", remedy)
    return results


def as_dataset(value: object) -> xarray.Dataset:
    """Return a function's result as a Dataset; raise `UsageError` if it is not of `KINDS`."""
    if isinstance(value, xarray.Dataset):
        for name, variable in value.data_vars.items():
            if variable.dtype.kind not in "fiub":
                what = f"the function gives '{name}' of type {variable.dtype}"
                raise UsageError(what, WHERE, "real numbers")
        return value.drop_vars([n for n in value.coords if n not in value.dims])
    if isinstance(value, xarray.DataArray):
        return as_dataset(value.to_dataset(name=value.name or "reduced"))
    if is_number(value):
        return xarray.Dataset({"reduced": float(value)})  # type: ignore[arg-type]  # a number
    usable = isinstance(value, Mapping) and all(
        isinstance(name, str) and (isinstance(one, xarray.DataArray) or is_number(one))
        for name, one in value.items()
    )
    if not usable:
        raise UsageError(f"the function gives {quote(value)}", WHERE, KINDS)
    parts = {
        name: one.reset_coords(drop=True) if isinstance(one, xarray.DataArray) else float(one)
        for name, one in value.items()  # type: ignore[attr-defined]  # a mapping, see above
    }
    return as_dataset(xarray.Dataset(parts))


def as_quantities(results: xarray.Dataset) -> tuple[Quantities, Quantities]:
    """Return a function's results, and the coordinates of the dimensions that it added."""
    quantities = {
        str(name): array.variable.transpose(MEMBER, ...).astype(float)
        for name, array in results.data_vars.items()
    }
    coords = {str(name): c.variable for name, c in results.coords.items() if name != MEMBER}
    return quantities, coords
