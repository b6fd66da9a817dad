"""Laws that see other states and temperatures, against rates written by hand and run by SciPy.

A coil whose resistance depends on another body's temperature and on a position, a damper that
depends on a position (with a kink), radiation between two bodies and to the environment, a
transducer whose ratio depends on position and temperature: all in one machine.
"""

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp

from piezo_sym import derive, simulate, sine
from piezo_sym.proofs import Verdict, decide
from piezo_sym.spec.load import parse

SPEC = """
[model]
name = "moving_coil"
[parameters]
M = { value = 1.0, unit = "kg" }
k = { value = 100.0, unit = "N/m" }
L = { value = 0.1, unit = "H" }
R = { value = 2.0, unit = "ohm" }
al = { value = 0.02, unit = "1/K" }
g = { value = 1.0, unit = "m" }
q_0 = { value = 0.02, unit = "m" }
T_0 = { value = 300.0, unit = "K" }
c = { value = 2.0, unit = "J/K" }
lam = { value = 0.1, unit = "W/K" }
sig = { value = 1e-8, unit = "W/K**4" }
d = { value = 1.0, unit = "N*s/m" }
a = { value = 2.0, unit = "C/m" }
C = { value = 0.1, unit = "F" }
[inputs]
V = { unit = "V" }
T_e = { unit = "K", default = 310.0 }
[domain]
assume = ["sig >= 0", "lam >= 0", "d >= 0", "R >= 0", "al >= 0", "g > 0", "q_0 > 0", "q > -g",
    "a > 0", "T_hot > T_0", "T_cold > T_0", "T_e > 0"]
[initial]
S_hot = "c*0.1"
S_cold = "c*0.05"
[elements]
spring = { kind = "spring", between = ["tip", "wall"], stiffness = "k", state = "q" }
mass = { kind = "mass", at = "tip", mass = "M", state = "p" }
cap = { kind = "capacitor", between = ["b", "gnd"], capacitance = "C", state = "Q" }
coil = { kind = "inductor", between = ["in", "a"], inductance = "L", state = "phi" }
hot = { kind = "thermal_mass", temperature = "T_0*exp(S/c)" }
cold = { kind = "thermal_mass", temperature = "T_0*exp(S/c)" }
supply = { kind = "voltage_source", between = ["in", "gnd"], input = "V" }
[elements.wire]
kind = "resistor"
between = ["a", "b"]
voltage = "R*(1 + al*(T_cold - T_0))*(1 + q**2/g**2)*i"
heats = "hot"
[elements.drag]
kind = "damper"
between = ["tip", "wall"]
force = "d*v*(2 if q > q_0 else 1 + q**2/q_0**2)"
heats = "cold"
[elements.piezo]
kind = "transducer"
electrical = ["b", "gnd"]
mechanical = ["tip", "wall"]
ratio = "a*(1 + q/g)*T_cold/T_0"
[elements.rad]
kind = "conduction"
between = ["hot", "cold"]
conductance = "sig*(T_1**2 + T_2**2)*(T_1 + T_2)"
[elements.air]
kind = "ambient"
body = "cold"
conductance = "lam + sig*(T**2 + T_e**2)*(T + T_e)"
input = "T_e"
"""
P = dict(M=1.0, k=100.0, L=0.1, R=2.0, al=0.02, g=1.0, q_0=0.02, T_0=300.0, c=2.0, lam=0.1)
P |= dict(sig=1e-8, d=1.0, a=2.0, C=0.1)
STATES = ("q", "p", "Q", "phi", "S_hot", "S_cold")
START = (0.0, 0.0, 0.0, 0.0, 0.2, 0.1)


def rates(x, V, T_e, p=P):
    """Return dx/dt, typed from Newton's, Kirchhoff's and Stefan's laws."""
    q, momentum, charge, flux, s_hot, s_cold = x
    v, current, voltage = momentum / p["M"], flux / p["L"], charge / p["C"]
    hot, cold = (p["T_0"] * np.exp(s / p["c"]) for s in (s_hot, s_cold))
    drop = p["R"] * (1 + p["al"] * (cold - p["T_0"])) * (1 + (q / p["g"]) ** 2) * current
    force = p["d"] * v * (2 if q > p["q_0"] else 1 + (q / p["q_0"]) ** 2)
    ratio = p["a"] * (1 + q / p["g"]) * cold / p["T_0"]
    radiated = p["sig"] * (hot**4 - cold**4)
    outside = p["lam"] * (T_e - cold) + p["sig"] * (T_e**4 - cold**4)
    return [
        v,
        -p["k"] * q - force + ratio * voltage,
        current - ratio * v,
        V - drop - voltage,
        (drop * current - radiated) / hot,
        (force * v + radiated + outside) / cold,
    ]


