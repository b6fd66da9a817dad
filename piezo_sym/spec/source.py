"""Spec files as text and plain data: found, read, checked for size and nesting.

Input: a path, or the name of a shipped spec.  Output: text, or TOML data; where a text is no TOML,
but of another habit, what to write instead.  Nothing here needs the spec's types, so that a run can
compare a module with its spec at little cost.
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
#: How many characters before and behind the fault are looked at.
NEAR = 150
#: Patterns of a line in which ! marks the fault, and what to write there; the first one counts.
HINTS = tuple(
    (re.compile(pattern), hint)
    for pattern, hint in (
        (r"= *([+-]?\d+)!?,!?(\d+)", r"write \1.\2, with a point"),
        (r"!(%|//)", "a comment begins with #"),
        (r"!(True|False)\b", "write true or false"),
        (r"!['\"]?.*[\u201c\u201d\u201e\u2018\u2019]", 'write straight quotes, as in unit = "N/m"'),
        (r"[\w.-]*![^\x00-\x7f]", "write a name in Latin letters, as alpha"),
        (r"!([+-]?)\.(\d+)", r"write \g<1>0.\2, with a digit before the point"),
        (r"(\d)!\.(?!\d)", r"write a digit behind the point, as in \1.0"),
        (r"[=,{ ]!(\w+)\s*=", r"separate entries by commas: one is missing before '\1'"),
        (r"(\d[\d.eE+-]*) !([A-Za-z][\w/*()-]*)", r'write { value = \1, unit = "\2" }'),
        (r"\d *!([*/^]|\*\*)", "write a value as one number, and a law as a text in quotes"),
        (r"[=\[,] *!([A-Za-z][^,;}\]#\"']*?) *(?![^,;}\]#\"'])", r'write texts in quotes: "\1"'),
        (r"!;", "separate entries by commas"),
        (r"!:", "write = between a key and its value"),
        (r"\w *!\{", "write = between a key and its value"),
        (r"=!=", "write one ="),
        (r"= *\"[^\"]*\"!,", 'write several values as a list: ["a", "b"]'),
        (r", *!\}", "take out the last comma"),
        (r"^\[[^\]]*!", "close the name of a table with ], without blanks: [elements.spring]"),
        (r"\{[^}]*!$", "close the braces on the same line: }"),
        (r"['\"][^'\"]*!$", "close the quotes on the same line"),
    )
)
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
        remedy = _remedy_at(text, fault) or "mend the syntax there"
        raise SpecError(f"is not TOML: {fault[:200]}", remedy=remedy) from None


def _remedy_at(text: str, fault: str) -> str:
    """Return what to write at the place that a fault of the TOML parser names, or ''."""
    place = re.search(r"at line (\d+), column (\d+)", fault)
    lines = text.split("\n")
    number, column = (int(place[1]), int(place[2])) if place else (len(lines), len(lines[-1]) + 1)
    line = lines[min(number, len(lines)) - 1]
    first = max(0, column - 1 - NEAR)  # of a hostile text, a line may be all of it
    marked = f"{line[first : column - 1]}!{line[column - 1 : column - 1 + NEAR]}".rstrip()
    found = ((pattern.search(marked), hint) for pattern, hint in HINTS)
    return next((match.expand(hint).strip() for match, hint in found if match), "")


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
