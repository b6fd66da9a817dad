"""Rates and co-states that equal those of the network on each branch, or for positive factors."""

from math import sqrt

import pytest
from scipy.integrate import quad

from tests.checker.stated import forged, refused, stated
from tests.energies.kinked import TEXT

CONTACT = """[model]
name = "contact"
[parameters]
T_0 = { value = 300.0, unit = "K" }
c = { value = 2.0, unit = "J/K" }
h = { value = 1.0, unit = "W/K" }
n = { value = 0.3, unit = "1" }
[inputs]
T_e = { unit = "K", default = 320.0 }
[domain]
assume = ["h >= 0", "n > 0", "T_e > 0"]
[elements]
one = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
air = { kind = "ambient", body = "one", conductance = "LAW", input = "T_e" }
"""
#: Conductances, and of the rate a part, and what is put in its place.
CONTACTS = (
    ("h*abs((T - T_e)/T_0)**(1/4)", "(-T_e + T)**0.25", "(T_e - T)**0.25"),
    ("h*sqrt(abs(T - T_e)/T_0)", "else sqrt(-T + T_e)", "else 2*sqrt(-T + T_e)"),
    ("h*max((T - T_e)/T_0, 0)**(1/4)", "else 0", "else 0.1"),
    ("h*(T_e/T)**(1/2)", "**1.5", "**0.5"),
    ("h*(1 + saturate((T - T_e)/T_0, 0.1))", "< -0.1", "< -0.2"),
)


@pytest.mark.some(2)
@pytest.mark.parametrize(("law", "old", "new"), CONTACTS)
def test_a_conductance_with_a_root_or_a_limit_is_confirmed(law, old, new):
    text = CONTACT.replace("LAW", law)
    proofs = stated(text)
    assert all(row["verdict"] == "PROVED" for row in proofs["obligations"])
    assert refused(text, proofs) == {}
    rate = proofs["system"]["rates"]["S"]
    assert old in rate, rate
    proofs["system"]["rates"]["S"] = rate.replace(old, new, 1)
    assert refused(text, proofs)["system", ""] == "rate of S is not that of the network"


@pytest.mark.parametrize("more", ["h/(0*T_0)", "h/(T - T)"])
def test_a_divisor_that_is_zero_by_its_form_is_told(more):
    text = CONTACT.replace("LAW", "h*(1 + saturate((T - T_e)/T_0, 0.1))")
    proofs = stated(text)
    proofs["system"]["rates"]["S"] += f" + {more}"
    assert refused(text, proofs)["system", ""] == "a divisor is zero by its form"


def test_factors_that_may_be_negative_are_not_taken_out_of_roots():
    """sqrt(T_e**2) is T_e where T_e is positive."""
    text = CONTACT.replace("LAW", "h*(T_e**2/T**2)**(1/2)")
    proofs = stated(text)
    proofs["system"]["rates"]["S"] = "h*T_e/T*(T_e/T - 1)"
    assert ("system", "") not in refused(text, proofs)
    assert ("system", "") in refused(text.replace('"T_e > 0"', '"T_e >= -T_0"'), proofs)


#: Fields of springs; of the energy or co-state a part, and what is put in its place.
SPRINGS = (
    ('force = "deadzone(k*q, F_0)"', "energy", "0.5*deadzone", "0.6*deadzone"),
    ('force = "deadzone(k*q, F_0) + k*q"', "energy", "k*q, F_0", "k*q, F_0/2"),
    (
        'energy = "k*q**2/2 if abs(k*q) < F_0 else F_0*abs(q) - F_0**2/(2*k)"',
        "F_spring",
        "-k*q < F_0 else (F_0 if q >= 0 else -F_0)",
        "-k*q < F_0 else F_0",
    ),
)


@pytest.mark.some(2)
@pytest.mark.parametrize(("field", "name", "old", "new"), SPRINGS)
def test_kinks_at_a_product_with_the_state_are_confirmed(field, name, old, new):
    text = TEXT.replace('force = "LAW"', field)
    proofs = stated(text)
    assert all(row["verdict"] == "PROVED" for row in proofs["obligations"])
    assert refused(text, proofs) == {}
    place = proofs["system"] if name == "energy" else proofs["system"]["names"][name]
    key = "energy" if name == "energy" else "law"
    assert old in place[key], place
    place[key] = place[key].replace(old, new, 1)
    assert ("energy", "") in refused(text, proofs)


@pytest.mark.parametrize("force", ["F_0*(q/r)*sinh(q/r)/(q/r)", "k*q - F_0*sin(q/r)/(q/r)*q/r"])
def test_a_force_that_is_zero_by_zero_at_rest_is_confirmed(force):
    text = TEXT.replace("LAW", force)
    proofs = stated(text)
    assert all(row["verdict"] == "PROVED" for row in proofs["obligations"])
    assert refused(text, proofs) == {}
    proofs["system"]["energy"] = proofs["system"]["energy"].replace("cos", "2*cos", 1)
    assert refused(text, proofs).keys() == {("skew", ""), ("energy", "")}


