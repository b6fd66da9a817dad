"""The stroboscopic map of a periodically driven model: the state after one period of its inputs.

Input: a generated module with one body, its inputs as a function of the frequency, a frequency,
parameters.  Output: a `Stroboscope`, whose `look` maps the state x (n,) at t = 0 to the state one
period later.

    x' = P(x; f)        a periodic steady state is a fixed point of P

Inputs that do not repeat are refused.  Every period has the same number of steps, which resolve
every input, so that P is smooth in x and f: with adaptive steps it would have small jumps.  Both
balances hold exactly.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeAlias, final

import numpy as np

from piezo_sym.analysis.conserved import conserved_functions
from piezo_sym.errors import RunError, UsageError, quote
from piezo_sym.run import simulate
from piezo_sym.run.checks import FloatArray, known_keys
from piezo_sym.run.collocation import METHOD, FixedStep, collocate
from piezo_sym.run.engine.engine import engine_of
from piezo_sym.run.guard import check_inputs, check_start
from piezo_sym.run.inputs import Inputs, InputValue, as_signal, read_inputs
from piezo_sym.run.module import GeneratedModule, by_name, checked, held
from piezo_sym.run.parameters import (
    LaneValue,
    entropy_row,
    read_initial,
    read_parameters,
    refuse_run,
)
from piezo_sym.run.samples import Samples
from piezo_sym.run.system import DrivenModule

if TYPE_CHECKING:
    import xarray

Rows: TypeAlias = np.ndarray[tuple[int], np.dtype[np.bool_]]
Driven: TypeAlias = Callable[[float], Mapping[str, InputValue]]

SAMPLES = 16  # of a period, for the sizes of states and the mean temperature
SPREAD = (-2.0, 2.0)  # powers of ten: factors from the sizes of states to random states
ENTROPY_SPREAD = 1e-2  # factor from the entropy's size to random entropies
SPARE = 16  # random states beyond the least number
CONSTANT = 1e-9  # the largest change of a conserved quantity in a period, over the sizes of states
SAME = 1e-6  # difference of values that repeat, over the input's size
GOLDEN = 0.6180339887498949
#: Times at which inputs are evaluated, over the period; irregular, so that no harmonic is missed.
PROBES = np.sort(np.r_[0.0, np.modf(np.arange(1, 64) * GOLDEN)[0]])
MOST_STEPS = 1 << 14  # per period: enough for a sine of 2048 cycles in it
COMMON = "give the frequency that the inputs have in common"


@final
@dataclass(frozen=True, eq=False)
class Period:
    """One period from a state x (n,)."""

    end: FloatArray  # the state (n,) after the period
    size: FloatArray  # largest magnitude of each state (n,); for a bank that of all its lanes
    mean: float  # temperature of the body [K]
    coldest: float
    hottest: float


def over_period(T: FloatArray) -> tuple[float, float, float]:
    """Return mean, least and greatest of a period's samples (nt,), both ends included."""
    mean = float((T[0] + T[-1]) / 2 + T[1:-1].sum()) / (T.size - 1)
    return mean, float(T.min()), float(T.max())


