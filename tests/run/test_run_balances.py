"""Both laws over long runs: a million steps, and starts right above the reference temperature."""

from pathlib import Path

import numpy as np
import pytest

from piezo_sym import load, simulate, sine

SPECS = Path(__file__).parents[1] / "networks" / "specs"
T_0 = 296.15
METHOD = "discrete_gradient"
PRODUCTIONS = ("produced_hysteron", "produced_damper")


def gross(found):
    """Return the energy that went through the ports, in and out, between samples."""
    ports = [found[name].values for name in found.data_vars if name.startswith("supplied_")]
    return float(sum(np.abs(np.diff(port)).sum() for port in ports))


def check_energy(found):
    """Check the criterion of a run: |residual| <= 1e-12 (range + gross supply) + 4 ulp."""
    energy = found.energy.values
    bound = 1e-12 * (np.ptp(energy) + gross(found)) + 4 * np.spacing(np.abs(energy).max())
    assert np.abs(found.energy_residual.values).max() <= bound


def check_production(found):
    """Check that no process takes entropy between two samples."""
    for name in PRODUCTIONS:
        assert np.all(np.diff(found[name].values, axis=0) >= 0)
        assert np.all(np.diff(found[name.replace("produced", "heat")].values, axis=0) >= 0)


def check_entropy(found, t_e, bound):
    """Check that entropy is what was produced and what came in.

    lam (T_e/Tbar - 1) is integrated here by Simpson's rule, from the states of each sample.
    """
    hot = found.T_body.values
    rates = 2.0 * (t_e / hot - 1)
    h = np.diff(found.time.values)[::2]
    exchanged = float(np.sum(h / 3 * (rates[:-2:2] + 4 * rates[1:-1:2] + rates[2::2])))
    made = sum(float(found[name].values[-1].sum()) for name in PRODUCTIONS)
    gained = float(found.entropy[-1] - found.entropy[0])
    assert abs(gained - made - exchanged) <= bound * (made + abs(exchanged))
    assert found.entropy_exchanged_ambient.values[-1] == pytest.approx(exchanged, rel=bound)


def turnover(found):
    """Return the entropy that was made, and that went in and out, between samples."""
    names = [n for n in found if n.startswith(("produced_", "entropy_exchanged_"))]
    parts = [found[n].values.reshape(found.sizes["time"], -1).sum(axis=1) for n in names]
    return sum(np.abs(np.diff(part)).sum() for part in parts)


@pytest.mark.parametrize(
    "how",
    [
        {"rtol": 1e-6},
        {"step": 1e-5},
        {"step": 1e-4, "dissipative_start": True},
    ],
    ids=str,
)
def test_entropy_is_what_was_made_and_what_came_in(how):
    inputs = {"V_in": sine(100, 100, phase=1.0), "T_e": sine(20, 50, offset=330)}
    found = simulate("piezo_stack", inputs=inputs, duration=0.1, **how)
    scale = turnover(found) + np.abs(found.entropy.values).max()
    assert scale > 1e-3
    assert np.abs(found.entropy_residual.values).max() <= 1e-13 * scale
    assert np.abs(found.entropy_exchanged_ambient.values).max() > 1e-3


