import json
import subprocess
import sys

import pytest
from stated import CHECKER, PIEZO_STACK, forged, mass, refused, run, stated

from piezo_sym.checker import InputError, read_spec

TWO_BANKS = """[model]
name = "two_banks"
[parameters]
R = { value = 1.0, unit = "ohm" }
i_1 = { value = 1.0, unit = "A" }
L = { value = 1.0, unit = "H" }
T_0 = { value = 300.0, unit = "K" }
c = { value = 2.0, unit = "J/K" }
[inputs]
V = { unit = "V" }
[domain]
assume = ["R > 0", "i_1 > 0", "phi_h**2 < L*L*i_1*i_1"]
[elements]
supply = { kind = "voltage_source", between = ["in", "gnd"], input = "V" }
[elements.h]
kind = "hysteron"
between = ["in", "gnd"]
count = 2
inductance = "L"
voltage = "R*i"
heats = "body"
[elements.h_j]
kind = "hysteron"
between = ["in", "gnd"]
inductance = "L"
voltage = "R*i*(1 - (i/i_1)**2)"
heats = "body"
state = "phi_2"
[elements.body]
kind = "thermal_mass"
temperature = "T_0*exp(S/c)"
"""
WRONGLY_PROVED = {
    "a root in a branch of a spring": mass(
        "a*v", stiffness="k*(1 + (sqrt(a/a_1) if a > 0 else 0))"
    ),
    "a root in a branch of the domain": mass("a*v", "(sqrt(a/a_1) if a > 0 else 1) >= 0"),
    "the other branch": mass(
        "F_1*v/v_1*(exp(v/v_1) - 2.7*v/v_1) if a > 0 else "
        "F_1*v/v_1*(exp(v/v_1 - 0.37) - 2.72*(v/v_1 - 0.37))",
        unit="1",
    ),
    "an element named like a lane": TWO_BANKS,
}


@pytest.mark.long
@pytest.mark.parametrize("name", WRONGLY_PROVED)
def test_a_law_that_gives_power_is_not_confirmed(name):
    text = WRONGLY_PROVED[name]
    found = refused(text, forged(text))
    element = "h_j" if text is TWO_BANKS else "damper"
    assert "does not follow" in found["passive", element]
    assert ("sigma", "") in found


@pytest.mark.long
def test_a_negative_width_in_the_domain_leaves_no_domain(tmp_path):
    free, width = mass("(a - a_1)*v"), "saturate(a, a_1) < 0"
    text = free.replace('"a_1 > 0"', f'"{width}", "a_1 < 0"').replace(
        "a_1 = { value = 1.0", "a_1 = { value = -1.0"
    )
    text = text.replace("a   = { value = -1.0", "a   = { value = -5.0")
    code, out, _ = run(tmp_path, text, forged(free))
    assert code == 1
    assert "not confirmed domain" in out


CHANGES = {
    "a sign": ("-F_damper - F_spring", "F_damper - F_spring"),
    "two symbols merged": ("V_capacitor*alpha_transducer", "V_capacitor*V_capacitor"),
    "a lane for the sum": ('"sum(hysteron, i_hysteron)"', '"i_hysteron"'),
    "a product of sums": (
        "sum(hysteron, V_hysteron*i_hysteron)/T",
        "sum(hysteron, V_hysteron)*sum(hysteron, i_hysteron)/T",
    ),
    "three sums that vanish for few lanes": (
        '"-V_capacitor - V_hysteron + V_in"',
        '"-V_capacitor - V_hysteron + V_in + sum(hysteron, 1)*(sum(hysteron, 1) - 1)'
        '*(sum(hysteron, 1) - 2)*(sum(hysteron, 1) - 3)"',
    ),
    "an argument": ("deadzone(i_hysteron, i_0)", "deadzone(i_hysteron, 2*i_0)"),
    "a co-state": ('"k*(q - q_l)"', '"k*(q + q_l)"'),
    "an energy": ("phi**2/(2*L)", "phi**2/(2*M)"),
    "the energy of a body": ("T_0*c_0*exp(S/c_0)", "T_0*exp(S/c_0)"),
    "an output": ('"ambient": "T"', '"ambient": "T_e"'),
    "a temperature": ('"T_0*exp(S/c_0)"', '"T_0*exp(2*S/c_0)"'),
    "the other order of states": ('"name": "q"', '"name": "p"'),
    "heat that stays away": ("F_damper*v_mass/T", "0*F_damper*v_mass/T"),
}


@pytest.mark.some(4)
@pytest.mark.parametrize("name", CHANGES)
def test_a_changed_system_is_not_confirmed(name):
    proofs, (old, new) = stated(PIEZO_STACK), CHANGES[name]
    text = json.dumps(proofs["system"])
    assert old in text
    proofs["system"] = json.loads(text.replace(old, new))
    assert ("energy", "") in refused(PIEZO_STACK, proofs)


def test_every_stated_row_is_needed():
    proofs = stated(PIEZO_STACK)
    required = {(r["id"], r["element"] or "") for r in proofs["obligations"] if r["required"]}
    found = refused(PIEZO_STACK, {**proofs, "obligations": []})
    optional = {("welldef", "")}  # divisors of the network, of which the row `system` speaks too
    assert {row for row, why in found.items() if why == "missing"} == required - optional
    some = [r for r in proofs["obligations"] if (r["id"], r["element"]) != ("passive", "damper")]
    found = refused(PIEZO_STACK, {**proofs, "obligations": some})
    assert found["passive", "damper"] == "missing"
    assert ("sigma", "") in found


