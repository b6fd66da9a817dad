"""Rows that are decided one after the other, where any of them may take all the time there is.

Input: messages of the process that examines a system.  Output: its `Report`, and which rows come
last when it is examined again.  A row is PROVED only where a message says so; what no message is
about is OPEN, and says which row took the time.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import final

from piezo_sym.report import Report, Row, Verdict
from piezo_sym.verification.protocol import Progress, Stop

#: What the process does while it examines no single row.
ATTACK = "the search for numbers that contradict it"


@final
@dataclass(eq=False)
class Record:
    """The verdicts on the rows of a model so far."""

    model: str  # its name
    limit: float  # seconds that it may take in all
    #: late, known: for another `Request`.
    late: dict[int, int] = field(default_factory=dict)
    known: dict[int, Row] = field(default_factory=dict)
    _stated: Report | None = None
    _rows: dict[int, Row] = field(default_factory=dict)
    _next: int | None = None
    _why: dict[int, str] = field(default_factory=dict)
    _stop: str = ""

    def take(self, message: Report | Progress) -> None:
        """Record a message: a report with all rows, or the verdicts on some rows."""
        if isinstance(message, Report):
            self._stated = message if message.stated else self._stated or message
        else:
            self._rows |= message.rows
            self._next = message.next
            self.known |= {**message.proved, **message.rows}
            for number in message.rows:
                self.late.pop(number, None)

    def goes_on(self, stop: Stop) -> bool:
        """Return whether a system is to be examined again after an early end."""
        number, self._next, self._stop = self._next, None, stop.reason.format(limit=self.limit)
        if number is None:
            return False
        self._why[number] = self._stop
        self.late[number] = self.late.get(number, 0) + 1
        return not stop.last and 1 in self.late.values()

    def report(self) -> Report:
        """Return the report; rows that are not decided are OPEN, with the reason."""
        if self._stated is None:
            row = Row("derivation", "", "the system, derived", Verdict.OPEN, reason=self._stop)
            return Report(self.model, (row,))
        rows = dict(enumerate(self._stated.rows)) | self._rows
        hard = [rows[n].name for n in sorted(self._why) if n not in self._rows]
        lost = f"{self._stop}: {' and '.join(hard) or ATTACK} took the time"
        for n, row in rows.items():
            if n not in self._rows and row.verdict is Verdict.OPEN and not row.reason:
                own = self._why.get(n)
                rows[n] = replace(row, reason=own or lost, waits=own is None)
        return replace(self._stated, rows=tuple(rows[n] for n in sorted(rows)))
