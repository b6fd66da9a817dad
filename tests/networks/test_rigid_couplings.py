"""Stores that depend on each other become one state, or a few: each case worked out by hand."""

from dataclasses import dataclass

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp

from piezo_sym import derive, simulate, sine
from piezo_sym.spec.elements.ports import Storage
from piezo_sym.spec.load import parse
from piezo_sym.verification import process

#: Those who run a model and those who look at its rows need the same report.
pytestmark = pytest.mark.usefixtures("known_reports")

HEAD = """
[model]
name = "joined"
[parameters]
m_1 = { value = 1.3,   unit = "kg" }
m_2 = { value = 0.7,   unit = "kg" }
m_3 = { value = 0.4,   unit = "kg" }
k   = { value = 4.0,   unit = "N/m" }
k_2 = { value = 9.0,   unit = "N/m" }
l_1 = { value = 0.5,   unit = "m" }
l_2 = { value = -0.2,  unit = "m" }
F_0 = { value = 9.0,   unit = "N" }
J_1 = { value = 0.9,   unit = "kg*m**2" }
J_2 = { value = 0.3,   unit = "kg*m**2" }
rad = { value = 0.25,  unit = "m" }
kap = { value = 2.0,   unit = "N*m" }
b   = { value = 0.4,   unit = "N*m*s" }
d   = { value = 0.4,   unit = "N*s/m" }
n   = { value = 1.7,   unit = "1" }
C_1 = { value = 0.3,   unit = "F" }
C_2 = { value = 0.8,   unit = "F" }
L_1 = { value = 0.6,   unit = "H" }
L_2 = { value = 0.9,   unit = "H" }
R   = { value = 0.5,   unit = "ohm" }
a   = { value = 0.7,   unit = "C/m" }
T_0 = { value = 300.0, unit = "K" }
c   = { value = 2.0,   unit = "J/K" }
[inputs]
F = { unit = "N" }
V = { unit = "V" }
G = { unit = "N*m" }
[domain]
assume = ["d >= 0", "R > 0", "n > 0", "a > 0", "rad > 0", "b >= 0"]
[initial]
START
[elements]
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
"""
DAMPED = """
damper = { kind = "damper", between = ["b", "wall"], force = "d*v", heats = "body" }
push = { kind = "force_source", at = "b", input = "F" }
"""
TWISTED = """
twist = { kind = "torque_source", at = "x", input = "G" }
"""
FED = """
supply = { kind = "voltage_source", between = ["in", "gnd"], input = "V" }
"""


@dataclass(frozen=True)
class Case:
    """A network; by hand its states and U, and the rates but for S', in the symbols of the spec.

    `costates` are those of stores that are not kept.
    """

    elements: str
    states: str
    energy: str
    rates: tuple[str, ...]
    costates: dict


