"""Values of options on the command line: ``NAME=VALUE`` with numbers, signals or files.

Input: what a user typed.  Output: names and values, or an error that names the option.
"""

import re
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from piezo_sym.errors import UsageError, listing, nearest, quote
from piezo_sym.files import path_text

CALL = re.compile(r"(?P<name>[a-z]+)\((?P<numbers>[^()]*)\)")


def pairs(
    texts: Iterable[str], option: str, read: Callable[[str, str], Any]
) -> Iterable[tuple[str, Any]]:
    """Yield the name and value of each ``NAME=VALUE``; `read` converts (text, place) to a value."""
    seen: set[str] = set()
    for given in texts:
        name, equals, value = given.partition("=")
        if not equals:
            raise UsageError(f"{quote(given)} has no '='", option, "NAME=VALUE")
        name = name.strip()
        if name in seen:
            raise UsageError(f"{quote(name)} is given twice", option, remedy="give it once")
        seen.add(name)
        yield name, read(value.strip(), f"{option} {name}")


def signal(text: str, where: str) -> Any:
    """Return a number, a signal such as ``sine(100, 100, offset=50)``, or samples, ``@drive.csv``.

    Nothing is evaluated.
    """
    if text.startswith("@"):
        return samples(text[1:], where)
    call = CALL.fullmatch(text)
    if call is None:
        return number(text, where)
    from piezo_sym.run.signals import SIGNALS

    if call["name"] not in SIGNALS:
        what = f"{quote(call['name'])} is no signal"
        raise UsageError(what, where, remedy=nearest(call["name"], SIGNALS))
    words = [part.rpartition("=") for part in call["numbers"].split(",")]
    given = [number(value, where) for _, equals, value in words if not equals]
    named = {word.strip(): number(value, where) for word, equals, value in words if equals}
    try:
        return SIGNALS[call["name"]](*given, **named)
    except TypeError as error:
        what = f"{call['name']} does not take {quote(call['numbers'])}"
        raise UsageError(what, where, spelled(call["name"])) from error
    except UsageError as error:
        error.where = f"{where}: {error.where}"
        raise


def spelled(name: str) -> str:
    """Return a signal as it is written: sine(amplitude, frequency, offset=0, phase=0)."""
    from inspect import signature

    from piezo_sym.run.signals import SIGNALS

    taken = signature(SIGNALS[name]).parameters.values()
    words = (p.name if p.default is p.empty else f"{p.name}={p.default:g}" for p in taken)
    return f"{name}({', '.join(words)})"


def samples(path: str, where: str) -> Any:
    """Return the samples in a delimited text file: its one column, or that named like the input."""
    from piezo_sym.run.samples import column_headers, samples_from_csv

    if not path:
        raise UsageError("'@' names no file", where, "@FILE.csv")
    name = where.rpartition(" ")[2]
    columns = [column for column, _ in column_headers(path)]
    if len(columns) > 2 and name not in columns[1:]:
        what = f"{path_text(Path(path))} has no column {quote(name)} beside its times"
        raise UsageError(
            what, where, remedy=f"columns: {listing(columns)}; name one like the input"
        )
    return samples_from_csv(path, name if name in columns[1:] else None)


def number(text: str, where: str) -> float:
    """Return a number."""
    try:
        value = float(text.replace("_", "x"))  # float() would skip underscores
    except ValueError:
        expected = "such as 0.5 or 1e-3, in SI"
        raise UsageError(f"{quote(text)} is no number", where, expected) from None
    return int(value) if value.is_integer() and text.strip().isdigit() else value


def numbers(
    text: str, where: str, read: Callable[[str, str], float] = number
) -> float | list[float]:
    """Return a number, or a list of them for the lanes of a bank; `read` converts each."""
    values = [read(part, where) for part in text.split(",")]
    return values[0] if len(values) == 1 else values
