"""Step by step: the same states as a run, inputs decided on the way, at the cost of a C call."""

import copy
import doctest
import pickle
import pydoc
import threading
from math import inf, nan
from pathlib import Path

import numpy as np
import pytest

from piezo_sym import Stepper, simulate, sine
from piezo_sym.errors import RunError, UsageError
from piezo_sym.spec.load import parse

H = 1e-5
SHIPPED = Path(__file__).parents[2] / "piezo_sym" / "models" / "piezo_stack.toml"


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


def test_outputs_that_are_kept_stay_what_they_were():
    """Kept in a list, they are those of as many runs, one to each step."""
    actuator = Stepper("piezo_stack", step=H)
    kept = [actuator.step([0.0, 50.0, 298.15]) for _ in range(4)]
    for steps, y in enumerate(kept, 1):
        again = Stepper("piezo_stack", step=H)
        values = [again.step([0.0, 50.0, 298.15]).tolist() for _ in range(steps)]
        assert y.tolist() == values[-1]


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


@pytest.mark.parametrize("wrong", [True, np.True_])
@pytest.mark.parametrize("given", [{}, {"delay": 1}, {"parameters": [{}, {}]}])
def test_a_truth_value_is_no_input(wrong, given):
    actuator = Stepper("piezo_stack", step=H, **given)
    before = held(actuator)
    with pytest.raises(UsageError, match=r"step: input 'V_in': .*True.* is not a finite"):
        actuator.step([0.0, wrong, 298.15])
    with pytest.raises(UsageError, match="one number each for F_ext"):
        actuator.step(np.array([False, wrong, True]))
    assert held(actuator) == before


@pytest.mark.parametrize("wrong", ["1", True, [1]])
def test_what_is_no_number_is_refused_before_a_delay(wrong):
    late = Stepper("piezo_stack", step=H, delay=2)
    with pytest.raises(UsageError, match=r"step: input 'V_in': .* is not a finite number"):
        late.step([0.0, wrong, 298.15])
    with pytest.raises(UsageError, match="a list, in this order, of one number each for F_ext"):
        late.step(np.array([[0.0], [50.0], [298.15]]))


@pytest.mark.parametrize("given", [{}, {"delay": 1}, {"parameters": [{}, {}]}])
def test_inputs_are_taken_by_name(given):
    actuator, other = (Stepper("piezo_stack", step=H, **given) for _ in range(2))
    for _ in range(2):
        y = actuator.step({"T_e": 298.15, "V_in": 50.0, "F_ext": 0.0})
        assert np.array_equal(y, other.step([0.0, 50.0, 298.15]))
    before = held(actuator)
    with pytest.raises(UsageError, match=r"Stepper.step: there is no 'F_ext', 'T_e'; expected a"):
        actuator.step({"V_in": 50.0})
    with pytest.raises(UsageError, match=r"unknown name 'V_i'; did you mean 'V_in'\?"):
        actuator.step({"T_e": 298.15, "V_i": 50.0, "F_ext": 0.0})
    with pytest.raises(UsageError, match=r"step: input 'V_in': 'a' is not a finite number"):
        actuator.step({"T_e": 298.15, "V_in": "a", "F_ext": 0.0})
    assert held(actuator) == before


@pytest.mark.parametrize("u", [[0.0, 50.0], [0.0, 50.0, 298.15, 1.0], "abc", 50.0, [50.0]])
def test_wrong_inputs_are_refused(u):
    with pytest.raises(UsageError, match="one number each for F_ext, V_in, T_e"):
        Stepper("piezo_stack", step=H).step(u)


@pytest.mark.parametrize("wrong", [nan, inf, None, "x", [1.0]])
@pytest.mark.parametrize("row", [1, 2])
def test_an_input_that_is_no_number_is_named(row, wrong):
    u = [0.0, 50.0, 298.15]
    u[row] = wrong
    name = ("F_ext", "V_in", "T_e")[row]
    actuator = Stepper("piezo_stack", step=H)
    before = held(actuator)
    with pytest.raises(UsageError, match=rf"step: input '{name}': .* is not a finite number"):
        actuator.step(u)
    assert held(actuator) == before


def test_inputs_outside_the_domain_are_refused_and_change_nothing():
    actuator = Stepper("piezo_stack", step=H)
    actuator.step([0.0, 50.0, 310.0])
    before = held(actuator)
    for wrong in (296.15, 290.0):
        with pytest.raises(RunError, match=r"at t = 1e-05 s: condition 'T_e > T_0' has margin"):
            actuator.step([0.0, 50.0, wrong])
        assert held(actuator) == before
    actuator.step([0.0, 50.0, 310.0])
    assert actuator.time == 2 * H


def held(actuator):
    """Return all that a step changes."""
    ledger = {name: np.ravel(value).tolist() for name, value in actuator.ledger.items()}
    for residual in ("energy_residual", "entropy_residual"):
        del ledger[residual]
    return actuator.x.tolist(), actuator.time, ledger


@pytest.fixture(scope="module")
def frozen():
    """The actuator where the domain ends above the environment, so that cooling leads out of it."""
    cold = '"T_e > 0"'
    text = SHIPPED.read_text(encoding="utf-8").replace('"piezo_stack"', '"frozen"')
    return parse(text.replace('"T_e > T_0"', cold))


def test_a_step_that_fails_changes_nothing(frozen):
    """Halves of it stay in the domain: what they book is forgotten."""
    actuator = Stepper(frozen, step=0.07)

    def cool():
        for _ in range(1000):
            before.append(held(actuator))
            actuator.step([0.0, 0.0, 250.0])

    before = []
    with pytest.raises(RunError, match="no step stays in the domain"):
        cool()
    assert len(before) > 1
    assert held(actuator) == before[-1]
    assert actuator.ledger["entropy_exchanged_ambient"] < 0
    actuator.step([0.0, 0.0, 310.0])
    assert actuator.ledger["entropy_residual"] == pytest.approx(0, abs=1e-12)


