"""Functions of a compiled module for many runs, each with parameters of its own.

Input: an `Engine`, states (runs, k, n), parameters.  Output: rows (runs, k, rows).  C goes from run
to run, for arrays lie there as it wants them.
"""

import ctypes
from collections.abc import Sequence
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from piezo_sym.run.checks import FloatArray
from piezo_sym.run.engine.engine import Engine
from piezo_sym.run.engine.records import LONG, POINTER, at


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
        library, model = engine.library, engine.module.NAME
        loop = ctypes.cast(getattr(library, f"{model}_{name}_columns"), POINTER)
        places = self._kept.addresses
        out = np.empty((*x.shape[:2], rows))
        inputs = np.empty((1, 0)) if u is None else u
        sizes = map(LONG, (x.shape[1], x.shape[2], inputs.shape[1], rows))
        arrays = at(x), at(inputs), at(out)
        getattr(library, f"{model}_of_members")(
            loop, at(places), LONG(len(places)), *arrays, *sizes
        )
        return out
