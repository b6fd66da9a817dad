"""Spec files to models, with the models of their components.

Input: a path, or a text and the folder that its paths are in.  Output: a `Model`; each file is read
once, in whatever components it is.  A component is a shipped name, a path below the folder of
the spec that names it, or, in Python, a `Model`.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Generic, TypeVar, final

from piezo_sym.errors import PiezoError, SpecError, listing, nearest, quote
from piezo_sym.spec.fields import Included, Tables
from piezo_sym.spec.names import MAX_NAME
from piezo_sym.spec.source import data, find, read, shipped

#: Each model around another makes its names two characters longer, at least.
MOST_DEEP = MAX_NAME // 2
Chain = tuple[Path, ...]
Made = TypeVar("Made", bound=Tables)


@final
@dataclass(frozen=True)
class Reader(Generic[Made]):
    """Reads specs as models of one type."""

    make: Callable[..., Made]
    _known: dict[Path, Made] = field(default_factory=dict)

    def file(self, path: Path, chain: Chain = ()) -> Made:
        """Return the model of a file; `chain` are the files around it."""
        key = _real(path)
        if key in chain:
            names = " -> ".join(p.name for p in (*chain[chain.index(key) :], key))
            raise SpecError(f"{quote(path.name)} is a component of itself: {names}")
        if len(chain) > MOST_DEEP:
            expected = f"at most {MOST_DEEP} models around another"
            raise SpecError(f"{quote(path.name)} is too deep inside", expected=expected)
        if key not in self._known:
            self._known[key] = self.text(read(path), path.name, path.parent, (*chain, key))
        return self._known[key]

    def text(self, text: str, source: str, folder: Path | None, chain: Chain = ()) -> Made:
        """Return the model of a text; messages begin with `source`."""
        try:
            return self.make(**self.complete(data(text), folder, chain))
        except PiezoError as error:
            _put_around(error, source)
            raise

    def complete(
        self, content: Mapping[str, Any], folder: Path | None = None, chain: Chain = ()
    ) -> dict[str, Any]:
        """Return the tables of a spec with the models of its components.

        Raises
        ------
        FileError, SpecError
            If a component cannot be read, is no spec, has itself as a part, or lies elsewhere.
        """
        table = content.get("components")
        if not isinstance(table, Mapping):
            return dict(content)
        made = {}
        for name, row in table.items():
            given = row.get("spec") if isinstance(row, Mapping) else None
            if given is not None and not isinstance(given, Included):
                where = f"components.{name}"
                row = {**row, "spec": self._included(given, where, folder, chain)}
            made[name] = row
        return {**content, "components": made}

    def _included(self, given: object, where: str, folder: Path | None, chain: Chain) -> Included:
        if isinstance(given, Tables):
            return Included(given)
        path = _placed(given, f"{where}.spec", folder)
        try:
            return Included(self.file(path, chain), str(given))
        except PiezoError as error:
            _put_around(error, where)
            raise


def _real(path: Path) -> Path:
    """Return where a path leads; itself, if it has a character that no path has."""
    try:
        return Path(os.path.realpath(path))
    except ValueError:
        return path


def _put_around(error: PiezoError, where: str) -> None:
    """Put a place around that of an error."""
    error.where = f"{where}: {error.where}" if error.where else where


def _placed(given: object, where: str, folder: Path | None) -> Path:
    """Return the file of a component.

    Raises
    ------
    SpecError
        If it is none below the folder of the spec.
    """
    expected = "a shipped name, or a path in this file's folder"
    if not isinstance(given, str):
        raise SpecError(f"{quote(given)} is no spec", where, expected)
    if given in shipped():
        return find(given)
    if folder is None:
        remedy = (
            f"shipped: {listing(shipped())}; or in Python a Model, such as load({quote(given)})"
        )
        raise SpecError(f"{quote(given)} is no shipped spec", where, remedy=remedy)
    own, path = Path(given), folder / given
    inside = _real(path).is_relative_to(_real(folder))
    if not inside or ".." in own.parts or own.is_absolute():
        remedy = "move or copy the file there"
        raise SpecError(f"{quote(given)} leads out of the spec's folder", where, expected, remedy)
    if not os.path.isfile(path):
        known = nearest(given, shipped()).replace("known", "shipped")
        raise SpecError(f"{quote(given)} is no file there, and not shipped", where, expected, known)
    return path
