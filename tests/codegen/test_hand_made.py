"""The step holds for models that no spec can write yet: each closes its balances to round-off."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from piezo_sym.errors import RunError
from piezo_sym.expressions.calculus import add, div, neg
from piezo_sym.expressions.tree import LaneSum, Sym
from piezo_sym.run.simulate import simulate

from .hand_made import HandMade, read
from .test_step_alone import Alone
from .tiers import tiers

#: A gas under a piston on a spring: volume and entropy share one energy.
GAS = HandMade(
    name="gas",
    parameters={"m": 0.05, "k": 800.0, "d": 0.6, "T_0": 300.0, "c": 0.8, "R": 0.3, "l": 0.1},
    states={"q": (0.02, None), "p": (0.0, None), "S": (0.01, None)},
    energies=["p**2/(2*m)", "k*q**2/2", "c*T_0*exp((S - R*log(1 + q/l))/c)"],
    rates={"q": "E_p", "p": "F - E_q - d*E_p", "S": "d*E_p*E_p/E_S"},
    inputs={"F": 0.0},
    supply={"pull": "F*E_p"},
    heats={"damper": ("d*E_p*E_p", "S")},
    limits=("1 + q/l",),
)


@pytest.fixture(scope="module")
def gas(tmp_path_factory):
    return GAS.module(tmp_path_factory.mktemp("gas"))


@pytest.mark.parametrize(
    "way", tiers([{"rtol": 1e-4}, {"rtol": 1e-9}, {"step": 2e-3}, {"step": 2e-3, "order": 6}], 1, 3)
)
def test_a_store_of_several_states_closes_its_balances(gas, way):
    run = simulate(gas, duration=0.2, inputs={"F": 20.0}, times=50, **way)
    p = gas.Parameters()
    x = np.array([run[name].values for name in ("q", "p", "S")])
    energy = gas.energy(x, p)
    supplied = 20.0 * (x[0] - x[0, 0])
    assert np.ptp(x[0]) > 0.005
    assert np.abs(energy - energy[0] - supplied).max() <= 1e-12 * energy.max()
    assert np.abs(run.entropy_residual).max() <= 1e-12 * abs(x[2]).max()
    assert np.all(np.diff(run.produced_damper) >= 0)


def cells(count):
    """Return cells of three states each, in a row along the current that they share."""
    draw = np.random.default_rng(count)
    values = {n: tuple(draw.uniform(0.5, 2.0, count)) for n in ("a", "b", "g")}
    return HandMade(
        name=f"cells_{count}",
        parameters={
            **{name: (value, "cell") for name, value in values.items()},
            **{"m": 0.7, "c": 2.0, "T_0": 300.0, "r": 0.4},
        },
        states={"p": (1.0, None), **dict.fromkeys("xyz", (0.2, "cell")), "S": (0.0, None)},
        energies=[
            "p**2/(2*m)",
            ("a*x**2/2 + b*y**2/2 + x**2*y**2/4", "cell"),
            ("z**2/2 + g*z**4/4", "cell"),
            "c*T_0*exp(S/c)",
        ],
        laws={"i": "E_p", "v": ("r*(E_z - E_x)", "cell")},
        rates={
            "p": add(read("-r*E_p"), neg(LaneSum(read("E_x"), "cell"))),
            "x": "i + E_y + v",
            "y": "-E_x + g*E_z",
            "z": "-g*E_y - v",
            "S": div(add(read("r*E_p*E_p"), LaneSum(read("v*v/r"), "cell")), Sym("E_S")),
        },
        heats={"coil": ("r*E_p*E_p", "S"), "cells": (("v*v/r", "cell"), "S")},
        counts={"cell": count},
    )


@pytest.mark.long
@pytest.mark.parametrize("count", tiers([1, 7], 1))
def test_lanes_may_have_states_of_their_own_that_act_on_each_other(count, tmp_path):
    module = cells(count).module(tmp_path)
    p = module.Parameters()
    for way in ({"rtol": 1e-9}, {"step": 0.02, "order": 4}):
        run = simulate(module, duration=3.0, times=31, **way)
        x = np.vstack([np.atleast_2d(run[name].values.T) for name in ("p", "x", "y", "z", "S")])
        energy = module.energy(x, p)
        assert np.abs(energy - energy[0]).max() <= 1e-12 * energy.max()
        assert np.abs(run.entropy_residual).max() <= 1e-12 * np.abs(x[-1]).max()
    found = solve_ivp(
        lambda _, x: module.rhs(x, [], p), (0, 3), x[:, 0], "DOP853", rtol=1e-12, atol=1e-13
    )
    run = simulate(module, duration=3.0, times=2, rtol=1e-9)
    for name, row in (("p", 0), ("x", 1), ("S", -1)):
        assert np.allclose(np.ravel(run[name].values[-1])[0], found.y[row, -1], rtol=0, atol=1e-7)


def test_newtons_method_knows_cells_as_blocks(tmp_path):
    """With the slopes of whole blocks a step takes few iterations, however many cells."""
    iterations = []
    for count in (1, 7):
        (tmp_path / str(count)).mkdir()
        module = cells(count).module(tmp_path / str(count))
        run = simulate(module, duration=3.0, times=2, step=0.02, order=4)
        iterations.append(run.newton_iterations / run.accepted_steps)
    assert max(iterations) <= 5


def chain(links):
    """Return masses in a row on springs and dampers, each damper with a body of its own."""
    numbers = range(links)
    energies = [f"p{n}**2/(2*m) + k*q{n}**2/2 + c*T_0*exp(S{n}/c)" for n in numbers]
    slip = ["E_p0", *(f"E_p{n} - E_p{n - 1}" for n in numbers[1:])]
    laws = {f"v{n}": slip[n] for n in numbers}
    forces = [f"E_q{n} + d*v{n}" for n in numbers]
    pull = [f"{forces[n + 1]} - E_q{n} - d*v{n}" for n in numbers[:-1]]
    pull += [f"-E_q{links - 1} - d*v{links - 1}"]
    rates = {}
    for n in numbers:
        rates |= {f"q{n}": f"v{n}", f"p{n}": pull[n], f"S{n}": f"d*v{n}*v{n}/E_S{n}"}
    starts = {name: (0.1 if name == f"p{links - 1}" else 0.0, None) for name in rates}
    parameters = {"m": 1.0, "k": 4.0, "d": 0.1, "c": 2.0, "T_0": 300.0}
    heats = {f"damper{n}": (f"d*v{n}*v{n}", f"S{n}") for n in numbers}
    return HandMade("chain", parameters, starts, energies, rates, laws=laws, heats=heats)


@pytest.mark.parametrize("links", [20, pytest.param(200, marks=pytest.mark.long)])
def test_a_chain_of_many_states_runs(links, tmp_path):
    """Of 600 states, the long one; tables solve its equations, with few entries per link."""
    module = chain(links).module(tmp_path)
    run = simulate(module, duration=2.0, times=3, rtol=1e-8)
    motion = np.zeros((2 * links, 2 * links))  # lengths, then momenta
    for n in range(links):
        motion[n, links + n] = 1.0
        motion[links + n, n] = -4.0
        if n:
            motion[n, links + n - 1] = -1.0
            motion[links + n - 1, n] = 4.0
    slip = motion[:links, links:]
    motion[links:, links:] = -0.1 * slip.T @ slip
    start = np.zeros(2 * links)
    start[-1] = 0.1
    wanted = expm(2.0 * motion) @ start
    found = [run[f"{kind}{n}"].values[-1] for kind in "qp" for n in range(links)]
    assert np.abs(found - wanted).max() <= 1e-7 * np.abs(wanted).max()
    assert np.abs(run.energy_residual).max() <= 1e-11 * run.energy.max()
    entries = (tmp_path / "chain_step.c").read_text(encoding="utf-8").partition("chain_slots = ")[2]
    assert int(entries.partition(",")[0]) <= 30 * links


def well(energy):
    """Return a mass in a well, whose damper heats a body."""
    return HandMade(
        name="well",
        parameters={"m": 1.0, "k": 1.0, "d": 0.1, "c": 2.0, "T_0": 300.0},
        states={"q": (0.0, None), "p": (5.0, None), "S": (0.0, None)},
        energies=["p**2/(2*m)", energy, "c*T_0*exp(S/c)"],
        rates={"q": "E_p", "p": "-E_q - d*E_p", "S": "d*E_p*E_p/E_S"},
        heats={"damper": ("d*E_p*E_p", "S")},
    )


@pytest.mark.some(1)
@pytest.mark.parametrize("seed", [3, *(pytest.param(n, marks=pytest.mark.long) for n in (1, 2))])
@pytest.mark.parametrize(
    "energy", ["k*q**4/4", pytest.param("k*log(1 + q**2)", marks=pytest.mark.long)]
)
def test_very_long_steps_close_their_balances_or_are_halved(energy, seed, tmp_path):
    """Newton's method may end at what is no root, and quadrature miss a well within a step.

    A change that stagnates is accepted up to 1e-12 of a state (MOST_NOISE), in each of 20 to 600
    steps.
    """
    module = well(energy).module(tmp_path)
    draw = np.random.default_rng(seed)
    ran = 0
    for _ in range(5):
        h, k, p = 10.0 ** draw.uniform((-1, -1, -1), (1.5, 5, 3))
        order = int(draw.choice([2, 4, 6]))
        how = {"step": h, "order": order, "parameters": {"k": k}, "initial": {"p": p}}
        try:
            run = simulate(module, duration=20 * h, **how)
        except RunError:  # a body cannot take in all that
            continue
        ran += 1
        assert np.abs(run.energy_residual).max() <= 1e-10 * run.energy.max()
    assert ran >= 3


@pytest.mark.long
def test_a_force_that_goes_to_zero_is_no_reason_to_halve_steps(tmp_path):
    """At rest at a length that is not zero all of it is what rounding leaves."""
    module = replace(well("k*(q - 0.1)**2/2 + k*(q - 0.1)**4"), name="rest").module(tmp_path)
    start = {"parameters": {"k": 10.0, "d": 2.0}, "initial": {"q": 0.5, "p": 0.0}}
    for way in ({"step": 0.05}, {"step": 0.05, "order": 4}, {"rtol": 1e-6}):
        run = simulate(module, duration=100.0, times=11, **way, **start)
        assert run.halvings <= 10
        assert run.accepted_steps <= 2000
        assert abs(run.q.values[-1] - 0.1) <= 1e-6


def test_floats_do_for_energies_that_are_not_quadratic(gas, tmp_path):
    step, x = Alone(gas, tmp_path, "-DREAL=float"), np.array([0.02, 0.0, 0.01])
    exact, wanted = Alone(gas, tmp_path), x.copy()
    for _ in range(300):
        assert step(x, np.array([20.0]), 1e-3)
        assert exact(wanted, np.array([20.0]), 1e-3)
    assert np.abs(x - wanted).max() <= 1e-4 * np.abs(wanted).max()
