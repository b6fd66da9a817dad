"""The heat balance of a period: what drifts when all else has settled, and where it does not.

Input: a `Stroboscope`, a frequency, the body's temperature T at t = 0.  Output: `Settled`, the
state in which everything but the body's entropy S repeats, and how far S then drifts in the period,

    P_fast(x_fast, S; f) = x_fast        drift(T; f) = P_S(x_fast, S; f) - S

A periodic steady state is a zero of the drift: heat and cooling of a period balance.  No time
scale is taken to be short for that, but where the drift is the slowest motion, its sign says which
way the temperature goes between zeros, and its slope at a zero whether that state is stable.

The settled state is found by Newton's method on the fast rows, with Broyden's updates; a motion
without damping (a current that circulates in a dead zone) is left as it is.
"""

import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TypeAlias, final

import numpy as np

from piezo_sym.analysis.stroboscope import FLOOR, Period, Stroboscope
from piezo_sym.errors import RunError
from piezo_sym.run.checks import FloatArray, span_of

Rows: TypeAlias = np.ndarray[tuple[int], np.dtype[np.bool_]]

HOTTEST = 20.0  # times the temperature at the start: how far is looked, if nothing is said
NUDGE = 1e-4  # of a state's size: the difference that a derivative is taken over
TOLERANCE = 1e-8  # of a state's size: what repeats
MOST_LOOKS = 40
FRESH = (5, 11, 17, 23, 29, 35)  # looks after which the derivative is taken anew, if need be
WORSE = 2.0  # a step may make the error so much larger
LONGEST = 2.0  # sizes that a step may go
NEUTRAL = 1e-7  # singular values below this belong to motions that neither grow nor decay
FIRST_RISE = 1e-4  # of the coldest temperature: the first step of a scan
POINTS = 40
MOST_HALVINGS = 60
ZERO = 1e-10  # relative width of a bracket that counts as a zero


class SteadyWarning(UserWarning):
    """Part of a search for steady states could not be done, and where."""


@final
@dataclass(frozen=True, eq=False)
class Settled:
    """A state x (n,) whose rows but the body's entropy repeat after a period."""

    temperature: float  # of the body at t = 0 [K]
    x: FloatArray
    drift: float  # of the entropy in a period [J/K]
    period: Period
    slope: FloatArray  # of the fast rows: d P_fast/d x_fast - 1, in units of sizes


@final
@dataclass(frozen=True, eq=False)
class Try:
    """A period from a state x (n,), and by how much its fast rows fail to repeat, in sizes."""

    x: FloatArray
    period: Period
    off: FloatArray
    error: float


def settled(
    strobe: Stroboscope, frequency: float, T: float, near: FloatArray, slope: FloatArray | None
) -> Settled:
    """Return the settled state at the temperature T.

    Parameters
    ----------
    near : a state (n,) to start from; its entropy does not count.
    slope : that of a settled state nearby, if there is one.

    Raises
    ------
    RunError : the run leaves the domain, or nothing settles.
    """
    x = strobe.at_temperature(near, T)
    fast = np.arange(x.size) != strobe.entropy_row(x)
    best: Try | None = None
    for n in range(MOST_LOOKS):
        now = _tried(strobe, frequency, x, fast)
        if now and now.error < TOLERANCE:
            drift = float((now.period.end - x)[~fast][0])
            if slope is None:
                slope = derivative(strobe, frequency, now, fast)
            return Settled(T, x, drift, now.period, slope)
        if best and slope is not None and now and now.error < WORSE * best.error:
            slope = updated(slope, now, best, fast)
        if now and (best is None or now.error < WORSE * best.error):
            best = now
        elif best is None:
            break
        else:  # a step into the blue: back, with the derivative as it is there
            slope = None
        if slope is None or n in FRESH:
            slope = derivative(strobe, frequency, best, fast)
        x = stepped(best, slope, fast)
    what = f"nothing settles at {T:.6g} K and {frequency:g} Hz within {MOST_LOOKS} periods"
    raise RunError(what, f"model '{strobe.module.NAME}'", remedy="give more steps a period")


def _tried(strobe: Stroboscope, frequency: float, x: FloatArray, fast: Rows) -> Try | None:
    """Return a period from the state x (n,), or None if it leaves the domain."""
    try:
        period = strobe.look(x, frequency)
    except RunError:
        return None
    off = (period.end - x)[fast] / period.size[fast]
    return Try(x, period, off, float(np.max(np.abs(off), initial=0.0)))


def updated(slope: FloatArray, now: Try, before: Try, fast: Rows) -> FloatArray:
    """Return the slope with Broyden's update for the last step."""
    move = (now.x - before.x)[fast] / now.period.size[fast]
    square = float(move @ move)
    if square == 0:
        return slope
    changed: FloatArray = slope + np.outer(now.off - before.off - slope @ move, move) / square
    return changed


def stepped(at: Try, slope: FloatArray, fast: Rows) -> FloatArray:
    """Return the state (n,) after a step of Newton's method, no longer than two sizes."""
    move = -solved(slope, at.off)
    x = at.x.copy()
    x[fast] += move * min(1.0, LONGEST / np.max(np.abs(move), initial=FLOOR)) * at.period.size[fast]
    return x


def derivative(strobe: Stroboscope, frequency: float, at: Try, part: Rows) -> FloatArray:
    """Return d(P - x)/dx over the rows in `part`, in units of their sizes."""
    size = at.period.size[part]
    columns = []
    for row in np.flatnonzero(part):
        moved = at.x.copy()
        moved[row] += NUDGE * at.period.size[row]
        ends = strobe.look(moved, frequency).end
        columns.append((ends - at.period.end)[part] / size / NUDGE)
    return np.array(columns).T.reshape(size.size, size.size) - np.eye(size.size)


