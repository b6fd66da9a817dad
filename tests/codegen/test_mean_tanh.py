"""The mean of tanh over a step, in C and in vectors: against 80 digits, and never active."""

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from piezo_sym.codegen.c_means import step_helpers
from piezo_sym.run.engine.texts import VECTORS, texts
from tests.codegen.called import built

ENDS = st.floats(-50, 50) | st.floats(-1e-3, 1e-3) | st.floats(-1e5, 1e5)
GAPS = st.floats(-1e-2, 1e-2) | st.floats(-1e-9, 1e-9) | st.floats(-30, 30) | st.floats(-1e5, 1e5)
CALLS = """
double mean(double a, double b) { return mean_tanh(a, b); }
double by_new(double a, double b) { return mean_tanh_by_new(a, b); }
"""
IN_VECTORS = """
double mean(double a, double b) { return mean_tanh_of(wide(a), wide(b))[1]; }
double by_new(double a, double b) { return mean_tanh_by_new_of(wide(a), wide(b))[1]; }
double plain(double a) { return tanh_of(wide(a))[0]; }
"""
ARITIES = {"mean": 2, "by_new": 2}


@pytest.fixture(scope="module")
def vectors(tmp_path_factory):
    folder = tmp_path_factory.mktemp("vectors")
    return built(folder, {**ARITIES, "plain": 1}, texts(*VECTORS), IN_VECTORS)


@pytest.fixture(scope="module")
def alone(tmp_path_factory):
    texts = ["#include <math.h>", *step_helpers(CALLS), CALLS]
    return built(tmp_path_factory.mktemp("alone"), ARITIES, *texts)


@pytest.fixture(params=["alone", "vectors"], scope="module")
def in_c(request):
    return request.getfixturevalue(request.param)


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
    assert abs(in_c.mean(a, b) - mean) <= 2e-15 * abs(mean) + 1e-300
    assert abs(in_c.by_new(a, b) - slope) <= 1e-9 * abs(slope) + 5e-16 / max(abs(b - a), 1e-3)


@given(ENDS, GAPS)
def test_it_never_feeds_in_work(in_c, a, gap):
    b = a + gap
    assert in_c.mean(a, b) * (a + b) >= 0
    assert abs(in_c.mean(a, b)) <= 1 + 1e-15
    assert in_c.mean(a, b) == in_c.mean(b, a) == -in_c.mean(-a, -b)


@pytest.mark.parametrize("half", [2.0, 2**-10, 2**-27, 0.0])
@pytest.mark.parametrize("middle", [2.0, 3.0, 10.0, 17.0, 19.0, 300.0])
def test_it_goes_on_where_one_formula_follows_another(in_c, middle, half):
    for h in (half * (1 - 1e-9), half, half * (1 + 1e-9)):
        a, b = middle - h, middle + h
        assert abs(in_c.mean(a, b) - exactly(a, b)[0]) <= 2e-15


@given(st.floats(-750, 750) | st.floats(-1e-3, 1e-3) | st.sampled_from([0.0, -0.0, 1e308]))
def test_tanh_in_vectors(vectors, z):
    assert abs(vectors.plain(z) - mpmath.tanh(z)) <= 4e-16 * abs(np.tanh(z)) + 1e-320
    assert np.copysign(1, vectors.plain(z)) == np.copysign(1, z)
