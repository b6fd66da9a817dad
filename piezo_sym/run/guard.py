"""The domain guard: errors of runs that leave the domain in which the proofs hold.

Input: states and inputs along a run.  Output: nothing, or a `RunError` with the condition, the time
and the values that violate it.  A condition holds when its margin (greater minus smaller side) is
> 0 if it is strict, >= 0 otherwise; a margin of nan fails.
"""

import re
from collections.abc import Callable
from typing import Any

import numpy as np

from piezo_sym.errors import RunError, listing
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.inputs import Segment
from piezo_sym.run.module import GeneratedModule, by_name, row_name, rows
from piezo_sym.run.system import DrivenModule

NAME = re.compile(r"[A-Za-z_]\w*\b(?!\()")  # a name that is not called
MOST_VALUES = 4
#: Checks of inputs per longest step; the most numbers (checks times states) in a run.
CHECKS, MOST_NUMBERS = 4, 5_000_000

#: The name's ending for an element's largest effort; the part of it allowed beyond for round-off.
LIMIT, SLACK = ".limit", 1e-9

Value = tuple[str, str, "float | FloatArray"]  # label, unit, value


def check_start(system: DrivenModule, x: FloatArray, slack: float = SLACK) -> None:
    """Raise `RunError` if the run cannot start from the state x (n,) at t = 0.

    A stop may exceed its limit by `slack`, a fraction of the limit.
    """
    t = system.inputs.start
    u = system.inputs.segments[0].at(t)
    try:
        if np.any(system.violated(x, u)):
            raise domain_error(system, t, x, u)
        if not np.all(system.finite(x, u)):
            raise rate_error(system, t, x, u)
        check_limits(system, x, u, slack)
    except ArithmeticError as cause:
        what = f"the state at t = {t:g} s cannot be evaluated: {cause}"
        raise RunError(what, place(system), remedy="check the parameters") from cause


def limited(module: GeneratedModule) -> list[str]:
    """Return the elements that have a limit: stops."""
    return [r.name.removesuffix(LIMIT) for r in module.ELEMENTS if r.name.endswith(LIMIT)]


def stop_rows(module: GeneratedModule, p: Any, x: FloatArray, u: FloatArray) -> dict[str, slice]:
    """Return the rows of the state of each stop: no other state moves its effort."""
    found, stops = dict[str, slice](), limited(module)
    with np.errstate(all="ignore"):
        before = by_name(module.ELEMENTS, p, module.elements(x, u, p)) if stops else {}
        for own in rows(module.STATES, p) if stops else ():
            moved = x.copy()
            moved[own] = 2.0 * x[own] + 1.0
            after = by_name(module.ELEMENTS, p, module.elements(moved, u, p))
            for stop in stops:
                if np.any(np.asarray(after[f"{stop}.effort"]) != before[f"{stop}.effort"]):
                    found[stop] = own
    return found


def check_limits(system: DrivenModule, x: FloatArray, u: FloatArray, slack: float) -> None:
    """Raise `RunError` if a stop would start beyond its limit, from x (n,) under inputs u (m,)."""
    module, p, stops = system.module, system.parameters, limited(system.module)
    if not stops or slack == np.inf:
        return
    with np.errstate(all="ignore"):
        values = by_name(module.ELEMENTS, p, module.elements(x, u, p))
    for stop in stops:
        effort, limit = np.broadcast_arrays(values[f"{stop}.effort"], values[f"{stop}{LIMIT}"])
        beyond = np.abs(effort) > limit * (1 + slack)
        if np.any(beyond):
            at = np.argmax(beyond)
            lane = f" in lane {at + 1}" if beyond.ndim else ""
            what = f"stop '{stop}' starts beyond its limit{lane}: its effort is"
            what += f" {effort.flat[at]:.6g}, its limit {limit.flat[at]:.6g}"
            remedy = "change the initial state or the parameters of the stop"
            raise RunError(what, place(system), "abs(effort) <= limit", remedy)


def crossing(
    system: DrivenModule,
    left: float,
    right: float,
    path: Callable[[float], tuple[FloatArray, FloatArray]],
) -> float:
    """Return the first time [s] in (left, right] at which `path` (t -> x, u) is outside the domain.

    It is inside at `left` and outside at `right`; found by bisection, to round-off.
    """
    while (middle := left + (right - left) / 2) not in (left, right):
        if np.any(system.violated(*path(middle))):
            right = middle
        else:
            left = middle
    return right


