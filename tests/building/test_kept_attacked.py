"""What is kept, after an accident or an edit: never taken for another's, never in the way."""

import os
import pwd
import shutil
import subprocess
import sys
import warnings
from dataclasses import replace
from pathlib import Path

import pytest

from piezo_sym import Model, generate, simulate
from piezo_sym.cli import run
from piezo_sym.report import Report
from piezo_sym.verification import process
from piezo_sym.verification.protocol import Progress
from tests.building.test_started import STRETCHED

pytestmark = pytest.mark.usefixtures("cache")
ROOT = Path(__file__).parents[2]
#: Of joined springs, one of which is drawn where its state is 0, where nothing is said.
DRAWN = (
    STRETCHED.replace('["d >= 0"', '["d >= 0", "k > 0"')
    .replace('"tip", "wall"], stiffness = "k*cosh(q/q_0)"', '"tip", "middle"], stiffness = "k"')
    .replace(
        "damper =",
        'drawn  = { kind = "spring", between = ["middle", "wall"], force = "k*(q - q_0)", '
        'state = "r" }\ndamper =',
    )
)


@pytest.fixture(autouse=True)
def _work(tmp_path, monkeypatch):
    """A working folder without modules."""
    (tmp_path / "work").mkdir()
    monkeypatch.chdir(tmp_path / "work")


def changed_session(code, **environment):
    """Run Python with a package that it may change, or otherwise unlike this process."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT), **environment}
    words = [sys.executable, "-P", "-c", code]
    done = subprocess.run(words, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_editors_may_have_files_among_the_sources(monkeypatch, tmp_path):
    """Emacs locks by a link, `.#laws.py`, as long as an edit is not saved."""
    from piezo_sym import version

    (tmp_path / "laws.py").touch()
    monkeypatch.setattr(version, "PACKAGE", tmp_path)
    before = version.sources_hash()
    (tmp_path / ".#laws.py").symlink_to("someone@somewhere.1:2")
    (tmp_path / "folder.py").mkdir()
    assert version.sources_hash() == before
    (tmp_path / "other.py").touch()
    assert version.sources_hash() != before


def test_what_is_proved_after_an_edit_of_the_package_is_not_kept(tmp_path, cache):
    """The process runs the old text, and the hash is that of the new one."""
    folder = tmp_path / "piezo_sym"
    shutil.copytree(ROOT / "piezo_sym", folder)  # with what Python has compiled
    code = """
import piezo_sym.report
with open(piezo_sym.report.__file__, "a") as file:
    file.write("# edited")
from piezo_sym import generate, load
from piezo_sym.modules import module_of
generate(load("oscillator"))
assert module_of("oscillator").NAME == "oscillator"
"""
    changed_session(code, PYTHONPATH=str(tmp_path))
    assert [*cache.rglob("modules/*/*")] == []


@pytest.mark.long
@pytest.mark.parametrize("name", ["HOME", "XDG_CACHE_HOME"])
def test_a_cache_is_never_in_the_working_folder(name):
    code = "import sys; from piezo_sym.cli import run; sys.exit(run(['verify', 'oscillator']))"
    changed_session(code, **{"XDG_CACHE_HOME": "", name: "relative"})
    assert [*Path().iterdir()] == []


@pytest.mark.long
def test_a_proof_is_a_proof_for_python_without_docstrings():
    code = """
from piezo_sym import simulate
print(simulate("oscillator", duration=1e-4, times=2).attrs["proofs"])
"""
    assert changed_session(code, PYTHONOPTIMIZE="2").endswith("program PROVED\n")


def test_a_user_may_have_no_home(monkeypatch):
    def unknown(user):
        raise KeyError(user)

    monkeypatch.delenv("HOME")
    monkeypatch.delenv("XDG_CACHE_HOME")
    monkeypatch.setattr(pwd, "getpwuid", unknown)
    assert run(["verify", "oscillator"]) == 0


def test_a_module_that_other_sources_have_proved_is_not_kept(spec, cache, monkeypatch):
    spec["parameters"]["M"]["value"] *= 2  # not the one that comes with the package
    messages = process.messages

    def others(worker, request):
        for message in messages(worker, request):
            known = isinstance(message, Report)
            yield replace(message, sources="of others") if known else message

    monkeypatch.setattr(process, "messages", others)
    simulate(Model(**spec), duration=1e-4)
    assert [*cache.rglob("modules/*/*.py")] == []


def test_a_late_row_is_proved_for_runs_too(spec, monkeypatch):
    spec["parameters"]["M"]["value"] *= 2  # not the one that comes with the package
    model = Model(**spec)
    messages = process.messages

    def late(worker, request):
        for message in messages(worker, request):
            if isinstance(message, Progress):
                rows = {n: row for n, row in message.rows.items() if row.id != "odd"}
                message = replace(message, rows=rows)
            yield message

    with monkeypatch.context() as patch:
        patch.setattr(process, "messages", late)
        simulate(model, duration=1e-4)
    generate(model)
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # "is not what the spec generates"
        simulate(model, duration=1e-4)


WRONG = (
    (STRETCHED, 'state = "q" }', 'state = "q", count = 0 }'),
    (STRETCHED, "[domain]", "[initial]\nz = 0.0\n[domain]"),
    (STRETCHED, "[domain]", "[initial]\nS = false\n[domain]"),
    (STRETCHED, "[domain]", "[domain]\nasume = []"),
    (STRETCHED.replace("[parameters]", 'title = "nan"\n[parameters]'), '"nan"', "nan"),
    (DRAWN, "[domain]", "[initial]\nq = 0.0\n[domain]"),
)


@pytest.mark.some(2)
@pytest.mark.parametrize(("good", "old", "new"), WRONG)
def test_a_wrong_spec_is_refused_whatever_is_kept(good, old, new, capsys):
    path, words = Path("stretched.toml"), ["simulate", "stretched.toml", "--duration", "0.01"]
    wrong = good.replace(old, new)
    for text, code in ((wrong, 2), (good, 0), (wrong, 2), (good.replace("300.0", "310.0"), 0)):
        path.write_text(text)
        assert run(words) == code, capsys.readouterr().err
    path.write_text(wrong.replace("300.0", "310.0"))
    assert run(words) == 2


@pytest.mark.parametrize("ending", [".py", "_step.c"])
@pytest.mark.parametrize("damage", [Path.unlink, lambda path: path.write_text("NAME = 1")])
def test_a_module_of_which_a_file_is_damaged_is_mended(ending, damage, cache):
    path = Path("stretched.toml")
    path.write_text(STRETCHED)
    simulate(path, duration=0.01)
    (file,) = cache.rglob(f"stretched{ending}")
    before = file.read_bytes()
    damage(file)
    assert simulate(path, duration=0.01).attrs["method"] == "discrete_gradient"
    assert file.read_bytes() == before


def test_a_spec_from_a_pipe_is_simulated():
    text = (ROOT / "piezo_sym" / "models" / "oscillator.toml").read_text()
    text = text.replace('"oscillator"', '"mine"')
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    words = [sys.executable, "-P", "-m", "piezo_sym", "simulate", "/dev/stdin", "--duration", "0.1"]
    done = subprocess.run(words, env=environment, input=text, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


@pytest.mark.long
def test_a_spec_from_a_pipe_is_rechecked(tmp_path):
    pytest.importorskip("cvc5")
    command = f"cat {ROOT}/piezo_sym/models/oscillator.toml | {sys.executable} -P -m piezo_sym"
    words = ["sh", "-c", f"{command} verify --recheck /dev/stdin"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(words, cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
