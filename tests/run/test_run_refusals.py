"""Calls of `simulate` that are wrong: each is refused with a line that names the place."""

import re
from math import inf, nan

import numpy as np
import pytest
import xarray

import piezo_sym
from piezo_sym import samples, sweep
from piezo_sym.errors import UsageError
from piezo_sym.run import simulate

REFUSED = [
    ({"inputs": {"V_inn": 1}}, "simulate.inputs: unknown name 'V_inn'; did you mean 'V_in'?"),
    ({"inputs": {"zzz": 1}}, "known: F_ext, V_in, T_e"),
    ({"inputs": {3: 1}}, "simulate.inputs: unknown name 3"),
    ({"inputs": [1, 2]}, "simulate.inputs: '[1, 2]' is not a mapping"),
    ({"inputs": {"V_in": nan}}, "simulate.inputs.V_in: nan is not a finite number"),
    ({"inputs": {"V_in": inf}}, "simulate.inputs.V_in: inf is not a finite number"),
    ({"inputs": {"V_in": True}}, "simulate.inputs.V_in: 'True' is no input; expected a number"),
    ({"inputs": {"V_in": "5"}}, "simulate.inputs.V_in: '5' is no input"),
    ({"inputs": {"V_in": None}}, "simulate.inputs.V_in: 'None' is no input"),
    ({"inputs": {"V_in": int}}, "is no input"),
    ({"inputs": {"V_in": [1, 2, 3]}}, "simulate.inputs.V_in: '[1, 2, 3]' is no input"),
    ({"inputs": {"V_in": ([0, 1], [1, nan])}}, "simulate.inputs.V_in.values[1]: nan"),
    ({"inputs": {"V_in": ([0, 1, 1, 1], [1, 2, 3, 4])}}, "at entry 3 follows 1 twice"),
    ({"inputs": {"V_in": ([0, 1, 2, 1], [1] * 4)}}, "V_in.times: time 1 at entry 3 follows 2"),
    ({"inputs": {"V_in": ([0, 1], [1, 2, 3])}}, "simulate.inputs.V_in: 2 times and 3 values"),
    (
        {"inputs": {"V_in": ([0, 0.05], [1, 2])}},
        "inputs.V_in: samples span 0 s to 0.05 s; expected samples that cover 0 s to 0.1 s"
        "; no value is held before the first or after the last: add samples at both ends",
    ),
    ({"inputs": {"V_in": samples([0.01, 1], [1, 2])}}, "samples span 0.01 s to 1 s"),
    ({"inputs": {"V_in": lambda _: nan}}, "simulate.inputs.V_in(0): nan is not a finite"),
    ({"inputs": {"V_in": lambda _: "x"}}, "simulate.inputs.V_in(0): 'x' is not a finite"),
    (
        {"inputs": {"V_in": lambda t: 1 / t}},
        "simulate.inputs.V_in: the function fails at t = 0 s: ZeroDivisionError: ",
    ),
    ({"inputs": {"V_in": lambda: 1}}, "the function fails at t = 0 s: TypeError: "),
    ({"parameters": {"l": 1}}, "simulate.parameters: unknown name 'l'"),
    ({"parameters": {"lamb": 1}}, "did you mean 'lam'?"),
    ({"parameters": {"hysteron_cout": 1}}, "did you mean 'hysteron_count'?"),
    ({"parameters": {"M": nan}}, "simulate.parameters.M: nan is not a finite number"),
    ({"parameters": {"M": True}}, "simulate.parameters.M: 'True' is not a finite number"),
    ({"parameters": {"M": "1"}}, "simulate.parameters.M: '1' is not a finite number"),
    ({"parameters": {"M": [1, 2]}}, "simulate.parameters.M: '[1, 2]' is a list; expected one"),
    ({"parameters": {"L": [1, 2, 3]}}, "simulate.parameters.L: 3 values for 2 lanes; expected 2"),
    ({"parameters": {"L": [1, inf]}}, "simulate.parameters.L[1]: inf"),
    ({"parameters": {"hysteron_count": 3, "L": [1, 2]}}, "2 values for 3 lanes"),
    ({"parameters": {"hysteron_count": 0}}, "simulate.parameters.hysteron_count: 0 is not"),
    ({"parameters": {"hysteron_count": 2.0}}, "expected a whole number >= 1"),
    ({"parameters": {"hysteron_count": True}}, "expected a whole number >= 1"),
    ({"initial": {"Q": 0}}, "simulate.initial: unknown name 'Q'"),
    ({"initial": 5}, "simulate.initial: 5 is not a mapping; expected a mapping of names to"),
    ({"initial": {"q": nan}}, "simulate.initial.q: nan is not a finite number"),
    ({"initial": {"q": [0, 0]}}, "simulate.initial.q: '[0, 0]' is a list; expected one number"),
    ({"initial": {"phi": [0]}}, "simulate.initial.phi: 1 values for 2 lanes; expected 2"),
    ({"duration": 0}, "simulate.duration: 0 is not positive"),
    ({"duration": -1}, "simulate.duration: -1 is not positive"),
    ({"duration": np.float64(-1.5)}, "simulate.duration: -1.5 is not positive"),
    ({"times": [np.float64(0.5), "1"]}, "simulate.times[1]: '1' is not a finite number"),
    ({"duration": [np.float64(1.5)]}, "simulate.duration: '[1.5]' is not a finite number"),
    ({"duration": inf}, "simulate.duration: inf is not a finite number"),
    ({"duration": True}, "simulate.duration: 'True' is not a finite number"),
    ({"step": 1e-14}, "simulate.step: 1e-14 s is too short a step for 0.1 s"),
    ({"step": 1e-90}, "a run of over 10^11 steps; expected at least 1e-12 s"),
    ({"step": 0.2}, "simulate.step: 0.2 s is longer than the run; expected at most 0.1 s"),
    ({"step": 0.2, "times": 5}, "simulate.step: 0.2 s is longer than the run"),
    ({"rtol": 0}, "simulate.rtol: 0 is out of range; expected 1e-13 to 0.1"),
    ({"rtol": 1}, "simulate.rtol: 1 is out of range"),
    ({"rtol": nan}, "simulate.rtol: nan is not a finite number"),
    ({"step": 1e-5, "method": "LSODA"}, "simulate.step: method LSODA chooses its own steps"),
    (
        {"step": 1e-5, "method": "BDF"},
        "simulate.step: method BDF chooses its own steps; expected nothing; leave out step",
    ),
    ({"step": 0.0}, "simulate.step: 0.0 is not positive"),
    (
        {"method": "euler"},
        "unknown method 'euler'; expected discrete_gradient, RK23, RK45, DOP853, Radau, BDF, LSODA",
    ),
    ({"method": 5}, "simulate.method: unknown method 5"),
    ({"times": 1}, "simulate.times: 1 is not allowed; expected a whole number >= 2"),
    ({"times": 10.0}, "expected a whole number >= 2"),
    ({"times": True}, "expected a whole number >= 2"),
    ({"times": []}, "simulate.times: no times; expected times within 0 s to 0.1 s"),
    ({"times": [0, 0.2]}, "simulate.times: times span 0 s to 0.2 s; expected times within"),
    ({"times": [-0.1, 0.1]}, "simulate.times: times span -0.1 s to 0.1 s"),
    ({"times": [0, 0.05, 0.05]}, "simulate.times: time 0.05 at entry 2 follows 0.05"),
    ({"times": [0, 0.1, 0.1 * (1 + 5e-13)]}, "simulate.times: time 0.1 at entry 2 follows 0.1"),
    ({"times": np.array([0, nan])}, "simulate.times: entry 1 is nan"),
    ({"times": "all"}, "simulate.times: 'all' is not a list of numbers"),
]


