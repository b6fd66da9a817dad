"""Vectors and matrices over banks whose size stays a symbol.

Input: entries per pair of slots.  Output: `LaneMatrix` with the products that Definition 1 needs;
sums over lanes are kept as `LaneSum`.

A slot is one row or column, or, for a bank, one per lane.  The entry in row (s, j) and column
(t, k) is ``full[s, t]``, the same for every pair of lanes, plus ``own[s, t]`` where j = k and both
slots are of one bank.  An entry may use lane symbols of its own row's or column's lane.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, final

import sympy as sp

from piezo_sym.algebra.notation import Entries, matrix_latex, matrix_text
from piezo_sym.algebra.notation import Slot as Slot
from piezo_sym.algebra.sums import Lanes, outside_sums
from piezo_sym.errors import UsageError, nearest, quote

ONE_SLOT = (Slot(""),)


@final
@dataclass(frozen=True, repr=False)
class LaneMatrix:
    """A matrix whose rows and columns may run over banks of any size.

    Attributes
    ----------
    rows, cols : slots.
    full : entry for every pair of lanes.
    own : further entry where both are the same lane of one bank.
    lanes : the banks' lane symbols and sizes.
    at : the bank, for a matrix of one lane (such as J_j): its `own` entries then stand in that
        lane alone, even in rows and columns outside the bank.
    """

    rows: tuple[Slot, ...]
    cols: tuple[Slot, ...]
    lanes: Lanes
    full: Entries = field(default_factory=dict)
    own: Entries = field(default_factory=dict)
    at: str | None = None

    @property
    def T(self) -> LaneMatrix:
        """The transpose."""
        full = {(c, r): entry for (r, c), entry in self.full.items()}
        own = {(c, r): entry for (r, c), entry in self.own.items()}
        return LaneMatrix(self.cols, self.rows, self.lanes, full, own, self.at)

    def map(self, change: Callable[[sp.Expr], sp.Expr]) -> LaneMatrix:
        """Return the matrix with `change` applied to every entry; zeros drop out."""
        full, own = (
            {place: new for place, old in entries.items() if (new := change(old)) != 0}
            for entries in (self.full, self.own)
        )
        return replace(self, full=full, own=own)

    def __neg__(self) -> LaneMatrix:
        """Return minus the matrix."""
        return self.map(lambda entry: -entry)

    def __add__(self, other: LaneMatrix) -> LaneMatrix:
        """Return the sum of two matrices over the same slots."""
        full, own = _added(self.full, other.full), _added(self.own, other.own)
        return replace(self, full=full, own=own)

    def __sub__(self, other: LaneMatrix) -> LaneMatrix:
        """Return the difference of two matrices over the same slots."""
        return self + -other

    def __matmul__(self, other: LaneMatrix) -> LaneMatrix:
        """Return the product; sums over a bank's lanes become `LaneSum`."""
        full: dict[tuple[int, int], list[sp.Expr]] = {}
        own: dict[tuple[int, int], list[sp.Expr]] = {}
        for (r, m), left, left_own in self.entries():
            for c, right, right_own in other.by_row.get(m, ()):
                entry, same = _product(left, left_own, right, right_own, self.cols[m], self.lanes)
                self._check_lanes(entry, self.rows[r].bank, other.cols[c].bank)
                full.setdefault((r, c), []).append(entry)
                own.setdefault((r, c), []).append(same)
        return LaneMatrix(self.rows, other.cols, self.lanes, _totals(full), _totals(own))

    def _check_lanes(self, entry: sp.Expr, row: str | None, col: str | None) -> None:
        """Refuse a lane symbol in an entry for two lanes of its bank: it could mean either lane."""
        if row and row == col and outside_sums(entry) & set(self.lanes.symbols(row)):
            what = f"an entry for two lanes of bank '{row}' depends on both"
            remedy = "write the banks out first: iphs.expand()"
            raise UsageError(what, "matrix product", remedy=remedy)

    def __iter__(self) -> Iterator[sp.Expr]:
        """Iterate over a vector's entries, one per slot."""
        return (self.full.get((r, 0), sp.S.Zero) for r in range(len(self.rows)))

    @property
    def shape(self) -> tuple[int, int]:
        """Number of row and column slots; a bank counts as one."""
        return len(self.rows), len(self.cols)

    def __getitem__(self, place: tuple[int | str, int | str] | int | str) -> sp.Expr:
        """Return an entry by labels (``J0["p", "Q_C"]``) or indices; a vector needs the row alone.

        Within one bank, what counts for equal lanes only has the factor delta_jk.  Raises
        `UsageError` if there is no such row or column.
        """
        row, col = place if isinstance(place, tuple) else (place, 0)
        rows, cols = ([slot.label for slot in slots] for slots in (self.rows, self.cols))
        at = _place_of(row, rows, "row"), _place_of(col, cols, "column")
        same = sp.KroneckerDelta(sp.Symbol("j"), sp.Symbol("k"))
        return self.full.get(at, sp.S.Zero) + self.own.get(at, sp.S.Zero) * same

    def entries(self) -> Iterator[tuple[tuple[int, int], sp.Expr, sp.Expr]]:
        """Yield ((row, column), full, own) of every entry that is not zero, in order."""
        for place in sorted({**self.full, **self.own}):
            yield place, self.full.get(place, sp.S.Zero), self.own.get(place, sp.S.Zero)

    @cached_property
    def by_row(self) -> dict[int, list[tuple[int, sp.Expr, sp.Expr]]]:
        """The (column, full, own) of every entry that is not zero, in order, by row."""
        found: dict[int, list[tuple[int, sp.Expr, sp.Expr]]] = {}
        for (r, c), full, own in self.entries():
            found.setdefault(r, []).append((c, full, own))
        return found

    def __str__(self) -> str:
        """Return the matrix as an aligned grid with its labels."""
        return matrix_text(self.rows, self.cols, self.full, self.own)

    __repr__ = __str__

    def _repr_latex_(self) -> str:
        return f"$\\displaystyle {matrix_latex(self.rows, self.cols, self.full, self.own)}$"

    @property
    def is_zero(self) -> bool:
        """Whether every entry is zero as it stands."""
        return not self.full and not self.own

    def explicit(self, counts: Mapping[str, int], lane: int = 1) -> NamedMatrix:
        """Return the SymPy matrix, with labels, for banks of the sizes `counts`.

        Of a matrix of one lane (`at`), `lane` is the number of that lane, from 1.
        """
        rows, cols = _places(self.rows, counts), _places(self.cols, counts)
        matrix = NamedMatrix(
            len(rows), len(cols), lambda r, c: self._entry(rows[r], cols[c], counts, lane)
        )
        matrix.labels = _labels(self.rows, rows), _labels(self.cols, cols)
        return matrix

    def _entry(
        self, row: tuple[int, int], col: tuple[int, int], counts: Mapping[str, int], lane: int
    ) -> sp.Expr:
        (r, j), (c, k) = row, col
        entry = self.full.get((r, c), sp.S.Zero)
        if self._is_own(row, col, lane):
            entry += self.own.get((r, c), sp.S.Zero)
        entry = self.lanes.expand(entry, counts)
        for slot, place in ((self.rows[r], j), (self.cols[c], k)):
            entry = self.lanes.at(entry, slot.bank, place) if slot.bank else entry
        return entry

    def _is_own(self, row: tuple[int, int], col: tuple[int, int], lane: int) -> bool:
        """Return whether `own` counts for a row and a column, each as (slot, lane of its bank)."""
        if self.at is None:
            return row[1] == col[1] and self.rows[row[0]].bank == self.cols[col[0]].bank
        places = ((self.rows[row[0]], row[1]), (self.cols[col[0]], col[1]))
        return all(place == lane for slot, place in places if slot.bank == self.at)


