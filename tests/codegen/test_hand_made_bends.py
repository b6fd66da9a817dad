"""Energies with kinks: means are split there, so that balances close, and steps end there."""

import subprocess
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from piezo_sym.expressions.calculus import div
from piezo_sym.expressions.tree import LaneSum, Sym
from piezo_sym.run.collocation import FixedStep, collocate
from piezo_sym.run.engine.engine import engine_of
from piezo_sym.run.inputs import read_inputs
from piezo_sym.run.parameters import read_initial, read_parameters
from piezo_sym.run.simulate import simulate
from piezo_sym.run.system import DrivenModule

from .c_compilers import COMPILERS
from .hand_made import HandMade, read
from .test_c_text import STRICT
from .test_step_alone import Alone
from .tiers import tiers

#: A mass between two contacts; the right one becomes stiffer with temperature: q and S share it.
BOUNCE = HandMade(
    name="bounce",
    parameters={"m": 1.0, "k": 4.0, "k_c": 2e3, "d": 0.1, "b": 0.05, "c": 0.01, "T_0": 300.0},
    states={"q": (0.0, None), "p": (2.0, None), "S": (0.0, None)},
    energies=[
        *("p**2/(2*m)", "k*q**2/2", "k_c*max(-q - d, 0)**2/2"),
        *("k_c*max(q - d, 0)**2/2*exp(S/(5*c))", "c*T_0*exp(S/c)"),
    ],
    rates={"q": "E_p", "p": "-E_q - b*E_p", "S": "b*E_p*E_p/E_S"},
    heats={"damper": ("b*E_p*E_p", "S")},
)
HEAT = "b*E_p*E_p"
#: Masses with gaps of their own, whose dampers heat one body.
BANK = HandMade(
    name="bouncers",
    parameters={"m": 1.0, "k_c": ((3e3, 1e3, 2e3), "n"), "d": ((0.03, 0.1, 0.2), "n")}
    | {"k": 4.0, "b": 0.05, "c": 0.01, "T_0": 300.0},
    states={"q": (0.0, "n"), "p": (2.0, "n"), "S": (0.0, None)},
    energies=[
        *(("p**2/(2*m) + k*q**2/2", "n"), ("k_c/2*max(abs(q) - d, 0)**2", "n")),
        "c*T_0*exp(S/c)",
    ],
    rates={"q": "E_p", "p": "-E_q - b*E_p", "S": div(LaneSum(read(HEAT), "n"), Sym("E_S"))},
    heats={"damper": ((HEAT, "n"), "S")},
    counts={"n": 3},
)
FIXED = [{"step": h, "order": order} for order in (2, 4, 6) for h in (3e-3, 1e-2, 3e-2)]
WAYS = [*FIXED, *({"rtol": rtol} for rtol in (1e-4, 1e-6, 1e-8, 1e-10))]


class Plain(HandMade):
    """The same, its means by one rule for the whole step."""

    def collocation(self):
        made = super().collocation()
        return replace(made, stage=replace(made.stage, bends=()))


class Unlocated(HandMade):
    """The same, no step of which looks for kinks to end there."""

    def collocation(self):
        made = super().collocation()
        return replace(made, stage=replace(made.stage, switches=()))


@pytest.fixture(scope="module")
def bounce(tmp_path_factory):
    return BOUNCE.module(tmp_path_factory.mktemp("bounce"))


def energy(p, x):
    """Return U of BOUNCE, by hand."""
    q, v, s = x
    right, left = np.maximum(q - p.d, 0), np.maximum(-q - p.d, 0)
    stored = p.k_c / 2 * (right**2 * np.exp(s / (5 * p.c)) + left**2)
    return v**2 / (2 * p.m) + p.k * q**2 / 2 + stored + p.c * p.T_0 * np.exp(s / p.c)


def rates(p, x):
    q, v, s = x
    warm = np.exp(s / (5 * p.c))
    right, left = max(q - p.d, 0), max(-q - p.d, 0)
    temperature = p.T_0 * np.exp(s / p.c) + p.k_c / 2 * right**2 * warm / (5 * p.c)
    v = v / p.m
    force = p.k * q + p.k_c * (right * warm - left)
    return [v, -force - p.b * v, p.b * v * v / temperature]


def ran(module, duration=3.0, **options):
    """Return a run of BOUNCE, its states, and what is left of the balance of energy, in parts."""
    run = simulate(module, duration=duration, **{"times": 200, **options})
    x = np.array([run[name].values for name in ("q", "p", "S")])
    u = energy(module.Parameters(**options.get("parameters", {})), x)
    return run, x, np.abs(u - u[0]).max() / u.max()


@pytest.mark.some(1)
@pytest.mark.parametrize("way", tiers(WAYS, 1, 2, 7, 10), ids=str)
def test_balances_close_over_contacts(bounce, way):
    run, x, left = ran(bounce, **way)
    assert x[0].max() > 0.12
    assert x[0].min() < -0.12
    assert left <= 1e-13
    assert np.abs(run.entropy_residual).max() <= 1e-13 * x[2].max()
    assert np.all(np.diff(run.produced_damper) >= 0)


@pytest.mark.long
@pytest.mark.parametrize("way", FIXED, ids=str)
def test_they_would_not_without_the_split(way, tmp_path):
    module = Plain(**{**vars(BOUNCE), "name": "plain"}).module(tmp_path)
    assert ran(module, **way)[2] > 1e-6


