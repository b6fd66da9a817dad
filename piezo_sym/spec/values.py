"""Values of a spec, apart from all else that it says: what an edit changes without a new proof.

Input: plain data of a spec, as TOML gives it, or the texts of a module.  Output: the hash of what
is proved, and texts with other values.  Nothing here needs the spec's types, so that a run can tell
an edit of a value without loading them.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from fractions import Fraction
from typing import Any, TypeAlias, final

from piezo_sym.expressions.units import scaled
from piezo_sym.spec.write import MAX_SIZE, spec_hash

Texts: TypeAlias = dict[str, str]
#: Where numbers stand in a spec, and what a number is called there.
TABLES = {"parameters": "value", "inputs": "default"}
#: The places of a spec's hash and of its verdict in a template; no parameter has these names.
HASH, VERDICT = "#", "!"
#: What stands in a template for a value or the hash; no text of a spec holds such characters.
PLACE = re.compile("\0[^\0]+\0")


def place(name: str) -> str:
    """Return what stands in a template for a value."""
    return f"\0{name}\0"


def lane_name(name: str, lane: int) -> str:
    """Return what the value of one lane is called, counted from 0."""
    return f"{name}.{lane}"


@final
@dataclass(frozen=True)
class Template:
    """The texts of a module, with places for its values.

    Attributes
    ----------
    files : text by how the file's name ends.
    factors : name of a parameter or an input -> its unit in coherent SI, an exact fraction.
    quick : whether the module's own `margins` tell all that loading the spec checks of values.
    verdict : in one line; of values in the domain it says nothing else than of any others.
    """

    files: Mapping[str, str]
    factors: Mapping[str, str]
    quick: bool
    verdict: str = ""

    def filled(self, data: Mapping[str, Any]) -> Texts:
        """Return the texts for the values of a spec, which has the template's `shape_hash`."""
        values = {place(name): text for name, text in _number_texts(data, self.factors)}
        values |= {place(HASH): spec_hash(data), place(VERDICT): self.verdict}
        return {
            ending: PLACE.sub(lambda found: values[found[0]], text)
            for ending, text in self.files.items()
        }

    def to_json(self) -> str:
        """Return the template as JSON."""
        return json.dumps(asdict(self))


def from_json(text: str) -> Template | None:
    """Return a template; None if the text is none."""
    try:
        return Template(**json.loads(text))
    except (ValueError, TypeError):
        return None


def shape_hash(data: Mapping[str, Any]) -> str:
    """Return the SHA-256 of a spec without its values: of what its proofs and programs hold for."""
    tables = {name: _without_values(data.get(name, {}), key) for name, key in TABLES.items()}
    return spec_hash({**data, **tables})


def _without_values(table: Mapping[str, Any], key: str) -> dict[str, Any]:
    """Return a table in which every number is 1; what is no number stays, and is refused later."""
    return {
        name: {**entry, key: _unit(entry.get(key, 0.0))} if isinstance(entry, Mapping) else entry
        for name, entry in table.items()
    }


def _unit(value: Any) -> Any:
    if isinstance(value, (list, tuple)):
        return [_unit(item) for item in value]
    return 1.0 if _is_number(value) else value


def _is_number(value: Any) -> bool:
    number = isinstance(value, (int, float)) and not isinstance(value, bool)
    return number and math.isfinite(value) and abs(value) <= MAX_SIZE


def _number_texts(data: Mapping[str, Any], factors: Mapping[str, str]) -> Iterator[tuple[str, str]]:
    """Yield what stands for every value of a spec, in coherent SI."""
    for table, key in TABLES.items():
        for name, entry in data.get(table, {}).items():
            factor = Fraction(factors[name])
            for word, value in _named(name, entry.get(key, 0.0)):
                yield word, repr(scaled(float(value), factor))


def _named(name: str, value: Any) -> Iterator[tuple[str, float]]:
    if isinstance(value, (list, tuple)):
        yield from ((lane_name(name, lane), item) for lane, item in enumerate(value))
    else:
        yield name, value