def check_inputs(system: DrivenModule, x: FloatArray, samples: FloatArray) -> None:
    """Raise `RunError` if inputs leave the domain; steps check conditions on the state only.

    Conditions on inputs do not depend on the state, so x (n,) is the one at t = 0.
    """
    limits, rows = input_conditions(system)
    for segment in system.inputs.segments if rows else ():
        times = np.array([segment.start])
        if rows & {row for row, _ in segment.varying}:
            times = _times_to_check(system, segment, samples, MOST_NUMBERS / x.size)
        states = np.tile(x[:, None], times.size)
        failed = np.any(system.violated(states, segment.over(times))[limits], axis=0)
        if np.any(failed):
            raise _input_error(system, segment, x, times[: np.argmax(failed) + 1])


def input_conditions(system: DrivenModule) -> tuple[list[int], set[int]]:
    """Return which conditions are on inputs, and the rows of the inputs that they name."""
    texts = [condition.text for condition in system.module.DOMAIN]
    limits = [n for n, text in enumerate(texts) if depth(system, text) == 1]
    names = {name for n in limits for name in NAME.findall(texts[n])}
    return limits, {n for n, record in enumerate(system.module.INPUTS) if record.name in names}


def inputs_vary(system: DrivenModule) -> bool:
    """Return whether inputs that conditions name may vary: if not, t = 0 is checked alone."""
    _, rows = input_conditions(system)
    first, *others = system.inputs.segments
    return bool(rows) and bool(others or rows & {row for row, _ in first.varying})


def _input_error(
    system: DrivenModule, segment: Segment, x: FloatArray, times: FloatArray
) -> RunError:
    """Return the error of inputs that leave the domain between the last two of `times`."""
    t = float(times[-1])
    if times.size > 1:
        t = crossing(system, float(times[-2]), t, lambda time: (x, segment.at(time)))
    error = domain_error(system, t, x, segment.at(t))
    error.time = t
    return error


def _times_to_check(
    system: DrivenModule, segment: Segment, samples: FloatArray, most: float
) -> FloatArray:
    """Return the times at which a segment's inputs are checked: samples and at most `most` more."""
    part = (segment.stop - segment.start) / system.inputs.duration
    number = CHECKS * part * system.inputs.duration / system.inputs.max_step
    even = np.linspace(segment.start, segment.stop, 2 + int(min(number, most * part)))
    inner = samples[(samples > segment.start) & (samples < segment.stop)]
    return np.union1d(even, inner)


def domain_error(system: DrivenModule, t: float, x: FloatArray, u: FloatArray) -> RunError:
    """Return the error for a state outside the domain at t [s], with a condition that fails."""
    text, shown = broken(system, x, u)
    event = "state leaves" if t > system.inputs.start else "start is outside"
    what = f"{event} the domain at t = {t:.6g} s: {shown}"
    remedy = f"change {listing(remedies(system, text))}"
    return RunError(what, place(system), f"{text} throughout the run", remedy)


def broken(system: DrivenModule, x: FloatArray, u: FloatArray) -> tuple[str, str]:
    """Return the failed condition of least depth, and a message with its margin and values."""
    row = first_broken(system, x, u)
    return system.module.DOMAIN[row].text, shown_condition(system, row, x, u)


def first_broken(system: DrivenModule, x: FloatArray, u: FloatArray) -> int:
    """Return the row of the failed condition of least depth."""
    failed: list[int] = np.flatnonzero(system.violated(x, u)).tolist()
    return min(failed, key=lambda k: depth(system, system.module.DOMAIN[k].text))


def shown_condition(system: DrivenModule, row: int, x: FloatArray, u: FloatArray) -> str:
    """Return a condition of the domain for a message, with its margin and values."""
    text, margin = system.module.DOMAIN[row].text, system.margins(x, u)[row]
    values = ", ".join(shown_value(*value) for value in values_in(system, text, x, u))
    return f"condition '{text}' has margin {margin:.3g} ({values})"


