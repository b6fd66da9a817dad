"""A run at its samples, and the ledger that goes with it.

supplied_port(t) = int_0^t y u dt
heat_k(t) = int_0^t W_k z_k dt        produced_k(t) = int_0^t W_k z_k/T dt
entropy_exchanged_a(t) = int_0^t lam (T_e - T)/T dt
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import final

import numpy as np
from numpy.typing import NDArray

from piezo_sym.run.checks import FloatArray
from piezo_sym.run.module import exchanges, row_count
from piezo_sym.run.system import DrivenModule


@final
@dataclass(frozen=True)
class Trajectory:
    """A run at its sample times (nt,), nan beyond what it reached, and what it took."""

    start: FloatArray  # (n,): the state at t = 0
    states: FloatArray  # (n, nt)
    inputs: FloatArray  # (m, nt)
    #: (ports + 2 processes + exchanges, nt): supplied, heat, produced, exchanged
    integrals: FloatArray
    steps: int = 0
    evaluations: int = 0
    halvings: int = 0
    numerical: FloatArray | None = None  # (2, nt): heat and entropy that dissipative starts produce

    @staticmethod
    def blank(system: DrivenModule, start: FloatArray, samples: int) -> Trajectory:
        """Return a run that has not begun."""
        module, p = system.module, system.parameters
        sums = len(module.OUTPUTS) + 2 * row_count(module.PROCESSES, p) + len(exchanges(module))
        rows = start.size, len(module.INPUTS), sums
        states, inputs, integrals = (np.full((size, samples), np.nan) for size in rows)
        return Trajectory(start, states, inputs, integrals)

    def at(self, places: NDArray[np.intp]) -> Trajectory:
        """Return some of the samples."""
        return replace(
            self,
            states=self.states[:, places],
            inputs=self.inputs[:, places],
            integrals=self.integrals[:, places],
            numerical=None if self.numerical is None else self.numerical[:, places],
        )

    def until(self, times: FloatArray) -> tuple[FloatArray, Trajectory]:
        """Return the times and samples of a run that has no more states."""
        missing = np.isnan(self.states).any(axis=0)
        count = int(np.argmax(missing)) if missing.any() else missing.size
        return times[:count], self.at(np.arange(count))
