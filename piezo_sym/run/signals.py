"""Signals: inputs as functions of time that know their corners and how fast they move.

Input: a waveform's numbers (SI; frequencies in Hz).  Output: a frozen `Signal`, callable on t.
"""

from abc import ABC, abstractmethod
from collections.abc import Iterable
from dataclasses import dataclass
from math import inf, pi
from typing import final

import numpy as np

from piezo_sym.errors import UsageError
from piezo_sym.run.checks import FloatArray, number, positive

MOST_CORNERS = 1000
STEPS_PER_PERIOD = 8


class Signal(ABC):
    """An input as a function of time, continuous from the right.

    A solver restarts at `breaks`, where the signal or its slope jumps, and takes no step longer
    than `max_step`, so that it misses no period and no pulse.
    """

    @abstractmethod
    def __call__(self, t: FloatArray | float) -> FloatArray:
        """Return the values at the times t [s]; shape of t."""

    def breaks(self, duration: float) -> tuple[float, ...]:  # noqa: ARG002
        """Return the times in (0, duration) [s] where the signal or its slope jumps: here none.

        Corners without a jump are left out when there are more than 1000 of them; `max_step`
        resolves the signal then.
        """
        return ()

    @property
    def period(self) -> float:
        """The shortest period [s]; infinity for what is not periodic."""
        return inf

    def max_step(self, duration: float) -> float:  # noqa: ARG002
        """Return the longest step [s] that resolves the signal between its breaks."""
        return self.period / STEPS_PER_PERIOD

    def longest_step(self, duration: float) -> float:
        """Return the same for steps that evaluate the signal at several stages each."""
        return self.max_step(duration)


@final
@dataclass(frozen=True)
class Constant(Signal):
    """The same value at all times."""

    value: float

    def __call__(self, t: FloatArray | float) -> FloatArray:
        """Return the values at the times t; shape of t."""
        return np.full(np.shape(t), self.value)[()]


@final
@dataclass(frozen=True)
class Sine(Signal):
    """A sine; see `sine`."""

    amplitude: float
    frequency: float
    offset: float
    phase: float

    def __call__(self, t: FloatArray | float) -> FloatArray:
        """Return the values at the times t; shape of t."""
        angle = 2 * pi * self.frequency * t + self.phase
        return np.asarray(self.amplitude * np.sin(angle) + self.offset)[()]

    @property
    def period(self) -> float:
        """The shortest period [s]."""
        return 1 / self.frequency

    def longest_step(self, duration: float) -> float:  # noqa: ARG002
        """Return half of the shortest period."""
        return 0.5 * self.period


@final
@dataclass(frozen=True)
class Step(Signal):
    """A jump; see `step`."""

    time: float
    before: float
    after: float

    def __call__(self, t: FloatArray | float) -> FloatArray:
        """Return the values at the times t; shape of t."""
        return np.where(np.asarray(t) < self.time, self.before, self.after)[()]

    def breaks(self, duration: float) -> tuple[float, ...]:
        """Return the time of the jump."""
        return inside((self.time,), duration)


@final
@dataclass(frozen=True)
class Ramp(Signal):
    """A straight line between two constants; see `ramp`."""

    start: float
    stop: float
    before: float
    after: float

    def __call__(self, t: FloatArray | float) -> FloatArray:
        """Return the values at the times t; shape of t."""
        value = np.interp(t, (self.start, self.stop), (self.before, self.after))
        return np.asarray(value)[()]

    def breaks(self, duration: float) -> tuple[float, ...]:
        """Return the times of the two corners."""
        return inside((self.start, self.stop), duration)


@final
@dataclass(frozen=True)
class Triangle(Signal):
    """A triangle wave; see `triangle`."""

    amplitude: float
    frequency: float
    offset: float

    def __call__(self, t: FloatArray | float) -> FloatArray:
        """Return the values at the times t; shape of t."""
        turns = self.frequency * np.asarray(t) + 0.25
        wave = 1 - 4 * np.abs(turns - np.floor(turns) - 0.5)
        return np.asarray(self.amplitude * wave + self.offset)[()]

    def breaks(self, duration: float) -> tuple[float, ...]:
        """Return the times of the corners, a quarter period after each zero crossing."""
        if 2 * self.frequency * duration > MOST_CORNERS:
            return ()
        count = int(2 * self.frequency * duration) + 1
        return inside((np.arange(count) + 0.5) / (2 * self.frequency), duration)

    @property
    def period(self) -> float:
        """The period [s]."""
        return 1 / self.frequency