@pytest.mark.some(2)
@pytest.mark.parametrize(
    "force",
    ["F_0*cosh(q/r)*(q/r)/(q/r)", "k*q*(q - s)/(q - s)", "k*max(q + r, 0)*q/q", "k*q*s/s"],
)
def test_a_force_without_a_value_elsewhere_is_not_confirmed(force):
    text = TEXT.replace("LAW", force)
    proofs = forged(TEXT.replace("LAW", "k*q/(1 + (q/r)**2)"))
    assert ("welldef", "spring") in refused(text, proofs)


SLIP = """[model]
name = "slip"
[parameters]
M = { value = 2.0, unit = "kg" }
k = { value = 5.0, unit = "N/m" }
s = { value = 0.2, unit = "m" }
F_0 = { value = 0.7, unit = "N" }
T_0 = { value = 300.0, unit = "K" }
c = { value = 2.0, unit = "J/K" }
[domain]
assume = ["k > 0", "s > 0", "F_0 > 0"]
[elements]
mass = { kind = "mass", at = "a", mass = "M" }
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)" }
[elements.spring]
kind = "spring"
between = ["a", "wall"]
force = "LAW"
state = "q"
slip = "(v if f >= F_0 else 0) if v > 0 else (v if f <= -F_0 else 0)"
heats = "body"
discontinuous = true
"""


def test_a_slip_may_jump_and_the_force_of_its_spring_may_not():
    """Where the force is another at one place, no energy has it as its slope there."""
    text = SLIP.replace("LAW", "k*q + k*max(q - s, 0)")
    proofs = stated(text)
    assert all(row["verdict"] == "PROVED" for row in proofs["obligations"] if row["required"])
    assert refused(text, proofs) == {}
    for more in ("(F_0 if q >= 0 else 0)", "((F_0 if q <= s else 0) if q >= s else 0)"):
        text = SLIP.replace("LAW", f"k*q + {more}")
        proofs = forged(text)
        rows = [row for row in proofs["obligations"] if row["id"] != "continuous"]
        assert refused(text, {**proofs, "obligations": rows})["continuous", "spring"] == "missing"
        assert "does not follow" in refused(text, proofs)["continuous", "spring"]


CAPACITOR = """[model]
name = "capacitor"
[parameters]
C = { value = 0.1, unit = "F" }
L = { value = 0.1, unit = "H" }
Q_0 = { value = 0.2, unit = "C" }
[domain]
assume = ["C > 0", "L > 0", "Q_0 > 0", "Q >= 0"]
[initial]
Q = START
[elements]
coil = { kind = "inductor", between = ["a", "gnd"], inductance = "L", state = "phi" }
cap = { kind = "capacitor", between = ["a", "gnd"], capacitance = "LAW", state = "Q" }
"""


def test_a_capacitance_that_is_zero_at_rest_is_confirmed_beside_it():
    """Its voltage has a value without a charge, too, but the capacitance is positive."""
    text = CAPACITOR.replace("LAW", "C*(Q/Q_0)/cosh(Q/Q_0)").replace("START", "0.1")
    proofs = stated(text)
    assert all(row["verdict"] == "PROVED" for row in proofs["obligations"])
    assert refused(text, proofs) == {}
    assert ("domain", "") in refused(text.replace("Q = 0.1", "Q = 0.0"), proofs)


@pytest.mark.some(1)
@pytest.mark.parametrize("size", ["C*(1 - Q/Q_0)**(1/2)", "C*sqrt((Q_0 - Q)/Q_0)"])
def test_a_capacitance_with_the_root_of_a_sum_has_an_energy(size):
    """The square of a root is its base: the energy has powers 1/2 and 3/2 of it."""
    text = CAPACITOR.replace("Q >= 0", "Q < Q_0").replace("LAW", size).replace("START", "0.0")
    proofs = stated(text)
    assert all(row["verdict"] == "PROVED" for row in proofs["obligations"])
    assert refused(text, proofs) == {}
    energy = proofs["system"]["energy"]
    at = {"C": 0.1, "L": 0.1, "Q_0": 0.2, "phi": 0.0, "sqrt": sqrt}
    rise = eval(energy, {**at, "Q": 0.15}) - eval(energy, {**at, "Q": 0.0})
    assert rise == pytest.approx(quad(lambda Q: Q / (0.1 * sqrt(1 - Q / 0.2)), 0, 0.15)[0])
    proofs["system"]["energy"] = energy.replace("1.5", "2.5", 1)
    assert refused(text, proofs).keys() == {("skew", ""), ("energy", "")}
