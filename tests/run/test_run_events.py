"""Events and stops against closed forms; runs from other times, and runs that go on."""

import re

import numpy as np
import pytest
import xarray
from scipy.optimize import brentq

from piezo_sym import load, simulate, sine
from piezo_sym.errors import InputWarning, RunError, UsageError
from piezo_sym.run import events, streaming
from tests.networks.test_acceptance import OSCILLATOR, TWO_BODIES

DRIVE = {"V_in": sine(100, 100)}
LENGTH = 5.0
#: The oscillator, in a domain that it leaves.
ENDS = (
    OSCILLATOR.read_text()
    .replace("assume = [", 'assume = ["q > q_m", ', 1)
    .replace("[domain]", '[parameters.q_m]\nvalue = -0.5\nunit = "m"\n[domain]', 1)
)


def swing(t: float) -> float:
    """q of the damped oscillator, m = 1, k = 4, d = 0.4, from q = 1."""
    w = np.sqrt(4 - 0.2**2)
    return float(np.exp(-0.2 * t) * (np.cos(w * t) + 0.2 / w * np.sin(w * t)))


@pytest.mark.parametrize(("method", "error"), [(None, 1e-9), ("DOP853", 1e-8)])
def test_events_of_an_oscillator(method, error):
    run = simulate(OSCILLATOR, duration=LENGTH, rtol=1e-11, method=method, events={"rest": "q"})
    roots = [brentq(swing, a, b, xtol=1e-15) for a, b in ((0.5, 1.2), (2, 3), (3.5, 4.5))]
    assert run.rest.values == pytest.approx(roots, abs=error)
    assert np.abs(run.q_at_rest.values).max() < 1e-15
    assert run.sizes["time"] == 1001
    plain = simulate(OSCILLATOR, duration=LENGTH, rtol=1e-11, method=method)
    assert np.array_equal(plain.q, run.q)  # looking changes no number
    assert run.rest.attrs["units"] == "s"
    assert run.q_at_rest.dims == ("rest",)
    assert run.attrs["accepted_steps"] == plain.attrs["accepted_steps"]


def test_a_run_stops_where_a_condition_first_holds():
    """A1: T_1 - T_2 = 60 exp(-lambda (1/c_1 + 1/c_2) t), lambda = 0.5, c = (2, 3)."""
    stop = "20 > T_hot - T_cold"
    model = load(TWO_BODIES)
    run = simulate(model, duration=20, rtol=1e-11, stop=stop, events={"half": "T_hot - 330"})
    end = float(run.time[-1])
    assert end == pytest.approx(np.log(3) / (0.5 * (1 / 2 + 1 / 3)), rel=1e-9)
    assert float(run.T_hot[-1] - run.T_cold[-1]) == pytest.approx(20, rel=1e-14)
    assert run.attrs["stopped"] == f"{stop} at t = {end:.9g} s"
    assert run.half.values[0] < end
    assert np.all(np.diff(run.time) > 0)
    assert np.abs(run.energy_residual).max() < 1e-12 * float(run.energy[0])


def test_a_run_of_many_steps_loses_no_event(monkeypatch):
    """Four looks per step, however many, unless they do not fit into the memory."""
    run = {"inputs": DRIVE, "duration": 1.0, "events": {"up": "q"}}
    monkeypatch.setattr(events, "MOST", 100)
    dense = simulate("piezo_stack", times=40_001, **run)
    signs = np.sign(dense.q.values)
    signs = signs[signs != 0]
    assert dense.sizes["up"] == np.count_nonzero(np.diff(signs)) > 150
    assert simulate("piezo_stack", times=2, **run).sizes["up"] == dense.sizes["up"]
    monkeypatch.setattr(events, "NUMBERS", 0)
    with pytest.warns(InputWarning, match="100 times in .* steps, so some may be missed"):
        assert simulate("piezo_stack", times=2, **run).sizes["up"] < dense.sizes["up"]


@pytest.mark.parametrize("options", [{}, pytest.param({"method": "LSODA"}, marks=pytest.mark.long)])
def test_a_run_ends_soon_after_it_stops(options):
    """However long it might have gone on, with the same states until then."""
    run = {"inputs": DRIVE, "stop": "T_body > 299", "times": np.linspace(0, 0.02, 41), **options}
    near, far = (simulate("piezo_stack", duration=t, **run) for t in (0.1, 1.0))
    assert far.time[-1] == pytest.approx(float(near.time[-1]), rel=1e-5)
    assert float(far.T_body[-1]) == pytest.approx(299, rel=1e-15)
    whole = simulate("piezo_stack", duration=1.0, **{**run, "stop": None})
    assert 20 < far.attrs["accepted_steps"] < whole.attrs["accepted_steps"] / 2
    assert np.array_equal(far.q[:-1], whole.q[: far.sizes["time"] - 1])


