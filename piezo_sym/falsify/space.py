"""Points of a model as one array, and its functions, laws and edges at these points.

Input: a module, a probe, bank sizes.  Output: a `Space`.  Its n points are an array of shape
(columns, n); the columns are all parameters, inputs and states, one per lane of a bank.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate, pairwise, starmap
from types import ModuleType
from typing import Any, TypeVar, final

import numpy as np
import numpy.typing as npt

from piezo_sym.expressions.floats import Approx, Floats
from piezo_sym.expressions.tree import COMPARED, Cmp, Expr, Num, Sym
from piezo_sym.expressions.units import parse_unit
from piezo_sym.falsify.probe import RESULTS, Probe
from piezo_sym.spec.tables import greater

Array = npt.NDArray[np.float64]
Index = npt.NDArray[np.int64]
Mask = npt.NDArray[np.bool_]
Key = TypeVar("Key")

#: Bounds on the magnitudes of a point's nonzero values; above EXTREME their products overflow.
LEAST, LARGEST, EXTREME = 1e-300, 1e300, 1e30
#: A power with a smaller exponent hardly changes over tens of decades, and seems to jump at zero.
STEEP = 0.01
#: Most numbers (states times points) in one call of the module; its `rhs` splits larger arrays.
BLOCK = 100_000
#: Most numbers (states times points) in one evaluation of trees: many, to save calls of NumPy.
TREES = 3 * BLOCK
#: Fewest points in one evaluation; the most points in all, times the square of their columns.
FEWEST, MOST = 1024, 10**9


@final
@dataclass(frozen=True, eq=False)
class Space:
    """The points of a module with given bank sizes."""

    module: ModuleType
    probe: Probe
    counts: Mapping[str, int]

    @cached_property
    def fields(self) -> tuple[Any, ...]:
        """The records of parameters, inputs and states, in the order of columns."""
        return (*self.module.PARAMETERS, *self.module.INPUTS, *self.module.STATES)

    @cached_property
    def columns(self) -> tuple[tuple[str, int], ...]:
        """Name and lane of each column; lane 0 where there is no bank."""
        return tuple((f.name, lane) for f in self.fields for lane in range(self.lanes(f.bank)))

    @cached_property
    def columns_of(self) -> Mapping[str, slice]:
        """The columns of each parameter, input and state."""
        return self._slices((field.name, field.bank) for field in self.fields)

    @cached_property
    def banks(self) -> Mapping[str, str | None]:
        """The bank of each parameter, input and state that has a value per lane."""
        return {field.name: field.bank for field in self.fields}

    @cached_property
    def inputs_at(self) -> int:
        """The first column of the inputs."""
        return sum(self.lanes(field.bank) for field in self.module.PARAMETERS)

    @cached_property
    def states_at(self) -> int:
        """The first column of the states."""
        return self.inputs_at + len(self.module.INPUTS)

    @cached_property
    def positive(self) -> Mask:
        """Mask of the columns that a condition of the domain keeps from being negative."""
        found = set()
        for condition in self.probe.iphs.circuit.conditions:
            match greater(condition.tree):
                case Cmp(_, Sym(name), Num(value)) if value >= 0:
                    found.add(name)
        return np.array([name in found for name, _ in self.columns])

    @cached_property
    def pairs(self) -> Index:
        """Pairs of columns of equal dimension, shape (pairs, 2)."""
        units = {field.name: parse_unit(field.unit).dimension for field in self.fields}
        columns = [units[name] for name, _ in self.columns]
        alike: dict[Any, list[int]] = {}
        for n, unit in enumerate(columns):
            alike.setdefault(unit, []).append(n)
        pairs = [(a, b) for a, unit in enumerate(columns) for b in alike[unit] if a != b]
        return np.array(pairs, dtype=np.int64).reshape(-1, 2)

    @cached_property
    def block(self) -> int:
        """The number of points evaluated together."""
        return max(FEWEST, min(8192, TREES // max(1, len(self.columns) - self.states_at)))

    @cached_property
    def most(self) -> int:
        """The most points evaluated, fewer for systems with more than 100 columns."""
        return max(2 * FEWEST, MOST // len(self.columns) ** 2)

    def lanes(self, bank: str | None) -> int:
        """Return the number of lanes of a bank, 1 for None."""
        return self.counts[bank] if bank else 1

    @cached_property
    def rows(self) -> Mapping[str, Mapping[str, slice]]:
        """The rows of each state, process and body in results, one per lane."""
        return {
            table: self._slices((r.name, r.bank) for r in getattr(self.module, table))
            for table in ("STATES", "PROCESSES", "BODIES")
        }

    @cached_property
    def edges_by_column(self) -> Mapping[str, tuple[int, ...]]:
        """The indices of the edges that depend on each column; module results depend on all."""
        found: dict[str, tuple[int, ...]] = {}
        for n, edge in enumerate(self.probe.edges):
            behind = self.probe.behind(edge.tree)
            for name in self.columns_of if " " in "".join(behind) else behind:
                found[name] = (*found.get(name, ()), n)
        return found

    @cached_property
    def edge_rows(self) -> Mapping[int, slice]:
        """The rows of each edge, one per lane."""
        return self._slices((n, edge.bank) for n, edge in enumerate(self.probe.edges))

    @cached_property
    def kinks(self) -> Mask:
        """Mask of the rows of edges that are kinks."""
        edges = self.probe.edges
        return np.array([e.kink for e in edges for _ in range(self.lanes(e.bank))], dtype=bool)

    def _slices(self, banks: Iterable[tuple[Key, str | None]]) -> Mapping[Key, slice]:
        """Return the rows of each key, given its bank."""
        keys = list(banks)
        ends = [0, *accumulate(self.lanes(bank) for _, bank in keys)]
        return dict(zip((key for key, _ in keys), starmap(slice, pairwise(ends)), strict=True))

    @cached_property
    def _given(self) -> Mapping[str, Array]:
        """The spec's own values, by name, one per lane."""
        spec, u = self.module.Parameters(), np.asarray(self.module.INPUT_DEFAULTS, dtype=float)
        full = Space(self.module, self.probe, {b: getattr(spec, f"{b}_count") for b in self.counts})
        sizes = [full.lanes(field.bank) for field in self.fields]
        values = [getattr(spec, field.name) for field in self.module.PARAMETERS]
        spread = [np.broadcast_to(v, n) for v, n in zip(values, sizes, strict=False)]
        point = np.concatenate([*spread, u, self.module.initial_state(u, spec)])
        names, parts = (f.name for f in self.fields), np.split(point, np.cumsum(sizes)[:-1])
        return dict(zip(names, parts, strict=True))

    def own(self, first: int = 0) -> Array:
        """Return the spec's own values as one point; its lane 0 is lane `first` of each bank."""
        parts = ((self._given[name], lane) for name, lane in self.columns)
        return np.array([[part[(first + lane) % len(part)]] for part, lane in parts])

    def at(self, points: Array) -> Evaluation:
        """Return the evaluation of the module and the probe at points."""
        return Evaluation(self, points)

    def split(self, points: Array) -> tuple[Array, Array, Any]:
        """Return points as (states, inputs, parameters) for the module."""
        values: dict[str, Any] = {f"{bank}_count": count for bank, count in self.counts.items()}
        for field in self.module.PARAMETERS:
            columns = self.columns_of[field.name]
            values[field.name] = points[columns] if field.bank else points[columns.start]
        p = self.module.Parameters(**values)
        return points[self.states_at :], points[self.inputs_at : self.states_at], p

    def words(self, point: Array) -> dict[str, str]:
        """Return the values of a point as text that reads back exactly."""
        single = {field.name for field in self.fields if field.bank is None}
        return {
            name if name in single else f"{name}[{lane + 1}]": repr(float(value))
            for (name, lane), value in zip(self.columns, point, strict=True)
        }


