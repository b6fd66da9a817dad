"""The Dataset: its variables, units and attributes; netCDF; what a run imports."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import xarray

from piezo_sym import progress, sine
from piezo_sym import simulate as simulate_shipped
from piezo_sym.errors import UsageError
from piezo_sym.run import simulate

NAMES = {
    **dict.fromkeys(["q"], "m"),
    **dict.fromkeys(["p"], "kg*m/s"),
    **dict.fromkeys(["Q_C"], "C"),
    **dict.fromkeys(["phi"], "Wb"),
    **dict.fromkeys(["S", "entropy", "produced_hysteron", "produced_damper"], "J/K"),
    **dict.fromkeys(["entropy_exchanged_ambient", "entropy_residual"], "J/K"),
    **dict.fromkeys(["F_ext"], "N"),
    **dict.fromkeys(["V_in"], "V"),
    **dict.fromkeys(["T_e", "y_ambient", "T_body"], "K"),
    **dict.fromkeys(["y_load"], "m/s"),
    **dict.fromkeys(["y_supply"], "A"),
    **dict.fromkeys(["energy", "energy_residual", "heat_hysteron", "heat_damper"], "J"),
    **dict.fromkeys(["supplied_load", "supplied_supply", "supplied_ambient"], "J"),
}
BANKED = {"phi", "heat_hysteron", "produced_hysteron"}


@pytest.fixture(scope="module")
def ds(piezo):
    parameters = {"L": [1e-3, 2e-3, 3e-3], "hysteron_count": 3}
    drive = {"V_in": sine(100, 100), "F_ext": lambda t: 3.0 * t}
    return simulate(piezo, inputs=drive, duration=0.01, parameters=parameters, times=21, rtol=1e-6)


def test_variables(ds):
    assert set(ds.data_vars) == set(NAMES)
    for name, unit in NAMES.items():
        assert ds[name].attrs["units"] == unit, name
        assert ds[name].attrs["long_name"], name
        assert ds[name].dims == (("time", "hysteron") if name in BANKED else ("time",)), name
        assert np.all(np.isfinite(ds[name])), name
    assert ds.time.attrs == {"units": "s", "long_name": "time"}
    assert np.array_equal(ds.time, np.linspace(0, 0.01, 21))
    assert np.array_equal(ds.hysteron, [1, 2, 3])


def test_values_are_the_modules_at_the_samples(ds, piezo):
    p = piezo.Parameters(L=(1e-3, 2e-3, 3e-3), hysteron_count=3)
    x = np.vstack([ds.q, ds.p, ds.Q_C, ds.phi.T, ds.S])
    u = np.vstack([ds.F_ext, ds.V_in, ds.T_e])
    assert np.array_equal(np.vstack([ds.y_load, ds.y_supply, ds.y_ambient]), piezo.outputs(x, u, p))
    assert np.array_equal(ds.T_body, piezo.temperatures(x, p)[0])
    assert np.array_equal(ds.energy, piezo.energy(x, p))
    assert ds.V_in.values == pytest.approx(100 * np.sin(200 * np.pi * ds.time.values), abs=1e-9)
    supplied = ds.supplied_load + ds.supplied_supply + ds.supplied_ambient
    residual = ds.energy - ds.energy[0] - supplied
    assert ds.energy_residual.values == pytest.approx(residual.values, abs=1e-12)
    assert float(ds.energy_residual[0]) == 0


LEDGER = ("supplied_", "heat_", "produced_", "entropy_exchanged_", "energy_res", "entropy_res")


@pytest.mark.parametrize(("rtol", "order"), [(1e-4, 8), (1e-9, 12)])
def test_a_run_says_the_order_of_its_steps(rtol, order):
    found = simulate_shipped("piezo_stack", duration=1e-3, times=2, rtol=rtol)
    assert (found.attrs["method"], found.attrs["order"]) == ("discrete_gradient", order)


def test_a_last_time_may_lie_beyond_the_end_by_round_off():
    times = np.arange(0, 0.4, 0.1)
    assert times[-1] > 0.3
    found = simulate_shipped("piezo_stack", duration=0.3, times=times)
    assert found.time.values[-1] == 0.3


def test_attributes(ds):
    assert ds.attrs["model"] == "piezo_stack"
    assert ds.attrs["spec_sha256"] == "0" * 64
    assert (ds.attrs["method"], ds.attrs["rtol"]) == ("LSODA", 1e-6)
    assert ds.attrs["parameter_M"] == 3.5e-3
    assert np.array_equal(ds.attrs["parameter_L"], [1e-3, 2e-3, 3e-3])
    assert ds.attrs["rhs_evaluations"] >= ds.attrs["accepted_steps"] > 20
    assert ds.attrs["scale_evaluations"] > 0


def test_defaults(piezo):
    ds = simulate(piezo, duration=1e-3)
    assert ds.sizes == {"time": 1001, "hysteron": 2}
    assert (ds.attrs["rtol"], ds.attrs["method"]) == (1e-5, "LSODA")
    assert np.all(ds.T_e == 298.15)
    assert np.all(ds.V_in == 0)


def test_netcdf_round_trip(ds, tmp_path):
    path = tmp_path / "run.nc"
    ds.to_netcdf(path, engine="scipy")
    with xarray.open_dataset(path, engine="scipy") as back:
        xarray.testing.assert_equal(ds, back)
        assert back.time.attrs == ds.time.attrs
        assert list(back.attrs) == list(ds.attrs)
        assert all(np.array_equal(back.attrs[name], value) for name, value in ds.attrs.items())


SCRIPT = """
import sys
sys.path[:0] = sys.argv[1:]
import hand_written
from piezo_sym import simulate as simulate_shipped
from piezo_sym.errors import UsageError
from piezo_sym import sine
from piezo_sym.run import simulate
light = {"scipy", "xarray"} & set(sys.modules)
simulate(hand_written, inputs={"V_in": sine(100, 100)}, duration=1e-3)
heavy = {"sympy", "pydantic", "pint", "z3", "matplotlib"} & set(sys.modules)
print(sorted(light), sorted(heavy), "xarray" in sys.modules)
"""


def test_a_run_leaves_the_symbolic_libraries_alone():
    here = Path(__file__).parent
    command = [sys.executable, "-W", "error", "-c", SCRIPT, str(here), str(here.parents[1])]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    assert run.stdout.strip() == "[] [] True", run.stderr


@pytest.mark.parametrize(
    ("duration", "step", "samples", "apart"),
    [
        (1e-4, 1e-6, 101, 1e-6),
        (1e-3, 1e-6, 1001, 1e-6),
        (1.001e-3, 1e-6, 502, 2e-6),
        (0.1, 3e-5, 835, 12e-5),
        (1e-4, 1e-4, 2, 1e-4),
    ],
)
def test_samples_of_a_fixed_step_are_ends_of_its_steps(duration, step, samples, apart):
    run = simulate_shipped("piezo_stack", duration=duration, step=step)
    times = run.time.values
    assert (times.size, times[0], times[-1]) == (samples, 0, duration)
    assert np.diff(times)[:-1] == pytest.approx(apart, rel=1e-9)
    assert run.attrs["accepted_steps"] == int(np.ceil(duration / step - 1e-9))


def test_progress_is_shown_as_a_bar(capsys, monkeypatch):
    monkeypatch.setattr(progress, "SECOND", -1.0)
    monkeypatch.setenv("FORCE_COLOR", "1")
    simulate_shipped("piezo_stack", duration=1e-3, progress=True)
    assert "simulated" in capsys.readouterr().err
    simulate_shipped("piezo_stack", duration=1e-3, progress=False)
    assert capsys.readouterr() == ("", "")


@pytest.mark.parametrize(("wrong", "shown"), [(1, "1"), ("yes", "'yes'"), (0, "0")])
def test_no_progress_is_refused(wrong, shown):
    words = rf"simulate.progress: {shown} shows no progress; expected True, False, None or a func"
    with pytest.raises(UsageError, match=words):
        simulate_shipped("piezo_stack", duration=1e-3, progress=wrong)


def test_a_module_runs_without_a_bar(piezo):
    with pytest.raises(UsageError, match=r"simulate.progress: 'True' shows no progress"):
        simulate(piezo, duration=1e-3, progress=True)


@pytest.mark.parametrize("how", [{"rtol": 1e-5}, {"step": 1e-6}, {"method": "LSODA"}])
def test_progress_is_told_the_time(how):
    told = []
    simulate_shipped("piezo_stack", duration=0.5, times=3, progress=told.append, **how)
    assert told == sorted(told)
    assert 0 <= told[-1] <= 0.5
    assert told[-1] > 0 or "method" in how


def test_what_is_changed_in_one_run_is_not_in_the_next():
    """Runs at the same times are copies of one Dataset without numbers."""
    first, again = (simulate_shipped("oscillator", duration=0.01, times=3) for _ in range(2))
    for name in ("time", "q", "energy"):
        again[name].attrs["units"] = "1"
        again[name].encoding["dtype"] = "f4"
    again["q"][:] = 7.0
    again.attrs["model"] = "another"
    with pytest.raises(ValueError, match="read-only"):
        again.time.values[:] = 0.0
    last = simulate_shipped("oscillator", duration=0.01, times=3)
    assert last.identical(first)
    assert [last[name].encoding for name in ("time", "q", "energy")] == [{}, {}, {}]
