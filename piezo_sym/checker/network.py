"""Kirchhoff's and Newton's laws of a spec as one tableau, solved in any field.

Input: a `Spec`, the size of each bank, and the algebra in which the laws are written, numbers or
rational functions: its `one`, `law(element, field, lane, letter)` ("law" the dissipative one) and
`given(role, owner, lane)` of an input "u", a co-state "E" or a temperature "T".  Output: `Flows`.
Every branch's through variable and every node's potential is an unknown; a law that is linear in
its letter is an equation, in either causality.
"""

from collections.abc import Iterator, Mapping
from functools import cache
from typing import Any, NamedTuple

from .field import Field
from .kinds import REFERENCES
from .laws import Node, made, num, put, sym
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


class Flows(NamedTuple):
    """A network solved, by (element, lane)."""

    letters: dict[Slot, Any]
    outputs: dict[Slot, Any]
    rates: dict[Slot, Any]
    conjugates: dict[str, Any]
    pivots: list[Any]


def _parts(spec: Spec, counts: Mapping[str, int]) -> Iterator[Part]:
    for e in spec.of("store", "law", "source", "coupling", "hysteron"):
        for lane in range(1, counts[e.name] + 1) if e.lanes is not None else (0,):
            if e.kind.form == "hysteron":
                (a, b), inner = e.pairs[0], (e.name, lane)
                yield Part(e.name, lane, "store", (a, inner), False)
                yield Part(e.name, lane, "law", (inner, b), True)
                continue
            roles = "01" if e.kind.form == "coupling" else [e.kind.form]
            for role, pair in zip(roles, e.pairs, strict=True):
                yield Part(e.name, lane, role, pair, e.across)


def flows(spec: Spec, counts: Mapping[str, int], algebra: Any) -> Flows:
    """Return what flows in a network.

    Raises
    ------
    SingularError
        If its laws have no, or more than one, solution, or a loop of laws that are not linear.
    """
    found = list(_parts(spec, counts))
    answers, pivots = _solved(spec, found, algebra)
    made = Flows({}, {}, {}, {}, pivots)

    def total(form: Form) -> Any:
        terms = algebra.one - algebra.one
        for (role, *slot), factor in form.items():
            if role == "W" and (*slot,) not in made.outputs:
                raise SingularError("laws that are not linear depend on each other")
            terms += factor * (
                made.outputs[(*slot,)] if role == "W" else algebra.given(role, *slot)
            )
        return terms

    for part in sorted((p for p in found if p.role == "law"), key=lambda p: _is_equation(spec, p)):
        slot, element = (part.element, part.lane), spec.elements[part.element]
        made.letters[slot] = total(answers[part])
        made.outputs[slot] = algebra.law(element, "law", part.lane, made.letters[slot])
    for part in found:
        if part.role == "store":
            made.rates[part.element, part.lane] = total(answers[part])
        elif part.role == "source":
            y = total(answers[part])
            made.conjugates[part.element] = -y if part.across else y
    _heat(spec, algebra, made)
    return made


def _heat(spec: Spec, algebra: Any, made: Flows) -> None:
    heat = {body.name: algebra.given("T", body.name, 0) for body in spec.of("body")}
    rates = dict.fromkeys(heat, algebra.one - algebra.one)
    for slot, W in made.outputs.items():
        body = spec.elements[slot[0]].bodies[0]
        rates[body] += W * made.letters[slot] / heat[body]
    for e in spec.of("ambient"):
        rates[e.bodies[0]] += exchange(e, algebra)
        made.conjugates[e.name] = heat[e.bodies[0]]
    for e in spec.of("conduction"):
        first, second = e.bodies
        power = algebra.law(e, "conductance", 0) * (heat[first] - heat[second])
        rates[first] -= power / heat[first]
        rates[second] += power / heat[second]
    made.rates.update({(body, 0): rate for body, rate in rates.items()})


