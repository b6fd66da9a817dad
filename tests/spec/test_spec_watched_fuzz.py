"""Hostile and damaged texts by the thousand, while the interpreter reports what it does."""

import json
import subprocess
import sys
from pathlib import Path

import fuzz_watched
import pytest
from fuzz_texts import law_texts, spec_texts

from piezo_sym import PiezoError
from piezo_sym.errors import SpecError
from piezo_sym.expressions.parse import parse_law
from piezo_sym.expressions.tree import Expr
from piezo_sym.spec.load import parse

HERE = Path(__file__).parent
ROOT = HERE.parents[1]


def run(folder, *words, limit=600):
    command = [sys.executable, str(HERE / "fuzz_watched.py"), *map(str, words)]
    path = {"PYTHONPATH": str(ROOT), "PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run(
        command, cwd=folder, env=path, capture_output=True, text=True, timeout=limit, check=True
    )
    assert done.stderr == ""
    assert list(folder.iterdir()) == []
    return json.loads(done.stdout)


@pytest.mark.long
def test_two_thousand_texts(tmp_path):
    found = run(tmp_path, 1, 1500, 500)
    assert found["faults"] == []
    assert found["count"] == 2000


@pytest.mark.long
@pytest.mark.parametrize("seed", range(2, 6))
def test_a_hundred_thousand_texts(tmp_path, seed):
    found = run(tmp_path, seed, 20_000, 5_000)
    assert found["faults"] == []
    assert found["count"] == 25_000


def accepted(read, texts):
    good = 0
    for text in texts:
        try:
            read(text)
        except PiezoError:
            continue
        good += 1
    return good / len(texts)


def test_the_texts_are_neither_all_good_nor_all_bad():
    """What is always refused at the first check shows nothing about the later ones."""
    assert 0.1 < accepted(lambda text: parse_law(text, "law"), list(law_texts(1, 1000))) < 0.9
    assert 0.1 < accepted(parse, list(spec_texts(1, 500))) < 0.9


def opens(text):
    with Path(text).open("w"):
        return Expr


FAULTY = {
    "runs a command": (lambda _: __import__("os").system("true"), "os.system"),
    "starts a process": (lambda _: subprocess.run("true", check=True), "subprocess.Popen"),
    "evaluates": (eval, "exec"),
    "imports": (lambda _: __import__("this_module_is_not_there"), "import"),
    "writes": (opens, "open"),
}


@pytest.mark.some(1)
@pytest.mark.parametrize(("read", "event"), FAULTY.values(), ids=FAULTY)
def test_what_a_text_may_not_do_is_seen(read, event, tmp_path):
    """The watch itself works: each forbidden deed is noted, in a process of its own."""
    program = tmp_path / "canary.py"
    name = next(name for name, (found, _) in FAULTY.items() if found is read)
    program.write_text(
        "import sys, fuzz_watched as w, test_spec_watched_fuzz as t\n"
        "sys.addaudithook(w.watch)\n"
        f"w.fault(t.FAULTY[{name!r}][0], sys.argv[1], object)\n"
        "print(w.events)\n"
    )
    path = {"PYTHONPATH": f"{HERE}:{ROOT}", "PATH": "/usr/bin:/bin"}
    words = [sys.executable, str(program), str(tmp_path / "x") if event == "open" else "1"]
    done = subprocess.run(words, env=path, capture_output=True, text=True, check=True)
    assert event in done.stdout


@pytest.mark.parametrize(
    ("error", "said"),
    [
        (SpecError("what", "where", "more"), ""),
        (SpecError("what", "", "more"), "message"),
        (SpecError("x" * 900, "where"), "message"),
        (RuntimeError("odd"), "RuntimeError: odd"),
        (RecursionError("deep"), "RecursionError: deep"),
    ],
)
def test_a_bad_answer_is_seen(error, said):
    def read(_):
        raise error

    assert fuzz_watched.fault(read, "", object).startswith(said)
    assert fuzz_watched.fault(lambda _: 1, "", Expr) == "gave int"
