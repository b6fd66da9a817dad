"""Cases with answers in closed form: bodies, an oscillator and a circuit that heat themselves."""

import numpy as np
import pytest

from piezo_sym import derive, simulate, verify
from piezo_sym.spec.load import parse

TWO_BODIES = """
[model]
name = "two_bodies"
[parameters]
c_1 = { value = 2.0, unit = "J/K" }
c_2 = { value = 3.0, unit = "J/K" }
lam = { value = 0.5, unit = "W/K" }
T_0 = { value = 300.0, unit = "K" }
T_1 = { value = 350.0, unit = "K" }
T_2 = { value = 290.0, unit = "K" }
[domain]
assume = ["lam >= 0"]
[initial]
S_hot  = "c_1*log(T_1/T_0)"
S_cold = "c_2*log(T_2/T_0)"
[elements]
hot     = { kind = "thermal_mass", temperature = "T_0*exp(S/c_1)" }
cold    = { kind = "thermal_mass", temperature = "T_0*exp(S/c_2)" }
contact = { kind = "conduction", between = ["hot", "cold"], conductance = "lam" }
"""
OSCILLATOR = """
[model]
name = "oscillator"
[parameters]
m   = { value = 1.0,   unit = "kg" }
k   = { value = 4.0,   unit = "N/m" }
d   = { value = 0.4,   unit = "N*s/m" }
T_0 = { value = 300.0, unit = "K" }
c   = { value = 2.0,   unit = "J/K" }
[domain]
assume = ["d >= 0"]
[initial]
q = 1.0
[elements]
spring = { kind = "spring", between = ["tip", "wall"], stiffness = "k", state = "q" }
mass   = { kind = "mass", at = "tip", mass = "m", state = "p" }
damper = { kind = "damper", between = ["tip", "wall"], force = "d*v", heats = "body" }
body   = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
"""
THERMISTOR = """
[model]
name = "thermistor"
[parameters]
L     = { value = 0.05,   unit = "H" }
C     = { value = 2e-6,   unit = "F" }
R_0   = { value = 1e3,    unit = "ohm" }
alpha = { value = 3000.0, unit = "K" }
c     = { value = 1e-6,   unit = "J/K" }
T_0   = { value = 300.0,  unit = "K" }
[initial]
Q = 2e-5
[elements.coil]
kind = "inductor"
between = ["a", "b"]
inductance = "L"
[elements.cap]
kind = "capacitor"
between = ["a", "gnd"]
capacitance = "C"
state = "Q"
[elements.thermistor]
kind = "resistor"
between = ["b", "gnd"]
voltage = "R_0*exp(alpha*(1/T - 1/T_0))*i"
heats = "body"
[elements.body]
kind = "thermal_mass"
temperature = "T_0*exp(S/c)"
state = "S"
"""


@pytest.mark.parametrize("text", [TWO_BODIES, OSCILLATOR, THERMISTOR])
def test_the_structure_is_proved(text):
    iphs = derive(parse(text))
    verify(iphs).raise_if_not_proved()
    verify(iphs.expand()).raise_if_not_proved()


def test_two_bodies_in_contact():
    run = simulate(parse(TWO_BODIES), duration=60.0, rtol=1e-10, times=[0.0, 4.0, 60.0])
    assert run.T_hot.values[1] == pytest.approx(320.79952170215, rel=1e-9)
    assert run.T_cold.values[1] == pytest.approx(309.46698553190, rel=1e-9)
    gap = 60 * np.exp(-0.5 * (1 / 2 + 1 / 3) * run.time.values)
    assert np.allclose(run.T_hot - run.T_cold, gap, atol=1e-6)
    assert run.T_hot.values[2] == pytest.approx(314.0, abs=1e-8)
    gained = float(run.entropy[2] - run.entropy[0])
    assert gained == pytest.approx(0.02145585163279, rel=1e-7)
    assert float(run.produced_contact[2]) == pytest.approx(gained, rel=1e-7)


def test_conduction_is_the_process_of_a_heat_exchanger():
    iphs = derive(parse(TWO_BODIES))
    (process,) = iphs.processes
    hot, cold = iphs.E
    lam = iphs.symbols["lam"]
    assert process.bracket == hot - cold
    assert (process.gamma - lam / (hot * cold)).expand() == 0
    assert list(process.J) == [0, -1, 1, 0]


def test_an_oscillator_that_heats_itself():
    run = simulate(parse(OSCILLATOR), duration=200.0, rtol=1e-11, times=[0.0, 5.0, 200.0])
    assert run.q.values[1] == pytest.approx(-0.336851680590, abs=1e-9)
    assert run.p.values[1] == pytest.approx(0.370691413969, abs=1e-9)
    assert run.T_body.values[1] == pytest.approx(300.852177914186, abs=1e-8)
    assert run.T_body.values[2] == pytest.approx(301.0, abs=1e-7)


def test_a_circuit_with_a_thermistor_ends_at_400_kelvin():
    run = simulate(parse(THERMISTOR), duration=0.1, rtol=1e-9, method="Radau", times=[0.0, 0.1])
    assert run.T_body.values[1] == pytest.approx(400.0, rel=1e-6)
    assert abs(float(run.energy_residual[1])) < 1e-8
