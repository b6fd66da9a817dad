"""What rtol means: the largest error of a run, in the largest magnitude of each state, is about it.

Reference: linear chains of masses, whose motion is a matrix exponential; and a mass with steep
friction by the method of Dormand and Prince, its equations typed by hand.  Heat does not act back.
"""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from piezo_sym import simulate, sine
from piezo_sym.spec.load import parse

STIFFNESS, DRIVE = 1e3, 5.0
HEAD = """
[model]
name = "chain"
[parameters]
m = {{ value = {mass}, unit = "kg" }}
k = {{ value = 1e3, unit = "N/m" }}
d = {{ value = {damping}, unit = "N*s/m" }}
T_0 = {{ value = 300.0, unit = "K" }}
c = {{ value = 2.0, unit = "J/K" }}
[inputs]
F = {{ unit = "N", default = 0.0 }}
[domain]
assume = ["d >= 0"]
[elements]
pull = {{ kind = "force_source", at = "a", input = "F" }}
tip = {{ kind = "mass", at = "a", mass = "m" }}
ground = {{ kind = "spring", between = ["a", "wall"], stiffness = "k" }}
loss = {{ kind = "damper", between = ["a", "wall"], force = "d*v", heats = "body" }}
body = {{ kind = "thermal_mass", temperature = "T_0*exp(S/c)" }}
"""
SECOND = """
far = { kind = "mass", at = "b", mass = "m" }
between = { kind = "spring", between = ["a", "b"], stiffness = "k" }
"""
#: Mass, damping, number of masses, frequency of the drive (0: constant), duration.  Steps of the
#: first are much longer than its time constant; the second rings for ninety periods.
CHAINS = {
    "overdamped": (1e-4, 200.0, 1, 3.0, 1.0),
    "ringing": (1.0, 0.01, 1, 0.0, 90 * 2 * np.pi / np.sqrt(STIFFNESS)),
    "two masses": (0.1, 2.0, 2, 0.0, 2.0),
}


def exact(mass, damping, masses, frequency, times):
    """Return the states (states, nt) from rest: springs' lengths and momenta, and their names."""
    names = ["p_tip", "q_ground", "p_far", "q_between"][: 2 * masses]
    a = np.zeros((2 * masses + 2, 2 * masses + 2))  # and the drive, as an oscillator's two states
    a[0, :2] = -damping / mass, -STIFFNESS
    a[1, 0] = 1 / mass
    if masses == 2:  # the spring between takes its length from a to b
        a[0, 3], a[2, 3] = -STIFFNESS, STIFFNESS
        a[3, 0], a[3, 2] = 1 / mass, -1 / mass
    omega = 2 * np.pi * frequency
    a[0, -2] = DRIVE
    a[-2, -1], a[-1, -2] = omega, -omega
    start = np.zeros(len(a))
    start[-1 if frequency else -2] = 1.0
    return names, np.array([(expm(a * t) @ start)[:-2] for t in times]).T


#: Damped, with and without a drive: what a user may ask of any one of them, and of most of them.
DAMPED = {
    "falls": (1.0, 10.0, 1, 0.0, 2.0),
    "driven": (1.0, 10.0, 1, 3.0, 4.0),
    "driven fast": (1.0, 20.0, 1, 15.0, 2.0),
    "driven slowly": (0.2, 20.0, 1, 0.7, 5.0),
    "overdamped": (0.1, 100.0, 1, 2.0, 4.0),
    "two fall": (0.5, 4.0, 2, 0.0, 2.0),
    "two driven": (0.1, 8.0, 2, 5.0, 2.0),
    "two driven slowly": (0.1, 30.0, 2, 1.0, 4.0),
}
RTOLS = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9)
#: Runs of no more steps are too short for errors to be about rtol.
FEW = 20


def errors(chain):
    """Return the largest error of a run in rtol, and its steps, for each rtol."""
    mass, damping, masses, frequency, duration = chain
    text = HEAD.format(mass=1.0, damping=1.0) + (SECOND if masses == 2 else "")
    times = np.linspace(0.0, duration, 101)
    names, wanted = exact(mass, damping, masses, frequency, times)
    drive = {"F": sine(DRIVE, frequency) if frequency else DRIVE}
    options = {"inputs": drive, "duration": duration, "times": times}
    options["parameters"] = {"m": mass, "d": damping}
    for rtol in RTOLS:
        found = simulate(parse(text), rtol=rtol, **options)
        states = np.array([found[name].values for name in names])
        parts = np.abs(states - wanted) / np.abs(wanted).max(axis=1)[:, None]
        yield parts.max() / rtol, found.attrs["accepted_steps"]


@pytest.mark.some(1)
@pytest.mark.parametrize("chain", CHAINS)
def test_the_error_of_a_run_is_about_rtol(chain):
    found = [error for error, _ in errors(CHAINS[chain])]
    assert max(found) <= 10
    assert np.median(found) <= 3


