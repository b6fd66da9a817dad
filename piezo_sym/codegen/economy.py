"""A step with fewer divisions and calls of functions: what it computes stays the same.

Input: a `Step`.  Output: the same step, with ``per_L = 1/L`` where L divides more than once, and
phi2 = 1/2 + d*phi3, phi1 = 1 + d*phi2 in place of calls.  A division takes as long as ten products.
A step may be rounded differently from the rates at a point: its balances close whatever the last
bit of its co-states is.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from typing import Any

from piezo_sym.codegen.mean import HALF
from piezo_sym.codegen.program import Quantity, Row
from piezo_sym.codegen.step import Change, Step
from piezo_sym.spec.calculus import add, mul
from piezo_sym.spec.expressions import ONE, Call, Div, Expr, Node, Pow, Sym, rebuild
from piezo_sym.spec.expressions import children as parts_of
from piezo_sym.spec.names import fresh

NOTE = "reciprocals"
SQUARE = Fraction(2)


def economical(step: Step, lanes: Mapping[str, str]) -> Step:
    """Return a step with reciprocals and recurrences.

    Parameters
    ----------
    lanes : the bank of each parameter and state that is one a lane.
    """
    return with_reciprocals(with_recurrences(step), lanes)


def with_recurrences(step: Step) -> Step:
    """Return the step with phi1 and phi2 of a change computed from its phi3."""
    names = {quantity.value: Sym(quantity.name) for quantity in step.quantities}

    def value(node: Expr) -> Expr:
        match node:
            case Call("phi2", (change,)):
                return add(HALF, mul(change, names[Call("phi3", (change,))]))
            case Call("phi1", (change,)):
                return add(ONE, mul(change, names[Call("phi2", (change,))]))
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
    names: dict[str, Sym] = {}
    for name in sorted(name for name, count in counts.items() if count > 1):
        names[name] = Sym(fresh(f"per_{name}", taken))
        taken.add(names[name].name)
    made = {n: Quantity(names[n].name, Div(ONE, Sym(n)), banks.get(n), NOTE) for n in names}
    quantities = [made.pop(name) for name in sorted(names) if name not in _defined(step)]
    for quantity in step.quantities:
        quantities.append(replace(quantity, value=_rewritten(quantity.value, names)))
        if quantity.name in made:
            quantities.append(replace(made.pop(quantity.name), note=quantity.note))
    return replace(_with_values(step, names), quantities=tuple(quantities), taken=frozenset(taken))


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


def _rewritten(node: Expr, names: Mapping[str, Sym]) -> Expr:
    """Return an expression with products for quotients by `names`."""
    found: Any = rebuild(node, lambda part: _rewritten(part, names))
    match found:
        case Div(top, Sym(name)) if name in names:
            return mul(top, names[name])
        case Div(top, Pow(Sym(name), power)) if name in names and power == SQUARE:
            return mul(mul(top, names[name]), names[name])
    return found  # type: ignore[no-any-return]  # rebuild keeps expressions


def _with_values(step: Step, names: Mapping[str, Sym]) -> Step:
    def row(row: Row) -> Row:
        listed = tuple(_rewritten(value, names) for value in row.listed)
        return replace(row, value=_rewritten(row.value, names), listed=listed)

    def change(change: Change) -> Change:
        return replace(change, free=_rewritten(change.free, names))

    return replace(
        step,
        changes=tuple(map(change, step.changes)),
        supplies=tuple(map(row, step.supplies)),
        entropies=tuple(map(row, step.entropies)),
        heats=tuple(map(row, step.heats)),
        productions=tuple(map(row, step.productions)),
        numerical=tuple(map(row, step.numerical)),
    )
