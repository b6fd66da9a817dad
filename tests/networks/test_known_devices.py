"""Couplings of domains by hand: structure matrices entry by entry, and rates, with their signs."""

from pathlib import Path

import numpy as np
import pytest
import sympy as sp

from piezo_sym import derive, load
from piezo_sym.modules import module_of
from piezo_sym.proofs import obligations
from piezo_sym.spec.load import parse

SPECS = Path(__file__).with_name("specs")
HEAD = """[model]
name = "case"
[parameters]
M = { value = 1.5, unit = "kg" }
I = { value = 0.2, unit = "kg*m**2" }
K = { value = 2.0, unit = "N/m" }
L = { value = 0.3, unit = "H" }
C = { value = 0.1, unit = "F" }
H = { value = 0.4, unit = "m**3/Pa" }
r = { value = 0.7, unit = "m" }
k = { value = 0.6, unit = "V*s/m" }
a = { value = 0.9, unit = "C/m" }
D = { value = 0.8, unit = "m**3/rad" }
[elements]
"""
RACK = """
rotor = { kind = "inertia", at = "hub", inertia = "I", state = "L_r" }
rack  = { kind = "rack", translation = ["cart", "wall"], rotation = ["hub", "frame"], radius = "r" }
link  = { kind = "spring", between = ["cart", "block"], stiffness = "K", state = "q" }
block = { kind = "mass", at = "block", mass = "M", state = "p" }
"""
COIL = """
coil  = { kind = "inductor", between = ["gnd", "n"], inductance = "L", state = "phi" }
motor = { kind = "motor", electrical = ["n", "gnd"], translation = ["tip", "wall"], constant = "k" }
mass  = { kind = "mass", at = "tip", mass = "M", state = "p" }
"""
STACK = """
stack = { kind = "capacitor", between = ["in", "gnd"], capacitance = "C", state = "Q" }
piezo = { kind = "transducer", electrical = ["in", "gnd"], PAIR = ["tip", "wall"], ratio = "a" }
mass  = { kind = "mass", at = "tip", mass = "M", state = "p" }
"""
BEHIND = """
rotor = { kind = "inertia", at = "shaft", inertia = "I", state = "L_r" }
pump  = { kind = "pump", rotation = ["frame", "shaft"], hydraulic = ["a", "b"], displacement = "D" }
one   = { kind = "accumulator", between = ["a", "tank"], capacitance = "H", state = "V_a" }
two   = { kind = "accumulator", between = ["b", "tank"], capacitance = "H", state = "V_b" }
"""

# Rows of J0 above the diagonal, x' = J0 E: what each co-state does to each rate.
CASES = {
    "a geared motor": (
        load(SPECS / "geared_motor.toml"),
        {
            ("phi", "L_r"): "-k",  # the voltage that turning induces
            ("L_r", "theta"): "-1/n",  # the shaft's torque, less by the gear
            ("theta", "L_l"): "-1",
        },
    ),
    "a hydraulic cylinder and its pump": (
        load(SPECS / "hydraulic_cylinder.toml"),
        {
            ("L", "V_l"): "-D",  # pressure brakes the pump
            ("V_l", "G"): "-1",
            ("G", "V_c"): "-1",
            ("V_c", "p"): "-A",  # the piston makes room
            ("p", "q"): "-1",
        },
    ),
    "a rack and a rotor": (parse(HEAD + RACK), {("L_r", "q"): "-r", ("q", "p"): "-1"}),
    "a voice coil": (parse(HEAD + COIL), {("phi", "p"): "-k"}),  # moving, it holds the current back
    "a transducer": (
        parse(HEAD + STACK.replace("PAIR", "translation")),
        {("Q", "p"): "-a"},
    ),
    "a transducer by its other name": (
        parse(HEAD + STACK.replace("PAIR", "mechanical")),
        {("Q", "p"): "-a"},
    ),
    "a pump between two chambers, its shaft turned round": (
        parse(HEAD + BEHIND),
        {("L_r", "V_a"): "D", ("L_r", "V_b"): "-D"},
    ),
}


