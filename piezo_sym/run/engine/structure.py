"""The parameters of a module as the C structure of its header.

Input: a module's `Parameters`, or a `ParameterTable` of many.  Output: a `Structure`, or
`Structures` one after another: numbers, then a pointer for each parameter of a bank to one number
per lane, in the order of the spec, then the sizes of banks.
"""

import ctypes
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, final
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from piezo_sym.run.checks import FloatArray
from piezo_sym.run.module import GeneratedModule, lanes
from piezo_sym.run.parameter_table import Column, ParameterTable

#: Structures kept: of the runs that go through C alone, which are asked for again and again.
REMEMBERED = 256


@final
@dataclass(frozen=True, eq=False)
class Structure:
    """A C structure and the arrays that its pointers point into."""

    value: ctypes.Structure
    arrays: tuple[FloatArray, ...]


@final
@dataclass(frozen=True, eq=False)
class Structures:
    """C structures of many runs, their addresses, and what their pointers point into."""

    addresses: NDArray[np.uintp]
    kept: tuple[object, ...]


@final
class Layout:
    """How a module's `Parameters` lie in C; called, it gives the structure of one run."""

    def __init__(self, module: GeneratedModule) -> None:
        self._module = module
        fields: list[tuple[str, Any]] = [
            (f"field_{n}", ctypes.c_void_p if record.bank else ctypes.c_double)
            for n, record in enumerate(module.PARAMETERS)
        ]
        fields += [(f"count_{n}", ctypes.c_long) for n, _ in enumerate(module.BANKS)]
        none = [("none", ctypes.c_char)]
        self._kind = type("Parameters", (ctypes.Structure,), {"_fields_": fields or none})
        self._record = record_of(self._kind)
        self._remembered = lru_cache(maxsize=REMEMBERED)(self._made)
        self._tables: WeakKeyDictionary[ParameterTable, Structures] = WeakKeyDictionary()

    def __call__(self, p: Any) -> Structure:
        """Return the structure of one run."""
        try:
            return self._remembered(p)
        except TypeError:  # a list among the values cannot be a key
            return self._made(p)

    def _made(self, p: Any) -> Structure:
        values: list[float | int] = []
        arrays: list[FloatArray] = []
        for record in self._module.PARAMETERS:
            value = getattr(p, record.name)
            if record.bank:
                arrays.append(_spread(value, lanes(p, record.bank)))
                values.append(arrays[-1].ctypes.data)
            else:
                values.append(float(value))
        values += [lanes(p, bank) for bank in self._module.BANKS]
        return Structure(self._kind(*values), tuple(arrays))

    def many(self, parameters: Sequence[Any]) -> Structures:
        """Return the structures of runs whose banks have equal sizes.

        Those of a `ParameterTable` are made once, and go with it.
        """
        if len(parameters) == 1:
            one = self(parameters[0])
            return Structures(np.array([ctypes.addressof(one.value)], dtype=np.uintp), (one,))
        table = ParameterTable.of(parameters)
        found = self._tables.get(table)
        if found is None:
            found = self._tables[table] = self._together(table)
        return found

    def _together(self, table: ParameterTable) -> Structures:
        base = self(table.base)
        records = np.full(len(table), np.frombuffer(memoryview(base.value), self._record))
        kept: list[object] = [base, records]
        for n, record in enumerate(self._module.PARAMETERS):
            column = table.columns.get(record.name)
            if column is not None and record.bank:
                kept.append(rows := _rows(column, lanes(table.base, record.bank)))
                records[f"field_{n}"] = addresses(rows)
            elif column is not None:
                records[f"field_{n}"] = column
        return Structures(addresses(records), tuple(kept))


@lru_cache(maxsize=64)
def record_of(kind: Any) -> np.dtype[np.void]:
    """Return a C structure's layout for NumPy: arrays of it are filled a column at a time."""
    plain = {ctypes.c_void_p: np.uintp, ctypes.c_double: np.float64, ctypes.c_long: np.dtype("l")}
    names = [name for name, _ in kind._fields_]
    formats: list[Any] = [
        plain[of] if of in plain else record_of(of) if hasattr(of, "_fields_") else np.dtype(of)
        for _, of in kind._fields_
    ]
    offsets = [getattr(kind, name).offset for name in names]
    parts = {"names": names, "formats": formats, "offsets": offsets}
    return np.dtype({**parts, "itemsize": ctypes.sizeof(kind)})  # type: ignore[call-overload,no-any-return]


def addresses(array: NDArray[Any]) -> NDArray[np.uintp]:
    """Return the address of each part of an array along its first axis."""
    first, apart = array.ctypes.data, array.strides[0]
    return (first + apart * np.arange(len(array))).astype(np.uintp)


def _rows(values: Column, count: int) -> FloatArray:
    """Return one number per lane, a row each; a value is a number or one per lane."""
    try:
        array = np.array(values, dtype=float)  # all of them numbers, or all one per lane
    except ValueError:
        return np.array([_spread(value, count) for value in values])
    if array.ndim == 1:
        array = array[:, None]
    return np.ascontiguousarray(np.broadcast_to(array, (len(values), count)))


def _spread(value: Any, count: int) -> FloatArray:
    """Return one number per lane."""
    array = np.array(value, dtype=float)
    if array.ndim and array.shape != (count,):
        msg = f"a parameter of a bank of {count} lanes has {array.size} values"
        raise ValueError(msg)
    return np.ascontiguousarray(np.broadcast_to(array, (count,)))
