"""The domain guard and solvers that cannot go on: what is said, and when."""

from math import log

import numpy as np
import pytest

import piezo_sym
from piezo_sym import ramp, step
from piezo_sym.errors import RunError
from piezo_sym.run import simulate

METHODS = ["RK45", "Radau", "LSODA"]


def message(*args, **more):
    with pytest.raises(RunError) as error:
        simulate(*args, **more)
    return str(error.value)


def time_in(text):
    return float(text.split("t = ")[1].split(" s")[0])


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("gap", [30.0, 10.0, 0.5])
def test_domain_left_at_a_known_time(exchanger, method, gap):
    known = log(60 / gap) / (0.5 * (1 / 2 + 1 / 3))
    text = message(
        exchanger, duration=20.0, parameters={"gap": gap}, method=method, rtol=1e-8, times=2
    )
    assert time_in(text) == pytest.approx(known, rel=1e-5)
    assert "model 'exchanger': state leaves the domain at t = " in text
    assert "condition 'T_1 - T_2 > gap' has margin" in text
    assert f"gap = {gap:g} K" in text
    cold = 314 - gap * 2 / 5
    assert f"(T_1 = {cold + gap:.6g} K, T_2 = {cold:.6g} K, gap" in text


def test_a_run_that_ends_before_is_not_stopped(exchanger):
    known = log(60 / 10) / (0.5 * (1 / 2 + 1 / 3))
    ds = simulate(exchanger, duration=known - 1e-4, parameters={"gap": 10.0}, rtol=1e-9)
    assert float(ds.T_1[-1] - ds.T_2[-1]) == pytest.approx(10, abs=1e-3)


@pytest.mark.parametrize("method", METHODS)
def test_strict_conditions_fail_at_equality_and_others_do_not(store, variant, method):
    text = message(store, inputs={"power": 1.0}, duration=2.0, parameters={"x_max": 0.75})
    assert time_in(text) == pytest.approx(0.75, abs=1e-6)
    loose = variant(store, DOMAIN=(store.Condition("x <= x_max", False),))
    at_rest = {"initial": {"x": 1.0}, "parameters": {"x_max": 1.0}, "duration": 1.0}
    assert float(simulate(loose, method=method, **at_rest).x[-1]) == 1.0
    assert "start is outside the domain at t = 0 s: condition 'x < x_max' has margin 0 " in message(
        store, method=method, **at_rest
    )


@pytest.mark.parametrize("method", METHODS)
def test_input_that_jumps_out_of_the_domain(piezo, method):
    cold = {"T_e": step(0.0021, 298.15, 291.15)}
    text = message(piezo, inputs=cold, duration=0.01, method=method)
    assert "state leaves the domain at t = 0.0021 s: condition 'T_e > T_0' has margin -5 " in text
    assert "(T_e = 291.15 K, T_0 = 296.15 K)" in text
    assert text.endswith("expected T_e > T_0 throughout the run; change input 'T_e'")


def test_input_that_slides_out_of_the_domain(piezo):
    text = message(piezo, inputs={"T_e": ramp(0.002, 0.006, 298.15, 294.15)}, duration=0.01)
    assert time_in(text) == pytest.approx(0.004, rel=1e-5)


def test_state_that_cools_below_its_domain(piezo, variant):
    """Without the condition on T_e the body itself cools down to T_0, at a known time."""
    domain = (piezo.Condition("T > T_0", True),)
    only_T = variant(piezo, DOMAIN=domain, margins=lambda x, u, p: piezo.margins(x, u, p)[:1])
    text = message(only_T, inputs={"T_e": 290.0}, initial={"S": 0.03}, duration=20.0, rtol=1e-8)
    start = 296.15 * np.exp(0.03 / 5)
    known = 5 / 2 * log((start - 290) / (296.15 - 290))
    assert time_in(text) == pytest.approx(known, rel=1e-4)
    assert "T_body = 296.15 K, T_0 = 296.15 K" in text
    assert "change the inputs, the parameters, the initial state" in text


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ({"inputs": {"T_e": 291.15}}, "'T_e > T_0' has margin -5 (T_e = 291.15 K, T_0 = 296.15 K)"),
        ({"parameters": {"M": -1}}, "'M > 0' has margin -1 (M = -1 kg); expected M > 0"),
        ({"parameters": {"T_0": 0}}, "'T_0 > 0' has margin 0 (T_0 = 0 K)"),
        ({"parameters": {"c_0": 0}}, "'c_0 > 0' has margin 0 (c_0 = 0 J/K)"),
        ({"parameters": {"d": -2}}, "change parameter 'd'"),
        ({"parameters": {"L": [1e-3, 0]}}, "'L > 0' has margin 0 (L = [0.001, 0] H)"),
        (
            {"parameters": {"hysteron_count": 9, "rho": [-1, *range(8)]}},
            "'rho >= 0' has margin -1 (rho from -1 to 7 ohm*K)",
        ),
        ({"initial": {"S": -1}}, "condition 'T > T_0' has margin -53.7 (T_body = 242.467 K, T_0"),
    ],
)
def test_start_outside_the_domain(piezo, more, words):
    text = message(piezo, duration=0.1, **more)
    assert "model 'piezo_stack': start is outside the domain at t = 0 s: condition " in text
    assert words in text
    assert "\n" not in text


