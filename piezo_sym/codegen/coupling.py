"""The structure of the equations of a step: lanes of banks, shared states, sums over lanes.

Input: a program and the slopes of its rates.  Output: a `StepCoupling`: the place of each slope in
one array, and tables by which `run/engine` solves ``(1 - gamma J) d = r``.  The lanes of a bank are
eliminated first, each by itself, which leaves equations of the shared states.  A sum through which
lanes act on each other is an additional shared unknown: a border.  A step costs O(r).
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from heapq import heapify, heappop, heappush
from itertools import accumulate
from textwrap import wrap
from typing import final

from piezo_sym.codegen.collocation import Slopes
from piezo_sym.codegen.program import Entry, Program
from piezo_sym.expressions.calculus import add
from piezo_sym.expressions.tree import ZERO, Expr

WIDTH = 96
Place = tuple[int, int]


@final
@dataclass(frozen=True)
class Bank:
    """The equations of the lanes of a bank."""

    name: str
    states: tuple[int, ...]  # the states of a lane, by their place among all states
    columns: tuple[int, ...]  # the shared unknowns in a lane's equations
    rows: tuple[int, ...]  # the shared equations in which a lane's states occur
    #: The slopes in a lane: by its own states, by `columns`, and of `rows` by its states.
    slopes: tuple[Expr, ...]


@final
@dataclass(frozen=True)
class Elimination:
    """The order in which shared unknowns are eliminated, and the fill-in.

    A printed step has it as tables of numbers instead of a statement per entry, so that the text
    stays short for a network of 600 states.
    """

    slots: dict[Place, int]  # the number of each entry, fill-in included
    order: tuple[int, ...]  # the unknowns, first to last
    #: For each pivot in order, row and slot of each later entry in its column.
    below: tuple[tuple[int, ...], ...]
    #: For each pivot in order, column and slot of each later entry in its row.
    right: tuple[tuple[int, ...], ...]
    #: The slots that each pivot changes: rows `below` by columns `right`, row by row.
    updates: tuple[int, ...]


@final
@dataclass(frozen=True)
class StepCoupling:
    """The structure of a step's equations.

    In the array of slopes, those between shared states come first, then those of each bank, each
    slope of a bank as a row of lanes.
    """

    #: The shared states, by their place among all states; borders come after them.
    states: tuple[int, ...]
    borders: int  # the number of borders
    entries: dict[Place, Expr]  # the slopes between shared states, by (row, column)
    banks: tuple[Bank, ...]  # in the order of the program
    elimination: Elimination  # of the shared unknowns

    def tables(self, name: str) -> Iterator[str]:
        """Yield the tables in C."""
        size = len(self.states) + self.borders
        slots, order = self.elimination.slots, self.elimination.order
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
        yield from table(f"{name}_order", order)
        yield from table(f"{name}_pivot", [slots[n, n] for n in order])
        yield from _ranges(f"{name}_below", self.elimination.below)
        yield from _ranges(f"{name}_right", self.elimination.right)
        yield from table(f"{name}_update", self.elimination.updates)
        for what in ("states", "columns", "rows"):
            yield from _ranges(f"{name}_lane_{what}", [getattr(b, what) for b in self.banks])
        before = accumulate((len(b.rows) * len(b.columns) for b in self.banks), initial=0)
        yield from table(f"{name}_first", [*before][:-1])
        meets = [slots[r, c] for bank in self.banks for r in bank.rows for c in bank.columns]
        yield from table(f"{name}_meet", meets)


def coupling_of(program: Program, slopes: Slopes) -> StepCoupling:
    """Return the structure of the equations of a step."""
    states = tuple(n for n, state in enumerate(program.states) if not state.bank)
    index = {state: n for n, state in enumerate(states)}
    shared = {
        (index[e.row], index[e.col]): e.value
        for e in slopes.entries
        if e.row in index and e.col in index
    }
    sums = dict.fromkeys((e.col, outer.right) for e in slopes.entries for outer in e.outer)
    borders = {key: n for n, key in enumerate(sums, len(states))}
    banks = []
    for name in program.counts:
        own = tuple(n for n, state in enumerate(program.states) if state.bank == name)
        banks.append(_bank(name, own, slopes.entries, index, borders))
    meets = [(r, c) for bank in banks for r in bank.rows for c in bank.columns]
    order = elimination(len(states) + len(borders), [*shared, *meets])
    return StepCoupling(states, len(borders), shared, tuple(banks), order)


def _bank(
    name: str,
    states: tuple[int, ...],
    entries: Sequence[Entry],
    index: Mapping[int, int],
    borders: Mapping[tuple[int, Expr], int],
) -> Bank:
    """Return a bank; `index` has the numbers of shared states, `borders` those of sums."""
    in_lane = {(e.row, e.col): e.value for e in entries}
    by_shared: dict[Place, Expr] = {}
    in_shared: dict[Place, Expr] = {}
    for e in entries:
        if e.row in states:
            if e.col in index:
                by_shared[e.row, index[e.col]] = e.value
            for outer in e.outer:
                key = e.row, borders[e.col, outer.right]
                by_shared[key] = add(by_shared.get(key, ZERO), outer.left)
        if e.col in states and e.row in index:
            in_shared[index[e.row], e.col] = e.value
    for (col, right), border in borders.items():
        if col in states:
            in_shared[border, col] = right
    columns = tuple(sorted({column for _, column in by_shared}))
    rows = tuple(sorted({row for row, _ in in_shared}))
    values = [in_lane.get((a, b), ZERO) for a in states for b in states]
    values += [by_shared.get((a, column), ZERO) for a in states for column in columns]
    values += [in_shared.get((row, b), ZERO) for row in rows for b in states]
    return Bank(name, states, columns, rows, tuple(values))


def elimination(size: int, places: Iterable[Place]) -> Elimination:
    """Return the elimination of a matrix that has these entries and its diagonal.

    Pivots are on the diagonal, in Markowitz's order: the one with the least fill-in first.
    """
    rows: list[set[int]] = [{n} for n in range(size)]
    columns: list[set[int]] = [{n} for n in range(size)]
    for row, column in places:
        rows[row].add(column)
        columns[column].add(row)
    left, order = set(range(size)), list[int]()
    below, right = list[tuple[int, ...]](), list[tuple[int, ...]]()

    def cost(n: int) -> tuple[int, int]:
        return (len(rows[n] & left) - 1) * (len(columns[n] & left) - 1), n

    costs = [cost(n) for n in left]
    heapify(costs)
    while costs:
        n = (least := heappop(costs))[1]
        if n not in left or cost(n) != least:  # it was pushed again when it changed
            continue
        left.remove(n)
        order.append(n)
        below.append(tuple(sorted(columns[n] & left)))
        right.append(tuple(sorted(rows[n] & left)))
        for row in below[-1]:
            rows[row].update(right[-1])
        for column in right[-1]:
            columns[column].update(below[-1])
        for changed in {*below[-1], *right[-1]}:
            heappush(costs, cost(changed))
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
    """Yield the table of the bounds of some lists, and that of their items."""
    yield from table(f"{name}_at", [*accumulate(map(len, parts), initial=0)])
    yield from table(name, [n for part in parts for n in part])


def table(name: str, numbers: Sequence[int]) -> Iterator[str]:
    """Yield a table of numbers; an empty one gets a zero, since C has no empty arrays."""
    yield f"static const int {name}[] = {{"
    text = " ".join(f"{n}," for n in numbers or (0,))
    yield from (f"    {line}" for line in wrap(text, WIDTH - 4))
    yield "};"
