"""C structures for Python: those declared in the files of this folder; parameters; inputs.

Input: the declarations; a module's `Parameters`, of one run or of many; `Inputs`.  Output: ctypes
structures, their addresses, and the arrays to which they point.  A signal that C cannot compute is
approximated by piecewise polynomials, so that C does not call Python; one that needs some thousand
pieces is called.
"""

import ctypes
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache, lru_cache
from itertools import repeat
from math import ceil, nan
from operator import is_
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from piezo_sym.run.checks import FloatArray
from piezo_sym.run.engine.c_sources import c_source
from piezo_sym.run.inputs import Inputs, Segment
from piezo_sym.run.module import GeneratedModule, lanes
from piezo_sym.run.samples import Samples
from piezo_sym.run.signals import Chirp, Constant, Ramp, Signal, Sine, Square, Step, Triangle

POINTER, LONG, INT, DOUBLE = ctypes.c_void_p, ctypes.c_long, ctypes.c_int, ctypes.c_double
_DECLARED = ("inputs.c", "trajectory.c", "batch.c", "step_once.c", "derivatives.c")
_NUMBERS = {"double": DOUBLE, "long": LONG}

#: The number of parameters whose structures are cached: calls of single runs use the same ones.
REMEMBERED = 256
_CALLED = ctypes.CFUNCTYPE(DOUBLE, DOUBLE)
#: Chebyshev terms of a piece; the bound on its last two, over the signal's size, to be exact.
TERMS, EXACT = 12, 1e-13
#: The first number of pieces of a run, so that their nodes are as dense as the samples of `jumps`;
#: the most times that pieces are halved, and the most pieces.
FIRST, ROUNDS, MOST = 192, 16, 5000
#: The most corners of a triangle wave that is a polygon in C.
MOST_LINES = 1_000_000


@cache
def c_record(name: str) -> Any:
    """Return MODEL(name) as a ctypes structure, from its declaration in C.

    Fields are numbers, `double` or `long`, and pointers.
    """
    text = re.sub(r"/\*.*?\*/", "", c_source(*_DECLARED), flags=re.DOTALL)
    declaration = re.search(rf"typedef struct {{([^{{}}]*)}} MODEL\({name}\);", text)
    if not declaration:
        msg = f"no file declares a record {name}"
        raise LookupError(msg)
    return type(name, (ctypes.Structure,), {"_fields_": list(_fields(declaration[1]))})


def _fields(declarations: str) -> Iterator[tuple[str, Any]]:
    for declaration in declarations.split(";")[:-1]:
        if function := re.search(r"\(\*(\w+)\)", declaration):
            yield function[1], POINTER
            continue
        kind, names = declaration.replace("const ", "").split(maxsplit=1)
        for name in (one.strip() for one in names.split(",")):
            yield name.lstrip("*"), POINTER if name.startswith("*") else _NUMBERS[kind]


@cache
def record_dtype(name: str) -> np.dtype[Any]:
    """Return the NumPy type of an array of MODEL(name)."""
    dtype: np.dtype[Any] = np.dtype(c_record(name))
    return dtype


def at(array: NDArray[Any]) -> ctypes.c_void_p:
    """Return the address of an array's numbers."""
    return ctypes.c_void_p(array.ctypes.data)


def addresses(array: NDArray[Any]) -> NDArray[np.uintp]:
    """Return the address of each entry of an array along its first axis."""
    return np.arange(len(array), dtype=np.uintp) * array.strides[0] + array.ctypes.data


@final
@dataclass(frozen=True, eq=False)
class Structures:
    """C structures of some runs: the first, their addresses, and the arrays that they need."""

    value: ctypes.Structure
    addresses: NDArray[np.uintp]
    kept: tuple[object, ...]


@final
class ParameterRecords:
    """Converts a module's `Parameters` to the structure of its header.

    Its fields are in the order of the spec, a number each, or a pointer to one number per lane;
    then the sizes of banks.
    """

    def __init__(self, module: GeneratedModule) -> None:
        self._module = module
        fields: list[tuple[str, Any]] = [
            (f"field_{n}", POINTER if record.bank else DOUBLE)
            for n, record in enumerate(module.PARAMETERS)
        ]
        fields += [(f"count_{n}", LONG) for n, _ in enumerate(module.BANKS)]
        none = [("none", ctypes.c_char)]
        self._kind: Any = type("Parameters", (ctypes.Structure,), {"_fields_": fields or none})
        self._dtype: np.dtype[Any] = np.dtype(self._kind)
        self._cached = lru_cache(maxsize=REMEMBERED)(lambda p: self._made([p]))

    def __call__(self, p: Any) -> Structures:
        """Return the structure of one run."""
        try:
            return self._cached(p)
        except TypeError:  # a list among the values is not hashable
            return self._made([p])

    def many(self, parameters: Sequence[Any]) -> Structures:
        """Return the structures of runs whose banks have equal sizes."""
        return self(*parameters) if len(parameters) == 1 else self._made(parameters)

    def _made(self, parameters: Sequence[Any]) -> Structures:
        records: NDArray[Any] = np.zeros(len(parameters), self._dtype)
        kept: list[object] = [records]
        for n, record in enumerate(self._module.PARAMETERS):
            values: Any = [getattr(p, record.name) for p in parameters]
            if record.bank:
                rows = _rows(values, lanes(parameters[0], record.bank))
                kept.append(rows)
                values = addresses(rows)
            records[f"field_{n}"] = values
        for n, bank in enumerate(self._module.BANKS):
            records[f"count_{n}"] = lanes(parameters[0], bank)
        first = self._kind.from_address(records.ctypes.data)
        return Structures(first, addresses(records), tuple(kept))


