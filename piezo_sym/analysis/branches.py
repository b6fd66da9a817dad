"""Branches of periodic steady states over the frequency of the drive, their folds, and the jumps.

Input: a generated module with one body, its inputs as a function of the frequency, a range of
frequencies and of temperatures.  Output: `Branches`: curves in the plane of frequency and
temperature, stable or not, and the jumps where a stable part ends.

    drift(T, f) = 0        traced as a curve in (log f, log T), from every zero at the two ends

A stable part ends in a fold, where it meets an unstable one. Who moves the frequency past it sees
the temperature jump: it runs away to another branch, or falls back to one.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, final

import numpy as np

from piezo_sym.analysis.balance import Settled, SteadyWarning, grid, scan, settled, zeros
from piezo_sym.analysis.steady import temperature_range
from piezo_sym.analysis.stroboscope import Stroboscope, stroboscope
from piezo_sym.errors import RunError, UsageError
from piezo_sym.run.checks import positive

if TYPE_CHECKING:
    from collections.abc import Mapping

    from piezo_sym.analysis.stroboscope import Driven
    from piezo_sym.run.checks import FloatArray
    from piezo_sym.run.module import GeneratedModule
    from piezo_sym.run.parameters import LaneValue

STEPS = 256  # a period
LONGEST, SHORTEST = 0.15, 1e-4  # step along a curve, in log f and log T
SHARP = 0.3  # rad: a curve may turn so much in a step
MOST_POINTS = 2000
EXACT = 1e-10  # in log f and log T
SAME = 1e-3  # zeros nearer than this in log T are one


@final
@dataclass(frozen=True)
class Point:
    """A periodic steady state on a curve."""

    frequency: float
    state: Settled
    rising: float  # d drift/d log T: stable if negative
    place: FloatArray  # (log f, log T)

    @property
    def stable(self) -> bool:
        """Whether the body comes back to this temperature."""
        return self.rising < 0

    def described(self) -> tuple[float, ...]:
        """Return frequency, the body's mean, least and greatest temperature, and 1 if stable."""
        T = self.state.period
        return self.frequency, T.mean, T.coldest, T.hottest, float(self.stable)


@final
@dataclass(frozen=True)
class Jump:
    """Where a stable part of a curve ends: move the frequency on, and the temperature jumps.

    Attributes
    ----------
    frequency : at which it ends [Hz].
    upward : whether it ends as the frequency rises.
    temperature : mean of the body there [K].
    lands : mean temperature of the stable state that it goes to [K], nan if none is known.
    """

    frequency: float
    upward: bool
    temperature: float
    lands: float


COLUMNS = ("curve", "frequency", "temperature", "coldest", "hottest", "stable", "jumps_to")


@final
@dataclass(frozen=True)
class Branches:
    """Curves of periodic steady states, each a tuple of points in order, and the jumps."""

    curves: tuple[tuple[Point, ...], ...]
    jumps: tuple[Jump, ...]

    def table(self) -> dict[str, FloatArray]:
        """Return columns, a row a point.

        The number of its curve, frequency [Hz], temperature (mean), coldest and hottest [K], stable
        (0 or 1), and at a fold the temperature that the body jumps to [K] (inf if beyond the
        range), elsewhere nan.
        """
        lands = {jump.frequency: jump.lands for jump in self.jumps}
        rows = [
            (n, *p.described(), _nan_elsewhere(lands.get(p.frequency)))
            for n, curve in enumerate(self.curves)
            for p in curve
        ]
        columns = np.array(rows, dtype=float).reshape(-1, len(COLUMNS)).T
        return dict(zip(COLUMNS, columns, strict=True))


def _nan_elsewhere(lands: float | None) -> float:
    """Return where a fold lands, inf if it is not known; nan for what is no fold."""
    if lands is None:
        return np.nan
    return np.inf if np.isnan(lands) else lands


