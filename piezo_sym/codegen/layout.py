"""The layout of rows in a vector, for banks whose sizes are known at run time only.

Input: slots.  Output: index text, such as ``3 : 3 + hysteron_count``.  If there are many banks, the
end of each bank's rows gets a name, defined once at the head of a function, so that the text grows
with the number of banks, not with its square.
"""

from collections import Counter
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import final

from piezo_sym.algebra.lanes import Slot
from piezo_sym.codegen.program import Names
from piezo_sym.expressions.text import PRODUCT, SUM, Piece, enclose, signed
from piezo_sym.expressions.tree import Add, Expr

#: The most banks whose sizes are added up in each index.
SPELLED = 2


@final
@dataclass(frozen=True)
class Places:
    """The places of slots in a vector."""

    slots: Sequence[Slot]  # one per row, or one for the rows of a bank
    positions: tuple[str, ...]  # of the first row of each slot; the last is the size
    ends: Mapping[str, str]  # names of the ends of banks, and these; empty if indices are sums

    def bounds(self, n: int) -> tuple[str, str]:
        """Return the places of slot n's first row, and of that after its last."""
        return self.positions[n], self.positions[n + 1]

    def index(self, n: int) -> str:
        """Return the index of slot n: a number, or a slice for a bank."""
        first, last = self.bounds(n)
        return f"{first} : {last}" if self.slots[n].bank else first

    @property
    def size(self) -> str:
        """The number of rows."""
        return self.positions[-1]

    def definitions(self) -> Iterator[str]:
        """Yield the lines that define the ends, in order."""
        yield from (f"{name} = {end}" for name, end in self.ends.items())


def places(slots: Sequence[Slot], word: str, taken: Collection[str]) -> Places:
    """Return the places of slots; ends are named after `word` and the slot."""
    named, new = sum(slot.bank is not None for slot in slots) > SPELLED, Names(taken)
    positions, ends, fixed, sizes = ["0"], dict[str, str](), 0, list[str]()
    for slot in slots:
        fixed += slot.bank is None
        sizes += [f"{slot.bank}_count"] if slot.bank else []
        if slot.bank and named:
            name = new(f"{word}_{slot.label.replace('.', '_')}")
            ends[name] = _sum(fixed, sizes)
            fixed, sizes = 0, [name]
        positions.append(_sum(fixed, sizes))
    return Places(slots, tuple(positions), ends)


def size_in_words(slots: Sequence[Slot]) -> str:
    """Return the number of rows, for a docstring."""
    banks = Counter(slot.bank for slot in slots if slot.bank)
    sizes = [f"{n}*{bank}_count" if n > 1 else f"{bank}_count" for bank, n in banks.items()]
    fixed = len(slots) - banks.total()
    if len(banks) <= SPELLED:
        return _sum(fixed, sizes)
    return f"{fixed} + the sizes of {banks.total()} banks"


def term_lines(value: Add, write: Callable[[Expr], Piece]) -> Iterator[str]:
    """Yield one line for each term of a long sum, with its sign."""
    first, *rest = value.terms
    yield enclose(write(first), SUM)
    for term in rest:
        sign, size = signed(term)
        yield f"{sign} {enclose(write(size), PRODUCT)}"


def _sum(fixed: int, sizes: Sequence[str]) -> str:
    return " + ".join([*([str(fixed)] if fixed or not sizes else []), *sizes])
