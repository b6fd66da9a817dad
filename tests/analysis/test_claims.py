"""What section 4 of the paper claims, as numbers: what holds, and what does not, and how it fails.

The table in notebooks/06-paper-and-software.ipynb says the same in words.
"""

import numpy as np
import pytest

from piezo_sym import periodic_steady_state, periodic_steady_states, simulate, sine
from piezo_sym.analysis import loops
from piezo_sym.analysis.figures import lines

TEMPERATURES = (298.15, 303.15, 308.15, 313.15)
FREQUENCIES = (10, 50, 100, 200)


def tenth(frequency, T_e=298.15, **changed):
    run = simulate(
        "piezo_stack",
        inputs={"V_in": sine(100, frequency), "T_e": T_e},
        duration=10 / frequency,
        times=4001,
        rtol=1e-6,
        method="discrete_gradient",
        **changed,
    )
    last = loops.last_period(run, frequency)
    return loops.measure(last.V_in.values, last.q.values)


@pytest.fixture(scope="module")
def over_frequency():
    return [tenth(f) for f in FREQUENCIES]


def test_figure_2_the_operator_is_odd_dead_in_the_middle_and_flatter_when_warm(stack):
    for T in TEMPERATURES:
        data = lines.operator(stack, T - 273.15)
        i, w = data.i.values, data.w_T.values
        expected = 10 / (T - 296.15) * np.sign(i) * np.maximum(np.abs(i) - 0.5, 0)
        assert np.abs(w - expected).max() < 1e-10
        assert np.abs(w + w[::-1]).max() < 1e-12


def test_figure_3_the_slope_rises_with_the_temperature_of_the_environment():
    slopes = [tenth(100, T_e).slope for T_e in TEMPERATURES]
    assert slopes == pytest.approx([15.706e-6, 16.393e-6, 16.871e-6, 17.272e-6], rel=1e-3)


def test_figure_3_shows_loops_that_close_within_their_warming():
    run = simulate(
        "piezo_stack",
        inputs={"V_in": sine(100, 100)},
        duration=0.1,
        times=4001,
        rtol=1e-6,
        method="discrete_gradient",
    )
    last = loops.last_period(run, 100)
    loop = loops.measure(last.V_in.values, last.q.values)
    assert abs(loop.closure) < 3e-3 * float(np.ptp(last.q.values))
    assert float(run.T_body[-1]) == pytest.approx(304.2, abs=0.01)


@pytest.mark.parametrize(("T_e", "shift"), [(T_e, 5 / 298.15) for T_e in TEMPERATURES])
def test_figure_5_the_tip_rests_where_the_temperature_says(stack, T_e, shift):
    run = lines.stepped(stack, T_e, duration=20.0, times=2)
    static = 100 * 10 * T_e / (296.15 * 5e5)
    assert float(run.q[-1]) == pytest.approx(static, rel=1e-6)
    assert lines.static(stack, 100, T_e) == pytest.approx(static, rel=1e-15)
    assert lines.static(stack, 100, T_e + 5) / static - 1 == pytest.approx(shift, rel=0.06)


def test_figure_5_shows_the_offset_within_its_window(stack):
    for T_e in TEMPERATURES:
        run = lines.stepped(stack, T_e)
        static = 100 * 10 * T_e / (296.15 * 5e5)
        warmer = float(run.T_body[-1]) / T_e - 1
        assert warmer == pytest.approx(1.75e-4, abs=1e-5)
        assert float(run.q[-1]) / static - 1 == pytest.approx(warmer, abs=1e-5)


def test_figure_6_loops_are_wider_and_flatter_with_the_frequency(over_frequency):
    widths, slopes = zip(*((loop.width, loop.slope) for loop in over_frequency), strict=True)
    assert widths == pytest.approx([0.226e-3, 1.146e-3, 1.906e-3, 2.384e-3], rel=2e-3)
    assert slopes == pytest.approx([20.13e-6, 18.93e-6, 15.71e-6, 8.45e-6], rel=2e-3)
    assert all(loop.phase > 0 and loop.area > 0 for loop in over_frequency)


@pytest.mark.long
def test_figure_6_does_not_hold_for_settled_loops():
    """The cool steady state steepens from 10 to 50 Hz; the hot ones move against the voltage."""
    slopes = []
    for frequency in FREQUENCIES:
        found = periodic_steady_state(
            "piezo_stack", inputs={"V_in": sine(100, frequency)}, frequency=frequency, rtol=1e-4
        )
        slopes.append(loops.slope(found.orbit.V_in.values, found.orbit.q.values))
    assert slopes == pytest.approx([20.21e-6, 22.73e-6, -74.8e-6, -27.4e-6], rel=2e-3)


def test_figure_6_is_no_combination_of_figures_3_and_4(over_frequency):
    """Heating steepens loops: with the temperature frozen they are flatter still."""
    capacity = 1e9
    frozen = {"parameters": {"c_0": capacity}, "initial": {"S": capacity * np.log1p(2 / 296.15)}}
    slopes = [tenth(f, **frozen).slope for f in FREQUENCIES]
    assert slopes == pytest.approx([20.09e-6, 17.83e-6, 12.50e-6, 5.056e-6], rel=2e-3)
    assert all(cold < loop.slope for cold, loop in zip(slopes, over_frequency, strict=True))


def test_hysteresis_vanishes_with_the_frequency(over_frequency):
    """Width and area go to zero as f: a lag, where ceramics keep a loop however slow."""
    slow = [tenth(f) for f in (1, 3)] + over_frequency[:1]
    widths = np.array([loop.width for loop in slow])
    assert widths[1:] / widths[:-1] == pytest.approx([3.000, 3.721], rel=1e-3)
    areas = np.array([loop.area for loop in slow])
    assert areas[1:] / areas[:-1] == pytest.approx([3.001, 3.557], rel=1e-3)


def test_table_1_couples_nearly_all_energy_and_moves_two_millimetres(stack):
    p = stack.Parameters()
    assert p.a**2 / (p.a**2 + p.k * p.C) == pytest.approx(200 / 205)
    assert 100 * p.a / p.k == pytest.approx(2e-3)


@pytest.mark.some(1)
@pytest.mark.parametrize(("L", "below", "above"), [(1e-4, 71.2, 71.7), (5e-3, 57.3, 57.8)])
def test_figure_4_how_far_the_temperature_rises_depends_on_the_inductance(L, below, above):
    """The cool state is there below the fold of the table, and gone above it."""
    counts = [
        len(
            periodic_steady_states(
                "piezo_stack",
                inputs={"V_in": sine(100, f)},
                frequency=f,
                parameters={"L": L},
                temperatures=(298.15, 900.0),
                rtol=1e-2,
            )
        )
        for f in (below, above)
    ]
    assert counts == [2, 0]
