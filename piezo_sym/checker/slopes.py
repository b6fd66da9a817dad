"""Slopes of energies against laws, one branch at a time.

Input: slope minus law, the state, and a `Prover`.  Output: whether it vanishes on every branch but
for single values of the state.  At such an edge a continuous energy has the slope of a continuous
law if it has it on both sides; other claims show that neither jumps.  A domain that keeps a state
at one value leaves no sides, so its conditions on the state are not used to find edges.
"""

from collections.abc import Iterator
from typing import Any

from .field import Field
from .functions import KINKS
from .laws import InputError, Node, build, compare, derivative, need, negated, num, symbols
from .laws import unkinked as by_choices
from .prover import Prover

MOST = 200
Path = tuple[Node, ...]


def vanishes(difference: Node, state: Any, prover: Prover) -> bool:
    """Return whether a slope minus a law is zero on every branch that is more than an edge."""
    aside = Prover([c for c in prover.domain if state not in symbols(c)])
    try:
        for count, (tree, path) in enumerate(_branches(_chosen(difference), ())):
            need(count < MOST, "too many branches")
            if not (
                _is_zero(tree, path, prover)
                or _is_edge(path, state, aside)
                or prover.proves(compare(num(1), "<"), path)
            ):
                return False
    except InputError:
        return False
    return True


def _chosen(node: Node) -> Node:
    """Return a tree with its kinks as choices."""
    tree = Node(node.op, tuple(map(_chosen, node.args)), node.value)
    return _chosen(by_choices(tree)) if tree.op in KINKS else tree


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
    try:
        field = Field(lambda claim: prover.proves(claim, path))
        return field.is_zero(field.of(tree))
    except InputError:
        return False


def _is_edge(path: Path, state: Any, prover: Prover) -> bool:
    """Return whether a path leaves at most one value of the state for given parameters."""
    for left, right in (c.args for c in path if c.value in ("<=", ">=")):
        slope = derivative(build("x - z", x=left, z=right), state)
        fixed = all(role == "p" for role, *_ in symbols(slope))
        edge = fixed and prover.proves(compare(slope, "!="))
        if edge and prover.proves(compare(left, "=", right), path):
            return True
    return False
