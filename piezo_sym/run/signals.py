"""Signals: inputs as functions of time that know their corners and how fast they move.

Input: a waveform's numbers (SI; frequencies in Hz).  Output: a frozen `Signal`, callable on t.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from math import inf, pi
from typing import ClassVar, final

import numpy as np

from piezo_sym.errors import UsageError
from piezo_sym.run.checks import FloatArray, number, positive

#: The functions that make signals: `piezo_sym.run` and the command line offer all of them.
__all__ = ["chirp", "ramp", "sine", "step", "triangle"]

MOST_CORNERS = 1000
STEPS_PER_PERIOD = 8


class Signal(ABC):
    """An input as a function of time, continuous from the right; called, it gives its values.

    A solver restarts at `breaks`, where the signal or its slope jumps, and takes no step longer
    than `max_step`, so that it misses no period and no pulse. A new kind of signal is a class
    below, and a function in `__all__` that makes it from checked numbers.
    """

    #: Whether there are no corners but breaks: steps with several stages may then be longer.
    _smooth: ClassVar[bool] = False

    def __call__(self, t: FloatArray | float) -> FloatArray:
        """Return the values at the times t [s]; shape of t."""
        return np.asarray(self._values(t))[()]

    @abstractmethod
    def _values(self, t: FloatArray | float) -> FloatArray: ...

    def _corners(self, duration: float) -> Iterable[float]:  # noqa: ARG002
        """Return at least the breaks in (0, duration), in order: here none."""
        return ()

    @property
    def _period(self) -> float:
        """The shortest period [s]; infinity for what is not periodic."""
        return inf

    def breaks(self, duration: float) -> tuple[float, ...]:
        """Return the times in (0, duration) [s] where the signal or its slope jumps.

        Corners without a jump are left out when there are more than 1000 of them; `max_step`
        resolves the signal then.
        """
        return tuple(float(t) for t in self._corners(duration) if 0 < t < duration)

    def max_step(self, duration: float) -> float:  # noqa: ARG002
        """Return the longest step [s] that resolves the signal between its breaks."""
        return self._period / STEPS_PER_PERIOD

    def longest_step(self, duration: float) -> float:
        """Return the same for steps that evaluate the signal at several stages each."""
        return 0.5 * self._period if self._smooth else self.max_step(duration)


@final
@dataclass(frozen=True)
class Constant(Signal):
    """The same value at all times."""

    value: float

    def _values(self, t: FloatArray | float) -> FloatArray:
        return np.full(np.shape(t), self.value)


@final
@dataclass(frozen=True)
class Sine(Signal):
    """A sine; see `sine`."""

    amplitude: float
    frequency: float
    offset: float
    phase: float
    _smooth = True

    def _values(self, t: FloatArray | float) -> FloatArray:
        angle = 2 * pi * self.frequency * t + self.phase
        return np.asarray(self.amplitude * np.sin(angle) + self.offset)

    @property
    def _period(self) -> float:
        return 1 / self.frequency


@final
@dataclass(frozen=True)
class Step(Signal):
    """A jump; see `step`."""

    time: float
    before: float
    after: float

    def _values(self, t: FloatArray | float) -> FloatArray:
        return np.where(np.less(t, self.time), self.before, self.after)

    def _corners(self, duration: float) -> Iterable[float]:  # noqa: ARG002
        return (self.time,)


@final
@dataclass(frozen=True)
class Ramp(Signal):
    """A straight line between two constants; see `ramp`."""

    start: float
    stop: float
    before: float
    after: float

    def _values(self, t: FloatArray | float) -> FloatArray:
        return np.asarray(np.interp(t, (self.start, self.stop), (self.before, self.after)))

    def _corners(self, duration: float) -> Iterable[float]:  # noqa: ARG002
        return self.start, self.stop


@final
@dataclass(frozen=True)
class Triangle(Signal):
    """A triangle wave; see `triangle`."""

    amplitude: float
    frequency: float
    offset: float

    def _values(self, t: FloatArray | float) -> FloatArray:
        turns = self.frequency * np.asarray(t) + 0.25
        wave = 1 - 4 * np.abs(turns - np.floor(turns) - 0.5)
        return np.asarray(self.amplitude * wave + self.offset)

    def _corners(self, duration: float) -> Iterable[float]:
        """Return the corners, a quarter period after each zero crossing."""
        if 2 * self.frequency * duration > MOST_CORNERS:
            return ()
        count = int(2 * self.frequency * duration) + 1
        return (np.arange(count) + 0.5) / (2 * self.frequency)

    @property
    def _period(self) -> float:
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
    _smooth = True

    def _values(self, t: FloatArray | float) -> FloatArray:
        sweep = np.minimum(t, self.duration)
        rate = (self.f_stop - self.f_start) / self.duration
        turns = (self.f_start + rate * sweep / 2) * sweep + self.f_stop * (t - sweep)
        return np.asarray(self.amplitude * np.sin(2 * pi * turns) + self.offset)

    def _corners(self, duration: float) -> Iterable[float]:  # noqa: ARG002
        return (self.duration,)

    @property
    def _period(self) -> float:
        return 1 / max(self.f_start, self.f_stop)


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


SIGNALS: dict[str, Callable[..., Signal]] = {name: globals()[name] for name in __all__}
