"""Sweeps are measured at equal error, over runs that are known, whoever computes them."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from piezo_sym import load, simulate
from tests.benchmarks.case_p import problem_of
from tests.benchmarks.family import family_of, varied
from tests.benchmarks.peers import PEERS
from tests.benchmarks.settings import QUICK
from tests.benchmarks.sweeps import single_runs, sweep_rows, swept

SPECS = Path(__file__).parents[1] / "networks" / "specs"
SMALL = replace(QUICK, rounds=1, members=11, patience=1e4)  # more than the lanes of any vector
WAYS = [(peer, way) for peer in PEERS for way in peer.many]
WAY_NAMES = [f"{peer.package}, {way}" for peer, way in WAYS]


@pytest.fixture(scope="module")
def problem():
    """The beginning of case P, in which the first kinks lie."""
    return problem_of(load("piezo_stack"), {}, 2e-3)


@pytest.fixture(scope="module")
def family(problem):
    return family_of(problem, SMALL.members)


@pytest.mark.long
def test_a_family_varies_the_inductance_around_its_value(family):
    assert family.name == "L"
    assert family.values[[0, 5, -1]] == pytest.approx([5e-4, 1e-3, 2e-3])
    assert [system.parameters.L for system in family.systems] == family.values.tolist()
    assert family.good_to <= 1e-7


@pytest.mark.some(1)
@pytest.mark.parametrize("k", [0, 4, 10])
def test_ends_are_those_of_runs_by_lsoda(family, k):
    run = simulate(
        "piezo_stack",
        inputs=family.problem.inputs,
        duration=2e-3,
        parameters={"L": float(family.values[k])},
        rtol=1e-11,
        method="LSODA",
        times=[2e-3],
    )
    names = [record.name for record in family.problem.module.STATES]
    end = np.concatenate([run[name].values.ravel() for name in names])
    assert np.max(np.abs(family.ends[k] - end) / family.problem.scale) <= 1e-7


def test_errors_are_the_largest_of_all_members(family):
    x = family.ends.copy()
    x[7] += 1e-3 * family.problem.scale
    assert family.error(x) == pytest.approx(1e-3)
    x[2, 0] = np.nan
    assert family.error(x) == np.inf


@pytest.mark.parametrize("ways", [{}, {"threads": 2}, {"side_by_side": False}], ids=str)
def test_every_way_to_sweep_computes_the_same(family, ways):
    assert family.error(swept(family, **ways)(1e-7)) <= 1e-6
    difference = swept(family, **ways)(1e-5) - single_runs(family)(1e-5)
    assert np.max(np.abs(difference) / family.problem.scale) <= 1e-11


@pytest.mark.parametrize(("peer", "way"), WAYS, ids=WAY_NAMES)
def test_a_peer_runs_the_family(family, peer, way):
    pytest.importorskip(peer.package)
    assert family.error(peer.many[way](family)(1e-12)) <= 1e-7
    assert family.error(peer.many[way](family)(1e-2)) > 1e-12  # the tolerance counts


@pytest.mark.parametrize(("peer", "way"), WAYS, ids=WAY_NAMES)
def test_a_peer_runs_a_family_without_kinks_whose_starts_differ(peer, way):
    pytest.importorskip(peer.package)
    data = load(SPECS / "a1_two_bodies.toml")
    found = family_of(problem_of(data, {}, 0.05), 5)
    assert found.name == "c_1"
    assert np.ptp(found.starts, axis=0).max() > 1e-3
    assert found.error(peer.many[way](found)(1e-10)) <= 1e-6


def test_rows_stand_at_equal_error(problem):
    part = sweep_rows(problem, replace(SMALL, sweep_target=1e-6))
    ours = {row.ours for row in part.rows}
    others = {row.other for row in part.rows}
    assert ours == {f"sweep(), {way}" for way in ("one thread", "two threads")} | {
        "sweep(), one thread, one by one"
    }
    assert others | {line.split(": ")[0][7:] for line in part.left_out} == {
        "single runs in C",
        "sweep(), one thread",
        "sweep(), one thread, one by one",
        *WAY_NAMES,
    }
    assert max(max(row.other_error, row.ours_error) for row in part.rows) <= 1e-6
    assert all(row.ratio.median > 0 for row in part.rows)
    assert all("rtol" in row.note for row in part.rows)
    assert "11 runs with L from 0.0005 to 0.002" in part.rows[0].measure


def test_a_target_out_of_reach_is_said(problem):
    part = sweep_rows(problem, replace(SMALL, sweep_target=1e-30, patience=0.0))
    assert part.rows == ()
    assert "at best, not 1e-30" in part.left_out[0]


@pytest.mark.usefixtures("no_compiler")
def test_without_a_compiler_sweeps_are_left_out(problem):
    (reason,) = sweep_rows(problem, SMALL).left_out
    assert reason.startswith("sweep: engine: no C compiler is found; ")


def test_another_model_varies_its_first_positive_parameter():
    found = family_of(problem_of(load(SPECS / "a2_oscillator.toml"), {}, 0.5), 4)
    assert found.name == varied(found.problem) == "m"
    assert found.error(swept(found)(1e-8)) <= 1e-6
