"""Checks of periodic inputs, and the steps per period that resolve them.

Input: the inputs of a module by name, their frequency.  Output: an error for an input that does not
repeat; the number of steps per period that resolves every input.
"""

from collections.abc import Callable, Iterable, Mapping
from typing import TypeAlias

import numpy as np

from piezo_sym.errors import UsageError, quote
from piezo_sym.run.inputs import Inputs, InputValue, as_signal, read_inputs
from piezo_sym.run.module import GeneratedModule
from piezo_sym.run.samples import Samples

Driven: TypeAlias = Callable[[float], Mapping[str, InputValue]]

SAME = 1e-6  # difference of values that repeat, over the input's size
GOLDEN = 0.6180339887498949
#: Times at which inputs are evaluated, over the period; irregular, so that no harmonic is missed.
PROBES = np.sort(np.r_[0.0, np.modf(np.arange(1, 64) * GOLDEN)[0]])
MOST_STEPS = 1 << 14  # per period: enough for a sine of 2048 cycles in it
COMMON = "give the frequency that the inputs have in common"
FREQUENCIES = 33  # checked in a range of frequencies, ends included
FOLLOW = "let the inputs follow the frequency"
DRIVEN = "a function of the frequency in Hz, such as lambda f: {'V_in': sine(100, f)}"


def refuse_unperiodic(
    module: GeneratedModule,
    inputs: Mapping[str, InputValue],
    frequency: float,
    caller: str = "periodic_steady_state",
    remedy: str = COMMON,
) -> None:
    """Raise `UsageError`, with this remedy, if an input is not the same one period later."""
    period = 1 / frequency
    read_inputs(module, inputs, period)
    for name, value in (inputs or {}).items():
        where = f"{caller}.inputs.{name}"
        signal = as_signal(value, where)
        times = PROBES * period
        if isinstance(signal, Samples):  # samples of one period are taken to repeat
            times = times[times + period <= signal.times[-1]]
        now = np.asarray(signal(times))
        largest = np.max(np.abs(now), initial=0.0)
        if np.any(np.abs(now - signal(times + period)) > SAME * largest):
            what = f"{quote(name)} does not repeat after {period:g} s"
            raise UsageError(what, where, f"an input of {frequency:g} Hz, or a number", remedy)


def refuse_not_following(module: GeneratedModule, inputs: Driven, low: float, high: float) -> None:
    """Raise `UsageError` if inputs do not repeat with each frequency from `low` to `high` [Hz]."""
    if not callable(inputs):
        raise UsageError(f"{quote(inputs)} is no function", "steady_branches.inputs", DRIVEN)
    for f in np.geomspace(low, high, FREQUENCIES).tolist():
        refuse_unperiodic(module, inputs(f), f, "steady_branches", FOLLOW)


def steps_needed(inputs: Inputs, names: Iterable[str], steps: int) -> int:
    """Return `steps` per period, doubled until they resolve every input.

    A sine of 512 cycles per period is 0 at each of 256 steps, and of 512: a run would miss it.
    """
    period = inputs.duration
    for name, signal in zip(names, inputs.signals, strict=True):
        while steps * signal.max_step(period) < period:
            steps *= 2
            if steps > MOST_STEPS:
                what = f"{quote(name)} needs more than {MOST_STEPS} steps in {period:g} s"
                where = f"periodic_steady_state.inputs.{name}"
                remedy = "give the greatest frequency that the inputs have in common"
                raise UsageError(what, where, "an input that moves less in a period", remedy)
    return steps
