"""What runs cost, in solves and iterations: these are counts, the same on every machine.

A Bouc-Wen spring has two kinks in a half-period, where its rate and its force change their signs.
"""

from pathlib import Path

import numpy as np
import pytest

from piezo_sym import load, simulate, sine

BOUC_WEN = Path(__file__).parents[1] / "benchmarks" / "bouc_wen.toml"


@pytest.mark.parametrize("rtol", [1e-3, 1e-5])
def test_steps_end_at_kinks_that_are_seen_before(rtol):
    inputs = {"F": sine(8.0, 0.5)}
    run = simulate(load(BOUC_WEN), inputs=inputs, duration=60.0, rtol=rtol, times=[60.0])
    steps = run.attrs["accepted_steps"]
    assert run.attrs["halvings"] <= 2  # refused; without looking ahead 60 and 119
    assert run.attrs["newton_iterations"] < 5.5 * steps  # 5.0 and 3.5; else 6.0 and 5.3


def test_a_solve_ends_where_its_residuals_are_small():
    run = simulate("oscillator", initial={"q": 1e-3}, duration=10.0, rtol=1e-5, times=[10.0])
    assert run.attrs["newton_iterations"] < 2 * run.attrs["accepted_steps"]
    assert np.abs(run.energy_residual).max() < 1e-15 * run.energy.max()
