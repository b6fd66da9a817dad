"""Springs with kinks: energies against quadrature, and bad ones, which are not proved."""

from itertools import pairwise

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from piezo_sym import PiezoError, derive, verify
from piezo_sym.proofs import Verdict, decide
from piezo_sym.spec.load import parse

from .kinked import BAD_ENERGIES, BAD_LAWS, GOOD, TEXT, VALUES, WORDS

#: On both sides of all kinks.
POINTS = (-2.1, -0.9, -0.4, -0.05, 0.1, 0.6, 1.0, 1.7)
#: Of which a row stays open: the derivative of the printed energy at the kink, a 0/0 of its form.
OPEN = {"F_0*abs((q - s)/r)**n*sign(q - s)": {"program"}}
KINKS = (-0.7, -0.1, 0.0, 0.2, 0.7)


def by_hand(law):
    code = compile(law, "law", "eval")
    return lambda q: eval(code, {**WORDS, "q": q})


def energy_of(iphs):
    values = {**VALUES, "p": 0.0}
    known = {s: values[s.name] for s in iphs.U.free_symbols if s.name != "q"}
    return sp.lambdify("q", iphs.U.subs(known), "math")


def worst(iphs, law):
    """Return how far differences of the energy are from quadrature of the law, at most."""
    U, F = energy_of(iphs), by_hand(law)
    apart = [
        U(b) - U(a) - quad(F, a, b, points=[x for x in KINKS if a < x < b] or None)[0]
        for a, b in pairwise(POINTS)
    ]
    return float(np.abs(apart).max())


def unproved(rows):
    return {row.id for row in rows if row.required and row.verdict is not Verdict.PROVED}


@pytest.mark.some(1)
@pytest.mark.parametrize("law", GOOD)
def test_it_is_proved_and_has_the_energy_of_quadrature(law):
    iphs = derive(parse(TEXT.replace("LAW", law)))
    assert unproved(verify(iphs).rows) <= {"program"} & OPEN.get(law, set())
    assert worst(iphs, law) < 1e-8


BAD = [*(("energy", text) for text in BAD_ENERGIES), *(("force", text) for text in BAD_LAWS)]


@pytest.mark.some(1)
@pytest.mark.parametrize(
    ("field", "law"),
    [pytest.param(*bad, marks=pytest.mark.long if n % 4 else ()) for n, bad in enumerate(BAD)],
)
def test_what_jumps_or_lacks_a_value_is_not_proved(field, law):
    text = TEXT.replace('force = "LAW"', f'{field} = "{law}"')
    assert unproved(decide(derive(parse(text))).rows) & {"energy", "continuous", "welldef"}


PLACES = st.sampled_from(["q", "(q - s)", "(q - s_2)", "(q + r)", "(q - r)"])
SHAPES = st.sampled_from(
    [
        "k*Z",
        "k*Z*abs(Z)/r",
        "k*Z/(1 + abs(Z)/r)",
        "k*max(Z, 0)/(1 + max(Z, 0)/r)",
        "F_0*abs(Z/r)**n*sign(Z)",
        "F_0*sign(Z)*abs(Z/r)**(3/2)",
        "k*Z*exp(-abs(Z)/r)",
        "k*min(Z, 0)",
        "k*r*tanh(Z/r)",
        "F_0/(1 + abs(Z)/r)",
        "F_0*sign(Z)",
        "k*Z/(1 - Z/r)",
    ]
)
TERM = st.builds(lambda shape, place: shape.replace("Z", place), SHAPES, PLACES)
SUM = st.builds("{} + {}".format, TERM, TERM)
CHOICE = st.builds(lambda a, b, z: f"{a} if {z} > 0 else {b}", TERM, TERM, PLACES)


@pytest.mark.long
@settings(max_examples=8, deadline=None, derandomize=True)
@given(st.one_of(TERM, SUM, CHOICE))
def test_no_law_is_proved_of_which_quadrature_says_otherwise(law):
    """Laws that jump have to be seen at their kinks; poles are where a divisor of them is zero."""
    try:
        iphs = derive(parse(TEXT.replace("LAW", law)))
    except PiezoError:
        return
    rows = decide(iphs).rows
    assert not any(row.verdict is Verdict.REFUTED for row in rows if row.id == "energy")
    if not unproved(rows):
        F = by_hand(law)
        assert max(abs(F(x + 1e-9) - F(x - 1e-9)) for x in KINKS) < 1e-4
        assert worst(iphs, law) < 1e-7


def test_an_energy_that_was_found_and_is_none_refutes_no_law():
    """Where q > r the logarithm of SymPy's integral has no value."""
    text = TEXT.replace("LAW", "k*r*r/(q - r)").replace('"n > 0"]', '"n > 0", "(q - r)**2 > 0"]')
    rows = decide(derive(parse(text))).rows
    (row,) = (row for row in rows if (row.id, row.element) == ("welldef", "spring"))
    assert row.verdict is Verdict.OPEN
    assert "add '-q + r > 0' to [domain], or give" in row.why
