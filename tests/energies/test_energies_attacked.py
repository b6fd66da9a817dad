"""Energies that are wrong somewhere in their domain: the row that says otherwise is not PROVED.

Each point is checked by Python's own arithmetic on laws typed here.
"""

from math import exp, log

import pytest

from piezo_sym import PiezoError, derive, verify
from piezo_sym.proofs import decide
from piezo_sym.spec.load import parse

SPEC = """
[model]
name = "attacked"
[parameters]
k = { value = 100.0, unit = "N/m" }
g = { value = 0.01, unit = "m" }
U_0 = { value = 10.0, unit = "J" }
m_1 = { value = 1.0, unit = "kg" }
m_2 = { value = 1.0, unit = "kg" }
a = { value = 0.5, unit = "1" }
d = { value = 1.0, unit = "N*s/m" }
c = { value = 5.0, unit = "J/K" }
T_0 = { value = 300.0, unit = "K" }
[domain]
assume = ["k > 0", "g > 0", "U_0 > 0", "m_1 > 0", "m_1 + m_2 > 0", "d >= 0", "c > 0", "a > 0"]
[elements]
mass = { kind = "mass", at = "tip", mass = "m_1", state = "p" }
damper = { kind = "damper", between = ["tip", "wall"], force = "d*v", heats = "body" }
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
"""
SPRING = 'spring = {{ kind = "spring", between = ["tip", "wall"], {} = "{}", state = "q" }}\n'
GAS = """
gas = {{ kind = "storage", energy = "{}", states = {{ q = {{ rate = "velocity", \
between = ["tip", "wall"] }}, S_g = {{ rate = "entropy" }} }} }}
"""
PAIR = 'two = {{ kind = "mass", at = "tip", energy = "{}", state = "p_2" }}\n'


def verdicts(text, domain=""):
    """Return the verdict on each required row; the worst, where several have one name."""
    found = {}
    spec = SPEC.replace('"a > 0"]', f'"a > 0"{domain}]') + text
    for row in decide(derive(parse(spec))).rows:
        if row.required and found.get((row.id, row.element), "PROVED") == "PROVED":
            found[row.id, row.element] = row.verdict.value
    return found


def beside(law, at, step=1e-7):
    """Return how much a law rises from just before a point to just after it."""
    return law(at + step) - law(at - step)


JUMPS = {
    "k*q**2/2 if q < g else k*q**2/2 + U_0": (0.01, lambda q: 10.0 if q >= 0.01 else 0.0),
    "k*q**2/2 + U_0*sign(q)": (0.0, lambda q: 10.0 * ((q > 0) - (q < 0))),
    "k*q**2/2 if q < g else a*k*q**2/2": (0.01, lambda q: (50 if q < 0.01 else 25) * q * q),
}


@pytest.mark.parametrize("energy", JUMPS)
def test_power_is_not_all_that_changes_an_energy_that_jumps(energy):
    at, law = JUMPS[energy]
    assert abs(beside(law, at)) > 1e-3
    assert verdicts(SPRING.format("energy", energy))["energy", ""] == "REFUTED"


def test_two_energies_with_edges_at_one_place_are_each_looked_at():
    """An energy that does not jump hides none that does."""
    smooth = GAS.format("U_0*exp(S_g/c) + k*max(q - g, 0)**2/2")
    jumps = SPRING.format("energy", "k*q**2/2 if q < g else k*q**2/2 + U_0")
    jumps = jumps.replace('"q" }', '"z" }')
    for text in (smooth + jumps, jumps + smooth):
        assert verdicts(text)["energy", ""] == "REFUTED"
    assert verdicts(smooth)["energy", ""] == "PROVED"


@pytest.mark.parametrize("field", ["force", "energy"])
def test_a_force_that_jumps_is_refuted_and_numbers_do_not_contradict_its_energy(field):
    """The energy k abs(q) g has a kink, and no jump; one row speaks of both."""
    law = {"force": "k*g*sign(q)", "energy": "k*g*abs(q)"}[field]
    rows = verify(derive(parse(SPEC + SPRING.format(field, law)))).rows
    (row,) = (r for r in rows if (r.id, r.element) == ("continuous", "spring"))
    assert row.verdict.value == "REFUTED"


FALLING = {
    "U_0*exp(S_g/c) if S_g < 0 else U_0*(0.5 + 0.5*exp(S_g/c))": (
        lambda S: 2.0 * exp(S / 5) * (1 if S < 0 else 0.5)
    ),
    "U_0*(exp(S_g/c) - 0.9*max(S_g/c, 0))": lambda S: 2.0 * (exp(S / 5) - 0.9 * (S > 0)),
}


@pytest.mark.parametrize("energy", FALLING)
def test_a_temperature_that_jumps_down_does_not_rise_with_entropy(energy):
    assert beside(FALLING[energy], 0.0) < -0.1
    assert verdicts(GAS.format(f"{energy} + k*q**2/2"))["temperature", "gas"] == "REFUTED"


def test_a_body_that_jumps_down_is_no_warmer_with_more_entropy():
    hot = 'hot = { kind = "thermal_mass", temperature = "LAW", state = "S_h" }\n'
    text = hot.replace("LAW", "T_0*(exp(S/c) if S < 0 else 0.5*exp(S/c))")
    assert verdicts(text)["temperature", "hot"] == "REFUTED"


