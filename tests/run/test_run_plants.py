"""Closed loops as a controller sees them: plants side by side, sampled, late inputs, quanta."""

import numpy as np
import pytest
from scipy.linalg import expm

from piezo_sym import Stepper
from piezo_sym.errors import RunError, UsageError

H = 1e-5
U = np.array([0.0, 60.0, 298.15])
M, K = 1.0, 4.0  # of the oscillator


def discrete(damping, sample):
    """Return how q and p of the oscillator go on over a sample, and what a held force adds."""
    rates = np.array([[0, 1 / M, 0], [-K, -damping / M, 1], [0, 0, 0]])
    whole = expm(rates * sample)
    return whole[:2, :2], whole[:2, 2]


def test_a_loop_is_that_written_by_hand():
    """PI on q in steps of 0.02, two dampers, sampled every ten steps, forces two samples late."""
    dampings, h, every, delay, quantum, target = (0.4, 1.5), 0.01, 10, 2, 0.02, 0.5
    hand = []
    for damping in dampings:
        (a, b), x, waiting, total, path = (
            discrete(damping, every * h),
            np.array([1.0, 0.0]),
            [],
            0.0,
            [],
        )
        for _ in range(100):
            error = target - round(x[0] / quantum) * quantum
            total += error * every * h
            waiting.append(0.5 * error + 0.6 * total)
            force = waiting.pop(0) if len(waiting) > delay else 0.25
            x = a @ x + b * force
            path.append(x)
        hand.append(path)
    loop = Stepper(
        "oscillator",
        step=h,
        order=10,
        parameters=[{"d": damping} for damping in dampings],
        inputs={"F": 0.25},
        every=every,
        delay=delay,
        quantum={"q": quantum},
    )
    total, path = 0.0, []
    for _ in range(100):
        error = target - loop.measured[0]
        total += error * every * h
        y = loop.step([0.5 * error + 0.6 * total])
        path.append(loop.x[:2])
    assert np.abs(np.array(path) - np.transpose(hand, (1, 2, 0))).max() < 1e-11
    assert y[0] == pytest.approx(path[-1][1] / M)
    assert loop.time == pytest.approx(10.0)
    assert np.abs(loop.ledger["energy_residual"]).max() < 1e-12


def test_a_call_holds_its_inputs_for_many_steps():
    plant, one = Stepper("piezo_stack", step=H, every=10), Stepper("piezo_stack", step=H)
    for k in range(5):
        y = plant.step(U * [1, k, 1])
        for _ in range(10):
            expected = one.step(U * [1, k, 1])
        assert np.array_equal(y, expected)
        assert np.array_equal(plant.x, one.x)
    assert plant.time == pytest.approx(50 * H)
    assert plant.ledger.keys() == one.ledger.keys()
    for name, value in one.ledger.items():
        assert np.array_equal(plant.ledger[name], value), name


def test_inputs_act_some_calls_later():
    late = Stepper("piezo_stack", step=H, delay=2, inputs={"V_in": 7.0})
    one = Stepper("piezo_stack", step=H)
    found = [late.step(U * [1, k, 1]) for k in (1, 2, 3, 4)]
    expected = [one.step([0.0, v, 298.15]) for v in (7.0, 7.0, 60.0, 120.0)]
    assert np.array_equal(found, expected)
    late.reset()
    assert np.array_equal(late.step(U), expected[0])


def test_plants_side_by_side_are_those_alone():
    parameters = [{"d": 300.0}, {"d": 500.0, "L": [1e-3, 2e-3]}, {"hysteron_count": 2}]
    together = Stepper("piezo_stack", step=H, parameters=parameters)
    alone = [Stepper("piezo_stack", step=H, parameters=one) for one in parameters]
    volts = np.array([10.0, 60.0, -30.0])
    for k in range(20):
        y = together.step([0.0, k * volts, 298.15])
        expected = [one.step([0.0, v, 298.15]) for one, v in zip(alone, k * volts, strict=True)]
        assert np.array_equal(y, np.transpose(expected))
        assert np.array_equal(together.x, np.transpose([one.x for one in alone]))
    for name, values in together.ledger.items():
        each = np.stack([np.asarray(one.ledger[name]) for one in alone], axis=-1)
        assert np.array_equal(values, each), name
    last = together.x
    together.reset(last)
    assert np.array_equal(together.x, last)
    assert together.time == 0
    y = together.step(U)
    together.reset()
    assert np.array_equal(together.step(np.tile(U[:, None], 3)), y)


def test_a_measurement_is_a_multiple_of_its_quantum():
    exact = Stepper("piezo_stack", step=H)
    rough = Stepper("piezo_stack", step=H, quantum={"q": 1e-7, "y_ambient": 0.01})
    for _ in range(200):
        y, measured = exact.step(U), rough.step(U)
    assert measured[2] == pytest.approx(round(y[2] / 0.01) * 0.01, abs=1e-12)
    assert measured[2] != y[2]
    assert np.array_equal(measured[:2], y[:2])
    assert np.array_equal(rough.x, exact.x)
    assert rough.measured[0] == pytest.approx(round(exact.x[0] / 1e-7) * 1e-7, abs=1e-18)
    assert abs(rough.measured[0]) > 1e-7
    assert np.array_equal(rough.measured[1:], exact.x[1:])
    assert np.array_equal(exact.measured, exact.x)


