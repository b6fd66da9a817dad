"""Runs that begin at rest, under laws that are a small difference of large terms there."""

import numpy as np
import pytest

from piezo_sym import ramp, simulate
from piezo_sym.spec.load import parse

SPRING = """
[model]
name = "from_rest"
[parameters]
m = {{ value = 0.03, unit = "kg" }}
d = {{ value = 3.0, unit = "N*s/m" }}
k = {{ value = 1e4, unit = "N/m" }}
g = {{ value = 7.5e-3, unit = "m" }}
T_0 = {{ value = 300.0, unit = "K" }}
c = {{ value = 2.0, unit = "J/K" }}
[inputs]
F = {{ unit = "N" }}
[domain]
assume = ["d >= 0", "k > 0", "g > 0", "q < g", "q > -g"]
[elements]
spring = {{ kind = "spring", between = ["tip", "wall"], force = "{}", state = "q" }}
mass = {{ kind = "mass", at = "tip", mass = "m", state = "p" }}
push = {{ kind = "force_source", at = "tip", input = "F" }}
damper = {{ kind = "damper", between = ["tip", "wall"], force = "d*v", heats = "body" }}
body = {{ kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }}
"""
LAWS = (
    "k*g*((1 - q/g)**(-1.2) - 1)",
    "k*g*((1 - q/g)**(-1.5) - 1)",
    "k*g*log(1 + q/g)",
    "k*g*(sqrt(1 + q/g) - 1)",
)


@pytest.mark.some(2)
@pytest.mark.parametrize("force", [0.1, 1e-3, 1e-6])
@pytest.mark.parametrize("law", LAWS)
def test_what_is_a_difference_of_large_terms_at_rest_begins_to_move(law, force):
    """Its round-off was taken for a law that no step resolves: q is some 1e-18 at first."""
    model, given = parse(SPRING.format(law)), {"inputs": {"F": force}, "duration": 0.02}
    run, other = (
        simulate(model, **given, times=21, **way)
        for way in ({"rtol": 1e-7}, {"method": "Radau", "rtol": 1e-9})
    )
    for name in ("q", "p"):
        size = np.abs(other[name].values).max()
        assert np.abs(run[name].values - other[name].values).max() <= 1e-5 * size
    assert np.abs(run.energy_residual.values).max() <= 8 * np.spacing(float(run.energy[0]))
    assert run.attrs["halvings"] < 100


@pytest.mark.some(1)
@pytest.mark.parametrize(
    ("model", "rtol"),
    [("stack_bouc_wen", 1e-4), ("stack_maxwell", 1e-7), ("stack_bouc_wen", 1e-10)],
)
def test_a_voltage_that_is_held_leads_to_rest_in_few_steps(model, rtol):
    """At rest the rate of the momentum is a difference of forces, and all of it is round-off."""
    ramped = {"inputs": {"V_in": ramp(0.0, 1.0, 0.0, 80.0)}, "duration": 3.0, "rtol": rtol}
    run = simulate(model, times=[0.0, 1.0, 3.0], **ramped)
    assert run.attrs["accepted_steps"] < 10_000  # else 10^5 and more
    assert np.abs(run.energy_residual).max() <= 1e-14 * run.energy.max()
    heat = run.entropy_residual * run.T_body
    assert np.abs(heat).max() <= 1e-14 * run.energy.max()


def test_a_run_goes_on_from_near_rest_in_few_steps():
    """The flux of an inductor at rest is no more than the round-off of voltages."""
    held = {"inputs": {"V_in": 80.0}, "rtol": 1e-7}
    ramped = simulate("stack_maxwell", inputs={"V_in": ramp(0.0, 1.0, 0.0, 80.0)}, duration=3.0)
    run = simulate("stack_maxwell", initial=ramped, duration=5.0, times=[8.0], **held)
    assert run.attrs["accepted_steps"] < 1000
    assert float(run.q[-1]) == pytest.approx(float(ramped.q[-1]), rel=1e-6)
