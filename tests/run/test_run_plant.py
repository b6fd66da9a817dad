"""Plants of closed loops do, sampled, delayed, rounded and side by side, what one Stepper does."""

import numpy as np
import pytest

from piezo_sym import Stepper
from piezo_sym.errors import UsageError

H = 1e-5
U = np.array([0.0, 60.0, 298.15])


def test_a_sample_holds_its_inputs_for_many_steps():
    plant, one = Stepper("piezo_stack", step=H, sample=10 * H), Stepper("piezo_stack", step=H)
    for k in range(5):
        y = plant.step(U * [1, k, 1])
        for _ in range(10):
            expected = one.step(U * [1, k, 1])
        assert np.array_equal(y, expected)
        assert np.array_equal(plant.x, one.x)
    assert plant.time == pytest.approx(50 * H)
    for name, value in one.ledger.items():
        assert np.array_equal(plant.ledgers[0][name], value), name


def test_a_delay_lets_inputs_act_later():
    inputs = {"V_in": 7.0}
    late = Stepper("piezo_stack", step=H, delay=2, inputs=inputs)
    one = Stepper("piezo_stack", step=H, inputs=inputs)
    drives = [U, 2 * U, 3 * U, 4 * U]
    found = [late.step([0, u[1], 298.15]) for u in drives]
    expected = [one.step([0, v, 298.15]) for v in (7.0, 7.0, U[1], 2 * U[1])]
    assert np.array_equal(found, expected)
    late.reset()
    assert np.array_equal(late.step([0, 60.0, 298.15]), expected[0])


def test_plants_side_by_side_are_those_alone():
    parameters = [{"d": 300.0}, {"d": 500.0, "L": [1e-3, 2e-3]}]
    both = Stepper("piezo_stack", step=H, parameters=parameters)
    alone = [Stepper("piezo_stack", step=H, parameters=one) for one in parameters]
    for k in range(20):
        u = np.stack([U, U * [1, 2 + k, 1]], axis=1)
        y = both.step(u)
        assert np.array_equal(y, np.stack([a.step(u[:, n]) for n, a in enumerate(alone)], axis=1))
    assert both.x.shape == (6, 2)
    assert y.shape == (3, 2)
    assert both.step(U).shape == (3, 2)  # the same for all


def test_a_measurement_is_rounded():
    exact, rough = (
        Stepper("piezo_stack", step=H, resolution=size) for size in (None, {"ambient": 0.01})
    )
    for _ in range(200):
        y, measured = exact.step(U), rough.step(U)
    assert measured[2] == pytest.approx(round(y[2] / 0.01) * 0.01, abs=1e-12)
    assert measured[2] != y[2]
    assert np.array_equal(measured[:2], y[:2])
    assert np.array_equal(rough.x, exact.x)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"sample": 2.5 * H}, "Stepper.sample: '2.5e-05' s is no multiple of the step"),
        ({"sample": 0.1 * H}, "no multiple of the step; expected a whole number of steps"),
        ({"delay": -1}, "Stepper.delay"),
        ({"delay": 1.5}, "Stepper.delay"),
        ({"resolution": {"T": 1.0}}, "Stepper.resolution: unknown name 'T'"),
        ({"resolution": {"ambient": -1.0}}, "Stepper.resolution.ambient"),
        ({"parameters": []}, "there is no plant"),
    ],
)
def test_what_makes_no_plant_is_one_line(options, said):
    with pytest.raises(UsageError) as error:
        Stepper("piezo_stack", step=H, **options)
    assert said in str(error.value)


def test_inputs_of_another_shape_are_refused():
    plant = Stepper("piezo_stack", step=H, parameters=[{}, {}])
    for wrong in ([1.0], np.zeros((3, 3)), 1.0, "abc"):
        with pytest.raises(UsageError, match="are no inputs; expected numbers of shape"):
            plant.step(wrong)
