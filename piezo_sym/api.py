"""`simulate` and `Stepper`: a spec's generated module, and runs of it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

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
