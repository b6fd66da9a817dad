"""The mean of tanh over a step, in C: against 50 digits, and passive at every pair of ends."""

import ctypes

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from piezo_sym.codegen.c_means import step_helpers
from piezo_sym.run.engine.compiler import build, compilers

ENDS = st.floats(-50, 50) | st.floats(-1e-3, 1e-3) | st.floats(-1e5, 1e5)
GAPS = st.floats(-1e-2, 1e-2) | st.floats(-1e-9, 1e-9) | st.floats(-30, 30) | st.floats(-1e5, 1e5)
CALLS = """
double mean(double a, double b) { return mean_tanh(a, b); }
double by_new(double a, double b) { return mean_tanh_by_new(a, b); }
"""


@pytest.fixture(scope="module")
def in_c(tmp_path_factory):
    folder = tmp_path_factory.mktemp("tanh")
    text = "\n".join(["#include <math.h>", *step_helpers(CALLS), CALLS])
    (folder / "tanh.c").write_text(text)
    build(next(compilers()), ("-shared", "-fPIC"), folder / "tanh.c", folder / "tanh.so")
    library = ctypes.CDLL(str(folder / "tanh.so"))
    for function in (library.mean, library.by_new):
        function.restype, function.argtypes = ctypes.c_double, [ctypes.c_double] * 2
    return library


def exactly(a, b):
    """Return the mean and its derivative by b, to many digits."""
    with mpmath.workdps(80):
        a, b = mpmath.mpf(a), mpmath.mpf(b)
        if abs(b - a) < 1e-9:  # there the difference of integrals would keep too few digits
            t, half = mpmath.tanh((a + b) / 2), (b - a) / 2
            return t * (1 - (1 - t**2) * half**2 / 3), (1 - t**2) / 2 * (1 - 2 * t * half / 3)
        mean = mpmath.log(mpmath.cosh(b) / mpmath.cosh(a)) / (b - a)
        return mean, (mpmath.tanh(b) - mean) / (b - a)


@given(ENDS, GAPS)
def test_it_is_the_mean_and_that_changes_as_it_says(in_c, a, gap):
    b = a + gap
    mean, slope = exactly(a, b)
    assert abs(in_c.mean(a, b) - mean) <= 8e-16 * abs(mean) + 1e-300
    assert abs(in_c.by_new(a, b) - slope) <= 1e-9 * abs(slope) + 5e-16 / max(abs(b - a), 1e-3)


@given(ENDS, GAPS)
def test_it_never_feeds_in_work(in_c, a, gap):
    b = a + gap
    assert in_c.mean(a, b) * (a + b) >= 0
    assert abs(in_c.mean(a, b)) <= 1 + 1e-15
    assert in_c.mean(a, b) == in_c.mean(b, a) == -in_c.mean(-a, -b)


def test_it_goes_on_where_one_formula_follows_another(in_c):
    for middle in (2.0, 3.0, 10.0, 17.0, 19.0, 300.0):
        for half in (2.0, 2**-10, 0.0):
            near = [in_c.mean(middle - h, middle + h) for h in half + np.linspace(-1e-6, 1e-6, 5)]
            assert np.ptp(near) <= 4e-6
