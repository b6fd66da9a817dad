"""Whole models in other base units: the rates of what is proved scale as the states' units say."""

import numpy as np
import pytest

from piezo_sym import derive, load
from piezo_sym.expressions.dimensions import BASES
from piezo_sym.expressions.units import parse_unit
from piezo_sym.modules import module_of
from piezo_sym.proofs import Verdict, decide
from piezo_sym.spec.load import parse
from piezo_sym.spec.places import state_dimensions

BODIES = """
[model]
name = "bodies"
[parameters]
R = { value = 2.0, unit = "ohm" }
b = { value = 0.5, unit = "ohm/A**2" }
g = { value = 0.1, unit = "m/s/N" }
n = { value = 3.0, unit = "1" }
T_0 = { value = 300.0, unit = "K" }
c = { value = 2.0, unit = "J/K" }
lam = { value = 0.5, unit = "W/K" }
L = { value = 0.3, unit = "H" }
m = { value = 0.3, unit = "kg" }
C = { value = 0.6, unit = "F" }
k = { value = 0.4, unit = "N/m" }
[inputs]
V = { unit = "V" }
w = { unit = "m/s" }
F = { unit = "N" }
I = { unit = "A" }
[domain]
assume = ["n > 0", "R > 0", "b >= 0", "g > 0", "lam >= 0"]
[elements]
hot  = { kind = "thermal_mass", temperature = "T_0*exp(S/c)" }
cold = { kind = "thermal_mass", temperature = "T_0*exp(S/c/n)" }
contact = { kind = "conduction", between = ["hot", "cold"], conductance = "lam" }
source = { kind = "voltage_source", between = ["in", "gnd"], input = "V" }
turns = { kind = "transformer", first = ["in", "gnd"], second = ["n", "gnd"], ratio = "n" }
R1 = { kind = "resistor", between = ["n", "o"], voltage = "R*i + b*i**3", heats = "hot" }
L1 = { kind = "inductor", between = ["o", "f"], inductance = "L", state = "phi" }
push = { kind = "velocity_source", at = "a", input = "w" }
spring = { kind = "spring", between = ["a", "b"], stiffness = "k", state = "q" }
slip = { kind = "damper", between = ["b", "e"], velocity = "g*f", heats = "cold" }
mass = { kind = "mass", at = "e", mass = "m", state = "p" }
arm = { kind = "lever", first = ["e", "wall"], second = ["h", "wall"], ratio = "n" }
grip = { kind = "damper", between = ["h", "wall"], force = "v/g", heats = "hot" }
load = { kind = "force_source", at = "e", input = "F" }
leak = { kind = "resistor", between = ["in", "gnd"], current = "v/R", heats = "cold" }
drain = { kind = "current_source", between = ["f", "gnd"], input = "I" }
cap = { kind = "capacitor", between = ["f", "gnd"], capacitance = "C", state = "Q" }
"""


def factor(size, scales):
    return float(np.prod([s ** float(p) for p, s in zip(size, scales, strict=True)]))


@pytest.mark.some(1)
@pytest.mark.parametrize(
    "model", [load("piezo_stack"), parse(BODIES)], ids=["piezo_stack", "bodies"]
)
@pytest.mark.parametrize("seed", range(8))
def test_the_rates_of_a_proved_model_scale(model, seed):
    rows = [row for row in decide(derive(model)).rows if row.id == "units"]
    assert [row.verdict for row in rows] == [Verdict.PROVED]
    module, rng = module_of(model), np.random.default_rng(seed)
    scales = rng.uniform(0.2, 5.0, len(BASES))
    sizes = state_dimensions(model)
    state_sizes = [sizes[s.name] for s in module.STATES for _ in range(2 if s.bank else 1)]
    x_scale = np.array([factor(size, scales) for size in state_sizes])
    time = factor(parse_unit("s").dimension, scales)
    u_scale = np.array([factor(u.dimension.dimension, scales) for u in model.inputs.values()])
    u = rng.uniform(0.5, 1.0, len(u_scale)) * [300.0 if s.unit == "K" else 1 for s in module.INPUTS]
    values = {name: p.si for name, p in model.parameters.items()}
    sized = {
        n: v * factor(model.parameters[n].dimension.dimension, scales) for n, v in values.items()
    }
    x = rng.uniform(0.5, 1.0, len(x_scale)) * 2
    here = module.rhs(x, u, module.Parameters())
    there = module.rhs(x * x_scale, u * u_scale, module.Parameters(**sized))
    assert np.all(here != 0)
    assert np.allclose(there, here * x_scale / time, rtol=1e-9)
