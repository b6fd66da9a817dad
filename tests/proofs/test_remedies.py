"""Remedies that messages show, put into the spec as they stand: all rows are PROVED with them."""

import re

import pytest

from piezo_sym import PiezoError, derive, verify
from piezo_sym.proofs import Verdict, decide
from piezo_sym.spec.load import parse

SPEC = """
[model]
name = "circuit"
[parameters]
L = { value = 0.5, unit = "H" }
C = { value = 0.1, unit = "F" }
R = { value = 2.0, unit = "ohm" }
c = { value = 2.0, unit = "J/K" }
T_0 = { value = 300.0, unit = "K" }
al = { value = 1e-3, unit = "1/K" }
k = { value = 5.0, unit = "N/m" }
m = { value = 0.1, unit = "kg" }
x_0 = { value = 1.0, unit = "m" }
phi_s = { value = 1.0, unit = "Wb" }
i_s = { value = 1.0, unit = "A" }
F_c = { value = 1.0, unit = "N" }
h = { value = 1.0, unit = "W/K" }
[inputs]
T_e = { unit = "K", default = 320.0 }
[domain]
assume = ["R >= 0"]
[elements]
coil = { kind = "inductor", between = ["a", "gnd"], inductance = "L", state = "phi" }
cap = { kind = "capacitor", between = ["a", "b"], capacitance = "C", state = "Q" }
res = { kind = "resistor", between = ["b", "gnd"], voltage = "R*i", heats = "body" }
spring = { kind = "spring", between = ["tip", "wall"], stiffness = "k", state = "q" }
mass = { kind = "mass", at = "tip", mass = "m" }
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)", state = "S" }
"""
HEATED = """
[elements.body]
kind = "storage"
energy = "ENERGY"
[elements.body.states]
S = { rate = "entropy" }
Q = { rate = "current", between = ["a", "b"] }
"""
LEVER = """
load = { kind = "mass", at = "end", mass = "m" }
lever = { kind = "lever", first = ["tip", "wall"], second = ["end", "wall"], ratio = "1 + q/x_0" }
"""


def without(*elements, text=SPEC):
    lines = text.splitlines()
    return "\n".join(line for line in lines if line.split(" = ")[0] not in elements) + "\n"


def assuming(text, conditions):
    return text.replace('assume = ["R >= 0"', f'assume = ["R >= 0", {conditions}')


def unproved(text):
    rows = (row for row in verify(derive(parse(text))).rows if row.required)
    return [row for row in rows if row.verdict is not Verdict.PROVED]


HEATED_BY = without("cap", "body") + HEATED
SHARED = """
res.kind = "resistor"
res.between = ["b", "n"]
res.voltage = "R*(1 + al*(T - T_0))*i"
res.heats = "body"
iron = { kind = "resistor", between = ["n", "gnd"], current = "v/R*T_0/T", heats = "body" }
"""
REFUTED = {
    "two resistors of one current": assuming(without("res") + SHARED, '"R > 0"'),
    "a body that is cold": SPEC.replace("T_0*exp(S/c)", "T_0*(1 + S/c)"),
    "heat that is a polynomial": HEATED_BY.replace(
        "ENERGY", "c*T_0*(S/c + (S/c)**2/2) + Q**2/(2*C)"
    ),
    "a capacitance that rises": HEATED_BY.replace(
        "ENERGY", "T_0*c*exp(S/c) + Q**2/(2*C)*(1 - S/c)"
    ),
    "a lever that turns round": without("mass") + LEVER,
    "a coil with a pole": SPEC.replace(
        'inductance = "L"', 'current = "i_s*phi/(phi_s - abs(phi))"'
    ),
    "a drive of a logarithm": SPEC.replace('"R*i"', '"R*i_s*log(1 + i/i_s)"'),
    "an energy that divides": SPEC.replace('stiffness = "k"', 'force = "saturate(k*q, F_c)"'),
    "another one": SPEC.replace('stiffness = "k"', 'force = "deadzone(k*q, F_c) + k*q"'),
    "one of a product": SPEC.replace(
        'stiffness = "k"', 'force = "max(k*(q - x_0), 0) + min(k*(q + x_0), 0)"'
    ),
}


@pytest.mark.some(1)
@pytest.mark.parametrize("name", REFUTED)
def test_the_conditions_that_mend_a_row_do(name):
    text = REFUTED[name]
    for _ in range(3):  # a row may be refuted once another one holds
        rows = unproved(text)
        refuted = [r for r in rows if r.verdict is Verdict.REFUTED or "; the condition" in r.reason]
        if not refuted:
            break
        said = [
            re.search(r"; the conditions? ('.*) in \[domain\] mends? it", r.reason) for r in refuted
        ]
        assert all(said)
        more = {condition for found in said for condition in found[1].split("'")[1::2]}
        text = assuming(text, ", ".join(f'"{condition}"' for condition in more))
    assert not unproved(text)


