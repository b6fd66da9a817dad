"""``piezo-sym bench``: ratios beside what users have today, each with the error of both sides."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from piezo_sym import load
from piezo_sym.bench import GROUPS, bench
from piezo_sym.bench.contest import COLUMNS, Comparison, Spread
from piezo_sym.bench.measure import LADDER, TARGET, reference_of, tuned
from piezo_sym.bench.problem import problem_of
from piezo_sym.cli import run

OSCILLATOR = Path(__file__).parents[1] / "networks" / "specs" / "a2_oscillator.toml"
ROW = Comparison(
    group="run",
    other="LSODA",
    ours="simulate()",
    other_time=Spread(0.282, 0.28, 0.3),
    ours_time=Spread(1.2e-3, 1.1e-3, 1.3e-3),
    ratio=Spread(235.0, 230.0, 250.0),
    other_error=1.4e-5,
    ours_error=2e-7,
)


def test_cells():
    assert ROW.cells == (
        *("run", "LSODA", "282 ms", "1e-05", "simulate()", "1.2 ms", "2e-07"),
        *("235", "230 - 250"),
    )
    alone = Comparison("making", "", "derivation", None, Spread(1e-8, 1e-8, 1e-8), None)
    assert alone.cells == ("making", "-", "-", "-", "derivation", "10 ns", "-", "-", "-")
    assert len(COLUMNS) == len(alone.cells)


@pytest.fixture(scope="module")
def report():
    return bench(load("piezo_stack"), duration=2e-3, rounds=1)


@pytest.mark.long
def test_every_group_compares_numpy_and_c_with_lambdified_sympy(report):
    assert report.left_out == ()
    pairs = {(row.group, row.other, row.ours) for row in report.rows}
    lambdified = "lambdified SymPy (numpy)"
    assert {("rhs", lambdified, "generated NumPy"), ("rhs", lambdified, "generated C")} < pairs
    assert ("batch of 10000", lambdified, "generated C") in pairs
    assert ("run", "LSODA on lambdified SymPy", "simulate()") in pairs
    assert len(pairs) == len(report.rows) == 4 + 2 + 3


def test_no_speed_stands_without_its_error(report):
    for row in report.rows:
        most = TARGET if row.group == "run" else 1e-9
        assert max(row.other_error, row.ours_error) <= most
        assert row.ratio.median > 0
    assert {"errors of run", "errors of rhs"} <= {line.partition(":")[0] for line in report.notes}


def test_wrong_rates_show_in_their_error(monkeypatch):
    problem = problem_of(load(OSCILLATOR), {}, 0.5)
    found = replace(problem, rates=tuple(1.001 * rate for rate in problem.rates))
    monkeypatch.setattr("piezo_sym.bench.measure.problem_of", lambda *_: found)
    rows = bench(problem.model, duration=0.5, only=["rhs", "batch"], rounds=1).rows
    assert all(row.ours_error > 1e-4 > 1e-9 > row.other_error for row in rows)


def test_ends_of_runs_are_the_known_ones():
    """At 0.1 s three solvers with located kinks agree on them to 1e-14."""
    _, end, line = reference_of(problem_of(load("piezo_stack"), {}, 0.1))
    known = [-9.523507638450e-04, 3.453828489837e-03, -3.900998920056e-05]
    known += [5.224415297332e-03] * 2 + [1.341141665114e-01]
    assert end == pytest.approx(known, rel=1e-6)
    assert "LSODA" in line


def test_where_no_step_is_small_enough_lsoda_is_the_reference(monkeypatch):
    from piezo_sym.bench import measure
    from piezo_sym.errors import RunError

    ran = measure.simulate

    def refusing(*_, method, **given):
        if method == measure.METHOD:
            raise RunError("no step is small enough", "t = 0", remedy="use another method")
        return ran(*_, method=method, **given)

    monkeypatch.setattr(measure, "simulate", refusing)
    _, _, line = reference_of(problem_of(load(OSCILLATOR), {}, 0.5))
    assert "against LSODA at rtol 1e-12, good to" in line


@pytest.mark.parametrize("factor", [1e-3, 0.9, 1.1, 300.0])
def test_the_loosest_good_tolerance_is_used(factor):
    found = tuned("it", lambda rtol: factor * rtol, float)
    good = next(rtol for rtol in LADDER if factor * rtol <= TARGET)
    assert (found.error, found.note) == (factor * good, f"rtol {good:g}")


def test_a_lucky_tolerance_does_not_count():
    lucky = {LADDER[1]: 0.0}
    assert tuned("it", lambda rtol: lucky.get(rtol, rtol), float).note == "rtol 1e-06"


@pytest.mark.parametrize("fault", [RuntimeError, ArithmeticError, ValueError])
def test_a_solver_that_fails_is_off(fault):
    def solve(rtol):
        if rtol > 1e-8:
            raise fault
        return 0.0

    assert tuned("it", solve, float).note == "rtol 1e-08"
    assert "does not reach" in tuned("it", lambda _: np.inf, float)


@pytest.mark.usefixtures("no_compiler")
def test_without_a_compiler_numpy_remains():
    found = bench(load(OSCILLATOR), only=["rhs"], rounds=1)
    assert {row.ours for row in found.rows} == {"generated NumPy"}
    (said,) = found.left_out
    assert said.startswith("rhs, generated C: engine: no C compiler is found")


def test_the_command(tmp_path, capsys):
    file = tmp_path / "report.json"
    words = ["bench", OSCILLATOR, "--repeat", 1, "--duration", "2000 ms"]
    words += ["--only", "run", "--json", file]
    assert run([str(word) for word in words]) == 0
    out = capsys.readouterr().out
    found = json.loads(file.read_text())
    assert {row["group"] for row in found["rows"]} == {"run"}
    assert set(found["rows"][0]["ratio"]) == {"median", "low", "high"}
    assert "benchmark of damped_oscillator" in out
    assert "errors of run: at the end" in out


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--only", "rus"], "no group 'rus'"),
        (["--duration", "0"], "duration"),
        (["--repeat", "0"], "repeat"),
        (["--input", "V_in=step(0.1,0,1)"], "input 'V_in' is neither"),
        (["--input", "V=1"], "V"),
        (["no_such_spec"], "no_such_spec"),
    ],
)
def test_the_command_refuses_in_one_line(capsys, words, said):
    assert run(["bench", *words]) == 2
    err = capsys.readouterr().err
    assert len(err.splitlines()) == 1
    assert said in err


def test_every_group_has_its_name_in_the_help(capsys):
    assert run(["bench", "--help"]) == 0
    text = capsys.readouterr().out
    assert all(name in text for name in GROUPS)
