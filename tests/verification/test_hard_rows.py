"""A row that takes all the time leaves the others theirs, and is the one that is named."""

from dataclasses import replace

import pytest

from piezo_sym import load
from piezo_sym.errors import ProofError
from piezo_sym.processes import Worker
from piezo_sym.proofs import Verdict
from piezo_sym.verification import examine, process
from piezo_sym.verification.examine import ATTACKED, examined
from piezo_sym.verification.process import answer
from piezo_sym.verification.protocol import OVERDUE, Progress, Request
from piezo_sym.verification.record import Record

#: Does something instead of proving, or attacking, a row.
WORKER = """
import os, signal
from pathlib import Path
from piezo_sym import proofs
from piezo_sym.falsify import Hunt
from piezo_sym.verification import examine, worker
prove, attack = proofs.prove, Hunt.attack
def proved(obligation, *rest):
    {proving}
    return prove(obligation, *rest)
def attacked(hunt, row):
    {attacking}
    return attack(hunt, row)
proofs.prove, Hunt.attack, examine.SHARE = proved, attacked, {share}
worker.main()
"""
#: What a row does to the process that takes too long, at once.
ENDS = "os.kill(os.getpid(), signal.SIGALRM)"
DAMPER, HYSTERON = ("passive", "damper"), ("passive", "hysteron")
RESTING = {"sigma", "exergy", "environment", "invariant"}


@pytest.fixture
def worker(monkeypatch):
    """Return a function that lets rows of the process do something else."""
    made = []

    def using(proving="pass", attacking="pass", share=0.25):
        code = WORKER.format(proving=proving, attacking=attacking, share=share)
        made.append(Worker("-c", code, group=True))
        monkeypatch.setattr(process, "_examiner", lambda: made[-1])
        return made[-1]

    yield using
    for one in made:
        one.close()


def verdicts(report):
    return {(row.id, row.element): row.verdict for row in report.rows}


@pytest.mark.some(1)
@pytest.mark.parametrize("stage", ["proving", "attacking"])
def test_the_others_are_decided(worker, stage):
    row = "(obligation.id, obligation.element)" if stage == "proving" else "row"
    worker(**{stage: f"{row} == {DAMPER} and {ENDS}"})
    report = process.examined(load("oscillator"))
    found = verdicts(report)
    assert {key for key, verdict in found.items() if verdict is not Verdict.PROVED} == {
        DAMPER,
        *(key for key in found if key[0] in RESTING),
    }
    assert {row.points > 0 for row in report.rows if row.verdict is Verdict.PROVED} == {True, False}
    (hard,) = (row for row in report.rows if (row.id, row.element) == DAMPER)
    assert hard.reason == "not decided in its share of 28 s"
    with pytest.raises(ProofError, match=r"oscillator\.damper: passive is OPEN: not decided in"):
        report.raise_if_not_proved()


@pytest.mark.long
def test_of_two_hard_rows_each_is_named(worker):
    worker(attacking=f"row in {(DAMPER, HYSTERON)} and {ENDS}")
    report = process.examined(load("piezo_stack"))
    left = {row.name for row in report.rows if "its share" in row.reason}
    assert left == {"passive of damper", "passive of hysteron"}
    assert verdicts(report)["program", ""] is Verdict.PROVED


@pytest.mark.long
def test_a_row_that_takes_more_than_its_share_gets_what_is_left(worker, tmp_path):
    """The system ends it where the interpreter has no turn."""
    once = f"Path({str(tmp_path / 'seen')!r})"
    hangs = f"row == {DAMPER} and not {once}.exists() and ({once}.touch(), 3**10**10)"
    worker(attacking=hangs, share=0.05)
    assert process.examined(load("oscillator")).proved
    assert (tmp_path / "seen").exists()


@pytest.fixture(scope="module")
def found():
    """All messages on a model."""
    return [*answer(Request(load("piezo_stack"), 60.0))]


def test_rows_that_were_not_reached_say_what_took_the_time(found):
    number = next(
        n for n, row in enumerate(examined(found).rows) if (row.id, row.element) == DAMPER
    )
    begun = [m for m in found if isinstance(m, Progress) and m.next == number]
    record = Record("piezo_stack", 28.0)
    for message in found[1 : found.index(begun[-1]) + 1]:  # its attack takes all the time
        record.take(message)
    assert not record.goes_on(OVERDUE)
    reasons = {row.name: row.reason for row in record.report().rows}
    assert reasons["welldef of hysteron"] == reasons["energy"] == ""
    assert reasons["passive of damper"] == "not decided in 28 s"
    assert reasons["program"] == "not decided in 28 s: passive of damper took the time"
    with pytest.raises(ProofError, match=r"piezo_stack\.damper: passive is OPEN"):
        record.report().raise_if_not_proved()


