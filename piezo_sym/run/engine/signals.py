"""The inputs of a run as C takes them: waves, polynomials piece by piece, or functions to call.

Input: `Inputs`.  Output: `InputRecords`.  A signal that C does not know becomes polynomials on
pieces of its segment, so that C has its values without a call of Python; one that would take some
thousand pieces is called.
"""

from __future__ import annotations

import ctypes
from dataclasses import dataclass
from math import ceil, nan
from typing import Any, final

import numpy as np

from piezo_sym.run.checks import FloatArray
from piezo_sym.run.engine.records import DOUBLE, POINTER, c_record
from piezo_sym.run.inputs import Inputs, Segment
from piezo_sym.run.samples import Samples
from piezo_sym.run.signals import Chirp, Constant, Ramp, Signal, Sine, Square, Step

_CALLED = ctypes.CFUNCTYPE(DOUBLE, DOUBLE)
#: Terms of a piece, and how large the last of them may be, as a part of the signal's size.
TERMS, EXACT = 12, 1e-13
#: Pieces of a run to begin with, so that nothing is missed that lasts as long as the time between
#: two samples of `jumps`; how often pieces may be halved, and how many there may be.
FIRST, ROUNDS, MOST = 192, 16, 5000


@final
class InputRecords:
    """The segments of some inputs in C, an array of MODEL(segment), and what they point into.

    `raised` is what functions of time have raised, which C cannot pass on.
    """

    def __init__(self, inputs: Inputs) -> None:
        self._inputs = inputs
        self.raised: list[Exception] = []
        self._kept: list[Any] = []
        made = [self._segment(segment) for segment in inputs.segments]
        self.segments: Any = (c_record("segment") * len(made))(*made)

    def address(self, t: float) -> int:
        """Return the address of the segment that begins at t [s], or in which t lies."""
        now = sum(one.stop <= t for one in self._inputs.segments[:-1])
        return ctypes.addressof(self.segments) + now * ctypes.sizeof(c_record("segment"))

    def _segment(self, segment: Segment) -> Any:
        signals = self._inputs.signals
        found = (c_record("signal") * max(1, len(signals)))(
            *(self._signal(signal, segment.low, segment.high) for signal in signals)
        )
        self._kept.append(found)
        return c_record("segment")(stop=segment.stop, signals=ctypes.addressof(found))

    def _signal(self, signal: Signal, low: float, high: float) -> Any:
        wave = c_record("signal")
        match signal:
            case Constant(value):
                return wave(offset=value)
            case Sine(amplitude, frequency, offset, phase):
                return wave(amplitude, frequency, 0.0, phase, offset)
            case Chirp(amplitude, start, stop, duration, offset) if high <= duration:
                return wave(amplitude, start, (stop - start) / duration, 0.0, offset)

        if found := pieces_of(signal, low, high, self._inputs.duration):
            self._kept.append(found)
            pieces, terms = found.coefficients.shape
            edges, coefficients = found.edges.ctypes.data, found.coefficients.ctypes.data
            return wave(edges=edges, coefficients=coefficients, pieces=pieces, terms=terms)

        def called(t: float) -> float:
            try:
                return float(signal(min(max(t, low), high)))
            except Exception as error:  # the user's own code; with nan, C finds no step
                self.raised.append(error)
                return nan

        self._kept.append(_CALLED(called))
        return wave(called=ctypes.cast(self._kept[-1], POINTER))


@final
@dataclass(frozen=True)
class Pieces:
    """A function by its coefficients (pieces, terms) in Chebyshev's polynomials on each piece.

    `edges` (pieces + 1,) are times [s].
    """

    edges: FloatArray
    coefficients: FloatArray


def pieces_of(signal: Signal, low: float, high: float, duration: float) -> Pieces | None:
    """Return a signal as polynomials on [low, high]; None if that takes too many pieces."""
    if isinstance(signal, Samples):
        return _lines(signal, low, high)
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
        good = np.abs(terms[:, -2:]).max(axis=1) <= EXACT * size
        done.append((starts[good], terms[good]))
        if good.all():
            break
        bad = ~good
        starts = np.concatenate([starts[bad], middle[bad]])
        stops = np.concatenate([middle[bad], stops[bad]])
        if starts.size + sum(part.size for part, _ in done) > MOST:
            return None
    else:
        return None
    found = np.concatenate([part for part, _ in done])
    order = np.argsort(found)
    coefficients = np.concatenate([terms for _, terms in done])[order]
    return Pieces(np.append(found[order], high), np.ascontiguousarray(coefficients))


def _lines(signal: Samples, low: float, high: float) -> Pieces:
    inner = signal.times[(signal.times > low) & (signal.times < high)]
    edges = np.concatenate([[low], inner, [high]])
    values = np.asarray(signal(edges))
    first, last = values[:-1], values[1:]
    return Pieces(edges, np.stack([0.5 * (first + last), 0.5 * (last - first)], axis=1))
