"""Whether a value without signs is zero once its denominators are multiplied out.

Input: a `Value`.  Output: whether its numerator, a polynomial in roots of generators, has no terms.
The polynomials are FLINT's: products of sums with hundreds of terms take milliseconds there.
"""

from collections.abc import Collection
from fractions import Fraction
from math import lcm
from operator import neg, sub

from flint import Ordering, fmpq, fmpq_mpoly, fmpq_mpoly_ctx

from piezo_sym.translation.field import NotShownError, Value

MOST_TERMS = 200_000
#: Number of terms that a product of two polynomials may have before equal ones are joined.
MOST_PRODUCTS = 20_000_000


class _Roots:
    """Generators as powers of variables: g = y**d, where d makes every exponent of g whole.

    Attributes
    ----------
    order : the generators, by their indices; those in the argument of another one come before it.
    place : where each of them stands in `order`.
    whole : d of each.
    ring : the polynomials in the variables y.
    """

    def __init__(self, value: Value) -> None:
        self.gens = value.field.gens
        self.order = sorted(value.parts)
        self.place = {g: n for n, g in enumerate(self.order)}
        self.whole = dict.fromkeys(self.order, 1)
        for one in (value, *(arg for g in self.order if (arg := self.gens[g].arg))):
            for g, e in (factor for mono in one.terms for factor in mono):
                self.whole[g] = lcm(self.whole[g], Fraction(e).denominator)
        names = tuple(f"y{g}" for g in self.order)
        self.ring = fmpq_mpoly_ctx.get(names, Ordering.lex)

    def of(self, value: Value) -> tuple[fmpq_mpoly, fmpq_mpoly]:
        """Return a polynomial and a monomial whose ratio is the value, powers being variables."""
        least = [0] * len(self.order)
        rows = []
        for mono, c in value.terms.items():
            row = [0] * len(self.order)
            for g, e in mono:
                n = self.place[g]
                row[n] = int(e * self.whole[g])
                least[n] = min(least[n], row[n])
            rows.append((row, fmpq(c.numerator, c.denominator)))
        shifted = {tuple(map(sub, row, least)): c for row, c in rows}
        return self.ring.from_dict(shifted), self.ring.from_dict({tuple(map(neg, least)): 1})

    def written_out(self, value: fmpq_mpoly, g: int) -> fmpq_mpoly:
        """Return a multiple of a polynomial, without whole powers of a generator."""
        n, arg = self.place[g], self.gens[g].arg
        assert arg is not None
        parts: dict[int, dict[tuple[int, ...], fmpq]] = {}
        for exponents, c in value.to_dict().items():
            times, left = divmod(exponents[n], self.whole[g])
            rest = (*exponents[:n], left, *exponents[n + 1 :])
            parts.setdefault(times, {})[rest] = c
        if max(parts, default=0) == 0:
            return value
        above, below = self.of(arg)
        most, made = max(parts), self.ring.from_dict({})
        for times, terms in parts.items():
            part = self.ring.from_dict(terms) * below ** (most - times)
            for _ in range(times):
                part = _product(part, above)
            made += part
        return made


def vanishes(value: Value, kinds: Collection[str] = ("power",)) -> bool:
    """Return whether a value's numerator has no terms, its generators taken as independent.

    Whole powers of generators of the given `kinds` are replaced by those of their arguments.
    """
    if not value.terms:
        return True
    roots = _Roots(value)
    found, _ = roots.of(value)
    for g in reversed(roots.order):
        if roots.gens[g].kind in kinds:
            found = roots.written_out(found, g)
    return bool(found.is_zero())


def _product(left: fmpq_mpoly, right: fmpq_mpoly) -> fmpq_mpoly:
    if len(left) * len(right) > MOST_PRODUCTS:
        raise NotShownError("the expressions are too large")
    made = left * right
    if len(made) > MOST_TERMS:
        raise NotShownError("the expressions are too large")
    return made
