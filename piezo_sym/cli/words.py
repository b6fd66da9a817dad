"""Values of options on the command line: ``NAME=VALUE`` with numbers, signals or files.

Input: what a user typed; for `Units`, also the spec that declares the units of its parameters and
inputs: ``L=1.2e-3`` is in SI, ``L=1.2mH`` in its own unit.  Output: names and values in SI, or an
error that names the option.
"""

import re
from collections.abc import Callable, Iterable
from functools import cached_property
from pathlib import Path
from typing import Any, final

from piezo_sym.cli.output import about
from piezo_sym.errors import SpecError, UsageError, listing, nearest, quote
from piezo_sym.files import path_text

CALL = re.compile(r"(?P<name>[a-z]+)\((?P<numbers>[^()]*)\)")
NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
#: A number and its unit; the e of 1e3 is no unit.
IN_UNIT = re.compile(rf"\s*({NUMBER})\s*(?![eE][-+]?\d)([^\W\d_].*)")


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


@final
class Units:
    """The units of a spec's parameters and inputs.

    Attributes
    ----------
    assumed : a line for each number that was read in SI, although its declared unit is another.
    """

    def __init__(self, spec: str) -> None:
        self._spec = spec
        self.assumed: list[str] = []

    def numbers(self, text: str, where: str) -> float | list[float]:
        """Return a number, or a list of them for the lanes of a bank, each in its unit or SI."""
        if any(map(IN_UNIT.fullmatch, text.split(","))):
            return numbers(text, where, self._converted)
        self._assume(where)
        return numbers(text, where)

    def signal(self, text: str, where: str) -> Any:
        """Return a signal, or a number in its unit or SI."""
        if IN_UNIT.fullmatch(text):
            return self._converted(text, where)
        if not text.startswith("@"):
            self._assume(where)
        return signal(text, where)

    @cached_property
    def _declared(self) -> dict[str, str]:
        """The unit of each parameter and input that has one in the spec."""
        from piezo_sym.spec.source import data, find, read

        with about(self._spec, SpecError):
            content = data(read(find(self._spec)))
            if "components" in content:
                from piezo_sym.spec.load import load

                content = load(self._spec).flatten().model_dump()
        tables = (content.get(table) for table in ("parameters", "inputs"))
        entries = {k: v for table in tables if isinstance(table, dict) for k, v in table.items()}
        units = {k: v.get("unit") for k, v in entries.items() if isinstance(v, dict)}
        return {name: unit for name, unit in units.items() if isinstance(unit, str)}

    def _converted(self, text: str, where: str) -> float:
        from piezo_sym.expressions.units import parse_unit, to_si

        match = IN_UNIT.fullmatch(text)
        if match is None:
            raise UsageError(f"{quote(text)} has no unit", where, "a unit for each number, or none")
        value, (name, unit_part) = number(match[1], where), (where.rpartition(" ")[2], match[2])
        declared = self._declared.get(name, "1" if name.endswith("_count") else unit_part)
        unit = parse_unit(unit_part.strip(), where, value)
        if parse_unit(declared.strip()).dimension != unit.dimension:
            expected = "a plain number" if declared == "1" else f"one such as {declared}"
            raise UsageError(f"{quote(unit_part)} is no unit of {quote(name)}", where, expected)
        return to_si(value, unit)

    def _assume(self, where: str) -> None:
        from piezo_sym.expressions.units import parse_unit

        name = where.rpartition(" ")[2]
        if (declared := self._declared.get(name)) is None:
            return
        unit = parse_unit(declared, f"unit of {quote(name)}")
        if unit.factor != 1:
            line = f"{name}: read in {unit.si}, though the spec has {declared}"
            self.assumed.append(f"{line}; a number may say its unit: {name}=1.2{declared}")
