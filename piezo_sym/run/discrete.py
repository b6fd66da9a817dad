"""Runs of the discrete gradient in C: both balances to round-off, of order two with a fixed step.

Input: systems that differ in parameters, their engine, their states at t = 0 and the sample times.
Output: `Runs`.  If asked to, the first step after a jump of the inputs is made of four dissipative
quarters.
"""

from collections.abc import Sequence
from typing import final

import numpy as np

from piezo_sym.errors import RunError
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.engine import Engine
from piezo_sym.run.engine.march import Batch
from piezo_sym.run.mesh import Block, blocks
from piezo_sym.run.runs import Runs, Watch, stuck
from piezo_sym.run.system import System, Systems

#: Numbers of state that are stepped in one call: memory stays small, and a run can be stopped.
CHUNK = 50_000


def fixed(
    systems: Sequence[System],
    engine: Engine,
    x: FloatArray,
    times: FloatArray,
    step: float,
    watch: Watch | None = None,
    *,
    starts: bool = False,
) -> Runs:
    """Return runs with steps of at most `step`; they end at samples and at breaks of inputs.

    Parameters
    ----------
    systems : with equal inputs and sizes.
    x : their states (systems, n) at t = 0.
    watch : told the time reached, now and then.
    starts : whether the first step after a jump of the inputs is dissipative.
    """
    run = Run(systems, engine, x, times, starts, watch)
    size = CHUNK // max(1, x.shape[1])
    for block in blocks(systems[0], times, step, lambda: size):
        run.through(block)
        if not run.goes_on(block):
            break
    return run.runs()


@final
class Run:
    """A batch on its way, and the errors of members that stopped."""

    def __init__(
        self,
        systems: Sequence[System],
        engine: Engine,
        x: FloatArray,
        times: FloatArray,
        starts: bool,
        watch: Watch | None = None,
    ) -> None:
        self.systems, self.start, self.times, self.watch = Systems.of(systems), x, times, watch
        self.batch = Batch(engine, self.systems.parameters, x, times.size, starts=starts)
        self.jumps = self.systems.inputs.jumps if starts else frozenset()
        self.errors: list[RunError | None] = [None] * len(systems)
        if times[0] == 0:
            self.batch.states[:, 0] = x
            self.batch.sums[:, 0] = 0.0

    def through(self, block: Block) -> None:
        """Take the batch through a block; note who did not come through, and why."""
        first = block.quarters() if block.starts[0] in self.jumps else None
        done = self.batch.run(block.lengths, block.middles(), block.samples, first)
        for k in np.flatnonzero(done < len(block)).tolist():
            if self.errors[k] is None:
                t = float(block.starts[done[k]])
                self.errors[k] = stuck(self.systems[k], t, self.batch.x[k])

    def goes_on(self, block: Block) -> bool:
        """Tell the time reached; return whether any member goes on."""
        if self.watch:
            self.watch(float(block.starts[-1] + block.lengths[-1]))
        return not all(self.errors)

    def runs(self) -> Runs:
        """Return what the batch has become."""
        batch = self.batch
        members = batch.members
        work = np.array([[m.steps, m.model.iterations, m.model.halvings] for m in members])
        arrays = self.times, batch.states, batch.sums, work
        numerical = batch.rows.numerical > 0
        return Runs(self.systems, self.start, *arrays, tuple(self.errors), numerical)
