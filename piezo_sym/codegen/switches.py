"""Comparisons as switches, so that a law takes the branches that a step gives it.

Input: values with kinks.  Output: the same values with choices by a given branch in place of a
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
from piezo_sym.spec.tables import greater

NOTE = "switching functions"


@final
@dataclass(frozen=True)
class Switch:
    """A comparison: the name of its branch, and the switching function whose sign decides it."""

    branch: str
    value: Sym
    bank: str | None  # the bank with one branch per lane, or None
    strict: bool  # whether the branch is 0 where the switching function is zero


@final
@dataclass(frozen=True)
class SwitchedValues:
    """Values whose choices are made by branches."""

    quantities: tuple[Quantity, ...]  # each after the switching functions that it needs
    rows: tuple[OutputRow, ...]  # in the order given
    switches: tuple[Switch, ...]  # in the order in which they are met
    bends: tuple[OutputRow, ...]  # functions whose sign changes where a mean has a kink
    lanes: Mapping[str, str]  # the bank of every name that has a value per lane


def switched_values(
    quantities: Iterable[Quantity],
    rows: Iterable[OutputRow],
    lanes: Mapping[str, str],
    new: Names,
    *,
    means: Sequence[Quantity] = (),
    compared_names: Collection[str] = (),
) -> SwitchedValues:
    """Return quantities and rows whose choices are made by branches.

    Parameters
    ----------
    lanes : the bank of every name that has a value per lane.
    new : gives names to branches and switching functions.
    means : functions of the state at whose kinks steps end, too; no law takes their branches.
    compared_names : quantities whose choices are made by comparisons all the same.
    """
    switches = _Switches(dict(lanes), new)
    for quantity in quantities:
        if quantity.name in compared_names:
            value = compared(quantity.value)
        else:
            value = switches.by_branches(quantity.value)
            if not isinstance(value, If):
                value = switches.with_named_choices(value, quantity)
        switches.values.append(replace(quantity, value=value))
    switched = tuple(replace(r, value=switches.by_branches(r.value)) for r in rows)
    bends = tuple(switches.bends(means))
    met = tuple(switches.by_condition.values())
    return SwitchedValues(tuple(switches.values), switched, met, bends, switches.lanes)


@final
class _Switches:
    """The switches met so far, and the values, each after the switching functions it needs."""

    def __init__(self, lanes: dict[str, str], new: Names) -> None:
        self.lanes, self.new = lanes, new
        self.by_condition: dict[Cmp, Switch] = {}
        self.values: list[Quantity] = []

    def by_branches(self, value: Expr) -> Expr:
        """Return a value whose choices are made by branches."""
        inner = rebuild(choices(value), self.by_branches)
        match inner:
            case If(then, condition, other):
                return If(then, self._branch(condition), other)
        return inner

    def with_named_choices(self, value: Expr, quantity: Quantity) -> Expr:
        """Return a value whose choices are quantities of their own."""
        if not isinstance(value, If):
            return rebuild(value, lambda part: self.with_named_choices(part, quantity))
        name, bank = self.new(f"chosen_{quantity.name}"), bank_of(value, self.lanes)
        self._define(Quantity(name, value, bank, quantity.note))
        return Sym(name)

    def bends(self, means: Iterable[Quantity]) -> Iterator[OutputRow]:
        """Yield the functions whose signs change where means have kinks, once each."""
        met = set[Expr]()
        for condition in (kink for mean in means for kink in kinks(compared(mean.value))):
            value = add(condition.left, neg(condition.right))
            if met.isdisjoint({value, neg(value)}):
                met.add(value)
                self._branch(Cmp(">", self.by_branches(value), ZERO))
                yield OutputRow(Slot(f"bend_{len(met)}", bank_of(value, self.lanes)), value)

    def _define(self, quantity: Quantity) -> None:
        self.values.append(quantity)
        if quantity.bank:
            self.lanes[quantity.name] = quantity.bank

    def _branch(self, condition: Cmp) -> Cmp:
        """Return the comparison of the branch with 0 that replaces a condition."""
        if condition not in self.by_condition:
            test = greater(condition)
            bank, n = bank_of(condition, self.lanes), len(self.by_condition) + 1
            branch, name = self.new(f"branch_{n}"), self.new(f"switch_{n}")
            self._define(Quantity(name, add(test.left, neg(test.right)), bank, NOTE))
            self.lanes |= {branch: bank} if bank else {}
            self.by_condition[condition] = Switch(branch, Sym(name), bank, "=" not in test.op)
        return Cmp(">", Sym(self.by_condition[condition].branch), ZERO)
