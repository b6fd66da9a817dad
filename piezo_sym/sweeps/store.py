"""A Zarr store of a sweep: written box by box, so that an interrupted sweep can continue.

Input: a path, a `Plan`, its frame.  Output: a `Store`.  The errors of a box are written last; until
then they are "not run".  A store has the fingerprint of its sweep, SHA-256 of each field: equal for
two sweeps exactly if they request the same runs.  That of a function includes its name, its code
and all values that it refers to, so that an edit changes it.
"""

from __future__ import annotations

import hashlib
import json
import tempfile
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import fields, is_dataclass, replace
from pathlib import Path
from types import CodeType, ModuleType
from typing import Any, final

import numpy as np
import xarray

from piezo_sym.errors import FileError, listing
from piezo_sym.files import consolidate, path_text, zarr_library
from piezo_sym.interrupts import held_back
from piezo_sym.sweeps.frame import ERROR_ATTRS, NOT_RUN, Results, Shape
from piezo_sym.sweeps.plan import Plan, Region
from piezo_sym.sweeps.run import Result

#: Fields that say how runs are divided and executed, not which runs they are; and the arguments of
#: `sweep` that other fields come from.
LEFT_OUT = ("most", "together", "engine", "side_by_side")
CALLED = {"axes": "over", "signals": "inputs", "samples": "times", "each": "reduce_by"}


def fingerprint(plan: Plan, spec_sha256: str) -> str:
    """Return the fingerprint of a sweep: the digest of each field by name, as JSON."""
    digests = {"spec": spec_sha256}
    for field in fields(plan):
        if field.name not in LEFT_OUT:
            digest = hashlib.sha256()
            for part in parts(getattr(plan, field.name)):
                digest.update(len(part).to_bytes(8, "little") + part)
            digests[CALLED.get(field.name, field.name)] = digest.hexdigest()
    return json.dumps(digests)


def difference(mark: str, stored: str) -> str:
    """Return in which fields two sweeps differ, by their fingerprints."""
    try:
        ours, theirs = json.loads(mark), dict(json.loads(stored))
    except ValueError:  # of another version
        return "holds another sweep"
    names = [name for name, digest in ours.items() if theirs.get(name) != digest]
    return f"holds another sweep, which differs in {listing(names)}"


def parts(value: object, met: dict[int, object] | None = None) -> Iterator[bytes]:
    """Yield the contents of a value as bytes, those of each object in it once."""
    met = {} if met is None else met
    yield type(value).__name__.encode()
    if isinstance(value, float | int | str | bytes | None):
        yield (value.hex() if isinstance(value, float) else repr(value)).encode()
        return
    if isinstance(value, np.ndarray | np.generic):
        array = np.asarray(value)
        yield f"{array.dtype.str}{array.shape}".encode()
        yield array.tobytes() if array.dtype.kind != "O" else repr(array.tolist()).encode()
        return
    if id(value) not in met:
        met[id(value)] = value  # kept alive, so that no other object gets its id
        for part in contents(value):
            yield from parts(part, met)


def contents(value: object) -> Iterable[object]:
    """Return the contents of a container, a record, a function or another object of a user."""
    match value:
        case Mapping():
            return [part for key in sorted(value, key=repr) for part in (key, value[key])]
        case frozenset():
            return sorted(value, key=repr)
        case tuple() | list():
            return value
        case CodeType():
            return value.co_code, value.co_names, value.co_consts
        case ModuleType():
            return ()
    if is_dataclass(value):
        return [getattr(value, field.name) for field in fields(value)]
    code, name = getattr(value, "__code__", None), str(getattr(value, "__qualname__", ""))
    attributes = ("func", "args", "keywords", "__self__", "__defaults__", "__kwdefaults__")
    found = [name, code, *(getattr(value, attribute, None) for attribute in attributes)]
    if not isinstance(code, CodeType):
        return [*found, dict(getattr(value, "__dict__", None) or {})]
    cells = (cell.cell_contents for cell in getattr(value, "__closure__", None) or ())
    known = getattr(value, "__globals__", {})
    read = (known[name] for name in code.co_names if name in known)
    return [*found, *cells, *(_global(one, getattr(value, "__module__", None)) for one in read)]


