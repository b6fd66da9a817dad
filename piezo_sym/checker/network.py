"""Kirchhoff's and Newton's laws of a spec as one tableau, solved in any field.

Input: a `Spec`, the size of each bank, the value of each ratio and of each linear law's slope.
Output: across and through variable of every branch as combinations of co-states ("E", element,
lane), outputs of nonlinear laws ("W", element, lane) and inputs ("u", element); and the pivots,
whose product is the determinant.  A linear law is an equation, in either causality.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from .kinds import REFERENCES
from .laws import Node, symbols
from .spec import Element, Spec

Form = dict[Any, Any]
Slot = tuple[str, int]


class Part(NamedTuple):
    """A branch: its element and lane, what stands in it, its nodes, what it imposes."""

    element: str
    lane: int
    role: str
    nodes: tuple[Any, Any]
    across: bool


class SingularError(Exception):
    """The laws have no single solution."""


class Solution(NamedTuple):
    """The tableau solved; `across` and `through` by branch."""

    across: Mapping[Part, Form]
    through: Mapping[Part, Form]
    pivots: tuple[Any, ...]


def lanes(element: Element, counts: Mapping[str, int]) -> range:
    """Return the lanes of an element, 0 alone if it is no bank."""
    return range(1, counts[element.name] + 1) if element.count is not None else range(1)


def parts(spec: Spec, counts: Mapping[str, int]) -> list[Part]:
    """Return every branch, those of a bank once per lane."""
    found = []
    for e in spec.of("store", "resistor", "source", "coupling", "hysteron"):
        for lane in lanes(e, counts):
            if e.kind.form == "hysteron":
                (a, b), inner = e.pairs[0], (e.name, lane)
                found.append(Part(e.name, lane, "store", (a, inner), False))
                found.append(Part(e.name, lane, "law", (inner, b), True))
            elif e.kind.form == "coupling":
                found += [Part(e.name, lane, f"{n}", pair, False) for n, pair in enumerate(e.pairs)]
            else:
                role = {"resistor": "law"}.get(e.kind.form, e.kind.form)
                found.append(Part(e.name, lane, role, e.pairs[0], e.across))
    return found


def solve(
    spec: Spec,
    counts: Mapping[str, int],
    ratio: Mapping[str, Any],
    slope: Mapping[Slot, Any],
    one: Any,
) -> Solution:
    """Return the solved tableau.

    Raises
    ------
    SingularError
        If it has no, or more than one, solution.
    """
    found = parts(spec, counts)
    rows: list[tuple[Form, Form]] = []
    balances: dict[Any, Form] = {}
    for part in found:
        for node, sign in zip(part.nodes, (one, -one), strict=True):
            if node not in REFERENCES:
                balances.setdefault(node, {})[part] = sign
    rows += [(row, {}) for row in balances.values()]
    for n, part in enumerate(found):
        rows.append(_law(spec, part, found[n - 1], found[(n + 1) % len(found)], ratio, slope, one))
    solved, pivots = _eliminated(rows, len(balances) + len(found))
    across = {}
    for part in found:
        across[part] = _combined(_potential(part.nodes, one), solved)
    return Solution(across, {part: solved[part] for part in found}, tuple(pivots))


def _law(
    spec: Spec, part: Part, before: Part, after: Part, ratio: Any, slope: Any, one: Any
) -> tuple[Form, Form]:
    """Return the equation of one branch: (unknowns, givens)."""
    element, slot = spec.elements[part.element], (part.element, part.lane)
    if part.role in "01":
        n = ratio[part.element]
        if part.role == "1":  # through_2 = -ratio * (across_1 or through_1)
            other = _potential(before.nodes, n) if not element.across else {before: n}
            return {part: one, **other}, {}
        if element.across:  # across_1 = ratio * across_2
            return _added(_potential(part.nodes, one), _potential(after.nodes, -n)), {}
        return {part: one, **_potential(after.nodes, -n)}, {}
    if part.role == "law" and slot in slope:
        given, taken = ({part: -slope[slot]}, _potential(part.nodes, one))
        if not part.across:
            given, taken = {part: one}, _potential(part.nodes, -slope[slot])
        return given | taken, {}
    kind = {"store": "E", "law": "W", "source": "u"}[part.role]
    label = (kind, part.element) if kind == "u" else (kind, *slot)
    sign = -one if kind == "u" and not part.across else one
    return _potential(part.nodes, one) if part.across else {part: one}, {label: sign}


def _potential(nodes: tuple[Any, Any], factor: Any) -> Form:
    pairs = zip(nodes, (factor, -factor), strict=True)
    return {("e", node): sign for node, sign in pairs if node not in REFERENCES}


def _added(left: Form, right: Form, factor: Any = 1) -> Form:
    total = dict(left)
    for label, value in right.items():
        new = factor * value + total[label] if label in total else factor * value
        total[label] = new
        if new == 0:
            del total[label]
    return total


def _combined(form: Form, solved: Mapping[Any, Form]) -> Form:
    total: Form = {}
    for label, factor in form.items():
        total = _added(total, solved[label], factor)
    return total


def _eliminated(rows: list[tuple[Form, Form]], size: int) -> tuple[dict[Any, Form], list[Any]]:
    """Return each unknown as a form of the givens, by Gauss and Jordan; plain pivots first."""
    left, solved, pivots = rows, dict[Any, tuple[Form, Form]](), list[Any]()
    while left:
        choices = [
            (value not in (1, -1), len(row), n, label)
            for n, (row, _) in enumerate(left)
            for label, value in row.items()
            if _regular(value)
        ]
        if not choices:
            raise SingularError("the laws of the network have no single solution")
        _, _, n, label = min(choices, key=lambda choice: choice[:3])
        row, given = left.pop(n)
        pivot = row[label]
        pivots.append(pivot)
        row = {key: value / pivot for key, value in row.items() if key != label}
        given = {key: value / pivot for key, value in given.items()}
        left = [_without(other, label, row, given) for other in left]
        solved = {key: _without(other, label, row, given) for key, other in solved.items()}
        solved[label] = (row, given)
    if len(solved) != size or any(row for row, _ in solved.values()):
        raise SingularError("the laws of the network have no single solution")
    return {label: given for label, (_, given) in solved.items()}, pivots


def _regular(value: Any) -> bool:
    """Return whether a coefficient is surely not zero (an enclosure may not tell)."""
    return bool(value != 0)


def _without(equation: tuple[Form, Form], label: Any, row: Form, given: Form) -> tuple[Form, Form]:
    """Return an equation, or the unknown it is solved for, with `label` eliminated.

    Both are kept as sum(unknowns) = givens.
    """
    unknowns, givens = equation
    if label not in unknowns:
        return equation
    factor = -unknowns[label]
    rest = {key: value for key, value in unknowns.items() if key != label}
    return _added(rest, row, factor), _added(givens, given, factor)


def is_linear(law: Node, letter: Any) -> bool:
    """Return whether a law is its letter times what is free of it, seen from its form."""
    return _degree(law, letter) == 1


def _degree(node: Node, letter: Any) -> int | None:
    """Return 0 for a law free of the letter, 1 for one proportional to it, else None."""
    if letter not in symbols(node):
        return 0
    if node.op == "sym":
        return 1
    degrees = [_degree(arg, letter) for arg in node.args]
    if node.op == "neg":
        return degrees[0]
    if node.op == "+" or (node.op == "if" and letter not in symbols(node.args[0])):
        own = degrees if node.op == "+" else degrees[1:]
        return 1 if all(degree == 1 for degree in own) else None
    if node.op == "*" and sorted(str(d) for d in degrees) == ["0", "1"]:
        return 1
    if node.op == "/" and degrees == [1, 0]:
        return 1
    return None
