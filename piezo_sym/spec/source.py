"""Spec files as text and plain data: found, read, checked for size and nesting.

Input: a path, or the name of a shipped spec.  Output: text, or TOML data.  Nothing here needs the
spec's types, so that a run can compare a module with its spec at little cost.
"""

import os
import re
import tomllib
from contextlib import suppress
from pathlib import Path
from typing import Any

from piezo_sym.errors import FileError, SpecError, UsageError, listing, nearest, quote
from piezo_sym.files import near_file
from piezo_sym.spec.names import NAME
from piezo_sym.spec.syntax import remedy_at

MAX_BYTES = 500_000
MAX_NESTING = 20
MAX_DOTS = 8
MOST_LINES = 20  # of a value whose key is looked for
QUOTED = re.compile(
    r"'{3}.*?'{3}"
    r'|"{3}(?:\\.|[^\\])*?"{3}'
    r'|"(?:\\.|[^"\\\n])*"'
    r"|'[^'\n]*'"
    r"|#[^\n]*",
    re.DOTALL,
)
BETWEEN_KEYS = re.compile(r"[=,{}\[\]\n]")
MODELS = Path(__file__).parent.parent / "models"


def shipped() -> tuple[str, ...]:
    """Return the names of the shipped specs."""
    return tuple(sorted(path.stem for path in MODELS.glob("*.toml")))


def find(spec: str | Path) -> Path:
    """Return the file of a spec given by path or shipped name.

    Raises `FileError` if a bare name is neither shipped nor a file.  Raises `UsageError` if it is
    neither text nor a path.
    """
    if not isinstance(spec, str | os.PathLike):
        raise UsageError(f"{quote(spec)} is no spec", "load", "a shipped name, or a spec's path")
    text = str(spec)
    if text in shipped():
        return MODELS / f"{text}.toml"
    path = Path(spec)
    if path.suffix != ".toml" and NAME.fullmatch(text) and not os.path.exists(path):
        remedy = f"{nearest(text, shipped())}; or give the path of a .toml file"
        beside = os.path.exists(f"{text}.toml")
        remedy = f"to use the file {text}.toml, write its ending" if beside else remedy
        raise FileError(f"no shipped spec is called {quote(text)}", remedy=remedy)
    return path


def component_file(given: object, where: str, folder: Path | None) -> Path:
    """Return the file of a component of a spec in a folder.

    Raises `SpecError` if it is none below the folder of the spec.
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
    relative, path = Path(given), folder / given
    inside = real(path).is_relative_to(real(folder))
    if not inside or ".." in relative.parts or relative.is_absolute():
        remedy = "move or copy the file there"
        raise SpecError(f"{quote(given)} leads out of the spec's folder", where, expected, remedy)
    if not os.path.isfile(path):
        known = nearest(given, shipped()).replace("known", "shipped")
        beside = os.path.isfile(folder / f"{given}.toml")
        known = f"did you mean {quote(f'{given}.toml')}?" if beside else known
        raise SpecError(f"{quote(given)} is no file there, and not shipped", where, expected, known)
    return path


def real(path: Path) -> Path:
    """Return a path with its links resolved; unchanged if it holds a character that no path has."""
    try:
        return Path(os.path.realpath(path))
    except ValueError:
        return path


def read(path: Path) -> str:
    """Return the text of a spec file.

    Raises `FileError` if it cannot be read, is too large, or is not UTF-8.
    """
    where = quote(str(path))
    try:
        with path.open("rb") as file:
            raw = file.read(MAX_BYTES + 1)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or "not a path"
        remedy = near_file(path) if isinstance(error, FileNotFoundError) else "check the path"
        raise FileError(f"cannot be read ({reason})", where, remedy=remedy) from error
    if len(raw) > MAX_BYTES:
        remedy = "a bank needs one element, not one per lane"
        raise FileError("is too large", where, f"at most {MAX_BYTES} bytes", remedy)
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        what = f"is not UTF-8 (byte {error.start})"
        raise FileError(what, where, remedy="save it as UTF-8") from error


def data(text: str) -> dict[str, Any]:
    """Return the TOML data of a spec's text.

    Raises `SpecError` if the text is not TOML, or nested beyond what a spec needs.
    """
    if len(text) > MAX_BYTES:
        raise SpecError("is too large", "", f"at most {MAX_BYTES} characters")
    _check_nesting(text)
    try:
        return tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError, ValueError) as error:
        fault = str(error)
        if twice := _given_twice(text, fault):
            raise SpecError(twice, remedy="rename one of the two, or leave it out") from None
        remedy = remedy_at(text, fault) or "mend the syntax there"
        raise SpecError(f"is not TOML: {fault[:200]}", remedy=remedy) from None


def _given_twice(text: str, fault: str) -> str:
    """Return which table, or key of a table, is there twice, if that is the fault of a text."""
    if not fault.startswith(("Cannot overwrite a value", "Cannot declare")):
        return ""
    lines, at = text.split("\n"), re.search(r"at line (\d+)", fault)
    last = int(at[1]) if at else len(text.rstrip("\n").split("\n"))
    for number in range(last, max(last - MOST_LINES, 0), -1):
        with suppress(tomllib.TOMLDecodeError):
            tomllib.loads("\n".join(lines[: number - 1]))
            # what is before this line is TOML, so that the second of the two begins here
            if table := re.match(r"\s*(\[[^\]]*\]+)", lines[number - 1]):
                return f"table {quote(table[1])} is given twice (line {number})"
            key = lines[number - 1].partition("=")[0].strip()
            return f"key {quote(key)} is in its table twice (line {number})"
    return f"a key is in its table twice (its value ends in line {last})"


def _check_nesting(text: str) -> None:
    """Refuse deep nesting outside of strings and comments: the TOML parser is recursive."""
    bare = QUOTED.sub("", text)
    if any(part.count(".") > MAX_DOTS for part in BETWEEN_KEYS.split(bare)):
        raise SpecError("has a key of too many parts", "", f"at most {MAX_DOTS + 1}")
    depth = 0
    for c in bare:
        depth += (c in "[{") - (c in "]}")
        if depth > MAX_NESTING:
            raise SpecError("is nested too deeply", "", f"at most {MAX_NESTING} levels")