def test_where_no_row_takes_the_time_the_search_does(found):
    record = Record("piezo_stack", 28.0)
    for message in found[1:-1]:
        if record._next is None and len(record._rows) > 1:
            break
        record.take(message)
    assert not record.goes_on(OVERDUE)
    said = {row.reason for row in record.report().rows} - {""}
    assert said == {"not decided in 28 s: the search for numbers that contradict it took the time"}


def test_a_row_is_proved_by_its_message_alone(found):
    sent = [m for m in found if isinstance(m, Progress) and m.rows]
    for message in sent:
        report = examined(m for m in found if m is not message)
        left = {(row.id, row.element) for row in report.failures}
        assert left == {(row.id, row.element) for row in message.rows.values() if row.required}
    proved = [row for message in sent for row in message.rows.values()]
    assert {row.points > 0 for row in proved if row.id in ATTACKED} == {True}


@pytest.mark.some(1)
@pytest.mark.parametrize("row", [("temperature", "body"), DAMPER, ("program", "")])
def test_a_row_that_comes_last_has_the_same_verdict(found, row):
    wanted = verdicts(examined(found))
    number = [*wanted].index(row)
    again = examined(answer(Request(load("piezo_stack"), 60.0, {number: 1})))
    assert verdicts(again) == wanted
    assert again.rows == examined(found).rows


def test_a_row_that_is_left_out_is_open_and_so_are_those_that_rest_on_it(found):
    number = [*verdicts(examined(found))].index(("temperature", "body"))
    without = verdicts(examined(answer(Request(load("piezo_stack"), 60.0, {number: 2}))))
    assert {without[key] for key in without if key[0] in {"temperature", "sigma"}} == {Verdict.OPEN}
    assert without[DAMPER] is Verdict.PROVED


def test_of_rows_that_rest_on_one_that_comes_last_none_is_decided_that_is_left_out(found):
    keys = [*verdicts(examined(found))]
    first, *last = (keys.index(key) for key in (("temperature", "body"), ("sigma", ""), DAMPER))
    late = {first: 1, **dict.fromkeys(last, 2)}
    sent = answer(Request(load("piezo_stack"), 60.0, late))
    assert {m.next for m in sent if isinstance(m, Progress)}.isdisjoint(last)


def test_rows_that_are_known_are_not_decided_again(found, monkeypatch):
    """They are attacked, unless they were."""
    record = Record("piezo_stack", 28.0)
    for message in found[1:]:
        if isinstance(message, Progress) and record._next is None and len(record.known) > 1:
            break  # all are decided, none is attacked
        record.take(message)
    wanted = examined(found).rows
    decided = {n for n, row in enumerate(wanted) if row.id not in {"units", "program"}}
    assert record.known.keys() == decided
    assert not any(row.points for row in record.known.values())
    monkeypatch.setattr(examine.Prover, "decide", None)
    again = Request(load("piezo_stack"), 60.0, known=record.known)
    assert examined(answer(again)).rows == wanted
    monkeypatch.undo()
    number = [*verdicts(examined(found))].index(DAMPER)
    again = Request(load("piezo_stack"), 60.0, {number: 2}, record.known)
    without = verdicts(examined(answer(again)))  # what rests on a row that is not is not known
    assert {without[key] for key in without if key[0] in {"sigma", "exergy"}} == {Verdict.OPEN}
    monkeypatch.setattr(examine, "Hunt", None)
    again = Request(load("piezo_stack"), 60.0, known=dict(enumerate(wanted)))
    assert examined(answer(again)).rows[:-1] == wanted[:-1]  # the last is not sent again


def test_a_row_that_is_proved_alone_is_open(found):
    """Rows to be attacked are sent for another request, and not as verdicts."""
    sent = [replace(m, rows={}) if isinstance(m, Progress) else m for m in found]
    assert any(m.proved for m in sent if isinstance(m, Progress))
    left = {row.verdict for row in examined(sent).rows if row.id != "units"}
    assert left == {Verdict.OPEN}
