"""Runs with a tolerance: three side by side on one mesh, of order six where all is smooth.

Input: as for runs with a fixed step, and the tolerance.  Output: `Runs`.  The three go through a
mesh, its halves and its quarters, each with a state of its own, so that its balances stay exact.
States are extrapolated from the three; ledger and balances are those of the finest run.  paths.c
decides how finely an interval is divided; here it gets its inputs, and an interval that needs very
many steps is cut into parts.
"""

from collections.abc import Sequence
from typing import final

import numpy as np
from numpy.typing import NDArray

from piezo_sym.errors import RunError
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.discrete import CHUNK, Run, Runs, Watch, stopped
from piezo_sym.run.engine import Engine
from piezo_sym.run.engine.march import coarser, finest, steps_at, twice
from piezo_sym.run.mesh import Block, blocks
from piezo_sym.run.scales import shared
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
    run = Run(systems, engine, x, times, starts, watch)
    batch = run.batch
    batch.allow(rtol)
    batch.scale[:] = LOOSER * rtol * _scale(run, longest)
    for block in blocks(first, times, longest, lambda: CHUNK):
        if block.starts[0] == block.segment.start:
            batch.forget()
        _Passage(run, block, np.arange(len(batch))).pass_through()
        if not run.goes_on(block):
            break
    return run.runs(extrapolated=True)


@final
class _Passage:
    """Some members on their way through a block.

    Attributes
    ----------
    done : how many of its intervals each member has done; all, if it is none of these.
    cuts : how often each member has had the interval cut whose parts these are, or its parts.
    """

    def __init__(
        self,
        run: Run,
        block: Block,
        members: NDArray[np.intp],
        cuts: NDArray[np.intp] | None = None,
    ) -> None:
        self.run, self.block, self.cuts = run, block, cuts
        self.done = np.full(len(run.batch), len(block))
        self.done[members] = 0

    def pass_through(self) -> None:
        """Take the members to the end of the block, but for those that stop.

        Where a level is missing, members wait; what is left is then handed over anew, for inputs
        are sampled at the middles of all steps that a level may take.
        """
        batch = self.run.batch
        while (present := np.flatnonzero((self.done < len(self.block)) & ~batch.failed)).size:
            waiting = present[batch.level[present] > MOST_LEVEL]
            if waiting.size:
                self.cut(waiting)
            else:
                self.hand_over(present)
        self.run.note(self.block, self.done)

    def hand_over(self, present: NDArray[np.intp]) -> None:
        """Let members go on in C, with inputs for the levels that they are at, and more."""
        first, batch = int(self.done[present].min()), self.run.batch
        known = batch.members[int(present[0])].steps > 0
        levels = _levels(batch.level[present]) if known else range(HIGHEST_TRIED + 1)
        size = _block_size(self.run, levels) if known else TRIED
        self.run.tell(float(self.block.starts[first]))
        part = self.block.part(first, first + size)
        found = self.run.through("adapt", part, levels, self.done - first)
        self.done = np.maximum(self.done, first + found)

    def cut(self, waiting: NDArray[np.intp]) -> None:
        """Take members through the intervals that they wait at, in parts; others see none of it."""
        batch = self.run.batch
        at = self.done[waiting]  # as it is now: who has come through one interval waits no more
        for n in np.unique(at).tolist():
            here = waiting[at == n]
            cuts = np.zeros(len(batch), np.intp) if self.cuts is None else self.cuts
            cuts[here] += 1
            short = self.block.lengths[n] < SHORTEST * self.run.times[-1]
            for k in here[(cuts[here] > MOST_CUTS) | short].tolist():
                t = float(self.block.starts[n])
                self.run.stop(k, _too_fine(self.run.systems[k], t, batch.x[k]))
            batch.level[here] -= 4 * (PARTS.bit_length() - 1)
            _Passage(self.run, self.block.part(n, n + 1).cut(PARTS), here, cuts).pass_through()
            self.done[here] += 1


def _levels(present: NDArray[np.intp]) -> Sequence[int]:
    """Return the levels whose inputs are sampled: what the present ones and coarser ones need.

    Members that are not far apart go on between.
    """
    low, high = int(present.min()), int(present.max())
    if low < high < low + NEAR:
        return range(coarser(low), finest(high) + 1)
    begun = {*present.tolist()}
    begun |= {*map(coarser, begun)}
    return sorted({level for n in begun for level in (n, twice(n), finest(n))})


def _block_size(run: Run, levels: Sequence[int]) -> int:
    """Return how many intervals to hand over at once, with inputs for some levels."""
    if run.systems[0].inputs.asked:
        return max(1, ASKED // sum(map(steps_at, levels)))
    return max(1, CHUNK // (max(run.batch.rows.n, 1) * steps_at(max(levels))))


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
    remedy = "try another rtol, or give a step; dissipative_start damps what a jump sets off"
    if system.inputs.asked:
        remedy = f"give an input that jumps as a signal or as (t, values); {remedy}"
    return stopped(system, t, x, why, remedy)
