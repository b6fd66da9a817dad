"""Whether a value without signs is zero once its denominators are multiplied out.

Input: a `Value`.  Output: whether its numerator, a polynomial in roots of generators, has no terms.
The polynomials are FLINT's: products of sums with hundreds of terms take milliseconds there.
"""

from collections.abc import Collection
from contextlib import suppress
from fractions import Fraction
from math import lcm
from operator import neg, sub

from flint import Ordering, fmpq, fmpq_mpoly, fmpq_mpoly_ctx

from piezo_sym.translation.change import put
from piezo_sym.translation.field import NotShownError, Value
from piezo_sym.translation.functions import power
from piezo_sym.translation.signs import has_sign, on_path, sign_of

MOST_TERMS = 200_000
#: Costs, in products of two terms by `GeneratorField`: FLINT multiplies two terms at 1/FASTER; to
#: pass a term to FLINT costs SLOWER.
FASTER, SLOWER = 30, 3


class _Roots:
    """Generators as powers of variables: g = y**d, where d makes every exponent of g whole.

    Attributes
    ----------
    order : the indices of the generators; a generator comes after those in its argument.
    place : the position of each generator in `order`.
    whole : the exponent d of each generator.
    ring : the polynomials in the variables y.
    """

    def __init__(self, *values: Value) -> None:
        self.field = values[0].field
        self.gens = self.field.gens
        self.order = sorted(frozenset[int]().union(*(value.parts for value in values)))
        self.place = {g: n for n, g in enumerate(self.order)}
        self.whole = dict.fromkeys(self.order, 1)
        for one in (*values, *(arg for g in self.order if (arg := self.gens[g].arg))):
            for g, e in (factor for mono in one.terms for factor in mono):
                self.whole[g] = lcm(self.whole[g], Fraction(e).denominator)
        names = tuple(f"y{g}" for g in self.order)
        self.ring = fmpq_mpoly_ctx.get(names, Ordering.lex)

    def of(self, value: Value) -> tuple[fmpq_mpoly, fmpq_mpoly]:
        """Return a polynomial and a monomial in y whose ratio is the value."""
        self.field.spend(SLOWER * len(value.terms))
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
        """Return a multiple of a polynomial with integer powers of a generator written out."""
        n, whole, arg = self.place[g], self.whole[g], self.gens[g].arg
        assert arg is not None
        most = value.degrees()[n] // whole
        if most < 1:
            return value
        above, below = self.of(arg)
        y, made = self.ring.gen(n), self.ring.from_dict({})
        for k in range(value.degrees()[n], whole - 1, -1):
            part = value
            for order in range(1, k + 1):
                part = part.derivative(n) / order
            value -= part * y**k
            part *= y ** (k % whole) * below ** (most - k // whole)
            for _ in range(k // whole):
                part = self._product(part, above)
            made += part
        return made + value * below**most

    def _product(self, left: fmpq_mpoly, right: fmpq_mpoly) -> fmpq_mpoly:
        self.field.spend(len(left) * len(right) // FASTER)
        made = left * right
        if len(made) > MOST_TERMS:
            raise NotShownError("the expressions are too large")
        return made

    def numerator(self, value: Value, kinds: Collection[str]) -> fmpq_mpoly:
        """Return a value times its denominators, generators of some kinds written out."""
        found, _ = self.of(value)
        for g in reversed(self.order):
            if self.gens[g].kind in kinds and not found.is_zero():
                found = self.written_out(found, g)
        return found

    def have_roots(self, value: fmpq_mpoly) -> bool:
        """Return whether roots of sums are left in a polynomial: they are not independent."""
        found = zip(self.order, value.degrees(), strict=True)
        return any(degree and self.gens[g].kind in {"power", "letter"} for g, degree in found)


def vanishes(value: Value) -> bool:
    """Return whether a value's numerator has no terms, its generators taken as independent.

    Powers of sums are written out first.  If terms are left, a letter is replaced by a name if
    possible, which keeps products short; else all letters are written out.
    """
    if not value.terms:
        return True
    roots = _Roots(value)
    if roots.numerator(value, ("power",)).is_zero():
        return True
    letters = [g for g in reversed(roots.order) if roots.gens[g].kind == "letter"]
    new = next(filter(None, (renamed(value, letter) for letter in letters)), None)
    if new is not None:
        return vanishes(new)
    return bool(letters) and roots.numerator(value, ("power", "letter")).is_zero()


def renamed(value: Value, letter: int) -> Value | None:
    """Return a value with a name in place of a letter that is linear in a state, else None.

    The letter is rest + factor*state with a factor that is nowhere zero, and the state is expressed
    by the new name: an equation holds for all values of the state if it does for all of the name.
    """
    field, arg = value.field, value.field.gens[letter].arg
    assert arg is not None
    linear = not any(field.gens[g].kind == "sign" for g in arg.parts)
    for g in sorted(arg.parts & field.states) if linear else ():
        own = Value(field, {mono: c for mono, c in arg.terms.items() if (g, 1) in mono})
        rest, factor = arg - own, own * Value(field, {((g, -1),): 1})
        alone = g not in factor.parts | rest.parts and not sign_of(field, g)
        if alone and has_sign(factor) and arg.lanes == field.gens[g].lanes:
            bank, lane = next(iter(arg.lanes), (None, 0))
            new = field.name(f"letter {letter}", bank, lane)
            field.states |= new.parts
            with suppress(NotShownError):  # if the name would occur in a sum over lanes
                return put(value, {letter: new, g: (new - rest) * inverse(factor)})
    return None


def inverse(value: Value) -> Value:
    """Return 1/value without noting that the value must not be zero."""
    with on_path(value.field, None):
        return power(value, Fraction(-1))


def vanishes_with(value: Value, other: Value) -> bool:
    """Return whether a value is shown to be zero wherever another value is.

    Its numerator is a multiple of the other's, and no denominator vanishes there: 0/0 is not 0.
    """
    roots, kinds = _Roots(value, other), ("power", "letter")
    above, below = (roots.numerator(one, kinds) for one in (value, other))
    if below.is_zero() or not divmod(above, below)[1].is_zero():
        return False
    apart = (d for d in divisors(value) if d.parts & other.parts and not has_sign(d))
    found = [roots.numerator(d, kinds) for d in apart]
    if any(roots.have_roots(one) for one in (above, below, *found)):  # roots are not independent
        return not found
    return all(one.gcd(below).is_one() for one in found)


def divisors(value: Value) -> list[Value]:
    """Return the generators by which a value is divided, its sums and letters written out."""
    gens, found, left = value.field.gens, dict[int, None](), [value]
    while left:
        for g, e in {factor for mono in left.pop().terms for factor in mono}:
            arg = gens[g].arg
            found |= {g: None} if e < 0 else {}
            left += [arg] if arg and gens[g].kind in {"power", "letter"} else []
    return [value.field.raised(g, 1) for g in sorted(found)]
