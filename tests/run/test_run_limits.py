"""Stops start within their limits: abs(state(0)) <= limit/stiffness, whatever is given at a run."""

import numpy as np
import pytest

from piezo_sym import (
    PiezoError,
    Stepper,
    operating_point,
    periodic_steady_state,
    simulate,
    sine,
    sweep,
)
from piezo_sym.errors import RunError
from piezo_sym.spec.load import parse
from piezo_sym.sweeps import SweepWarning

SPEC = """
[model]
name = "stopped"
[parameters]
k   = { value = 2.0, unit = "N/m" }
F_c = { value = 1.0, unit = "N" }
m   = { value = 1.0, unit = "kg" }
T_0 = { value = 300.0, unit = "K" }
c   = { value = 2.0, unit = "J/K" }
[inputs]
F = { unit = "N" }
[initial]
z = 0.4
[elements]
stop = { kind = "stop", between = ["tip", "wall"], stiffness = "k", limit = "F_c", heats = "body", state = "z" }
mass = { kind = "mass", at = "tip", mass = "m", state = "p" }
push = { kind = "force_source", at = "tip", input = "F" }
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
"""  # noqa: E501
BANK = SPEC.replace('kind = "stop"', 'count = 2, kind = "stop"').replace(
    'value = 1.0, unit = "N"', 'value = [1.0, 3.0], unit = "N"'
)
BEYOND = [
    {"initial": {"z": 0.6}},
    {"initial": {"z": -0.500001}},
    {"parameters": {"F_c": 0.7}},
    {"parameters": {"k": 2.6}},
]


@pytest.mark.parametrize("given", BEYOND)
@pytest.mark.parametrize("method", [None, "LSODA"])
def test_a_start_beyond_the_limit_is_refused(given, method):
    with pytest.raises(RunError, match="stop 'stop' starts beyond its limit: its effort is") as e:
        simulate(parse(SPEC), duration=0.1, method=method, **given)
    assert str(e.value).isprintable()
    assert e.value.remedy


@pytest.mark.parametrize("given", BEYOND)
def test_a_stepper_refuses_it_too(given):
    with pytest.raises(RunError, match="beyond its limit"):
        Stepper(parse(SPEC), step=0.01, **given)
    plant = Stepper(parse(SPEC), step=0.01)
    with pytest.raises(RunError, match="beyond its limit"):
        plant.reset([0.6, 0.0, 0.0])


def test_lanes_have_limits_of_their_own():
    with pytest.raises(PiezoError, match=r"limit in lane 1: its effort is 1\.2, its limit 1;"):
        simulate(parse(BANK), duration=0.1, initial={"z": [0.6, 1.4]})
    run = simulate(parse(BANK), duration=0.1, initial={"z": [0.5, 1.4]})
    assert run.z[0].values.tolist() == [0.5, 1.4]


def test_runs_of_a_sweep_beyond_the_limit_have_errors():
    with pytest.warns(SweepWarning, match="beyond its limit"):
        found = sweep(parse(SPEC), over={"z": [0.3, 0.6], "F_c": [1.0, 0.7]}, duration=0.1)
    good = found.error.values == ""
    assert good.tolist() == [[True, True], [False, False]]
    assert "beyond its limit" in found.error.values[1, 0]


@pytest.mark.parametrize("method", ["discrete_gradient", "RK45"])
def test_runs_go_on_from_the_limit(method, tmp_path):
    model, given = parse(SPEC), {"inputs": {"F": sine(2.6, 0.1)}, "method": method, "rtol": 1e-4}
    whole = simulate(model, duration=40.0, store=tmp_path / "run.zarr", **given)
    assert np.max(np.abs(whole.z)) == pytest.approx(0.5, rel=5e-2)  # RK45 steps over the limit
    late = float(whole.time[int(np.argmax(np.abs(whole.z.values)))])
    first = simulate(model, duration=late, **given)
    assert float(simulate(model, duration=1.0, initial=first, **given).time[-1]) == late + 1.0


def test_the_limit_is_among_the_quantities_of_a_stop():
    run = simulate(parse(BANK), duration=0.1, outputs=["stop.limit"])
    assert run["stop.limit"].values[-1].tolist() == [1.0, 3.0]
    assert run["stop.limit"].units == "N"


@pytest.mark.parametrize("given", BEYOND)
def test_searches_begin_within_the_limits_too(given):
    with pytest.raises(RunError, match="stop 'stop' starts beyond its limit"):
        operating_point(parse(SPEC), temperatures={"body": 300.0}, **given)
    with pytest.raises(RunError, match="stop 'stop' starts beyond its limit"):
        periodic_steady_state(parse(SPEC), inputs={"F": sine(0.1, 2.0)}, frequency=2.0, **given)
