"""Laws of foreign states and temperatures whose sign fails somewhere in the domain: none is PROVED.

Where a law is refuted, its witness is checked by numbers typed here, and the condition shown mends.
"""

import math
from fractions import Fraction
from functools import cache

import pytest

from piezo_sym import derive
from piezo_sym.proofs import Verdict, decide
from piezo_sym.spec.load import parse

SPEC = """
[model]
name = "attacked"
[parameters]
R = { value = 2.0, unit = "ohm" }
al = { value = 0.004, unit = "1/K" }
g = { value = 1.0, unit = "m" }
p_1 = { value = 1.0, unit = "kg*m/s" }
Q_1 = { value = 1.0, unit = "C" }
L = { value = 1.0, unit = "H" }
c = { value = 2.0, unit = "J/K" }
T_0 = { value = 300.0, unit = "K" }
one = { value = 1.0, unit = "1" }
lam = { value = 1.0, unit = "W/K" }
[domain]
assume = ["R >= 0", "al >= 0", "g > 0", "p_1 > 0", "Q_1 > 0", "lam >= 0", "T_hot > 0.1*T_0",
    "T_cold > 0.1*T_0"]
[elements]
spring = { kind = "spring", between = ["tip", "wall"], stiffness = "one*L", state = "q" }
mass = { kind = "mass", at = "tip", mass = "one*L", state = "p" }
cap = { kind = "capacitor", between = ["a", "gnd"], capacitance = "one*L", state = "Q" }
coil = { kind = "inductor", between = ["a", "b"], inductance = "L" }
hot = { kind = "thermal_mass", temperature = "T_0*exp(S/c)" }
cold = { kind = "thermal_mass", temperature = "T_0*exp(S/c)" }
wire = { kind = "resistor", between = ["b", "gnd"], voltage = "R*i*(WIRE)", heats = "hot",
    discontinuous = true }
contact = { kind = "conduction", between = ["hot", "cold"], conductance = "lam*(CONTACT)" }
""".replace(",\n    discontinuous", ", discontinuous")
FACTORS = """
1 + q/g; 1 - q**2/g**2; q/g + 0.5; tanh(q/g); sin(q/g); 1 + p/p_1; 1 + Q/Q_1; 1 - T_hot/T_cold
(T_cold - T_0)/T_0; T_hot/T_cold - 0.5; 1 + al*(T_cold - T_0); 2 - exp(q/g); 2 - T_hot/T_0
log(T_hot/T_0); sqrt(T_cold/T_0) - 1; 1 if q > -g else -1; max(q/g, -0.001); min(1, 1 + q/g)
1 - abs(q)/g; deadzone(q, g)/g; 1 - 0.001*(T_hot/T_cold)**2; q**3/g**3 + 1; (q/g)*(T_cold/T_0)
1 + q*p/(g*p_1); cos(q/g); 1 + S_hot/c; 1 - S_cold**2/c**2; atan(1 + q/g); saturate(q/g, 1)
(T_hot*T_hot - T_cold*T_0)/T_0**2; 1 - 0.000001*q**2/g**2; exp(-q/g) - 0.000000001
1 - 0.001*exp(T_hot/T_0); q/g if T_hot > T_cold else 1; 1 if T_hot > T_cold else q/g; sign(q)
(1 + q/g)**3; 0.4 + sin(q/g) - 1.5*abs(tanh(p/p_1)); Q/Q_1 + q/g + 3;
table(q/g, -1, -0.1, 0, 1, 1, 1); (1 - q/g)*(1 + q/g + Q/Q_1)
"""
WIRES = [f.strip() for f in FACTORS.replace("\n", ";").split(";") if f.strip()]


@cache
def rows(wire="1", contact="1"):
    return decide(derive(parse(SPEC.replace("WIRE", wire).replace("CONTACT", contact)))).rows


def row(found, name, element):
    return next(r for r in found if (r.id, r.element) == (name, element))


