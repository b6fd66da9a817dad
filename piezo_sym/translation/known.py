"""The proved system in normal form, as readers of printed text need it.

Input: what `reference` finds in an `IPHS`; this is the type.  Output: the rows of every function,
the names that texts may use, and the places of parts and rows in arrays.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from dataclasses import field as dataclass_field
from fractions import Fraction
from typing import final

from piezo_sym.algebra.lanes import Slot
from piezo_sym.translation.field import Field, Need, NotShownError, Value

#: A function, its row, and for an entry its column and whether it is of equal lanes.
Key = tuple[str | int, ...]
LEAST, ALL, SAME = "least over lanes", "all lanes", "equal lanes"


@final
@dataclass(frozen=True)
class Proved:
    """A system in normal form.

    Attributes
    ----------
    field : of all values.
    names : parameters, states and inputs, in lane 0 where they have one a lane.
    banks : the bank of each of these that has.
    slots : the rows of each function.
    values : by function and row; what is not listed is zero.
    needs : what the laws divide by, and take roots and logarithms of.
    margins : of the conditions of the domain, and whether each is strict.
    numbers : numbers of the spec that have to be rounded to be printed, by what they become.
    parameters, inputs : the names that are parameters, the rows of u.
    placed : what `places` found.
    """

    field: Field
    names: Mapping[str, Value]
    banks: Mapping[str, str]
    slots: Mapping[str, tuple[Slot, ...]]
    values: Mapping[Key, Value]
    needs: tuple[Need, ...]
    margins: tuple[tuple[Value, bool], ...]
    numbers: Mapping[float, Fraction]
    parameters: frozenset[str]
    inputs: tuple[Slot, ...]
    placed: dict[tuple[Slot, ...], list[Value]] = dataclass_field(default_factory=dict)

    def places(self, slots: tuple[Slot, ...]) -> list[Value]:
        """Return where the rows of each slot start, in sizes of banks; and their number."""
        if slots not in self.placed:
            found = [self.field.zero]
            for slot in slots:
                size = self.field.count(slot.bank) if slot.bank else self.field.one
                found.append(found[-1] + size)
            self.placed[slots] = found
        return self.placed[slots]

    @property
    def counts(self) -> dict[str, str]:
        """The bank of each name of a size."""
        return {f"{slot.bank}_count": slot.bank for slot in self.slots["rhs"] if slot.bank}

    def parameter(self, name: str) -> tuple[Value, bool]:
        """Return a parameter that lanes share, or the size of a bank; and whether it is a size."""
        if name in self.counts:
            return self.field.count(self.counts[name]), True
        if name not in self.parameters or name in self.banks:
            raise NotShownError(f"{name} is no parameter that lanes share")
        return self.names[name], False

    def part(self, role: str, place: Value) -> Value:
        """Return the part of x or u at a place, one that lanes share."""
        slots = self.slots["rhs"] if role == "x" else self.inputs
        found = zip(slots, self.places(slots), strict=False)
        name = next((s.label for s, at in found if at == place and not s.bank), None)
        if name is None:
            raise NotShownError(f"a part of {role} that is none")
        return self.names[name]
