"""Proofs: obligations on an `IPHS`, and verdicts on them.

stage          from -> to                in
obligations    IPHS -> Obligation        domain, bodies, balances, laws, ties, continuity
queries        Question -> Query         obligations, branches, rational, query
answers        Query -> Answer           solvers, in processes of their own (worker)
verdicts       Obligation -> Row         prove; sign_analysis and signs; witnesses by exact_eval
report         rows -> Report            report, published
"""

from collections.abc import Iterator
from dataclasses import replace
from itertools import groupby

from piezo_sym.iphs import IPHS
from piezo_sym.proofs import balances, bodies, laws
from piezo_sym.proofs.assumptions import Assumptions, Law, assumptions_of, with_temperatures
from piezo_sym.proofs.continuity import continuous
from piezo_sym.proofs.domain import divisors, domain_defined, why_empty
from piezo_sym.proofs.obligations import Obligation
from piezo_sym.proofs.prove import prove
from piezo_sym.proofs.published import published
from piezo_sym.proofs.report import Report, Row, Verdict, proofs_json, smt2
from piezo_sym.proofs.solvers import opinions
from piezo_sym.proofs.units import units
from piezo_sym.spec.elements.ports import Conductor

__all__ = [
    "Obligation",
    "Report",
    "Row",
    "Verdict",
    "decide",
    "obligations",
    "proofs_json",
    "prove",
    "smt2",
]


def decide(iphs: IPHS) -> Report:
    """Return the verdicts on a system by algebra, solvers and intervals alone.

    `piezo_sym.verify` asks for more before it calls a row PROVED: see `verification`.
    """
    rows: list[Row] = []
    by_name: dict[tuple[str, str], list[Row]] = {}
    stated, solver = obligations(iphs), opinions()
    empty = why_empty(iphs, assumptions_of(iphs), solver) if stated else ""
    for obligation in stated:
        asked = replace(obligation, open_because=empty) if empty else obligation
        premises = dict.fromkeys((*asked.rests_on, ("welldef", asked.element)))
        before = [row for name in premises for row in by_name.get(name, ())]
        rows.append(row := prove(asked, iphs, before, solver))
        by_name.setdefault((row.id, row.element), []).append(row)
    return Report(iphs.model.name, (*rows, *units(iphs)), stated, published(iphs))


def obligations(iphs: IPHS) -> tuple[Obligation, ...]:
    """Return the obligations of a system, each after those that it rests on."""
    assumptions = assumptions_of(iphs)
    return tuple(
        with_temperatures(obligation.smooth(), assumptions)
        for obligation in _obligations(iphs, assumptions)
    )


def _obligations(iphs: IPHS, assumptions: Assumptions) -> Iterator[Obligation]:
    yield from (balances.skew(iphs), balances.casimir(iphs))
    yield from domain_defined(iphs, assumptions)
    yield from bodies.temperature(iphs, assumptions)
    yield from divisors(iphs, assumptions)
    yield from (balances.energy(iphs, assumptions), balances.entropy(iphs))
    for element, own in groupby(laws.laws_of(iphs), key=lambda law: law.element):
        yield from _of_element(iphs, element, tuple(own), assumptions)
    yield balances.sigma(iphs)
    yield from balances.exergy(iphs, assumptions)
    yield from balances.environment(iphs, assumptions)
    yield from bodies.invariant(iphs, assumptions)


def _of_element(
    iphs: IPHS, element: str, own: tuple[Law, ...], assumptions: Assumptions
) -> Iterator[Obligation]:
    """Yield the obligations on the laws of one element."""
    stated = [laws.welldef(own, assumptions), continuous(own, assumptions)]
    for law in own:
        if law.letter:
            information = laws.rate_independent if law.rate else laws.odd
            stated += (laws.passive(law, assumptions), information(law, assumptions))
        elif any(placed.element == element for placed, _ in iphs.circuit.of(Conductor)):
            stated.append(laws.conducts(law, assumptions))
    loose = next((law.letter for law in own if None in law.ties), "")
    yield from (replace(obligation, loose=loose) for obligation in stated if obligation)
