"""What is proved is kept: the same spec is not proved again, and nothing else is taken for it."""

import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from piezo_sym import Model, ProofError, generate, simulate
from piezo_sym.build import render, report_and_files
from piezo_sym.cli import run
from piezo_sym.report import Report, Verdict
from piezo_sym.spec.load import parse
from piezo_sym.verification import process
from piezo_sym.verification.protocol import Progress

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
    report, files = report_and_files(model)
    again, same = report_and_files(model)
    assert len(asked) == 1
    assert (rows(again), same) == (rows(report), files)
    assert [row.certificate for row in again.rows] == [row.certificate for row in report.rows]
    assert (again.model, again.system) == (report.model, report.system)
    generate(model, tmp_path)
    simulate(model, duration=1e-4)
    assert len(asked) == 1


def test_a_run_proves_for_verify_too(model, asked):
    simulate(model, duration=1e-4)
    assert report_and_files(model)[0].proved
    assert len(asked) == 1


def test_a_refuted_model_is_not_examined_again(spec, asked, tmp_path):
    spec["elements"]["damper"]["force"] = "-d*v"
    model = Model(**spec)
    report, files = report_and_files(model)
    again, same = report_and_files(model)
    assert len(asked) == 1
    assert (rows(again), same.keys() < files.keys()) == (rows(report), True)
    assert all(files[name] == text for name, text in same.items())
    for refused in (lambda: generate(model, tmp_path), lambda: simulate(model, duration=1e-4)):
        with pytest.raises(ProofError, match="passive is REFUTED"):
            refused()
    assert len(asked) == 1
    assert f"{model.name}/{model.name}.py" in render(model, allow_unproved=True)


def test_another_value_or_law_is_report_and_files(spec, asked):
    report_and_files(Model(**spec))
    spec["parameters"]["M"]["value"] *= 2
    report_and_files(Model(**spec))
    spec["elements"]["damper"]["force"] = "-d*v"
    assert not report_and_files(Model(**spec))[0].proved
    assert len(asked) == 3


def test_what_is_open_is_not_kept(unproved, asked, monkeypatch):
    monkeypatch.setattr(Report, "refuted", False)
    assert rows(report_and_files(unproved)[0]) == rows(report_and_files(unproved)[0])
    assert len(asked) == 2


def kept_by_force(model, monkeypatch):
    """Keep what is not proved."""
    with monkeypatch.context() as patch:
        patch.setattr(Report, "proved", True)
        patch.setattr(Report, "decided", True)
        patch.setattr(Report, "refuted", False)
        report_and_files(model)


@pytest.mark.parametrize("damage", [lambda text: text.replace("OPEN", "PROVED"), lambda _: ""])
def test_what_was_changed_in_the_cache_is_not_believed(unproved, cache, asked, damage, monkeypatch):
    kept_by_force(unproved, monkeypatch)
    (path,) = cache.rglob("*-proved/record.json")
    path.write_text(damage(path.read_text(encoding="utf-8")), encoding="utf-8")
    before = len(asked)
    assert not report_and_files(unproved)[0].proved
    assert len(asked) == before + 1


def test_a_record_is_that_of_its_folder_alone(model, unproved, cache, monkeypatch):
    report_and_files(model)
    kept_by_force(unproved, monkeypatch)
    good, bad = (
        next(path for path in cache.rglob("*-proved/record.json") if one.key in path.parent.name)
        for one in (model, unproved)
    )
    bad.write_bytes(good.read_bytes())
    assert not report_and_files(unproved)[0].proved


LINKED = """
[model]
name = "linked"
[parameters]
R = { value = 1.0, unit = "ohm" }
C = { value = 4.0, unit = "F" }
T_0 = { value = 300.0, unit = "K" }
c = { value = 2.0, unit = "J/K" }
[initial]
q = 1.0
[domain]
assume = ["R >= 0"]
[elements]
cap = { kind = "capacitor", between = ["a", "gnd"], capacitance = "C", state = "q" }
res = { kind = "resistor", between = ["a", "b"], voltage = "R*i", heats = "body" }
link = { kind = "resistor", between = ["b", "gnd"], current = "0", heats = "body" }
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
"""


