"""Processes that are started look for modules where this one does, and nowhere else."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from piezo_sym.__main__ import start_examiner
from piezo_sym.modules import module_of
from piezo_sym.spec.source import find

ROOT = Path(__file__).parents[2]
STRETCHED = """
[model]
name = "stretched"
[parameters]
m   = { value = 1.0, unit = "kg" }
k   = { value = 1.0, unit = "N/m" }
q_0 = { value = 1.0, unit = "m" }
d   = { value = 1.0, unit = "N*s/m" }
T_0 = { value = 300.0, unit = "K" }
c   = { value = 2.0, unit = "J/K" }
[domain]
assume = ["d >= 0", "q_0 > 0"]
[elements]
spring = { kind = "spring", between = ["tip", "wall"], stiffness = "k*cosh(q/q_0)", state = "q" }
mass   = { kind = "mass", at = "tip", mass = "m", state = "p" }
damper = { kind = "damper", between = ["tip", "wall"], force = "d*v", heats = "body" }
body   = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
"""


def started(words, folder, **environment):
    """Run Python in a folder, which is not where it looks for modules."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT), **environment}
    command = [sys.executable, "-P", *words]
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)


def test_no_process_runs_files_of_the_working_folder(tmp_path):
    (tmp_path / "stretched.toml").write_text(STRETCHED)
    for name in ("json", "signal", "sympy", "report"):
        (tmp_path / f"{name}.py").write_text(f"open('{name}.ran', 'w')")
    done = started(["-m", "piezo_sym", "show", "stretched.toml"], tmp_path)
    assert [*tmp_path.glob("*.ran")] == []
    assert done.returncode == 0, done.stderr


def test_where_modules_are_looked_for_may_hold_paths(tmp_path):
    """Python passes over them without a word, so they are there."""
    code = (
        "import sys; from pathlib import Path; sys.path.append(Path('.'))\n"
        "from piezo_sym.cli import run; sys.exit(run(['verify', 'oscillator']))"
    )
    done = started(["-c", code], tmp_path)
    assert done.returncode == 0, done.stderr


@pytest.fixture
def starts(monkeypatch):
    """The starts of the process that proves, which are counted and not made."""
    found = []
    monkeypatch.setattr("piezo_sym.verification.process.started", lambda: found.append(True))
    return found


def starts_it(words, starts):
    before = len(starts)
    start_examiner(words)
    return len(starts) > before


def test_a_run_starts_the_process_that_proves_if_its_spec_is_not_known(tmp_path, starts):
    path = tmp_path / "stretched.toml"
    words = ["simulate", "-i", "F=1", str(path), "--duration", "1 s"]
    path.write_text(STRETCHED)
    module_of(path)
    assert not starts_it(words, starts)
    path.write_text(STRETCHED.replace("value = 2.0", "value = 2.5"))
    assert not starts_it(words, starts)
    path.write_text(STRETCHED.replace("k*cosh", "k/2*cosh"))
    assert starts_it(words, starts)


@pytest.mark.parametrize("text", [None, "[model", "\udcff"])
def test_what_cannot_be_read_is_left_to_the_command(text, tmp_path, starts):
    path = tmp_path / "no.toml"
    if text:
        path.write_bytes(text.encode(errors="surrogateescape"))
    assert not starts_it(["simulate", str(path)], starts)


def test_a_pipe_is_left_to_the_command(tmp_path, starts):
    """It can be read once."""
    os.mkfifo(tmp_path / "pipe.toml")
    assert not starts_it(["simulate", str(tmp_path / "pipe.toml")], starts)


def test_a_shipped_spec_is_known_by_its_path(starts):
    assert not starts_it(["simulate", str(find("oscillator"))], starts)


@pytest.mark.long  # where the signal falls is chance
def test_a_command_that_is_stopped_before_it_begins_says_nothing_of_python(tmp_path):
    (tmp_path / "new.toml").write_text(STRETCHED.replace("k*cosh", "k/3*cosh"))
    words = [sys.executable, "-m", "piezo_sym", "verify", "new.toml"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    with subprocess.Popen(words, cwd=tmp_path, env=environment, **pipes) as command:
        time.sleep(0.25)
        command.send_signal(signal.SIGTERM)
        _, said = command.communicate()
    assert "Traceback" not in said
    # of text that is executed, as dataclasses do, Python itself ends by the signal
    assert command.returncode in (130, -signal.SIGINT, -signal.SIGTERM)


def test_a_command_without_a_stdout_has_its_exit_code():
    words = f"{sys.executable} -P -m piezo_sym kinds spring >&-"
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(words, shell=True, env=environment, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.parametrize(
    ("words", "wanted"),
    [
        (["verify", "oscillator"], True),
        (["generate", "--check"], True),
        (["generate", "--help"], False),
        (["simulate", "oscillator"], False),
        (["show", "oscillator"], False),
        ([], False),
    ],
)
def test_commands_that_prove_start_the_process_at_once(words, wanted, starts):
    assert starts_it(words, starts) == wanted
