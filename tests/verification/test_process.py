"""The process in which systems are examined ends in time, and says what was not decided."""

import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from contextlib import suppress

import pytest

from piezo_sym import PiezoError, derive, load, verify
from piezo_sym.codegen import template_of
from piezo_sym.errors import ProofError, SpecError
from piezo_sym.processes import Worker, beside
from piezo_sym.proofs import Report, Verdict
from piezo_sym.spec.load import parse
from piezo_sym.spec.values import Template
from piezo_sym.verification import examine, process
from piezo_sym.verification.process import answer, examined, examining, messages
from piezo_sym.verification.protocol import ENDED, OVERDUE, TOO_LARGE, Progress, Request
from tests.proofs.test_false_proofs import MASS


@pytest.fixture
def examiner():
    made = Worker("-m", "piezo_sym.verification.worker", group=True)
    yield made
    made.close()


def test_a_report_is_that_of_the_system():
    """The system itself is sent, not its spec: an edited one is seen as it is."""
    iphs = derive(load("piezo_stack"))
    report = verify(iphs)
    assert report.proved
    assert {row.points >= 100_000 for row in report.rows if row.id == "passive"} == {True}
    assert pickle.loads(pickle.dumps(iphs)).system.rhs == iphs.system.rhs


def test_what_takes_too_long_is_stopped_and_the_next_one_is_answered(examiner):
    model = load("oscillator")
    assert list(messages(examiner, Request(model, 0.01))) == [OVERDUE]
    found = {type(m) for m in messages(examiner, Request(model, 60.0))}
    assert found == {Template, Report, Progress}


def test_what_is_not_decided_in_time_is_open(monkeypatch):
    monkeypatch.setattr(process, "PATIENCE", 0.01)
    report = examined(load("oscillator"))
    assert not report.proved
    assert {row.verdict for row in report.rows} == {Verdict.OPEN}
    assert "not decided in 0.01 s" in report.rows[0].reason


@pytest.mark.parametrize(("waiting", "times"), [(0.2, 1.0), (2.5, 2.5), (50.0, 4.0)])
def test_a_busy_machine_is_given_more_time(waiting, times, monkeypatch):
    """What is decided depends as little as can be on what else the machine does."""
    monkeypatch.setattr(os, "getloadavg", lambda: (waiting * (os.cpu_count() or 1), 0.0, 0.0))
    assert process.crowding() == pytest.approx(times)


def test_an_error_of_the_derivation_comes_back_as_it_is(examiner):
    broken = parse(
        MASS.format(parameters="", domain="", elements="", force="m*v*0").replace(
            'at = "tip"', 'at = "tap"'
        )
    )
    with pytest.raises(PiezoError) as wanted:
        derive(broken)
    (error,) = messages(examiner, Request(broken, 60.0))
    assert isinstance(error, PiezoError)
    assert str(error) == str(wanted.value)


def test_errors_with_all_their_parts_can_be_sent():
    error = SpecError("what", "where", expected="this", remedy="that")
    assert str(pickle.loads(pickle.dumps(error))) == str(error)


SLOW = {
    "a tower of exponentials": "m*v*exp(exp(exp(exp(exp(v/v_1)))))",
    "an exponential of one": "-F_1*v/v_1*exp(exp(1e9*v/v_1))",
}


@pytest.mark.some(1)
@pytest.mark.parametrize("name", SLOW)
def test_laws_that_once_hung_end(name):
    parameters = 'v_1 = { value = 1.0, unit = "m/s" }\nF_1 = { value = 1.0, unit = "N" }'
    force = SLOW[name].replace("m*v", "F_1*v/v_1")
    text = MASS.format(
        parameters=parameters, domain='"v_1 > 0", "F_1 > 0"', elements="", force=force
    )
    report = examined(parse(text))
    verdicts = {(row.id, row.element): row.verdict for row in report.rows}
    if force.startswith("-"):
        assert verdicts["passive", "damper"] is not Verdict.PROVED


def running(pid):
    """Return whether a process runs; one that has ended and was not asked for does not."""
    try:
        with open(f"/proc/{pid}/stat") as file:
            return file.read().rpartition(")")[2].split()[0] != "Z"
    except FileNotFoundError:
        return False


def ended(pid):
    """Return whether a process ends within a while."""
    for _ in range(600):
        if not running(pid):
            return True
        time.sleep(0.05)
    return False


def own_pid(then=lambda: None):
    """Yield the number of the process in which this is done, then do something."""
    yield os.getpid()
    yield then()


def test_work_beside_is_done_in_a_copy_that_ends_with_its_context():
    with beside(own_pid(lambda: time.sleep(600))) as found:
        copy = next(found)
        assert copy != os.getpid()
        assert running(copy)
    assert not running(copy)


def test_errors_of_work_beside_are_raised_where_its_results_are_asked_for():
    def failing():
        yield 1
        raise SpecError("what", "where")

    with beside(failing()) as found:
        assert next(found) == 1
        with pytest.raises(SpecError, match="what"):
            next(found)


