"""Random networks derive to a proved system whose module is right, or are refused by name."""

from collections import Counter

import pytest
from agreement import DERIVED, REFUSED, check
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from kinds import KINDS
from strategy import networks

from piezo_sym.spec import elements


def explore(number):
    """Check a number of networks; return how many came out how, and the kinds in those derived."""
    outcomes, kinds = Counter(), Counter()

    @settings(max_examples=number, suppress_health_check=list(HealthCheck), database=None)
    @given(networks(), st.integers(0, 10**6))
    def each(spec, seed):
        outcome = check(spec, seed)
        outcomes[outcome] += 1
        if outcome == DERIVED:
            kinds.update({element["kind"] for element in spec["elements"].values()})

    each()
    return outcomes, kinds


def check_seen(outcomes, kinds):
    assert set(kinds) == set(elements.KINDS)
    assert outcomes[REFUSED] >= sum(outcomes.values()) / 20
    assert outcomes[DERIVED] >= sum(outcomes.values()) / 2


def test_every_kind_has_a_strategy():
    assert set(KINDS) == set(elements.KINDS)


def test_networks():
    check_seen(*explore(200))


@pytest.mark.long
def test_many_networks():
    check_seen(*explore(2000))
