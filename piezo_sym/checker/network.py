"""Kirchhoff's and Newton's laws of a spec as one tableau, solved in any field.

Input: a `Spec`, the size of each bank, and an `Algebra`: numbers, or rational functions.  Output:
`Flows`: letters, outputs, rates.  Every branch's through variable and every node's potential is an
unknown; a law that is linear in its letter is an equation, in either causality.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple, Protocol

from .kinds import REFERENCES
from .laws import Node, symbols
from .spec import Element, Spec

Form = dict[Any, Any]
Slot = tuple[str, int]


class Algebra(Protocol):
    """What the laws are written in."""

    one: Any

    def law(self, element: Element, field: str, lane: int, letter: Any = None) -> Any:
        """Return a law of an element ("law" its dissipative one) in a lane."""

    def given(self, role: str, owner: str, lane: int) -> Any:
        """Return an input "u", a co-state "E" or a temperature "T"."""


class Part(NamedTuple):
    """A branch: its element and lane, what stands in it, its nodes, what it imposes."""

    element: str
    lane: int
    role: str
    nodes: tuple[Any, Any]
    across: bool


class SingularError(Exception):
    """The laws have no single solution."""


class Flows(NamedTuple):
    """A network solved, by (element, lane); `forms` says what each letter is a combination of."""

    letters: dict[Slot, Any]
    outputs: dict[Slot, Any]
    rates: dict[Slot, Any]
    conjugates: dict[str, Any]
    forms: dict[Slot, Form]
    pivots: list[Any]


def lanes(element: Element, counts: Mapping[str, int]) -> range:
    """Return the lanes of an element, 0 alone if it is no bank."""
    return range(1, counts[element.name] + 1) if element.count is not None else range(1)


def parts(spec: Spec, counts: Mapping[str, int]) -> list[Part]:
    """Return every branch, those of a bank once per lane."""
    found = []
    for e in spec.of("store", "law", "source", "coupling", "hysteron"):
        for lane in lanes(e, counts):
            if e.kind.form == "hysteron":
                (a, b), inner = e.pairs[0], (e.name, lane)
                found.append(Part(e.name, lane, "store", (a, inner), False))
                found.append(Part(e.name, lane, "law", (inner, b), True))
            elif e.kind.form == "coupling":
                found += [Part(e.name, lane, f"{n}", pair, False) for n, pair in enumerate(e.pairs)]
            else:
                found.append(Part(e.name, lane, e.kind.form, e.pairs[0], e.across))
    return found


def flows(spec: Spec, counts: Mapping[str, int], algebra: Algebra) -> Flows:
    """Return what flows in a network.

    Raises
    ------
    SingularError
        If its laws have no, or more than one, solution, or a loop of laws that are not linear.
    """
    found = parts(spec, counts)
    answers, pivots = _solved(spec, found, algebra)
    made = Flows({}, {}, {}, {}, {}, pivots)

    def total(form: Form) -> Any:
        terms = algebra.one - algebra.one
        for (role, name, lane), factor in form.items():
            W = made.outputs.get((name, lane)) if role == "W" else None
            if role == "W" and W is None:
                raise SingularError("laws that are not linear depend on each other")
            terms = terms + factor * (algebra.given(role, name, lane) if role != "W" else W)
        return terms

    laws = [part for part in found if part.role == "law"]
    for part in sorted(laws, key=lambda p: _is_equation(spec, p)):
        slot = part.element, part.lane
        made.forms[slot] = answers[part]
        made.letters[slot] = z = total(answers[part])
        made.outputs[slot] = algebra.law(spec.elements[part.element], "law", part.lane, z)
    for part in found:
        if part.role == "store":
            made.rates[part.element, part.lane] = total(answers[part])
        elif part.role == "source":
            y = total(answers[part])
            made.conjugates[part.element] = -y if part.across else y
    _heat(spec, algebra, made)
    return made


def _heat(spec: Spec, algebra: Algebra, made: Flows) -> None:
    """Add the rates of entropies: what processes produce, and what is exchanged."""
    heat = {body.name: algebra.given("T", body.name, 0) for body in spec.of("body")}
    rates = {(body, 0): algebra.one - algebra.one for body in heat}
    for (name, lane), W in made.outputs.items():
        body = spec.elements[name].bodies[0]
        rates[body, 0] = rates[body, 0] + W * made.letters[name, lane] / heat[body]
    for e in spec.of("conduction", "ambient"):
        lam, first = algebra.law(e, "conductance", 0), e.bodies[0]
        if e.kind.form == "ambient":
            rates[first, 0] = rates[first, 0] + exchange(e, algebra)
            made.conjugates[e.name] = heat[first]
            continue
        power = lam * (heat[first] - heat[e.bodies[1]])
        for body, share in zip(e.bodies, (-power, power), strict=True):
            rates[body, 0] = rates[body, 0] + share / heat[body]
    made.rates.update(rates)


def exchange(element: Element, algebra: Algebra) -> Any:
    """Return the entropy that an environment brings, lam*(T_e/T - 1)."""
    hot, T = algebra.given("u", element.name, 0), algebra.given("T", element.bodies[0], 0)
    return algebra.law(element, "conductance", 0) * (hot / T - algebra.one)


def _is_equation(spec: Spec, part: Part) -> bool:
    law = spec.elements[part.element].law
    return law is not None and degree(law, ("z", part.element)) == 1


def _solved(spec: Spec, found: list[Part], algebra: Algebra) -> tuple[dict[Any, Form], list[Any]]:
    """Return for each branch the variable that it does not impose, and the pivots."""
    rows, one = list[Form](), algebra.one
    balances: dict[Any, Form] = {}
    for part in found:
        for node, sign in zip(part.nodes, (one, -one), strict=True):
            if node not in REFERENCES:
                balances.setdefault(node, {})[part] = sign
    for n, part in enumerate(found):
        rows.append(_law(spec, part, found[n - 1], found[(n + 1) % len(found)], algebra))
    unknowns, pivots = _eliminated([*balances.values(), *rows], len(balances) + len(found))
    answers: dict[Any, Form] = {}
    for part in found:
        asked = {part: one} if part.across else _potential(part.nodes, one)
        for label, factor in asked.items():
            answers[part] = _added(answers.get(part, {}), unknowns[label], factor)
    return answers, pivots


def _law(spec: Spec, part: Part, before: Part, after: Part, algebra: Algebra) -> Form:
    """Return the equation of one branch; a given label stands with what is added to it."""
    element, one, own = spec.elements[part.element], algebra.one, {part: algebra.one}
    across = _potential(part.nodes, one)
    if part.role in "01":
        n = algebra.law(element, "ratio", 0)
        if part.role == "1":  # through_2 = -ratio * (through_1 or across_1)
            return own | ({before: n} if element.across else _potential(before.nodes, n))
        # across_1 = ratio * across_2, or through_1 = ratio * across_2
        return _added(across if element.across else own, _potential(after.nodes, -n), one)
    if part.role == "law" and _is_equation(spec, part):
        slope = algebra.law(element, "law", part.lane, one)
        if part.across:
            return across | {part: -slope}
        return own | _potential(part.nodes, -slope)
    given = {"store": "E", "law": "W", "source": "u"}[part.role], part.element, part.lane
    sign = one if part.role == "source" and not part.across else -one
    return (across if part.across else own) | {given: sign}


def _potential(nodes: tuple[Any, Any], factor: Any) -> Form:
    pairs = zip(nodes, (factor, -factor), strict=True)
    return {("e", node): sign for node, sign in pairs if node not in REFERENCES}


def _added(left: Form, right: Form, factor: Any) -> Form:
    total = dict(left)
    for label, value in right.items():
        total[label] = factor * value + total[label] if label in total else factor * value
    return {label: value for label, value in total.items() if not value == 0}


def _is_given(label: Any) -> bool:
    return not isinstance(label, Part) and label[0] != "e"


def _eliminated(left: list[Form], size: int) -> tuple[dict[Any, Form], list[Any]]:
    """Return each unknown as a form of the givens, by Gauss and Jordan; plain pivots first."""
    solved, pivots = dict[Any, Form](), list[Any]()
    while left:
        choices = [
            ((value not in (1, -1), len(row), n), label)
            for n, row in enumerate(left)
            for label, value in row.items()
            if not _is_given(label) and value != 0
        ]
        if not choices:
            raise SingularError("the laws of the network have no single solution")
        (_, _, n), label = min(choices, key=lambda choice: choice[0])
        row = left.pop(n)
        pivot = row.pop(label)
        pivots.append(pivot)
        row = {key: -value / pivot for key, value in row.items()}
        left = [_without(other, label, row) for other in left]
        solved = {key: _without(other, label, row) for key, other in solved.items()}
        solved[label] = row
    if len(solved) != size or any(not _is_given(key) for row in solved.values() for key in row):
        raise SingularError("the laws of the network have no single solution")
    return solved, pivots


def _without(form: Form, label: Any, row: Form) -> Form:
    """Return a form with an unknown replaced by what it is."""
    if label not in form:
        return form
    return _added({k: v for k, v in form.items() if k != label}, row, form[label])


def degree(node: Node, letter: Any) -> int | None:
    """Return 0 for a law free of its letter, 1 for one proportional to it by its form, else None."""
    if node.op == "sym" or letter not in symbols(node):
        return int(node.op == "sym" and node.value == letter)
    degrees = [degree(arg, letter) for arg in node.args]
    if node.op == "if":
        degrees = degrees[1:] if letter not in symbols(node.args[0]) else [None]
    if node.op in ("neg", "+", "if"):
        return 1 if all(found == 1 for found in degrees) else None
    good = (node.op == "*" and None not in degrees) or (node.op == "/" and degrees[1] == 0)
    return 1 if good and sum(found or 0 for found in degrees) == 1 and degrees[0] is not None else None
