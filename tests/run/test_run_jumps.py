"""What all but jumps, and what is much faster than a run: rtol is kept there too.

References are SciPy's Radau at 1e-10, which shares no step with the engine.
"""

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from piezo_sym import simulate, sine, step, sweep, triangle
from piezo_sym.modules import module_of
from piezo_sym.run import integrate
from piezo_sym.run.functions import INTERVALS, jumps
from piezo_sym.run.integrate import advance
from piezo_sym.spec.load import parse

SPECS = Path(__file__).parents[1] / "networks" / "specs"
FRICTION = (SPECS / "dry_friction.toml").read_text(encoding="utf-8")
#: An inductor and two capacitors, the second behind 1 ohm: its charge follows in Rs*Cs.
CIRCUIT = """
[model]
name = "circuit"
[parameters]
L = { value = 1e-3, unit = "H" }
C = { value = 1e-6, unit = "F" }
R = { value = 5.0, unit = "ohm" }
Cs = { value = 1e-12, unit = "F" }
Rs = { value = 1.0, unit = "ohm" }
T_0 = { value = 300.0, unit = "K" }
c = { value = 1.0, unit = "J/K" }
[inputs]
V = { unit = "V", default = 0.0 }
[domain]
assume = ["R >= 0", "Rs > 0"]
[elements]
source = { kind = "voltage_source", between = ["in", "gnd"], input = "V" }
coil = { kind = "inductor", between = ["in", "a"], inductance = "L", state = "phi" }
wire = { kind = "resistor", between = ["a", "b"], voltage = "R*i", heats = "body" }
large = { kind = "capacitor", between = ["b", "gnd"], capacitance = "C", state = "Q" }
lead = { kind = "resistor", between = ["b", "d"], current = "v/Rs", heats = "body" }
small = { kind = "capacitor", between = ["d", "gnd"], capacitance = "Cs", state = "Qs" }
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
"""
#: A body of 400 K heats a small one, which begins at 350 K.
BODIES = """
[model]
name = "bodies"
[parameters]
T_0 = { value = 300.0, unit = "K" }
c = { value = 2.0, unit = "J/K" }
c_small = { value = 1e-6, unit = "J/K" }
between = { value = 0.5, unit = "W/K" }
lam = { value = 0.1, unit = "W/K" }
hot = { value = 400.0, unit = "K" }
warm = { value = 350.0, unit = "K" }
[inputs]
T_e = { unit = "K", default = 300.0 }
[domain]
assume = ["between >= 0", "lam >= 0", "T_e > 0"]
[initial]
S = "c*log(hot/T_0)"
S_small = "c_small*log(warm/T_0)"
[elements]
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
small = { kind = "thermal_mass", temperature = "T_0*exp(S/c_small)", state = "S_small" }
joint = { kind = "conduction", between = ["body", "small"], conductance = "between" }
room = { kind = "ambient", body = "small", conductance = "lam", input = "T_e" }
"""


#: Two diodes, one each way, that a voltage turns around: beyond their bend a volt is 10^16 times.
DIODES = """
[model]
name = "diodes"
[parameters]
R = { value = 1000.0, unit = "ohm" }
C = { value = 1e-9, unit = "F" }
I_s = { value = 1e-12, unit = "A" }
V_T = { value = 0.026, unit = "V" }
C_2 = { value = 1e-6, unit = "F" }
T_0 = { value = 300.0, unit = "K" }
c = { value = 2.0, unit = "J/K" }
[inputs]
V = { unit = "V", default = 0.0 }
[domain]
assume = ["R > 0", "I_s >= 0", "V_T > 0"]
[elements]
source = { kind = "voltage_source", between = ["in", "gnd"], input = "V" }
series = { kind = "resistor", between = ["in", "a"], current = "v/R", heats = "body" }
both = { kind = "resistor", between = ["a", "gnd"], current = "I_s*(exp(v/V_T) - exp(-v/V_T))", heats = "body" }
small = { kind = "capacitor", between = ["a", "gnd"], capacitance = "C", state = "Q" }
out = { kind = "resistor", between = ["a", "o"], current = "v/R", heats = "body" }
large = { kind = "capacitor", between = ["o", "gnd"], capacitance = "C_2", state = "Q_2" }
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
"""  # noqa: E501
TURNED = {"inputs": {"V": step(7.143e-4, 5, -5)}, "duration": 2e-3}
SLIDES = {
    "step": {"inputs": {"F": step(0.5, 0, 20)}, "initial": {"q": 0.0}},
    "sine": {"inputs": {"F": sine(20, 2)}, "initial": {"q": 0.0}},
    "free": {},
}
CHARGE = {"initial": {"Qs": 1e-11}, "inputs": {"V": step(1e-3, 0, 10)}, "duration": 5e-3}
RTOLS = (1e-3, 1e-5, 1e-7)


