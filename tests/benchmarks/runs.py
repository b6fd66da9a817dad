"""Whole runs at equal error: this package against whatever else is installed.

Input: a `Problem` and a target error.  Output: rows; every solver at the loosest tolerance with
which it reaches the target, and LSODA on lambdified SymPy at rtol 1e-6 besides, whatever its error.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from time import perf_counter
from typing import TYPE_CHECKING

from piezo_sym.bench.contest import Contestant, Pair, compared
from piezo_sym.errors import EngineError, RunError, one_line
from tests.benchmarks.machine import installed
from tests.benchmarks.ours import RUN, SAMPLED, WHOLE, run_in_c, states, whole
from tests.benchmarks.peers import LSODA, PEERS
from tests.benchmarks.reference import reference_of
from tests.benchmarks.report import Part
from tests.benchmarks.tuning import tuned

if TYPE_CHECKING:
    from piezo_sym.bench.problem import Problem
    from piezo_sym.run.checks import FloatArray
    from tests.benchmarks.peers import Peer
    from tests.benchmarks.peers.peer import Solver
    from tests.benchmarks.reference import Reference
    from tests.benchmarks.settings import Settings

PROBED = 1 / 50  # of a run: how long a peer's run takes is seen from that part of it
PROBE, USUAL = 1e-6, 1e-6
MOST_WORDS = 120


def run_rows(
    group: str,
    problem: Problem,
    target: float,
    settings: Settings,
    independent: bool,
    peers: tuple[Peer, ...] = PEERS,
) -> Part:
    """Return the rows of one group of runs.

    Parameters
    ----------
    independent : whether LSODA has a say in the reference, where no numbers are known.
    peers : what this package is compared with.
    """
    try:
        exact = reference_of(problem, independent)
        solve = run_in_c(exact.problem)
    except (EngineError, RunError) as error:
        return Part(left_out=(f"{group}: {error}",))
    ours = _tuned(RUN, solve, exact, target, settings, "rtol")
    if isinstance(ours, str):
        return Part(left_out=(f"{group}, {ours}",))
    found = [_peer(peer, exact, target, settings) for peer in peers]
    found += [_usual(exact, settings)]
    found += [_simulated(*row, exact, target, settings) for row in _datasets(exact)]
    others = [contestant for contestant in found if isinstance(contestant, Contestant)]
    pairs = [Pair(other, ours) for other in others]
    rows = compared(group, pairs, settings.rounds, exact.line)
    return Part(rows, tuple(f"{group}, {line}" for line in found if isinstance(line, str)))


def _datasets(exact: Reference) -> tuple[tuple[str, list[float] | None], ...]:
    """Return what `simulate` is asked for: the end alone, and the usual samples."""
    return (WHOLE, [exact.problem.duration]), (SAMPLED, None)


def _simulated(
    name: str, times: list[float] | None, exact: Reference, target: float, settings: Settings
) -> Contestant | str:
    """Return `simulate` with its Dataset; samples are ends of steps, so it is tuned by itself."""

    def solve(rtol: float) -> FloatArray:
        return states(exact.problem, whole(exact.problem, rtol, times))[:, -1]

    return _tuned(name, solve, exact, target, settings, "rtol")


def _peer(peer: Peer, exact: Reference, target: float, settings: Settings) -> Contestant | str:
    """Return a peer at the tolerance that reaches the target, or why it is left out."""
    reason = unable(peer, exact.problem)
    if reason:
        return f"{peer.name}: {reason}"
    try:
        compiling, running = probed(peer, exact.problem)
        if running > settings.most:
            return f"{peer.name}: about {running:.0f} s a run, over {settings.most:g} s"
        solve = peer.solver(exact.problem)
    except Exception as error:  # a peer's own code: it may raise anything
        return f"{peer.name}: {failure(error)}"
    note = f", compiled in {compiling:.1f} s" if compiling > 0.05 else ""
    return _tuned(peer.name, solve, exact, target, settings, "tolerance", note)


def _usual(exact: Reference, settings: Settings) -> Contestant | str:
    """Return what a user would write today: LSODA on lambdified SymPy with rtol 1e-6."""
    name = f"{LSODA.name}, rtol {USUAL:g}"
    _, running = probed(LSODA, exact.problem)
    if running > settings.most * 10:
        return f"{name}: about {running:.0f} s a run"
    solve = LSODA.solver(exact.problem)
    return Contestant(name, partial(solve, USUAL), error=exact.error(solve(USUAL)))


def unable(peer: Peer, problem: Problem, *, events: bool = True) -> str:
    """Return why a peer cannot run a problem, or nothing; rates alone need no events."""
    if not installed(peer.package):
        return "not installed"
    elements = problem.model.elements.values()
    if events and not peer.jumps and any(getattr(e, "discontinuous", False) for e in elements):
        return "a law that jumps cannot be an event"
    return ""


def failure(error: Exception) -> str:
    """Return why a peer failed, in a short line."""
    return f"fails: {one_line(str(error))[:MOST_WORDS] or type(error).__name__}"


def probed(peer: Peer, problem: Problem) -> tuple[float, float]:
    """Return the seconds that a peer takes to compile, and those that a run may take."""
    start = perf_counter()
    solve = peer.solver(replace(problem, duration=problem.duration * PROBED))
    solve(PROBE)
    first = perf_counter()
    solve(PROBE)
    running = perf_counter() - first
    return first - start - running, running / PROBED


def _tuned(
    name: str,
    solve: Solver,
    exact: Reference,
    target: float,
    settings: Settings,
    word: str,
    note: str = "",
) -> Contestant | str:
    best = tuned(solve, exact.error, target, settings.patience)
    if isinstance(best, str):
        return f"{name}: {best}"
    call = partial(solve, best.tolerance)
    about = f"{word} {best.tolerance:.0e}{note}"
    return Contestant(name, call, error=best.error, note=about)
