"""A compiled module: the functions of its NumPy module, computed in C.

Input: a generated module.  Output: an `Engine`, and `Members` for many runs, each with parameters
of its own.  A call releases the interpreter's lock.
"""

from __future__ import annotations

import ctypes
import os
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from piezo_sym.errors import EngineError
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.engine.library import CACHE, Sources, read_source, shared_library
from piezo_sym.run.engine.records import INT, LONG, POINTER, ParameterRecords, at
from piezo_sym.run.module import GeneratedModule, row_count

#: The functions of a module that a library computes.
OFFERED = (
    *("initial_state", "rhs", "jacobian", "outputs", "supply", "heat", "entropy_production"),
    *("margins", "temperatures", "energy", "entropy"),
)


def engine_of(module: GeneratedModule) -> Engine:
    """Return the compiled engine of a module, loaded from a file with its .c and .h beside it.

    Raises
    ------
    EngineError
        If the sources are missing or of another spec, nothing can compile them, or the cache
        cannot be written.
    """
    sources = Sources(module.NAME, read_source(module, ".h"), read_source(module, ".c"))
    environment = tuple(map(os.environ.get, ("CC", "PATH", CACHE, "HOME")))
    found = _engine(module, sources, environment)  # type: ignore[arg-type]  # a module can be a key
    if isinstance(found, EngineError):
        raise found.with_traceback(None)
    return found


@lru_cache(maxsize=64)
def _engine(
    module: GeneratedModule, sources: Sources, environment: tuple[str | None, ...]
) -> Engine | EngineError:
    """Return a module's engine, or why there is none, kept: compilers that fail may take long."""
    del environment  # it tells one attempt from another
    try:
        return Engine(module, shared_library(sources), ParameterRecords(module), sources)
    except EngineError as error:
        return EngineError(error.what, error.where, error.expected, error.remedy)


