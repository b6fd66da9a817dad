"""The inputs of a run in C: waves, piecewise polynomials, or functions to call.

Input: `Inputs`.  Output: `InputRecords`.  A signal that C cannot compute is approximated by
piecewise polynomials, so that C does not call Python; one that needs some thousand pieces is
called.
"""

import ctypes
from dataclasses import dataclass
from math import ceil, nan
from typing import Any, final

import numpy as np

from piezo_sym.run.checks import FloatArray
from piezo_sym.run.engine.records import DOUBLE, POINTER, c_record
from piezo_sym.run.inputs import Inputs, Segment
from piezo_sym.run.samples import Samples
from piezo_sym.run.signals import Chirp, Constant, Ramp, Signal, Sine, Square, Step, Triangle

_CALLED = ctypes.CFUNCTYPE(DOUBLE, DOUBLE)
#: Chebyshev terms of a piece; the bound on its last two, over the signal's size, to be exact.
TERMS, EXACT = 12, 1e-13
#: The first number of pieces of a run, so that their nodes are as dense as the samples of `jumps`;
#: the most times that pieces are halved, and the most pieces.
FIRST, ROUNDS, MOST = 192, 16, 5000
#: The most corners of a triangle wave that is a polygon in C.
MOST_LINES = 1_000_000


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
