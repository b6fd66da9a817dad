"""Values of a spec, apart from all else that it says: what an edit changes without a new proof.

Input: plain data of a spec, as TOML gives it, or the texts of a module.  Output: the hash of what
is proved, and texts with other values.  Nothing here needs the spec's types, so that a run can tell
an edit of a value without loading them.
"""

import hashlib
import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from fractions import Fraction
from typing import Any, TypeAlias, final

from piezo_sym.expressions.units import scaled
from piezo_sym.spec.write import MAX_SIZE, spec_hash

Texts: TypeAlias = dict[str, str]
#: Where numbers stand in a spec, what a number is called there, and what it is if it is left out.
TABLES: dict[str, tuple[str, float | None]] = {
    "parameters": ("value", None),
    "inputs": ("default", 0.0),
}
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
        """Return the texts for the values of a spec, which has the template's `shape_hash`.

        Raises
        ------
        OverflowError
            If a value is beyond all numbers in coherent SI, as loading refuses it.
        """
        values = {place(name): text for name, text in _number_texts(data, self.factors)}
        values |= {place(HASH): spec_hash(data), place(VERDICT): self.verdict}
        return {
            ending: PLACE.sub(lambda found: values[found[0]], text)
            for ending, text in self.files.items()
        }

    def to_text(self) -> str:
        """Return the template as JSON, after its digest."""
        text = json.dumps(asdict(self))
        return f"{_digest(text)}\n{text}"


def from_text(text: str) -> Template | None:
    """Return a template; None if the text is not as it was written."""
    digest, _, content = text.partition("\n")
    return Template(**json.loads(content)) if digest == _digest(content) else None


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()


def shape_hash(data: Mapping[str, Any]) -> str:
    """Return the SHA-256 of a spec without its values: of what its proofs and programs hold for."""
    tables = {
        name: {word: _without_value(entry, *TABLES[name]) for word, entry in data[name].items()}
        for name in TABLES.keys() & data.keys()
    }
    return spec_hash({**data, **tables})


def _without_value(entry: Any, key: str, default: float | None) -> Any:
    """Return an entry whose number is 1; what is none, or missing, stays and is refused later."""
    if not isinstance(entry, Mapping) or (value := entry.get(key, default)) is None:
        return entry
    return {**entry, key: _unit(value)}


def _unit(value: Any) -> Any:
    if isinstance(value, (list, tuple)):
        return [_unit(item) for item in value]
    return 1.0 if _is_number(value) else value


def _is_number(value: Any) -> bool:
    number = isinstance(value, (int, float)) and not isinstance(value, bool)
    return number and abs(value) <= MAX_SIZE  # so it is finite


def _number_texts(data: Mapping[str, Any], factors: Mapping[str, str]) -> Iterator[tuple[str, str]]:
    """Yield what stands for every value of a spec, in coherent SI."""
    for table, (key, default) in TABLES.items():
        for name, entry in data.get(table, {}).items():
            factor = Fraction(factors[name])
            for word, value in _named(name, entry.get(key, default)):
                si = scaled(float(value), factor)
                if si and not 1 / MAX_SIZE <= abs(si) <= MAX_SIZE:
                    msg = f"{name} is beyond all numbers"
                    raise OverflowError(msg)
                yield word, repr(si)


def _named(name: str, value: Any) -> Iterator[tuple[str, float]]:
    if isinstance(value, (list, tuple)):
        yield from ((lane_name(name, lane), item) for lane, item in enumerate(value))
    else:
        yield name, value
