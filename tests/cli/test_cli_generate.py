"""``piezo-sym generate``: files, and the check that they are up to date."""

import re
import shutil
from pathlib import Path

import pytest

from piezo_sym.codegen import PRINTERS

ROOT = Path(__file__).parents[2]
NAME = "piezo_stack/piezo_stack.py"


@pytest.fixture
def out(tmp_path, monkeypatch):
    """A folder with the modules of all shipped specs, which are two here, as they are written."""
    two = ("oscillator", "piezo_stack")
    monkeypatch.setattr("piezo_sym.build.shipped", lambda: two)
    for name in two:
        shutil.copytree(ROOT / "generated" / name, tmp_path / "out" / name)
    return tmp_path / "out"


@pytest.mark.long
def test_without_a_spec_all_shipped_ones_are_written(call, tmp_path):
    answer = call("generate", "--out", tmp_path)
    assert (answer.code, answer.err) == (0, "")
    made, wanted = (
        {path.relative_to(folder): path.read_bytes() for path in folder.rglob("*.*")}
        for folder in (tmp_path, ROOT / "generated")
    )
    assert made == {path: text for path, text in wanted.items() if path.parent != Path()}
    assert {str(tmp_path / path) for path in made} == {*answer.out.splitlines()}


def test_the_folder_is_generated_if_nothing_is_said(call, spec_file, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    spec_file()
    names = (*(f"mine{ending}" for ending in PRINTERS), "proofs.json", "proofs.smt2")
    said = "".join(f"{Path('generated/mine') / name}\n" for name in names)
    assert call("generate", "mine.toml") == (0, said, "")


def test_files_as_their_specs_give_them_are_up_to_date(call, out):
    answer = call("generate", "--check", "--out", out)
    assert (answer.code, answer.err) == (0, "")
    assert "2 models up to date in " in answer.out


def test_a_drifted_file_is_exit_code_1_with_the_difference(call, out):
    path = out / NAME
    path.write_text(path.read_text().replace("M: float = 0.0035", "M: float = 1.0"))
    answer = call("generate", "--check", "--out", out)
    assert answer.code == 1
    assert "-    M: float = 1.0\n+    M: float = 0.0035\n" in answer.out
    assert answer.err == (
        f"piezo-sym: '{path}': differs from its spec; "
        f"run `piezo-sym generate --out {out}` and commit the result\n"
    )


def test_of_an_edited_value_the_lines_are_printed_and_no_hashes(call, spec_file, tmp_path):
    spec, out = spec_file(), tmp_path / "out"
    call("generate", spec, "--out", out)
    spec.write_text(spec.read_text().replace("3.5e-3", "4.5e-3"))
    answer = call("generate", spec, "--check", "--out", out)
    assert answer.code == 1
    assert "-    M: float = 0.0035\n+    M: float = 0.0045\n" in answer.out
    assert not re.search("[0-9a-f]{64}", answer.out)
    assert answer.out.endswith("commit the result\nthe sha256 of its spec differs\n")


def test_of_a_long_difference_the_first_lines_are_printed(call, out):
    path = out / NAME
    path.write_text(path.read_text().replace(" = ", " := "))
    printed = call("generate", "--check", "--out", out).out.splitlines()
    assert len(printed) == 12
    assert re.fullmatch(r"\.\.\. and \d\d+ more lines of the difference", printed[-1])


def test_a_missing_file_names_the_command_for_the_specs_given(refused, spec_file, tmp_path):
    path = spec_file()
    message = refused("generate", path, "--check", "--out", tmp_path / "none", code=1)
    assert f"run `piezo-sym generate {path} --out {tmp_path / 'none'}`" in message


def test_a_left_over_file_is_exit_code_1(refused, out):
    old = out / "removed" / "removed.py"
    old.parent.mkdir()
    old.write_text((out / NAME).read_text())
    message = refused("generate", "--check", "--out", out, code=1)
    assert (
        message
        == f"'{old}': belongs to no spec given; delete it, or name its spec on the command line"
    )


def test_every_drifted_file_is_named_in_one_line_with_the_remedy(call, out):
    (out / NAME).unlink()
    (out / "notes.txt").write_text("")
    answer = call("generate", "--check", "--all", "--out", out)
    run = f"run `piezo-sym generate --out {out}` and commit the result"
    assert (answer.code, answer.out.splitlines()) == (
        1,
        [
            f"'{out / NAME}' is missing; {run}",
            f"'{out / 'notes.txt'}' belongs to no spec given; "
            "delete it, or name its spec on the command line",
        ],
    )


def test_a_check_of_some_specs_leaves_other_modules_alone(call, spec_file, out):
    assert call("generate", spec_file(), "--out", out).code == 0
    assert call("generate", "piezo_stack", "--check", "--out", out).code == 0


def test_what_is_not_proved_is_exit_code_1(refused, unproved, tmp_path):
    message = refused("generate", unproved, "--out", tmp_path / "out", code=1)
    assert message.startswith("mine.toml: mine.damper: passive is REFUTED")
    assert not (tmp_path / "out").exists()


def test_what_is_not_proved_is_written_if_allowed(call, unproved, tmp_path):
    words = ("generate", unproved, "--out", tmp_path / "out", "--allow-unproved")
    assert call(*words).code == 0
    assert "NOT PROVED" in (tmp_path / "out" / "mine" / "mine.py").read_text()
    assert call(*words, "--check").code == 0


def test_a_folder_that_cannot_be_written_is_one_line(refused, tmp_path):
    (tmp_path / "file").write_text("")
    message = refused("generate", "piezo_stack", "--out", tmp_path / "file")
    assert message.startswith(f"'{tmp_path / 'file' / NAME}': cannot be written")


def test_models_whose_names_differ_only_by_case_are_refused(call, spec_file, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    first = Path(spec_file())
    other = tmp_path / "other.toml"
    text = first.read_text(encoding="utf-8")
    other.write_text(text.replace('"mine"', '"Mine"', 1), encoding="utf-8")
    said = "'{}' and '{}' differ only by case; rename a model: names become files"
    answer = call("generate", first, other)
    assert answer.code == 2
    assert said.format("mine", "Mine") in answer.err
    assert not (tmp_path / "generated").exists()
    assert call("generate", first).code == 0
    for more in ((), ("piezo_stack",)):
        answer = call("generate", *more, other)
        assert answer.code == 2
        assert said.format("Mine", "mine") in answer.err
        assert answer.err.count("\n") == 1
    assert [path.name for path in (tmp_path / "generated").iterdir()] == ["mine"]
    assert call("generate", first).code == 0


def test_all_is_of_a_check(refused):
    assert refused("generate", "oscillator", "--all").startswith("--all: goes with --check alone")
