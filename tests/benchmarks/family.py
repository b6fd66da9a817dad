"""A family of runs: a problem with one parameter varied, and the state at the end of each run.

Input: a `Problem`, how many runs.  Output: `Family`.  The ends are those of an own tight run;
how far they are known is its distance to LSODA on the generated NumPy module, for some members.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, final

import numpy as np
import sympy as sp

from piezo_sym.bench.problem import explicit
from piezo_sym.errors import RunError
from piezo_sym.run.collocation import collocate
from piezo_sym.run.engine.engine import engine_of
from piezo_sym.run.module import lanes
from piezo_sym.run.parameters import own_initial, read_parameters
from piezo_sym.run.system import DrivenModule
from tests.benchmarks.case_p import SWEPT, case_p
from tests.benchmarks.ours import states, whole

if TYPE_CHECKING:
    from collections.abc import Sequence

    from piezo_sym.bench.problem import Problem
    from piezo_sym.run.checks import FloatArray

#: The parameter is varied between these multiples of its value.
LEAST, MOST = 0.5, 2.0
TIGHT, INDEPENDENT = 1e-9, ("LSODA", 1e-10)
CHECKED = 3


@final
@dataclass(frozen=True)
class Family:
    """Runs of one problem that differ in one parameter.

    Attributes
    ----------
    problem : its rates hold `symbol`, for which each member puts its own value.
    name, symbol, values : of the parameter; a value per member (members,).
    starts, ends : states (members, n) at t = 0 and at the end.
    good_to : how far the ends are known, in units of the scale.
    """

    problem: Problem
    name: str
    symbol: sp.Symbol
    values: FloatArray
    starts: FloatArray
    ends: FloatArray
    good_to: float

    def error(self, x: FloatArray) -> float:
        """Return the largest error of a state of any member, in units of the scale."""
        return self.problem.error(x, self.ends)

    @property
    def systems(self) -> list[DrivenModule]:
        """Each member's module, parameters and inputs."""
        return systems_of(self.problem, self.name, self.values)

    @property
    def line(self) -> str:
        """What errors are, in one line."""
        least, most = float(self.values[0]), float(self.values[-1])
        return (
            f"the largest of {len(self.values)} runs with {self.name} from {least:.3g} to "
            f"{most:.3g}, at the end, against an own run at rtol {TIGHT:g}, good to "
            f"{self.good_to:.0e} by {INDEPENDENT[0]} at rtol {INDEPENDENT[1]:g} for {CHECKED}"
        )


def family_of(problem: Problem, members: int) -> Family | str:
    """Return a problem's family, or why it has none.

    Raises
    ------
    EngineError
        If there is no compiler.
    RunError
        If a run stops.
    """
    name = varied(problem)
    if not name:
        return "the model has no positive parameter to vary"
    usual = float(getattr(problem.system.parameters, name))
    values = usual * np.geomspace(LEAST, MOST, members)
    systems = systems_of(problem, name, values)
    u = systems[0].inputs.segments[0].at(0.0)
    starts = np.array([own_initial(problem.module, s.parameters, u) for s in systems])
    ends, scale = tight(problem, systems, starts)
    opened = replace(problem, rates=_rates(problem, name), scale=scale, start=starts[0])
    checked = np.unique(np.linspace(0, members - 1, CHECKED).astype(int))
    single = [_independent(opened, name, float(value)) for value in values[checked]]
    good = opened.error(np.array(single), ends[checked])
    return Family(opened, name, sp.Symbol(name, real=True), values, starts, ends, good)


def varied(problem: Problem) -> str:
    """Return the name of the parameter to vary: the first positive one, case P's own first."""
    names = [record.name for record in problem.module.PARAMETERS]
    usual = SWEPT if case_p(problem.model.sha256, problem.inputs) else ""
    given = problem.system.parameters
    positive = (n for n in names if np.ndim(getattr(given, n)) == 0 and getattr(given, n) > 0)
    return usual or next((n for n in positive if not n.endswith("_count")), "")


def systems_of(problem: Problem, name: str, values: FloatArray) -> list[DrivenModule]:
    """Return the problem's system with each value of a parameter."""
    module, inputs = problem.module, problem.system.inputs
    changes = ({**problem.counts, name: value} for value in values.tolist())
    return [DrivenModule(module, read_parameters(module, change), inputs) for change in changes]


def tight(
    problem: Problem, systems: Sequence[DrivenModule], starts: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the states (members, n) at the end, and the scale of errors (n,)."""
    times = np.array([problem.duration])
    runs = collocate(systems, engine_of(problem.module), starts, times, TIGHT)
    for error in runs.errors:
        if error:
            raise error
    ends: FloatArray = runs.states[:, -1].copy()
    if case_p(problem.model.sha256, problem.inputs):
        return ends, problem.scale
    path = states(problem, whole(problem, 1e-6, 201))
    return ends, problem.system.scale(np.max(np.abs(path), axis=1))


def _rates(problem: Problem, name: str) -> tuple[sp.Expr, ...]:
    names = [record.name for record in problem.module.INPUTS]
    signals = dict(zip(names, problem.system.inputs.signals, strict=True))
    sizes = {bank: lanes(problem.system.parameters, bank) for bank in problem.module.BANKS}
    return explicit(problem.model, signals, sizes, name)[1]


def _independent(problem: Problem, name: str, value: float) -> FloatArray:
    method, rtol = INDEPENDENT
    one = replace(problem, counts={**problem.counts, name: value})  # type: ignore[dict-item]
    found = states(one, whole(one, rtol, [problem.duration], method))[:, -1]
    if not np.isfinite(found).all():
        raise RunError("LSODA gives no number", "bench", remedy="leave out the group")
    return found
