"""Numbers at which a printed row is not the proved one.

Input: the difference of both in normal form.  Output: a point of the domain, with at least two
lanes per bank, at which ball arithmetic shows that the difference is not zero; or none.
"""

from __future__ import annotations

import random
from collections.abc import Hashable, Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import islice
from math import isfinite
from typing import Any, final

from flint import arb, ctx

from piezo_sym.expressions.exact_eval import BITS, TooCloseError, evaluated, exact, holds
from piezo_sym.expressions.tree import ZERO, Call, Cmp, Pow, Sym
from piezo_sym.translation.field import Generator, Value
from piezo_sym.translation.known import Proved

POINTS = 30
#: The most terms that are evaluated at all points together.
MOST_TERMS = 3_000
#: A difference below this fraction of the proved value may come from rounding in print.
LEAST_SHARE = 1e-12
FACTORS = tuple(map(Fraction, ("1/2", "3/4", "1", "5/4", "2")))
#: A value is undefined at a point, or its ball is too wide; or a name has no number (1/0).
UNDECIDED = ArithmeticError, ValueError, KeyError
#: The comparison with zero that each sign stands for.
OPERATORS: Mapping[Hashable, str] = {1: ">", 0: "=", -1: "<"}
X = Sym("x")


def witness(printed: Value, wanted: Value, known: Proved) -> tuple[Mapping[str, str], str] | None:
    """Return a point of the domain, as text, where two values differ, and what both are there."""
    difference = printed - wanted
    size = len(difference.terms) + len(printed.terms) + len(wanted.terms)
    for point in islice(_points(known), max(2, min(POINTS, MOST_TERMS // size))):
        try:
            if not all(_inside(margin, point, strict) for margin, strict in known.margins):
                continue
            found = point.value(difference, {})
            one, other = point.value(printed, {}), point.value(wanted, {})
        except UNDECIDED:
            continue
        if abs(found) > LEAST_SHARE * abs(other):
            values = f"is {float(one):.9g}, and {float(other):.9g} is proved"
            return {name: ", ".join(map(str, own)) for name, own in point.numbers.items()}, values
    return None


def _inside(margin: Value, point: WitnessPoint, strict: bool) -> bool:
    lanes = [{}] if not margin.lanes else [{bank: n} for bank, _ in margin.lanes for n in (0, 1)]
    found = (point.value(margin, lane) for lane in lanes)
    return all(value > 0 if strict else value >= 0 for value in found)


def _points(known: Proved) -> Iterator[WitnessPoint]:
    """Yield points: the spec's parameters and inputs, or values near them; states of any size."""
    model, chance = known.iphs.model, random.Random(0)
    given = {n: e.si for table in (model.parameters, model.inputs) for n, e in table.items()}
    for n in range(POINTS):
        numbers: dict[str, tuple[Fraction, ...]] = {}
        for name in known.names:
            values = given.get(name)
            listed = values if isinstance(values, tuple) else (values,)
            lanes = range(max(2, len(listed)) if name in known.banks else 1)
            numbers[name] = tuple(_number(listed[j % len(listed)], n, chance) for j in lanes)
        try:
            yield WitnessPoint(
                known, numbers | _means(WitnessPoint(known, numbers), known, n, chance)
            )
        except UNDECIDED:
            continue


def _means(
    point: WitnessPoint, known: Proved, n: int, chance: random.Random
) -> dict[str, tuple[Fraction, ...]]:
    """Return numbers for means of co-states: the co-states at a point, or values near them."""
    found = {}
    for name, costate in known.means.items():
        bank = known.banks.get(name)
        lanes = [{bank: j} for j in range(len(point.numbers[name]))] if bank else [{}]
        values = [float(point.value(costate, lane)) for lane in lanes]
        if not all(map(isfinite, values)):
            raise TooCloseError
        factors = [chance.choice(FACTORS) if n % 2 else Fraction(1) for _ in lanes]
        found[name] = tuple(Fraction(v) * f for v, f in zip(values, factors, strict=True))
    return found


def _number(value: float | None, n: int, chance: random.Random) -> Fraction:
    """Return a random number for a state (no value), or one at or near a given value."""
    if value is None or (value == 0 and n % 2):
        return Fraction(f"{chance.choice((1, 1, -1)) * 10 ** chance.uniform(-4, 2):.3g}")
    exact = Fraction(repr(float(value)))
    return exact * chance.choice(FACTORS) if n % 2 else exact


@final
class WitnessPoint:
    """Numbers for names, one per lane where they have lanes; values at them, as balls."""

    def __init__(self, known: Proved, numbers: Mapping[str, Sequence[Fraction]]) -> None:
        self.numbers, self.gens = numbers, known.field.gens
        self.found: dict[tuple[object, ...], Any] = {}
        self.size = max(2, *map(len, numbers.values()))

    def value(self, value: Value, lanes: Mapping[str, int]) -> Any:
        """Return a ball around a value; a row's lane is the first, a column's the second."""
        with ctx.workprec(BITS):
            return self._value(value, lanes)

    def _value(self, value: Value, lanes: Mapping[str, int]) -> Any:
        total = arb(0)
        for mono, c in value.terms.items():
            term = exact(Fraction(c))
            for g, e in mono:
                own = self._generator(g, lanes)
                term = term * (own if e == 1 else evaluated(Pow(X, Fraction(e)), {"x": own}))
            total = total + term
        return total

    def _generator(self, g: int, lanes: Mapping[str, int]) -> Any:
        """Return a ball around a generator, kept for the lanes on which it depends."""
        banks = {bank for bank, _ in self.gens[g].lanes}
        key = g, *sorted((bank, n) for bank, n in lanes.items() if bank in banks)
        if key not in self.found:
            self.found[key] = self._made(self.gens[g], lanes)
        return self.found[key]

    def _made(self, gen: Generator, lanes: Mapping[str, int]) -> Any:
        if gen.arg is None:
            assert isinstance(gen.mark, tuple)
            name, bank, lane = gen.mark
            if lane == -1:
                return arb(self.size)
            values = self.numbers[name]
            return arb(exact(values[lanes.get(bank, lane) % len(values) if bank else 0]))
        if gen.kind == "sum":
            bank = str(gen.mark)
            return sum(self._value(gen.arg, {**lanes, bank: n}) for n in range(self.size))
        arg = self._value(gen.arg, lanes)
        if gen.kind == "sign":
            return arb(int(holds(Cmp(OPERATORS[gen.mark], X, ZERO), {"x": arg})))
        if gen.kind in {"power", "letter"}:
            return arg
        return evaluated(Call(gen.kind, (X,)), {"x": arg})
