"""Times: taken in turns, with medians and quartiles, and patience for slow calls."""

import time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from piezo_sym.bench.contest import Contestant, Pair, compared, interleaved, ratio, spread

TIMES = st.lists(st.floats(1e-9, 1e3), min_size=1, max_size=30)


@given(TIMES)
def test_quartiles_lie_around_the_median(values):
    found = spread(values)
    assert min(values) <= found.low <= found.median <= found.high <= max(values)
    assert sum(value <= found.median for value in values) >= len(values) / 2
    assert sum(value >= found.median for value in values) >= len(values) / 2


@given(TIMES, st.floats(0.01, 100))
def test_a_ratio_is_taken_round_by_round(values, factor):
    found = ratio(tuple(factor * value for value in values), tuple(values))
    assert found.low == pytest.approx(factor)
    assert found.high == pytest.approx(factor)


@pytest.fixture
def clock(monkeypatch):
    """A clock that goes on only when it is told to: a busy machine changes nothing."""
    now = [0.0]
    monkeypatch.setattr("piezo_sym.bench.contest.perf_counter", lambda: now[0])

    def going(seconds, seen=None):
        def call():
            now[0] += seconds
            if seen is not None:
                seen.append(seconds)

        return call

    return going


def test_calls_are_measured_in_turns(clock):
    seen = []
    times = interleaved([clock(seconds, seen) for seconds in (0.1, 0.2, 0.3)], 3)
    assert seen == [0.1, 0.2, 0.3] * 4  # a first call of each finds out how long it takes
    assert [*times] == [pytest.approx([s] * 3) for s in (0.1, 0.2, 0.3)]


def test_a_short_call_is_repeated_within_a_measurement(clock):
    seen = []
    (times,) = interleaved([clock(1e-5, seen)], 2)
    assert len(seen) == pytest.approx(2 + 2 * (1 + 2000), abs=4)  # one of each is not measured
    assert times == pytest.approx([1e-5, 1e-5])


def test_a_slow_call_is_not_measured_again(clock):
    seen = []
    slow, fast = interleaved([clock(3.0, seen), clock(0.1)], 4, patience=5.0)
    assert len(seen) == len(slow) == 1
    assert len(fast) == 4


def test_a_call_is_measured_while_there_is_patience(clock):
    (times,) = interleaved([clock(1.0)], 9, patience=5.0)
    assert len(times) == 5


def test_the_clock_is_a_real_one():
    (times,) = interleaved([lambda: time.sleep(0.01)], 1)
    assert times[0] >= 0.01


def test_a_ratio_above_one_says_that_ours_is_faster(clock):
    slow = Contestant("slow", clock(0.02), error=1e-3, note="first")
    fast = Contestant("fast", clock(0.005), error=1e-6, note="second")
    halved = Contestant("two at once", clock(0.02), per=2)
    rows = compared("group", [Pair(slow, fast), Pair(slow, halved), Pair(None, fast)], 3, "measure")
    first, second, third = rows
    assert first.ratio.median == pytest.approx(4)
    assert second.ratio.median == pytest.approx(2)
    assert (first.other_error, first.ours_error) == (1e-3, 1e-6)
    assert first.note == "its first; our second"
    assert third.ratio is None
    assert third.other_time is None
    assert third.ours_time == first.ours_time
