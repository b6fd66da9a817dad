"""Steps of the discrete gradient in C: the records that stepper.c works on, filled from NumPy.

Input: an `Engine`, parameters, a state.  Output: `March`, a state on its way with its ledger, and
`Pair`, two of them on one mesh.  Arrays live as long as the object that holds them.
"""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, final

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from piezo_sym.run.checks import FloatArray
    from piezo_sym.run.engine.engine import Engine

POINTER, LONG = ctypes.c_void_p, ctypes.c_long


class Model(ctypes.Structure):
    """MODEL(model): parameters, sizes, and room for one step."""

    _fields_ = [
        ("p", POINTER),
        *((name, LONG) for name in ("n", "rows", "ports", "processes", "inputs")),
        ("space", POINTER),
        ("iterations", LONG),
        ("halvings", LONG),
    ]


class Path(ctypes.Structure):
    """MODEL(path): a state, its last two changes, and its ledger."""

    _fields_ = [
        *((name, POINTER) for name in ("x", "last", "prior")),
        *((name, ctypes.c_double) for name in ("h", "h_prior")),
        *((name, POINTER) for name in ("sums", "lost")),
    ]


class PathPair(ctypes.Structure):
    """MODEL(pair): three paths, what is kept of the first, and the level of division."""

    _fields_ = [
        *((name, Path) for name in ("fine", "coarse", "trial")),
        ("kept", POINTER),
        ("level", LONG),
    ]


@final
class Rows:
    """The sizes of a run: states n, inputs, ports, processes, and rows of the ledger in C."""

    def __init__(self, engine: Engine, p: Any) -> None:
        module = engine.module
        self.n = engine.rows(module.STATES, p)
        self.inputs = len(module.INPUTS)
        self.ports = len(module.OUTPUTS)
        self.processes = engine.rows(module.PROCESSES, p)
        self.booked = self.ports + 2 * self.processes  # supplied, heat, produced
        self.ledger = self.booked + engine.exchanges


@final
class March:
    """States on their way through intervals, in C.

    Parameters
    ----------
    engine, p : the compiled module and its parameters.
    x : the state (n,) to start from.

    Attributes
    ----------
    x, sums : the state (n,) and the ledger (rows,) after what was run.
    steps : the steps taken.
    """

    def __init__(self, engine: Engine, p: Any, x: FloatArray) -> None:
        self.rows = Rows(engine, p)
        self.x, self.sums = x.copy(), np.zeros(self.rows.ledger)
        self.steps = 0
        self._held: list[Any] = []
        self._library, self._name = engine.library, engine.module.NAME
        structure = engine.structure(p)
        self._held.append(structure)
        r = self.rows
        address = ctypes.addressof(structure.value)
        self.model = Model(address, r.n, r.ledger, r.ports, r.processes, r.inputs)
        self.model.space = self.room(self.function("room")(ctypes.byref(self.model)))
        self.path = self.start(self.x, self.sums)

    @property
    def work(self) -> dict[str, int]:
        """Newton iterations and halvings so far."""
        return {"iterations": self.model.iterations, "halvings": self.model.halvings}

    def run(
        self, lengths: FloatArray, u: FloatArray, samples: NDArray[np.int_], *out: FloatArray
    ) -> int:
        """Take one step over each interval, and return how many were done.

        Parameters
        ----------
        lengths : of the intervals [s], (k,); u (k, m), the inputs at their middles.
        samples : of each interval, the row of `out` that gets what is after it; -1 for none.
        out : states (rows, n) and ledgers (rows, ledger), written.
        """
        done: int = self.function("run")(
            *(ctypes.byref(self.model), ctypes.byref(self.path), LONG(lengths.size)),
            *(at(lengths), at(u), at(samples), *map(at, out)),
        )
        self.steps += done
        return done

    def function(self, name: str) -> Any:
        """Return a function of stepper.c that returns a long."""
        function = getattr(self._library, f"{self._name}_{name}")
        function.restype = LONG
        return function

    def start(self, x: FloatArray, sums: FloatArray | None = None) -> Path:
        """Return a path of the state x, which the caller keeps."""
        path = Path(at(x), self.room(x.size), self.room(x.size))
        if sums is not None:
            path.sums, path.lost = at(sums), self.room(sums.size)
        return path

    def room(self, size: int) -> ctypes.c_void_p:
        """Return the address of an array of zeros that lives as long as this object."""
        array = np.zeros(max(size, 1))
        self._held.append(array)
        return at(array)


@final
class Pair:
    """Two runs on one mesh, the second with half its steps, and the mesh chosen on the way.

    Parameters
    ----------
    march : the finer of the two, before its first step.
    """

    def __init__(self, march: March) -> None:
        self.march, self.failed = march, False
        others = [march.x.copy() for _ in range(2)]
        self._held = others
        paths = [march.path, *(march.start(x) for x in others)]
        kept = march.room(march.rows.n + 2 * march.rows.ledger)
        self._pair = PathPair(*paths, kept, 0)

    @property
    def level(self) -> int:
        """How finely the next interval is divided: `steps_at` says how often."""
        return int(self._pair.level)

    def run(
        self,
        lengths: FloatArray,
        u: list[FloatArray],
        lowest: int,
        tolerance: FloatArray,
        samples: NDArray[np.int_],
        *out: FloatArray,
    ) -> int:
        """Run through intervals, and return how many were done: fewer if a level is missing.

        Parameters
        ----------
        lengths : of the intervals [s], (k,).
        u : for each level from `lowest` on, the inputs at the middles of all steps.
        tolerance : of each state (n,), for the error of an interval.
        samples : of each interval, the row of `out` that gets what is after it; -1 for none.
        out : extrapolated states and those of the finer run (rows, n), and its ledgers, written.
        """
        march = self.march
        pointers = (POINTER * len(u))(*(level.ctypes.data for level in u))
        taken, failed = LONG(0), ctypes.c_int(0)
        done: int = march.function("adapt")(
            *(ctypes.byref(march.model), ctypes.byref(self._pair), LONG(lengths.size)),
            *(at(lengths), pointers, LONG(lowest), LONG(lowest + len(u) - 1), at(tolerance)),
            *(at(samples), *map(at, out), ctypes.byref(taken), ctypes.byref(failed)),
        )
        march.steps += taken.value
        self.failed = bool(failed.value)
        return done


def steps_at(level: int) -> int:
    """Return how many steps an interval has at a level: 1, 2, 3, 4, 6, 8, 12, ..."""
    return 1 if level == 0 else (2 + (level + 1) % 2) << ((level - 1) // 2)


def at(array: NDArray[Any]) -> ctypes.c_void_p:
    """Return the address of an array's numbers."""
    return ctypes.c_void_p(array.ctypes.data)