def test_a_stop_comes_before_what_would_fail():
    """The run would leave its domain, q < 2 mm, later."""
    model = load_text(ENDS)
    with pytest.raises(RunError, match="leaves the domain"):
        simulate(model, duration=LENGTH)
    run = simulate(model, duration=LENGTH, stop="q < -0.4", events={"rest": "q"})
    assert float(run.q[-1]) == pytest.approx(-0.4, rel=1e-14)
    assert run.sizes["rest"] == 1


@pytest.mark.parametrize("options", [{}, {"method": "DOP853"}, {"store": "run.zarr"}])
def test_events_before_a_failure_are_kept(options, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(streaming, "WINDOW", 2000)  # numbers: the run fails in its second window
    model = load_text(ENDS)
    watched = {"events": {"rest": "q", "never": "q - 2"}}
    with pytest.raises(RunError, match="leaves the domain") as plain:
        simulate(model, duration=LENGTH, **(options | {"store": None}))
    with pytest.raises(RunError, match="leaves the domain") as stopped:
        simulate(model, duration=LENGTH, **options, **watched)
    partial = stopped.value.partial
    said, known = (re.sub(r"margin \S+ ", "", str(e.value)) for e in (stopped, plain))
    assert said == known  # but for the margin, which is round-off of 0
    until = plain.value.partial.time.values  # the last is the end of a step, of another window
    assert partial.time.values == pytest.approx(until, rel=1e-9)
    assert partial.rest.values == pytest.approx([brentq(swing, 0.5, 1.2)], abs=1e-4)
    assert np.abs(partial.q_at_rest.values).max() < 1e-15
    assert partial.sizes["never"] == 0
    assert partial.attrs["stopped"] == str(stopped.value)


def test_an_input_that_jumps_is_an_event():
    drive = {"V_in": ([0, 0.005, 0.005, 0.01], [0, 0, 10, 10])}
    run = simulate("piezo_stack", inputs=drive, duration=0.01, events={"on": "V_in - 5"})
    assert run.on.values == pytest.approx([0.005], abs=1e-17)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"events": {"hit": "phi - 1"}}, "simulate.events.hit: events and stop know no 'phi'"),
        ({"stop": "heat_damper > 1"}, "quantity of an element, such as 'spring.effort'"),
        ({"stop": "spring.force > 1"}, "'spring.force'; expected a state, input, y_<port>"),
        ({"stop": "spring.force > 1"}, "'spring' has effort, flow, power, energy"),
        ({"stop": "sprin.effort > 1"}, "did you mean 'spring.effort'?"),
        ({"stop": "spring.effort > 1 +"}, "simulate.stop: 'spring.effort > 1 +' "),
        ({"stop": "spring.effort(2) > 1"}, "'spring.effort'"),
        ({"events": {"hit": "q.real"}}, "simulate.events.hit"),
        ({"events": {"hit": "__import__('os')"}}, "simulate.events.hit"),
        ({"events": {"q": "p"}}, "'q' cannot name an event"),
        ({"events": {"a b": "p"}}, "'a b' cannot name an event"),
        ({"events": "q"}, "simulate.events: 'q' is no mapping"),
        ({"events": {"hit": 3}}, "3 is no text; expected text such as"),
        ({"stop": "q"}, "simulate.stop"),
        ({"stop": "q > 1", "step": 1e-5}, "with a fixed step, events are not located"),
        ({"stop": "q < 1"}, "the condition holds at t = 0 s already"),
        ({"t0": "now"}, "simulate.t0"),
    ],
)
def test_what_cannot_be_looked_for_is_one_line(options, said):
    with pytest.raises(UsageError) as error:
        simulate("piezo_stack", duration=1e-3, **options)
    assert said in str(error.value)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"events": {"mixed": "q - T_body"}}, "simulate.events.mixed: adds or compares what has"),
        ({"stop": "q > T_body"}, "different units: q in m, T_body in K; expected equal units"),
        ({"stop": "min(q - T_body, p) > 0"}, "different units: q in m, T_body in K"),
        ({"events": {"mixed": "damper.power - d*y_load"}}, "damper.power in W, d in "),
    ],
)
def test_quantities_of_different_units_are_not_compared(options, said):
    with pytest.raises(UsageError, match=re.escape(said)):
        simulate("piezo_stack", duration=1e-3, **options)


@pytest.mark.parametrize(
    "text",
    [
        "q - 1e-3",
        "damper.power - d*y_load**2",
        "spring.effort - k*q + 0.1*T_body",
        "1000*q - T_body",
    ],
)
def test_a_number_may_have_any_unit(text):
    simulate("piezo_stack", duration=1e-4, times=2, events={"fine": text})


