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
from contextlib import suppress
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from piezo_sym.analysis.newton import Settled, settled
from piezo_sym.analysis.stroboscope import Stroboscope
from piezo_sym.errors import RunError
from piezo_sym.run.checks import FloatArray, span_of

HOTTEST = 20.0  # times the temperature at the start: upper end of the range if none is given
FIRST_RISE = 1e-4  # of the coldest temperature: the first step of a scan
POINTS = 40
TURNING = 12  # states looked at around a least drift
ZERO = 1e-10  # relative width of a bracket that counts as a zero


class SteadyWarning(UserWarning):
    """Part of a search for steady states could not be done, and where."""


def scan(
    strobe: Stroboscope, temperatures: Sequence[float], near: FloatArray
) -> Iterator[Settled | None]:
    """Yield the settled state at each temperature, each found from the one before, or None."""
    for T in temperatures:
        try:
            found = settled(strobe, T, near)
        except RunError:
            yield None
        else:
            near = found.x
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

    Where |drift| has a minimum without a change of sign, it is searched, so that two zeros close
    together are found.  Where nothing settles on the way to a zero, for the settled state jumps
    there, a warning says so.
    """
    for a, b in pairwise(known):
        if a.drift == b.drift == 0:
            what = f"any temperature from {a.temperature:.6g} K to {b.temperature:.6g} K is steady"
            remedy = "let an ambient cool the body, or drive it so that it heats"
            raise RunError(what, strobe.where, remedy=remedy)
    states = {np.log(state.temperature): state for state in known}

    def drift(log_T: float) -> float:
        nearest = min(states, key=lambda other: abs(other - log_T))
        if nearest != log_T:
            states[log_T] = settled(strobe, float(np.exp(log_T)), states[nearest].x)
        return states[log_T].drift

    for a, b, c in zip(known, known[1:], known[2:], strict=False):
        least = abs(b.drift) < min(abs(a.drift), abs(c.drift))
        if least and a.drift * b.drift > 0 < b.drift * c.drift:
            low, high = np.log([a.temperature, c.temperature])
            with suppress(RunError):  # the settled state jumps there: keep what is found
                how: Any = {"bounds": (low, high), "method": "bounded"}
                how |= {"options": {"xatol": 1e-6, "maxiter": TURNING}}
                minimize_scalar(lambda log_T: abs(drift(log_T)), **how)
    found = [state for state in states.values() if state.drift == 0]
    for (x, a), (y, b) in pairwise(sorted(states.items())):
        if a.drift * b.drift < 0:
            try:
                root = brentq(drift, x, y, xtol=ZERO)
            except RunError as error:
                text = f"{error}; a steady state there may be missed"
                warnings.warn(text, SteadyWarning, stacklevel=3)
            else:
                found.append(states[min(states, key=lambda other: abs(other - root))])
    return sorted(found, key=lambda state: state.temperature)
