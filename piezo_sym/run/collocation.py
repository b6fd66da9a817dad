"""Runs of Gauss collocation in C, with a tolerance or a fixed step: both balances to round-off.

Input: systems that differ in parameters, their engine, their states at t = 0, the sample times, and
a tolerance or a `FixedStep`.  Output: `Runs`, whose states are those of their ledgers.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from math import ceil
from typing import Any, TypeAlias, final

import numpy as np
from numpy.typing import NDArray

from piezo_sym.errors import PiezoError, RunError, UsageError, listing, quote
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.dataset import Trajectory
from piezo_sym.run.engine.batch import Batch, Stepping, collocation_library
from piezo_sym.run.engine.engine import Engine, engine_of
from piezo_sym.run.engine.library import Layout
from piezo_sym.run.inputs import Inputs, Segment
from piezo_sym.run.module import UNPROVED, GeneratedModule, row_count, verdict_of
from piezo_sym.run.system import DrivenModule

METHOD = "discrete_gradient"
#: Told the time that runs have reached, now and then; what it raises ends them.
Watch: TypeAlias = Callable[[float], object]
#: The first step, the longest, and the longest of the survey of scales, in parts of the run.
FIRST, LONGEST, SURVEYED = 1e-5, 0.25, 1 / 64
#: Numbers of state that are stepped between two calls of `watch`: some milliseconds.
CHUNK = 50_000
#: Runs of more states have vectors for the lanes of their banks.
MOST_STATES = 32
#: From this rtol on: the cheapest number of stages, and the estimated error allowed in a step, as a
#: part of rtol, with which the largest error of a run is about rtol.
CHOICE = ((1e-5, 4, 0.3), (0.0, 5, 0.75))
#: Below this tolerance steps end at kinks, however many there are.
LEAST_OVER = 1e-6
#: A run of more steps would take days, and steps below round-off.
MOST_STEPS = 1e12
#: Twice the stages that a step can have.
ORDERS = (2, 4, 6, 8, 10)
#: A step that would leave less than this part of itself before a sample or a break ends there.
ROUNDING = 1e-9


@final
@dataclass(frozen=True)
class FixedStep:
    """The longest step of a run [s], and by which power of it errors fall."""

    length: float
    order: int = 2


@final
@dataclass(frozen=True)
class Runs:
    """Runs of some systems, and why those that did not come through stopped."""

    systems: Sequence[DrivenModule]  # with equal inputs and sizes
    start: FloatArray  # their states (runs, n) at t = 0
    times: FloatArray  # of samples (nt,)
    states: FloatArray  # (runs, nt, n)
    sums: FloatArray  # (runs, nt, rows), in the order of `DrivenModule.rates`
    work: NDArray[Any]  # of each run its steps, Newton's iterations, steps refused (runs, 3)
    errors: Sequence[RunError | None]  # of each run
    numerical: bool  # whether sums end with heat and entropy that dissipative starts produce

    def trajectory(self, k: int) -> Trajectory:
        """Return run k; raise its error, which holds what was reached, if it stopped."""
        if error := self.errors[k]:
            error.reached = self.so_far(k).until(self.times)
            raise error
        return self.so_far(k)

    def so_far(self, k: int) -> Trajectory:
        """Return run k, whose samples are nan beyond what it reached."""
        sums = self.sums[k].T
        steps, evaluations, halvings = (int(number) for number in self.work[k])
        return Trajectory(
            start=self.start[k],
            states=self.states[k].T,
            inputs=self.systems[0].inputs.at_samples(self.times),
            integrals=sums[:-2] if self.numerical else sums,
            steps=steps,
            evaluations=evaluations,
            halvings=halvings,
            numerical=sums[-2:] if self.numerical else None,
        )


def collocate(
    systems: Sequence[DrivenModule],
    engine: Engine,
    x: FloatArray,
    times: FloatArray,
    accuracy: float | FixedStep,
    watch: Watch | None = None,
    *,
    stages: int | None = None,
    starts: bool = False,
    side_by_side: bool = True,
) -> Runs:
    """Return runs from their states x (runs, n) at t = 0 through the sample times (nt,).

    With a tolerance, a rough run first shows how large each state becomes; errors are measured by
    that. Fixed steps end at samples and at breaks of inputs.

    Systems have equal inputs and sizes. `stages` of a step with a tolerance are those that are
    cheapest for it, when left out; `starts`: the first fixed step after a jump of the inputs is
    dissipative; `side_by_side`: runs of few states lie in the lanes of vectors.
    """
    first = systems[0]
    how = stepping(first, accuracy, stages)
    lying, extra = layout_of(*x.shape, side_by_side=side_by_side), 2 if starts else 0
    batch = Batch(
        engine, [one.parameters for one in systems], x, first.inputs, times, how, lying, extra=extra
    )
    try:
        if starts:
            go_dissipatively(batch, how, first.inputs, times, watch)
        elif not how.fixed:
            batch.survey(min(first.inputs.max_step, SURVEYED * first.inputs.duration))
            batch.largest[:] = first.scale(batch.largest)
        through(batch, watch)
    except KeyboardInterrupt as stopped:
        vars(stopped)["reached"] = results(batch, systems, x, times).so_far(0).until(times)
        raise
    return results(batch, systems, x, times)


def go_dissipatively(
    batch: Batch, how: Stepping, inputs: Inputs, times: FloatArray, watch: Watch | None
) -> None:
    """Take runs up to the last jump of the inputs, and begin a dissipative step after each jump."""
    for segment in inputs.segments:
        if segment.start in inputs.jumps:
            batch.go_on(how, segment.start)
            through(batch, watch)
            start(batch, how, *first_step(segment, times, how.fixed))
    batch.go_on(how, inputs.end)


def through(batch: Batch, watch: Watch | None = None) -> None:
    """Take runs as far as they go; `watch` is told the time reached, now and then."""
    more = True
    while more:
        more = batch.go(max(1, CHUNK // batch.x.shape[1]))
        if watch:
            watch(float(np.mean(batch.records["t"])))


def results(
    batch: Batch, systems: Sequence[DrivenModule], x: FloatArray, times: FloatArray
) -> Runs:
    """Return the results of runs that began at x (runs, n)."""
    records = batch.records
    work = np.stack([records[n] for n in ("steps", "iterations", "rejected")], axis=1)
    errors: list[RunError | None] = [None] * len(x)
    for k in np.flatnonzero(records["failed"]).tolist():
        errors[k] = _stuck(systems[k], float(records["t"][k]), batch.x[k])
    arrays = batch.states, batch.sums, work
    return Runs(systems, x, times, *arrays, tuple(errors), numerical=batch.extra > 0)


def _stuck(system: DrivenModule, t: float, x: FloatArray) -> RunError:
    """Return the error of a run that cannot go on: it says when and where."""
    why = "no step stays in the domain, or a law that jumps holds the state there"
    remedy = "look at inputs and state; allow more room in [domain]; tanh(v/w) for sign(v)"
    if verdict_of(system.module).startswith(UNPROVED):
        why = f"each step leaves the domain or consumes entropy, and the model is {UNPROVED}"
        remedy = "mend what `piezo-sym verify` refutes; or take method LSODA, which goes on"
    names = [record.name for record in system.module.STATES]
    rows = system.rows(system.module.STATES)
    values = ", ".join(f"{n} = {x[row.start]:.6g}" for n, row in zip(names, rows, strict=True))
    what = f"{METHOD} cannot go on from t = {t:.6g} s at {values}: {why}"
    return RunError(what, f"model '{system.module.NAME}'", remedy=remedy)


def stepping(system: DrivenModule, accuracy: float | FixedStep, stages: int | None) -> Stepping:
    """Return how a run steps, with a tolerance or with a fixed step."""
    if isinstance(accuracy, FixedStep):
        h = accuracy.length
        return Stepping(accuracy.order // 2, 0.0, h, h, fixed=h)
    inputs = system.inputs
    if not inputs.duration / inputs.max_step <= MOST_STEPS:
        step = f"steps of {inputs.max_step:g} s, over 10^12 of them"
        what = f"a run of {inputs.duration:g} s would take {step}"
        remedy = "a shorter run, or slower inputs"
        raise RunError(what, f"model '{system.module.NAME}'", remedy=remedy)
    best, caution = choice(accuracy)
    return Stepping(
        stages=stages or best,
        tolerance=caution * accuracy,
        first=FIRST * inputs.duration,
        longest=min(inputs.longest_step, LONGEST * inputs.duration),
        kinks="either" if accuracy >= LEAST_OVER else "end",
    )


def choice(rtol: float) -> tuple[int, float]:
    """Return the stages of a run's steps, and what part of rtol a step's estimated error may be."""
    return next((stages, part) for least, stages, part in CHOICE if rtol >= least)


def layout_of(runs: int, states: int, *, side_by_side: bool) -> Layout:
    """Return what lies in vectors, for runs of so many states; results do not depend on it."""
    if states > MOST_STATES:
        return "lanes"
    return "many" if runs > 1 and side_by_side else "one"


def compile_ahead(module: GeneratedModule, stages: int) -> None:
    """Compile what one run of a module needs with steps of so many stages, if that can be done."""
    layout = layout_of(1, row_count(module.STATES, module.Parameters()), side_by_side=True)
    with suppress(PiezoError, OSError):  # the run says so
        collocation_library(engine_of(module), stages, layout)


def read_order(order: object, where: str) -> int:
    """Return an order; raise `UsageError` if steps have none such."""
    if isinstance(order, bool) or not isinstance(order, int) or order not in ORDERS:
        raise UsageError(f"{quote(order)} is no order of steps", where, listing(map(str, ORDERS)))
    return order


def first_step(segment: Segment, times: FloatArray, step: float) -> tuple[float, float]:
    """Return where the first step of a segment ends, and its length [s]."""
    later = times[times > segment.start]
    until = min(segment.stop, float(later[0])) if later.size else segment.stop
    span = until - segment.start
    steps = max(1, ceil(span / step * (1 - ROUNDING)))
    return (until if steps == 1 else segment.start + span / steps), span / steps


def start(batch: Batch, plain: Stepping, stop: float, length: float) -> None:
    """Take runs to `stop` by four dissipative quarters of a step.

    A run goes on by ordinary quarters from where there is no dissipative one: where an energy is
    not convex, these take entropy however short they are.
    """
    failed = batch.records["failed"].copy()
    quarter = replace(plain, first=0.25 * length, fixed=0.25 * length)
    batch.go_on(replace(quarter, stages=1, lossy=True), stop)
    through(batch)
    batch.records["failed"] = failed
    batch.go_on(quarter, stop)
    through(batch)
