"""Runs of the discrete gradient as `simulate` gives them: what they took, and why one stopped.

Input: a `DrivenModule`, its engine, the state x (n,) at t = 0, the sample times, and a tolerance or
a step.  Output: a `Trajectory` whose samples lie in the domain, and the attributes of the run; or a
`RunError` that says which condition of the domain the state leaves, when, and with which values.
"""

import numpy as np

from piezo_sym.errors import RunError, UsageError
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.collocation import FixedStep, choice, collocate
from piezo_sym.run.engine import Engine
from piezo_sym.run.engine.batch import is_lossy
from piezo_sym.run.guard import check_inputs
from piezo_sym.run.ledger import Trajectory
from piezo_sym.run.runs import METHOD, Watch
from piezo_sym.run.scipy_runs import cause
from piezo_sym.run.system import DrivenModule

#: Of a step: one that is shorter by less is rounded, not cut.
SAME = 1e-6
#: No better accuracy is asked for: round-off is all that would be left.
LEAST_RTOL = 1e-12


def compiled_run(
    system: DrivenModule,
    engine: Engine,
    x: FloatArray,
    samples: FloatArray,
    rtol: float,
    step: FixedStep | None,
    watch: Watch | None = None,
    *,
    starts: bool = False,
) -> tuple[Trajectory, dict[str, object]]:
    """Return a run with a fixed step, or with a tolerance where `step` is None.

    Parameters
    ----------
    watch : told the time reached, now and then.
    starts : whether the first step after a jump of the inputs is dissipative.

    Raises
    ------
    UsageError : it shall be, but the model has no store to damp, or no body to take the loss.
    RunError : the state leaves the domain, or no step can go on; says when, and with which values.
    """
    if starts and not is_lossy(engine):
        what = f"model '{engine.module.NAME}' has no thermal_mass to take a loss, or no storage"
        remedy = "leave it out, or add a thermal_mass"
        raise UsageError(what, "simulate.dissipative_start", "False", remedy)
    if starts and step is None:
        what = "a run with a tolerance follows what a jump sets off, and damps nothing"
        raise UsageError(what, "simulate.dissipative_start", "False", "leave it out, or give step")
    check_inputs(system, x, samples)
    rtol = max(rtol, LEAST_RTOL)
    accuracy: dict[str, object]
    try:
        if step is None:
            accuracy = {"rtol": rtol, "order": 2 * choice(rtol)[0]}
        else:
            shortest = shortest_step(system, samples, step.length)
            accuracy = {"step": step.length, "order": step.order, "shortest_step": shortest}
        runs = collocate([system], engine, x[None], samples, step or rtol, watch, starts=starts)
        trajectory = runs.trajectory(0)
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


def shortest_step(system: DrivenModule, samples: FloatArray, step: float) -> float:
    """Return the shortest step [s] of a run with a fixed one, but for halvings.

    Steps end at samples and at breaks of inputs; those between two of them are equal.
    """
    segments = system.inputs.segments
    inner = samples[(samples > segments[0].start) & (samples < segments[-1].stop)]
    edges = [segment.start for segment in segments] + [segments[-1].stop]
    widths = np.diff(np.union1d(inner, edges))
    rounding = 4 * np.finfo(float).eps * edges[-1] / step
    taken = float(np.min(widths / np.maximum(1, np.ceil(widths / step - rounding))))
    return step if taken > step * (1 - SAME) else taken