@final
@dataclass(frozen=True)
class Stroboscope:
    """A periodically driven model, with one body, at one frequency of its inputs."""

    module: GeneratedModule
    inputs_at: Driven
    frequency: float  # Hz
    parameters: Mapping[str, LaneValue]
    initial: Mapping[str, LaneValue]
    steps: int  # per period
    free: bool = False  # whether states that move nothing need not repeat

    @property
    def duration(self) -> float:
        """The length of one period [s]."""
        return 1 / self.frequency

    @property
    def where(self) -> str:
        """The place that errors name."""
        return f"model '{self.module.NAME}'"

    def at(self, frequency: float) -> Stroboscope:
        """Return the same model at a frequency [Hz]."""
        return self if frequency == self.frequency else replace(self, frequency=frequency)

    def look(self, x: FloatArray) -> Period:
        """Return the period that begins with the state x (n,) at t = 0."""
        states = self._period(x)
        size = self._system.scale(np.abs(states).max(axis=1))
        T = np.asarray(self.module.temperatures(states, self.values))[0]
        return Period(states[:, -1], size, *over_period(T))

    def _period(self, x: FloatArray) -> FloatArray:
        return np.asarray(self._periods(x[None], SAMPLES + 1)[0])

    def ends(self, x: FloatArray) -> FloatArray:
        """Return the states (many, n) one period after x (many, n)."""
        return np.asarray(self._periods(x, 2)[..., -1])

    def _periods(self, x: FloatArray, samples: int) -> FloatArray:
        """Return the states (many, n, samples) of periods from x (many, n), without Datasets."""
        system, step = self._system, FixedStep(self.duration / self.steps)
        for start in x:
            check_start(system, start, np.inf)  # searches may go beyond the limits of stops
        times = np.linspace(0.0, self.duration, samples)
        runs = collocate([system] * len(x), engine_of(self.module), x, times, step)
        return np.array([runs.trajectory(k).states for k in range(len(x))])

    @cached_property
    def inputs(self) -> Inputs:
        """The inputs over one period."""
        return read_inputs(self.module, self.inputs_at(self.frequency), self.duration)

    @cached_property
    def _system(self) -> DrivenModule:
        """The module with its parameters and inputs, checked."""
        system = DrivenModule(self.module, self.values, self.inputs)
        check_inputs(system, self.start, np.array([0.0, self.duration]))
        return system

    def run(self, x: FloatArray, **options: Any) -> xarray.Dataset:
        """Return a run of one period from the state x (n,); options as for `simulate`."""
        return simulate(
            self.module,
            inputs=self.inputs_at(self.frequency),
            duration=self.duration,
            parameters=self.parameters,
            initial=self.named(x),
            method=METHOD,
            **options,
        )

    def named(self, x: FloatArray) -> dict[str, LaneValue]:
        """Return a state x (n,) by name, as `simulate` takes it."""
        return by_name(self.module.STATES, self.values, x)

    @cached_property
    def values(self) -> Any:
        """The module's frozen `Parameters`."""
        return read_parameters(self.module, self.parameters)

    @property
    def start(self) -> FloatArray:
        """The state (n,) that a run starts from."""
        u = self.inputs.segments[0].at(0.0)
        return read_initial(self.module, self.values, u, self.initial)

    @cached_property
    def repeating(self) -> Rows:
        """Which states (n,) must repeat: all, or without `moving_nothing` if `free`."""
        return ~self.moving_nothing if self.free else np.ones(self.start.size, dtype=bool)

    @cached_property
    def moving_nothing(self) -> Rows:
        """Which states (n,) no rate depends on in the period from the start, as a free position."""
        times = np.linspace(0.0, self.duration, SAMPLES + 1)
        x, u = self._period(self.start), self.inputs.at_samples(times)
        with np.errstate(all="ignore"):
            slopes = self.module.jacobian(x, u, self.values)
        return np.asarray(~slopes.any(axis=(0, 2)))

    @cached_property
    def conserved(self) -> FloatArray:
        """Linear functions (k, n) of repeating states that are conserved; none if in doubt.

        Applied to the rates at random states they give zero; over a period they are constant.
        """
        none = np.empty((0, self.start.size))
        try:
            states = self._period(self.start)
        except RunError:  # the start lies outside the domain
            return none
        size = self._system.scale(np.abs(states).max(axis=1))
        rates = self._random_rates(size)
        rates = rates[:, np.isfinite(rates).all(axis=0) & rates.any(axis=0)]
        if rates.shape[1] < size.size + SPARE:
            return none
        functions = conserved_functions(rates, size)
        kept = np.ptp(functions @ states, axis=1) <= CONSTANT * (np.abs(functions) @ size)
        return np.asarray(functions[kept & ~functions[:, ~self.repeating].any(axis=1)])

    def _random_rates(self, size: FloatArray) -> FloatArray:
        """Return rates (n, many) at states so widely spread that no law is zero at all of them.

        The entropy of the body is not: its temperature may be an exponential of it.
        """
        rng, many = np.random.default_rng(0), 4 * (size.size + SPARE)
        spread = 10 ** rng.uniform(*SPREAD, many) * np.ones((size.size, 1))
        spread[self.entropy_row(self.start)] = ENTROPY_SPREAD
        x = self.start[:, None] + size[:, None] * spread * rng.normal(size=spread.shape)
        u = self.inputs.at_samples(np.sort(rng.uniform(0.0, self.duration, many)))
        with np.errstate(all="ignore"):
            inside = held(self.module, self.module.margins(x, u, self.values)).all(axis=0)
            return np.asarray(self.module.rhs(x, u, self.values))[:, inside]

    def temperature(self, x: FloatArray) -> float:
        """Return the body's temperature in the state x (n,); inf where it overflows."""
        with np.errstate(over="ignore"):
            return float(self.module.temperatures(x, self.values)[0])

    def entropy_row(self, x: FloatArray) -> int:
        """Return the row of the body's entropy."""
        return entropy_row(self.module, self.values, x, 0)


def stroboscope(
    module: GeneratedModule,
    inputs_at: Driven,
    frequency: float,
    parameters: Mapping[str, LaneValue] | None,
    initial: Mapping[str, LaneValue] | None,
    steps: int,
) -> Stroboscope:
    """Return a module's stroboscope, with `steps` per period doubled until they resolve the inputs.

    A run of one period checks its start.
    """
    bodies = [record.name for record in checked(module).BODIES]
    if len(bodies) != 1:
        what = f"model '{module.NAME}' has {len(bodies)} bodies"
        remedy = "simulate until it settles"
        raise UsageError(what, "periodic_steady_state.model", "a model with one body", remedy)
    refuse_unperiodic(module, inputs_at(frequency), frequency, COMMON)
    inputs = read_inputs(module, inputs_at(frequency), 1 / frequency)
    steps = steps_needed(inputs, (record.name for record in module.INPUTS), steps)
    refuse_run(module, initial)
    known_keys(initial, [record.name for record in module.STATES], "periodic_steady_state.initial")
    strobe = Stroboscope(module, inputs_at, frequency, parameters or {}, initial or {}, steps)
    strobe.run(strobe.start, times=2, step=strobe.duration / steps)
    return strobe


def refuse_unperiodic(
    module: GeneratedModule, inputs: Mapping[str, InputValue], frequency: float, remedy: str
) -> None:
    """Raise `UsageError`, with this remedy, if an input is not the same one period later."""
    period = 1 / frequency
    read_inputs(module, inputs, period)
    for name, value in (inputs or {}).items():
        where = f"periodic_steady_state.inputs.{name}"
        signal = as_signal(value, where)
        times = PROBES * period
        if isinstance(signal, Samples):  # samples of one period are taken to repeat
            times = times[times + period <= signal.times[-1]]
        now = np.asarray(signal(times))
        largest = np.max(np.abs(now), initial=0.0)
        if np.any(np.abs(now - signal(times + period)) > SAME * largest):
            what = f"{quote(name)} does not repeat after {period:g} s"
            raise UsageError(what, where, f"an input of {frequency:g} Hz, or a number", remedy)


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
