"""``piezo-sym verify``: a table to read, rows to parse, and an exit code."""

import json

import pytest

from piezo_sym import simulate, sine
from piezo_sym.errors import InputWarning

KEYS = ["model", "id", "element", "verdict", "witness", "reason"]


def rows_of(answer):
    return json.loads(answer.out)


def test_a_proved_model_is_exit_code_0(call):
    answer = call("verify", "piezo_stack")
    assert (answer.code, answer.err) == (0, "")
    assert "piezo_stack: " in answer.out
    for word in ("skew", "casimir", "energy", "entropy", "temperature", "PROVED"):
        assert word in answer.out


def test_json_rows_have_the_keys_of_the_contract(call):
    rows = rows_of(call("verify", "piezo_stack", "--json"))
    assert all(list(row) == KEYS for row in rows)
    assert {row["model"] for row in rows} == {"piezo_stack"}
    assert [row["element"] for row in rows if row["id"] == "temperature"] == ["body"]
    assert [row["element"] for row in rows if row["id"] == "energy"] == [None]


def test_several_specs_are_one_list(call, spec_file):
    rows = rows_of(call("verify", "piezo_stack", spec_file(), "--json"))
    assert list(dict.fromkeys(row["model"] for row in rows)) == ["piezo_stack", "mine"]


def test_what_is_not_proved_is_exit_code_1(call, unproved):
    answer = call("verify", unproved, "--json")
    failed = [row for row in rows_of(answer) if row["verdict"] != "PROVED"]
    assert answer.code == 1
    first, *others = failed
    assert (first["id"], first["element"], first["verdict"]) == ("passive", "damper", "REFUTED")
    assert first["witness"] == {"d": "-1", "v": "1"}
    assert {row["id"] for row in others} == {"sigma", "exergy", "environment", "invariant"}


def test_the_table_says_why_something_is_not_proved(call, unproved):
    answer = call("verify", unproved)
    assert answer.code == 1
    assert "passive of damper: d*v*v = -1" in answer.out


def test_no_line_is_wrapped_in_a_pipe(call, spec_file, monkeypatch):
    """A reason and a row are one line each, whatever the width of the terminal."""
    monkeypatch.setenv("COLUMNS", "40")
    longer, name = "conductance_of_the_damper_of_it", "n" * 30
    path = spec_file('"d >= 0", ', "")
    text = path.read_text().replace("\nd    =", f"\n{longer} =").replace('"d*v"', f'"{longer}*v"')
    path.write_text(text.replace('name   = "mine"', f'name = "{name}"'))
    answer = call("verify", path)
    lines = answer.out.splitlines()
    assert lines[0].startswith(f"{name}: ")
    assert "REFUTED" in lines[0]
    why = f"{longer}*v*v = -1; the condition '{longer} >= 0' in [domain] mends it"
    assert f"passive of damper: {why}" in lines


def test_one_model_that_is_not_proved_is_enough(call, unproved):
    assert call("verify", unproved, "piezo_stack").code == 1


GYRATOR = """
[model]
name = "gyrator"
[parameters]
m = { value = 1.0, unit = "kg" }
I = { value = 1.0, unit = "kg*m**2" }
K = { value = 3.0, unit = "N/A" }
L = { value = 1e-3, unit = "H" }
[elements]
coil = { kind = "inductor", between = ["gnd", "a"], inductance = "L" }
"""
TRANSDUCER = """
mass = { kind = "mass", at = "x", mass = "m" }
k = { kind = "transducer", electrical = ["a", "gnd"], mechanical = ["x", "wall"], ratio = "K" }
"""
MOTOR = """
rotor = { kind = "inertia", at = "x", inertia = "I" }
k = { kind = "motor", electrical = ["a", "gnd"], rotation = ["x", "frame"], constant = "K" }
"""
WRONG = {
    "a force per current": (
        GYRATOR + TRANSDUCER,
        "K is N/A, a transducer ratio [C/m] is needed; check the unit of K: C/m would fit; "
        "a motor takes N/A",
    ),
    "a torque per current": (
        GYRATOR.replace("N/A", "N*m/A") + TRANSDUCER,
        "K is N*m/A, a transducer ratio [C/m] is needed; check the unit of K: C/m would fit; "
        "a motor takes N*m/A on rotation",
    ),
    "a force that turns": (
        GYRATOR + MOTOR,
        "K is N/A, a motor constant [N*m/A] is needed; check the unit of K: N*m/A would fit; "
        "a motor takes N/A on translation",
    ),
}


