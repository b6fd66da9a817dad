"""Values of options on the command line: ``NAME=VALUE`` with numbers, signals or files.

Input: what a user typed; for `Units`, also the spec, which knows the units of its parameters,
inputs and states: ``L=1.2e-3`` is in SI, ``L=1.2mH`` in its own unit.  Output: names and values in
SI, or an error that names the option.
"""

import re
from collections.abc import Callable, Iterable
from functools import cached_property
from inspect import Parameter, signature
from pathlib import Path
from typing import Any, NoReturn, final

from piezo_sym.cli.output import about
from piezo_sym.errors import SpecError, UsageError, listing, nearest, quote
from piezo_sym.expressions.incomplete import with_a_point
from piezo_sym.files import path_text
from piezo_sym.run.checks import known_keys

CALL = re.compile(r"(?P<name>[a-z]+)\((?P<numbers>[^()]*)(?P<end>\)?)")
NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
#: A number and its unit; the e of 1e3 is no unit.
IN_UNIT = re.compile(rf"\s*({NUMBER})\s*(?![eE][-+]?\d)([^\W\d_].*)")
#: A formula in place of a signal, and one that is a sine.
FORMULA = re.compile(r"(?<![\w.])(?:sin|cos|exp)\(.*t|\*\s*t\b|\bpi\b")
SINE = re.compile(rf"(?:({NUMBER})\*)?sin\(2\*pi\*(?:({NUMBER})\*)?t\)({NUMBER})?")
#: The units of the numbers of signals; all others have that of the input.
UNITS = {
    **dict.fromkeys(("frequency", "f_start", "f_stop"), "Hz"),
    **dict.fromkeys(("time", "start", "stop", "duration"), "s"),
    "phase": "rad",
}


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


def _refuse_formula(text: str, where: str) -> NoReturn:
    sine = SINE.fullmatch(text.replace(" ", ""))
    numbers = [sine[1] or "1", sine[2] or "1", *([sine[3]] if sine[3] else [])] if sine else []
    remedy = f"write sine({', '.join(numbers)})" if sine else "or a table, @FILE.csv"
    raise UsageError(f"{quote(text)} is a formula", where, spelled("sine"), remedy)


def _signal_parameters(name: str) -> dict[str, Any]:
    """Return the names of a signal's parameters, with their defaults."""
    from piezo_sym.run.signals import SIGNALS

    return {p.name: p.default for p in signature(SIGNALS[name]).parameters.values()}


def spelled(name: str) -> str:
    """Return a signal as it is written: square(amplitude, frequency [Hz], offset=0)."""
    words = (
        (word if default is Parameter.empty else f"{word}={default:g}")
        + (f" [{UNITS[word]}]" if word in UNITS else "")
        for word, default in _signal_parameters(name).items()
    )
    return f"{name}({', '.join(words)})"


def samples(path: str, where: str) -> Any:
    """Return the samples in a delimited text file: its one column, or that named like the input."""
    from piezo_sym.run.sample_files import samples_from_csv
    from piezo_sym.run.text_tables import column_headers

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
        expected, remedy = "such as 0.5 or 1e-3, in SI", with_a_point(text)
        raise UsageError(f"{quote(text)} is no number", where, expected, remedy) from None
    return int(value) if value.is_integer() and text.strip().isdigit() else value


def in_unit(text: str, where: str, needed: str, name: str = "") -> float:
    """Return a number in SI: a plain one, or one with a unit like `needed`; with any if it is "".

    `name` is what the number is of, in a message.
    """
    from piezo_sym.expressions.units import parse_unit, to_si

    match = IN_UNIT.fullmatch(text)
    if match is None:
        return number(text, where)
    value, given = number(match[1], where), match[2].strip()
    unit = parse_unit(given, where, value)
    other = parse_unit(needed or given).dimension != unit.dimension
    if other or (needed == "Hz" and not given.endswith("Hz")):  # rpm is in rad/s
        expected = "a plain number" if needed == "1" else f"one such as {needed}"
        of = f" of {quote(name)}" if name else ""
        raise UsageError(f"{quote(given)} is no unit{of}", where, expected)
    return to_si(value, unit)


