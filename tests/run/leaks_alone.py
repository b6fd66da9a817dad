"""Runs keep no memory: fifty thousand calls in C, and hundreds of whole runs, leave none.

Memory is what the operating system counts; sixteen bytes a call would be seen.
"""

import ctypes
import gc
import math
import os
import sys
from pathlib import Path
from resource import RUSAGE_SELF, getrusage

import numpy as np
import pytest

from piezo_sym import simulate, sine
from piezo_sym.modules import module_of
from piezo_sym.run.engine.batch import Batch, Stepping
from piezo_sym.run.engine.engine import engine_of
from piezo_sym.run.inputs import read_inputs
from piezo_sym.run.stepper import Stepper

CALLS, ROUNDS = 50_000, 3
#: What a round may take for good [bytes]: less than 4 a call of a run in C.
MOST = 200_000
STATM = Path("/proc/self/statm")
U = (0.0, 50.0, 298.15)


def memory():
    """Return the memory in use [bytes]; where only its peak is known, that."""
    gc.collect()
    if STATM.exists():
        return int(STATM.read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")
    return getrusage(RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)


def grown(call, times):
    """Return by how much memory grows when something is done so many times: the least of rounds.

    A heap grows in steps until it has found its size; what leaks, leaks in every round: after one
    that took less than `MOST` for good there is nothing to look for.
    """
    least = math.inf
    for _ in range(ROUNDS):
        before = memory()
        for _ in range(times):
            call()
        least = min(least, memory() - before)
        if least < MOST:
            break
    return least


def test_a_leak_of_sixteen_bytes_is_seen():
    allocate = ctypes.CDLL(None).malloc
    allocate.restype, allocate.argtypes = ctypes.c_void_p, (ctypes.c_size_t,)
    kept = []
    assert grown(lambda: kept.append(allocate(16)), CALLS) > 2 * MOST


@pytest.mark.parametrize("fixed", [0.0, 1e-6], ids=["tolerance", "fixed"])
@pytest.mark.parametrize("layout", ["one", "many", "lanes"])
def test_steps_of_runs(layout, fixed):
    """A batch that is done is asked to go on: it looks at its lanes; and one that is on its way."""
    module = module_of("piezo_stack")
    inputs = read_inputs(module, {"V_in": sine(100, 100)}, 1e4)
    p = module.Parameters()
    x = module.initial_state(inputs.segments[0].at(0.0), p)[None]
    how = Stepping(3, 1e-3, 1e-6, 1e-3, fixed=fixed)
    batch = Batch(engine_of(module), [p], x, inputs, np.array([1e4]), how, layout)
    assert batch.go(1)
    assert grown(lambda: batch.go(1), CALLS) < MOST


def test_steps():
    actuator = Stepper(module_of("piezo_stack"), step=1e-6)
    assert grown(lambda: actuator.step(U), CALLS) < MOST


def test_steppers():
    """Each has parameters of its own, so that nothing that is remembered can be taken."""
    values = iter(range(10**6))

    def made():
        step = 1e-6 * (1 + next(values) * 1e-6)
        parameters = {"L": [1e-3, 2e-3 * (1 + step)], "hysteron_count": 2}
        Stepper(module_of("piezo_stack"), step=step, parameters=parameters).step(U)

    for _ in range(300):  # until what is remembered, of so many at most, has its size
        made()
    assert grown(made, 1000) < MOST


def test_whole_runs():
    def run():
        options = {"method": "discrete_gradient", "duration": 1e-4, "times": 5}
        simulate("piezo_stack", inputs={"V_in": sine(100, 100)}, rtol=1e-5, **options)

    assert grown(run, 100) < MOST
