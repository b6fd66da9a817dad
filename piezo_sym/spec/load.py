"""A spec file to a `Model`: the one way in for text from strangers.

Input: a path, or the name of a shipped spec.  Output: a `Model`, or one error with the file's name.
Size, encoding and nesting are checked before the TOML parser sees anything.
"""

from __future__ import annotations

import re
import tomllib
from importlib import resources
from pathlib import Path
from typing import Any

from piezo_sym.errors import FileError, PiezoError, SpecError, nearest, quote
from piezo_sym.spec.model import Model
from piezo_sym.spec.names import NAME

MAX_BYTES = 500_000
MAX_NESTING = 20


def load(spec: str | Path) -> Model:
    """Return the model of a spec file, or of a shipped spec.

    Parameters
    ----------
    spec : path of a TOML file, or a name from `shipped()`.

    Raises
    ------
    FileError
        If the file cannot be read.
    SpecError
        If it is not a spec; the message names the place.
    """
    path = find(spec)
    return parse(read(path), path.name)


def find(spec: str | Path) -> Path:
    """Return the file of a spec given by path or shipped name."""
    text = str(spec)
    if text in shipped():
        return _models() / f"{text}.toml"
    path = Path(spec)
    if path.suffix != ".toml" and NAME.fullmatch(text) and not path.exists():
        what = f"no shipped spec is called {quote(text)}"
        raise FileError(what, remedy=f"{nearest(text, shipped())}; or give the path of a .toml file")
    return path


def shipped() -> tuple[str, ...]:
    """Return the names of the shipped specs."""
    return tuple(sorted(path.stem for path in _models().glob("*.toml")))


def _models() -> Path:
    return Path(str(resources.files("piezo_sym"))) / "models"


def read(path: Path) -> str:
    """Return the text of a spec file, checked for size, encoding and nesting.

    Raises
    ------
    FileError
        If it cannot be read, is too large, or is not UTF-8.
    """
    where = quote(str(path))
    try:
        with path.open("rb") as file:
            raw = file.read(MAX_BYTES + 1)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or "not a path"
        raise FileError(f"cannot be read ({reason})", where, remedy="check the path") from error
    if len(raw) > MAX_BYTES:
        remedy = "shorten the spec: a bank needs one element, not one a lane"
        raise FileError("is too large", where, f"at most {MAX_BYTES} bytes", remedy)
    try:
        return raw.decode("utf-8")
    except UnicodeDecodeError as error:
        what = f"is not UTF-8 (byte {error.start})"
        raise FileError(what, where, remedy="save it as UTF-8") from error


def parse(text: str, source: str = "spec") -> Model:
    """Return the model of a spec's text.

    Raises
    ------
    SpecError
        If the text is not a spec; the message begins with `source`.
    """
    try:
        return Model(**data(text))
    except PiezoError as error:
        error.where = f"{source}: {error.where}" if error.where else source
        raise


def data(text: str) -> dict[str, Any]:
    """Return the TOML data of a spec's text.

    Raises
    ------
    SpecError
        If the text is not TOML, or nested beyond what a spec needs.
    """
    if len(text) > MAX_BYTES:
        raise SpecError("is too large", "", f"at most {MAX_BYTES} characters")
    _check_nesting(text)
    try:
        return tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError, ValueError) as error:
        raise SpecError(f"is not TOML: {str(error)[:200]}", remedy="mend the syntax there") from None


def _check_nesting(text: str) -> None:
    """Refuse deep nesting before a recursive parser meets it; brackets in strings count too."""
    depth = 0
    for line in text.splitlines():
        if line.count(".") > 4 * MAX_NESTING and re.match(r"\s*\[*[\w.\s\"'-]*$", line.split("=")[0]):
            raise SpecError("has a key of too many parts", "", f"at most {4 * MAX_NESTING}")
        for c in line:
            depth += (c in "[{") - (c in "]}")
            if depth > MAX_NESTING:
                raise SpecError("is nested too deeply", "", f"at most {MAX_NESTING} levels")
