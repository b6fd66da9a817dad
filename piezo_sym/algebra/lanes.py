"""Vectors and matrices over banks whose size stays a symbol, and sums over their lanes.

Input: entries per pair of slots.  Output: `LaneMatrix` with the products and sums that Definition 1
needs, and `LaneSum`, a sum over lanes kept as a sum.

A slot is one row or column, or, for a bank, one a lane.  The entry of rows (s, j) and (t, k) is
``full[s, t]``, the same for every pair of lanes, plus ``own[s, t]`` where j = k and s and t are of
one bank.  An entry may use lane symbols of its own row's or column's lane.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, final

import sympy as sp
from sympy.core.symbol import Str
from sympy.printing.precedence import PRECEDENCE

from piezo_sym.algebra.notation import Entries, matrix_latex, matrix_text


class LaneSum(sp.Expr):  # type: ignore[misc]
    """The sum of its first argument over the lanes j = 1..r of the bank named by its second."""

    is_commutative = True
    is_real = True

    def __new__(cls, arg: sp.Expr, bank: str | Str) -> LaneSum:
        """Return the sum of `arg` over the lanes of `bank`, as it stands."""
        made: LaneSum = sp.Expr.__new__(cls, arg, bank if isinstance(bank, Str) else Str(bank))
        return made

    def _latex(self, printer: Any, exp: Any = None) -> str:
        term = printer.parenthesize(self.args[0], PRECEDENCE["Mul"])
        text = rf"\sum_{{j=1}}^{{r}} {term}"
        return text if exp is None else rf"\left({text}\right)^{{{exp}}}"

    def _sympystr(self, printer: Any) -> str:
        return f"Sum_j({printer.doprint(self.args[0])})"


def outside_sums(expr: sp.Basic) -> frozenset[sp.Symbol]:
    """Return the symbols of `expr` that do not stand inside a sum over lanes."""
    if isinstance(expr, LaneSum):
        return frozenset()
    if isinstance(expr, sp.Symbol):
        return frozenset({expr})
    return frozenset().union(*(outside_sums(arg) for arg in expr.args))


@final
@dataclass(frozen=True)
class Lanes:
    """What sums over lanes need to know: the bank of each lane symbol, the size of each bank."""

    banks: Mapping[sp.Symbol, str]
    counts: Mapping[str, sp.Symbol]

    def sum(self, expr: sp.Expr, bank: str) -> sp.Expr:
        """Return the sum of `expr` over the lanes of `bank`, in normal form.

        Lane-free factors stand outside, lane-free terms give the bank's size, and every distinct
        sum of a product of lane symbols is an atom of its own.
        """
        total = sp.S.Zero
        for term in sp.Add.make_args(sp.expand(expr)):
            free, lane = self._split(term, bank)
            total += free * (self.counts[bank] if lane == 1 else LaneSum(lane, bank))
        return total

    def _split(self, term: sp.Expr, bank: str) -> tuple[sp.Expr, sp.Expr]:
        """Return a product as (factors free of the bank's lane, the others)."""
        parts: tuple[list[sp.Expr], list[sp.Expr]] = ([], [])
        for factor in sp.Mul.make_args(term):
            lane = any(self.banks.get(symbol) == bank for symbol in outside_sums(factor))
            parts[lane].append(factor)
        return sp.Mul(*parts[0]), sp.Mul(*parts[1])

    def symbols(self, bank: str) -> tuple[sp.Symbol, ...]:
        """Return the lane symbols of `bank`."""
        return tuple(symbol for symbol, own in self.banks.items() if own == bank)

    def at(self, expr: sp.Expr, bank: str, lane: int) -> sp.Expr:
        """Return `expr` in lane number `lane` of `bank`: ``phi_j`` becomes ``phi_<lane>``."""
        names = {s: _numbered(s, lane) for s in self.symbols(bank)}
        return expr.xreplace(names)

    def expand(self, expr: sp.Expr, counts: Mapping[str, int]) -> sp.Expr:
        """Return `expr` with every sum over lanes written out, for banks of the given sizes."""

        def written(arg: sp.Expr, bank: Str) -> sp.Expr:
            lanes = range(1, counts[bank.name] + 1)
            return sp.Add(*(self.at(arg, bank.name, lane) for lane in lanes))

        sizes = {symbol: sp.Integer(counts[bank]) for bank, symbol in self.counts.items()}
        return expr.replace(LaneSum, written).xreplace(sizes)


def _numbered(symbol: sp.Symbol, lane: int) -> sp.Symbol:
    return sp.Symbol(f"{symbol.name.removesuffix('_j')}_{lane}", **symbol.assumptions0)


@final
@dataclass(frozen=True)
class Slot:
    """A row or column: its label and, if it stands for one a lane, its bank."""

    label: str
    bank: str | None = None


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
    at : for a matrix that belongs to one lane of a bank (such as J_j), that bank: its `own`
        entries then stand in that lane alone, also in rows and columns that no bank has.
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
        full: dict[tuple[int, int], sp.Expr] = {}
        own: dict[tuple[int, int], sp.Expr] = {}
        right_rows: dict[int, list[tuple[int, sp.Expr, sp.Expr]]] = {}
        for (m, c), entry, same in other.entries():
            right_rows.setdefault(m, []).append((c, entry, same))
        for (r, m), left, left_own in self.entries():
            for c, right, right_own in right_rows.get(m, ()):
                entry, same = _product(left, left_own, right, right_own, self.cols[m], self.lanes)
                _accumulate(full, (r, c), entry)
                _accumulate(own, (r, c), same)
        return LaneMatrix(self.rows, other.cols, self.lanes, full, own)

    def __iter__(self) -> Iterator[sp.Expr]:
        """Iterate over a vector's entries, one a slot."""
        return (self.full.get((r, 0), sp.S.Zero) for r in range(len(self.rows)))

    def __getitem__(self, place: tuple[int, int]) -> sp.Expr:
        """Return the entry for every pair of lanes; see `own` for the same lane."""
        return self.full.get(place, sp.S.Zero)

    def entries(self) -> Iterator[tuple[tuple[int, int], sp.Expr, sp.Expr]]:
        """Yield ((row, column), full, own) of every entry that is not zero, in order."""
        for place in sorted({**self.full, **self.own}):
            yield place, self.full.get(place, sp.S.Zero), self.own.get(place, sp.S.Zero)

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

    def explicit(self, counts: Mapping[str, int], lane: int = 1) -> sp.ImmutableMatrix:
        """Return the SymPy matrix for banks of the given sizes.

        Parameters
        ----------
        counts : size of each bank.
        lane : for a matrix that belongs to one lane (`at`), which one, from 1.
        """
        rows, cols = _places(self.rows, counts), _places(self.cols, counts)
        return sp.ImmutableMatrix(
            len(rows), len(cols), lambda r, c: self._entry(rows[r], cols[c], counts, lane)
        )

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
        """Return whether `own` counts for a pair of places (slot, lane of its bank)."""
        if self.at is None:
            return row[1] == col[1] and self.rows[row[0]].bank == self.cols[col[0]].bank
        places = ((self.rows[row[0]], row[1]), (self.cols[col[0]], col[1]))
        return all(place == lane for slot, place in places if slot.bank == self.at)


def vector(rows: tuple[Slot, ...], lanes: Lanes, entries: Mapping[int, sp.Expr]) -> LaneMatrix:
    """Return a column vector with one entry a slot; zeros drop out."""
    return LaneMatrix(rows, ONE_SLOT, lanes, {(r, 0): e for r, e in entries.items() if e != 0})


def _places(slots: tuple[Slot, ...], counts: Mapping[str, int]) -> list[tuple[int, int]]:
    return [
        (n, lane)
        for n, slot in enumerate(slots)
        for lane in (range(1, counts[slot.bank] + 1) if slot.bank else (0,))
    ]


def _added(left: Entries, right: Entries) -> dict[tuple[int, int], sp.Expr]:
    total = dict(left)
    for place, entry in right.items():
        _accumulate(total, place, entry)
    return total


def _accumulate(
    entries: dict[tuple[int, int], sp.Expr], place: tuple[int, int], entry: sp.Expr
) -> None:
    total = sp.expand(entries.get(place, sp.S.Zero) + entry)
    if total == 0:
        entries.pop(place, None)
    else:
        entries[place] = total


def _product(
    left: sp.Expr, left_own: sp.Expr, right: sp.Expr, right_own: sp.Expr, middle: Slot, lanes: Lanes
) -> tuple[sp.Expr, sp.Expr]:
    """Return one term of a product, over all lanes of the middle slot: (every pair, same lane)."""
    if middle.bank is None:
        return left * right, sp.S.Zero
    across = lanes.sum(left * right, middle.bank)
    return across + left_own * right + left * right_own, left_own * right_own
