"""Many runs at once: a table gives each run's parameters, and C has them as they are."""

import ctypes

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from piezo_sym.modules import module_of
from piezo_sym.run.engine.engine import engine_of
from piezo_sym.run.inputs import read_inputs
from piezo_sym.run.many import Systems, Table
from piezo_sym.spec.load import load

NUMBERS = st.floats(1e-6, 1e6)
LANES = st.tuples(NUMBERS, NUMBERS)


@pytest.fixture(scope="module")
def module():
    return module_of(load("piezo_stack"))


def shapes(masses, inductances):
    """Return columns of a plain parameter and of a bank's."""
    return {"M": np.array(masses), "L": list(inductances)}


@given(st.lists(st.tuples(NUMBERS, NUMBERS | LANES), min_size=1, max_size=6), st.data())
def test_a_table_gives_each_run_its_parameters(module, drawn, data):
    columns = shapes(*zip(*drawn, strict=True))
    table = Table(module.Parameters(d=300.0), len(drawn), columns)
    wanted = [module.Parameters(M=mass, L=lanes, d=300.0) for mass, lanes in drawn]
    assert list(table) == wanted == list(Table.of(wanted))
    assert all(type(one.M) is float for one in table)
    runs = data.draw(st.lists(st.integers(0, len(drawn) - 1), min_size=1, max_size=4))
    assert list(table.some(runs)) == [wanted[k] for k in runs]
    assert list(table[1:]) == wanted[1:]


@given(st.lists(st.tuples(NUMBERS, NUMBERS | LANES), min_size=2, max_size=6))
def test_c_has_of_a_table_what_it_has_of_each_run(module, drawn):
    layout = engine_of(module).structure
    table = Table(module.Parameters(), len(drawn), shapes(*zip(*drawn, strict=True)))
    together = layout.many(table)
    assert layout.many(table) is together
    for address, p in zip(together.addresses.tolist(), table, strict=True):
        alone = layout(p).value
        there = type(alone).from_address(address)
        for n, record in enumerate(module.PARAMETERS):
            found, one = (getattr(of, f"field_{n}") for of in (there, alone))
            if record.bank:
                found, one = ([*(ctypes.c_double * 2).from_address(at)] for at in (found, one))
            assert found == one


def test_systems_are_those_of_their_parameters(module):
    inputs = read_inputs(module, {"V_in": 50.0}, 0.1)
    table = Table(module.Parameters(), 3, {"M": np.array([1.0, 2.0, 3.0])})
    systems = Systems(module, inputs, table)
    assert [system.parameters.M for system in systems] == [1.0, 2.0, 3.0]
    assert all(system.inputs is inputs and system.module is module for system in systems)
    assert Systems.of(systems) is systems
    again = Systems.of(list(systems))
    assert list(again) == list(systems)
    assert list(systems.some([2, 0])) == [systems[2], systems[0]] == [systems[-1], systems[-3]]
    assert list(systems[1:]) == [systems[1], systems[2]]
    with pytest.raises(IndexError):
        systems[3]
