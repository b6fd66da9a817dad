"""A Zarr store of a sweep: written box by box, and taken up again where it was stopped.

Input: a path, a `Plan`, its `Frame`.  Output: a `Store`.  A box is done when its part of `error` is
written, last of all: until then it says "not run".
"""

from __future__ import annotations

import json
import tempfile
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any, final

import numpy as np

from piezo_sym.errors import FileError, UsageError, listing
from piezo_sym.files import path_text
from piezo_sym.sweeps.fingerprint import fingerprint
from piezo_sym.sweeps.frame import ERROR_ATTRS, NOT_RUN
from piezo_sym.sweeps.reduce import refuse_other_names
from piezo_sym.sweeps.sinks import Sink, refuse_other_sizes

if TYPE_CHECKING:
    from collections.abc import Iterator

    import xarray

    from piezo_sym.sweeps.frame import Frame
    from piezo_sym.sweeps.plan import Box, Plan
    from piezo_sym.sweeps.quantities import RunQuantity
    from piezo_sym.sweeps.run import Result

MARK, BOX, RESULTS = "sweep_fingerprint", "sweep_box", "sweep_results"
FRESH = "choose another path, or delete it"
UNREADABLE = (OSError, ValueError, KeyError, RuntimeError)


def store_at(path: Path, plan: Plan, frame: Frame, spec_sha256: str) -> tuple[Plan, Store]:
    """Return the store at a path, made if there is none, and the plan with the store's boxes.

    Raises
    ------
    FileError : the path holds something else, or the store of another sweep, or cannot be written.
    UsageError : zarr is not installed.
    """
    try:
        import zarr
    except ImportError as error:
        remedy = "run `pip install 'piezo_sym[store]'`"
        raise UsageError("zarr is not installed", "sweep.store", remedy=remedy) from error
    mark = fingerprint(plan, spec_sha256)
    if not path.exists():
        create(path, plan, frame, {MARK: mark, BOX: plan.most})
    try:
        group = zarr.open_group(path, mode="r+", zarr_format=3, use_consolidated=False)
    except UNREADABLE as cause:
        raise FileError("is no store of a sweep", path_text(path), remedy=FRESH) from cause
    if MARK not in group.attrs:
        raise FileError("is no store of a sweep", path_text(path), remedy=FRESH)
    if group.attrs[MARK] != mark:
        what = f"holds another sweep: {difference(group, frame)}"
        raise FileError(what, path_text(path), "a store of this very sweep", FRESH)
    plan = plan.with_most(int(str(group.attrs[BOX])))
    return plan, Store(path, group, plan, frame)


def difference(group: Any, frame: Frame) -> str:
    """Return in what the sweep in a store differs from this one, as far as it can be told."""
    other = [name for name, value in frame.attrs.items() if not same(group.attrs.get(name), value)]
    other += [name for name in group.attrs if name not in {*frame.attrs, MARK, BOX, RESULTS}]
    swept = group["error"].metadata.dimension_names or ()
    other += sorted(set(swept) ^ set(frame.dims))
    for name, (dims, values, _) in frame.coords.items():
        if name in group and set(dims) <= set(frame.dims):
            other += [] if same(group[name][...], np.asarray(values)) else [name]
    names = [name for name in dict.fromkeys(other) if name != "engine"]
    if not names:
        return "its inputs, samples, initial values or functions are others"
    return f"others are {listing(name.removeprefix('parameter_') for name in names)}"


def same(one: Any, other: Any) -> bool:
    """Return whether two values are equal, arrays entry by entry."""
    return bool(np.array_equal(np.asarray(one), np.asarray(other)))


def create(path: Path, plan: Plan, frame: Frame, marks: dict[str, object]) -> None:
    """Make a store in which nothing has run; it appears at its path when it is whole."""
    errors = np.full(plan.shape, NOT_RUN, dtype=object)
    data = {**frame.inputs, "error": (frame.dims, errors, ERROR_ATTRS)}
    needed = coordinates_needed(plan, frame)
    sizes = {name: of for name, of in frame.coords.items() if name in needed}
    empty = frame.dataset(data, {}).assign_coords(sizes).assign_attrs(marks)
    # a chunk that is not there has not run
    encoding = {"error": {"chunks": box_in_order(plan), "fill_value": NOT_RUN}}
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=path.parent, prefix=f".{path.name}-") as folder:
            new = Path(folder) / "new"
            empty.to_zarr(new, mode="w", zarr_format=3, consolidated=False, encoding=encoding)
            new.rename(path)
    except OSError as cause:
        what = f"cannot be written: {cause.strerror}"
        raise FileError(what, path_text(path), remedy="check the path") from cause


