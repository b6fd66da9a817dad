"""Collocation steps of runs in C: the library for a number of stages, and batches of runs.

Input: a module's engine; parameters, inputs and states of some runs.  Output: `Batch`, which steps
them and owns the arrays that C uses.
"""

import ctypes
from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import dataclass, replace
from functools import lru_cache
from math import nan
from typing import Any, Literal, final

import numpy as np
from numpy.typing import NDArray

from piezo_sym.interrupts import held_back
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.engine.engine import Engine
from piezo_sym.run.engine.library import Layout, Sources, read_source, shared_library
from piezo_sym.run.engine.records import (
    DOUBLE,
    LONG,
    InputRecords,
    addresses,
    at,
    c_record,
    record_dtype,
)
from piezo_sym.run.inputs import Inputs
from piezo_sym.run.module import GeneratedModule

#: Alignment of vectors, in bytes.
ALIGNED = 64


@final
@dataclass(frozen=True)
class Stepping:
    """The options of steps."""

    stages: int  # of a step, 1 to 6; its order is twice that
    #: The largest estimated error of a step, over the scales of the states; not used with `fixed`.
    tolerance: float
    #: first, longest: the length of the first step, and of the longest [s].
    first: float
    longest: float
    #: The longest step [s], for equal steps between samples and breaks that go over kinks; 0 for
    #: steps chosen by their errors.
    fixed: float = 0.0
    #: "end" steps at kinks; or "either": go over many of them where that is faster.
    kinks: Literal["end", "either"] = "either"
    lossy: bool = False  # whether steps are dissipative, of one stage; a failed one is not halved


@lru_cache(maxsize=64)
def collocation_library(
    engine: Engine, stages: int, layout: Layout, *, lossy: bool = False
) -> ctypes.CDLL:
    """Return the library of a module's collocation steps with `stages` stages."""
    return shared_library(steps_of(engine.module, engine.sources, stages, layout, lossy=lossy))


def steps_of(
    module: GeneratedModule, functions: Sources, stages: int, layout: Layout, *, lossy: bool = False
) -> Sources:
    """Return the sources of a module's steps."""
    step = read_source(module, "_step.c")
    return replace(functions, step=step, stages=stages, layout=layout, lossy=lossy)


def is_lossy(engine: Engine) -> bool:
    """Return whether a module has dissipative steps: it has storage, and a body to heat."""
    library = collocation_library(engine, 1, "one")
    return bool(LONG.in_dll(library, f"{engine.module.NAME}_lossy").value)


