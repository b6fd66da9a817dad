"""heyoka over a family: one integrator for all its members, the parameter varied heyoka's own.

Input: a family.  Output: its states at the end, from members one by one, or in batches that fill
the lanes of vectors.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from tests.benchmarks.peers.heyoka_words import Equations, equations_of

if TYPE_CHECKING:
    from tests.benchmarks.family import Family
    from tests.benchmarks.peers.peer import Solver


def integrator(equations: Equations, start: Any, pars: Any, tolerance: float) -> Any:
    """Return a compiled integrator of a tolerance, with an event for each gap."""
    import heyoka

    def flip(number: int) -> Callable[[Any, int], bool]:
        def turned(run: Any, sign: int) -> bool:
            run.pars[number] = 1.0 if sign > 0 else 0.0
            return True

        return turned

    events = [heyoka.t_event(gap, callback=flip(n)) for n, gap in enumerate(equations.gaps)]
    kinks = {"t_events": events} if events else {}
    return heyoka.taylor_adaptive(
        equations.pairs, list(start), tol=tolerance, pars=list(pars), **kinks
    )


def ended(run: Any, start: Any, pars: Any, duration: float) -> Any:
    """Return the state z at the end of a run.

    Raises
    ------
    RuntimeError
        If it does not come through.
    """
    run.time, run.state[:], run.pars[:] = 0.0, start, pars
    if run.with_events:
        run.reset_cooldowns()
    outcome = run.propagate_until(duration)[0]
    if "time_limit" not in str(outcome):
        raise RuntimeError(str(outcome))
    return run.state.copy()


def one_by_one(family: Family) -> Solver:
    """Return the members' states (members, n), one run after another."""
    problem = family.problem
    equations = equations_of(problem, (family.symbol,))
    starts = family.starts / problem.scale
    pars = [equations.parameters(z, value) for z, value in _members(family, starts)]
    first = starts[0], pars[0]
    made = lru_cache(maxsize=2)(lambda tolerance: integrator(equations, *first, tolerance))

    def solve(tolerance: float) -> Any:
        run = made(tolerance)
        ends = [ended(run, *one, problem.duration) for one in zip(starts, pars, strict=True)]
        return np.array(ends) * problem.scale

    return solve


def in_batches(family: Family) -> Solver:
    """Return the members' states (members, n), as many at once as a vector has lanes."""
    import heyoka

    problem = family.problem
    width = heyoka.recommended_simd_size()
    equations = equations_of(problem, (family.symbol,))
    starts = family.starts / problem.scale
    pars = [equations.parameters(z, value) for z, value in _members(family, starts)]
    states, numbers = _filled(starts, width), _filled(np.array(pars), width)
    first = states[0], numbers[0]
    made = lru_cache(maxsize=2)(lambda tolerance: wide(equations, *first, tolerance))

    def solve(tolerance: float) -> Any:
        run = made(tolerance)
        batches = zip(states, numbers, strict=True)
        ends = [_ended_wide(run, z, values, problem.duration).T for z, values in batches]
        return np.concatenate(ends)[: len(starts)] * problem.scale

    return solve


def wide(equations: Equations, start: Any, pars: Any, tolerance: float) -> Any:
    """Return a compiled integrator of as many runs as its start and parameters have columns."""
    import heyoka

    def flip(number: int) -> Callable[[Any, int, int], bool]:
        def turned(run: Any, sign: int, lane: int) -> bool:
            run.pars[number, lane] = 1.0 if sign > 0 else 0.0
            return True

        return turned

    events = [heyoka.t_event_batch(gap, callback=flip(n)) for n, gap in enumerate(equations.gaps)]
    kinks = {"t_events": events} if events else {}
    arrays = np.array(start), np.array(pars)
    return heyoka.taylor_adaptive_batch(
        equations.pairs, arrays[0], tol=tolerance, pars=arrays[1], **kinks
    )


def _ended_wide(run: Any, start: Any, pars: Any, duration: float) -> Any:
    run.set_time(0.0)
    run.state[:], run.pars[:] = start, pars
    if run.with_events:
        run.reset_cooldowns()
    run.propagate_until(np.full(start.shape[1], duration))
    outcomes = [str(outcome) for outcome, *_ in run.propagate_res]
    if not all("time_limit" in outcome for outcome in outcomes):
        raise RuntimeError(", ".join(outcomes))
    return run.state.copy()


def _members(family: Family, starts: Any) -> Any:
    return zip(starts.tolist(), family.values.tolist(), strict=True)


def _filled(rows: Any, width: int) -> Any:
    """Return rows (members, k) as (batches, k, width); the last fills up its batch."""
    missing = -len(rows) % width
    whole = np.concatenate([rows, np.repeat(rows[-1:], missing, axis=0)])
    return whole.reshape(-1, width, rows.shape[1]).transpose(0, 2, 1)
