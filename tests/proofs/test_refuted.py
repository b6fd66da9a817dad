"""What must be refuted is refuted, with numbers that break the law by Python's own arithmetic.

The witness is put into the law's text, with floating-point numbers and with exact rationals.
"""

from fractions import Fraction
from pathlib import Path

import pytest

from piezo_sym import derive, load
from piezo_sym.proofs import Verdict, decide
from piezo_sym.spec.load import parse

SHIPPED = Path(__file__).parents[2] / "piezo_sym" / "models" / "piezo_stack.toml"
DEAD_ZONE = "rho/(T - T_0)*deadzone(i, i_0)"


def changed(*pairs):
    text = SHIPPED.read_text(encoding="utf-8")
    for old, new in pairs:
        assert old in text
        text = text.replace(old, new)
    return parse(text)


def row(model, name, element=""):
    rows = decide(derive(model)).rows
    return next(r for r in rows if (r.id, r.element) == (name, element))


def branches(lower="i + i_0", upper="i - i_0"):
    return f"rho/(T - T_0)*({upper} if i > i_0 else {lower} if i < -i_0 else 0)"


def deadzone(z, w):
    return max(z - w, 0) + min(z + w, 0)


REFUTED = {
    "the lower branch negated": (
        [(DEAD_ZONE, branches(lower="-i - i_0"))],
        "passive",
        "hysteron",
        f"({branches(lower='-i - i_0')})*i < 0 and T > T_0 and i_0 >= 0 and rho >= 0",
        {"i": "-2", "T": "2", "T_0": "1"},
    ),
    "d free of sign": ([('"d >= 0", ', "")], "passive", "damper", "d*v*v < 0", {"d": "-1"}),
    "rho free of sign": (
        [('"rho >= 0", ', "")],
        "passive",
        "hysteron",
        f"({DEAD_ZONE})*i < 0 and T > T_0 and i_0 >= 0",
        {"rho": "-1"},
    ),
    "the paper's gamma_j = w/T": (
        [(DEAD_ZONE, f"{DEAD_ZONE}*i/i_0"), ('"i_0 >= 0"', '"i_0 > 0"')],
        "passive",
        "hysteron",
        f"({DEAD_ZONE}*i/i_0)*i < 0 and T > T_0 and i_0 > 0 and rho >= 0",
        {"i": "-2"},
    ),
    "the domain without T > T_0": (
        [('"T > T_0", ', "")],
        "passive",
        "hysteron",
        f"({DEAD_ZONE})*i < 0 and T < T_0 and T > 0 and rho >= 0 and i_0 >= 0",
        {},
    ),
    "T = T_0 is a division by zero": (
        [('"T > T_0", ', "")],
        "welldef",
        "hysteron",
        "T - T_0 == 0",
        {},
    ),
    "a conductance below zero": (
        [('"lam >= 0"', '"T_0 > 0"')],
        "environment",
        "",
        "lam < 0",
        {"lam": "-1"},
    ),
}


@pytest.mark.some(2)
@pytest.mark.parametrize(
    ("pairs", "name", "element", "broken", "numbers"), REFUTED.values(), ids=REFUTED
)
def test_it_is_refuted_with_a_witness(pairs, name, element, broken, numbers):
    found = row(changed(*pairs), name, element)
    assert found.verdict is Verdict.REFUTED
    exact = {symbol: Fraction(value) for symbol, value in found.witness.items()}
    for kind in (float, Fraction):
        values = {symbol: kind(value) for symbol, value in exact.items()}
        assert eval(broken, {"deadzone": deadzone}, values)
    assert {symbol: found.witness[symbol] for symbol in numbers} == numbers
    assert found.reason