def test_an_open_link_is_not_a_closed_one():
    """With the link closed, R = 0 leaves the charge without a value."""
    opened, closed = (parse(LINKED.replace("current =", law)) for law in ("current =", "voltage ="))
    assert opened.sha256 != closed.sha256
    assert report_and_files(opened)[0].proved
    assert not report_and_files(closed)[0].proved


TEXTS = (
    ('name = "linked"', 'name = "linked"\ntitle = "0"'),
    ('unit = "ohm" }', 'unit = "ohm", doc = "0" }'),
)


@pytest.mark.parametrize(("old", "new"), TEXTS)
def test_models_are_the_same_only_if_their_files_are(old, new):
    one, other = parse(LINKED), parse(LINKED.replace(old, new))
    assert one.sha256 != other.sha256
    assert one.key != other.key


def test_a_zero_that_is_said_may_be_refused():
    """Of joined stores, that is, so the very same model alone is known as proved."""
    one, other = parse(LINKED), parse(LINKED.replace("q = 1.0", "q = 1.0\nS = 0.0"))
    assert one.sha256 == other.sha256
    assert one.key != other.key


def test_zeros_of_both_signs_are_the_same():
    one, other = (parse(LINKED.replace("q = 1.0", f"q = {zero}")) for zero in ("0.0", "-0.0"))
    assert (one.key, one.sha256) == (other.key, other.sha256)


def test_a_row_that_is_open_for_want_of_time_is_not_kept(model, asked, monkeypatch):
    messages = process.messages

    def late(worker, request):
        for message in messages(worker, request):
            if isinstance(message, Progress):
                rows = {n: row for n, row in message.rows.items() if row.id != "odd"}
                message = replace(message, rows=rows)
            yield message

    with monkeypatch.context() as patch:
        patch.setattr(process, "messages", late)
        report, _ = report_and_files(model)
        assert report.proved
        assert {row.verdict for row in report.rows if row.id == "odd"} == {Verdict.OPEN}
    report, _ = report_and_files(model)
    assert len(asked) == 2
    assert {row.verdict for row in report.rows if row.id == "odd"} == {Verdict.PROVED}


def test_what_other_sources_have_proved_is_not_kept(model, asked, monkeypatch):
    """The process may have begun after an edit of the package."""
    messages = process.messages

    def others(worker, request):
        for message in messages(worker, request):
            known = isinstance(message, Report)
            yield replace(message, sources="of others") if known else message

    with monkeypatch.context() as patch:
        patch.setattr(process, "messages", others)
        assert report_and_files(model)[0].proved
    report_and_files(model)
    assert len(asked) == 2


@pytest.mark.long
def test_a_package_in_the_working_folder_is_not_that_of_the_process(tmp_path):
    (tmp_path / "piezo_sym").mkdir()
    (tmp_path / "piezo_sym" / "__init__.py").write_text("raise SystemExit('not this one')")
    code = "from piezo_sym.cli import run; raise SystemExit(run(['verify', 'oscillator']))"
    words = [sys.executable, "-P", "-c", code]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(words, cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_a_copy_with_other_tables_is_another_model(model):
    domain = model.domain.model_copy(update={"assume": ()})
    copy = model.model_copy(update={"domain": domain})
    assert copy.key != model.key
    assert copy.flatten().domain.assume == ()


def test_the_cache_may_be_read_only(model, cache):
    cache.parent.mkdir()
    cache.write_text("no folder")
    assert render(model)


def test_commands_ask_no_process_for_what_is_known(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert run(["verify", "oscillator"]) == 0
    first = capsys.readouterr().out
    code = """
import sys
from piezo_sym.cli import run
from piezo_sym.verification import process
process.messages = None
assert run(["verify", "oscillator"]) == 0
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
