"""Switches of laws with kinks: none is missed, none is taken for another, and rest has none."""

from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from piezo_sym import simulate, sine, square, sweep
from piezo_sym.spec.load import parse

DIODE = """
[model]
name = "diode"
[parameters]
C   = { value = 1e-6, unit = "F" }
I_s = { value = 1e-9, unit = "A" }
V_T = { value = 0.025, unit = "V" }
T_0 = { value = 300, unit = "K" }
c   = { value = 2, unit = "J/K" }
[inputs]
V = { unit = "V" }
[domain]
assume = ["I_s > 0", "V_T > 0"]
[elements]
cap    = { kind = "capacitor", between = ["cap", "gnd"], capacitance = "C", state = "Q" }
supply = { kind = "voltage_source", between = ["in", "gnd"], input = "V" }
[elements.diode]
kind = "resistor"
between = ["in", "cap"]
current = "I_s*max(exp(v/V_T) - 1, 0)"
heats = "body"
[elements.body]
kind = "thermal_mass"
temperature = "T_0*exp(S/c)"
"""
KNOTS = (
    "table(v, -v_1 - 2*w, 0, -v_1 - w, 0, -v_1, -F_1, -v_1 + w, 0, "
    "v_1 - w, 0, v_1, F_1, v_1 + w, 0, v_1 + 2*w, 0)"
)
BUMP = f"""
[model]
name = "bump"
[parameters]
m   = {{ value = 1, unit = "kg" }}
v_1 = {{ value = 5, unit = "m/s" }}
w   = {{ value = 2e-3, unit = "m/s" }}
F_1 = {{ value = 0.5, unit = "N" }}
T_0 = {{ value = 300, unit = "K" }}
c   = {{ value = 2, unit = "J/K" }}
[inputs]
F = {{ unit = "N", default = 1 }}
[domain]
assume = ["w > 0", "v_1 > w", "F_1 >= 0"]
[elements]
mass   = {{ kind = "mass", at = "tip", mass = "m", state = "p" }}
load   = {{ kind = "force_source", at = "tip", input = "F" }}
damper = {{ kind = "damper", between = ["tip", "wall"], heats = "body", force = "{KNOTS}" }}
body   = {{ kind = "thermal_mass", temperature = "T_0*exp(S/c)" }}
"""


def diode(charge, rtol):
    """Return a diode's charge after pulses of 50 mV: by simulate and by LSODA."""

    def rate(t, y):
        return [1e-9 * max(np.exp((0.05 * np.sin(100 * np.pi * t) - y[0] / 1e-6) / 0.025) - 1, 0)]

    inputs = {"V": sine(0.05, 50)}
    run = simulate(parse(DIODE), duration=1.0, rtol=rtol, initial={"Q": charge}, inputs=inputs)
    options = {"method": "LSODA", "rtol": 1e-11, "atol": 1e-22, "max_step": 1e-3}
    return float(run.Q[-1]), solve_ivp(rate, (0, 1), [charge], **options).y[0, -1]


@pytest.mark.some(1)
@pytest.mark.parametrize("rtol", [1e-5, 1e-7])
@pytest.mark.parametrize("charge", [-0.9e-6, -0.7e-6, -0.5e-6])
def test_no_pulse_through_a_steep_law_is_missed(charge, rtol):
    """Its switching function goes from exp(36) to parts of 1; 140 and up to 2000 rtol before."""
    found, wanted = diode(charge, rtol)
    assert abs(found - wanted) < 10 * rtol * abs(charge)


@pytest.mark.parametrize("rtol", [1e-3, 1e-7])
@pytest.mark.parametrize("width", [0.02, 2e-3, 5e-4])
def test_a_force_at_one_speed_is_not_skipped(width, rtol):
    run = simulate(parse(BUMP), duration=10.0, rtol=rtol, parameters={"w": width})
    momentum = 10 - 2 * width * 2 * np.log(2) + 2 * width  # dv/dt is 1, and 1 to 1/2 to 1 within
    assert float(run.p[-1]) == pytest.approx(momentum, rel=10 * rtol)
    assert run.S_body[-1] > 0


@pytest.mark.parametrize("rtol", [1e-3, 1e-5])
def test_what_a_lane_knows_of_a_switch_is_of_its_own_run(rtol):
    """The first step of some members is refused while others go on."""
    charges = [-0.75e-6 - 1e-8 * k if k % 2 == 0 else 0.0 for k in range(9)]
    given = {"duration": 0.2, "rtol": rtol, "inputs": {"V": sine(0.05, 50)}, "reduce": "last"}
    together = sweep(parse(DIODE), over={"Q": charges}, **given)
    for k, charge in enumerate(charges):
        alone = sweep(parse(DIODE), over={"Q": [charge]}, **given)
        assert float(alone.Q[0]) == float(together.Q[k])
        assert float(alone.S_body[0]) == float(together.S_body[k])


@pytest.mark.parametrize("rtol", [1e-3, 1e-9])
def test_rest_after_motion_takes_few_steps(rtol):
    """A sign that is round-off, but for which a process consumes entropy, is a switch."""
    inputs = {"V_in": square(20.0, 100.0), "F_ext": square(5.0, 100.0)}
    run = simulate("stack_bouc_wen", duration=0.02, rtol=rtol, inputs=inputs, times=[0.02])
    assert run.attrs["accepted_steps"] < 3000  # 33753 and 43677 without that


def test_errors_of_many_kinks_do_not_add_up() -> None:
    """Heat of 300 periods with four kinks per hysteron each: it adds up whatever a step leaves."""
    run: dict[str, Any] = {
        "inputs": {"V_in": sine(100.0, 100.0)},
        "duration": 3.0,
        "times": [3.0],
    }
    exact = float(simulate("piezo_stack", rtol=1e-9, **run).S[-1])
    for rtol in (1e-3, 3e-4, 1e-4):
        found = float(simulate("piezo_stack", rtol=rtol, **run).S[-1])
        assert abs(found - exact) <= 1e-4 * rtol * abs(exact)