def test_a_bank_has_one_quantum_unless_a_lane_has_its_own():
    stepper = Stepper("piezo_stack", step=H, quantum={"phi": 1e-4, "phi_2": 1e-5})
    for _ in range(200):
        stepper.step(U)
    place = stepper.states.index("phi_1")
    exact = stepper.x[place : place + 2]
    wanted = np.round(exact / [1e-4, 1e-5]) * [1e-4, 1e-5]
    assert stepper.measured[place : place + 2] == pytest.approx(wanted, abs=1e-15)
    assert np.all(wanted != 0.0)


def test_a_call_that_fails_changes_no_plant():
    """The second plant's environment is too cold; the first has been stepped by then, or not."""
    plants = [{"T_0": 296.15}, {"T_0": 297.0}]
    pair, same = (Stepper("piezo_stack", step=H, every=3, parameters=plants) for _ in range(2))
    for stepper in (pair, same):
        stepper.step([0.0, 50.0, 310.0])
    before = pair.x
    for _ in range(2):
        with pytest.raises(RunError, match=r"'piezo_stack', plant 2 of 2: .* 'T_e > T_0'"):
            pair.step([0.0, [20.0, 30.0], 296.5])
        assert np.array_equal(pair.x, before)
    assert pair.time == same.time == pytest.approx(3 * H)
    assert np.array_equal(*(each.step([0.0, 20.0, 310.0]) for each in (pair, same)))


def test_a_step_that_is_not_taken_restores_the_plants_before_it():
    """Long steps of a body that cools: the second plant leaves the domain within its call."""
    cold = {"q": 0.0, "p": 0.0, "S": 0.0}
    pair = Stepper("oscillator", step=0.5, parameters=[{"d": 0.4}, {"d": 0.0}], initial=cold)
    alone = Stepper("oscillator", step=0.5, parameters={"d": 0.4}, initial=cold)
    pair.step([1.0]), alone.step([1.0])
    before = pair.x
    with pytest.raises(RunError, match="plant 2 of 2: no step stays in the domain"):
        pair.step([np.array([1.0, 1e308])])
    assert np.array_equal(pair.x, before)
    assert np.abs(pair.step([2.0])[:, 0] - alone.step([2.0])).max() < 1e-12


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"every": 0}, "Stepper.every"),
        ({"every": 2.5}, "Stepper.every: 2.5 is not allowed; expected a whole number >= 1"),
        ({"delay": -1}, "Stepper.delay"),
        ({"delay": 1.5}, "Stepper.delay"),
        ({"quantum": {"y_amb": 1.0}}, "Stepper.quantum: unknown name 'y_amb'"),
        ({"quantum": {"q": -1.0}}, "Stepper.quantum.q: -1.0 is not positive"),
        ({"parameters": []}, "Stepper.parameters: there is no plant; expected one mapping per"),
        ({"parameters": [{}, {"hysteron_count": 3}]}, "Stepper.parameters: banks differ in size"),
    ],
)
def test_what_makes_no_loop_is_one_line(options, said):
    with pytest.raises(UsageError) as error:
        Stepper("piezo_stack", step=H, **options)
    assert said in str(error.value)


@pytest.mark.parametrize(
    "wrong", [[1.0], np.zeros((3, 3)), 1.0, "abc", [0.0, [1.0, 2.0, 3.0], 300]]
)
def test_inputs_of_another_shape_are_refused(wrong):
    pair = Stepper("piezo_stack", step=H, parameters=[{}, {}])
    with pytest.raises(
        UsageError, match=r"one number each for F_ext, V_in, T_e, or 2 numbers, one"
    ):
        pair.step(wrong)


def test_an_input_that_is_no_number_is_named_when_it_is_given():
    late = Stepper("piezo_stack", step=H, parameters=[{}, {}], delay=3)
    with pytest.raises(UsageError, match="step: input 'V_in': nan is not a finite number"):
        late.step([0.0, np.array([1.0, np.nan]), 298.15])
    late.step(U)
    assert late.time == H


@pytest.mark.parametrize("plants", [None, [{}, {}]])
def test_an_input_outside_the_domain_is_refused_when_it_is_given(plants):
    """Once it waited, no call would succeed any more."""
    late = Stepper("piezo_stack", step=H, parameters=plants, delay=2)
    late.step(U)
    with pytest.raises(RunError, match=rf"at t = {3 * H:g} s: condition 'T_e > ") as error:
        late.step([0.0, 1.0, -1.0])
    assert ("plant 1 of 2" in str(error.value)) == bool(plants)
    for _ in range(4):
        late.step(U)
    assert late.time == pytest.approx(5 * H)