def test_work_beside_that_dies_is_no_result():
    with beside(own_pid(lambda: os.kill(os.getpid(), signal.SIGKILL))) as found:
        next(found)
        with pytest.raises(EOFError):
            next(found)


def test_a_copy_has_processes_of_its_own():
    """Two that wrote into one pipe would read each other's answers."""
    echo = Worker("-uc", "import os\nwhile input(): print(os.getpid())")

    def asked():
        yield [*echo.ask(b"who", 60.0)]

    (own,) = echo.ask(b"who", 60.0)
    with beside(asked()) as found:
        assert next(found) != [own]
    assert [*echo.ask(b"who", 60.0)] == [own]
    echo.close()


def test_a_copy_ends_with_the_process_that_is_copied():
    code = """
import os, time
from piezo_sym.processes import beside
def work():
    yield os.getpid()
    time.sleep(600)
with beside(work()) as found:
    print(next(found), flush=True)
    time.sleep(600)
"""
    made = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
    copy = int(made.stdout.readline())
    made.kill()
    assert made.stdout.read() == ""  # the copy does not hold the pipe
    made.wait()
    made.stdout.close()
    assert ended(copy)


def test_a_program_whose_reading_dies_is_open(monkeypatch):
    monkeypatch.setattr(process, "FEWEST_BESIDE", 1)
    monkeypatch.setattr(os, "cpu_count", lambda: 2)
    monkeypatch.setattr(examine, "program_row", lambda *_: os.kill(os.getpid(), signal.SIGKILL))
    *first, last = answer(Request(load("piezo_stack"), 60.0))
    assert last == ENDED
    monkeypatch.setattr(process, "messages", lambda *_: iter((*first, last)))
    rows = {row.id: row for row in examined(load("piezo_stack")).rows}
    assert rows["program"].verdict is Verdict.OPEN
    assert ENDED.reason in rows["program"].reason
    assert rows["passive"].verdict is Verdict.PROVED  # it was attacked before


def test_texts_come_before_the_verdicts_on_them():
    model = load("oscillator")
    with examining(model) as (texts, verdicts):
        template, report = texts.result(), verdicts.result()
    assert template == template_of(derive(model))
    assert report.rows == examined(model).rows


def test_texts_come_also_where_too_much_would_have_to_be_stated(monkeypatch):
    """They are made in a copy, and can be written as they are."""

    def prover(_):
        raise MemoryError

    monkeypatch.setattr(process, "FEWEST_BESIDE", 1)
    monkeypatch.setattr(os, "cpu_count", lambda: 2)
    monkeypatch.setattr(examine, "Prover", prover)
    first, last = answer(Request(load("oscillator"), 60.0))
    assert first == template_of(derive(load("oscillator")))
    assert last == TOO_LARGE


def test_errors_of_a_report_are_raised_where_it_is_asked_for():
    with examining("no model") as found:
        for asked in found:
            with pytest.raises(AttributeError):
                asked.result()


def test_where_texts_are_not_made_in_time_who_asks_for_them_is_told(monkeypatch):
    monkeypatch.setattr(process, "PATIENCE", 0.01)
    with examining(load("piezo_stack")) as (texts, verdicts):
        assert not verdicts.result().proved
        with pytest.raises(ProofError, match=r"not decided in 0\.01 s"):
            texts.result()


def test_who_is_stopped_leaves_no_examination_behind():
    with suppress(KeyboardInterrupt), examining(load("piezo_stack")):
        while process._examiner().process is None:
            time.sleep(0.01)
        left = process._examiner().process.pid
        raise KeyboardInterrupt
    assert ended(left)
    assert examined(load("oscillator")).proved


def test_two_threads_may_close_a_process():
    """One whose request failed, and one that wants it stopped."""
    slow = Worker("-c", "import time; time.sleep(600)")
    slow.start()
    waiting, process = threading.Event(), slow.process
    wait = process.wait

    def waited(*args, **kwargs):
        waiting.set()
        time.sleep(0.1)
        return wait(*args, **kwargs)

    process.wait = waited
    first = threading.Thread(target=slow.close)
    first.start()
    assert waiting.wait(60)
    slow.close()
    first.join()
    assert slow.process is None
    assert process.poll() is not None


def test_a_watch_that_is_late_itself_does_not_stop_the_next_request(monkeypatch):
    watches = []

    class Late(threading.Timer):
        def start(self):
            watches.append(self)

        def cancel(self):
            """It has begun to run, as it may just when the answer comes."""

    monkeypatch.setattr("piezo_sym.processes.threading.Timer", Late)
    echo = Worker("-uc", "import os\nwhile input(): print(os.getpid())")
    (first,) = echo.ask(b"1", 10.0)
    watches[0].function(*watches[0].args)
    (second,) = echo.ask(b"2", 10.0)
    assert first == second
    watches[1].function(*watches[1].args)
    assert echo.process.poll() is None
    echo.close()