@cache
def model_of(text):
    return parse(text)


def error(text, rtol, wanted, **options):
    """Return the largest error of any state, in rtol of its largest magnitude."""
    found = simulate(model_of(text), rtol=rtol, times=101, **options)
    return max(
        float(np.abs(found[state.name] - wanted[state.name]).max())
        / float(np.abs(wanted[state.name]).max())
        / rtol
        for state in module_of(model_of(text)).STATES
    )


def exact(text, **options):
    return simulate(model_of(text), method="Radau", rtol=1e-10, times=101, **options)


@pytest.mark.some(1)
@pytest.mark.parametrize("width", [1e-3, pytest.param(1e-4, marks=pytest.mark.long)])
@pytest.mark.parametrize("options", SLIDES.values(), ids=SLIDES)
def test_friction_is_as_good_as_asked_for(options, width):
    """Each reversal may add a few rtol; before steps told how strange they are, it was 5000."""
    given = {"duration": 1.5, "parameters": {"w": width}, **options}
    wanted = exact(FRICTION, **given)
    for rtol in RTOLS:
        assert error(FRICTION, rtol, wanted, **given) <= 20


@pytest.mark.long
def test_a_charge_that_follows_at_once_is_right_from_its_start():
    wanted = exact(CIRCUIT, **CHARGE)
    for rtol in RTOLS:
        assert error(CIRCUIT, rtol, wanted, **CHARGE) <= 20


@pytest.mark.long
def test_diodes_that_a_long_step_carries_beyond_their_bend_come_back():
    wanted = exact(DIODES, **TURNED)
    for rtol in RTOLS:
        assert error(DIODES, rtol, wanted, **TURNED) <= 20
    assert simulate(model_of(DIODES), step=1e-5, **TURNED).attrs["halvings"] < 1000


@pytest.mark.long
@pytest.mark.parametrize("size", [2e-3, 1e-6, 1e-9])
def test_a_small_body_follows_at_once(size):
    options = {"parameters": {"c_small": size}, "duration": 10.0}
    wanted = exact(BODIES, **options)
    for rtol in RTOLS:
        assert error(BODIES, rtol, wanted, **options) <= 20


@pytest.mark.parametrize("share", [0.01, 0.3, 0.48, 0.5, 0.62, 0.86, 0.9, 0.95, 0.99, 0.999])
def test_a_functions_own_jumps_are_as_good_as_known_ones(share):
    """Wherever in an interval they are: steps end there."""
    asked, jump = [], 5e-3 + 4e-5 * share

    def function(t):
        asked.append(t)
        return 100.0 if t >= jump else 0.0

    options = {"duration": 0.02, "times": 51, "rtol": 1e-6}
    found = simulate("piezo_stack", inputs={"V_in": function}, **options)
    wanted = simulate("piezo_stack", inputs={"V_in": step(jump, 0, 100)}, **options)
    for name in ("q", "p", "Q_C", "phi", "S"):
        size = float(np.abs(wanted[name]).max())
        assert float(np.abs(found[name] - wanted[name]).max()) <= 5e-6 * size
    solves = found.attrs["accepted_steps"] + found.sizes["time"]
    assert len(asked) <= INTERVALS + 20 * solves  # at stages, ends and where a kink is looked for


