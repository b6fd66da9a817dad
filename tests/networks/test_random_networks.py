"""Random networks derive to a proved system whose module is right, or are refused by name."""

from collections import Counter

import pytest
from agreement import DERIVED, REFUSED, check
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from kinds import KINDS
from strategy import networks

from piezo_sym import derive
from piezo_sym.errors import PiezoError
from piezo_sym.spec import elements
from piezo_sym.spec.model import Model


def derived(spec, _):
    """Return whether a network is derived or refused; nothing else is looked at."""
    try:
        derive(Model(**spec))
    except PiezoError:
        return REFUSED
    return DERIVED


def explore(number, check=check):
    """Check a number of networks; count how they came out, and what those derived have."""
    outcomes, found = Counter(), Counter()

    @settings(max_examples=number, suppress_health_check=list(HealthCheck), database=None)
    @given(networks(), st.integers(0, 10**6))
    def each(spec, seed):
        outcome = check(spec, seed)
        outcomes[outcome] += 1
        if outcome == DERIVED:
            found.update(features(spec))

    each()
    return outcomes, found


def features(spec):
    """Return the kinds in a network that is derived, and what else it has."""
    elements = spec["elements"].values()
    values = [entry["value"] for entry in spec["parameters"].values()]
    has = {
        "a list of values": any(isinstance(value, list) for value in values),
        "a loop of resistors": bool(derive(Model(**spec)).junction.slopes),
        "two banks": sum("count" in element for element in elements) > 1,
    }
    return {element["kind"] for element in elements} | {
        name for name, there in has.items() if there
    }


def check_seen(outcomes, found, *, missing):
    """Check that both outcomes are frequent, and that what derives is not only what is simple."""
    wanted = {*elements.KINDS, "a list of values", "a loop of resistors", "two banks"}
    assert set(found) <= wanted
    assert len(wanted - set(found)) <= missing
    assert outcomes[REFUSED] >= sum(outcomes.values()) / 20
    assert outcomes[DERIVED] >= sum(outcomes.values()) / 2


def test_every_kind_has_a_strategy():
    assert set(KINDS) == set(elements.KINDS)


def test_what_is_drawn():
    check_seen(*explore(50, derived), missing=4)


def test_networks():
    outcomes, _ = explore(20)
    assert outcomes[DERIVED] >= 6  # what is refused, and how often, is seen among the fifty above


@pytest.mark.long
def test_many_networks():
    check_seen(*explore(2000), missing=0)
