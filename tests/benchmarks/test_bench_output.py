"""The kept reports: their table, Markdown and JSON, and the command that makes them."""

import json
import re
from dataclasses import asdict, replace
from pathlib import Path

import pytest

from piezo_sym import load
from piezo_sym.bench.contest import COLUMNS, Comparison, Spread
from piezo_sym.bench.problem import problem_of
from tests.benchmarks.__main__ import main
from tests.benchmarks.groups import bench
from tests.benchmarks.machine import installed, machine
from tests.benchmarks.making import enlarged, making_rows
from tests.benchmarks.output import as_json, markdown, notes
from tests.benchmarks.report import Report
from tests.benchmarks.settings import QUICK

OSCILLATOR = Path(__file__).parents[1] / "networks" / "specs" / "a2_oscillator.toml"
ROW = Comparison(
    group="run",
    other="LSODA",
    ours="discrete gradient in C",
    other_time=Spread(0.282, 0.28, 0.3),
    ours_time=Spread(1.2e-3, 1.1e-3, 1.3e-3),
    ratio=Spread(235.0, 230.0, 250.0),
    other_error=1.4e-5,
    ours_error=2e-7,
    measure="at the end",
    note="rtol 1e-06",
)
ALONE = Comparison("making", "", "derivation", None, Spread(1e-8, 1e-8, 1e-8), None)


@pytest.fixture
def report():
    return Report("piezo_stack", machine(["numpy"]), (ROW, ALONE), ("run, heyoka: not installed",))


def test_notes_say_what_errors_are_and_what_is_missing(report):
    assert notes(report) == (
        "errors of run: at the end",
        "run, LSODA: rtol 1e-06",
        "left out: run, heyoka: not installed",
    )


def test_a_batch_is_told_from_few_states(report):
    batch = replace(ROW, group="batch of 100000, 6 states each")
    told = [line for line in notes(replace(report, rows=(batch, ALONE))) if "shared among" in line]
    assert len(told) == 1


def test_markdown_is_a_table_with_its_machine(report):
    lines = markdown(report).splitlines()
    table = [line for line in lines if line.startswith("|")]
    assert [line.count("|") for line in table] == [len(COLUMNS) + 1] * 4
    assert report.machine.python in lines[2]
    assert lines[-1] == "- left out: run, heyoka: not installed"


def test_json_holds_every_field(report):
    found = json.loads(as_json(report))
    assert found == json.loads(json.dumps(asdict(report)))
    assert found["rows"][0]["ratio"] == {"median": 235.0, "low": 230.0, "high": 250.0}
    assert found["rows"][1]["ratio"] is None


def test_the_machine_tells_where_it_was_measured():
    found = machine(["numpy", "no_such_package"])
    assert found.processor
    assert found.cores >= 1
    assert re.fullmatch(r"\d{4}-\d\d-\d\d", found.date)
    assert dict(found.versions)["sympy"] == installed("sympy") != ""
    assert "no_such_package" not in dict(found.versions)


@pytest.mark.long
def test_derivation_is_compared_with_large_banks():
    problem = problem_of(load("piezo_stack"), {}, 0.1)
    assert enlarged(problem.model).elements["hysteron"].count == 10_000
    part = making_rows(problem, replace(QUICK, rounds=1))
    assert [row.other for row in part.rows] == [f"{row.ours}, r = 10000" for row in part.rows]
    assert enlarged(load(OSCILLATOR)) is None


def test_groups_that_are_not_asked_for_are_not_measured():
    said = []
    report = bench(
        load(OSCILLATOR), only=["making"], settings=replace(QUICK, rounds=1), say=said.append
    )
    assert said == ["making"]
    assert {row.group for row in report.rows} == {"making"}


def test_the_command(tmp_path, capsys):
    files = [tmp_path / "report.json", tmp_path / "report.md"]
    words = [OSCILLATOR, "--quick", "--repeat", 1, "--duration", 2]
    words += ["--only", "run", "--only", "rhs", "--json", files[0], "--markdown", files[1]]
    assert main([str(word) for word in words]) == 0
    out = capsys.readouterr().out
    found = json.loads(files[0].read_text())
    assert {row["group"] for row in found["rows"]} == {"run", "rhs"}
    assert "discrete gradient in C" in files[1].read_text()
    assert "# Benchmark of damped_oscillator" in out


@pytest.mark.parametrize("words", [["--only", "rus"], ["--duration", "0"], ["no_such_spec"]])
def test_the_command_refuses_in_one_line(capsys, words):
    assert main(["--quick", *words]) == 2
    assert len(capsys.readouterr().err.splitlines()) == 1
