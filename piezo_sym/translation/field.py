"""Normal forms: sums of products of independent generators, with exact coefficients.

Input: values of one `GeneratorField`.  Output: values of which equal ones have equal terms as a
rule. Generators are names (of one lane, if they belong to a bank), smooth functions of values,
powers of sums with exponents other than positive integers, sums over the lanes of a bank, letters
and signs. A letter abbreviates a long value; it is written out only if a comparison fails without.
``sign(d, s)`` is 1 where d has the sign s, else 0; one of the three is 1, and equals its square.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import floor
from typing import final

Exponent = int | Fraction
Mono = tuple[tuple[int, Exponent], ...]
Lane = tuple[str, int]  # a bank, and which of its lanes: 0 a row's, 1 a column's

MOST_WORK = 10_000_000
MOST_BITS = 20_000
MOST_POWER = 64
#: A named value in printed text becomes a letter if it has more terms than this.
MOST_SPELLED = 6


class NotShownError(Exception):
    """A text is outside the grammar, or a value is too large, so that nothing is shown of it."""


@final
@dataclass(frozen=True)
class Generator:
    """A factor of the terms of values."""

    #: kind, arg: ``name``, or a function and its argument.
    kind: str
    arg: Value | None
    mark: Hashable  # the name, bank and lane of a name; the side of a sign; the bank of a sum
    lanes: frozenset[Lane]  # the lanes on which it depends
    parts: frozenset[int]  # the generators in it, including itself


@final
class Value:
    """A sum of products of powers of generators."""

    def __init__(self, field: GeneratorField, terms: Mapping[Mono, Exponent]) -> None:
        self.field = field
        self.terms = terms if all(terms.values()) else {m: c for m, c in terms.items() if c}
        self._hash: int | None = None

    def __eq__(self, other: object) -> bool:
        """Return whether two values have the same normal form."""
        return isinstance(other, Value) and self.terms == other.terms

    def __hash__(self) -> int:
        """Return the hash of the normal form, computed once."""
        if self._hash is None:
            self._hash = hash(frozenset(self.terms.items()))
        return self._hash

    def __add__(self, other: Value) -> Value:
        """Return the sum."""
        return self.field.total((self, other))

    def __neg__(self) -> Value:
        """Return minus the value."""
        return Value(self.field, {mono: -c for mono, c in self.terms.items()})

    def __sub__(self, other: Value) -> Value:
        """Return the difference."""
        return self + -other

    def __mul__(self, other: Value) -> Value:
        """Return the product."""
        return self.field.times(self, other)

    def generators(self) -> set[int]:
        """Return the generators that are factors of its terms, not those inside functions only."""
        return {g for mono in self.terms for g, _ in mono}

    @cached_property
    def lanes(self) -> frozenset[Lane]:
        """The lanes on which the value depends."""
        gens = self.field.gens
        return frozenset().union(*(gens[g].lanes for g in self.generators()))

    @cached_property
    def parts(self) -> frozenset[int]:
        """The generators in the value, including those inside functions."""
        gens = self.field.gens
        return frozenset().union(*(gens[g].parts for g in self.generators()))

    @property
    def constant(self) -> Fraction | None:
        """The number that the value is, if it is one."""
        return Fraction(self.terms.get((), 0)) if self.terms.keys() <= {()} else None

    @property
    def lead(self) -> Fraction:
        """The coefficient of the term that comes last."""
        return Fraction(self.terms[max(self.terms)])


@final
@dataclass(frozen=True)
class Need:
    """A condition on `value` where `path` is 1: nonzero, nonnegative or positive, as `kind` says.

    `derived`: only derivatives need it; `outside`: the function that needs it outside the domain.
    """

    kind: str
    value: Value
    path: Value
    derived: bool = False
    outside: str = ""


@final
class GeneratorField:
    """The generators of one system, and what is known of their signs.

    Attributes
    ----------
    gens : the generators; values refer to them by index.
    path : a product of signs, 1 where the branch being read is taken; None to collect no needs.
    derived, outside : whether a derivative is being read; a function outside the domain, or "".
    needs : the conditions of the divisions, roots and logarithms read so far.
    states : the names by which derivatives are taken.
    signed : generators that are positive (2) or not negative (1).
    counts : as `signed`, for sizes of banks, which are positive even outside the domain.
    assumed : values other than generators that the domain makes positive (2) or not negative (1).
    signs, forms, factors, never, asked, zeros : kept by `signs`, `zero` and `possible`.
    unknown : how often a solver gave no answer.
    work : how many products of two terms were formed.
    """

    def __init__(self) -> None:
        self.gens: list[Generator] = []
        self._numbers: dict[tuple[str, Value | None, Hashable], int] = {}
        self._joined: dict[Mono, dict[Mono, tuple[Mono, Value | None] | None]] = {}
        self.work = 0
        self.zero, self.one = Value(self, {}), Value(self, {(): 1})
        self.path: Value | None = self.one
        self.derived, self.outside = False, ""
        self.needs: dict[Need, None] = {}
        self.states: frozenset[int] = frozenset()
        self.signed: dict[int, int] = {}
        self.counts: dict[int, int] = {}
        self.assumed: dict[Value, int] = {self.zero: 1}
        self.signs: dict[Value, int] = {}
        self.forms: dict[Value, tuple[list[Value], int]] = {}
        self.factors: dict[Value, list[tuple[Value, int]]] = {}
        self.never: dict[tuple[Value, int, Value, int], bool] = {}
        self.asked: dict[frozenset[tuple[Value, int]], bool] = {}
        self.zeros: set[tuple[Value, frozenset[Value]]] = set()
        self.unknown = 0

    def number(self, value: Exponent) -> Value:
        """Return a rational number."""
        return Value(self, {(): value.numerator if value.denominator == 1 else value})

    def name(self, name: str, bank: str | None = None, lane: int = 0, sign: int = 0) -> Value:
        """Return a name, of one lane of a bank if it has one; `sign` 2: positive, 1: >= 0."""
        made = self.generator("name", None, (name, bank, lane))
        (number,) = made.parts
        self.signed[number] = max(sign, self.signed.get(number, 0))
        self.counts |= {number: sign} if lane == -1 else {}
        return made

    def count(self, bank: str) -> Value:
        """Return the size of a bank."""
        return self.name(f"{bank}_count", None, -1, sign=2)

    def generator(self, kind: str, arg: Value | None, mark: Hashable = None) -> Value:
        """Return a generator as a value."""
        known = self._numbers.get((kind, arg, mark))
        if known is None:
            known = self._numbers[kind, arg, mark] = len(self.gens)
            lanes = arg.lanes if arg else frozenset()
            parts = frozenset({known}) | (arg.parts if arg else frozenset())
            if isinstance(mark, tuple):
                lanes = frozenset({(mark[1], mark[2])} if mark[1] else ())
            elif kind == "sum":
                lanes -= {(mark, 0)}
            self.gens.append(Generator(kind, arg, mark, lanes, parts))
        return self.raised(known, 1)

    def letter(self, value: Value) -> Value:
        """Return a letter for a long value without signs, one per distinct value; else `value`."""
        if len(value.terms) <= MOST_SPELLED:
            return value
        chosen = any(self.gens[g].kind == "sign" for g in value.generators())
        return value if chosen else self.generator("letter", value)

    def raised(self, g: int, exponent: Exponent) -> Value:
        """Return a power of a generator; for a power of a sum it is not yet in normal form."""
        return Value(self, {((g, exponent),): 1})

    def total(self, values: Iterable[Value]) -> Value:
        """Return a sum."""
        terms: dict[Mono, Exponent] = {}
        for value in values:
            for mono, c in value.terms.items():
                terms[mono] = terms[mono] + c if mono in terms else c
        return Value(self, terms)

    def spend(self, work: int) -> None:
        """Count work, in products of two terms; raise `NotShownError` if it is too much."""
        self.work += work
        if self.work > MOST_WORK:
            raise NotShownError("the expressions are too large")

    def times(self, left: Value, right: Value) -> Value:
        """Return a product, in normal form."""
        self.spend(len(left.terms) * len(right.terms))
        terms: dict[Mono, Exponent] = {}
        more = []
        for m, a in left.terms.items():
            if (joined := self._joined.get(m)) is None:
                joined = self._joined[m] = {}
            for n, b in right.terms.items():
                if n not in joined:
                    joined[n] = self._join(m, n)
                found, c = joined[n], a * b
                if c.numerator.bit_length() + c.denominator.bit_length() > MOST_BITS:
                    raise NotShownError("the numbers are too long")
                if found and found[1] is None:
                    terms[found[0]] = terms.get(found[0], 0) + c
                elif found and found[1]:
                    more.append(self.times(Value(self, {found[0]: c}), found[1]))
        return self.total([Value(self, terms), *more]) if more else Value(self, terms)

    def _join(self, m: Mono, n: Mono) -> tuple[Mono, Value | None] | None:
        """Return a product as a monomial and a sum (or None) to multiply by; None if it is zero."""
        found = dict(m)
        for g, e in n:
            found[g] = found.get(g, 0) + e
        extra: Value | None = None
        seen: dict[Value | None, int] = {}
        for g, e in tuple(found.items()):
            gen = self.gens[g]
            if e == 0:
                del found[g]
            elif gen.kind == "sign":
                found[g] = 1
                if seen.setdefault(gen.arg, g) != g:
                    return None
            elif gen.kind == "power" and gen.arg and (e >= 1 or (e < 0 and gen.arg.constant)):
                found[g] = e - floor(e)
                if e == floor(e):
                    del found[g]
                factor = self.whole_power(gen.arg, floor(e))
                extra = factor if extra is None else extra * factor
        return tuple(sorted(found.items())), extra

    def whole_power(self, base: Value, n: int) -> Value:
        """Return an integer power; a negative exponent only for a single term."""
        if abs(n) > MOST_POWER and (len(base.terms) != 1 or base.constant not in {None, 1, -1}):
            raise NotShownError("a power is too large")
        if len(base.terms) == 1:
            ((mono, c),) = base.terms.items()
            return Value(self, {tuple((g, e * n) for g, e in mono): Fraction(c) ** n}) * self.one
        made = self.one
        for bit in f"{n:b}":
            made = made * made * base if bit == "1" else made * made
        return made

    def at(self, value: Value, sides: Mapping[Value, int]) -> Value:
        """Return a value where some differences have the given signs."""
        terms: dict[Mono, Exponent] = {}
        for mono, c in value.terms.items():
            left = []
            for g, e in mono:
                gen = self.gens[g]
                if gen.kind != "sign" or gen.arg is None or gen.arg not in sides:
                    left.append((g, e))
                elif sides[gen.arg] != gen.mark:
                    break
            else:
                terms[tuple(left)] = terms.get(tuple(left), 0) + c
        return Value(self, terms)

    def lane_sum(self, value: Value, bank: str) -> Value:
        """Return the sum of a value over the lanes of a bank."""
        parts = []
        for mono, c in value.terms.items():
            own = tuple((g, e) for g, e in mono if (bank, 0) in self.gens[g].lanes)
            free = Value(self, {tuple(p for p in mono if p not in own): c})
            inner = Value(self, {own: 1})
            parts.append(free * (self.generator("sum", inner, bank) if own else self.count(bank)))
        return self.total(parts)
