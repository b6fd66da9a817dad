"""Networks with right-hand sides that can be written by hand: general roads, no special case.

Each case is a spec and its rates, typed from Kirchhoff's and Newton's laws.  Checked are the rates
of the generated module, its Jacobian against differences, the power balance, and the exact proofs.
"""

import numpy as np
import pytest

from piezo_sym import derive, verify
from piezo_sym.modules import module_of
from piezo_sym.spec.load import parse
from piezo_sym.verification import process

#: Those who run a model and those who look at its rows need the same report.
pytestmark = pytest.mark.usefixtures("known_reports")

HEAD = """
[model]
name = "case"
[parameters]
R   = { value = 2.0,   unit = "ohm" }
C   = { value = 0.1,   unit = "F" }
L   = { value = 0.3,   unit = "H" }
rho = { value = 0.5,   unit = "ohm" }
b   = { value = 0.5,   unit = "ohm/A**2" }
g   = { value = 0.5,   unit = "A/V**3" }
i_0 = { value = 0.1,   unit = "A" }
m   = { value = 1.5,   unit = "kg" }
k   = { value = 2.0,   unit = "N/m" }
d   = { value = 0.7,   unit = "N*s/m" }
T_0 = { value = 300.0, unit = "K" }
c   = { value = 2.0,   unit = "J/K" }
[inputs]
V = { unit = "V" }
w = { unit = "m/s" }
I = { unit = "A" }
[domain]
assume = ["i_0 >= 0", "R > 0", "rho >= 0", "d > 0", "b >= 0", "g >= 0"]
[elements]
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
source = { kind = "voltage_source", between = ["in", "gnd"], input = "V" }
"""
V, W, DRAIN = 1.3, -0.4, 0.25
P = {"R": 2.0, "C": 0.1, "L": 0.3, "rho": 0.5, "b": 0.5, "i_0": 0.1, "m": 1.5, "k": 2.0, "d": 0.7}


def hot(S):
    return 300.0 * np.exp(S / 2.0)


def dead(i):
    return np.maximum(i - P["i_0"], 0) + np.minimum(i + P["i_0"], 0)


def amplifier(law):
    return f"""
    R1 = {{ kind = "resistor", between = ["in", "n"], {law}, heats = "body" }}
    C1 = {{ kind = "capacitor", between = ["n", "gnd"], capacitance = "C", state = "Q" }}
    """


def amplifier_rates(x):
    S, Q = x
    v = V - Q / P["C"]
    return [v**2 / P["R"] / hot(S), v / P["R"]]


def bank(law, count):
    return f"""
    R1 = {{ kind = "resistor", between = ["in", "n"], {law}, heats = "body" }}
    h = {{ kind = "hysteron", between = ["n", "cap"], count = {count}, inductance = "L",
           voltage = "rho*deadzone(i, i_0)", heats = "body", state = "phi" }}
    C1 = {{ kind = "capacitor", between = ["cap", "gnd"], capacitance = "C", state = "Q" }}
    """.replace('L",\n', 'L",').replace("\n           ", " ")


def bank_rates(x):
    S, *phi, Q = x
    i = np.array(phi) / P["L"]
    drop = P["rho"] * dead(i)
    heat = P["R"] * i.sum() ** 2 + (drop * i).sum()
    return [heat / hot(S), *(V - P["R"] * i.sum() - drop - Q / P["C"]), i.sum()]


def series_rates(x):
    S, Q = x
    v = Q / P["C"]
    other = P["rho"] * hot(S) / 300.0
    through, supplied = v / (P["R"] + other), (V - v) / P["R"]
    heat = P["R"] * supplied**2 + (P["R"] + other) * through**2
    return [heat / hot(S), supplied - through]


def bridge_rates(x):
    """Solve for the nodes a, b, c with the coil's current as given: conductances times heights."""
    S, phi = x
    R, i = P["R"], phi / P["L"]
    links = [
        (0, None, R),
        (0, 1, 2 * R),
        (0, 2, 3 * R),
        (1, 3, 4 * R),
        (2, 3, 5 * R),
        (1, 2, 6 * R),
    ]
    matrix, drawn = np.zeros((3, 3)), np.array([V / R, 0, -i])
    for a, b, r in links:
        for one, other in ((a, b), (b, a)):
            if one in (0, 1, 2):
                matrix[one, one] += 1 / r
                if other in (0, 1, 2):
                    matrix[one, other] -= 1 / r
    e = np.append(np.linalg.solve(matrix, drawn), 0)
    heat = sum(((V if b is None else e[b]) - e[a]) ** 2 / r for a, b, r in links)
    return [heat / hot(S), e[2]]


