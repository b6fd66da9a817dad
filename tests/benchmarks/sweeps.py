"""Sweeps of parameters: many runs of one model.

Input: a problem.  Output: rows of times per run at equal error: `sweep` in one thread and in two,
its runs side by side and one by one, beside single runs in C and peers that compile once for all.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from piezo_sym.bench.contest import Contestant, Pair, compared
from piezo_sym.errors import EngineError, RunError
from piezo_sym.run.collocation import METHOD, collocate
from piezo_sym.run.engine.engine import engine_of
from piezo_sym.sweeps.plan import Plan, read_plan
from piezo_sym.sweeps.pool import threads_for
from piezo_sym.sweeps.sweep import run_missing, sink_of
from tests.benchmarks.family import family_of
from tests.benchmarks.peers import PEERS
from tests.benchmarks.report import Part
from tests.benchmarks.runs import failure, unable
from tests.benchmarks.tuning import tuned

if TYPE_CHECKING:
    from piezo_sym.bench.problem import Problem
    from piezo_sym.run.checks import FloatArray
    from piezo_sym.run.module import GeneratedModule
    from tests.benchmarks.family import Family
    from tests.benchmarks.peers import Peer
    from tests.benchmarks.peers.peer import Solver
    from tests.benchmarks.settings import Settings


def sweep_rows(problem: Problem, settings: Settings) -> Part:
    """Return the rows of the group `sweep`."""
    try:
        family = family_of(problem, settings.members)
    except (EngineError, RunError) as error:
        return Part(left_out=(f"sweep: {error}",))
    if isinstance(family, str):
        return Part(left_out=(f"sweep: {family}",))
    best = tuned(swept(family), family.error, settings.sweep_target, settings.patience)
    if isinstance(best, str):
        return Part(left_out=(f"sweep: {best}",))
    pairs = _own(family, best.tolerance)
    one, two = pairs[0].ours, pairs[-1].ours
    found = [_peer(peer, way, family, settings) for peer in PEERS for way in peer.many]
    pairs += [Pair(o, ours) for o in found if isinstance(o, Contestant) for ours in (one, two)]
    rows = compared("sweep", pairs, settings.rounds, family.line)
    return Part(rows, tuple(f"sweep, {line}" for line in found if isinstance(line, str)))


def _own(family: Family, rtol: float) -> list[Pair]:
    """Return what this package does in several ways: first one thread, last two."""
    many = len(family.values)

    def contestant(name: str, solve: Solver) -> Contestant:
        error = family.error(solve(rtol))
        return Contestant(name, partial(solve, rtol), many, error, f"rtol {rtol:g}")

    one = contestant("sweep(), one thread", swept(family))
    two = contestant("sweep(), two threads", swept(family, threads=2))
    scalar = contestant("sweep(), one thread, one by one", swept(family, side_by_side=False))
    singles = contestant("single runs in C", single_runs(family))
    return [Pair(singles, one), Pair(singles, scalar), Pair(scalar, one), Pair(one, two)]


def swept(family: Family, threads: int = 1, *, side_by_side: bool = True) -> Solver:
    """Return `sweep` with its last values: from rtol to the states (members, n) at the end."""
    problem, names = family.problem, [record.name for record in family.problem.module.STATES]

    def solve(rtol: float) -> FloatArray:
        plan = replace(_plan(family, rtol), side_by_side=side_by_side)
        found = in_threads(plan, problem.module, threads)
        parts = [found[name].values.reshape(len(family.values), -1) for name in names]
        return np.concatenate(parts, axis=1)

    return solve


def in_threads(plan: Plan, module: GeneratedModule, count: int) -> Any:
    """Return the Dataset of a plan run in threads of our own, without warnings."""
    plan, sink = sink_of(plan, module, None, count)
    with threads_for(plan, module, count) as (submit, at_once):
        run_missing(sink, submit, at_once, False, plan.size)
    return sink.dataset()


def _plan(family: Family, rtol: float) -> Plan:
    problem, end = family.problem, [family.problem.duration]
    stepping = rtol, None, None
    start = problem.counts, None, METHOD
    runs = problem.inputs, problem.duration, *stepping, *start, end
    return read_plan(problem.module, {family.name: family.values}, runs, "last", "run")


def single_runs(family: Family) -> Solver:
    """Return runs in C that know nothing of each other, one after another."""
    engine, systems = engine_of(family.problem.module), family.systems
    times = np.array([family.problem.duration])

    def solve(rtol: float) -> FloatArray:
        runs = (
            collocate([system], engine, start[None], times, rtol)
            for system, start in zip(systems, family.starts, strict=True)
        )
        return np.array([run.trajectory(0).states[:, -1] for run in runs])

    return solve


def _peer(peer: Peer, way: str, family: Family, settings: Settings) -> Contestant | str:
    """Return a peer at the tolerance that reaches the target, or why it is left out."""
    name = f"{peer.package}, {way}"
    reason = unable(peer, family.problem)
    if reason:
        return f"{name}: {reason}"
    try:
        solve = peer.many[way](family)
        best = tuned(solve, family.error, settings.sweep_target, settings.patience)
    except Exception as error:  # a peer's own code: it may raise anything
        return f"{name}: {failure(error)}"
    if isinstance(best, str):
        return f"{name}: {best}"
    note = f"tolerance {best.tolerance:.0e}"
    return Contestant(name, partial(solve, best.tolerance), len(family.values), best.error, note)