@pytest.mark.parametrize(("wrong", "words"), REFUSED)
def test_refused(piezo, wrong, words):
    with pytest.raises(UsageError) as error:
        simulate(piezo, **{"duration": 0.1, **wrong})
    assert words in str(error.value)
    assert str(error.value).isprintable()


def test_no_generated_module(piezo, variant):
    with pytest.raises(UsageError, match=r"'piezo_stack' is no generated module: it lacks NAME"):
        simulate("piezo_stack", duration=0.1)
    partial = variant(piezo)
    del partial.margins
    with pytest.raises(UsageError, match=r"it lacks margins; expected a generated module"):
        simulate(partial, duration=0.1)


def test_names_that_collide(store, variant):
    same = variant(store, INPUTS=(store.INPUTS[0], store.Record("x", "W", "")))
    with pytest.raises(UsageError, match=r"model 'store': two quantities are named 'x'; rename"):
        simulate(same, duration=1.0)


def test_list_of_defaults_that_a_new_count_does_not_fit(piezo, variant):
    class Listed(piezo.Parameters):
        def __init__(self, L=(1e-3, 2e-3), **more):
            super().__init__(L=L, **more)

    listed = variant(piezo, Parameters=Listed)
    assert simulate(listed, duration=1e-4, times=2).sizes["hysteron"] == 2
    with pytest.raises(UsageError, match=r"simulate.parameters.L: 2 values for 3 lanes"):
        simulate(listed, duration=1e-4, parameters={"hysteron_count": 3})