@final
class Batch:
    """Runs of equal sizes, stepped together.

    `layout` says what vectors hold: the stages of "one" run, "many" runs, or the "lanes" of one
    run's banks.

    Attributes
    ----------
    x : the current states (runs, n), at first those at t = 0.
    largest : the largest magnitude of each state (runs, n).
    noise : how far round-off moves each state at rest (runs, n), or 0.
    ledgers : the ledger so far, and its rounding error (runs, 2, rows).
    states, sums : at samples, (runs, samples, n) and (runs, samples, rows), rows in the order of
        `DrivenModule.rates`, then `extra`: 2 for heat and entropy of dissipative steps; nan at
        samples not reached.
    records : the other fields of each run, by the names of MODEL(run).
    inputs : of all runs, in C.
    address : of MODEL(batch).
    """

    def __init__(
        self,
        engine: Engine,
        parameters: Sequence[Any],
        x: FloatArray,
        inputs: Inputs,
        times: FloatArray,
        stepping: Stepping,
        layout: Layout,
        *,
        extra: int = 0,
    ) -> None:
        self._engine, self._layout, self.extra = engine, layout, extra
        self._structures = engine.structure.many(parameters)
        self.inputs, self._end = InputRecords(inputs), inputs.end
        self._times = np.ascontiguousarray(times, dtype=float)
        self.records: Any = np.zeros(len(x), record_dtype("run"))
        self._load(stepping)
        rows = self.sizes()[3] + extra
        self.x: FloatArray = np.empty(x.shape)
        self.largest, self.noise = np.empty(x.shape), np.empty(x.shape)
        self.states = np.empty((len(x), times.size, x.shape[1]))
        self.sums = np.empty((len(x), times.size, rows))
        self.ledgers = np.empty((len(x), 2, rows))
        fields = {"ledger": self.ledgers}
        fields |= {n: getattr(self, n) for n in ("x", "largest", "noise", "states", "sums")}
        fixed: dict[str, Any] = {name: addresses(array) for name, array in fields.items()}
        fixed |= {"p": self._structures.addresses, "t": inputs.start}
        fixed["segments"] = self.inputs.address(inputs.start)
        for name, value in fixed.items():
            self.records[name] = value
        self._first_records = self.records.copy()
        sizes = {"count": len(x), "samples": times.size, "extra": extra}
        self._task = c_record("task")(runs=self.run, times=at(self._times), **sizes)
        self._stepping: Stepping | None = None  # the options that there is memory for
        self.begin(x, stepping)

    def begin(self, x: FloatArray, stepping: Stepping) -> None:
        """Prepare runs that begin at the states x (runs, n), whatever has been run before."""
        self.x[:], self.largest[:] = x, np.abs(x)
        self.noise[:] = self.ledgers[:] = 0
        self.states[:] = self.sums[:] = nan
        self.records[:] = self._first_records
        self._open(stepping, self._end)

    def go_on(self, stepping: Stepping, stop: float) -> None:
        """Prepare runs to continue until `stop` [s], except for failed ones.

        All are in the same segment of the inputs, or beyond `stop`.
        """
        t = self.records["t"].min(where=self.records["failed"] == 0, initial=stop)
        self.records["segments"] = self.inputs.address(t)
        self._open(stepping, stop)

    def _open(self, stepping: Stepping, stop: float) -> None:
        """Make the working memory of runs that go on until `stop` [s]."""
        self._task.stop = stop
        if stepping is self._stepping:
            self._space[:] = 0
        else:
            self._prepare(stepping)
            self._stepping = stepping
        self.call("open", ctypes.byref(self._task))

    def _prepare(self, stepping: Stepping) -> None:
        """Load the library for some options, and take as much memory as it needs."""
        self._load(stepping)
        over, task = bool(stepping.fixed > 0), self._task
        task.over_kinks, task.either = over, stepping.kinks == "either" and not over
        task.tolerance = stepping.tolerance
        task.first, task.longest, task.fixed = stepping.first, stepping.longest, stepping.fixed
        size = self.function("batch_size")
        size.restype = LONG
        self._space = np.zeros(size(ctypes.byref(task)) + ALIGNED, dtype=np.uint8)
        place = self._space.ctypes.data
        self.address = ctypes.c_void_p(place + -place % ALIGNED)

    def _load(self, stepping: Stepping) -> None:
        given = self._engine, stepping.stages, "one" if stepping.lossy else self._layout
        self._library = collocation_library(*given, lossy=stepping.lossy)

    def sizes(self) -> NDArray[Any]:
        """Return the sizes of the model's arrays, by MODEL(sizes_of)."""
        module = self._engine.module
        sizes = np.zeros(7 + len(module.BANKS) + len(module.STATES), dtype=np.dtype("l"))
        self.function("sizes_of")(ctypes.byref(self._structures.value), at(sizes))
        return sizes

    @property
    def run(self) -> int:
        """The address of the first run."""
        return int(self.records.ctypes.data)

    @property
    def jumps(self) -> bool:
        """Whether a law of the model jumps."""
        return bool(LONG.in_dll(self._library, f"{self._engine.module.NAME}_jumping").value)

    def function(self, name: str) -> Any:
        """Return the C function MODEL(name)."""
        return getattr(self._library, f"{self._engine.module.NAME}_{name}")

    def survey(self, longest: float) -> None:
        """Set `largest` by coarse steps of at most `longest` [s]."""
        self.call("survey", DOUBLE(longest))

    def go(self, steps: int) -> bool:
        """Take at most `steps` steps in each lane; return whether runs are left."""
        return bool(self.call("go", LONG(steps)))

    def call(self, name: str, *more: Any) -> Any:
        """Call MODEL(name) with the batch; raise the exception of a user's input function.

        An interrupt is raised behind the call: what is raised in a function that C calls is lost.
        """
        delayed = held_back() if self.inputs.calls else nullcontext(list[int]())
        with delayed as self.inputs.received:
            result = self.function(name)(self.address, *more)
        if self.inputs.raised:
            raise self.inputs.raised[0]
        return result
