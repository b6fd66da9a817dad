"""How the equations of a step hang together: lanes of banks, shared states, sums between lanes.

Input: a program and the slopes of its rates.  Output: a `StepCoupling`: where each slope stands in
one array, and tables from which `run/engine` solves ``(1 - gamma J) d = r``.  The lanes of a bank
are eliminated first, each by itself, and what is left are equations of the shared states.  Where
lanes act on each other through a sum, that sum is a shared unknown more: a border.  A step costs
O(r).
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import accumulate
from typing import final

from piezo_sym.codegen.collocation import Slopes
from piezo_sym.codegen.program import Entry, Program
from piezo_sym.expressions.calculus import add
from piezo_sym.expressions.tree import ZERO, Expr

WIDTH = 96
Place = tuple[int, int]


@final
@dataclass(frozen=True)
class At:
    """A slope and its place: after `shared` numbers, and for each bank after some rows of lanes."""

    shared: int
    lanes: dict[str, int]
    bank: str | None
    value: Expr


@final
@dataclass(frozen=True)
class Bank:
    """The lanes of a bank, as equations.

    Attributes
    ----------
    states : the states that each lane has, by their place among all.
    columns : shared unknowns that occur in a lane's equations.
    rows : shared equations in which a lane's states occur.
    """

    name: str
    states: tuple[int, ...]
    columns: tuple[int, ...]
    rows: tuple[int, ...]


@final
@dataclass(frozen=True)
class Elimination:
    """The order in which shared unknowns are eliminated, and where they fill in.

    A printed step holds it as tables of numbers, and no statement per entry, so that a network of
    600 states has a short text.

    Attributes
    ----------
    slots : the number of each entry, fill-in included.
    order : the unknowns, first to last.
    below : of each pivot in order, row and slot of each entry in its column that comes later.
    right : of each pivot in order, column and slot of each entry in its row that comes later.
    updates : the slots that each pivot changes: its rows below by its columns right, row by row.
    """

    slots: dict[Place, int]
    order: tuple[int, ...]
    below: tuple[tuple[int, ...], ...]
    right: tuple[tuple[int, ...], ...]
    updates: tuple[int, ...]


@final
@dataclass(frozen=True)
class StepCoupling:
    """The structure of a step's equations.

    Attributes
    ----------
    places : the slopes, where they stand.
    sizes : of each bank, how many rows of slopes its lanes have.
    states : the shared states, by their place among all; borders come after them.
    borders : how many there are.
    entries : (row, column) of each slope between shared states.
    banks : in the order of the program.
    solved : the elimination of the shared unknowns.
    """

    places: tuple[At, ...]
    sizes: Mapping[str, int]
    states: tuple[int, ...]
    borders: int
    entries: tuple[tuple[int, int], ...]
    banks: tuple[Bank, ...]
    solved: Elimination

    def tables(self, name: str) -> Iterator[str]:
        """Yield the tables in C."""
        size = len(self.states) + self.borders
        slots = self.solved.slots
        yield "/* The equations of a step: shared unknowns, those of lanes, their elimination. */"
        yield "enum {"
        yield f"    {name}_shared = {len(self.states)}, /* shared states */"
        yield f"    {name}_unknowns = {size}, /* and sums between lanes */"
        yield f"    {name}_slots = {len(slots)}, /* entries between them, fill-in included */"
        yield f"    {name}_entries = {len(self.entries)}, /* slopes between shared states */"
        yield f"    {name}_banks = {len(self.banks)},"
        most = max([1, *(len(bank.states) for bank in self.banks)])
        yield f"    {name}_most_states = {most} /* that a lane has */"
        yield "};"
        yield from table(f"{name}_place", [slots[place] for place in self.entries])
        yield from table(f"{name}_state", self.states)
        yield from table(f"{name}_order", self.solved.order)
        yield from table(f"{name}_pivot", [slots[n, n] for n in self.solved.order])
        yield from _ranges(f"{name}_below", self.solved.below)
        yield from _ranges(f"{name}_right", self.solved.right)
        yield from table(f"{name}_update", self.solved.updates)
        for what in ("states", "columns", "rows"):
            yield from _ranges(f"{name}_lane_{what}", [getattr(b, what) for b in self.banks])
        before = accumulate((len(b.rows) * len(b.columns) for b in self.banks), initial=0)
        yield from table(f"{name}_first", [*before][:-1])
        meets = [slots[r, c] for bank in self.banks for r in bank.rows for c in bank.columns]
        yield from table(f"{name}_meet", meets)


def coupling_of(program: Program, slopes: Slopes) -> StepCoupling:
    """Return the structure of the equations of a step."""
    return _Builder(program, slopes.entries).made()


@final
class _Builder:
    """Finds places for slopes."""

    def __init__(self, program: Program, entries: Sequence[Entry]) -> None:
        self.program, self.entries = program, entries
        self.bank_of = [state.bank for state in program.states]
        self.states = tuple(n for n, bank in enumerate(self.bank_of) if not bank)
        self.index = {state: n for n, state in enumerate(self.states)}
        self.borders: dict[tuple[int, Expr], int] = {}
        for entry in entries:
            for outer in entry.outer:
                key = (entry.col, outer.right)
                self.borders.setdefault(key, len(self.states) + len(self.borders))

    def made(self) -> StepCoupling:
        """Return the structure."""
        shared = [e for e in self.entries if e.row in self.index and e.col in self.index]
        pairs = [(self.index[e.row], self.index[e.col]) for e in shared]
        found = [At(n, {}, None, e.value) for n, e in enumerate(shared)]
        sizes: dict[str, int] = {}
        banks = []
        for name in self.program.counts:
            bank, values = self._bank(name)
            banks.append(bank)
            for n, value in enumerate(values):
                found += [At(len(shared), {**sizes, name: n}, name, value)]
            sizes[name] = len(values)
        size = len(self.states) + len(self.borders)
        meets = [(r, c) for bank in banks for r in bank.rows for c in bank.columns]
        solved = elimination(size, [*pairs, *meets])
        return StepCoupling(
            tuple(found),
            sizes,
            self.states,
            len(self.borders),
            tuple(pairs),
            tuple(banks),
            solved,
        )

    def _bank(self, name: str) -> tuple[Bank, list[Expr]]:
        """Return a bank, and its slopes: in a lane, by shared unknowns, in shared equations."""
        states = tuple(n for n, bank in enumerate(self.bank_of) if bank == name)
        own = {(e.row, e.col): e.value for e in self.entries}
        by: dict[tuple[int, int], Expr] = {}
        into: dict[tuple[int, int], Expr] = {}
        for e in self.entries:
            if e.row in states:
                if e.col in self.index:
                    by[e.row, self.index[e.col]] = e.value
                for outer in e.outer:
                    key = e.row, self.borders[e.col, outer.right]
                    by[key] = add(by.get(key, ZERO), outer.left)
            if e.col in states and e.row in self.index:
                into[self.index[e.row], e.col] = e.value
        for (col, right), border in self.borders.items():
            if col in states:
                into[border, col] = right
        columns = tuple(sorted({column for _, column in by}))
        rows = tuple(sorted({row for row, _ in into}))
        values = [own.get((a, b), ZERO) for a in states for b in states]
        values += [by.get((a, column), ZERO) for a in states for column in columns]
        values += [into.get((row, b), ZERO) for row in rows for b in states]
        return Bank(name, states, columns, rows), values


def elimination(size: int, places: Iterable[Place]) -> Elimination:
    """Return the elimination of a matrix with these entries, and its diagonal.

    Pivots stay on the diagonal; the unknown that touches fewest entries goes first (Markowitz).
    """
    rows: list[set[int]] = [{n} for n in range(size)]
    columns: list[set[int]] = [{n} for n in range(size)]
    for row, column in places:
        rows[row].add(column)
        columns[column].add(row)
    left, order = set(range(size)), list[int]()
    below, right = list[tuple[int, ...]](), list[tuple[int, ...]]()
    while left:
        n = min(left, key=lambda n: ((len(rows[n] & left) - 1) * (len(columns[n] & left) - 1), n))
        left.remove(n)
        order.append(n)
        below.append(tuple(sorted(columns[n] & left)))
        right.append(tuple(sorted(rows[n] & left)))
        for row in below[-1]:
            rows[row].update(right[-1])
        for column in right[-1]:
            columns[column].update(below[-1])
    filled = sorted((row, column) for row in range(size) for column in rows[row])
    slots = {place: n for n, place in enumerate(filled)}
    pivots = tuple(zip(order, below, right, strict=True))
    return Elimination(
        slots,
        tuple(order),
        tuple(tuple(k for r in below for k in (r, slots[r, n])) for n, below, _ in pivots),
        tuple(tuple(k for c in right for k in (c, slots[n, c])) for n, _, right in pivots),
        tuple(slots[r, c] for _, below, right in pivots for r in below for c in right),
    )


def _ranges(name: str, parts: Sequence[Sequence[int]]) -> Iterator[str]:
    """Yield a table of lists, and where each begins and the last ends."""
    yield from table(f"{name}_at", [*accumulate(map(len, parts), initial=0)])
    yield from table(name, [n for part in parts for n in part])


def table(name: str, numbers: Sequence[int]) -> Iterator[str]:
    """Yield a table of numbers; one that is empty has a zero, since C has no empty arrays."""
    yield f"static const int {name}[] = {{"
    line = "   "
    for n in numbers or (0,):
        if len(line) + len(f" {n},") > WIDTH:
            yield line
            line = "   "
        line += f" {n},"
    yield from (line, "};")
