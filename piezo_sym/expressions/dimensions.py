"""Dimensions of laws, and the rules of units that they obey or break.

Input: a tree, and the dimension of each name in it.  Output: its dimension, and the `Match`es that
fail.  A dimension is a vector of powers of the base units `BASES`, so the dimension of a
product of powers is linear in those of its names: `powers` gives the coefficients, and what a
rule asks for is one linear equation.  The rules:

    a + b, min, max, deadzone, saturate, a if c else b, a < b     equal units
    exp log sin cos tanh expm1 pow                                arguments without unit, no unit
    sign                                                          any argument, no unit
    table(x, x_1, y_1, ...)                                       x as all x_k; value as all y_k
    abs, -a                                                       keep
    a*b, a/b, a**(p/q), sqrt                                      add, subtract, multiply, halve

The literal 0 fits any unit, and so does what is 0 times something; other literals have none.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import TypeAlias, final

from piezo_sym.expressions.functions import RECORDS
from piezo_sym.expressions.tree import (
    ZERO,
    Add,
    Call,
    Cmp,
    Div,
    Expr,
    If,
    LaneSum,
    Mul,
    Neg,
    Node,
    Num,
    Pow,
    Sym,
    children,
    knots,
    walk,
)

#: The SI base units whose powers a dimension is.
BASES = ("kg", "m", "s", "A", "K", "mol", "cd")
Dimension: TypeAlias = tuple[Fraction, ...]
Powers: TypeAlias = Mapping[str, Fraction]

NONE: Dimension = (Fraction(0),) * len(BASES)


def times(left: Dimension, right: Dimension, power: Fraction | int = 1) -> Dimension:
    """Return the dimension of ``left * right**power``."""
    return tuple(a + power * b for a, b in zip(left, right, strict=True))


@final
@dataclass(frozen=True)
class Match:
    """One rule at one place of a tree: two dimensions that must be equal."""

    node: Node  # the smallest term that contains both
    left: Expr  # the part that is checked
    #: The part that it must match; None if it must have the dimension `needed`.
    right: Expr | None = None
    needed: Dimension = NONE  # the dimension that left over right must have

    @property
    def whole(self) -> bool:
        """Whether the rule is about a law itself, not about two parts of it."""
        return self.left == self.node

    @property
    def excess(self) -> Powers:
        """The powers of each name in left over right; names that cancel are left out."""
        right = {} if self.right is None else powers(self.right) or {}
        return _product(powers(self.left) or {}, right, Fraction(-1))

    def gap(self, words: Mapping[str, Dimension]) -> Dimension:
        """Return the dimension missing from left over right; `NONE` if they match."""
        if powers(self.left) is None:
            return NONE
        return times(self.needed, of_powers(self.excess, words), -1)


def _product(left: Powers, right: Powers, power: Fraction) -> Powers:
    names = dict.fromkeys([*left, *right])
    total = {name: left.get(name, Fraction(0)) + power * right.get(name, 0) for name in names}
    return {name: value for name, value in total.items() if value}


def of_powers(factors: Powers, words: Mapping[str, Dimension]) -> Dimension:
    """Return the dimension of a product of powers of names."""
    total = NONE
    for name, power in factors.items():
        total = times(total, words[name], power)
    return total


def dimension(node: Expr, words: Mapping[str, Dimension]) -> Dimension | None:
    """Return the dimension of a tree without faults, or None if it is zero and fits any."""
    factors = powers(node)
    return None if factors is None else of_powers(factors, words)


def powers(node: Expr) -> Powers | None:
    """Return the dimension of a tree as powers of its names, or None if it is zero and fits any.

    Of parts that must match, the first one that is not zero counts.
    """
    match node:
        case Num(value):
            return None if value == 0 else {}
        case Sym(name):
            return {name: Fraction(1)}
        case Neg(arg) | LaneSum(arg, _):
            return powers(arg)
        case Add(terms):
            return _first(terms)
        case If(then, _, other):
            return _first((then, other))
        case Mul(left, right):
            return _product_powers(left, right, Fraction(1))
        case Div(left, right):
            return _product_powers(left, right, Fraction(-1))
        case Pow(base, exponent):
            return _raised(base, exponent)
        case Call(function, args):
            return _call_powers(function, args)


def _first(parts: Iterable[Expr]) -> Powers | None:
    return next((factors for factors in map(powers, parts) if factors is not None), None)


def _product_powers(left: Expr, right: Expr, power: Fraction) -> Powers | None:
    first, second = powers(left), powers(right)
    return None if first is None or second is None else _product(first, second, power)


def _raised(base: Expr, exponent: Fraction) -> Powers | None:
    if exponent == 0:
        return {}
    inner = powers(base)
    return None if inner is None else {name: power * exponent for name, power in inner.items()}


def _call_powers(function: str, args: tuple[Expr, ...]) -> Powers | None:
    record = RECORDS[function]
    if record.units in {"pure", "none"}:
        return {}
    if record.knots:
        return _first(args[2::2])
    return _first(args) if record.power is None else _raised(args[0], record.power)


def matches(node: Node) -> Iterator[Match]:
    """Yield every rule that the parts of a tree must obey, innermost first."""
    for part in children(node):
        yield from matches(part)
    match node:
        case Call(function, args) if RECORDS[function].units == "pure":
            yield from (Match(node, arg) for arg in args)
        case Add(parts):
            yield from _equal(node, parts)
        case Call(_, (x, *_)) if pairs := knots(node):
            for parts in zip((x, ZERO), *pairs, strict=True):
                yield from _equal(node, parts)
        case Call(function, parts) if RECORDS[function].units == "equal":
            yield from _equal(node, parts)
        case If(left, _, right) | Cmp(_, left, right):
            yield from _equal(node, (left, right))


def _equal(node: Node, parts: tuple[Expr, ...]) -> Iterator[Match]:
    known = [part for part in parts if powers(part) is not None]
    for part in known[1:]:
        yield Match(node, known[0], part)


def faults(rules: Iterable[Match], words: Mapping[str, Dimension]) -> tuple[Match, ...]:
    """Return the rules that fail, one per term, without those whose parts contain a failed term."""
    failed: dict[Node, Match] = {}
    for rule in rules:
        if rule.gap(words) != NONE and failed.keys().isdisjoint(_parts(rule)):
            failed.setdefault(rule.node, rule)
    return tuple(failed.values())


def _parts(rule: Match) -> Iterator[Node]:
    """Yield all parts of a rule's sides; if one of them fails, the sides' dimension is a guess."""
    for side in (rule.node,) if rule.whole else children(rule.node):
        yield from walk(side)
