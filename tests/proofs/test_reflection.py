"""Laws mirrored in their letter have the mirrored value; what is odd by its form cancels."""

import mpmath
import pytest
from hypothesis import assume, given

from piezo_sym.expressions.calculus import neg
from piezo_sym.expressions.parse import parse_law
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tidying import reflected
from tests.proofs.test_branches import VALUES, close, value
from tests.spec.spec_laws import laws, steady


def mirrored(tree):
    try:
        return reflected(tree, "x")
    except ZeroDivisionError:  # a divisor that is zero by its form
        assume(False)


@steady
@given(laws(), VALUES)
def test_the_mirrored_law_has_the_mirrored_value(tree, values):
    wanted = value(tree, {**values, "x": -values["x"]})
    made = mirrored(tree)
    assume(wanted is not None)
    got = value(made, values)
    assume(got is not None)
    assert close(got, wanted)


@steady
@given(laws(), VALUES)
def test_a_law_mirrored_twice_is_itself(tree, values):
    wanted = value(tree, values)
    made = mirrored(mirrored(tree))
    assume(wanted is not None)
    got = value(made, values)
    assume(got is not None)
    assert close(got, wanted)


@steady
@given(laws(), VALUES)
def test_what_cancels_is_odd(tree, values):
    turned = mirrored(tree)
    if mirrored(turned) != neg(turned):
        return
    one, other = (value(tree, {**values, "x": x}) for x in (values["x"], -values["x"]))
    assume(one is not None and other is not None)
    assert abs(one + other) <= mpmath.mpf(10) ** -40 * (1 + abs(one))


ODD = """
x; x**3; x*abs(y); tanh(x/w); x/(1 + x**2); deadzone(x, w)/(y - w); sin(x)*cos(x); -x*exp(-x**2)
tanh(x/-w); sign(-x)*log(1 + abs(x)/w); saturate(2*x, w); x*(y - w); -(-x); x*abs(x) + x**5
"""


@pytest.mark.parametrize("text", [t.strip() for t in ODD.strip().replace("\n", ";").split(";")])
def test_odd_laws_cancel_by_their_form(text):
    tree = parse_law(text, "test")
    turned = mirrored(tree)
    assert mirrored(turned) == neg(turned)


@pytest.mark.parametrize("text", ["x**2", "x + y", "cos(x)", "exp(x)", "x**(1/3)", "max(x, 0)"])
def test_other_laws_do_not(text):
    turned = mirrored(parse_law(text, "test"))
    assert mirrored(turned) != neg(turned)
    assert spell(turned) != text or text in {"x**2", "cos(x)"}
