"""What rtol means: the largest error of a run, in the largest magnitude of each state, is about it.

Reference: linear chains of masses, whose motion is a matrix exponential; heat does not act back.
"""

import numpy as np
import pytest
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


@pytest.mark.parametrize("chain", CHAINS)
def test_the_error_of_a_run_is_about_rtol(chain):
    mass, damping, masses, frequency, duration = CHAINS[chain]
    text = HEAD.format(mass=mass, damping=damping) + (SECOND if masses == 2 else "")
    times = np.linspace(0.0, duration, 101)
    names, wanted = exact(mass, damping, masses, frequency, times)
    drive = {"F": sine(DRIVE, frequency) if frequency else DRIVE}
    errors = []
    for rtol in (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9):
        found = simulate(parse(text), inputs=drive, duration=duration, times=times, rtol=rtol)
        states = np.array([found[name].values for name in names])
        errors.append(np.max(np.abs(states - wanted) / np.abs(wanted).max(axis=1)[:, None]) / rtol)
    assert max(errors) <= 10
    assert np.median(errors) <= 3
