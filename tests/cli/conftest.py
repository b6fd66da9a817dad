"""Command lines, run in this process; specs to give them."""

from pathlib import Path
from typing import NamedTuple

import pytest

from piezo_sym import cli

SHIPPED = Path(__file__).parents[2] / "piezo_sym" / "models" / "piezo_stack.toml"


class Answer(NamedTuple):
    """What a command line gave."""

    code: int
    out: str
    err: str


@pytest.fixture(autouse=True)
def _known_reports(known_reports):
    """Nothing here is about how a model is examined, but for what is said of it."""


@pytest.fixture
def call(capsys):
    """Run a command line and return its exit code and output."""

    def run(*words):
        code = cli.run([str(word) for word in words])
        return Answer(code, *capsys.readouterr())

    return run


@pytest.fixture
def refused(call):
    """Run a command line that is wrong, and return its one line."""

    def run(*words, code=2):
        answer = call(*words)
        assert answer.code == code
        assert answer.err.startswith("piezo-sym: ")
        assert answer.err.endswith("\n")
        assert len(answer.err.splitlines()) == 1
        return answer.err.removeprefix("piezo-sym: ").rstrip("\n")

    return run


@pytest.fixture
def spec_file(tmp_path):
    """Write piezo_stack with some text replaced, and return its path."""

    def write(old="", new="", name="mine.toml"):
        text = SHIPPED.read_text(encoding="utf-8").replace('"piezo_stack"', '"mine"')
        assert old in text
        (tmp_path / name).write_text(text.replace(old, new, 1), encoding="utf-8")
        return tmp_path / name

    return write


@pytest.fixture
def unproved(spec_file):
    """A spec whose damper may have a negative coefficient."""
    return spec_file('"d >= 0", ', "")