TRUE = {
    "a kink of T": ("U_0*exp(S_g/c) if S_g < 0 else U_0*(1 + S_g/c + (S_g/c)**2)", ""),
    "heat capacity changes": (
        "U_0*(S_g/c + (S_g/c)**2/2 if S_g < c else 2*S_g/c - 0.5 + (S_g/c - 1)**2)",
        ', "S_g > -0.5*c"',
    ),
}


@pytest.mark.parametrize("name", TRUE)
def test_a_temperature_with_a_kink_rises(name):
    energy, domain = TRUE[name]
    found = verdicts(GAS.format(f"({energy}) + k*q**2/2"), domain)
    assert found["temperature", "gas"] == found["energy", ""] == "PROVED"


def test_a_temperature_that_jumps_as_the_volume_changes_still_rises_with_entropy():
    found = verdicts(GAS.format("U_0*exp(S_g/c)*(1 if q < g else 2) + k*q**2/2"))
    assert found["temperature", "gas"] == "PROVED"
    assert found["continuous", "gas"] != "PROVED"
    assert found["energy", ""] != "PROVED"


@pytest.mark.some(1)
@pytest.mark.parametrize("factor", ["log(1 + q/g)", "sqrt(q/g)", "(1 + g/q)", "exp(g/q)"])
def test_a_factor_without_a_value_is_not_left_out_of_a_stiffness(factor):
    """At q = -2 g none of log and root has a value, at q = 0 none of the quotients."""
    with pytest.raises(ValueError, match="domain"):
        log(1 - 2)
    text = SPRING.format("stiffness", f"k*{factor}/{factor}")
    text += "[initial]\nq = 0.001\n"
    assert verdicts(text)["welldef", "spring"] != "PROVED"


@pytest.mark.some(1)
@pytest.mark.parametrize(
    "size",
    [
        "1 + cosh(q/g)/(q/g)",
        "cosh(q/g)/(q/g)",
        "2 + sign(q/g)/(q/g)",
        "2 + abs(q/g)/(q/g)",
        "2 + sqrt(abs(q/g))/(q/g)",
        "2 + max(q/g + a, 0)/(q/g)",
    ],
)
def test_a_stiffness_without_a_limit_at_rest_is_not_proved(size):
    """Force and energy have a value there, as k*(q + g*cosh(q/g)); a stiffness has none."""
    text = SPRING.format("stiffness", f"k*({size})") + "[initial]\nq = 0.001\n"
    assert verdicts(text)["welldef", ""] == "REFUTED"


@pytest.mark.some(2)
@pytest.mark.parametrize(
    "law",
    [
        "k*g*cosh(q/g)*(q/g)/(q/g)",
        "k*max(q + g, 0)*q/q",
        "k*q*(q - g)/(q - g)",
        "k*g*abs(q)/q",
        "k*q*(1 + abs(q)/q)",
    ],
)
def test_a_force_with_another_hole_than_zero_at_rest_is_not_proved(law):
    text = SPRING.format("force", law)
    assert verdicts(text)["welldef", "spring"] == "REFUTED"


@pytest.mark.parametrize(
    "size", ["1 + sinh(q/g)/(q/g)/(q/g)", "sin(q/g)/(q/g) - 2", "-sinh(q/g)/(q/g)"]
)
def test_a_stiffness_that_is_infinite_or_negative_at_rest_is_refused(size):
    with pytest.raises(PiezoError, match="outside the domain"):
        derive(parse(SPEC + SPRING.format("stiffness", f"k*({size})")))


def test_a_factor_that_parameters_make_zero_is_not_left_out_of_a_stiffness():
    """For m_2 = 0 the stiffness is 0/0 wherever the spring is."""
    text = SPRING.format("stiffness", "k*(m_2*q + m_2*g)/(m_2*q + m_2*g)")
    assert verdicts(text)["welldef", ""] == "REFUTED"


@pytest.mark.parametrize(
    "force",
    ["max(q/g + 1, 0)", "(cosh(q/g) if q > -g else 1)", "table(q/g, -1, -1, 1, 2, 2, 3)"],
)
def test_a_kink_hides_no_stiffness_that_is_infinite_at_rest(force):
    """With q >= 0 alone displacement times force is nowhere negative; at rest there is a force."""
    text = SPRING.format("stiffness", f"k*{force}/(q/g)") + "[initial]\nq = 0.001\n"
    with pytest.raises(PiezoError, match="outside the domain"):
        verdicts(text, ', "q >= 0"')


def test_a_gap_may_be_in_a_stiffness():
    text = SPRING.format("stiffness", "k*max(q - g, 0)/q")
    assert {*verdicts(text).values()} == {"PROVED"}


@pytest.mark.parametrize(
    "energy", ["p**2/(2*m_2)", "p**2/(2*m_1) + U_0*log(m_2/m_1)", "p**2/2*m_2/(m_1*m_2)"]
)
def test_joined_stores_need_a_value_each(energy):
    """With m_2 = 0 and m_1 = 1 the sum of the masses is positive; the second has no velocity."""
    assert verdicts(PAIR.format(energy))["welldef", "mass"] == "REFUTED"
    assert verdicts(PAIR.format(energy), ', "m_2 > 0"')["welldef", "mass"] == "PROVED"
