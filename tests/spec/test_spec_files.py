"""Spec files that cannot be read, and texts that no parser should meet."""

import os

import pytest
from spec_tools import MINIMAL, SHIPPED, check_message, edited_text, refusal

from piezo_sym import load
from piezo_sym.errors import FileError, SpecError, UsageError
from piezo_sym.spec.load import parse
from piezo_sym.spec.source import data, find, read, shipped
from tests.clock import within


def written(folder, content, name="spec.toml"):
    path = folder / name
    path.write_bytes(content)
    return path


def test_a_file_is_loaded_by_path_or_text(tmp_path):
    path = written(tmp_path, SHIPPED.encode())
    assert load(path) == load(str(path)) == load("piezo_stack")


def test_a_shipped_name_is_found_from_anywhere(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert load("piezo_stack").name == "piezo_stack"
    assert "piezo_stack" in shipped()


def test_a_file_without_the_usual_ending_is_found(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    written(tmp_path, MINIMAL.encode(), "slider")
    assert load("slider").name == "slider"


@pytest.mark.parametrize("ending", ["\n", "\r\n"])
def test_lines_end_as_on_any_system(tmp_path, ending):
    path = written(tmp_path, SHIPPED.replace("\n", ending).encode())
    assert load(path) == load("piezo_stack")


@pytest.mark.parametrize(
    ("name", "answer"),
    [("piezo_stac", "did you mean 'piezo_stack'?"), ("zzz", "known: ")],
)
def test_an_unknown_name_is_answered_with_the_nearest(name, answer):
    with pytest.raises(FileError) as caught:
        load(name)
    assert str(caught.value).startswith(f"no shipped spec is called '{name}'; {answer}")
    assert "give the path of a .toml file" in str(caught.value)


@pytest.mark.parametrize(
    "name", ["nowhere.toml", "no/where.toml", "x" * 5000 + ".toml", "a\x00b.toml", "\ud800.toml"]
)
def test_a_path_that_is_not_there(name):
    error = refusal(load, name)
    assert isinstance(error, FileError)
    assert "cannot be read" in str(error)


def test_a_directory_is_no_spec(tmp_path):
    assert "cannot be read (Is a directory)" in str(refusal(load, tmp_path))


def test_an_empty_path_is_no_spec():
    assert "cannot be read" in str(refusal(load, ""))


@pytest.mark.parametrize("nothing", [None, 3, b"piezo_stack", ["piezo_stack"]])
def test_what_is_no_path_is_refused(nothing):
    with pytest.raises(UsageError, match=r"^load: .* is no spec; expected a shipped name, or a sp"):
        load(nothing)


def test_an_unreadable_file_is_refused(tmp_path, monkeypatch):
    path = written(tmp_path, SHIPPED.encode())

    def denied(*_args, **_kwargs):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(type(path), "open", denied)
    message = str(refusal(load, path))
    assert "cannot be read (Permission denied)" in message
    assert message.endswith("check the path")


@pytest.mark.parametrize("content", [b"\xff\xfe", b"name = '\xe4'", SHIPPED.encode("utf-16")])
def test_a_file_that_is_not_utf8(tmp_path, content):
    message = str(refusal(load, written(tmp_path, content)))
    assert "is not UTF-8 (byte " in message
    assert message.endswith("save it as UTF-8")


@pytest.mark.parametrize("content", [b"", b"\x00" * 10, b"\x7fELF", b"[model", b"a = 1\na = 2\n"])
def test_a_file_that_is_no_spec(tmp_path, content):
    assert str(refusal(load, written(tmp_path, content))).startswith("spec.toml: ")


@pytest.mark.parametrize("size", [500_001, 3_000_000])
def test_a_file_that_is_too_large(tmp_path, size):
    message = str(refusal(load, written(tmp_path, b"#" * size)))
    assert "is too large; expected at most 500000 bytes" in message


def test_a_text_that_is_too_large():
    assert "is too large; expected at most 500000" in str(refusal(parse, "#" * 500_001))


def test_a_device_is_read_only_in_part():
    assert "is too large" in str(refusal(load, "/dev/zero"))


KEY = ".".join("a" * 5000)
HOSTILE = {
    "arrays": "x = " + "[" * 5000 + "]" * 5000,
    "open arrays": "x = " + "[" * 5000,
    "arrays over lines": "x = " + "[\n" * 5000 + "]\n" * 5000,
    "inline tables": "x = " + "{a=" * 5000 + "1" + "}" * 5000,
    "arrays and tables": "x = " + "[{a=" * 2500 + "1" + "}]" * 2500,
    "a comment that closes": "# " + "]" * 5000 + "\nx = " + "[" * 5000 + "]" * 5000,
    "a string that closes": 'y = "' + "]" * 5000 + '"\nx = ' + "[" * 5000 + "]" * 5000,
    "lines that close": "y = '''\n" + "]\n" * 5000 + "'''\nx = " + "[" * 5000 + "]" * 5000,
    "a dotted key": f"{KEY} = 1",
    "a dotted table": f"[{KEY}]",
    "a dotted array of tables": f"[[{KEY}]]",
    "a dotted key inside": f"x = {{ {KEY} = 1 }}",
    "quoted parts": ".".join(['"a"'] * 5000) + " = 1",
    "an equals sign in a key": f'"=".{KEY} = 1',
    "a very long dotted key": '"=".' + ".".join("a" * 200_000) + " = 1",
    "a value": edited_text(("value = 3.5e-3", f"value = {{ {KEY} = 1 }}")),
    "a kind": edited_text(('kind = "spring"', f"kind = {{ {KEY} = 1 }}")),
    "a title": edited_text(("title  = ", f"title = {{ {KEY} = 1 }}\nt = ")),
    "a long integer": "x = " + "1" * 5000,
    "many quotes": "x = " + '"' * 100_001,
    "many backslashes": 'x = "' + "\\" * 100_001,
    "many triples": "x = " + "'''" * 33_333,
    "an open string": 'x = "' + "a" * 400_000,
    "an open text": 'x = """' + "\\a" * 200_000,
}


@pytest.mark.parametrize("text", HOSTILE.values(), ids=HOSTILE)
def test_hostile_texts_are_refused(text):
    error = refusal(parse, text)
    assert isinstance(error, SpecError)
    assert str(error).startswith("spec: ")


@pytest.mark.parametrize("name", ["arrays", "a comment that closes", "inline tables"])
def test_nesting_is_named(name):
    assert "is nested too deeply; expected at most 20 levels" in str(refusal(parse, HOSTILE[name]))


@pytest.mark.parametrize("name", ["a dotted key", "quoted parts", "a dotted key inside", "a value"])
def test_dotted_keys_are_named(name):
    assert "has a key of too many parts; expected at most 9" in str(refusal(parse, HOSTILE[name]))


def test_nesting_is_counted_exactly():
    assert data("x = " + "[" * 20 + "]" * 20)
    with pytest.raises(SpecError, match="nested too deeply"):
        data("x = " + "[" * 21 + "]" * 21)


def test_parts_of_a_key_are_counted_exactly():
    assert data(".".join("a" * 9) + " = 1")
    with pytest.raises(SpecError, match="too many parts"):
        data(".".join("a" * 10) + " = 1")


def test_brackets_in_comments_and_texts_are_free():
    notes = "# values in [0, 1)\n" * 50
    text = notes + edited_text(('doc = "moving mass"', f'doc = "{"[" * 30}"'))
    assert parse(text).parameters["M"].doc == "[" * 30


def test_dots_in_texts_and_numbers_are_free():
    text = edited_text(('doc = "moving mass"', 'doc = "..............."'))
    assert parse(text).parameters["M"].doc == "." * 15
    assert data("x = [" + "1.5, " * 100 + "]")["x"] == [1.5] * 100


def test_a_syntax_error_has_its_line():
    message = str(refusal(parse, SHIPPED.replace("[inputs]", "[inputs", 1)))
    assert "is not TOML: " in message
    assert "line 20" in message


def test_of_a_key_that_is_twice_with_a_very_long_value_the_end_is_said():
    lanes = "\n".join(["x = [", *["    1.5,"] * 60, "]"])
    with pytest.raises(SpecError, match=r"its table twice \(its value ends in line 63\)"):
        data(f"x = 1\n{lanes}\n")


def test_a_file_is_named_in_the_message(tmp_path):
    path = written(tmp_path, edited_text(("value = 3.5e-3", "value = nan")).encode(), "mine.toml")
    assert str(refusal(load, path)).startswith("mine.toml: parameters.M.value: ")


def test_a_file_of_an_odd_name_is_named_on_one_line(tmp_path):
    path = written(tmp_path, b"x = 1", "\u03bb\n.toml")
    assert str(refusal(load, path)).startswith("\u03bb\\n.toml: ")


def test_a_link_is_followed(tmp_path):
    os.symlink(written(tmp_path, MINIMAL.encode()), tmp_path / "link.toml")
    assert load(tmp_path / "link.toml").name == "slider"


def test_find_and_read_give_the_text():
    assert read(find("piezo_stack")) == SHIPPED


def many_masses(count):
    lines = ['[model]\nname = "m"\n[parameters]\nm = { value = 1, unit = "kg" }\n[initial]\n']
    lines += [f'p_a{n} = "0*m"\n' for n in range(count)]
    lines += [f'[elements.a{n}]\nkind = "mass"\nat = "x{n}"\nmass = "m"\n' for n in range(count)]
    return "".join(lines)


def test_a_thousand_elements_are_loaded_in_time():
    with within(4):
        assert len(parse(many_masses(2500)).elements) == 2500


@pytest.mark.parametrize("error", [FileError("x", "y", "z"), SpecError("a\nb\u03bb", "c", "d")])
def test_messages_are_one_line(error):
    check_message(error)
