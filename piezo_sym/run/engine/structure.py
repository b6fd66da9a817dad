"""The parameters of a module as the C structure of its header.

Input: a module's `Parameters`.  Output: a `Structure`: numbers, then a pointer for each parameter
of a bank to one number a lane, in the order of the spec, then the sizes of banks.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any, final

import numpy as np

from piezo_sym.run.module import lanes

if TYPE_CHECKING:
    from piezo_sym.run.checks import FloatArray
    from piezo_sym.run.module import GeneratedModule

#: Structures kept: of the runs that go through C together, which are asked for again and again.
REMEMBERED = 256


@final
@dataclass(frozen=True, eq=False)
class Structure:
    """A C structure and the arrays that its pointers point into."""

    value: ctypes.Structure
    arrays: tuple[FloatArray, ...]


def structure_of(module: GeneratedModule) -> Callable[[Any], Structure]:
    """Return the function from a module's `Parameters` to its C structure."""
    fields: list[tuple[str, Any]] = [
        (f"field_{n}", ctypes.c_void_p if record.bank else ctypes.c_double)
        for n, record in enumerate(module.PARAMETERS)
    ]
    fields += [(f"count_{n}", ctypes.c_long) for n, _ in enumerate(module.BANKS)]
    kind = type(
        "Parameters", (ctypes.Structure,), {"_fields_": fields or [("none", ctypes.c_char)]}
    )

    def made(p: Any) -> Structure:
        values: list[float | int] = []
        arrays: list[FloatArray] = []
        for record in module.PARAMETERS:
            value = getattr(p, record.name)
            if record.bank:
                arrays.append(_spread(value, lanes(p, record.bank)))
                values.append(arrays[-1].ctypes.data)
            else:
                values.append(float(value))
        values += [lanes(p, bank) for bank in module.BANKS]
        return Structure(kind(*values), tuple(arrays))

    remembered = lru_cache(maxsize=REMEMBERED)(made)

    def structure(p: Any) -> Structure:
        try:
            return remembered(p)
        except TypeError:  # a list among the values cannot be a key
            return made(p)

    return structure


def _spread(value: Any, count: int) -> FloatArray:
    """Return one number a lane."""
    array = np.array(value, dtype=float)
    if array.ndim and array.shape != (count,):
        msg = f"a parameter of a bank of {count} lanes has {array.size} values"
        raise ValueError(msg)
    return np.ascontiguousarray(np.broadcast_to(array, (count,)))