SIGNED = {
    "R*i**2/i_s": "write i*abs(i) for i**2, whose sign is not that of i",
    "R*abs(i)": "write i for abs(i), whose sign is not that of i",
    "R*i*(i/i_s)**3 + R*i**4/i_s**3": "write i**3*abs(i) for i**4, whose sign is not that of i",
    "R*sqrt(i_s)*sqrt(i)": "for both signs of i, write sign(i)*sqrt(abs(i)) for sqrt(i)",
    "R*i_s*sqrt(2*i/i_s)": "both signs of i, write sign(i)*sqrt(2*abs(i)/i_s) for sqrt(2*i/i_s)",
}


@pytest.mark.some(2)
@pytest.mark.parametrize("law", SIGNED)
def test_a_law_that_loses_the_sign_of_its_letter_is_told_the_one_that_does_not(law):
    text = assuming(SPEC, '"i_s > 0"')
    (said,) = (
        found[0]
        for row in unproved(text.replace("R*i", law))
        if (found := re.search(r"write .* for [^,;]*", row.reason))
    )
    assert said in SIGNED[law]
    new, old = re.match("write (.*) for (.*)", said).groups()
    assert not unproved(text.replace("R*i", law.replace(old, new)))


def test_the_root_in_a_store_has_a_form_for_both_signs():
    """To keep the flux above 0, as its condition does, stops every run under a sine."""
    law = "phi/L*(1 + (phi/phi_s)**1.5)"
    text = assuming(SPEC, '"phi_s > 0", "L > 0"')
    rows = unproved(text.replace('inductance = "L"', f'current = "{law}"'))
    said = next(filter(None, (re.search(r"write (.*?) for ([^;]*);", r.reason) for r in rows)))
    assert said.groups() == ("(abs(phi)/phi_s)**1.5", "(phi/phi_s)**1.5")
    assert not unproved(
        text.replace('inductance = "L"', f'current = "{law.replace(said[2], said[1])}"')
    )


@pytest.mark.parametrize(
    "law", ["R*i*abs(i) - F_c*R/T_0", "R*i*sqrt(1 - (i/i_s)**2)", "R*i**2*abs(i)*i/i_s**3 - R*i"]
)
def test_no_other_sign_is_offered_that_does_not_mend_a_law(law):
    assert not any("; write " in row.reason for row in unproved(SPEC.replace("R*i", law)))


@pytest.mark.some(2)
@pytest.mark.parametrize(
    ("old", "new", "left_out"),
    [
        ("T_0*exp(S/c)", "T_0*(1 + S/c)", "1 + S/c > -1"),
        ('inductance = "L"', 'current = "i_s*phi/(phi_s - abs(phi))"', "phi_s - phi > 0"),
        ('"R*i"', '"R*i_s*log(1 + i/i_s)"', '2 + phi/L/i_s > 0", "i_s > 0'),
    ],
)
def test_less_than_these_conditions_is_not_enough(old, new, left_out):
    rows = decide(derive(parse(assuming(SPEC.replace(old, new), f'"{left_out}"')))).rows
    assert any(row.verdict is Verdict.REFUTED for row in rows)


WARM = [
    ("cap", 'capacitance = "C"', 'capacitance = "C*(1 + al*(T - T_0))"'),
    ("cap", 'capacitance = "C"', 'capacitance = "C*exp(al*(T - T_0))"'),
    ("cap", 'capacitance = "C"', 'voltage = "Q/C*(1 + al*(T_body - T_0))"'),
    ("spring", 'stiffness = "k"', 'stiffness = "k*T/T_0"'),
    ("spring", 'stiffness = "k"', 'stiffness = "k*(1 - al*(T - T_0))"'),
]


def shown(store, old, new):
    """Return the element and the conditions that the message on such a store shows."""
    with pytest.raises(PiezoError) as caught:
        derive(parse(SPEC.replace(old, new)))
    said = rf"in place of '{store}' and 'body': (body = .*), and add to assume in \[domain\]: (.*)$"
    return re.search(said, str(caught.value)).groups()


@pytest.mark.some(2)
@pytest.mark.parametrize(("store", "old", "new"), WARM)
def test_the_storage_that_is_shown_is_proved(store, old, new):
    element, conditions = shown(store, old, new)
    assert not unproved(assuming(without(store, "body") + element, conditions))