def steady_branches(
    module: GeneratedModule,
    *,
    inputs: Driven,
    frequencies: tuple[float, float],
    parameters: Mapping[str, LaneValue] | None = None,
    initial: Mapping[str, LaneValue] | None = None,
    temperatures: tuple[float, float] | None = None,
) -> Branches:
    """Return the periodic steady states of a model over a range of frequencies.

    Parameters
    ----------
    module : a generated module; `piezo_sym.steady_branches` also takes a model, a name or a path.
    inputs : function of the frequency [Hz] to inputs as for `simulate`, which repeat with it.
    frequencies, temperatures : least and greatest [Hz], [K]; temperatures when left out from the
        module's own start to 20 times that. Curves end where they leave the ranges.
    parameters, initial : as for `simulate`.

    Raises
    ------
    UsageError : an argument is wrong, an input does not repeat, or there is not one body.

    Notes
    -----
    Curves that touch neither end of the range of frequencies are not found. Temperatures are those
    of 256 steps a period, within about 1e-4 of the rise over the environment; where more is asked
    for, give a point's frequency to `periodic_steady_state`.
    """
    low, high = (positive(f, "steady_branches.frequencies") for f in frequencies)
    if low >= high:
        what = f"{low:g} Hz to {high:g} Hz is no range"
        raise UsageError(what, "steady_branches.frequencies", "the least, then the greatest")
    strobe = stroboscope(module, inputs, low, parameters, initial, STEPS)
    span = np.log([[low, high], temperature_range(strobe, low, temperatures)])
    curves: list[tuple[Point, ...]] = []
    folds: list[tuple[int, Point, bool]] = []
    for curve in _curves(strobe, span):
        found = tuple(_folds(strobe, curve))
        folds += found
        curves.append(_with_folds(curve, found))
    whole = tuple(curves)
    return Branches(whole, tuple(_jump(strobe, whole, point, up) for _, point, up in folds))


def _curves(strobe: Stroboscope, span: FloatArray) -> Iterator[tuple[Point, ...]]:
    """Yield curves from the zeros at both ends of the range of frequencies, each once."""
    reached: list[FloatArray] = []
    for log_f, way in ((span[0, 0], 1.0), (span[0, 1], -1.0)):
        f = float(np.exp(log_f))
        asked = grid(*np.exp(span[1]).tolist())
        known = [state for state in scan(strobe, f, asked, strobe.start(f)) if state]
        for zero in zeros(strobe, f, known):
            place = np.array([log_f, np.log(zero.temperature)])
            if any(np.max(np.abs(place - other)) < SAME for other in reached):
                continue
            curve = tuple(_traced(strobe, place, zero, way, span))
            if not curve:
                continue
            reached += [curve[0].place, curve[-1].place]
            yield curve


def _traced(
    strobe: Stroboscope, place: FloatArray, zero: Settled, way: float, span: FloatArray
) -> Iterator[Point]:
    """Yield the points of the curve through a zero, to where it leaves the ranges."""
    tangent = np.array([way, 0.0])
    try:
        point = _corrected(strobe, place, np.array([0.0, 1.0]), zero)
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
        if turn > SHARP and length > SHORTEST:
            length /= 2
            continue
        tangent, point = ahead / step, new
        yield point
        if not np.all((span[:, 0] + EXACT < new.place) & (new.place < span[:, 1] - EXACT)):
            return
        length = min(LONGEST, length * (1.5 if turn < SHARP / 3 else 1.0))


def _next(
    strobe: Stroboscope, point: Point, tangent: FloatArray, length: float, span: FloatArray
) -> Point | None:
    """Return the next point, at most `length` on; on the edge, if it would leave the range."""
    guess = point.place + length * tangent
    across = np.array([-tangent[1], tangent[0]])
    if not span[0, 0] <= guess[0] <= span[0, 1]:
        edge = float(np.clip(guess[0], *span[0]))
        part = (edge - point.place[0]) / (guess[0] - point.place[0])
        guess = np.array([edge, (point.place + part * length * tangent)[1]])
        across = np.array([0.0, 1.0])
    try:
        new = _corrected(strobe, guess, across, point.state)
    except RunError:
        return None
    far = float(np.hypot(*(new.place - point.place)))
    return new if EXACT < far < 2 * length else None


