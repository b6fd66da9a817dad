"""Names that read like a lane's: a bank `h`, and elements `h_j` and `h_1` beside it.

The oracle is the network written down by hand: Kirchhoff's laws of two banks' worth of hysterons
and two single ones in parallel between a supply and a capacitor, each with a law of its own.
"""

from pathlib import Path

import numpy as np
import pytest
import sympy as sp

from piezo_sym import derive, generate, verify
from piezo_sym.errors import UsageError
from piezo_sym.module_cache import load_module
from piezo_sym.run.engine.engine import engine_of
from piezo_sym.spec.load import parse

SPEC = """
[model]
name = "alike"

[parameters]
C = { value = 2.0, unit = "F" }
L = { value = 0.5, unit = "H" }
L_2 = { value = 0.25, unit = "H" }
R = { value = 3.0, unit = "ohm" }
i_1 = { value = 2.0, unit = "A" }
T_0 = { value = 300.0, unit = "K" }
c = { value = 5.0, unit = "J/K" }

[inputs]
V_in = { unit = "V" }

[domain]
assume = ["R >= 0", "i_1 > 0", "phi_h**2 < 100*L*L*i_1*i_1"]

[elements.supply]
kind = "voltage_source"
between = ["in", "gnd"]
input = "V_in"

[elements.h]
kind = "hysteron"
between = ["in", "cap"]
count = 2
inductance = "L"
voltage = "R*i"
heats = "body"

[elements.NAME]
kind = "hysteron"
between = ["in", "cap"]
inductance = "L_2"
voltage = "2*R*i*(1 + (i/i_1)**2)"
heats = "body"
state = "STATE"

[elements.capacitor]
kind = "capacitor"
between = ["cap", "gnd"]
capacitance = "C"
state = "Q"

[elements.body]
kind = "thermal_mass"
temperature = "T_0*exp(S/c)"
state = "S"
"""
C, L, L_2, R, I_1, T_0, HEAT = 2.0, 0.5, 0.25, 3.0, 2.0, 300.0, 5.0
#: The single element's name, and its state's symbol.
NAMES = [("h_j", "phi"), ("h_1", "phi"), ("h_j", "i_h"), ("h_j", "phi_h_single"), ("i_h", "phi")]


def text(name, state):
    return SPEC.replace("NAME", name).replace("STATE", state)


def rates(x, u):
    """Return the rates of (phi_1 ... phi_r, phi of the single one, Q, S), by hand."""
    *lanes, single, charge, entropy = x
    V_C, temperature = charge / C, T_0 * np.exp(entropy / HEAT)
    currents = [phi / L for phi in lanes]
    i = single / L_2
    drops = [R * lane for lane in currents]
    drop = 2 * R * i * (1 + (i / I_1) ** 2)
    heat = sum(lane * V for lane, V in zip(currents, drops, strict=True)) + i * drop
    loops = [u[0] - V_C - V for V in (*drops, drop)]
    return np.array([*loops, sum(currents) + i, heat / temperature])


def states(r):
    draw = np.random.default_rng(7)
    for _ in range(5):
        yield draw.uniform(-1, 1, r + 3), draw.uniform(-2, 2, 1)


@pytest.fixture(scope="module", params=NAMES, ids=lambda pair: "-".join(pair))
def model(request):
    return parse(text(*request.param))


@pytest.mark.some(1)
def test_generated_modules_are_right(model, tmp_path):
    path = generate(model, tmp_path, allow_unproved=True)[0]
    module = load_module(Path(path))
    engine = engine_of(module)
    for r in (1, 2, 3):
        p = module.Parameters(h_count=r)
        for x, u in states(r):
            for twin in (module, engine):
                np.testing.assert_allclose(twin.rhs(x, u, p), rates(x, u), rtol=1e-12)


@pytest.mark.some(1)
def test_jacobians_are_right(model, tmp_path):
    module = load_module(Path(generate(model, tmp_path, allow_unproved=True)[0]))
    p = module.Parameters()
    for x, u in states(2):
        found = module.jacobian(x, u, p)
        steps = 1e-6 * np.eye(len(x))
        wanted = [(rates(x + d, u) - rates(x - d, u)) / 2e-6 for d in steps]
        np.testing.assert_allclose(found, np.array(wanted).T, rtol=1e-6, atol=1e-6)


def values(iphs, x, u):
    """Return what the symbols of an expanded system are worth, by the order of its states."""
    given = {"C": C, "L": L, "L_2": L_2, "R": R, "i_1": I_1, "T_0": T_0, "c": HEAT, "V_in": u[0]}
    symbols = iphs.rhs.free_symbols | set(iphs.x)
    found = {s: sp.Float(given[s.name]) for s in symbols if s.name in given}
    return found | {s: sp.Float(value) for s, value in zip(iphs.x, x, strict=True)}


def test_expanded_systems_are_right(model):
    """An element that has a lane's name is refused by name, any other stays apart."""
    if "h_1" in model.elements:
        with pytest.raises(UsageError, match="a lane would be called 'h_1'"):
            derive(model).expand()
        return
    iphs = derive(model).expand({"h": 2})
    for x, u in states(2):
        found = iphs.rhs.xreplace(values(iphs, x, u))
        np.testing.assert_allclose(np.array(found, float).ravel(), rates(x, u), rtol=1e-12)


@pytest.mark.some(1)
def test_verdicts_do_not_depend_on_the_name(model):
    plain = parse(text("other", "phi"))

    def said(found):
        return [(row.id, row.verdict) for row in verify(derive(found)).rows]

    assert said(model) == said(plain)
