"""The small tree in which laws are kept, from the spec to the printers.

Input: nothing; these are the types.  Output: frozen nodes, and the walks that every stage shares:
which names occur, renaming, replacement.  A tree is data: it cannot execute.  A `LaneSum` never
comes from a spec; lowering makes it for sums over the lanes of a bank.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from operator import eq, ge, gt, le, lt, ne
from typing import Any, TypeVar, cast, dataclass_transform, final

from piezo_sym.expressions.functions import FUNCTIONS

Kind = TypeVar("Kind")


class _Tree:
    """Base of all nodes; it caches the hash, since deep trees are keys of many dictionaries."""

    __slots__ = ("_hash",)


@dataclass_transform(frozen_default=True)
def _node(kind: type[Kind]) -> type[Kind]:
    """Return a frozen dataclass whose hash is computed once."""
    node: Any = dataclass(frozen=True, slots=True)(kind)
    computed = node.__hash__

    def cached(self: _Tree) -> int:
        if not hasattr(self, "_hash"):
            object.__setattr__(self, "_hash", computed(self))
        return self._hash  # type: ignore[attr-defined, no-any-return]

    parts = tuple(node.__dataclass_fields__)
    node.__hash__ = cached
    node.__reduce__ = lambda self: (node, tuple(getattr(self, part) for part in parts))
    return cast(type[Kind], node)


@final
@_node
class Num(_Tree):
    """An exact rational number."""

    value: Fraction


@final
@_node
class Sym(_Tree):
    """A name: a parameter, an input, a state, a law's letter, or a quantity of a program."""

    name: str


@final
@_node
class Neg(_Tree):
    """Minus its argument."""

    arg: Expr


@final
@_node
class Add(_Tree):
    """A sum, its terms in the order in which they were written; a difference is a `Neg` term."""

    terms: tuple[Expr, ...]


@final
@_node
class Mul(_Tree):
    """A product of two factors."""

    left: Expr
    right: Expr


@final
@_node
class Div(_Tree):
    """A quotient."""

    left: Expr
    right: Expr


@final
@_node
class Pow(_Tree):
    """A power with a small rational exponent."""

    base: Expr
    exponent: Fraction


@final
@_node
class Call(_Tree):
    """One of `functions` applied to its arguments."""

    function: str
    args: tuple[Expr, ...]


@final
@_node
class Cmp(_Tree):
    """One comparison: ``left op right`` with op one of < <= > >=."""

    op: str
    left: Expr
    right: Expr


@final
@_node
class If(_Tree):
    """``then if condition else other``."""

    then: Expr
    condition: Cmp
    other: Expr


@final
@_node
class LaneSum(_Tree):
    """The sum of `arg` over the lanes j = 1..r of `bank`."""

    arg: Expr
    bank: str


Expr = Num | Sym | Neg | Add | Mul | Div | Pow | Call | If | LaneSum
Node = Expr | Cmp

#: Whether a comparison holds between two numbers, of any type; proofs also use = and !=.
COMPARED: Mapping[str, Callable[..., Any]] = {
    "<": lt,
    "<=": le,
    ">": gt,
    ">=": ge,
    "=": eq,
    "!=": ne,
}

ZERO, ONE = Num(Fraction(0)), Num(Fraction(1))


def knots(node: Node) -> tuple[tuple[Expr, Expr], ...]:
    """Return the knots (x_k, y_k) of a table; an empty tuple for any other node."""
    if isinstance(node, Call) and node.function in FUNCTIONS and FUNCTIONS[node.function].knots:
        return tuple(zip(node.args[1::2], node.args[2::2], strict=True))
    return ()


def children(node: Node) -> tuple[Node, ...]:
    """Return the direct parts of `node`, from left to right."""
    parts: list[Node] = []
    for field in node.__slots__:
        part = getattr(node, field)
        if isinstance(part, _Tree):
            parts.append(cast(Node, part))
        elif isinstance(part, tuple):
            parts += part
    return tuple(parts)


def walk(node: Node) -> Iterator[Node]:
    """Yield `node` and all its parts, outermost first, from left to right."""
    stack: list[Node] = [node]
    while stack:
        top = stack.pop()
        yield top
        stack.extend(reversed(children(top)))


@lru_cache(1 << 14)
def names(node: Node) -> tuple[str, ...]:
    """Return the names that occur in `node`, each once, in order of first appearance."""
    return tuple(dict.fromkeys(n.name for n in walk(node) if isinstance(n, Sym)))


def rebuild(node: Expr, change: Callable[[Expr], Expr]) -> Expr:
    """Return `node` with `change` applied to each of its direct parts."""

    def changed(part: Any) -> Any:
        if isinstance(part, Cmp):
            return Cmp(part.op, change(part.left), change(part.right))
        if isinstance(part, _Tree):
            return change(cast(Expr, part))
        return tuple(map(change, part)) if isinstance(part, tuple) else part

    if isinstance(node, Num | Sym):
        return node
    return type(node)(*(changed(getattr(node, field)) for field in node.__slots__))


def first_choice(node: Node) -> Cmp | None:
    """Return the comparison that has to be decided first when a tree is evaluated, if any.

    The condition of a branch is decided before those inside the branch.
    """
    if isinstance(node, If):
        return first_choice(node.condition) or node.condition
    return next(filter(None, map(first_choice, children(node))), None)


def decided(node: Expr, known: Mapping[Cmp, bool]) -> Expr:
    """Return a tree with the choices taken whose comparisons are `known`."""
    if isinstance(node, If) and node.condition in known:
        return decided(node.then if known[node.condition] else node.other, known)
    return rebuild(node, lambda part: decided(part, known))


def replace(node: Expr, mapping: Mapping[str, Expr]) -> Expr:
    """Return `node` with each name in `mapping` replaced by its tree, all at once."""
    return replaced(node, {Sym(name): tree for name, tree in mapping.items()})


def replaced(node: Expr, known: Mapping[Any, Expr]) -> Expr:
    """Return `node` with each part that is `known` replaced by another tree, outermost first."""
    return known.get(node) or rebuild(node, lambda part: replaced(part, known))


def rename(node: Expr, mapping: Mapping[str, str]) -> Expr:
    """Return `node` with names replaced by other names, all at once."""
    return replace(node, {old: Sym(new) for old, new in mapping.items()})
