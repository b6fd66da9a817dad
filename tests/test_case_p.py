"""ACCEPTANCE case P: the paper's actuator after ten periods, by the generated module."""

import numpy as np
import pytest

from piezo_sym import simulate, sine

STATE = {
    "q": -9.523507638450e-04,
    "p": 3.453828489837e-03,
    "Q_C": -3.900998920056e-05,
    "phi": 5.224415297332e-03,
    "S": 1.341141665114e-01,
}
SCALES = {"q": 2e-3, "p": 5e-3, "Q_C": 5e-4, "phi": 6e-3, "S": 5e-2}


@pytest.mark.parametrize("method", ["LSODA", pytest.param("Radau", marks=pytest.mark.long)])
def test_state_after_ten_periods(method):
    run = simulate(
        "piezo_stack",
        inputs={"V_in": sine(100, 100), "T_e": 298.15},
        duration=0.1,
        rtol=1e-9,
        method=method,
        times=11,
    )
    for name, value in STATE.items():
        error = np.abs(run[name].values[-1] - value).max() / SCALES[name]
        assert error < 1e-6, (name, error)
    assert abs(float(run.T_body[-1]) - 304.2) < 0.05


def test_current_with_the_temperature_frozen():
    """T stays at T_0 + 5 K and the capacitor takes any charge: i(2 ms) of one R-L branch."""
    run = simulate(
        "piezo_stack",
        inputs={"V_in": 100.0, "T_e": 301.15},
        parameters={"c_0": 1e12, "C": 1e12, "lam": 0.0, "hysteron_count": 1},
        initial={"S": 1e12 * np.log1p(5 / 296.15)},
        duration=2e-3,
        rtol=1e-10,
        times=401,
    )
    current = run.y_supply.values
    assert abs(current[-1] - 49.575014294) < 1e-5
    assert np.interp(0.5, current[:3], run.time.values[:3]) == pytest.approx(5e-6, rel=0.02)
