"""The shipped spec as plain data, to change and to make models of; modules from text."""

import tomllib
from pathlib import Path

import pytest

from piezo_sym import Model
from piezo_sym.build import render
from piezo_sym.module_cache import load_module

SHIPPED = Path(__file__).parents[2] / "piezo_sym" / "models" / "piezo_stack.toml"


@pytest.fixture(autouse=True)
def _known_reports(known_reports):
    """Nothing here is about how a model is examined, but for what is said of it."""


@pytest.fixture
def spec():
    """Plain data of piezo_stack."""
    return tomllib.loads(SHIPPED.read_text(encoding="utf-8"))


@pytest.fixture
def model(spec):
    """The model of piezo_stack."""
    return Model(**spec)


@pytest.fixture
def unproved(spec):
    """A model whose damper may have a negative coefficient."""
    spec["model"]["name"] = "free_damper"
    spec["domain"]["assume"].remove("d >= 0")
    return Model(**spec)


@pytest.fixture
def module_from(tmp_path):
    """Return the module that the text generated from a model is."""

    def made(model):
        path = tmp_path / "made" / f"{model.name}.py"
        path.parent.mkdir(exist_ok=True)
        text, *_ = render(model).values()
        path.write_text(text, encoding="utf-8")
        return load_module(path)

    return made
