"""Settled states at a given temperature of the body, their drift, and its zeros.

Input: a `Stroboscope`, temperatures T of the body at t = 0.  Output: `Settled` states, by Newton's
method, in which every state but the body's entropy S repeats after a period; the change of S, their
drift; and the states in which the drift is 0:

    P_fast(x_fast, S; f) = x_fast        drift(T; f) = P_S(x_fast, S; f) - S

At a zero, heat and cooling of a period balance: it is a periodic steady state.  This needs no
separation of time scales.  Where the drift is the slowest motion, its sign is the direction of the
temperature between zeros, and its slope at a zero says whether that state is stable.

What is conserved keeps its value: linear functions of the state, such as the difference in length
of parallel springs, and what a period near the state conserves, such as a current that circulates
in a dead zone, or the slip of a stop that sticks.  Messages say which state does not settle.
"""

import warnings
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any, final

import numpy as np

from piezo_sym.analysis.conserved import FLOOR
from piezo_sym.analysis.stroboscope import Period, Rows, Stroboscope
from piezo_sym.errors import RunError
from piezo_sym.run.checks import FloatArray, positive_range
from piezo_sym.run.module import row_name
from piezo_sym.run.parameters import set_temperature

DIFFERENCE = 1e-4  # step of difference quotients, over the size of the state
TOLERANCE = 1e-8  # change of a state that repeats, over its size
MOST_PERIODS = 20
MOST_GROWTH = 2.0  # of the error in one iteration
SHORTER = 0.25  # the next step, over one that failed
LONGEST = 2.0  # step of an iteration, in sizes of the states
NEUTRAL = 1e-7  # singular values below belong to motions that neither grow nor decay
SHARE = 1e-3  # least part of a conserved unit row that is not in the span of the others
MOST_ITERATIONS = 12
HOTTEST = 20.0  # upper end of the range, over the temperature at the start, if none is given
FIRST_RISE = 1e-4  # the first step of a scan, over its coldest temperature
POINTS = 40
TURNING = 12  # the most states in the search for a least drift
ZERO = 1e-10  # width of a bracket of a zero, in log T
PERIODS = 100  # from the start, after which a state that still changes is said to drift


@final
@dataclass(frozen=True, eq=False)
class Settled:
    """A state x (n,) in which all but the body's entropy repeats after a period."""

    temperature: float  # of the body at t = 0 [K]
    x: FloatArray
    drift: float  # change of the body's entropy in a period [J/K]
    period: Period


def settled(strobe: Stroboscope, T: float, near: FloatArray) -> Settled:
    """Return the settled state at the temperature T, by Newton's method from x = `near` (n,)."""
    best = x = near.copy()
    slow = set_temperature(strobe.module, strobe.values, x, 0, T, strobe.where)
    fast = strobe.repeating & (np.arange(x.size) != slow)
    least, move = np.inf, np.zeros(x.size)
    for _ in range(MOST_PERIODS):
        try:
            period = strobe.look(x)
            off = (period.end - x) / period.size
            error = float(np.max(np.abs(off[fast]), initial=0.0))
            if error < TOLERANCE:
                return Settled(T, x, float((period.end - x)[slow]), period)
            if error < MOST_GROWTH * least:
                move = _move(strobe, x, off, period.size, fast)
                best, least = x, error
            else:
                move = SHORTER * move
        except RunError:  # the step leaves the domain
            if np.isinf(least):
                break
            move = SHORTER * move
        x = best + move
    what = f"nothing settles at {T:.6g} K and {strobe.frequency:g} Hz within {MOST_PERIODS} periods"
    raise RunError(what, strobe.where, remedy="give more steps a period")


def _move(
    strobe: Stroboscope, x: FloatArray, off: FloatArray, size: FloatArray, rows: Rows
) -> FloatArray:
    """Return Newton's step (n,) in these rows of the state, at most `LONGEST` sizes."""
    kept = strobe.conserved
    kept = kept[~kept[:, ~rows].any(axis=1)] * size
    slope = jacobian(strobe, x, size, rows)[rows] - np.eye(int(rows.sum()))
    move = np.zeros(x.size)
    move[rows] = -_solved(slope, off[rows], kept[:, rows])
    return np.asarray(move * min(1.0, LONGEST / np.max(np.abs(move), initial=FLOOR)) * size)


def jacobian(
    strobe: Stroboscope, x: FloatArray, size: FloatArray, rows: Rows | None = None
) -> FloatArray:
    """Return dP/dx (n, n), or its columns `rows`, in units of the states' sizes.

    By central differences.
    """
    steps = np.diag(DIFFERENCE * size)[slice(None) if rows is None else rows]
    ends = strobe.ends(np.concatenate([x + steps, x - steps]))
    ahead, behind = np.split(ends, 2)
    return np.asarray((ahead - behind).T / size[:, None] / (2 * DIFFERENCE))


