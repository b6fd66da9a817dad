"""Runs of the discrete gradient in C: batches of members, and what paths.c does with them.

Input: an `Engine`, the parameters and states of some members.  Output: `Batch`, members on their
way through one mesh, with what they leave at samples.  Arrays live as long as the object that holds
them.
"""

import ctypes
from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any, Literal, final

import numpy as np
from numpy.typing import NDArray

from piezo_sym.run.checks import FloatArray
from piezo_sym.run.engine.engine import Engine
from piezo_sym.run.engine.records import LONG, PATHS, POINTER, Intervals, Member, at, room_of
from piezo_sym.run.engine.structure import record_of

#: Members of more states are computed one by one: then the lanes of their banks fill the vectors.
MOST_STATES = 32
#: What Newton's method may leave of a step's change, in 1e-9 of it: where balances have to close,
#: and, with a tolerance, on the paths that only tell or mend an error.
EXACT, SLACK = 1e-6, 1e-3 / 1e-9
Way = Literal["survey", "march", "adapt"]
MODES: dict[Way, int] = {"survey": 0, "march": 1, "adapt": 2}


@final
class Rows:
    """The sizes of a run: states n, inputs, ports, processes, and rows of the ledger in C."""

    def __init__(self, engine: Engine, p: Any, *, starts: bool) -> None:
        module = engine.module
        self.n = engine.rows(module.STATES, p)
        self.inputs = len(module.INPUTS)
        self.ports = len(module.OUTPUTS)
        self.processes = engine.rows(module.PROCESSES, p)
        self.booked = self.ports + 2 * self.processes  # supplied, heat, produced
        self.numerical = 2 if starts else 0  # heat and production of the loss, last
        self.ledger = self.booked + engine.exchanges + self.numerical


