"""The mass on stops: this package, events by hand, and regularised slips agree."""

import numpy as np
import pytest

from tests.benchmarks.hysteresis import error, mass_on_stops, run_of
from tests.benchmarks.slips_by_hand import exact, regularised


@pytest.mark.some(1)
@pytest.mark.parametrize("periods", [0.1, 0.75, 3])
def test_events_by_hand_are_the_runs(periods):
    mass = mass_on_stops()
    known = exact(mass, periods * mass.period)
    assert error(mass, run_of(mass, periods)(1e-6), known) <= 1e-6
    assert error(mass, run_of(mass, periods)(1e-8), known) <= 1e-9


def test_regularised_slips_tend_to_stops():
    pytest.importorskip("numba")
    mass = mass_on_stops()
    known, solve = exact(mass, mass.period), regularised(mass, mass.period)
    errors = [error(mass, solve(smooth, 1e-9), known) for smooth in (1e-3, 1e-4, 1e-5)]
    assert np.all(np.diff(errors) < 0.0)
    assert errors[-1] <= 1e-5


def test_a_fixed_step_of_a_bank_of_many_stops_is_of_its_order():
    mass = mass_on_stops(1000)
    known, solve = exact(mass, 0.3), run_of(mass, 0.5)
    steps = (2e-3, 1e-3, 5e-4)
    errors = np.array([error(mass, solve(step=step, order=2), known) for step in steps])
    assert errors[-1] <= 1e-3
    np.testing.assert_allclose(errors[:-1] / errors[1:], 4.0, rtol=0.1)
