"""Runs of Gauss collocation in C, with a tolerance or a fixed step: both balances to round-off.

Input: systems that differ in parameters, their engine, their states at t = 0, the sample times, and
a tolerance or a `FixedStep`.  Output: `Runs`, whose states are those of their ledgers.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import ceil
from typing import Any, TypeAlias, final

import numpy as np
from numpy.typing import NDArray

from piezo_sym.errors import RunError, UsageError, listing, quote
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.dataset import Trajectory
from piezo_sym.run.engine.batch import Batch, Stepping
from piezo_sym.run.engine.engine import Engine
from piezo_sym.run.engine.library import Layout
from piezo_sym.run.inputs import Inputs
from piezo_sym.run.stuck import stuck_error
from piezo_sym.run.system import QUIET, DrivenModule

METHOD = "discrete_gradient"
#: Called with the time [s] that runs have reached, every few milliseconds; an exception ends them.
Watch: TypeAlias = Callable[[float], object]
#: Returns the samples behind a time [s] that a run has reached so far: times, and the run there.
Later: TypeAlias = Callable[[float], tuple[FloatArray, Trajectory]]
#: Called now and then with the time [s] that a run has reached: whether it may end.
Ended: TypeAlias = Callable[[float, Later], bool]
#: The first step, the longest step, and the longest step of the coarse run, over the duration.
FIRST, LONGEST, SURVEYED = 1e-5, 0.25, 1 / 64
#: States times steps between two calls of `watch`: some milliseconds.
CHUNK = 50_000
#: Steps between two questions whether a run has ended: a part of a chunk, and the least number.
ASKED, FEWEST = 8, 16
#: In runs of more states, vectors hold lanes of banks instead of runs.
MOST_STATES = 32
#: (least rtol, cheapest number of stages, tolerance of a step's estimated error over rtol); the
#: tolerance is chosen so that the largest error of a run is about rtol.
STAGES = ((8e-6, 4, 0.3), (0.0, 6, 0.75))
#: Below this tolerance steps end at kinks, however many there are.
LEAST_OVER = 1e-6
#: A run of more steps would take days, and steps below round-off.
MOST_STEPS = 1e12
#: Twice the stages that a step can have.
ORDERS = (2, 4, 6, 8, 10, 12)
#: A step that ends closer than this, over its length, to a sample or a break ends there.
ROUNDING = 1e-9
#: The smallest tolerance of a state's error, over the round-off that moves the state at rest.
OVER_NOISE = 50.0


@final
@dataclass(frozen=True)
class FixedStep:
    """A fixed step: its greatest length [s], and the order of the error in it."""

    length: float
    order: int = 2


@final
@dataclass(frozen=True)
class Runs:
    """Runs in C from their states at t = 0, and what they have reached so far."""

    systems: Sequence[DrivenModule]  # with equal inputs and sizes
    start: FloatArray  # states (runs, n) at t = 0
    times: FloatArray  # of samples (nt,)
    states: FloatArray  # (runs, nt, n); nan at samples that are not reached
    sums: FloatArray  # integrals (runs, nt, rows), as in `Batch`
    batch: Batch

    @property
    def work(self) -> NDArray[Any]:
        """Steps, Newton iterations and refused steps of each run (runs, 3)."""
        records = self.batch.records
        return np.stack([records[name] for name in ("steps", "iterations", "rejected")], axis=1)

    @cached_property
    def errors(self) -> tuple[RunError | None, ...]:
        """The error of each run that stopped early; asked for when all have ended."""
        batch, errors = self.batch, list[RunError | None]([None] * len(self.start))
        for k in np.flatnonzero(batch.records["failed"]).tolist():
            seen = np.vstack([self.start[k], batch.states[k]])
            at = float(batch.records["t"][k]), batch.x[k]
            errors[k] = stuck_error(self.systems[k], METHOD, *at, seen, jumps=batch.jumps)
        return tuple(errors)

    def trajectory(self, k: int) -> Trajectory:
        """Return run k; raise its error, with the samples it reached, if it stopped."""
        if error := self.errors[k]:
            error.reached = self.reached(k)
            raise error
        return self._so_far(k)

    def reached(self, k: int) -> tuple[FloatArray, Trajectory]:
        """Return the times and run k until the end of its last step."""
        batch = self.batch
        t = batch.records["t"][k : k + 1]
        last = self._run(k, t, batch.x[k : k + 1], batch.ledgers[k, :1])
        return self._so_far(k).until(self.times, float(t[0]), last)

    def later(self, since: float) -> tuple[FloatArray, Trajectory]:
        """Return the first run at the samples that it has reached behind a time [s]."""
        return self._so_far(0).later(self.times, float(self.batch.records["t"][0]), since)

    def _so_far(self, k: int) -> Trajectory:
        return self._run(k, self.times, self.states[k], self.sums[k])

    def _run(self, k: int, times: FloatArray, states: FloatArray, sums: FloatArray) -> Trajectory:
        """Return run k from its rows at some times; those that it has not reached are nan."""
        numerical = self.batch.extra > 0
        steps, iterations, refused = self.work[k].tolist()
        return Trajectory(
            start=self.start[k],
            states=states.T,
            inputs=self.systems[0].inputs.at_samples(times),
            integrals=sums.T[:-2] if numerical else sums.T,
            steps=steps,
            evaluations=iterations,
            halvings=refused,
            numerical=sums.T[-2:] if numerical else None,
        )


def collocate(
    systems: Sequence[DrivenModule],
    engine: Engine,
    x: FloatArray,
    times: FloatArray,
    accuracy: float | FixedStep,
    watch: Watch | None = None,
    *,
    ended: Ended | None = None,
    stages: int | None = None,
    starts: bool = False,
    side_by_side: bool = True,
) -> Runs:
    """Return runs from the states x (runs, n) at t = 0 to the last sample time (nt,).

    With a tolerance, a coarse run first finds the scale of each state, in which errors are
    measured. Fixed steps end at samples and at breaks of inputs.

    Parameters
    ----------
    systems : with equal inputs and sizes.
    ended : says of the first run so far whether all runs may end there.
    stages : of a step with a tolerance; the cheapest number when left out.
    starts : whether the first fixed step after a jump of the inputs is dissipative.
    side_by_side : whether runs of few states share vectors.
    """
    first = systems[0]
    how = stepping(first, accuracy, stages)
    layout = layout_of(len(x) if side_by_side else 1, x.shape[1])
    parameters = [system.parameters for system in systems]
    given = engine, parameters, x, first.inputs, times, how, layout
    batch = Batch(*given, extra=2 if starts else 0)
    runs = Runs(systems, x, times, batch.states, batch.sums, batch)
    try:
        if starts:
            advance_from_jumps(batch, how, first.inputs, times, watch)
        elif not how.fixed:
            set_scales(batch, systems, x, how.tolerance)
        advance(batch, watch, (lambda t: ended(t, runs.later)) if ended else None)
    except KeyboardInterrupt as stopped:
        batch.call("halt")
        vars(stopped)["reached"] = runs.reached(0)
        raise
    return runs


def set_scales(
    batch: Batch, systems: Sequence[DrivenModule], x: FloatArray, tolerance: float
) -> None:
    """Set the scale of each state of runs from x (runs, n), by a coarse run."""
    first = systems[0]
    batch.survey(min(first.inputs.max_step, SURVEYED * first.inputs.duration))
    batch.largest[:] = first.scale(batch.largest)
    quiet = batch.largest < QUIET / tolerance
    if not quiet.any():
        return
    for n in np.flatnonzero(quiet.any(axis=1)).tolist():
        batch.noise[n] = systems[n].noise(x[n], batch.largest[n])
    least = first.scale(OVER_NOISE * batch.noise / tolerance)
    batch.largest[:] = np.maximum(batch.largest, least)


def advance_from_jumps(
    batch: Batch, how: Stepping, inputs: Inputs, times: FloatArray, watch: Watch | None
) -> None:
    """Advance runs to the last jump of the inputs, with a dissipative step after each jump."""
    for segment in inputs.segments:
        if segment.start in inputs.jumps:
            batch.go_on(how, segment.start)
            advance(batch, watch)
            until = min([segment.stop, *times[times > segment.start][:1].tolist()])
            span = until - segment.start
            steps = max(1, ceil(span / how.fixed * (1 - ROUNDING)))
            stop = until if steps == 1 else segment.start + span / steps
            dissipative_step(batch, how, stop, span / steps)
    batch.go_on(how, inputs.end)


def advance(
    batch: Batch, watch: Watch | None = None, ended: Callable[[float], bool] | None = None
) -> None:
    """Advance runs until they have `ended`, and tell `watch` the mean time they have reached."""
    most = max(1, CHUNK // batch.x.shape[1])
    most = max(FEWEST, most // ASKED) if ended else most
    while batch.go(most) and not (ended and ended(float(batch.records["t"][0]))):
        if watch:
            watch(float(np.mean(batch.records["t"])))
    if watch:
        watch(float(np.mean(batch.records["t"])))


def stepping(system: DrivenModule, accuracy: float | FixedStep, stages: int | None) -> Stepping:
    """Return the options of steps for a tolerance or a fixed step."""
    if isinstance(accuracy, FixedStep):
        h = accuracy.length
        return Stepping(accuracy.order // 2, 0.0, h, h, fixed=h)
    inputs = system.inputs
    if not inputs.duration / inputs.max_step <= MOST_STEPS:
        step = f"steps of {inputs.max_step:g} s, over 10^12 of them"
        what = f"a run of {inputs.duration:g} s would take {step}"
        remedy = "a shorter run, or slower inputs"
        raise RunError(what, f"model '{system.module.NAME}'", remedy=remedy)
    best, caution = stages_for(accuracy)
    return Stepping(
        stages=stages or best,
        tolerance=caution * accuracy,
        first=FIRST * inputs.duration,
        longest=min(inputs.longest_step, LONGEST * inputs.duration),
        kinks="either" if accuracy >= LEAST_OVER else "end",
    )


def stages_for(rtol: float) -> tuple[int, float]:
    """Return the number of stages, and the tolerance of a step's estimated error over rtol."""
    return next((stages, part) for least, stages, part in STAGES if rtol >= least)


def layout_of(runs: int, states: int) -> Layout:
    """Return what vectors hold in runs of this many states; results do not depend on it."""
    if states > MOST_STATES:
        return "lanes"
    return "many" if runs > 1 else "one"


def read_order(order: object, where: str) -> int:
    """Return the order of a step; raise `UsageError` if it is not in `ORDERS`."""
    if isinstance(order, bool) or not isinstance(order, int) or order not in ORDERS:
        raise UsageError(f"{quote(order)} is no order of steps", where, listing(map(str, ORDERS)))
    return order


def dissipative_step(batch: Batch, plain: Stepping, stop: float, length: float) -> None:
    """Advance runs to `stop` by four dissipative quarter steps.

    Where these fail, ordinary quarter steps follow: at an energy that is not convex, dissipative
    steps of any length consume entropy.
    """
    failed = batch.records["failed"].copy()
    quarter = replace(plain, first=0.25 * length, fixed=0.25 * length)
    batch.go_on(replace(quarter, stages=1, lossy=True), stop)
    advance(batch)
    batch.records["failed"] = failed
    batch.go_on(quarter, stop)
    advance(batch)
