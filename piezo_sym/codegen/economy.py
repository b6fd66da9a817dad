"""A step with fewer divisions and calls of functions: what it computes stays the same.

Input: a `Step`.  Output: the same step, with ``per_L = 1/L`` where L divides more than once, and
``(T_e - T)*per_T`` for ``T_e/T - 1``; phi2 = 1/2 + d*phi3, phi1 = 1 + d*phi2 in place of calls;
products that hold an earlier one written by its name; and names for functions of the state before
the step, which Newton's method does not change: ``expm1_S = expm1(S/c_0)``.  A division takes as
long as ten products, an exponential as thirty.  A step may be rounded differently from the rates at
a point: its balances close whatever the last bit of its co-states is.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from functools import reduce
from typing import Any

from piezo_sym.codegen.mean import HALF
from piezo_sym.codegen.program import Quantity, Row
from piezo_sym.codegen.step import Change, Step
from piezo_sym.expressions.calculus import add, mul, neg
from piezo_sym.expressions.functions import RECORDS
from piezo_sym.expressions.tree import (
    ONE,
    Add,
    Call,
    Div,
    Expr,
    Mul,
    Neg,
    Node,
    Pow,
    Sym,
    names,
    rebuild,
)
from piezo_sym.expressions.tree import children as parts_of
from piezo_sym.spec.names import fresh

NOTE = "reciprocals"
#: Of quantities that a caller may compute once a step, in whatever iterations they are used.
BEFORE = "before the step"
SQUARE = Fraction(2)
#: Factors of a product that is worth a name elsewhere.
FEWEST = 3
FUNCTIONS = frozenset(name for name, record in RECORDS.items() if record.smooth)


def economical(step: Step, lanes: Mapping[str, str], still: Collection[str]) -> Step:
    """Return a step with reciprocals, recurrences, products, and what is known before it by name.

    Parameters
    ----------
    lanes : the bank of each parameter and state that is one a lane.
    still : parameters, and states before the step.
    """
    step = with_products(with_reciprocals(with_recurrences(step), lanes))
    return with_beginnings(step, {*still} - {*lanes})


def with_recurrences(step: Step) -> Step:
    """Return the step with phi1 and phi2 of a change computed from its phi3."""
    known = {quantity.value: Sym(quantity.name) for quantity in step.quantities}

    def value(node: Expr) -> Expr:
        match node:
            case Call("phi2", (change,)):
                return add(HALF, mul(change, known[Call("phi3", (change,))]))
            case Call("phi1", (change,)):
                return add(ONE, mul(change, known[Call("phi2", (change,))]))
        return node

    quantities = (replace(quantity, value=value(quantity.value)) for quantity in step.quantities)
    return replace(step, quantities=tuple(quantities))


def with_reciprocals(step: Step, lanes: Mapping[str, str]) -> Step:
    """Return the step with reciprocals of what divides more than once."""
    counts: Counter[str] = Counter()
    for value in _values(step):
        counts.update(_divisors(value))
    banks: dict[str, str | None] = {**lanes, **{q.name: q.bank for q in step.quantities}}
    taken = set(step.taken)
    instead: dict[str, Sym] = {}
    for name in sorted(name for name, count in counts.items() if count > 1):
        instead[name] = Sym(fresh(f"per_{name}", taken))
        taken.add(instead[name].name)
    made = {n: Quantity(instead[n].name, Div(ONE, Sym(n)), banks.get(n), NOTE) for n in instead}
    quantities = [made.pop(name) for name in sorted(instead) if name not in _defined(step)]
    for quantity in step.quantities:
        quantities.append(replace(quantity, value=_rewritten(quantity.value, instead)))
        if quantity.name in made:
            quantities.append(replace(made.pop(quantity.name), note=quantity.note))
    step = _with_values(step, lambda value: _rewritten(value, instead))
    return replace(step, quantities=tuple(quantities), taken=frozenset(taken))


def with_products(step: Step) -> Step:
    """Return the step with products that hold the factors of an earlier one written by its name.

    A law that falls with a temperature has such a derivative: ``dV/dS = -V/T*dT/dS``.
    """
    products: list[tuple[Quantity, list[Expr]]] = []
    quantities = []
    for quantity in step.quantities:
        sign, factors = _factors(quantity.value)
        for earlier, parts in reversed(products):
            rest = [] if earlier.bank not in (None, quantity.bank) else _without(factors, parts)
            if rest:
                known: Expr = Sym(earlier.name)
                value = reduce(mul, rest, known)
                quantity = replace(quantity, value=neg(value) if sign < 0 else value)
                break
        else:
            if sign > 0 and len(factors) >= FEWEST:
                products.append((quantity, factors))
        quantities.append(quantity)
    return replace(step, quantities=tuple(quantities))


def _factors(value: Expr) -> tuple[int, list[Expr]]:
    """Return the sign of a product, and its factors in order."""
    match value:
        case Neg(arg):
            sign, factors = _factors(arg)
            return -sign, factors
        case Mul(left, right):
            (first, one), (second, other) = _factors(left), _factors(right)
            return first * second, [*one, *other]
    return 1, [value]


def _without(factors: list[Expr], parts: list[Expr]) -> list[Expr]:
    """Return the factors that are left when parts are taken away; none if not all are there."""
    rest = list(factors)
    for part in parts:
        if part not in rest:
            return []
        rest.remove(part)
    return rest


def with_beginnings(step: Step, still: Collection[str]) -> Step:
    """Return the step with names for functions of what is known before it, the same for all lanes.

    Parameters
    ----------
    still : parameters and states before the step that are not one a lane.
    """
    reciprocals = [q for q in step.quantities if q.note == NOTE]
    still = frozenset(still)
    known = still.union(q.name for q in reciprocals if still.issuperset(names(q.value)))
    taken, found = set(step.taken), dict[Expr, Sym]()
    for value in _values(step):
        for node in _functions_of(value, known):
            if node not in found:
                found[node] = Sym(fresh(_base(node), taken))
                taken.add(found[node].name)

    def renamed(value: Expr) -> Expr:
        if isinstance(value, Call | Pow) and value in found:  # to hash a tree takes long
            return found[value]
        return rebuild(value, renamed) if found else value

    begun = [Quantity(name.name, node, None, BEFORE) for node, name in found.items()]
    rest = [replace(q, value=renamed(q.value)) for q in step.quantities if q.note != NOTE]
    step = _with_values(step, renamed)
    return replace(step, quantities=(*reciprocals, *begun, *rest), taken=frozenset(taken))


def _functions_of(node: Node, known: frozenset[str]) -> Iterator[Expr]:
    """Yield the functions in an expression, and roots, that are made of known names alone."""
    match node:
        case Call(function) if function in FUNCTIONS and known.issuperset(names(node)):
            yield node
            return
        case Pow(_, exponent) if exponent.denominator > 1 and known.issuperset(names(node)):
            yield node
            return
    for part in parts_of(node):
        yield from _functions_of(part, known)


def _base(node: Expr) -> str:
    """Return a name for a function: ``expm1_S``."""
    function = node.function if isinstance(node, Call) else "power"
    return "_".join([function, *sorted({*names(node)})[:1]])


def _defined(step: Step) -> set[str]:
    return {quantity.name for quantity in step.quantities}


def _values(step: Step) -> Iterator[Expr]:
    """Yield every value of a step."""
    yield from (quantity.value for quantity in step.quantities)
    for change in step.changes:
        yield change.free
    tables = (step.supplies, step.entropies, step.heats, step.productions, step.numerical)
    for rows in tables:
        for row in rows:
            yield from (row.value, *row.listed)


def _divisors(node: Node) -> Iterator[str]:
    """Yield the names that an expression divides by, as often as it does."""
    match node:
        case Div(_, Sym(name)):
            yield name
        case Div(_, Pow(Sym(name), power)) if power == SQUARE:
            yield name
    for part in parts_of(node):
        yield from _divisors(part)


def _rewritten(node: Expr, instead: Mapping[str, Sym]) -> Expr:
    """Return an expression with products for quotients by the keys of `instead`.

    ``a/b - 1``, as heat exchanges have it, becomes ``(a - b)*per_b``: 0 where a is b, which
    ``a*per_b - 1`` need not be.
    """
    match node:
        case Add((Div(top, Sym(name)), less)) if less == neg(ONE) and name in instead:
            return mul(add(_rewritten(top, instead), neg(Sym(name))), instead[name])
    found: Any = rebuild(node, lambda part: _rewritten(part, instead))
    match found:
        case Div(top, Sym(name)) if name in instead:
            return mul(top, instead[name])
        case Div(top, Pow(Sym(name), power)) if name in instead and power == SQUARE:
            return mul(mul(top, instead[name]), instead[name])
    return found  # type: ignore[no-any-return]  # rebuild keeps expressions


def _with_values(step: Step, new: Callable[[Expr], Expr]) -> Step:
    """Return a step with other values of what is not a quantity."""

    def row(row: Row) -> Row:
        return replace(row, value=new(row.value), listed=tuple(map(new, row.listed)))

    def change(change: Change) -> Change:
        return replace(change, free=new(change.free))

    return replace(
        step,
        changes=tuple(map(change, step.changes)),
        supplies=tuple(map(row, step.supplies)),
        entropies=tuple(map(row, step.entropies)),
        heats=tuple(map(row, step.heats)),
        productions=tuple(map(row, step.productions)),
        numerical=tuple(map(row, step.numerical)),
    )