def test_its_ledger_is_that_of_a_run():
    drive = sine(100, 1000)
    actuator = Stepper("piezo_stack", step=H)
    for k in range(100):
        actuator.step([0.0, float(drive((k + 0.5) * H)), 298.15])
    run = simulate("piezo_stack", inputs={"V_in": drive}, duration=100 * H, step=H, times=2)
    names = [n for n in run if n.startswith(("supplied_", "heat_", "produced_", "entropy_e"))]
    assert [*names, "energy_residual", "entropy_residual"] == list(actuator.ledger)
    for name in names:
        assert actuator.ledger[name] == pytest.approx(run[name].values[-1], rel=1e-9, abs=1e-18)
    assert actuator.ledger["heat_hysteron"].shape == (2,)
    assert abs(actuator.ledger["energy_residual"]) <= 1e-12 * float(run.energy[-1])
    assert abs(actuator.ledger["entropy_residual"]) <= 1e-14


def test_names_are_in_the_order_of_the_numbers():
    actuator = Stepper("piezo_stack", step=H, parameters={"hysteron_count": 3})
    assert actuator.states == ("q", "p", "Q_C", "phi_1", "phi_2", "phi_3", "S")
    assert actuator.inputs == ("F_ext", "V_in", "T_e")
    assert actuator.outputs == ("y_load", "y_supply", "y_ambient")
    y = dict(zip(actuator.outputs, actuator.step([0.0, 50.0, 298.15]), strict=True))
    x = dict(zip(actuator.states, actuator.x, strict=True))
    assert y["y_load"] == pytest.approx(x["p"] / 3.5e-3)
    assert y["y_supply"] == pytest.approx((x["phi_1"] + x["phi_2"] + x["phi_3"]) / 1e-3)


def walked(actuator):
    """Return the states of some steps."""
    found = []
    for k in range(50):
        actuator.step([0.0, 10.0 * k, 298.15])
        found.append(actuator.x.tolist())
    return found


def test_a_reset_begins_again():
    actuator = Stepper("piezo_stack", step=H, initial={"q": 1e-4})
    first, ledger, last = walked(actuator), actuator.ledger, actuator.x
    actuator.reset()
    assert actuator.time == 0
    assert actuator.x[0] == 1e-4
    assert not any(np.any(value) for value in actuator.ledger.values())
    assert walked(actuator) == first
    assert actuator.ledger["supplied_supply"] == ledger["supplied_supply"]
    actuator.reset(last)
    assert actuator.x.tolist() == last.tolist()
    assert not any(np.any(value) for value in actuator.ledger.values())


@pytest.mark.parametrize(
    ("x", "error", "words"),
    [
        ([0.0], UsageError, "1 numbers are no state; expected one number each for q, p"),
        ([0, 0, 0, 0, 0, nan], UsageError, "Stepper.reset[5]: nan is not a finite number"),
        ([0, 0, 0, 0, 0, -1.0], RunError, "condition 'T > T_0'"),
    ],
)
def test_a_reset_to_no_state_is_refused(x, error, words):
    actuator = Stepper("piezo_stack", step=H)
    before = held(actuator)
    with pytest.raises(error) as raised:
        actuator.reset(x)
    assert words in str(raised.value)
    assert held(actuator) == before


def test_the_examples_of_its_documentation_run_as_they_say():
    examples = doctest.DocTestFinder(recurse=False).find(Stepper, "Stepper", globs={})
    assert [len(example.examples) > 3 for example in examples] == [True]
    assert doctest.DocTestRunner().run(examples[0]).failed == 0


def test_inputs_at_the_start_are_numbers():
    with pytest.raises(UsageError, match=r"Stepper.inputs.V_in: this is no number.*step\(u\)"):
        Stepper("piezo_stack", step=H, inputs={"V_in": sine(100, 100)})


def test_two_threads_cannot_step_one_stepper():
    stepper, errors = Stepper("piezo_stack", step=1e-5), []

    def other():
        with pytest.raises(UsageError) as error:
            stepper.step([0.0, 1.0, 298.15])
        errors.append(str(error.value))

    class Inputs:
        """Inputs that are read while another thread steps."""

        def __iter__(self):
            thread = threading.Thread(target=other)
            thread.start()
            thread.join()
            return iter([0.0, 1.0, 298.15])

    stepper.step(Inputs())
    said = "Stepper.step: another thread is stepping this Stepper; give each thread"
    assert errors[0].startswith(said)
    assert stepper.time == 1e-5
    stepper.step([0.0, 1.0, 298.15])


def test_a_stepper_is_not_pickled_but_another_can_be_made():
    stepper = Stepper("piezo_stack", step=1e-5)
    stepper.step([0.0, 1.0, 298.15])
    with pytest.raises(UsageError, match="stays in its process; make another there"):
        pickle.dumps(stepper)
    with pytest.raises(UsageError, match="stays in its process"):
        copy.deepcopy(stepper)


def test_help_shows_the_methods_and_what_they_take():
    said = pydoc.plain(pydoc.render_doc(Stepper))
    assert "-> piezo_sym.run.stepper.Stepper" in said
    assert "ring from step to step after a jump, at order 2," in " ".join(said.split())
    for words in ("    step(u) : ", "    reset(x=None) : ", "<bank>_count", "or a dict"):
        assert words in said
