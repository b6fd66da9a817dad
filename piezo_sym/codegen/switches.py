"""Comparisons as switches, so that a law keeps the branches that a step gives it.

Input: values whose laws choose.  Output: the same values with choices by a branch in place of a
comparison, and the switching functions: a branch is 1 where its switching function is positive (or
zero, for <= and >=), else 0.  Every kink is such a choice: ``abs(z)`` is ``z if z >= 0 else -z``, a
dead zone ``z - w if z > w else (z + w if z < -w else 0)``.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import final

from piezo_sym.algebra.lanes import Slot
from piezo_sym.codegen.program import Quantity, Row, bank_of
from piezo_sym.expressions.calculus import add, choices, kinks, neg
from piezo_sym.expressions.tree import ZERO, Cmp, Expr, If, Sym, names, rebuild

NOTE = "switching functions"


@final
@dataclass(frozen=True)
class Switch:
    """A comparison: the name of its branch, and the switching function whose sign decides it.

    Attributes
    ----------
    bank : whose lanes have a branch each, or None.
    strict : whether the branch is 0 where the switching function is zero.
    """

    branch: str
    value: Sym
    bank: str | None
    strict: bool


@final
class Switches:
    """The switches of some values, in the order in which they are met.

    Parameters
    ----------
    lanes : the bank of each name that has a value per lane; grows by the switching functions.
    name : returns a fresh name, and takes it.
    """

    def __init__(self, lanes: dict[str, str], name: Callable[[str], str]) -> None:
        self.lanes, self.name = lanes, name
        self.found: dict[Cmp, Switch] = {}
        self._new: list[Quantity] = []

    def quantities(
        self, given: Iterable[Quantity], free: Collection[str] = ()
    ) -> Iterator[Quantity]:
        """Yield quantities that choose by branches, each after the switching functions it needs.

        Those named in `free` choose by comparisons.
        """
        for quantity in given:
            if quantity.name in free:
                yield replace(quantity, value=compared(quantity.value))
                continue
            value = self.chosen(quantity.value, quantity.bank)
            if not isinstance(value, If):
                value = self._named(value, quantity)
            yield from self.new()
            yield replace(quantity, value=value)

    def rows(self, given: Iterable[Row]) -> tuple[Row, ...]:
        """Return rows that choose by branches; `new` has what they need."""
        return tuple(replace(r, value=self.chosen(r.value, r.slot.bank)) for r in given)

    def new(self) -> tuple[Quantity, ...]:
        """Return the switching functions met since this was asked last."""
        new, self._new = tuple(self._new), []
        return new

    def chosen(self, value: Expr, bank: str | None) -> Expr:
        """Return a value that chooses by branches, itself one per lane of `bank` or shared."""
        inner = rebuild(choices(value), lambda part: self.chosen(part, bank))
        match inner:
            case If(then, condition, other):
                return If(then, self._branch(condition), other)
        return inner

    def bends(self, means: Iterable[Quantity]) -> tuple[Row, ...]:
        """Return what changes its sign where `means` have kinks; each is a switching function, too.

        Nobody takes its branch: a step ends there, as at a kink of a law.
        """
        found = list[Row]()
        for condition in (kink for mean in means for kink in kinks(compared(mean.value))):
            value = add(condition.left, neg(condition.right))
            if any(row.value in (value, neg(value)) for row in found):
                continue
            bank = bank_of(value, self.lanes)
            self._branch(Cmp(">", self.chosen(value, bank), ZERO))
            found.append(Row(Slot(f"bend_{len(found) + 1}", bank), value))
        return tuple(found)

    def _named(self, value: Expr, quantity: Quantity) -> Expr:
        """Return a value whose choices are quantities of their own."""
        if not isinstance(value, If):
            return rebuild(value, lambda part: self._named(part, quantity))
        name, bank = self.name(f"chosen_{quantity.name}"), bank_of(value, self.lanes)
        self._new.append(Quantity(name, value, bank, quantity.note))
        if bank:
            self.lanes[name] = bank
        return Sym(name)

    def _branch(self, condition: Cmp) -> Cmp:
        if condition not in self.found:
            left, right = condition.left, condition.right
            sides = (right, left) if condition.op.startswith("<") else (left, right)
            bank, n = bank_of(condition, self.lanes), len(self.found) + 1
            branch, place = self.name(f"branch_{n}"), self.name(f"switch_{n}")
            self._new.append(Quantity(place, add(sides[0], neg(sides[1])), bank, NOTE))
            if bank:
                self.lanes |= {branch: bank, place: bank}
            self.found[condition] = Switch(branch, Sym(place), bank, "=" not in condition.op)
        return Cmp(">", Sym(self.found[condition].branch), ZERO)


def compared(node: Expr) -> Expr:
    """Return an expression whose kinks are choices by comparisons, as no step keeps them."""
    return choices(rebuild(node, compared))


def lanes_of(known: Mapping[str, str], quantities: Iterable[Quantity]) -> dict[str, str]:
    """Return the bank of each name that has a value per lane, quantities among them."""
    return {**known, **{q.name: q.bank for q in quantities if q.bank and names(q.value)}}