def value(law, witness):
    """Return a law at a witness, by Python's own arithmetic; names left out are 0 or 1."""
    names = dict.fromkeys(("q", "p", "Q"), 0.0) | dict.fromkeys(("R", "al", "g", "lam", "T_0"), 1.0)
    names |= {"p_1": 1.0, "Q_1": 1.0, "c": 1.0, "i": 1.0}
    names |= {name: float(Fraction(number)) for name, number in witness.items()}
    known = {n: getattr(math, n) for n in ("exp", "log", "sin", "cos", "tanh", "atan", "sqrt")}
    known |= {"deadzone": lambda z, w: max(z - w, 0) + min(z + w, 0), "abs": abs}
    known |= {"saturate": lambda z, w: min(max(z, -w), w), "max": max, "min": min}
    known |= {"sign": lambda z: (z > 0) - (z < 0)}
    return eval(law, {"__builtins__": {}}, known | names)


@pytest.mark.some(1)
@pytest.mark.parametrize("factor", WIRES)
def test_a_law_whose_sign_fails_is_not_proved(factor):
    """Neither the resistor's law, nor the conductance with the same factor."""
    both = rows(factor, factor)
    for element, law in (("wire", f"R*i*({factor})*i"), ("contact", f"lam*({factor})")):
        found = row(both, "passive", element)
        assert found.verdict is not Verdict.PROVED
        if found.verdict is Verdict.REFUTED and "table" not in factor:
            assert value(law, found.witness) < 0


@pytest.mark.long
def test_few_of_them_stay_open():
    verdicts = [row(rows(f, f), "passive", "wire").verdict for f in WIRES[:12]]
    assert verdicts == [Verdict.REFUTED] * 12


TEXTBOOK = SPEC.replace('"al >= 0", ', "").replace("T_hot > 0.1*T_0", "one > 0")


def textbook(extra=""):
    text = TEXTBOOK.replace("WIRE", "1 + al*(T_cold - T_0)").replace("CONTACT", "1")
    text = text.replace('"R >= 0"', f'"R >= 0"{extra}')
    return row(decide(derive(parse(text))).rows, "passive", "wire")


def test_the_textbooks_resistance_is_refuted_and_the_condition_that_mends_it_is_shown():
    found = textbook()
    assert found.verdict is Verdict.REFUTED
    assert value("R*i*(1 + al*(T_cold - T_0))*i", found.witness) < 0
    assert "the condition '1 + al*(T_cold - T_0) >= 0' in [domain] mends it" in found.reason
    assert textbook(', "1 + al*(T_cold - T_0) >= 0"').verdict is Verdict.PROVED


@pytest.mark.some(1)
@pytest.mark.parametrize(
    ("wire", "condition"),
    [
        ("1 + q/g", "1 + q/g >= 0"),
        ("(1 + q/g)*(T_cold/T_0 - 1)", "(1 + q/g)*(T_cold/T_0 - 1) >= 0"),
        ("-T_cold/T_0", ""),
    ],
)
def test_a_condition_that_mends_is_shown_without_what_the_domain_says(wire, condition):
    found = row(rows(wire=wire), "passive", "wire")
    assert found.verdict is Verdict.REFUTED
    assert (f"the condition '{condition}' in" in found.reason) == bool(condition)
    assert ("mends" in found.reason) == bool(condition)


def test_a_letter_tied_to_a_state_that_the_law_reads_is_no_free_number():
    """Its power v**3*Q is not negative, for v = Q/C has the sign of Q."""
    text = SPEC.replace("WIRE", "1").replace("CONTACT", "1")
    leak = 'leak = { kind = "resistor", between = ["a", "gnd"], heats = "hot", current = "LAW" }\n'
    text += leak.replace("LAW", "v**2*Q/(R*Q_1)")
    found = row(decide(derive(parse(text.replace('"R >= 0"', '"R > 0"')))).rows, "passive", "leak")
    assert found.verdict is Verdict.PROVED
