"""Laws that divide by a root are read back as they are printed, also where no sign is known.

A step's integrands are compared outside the domain, where a parameter has no sign.
"""

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
name = "fast"
[parameters]
m   = {{ value = 1.0, unit = "kg" }}
p_0 = {{ value = 2.0, unit = "kg*m/s" }}
k   = {{ value = 3.0, unit = "N/m" }}
[domain]
assume = ["m > 0", "p_0 > 0"]
[elements]
spring = {{ kind = "spring", between = ["tip", "wall"], stiffness = "k", state = "q" }}
mass   = {{ kind = "mass", at = "tip", velocity = "{law}", state = "p" }}
"""
LAWS = [
    "p/m/sqrt(1 + (p/p_0)**2)",
    "p/(m*sqrt(1 + (p/p_0)**2))",
    "p/m*(1 + (p/p_0)**2)**(-1/2)",
    "p/m*(1 + (p/p_0)**2)**(-3/2)",
]
#: What is printed of a root below, and what else may not be shown to be it.
WRONG = [
    ("p/m/sqrt_of(1.0 + power_2_of(p/p_0))", "p/m*sqrt_of(1.0 + power_2_of(p/p_0))"),
    ("p/m/sqrt_of(1.0 + power_2_of(p/p_0))", "p/m/(1.0 + power_2_of(p/p_0))"),
    ("p/m/sqrt_of(1.0 + power_2_of(p/p_0))", "p/m/sqrt_of(1.0 + power_2_of(p)/p_0)"),
    ("p/m/sqrt_of(1.0 + power_2_of(p/p_0))", "p/m/sqrt_of(1.0 - power_2_of(p/p_0))"),
    ("p/m/sqrt_of(1.0 + power_2_of(p/p_0))", "p*p/p/m/sqrt_of(1.0 + power_2_of(p/p_0))"),
    (
        "p/m/sqrt_of(1.0 + power_2_of(p/p_0))",
        "p*p_0/m/sqrt_of(power_2_of(p_0) + power_2_of(p))",
    ),
]


@pytest.mark.some(1)
@pytest.mark.parametrize("law", LAWS)
def test_a_law_that_divides_by_a_root_is_proved(law):
    iphs = derive(parse(SPEC.format(law=law)))
    (row,) = rows(iphs, printed(iphs))
    assert row.verdict is Verdict.PROVED, row.reason


@pytest.mark.some(2)
@pytest.mark.parametrize(("old", "new"), WRONG)
def test_another_root_below_is_not_proved(old, new):
    iphs = derive(parse(SPEC.format(law=LAWS[0])))
    text = printed(iphs)["step"]
    assert old in text
    changed = text.replace(old, new, 1)
    assert verdict(Reference(iphs), "step", changed) is not Verdict.PROVED


@pytest.mark.some(1)
@pytest.mark.parametrize("language", TEXTS)
def test_no_mutant_of_a_root_below_is_proved(language):
    iphs = derive(parse(SPEC.format(law=LAWS[0])))
    text, known = printed(iphs)[language], Reference(iphs)
    lines = [n for n, line in enumerate(text.split("\n"), 1) if "sqrt" in line]
    made = [one for one in mutants(text) if int(one[0].split()[1]) in lines]
    assert len(made) > 10
    assert [what for what, new in made if verdict(known, language, new) is Verdict.PROVED] == []
