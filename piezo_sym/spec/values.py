"""The values of a spec, which an edit may change without a new proof.

Input: plain data of a spec, as TOML gives it, or the texts of a module.  Output: the hash of a spec
without its values, and the texts of its module with new ones.  Nothing here needs the spec's types,
so that a run can recognise an edit of a value without loading them.
"""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, TypeAlias, final

from piezo_sym.expressions.units import scaled
from piezo_sym.spec.write import MAX_SIZE, spec_hash

Texts: TypeAlias = dict[str, str]
#: The tables that hold values, with the key of the value and its default.
TABLES: dict[str, tuple[str, float | None]] = {
    "parameters": ("value", None),
    "inputs": ("default", 0.0),
}
#: The names of the spec's hash and of the verdict in a template; no parameter has these names.
HASH, VERDICT = "#", "!"
#: The place of a value, or of the hash or verdict, in a template; no spec holds such characters.
PLACE = re.compile("\0[^\0]+\0")


def place(name: str) -> str:
    """Return the place of a value in a template."""
    return f"\0{name}\0"


def lane_name(name: str, lane: int) -> str:
    """Return the name of one lane's value, lanes counted from 0."""
    return f"{name}.{lane}"


@final
@dataclass(frozen=True)
class Template:
    """The texts of a module, with places for its values."""

    files: Mapping[str, str]  # text by ending of the file's name
    #: For each parameter and input, the exact factor from its unit to coherent SI.
    factors: Mapping[str, str]
    #: Whether the module's own `margins` cover all checks of values that loading a spec makes.
    quick: bool
    #: Whether stores are joined: then their initial values may contradict each other.
    joined: bool
    verdict: str = ""  # in one line; it holds for all values in the domain

    def filled(self, data: Mapping[str, Any]) -> Texts:
        """Return the texts for the values of a spec, which has the template's `shape_hash`.

        Raises `OverflowError` if a value is beyond all numbers in coherent SI, as loading refuses
        it.
        """
        values = {place(name): text for name, text in _number_texts(data, self.factors)}
        values |= {place(HASH): spec_hash(data), place(VERDICT): self.verdict}
        return {
            ending: PLACE.sub(lambda match: values[match[0]], text)
            for ending, text in self.files.items()
        }


def shape_hash(data: Mapping[str, Any]) -> str:
    """Return the SHA-256 of a spec without its values, on which proofs and programs depend."""
    return spec_hash(without_values(data))


def without_values(data: Mapping[str, Any]) -> dict[str, Any]:
    """Return the data of a spec with 1 for each of its values."""
    made = dict(data)
    for name, of_entry in TABLES.items():
        if isinstance(table := data.get(name), Mapping):
            made[name] = {word: _without_value(entry, *of_entry) for word, entry in table.items()}
    return made


def _without_value(entry: Any, key: str, default: float | None) -> Any:
    """Return an entry with 1 for its number; an entry of another form is refused later."""
    if not isinstance(entry, Mapping) or (value := entry.get(key, default)) is None:
        return entry
    return {**entry, key: _with_ones(value)}


def _with_ones(value: Any) -> Any:
    if isinstance(value, (list, tuple)):
        return [_with_ones(item) for item in value]
    number = isinstance(value, (int, float)) and not isinstance(value, bool)
    return 1.0 if number and abs(value) <= MAX_SIZE else value


def _number_texts(data: Mapping[str, Any], factors: Mapping[str, str]) -> Iterator[tuple[str, str]]:
    """Yield the name of every value of a spec, and its text in coherent SI."""
    for table, (key, default) in TABLES.items():
        for name, entry in data.get(table, {}).items():
            factor = Fraction(factors[name])
            for word, value in _lane_values(name, entry.get(key, default)):
                si = scaled(float(value) + 0.0, factor)  # -0.0 is 0.0
                if si and not 1 / MAX_SIZE <= abs(si) <= MAX_SIZE:
                    raise OverflowError(f"{name} is beyond all numbers")
                yield word, repr(si)


def _lane_values(name: str, value: Any) -> Iterator[tuple[str, float]]:
    if isinstance(value, (list, tuple)):
        yield from ((lane_name(name, lane), item) for lane, item in enumerate(value))
    else:
        yield name, value
