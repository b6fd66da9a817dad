"""Runs with known answers: the paper's actuator, bodies in contact, integrals of signals."""

from math import log

import numpy as np
import pytest
from scipy.integrate import quad, simpson

from piezo_sym import chirp, ramp, samples, sine, step, triangle
from piezo_sym.run import simulate
from piezo_sym.run.inputs import as_signal, read_inputs
from piezo_sym.run.scipy_runs import magnitudes
from piezo_sym.run.system import DrivenModule

CASE_P = {  # at t = 0.1 s, and the scale of its error
    "q": (-9.523507638450e-04, 2e-3),
    "p": (3.453828489837e-03, 5e-3),
    "Q_C": (-3.900998920056e-05, 5e-4),
    "phi": (5.224415297332e-03, 6e-3),
    "S": (1.341141665114e-01, 5e-2),
}


@pytest.fixture(scope="module", params=["LSODA", pytest.param("Radau", marks=pytest.mark.long)])
def case_p(request, piezo):
    drive = {"V_in": sine(100, 100), "T_e": 298.15}
    return simulate(piezo, inputs=drive, duration=0.1, rtol=1e-9, method=request.param, times=20001)


def test_case_p(case_p):
    for name, (value, scale) in CASE_P.items():
        error = np.max(np.abs(case_p[name].values[-1] - value)) / scale
        assert error < 1e-6, name


def test_case_p_closes_its_ledger(case_p):
    gross = np.abs(case_p.supplied_supply).max() + np.abs(case_p.supplied_ambient).max()
    assert gross > 20
    assert np.abs(case_p.energy_residual).max() < 1e-6 * gross
    into_body = 2.0 * (298.15 / case_p.T_body.values - 1)  # the entropy that lam lets in
    exchanged = simpson(into_body, x=case_p.time.values)
    produced = case_p.produced_hysteron.sum("hysteron") + case_p.produced_damper
    gained = case_p.entropy - case_p.entropy[0]
    assert gained[-1] > 0.05
    assert float((gained - produced)[-1]) == pytest.approx(exchanged, abs=1e-8)
    stored = case_p.heat_hysteron.sum("hysteron") + case_p.heat_damper + case_p.supplied_ambient
    heated = 5.0 * (case_p.T_body - case_p.T_body[0])
    assert np.abs(heated - stored).max() < 1e-6 * gross


@pytest.mark.parametrize("method", ["RK23", "RK45", "DOP853", "Radau", "BDF", "LSODA"])
def test_bodies_in_contact(exchanger, method):
    ds = simulate(exchanger, duration=4.0, rtol=1e-8, method=method, times=9)
    known = (320.79952170215, 309.46698553190)
    assert (ds.T_1.values[-1], ds.T_2.values[-1]) == pytest.approx(known, rel=3e-8)
    difference = 60 * np.exp(-0.5 * (1 / 2 + 1 / 3) * ds.time.values)
    assert (ds.T_1 - ds.T_2).values == pytest.approx(difference, rel=1e-6)
    assert ds.heat_wall.values == pytest.approx((2 * (350 - ds.T_1)).values, abs=1e-5)
    gained = (ds.entropy - ds.entropy[0]).values
    assert ds.produced_wall.values == pytest.approx(gained, abs=1e-8)


def test_bodies_in_contact_forever(exchanger):
    ds = simulate(exchanger, duration=30.0, rtol=1e-9)
    assert float(ds.T_1[-1]) == pytest.approx(314, abs=2e-4)
    assert float(ds.produced_wall[-1]) == pytest.approx(0.02145585163279, rel=1e-6)


PULSE = np.zeros(2001)
PULSE[1234] = 1e3


@pytest.mark.some(2)
@pytest.mark.parametrize("method", ["RK45", "Radau", "LSODA"])
@pytest.mark.parametrize(
    ("signal", "integral"),
    [
        (2.5, 2.5),
        (lambda t: 3 * t * t, 1.0),
        (step(0.3, 1.0, -2.0), 0.3 - 1.4),
        (ramp(0.5, 0.501, 0.0, 8.0), 0.004 + 8 * 0.499),
        (triangle(7.0, 2.25, 1.0), 1 + 7 / (4 * 2 * 2.25)),
        (triangle(2e3, 505.25), 2e3 / (4 * 2 * 505.25)),  # more than a thousand corners
        (sine(3.0, 300.25, 1.0), 1 + 3 / (2 * np.pi * 300.25)),
        (chirp(1.0, 1.0, 40.0, 0.8), quad(chirp(1.0, 1.0, 40.0, 0.8), 0, 1, limit=500)[0]),
        (([0, 0.7, 0.7001, 0.7002, 1], [0, 0, 5e4, 0, 0]), 5.0),
        (samples(np.linspace(0, 1, 2001), PULSE), 0.5),
    ],
)
def test_no_signal_is_jumped_over(store, signal, integral, method):
    ds = simulate(store, inputs={"power": signal, "other": 1.0}, duration=1.0, method=method)
    gross = 1 + np.mean(np.abs(as_signal(signal, "power")(np.linspace(0, 1, 100_001))))
    near = 2e-4 * gross
    assert abs(integral) > 2 * near
    assert float(ds.x[-1]) == pytest.approx(1 + integral, abs=near)
    assert float(ds.supplied_more[-1]) == pytest.approx(1.0)
    assert float(ds.supplied_feed[-1]) == pytest.approx(integral, abs=near)


