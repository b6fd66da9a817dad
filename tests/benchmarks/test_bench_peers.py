"""Peers solve the same problem: each, where it is installed, reaches the known answers."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from piezo_sym import Model, load
from tests.benchmarks.by_hand import hand_of
from tests.benchmarks.case_p import problem_of
from tests.benchmarks.ours import run_in_c, states, whole
from tests.benchmarks.peers import LSODA, PEERS
from tests.benchmarks.rates import batch_rows, rhs_rows, sample_of
from tests.benchmarks.reference import reference_of
from tests.benchmarks.runs import run_rows, unable
from tests.benchmarks.settings import QUICK

SMALL = replace(QUICK, rounds=1, columns=300, most=1e4, patience=1e4)  # however busy the machine
SPECS = Path(__file__).parents[1] / "networks" / "specs"
ALWAYS = {"LSODA on lambdified SymPy", "RK45 on lambdified SymPy"}


@pytest.fixture(scope="module")
def case_p():
    return problem_of(load("piezo_stack"), {}, 0.1)


@pytest.fixture(scope="module")
def brief(case_p):
    """A part of it that is soon computed, and what LSODA's tightest run says of its end."""
    problem = replace(case_p, duration=2e-3)
    end = states(problem, whole(problem, 1e-12, [2e-3], "LSODA"))[:, -1]
    return problem, end


@pytest.mark.parametrize("peer", PEERS, ids=lambda peer: peer.name)
def test_a_peer_solves_the_problem(brief, peer, tmp_path, monkeypatch):
    pytest.importorskip(peer.package)
    monkeypatch.chdir(tmp_path)
    problem, end = brief
    assert problem.error(peer.solver(problem)(1e-9), end) <= 1e-6
    assert list(tmp_path.iterdir()) == []  # nothing is left behind


@pytest.mark.some(8)
@pytest.mark.parametrize("spec", ["a1_two_bodies", "a2_oscillator", "a5_thermistor"])
@pytest.mark.parametrize("peer", PEERS, ids=lambda peer: peer.name)
def test_a_peer_solves_smooth_problems(peer, spec):
    pytest.importorskip(peer.package)
    exact = reference_of(problem_of(load(SPECS / f"{spec}.toml"), {}, 0.05), independent=True)
    assert exact.good_to <= 1e-7
    assert exact.error(peer.solver(exact.problem)(1e-8)) <= 1e-6


@pytest.mark.parametrize("peer", PEERS, ids=lambda peer: peer.name)
def test_a_peers_rates_are_the_models(case_p, peer):
    pytest.importorskip(peer.package)
    sample = sample_of(replace(case_p, duration=1e-2), 50)
    assert peer.rates is None or sample.error(peer.rates(case_p)(sample.x)) <= 1e-9


def test_our_run_solves_the_problem(brief):
    problem, end = brief
    assert problem.error(run_in_c(problem)(1e-6), end) <= 1e-6


def test_a_peer_that_is_not_installed_is_left_out(case_p):
    missing = replace(LSODA, name="something", package="no_such_package")
    assert unable(missing, case_p) == "not installed"
    assert unable(LSODA, case_p) == ""


def broken(*_):
    raise TypeError("cannot\ndo this")


@pytest.mark.long
def test_a_peer_that_fails_is_left_out(case_p):
    peers = (LSODA, replace(LSODA, name="first", solver=broken, rates=broken))
    brief = replace(case_p, duration=1e-3)
    run = run_rows("run", brief, 1e-3, SMALL, independent=False, peers=peers)
    assert run.left_out == ("run, first: fails: cannot\\ndo this",)
    batch = batch_rows(replace(case_p, duration=1e-2), SMALL, peers)
    assert batch.left_out == ("batch, sympy: fails: cannot\\ndo this",)


def test_a_law_that_jumps_is_no_event(case_p):
    model = load("piezo_stack")
    damper = model.elements["damper"].model_copy(update={"discontinuous": True})
    jumping = model.model_copy(update={"elements": {**model.elements, "damper": damper}})
    problem = replace(case_p, model=jumping)
    without = replace(LSODA, jumps=False)
    assert unable(without, problem) == "a law that jumps cannot be an event"
    assert unable(without, problem, events=False) == unable(LSODA, problem) == ""


