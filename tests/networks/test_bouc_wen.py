"""Bouc-Wen's hysteresis, its exponent a parameter: an oscillator, and both laws along its runs.

References are right-hand sides typed by hand, run by SciPy.
"""

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from piezo_sym import derive, load, simulate, sine, verify
from piezo_sym.spec.load import parse
from piezo_sym.verification import process

#: Those who run a model and those who look at its rows need the same report.
pytestmark = pytest.mark.usefixtures("known_reports")

SLIPS = Path(__file__).with_name("specs") / "slips.toml"
OSCILLATOR = """[model]
name = "bouc_wen_oscillator"
[parameters]
m    = { value = 2.0,   unit = "kg" }
d    = { value = 0.5,   unit = "N*s/m" }
k    = { value = 30.0,  unit = "N/m" }
f_0  = { value = 4.0,   unit = "N" }
beta = { value = 0.6,   unit = "1" }
gam  = { value = -0.35, unit = "1" }
n    = { value = 1.5,   unit = "1" }
T_0  = { value = 300.0, unit = "K" }
c    = { value = 10.0,  unit = "J/K" }
[inputs]
F = { unit = "N" }
[domain]
assume = ["beta >= abs(gam)", "n > 0", "f_0 > 0", "d >= 0"]
[elements]
mass   = { kind = "mass", at = "tip", mass = "m", state = "p" }
damper = { kind = "damper", between = ["tip", "wall"], force = "d*v", heats = "body" }
body   = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
load   = { kind = "force_source", at = "tip", input = "F" }
[elements.spring]
kind = "spring"
between = ["tip", "wall"]
stiffness = "k"
state = "z"
slip = "(beta*abs(v)*sign(f) + gam*v)*abs(f/f_0)**n"
heats = "body"
"""


def rates(t, x, n):
    """Return the rates of the oscillator, by hand; states p, S, z."""
    p, S, z = x
    v, f = p / 2, 30 * z
    slip = (0.6 * abs(v) * np.sign(f) - 0.35 * v) * abs(f / 4) ** n
    heat = 0.5 * v**2 + f * slip
    return [9 * np.sin(2 * np.pi * 0.7 * t) - f - 0.5 * v, heat / (300 * np.exp(S / 10)), v - slip]


@pytest.mark.some(1)
@pytest.mark.parametrize("n", [1.0, 1.5, 2.0])
def test_an_oscillator_is_that_of_the_equations_by_hand(n):
    run = simulate(
        parse(OSCILLATOR), inputs={"F": sine(9, 0.7)}, duration=8, rtol=1e-8, parameters={"n": n}
    )
    exact = solve_ivp(
        rates, (0, 8), [0.0] * 3, "DOP853", run.time.values, args=(n,), rtol=1e-11, atol=1e-14
    )
    assert np.max(abs(30 * run.z.values)) > 4  # beyond f_0: the loop is closed by slip
    for name, values in zip(("p", "S", "z"), exact.y, strict=True):
        assert np.max(abs(run[name].values - values)) <= 1e-6 * np.max(abs(values)), name


@pytest.mark.some(1)
@pytest.mark.parametrize("rtol", [1e-3, 1e-5, 1e-7, 1e-9])
@pytest.mark.parametrize("n", [0.5, 1.0, 1.5, 2.0, 3.7])
def test_both_laws_close_to_round_off_for_every_exponent(n, rtol):
    drive = {"F": sine(40, 1.1), "V": sine(12, 2.3)}
    run = simulate(load(SLIPS), inputs=drive, duration=2, rtol=rtol, parameters={"n": n})
    produced = [run[f"produced_{e}"].values for e in ("wen", "dahl", "stack", "amplifier")]
    assert np.max(abs(run.energy_residual.values)) < 1e-13 * np.max(abs(run.energy.values))
    assert np.allclose(sum(produced), run.entropy - run.entropy[0], rtol=0, atol=1e-12)
    assert all(np.all(np.diff(part) >= 0) for part in produced)
    assert produced[0][-1] > 0


def test_every_row_of_the_oscillator_is_proved():
    verdicts = {
        (row.id, row.element): row.verdict.value for row in process.examined(parse(OSCILLATOR)).rows
    }
    assert set(verdicts.values()) == {"PROVED"}
    assert verdicts.keys() >= {
        ("passive", "spring"),
        ("rate-independent", "spring"),
        ("program", ""),
    }


@pytest.mark.some(1)
@pytest.mark.parametrize("domain", ['"n >= 0"', '"n > -1"', '"f_0 > 0"'])
def test_what_to_declare_of_an_exponent_is_said(domain):
    rows = verify(derive(parse(OSCILLATOR.replace('"n > 0"', domain)))).rows
    (row,) = (row for row in rows if (row.id, row.element) == ("welldef", "spring"))
    if domain == '"n >= 0"':  # mathematics has a value at n = 0: that refutes nothing
        assert (row.verdict.value, row.witness) == ("OPEN", None)
    else:
        assert row.verdict.value == "REFUTED"
        assert Fraction(row.witness["n"]) < 0 == Fraction(row.witness["f"])
    assert row.reason.endswith("; the condition 'n > 0' in [domain] mends it")


@pytest.mark.some(1)
@pytest.mark.parametrize(
    ("power", "said"),
    [
        ("abs(f)**n", "abs(f) is N in abs(f)**n, a number without unit is needed"),
        ("abs(f/f_0)**m", "m is kg in abs(f/f_0)**m, a number without unit is needed"),
    ],
)
def test_units_of_base_and_exponent_are_refused_in_one_line(power, said):
    rows = verify(derive(parse(OSCILLATOR.replace("abs(f/f_0)**n", power)))).rows
    (reason,) = (row.reason for row in rows if row.id == "units" and row.verdict.value != "PROVED")
    assert said in reason
    assert "\n" not in reason


def test_a_parameter_may_be_called_as_the_power_is_in_c():
    named = (
        OSCILLATOR.replace("n    =", "pow =").replace("n > 0", "pow > 0").replace("**n", "**pow")
    )
    drive = {"F": sine(9, 0.7)}
    runs = (simulate(parse(text), inputs=drive, duration=1) for text in (OSCILLATOR, named))
    assert len({float(run.z[-1]) for run in runs}) == 1
