"""The rows that a printed function writes, by the place in its result.

Input: what is written where, place by place.  Output: rows by slot, entries by row and column and
whether they are of equal lanes.  Each is written once; to an entry made of zeros more may be added.
"""

from fractions import Fraction
from math import prod
from typing import final

from piezo_sym.algebra.lanes import Slot
from piezo_sym.translation.field import NotShownError, Value
from piezo_sym.translation.known import ALL, SAME, Key, Layout, Proved

#: More lanes than an array without banks has places.
LONG = 10**9


@final
class Rows:
    """What one function writes.

    Attributes
    ----------
    layout : of its result.
    found : what was written.
    zeros : whether what is not written is zero.
    """

    def __init__(self, known: Proved, name: str) -> None:
        self.known, self.name = known, name
        self.layout = known.layouts.get(name, Layout((), (known.field.zero,)))
        self.found: dict[Key, Value] = {}
        self.zeros = False
        self._ends = {letter: n * LONG for n, letter in enumerate(known.ends, 1)}
        self._starts = {self._if_long(at): n for n, at in enumerate(self.layout.places[:-1])}

    @property
    def slots(self) -> tuple[Slot, ...]:
        """The slots of its result."""
        return self.layout.slots

    @property
    def size(self) -> Value:
        """How many rows its result has."""
        return self.layout.places[-1]

    def keep(self, key: Key, value: Value, *, added: bool = False) -> None:
        """Take what is written; refuse what is written over, or added to nothing."""
        matrix = self.name == "jacobian"
        twin = (*key[:-1], SAME if key[-1] == ALL else ALL)
        again = not added and (key in self.found or (matrix and twin in self.found))
        if again or (matrix and not self.zeros) or (added and not matrix):
            raise NotShownError(f"{self.name}{list(key[1:])} is not written once")
        self.found[key] = self.found[key] + value if key in self.found else value

    def key_at(self, place: Value, banks: tuple[str, ...]) -> Key | None:
        """Return what stands at a place that loops over the lanes of some banks write.

        The place says which slots it is where every bank has `LONG` lanes; it then has to be
        theirs for every size.
        """
        matrix, at, total = self.name == "jacobian", self._if_long(place), self.known.field.zero
        found = [
            self._starts.get(n) for n in (divmod(at, self._if_long(self.size)) if matrix else [at])
        ]
        slots, lanes, steps = [n for n in found if n is not None], list[str](), list[Value]()
        if len(slots) < len(found):
            return None
        for n, step in zip(slots[::-1], (self.known.field.one, self.size), strict=False):
            total = total + self.layout.places[n] * step
            if bank := self.slots[n].bank:
                lanes, steps = [bank, *lanes], [step, *steps]
        same = len(lanes) == 2 and [*banks] == lanes[:1] == lanes[1:]
        lanes, steps = (lanes[:1], [steps[0] + steps[1]]) if same else (lanes, steps)
        for n, (bank, step) in enumerate(zip(lanes, steps, strict=True)):
            total = total + self.known.field.name("index", bank, n) * step
        kind = [SAME if same else ALL] if matrix else []
        return (self.name, *slots, *kind) if [*banks] == lanes and total == place else None

    def _if_long(self, place: Value) -> int:
        """Return a place of the first lanes where every bank has `LONG` lanes."""
        total = Fraction(0)
        for mono, c in place.terms.items():
            total += Fraction(c) * prod(self._ends.get(g, 0) ** int(e) for g, e in mono)
        return int(total)
