"""``verify --recheck`` and ``verify --junit``: a second opinion, and verdicts for pipelines."""

import json
import subprocess
import sys
from collections import Counter
from xml.etree import ElementTree as ET

import pytest

from piezo_sym import derive, load, verify
from piezo_sym.proofs import Verdict, proofs_json
from piezo_sym.spec.source import find, read
from piezo_sym.verification import recheck as module
from piezo_sym.verification.recheck import recheck

MODEL = load("piezo_stack")


def test_rechecking_confirms_every_row(call):
    answer = call("verify", "piezo_stack", "--recheck")
    lines = answer.err.splitlines()
    assert answer.code == 0
    assert lines[0] == "piezo_stack, by a second program:"
    confirmed = [line for line in lines if line.startswith("confirmed ")]
    known = f"{len(confirmed)} of {len(confirmed)} rows confirmed"
    assert lines[-1] == f"{known}; printed text is not read here"
    assert "stated program" in lines  # the checker does not call confirmed what it does not look at
    assert {"confirmed passive hysteron", "confirmed sigma"} <= {*confirmed}


@pytest.mark.long
def test_a_row_that_is_left_out_or_says_too_much_is_not_confirmed():
    proofs = json.loads(proofs_json(verify(derive(MODEL)), MODEL, ""))
    text = read(find("piezo_stack"))
    rows = proofs["obligations"]
    proofs["obligations"] = [row for row in rows if (row["id"], row["element"]) != ("sigma", None)]
    found = recheck(text, json.dumps(proofs))
    assert found.faults()[0].startswith("not confirmed sigma: ")
    wrong = text.replace('"d*v"', '"-d*v"')
    found = recheck(wrong, json.dumps({**proofs, "obligations": rows}))
    assert "not confirmed" in found.rows["passive", "damper"]


def refusing(monkeypatch, *keys):
    """Have a checker that confirms one row and does not confirm those given."""
    said = ["confirmed skew", "stated program"]
    said += [f"not confirmed {' '.join(key)}: cvc5 does not decide it" for key in keys]
    done = subprocess.CompletedProcess([], 1, "\n".join(said), "")
    monkeypatch.setattr(module.subprocess, "run", lambda *_, **__: done)


def test_what_is_not_confirmed_is_one_line_and_exit_code_1(call, monkeypatch):
    refusing(monkeypatch, ("passive", "damper"))
    answer = call("verify", "piezo_stack", "--recheck")
    assert answer.code == 1
    assert answer.err.endswith(
        "piezo-sym: piezo_stack: not confirmed passive damper: cvc5 does not decide it\n"
    )


def test_rechecking_without_cvc5_is_one_line(refused, monkeypatch):
    monkeypatch.setitem(sys.modules, "cvc5", None)
    said = refused("verify", "piezo_stack", "--recheck")
    assert "cvc5" in said
    assert "pip install 'piezo_sym[proof]'" in said


def test_an_information_row_does_not_decide(call, monkeypatch):
    refusing(monkeypatch, ("odd", "hysteron"))
    answer = call("verify", "piezo_stack", "--recheck")
    assert answer.code == 0
    assert "not confirmed odd hysteron" in answer.err


@pytest.mark.long
def test_a_checker_that_ends_without_rows_confirms_nothing(call, monkeypatch, tmp_path):
    for code, said in ((2, "bad input: no table"), (0, ""), (-11, "confirmed skew")):
        done = subprocess.CompletedProcess([], code, said, "")
        with monkeypatch.context() as patch:
            patch.setattr(module.subprocess, "run", lambda *_, done=done, **__: done)
            answer = call("verify", "piezo_stack", "--recheck", "--junit", tmp_path / "p.xml")
        assert answer.code == 1
        assert "piezo-sym: piezo_stack: not confirmed: " in answer.err
        suite = suites(tmp_path / "p.xml")["piezo_stack, rechecked"]
        assert suite.get("failures") == "1"


