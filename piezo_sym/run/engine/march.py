"""Runs of the discrete gradient in C: batches of members, and what march.c does with them.

Input: an `Engine`, the parameters and states of some members.  Output: `Batch`, members on their
way through one mesh, with what they leave at samples.  Arrays live as long as the object that holds
them.
"""

import ctypes
from collections.abc import Sequence
from functools import cached_property
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from piezo_sym.run.checks import FloatArray
from piezo_sym.run.engine.engine import Engine
from piezo_sym.run.engine.records import LONG, Intervals, Member, at, room_of
from piezo_sym.run.engine.structure import record_of

#: Members of more states are computed one by one: then the lanes of their banks fill the vectors.
MOST_STATES = 32


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
    states, sums : at samples: states (members, samples, n), ledgers (members, samples, ledger).
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
        names = ("x", "ledgers", "states", "sums")
        self.x, self.ledgers, self.states, self.sums = (room.part(numbers, k) for k in names)
        self.x[:], room.part(numbers, "largest")[:] = x, np.abs(x)
        self.states[:] = self.sums[:] = np.nan

    def __len__(self) -> int:
        """Return the number of members."""
        return len(self.members)

    def run(
        self,
        lengths: FloatArray,
        u: FloatArray,
        samples: NDArray[np.int_],
        first: FloatArray | None = None,
    ) -> NDArray[np.intp]:
        """Take a step over each interval; return how many of them each member has done.

        Parameters
        ----------
        lengths : of the intervals, (k,).
        u : inputs at their middles (k, inputs).
        samples : the sample after each interval (k,), -1 for none.
        first : after a jump, inputs of the quarters of the first step (4, inputs).
        """
        rows = np.ascontiguousarray(samples, dtype="l")  # as C has them
        start = None if first is None else at(first)
        block = Intervals(lengths.size, at(lengths), at(u), at(rows), start)
        self._records["done"] = 0
        arguments = (self.members, LONG(len(self.members)), ctypes.byref(block))
        if self._vectors is None:
            self._function("march")(*arguments)
        else:
            function, space = self._vectors
            function(*arguments, at(space))
        reached: NDArray[np.intp] = self._records["done"].astype(np.intp)
        return reached

    @cached_property
    def _vectors(self) -> tuple[Any, FloatArray] | None:
        """The function that steps members side by side, and its room; None if one by one."""
        alone = len(self.members) == 1
        one_by_one = alone or self.rows.n > MOST_STATES or self.rows.numerical
        library = None if one_by_one else self._engine.side_by_side()
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
        models["rows"] = rows.ledger

    def _function(self, name: str) -> Any:
        function = getattr(self._library, f"{self._name}_{name}")
        function.restype = LONG if name == "room" else None
        return function
