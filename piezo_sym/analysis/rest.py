"""The search for a state of rest: long steps of the implicit Euler method, then Newton's method.

Input: a generated module, its parameters and constant inputs, the rows of the free states.  Output:
the state x (n,) at which their rates are zero, or a `RunError` that names a state that moves on.
"""

from dataclasses import dataclass
from typing import Any, final

import numpy as np

from piezo_sym.errors import RunError
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.module import GeneratedModule, held, row_name

MOST_STEPS, MOST_MOVES = 400, 40
LONGEST = 1e20  # the longest Euler step, over the first
GROWTH = 4.0  # of the Euler step
CONTRACTION = 0.25  # the largest second Newton move of an Euler step, over the first
AT_REST = 1e-9  # a move at rest, over the states' sizes
ROUND_OFF = 1e-13
COUNTS = 1e-6  # the least relative change of a body's temperature that counts as a motion
UNDETERMINED = 1e-6  # components of a unit vector below this are round-off
SINGULAR = 1e-10  # over the greatest singular value of the scaled Jacobian


@final
@dataclass(frozen=True)
class RestSearch:
    """A search for the rest of the states `free` of a module under constant inputs."""

    module: GeneratedModule
    parameters: Any
    u: FloatArray
    free: np.ndarray[Any, np.dtype[np.intp]]

    def rates(self, x: FloatArray) -> FloatArray:
        """Return dx/dt of the free rows."""
        with np.errstate(all="ignore"):
            return np.asarray(self.module.rhs(x, self.u, self.parameters)[self.free])

    def slope(self, x: FloatArray) -> FloatArray:
        """Return the Jacobian of the free rows by the free states."""
        with np.errstate(all="ignore"):
            full = self.module.jacobian(x, self.u, self.parameters)
        return np.asarray(full[np.ix_(self.free, self.free)])

    def inside(self, x: FloatArray) -> bool:
        """Return whether x is in the domain and has finite rates."""
        with np.errstate(all="ignore"):
            margins = self.module.margins(x, self.u, self.parameters)
        return bool(np.all(held(self.module, margins)) and np.isfinite(self.rates(x)).all())

    def moved(self, x: FloatArray, move: FloatArray) -> FloatArray:
        """Return x with its free rows moved."""
        y = x.copy()
        y[self.free] += move
        return y

    def approach(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return a state almost at rest, and the sizes of the free states on the way to it."""
        if not self.inside(x):
            what = "the initial state is outside the domain, or has no rates"
            raise RunError(what, self._model, remedy="give another as 'initial', or other inputs")
        eye = np.eye(self.free.size)
        size: FloatArray = np.maximum(np.abs(x[self.free]), self._heating_sizes(x))
        if not np.any(self.rates(x)):
            return x, size
        first = step = 1e-3 / (float(np.linalg.norm(self.slope(x), 2)) or 1.0)
        move: FloatArray = np.zeros(self.free.size)
        for _ in range(MOST_STEPS):
            if step > LONGEST * first:
                break
            matrix = eye - step * self.slope(x)
            move = np.asarray(np.linalg.solve(matrix, step * self.rates(x)), dtype=float)
            ahead = self.moved(x, move)
            round_off = self._round_off_sizes(x, matrix, step)
            reached = np.maximum.reduce([size, np.abs(ahead[self.free]), np.abs(move), round_off])
            if not self.inside(ahead) or not self._contracts(matrix, step, move, ahead, reached):
                step /= GROWTH
                continue
            x, size = ahead, reached
            if _relative(move, size) <= AT_REST and step * np.linalg.norm(self.slope(x), 2) > 1:
                return x, size
            step *= GROWTH
        raise self._error(move / step, size)

    def _round_off_sizes(self, x: FloatArray, matrix: FloatArray, step: float) -> FloatArray:
        """Return the sizes over which moves caused by round-off of the rates are `ROUND_OFF`."""
        terms = step * np.abs(self.slope(x)) @ np.abs(x[self.free])
        moves: FloatArray = np.abs(np.linalg.inv(matrix)) @ terms
        return moves * np.finfo(float).eps / ROUND_OFF

    def _heating_sizes(self, x: FloatArray) -> FloatArray:
        """Return the change of each free state that changes a temperature by `COUNTS`, else 0."""
        step = 1e-6 * np.maximum(np.abs(x), 1.0)
        with np.errstate(all="ignore"):
            temperatures = self.module.temperatures(x, self.parameters)[:, None]
            changed = self.module.temperatures(x[:, None] + np.diag(step), self.parameters)
            change = np.max(np.abs(changed / temperatures - 1.0), axis=0, initial=0.0)
            size = COUNTS * step / change
        return np.asarray(np.where(change > 0, size, 0.0)[self.free], dtype=float)

    def _contracts(
        self, matrix: FloatArray, step: float, move: FloatArray, ahead: FloatArray, size: FloatArray
    ) -> bool:
        """Return whether a second move of Newton's method is much smaller than the first."""
        again = np.asarray(np.linalg.solve(matrix, step * self.rates(ahead) - move), dtype=float)
        return _relative(again, size) <= CONTRACTION * _relative(move, size) + ROUND_OFF

    def at_rest(self, x: FloatArray, size: FloatArray) -> FloatArray:
        """Return the state of rest near x, by Newton's method with the smallest moves."""
        for _ in range(MOST_MOVES):
            left, values, right, row_size, scale = self._factors(x, size)
            kept = values > SINGULAR * values[0] if values.size else values > 0
            parts = left.T[kept] @ (self.rates(x) / row_size) / values[kept]
            move = -scale * (right[kept].T @ parts)
            if not self.inside(self.moved(x, move)):
                break
            x = self.moved(x, move)
            if _relative(move, size) <= ROUND_OFF:
                break
        *_, row_size, _ = self._factors(x, size)
        if np.max(np.abs(self.rates(x) / row_size), initial=0.0) > AT_REST:
            raise self._error(self.rates(x), size)
        return x

    def _factors(
        self, x: FloatArray, size: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]:
        """Return the singular value decomposition of the scaled Jacobian, and its scales.

        The scales are those of rows (n,) and columns (n,). A state that is 0 and never moved has
        no size: its column gives its scale.
        """
        scale = np.where(size > 0, size, 1.0)
        row_size = np.max(np.abs(self.slope(x) * scale), axis=1, initial=0.0)
        row_size[row_size == 0] = 1.0
        scaled = self.slope(x) * scale / row_size[:, None]
        column = np.max(np.abs(scaled), axis=0, initial=0.0)
        column = np.where((size > 0) | (column == 0), 1.0, column)
        left, values, right = np.linalg.svd(scaled / column)
        return left, values, right, row_size, scale / column

    def undetermined(self, x: FloatArray, size: FloatArray) -> list[int]:
        """Return the rows that differ between x and other states of rest."""
        _, values, right, *_ = self._factors(x, size)
        open_ = right[values <= SINGULAR * values[0]] if values.size else right
        return [int(row) for row in self.free[np.any(np.abs(open_) > UNDETERMINED, axis=0)]]

    def _error(self, rates: FloatArray, size: FloatArray) -> RunError:
        """Return the error of a search without result, with the state of the largest rate."""
        row = int(self.free[int(np.argmax(np.abs(rates) / np.where(size > 0, size, np.inf)))])
        name = row_name(self.module.STATES, self.parameters, row)
        what = f"no state of rest is found: '{name}' goes on and on"
        remedy = "give other inputs"
        if self.module.BODIES:
            temperatures = f"temperatures={{'{self.module.BODIES[0].name}': ...}}"
            remedy += f", or hold a body that heats: operating_point(..., {temperatures})"
        return RunError(what, self._model, remedy=remedy)

    @property
    def _model(self) -> str:
        return f"model '{self.module.NAME}'"


def _relative(move: FloatArray, size: FloatArray) -> float:
    """Return the largest part of its size by which a state moves."""
    return float(np.max(np.abs(move) / np.where(size > 0, size, 1.0), initial=0.0))
