"""Runs that go on where another ended: its last state, its time, its parameters.

Input: a Dataset of `simulate`, of the same module.  Output: what the run after it starts from.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from piezo_sym.errors import UsageError, quote
from piezo_sym.run.checks import number
from piezo_sym.run.module import GeneratedModule
from piezo_sym.run.parameters import LaneValue

if TYPE_CHECKING:
    import xarray

WHERE = "simulate.initial"
PARAMETER = "parameter_"


def start_of(
    module: GeneratedModule,
    t0: float | None,
    initial: Mapping[str, LaneValue] | xarray.Dataset | None,
    parameters: Mapping[str, LaneValue] | None,
) -> tuple[float, Mapping[str, LaneValue] | None, Mapping[str, LaneValue] | None]:
    """Return when a run starts [s], from which state, and with which parameters."""
    start = None if t0 is None else number(t0, "simulate.t0")
    run: Any = initial
    if not hasattr(run, "data_vars"):  # no Dataset: xarray is not loaded to ask
        return start or 0.0, run, parameters
    model, sha256 = (str(run.attrs.get(key, "")) for key in ("model", "spec_sha256"))
    if "time" not in run.dims or not model:
        raise UsageError("this Dataset is no run of simulate()", WHERE)
    if (model, sha256) != (module.NAME, module.SPEC_SHA256):
        what = f"this is a run of model {quote(model)}, spec {sha256[:12]}"
        expected = f"one of model '{module.NAME}', spec {module.SPEC_SHA256[:12]}"
        raise UsageError(what, WHERE, expected)
    last = run.isel(time=-1)
    state: dict[str, Any] = {}
    for record in module.STATES:
        values = np.asarray(last[record.name].values, dtype=float)
        state[record.name] = values if record.bank else float(values)
    used: dict[str, Any] = {}
    for name, value in run.attrs.items():
        if str(name).startswith(PARAMETER):
            word = str(name).removeprefix(PARAMETER)
            used[word] = int(value) if word.endswith("_count") else np.asarray(value).tolist()
    return float(last.time) if start is None else start, state, {**used, **(parameters or {})}
