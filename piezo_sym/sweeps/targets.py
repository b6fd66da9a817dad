"""What can be swept: parameters, sizes of banks, inputs and initial values, by name.

Input: a generated module, a user's name for a quantity and its values.  Output: a `Target` with
checked values, one per point of an axis.

A name that belongs to several quantities needs a prefix: "parameters.x", "inputs.x", "initial.x".
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import Any, Literal, TypeAlias, final

import numpy as np

from piezo_sym.errors import UsageError, nearest, quote
from piezo_sym.run.checks import FloatArray, is_number, number, whole
from piezo_sym.run.functions import InputFunction
from piezo_sym.run.inputs import read_signal
from piezo_sym.run.module import GeneratedModule
from piezo_sym.run.parameters import lane_value
from piezo_sym.run.samples import Samples
from piezo_sym.run.signals import Signal

Kind: TypeAlias = Literal["parameters", "inputs", "initial"]
Value: TypeAlias = float | int | tuple[float, ...] | Signal
WORDS = {"parameters": "a parameter", "inputs": "an input", "initial": "a state"}
MOST_TEXT = 60


@final
@dataclass(frozen=True)
class Target:
    """A quantity and its values along an axis."""

    kind: Kind
    name: str
    unit: str
    doc: str
    bank: str | None  # to which it belongs, or whose size it is
    is_size: bool = False  # whether it is the number of lanes of a bank
    values: FloatArray | tuple[Value, ...] = ()  # one per point; tuples of one per lane
    texts: tuple[str, ...] = ()  # that label the values, if not all of them are numbers

    @property
    def coordinate(self) -> str:
        """The name of the coordinate that holds its values."""
        return f"initial_{self.name}" if self.kind == "initial" else self.name

    @property
    def divides(self) -> bool:
        """Whether runs with different values need separate calls of C."""
        return self.is_size or self.kind == "inputs"

    def along(self, values: FloatArray | tuple[Value, ...]) -> Target:
        """Return it with values, one per point."""
        numbers = isinstance(values, np.ndarray) or all(map(is_number, values))
        texts = () if numbers else distinct([label(value) for value in values])
        return replace(self, values=values, texts=tuple(texts))

    def part(self, points: slice) -> Target:
        """Return it with the values at some points."""
        return replace(self, values=self.values[points], texts=self.texts[points])

    def labels(self) -> Any:
        """Return its values as numbers (points,), or as one text each."""
        return self.texts or np.asarray(self.values)


def find(module: GeneratedModule, word: object, where: str) -> Target:
    """Return the quantity that a user's name means, without values."""
    known = list(targets(module))
    kind, dot, name = word.partition(".") if isinstance(word, str) else ("", "", word)
    if dot:
        found = [target for target in known if (target.kind, target.name) == (kind, name)]
    else:
        found = [target for target in known if target.name == word]
    if not found:
        names = [t.name for t in known] + [f"{t.kind}.{t.name}" for t in known if dot]
        raise UsageError(f"unknown name {quote(word)}", where, remedy=nearest(str(word), names))
    if len(found) > 1:
        both = " and ".join(WORDS[target.kind] for target in found)
        spelled = " or ".join(f"'{target.kind}.{word}'" for target in found)
        raise UsageError(f"{quote(word)} is {both}", where, remedy=f"write {spelled}")
    return found[0]


def targets(module: GeneratedModule) -> Iterator[Target]:
    """Yield all that can be swept."""
    for record in module.PARAMETERS:
        yield Target("parameters", record.name, record.unit, record.doc, record.bank)
    for bank in module.BANKS:
        doc = f"number of lanes of bank '{bank}'"
        yield Target("parameters", f"{bank}_count", "1", doc, bank, is_size=True)
    for record in module.INPUTS:
        yield Target("inputs", record.name, record.unit, record.doc, None)
    for record in module.STATES:
        doc = f"at t = 0: {record.doc}"
        yield Target("initial", record.name, record.unit, doc, record.bank)


def read_values(
    target: Target, given: Sequence[object] | FloatArray, where: str, duration: float
) -> FloatArray | tuple[Value, ...]:
    """Return a target's values, one per point; raise `UsageError` at the first that is invalid."""
    if target.is_size:
        return tuple(whole(value, f"{where}[{n}]", 1) for n, value in enumerate(given))
    if isinstance(given, np.ndarray) and given.ndim == 1 and given.dtype.kind in "iuf":
        wrong = np.flatnonzero(~np.isfinite(given))
        for n in wrong[:1]:
            number(given[n].item(), f"{where}[{n}]")
        return given.astype(float)
    if all(is_number(value) for value in given):
        return np.array([number(value, f"{where}[{n}]") for n, value in enumerate(given)])
    return tuple(
        read_value(target, value, f"{where}[{n}]", duration) for n, value in enumerate(given)
    )


def read_value(target: Target, value: object, where: str, duration: float) -> Value:
    """Return one value that need not be a number: a signal, or one number per lane."""
    if is_number(value):
        return number(value, where)
    if target.kind == "inputs":
        return read_signal(value, where, (0.0, duration), target.unit)
    size = len(value) if target.bank and isinstance(value, Sequence | np.ndarray) else None
    return lane_value(value, size, where)


def label(value: Value) -> str:
    """Return one value as a text for a coordinate."""
    if isinstance(value, Samples):
        text = f"samples({value.times.size})"
    elif isinstance(value, InputFunction):
        text = str(getattr(value.function, "__name__", type(value.function).__name__))
    elif is_dataclass(value):
        numbers = ", ".join(f"{getattr(value, field.name):g}" for field in fields(value))
        text = f"{type(value).__name__.lower()}({numbers})"
    elif isinstance(value, tuple):
        text = f"[{', '.join(f'{lane:g}' for lane in value)}]"
    else:
        text = f"{value:g}" if is_number(value) else type(value).__name__
    return text if len(text) <= MOST_TEXT else f"{text[: MOST_TEXT - 3]}..."


def distinct(texts: list[str]) -> list[str]:
    """Return texts, numbered where two are equal."""
    if len(set(texts)) == len(texts):
        return texts
    return [f"{n}: {text}" for n, text in enumerate(texts)]
