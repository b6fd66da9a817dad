"""Types and addresses of C, for what Python hands to a library."""

import ctypes
from typing import Any

from numpy.typing import NDArray

POINTER, LONG, INT, DOUBLE = ctypes.c_void_p, ctypes.c_long, ctypes.c_int, ctypes.c_double


def at(array: NDArray[Any]) -> ctypes.c_void_p:
    """Return the address of an array's numbers."""
    return ctypes.c_void_p(array.ctypes.data)