CASES = {
    "two masses on one node": Case(
        """
m1 = { kind = "mass", at = "b", mass = "m_1", state = "p" }
m2 = { kind = "mass", at = "b", mass = "m_2" }
spring = { kind = "spring", between = ["b", "wall"], stiffness = "k", state = "q" }
"""
        + DAMPED,
        "S p q",
        "p**2/(2*(m_1 + m_2)) + k*q**2/2",
        ("F - k*q - d*p/(m_1 + m_2)", "p/(m_1 + m_2)"),
        {"v_m2": "p/(m_1 + m_2)"},
    ),
    # v_a = n v_b: all is moved to a, where the mass is m_1 + m_2/n^2 and forces at b are F/n
    "two masses on a lever": Case(
        """
m1 = { kind = "mass", at = "a", mass = "m_1", state = "p" }
m2 = { kind = "mass", at = "b", mass = "m_2" }
lever = { kind = "lever", first = ["a", "wall"], second = ["b", "wall"], ratio = "n" }
spring = { kind = "spring", between = ["a", "wall"], stiffness = "k", state = "q" }
"""
        + DAMPED,
        "S p q",
        "p**2/(2*(m_1 + m_2/n**2)) + k*q**2/2",
        ("F/n - k*q - d*p/(m_1 + m_2/n**2)/n**2", "p/(m_1 + m_2/n**2)"),
        {"v_m2": "p/(m_1 + m_2/n**2)/n"},
    ),
    "the same lever, the other mass first": Case(
        """
m2 = { kind = "mass", at = "b", mass = "m_2", state = "p" }
m1 = { kind = "mass", at = "a", mass = "m_1" }
lever = { kind = "lever", first = ["a", "wall"], second = ["b", "wall"], ratio = "n" }
spring = { kind = "spring", between = ["a", "wall"], stiffness = "k", state = "q" }
"""
        + DAMPED,
        "S p q",
        "p**2/(2*(m_2 + n**2*m_1)) + k*q**2/2",
        ("F - n*k*q - d*p/(m_2 + n**2*m_1)", "n*p/(m_2 + n**2*m_1)"),
        {"v_m1": "n*p/(m_2 + n**2*m_1)"},
    ),
    # one behind the other, the second drawn from b to its inner node: F_2 = -F_1 pulls b back,
    # so that the length of both is q = q_1 - q_2, at rest l_1 - l_2
    "springs in series": Case(
        """
s1 = { kind = "spring", between = ["wall", "i"], stiffness = "k", rest = "l_1", state = "q" }
s2 = { kind = "spring", between = ["b", "i"], stiffness = "k_2", rest = "l_2" }
mass = { kind = "mass", at = "b", mass = "m_1", state = "p" }
"""
        + DAMPED,
        "S q p",
        "(q - l_1 + l_2)**2/(2*(1/k + 1/k_2)) + p**2/(2*m_1)",
        ("-p/m_1", "F - d*p/m_1 + (q - l_1 + l_2)/(1/k + 1/k_2)"),
        {"F_s2": "-(q - l_1 + l_2)/(1/k + 1/k_2)"},
    ),
    # v_x = n v_y, fed through R and L_1 at x: charges add as Q_1 + Q_2/n
    "capacitors in parallel through a transformer": Case(
        """
coil = { kind = "inductor", between = ["in", "w"], inductance = "L_1", state = "phi" }
wire = { kind = "resistor", between = ["w", "x"], voltage = "R*i", heats = "body" }
C1 = { kind = "capacitor", between = ["x", "gnd"], capacitance = "C_1", state = "Q" }
C2 = { kind = "capacitor", between = ["y", "gnd"], capacitance = "C_2" }
trafo = { kind = "transformer", first = ["x", "gnd"], second = ["y", "gnd"], ratio = "n" }
"""
        + FED,
        "S phi Q",
        "phi**2/(2*L_1) + Q**2/(2*(C_1 + C_2/n**2))",
        ("V - R*phi/L_1 - Q/(C_1 + C_2/n**2)", "phi/L_1"),
        {"V_C2": "Q/(C_1 + C_2/n**2)/n"},
    ),
    "inductors in series": Case(
        """
L1 = { kind = "inductor", between = ["in", "x"], inductance = "L_1", state = "phi" }
L2 = { kind = "inductor", between = ["x", "y"], inductance = "L_2" }
C1 = { kind = "capacitor", between = ["y", "gnd"], capacitance = "C_1", state = "Q" }
wire = { kind = "resistor", between = ["y", "gnd"], current = "v/R", heats = "body" }
"""
        + FED,
        "S phi Q",
        "phi**2/(2*(L_1 + L_2)) + Q**2/(2*C_1)",
        ("V - Q/C_1", "phi/(L_1 + L_2) - Q/C_1/R"),
        {"i_L2": "phi/(L_1 + L_2)"},
    ),
    # i = a v: the mass is an inductance m_1/a^2 for the current, which meets V - a d v/a ...
    "an inductor and a mass on a transducer": Case(
        """
L1 = { kind = "inductor", between = ["in", "x"], inductance = "L_1", state = "phi" }
wire = { kind = "resistor", between = ["in", "gnd"], current = "v/R", heats = "body" }
m1 = { kind = "mass", at = "b", mass = "m_1" }
stack = { kind = "transducer", electrical = ["x", "gnd"], mechanical = ["b", "wall"], ratio = "a" }
"""
        + DAMPED
        + FED,
        "S phi",
        "phi**2/(2*(L_1 + m_1/a**2))",
        ("V + F/a - d/a**2*phi/(L_1 + m_1/a**2)",),
        {"v_m1": "phi/(L_1 + m_1/a**2)/a"},
    ),
    # omega_x = n omega_y, the load's inertia is J_2/n^2 at the motor's shaft
    "an inertia behind a gear": Case(
        """
rotor = { kind = "inertia", at = "x", inertia = "J_1", state = "w" }
load = { kind = "inertia", at = "y", inertia = "J_2" }
gear = { kind = "gear", first = ["x", "frame"], second = ["y", "frame"], ratio = "n" }
shaft = { kind = "torsion_spring", between = ["y", "frame"], stiffness = "kap", state = "theta" }
rub = { kind = "rotational_damper", between = ["x", "frame"], torque = "b*omega", heats = "body" }
"""
        + TWISTED,
        "S w theta",
        "w**2/(2*(J_1 + J_2/n**2)) + kap*theta**2/2",
        ("G - kap*theta/n - b*w/(J_1 + J_2/n**2)", "w/(J_1 + J_2/n**2)/n"),
        {"omega_load": "w/(J_1 + J_2/n**2)/n"},
    ),
    # v = rad omega: the rotor is a mass J_1/rad^2 on the rack, its torque a force G/rad
    "a mass on a rack with a rotor": Case(
        """
mass = { kind = "mass", at = "b", mass = "m_1", state = "p" }
rotor = { kind = "inertia", at = "x", inertia = "J_1" }
rack = { kind = "rack", translation = ["b", "wall"], rotation = ["x", "frame"], radius = "rad" }
spring = { kind = "spring", between = ["b", "wall"], stiffness = "k", state = "q" }
"""
        + DAMPED
        + TWISTED,
        "S p q",
        "p**2/(2*(m_1 + J_1/rad**2)) + k*q**2/2",
        ("F + G/rad - k*q - d*p/(m_1 + J_1/rad**2)", "p/(m_1 + J_1/rad**2)"),
        {"omega_rotor": "p/(m_1 + J_1/rad**2)/rad"},
    ),
    # v_a - v_i = n (v_i - v_b): v_i = (v_a + n v_b)/(1 + n) is the beam's own point
    "three masses on a beam": Case(
        """
m1 = { kind = "mass", at = "a", mass = "m_1", state = "p" }
m2 = { kind = "mass", at = "b", mass = "m_2", state = "r" }
m3 = { kind = "mass", at = "i", mass = "m_3" }
beam = { kind = "lever", first = ["a", "i"], second = ["i", "b"], ratio = "n" }
spring = { kind = "spring", between = ["a", "wall"], stiffness = "k", state = "q" }
"""
        + DAMPED,
        "S p r q",
        "(p*V_A + r*V_B)/2 + k*q**2/2",
        ("-k*q", "F - d*V_B", "V_A"),
        {"v_m3": "(V_A + n*V_B)/(1 + n)"},
    ),
}
#: The velocities of the beam: [[A, B], [B, D]] (V_A, V_B) = (p, r).
BEAM = {
    "A": "m_1 + m_3/(1 + n)**2",
    "B": "m_3*n/(1 + n)**2",
    "D": "m_2 + m_3*n**2/(1 + n)**2",
}


