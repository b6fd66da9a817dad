"""A prepared run: its system, start and method; and its Dataset.

Input: the checked arguments of `simulate`.  Output: the samples at any times, and the Dataset of
the run with its events.  An error, or Ctrl-C, has the Dataset up to then; the error of a run in C
says which condition of the domain the state violates, when, and with which values.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, final

import numpy as np

from piezo_sym.errors import RunError, UsageError
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.collocation import METHOD, Ended, FixedStep, Watch, collocate, stages_for
from piezo_sym.run.dataset import Trajectory, to_dataset
from piezo_sym.run.engine.batch import is_lossy
from piezo_sym.run.engine.engine import Engine
from piezo_sym.run.events import at_last, event_variables, locate, stop_margin
from piezo_sym.run.guard import SLACK, check_inputs, check_start
from piezo_sym.run.inputs import InputValue, read_inputs
from piezo_sym.run.method import ChosenMethod
from piezo_sym.run.module import GeneratedModule
from piezo_sym.run.parameters import Given, read_initial
from piezo_sym.run.scipy_runs import by_scipy, stop_cause
from piezo_sym.run.system import DrivenModule
from piezo_sym.run.watched import Watched, element_variables

if TYPE_CHECKING:
    import xarray

#: Below this rtol of the discrete gradient, errors are round-off.
LEAST_RTOL = 1e-12
#: A run whose inputs leave the domain ends this part of it before.
BEFORE = 1e-6


@final
@dataclass(frozen=True)
class Request:
    """The arguments of a run, except for its time and its start."""

    module: GeneratedModule
    parameters: Any
    inputs: Mapping[str, InputValue] | None  # as the user gave them
    chosen: ChosenMethod
    rtol: float
    step: FixedStep | None
    starts: bool  # whether the first step after a jump of the inputs is dissipative
    watch: Watch | None
    outputs: tuple[str, ...] = ()  # quantities of elements
    slack: float = SLACK  # of the stops' limits at the start

    def planned(self, start: float, duration: float, state: Given | None) -> PlannedRun:
        """Return the run from a time [s] and a state, and check that it can start there."""
        inputs = read_inputs(self.module, self.inputs, duration, start)
        system = DrivenModule(self.module, self.parameters, inputs)
        x = read_initial(self.module, self.parameters, inputs.segments[0].at(start), state)
        check_start(system, x, self.slack)
        return PlannedRun(self, system, x)


@final
@dataclass(eq=False)
class _Passes:
    """Runs from the same state with other samples.

    Attributes
    ----------
    failed : the error of each that failed, after it had reached a sample.
    work : of the last one.
    first : what the first one reached: times, and the run there.
    """

    planned: PlannedRun
    failed: list[RunError] = field(default_factory=list)
    work: dict[str, object] = field(default_factory=dict)
    first: tuple[FloatArray, Trajectory] | None = None

    def run(self, times: FloatArray, ended: Ended | None) -> tuple[FloatArray, Trajectory]:
        """Return the given times that a run reaches, and the run there."""
        try:
            trajectory, attrs = self.planned.run(times, ended)
        except RunError as error:
            if error.reached is None or not error.reached[0].size:
                raise
            self.failed.append(error)
            times, trajectory = error.reached
        except KeyboardInterrupt as stopped:
            self.first = self.first or vars(stopped).get("reached")
            raise
        else:
            self.work.update(attrs)
        found = trajectory.reached(times)
        self.first = self.first or found
        return found


@final
@dataclass(frozen=True)
class PlannedRun:
    """A run from the state x (n,)."""

    request: Request
    system: DrivenModule
    x: FloatArray

    def run(
        self, samples: FloatArray, ended: Ended | None = None
    ) -> tuple[Trajectory, dict[str, object]]:
        """Return the run at its samples (nt,), and its work; an error has the samples reached.

        Behind its end there are no numbers.
        """
        request, engine = self.request, self.request.chosen.engine
        if engine:
            return self._compiled(engine, samples, ended)
        options = request.chosen.method, request.rtol, request.watch, ended
        return by_scipy(self.system, self.x, samples, *options)

    def _compiled(
        self, engine: Engine, samples: FloatArray, ended: Ended | None
    ) -> tuple[Trajectory, dict[str, object]]:
        """Return the run in C, with a fixed step or a tolerance."""
        request, system, x, step = self.request, self.system, self.x, self.request.step
        if request.starts:
            _check_dissipative(engine, step)
        try:
            check_inputs(system, x, samples)
        except RunError as error:
            error.reached = self._run_before(error.time, samples, ended)
            raise
        rtol = max(request.rtol, LEAST_RTOL)
        accuracy: dict[str, object] = {"rtol": rtol, "order": 2 * stages_for(rtol)[0]}
        try:
            if step:
                accuracy = {"step": step.length, "order": step.order}
            given = [system], engine, x[None], samples, step or rtol, request.watch
            trajectory = collocate(*given, ended=ended, starts=request.starts).trajectory(0)
        except RunError as stopped:
            cause = stop_cause(system, x, samples, stopped)
            cause.reached = stopped.reached
            raise cause from stopped
        work = {
            "accepted_steps": trajectory.steps,
            "newton_iterations": trajectory.evaluations,
            "halvings": trajectory.halvings,
        }
        return trajectory, {"method": METHOD, **accuracy, **work}

    def _run_before(
        self, end: float, samples: FloatArray, ended: Ended | None
    ) -> tuple[FloatArray, Trajectory]:
        """Return the run to shortly before its inputs leave the domain at `end` [s].

        An error before then replaces that of the inputs.
        """
        start = self.system.inputs.start
        before = np.union1d(samples[samples < end], [end - BEFORE * (end - start)])
        inputs = replace(self.system.inputs, duration=float(before[-1]) - start)
        shorter = replace(self, system=replace(self.system, inputs=inputs))
        return shorter.run(before, ended)[0].reached(before)

    def dataset(self, samples: FloatArray, watched: Watched) -> xarray.Dataset:
        """Return the run as a Dataset with its events; `partial` of an error is that so far."""
        try:
            if watched:
                return self._dataset_with_events(samples, watched)
            trajectory, work = self.run(samples)
        except (RunError, KeyboardInterrupt) as stopped:
            times, seen = getattr(stopped, "reached", None) or (samples[:0], None)
            if getattr(stopped, "partial", None) is None and seen is not None and times.size:
                why = str(stopped) or "stopped by the user"
                vars(stopped)["partial"] = self._dataset_of(times, seen, {"stopped": why})
            raise
        return self._dataset_of(samples, trajectory, work)

    def _dataset_of(
        self, times: FloatArray, trajectory: Trajectory, attrs: dict[str, object]
    ) -> xarray.Dataset:
        chosen = self.request.chosen
        attrs = {"method": chosen.method, **attrs, "engine": chosen.note}
        outputs = element_variables(self.system, trajectory, self.request.outputs)
        return to_dataset(self.system, times, trajectory, attrs, outputs)

    def _dataset_with_events(self, samples: FloatArray, watched: Watched) -> xarray.Dataset:
        passes = _Passes(self)
        try:
            located = locate(self.system, watched, samples, passes.run)
        except KeyboardInterrupt as stopped:
            if passes.first:
                vars(stopped)["reached"] = self._sampled(*passes.first, samples, watched)
            raise
        failed, work = passes.failed, passes.work
        ends, kept = located.end is None and bool(failed), samples
        if ends:
            work["stopped"] = str(failed[0])
        if located.end is not None:
            kept = np.append(samples[samples < located.end], located.end)
            work["stopped"] = f"{watched.condition} at t = {located.end:.9g} s"
        at = np.unique(np.concatenate([kept, *located.times.values()]))
        times, seen = passes.run(at, None if located.end is None else at_last(at))
        kept = np.union1d(kept[kept <= times[-1]], times[-1:]) if ends else kept
        dataset = self._dataset_of(kept, seen.at(np.searchsorted(times, kept)), work)
        dataset = dataset.assign(dict(event_variables(self.system, located, times, seen)))
        if ends:
            failed[0].partial = dataset
            raise failed[0]
        return dataset

    def _sampled(
        self, times: FloatArray, seen: Trajectory, samples: FloatArray, watched: Watched
    ) -> tuple[FloatArray, Trajectory]:
        """Return a run, sampled more often, at its samples and its last time before it stops."""
        holds = stop_margin(self.system, watched, seen) > 0 if watched.stop else np.zeros(1)
        count = int(np.argmax(holds)) if holds.any() else times.size
        kept = np.flatnonzero(np.isin(times[:count], samples) | (np.arange(count) == count - 1))
        return times[kept], seen.at(kept)


def _check_dissipative(engine: Engine, step: FixedStep | None) -> None:
    """Raise `UsageError` if there is no storage to damp, no body to heat, or no fixed step."""
    where = "simulate.dissipative_start"
    if not is_lossy(engine):
        what = f"model '{engine.module.NAME}' has no thermal_mass to take a loss, or no storage"
        raise UsageError(what, where, "False", "leave it out, or add a thermal_mass")
    if step is None:
        what = "a run with a tolerance follows what a jump sets off, and damps nothing"
        raise UsageError(what, where, "False", "leave it out, or give step")
