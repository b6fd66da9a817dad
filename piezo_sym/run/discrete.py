"""Runs of the discrete gradient in C: both balances to round-off, order two, extrapolated to six.

Input: systems that differ in parameters, their engine, their states at t = 0 and the sample times.
Output: `Runs`.  With a step, one run of each.  With a tolerance, three runs side by side on a mesh,
its halves and its quarters, each with a state of its own, so that its balances stay exact.  States
are extrapolated from the three; ledger and balances are those of the finest run.  If asked to, the
first step after a jump of the inputs is made of four dissipative quarters, in each of the runs.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias, final

from piezo_sym.errors import RunError
from piezo_sym.run.engine.march import Batch, Way, coarser, finest, steps_at, twice
from piezo_sym.run.ledger import Trajectory
from piezo_sym.run.mesh import Block, blocks, inputs_at
from piezo_sym.run.scales import shared

if TYPE_CHECKING:
    from piezo_sym.run.checks import FloatArray
    from piezo_sym.run.engine import Engine
    from piezo_sym.run.system import System

METHOD = "discrete_gradient"
#: Numbers of state that are stepped in one call: memory stays small, and a run can be stopped.
CHUNK = 50_000
#: Intervals that a tolerance starts from, at least; into how many steps one may be divided.
FEWEST_INTERVALS = 32
MOST_LEVEL = 68
#: At first, when no level is known: how many intervals are tried, and up to which level.
TRIED, HIGHEST_TRIED = 4, 17
#: So few levels apart, members get all levels between.
NEAR = 8
#: The finest run may be so much less accurate than the states extrapolated from it.
LOOSER = 5.0

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

    systems: Sequence[System]
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
    run = _Run(systems, engine, x, times, starts)
    size = CHUNK // max(1, x.shape[1])
    for block in blocks(systems[0], times, step, lambda: size):
        done = run.through("march", block, range(1))
        run.note(block, done)
        if not run.goes_on(block, watch):
            break
    return run.runs(extrapolated=False)


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
    with a quarter of its steps.  Parameters as for `fixed`.
    """
    first = systems[0]
    longest = min(first.inputs.max_step, times[-1] / FEWEST_INTERVALS)
    run = _Run(systems, engine, x, times, starts)
    batch = run.batch
    batch.allow(rtol)
    batch.scale[:] = LOOSER * rtol * _scale(run, longest)
    for block in blocks(first, times, longest, lambda: _block_size(batch)):
        run.note(block, _through(run, block))
        if not run.goes_on(block, watch):
            break
    return run.runs(extrapolated=True)


def _through(run: _Run, block: Block) -> list[int]:
    """Take members through a block, and return how many of its intervals each has done.

    Where a level is missing, members stop; what is left is then cut anew, for inputs are sampled
    at the middles of all steps that a level may take.
    """
    batch = run.batch
    done = [0] * len(batch)
    while True:
        run.give_up(block, done)
        left = [n for n, member in zip(done, batch.members, strict=True) if not member.failed]
        if not left or min(left) == len(block):
            return done
        first = min(left)
        part = block.part(first, first + _block_size(batch))
        levels = _levels(batch.levels) if batch.members[0].steps else range(HIGHEST_TRIED + 1)
        before = [n - first for n in done]
        found = run.through("adapt", part, levels, before)
        done = [first + n for n in found]


