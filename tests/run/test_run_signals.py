"""Signals: values, corners, one-sided limits, and the refusals of their makers."""

import re
from math import inf, isinf, nan, pi

import numpy as np
import pandas
import pytest
import xarray
from hypothesis import given
from hypothesis import strategies as st

from piezo_sym import chirp, ramp, samples, simulate, sine, square, step, triangle
from piezo_sym.errors import UsageError
from piezo_sym.run.engine.records import InputRecords, pieces_of
from piezo_sym.run.inputs import Inputs, as_signal

numbers = st.floats(-1e6, 1e6)
frequencies = st.floats(1e-3, 1e4)
times = st.floats(0, 10)


@st.composite
def signals(draw):
    a, b, f, g, t = (draw(s) for s in (numbers, numbers, frequencies, frequencies, times))
    width = draw(st.floats(1e-3, 10))
    return draw(
        st.sampled_from(
            [
                sine(a, f, b, t),
                step(t, a, b),
                ramp(t, t + width, a, b),
                triangle(a, f, b),
                chirp(a, f, g, width, b),
                samples([0, width, 2 * width], [a, b, a]),
                as_signal(a, "u"),
            ]
        )
    )


@given(signals(), st.lists(times, min_size=1, max_size=8))
def test_arrays_give_what_scalars_give(signal, ts):
    grid = np.array([ts, ts])
    values = signal(grid)
    assert values.shape == grid.shape
    assert np.array_equal(values[0], [signal(t) for t in ts])


@given(signals(), st.floats(1e-3, 20))
def test_breaks_lie_inside_in_order(signal, duration):
    breaks = signal.breaks(duration)
    assert list(breaks) == sorted(set(breaks))
    assert all(0 < t < duration for t in breaks)
    assert len(breaks) <= 1000
    assert signal.max_step(duration) > 0


@given(st.lists(signals(), min_size=1, max_size=3), st.floats(1e-3, 20))
def test_segments_tile_the_run_without_jumps(sigs, duration):
    segments = Inputs(tuple(sigs), duration).segments
    assert segments[0].start == 0
    assert segments[-1].stop == duration
    assert [s.stop for s in segments[:-1]] == [s.start for s in segments[1:]]
    inner = np.array([[s.start, (s.start + s.stop) / 2, s.stop] for s in segments])
    for segment, ts in zip(segments, inner, strict=True):
        u = segment.over(ts)
        assert np.array_equal(u, np.stack([segment.at(t) for t in ts], axis=1))
        expected = [signal(ts[1]) for signal in sigs]
        assert np.array_equal(u[:, 1], expected)


def test_sine_is_the_formula():
    t = np.linspace(0, 0.1, 77)
    assert sine(100, 100)(t) == pytest.approx(100 * np.sin(2 * pi * 100 * t), abs=1e-12)
    assert sine(1, 50, phase=0.3)(1e4 + 0.005) == pytest.approx(np.sin(0.3 + pi / 2), abs=1e-9)
    assert sine(2, 3, 5, pi / 2)(0.0) == 7
    assert sine(1, 50).max_step(1.0) <= 1 / 50 / 4


def test_a_triangle_of_many_corners_is_no_function_that_c_calls():
    wave = triangle(50, 500, 50)
    assert not InputRecords(Inputs((wave,), 12.0)).calls
    pieces, t = pieces_of(wave, 0.0, 12.0, 12.0), np.linspace(0, 12, 12_345)
    assert np.interp(t, pieces.edges, wave(pieces.edges)) == pytest.approx(wave(t), abs=1e-9)


def test_step_holds_after_at_its_time():
    signal = step(0.5, 1, 2)
    assert [signal(t) for t in (0.0, np.nextafter(0.5, 0), 0.5, 1.0)] == [1, 1, 2, 2]
    assert signal.breaks(1.0) == (0.5,)
    assert signal.breaks(0.5) == ()
    first, second = Inputs((signal,), 1.0).segments
    assert (first.at(0.5)[0], second.at(0.5)[0]) == (1, 2)


