"""Verdicts, with the numbers that refute and the reasons why something is open.

Input: rows.  Output: a `Report` to print or to raise from, and files for others to check:
``proofs.json`` to read, ``proofs.smt2`` for a solver (``z3 proofs.smt2`` or ``cvc5 --incremental
proofs.smt2``: each ``unsat`` proves the claim in the comment above it).
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from enum import Enum
from itertools import zip_longest
from typing import TYPE_CHECKING, Any, final

from piezo_sym.errors import ProofError

if TYPE_CHECKING:
    from piezo_sym.spec.model import Model


#: How the reason of a row begins that is open because another is not proved.
RESTS = "it rests on"


@final
class Verdict(Enum):
    """PROVED: for all states, inputs and parameters in the domain, and banks of every size."""

    PROVED = "PROVED"
    REFUTED = "REFUTED"
    OPEN = "OPEN"


@final
@dataclass(frozen=True)
class Row:
    """One property of one model.

    Attributes
    ----------
    id : such as ``energy``.
    element : the element it is about, or empty for the whole model.
    statement : the property in words.
    verdict : see `Verdict`.
    witness : for REFUTED, a value for every symbol at which the property fails.
    reason : for REFUTED what fails there, for OPEN what is missing.
    required : whether `generate` insists on it; else it is information.
    method : what decided it: algebra, branches (queries), or intervals (the law as a whole).
    points : the number of points of the domain at which it was found true.
    certificate : for intervals, the data for a second program to check; see `signs`.
    waits : whether it is open for want of time alone, which other rows have taken.
    """

    id: str
    element: str
    statement: str
    verdict: Verdict
    witness: Mapping[str, str] | None = None
    reason: str = ""
    required: bool = True
    method: str = "algebra"
    points: int = 0
    certificate: tuple[Mapping[str, object], ...] = ()
    waits: bool = False

    @property
    def name(self) -> str:
        """The row in words, such as ``passive of damper``."""
        return f"{self.id} of {self.element}" if self.element else self.id

    @property
    def is_cause(self) -> bool:
        """Whether it is said before others: a wrong unit is often why other rows fail."""
        return self.id == "units"

    @property
    def at(self) -> str:
        """The witness as text, such as ``d = -1, v = 1``, or ''."""
        return ", ".join(f"{name} = {value}" for name, value in (self.witness or {}).items())

    @property
    def why(self) -> str:
        """The reason, with the witness after its first part."""
        fails, *more = self.reason.split("; ", 1)
        return "; ".join([f"{fails} at {self.at}" if self.at else fails, *more])

    def as_dict(self, model: str) -> dict[str, object]:
        """Return the row as plain data, as ``verify --json`` prints it."""
        return {
            "model": model,
            "id": self.id,
            "element": self.element or None,
            "verdict": self.verdict.value,
            "witness": dict(self.witness) if self.witness else None,
            "reason": self.reason or None,
        }


@final
@dataclass(frozen=True)
class Stated:
    """What was to be shown for a row.

    Attributes
    ----------
    latex : the property as mathematics.
    assumptions : the comparisons of the domain that it is stated under.
    rests_on : (id, element) of the rows that must hold, too.
    queries : for solvers, in words and in SMT-LIB 2.
    """

    latex: str
    assumptions: tuple[str, ...] = ()
    rests_on: tuple[tuple[str, str], ...] = ()
    queries: tuple[tuple[str, str], ...] = ()


@final
@dataclass(frozen=True, repr=False)
class Report:
    """The verdicts on one model.

    Attributes
    ----------
    model : its name.
    rows : the verdicts.
    stated : what was to be shown for each row; rows on units come last, and have none.
    system : the system as text, for a second program to check; see `published`.
    sources : the hash of the sources of the package that made it, if it was made by a process.
    """

    model: str
    rows: tuple[Row, ...]
    stated: tuple[Stated, ...] = ()
    system: Mapping[str, object] = field(default_factory=dict)
    sources: str = ""

    @property
    def failures(self) -> tuple[Row, ...]:
        """The required rows that are not proved."""
        return tuple(r for r in self.rows if r.required and r.verdict is not Verdict.PROVED)

    @property
    def information(self) -> frozenset[tuple[str, str]]:
        """(id, element) of the rows that `generate` does not insist on."""
        return frozenset((row.id, row.element) for row in self.rows if not row.required)

    @property
    def proved(self) -> bool:
        """Whether every required property is proved."""
        return not self.failures

    @property
    def decided(self) -> bool:
        """Whether no row is open, so that more time would change none; rounding is no verdict."""
        return all(row.verdict is not Verdict.OPEN or row.id == "rounding" for row in self.rows)

    @property
    def refuted(self) -> bool:
        """Whether a required row is refuted, and open rows rest on others: time changes none."""
        open_rows = [r for r in self.rows if r.verdict is Verdict.OPEN and r.id != "rounding"]
        found = any(row.verdict is Verdict.REFUTED for row in self.failures)
        return found and all(row.reason.startswith(RESTS) for row in open_rows)

    def raise_if_not_proved(self) -> None:
        """Raise if a required property is not proved: names units first, then refuted, then open.

        Raises
        ------
        ProofError
            Names the property, its witness or the reason why it is open.
        """
        if self.failures:
            row = min(
                self.failures,
                key=lambda row: (not row.is_cause, row.verdict is Verdict.OPEN, row.waits),
            )
            what = f"{row.id} is {row.verdict.value}"
            where = f"{self.model}.{row.element}" if row.element else self.model
            remedy = f"mend the law or the {'unit' if row.is_cause else 'domain'}"
            others = sum(row.verdict is Verdict.REFUTED for row in self.failures) - 1
            if others > 0:  # rows that rest on these are OPEN
                remedy += f"; {others} more REFUTED: see `piezo-sym verify SPEC`"
            raise ProofError(f"{what}: {row.why}", where, row.statement, remedy)

    def summary(self) -> str:
        """Return one line: how many rows have which verdict."""
        counts = {v: sum(row.verdict is v for row in self.rows) for v in Verdict}
        return ", ".join(f"{count} {v.value}" for v, count in counts.items() if count)

    def __str__(self) -> str:
        """Return the verdicts as lines of text."""
        lines = [f"{self.model}: {self.summary()}"]
        for row in self.rows:
            attacked = f" ({row.points:,} points)" if row.points else ""
            lines.append(
                f"  {row.verdict.value:8} {row.id:12} {row.element:12} {row.statement}{attacked}"
            )
            lines += [f"           {row.why}"] if row.reason else []
        return "\n".join(lines)

    __repr__ = __str__


def smt2(report: Report, made: str) -> str:
    """Return every query of a report in SMT-LIB 2, each between push and pop.

    The first line is `made`, which names the generator.
    """
    by_intervals = [row for row in report.rows if row.method == "intervals"]
    lines = [
        f"; {made}",
        f"; Claims on the laws of {report.model}.  Each query asserts the opposite of its claim:",
        "; `unsat` proves it, for all real numbers in the domain.  A function such as exp is",
        "; a symbol with bounds on its values.  Names begin with a question mark.",
        *(
            f"; {row.id} of {row.element} is {row.verdict.value} by intervals"
            for row in by_intervals
        ),
        "(set-logic QF_NRA)",
    ]
    for row, stated in zip(report.rows, report.stated, strict=False):
        for label, query in stated.queries if row.method != "intervals" else ():
            lines += ["", f"; {row.name}: {label}", "(push 1)", query]
            lines += ["(check-sat)", "(pop 1)"]
    return "\n".join(lines) + "\n"


def proofs_json(report: Report, model: Model, made: str) -> str:
    """Return every row of a report and what was to be shown for it, as JSON."""
    entries = zip_longest(report.rows, report.stated)  # units have no `stated`
    content = {
        "made": made,
        "model": report.model,
        "spec_sha256": model.sha256,
        "system": report.system,
        "obligations": [_entry(row, stated) for row, stated in entries],
    }
    return json.dumps(content, indent=1) + "\n"


def report_of(text: str) -> Report:
    """Return the rows and the system in the text of ``proofs.json``, without what was stated."""
    content = json.loads(text)
    rows = (_row(entry) for entry in content["obligations"])
    return Report(content["model"], tuple(rows), system=content["system"])


def _row(entry: Mapping[str, Any]) -> Row:
    given = {name: entry[name] for name in Row.__annotations__ if entry.get(name) is not None}
    given["verdict"] = Verdict(entry["verdict"])
    given["certificate"] = tuple(entry["certificate"] or ())
    return Row(**{"element": "", **given})


def _entry(row: Row, stated: Stated | None) -> dict[str, object]:
    plain = row.as_dict("")
    entry = {
        **{name: plain[name] for name in ("id", "element")},
        "statement": row.statement,
        "required": row.required,
        **{name: plain[name] for name in ("verdict", "witness", "reason")},
        **{name: getattr(row, name) for name in ("method", "points")},
        "certificate": row.certificate or None,
    }
    if stated:
        entry |= asdict(stated)
        entry["queries"] = [label for label, _ in stated.queries]
    return entry
