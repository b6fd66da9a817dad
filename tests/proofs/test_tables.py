"""Tables in proofs: the order of knots is proved or refuted, and numbers deny no verdict."""

from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from piezo_sym import derive
from piezo_sym.errors import SpecError
from piezo_sym.proofs import Verdict, decide
from piezo_sym.report import Row
from piezo_sym.spec.load import parse
from tests.clock import within
from tests.networks import law_values

SPEC = """
[model]
name = "tabled"
[parameters]
m = {{ value = 1.0, unit = "kg" }}
a = {{ value = {a}, unit = "m/s" }}
b = {{ value = {b}, unit = "m/s" }}
F = {{ value = {F}, unit = "N" }}
G = {{ value = {G}, unit = "N" }}
T_0 = {{ value = 300.0, unit = "K" }}
c = {{ value = 2.0, unit = "J/K" }}
[domain]
assume = [{assume}]
[elements]
mass = {{ kind = "mass", at = "tip", mass = "m", state = "p" }}
body = {{ kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }}
damper = {{ kind = "damper", between = ["tip", "wall"], force = "{law}", heats = "body" }}
"""
OWN = {"a": 1.0, "b": 2.0, "F": 1.0, "G": 2.0}
MONOTONE = "table(v, -a, -F, 0, 0, a, F, b, G)"
DOMAIN = ("a > 0", "b > a", "F >= 0", "G >= F")


def spec(law, domain=DOMAIN, **values):
    assume = ", ".join(f'"{text}"' for text in domain)
    return SPEC.format(law=law, assume=assume, **(OWN | values))


def rows(law, domain=DOMAIN, **values):
    found = decide(derive(parse(spec(law, domain, **values)))).rows
    return {row.id: row for row in found if row.element in {"damper", ""}}


@pytest.mark.parametrize("law", [MONOTONE, "table(v, a - 1.5*a, -F, 0, 0, b, G)"])
def test_a_monotone_table_through_the_origin_is_proved(law):
    found = rows(law)
    for name in ("welldef", "continuous", "passive", "sigma", "units"):
        assert found[name].verdict is Verdict.PROVED, found[name].reason


@pytest.mark.some(2)
@pytest.mark.parametrize(
    ("law", "without", "more"),
    [
        (MONOTONE, "b > a", ()),
        (MONOTONE, "b > a", ("b >= a",)),
        (MONOTONE, "a > 0", ("a >= 0",)),
        ("table(v, a**2/b, 0, a, F, b, G)", "b > a", ("b > 0",)),
        ("F*table(v/a, 0, 0, b/a, 1)", "a > 0", ()),
        ("table(v, 0, 0, a, F) if a > b else table(v, 0, 0, a*b/b - a/2, F)", "a > 0", ()),
    ],
)
def test_an_order_that_the_domain_leaves_open_is_not_proved(law, without, more):
    found = rows(law, (*(text for text in DOMAIN if text != without), *more))
    assert found["welldef"].verdict is not Verdict.PROVED
    assert all(found[name].verdict is not Verdict.PROVED for name in ("passive", "sigma"))


def test_a_refuted_order_has_a_witness_in_the_domain():
    row = rows(MONOTONE, ("a > 0", "b >= a", "F >= 0"))["welldef"]
    at = {name: Fraction(value) for name, value in row.witness.items()}
    assert row.verdict is Verdict.REFUTED
    assert at["a"] == at["b"] > 0
    assert row.reason.startswith("a < b in a table is false: ")


@pytest.mark.parametrize("law", ["table(v, -a, -F, 0, 0, a, F, b, -G)", "table(v, 0, F, a, G)"])
def test_a_table_that_is_not_passive_has_a_witness(law):
    row = rows(law)["passive"]
    at = {"a": 1, "b": 2, "F": 1, "G": 2}
    at |= {name: float(Fraction(value)) for name, value in row.witness.items()}
    assert row.verdict is Verdict.REFUTED
    assert law_values.value(law, at) * at["v"] < 0


@pytest.mark.parametrize(
    ("law", "values"),
    [
        (MONOTONE, {"a": 3.0}),
        ("table(v, a, F, a, G)", {}),
        ("F*table(v/a, 2, 1, 1, 1)", {}),
        ("table(v, a, F, a + 0*b, G)", {}),
        ("table(table(v, 0, a, a, b), 0, 0, a - b, F)", {}),
    ],
)
def test_own_values_out_of_order_are_refused(law, values):
    with pytest.raises(SpecError, match=r"damper.force: the knots of a table do not increase.*<"):
        parse(spec(law, ("b > 0",), **values))


@pytest.mark.parametrize("law", ["table(v, 0, 0, v + a, F)", "F*table(v/a, 0, 0, T/T_0, 1)"])
def test_knots_are_of_parameters(law):
    with pytest.raises(SpecError, match=r"knot of a table in elements\.damper\.force"):
        parse(spec(law))


BANK = (
    SPEC[: SPEC.index("mass = {{")].replace("m/s", "A").replace('"N"', '"V"')
    + """
body = {{ kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }}
source = {{ kind = "voltage_source", between = ["in", "gnd"], input = "u" }}
[elements.bank]
kind = "hysteron"
between = ["in", "gnd"]
count = 3
inductance = "m"
voltage = "{law}"
heats = "body"
[inputs]
u = {{ unit = "V" }}
"""
)
LANES = {"law": "table(i, -a, -F, 0, 0, a, F, b, G)", **OWN, "b": [2.0, 3.0, 1.5]}


