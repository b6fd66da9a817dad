"""The tolerance at which a solver just reaches a target error, so that speeds are compared fairly.

Input: a solver as a function of its tolerance.  Output: `Tuned`: the loosest tolerance on a ladder
that reaches the target together with the tighter ones, so that no lucky hit counts.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from time import perf_counter
from typing import TYPE_CHECKING, final

from piezo_sym import PiezoError

if TYPE_CHECKING:
    from piezo_sym.run.checks import FloatArray

#: Tolerances, loosest first, and the parts of each that are tried above the first good one: six to
#: a decade, those of the series of preferred numbers E6.
LADDER = tuple(float(f"1e-{n}") for n in range(2, 14))
PARTS = (0.15, 0.22, 0.33, 0.47, 0.68)


@final
@dataclass(frozen=True)
class Tuned:
    """A tolerance that reaches the target, and the error it has there."""

    tolerance: float
    error: float


@final
@dataclass
class _Search:
    """Tolerances tried so far: what they cost, and the best error."""

    solve: Callable[[float], FloatArray]
    error: Callable[[FloatArray], float]
    target: float
    clock: Callable[[], float]
    spent: float = 0.0
    best: float = float("inf")

    def tried(self, tolerance: float) -> Tuned | None:
        """Return a tolerance that reaches the target, or nothing; a solver that fails is off."""
        start, found = self.clock(), float("inf")
        with suppress(ArithmeticError, RuntimeError, ValueError, PiezoError):
            found = self.error(self.solve(tolerance))
        self.spent += self.clock() - start
        self.best = min(self.best, found)
        return Tuned(tolerance, found) if found <= self.target else None


def tuned(
    solve: Callable[[float], FloatArray],
    error: Callable[[FloatArray], float],
    target: float,
    patience: float,
    clock: Callable[[], float] = perf_counter,
) -> Tuned | str:
    """Return the tolerance to use, or why there is none.

    Decades first, then parts of the last one that was too loose: the result is the
    loosest of them below which everything tried is good.

    Parameters
    ----------
    solve, error : tolerance -> state at the end -> its error; a solver that fails counts as off.
    patience : seconds; no further decade is tried once they are spent.
    clock : the time [s].
    """
    search = _Search(solve, error, target, clock)
    good: Tuned | None = None
    loose: float | None = None
    for tolerance in LADDER:
        found = search.tried(tolerance)
        if found and good:
            break
        good, loose = found, (loose if found else tolerance)
        if search.spent > patience:
            break
    if good is None:
        if not search.best < float("inf"):
            return "fails, or gives no number, at every tolerance tried"
        return f"reaches an error of {search.best:.1e} at best, not {target:.0e}"
    for part in PARTS if loose else ():
        finer = search.tried(part * (loose or 0.0))
        if finer is None:
            break
        good = finer
    return good