def test_numbers_of_numpy_are_numbers(piezo):
    ds = simulate(
        piezo,
        inputs={"V_in": np.float32(2), "F_ext": np.array(3)},
        parameters={"hysteron_count": np.int64(3), "L": np.array([1, 2, 3]) * 1e-3},
        duration=np.float64(1e-3),
        times=np.int64(3),
    )
    assert ds.attrs["parameter_hysteron_count"] == 3
    assert np.array_equal(ds.V_in, [2, 2, 2])
    assert np.array_equal(ds.F_ext, [3, 3, 3])


def test_numbers_of_a_run_are_numbers():
    """As 0-d DataArrays, which indexing gives: in all arguments of all functions."""
    run = piezo_sym.simulate("piezo_stack", inputs={"V_in": 100.0}, duration=1e-3, times=2)
    point = {"inputs": {"V_in": run.V_in[-1]}, "parameters": {"d": xarray.DataArray(300.0)}}
    point["parameters"]["hysteron_count"] = xarray.DataArray(3)
    start = {"q": run.q[-1], "T_body": run.T_body[-1]}
    given = {"initial": start, "duration": run.time[-1], "times": 2}
    again = piezo_sym.simulate("piezo_stack", **point, **given)
    assert again.V_in[0] == 100.0
    assert again.attrs["parameter_d"] == 300.0
    assert again.sizes["hysteron"] == 3
    assert again.q[0] == run.q[-1]
    assert again.T_body[0] == pytest.approx(float(run.T_body[-1]), rel=1e-15)
    assert piezo_sym.operating_point("piezo_stack", **point).inputs["V_in"] == 100.0
    assert piezo_sym.Stepper("piezo_stack", step=1e-5, initial=start, **point).x[0] == run.q[-1]
    wrong = {"inputs": {"V_in": xarray.DataArray(True)}}
    with pytest.raises(UsageError, match=r"simulate.inputs.V_in"):
        piezo_sym.simulate("piezo_stack", duration=1e-3, **wrong)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (
            {"times": 10**9},
            "times: 1000000000 is too many; expected at most 100,000,000",
        ),
        (
            {"parameters": {"hysteron_count": 10**18}},
            "is too many; expected at most 10,000,000",
        ),
        ({"parameters": {"hysteron_count": 10**8}}, "is too many; expected at most 10,000,000"),
    ],
)
def test_sizes_beyond_any_memory_are_refused(options, said):
    for run in (piezo_sym.simulate, lambda *a, **k: sweep(*a, over={"d": [1.0, 2.0]}, **k)):
        with pytest.raises(UsageError) as error:
            run("piezo_stack", duration=1e-3, **options)
        assert said in str(error.value)


def test_a_run_too_large_for_the_memory_is_told_to_take_a_store():
    """How large a sample is, is counted."""
    few = piezo_sym.simulate("piezo_stack", duration=1e-3, times=1000, outputs="all")
    size = few.nbytes / 1000
    with pytest.raises(UsageError) as error:
        piezo_sym.simulate("piezo_stack", duration=1e-3, times=10**8, outputs="all")
    said = str(error.value)
    assert "simulate.times: a run of 100,000,000 samples takes" in said
    assert "store='run.zarr' (--out run.zarr)" in said
    assert float(re.search(r"takes (\d+) GB", said)[1]) == pytest.approx(size / 10, rel=0.1)
    most = int(re.search(r"at most ([\d,]+) in memory", said)[1].replace(",", ""))
    assert most * size == pytest.approx(8e9, rel=0.1)


def test_a_hundred_thousand_hysterons_run():
    """More lanes than one step's vectors, in a run and in a sweep."""
    given = {"duration": 1e-6, "times": 2, "parameters": {"hysteron_count": 100_000}}
    run = piezo_sym.simulate("piezo_stack", **given)
    assert run.phi.shape == (2, 100_000)
    assert sweep("piezo_stack", over={"d": [1.0, 2.0]}, **given).sizes["hysteron"] == 100_000


def test_a_run_whose_times_cannot_be_told_apart_is_refused(piezo):
    with pytest.raises(UsageError, match=r"simulate.duration: 5e-324 is too small"):
        simulate(piezo, duration=5e-324)
    with pytest.raises(UsageError, match=r"simulate.t0: times from t0 = 1e\+20 s on cannot be"):
        simulate(piezo, duration=1e-3, t0=1e20)
