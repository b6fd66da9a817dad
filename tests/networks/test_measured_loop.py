"""The shipped Maxwell-slip stack against the loop that it was identified from, and by hand."""

from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import nnls

from piezo_sym import load, simulate

MEASURED = Path(__file__).parents[2].parent / "shared" / "data" / "piezo_1hz.csv"
STEP, STOPS = 2.35, 8


def stops(path, limits):
    """Return the extensions of stops along a path that starts where they are at rest."""
    z, found = np.zeros(len(limits)), []
    for step in np.diff(path, prepend=path[0]):
        z = np.clip(z + step, -limits, limits)
        found.append(z)
    return np.array(found)


def weights():
    """Return what each stop and the spring add to the voltage, per extension [V/um]."""
    given = load("stack_maxwell").parameters
    listed = [*given["k_s"].value, given["k"].value]
    return np.array(listed) / given["a"].value


def loop_fill(V, x):
    """Return the area of a loop over that of its box."""
    area = abs(np.sum(V * np.roll(x, -1) - x * np.roll(V, -1))) / 2
    return area / (np.ptp(V) * np.ptp(x))


def squared(error, of):
    return (error @ error) / (of @ of)


@pytest.fixture(scope="module")
def measured():
    if not MEASURED.exists():
        pytest.skip("the measured loop is not part of the project: see its source in the spec")
    return np.loadtxt(MEASURED, delimiter=",", skiprows=1, unpack=True)


def test_weights_are_those_of_one_second_and_hold_in_the_next(measured):
    """Least squares on seconds 5 to 6, judged on 6 to 7; published sparse regression: 0.033 %."""
    t, V, x = measured
    limits = STEP * np.arange(1, STOPS + 1)
    table = np.column_stack([stops(x, limits), x])
    seen, later = (t >= 5) & (t < 6), t >= 6
    found, _ = nnls(table[seen], V[seen])
    assert found == pytest.approx(weights(), rel=1e-3)
    assert squared(V[later] - table[later] @ found, V[later]) <= 8e-5


def test_the_network_moves_as_was_measured(measured):
    t, V, x = (part[::2] for part in measured)
    inputs, t = {"V_in": (t - t[0], V)}, t - t[0]
    run = simulate("stack_maxwell", inputs=inputs, duration=t[-1], times=t, rtol=1e-4)
    later, q = t >= 3, run.q.values * 1e6
    assert squared(q[later] - x[later], x[later]) <= 1.1e-4
    assert loop_fill(V[later], q[later]) == pytest.approx(0.106, abs=0.005)
    assert np.abs(run.energy_residual).max() <= 1e-12 * run.energy.max()


def quasi_static(voltages, limits, parts):
    """Return where stops and spring stand under slowly changing voltages, branch by branch."""
    z, x, found = np.zeros(len(limits)), 0.0, []
    for V in voltages:
        for _ in range(100):
            left = V - parts[:-1] @ z - parts[-1] * x
            if abs(left) < 1e-10:
                break
            sign = np.sign(left)
            free = sign * z < limits * (1 - 1e-12)
            stiff = parts[-1] + parts[:-1][free].sum()
            room = (limits - sign * z)[free].min(initial=np.inf)
            step = sign * min(abs(left) / stiff, room)
            x, z = x + step, np.clip(z + step, -limits, limits)
        found.append(x)
    return np.array(found)


def test_slow_voltages_move_it_as_by_hand():
    """Voltages that rise and fall at 100 V/s; inertia, damping and leads are all but nothing."""
    turns = np.array([0.0, 150.0, -100.0, 50.0, -30.0, 120.0, 0.0])
    t = np.cumsum([0.0, *np.abs(np.diff(turns))]) / 100.0
    run = simulate("stack_maxwell", inputs={"V_in": (t, turns)}, duration=t[-1], times=t, rtol=1e-5)
    wanted = quasi_static(turns, STEP * np.arange(1, STOPS + 1), weights())
    assert run.q.values * 1e6 == pytest.approx(wanted, abs=0.01)
    assert np.diff(run.heat_slips.values, axis=0).min() >= 0
