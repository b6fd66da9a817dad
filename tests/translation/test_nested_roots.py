"""A root of a root is one root, also of a difference of states, of which no sign is known."""

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