@given(st.floats(1e-3, 1.0, exclude_max=True), st.floats(-3, 3))
def test_a_jump_is_found_to_the_last_digit(jump, before):
    assert jumps(lambda t: before + np.sin(t) + (t >= jump), 0.0, 1.0) == (jump,)


def test_many_jumps_are_found_and_what_is_smooth_has_none():
    found = jumps(lambda t: np.where(t * 700 % 1 < 0.5, 5.0, -5.0), 0.0, 0.0499)
    assert np.allclose(found, np.arange(1, 70) / 1400, rtol=1e-14)
    for smooth in (
        lambda t: np.sin(2000 * t),
        lambda t: np.exp(-50 * t) * np.sin(900 * t * t),
        lambda t: 1e6 + t,
        lambda t: abs(np.sin(9 * t)),
        lambda t: np.tanh((t - 0.3) / 1e-4),
        lambda t: 0.0 * t,
    ):
        assert jumps(smooth, 0.0, 1.0) == ()
    (steep,) = jumps(lambda t: np.tanh((t - 0.3001) / 1e-12), 0.0, 1.0)
    assert steep == pytest.approx(0.3001, abs=1e-11)


def test_stiff_runs_are_the_same_in_any_company():
    """From friction that all but jumps to a damper that does not."""
    model, widths = model_of(FRICTION), np.geomspace(1e-5, 1e-1, 12)
    options = {"inputs": {"F": sine(20, 2)}, "duration": 1.0, "rtol": 1e-7, "times": 7}
    some = sweep(model, over={"w": widths}, **options)
    few = sweep(model, over={"w": widths[::3]}, **options)
    assert np.array_equal(some.p.values[::3], few.p.values)
    for k in (0, 5, 11):
        alone = simulate(model, parameters={"w": widths[k]}, **options)
        assert np.array_equal(some.p.values[k], alone.p.values)


def test_a_run_through_what_follows_at_once_has_all_samples_and_closes_its_balances():
    found = simulate(model_of(CIRCUIT), **CHARGE, times=301, rtol=1e-5)
    assert not any(np.isnan(found[name]).any() for name in found)
    energy, entropy = found.energy.values, found.entropy.values
    bound = 1e-12 * float(np.ptp(energy)) + 4 * np.spacing(np.abs(energy).max())
    assert float(np.abs(found.energy_residual).max()) <= bound
    assert float(np.abs(found.entropy_residual).max()) <= 1e-12 * float(np.ptp(entropy))


@pytest.mark.long
def test_lsoda_does_not_crawl_after_stops_begin_to_slip(monkeypatch):
    """It kept to steps of 0.2 ns, which the jump of the rates had allowed."""
    steps = iter(range(20_000))

    def counted(solver):
        next(steps)
        return advance(solver)

    monkeypatch.setattr(integrate, "advance", counted)
    options = {"inputs": {"V_in": triangle(60, 100, 60)}, "duration": 0.01, "times": 11}
    found = simulate("stack_maxwell", method="LSODA", **options)
    wanted = simulate("stack_maxwell", rtol=1e-8, **options)
    for name in ("q", "z", "S"):
        assert np.abs(found[name] - wanted[name]).max() < 1e-4 * np.abs(wanted[name]).max()


def shifted(t):
    t -= 0.01
    return 50 * np.sin(600 * t)


def wrapped(t):
    t %= 0.01
    return 5e3 * t


def pulsed(t):
    return 40.0 if np.all((t > 0.0031) & (t < 0.0042)) else 0.0 * t


@pytest.mark.parametrize("function", [shifted, wrapped, pulsed])
def test_a_function_that_treats_arrays_otherwise_is_asked_time_by_time(function):
    """It may write into what it is given, or take a whole array for one time."""
    found = simulate("piezo_stack", inputs={"V_in": function}, duration=0.03, times=301)
    wanted = [float(function(t)) for t in found.time.values.tolist()]
    assert np.array_equal(found.V_in.values[:-1], wanted[:-1])
    again = simulate(
        "piezo_stack",
        inputs={"V_in": lambda t: float(function(float(t)))},
        duration=0.03,
        times=301,
    )
    assert np.allclose(found.q, again.q, rtol=0, atol=1e-12)
