"""A root of a root is one root, also of a difference of states, of which no sign is known."""

import re

import pytest

from piezo_sym import derive
from piezo_sym.report import Verdict
from piezo_sym.spec.load import parse
from piezo_sym.translation.program import Reference
from tests.translation.mutants import mutants
from tests.translation.printed import TEXTS, printed, rows
from tests.translation.test_program import verdict

SPEC = """
[model]
name = "between"
[parameters]
m   = {{ value = 1.0, unit = "kg" }}
d   = {{ value = 1.0, unit = "N/(m/s)**(1/2)" }}
v_0 = {{ value = 1.0, unit = "m/s" }}
T_0 = {{ value = 300.0, unit = "K" }}
c   = {{ value = 1.0, unit = "J/K" }}
[domain]
assume = ["d >= 0", "v_0 > 0"]
[elements]
first  = {{ kind = "mass", at = "a", mass = "m", state = "p_1" }}
second = {{ kind = "mass", at = "b", mass = "m", state = "p_2" }}
damper = {{ kind = "damper", between = ["a", "b"], force = "{law}", heats = "body" }}
body   = {{ kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }}
"""
LAWS = [
    "d*v/sqrt(sqrt(v**2 + v_0**2))",
    "d*v/sqrt((v**2 + v_0**2)**(1/2))",
    "d*v/v_0*sqrt(sqrt(v**2 + v_0**2))",
]


@pytest.mark.some(1)
@pytest.mark.parametrize("law", LAWS)
def test_a_root_of_a_root_is_proved(law):
    iphs = derive(parse(SPEC.format(law=law)))
    (row,) = rows(iphs, printed(iphs))
    assert row.verdict is Verdict.PROVED, row.reason


@pytest.mark.some(1)
@pytest.mark.parametrize("language", TEXTS)
def test_no_mutant_of_a_root_of_a_root_is_proved(language):
    iphs = derive(parse(SPEC.format(law=LAWS[0])))
    text, known = printed(iphs)[language], Reference(iphs)
    lines = [n for n, line in enumerate(text.split("\n"), 1) if "F_damper = " in line]
    made = [one for one in mutants(text) if int(one[0].split()[1]) in lines]
    assert len(made) > 10
    assert [what for what, new in made if verdict(known, language, new) is Verdict.PROVED] == []


CHOICE = """
[model]
name = "chosen"
[parameters]
m = {{ value = 1.0, unit = "kg" }}
d = {{ value = 1.0, unit = "N*s/m" }}
h = {{ value = 2.0, unit = "1" }}
p = {{ value = 1.0, unit = "1" }}
r = {{ value = 1.0, unit = "1" }}
T_0 = {{ value = 300.0, unit = "K" }}
c = {{ value = 1.0, unit = "J/K" }}
[domain]
assume = ["d >= 0", "{first}", "{second}"]
[elements]
mass   = {{ kind = "mass", at = "a", mass = "m", state = "p_a" }}
damper = {{ kind = "damper", between = ["a", "wall"], force = "{law}", heats = "body" }}
body   = {{ kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }}
"""
#: Factors that may be 0, each with the condition under which it is a value >= 0.
ZEROS = [
    ("r", "r >= 0"),
    ("sqrt(r)", "r >= 0"),
    ("sqrt(p - r)", "p >= r"),
    ("sqrt((p - r)**2)", "p >= 0"),
]


def not_proved(first, second, law, test, others):
    """Show that a NumPy text is proved, and not with others in place of a comparison in it."""
    iphs = derive(parse(CHOICE.format(first=first, second=second, law=law)))
    text, known = printed(iphs)["NumPy"], Reference(iphs)
    test = test.replace("sqrt", "np.sqrt")
    assert test in text
    assert verdict(known, "NumPy", text) is Verdict.PROVED
    for other in others:
        assert verdict(known, "NumPy", text.replace(test, other)) is not Verdict.PROVED, other


