"""The parameters, initial state and sample times of a run, from a user's arguments.

Input: mappings of names to numbers, or for a bank to lists of one number per lane; times; a Dataset
to continue.  Output: the module's frozen `Parameters`, the state x (n,) at t = 0, and the times
(nt,) of the samples.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from piezo_sym.errors import RunError, UsageError, listing, quote
from piezo_sym.run.checks import (
    FloatArray,
    increasing,
    integer,
    is_number,
    is_vector,
    known_keys,
    number,
    positive,
    vector,
)
from piezo_sym.run.module import GeneratedModule, lanes, names_elsewhere, row_names, rows

if TYPE_CHECKING:
    import xarray

LaneValue: TypeAlias = float | Sequence[float] | FloatArray
Given: TypeAlias = Mapping[str, LaneValue]
Start: TypeAlias = "Given | xarray.Dataset"

#: A sample nearer to the end than this part of the duration is the end.
CLOSE = 1e-12
SAMPLES = 1001
MOST_LANES = 10_000_000
#: A run of more steps would take days, and they would be shorter than round-off.
MOST_STEPS = 1e11
#: The greatest relative change of a temperature that is small; how often a step is shortened.
LARGE, SHORTER = 1e-4, 300


def read_parameters(module: GeneratedModule, given: Given | None) -> Any:
    """Return the module's parameters with those a user gave in place of the defaults."""
    default = module.Parameters()
    banks = {record.name: record.bank for record in module.PARAMETERS}
    values, sizes = _checked_keys(module, given), read_sizes(module, given)
    merged = {name: values.get(name, value) for name, value in vars(default).items()}
    changed: dict[str, Any] = {
        name: lane_value(merged[name], sizes.get(bank or ""), f"simulate.parameters.{name}")
        for name, bank in banks.items()
    }
    return replace(default, **changed, **{f"{bank}_count": n for bank, n in sizes.items()})


def read_sizes(module: GeneratedModule, given: Given | None) -> dict[str, int]:
    """Return the number of lanes of each bank."""
    default, values = module.Parameters(), _checked_keys(module, given)
    sizes = {bank: values.get(f"{bank}_count", lanes(default, bank)) for bank in module.BANKS}
    where = "simulate.parameters"
    return {b: integer(n, f"{where}.{b}_count", 1, MOST_LANES) for b, n in sizes.items()}


def _checked_keys(module: GeneratedModule, given: Given | None) -> dict[str, Any]:
    """Return a user's parameters and sizes; raise `UsageError` at an unknown name."""
    names = [record.name for record in module.PARAMETERS]
    counts = [f"{bank}_count" for bank in module.BANKS]
    places = names_elsewhere(module, "parameters")
    return known_keys(given, (*names, *counts), "simulate.parameters", places)


def lane_value(value: object, size: int | None, where: str) -> float | tuple[float, ...]:
    """Return a number, or for a bank of `size` lanes (None: no bank) a tuple of one per lane."""
    if not is_vector(value):
        return number(value, where)
    if size is None:
        what = f"{quote(value)} is a list"
        raise UsageError(what, where, "one number: this belongs to no bank")
    values = tuple(vector(value, where).tolist())
    if len(values) != size:
        remedy = "give one number for all lanes, or one per lane"
        what = f"{len(values)} values for {size} lane{'s' * (size != 1)}"
        raise UsageError(what, where, f"{size}", remedy)
    return values


def read_initial(
    module: GeneratedModule, parameters: Any, u: FloatArray, given: Given | None
) -> FloatArray:
    """Return the state (n,) at t = 0, with inputs u (m,): the default, changed where given."""
    given = getattr(given, "initial", given)  # of an OperatingPoint
    refuse_run(module, given)
    if isinstance(given, Mapping):
        _refuse_single_lanes(module, parameters, given)
    names, places = [record.name for record in module.STATES], names_elsewhere(module, "initial")
    hot = {f"T_{record.name}": n for n, record in enumerate(module.BODIES)}
    values = known_keys(given, [*names, *hot], "simulate.initial", places)
    with np.errstate(all="ignore"):
        x = own_initial(module, parameters, u)
    for record, row in zip(module.STATES, rows(module.STATES, parameters), strict=True):
        if record.name in values:
            size = lanes(parameters, record.bank) if record.bank else None
            x[row] = lane_value(values[record.name], size, f"simulate.initial.{record.name}")
    for name in (name for name in hot if name in values and name not in names):
        where = f"simulate.initial.{name}"
        changed = set_temperature(module, parameters, x, hot[name], values[name], where)
        state = row_names(module.STATES, parameters)[changed]
        if state in values:
            raise UsageError(f"{quote(state)} is given too", where, "one of them")
    return x


