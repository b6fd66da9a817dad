"""Signals: inputs as functions of time with their breaks and the longest step that resolves them.

Input: a waveform's numbers (SI; frequencies in Hz).  Output: a frozen `Signal`, callable on t.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable
from dataclasses import dataclass, fields
from math import inf, pi
from typing import ClassVar, final

import numpy as np

from piezo_sym.errors import UsageError
from piezo_sym.run.checks import FloatArray, checked_call, number, positive, vector

#: The signals that `piezo_sym.run` and the command line offer.
__all__ = ["chirp", "ramp", "sine", "square", "step", "triangle"]

MOST_CORNERS = 1000
#: Each jump begins a segment of its own.
MOST_JUMPS = 100_000
STEPS_PER_PERIOD = 8


class Signal(ABC):
    """An input as a function of time, continuous from the right: signal(t) gives its values.

    A solver restarts at `breaks`, where the signal or its slope jumps, and takes no step longer
    than `max_step`, so that it misses no period and no pulse. A new kind of signal is a class
    below and its name in small letters in `__all__`.
    """

    #: Whether it is smooth between breaks: steps with several stages may then be longer.
    _smooth: ClassVar[bool] = False
    #: The fields that must be above 0; None where no field is checked.
    _above_zero: ClassVar[tuple[str, ...] | None] = None

    def __post_init__(self) -> None:
        """Check the fields, and convert them to floats."""
        for field in fields(self) if self._above_zero is not None else ():  # type: ignore[arg-type]
            check = positive if field.name in (self._above_zero or ()) else number
            place = f"{type(self).__name__.lower()}.{field.name}"
            object.__setattr__(self, field.name, check(getattr(self, field.name), place))

    def __call__(self, t: FloatArray | float | list[float] | tuple[float, ...]) -> FloatArray:
        """Return the values at the times t [s]; shape of t."""
        if isinstance(t, list | tuple):
            t = vector(t, f"{type(self).__name__.lower()}.t")
        return np.asarray(self._values(t))[()]

    @abstractmethod
    def _values(self, t: FloatArray | float) -> FloatArray: ...

    def _corners(self, duration: float) -> Iterable[float]:  # noqa: ARG002
        """Return at least the breaks in (0, duration), in order: here none."""
        return ()

    @property
    def _period(self) -> float:
        """The shortest period [s]; infinity if it is not periodic."""
        return inf

    def breaks(self, duration: float) -> tuple[float, ...]:
        """Return where in (0, duration) [s] the signal or its slope jumps, and steps end.

        Corners without a jump are left out when there are more than 1000 of them; `max_step`
        resolves the signal then.
        """
        return tuple(float(t) for t in self._corners(duration) if 0 < t < duration)

    def max_step(self, duration: float) -> float:  # noqa: ARG002
        """Return the longest step [s] of methods that sample it once per step."""
        return self._period / STEPS_PER_PERIOD

    def longest_step(self, duration: float) -> float:
        """Return the longest step [s] of methods with several stages per step."""
        return 0.5 * self._period if self._smooth else self.max_step(duration)


@final
@dataclass(frozen=True)
class Constant(Signal):
    """The same value at all times."""

    value: float

    def _values(self, t: FloatArray | float) -> FloatArray:
        return np.full(np.shape(t), self.value)


@dataclass(frozen=True)
class _Wave(Signal):
    """A periodic signal with an amplitude, a frequency and an offset."""

    amplitude: float
    frequency: float
    offset: float = 0.0
    _above_zero = ("frequency",)


@final
@dataclass(frozen=True)
class Sine(_Wave):
    """The signal offset + amplitude sin(2 pi frequency t + phase).

    Parameters
    ----------
    amplitude, offset : in the SI unit of the input.
    frequency : in Hz, above 0.
    phase : in rad.

    Raises
    ------
    UsageError : a number is not finite, or the frequency not positive.
    """

    phase: float = 0.0
    _smooth = True

    def _values(self, t: FloatArray | float) -> FloatArray:
        turns = self.frequency * np.asarray(t)  # whole turns are left out, as in C
        angle = 2 * pi * (turns - np.rint(turns)) + self.phase
        return np.asarray(self.amplitude * np.sin(angle) + self.offset)

    @property
    def _period(self) -> float:
        return 1 / self.frequency


@final
@dataclass(frozen=True)
class Step(Signal):
    """A jump from one value to another, which holds at the time of the jump itself.

    Parameters
    ----------
    time : of the jump [s].
    before, after : the two values, in the SI unit of the input.

    Raises
    ------
    UsageError : a number is not finite.
    """

    time: float
    before: float
    after: float
    _above_zero = ()

    def _values(self, t: FloatArray | float) -> FloatArray:
        return np.where(np.less(t, self.time), self.before, self.after)

    def _corners(self, duration: float) -> Iterable[float]:  # noqa: ARG002
        return (self.time,)


@final
@dataclass(frozen=True)
class Ramp(Signal):
    """A constant, a straight line to another value, and that value from then on.

    Parameters
    ----------
    start, stop : times at which the line begins and ends [s].
    before, after : the two values, in the SI unit of the input.

    Raises
    ------
    UsageError : a number is not finite, or `stop` is not after `start`.
    """

    start: float
    stop: float
    before: float
    after: float
    _above_zero = ()

    def __post_init__(self) -> None:
        """Check that it stops after it starts."""
        super().__post_init__()
        if self.stop <= self.start:
            what, expected = f"the ramp stops at {self.stop:g}", f"over {self.start:g}"
            raise UsageError(what, "ramp.stop", expected, "use step() for a jump")

    def _values(self, t: FloatArray | float) -> FloatArray:
        return np.asarray(np.interp(t, (self.start, self.stop), (self.before, self.after)))

    def _corners(self, duration: float) -> Iterable[float]:  # noqa: ARG002
        return self.start, self.stop


@final
@dataclass(frozen=True)
class Triangle(_Wave):
    """A triangle wave between offset - amplitude and offset + amplitude.

    At t = 0 it is at the offset, and rises.

    Parameters
    ----------
    amplitude, offset : in the SI unit of the input.
    frequency : in Hz, above 0.

    Raises
    ------
    UsageError : a number is not finite, or the frequency not positive.
    """

    def _values(self, t: FloatArray | float) -> FloatArray:
        turns = self.frequency * np.asarray(t) + 0.25
        wave = 1 - 4 * np.abs(turns - np.floor(turns) - 0.5)
        return np.asarray(self.amplitude * wave + self.offset)

    def corners(self, duration: float) -> FloatArray:
        """Return the times of all corners [s], a quarter period after each zero crossing."""
        count = int(2 * self.frequency * duration) + 1
        return np.asarray((np.arange(count) + 0.5) / (2 * self.frequency))

    def _corners(self, duration: float) -> Iterable[float]:
        return self.corners(duration) if 2 * self.frequency * duration <= MOST_CORNERS else ()

    @property
    def _period(self) -> float:
        return 1 / self.frequency


@final
@dataclass(frozen=True)
class Square(_Wave):
    """A square wave: offset + amplitude in the first half of each period, then offset - amplitude.

    The first period begins at t = 0.

    Parameters
    ----------
    amplitude, offset : in the SI unit of the input.
    frequency : in Hz, above 0.

    Raises
    ------
    UsageError : a number is not finite, the frequency not positive, or it jumps too often in a run.
    """

    def _values(self, t: FloatArray | float) -> FloatArray:
        jumps = 2 * self.frequency
        last = np.round(jumps * np.asarray(t))
        last = np.where(t < last / jumps, last - 1, last)  # exact at each jump and beside it
        return np.asarray(self.offset + self.amplitude * (1 - 2 * (last % 2)))

    def _corners(self, duration: float) -> Iterable[float]:
        jumps = 2 * self.frequency
        if jumps * duration > MOST_JUMPS:
            what, expected = f"over {MOST_JUMPS:,} jumps until {duration:g} s", "fewer in a run"
            raise UsageError(what, "square.frequency", expected, "take shorter runs, one by one")
        return np.arange(1, int(jumps * duration) + 2) / jumps


@final
@dataclass(frozen=True)
class Chirp(Signal):
    """The sine offset + amplitude sin(angle); its frequency goes linearly from one to another.

    The angle is 0 at t = 0; after the sweep the last frequency stays.

    Parameters
    ----------
    amplitude, offset : in the SI unit of the input.
    f_start, f_stop : frequency at t = 0, and from t = duration on; in Hz, above 0.
    duration : time of the sweep [s], above 0.

    Raises
    ------
    UsageError : a number is not finite, or a frequency or the duration not positive.
    """

    amplitude: float
    f_start: float
    f_stop: float
    duration: float
    offset: float = 0.0
    _smooth, _above_zero = True, ("f_start", "f_stop", "duration")

    def _values(self, t: FloatArray | float) -> FloatArray:
        sweep = np.minimum(t, self.duration)
        rate = (self.f_stop - self.f_start) / self.duration
        turns = (self.f_start + rate * sweep / 2) * sweep + self.f_stop * (t - sweep)
        return np.asarray(self.amplitude * np.sin(2 * pi * (turns - np.rint(turns))) + self.offset)

    def _corners(self, duration: float) -> Iterable[float]:  # noqa: ARG002
        return (self.duration,)

    @property
    def _period(self) -> float:
        return 1 / max(self.f_start, self.f_stop)


sine, step, ramp = checked_call(Sine), checked_call(Step), checked_call(Ramp)
triangle, square, chirp = checked_call(Triangle), checked_call(Square), checked_call(Chirp)
SIGNALS: dict[str, Callable[..., Signal]] = {name: globals()[name] for name in __all__}
