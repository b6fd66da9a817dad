"""Energies of storage elements from their co-state laws, and co-states from energies.

Input: a tree and a name.  Output: a tree, or None if an integral has no simple form.  Where two
branches meet, at an edge, a constant is added to one of the antiderivatives, so that both have the
same value there.  Where rules find no antiderivative, the variable is replaced by the distance from
the edge: it is positive on both sides, and so are the arguments of logarithms and roots.
"""

from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from itertools import islice
from math import prod
from typing import final

from piezo_sym.expressions.calculus import add, compared, derivative, inserted, mul, neg
from piezo_sym.expressions.integrals import MAX_PARTS, NoFormError, by_rules, divided, slope_of
from piezo_sym.expressions.tidying import collected, reflected, settled, tidied
from piezo_sym.expressions.tree import (
    ONE,
    ZERO,
    Add,
    Call,
    Cmp,
    Div,
    Expr,
    If,
    Node,
    Sym,
    children,
    decided,
    first_choice,
    names,
    rebuild,
    walk,
)

#: No energy is found for a law of more pieces, or of pieces of more than MAX_PARTS nodes.
MOST_PIECES = 128
Otherwise = Callable[[Expr, str, frozenset[str]], Expr | None]


def antiderivative(
    node: Expr,
    name: str,
    otherwise: Otherwise | None = None,
    positive: frozenset[str] = frozenset(),
) -> Expr | None:
    """Return an antiderivative of `node` by `name`, or None if it has no simple form.

    Known forms are those of `integrals`, and choices between them by affine comparisons.  Where
    rules have none, `otherwise` gives that of a smooth branch.  The values of the names in
    `positive` are so; they decide the order of some edges.
    """
    with suppress(NoFormError):
        return by_rules(node, name)
    plain = compared(node)
    condition = first_choice(plain)
    if isinstance(node, Add) and condition:
        terms = [antiderivative(term, name, otherwise, positive) for term in _split(node)]
        known = [term for term in terms if term is not None]
        if len(known) == len(terms):
            return add(*known)
    if condition is None:
        return otherwise(node, name, positive) if otherwise else None
    return _by_branches(plain, condition, name, otherwise, positive)


def _split(node: Add) -> Iterator[Expr]:
    """Yield the terms of a sum that have choices, then the sum of the smooth ones."""
    smooth = tuple(term for term in node.terms if first_choice(compared(term)) is None)
    yield from (term for term in node.terms if term not in smooth)
    if smooth:
        yield add(*smooth)


def slope(energy: Expr, name: str) -> Expr:
    """Return the derivative of an energy by `name`, terms with kinks as choices of slopes."""
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
    """Return the antiderivative of a choice by `condition` from those of its branches."""
    if sum(1 for _ in walk(node)) > MAX_PARTS or _pieces(node) > MOST_PIECES:
        return None
    difference = collected(condition.left, neg(condition.right))
    sides = tuple(decided(node, {condition: holds}) for holds in (True, False))
    if name not in names(difference):
        parts = _antiderivatives(sides, name, otherwise, positive)
        return If(parts[0], condition, parts[1]) if parts else None
    slope = slope_of(difference, name)
    if slope is None:
        return None
    edge = _Edge(condition, difference, slope, name, sides, positive)
    with suppress(ZeroDivisionError):
        return edge.odd(otherwise) or edge.joined(otherwise)
    return None


def _antiderivatives(
    branches: Iterable[Expr], name: str, otherwise: Otherwise | None, positive: frozenset[str]
) -> tuple[Expr, ...]:
    """Return the antiderivative of each branch; nothing if one has none, or too long a one."""
    results: list[Expr] = []
    for branch in branches:
        result = antiderivative(branch, name, otherwise, positive)
        if result is None or _is_long(result):
            return ()
        results.append(result)
    return tuple(results)


@final
@dataclass(frozen=True)
class _Edge:
    """The edge of a comparison that is affine in `name`: the zero of the `difference` of its sides.

    `slope` is that of the difference; `sides` are the law where it holds, then where it does not.
    """

    condition: Cmp
    difference: Expr
    slope: Expr
    name: str
    sides: tuple[Expr, ...]
    positive: frozenset[str]

    def odd(self, otherwise: Otherwise | None) -> Expr | None:
        """Return the antiderivative of a law that is odd about the edge, or None if it is not."""
        above, below = self._outward()
        if above != below:
            return None
        parts = _antiderivatives((above,), self.name, otherwise, self.positive | {self.name})
        return self._by_name(parts[0], Call("abs", (self.difference,))) if parts else None

    def joined(self, otherwise: Otherwise | None) -> Expr | None:
        """Return the antiderivatives of both sides, shifted to meet at the edge.

        Rules integrate over the name itself, `otherwise` over the distance from the edge.
        """
        parts = _antiderivatives(self.sides, self.name, None, self.positive)
        if not parts and otherwise:
            near = self.positive | {self.name}
            parts = _antiderivatives(self._outward(), self.name, otherwise, near)
            distances = self.difference, collected(neg(self.difference))
            parts = tuple(self._by_name(*pair) for pair in zip(parts, distances, strict=False))
            parts = parts if self._rises else parts[::-1]
        if not parts:
            return None
        at = {self.name: self._place}
        then, other = (tidied(settled(inserted(part, at), self.positive)) for part in parts)
        shift = ZERO if then == other else add(then, neg(other))
        return If(parts[0], self.condition, add(parts[1], shift))

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

    def _by_name(self, part: Expr, distance: Expr) -> Expr:
        """Return an antiderivative over the distance as one over the name."""
        return divided(tidied(inserted(part, {self.name: distance})), self.slope)

    def _outward(self) -> tuple[Expr, Expr]:
        """Return the law above the edge and minus that below, as functions of the distance."""
        above, below = map(self._shifted, self.sides if self._rises else self.sides[::-1])
        turned = neg(reflected(inserted(below, {}), self.name))
        near = self.positive | {self.name}
        one, other = (settled(side, near) for side in (inserted(above, {}), turned))
        return inserted(one, {}), inserted(other, {})

    def _shifted(self, node: Expr) -> Expr:
        """Return the law as a function of the difference, for which `name` stands then."""
        slope = slope_of(node, self.name)
        if slope is None:
            return rebuild(node, self._shifted)
        ratio = ONE if slope == self.slope else divided(slope, self.slope)
        return collected(mul(ratio, Sym(self.name)), inserted(node, {self.name: self._place}))


def _pieces(node: Node) -> int:
    """Return an upper bound on the number of branches of a tree."""
    if isinstance(node, If):
        return _pieces(node.condition) * (_pieces(node.then) + _pieces(node.other))
    return prod(map(_pieces, children(node)))


def _is_long(node: Node) -> bool:
    return next(islice(walk(node), MAX_PARTS, None), None) is not None
