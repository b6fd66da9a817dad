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

from numpy.typing import ArrayLike

from piezo_sym.analysis import branches, steady
from piezo_sym.analysis import operating_point as rest
from piezo_sym.modules import module_of
from piezo_sym.progress import watch_of
from piezo_sym.run import simulate as run
from piezo_sym.run.inputs import InputValue
from piezo_sym.run.parameters import LaneValue
from piezo_sym.run.stepper import Stepper as Steps

if TYPE_CHECKING:
    import xarray

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


def simulate(
    model: Spec,
    *,
    inputs: Mapping[str, InputValue] | None = None,
    duration: float,
    rtol: float | None = None,
    step: float | None = None,
    order: int | None = None,
    parameters: Mapping[str, LaneValue] | None = None,
    initial: Mapping[str, LaneValue] | None = None,
    method: str | None = None,
    times: int | ArrayLike | None = None,
    every: int | None = None,
    dissipative_start: bool = False,
    progress: bool | Callable[[float], object] | None = None,
) -> xarray.Dataset:
    """Run a model and return all its quantities over time.

    Parameters
    ----------
    model : the name of a shipped spec, the path of a spec file, or a `Model`.
    inputs : name -> number, (t, values), function of t [s], or signal; SI units.
    duration : length of the run [s].
    rtol : about the largest error of a state, in its largest magnitude; 1e-5 when left out.
    step, order : a fixed step [s] instead of rtol, of order 2 (when left out), 4, 6, 8 or 10.
    parameters, initial : name -> number, or for a bank a list of one number per lane; SI units.
    method : discrete_gradient when left out, or one of SciPy's.
    times : the samples: a number of even ones, or increasing times [s].
    every : with `step`, instead of `times`: a sample every so many steps, and at the end.
    dissipative_start : whether the first step after each jump of an input is damped, which reduces
        the states' error after it where steps are long.
    progress : True for a bar; or a function, told the time [s] reached.

        More on each: `help(piezo_sym.run.simulate)`.

    Returns
    -------
    xarray.Dataset
        Over ``time``: states, inputs, outputs, temperatures, energy, entropy and the ledger, in SI.

    Raises
    ------
    UsageError
        If an option is wrong; names it.
    RunError
        If a state leaves the domain or the solver cannot go on; says when and why.
    DriftError
        If the generated module is not of this spec.
    """
    with watch_of(progress, duration) as watch:
        return run(
            module_of(model),
            inputs=inputs,
            duration=duration,
            rtol=rtol,
            step=step,
            order=order,
            parameters=parameters,
            initial=initial,
            method=method,
            times=times,
            every=every,
            dissipative_start=dissipative_start,
            progress=watch,
        )


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
