"""Functions of a compiled module for many runs, each with parameters of its own.

Input: an `Engine`, states (runs, k, n), parameters.  Output: rows (runs, k, rows).  A run costs a
bare call of C, for arrays lie there as C wants them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, final

import numpy as np

from piezo_sym.run.engine.march import LONG, POINTER, at

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from piezo_sym.run.checks import FloatArray
    from piezo_sym.run.engine.engine import Engine


@final
class Members:
    """The parameters of some runs in C, and the functions of their states.

    Parameters
    ----------
    engine : the compiled module.
    parameters : of each run, of equal sizes.
    """

    def __init__(self, engine: Engine, parameters: Sequence[Any]) -> None:
        self._engine = engine
        self._kept = engine.structure.many(parameters)
        self._places = [POINTER(place) for place in self._kept.addresses.tolist()]

    def inside(self, x: FloatArray, u: FloatArray) -> NDArray[np.bool_]:
        """Return which states (runs, k, n) lie in the domain, and have a finite rate, (runs, k)."""
        domain = self._engine.module.DOMAIN
        margins = self("margins", x, len(domain), u)
        strict = np.array([condition.strict for condition in domain], dtype=bool)
        held = np.where(strict, margins > 0, margins >= 0)
        finite = np.isfinite(self("rhs", x, x.shape[2], u))
        good: NDArray[np.bool_] = np.all(held, axis=2) & np.all(finite, axis=2)
        return good

    def __call__(
        self, name: str, x: FloatArray, rows: int, u: FloatArray | None = None
    ) -> FloatArray:
        """Return a function's rows (runs, k, rows).

        Parameters
        ----------
        name : of the function, such as "outputs".
        x : states (runs, k, n), C-contiguous.
        rows : that it gives.
        u : inputs (k, inputs) for all runs, C-contiguous; None for a function without.
        """
        engine = self._engine
        function = getattr(engine.library, f"{engine.module.NAME}_{name}_columns")
        out = np.empty((*x.shape[:2], rows))
        inputs = np.empty((1, 0)) if u is None else u
        sizes = (x.shape[1], x.shape[2], inputs.shape[1], rows)
        longs, u_at = tuple(map(LONG, sizes)), at(inputs)
        x_at, out_at = x.ctypes.data, out.ctypes.data
        for k, place in enumerate(self._places):
            there = (POINTER(x_at + k * x.strides[0]), u_at, place)
            function(*there, POINTER(out_at + k * out.strides[0]), *longs)
        return out
