"""The Jacobian of the rates, by the chain rule through the named quantities.

Input: the rows of `rhs` and the quantities they use.  Output: the entries that are not identically
zero, and the derivatives that get a name (``dT_dS``).

The derivative of one value by one state is a `_Slope`: `value`, in the lane that either of them has
(in equal lanes if both have one), plus products over all pairs of lanes if a sum over lanes lies
between them.
"""

from collections.abc import Container, Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from heapq import heappop, heappush
from operator import attrgetter
from typing import final

from piezo_sym.codegen.program import (
    Described,
    Entry,
    Names,
    Outer,
    OutputRow,
    Quantity,
    bank_of,
    needed,
)
from piezo_sym.expressions.calculus import add, derivative, mul
from piezo_sym.expressions.grammar import may_vanish
from piezo_sym.expressions.tree import (
    ONE,
    ZERO,
    Call,
    Expr,
    LaneSum,
    Num,
    Pow,
    Sym,
    names,
    rebuild,
    replaced,
)


@final
@dataclass(frozen=True)
class _Slope:
    """A derivative by one state; see the module's docstring."""

    value: Expr = ZERO
    outer: tuple[Outer, ...] = ()


def jacobian_of(
    rates: tuple[OutputRow, ...],
    states: tuple[Described, ...],
    quantities: tuple[Quantity, ...],
    lanes: Mapping[str, str],
    new: Names,
    known: Mapping[Expr, Sym],
) -> tuple[tuple[Entry, ...], tuple[Quantity, ...]]:
    """Return the derivative of rates by states, and the named derivatives in it.

    Parameters
    ----------
    rates : rows of the right-hand side, one per state.
    states : in the same order.
    quantities : those that the rates use, in order.
    lanes : the bank of every name that has a value per lane.
    new : gives names to derivatives.
    known : expressions that have a name already.
    """
    before, _ = needed(quantities, (rate.value for rate in rates))
    users, rows = (_users(item.value for item in items) for items in (before, rates))
    sums: dict[Expr, Sym] = {
        item.value: Sym(item.name) for item in quantities if isinstance(item.value, LaneSum)
    }
    kinked = frozenset(item.name for item in before if may_vanish(item.value))
    named, entries = _NamedDerivatives(dict(lanes), sums, known, new, kinked, []), list[Entry]()
    for col, state in enumerate(states):
        chain = _Chain(state, named)
        waiting = sorted({n for name in chain.slopes for n in users.get(name, ())})
        while waiting:
            quantity = before[n := heappop(waiting)]
            if quantity.name not in chain.slopes:
                chain.differentiate(quantity)
                for later in users.get(quantity.name, ()) if quantity.name in chain.slopes else ():
                    heappush(waiting, later)
        for n in sorted({n for name in chain.slopes for n in rows.get(name, ())}):
            slope = chain.of(rates[n].value, rates[n].slot.bank)
            entries += [Entry(n, col, slope.value, slope.outer)] if slope != _Slope() else []
    return tuple(sorted(entries, key=attrgetter("row", "col"))), tuple(named.defined)


def _slope_of(value: Expr, name: str, kinked: Container[str]) -> Expr:
    """Return the derivative of a value, with a value where the argument of a root is zero.

    That of ``q*sqrt(abs(q))`` is no 0/0 at rest; that of a root alone is infinite there.
    """
    return _as_roots(derivative(_as_powers(value, kinked), name))


def _as_powers(node: Expr, kinked: Container[str]) -> Expr:
    """Return an expression with roots of what may vanish at a kink as powers."""
    match node:
        case Call("sqrt", (arg,)) if may_vanish(arg, kinked):
            return Call("pow", (_as_powers(arg, kinked), Num(Fraction(1, 2))))
        case Pow(base, exponent) if 0 < exponent < 1 and may_vanish(base, kinked):
            return Call("pow", (_as_powers(base, kinked), Num(exponent)))
    return rebuild(node, lambda part: _as_powers(part, kinked))


