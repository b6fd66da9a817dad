"""Calls of C for every column of a batch.

Input: a library, the name of one of its loops, arrays (rows, columns) as NumPy has them, parameters
in C.  Output: rows (rows, columns), put into an array.
"""

import ctypes
from typing import Any

import numpy as np

from piezo_sym.run.checks import FloatArray
from piezo_sym.run.engine.records import INT, LONG, POINTER, at


def of_columns(
    library: ctypes.CDLL,
    model: str,
    name: str,
    x: FloatArray,
    u: FloatArray,
    p: Any,
    out: FloatArray,
) -> None:
    """Compute a function's rows for columns of x.

    Parameters
    ----------
    library : of the module of that model.
    name : of the function.
    x : states (n, columns).
    u : inputs (inputs, columns), or (inputs,) for all columns.
    p : the structure of the parameters.
    out : where rows go, (rows, columns), C-contiguous.
    """
    states, inputs = np.ascontiguousarray(x), np.ascontiguousarray(u)
    n, columns = x.shape
    sizes = n, inputs.shape[0], out.shape[0]
    space = np.empty(LONG.in_dll(library, f"{model}_tile").value * (sum(sizes) + 1))
    loop = ctypes.cast(getattr(library, f"{model}_{name}_columns"), POINTER)
    getattr(library, f"{model}_of_columns")(
        *(loop, at(states), at(inputs), ctypes.byref(p), at(out), LONG(columns)),
        *(*map(LONG, sizes), INT(inputs.ndim == 2), at(space)),
    )