@final
class _Run:
    """A batch on its way, and the errors of members that stopped."""

    def __init__(
        self,
        systems: Sequence[System],
        engine: Engine,
        x: FloatArray,
        times: FloatArray,
        starts: bool,
    ) -> None:
        self.systems, self.start, self.times, self.starts = systems, x, times, starts
        parameters = [system.parameters for system in systems]
        self.batch = Batch(engine, parameters, x, times.size, starts=starts)
        self.jumps = systems[0].inputs.jumps if starts else frozenset()
        self.errors: list[RunError | None] = [None] * len(systems)
        if times[0] == 0:
            self.batch.states[:, 0] = self.batch.fine[:, 0] = x
            self.batch.sums[:, 0] = 0.0

    def through(
        self, name: Way, block: Block, levels: Sequence[int], done: Sequence[int] = ()
    ) -> list[int]:
        """Take the batch through a block, and return how many intervals each member has done."""
        steps = [steps_at(level) for level in levels]
        u = dict(zip(levels, block.middles(steps), strict=True))
        starts = levels if block.starts[0] in self.jumps else ()
        first = {level: block.quarters(steps_at(level)) for level in starts}
        return self.batch.run(name, block.lengths, u, block.samples, done, first)

    def give_up(self, block: Block, done: Sequence[int]) -> None:
        """Stop members that would need more steps in an interval than any has."""
        for k, reached in enumerate(done):
            member = self.batch.members[k]
            if not member.failed and member.level > MOST_LEVEL and reached < len(block):
                t = float(block.starts[reached])
                self.errors[k] = _too_fine(self.systems[k], t, self.batch.x[k])
                member.failed = 1

    def note(self, block: Block, done: Sequence[int]) -> None:
        """Note why members did not come through a block."""
        for k, reached in enumerate(done):
            if reached < len(block) and self.errors[k] is None:
                self.errors[k] = _stuck(
                    self.systems[k], float(block.starts[reached]), self.batch.x[k]
                )
                self.batch.members[k].failed = 1

    def goes_on(self, block: Block, watch: Watch | None) -> bool:
        """Tell the time reached; return whether any member goes on."""
        if watch:
            watch(float(block.starts[-1] + block.lengths[-1]))
        return not all(self.errors)

    def runs(self, *, extrapolated: bool) -> Runs:
        """Return what the batch has become."""
        parts = (self.systems, self.start, self.batch, self.times, tuple(self.errors))
        return Runs(*parts, extrapolated)


def _levels(present: Sequence[int]) -> Sequence[int]:
    """Return the levels whose inputs are sampled: what the present ones and coarser ones need.

    Members that are not far apart go on between.
    """
    low, high = min(present), max(present)
    if low < high < low + NEAR:
        return range(coarser(low), finest(high) + 1)
    begun = {*present, *map(coarser, present)}
    return sorted({level for n in begun for level in (n, twice(n), finest(n))})


def _block_size(batch: Batch) -> int:
    """Return how many intervals to hand over at once: few at first, when no level is known."""
    levels = batch.levels
    if not levels or not batch.members[0].steps:
        return TRIED
    return max(1, CHUNK // (max(batch.rows.n, 1) * steps_at(finest(max(levels)))))


def _scale(run: _Run, longest: float) -> FloatArray:
    """Return the scale of each state (systems, n): its largest magnitude in a coarse run."""
    size = CHUNK // max(1, run.start.shape[1])
    for block in blocks(run.systems[0], run.times, longest, lambda: size):
        run.through("survey", block, range(1))
    run.batch.rewind()
    return shared(run.systems[0], run.batch.scale)


def _stuck(system: System, t: float, x: FloatArray) -> RunError:
    """Return the error of a run that cannot go on: it says when and where."""
    why = "no step stays in the domain, or a law that jumps holds the state there"
    remedy = "look at inputs and state; allow more room in [domain]; tanh(v/w) for sign(v)"
    return _stopped(system, t, x, why, remedy)


def _too_fine(system: System, t: float, x: FloatArray) -> RunError:
    """Return the error of a run whose tolerance asks for steps without end."""
    why = "the tolerance is out of reach there"
    remedy = "allow a larger rtol; give an input that jumps as a signal or as (t, values)"
    return _stopped(system, t, x, why, remedy)


def _stopped(system: System, t: float, x: FloatArray, why: str, remedy: str) -> RunError:
    names = [record.name for record in system.module.STATES]
    rows = system.rows(system.module.STATES)
    values = ", ".join(f"{n} = {x[row.start]:.6g}" for n, row in zip(names, rows, strict=True))
    what = f"{METHOD} cannot go on from t = {t:.6g} s at {values}: {why}"
    return RunError(what, f"model '{system.module.NAME}'", remedy=remedy)
