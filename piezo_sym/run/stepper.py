"""`Stepper`: one step at a time, with the caller's inputs: closed loops, hardware in the loop.

Input: a generated module, a step, parameters and initial values, and the delay, sampling and quanta
between plant and controller.  Output: a `Stepper`, whose `step(u)` takes steps of Gauss collocation
in C and returns the outputs y.  A step costs little more than a call of C: names, ledger and errors
are computed on demand.
"""

from __future__ import annotations

import ctypes
import struct
import threading
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any, NoReturn, final

import numpy as np

from piezo_sym.errors import PiezoError, UsageError, listing, quote
from piezo_sym.run.checks import BOOLS, FloatArray, calling, integer, number, positive, vector
from piezo_sym.run.collocation import read_order
from piezo_sym.run.engine.batch import Stepping
from piezo_sym.run.engine.engine import engine_of
from piezo_sym.run.engine.records import c_record
from piezo_sym.run.guard import check_start
from piezo_sym.run.module import GeneratedModule, checked, in_order, row_names
from piezo_sym.run.parameters import Given, Start
from piezo_sym.run.plant import Plant, read_held, read_plants, read_quanta
from piezo_sym.run.system import DrivenModule

#: The longest delay of inputs, in calls.
MOST_DELAY = 1_000_000