@pytest.mark.long
def test_nobody_pays_for_much_more_than_rtol():
    """The lower side: steps are about as long as rtol allows, at every rtol."""
    runs = [list(errors(chain)) for chain in DAMPED.values()]
    for at_one in zip(*runs, strict=True):
        found = [error for error, steps in at_one if steps > FEW]
        assert len(found) >= 3
        assert max(found) <= 10
        assert 1 / 30 <= np.median(found) <= 3


STEEP = """
[model]
name = "steep"
[parameters]
m = { value = 1.0, unit = "kg" }
k = { value = 100.0, unit = "N/m" }
F_c = { value = 1.0, unit = "N" }
w = { value = 0.02, unit = "m/s" }
T_0 = { value = 300.0, unit = "K" }
c = { value = 2.0, unit = "J/K" }
[domain]
assume = ["F_c >= 0", "w > 0"]
[elements]
block = { kind = "mass", at = "a", mass = "m", state = "p" }
spring = { kind = "spring", between = ["a", "wall"], stiffness = "k", state = "q" }
friction = { kind = "damper", between = ["a", "wall"], force = "F_c*tanh(v/w)", heats = "body" }
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)" }
"""
#: Mass, stiffness, friction, its width, and the spring's length at the start, such that at some
#: rtol a step that looks smooth at its stages goes over the steep part, or ends in it.
FRICTIONS = (
    (1.0, 100.0, 1.0, 0.005, 0.1),
    (1.0, 100.0, 1.0, 0.1, 0.1),
    (0.208, 344.0, 0.31, 0.0757, 0.46),
    (0.202, 64.0, 0.185, 0.0157, 0.0335),
)


@pytest.mark.some(2)
@pytest.mark.parametrize("friction", FRICTIONS)
def test_no_step_misses_a_steep_part_of_a_law(friction):
    m, k, F_c, w, q = friction

    def rates(_, x):
        return x[1] / m, -k * x[0] - F_c * np.tanh(x[1] / m / w)

    times = np.linspace(0.0, 1.0, 21)
    exactly = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-16, "max_step": 2e-3}
    wanted = solve_ivp(rates, (0.0, 1.0), (q, 0.0), t_eval=times, **exactly).y
    given = {"m": m, "k": k, "F_c": F_c, "w": w}
    for rtol in (*RTOLS, 1e-10):
        options = {"duration": 1.0, "times": times, "parameters": given, "initial": {"q": q}}
        run = simulate(parse(STEEP), rtol=rtol, **options)
        parts = np.abs(run[["q", "p"]].to_array() - wanted) / np.abs(wanted).max(axis=1)[:, None]
        assert parts.max() <= 10 * rtol, rtol


#: A thermistor that its current warms up over many periods; its temperature bounds the current.
BEAD = """
[model]
name = "bead"
[parameters]
L = { value = 0.05, unit = "H" }
R_0 = { value = 1.0, unit = "ohm" }
R_s = { value = 0.05, unit = "ohm" }
B = { value = 2000.0, unit = "K" }
c = { value = 0.1, unit = "J/K" }
T_1 = { value = 1.0, unit = "K", doc = "so that entropies are large from the start" }
T_0 = { value = 300.0, unit = "K" }
lam = { value = 0.01, unit = "W/K" }
[inputs]
V = { unit = "V" }
T_e = { unit = "K", default = 300.0 }
[domain]
assume = ["T_0 > 0", "T_1 > 0", "R_0 > 0", "R_s > 0", "lam >= 0", "T_e > 0"]
[initial]
S = "c*log(T_0/T_1)"
[elements]
supply = { kind = "voltage_source", between = ["in", "gnd"], input = "V" }
coil = { kind = "inductor", between = ["in", "a"], inductance = "L", state = "phi" }
shunt = { kind = "resistor", between = ["b", "gnd"], voltage = "R_s*i", heats = "body" }
body = { kind = "thermal_mass", temperature = "T_1*exp(S/c)", state = "S" }
air = { kind = "ambient", body = "body", conductance = "lam", input = "T_e" }
[elements.bead]
kind = "resistor"
between = ["a", "b"]
voltage = "R_0*exp(B*(1/T - 1/T_0))*i"
heats = "body"
"""


def test_a_body_that_warms_up_over_thousands_of_periods_is_measured_by_what_it_reaches():
    """The survey leaps over most periods; were all surveyed, errors would be as small."""
    how = {"inputs": {"V": sine(0.3, 1.0)}, "duration": 2000.0, "times": 4001}
    fine, found = (simulate(parse(BEAD), rtol=rtol, **how) for rtol in (1e-9, 1e-4))
    for name in ("phi", "S"):
        size = np.abs(fine[name].values).max()
        assert np.abs(found[name].values - fine[name].values).max() <= 0.3 * 1e-4 * size