def test_nan_margin_is_a_violation(store, variant):
    def margins(x, _u, _p, /):
        return np.where(x > 0.5, np.nan, 1.0)

    text = message(variant(store, margins=margins), inputs={"power": 1.0}, duration=1.0)
    assert "has margin nan" in text
    assert time_in(text) == pytest.approx(0.5, abs=1e-6)


@pytest.mark.parametrize("method", METHODS)
def test_rate_that_is_no_number(store, variant, method):
    def rhs(x, u, _, /):
        return np.where(np.asarray(x) > 0.5, np.nan, u[0]) * np.ones_like(x)

    broken = variant(store, rhs=rhs)
    text = message(broken, inputs={"power": 1.0}, duration=1.0, method=method)
    assert 0.4 < time_in(text) < 0.7
    assert "'x' is not finite" in text or "cannot go on" in text
    text = message(broken, initial={"x": 0.6}, duration=1.0, method=method)
    assert "the rate of change of 'x' is not finite at t = 0 s" in text


@pytest.mark.parametrize("method", METHODS)
def test_solver_that_cannot_go_on(store, variant, method):
    """dx/dt = x^2 from 1 is infinite at t = 1."""
    blow_up = variant(
        store,
        rhs=lambda x, *_: np.asarray(x) ** 2,
        jacobian=lambda x, *_: 2 * np.asarray(x)[None],
        margins=lambda x, *_: np.ones_like(x),
    )
    text = message(blow_up, initial={"x": 1.0}, duration=2.0, method=method)
    assert f"model 'store': solver {method} cannot go on from t = " in text
    assert time_in(text) == pytest.approx(1.0, abs=1e-3)


STEEP = """
[model]
name = "steep"
title = "A spring that saturates, drawn far"
[parameters]
E_0 = { value = 1.0, unit = "J" }
k = { value = 1.0, unit = "N/m" }
m = { value = 1.0, unit = "kg" }
w = { value = 1.0, unit = "mm" }
[inputs]
F = { unit = "N" }
[domain]
assume = ["w > 0"]
[elements.spring]
kind = "spring"
between = ["tip", "wall"]
state = "q"
energy = "k*q**2/2 + E_0*(1 - 1/cosh(q/w))**2"
[elements]
mass = { kind = "mass", at = "tip", mass = "m", state = "p" }
load = { kind = "force_source", at = "tip", input = "F" }
"""


def test_slopes_that_overflow_are_named(tmp_path):
    """A fourth power of cosh is no number from 178 on, though no law jumps there."""
    (tmp_path / "steep.toml").write_text(STEEP, encoding="utf-8")
    with pytest.raises(RunError) as error:
        piezo_sym.simulate(tmp_path / "steep.toml", inputs={"F": 1000.0}, duration=1.0)
    assert "the slopes of its laws by 'q' are infinite there, or nearly" in str(error.value)
    assert "jump" not in str(error.value)


def test_what_was_left_before_the_solver_failed_is_said_first(store, variant):
    blow_up = variant(store, rhs=lambda x, *_: np.asarray(x) ** 2)
    more = {"initial": {"x": 1.0}, "parameters": {"x_max": 50.0}, "duration": 2.0}
    text = message(blow_up, method="RK45", rtol=1e-8, **more)
    assert "condition 'x < x_max'" in text
    assert time_in(text) == pytest.approx(1 - 1 / 50, rel=1e-5)


def test_arithmetic_fault_of_the_module_is_named(store, variant):
    def fails(*_):
        return np.ones(1) * (1 / 0)

    text = message(variant(store, margins=fails), duration=1.0)
    assert "the state at t = 0 s cannot be evaluated: division by zero" in text
    text = message(variant(store, initial_state=fails), duration=1.0)
    assert "the initial state cannot be computed: division by zero" in text
