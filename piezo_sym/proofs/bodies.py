"""The obligations on temperatures: positive, rising with entropy, never below their floor.

Input: an `IPHS`.  Output: obligations.
"""

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from itertools import permutations

from piezo_sym.expressions.calculus import add, derivative, div, mul, neg
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import ONE, ZERO, Cmp, Expr, Sym, names
from piezo_sym.iphs import IPHS
from piezo_sym.proofs.assumptions import Assumptions, Law
from piezo_sym.proofs.balances import premises
from piezo_sym.proofs.continuity import jump_questions
from piezo_sym.proofs.laws import branch_questions, value_questions
from piezo_sym.proofs.obligations import Obligation, Question
from piezo_sym.spec.elements.ports import Body, Conductor, Exchange, HeatInput
from piezo_sym.spec.names import fresh
from piezo_sym.spec.tables import greater


def temperature(iphs: IPHS, assumptions: Assumptions) -> Iterator[Obligation]:
    """Yield for each body the obligation that T > 0 and dT/dS > 0."""
    domain = tuple(condition.tree for condition in iphs.circuit.conditions)
    used = {name for tree in domain for name in names(tree)}
    for placed, port in iphs.circuit.of(Body):
        tie = (Cmp("=", Sym(port.temperature), port.law),) if port.temperature in used else ()
        within = replace(assumptions, where=(*domain, *tie))
        statement, latex = "T > 0 and dT/dS > 0", r"T > 0,\quad \partial T/\partial S > 0"
        obligation = Obligation("temperature", placed.element, statement, latex, assumptions.texts)
        yield obligation.asking(
            partial(_temperature_questions, port.law, port.state, within), "the law"
        )


def _temperature_questions(law: Expr, state: str, assumptions: Assumptions) -> Iterator[Question]:
    """Yield the questions whether a temperature and its slope have values and are positive.

    Continuity is asked, too: a slope does not show a jump downward.
    """
    slope = derivative(law, state)
    warm = assumptions.question("T > 0", Cmp(">", law, ZERO))
    rising = assumptions.question("dT/dS > 0", Cmp(">", slope, ZERO))
    found = [
        *value_questions(law, assumptions),
        *value_questions(slope, assumptions),
        *branch_questions(law, replace(warm, rising="energy")),
        *branch_questions(slope, replace(rising, rising="temperature")),
    ]
    asked = {(question.where, question.claim): question for question in reversed(found)}
    yield from reversed(asked.values())
    others = {name for name in names(law) if name != state}
    yield from jump_questions(
        Law("", "T", law), replace(assumptions, fixed=assumptions.fixed | others)
    )


def invariant(iphs: IPHS, assumptions: Assumptions) -> Iterator[Obligation]:
    """Yield for each body with a floor and an environment that T stays above the floor.

    The coldest body only gains entropy from processes and conduction.  Where T <= m < T_e, heat
    exchange brings at least lam*(T_e/m - 1) >= 0, so T never falls below its start and m.
    """
    above = [greater(condition.tree) for condition in iphs.circuit.conditions]
    floors = {c.left.name: c.right for c in above if c.op == ">" and isinstance(c.left, Sym)}
    for placed, port in iphs.circuit.of(Body):
        exchanges = [p for _, p in iphs.circuit.of(Exchange) if p.body == placed.element]
        floor = floors.get(port.temperature)
        others = {slot.label for slot in iphs.system.states} - {port.state}
        worked = not others.isdisjoint(names(port.law))  # T depends on other states
        heated = any(p.body == placed.element for _, p in iphs.circuit.of(HeatInput))
        pumped = placed.element in iphs.circuit.pumped  # a current may take entropy from it
        if floor is None or not exchanges or worked or heated or pumped:
            continue
        contacts = tuple(
            (contact.conductance, Sym(iphs.circuit.bodies[other].temperature))
            for _, contact in iphs.circuit.of(Conductor)
            for one, other in permutations((contact.first, contact.second))
            if one == placed.element
        )
        neighbours = ", no neighbour colder" if contacts else ""
        yield Obligation(
            "invariant",
            placed.element,
            f"{spell(floor)} < T <= m < T_e{neighbours}: dS/dt >= lam*(T_e/m - 1) >= 0",
            r"T_0 < T \le m < T_e \Rightarrow \dot S \ge \lambda (T_e/m - 1) \ge 0",
            assumptions.texts,
            questions=tuple(_floor_questions(port, exchanges, contacts, assumptions)),
            rests_on=premises(iphs),
            required=False,
        )


def _floor_questions(
    port: Body,
    exchanges: list[Exchange],
    contacts: tuple[tuple[Expr, Sym], ...],
    assumptions: Assumptions,
) -> Iterator[Question]:
    """Yield the questions whether warmer neighbours, and heat exchange at T <= m, bring entropy."""
    T, m = Sym(port.temperature), Sym(fresh("m", assumptions.order))
    for conductance, other in contacts:
        claim = Cmp(">=", mul(conductance, add(div(other, T), neg(ONE))), ZERO)
        colder = Cmp("<=", T, other)
        label = f"conduction from {other.name} brings entropy"
        yield assumptions.given(colder).question(label, claim)
    for exchange in exchanges:
        hot, lam = Sym(exchange.input), exchange.conductance
        order = (*assumptions.order, m.name)
        between = replace(assumptions, order=order).given(Cmp("<=", T, m), Cmp("<", m, hot))
        brought = [mul(lam, add(div(hot, at), neg(ONE))) for at in (T, m)]
        yield between.question("at T at least as at m", Cmp(">=", brought[0], brought[1]))
        yield between.question("at m not negative", Cmp(">=", brought[1], ZERO))
