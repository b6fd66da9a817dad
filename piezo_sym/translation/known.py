"""The proved system in normal form, as readers of printed text need it.

`reference` makes a `Proved` from an `IPHS`: the rows of every function, the names that texts may
use, and the places of parts and rows in arrays.  `Rows` are the rows that a printed function
writes: each once, except that values may be added to the entries of a Jacobian of zeros.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import accumulate
from math import prod
from typing import final

from piezo_sym.algebra.lanes import Slot
from piezo_sym.iphs import IPHS
from piezo_sym.translation.field import GeneratorField, Need, NotShownError, Value
from piezo_sym.translation.system_reader import rounded

#: A function and its row; for a Jacobian's entry also its column, and `SAME` or `ALL` lanes.
Key = tuple[str | int, ...]
LEAST, ALL, SAME = "least over lanes", "all lanes", "equal lanes"


@final
@dataclass(frozen=True)
class Layout:
    """The slots of an array, and the place where each starts; the last place is the size."""

    slots: tuple[Slot, ...]
    places: tuple[Value, ...]

    @cached_property
    def _starts(self) -> dict[Value, int]:
        return {place: n for n, place in enumerate(self.places[:-1])}

    def at(self, place: Value, *, bank: bool) -> int:
        """Return the index of the slot that starts at a place; `bank`: whether it is a bank's."""
        n = self._starts.get(place)
        if n is None or bool(self.slots[n].bank) != bank:
            raise NotShownError("a place where no row starts")
        return n


@final
@dataclass(frozen=True)
class Proved:
    """A system in normal form."""

    iphs: IPHS  # the system
    field: GeneratorField  # of all values
    #: Parameters, states and inputs, in lane 0 where they have one per lane.
    names: Mapping[str, Value]
    banks: Mapping[str, str]  # the bank of each of these that has one value per lane
    slots: Mapping[str, tuple[Slot, ...]]  # the rows of each function
    values: Mapping[Key, Value]  # by function and row; what is not listed is zero
    needs: tuple[Need, ...]  # what the laws divide by, and take roots and logarithms of
    #: The margin of each condition of the domain, and whether the condition is strict.
    margins: tuple[tuple[Value, bool], ...]
    means: Mapping[str, Value]  # in a stage: each co-state, by the name of its mean
    #: In a stage: each stop's inner state, its bank, whether each lane has its own drive, and
    #: whether a drive depends on the state.
    paths: tuple[tuple[str, str | None, bool, bool], ...] = ()

    @cached_property
    def numbers(self) -> Mapping[float, Fraction]:
        """The exact numbers of the spec that are rounded in print, by the printed number."""
        return dict(rounded(self.iphs))

    @cached_property
    def layouts(self) -> dict[str, Layout]:
        """The layout of each function's result, and of the arguments x and u."""
        found, inputs = {}, tuple(map(Slot, self.iphs.model.inputs))
        for name, slots in {**self.slots, "x": self.slots["rhs"], "u": inputs}.items():
            rows = (self.sizes[slot.bank] if slot.bank else self.field.one for slot in slots)
            places = accumulate(rows, Value.__add__, initial=self.field.zero)
            found[name] = Layout(slots, tuple(places))
        return found

    @cached_property
    def sizes(self) -> dict[str, Value]:
        """The size of each bank."""
        return {bank: self.field.count(bank) for bank in self.iphs.symbols.counts}

    @cached_property
    def bank_of_size(self) -> dict[Value, str]:
        """The bank of each size."""
        return {size: bank for bank, size in self.sizes.items()}

    def parameter(self, name: str) -> tuple[Value, bool]:
        """Return a parameter that lanes share, or the size of a bank; and whether it is a size."""
        bank = name.removesuffix("_count")
        if bank != name and bank in self.sizes:
            return self.sizes[bank], True
        if name not in self.iphs.model.parameters or name in self.banks:
            raise NotShownError(f"{name} is no parameter that lanes share")
        return self.names[name], False

    def part(self, role: str, place: Value, *, bank: bool) -> Value:
        """Return the entry of x, u or g at a place; with `bank`, that of lane 0 of a bank."""
        layout = self.layouts[role]
        return self.names[layout.slots[layout.at(place, bank=bank)].label]


#: A number of lanes that exceeds the size of any array without banks.
LONG = 10**9


@final
class Rows:
    """The rows that one function writes.

    Attributes
    ----------
    layout, slots, size : the layout of the function's result, its slots, how many rows it has.
    found : the values written so far.
    zeros : whether entries that are not written are zero.
    """

    def __init__(self, known: Proved, name: str) -> None:
        self.known, self.name = known, name
        self.layout = known.layouts.get(name, Layout((), (known.field.zero,)))
        self.slots, self.size = self.layout.slots, self.layout.places[-1]
        self.found: dict[Key, Value] = {}
        self.zeros = False
        self._counts = {g for size in known.sizes.values() for g in size.generators()}
        self._starts = {self._if_long(at): n for n, at in enumerate(self.layout.places[:-1])}

    def keep(self, key: Key, value: Value, *, added: bool = False) -> None:
        """Keep a written value; refuse to overwrite one, or to add to one that is not there."""
        matrix = self.name == "jacobian"
        twin = (*key[:-1], SAME if key[-1] == ALL else ALL)
        again = not added and (key in self.found or (matrix and twin in self.found))
        if again or (matrix and not self.zeros) or (added and not matrix):
            raise NotShownError(f"{self.name}{list(key[1:])} is not written once")
        self.found[key] = self.found[key] + value if key in self.found else value

    def key_at(self, place: Value, banks: tuple[str, ...]) -> Key | None:
        """Return the key of the row at a place, in loops over the lanes of some banks; or None.

        The slots are found as if every bank had `LONG` lanes; then the place must be theirs for
        banks of any size.
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
        """Return the place, in the first lanes, if every bank has `LONG` lanes."""
        total = Fraction(0)
        for mono, c in place.terms.items():
            total += Fraction(c) * prod((LONG * (g in self._counts)) ** int(e) for g, e in mono)
        return int(total)
