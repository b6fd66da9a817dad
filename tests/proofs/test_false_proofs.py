"""Specs that break the second law at the values they give, and were once called proved.

Each is wrong inside its domain; whatever is said of it, it is not that all is proved.
"""

import pytest

from piezo_sym import PiezoError, derive
from piezo_sym.proofs import decide
from piezo_sym.spec.load import parse

MASS = """
[model]
name = "damped"
[parameters]
m = {{ value = 1.0, unit = "kg" }}
c = {{ value = 2.0, unit = "J/K" }}
T_0 = {{ value = 300.0, unit = "K" }}
{parameters}
[domain]
assume = [{domain}]
[elements]
mass = {{ kind = "mass", at = "tip", mass = "m", state = "p" }}
{elements}
damper = {{ kind = "damper", between = ["tip", "wall"], force = "{force}", heats = "body" }}
body = {{ kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }}
"""
A = 'a = { value = -1.0, unit = "N*s/m" }\na_1 = { value = 1.0, unit = "N*s/m" }'
TWO = 'a = { value = -5.0, unit = "N*s/m" }\nb = { value = -1.0, unit = "N*s/m" }'
SCALES = A + '\nF_1 = { value = 1.0, unit = "N" }\nv_1 = { value = 1.0, unit = "m/s" }'
SPRING = (
    'spring = {{ kind = "spring", between = ["tip", "wall"], stiffness = "{}", state = "q" }}\n'
)
K = '\nk = { value = 1.0, unit = "N/m" }'
ROOT = "(sqrt(a/a_1) if a > 0 else {})"
EXPONENTIALS = (
    "F_1*v/v_1*(exp(v/v_1) - 2.7*v/v_1) if a > 0 else "
    "F_1*v/v_1*(exp(v/v_1 - 0.37) - 2.72*(v/v_1 - 0.37))"
)

DAMPED = {
    "a root in a stiffness": (
        A + K,
        '"a_1 > 0"',
        SPRING.format(f"k*(1 + {ROOT.format(0)})"),
        "a*v",
    ),
    "a root in the domain": (A, f'"a_1 > 0", "{ROOT.format(1)} >= 0"', "", "a*v"),
    "a quotient in the domain": (A, '"a_1 > 0", "(a_1/a if a > 0 else 1) >= 0"', "", "a*v"),
    "a log in the domain": (A, '"a_1 > 0", "(log(a/a_1) if a > 0 else 1) >= -9"', "", "a*v"),
    "a power in the domain": (
        A,
        '"a_1 > 0", "((a/a_1)**(3/2) if a > 0 else 1) >= 0"',
        "",
        "a*v",
    ),
    "exponentials by a parameter": (SCALES, '"a_1 > 0", "F_1 > 0", "v_1 > 0"', "", EXPONENTIALS),
    "a saturation of negative width": (TWO, '"saturate(a, b) < 0", "b < 0"', "", "(a - b)*v"),
    "a dead zone of negative width": (TWO, '"deadzone(a, b) < 0", "b < 0"', "", "(a - b)*v"),
}

HYSTERONS = """
[model]
name = "lanes"
[parameters]
R = { value = 1.0, unit = "ohm" }
i_1 = { value = 1.0, unit = "A" }
L = { value = 1.0, unit = "H" }
C = { value = 1.0, unit = "F" }
c = { value = 1.0, unit = "J/K" }
T_0 = { value = 300.0, unit = "K" }
[inputs]
V = { unit = "V" }
[domain]
assume = ["phi_h**2 < L*L*i_1*i_1", "R > 0", "i_1 > 0"]
[initial]
z = 5.0
[elements]
supply = { kind = "voltage_source", between = ["in", "gnd"], input = "V" }
capacitor = { kind = "capacitor", between = ["cap", "gnd"], capacitance = "C" }
[elements.h]
kind = "hysteron"
between = ["in", "cap"]
count = 2
inductance = "L"
voltage = "R*i"
heats = "body"
[elements.h_j]
kind = "hysteron"
between = ["in", "cap"]
inductance = "L"
voltage = "R*i*(1 - (i/i_1)**2)"
heats = "body"
state = "z"
[elements.body]
kind = "thermal_mass"
temperature = "T_0*exp(S/c)"
"""


def required(text):
    """Return the verdict on each required row, or nothing if the spec is refused."""
    try:
        report = decide(derive(parse(text)))
    except PiezoError:
        return {}
    return {(row.id, row.element): row.verdict.value for row in report.rows if row.required}


@pytest.mark.some(3)
@pytest.mark.parametrize("name", DAMPED)
def test_a_damper_that_is_active_at_the_values_given_is_not_proved(name):
    parameters, domain, elements, force = DAMPED[name]
    text = MASS.format(parameters=parameters, domain=domain, elements=elements, force=force)
    found = required(text)
    assert found.get(("passive", "damper")) != "PROVED"
    assert found.get(("sigma", "")) != "PROVED"


def test_a_bank_and_an_element_named_like_its_lane_are_told_apart():
    found = required(HYSTERONS)
    assert found["passive", "h"] == "PROVED"
    assert found["passive", "h_j"] == "REFUTED"
    assert found["sigma", ""] != "PROVED"


def test_the_rates_of_a_bank_and_of_an_element_named_like_its_lane_do_not_collapse():
    iphs = derive(parse(HYSTERONS))
    C, Q, V = (iphs.symbols[name] for name in ("C", "Q_capacitor", "V"))
    R, L, i_1, z = (iphs.symbols[name] for name in ("R", "L", "i_1", "z"))
    rates = dict(zip((slot.label for slot in iphs.system.states), iphs.rhs, strict=True))
    i = z / L
    assert (rates["z"] - (V - Q / C - R * i * (1 - (i / i_1) ** 2))).expand() == 0


def test_a_quotient_by_what_may_be_zero_has_no_value_there():
    """A root of a branch that is not taken once made `a` positive everywhere."""
    text = MASS.format(
        parameters=A,
        domain=f'"a_1 > 0", "{ROOT.format(1)} >= 0"',
        elements="",
        force="a_1*v*(a_1/a)**2",
    )
    assert required(text)["welldef", "damper"] == "REFUTED"


TRUE = {
    "a choice inside its guard": (
        "v*F_1/v_1*((1 if sqrt(v/v_1) > 1 else 2) if abs(v/v_1 - 2) < 1 else 1)"
    ),
    "a root where it is taken": "a_1*v*(sqrt(a/a_1) if a > 0 else 0)",
}


@pytest.mark.parametrize("name", TRUE)
def test_what_is_evaluated_under_its_guard_has_a_value(name):
    """Neither is refuted for a value it never takes."""
    text = MASS.format(
        parameters=SCALES,
        domain='"a_1 > 0", "F_1 > 0", "v_1 > 0"',
        elements="",
        force=TRUE[name],
    )
    found = required(text)
    assert found["welldef", "damper"] == "PROVED"
    assert found["passive", "damper"] == "PROVED"


def test_a_branch_chosen_by_parameters_alone_is_no_jump():
    text = MASS.format(
        parameters=A, domain='"a_1 > 0"', elements="", force="a_1*v if a > 0 else 2*a_1*v"
    )
    found = required(text)
    assert ("continuous", "damper") not in found
    assert found["passive", "damper"] == "PROVED"
