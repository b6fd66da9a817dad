"""Newton's method on a period: the settled state at a temperature, and the fixed point.

Input: a `Stroboscope`, a state x (n,) nearby.  Output: `Settled`, the state in which everything but
the body's entropy S repeats (`settled`), or the state in which all repeats (`fixed_point`):

    P_fast(x_fast, S; f) = x_fast        P(x; f) = x

What every motion conserves, such as the difference in length of parallel springs, stays as it is;
so does a motion that neither grows nor decays, such as a current that circulates in a dead zone.
"""

from dataclasses import dataclass
from typing import TypeAlias, final

import numpy as np

from piezo_sym.analysis.stroboscope import FLOOR, Period, Stroboscope
from piezo_sym.errors import RunError
from piezo_sym.run.checks import FloatArray

Rows: TypeAlias = np.ndarray[tuple[int], np.dtype[np.bool_]]

DIFFERENCE = 1e-4  # of a state's size, for difference quotients
TOLERANCE = 1e-8  # of a state's size: a state that differs by less repeats
MOST_PERIODS = 40
RENEWED = (5, 11, 17, 23, 29, 35)  # iterations at which the Jacobian is computed again
MOST_GROWTH = 2.0  # of the error in one iteration
LONGEST = 2.0  # step of an iteration, in sizes of the states
NEUTRAL = 1e-7  # smaller singular values belong to motions that neither grow nor decay
MOST_ITERATIONS = 12


@final
@dataclass(frozen=True, eq=False)
class Settled:
    """A state x (n,) in which everything but the body's entropy repeats after a period."""

    temperature: float  # of the body at t = 0 [K]
    x: FloatArray
    drift: float  # of the entropy in a period [J/K]
    period: Period
    slope: FloatArray  # d(P_fast - x_fast)/dx_fast, in units of sizes


@final
@dataclass(frozen=True, eq=False)
class Iterate:
    """A period from a state x (n,), and by how much its fast states fail to repeat, in sizes."""

    x: FloatArray
    period: Period
    off: FloatArray

    @property
    def error(self) -> float:
        """The largest of these."""
        return float(np.max(np.abs(self.off), initial=0.0))


def settled(
    strobe: Stroboscope, T: float, near: FloatArray, slope: FloatArray | None = None
) -> Settled:
    """Return the settled state at the temperature T, by Newton's method with Broyden's updates.

    It starts from the state `near` (n,), whose entropy does not count, and the slope of a settled
    state nearby, if there is one.
    """
    x = strobe.at_temperature(near, T)
    fast = np.arange(x.size) != strobe.entropy_row(x)
    best: Iterate | None = None
    for n in range(MOST_PERIODS):
        now = _iterate(strobe, x, fast)
        if now and now.error < TOLERANCE:
            drift = float((now.period.end - x)[~fast][0])
            if slope is None:
                slope = _fast_slope(strobe, now, fast)
            return Settled(T, x, drift, now.period, slope)
        good = now is not None and (best is None or now.error < MOST_GROWTH * best.error)
        if now and good:
            if best and slope is not None:
                slope = _updated(slope, now, best, fast)
            best = now
        elif best is None:
            break
        else:  # the step failed: go back, and compute the Jacobian there
            slope = None
        if slope is None or n in RENEWED:
            slope = _fast_slope(strobe, best, fast)
        x = _step(strobe, best, slope, fast)
    what = f"nothing settles at {T:.6g} K and {strobe.frequency:g} Hz within {MOST_PERIODS} periods"
    raise RunError(what, strobe.where, remedy="give more steps a period")


def _iterate(strobe: Stroboscope, x: FloatArray, fast: Rows) -> Iterate | None:
    """Return a period from the state x (n,), or None if it leaves the domain."""
    try:
        period = strobe.look(x)
    except RunError:
        return None
    return Iterate(x, period, (period.end - x)[fast] / period.size[fast])


def _updated(slope: FloatArray, now: Iterate, before: Iterate, fast: Rows) -> FloatArray:
    """Return the slope with Broyden's update for the last step."""
    move = (now.x - before.x)[fast] / now.period.size[fast]
    wrong = np.outer(now.off - before.off - slope @ move, move)
    changed: FloatArray = slope + wrong / square if (square := float(move @ move)) else slope
    return changed


def _step(strobe: Stroboscope, at: Iterate, slope: FloatArray, fast: Rows) -> FloatArray:
    """Return the state (n,) after a step of Newton's method, no longer than `LONGEST`."""
    size, kept = at.period.size[fast], strobe.conserved
    fast_only = ~kept[:, ~fast].any(axis=1)
    move = -_solved(slope, at.off, kept[fast_only][:, fast] * size)
    x = at.x.copy()
    x[fast] += move * min(1.0, LONGEST / np.max(np.abs(move), initial=FLOOR)) * size
    return x


def _fast_slope(strobe: Stroboscope, at: Iterate, fast: Rows) -> FloatArray:
    """Return d(P_fast - x_fast)/dx_fast in units of sizes, by one-sided differences."""
    size = at.period.size[fast]
    steps = np.diag(DIFFERENCE * at.period.size)[fast]
    ends = [strobe.look(at.x + step).end - at.period.end for step in steps]
    columns = [end[fast] / size / DIFFERENCE for end in ends]
    return np.array(columns).T.reshape(size.size, size.size) - np.eye(size.size)


def jacobian(strobe: Stroboscope, x: FloatArray) -> FloatArray:
    """Return dP/dx (n, n) in units of the states' sizes, by central differences."""
    size = strobe.look(x).size
    steps = np.diag(DIFFERENCE * size)
    ends = [strobe.look(x + step).end - strobe.look(x - step).end for step in steps]
    return np.array([end / size / (2 * DIFFERENCE) for end in ends]).T


def _solved(matrix: FloatArray, right: FloatArray, conserved: FloatArray) -> FloatArray:
    """Return the smallest y with matrix y = right and conserved y = 0.

    Other neutral motions have no part in it.
    """
    if not right.size:
        return right
    whole = np.vstack([matrix, unit_rows(conserved)])
    right = np.append(right, np.zeros(len(conserved)))
    return np.asarray(np.linalg.lstsq(whole, right, rcond=NEUTRAL)[0], dtype=float)


def unit_rows(rows: FloatArray) -> FloatArray:
    """Return orthogonal rows (k, n) of length 1 that span the same."""
    return np.linalg.qr((rows / np.linalg.norm(rows, axis=1, keepdims=True)).T)[0].T


def fixed_point(strobe: Stroboscope, x: FloatArray, slope: FloatArray) -> FloatArray:
    """Return the fixed point (n,) near x, by Newton's method with the Jacobian `slope` throughout.

    It ends where the steps no longer get smaller: at round-off.
    """
    matrix = slope - np.eye(x.size)
    error = np.inf
    for _ in range(MOST_ITERATIONS):
        period = strobe.look(x)
        move = _solved(matrix, (period.end - x) / period.size, strobe.conserved * period.size)
        if np.max(np.abs(move)) >= error:
            break
        error = float(np.max(np.abs(move)))
        x = x - move * period.size
    return x
