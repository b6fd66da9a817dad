"""The groups of benchmarks: the table of contents of this stage.

    group    what is compared                                            in
    rhs      one state's rates: lambdified, hand-written, generated      rates
    batch    rates at many states in one call, also by the peers         rates
    run      a short run at equal error                                  runs
    long     a run a hundred times as long                               runs
    making   derivation, proofs, files; small banks and large            making
    sweep    many runs                                                   sweeps
    hysteresis  stops and a Bouc-Wen spring, models of their own         hysteresis

Input: a `Model`, what drives it, and `Settings`.  Output: a `Report`.  All is measured in one
process, in turns, so that its ratios hold on a busy machine too.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from piezo_sym.errors import UsageError, nearest, quote
from tests.benchmarks.case_p import problem_of
from tests.benchmarks.hysteresis import hysteresis_rows
from tests.benchmarks.machine import machine
from tests.benchmarks.making import making_rows
from tests.benchmarks.peers import PEERS
from tests.benchmarks.rates import batch_rows, rhs_rows
from tests.benchmarks.report import Part, Report
from tests.benchmarks.runs import run_rows
from tests.benchmarks.settings import THOROUGH
from tests.benchmarks.sweeps import sweep_rows

if TYPE_CHECKING:
    from piezo_sym import Model
    from piezo_sym.bench.problem import Problem
    from piezo_sym.run.inputs import InputValue
    from tests.benchmarks.settings import Settings

LONGER = 100


def _run(problem: Problem, settings: Settings) -> Part:
    return run_rows("run", problem, settings.run_target, settings, independent=True)


def _long(problem: Problem, settings: Settings) -> Part:
    longer = replace(problem, duration=problem.duration * LONGER)
    return run_rows("long", longer, settings.long_target, settings, independent=False)


GROUPS: Mapping[str, Callable[[Problem, Settings], Part]] = {
    "rhs": rhs_rows,
    "batch": batch_rows,
    "run": _run,
    "long": _long,
    "making": making_rows,
    "sweep": sweep_rows,
    "hysteresis": hysteresis_rows,
}
#: Groups that have models of their own.
OWN = frozenset({"hysteresis"})


def bench(
    model: Model,
    *,
    inputs: Mapping[str, InputValue] | None = None,
    duration: float = 0.1,
    only: Sequence[str] = (),
    settings: Settings = THOROUGH,
    say: Callable[[str], None] = lambda _: None,
) -> Report:
    """Measure a model, and return the report.

    Parameters
    ----------
    inputs : constants and sines; the spec's defaults where nothing is said, but for the paper's
        actuator, which is driven as in case P.
    duration : of the short run [s]; the long one takes a hundred times as long.
    only : names of groups; all but those with models of their own when empty.
    settings : how thoroughly to measure.
    say : told which group is being measured.

    Raises
    ------
    UsageError
        If a group is unknown, or an input is neither a constant nor a sine.
    """
    names = tuple(only) or tuple(name for name in GROUPS if name not in OWN)
    for name in names:
        if name not in GROUPS:
            raise UsageError(f"no group {quote(name)}", "--only", remedy=nearest(name, GROUPS))
    problem = problem_of(model, inputs or {}, duration)
    parts = []
    for name in dict.fromkeys(names):
        say(name)
        parts.append(GROUPS[name](problem, settings))
    return Report(
        model.name if set(names) - OWN else ", ".join(names),
        machine(peer.package for peer in PEERS),
        tuple(row for part in parts for row in part.rows),
        tuple(line for part in parts for line in part.left_out),
    )
