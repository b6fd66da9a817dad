"""Modules of the generated interface, written by hand, as fixtures."""

import shutil
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import SimpleNamespace

import pytest

from piezo_sym.module_cache import load_module

FILES = Path(__file__).parents[2] / "generated" / "piezo_stack"


def load(name):
    spec = spec_from_file_location(f"run_{name}", Path(__file__).with_name(f"{name}.py"))
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def piezo():
    return load("hand_written")


@pytest.fixture(scope="module")
def exchanger():
    return load("exchanger")


@pytest.fixture(scope="module")
def store():
    return load("store")


@pytest.fixture(scope="module")
def variant():
    """A module with some of its names changed."""
    return lambda module, **changes: SimpleNamespace(**(vars(module) | changes))


@pytest.fixture
def own_stack(tmp_path, cache, quick_compiler):  # noqa: ARG001  # neither gives a value
    """A module of piezo_stack in a folder of its own, with its sources, not compiled yet."""
    shutil.copytree(FILES, tmp_path / "piezo_stack")
    return load_module(tmp_path / "piezo_stack" / "piezo_stack.py")
