"""Everything that is examined of a system: proofs, printed modules, and attacks by numbers.

Input: an `IPHS`.  Output: the texts of its module, its rows, and their verdicts one by one.
A verdict is PROVED only if it was proved and no number contradicts it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import AbstractContextManager, nullcontext
from dataclasses import replace
from types import MappingProxyType
from typing import Any, TypeAlias, final

from piezo_sym.codegen import template_of
from piezo_sym.falsify import POINTS, Attack, Hunt, module_from
from piezo_sym.iphs import IPHS
from piezo_sym.proofs import Prover, Report, Row, Verdict
from piezo_sym.spec.values import Template
from piezo_sym.translation import program_row, worst
from piezo_sym.translation.program import STATEMENT
from piezo_sym.verification.protocol import Progress
from piezo_sym.verification.record import Record

#: Rows that say something at every point of the domain, and so can be attacked by numbers.
ATTACKED = frozenset(
    {"passive", "temperature", "welldef", "continuous", "sigma", "exergy", "environment"}
    | {"invariant"}
)
#: The fraction of the time left that a row may take while other rows are not decided.
SHARE = 0.125
#: A context with the results of some work, which is done when they are asked for, or `beside`.
Apart: TypeAlias = Callable[[Iterator[Any]], AbstractContextManager[Iterator[Any]]]
NOTHING: Mapping[int, Any] = MappingProxyType({})
PROGRAM = Row("program", "", STATEMENT, Verdict.OPEN)


def examine(
    iphs: IPHS,
    points: int = POINTS,
    apart: Apart = nullcontext,
    late: Mapping[int, int] = NOTHING,
    known: Mapping[int, Row] = NOTHING,
) -> Iterator[Template | Report | Progress]:
    """Yield the texts of a system's module, its rows (all open), and each verdict once it is final.

    A report with the statements of the rows comes when all rows are decided.

    Parameters
    ----------
    points : how many points the attack takes; fewer in tests of many small networks alone.
    apart : how texts are printed and read back: when needed, or `beside` proofs and attacks.
    late, known : how often each row took more than its share; the rows decided; see `Request`.
    """
    with apart(_printed(iphs, apart)) as printed:
        try:
            prover = Prover(iphs)
        finally:  # the texts are wanted even without a prover
            yield (made := next(printed))
        rows = (*prover.rows, PROGRAM)
        yield Report(iphs.model.name, rows)
        text = made.filled(iphs.model.flatten().model_dump())[".py"]
        work = _Work(prover, rows, text, points, printed)
        again = [n for n, times in late.items() if times == 1]
        rest = [n for n in range(len(prover.obligations)) if n not in late]
        waiting = {*work.prover.resting(late)}
        sure = {n: row for n, row in known.items() if n not in waiting}
        yield from work.decided(rest, SHARE, sure)
        if work.program not in {*late, *known}:
            yield from work.read_back(0.5 if again else 1.0)
        for number in sorted(again):
            if number == work.program:
                yield from work.read_back(1.0)
            else:
                left = [n for n in prover.resting((number,)) if late.get(n, 1) == 1]
                yield from work.decided(left, 1 / len(again))
        yield work.begun(None, 1.0)


def examined(messages: Iterable[Template | Report | Progress]) -> Report:
    """Return the report that the messages of `examine` add up to."""
    record = Record("", 0.0)
    for message in messages:
        if not isinstance(message, Template):
            record.take(message)
    return record.report()


@final
class _Work:
    """The rows of a system that is examined."""

    def __init__(
        self, prover: Prover, rows: tuple[Row, ...], text: str, points: int, read: Iterator[Row]
    ) -> None:
        self.prover, self.rows, self.points, self.read = prover, rows, points, read
        self.program = len(rows) - 1
        self._text, self._done, self._proved = text, dict[int, Row](), dict[int, Row]()

    def begun(self, number: int | None, part: float) -> Progress:
        """Return what was decided since the last call, and what is done next."""
        done, proved, self._done, self._proved = self._done, self._proved, {}, {}
        return Progress(done, number, part, proved)

    def decided(
        self, numbers: Iterable[int], part: float, known: Mapping[int, Row] = NOTHING
    ) -> Iterator[Progress | Report]:
        """Decide the rows that are not known, and attack the proved ones that were not attacked."""
        claims = list[int]()
        for number in numbers:
            if number in known:
                self.prover.rows[number] = row = known[number]
            else:
                yield self.begun(number, part)
                row = self.prover.decide(number)
            if row.id in ATTACKED and row.verdict is Verdict.PROVED and not row.points:
                claims.append(number)
                self._proved[number] = row
            else:
                self._done[number] = row
        yield self.begun(None, 1.0)
        yield replace(self.prover.report(), rows=self.rows)  # with statements
        keys = self._attackable(claims)
        if not keys:
            return
        hunt = Hunt(self.prover.iphs, module_from(self._text), tuple(keys.values()), self.points)
        hunt.search()
        for number, key in keys.items():
            yield self.begun(number, part)
            row, attack = self.prover.rows[number], hunt.attack(key)
            self.prover.rows[number] = self._done[number] = _attacked(row, attack)
            if attack and attack.worst:  # an extra row, after all others
                self._done[self.program + 1 + number] = _rounding(row, attack)

    def _attackable(self, claims: Iterable[int]) -> dict[int, tuple[str, str]]:
        """Return the id and the element of the rows to attack; the other claims become OPEN.

        Rows on divisors of the junction laws share id and element, so an attack is on all of them.
        """
        rows, keys = self.prover.rows, dict[int, tuple[str, str]]()
        for number in claims:
            row = rows[number]
            beside = (r for r in rows if (r.id, r.element) == (row.id, row.element))
            doubted = next((r for r in beside if r.verdict is not Verdict.PROVED), None)
            if doubted:
                reason = f"its laws are also those of a row that is {doubted.verdict.value}"
                rows[number] = replace(row, verdict=Verdict.OPEN, reason=reason)
                self._done[number] = rows[number]
            else:
                keys[number] = row.id, row.element
        return keys

    def read_back(self, part: float) -> Iterator[Progress]:
        """Decide the row on the printed texts."""
        yield self.begun(self.program, part)
        self._done[self.program] = next(self.read)


def _printed(iphs: IPHS, apart: Apart) -> Iterator[Any]:
    """Yield the texts of a module, then the row on them, read back."""
    yield (made := template_of(iphs))
    texts = made.filled(iphs.model.flatten().model_dump())
    with apart(program_row(iphs, texts, [end]) for end in ["_step.c"]) as of_step:  # one, lazily
        yield worst([program_row(iphs, texts, (".py", ".c")), next(of_step)])


def _attacked(row: Row, attack: Attack | None) -> Row:
    """Return a row with the number of points that it was attacked at; without any it is open."""
    if attack is None or attack.points == 0:
        reason = "no point of the domain was found at which numbers could contradict it"
        return replace(row, verdict=Verdict.OPEN, reason=reason)
    return replace(row, points=attack.points)


def _rounding(row: Row, attack: Attack) -> Row:
    """Return the row that the module rounds to the other side, at a point that an attack found."""
    statement = f"{row.name}: the generated module rounds to the other side"
    reason = "doubles cannot tell it from zero there; the exact value does not contradict it"
    return Row(
        "rounding", row.element, statement, Verdict.OPEN, attack.worst, reason, required=False
    )
