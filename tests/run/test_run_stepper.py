"""Step by step: the same states as a run, inputs decided on the way, at the cost of a C call."""

import doctest

import numpy as np
import pytest

from piezo_sym import Stepper, simulate
from piezo_sym.errors import RunError, UsageError
from piezo_sym.run.stepper import Stepper as Steps

H = 1e-5


def test_held_inputs_give_the_states_of_a_run():
    actuator = Stepper("piezo_stack", step=H)
    for _ in range(100):
        y = actuator.step([0.0, 50.0, 298.15])
    run = simulate(
        "piezo_stack",
        inputs={"V_in": 50.0},
        duration=100 * H,
        step=H,
        method="discrete_gradient",
        times=2,
    )
    last = [run[n].values[-1] for n in ("q", "p", "Q_C", "phi", "S")]
    assert np.allclose(actuator.x, np.hstack(last), rtol=1e-9, atol=1e-18)
    assert actuator.time == pytest.approx(100 * H)
    assert np.allclose(y, [run[f"y_{n}"].values[-1] for n in ("load", "supply", "ambient")])


def test_a_position_controller_reaches_its_target():
    actuator = Stepper("piezo_stack", step=2e-5)
    target, integral, y = 2e-4, 0.0, None
    for _ in range(20_000):
        q = actuator.x[0]
        integral += (target - q) * 2e-5
        y = actuator.step([0.0, 2e4 * (target - q) + 4e7 * integral, 298.15])
    assert actuator.x[0] == pytest.approx(target, rel=1e-3)
    assert np.all(np.isfinite(y))


def test_parameters_and_starts_are_those_given():
    actuator = Stepper("piezo_stack", step=H, parameters={"hysteron_count": 5}, initial={"q": 1e-3})
    assert actuator.x.shape == (9,)
    assert actuator.x[0] == 1e-3


@pytest.mark.parametrize("u", [[0.0, 50.0], [0.0, 50.0, 298.15, 1.0], "abc", 50.0, [50.0]])
def test_wrong_inputs_are_refused(u):
    with pytest.raises(UsageError, match="one number each for F_ext, V_in, T_e"):
        Stepper("piezo_stack", step=H).step(u)


def test_no_step_out_of_the_domain():
    actuator = Stepper("piezo_stack", step=1.0)

    def cool():
        for _ in range(1000):
            actuator.step([0.0, 0.0, 1.0])

    with pytest.raises(RunError, match="no step stays in the domain"):
        cool()


@pytest.mark.parametrize("documented", [Stepper, Steps], ids=["function", "class"])
def test_the_examples_of_its_documentation_run_as_they_say(documented):
    examples = doctest.DocTestFinder(recurse=False).find(documented, "Stepper", globs={})
    assert [len(example.examples) > 3 for example in examples] == [True]
    assert doctest.DocTestRunner().run(examples[0]).failed == 0
