"""A module with its parameters and inputs, and its functions of x and u.

Input: a generated module, `Parameters`, `Inputs`.  Output: `DrivenModule`.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from piezo_sym.run.checks import FloatArray
from piezo_sym.run.inputs import Inputs
from piezo_sym.run.module import GeneratedModule, Record, heat_exchanges, held, rows

FLOOR = 1e-15  # so that no tolerance is 0
#: Errors, relative to 1 in SI, at which round-off may show in a state; and round-off, relative.
QUIET, ROUND_OFF = 1e-15, 2e-16
CHAIN = 3  # the most states from a temperature to one that its round-off moves
MOST_QUIET = 300  # states of a model: the Jacobian of one with more takes too long
INSTANT = 1e-14  # the part of a run that a motion takes whose slope is as good as infinite


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
        """Return magnitudes of x (*batch, n), at least `FLOOR`; for a bank, the largest lane's."""
        scale = np.maximum(np.abs(x), FLOOR)
        for row in self._lanes:
            scale[..., row] = np.max(scale[..., row], axis=-1, keepdims=True)
        return scale

    @cached_property
    def _lanes(self) -> tuple[slice, ...]:
        """The rows of states that have lanes."""
        records = self.module.STATES
        return tuple(row for r, row in zip(records, self.rows(records), strict=True) if r.bank)

    def noise(self, x: FloatArray, largest: FloatArray) -> FloatArray:
        """Return how far round-off of temperatures and states moves each state (n,) near x (n,).

        No step resolves less; at rest a state is nothing else. Round-off of a rate moves the state
        for as long as the state's own motion takes, its exchange with another state, or the run.
        """
        if x.size > MOST_QUIET:
            return np.zeros(x.size)
        u = self.inputs.segments[0].at(self.inputs.start)
        with np.errstate(all="ignore"):
            slope = np.abs(self.module.jacobian(x, u, self.parameters))
            step = 1e-6 * np.maximum(np.abs(x), 1.0)
            T = self.module.temperatures(x, self.parameters)[:, None]
            rise = np.abs(self.module.temperatures(x[:, None] + np.diag(step), self.parameters) - T)
            sizes = np.nan_to_num(np.min(T * step / rise, axis=0, initial=np.inf), posinf=0.0)
            sizes = np.maximum(sizes, largest)
            pace = np.maximum(np.max(np.sqrt(slope * slope.T), axis=1), 1.0 / self.inputs.duration)
            for _ in range(CHAIN):
                moved = (slope - np.diag(np.diag(slope))) @ sizes / pace
                sizes = np.maximum(sizes, np.nan_to_num(moved, posinf=0.0))
        return np.asarray(ROUND_OFF * sizes)

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

    def steep(self, t: float, x: FloatArray) -> tuple[str, ...]:
        """Return the names of states by which slopes of rates are infinite, or nearly, at t [s].

        A motion of its own, or of two states, takes less than a run's part `INSTANT`.
        """
        if x.size > MOST_QUIET:
            return ()
        u, duration = self.inputs.at_samples(np.array([t]))[:, 0], self.inputs.duration
        with np.errstate(all="ignore"):
            slope = np.abs(self.module.jacobian(x, u, self.parameters))
            known = np.where(np.isfinite(slope), slope, 0.0)
            pace = np.sqrt(known) * np.sqrt(known.T)
        gentle = np.isfinite(slope) & (pace * duration < 1 / INSTANT)
        states = zip(self.module.STATES, self.rows(self.module.STATES), strict=True)
        return tuple(state.name for state, row in states if not gentle[:, row].all())

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
