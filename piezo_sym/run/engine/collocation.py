"""Collocation steps of runs in C: the library of a number of stages, and batches of runs.

Input: a generated module with its ``<model>_step.c``, parameters, inputs and states of some runs.
Output: `Batch`, which takes them through.  Arrays that C works on belong to it.
"""

import ctypes
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from math import nan
from typing import Any, Literal, final

import numpy as np
from numpy.typing import NDArray

from piezo_sym.run.checks import FloatArray
from piezo_sym.run.engine.engine import Engine, read_source, shared_library
from piezo_sym.run.engine.library import Layout
from piezo_sym.run.engine.records import DOUBLE, LONG, POINTER, at
from piezo_sym.run.engine.structure import addresses, record_of
from piezo_sym.run.inputs import Inputs, Segment
from piezo_sym.run.pieces import Pieces, pieces_of
from piezo_sym.run.signals import Chirp, Constant, Signal, Sine

ASKED = ctypes.CFUNCTYPE(DOUBLE, DOUBLE)
#: Vectors lie at multiples of so many bytes.
ALIGNED = 64


class Wave(ctypes.Structure):
    """MODEL(signal) of trajectory.c."""

    _fields_ = [
        *((n, DOUBLE) for n in ("amplitude", "frequency", "rate", "phase", "offset")),
        *((n, POINTER) for n in ("edges", "coefficients")),
        *((n, LONG) for n in ("pieces", "terms")),
        ("asked", ASKED),
    ]


class Piece(ctypes.Structure):
    """MODEL(segment) of trajectory.c."""

    _fields_ = [("stop", DOUBLE), ("signals", POINTER)]


class Record(ctypes.Structure):
    """MODEL(run) of trajectory.c."""

    _fields_ = [
        *((n, POINTER) for n in ("p", "segments", "x", "largest", "ledger", "states", "sums")),
        ("t", DOUBLE),
        *((n, LONG) for n in ("sample", "steps", "rejected", "switched", "iterations", "failed")),
    ]


class Task(ctypes.Structure):
    """MODEL(task) of batch.c."""

    _fields_ = [
        *((n, POINTER) for n in ("runs", "times")),
        *((n, LONG) for n in ("count", "samples", "over", "ways", "more")),
        *((n, DOUBLE) for n in ("stop", "tolerance", "first", "longest", "fixed")),
    ]


@final
@dataclass(frozen=True)
class Stepping:
    """How runs step.

    Attributes
    ----------
    stages : of a step, 1 to 5; its order is twice that.
    tolerance : of the estimate of a step's error, in scales of the states; not used with `fixed`.
    fixed : the longest step [s], where steps divide what lies between samples and breaks evenly,
        and go over kinks; 0 if errors decide.
    first, longest : the length of the first step, and of the longest [s].
    kinks : whether steps end there, or go over them; or what gets further, where switches are many.
    lossy : whether steps are dissipative, of one stage; one that does not succeed is not halved.
    """

    stages: int
    tolerance: float
    first: float
    longest: float
    fixed: float = 0.0
    kinks: Literal["end", "over", "either"] = "either"
    lossy: bool = False


@lru_cache(maxsize=64)
def collocation_library(
    engine: Engine, stages: int, layout: Layout, *, lossy: bool = False
) -> ctypes.CDLL:
    """Return the library of a module's collocation steps of so many stages.

    Raises
    ------
    EngineError
        If ``<model>_step.c`` is missing or of another spec, or cannot be compiled.
    """
    step = read_source(engine.module, "_step.c")
    made = replace(engine.sources, step=step, stages=stages, layout=layout, lossy=lossy)
    return shared_library(made)


def is_lossy(engine: Engine) -> bool:
    """Return whether a module has dissipative steps: stores, and a body to take their loss."""
    library = collocation_library(engine, 1, "one")
    return bool(LONG.in_dll(library, f"{engine.module.NAME}_lossy").value)


