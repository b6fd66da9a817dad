"""A step costs O(r), also with ten thousand hysterons.  ``pytest -s`` shows the times."""

from time import perf_counter

import numpy as np
import pytest

from piezo_sym import Stepper, simulate, sine
from piezo_sym.modules import module_of
from piezo_sym.run.collocation import FixedStep, collocate
from piezo_sym.run.engine.engine import engine_of
from piezo_sym.run.inputs import read_inputs
from piezo_sym.run.parameters import read_initial, read_parameters
from piezo_sym.run.system import DrivenModule

STEP = 1e-6
MOST = 85  # times as long with 64 times the hysterons; measured 50 to 60


def distributed(count):
    """Return parameters of `count` hysterons in parallel that act like a few together."""
    spread = np.linspace(0.5, 1.5, count)
    scale = count / 2
    return {
        "hysteron_count": count,
        "L": (1e-3 * scale * spread).tolist(),
        "rho": (10 * scale * spread).tolist(),
        "i_0": (0.5 / scale * spread).tolist(),
    }


def time_of_a_step(count, steps, repetitions=5):
    """Return the least time of a step [s] of several runs."""
    module = module_of("piezo_stack")
    duration = steps * STEP
    inputs = read_inputs(module, {"V_in": sine(100, 1000)}, duration)
    system = DrivenModule(module, read_parameters(module, distributed(count)), inputs)
    x = read_initial(module, system.parameters, inputs.segments[0].at(0.0), None)[None]
    best = np.inf
    for _ in range(repetitions):
        start = perf_counter()
        collocate(
            [system], engine_of(module), x, np.array([0.0, duration]), FixedStep(STEP)
        ).trajectory(0)
        best = min(best, perf_counter() - start)
    return best / steps


@pytest.mark.long
def test_a_step_costs_in_proportion_to_the_hysterons():
    ratio = np.inf
    for _ in range(4):  # a busy machine blurs the ratio: measured again while it is too large
        few, many = time_of_a_step(64, 4000), time_of_a_step(4096, 200)
        ratio = min(ratio, many / few)
        if ratio <= MOST:
            break
    print(f"\nstep, r = 64: {few * 1e9:.0f} ns, r = 4096: {many * 1e9:.0f} ns, ratio {ratio:.1f}")
    assert ratio <= MOST


@pytest.mark.long
def test_ten_thousand_hysterons_run():
    options = {"inputs": {"V_in": sine(100, 1000)}, "duration": 1e-3, "times": 11}
    found = simulate("piezo_stack", parameters=distributed(10_000), **options)
    assert found.phi.shape == (11, 10_000)
    scale = float(np.abs(found.energy).max()) + float(np.abs(found.supplied_supply).max())
    assert np.abs(found.energy_residual).max() <= 1e-12 * scale
    assert found.produced_hysteron.values[-1].min() >= 0
    assert found.produced_hysteron.values[-1].max() > 0
    few = simulate("piezo_stack", parameters=distributed(1000), **options)
    assert float(found.q[-1]) == pytest.approx(float(few.q[-1]), rel=1e-3)


MOST_AROUND = 3  # times a bare call of C; measured about 2, and 2.5 where T_e moves
WARM, MOVING = 298.15, (298.15, 298.16)


def time_of_calls(actuator, call, calls=500):
    """Return the time of a call [s], its least of several trials, each from t = 0.

    Later on nothing moves, and a step in C takes half the time: then it is hardly one.
    """
    best = np.inf
    for _ in range(40):
        actuator.reset()
        actuator.step([0.0, 50.0, WARM])
        start = perf_counter()
        for _ in range(calls):
            call()
        best = min(best, (perf_counter() - start) / calls)
    return best


@pytest.mark.parametrize("moving", [False, True], ids=["T_e held", "T_e moves"])
def test_a_step_of_a_stepper_costs_little_more_than_a_call_of_c(moving):
    """A pair of steps, with all checks and the ledger, beside bare calls of the same function."""
    actuator = Stepper("piezo_stack", step=2e-5)
    first, second = ([0.0, 50.0, T] for T in (MOVING if moving else (WARM, WARM)))
    actuator.step(first)

    def checked():
        actuator.step(first)
        actuator.step(second)

    def bare():
        actuator._once(actuator._at)
        actuator._once(actuator._at)

    ratio = np.inf
    for _ in range(4):  # a busy machine blurs the ratio
        ratio = min(ratio, time_of_calls(actuator, checked) / time_of_calls(actuator, bare))
        if ratio <= MOST_AROUND:
            break
    print(f"\nstep of a Stepper: {ratio:.2f} times a bare call")
    assert ratio <= MOST_AROUND
