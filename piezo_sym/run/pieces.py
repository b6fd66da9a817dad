"""Signals as polynomials, piece by piece: C then has their values without asking Python for each.

Input: a `Signal`, and a stretch of time in which it has no break.  Output: `Pieces`, or None where
the signal has no such form of some thousand pieces.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil
from typing import final

import numpy as np

from piezo_sym.run.checks import FloatArray
from piezo_sym.run.samples import Samples
from piezo_sym.run.signals import Ramp, Signal, Step

#: Terms of a piece, and what the last of them may have, in parts of the signal's size.
TERMS, EXACT = 12, 1e-13
#: Pieces of a run to begin with, so that nothing is missed that is as long as the time between two
#: questions of `jumps`; how often they may be halved, and how many there may be.
FIRST, ROUNDS, MOST = 192, 16, 5000


@final
@dataclass(frozen=True)
class Pieces:
    """A function by its coefficients (pieces, terms) in Chebyshev's polynomials on each piece.

    `edges` (pieces + 1,) are times [s].
    """

    edges: FloatArray
    coefficients: FloatArray


def pieces_of(signal: Signal, low: float, high: float, duration: float) -> Pieces | None:
    """Return a signal on [low, high], part of a run; None if that takes too many pieces."""
    if isinstance(signal, Samples):
        return _lines(signal, low, high)
    at = np.cos(np.pi * (np.arange(TERMS) + 0.5) / TERMS)
    to_terms = np.linalg.inv(np.polynomial.chebyshev.chebvander(at, TERMS - 1)).T
    first = 1 if isinstance(signal, Step | Ramp) else ceil(FIRST * (high - low) / duration)
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
