"""The rows that a printed function writes, by the place in its result.

Input: what is written where, place by place.  Output: rows by slot, entries by row and column and
whether they are of equal lanes.  Each is written once; to an entry made of zeros more may be added.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import final

from piezo_sym.algebra.lanes import Slot
from piezo_sym.translation.field import NotShownError, Value
from piezo_sym.translation.known import ALL, SAME, Key, Proved


@final
class Rows:
    """What one function writes.

    Attributes
    ----------
    slots, places : the rows of its result, and where each of them starts; the last is the size.
    found : what was written.
    zeros : whether what is not written is zero.
    """

    def __init__(self, known: Proved, name: str) -> None:
        self.known, self.name = known, name
        self.slots = known.slots.get(name, ())
        self.places = known.places(self.slots)
        self.found: dict[Key, Value] = {}
        self.zeros = False
        self._tables: dict[tuple[str, ...], dict[Value, Key]] = {}

    def keep(self, key: Key, value: Value, *, added: bool = False) -> None:
        """Take what is written; refuse what is written over, or added to nothing."""
        matrix = self.name == "jacobian"
        twin = (*key[:-1], SAME if key[-1] == ALL else ALL)
        again = not added and (key in self.found or (matrix and twin in self.found))
        if again or (matrix and not self.zeros) or (added and not matrix):
            raise NotShownError(f"{self.name}{list(key[1:])} is not written once")
        self.found[key] = self.found[key] + value if key in self.found else value

    def key_at(self, place: Value, banks: tuple[str, ...]) -> Key | None:
        """Return what stands at a place that loops over the lanes of some banks write."""
        if banks not in self._tables:
            self._tables[banks] = {at: key for key, at in self._lane_places(banks)}
        return self._tables[banks].get(place)

    def _lane_places(self, banks: Sequence[str]) -> Iterator[tuple[Key, Value]]:
        """Yield the key and the place of all that such loops can write."""
        index = [self.known.field.name("index", bank, n) for n, bank in enumerate(banks)]
        for r, row in enumerate(self.slots):
            if row.bank and [row.bank] != [*banks[:1]]:
                continue
            first = self.places[r] + index[0] if row.bank else self.places[r]
            used = int(row.bank is not None)
            if self.name != "jacobian":
                yield from [((self.name, r), first)] if used == len(banks) else []
                continue
            for c in range(len(self.slots)):
                place = first * self.places[-1] + self.places[c]
                yield from self._entries(r, c, place, banks, used, index)

    def _entries(
        self,
        r: int,
        c: int,
        place: Value,
        banks: Sequence[str],
        used: int,
        index: Sequence[Value],
    ) -> Iterator[tuple[Key, Value]]:
        """Yield the entries of a row's lane (if it is `used`) and of a column."""
        row, col = self.slots[r], self.slots[c]
        if not col.bank and used == len(banks):
            yield ("jacobian", r, c, ALL), place
        if col.bank and [col.bank] == [*banks[used:]]:
            yield ("jacobian", r, c, ALL), place + index[used]
        if col.bank and row.bank and [row.bank] == [col.bank] == [*banks]:
            yield ("jacobian", r, c, SAME), place + index[0]


def slot_at(slots: Sequence[Slot], places: Sequence[Value], place: Value, bank: bool) -> int:
    """Return the slot that starts at a place, a bank's or another.

    Raises
    ------
    NotShownError
        If there is none.
    """
    for n, slot in enumerate(slots):
        if bool(slot.bank) == bank and places[n] == place:
            return n
    raise NotShownError("a place where no row starts")
