"""Comparisons as switches, so that a law keeps the branches that a step gives it.

Input: values whose laws choose.  Output: the same values with choices by a branch in place of a
comparison, and the switching functions: a branch is 1 where its switching function is positive (or
zero, for <= and >=), else 0.  Every kink is such a choice: ``abs(z)`` is ``z if z >= 0 else -z``, a
dead zone ``z - w if z > w else (z + w if z < -w else 0)``.
"""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import final

from piezo_sym.algebra.lanes import Slot
from piezo_sym.codegen.program import Names, OutputRow, Quantity, bank_of
from piezo_sym.expressions.calculus import add, choices, compared, kinks, neg
from piezo_sym.expressions.tree import ZERO, Cmp, Expr, If, Sym, rebuild

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
@dataclass(frozen=True)
class Switched:
    """Values that choose by branches.

    Attributes
    ----------
    quantities : each after the switching functions that it needs.
    rows : in the order given.
    switches : in the order in which they are met.
    bends : what changes its sign where a mean has a kink.
    lanes : the bank of every name that has a value per lane.
    """

    quantities: tuple[Quantity, ...]
    rows: tuple[OutputRow, ...]
    switches: tuple[Switch, ...]
    bends: tuple[OutputRow, ...]
    lanes: Mapping[str, str]


def switched(
    quantities: Iterable[Quantity],
    rows: Iterable[OutputRow],
    lanes: Mapping[str, str],
    new: Names,
    *,
    means: Sequence[Quantity] = (),
    compared_names: Collection[str] = (),
) -> Switched:
    """Return quantities and rows that choose by branches.

    Parameters
    ----------
    lanes : the bank of every name that has a value per lane.
    new : gives names to branches and switching functions.
    means : functions of the state at whose kinks a step ends, too: nobody takes their branches.
    compared_names : quantities that choose by comparisons all the same.
    """
    made = _Switches(dict(lanes), new)
    found = list[Quantity]()
    for quantity in quantities:
        found += made.quantity(quantity, by_branch=quantity.name not in compared_names)
    chosen = tuple(replace(r, value=made.chosen(r.value, r.slot.bank)) for r in rows)
    bends = tuple(made.bends(means))
    found += made.taken()
    return Switched(tuple(found), chosen, tuple(made.found.values()), bends, made.lanes)


@final
class _Switches:
    """The switches met so far."""

    def __init__(self, lanes: dict[str, str], new: Names) -> None:
        self.lanes, self.new = lanes, new
        self.found: dict[Cmp, Switch] = {}
        self.defined: list[Quantity] = []

    def quantity(self, quantity: Quantity, *, by_branch: bool) -> Iterator[Quantity]:
        """Yield a quantity that chooses by branches, after the switching functions it needs."""
        if not by_branch:
            yield replace(quantity, value=compared(quantity.value))
            return
        value = self.chosen(quantity.value, quantity.bank)
        if not isinstance(value, If):
            value = self._named(value, quantity)
        yield from self.taken()
        yield replace(quantity, value=value)

    def taken(self) -> list[Quantity]:
        """Return the quantities defined since this was asked last."""
        found, self.defined = self.defined, []
        return found

    def chosen(self, value: Expr, bank: str | None) -> Expr:
        """Return a value that chooses by branches, itself one per lane of `bank` or shared."""
        inner = rebuild(choices(value), lambda part: self.chosen(part, bank))
        match inner:
            case If(then, condition, other):
                return If(then, self._branch(condition), other)
        return inner

    def bends(self, means: Iterable[Quantity]) -> Iterator[OutputRow]:
        """Yield what changes its sign where means have kinks, once each."""
        met = set[Expr]()
        for condition in (kink for mean in means for kink in kinks(compared(mean.value))):
            value = add(condition.left, neg(condition.right))
            if not met.isdisjoint({value, neg(value)}):
                continue
            met.add(value)
            bank = bank_of(value, self.lanes)
            self._branch(Cmp(">", self.chosen(value, bank), ZERO))
            yield OutputRow(Slot(f"bend_{len(met)}", bank), value)

    def _named(self, value: Expr, quantity: Quantity) -> Expr:
        """Return a value whose choices are quantities of their own."""
        if not isinstance(value, If):
            return rebuild(value, lambda part: self._named(part, quantity))
        name, bank = self.new(f"chosen_{quantity.name}"), bank_of(value, self.lanes)
        self._define(Quantity(name, value, bank, quantity.note))
        return Sym(name)

    def _define(self, quantity: Quantity) -> None:
        self.defined.append(quantity)
        if quantity.bank:
            self.lanes[quantity.name] = quantity.bank

    def _branch(self, condition: Cmp) -> Cmp:
        if condition not in self.found:
            left, right = condition.left, condition.right
            sides = (right, left) if condition.op.startswith("<") else (left, right)
            bank, n = bank_of(condition, self.lanes), len(self.found) + 1
            branch, name = self.new(f"branch_{n}"), self.new(f"switch_{n}")
            self._define(Quantity(name, add(sides[0], neg(sides[1])), bank, NOTE))
            self.lanes |= {branch: bank} if bank else {}
            self.found[condition] = Switch(branch, Sym(name), bank, "=" not in condition.op)
        return Cmp(">", Sym(self.found[condition].branch), ZERO)
