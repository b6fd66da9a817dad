"""Signs of values: known signs, comparisons, and functions of values with branches.

Input: values.  Output: values whose branches are products with signs; a comparison is 1 or 0.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from fractions import Fraction
from functools import partial, reduce
from itertools import product
from math import prod
from typing import Any

from sympy import QQ
from sympy.polys.orderings import lex
from sympy.polys.rings import PolyRing

from piezo_sym.expressions.functions import RECORDS
from piezo_sym.translation.field import Exponent, Generator, GeneratorField, Mono, Value

MOST_FACTORED = 40
SIDES = {"<": (-1,), "<=": (-1, 0), ">": (1,), ">=": (1, 0), "==": (0,), "!=": (1, -1)}
_POSSIBLE = {2: {1}, 1: {1, 0}, 0: {1, 0, -1}}


def sign_of(field: GeneratorField, g: int) -> int:
    """Return 2 if a generator is positive wherever it is defined, 1 if it is >= 0, else 0."""
    if g not in field.signed:
        gen = field.gens[g]
        known = int(gen.kind == "sign")
        if gen.kind in RECORDS and RECORDS[gen.kind].sign == ">":
            known = 2
        if gen.arg and (gen.kind in {"power", "sum", "letter"} or _bends(gen)):
            known = sign(gen.arg)
        if not known:  # not kept, as later assumptions may say more
            return field.assumed.get(field.raised(g, 1), 0)
        field.signed[g] = known
    return field.signed[g]


def _bends(gen: Generator) -> bool:
    """Return whether a function has the sign of its argument, as tanh has."""
    record = RECORDS.get(gen.kind)
    return record is not None and record.monotone and record.parity == "odd"


def sign(value: Value) -> int:
    """Return 2 if a value is positive in the domain, 1 if it is >= 0, 0 if that is not known."""
    known = value.field.signs
    if value not in known:
        known[value] = _sign(value)
    return known[value]


def _sign(value: Value) -> int:
    if value in value.field.assumed:
        return value.field.assumed[value]
    found = [_sign_of_term(value.field, mono, c) for mono, c in value.terms.items()]
    if min(found) > 0:
        return max(found)
    _, common, rest = primitive(value, partly=True)
    return min(value.field.assumed.get(rest, 0), _sign_of_term(value.field, common, 1))


def _sign_of_term(field: GeneratorField, mono: Mono, c: Exponent) -> int:
    known = 2 if c > 0 else 0
    for g, e in mono:
        even = e % 2 == 0 or Fraction(e).denominator != 1
        known = min(known, max(sign_of(field, g), int(even)))
    return known


@contextmanager
def on_path(field: GeneratorField, path: Value | None) -> Iterator[None]:
    """Set the path of the branch that is being read, until the context ends."""
    before, field.path = field.path, path
    try:
        yield
    finally:
        field.path = before


@contextmanager
def reading(field: GeneratorField, function: str) -> Iterator[None]:
    """Forget the signs known from the domain while margins or integrands are read.

    Both must hold outside the domain, too: margins decide whether a state is inside, and integrands
    are evaluated at nodes where the domain is not checked.
    """
    if function not in {"margins", "integrands"}:
        yield
        return
    kept = field.signed, field.assumed, field.signs, field.forms, field.never, field.asked
    zeros, field.zeros = field.zeros, set()
    outside, field.outside = field.outside, function
    field.signed, field.assumed = dict(field.counts), {field.zero: 1}
    field.signs, field.forms, field.never, field.asked = {}, {}, {}, {}
    try:
        yield
    finally:
        field.signed, field.assumed, field.signs, field.forms, field.never, field.asked = kept
        field.zeros = zeros
        field.outside = outside


def sides_of(d: Value) -> set[int]:
    """Return the signs that a difference may have in the domain."""
    return _POSSIBLE[sign(d)] & {-side for side in _POSSIBLE[sign(-d)]}


def has_sign(value: Value) -> bool:
    """Return whether a value is known to be positive, or negative, all over the domain."""
    return max(sign(value), sign(-value)) == 2


def assume(value: Value, known: int) -> None:
    """Assume that a value is positive (2) or not negative (1)."""
    field = value.field
    field.signs.clear()
    field.forms.clear()
    if value.constant is None:
        size, common, rest = primitive(value, partly=True)
        if known < 2 and _sign_of_term(field, common, 1) < 2:  # rest may be < 0
            rest = value * field.number(1 / size)
        field.assumed[rest] = max(known, field.assumed.get(rest, 0))
        for g in rest.generators():  # if the value is a mere name, mark the name itself
            if rest == field.raised(g, 1) and field.gens[g].kind == "name":
                field.signed[g] = max(known, field.signed.get(g, 0))


def primitive(value: Value, *, partly: bool) -> tuple[Fraction, Mono, Value]:
    """Return (number, common factors, rest) of a value; the leading coefficient of rest is 1 or -1.

    With `partly`, only positive factors (or factors >= 0 with a positive exponent) are taken out.
    A factor with a fractional exponent is one: where the root of it exists, it is >= 0.  The rest
    has the sign of the value where these factors are not 0, and any sign where one is.
    """
    field, least = value.field, dict[int, Exponent]()
    monos = [dict(mono) for mono in value.terms]
    for g in value.generators():
        e, known = min(mono.get(g, 0) for mono in monos), sign_of(field, g)
        is_root = Fraction(e).denominator != 1
        if e and (not partly or is_root or known == 2 or (known == 1 and e > 0)):
            least[g] = e
    common = tuple(sorted(least.items()))
    rest = value * Value(field, {tuple((g, -e) for g, e in common): 1}) if common else value
    if not rest.terms:
        return Fraction(1), (), rest
    size = abs(rest.lead) if partly else rest.lead
    return size, common, rest if size == 1 else rest * field.number(1 / size)


def factors(value: Value) -> list[tuple[Value, int]]:
    """Return the irreducible factors of a sum without common factors, and how often they occur."""
    known = value.field.factors
    if value not in known:
        exponents = {Fraction(e).denominator for mono in value.terms for _, e in mono}
        whole = 1 < len(value.terms) <= MOST_FACTORED and exponents == {1}
        known[value] = _factored(value) if whole else [(value, 1)]
    return known[value] if value != value.field.one else []


def _factored(value: Value) -> list[tuple[Value, int]]:
    field, numbers, table = value.field, sorted(value.generators()), dict[Any, Any]()
    for mono, c in value.terms.items():
        powers = dict(mono)
        table[tuple(int(powers.get(g, 0)) for g in numbers)] = QQ(c.numerator, c.denominator)
    found = []
    ring = PolyRing([f"g{g}" for g in numbers], QQ, lex)
    scale, parts = ring.from_dict(table).factor_list()
    whole = Fraction(int(scale.numerator), int(scale.denominator))
    for factor, times in parts:
        terms = {
            tuple((g, e) for g, e in zip(numbers, powers, strict=True) if e): Fraction(
                int(c.numerator), int(c.denominator)
            )
            for powers, c in factor.terms()
        }
        made = Value(field, terms)
        found.append((made * field.number(1 / made.lead), times))
        whole = whole * made.lead**times
    # the leading coefficient of a product need not be the product of those of its factors
    return found if whole == 1 else [(field.number(whole), 1), *found]


def compare(op: str, left: Value, right: Value) -> Value:
    """Return 1 where a comparison holds, 0 elsewhere."""
    return lifted(partial(_compared, SIDES[op]), left - right)


def _compared(sides: tuple[int, ...], d: Value) -> Value:
    field, number = d.field, d.constant
    if number is None and not primitive(d, partly=False)[2].terms:
        number = Fraction(0)
    if number is not None:
        return field.number(int((number > 0) - (number < 0) in sides))
    possible = sides_of(d)
    if possible <= {*sides}:
        return field.one
    forms, turn = _forms(d)
    found = []
    for chosen in product((1, 0, -1), repeat=len(forms)):
        if prod(chosen) * turn in {*sides} & possible:
            parts = (field.generator("sign", f, s) for f, s in zip(forms, chosen, strict=True))
            found.append(reduce(field.times, parts, field.one))
    return field.total(found)


def _forms(d: Value) -> tuple[list[Value], int]:
    """Return values, and 1 or -1, such that the product of their signs is the sign of d."""
    field = d.field
    if d not in field.forms:
        size, common, rest = primitive(d, partly=False)
        turn, forms = (1 if size > 0 else -1), list[Value]()
        powers = [(field.raised(g, e if Fraction(e).denominator != 1 else 1), e) for g, e in common]
        for factor, e in (*powers, *factors(rest)):
            if sign(-factor) == 2:
                turn = -turn if e % 2 else turn
            elif sign(factor) < 2:
                own, side = _bent(factor)
                forms += own if e % 2 else own * 2
                turn *= side if e % 2 else 1
        field.forms[d] = forms, turn
    return field.forms[d]


def _bent(factor: Value) -> tuple[list[Value], int]:
    """Return the result of `_forms` for a factor; tanh and the like have their argument's sign."""
    (mono, c), *more = factor.terms.items()
    gen = factor.field.gens[mono[0][0]] if len(mono) == 1 and mono[0][1] == 1 else None
    if not more and gen and gen.arg and _bends(gen):
        return _forms(gen.arg * factor.field.number(c))
    return [factor * factor.field.number(1 / factor.lead)], 1 if factor.lead > 0 else -1


def lifted(function: Callable[[Value], Value], value: Value) -> Value:
    """Return a function of a value with branches, applied on each branch."""
    field = value.field
    first = next((g for g in sorted(value.generators()) if field.gens[g].kind == "sign"), None)
    form = field.gens[first].arg if first is not None else None
    if form is None:
        return function(value)
    parts = []
    for side in (1, 0, -1):
        chosen = field.generator("sign", form, side)
        with on_path(field, field.path and field.path * chosen):
            parts.append(chosen * lifted(function, field.at(value, {form: side})))
    return field.total(parts)


def choose(test: Value, then: Value, other: Value) -> Value:
    """Return one value where `test` is 1 and the other where it is 0."""
    return test * then + (test.field.one - test) * other


def side_of(value: Value) -> Value:
    """Return 1, 0 or -1, the sign of a value."""
    zero = value.field.zero
    return compare(">", value, zero) - compare("<", value, zero)