def meant(text, iphs):
    """Return an expression by hand in the symbols of a system."""
    names = {s.name: s for s in iphs.symbols.symbols.values()}
    A, B, D = (sp.sympify(BEAM[name], names) for name in "ABD")
    p, r = names.get("p", sp.Symbol("p")), names.get("r", sp.Symbol("r"))
    det = A * D - B**2
    names |= {"V_A": (D * p - B * r) / det, "V_B": (A * r - B * p) / det}
    return sp.sympify(text, names)


@pytest.fixture(params=CASES.values(), ids=CASES, scope="module")
def case(request):
    text = HEAD.replace("START", "") + request.param.elements
    return request.param, text, derive(parse(text))


def test_entry_by_entry(case):
    by_hand, _, iphs = case
    assert [s.name for s in iphs.x] == by_hand.states.split()
    energy = meant(by_hand.energy, iphs) + meant("c*T_0*exp(S/c)", iphs)
    assert sp.simplify(iphs.U - energy) == 0
    for rate, wanted in zip(iphs.rhs[1:], by_hand.rates, strict=True):
        assert sp.simplify(rate - meant(wanted, iphs)) == 0, wanted


def test_each_element_keeps_its_costate_and_its_energy(case):
    by_hand, _, iphs = case
    (joint,) = iphs.junction.joints
    law = {str(s.name): e for s, e in iphs.costates}
    found = {m.store.costate: iphs.symbols.law(joint.costate(m), law) for m in joint.followers}
    assert found.keys() == by_hand.costates.keys()
    for name, wanted in by_hand.costates.items():
        assert sp.simplify(found[name] - meant(wanted, iphs)) == 0
    together = sum(iphs.symbols.law(m.energy, law | found) for m in joint.members)
    others = [name for name in law if name not in {m.store.costate for m in joint.kept}]
    left = {iphs.symbols[p.state]: 0 for _, p in iphs.circuit.of(Storage) if p.costate in others}
    stored = iphs.U - meant("c*T_0*exp(S/c)", iphs)
    assert sp.simplify(together - stored.xreplace(left)) == 0


@pytest.mark.some(1)
def test_proved(case):
    _, _, iphs = case
    report = process.examined(iphs.model)
    report.raise_if_not_proved()
    assert {row.id for row in report.rows} >= {"energy", "entropy", "sigma", "units", "program"}


@pytest.mark.some(1)
def test_runs_agree_with_the_rates_by_hand(case):
    by_hand, text, iphs = case
    drive = {name: sine(2.0, 0.7) for name in iphs.model.inputs if f'input = "{name}"' in text}
    run = simulate(parse(text), inputs=drive, duration=3.0, rtol=1e-10)
    values = {iphs.symbols[n]: p.si for n, p in iphs.model.parameters.items()}
    states = [iphs.symbols[name] for name in by_hand.states.split()[1:]]
    inputs = [iphs.symbols[name] for name in iphs.model.inputs]
    rates = [meant(rate, iphs).subs(values) for rate in by_hand.rates]
    f = sp.lambdify([states, inputs], rates)
    force = lambda t: [2.0 * np.sin(2 * np.pi * 0.7 * t)] * len(inputs)  # noqa: E731
    wanted = solve_ivp(
        lambda t, x: f(x, force(t)), (0, 3.0), [0.0] * len(states), rtol=1e-11, atol=1e-12
    )
    for name, end in zip(by_hand.states.split()[1:], wanted.y[:, -1], strict=True):
        assert abs(float(run[name][-1]) - end) <= 1e-7 * abs(wanted.y).max()
    assert float(abs(run.energy_residual).max()) <= 1e-12 * float(run.energy[0])
