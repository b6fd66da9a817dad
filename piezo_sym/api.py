"""Specs run: `simulate`, `Stepper` and steady states, of a spec's generated module.

Input: the name of a shipped spec, a path or a `Model`, and the options of what is called.  Output:
what that returns for the module.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from piezo_sym.analysis import branches, steady
from piezo_sym.modules import module_of
from piezo_sym.run import simulate as run
from piezo_sym.run.stepper import Stepper as Steps

if TYPE_CHECKING:
    import xarray

    from piezo_sym.spec.model import Model


def simulate(model: str | Path | Model, **options: Any) -> xarray.Dataset:
    """Run a model and return all its quantities over time.

    Parameters
    ----------
    model : the name of a shipped spec, the path of a spec file, or a `Model`.
    **options : inputs, duration, rtol or step, parameters, initial, method, times,
        dissipative_start: see `piezo_sym.run.simulate`.

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
    return run(module_of(model), **options)


def Stepper(model: str | Path | Model, **options: Any) -> Steps:
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
    **options : step, parameters, initial, inputs: see `piezo_sym.run.stepper.Stepper`.

    Returns
    -------
    Stepper
        With ``.step(u) -> y``, ``.x`` and ``.time``.

    Raises
    ------
    UsageError, EngineError, RunError
        If an option is wrong, there is no compiler, or the start is outside the domain.
    """
    return Steps(module_of(model), **options)


def periodic_steady_state(model: str | Path | Model, **options: Any) -> steady.SteadyState:
    """Return the periodic steady state that a driven model settles in.

    Parameters
    ----------
    model : the name of a shipped spec, the path of a spec file, or a `Model`, with one body.
    **options : inputs, frequency, parameters, initial, temperatures, rtol: see
        `piezo_sym.analysis.steady.periodic_steady_state`.

    Raises
    ------
    UsageError, RunError
        If an option is wrong, or there is no steady state in the range.
    """
    return steady.periodic_steady_state(module_of(model), **options)


def periodic_steady_states(
    model: str | Path | Model, **options: Any
) -> tuple[steady.SteadyState, ...]:
    """Return all periodic steady states of a driven model, stable or not, coldest first.

    Parameters
    ----------
    model, **options : as for `periodic_steady_state`.
    """
    return steady.periodic_steady_states(module_of(model), **options)


def steady_branches(model: str | Path | Model, **options: Any) -> branches.Branches:
    """Return the periodic steady states of a model over a range of frequencies, and the jumps.

    Parameters
    ----------
    model : the name of a shipped spec, the path of a spec file, or a `Model`, with one body.
    **options : inputs (a function of the frequency), frequencies, parameters, initial,
        temperatures: see `piezo_sym.analysis.branches.steady_branches`.
    """
    return branches.steady_branches(module_of(model), **options)
