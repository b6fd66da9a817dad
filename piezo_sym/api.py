"""Specs run: `simulate`, `Stepper` and steady states, of a spec's generated module.

Input: the name of a shipped spec, a path or a `Model`, and the options of what is called.  Output:
what that returns for the module.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import update_wrapper
from inspect import signature
from pathlib import Path
from typing import TYPE_CHECKING, Any, Concatenate, ParamSpec, TypeAlias, TypeVar

from piezo_sym.analysis import branches, steady
from piezo_sym.analysis import operating_point as rest
from piezo_sym.modules import module_of
from piezo_sym.progress import watch_of
from piezo_sym.run import simulate as run
from piezo_sym.run.parameters import LaneValue
from piezo_sym.run.plant import Plant
from piezo_sym.run.simulate import stages_of
from piezo_sym.run.stepper import Stepper as Steps

if TYPE_CHECKING:
    from piezo_sym.spec.model import Model

Spec: TypeAlias = "str | Path | Model"
P = ParamSpec("P")
R = TypeVar("R")


def of_spec(
    run: Callable[Concatenate[Any, P], R],
    stages: Callable[[Mapping[str, Any]], int | None] = lambda _: None,
) -> Callable[Concatenate[Spec, P], R]:
    """Return a function of a generated module as one of a spec: a name, a path or a `Model`.

    `stages` returns those of the steps that it takes, from its options.
    """

    def call(model: Spec, *args: P.args, **given: P.kwargs) -> R:
        return run(module_of(model, stages(given)), *args, **given)

    made: Any = update_wrapper(call, run)
    first, *others = signature(run).parameters.values()
    first = first.replace(name="model", annotation=Spec)
    made.__signature__ = signature(run).replace(parameters=[first, *others])
    return call  # type: ignore[return-value]  # the model may be given by name, too


operating_point = of_spec(rest.operating_point)
periodic_steady_state = of_spec(steady.periodic_steady_state)
periodic_steady_states = of_spec(steady.periodic_steady_states)
steady_branches = of_spec(branches.steady_branches)


def _with_bar(run: Callable[P, R]) -> Callable[P, R]:
    """Return `simulate` with a bar where `progress` is True, and none where it is False."""

    def call(*args: P.args, **given: P.kwargs) -> R:
        options: dict[str, Any] = given
        last = getattr(options.get("initial"), "time", None)
        start = options.get("t0") or (0.0 if last is None else float(last[-1]))
        with watch_of(options.get("progress"), options.get("duration"), start) as watch:
            return run(*args, **{**options, "progress": watch})

    return update_wrapper(call, run)


simulate = of_spec(_with_bar(run), stages_of)


def Stepper(
    model: Spec,
    *,
    step: float,
    order: int = 2,
    parameters: Mapping[str, LaneValue] | Sequence[Mapping[str, LaneValue]] | None = None,
    initial: Mapping[str, LaneValue] | None = None,
    inputs: Mapping[str, float] | None = None,
    sample: float | None = None,
    delay: int = 0,
    resolution: Mapping[str, float] | None = None,
) -> Any:
    """Return a model that goes step by step, with inputs that the caller decides.

    A PI controller of the actuator's position (q is the first state), 0.1 mm within 1 s:

    >>> from piezo_sym import Stepper
    >>> h, target, integral = 2e-5, 1e-4, 0.0
    >>> actuator = Stepper("piezo_stack", step=h)
    >>> for _ in range(50_000):
    ...     error = target - actuator.x[0]
    ...     integral += error * h
    ...     y = actuator.step([0.0, 2e4 * error + 4e7 * integral, 298.15])  # F_ext, V_in, T_e
    >>> print(f"q = {actuator.x[0] * 1e6:.2f} um at t = {actuator.time:.2f} s")
    q = 100.00 um at t = 1.00 s

    Three of them side by side, sampled at 5 kHz, with one sample of delay, drawn over time:

    >>> import numpy as np
    >>> from matplotlib import pyplot
    >>> dampings = [{"d": 300.0}, {"d": 400.0}, {"d": 500.0}]
    >>> plant = Stepper("piezo_stack", step=2e-5, sample=2e-4, delay=1, parameters=dampings)
    >>> integral, path = np.zeros(3), []
    >>> for _ in range(5000):
    ...     error = target - plant.x[0]
    ...     integral += error * 2e-4
    ...     voltage = 2e4 * error + 4e7 * integral
    ...     y = plant.step([np.zeros(3), voltage, np.full(3, 298.15)])
    ...     path.append(plant.x[0])
    >>> lines = pyplot.plot(np.array(path) * 1e6)

    Parameters
    ----------
    model : the name of a shipped spec, the path of a spec file, or a `Model`.
    step : length of a step [s]; the step is halved inside where it has to be.
    order : 2, 4, 6, 8 or 10: by which power of the step its error falls, where all is smooth.
    parameters, initial, inputs : as for `simulate`; `inputs` are those at t = 0, numbers only. A
        list of parameters makes as many plants side by side: u is (inputs, plants) or the same for
        all, y is (ports, plants), x (states, plants).
    sample : the time that inputs are held [s], a multiple of `step`; one step when left out.
    delay : whole samples from a call until its inputs act; `inputs` act until then.
    resolution : port -> its measurement is rounded to multiples of this, SI units.

    Returns
    -------
    Stepper or Plant
        With ``.step(u) -> y``, ``.x``, ``.time``, ``.reset()``, and the names ``.states``,
        ``.inputs``, ``.outputs``: a `piezo_sym.run.stepper.Stepper`, with ``.ledger``; or, of
        several, or with sample, delay or resolution, a `piezo_sym.run.plant.Plant`, with
        ``.ledgers``.

    Raises
    ------
    UsageError, EngineError, RunError
        If an option is wrong, there is no compiler, or the start is outside the domain.
    """
    given: Any = {"step": step, "order": order, "initial": initial, "inputs": inputs}
    module: Any = module_of(model, stages_of({"step": step, "order": order}))

    def made(parameters: Mapping[str, LaneValue] | None) -> Steps:
        return Steps(module, parameters=parameters, **given)

    if isinstance(parameters, Sequence) or sample is not None or delay or resolution:
        return Plant(made, parameters, step, sample, delay, resolution)
    return made(parameters)
