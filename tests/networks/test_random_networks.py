"""Random networks derive to a proved system whose module is right, or are refused by name."""

import ast

import pytest
from agreement import DERIVED, check, check_laws
from kinds import KINDS
from network_tableau import entropy_of, state
from strategy import explore

from piezo_sym import Model, PiezoError, derive
from piezo_sym.spec import elements

MORE = (
    "a list of values",
    "a loop of resistors",
    "two banks",
    "a cell of a bank",
    "joined stores",
    "a law of another's state",
    "a law of another's temperature",
    "a store's own law",
    "a storage with an entropy",
)


def words(law):
    """Return the names in a law."""
    return {node.id for node in ast.walk(ast.parse(law)) if isinstance(node, ast.Name)}


def features(spec, _):
    """Return the kinds in a network, and what else it has; nothing of one that is refused."""
    try:
        iphs = derive(Model(**spec))
    except PiezoError:
        return set()
    elements = spec["elements"].values()
    stores = [e for e in elements if KINDS[e["kind"]].itself]
    storages = {n: e for n, e in spec["elements"].items() if e["kind"] == "storage"}
    values = [entry["value"] for entry in spec["parameters"].values()]
    symbols = {state(n, e) for n, e in spec["elements"].items() if KINDS[e["kind"]].letter}
    fields = ("voltage", "current", "force", "velocity", "ratio", "conductance")
    laws = [e[field] for e in elements for field in fields if field in e]
    has = {
        "a law of another's state": any(symbols & words(law) for law in laws),
        "a law of another's temperature": any("T_bo" in law or "T_th" in law for law in laws),
        "a store's own law": any(KINDS[e["kind"]].itself in e or "energy" in e for e in stores),
        "a storage with an entropy": any(map(entropy_of, storages, storages.values())),
        "a list of values": any(isinstance(value, list) for value in values),
        "a loop of resistors": bool(iphs.junction.slopes),
        "joined stores": bool(iphs.junction.joints),
        "a cell of a bank": any("bank" in element for element in elements),
        "two banks": sum("count" in element for element in elements) > 1,
    }
    return {element["kind"] for element in elements} | {
        name for name, there in has.items() if there
    }


def check_seen(outcomes, *, missing):
    """Check that both outcomes are frequent, and that what derives is not only what is simple."""
    found, refused = set().union(*outcomes), outcomes.count(set())
    wanted = {*elements.KINDS, *MORE}
    assert found <= wanted
    assert len(wanted - found) <= missing
    assert len(outcomes) / 20 <= refused <= len(outcomes) / 2


def test_every_kind_has_a_strategy():
    assert set(KINDS) == set(elements.KINDS)


@pytest.mark.long
@pytest.mark.parametrize(
    ("number", "missing"), [(60, 12), pytest.param(2000, 0, marks=pytest.mark.long)]
)
def test_what_is_drawn(number, missing):
    check_seen(explore(number, features), missing=missing)


#: Parts of 25 networks; of the first one the fast tier takes a few, the long tier has all 80.
LAWS = [n if n < 1 else pytest.param(n, marks=pytest.mark.long) for n in range(80)]
PARTS = [n if n < 1 else pytest.param(n, marks=pytest.mark.long) for n in range(80)]


def check_part(number, check, part):
    """Check a part of the networks; what is refused, and how often, is seen among those drawn."""
    assert explore(number, check, part).count(DERIVED) >= number / 5


@pytest.mark.parametrize("part", LAWS)
def test_laws_of_networks(part):
    check_part(25 if part else 10, check_laws, part)


@pytest.mark.parametrize("part", PARTS)
def test_networks(part):
    check_part(25 if part else 2, check, part)
