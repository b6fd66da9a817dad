"""The heat balance of a period over the body's temperature, and its zeros.

Input: a `Stroboscope`, the body's temperatures T at t = 0.  Output: settled states (`newton`), each
with the drift of the body's entropy S in a period, and those whose drift is 0:

    drift(T; f) = P_S(x_fast, S; f) - S

At a zero, heat and cooling of a period balance: it is a periodic steady state.  This needs no
separation of time scales.  Where the drift is the slowest motion, its sign says which way the
temperature goes between zeros, and its slope at a zero whether that state is stable.
"""

import warnings
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from piezo_sym.analysis.newton import Settled, settled
from piezo_sym.analysis.stroboscope import Stroboscope
from piezo_sym.errors import RunError
from piezo_sym.run.checks import FloatArray, span_of

HOTTEST = 20.0  # times the temperature at the start: upper end of the range if none is given
FIRST_RISE = 1e-4  # of the coldest temperature: the first step of a scan
POINTS = 40
MOST_ITERATIONS = 60
ZERO = 1e-10  # relative width of a bracket that counts as a zero


class SteadyWarning(UserWarning):
    """Part of a search for steady states could not be done, and where."""


def scan(
    strobe: Stroboscope, temperatures: Sequence[float], near: FloatArray
) -> Iterator[Settled | None]:
    """Yield the settled state at each temperature, each found from the one before, or None."""
    slope: FloatArray | None = None
    for T in temperatures:
        try:
            found = settled(strobe, T, near, slope)
        except RunError:
            slope = None
            yield None
        else:
            near, slope = found.x, found.slope
            yield found


def temperature_range(
    strobe: Stroboscope, given: tuple[float, float] | None
) -> tuple[float, float]:
    """Return the range to search [K]: what a user gave, or from the start on."""
    if given is None:
        T = strobe.temperature(strobe.start)
        own = strobe.temperature(replace(strobe, initial={}).start)
        return min(T, own), HOTTEST * own
    return span_of(given, "periodic_steady_state.temperatures", "K")


def grid(low: float, high: float, points: int = POINTS) -> list[float]:
    """Return temperatures from `low` to `high`; their rises over `low` are a geometric series."""
    most = high / low - 1
    return [low, *(low * (1 + np.geomspace(min(FIRST_RISE, most / 2), most, points))).tolist()]


def between(a: Settled, b: Settled) -> str:
    """Return the temperatures from one state to another in words."""
    low, high = sorted([a.temperature, b.temperature])
    if low == high:
        return f"at {low:.6g} K, where the range ends,"
    return f"at every temperature between {low:.6g} K and {high:.6g} K"


def zeros(strobe: Stroboscope, known: Sequence[Settled]) -> list[Settled]:
    """Return the zeros of the drift between settled states in order of temperature.

    Where |drift| has a minimum without a change of sign, states at the vertex of a parabola
    through three of them are added, so that two zeros close together are found.
    """
    for a, b in pairwise(known):
        if a.drift == b.drift == 0:
            what = f"any temperature from {a.temperature:.6g} K to {b.temperature:.6g} K is steady"
            remedy = "let an ambient cool the body, or drive it so that it heats"
            raise RunError(what, strobe.where, remedy=remedy)
    points = list(known)
    for a, b, c in zip(known, known[1:], known[2:], strict=False):
        least = abs(b.drift) < min(abs(a.drift), abs(c.drift))
        if least and a.drift * b.drift > 0 < b.drift * c.drift:
            points += _turning(strobe, a, b, c)
    points.sort(key=lambda point: point.temperature)
    changes = [(a, b) for a, b in pairwise(points) if a.drift * b.drift < 0]
    found = [point for point in points if point.drift == 0]
    found += filter(None, (_zero(strobe, a, b) for a, b in changes))
    return sorted(found, key=lambda point: point.temperature)


def _turning(strobe: Stroboscope, a: Settled, b: Settled, c: Settled) -> list[Settled]:
    """Return states around the least |drift| between a and c, until its sign changes."""
    found: list[Settled] = []
    for _ in range(6):
        t = np.log([a.temperature, b.temperature, c.temperature]) - np.log(b.temperature)
        curve = np.polyfit(t, [a.drift, b.drift, c.drift], 2)
        top = float(np.clip(-curve[1] / (2 * curve[0]), t[0] * 0.9, t[2] * 0.9))
        if abs(top) < 1e-6:
            break
        T = b.temperature * float(np.exp(top))
        try:
            new = settled(strobe, T, b.x, b.slope)
        except RunError:  # the settled state jumps here: keep what is found
            break
        found.append(new)
        if new.drift * b.drift <= 0:
            break
        inner, outer = (new, b) if abs(new.drift) < abs(b.drift) else (b, new)
        above = outer.temperature > inner.temperature
        a, b, c = (a, inner, outer) if above else (outer, inner, c)
    return found


def _zero(strobe: Stroboscope, a: Settled, b: Settled) -> Settled | None:
    """Return the zero of the drift between two states, by false position (Illinois).

    None, with a warning, if nothing settles on the way: the settled state jumps there, and with it
    the drift.
    """
    weight_a, weight_b = a.drift, b.drift
    for _ in range(MOST_ITERATIONS):
        x, y = np.log(a.temperature), np.log(b.temperature)
        T = float(np.exp((x * weight_b - y * weight_a) / (weight_b - weight_a)))
        near = a if abs(a.drift) < abs(b.drift) else b
        try:
            new = settled(strobe, T, near.x, near.slope)
        except RunError as error:
            warnings.warn(f"{error}; a steady state there may be missed", SteadyWarning, 2)
            return None
        a, weight_a = (b, weight_b) if new.drift * b.drift < 0 else (a, weight_a / 2)
        close = abs(new.temperature - b.temperature) < ZERO * T
        b, weight_b = new, new.drift
        if close or new.drift == 0:
            return new
    return b
