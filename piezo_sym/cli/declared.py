"""Numbers on the command line, in SI or in units of their own: ``L=1.2e-3``, ``L=1.2mH``.

Input: what a user typed, and the spec that declares the units of its parameters and inputs.
Output: numbers in coherent SI, and a line for each number without unit whose declared unit is not
SI.
"""

import re
from functools import cached_property
from typing import Any, final

from piezo_sym.cli.output import about
from piezo_sym.cli.words import number, numbers, signal
from piezo_sym.errors import SpecError, UsageError, quote

NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
#: A number and its unit; the e of 1e3 is no unit.
IN_UNIT = re.compile(rf"\s*({NUMBER})\s*(?![eE][-+]?\d)([^\W\d_].*)")


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
        value, (name, said) = number(match[1], where), (where.rpartition(" ")[2], match[2])
        declared = self._declared.get(name, "1" if name.endswith("_count") else said)
        unit = parse_unit(said.strip(), where, value)
        if parse_unit(declared.strip()).dimension != unit.dimension:
            expected = "a plain number" if declared == "1" else f"one such as {declared}"
            raise UsageError(f"{quote(said)} is no unit of {quote(name)}", where, expected)
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