def exchange(element: Element, algebra: Any) -> Any:
    """Return the entropy that an environment brings, lam*(T_e/T - 1)."""
    hot, T = algebra.given("u", element.name, 0), algebra.given("T", element.bodies[0], 0)
    return algebra.law(element, "conductance", 0) * (hot / T - algebra.one)


def _is_equation(spec: Spec, part: Part) -> bool:
    law = spec.elements[part.element].law
    return law is not None and is_linear(law, ("z", part.element))


def _solved(spec: Spec, found: list[Part], algebra: Any) -> tuple[dict[Any, Form], list[Any]]:
    rows, one, balances = list[Form](), algebra.one, dict[Any, Form]()
    for n, part in enumerate(found):
        for node, sign in zip(part.nodes, (one, -one), strict=True):
            if node not in REFERENCES:
                balances.setdefault(node, {})[part] = sign
        rows.append(_law(spec, part, found[n - 1], found[(n + 1) % len(found)], algebra))
    unknowns, pivots = _eliminated([*balances.values(), *rows], len(balances) + len(found))
    answers: dict[Any, Form] = {part: {} for part in found}
    for part in found:
        for label, factor in ({part: one} if part.across else _potential(part.nodes, one)).items():
            answers[part] = _added(answers[part], unknowns[label], factor)
    return answers, pivots


def _law(spec: Spec, part: Part, before: Part, after: Part, algebra: Any) -> Form:
    element, one, own = spec.elements[part.element], algebra.one, {part: algebra.one}
    across = _potential(part.nodes, one)
    if part.role == "1":  # through_2 = -ratio * (through_1 or across_1)
        n = algebra.law(element, "ratio", 0)
        return own | ({before: n} if element.across else _potential(before.nodes, n))
    if part.role == "0":  # across_1 = ratio * across_2, or through_1 = ratio * across_2
        other = _potential(after.nodes, -algebra.law(element, "ratio", 0))
        return _added(across if element.across else own, other, one)
    if part.role == "law" and _is_equation(spec, part):
        slope = algebra.law(element, "law", part.lane, one)
        return across | {part: -slope} if part.across else own | _potential(part.nodes, -slope)
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
    return {label: value for label, value in total.items() if (value == 0) is not True}


def _eliminated(left: list[Form], size: int) -> tuple[dict[Any, Form], list[Any]]:
    rows, solved, pivots = dict(enumerate(left)), dict[Any, Form](), list[Any]()
    choices = {n: found for n, row in rows.items() if (found := _choice(n, row))}
    while choices:
        (_, _, n), label = min(choices.values(), key=lambda choice: choice[0])
        row = rows.pop(n)
        del choices[n]
        pivots.append(pivot := row.pop(label))
        row = {key: -value / pivot for key, value in row.items()}
        for table in (rows, solved):
            for key in [key for key, other in table.items() if label in other]:
                factor = table[key].pop(label)
                table[key] = _added(table[key], row, factor)
                if table is rows and not (found := _choice(key, table[key])):
                    choices.pop(key, None)
                elif table is rows:
                    choices[key] = found
        solved[label] = row
    if rows or len(solved) != size or any(map(_unknown, solved.values())):
        raise SingularError("the laws of the network have no single solution")
    return solved, pivots


def _choice(n: int, row: Form) -> Any:
    """Return the best unknown to solve a row for: short rows first, and factors 1 and -1."""
    found = [label for label in _unknown(row) if row[label] != 0]
    ranks = [((row[label] not in (1, -1), len(row), n), label) for label in found]
    return min(ranks, key=lambda choice: choice[0], default=None)


def _unknown(row: Form) -> list[Any]:
    return [key for key in row if isinstance(key, Part) or key[0] == "e"]


@cache
def is_linear(law: Node, letter: Any) -> bool:
    """Return whether a law is proportional to its letter: f(z) = z*f(1), by its form."""
    return Field().same(law, made("z*x", z=sym(letter), x=put(law, {letter: num(1)})))
