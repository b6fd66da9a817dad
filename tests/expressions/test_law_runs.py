"""Models with many functions in their laws run alone and side by side."""

from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from piezo_sym import load, simulate, sine, sweep

TABLES = Path(__file__).parents[1] / "networks" / "specs" / "tables.toml"
SPEC = Path(__file__).parents[1] / "networks" / "specs" / "smooth_functions.toml"
DRIVE = {"F_ext": sine(0.2, 1.0)}


def test_a_run_keeps_both_balances_and_agrees_with_scipy():
    model = load(SPEC)
    run = simulate(model, inputs=DRIVE, duration=2.0, rtol=1e-9)
    reference = simulate(model, inputs=DRIVE, duration=2.0, rtol=1e-9, method="DOP853")
    assert abs(run.energy_residual).max() < 1e-12 * abs(run.energy).max()
    assert abs(float(run.T_body[-1]) - float(reference.T_body[-1])) < 1e-6
    assert abs(float(run.q[-1]) - float(reference.q[-1])) < 1e-6


def test_members_of_a_sweep_are_what_runs_alone_are():
    values = [0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5]
    runs = sweep(SPEC, over={"F": values}, inputs=DRIVE, duration=1.0, rtol=1e-7)
    for n, force in enumerate(values):
        alone = simulate(SPEC, inputs=DRIVE, duration=1.0, rtol=1e-7, parameters={"F": force})
        end = runs.T_body.isel(F=n, time=-1)
        assert float(end) == float(alone.T_body[-1])


@pytest.mark.long
def test_a_table_as_damper_runs_as_in_scipy():
    x, y = [-9.5, -0.5, -0.2, 0, 0.2, 0.5, 9.5], [-3.4, -0.4, -0.3, 0, 0.3, 0.4, 3.4]

    def rates(_, state):
        q, p = state
        return p, -4 * q - np.interp(p, x, y)

    run = simulate(TABLES, duration=4.0, rtol=1e-10)
    assert 0.5 < float(abs(run.p).max()) < 9.5
    settings = {"method": "DOP853", "rtol": 1e-11, "atol": 1e-13, "max_step": 1e-3}
    end = solve_ivp(rates, (0, 4), (0.5, 0.0), **settings).y[:, -1]
    assert np.allclose([float(run.q[-1]), float(run.p[-1])], end, rtol=0, atol=1e-9)
    assert abs(run.energy_residual).max() < 1e-12 * abs(run.energy).max()
