"""Edges are searched for along the columns that they depend on, and no other has any."""

from dataclasses import replace

import numpy as np
import pytest

from piezo_sym import derive, load
from piezo_sym.codegen import collocation_of, lower, printed
from piezo_sym.expressions.tree import Sym
from piezo_sym.falsify import module_from
from piezo_sym.falsify.hunt import Hunt
from piezo_sym.falsify.probe import Edge
from piezo_sym.falsify.space import Space


def hunt(name):
    iphs = derive(load(name))
    return Hunt(iphs, module_from(printed(lower(iphs, ""), collocation_of(iphs))[".py"]), (), 1000)


def points(name):
    """Return all points that an attack on no row tries."""
    return [points for _, _, points in hunt(name)._blocks()]


@pytest.mark.some(1)
@pytest.mark.parametrize("name", ["piezo_stack", "electromagnet", "stack_maxwell"])
def test_points_are_those_of_a_search_along_all_columns(name, monkeypatch):
    found = points(name)
    everything = {
        column: tuple(range(len(hunt(name).space.probe.edges)))
        for column, _ in hunt(name).space.columns
    }
    monkeypatch.setattr(Space, "edges_by_column", everything)
    for own, wanted in zip(found, points(name), strict=True):
        np.testing.assert_array_equal(own, wanted)


def test_an_edge_of_what_the_module_computes_may_depend_on_all_columns():
    space = hunt("oscillator").space
    rate = next(name for name in space.probe.defined if " " in name)
    edged = replace(space, probe=replace(space.probe, edges=(Edge(Sym(rate)),)))
    assert edged.edges_by_column == dict.fromkeys(space.columns_of, (0,))
