"""The edge of the domain: where runs stop, what they say there, and what stays inside."""

import signal
from contextlib import contextmanager
from math import log

import numpy as np
import pytest

import piezo_sym
from piezo_sym import ramp, sine, step
from piezo_sym.errors import RunError
from piezo_sym.modules import module_of
from piezo_sym.run import simulate
from piezo_sym.spec.load import parse


@pytest.fixture(scope="module")
def module():
    return module_of("piezo_stack")


def message(module, **more):
    with pytest.raises(RunError) as error:
        simulate(module, **more)
    text = str(error.value)
    assert text.isprintable()
    return text


def time_in(text):
    return float(text.split("t = ")[1].split(" s")[0])


WAYS = [{}, {"rtol": 1e-9}, {"step": 1e-3}, {"step": 2e-5}]


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize(
    ("T_e", "known"),
    [
        (step(0.0021, 298.15, 291.15), 0.0021),
        (ramp(0.002, 0.006, 298.15, 294.15), 0.004),
        (lambda t: 298.15 - 2e2 * t, 0.01),
        (sine(4.0, 10.0, 298.15), 7 / 120),
    ],
)
def test_inputs_that_leave_the_domain(module, way, T_e, known):
    text = message(module, inputs={"T_e": T_e}, duration=0.1, **way)
    assert time_in(text) == pytest.approx(known, rel=1e-5)
    assert "state leaves the domain at t = " in text
    assert "condition 'T_e > T_0' has margin " in text
    assert text.endswith("expected T_e > T_0 throughout the run; change input 'T_e'")


def test_inputs_that_come_near_the_edge_do_not_stop_a_run(module):
    run = simulate(module, inputs={"T_e": sine(1.999, 100.0, 298.15)}, duration=0.02)
    assert 296.15 < run.T_e.min() < 296.16


LEAK = """
[model]
name = "leak"

[parameters]
T_0 = { value = 296.15, unit = "K" }
c = { value = 5.0, unit = "J/K" }
lam = { value = 2.0, unit = "W/K" }
T_low = { value = 296.15, unit = "K" }

[inputs]
T_e = { unit = "K", default = 290.0 }

[domain]
assume = ["T > T_low", "T_low > 0", "T_e > 0", "lam >= 0"]

[initial]
S = 0.03

[elements.body]
kind = "thermal_mass"
temperature = "T_0*exp(S/c)"
state = "S"

[elements.ambient]
kind = "ambient"
body = "body"
conductance = "lam"
input = "T_e"
"""


@pytest.fixture(scope="module")
def leak(tmp_path_factory):
    """A body that an ambient cools below what its domain allows."""
    path = tmp_path_factory.mktemp("leak") / "leak.toml"
    path.write_text(LEAK)
    return path


@pytest.mark.some(1)
@pytest.mark.parametrize("way", [{}, {"rtol": 1e-8}, {"step": 0.5}, {"step": 1e-3}])
def test_a_state_that_leaves_the_domain_is_said_with_time_and_value(leak, way):
    """C dT/dt = lam (T_e - T): the time is known in closed form."""
    with pytest.raises(RunError) as error:
        piezo_sym.simulate(leak, duration=20.0, **way)
    text = str(error.value)
    start = 296.15 * np.exp(0.03 / 5)
    known = 5 / 2 * log((start - 290) / (296.15 - 290))
    assert time_in(text) == pytest.approx(known, rel=1e-5)
    assert "model 'leak': state leaves the domain at t = " in text
    assert "condition 'T > T_low' has margin " in text
    assert "(T_body = 296.15 K, T_low = 296.15 K)" in text
    assert "discrete_gradient cannot go on from t = " in str(error.value.__cause__)


def test_a_run_that_ends_before_the_edge_is_not_stopped(leak):
    start = 296.15 * np.exp(0.03 / 5)
    known = 5 / 2 * log((start - 290) / (296.15 - 290))
    run = piezo_sym.simulate(leak, duration=known - 1e-6, rtol=1e-8)
    assert float(run.T_body[-1]) == pytest.approx(296.15, abs=1e-5)
    assert np.all(run.T_body > 296.15)