@pytest.mark.some(1)
@pytest.mark.parametrize("times", [20_001, pytest.param(200_001, marks=pytest.mark.long)])
@pytest.mark.parametrize("rtol", [1e-3, 1e-5])
def test_production_never_falls_between_close_samples(rtol, times):
    """Samples' own errors are larger than what is produced between two that are so close."""
    options = {"inputs": {"V_in": sine(100, 100)}, "duration": 0.1, "rtol": rtol}
    found = simulate("piezo_stack", times=times, **options)
    check_production(found)
    check_energy(found)
    scale = turnover(found) + np.abs(found.entropy.values).max()
    assert np.abs(found.entropy_residual.values).max() <= 1e-13 * scale
    few = simulate("piezo_stack", times=11, **options)
    for name in ("q", "p", "Q_C", "phi", "S"):
        every = found[name].values[:: (times - 1) // 10]
        assert np.abs(every - few[name].values).max() <= 10 * rtol * np.abs(every).max()
        assert np.array_equal(every[-1], few[name].values[-1])  # runs do not go by samples


@pytest.mark.some(1)
@pytest.mark.parametrize(
    ("spec", "rtol", "duration"), [("dry_friction", 0.1, 1.0), ("tables", 1e-6, 0.01)]
)
def test_the_run_is_the_same_beside_samples_whose_steps_find_no_rates(spec, rtol, duration):
    """Some lie in that part of a step that is beyond a switch, where no stage of the step is."""
    few, many = (
        simulate(load(SPECS / f"{spec}.toml"), duration=duration, rtol=rtol, times=times)
        for times in (2, 20_001)
    )
    assert few.attrs["accepted_steps"] == many.attrs["accepted_steps"]
    assert few.attrs["halvings"] == many.attrs["halvings"]
    for name in (n for n in many if n.startswith(("heat_", "produced_"))):
        assert np.all(np.diff(many[name].values, axis=0) >= 0)


def test_scipys_entropy_balance_closes_to_its_error():
    inputs = {"V_in": sine(100, 100)}
    loose, tight = (
        simulate("piezo_stack", inputs=inputs, duration=0.01, method="DOP853", rtol=rtol)
        for rtol in (1e-4, 1e-9)
    )
    assert np.abs(tight.entropy_residual).max() <= 1e-7 * turnover(tight)
    assert np.abs(tight.entropy_residual).max() < np.abs(loose.entropy_residual).max()


def test_bodies_in_contact_exchange_nothing_with_others():
    found = simulate(load(SPECS / "a1_two_bodies.toml"), duration=1.0, times=11)
    assert not [name for name in found if name.startswith("entropy_exchanged_")]
    assert np.abs(found.entropy_residual.values).max() <= 1e-14 * float(found.entropy[-1])


@pytest.mark.some(1)
@pytest.mark.parametrize("h", [1e-5, 1e-6])
def test_a_million_steps_close_the_energy_balance(h):
    options = {"inputs": {"V_in": sine(100, 100)}, "times": 1001}
    found = simulate("piezo_stack", method=METHOD, step=h, duration=1e6 * h, **options)
    assert found.accepted_steps == 1_000_000
    check_energy(found)
    check_production(found)


@pytest.mark.long
def test_a_million_steps_of_what_nothing_enters():
    """An oscillator alone: what its damper takes, its body has; U stays at 602 J to 4 ulp."""
    model = load(SPECS / "a2_oscillator.toml")
    found = simulate(model, method=METHOD, step=1e-5, duration=10.0)
    assert found.accepted_steps == 1_000_000
    assert gross(found) == 0
    check_energy(found)
    assert np.all(np.diff(found.produced_damper.values) >= 0)


def test_no_single_step_takes_entropy():
    """Every step is a sample: 100,000 of them, through ten periods and all kinks."""
    options = {"inputs": {"V_in": sine(100, 100)}, "duration": 0.1}
    found = simulate("piezo_stack", method=METHOD, step=1e-6, times=100_001, **options)
    assert 100_000 <= found.accepted_steps <= 100_010
    check_energy(found)
    check_production(found)
    check_entropy(found, 298.15, 1e-9)
    idle = np.abs(found.phi.values) < 0.4 * 1e-3
    still = np.diff(found.produced_hysteron.values, axis=0)[idle[:-1] & idle[1:]]
    assert still.size > 0
    assert np.all(still == 0)


@pytest.mark.parametrize("above", [1e-3, 1e-6, 1e-9])
@pytest.mark.parametrize("accuracy", [{"step": 2e-5}, {"step": 1e-6}, {"rtol": 1e-6}], ids=str)
def test_starts_next_to_the_reference_temperature(above, accuracy):
    inputs = {"V_in": sine(100, 100), "T_e": T_0 + above}
    options = {"inputs": inputs, "duration": 0.1, "times": 201}
    found = simulate("piezo_stack", method=METHOD, **accuracy, **options)
    check_energy(found)
    check_production(found)
    assert np.all(found.T_body.values > T_0)
    assert found.produced_hysteron.values[-1].min() > 0
    assert np.all(np.isfinite(found.to_array()))


@pytest.mark.parametrize("above", [1e-3, 1e-6, 1e-9])
def test_states_next_to_the_reference_temperature_are_right(above):
    """Runs with a tolerance and with short steps agree: no false root was taken for a state."""
    inputs = {"V_in": sine(100, 100), "T_e": T_0 + above}
    options = {"inputs": inputs, "duration": 0.02, "times": 51}
    found, wanted = (
        simulate("piezo_stack", method=METHOD, **accuracy, **options)
        for accuracy in ({"rtol": 1e-7}, {"step": 2.5e-7})
    )
    for name, size in (("q", 2e-3), ("p", 5e-3), ("Q_C", 5e-4), ("phi", 6e-3), ("S", 5e-2)):
        assert np.abs(found[name] - wanted[name]).max() <= 1e-5 * size
