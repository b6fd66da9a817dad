"""The Jacobian of the rates, by the chain rule through the named quantities.

Input: the rows of `rhs` and the quantities they use.  Output: a `Jacobian`, and the derivatives
that deserve a name (``dT_dS``) as further quantities.  Its structure is found here, once: an entry
that is not listed is zero for every state and every r.

The derivative of one value by one state is a `_Slope`: `value`, in the lane that either of them has
(in equal lanes, if both have one), plus products over all pairs of lanes where a sum over lanes
lies between them.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import final

from piezo_sym.codegen.program import Entry, Field, Jacobian, Outer, Quantity, Row, bank_of, needed
from piezo_sym.codegen.quantities import Quantities
from piezo_sym.expressions.calculus import add, derivative, mul
from piezo_sym.expressions.tree import ZERO, Expr, LaneSum, Num, Sym, names


@final
@dataclass(frozen=True)
class _Slope:
    """A derivative by one state; see the module's head."""

    value: Expr = ZERO
    outer: tuple[Outer, ...] = ()


@final
@dataclass(frozen=True)
class Given:
    """A name that stands for no expression, and its derivative by a state."""

    name: str
    state: str
    slope: Expr


def jacobian_of(
    rates: tuple[Row, ...],
    states: tuple[Field, ...],
    lanes: Mapping[str, str],
    q: Quantities,
    given: Iterable[Given] = (),
) -> Jacobian:
    """Return the derivative of `rates` by `states`; adds the named derivatives to `q`.

    Parameters
    ----------
    rates : rows of the right-hand side, one per state.
    states : the states, in the same order.
    lanes : the bank of every parameter and state that has a value per lane.
    q : the quantities; grows by the derivatives that get a name.
    given : names that are no quantities, and depend on a state all the same.
    """
    before, _ = needed(q.defined, (rate.value for rate in rates))
    known = {**lanes, **{item.name: item.bank for item in before if item.bank}}
    words = [(quantity, names(quantity.value)) for quantity in before]
    rows = [(row, rate, names(rate.value)) for row, rate in enumerate(rates)]
    found: list[Entry] = []
    for col, state in enumerate(states):
        chain = _Chain(state, dict(known), q)
        chain.slopes |= {g.name: _Slope(g.slope) for g in given if g.state == state.name}
        for quantity, used in words:
            if not chain.slopes.keys().isdisjoint(used):
                chain.differentiate(quantity)
        for row, rate, used in rows:
            if not chain.slopes.keys().isdisjoint(used):
                slope = chain.of(rate.value, rate.slot.bank)
                found += [Entry(row, col, slope.value, slope.outer)] if slope != _Slope() else []
    return Jacobian(
        "Derivative of rhs by the state", tuple(sorted(found, key=lambda e: (e.row, e.col)))
    )


@final
class _Chain:
    """The chain rule for one state, quantity after quantity."""

    def __init__(self, state: Field, lanes: dict[str, str], q: Quantities) -> None:
        self.state, self.lanes, self.q = state, lanes, q
        self.named: dict[Expr, Sym] = {}
        self.label = ""  # what a sum over lanes met on the way is called by
        self.slopes: dict[str, _Slope] = {state.name: _Slope(Num(ZERO.value + 1))}

    def differentiate(self, quantity: Quantity) -> None:
        """Find the derivative of a quantity by the state; name it if it is more than a factor."""
        self.label = f"d{quantity.name}_d{self.state.name}"
        slope = self.of(quantity.value, quantity.bank)
        if slope == _Slope():
            return
        value = self.q.known(slope.value)
        if not _simple(value):
            bank = quantity.bank or self.state.bank
            named = self.named.get(value) or self.q.define(self.label, value, bank, "derivatives")
            self.named[value] = named
            if bank:
                self.lanes[named.name] = bank
            slope = _Slope(named, slope.outer)
        self.slopes[quantity.name] = slope

    def of(self, value: Expr, bank: str | None) -> _Slope:
        """Return the derivative of an expression, itself one per lane of `bank` or shared."""
        if isinstance(value, LaneSum):
            return self._of_sum(self.of(value.arg, value.bank), value.bank)
        own: list[Expr] = []
        outer: list[Outer] = []
        for name in names(value):
            slope = self.slopes.get(name)
            if slope is None:
                continue
            factor = derivative(value, name)
            if bank and self.state.bank and not self.lanes.get(name):
                outer.append(Outer(factor, slope.value))
            else:
                own.append(mul(factor, slope.value))
                outer += [Outer(mul(factor, o.left), o.right) for o in slope.outer]
        return _Slope(add(*own), tuple(o for o in outer if ZERO not in (o.left, o.right)))

    def _of_sum(self, slope: _Slope, bank: str) -> _Slope:
        """Return the derivative of a sum over the lanes of `bank`, given that of its terms."""
        if not self.state.bank:
            return _Slope(self._total(slope.value, bank))
        across = [mul(self._total(o.left, bank), o.right) for o in slope.outer]
        return _Slope(add(slope.value, *across))

    def _total(self, term: Expr, bank: str) -> Expr:
        if term == ZERO:
            return ZERO
        if bank_of(term, self.lanes) is None:
            return mul(Sym(f"{bank}_count"), term)
        return self.q.total(term, bank, self.label)


def _simple(value: Expr) -> bool:
    """Return whether a derivative is short enough to stand where it is used."""
    return len(names(value)) <= 1