def test_ramp_is_straight_between_its_corners():
    signal = ramp(1, 3, 10, 20)
    assert np.array_equal(signal(np.array([0, 1, 1.5, 3, 4])), [10, 10, 12.5, 20, 20])
    assert signal.breaks(5.0) == (1, 3)


def test_triangle_turns_at_its_breaks():
    signal = triangle(2, 5, 1)
    assert signal(0.0) == 1
    assert signal.breaks(0.3) == pytest.approx((0.05, 0.15, 0.25))
    assert signal(np.array([0.05, 0.15, 0.25])) == pytest.approx([3, -1, 3])
    assert signal(0.025) == pytest.approx(2)
    assert signal.breaks(1e9) == ()


@given(numbers, st.floats(0.1, 100), st.integers(0, 50))
def test_triangle_has_its_period(amplitude, frequency, n):
    signal = triangle(amplitude, frequency)
    t = np.linspace(0, 1, 11) / frequency
    bound = 1e-9 * (1 + abs(amplitude))
    assert np.abs(signal(t + n / frequency) - signal(t)).max() < bound
    assert np.abs(signal(t)).max() <= abs(amplitude)


@pytest.mark.parametrize("frequency", [1.0, 3.0, 7.3, 1e3 / 3])
def test_square_jumps_at_its_breaks_and_nowhere_else(frequency):
    signal = square(2, frequency, 1)
    breaks = np.array(signal.breaks(20 / frequency))
    assert breaks == pytest.approx(np.arange(1, 40) / (2 * frequency))
    after = np.where(np.arange(1, 40) % 2, -1.0, 3.0)
    assert signal(0.0) == 3
    assert np.array_equal(signal(breaks), after)
    assert np.array_equal(signal(np.nextafter(breaks, 0)), 2 - after)
    assert np.array_equal(signal(breaks + 0.49 / (2 * frequency)), after)
    segments = Inputs((signal,), 20 / frequency).segments
    assert [segment.at(segment.stop)[0] for segment in segments] == [3, *after]


def test_a_square_wave_is_a_run_through_its_samples():
    """Samples in which each jump's time stands twice are the same run."""
    half, volts = 1e-3, 40.0
    times = np.repeat(half * np.arange(7), 2)[1:-1]
    values = np.tile(np.repeat([volts + 5, 5 - volts], 2), 3)
    wave, knots = (
        simulate("piezo_stack", inputs={"V_in": drive}, duration=6e-3, times=7, rtol=1e-9)
        for drive in (square(volts, 0.5 / half, 5), (times, values))
    )
    assert np.abs(wave.q - knots.q).max() < 1e-9 * np.abs(knots.q).max()
    assert np.array_equal(wave.V_in, knots.V_in)


def test_a_square_wave_that_jumps_too_often_is_refused():
    with pytest.raises(UsageError, match=r"square\.frequency: over 100,000 jumps until 1 s"):
        simulate("piezo_stack", inputs={"V_in": square(1, 1e6)}, duration=1)


def test_chirp_sweeps_then_stays():
    signal = chirp(1, 10, 30, 2.0, 5)
    t = 0.7
    assert signal(t) == pytest.approx(5 + np.sin(2 * pi * (10 * t + 5 * t * t)))
    late = np.array([2.0, 2.4])
    turns = 40 + 30 * (late - 2)
    assert signal(late) == pytest.approx(5 + np.sin(2 * pi * turns), abs=1e-9)
    assert signal.breaks(3.0) == (2.0,)
    assert signal.max_step(3.0) <= 1 / 30 / 4


