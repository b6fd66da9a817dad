"""Loop measures against closed forms: an ellipse has all of them in its amplitudes and its lag."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from piezo_sym import simulate, sine
from piezo_sym.analysis import loops
from piezo_sym.errors import UsageError

SIZES = st.floats(1e-6, 1e6)
LAGS = st.floats(-3.1, 3.1)
SHIFTS = st.floats(-10, 10)


def ellipse(a, b, lag, shift=0.0, start=0.0, n=400):
    t = start + 2 * np.pi * np.arange(n + 1) / n
    return a * np.cos(t) + shift * a, b * np.cos(t - lag) - shift * b


@given(SIZES, SIZES, LAGS, SHIFTS, st.floats(0, 6.2))
def test_an_ellipse(a, b, lag, shift, start):
    x, y = ellipse(a, b, lag, shift, start)
    corners = 1 - (2 * np.pi / 400) ** 2 / 6  # the polygon's area over the ellipse's
    assert loops.area(x, y) == pytest.approx(
        np.pi * a * b * np.sin(lag) * corners, abs=1e-8 * a * b
    )
    assert loops.width(x, y, at=shift * a) == pytest.approx(2 * b * abs(np.sin(lag)), abs=3e-4 * b)
    assert loops.slope(x, y) == pytest.approx(b / a * np.cos(lag), abs=0.02 * b / a)
    assert loops.phase(x, y) == pytest.approx(lag, abs=1e-9)
    assert abs(loops.closure(x, y)) < 1e-12 * b * (1 + abs(shift))


def test_measures_come_together():
    x, y = ellipse(2.0, 3.0, 0.4)
    one = loops.measure(x, y)
    assert (one.area, one.width, one.slope) == (
        loops.area(x, y),
        loops.width(x, y),
        loops.slope(x, y),
    )
    assert (one.phase, one.closure) == (loops.phase(x, y), loops.closure(x, y))


def test_a_loop_that_does_not_close_says_by_how_much():
    x, y = ellipse(1.0, 1.0, 0.5)
    drifting = y + np.linspace(0, 0.25, y.size)
    assert loops.closure(x, drifting) == pytest.approx(0.25)


def test_backwards_is_negative():
    x, y = ellipse(1.0, 1.0, 0.5)
    assert loops.area(x[::-1], y[::-1]) == pytest.approx(-loops.area(x, y))


def test_the_width_where_the_ends_lie_on_the_value():
    """A sine's period starts and ends at its zero, give or take rounding."""
    t = np.linspace(0, 2 * np.pi, 401)
    assert loops.width(np.sin(t), np.sin(t - 0.3)) == pytest.approx(2 * np.sin(0.3), abs=1e-4)


@pytest.mark.parametrize(
    ("x", "y", "said"),
    [
        ([0, 1], [0, 1], "two lists of equal length"),
        (np.arange(9), np.arange(10), "two lists of equal length"),
        (np.ones((3, 3)), np.ones((3, 3)), "two lists of equal length"),
        ([0, 1, 2, 3, 4, 5, 6, np.nan], np.arange(8), "not finite"),
    ],
)
def test_what_is_no_loop_is_refused(x, y, said):
    for measure in (loops.area, loops.width, loops.slope, loops.phase, loops.closure):
        with pytest.raises(UsageError, match=said):
            measure(x, y)


def test_a_width_that_is_not_there_is_refused():
    x, y = ellipse(1.0, 1.0, 0.5)
    with pytest.raises(UsageError, match="x crosses 2 less than twice; it goes from -1 to 1"):
        loops.width(x, y, at=2.0)
    with pytest.raises(UsageError, match="does not vary"):
        loops.slope(np.ones(9), np.arange(9))


@pytest.fixture(scope="module")
def run():
    return simulate(
        "piezo_stack",
        inputs={"V_in": sine(10, 50)},
        duration=0.05,
        times=1001,
        rtol=1e-8,
        method="discrete_gradient",
    )


def test_the_last_period(run):
    last = loops.last_period(run, 50)
    assert last.sizes["time"] == 401
    assert float(last.time[-1] - last.time[0]) == pytest.approx(0.02)
    assert float(last.time[-1]) == 0.05


@pytest.mark.parametrize("frequency", [15.0, 33.3, 8000.0])
def test_no_whole_period_is_refused(run, frequency):
    with pytest.raises(UsageError, match="span one period"):
        loops.last_period(run, frequency)


def test_the_charge_drawn_is_what_the_states_hold(run):
    """What hysterons pass is on the capacitor, or has moved the tip: Q_C' = sum i - alpha v."""
    charge = loops.drawn(run, "supply")
    alpha = run.attrs["parameter_a"] * run.T_body / run.attrs["parameter_T_0"]
    held = run.Q_C - run.Q_C[0] + float(alpha.mean()) * (run.q - run.q[0])
    assert charge.attrs["units"] == "C"
    assert float(np.abs(charge - held).max()) < 1e-4 * float(np.abs(charge).max())
    moved = loops.drawn(run, "load")
    assert moved.attrs["units"] == "m"
    assert float(np.abs(moved - (run.q - run.q[0])).max()) < 1e-5 * float(np.abs(run.q).max())


def test_a_port_that_is_not_there_is_refused(run):
    with pytest.raises(UsageError, match="did you mean 'supply'"):
        loops.drawn(run, "suply")