def test_a_row_that_is_open_or_unknown_is_not_confirmed():
    proofs = stated(PIEZO_STACK)
    proofs["obligations"][0]["verdict"] = "OPEN"
    proofs["obligations"].append({"id": "perpetual", "element": "body", "verdict": "PROVED"})
    found = refused(PIEZO_STACK, proofs)
    assert found == {
        ("skew", ""): "stated as OPEN",
        ("perpetual", "body"): "the checker knows no such row",
    }


@pytest.mark.some(4)
@pytest.mark.parametrize(
    ("law", "row"),
    [
        ("a_1*v if v > v_1 else 2*a_1*v", "continuous"),
        ("a_1*v*(2 + sign(v - v_1))", "continuous"),
        ("a_1*v**2/v", "welldef"),
        ("a_1*v*log(a/a_1)/log(a/a_1)", "welldef"),
        ("F_1*sqrt(v/v_1)", "welldef"),
        ("F_1", "passive"),
        ("F_1*sin(v/v_1)", "passive"),
    ],
)
def test_false_rows_are_not_confirmed(law, row):
    text = mass(law)
    proofs = forged(text)
    if row == "continuous" and not any(r["id"] == row for r in proofs["obligations"]):
        proofs["obligations"].append({"id": row, "element": "damper", "verdict": "PROVED"})
    assert "does not follow" in refused(text, proofs)[row, "damper"]


def test_a_wrong_unit_is_seen():
    text = PIEZO_STACK.replace('unit = "J/K"', 'unit = "K/J"')
    assert "body" in refused(text, forged(PIEZO_STACK))["units", ""]


def test_a_condition_of_two_units_is_seen():
    text = PIEZO_STACK.replace('"d >= 0"', '"d >= T_0"')
    assert "different units" in refused(text, stated(PIEZO_STACK))["units", ""]


@pytest.mark.parametrize(
    "unit", ["m,N*s/m", "m<N", "(m", "m m", "2*m", "m**2**9", "m**10", "", "m*"]
)
def test_odd_units_are_refused(unit):
    with pytest.raises(InputError, match="is no unit"):
        read_spec(PIEZO_STACK.replace('unit = "J/K"', f'unit = "{unit}"'))


BAD = [
    ("", "{}"),
    ("[model", "{}"),
    (PIEZO_STACK, "[]"),
    (PIEZO_STACK.replace('"d*v"', '"d*v*y"'), "{}"),
    (PIEZO_STACK.replace('"d*v"', '"__import__(1)"'), "{}"),
    (PIEZO_STACK.replace('"d*v"', '"' + "(" * 300 + '"'), "{}"),
    (PIEZO_STACK.replace("value = 4e2", "value = 1e999999999"), "{}"),
    (PIEZO_STACK.replace('kind = "damper"', 'kind = "dumper"'), "{}"),
    (PIEZO_STACK.replace("[elements.damper]", '[elements."damper\\nconfirmed sigma"]'), "{}"),
    (PIEZO_STACK.replace("4e2", "nan"), "{}"),
    ("a = " + "[" * 5000, "{}"),
    ("a" + ".a" * 100_000 + " = 1", "{}"),
]


@pytest.mark.parametrize(("spec", "proofs"), BAD)
def test_bad_input_is_refused(spec, proofs):
    with pytest.raises(InputError):
        refused(spec, json.loads(proofs))


def test_bad_input_is_one_line(tmp_path):
    for spec, proofs in ((BAD[1][0], "{}"), (PIEZO_STACK, "[")):
        code, out, error = run(tmp_path, spec, proofs)
        assert (code, out) == (2, "")
        assert len(error.splitlines()) == 1
        assert error.startswith("bad input: ")


def test_without_cvc5_the_program_says_what_to_install():
    text = (
        "import runpy, sys; sys.modules['cvc5'] = None; runpy.run_path(sys.argv[1], {}, '__main__')"
    )
    command = [sys.executable, "-I", "-c", text, str(CHECKER / "__main__.py"), "a.toml", "b.json"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == "cvc5 is not installed: pip install 'piezo_sym[proof]'\n"


@pytest.mark.long
@pytest.mark.parametrize(
    "law", ["a_1*v*exp(exp(exp(exp(exp(v/v_1)))))", "-a_1*v*exp(exp(1e9*v/v_1))"]
)
def test_hostile_functions_end(law):
    text = mass("a_1*v")
    changed = text.replace('"a_1*v"', f'"{law}"')
    assert ("system", "") in refused(changed, forged(text))


@pytest.mark.parametrize(
    "law",
    [
        "a_1*v*((1 + v/v_1)**16 + 1)**16",
        "a_1*v*" + "(1 + " * 40 + "v/v_1" + ")**2" * 40,
        "v**9**9**9",
        "v*" * 400 + "v" * 400,
        "1" * 5000,
    ],
)
def test_hostile_laws_are_refused(law):
    with pytest.raises(InputError):
        read_spec(mass("a_1*v").replace('"a_1*v"', f'"{law}"'))
