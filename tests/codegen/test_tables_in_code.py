"""A table of 64 knots in generated code, NumPy's and C's, against NumPy's own interpolation."""

import numpy as np
import pytest

from piezo_sym.spec.load import parse
from tests.proofs.test_tables import spec

from .test_c_against_numpy import made

RNG = np.random.default_rng(3)
SIDES = RNG.choice([-1, 1], 63)
X = np.sort([0, *RNG.choice(np.arange(1, 3000), 63, replace=False) * SIDES]) / 1000
Y = np.sign(X) * RNG.uniform(0, 1, 64).round(3)
Y[[0, -1]] = -2, 2
KNOTS = ", ".join(f"{x}, {y}" for x, y in zip(X, Y, strict=True))
SPEEDS = np.concatenate([X, X + 1e-9, X - 1e-9, RNG.uniform(-5, 5, 200)])


def interpolated(v):
    """Return NumPy's interpolation, continued by the slopes at both ends."""
    low, high = ((Y[n + 1] - Y[n]) / (X[n + 1] - X[n]) for n in (0, -2))
    ends = low * np.minimum(v - X[0], 0) + high * np.maximum(v - X[-1], 0)
    return np.interp(v, X, Y) + ends


@pytest.mark.long
def test_rates_and_slopes_are_those_of_the_interpolation(tmp_path):
    module, engine = made(parse(spec(f"F*table(v/a, {KNOTS})")), tmp_path)
    x, p = np.zeros((2, len(SPEEDS))), module.Parameters()
    momentum = [state.name for state in module.STATES].index("p")
    x[momentum] = SPEEDS
    slope = (interpolated(SPEEDS + 5e-10) - interpolated(SPEEDS - 5e-10)) / 1e-9
    smooth = np.abs(SPEEDS[:, None] - X).min(axis=1) > 6e-10
    for made_of in (module, engine):
        rates = made_of.rhs(x, np.zeros(0), p)
        slopes = made_of.jacobian(x, np.zeros(0), p)[momentum, momentum]
        assert np.allclose(rates[momentum], -interpolated(SPEEDS), rtol=1e-12, atol=1e-12)
        assert np.allclose(slopes[smooth], -slope[smooth], rtol=1e-4, atol=1e-4)
