"""Generated C is as fast as C written by hand.  ``pytest -s`` shows the times.

Both are compiled into one library with the flags of the engine, and run in turns.
"""

import ctypes
from pathlib import Path
from time import perf_counter

import numpy as np
import pytest

from piezo_sym.module_cache import load_module
from piezo_sym.run.engine.compiler import FLAGS, build, compilers
from piezo_sym.run.engine.records import ParameterRecords

HERE = Path(__file__).parent
FOLDER = HERE.parents[1] / "generated" / "piezo_stack"
MODULE = load_module(FOLDER / "piezo_stack.py")
SIZES = (2, 64, 1024)
MOST = 1.8  # far above what is measured alone: the suite runs on all cores at once
LANE_CALLS = 4_000_000  # lanes computed in one measurement


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    path = tmp_path_factory.mktemp("built") / "loop.so"
    flags = [*FLAGS[0], f"-I{FOLDER}", f"-I{HERE}"]
    build(next(compilers()), flags, [HERE / "loop.c"], path)
    return ctypes.CDLL(str(path))


def state(lanes):
    """Return a state and inputs of the size that they have in a run, lanes on all branches."""
    draw = np.random.default_rng(lanes)
    x = np.array([1e-3, 5e-3, 5e-4, *[2e-3] * lanes, 0.1]) * draw.uniform(-1, 1, 4 + lanes)
    x[-1] = 0.1
    return x, np.array([10.0, 100.0, 300.0])


def caller(library, name, lanes, calls):
    """Return a call that computes the rates of one state many times, and where they go."""
    x, u = state(lanes)
    out = np.empty_like(x)
    structure = ParameterRecords(MODULE)(MODULE.Parameters(hysteron_count=lanes))
    function = getattr(library, f"loop_{name}")

    def call():
        at = [ctypes.c_void_p(array.ctypes.data) for array in (x, u, out)]
        function(at[0], at[1], ctypes.byref(structure.value), at[2], ctypes.c_long(calls))

    return call, out


def best_times(first, second, repetitions):
    """Return the least times of two calls [s], taken in turns so that both meet the same noise."""
    times = []
    for call in [first, second] * repetitions:
        start = perf_counter()
        call()
        times.append(perf_counter() - start)
    return min(times[::2]), min(times[1::2])


@pytest.mark.parametrize("lanes", [1, 2, 5, 64])
def test_both_compute_the_same(library, lanes):
    results = []
    for name in ("by_hand", "generated"):
        call, out = caller(library, name, lanes, 1)
        call()
        results.append(out)
    np.testing.assert_allclose(*results, rtol=1e-12)


@pytest.mark.long
@pytest.mark.parametrize("lanes", SIZES)
def test_generated_c_is_as_fast_as_c_written_by_hand(library, lanes):
    calls = LANE_CALLS // (lanes + 10)
    first, second = (caller(library, name, lanes, calls)[0] for name in ("by_hand", "generated"))
    best = (np.inf, np.inf)
    for _ in range(6):  # a busy machine blurs the ratio: measured again while it is too large
        best = tuple(map(min, best, best_times(first, second, 8)))
        if best[1] <= MOST * best[0]:
            break
    hand, made = (time / calls * 1e9 for time in best)
    print(f"\nrhs, r = {lanes}: by hand {hand:.1f} ns, generated {made:.1f} ns,", end=" ")
    print(f"ratio {made / hand:.3f}")
    assert made <= MOST * hand
