"""Energies of storage elements from their co-state laws, and co-states from energies.

Input: a tree and a name.  Output: a tree, or None where an integral has no simple form.  Where two
branches meet at the edge e, one of the antiderivatives has a constant added, so that both have one
value there.  Where rules give none, the variable is the distance from the edge, which is positive
on both sides: the logarithms and roots of an integral then are of what is positive.
"""

from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import reduce
from itertools import islice
from math import prod
from typing import final

from piezo_sym.expressions.calculus import add, compared, derivative, div, inserted, mul, neg
from piezo_sym.expressions.integrals import MAX_PARTS, NoFormError, by_rules, divided, slope_of
from piezo_sym.expressions.reflection import reflected
from piezo_sym.expressions.tidying import collected, settled, tidied
from piezo_sym.expressions.tree import (
    ONE,
    ZERO,
    Add,
    Call,
    Cmp,
    Div,
    Expr,
    If,
    Mul,
    Neg,
    Node,
    Num,
    Pow,
    Sym,
    children,
    decided,
    first_choice,
    names,
    rebuild,
    walk,
)

#: Of higher powers no factors are taken apart.
MOST_FACTORS = 8
#: Of more pieces, or pieces of more than MAX_PARTS, no energy is written: it is asked for.
MOST_PIECES = 128
Otherwise = Callable[[Expr, str, frozenset[str]], Expr | None]


def antiderivative(
    node: Expr,
    name: str,
    otherwise: Otherwise | None = None,
    positive: frozenset[str] = frozenset(),
) -> Expr | None:
    """Return an antiderivative of `node` by `name`, or None where there is none of a simple form.

    Known forms are those of `integrals`, and choices between such where comparisons are affine.

    Parameters
    ----------
    otherwise : is asked for those of smooth branches of other forms, with the names that are
        positive there.
    positive : names that are; they decide how some edges are ordered.
    """
    with suppress(NoFormError):
        return by_rules(node, name)
    plain = compared(node)
    condition = first_choice(plain)
    if isinstance(node, Add) and (condition or not otherwise):
        found = [antiderivative(term, name, otherwise, positive) for term in _apart(node)]
        known = [part for part in found if part is not None]
        if len(known) == len(found):
            return add(*known)
    if condition is None:
        return otherwise(node, name, positive) if otherwise else None
    return _by_branches(plain, condition, name, otherwise, positive)


def _apart(node: Add) -> Iterator[Expr]:
    """Yield the terms of a sum that choose, and what is left of it."""
    smooth = tuple(term for term in node.terms if first_choice(compared(term)) is None)
    yield from (term for term in node.terms if term not in smooth)
    if smooth:
        yield add(*smooth)


def slope(energy: Expr, name: str) -> Expr:
    """Return the derivative of an energy by `name`; each term with kinks is a choice of slopes."""
    if name not in names(energy):
        return ZERO
    if isinstance(energy, Add):
        return add(*(slope(term, name) for term in energy.terms))
    plain = compared(energy)
    condition = first_choice(plain)
    if condition is None:
        return derivative(plain, name)
    then, other = (slope(decided(plain, {condition: h}), name) for h in (True, False))
    return then if then == other else If(then, condition, other)


def _by_branches(
    node: Expr,
    condition: Cmp,
    name: str,
    otherwise: Otherwise | None,
    positive: frozenset[str],
) -> Expr | None:
    """Return the antiderivative of a choice from those of what it chooses between."""
    if sum(1 for _ in walk(node)) > MAX_PARTS or _pieces(node) > MOST_PIECES:
        return None
    difference = collected(condition.left, neg(condition.right))
    sides = tuple(decided(node, {condition: holds}) for holds in (True, False))
    if name not in names(difference):
        found = _each(sides, name, otherwise, positive)
        return If(found[0], condition, found[1]) if found else None
    slope = slope_of(difference, name)
    if slope is None:
        return None
    edge = _Edge(condition, difference, slope, name, sides, positive)
    with suppress(ZeroDivisionError):
        return edge.odd(otherwise) or edge.joined(otherwise)
    return None


def _each(
    parts: Iterable[Expr], name: str, otherwise: Otherwise | None, positive: frozenset[str]
) -> tuple[Expr, ...]:
    """Return the antiderivative of each of some trees; nothing if one has none, or a long one."""
    found: list[Expr] = []
    for part in parts:
        own = antiderivative(part, name, otherwise, positive)
        if own is None or _is_long(own):
            return ()
        found.append(own)
    return tuple(found)