@final
class NamedMatrix(sp.ImmutableMatrix):  # type: ignore[misc]  # SymPy has no types
    """A SymPy matrix with labelled rows and columns; results of operations on it have no labels."""

    labels: tuple[Sequence[str], Sequence[str]] = ((), ())

    def __getitem__(self, place: Any) -> Any:
        """Return an entry by labels (``J0["p", "Q_C"]``), or what SymPy returns."""
        row, col = place if isinstance(place, tuple) and len(place) == 2 else (place, 0)
        if isinstance(row, str) or isinstance(col, str):
            rows, cols = self.labels
            place = _place_of(row, rows, "row"), _place_of(col, cols, "column")
        return super().__getitem__(place)


def vector(rows: tuple[Slot, ...], lanes: Lanes, entries: Mapping[int, sp.Expr]) -> LaneMatrix:
    """Return a column vector with one entry per slot; zeros drop out."""
    return LaneMatrix(rows, ONE_SLOT, lanes, {(r, 0): e for r, e in entries.items() if e != 0})


def _place_of(asked: int | str, labels: Sequence[str], what: str) -> int:
    if isinstance(asked, str) and asked in labels:
        return labels.index(asked)
    if isinstance(asked, int) and -len(labels) <= asked < len(labels):
        return asked % len(labels)
    remedy = nearest(str(asked), labels)
    raise UsageError(f"{quote(asked)} is no {what}", "matrix", remedy=remedy)


def _places(slots: tuple[Slot, ...], counts: Mapping[str, int]) -> list[tuple[int, int]]:
    return [
        (n, lane)
        for n, slot in enumerate(slots)
        for lane in (range(1, counts[slot.bank] + 1) if slot.bank else (0,))
    ]


def _labels(slots: tuple[Slot, ...], places: list[tuple[int, int]]) -> list[str]:
    return [f"{slots[n].label}_{lane}" if lane else slots[n].label for n, lane in places]


def _added(left: Entries, right: Entries) -> dict[tuple[int, int], sp.Expr]:
    terms = {place: [entry] for place, entry in left.items()}
    for place, entry in right.items():
        terms.setdefault(place, []).append(entry)
    return _totals(terms)


def _totals(terms: Mapping[tuple[int, int], list[sp.Expr]]) -> dict[tuple[int, int], sp.Expr]:
    """Return the sum at each place, expanded once; zeros drop out."""
    totals = {place: sp.expand(sp.Add(*parts)) for place, parts in terms.items()}
    return {place: total for place, total in totals.items() if total != 0}


def _product(
    left: sp.Expr, left_own: sp.Expr, right: sp.Expr, right_own: sp.Expr, middle: Slot, lanes: Lanes
) -> tuple[sp.Expr, sp.Expr]:
    """Return one term of a product, over all lanes of the middle slot: (every pair, same lane)."""
    if middle.bank is None:
        return left * right, sp.S.Zero
    across = lanes.sum(left * right, middle.bank)
    return across + left_own * right + left * right_own, left_own * right_own
