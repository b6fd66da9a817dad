"""What a sweep refuses, in one line, before anything runs; and runs that fail."""

import re

import numpy as np
import pytest

from piezo_sym import ramp, simulate, sine, step, sweep
from piezo_sym.errors import FileError, RunError, UsageError
from piezo_sym.sweeps import SweepWarning
from piezo_sym.sweeps.axes import Target, find

NAN, INF = float("nan"), float("inf")

REFUSED = [
    ({"over": {}}, "sweep.over: '{}' sweeps nothing"),
    ({"over": [1]}, "sweep.over: '[1]' is no map"),
    ({"over": {"lamb": [1]}}, "unknown name 'lamb'; did you mean 'lam'"),
    ({"over": {"inputs.L": [1]}}, "unknown name 'inputs.L'; did you mean"),
    ({"over": {3: [1]}}, "unknown name 3"),
    ({"over": {(): [1]}}, "a key names nothing"),
    ({"over": {"L": []}}, "sweep.over.L: there are no values"),
    ({"over": {"L": 1e-3}}, "sweep.over.L: 0.001 is no list of values; expected a list"),
    ({"over": {"L": "abc"}}, "sweep.over.L: 'abc' is no list of values"),
    ({"over": {"L": [1e-3, NAN]}}, "sweep.over.L[1]: nan is not a finite number"),
    ({"over": {"L": np.array([1e-3, INF])}}, "sweep.over.L[1]: inf is not a finite"),
    ({"over": {"L": [True]}}, "sweep.over.L[0]: 'True' is not a finite number"),
    ({"over": {"L": ["1"]}}, "sweep.over.L[0]: '1' is not a finite number"),
    ({"over": {"M": [[1, 2]]}}, "sweep.over.M[0]: '[1, 2]' is a list; expected one number"),
    ({"over": {"L": [[1e-3] * 3]}}, "sweep.over.L[0]: 3 values for 2 lanes"),
    ({"over": {"phi": [[0.0] * 3]}}, "sweep.over.phi[0]: 3 values for 2 lanes"),
    (
        {"over": {"L": [[1e-3] * 2], "hysteron_count": [1, 2]}},
        "sweep.over.L[0]: 2 values for 1, 2 lanes; expected one per lane; zip both",
    ),
    ({"over": {("L", "hysteron_count"): [([1, 1], 3)]}}, "2 values for 3 lanes"),
    ({"over": {"hysteron_count": [1, 0]}}, "sweep.over.hysteron_count[1]: 0 is not allowed"),
    ({"over": {"hysteron_count": [1.5]}}, "1.5 is not allowed; expected a whole number"),
    (
        {"over": {"hysteron_count": [1, 2]}, "parameters": {"L": [1e-3, 1e-3]}},
        "sweep.parameters.L: 2 values for 1 lane",
    ),
    ({"over": {"V_in": ["x"]}}, "sweep.over.V_in[0]: 'x' is no input"),
    ({"over": {"V_in": [([0, 0.001], [0, 1])]}}, "samples span 0 s to 0.001 s"),
    ({"over": {"L": [1e-3], "parameters.L": [1e-3]}}, "'L' is swept twice"),
    ({"over": {"L": [1e-3]}, "parameters": {"L": 1}}, "'L' is swept and also given"),
    ({"over": {"V_in": [1]}, "inputs": {"V_in": 1}}, "'V_in' is swept and also given"),
    ({"over": {("L", "d"): [(1, 2), (1,)]}}, "sweep.over.L, d[1]: '(1,)' is no point"),
    ({"over": {("L", "d"): [1, 2]}}, "1 is no point; expected a tuple of 2 values"),
    ({"over": {"L": {"a": 1e-3, 2: 1e-3}}}, "label 'a' is mixed with others"),
    ({"parameters": {"x": 1}}, "sweep.parameters: unknown name 'x'"),
    ({"inputs": {"x": 1}}, "sweep.inputs: unknown name 'x'"),
    ({"initial": {"x": 1}}, "sweep.initial: unknown name 'x'"),
    ({"events": {"hit": "q"}}, "sweep.events: runs of a sweep have no events; leave it out, or"),
    ({"stop": "T_body > 350"}, "sweep.stop: runs of a sweep have no stop; leave it out, or call"),
    ({"outputs": "all"}, "sweep.outputs: runs of a sweep have no outputs; leave it out, or call"),
    ({"theads": 2}, "sweep: unknown argument 'theads'; did you mean 'threads'?"),
    ({"rtol": 1}, "sweep.rtol: 1 is out of range"),
    ({"step": -1}, "sweep.step: -1 is not positive"),
    ({"duration": 0}, "sweep.duration: 0 is not positive"),
    ({"times": 1}, "sweep.times: 1 is not allowed"),
    ({"method": "euler"}, "sweep.method: unknown method 'euler'"),
    ({"reduce": "max"}, "sweep.reduce: 'max' is no reduction; expected 'last', 'mean', or a"),
    ({"reduce_by": "all"}, "sweep.reduce_by: 'all' is not known"),
    ({"threads": 0}, "sweep.threads: 0 is not allowed"),
    ({"executor": 3}, "sweep.executor: 3 has no 'submit'"),
    ({"store": 3}, "sweep.store: 3 is no path; expected a path, as text or a Path"),
    ({"progress": 3}, "sweep.progress: 3 shows no progress"),
]


