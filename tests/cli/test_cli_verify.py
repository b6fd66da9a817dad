"""``piezo-sym verify``: a table to read, rows to parse, and an exit code."""

import json

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