def _global(value: Any, module: str | None) -> object:
    """Return a global value that a function reads; its name alone, if it is of another module."""
    local = getattr(value, "__module__", None) in (None, module)
    return value if local else f"{value.__module__}.{getattr(value, '__qualname__', '')}"


MARK, BOX, RESULTS = "sweep_fingerprint", "sweep_box", "sweep_results"
FRESH = "choose another path, or delete it"
UNREADABLE = (OSError, ValueError, KeyError, RuntimeError)


def store_at(path: Path, plan: Plan, frame: xarray.Dataset, spec_sha256: str) -> tuple[Plan, Store]:
    """Return the store at a path, created if there is none, and the plan with the store's boxes."""
    zarr, mark = zarr_library("sweep.store"), fingerprint(plan, spec_sha256)
    if not path.exists():
        create(path, plan, frame, {MARK: mark, BOX: plan.most})
    try:
        group = zarr.open_group(path, mode="r+", zarr_format=3, use_consolidated=False)
        stored = group.attrs[MARK]
    except UNREADABLE as cause:
        raise FileError("is no store of a sweep", path_text(path), remedy=FRESH) from cause
    if stored != mark:
        what, expected = difference(mark, str(stored)), "a store of this very sweep"
        raise FileError(what, path_text(path), expected, FRESH)
    plan = replace(plan, most=int(str(group.attrs[BOX])))
    return plan, Store(path, group, plan)


def create(path: Path, plan: Plan, frame: xarray.Dataset, marks: dict[str, object]) -> None:
    """Create a store without results beside its path, and move it there when complete."""
    errors = np.full(plan.shape, NOT_RUN, dtype=object)
    empty = frame.assign(error=(plan.dims, errors, ERROR_ATTRS)).assign_attrs(marks)
    # a missing chunk reads as not run
    encoding = {"error": {"chunks": plan.box_shape, "fill_value": NOT_RUN}}
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=path.parent, prefix=f".{path.name}-") as folder:
            new = Path(folder) / "new"
            empty.to_zarr(new, mode="w", zarr_format=3, consolidated=False, encoding=encoding)
            new.rename(path)
    except OSError as cause:
        what = f"cannot be written: {cause.strerror}"
        raise FileError(what, path_text(path), remedy="check the path") from cause


@final
class Store(Results):
    """Writes results into Zarr arrays over the grid, one chunk per box."""

    def __init__(self, path: Path, group: Any, plan: Plan) -> None:
        super().__init__(plan)
        self._path, self._arrays = path, group
        self._names = json.loads(str(group.attrs.get(RESULTS, "[]")))

    def missing(self) -> Iterator[Region]:
        """Yield the boxes that are not written completely."""
        for region in self._plan.regions():
            try:
                done = not np.any(np.asarray(self._arrays["error"][region]) == NOT_RUN)
            except UNREADABLE:  # the process ended while it was written
                done = False
            if not done:
                yield region

    def take(self, region: Region, result: Result) -> None:
        """Write the result of a box."""
        known = self._names
        try:
            with held_back():
                super().take(region, result)
                if not known and self._names:
                    self._arrays.attrs[RESULTS] = json.dumps(self._names)
                    consolidate(self._path)
        except OSError as cause:
            what = f"cannot be written: {cause.strerror}"
            raise FileError(what, path_text(self._path)) from cause

    def _add(self, name: str, like: xarray.Variable, shape: Shape, chunks: Shape) -> None:
        self._arrays.create_array(
            name,
            shape=shape,
            chunks=tuple(max(1, size) for size in chunks),
            dtype=like.dtype,
            fill_value=np.nan if like.dtype.kind == "f" else 0,
            dimension_names=like.dims,
            attributes=dict(like.attrs),
        )

    def dataset(self) -> xarray.Dataset:
        """Return the store as a Dataset that reads values on demand.

        As in memory, it has no attributes of the store, and errors are Python strings.
        """
        consolidate(self._path)
        stored: xarray.Dataset = xarray.open_zarr(self._path, chunks=None, consolidated=False)
        stored["error"] = stored["error"].astype(object)
        for name in {MARK, BOX, RESULTS} & {*stored.attrs}:
            del stored.attrs[name]
        return stored
