"""Everything that is examined of a system: proofs, printed modules, and attacks by numbers.

Input: an `IPHS`.  Output: the texts of its module, then reports, each more complete than the one
before; the last one is whole.
A row is PROVED in the last one only if it was proved and no number contradicts it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager, nullcontext
from dataclasses import replace
from typing import Any

from piezo_sym.codegen.template import template_of
from piezo_sym.falsify import POINTS, Attack, falsify, module_from
from piezo_sym.iphs import IPHS
from piezo_sym.proofs import Report, Row, Verdict, decide
from piezo_sym.spec.values import Template
from piezo_sym.translation import program_row, worst

#: Rows that say something at every point of the domain, and so can be attacked by numbers.
ATTACKED = frozenset(
    {"passive", "temperature", "welldef", "continuous", "sigma", "exergy", "environment"}
    | {"invariant"}
)


def examine(
    iphs: IPHS,
    points: int = POINTS,
    apart: Callable[[Iterator[Any]], AbstractContextManager[Iterator[Any]]] = nullcontext,
) -> Iterator[Template | Report]:
    """Yield the texts of a system's module, then verdicts that were not attacked yet, then all.

    Parameters
    ----------
    points : how many points the attack takes; fewer in tests of many small networks alone.
    apart : where printed texts are read back: in turn, or `beside` proofs and attacks.
    """
    made = template_of(iphs)
    yield made
    texts = made.filled(iphs.model.flatten().model_dump())
    of_system = apart(_read_back(iphs, texts, (".py", ".c")))
    of_step = apart(_read_back(iphs, texts, ("_step.c",)))
    with of_system as system, of_step as step:
        proved = decide(iphs)
        yield proved
        module = module_from(texts[".py"])
        proofs = (r for r in proved.rows if r.id in ATTACKED and r.verdict is Verdict.PROVED)
        claims = tuple((row.id, row.element) for row in proofs)
        attacks = falsify(iphs, module, claims, points=points)
        rows = (*proved.rows, worst((next(system), next(step))))
    found = {(attack.id, attack.element): attack for attack in attacks}
    attacked = (_attacked(row, found.get((row.id, row.element))) for row in rows)
    rounding = (_rounding(attack) for attack in attacks if attack.worst)
    yield replace(proved, rows=(*attacked, *rounding))


def _read_back(iphs: IPHS, texts: Mapping[str, str], endings: tuple[str, ...]) -> Iterator[Row]:
    """Yield the row on some of the printed texts."""
    yield program_row(iphs, texts, endings)


def unfinished(report: Report, reason: str) -> Report:
    """Return a report whose proved rows were not all attacked: those are open."""
    rows = (
        replace(row, verdict=Verdict.OPEN, reason=reason)
        if row.id in ATTACKED and row.verdict is Verdict.PROVED
        else row
        for row in report.rows
    )
    program = Row("program", "", "the printed modules are the proved system", Verdict.OPEN)
    missing = () if any(r.id == "program" for r in report.rows) else (program,)
    return replace(report, rows=(*rows, *(replace(row, reason=reason) for row in missing)))


def _attacked(row: Row, attack: Attack | None) -> Row:
    """Return a row with the number of points that it was attacked at; without any it is open."""
    if row.id not in ATTACKED or row.verdict is not Verdict.PROVED:
        return row
    if attack is None or attack.points == 0:
        reason = "no point of the domain was found at which numbers could contradict it"
        return replace(row, verdict=Verdict.OPEN, reason=reason)
    return replace(row, points=attack.points)


def _rounding(attack: Attack) -> Row:
    name = f"{attack.id} of {attack.element}" if attack.element else attack.id
    statement = f"{name}: the generated module rounds to the other side"
    reason = "doubles cannot tell it from zero there; the exact value does not contradict it"
    return Row(
        "rounding", attack.element, statement, Verdict.OPEN, attack.worst, reason, required=False
    )
