"""Points at which rows are evaluated; a fixed seed makes them the same on every machine.

Input: a `Space` and points inside the domain to start from.  Output: more points inside, found in
four ways: `kinks` (an edge bisected to neighbouring floats along one column, and points beside it),
`corners` (kinks found from kinks), `drawn` (random values in logarithmic ranges, near known values
and near equality) and `walked` (random steps from points inside, where drawing finds few).
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import final

import numpy as np

from piezo_sym.falsify.space import LARGEST, LEAST, Array, Index, Space

#: If fewer points than this are known, drawn points are added to those from which walks start.
FEW = 1000
WALKS = 40
#: A root at zero is bracketed by -TINY and TINY, as products of smaller values may underflow.
TINY = 1e-280
TABLE = 8192
#: Points evaluated beside a root.
BESIDE = 24
#: Halvings of a bracket that are evaluated together, and of how many brackets one alone is.
HALVINGS, MANY = 3, 2000
#: Searches for zeros of edges, from known points and then from points on edges; most per edge.
STAGES = (("kinks", 16), ("corners", 12))
FAR = (-290, -100, -30, -15, -9, -6)
DECADES = (*FAR, -4, -3, -2, -1, -0.3, 0, 0.3, 1, 2, 3, 4, 6, 9, 15, 30, 100)
LADDER = np.array([-(10.0**e) for e in DECADES[::-1]] + [0.0] + [10.0**e for e in DECADES])
OFF = np.array([0, *(s * 10.0**-e for e in (12, 9, 6, 5, 4, 3, 2, 1) for s in (1, -1))])
POWERS = np.array([float(f"1e{n}") for n in range(-300, 302)])
SIMPLE = np.array([0, 1, -1, 2, -2, 3, -3, 4, 0.5, -0.5, 0.25, 8, 10, -10, 1.5, 5])


@final
@dataclass(eq=False)
class Roots:
    """Sign changes of edges along one column, between neighbouring floats `low` and `high`."""

    edge: Index
    column: Index
    base: Array
    low: Array
    high: Array

    def at(self, value: Array) -> Array:
        """Return the base points with these values in their columns."""
        points = self.base.copy()
        points[self.column, np.arange(len(value))] = value
        return points


@final
@dataclass(eq=False)
class Draw:
    """Draws random points of a space, and points at kinks."""

    space: Space  # the space of the points
    known: Array  # points inside the domain to start from; the first has the spec's own values
    rng: np.random.Generator = field(default_factory=lambda: np.random.default_rng(16))
    roots: list[Roots] = field(default_factory=list)

    def __post_init__(self) -> None:
        """Collect the scales of each column: 1, its known values, and those of equal dimension."""
        scales = [[1.0, *row] for row in np.abs(self.known).tolist()]
        for one, other in self.space.pairs.tolist():
            scales[one] += np.abs(self.known[other]).tolist()
        self.scales = [sorted({s for s in row if s > 0})[:24] for row in scales]

    def inside(self, points: Array) -> Array:
        """Return the points that lie in the domain."""
        step = self.space.block
        parts = [points[:, n : n + step] for n in range(0, points.shape[1], step)]
        kept = [part[:, self.space.at(part).inside] for part in parts]
        return np.concatenate([points[:, :0], *kept], axis=1)

    def kinks(self, bases: Array, most: int) -> Array:
        """Return points on edges and next to them, found by varying one column of each base."""
        roots = self._bisected(self._crossed(bases, most))
        self.roots.append(roots)
        points = np.concatenate([roots.at(v) for v in self._near(roots)], axis=1)
        return self.inside(_normal(points))

    def _near(self, roots: Roots) -> Iterator[Array]:
        for value in (roots.low, roots.high):
            yield from (value, np.nextafter(value, np.inf), np.nextafter(value, -np.inf))
        yield np.where(np.abs(roots.high) <= TINY, 0, roots.high)
        largest = np.array([row[-1] for row in self.scales])[roots.column]
        size = np.where(roots.high == 0, largest, roots.high)
        for off in OFF[1:].tolist():
            yield _bounded(roots.high + off * size)

    def _crossed(self, bases: Array, most: int) -> Roots:
        """Return brackets of sign changes of edges, along a ladder of values of each column."""
        count = bases.shape[1]
        steps = [
            np.unique(_bounded(np.multiply.outer(row[-3:], LADDER).ravel())) for row in self.scales
        ]
        nowhere, nothing = np.empty(0, dtype=np.int64), np.empty(0)
        found: list[tuple[Index, Index, Index, Array, Array]]
        found = [(nowhere, nowhere, nowhere, nothing, nothing)]
        for column, ((name, _), ladder) in enumerate(zip(self.space.columns, steps, strict=True)):
            moving = self.space.edges_by_column.get(name, ())
            if not moving:
                continue
            points = np.repeat(bases, len(ladder), axis=1)
            points[column] = np.tile(ladder, count)
            signs = np.sign(self.space.at(points).some_edges(moving))
            signs = signs.reshape(-1, count, len(ladder))
            first, second = signs[..., :-1], signs[..., 1:]
            row, base, step = np.nonzero((first != second) & np.isfinite(first * second))
            edge = np.concatenate([np.r_[self.space.edge_rows[n]] for n in moving])[row]
            rising = first[row, base, step] != 0
            low = np.where(rising, ladder[step], ladder[step + 1])
            high = np.where(rising, ladder[step + 1], ladder[step])
            found.append((edge, np.full_like(edge, column), base, low, high))
        edges, columns, at, lows, highs = map(np.concatenate, zip(*found, strict=True))
        order = np.argsort(self.rng.random(len(edges)) - 0.5 * (columns >= self.space.inputs_at))
        order = order[np.argsort(edges[order], kind="stable")]
        rank = np.arange(len(order)) - np.searchsorted(edges[order], edges[order])
        share = 2 * self.space.most // (BESIDE * (1 + int(edges.max(initial=0))))
        kept = order[rank < min(most, max(1, share))]
        return Roots(edges[kept], columns[kept], bases[:, at[kept]], lows[kept], highs[kept])

    def _bisected(self, roots: Roots) -> Roots:
        """Return brackets narrowed to neighbouring floats."""

        def signs(value: Array) -> Array:
            """Return the signs of the edges at values of their columns, several times each."""
            again = np.resize(np.arange(len(roots.edge)), len(value))
            points = roots.base[:, again]
            points[roots.column[again], np.arange(len(value))] = value
            edges = self.space.at(points).edges
            return np.sign(edges[roots.edge[again], np.arange(len(value))])

        low, high = _key(roots.low), _key(roots.high)
        sign = signs(roots.low)
        halvings = HALVINGS if len(sign) < MANY else 1
        lanes = np.arange(len(sign))
        while ((_middle(low, high) != low) & (_middle(low, high) != high)).any():
            ends = np.array([low, high])
            for _ in range(halvings):
                between = _middle(ends[:-1], ends[1:])
                ends = np.insert(ends, np.arange(1, len(ends)), between, axis=0)
            same = signs(_float(ends[1:-1].ravel())).reshape(-1, len(sign)) == sign
            at = np.zeros_like(lanes)
            for half in range(halvings - 1, -1, -1):
                at += same[at + (1 << half) - 1, lanes] << half
            low, high = ends[at, lanes], ends[at + 1, lanes]
        ends = np.array([_float(low), _float(high)])
        ends = np.where(np.abs(ends).max(axis=0) < LEAST, [[-TINY], [TINY]], ends)
        return Roots(roots.edge, roots.column, roots.base, *ends)

    def learn(self, points: Array) -> None:
        """Add values found on edges to the scales of their columns, and some points to `known`."""
        roots = self.roots[-1]
        for column, value in zip(roots.column.tolist(), np.abs(roots.high).tolist(), strict=True):
            if 1e-100 < value < 1e100 and len(self.scales[column]) < 64:
                self.scales[column].append(value)
        chosen = self.rng.integers(0, max(1, points.shape[1]), min(256, points.shape[1]))
        self.known = np.concatenate([self.known, points[:, chosen]], axis=1)
        anywhere = self.inside(self.drawn(256))
        plain = anywhere[:, ~self.space.at(anywhere).extreme]
        self.known = np.concatenate([self.known, plain[:, :10]], axis=1)

    @cached_property
    def table(self) -> Array:
        """Values to draw per column, stored twice in a row so that a draw may start anywhere."""
        once = np.array([self._values(column) for column in range(len(self.scales))])
        return np.concatenate([once, once], axis=1)

    def _values(self, column: int) -> Array:
        """Return values to draw: simple numbers, scales times factors near 1 or of any decade."""
        u, v = self.rng.random((2, TABLE))
        kind = np.arange(TABLE) % 16
        exponent = np.select([kind < 6, kind < 9], [4 * u - 2, 18 * u - 9], 600 * u - 300)
        near = 1 + np.where(v < 0.5, 1, -1) * _power(-16 * u)
        factor = np.where((kind >= 9) & (kind < 14), near, _power(exponent))
        scale = np.array(self.scales[column])[self.rng.integers(0, len(self.scales[column]), TABLE)]
        sign = np.where(self.rng.random(TABLE) < 0.5, -1, 1)
        simple = SIMPLE[self.rng.integers(0, len(SIMPLE), TABLE)]
        with np.errstate(over="ignore"):
            values = _bounded(np.where(kind == 14, simple, sign * scale * factor))
        values[np.abs(values) < LEAST] = 0
        return np.abs(values) if self.space.positive[column] else values

    def drawn(self, count: int) -> Array:
        """Return known points with some or all columns replaced by values of the table."""
        rng, columns = self.rng, len(self.scales)
        first = np.where(rng.random(count) < 0.3, 0, rng.integers(0, self.known.shape[1], count))
        share = np.array([1.5 / columns, 4 / columns, 0.5, 1.0])[rng.integers(0, 4, count)]
        anew = rng.integers(0, 256, (columns, count), dtype=np.uint8) < np.int16(256 * share)
        points = self.known[:, first]
        for column, start in enumerate(rng.integers(0, TABLE, columns).tolist()):
            drawn = self.table[column, start : start + count]
            np.copyto(points[column], drawn, where=anew[column])
        return self._paired(points)

    def _paired(self, points: Array) -> Array:
        """Set some values equal, or close, to values of equal dimension in other columns."""
        pairs, rng = self.space.pairs, self.rng
        if len(pairs):
            place = np.flatnonzero(rng.random(points.shape[1]) < 0.2)
            one, other = pairs[rng.integers(0, len(pairs), len(place))].T
            off = OFF[rng.integers(0, len(OFF), len(place))]
            sign = np.where((rng.random(len(place)) < 0.2) & ~self.space.positive[one], -1, 1)
            points[one, place] = sign * points[other, place] * (1 + off)
        return points

    def moved(self, points: Array, each: int, finest: float) -> Array:
        """Return points with two values changed by relative steps from 1 down to 10**-finest."""
        rng, points = self.rng, np.repeat(points, each, axis=1)
        count = points.shape[1]
        size = _power(np.multiply(-finest, rng.random(count)))
        for _ in range(2):
            place = (rng.integers(0, len(points), count), np.arange(count))
            drawn = self.table[place[0], rng.integers(0, TABLE, count)]
            unit = np.where(points[place] == 0, drawn, points[place])
            step = size * (2 * rng.random(count) - 1) * unit
            points[place] = np.where(rng.random(count) < 0.1, drawn, points[place] + step)
        return _normal(points)

    def walked(self, points: Array, wanted: int) -> Array:
        """Return new points inside the domain, found by steps from points inside."""
        first = points.shape[1]
        for n in range(WALKS if first else 0):
            if points.shape[1] - first >= wanted:
                break
            start = points[:, self.rng.integers(0, points.shape[1], 512)]
            new = self.inside(self.moved(start, max(1, min(16, wanted // 512)), 2.0 + n % 12))
            points = np.concatenate([points, new], axis=1)
        return points[:, first:]


def _normal(points: Array) -> Array:
    """Return the points without values that are subnormal or nearly so."""
    size = np.abs(points)
    return points[:, ((size == 0) | (size >= LEAST)).all(axis=0)]


def _bounded(values: Array) -> Array:
    return np.clip(values, -LARGEST, LARGEST)


def _power(exponents: Array) -> Array:
    """Return about 10**exponents by products alone, for the same bits on every machine."""
    floor = np.floor(exponents)
    return POWERS[floor.astype(np.int64) + 300] * (1 + 9 * (exponents - floor))


def _key(values: Array) -> Index:
    """Return integers in the order of the floats; neighbouring floats differ by 1."""
    bits = values.view(np.int64)
    return np.where(bits < 0, np.iinfo(np.int64).min - bits, bits)


def _middle(low: Index, high: Index) -> Index:
    middle: Index = (low >> 1) + (high >> 1) + (low & high & 1)
    return middle


def _float(keys: Index) -> Array:
    bits = np.where(keys < 0, np.iinfo(np.int64).min - keys, keys)
    return np.ascontiguousarray(bits).view(np.float64)
