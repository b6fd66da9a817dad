"""What the README says can be done: its spec, its commands and its Python, run as they stand."""

import re
import shlex
from pathlib import Path

import numpy as np
import pytest

from piezo_sym.spec.elements import KINDS

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
MOST_LINES = 128  # two screens


def blocks(language):
    return re.findall(rf"```{language}\n(.*?)```", README, re.DOTALL)


def commands():
    lines = [line for block in blocks("sh") for line in block.splitlines()]
    return [line.partition("#")[0].strip() for line in lines if line.startswith("piezo-sym")]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    (tmp_path / "specs").mkdir()
    for path in (tmp_path / "damped_mass.toml", tmp_path / "specs" / "damped_mass.toml"):
        path.write_text(blocks("toml")[0], encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_every_command_works_in_the_order_given(folder, capsys):
    from piezo_sym.cli import run

    found = commands()
    assert len(found) == 8
    for command in found:
        command, _, kept = command.partition(" > ")
        _, *words = shlex.split(command.replace("specs/*.toml", "specs/damped_mass.toml"))
        assert run(words) == 0, command
        printed = capsys.readouterr().out
        if kept:
            (folder / kept).write_text(printed, encoding="utf-8")
    made = {path.name for path in folder.iterdir()}
    assert {"damped_mass.csv", "actuator.toml", "piezo-sym.schema.json"} <= made


def test_the_schema_line_is_that_of_a_new_spec():
    from piezo_sym.spec.load import starter

    first = starter("actuator").splitlines()[0]
    assert f"`{first}`" in README
    (file,) = (command.partition(" > ")[2] for command in commands() if " > " in command)
    assert first.endswith(f"./{file}")


def test_imports_named_in_comments_work():
    found = re.findall(r"#.*(from piezo_sym\S* import \w+)", blocks("python")[0])
    assert found
    for line in found:
        exec(line, {})


def test_the_python_works(folder, monkeypatch):
    monkeypatch.setenv("MPLBACKEND", "agg")
    text, test = blocks("python")
    names = {}
    exec(compile(text, "README.md", "exec"), names)
    exec(compile(test, "README.md", "exec"), names)
    names["test_my_actuator_obeys_both_laws"]()
    assert names["run"].sizes["time"] == 1001
    assert np.abs(names["path"][-1] - 1e-4).max() < 1e-8  # both actuators are where they shall be
    assert folder.exists()


def test_the_refutation_is_what_verify_says(folder, capsys):
    from piezo_sym.cli import run

    spec = folder / "damped_mass.toml"
    spec.write_text(spec.read_text(encoding="utf-8").replace('"d >= 0"', ""), encoding="utf-8")
    assert run(["verify", "damped_mass.toml"]) == 1
    (said,) = blocks("text")
    assert said in capsys.readouterr().out


def test_set_up_is_one_line_each():
    lines = [line for block in blocks("sh") for line in block.splitlines() if ".venv &&" in line]
    assert [line.rsplit(" && ", 1)[1].split(" ")[0] for line in lines] == [
        ".venv/bin/piezo-sym",
        ".venv/bin/pytest",
    ]


def test_the_whole_is_under_two_screens():
    assert len(README.splitlines()) <= MOST_LINES


def test_every_kind_of_element_is_listed():
    listed = README.partition("Element kinds (")[2].partition("Laws are text")[0]
    words = re.findall(r"[a-z_]+", listed.partition("):")[2])
    assert sorted(words) == sorted(KINDS)


def test_pictures_and_links_are_there():
    paths = re.findall(r"\[.*?\]\((.*?)\)", README)
    assert len(paths) > 2
    for path in paths:
        assert (ROOT / path).is_file(), path


def test_every_notebook_is_linked():
    linked = re.findall(r"\((notebooks/[^)]*\.ipynb)\)", README)
    assert linked == sorted(f"notebooks/{path.name}" for path in ROOT.glob("notebooks/*.ipynb"))
