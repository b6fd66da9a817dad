"""Proofs as files: what z3 and cvc5 themselves say of them, by their own front ends."""

import json
import os
import subprocess
import sys
from functools import cache
from itertools import pairwise
from pathlib import Path

import cvc5
import pytest
import z3

from piezo_sym import derive, load
from piezo_sym.proofs import Verdict, decide, proofs_json, smt2
from piezo_sym.spec.load import parse

ROOT = Path(__file__).parents[2]
COMMITTED = ROOT / "generated" / "piezo_stack"
SPECS = sorted((ROOT / "tests" / "networks" / "specs").glob("*.toml"))
ENTRY = {"id", "element", "statement", "required", "verdict", "witness", "reason", "method"}
ENTRY |= {"points", "certificate"}
OF_AN_OBLIGATION = {"latex", "assumptions", "rests_on", "queries"}
IDS = {"skew", "casimir", "energy", "entropy", "temperature", "welldef", "continuous", "passive",
       "odd", "rate-independent", "sigma", "exergy", "environment", "units", "invariant",
       "program"}  # fmt: skip


@cache
def report_of(spec):
    return decide(derive(load(str(spec))))


def by_z3(text):
    """Return what z3 says to each query of a file, by its own front end, push and pop included."""
    context = z3.Context()
    answers = z3.Z3_eval_smtlib2_string(context.ref(), text).split("\n")
    return [answer.strip() for answer in answers if answer.strip()]


def by_cvc5(text):
    """Return what cvc5 says to each query of a file, command by command."""
    solver = cvc5.Solver(cvc5.TermManager())
    solver.setOption("incremental", "true")
    parser = cvc5.InputParser(solver)
    parser.setStringInput(cvc5.InputLanguage.SMT_LIB_2_6, text, "proofs")
    symbols = parser.getSymbolManager()
    answers = []
    while not (command := parser.nextCommand()).isNull():
        said = str(command.invoke(solver, symbols)).strip()
        answers += [said] if said else []
    return answers


def comments(text):
    """Return the claims of a file: the comment above each query."""
    lines = text.splitlines()
    return [before for before, line in pairwise(lines) if line == "(push 1)"]


@pytest.mark.some(7)
@pytest.mark.parametrize("spec", [None, *SPECS], ids=lambda s: s.stem if s else "committed")
def test_both_solvers_read_the_file_and_every_claim_is_proved(spec):
    text = (COMMITTED / "proofs.smt2").read_text() if spec is None else smt2(report_of(spec), "x")
    count = text.count("(check-sat)")
    assert count == len(comments(text)) > 3
    assert text.count("(push 1)") == text.count("(pop 1)") == count
    assert by_z3(text) == by_cvc5(text) == ["unsat"] * count


@pytest.mark.some(8)
@pytest.mark.parametrize("spec", SPECS, ids=lambda s: s.stem)
def test_the_file_has_every_query_of_the_report_in_its_order(spec):
    report = report_of(spec)
    asked = zip(report.rows, report.stated, strict=False)
    wanted = [label for row, o in asked if row.method != "intervals" for label, _ in o.queries]
    written = comments(smt2(report, "x"))
    assert [line.split(": ", 1)[1] for line in written] == wanted


def test_a_claim_that_is_false_is_sat_in_the_file():
    text = (ROOT / "piezo_sym/models/piezo_stack.toml").read_text().replace('"d >= 0", ', "")
    written = smt2(decide(derive(parse(text))), "x")
    answers = dict(zip(comments(written), by_z3(written), strict=True))
    assert answers == dict(zip(comments(written), by_cvc5(written), strict=True))
    false = [claim for claim, answer in answers.items() if answer == "sat"]
    assert false == ["; passive of damper: F_damper*v >= 0"]


INTERVALS = """
[model]
name = "m"
[parameters]
R = { value = 1.0, unit = "ohm" }
i_1 = { value = 1.0, unit = "A" }
L = { value = 1.0, unit = "H" }
T_0 = { value = 300.0, unit = "K" }
c = { value = 1.0, unit = "J/K" }
[domain]
assume = ["R > 0", "i_1 > 0"]
[elements]
coil = { kind = "inductor", between = ["a", "gnd"], inductance = "L" }
load = { kind = "resistor", between = ["a", "gnd"], \
voltage = "R*(i + 4*i_1*sin(i/i_1))", heats = "body" }
body = { kind = "thermal_mass", temperature = "T_0*exp(S/c)" }
"""


def test_what_intervals_prove_is_said_and_not_asked():
    report = decide(derive(parse(INTERVALS)))
    assert report.proved
    written = smt2(report, "x")
    assert "; passive of load is PROVED by intervals" in written
    assert not any("passive" in claim for claim in comments(written))
    assert by_z3(written) == by_cvc5(written)


@pytest.mark.some(6)
@pytest.mark.parametrize("spec", [None, *SPECS], ids=lambda s: s.stem if s else "committed")
def test_the_json_has_a_true_entry_a_row(spec):
    name = spec or "piezo_stack"
    report, model = report_of(name), load(str(name))
    text = (COMMITTED / "proofs.json").read_text() if spec is None else proofs_json(
        report, model, "made")  # fmt: skip
    content = json.loads(text)
    assert list(content) == ["made", "model", "spec_sha256", "system", "obligations"]
    assert (content["model"], content["spec_sha256"]) == (report.model, model.sha256)
    entries = content["obligations"]
    proved = [e for e in entries if e["id"] != "program"]  # that row is not the prover's
    assert [(e["id"], e["element"] or "", e["verdict"]) for e in proved] == [
        (r.id, r.element, r.verdict.value) for r in report.rows
    ]
    for entry in entries:
        assert entry.keys() in (ENTRY, ENTRY | OF_AN_OBLIGATION)
        assert (entry.keys() == ENTRY) == (entry["id"] in {"units", "program"})
        assert entry["id"] in IDS
        assert entry["verdict"] in {v.value for v in Verdict}
        assert (entry["witness"] is not None) == (entry["verdict"] == "REFUTED")
        assert (entry["reason"] is None) == (entry["verdict"] == "PROVED")
    known = {(e["id"], e["element"] or "") for e in entries}
    rests = {tuple(name) for e in entries for name in e.get("rests_on", ())}
    assert rests <= known


RECORDS = """
from pathlib import Path
from piezo_sym import derive, load
from piezo_sym.proofs import decide, proofs_json, smt2
import sys
for spec in sys.argv[1:]:
    model = load(spec)
    report = decide(derive(model))
    print(smt2(report, "x"), proofs_json(report, model, "x"))
"""


@pytest.mark.long
def test_the_files_are_the_same_in_every_process():
    specs = ["piezo_stack", *(str(path) for path in SPECS[::8])]
    texts = set()
    for seed in ("1", "2"):
        environment = {**os.environ, "PYTHONHASHSEED": seed}
        command = (sys.executable, "-c", RECORDS, *specs)
        done = subprocess.run(
            command, env=environment, capture_output=True, check=True, text=True, cwd=ROOT
        )
        texts.add(done.stdout)
    assert len(texts) == 1
    assert texts.pop().count("(check-sat)") > 50
