"""Random networks derive to a proved system whose module is right, or are refused by name."""

import pytest
from agreement import DERIVED, check
from kinds import KINDS
from strategy import explore

from piezo_sym import Model, PiezoError, derive
from piezo_sym.spec import elements


def features(spec, _):
    """Return the kinds in a network, and what else it has; nothing of one that is refused."""
    try:
        iphs = derive(Model(**spec))
    except PiezoError:
        return set()
    elements = spec["elements"].values()
    values = [entry["value"] for entry in spec["parameters"].values()]
    has = {
        "a list of values": any(isinstance(value, list) for value in values),
        "a loop of resistors": bool(iphs.junction.slopes),
        "joined stores": bool(iphs.junction.joints),
        "two banks": sum("count" in element for element in elements) > 1,
    }
    return {element["kind"] for element in elements} | {
        name for name, there in has.items() if there
    }


def checked(spec, seed):
    """Check a network, and return its features."""
    return features(spec, seed) if check(spec, seed) == DERIVED else set()


def check_seen(outcomes, *, missing):
    """Check that both outcomes are frequent, and that what derives is not only what is simple."""
    found, refused = set().union(*outcomes), outcomes.count(set())
    wanted = {*elements.KINDS, "a list of values", "a loop of resistors", "two banks"}
    wanted.add("joined stores")
    assert found <= wanted
    assert len(wanted - found) <= missing
    assert len(outcomes) / 20 <= refused <= len(outcomes) / 2


def test_every_kind_has_a_strategy():
    assert set(KINDS) == set(elements.KINDS)


def test_what_is_drawn():
    check_seen(explore(200, features), missing=8)


def test_networks():
    derived = [found for found in explore(20, checked) if found]
    assert len(derived) >= 6  # what is refused, and how often, is seen among those above


@pytest.mark.long
def test_many_networks():
    check_seen(explore(2000, checked), missing=0)