def coordinates_needed(plan: Plan, frame: Frame) -> set[str]:
    """Return the coordinates that results will have; a function brings most of its own."""
    if callable(plan.reduce):
        return set(plan.largest_banks)
    return {*frame.banks, *(() if plan.reduce else ("time",))}


def box_in_order(plan: Plan) -> tuple[int, ...]:
    """Return the shape of a box along the axes in the user's order."""
    sizes = dict(zip(plan.order, plan.box_shape, strict=True))
    return tuple(sizes[n] for n in range(len(plan.axes)))


def consolidate(path: Path) -> None:
    """Write what arrays there are in one place, where others who open a store look for it.

    zarr warns that its format 3 does not speak of that yet; xarray warns where it is missing.
    """
    import zarr

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        zarr.consolidate_metadata(path, zarr_format=3)


@final
class Store(Sink):
    """Writes results into arrays over the grid, a chunk of each a box."""

    def __init__(self, path: Path, group: Any, plan: Plan, frame: Frame) -> None:
        self._path, self._group, self._plan, self._frame = path, group, plan, frame

    def missing(self) -> Iterator[Box]:
        """Return the boxes that were not written to their end."""
        errors = self._group["error"]
        for box in self._plan.boxes():
            try:
                part = errors[self._plan.region(box)]
            except UNREADABLE:  # it was being written when all ended
                yield box
            else:
                if np.any(np.asarray(part) == NOT_RUN):
                    yield box

    def take(self, result: Result) -> None:
        """Write a result; its errors last."""
        region, quantities = self._plan.region(result.box), result.quantities
        known = self._group.attrs.get(RESULTS)
        if known is not None and quantities:
            refuse_other_names(json.loads(str(known)), quantities)
        try:
            for name, one in {**result.coords, **quantities}.items():
                if name not in self._group:
                    self._add(name, one, own=name in result.coords)
            for name, one in quantities.items():
                array = self._group[name]
                refuse_other_sizes(name, array.shape[len(region) :], one)
                array[region] = self._plan.arranged(result.box, one.values)
            errors = np.array(result.errors, dtype=object)
            self._group["error"][region] = self._plan.arranged(result.box, errors)
            if known is None and quantities:
                self._group.attrs[RESULTS] = json.dumps(list(quantities))
                consolidate(self._path)
        except OSError as cause:
            what = f"cannot be written: {cause.strerror}"
            raise FileError(what, path_text(self._path)) from cause

    def _add(self, name: str, one: RunQuantity, *, own: bool) -> None:
        """Add an array for a quantity, or with its numbers a coordinate that a function made."""
        shape, dims = one.values.shape, one.dims
        chunks = shape
        if not own:
            shape = (*self._plan.shape, *shape[1:])
            dims = (*self._frame.dims, *dims)
            chunks = (*box_in_order(self._plan), *one.values.shape[1:])
        array = self._group.create_array(
            name,
            shape=shape,
            chunks=tuple(max(1, size) for size in chunks),
            dtype=one.values.dtype,
            fill_value=0 if own else np.nan,
            dimension_names=dims,
            attributes=dict(one.attrs),
        )
        if own:
            array[...] = one.values

    def dataset(self) -> xarray.Dataset:
        """Return the store as a Dataset that is read when its values are asked for.

        It is as one in memory: without the store's marks, and with errors as Python has texts.
        """
        import xarray

        consolidate(self._path)
        found: xarray.Dataset = xarray.open_zarr(self._path, chunks=None, consolidated=False)
        found["error"] = found["error"].astype(object)
        found.attrs = {k: v for k, v in found.attrs.items() if k not in {MARK, BOX, RESULTS}}
        return found
