"""What has to be shown of a domain: its conditions have values, and a point is known to be in it.

Input: an `IPHS`.  Output: an obligation, and the reason why nothing can be said of an empty domain.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from fractions import Fraction

from piezo_sym.expressions.parse import parse_law
from piezo_sym.expressions.tree import ONE, ZERO, Cmp, names, rename
from piezo_sym.iphs import IPHS
from piezo_sym.proofs.assumptions import Assumptions
from piezo_sym.proofs.branches import TooManyBranchesError
from piezo_sym.proofs.exact_eval import Value, holds, value_of
from piezo_sym.proofs.laws import valued
from piezo_sym.proofs.obligations import Obligation, Question
from piezo_sym.proofs.solvers import Asks
from piezo_sym.spec.elements.ports import Body
from piezo_sym.spec.tables import conditions, states


def defined(iphs: IPHS, assumptions: Assumptions) -> Iterator[Obligation]:
    """Yield that each condition of the domain has a value where those before it hold.

    Conditions that always have a value come first: all of them have to hold, in whatever order.
    """
    trees = [condition.tree for condition in conditions(iphs.model)]
    ties = tuple(c for c in assumptions.where if c.op == "=")
    statement, latex = "the domain: each condition has a value", r"\mathcal{D}"
    made = Obligation("welldef", "", statement, latex, assumptions.texts)
    try:
        partial = [tree for tree in trees if valued(tree, replace(assumptions, where=ties))]
        known = [tree for tree in trees if tree not in partial]
        found: list[Question] = []
        for tree in partial:
            found += valued(tree, replace(assumptions, where=(*known, *ties)))
            known.append(tree)
    except TooManyBranchesError:
        yield replace(made, open_because="the domain has too many branches; use fewer kinks")
        return
    if found:
        yield replace(made, questions=tuple(dict.fromkeys(found)))


def not_shown(iphs: IPHS, assumptions: Assumptions, solver: Asks) -> str:
    """Return what to say of a domain that no point is known to be in; else nothing.

    The spec's own values are a point of it; where that is too close to tell, the solver looks for
    another.  Both are evaluated exactly.
    """
    if _inside(assumptions, _own_values(iphs)):
        return ""
    never = Cmp("<", ONE, ZERO)
    question = Question(
        "the domain is empty", assumptions.order, assumptions.where, never, never, whole=True
    )
    answer = solver.ask(question.query())
    if answer.result == "sat" and _inside(assumptions, (answer.model,)):
        return ""
    given = ", ".join(assumptions.texts)
    if answer.result == "unsat":
        return f"no point is in the domain, where all is true: {given}"
    return f"no point is known to be in the domain: {given}"


def _inside(assumptions: Assumptions, points: tuple[Mapping[str, Value], ...]) -> bool:
    """Return whether every point is certainly in the domain."""
    try:
        return bool(points) and all(
            holds(condition, point)
            for point in points
            for condition in assumptions.where
            if condition.op != "="  # what ties a temperature to its entropy holds by its value
        )
    except (ArithmeticError, ValueError, KeyError):
        return False


def _own_values(iphs: IPHS) -> tuple[dict[str, Value], ...]:
    """Return the values of a spec in each lane of its banks; none if one of them has no value."""
    model = iphs.model
    lists = {name: parameter.lanes for name, parameter in model.parameters.items()}
    starts = model.initial.values()
    sizes = [*map(len, lists.values()), *(len(s) for s in starts if isinstance(s, tuple))]
    points = []
    try:
        for lane in range(max(sizes, default=1)):
            values: dict[str, Value] = {
                name: Fraction(given[min(lane, len(given) - 1)]) for name, given in lists.items()
            }
            values |= {name: Fraction(entry.si) for name, entry in model.inputs.items()}
            values |= {name: _start(iphs, name, lane, values) for name in states(model)}
            points.append({**values, **dict(_temperatures(iphs, values))})
    except (ArithmeticError, ValueError):
        return ()
    return tuple(points)


def _start(iphs: IPHS, state: str, lane: int, values: Mapping[str, Value]) -> Value:
    start = iphs.model.initial.get(state, 0.0)
    given = start[min(lane, len(start) - 1)] if isinstance(start, tuple) else start
    if isinstance(given, str):
        return value_of(parse_law(given, f"initial.{state}"), values)
    return Fraction(given)


def _temperatures(iphs: IPHS, values: Mapping[str, Value]) -> Iterator[tuple[str, Value]]:
    for _, port in iphs.circuit.of(Body):
        law = rename(port.law, {port.letter: port.state})
        if {*names(law)} <= values.keys():
            yield port.temperature, value_of(law, values)