def _rows(values: Sequence[Any], count: int) -> FloatArray:
    """Return the values of a parameter of a bank, (runs, lanes), or one row for all runs."""
    if all(map(is_, values, repeat(values[0]))):
        return _spread(values[0], count)[None]
    if all(isinstance(value, float) for value in values):
        return np.repeat(np.array(values, dtype=float)[:, None], count, axis=1)
    return np.array([_spread(value, count) for value in values])


def _spread(value: Any, count: int) -> FloatArray:
    array = np.array(value, dtype=float)
    if array.ndim and array.shape != (count,):
        msg = f"a parameter of a bank of {count} lanes has {array.size} values"
        raise ValueError(msg)
    return np.ascontiguousarray(np.broadcast_to(array, (count,)))


@final
class InputRecords:
    """The segments of inputs in C, an array of MODEL(segment), and the arrays that they need.

    `raised` are exceptions of functions of time, which C cannot pass on; `calls`: whether it has
    such functions; `received`: signals that end the process, and so the run.
    """

    def __init__(self, inputs: Inputs) -> None:
        self._inputs = inputs
        self.raised: list[BaseException] = []
        self.calls, self.received = False, list[int]()
        self._kept: list[Any] = []
        segments = [self._segment(segment) for segment in inputs.segments]
        self.segments: Any = (c_record("segment") * len(segments))(*segments)

    def address(self, t: float) -> int:
        """Return the address of the segment that begins at t [s] or contains it."""
        now = sum(one.stop <= t for one in self._inputs.segments[:-1])
        return ctypes.addressof(self.segments) + now * ctypes.sizeof(c_record("segment"))

    def _segment(self, segment: Segment) -> Any:
        low, high = segment.low, segment.high
        signals = [self._signal(signal, low, high) for signal in self._inputs.signals]
        array = (c_record("signal") * max(1, len(signals)))(*signals)
        self._kept.append(array)
        return c_record("segment")(stop=segment.stop, signals=ctypes.addressof(array))

    def _signal(self, signal: Signal, low: float, high: float) -> Any:
        wave = c_record("signal")
        match signal:
            case Constant(value):
                return wave(offset=value)
            case Sine(amplitude, frequency, offset, phase):
                return wave(amplitude, frequency, 0.0, phase, offset)
            case Chirp(amplitude, start, stop, duration, offset) if high <= duration:
                return wave(amplitude, start, (stop - start) / duration, 0.0, offset)

        if pieces := pieces_of(signal, low, high, self._inputs.duration):
            self._kept.append(pieces)
            count, terms = pieces.coefficients.shape
            edges, coefficients = pieces.edges.ctypes.data, pieces.coefficients.ctypes.data
            return wave(edges=edges, coefficients=coefficients, pieces=count, terms=terms)

        def called(t: float) -> float:
            if self.raised or self.received:
                return nan  # the run ends
            try:
                return float(signal(min(max(t, low), high)))
            except BaseException as error:  # the user's own code; with nan, C finds no step
                self.raised.append(error)
                return nan

        self.calls = True
        self._kept.append(_CALLED(called))
        return wave(called=ctypes.cast(self._kept[-1], POINTER))


@final
@dataclass(frozen=True)
class Pieces:
    """A piecewise polynomial: times `edges` (pieces + 1,) [s], and Chebyshev coefficients."""

    edges: FloatArray
    coefficients: FloatArray  # (pieces, terms)


def pieces_of(signal: Signal, low: float, high: float, duration: float) -> Pieces | None:
    """Return a signal as polynomials on [low, high]; None if it needs too many pieces."""
    if isinstance(signal, Samples):
        return _lines(signal, signal.times, low, high)
    if isinstance(signal, Triangle) and 2 * signal.frequency * high <= MOST_LINES:
        return _lines(signal, signal.corners(high), low, high)
    at = np.cos(np.pi * (np.arange(TERMS) + 0.5) / TERMS)
    to_terms = np.linalg.inv(np.polynomial.chebyshev.chebvander(at, TERMS - 1)).T
    first = 1 if isinstance(signal, Step | Ramp | Square) else ceil(FIRST * (high - low) / duration)
    edges = np.linspace(low, high, max(1, min(first, FIRST)) + 1)
    starts, stops = edges[:-1], edges[1:]
    done: list[tuple[FloatArray, FloatArray]] = []
    size = 0.0
    for _ in range(ROUNDS):
        middle, half = 0.5 * (stops + starts), 0.5 * (stops - starts)
        values = np.asarray(signal(middle[:, None] + half[:, None] * at))
        size = max(size, float(np.abs(values).max(initial=0.0)))
        terms = values @ to_terms
        exact = np.abs(terms[:, -2:]).max(axis=1) <= EXACT * size
        done.append((starts[exact], terms[exact]))
        if exact.all():
            break
        starts, middle, stops = starts[~exact], middle[~exact], stops[~exact]
        starts, stops = np.concatenate([starts, middle]), np.concatenate([middle, stops])
        if starts.size + sum(first.size for first, _ in done) > MOST:
            return None
    else:
        return None
    starts = np.concatenate([first for first, _ in done])
    order = np.argsort(starts)
    coefficients = np.concatenate([terms for _, terms in done])[order]
    return Pieces(np.append(starts[order], high), np.ascontiguousarray(coefficients))


def _lines(signal: Signal, times: FloatArray, low: float, high: float) -> Pieces:
    inner = times[(times > low) & (times < high)]
    edges = np.concatenate([[low], inner, [high]])
    values = np.asarray(signal(edges))
    first, last = values[:-1], values[1:]
    return Pieces(edges, np.stack([0.5 * (first + last), 0.5 * (last - first)], axis=1))
