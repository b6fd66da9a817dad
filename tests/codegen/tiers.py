"""Which cases of a test run each time: compiling a step takes longer than running it."""

import pytest


def tiers(values, *fast):
    """Return cases; all but those at some places are of the long tier."""
    long = pytest.mark.long
    return [v if n in fast else pytest.param(v, marks=long) for n, v in enumerate(values)]
