"""Large functions in parts: the time of compilers grows with the square of a function's length.

Input: what a function computes and writes.  Output: the writes of each part.  A part computes all
that it needs, even what other parts compute, too, so that parts share nothing; writes that read
neighbouring fields of the state are put into one part.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import final

from piezo_sym.codegen.c.lines import Write
from piezo_sym.codegen.program import Described, Quantity
from piezo_sym.expressions.tree import Expr, LaneSum, names

#: A function with this many statements is printed in parts; about the statements of a part.
LARGE, OF_A_PART = 1000, 250
#: The most statements of all parts together, over those of the whole function.
MOST_AGAIN = 2


@final
@dataclass(frozen=True)
class _Needs:
    """What a value needs: quantities, as bits; the first field it reads; a loop over lanes."""

    quantities: int = 0
    first: float = 1.0  # as a fraction of its array, since all arrays follow the order of elements
    loop: bool = False


def in_parts(
    quantities: Sequence[Quantity], writes: Sequence[Write], fields: Iterable[Sequence[Described]]
) -> tuple[list[list[Write]], Sequence[Write]]:
    """Return the writes of each part of a function, and the others: those with loops over lanes.

    `fields` are those of each array of states, means or branches.
    """
    if len(quantities) + len(writes) < LARGE:
        return [], writes
    known = {
        field.name: _Needs(first=n / len(array))
        for array in fields
        for n, field in enumerate(array)
    }

    def needs(value: Expr, bits: int = 0, *, loop: bool = False) -> _Needs:
        found = [known[name] for name in names(value) if name in known]
        for part in found:
            bits |= part.quantities
        first = min((part.first for part in found), default=1.0)
        return _Needs(bits, first, loop or any(part.loop for part in found))

    for n, quantity in enumerate(quantities):
        loop = quantity.bank is not None or isinstance(quantity.value, LaneSum)
        known[quantity.name] = needs(quantity.value, 1 << n, loop=loop)
    found = [needs(write.value, loop=write.bank is not None) for write in writes]
    groups = [*_groups([n for n, part in enumerate(found) if not part.loop], found)]
    statements = sum(_size(group, found) for group in groups)
    whole = _size([n for group in groups for n in group], found)
    if len(groups) < 2 or statements > MOST_AGAIN * whole:
        return [], writes
    left = [write for write, part in zip(writes, found, strict=True) if part.loop]
    return [[writes[n] for n in group] for group in groups], left


def _groups(rows: Sequence[int], needs: Sequence[_Needs]) -> Iterator[list[int]]:
    """Yield groups of neighbouring rows, each in order."""
    group: list[int] = []
    for n in sorted(rows, key=lambda n: needs[n].first):
        if group and _size([*group, n], needs) > OF_A_PART:
            yield sorted(group)
            group = []
        group.append(n)
    if group:
        yield sorted(group)


def _size(rows: Sequence[int], needs: Sequence[_Needs]) -> int:
    """Return how many statements compute and write some rows."""
    bits = 0
    for n in rows:
        bits |= needs[n].quantities
    return bits.bit_count() + len(rows)