@final
@dataclass(frozen=True)
class Chirp(Signal):
    """A sine whose frequency moves; see `chirp`."""

    amplitude: float
    f_start: float
    f_stop: float
    duration: float
    offset: float

    def __call__(self, t: FloatArray | float) -> FloatArray:
        """Return the values at the times t; shape of t."""
        sweep = np.minimum(t, self.duration)
        rate = (self.f_stop - self.f_start) / self.duration
        turns = (self.f_start + rate * sweep / 2) * sweep + self.f_stop * (t - sweep)
        return np.asarray(self.amplitude * np.sin(2 * pi * turns) + self.offset)[()]

    def breaks(self, duration: float) -> tuple[float, ...]:
        """Return the time at which the frequency stops moving."""
        return inside((self.duration,), duration)

    @property
    def period(self) -> float:
        """The shortest period [s]."""
        return 1 / max(self.f_start, self.f_stop)

    def longest_step(self, duration: float) -> float:  # noqa: ARG002
        """Return half of the shortest period."""
        return 0.5 * self.period


def inside(times: Iterable[float], duration: float) -> tuple[float, ...]:
    """Return those of the times that lie in (0, duration)."""
    return tuple(float(t) for t in times if 0 < t < duration)


def sine(amplitude: float, frequency: float, offset: float = 0.0, phase: float = 0.0) -> Sine:
    """Return offset + amplitude sin(2 pi frequency t + phase).

    Parameters
    ----------
    amplitude, offset : in the input's unit.
    frequency : in Hz, above 0.
    phase : in rad.

    Raises
    ------
    UsageError : a number is not finite, or the frequency not positive.
    """
    given = {"amplitude": amplitude, "frequency": frequency, "offset": offset, "phase": phase}
    return Sine(**_checked("sine", given, "frequency"))


def step(time: float, before: float, after: float) -> Step:
    """Return a jump at `time` [s] from `before` to `after`, which holds at `time` itself.

    Raises
    ------
    UsageError : a number is not finite.
    """
    return Step(**_checked("step", {"time": time, "before": before, "after": after}))


def ramp(start: float, stop: float, before: float, after: float) -> Ramp:
    """Return `before` until the time `start` [s], `after` from `stop` on, a line between.

    Raises
    ------
    UsageError : a number is not finite, or `stop` is not after `start`.
    """
    given = {"start": start, "stop": stop, "before": before, "after": after}
    found = Ramp(**_checked("ramp", given))
    if found.stop <= found.start:
        remedy = "use step() for a jump"
        what = f"the ramp stops at {found.stop:g}"
        raise UsageError(what, "ramp.stop", f"over {found.start:g}", remedy)
    return found


def triangle(amplitude: float, frequency: float, offset: float = 0.0) -> Triangle:
    """Return a triangle wave that starts at `offset`, rising, and reaches offset +- amplitude.

    Parameters
    ----------
    amplitude, offset : in the input's unit.
    frequency : in Hz, above 0.

    Raises
    ------
    UsageError : a number is not finite, or the frequency not positive.
    """
    given = {"amplitude": amplitude, "frequency": frequency, "offset": offset}
    return Triangle(**_checked("triangle", given, "frequency"))


def chirp(
    amplitude: float, f_start: float, f_stop: float, duration: float, offset: float = 0.0
) -> Chirp:
    """Return a sine whose frequency moves linearly from `f_start` to `f_stop`, then stays.

    Parameters
    ----------
    amplitude, offset : in the input's unit.
    f_start, f_stop : in Hz, above 0.
    duration : time of the sweep [s], above 0.

    Raises
    ------
    UsageError : a number is not finite, or a frequency or the duration not positive.
    """
    moved = {"f_start": f_start, "f_stop": f_stop, "duration": duration}
    given = {"amplitude": amplitude, **moved, "offset": offset}
    return Chirp(**_checked("chirp", given, *moved))


def _checked(signal: str, given: dict[str, float], *above_zero: str) -> dict[str, float]:
    """Return a signal's numbers as finite floats, some of them above 0."""
    return {
        name: (positive if name in above_zero else number)(value, f"{signal}.{name}")
        for name, value in given.items()
    }