def test_json_and_junit_say_what_was_confirmed(call, monkeypatch, tmp_path):
    path = tmp_path / "proofs.xml"
    refusing(monkeypatch, ("passive", "damper"), ("odd", "hysteron"))
    answer = call("verify", "piezo_stack", "--recheck", "--json", "--junit", path)
    rows = {(row["id"], row["element"]): row["recheck"] for row in json.loads(answer.out)}
    why = "not confirmed: cvc5 does not decide it"
    assert rows["skew", None] == "confirmed"
    assert rows["passive", "damper"] == why
    suite = suites(path)["piezo_stack, rechecked"]
    assert (suite.get("tests"), suite.get("failures"), suite.get("errors")) == ("4", "1", "0")
    said = {case.get("name"): [(c.tag, c.get("message")) for c in case] for case in suite}
    assert said == {
        "skew": [],
        "program": [("skipped", "stated")],
        "passive damper": [("failure", why)],
        "odd hysteron": [("skipped", why)],
    }


def suites(path):
    return {suite.get("name"): suite for suite in ET.parse(path).getroot()}


@pytest.mark.long
def test_junit_has_a_case_a_row(call, unproved, tmp_path):
    path = tmp_path / "proofs.xml"
    answer = call("verify", "piezo_stack", unproved, "--junit", path)
    assert answer.code == 1
    found = suites(path)
    assert list(found) == ["piezo_stack", "mine"]
    for name, spec in (("piezo_stack", "piezo_stack"), ("mine", unproved)):
        rows, suite = verify(derive(load(str(spec)))).rows, found[name]
        cases = suite.findall("testcase")
        assert [case.get("name") for case in cases] == [f"{r.id} {r.element}".strip() for r in rows]
        assert int(suite.get("tests")) == len(rows)
        kinds = Counter(child.tag for case in cases for child in case)
        assert int(suite.get("failures")) == kinds["failure"]
        assert int(suite.get("errors")) == kinds["error"]
        required = Counter(r.verdict for r in rows if r.required)
        assert kinds["failure"] == required[Verdict.REFUTED]
        assert kinds["error"] == required[Verdict.OPEN]
    damper = next(c for c in found["mine"] if c.get("name") == "passive damper")
    fault = damper.find("failure")
    assert fault.get("message").startswith("d*v*v = -1; the condition 'd >= 0'")
    assert "at d = -1, v = 1" in fault.text


def test_junit_of_what_is_proved_has_no_failure(call, tmp_path):
    path = tmp_path / "proofs.xml"
    assert call("verify", "piezo_stack", "--junit", path).code == 0
    (suite,) = suites(path).values()
    assert (suite.get("failures"), suite.get("errors")) == ("0", "0")
    assert all(len(case) == 0 for case in suite)


def test_junit_keeps_information_apart(call, spec_file, tmp_path):
    """A law that is not odd is no failure: a skipped case says so."""
    law = "rho/(T - T_0)*(i if i > 0 else 2*i)"
    path = tmp_path / "proofs.xml"
    spec = spec_file("rho/(T - T_0)*deadzone(i, i_0)", law)
    assert call("verify", spec, "--junit", path).code == 0
    (suite,) = suites(path).values()
    case = next(case for case in suite if case.get("name") == "odd hysteron")
    assert case.find("skipped").get("message").startswith("information: REFUTED: ")
    assert (suite.get("failures"), suite.get("errors")) == ("0", "0")


def test_rows_decided_by_intervals_are_confirmed_too(call, spec_file):
    law = "rho/(T - T_0)*(i + 4*i_0*sin(i/i_0))"
    path = spec_file("rho/(T - T_0)*deadzone(i, i_0)", law)
    path.write_text(path.read_text().replace('"i_0 >= 0"', '"i_0 > 0"'), encoding="utf-8")
    answer = call("verify", path, "--recheck")
    assert answer.code == 0
    assert "\nconfirmed passive hysteron\n" in answer.err
