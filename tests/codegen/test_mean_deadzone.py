"""The mean of a dead zone over a step, in C and in vectors: against exact fractions."""

from fractions import Fraction

import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st

from piezo_sym.codegen.c_means import step_helpers
from piezo_sym.run.engine.texts import VECTORS, texts
from tests.codegen.called import built

WIDTHS = st.floats(1e-3, 10) | st.just(0.0) | st.floats(0, 1e-9, allow_subnormal=False)
#: Ends in halves of the width, and off them, so that many steps begin or end at a kink.
PLACES = st.sampled_from([-3.0, -2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0, 3.0])
OFFSETS = (
    st.floats(-1, 1, allow_subnormal=False)
    | st.floats(-1e-9, 1e-9, allow_subnormal=False)
    | st.floats(-1e5, 1e5, allow_subnormal=False)
    | st.just(0.0)
)
ARITIES = {"mean": 3, "by_new": 3, "by_width": 3}
FORMS = ("mean_deadzone", "mean_deadzone_by_new", "mean_deadzone_by_width")
ALONE, BESIDE = "{form}(a, b, w)", "{form}_of(wide(a), wide(b), wide(w))[1]"


def calls(text):
    lines = zip(ARITIES, FORMS, strict=True)
    head = "double {name}(double a, double b, double w) {{ return {call}; }}"
    return "\n".join(head.format(name=name, call=text.format(form=form)) for name, form in lines)


@pytest.fixture(params=["alone", "vectors"], scope="module")
def in_c(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp("deadzone")
    if request.param == "vectors":
        return built(folder, ARITIES, texts(*VECTORS), calls(BESIDE))
    text = calls(ALONE)
    return built(folder, ARITIES, "#include <math.h>", *step_helpers(text), text)


def beyond(z, w):
    return z - w if z > w else z + w if z < -w else Fraction(0)


def exactly(a, b, w):
    """Return the mean, and its derivatives by b and by w."""
    a, b, w = map(Fraction, (a, b, w))
    from_, to = beyond(a, w), beyond(b, w)
    if a == b:
        return from_, Fraction(1, 2) if from_ else Fraction(0), -(a > w) + (a < -w)
    low, top = min(a, b), max(a, b)
    above = max(top - max(low, w), 0) / (top - low)
    below = max(min(top, -w) - low, 0) / (top - low)
    mean = (to**2 - from_**2) / 2 / (b - a)
    return mean, (to - mean) / (b - a), below - above


@given(WIDTHS, PLACES, OFFSETS, PLACES, OFFSETS)
def test_it_is_the_mean_and_that_changes_as_it_says(in_c, w, place, offset, other, further):
    a, b = w * place + offset, w * other + further
    ends = abs(beyond(Fraction(a), Fraction(w))), abs(beyond(Fraction(b), Fraction(w)))
    assume(not 0 < ends[0] * ends[1] < 1e-300)  # below what numbers can tell from zero
    assume(a == b or abs(b - a) > 1e-300)
    mean, by_new, by_width = exactly(a, b, w)
    size = sum(ends)
    assert abs(in_c.mean(a, b, w) - mean) <= 1e-15 * size + 1e-150
    assert abs(in_c.by_new(a, b, w) - by_new) <= 1e-14
    assert abs(in_c.by_width(a, b, w) - by_width) <= 1e-14


@example(1.0, 0.0, 0.0, 0.0, 1e-310)
@example(0.0, 0.0, 1e-310, 0.0, 2e-310)
@example(0.0, 0.0, -1e-310, 0.0, 1e-310)
@given(WIDTHS, PLACES, OFFSETS, PLACES, OFFSETS)
def test_it_never_feeds_in_work(in_c, w, place, offset, other, further):
    a, b = w * place + offset, w * other + further
    mean = in_c.mean(a, b, w)
    assert abs(mean) <= max(abs(a), abs(b))
    assert mean * (a + b) >= 0
    assert mean == in_c.mean(b, a, w) == -in_c.mean(-a, -b, w)
