"""Reductions: what they give is what they would give of single runs, in little memory."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import xarray

from piezo_sym import simulate, sine, sweep
from piezo_sym.errors import UsageError
from piezo_sym.sweeps import SweepWarning

ROOT = Path(__file__).parents[2]
BASE = {"duration": 0.01, "times": 41, "inputs": {"V_in": sine(100, 100)}}
OVER = {"L": [1e-3, 2e-3], "hysteron_count": [1, 3]}


def singles():
    for one in OVER["L"]:
        for count in OVER["hysteron_count"]:
            values = {"L": one, "hysteron_count": count}
            run = simulate("piezo_stack", method="discrete_gradient", parameters=values, **BASE)
            yield values, run


def swept(**options):
    return sweep("piezo_stack", over=OVER, **BASE, **options)


def test_last_is_the_last_sample():
    whole, last = swept(), swept(reduce="last")
    assert "time" not in last.dims
    for name in whole.data_vars:
        at_end = whole[name].isel(time=-1) if "time" in whole[name].dims else whole[name]
        np.testing.assert_array_equal(last[name], at_end, err_msg=name)
        assert last[name].attrs == whole[name].attrs
    assert last.attrs["reduction"] == "last"


@pytest.mark.parametrize("how", [{"rtol": 1e-5}, {"step": 3e-5}], ids=str)
def test_where_the_last_is_kept_no_samples_in_between_are_paid_for(how):
    options = {"duration": 0.01, "inputs": BASE["inputs"], "over": {"L": [1e-3, 2e-3]}, **how}
    times = {"times": [0.0, 0.01]} if "rtol" in how else {}
    last = sweep("piezo_stack", reduce="last", **options)
    whole = sweep("piezo_stack", **times, **options)
    for name in ("q", "S", "energy", "energy_residual"):
        np.testing.assert_array_equal(last[name], whole[name].isel(time=-1), err_msg=name)


def test_inputs_that_leave_the_domain_between_its_ends_still_stop_a_run():
    dip = {"T_e": ([0.0, 0.004, 0.005, 0.006, 0.01], [298.15, 298.15, 290.0, 298.15, 298.15])}
    options = {"over": {"L": [1e-3, 2e-3]}, "duration": 0.01, "reduce": "last"}
    with pytest.warns(SweepWarning, match="2 of 2 runs failed"):
        last = sweep("piezo_stack", inputs=dip, **options)
    assert all("T_e > T_0" in str(error) for error in last.error.values)


def test_mean_is_the_integral_over_the_span():
    times = np.array([0.0, 0.001, 0.0015, 0.004, 0.01])
    options = {**BASE, "times": times}
    whole = sweep("piezo_stack", over=OVER, **options)
    mean = sweep("piezo_stack", over=OVER, reduce="mean", **options)
    for name in ("q", "phi", "T_body", "supplied_supply", "V_in"):
        expected = whole[name].integrate("time") / 0.01
        np.testing.assert_allclose(mean[name], expected, rtol=1e-12, atol=1e-18, err_msg=name)


def test_the_mean_of_one_sample_is_that_sample():
    options = {**BASE, "times": [0.01]}
    mean = sweep("piezo_stack", over=OVER, reduce="mean", **options)
    whole = sweep("piezo_stack", over=OVER, **options)
    np.testing.assert_array_equal(mean.q, whole.q.isel(time=0))


def area(run):
    return {"area": np.trapezoid(run.q.values, run.V_in.values), "peak": run.q.max()}


def test_a_function_sees_each_run_as_simulate_gives_it():
    found = swept(reduce=area)
    assert set(found.data_vars) == {"area", "peak", "error"}
    assert found.area.dims == ("L", "hysteron_count")
    for values, run in singles():
        expected = area(run)
        assert float(found.area.sel(values)) == expected["area"]
        assert float(found.peak.sel(values)) == float(expected["peak"])


def test_a_function_finds_what_was_swept():
    seen = sweep(
        "piezo_stack",
        over={"V_in": {50.0: sine(100, 50)}, ("L", "q"): [(1e-3, 1e-4)]},
        duration=0.01,
        reduce=lambda run: {"f": run.over_V_in, "H": run.L, "start": run.initial_q, "V": run.V_in},
    )
    assert (float(seen.f[0, 0]), float(seen.H[0, 0]), float(seen.start[0, 0])) == (50, 1e-3, 1e-4)
    np.testing.assert_allclose(seen.V[0, 0], sine(100, 50)(seen.time.values), atol=1e-9)


KINDS = [
    (lambda run: float(run.q[-1]), "reduced"),
    (lambda run: run.q[-1], "q"),
    (lambda run: run.q[-1] * run.p[-1], "reduced"),
    (lambda run: run[["q"]].isel(time=-1), "q"),
    (lambda run: {"q": run.q[-1]}, "q"),
]


@pytest.mark.parametrize(("function", "name"), KINDS)
def test_a_function_may_give_any_of_these(function, name):
    found = swept(reduce=function)
    assert set(found.data_vars) == {name, "error"}
    for values, run in singles():
        made = function(run)
        made = made[name] if isinstance(made, xarray.Dataset | dict) else made
        assert float(found[name].sel(values)) == float(made)


def thin(run):
    return run[["q", "phi"]].isel(time=slice(None, None, 10))


@pytest.mark.parametrize("by", ["run", "chunk"])
def test_a_function_may_keep_dimensions(by):
    found = swept(reduce=thin, reduce_by=by)
    assert dict(found.sizes) == {"L": 2, "hysteron_count": 2, "time": 5, "hysteron": 3}
    for values, run in singles():
        count = values["hysteron_count"]
        member = found.sel(values).isel(hysteron=slice(count))
        np.testing.assert_array_equal(member.phi, thin(run).phi)
        np.testing.assert_array_equal(found.time, thin(run).time)


def test_a_function_may_make_dimensions():
    def spectrum(run):
        lines = np.abs(np.fft.rfft(run.q.values))[:3]
        return xarray.DataArray(lines, [("line", [0, 1, 2])], name="spectrum")

    found = swept(reduce=spectrum)
    assert found.spectrum.dims == ("L", "hysteron_count", "line")
    assert found.line.values.tolist() == [0, 1, 2]


def test_a_chunk_is_reduced_at_once():
    def shares(runs):
        assert runs.q.dims == ("member", "time")
        assert runs.L.dims == ("member",)
        return {"span": runs.q.max("time") - runs.q.min("time")}

    found = swept(reduce=shares, reduce_by="chunk")
    for values, run in singles():
        assert float(found.span.sel(values)) == float(run.q.max() - run.q.min())


def test_a_function_that_fails_fails_its_run():
    def picky(run):
        return {"far": 1 / (float(run.L) - 1e-3)}

    with pytest.warns(SweepWarning, match=r"the function fails: ZeroDivisionError: float division"):
        found = swept(reduce=picky)
    assert (found.error.sel(L=1e-3) != "").all()
    assert np.isnan(found.far.sel(L=1e-3)).all()
    assert (found.far.sel(L=2e-3) == 1 / (2e-3 - 1e-3)).all()


WRONG = [
    (lambda run: "text", "run", "the function gives 'text'"),  # noqa: ARG005
    (lambda run: {"a": [1, 2]}, "run", "the function gives"),  # noqa: ARG005
    (lambda run: {3: run.q[-1]}, "run", "the function gives"),
    (lambda run: {"L": run.q[-1]}, "run", "gives 'L', which the sweep has, too"),
    (lambda run: run.q[: int(run.L * 1e4)], "run", "other sizes for one run than for another"),
    (
        lambda run: {f"q{int(run.L > 1.5e-3)}": run.q[-1]},
        "run",
        "for another; expected the same for every run",
    ),
    (lambda runs: runs.q.mean(), "chunk", "keep the dimension 'member'"),
    (lambda run: xarray.DataArray("a"), "run", "of type <U1; expected real numbers"),  # noqa: ARG005
]


@pytest.mark.parametrize(("function", "by", "message"), WRONG, ids=[m for *_, m in WRONG])
@pytest.mark.parametrize("threads", [1, 2])
def test_what_is_of_no_use_is_refused_in_one_line(function, by, message, threads):
    over = {"L": [1e-3, 2e-3, 1e-3, 2e-3]}  # in boxes of two runs, and of one
    with pytest.raises(UsageError) as raised:
        sweep("piezo_stack", over=over, **BASE, reduce=function, reduce_by=by, threads=threads)
    assert message in str(raised.value)
    assert "\n" not in str(raised.value)


PEAK = """
import resource, numpy as np
from piezo_sym import sine, sweep
def peak():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
found = sweep("piezo_stack", over={{"L": np.linspace(5e-4, 5e-3, 100),
    "lam": np.linspace(1, 3, {runs} // 100)}}, inputs={{"V_in": sine(100, 100)}},
    duration={duration}, threads=2, reduce={reduce}, reduce_by="chunk")
assert found.q.shape == (100, {runs} // 100) and bool(np.isfinite(found.q).all())
print(peak())
"""


def peak(runs, duration, reduce):
    """Return the largest memory [GiB] that a sweep took."""
    code = PEAK.format(runs=runs, duration=duration, reduce=reduce)
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, cwd=ROOT, check=True
    )
    return float(done.stdout)


@pytest.mark.long
@pytest.mark.skipif(sys.platform != "linux", reason="the unit of ru_maxrss")
def test_memory_does_not_grow_with_the_runs():
    """2000 trajectories would be 0.4 GiB."""
    few = peak(200, 1e-3, "'last'")
    assert peak(2000, 1e-3, "'last'") < few + 0.12


@pytest.mark.long
@pytest.mark.skipif(sys.platform != "linux", reason="the unit of ru_maxrss")
@pytest.mark.parametrize("reduce", ["'last'", "'mean'", "lambda runs: runs[['q']].max('time')"])
def test_ten_thousand_runs_stay_under_a_gibibyte(reduce):
    assert peak(10_000, 0.1, reduce) < 1.0
