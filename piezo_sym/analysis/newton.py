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
MOST_PERIODS = 20
MOST_GROWTH = 2.0  # of the error in one iteration
SHORTER = 0.25  # the step after one that failed
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


def settled(strobe: Stroboscope, T: float, near: FloatArray) -> Settled:
    """Return the settled state at the temperature T, by Newton's method.

    It starts from the state `near` (n,), whose entropy does not count.
    """
    best = x = strobe.at_temperature(near, T)
    fast = np.arange(x.size) != strobe.entropy_row(x)
    least, move = np.inf, np.zeros(x.size)
    for _ in range(MOST_PERIODS):
        try:
            period = strobe.look(x)
            off = (period.end - x) / period.size
            error = float(np.max(np.abs(off[fast]), initial=0.0))
            if error < TOLERANCE:
                return Settled(T, x, float((period.end - x)[~fast][0]), period)
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
    """Return a step (n,) of Newton's method in some rows of the state, no longer than `LONGEST`."""
    kept = strobe.conserved
    kept = kept[~kept[:, ~rows].any(axis=1)] * size
    slope = jacobian(strobe, x, size, rows)[rows] - np.eye(int(rows.sum()))
    move = np.zeros(x.size)
    move[rows] = -_solved(slope, off[rows], kept[:, rows])
    return np.asarray(move * min(1.0, LONGEST / np.max(np.abs(move), initial=FLOOR)) * size)


def jacobian(
    strobe: Stroboscope, x: FloatArray, size: FloatArray, rows: Rows | None = None
) -> FloatArray:
    """Return dP/dx (n, n) in units of the states' sizes, by central differences.

    With `rows`, only the columns of these.
    """
    steps = np.diag(DIFFERENCE * size)[slice(None) if rows is None else rows]
    ends = strobe.ends(np.concatenate([x + steps, x - steps]))
    ahead, behind = np.split(ends, 2)
    return np.asarray((ahead - behind).T / size[:, None] / (2 * DIFFERENCE))


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
