"""Right-hand sides: one state at a time, and many at once.

Input: a `Problem`.  Output: rows.  States are those of a run, on all branches of the laws.  Errors
are against the expressions in 30 digits, in units of each row's largest rate.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, final

import numpy as np
import sympy as sp

from piezo_sym.bench.contest import Contestant, Pair, compared
from piezo_sym.bench.problem import INSTANT, field
from piezo_sym.errors import EngineError
from piezo_sym.run.engine.engine import engine_of
from tests.benchmarks.by_hand import hand_of
from tests.benchmarks.case_p import problem_of
from tests.benchmarks.ours import rates_in_place, rates_into, rates_of, states, whole
from tests.benchmarks.peers import PEERS
from tests.benchmarks.report import Part
from tests.benchmarks.runs import failure, unable

if TYPE_CHECKING:
    from piezo_sym.bench.problem import Problem
    from piezo_sym.run.checks import FloatArray
    from tests.benchmarks.peers import Peer
    from tests.benchmarks.peers.peer import Rates
    from tests.benchmarks.settings import Settings

LOOPED = 2048  # states of a loop in C: a call costs little beside them
CALLED = 50  # states of a loop in Python
CHECKED = 8
DIGITS = 30
MANY = 64
MEASURE = "of a rate, against 30 digits, in units of the row's largest"


@final
@dataclass(frozen=True)
class Sample:
    """States x (n, columns) of a run; the exact rates (n, k) of the first k, and their size."""

    x: FloatArray
    exact: FloatArray
    size: FloatArray

    def error(self, rates: Any) -> float:
        """Return the largest error of rates (n, at least k)."""
        found = np.asarray(rates)[:, : self.exact.shape[1]]
        return float(np.max(np.abs(found - self.exact) / self.size))


def sample_of(problem: Problem, columns: int) -> Sample:
    """Return states of a run in random order."""
    path = states(problem, whole(problem, 1e-5, 1001, "LSODA"))
    order = np.random.default_rng(0).integers(path.shape[1], size=columns)
    x = np.ascontiguousarray(path[:, order])
    exact = np.array([precise(problem, column) for column in x.T[:CHECKED]]).T
    sizes = np.max(np.abs(np.asarray(rates_of(problem)(path))), axis=1, keepdims=True)
    return Sample(x, exact, np.where(sizes > 0, sizes, 1.0))


def precise(problem: Problem, x: FloatArray) -> list[float]:
    """Return the rates of one state, computed in 30 digits."""
    values = zip(problem.states, x, strict=True)
    known = {state: sp.Float(float(value), DIGITS) for state, value in values}
    return [float(rate.xreplace(known).evalf(DIGITS)) for rate in problem.at_instant]


def rhs_rows(problem: Problem, settings: Settings) -> Part:
    """Return the rows of the group `rhs`: time of one state."""
    sample = sample_of(problem, LOOPED)
    mine = _one_at_a_time("generated NumPy", rates_of(problem), sample)
    plain = _lambdified(problem, sample, "numpy", cse=False)
    tight = _lambdified(problem, sample, "math", cse=True)
    pairs: list[Pair] = [Pair(plain, mine)]
    left_out: list[str] = []
    try:
        c = _in_place(problem, sample)
        pairs += [Pair(plain, c), Pair(tight, c)]
    except EngineError as error:
        left_out.append(f"rhs, generated C: {error}")
    hand = hand_of(problem)
    if hand:
        pairs.append(Pair(_one_at_a_time("hand-written NumPy", hand.numpy, sample), mine))
        pairs += [Pair(*hand.c_loops(lanes)) for lanes in (2, MANY, 1024)]
    return Part(compared("rhs", pairs, settings.rounds, MEASURE), tuple(left_out))


def _one_at_a_time(name: str, rates: Any, sample: Sample) -> Contestant:
    columns = [np.ascontiguousarray(column) for column in sample.x.T[:CALLED]]

    def call() -> None:
        for column in columns:
            rates(column)

    found = np.array([rates(column) for column in columns[:CHECKED]]).T
    return Contestant(name, call, len(columns), sample.error(found))


def _lambdified(problem: Problem, sample: Sample, modules: str, cse: bool) -> Contestant:
    name = f"lambdified SymPy ({modules}{', cse' if cse else ''})"
    return _one_at_a_time(name, partial(field(problem, modules, cse), INSTANT), sample)


def batch_rows(problem: Problem, settings: Settings, peers: tuple[Peer, ...] = PEERS) -> Part:
    """Return the rows of the group `batch`, also with banks of 64 lanes where there are banks."""
    parts = [_batch(problem, settings, peers)]
    module = problem.module
    if module.BANKS and not any(
        isinstance(p.value, tuple) for p in problem.model.parameters.values()
    ):
        sizes = dict.fromkeys(module.BANKS, MANY)
        large = problem_of(problem.model, problem.inputs, problem.duration, sizes)
        parts.append(_batch(large, settings, peers))
    return Part(
        tuple(row for part in parts for row in part.rows),
        tuple(dict.fromkeys(line for part in parts for line in part.left_out)),
    )


def _batch(problem: Problem, settings: Settings, peers: tuple[Peer, ...]) -> Part:
    sample = sample_of(problem, settings.columns)
    numpy = _at_once("generated NumPy", rates_of(problem), sample)
    others, left_out = _others(problem, sample, peers)
    pairs = [Pair(others[0], numpy)]
    hand = hand_of(problem)
    try:
        compiled = _at_once("generated C", rates_of(problem, engine_of(problem.module)), sample)
        pairs += [Pair(other, compiled) for other in others]
        if hand:
            blocked = hand.c_batch(sample.x, sample.error)
            mine = compiled, _into(problem, sample), _in_place(problem, sample)
            pairs += [Pair(blocked, one) for one in mine]
    except EngineError as error:
        left_out.append(f"batch, generated C: {error}")
    if hand:
        pairs.append(Pair(_at_once("hand-written NumPy", hand.numpy, sample), numpy))
    group = f"batch of {settings.columns}, {problem.start.size} states each"
    rows = compared(group, pairs, settings.rounds, MEASURE)
    return Part(rows, tuple(left_out))


def _others(
    problem: Problem, sample: Sample, peers: tuple[Peer, ...]
) -> tuple[list[Contestant], list[str]]:
    """Return the rates of those peers that have them, and why others are left out."""
    found: list[Contestant] = []
    left_out: list[str] = []
    for peer in peers:
        reason = unable(peer, problem, events=False)
        if not peer.rates:
            continue
        try:
            if not reason:
                found.append(_at_once(f"{peer.package}, batch", peer.rates(problem), sample))
        except Exception as error:  # a peer's own code: it may raise anything
            reason = failure(error)
        if reason:
            left_out.append(f"batch, {peer.package}: {reason}")
    return found, left_out


def _at_once(name: str, rates: Rates, sample: Sample) -> Contestant:
    call = partial(rates, sample.x)
    return Contestant(name, call, sample.x.shape[1], sample.error(call()))


def _into(problem: Problem, sample: Sample) -> Contestant:
    call, out = rates_into(problem, sample.x)
    call()
    name = "generated C, into an array that is there"
    return Contestant(name, call, sample.x.shape[1], sample.error(out))


def _in_place(problem: Problem, sample: Sample) -> Contestant:
    call, out = rates_in_place(problem, sample.x)
    call()
    name = "generated C, states one after another"
    return Contestant(name, call, sample.x.shape[1], sample.error(out.T))