def test_a_run_starts_at_another_time():
    late = simulate("piezo_stack", inputs=DRIVE, duration=0.01, t0=0.0025, rtol=1e-9)
    assert late.time.values[[0, -1]].tolist() == [0.0025, 0.0125]
    shifted = {"V_in": lambda t: 100 * np.sin(200 * np.pi * (t + 0.0025))}
    same = simulate("piezo_stack", inputs=shifted, duration=0.01, rtol=1e-9)
    for name in ("q", "p", "S", "V_in", "supplied_supply"):
        size = float(np.abs(same[name]).max())
        assert np.abs(late[name].values - same[name].values).max() < 1e-7 * size


@pytest.mark.parametrize("options", [{"step": 1e-5}, {"step": 1e-5, "order": 6}])
def test_a_run_goes_on_where_another_ended(options, tmp_path):
    given = {"inputs": DRIVE, "parameters": {"d": 300.0, "L": [1e-3, 2e-3]}, **options}
    whole = simulate("piezo_stack", duration=0.02, **given)
    first = simulate("piezo_stack", duration=0.01, **given)
    first.to_netcdf(tmp_path / "first.nc", engine="scipy")
    with xarray.open_dataset(tmp_path / "first.nc", engine="scipy") as kept:
        second = simulate("piezo_stack", duration=0.01, inputs=DRIVE, initial=kept, **options)
    assert second.time.values[[0, -1]].tolist() == [0.01, 0.02]
    for name in ("q", "p", "Q_C", "phi", "S"):
        assert np.array_equal(second[name][0], first[name][-1])  # to the bit
        size = float(np.abs(whole[name]).max())
        assert np.abs(whole[name][-1] - second[name][-1]).max() < 1e-14 * size
    assert second.attrs["parameter_d"] == 300.0
    assert second.supplied_supply[0] == 0
    rest = {"duration": 1e-3, "inputs": DRIVE, "parameters": {"d": 1.0}}
    changed = simulate("piezo_stack", initial=first, t0=0, **rest)
    assert (changed.attrs["parameter_d"], changed.time[0]) == (1.0, 0.0)


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("q > 0.5 and p > 0", "min(q - 0.5, p)"),
        ("(q > 0.5) and (0 >= p)", "min(q - 0.5, 0 - p)"),
        ("q > 0.5 && p > 0 || T_body < 3", "max(min(q - 0.5, p), 3 - T_body)"),
        ("spring.effort > 1 | p > 1 | q > 1", "max(spring.effort - 1, max(p - 1, q - 1))"),
        ("1 < spring.effort < 2", "min(spring.effort - 1, 2 - spring.effort)"),
    ],
)
def test_several_conditions_are_told_the_law_to_write(text, meant):
    for given, form in (({"stop": text}, "{} > 0"), ({"events": {"hit": text}}, "{}")):
        with pytest.raises(UsageError) as error:
            simulate("piezo_stack", duration=1e-3, **given)
        said = form.format(meant)
        assert error.value.remedy == f"write '{said}'"
        again = {"stop": said} if "stop" in given else {"events": {"hit": said}}
        simulate("piezo_stack", duration=1e-4, **again)


@pytest.mark.parametrize("store", [False, True])
def test_quantities_of_elements_are_watched(store, tmp_path):
    at = {"store": tmp_path / "run.zarr"} if store else {}
    laws = {"by_name": "spring.effort - 2", "by_law": "k*(q - q_l) - 2", "lane": "hysteron.heat_2"}
    given = {"inputs": {"V_in": 100.0}, "duration": 0.01, "parameters": {"d": 300.0}}
    run = simulate("piezo_stack", events=laws, stop="damper.heat < -1", **given, **at)
    assert run.by_name.size > 0
    assert np.array_equal(run.by_name, run.by_law)
    ended = simulate("piezo_stack", stop="spring.effort > 2", **given)
    assert ended.time[-1] == run.by_name[0]
    assert ended.attrs["stopped"].startswith("spring.effort > 2 at t = ")


def test_an_instant_of_a_run_is_a_start():
    given = {"inputs": DRIVE, "parameters": {"d": 300.0, "L": [1e-3, 2e-3]}}
    first = simulate("piezo_stack", duration=0.01, **given)
    goes_on = {"duration": 0.01, "inputs": DRIVE}
    whole = simulate("piezo_stack", initial=first, **goes_on)
    end = simulate("piezo_stack", initial=first.isel(time=-1), progress=True, **goes_on)
    assert end.identical(whole)  # to the bit, with its parameters
    middle = simulate("piezo_stack", initial=first.isel(time=500), **goes_on)
    assert middle.time[0] == first.time[500]
    assert np.array_equal(middle.phi[0], first.phi[500])


