"""Curves of periodic steady states in the plane of frequency and temperature, and their folds.

Input: a `Stroboscope`, a zero of its drift, the ranges of both axes.  Output: points of the curve

    drift(T, f) = 0        in (log f, log T)

A step follows the last chord, then the secant method goes at a right angle to it to a zero of the
drift.  So a curve is followed around its folds, where it is vertical over f.
"""

import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TypeAlias, final

import numpy as np

from piezo_sym.analysis.balance import Settled, SteadyWarning, settled
from piezo_sym.analysis.stroboscope import Stroboscope
from piezo_sym.errors import RunError
from piezo_sym.run.checks import FloatArray

LONGEST, SHORTEST = 0.12, 1e-4  # step along a curve, in log f and log T
MOST_TURN = 0.2  # rad, of a curve in one step
MOST_POINTS = 2000
DIFFERENCE = 1e-5  # in log T, for a difference quotient
FIRST = 1e-4  # step of the secant method where the slope is unknown
EXACT = 1e-8  # in log f and log T
MOST_SECANTS = 20
FOLD = 1e-5  # in log T: a fold is flat there


@final
@dataclass(frozen=True, eq=False)
class CurvePoint:
    """A periodic steady state on a curve."""

    frequency: float
    state: Settled
    rising: float  # derivative of the drift per second by log T: stable if negative
    steepness: float  # that along the line on which the point was found
    place: FloatArray  # (log f, log T)

    @property
    def stable(self) -> bool:
        """Whether the body returns to this temperature."""
        return self.rising < 0


Curve: TypeAlias = tuple[CurvePoint, ...]


def trace(
    strobe: Stroboscope, place: FloatArray, zero: Settled, direction: float, span: FloatArray
) -> Iterator[CurvePoint]:
    """Yield the points of the curve from a zero to the edge of `span`.

    The frequency rises at first if `direction` is 1, and falls if it is -1; `span` (2, 2) is the
    range of log f, and of log T.
    """
    tangent, known = np.array([direction, 0.0]), False
    try:
        point = _correct(strobe, place, np.array([0.0, 1.0]), zero)
    except RunError as error:
        warnings.warn(f"{error}; a curve is left out", SteadyWarning, stacklevel=4)
        return
    yield point
    length = LONGEST / 8
    for _ in range(MOST_POINTS):
        new = _next(strobe, point, tangent, length, span)
        if new is None:
            if length < SHORTEST:
                return
            length /= 2
            continue
        ahead = new.place - point.place
        step = float(np.hypot(*ahead))
        turn = float(np.arccos(np.clip(ahead @ tangent / step, -1, 1)))
        if known and turn > MOST_TURN and length > SHORTEST:
            length /= 2
            continue
        tangent, point, known = ahead / step, new, True
        yield point
        if not np.all((span[:, 0] + EXACT < new.place) & (new.place < span[:, 1] - EXACT)):
            return
        length = min(LONGEST, length * (1.5 if turn < MOST_TURN / 3 else 1.0))


def _next(
    strobe: Stroboscope, point: CurvePoint, tangent: FloatArray, length: float, span: FloatArray
) -> CurvePoint | None:
    """Return the next point, about `length` away or at the end of f's range, or None."""
    guess = point.place + length * tangent
    across, hint = np.array([-tangent[1], tangent[0]]), point.steepness
    if not span[0, 0] <= guess[0] <= span[0, 1]:
        edge = float(np.clip(guess[0], *span[0]))
        part = (edge - point.place[0]) / (guess[0] - point.place[0])
        guess = np.array([edge, (point.place + part * length * tangent)[1]])
        across, hint = np.array([0.0, 1.0]), point.rising
    try:
        new = _correct(strobe, guess, across, point.state, hint)
    except RunError:
        return None
    far = float(np.hypot(*(new.place - point.place)))
    return new if EXACT < far < 2 * length else None


def _correct(
    strobe: Stroboscope,
    guess: FloatArray,
    across: FloatArray,
    near: Settled,
    steepness: float = 0.0,
) -> CurvePoint:
    """Return the zero of the drift on the line through `guess` along `across`, by secants.

    `steepness` is the derivative of the drift per second along the line, 0 if it is unknown.
    """
    s, before = 0.0, (0.0, 0.0)
    for n in range(MOST_SECANTS):
        place = guess + s * across
        strobe = strobe.at(float(np.exp(place[0])))
        state = settled(strobe, float(np.exp(place[1])), near.x)
        rate = state.drift * strobe.frequency
        if n:
            steepness = (rate - before[1]) / (s - before[0])
        move = -rate / steepness if steepness else FIRST
        if (n and abs(move) <= EXACT) or rate == 0:
            beside = settled(strobe, state.temperature * (1 + DIFFERENCE), state.x)
            rising = (beside.drift - state.drift) * strobe.frequency / DIFFERENCE
            return CurvePoint(strobe.frequency, state, rising, steepness, place)
        before, near = (s, rate), state
        s += float(np.clip(move, -LONGEST, LONGEST)) or FIRST
    what = f"no steady state near {strobe.frequency:g} Hz and {near.temperature:.6g} K"
    raise RunError(what, strobe.where)


def folds(strobe: Stroboscope, curve: Curve) -> Iterator[tuple[int, CurvePoint, bool]]:
    """Yield the index of the point nearest to a fold, the fold, and whether f is greatest there."""
    for n in range(1, len(curve) - 1):
        a, b, c = curve[n - 1 : n + 2]
        if (b.place[0] - a.place[0]) * (c.place[0] - b.place[0]) < 0:
            yield n, _fold(strobe, a, b, c), bool(b.place[0] > a.place[0])


def _fold(strobe: Stroboscope, a: CurvePoint, b: CurvePoint, c: CurvePoint) -> CurvePoint:
    """Return the point of extreme frequency near b, between a and c, by log f over log T."""
    from scipy.optimize import minimize_scalar  # loads slowly, and runs need none

    points = [b]
    sign = 1.0 if b.place[0] > a.place[0] else -1.0

    def objective(log_T: float) -> float:
        guess = np.array([b.place[0], log_T])
        points.append(_correct(strobe, guess, np.array([1.0, 0.0]), b.state))
        return float(-sign * points[-1].place[0])

    low, high = sorted([a.place[1], c.place[1]])
    minimize_scalar(objective, bounds=(low, high), method="bounded", options={"xatol": FOLD})
    return max(points, key=lambda point: float(sign * point.place[0]))
