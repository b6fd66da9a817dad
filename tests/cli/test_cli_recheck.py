"""``verify --recheck`` and ``verify --junit``: a second opinion, and verdicts for pipelines."""

import sys
from collections import Counter
from xml.etree import ElementTree as ET

from piezo_sym import derive, load, verify
from piezo_sym.proofs import Verdict, recheck, smt2


def report_of(spec):
    return verify(derive(load(str(spec))))


def test_rechecking_agrees_on_every_query(call):
    answer = call("verify", "piezo_stack", "--recheck")
    count = smt2(report_of("piezo_stack"), "").count("(check-sat)")
    assert (answer.code, answer.err) == (
        0,
        f"piezo_stack: cvc5 agrees on {count} of {count} queries\n",
    )


def test_rechecking_says_where_the_solvers_differ(call, monkeypatch):
    module = sys.modules["piezo_sym.proofs.recheck"]
    real = module.solver

    class Contrary:
        def ask(self, query):
            found = real("z3").ask(query).result
            changed = "sat" if "F_damper" in query.label else found
            return type("Answer", (), {"result": changed})()

    monkeypatch.setattr(module, "solver", lambda name: Contrary() if name == "cvc5" else real(name))
    asked, found = recheck(report_of("piezo_stack"))
    assert asked > 20
    assert {difference.answers for difference in found} == {("unsat", "sat")}
    answer = call("verify", "piezo_stack", "--recheck")
    assert answer.code == 1
    assert "z3 says unsat, cvc5 says sat: passive damper: F_damper*v >= 0" in answer.err


def test_rechecking_without_cvc5_is_one_line(refused, monkeypatch):
    module = sys.modules["piezo_sym.proofs.recheck"]
    assert recheck is module.recheck
    monkeypatch.setattr(module, "find_spec", lambda _: None)
    said = refused("verify", "piezo_stack", "--recheck")
    assert "cvc5 is not installed" in said
    assert "pip install 'piezo_sym[proof]'" in said


def suites(path):
    return {suite.get("name"): suite for suite in ET.parse(path).getroot()}


def test_junit_has_a_case_a_row(call, unproved, tmp_path):
    path = tmp_path / "proofs.xml"
    answer = call("verify", "piezo_stack", unproved, "--junit", path)
    assert answer.code == 1
    found = suites(path)
    assert list(found) == ["piezo_stack", "mine"]
    for name, spec in (("piezo_stack", "piezo_stack"), ("mine", unproved)):
        rows, suite = report_of(spec).rows, found[name]
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
    assert fault.get("message") == "d*v*v = -1"
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


def test_rows_without_a_query_are_counted_apart(call, spec_file):
    law = "rho/(T - T_0)*(i + 4*i_0*sin(i/i_0))"
    path = spec_file("rho/(T - T_0)*deadzone(i, i_0)", law)
    path.write_text(path.read_text().replace('"i_0 >= 0"', '"i_0 > 0"'), encoding="utf-8")
    answer = call("verify", path, "--recheck")
    assert answer.code == 0
    assert "; rows decided by intervals, without a query: 1" in answer.err
