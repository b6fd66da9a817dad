"""In which order the shared equations of a step are eliminated, and where they fill in.

Input: which entries a matrix has.  Output: an `Elimination`, as tables of numbers: a printed step
holds them, and no statement per entry, so that a network of 600 states has a short text.  Pivots
stay on the diagonal; the unknown that touches fewest entries goes first (Markowitz).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import final

Place = tuple[int, int]


@final
@dataclass(frozen=True)
class Elimination:
    """An elimination of `size` unknowns.

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


def elimination(size: int, places: Iterable[Place]) -> Elimination:
    """Return the elimination of a matrix with these entries, and its diagonal."""
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