def solved(matrix: FloatArray, right: FloatArray) -> FloatArray:
    """Return the smallest y with matrix y = right, neutral motions left out."""
    if not right.size:
        return right
    return np.asarray(np.linalg.lstsq(matrix, right, rcond=NEUTRAL)[0], dtype=float)


def scan(
    strobe: Stroboscope, frequency: float, temperatures: Sequence[float], near: FloatArray
) -> Iterator[Settled | None]:
    """Yield the settled state at each temperature, each from the one before; None for none."""
    slope: FloatArray | None = None
    for T in temperatures:
        try:
            found = settled(strobe, frequency, T, near, slope)
        except RunError:
            slope = None
            yield None
        else:
            near, slope = found.x, found.slope
            yield found


def temperature_range(
    strobe: Stroboscope, frequency: float, given: tuple[float, float] | None
) -> tuple[float, float]:
    """Return where to look for steady states: what a user gave, or from the start on."""
    if given is None:
        T = strobe.temperature(strobe.start(frequency))
        own = strobe.temperature(replace(strobe, initial={}).start(frequency))
        return min(T, own), HOTTEST * own
    return span_of(given, "periodic_steady_state.temperatures", "K")


def grid(low: float, high: float, points: int = POINTS) -> list[float]:
    """Return temperatures from `low` to `high`, the rises over `low` in geometric progression."""
    most = high / low - 1
    return [low, *(low * (1 + np.geomspace(min(FIRST_RISE, most / 2), most, points))).tolist()]


def between(a: Settled, b: Settled) -> str:
    """Return the temperatures from one state to another in words."""
    low, high = sorted([a.temperature, b.temperature])
    if low == high:
        return f"at {low:.6g} K, where the range ends,"
    return f"at every temperature between {low:.6g} K and {high:.6g} K"


def zeros(strobe: Stroboscope, frequency: float, known: Sequence[Settled]) -> list[Settled]:
    """Return the zeros of the drift between settled states in order of temperature.

    Where the drift comes near to zero without crossing it between three of them, the top of a
    parabola through them is looked at too, so that two zeros close together are found.

    Raises
    ------
    RunError : every temperature is steady, for nothing heats or cools the body.
    """
    for a, b in pairwise(known):
        if a.drift == b.drift == 0:
            what = f"any temperature from {a.temperature:.6g} K to {b.temperature:.6g} K is steady"
            remedy = "let an ambient cool the body, or drive it so that it heats"
            raise RunError(what, f"model '{strobe.module.NAME}'", remedy=remedy)
    points = list(known)
    for a, b, c in zip(known, known[1:], known[2:], strict=False):
        if a.drift * b.drift > 0 < b.drift * c.drift and abs(b.drift) < min(
            abs(a.drift), abs(c.drift)
        ):
            points += _turning(strobe, frequency, a, b, c)
    points.sort(key=lambda point: point.temperature)
    found = [point for point in points if point.drift == 0]
    for a, b in pairwise(points):
        if a.drift * b.drift < 0 and (zero := _zero(strobe, frequency, a, b)):
            found.append(zero)
    return sorted(found, key=lambda point: point.temperature)


def _turning(
    strobe: Stroboscope, frequency: float, a: Settled, b: Settled, c: Settled
) -> list[Settled]:
    """Return states around the least |drift| between a and c, until one crosses zero."""
    found: list[Settled] = []
    for _ in range(6):
        t = np.log([a.temperature, b.temperature, c.temperature]) - np.log(b.temperature)
        curve = np.polyfit(t, [a.drift, b.drift, c.drift], 2)
        top = float(np.clip(-curve[1] / (2 * curve[0]), t[0] * 0.9, t[2] * 0.9))
        if abs(top) < 1e-6:
            break
        T = b.temperature * float(np.exp(top))
        try:
            new = settled(strobe, frequency, T, b.x, b.slope)
        except RunError:  # the fast motion jumps here; what is known stands
            break
        found.append(new)
        if new.drift * b.drift <= 0:
            break
        inner, outer = (new, b) if abs(new.drift) < abs(b.drift) else (b, new)
        if outer.temperature > inner.temperature:
            b, c = inner, outer
        else:
            a, b = outer, inner
    return found


def _zero(strobe: Stroboscope, frequency: float, a: Settled, b: Settled) -> Settled | None:
    """Return the zero of the drift between two states, by false position (Illinois).

    None, with a warning, if nothing settles on the way: the fast motion jumps there, and the drift
    with it.
    """
    weight_a, weight_b = a.drift, b.drift
    for _ in range(MOST_HALVINGS):
        x, y = np.log(a.temperature), np.log(b.temperature)
        T = float(np.exp((x * weight_b - y * weight_a) / (weight_b - weight_a)))
        near = a if abs(a.drift) < abs(b.drift) else b
        try:
            new = settled(strobe, frequency, T, near.x, near.slope)
        except RunError as error:
            warnings.warn(f"{error}; a steady state there may be missed", SteadyWarning, 2)
            return None
        if new.drift * b.drift < 0:
            a, weight_a = b, weight_b
        else:
            weight_a /= 2
        close = abs(new.temperature - b.temperature) < ZERO * T
        b, weight_b = new, new.drift
        if close or new.drift == 0:
            return new
    return b
