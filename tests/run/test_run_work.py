"""What runs cost, in solves and iterations: these are counts, the same on every machine.

A Bouc-Wen spring has two kinks in a half-period, where its rate and its force change their signs.
"""

from pathlib import Path

import numpy as np
import pytest

from piezo_sym import chirp, load, simulate, sine
from piezo_sym.spec.load import parse

#: A gas behind a valve whose law has a knot at rest, where round-off changes the flow's sign.
CHAMBER = """
[model]
name = "chamber"
title = "A chamber with a bladder, behind a valve"
[parameters]
V_0 = { value = 0.2, unit = "l" }
p_0 = { value = 60, unit = "bar" }
q_1 = { value = 1.0, unit = "l/min" }
p_1 = { value = 1.0, unit = "bar" }
T_0 = { value = 313.15, unit = "K" }
c   = { value = 200, unit = "J/K" }
[inputs]
p_in = { unit = "bar" }
[domain]
assume = ["V < V_0", "0 <= q_1", "0 < p_1", "V_0 > 0", "p_0 > 0"]
[initial]
V = 1e-5
[elements]
supply  = { kind = "pressure_source", between = ["in", "tank"], input = "p_in" }
bladder = { kind = "accumulator", between = ["port", "tank"], state = "V", pressure = "GAS" }
oil     = { kind = "thermal_mass", temperature = "T_0*exp(S/c)" }
[elements.valve]
kind    = "orifice"
between = ["in", "port"]
flow    = "table(dp, -50*p_1, -6*q_1, -p_1, -q_1, 0, 0, p_1, q_1, 50*p_1, 6*q_1)"
heats   = "oil"
""".replace("GAS", "p_0*((1 - V/V_0)**(-1.3) - 1)")

BOUC_WEN = Path(__file__).parents[1] / "benchmarks" / "bouc_wen.toml"


@pytest.mark.some(1)
@pytest.mark.parametrize("rtol", [1e-3, 1e-5])
def test_steps_end_at_kinks_that_are_seen_before(rtol):
    inputs = {"F": sine(8.0, 0.5)}
    run = simulate(load(BOUC_WEN), inputs=inputs, duration=60.0, rtol=rtol, times=[60.0])
    steps = run.attrs["accepted_steps"]
    assert run.attrs["halvings"] <= 2  # refused; without looking ahead 60 and 119
    assert run.attrs["newton_iterations"] < 5.5 * steps  # 5.0 and 3.5; else 6.0 and 5.3


def test_a_period_costs_little_more_than_an_iteration_per_step():
    """Switches are expected when they came in the last period, and steps predicted by those of it.

    Behind each switch there is a step whose rates do not tell of the next one.
    """
    more = []
    for duration in (40.0, 60.0):  # 10 periods apart, 4 switches in each
        inputs, end = {"F": sine(8.0, 0.5)}, [duration]
        run = simulate(load(BOUC_WEN), inputs=inputs, duration=duration, rtol=2e-6, times=end)
        more.append([run.attrs[n] for n in ("accepted_steps", "newton_iterations")])
    steps, iterations = np.subtract(more[1], more[0])
    assert steps < 10 * 12
    assert iterations < 1.2 * steps  # 4.7 where steps are predicted by the one before


def test_motions_that_do_not_repeat_are_followed_as_well():
    """The period changes all the time: steps that are kept lie elsewhere after their switches."""
    inputs = {"F": chirp(8.0, 0.4, 0.7, 60.0)}
    end = [60.0]
    run, exact = (
        simulate(load(BOUC_WEN), inputs=inputs, duration=60.0, rtol=rtol, times=end)
        for rtol in (1e-6, 1e-10)
    )
    assert run.attrs["newton_iterations"] < 4.2 * run.attrs["accepted_steps"]  # 4.6 before
    for name, size in (("p", 2.0), ("z", 0.4)):
        assert abs(run[name].values[-1] - exact[name].values[-1]) < 10 * 1e-6 * size


