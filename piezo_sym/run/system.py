"""A run's fixed parts: the module, its parameters and inputs, and its functions of x and u alone.

Input: a generated module, `Parameters`, `Inputs`.  Output: `DrivenModule`; of many runs
`DrivenModules`, whose parameters are columns of a `ParameterTable`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from operator import attrgetter
from typing import Any, TypeAlias, final

import numpy as np
from numpy.typing import NDArray

from piezo_sym.run.checks import FloatArray
from piezo_sym.run.inputs import Inputs, Segment
from piezo_sym.run.module import GeneratedModule, Record, exchanges, held, rows

Column: TypeAlias = Sequence[Any] | NDArray[Any]


@final
@dataclass(frozen=True, eq=False)  # a key by identity: what C has of it is kept as long as it
class ParameterTable:
    """The parameters of many runs, of equal sizes: those of run k are `table[k]`."""

    base: Any  # those of one run
    size: int
    columns: Mapping[str, Column]  # of each in which runs differ, one value per run; never written

    def __post_init__(self) -> None:
        """Refuse columns of another length."""
        for name, column in self.columns.items():
            if len(column) != self.size:
                msg = f"column {name} has {len(column)} values for {self.size} runs"
                raise ValueError(msg)

    @staticmethod
    def of(parameters: Sequence[Any] | ParameterTable) -> ParameterTable:
        """Return the parameters of some runs as a table."""
        if isinstance(parameters, ParameterTable):
            return parameters
        base = parameters[0]
        names = vars(base) if len(parameters) > 1 else ()
        columns = {name: list(map(attrgetter(name), parameters)) for name in names}
        return ParameterTable(base, len(parameters), columns)

    def __len__(self) -> int:
        """Return the number of runs."""
        return self.size

    def __iter__(self) -> Iterator[Any]:
        """Yield the parameters of each run."""
        return (self[k] for k in range(self.size))

    def __getitem__(self, k: int) -> Any:
        """Return the parameters of one run: made in a tenth of the time of `replace`."""
        run = range(self.size)[k]
        if not self.columns:
            return self.base
        found = object.__new__(type(self.base))
        change = {
            name: column[run].item() if isinstance(column, np.ndarray) else column[run]
            for name, column in self.columns.items()
        }
        vars(found).update(vars(self.base), **change)
        return found

    def some(self, runs: Sequence[int]) -> ParameterTable:
        """Return the parameters of some of the runs; the table itself for all in their order."""
        runs = list(runs)
        if runs == list(range(self.size)):
            return self
        parts = {
            name: column[runs] if isinstance(column, np.ndarray) else [column[k] for k in runs]
            for name, column in self.columns.items()
        }
        return ParameterTable(self.base, len(runs), parts)


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

    def violated(self, x: FloatArray, u: FloatArray) -> NDArray[np.bool_]:
        """Return whether each condition fails, (conditions, *batch); a margin of nan fails."""
        return ~held(self.module, self.margins(x, u))

    def finite(self, x: FloatArray, u: FloatArray) -> NDArray[np.bool_]:
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
class DrivenModules:
    """Systems of one module with equal inputs and sizes, `systems[k]` made when asked for."""

    module: GeneratedModule
    parameters: ParameterTable
    inputs: Inputs

    @staticmethod
    def of(systems: Sequence[DrivenModule] | DrivenModules) -> DrivenModules:
        """Return systems with equal inputs as one value."""
        if isinstance(systems, DrivenModules):
            return systems
        first, table = systems[0], ParameterTable.of([one.parameters for one in systems])
        return DrivenModules(first.module, table, first.inputs)

    def __len__(self) -> int:
        """Return the number of systems."""
        return len(self.parameters)

    def __iter__(self) -> Iterator[DrivenModule]:
        """Yield each system."""
        return (self[k] for k in range(len(self)))

    def __getitem__(self, k: int) -> DrivenModule:
        """Return one system."""
        return DrivenModule(self.module, self.parameters[k], self.inputs)

    def some(self, runs: Sequence[int]) -> DrivenModules:
        """Return some of the systems."""
        return DrivenModules(self.module, self.parameters.some(runs), self.inputs)
