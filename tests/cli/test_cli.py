"""The command line: exit codes, and one line for an error."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

import piezo_sym

ROOT = Path(__file__).parents[2]
COMMANDS = ["new", "verify", "generate", "show", "simulate", "reproduce", "schema"]


def test_version(call):
    assert call("--version") == (0, f"{piezo_sym.__version__}\n", "")


def test_help_lists_every_command(call):
    answer = call("--help")
    assert answer.code == 0
    assert [word for word in COMMANDS if f"\n  {word} " in answer.out] == COMMANDS


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_help(call, command):
    answer = call(command, "--help")
    assert (answer.code, answer.err) == (0, "")
    assert answer.out.startswith(f"Usage: piezo-sym {command} ")


WRONG = [
    ((), "Missing command; see `piezo-sym --help`"),
    (("nonsense",), "No such command 'nonsense'; see `piezo-sym --help`"),
    (("--nonsense",), "No such option: --nonsense; see `piezo-sym --help`"),
    (("verify",), "Missing argument 'SPEC...'; see `piezo-sym verify --help`"),
    (("show",), "Missing argument 'SPEC'; see `piezo-sym show --help`"),
    (("verify", "piezo_stack", "--jsom"), "No such option: --jsom"),
    (("simulate", "piezo_stack"), "Missing option '--duration'"),
    (("simulate", "piezo_stack", "--duration", "long"), "--duration: 'long' is no number"),
    (("verify", "piezo_stak"), "no shipped spec is called 'piezo_stak'; did you mean"),
    (("verify", "/no/such.toml"), "'/no/such.toml': cannot be read (No such file or directory)"),
    (("show", "/no/such.toml"), "'/no/such.toml': cannot be read"),
    (("generate", "/no/such.toml"), "'/no/such.toml': cannot be read"),
    (("simulate", "/no/such.toml", "--duration", "1"), "'/no/such.toml': cannot be read"),
    (("show", "two\nlines.toml"), "'two\\nlines.toml': cannot be read"),
]


@pytest.mark.parametrize(("words", "message"), WRONG)
def test_a_wrong_command_is_one_line_and_exit_code_2(refused, words, message):
    assert refused(*words).startswith(message)


@pytest.mark.parametrize("command", ["verify", "show", "generate"])
def test_a_wrong_spec_is_one_line_and_exit_code_2(refused, spec_file, command):
    message = refused(command, spec_file('stiffness = "k"', 'stiffness = "kk"'))
    assert message.startswith("mine.toml: elements.spring.stiffness: unknown name 'kk'")


@pytest.mark.parametrize("command", ["verify", "show", "generate"])
def test_a_wrong_network_is_one_line_and_exit_code_2(refused, spec_file, command):
    assert "cap" in refused(command, spec_file('["cap", "gnd"]', '["caq", "gnd"]'))


def test_a_stop_by_the_user_is_no_traceback(call, monkeypatch):
    def stops(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("piezo_sym.derivation.derive", stops)
    answer = call("show", "piezo_stack")
    assert answer.code == 130
    assert answer.err.strip("\n") == "piezo-sym: stopped"


def test_too_little_memory_is_one_line(refused, monkeypatch):
    def fails(*_, **__):
        raise MemoryError

    monkeypatch.setattr("piezo_sym.api.simulate", fails)
    assert refused("simulate", "piezo_stack", "--duration", 1).startswith("out of memory")


def test_the_package_runs_as_a_program(tmp_path):
    words = [sys.executable, "-W", "error", "-m", "piezo_sym", "verify", "oscillator", "--json"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        words, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert {row["verdict"] for row in json.loads(done.stdout)} == {"PROVED"}


def test_the_program_leaves_with_its_exit_code(tmp_path):
    generate = ["generate", "oscillator", "--check", "--out", "none"]
    words = [sys.executable, "-m", "piezo_sym", *generate]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        words, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 1
    first = "oscillator"
    assert done.stderr.startswith(f"piezo-sym: 'none/{first}/{first}.py': is missing")
