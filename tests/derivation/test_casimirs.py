"""Linear functions of the state that no motion changes, against rates of generated modules."""

from pathlib import Path

import numpy as np
import pytest
import sympy as sp

from piezo_sym import derive, load
from piezo_sym.algebra.notation import text
from piezo_sym.iphs.casimirs import linear_casimirs
from piezo_sym.modules import module_of
from piezo_sym.spec.load import parse

SPECS = Path(__file__).parents[1] / "networks" / "specs"
LEVER = """
[model]
name = "lever_between"
[parameters]
m = { value = 2.0, unit = "kg" }
k = { value = 3.0, unit = "N/m" }
n = { value = 5.0, unit = "1" }
d = { value = 0.5, unit = "N*s/m" }
c = { value = 2.0, unit = "J/K" }
T_0 = { value = 300.0, unit = "K" }
[inputs]
F = { unit = "N" }
[domain]
assume = ["d >= 0"]
[elements]
heavy = { kind = "mass", at = "in", mass = "m", state = "p_1" }
light = { kind = "mass", at = "jaw", mass = "m", state = "p_2" }
first = { kind = "spring", between = ["in", "wall"], stiffness = "k", state = "q_1" }
arm = { kind = "lever", first = ["out", "wall"], second = ["in", "wall"], ratio = "n" }
link = { kind = "spring", between = ["out", "jaw"], stiffness = "k", state = "q_a" }
last = { kind = "spring", between = ["jaw", "wall"], stiffness = "k", state = "q_2" }
damper = { kind = "damper", between = ["in", "wall"], force = "d*v", heats = "body" }
push = { kind = "force_source", at = "jaw", input = "F" }
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
"""


def casimirs(text_):
    return {text(found) for found in linear_casimirs(derive(parse(text_)))}


def test_positions_over_a_lever_keep_their_relation():
    """The lever turns in to out, n times as far: its spring ends where the jaw's begins."""
    assert casimirs(LEVER) == {"n*q_1 - q_2 - q_a"}


def test_a_ratio_that_a_temperature_decides_leaves_none():
    warm = LEVER.replace('ratio = "n"', 'ratio = "n*(1 + T_body/T_0)"')
    assert casimirs(warm) == set()


def test_the_start_decides_how_far_two_springs_of_one_point_differ():
    both = LEVER.replace(
        "last = ",
        'more = { kind = "spring", between = ["jaw", "wall"], '
        'stiffness = "2*k", state = "q_3" }\nlast = ',
    )
    assert casimirs(both) == {"n*q_1 - q_2 - q_a", "n*q_1 - q_3 - q_a"}


@pytest.mark.parametrize(
    ("spec", "number"),
    [(SPECS / "springs_in_a_loop.toml", 1), ("amplified_stack", 2), ("piezo_stack", 0)],
)
def test_rates_of_the_generated_module_do_not_change_them(spec, number):
    model = load(spec)
    iphs, module = derive(model), module_of(model)
    found = linear_casimirs(iphs)
    assert len(found) == number
    p, u = module.Parameters(), np.array(module.INPUT_DEFAULTS)
    given = {iphs.symbols[name]: getattr(p, name) for name in model.parameters}
    rng = np.random.default_rng(3)
    start = module.initial_state(u, p)
    for _ in range(5):
        x = start + 1e-3 * rng.standard_normal(start.size)
        rates = module.rhs(x, u + rng.standard_normal(u.size), p)
        for function in found:
            change = [
                float(sp.diff(function, iphs.symbols[record.name]).subs(given)) * rate
                for record, rate in zip(module.STATES, rates.tolist(), strict=True)
            ]
            assert abs(sum(change)) <= 1e-12 * max(map(abs, change))