def refuse_run(module: GeneratedModule, given: object) -> None:
    """Raise `UsageError` for a Dataset where a state is needed."""
    if hasattr(given, "data_vars"):
        states = [record.name for record in module.STATES]
        remedy = f"give {{name: run[name][-1] for name in {states}}}"
        raise UsageError("a Dataset is no state", WHERE, "state -> value", remedy)


def _refuse_single_lanes(module: GeneratedModule, parameters: Any, given: Iterable[str]) -> None:
    """Raise `UsageError` for a name such as phi_2: the lanes of a bank are given together."""
    banks = {record.name: record.bank for record in module.STATES if record.bank}
    for name in map(str, given):
        base, _, lane = name.rpartition("_")
        if base in banks and lane.isdigit():
            numbers = f"one number, or a list of {lanes(parameters, banks[base])}"
            remedy = f"give {base} {numbers}, on a command line {base}=1,2,..."
            raise UsageError(f"{quote(name)} is one lane of a bank", WHERE, "all lanes", remedy)


def own_initial(module: GeneratedModule, parameters: Any, u: FloatArray) -> FloatArray:
    """Return the module's initial state; outside the domain it may hold nan, and NumPy warn."""
    try:
        return np.array(module.initial_state(u, parameters), dtype=float)
    except (ArithmeticError, LookupError, ValueError) as cause:  # a list of another length, too
        what = f"the initial state cannot be computed: {cause}"
        raise RunError(what, f"model '{module.NAME}'", remedy="check the parameters") from cause


