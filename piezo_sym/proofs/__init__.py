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
from piezo_sym.proofs.assumptions import Assumptions, Law, assumptions_of, on_warm_bodies
from piezo_sym.proofs.continuity import continuous
from piezo_sym.proofs.domain import defined, divisors, not_shown
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
    """Return what is proved, refuted or open of a system, by algebra, solvers and intervals alone.

    `piezo_sym.verify` calls a row PROVED only after more than this: see `verification`.
    """
    rows: list[Row] = []
    by_name: dict[tuple[str, str], list[Row]] = {}
    found, asked = obligations(iphs), opinions()
    empty = not_shown(iphs, assumptions_of(iphs), asked) if found else ""
    for obligation in found:
        left = replace(obligation, open_because=empty) if empty else obligation
        needed = dict.fromkeys((*left.rests_on, ("welldef", left.element)))
        before = [row for name in needed for row in by_name.get(name, ())]
        rows.append(row := prove(left, iphs, before, asked))
        by_name.setdefault((row.id, row.element), []).append(row)
    return Report(iphs.model.name, (*rows, *units(iphs)), found, published(iphs))


def obligations(iphs: IPHS) -> tuple[Obligation, ...]:
    """Return what has to be shown of a system, in an order in which each rests on earlier ones."""
    assumptions = assumptions_of(iphs)
    return tuple(
        on_warm_bodies(made.smooth(), assumptions) for made in _obligations(iphs, assumptions)
    )


def _obligations(iphs: IPHS, assumptions: Assumptions) -> Iterator[Obligation]:
    yield from (balances.skew(iphs), balances.casimir(iphs))
    yield from defined(iphs, assumptions)
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
    """Yield what has to be shown of the laws of one element."""
    found = [laws.welldef(own, assumptions), continuous(own, assumptions)]
    for law in own:
        if law.letter:
            information = laws.rate_independent if law.rate else laws.odd
            found += (laws.passive(law, assumptions), information(law, assumptions))
        elif any(placed.element == element for placed, _ in iphs.circuit.of(Conductor)):
            found.append(laws.conducts(law, assumptions))
    loose = next((law.letter for law in own if None in law.ties), "")
    yield from (replace(made, loose=loose) for made in found if made)
