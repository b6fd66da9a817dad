"""Steps taken in C are those written by hand, one by one and all together."""

import numpy as np
import pytest

from piezo_sym import Stepper, simulate

from .piezo_step import Table1, step

P = Table1()
SCALES = np.array([2e-3, 5e-3, 5e-4, 6e-3, 6e-3, 5e-2])
STATES = ("q", "p", "Q_C", "phi", "S")
U = (0.0, 80.0, 300.0)


def compiled(x, u, h, lanes):
    """Return the state after one step in C."""
    first = {"q": x[0], "p": x[1], "Q_C": x[2], "phi": x[3:-1], "S": x[-1]}
    options = {"initial": first, "parameters": {"hysteron_count": lanes}}
    named = dict(zip(("F_ext", "V_in", "T_e"), u, strict=True))
    actuator = Stepper("piezo_stack", step=h, inputs=named, **options)
    actuator.step(u)
    return actuator.x


def starts(lanes):
    """Yield states with currents inside, outside, on and across the dead zone."""
    draw = np.random.default_rng(lanes)
    for _ in range(12):
        currents = draw.choice([-3.0, -P.i_0, -0.4, 0.0, 0.45, P.i_0, 0.55, 4.0], lanes)
        entropy = P.c_0 * np.log1p(draw.choice([0.5, 2.0, 100.0]) / P.T_0)
        head = draw.uniform(-0.5, 0.5, 3) * SCALES[:3]
        yield np.array([*head, *(currents * P.L), entropy])


@pytest.mark.some(3)
@pytest.mark.parametrize("lanes", [1, 2, 5])
@pytest.mark.parametrize("h", [1e-7, 1e-6, 1e-5])
def test_one_step(lanes, h):
    scales = np.array([*SCALES[:3], *[SCALES[3]] * lanes, SCALES[-1]])
    for x in starts(lanes):
        wanted, _, _ = step(x, U, h, P, scales)
        found = compiled(x, U, h, lanes)
        assert np.abs((found - wanted) / scales).max() <= 1e-10


@pytest.mark.parametrize("h", [pytest.param(2e-6, marks=pytest.mark.long), 1e-5])
def test_a_run_and_its_ledger(h):
    """A hundred steps from rest through the edge of the dead zone, and what they book."""
    x = np.array([0.0, 0.0, 0.0, 0.0, 0.0, P.c_0 * np.log1p(2.0 / P.T_0)])
    heats, produced = np.zeros(3), np.zeros(3)
    for _ in range(100):
        x, heat, entropy = step(x, (0.0, 80.0, 298.15), h, P, SCALES)
        heats, produced = heats + heat, produced + entropy
    options = {"inputs": {"V_in": 80.0}, "step": h, "duration": 100 * h, "times": 2}
    found = simulate("piezo_stack", method="discrete_gradient", **options)
    assert found.accepted_steps == 100
    assert found.halvings == 0
    last = np.hstack([found[name].values[-1] for name in STATES])
    assert np.abs((last - x) / SCALES).max() <= 1e-10
    assert abs(x[3]) > P.L * P.i_0
    for name, wanted in (("heat", heats), ("produced", produced)):
        booked = np.hstack([found[f"{name}_{e}"].values[-1] for e in ("hysteron", "damper")])
        assert np.allclose(booked, [*wanted[1:], wanted[0]], rtol=1e-9, atol=0)
