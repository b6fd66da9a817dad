"""A compiled module: the functions of its NumPy twin, computed in C.

Input: a generated module.  Output: an `Engine`.  Arrays have the module's shapes; a call releases
the interpreter's lock.
"""

from __future__ import annotations

import ctypes
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike

from piezo_sym.errors import EngineError, FileError
from piezo_sym.files import path_text, read_text
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.engine.columns import of_columns
from piezo_sym.run.engine.driver import DRIVEN, PLAIN, SCALARS
from piezo_sym.run.engine.library import EngineWarning, Sources, library
from piezo_sym.run.engine.records import at
from piezo_sym.run.engine.structure import Layout
from piezo_sym.run.module import GeneratedModule, Record, lanes


def compiled(module: GeneratedModule) -> Engine | None:
    """Return the compiled engine of a module; without one, warn in one line and return None.

    Parameters
    ----------
    module : a generated module, loaded from a file with its .c and .h beside it.
    """
    try:
        return engine_of(module)
    except EngineError as error:
        warnings.warn(f"{error}; running in NumPy", EngineWarning, stacklevel=2)
        return None


def engine_of(module: GeneratedModule) -> Engine:
    """Return the compiled engine of a module.

    Raises
    ------
    EngineError
        If the sources are missing or of another spec, nothing can compile them, or the cache
        cannot be written.
    """
    return _engine(module, _sources(module))  # type: ignore[arg-type]  # a module can be a key


@lru_cache(maxsize=64)
def _engine(module: GeneratedModule, sources: Sources) -> Engine:
    return Engine(module, shared_library(sources), Layout(module), sources)


def shared_library(sources: Sources) -> ctypes.CDLL:
    """Return the library of some texts, compiled if need be, loaded."""
    try:
        return ctypes.CDLL(str(library(sources)))
    except OSError:  # a damaged file in the cache
        path = library(sources, again=True)
    try:
        return ctypes.CDLL(str(path))
    except OSError as error:
        what = "the compiled module cannot be loaded"
        raise EngineError(what, path_text(path), remedy="delete it") from error


def _sources(module: GeneratedModule) -> Sources:
    """Return the texts beside a module, checked to be of its spec."""
    header, source = (read_source(module, ending) for ending in (".h", ".c"))
    return Sources(module.NAME, header, source)


def read_source(module: GeneratedModule, ending: str) -> str:
    """Return the text beside a module, ``<model>.c`` for ".c", checked to be of its spec.

    Raises
    ------
    EngineError
        If it is missing, or of another spec.
    """
    path = Path(getattr(module, "__file__", None) or f"{module.NAME}.py")
    file = path.with_name(f"{module.NAME}{ending}")
    text = _text(file)
    if text is None or f"spec sha256 {module.SPEC_SHA256}" not in text:
        what = "is missing" if text is None else "is of another spec than the module"
        raise EngineError(what, path_text(file), remedy="run `piezo-sym generate`")
    return text


def _text(file: Path) -> str | None:
    """Return a file's text, or None without one; it is read again when it changes."""
    try:
        status = file.stat()
    except OSError:
        return None
    return _read(file, status.st_mtime_ns, status.st_size)


@lru_cache(maxsize=64)
def _read(file: Path, changed: int, size: int) -> str | None:
    del changed, size  # they tell one text from another
    try:
        return read_text(file)
    except FileError as error:
        raise EngineError(error.what, error.where, remedy=error.remedy) from error


@final
@dataclass(frozen=True)
class Engine:
    """The functions of a generated module, compiled; arguments and results as in the module.

    x is (n, *batch); u is (inputs,) or (inputs, *batch); p is the module's `Parameters`.
    """

    module: GeneratedModule
    library: ctypes.CDLL
    structure: Layout
    sources: Sources

    def initial_state(self, u: ArrayLike, p: Any, /) -> FloatArray:
        """Return the state at t = 0, shape (n,), for the inputs u (inputs,) at t = 0."""
        u = self._array(u, len(self.module.INPUTS), "inputs").ravel()
        out = np.empty(self.rows(self.module.STATES, p))
        function = getattr(self.library, f"{self.module.NAME}_initial_state")
        structure = self.structure(p)  # a name of its own keeps the arrays of its lanes alive
        function(at(u), ctypes.byref(structure.value), at(out))
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
        return self._called("rhs", x, u, p, self.rows(self.module.STATES, p), out)

    def jacobian(self, x: ArrayLike, u: ArrayLike, p: Any, /) -> FloatArray:
        """Return the derivative of `rhs` by the state, shape (n, n, *batch)."""
        n = self.rows(self.module.STATES, p)
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
        return self._called("heat", x, u, p, self.rows(self.module.PROCESSES, p))

    def entropy_production(self, x: ArrayLike, u: ArrayLike, p: Any, /) -> FloatArray:
        """Return the entropy produced [W/K], shape (processes, *batch), banks spread."""
        return self._called("entropy_production", x, u, p, self.rows(self.module.PROCESSES, p))

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

    def rows(self, records: Sequence[Record], p: Any) -> int:
        """Return the number of rows that records take, banks spread."""
        return sum(lanes(p, record.bank) if record.bank else 1 for record in records)

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
        states = self._array(x, self.rows(self.module.STATES, p), "states")
        batch, structure = states.shape[1:], self.structure(p)  # it keeps its lanes' arrays alive
        width = int(np.prod(batch, dtype=int))
        columns = states.reshape(states.shape[0], width)
        found = _place(out, (rows, *batch))
        given = columns, self._inputs(u, batch), structure.value, found.reshape(rows, width)
        of_columns(self.library, self.module.NAME, name, *given)
        return found

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


#: The functions of a module that a library computes.
OFFERED = ("initial_state", *DRIVEN, *PLAIN, *SCALARS)
