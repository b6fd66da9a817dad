"""A module with its parameters and inputs, and its functions of x and u.

Input: a generated module, `Parameters`, `Inputs`.  Output: `DrivenModule`.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from piezo_sym.run.checks import FloatArray
from piezo_sym.run.inputs import Inputs, Segment
from piezo_sym.run.module import GeneratedModule, Record, heat_exchanges, held, rows

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
        """Return magnitudes of x (*batch, n), at least `FLOOR`; of lanes, that of the largest."""
        scale = np.maximum(np.abs(x), FLOOR)
        for row in self.rows(self.module.STATES):
            scale[..., row] = np.max(scale[..., row], axis=-1, keepdims=True)
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

    def violated(self, x: FloatArray, u: FloatArray) -> NDArray[np.bool_]:
        """Return whether each condition fails, (conditions, *batch); a margin of nan fails."""
        return ~held(self.module, self.margins(x, u))

    def finite(self, x: FloatArray, u: FloatArray) -> NDArray[np.bool_]:
        """Return whether each row of dx/dt is a finite number, (n, *batch)."""
        with np.errstate(all="ignore"):
            return np.isfinite(self.module.rhs(x, u, self.parameters))

    def rates(self, x: FloatArray, u: FloatArray) -> FloatArray:
        """Return the rates of the ledger, (ports + 2 processes + exchanges, *batch).

        Supply rates, heat, entropy production; and the entropy from each heat exchange, its power
        over the temperature of the body.
        """
        m, p, exchanging = self.module, self.parameters, heat_exchanges(self.module)
        with np.errstate(all="ignore"):
            supply = m.supply(x, u, p)
            entropy = supply[exchanging] / m.outputs(x, u, p)[exchanging]
            return np.concatenate([supply, m.heat(x, u, p), m.entropy_production(x, u, p), entropy])
