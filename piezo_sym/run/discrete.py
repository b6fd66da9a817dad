"""Runs with a fixed step: Gauss collocation of a given order, both balances to round-off.

Input: systems that differ in parameters, their engine, their states at t = 0, the sample times and
a step.  Output: `Runs`.  Steps go over kinks.  If asked to, the first step after a jump of the
inputs is made of four dissipative quarters.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import ceil
from typing import final

from piezo_sym.errors import UsageError, listing, quote
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.collocation import layout_of, results, through
from piezo_sym.run.engine import Engine
from piezo_sym.run.engine.batch import Batch, Stepping
from piezo_sym.run.inputs import Segment
from piezo_sym.run.runs import Runs, Watch
from piezo_sym.run.system import System, Systems

#: Twice the stages that a step can have.
ORDERS = (2, 4, 6, 8, 10)
#: A step that is longer than the rest by less, in parts of it, is the rest.
ROUNDING = 1e-9


@final
@dataclass(frozen=True)
class FixedStep:
    """The longest step of a run [s], and by which power of it errors fall."""

    length: float
    order: int = 2


def fixed(
    systems: Sequence[System],
    engine: Engine,
    x: FloatArray,
    times: FloatArray,
    step: FixedStep,
    watch: Watch | None = None,
    *,
    starts: bool = False,
    side_by_side: bool = True,
) -> Runs:
    """Return runs with a fixed step; steps end at samples and at breaks of inputs.

    Parameters
    ----------
    systems : with equal inputs and sizes.
    x : their states (systems, n) at t = 0.
    watch : told the time reached, now and then.
    starts : whether the first step after a jump of the inputs is dissipative.
    side_by_side : whether runs of few states lie in the lanes of vectors.
    """
    known = Systems.of(systems)
    inputs = known[0].inputs
    length = step.length
    plain = Stepping(step.order // 2, 0.0, length, length, fixed=length)
    layout = layout_of(x, side_by_side=side_by_side)
    given = engine, known.parameters, x, inputs, times, plain, layout
    batch = Batch(*given, extra=2 if starts else 0)
    for segment in inputs.segments if starts else ():
        if segment.start in inputs.jumps:
            batch.go_on(plain, segment.start)
            through(batch, watch)
            start(batch, plain, *first_step(segment, times, length))
    batch.go_on(plain, inputs.duration)
    through(batch, watch)
    return results(batch, known, x, times)


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
