"""Periodic steady states against a closed form, against long runs, and what is refused."""

import warnings
from types import SimpleNamespace

import numpy as np
import pytest

from piezo_sym import (
    load,
    periodic_steady_state,
    periodic_steady_states,
    samples,
    simulate,
    sine,
    step,
    triangle,
)
from piezo_sym.analysis import loops, steady
from piezo_sym.analysis.balance import SteadyWarning, settled
from piezo_sym.analysis.stroboscope import Stroboscope, stroboscope
from piezo_sym.errors import EngineError, RunError, UsageError
from piezo_sym.spec.load import parse

HEATER = """
[model]
name = "heater"
[parameters]
R   = { value = 5.0, unit = "ohm" }
T_0 = { value = 300.0, unit = "K" }
c   = { value = 0.02, unit = "J/K" }
lam = { value = 0.5, unit = "W/K" }
[inputs]
V   = { unit = "V" }
T_e = { unit = "K", default = 290.0 }
[domain]
assume = ["R > 0", "lam >= 0", "T_e > 0"]
[initial]
S = "c*log(T_e/T_0)"
[elements]
supply = { kind = "voltage_source", between = ["in", "gnd"], input = "V" }
heater = { kind = "resistor", between = ["in", "gnd"], current = "v/R", heats = "body" }
body   = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
air    = { kind = "ambient", body = "body", conductance = "lam", input = "T_e" }
"""
R, C, LAM, T_E, V, F = 5.0, 0.02, 0.5, 290.0, 20.0, 3.0


@pytest.fixture(scope="module")
def heater(module):
    return module(HEATER)


def test_a_heated_body_against_its_closed_form(heater):
    """c dT/dt = V^2/(2R) (1 - cos 2wt) - lam (T - T_e): mean, swing and decay are known."""
    found = steady.periodic_steady_state(heater, inputs={"V": sine(V, F)}, frequency=F, rtol=1e-7)
    power = V**2 / (2 * R)
    swing = power / np.hypot(LAM, 2 * 2 * np.pi * F * C)
    assert found.temperature == pytest.approx(T_E + power / LAM, rel=1e-8)
    assert found.hottest == pytest.approx(T_E + power / LAM + swing, abs=1e-3 * swing)
    assert found.coldest == pytest.approx(T_E + power / LAM - swing, abs=1e-3 * swing)
    assert found.loss == pytest.approx(power / F, rel=1e-6)
    assert found.multiplier == pytest.approx(np.exp(-LAM / (C * F)), rel=2e-3)
    assert found.stable
    assert found.residual < 1e-6


def test_a_hot_start_cools_to_the_same_state(heater):
    drive = {"inputs": {"V": sine(V, F)}, "frequency": F}
    found = steady.periodic_steady_state(heater, initial={"S": C * np.log(900 / 300)}, **drive)
    assert found.temperature == pytest.approx(T_E + V**2 / (2 * R * LAM), rel=1e-6)
    (only,) = steady.periodic_steady_states(heater, **drive)
    assert only.temperature == pytest.approx(found.temperature, rel=1e-6)


def test_a_body_that_starts_over_the_environment_cools_below_its_start(module):
    warm = module(HEATER.replace("log(T_e/T_0)", "log(2*T_e/T_0)"))
    found = steady.periodic_steady_state(warm, inputs={"V": sine(V, F)}, frequency=F)
    assert found.temperature == pytest.approx(T_E + V**2 / (2 * R * LAM), rel=1e-6)


def test_constant_inputs_have_an_equilibrium(heater):
    found = steady.periodic_steady_state(heater, inputs={"V": 20.0}, frequency=1.0)
    assert found.temperature == pytest.approx(T_E + 400 / (R * LAM), rel=1e-6)
    assert found.hottest - found.coldest < 1e-5


@pytest.mark.parametrize(
    ("wave", "mean_square"),
    [
        (triangle(V, F), V**2 / 3),
        (samples([0, 0.5 / F, 1 / F], [0.0, V, 0.0]), V**2 / 3),
        (lambda t: V * np.cos(2 * np.pi * F * t), V**2 / 2),
    ],
)
def test_any_input_that_repeats(heater, wave, mean_square):
    found = steady.periodic_steady_state(heater, inputs={"V": wave}, frequency=F, rtol=1e-5)
    assert found.temperature == pytest.approx(T_E + mean_square / (R * LAM), rel=2e-5)


