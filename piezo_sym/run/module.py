"""The interface of generated modules, and the rows of their records in arrays.

Input: a module object from generated/<model>/<model>.py.  Output: the same object, checked to have
every name of the interface; the rows of each record.
"""

import re
from collections.abc import Callable, Mapping, Sequence
from itertools import accumulate, pairwise
from typing import Any, Protocol, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from piezo_sym.errors import UsageError, listing, quote
from piezo_sym.run.checks import FloatArray, known_keys


class Record(Protocol):
    """A row of an array: name, SI unit, description, and its bank if it has a row per lane."""

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
UNPROVED = "NOT PROVED"  # how the verdict of a module that is not proved begins


def checked(module: ModuleT) -> ModuleT:
    """Return `module` if it has every name of the interface; raise `UsageError` otherwise."""
    missing = [name for name in GeneratedModule.__annotations__ if not hasattr(module, name)]
    if missing:
        what = f"{quote(module)} is no generated module: it lacks {listing(missing, 4)}"
        remedy = "load a file that 'piezo-sym generate' wrote, or generate it again"
        raise UsageError(what, "simulate.module", "a generated module", remedy)
    return module


def verdict_of(module: GeneratedModule) -> str:
    """Return the verdict in a module's docstring: "skew, ... PROVED", "NOT PROVED (...)"."""
    line = re.search(r"^Proofs: +(.+)$", module.__doc__ or "", re.MULTILINE)
    return line[1] if line else f"{UNPROVED} (its head says nothing of proofs)"


def is_unproved(module: GeneratedModule) -> bool:
    """Return whether a module's docstring says that it is not proved.

    While a module is being proved, it says nothing.
    """
    return re.search(rf"^Proofs: +{UNPROVED}", module.__doc__ or "", re.MULTILINE) is not None


def held(module: GeneratedModule, margins: FloatArray) -> NDArray[np.bool_]:
    """Return whether each condition holds, by its margin (conditions, *batch); nan fails."""
    strict = np.array([condition.strict for condition in module.DOMAIN], dtype=bool)
    strict = strict.reshape(-1, *(1,) * (margins.ndim - 1))
    return np.where(strict, margins > 0, margins >= 0)


def lanes(parameters: Any, bank: str) -> int:
    """Return how many lanes `bank` has."""
    return int(getattr(parameters, f"{bank}_count"))


def rows(records: Sequence[Record], parameters: Any) -> tuple[slice, ...]:
    """Return the rows of each record in an array that spreads banks: one, or one per lane."""
    sizes = (lanes(parameters, record.bank) if record.bank else 1 for record in records)
    return tuple(slice(first, last) for first, last in pairwise(accumulate(sizes, initial=0)))


def by_name(records: Sequence[Record], parameters: Any, x: FloatArray) -> dict[str, Any]:
    """Return the rows of x (n,) by record: a number, for a bank one per lane."""
    slices = zip(records, rows(records, parameters), strict=True)
    return {r.name: x[row] if r.bank else float(x[row.start]) for r, row in slices}


def in_order(given: Mapping[str, Any], names: Sequence[str], where: str) -> list[Any]:
    """Return values by name as a list; raise `UsageError` if a name is unknown or left out."""
    values = known_keys(given, names, where)
    if missing := [name for name in names if name not in values]:
        expected = f"a number for each of {listing(names)}"
        raise UsageError(f"there is no {listing(map(quote, missing))}", where, expected)
    return [values[name] for name in names]


def row_count(records: Sequence[Record], parameters: Any) -> int:
    """Return the number of rows of an array that spreads banks."""
    return sum(lanes(parameters, record.bank) if record.bank else 1 for record in records)


def heat_exchanges(module: GeneratedModule) -> list[int]:
    """Return the numbers of the outputs of heat exchanges with the surroundings, such as ambients.

    Only these outputs are the temperatures of bodies.
    """
    return [n for n, record in enumerate(module.OUTPUTS) if record.unit == "K"]


def names_elsewhere(module: GeneratedModule, kind: str) -> dict[str, str]:
    """Return the names of the other kinds ("parameters", "initial", "inputs"), with their kind."""
    kinds = {"parameters": module.PARAMETERS, "initial": module.STATES, "inputs": module.INPUTS}
    return {r.name: other for other, records in kinds.items() if other != kind for r in records}


def row_names(records: Sequence[Record], parameters: Any) -> list[str]:
    """Return the names of all rows of an array that spreads banks: q, phi_1, phi_2, S."""
    names = []
    for record in records:
        size = lanes(parameters, record.bank) if record.bank else 0
        names += [f"{record.name}_{n + 1}" for n in range(size)] or [record.name]
    return names


def row_name(records: Sequence[Record], parameters: Any, row: int) -> str:
    """Return the name of one row, for a message: `q`, or `phi[2]` for the second lane."""
    slices = zip(records, rows(records, parameters), strict=True)
    record, first = next((r, place.start) for r, place in slices if row < place.stop)
    return f"{record.name}[{row - first + 1}]" if record.bank else record.name
