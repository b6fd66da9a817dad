"""The committed module of piezo_stack, and modules of specs that a test writes."""

import pytest

from piezo_sym import load
from piezo_sym.modules import module_of


@pytest.fixture(scope="session")
def stack():
    return module_of("piezo_stack")


@pytest.fixture(scope="session")
def module(tmp_path_factory):
    """The module of a spec's text."""
    folder = tmp_path_factory.mktemp("specs")

    def write(text):
        path = folder / "mine.toml"
        path.write_text(text, encoding="utf-8")
        with pytest.MonkeyPatch.context() as patch:
            patch.setenv("XDG_CACHE_HOME", str(folder / "cache"))
            return module_of(load(path))

    return write