@final
class Stepper:
    """A model that goes step by step, with the caller's inputs.

    A PI controller of the actuator's position (q is the first state), 0.1 mm within 1 s:

    >>> from piezo_sym import Stepper
    >>> h, target, integral = 2e-5, 1e-4, 0.0
    >>> actuator = Stepper("piezo_stack", step=h)
    >>> for _ in range(50_000):
    ...     error = target - actuator.x[0]
    ...     integral += error * h
    ...     y = actuator.step([0.0, 2e4 * error + 4e7 * integral, 298.15])  # F_ext, V_in, T_e
    >>> print(f"q = {actuator.x[0] * 1e6:.2f} um at t = {actuator.time:.2f} s")
    q = 100.00 um at t = 1.00 s

    Two actuators with other dampers at 5 kHz, the voltage one sample late, q measured to 10 nm:

    >>> plants = [{"d": 300.0}, {"d": 500.0}]
    >>> quantum = {"q": 1e-8}
    >>> pair = Stepper("piezo_stack", step=h, parameters=plants, every=10, delay=1, quantum=quantum)
    >>> integral = 0.0
    >>> for _ in range(5000):
    ...     error = target - pair.measured[0]
    ...     integral += error * 10 * h
    ...     y = pair.step([0.0, 2e4 * error + 4e7 * integral, 298.15])
    >>> pair.x.shape, y.shape, (abs(pair.x[0] - target) < 2e-8).tolist()
    ((6, 2), (3, 2), [True, True])

    Parameters
    ----------
    model : a shipped name, a path or a `Model`; here, of `piezo_sym.run`, a generated module.
    step : length of a step [s]; a step that fails is halved. Motions much faster than it ring from
        step to step after a jump, at order 2, instead of decaying: take shorter steps, `every` so
        many, or a higher order. Of `simulate`, `dissipative_start` damps them; a Stepper has none.
    order : 2, 4, 6, 8, 10 or 12: the order of the error in the step, where all is smooth.
    parameters, initial, inputs : as for `simulate`, `<bank>_count`, `T_<body>` and a Dataset among
        them; `inputs` are those at t = 0, numbers only. A list of parameters makes as many plants:
        each array has a last axis for them.
    every : steps of a call, its inputs held: the sample time is every*step.
    delay : calls until inputs act; those at t = 0 act until then.
    quantum : state, a lane's, a bank's or an output `y_<port>` -> quantum of its measurement, SI.

    Attributes
    ----------
    states, inputs, outputs : the names of the entries of x, u and y, in order, those of
        `simulate`'s Dataset: an output is `y_<port>`; lanes are `phi_1`, ...
    x : the state (n,), a copy, banks spread; `measured`: the state in multiples of quanta.
    time : the time [s] after the steps taken.
    ledger : integrals over ports and processes since t = 0, by the names of `simulate`'s Dataset.

    Methods
    -------
    step(u) : take one step, or `every` steps, with the inputs u held: a number for each, in the
        order of `inputs`, or a dict. Returns the outputs y (ports,), in the order of `outputs`.
    reset(x=None) : go back to t = 0, to the state x (n,), or to where it last began.

    Raises
    ------
    UsageError : an option is wrong.
    EngineError : there is no compiler.
    RunError : the start is outside the domain.
    """

    @calling("Stepper")
    def __init__(
        self,
        module: GeneratedModule,
        *,
        step: float,
        order: int = 2,
        parameters: Given | Sequence[Given] | None = None,
        initial: Start | None = None,
        inputs: Mapping[str, float] | None = None,
        every: int = 1,
        delay: int = 0,
        quantum: Mapping[str, float] | None = None,
    ) -> None:
        self._name, self._h = checked(module).NAME, positive(step, "Stepper.step")
        stages, engine = read_order(order, "Stepper.order") // 2, engine_of(module)
        self._many, held = isinstance(parameters, Sequence), read_held(module, inputs, self._h)
        values, initial = read_plants(module, parameters, initial)
        self.states = tuple(row_names(module.STATES, values[0]))
        self.inputs = tuple(record.name for record in module.INPUTS)
        self.outputs = tuple(f"y_{record.name}" for record in module.OUTPUTS)
        self._u = np.tile(held.segments[0].at(0.0), (len(values), 1))
        self._y = np.zeros((len(values), len(self.outputs)))
        how = Stepping(stages, 0.0, self._h, self._h, fixed=self._h)
        rows = zip((DrivenModule(module, p, held) for p in values), self._u, self._y, strict=True)
        self._plants = [Plant(system, engine, initial, how, u, y) for system, u, y in rows]
        steps, many = integer(every, "Stepper.every", 1), len(self._plants)
        self._calls = (c_record("stepper") * many)(*(p.record(steps, many) for p in self._plants))
        self._at = ctypes.byref(self._calls)
        self._once, self._forget = map(self._plants[0].batch.function, ("step_once", "forget"))
        self._x_quanta, self._y_quanta = read_quanta(quantum, module, values[0], self.outputs)
        kept = integer(delay, "Stepper.delay", 0, MOST_DELAY) + 1
        self._first, self._late = self._u.copy(), np.zeros((kept, *self._u.shape))
        self._direct = not (self._many or delay)
        self._put, self._buffer = struct.Struct(f"{len(self.inputs)}d").pack_into, self._u.data
        direct = self._direct and self._y_quanta is None
        shown = partial(self._shown, self._y, self._y_quanta)
        self._read: Callable[[], FloatArray] = self._y[0].copy if direct else shown
        lock = threading.Lock()
        self._begin, self._end = lock.acquire, lock.release
        self.reset()

    def __repr__(self) -> str:
        """Return the model, the step and the time."""
        return f"<Stepper of {self._name}: step {self._h:g} s, time {self.time:g} s>"

    def _shown(self, rows: FloatArray, quanta: FloatArray | None = None) -> FloatArray:
        """Return a copy of rows, rounded to quanta: (k,) of one plant, (k, plants) of several."""
        if quanta is not None:
            size = np.where(quanta > 0, quanta, 1.0)
            rows = np.where(quanta > 0, np.round(rows / size) * size, rows)
        return rows.T.copy() if self._many else rows[0].copy()

    @property
    def x(self) -> FloatArray:
        """The state, shape (n,); of several plants (n, plants)."""
        return self._shown(np.array([plant.batch.x[0] for plant in self._plants]))

    @property
    def measured(self) -> FloatArray:
        """The state, shaped as x, rounded to quanta where there are some."""
        return self._shown(np.array([plant.batch.x[0] for plant in self._plants]), self._x_quanta)

    @property
    def time(self) -> float:
        """The time [s]."""
        return self._taken * int(self._calls[0].steps) * self._h

    @property
    def ledger(self) -> dict[str, Any]:
        """The ledger since t = 0: numbers, or for a bank one per lane (lanes,).

        `supplied_<port>`, `heat_<element>` [J], `produced_<element>` [J/K],
        `entropy_exchanged_<port>` [J/K]; the residuals of both balances, `energy_residual` [J] and
        `entropy_residual` [J/K]: round-off. Of several plants, with a last axis for them.
        """
        ledgers = [plant.ledger(self._taken) for plant in self._plants]
        if self._many:
            return {name: np.stack([one[name] for one in ledgers], axis=-1) for name in ledgers[0]}
        return {name: row if row.ndim else float(row) for name, row in ledgers[0].items()}

    def step(self, u: Sequence[float | FloatArray] | FloatArray | dict[str, Any]) -> FloatArray:
        """Take one step, or `every` steps, with the inputs u held, and return the outputs after.

        Parameters
        ----------
        u : one number per input, in the order of `inputs` or by name, SI units; with several
            plants, each a number for all or an array (plants,). Lists take less time than dicts.

        Returns
        -------
        numpy.ndarray
            y (ports,), of several plants (ports, plants), a copy, in the order of `outputs`, SI.

        Raises
        ------
        UsageError : there are more or fewer numbers than inputs, one is not finite, or another
            thread is stepping it.
        RunError : inputs leave the domain, or no step stays in it. State, time, ledger and delayed
            inputs of all plants are then those before the call.
        """
        if not self._begin(False):  # not to wait
            what = "another thread is stepping this Stepper"
            raise UsageError(what, "Stepper.step", remedy="give each thread a Stepper of its own")
        try:
            if isinstance(u, dict):
                u = in_order(u, self.inputs, "Stepper.step")
            if self._direct:
                self._put(self._buffer, 0, *u)
                if not BOOLS.isdisjoint(map(type, u)):
                    raise TypeError("struct takes True")
            else:
                self._queue(u)
            if failed := self._once(self._at):
                self._check(u)
                plant = self._plants[failed - 1]
                raise self._of_plant(plant.refusal(self.time), failed - 1)
            self._taken += 1
            return self._read()
        except (ValueError, TypeError, OverflowError, struct.error) as error:
            raise self._no_inputs(u) from error
        finally:
            self._end()

    def _queue(self, u: Sequence[float | FloatArray] | FloatArray) -> None:
        """Store inputs for the call in which they act, and set those that act in this one."""
        size = len(self._late)
        stored = self._late[(self._taken + size - 1) % size]  # written again if this call fails
        for row, value in zip(stored.T, u, strict=True):
            if np.ndim(value) > self._many or np.asarray(value).dtype.kind not in "iuf":
                raise TypeError("NumPy would take '1' and True, too")
            row[:] = value
        if size > 1:  # C checks those that act
            if not np.all(np.isfinite(stored)):
                raise ValueError
            acting = self.time + (size - 1) * int(self._calls[0].steps) * self._h
            for n, (plant, row) in enumerate(zip(self._plants, stored, strict=True)):
                if error := plant.inputs_error(row, acting):
                    raise self._of_plant(error, n)
        self._u[:] = self._late[self._taken % size]

    def __reduce__(self) -> NoReturn:
        """Raise `UsageError` when pickled or copied: its state lies in C."""
        what = "a Stepper stays in its process"
        remedy = "make another there, with initial=dict(zip(stepper.states, stepper.x))"
        raise UsageError(what, "Stepper", remedy=remedy)

    def reset(self, x: Sequence[float] | FloatArray | None = None) -> None:
        """Go back to t = 0, with an empty ledger and without delayed inputs.

        Parameters
        ----------
        x : the state to start from (n,), in the order of `states`, of several plants also an array
            (n, plants); that of the last reset, or the initial one, when left out.

        Raises
        ------
        UsageError : x is no state.
        RunError : x is outside the domain.
        """
        if x is not None:
            for plant, start in zip(self._plants, self._starts(x), strict=True):
                plant.start = start
        for n, plant in enumerate(self._plants):
            plant.reset()
            self._forget(ctypes.byref(self._calls[n]))
        self._late[:] = self._first
        self._taken = 0

    def _starts(self, x: Sequence[float] | FloatArray) -> list[FloatArray]:
        """Return the states from which all plants start; raise `UsageError` if one is no state."""
        each = isinstance(x, np.ndarray) and x.shape == (len(self.states), len(self._plants))
        given = list(np.transpose(x)) if self._many and each else [x] * len(self._plants)
        starts = [vector(one, "Stepper.reset") for one in given]
        for plant, start in zip(self._plants, starts, strict=True):
            if start.size != len(self.states):
                expected = f"one number each for {listing(self.states)}"
                raise UsageError(f"{start.size} numbers are no state", "Stepper.reset", expected)
            check_start(plant.system, start)
        return starts

    def _no_inputs(self, u: object) -> UsageError:
        if isinstance(u, Sequence) and not isinstance(u, str) and len(u) == len(self.inputs):
            self._check(u)
        expected = f"a list, in this order, of one number each for {', '.join(self.inputs)}"
        expected += f", or {len(self._plants)} numbers, one per plant" * self._many
        return UsageError("these are no inputs", "Stepper.step", expected)

    def _check(self, u: Sequence[float | FloatArray] | FloatArray) -> None:
        """Raise `UsageError` for the first input that is no finite number."""
        for name, value in zip(self.inputs, u, strict=True):
            for one in np.ravel(value).tolist() if self._many else [value]:
                number(one, f"Stepper.step: input {quote(name)}")

    def _of_plant(self, error: PiezoError, n: int) -> PiezoError:
        """Return the error with the plant's number, if there are several plants."""
        if self._many:
            error.where += f", plant {n + 1} of {len(self._plants)}"
        return error
