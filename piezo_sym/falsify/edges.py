"""Values of edges at many points; each edge depends on a few columns alone.

Input: a `Space`.  Output: `Edges`.  An edge that has a value per lane has a row for each.
"""

from __future__ import annotations

from collections.abc import Container, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import final

import numpy as np

from piezo_sym.falsify.floats import Floats
from piezo_sym.falsify.space import Array, Index, Space


@final
@dataclass(frozen=True, eq=False)
class Edges:
    """The edges of a space."""

    space: Space

    @cached_property
    def reached(self) -> tuple[frozenset[str], ...]:
        """The parameters, inputs and states that each row depends on."""
        space, probe = self.space, self.space.probe
        own = ((probe.reach(edge.tree) & space.banks.keys(), edge.bank) for edge in probe.edges)
        return tuple(found for found, bank in own for _ in range(space.lanes(bank)))

    @cached_property
    def on(self) -> Mapping[str, Index]:
        """The rows that depend on each parameter, input and state."""
        found: dict[str, list[int]] = {name: [] for name in self.space.banks}
        for row, reached in enumerate(self.reached):
            for name in reached:
                found[name].append(row)
        return {name: np.array(rows, dtype=np.int64) for name, rows in found.items()}

    def values(self, given: Mapping[str, Array], rows: Container[int], count: int) -> Array:
        """Return the values of all rows; of edges of which no row is needed they are not set.

        Parameters
        ----------
        given : the values of what the edges depend on, by name.
        rows : those needed.
        count : how many points.
        """
        space, n = self.space, 0
        found = np.empty((len(space.kinks), count))
        values = Floats(given, space.probe.defined, space.counts, sized=False)
        with np.errstate(all="ignore"):
            for edge in space.probe.edges:
                own = range(n, n + space.lanes(edge.bank))
                if any(row in rows for row in own):
                    found[own.start : own.stop] = values[edge.tree].value
                n = own.stop
        return found

    def along(self, bases: Array, column: int, ladder: Array, rows: Index) -> Array:
        """Return the values of some rows at bases that have other values in one column."""
        space, given, needed = self.space, dict[str, Array](), frozenset(rows.tolist())
        for name in frozenset[str]().union(*(self.reached[row] for row in needed)):
            at = space.columns_of[name]
            values = np.repeat(bases[at], len(ladder), axis=1)
            if at.start <= column < at.stop:
                values[column - at.start] = np.tile(ladder, bases.shape[1])
            given[name] = values if space.banks[name] else values[0]
        return self.values(given, needed, bases.shape[1] * len(ladder))[rows]