def test_samples_pass_through_their_knots_and_limit_steps_when_many():
    few = samples([0, 1, 3], [2, 4, 0])
    assert np.array_equal(few(np.array([0, 0.5, 1, 2, 3])), [2, 3, 4, 2, 0])
    assert few.breaks(2.0) == (1.0,)
    assert isinf(few.max_step(3.0))
    t = np.linspace(0, 1, 5001)
    many = samples(t, t)
    assert many.breaks(1.0) == ()
    assert many.max_step(1.0) == pytest.approx(2e-4)
    assert len(many.breaks(0.1)) == 500 - 1


def test_breaks_that_round_to_one_another_are_one():
    close = (step(0.3, 0, 1), step(0.1 + 0.2, 0, 1))
    assert 0.3 != 0.1 + 0.2
    first, second = Inputs(close, 1.0).segments
    assert np.array_equal(first.at(0.3), [0, 0])
    assert np.array_equal(second.at(0.3), [1, 1])


@pytest.mark.parametrize(
    "signal",
    [
        sine(2, 5, phase=0.3),
        step(0.1, 0, 1),
        ramp(0.1, 0.2, 0, 1),
        triangle(1, 5),
        square(1, 5),
        chirp(1, 1, 2, 0.15),
        samples([0, 1], [1, 2]),
    ],
)
def test_lists_of_times_are_taken_as_arrays(signal):
    times = [0, 0.1, 0.25]
    assert signal(times).tolist() == signal(np.array(times)).tolist()
    assert signal(tuple(times)).shape == (3,)


@pytest.mark.parametrize(
    ("make", "where"),
    [
        (lambda: sine(1, 0), "sine.frequency: 0 is not positive"),
        (lambda: sine(1, -2), "sine.frequency: -2 is not positive"),
        (lambda: sine(nan, 2), "sine.amplitude: nan is not a finite number"),
        (lambda: sine(True, 2), "sine.amplitude: 'True' is not a finite number"),
        (lambda: sine("1", 2), "sine.amplitude: '1' is not a finite number"),
        (lambda: sine(1, 2, phase=inf), "sine.phase: inf"),
        (lambda: sine(10**400, 2), "sine.amplitude: "),
        (lambda: step(nan, 0, 1), "step.time: nan"),
        (lambda: step(0, None, 1), "step.before: 'None'"),
        (lambda: ramp(1, 1, 0, 1), "ramp.stop: the ramp stops at 1; expected over 1; use step()"),
        (lambda: triangle(1, inf), "triangle.frequency: inf"),
        (lambda: chirp(1, 1, 2, 0), "chirp.duration: 0 is not positive"),
        (lambda: chirp(1, 0, 2, 1), "chirp.f_start: 0 is not positive"),
        (lambda: samples([0, 1], [1]), "samples: 2 times and 1 values; expected as many"),
        (lambda: samples([0], [1]), "samples: 1 row of a time and a value; expected at least two"),
        (lambda: sine(100, freq=5), "sine: unknown name 'freq'; did you mean 'frequency'?"),
        (lambda: step(1, 2), "step.after: is missing; expected step(time, before, after)"),
        (lambda: sine(1, 2, amplitude=3), "sine: multiple values for argument 'amplitude'; expec"),
        (lambda: square(), "square.amplitude: is missing; expected square(amplitude, frequency)"),
        (
            lambda: samples([0, 1, 1, 1], [1, 2, 3, 4]),
            "at entry 3 follows 1 twice; expected increasing",
        ),
        (lambda: samples([0, 1, 2, 1, 3], [0] * 5), "times: time 1 at entry 3 follows 2"),
        (lambda: sine(1, 2)([0, "x"]), "sine.t[1]: 'x' is not a finite number"),
        (lambda: samples([0, nan], [1, 2]), "samples.times[1]: nan"),
        (lambda: samples(np.array([0, inf]), [1, 2]), "samples.times: entry 1 is inf"),
        (lambda: samples([0, 1], [True, 2]), "samples.values[0]: 'True'"),
        (lambda: samples(np.eye(2), [1, 2]), "samples.times: "),
    ],
)
def test_makers_refuse(make, where):
    with pytest.raises(UsageError) as error:
        make()
    assert where in str(error.value)