def test_case_p_has_known_answers(case_p):
    exact = reference_of(case_p, independent=True)
    assert exact.good_to == 1e-12
    assert exact.error(run_in_c(case_p)(1e-6)) <= 1e-6
    off = exact.state + 1e-6 * case_p.scale
    assert exact.error(off) == pytest.approx(1e-6)
    assert exact.error(np.full_like(off, np.nan)) == np.inf


def test_another_problems_reference_is_confirmed_by_lsoda(case_p):
    exact = reference_of(replace(case_p, duration=0.01), independent=True)
    assert exact.good_to <= 1e-6
    assert "LSODA" in exact.line


@pytest.mark.long
def test_runs_stand_at_equal_error(case_p):
    part = run_rows("run", replace(case_p, duration=5e-3), 1e-5, SMALL, independent=False)
    tuned = [row for row in part.rows if "tolerance" in row.note]
    assert {row.other for row in tuned} | {
        line.split(": ")[0][5:] for line in part.left_out
    } >= ALWAYS
    assert all(row.other_error <= 1e-5 and row.ours_error <= 1e-5 for row in tuned)
    assert {"LSODA on lambdified SymPy, rtol 1e-06"} <= {row.other for row in part.rows}
    assert all(row.ratio.median > 0 for row in part.rows)


@pytest.mark.usefixtures("no_compiler")
def test_without_a_compiler_runs_are_left_out(case_p):
    part = run_rows("run", case_p, 1e-5, SMALL, independent=False)
    assert part.rows == ()
    (reason,) = part.left_out
    assert reason.startswith("run: engine: no C compiler is found; ")


def test_rates_stand_beside_those_written_by_hand(case_p):
    part = rhs_rows(replace(case_p, duration=1e-2), SMALL)
    names = {row.other for row in part.rows}
    assert {"lambdified SymPy (numpy)", "hand-written NumPy", "hand-written C, r = 64"} <= names
    errors = [e for row in part.rows for e in (row.other_error, row.ours_error) if e is not None]
    assert max(errors) <= 1e-10


@pytest.mark.long
def test_batches_stand_beside_those_written_by_hand(case_p):
    part = batch_rows(replace(case_p, duration=1e-2), SMALL)
    groups = {f"batch of {SMALL.columns}, {size} states each" for size in (6, 68)}
    assert {row.group for row in part.rows} == groups
    assert {"hand-written C, in blocks", "hand-written NumPy"} <= {row.other for row in part.rows}
    assert max(max(row.other_error, row.ours_error) for row in part.rows) <= 1e-10


def test_a_sample_sees_a_wrong_rate(case_p):
    sample = sample_of(replace(case_p, duration=1e-2), 20)
    rates = case_p.module.rhs(sample.x, np.array([0.0, 70.0, 298.15]), case_p.system.parameters)
    assert sample.error(rates) > 1e-3  # the voltage is another one


@pytest.mark.some(1)
@pytest.mark.parametrize("lanes", [1, 2, 65])
def test_batches_by_hand_are_right_for_any_size(case_p, lanes):
    problem = problem_of(case_p.model, {}, 1e-3, {"hysteron": lanes})
    hand = hand_of(problem)
    sample = sample_of(problem, 600)  # two blocks and a part of one
    seen = []
    hand.c_batch(sample.x, lambda out: seen.append(out) or 0.0)
    expected = hand.numpy(sample.x)
    size = np.max(np.abs(expected), axis=1, keepdims=True)
    assert np.all(np.abs(seen[0] - expected) <= 1e-12 * np.maximum(size, 1e-300))


def test_other_models_have_nothing_by_hand(case_p):
    data = case_p.model.model_dump()
    data["parameters"]["L"]["value"] = 2e-3
    other = Model(**data)
    assert hand_of(replace(case_p, model=other)) is None