def test_a_jump_is_a_run_split_by_hand(piezo):
    jump, end, more = 0.00123456, 0.004, {"rtol": 1e-9, "method": "Radau"}
    drive = {"F_ext": 5.0, "V_in": step(jump, 20.0, 90.0)}
    times = np.array([0.0, jump, end])
    whole = simulate(piezo, inputs=drive, duration=end, times=times, **more)
    first = simulate(piezo, inputs=drive | {"V_in": 20.0}, duration=jump, times=2, **more)
    names = [record.name for record in piezo.STATES]
    middle = {name: first[name].values[-1] for name in names}
    drive["V_in"] = 90.0
    second = simulate(piezo, inputs=drive, duration=end - jump, initial=middle, times=2, **more)
    for name in names:
        scale = np.abs(whole[name].values).max()
        for place, part in ((1, first), (2, second)):
            gap = whole[name].values[place] - part[name].values[-1]
            assert np.abs(gap).max() < 1e-8 * scale, name
    assert np.array_equal(whole.V_in, [20, 90, 90])
    parts = first.supplied_supply[-1] + second.supplied_supply[-1]
    assert float(whole.supplied_supply[-1]) == pytest.approx(float(parts), rel=1e-8)


def test_equal_hysterons_stay_equal_and_uneven_ones_do_not(piezo):
    drive = {"V_in": sine(100, 100)}
    even = simulate(piezo, inputs=drive, duration=0.005, parameters={"hysteron_count": 8})
    assert even.phi.shape == (1001, 8)
    assert np.array_equal(even.hysteron, np.arange(1, 9))
    assert np.allclose(even.phi[:, 0], even.phi[:, 7], rtol=1e-9)
    uneven = simulate(
        piezo,
        inputs=drive,
        duration=0.005,
        parameters={"hysteron_count": 3, "L": [1e-3, 2e-3, 1e-3]},
    )
    assert np.allclose(uneven.phi[:, 0], uneven.phi[:, 2], rtol=1e-9)
    assert np.abs(uneven.phi[:, 0] - uneven.phi[:, 1]).max() > 1e-3


def test_start_values_replace_the_modules_own(piezo):
    initial = {"q": 1e-4, "phi": [1e-3, -1e-3]}
    ds = simulate(piezo, inputs={"T_e": 310.0}, initial=initial, duration=1e-3, times=2)
    assert float(ds.q[0]) == 1e-4
    assert np.array_equal(ds.phi[0], [1e-3, -1e-3])
    assert float(ds.S[0]) == pytest.approx(5 * log(310 / 296.15))
    both = simulate(piezo, initial={"phi": 2e-3}, duration=1e-3, times=2)
    assert np.array_equal(both.phi[0], [2e-3, 2e-3])


def test_tighter_rtol_is_nearer(piezo):
    drive = {"V_in": sine(100, 100), "T_e": 298.15}
    errors = [
        abs(simulate(piezo, inputs=drive, duration=0.1, rtol=r).q.values[-1] - CASE_P["q"][0])
        for r in (1e-4, 1e-8)
    ]
    assert errors[1] < errors[0] / 10


def test_samples_do_not_change_the_run_or_its_integrals(piezo):
    drive, times = {"V_in": triangle(80, 100)}, np.array([0.0013, 0.0025, 0.006, 0.01])
    some = simulate(piezo, inputs=drive, duration=0.01, times=times)
    many = simulate(piezo, inputs=drive, duration=0.01, times=10001)
    picked = many.sel(time=times, method="nearest")
    for name in ("q", "phi", "energy", "heat_damper", "produced_hysteron", "supplied_supply"):
        scale = float(np.abs(picked[name]).max())
        assert np.abs(some[name].values - picked[name].values).max() < 1e-6 * scale, name


def test_scale_of_a_state_that_starts_at_rest(store):
    """A state of 1e-13 is followed as well as one of 1e9: its tolerance fits its scale."""
    for size in (1e-13, 1e9):
        ds = simulate(
            store, inputs={"power": sine(size, 3.0)}, duration=1.0, parameters={"x_max": 1e12}
        )
        exact = size * (1 - np.cos(6 * np.pi * ds.time)) / (6 * np.pi)
        assert np.abs(ds.x - exact).max() < 1e-3 * size / (3 * np.pi)


def test_lanes_share_their_scale(piezo):
    p = piezo.Parameters()
    system = DrivenModule(piezo, p, read_inputs(piezo, {"V_in": 0.0}, 1e-4))
    x = piezo.initial_state((0, 0, 298.15), p)
    x[3] = 2e-3
    scale, evaluations = magnitudes(system, x)
    assert scale[3] == scale[4] == 2e-3
    assert scale[0] < scale[3]
    assert np.all(scale > 0)
    assert evaluations > 10


@pytest.mark.parametrize("method", ["Radau", "BDF", "LSODA"])
def test_implicit_methods_use_the_jacobian(piezo, variant, method):
    seen = []

    def jacobian(*args):
        seen.append(args)
        return piezo.jacobian(*args)

    spied = variant(piezo, jacobian=jacobian)
    simulate(spied, inputs={"V_in": 50.0}, duration=2e-3, method=method)
    coarse = len(seen)
    simulate(spied, inputs={"V_in": 50.0}, duration=2e-3, method="RK23")
    assert coarse > len(seen) - coarse  # RK23 needs it in the coarse run only


def test_long_steps_with_many_samples_are_cut(store):
    ds = simulate(store, inputs={"power": 2.0}, duration=1.0, times=5000)
    assert ds.attrs["accepted_steps"] < 100
    assert ds.x.values == pytest.approx(2 * ds.time.values, abs=1e-12)
    assert ds.supplied_feed.values == pytest.approx(2 * ds.time.values, abs=1e-12)
