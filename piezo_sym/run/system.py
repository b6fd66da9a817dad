"""A run's fixed parts: the module, its parameters and inputs, and its functions of x and u alone.

Input: a generated module, `Parameters`, `Inputs`.  Output: `DrivenModule`; of many runs
`DrivenModules`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, final, overload

import numpy as np

from piezo_sym.run.checks import FloatArray
from piezo_sym.run.inputs import Inputs, Segment
from piezo_sym.run.module import GeneratedModule, Record, exchanges, rows
from piezo_sym.run.parameter_table import ParameterTable

FLOOR = 1e-15  # so that no tolerance is 0


@final
@dataclass(frozen=True)
class DrivenModule:
    """A module with parameters and inputs; x is (n, *batch), u is (m, *batch)."""

    module: GeneratedModule
    parameters: Any
    inputs: Inputs

    def rows(self, records: Sequence[Record]) -> tuple[slice, ...]:
        """Return the rows of each record in an array that spreads banks."""
        return rows(records, self.parameters)

    def scale(self, x: FloatArray) -> FloatArray:
        """Return the magnitudes of x (*batch, n), lanes of a bank at their maximum, none at 0."""
        scale = np.maximum(np.abs(x), FLOOR)
        for part in self.rows(self.module.STATES):
            scale[..., part] = np.max(scale[..., part], axis=-1, keepdims=True)
        return scale

    def field(self, segment: Segment) -> Callable[[float, FloatArray], FloatArray]:
        """Return dx/dt (n,) as a function of t and x in one segment."""
        rhs, parameters = self.module.rhs, self.parameters
        return lambda t, x: rhs(x, segment.at(t), parameters)

    def slope(self, segment: Segment) -> Callable[[float, FloatArray], FloatArray]:
        """Return the Jacobian (n, n) as a function of t and x in one segment."""
        jacobian, parameters = self.module.jacobian, self.parameters
        return lambda t, x: jacobian(x, segment.at(t), parameters)

    def margins(self, x: FloatArray, u: FloatArray) -> FloatArray:
        """Return each condition's margin, (conditions, *batch)."""
        with np.errstate(all="ignore"):
            return self.module.margins(x, u, self.parameters)

    def violated(self, x: FloatArray, u: FloatArray) -> np.ndarray[Any, np.dtype[np.bool_]]:
        """Return whether each condition fails, (conditions, *batch); a margin of nan fails."""
        margins = self.margins(x, u)
        strict = np.array([c.strict for c in self.module.DOMAIN], dtype=bool)
        strict = strict.reshape(-1, *(1,) * (margins.ndim - 1))
        return ~np.where(strict, margins > 0, margins >= 0)

    def finite(self, x: FloatArray, u: FloatArray) -> np.ndarray[Any, np.dtype[np.bool_]]:
        """Return whether each row of dx/dt is a finite number, (n, *batch)."""
        with np.errstate(all="ignore"):
            return np.isfinite(self.module.rhs(x, u, self.parameters))

    def rates(self, x: FloatArray, u: FloatArray) -> FloatArray:
        """Return what the ledger books, (ports + 2 processes + exchanges, *batch).

        Supply, heat, entropy production; and the entropy that each heat exchange brings, which is
        its power over the temperature of the body.
        """
        m, p, exchanging = self.module, self.parameters, exchanges(self.module)
        with np.errstate(all="ignore"):
            supply = m.supply(x, u, p)
            brought = supply[exchanging] / m.outputs(x, u, p)[exchanging]
            return np.concatenate([supply, m.heat(x, u, p), m.entropy_production(x, u, p), brought])


@final
@dataclass(frozen=True, eq=False)
class DrivenModules(Sequence[DrivenModule]):
    """Systems of one module with equal inputs, each made when asked for.

    Attributes
    ----------
    module, inputs : of all.
    parameters : of each.
    """

    module: GeneratedModule
    parameters: ParameterTable
    inputs: Inputs

    @staticmethod
    def of(systems: Sequence[DrivenModule]) -> DrivenModules:
        """Return systems with equal inputs as one value."""
        if isinstance(systems, DrivenModules):
            return systems
        first = systems[0]
        return DrivenModules(
            first.module, ParameterTable.of([one.parameters for one in systems]), first.inputs
        )

    def __len__(self) -> int:
        """Return the number of systems."""
        return len(self.parameters)

    @overload
    def __getitem__(self, k: int) -> DrivenModule: ...
    @overload
    def __getitem__(self, k: slice) -> DrivenModules: ...
    def __getitem__(self, k: int | slice) -> DrivenModule | DrivenModules:
        """Return one system, or some."""
        if isinstance(k, slice):
            return DrivenModules(self.module, self.parameters[k], self.inputs)
        return DrivenModule(self.module, self.parameters[k], self.inputs)

    def some(self, runs: Sequence[int]) -> DrivenModules:
        """Return some of the systems."""
        return DrivenModules(self.module, self.parameters.some(runs), self.inputs)
