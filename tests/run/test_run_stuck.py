"""What is said of runs whose steps become too short: growth in finite time, an edge ahead."""

import pytest

from piezo_sym import Stepper, simulate, sine
from piezo_sym.errors import RunError
from piezo_sym.spec.load import parse

#: A spring that softens: beyond q = 2 m it pushes outward, ever harder.
SOFTENING = """
[model]
name = "softening"
[parameters]
k = { value = 4.0, unit = "N/m" }
b = { value = 1.0, unit = "N/m**3" }
m = { value = 1.0, unit = "kg" }
d = { value = 0.1, unit = "N*s/m" }
T_0 = { value = 300.0, unit = "K" }
c = { value = 2.0, unit = "J/K" }
[inputs]
F = { unit = "N" }
[domain]
assume = ["d >= 0"]
[elements]
push = { kind = "force_source", at = "tip", input = "F" }
spring = { kind = "spring", between = ["tip", "wall"], force = "k*q - b*q**3", state = "q" }
mass = { kind = "mass", at = "tip", mass = "m", state = "p" }
damper = { kind = "damper", between = ["tip", "wall"], force = "d*v", heats = "body" }
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
"""


def test_growth_in_finite_time_names_states_and_the_energy_without_bound() -> None:
    """It is proved, as passivity holds, but its energy -b q^4/4 has no lower bound."""
    with pytest.raises(RunError, match=r"cannot go on from t = 1\.78") as error:
        simulate(parse(SOFTENING), inputs={"F": 5.0}, duration=20.0)
    said = str(error.value)
    assert "'q', 'p' grow without bound; the energy of 'spring' has fallen to -" in said
    assert "passivity bounds no state whose energy has no lower bound; check the signs" in said
    assert "jumps" not in said
    assert "sign(v)" not in said


#: A capacitor of negative energy: its plates are drawn to where it has no capacitance.
NEGATIVE = """
[model]
name = "negative"
[parameters]
m = { value = 0.5, unit = "ug" }
k = { value = 2.0, unit = "N/m" }
d = { value = 5e-7, unit = "N*s/m" }
C_0 = { value = 0.2, unit = "pF" }
C_1 = { value = 40.0, unit = "nF/m" }
R = { value = 100.0, unit = "kohm" }
T_0 = { value = 300.0, unit = "K" }
c = { value = 0.35, unit = "uJ/K" }
[inputs]
V_in = { unit = "V" }
[domain]
assume = ["d >= 0", "R > 0", "C_0 + C_1*x > 0"]
[elements]
comb = { kind = "storage", energy = "-Q**2/(2*(C_0 + C_1*x))", states = { Q = { rate = "current", between = ["comb", "gnd"] }, x = { rate = "velocity", between = ["shuttle", "wall"] } } }
flexure = { kind = "spring", between = ["shuttle", "wall"], stiffness = "k", state = "q" }
film = { kind = "damper", between = ["shuttle", "wall"], force = "d*v", heats = "body" }
mass = { kind = "mass", at = "shuttle", mass = "m", state = "p" }
supply = { kind = "voltage_source", between = ["in", "gnd"], input = "V_in" }
lead = { kind = "resistor", between = ["in", "comb"], voltage = "R*i", heats = "body" }
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
"""  # noqa: E501


def test_an_edge_that_steps_cannot_reach_is_named() -> None:
    with pytest.raises(RunError) as error:
        simulate(parse(NEGATIVE), inputs={"V_in": 20.0}, duration=1e-2)
    said = str(error.value)
    assert "condition 'C_0 + C_1*x > 0' has margin" in said
    assert "the energy of 'comb' has fallen to -" in said
    assert "jumps" not in said


#: A coil that heats itself up to an edge of the domain.
HEATED = """
[model]
name = "heated"
[parameters]
L = { value = 1.0, unit = "mH" }
R = { value = 4.0, unit = "ohm" }
T_0 = { value = 300.0, unit = "K" }
T_max = { value = 320.0, unit = "K" }
c = { value = 2.0, unit = "J/K" }
[inputs]
V_in = { unit = "V" }
[domain]
assume = ["R > 0", "T_winding < T_max"]
[elements]
supply = { kind = "voltage_source", between = ["in", "gnd"], input = "V_in" }
coil = { kind = "inductor", between = ["in", "a"], inductance = "L", state = "phi" }
copper = { kind = "resistor", between = ["a", "gnd"], voltage = "R*i", heats = "winding" }
winding = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
"""


def test_an_edge_is_named_with_its_values() -> None:
    model = parse(HEATED)
    for step in (None, 1e-4):
        with pytest.raises(RunError) as error:
            simulate(model, inputs={"V_in": 20.0}, duration=1.0, step=step)
        said = str(error.value)
        assert "condition 'T < T_max' has margin" in said
        assert "(T_winding = 320 K, T_max = 320 K)" in said
        assert "jumps" not in said


@pytest.mark.parametrize(("step", "every"), [(1e-3, 1), (1e-4, 70), (2e-2, 1)])
def test_a_stepper_names_the_edge(step: float, every: int) -> None:
    stepper = Stepper(parse(HEATED), step=step, every=every)

    def heat() -> None:
        for _ in range(1000):
            stepper.step([20.0])

    with pytest.raises(RunError, match="no step stays in the domain at t = ") as error:
        heat()
    said = str(error.value)
    assert "condition 'T < T_max' has margin" in said
    assert "T_max = 320 K), and falls; change the inputs" in said


ORIFICE = """
[model]
name = "orifice"
[parameters]
C = { value = 2e-13, unit = "m**3/Pa" }
k = { value = 1e-6, unit = "m**3/s/Pa**(1/2)" }
T_0 = { value = 300.0, unit = "K" }
c = { value = 2.0, unit = "J/K" }
[inputs]
Q = { unit = "m**3/s" }
[domain]
assume = ["k >= 0", "C > 0"]
[elements]
pump = { kind = "flow_source", between = ["a", "tank"], input = "Q" }
volume = { kind = "accumulator", between = ["a", "tank"], capacitance = "C", state = "V" }
leak = { kind = "orifice", between = ["a", "tank"], flow = "k*sign(dp)*sqrt(abs(dp))", heats = "oil" }
oil = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
"""  # noqa: E501


def test_a_slope_that_is_infinite_at_rest_is_named() -> None:
    with pytest.raises(RunError) as error:
        simulate(parse(ORIFICE), inputs={"Q": sine(1e-9, 200)}, duration=0.05, rtol=1e-9)
    said = str(error.value)
    assert "the slopes of its laws by 'V' are infinite there, or nearly" in said
    assert "write x/(x**2 + x_0**2)**(1/4) for sign(x)*sqrt(abs(x))" in said
    assert "jumps" not in said
