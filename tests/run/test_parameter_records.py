"""Parameters of many runs: C has them as it has those of one."""

import ctypes

import pytest
from hypothesis import given
from hypothesis import strategies as st

from piezo_sym import load
from piezo_sym.modules import module_of
from piezo_sym.run.engine.engine import engine_of
from piezo_sym.run.module import lanes

NUMBERS = st.floats(1e-6, 1e6)


@pytest.fixture(scope="module")
def module():
    return module_of(load("piezo_stack"))


@st.composite
def runs(draw):
    """Draw a number of lanes; and of some runs M, and L for all lanes or one per lane."""
    count = draw(st.integers(1, 4))
    inductances = NUMBERS | st.tuples(*[NUMBERS] * count)
    return count, draw(st.lists(st.tuples(NUMBERS, inductances), min_size=1, max_size=6))


@given(runs())
def test_c_has_of_many_runs_what_it_has_of_each(module, drawn):
    structure, (count, values) = engine_of(module).structure, drawn
    same = {"d": 300.0, "hysteron_count": count}
    parameters = [module.Parameters(M=mass, L=lane, **same) for mass, lane in values]
    together = structure.many(parameters)
    for address, p in zip(together.addresses.tolist(), parameters, strict=True):
        alone = structure(p)
        there = type(alone.value).from_address(address)
        assert numbers(module, there, p) == numbers(module, alone.value, p)


def numbers(module, structure, p):
    """Return all numbers of a C structure: its parameters, of banks one per lane, its sizes."""
    found = []
    for n, record in enumerate(module.PARAMETERS):
        value = getattr(structure, f"field_{n}")
        size = lanes(p, record.bank) if record.bank else 0
        found.append([*(ctypes.c_double * size).from_address(value)] if size else value)
    return [*found, *(getattr(structure, f"count_{n}") for n, _ in enumerate(module.BANKS))]
