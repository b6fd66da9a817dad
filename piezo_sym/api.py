"""Specs run: `simulate`, `Stepper` and steady states, of a spec's generated module.

Input: the name of a shipped spec, a path or a `Model`, and the options of what is called.  Output:
what that returns for the module.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
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
from piezo_sym.run.stepper import Stepper as Steps

if TYPE_CHECKING:
    from piezo_sym.spec.model import Model

Spec: TypeAlias = "str | Path | Model"
P = ParamSpec("P")
R = TypeVar("R")


def of_spec(run: Callable[Concatenate[Any, P], R]) -> Callable[Concatenate[Spec, P], R]:
    """Return a function of a generated module as one of a spec: a name, a path or a `Model`."""

    def call(model: Spec, *args: P.args, **given: P.kwargs) -> R:
        return run(module_of(model), *args, **given)

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


simulate = of_spec(_with_bar(run))


def Stepper(
    model: Spec,
    *,
    step: float,
    order: int = 2,
    parameters: Mapping[str, LaneValue] | None = None,
    initial: Mapping[str, LaneValue] | None = None,
    inputs: Mapping[str, float] | None = None,
) -> Steps:
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

    Parameters
    ----------
    model : the name of a shipped spec, the path of a spec file, or a `Model`.
    step : length of a step [s]; the step is halved inside where it has to be.
    order : 2, 4, 6, 8 or 10: by which power of the step its error falls, where all is smooth.
    parameters, initial, inputs : as for `simulate`; `inputs` are those at t = 0, numbers only.

    Returns
    -------
    Stepper
        With ``.step(u) -> y``, ``.x``, ``.time``, ``.ledger``, ``.reset()``, and the names
        ``.states``, ``.inputs``, ``.outputs``; see `piezo_sym.run.stepper.Stepper`.

    Raises
    ------
    UsageError, EngineError, RunError
        If an option is wrong, there is no compiler, or the start is outside the domain.
    """
    return Steps(
        module_of(model),
        step=step,
        order=order,
        parameters=parameters,
        initial=initial,
        inputs=inputs,
    )