def _as_roots(node: Expr) -> Expr:
    match node:
        case Call("pow", (arg, Num(Fraction(numerator=1, denominator=2)))):
            return Call("sqrt", (_as_roots(arg),))
        case Call("pow", (base, Num(exponent))):
            return Pow(_as_roots(base), exponent)
    return rebuild(node, _as_roots)


def _users(values: Iterable[Expr]) -> Mapping[str, list[int]]:
    """Return the numbers of the expressions in which each name occurs."""
    users: dict[str, list[int]] = {}
    for n, value in enumerate(values):
        for name in names(value):
            users.setdefault(name, []).append(n)
    return users


@final
@dataclass(frozen=True)
class _NamedDerivatives:
    """The derivatives that get a name; expressions in `sums` and `known` have one already.

    `kinked` are the names of values with kinks.
    """

    lanes: dict[str, str]
    sums: dict[Expr, Sym]
    known: Mapping[Expr, Sym]
    new: Names
    kinked: frozenset[str]
    defined: list[Quantity]

    def define(self, word: str, value: Expr, bank: str | None, note: str) -> Sym:
        """Name a derivative."""
        name = self.new(word)
        self.defined.append(Quantity(name, value, bank, note))
        self.lanes.update({name: bank} if bank else {})
        return Sym(name)

    def total(self, term: Expr, bank: str, word: str) -> Expr:
        """Return a term summed over the lanes of a bank."""
        if bank_of(term, self.lanes) is None:
            return mul(Sym(f"{bank}_count"), term)
        key = LaneSum(term, bank)
        if key not in self.sums:
            self.sums[key] = self.define(word, key, None, "sums over lanes")
        return self.sums[key]


@final
class _Chain:
    """The chain rule for one state, quantity after quantity."""

    def __init__(self, state: Described, derivatives: _NamedDerivatives) -> None:
        self.state, self.derivatives = state, derivatives
        self.named: dict[Expr, Sym] = {}
        self.word = ""  # the name for a sum over lanes in a derivative
        self.slopes: dict[str, _Slope] = {state.name: _Slope(ONE)}

    def differentiate(self, quantity: Quantity) -> None:
        """Find a quantity's derivative in the state; name it if it has two names or more."""
        self.word = f"d{quantity.name}_d{self.state.name}"
        slope = self.of(quantity.value, quantity.bank)
        if slope == _Slope():
            return
        value = replaced(slope.value, self.derivatives.known)
        if len(names(value)) > 1:
            bank = quantity.bank or self.state.bank
            if value not in self.named:
                self.named[value] = self.derivatives.define(self.word, value, bank, "derivatives")
            slope = _Slope(self.named[value], slope.outer)
        self.slopes[quantity.name] = slope

    def of(self, value: Expr, bank: str | None) -> _Slope:
        """Return the derivative of an expression that has a value per lane of `bank`, or one."""
        if isinstance(value, LaneSum):
            return self._of_sum(self.of(value.arg, value.bank), value.bank)
        terms: list[Expr] = []
        outer: list[Outer] = []
        for name in names(value):
            slope = self.slopes.get(name)
            if slope is None:
                continue
            factor = _slope_of(value, name, self.derivatives.kinked)
            if bank and self.state.bank and not self.derivatives.lanes.get(name):
                outer.append(Outer(factor, slope.value))
            else:
                terms.append(mul(factor, slope.value))
                outer += [Outer(mul(factor, o.left), o.right) for o in slope.outer]
        return _Slope(add(*terms), tuple(o for o in outer if ZERO not in (o.left, o.right)))

    def _of_sum(self, slope: _Slope, bank: str) -> _Slope:
        """Return the derivative of a sum over the lanes of `bank`, given that of its terms."""
        if not self.state.bank:
            return _Slope(self.derivatives.total(slope.value, bank, self.word))
        across = [
            mul(self.derivatives.total(o.left, bank, self.word), o.right) for o in slope.outer
        ]
        return _Slope(add(slope.value, *across))
