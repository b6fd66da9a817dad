"""C structures for Python: those declared in the files of this folder, and a model's parameters.

Input: the declarations, and a module's `Parameters`, of one run or of many.  Output: ctypes
structures, their addresses, and the arrays to which they point.
"""

import ctypes
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache, lru_cache
from itertools import repeat
from operator import is_
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from piezo_sym.run.checks import FloatArray
from piezo_sym.run.engine.c_sources import c_source
from piezo_sym.run.module import GeneratedModule, lanes

POINTER, LONG, INT, DOUBLE = ctypes.c_void_p, ctypes.c_long, ctypes.c_int, ctypes.c_double
_DECLARED = ("inputs.c", "trajectory.c", "batch.c", "step_once.c", "derivatives.c")
_NUMBERS = {"double": DOUBLE, "long": LONG}

#: The number of parameters whose structures are cached: calls of single runs use the same ones.
REMEMBERED = 256


@cache
def c_record(name: str) -> Any:
    """Return MODEL(name) as a ctypes structure, from its declaration in C.

    Fields are numbers, `double` or `long`, and pointers.
    """
    text = re.sub(r"/\*.*?\*/", "", c_source(*_DECLARED), flags=re.DOTALL)
    declaration = re.search(rf"typedef struct {{([^{{}}]*)}} MODEL\({name}\);", text)
    if not declaration:
        msg = f"no file declares a record {name}"
        raise LookupError(msg)
    return type(name, (ctypes.Structure,), {"_fields_": list(_fields(declaration[1]))})


def _fields(declarations: str) -> Iterator[tuple[str, Any]]:
    for declaration in declarations.split(";")[:-1]:
        if function := re.search(r"\(\*(\w+)\)", declaration):
            yield function[1], POINTER
            continue
        kind, names = declaration.replace("const ", "").split(maxsplit=1)
        for name in (one.strip() for one in names.split(",")):
            yield name.lstrip("*"), POINTER if name.startswith("*") else _NUMBERS[kind]


@cache
def record_dtype(name: str) -> np.dtype[Any]:
    """Return the NumPy type of an array of MODEL(name)."""
    dtype: np.dtype[Any] = np.dtype(c_record(name))
    return dtype


def at(array: NDArray[Any]) -> ctypes.c_void_p:
    """Return the address of an array's numbers."""
    return ctypes.c_void_p(array.ctypes.data)


def addresses(array: NDArray[Any]) -> NDArray[np.uintp]:
    """Return the address of each entry of an array along its first axis."""
    return np.arange(len(array), dtype=np.uintp) * array.strides[0] + array.ctypes.data


@final
@dataclass(frozen=True, eq=False)
class Structures:
    """C structures of some runs: the first, their addresses, and the arrays that they need."""

    value: ctypes.Structure
    addresses: NDArray[np.uintp]
    kept: tuple[object, ...]


@final
class ParameterRecords:
    """Converts a module's `Parameters` to the structure of its header.

    Its fields are in the order of the spec, a number each, or a pointer to one number per lane;
    then the sizes of banks.
    """

    def __init__(self, module: GeneratedModule) -> None:
        self._module = module
        fields: list[tuple[str, Any]] = [
            (f"field_{n}", POINTER if record.bank else DOUBLE)
            for n, record in enumerate(module.PARAMETERS)
        ]
        fields += [(f"count_{n}", LONG) for n, _ in enumerate(module.BANKS)]
        none = [("none", ctypes.c_char)]
        self._kind: Any = type("Parameters", (ctypes.Structure,), {"_fields_": fields or none})
        self._dtype: np.dtype[Any] = np.dtype(self._kind)
        self._cached = lru_cache(maxsize=REMEMBERED)(lambda p: self._made([p]))

    def __call__(self, p: Any) -> Structures:
        """Return the structure of one run."""
        try:
            return self._cached(p)
        except TypeError:  # a list among the values is not hashable
            return self._made([p])

    def many(self, parameters: Sequence[Any]) -> Structures:
        """Return the structures of runs whose banks have equal sizes."""
        return self(*parameters) if len(parameters) == 1 else self._made(parameters)

    def _made(self, parameters: Sequence[Any]) -> Structures:
        records: NDArray[Any] = np.zeros(len(parameters), self._dtype)
        kept: list[object] = [records]
        for n, record in enumerate(self._module.PARAMETERS):
            values: Any = [getattr(p, record.name) for p in parameters]
            if record.bank:
                rows = _rows(values, lanes(parameters[0], record.bank))
                kept.append(rows)
                values = addresses(rows)
            records[f"field_{n}"] = values
        for n, bank in enumerate(self._module.BANKS):
            records[f"count_{n}"] = lanes(parameters[0], bank)
        first = self._kind.from_address(records.ctypes.data)
        return Structures(first, addresses(records), tuple(kept))


def _rows(values: Sequence[Any], count: int) -> FloatArray:
    """Return the values of a parameter of a bank, (runs, lanes), or one row for all runs."""
    if all(map(is_, values, repeat(values[0]))):
        return _spread(values[0], count)[None]
    if all(isinstance(value, float) for value in values):
        return np.repeat(np.array(values, dtype=float)[:, None], count, axis=1)
    return np.array([_spread(value, count) for value in values])


def _spread(value: Any, count: int) -> FloatArray:
    array = np.array(value, dtype=float)
    if array.ndim and array.shape != (count,):
        msg = f"a parameter of a bank of {count} lanes has {array.size} values"
        raise ValueError(msg)
    return np.ascontiguousarray(np.broadcast_to(array, (count,)))