def test_kinds_of_other_domains_are_not_offered(call, tmp_path):
    path = tmp_path / "gyrator.toml"
    path.write_text(GYRATOR.replace('"N/A"', '"m"') + TRANSDUCER)
    assert "a rack takes" not in call("verify", path).out


@pytest.mark.parametrize(("text", "said"), WRONG.values(), ids=WRONG)
def test_a_ratio_of_another_unit_is_said_before_what_follows_from_it(call, tmp_path, text, said):
    """That the ratio may be zero, and the two stores then are not one, is said after it."""
    path = tmp_path / "gyrator.toml"
    path.write_text(text)
    table, _, why = call("verify", path).out.partition("program")
    first, *others = why.splitlines()[2:]
    field = "ratio" if "transducer" in said else "constant"
    assert first == f"units of k: elements.k.{field}: {said}"
    zero = "alpha_k != 0: the junction laws divide by it"
    assert table.count(zero) == (field == "ratio")
    assert others[:1] == ["welldef: K = 0; the condition 'K > 0' in [domain] mends it"] * (
        field == "ratio"
    )
    for command in (("generate", path, "--out", tmp_path), ("simulate", path, "--duration", "1")):
        answer = call(*command)
        assert answer.code == 1
        assert f"gyrator.k: units is REFUTED: elements.k.{field}: {said}; expected" in answer.err


def test_a_parameter_without_effect_is_a_line(call, spec_file):
    unused = 'F_2 = { value = 1.0, unit = "N" }\nV_m = { value = 1e6, unit = "V" }'
    spec = spec_file("[parameters]", f"[parameters]\n{unused}")
    text = spec.read_text(encoding="utf-8").replace('"d >= 0"', '"d >= 0", "V_in < V_m"')
    spec.write_text(text, encoding="utf-8")
    answer = call("verify", spec, "--json")  # V_m bounds an input
    said = "piezo-sym: mine.toml: parameters.F_2: no law uses it\n"
    assert (answer.code, answer.err) == (0, said)
    assert "F_2" not in answer.out


def test_a_parameter_of_a_component_is_not_a_line(call, tmp_path):
    """What is left out of a component takes the effect of its parameters with it, on purpose."""
    path = tmp_path / "pair.toml"
    text = '[model]\nname = "pair"\n[components.one]\nspec = "oscillator"\n'
    path.write_text(f'{text}without = ["damper", "body"]\n', encoding="utf-8")
    assert call("verify", path).err == ""


def test_an_input_without_effect_is_a_line(call, spec_file):
    spec = spec_file("[inputs]", '[inputs]\nV_3 = { unit = "kV" }\nS_0 = { unit = "J/K" }')
    text = spec.read_text(encoding="utf-8").replace("c_0*log(T_e/T_0)", "S_0 + c_0*log(T_e/T_0)")
    spec.write_text(text, encoding="utf-8")
    answer = call("verify", spec)
    said = "piezo-sym: mine.toml: inputs.V_3: no element uses it; "
    assert answer.code == 0
    assert answer.err.startswith(said)  # S_0 sets the start
    assert len(answer.err.splitlines()) == 1
    run = call(
        "simulate", spec, "--duration", "1e-4", "-i", "V_3=2kV", "-i", "V_in=1", "-i", "S_0=0"
    )
    assert (run.code, run.err) == (0, "piezo-sym: V_3: no element uses this input\n")
    with pytest.warns(InputWarning, match="^V_3: no element uses this input$") as warned:
        simulate(spec, duration=1e-4, inputs={"V_3": sine(1, 2), "S_0": 0.0})
    assert [warning.filename for warning in warned] == [__file__]