@pytest.mark.some(1)
@pytest.mark.parametrize(("store", "old", "new"), WARM[::2])
def test_without_its_last_condition_it_is_not(store, old, new):
    element, conditions = shown(store, old, new)
    text = assuming(without(store, "body") + element, conditions.rpartition(", ")[0])
    assert any(row.verdict is not Verdict.PROVED for row in decide(derive(parse(text))).rows)


def test_of_conditions_that_imply_each_other_the_short_one_is_said():
    text = assuming(HEATED_BY.replace("ENERGY", "k*x_0**2*exp(S/c)*exp(Q**2/(2*C*i_s))"), "")
    text = text.replace(
        'i_s = { value = 1.0, unit = "A" }', 'i_s = { value = 1.0, unit = "V*A*s" }'
    )
    text = text.replace('"R >= 0"', '"R >= 0", "c > 0", "C > 0", "i_s > 0"')
    (row,) = (row for row in unproved(text) if row.id == "temperature")
    assert row.reason.endswith("the condition 'x_0 > 0' in [domain] mends it")


def test_two_rows_of_one_cause_say_one_condition():
    text = SPEC.replace("[inputs]", 'n = { value = 2.0, unit = "1" }\n[inputs]')
    rows = unproved(text + LEVER.replace("1 + q/x_0", "n"))
    said = {row.reason.partition("; ")[2] for row in rows if row.verdict is Verdict.REFUTED}
    assert said == {"the condition 'n > 0' in [domain] mends it"}


def test_an_input_without_a_default_is_told_to_have_one():
    text = SPEC.replace(", default = 320.0", "") + AIR.replace("LAW", "h")
    found = {row.id: row.reason for row in verify(derive(parse(text))).rows}
    more = "; input T_e is 0, as it has no other default: give it one (default = 293.15)"
    assert f"the values of the spec do not satisfy them{more}" in found["exergy"]


AIR = 'air = { kind = "ambient", body = "body", conductance = "LAW", input = "T_e" }\n'
WARM_AIR = assuming(SPEC + AIR, '"T_e > 0", "h >= 0"')
JUMPS = {
    "a force of a spring": (
        SPEC.replace('stiffness = "k"', 'force = "LAW"'),
        "k*q if q < x_0 else k*q + F_c",
        "k*q if q < x_0 else k*q + k*(q - x_0)",
    ),
    "a conductance": (WARM_AIR, "h if T < T_0 else 2*h", "h if T < T_0 else h + h*al*(T - T_0)"),
    "a temperature": (
        SPEC.replace("T_0*exp(S/c)", "LAW"),
        "T_0*exp(S/c) if S < 0 else 2*T_0*exp(S/c)",
        "T_0*exp(S/c) if S < 0 else T_0 + T_0*S/c",
    ),
}


@pytest.mark.some(1)
@pytest.mark.parametrize("name", JUMPS)
def test_what_must_not_jump_is_told_to_meet(name):
    text, jumps, meets = JUMPS[name]
    text = assuming(text, '"al >= 0", "F_c >= 0"')
    reasons = [row.reason for row in unproved(text.replace("LAW", jumps))]
    assert any("only a law of dissipation may jump: let the two branches" in r for r in reasons)
    assert not any("discontinuous" in reason for reason in reasons)
    assert not unproved(text.replace("LAW", meets))


def test_of_conditions_that_the_values_break_that_is_said():
    lever = LEVER.splitlines()[-1].replace("1 + q/x_0", "q/x_0")
    text = SPEC.replace('["tip", "wall"], stiffness', '["end", "wall"], stiffness') + lever
    (row,) = (row for row in unproved(assuming(text, '"x_0 > 0"')) if row.id == "welldef")
    said = "the condition 'q > 0' in [domain] would mend it, but the values of the spec do not"
    assert said in row.reason
    worse = SPEC.replace("R = { value = 2.0", "R = { value = -2.0")
    for text, value in ((SPEC, "it"), (worse, "it, but the values of the spec do not satisfy it")):
        (row,) = (row for row in unproved(text.replace('"R >= 0"', "")) if row.id == "passive")
        said = f"'R >= 0' in [domain] {'mends' if text == SPEC else 'would mend'} {value}"
        assert row.reason.endswith(said)


@pytest.mark.parametrize(
    ("known", "said"),
    [
        ('"R >= 0"', "-1; check the sign of the law"),
        ('"R > 0"', "-1; check the sign of the law"),
        ("", "the values of the spec do not satisfy it; check the sign of the law"),
    ],
)
def test_of_a_law_of_the_wrong_sign_that_is_said(known, said):
    text = SPEC.replace('"R >= 0"', known).replace('"R*i"', '"-R*i"')
    (row,) = (row for row in unproved(text) if row.id == "passive")
    assert row.verdict is Verdict.REFUTED
    assert row.reason.endswith(said)


