"""What is proved is kept: the same spec is not proved again, and nothing else is taken for it."""

import subprocess
import sys
from pathlib import Path

import pytest

from piezo_sym import Model, generate, simulate
from piezo_sym.build import examined, render
from piezo_sym.cli import run
from piezo_sym.report import Report
from piezo_sym.verification import process

pytestmark = pytest.mark.usefixtures("cache")
ROOT = Path(__file__).parents[2]
KEPT = ("id", "element", "statement", "verdict", "witness", "reason", "required", "points")


@pytest.fixture
def asked(monkeypatch):
    """The requests to the process that examines systems."""
    found, messages = [], process.messages

    def seen(worker, request):
        found.append(request)
        return messages(worker, request)

    monkeypatch.setattr(process, "messages", seen)
    return found


def rows(report):
    return [[getattr(row, name) for name in KEPT] for row in report.rows]


def test_the_same_spec_is_not_proved_again_and_all_is_as_before(model, asked, tmp_path):
    report, files = examined(model)
    again, same = examined(model)
    assert len(asked) == 1
    assert (rows(again), same) == (rows(report), files)
    assert [row.certificate for row in again.rows] == [row.certificate for row in report.rows]
    assert (again.model, again.system) == (report.model, report.system)
    generate(model, tmp_path)
    simulate(model, duration=1e-4)
    assert len(asked) == 1


def test_a_run_proves_for_verify_too(model, asked):
    simulate(model, duration=1e-4)
    assert examined(model)[0].proved
    assert len(asked) == 1


def test_another_value_or_law_is_examined(spec, asked):
    examined(Model(**spec))
    spec["parameters"]["M"]["value"] *= 2
    examined(Model(**spec))
    spec["elements"]["damper"]["force"] = "-d*v"
    assert not examined(Model(**spec))[0].proved
    assert len(asked) == 3


def test_what_is_not_proved_is_not_kept(unproved, asked):
    assert rows(examined(unproved)[0]) == rows(examined(unproved)[0])
    assert len(asked) == 2


@pytest.mark.parametrize("damage", [lambda text: text.replace("OPEN", "PROVED"), lambda _: ""])
def test_what_was_changed_in_the_cache_is_not_believed(unproved, cache, asked, damage, monkeypatch):
    """A record of something that is not proved is forged here, and then edited by hand."""
    report = Report(unproved.name, (*examined(unproved)[0].rows,))
    with monkeypatch.context() as patch:
        patch.setattr(type(report), "proved", True)
        examined(unproved)
    (path,) = cache.rglob("*-proved/record.json")
    path.write_text(damage(path.read_text(encoding="utf-8")), encoding="utf-8")
    before = len(asked)
    assert not examined(unproved)[0].proved
    assert len(asked) == before + 1


def test_the_cache_may_be_read_only(model, cache):
    cache.parent.mkdir()
    cache.write_text("no folder")
    assert render(model)


def test_commands_start_no_process_for_what_is_known(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert run(["verify", "oscillator"]) == 0
    first = capsys.readouterr().out
    code = """
import sys
from piezo_sym.cli import run
from piezo_sym.verification import process
process.messages = None
assert run(["verify", "oscillator"]) == 0
assert process._examiner().process is None
sys.exit(run(["generate", "oscillator"]))
"""
    words = [sys.executable, "-c", code]
    done = subprocess.run(words, capture_output=True, text=True, check=True)
    assert done.stdout.startswith(first)
    committed = ROOT / "generated" / "oscillator"
    assert all(
        path.read_bytes() == (committed / path.name).read_bytes()
        for path in (tmp_path / "generated" / "oscillator").iterdir()
    )