@final
class Batch:
    """Members of equal sizes on their way through one mesh, in C.

    Parameters
    ----------
    engine : the compiled module.
    parameters : of each member.
    x : the states (members, n) to start from.
    samples : the number of samples.
    starts : whether steps after jumps are dissipative, and the ledger has rows for their loss.

    Attributes
    ----------
    rows : the sizes.
    x : the states (members, n) after what was run.
    ledgers : the sums booked so far, and what rounding lost of them (members, 2, ledger).
    scale : the largest magnitude of each state met by `survey` (members, n); for `adapt`, the
        tolerance of each state.
    states, fine, sums : at samples: states (members, samples, n), extrapolated or else those of the
        finer run, and its ledgers (members, samples, ledger).
    """

    def __init__(
        self,
        engine: Engine,
        parameters: Sequence[Any],
        x: FloatArray,
        samples: int,
        *,
        starts: bool = False,
    ) -> None:
        rows = self.rows = Rows(engine, parameters[0], starts=starts)
        size, n, ledger = len(parameters), rows.n, rows.ledger
        self._engine, self._library, self._name = engine, engine.library, engine.module.NAME
        self._structures = engine.structure.many(parameters)
        self.members = (Member * size)()
        self._records: Any = np.frombuffer(memoryview(self.members), record_of(Member))
        self._fill(self._records["model"])
        space = self._function("room")(ctypes.byref(self.members[0].model))
        room = room_of(n, ledger, samples, space)
        numbers = room.rows(size)
        room.point(self.members, numbers)
        self.x, self.scale, self.ledgers = (
            room.part(numbers, k) for k in ("x", "scale", "ledgers")
        )
        self.states, self.fine, self.sums = (
            room.part(numbers, name) for name in ("states", "fine", "sums")
        )
        self._others = room.part(numbers, "others")
        self._largest = room.part(numbers, "largest")
        self.x[:], self._others[:] = x, x[:, None]
        self.scale[:] = self._largest[:] = np.abs(x)
        self.states[:] = self.fine[:] = self.sums[:] = np.nan

    def __len__(self) -> int:
        """Return the number of members."""
        return len(self.members)

    @property
    def level(self) -> NDArray[np.intp]:
        """How finely each member divides its next interval, to be changed: `steps_at` says it."""
        found: NDArray[np.intp] = self._records["level"]
        return found

    @property
    def failed(self) -> NDArray[np.bool_]:
        """Whether each member has stopped."""
        found: NDArray[np.bool_] = self._records["failed"] != 0
        return found

    def run(
        self,
        name: Way,
        lengths: FloatArray,
        u: Mapping[int, FloatArray],
        samples: NDArray[np.int_],
        done: NDArray[np.intp] | int = 0,
        first: Mapping[int, FloatArray] | None = None,
    ) -> NDArray[np.intp]:
        """Go through intervals, and return how many of them each member has done.

        Parameters
        ----------
        name : "march", one step over each; "survey", the same for `scale` alone, from where the run
            began; "adapt", as many steps and half steps as the tolerance asks for.
        lengths : of the intervals, (k,).
        u : of levels, inputs at the middles of steps (k*steps, inputs).
        samples : the sample after each interval (k,), -1 for none.
        first : after a jump, of levels, inputs of the quarters of the first step (4, inputs).
        done : how many of these intervals each member has done before.
        """
        levels = range(min(u), max(u) + 1)
        held = _pointers(u, levels), _pointers(first, levels) if first else None
        rows = np.ascontiguousarray(samples, dtype="l")  # as C has them
        block = Intervals(lengths.size, levels[0], levels[-1], at(lengths), None, at(rows))
        block.u, block.first = (ctypes.cast(p, POINTER) if p else None for p in held)
        self._records["done"] = done
        arguments = (self.members, LONG(len(self.members)), ctypes.byref(block))
        vectors = self._vectors_for(name)
        if vectors is None:
            self._function(name)(*arguments)
        else:
            function, space = vectors
            function(*arguments, ctypes.c_int(MODES[name]), at(space))
        reached: NDArray[np.intp] = self._records["done"].astype(np.intp)
        return reached

    def allow(self, rtol: float) -> None:
        """Let paths without a ledger leave a small share of rtol in each step."""
        self._records["model"]["slack"] = max(EXACT, SLACK * rtol)

    def forget(self) -> None:
        """Let paths expect nothing of their next step: inputs jump, or have a corner."""
        for path in PATHS:
            self._records[path]["h"] = self._records[path]["h_prior"] = 0.0

    def rewind(self) -> None:
        """Forget a survey, but for its `scale`."""
        self._others[:, -1] = self.x  # the trial's
        self._largest[:] = np.abs(self.x)
        self.forget()
        records = self._records
        records["steps"] = records["failed"] = 0
        records["model"]["iterations"] = records["model"]["halvings"] = 0

    def _vectors_for(self, name: Way) -> tuple[Any, FloatArray] | None:
        """Return the function that takes paths side by side, and its room; None if one by one.

        One member alone has several paths only where there is a tolerance.
        """
        alone = len(self.members) == 1 and name != "adapt"
        return None if alone or self.rows.n > MOST_STATES or self.rows.numerical else self._vectors

    @cached_property
    def _vectors(self) -> tuple[Any, FloatArray] | None:
        library = self._engine.side_by_side(len(self.members))
        if library is None:
            return None
        width = LONG.in_dll(library, f"{self._name}_width").value
        size = getattr(library, f"{self._name}_wide_size")
        size.restype = LONG
        room = size(ctypes.byref(self.members[0].model)) * width
        numbers = np.zeros(room + width)
        skipped = -numbers.ctypes.data % (8 * width) // 8  # vectors have to be aligned
        function = getattr(library, f"{self._name}_run_wide")
        function.restype = None
        return function, numbers[skipped : skipped + room]

    def _fill(self, models: Any) -> None:
        """Fill in the models of the members, without their space."""
        rows = self.rows
        models["p"] = self._structures.addresses
        for name in ("n", "ports", "processes", "inputs"):
            models[name] = getattr(rows, name)
        models["rows"], models["slack"] = rows.ledger, EXACT

    def _function(self, name: str) -> Any:
        function = getattr(self._library, f"{self._name}_{name}")
        function.restype = LONG if name == "room" else None
        return function


def _pointers(arrays: Mapping[int, FloatArray], levels: range) -> Any:
    """Return the addresses of arrays at levels, none where there is none; the caller keeps them."""
    there = (arrays[level].ctypes.data if level in arrays else None for level in levels)
    return (POINTER * len(levels))(*there)


def coarser(level: int) -> int:
    """Return the level with half the steps, or the next below."""
    return level - 4 if level > 6 else max(level - 1, 0) // 2


def twice(level: int) -> int:
    """Return the level with twice the steps."""
    return level + 4 if level > 2 else 2 * level + 1


def finest(level: int) -> int:
    """Return the level with four times the steps, that of the finest path."""
    return twice(twice(level))


def steps_at(level: int) -> int:
    """Return how many steps an interval has at a level: 1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 14, ..."""
    return level + 1 if level < 3 else 4 + (level - 3) % 4 << (level - 3) // 4
