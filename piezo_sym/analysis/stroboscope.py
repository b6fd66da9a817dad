"""The stroboscopic map: a model driven with a period, looked at once a period.

Input: a generated module with one body, its inputs as a function of the frequency, parameters.
Output: a `Stroboscope`, whose `look` maps the state x (n,) at t = 0 to that one period later.

    x' = P(x; f)        a periodic steady state is a fixed point of P

The module runs with a fixed number of steps a period, so that P is smooth in x and f (a mesh that a
tolerance chooses would make it jump), and both balances are exact.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Any, final

import numpy as np

from piezo_sym.analysis.repeating import Driven, refuse_unperiodic, steps_needed
from piezo_sym.errors import RunError, UsageError
from piezo_sym.run import simulate
from piezo_sym.run.checks import known_keys
from piezo_sym.run.collocation import FixedStep, fixed
from piezo_sym.run.engine import compiled
from piezo_sym.run.guard import check_inputs, check_start
from piezo_sym.run.inputs import read_inputs
from piezo_sym.run.module import checked, rows
from piezo_sym.run.parameters import read_initial, read_parameters
from piezo_sym.run.runs import METHOD
from piezo_sym.run.system import System

if TYPE_CHECKING:
    import xarray

    from piezo_sym.run.checks import FloatArray
    from piezo_sym.run.engine import Engine
    from piezo_sym.run.module import GeneratedModule
    from piezo_sym.run.parameters import LaneValue

LOOKS = 16  # times in a period at which sizes and the mean temperature are taken
FLOOR = 1e-15  # so that no size is 0
GENTLE = 1.01  # a difference quotient may change the temperature by so much
FINE = 1e-9  # rtol where nothing can compile


@final
@dataclass(frozen=True, eq=False)
class Period:
    """One period from a state x (n,): the state after it, sizes (n,), the body's temperature."""

    end: FloatArray
    size: FloatArray
    mean: float
    coldest: float
    hottest: float


