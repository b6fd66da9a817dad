"""Runs of the discrete gradient in C: both balances to round-off, order two, extrapolated to four.

Input: a `System`, its engine, the state x (n,) at t = 0 and the sample times.  Output: a
`Trajectory`.  With a step, one run of it.  With a tolerance, two runs side by side on one mesh, the
second with half its steps, each with a state of its own, so that its balances stay exact.  States
are extrapolated from both; ledger and balances are those of the finer run.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, TypeAlias, final

import numpy as np

from piezo_sym.errors import RunError
from piezo_sym.run.engine.march import March, Pair, steps_at
from piezo_sym.run.ledger import Trajectory
from piezo_sym.run.mesh import Block, blocks, inputs_at
from piezo_sym.run.scales import shared

if TYPE_CHECKING:
    from piezo_sym.run.checks import FloatArray
    from piezo_sym.run.engine import Engine
    from piezo_sym.run.system import System

METHOD = "discrete_gradient"
#: Numbers of state that are stepped in one call: memory stays small, and a run can be stopped.
CHUNK = 200_000
#: Intervals that a tolerance starts from, at least; into how many steps one may be divided.
FEWEST_INTERVALS = 32
MOST_LEVEL = 36
#: Levels whose inputs are sampled below and above the present one.
BELOW, ABOVE = 2, 3
#: The finer run may be so much less accurate than the states extrapolated from it.
LOOSER = 5.0

Watch: TypeAlias = Callable[[float], object]


@final
class _Kept:
    """What a run leaves at its samples (nt,): rows of states and ledgers."""

    def __init__(self, march: March, x: FloatArray, times: FloatArray) -> None:
        rows = march.rows
        self.states = np.full((times.size, rows.n), np.nan)
        self.fine = np.full((times.size, rows.n), np.nan)
        self.sums = np.full((times.size, rows.ledger), np.nan)
        if times[0] == 0:
            self.states[0] = self.fine[0] = x
            self.sums[0] = 0.0


def fixed(
    system: System,
    engine: Engine,
    x: FloatArray,
    times: FloatArray,
    step: float,
    watch: Watch | None = None,
) -> Trajectory:
    """Return a run with steps of at most `step`; they end at samples and at breaks of inputs.

    Parameters
    ----------
    watch : told the time reached, now and then.

    Raises
    ------
    RunError : a step has no solution inside the domain; the message says when.
    """
    march = March(engine, system.parameters, x)
    kept = _Kept(march, x, times)
    size = max(1, CHUNK // x.size)
    for block in blocks(system, times, step, lambda: size):
        out = (kept.states, kept.sums)
        done = march.run(block.lengths, block.middles(), block.samples, *out)
        _check(system, march, block, done)
        _tell(watch, block)
    return _trajectory(system, x, times, march, kept, kept.states)


def adaptive(
    system: System,
    engine: Engine,
    x: FloatArray,
    times: FloatArray,
    rtol: float,
    watch: Watch | None = None,
) -> Trajectory:
    """Return a run on a mesh that holds the error of each interval below rtol times a scale.

    A coarse run gives the scale of each state, its largest magnitude.  The pair then goes from
    interval to interval; how finely one is divided is decided by a trial from the finer state, with
    half its steps.

    Raises
    ------
    RunError : a step has no solution inside the domain; the message says when.
    """
    longest = min(system.inputs.max_step, times[-1] / FEWEST_INTERVALS)
    tolerance = LOOSER * rtol * _scale(system, engine, x, times, longest)
    march = March(engine, system.parameters, x)
    kept, pair = _Kept(march, x, times), Pair(march)
    for whole in blocks(system, times, longest, lambda: _block_size(pair, x.size)):
        block = whole
        while len(block):
            lowest = max(0, pair.level - BELOW)
            levels = range(lowest, pair.level + ABOVE + 1)
            u = [block.middles(steps_at(level)) for level in levels]
            out = (kept.states, kept.fine, kept.sums)
            done = pair.run(block.lengths, u, lowest, tolerance, block.samples, *out)
            if pair.failed or pair.level > MOST_LEVEL:
                _check(system, march, block, done)
            block = block.rest(done)
        _tell(watch, whole)
    return _trajectory(system, x, times, march, kept, kept.fine)


def _block_size(pair: Pair, n: int) -> int:
    """Return how many intervals to hand over at once: few at first, when no level is known."""
    if not pair.march.steps:
        return 16
    return max(1, CHUNK // (n * steps_at(pair.level + ABOVE)))


def _scale(
    system: System, engine: Engine, x: FloatArray, times: FloatArray, longest: float
) -> FloatArray:
    """Return the scale of each state (n,): its largest magnitude in a coarse run."""
    march = March(engine, system.parameters, x)
    size = max(1, CHUNK // x.size)
    states, sums = np.empty((size, x.size)), np.empty((size, march.rows.ledger))
    scale = np.abs(x)
    for block in blocks(system, times, longest, lambda: size):
        rows = np.arange(len(block))
        done = march.run(block.lengths, block.middles(), rows, states, sums)
        _check(system, march, block, done)
        scale = np.maximum(scale, np.abs(states[: len(block)]).max(axis=0))
    return shared(system, scale)


def _trajectory(
    system: System,
    x: FloatArray,
    times: FloatArray,
    march: March,
    kept: _Kept,
    balanced: FloatArray,
) -> Trajectory:
    return Trajectory(
        start=x,
        states=kept.states.T,
        inputs=inputs_at(system, times),
        integrals=kept.sums.T[: march.rows.booked],
        steps=march.steps,
        evaluations=march.work["iterations"],
        balanced=balanced.T,
        halvings=march.work["halvings"],
    )


def _tell(watch: Watch | None, block: Block) -> None:
    if watch:
        watch(float(block.starts[-1] + block.lengths[-1]))


def _check(system: System, march: March, block: Block, done: int) -> None:
    """Raise `RunError` if a run did not come through a block: the error says when and where."""
    if done == len(block):
        return
    t, x = float(block.starts[done]), march.x
    names = [record.name for record in system.module.STATES]
    rows = system.rows(system.module.STATES)
    values = ", ".join(f"{n} = {x[row.start]:.6g}" for n, row in zip(names, rows, strict=True))
    what = f"{METHOD} cannot go on from t = {t:.6g} s at {values}: no step stays in the domain"
    remedy = "look at the inputs and the state there, or allow the state more room in [domain]"
    raise RunError(what, f"model '{system.module.NAME}'", remedy=remedy)