CASES = {
    "an amplifier's output resistance before a capacitor": (
        amplifier('current = "v/R"'),
        amplifier_rates,
    ),
    "the same, its law turned round": (amplifier('voltage = "R*i"'), amplifier_rates),
    "an amplifier's output resistance before a bank": (bank('current = "v/R"', 3), bank_rates),
    "the same, its law as needed": (bank('voltage = "R*i"', 3), bank_rates),
    "a bank of one": (bank('voltage = "R*i"', 1), bank_rates),
    "a damper between a velocity source and a mass": (
        """
        push = { kind = "velocity_source", at = "a", input = "w" }
        grip = { kind = "damper", between = ["a", "b"], force = "d*v", heats = "body" }
        mass = { kind = "mass", at = "b", mass = "m", state = "p" }
        R1 = { kind = "resistor", between = ["in", "gnd"], current = "v/R", heats = "body" }
        """,
        lambda x: [
            (P["d"] * (W - x[1] / P["m"]) ** 2 + V**2 / P["R"]) / hot(x[0]),
            P["d"] * (W - x[1] / P["m"]),
        ],
    ),
    "a resistor of a current law across a voltage source heats V**2/R": (
        'R1 = { kind = "resistor", between = ["in", "gnd"], current = "v/R", heats = "body" }',
        lambda x: [V**2 / P["R"] / hot(x[0])],
    ),
    "two resistors in series with an inductor": (
        """
        R1 = { kind = "resistor", between = ["in", "n"], current = "v/R", heats = "body" }
        R2 = { kind = "resistor", between = ["n", "o"], voltage = "b*i**3", heats = "body" }
        L1 = { kind = "inductor", between = ["o", "gnd"], inductance = "L", state = "phi" }
        """,
        lambda x: [
            (P["R"] * (x[1] / P["L"]) ** 2 + P["b"] * (x[1] / P["L"]) ** 4) / hot(x[0]),
            V - P["R"] * x[1] / P["L"] - P["b"] * (x[1] / P["L"]) ** 3,
        ],
    ),
    "a current source at a voltage source": (
        """
        drain = { kind = "current_source", between = ["in", "gnd"], input = "I" }
        R1 = { kind = "resistor", between = ["in", "gnd"], current = "v/R", heats = "body" }
        """,
        lambda x: [V**2 / P["R"] / hot(x[0])],
    ),
    "two linear resistors in series across a capacitor": (
        """
        R1 = { kind = "resistor", between = ["in", "c"], current = "v/R", heats = "body" }
        C1 = { kind = "capacitor", between = ["c", "gnd"], capacitance = "C", state = "Q" }
        R2 = { kind = "resistor", between = ["c", "n"], current = "v/R", heats = "body" }
        R3 = { kind = "resistor", between = ["n", "gnd"], voltage = "rho*i*T/T_0", heats = "body" }
        """,
        series_rates,
    ),
    "a bridge of five resistors, driven through a sixth": (
        """
        R0 = { kind = "resistor", between = ["in", "a"], current = "v/R", heats = "body" }
        R1 = { kind = "resistor", between = ["a", "b"], current = "v/(2*R)", heats = "body" }
        R2 = { kind = "resistor", between = ["a", "c"], voltage = "3*R*i", heats = "body" }
        R3 = { kind = "resistor", between = ["b", "gnd"], current = "v/(4*R)", heats = "body" }
        R4 = { kind = "resistor", between = ["c", "gnd"], voltage = "5*R*i", heats = "body" }
        R5 = { kind = "resistor", between = ["b", "c"], current = "v/(6*R)", heats = "body" }
        L1 = { kind = "inductor", between = ["c", "gnd"], inductance = "L", state = "phi" }
        """,
        bridge_rates,
    ),
    "two dampers in series between a mass and the wall": (
        """
        R1 = { kind = "resistor", between = ["in", "gnd"], current = "v/R", heats = "body" }
        m1 = { kind = "mass", at = "a", mass = "m", state = "p" }
        d1 = { kind = "damper", between = ["a", "b"], force = "d*v", heats = "body" }
        d2 = { kind = "damper", between = ["b", "wall"], force = "3*d*v", heats = "body" }
        """,
        lambda x: [
            (V**2 / P["R"] + 0.75 * P["d"] * (x[1] / P["m"]) ** 2) / hot(x[0]),
            -0.75 * P["d"] * x[1] / P["m"],
        ],
    ),
    "springs in a loop": (
        """
        R1 = { kind = "resistor", between = ["in", "gnd"], current = "v/R", heats = "body" }
        s1 = { kind = "spring", between = ["a", "wall"], stiffness = "k", state = "q1" }
        s2 = { kind = "spring", between = ["a", "b"], stiffness = "k", state = "q2" }
        s3 = { kind = "spring", between = ["b", "wall"], stiffness = "k", state = "q3" }
        m1 = { kind = "mass", at = "a", mass = "m", state = "p1" }
        m2 = { kind = "mass", at = "b", mass = "m", state = "p2" }
        """,
        lambda x: [
            V**2 / P["R"] / hot(x[0]),
            x[4] / P["m"],
            (x[4] - x[5]) / P["m"],
            x[5] / P["m"],
            -P["k"] * (x[1] + x[2]),
            P["k"] * (x[2] - x[3]),
        ],
    ),
}
U = np.array([V, W, DRAIN])


