"""``piezo-sym new`` and ``piezo-sym schema``: a spec to start from, and what an editor checks."""

import json
import os
import re
import shlex
import tomllib
from pathlib import Path

import pytest

from piezo_sym import load
from piezo_sym.spec.schema import schema
from tests.conftest import full_disk


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    return tmp_path


def files(folder):
    return sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*.*"))


def test_the_commands_it_prints_work(call, folder):
    answer = call("new", "actuator")
    path, *commands = answer.out.splitlines()
    assert (answer.code, answer.err, path) == (0, "", "actuator.toml")
    assert files(folder) == ["here/actuator.toml"]
    assert [shlex.split(command)[1] for command in commands] == ["verify", "simulate"]
    for command in commands:
        done = call(*shlex.split(command)[1:])
        assert done.code == 0, command
        assert "rounding" not in done.out


def test_its_module_is_generated_and_has_no_drift(call):
    call("new", "actuator")
    assert call("generate", "actuator.toml").code == 0
    assert call("generate", "--check", "--all", "actuator.toml").code == 0


def test_the_supply_moves_it_as_it_stands(call, folder):
    call("new", "actuator")
    assert call("simulate", "actuator.toml", "--duration", 0.1, "--out", "run.csv").code == 0
    names, *_, last = (folder / "here" / "run.csv").read_text(encoding="utf-8").splitlines()
    end = dict(zip(names.split(","), last.split(","), strict=True))
    assert float(end["q [m]"]) == pytest.approx(5.0 * 100 / 2e7, rel=1e-3)  # a*V_in = k*q at rest
    assert float(end["Q [C]"]) == pytest.approx(2e-6 * 100, rel=1e-3)


def test_it_has_the_name_and_nothing_else_of_the_starter(call):
    call("new", "Axis_2")
    assert load("Axis_2.toml").name == "Axis_2"
    text = Path("Axis_2.toml").read_text(encoding="utf-8")
    assert "starter" not in text
    assert len(text.splitlines()) <= 75
    assert max(map(len, text.splitlines())) <= 100


def test_the_line_to_change_first_can_be_changed(call):
    call("new", "actuator")
    text = Path("actuator.toml").read_text(encoding="utf-8")
    (line,) = [line for line in text.splitlines() if "change this first" in line]
    changed = line.replace("2e7", "1e7")
    assert changed != line
    Path("actuator.toml").write_text(text.replace(line, changed), encoding="utf-8")
    assert load("actuator.toml").parameters["k"].value == 1e7
    assert call("verify", "actuator.toml").code == 0


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("../actuator", "NAME: '../actuator' is not a name; expected a letter, then letters"),
        ("/tmp/actuator", "NAME: '/tmp/actuator' is not a name"),
        ("here/actuator", "NAME: 'here/actuator' is not a name"),
        ("actuator.toml", "NAME: 'actuator.toml' is not a name"),
        ('a"\nb', "NAME: 'a\"\\nb' is not a name"),
        ("", "NAME: '' is not a name"),
        ("x" * 41, "NAME: 'xxx"),
        ("con", "NAME: 'con' is a device on some systems"),
        ("lambda", "NAME: 'lambda' is a word of Python's"),
        ("numpy", "NAME: 'numpy' is a word of Python's that the module would hide; call it 'numpy"),
        ("piezo_stack", "NAME: 'piezo_stack' is the name of a shipped spec; call it 'my_piezo_s"),
        ("Piezo_Stack", "NAME: 'Piezo_Stack' is the name of a shipped spec"),
    ],
)
def test_a_bad_name_is_one_line_and_no_file(refused, folder, name, message):
    assert refused("new", name).startswith(message)
    assert files(folder) == []


def test_no_name_is_one_line(refused):
    assert refused("new").startswith("Missing argument 'NAME'")


def test_a_file_that_is_there_is_kept(refused, folder):
    path = folder / "here" / "actuator.toml"
    path.write_text("mine", encoding="utf-8")
    assert refused("new", "actuator").startswith("'actuator.toml': is there already; give another")
    assert path.read_text(encoding="utf-8") == "mine"


def test_a_link_that_is_there_is_not_written_through(refused, folder):
    os.symlink(folder / "elsewhere.toml", "actuator.toml")
    assert "is there already" in refused("new", "actuator")
    assert files(folder) == ["here/actuator.toml"]
    assert not (folder / "elsewhere.toml").exists()


def test_a_full_disk_is_one_line(refused, folder):
    with full_disk():
        message = refused("new", "actuator")
    assert message.startswith("'actuator.toml': cannot be written (File too large")
    assert files(folder) == []


def test_the_schema_is_printed(call):
    answer = call("schema")
    assert (answer.code, answer.err) == (0, "")
    assert json.loads(answer.out) == schema()
    assert answer.out.isascii()


def test_the_first_line_tells_an_editor_where_the_schema_is(call):
    """The line is a comment to TOML; its file is the one that the next line says how to make."""
    call("new", "actuator")
    first, second, *_ = Path("actuator.toml").read_text(encoding="utf-8").splitlines()
    (file,) = re.findall(r"^#:schema \./(\S+)$", first)
    assert f"piezo-sym schema > {file}" in second
    assert tomllib.loads(first) == {}
    assert first in " ".join(call("schema", "--help").out.split())
