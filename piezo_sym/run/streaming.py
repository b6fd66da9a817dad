"""Long runs into a Zarr store, window after window: memory does not grow with the run.

Input: a `Request`, the sample times, a path.  Output: the run's Dataset, read from the store when
it is asked for.  A window goes on from the last state of the one before; its integrals are added to
what they had come to.
"""

from __future__ import annotations

import signal
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from itertools import pairwise
from os import PathLike, fspath
from pathlib import Path
from threading import current_thread, main_thread
from typing import TYPE_CHECKING, Any

import numpy as np

from piezo_sym.errors import FileError, RunError, UsageError, quote
from piezo_sym.files import path_text, zarr_library
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.events import read_watched
from piezo_sym.run.module import row_count
from piezo_sym.run.parameters import LaneValue
from piezo_sym.run.planned import Request

if TYPE_CHECKING:
    import xarray

WHERE = "simulate.store"
#: Signals that end a process.
ENDINGS = (signal.SIGINT, signal.SIGTERM)
#: Numbers of a window, of which a sample has a few per state, port and process.
WINDOW, PER_ROW = 4_000_000, 6
#: How the names of integrals begin, or end.
SUMS, LEFT = ("supplied_", "heat_", "produced_", "entropy_exchanged_"), "_residual"
#: What a run took, which windows add up.
WORK = ("accepted_steps", "newton_iterations", "halvings", "rhs_evaluations", "scale_evaluations")


def streamed(
    request: Request,
    start: float,
    samples: FloatArray,
    state: Mapping[str, LaneValue] | None,
    watched: tuple[Mapping[str, str] | None, str | None],
    store: str | PathLike[str],
) -> xarray.Dataset:
    """Run through all samples into a new store, and return what it holds."""
    events, stop = watched
    path = _new(store)
    hits: list[xarray.Dataset] = []  # of each window
    written: xarray.Dataset | None = None
    signs: dict[str, float] = {}
    try:
        for window in _windows(request, samples):
            begin = start if written is None else float(window[0])
            planned = request.planned(begin, float(window[-1]) - begin, state)
            window = np.minimum(window, planned.system.inputs.end)  # by round-off
            looked = read_watched(planned.system, events, stop, request.step)
            found = planned.dataset(window, replace(looked, signs=signs))
            own = [n for n in found.data_vars if {*found[n].dims} & {*looked.event}]
            at_events, found = found[own], found.drop_dims([*looked.event])
            with held_back():
                written, hits = _append(path, found, written), [*hits, at_events]
            request = replace(request, slack=np.inf)
            last_state = found.isel(time=-1)
            state = {r.name: last_state[r.name].values for r in request.module.STATES}
            if "stopped" in found.attrs:
                break
    except (RunError, KeyboardInterrupt) as stopped:
        rest = getattr(stopped, "partial", None)
        if rest is not None:
            with held_back():
                written = _append(path, rest, written)
        if written is not None:
            vars(stopped)["partial"] = _opened(path, written, _events(path, hits, events))
        raise
    assert written is not None  # there is a window at least
    return _opened(path, written, _events(path, hits, events))


def _windows(request: Request, samples: FloatArray) -> Iterator[FloatArray]:
    """Yield the sample times of each window; one begins with the last of the one before."""
    rows = row_count(request.module.STATES, request.parameters) + len(request.module.OUTPUTS)
    rows += row_count(request.module.ELEMENTS, request.parameters) if request.outputs else 0
    most = max(2, WINDOW // (PER_ROW * rows))
    for first, last in pairwise([*range(0, samples.size - 1, most), samples.size - 1]):
        yield samples[first : last + 1]


def _new(store: object) -> Path:
    if not isinstance(store, str | PathLike):
        raise UsageError(f"{quote(store)} is no path", WHERE, "a path such as 'run.zarr'")
    path = Path(fspath(store))
    if path.suffix != ".zarr":
        remedy = "name it *.zarr; other files: to_netcdf() of a run in memory"
        raise UsageError(f"{path_text(path)} is no Zarr store", WHERE, remedy=remedy)
    if path.exists():
        raise FileError(
            "exists already", path_text(path), remedy="choose another path, or delete it"
        )
    zarr_library(WHERE)
    return path


def _added(found: xarray.Dataset, before: xarray.Dataset | None) -> xarray.Dataset:
    """Return a window's Dataset as one of the whole run, without the sample it begins with."""
    if before is None:
        return found
    names = [str(name) for name in found.data_vars if "." not in str(name)]
    integrals = [name for name in names if name.startswith(SUMS) or name.endswith(LEFT)]
    last = before[integrals].isel(time=-1).drop_vars("time")
    whole = found.assign({name: found[name] + last[name] for name in integrals})
    for name in integrals:
        whole[name].attrs = before[name].attrs
    work = {n: found.attrs[n] + before.attrs[n] for n in WORK if n in found.attrs}
    return whole.isel(time=slice(1, None)).assign_attrs(work)


def _append(path: Path, found: xarray.Dataset, before: xarray.Dataset | None) -> xarray.Dataset:
    """Write a window after the one before, and return it as written."""
    part = _added(found, before)
    how = {"mode": "w-", "zarr_format": 3} if before is None else {"append_dim": "time"}
    _written(part, path, **how)
    return part


def _written(part: xarray.Dataset, path: Path, **how: Any) -> None:
    try:
        part.to_zarr(path, consolidated=False, **how)
    except OSError as cause:
        raise FileError(f"cannot be written: {cause.strerror}", path_text(path)) from cause


def _events(path: Path, hits: list[xarray.Dataset], events: Iterable[str] | None) -> list[str]:
    """Write the events of all windows, and return the names of their quantities."""
    import xarray

    found: list[str] = []
    for event in (events or ()) if hits else ():
        own = [str(name) for name, one in hits[0].data_vars.items() if event in one.dims]
        whole = xarray.concat([one[own] for one in hits], dim=event)
        with held_back():
            _written(whole, path, mode="a")
        found += own
    return found


@contextmanager
def held_back() -> Iterator[None]:
    """Hold back what ends a process to the end of the block, of which half would be left."""
    if current_thread() is not main_thread():
        yield
        return
    asked: list[int] = []
    before = {n: signal.signal(n, lambda number, _: asked.append(number)) for n in ENDINGS}
    try:
        yield
    finally:
        for held, handler in before.items():
            signal.signal(held, handler or signal.SIG_DFL)
    for number in asked:
        signal.raise_signal(number)


def _opened(path: Path, part: xarray.Dataset, events: list[str]) -> xarray.Dataset:
    """Return what a store holds, in the order of a part of it: Zarr knows none."""
    import xarray

    found = xarray.open_dataset(path, engine="zarr", consolidated=False)
    return found[[*part.data_vars, *events]]
