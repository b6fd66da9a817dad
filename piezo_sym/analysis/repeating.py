"""Inputs of a model that is looked at once a period: do they repeat, and how fine must steps be.

Input: the inputs of a module by name, their frequency.  Output: a refusal of what does not repeat;
the number of steps a period between which every input is nearly a straight line.
"""

from collections.abc import Callable, Mapping
from typing import TypeAlias

import numpy as np

from piezo_sym.errors import UsageError, quote
from piezo_sym.run.inputs import InputValue, as_signal, read_inputs
from piezo_sym.run.module import GeneratedModule
from piezo_sym.run.samples import Samples
from piezo_sym.run.signals import Signal

Driven: TypeAlias = Callable[[float], Mapping[str, InputValue]]

CLOSE = 1e-6  # of an input's size: what repeats
GOLDEN = 0.6180339887498949
PROBES = np.sort(np.r_[0.0, np.modf(np.arange(1, 64) * GOLDEN)[0]])  # of a period
STRAIGHT = 0.01  # of an input's range: mean distance from straight lines between steps
MOST_NEEDED = 1 << 14  # steps a period: a sine with 1300 turns in it
COMMON = "give the frequency that the inputs have in common"
PROBED = 33  # frequencies of a range, the ends among them
FOLLOW = "let the inputs follow the frequency"
DRIVEN = "a function of the frequency in Hz, such as lambda f: {'V_in': sine(100, f)}"


def refuse_unperiodic(
    module: GeneratedModule,
    inputs: Mapping[str, InputValue],
    frequency: float,
    caller: str = "periodic_steady_state",
    remedy: str = COMMON,
) -> None:
    """Raise `UsageError` if an input is not the same one period later.

    Parameters
    ----------
    caller, remedy : what the error names as its place, and what to do.
    """
    period = 1 / frequency
    read_inputs(module, inputs, period)
    for name, value in (inputs or {}).items():
        where = f"{caller}.inputs.{name}"
        signal = as_signal(value, where)
        times = PROBES * period
        if isinstance(signal, Samples):  # those of one period alone repeat by meaning
            times = times[times + period <= signal.times[-1]]
        now = np.asarray(signal(times))
        largest = np.max(np.abs(now), initial=0.0)
        if np.any(np.abs(now - signal(times + period)) > CLOSE * largest):
            what = f"{quote(name)} does not repeat after {period:g} s"
            raise UsageError(what, where, f"an input of {frequency:g} Hz, or a number", remedy)


def refuse_not_following(module: GeneratedModule, inputs: Driven, low: float, high: float) -> None:
    """Raise `UsageError` if inputs do not repeat with each frequency from `low` to `high` [Hz]."""
    if not callable(inputs):
        raise UsageError(f"{quote(inputs)} is no function", "steady_branches.inputs", DRIVEN)
    for f in np.geomspace(low, high, PROBED).tolist():
        refuse_unperiodic(module, inputs(f), f, "steady_branches", FOLLOW)


def moves(
    module: GeneratedModule, inputs: Mapping[str, InputValue] | None, frequency: float
) -> bool:
    """Return whether any input moves in a period."""
    period = 1 / frequency
    signals = read_inputs(module, inputs, period).signals
    return any(bool(np.ptp(np.asarray(signal(PROBES * period)))) for signal in signals)


def steps_needed(inputs: Mapping[str, InputValue], frequency: float, steps: int) -> int:
    """Return `steps` a period, doubled until every input is nearly straight between them.

    With 256 steps a period an input of 512 turns a period is 0 at each of them: a run would not
    see it, and neither would one with twice as many steps.

    Raises
    ------
    UsageError : an input moves too fast for the period.
    """
    for name, value in (inputs or {}).items():
        where = f"periodic_steady_state.inputs.{name}"
        signal = as_signal(value, where)
        while _bend(signal, 1 / frequency, steps) > STRAIGHT:
            steps *= 2
            if steps > MOST_NEEDED:
                what = f"{quote(name)} needs more than {MOST_NEEDED} steps in {1 / frequency:g} s"
                remedy = "give the greatest frequency that the inputs have in common"
                raise UsageError(what, where, "an input that moves less in a period", remedy)
    return steps


def _bend(signal: Signal, period: float, steps: int) -> float:
    """Return how far an input is from straight lines between steps, as a part of its range."""
    times = np.linspace(0.0, period, steps + 1)
    ends = np.asarray(signal(times))
    between = np.asarray(signal(times[:-1] + GOLDEN * period / steps))
    straight = (1 - GOLDEN) * ends[:-1] + GOLDEN * ends[1:]
    span = float(np.ptp(np.concatenate([ends, between])))
    return float(np.mean(np.abs(between - straight))) / span if span else 0.0
