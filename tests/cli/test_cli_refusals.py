"""Hostile specs on the command line: one line, exit code 2, and no file left."""

import pytest

from tests.conftest import full_disk

CSV = "zeit [s],größe,b [V]\n0,1,2\n1,2,3\n"


def test_text_of_the_user_is_shown_as_it_is_written(refused, tmp_path):
    (tmp_path / "Kräfte.csv").write_text(CSV, encoding="utf-8")
    drive = f"V_in=@{tmp_path / 'Kräfte.csv'}"
    message = refused("simulate", "piezo_stack", "--duration", "1", "--input", drive)
    assert "Kräfte.csv' has no column 'V_in' beside its times; columns: zeit, größe, b" in message
    message = refused("simulate", "piezo_stack", "--duration", "1", "--set", "λ\x1b=1")
    assert "unknown name 'λ\\x1b'" in message


LAWS = ["__import__('os').system('touch canary')", "9**9**9", "exp(", "v if v else 0", "\\uff34"]
EDITS = {
    "text": [('"d*v"', f'"{law}"', "elements.damper.force") for law in LAWS],
    "size": [
        ('"d*v"', '"(((1+v)**16)**16)**16"', "has too high a degree"),
        ('"d*v"', '"(v+d+T+M+k)**16"', "has too many terms"),
        ('"d*v"', '"v*1e300*1e300"', "has numbers that multiply"),
    ],
    "tables": [
        (
            '"d*v"',
            '"table(v, 0, 0, d)"',
            "damper.force: 'table(v, 0, 0, d)' gives table 4",
        ),
        ('"d*v"', '"table(v, 0, 0)"', "expected table(x, x_1, y_1, x_2, y_2, ...) with 2 to 64"),
        ('"d*v"', '"d*table(v, 1, 2, 0, 3)"', "knots of a table do not increase; expected '1 < 0'"),
    ],
    "names": [
        ('state = "phi"', 'state = "lambda"', "call it 'lambda_0'"),
        ("[elements.damper]", '[elements."../up"]', "is not a name"),
        ('name   = "mine"', 'name   = "../mine"', "model.name: '../mine' is not a name"),
        ('name   = "mine"', 'name   = "/etc/mine"', "model.name: '/etc/mine' is not a name"),
    ],
    "numbers": [
        ("value = 3.5e-3", "value = nan", "expected a finite number"),
        ("value = 3.5e-3", "value = 0", "expected 'M > 0'"),
        ("count = 2", "count = 0", "elements.hysteron.count"),
        ('unit = "kg"', 'unit = "m**9**9**9"', "is not a unit"),
        ('unit = "kg"', 'unit = "degC"', "has an offset"),
        ('stiffness = "k"', 'stifness = "k"', "did you mean 'stiffness'?"),
    ],
}
CASES = [(group, *case) for group, cases in EDITS.items() for case in cases]
FILES = {
    "not UTF-8": (b"\xff\xfe", "is not UTF-8 (byte 0)"),
    "nested": (b"x = " + b"[" * 5000 + b"]" * 5000, "is nested too deeply"),
    "a megabyte": (b"#" * 1_000_001, "is too large"),
    "no TOML": (b"[model", "is not TOML"),
    "nothing": (b"", "model: is missing"),
}


def files(folder):
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*"))


def arguments(command, path):
    return [command, path, *(["--duration", "1"] if command == "simulate" else [])]


@pytest.mark.some(60)
@pytest.mark.parametrize("command", ["verify", "show", "generate", "simulate"])
@pytest.mark.parametrize(("group", "old", "new", "said"), CASES)
def test_a_hostile_spec_is_refused(
    refused, spec_file, tmp_path, monkeypatch, command, group, old, new, said
):
    assert group in EDITS
    monkeypatch.chdir(tmp_path)
    path = spec_file(old, new)
    message = refused(*arguments(command, path))
    assert message.startswith("mine.toml: ")
    assert said in message
    assert files(tmp_path) == ["mine.toml"]


@pytest.mark.parametrize("command", ["verify", "show", "generate", "simulate"])
@pytest.mark.parametrize(("content", "said"), FILES.values(), ids=FILES)
def test_a_hostile_file_is_refused(refused, tmp_path, monkeypatch, command, content, said):
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "mine.toml"
    path.write_bytes(content)
    assert said in refused(*arguments(command, path))
    assert files(tmp_path) == ["mine.toml"]


@pytest.mark.parametrize("command", ["verify", "show", "generate", "simulate"])
def test_a_folder_is_no_spec(refused, tmp_path, command):
    assert "cannot be read (Is a directory)" in refused(*arguments(command, tmp_path))


def test_an_output_below_a_file_is_one_line(refused, spec_file, tmp_path):
    path = spec_file()
    message = refused("generate", path, "--out", path / "below")
    assert "cannot be written (Not a directory)" in message
    assert files(tmp_path) == ["mine.toml"]


def test_a_full_disk_is_one_line(refused, spec_file, tmp_path):
    path = spec_file()
    with full_disk():
        message = refused("generate", path, "--out", tmp_path / "full")
    assert "cannot be written (File too large)" in message
    assert [name for name in files(tmp_path) if name.endswith(".py")] == []


def test_a_name_longer_than_any_file_is_one_line(refused, spec_file):
    assert "no shipped spec is called" in refused("simulate", "a" * 300, "--duration", "1")
    spec = spec_file('name   = "mine"', f'name   = "{"a" * 300}"')
    assert "model.name" in refused("simulate", spec, "--duration", "1")
