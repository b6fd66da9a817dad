"""Solvers that crash, hang, talk nonsense or are not there: nothing is proved by that."""

import json
import os
import signal
import subprocess
import sys
import threading
import time
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

from piezo_sym import derive, load
from piezo_sym.expressions.parse import parse_condition
from piezo_sym.expressions.tree import Cmp, Num, Sym, names
from piezo_sym.processes import Worker
from piezo_sym.proofs import Verdict, decide, obligations, proofs_json, prove, solvers
from piezo_sym.proofs.query import Query, query
from piezo_sym.proofs.rational import cleared
from piezo_sym.proofs.solvers import Answer, Opinions, Solver, solver

#: Each of them answers rightly from the second process on: the first one leaves a mark.
FIRST_TIME = """
import json, os, sys, time
first = not os.path.exists({mark!r})
open({mark!r}, "a").close()
for line in sys.stdin:
    if first:
        {fault}
    print(json.dumps({{"result": "unsat"}}), flush=True)
"""
FAULTS = {
    "exits": "sys.exit(3)",
    "is killed": "os.kill(os.getpid(), 9)",
    "prints garbage": "print('segmentation fault', flush=True); continue",
    "prints no answer": "print('{}', flush=True); continue",
    "prints a list": "print('[1]', flush=True); continue",
    "prints another word": "print(json.dumps({'result': 'proved'}), flush=True); continue",
    "prints a word in a list": "print(json.dumps({'result': ['unsat']}), flush=True); continue",
    "prints a bad model": 'print(\'{"result": "sat", "model": {"x": "1/0"}}\', flush=True)',
    "prints half a line": 'sys.stdout.write(\'{"result": "unsat"}\'); sys.stdout.flush(); exit()',
    "hangs after half a line": (
        'sys.stdout.write(\'{"result": "unsat"}\'); sys.stdout.flush(); time.sleep(60)'
    ),
    "hangs": "time.sleep(60)",
    "closes its ears": "os.close(0); os.close(1); time.sleep(60)",
}
#: True, as Choi and Lam's form is not negative, and beyond what a solver decides: it has six names,
#: since of Motzkin's form with one more z3 finds a proof once in many runs.
HARD = (
    "x**2*y**2 + y**2*z**2 + z**2*x**2 + w**4 - 4*x*y*z*w"
    " + u**2*(x - w)**2*(y - z)**2 + 0.001*v**2*(u - x)**2*(z - w)**2 >= 0"
)


def claim(text, *given):
    """Return the query whether a claim follows."""
    made = [cleared(parse_condition(part, "test")) for part in (text, *given)]
    order = tuple(dict.fromkeys(name for part in made for name in names(part)))
    return Query(text, order, tuple((part,) for part in made[1:]), made[0])


def decided(asked):
    """Return the row on the mass, M != 0 for M > 0, as some solver decides it."""
    iphs = derive(load("piezo_stack"))
    found = obligations(iphs)
    wanted = next(o for o in found if (o.id, o.element) == ("welldef", "mass"))
    return prove(replace(wanted, rests_on=()), iphs, (), asked)


@pytest.fixture
def made(tmp_path):
    """Make a solver from the fault of its first process; stop it in the end."""
    running = []

    def make(fault, patience=0.7):
        script = tmp_path / "fake.py"
        mark = str(tmp_path / "mark")
        script.write_text(FIRST_TIME.format(mark=mark, fault=fault))
        running.append(Solver("fake", Worker(str(script)), patience))
        return running[-1]

    yield make
    for one in running:
        one.worker.close()


@pytest.mark.some(6)
@pytest.mark.parametrize("fault", FAULTS.values(), ids=FAULTS)
def test_a_faulty_solver_proves_nothing_and_the_next_question_works(made, fault):
    fake = made(fault)
    row = decided(fake)
    assert row.verdict is Verdict.OPEN
    assert "fake stopped, or took more than 0.7 s" in row.reason
    fake.patience = 10
    assert decided(fake).verdict is Verdict.PROVED


@pytest.mark.parametrize("interpreter", ["/nowhere/python", sys.executable])
def test_a_solver_that_is_not_there_proves_nothing(interpreter, monkeypatch):
    monkeypatch.setattr(sys, "executable", interpreter)
    absent = Solver("absent", Worker("/nowhere.py"))
    row = decided(absent)
    assert row.verdict is Verdict.OPEN
    assert "absent stopped" in row.reason
    absent.worker.close()


