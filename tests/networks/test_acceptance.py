"""Cases with answers in closed form: bodies, an oscillator and a circuit that heat themselves."""

from pathlib import Path

import numpy as np
import pytest

from piezo_sym import derive, load, simulate

SPECS = Path(__file__).with_name("specs")
TWO_BODIES = SPECS / "a1_two_bodies.toml"
OSCILLATOR = SPECS / "a2_oscillator.toml"
THERMISTOR = SPECS / "a5_thermistor.toml"
SLIDER = SPECS / "a10_maxwell_slip.toml"


def test_two_bodies_in_contact():
    run = simulate(load(TWO_BODIES), duration=60.0, rtol=1e-10, times=[0.0, 4.0, 60.0])
    assert run.T_hot.values[1] == pytest.approx(320.79952170215, rel=1e-9)
    assert run.T_cold.values[1] == pytest.approx(309.46698553190, rel=1e-9)
    gap = 60 * np.exp(-0.5 * (1 / 2 + 1 / 3) * run.time.values)
    assert np.allclose(run.T_hot - run.T_cold, gap, atol=1e-6)
    assert run.T_hot.values[2] == pytest.approx(314.0, abs=1e-8)
    gained = float(run.entropy[2] - run.entropy[0])
    assert gained == pytest.approx(0.02145585163279, rel=1e-7)
    assert float(run.produced_contact[2]) == pytest.approx(gained, rel=1e-7)


def test_conduction_is_the_process_of_a_heat_exchanger():
    iphs = derive(load(TWO_BODIES))
    (process,) = iphs.processes
    hot, cold = iphs.E
    lam = iphs.symbols["lam"]
    assert process.bracket == hot - cold
    assert (process.gamma - lam / (hot * cold)).expand() == 0
    assert list(process.J) == [0, -1, 1, 0]


def test_an_oscillator_that_heats_itself():
    run = simulate(load(OSCILLATOR), duration=200.0, rtol=1e-11, times=[0.0, 5.0, 200.0])
    assert run.q.values[1] == pytest.approx(-0.336851680590, abs=1e-9)
    assert run.p.values[1] == pytest.approx(0.370691413969, abs=1e-9)
    assert run.T_body.values[1] == pytest.approx(300.852177914186, abs=1e-8)
    assert run.T_body.values[2] == pytest.approx(301.0, abs=1e-7)


def test_a_circuit_with_a_thermistor_ends_at_400_kelvin():
    run = simulate(load(THERMISTOR), duration=0.1, rtol=1e-9, method="Radau", times=[0.0, 0.1])
    assert run.T_body.values[1] == pytest.approx(400.0, rel=1e-6)
    assert abs(float(run.energy_residual[1])) < 1e-8


def test_a_spring_and_a_slider_in_series_lose_what_maxwells_model_says():
    k, F_c, X, slow = 2.0, 1.0, 2.0, 2 * np.pi * 0.1
    run = simulate(
        load(SLIDER),
        inputs={"w": lambda t: X * slow * np.cos(slow * t)},
        duration=20.0,
        rtol=1e-7,
        method="Radau",
        times=[0.0, 10.0, 20.0],
    )
    cycle = float(run.heat_slider[2] - run.heat_slider[1])
    assert cycle == pytest.approx(4 * F_c * (X - F_c / k), rel=1e-4)
    assert 4 * F_c * (X - F_c / k) == 6
