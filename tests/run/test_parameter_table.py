"""Parameters of many runs: a table gives those of each, and C has them as they are."""

import ctypes

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from piezo_sym import load
from piezo_sym.modules import module_of
from piezo_sym.run.engine.engine import engine_of
from piezo_sym.run.inputs import read_inputs
from piezo_sym.run.module import lanes
from piezo_sym.run.system import DrivenModules, ParameterTable

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


def table_of(module, drawn):
    """Return the runs as a table, and the parameters of each."""
    count, values = drawn
    same = {"d": 300.0, "hysteron_count": count}
    masses, inductances = zip(*values, strict=True)
    columns = {"M": np.array(masses), "L": list(inductances)}
    table = ParameterTable(module.Parameters(**same), len(values), columns)
    return table, [module.Parameters(M=mass, L=lane, **same) for mass, lane in values]


@given(runs(), st.data())
def test_a_table_gives_each_run_its_parameters(module, drawn, data):
    table, wanted = table_of(module, drawn)
    assert list(table) == wanted == list(ParameterTable.of(wanted))
    assert all(type(one.M) is float for one in table)
    some = data.draw(st.lists(st.integers(0, len(wanted) - 1), min_size=1, max_size=4))
    assert list(table.some(some)) == [wanted[k] for k in some]


def test_as_many_runs_need_not_be_all_of_them(module):
    table, (first, second) = table_of(module, (2, [(1.0, 3.0), (2.0, (4.0, 5.0))]))
    assert list(table.some([1, 0])) == [second, first]
    assert list(table.some([1, 1])) == [second, second]
    assert table.some([0, 1]) is table


def test_columns_are_as_long_as_there_are_runs(module):
    with pytest.raises(ValueError, match="column M has 1 values for 3 runs"):
        ParameterTable(module.Parameters(), 3, {"M": np.array([1.0])})


@given(runs(), st.data())
def test_c_has_of_a_table_what_it_has_of_each_run(module, drawn, data):
    layout, (table, _) = engine_of(module).structure, table_of(module, drawn)
    some = data.draw(st.lists(st.integers(0, len(table) - 1), min_size=1, max_size=4))
    for found in (table, table.some(some)):
        together = layout.many(found)
        for address, p in zip(together.addresses.tolist(), found, strict=True):
            alone = layout(p)
            there = type(alone.value).from_address(address)
            assert values(module, there, p) == values(module, alone.value, p)


def values(module, structure, p):
    """Return all numbers of a C structure: its parameters, of banks one per lane, its sizes."""
    found = []
    for n, record in enumerate(module.PARAMETERS):
        value = getattr(structure, f"field_{n}")
        size = lanes(p, record.bank) if record.bank else 0
        found.append([*(ctypes.c_double * size).from_address(value)] if size else value)
    return [*found, *(getattr(structure, f"count_{n}") for n, _ in enumerate(module.BANKS))]


def test_systems_are_those_of_their_parameters(module):
    inputs = read_inputs(module, {"V_in": 50.0}, 0.1)
    table = ParameterTable(module.Parameters(), 3, {"M": np.array([1.0, 2.0, 3.0])})
    systems = DrivenModules(module, table, inputs)
    assert [system.parameters.M for system in systems] == [1.0, 2.0, 3.0]
    assert all(system.inputs is inputs and system.module is module for system in systems)
    assert DrivenModules.of(systems) is systems
    again = DrivenModules.of(list(systems))
    assert list(again) == list(systems)
    assert list(systems.some([2, 0])) == [systems[2], systems[0]] == [systems[-1], systems[-3]]
    with pytest.raises(IndexError):
        systems[3]
