"""Laws with roots: flows of heat and of fluid that come to rest, or start from it."""

import numpy as np
import pytest

from piezo_sym import generate, simulate
from piezo_sym.errors import RunError
from piezo_sym.modules import ModuleWarning
from piezo_sym.spec.load import parse

BODIES = """
[model]
name = "roots"
[parameters]
T_0 = { value = 300.0, unit = "K" }
c = { value = 2.0, unit = "J/K" }
h = { value = 1.0, unit = "W/K" }
n = { value = 0.4, unit = "1" }
[domain]
assume = ["h >= 0", "n > 0"]
[elements]
one = { kind = "thermal_mass", temperature = "T_0*exp(S/c)" }
"""
TWO = """
two = { kind = "thermal_mass", temperature = "T_0*exp(S/c)" }
wire = { kind = "conduction", between = ["one", "two"], conductance = "LAW" }
[initial]
S_one = 0.1
"""
AMBIENT = """
[inputs]
T_e = { default = 320.0, unit = "K" }
[elements.air]
kind = "ambient"
body = "one"
input = "T_e"
conductance = "LAW"
"""
TANK = """
[model]
name = "tank"
[parameters]
P_0 = { value = 1e5, unit = "Pa" }
V_0 = { value = 1e-3, unit = "m**3" }
c_o = { value = 1e-6, unit = "m**3/s/Pa**(1/2)" }
T_0 = { value = 300.0, unit = "K" }
c = { value = 2.0, unit = "J/K" }
[domain]
assume = ["V_0 > 0", "W > -V_0", "c_o >= 0"]
[inputs]
F = { default = 1e-5, unit = "m**3/s" }
[elements]
pump = { kind = "flow_source", between = ["h", "tank"], input = "F" }
leak = { kind = "orifice", between = ["h", "tank"], flow = "LAW", heats = "body" }
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
[elements.gas]
kind = "accumulator"
between = ["h", "tank"]
pressure = "P_0*log(1 + V/V_0)"
state = "W"
"""
FACTORS = (
    "h*(1 + sqrt(abs(A - B)/T_0))",
    "h*(1 + abs(A/T_0 - B/T_0)**(3/2))",
    "h*abs(A/T_0 - B/T_0)**(1/4)",
    "h*(1 + abs(A/T_0 - B/T_0)**n)",
)


@pytest.mark.some(2)
@pytest.mark.parametrize("rtol", [1e-5, 1e-8])
@pytest.mark.parametrize("factor", FACTORS)
def test_bodies_settle_at_one_temperature(factor, rtol):
    """Energy is kept: c*T_1 + c*T_2 is, so that both end at the mean of their temperatures."""
    law = factor.replace("A", "T_1").replace("B", "T_2")
    found = simulate(parse(BODIES + TWO.replace("LAW", law)), duration=300.0, rtol=rtol)
    hot, cold = found.T_one.values, found.T_two.values
    assert hot[-1] == pytest.approx((hot[0] + cold[0]) / 2, rel=1e-6)
    assert cold[-1] == pytest.approx(hot[-1], rel=1e-6)
    assert np.all(np.diff(found.produced_wire.values) >= 0)
    assert np.abs(found.energy_residual.values).max() <= 4 * np.spacing(found.energy.values.max())


@pytest.mark.some(2)
@pytest.mark.parametrize("warm", [305.0, 330.0])
@pytest.mark.parametrize("factor", FACTORS)
def test_a_body_settles_at_its_surroundings(factor, warm):
    text = BODIES.replace('"n > 0"', '"n > 0", "T_e > 0"') + AMBIENT.replace(
        "LAW", factor.replace("A", "T").replace("B", "T_e")
    )
    found = simulate(parse(text), inputs={"T_e": warm}, duration=300.0)
    assert found.T_one.values[-1] == pytest.approx(warm, rel=1e-6)


def test_an_orifice_starts_from_rest_against_any_pump():
    """In the end all that is pumped leaks: F = c_o*sqrt(P)."""
    model = parse(TANK.replace("LAW", "c_o*sign(dp)*sqrt(abs(dp))"))
    for F in (1e-5, 1e-4, -1e-6):
        found = simulate(model, inputs={"F": F}, duration=200.0)
        P = 1e5 * np.log(1 + found.W.values[-1] / 1e-3)
        assert pytest.approx(P, rel=1e-4) == np.sign(F) * (F / 1e-6) ** 2


@pytest.mark.long
def test_a_root_of_less_than_zero_ends_a_run_that_is_not_proved(tmp_path, monkeypatch):
    """Only a law that is proved goes on beyond its kinks within a step."""
    monkeypatch.chdir(tmp_path)
    model = parse(TANK.replace("LAW", "c_o*sqrt(dp)"))
    generate(model, allow_unproved=True)
    with pytest.warns(ModuleWarning), pytest.raises(RunError, match="cannot go on from t ="):
        simulate(model, inputs={"F": -1e-5}, initial={"W": 1e-7}, duration=10.0)
