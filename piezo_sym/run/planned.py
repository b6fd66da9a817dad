"""A run that is ready to go: its system, start and method; and its Dataset.

Input: what `simulate` has read.  Output: the samples at any times, and the Dataset of a run, with
its events if there are any.  An error, or Ctrl-C, brings the Dataset so far.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, final

import numpy as np

from piezo_sym.errors import RunError
from piezo_sym.run.compiled import compiled_run
from piezo_sym.run.dataset import to_dataset
from piezo_sym.run.events import event_variables, look
from piezo_sym.run.guard import check_start
from piezo_sym.run.inputs import read_inputs
from piezo_sym.run.parameters import read_initial
from piezo_sym.run.scipy_runs import by_scipy
from piezo_sym.run.system import DrivenModule

if TYPE_CHECKING:
    from collections.abc import Mapping

    import xarray

    from piezo_sym.run.checks import FloatArray
    from piezo_sym.run.collocation import FixedStep
    from piezo_sym.run.events import Watched
    from piezo_sym.run.inputs import InputValue
    from piezo_sym.run.ledger import Trajectory
    from piezo_sym.run.method import ChosenMethod
    from piezo_sym.run.module import GeneratedModule
    from piezo_sym.run.parameters import LaneValue
    from piezo_sym.run.runs import Watch


@final
@dataclass(frozen=True)
class Request:
    """What a user wants to be run, but when and from where.

    Attributes
    ----------
    module, parameters : of the system.
    inputs : as the user gave them.
    chosen, rtol, step : the method, and its tolerance or step.
    starts : whether the first step after a jump of the inputs is dissipative.
    watch : told the time reached, now and then.
    """

    module: GeneratedModule
    parameters: Any
    inputs: Mapping[str, InputValue] | None
    chosen: ChosenMethod
    rtol: float
    step: FixedStep | None
    starts: bool
    watch: Watch | None

    def planned(
        self, start: float, duration: float, state: Mapping[str, LaneValue] | None
    ) -> PlannedRun:
        """Return the run from a time and a state.

        Raises
        ------
        UsageError, RunError : inputs or state are wrong, or outside the domain.
        """
        inputs = read_inputs(self.module, self.inputs, duration, start)
        system = DrivenModule(self.module, self.parameters, inputs)
        x = read_initial(self.module, self.parameters, inputs.segments[0].at(start), state)
        check_start(system, x)
        return PlannedRun(system, x, self.chosen, self.rtol, self.step, self.starts, self.watch)


@final
@dataclass(frozen=True)
class PlannedRun:
    """A run from the state x (n,), by a method and its tolerance or step.

    `starts`: whether the first step after a jump of the inputs is dissipative; `watch` is told the
    time reached, now and then.
    """

    system: DrivenModule
    x: FloatArray
    chosen: ChosenMethod
    rtol: float
    step: FixedStep | None
    starts: bool
    watch: Watch | None

    def go(self, samples: FloatArray) -> tuple[Trajectory, dict[str, object]]:
        """Return the run at its samples (nt,), and what it took; an error holds what it reached."""
        system, x, chosen = self.system, self.x, self.chosen
        if chosen.engine:
            given = system, chosen.engine, x, samples, self.rtol, self.step, self.watch
            return compiled_run(*given, starts=self.starts)
        return by_scipy(system, x, samples, chosen.method, self.rtol, self.watch)

    def dataset(self, samples: FloatArray, watched: Watched) -> xarray.Dataset:
        """Return the run as a Dataset, with its events.

        Raises
        ------
        RunError, KeyboardInterrupt : the run stopped; `partial` is the Dataset so far.
        """
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
        told = {"method": self.chosen.method, **attrs, "engine": self.chosen.note}
        return to_dataset(self.system, times, trajectory, told)

    def _watched(self, samples: FloatArray, watched: Watched) -> xarray.Dataset:
        """Return the run with its events, until it stops."""
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