@final
class Units:
    """The units of a spec's parameters, inputs and states.

    Attributes
    ----------
    assumed : a line for each number that was read in SI, although its declared unit is another.
    """

    def __init__(self, spec: str) -> None:
        self._spec = spec
        self.assumed: list[str] = []

    def numbers(self, text: str, where: str) -> float | list[float]:
        """Read a number, or one per lane of a bank, each with its unit or in SI."""
        return self._numbers(text, where, self._unit)

    def initial(self, text: str, where: str) -> float | list[float]:
        """Read a state's initial value, or one per lane of a bank, with its unit or in SI."""
        return self._numbers(text, where, lambda name: self._states.get(name, ""))

    def _numbers(self, text: str, where: str, unit_of: Callable[[str], str]) -> float | list[float]:
        parts, name = text.split(","), where.rpartition(" ")[2]
        in_units = any(map(IN_UNIT.fullmatch, parts))
        if not in_units:
            self._assume(where, text)
        unit = "1" if name.endswith("_count") else unit_of(name) if in_units else ""
        if text.startswith("["):
            remedy = f"write {text.strip('[]')} without them"
            raise UsageError(f"{quote(text)} has brackets", where, remedy=remedy)

        def read(part: str) -> float:
            if in_units and not IN_UNIT.fullmatch(part):
                expected = "a unit for each number, or none"
                raise UsageError(f"{quote(part)} has no unit", where, expected)
            return in_unit(part, where, unit, name)

        values = [read(part) for part in parts]
        return values[0] if len(values) == 1 else values

    def signal(self, text: str, where: str) -> Any:
        """Return a number, a signal such as ``sine(100, 100, offset=50)``, or ``@drive.csv``.

        Nothing is evaluated. Numbers are in the units of the input, or those they say, or in SI.
        """
        if text.startswith("@"):  # or the column of that name would be looked for
            known = self._content.get("inputs") or ()
            known_keys({where.rpartition(" ")[2]: text}, known, "--input")
            return samples(text[1:], where)
        from piezo_sym.run.signals import SIGNALS

        if text in SIGNALS:
            raise UsageError(f"{quote(text)} has no numbers", where, spelled(text))
        call = CALL.fullmatch(text)
        if text.endswith((".csv", ".txt")):
            raise UsageError(f"{quote(text)} is a file", where, f"@{text}")
        if FORMULA.search(text):
            _refuse_formula(text, where)
        if call is None:
            return self._value(text, where)
        name = call["name"]
        if name not in SIGNALS:
            raise UsageError(f"{quote(name)} is no signal", where, remedy=nearest(name, SIGNALS))
        if not call["end"]:
            raise UsageError(f"{quote(text)} has no ')' at its end", where, spelled(name))
        given, named = self._arguments(name, call["numbers"], where)
        try:
            return SIGNALS[name](*given, **named)
        except UsageError as error:
            if error.expected.startswith(f"{name}("):
                error.expected = spelled(name)
            error.put_in(where)
            raise

    def _arguments(self, name: str, text: str, where: str) -> tuple[list[float], dict[str, float]]:
        """Return the numbers of a signal, by place and by name, in SI."""
        words = [part.rpartition("=") for part in text.split(",")]
        plain = [value for _, equals, value in words if not equals]
        named = {word.strip(): value for word, equals, value in words if equals}
        places = [*_signal_parameters(name), *[""] * len(plain)]  # too many are refused later
        given = [
            self._value(value, where, word) for value, word in zip(plain, places, strict=False)
        ]
        return given, {word: self._value(value, where, word) for word, value in named.items()}

    def _value(self, text: str, where: str, place: str = "") -> float:
        """Return the number of a signal at one of its places, or that of an input, in SI."""
        if place in UNITS:
            return in_unit(text, where, UNITS[place], place)
        if not IN_UNIT.fullmatch(text):
            self._assume(where)
        name = where.rpartition(" ")[2]
        try:
            return in_unit(text, where, self._unit(name), place or name)
        except SpecError as error:
            error.remedy += "; the header of a .csv may say degC" * ("offset" in error.what)
            raise

    @cached_property
    def _states(self) -> dict[str, str]:
        """The SI unit of each state, and of ``T_<body>``."""
        from piezo_sym.spec.places import state_dimensions
        from piezo_sym.spec.tables import bodies
        from piezo_sym.spec.unit_text import unit_text

        hot = {f"T_{body}": "K" for body in bodies(self._flat)}
        return hot | {name: unit_text(d) for name, d in state_dimensions(self._flat).items()}

    @cached_property
    def _flat(self) -> Any:
        from piezo_sym.spec.load import load

        with about(self._spec):
            return load(self._spec).flatten()

    @cached_property
    def _entries(self) -> dict[str, dict[str, Any]]:
        """What the spec says of each parameter and input."""
        tables = (self._content.get(table) for table in ("parameters", "inputs"))
        entries = {k: v for table in tables if isinstance(table, dict) for k, v in table.items()}
        return {name: entry for name, entry in entries.items() if isinstance(entry, dict)}

    def _unit(self, name: str) -> str:
        """Return the unit of a parameter or input in the spec, or ''."""
        unit = self._entries.get(name, {}).get("unit", "")
        return unit if isinstance(unit, str) else ""

    @cached_property
    def _content(self) -> dict[str, Any]:
        """The spec's tables; of one with components, with their elements."""
        from piezo_sym.spec.source import data, find, read

        with about(self._spec, SpecError):
            content = data(read(find(self._spec)))
            if "components" in content:
                content = self._flat.model_dump()
        return content

    def _assume(self, where: str, text: str = "") -> None:
        from piezo_sym.expressions.units import parse_unit

        name = where.rpartition(" ")[2]
        declared, value = self._unit(name), self._entries.get(name, {}).get("value")
        unit = parse_unit(declared or "1", f"unit of {quote(name)}")
        if unit.factor != 1:
            line = f"{name}: read in {unit.si}, though the spec has {declared}"
            if value is not None:
                line = f"{name} = {text} {unit.si} (spec: {value} {declared})"
            line += f"; a number may say its unit: {name}=1.2{declared}"
            self.assumed += [line] * (line not in self.assumed)