def test_a_time_that_stands_twice_is_a_jump():
    """A ramp to 1 V, then 10 V: between any two times as by two signals side by side."""
    signal = samples([0, 1, 1, 2], [0, 1, 10, 10])
    assert signal(np.array([0.5, 1 - 1e-9, 1.0, 1.5])) == pytest.approx([0.5, 1, 10, 10])
    first, second = Inputs((signal,), 2.0).segments
    assert (first.at(first.stop)[0], second.at(second.start)[0]) == (1.0, 10.0)
    assert Inputs((signal,), 2.0).jumps == {0.0, second.start}
    with pytest.raises(UsageError, match="follows"):
        samples([0, 1, 1, 1, 2], [0, 1, 2, 3, 4])
    many = np.linspace(0, 1, 3001)
    times, values = np.insert(many, 1500, many[1500]), np.insert(np.sin(many), 1500, 5.0)
    (jump,) = {t for t in samples(times, values).breaks(1.0)}
    assert jump == many[1500]
    drive = {"V_in": ([0, 0.005, 0.005, 0.01], [0, 0, 10, 10])}
    ours = simulate("piezo_stack", inputs=drive, duration=0.01, rtol=1e-8)
    theirs = simulate("piezo_stack", inputs={"V_in": step(0.005, 0, 10)}, duration=0.01, rtol=1e-8)
    assert np.abs(ours.q - theirs.q).max() < 1e-9 * float(np.abs(theirs.q).max())


@pytest.mark.parametrize("held", [400, 600])
def test_a_command_that_is_held_between_samples_may_jump_often(held):
    """Half of the distances between its times are those of jumps, which take no time."""
    ends = np.arange(held + 1) * 5e-4
    command = samples(np.repeat(ends, 2)[1:-1], np.repeat(np.sin(0.1 * np.arange(held)), 2))
    found = command.max_step(ends[-1])
    assert found == (pytest.approx(5e-4) if held > 500 else np.inf)
    run = simulate(
        "piezo_stack", inputs={"V_in": command}, duration=ends[-1], times=[0.0, ends[-1]]
    )
    assert run.attrs["accepted_steps"] < 20 * held


@pytest.mark.some(6)
@pytest.mark.parametrize("method", [None, "Radau"])
@pytest.mark.parametrize(
    ("drive", "end"),
    [
        (([0, 0.1, 0.3], [0, 1, 0]), 0.0),  # not 3e-16
        (triangle(1.0, 5.0), 0.0),
        (ramp(0.1, 0.3, 1.0, 0.5), 0.5),
        (step(0.3, 1.0, 2.0), 1.0),  # at a jump, as before it
        (([0, 0.1, 0.3, 0.3], [0, 1, 1, 5]), 1.0),
        (lambda t: 1 / (0.3 - t) if t < 0.3 else nan, None),
    ],
)
def test_the_last_sample_of_an_input_is_its_value_there(drive, end, method):
    inputs = {"V_in": drive} if end is not None else {"V_in": lambda t: drive(t - 0.3)}
    run = simulate("piezo_stack", inputs=inputs, duration=0.3, times=4, method=method)
    assert float(run.V_in[-1]) == (end if end is not None else pytest.approx(1 / 0.3))


def test_labelled_samples_are_told_the_pair_to_give():
    t = np.linspace(0.0, 0.01, 5)
    for x, pair in (
        (pandas.Series(t, index=t), "(x.index, x.values)"),
        (xarray.DataArray(t, coords={"time": t}, dims="time"), "(x.time, x.values)"),
    ):
        with pytest.raises(UsageError, match=re.escape(f"; give {pair}")):
            as_signal(x, "inputs.V")
        assert as_signal(eval(pair, {"x": x}), "inputs.V")(0.005) == pytest.approx(0.005)