def test_a_library_that_is_not_installed_is_named(tmp_path):
    """The worker runs, but there is no z3: its import fails as that of any missing library."""
    hidden = tmp_path / "z3.py"
    hidden.write_text("raise ModuleNotFoundError('No module named z3')")
    worker = solver("z3").worker.arguments[1]
    start = f"import sys, runpy; sys.path.insert(0, {str(tmp_path)!r}); sys.argv = ['w', 'z3']; "
    start += f"runpy.run_path({worker!r}, run_name='__main__')"
    asked = Solver("z3", Worker("-c", start))
    assert asked.ask(claim("x**2 >= 0")) == Answer(
        "unknown", reason="z3 failed: ModuleNotFoundError"
    )
    asked.worker.close()


def test_a_query_that_is_none_does_not_end_the_solver():
    class Broken:
        variables = ("x",)
        witness = False

        def text(self):
            return "(assert (> x"

    assert solver("z3").ask(Broken()).result == "unknown"
    assert solver("z3").ask(claim("x**2 >= 0")).result == "unsat"


def test_a_solver_killed_in_the_middle_is_started_again():
    asked = Solver("z3", Worker(*solver("z3").worker.arguments))
    assert asked.ask(claim("x**2 >= 0")).result == "unsat"
    process = asked.worker.process
    killer = threading.Timer(0.5, os.kill, (process.pid, signal.SIGKILL))
    killer.start()
    answer = asked.ask(claim(HARD))
    killer.join()
    assert answer.result == "unknown"
    assert "stopped" in answer.reason
    assert process.returncode == -signal.SIGKILL  # it was waited for
    assert asked.ask(claim("x**2 + 1 >= 0")).result == "unsat"
    process = asked.worker.process
    asked.worker.close()
    assert process.returncode is not None


def test_an_answer_that_was_not_waited_for_is_not_taken_for_the_next(made):
    """Ctrl-C while a solver works: its answer is still on its way when the next question comes."""
    fake = made("time.sleep(1)", patience=10)
    threading.Timer(0.5, signal.raise_signal, (signal.SIGINT,)).start()
    with pytest.raises(KeyboardInterrupt):
        fake.ask(claim("x**2 >= 0"))
    assert fake.worker.process is None
    assert fake.ask(claim("x**2 >= 0")).result == "unsat"


ENDS = """
import sys
from piezo_sym.proofs.solvers import solver
from tests.proofs.test_solvers import HARD, claim
asked = solver("z3")
asked.ask(claim("x**2 >= 0"))
print(asked.worker.process.pid, flush=True)
{last}
"""


def alive(pid):
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    with open(f"/proc/{pid}/stat") as stat:
        return stat.read().rsplit(")", 1)[1].split()[0] != "Z"


def gone(pid, seconds=10):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if not alive(pid):
            return True
        time.sleep(0.05)
    return False


needs_proc = pytest.mark.parametrize(
    ("last", "stop"),
    [
        ("", None),
        ("raise SystemExit(3)", None),
        ("asked.ask(claim(HARD))", signal.SIGINT),
        ("asked.ask(claim(HARD))", signal.SIGKILL),
    ],
    ids=["end", "exit", "Ctrl-C", "kill"],
)