@final
@dataclass(frozen=True)
class Engine:
    """The functions of a generated module, compiled; arguments and results as in the module.

    x is (n, *batch); u is (inputs,) or (inputs, *batch); p is the module's `Parameters`.
    """

    module: GeneratedModule
    library: ctypes.CDLL
    structure: ParameterRecords
    sources: Sources

    def initial_state(self, u: ArrayLike, p: Any, /) -> FloatArray:
        """Return the state at t = 0, shape (n,), for the inputs u (inputs,) at t = 0."""
        u = self._array(u, len(self.module.INPUTS), "inputs").ravel()
        out = np.empty(row_count(self.module.STATES, p))
        structure = self.structure(p)  # a name of its own keeps the arrays of its lanes alive
        self.function("initial_state")(at(u), ctypes.byref(structure.value), at(out))
        return out

    def rhs(
        self, x: ArrayLike, u: ArrayLike, p: Any, /, out: FloatArray | None = None
    ) -> FloatArray:
        """Return dx/dt, shape (n, *batch).

        Parameters
        ----------
        out : a C-contiguous array of that shape to put it in, apart from x and u: new memory for
            many states costs as much as their rates.
        """
        return self._called("rhs", x, u, p, row_count(self.module.STATES, p), out)

    def jacobian(self, x: ArrayLike, u: ArrayLike, p: Any, /) -> FloatArray:
        """Return the derivative of `rhs` by the state, shape (n, n, *batch)."""
        n = row_count(self.module.STATES, p)
        found = self._called("jacobian", x, u, p, n * n)
        return found.reshape(n, n, *found.shape[1:])

    def outputs(self, x: ArrayLike, u: ArrayLike, p: Any, /) -> FloatArray:
        """Return one y per port, shape (ports, *batch)."""
        return self._called("outputs", x, u, p, len(self.module.OUTPUTS))

    def supply(self, x: ArrayLike, u: ArrayLike, p: Any, /) -> FloatArray:
        """Return the power put in [W], shape (ports, *batch)."""
        return self._called("supply", x, u, p, len(self.module.OUTPUTS))

    def heat(self, x: ArrayLike, u: ArrayLike, p: Any, /) -> FloatArray:
        """Return the heat of each process [W], shape (processes, *batch), banks spread."""
        return self._called("heat", x, u, p, row_count(self.module.PROCESSES, p))

    def entropy_production(self, x: ArrayLike, u: ArrayLike, p: Any, /) -> FloatArray:
        """Return the entropy produced [W/K], shape (processes, *batch), banks spread."""
        return self._called("entropy_production", x, u, p, row_count(self.module.PROCESSES, p))

    def margins(self, x: ArrayLike, u: ArrayLike, p: Any, /) -> FloatArray:
        """Return the margin of each condition of the domain, shape (conditions, *batch)."""
        return self._called("margins", x, u, p, len(self.module.DOMAIN))

    def temperatures(self, x: ArrayLike, p: Any, /) -> FloatArray:
        """Return the temperature of each body [K], shape (bodies, *batch)."""
        return self._called("temperatures", x, None, p, len(self.module.BODIES))

    def energy(self, x: ArrayLike, p: Any, /) -> FloatArray:
        """Return the Hamiltonian U [J], shape (*batch)."""
        rows = self._called("energy", x, None, p, 1)
        return rows.reshape(rows.shape[1:])

    def entropy(self, x: ArrayLike, p: Any, /) -> FloatArray:
        """Return the total entropy [J/K], shape (*batch)."""
        rows = self._called("entropy", x, None, p, 1)
        return rows.reshape(rows.shape[1:])

    def _array(self, value: ArrayLike, rows: int, what: str) -> FloatArray:
        array = np.asarray(value, dtype=float)
        if array.shape[:1] != (rows,):
            msg = f"{what} have shape {array.shape}, but there are {rows}"
            raise ValueError(msg)
        return array

    def _called(
        self,
        name: str,
        x: ArrayLike,
        u: ArrayLike | None,
        p: Any,
        rows: int,
        out: FloatArray | None = None,
    ) -> FloatArray:
        """Return a function's rows for every column of a batch, shape (rows, *batch)."""
        states = self._array(x, row_count(self.module.STATES, p), "states")
        batch, structure = states.shape[1:], self.structure(p)  # it keeps its lanes' arrays alive
        width = int(np.prod(batch, dtype=int))
        columns = np.ascontiguousarray(states.reshape(states.shape[0], width))
        inputs = np.ascontiguousarray(self._inputs(u, batch))
        found = _place(out, (rows, *batch))
        sizes = columns.shape[0], inputs.shape[0], rows
        space = np.empty(
            LONG.in_dll(self.library, f"{self.module.NAME}_tile").value * (sum(sizes) + 1)
        )
        self.function("of_columns")(
            *(self.loop(name), at(columns), at(inputs), ctypes.byref(structure.value), at(found)),
            *(*map(LONG, (width, *sizes)), INT(inputs.ndim == 2), at(space)),
        )
        return found

    def function(self, word: str) -> Any:
        """Return a function of the library by its own name."""
        return getattr(self.library, f"{self.module.NAME}_{word}")

    def loop(self, name: str) -> ctypes.c_void_p:
        """Return the loop of a function over columns, for `of_columns` and `of_runs`."""
        return ctypes.cast(self.function(f"{name}_columns"), POINTER)

    def _inputs(self, u: ArrayLike | None, batch: tuple[int, ...]) -> FloatArray:
        """Return inputs (inputs, columns), or (inputs,) for all columns."""
        if u is None:
            return np.empty(0)
        size = len(self.module.INPUTS)
        given = self._array(u, size, "inputs")
        if given.ndim == 1:
            return given
        return np.broadcast_to(given, (size, *batch)).reshape(size, int(np.prod(batch, dtype=int)))


def _place(out: FloatArray | None, shape: tuple[int, ...]) -> FloatArray:
    """Return where results go: `out`, if it is fit for them."""
    if out is None:
        return np.empty(shape)
    if out.shape != shape or out.dtype != float or not out.flags.carray:
        msg = f"out has to be a C-contiguous array of numbers of shape {shape}"
        raise ValueError(msg)
    return out


@final
class Members:
    """The functions of a module for some runs of equal sizes, each with parameters of its own."""

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
        out = np.empty((*x.shape[:2], rows))
        inputs = np.empty((1, 0)) if u is None else u
        places = self._kept.addresses
        sizes = map(LONG, (x.shape[1], x.shape[2], inputs.shape[1], rows))
        arrays = at(x), at(inputs), at(out)
        runs = at(places), LONG(len(places))
        self._engine.function("of_runs")(self._engine.loop(name), *runs, *arrays, *sizes)
        return out
