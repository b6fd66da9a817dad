"""Long runs into a Zarr store, window after window, with memory for one window.

Input: a `Request`, the sample times, a path.  Output: the run's Dataset, read from the store on
demand.  A window starts from the last state of the one before, and its integrals from their last
values there.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from itertools import pairwise
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from piezo_sym.errors import FileError, RunError, UsageError, quote
from piezo_sym.files import consolidate, path_text, zarr_library
from piezo_sym.interrupts import held_back
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.module import row_count
from piezo_sym.run.parameters import Given
from piezo_sym.run.planned import Request
from piezo_sym.run.watched import read_watched

if TYPE_CHECKING:
    import xarray

WHERE = "simulate.store"
#: The most numbers in a window, and those of a sample of time, energy, entropy and residuals.
WINDOW, BALANCES = 4_000_000, 5
#: The most numbers of a run in memory: 8 GB.
MOST = 1_000_000_000
#: Prefixes of integrals, and the suffix of residuals, which are continued as well.
SUMS, RESIDUAL = ("supplied_", "heat_", "produced_", "entropy_exchanged_"), "_residual"
#: Attributes that are added up over windows.
WORK = ("accepted_steps", "newton_iterations", "halvings", "rhs_evaluations", "scale_evaluations")


def streamed(
    request: Request,
    start: float,
    samples: FloatArray,
    state: Given | None,
    watched: tuple[Mapping[str, str] | None, str | None],
    store: str | PathLike[str],
) -> xarray.Dataset:
    """Run through all samples into a new store, and return its Dataset."""
    events, stop = watched
    path = _new_store(store)
    hits: list[xarray.Dataset] = []  # events of each window
    written: xarray.Dataset | None = None
    signs: dict[str, float] = {}
    try:
        most = max(2, WINDOW // _numbers(request))
        ends = [*range(0, samples.size - 1, most), samples.size - 1]
        for first, last in pairwise(ends):  # each begins with the last sample of the one before
            window = samples[first : last + 1]
            begin = start if written is None else float(window[0])
            planned = request.planned(begin, float(window[-1]) - begin, state)
            window = np.minimum(window, planned.system.inputs.end)  # by round-off
            located = read_watched(planned.system, events, stop, request.step)
            run = planned.dataset(window, replace(located, signs=signs))
            with held_back():
                written = _append(path, _timed(run, events, hits), written)
            request = replace(request, slack=np.inf)
            end = run.isel(time=-1)
            state = {record.name: end[record.name].values for record in request.module.STATES}
            if "stopped" in run.attrs:
                break
    except (RunError, KeyboardInterrupt) as stopped:
        rest = getattr(stopped, "partial", None)
        if rest is not None:
            with held_back():
                written = _append(path, _timed(rest, events, hits), written)
        if written is not None:
            vars(stopped)["partial"] = _finished(path, written, hits, events)
        raise
    assert written is not None  # there is one window at least
    return _finished(path, written, hits, events)


def _numbers(request: Request) -> int:
    """Return how many numbers there are in a sample of a run."""
    module = request.module
    kinds = [module.STATES, module.INPUTS, module.BODIES, *3 * [module.OUTPUTS]]
    kinds += [*2 * [module.PROCESSES], *[module.ELEMENTS] * bool(request.outputs)]
    return BALANCES + sum(row_count(kind, request.parameters) for kind in kinds)


def check_memory(request: Request, samples: FloatArray) -> None:
    """Raise `UsageError` if a run needs a store, as it has too many numbers for the memory."""
    numbers = _numbers(request)
    if samples.size * numbers > MOST:
        what = f"a run of {samples.size:,} samples takes {8e-9 * samples.size * numbers:.0f} GB"
        remedy = "take fewer, or write them to a file as it goes: store='run.zarr' (--out run.zarr)"
        raise UsageError(what, "simulate.times", f"at most {MOST // numbers:,} in memory", remedy)


def _new_store(store: object) -> Path:
    if not isinstance(store, str | PathLike):
        raise UsageError(f"{quote(store)} is no path", WHERE, "a path such as 'run.zarr'")
    path = Path(fspath(store))
    if path.suffix != ".zarr":
        remedy = "name it *.zarr; other files: to_netcdf() of a run in memory"
        raise UsageError(f"{path_text(path)} is no Zarr store", WHERE, remedy=remedy)
    if path.exists():
        remedy = "choose another path, or delete it"
        raise FileError("exists already", path_text(path), remedy=remedy)
    zarr_library(WHERE)
    return path


def _timed(
    run: xarray.Dataset, events: Iterable[str] | None, hits: list[xarray.Dataset]
) -> xarray.Dataset:
    """Return a window without its events, which go to `hits`; one that is interrupted has none."""
    of_events = {*(events or ())} & {*run.dims}
    if of_events:
        hits.append(run[[name for name in run.data_vars if of_events & {*run[name].dims}]])
    return run.drop_dims(of_events)


def _append(path: Path, window: xarray.Dataset, before: xarray.Dataset | None) -> xarray.Dataset:
    """Write a window after the one before, and return it as written."""
    if before is None:
        _write(window, path, mode="w-", zarr_format=3)
        return window
    names = [str(name) for name in window.data_vars if "." not in str(name)]
    integrals = [name for name in names if name.startswith(SUMS) or name.endswith(RESIDUAL)]
    last = before[integrals].isel(time=-1).drop_vars("time")
    window = window.assign({name: window[name] + last[name] for name in integrals})
    for name in integrals:
        window[name].attrs = before[name].attrs
    work = {n: window.attrs[n] + before.attrs[n] for n in WORK if n in window.attrs}
    window = window.isel(time=slice(1, None)).assign_attrs(work)  # its first is the last before
    _write(window, path, append_dim="time")
    return window


def _write(window: xarray.Dataset, path: Path, **options: Any) -> None:
    try:
        window.to_zarr(path, consolidated=False, **options)
    except OSError as cause:
        raise FileError(f"cannot be written: {cause.strerror}", path_text(path)) from cause


def _finished(
    path: Path, last: xarray.Dataset, hits: list[xarray.Dataset], events: Iterable[str] | None
) -> xarray.Dataset:
    """Write the events of all windows, and return the Dataset of the store.

    The attributes of the store are replaced, too: by those of the last window. Its order is that of
    the window, as Zarr keeps none.
    """
    import xarray

    written = [str(name) for name in last.data_vars]
    for event in (events or ()) if hits else ():
        names = [str(name) for name, values in hits[0].data_vars.items() if event in values.dims]
        with held_back():
            found = xarray.concat([window[names] for window in hits], dim=event)
            _write(found.assign_attrs(last.attrs), path, mode="a")
        written += names
    with held_back():
        consolidate(path)
    return xarray.open_dataset(path, engine="zarr", consolidated=False)[written]