@pytest.mark.some(1)
@pytest.mark.parametrize("turns", [2, 100, 512, 1024])
def test_a_drive_of_many_turns_a_period_is_not_overlooked(heater, turns):
    """256 steps, 512 too, would look at a sine of 512 turns at its zeros alone."""
    drive = {"V": sine(V, turns * 1.0)}
    found = steady.periodic_steady_state(heater, inputs=drive, frequency=1.0, rtol=1e-5)
    assert found.temperature == pytest.approx(T_E + V**2 / (2 * R * LAM), rel=1e-5)
    assert found.residual < 1e-4


def test_a_drive_that_moves_too_fast_is_refused(heater):
    with pytest.raises(UsageError, match=r"'V' needs more than 16384 steps in 1 s; .* in common"):
        steady.periodic_steady_state(heater, inputs={"V": sine(V, 5000)}, frequency=1.0)


def test_a_state_that_does_not_repeat_is_refused(heater, monkeypatch):
    """As it was before the steps looked at the inputs: an overlooked drive found at the end."""
    monkeypatch.setattr(
        "piezo_sym.analysis.stroboscope.steps_needed", lambda _inputs, _f, steps: steps
    )
    with pytest.raises(RunError, match=r"does not repeat: it is off by .* after a period"):
        steady.periodic_steady_state(heater, inputs={"V": sine(V, 512)}, frequency=1.0)


def test_two_inputs_repeat_with_the_frequency_they_have_in_common():
    """50 Hz and 75 Hz: a period of 25 Hz, which another solver follows back to its start."""
    drive = {"V_in": sine(60, 50), "F_ext": sine(200, 75)}
    found = periodic_steady_state("piezo_stack", inputs=drive, frequency=25)
    heat = 2.0 * (found.temperature - 298.15) / 25
    assert found.loss == pytest.approx(heat, rel=1e-5)
    run = simulate(
        "piezo_stack",
        inputs=drive,
        initial=found.initial,
        duration=1 / 25,
        times=[1 / 25],
        rtol=1e-9,
        method="LSODA",
    )
    for name in ("q", "p", "Q_C", "phi", "S"):
        size = float(np.abs(found.orbit[name]).max())
        assert np.abs(run[name].values[-1] - found.initial[name]).max() < 3e-6 * size


@pytest.mark.parametrize(("other", "frequency"), [(75, 50), (50 * 2**0.5, 50), (75, 75)])
def test_inputs_that_do_not_repeat_together_are_refused(other, frequency):
    drive = {"V_in": sine(60, 50), "F_ext": sine(200, other)}
    with pytest.raises(UsageError, match=r"does not repeat after .* have in common"):
        periodic_steady_state("piezo_stack", inputs=drive, frequency=frequency)


def test_heat_that_no_one_takes_away_has_no_steady_state(module):
    alone = "\n".join(line for line in HEATER.splitlines() if not line.startswith("air"))
    alone = alone.replace('T_e = { unit = "K", default = 290.0 }\n', "").replace(', "T_e > 0"', "")
    closed = module(alone.replace('S = "c*log(T_e/T_0)"', "S = 0.0"))
    with pytest.raises(RunError, match=r"the body heats at every temperature between 300 K"):
        steady.periodic_steady_state(closed, inputs={"V": sine(V, F)}, frequency=F)


@pytest.mark.some(1)
@pytest.mark.parametrize(
    ("L", "frequency", "expected", "tolerance"),
    [
        (1e-3, 10, 299.84, 0.01),
        (1e-3, 50, 354.1, 0.05),
        (1e-3, 70, 3604, 10),
        (1e-3, 100, 2722, 0.5),
        (5e-3, 100, 1066.8, 0.2),
    ],
)
def test_settled_temperatures_of_the_actuator(L, frequency, expected, tolerance):
    """ACCEPTANCE, case P: fixed-step runs of 40 s by another program."""
    found = periodic_steady_state(
        "piezo_stack",
        inputs={"V_in": sine(100, frequency)},
        frequency=frequency,
        parameters={"L": L},
    )
    assert abs(found.temperature - expected) < tolerance
    assert found.stable
    assert found.residual < 2e-6