@pytest.mark.parametrize(("model", "upper"), CASES.values(), ids=CASES)
def test_the_structure_matrix_is_that_by_hand(model, upper):
    iphs = derive(model)
    names = [slot.label for slot in iphs.system.states]
    value = {name: iphs.symbols[name] for name in model.parameters} | {"1": sp.S.One}
    wanted = {}
    for (row, col), text in upper.items():
        sign, over = -1 if text.startswith("-") else 1, text.lstrip("-").split("/")
        entry = sign * value[over[0]] / (value[over[1]] if len(over) > 1 else 1)
        wanted |= {(row, col): entry, (col, row): -entry}
    for r, row in enumerate(names):
        for c, col in enumerate(names):
            found = iphs.J0[r, c]
            assert found == wanted.get((row, col), 0), (row, col)


def test_the_rates_of_the_geared_motor():
    p, module = CASES["a geared motor"][0].parameters, module_of(CASES["a geared motor"][0])
    R, L, k, n, I_r, I_l, k_s, d = (p[x].si for x in ["R", "L", "k", "n", "I_r", "I_l", "k_s", "d"])
    V, load = 12.0, -0.2
    for x in np.random.default_rng(1).uniform(-0.5, 0.5, (5, 5)):
        phi, L_r, theta, L_l, S = x
        i, omega, shaft = phi / L, L_l / I_l, k_s * theta
        wanted = [
            V - R * i - k * L_r / I_r,
            k * i - shaft / n,
            L_r / I_r / n - omega,
            shaft - d * omega + load,
            (R * i**2 + d * omega**2) / (300 * np.exp(S / 2)),
        ]
        found = module.rhs(x, np.array([V, load]), module.Parameters())
        assert found == pytest.approx(wanted, rel=1e-12)
    assert list(module.outputs(x, np.array([V, load]), module.Parameters())) == pytest.approx(
        [i, omega]
    )


def test_the_rates_of_the_hydraulic_cylinder():
    case = CASES["a hydraulic cylinder and its pump"][0]
    p, module = case.parameters, module_of(case)
    I_p, D, C_l, L_h, C_c, g, R, A, M, k = (
        p[x].si for x in ["I_p", "D", "C_l", "L_h", "C_c", "g", "R", "A", "M", "k"]
    )
    tau, F = 0.3, -0.1
    for x in np.random.default_rng(2).uniform(-0.5, 0.5, (5, 7)):
        L, V_l, G, V_c, momentum, q, S = x
        flow, pressure, v = G / L_h, V_c / C_c, momentum / M
        wanted = [
            tau - D * V_l / C_l,
            D * L / I_p - flow,
            V_l / C_l - R * flow - pressure,
            flow - g * pressure - A * v,
            A * pressure - k * q + F,
            v,
            (R * flow**2 + g * pressure**2) / (300 * np.exp(S / 2)),
        ]
        found = module.rhs(x, np.array([tau, F]), module.Parameters())
        assert found == pytest.approx(wanted, rel=1e-12)


def test_the_rates_of_the_heater():
    model = load(SPECS / "heater.toml")
    module, (P, T_e) = module_of(model), (3.0, 310.0)
    p, u = module.Parameters(), np.array([P, T_e])
    for x in np.random.default_rng(3).uniform(0.1, 0.5, (5, 2)):
        body, mount = 300 * np.exp(x / 2)
        wanted = [
            (P - 0.5 * (body - mount)) / body,
            (0.5 * (body - mount) + 0.5 * (T_e - mount)) / mount,
        ]
        assert module.rhs(x, u, p) == pytest.approx(wanted, rel=1e-12)
        assert module.outputs(x, u, p) == pytest.approx([body, mount], rel=1e-12)
        assert module.supply(x, u, p) == pytest.approx([P, 0.5 * (T_e - mount)], rel=1e-12)


def test_a_floor_is_promised_of_bodies_without_a_source_of_heat():
    iphs = derive(load(SPECS / "heater.toml"))
    assert [o.element for o in obligations(iphs) if o.id == "invariant"] == ["mount"]
    text = (SPECS / "heater.toml").read_text().replace('into = "body"', 'into = "mount"')
    assert [o for o in obligations(derive(parse(text))) if o.id == "invariant"] == []