@pytest.mark.parametrize(("options", "message"), REFUSED, ids=[m for _, m in REFUSED])
def test_wrong_arguments_are_refused_in_one_line(options, message):
    with pytest.raises(UsageError) as raised:
        sweep("piezo_stack", **{"over": {"L": [1e-3]}, "duration": 0.01, **options})
    assert message in str(raised.value)
    assert "\n" not in str(raised.value)
    assert raised.value.exit_code == 2


def test_a_name_of_two_things_has_to_be_spelled_out(monkeypatch):
    two = (Target("parameters", "x", "1", "", None), Target("initial", "x", "1", "", None))
    monkeypatch.setattr("piezo_sym.sweeps.axes.targets", lambda _: iter(two))
    with pytest.raises(UsageError, match=r"'x' is a parameter and a state; write 'param"):
        find(None, "x", "sweep.over")
    assert find(None, "initial.x", "sweep.over") == two[1]


def test_a_coordinate_with_the_name_of_a_quantity_is_refused(tmp_path):
    text = """
    [model]
    name = "clash"
    [parameters]
    error = { value = 4.0, unit = "N/m" }
    [elements]
    s = { kind = "spring", between = ["tip", "wall"], stiffness = "error", state = "q" }
    m = { kind = "mass", at = "tip", mass = "1.0*kg", state = "p" }
    """
    path = tmp_path / "clash.toml"
    path.write_text(text.replace('"1.0*kg"', '"m"').replace("error =", _mass("error")))
    with pytest.raises(UsageError, match="coordinate 'error' has the name of another quantity"):
        sweep(path, over={"error": [1.0, 2.0]}, duration=0.01)


def _mass(name):
    return f'm = {{ value = 1.0, unit = "kg" }}\n    {name} ='


def test_an_unknown_model_is_refused(tmp_path):
    with pytest.raises(FileError):
        sweep(tmp_path / "none.toml", over={"L": [1]}, duration=0.01)


def reason(**options):
    """Return why a single run fails."""
    with pytest.raises(RunError) as raised:
        simulate("piezo_stack", method="discrete_gradient", **options)
    return str(raised.value)


def test_a_start_outside_the_domain_fails_its_runs_alone():
    over = {"d": [400.0, -1.0], "L": [1e-3, 2e-3]}
    with pytest.warns(SweepWarning, match=r"^2 of 4 runs failed, see 'error'; the first: model"):
        found = sweep("piezo_stack", over=over, duration=0.01, times=3)
    message = reason(duration=0.01, parameters={"d": -1.0})
    assert (found.error.sel(d=-1.0) == message).all()
    assert (found.error.sel(d=400.0) == "").all()
    for name in set(found.data_vars) - {"error", "V_in", "F_ext", "T_e"}:
        assert np.isnan(found[name].sel(d=-1.0)).all(), name
        assert np.isfinite(found[name].sel(d=400.0)).all(), name


