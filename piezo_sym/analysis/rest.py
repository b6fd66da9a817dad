"""The search for a state of rest: long steps of the implicit Euler method, then Newton's method.

Input: a generated module, its parameters and constant inputs, the rows of the free states, a start.
Output: a state x (n,) at which their rates are zero, or a `RunError` that names one that moves on.

The search has coordinates z, x = start + basis z.  At first these are the free states; once the
linear functions that the motion conserves are known, as many fewer.  Steps that are long beside
the motion would lose these functions to round-off.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any, TypeAlias, final

import numpy as np

from piezo_sym.analysis.conserved import basis_of, conserved_functions
from piezo_sym.errors import RunError, listing
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.guard import LIMIT, broken, place, remedies
from piezo_sym.run.module import GeneratedModule, by_name, row_name
from piezo_sym.run.parameters import temperature_slopes
from piezo_sym.run.system import DrivenModule

MOST_STEPS, MOST_MOVES = 400, 40
LONGEST = 1e30  # the longest Euler step, over the first: creep by a power law decays slowly
GROWTH = 4.0  # of the Euler step
CONTRACTION = 0.25  # the largest second Newton move of an Euler step, over the first
AT_REST = 1e-9  # a move at rest, over the states' sizes
ROUND_OFF = 1e-13
AT_LIMIT = 1.0 + 1e-15  # effort over limit of a stop that surely yields, despite round-off
COUNTS = 1e-6  # the least relative change of a body's temperature that counts as a motion
UNDETERMINED = 1e-6  # components of a unit vector below this are round-off
SINGULAR = 1e-10  # over the greatest singular value of the scaled Jacobian
JACOBIANS = 8  # states on the way whose Jacobians show which functions are conserved

Rows: TypeAlias = np.ndarray[Any, np.dtype[np.intp]]


@final
@dataclass(frozen=True)
class Approach:
    """The way to a state of rest."""

    states: list[FloatArray]  # x (n,) after each step, with the start
    size: FloatArray  # the greatest magnitude of each coordinate (k,); 0 where it never moved
    moving: FloatArray | None  # rates (k,) at the end of a way that does not end at rest
    outside: FloatArray | None = None  # the state (n,) outside the domain before which it ends


@final
@dataclass(frozen=True)
class RestSearch:
    """A search for a state of rest of a module under constant inputs."""

    system: DrivenModule
    u: FloatArray
    free: Rows  # of the states that are not held
    rows: Rows  # of the coordinates z (k,) among the states
    basis: FloatArray  # dx/dz (n, k)
    stops: Mapping[str, slice]  # the rows of the state of each stop

    @property
    def module(self) -> GeneratedModule:
        """The generated module."""
        return self.system.module

    def keeping(self, way: Approach) -> RestSearch:
        """Return the search that keeps the linear functions which are conserved on the way."""
        states = way.states[:: -(-len(way.states) // JACOBIANS)]
        jacobians = [self.jacobian(x)[np.ix_(self.free, self.free)] for x in states]
        changes = np.column_stack([*map(self.rates, way.states), *jacobians])
        size = np.where(way.size > 0, way.size, 1.0)
        functions = conserved_functions(changes, size)
        coordinates, basis = basis_of(functions, size)
        return replace(self, rows=self.rows[coordinates], basis=self.basis @ basis)

    def rates(self, x: FloatArray) -> FloatArray:
        """Return dz/dt (k,)."""
        with np.errstate(all="ignore"):
            return np.asarray(self.module.rhs(x, self.u, self.system.parameters)[self.rows])

    def jacobian(self, x: FloatArray) -> FloatArray:
        """Return the Jacobian (n, n) of the rates with respect to the states."""
        with np.errstate(all="ignore"):
            return np.asarray(self.module.jacobian(x, self.u, self.system.parameters))

    def slope(self, x: FloatArray) -> FloatArray:
        """Return the Jacobian (k, k) of the rates dz/dt with respect to z."""
        with np.errstate(all="ignore"):
            return np.asarray(self.jacobian(x)[self.rows] @ self.basis)

    def inside(self, x: FloatArray) -> bool:
        """Return whether x is in the domain and has finite rates."""
        system, u = self.system, self.u
        return not np.any(system.violated(x, u)) and bool(np.all(system.finite(x, u)))

    def _to_limit(self, x: FloatArray, ahead: FloatArray) -> float:
        """Return the fraction of the way to `ahead` at which a stop meets its limit, or 1."""
        meets = 1.0
        for (_, before, limit), (_, after, _) in zip(
            self.efforts(x), self.efforts(ahead), strict=True
        ):
            beyond = (after > limit) & (before < limit)
            rise = np.where(beyond, after - before, 1.0)
            parts = np.where(beyond, (limit - before) / rise, 1.0)
            meets = min(meets, float(np.min(parts, initial=1.0)))
        return meets

    def limited(self, x: FloatArray) -> FloatArray:
        """Return x with stops that a long step has moved beyond their limits moved back to them."""
        x = x.copy()
        for rows, effort, limit in [*self.efforts(x)]:
            beyond = effort > limit
            x[rows] *= np.where(beyond, limit / np.where(beyond, effort, 1.0), 1.0)
        return x

    def efforts(self, x: FloatArray) -> Iterator[tuple[slice, FloatArray, FloatArray]]:
        """Yield the rows of each stop, the magnitudes of its efforts, and at which they yield."""
        if self.stops:
            with np.errstate(all="ignore"):
                values = self.module.elements(x, self.u, self.system.parameters)
            by = by_name(self.module.ELEMENTS, self.system.parameters, values)
            for stop, rows in self.stops.items():
                yield rows, np.abs(by[f"{stop}.effort"]), by[f"{stop}{LIMIT}"] * AT_LIMIT

    def find(self, start: FloatArray) -> tuple[RestSearch, FloatArray, FloatArray]:
        """Return the search with the fewest coordinates, the state at rest, and sizes (n,).

        Raises
        ------
        RunError : there is no state of rest on the way.
        """
        way = self.approach(start)
        search = self.keeping(way)
        if search.rows.size < self.rows.size:
            sizes, way = way.size, search.approach(start)
        if way.moving is not None:
            raise search.error(way.moving, way.size, way.outside)
        x = search.at_rest(way.states[-1], way.size)
        if search.rows.size < self.rows.size:
            self._refuse_motion(x, sizes)
        return search, x, np.maximum(np.abs([*way.states, x]).max(axis=0), self.heating_sizes(x))

    def approach(self, x: FloatArray) -> Approach:
        """Return the way from x to a state almost at rest."""
        states, size = [x], np.maximum(np.abs(x), self.heating_sizes(x))[self.rows]
        if not np.any(self.rates(x)):
            return Approach(states, size, None)
        slope = self.slope(x)
        first = step = 1e-3 / (_fastest(slope) or float(np.linalg.norm(slope, 2)) or 1.0)
        move: FloatArray = np.zeros(self.rows.size)
        outside = None
        for _ in range(MOST_STEPS):
            if step > LONGEST * first:
                outside = None
                break
            slope = self.slope(x)
            matrix = np.eye(self.rows.size) - step * slope
            move = _solved(matrix, step * self.rates(x), size)
            ahead = x + self.basis @ move
            meets = self._to_limit(x, ahead)
            if 0 < meets < 1 and self.inside(here := self.limited(x + meets * (ahead - x))):
                x, size = here, np.maximum(size, np.abs(here[self.rows]))
                states.append(x)
                continue
            round_off = self._round_off_sizes(x, matrix, step)
            reached = np.maximum.reduce([size, np.abs(ahead[self.rows]), np.abs(move), round_off])
            inside = self.inside(ahead)
            outside = outside if inside else ahead
            if not inside or not self._contracts(matrix, step, move, ahead, reached):
                step /= GROWTH
                continue
            x, size = self.limited(ahead), reached
            states.append(x)
            if _relative(move, size) <= AT_REST and step * _fastest(slope) > 1:
                return Approach(states, size, None)
            step *= GROWTH
        return Approach(states, size, move / step, outside)

    def _round_off_sizes(self, x: FloatArray, matrix: FloatArray, step: float) -> FloatArray:
        """Return the sizes over which moves caused by round-off of the rates are `ROUND_OFF`."""
        terms = step * np.abs(self.jacobian(x)[self.rows]) @ np.abs(x)
        moves: FloatArray = np.abs(np.linalg.inv(matrix)) @ terms
        return moves * np.finfo(float).eps / ROUND_OFF

    def heating_sizes(self, x: FloatArray) -> FloatArray:
        """Return the change of each state (n,) that changes a temperature by `COUNTS`, else 0."""
        with np.errstate(all="ignore"):
            temperatures = self.module.temperatures(x, self.system.parameters)[:, None]
            slopes = temperature_slopes(self.module, self.system.parameters, x) / temperatures
            change = np.max(np.abs(slopes), axis=0, initial=0.0)
            size = COUNTS / change
        return np.asarray(np.where(change > 0, size, 0.0), dtype=float)

    def _contracts(
        self, matrix: FloatArray, step: float, move: FloatArray, ahead: FloatArray, size: FloatArray
    ) -> bool:
        """Return whether a second move of Newton's method is much smaller than the first.

        Moves as small as those at rest may be round-off.
        """
        again = _solved(matrix, step * self.rates(ahead) - move, size)
        return _relative(again, size) <= CONTRACTION * max(_relative(move, size), AT_REST)

    def at_rest(self, x: FloatArray, size: FloatArray) -> FloatArray:
        """Return the state of rest near x, by Newton's method with the smallest moves."""
        outside = None
        for _ in range(MOST_MOVES):
            left, values, right, row_size, scale = self._factors(x, size)
            kept = values > SINGULAR * values[0] if values.size else values > 0
            parts = left.T[kept] @ (self.rates(x) / row_size) / values[kept]
            move = -scale * (right[kept].T @ parts)
            ahead = self.limited(x + self.basis @ move)
            if not self.inside(ahead):
                outside = ahead
                break
            x = ahead
            if _relative(move, size) <= ROUND_OFF:
                break
        self._refuse_motion(x, size, outside)
        return x

    def _refuse_motion(
        self, x: FloatArray, size: FloatArray, outside: FloatArray | None = None
    ) -> None:
        """Raise `RunError` if a coordinate moves at x."""
        *_, row_size, _ = self._factors(x, size)
        if np.max(np.abs(self.rates(x) / row_size), initial=0.0) > AT_REST:
            raise self.error(self.rates(x), size, outside)

    def _factors(
        self, x: FloatArray, size: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]:
        """Return the singular value decomposition of the scaled Jacobian, and its scales.

        The scales are those of rows (k,) and columns (k,). A coordinate that is 0 and never moved
        has no size: its column gives its scale.
        """
        scale = np.where(size > 0, size, 1.0)
        slope = self.slope(x) * scale
        row_size = np.max(np.abs(slope), axis=1, initial=0.0)
        row_size[row_size == 0] = 1.0
        scaled = slope / row_size[:, None]
        column = np.max(np.abs(scaled), axis=0, initial=0.0)
        column = np.where((size > 0) | (column == 0), 1.0, column)
        left, values, right = np.linalg.svd(scaled / column)
        return left, values, right, row_size, scale / column

    def undetermined(self, x: FloatArray, size: FloatArray) -> FloatArray:
        """Return the directions (n, k) from x to other states of rest; no row is due to round-off.

        Each is a unit vector in the sizes (n,) of states.
        """
        *_, values, right, _, scale = self._factors(x, size[self.rows])
        open_ = right[values <= SINGULAR * values[0]] if values.size else right
        open_ = np.where(np.abs(open_) > UNDETERMINED, open_, 0.0)
        return np.asarray(self.basis @ (scale[:, None] * open_.T))

    def error(
        self, rates: FloatArray, size: FloatArray, outside: FloatArray | None = None
    ) -> RunError:
        """Return the error of a search without result: the condition broken, or what moves most."""
        where = place(self.system)
        if outside is not None and np.any(self.system.violated(outside, self.u)):
            text, shown = broken(self.system, outside, self.u)
            what = f"no state of rest is found: the way there leaves the domain, {shown}"
            return RunError(what, where, text, f"change {listing(remedies(self.system, text))}")
        row = int(self.rows[int(np.argmax(np.abs(rates) / np.where(size > 0, size, np.inf)))])
        name = row_name(self.module.STATES, self.system.parameters, row)
        what, remedy = f"no state of rest is found: '{name}' goes on and on", "give other inputs"
        if self.module.BODIES:
            temperatures = f"temperatures={{'{self.module.BODIES[0].name}': ...}}"
            remedy += f", or hold a body that heats: operating_point(..., {temperatures})"
        return RunError(what, where, remedy=remedy)


def _solved(matrix: FloatArray, right: FloatArray, size: FloatArray) -> FloatArray:
    """Return the z (k,) with matrix z = right, solved in units of the coordinates' sizes."""
    scale = np.where(size > 0, size, 1.0)
    scaled = matrix * scale / scale[:, None]
    return np.asarray(scale * np.linalg.solve(scaled, right / scale), dtype=float)


def _fastest(slope: FloatArray) -> float:
    """Return the greatest magnitude of the eigenvalues [1/s]."""
    return float(np.max(np.abs(np.linalg.eigvals(slope)), initial=0.0))


def _relative(move: FloatArray, size: FloatArray) -> float:
    """Return the largest part of its size by which a coordinate moves."""
    return float(np.max(np.abs(move) / np.where(size > 0, size, 1.0), initial=0.0))
