"""Ordinary laws of springs: every row that is proved is confirmed, and no other energy is."""

import pytest

from tests.checker.stated import forged, refused, stated
from tests.energies.kinked import TEXT

SPRING = TEXT.replace('"n > 0"]', '"n > 0", "s > r"]').replace("value = 0.2", "value = 0.9")
#: Laws of force, of their energies a part, and what is put in its place.
LAWS = (
    ("k*q/sqrt(1 + (q/r)**2)", "q**2 + r**2", "2*q**2 + r**2"),
    ("k*q/(1 + (q/r)**2 + (q/r)**4)", " + sqrt(3)/3)", " + sqrt(3)/2)"),
    ("k*q/(1 + (q/r)**6)", "q**4", "2*q**4"),
    ("2*k*r*(1 - exp(-q/r))*exp(-q/r)", "exp((-2)*q/r)", "exp((-3)*q/r)"),
    ("saturate(3*k*q, k*r) + k*q", "k*q**2/2", "k*q**2"),
    ("max(k*q, 3*k*q - 2*k*r)", "- 2*k*r*q", "- 2.5*k*r*q"),
    ("max(k*q, 3*k*q - 2*k*r)", "(k*q**2/2 if", "(k*q**2/2 + k*r*r if"),
    ("table(q, -s, -2*k*s, -r, -k*r, r, k*r, s, 2*k*s)", "- k*r*r", "- 2*k*r*r"),
    ("table(q, -s, -2*k*s, -r, -k*r, r, k*r, s, 2*k*s)", "/(-r + s)", "/(r + s)"),
)


@pytest.mark.some(2)
@pytest.mark.parametrize("law", dict.fromkeys(law for law, *_ in LAWS))
def test_laws_of_springs_are_confirmed(law):
    text = SPRING.replace("LAW", law)
    proofs = stated(text)
    assert all(row["verdict"] == "PROVED" for row in proofs["obligations"])
    assert refused(text, proofs) == {}


@pytest.mark.some(1)
@pytest.mark.parametrize(("law", "old", "new"), LAWS)
def test_another_energy_is_not_confirmed(law, old, new):
    text = SPRING.replace("LAW", law)
    proofs = stated(text)
    energy = proofs["system"]["energy"]
    assert old in energy, energy
    proofs["system"]["energy"] = energy.replace(old, new, 1)
    assert ("energy", "") in refused(text, proofs)


@pytest.mark.some(2)
@pytest.mark.parametrize(
    ("energy", "law"),
    [
        ("k*r*sqrt((q - r)**2)", "k*r"),  # on one side only
        ("k*r**2*exp(q/r)*exp(-q/r)", "k*r*exp(q/r)"),
        ("k*r**2*exp(2*q/r)", "k*r*exp(q/r)**2"),
        ("k*r**2*exp(q**2/r**2)", "2*k*q*exp(q/r)**2"),
    ],
)
def test_roots_and_exponentials_are_not_mixed_up(energy, law):
    text = SPRING.replace("LAW", law)
    proofs = forged(text)
    old = proofs["system"]["energy"]
    proofs["system"]["energy"] = f"p**2/(2*M) + {energy}"
    assert old != proofs["system"]["energy"]
    assert ("energy", "") in refused(text, proofs)


def test_an_energy_without_a_value_takes_the_row_of_its_values():
    text = SPRING.replace("LAW", "saturate(3*k*q, k*r) + k*q")
    proofs = stated(text)
    assert "/(3*k)" in proofs["system"]["energy"]
    proofs["system"]["energy"] += " + 0*log(k - r)"
    assert refused(text, proofs).keys() >= {("energy", "")}
    proofs = stated(text)
    proofs["system"]["energy"] = proofs["system"]["energy"].replace("k*q**2/2", "k*q**3/2/q")
    assert refused(text, proofs).keys() >= {("energy", ""), ("welldef", "spring")}


COILS = """[model]
name = "coils"
[parameters]
C = { value = 1.0, unit = "F" }
L = { value = 1.0, unit = "H" }
w = { value = 1.0, unit = "Wb" }
[domain]
assume = ["C > 0", "L > 0", "w > 0"]
[elements.c]
kind = "capacitor"
between = ["e", "gnd"]
capacitance = "C"
[elements.coil]
kind = "inductor"
between = ["e", "gnd"]
current = "phi/L/sqrt(1 + (phi/w)**2)"
count = 3
"""


@pytest.mark.long
@pytest.mark.parametrize(
    ("old", "new"),
    [("", ""), ("w*sqrt", "2*w*sqrt"), ("sqrt(", "sqrt(w*w + "), ("sum(", "sum(coil, 1)*sum(")],
)
def test_roots_in_banks_are_compared_in_each_lane(old, new):
    proofs = stated(COILS)
    energy = proofs["system"]["energy"]
    assert old in energy
    proofs["system"]["energy"] = energy.replace(old, new, 1)
    assert (("energy", "") in refused(COILS, proofs)) == bool(new)


@pytest.mark.parametrize("rest", ["", 'rest = "s", '])
def test_a_size_that_is_zero_by_zero_at_rest_is_confirmed(rest):
    text = SPRING.replace('force = "LAW"', f'{rest}stiffness = "k*sinh((q - s)/r)*r/(q - s)"')
    text = text if rest else text.replace("(q - s)", "q")
    proofs = stated(text)
    assert all(row["verdict"] == "PROVED" for row in proofs["obligations"])
    assert refused(text, proofs) == {}
    proofs["system"]["energy"] = proofs["system"]["energy"].replace("cosh", "sinh", 1)
    assert refused(text, proofs).keys() == {("skew", ""), ("energy", "")}


@pytest.mark.parametrize(
    "stiffness",
    [
        "k*sinh(q/r)*r/(q - s)",
        "k*sinh(q/r)*r**2/(q*q)",
        "k*sinh(q/r)*r**2/q**2",
        "k*log(q/r)*r/q",
        "k*q/max(q, 0)",
    ],
)
def test_a_size_without_a_value_elsewhere_is_not_confirmed(stiffness):
    text = SPRING.replace('force = "LAW"', f'stiffness = "{stiffness}"')
    proofs = stated(SPRING.replace("LAW", "k*r*sinh(q/r)"))
    row = {"id": "welldef", "element": "spring", "verdict": "PROVED"}
    proofs["obligations"] += [row, {**row, "element": None}]
    assert ("welldef", "spring") in refused(text, proofs)


@pytest.mark.parametrize("size", ["max(q + r, 0)*r/q", "cosh(q/r)*r/q", "(q + s)/q"])
def test_a_size_that_is_infinite_at_rest_is_not_confirmed(size):
    text = SPRING.replace('"n > 0"', '"n > 0", "q >= 0"') + "[initial]\nq = 0.1\n"
    proofs = forged(text.replace("LAW", "k*q"))
    text = text.replace('force = "LAW"', f'stiffness = "k*{size}"')
    assert refused(text, proofs).keys() & {("domain", ""), ("welldef", "spring")}
