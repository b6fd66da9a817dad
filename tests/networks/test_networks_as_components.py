"""Random networks as parts of a model: another's rates, supplies and energy are their own."""

import numpy as np
import pytest
from strategy import derivable, explore

from piezo_sym import Model, derive
from piezo_sym.codegen import collocation_of, lower, printed
from piezo_sym.falsify import module_from

FUNCTIONS = ("rhs", "outputs", "supply", "entropy_production", "jacobian")


def module(iphs):
    return module_from(printed(lower(iphs, ""), collocation_of(iphs))[".py"])


def check(spec, seed):
    """Compare a network with a model of which it is the only part; return how many states."""
    alone = module(derivable(spec))
    whole = Model(model={"name": "outer"}, components={"left": {"spec": Model(**spec)}})
    part = module(derive(whole))
    assert [r.name for r in part.STATES] == [f"left_{r.name}" for r in alone.STATES]
    rng, sizes = (
        np.random.default_rng(seed),
        alone.initial_state(alone.INPUT_DEFAULTS, alone.Parameters()),
    )
    x, u = rng.uniform(0.1, 0.9, len(sizes)), rng.uniform(1, 5, len(alone.INPUTS))
    for name in FUNCTIONS:
        found, wanted = (getattr(m, name)(x, u, m.Parameters()) for m in (part, alone))
        assert np.allclose(found, wanted, rtol=1e-12, atol=1e-12 * np.abs(wanted).max(initial=1.0))
    return len(sizes)


def test_networks_are_the_same_as_parts():
    assert sum(explore(2, check)) > 2


@pytest.mark.long
def test_many_networks_are_the_same_as_parts():
    assert sum(explore(100, check)) > 300
