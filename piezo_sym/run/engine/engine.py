"""A compiled module: the functions of its NumPy module, computed in C.

Input: a generated module.  Output: an `Engine`, and `Members` for many runs, each with parameters
of its own.  A call releases the interpreter's lock.
"""

from __future__ import annotations

import ctypes
import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache, partial
from math import prod
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from piezo_sym.errors import EngineError
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.engine.library import CACHE, Sources, read_source, shared_library
from piezo_sym.run.engine.records import INT, LONG, POINTER, ParameterRecords, at
from piezo_sym.run.module import GeneratedModule, held, is_unproved, row_count

#: The records of the rows of each function of a module; "" for a single number.
_ROWS = {
    "rhs": "STATES",
    "jacobian": "STATES",
    "outputs": "OUTPUTS",
    "supply": "OUTPUTS",
    "heat": "PROCESSES",
    "entropy_production": "PROCESSES",
    "margins": "DOMAIN",
    "temperatures": "BODIES",
    "energy": "",
    "entropy": "",
}
#: The functions of a module that a library computes.
OFFERED = ("initial_state", *_ROWS)


def engine_of(module: GeneratedModule) -> Engine:
    """Return the compiled engine of a module, loaded from a file with its .c and .h beside it."""
    sources = functions_of(module)
    environment = tuple(map(os.environ.get, ("CC", "PATH", CACHE, "HOME")))
    engine = _engine(module, sources, environment)  # type: ignore[arg-type]  # modules are hashable
    if isinstance(engine, EngineError):
        raise engine.with_traceback(None)
    return engine


def functions_of(module: GeneratedModule) -> Sources:
    """Return the sources of a module's functions."""
    texts = read_source(module, ".h"), read_source(module, ".c")
    return Sources(module.NAME, *texts, proved=not is_unproved(module))


@lru_cache(maxsize=64)
def _engine(
    module: GeneratedModule, sources: Sources, environment: tuple[str | None, ...]
) -> Engine | EngineError:
    """Return a module's engine or its error, which is cached, too, as failures may take long."""
    del environment  # a key of the cache alone
    try:
        return Engine(module, shared_library(sources), ParameterRecords(module), sources)
    except EngineError as error:
        return EngineError(error.what, error.where, error.expected, error.remedy)


@final
@dataclass(frozen=True)
class Engine:
    """The functions of a generated module, compiled; arguments and results as in the module.

    x is (n, *batch); u is (inputs,) or (inputs, *batch); p is the module's `Parameters`. `out` may
    be a C-contiguous array for the result, apart from x and u: new memory for many states costs as
    much as their rates.
    """

    module: GeneratedModule
    library: ctypes.CDLL
    structure: ParameterRecords
    sources: Sources

    def initial_state(self, u: ArrayLike, p: Any, /) -> FloatArray:
        """Return the state at t = 0, shape (n,), for the inputs u (inputs,) at t = 0."""
        u = _array(u, len(self.module.INPUTS), "inputs").ravel()
        out = np.empty(row_count(self.module.STATES, p))
        structure = self.structure(p)  # the name keeps its arrays of lanes alive
        self.function("initial_state")(at(u), ctypes.byref(structure.value), at(out))
        return out

    def __getattr__(self, name: str) -> Callable[..., FloatArray]:
        """Return another function of the module, computed in C."""
        if name not in _ROWS:
            raise AttributeError(name)
        return partial(self._call, name)

    def _call(
        self, name: str, x: ArrayLike, *more: Any, out: FloatArray | None = None
    ) -> FloatArray:
        """Return a function's values; `more` is p, or u and p for a function of inputs."""
        *u, p = more
        n, rows = row_count(self.module.STATES, p), self.rows(name, p)
        states = _array(x, n, "states")
        batch, structure = states.shape[1:], self.structure(p)  # keeps its arrays of lanes alive
        columns = np.ascontiguousarray(states.reshape(n, prod(batch)))
        inputs = np.ascontiguousarray(self._inputs(u[0], batch)) if u else np.empty(0)
        shape = {"jacobian": (n, n), "energy": (), "entropy": ()}.get(name, (rows,))
        result = _output(out, (*shape, *batch))
        sizes = n, inputs.shape[0], prod(shape)
        space = np.empty(
            LONG.in_dll(self.library, f"{self.module.NAME}_tile").value * (sum(sizes) + 1)
        )
        self.function("of_columns")(
            *(self.loop(name), at(columns), at(inputs), ctypes.byref(structure.value), at(result)),
            *(*map(LONG, (prod(batch), *sizes)), INT(inputs.ndim == 2), at(space)),
        )
        return result

    def rows(self, name: str, p: Any) -> int:
        """Return the number of rows of a function's values; of a single number, 1."""
        if name == "margins":
            return len(self.module.DOMAIN)
        return row_count(getattr(self.module, _ROWS[name]), p) if _ROWS[name] else 1

    def function(self, name: str) -> Any:
        """Return the C function MODEL(name)."""
        return getattr(self.library, f"{self.module.NAME}_{name}")

    def loop(self, name: str) -> ctypes.c_void_p:
        """Return the address of a function's loop over columns, for `of_columns` and `of_runs`."""
        return ctypes.cast(self.function(f"{name}_columns"), POINTER)

    def _inputs(self, u: ArrayLike, batch: tuple[int, ...]) -> FloatArray:
        """Return inputs (inputs, columns), or (inputs,) for all columns."""
        size = len(self.module.INPUTS)
        given = _array(u, size, "inputs")
        if given.ndim == 1:
            return given
        return np.broadcast_to(given, (size, *batch)).reshape(size, prod(batch))


def _array(value: ArrayLike, rows: int, what: str) -> FloatArray:
    array = np.asarray(value, dtype=float)
    if array.shape[:1] != (rows,):
        msg = f"{what} have shape {array.shape}, but there are {rows}"
        raise ValueError(msg)
    return array


def _output(out: FloatArray | None, shape: tuple[int, ...]) -> FloatArray:
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
        self._engine, self._first = engine, parameters[0]
        self._kept = engine.structure.many(parameters)

    def inside(self, x: FloatArray, u: FloatArray) -> NDArray[np.bool_]:
        """Return whether states (runs, k, n) lie in the domain with finite rates, (runs, k)."""
        finite = np.all(np.isfinite(self("rhs", x, u)), axis=0)
        holds = np.all(held(self._engine.module, self("margins", x, u)), axis=0)
        return np.asarray(finite & holds)

    def __call__(self, name: str, x: FloatArray, u: FloatArray | None = None) -> FloatArray:
        """Return a function's values at states (runs, k, n): (rows, runs, k), or (runs, k).

        Inputs (k, inputs), if it takes any, are the same for all runs; arrays are C-contiguous.
        """
        rows = self._engine.rows(name, self._first)
        out = np.empty((*x.shape[:2], rows))
        inputs = np.empty((1, 0)) if u is None else u
        places = self._kept.addresses
        sizes = map(LONG, (x.shape[1], x.shape[2], inputs.shape[1], rows))
        arrays = at(x), at(inputs), at(out)
        runs = at(places), LONG(len(places))
        self._engine.function("of_runs")(self._engine.loop(name), *runs, *arrays, *sizes)
        return np.moveaxis(out, 2, 0) if _ROWS[name] else out[..., 0]
