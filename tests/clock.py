"""Processor time as a test may judge it: beside a loop of the same moment, not in seconds alone."""

import time
from contextlib import contextmanager

QUIET = 0.006  # seconds of processor time that the loop takes where the limits of tests were set


def seconds(call, *args):
    """Return the processor time of a call."""
    start = time.process_time()
    call(*args)
    return time.process_time() - start


def slowness():
    """Return how many times longer than there a loop takes now."""
    return max(1.0, min(seconds(_loop) for _ in range(3)) / QUIET)


def _loop():
    names = {}
    for n in range(30_000):
        names[str(n)] = n


@contextmanager
def within(limit):
    """Fail where the body takes more than `limit` seconds of processor time of a quiet machine."""
    start = time.process_time()
    yield
    took = time.process_time() - start
    assert took < limit or took < limit * slowness()
