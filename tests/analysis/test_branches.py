"""Branches of steady states over the frequency: their folds and jumps, against single states."""

import doctest
import itertools

import numpy as np
import pytest

from piezo_sym import periodic_steady_state, periodic_steady_states, sine, steady_branches
from piezo_sym.errors import UsageError

SPAN = (298.15, 6000.0)


def drive(frequency):
    return {"V_in": sine(100, frequency)}


@pytest.fixture(scope="module")
def found():
    return steady_branches("piezo_stack", inputs=drive, frequencies=(60.0, 75.0), temperatures=SPAN)


def states(frequency):
    return periodic_steady_states(
        "piezo_stack", inputs=drive(frequency), frequency=frequency, temperatures=SPAN, rtol=1e-3
    )


@pytest.mark.long
def test_there_is_one_jump_and_it_goes_up(found):
    (jump,) = found.jumps
    assert jump.upward
    assert jump.frequency == pytest.approx(67.29, abs=0.02)
    assert jump.temperature == pytest.approx(541.9, abs=2)
    assert jump.lands == pytest.approx(3698, rel=0.01)


@pytest.mark.long
def test_steady_states_come_and_go_at_the_jump(found):
    """Three below the fold, one above; independent searches, half a per cent to either side."""
    f = found.jumps[0].frequency
    assert [state.stable for state in states(f * 0.995)] == [True, False, True]
    assert [state.stable for state in states(f * 1.005)] == [True]


@pytest.mark.long
@pytest.mark.parametrize("part", [0.5, 1.0])
@pytest.mark.parametrize("number", [0, 1])
def test_points_are_steady_states(found, number, part):
    curve = found.curves[number]
    point = curve[int(part * (len(curve) - 1))]
    f = point.frequency
    near = point.state.temperature
    (alone,) = periodic_steady_states(
        "piezo_stack",
        inputs=drive(f),
        frequency=f,
        temperatures=(near * 0.99, near * 1.01),
        rtol=1e-4,
    )
    rise = alone.temperature - 298.15
    assert point.state.period.mean - 298.15 == pytest.approx(rise, rel=1e-3)
    assert point.stable == alone.stable


def test_curves_reach_the_ends_of_the_range(found):
    ends = sorted(round(curve[n].frequency, 6) for curve in found.curves for n in (0, -1))
    assert ends == [60.0, 60.0, 60.0, 75.0]
    for curve in found.curves:
        steps = [np.abs(b.place - a.place).max() for a, b in itertools.pairwise(curve)]
        assert max(steps) < 0.31


def test_the_cool_branch_warms_with_the_frequency_up_to_its_end(found):
    cool = [p for p in found.curves[0] if p.stable]
    rise = np.diff([p.state.period.mean for p in cool])
    assert np.all(rise > 0)
    assert np.all(np.diff([p.frequency for p in cool]) > 0)


def test_the_hot_branch_cools_with_the_frequency(found):
    hot = sorted(found.curves[1], key=lambda p: p.frequency)
    assert all(p.stable for p in hot)
    assert np.all(np.diff([p.state.period.mean for p in hot]) < 0)


def test_the_table_has_a_row_a_point(found):
    table = found.table()
    sizes = {len(column) for column in table.values()}
    assert sizes == {sum(len(curve) for curve in found.curves)}
    (fold,) = np.flatnonzero(~np.isnan(table["jumps_to"]))
    assert (
        table["frequency"][fold]
        == found.jumps[0].frequency
        == max(table["frequency"][table["curve"] == 0])
    )
    assert np.all(table["coldest"] <= table["temperature"])
    assert np.all(table["temperature"] <= table["hottest"])


def test_branches_are_short_to_read(found):
    points = len(found.table()["curve"])
    jump = f"{found.jumps[0].frequency:.6g} Hz"
    assert repr(found) == f"Branches(curves: 2, points: {points}, jumps: {jump})"


@pytest.mark.some(1)
@pytest.mark.parametrize("documented", [steady_branches, periodic_steady_state])
def test_the_example_of_the_help_gives_what_it_says(documented):
    (example,) = doctest.DocTestFinder(recurse=False).find(documented, "help", globs={})
    assert doctest.DocTestRunner().run(example) == (0, len(example.examples))
    assert len(example.examples) > 1


@pytest.mark.long
def test_a_drive_without_jumps_has_none():
    """A tenth of the voltage: heat a hundredth, and no fold within reach."""
    found = steady_branches(
        "piezo_stack",
        inputs=lambda f: {"V_in": sine(10, f)},
        frequencies=(20.0, 60.0),
        temperatures=(298.15, 400.0),
    )
    assert found.jumps == ()
    (curve,) = found.curves
    assert all(point.stable for point in curve)
    alone = periodic_steady_state("piezo_stack", inputs={"V_in": sine(10, 60)}, frequency=60)
    assert curve[-1].state.period.mean == pytest.approx(alone.temperature, abs=1e-3)


@pytest.mark.parametrize("own", [50, 10, 200, 6.25])
def test_inputs_that_do_not_follow_the_frequency_are_refused(own):
    with pytest.raises(UsageError, match=r"^steady_branches\.inputs\.V_in: .* follow the freq"):
        steady_branches(
            "piezo_stack", inputs=lambda _: {"V_in": sine(100, own)}, frequencies=(10, 200)
        )


def test_inputs_that_repeat_at_both_ends_alone_are_refused():
    with pytest.raises(UsageError, match=r"V_in: 'V_in' does not repeat after"):
        steady_branches(
            "piezo_stack", inputs=lambda _: {"V_in": sine(100, 100)}, frequencies=(50, 100)
        )


RANGE = "expected two numbers above 0 in {}, the least and the greatest"
WRONG = [
    ({"frequencies": (100.0, 50.0)}, "'(100.0, 50.0)' is no range"),
    ({"frequencies": (50.0, 50.0)}, RANGE.format("Hz")),
    ({"frequencies": (0.0, 50.0)}, RANGE.format("Hz")),
    ({"frequencies": 50}, "steady_branches.frequencies: 50 is no range"),
    ({"frequencies": (50, "x")}, "steady_branches.frequencies[1]: 'x' is not a finite number"),
    ({"temperatures": 300}, "temperatures: 300 is no range; " + RANGE.format("K")),
    ({"temperatures": (300, 300)}, "temperatures: '(300, 300)' is no range"),
    ({"inputs": {"V_in": 1.0}}, "steady_branches.inputs: '{'V_in': 1.0}' is no function; expected"),
    ({"inputs": None}, "steady_branches.inputs: 'None' is no function"),
    ({"inputs": lambda f: f}, "is not a mapping"),
]


@pytest.mark.parametrize(("changed", "said"), WRONG)
def test_a_wrong_argument_is_one_line(changed, said):
    with pytest.raises(UsageError) as error:
        steady_branches("piezo_stack", **{"inputs": drive, "frequencies": (45.0, 50.0), **changed})
    assert said in str(error.value)
    assert str(error.value).isprintable()