@pytest.fixture(scope="module")
def at_50():
    return periodic_steady_states("piezo_stack", inputs={"V_in": sine(100, 50)}, frequency=50)


def test_all_branches_are_found(at_50):
    assert [state.stable for state in at_50] == [True, False, True]
    assert [state.temperature for state in at_50] == sorted(state.temperature for state in at_50)
    assert at_50[0].multiplier < 1 < at_50[1].multiplier


def test_heat_and_cooling_of_a_cycle_balance(at_50):
    for state in at_50:
        assert state.loss == pytest.approx(2.0 * (state.temperature - 298.15) / 50, rel=4e-6)


def test_the_area_of_voltage_over_charge_is_the_heat_of_a_cycle(at_50):
    """With F_ext = 0 all energy comes through V_in, and leaves as heat."""
    for state in (at_50[0], at_50[2]):
        run = simulate(
            "piezo_stack",
            inputs={"V_in": sine(100, 50)},
            initial=state.initial,
            duration=0.02,
            times=4001,
            rtol=1e-8,
            method="discrete_gradient",
        )
        area = loops.area(run.V_in.values, loops.drawn(run, "supply").values)
        heat = float(run.heat_hysteron[-1].sum() + run.heat_damper[-1])
        assert area == pytest.approx(heat, rel=3e-6)
        assert area == pytest.approx(state.loss, rel=1e-5)
        assert area == pytest.approx(float(run.supplied_supply[-1]), rel=3e-6)


def test_an_orbit_repeats_itself(at_50):
    for state in at_50:
        orbit = state.orbit
        for name in ("q", "p", "Q_C", "phi", "S"):
            values = orbit[name].values
            assert np.abs(values[-1] - values[0]).max() < 3e-6 * np.abs(values).max()


@pytest.mark.parametrize(("factor", "way"), [(0.98, -1), (1.02, 1)])
def test_the_unstable_state_parts_runs(at_50, factor, way):
    """One that starts a little colder cools, one that starts a little hotter runs away."""
    middle = at_50[1]
    start = {**middle.initial, "S": middle.initial["S"] + 5 * np.log(factor)}
    run = simulate(
        "piezo_stack",
        inputs={"V_in": sine(100, 50)},
        initial=start,
        duration=1.0,
        times=[0.02, 1.0],
        rtol=1e-5,
        method="discrete_gradient",
    )
    assert way * float(run.T_body[-1] - run.T_body[0]) > 5


def test_a_long_run_ends_there():
    run = simulate(
        "piezo_stack",
        inputs={"V_in": sine(100, 10)},
        initial={"S": 5 * np.log(299.8 / 296.15)},
        duration=20.0,
        times=[20.0],
        rtol=1e-4,
        method="discrete_gradient",
    )
    found = periodic_steady_state("piezo_stack", inputs={"V_in": sine(100, 10)}, frequency=10)
    for name in ("q", "p", "Q_C", "S"):
        size = float(np.abs(found.orbit[name]).max())
        assert float(run[name][-1]) == pytest.approx(found.initial[name], abs=1e-4 * size)


@pytest.mark.parametrize(
    "which", [pytest.param(0, id="cool"), pytest.param(2, id="hot", marks=pytest.mark.long)]
)
def test_another_solver_finds_the_same_orbit(at_50, which):
    state = at_50[which]
    drive = {"inputs": {"V_in": sine(100, 50)}, "initial": state.initial, "duration": 0.02}
    run = simulate("piezo_stack", **drive, times=[0.02], rtol=1e-9, method="LSODA")
    for name in ("q", "p", "Q_C", "phi", "S"):
        size = float(np.abs(state.orbit[name]).max())
        assert np.abs(run[name].values[-1] - state.initial[name]).max() < 2e-6 * size


