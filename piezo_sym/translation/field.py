"""Normal forms: sums of products of independent generators, with exact coefficients.

Input: values of one `Field`.  Output: values in which equal expressions look equal.  Generators are
names (of one lane of a bank, where they have one), functions of values (``exp``, ``log``, ``sin``,
``cos``, ``tanh``), powers of sums that are no whole positive ones, sums over the lanes of a bank,
and signs: ``sign(d, s)`` is 1 where d has the sign s, else 0.

Identities used, and their premises: exp(a + b) = exp(a) exp(b), exp(c log x) = x**c, log(exp z) = z,
log(a b) = log a + log b and (a b)**c = a**c b**c for a, b > 0; (x**(1/n))**n = x for x >= 0;
sin, tanh odd and cos even; of the signs of one value exactly one is 1, and it is its own square.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, partial, reduce
from itertools import product
from math import floor, prod
from typing import final

from sympy import QQ, factorint
from sympy.polys.orderings import lex
from sympy.polys.rings import PolyElement, PolyRing

Exponent = int | Fraction
Mono = tuple[tuple[int, Exponent], ...]
Lane = tuple[str, int]  # a bank, and which of its lanes: 0 a row's, 1 a column's

MOST_WORK = 400_000
MOST_BITS = 20_000
MOST_FACTOR = 10**12
MOST_FACTORED = 40
SIDES = {"<": (-1,), "<=": (-1, 0), ">": (1,), ">=": (1, 0), "==": (0,), "!=": (1, -1)}


class NotShownError(Exception):
    """A text is outside the grammar, or a value too large: nothing is said of it."""


@final
@dataclass(frozen=True)
class Generator:
    """What a value is made of; `mark` is a name and its lane, a side, or the bank of a sum.

    `parts` are the generators in it, itself among them; `lanes` those on which it depends.
    """

    kind: str
    arg: Value | None
    mark: Hashable
    lanes: frozenset[Lane]
    parts: frozenset[int]


@final
class Value:
    """A sum of products of powers of generators."""

    def __init__(self, field: Field, terms: Mapping[Mono, Exponent]) -> None:
        self.field = field
        self.terms = {mono: c for mono, c in terms.items() if c}

    @cached_property
    def key(self) -> frozenset[tuple[Mono, Exponent]]:
        """What tells a value from others."""
        return frozenset(self.terms.items())

    def __eq__(self, other: object) -> bool:
        """Return whether two values have the same normal form."""
        return isinstance(other, Value) and self.terms == other.terms

    def __hash__(self) -> int:
        """Return the hash of the normal form."""
        return hash(self.key)

    def __add__(self, other: Value) -> Value:
        """Return the sum."""
        terms = dict(self.terms)
        for mono, c in other.terms.items():
            terms[mono] = terms.get(mono, 0) + c
        return Value(self.field, terms)

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
        """Return the generators that occur at the top."""
        return {g for mono in self.terms for g, _ in mono}

    @cached_property
    def lanes(self) -> frozenset[Lane]:
        """The lanes on which the value depends."""
        gens = self.field.gens
        return frozenset().union(*(gens[g].lanes for g in self.generators()))

    @cached_property
    def parts(self) -> frozenset[int]:
        """The generators in the value, those in arguments of functions too."""
        gens = self.field.gens
        return frozenset().union(*(gens[g].parts for g in self.generators()))

    @property
    def constant(self) -> Fraction | None:
        """The number that the value is, if it is one."""
        return Fraction(self.terms.get((), 0)) if self.terms.keys() <= {()} else None


@final
@dataclass(frozen=True)
class Need:
    """What has to hold where `path` is 1: `value` is not zero, not negative or positive.

    `derived` says that derivatives need it, laws do not.
    """

    kind: str
    value: Value
    path: Value
    derived: bool = False


@final
class Field:
    """The generators of one system, and what is known of their signs.

    Attributes
    ----------
    signs : differences that the domain says are positive (2) or not negative (1).
    needs : what divisions, roots and logarithms needed, while `path` is not None.
    asked : whether some signs cannot be together, as a solver said.
    never : whether two differences cannot have two signs, once that is known.
    derived : whether what is computed at the moment is a derivative.
    path : a product of signs, 1 where what is computed at the moment is chosen.
    """

    def __init__(self) -> None:
        self.gens: list[Generator] = []
        self._numbers: dict[tuple[str, Value | None, Hashable], int] = {}
        self._signed: dict[int, int] = {}
        self._joined: dict[tuple[Mono, Mono], tuple[Mono, Value | None] | None] = {}
        self.signs: dict[Value, int] = {}
        self._known: dict[Value, int] = {}
        self._forms: dict[Value, tuple[list[Value], int]] = {}
        self._factored: dict[Value, list[tuple[Value, int]]] = {}
        self.asked: dict[frozenset[tuple[Value, int]], bool] = {}
        self.never: dict[tuple[Value, int, Value, int], bool] = {}
        self.needs: dict[Need, None] = {}
        self.zero, self.one = Value(self, {}), Value(self, {(): 1})
        self.signs[self.zero] = 1
        self.path: Value | None = self.one
        self.derived = False
        self.work = 0

    # Generators

    def number(self, value: Exponent) -> Value:
        """Return a rational number."""
        return Value(self, {(): value.numerator if value.denominator == 1 else value})

    def name(self, name: str, bank: str | None = None, lane: int = 0, sign: int = 0) -> Value:
        """Return a name, of one lane of a bank if it has one; `sign` 2: positive, 1: >= 0."""
        made = self.generator("name", None, (name, bank, lane))
        (number,) = made.parts
        self._signed[number] = max(sign, self._signed.get(number, 0))
        return made

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
        return Value(self, {((known, 1),): 1})

    # Products and powers

    def times(self, left: Value, right: Value) -> Value:
        """Return a product."""
        self.work += len(left.terms) * len(right.terms)
        if self.work > MOST_WORK:
            raise NotShownError("the expressions are too large")
        terms: dict[Mono, Exponent] = {}
        more = []
        for m, a in left.terms.items():
            for n, b in right.terms.items():
                if (m, n) not in self._joined:
                    self._joined[m, n] = self._join(m, n)
                found = self._joined[m, n]
                if found is None:
                    continue
                c = a * b
                if c.numerator.bit_length() + c.denominator.bit_length() > MOST_BITS:
                    raise NotShownError("the numbers are too long")
                if found[1] is None:
                    terms[found[0]] = terms.get(found[0], 0) + c
                else:
                    more.append(self.times(Value(self, {found[0]: c}), found[1]))
        return self.total([Value(self, terms), *more])

    def _join(self, m: Mono, n: Mono) -> tuple[Mono, Value | None] | None:
        """Return a product of two products: one product, times a sum if a power of it is whole."""
        found = dict(m)
        for g, e in n:
            found[g] = found.get(g, 0) + e
        extra, seen = None, {}
        for g, e in tuple(found.items()):
            gen = self.gens[g]
            if e == 0:
                del found[g]
            elif gen.kind == "sign":
                found[g] = 1
                if seen.setdefault(gen.arg, g) != g:
                    return None
            elif (
                gen.kind == "power"
                and gen.arg
                and (e >= 1 or (e < 0 and gen.arg.constant is not None))
            ):
                whole = floor(e)
                found[g] = e - whole
                if e == whole:
                    del found[g]
                factor = self.power(gen.arg, Fraction(whole))
                extra = factor if extra is None else extra * factor
        return tuple(sorted(found.items())), extra

    def total(self, values: Iterable[Value]) -> Value:
        """Return a sum."""
        terms: dict[Mono, Exponent] = {}
        for value in values:
            for mono, c in value.terms.items():
                terms[mono] = terms.get(mono, 0) + c
        return Value(self, terms)

    def power(self, base: Value, exponent: Fraction) -> Value:
        """Return a rational power."""
        if exponent.denominator == 1 and exponent >= 0:
            if exponent > 64 and len(base.terms) != 1:
                raise NotShownError("a power is too large")
            return self._whole(base, exponent.numerator)
        q = exponent.numerator if exponent.denominator == 1 else exponent
        return self.lifted(lambda v: self._power(v, q), base)

    def _whole(self, base: Value, n: int) -> Value:
        if n > 64 and base.constant is None:
            (mono, c), *_ = base.terms.items()
            if abs(c) == 1:
                return Value(self, {tuple((g, e * n) for g, e in mono): c ** (n % 2 or 2)})
        if n > 1024:
            raise NotShownError("a power is too large")
        made = self.one
        for bit in f"{n:b}":
            made = made * made * base if bit == "1" else made * made
        return made

    def _power(self, base: Value, q: Exponent) -> Value:
        """Return a power of a value without signs, for an exponent that is not whole or negative."""
        if not base.terms and q > 0:
            return base
        if not base.terms:
            return self._undefined("nonzero")
        size, common, rest = self.primitive(base, partly=q.denominator != 1)
        if not rest.terms:
            return self._power(rest, q)
        made = self._root(size, q)
        for g, e in common:
            made = made * Value(self, {((g, e * q),): 1}) * self.one
            if q < 0:
                arg = self.gens[g].arg if self.gens[g].kind == "power" else None
                self._needs("nonzero", arg or Value(self, {((g, 1),): 1}))
        if q.denominator != 1:
            rest, even = self._even(rest, q)
            made = made * even
        if q.denominator != 1 and rest != self.one:
            self._needs("nonnegative", rest)
        for factor, times in self._factors(rest, whole=q.denominator == 1):
            made = made * self.generator_power(factor, times * q)
            if q < 0:
                self._needs("nonzero", factor)
        return made

    def _even(self, value: Value, q: Exponent) -> tuple[Value, Value]:
        """Return a value without factors such as x**2, and the root of those, such as ``abs(x)``."""
        made = self.one
        for g in value.generators():
            e = min(dict(mono).get(g, 0) for mono in value.terms)
            if e and e % 2 == 0 and (e * q).denominator == 1:
                factor = Value(self, {((g, 1),): 1})
                value = value * Value(self, {((g, -e),): 1})
                made = made * self.power(self.size(factor), Fraction(e * q))
        return value, made

    def _factors(self, rest: Value, *, whole: bool) -> list[tuple[Value, int]]:
        """Return the irreducible factors of a sum; for roots, the sum itself."""
        if rest not in self._factored or not whole:
            found = [(rest, 1)] if rest != self.one else []
            numbers = sorted(rest.generators())
            exponents = {Fraction(e).denominator for mono in rest.terms for _, e in mono}
            if whole and 1 < len(rest.terms) <= MOST_FACTORED and exponents == {1}:
                terms = {
                    tuple(int(dict(m).get(g, 0)) for g in numbers): c for m, c in rest.terms.items()
                }
                table = {m: QQ(c.numerator, c.denominator) for m, c in terms.items()}
                polynomial = PolyRing([f"g{g}" for g in numbers], QQ, lex).from_dict(table)
                found = [(self._monic(f, numbers), n) for f, n in polynomial.factor_list()[1]]
            if not whole:
                return found
            self._factored[rest] = found
        return self._factored[rest]

    def _monic(self, factor: PolyElement, numbers: list[int]) -> Value:
        terms: dict[Mono, Exponent] = {}
        for powers, c in factor.terms():
            mono = tuple((g, e) for g, e in zip(numbers, powers, strict=True) if e)
            terms[mono] = Fraction(int(c.numerator), int(c.denominator))
        made = Value(self, terms)
        return made * self.number(1 / Fraction(terms[max(terms)]))

    def generator_power(self, arg: Value, q: Exponent) -> Value:
        """Return a power of a sum as a generator."""
        (mono,) = self.generator("power", arg).terms
        return Value(self, {((mono[0][0], q),): 1}) * self.one

    def _root(self, size: Fraction, q: Exponent) -> Value:
        """Return a power of a number, positive if the exponent is not whole."""
        if q.denominator == 1:
            return self.number(size**q)
        if max(size.numerator, size.denominator) > MOST_FACTOR:
            raise NotShownError("a root of a long number")
        made = self.one
        for part, sign in ((size.numerator, 1), (size.denominator, -1)):
            for prime, times in factorint(part).items():
                made = made * self.generator_power(self.number(prime), sign * times * q)
        return made

    def primitive(self, value: Value, *, partly: bool) -> tuple[Fraction, Mono, Value]:
        """Return (number, common factors, rest) of a value, the leading coefficient of rest 1 or -1.

        With `partly`, number and factors are positive, or not negative with a positive exponent.
        """
        least: dict[int, Exponent] = {}
        monos = [dict(mono) for mono in value.terms]
        for g in value.generators():
            e = min(mono.get(g, 0) for mono in monos)
            sign = self.sign_of(g)
            if e and (not partly or sign == 2 or (sign == 1 and e > 0)):
                least[g] = e
        common = tuple(sorted(least.items()))
        below = Value(self, {tuple((g, -e) for g, e in common): 1})
        rest = value * below if common else value
        lead = Fraction(rest.terms[max(rest.terms)] if rest.terms else 1)
        size = abs(lead) if partly else lead
        return size, common, rest if size == 1 else rest * self.number(1 / size)

    # Signs

    def sign_of(self, g: int) -> int:
        """Return 2 if a generator is positive wherever it is defined, 1 if >= 0, else 0."""
        if g not in self._signed:
            gen = self.gens[g]
            known = {"exp": 2, "sign": 1}.get(gen.kind, 0)
            if gen.kind in {"power", "sum"} and gen.arg:
                known = self.sign(gen.arg)
            if gen.kind != "sign" and not known:  # the domain may say more later
                return self.signs.get(Value(self, {((g, 1),): 1}), 0)
            self._signed[g] = known
        return self._signed[g]

    def sign(self, value: Value) -> int:
        """Return 2 if a value is positive in the domain, 1 if it is >= 0, 0 if that is not known."""
        if value not in self._known:
            self._known[value] = self._sign(value)
        return self._known[value]

    def _sign(self, value: Value) -> int:
        if value in self.signs:
            return self.signs[value]
        found = [self._sign_of_term(mono, c) for mono, c in value.terms.items()]
        if not found or min(found) > 0:
            return max(found, default=1)
        rest = self.primitive(value, partly=True)[2] if len(value.terms) > 1 else value
        return self.signs.get(rest, 0)

    def _sign_of_term(self, mono: Mono, c: Exponent) -> int:
        known = 2 if c > 0 else 0
        for g, e in mono:
            own = self.sign_of(g)
            if own == 0 and (e % 2 == 0 or Fraction(e).denominator != 1):
                own = 1
            known = min(known, own)
        return known

    def assume(self, value: Value, sign: int) -> None:
        """Take it that a value is positive (2) or not negative (1)."""
        self._known.clear()
        self._forms.clear()
        if value.constant is None:
            rest = self.primitive(value, partly=True)[2]
            self.signs[rest] = max(sign, self.signs.get(rest, 0))
            for g in rest.generators():  # of what is but a name, the name is marked itself
                if rest == Value(self, {((g, 1),): 1}) and self.gens[g].kind == "name":
                    self._signed[g] = max(sign, self._signed.get(g, 0))

    def compare(self, op: str, left: Value, right: Value) -> Value:
        """Return 1 where a comparison holds, 0 elsewhere."""
        return self.lifted(lambda d: self._compared(SIDES[op], d), left - right)

    def _compared(self, sides: tuple[int, ...], d: Value) -> Value:
        number = d.constant
        if number is None and not self.primitive(d, partly=False)[2].terms:
            number = Fraction(0)
        if number is not None:
            return self.number(int((number > 0) - (number < 0) in sides))
        possible = {2: {1}, 1: {1, 0}, 0: {1, 0, -1}}[self.sign(d)]
        possible &= {2: {-1}, 1: {-1, 0}, 0: {1, 0, -1}}[self.sign(-d)]
        if possible <= {*sides}:
            return self.one
        forms, turn = self._forms_of(d)
        found = []
        for chosen in product((1, 0, -1), repeat=len(forms)):
            if prod(chosen) * turn in {*sides} & possible:
                parts = (self.generator("sign", f, s) for f, s in zip(forms, chosen, strict=True))
                found.append(reduce(self.times, parts, self.one))
        return self.total(found)

    def _forms_of(self, d: Value) -> tuple[list[Value], int]:
        """Return values without positive factors whose signs, multiplied, are that of d times 1 or -1."""
        if d not in self._forms:
            size, common, rest = self.primitive(d, partly=False)
            turn, forms = (1 if size > 0 else -1), list[Value]()
            powers = [(Value(self, {((g, 1),): 1}), e) for g, e in common]
            for factor, e in (*powers, *self._factors(rest, whole=True)):
                whole = Fraction(e).denominator == 1
                known, below = self.sign(factor), self.sign(-factor)
                if below == 2 and e % 2:
                    turn = -turn
                elif known < 2 and below < 2:
                    own, side = self._bent(factor if whole else self.power(factor, Fraction(e)))
                    forms += own if e % 2 else own * 2
                    turn *= side if e % 2 else 1
            self._forms[d] = forms, turn
        return self._forms[d]

    def _bent(self, factor: Value) -> tuple[list[Value], int]:
        """Return the values whose signs are that of a factor: tanh has that of its argument."""
        (mono, c), *more = factor.terms.items()
        gen = self.gens[mono[0][0]] if len(mono) == 1 and mono[0][1] == 1 else None
        if not more and gen and gen.kind == "tanh" and gen.arg:
            return self._forms_of(gen.arg * self.number(c))
        lead = Fraction(factor.terms[max(factor.terms)])
        return [factor * self.number(1 / lead)], 1 if lead > 0 else -1

    def lifted(self, function: Callable[[Value], Value], value: Value) -> Value:
        """Return a function of a value whose signs choose what it is: of each choice."""
        first = next((g for g in sorted(value.generators()) if self.gens[g].kind == "sign"), None)
        if first is None:
            return function(value)
        form, path, parts = self.gens[first].arg, self.path, []
        assert form is not None
        for side in (1, 0, -1):
            chosen = self.generator("sign", form, side)
            self.path = path and path * chosen
            parts.append(chosen * self.lifted(function, self.at(value, {form: side})))
        self.path = path
        return self.total(parts)

    def at(self, value: Value, sides: Mapping[Value, int]) -> Value:
        """Return a value where some differences have given signs."""
        terms: dict[Mono, Exponent] = {}
        for mono, c in value.terms.items():
            left = []
            for g, e in mono:
                gen = self.gens[g]
                if gen.kind != "sign" or gen.arg not in sides:
                    left.append((g, e))
                elif sides[gen.arg] != gen.mark:
                    break
            else:
                terms[tuple(left)] = terms.get(tuple(left), 0) + c
        return Value(self, terms)

    def choose(self, test: Value, then: Value, other: Value) -> Value:
        """Return one value where `test` is 1 and the other where it is 0."""
        return test * then + (self.one - test) * other

    def _needs(self, kind: str, value: Value) -> None:
        enough = 2 if kind != "nonnegative" else 1
        if self.path is not None and self.sign(value) < enough and self.sign(-value) < 2:
            self.needs[Need(kind, value, self.path, self.derived)] = None

    def _undefined(self, kind: str) -> Value:
        """Return 1/0 or log(0): a name of which nothing is known, needed nowhere."""
        if self.path is not None:
            self.needs[Need(kind, self.zero, self.path, self.derived)] = None
        return self.generator("name", None, (f"not {kind}", None, 0))

    # Functions

    def call(self, function: str, arg: Value) -> Value:
        """Return exp, log, sin, cos or tanh of a value."""
        own = {"exp": self._exp, "log": self._log}.get(function)
        return self.lifted(own or partial(self._even_or_odd, function), arg)

    def _exp(self, arg: Value) -> Value:
        made = self.one
        for mono, c in arg.terms.items():
            gen = self.gens[mono[0][0]] if len(mono) == 1 and mono[0][1] == 1 else None
            if gen and gen.kind == "log" and gen.arg:
                made = made * self.power(gen.arg, Fraction(c))
                continue
            (inner,) = self.generator("exp", Value(self, {mono: 1})).terms
            made = made * Value(self, {((inner[0][0], c),): 1})
        return made

    def _log(self, arg: Value) -> Value:
        if not arg.terms:
            return self._undefined("positive")
        self._needs("positive", arg)
        (mono, c), *more = arg.terms.items()
        if more or c <= 0 or any(self.sign_of(g) < 2 for g, _ in mono):
            return self.generator("log", arg)
        whole = Fraction(c)
        parts = [
            self.generator("log", self.number(n)) * self.number(s)
            for n, s in ((whole.numerator, 1), (whole.denominator, -1))
            if n != 1
        ]
        for g, e in mono:
            gen, factor = self.gens[g], Value(self, {((g, 1),): 1})
            log = gen.arg if gen.kind == "exp" and gen.arg else self.generator("log", factor)
            parts.append(log * self.number(e))
        return self.total(parts)

    def _even_or_odd(self, function: str, arg: Value) -> Value:
        if not arg.terms:
            return self.one if function == "cos" else self.zero
        if arg.terms[max(arg.terms)] > 0:
            return self.generator(function, arg)
        made = self.generator(function, -arg)
        return made if function == "cos" else -made

    def size(self, value: Value) -> Value:
        """Return the absolute value."""
        return value * self.side(value)

    def side(self, value: Value) -> Value:
        """Return 1, 0 or -1, the sign of a value."""
        return self.compare(">", value, self.zero) - self.compare("<", value, self.zero)

    def lane_sum(self, value: Value, bank: str) -> Value:
        """Return the sum of a value over the lanes of a bank."""
        parts = []
        for mono, c in value.terms.items():
            own = tuple((g, e) for g, e in mono if (bank, 0) in self.gens[g].lanes)
            free = Value(self, {tuple(p for p in mono if p not in own): c})
            inner = Value(self, {own: 1})
            parts.append(free * (self.generator("sum", inner, bank) if own else self.count(bank)))
        return self.total(parts)

    def count(self, bank: str) -> Value:
        """Return the size of a bank."""
        return self.name(f"{bank}_count", None, -1, sign=2)
