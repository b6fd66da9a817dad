"""What rows that are not PROVED show of a law with free parameters: counterexamples, conditions."""

import math
from fractions import Fraction

import pytest

from piezo_sym import derive
from piezo_sym.proofs import Verdict, decide
from piezo_sym.spec.load import parse

SPEC = """
[model]
name = "shown"
[parameters]
m = {{ value = 1.0, unit = "kg" }}
c = {{ value = 2.0, unit = "J/K" }}
T_0 = {{ value = 300.0, unit = "K" }}
d = {{ value = 1.0, unit = "N*s/m" }}
v_0 = {{ value = 1.0, unit = "m/s" }}
n = {{ value = 1.5, unit = "1" }}
[domain]
assume = {domain}
[elements]
mass = {{ kind = "mass", at = "tip", mass = "m" }}
damper = {{ kind = "damper", between = ["tip", "wall"], force = "{law}", heats = "body" }}
body = {{ kind = "thermal_mass", temperature = "T_0*exp(S/c)" }}
"""
POWER = "d*v*abs(v/v_0)**(n - 1)"


def rows(law, *domain):
    report = decide(derive(parse(SPEC.format(law=law, domain=[*domain]))))
    return {r.id: r for r in report.rows if r.element in {"damper", ""}}


@pytest.mark.some(2)
@pytest.mark.parametrize("more", [(), ("n > 0",), ("n < 5",)])
def test_a_power_is_refuted_where_mathematics_has_no_value(more):
    """At n = 1, which was shown, the law is d*v: only a negative power of zero has no value."""
    row = rows(POWER, "d >= 0", "v_0 > 0", *more)["welldef"]
    assert row.verdict is Verdict.REFUTED
    at = {name: Fraction(value) for name, value in row.witness.items()}
    with pytest.raises(ZeroDivisionError):
        at["v"] * abs(at["v"] / at["v_0"]) ** (at["n"] - 1)
    found = rows(POWER, "d >= 0", "v_0 > 0", "n > 1", *more)
    assert {r.verdict for r in found.values()} == {Verdict.PROVED}


def test_a_power_that_laws_may_not_have_is_no_counterexample():
    row = rows("d*v*abs(T/T_0)**n", "d >= 0", "T > 0")["welldef"]
    assert row.verdict is Verdict.OPEN
    assert row.witness is None
    assert row.reason.endswith("the condition 'n > 0' in [domain] mends it")
    row = rows("d*v*abs(v/v_0)**max(n - 1, 0)", "d >= 0", "v_0 > 0", "n >= 1")["welldef"]
    assert row.verdict is Verdict.OPEN
    assert row.witness is None


BODY = 'body = {{ kind = "thermal_mass", temperature = "T_0*exp(S/c)" }}'
STORE = """
[elements.body]
kind = "storage"
energy = "ENERGY"
states = {{ S = {{ rate = "entropy" }} }}
"""
HOT = SPEC.replace("[domain]", 'b = {{ value = 1.0, unit = "1" }}\n[domain]').replace(BODY, STORE)


@pytest.mark.long
@pytest.mark.parametrize(
    ("energy", "domain", "said", "less"),
    [
        ("c*T_0*(1 + S/c)**n", ["S > -c"], "n > 1", "n > 0.9"),
        ("c*T_0*(1 + S/c)**n", ["S > -c", "n > 0"], "n > 1", "n > 0.9"),
        ("c*T_0*(n**2*b - n*b)*exp(S/c)", ["n > 0", "b > 0"], "n > 1", "n > 0.9"),
        ("c*T_0*exp(S/c)/(n - b)", [], "n > b", "n >= b"),  # T > 0 does not say that T has a value
    ],
)
def test_conditions_are_short_and_what_is_less_is_not_enough(energy, domain, said, less):
    def row(*more):
        text = HOT.format(law="d*v", domain=["c > 0", "T_0 > 0", "d >= 0", *domain, *more])
        report = decide(derive(parse(text.replace("ENERGY", energy))))
        return next(row for row in report.rows if row.id == "temperature")

    assert row().verdict is Verdict.REFUTED
    assert f"; the condition '{said}' in [domain]" in row().reason
    assert row(said).verdict is Verdict.PROVED
    assert row(less).verdict is not Verdict.PROVED


MORE = """a = {{ value = 2.0, unit = "N*s/m" }}
d_3 = {{ value = 1.0, unit = "N*s**3/m**3" }}
F_c = {{ value = 1.0, unit = "N" }}
[domain]"""
DAMPER = SPEC.replace("[domain]", MORE)


