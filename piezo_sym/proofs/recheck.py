"""A second opinion: every query once more, through another solver.

Input: a `Report`.  Output: the claims on which the other solver does not say the same.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from importlib.util import find_spec
from typing import final

from piezo_sym.errors import UsageError
from piezo_sym.proofs.record import queries
from piezo_sym.proofs.report import Report
from piezo_sym.proofs.solvers import solver


@final
@dataclass(frozen=True)
class Difference:
    """A query on which two solvers differ, or which one of them leaves unknown."""

    label: str
    answers: tuple[str, str]


def recheck(
    report: Report, first: str = "z3", second: str = "cvc5"
) -> tuple[int, list[Difference]]:
    """Return how many queries there are, and those on which two solvers do not agree.

    Raises
    ------
    UsageError
        If the second solver is not installed.
    """
    if find_spec(second) is None:
        remedy = "pip install 'piezo_sym[proof]'"
        raise UsageError(f"{second} is not installed", "--recheck", remedy=remedy)
    asked, found = 0, []
    for label, answers in _answers(report, first, second):
        asked += 1
        if answers[0] != answers[1] or "unknown" in answers:
            found.append(Difference(label, answers))
    return asked, found


def _answers(report: Report, first: str, second: str) -> Iterator[tuple[str, tuple[str, str]]]:
    whole = {(row.id, row.element) for row in report.rows if row.method == "intervals"}
    for obligation in report.obligations:
        if (obligation.id, obligation.element) in whole:
            continue
        for query in queries(obligation):
            answers = solver(first).ask(query).result, solver(second).ask(query).result
            yield f"{obligation.id} {obligation.element}: {query.label}", answers