@final
@dataclass(frozen=True)
class _Edge:
    """Where a comparison that is affine in `name` turns: where `difference` of its sides is zero.

    `slope` is that of the difference, and `sides` the law where the comparison holds, and else.
    """

    condition: Cmp
    difference: Expr
    slope: Expr
    name: str
    sides: tuple[Expr, ...]
    positive: frozenset[str]

    def odd(self, otherwise: Otherwise | None) -> Expr | None:
        """Return the antiderivative of what is odd about the edge: one of the distance from it."""
        above, below = self._outward()
        if above != below:
            return None
        found = _each((above,), self.name, otherwise, self.positive | {self.name})
        return self._at(found[0], Call("abs", (self.difference,))) if found else None

    def joined(self, otherwise: Otherwise | None) -> Expr | None:
        """Return the antiderivative by those of the sides, by rules in the name itself.

        Or else in the distance from the edge, where `otherwise` may be asked.
        """
        found = _each(self.sides, self.name, None, self.positive)
        if not found and otherwise:
            near = self.positive | {self.name}
            found = _each(self._outward(), self.name, otherwise, near)
            ways = self.difference, collected(neg(self.difference))
            found = tuple(self._at(*pair) for pair in zip(found, ways, strict=False))
            found = found if self._rises else found[::-1]
        if not found:
            return None
        at = {self.name: self._place}
        then, other = (tidied(settled(inserted(part, at), self.positive)) for part in found)
        shift = ZERO if then == other else add(then, neg(other))
        return If(found[0], self.condition, add(found[1], shift))

    @property
    def _rises(self) -> bool:
        """Whether the comparison holds where the difference is positive."""
        return self.condition.op in {">", ">="}

    @property
    def _place(self) -> Expr:
        """The value of the name at the edge."""
        core = self.difference
        while isinstance(core, Div) and self.name not in names(core.right):
            core = core.left
        return divided(neg(inserted(core, {self.name: ZERO})), derivative(core, self.name))

    def _at(self, found: Expr, distance: Expr) -> Expr:
        """Return an antiderivative by the distance as one by the name."""
        return divided(tidied(inserted(found, {self.name: distance})), self.slope)

    def _outward(self) -> tuple[Expr, Expr]:
        """Return the law above the edge, and minus that below, of the distance from the edge."""
        above, below = map(self._shifted, self.sides if self._rises else self.sides[::-1])
        turned = neg(reflected(inserted(below, {}), self.name))
        near = self.positive | {self.name}
        one, other = (settled(side, near) for side in (inserted(above, {}), turned))
        return inserted(one, {}), inserted(other, {})

    def _shifted(self, node: Expr) -> Expr:
        """Return a law of the difference, which has the same name."""
        slope = slope_of(node, self.name)
        if slope is None:
            return rebuild(node, self._shifted)
        ratio = ONE if slope == self.slope else divided(slope, self.slope)
        return collected(mul(ratio, Sym(self.name)), inserted(node, {self.name: self._place}))


def _pieces(node: Node) -> int:
    """Return how many branches the choices of a tree make together, at most."""
    if isinstance(node, If):
        return _pieces(node.condition) * (_pieces(node.then) + _pieces(node.other))
    return prod(map(_pieces, children(node)))


def _is_long(node: Node) -> bool:
    return next(islice(walk(node), MAX_PARTS, None), None) is not None


def without_common_factors(node: Expr, name: str) -> Expr:
    """Return a product or quotient without factors of `name` above and below: sinh(x)/x*x.

    These are polynomials, which have a value everywhere: of log(x)/log(x) nothing is left out.
    """
    above, below = _factors(node)
    one: Expr = ONE
    both = [f for f in above if f in below and name in names(f) and _is_polynomial(f)]
    if not both:
        return node
    for factor in both:
        if factor in below:
            above.remove(factor)
            below.remove(factor)
    top, bottom = (reduce(mul, factors, one) for factors in (above, below))
    return div(top, bottom)


def _is_polynomial(node: Node) -> bool:
    if isinstance(node, Pow) and (node.exponent < 0 or node.exponent.denominator != 1):
        return False
    known = isinstance(node, Num | Sym | Neg | Add | Mul | Pow)
    return known and all(map(_is_polynomial, children(node)))


def _factors(node: Expr) -> tuple[list[Expr], list[Expr]]:
    """Return the factors above and below the line, whole powers a factor at a time."""
    match node:
        case Mul(left, right) | Div(left, right):
            (above, below), other = _factors(left), _factors(right)
            more, less = other if isinstance(node, Mul) else other[::-1]
            return [*above, *more], [*below, *less]
        case Pow(base, exponent) if exponent.denominator == 1 and 0 < exponent <= MOST_FACTORS:
            above, below = _factors(base)
            return above * exponent.numerator, below * exponent.numerator
    return [node], []