@pytest.mark.parametrize(("factor", "condition"), ZEROS)
def test_a_product_is_not_positive_where_a_factor_is_0(factor, condition):
    """It was taken for positive where the rest of it is, and comparisons with 0 for true."""
    test = f"{factor}*(h - 1) > 0"
    not_proved(condition, "h > 1", f"d*v if {test} else 2*d*v", test, ["h - 1 > 0", "h > 0"])


@pytest.mark.parametrize(("factor", "condition"), ZEROS[:3])
def test_a_product_that_is_assumed_says_nothing_where_a_factor_is_0(factor, condition):
    law = "d*v if h - 1 >= 0 else 2*d*v"
    not_proved(condition, f"{factor}*(h - 1) >= 0", law, "h - 1 >= 0", ["h**2 >= 0"])


#: Conditions, a law, and a comparison that is false where a factor of the radicand is 0.
RADICANDS = [
    (
        ("r >= 0", "r*(p - h) >= 0"),
        "(d*v if p >= h else 2*d*v) if sqrt(r*(p - h)) <= 0 else 3*d*v",
    ),
    (("r >= 0", "sqrt(r*(p - h)) <= 1"), "d*v if p >= h else 2*d*v"),
    (("r >= 0", "sqrt(h**2*p) <= 1"), "d*v if p >= 0 else 2*d*v"),
    (("r >= 0", "sqrt(sqrt(r)*(p - h)) <= 1"), "d*v if p >= h else 2*d*v"),
    (("r >= 0", "sqrt(sqrt(r - h)*(p - h)) <= 1"), "d*v if p >= h else 2*d*v"),
    (
        ("r > -1", "sqrt(h**2 + r**2)*(p - h) >= 0"),
        "(d*v if p >= h else 2*d*v) if sqrt(sqrt(h**2 + r**2)*(p - h)) <= 1 else 3*d*v",
    ),
]


@pytest.mark.parametrize(("conditions", "law"), RADICANDS)
def test_a_radicand_says_nothing_of_a_factor_where_another_is_0(conditions, law):
    """The root of a product is 0 where one factor is, and the other may be negative there."""
    text = CHOICE.format(first=conditions[0], second=conditions[1], law=law)
    text = text.replace("h = { value = 2.0", "h = { value = 0.5")
    iphs = derive(parse(text))
    text, known = printed(iphs)["NumPy"], Reference(iphs)
    test = re.search(r"p >= \w", text)[0]
    assert verdict(known, "NumPy", text) is not Verdict.REFUTED
    assert verdict(known, "NumPy", text.replace(test, "p**2 >= 0")) is not Verdict.PROVED


#: Conditions, the factor of a law, and a text that is nan at a point where the factor is 0.
SPLIT = [
    (("r >= 0", "r*(p - h) >= 0"), "sqrt(r*(p - h))", "sqrt(r)*sqrt(p - h)"),
    (("r >= 0", "h**2*p >= 0"), "sqrt(h**2*p)", "abs(h)*sqrt(p)"),
    (("r >= 0", "sqrt(r)*(p - h) >= 0"), "sqrt(sqrt(r)*(p - h))", "r**(1/4)*sqrt(p - h)"),
    (("r >= 0", "r*(p - h) >= 0"), "sqrt(r*(p - h))", "(r**2)**(1/4)*sqrt(p - h)"),
]


@pytest.mark.parametrize(("conditions", "factor", "other"), SPLIT)
def test_the_root_of_a_product_is_no_product_of_roots_where_a_factor_is_0(
    conditions, factor, other
):
    text = CHOICE.format(first=conditions[0], second=conditions[1], law=f"d*v*{factor}")
    iphs = derive(parse(text.replace("h = { value = 2.0", "h = { value = 0.5")))
    text, known = printed(iphs)["NumPy"], Reference(iphs)
    old, new = (re.sub("sqrt|abs", r"np.\g<0>", part) for part in (factor, other))
    assert old in text
    assert verdict(known, "NumPy", text.replace(old, new)) is not Verdict.PROVED