@pytest.mark.parametrize("duration", [20.0, 60.0])
def test_runs_of_motions_that_repeat_do_not_depend_on_samples(duration):
    inputs = {"F": sine(8.0, 0.5)}
    few, many = (
        simulate(load(BOUC_WEN), inputs=inputs, duration=duration, rtol=2e-6, times=times)
        for times in (2, 2001)
    )
    assert few.attrs["newton_iterations"] < many.attrs["newton_iterations"]
    for name in ("p", "z", "S"):
        assert few[name].values[-1] == many[name].values[-1]


def test_a_solve_ends_where_its_residuals_are_small():
    run = simulate("oscillator", initial={"q": 1e-3}, duration=10.0, rtol=1e-5, times=[10.0])
    assert run.attrs["newton_iterations"] < 2 * run.attrs["accepted_steps"]
    assert np.abs(run.energy_residual).max() < 1e-15 * run.energy.max()


@pytest.mark.long
@pytest.mark.parametrize("rtol", [1e-4, 1e-5, 1e-6])
def test_rest_at_a_knot_takes_few_steps(rtol):
    """The sign of a flow that is round-off changes without end: no step is shorter for that."""
    inputs = {"p_in": 40e5}
    run = simulate(parse(CHAMBER), inputs=inputs, duration=30.0, rtol=rtol, times=[30.0])
    assert run.attrs["accepted_steps"] < 100  # 620 at 1e-6 before


@pytest.mark.parametrize("rtol", [1e-4, 1e-6])
def test_what_is_left_of_equations_with_stops_becomes_heat(rtol):
    inputs = {"V_in": sine(75.0, 1.0, offset=75.0)}
    run = simulate("stack_maxwell", inputs=inputs, duration=3.0, rtol=rtol)
    solves = run.attrs["accepted_steps"] + run.attrs["halvings"] + 1001
    assert run.attrs["newton_iterations"] < 2.5 * solves  # 3.5 and more to round-off
    assert np.abs(run.energy_residual).max() < 1e-14 * run.energy.max()
    assert np.abs(run.entropy_residual).max() < 1e-14 * run.entropy.max()


@pytest.mark.parametrize("rtol", [1e-4, 1e-5, 1e-6, 1e-7, 1e-8])
def test_the_scale_of_a_stiff_state_is_that_of_its_motion(rtol):
    """The momentum of a stack that moves slowly, which rough steps make ring."""
    given = {"inputs": {"V_in": sine(75.0, 1.0, offset=75.0, phase=-np.pi / 2)}, "duration": 2.0}
    best, run = (simulate("stack_maxwell", rtol=tol, **given) for tol in (1e-11, rtol))
    error = float(np.abs(run.p - best.p).max() / np.abs(best.p).max())
    assert error < 10 * rtol  # 25 times 1e-6 before, and 56 times 1e-4


PULL_IN = load(Path(__file__).with_name("pull_in.toml"))


@pytest.mark.some(1)
@pytest.mark.parametrize("voltage", [20.0, 60.0])
def test_a_mode_that_rings_far_below_the_tolerance_does_not_hold_a_run_up(voltage):
    """Its momentum is off by 1e-6 of its scale; rates at the ends of steps tell of that alone."""
    options = {"inputs": {"V_in": voltage}, "duration": 2e-3, "times": 21}
    run = simulate(PULL_IN, rtol=1e-5, **options)
    exact = simulate(PULL_IN, method="Radau", rtol=1e-10, **options)
    assert run.attrs["accepted_steps"] < 20_000  # 10^6 in the first ms without
    assert np.abs(run.S - exact.S).max() < 1e-5 * np.abs(exact.S).max()
    for name, size in (("q", 4e-6), ("Q", float(np.abs(exact.Q).max()))):
        assert np.abs(run[name] - exact[name]).max() < 1e-5 * size
    assert np.abs(run.energy_residual).max() < 1e-11 * float(run.energy[0])