def test_a_condition_on_state_and_input_is_looked_at_with_the_state_of_the_time(tmp_path):
    """T starts 5 K above where T_e ends, and follows it; the start and the end never meet."""
    limit = 'T_low = { value = 280.0, unit = "K" }\ngap = { value = 3.0, unit = "K" }'
    text = LEAK.replace('T_low = { value = 296.15, unit = "K" }', limit)
    path = tmp_path / "gap.toml"
    path.write_text(
        text.replace('["T > T_low", ', '["T > T_low", "T - T_e < gap", ').replace("290.0", "297.0")
    )
    slide = ramp(10.0, 110.0, 297.0, 292.92)
    run = piezo_sym.simulate(path, inputs={"T_e": slide}, duration=120.0)
    assert run.T_body[0] - run.T_e[-1] > 3 > (run.T_body - run.T_e).max()
    with pytest.raises(RunError, match=r"condition 'T - T_e < gap' has margin .*T_e = 29"):
        piezo_sym.simulate(path, inputs={"T_e": step(60.0, 297.0, 292.92)}, duration=120.0)


def test_samples_lie_in_the_domain_however_near_its_edge(module):
    """A step must not end beyond the edge that its stages keep away from."""
    inputs = {"T_e": 296.15 + 1e-9, "V_in": sine(1e-3, 100)}
    run = simulate(module, inputs=inputs, duration=0.05, initial={"S": 1e-6})
    assert np.all(run.T_body > 296.15)


#: A magnet whose gap closes, as a stop holds the armature too late: its energy has no slope there.
MAGNET = """
[model]
name = "magnet"
[parameters]
L_0 = { value = 20, unit = "mH" }
g = { value = 2, unit = "mm" }
x_0 = { value = 1, unit = "mm" }
L_s = { value = 5, unit = "mH" }
m = { value = 40, unit = "g" }
k = { value = 3, unit = "N/mm" }
k_c = { value = 500, unit = "N/mm" }
g_s = { value = 1.5, unit = "mm" }
d = { value = 4, unit = "N*s/m" }
R = { value = 5, unit = "ohm" }
T_0 = { value = 293, unit = "K" }
c = { value = 0.5, unit = "J/K" }
[inputs]
u = { unit = "V", default = 11.0 }
[domain]
assume = ["g + x > 0", "x_0 > 0", "L_0 > 0", "L_s > 0", "g > 0", "R >= 0", "d >= 0", "k_c >= 0"]
[elements]
src = { kind = "voltage_source", between = ["in", "gnd"], input = "u" }
coil = { kind = "resistor", between = ["in", "c"], voltage = "R*i", heats = "copper" }
copper = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
arm = { kind = "mass", at = "arm", mass = "m", state = "p" }
spring = { kind = "spring", between = ["arm", "wall"], stiffness = "k", state = "q" }
stop = { kind = "spring", between = ["arm", "wall"], force = "k_c*min(q + g_s, 0)", state = "z" }
guide = { kind = "damper", between = ["arm", "wall"], force = "d*v", heats = "copper" }
[elements.magnet]
kind = "storage"
energy = "phi**2/(2*(L_s + L_0*x_0/(g + x)))"
[elements.magnet.states]
phi = { rate = "voltage", between = ["c", "gnd"] }
x = { rate = "velocity", between = ["arm", "wall"] }
"""


@contextmanager
def ended_after(seconds):
    """Raise `TimeoutError` where the body would never end."""

    def late(*_):
        raise TimeoutError

    before = signal.signal(signal.SIGALRM, late)
    signal.alarm(seconds)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


@pytest.mark.some(1)
@pytest.mark.parametrize("rtol", [1e-5, 3e-6, 1e-8])
def test_a_run_that_crawls_towards_the_edge_ends_there(rtol):
    """Steps of one digit of the time succeed there: some 10^15 would be needed."""
    with ended_after(120), pytest.raises(RunError, match=r"leaves the domain at t = 0\.01526"):
        piezo_sym.simulate(parse(MAGNET), duration=0.02, rtol=rtol)


PUSHED = """
[model]
name = "pushed"
[parameters]
m = { value = 1.0, unit = "kg" }
k = { value = 4.0, unit = "N/m" }
[initial]
q = 1.0
[elements]
spring = { kind = "spring", between = ["tip", "wall"], force = "-k*q", state = "q" }
mass = { kind = "mass", at = "tip", mass = "m" }
"""


@pytest.mark.filterwarnings("ignore:(overflow|invalid value) encountered:RuntimeWarning")
def test_a_run_that_grows_without_bound_is_told_to_check_signs():
    with pytest.raises(RunError) as error:
        piezo_sym.simulate(parse(PUSHED), duration=1000.0)
    assert "'q', 'p_mass' grow without bound; the energy of 'spring' has fallen" in str(error.value)
    assert "no lower bound; check the signs of laws" in str(error.value)
    assert "domain" not in str(error.value)