def of_lanes(*domain, **values):
    text = BANK.format(**(LANES | values), assume=", ".join(f'"{text}"' for text in domain))
    return parse(text.replace('1.0, unit = "kg"', '1.0, unit = "H"'))


def test_knots_of_lanes_are_those_of_each_lane():
    for domain, verdict in ((DOMAIN, Verdict.PROVED), (("a > 0", "b > 0"), Verdict.REFUTED)):
        found = {r.id: r for r in decide(derive(of_lanes(*domain))).rows if r.element == "bank"}
        assert found["welldef"].verdict is verdict
        assert (found["passive"].verdict is Verdict.PROVED) == (verdict is Verdict.PROVED)


def test_one_lane_out_of_order_is_refused():
    with pytest.raises(SpecError, match=r"do not increase: a = 1, b = 0.5; .* in lane 3"):
        of_lanes("a > 0", b=[2.0, 3.0, 0.5])


def test_a_symmetric_table_is_odd_by_its_form():
    assert rows("table(v, -b, -G, -a, -F, 0, 0, a, F, b, G)")["odd"].verdict is Verdict.PROVED
    assert rows(MONOTONE)["odd"].verdict is Verdict.REFUTED


def test_64_knots_are_decided_in_seconds():
    knots = ", ".join(f"{k / 8}, {(k / 8) ** 3}" for k in range(-32, 32))
    with within(10):
        found = rows(f"F*table(v/a, {knots})")
    for name in ("welldef", "continuous", "passive"):
        assert found[name].verdict is Verdict.PROVED, found[name].reason


KNOTS = ("-b", "-a", "-a/2", "0", "a/2", "a", "2*a", "b", "a + b", "b - a", "a*b/b", "max(a, b)")
FORCES = ("-G", "-F", "0", "F", "G", "F/2", "F + G", "G - F", "-F*b/a", "F*T_0/T", "-F*T/T_0")
CONDITIONS = ("a > 0", "b > 0", "b > a", "b >= a", "b > 2*a", "a >= 0", "b < 3*a")
CONDITIONS += ("F >= 0", "G >= F", "G >= 0", "F > 0", "G < 2*F")
SHAPES = (
    "{}",
    "{}",
    "F/G*{}",
    "{} + F*v/a",
    "{} if v < a else {}",
    "max({}, F)",
    "deadzone({}, F)",
)


@st.composite
def tabled(draw):
    """Draw a law with a table and a domain, both of which may be as wrong as they like."""
    count = draw(st.integers(2, 5))
    x = draw(st.lists(st.sampled_from(KNOTS), min_size=count, max_size=count, unique=True))
    at = {"a": 1, "b": 2.25, "max": max}
    x.sort(key=lambda text: law_values.value(text, at))
    y = draw(st.lists(st.sampled_from(FORCES), min_size=count, max_size=count))
    if "0" in x and draw(st.booleans()):
        y = [f"F*{n - x.index('0')}" if n != x.index("0") else "0" for n in range(count)]
    table = f"table(v, {', '.join(f'{p}, {q}' for p, q in zip(x, y, strict=True))})"
    missing = draw(st.sampled_from((*DOMAIN, *[""] * 4)))
    more = draw(st.lists(st.sampled_from(CONDITIONS), unique=True, max_size=3))
    domain = ("T > 0", *(text for text in DOMAIN if text != missing), *more)
    return draw(st.sampled_from(SHAPES)).format(table, table), x, domain


def _points(domain, seed=0):
    """Yield points of a domain, many of them at its edges and at knots."""
    rng, sizes = np.random.default_rng(seed), (0, 1, 2, 0.5, 2.25, 1e-3, 3)
    for _ in range(800):
        at = {name: float(rng.choice(sizes)) for name in "abFG"} | {"T_0": 1.0}
        at |= {"T": float(rng.choice((0.2, 1, 7))), "v": float(rng.choice((-9, -1, 0.3, 1, 9)))}
        at["v"] *= float(rng.choice((1, at["a"], at["b"])))
        at |= {n: -at[n] for n in "abFG" if rng.random() < 0.1}
        if all(law_values.value(text, at) for text in domain):
            yield at


@pytest.mark.long
@settings(max_examples=15)
@given(tabled())
def test_what_is_proved_numbers_do_not_deny(drawn):
    law, x, domain = drawn
    try:
        found = rows(law, domain, b=2.25, G=1.5)
    except SpecError:
        return
    verdict = {name: row.verdict for name, row in found.items() if isinstance(row, Row)}
    for at in _points(domain):
        values = [_value(text, at) for text in x]
        ordered = None not in values and all(p < q for p, q in pairwise(values))
        if verdict["welldef"] is Verdict.PROVED:
            assert ordered, (law, at)
        if verdict["passive"] is Verdict.PROVED and ordered:
            assert law_values.value(law, at) * at["v"] >= -1e-9, (law, at)


def _value(text, at):
    try:
        return law_values.value(text, at)
    except ZeroDivisionError:
        return None