def test_runs_beside_one_that_cannot_start_have_their_own_parameters():
    inductances = [1e-3, (1e-3, 2e-3), 3e-3, (5e-4, 4e-3)]
    over = {("L", "d"): list(zip(inductances, [400.0, 300.0, -1.0, 200.0], strict=True))}
    drive = {"inputs": {"V_in": sine(100, 100)}, "duration": 0.01, "times": 3}
    with pytest.warns(SweepWarning, match="1 of 4 runs failed"):
        found = sweep("piezo_stack", over=over, **drive)
    for k, (lanes, damping) in enumerate(*over.values()):
        one = {"parameters": {"L": lanes, "d": damping}, **drive}
        if damping < 0:
            assert found.error.values[k] == reason(**one)
            continue
        alone = simulate("piezo_stack", method="discrete_gradient", **one)
        for name in ("q", "phi", "S", "heat_hysteron"):
            assert np.allclose(found[name].values[k], alone[name].values, rtol=1e-13, atol=0), name


OUTSIDE = [298.15, sine(2.0, 100.0, 298.15), step(0.005, 310.0, 298.15)]


@pytest.mark.parametrize("outside", OUTSIDE, ids=["constant", "sine", "step"])
def test_an_input_leaves_the_domain_of_one_run_and_not_of_another(outside):
    options = {"inputs": {"T_e": outside}, "duration": 0.01, "times": 3}
    options["initial"] = {"S": 0.5}  # warm enough to start for every T_0
    with pytest.warns(SweepWarning, match="1 of 2 runs failed"):
        found = sweep("piezo_stack", over={"T_0": [290.0, 299.0]}, **options)
    assert found.error.values[0] == ""
    assert found.error.values[1] == reason(**options, parameters={"T_0": 299.0})
    assert "'T_e > T_0'" in found.error.values[1]


@pytest.mark.parametrize("reduce", [None, "last", "mean", lambda run: run[["q"]]])
def test_a_run_that_stops_does_not_stop_others(reduce):
    parameters = {"lam": 2e4}  # the body follows its surroundings below T_0
    inputs = {"T_e": ramp(0.002, 0.004, 310.0, 299.0), "V_in": sine(100, 100)}
    options = {"inputs": inputs, "duration": 0.01, "times": 5}
    options["parameters"] = parameters
    cold = [296.15, 300.0, 295.0, 305.0, 298.0]
    with pytest.warns(SweepWarning, match="2 of 5 runs failed"):
        found = sweep("piezo_stack", over={"T_0": cold}, reduce=reduce, **options)
    assert (found.error.values != "").tolist() == [False, True, False, True, False]
    assert found.error.values[1] == reason(**options | {"parameters": {**parameters, "T_0": 300.0}})
    assert "condition 'T_e > T_0'" in found.error.values[1]
    assert np.isnan(found.q.values[[1, 3]]).all()
    options["parameters"] = {**parameters, "T_0": 298.0}
    alone = simulate("piezo_stack", method="discrete_gradient", **options)
    if reduce is None:
        np.testing.assert_allclose(found.q.values[4], alone.q.values, rtol=0, atol=1e-14)
    else:
        assert np.isfinite(found.q.values[[0, 2, 4]]).all()


@pytest.mark.parametrize("reduce", [None, "last", lambda run: run[["q"]]])
def test_all_runs_can_fail(reduce):
    with pytest.warns(SweepWarning, match="2 of 2 runs failed"):
        found = sweep("piezo_stack", over={"d": [-1.0, -2.0]}, duration=0.01, reduce=reduce)
    assert (found.error != "").all()


def test_the_message_of_a_failed_run_is_printable():
    with pytest.warns(SweepWarning) as warned:
        found = sweep("piezo_stack", over={"d": [-1.0]}, duration=0.01, times=3)
    assert re.fullmatch(r"[ -~]+", str(found.error.values[0]))
    assert len(warned) == 1
    assert warned[0].filename == __file__
