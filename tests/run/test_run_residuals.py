"""What Newton's method leaves of the equations of a step becomes heat: balances stay exact."""

import numpy as np
import pytest

from piezo_sym import simulate, sine
from piezo_sym.spec.load import parse

OSCILLATOR = """
[model]
name = "ringing"
[parameters]
m = { value = 1.0, unit = "kg" }
k = { value = 100.0, unit = "N/m" }
d = { value = 0.1, unit = "N*s/m" }
k_3 = { value = 1e4, unit = "N/m**3" }
T_0 = { value = 300.0, unit = "K" }
c = { value = 0.1, unit = "J/K" }
lam = { value = 0.05, unit = "W/K" }
[domain]
assume = ["d >= 0", "k > 0", "k_3 >= 0", "m > 0", "lam >= 0"]
[initial]
q = 0.2
[elements]
spring = { kind = "spring", between = ["tip", "wall"], force = "k*q + k_3*q**3", state = "q" }
mass = { kind = "mass", at = "tip", mass = "m", state = "p" }
damper = { kind = "damper", between = ["tip", "wall"], force = "d*v", heats = "inner" }
inner = { kind = "thermal_mass", temperature = "T_0*exp(S/c)" }
outer = { kind = "thermal_mass", temperature = "T_0*exp(S/c)" }
wall_leg = { kind = "conduction", between = ["inner", "outer"], conductance = "lam*T_1/T_0" }
"""


def ringing(damping, rtol, c=0.1):
    given = {"d": damping, "c": c}
    return simulate(parse(OSCILLATOR), parameters=given, duration=3.0, rtol=rtol)


@pytest.mark.some(6)
@pytest.mark.parametrize("rtol", [0.1, 1e-2, 1e-3, 1e-6, 1e-8, 1e-12])
@pytest.mark.parametrize(
    ("damping", "c"), [(1.0, 0.1), (5.0, 3e-3), (1.0, 1e-2), (1e-4, 0.1), (1e-8, 0.1), (0.0, 0.1)]
)
def test_both_balances_are_exact_whatever_is_produced(damping, c, rtol):
    """From states alone: the energies by hand, and the entropies of both bodies."""
    found = ringing(damping, rtol, c)
    q, p, S_1, S_2 = (found[name].values for name in ("q", "p", "S_inner", "S_outer"))
    T_1, T_2 = 300 * np.exp(S_1 / c), 300 * np.exp(S_2 / c)
    U = 50 * q**2 + 2500 * q**4 + p**2 / 2 + c * (T_1 + T_2)
    steps = found.attrs["accepted_steps"]
    assert np.abs(U - U[0]).max() <= 4 * (4 + steps**0.5) * np.spacing(U.max())
    made = found.produced_damper.values + found.produced_wall_leg.values
    size = np.abs(S_1).max() + np.abs(S_2).max()
    assert np.abs(S_1 + S_2 - made).max() <= 4 * (4 + steps**0.5) * np.spacing(size)
    for name in ("produced_damper", "produced_wall_leg", "heat_damper"):
        assert np.all(np.diff(found[name].values) >= 0)


def test_heats_are_those_of_the_laws():
    """The heat of the damper is the integral of d*v*v, to the accuracy of the run."""
    for damping in (1.0, 1e-4):
        loose, tight = ringing(damping, 1e-4), ringing(damping, 1e-12)
        for name in ("heat_damper", "produced_damper"):
            assert loose[name].values[-1] == pytest.approx(tight[name].values[-1], rel=1e-3)


def test_steps_with_a_tolerance_take_few_iterations():
    found = simulate("piezo_stack", inputs={"V_in": sine(100, 100)}, duration=0.05, times=[0.05])
    assert found.attrs["newton_iterations"] <= 3.5 * found.attrs["accepted_steps"]


def test_kinks_of_energies_lose_none():
    """Where a step is split at a kink, residuals become heat by the co-states of its pieces."""
    text = OSCILLATOR.replace("k*q + k_3*q**3", "k*q + k_3*q**3 + k_c*deadzone(q, g)")
    more = 'k_c = { value = 200.0, unit = "N/m" }\ng = { value = 0.1, unit = "m" }\n'
    text = text.replace("[domain]\n", f"{more}[domain]\n")
    text = text.replace('"lam >= 0"', '"lam >= 0", "k_c > 0", "g > 0"')
    model = parse(text)
    for p_0 in np.linspace(0.3, 6, 20):
        given = {"initial": {"p": p_0, "q": 0.0}, "parameters": {"d": 2.0, "k_3": 50.0, "c": 0.01}}
        run = simulate(model, duration=3.0, rtol=1e-3, times=60, **given)
        q, p, *entropies = (run[name].values for name in ("q", "p", "S_inner", "S_outer"))
        T_1, T_2 = (300 * np.exp(S / 0.01) for S in entropies)
        e = np.maximum(np.abs(q) - 0.1, 0)
        U = 50 * q**2 + 12.5 * q**4 + 100 * e**2 + p**2 / 2 + 0.01 * (T_1 + T_2)
        assert np.abs(U - U[0]).max() <= 2e-14 * U.max()