@pytest.mark.long
def test_a_tiny_heat_capacity_is_no_obstacle(module):
    small = module(HEATER.replace("value = 0.02", "value = 1e-7"))
    found = steady.periodic_steady_state(small, inputs={"V": 20.0}, frequency=1.0, rtol=1e-3)
    assert found.temperature == pytest.approx(T_E + 400 / (R * LAM), rel=1e-6)


def test_where_nothing_heats_or_cools_every_temperature_is_steady():
    """An oscillator at rest, without an ambient: one state is its start, all are a continuum."""
    model = load("tests/networks/specs/a2_oscillator.toml")
    rest = {"inputs": {}, "frequency": 1.0, "initial": {"q": 0.0}}
    found = periodic_steady_state(model, **rest)
    assert found.temperature == pytest.approx(300.0)
    assert found.residual == 0
    with pytest.raises(RunError, match=r"any temperature from 300 K to 300\.03 K is steady"):
        periodic_steady_states(model, **rest)


def test_a_neutral_motion_is_no_obstacle():
    """At 1 Hz the currents stay in the dead zone: their difference neither grows nor decays."""
    found = periodic_steady_state("piezo_stack", inputs={"V_in": sine(100, 1)}, frequency=1)
    assert found.stable
    assert found.multiplier == pytest.approx(1.0, abs=1e-6)
    assert found.temperature == pytest.approx(298.166, abs=1e-3)


@pytest.mark.long
def test_equal_hysterons_settle_as_one():
    def settles(**parameters):
        return periodic_steady_state(
            "piezo_stack",
            inputs={"V_in": sine(100, 50)},
            frequency=50,
            parameters=parameters,
            temperatures=(298.15, 600),
        ).temperature

    one = settles(hysteron_count=1, L=5e-4, rho=5.0, i_0=1.0)
    assert one == pytest.approx(
        settles(), rel=1e-6
    )  # two equal hysterons are one with half of each
    many = settles(hysteron_count=8, L=4e-3, rho=40.0, i_0=0.125)
    assert many == pytest.approx(one, rel=1e-6)


def test_the_settled_state_repeats_but_for_its_entropy(stack):
    drive = {"V_in": sine(100, 50)}
    strobe = stroboscope(stack, lambda _: drive, 50, None, None, 256)
    found = settled(strobe, 350.0, strobe.start)
    assert strobe.temperature(found.x) == pytest.approx(350.0, rel=1e-12)
    again = strobe.look(found.x)
    assert np.abs((again.end - found.x)[:-1] / again.size[:-1]).max() < 1e-7
    assert again.end[-1] - found.x[-1] == pytest.approx(found.drift, rel=1e-9)


STACK = {"inputs": {"V_in": sine(100, 50)}, "frequency": 50}


@pytest.mark.parametrize(
    ("temperatures", "said"),
    [
        ((400, 500), "the body cools at every temperature between 400 K and 500 K at t = 0; give"),
        ((330, 340), "the body heats at every temperature between 330 K and 340 K at t = 0; let"),
        ((400, 5000), "the body cools at 400 K, where the range ends, at t = 0; give a wider"),
    ],
)
def test_a_range_without_a_steady_state_is_named_as_it_was_asked_for(temperatures, said):
    """At 50 Hz they are at 354 K, 1236 K (unstable) and 4750 K; a run starts at 298 K."""
    with pytest.raises(RunError) as error:
        periodic_steady_state("piezo_stack", **STACK, temperatures=temperatures)
    assert said in str(error.value)


