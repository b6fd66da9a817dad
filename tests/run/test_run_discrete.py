"""The discrete gradient: right answers, balances to round-off, and no step that takes entropy."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from piezo_sym import load, simulate, sine, step
from piezo_sym.errors import RunError, UsageError

SPECS = sorted((Path(__file__).parents[1] / "networks" / "specs").glob("*.toml"))
CASE_P = {"V_in": sine(100, 100)}
SCALES = {"q": 2e-3, "p": 5e-3, "Q_C": 5e-4, "phi": 6e-3, "S": 5e-2}
ANSWER = {
    "q": -9.523507638450e-04,
    "p": 3.453828489837e-03,
    "Q_C": -3.900998920056e-05,
    "phi": 5.224415297332e-03,
    "S": 1.341141665114e-01,
}


def run(model="piezo_stack", **options):
    return simulate(model, **{"duration": 0.1, "method": "discrete_gradient", **options})


def error(found):
    last = {name: np.max(np.abs(found[name].values[-1] - ANSWER[name])) for name in ANSWER}
    return max(last[name] / SCALES[name] for name in ANSWER)


def residual_bound(found):
    """Return the round-off that the contracts of the step allow, per sample."""
    energy = np.abs(found.energy.values).max()
    gross = sum(np.abs(found[n].values).max() for n in found if n.startswith("supplied_"))
    return 1e-12 * (np.ptp(found.energy.values) + gross) + 4 * np.spacing(energy) * 50


@pytest.mark.parametrize(("rtol", "bound"), [(1e-4, 1e-5), (1e-6, 1e-7), (1e-8, 1e-9)])
def test_case_p_within_its_tolerance(rtol, bound):
    found = run(inputs=CASE_P, rtol=rtol)
    assert error(found) <= bound


def test_case_p_closes_its_energy_balance_to_round_off():
    found = run(inputs=CASE_P, step=1e-5)
    assert np.all(np.abs(found.energy_residual) <= residual_bound(found))
    produced = sum(float(found[n][-1].sum()) for n in found if n.startswith("produced_"))
    assert produced > 0


def test_a_fixed_step_is_of_second_order():
    errors = [error(run(inputs=CASE_P, step=h, times=2)) for h in (4e-5, 2e-5, 1e-5)]
    ratios = [a / b for a, b in pairwise(errors)]
    assert all(3.5 < ratio < 4.5 for ratio in ratios)


def test_extrapolation_is_of_fourth_order_where_laws_are_smooth():
    model = load(SPECS[0].with_name("a2_oscillator.toml"))
    last = []
    for h in (0.02, 0.01):
        coarse, fine = (run(model, step=h / n, duration=5.0, times=2).q.values[-1] for n in (1, 2))
        last.append(abs(fine + (fine - coarse) / 3 + 0.336851680590))
    assert 12 < last[0] / last[1] < 20


@pytest.mark.some(3)
@pytest.mark.parametrize("path", SPECS, ids=lambda path: path.stem)
def test_every_network_runs_and_closes_both_balances(path):
    model = load(path)
    slow = simulate(model, duration=1e-3, rtol=1e-10, times=11, method="LSODA")
    found = run(model, duration=1e-3, rtol=1e-7, times=11)
    for name in slow.data_vars:
        if not name.endswith("_residual"):
            scale = np.max(np.abs(slow[name].values))
            assert np.allclose(found[name], slow[name], rtol=0, atol=1e-5 * scale + 1e-14)
    assert np.all(np.abs(found.energy_residual) <= residual_bound(found))
    for name in found.data_vars:
        if name.startswith("produced_"):
            assert np.all(np.diff(found[name].values, axis=0) >= 0)


@pytest.mark.parametrize("above", [1e-3, 1e-6, 1e-9])
def test_runs_that_start_next_to_the_reference_temperature_finish(above):
    inputs = {**CASE_P, "T_e": 296.15 + above}
    found = run(inputs=inputs, step=2e-5)
    assert np.all(found.T_body.values > 296.15)
    assert np.all(np.diff(found.produced_hysteron.values, axis=0) >= 0)


def test_a_jump_of_an_input_lands_on_a_step():
    found = run(inputs={"V_in": step(0.0313, 0.0, 100.0)}, rtol=1e-6)
    slow = simulate(
        "piezo_stack",
        inputs={"V_in": step(0.0313, 0.0, 100.0)},
        duration=0.1,
        rtol=1e-9,
        method="LSODA",
    )
    assert np.allclose(found.q, slow.q, rtol=0, atol=2e-6 * float(np.abs(slow.q).max()))


@pytest.mark.long
def test_thousands_of_hysterons_run():
    found = run(inputs=CASE_P, step=1e-4, duration=0.01, parameters={"hysteron_count": 10_000})
    assert found.sizes["hysteron"] == 10_000
    assert np.all(np.abs(found.energy_residual) <= residual_bound(found))


def test_a_state_that_leaves_the_domain_stops_the_run():
    with pytest.raises(RunError, match=r"domain at t = 2e-05 s: condition 'T_e > T_0' has margin"):
        run(inputs={"T_e": lambda t: 298.15 - 1e5 * t}, step=1e-3)


def test_step_and_rtol_exclude_each_other():
    with pytest.raises(UsageError, match="step and rtol are both given"):
        run(step=1e-5, rtol=1e-6)


@pytest.mark.long
def test_an_input_that_would_take_steps_without_end_is_refused():
    with pytest.raises(RunError, match=r"steps of 1\.25e-301 s, over 10\^12 of them"):
        simulate("piezo_stack", inputs={"V_in": sine(100, 1e300)}, duration=0.1)


def test_coarse_runs_that_lost_their_way_do_not_spoil_the_finest():
    """Near T_0 the hysterons are so stiff that only the finest run follows them."""
    given = {"inputs": {"V_in": sine(100, 100), "T_e": 296.15 + 1e-6}, "duration": 0.02}
    given |= {"times": 201}
    exact = simulate("piezo_stack", rtol=1e-10, **given)
    found = simulate("piezo_stack", rtol=3e-5, **given)
    for name in ("q", "p", "Q_C", "phi", "S"):
        error = np.max(np.abs(found[name] - exact[name]) / np.max(np.abs(exact[name])))
        assert error <= 20 * 3e-5