@pytest.mark.filterwarnings("ignore:.generated/piezo_stack. is not what")
def test_a_run_of_another_model_is_refused():
    other = simulate(OSCILLATOR, duration=1.0)
    with pytest.raises(UsageError, match=r"a run of model 'damped_oscillator', spec [0-9a-f]+"):
        simulate("piezo_stack", duration=1e-3, initial=other)
    changed = load("piezo_stack").to_toml().replace("3.5e-3", "3.6e-3").replace("0.0035", "0.0036")
    run = simulate("piezo_stack", duration=1e-3)
    with pytest.raises(UsageError, match="expected one of model 'piezo_stack', spec"):
        simulate(load_text(changed), duration=1e-3, initial=run)
    with pytest.raises(UsageError, match="expected one of model 'piezo_stack', spec"):
        simulate(load_text(changed), duration=1e-3, initial=run.isel(time=-1))
    for none in (xarray.Dataset(), run.isel(time=[]), run.drop_vars("time")):
        with pytest.raises(UsageError, match="no run of simulate"):
            simulate("piezo_stack", duration=1e-3, initial=none)


def load_text(text: str):
    import tomllib

    from piezo_sym import Model

    return Model(**tomllib.loads(text))


def test_parameters_of_banks_are_watched_lane_by_lane():
    given = {
        "inputs": {"V_in": sine(100.0, 100.0)},
        "duration": 0.02,
        "parameters": {"L": [1e-3, 2e-3]},
    }
    run = simulate("piezo_stack", events={"by_name": "phi_2/L_2 - i_0_2"}, **given)
    same = simulate("piezo_stack", events={"by_number": "phi_2/(2/1000) - 1/2"}, **given)
    assert run.by_name.size > 0
    assert np.allclose(run.by_name, same.by_number, rtol=1e-12)


#: A stop that a ramp pushes against, and how its effort comes to its limit and stays there.
PUSHED = """
[model]
name = "pushed"
[parameters]
k = { value = 3.0, unit = "N/m" }
F_c = { value = 0.7, unit = "N" }
T_0 = { value = 300.0, unit = "K" }
c = { value = 1.0, unit = "J/K" }
[inputs]
v_in = { unit = "m/s" }
[elements]
drive = { kind = "velocity_source", at = "tip", input = "v_in" }
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
[elements.block]
kind = "stop"
between = ["tip", "wall"]
stiffness = "k"
limit = "F_c"
heats = "body"
state = "z"
"""


@pytest.mark.parametrize(
    "stop", ["block.effort >= block.limit", "block.effort >= 0.7", "F_c <= k*z"]
)
def test_a_condition_that_holds_with_equality_is_met(stop):
    run = simulate(load_text(PUSHED), inputs={"v_in": 0.5}, duration=1.0, stop=stop)
    assert float(run.time[-1]) == pytest.approx(0.7 / 3.0 / 0.5, rel=1e-9)


def test_one_without_equality_is_not_met_at_its_edge():
    run = simulate(
        load_text(PUSHED), inputs={"v_in": ([0, 1, 2], [0, 1, 1])}, duration=2.0, stop="v_in > 1"
    )
    assert "stopped" not in run.attrs or not run.attrs["stopped"]
    run = simulate(
        load_text(PUSHED), inputs={"v_in": ([0, 1, 2], [0, 1, 1])}, duration=2.0, stop="v_in >= 1"
    )
    assert float(run.time[-1]) == pytest.approx(1.0, rel=1e-12)


def test_one_that_holds_with_equality_at_the_start_holds_already():
    with pytest.raises(UsageError, match="holds at t = 0 s already"):
        simulate(load_text(PUSHED), inputs={"v_in": 0.5}, duration=1.0, stop="z >= 0")


def test_a_comparison_inside_a_choice_does_not_close_the_condition():
    held = {"v_in": ([0, 1, 2], [0, 0, 1])}
    run = simulate(load_text(PUSHED), inputs=held, duration=2.0, stop="(z if z >= 0 else 0) > 0")
    assert float(run.time[-1]) == pytest.approx(1.0, abs=1e-3)


def test_a_condition_that_a_jump_meets_between_two_windows_ends_the_run(tmp_path, monkeypatch):
    monkeypatch.setattr(streaming, "WINDOW", 1)  # two samples each: windows meet at 0.2, 0.4, ...
    how = {"duration": 2.0, "times": 21, "events": {"far": "z - 1"}, "stop": "v_in >= 0"}
    for jump in (0.9, 1.0):
        speed = ([0, jump, jump, 2], [-1, -1, 1, 1])
        store = tmp_path / f"{jump}.zarr"
        run = simulate(load_text(PUSHED), inputs={"v_in": speed}, store=store, **how)
        assert float(run.time[-1]) == pytest.approx(jump, abs=1e-12)
        assert "v_in >= 0 at t" in run.attrs["stopped"]