def test_a_steady_state_is_short_to_read(at_50):
    for state, kind in zip(at_50, ("stable", "unstable", "stable"), strict=True):
        assert repr(state) == f"SteadyState({state.temperature:.6g} K at 50 Hz, {kind})"


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"frequency": 40}, "'V_in' does not repeat after 0.025 s"),
        ({"frequency": 0}, "is not positive"),
        ({"inputs": {"V_in": step(0.01, 0, 100)}}, "'V_in' does not repeat"),
        ({"inputs": {"V": 1.0}}, "unknown name 'V'"),
        ({"inputs": {"V_in": samples([0, 1], [0, 1])}}, "'V_in' does not repeat"),
        ({"initial": {"z": 1.0}}, "unknown name 'z'"),
        ({"initial": {"S": float("nan")}}, "^periodic_steady_state.initial.S: nan is not"),
        ({"parameters": {"LL": 1.0}}, "^periodic_steady_state.parameters: unknown name 'LL'"),
        ({"rtol": 1e-12}, "out of range"),
        ({"temperatures": (400, 300)}, "no range"),
        ({"temperatures": (300,)}, "no range"),
        ({"temperatures": 300}, "300 is no range; expected two numbers above 0 in K"),
    ],
)
def test_a_wrong_argument_is_one_line(changed, said):
    with pytest.raises(UsageError, match=said) as error:
        periodic_steady_state("piezo_stack", **{**STACK, **changed})
    assert len(str(error.value).splitlines()) == 1


@pytest.mark.long
@pytest.mark.filterwarnings("ignore:nothing settles")
def test_constant_inputs_may_lead_to_no_state_of_rest():
    with pytest.raises(RunError, match=r"at 100 Hz: no(thing settles| periodic steady state)"):
        periodic_steady_state("piezo_stack", inputs={"V_in": 100.0}, frequency=100.0)
    assert periodic_steady_states("piezo_stack", inputs={"V_in": 100.0}, frequency=100.0) == ()


def test_no_inputs_are_the_defaults():
    found = periodic_steady_state("piezo_stack", inputs=None, frequency=10.0)
    assert found.temperature == pytest.approx(298.15, rel=1e-12)


def test_a_start_outside_the_domain_says_so():
    with pytest.raises(RunError, match="start is outside the domain"):
        periodic_steady_state("piezo_stack", **STACK, parameters={"L": -1.0})


@pytest.mark.usefixtures("no_compiler")
def test_without_a_compiler_there_is_none(heater):
    with pytest.raises(EngineError, match="no C compiler is found"):
        steady.periodic_steady_state(heater, inputs={"V": sine(V, F)}, frequency=F)


@pytest.mark.parametrize(("spec", "bodies"), [("a1_two_bodies", 2)])
def test_a_model_without_exactly_one_body_is_refused(spec, bodies):
    model = load(f"tests/networks/specs/{spec}.toml")
    with pytest.raises(
        UsageError, match=f"has {bodies} bodies; expected a model with one body; simulate"
    ):
        periodic_steady_state(model, inputs={}, frequency=1.0)


