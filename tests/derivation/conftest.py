"""The paper's actuator, derived once."""

import pytest

from piezo_sym import derive, load


@pytest.fixture(scope="session")
def stack():
    return load("piezo_stack")


@pytest.fixture(scope="session")
def iphs(stack):
    return derive(stack)
