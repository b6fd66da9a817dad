"""Runs of the discrete gradient in C: the records that stepper.c works on, filled from NumPy.

Input: an `Engine`, the parameters and states of some members.  Output: `Batch`, members on their
way through one mesh, with what they leave at samples.  Arrays live as long as the object that holds
them.
"""

from __future__ import annotations

import ctypes
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal, final

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from piezo_sym.run.checks import FloatArray
    from piezo_sym.run.engine.engine import Engine

#: Members of more states are computed one by one: then the lanes of their banks fill the vectors.
MOST_STATES = 32
#: What Newton's method may leave of a step's change, in 1e-9 of it: where balances have to close,
#: and, with a tolerance, on the paths that only tell or mend an error.
EXACT, SLACK = 1e-6, 1e-3 / 1e-9
Way = Literal["survey", "march", "adapt"]
MODES: dict[Way, int] = {"survey": 0, "march": 1, "adapt": 2}
POINTER, LONG, DOUBLE = ctypes.c_void_p, ctypes.c_long, ctypes.c_double


class Model(ctypes.Structure):
    """MODEL(model): parameters, sizes, and room for one step."""

    _fields_ = [
        ("p", POINTER),
        *((name, LONG) for name in ("n", "rows", "ports", "processes", "inputs")),
        ("space", POINTER),
        *((name, LONG) for name in ("iterations", "halvings", "start")),
        ("slack", DOUBLE),
    ]


class Path(ctypes.Structure):
    """MODEL(path): a state, its last two changes, and its ledger."""

    _fields_ = [
        *((name, POINTER) for name in ("x", "last", "prior")),
        *((name, DOUBLE) for name in ("h", "h_prior")),
        *((name, POINTER) for name in ("sums", "lost")),
    ]


class Member(ctypes.Structure):
    """MODEL(member): a run among others."""

    _fields_ = [
        ("model", Model),
        *((name, Path) for name in ("fine", "middle", "coarse", "trial")),
        *((name, POINTER) for name in ("kept", "tolerance", "out_x", "out_fine", "out_sums")),
        *((name, LONG) for name in ("level", "done", "steps", "failed")),
    ]


class Intervals(ctypes.Structure):
    """MODEL(block): the intervals that members go through, and the inputs in them."""

    _fields_ = [
        *((name, LONG) for name in ("intervals", "lowest", "highest")),
        *((name, POINTER) for name in ("h", "u", "sample", "first")),
    ]


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
        self._structures = [engine.structure(p) for p in parameters]
        self.x, self.scale = x.copy(), np.abs(x)
        self.states, self.fine = np.full((2, size, samples, n), np.nan)
        self.sums = np.full((size, samples, ledger), np.nan)
        self._others = np.stack([x, x, x])  # of the middle, the coarse and the trial path
        first = self._model(0, None)
        self._space = np.zeros((size, self._function("room")(ctypes.byref(first))))
        self._changes = np.zeros((size, 4, 2, max(n, 1)))
        self.ledgers = np.zeros((size, 2, ledger))
        self._kept = np.zeros((size, n + 2 * ledger))
        self.members = (Member * size)(*map(self._member, range(size)))

    def __len__(self) -> int:
        """Return the number of members."""
        return len(self.members)

    @property
    def levels(self) -> list[int]:
        """How finely each member divides its next interval: `steps_at` says how often."""
        return [member.level for member in self.members if not member.failed]

    def run(
        self,
        name: Way,
        lengths: FloatArray,
        u: Sequence[FloatArray],
        lowest: int,
        samples: NDArray[np.int_],
        done: Sequence[int] = (),
        first: Sequence[FloatArray] = (),
    ) -> list[int]:
        """Go through intervals, and return how many of them each member has done.

        Parameters
        ----------
        name : "march", one step over each; "survey", the same for `scale` alone, from where the run
            began; "adapt", as many steps and half steps as the tolerance asks for.
        lengths : of the intervals, (k,).
        u : inputs at the middles of steps (k*steps, inputs), for each level from the lowest on.
        lowest : the lowest level.
        samples : the sample after each interval (k,), -1 for none.
        first : after a jump, inputs of the quarters of the first step (4, inputs), likewise.
        done : how many of these intervals each member has done before; none when left out.
        """
        held = _pointers(u), _pointers(first) if first else None
        highest = lowest + len(u) - 1
        block = Intervals(lengths.size, lowest, highest, at(lengths), None, at(samples))
        block.u, block.first = (ctypes.cast(p, POINTER) if p else None for p in held)
        for k, member in enumerate(self.members):
            member.done = done[k] if done else 0
        arguments = (self.members, LONG(len(self.members)), ctypes.byref(block))
        vectors = self._vectors_for(name)
        if vectors is None:
            self._function(name)(*arguments)
        else:
            function, space = vectors
            function(*arguments, ctypes.c_int(MODES[name]), at(space))
        return [member.done for member in self.members]

    def allow(self, rtol: float) -> None:
        """Let paths without a ledger leave a small share of rtol in each step."""
        for member in self.members:
            member.model.slack = max(EXACT, SLACK * rtol)

    def rewind(self) -> None:
        """Forget a survey, but for its `scale`."""
        self._others[2] = self.x
        for member in self.members:
            member.trial.h = member.trial.h_prior = 0.0
            member.steps = member.failed = 0
            member.model.iterations = member.model.halvings = 0

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

    def _member(self, k: int) -> Member:
        changes, ledger = self._changes[k], self.ledgers[k]
        states = (self.x[k], *self._others[:, k])
        paths = [Path(at(x), at(c[0]), at(c[1])) for x, c in zip(states, changes, strict=True)]
        paths[0].sums, paths[0].lost = at(ledger[0]), at(ledger[1])
        out = (self.states[k], self.fine[k], self.sums[k])
        model = self._model(k, at(self._space[k]))
        return Member(model, *paths, at(self._kept[k]), at(self.scale[k]), *map(at, out))

    def _model(self, k: int, space: ctypes.c_void_p | None) -> Model:
        r, structure = self.rows, self._structures[k].value
        sizes = (r.n, r.ledger, r.ports, r.processes, r.inputs)
        return Model(ctypes.addressof(structure), *sizes, space, slack=EXACT)

    def _function(self, name: str) -> Any:
        function = getattr(self._library, f"{self._name}_{name}")
        function.restype = LONG if name == "room" else None
        return function


def _pointers(arrays: Sequence[FloatArray]) -> Any:
    """Return an array of the addresses of arrays, which the caller keeps."""
    return (POINTER * len(arrays))(*(array.ctypes.data for array in arrays))


def steps_at(level: int) -> int:
    """Return how many steps an interval has at a level: 1, 2, 3, 4, 6, 8, 12, ..."""
    return 1 if level == 0 else (2 + (level + 1) % 2) << ((level - 1) // 2)


def at(array: NDArray[Any]) -> ctypes.c_void_p:
    """Return the address of an array's numbers."""
    return ctypes.c_void_p(array.ctypes.data)