def _solved(matrix: FloatArray, right: FloatArray, conserved: FloatArray) -> FloatArray:
    """Return the y (n,) with matrix y = right, dP/dx - 1 of rows, and conserved y = 0.

    A row w with w (dP/dx - 1) = 0 is a function that is conserved near the state, such as the
    difference of the coordinates of a spring and of a stop that does not slip: w y = 0, too.
    """
    if not right.size:
        return right
    left, values, _ = np.linalg.svd(matrix)
    kept, neutral = unit_rows(conserved), left[:, values <= NEUTRAL * values[0]].T
    _, sizes, others = np.linalg.svd(neutral - neutral @ kept.T @ kept, full_matrices=False)
    kept = np.vstack([kept, others[sizes > SHARE]])
    matrix = np.vstack([matrix, kept])
    right = np.append(right, np.zeros(len(kept)))
    return np.asarray(np.linalg.lstsq(matrix, right, rcond=NEUTRAL)[0], dtype=float)


def unit_rows(rows: FloatArray) -> FloatArray:
    """Return orthonormal rows (k, n) with the same span."""
    return np.linalg.qr((rows / np.linalg.norm(rows, axis=1, keepdims=True)).T)[0].T


def fixed_point(strobe: Stroboscope, x: FloatArray, slope: FloatArray) -> FloatArray:
    """Return the fixed point (n,) near x, to round-off, by Newton's method with one Jacobian."""
    rows, move = strobe.repeating, np.zeros(x.size)
    matrix = (slope - np.eye(x.size))[np.ix_(rows, rows)]
    error = np.inf
    for _ in range(MOST_ITERATIONS):
        period = strobe.look(x)
        off, kept = (period.end - x) / period.size, strobe.conserved * period.size
        move[rows] = _solved(matrix, off[rows], kept[:, rows])
        if np.max(np.abs(move)) >= error:
            break
        error = float(np.max(np.abs(move)))
        x = x - move * period.size
    return x


class SteadyWarning(UserWarning):
    """A part of a search for steady states that failed, and where."""


def scan(
    strobe: Stroboscope, temperatures: Sequence[float], near: FloatArray
) -> Iterator[Settled | None]:
    """Yield the settled state at each temperature, found from the one before, or None."""
    for T in temperatures:
        try:
            state = settled(strobe, T, near)
        except RunError:
            yield None
        else:
            near = state.x
            yield state


def temperature_range(
    strobe: Stroboscope, given: tuple[float, float] | None
) -> tuple[float, float]:
    """Return the range to search [K]: the user's, or up to `HOTTEST` times the default start."""
    if given is None:
        T = strobe.temperature(strobe.start)
        default = strobe.temperature(replace(strobe, initial={}).start)
        return min(T, default), HOTTEST * default
    return positive_range(given, "periodic_steady_state.temperatures", "K")


def grid(low: float, high: float, points: int = POINTS) -> list[float]:
    """Return temperatures from `low` to `high`; the rises over `low` are a geometric series."""
    most = high / low - 1
    return [low, *(low * (1 + np.geomspace(min(FIRST_RISE, most / 2), most, points))).tolist()]


def between(a: Settled, b: Settled) -> str:
    """Return the range of temperatures between two states, for a message."""
    low, high = sorted([a.temperature, b.temperature])
    if low == high:
        return f"at {low:.6g} K, where the range ends,"
    return f"at every temperature between {low:.6g} K and {high:.6g} K"


def zeros(strobe: Stroboscope, known: Sequence[Settled]) -> list[Settled]:
    """Return the zeros of the drift between settled states in order of temperature.

    Where |drift| has a minimum without a change of sign, it is minimized, to find two zeros close
    together. Where the settled state jumps on the way to a zero, there is a warning.
    """
    from scipy.optimize import brentq, minimize_scalar  # loads slowly, and runs need none

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
            how: Any = {"bounds": (low, high), "method": "bounded"}
            how |= {"options": {"xatol": 1e-6, "maxiter": TURNING}}
            with suppress(RunError):  # the settled state jumps there
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


def unsettled(strobe: Stroboscope) -> str:
    """Return which state changes most in a period, over its size, after `PERIODS` periods."""
    x = change = size = strobe.start
    for count in range(PERIODS):
        try:
            period = strobe.look(x)
        except RunError as error:
            return f"in period {count + 1} from the start, {error.what}"
        change, size, x = period.end - x, period.size, period.end
    row = int(np.argmax(np.abs(change) / size))
    return f"after {PERIODS} periods from the start, {_drift(strobe, row, change)}"


def warn_of_drift(strobe: Stroboscope, x: FloatArray) -> None:
    """Warn of each state that moves nothing and does not repeat, from the state x (n,)."""
    period = strobe.look(x)
    change = period.end - x
    for row in np.flatnonzero(~strobe.repeating & (np.abs(change) > TOLERANCE * period.size)):
        text = f"{_drift(strobe, int(row), change)}; no rate depends on it here, and all other"
        text = f"{text} states repeat: a run goes on so until a law depends on it"
        warnings.warn(text, SteadyWarning, stacklevel=4)


def _drift(strobe: Stroboscope, row: int, change: FloatArray) -> str:
    """Return how far a state drifts in a period, `change` being that of the states (n,)."""
    name = row_name(strobe.module.STATES, strobe.values, row)
    units = {record.name: record.unit for record in strobe.module.STATES}
    return f"'{name}' drifts by {change[row]:.6g} {units[name.partition('[')[0]]} a period"
