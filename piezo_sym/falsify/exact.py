"""A suspicious point evaluated again, exactly: rationals where all is, else enclosures that decide.

Input: a `Probe`, and numbers for parameters, inputs and states (floats are rationals).  Output: a
`Point`, whose quantities are nan where `BITS` do not tell them; what breaks a row there, as text
(`Exact`).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from functools import cached_property
from typing import Any, final

from flint import arb, ctx, fmpq

from piezo_sym.expressions.exact_eval import TooCloseError, evaluated, exact, holds
from piezo_sym.expressions.tree import Cmp, Expr, LaneSum, names
from piezo_sym.falsify.claims import Claim
from piezo_sym.falsify.floats import Row
from piezo_sym.falsify.probe import Probe
from piezo_sym.falsify.space import Array, Space
from piezo_sym.spec.tables import conditions

#: Precision of enclosures: the numbers of a point may be 600 decades apart.
BITS = 4096
#: A point of more lanes is not computed; two at a time are attacked as well.
MOST_LANES = 64
#: Rationals of more bits become enclosures.
MOST_BITS = 40_000
NAN = arb("nan")


@final
class Exact:
    """Evaluates rows of one system."""

    def __init__(self, probe: Probe) -> None:
        self.probe = probe
        self.conditions = [condition.tree for condition in conditions(probe.iphs.model)]
        self.points: dict[tuple[Any, ...], Point] = {}

    def at(self, space: Space, values: Sequence[float | Fraction]) -> Point:
        """Return what the system is at a point, computed once for all claims."""
        key = (*space.counts.items(), *values)
        if key not in self.points:
            self.points[key] = Point(self, space, values)
        return self.points[key]

    def broken(self, claim: Claim, space: Space, point: Array) -> str | None:
        """Return what breaks a row at a point of the domain, or None."""
        at = self.at(space, point.tolist())
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
    """What a system is at a point."""

    def __init__(self, system: Exact, space: Space, values: Sequence[float | Fraction]) -> None:
        numbers = [exact(value) for value in values]
        self.system, self.probe, self.counts = system, system.probe, space.counts
        self.numbers = {name: numbers[columns] for name, columns in space.columns_of.items()}
        self.banks = space.banks
        self._lanes = [_Lane(self, n) for n in range(max(self.counts.values(), default=1))]

    def lanes(self, bank: str | None) -> list[_Lane]:
        """Return the lanes of a bank; without a bank, the first."""
        return self._lanes[: self.counts[bank] if bank else 1]

    def values(self, rows: Iterable[Row]) -> list[Any]:
        """Return the values of trees, one per lane of each."""
        with ctx.workprec(BITS):
            return [lane.told(tree) for tree, bank in rows for lane in self.lanes(bank)]

    @cached_property
    def inside(self) -> bool | None:
        """Whether the point is in the domain; None if it cannot be told."""
        if max(self.counts.values(), default=0) > MOST_LANES:
            return None
        told = {self.holds(condition) for condition in self.system.conditions}
        return False if False in told else None if None in told else True

    def holds(self, condition: Cmp) -> bool | None:
        """Return whether a condition holds, in every lane; None if it cannot be told."""
        bank = next(filter(None, map(self.bank, names(condition))), None)
        try:
            return all(holds(condition, lane, BITS) for lane in self.lanes(bank))
        except TooCloseError:
            return None
        except (ArithmeticError, ValueError):
            return False

    def bank(self, name: str) -> str | None:
        """Return the bank of a name that has a value per lane."""
        return self.banks[name] if name in self.banks else self.probe.defined[name][1]

    def undefined(self, element: str) -> bool:
        """Return whether a law of an element has no value; without a name, one of the junction."""
        laws = self.probe.of_element(element)
        return any(lane.lost(tree) for tree, bank in laws for lane in self.lanes(bank))


@final
class _Lane(dict[Any, Any]):
    """What a name, or a sum over lanes, is worth in one lane; computed when it is asked for."""

    def __init__(self, point: Point, number: int) -> None:
        super().__init__()
        self.point, self.number = point, number

    def __missing__(self, key: str | LaneSum) -> Any:
        """Return a value, which is kept."""
        self[key] = self._made(key)
        return self[key]

    def _made(self, key: str | LaneSum) -> Any:
        point = self.point
        if isinstance(key, LaneSum):
            return sum((lane.told(key.arg) for lane in point.lanes(key.bank)), start=fmpq(0))
        if key in point.numbers:
            return point.numbers[key][self.number % len(point.numbers[key])]
        if self.number and point.bank(key) is None:
            return point.lanes(None)[0][key]
        return self.told(point.probe.defined[key][0])

    def told(self, tree: Expr) -> Any:
        """Return the value of a tree; nan if it has none or it cannot be told."""
        try:
            found = evaluated(tree, self, BITS)
        except (ArithmeticError, ValueError):
            return NAN
        return arb(found) if isinstance(found, fmpq) and found.height_bits() > MOST_BITS else found

    def lost(self, tree: Expr) -> bool:
        """Return whether a tree has certainly no value."""
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
