"""What has to be shown of temperatures: positive, rising with entropy, never below their floor.

Input: an `IPHS`.  Output: obligations.
"""

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

from piezo_sym.expressions.calculus import add, derivative, div, mul, neg
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import ONE, ZERO, Cmp, Expr, Sym, names
from piezo_sym.iphs import IPHS
from piezo_sym.proofs.assumptions import Assumptions, Law
from piezo_sym.proofs.continuity import unbroken
from piezo_sym.proofs.laws import on_branches, valued
from piezo_sym.proofs.obligations import Obligation, Question
from piezo_sym.spec.elements.ports import Body, Conductor, DissipativePort, Exchange, HeatInput
from piezo_sym.spec.names import fresh
from piezo_sym.spec.tables import conditions, greater


def temperature(iphs: IPHS, assumptions: Assumptions) -> Iterator[Obligation]:
    """Yield for each body that its temperature is positive and rises with its entropy."""
    domain = tuple(condition.tree for condition in conditions(iphs.model))
    spoken_of = {name for tree in domain for name in names(tree)}
    for placed, port in iphs.circuit.of(Body):
        here = (Cmp("=", Sym(port.temperature), port.law),) if port.temperature in spoken_of else ()
        within = replace(assumptions, where=(*domain, *here))
        statement, latex = "T > 0 and dT/dS > 0", r"T > 0,\quad \partial T/\partial S > 0"
        made = Obligation("temperature", placed.element, statement, latex, assumptions.texts)
        yield made.asking(partial(_warm, port.law, port.state, within), "the law")


def _warm(law: Expr, state: str, assumptions: Assumptions) -> Iterator[Question]:
    """Yield the questions whether a temperature and its slope have values, and are positive.

    Where it jumped down as its entropy rises, it would have no slope.
    """
    slope = derivative(law, state)
    found = [
        *valued(law, assumptions),
        *valued(slope, assumptions),
        *on_branches(law, assumptions.question("T > 0", Cmp(">", law, ZERO))),
        *on_branches(slope, assumptions.question("dT/dS > 0", Cmp(">", slope, ZERO))),
    ]
    asked = {(question.where, question.claim): question for question in reversed(found)}
    yield from reversed(asked.values())
    others = {name for name in names(law) if name != state}
    yield from unbroken(Law("", "T", law), replace(assumptions, fixed=assumptions.fixed | others))


def invariant(iphs: IPHS, assumptions: Assumptions) -> Iterator[Obligation]:
    """Yield that a body's temperature stays above its floor, if it has one and an environment.

    The coldest body only gains from processes and conduction; where T <= m < T_e, heat exchange
    brings it at least lam*(T_e/m - 1) >= 0.  So T never falls below the least of its start and m.
    """
    above = [greater(condition.tree) for condition in conditions(iphs.model)]
    floors = {c.left.name: c.right for c in above if c.op == ">" and isinstance(c.left, Sym)}
    laws = [
        ("passive", placed.element) for placed, _ in iphs.circuit.of(DissipativePort, Conductor)
    ]
    warm = [("temperature", placed.element) for placed, _ in iphs.circuit.of(Body)]
    for placed, port in iphs.circuit.of(Body):
        exchanges = [p for _, p in iphs.circuit.of(Exchange) if p.body == placed.element]
        floor = floors.get(port.temperature)
        others = {slot.label for slot in iphs.system.states} - {port.state}
        worked = not others.isdisjoint(names(port.law))  # work changes its temperature, too
        heated = any(p.body == placed.element for _, p in iphs.circuit.of(HeatInput))
        pumped = placed.element in iphs.circuit.pumped  # a current takes entropy out of it
        if floor is None or not exchanges or worked or heated or pumped:
            continue
        contacts = tuple(_contacts(iphs, placed.element))
        neighbours = ", no neighbour colder" if contacts else ""
        yield Obligation(
            "invariant",
            placed.element,
            f"{spell(floor)} < T <= m < T_e{neighbours}: dS/dt >= lam*(T_e/m - 1) >= 0",
            r"T_0 < T \le m < T_e \Rightarrow \dot S \ge \lambda (T_e/m - 1) \ge 0",
            assumptions.texts,
            questions=tuple(_gains(port, exchanges, contacts, assumptions)),
            rests_on=(*warm, *laws),
            required=False,
        )


def _contacts(iphs: IPHS, element: str) -> Iterator[tuple[Expr, Sym]]:
    """Yield the conductance to each body in contact, and that body's temperature."""
    for _, port in iphs.circuit.of(Conductor):
        if element in (port.first, port.second):
            other = port.second if port.first == element else port.first
            yield port.conductance, Sym(iphs.circuit.body(other).temperature)


def _gains(
    port: Body,
    exchanges: list[Exchange],
    contacts: tuple[tuple[Expr, Sym], ...],
    assumptions: Assumptions,
) -> Iterator[Question]:
    """Yield that warmer neighbours bring entropy, and heat exchange at least as much as at m."""
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
