"""`simulate`: a spec's generated module, and a run of it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from piezo_sym.modules import module_of
from piezo_sym.run import simulate as run

if TYPE_CHECKING:
    import xarray

    from piezo_sym.spec.model import Model


def simulate(model: str | Path | Model, **options: Any) -> xarray.Dataset:
    """Run a model and return all its quantities over time.

    Parameters
    ----------
    model : the name of a shipped spec, the path of a spec file, or a `Model`.
    **options : inputs, duration, rtol, parameters, initial, method, times: see
        `piezo_sym.run.simulate`.

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
