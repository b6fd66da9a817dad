"""Runs of the discrete gradient in C: both balances to round-off, of order two with a fixed step.

Input: systems that differ in parameters, their engine, their states at t = 0 and the sample times.
Output: `Runs`.  If asked to, the first step after a jump of the inputs is made of four dissipative
quarters.  What runs with a tolerance have in common with these is here, too.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeAlias, final

import numpy as np
from numpy.typing import NDArray

from piezo_sym.errors import RunError
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.engine import Engine
from piezo_sym.run.engine.march import Batch, Way, steps_at
from piezo_sym.run.ledger import Trajectory
from piezo_sym.run.mesh import Block, blocks, inputs_at
from piezo_sym.run.system import System, Systems

METHOD = "discrete_gradient"
#: Numbers of state that are stepped in one call: memory stays small, and a run can be stopped.
CHUNK = 50_000
Watch: TypeAlias = Callable[[float], object]


@final
@dataclass(frozen=True)
class Runs:
    """Runs of some systems, and why those that did not come through stopped.

    Attributes
    ----------
    batch : what the runs left at samples.
    times : the sample times (nt,).
    errors : of each system, its error, or None.
    """

    systems: Systems
    start: FloatArray
    batch: Batch
    times: FloatArray
    errors: Sequence[RunError | None]
    extrapolated: bool

    def trajectory(self, k: int) -> Trajectory:
        """Return run k; raise its error if it stopped."""
        if error := self.errors[k]:
            raise error
        batch, member, sums = self.batch, self.batch.members[k], self.batch.sums[k].T
        rows = batch.rows
        balanced = batch.fine if self.extrapolated else batch.states
        return Trajectory(
            start=self.start[k],
            states=batch.states[k].T,
            inputs=inputs_at(self.systems[k], self.times),
            integrals=sums[: rows.booked],
            steps=member.steps,
            evaluations=member.model.iterations,
            balanced=balanced[k].T,
            halvings=member.model.halvings,
            numerical=sums[-rows.numerical :] if rows.numerical else None,
        )


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
        done = run.through("march", block, range(1))
        run.note(block, done)
        if not run.goes_on(block):
            break
    return run.runs(extrapolated=False)


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
            self.batch.states[:, 0] = self.batch.fine[:, 0] = x
            self.batch.sums[:, 0] = 0.0

    def through(
        self, name: Way, block: Block, levels: Sequence[int], done: NDArray[np.intp] | int = 0
    ) -> NDArray[np.intp]:
        """Take the batch through a block, and return how many intervals each member has done."""
        steps = [steps_at(level) for level in levels]
        u = dict(zip(levels, block.middles(steps), strict=True))
        starts = levels if block.starts[0] in self.jumps else ()
        first = {level: block.quarters(steps_at(level)) for level in starts}
        return self.batch.run(name, block.lengths, u, block.samples, done, first)

    def stop(self, k: int, error: RunError) -> None:
        """Stop member k."""
        self.errors[k] = error
        self.batch.members[k].failed = 1

    def note(self, block: Block, done: NDArray[np.intp]) -> None:
        """Stop members that did not come through a block, and note why."""
        for k in np.flatnonzero(done < len(block)).tolist():
            if self.errors[k] is None:
                t = float(block.starts[done[k]])
                self.stop(k, _stuck(self.systems[k], t, self.batch.x[k]))

    def tell(self, t: float) -> None:
        """Tell the time reached."""
        if self.watch:
            self.watch(t)

    def goes_on(self, block: Block) -> bool:
        """Tell the time reached; return whether any member goes on."""
        self.tell(float(block.starts[-1] + block.lengths[-1]))
        return not all(self.errors)

    def runs(self, *, extrapolated: bool) -> Runs:
        """Return what the batch has become."""
        parts = (self.systems, self.start, self.batch, self.times, tuple(self.errors))
        return Runs(*parts, extrapolated)


def _stuck(system: System, t: float, x: FloatArray) -> RunError:
    """Return the error of a run that cannot go on: it says when and where."""
    why = "no step stays in the domain, or a law that jumps holds the state there"
    remedy = "look at inputs and state; allow more room in [domain]; tanh(v/w) for sign(v)"
    return stopped(system, t, x, why, remedy)


def stopped(system: System, t: float, x: FloatArray, why: str, remedy: str) -> RunError:
    """Return the error of a run that stops at a time t and a state x (n,)."""
    names = [record.name for record in system.module.STATES]
    rows = system.rows(system.module.STATES)
    values = ", ".join(f"{n} = {x[row.start]:.6g}" for n, row in zip(names, rows, strict=True))
    what = f"{METHOD} cannot go on from t = {t:.6g} s at {values}: {why}"
    return RunError(what, f"model '{system.module.NAME}'", remedy=remedy)