def edge_ahead(
    system: DrivenModule, x: FloatArray, u: FloatArray, *lengths: float
) -> tuple[str, str]:
    """Return the condition that fails first ahead of the state, and a message; or '' twice.

    The state is extrapolated at its present rates over each of these times [s].
    """
    with np.errstate(all="ignore"):
        rates = system.module.rhs(x, u, system.parameters)
    for length in lengths:
        with np.errstate(all="ignore"):
            ahead = x + length * rates
        if np.isfinite(ahead).all() and np.any(system.violated(ahead, u)):
            row = first_broken(system, ahead, u)
            text = system.module.DOMAIN[row].text
            return text, f"{shown_condition(system, row, x, u)}, and falls"
    return "", ""


def rate_error(system: DrivenModule, t: float, x: FloatArray, u: FloatArray) -> RunError:
    """Return the error for a state in the domain whose rate of change is no number."""
    row = int(np.argmin(system.finite(x, u)))
    name = row_name(system.module.STATES, system.parameters, row)
    what = f"the rate of change of '{name}' is not finite at t = {t:.6g} s"
    values = ", ".join(shown_value(*value) for value in body_values(system, x))
    remedy = "check the laws there, or add the condition they need to the domain"
    return RunError(f"{what} ({values})" if values else what, place(system), "a number", remedy)


def place(system: DrivenModule) -> str:
    """Return the place that errors of this run name."""
    return f"model '{system.module.NAME}'"


def depth(system: DrivenModule, text: str) -> int:
    """Return on what a condition depends at most: 0 parameters, 1 inputs, 2 states."""
    names = set(NAME.findall(text)) - {record.name for record in system.module.PARAMETERS}
    return (1 if names <= {r.name for r in system.module.INPUTS} else 2) if names else 0


def remedies(system: DrivenModule, text: str) -> list[str]:
    """Return what a user can change to meet a condition, first parameters that a run has set."""
    module, level, names = system.module, depth(system, text), set(NAME.findall(text))
    inputs = [f"input '{r.name}'" for r in module.INPUTS if r.name in names]
    known = [r.name for r in module.PARAMETERS if r.name in names]
    p, default = system.parameters, module.Parameters()
    changed = [f"parameter '{n}'" for n in known if getattr(p, n) != getattr(default, n)]
    others = [[f"parameter '{n}'" for n in known], inputs, ["the inputs", "the initial state"]]
    if not changed:
        return others[level] if level < 2 else ["the inputs", "the parameters", "the initial state"]
    return changed + others[level] * (level > 0)


def values_in(system: DrivenModule, text: str, x: FloatArray, u: FloatArray) -> list[Value]:
    """Return the value of every symbol in a condition; the temperatures if it has none."""
    module, p, bodies = system.module, system.parameters, body_values(system, x)
    given = by_name(module.STATES, p, x) | by_name(module.INPUTS, p, u) | vars(p)
    records = (*module.STATES, *module.INPUTS, *module.PARAMETERS)
    known = {r.name: (r.name, r.unit, given[r.name]) for r in records} | {b[0]: b for b in bodies}
    known |= {"T": bodies[0]} if len(bodies) == 1 else {}
    names = dict.fromkeys(NAME.findall(text))
    return [known[name] for name in names if name in known] or bodies


def body_values(system: DrivenModule, x: FloatArray) -> list[Value]:
    """Return the temperature of each body."""
    with np.errstate(all="ignore"):
        values = system.module.temperatures(x, system.parameters)
    return [
        (f"T_{record.name}", record.unit, float(value))
        for record, value in zip(system.module.BODIES, values, strict=True)
    ]


def shown_value(label: str, unit: str, value: float | FloatArray) -> str:
    """Return one value for a message: `T_body = 296.15 K`, or the range of many lanes."""
    lanes = np.atleast_1d(np.asarray(value, dtype=float))
    suffix = f" {unit}" if unit not in ("", "1") else ""
    if np.ndim(value) == 0:
        return f"{label} = {lanes[0]:.6g}{suffix}"
    if lanes.size <= MOST_VALUES:
        return f"{label} = [{', '.join(f'{lane:.6g}' for lane in lanes)}]{suffix}"
    return f"{label} from {np.min(lanes):.6g} to {np.max(lanes):.6g}{suffix}"