@final
@dataclass(frozen=True)
class Stroboscope:
    """A model, driven with a period, that is looked at once a period."""

    module: GeneratedModule
    inputs: Driven
    parameters: Mapping[str, LaneValue]
    initial: Mapping[str, LaneValue]
    steps: int

    def look(self, x: FloatArray, frequency: float) -> Period:
        """Return what one period does to the state x (n,) at t = 0.

        Raises
        ------
        RunError : the run leaves the domain.
        """
        states = self._period(x, frequency)
        size = np.maximum(np.max(np.abs(states), axis=1), FLOOR)
        for part in rows(self.module.STATES, self.values):
            size[part] = np.max(size[part])
        T = np.asarray(self.module.temperatures(states, self.values))[0]
        mean = float((T[0] + T[-1]) / 2 + T[1:-1].sum()) / LOOKS
        return Period(states[:, -1], size, mean, float(T.min()), float(T.max()))

    def _period(self, x: FloatArray, frequency: float) -> FloatArray:
        """Return the states (n, LOOKS + 1) of one period; in C, nothing else is made of the run."""
        if self.engine is None:
            return self.states_of(self.run(x, frequency, times=LOOKS + 1, rtol=FINE))
        system, step = self._driven(frequency), FixedStep(1 / frequency / self.steps)
        check_start(system, x)
        times = np.linspace(0.0, 1 / frequency, LOOKS + 1)
        return fixed([system], self.engine, x[None], times, step).trajectory(0).states

    @cached_property
    def _driven(self) -> Callable[[float], System]:
        """The model with its inputs at a frequency, which are looked at once."""

        @lru_cache(maxsize=8)
        def at(frequency: float) -> System:
            inputs = read_inputs(self.module, self.inputs(frequency), 1 / frequency)
            system = System(self.module, self.values, inputs)
            check_inputs(system, self.start(frequency), np.array([0.0, 1 / frequency]))
            return system

        return at

    def run(self, x: FloatArray, frequency: float, **accuracy: Any) -> xarray.Dataset:
        """Return a run of one period from the state x (n,)."""
        return simulate(
            self.module,
            inputs=self.inputs(frequency),
            duration=1 / frequency,
            parameters=self.parameters,
            initial=self.named(x),
            method=METHOD if self.engine else "LSODA",
            **accuracy,
        )

    def states_of(self, run: xarray.Dataset) -> FloatArray:
        """Return the states of a run (n, nt), banks spread."""
        values = [run[record.name].values.T for record in self.module.STATES]
        return np.concatenate([np.atleast_2d(value) for value in values])

    def temperature_of(self, run: xarray.Dataset) -> FloatArray:
        """Return the body's temperature (nt,)."""
        return np.asarray(run[f"T_{self.module.BODIES[0].name}"].values, dtype=float)

    def named(self, x: FloatArray) -> dict[str, LaneValue]:
        """Return a state x (n,) by name, as `simulate` takes it."""
        records = self.module.STATES
        parts = zip(records, rows(records, self.values), strict=True)
        return {r.name: x[part] if r.bank else float(x[part.start]) for r, part in parts}

    @cached_property
    def engine(self) -> Engine | None:
        """The module in C; where nothing compiles it, LSODA follows a period to 1e-9, slowly."""
        return compiled(self.module)

    @cached_property
    def values(self) -> Any:
        """The module's frozen `Parameters`."""
        return read_parameters(self.module, self.parameters)

    def start(self, frequency: float) -> FloatArray:
        """Return the state (n,) that a run starts from."""
        u = read_inputs(self.module, self.inputs(frequency), 1 / frequency).segments[0].at(0.0)
        return read_initial(self.module, self.values, u, self.initial)

    def temperature(self, x: FloatArray) -> float:
        """Return the body's temperature in the state x (n,); inf far outside of what it can be."""
        with np.errstate(over="ignore"):
            return float(self.module.temperatures(x, self.values)[0])

    def entropy_row(self, x: FloatArray) -> int:
        """Return the row of the body's entropy: the only state that its temperature depends on."""
        T = self.temperature(x)
        for row in range(x.size):
            if self.temperature(_moved(x, row, 1e-3 * max(1.0, abs(x[row])))) != T:
                return row
        what = f"the temperature of '{self.module.BODIES[0].name}' depends on no state"
        raise RunError(what, f"model '{self.module.NAME}'", "a temperature that rises with entropy")

    def at_temperature(self, x: FloatArray, T: float) -> FloatArray:
        """Return the state x (n,) with the body's entropy such that its temperature is T.

        By Newton's method on log T, which is linear in the entropy for an exponential law, and
        proved to rise with it.
        """
        found, row = x.copy(), self.entropy_row(x)
        step = 1e-3 * max(1.0, abs(x[row]))
        for _ in range(100):
            now = self.temperature(found)
            while not self.temperature(_moved(found, row, step)) < now * GENTLE:
                step /= 10
            ahead = self.temperature(_moved(found, row, step))
            move = np.log(T / now) * step / np.log(ahead / now)
            found[row] += move
            if abs(move) <= 1e-14 * max(step, abs(found[row])):
                break
        return found


def _moved(x: FloatArray, row: int, by: float) -> FloatArray:
    """Return the state x (n,) with one row moved."""
    moved = x.copy()
    moved[row] += by
    return moved


def stroboscope(
    module: GeneratedModule,
    inputs: Driven,
    frequency: float,
    parameters: Mapping[str, LaneValue] | None,
    initial: Mapping[str, LaneValue] | None,
    steps: int,
) -> Stroboscope:
    """Return the stroboscope of a module, checked at one frequency; more steps if inputs need them.

    Raises
    ------
    UsageError : the module has not one body, an input does not repeat, or an argument is wrong.
    RunError : a run leaves the domain in its first period.
    """
    bodies = [record.name for record in checked(module).BODIES]
    if len(bodies) != 1:
        what = f"model '{module.NAME}' has {len(bodies)} bodies"
        remedy = "simulate until it settles"
        raise UsageError(what, "periodic_steady_state.model", "a model with one body", remedy)
    refuse_unperiodic(module, inputs(frequency), frequency)
    steps = steps_needed(inputs(frequency), frequency, steps)
    known_keys(initial, [record.name for record in module.STATES], "periodic_steady_state.initial")
    strobe = Stroboscope(module, inputs, parameters or {}, initial or {}, steps)
    accuracy = {"step": 1 / frequency / steps} if strobe.engine else {"rtol": FINE}
    strobe.run(strobe.start(frequency), frequency, times=2, **accuracy)  # its errors say why
    return strobe