def test_what_does_not_settle_is_said(stack):
    """A start far outside what can be integrated: the part of the range that fails is named."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        found = steady.periodic_steady_states(
            stack, inputs={"V_in": sine(100, 50)}, frequency=50, temperatures=(250.0, 400.0)
        )
    assert any(issubclass(one.category, SteadyWarning) for one in caught)
    assert "nothing settles at" in str(caught[0].message)
    assert [round(state.temperature) for state in found] == [354]


PARALLEL = """
[model]
name = "parallel"
[parameters]
m   = { value = 0.2,  unit = "kg" }
k   = { value = 800.0, unit = "N/m" }
k_c = { value = 1e5,  unit = "N/m" }
gap = { value = 5e-3, unit = "m" }
d   = { value = 30.0, unit = "N*s/m" }
T_0 = { value = 293.15, unit = "K" }
c   = { value = 30.0, unit = "J/K" }
lam = { value = 0.5,  unit = "W/K" }
[inputs]
F   = { unit = "N" }
T_e = { unit = "K", default = 293.15 }
[domain]
assume = ["d >= 0", "lam >= 0", "T_e > 0"]
[elements]
spring = { kind = "spring", between = ["tip", "wall"], stiffness = "k", state = "x" }
stop = { kind = "spring", between = ["tip", "wall"], force = "k_c*max(q - gap, 0)" }
mass = { kind = "mass", at = "tip", mass = "m", state = "p" }
damper = { kind = "damper", between = ["tip", "wall"], force = "d*v", heats = "body" }
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
air = { kind = "ambient", body = "body", conductance = "lam", input = "T_e" }
load = { kind = "force_source", at = "tip", input = "F" }
"""


@pytest.mark.long
@pytest.mark.usefixtures("cache")
@pytest.mark.parametrize("start", [0.0, 2e-3])
def test_what_every_motion_conserves_stays_as_it_was(start):
    """Springs in parallel keep the difference of their lengths, as in a run."""
    model = parse(PARALLEL)
    drive = {"F": sine(50, 10)}
    found = periodic_steady_state(
        model, inputs=drive, frequency=10, initial={"x": start, "q_stop": 0.0}
    )
    assert found.initial["x"] - found.initial["q_stop"] == pytest.approx(start, abs=1e-8)
    assert found.multiplier < 1 - 1e-4

    run = simulate(model, duration=1.0, inputs=drive, initial=found.initial, rtol=1e-9)
    assert run.x[-1] == pytest.approx(found.initial["x"], abs=1e-7)


STICKING = """
[model]
name = "sticking"
[parameters]
m = { value = 1.0, unit = "kg" }
k = { value = 1e4, unit = "N/m" }
d = { value = 50.0, unit = "N*s/m" }
k_s = { value = 5e3, unit = "N/m" }
F_s = { value = 1e3, unit = "N" }
T_0 = { value = 300.0, unit = "K" }
c = { value = 0.5, unit = "J/K" }
h = { value = 0.5, unit = "W/K" }
[inputs]
F = { unit = "N" }
T_e = { unit = "K", default = 300.0 }
[domain]
assume = ["d >= 0", "h >= 0", "T_e > 0"]
[elements]
mass = { kind = "mass", at = "tip", mass = "m", state = "p" }
spring = { kind = "spring", between = ["tip", "wall"], stiffness = "k", state = "q" }
damper = { kind = "damper", between = ["tip", "wall"], force = "d*v", heats = "body" }
push = { kind = "force_source", at = "tip", input = "F" }
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
air = { kind = "ambient", body = "body", conductance = "h", input = "T_e" }
[elements.slip]
kind = "stop"
between = ["tip", "wall"]
stiffness = "k_s"
limit = "F_s"
heats = "body"
state = "z"
"""


@pytest.mark.long
@pytest.mark.usefixtures("cache")
@pytest.mark.parametrize("start", [{}, {"q": 0.01}, {"z": -0.005}])
def test_a_stop_that_sticks_keeps_its_slip(start):
    """The closed form of a linear oscillator: q - z stays, and k q + k_s z is its force."""
    offset, amplitude, omega = 200.0, 100.0, 2 * np.pi * 5
    drive = {"F": sine(amplitude, 5, offset)}
    found = periodic_steady_state(parse(STICKING), inputs=drive, frequency=5, initial=start)
    slip = start.get("q", 0.0) - start.get("z", 0.0)
    response = amplitude / (1.5e4 - omega**2 + 50j * omega)
    q = (offset + 5e3 * slip) / 1.5e4 + response.imag
    assert found.initial["q"] == pytest.approx(q, rel=1e-6)
    assert found.initial["z"] == pytest.approx(q - slip, rel=1e-6)


FREE = STICKING[: STICKING.index("[elements.slip]")]
FREE = FREE.replace('stiffness = "k"', 'force = "k*deadzone(q, 100*q_0)"')
FREE = FREE.replace("F_s = {", 'q_0 = { value = 1.0, unit = "m" }\nF_s = {')


@pytest.mark.some(1)
@pytest.mark.usefixtures("cache")
@pytest.mark.parametrize(("start", "phase"), [(0.0, 0.0), (3.0, 1.0)])
def test_a_free_position_is_where_the_start_and_the_drive_put_it(start, phase):
    """m v' + d v = F: p + d x changes by the impulse of F, which a period does not change."""
    model = parse(FREE)
    m, d, amplitude, omega = 1.0, 50.0, 20.0, 2 * np.pi * 5
    drive = {"F": sine(amplitude, 5, 0.0, phase)}
    found = periodic_steady_state(model, inputs=drive, frequency=5, initial={"q": start})
    v = amplitude * np.exp(1j * phase) / (d + 1j * omega * m)
    x = start - m * v.imag / d
    assert found.initial["p"] == pytest.approx(m * v.imag, abs=1e-6 * m * abs(v))
    assert found.initial["q"] == pytest.approx(x, abs=1e-6 * abs(v) / omega)