@final
class Batch:
    """Runs of equal sizes on their way.

    Attributes
    ----------
    x : the states (runs, n): at t = 0, and then where runs stand.
    largest : the largest magnitude of each state (runs, n).
    ledgers : what is booked so far, and what rounding lost of it (runs, 2, rows).
    states, sums : at samples, (runs, samples, n) and (runs, samples, rows), rows in the order of
        `System.rates`, then `more`; nan where a run did not get.
    records : what else C tells of each run, by the names of `Record`.

    Parameters
    ----------
    engine : of the module.
    parameters : of each run.
    x : their states (runs, n) at t = 0.
    inputs : of all.
    times : of samples (samples,).
    layout : "one" run after another, "many" side by side in vectors, or "lanes" of one run's banks.
    more : rows of ledgers behind the model's own, heat and entropy of dissipative steps: 2, or 0.
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
        more: int = 0,
    ) -> None:
        self._engine, self._layout, self._inputs, self.more = engine, layout, inputs, more
        self._name = engine.module.NAME
        self._structures = engine.structure.many(parameters)
        self.x, self.largest = np.array(x, dtype=float), np.abs(x)
        self._raised: list[Exception] = []
        self._kept: list[Pieces] = []
        self._pieces = [self._piece(segment, inputs.signals) for segment in inputs.segments]
        self._segments = (Piece * len(self._pieces))(*(piece for piece, _ in self._pieces))
        self._times = np.ascontiguousarray(times, dtype=float)
        count, n = self.x.shape
        self._runs = (Record * count)()
        self.records: Any = np.frombuffer(memoryview(self._runs), record_of(Record))
        self.records["p"] = self._structures.addresses
        self._take(stepping)
        rows = self.sizes()[3] + more
        self.states = np.full((count, times.size, n), np.nan)
        self.sums = np.full((count, times.size, rows), np.nan)
        self.ledgers = np.zeros((count, 2, rows))
        for name in ("x", "largest", "states", "sums"):
            self.records[name] = addresses(getattr(self, name))
        self.records["ledger"] = addresses(self.ledgers)
        self.go_on(stepping, inputs.duration)

    def go_on(self, stepping: Stepping, stop: float) -> None:
        """Go on from where runs stand until `stop` [s]; those that failed stay where they are.

        The others stand in one segment of the inputs, or beyond `stop`.
        """
        self._take(stepping)
        t = self.records["t"].min(where=self.records["failed"] == 0, initial=stop)
        now = sum(one.stop <= t for one in self._inputs.segments[:-1])
        self.records["segments"] = ctypes.addressof(self._segments) + now * ctypes.sizeof(Piece)
        given = (stepping.tolerance, stepping.first, stepping.longest, stepping.fixed)
        arrays = ctypes.addressof(self._runs), at(self._times)
        over = stepping.kinks == "over" or bool(stepping.fixed > 0)
        ways = stepping.kinks == "either" and not over
        sizes = len(self._runs), self._times.size, over, ways, self.more
        task = Task(*arrays, *sizes, stop, *given)
        size = self.function("batch_size")
        size.restype = LONG
        self._room = np.zeros(int(size(ctypes.byref(task))) + ALIGNED, dtype=np.uint8)
        place = self._room.ctypes.data
        self._batch = ctypes.c_void_p(place + -place % ALIGNED)
        self.call("open", ctypes.byref(task))

    def _take(self, stepping: Stepping) -> None:
        given = self._engine, stepping.stages, "one" if stepping.lossy else self._layout
        self._library = collocation_library(*given, lossy=stepping.lossy)

    def sizes(self) -> NDArray[Any]:
        """Return what the model's own function says of its arrays' sizes."""
        module = self._engine.module
        found = np.zeros(7 + len(module.BANKS) + len(module.STATES), dtype=np.dtype("l"))
        first = ctypes.c_void_p(int(self._structures.addresses[0]))
        self.function("sizes_of")(first, at(found))
        return found

    def one(self) -> tuple[ctypes.c_void_p, int, int]:
        """Return the addresses of the batch, of its first run, and of its first signals."""
        return self._batch, ctypes.addressof(self._runs), self._segments[0].signals

    @property
    def segments(self) -> int:
        """The address of the inputs' segments."""
        return ctypes.addressof(self._segments)

    def function(self, word: str) -> Any:
        """Return one of the functions of C by its own name."""
        return getattr(self._library, f"{self._name}_{word}")

    def survey(self, longest: float) -> None:
        """Find by rough steps, none longer than that [s], how large states become: `largest`."""
        self.call("survey", DOUBLE(longest))

    def go(self, ticks: int) -> bool:
        """Take at most so many steps in each lane; return whether there is more to do."""
        return bool(self.call("go", LONG(ticks)))

    def here(self) -> FloatArray:
        """Return where runs stand that are on their way, (lanes, n)."""
        found = np.empty((1, self.x.shape[1]))
        self.call("here", at(found))
        return found

    def call(self, word: str, *more: Any) -> Any:
        """Call one of the functions of C on the batch; raise what an input has raised."""
        found = self.function(word)(self._batch, *more)
        if self._raised:
            raise self._raised[0]
        return found

    def _piece(self, segment: Segment, signals: Sequence[Signal]) -> tuple[Piece, Any]:
        """Return a segment as C takes it, and the waves that it points to."""
        waves = (self._wave(signal, segment.low, segment.high) for signal in signals)
        found = (Wave * max(1, len(signals)))(*waves)
        return Piece(segment.stop, ctypes.addressof(found)), found

    def _wave(self, signal: Signal, low: float, high: float) -> Wave:
        """Return a signal as C takes it, within [low, high]."""
        match signal:
            case Constant(value):
                return Wave(offset=value)
            case Sine(amplitude, frequency, offset, phase):
                return Wave(amplitude, frequency, 0.0, phase, offset)
            case Chirp(amplitude, start, stop, duration, offset) if high <= duration:
                return Wave(amplitude, start, (stop - start) / duration, 0.0, offset)

        if found := pieces_of(signal, low, high, self._inputs.duration):
            self._kept.append(found)  # C reads it
            places = found.edges.ctypes.data, found.coefficients.ctypes.data
            return Wave(0.0, 0.0, 0.0, 0.0, 0.0, *places, *found.coefficients.shape)

        def asked(t: float) -> float:
            try:
                return float(signal(min(max(t, low), high)))
            except Exception as error:  # C cannot pass it on: no step has a number that is none
                self._raised.append(error)
                return nan

        return Wave(asked=ASKED(asked))
