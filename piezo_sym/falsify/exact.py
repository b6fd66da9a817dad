"""Exact evaluation of suspicious points: in rationals where possible, else in enclosures.

Input: a `Space`, and numbers for its columns (floats are rationals).  Output: a `Point`, whose
quantities are nan where `BITS` do not suffice; what breaks a row there, as text (`broken`).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from functools import cached_property
from typing import Any, final

from flint import arb, ctx, fmpq

from piezo_sym.expressions.exact_eval import TooCloseError, evaluated, exact, holds
from piezo_sym.expressions.floats import Row
from piezo_sym.expressions.tree import Cmp, Expr, LaneSum, names
from piezo_sym.falsify.claims import Claim
from piezo_sym.falsify.space import Array, Space

#: Precision of enclosures [bit]: the numbers of a point may be 600 decades apart.
BITS = 4096
#: Points with more lanes per bank are left out, as rows are attacked with two lanes as well.
MOST_LANES = 64
#: Rationals with more bits become enclosures.
MOST_BITS = 40_000
NAN = arb("nan")


def broken(claim: Claim, space: Space, point: Array) -> str | None:
    """Return what breaks a row at a point of the domain, or None."""
    at = Point(space, point.tolist())
    if not at.inside:
        return None
    if claim.id == "welldef":
        return "a law has no value" if at.undefined(claim.element) else None
    for said in claim.says if all(map(at.holds, claim.where)) else ():
        for value in at.values([(said.value, said.bank)]):
            if value < 0 or (said.strict and value == 0):
                return f"{said.name} = {text(value)}"
    return None


@final
class Point:
    """The quantities of a system at a point."""

    def __init__(self, space: Space, values: Sequence[float | Fraction]) -> None:
        numbers = [exact(value) for value in values]
        self.probe, self.counts = space.probe, space.counts
        self.numbers = {name: numbers[columns] for name, columns in space.columns_of.items()}
        self.banks = space.banks
        self._lanes = [_Lane(self, n) for n in range(max(self.counts.values(), default=1))]

    def lanes(self, bank: str | None) -> list[_Lane]:
        """Return the lanes of a bank; the first lane without a bank."""
        return self._lanes[: self.counts[bank] if bank else 1]

    def values(self, rows: Iterable[Row]) -> list[Any]:
        """Return the values of trees, one per lane of each."""
        with ctx.workprec(BITS):
            return [lane.value(tree) for tree, bank in rows for lane in self.lanes(bank)]

    @cached_property
    def inside(self) -> bool | None:
        """Whether the point is in the domain; None if undecided."""
        if max(self.counts.values(), default=0) > MOST_LANES:
            return None
        results = {self.holds(condition.tree) for condition in self.probe.iphs.circuit.conditions}
        return False if False in results else None if None in results else True

    def holds(self, condition: Cmp) -> bool | None:
        """Return whether a condition holds in every lane; None if undecided."""
        bank = next(filter(None, map(self.bank, names(condition))), None)
        try:
            return all(holds(condition, lane, BITS) for lane in self.lanes(bank))
        except TooCloseError:
            return None
        except (ArithmeticError, ValueError):
            return False

    def bank(self, name: str) -> str | None:
        """Return the bank of a name, or None."""
        return self.banks[name] if name in self.banks else self.probe.defined[name][1]

    def undefined(self, element: str) -> bool:
        """Return whether a law of an element (of the junction for "") certainly has no value."""
        laws = self.probe.of_element.get(element, ())
        return any(lane.is_undefined(tree) for tree, bank in laws for lane in self.lanes(bank))


@final
class _Lane(dict[Any, Any]):
    """The values of names and of sums over lanes in one lane, computed on demand."""

    def __init__(self, point: Point, number: int) -> None:
        super().__init__()
        self.point, self.number = point, number

    def __missing__(self, key: str | LaneSum) -> Any:
        """Compute a value, and keep it."""
        self[key] = self._computed(key)
        return self[key]

    def _computed(self, key: str | LaneSum) -> Any:
        point = self.point
        if isinstance(key, LaneSum):
            return sum((lane.value(key.arg) for lane in point.lanes(key.bank)), start=fmpq(0))
        if key in point.numbers:
            return point.numbers[key][self.number % len(point.numbers[key])]
        if self.number and point.bank(key) is None:
            return point.lanes(None)[0][key]
        return self.value(point.probe.defined[key][0])

    def value(self, tree: Expr) -> Any:
        """Return the value of a tree; nan if it has none or is undecided."""
        try:
            found = evaluated(tree, self, BITS)
        except (ArithmeticError, ValueError):
            return NAN
        return arb(found) if isinstance(found, fmpq) and found.height_bits() > MOST_BITS else found

    def is_undefined(self, tree: Expr) -> bool:
        """Return whether a tree certainly has no value."""
        try:
            evaluated(tree, self, BITS)
        except TooCloseError:
            return False
        except (ArithmeticError, ValueError):
            return True
        return False


def text(number: Any) -> str:
    """Return an exact value as text: a short fraction, or 17 digits."""
    short = str(number)
    if isinstance(number, arb) or len(short) > 40:
        return str(arb(exact(number)).mid().str(17, radius=False))
    return short