@pytest.mark.long
@pytest.mark.usefixtures("cache")
@pytest.mark.filterwarnings("ignore:nothing settles")
def test_a_free_position_that_drifts_stays_at_its_start_and_the_others_repeat():
    """m v' + d v = F: the mean of v is that of F over d."""
    drive = {"F": sine(20.0, 5, 10.0, 1.0)}
    with pytest.warns(SteadyWarning, match="'q' drifts by 0.04 m a period; no rate depends on it"):
        found = periodic_steady_state(parse(FREE), inputs=drive, frequency=5, initial={"q": 2.0})
    wanted = 10.0 / 50.0 + (20.0 * np.exp(1j) / (50.0 + 10j * np.pi)).imag
    assert found.initial["p"] == pytest.approx(wanted, rel=1e-6)
    assert found.initial["q"] == 2.0
    assert found.residual < 1e-6


@pytest.mark.long
@pytest.mark.usefixtures("cache")
@pytest.mark.filterwarnings("ignore:nothing settles")
def test_a_free_position_may_be_coupled_to_the_temperature():
    """Where the body is not at its steady temperature, the position drifts."""
    text = FREE.replace('force = "d*v"', 'force = "d*v*(1 + al*(T - T_0))"')
    text = text.replace("F_s = {", 'al = { value = -5e-3, unit = "1/K" }\nF_s = {')
    model = parse(text.replace('"d >= 0",', '"d >= 0", "1 + al*(T - T_0) >= 0",'))
    drive = {"F": sine(100.0, 5)}
    found = periodic_steady_state(model, inputs=drive, frequency=5)
    run = simulate(model, inputs=drive, duration=20.0, times=2, rtol=1e-9)
    assert found.initial["p"] == pytest.approx(float(run.p[-1]), rel=1e-4)
    assert found.initial["S"] == pytest.approx(float(run.S[-1]), rel=1e-4)


@pytest.mark.long
@pytest.mark.usefixtures("cache")
def test_a_state_that_drifts_and_moves_others_is_named():
    """Without a damper p grows by the impulse of F, 10 N in 0.2 s, until the spring is hit."""
    text = FREE.replace("damper = {", "# damper = {").replace("100*q_0", "1e6*q_0")
    with (
        pytest.warns(SteadyWarning, match="nothing settles"),
        pytest.raises(RunError, match=r"periods from the start, 'q' drifts by .* m a period; take"),
    ):
        periodic_steady_state(parse(text), inputs={"F": sine(20.0, 5, 10.0)}, frequency=5)


@pytest.mark.parametrize("pair", [False, True])
@pytest.mark.parametrize("many", [4, 9, 13])
def test_only_what_is_surely_conserved_counts(many, pair):
    """Laws that are defined where their state is positive: few states that are drawn lie there."""

    def rhs(x, u, _):
        rates = u - x - np.log(x)
        rates[-1] = rates[0] if pair else rates[-1]
        return rates

    class Stub(SimpleNamespace):
        _random_rates = Stroboscope._random_rates

    stub = Stub(
        start=np.ones(many),
        repeating=np.ones(many, dtype=bool),
        _period=lambda x: x[:, None] * np.array([1.0, 1.1, 1.2]),
        _system=SimpleNamespace(scale=lambda x: x),
        entropy_row=lambda _: 0,
        values=None,
        inputs=SimpleNamespace(at_samples=lambda times: np.ones((1, times.size))),
        duration=1.0,
        module=SimpleNamespace(
            rhs=rhs,
            margins=lambda x, *_: x,
            DOMAIN=[SimpleNamespace(strict=True)] * many,
        ),
    )
    found = Stroboscope.conserved.func(stub)
    assert len(found) <= pair
    assert all(abs(row[0] + row[-1]) <= 1e-9 * abs(row[0]) for row in found)