@pytest.mark.parametrize("order", tiers([2, 4, 6, 10], 0, 2))
def test_a_step_goes_over_both_contacts(bounce, order):
    times, near = np.arange(101) * 0.03, {"d": 0.005}
    _, x, left = ran(bounce, times=times, step=0.03, order=order, parameters=near)
    side = np.sign(x[0]) * (np.abs(x[0]) > near["d"])
    assert np.sum(side[1:] * side[:-1] < 0) > 10
    assert left <= 1e-13


@pytest.mark.parametrize("order", tiers([4, 6, 10], 1))
@pytest.mark.parametrize("beyond", [1e-6, 1e-4, 1e-2])
def test_a_touch_within_a_step_is_found(bounce, order, beyond):
    """The mass turns back in the middle of a step, just behind a contact, or near its ends."""
    stiff = {"k_c": 1e4, "b": 1e-9, "k": 100.0}
    touch = {"p": 10 * 0.1 * (1 + beyond)}
    for turn in np.linspace(0.02, 0.98, 13):
        h = np.pi / 2 / 10 / (1 + turn)  # it turns back after 1 + turn steps
        times = np.arange(4) * h
        options = {"step": h, "order": order, "parameters": stiff, "initial": touch}
        assert ran(bounce, times[-1], times=times, **options)[2] <= 1e-13


def test_runs_are_those_of_another_solver(bounce):
    """Which takes contacts one after another, and stops at each."""
    p, x, t = bounce.Parameters(), np.array([0.0, 2.0, 0.0]), 0.0
    events = [lambda _, x, d=d: x[0] - d for d in (p.d, -p.d)]
    for event in events:
        event.terminal = True
    how = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-15, "events": events}
    while t < 3.0:
        part = solve_ivp(lambda _, x: rates(p, x), (t, min(t + 1e-6, 3.0)), x, "DOP853", rtol=1e-13)
        part = solve_ivp(lambda _, x: rates(p, x), (part.t[-1], 3.0), part.y[:, -1], **how)
        t, x = part.t[-1], part.y[:, -1]
    for way, most in (({"rtol": 1e-4}, 1e-3), ({"rtol": 1e-7}, 1e-6), ({"rtol": 1e-10}, 1e-9)):
        _, found, _ = ran(bounce, **way)
        error = np.abs(found[:, -1] - x) / np.abs(found).max(axis=1)
        assert error.max() <= most


def test_steps_that_end_at_kinks_are_fewer(bounce, tmp_path):
    other = Unlocated(**{**vars(BOUNCE), "name": "unlocated"}).module(tmp_path)
    runs = [ran(module, rtol=1e-10)[0].attrs for module in (bounce, other)]
    here, there = (run["accepted_steps"] + run["halvings"] for run in runs)
    assert here < 0.7 * there


@pytest.mark.some(1)
@pytest.mark.parametrize("count", [3, 40], ids=["stages in vectors", "lanes in vectors"])
@pytest.mark.parametrize("way", tiers([WAYS[2], WAYS[7], WAYS[9], WAYS[11]], 1), ids=str)
def test_a_bank_of_contacts(tmp_path, way, count):
    module = BANK.module(tmp_path)
    gaps = {"n_count": count, "d": np.linspace(0.03, 0.2, count), "k_c": np.full(count, 2e3)}
    p = read_parameters(module, gaps)
    run = simulate(module, duration=1.0, times=50, parameters=gaps, **way)
    q, v, s = (run[name].values for name in ("q", "p", "S"))
    q, v = (part if part.shape[1] == s.size else part.T for part in (q, v))
    assert np.all(np.abs(q).max(axis=1) > gaps["d"])
    beyond = np.maximum(np.abs(q) - gaps["d"][:, None], 0)
    u = (v**2 / 2 + 2 * q**2 + 1e3 * beyond**2).sum(axis=0) + p.c * p.T_0 * np.exp(s / p.c)
    assert np.abs(u - u[0]).max() <= 1e-13 * u.max()
    assert np.abs(run.entropy_residual).max() <= 1e-13 * s.max()


@pytest.mark.parametrize("how", tiers([1e-6, FixedStep(2e-2), FixedStep(2e-2, order=6)], 0))
def test_members_side_by_side_have_the_numbers_of_each_alone(bounce, how):
    """One never touches; the others do so at different times, and within the same steps."""
    known, times = read_inputs(bounce, None, 1.0), np.linspace(0.0, 1.0, 11)
    values = [read_parameters(bounce, {"d": d}) for d in (0.01, 0.02, 5.0, *np.linspace(0.1, 1, 8))]
    systems = [DrivenModule(bounce, p, known) for p in values]
    x = np.array([read_initial(bounce, p, known.segments[0].at(0.0), None) for p in values])
    given = systems, engine_of(bounce), x, times
    runs = [collocate(*given, how, side_by_side=on) for on in (False, True)]
    assert np.all(np.isfinite(runs[0].states))
    for name in ("states", "sums"):
        assert np.array_equal(getattr(runs[0], name), getattr(runs[1], name))


def test_a_step_for_programs_in_c_splits_too(tmp_path):
    module = BOUNCE.module(tmp_path)
    for command in COMPILERS.values():
        subprocess.run([*command, *STRICT, "-c", "bounce_step.c"], cwd=tmp_path, check=True)
    step, p, x = Alone(module, tmp_path), module.Parameters(), np.array([0.0, 2.0, 0.0])
    start, q = energy(p, x), []
    for _ in range(300):
        assert step(x, np.empty(0), 1e-2)
        q.append(x[0])
    assert max(q) > 0.12
    assert abs(energy(p, x) - start) <= 1e-13 * start