@pytest.fixture(scope="module", params=CASES.values(), ids=CASES)
def case(request):
    text, rates = request.param
    model = parse(HEAD + text.replace("\n        ", "\n").replace("\n    ", "\n"))
    return model, module_of(model), rates


def states(module):
    rng = np.random.default_rng(5)
    size = len(module.initial_state(U, module.Parameters()))
    return [rng.uniform(-0.5, 0.5, size) for _ in range(10)]


@pytest.mark.some(1)
def test_rates(case):
    _, module, rates = case
    for x in states(module):
        assert np.allclose(module.rhs(x, U, module.Parameters()), rates(x), rtol=1e-12, atol=1e-13)


@pytest.mark.some(3)
def test_jacobian(case):
    _, module, _ = case
    p, h = module.Parameters(), 1e-6
    for x in states(module):
        steps = np.eye(len(x)) * h
        slopes = [(module.rhs(x + e, U, p) - module.rhs(x - e, U, p)) / (2 * h) for e in steps]
        assert np.allclose(module.jacobian(x, U, p), np.transpose(slopes), rtol=1e-6, atol=1e-7)


@pytest.mark.some(3)
def test_power_balance(case):
    _, module, _ = case
    p, h = module.Parameters(), 1e-5
    for x in states(module):
        rate = module.rhs(x, U, p)
        slope = (module.energy(x + h * rate, p) - module.energy(x - h * rate, p)) / (2 * h)
        assert np.isclose(slope, module.supply(x, U, p).sum(), rtol=1e-6, atol=1e-6)


@pytest.mark.some(5)
def test_entropy_balance(case):
    _, module, _ = case
    p = module.Parameters()
    for x in states(module):
        produced = module.entropy_production(x, U, p)
        assert np.all(produced >= 0)
        assert np.isclose(module.rhs(x, U, p)[0], produced.sum(), rtol=1e-12)


@pytest.mark.some(1)
def test_proofs(case):
    model, _, _ = case
    process.examined(model).raise_if_not_proved()
    verify(derive(model).expand()).raise_if_not_proved()


REFUSED = {
    "a voltage source across a capacitor": (
        'C1 = { kind = "capacitor", between = ["in", "gnd"], capacitance = "C" }',
        "'source', 'C1' fix each other",
    ),
    "two nonlinear resistors in series across a capacitor": (
        """
        R0 = { kind = "resistor", between = ["in", "c"], current = "v/R", heats = "body" }
        R1 = { kind = "resistor", between = ["c", "n"], current = "g*v**3", heats = "body" }
        R2 = { kind = "resistor", between = ["n", "gnd"], current = "g*v**3", heats = "body" }
        C1 = { kind = "capacitor", between = ["c", "gnd"], capacitance = "C" }
        """,
        "'R1', 'R2' fix each other",
    ),
    "a linear and a nonlinear resistor in series across a capacitor": (
        """
        R0 = { kind = "resistor", between = ["in", "c"], current = "v/R", heats = "body" }
        R1 = { kind = "resistor", between = ["c", "n"], current = "v/R", heats = "body" }
        R2 = { kind = "resistor", between = ["n", "gnd"], voltage = "rho*i**3", heats = "body" }
        C1 = { kind = "capacitor", between = ["c", "gnd"], capacitance = "C" }
        """,
        "elements.R2: 'R1', 'R2' determine each other's flow; .*put a capacitor at node",
    ),
    "nine linear resistors in series across a capacitor": (
        """
        R0 = { kind = "resistor", between = ["in", "0"], current = "v/R", heats = "body" }
        C1 = { kind = "capacitor", between = ["0", "gnd"], capacitance = "C" }
        """
        + "".join(
            f"""
        R{n + 1} = {{ kind = "resistor", between = ["{n}", "{n + 1 if n < 8 else "gnd"}"],
         current = "v/R", heats = "body" }}""".replace("\n         current", " current")
            for n in range(9)
        ),
        "expected at most 8 that do",
    ),
    "two banks in series through a bare node": (
        """
        h1 = { kind = "hysteron", between = ["in", "n"], count = 2, LAW }
        h2 = { kind = "hysteron", between = ["n", "gnd"], count = 3, LAW }
        """.replace("LAW", 'inductance = "L", voltage = "R*i", heats = "body"'),
        "'h1', 'h2' fix each other",
    ),
}


@pytest.mark.parametrize(("text", "culprits"), REFUSED.values(), ids=REFUSED)
def test_impossible_networks_name_their_culprits(text, culprits):
    with pytest.raises(Exception, match=culprits) as caught:
        derive(parse(HEAD + text.replace("\n        ", "\n")))
    assert caught.value.exit_code == 2
    assert caught.value.remedy