@final
class Evaluation:
    """The module's functions, single laws and edges at points, computed on demand."""

    def __init__(self, space: Space, points: Array) -> None:
        self.space = space
        self.points = points

    def __getattr__(self, name: str) -> Array:
        """Return the result of a function of the module, computed once."""
        step = max(1, BLOCK // max(1, self.points.shape[0] - self.space.states_at))
        parts = (self.points[:, n : n + step] for n in range(0, max(1, self.points.shape[1]), step))
        function, found = getattr(self.space.module, name), list[Array]()
        with np.errstate(all="ignore"):
            for x, u, p in map(self.space.split, parts):
                found.append(function(x, p) if name == "temperatures" else function(x, u, p))
        value = found[0] if len(found) == 1 else np.concatenate(found, axis=-1)
        setattr(self, name, value)
        return value

    @cached_property
    def values(self) -> Floats:
        """Trees at the points."""
        return Floats(self._given, self.space.probe.defined, self.space.counts)

    @cached_property
    def edges(self) -> Array:
        """The values of all edges, one row per edge and lane."""
        return self.some_edges(range(len(self.space.probe.edges)))

    def some_edges(self, numbers: Iterable[int]) -> Array:
        """Return the values of the edges with some numbers, one row per edge and lane."""
        edges, count = self.space.probe.edges, self.points.shape[1]
        rows = (
            np.broadcast_to(self.of(edges[n].tree).value, (self.space.lanes(edges[n].bank), count))
            for n in numbers
        )
        return np.concatenate([np.empty((0, count)), *rows])

    def law(self, what: str, element: str) -> Approx:
        """Return a law, of shape (lanes, points)."""
        tree, bank = self.space.probe.law(what, element)
        found = self.of(tree)
        shape = self.space.lanes(bank), self.points.shape[1]
        value, size = (np.broadcast_to(part, shape) for part in (found.value, found.size))
        return Approx(value, size, found.lost)

    def of(self, tree: Expr) -> Approx:
        """Return a tree at the points."""
        with np.errstate(all="ignore"):
            return self.values[tree]

    def holds(self, conditions: Iterable[Cmp]) -> Mask:
        """Return the mask of points where all conditions hold."""
        found: Mask = np.ones(self.points.shape[1], dtype=bool)
        for c in conditions:
            found &= COMPARED[c.op](self.of(c.left).value, self.of(c.right).value)
        return found

    def _given(self, name: str) -> Array | None:
        """Return the values of a column or of a result of the module; None for other names."""
        what, _, label = name.partition(" ")
        if label:
            function, table = RESULTS[what]
            rows, bank = self.space.rows[table][label], self.space.probe.defined[name][1]
            values: Array = getattr(self, function)[rows]
        elif name in self.space.columns_of:
            values, bank = self.points[self.space.columns_of[name]], self.space.banks[name]
        else:
            return None
        return values if bank else values[0]

    @property
    def inside(self) -> Mask:
        """Mask of the points that lie in the domain."""
        floors = [[0.0] if c.strict else [-np.nextafter(0, 1)] for c in self.space.module.DOMAIN]
        found: Mask = np.all(self.margins > np.reshape(floors, (-1, 1)), axis=0)
        return found

    @cached_property
    def extreme(self) -> Mask:
        """Mask of the points with a value so large or small that products with it overflow."""
        size = np.abs(self.points)
        found: Mask = np.any((size > EXTREME) | ((size > 0) & (size < 1 / EXTREME)), axis=0)
        return found

    @cached_property
    def out_of_range(self) -> Mask:
        """Mask of the points with a value or a temperature whose products overflow.

        A nan there means nothing.  Temperatures are exponential in the entropy as a rule, so they
        may overflow at moderate values.
        """
        size = np.abs(self.temperatures)
        found: Mask = self.extreme | np.any((size > EXTREME) | (size < 1 / EXTREME), axis=0)
        return found

    @cached_property
    def steep(self) -> Mask:
        """Mask of the points with a power of so small an exponent that it seems to jump at zero."""
        found: Mask = np.zeros(self.points.shape[1], dtype=bool)
        for power in self.space.probe.powers:
            found |= np.atleast_2d(self.values[power.args[1]].value < STEEP).any(axis=0)
        return found

    def undefined(self, element: str) -> Mask:
        """Return where a law of an element, or of the junction for "", is undefined."""
        found: Mask = np.zeros(self.points.shape[1], dtype=bool)
        for tree, _ in self.space.probe.of_element.get(element, ()):
            found |= np.atleast_2d(self.of(tree).lost).any(axis=0)
        return found