@pytest.mark.some(1)
@needs_proc
def test_no_solver_outlives_who_asked(last, stop):
    asking = subprocess.Popen(
        (sys.executable, "-c", ENDS.format(last=last)),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    pid = int(asking.stdout.readline())
    if stop is not None:
        time.sleep(0.3)
        os.killpg(asking.pid, stop) if stop == signal.SIGINT else asking.send_signal(stop)
    _, said = asking.communicate(timeout=30)
    assert gone(pid)
    assert said.count("Traceback") == (1 if stop == signal.SIGINT else 0)  # none of the worker


@pytest.mark.parametrize("word", ["pi", "xor", "true", "ite", "Int", "e", "root-obj", "let"])
@pytest.mark.parametrize("name", ["z3", "cvc5"])
def test_a_word_of_the_solver_is_a_name_like_others(name, word):
    order = Cmp(">=", Sym(word), Num(Fraction(4)))
    below = Cmp("<", Sym(word), Num(Fraction(3)))
    assert solver(name).ask(query("", (word,), ((order,),), below)).result == "sat"
    assert solver(name).ask(query("", (word,), ((order,), (below,)), below)).result == "unsat"


@pytest.mark.long
def test_work_is_limited():
    answer = solver("z3").ask(claim(HARD))
    assert answer.result == "unknown"
    assert "resource limit" in answer.reason or "took more than 20 s" in answer.reason


def test_the_limit_of_work_is_said():
    """A smaller one, as far as the process goes the same."""
    folder = Path(solvers.__file__).parent
    code = f"import sys; sys.path.insert(0, {str(folder)!r}); import worker; "
    made = Worker("-Ec", f"{code}worker.Z3_LIMIT //= 20; worker.main()", "z3")
    answer = Solver("z3", made).ask(claim(HARD))
    made.close()
    assert answer.result == "unknown"
    assert "resource limit" in answer.reason


@pytest.mark.parametrize("name", ["z3", "cvc5"])
@pytest.mark.parametrize(
    ("text", "given", "result"),
    [
        ("x**2*y >= 0", ["y >= 0"], "unsat"),
        ("x**3*y >= 0", ["y >= 0"], "sat"),
        ("x**2 + y**2 - x*y >= 0", [], "unsat"),
        ("x*x > 2", ["x > 1.41"], "sat"),
    ],
)
def test_the_same_query_has_the_same_answer_twice(name, text, given, result):
    query = replace(claim(text, *given), witness=True)
    first, again = solver(name).ask(query), solver(name).ask(query)
    fresh = Solver(name, Worker(*solver(name).worker.arguments))
    assert first == again == fresh.ask(query)
    fresh.worker.close()
    assert first.result == result
    if name == "z3" and result == "sat":
        assert {*first.model} == {*query.variables}


def test_a_model_is_simple_and_exact():
    asked = replace(claim("x*y >= 0", "x >= 1/3"), witness=True)
    assert solver("z3").ask(asked).model == {"x": Fraction(1), "y": Fraction(-1)}


class Says:
    """A solver that always says the same."""

    def __init__(self, result, reason="", model=None):
        self.answer, self.asked = Answer(result, model or {}, reason), 0

    def ask(self, _):
        self.asked += 1
        return self.answer


KNOWS_NOT = ("unknown", "z3: resource limit")


@pytest.mark.parametrize(
    ("second", "verdict", "reason"),
    [
        (("unsat",), Verdict.PROVED, ""),
        (("unknown", "cvc5: timeout"), Verdict.OPEN, "z3: resource limit; cvc5: timeout"),
        (("sat",), Verdict.OPEN, "z3: resource limit; a second solver says sat, without a model"),
    ],
)
def test_a_second_opinion_counts_only_as_a_proof(second, verdict, reason):
    row = decided(Opinions(Says(*KNOWS_NOT), Says(*second)))
    assert row.verdict is verdict
    assert row.reason.endswith(reason)


@pytest.mark.parametrize("first", ["sat", "unsat"])
def test_who_knows_asks_nobody_else(first):
    second = Says("unsat")
    model = {"d": Fraction(-1), "v": Fraction(1)}
    assert Opinions(Says(first, model=model), second).ask(claim("d*v*v >= 0")).result == first
    assert second.asked == 0


def test_verify_asks_cvc5_where_z3_does_not_know(monkeypatch):
    """With a z3 that knows nothing, the actuator is proved by cvc5 alone, as far as it goes."""
    mute = Says(*KNOWS_NOT)
    real = solver("cvc5", solvers.LESS_PATIENCE)
    monkeypatch.setattr(solvers, "solver", lambda name, *_: mute if name == "z3" else real)
    rows = decide(derive(load("piezo_stack"))).rows
    assert {row.verdict for row in rows} == {Verdict.PROVED}
    assert mute.asked > 10


def test_without_cvc5_z3_is_asked_alone(monkeypatch):
    monkeypatch.setitem(sys.modules, "cvc5", None)
    assert solvers.opinions() is solver("z3")


def test_a_report_does_not_depend_on_the_process():
    first = decide(derive(load("piezo_stack")))
    solver("z3").worker.close()
    second = decide(derive(load("piezo_stack")))
    model = load("piezo_stack")
    assert json.loads(proofs_json(first, model, "")) == json.loads(proofs_json(second, model, ""))


def test_a_solver_that_never_ends_its_line_is_stopped():
    endless = "import os\nwhile True: os.write(1, b'no end ' * 100)"
    talker = Solver("talker", Worker("-c", endless), patience=1.0)
    started = time.monotonic()
    assert (
        talker.ask(Query("never", (), (), Cmp("<", Num(Fraction(1)), Num(Fraction(0))))).result
        == "unknown"
    )
    assert time.monotonic() - started < 60
