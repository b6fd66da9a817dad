"""Runs with a tolerance: three side by side on one mesh, of order six where all is smooth.

Input: as for runs with a fixed step, and the tolerance.  Output: `Runs`.  The three go through a
mesh, its halves and its quarters, each with a state of its own, so that its balances stay exact.
States are extrapolated from the three; ledger and balances are those of the finest run.  paths.c
decides how finely an interval is divided; here it gets its inputs, and an interval that needs very
many steps is cut into parts.
"""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, final

from piezo_sym.run.discrete import CHUNK, Run, Runs, stopped
from piezo_sym.run.engine.march import coarser, finest, steps_at, twice
from piezo_sym.run.mesh import blocks
from piezo_sym.run.scales import shared

if TYPE_CHECKING:
    from collections.abc import Sequence

    from piezo_sym.errors import RunError
    from piezo_sym.run.checks import FloatArray
    from piezo_sym.run.discrete import Watch
    from piezo_sym.run.engine import Engine
    from piezo_sym.run.mesh import Block
    from piezo_sym.run.system import System

#: How often a user's function is asked between two calls of C: what is asked too early is lost.
ASKED = 300
#: Intervals that a tolerance starts from, at least.
FEWEST_INTERVALS = 32
#: An interval of more steps than this level's, 256, is cut into parts, each divided as it needs.
MOST_LEVEL, PARTS = 27, 8
#: How often an interval and its parts may be cut; what share of a run is too short for it.
MOST_CUTS, SHORTEST = 100, 1e-16
#: At first, when no level is known: how many intervals are tried, and up to which level.
TRIED, HIGHEST_TRIED = 4, 17
#: So few levels apart, members get all levels between.
NEAR = 8
#: The finest run may be so much less accurate than the states extrapolated from it.
LOOSER = 5.0


def adaptive(
    systems: Sequence[System],
    engine: Engine,
    x: FloatArray,
    times: FloatArray,
    rtol: float,
    watch: Watch | None = None,
    *,
    starts: bool = False,
) -> Runs:
    """Return runs on a mesh that holds the error of each interval below rtol times a scale.

    A coarse run gives the scale of each state, its largest magnitude.  The three then go from
    interval to interval; how finely one is divided is decided by a trial from the finest state,
    with a quarter of its steps.  An interval that needs very many is cut into parts, which find
    their own.  Parameters as for `fixed`.
    """
    first = systems[0]
    longest = min(first.inputs.max_step, times[-1] / FEWEST_INTERVALS)
    run = Run(systems, engine, x, times, starts)
    batch = run.batch
    batch.allow(rtol)
    batch.scale[:] = LOOSER * rtol * _scale(run, longest)
    for block in blocks(first, times, longest, lambda: _block_size(run)):
        if block.starts[0] == block.segment.start:
            batch.forget()
        _Passage(run, block).pass_through()
        if not run.goes_on(block, watch):
            break
    return run.runs(extrapolated=True)


@final
class _Passage:
    """Members on their way through a block.

    Attributes
    ----------
    block : the intervals, some of them in parts.
    done : how many of them each member has done.
    cuts : how often each member has had an interval cut, or its parts, by its `whole`.
    """

    def __init__(self, run: Run, block: Block) -> None:
        self.run, self.block = run, block
        self.done = [0] * len(run.batch)
        self.cuts: Counter[tuple[int, int]] = Counter()

    def pass_through(self) -> None:
        """Take all members to the end of the block, but for those that stop.

        Where a level is missing, members wait; what is left is then handed over anew, for inputs
        are sampled at the middles of all steps that a level may take.
        """
        batch = self.run.batch
        while True:
            if max(batch.levels, default=0) > MOST_LEVEL:
                self.cut()
            members = zip(self.done, batch.members, strict=True)
            first = min((n for n, s in members if not s.failed), default=len(self.block))
            if first == len(self.block):
                self.run.note(self.block, self.done)
                return
            part = self.block.part(first, first + _block_size(self.run))
            levels = _levels(batch.levels) if batch.members[0].steps else range(HIGHEST_TRIED + 1)
            before = [n - first for n in self.done]
            found = self.run.through("adapt", part, levels, before)
            self.done = [first + n for n in found]

    def cut(self) -> None:
        """Cut the intervals at which members wait because they need more steps than any has."""
        for n in sorted({*self.done} - {len(self.block)}, reverse=True):
            for k in self._waiting(n):
                self._count(k, n)
            if waiting := self._waiting(n):
                self.block = self.block.cut(n, PARTS)
                self.done = [m + PARTS - 1 if m > n else m for m in self.done]
                for k in waiting:
                    self.run.batch.members[k].level -= 4 * (PARTS.bit_length() - 1)

    def _waiting(self, n: int) -> list[int]:
        """Return the members that need more steps in interval n than any has."""
        members = enumerate(zip(self.done, self.run.batch.members, strict=True))
        return [k for k, (m, s) in members if m == n and not s.failed and s.level > MOST_LEVEL]

    def _count(self, k: int, n: int) -> None:
        """Count a cut of interval n for member k, and stop that if there are too many."""
        run, cut = self.run, (k, int(self.block.whole[n]))
        self.cuts[cut] += 1
        if self.cuts[cut] > MOST_CUTS or self.block.lengths[n] < SHORTEST * run.times[-1]:
            t = float(self.block.starts[n])
            run.stop(k, _too_fine(run.systems[k], t, run.batch.x[k]))


def _levels(present: Sequence[int]) -> Sequence[int]:
    """Return the levels whose inputs are sampled: what the present ones and coarser ones need.

    Members that are not far apart go on between.
    """
    low, high = min(present), max(present)
    if low < high < low + NEAR:
        return range(coarser(low), finest(high) + 1)
    begun = {*present, *map(coarser, present)}
    return sorted({level for n in begun for level in (n, twice(n), finest(n))})


def _block_size(run: Run) -> int:
    """Return how many intervals to hand over at once: few at first, when no level is known."""
    batch = run.batch
    levels = batch.levels
    if not levels or not batch.members[0].steps:
        return TRIED
    if run.systems[0].inputs.asked:
        return max(1, ASKED // sum(map(steps_at, _levels(levels))))
    return max(1, CHUNK // (max(batch.rows.n, 1) * steps_at(finest(max(levels)))))


def _scale(run: Run, longest: float) -> FloatArray:
    """Return the scale of each state (systems, n): its largest magnitude in a coarse run."""
    size = CHUNK // max(1, run.start.shape[1])
    for block in blocks(run.systems[0], run.times, longest, lambda: size):
        run.through("survey", block, range(1))
    run.batch.rewind()
    return shared(run.systems[0], run.batch.scale)


def _too_fine(system: System, t: float, x: FloatArray) -> RunError:
    """Return the error of a run whose tolerance asks for steps without end."""
    why = "the tolerance is out of reach there"
    remedy = "allow a larger rtol; give an input that jumps as a signal or as (t, values)"
    return stopped(system, t, x, why, remedy)