def supply(t):
    return 20 * np.sin(2 * np.pi * 2 * t)


@pytest.fixture(scope="module")
def model():
    return parse(SPEC)


@pytest.fixture(scope="module")
def iphs(model):
    return derive(model)


def test_all_is_proved(iphs):
    assert {row.verdict for row in decide(iphs).rows} == {Verdict.PROVED}


def test_the_structure_is_that_found_by_hand(iphs):
    q, Q, phi, p, s_hot, s_cold = (iphs.symbols[n] for n in ("q", "Q", "phi", "p", *STATES[4:]))
    a, g, M, L, c, T_0 = (iphs.symbols[n] for n in ("a", "g", "M", "L", "c", "T_0"))
    ratio = a * (1 + q / g) * sp.exp(s_cold / c)
    expected = sp.zeros(6, 6)
    pairs = {("q", "p"): 1, ("p", "Q"): ratio, ("Q", "phi"): 1}
    for (row, col), value in pairs.items():
        n, m = STATES.index(row), STATES.index(col)
        expected[n, m], expected[m, n] = value, -value
    assert sp.simplify(iphs.J0 - expected) == sp.zeros(6, 6)
    brackets = [process.bracket for process in iphs.processes]
    by_hand = [phi / L, p / M, T_0 * (sp.exp(s_hot / c) - sp.exp(s_cold / c))]
    assert [sp.simplify(b - h) for b, h in zip(brackets, by_hand, strict=True)] == [0, 0, 0]
    assert not {q, Q} & brackets[0].free_symbols


@pytest.mark.parametrize("seed", range(5))
def test_rates_are_those_typed_by_hand(iphs, seed):
    random = np.random.default_rng(seed)
    x = random.uniform((-0.5, -2, -1, -1, 0.1, 0.1), (0.5, 2, 1, 1, 0.5, 0.5))
    values = dict(zip(STATES, x, strict=True)) | P | {"V": 3.0, "T_e": 350.0}
    named = {iphs.symbols[name]: value for name, value in values.items()}
    found = [float(rate.xreplace(named)) for rate in iphs.rhs]
    assert found == pytest.approx(rates(x, 3.0, 350.0), rel=1e-12, abs=1e-12)


@pytest.mark.some(1)
@pytest.mark.parametrize("rtol", [1e-5, 1e-8])
def test_a_run_is_that_of_scipy_and_its_balances_close(model, rtol):
    run = simulate(model, inputs={"V": sine(20, 2)}, duration=1.0, rtol=rtol)
    exact = solve_ivp(
        lambda t, x: rates(x, supply(t), 310.0),
        (0, 1),
        START,
        method="DOP853",
        rtol=1e-11,
        atol=1e-13,
        max_step=1e-3,
        t_eval=run.time.values,
    )
    for name, row in zip(STATES, exact.y, strict=True):
        error = np.abs(run[name].values - row).max() / np.abs(row).max()
        assert error < 10 * rtol, name
    energy = run.energy.values
    moved = np.ptp(energy) + float(np.abs(np.diff(run.supplied_supply.values)).sum())
    bound = 1e-12 * moved + 4 * np.spacing(np.abs(energy).max())
    assert np.abs(run.energy_residual.values).max() <= bound
    for name in ("wire", "drag", "rad"):
        assert np.diff(run[f"produced_{name}"].values).min() >= 0
    entropy = run.entropy.values
    made = sum(run[f"produced_{n}"].values for n in ("wire", "drag", "rad"))
    left = entropy - entropy[0] - made - run.entropy_exchanged_air.values
    assert np.abs(left).max() <= 1e-12 * (np.abs(entropy).max() + np.abs(made).max())
