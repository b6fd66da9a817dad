"""Modules of the generated interface, written by hand, as fixtures."""

from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import SimpleNamespace

import pytest


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
