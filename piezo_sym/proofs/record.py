"""Proofs as files that others can check: ``proofs.json`` to read, ``proofs.smt2`` for a solver.

Input: a `Report`.  Output: the texts.  A third party runs ``z3 proofs.smt2`` or ``cvc5
--incremental proofs.smt2``: each ``unsat`` proves the claim in the comment above it.
"""

from __future__ import annotations

import json
from itertools import zip_longest

from piezo_sym.proofs.obligations import Obligation
from piezo_sym.proofs.report import Report, Row
from piezo_sym.spec.model import Model


def smt2(report: Report, made: str) -> str:
    """Return every query of a report in SMT-LIB 2, each between push and pop.

    Parameters
    ----------
    report : from `verify`.
    made : the line that says what made the file.
    """
    whole = [row for row in report.rows if row.method == "intervals"]
    elsewhere = {(row.id, row.element) for row in whole}
    lines = [
        f"; {made}",
        f"; Claims on the laws of {report.model}.  Each query asserts the opposite of its claim:",
        "; `unsat` proves it, for all real numbers in the domain.  Functions such as exp stand",
        "; as symbols, of which some bounds are given.  Names have a question mark before them.",
        *(f"; {row.id} of {row.element} is {row.verdict.value} by intervals" for row in whole),
        "(set-logic QF_NRA)",
    ]
    for obligation in report.obligations:
        if (obligation.id, obligation.element) in elsewhere:
            continue
        for query in obligation.queries:
            where = f" of {obligation.element}" if obligation.element else ""
            lines += ["", f"; {obligation.id}{where}: {query.label}", "(push 1)", query.text()]
            lines += ["(check-sat)", "(pop 1)"]
    return "\n".join(lines) + "\n"


def proofs_json(report: Report, model: Model, made: str) -> str:
    """Return every obligation of a report and its verdict, as JSON."""
    entries = zip_longest(report.rows, report.obligations)  # units have rows alone
    content = {
        "made": made,
        "model": report.model,
        "spec_sha256": model.sha256,
        "system": report.system,
        "obligations": [_entry(row, obligation) for row, obligation in entries],
    }
    return json.dumps(content, indent=1) + "\n"


def _entry(row: Row, obligation: Obligation | None) -> dict[str, object]:
    entry: dict[str, object] = {
        "id": row.id,
        "element": row.element or None,
        "statement": row.statement,
        "required": row.required,
        "verdict": row.verdict.value,
        "witness": dict(row.witness) if row.witness else None,
        "reason": row.reason or None,
        "method": row.method,
        "points": row.points,
        "certificate": list(row.certificate) or None,
    }
    if obligation:
        entry["latex"] = obligation.latex
        entry["assumptions"] = list(obligation.assumptions)
        entry["rests_on"] = [list(name) for name in obligation.rests_on]
        entry["queries"] = [query.label for query in obligation.queries]
    return entry
