"""A run that is ready to go: its system, start and method; and its Dataset.

Input: what `simulate` has read.  Output: the samples at any times, and the Dataset of a run, with
its events if there are any.  An error, or Ctrl-C, brings the Dataset so far; the error of a run in
C says which condition of the domain the state leaves, when, and with which values.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, final

import numpy as np

from piezo_sym.errors import RunError, UsageError
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.collocation import METHOD, FixedStep, Watch, choice, collocate
from piezo_sym.run.dataset import Trajectory, element_variables, to_dataset
from piezo_sym.run.engine.batch import is_lossy
from piezo_sym.run.engine.engine import Engine
from piezo_sym.run.events import Watched, event_variables, look
from piezo_sym.run.guard import SLACK, check_inputs, check_start
from piezo_sym.run.inputs import InputValue, read_inputs
from piezo_sym.run.method import ChosenMethod
from piezo_sym.run.module import GeneratedModule
from piezo_sym.run.parameters import LaneValue, read_initial
from piezo_sym.run.scipy_runs import by_scipy, cause
from piezo_sym.run.system import DrivenModule

if TYPE_CHECKING:
    import xarray

#: No better accuracy is asked for: round-off is all that would be left.
LEAST_RTOL = 1e-12


@final
@dataclass(frozen=True)
class Request:
    """What a user wants to be run, but when and from where."""

    module: GeneratedModule
    parameters: Any
    inputs: Mapping[str, InputValue] | None  # as the user gave them
    chosen: ChosenMethod
    rtol: float
    step: FixedStep | None
    starts: bool  # whether the first step after a jump of the inputs is dissipative
    watch: Watch | None
    outputs: tuple[str, ...] = ()  # quantities of elements
    slack: float = SLACK  # of limits that the start has to keep

    def planned(
        self, start: float, duration: float, state: Mapping[str, LaneValue] | None
    ) -> PlannedRun:
        """Return the run from a time and a state, both checked."""
        inputs = read_inputs(self.module, self.inputs, duration, start)
        system = DrivenModule(self.module, self.parameters, inputs)
        x = read_initial(self.module, self.parameters, inputs.segments[0].at(start), state)
        check_start(system, x, self.slack)
        return PlannedRun(self, system, x)


@final
@dataclass(frozen=True)
class PlannedRun:
    """A run from the state x (n,)."""

    request: Request
    system: DrivenModule
    x: FloatArray

    def go(self, samples: FloatArray) -> tuple[Trajectory, dict[str, object]]:
        """Return the run at its samples (nt,), and what it took; an error holds what it reached."""
        request, system, x = self.request, self.system, self.x
        if request.chosen.engine:
            return compiled_run(request, request.chosen.engine, system, x, samples)
        return by_scipy(system, x, samples, request.chosen.method, request.rtol, request.watch)

    def dataset(self, samples: FloatArray, watched: Watched) -> xarray.Dataset:
        """Return the run as a Dataset, with its events; `partial` of an error is that so far."""
        try:
            if watched:
                return self._watched(samples, watched)
            trajectory, work = self.go(samples)
        except (RunError, KeyboardInterrupt) as stopped:
            times, seen = getattr(stopped, "reached", None) or (samples[:0], None)
            if seen is not None and times.size:
                why = str(stopped) or "stopped by the user"
                vars(stopped)["partial"] = self._made(times, seen, {"stopped": why})
            raise
        return self._made(samples, trajectory, work)

    def _made(
        self, times: FloatArray, trajectory: Trajectory, attrs: dict[str, object]
    ) -> xarray.Dataset:
        chosen = self.request.chosen
        told = {"method": chosen.method, **attrs, "engine": chosen.note}
        asked = element_variables(self.system, trajectory, self.request.outputs)
        return to_dataset(self.system, times, trajectory, told, asked)

    def _watched(self, samples: FloatArray, watched: Watched) -> xarray.Dataset:
        failed: list[RunError] = []
        work: dict[str, object] = {}

        def run(times: FloatArray) -> tuple[FloatArray, Trajectory]:
            try:
                found, told = self.go(times)
                work.update(told)
                return times, found
            except RunError as error:
                if error.reached is None:
                    raise
                failed[:] = [error]
                times, found = error.reached
                return times, found

        located = look(self.system, watched, samples, run(samples)[1].steps, run)
        if located.end is None and failed:
            run(samples)
            raise failed[0]
        kept = samples
        if located.end is not None:
            kept = np.append(samples[samples < located.end], located.end)
            work["stopped"] = f"{watched.condition} at t = {located.end:.9g} s"
        times, seen = run(np.unique(np.concatenate([kept, *located.times.values()])))
        made = self._made(kept, seen.at(np.searchsorted(times, kept)), work)
        return made.assign(dict(event_variables(self.system, located, times, seen)))


def compiled_run(
    request: Request, engine: Engine, system: DrivenModule, x: FloatArray, samples: FloatArray
) -> tuple[Trajectory, dict[str, object]]:
    """Return a run in C, with a fixed step or a tolerance, and what it took."""
    step = request.step
    if request.starts:
        _check_dissipative(engine, step)
    try:
        check_inputs(system, x, samples)
    except RunError as left:
        left.reached = _until(left.time, request, system, x, samples)
        raise
    rtol = max(request.rtol, LEAST_RTOL)
    accuracy: dict[str, object] = {"rtol": rtol, "order": 2 * choice(rtol)[0]}
    try:
        if step:
            accuracy = {"step": step.length, "order": step.order}
        given = [system], engine, x[None], samples, step or rtol, request.watch
        trajectory = collocate(*given, starts=request.starts).trajectory(0)
    except RunError as stopped:
        found = cause(system, x, samples, stopped)
        found.reached = stopped.reached
        raise found from stopped
    work = {
        "accepted_steps": trajectory.steps,
        "newton_iterations": trajectory.evaluations,
        "halvings": trajectory.halvings,
    }
    return trajectory, {"method": METHOD, **accuracy, **work}


def _until(
    left: float, request: Request, system: DrivenModule, x: FloatArray, samples: FloatArray
) -> tuple[FloatArray, Trajectory]:
    """Return a run to the last sample before its inputs leave the domain; its own error counts."""
    before = samples[samples < left]
    inside = (float(before[-1]) + left) / 2 - system.inputs.start
    shorter = replace(system, inputs=replace(system.inputs, duration=inside))
    return before, PlannedRun(request, shorter, x).go(before)[0]


def _check_dissipative(engine: Engine, step: FixedStep | None) -> None:
    """Raise `UsageError` if there is no store to damp, no body to take the loss, or no step."""
    where = "simulate.dissipative_start"
    if not is_lossy(engine):
        what = f"model '{engine.module.NAME}' has no thermal_mass to take a loss, or no storage"
        raise UsageError(what, where, "False", "leave it out, or add a thermal_mass")
    if step is None:
        what = "a run with a tolerance follows what a jump sets off, and damps nothing"
        raise UsageError(what, where, "False", "leave it out, or give step")
