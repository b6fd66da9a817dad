"""Derivatives of a step: of its equations, of where it ends, and of when an event ends it.

Input: a step of a `Taped` run, solved.  Output: `Derivatives`.  The rates K of the stages satisfy
G(K; x, u, p, h) = f(X(c_i), means, u_i) - K_i = 0; the derivatives of G are those of the step's own
text, computed with numbers that have slopes, so that they are exact to round-off.
"""

import ctypes
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from types import SimpleNamespace
from typing import Any, Literal, final

import numpy as np
from numpy.typing import ArrayLike, NDArray
from replay import Solved, Taped, TapedStep

from piezo_sym.run.checks import FloatArray
from piezo_sym.run.engine.batch import collocation_library
from piezo_sym.run.engine.records import LONG, at, c_record

#: A slope is an imaginary part of so much: a power of two, whose square is nothing beside 1.
TINY = 2.0**-400


@final
@dataclass(frozen=True)
class DirectionalSlopes:
    """The slopes of a step along a direction.

    Attributes
    ----------
    gap : of its equations G, (stages, n).
    end : of the state at its end, (n,).
    side : of the switching functions there, (branches,).
    """

    gap: FloatArray
    end: FloatArray
    side: FloatArray


@final
class Derivatives:
    """The derivatives of a step, on the branches that it took.

    A direction is given by name: `x` (n,), `u` (stages + 1, inputs), at the stages and the end,
    `h` [s], and `parameters`, name -> number, or one per lane.  What is left out does not move:
    where inputs change with time, a longer step has later inputs, ``u = h*places*du/dt``.
    """

    def __init__(self, run: Taped, step: TapedStep, solved: Solved) -> None:
        self._run, self._step, self._solved = run, step, solved
        engine = run.engine
        library = collocation_library(engine, run.stages, "slopes")
        self._along = getattr(library, f"{engine.module.NAME}_along")
        space = getattr(library, f"{engine.module.NAME}_direction_space")
        space.restype = LONG
        self._p = engine.structure(run.parameters)
        self._space = np.empty(space(ctypes.byref(self._p.value)), dtype=complex)

    def equations(
        self,
        *,
        rates: ArrayLike = 0.0,
        x: ArrayLike = 0.0,
        u: ArrayLike = 0.0,
        h: float = 0.0,
        parameters: Mapping[str, Any] | None = None,
    ) -> DirectionalSlopes:
        """Return the slopes of the equations, where the rates (stages, n) are a direction, too."""
        step, solved = self._step, self._solved
        moved = self._structure(parameters or {})
        size = np.array([step.h + 1j * TINY * h])
        given = (
            size,
            _with(step.x, x),
            _with(solved.rates, rates),
            _with(solved.u, u),
            step.branches.astype(complex),
        )
        out = tuple(np.empty(s, complex) for s in (solved.rates.shape, step.x.shape, self._sides))
        arrays = (at(array) for array in (*given, *out, self._space))
        both = (ctypes.addressof(p.value) for p in (self._p, moved))
        self._along(ctypes.byref(c_record("direction")(*both, *arrays)))
        return DirectionalSlopes(*(array.imag / TINY for array in out))

    @cached_property
    def places(self) -> FloatArray:
        """Where inputs are taken, in parts of the step, (stages + 1, 1)."""
        nodes, _ = np.polynomial.legendre.leggauss(self._run.stages)
        return np.append((nodes + 1) / 2, 1.0)[:, None]

    @cached_property
    def matrix(self) -> FloatArray:
        """The derivative of the equations by the rates, (stages*n, stages*n)."""
        return self._by_rates[0]

    @cached_property
    def ends(self) -> FloatArray:
        """The derivative of the step's end by the rates, (n, stages*n)."""
        return self._by_rates[1]

    def solve(self, right: ArrayLike) -> FloatArray:
        """Return what the matrix takes to `right` (stages*n,)."""
        return self._solved_by(right, 0)

    def solve_transposed(self, right: ArrayLike) -> FloatArray:
        """Return what the transpose of the matrix takes to `right` (stages*n,)."""
        return self._solved_by(right, 1)

    def tangent(self, **direction: Any) -> DirectionalSlopes:
        """Return how the step moves along a direction: its rates (as `gap`), end, and switches."""
        moved = self.equations(**direction)
        rates = -self.solve(moved.gap.ravel()).reshape(moved.gap.shape)
        whole = self.equations(rates=rates, **direction)
        return replace(whole, gap=rates)

    def gradient(self, weights: ArrayLike, **direction: Any) -> float:
        """Return the slope of `weights` (n,) times the step's end, by one transposed solve."""
        moved = self.equations(**direction)
        weights = np.asarray(weights, dtype=float)
        return float(weights @ moved.end - self._adjoint(weights) @ moved.gap.ravel())

    def event(self, switch: int, changes: ArrayLike = 0.0, **direction: Any) -> float:
        """Return the slope of the time at which a switching function is zero, the step's end.

        Parameters
        ----------
        changes : of the inputs, du/dt (stages + 1, inputs).

        Raises
        ------
        ZeroDivisionError
            If the function does not change with time there.
        """
        by_time = self.tangent(h=1.0, u=self.places * np.asarray(changes)).side[switch]
        if by_time == 0.0:
            raise ZeroDivisionError("the event is not crossed")
        return float(-self.tangent(**direction).side[switch] / by_time)

    def _adjoint(self, weights: FloatArray) -> FloatArray:
        return self.solve_transposed(self.ends.T @ weights)

    @cached_property
    def _sides(self) -> int:
        return int(self._step.branches.shape[1])

    @cached_property
    def _by_rates(self) -> tuple[FloatArray, FloatArray]:
        shape = self._solved.rates.shape
        found = [self.equations(rates=one.reshape(shape)) for one in np.eye(shape[0] * shape[1])]
        gaps = np.array([slopes.gap.ravel() for slopes in found]).T
        return gaps, np.array([slopes.end for slopes in found]).T

    @cached_property
    def _factors(self) -> tuple[NDArray[Any], NDArray[Any]]:
        from scipy.linalg import lu_factor

        factors: tuple[NDArray[Any], NDArray[Any]] = lu_factor(self.matrix)
        return factors

    def _solved_by(self, right: ArrayLike, transposed: Literal[0, 1]) -> FloatArray:
        from scipy.linalg import lu_solve

        given: Any = np.asarray(right, dtype=float)
        found: FloatArray = lu_solve(self._factors, given, trans=transposed)
        return found

    def _structure(self, moved: Mapping[str, Any]) -> Any:
        """Return the slopes of the parameters as a record of parameters."""
        module = self._run.engine.module
        counts = {f"{b}_count": getattr(self._run.parameters, f"{b}_count") for b in module.BANKS}
        zeros = {record.name: 0.0 for record in module.PARAMETERS}
        if unknown := sorted({*moved} - {*zeros}):
            raise ValueError(f"no parameter is called {unknown[0]}")
        scaled = {name: TINY * np.asarray(value, dtype=float) for name, value in moved.items()}
        return self._run.engine.structure(SimpleNamespace(**{**zeros, **counts, **scaled}))


def _with(value: FloatArray, slope: ArrayLike) -> NDArray[Any]:
    """Return numbers with slopes."""
    return value + 1j * TINY * np.asarray(slope, dtype=float)
