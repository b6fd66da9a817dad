"""Calls of C for every column of a batch: one after another, or as many at once as a vector holds.

Input: a function of a library, arrays (rows, columns) as NumPy has them, parameters in C.  Output:
rows (rows, columns), put into an array.
"""

import ctypes
from typing import Any

import numpy as np

from piezo_sym.run.checks import FloatArray
from piezo_sym.run.engine.records import LONG, at


def one_by_one(function: Any, x: FloatArray, u: FloatArray, p: Any, out: FloatArray) -> None:
    """Compute a function's rows, columns taken from x and put back in turn.

    Parameters
    ----------
    function : of the loop over columns.
    x : states (n, columns).
    u : inputs (inputs, columns), or (inputs,) for all columns.
    p : the structure of the parameters.
    out : where rows go, (rows, columns).
    """
    states, inputs = np.ascontiguousarray(x.T), np.ascontiguousarray(u.T)
    found = np.empty(out.shape[::-1])
    sizes = (*states.shape, inputs.shape[1] if inputs.ndim == 2 else 0, out.shape[0])
    function(at(states), at(inputs), ctypes.byref(p), at(found), *map(LONG, sizes))
    out[:] = found.T


def at_once(
    function: Any, tile: int, x: FloatArray, u: FloatArray, p: Any, out: FloatArray
) -> None:
    """Compute what `one_by_one` does, by a function that takes vectors; `out` is C-contiguous.

    Parameters
    ----------
    tile : the columns that the function takes to vectors together.
    """
    n, count = x.shape
    states, inputs = np.ascontiguousarray(x), np.ascontiguousarray(u)
    sizes = (LONG * 3)(n, inputs.shape[0], out.shape[0])
    space = np.empty(tile * (sum(sizes) + 1))
    skipped = -space.ctypes.data % (8 * tile) // 8  # vectors have to be aligned
    own = ctypes.c_int(inputs.ndim == 2)
    function(
        *(at(states), at(inputs), ctypes.byref(p), at(out)),
        *(LONG(count), sizes, own, at(space[skipped:])),
    )