WARM = """
[model]
name = "warm"
[parameters]
c = { value = 10.0, unit = "J/K" }
T_0 = { value = 300.0, unit = "K" }
x_0 = { value = 0.1, unit = "m" }
w = { value = 1.0, unit = "1/s" }
m = { value = 1.0, unit = "kg" }
[inputs]
T_e = { unit = "K", default = 300.0 }
[domain]
assume = ["c > 0", "T_0 > 0"]
[elements]
mass = { kind = "mass", at = "tip", mass = "m", state = "p" }
cool = { kind = "ambient", body = "body", conductance = "c/T_0*T_0*w", input = "T_e" }
[elements.body]
kind = "storage"
energy = "-T_0*c*exp(-S/c)*(1 + q**2/x_0**2)"
[elements.body.states]
q = { rate = "velocity", between = ["tip", "wall"] }
S = { rate = "entropy" }
"""


@pytest.mark.some(1)
@pytest.mark.parametrize("name", ["exergy", "environment"])
def test_parameters_refute_a_row_about_a_temperature_that_solvers_do_not_know(name):
    """They know the exponential by bounds: parameters are tried with the spec's own state."""
    found = row(parse(WARM), name)
    assert found.verdict is Verdict.REFUTED
    assert Fraction(found.witness["w"]) < 0 < Fraction(found.witness["c"])


@pytest.mark.long
def test_a_row_that_is_false_where_the_domain_has_no_value_says_so():
    spring = 'spring = { kind = "spring", between = ["tip", "wall"], state = "z", stiffness = '
    text = WARM.replace("[elements.body]", spring + '"k/(1 + (q/g)**6)" }\n[elements.body]', 1)
    more = 'k = { value = 1.0, unit = "N/m" }\ng = { value = 1.0, unit = "m" }\n[inputs]'
    found = row(parse(text.replace("[inputs]", more)), "welldef", "spring")
    assert found.verdict is Verdict.OPEN
    assert "g != 0: it is false at" in found.reason
    assert "g = 0, z = 0, where 'k/(1 + (z/g)**6) > 0' has no value" in found.reason


def test_a_shifted_branch_is_passive_and_jumps():
    """The branch (i + i_0) for i > i_0 takes power in, but jumps at i = i_0."""
    model = changed((DEAD_ZONE, branches(upper="i + i_0")))
    assert row(model, "passive", "hysteron").verdict is Verdict.PROVED
    jump = row(model, "continuous", "hysteron")
    assert jump.verdict is Verdict.REFUTED
    assert jump.witness["i"] == jump.witness["i_0"]
    assert "at i = i_0" in jump.statement or "i = i_0" in jump.reason


def test_a_law_may_jump_if_its_spec_says_so():
    text = ('force = "d*v"', 'force = "d*v + sign(v)*F_c"')
    added = ("[inputs]", 'F_c = { value = 1.0, unit = "N" }\n\n[inputs]')
    assumed = ('"d >= 0"', '"d >= 0", "F_c >= 0"')
    assert row(changed(text, added, assumed), "continuous", "damper").verdict is Verdict.REFUTED
    told = (text[0], text[1] + "\ndiscontinuous = true")
    report = decide(derive(changed(told, added, assumed)))
    assert ("continuous", "damper") not in {(r.id, r.element) for r in report.rows}
    report.raise_if_not_proved()


def test_a_law_that_is_not_odd_is_no_fault():
    law = "rho/(T - T_0)*(i if i > 0 else 2*i)"
    report = decide(derive(changed((DEAD_ZONE, law))))
    odd = next(r for r in report.rows if (r.id, r.element) == ("odd", "hysteron"))
    assert odd.verdict is Verdict.REFUTED
    assert not odd.required
    report.raise_if_not_proved()


def test_a_law_of_the_state_that_drives_it_is_told_that_it_was_held():
    odd = row(changed(('"d*v"', '"d*p/M"')), "odd", "damper")
    assert odd.verdict is Verdict.REFUTED
    assert odd.reason.endswith("; p was held while v = p/M changed its sign")
    assert "held" not in row(changed(('"d*v"', '"d*v**2"')), "odd", "damper").reason


def test_everything_of_the_paper_is_proved():
    rows = decide(derive(load("piezo_stack"))).rows
    assert {r.verdict for r in rows} == {Verdict.PROVED}
