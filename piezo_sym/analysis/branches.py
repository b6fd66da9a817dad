"""Branches of periodic steady states over the frequency of the drive, their folds and jumps.

Input: a generated module with one body, its inputs as a function of the frequency, ranges of
frequency and temperature.  Output: `Branches`: curves in the plane of frequency and temperature,
stable or not, and the jumps where a stable part ends.

    drift(T, f) = 0        trace as a curve in (log f, log T), from every zero at the two ends

A stable part ends in a fold, where it meets an unstable one.  When the frequency moves past a
fold, the temperature jumps to another branch, up or down.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import final

import numpy as np

from piezo_sym.analysis.balance import grid, scan, settled, temperature_range, zeros
from piezo_sym.analysis.curves import Curve, CurvePoint, folds, trace
from piezo_sym.analysis.stroboscope import Driven, Stroboscope, refuse_unperiodic, stroboscope
from piezo_sym.errors import UsageError, quote
from piezo_sym.run.checks import FloatArray, calling, positive_range
from piezo_sym.run.module import GeneratedModule, checked
from piezo_sym.run.parameters import LaneValue

STEPS = 256  # per period
SAME = 1e-3  # zeros closer than this in log T count as one
FREQUENCIES = 33  # checked in a range of frequencies, ends included
FOLLOW = "let the inputs follow the frequency"
DRIVEN = "a function of the frequency in Hz, such as lambda f: {'V_in': sine(100, f)}"


@final
@dataclass(frozen=True)
class Jump:
    """The end of a stable part of a curve, past which the temperature jumps.

    Attributes
    ----------
    frequency : at the end [Hz].
    upward : whether the stable part reaches the end with rising frequency.
    temperature : mean temperature of the body there [K].
    lands : mean temperature of the stable state after the jump [K], nan if none is known.
    """

    frequency: float
    upward: bool
    temperature: float
    lands: float


COLUMNS = ("curve", "frequency", "temperature", "coldest", "hottest", "stable", "jumps_to")


@final
@dataclass(frozen=True)
class Branches:
    """Curves of periodic steady states over the frequency, and the jumps.

    Attributes
    ----------
    curves : each a tuple of `CurvePoint` in order: `.frequency` [Hz], `.stable`, and `.state`, with
        the state (n,) at t = 0 as `.x`, and `.period.mean`, `.coldest`, `.hottest` [K].
    jumps : a `Jump` where a stable part ends: `.frequency` [Hz], `.upward`, `.temperature` and
        `.lands` [K].
    """

    curves: tuple[Curve, ...]
    jumps: tuple[Jump, ...]

    def __repr__(self) -> str:
        """Return the numbers of curves and points, and the frequencies of jumps."""
        points = sum(len(curve) for curve in self.curves)
        jumps = ", ".join(f"{jump.frequency:.6g} Hz" for jump in self.jumps) or "none"
        return f"Branches(curves: {len(self.curves)}, points: {points}, jumps: {jumps})"

    def table(self) -> dict[str, FloatArray]:
        """Return columns with a row per point, by the names of `COLUMNS`.

        The number of its curve, frequency [Hz], temperature (mean), coldest and hottest [K], stable
        (0 or 1), and at a fold the temperature after the jump [K] (inf if beyond the range),
        elsewhere nan.
        """
        lands = {j.frequency: np.inf if np.isnan(j.lands) else j.lands for j in self.jumps}
        rows = [
            (n, p.frequency, T.mean, T.coldest, T.hottest, p.stable, lands.get(p.frequency, np.nan))
            for n, curve in enumerate(self.curves)
            for p, T in ((p, p.state.period) for p in curve)
        ]
        columns = np.array(rows, dtype=float).reshape(-1, len(COLUMNS)).T
        return dict(zip(COLUMNS, columns, strict=True))


@calling("steady_branches")
def steady_branches(
    module: GeneratedModule,
    *,
    inputs: Driven,
    frequencies: tuple[float, float],
    parameters: Mapping[str, LaneValue] | None = None,
    initial: Mapping[str, LaneValue] | None = None,
    temperatures: tuple[float, float] | None = None,
) -> Branches:
    """Return the periodic steady states of a model over a range of frequencies, and the jumps.

    >>> from piezo_sym import sine, steady_branches
    >>> options = {"frequencies": (20, 60), "temperatures": (298.15, 400)}
    >>> steady_branches("piezo_stack", inputs=lambda f: {"V_in": sine(10, f)}, **options)
    Branches(curves: 1, points: 14, jumps: none)

    Of the result, ``.table()`` is columns for a plot or a file, such as
    ``pandas.DataFrame(found.table())``; a point ``found.curves[0][0]`` has its `.frequency`,
    whether it is `.stable`, the state (n,) at t = 0 as ``.state.x``, and the temperatures of its
    period as ``.state.period.mean``, `.coldest` and `.hottest`; ``found.jumps`` are the ends of
    stable parts.

    Parameters
    ----------
    model : the name of a shipped spec, the path of a spec file, or a `Model`; here, of
        `piezo_sym.analysis`, a generated module.
    inputs : function of the frequency [Hz] to inputs as for `simulate`, which repeat with it.
    frequencies, temperatures : least and greatest [Hz], [K]; temperatures when left out from the
        module's own start to 20 times that. Curves end where they leave the ranges.
    parameters, initial : as for `simulate`.

    Raises
    ------
    UsageError : an argument is wrong, an input does not repeat, or there is not one body.

    Notes
    -----
    Curves that reach neither end of the range of frequencies are not found. Temperatures are those
    of 256 steps per period, within about 1e-4 of the rise over the environment; for more accuracy,
    give a point's frequency to `periodic_steady_state`.
    """
    low, high = positive_range(frequencies, "steady_branches.frequencies", "Hz")
    _refuse_not_following(checked(module), inputs, low, high)
    strobe = stroboscope(module, inputs, low, parameters, initial, STEPS)
    span = np.log([[low, high], temperature_range(strobe, temperatures)])
    curves: list[Curve] = []
    ends: list[tuple[int, CurvePoint, bool]] = []
    for curve in _curves(strobe, span):
        curve_ends = tuple(folds(strobe, curve))
        ends += curve_ends
        exact = {n: point for n, point, _ in curve_ends}  # replace the points nearest to them
        curves.append(tuple(exact.get(n, point) for n, point in enumerate(curve)))
    jumps = (_jump(strobe, curves, point, up) for _, point, up in ends)
    return Branches(tuple(curves), tuple(jumps))


def _refuse_not_following(module: GeneratedModule, inputs: Driven, low: float, high: float) -> None:
    """Raise `UsageError` if inputs do not repeat with each frequency from `low` to `high` [Hz]."""
    if not callable(inputs):
        raise UsageError(f"{quote(inputs)} is no function", "steady_branches.inputs", DRIVEN)
    for f in np.geomspace(low, high, FREQUENCIES).tolist():
        refuse_unperiodic(module, inputs(f), f, FOLLOW)


def _curves(strobe: Stroboscope, span: FloatArray) -> Iterator[Curve]:
    """Yield curves from the zeros at both ends of the range of frequencies, each once."""
    reached: list[FloatArray] = []
    for log_f, way in ((span[0, 0], 1.0), (span[0, 1], -1.0)):
        end = strobe.at(float(np.exp(log_f)))
        temperatures = grid(*np.exp(span[1]).tolist())
        known = [state for state in scan(end, temperatures, end.start) if state]
        for zero in zeros(end, known):
            place = np.array([log_f, np.log(zero.temperature)])
            if any(np.max(np.abs(place - other)) < SAME for other in reached):
                continue
            curve = tuple(trace(end, place, zero, way, span))
            if not curve:
                continue
            reached += [curve[0].place, curve[-1].place]
            yield curve


def _jump(strobe: Stroboscope, curves: Sequence[Curve], fold: CurvePoint, upward: bool) -> Jump:
    """Return the jump at a fold, in the direction of the drift just past it."""
    beyond = fold.frequency * (1.01 if upward else 0.99)
    heats = settled(strobe.at(beyond), fold.state.temperature, fold.state.x).drift > 0
    crossings = _crossings(curves, float(np.log(beyond)))
    reached = sorted((p for p in crossings if (p[0] > fold.place[1]) == heats), reverse=not heats)
    lands = reached[0][1] if reached else np.nan
    return Jump(fold.frequency, upward, fold.state.period.mean, float(lands))


def _crossings(curves: Sequence[Curve], log_f: float) -> Iterator[tuple[float, float]]:
    """Yield log T at t = 0 and the mean temperature [K] of the stable states at a frequency."""
    for curve in curves:
        for a, b in pairwise(curve):
            if a.stable and b.stable and (a.place[0] - log_f) * (b.place[0] - log_f) <= 0:
                part = (log_f - a.place[0]) / (b.place[0] - a.place[0])
                log_T = a.place[1] + part * (b.place[1] - a.place[1])
                means = np.log([a.state.period.mean, b.state.period.mean])
                yield float(log_T), float(np.exp(means[0] + part * (means[1] - means[0])))