@pytest.mark.some(1)
@pytest.mark.parametrize(
    ("law", "said", "less"),
    [
        ("d*v + d_3*v**3", ("d >= 0", "d_3 >= 0"), ("d >= 0", "d_3 >= -d*1e-3/v_0**2")),
        ("d*v + F_c*tanh(v/v_0)", ("d >= 0", "F_c >= 0"), ("d >= 0", "F_c >= -d*v_0*1.1")),
        ("F_c*sign(v)*sqrt(abs(v)/v_0)", ("F_c >= 0",), ("F_c >= -0.1*d*v_0", "d > 0")),
        ("F_c*sign(v)*sqrt(abs(v)/v_0) + a*v", ("F_c >= 0", "a >= 0"), ("F_c >= 0",)),
        ("a*v + d*abs(v)", ("a >= abs(d)",), ("a >= d",)),
        ("(a - d)*v", ("a >= d",), ("a >= d - d_3*v_0**2", "d_3 > 0")),
        ("abs(d)*(exp(n) - 1)*v", ("n >= 0",), ("n >= -0.1",)),
        ("a*v if v > 0 else d*v", ("a >= 0", "d >= 0"), ("a + d >= 0",)),
        ("saturate(a*v, F_c)", ("a >= 0",), ("F_c >= 0",)),
    ],
)
def test_the_conditions_of_a_damper_are_those_of_its_terms(law, said, less):
    def row(*more):
        text = DAMPER.format(law=law, domain=["v_0 > 0", *more])
        jumps = 'heats = "body", discontinuous = true'
        found = decide(derive(parse(text.replace('heats = "body"', jumps)))).rows
        return next(row for row in found if row.id == "passive")

    shown = " and ".join(f"'{condition}'" for condition in said)
    assert f"; the condition{'s' * (len(said) > 1)} {shown} in [domain] mend" in row().reason
    assert row(*said).verdict is Verdict.PROVED
    assert row(*less).verdict is not Verdict.PROVED


@pytest.mark.parametrize("law", ["a*v + d*v**2/v_0", "(a*abs(v) + d*abs(v))*v_0/v_0"])
def test_what_would_have_to_be_zero_is_not_bounded(law):
    rows_of = decide(derive(parse(DAMPER.format(law=law, domain=["v_0 > 0"])))).rows
    (row,) = (row for row in rows_of if row.id == "passive")
    assert row.verdict is Verdict.REFUTED
    assert "in [domain]" not in row.reason


WEN = "(beta*abs(v)*f + gam*v*abs(f))/f_0"
SPRING = """[elements.spring]
kind = "spring"
between = ["tip", "wall"]
stiffness = "a"
slip = "LAW"
heats = "body"
[elements]
mass"""


@pytest.mark.some(1)
@pytest.mark.parametrize(
    ("law", "said"),
    [
        (WEN, "beta >= abs(gam)"),
        (WEN.replace("gam*v", "beta*v"), "beta >= 0"),
        (WEN.replace("abs(f)", "f"), "beta >= abs(gam)"),
        ("(beta*abs(v)*sign(f) + gam*v)*abs(f/f_0)", "beta >= abs(gam)"),
    ],
)
def test_bouc_wen_is_told_its_condition(law, said):
    """No condition has the velocity, which has no name in [domain]."""
    more = 'beta = {{ value = 0.6, unit = "1" }}\ngam = {{ value = -0.4, unit = "1" }}\n'
    more += 'f_0 = {{ value = 4.0, unit = "N" }}\n[domain]'
    text = DAMPER.replace("[domain]", more).replace("[elements]\nmass", SPRING)
    text = text.replace("LAW", law).replace(
        'a = {{ value = 2.0, unit = "N*s/m"', 'a = {{ value = 2.0, unit = "N/m"'
    )

    def row(*more):
        found = decide(derive(parse(text.format(law="d*v", domain=["d >= 0", "f_0 > 0", *more]))))
        return next(row for row in found.rows if (row.id, row.element) == ("passive", "spring"))

    assert row().verdict is Verdict.REFUTED
    assert row().reason.endswith(f"; the condition '{said}' in [domain] mends it")
    assert row(said).verdict is Verdict.PROVED
    assert row(f"1.001*{said}" if "abs" in said else "beta >= -1e-3").verdict is Verdict.REFUTED


JOINED = """
[elements.body]
kind = "storage"
energy = "c*T_0*exp(S/c) + a*q**2/4*(1 + tanh(S/S_m))"
[elements.body.states]
S = { rate = "entropy" }
q = { rate = "velocity", between = ["tip", "wall"] }
"""


@pytest.mark.some(1)
@pytest.mark.parametrize(
    ("more", "false"),
    [
        ((), True),
        (("a*q**2 < c*T_0",), True),  # c = 10, S = 1: the exponential is flat
        (("a*q**2 < c*T_0", "S_m > 100*c", "S > 0"), False),  # at most 2e-5 of the other term
    ],
)
def test_a_slope_that_solvers_know_by_bounds_is_refuted_by_numbers(more, false):
    """T = T_0*exp(S/c) + a*q**2/(4 S_m cosh(S/S_m)**2) falls with S where q is large."""
    text = DAMPER.format(
        law="d*v", domain=["c > 0", "T_0 > 0", "S_m > 0", "a > 0", "d >= 0", *more]
    )
    text = text.replace(BODY.format(), JOINED).replace('2.0, unit = "N*s/m"', '2.0, unit = "N/m"')
    value = "1000.0" if more[1:] else "1.0"
    text = text.replace("[domain]", f'S_m = {{ value = {value}, unit = "J/K" }}\n[domain]')
    start = "[initial]\nS = 1.0\n[elements]\nmass" if more[1:] else "[elements]\nmass"
    found = decide(derive(parse(text.replace("[elements]\nmass", start)))).rows
    row = next(row for row in found if row.id == "temperature")
    assert row.verdict is (Verdict.REFUTED if false else Verdict.PROVED)
    if false:
        at = {name: float(Fraction(number)) for name, number in row.witness.items()}
        a, c, q, S, S_m = (at[name] for name in ("a", "c", "q", "S", "S_m"))
        bent = math.tanh(S / S_m) / math.cosh(S / S_m) ** 2
        assert at["T_0"] / c * math.exp(S / c) < a * q**2 / (2 * S_m**2) * bent
        assert not more or a * q**2 < c * at["T_0"]
