"""Differences that vanish, one branch at a time: slopes of energies minus laws, jumps of laws.

Input: a difference, and a `Prover`; for a slope, also the states.  Output: whether it is zero on
every branch; for a slope, branches at a single value of the state (edges) are left out.  There a
continuous energy has the slope of a continuous law if it has it on both sides; other claims show
that neither jumps.  A domain that fixes a state has no sides, so its conditions on the state are
not used to find edges.
"""

from collections.abc import Callable, Iterable, Iterator
from itertools import product
from typing import Any, TypeAlias

from . import laws
from .field import Field
from .functions import KINKS
from .laws import InputError, Node, build, compare, negated, num, subs, sym, symbols
from .prover import Prover

MOST, NEVER = 200, compare(num(1), "<")
Path = tuple[Node, ...]
Test: TypeAlias = Callable[[Node, Path], bool]


def vanishes(difference: Node, states: Iterable[Any], prover: Prover) -> bool:
    """Return whether a difference is zero on every branch that does not fix one of the states."""
    aside = Prover([c for c in prover.domain if set(states).isdisjoint(symbols(c))])
    return _on_branches(difference, (), prover, lambda _, path: any(_edges(path, states, aside)))


def equal(claim: Node, path: Path, prover: Prover) -> bool:
    """Return whether two laws are equal on each branch; a branch may fix the value of a state."""
    difference = build("x - z", x=claim.args[0], z=claim.args[1])

    def on_edge(tree: Node, here: Path) -> bool:
        names = [name for name in symbols(tree) if name[0] == "x"]
        edges = _edges(here, names, prover)
        return any(_is_zero(subs(tree, edge), here, prover) for edge in edges)

    return _on_branches(difference, path, prover, on_edge)


def _on_branches(law: Node, path: Path, prover: Prover, or_else: Test) -> bool:
    """Return whether each branch is zero, passes the test `or_else`, or is empty."""
    try:
        return all(
            count < MOST
            and (_is_zero(tree, here, prover) or or_else(tree, here) or prover.proves(NEVER, here))
            for count, (tree, here) in enumerate(_branches(_chosen(law), path))
        )
    except InputError:
        return False


def _chosen(node: Node) -> Node:
    """Return a tree with its kinks as choices."""
    tree = Node(node.op, tuple(map(_chosen, node.args)), node.value)
    return _chosen(laws.unkinked(tree)) if tree.op in KINKS else tree


def _branches(node: Node, path: Path) -> Iterator[tuple[Node, Path]]:
    """Yield the branches of a tree with their paths; inner conditions are decided first."""
    condition = _first(node)
    if condition is None:
        yield node, path
        return
    for side, place in ((condition, 1), (negated(condition), 2)):
        if negated(side) not in path:
            yield from _branches(_taken(node, condition, place), (*path, side))


def _first(node: Node) -> Node | None:
    """Return the comparison that is evaluated first."""
    own = node.args[:1] if node.op == "if" else node.args
    found = next(filter(None, map(_first, own)), None)
    return found or (node.args[0] if node.op == "if" else None)


def _taken(node: Node, condition: Node, place: int) -> Node:
    if node.op == "if" and node.args[0] == condition:
        return _taken(node.args[place], condition, place)
    return Node(node.op, tuple(_taken(arg, condition, place) for arg in node.args), node.value)


def _is_zero(tree: Node, path: Path, prover: Prover) -> bool:
    return Field(lambda claim: prover.proves(claim, path)).same(tree, num(0))


def _edges(path: Path, states: Iterable[Any], prover: Prover) -> Iterator[dict[Any, Node]]:
    """Yield each state that a path's conditions fix for given parameters, with its value."""
    for state, (left, right) in product(states, (c.args for c in path if c.value in ("<=", ">="))):
        difference = build("x - z", x=left, z=right)
        field = Field()
        slope = field.tree(field.of(laws.derivative(difference, state)))
        fixed = all(role == "p" for role, *_ in symbols(slope))
        edge = fixed and prover.proves(compare(slope, "!="))
        if edge and prover.proves(compare(left, "=", right), path):
            yield {state: build("x - y/m", x=sym(state), y=difference, m=slope)}
