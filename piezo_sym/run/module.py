"""What a generated module offers: the one interface that this stage runs.

Input: a module object from generated/<model>/<model>.py.  Output: the same object, checked to have
every name of the interface, and the rows that each of its records takes in an array.
"""

import re
from collections.abc import Callable, Sequence
from typing import Any, Protocol, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from piezo_sym.errors import UsageError, listing, quote
from piezo_sym.run.checks import FloatArray


class Record(Protocol):
    """A row of an array: name, SI unit, one line on it, its bank if it has a row per lane."""

    name: str
    unit: str
    doc: str
    bank: str | None


class Condition(Protocol):
    """A condition of the domain: its text, and whether its margin must be > 0 or only >= 0."""

    text: str
    strict: bool


class GeneratedModule(Protocol):
    """A generated module; x is (n, *batch), u is (inputs, *batch), p its frozen `Parameters`."""

    NAME: str
    SPEC_SHA256: str
    STATES: Sequence[Record]
    INPUTS: Sequence[Record]
    INPUT_DEFAULTS: Sequence[float]
    OUTPUTS: Sequence[Record]
    PROCESSES: Sequence[Record]
    BODIES: Sequence[Record]
    ELEMENTS: Sequence[Record]
    BANKS: Sequence[str]
    PARAMETERS: Sequence[Record]
    DOMAIN: Sequence[Condition]
    Parameters: Callable[..., Any]
    initial_state: Callable[[FloatArray, Any], FloatArray]
    rhs: Callable[[ArrayLike, ArrayLike, Any], FloatArray]
    jacobian: Callable[[ArrayLike, ArrayLike, Any], FloatArray]
    outputs: Callable[[ArrayLike, ArrayLike, Any], FloatArray]
    supply: Callable[[ArrayLike, ArrayLike, Any], FloatArray]
    energy: Callable[[ArrayLike, Any], FloatArray]
    entropy: Callable[[ArrayLike, Any], FloatArray]
    temperatures: Callable[[ArrayLike, Any], FloatArray]
    heat: Callable[[ArrayLike, ArrayLike, Any], FloatArray]
    entropy_production: Callable[[ArrayLike, ArrayLike, Any], FloatArray]
    elements: Callable[[ArrayLike, ArrayLike, Any], FloatArray]
    margins: Callable[[ArrayLike, ArrayLike, Any], FloatArray]


ModuleT = TypeVar("ModuleT")
UNPROVED = "NOT PROVED"  # what the verdict of a module begins with that is not proved


def checked(module: ModuleT) -> ModuleT:
    """Return `module` if it has every name of the interface; raise `UsageError` otherwise."""
    missing = [name for name in GeneratedModule.__annotations__ if not hasattr(module, name)]
    if missing:
        what = f"{quote(module)} is no generated module: it lacks {listing(missing, 4)}"
        remedy = "load a file that 'piezo-sym generate' wrote, or generate it again"
        raise UsageError(what, "simulate.module", "a generated module", remedy)
    return module


def verdict_of(module: GeneratedModule) -> str:
    """Return what a module's head says of its proofs: "skew, ... PROVED", or "NOT PROVED (...)"."""
    found = re.search(r"^Proofs: +(.+)$", module.__doc__ or "", re.MULTILINE)
    return found[1] if found else f"{UNPROVED} (its head says nothing of proofs)"


def held(module: GeneratedModule, margins: FloatArray) -> NDArray[np.bool_]:
    """Return whether each condition holds, from its margin (conditions, *batch); nan does not."""
    strict = np.array([condition.strict for condition in module.DOMAIN], dtype=bool)
    strict = strict.reshape(-1, *(1,) * (margins.ndim - 1))
    return np.where(strict, margins > 0, margins >= 0)


def lanes(parameters: Any, bank: str) -> int:
    """Return how many lanes `bank` has."""
    return int(getattr(parameters, f"{bank}_count"))


def rows(records: Sequence[Record], parameters: Any) -> tuple[slice, ...]:
    """Return the rows of each record in an array that spreads banks: one, or one per lane."""
    found: list[slice] = []
    start = 0
    for record in records:
        size = lanes(parameters, record.bank) if record.bank else 1
        found.append(slice(start, start + size))
        start += size
    return tuple(found)


def by_name(records: Sequence[Record], parameters: Any, x: FloatArray) -> dict[str, Any]:
    """Return the rows of x (n,) by record: a number, for a bank one per lane."""
    parts = zip(records, rows(records, parameters), strict=True)
    return {r.name: x[part] if r.bank else float(x[part.start]) for r, part in parts}


def row_count(records: Sequence[Record], parameters: Any) -> int:
    """Return the number of rows of an array that spreads banks."""
    return sum(lanes(parameters, record.bank) if record.bank else 1 for record in records)


def exchanges(module: GeneratedModule) -> list[int]:
    """Return which outputs belong to heat exchanges with the surroundings, such as ambients.

    Their output is the temperature of a body; no other port has one.
    """
    return [n for n, record in enumerate(module.OUTPUTS) if record.unit == "K"]


def others(module: GeneratedModule, kind: str) -> dict[str, str]:
    """Return names that are no `kind` ("parameters", "initial", "inputs"), and which they are."""
    kinds = {"parameters": module.PARAMETERS, "initial": module.STATES, "inputs": module.INPUTS}
    return {r.name: name for name, records in kinds.items() if name != kind for r in records}


def row_names(records: Sequence[Record], parameters: Any) -> list[str]:
    """Return the names of all rows of an array that spreads banks: q, phi_1, phi_2, S."""
    found = []
    for record in records:
        size = lanes(parameters, record.bank) if record.bank else 0
        found += [f"{record.name}_{n + 1}" for n in range(size)] or [record.name]
    return found


def row_name(records: Sequence[Record], parameters: Any, row: int) -> str:
    """Return the name of one row, for a message: `q`, or `phi[2]` for the second lane."""
    for record, part in zip(records, rows(records, parameters), strict=True):
        if part.start <= row < part.stop:
            return f"{record.name}[{row - part.start + 1}]" if record.bank else record.name
    return str(row)
