"""Proofs: obligations on an `IPHS`, and verdicts on them.

stage          from -> to                in
obligations    IPHS -> Obligation        assumptions, domain, bodies, balances, laws, continuity
queries        Question -> Query         obligations, branches, rational, query
answers        Query -> Answer           solvers, in processes of their own (worker)
verdicts       Obligation -> Row         prove; sign_analysis and signs; witnesses by exact_eval
report         rows -> Report            published; piezo_sym.report
"""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import cached_property
from itertools import groupby
from typing import final

from piezo_sym.iphs import IPHS
from piezo_sym.proofs import balances, bodies, laws
from piezo_sym.proofs.assumptions import Assumptions, Law, assumptions_of, with_temperatures
from piezo_sym.proofs.continuity import continuous
from piezo_sym.proofs.domain import divisors, domain_defined, why_empty
from piezo_sym.proofs.obligations import Obligation
from piezo_sym.proofs.prove import prove
from piezo_sym.proofs.published import published
from piezo_sym.proofs.solvers import opinions
from piezo_sym.proofs.units import units
from piezo_sym.report import Report, Row, Verdict, proofs_json, smt2
from piezo_sym.spec.elements.ports import Conductor

__all__ = [
    "Obligation",
    "Prover",
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
    prover = Prover(iphs)
    for number in range(len(prover.obligations)):
        prover.decide(number)
    return prover.report()


@final
class Prover:
    """Decides the rows of a system, one at a time; what is not decided yet is OPEN in `rows`.

    Rows on units, which come last, are decided at once.
    """

    def __init__(self, iphs: IPHS) -> None:
        self.iphs, self.obligations = iphs, obligations(iphs)
        self.rows = [
            Row(o.id, o.element, o.statement, Verdict.OPEN, required=o.required, method="")
            for o in self.obligations
        ]
        self.rows += units(iphs)
        self._solver, self._named = opinions(), dict[tuple[str, str], list[int]]()
        for number, o in enumerate(self.obligations):
            self._named.setdefault((o.id, o.element), []).append(number)

    def report(self) -> Report:
        """Return the verdicts, and what was to be shown."""
        asked = tuple(o.published() for o in self.obligations)
        return Report(self.iphs.model.name, tuple(self.rows), asked, published(self.iphs))

    def decide(self, number: int) -> Row:
        """Return the verdict on an obligation, whose premises have been decided."""
        asked = self.obligations[number]
        asked = replace(asked, open_because=self._empty) if self._empty else asked
        premises = dict.fromkeys((*asked.rests_on, ("welldef", asked.element)))
        before = [self.rows[n] for name in premises for n in self._named.get(name, ())]
        self.rows[number] = prove(asked, self.iphs, before, self._solver)
        return self.rows[number]

    def resting(self, numbers: Iterable[int]) -> list[int]:
        """Return some obligations and all that rest on them, each after its premises."""
        found = {*numbers}
        for number, o in enumerate(self.obligations):
            if any(not found.isdisjoint(self._named.get(name, ())) for name in o.rests_on):
                found.add(number)
        return sorted(found)

    @cached_property
    def _empty(self) -> str:
        """The reason to leave all open if the domain has no known point, else ''."""
        return why_empty(self.iphs, assumptions_of(self.iphs), self._solver)


def obligations(iphs: IPHS) -> tuple[Obligation, ...]:
    """Return the obligations of a system, each after those that it rests on."""
    assumptions = assumptions_of(iphs)
    return tuple(
        with_temperatures(obligation.smooth(), assumptions)
        for obligation in _obligations(iphs, assumptions)
    )


def _obligations(iphs: IPHS, assumptions: Assumptions) -> Iterator[Obligation]:
    yield from (balances.skew(iphs), balances.casimir(iphs))
    yield from bodies.temperature(iphs, assumptions)  # rests on no row
    yield from domain_defined(iphs, assumptions)
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
        elif any(isinstance(port, Conductor) for port in iphs.circuit.by_element[element]):
            stated.append(laws.conducts(law, assumptions))
    loose = next((law.letter for law in own if None in law.ties), "")
    yield from (replace(obligation, loose=loose) for obligation in stated if obligation)
