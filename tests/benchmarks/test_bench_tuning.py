"""The tolerance that just reaches a target: no lucky hit, no endless search."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.benchmarks.tuning import LADDER, PARTS, Tuned, tuned


def error(x):
    return x


FINE = sorted((part * t for t in LADDER for part in (1, *PARTS)), reverse=True)


@given(st.floats(1e-3, 1e3), st.floats(1e-9, 1e-3))
def test_the_loosest_good_tolerance_is_found(factor, target):
    found = tuned(lambda tolerance: factor * tolerance, error, target, patience=10)
    good = next(t for t in FINE if factor * t <= target and t <= LADDER[0])
    assert found == Tuned(good, factor * good)


def test_a_lucky_decade_does_not_count():
    lucky = {LADDER[2]: 0.0}
    found = tuned(lambda t: lucky.get(t, 10 * t), error, 1e-6, patience=10)
    assert found.tolerance == next(t for t in LADDER if 10 * t <= 1e-6)


def test_a_lucky_half_does_not_count():
    """A fifth of the decade is too loose, so its half is not even looked at."""
    found = tuned(lambda t: 0.0 if t in (1e-7, 5e-7) else 10 * t, error, 1e-6, patience=10)
    assert found.tolerance == 1e-7


def test_a_solver_that_never_gets_there_is_left_out():
    assert (
        tuned(lambda _: 1e-4, error, 1e-6, 10) == "reaches an error of 1.0e-04 at best, not 1e-06"
    )


@pytest.mark.parametrize("fault", [RuntimeError, ArithmeticError, ValueError])
def test_a_tolerance_at_which_a_solver_fails_is_passed_over(fault):
    def solve(tolerance):
        if tolerance > 1e-5:
            raise fault
        return tolerance

    assert tuned(solve, error, 1.0, 10) == Tuned(1e-5, 1e-5)


def test_no_more_is_tried_once_patience_is_spent():
    now = [0.0]

    def solve(tolerance):
        now[0] += 2.0
        return tolerance

    found = tuned(solve, error, 1e-9, 5.0, clock=lambda: now[0])
    assert found == "reaches an error of 1.0e-04 at best, not 1e-09"