def _corrected(strobe: Stroboscope, guess: FloatArray, across: FloatArray, near: Settled) -> Point:
    """Return the zero of the drift on the line through `guess` along `across`, by secants.

    Raises
    ------
    RunError : the secants do not meet one, or nothing settles on the way.
    """
    s, last, slope = 0.0, None, 0.0
    for _ in range(20):
        log_f, log_T = guess + s * across
        f = float(np.exp(log_f))
        state = settled(strobe, f, float(np.exp(log_T)), near.x, near.slope)
        rate = state.drift * f
        if last is None:
            move = 1e-4 if s == 0 else 0.0
        else:
            slope = (rate - last[1]) / (s - last[0])
            move = -rate / slope if slope else 0.0
            if abs(move) <= EXACT or rate == 0:
                return Point(f, state, slope * float(across[1]), guess + s * across)
        last, s, near = (s, rate), s + float(np.clip(move, -LONGEST, LONGEST)), state
    what = f"no steady state near {f:g} Hz and {near.temperature:.6g} K"
    raise RunError(what, f"model '{strobe.module.NAME}'")


def _folds(strobe: Stroboscope, curve: tuple[Point, ...]) -> Iterator[tuple[int, Point, bool]]:
    """Yield each fold, the number of the point nearest to it, and whether it is the highest f."""
    for n in range(1, len(curve) - 1):
        a, b, c = curve[n - 1 : n + 2]
        if (b.place[0] - a.place[0]) * (c.place[0] - b.place[0]) < 0:
            yield n, _fold(strobe, a, b, c), bool(b.place[0] > a.place[0])


def _with_folds(
    curve: tuple[Point, ...], folds: tuple[tuple[int, Point, bool], ...]
) -> tuple[Point, ...]:
    """Return a curve with its folds in place of the points nearest to them."""
    at = {n: point for n, point, _ in folds}
    return tuple(at.get(n, point) for n, point in enumerate(curve))


def _fold(strobe: Stroboscope, a: Point, b: Point, c: Point) -> Point:
    """Return the point of extreme frequency between three, by parabolas of log f over log T."""
    for _ in range(3):
        x = np.array([p.place[1] - b.place[1] for p in (a, b, c)])
        y = np.array([p.place[0] - b.place[0] for p in (a, b, c)])
        curve = np.polyfit(x, y, 2)
        top = float(np.clip(-curve[1] / (2 * curve[0]), min(x), max(x)))
        if abs(top) < 1e-7:
            break
        guess = b.place + np.array([np.polyval(curve, top), top])
        new = _corrected(strobe, guess, np.array([1.0, 0.0]), b.state)
        if (new.place[0] - b.place[0]) * curve[0] > 0:  # no further out than b
            break
        a, c = (b, c) if (new.place[1] - b.place[1]) * (c.place[1] - b.place[1]) > 0 else (a, b)
        b = new
    return b


def _jump(
    strobe: Stroboscope, curves: tuple[tuple[Point, ...], ...], fold: Point, upward: bool
) -> Jump:
    """Return where the temperature goes from a fold: the drift just beyond it says which way."""
    beyond = fold.frequency * (1.01 if upward else 0.99)
    heats = settled(strobe, beyond, fold.state.temperature, fold.state.x, None).drift > 0
    log_f = float(np.log(beyond))
    found = [p for p in _crossings(curves, log_f) if (p[0] > fold.place[1]) == heats]
    found.sort(reverse=not heats)
    lands = found[0][1] if found else np.nan
    return Jump(fold.frequency, upward, fold.state.period.mean, float(lands))


def _crossings(
    curves: tuple[tuple[Point, ...], ...], log_f: float
) -> Iterator[tuple[float, float]]:
    """Yield log T at t = 0 and mean T of the stable states at a frequency, between points."""
    for curve in curves:
        for a, b in pairwise(curve):
            if a.stable and b.stable and (a.place[0] - log_f) * (b.place[0] - log_f) <= 0:
                part = (log_f - a.place[0]) / (b.place[0] - a.place[0])
                log_T = a.place[1] + part * (b.place[1] - a.place[1])
                means = np.log([a.state.period.mean, b.state.period.mean])
                yield float(log_T), float(np.exp(means[0] + part * (means[1] - means[0])))