STRIBECK = ("R*i*(1 - n*exp(-(i/i_s)**2))", "R*i_s*tanh(i/i_s)*(1 - n*exp(-abs(i)/i_s))")


@pytest.mark.long
@pytest.mark.parametrize("law", STRIBECK)
def test_conditions_that_the_values_satisfy_are_said_rather_than_others(law):
    """It said -R*n >= 0, of the sum of two terms; n = 1 satisfies n <= 1."""
    text = SPEC.replace("[inputs]", 'n = { value = 1.0, unit = "1" }\n[inputs]')
    text = assuming(text, '"i_s > 0", "n <= MOST"')
    text = text.replace('"R*i"', f'"{law}"')
    (row,) = (row for row in unproved(text.replace("MOST", "1.01")) if row.id == "passive")
    assert row.reason.endswith("; the condition 'n <= 1' in [domain] mends it")
    assert not unproved(text.replace("MOST", "1"))


@pytest.mark.long
def test_conditions_on_parameters_are_said_rather_than_on_states():
    """No run leaves them; and a margin that divides by w is not PROVED where w may be 0."""
    given = 'w = { value = 1.0, unit = "C" }\nd_c = { value = 2.0, unit = "ohm" }\n[inputs]'
    law = "(R + d_c*min(max(Q - w, 0)/w, 1))*i"
    text = assuming(SPEC.replace("[inputs]", given).replace('"R*i"', f'"{law}"'), '"w > 0"')
    (row,) = (row for row in unproved(text) if row.id == "passive")
    assert row.reason.endswith("; the condition 'd_c >= 0' in [domain] mends it")
    assert not unproved(assuming(text, '"d_c >= 0"'))
    (row,) = unproved(assuming(text, f'"{law.removesuffix("*i")} >= 0"'))
    assert row.id == "program"
    assert "write that condition without division" in row.reason


@pytest.mark.parametrize(
    ("temperature", "known"),
    [("T_0*(1 - S/c)", "T > 0"), ("T_0*(2 + S/c) if S > 0 else T_0*exp(S/c)", "c > 0")],
)
def test_no_condition_is_shown_that_domain_cannot_have(temperature, known):
    """-1 > 0 holds nowhere, and [domain] takes no equation of two branches."""
    text = assuming(SPEC.replace("T_0*exp(S/c)", temperature), f'"{known}"')
    (row,) = (row for row in unproved(text) if row.id == "temperature")
    assert row.verdict is Verdict.REFUTED
    assert "in [domain]" not in row.reason


@pytest.mark.some(1)
@pytest.mark.parametrize(
    ("text", "said"),
    [
        (
            SPEC.replace("T_0*exp(S/c)", "T_0*(2 - S/c)"),
            "dT/dS has to be positive, and is -150 for the values of the spec: let the temperature "
            "rise with S, as exp(S/c) does",
        ),
        (
            HEATED_BY.replace("ENERGY", "c*T_0*exp(-S/c) + Q**2/(2*C)"),
            "T = dU/dS has to be positive, and is -300 for the values of the spec: let the energy "
            "rise with S, as exp(S/c) does",
        ),
        (
            HEATED_BY.replace("ENERGY", "T_0*S + Q**2/(2*C)"),
            "dT/dS has to be positive, and is 0 for the values of the spec: let the temperature "
            "rise with S, as exp(S/c) does",
        ),
    ],
)
def test_of_what_falls_with_entropy_no_contradictory_conditions_are_said(text, said):
    (row,) = (row for row in unproved(text) if row.id == "temperature")
    assert row.reason.endswith(f"; {said}")
    more = '"c > 0", "C > 0", "T_0 > 0"'
    text = assuming(text, more).replace("exp(-S/c)", "exp(S/c)").replace("(2 - S/c)", "exp(S/c)")
    assert not unproved(text.replace("T_0*S +", "T_0*c*exp(S/c) +"))


@pytest.mark.long
def test_no_condition_is_looked_for_where_there_are_thousands_of_questions():
    """Two tables with parameters for knots have 7000 pieces of their product: it took minutes."""
    table = "table(q/{}, -2, -3, -b, -n, b, n, 2, 3)"
    law = f'force = "k*x_0*{table.format("x_0")}*{table.format("x_1")}"'
    more = 'x_1 = { value = 0.2, unit = "m" }\nn = { value = 1.5, unit = "1" }\n'
    more += 'b = { value = 0.5, unit = "1" }\n[inputs]'
    text = SPEC.replace("[inputs]", more).replace('stiffness = "k"', law)
    (row,) = (row for row in unproved(text) if row.id == "welldef")
    assert row.reason == "-2 < -b in a table is false: -2 and -2"