def sample_times(
    times: object, step: float | None, duration: float, start: float = 0.0
) -> FloatArray:
    """Return the times (nt,) of the samples [s]; ends of steps, where `times` is left out."""
    if step is not None and not duration / step <= MOST_STEPS:
        what = f"{step:g} s is too short a step for {duration:g} s: a run of over 10^11 steps"
        raise UsageError(what, "simulate.step", f"at least {duration / MOST_STEPS:.1g} s")
    if step is not None and step > duration * (1 + CLOSE):
        what = f"{step:g} s is longer than the run"
        raise UsageError(what, "simulate.step", f"at most {duration:g} s")
    where, end = "simulate.times", start + duration
    if times is None and step is not None:
        steps = int(np.ceil(duration / step * (1 - CLOSE)))
        apart = -(-steps // (SAMPLES - 1)) * step
        even = apart * np.arange(int(duration / apart * (1 - CLOSE)) + 1)
        return np.append(start + even, end)
    if times is None:
        return np.linspace(start, end, SAMPLES)
    if is_number(times) or isinstance(times, bool):
        return np.linspace(start, end, integer(times, where, 2))
    given = vector(times, where)
    late = end + CLOSE * max(abs(end), duration)
    given = increasing(np.where(given <= late, np.minimum(given, end), given), where)
    if not given.size or given[0] < start or given[-1] > end:
        span = f"times span {given[0]:g} s to {given[-1]:g} s" if given.size else "no times"
        raise UsageError(span, where, f"times within {start:g} s to {end:g} s")
    return given


WHERE = "simulate.initial"
PARAMETER = "parameter_"


def start_of(
    module: GeneratedModule, t0: float | None, initial: Start | None, parameters: Given | None
) -> tuple[float, Given | None, Given | None]:
    """Return when a run starts [s], from which state, and with which parameters."""
    start = None if t0 is None else number(t0, "simulate.t0")
    run: Any = initial
    if not hasattr(run, "data_vars"):  # no Dataset: xarray is not loaded to ask
        point = getattr(run, "parameters", None)  # of an OperatingPoint
        return start or 0.0, run, {**point, **(parameters or {})} if point else parameters
    model, sha256 = (str(run.attrs.get(key, "")) for key in ("model", "spec_sha256"))
    if "time" not in run.coords or not run.time.size or not model:
        raise UsageError("this Dataset is no run of simulate()", WHERE)
    if (model, sha256) != (module.NAME, module.SPEC_SHA256):
        what = f"this is a run of model {quote(model)}, spec {sha256[:12]}"
        expected = f"one of model '{module.NAME}', spec {module.SPEC_SHA256[:12]}"
        remedy = "give the run's own spec, and changed values as parameters (--set); "
        remedy += "of a spec whose laws have changed, give each state in 'initial' (--initial)"
        raise UsageError(what, WHERE, expected, remedy if model == module.NAME else "")
    state = at_end(run, [record.name for record in module.STATES])
    used: dict[str, Any] = {}
    for name, value in run.attrs.items():
        if str(name).startswith(PARAMETER):
            key = str(name).removeprefix(PARAMETER)
            used[key] = int(value) if key.endswith("_count") else np.asarray(value).tolist()
    end = float(run.time.values.flat[-1])
    return end if start is None else start, state, {**used, **(parameters or {})}


def at_end(run: Any, names: Sequence[str]) -> dict[str, Any]:
    """Return quantities at the last instant of a run; raise `UsageError` if it lacks one."""
    if missing := [name for name in names if name not in run.data_vars]:
        what = f"this Dataset has no {listing(map(repr, missing))}"
        raise UsageError(what, WHERE, "a whole run")
    last = run.isel(time=-1) if run.time.ndim else run  # of one instant
    return {name: last[name].values for name in names}


def set_temperature(
    module: GeneratedModule, p: Any, x: FloatArray, body: int, value: object, where: str
) -> int:
    """Set the entropy in x (n,) so that a body has this temperature [K]; return the entropy's row.

    Raises
    ------
    UsageError
        If the temperature is not positive, or no entropy gives it.
    """
    T = positive(value, where)
    row = entropy_row(module, p, x, body)
    x[row] = _entropy_at(module, p, x, body, row, T, where)
    return row


def entropy_row(module: GeneratedModule, p: Any, x: FloatArray, body: int) -> int:
    """Return the row of x (n,) that is an entropy and changes a body's temperature most."""
    size = np.maximum(np.abs(x), 1.0)
    change = np.abs(temperature_slopes(module, p, x)[body]) * size
    for record, at in zip(module.STATES, rows(module.STATES, p), strict=True):
        change[at] = change[at] if record.unit == "J/K" else -1.0
    return int(np.argmax(change))


def temperature_slopes(module: GeneratedModule, p: Any, x: FloatArray) -> FloatArray:
    """Return dT/dx (bodies, n) of each body's temperature, by central differences.

    A capacity may be so small that a step of 1e-6 J/K is no small one: each step changes no
    temperature by more than a part of 1e-4.
    """
    step = 1e-6 * np.maximum(np.abs(x), 1.0)
    with np.errstate(all="ignore"):
        here = np.asarray(module.temperatures(x, p))[:, None]
        for _ in range(SHORTER):
            ends = [module.temperatures(x[:, None] + np.diag(s), p) for s in (step, -step)]
            parts = np.max([np.abs(end / here - 1) for end in ends], axis=(0, 1), initial=0.0)
            large = ~(parts <= LARGE)
            if not large.any():
                break
            step = np.where(large, step / 10, step)
    return np.asarray((ends[0] - ends[1]) / (2 * step))


def _entropy_at(
    module: GeneratedModule, p: Any, x: FloatArray, body: int, row: int, T: float, where: str
) -> float:
    """Return the entropy [J/K] at which a body has the temperature T; it rises with the entropy."""
    from scipy.optimize import brentq  # loads slowly, and few runs ask for it

    def excess(entropy: float) -> float:
        y = x.copy()
        y[row] = entropy
        with np.errstate(all="ignore"):
            ratio = module.temperatures(y, p)[body] / T
        if np.isnan(ratio):
            raise UsageError(f"{T:g} K is out of the body's reach", where)
        return float(np.log(np.clip(ratio, 1e-300, 1e300)))  # a law may go below 0 K

    middle, reach = float(x[row]), 1e-9 * max(1.0, abs(float(x[row])))  # a capacity may be tiny
    while excess(middle - reach) > 0 or excess(middle + reach) < 0:
        reach *= 4
        if not np.isfinite(reach):
            raise UsageError(f"{T:g} K is out of the body's reach", where)
    return float(brentq(excess, middle - reach, middle + reach, xtol=1e-300, rtol=1e-15))
