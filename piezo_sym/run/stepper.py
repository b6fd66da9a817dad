"""One step at a time, with inputs that the caller decides: closed loops, hardware in the loop.

Input: a generated module, a step, parameters and initial values.  Output: a `Stepper`, whose
`step(u)` takes one step of Gauss collocation in C and returns the outputs y.  What happens in each
step costs no more than a call of C; the names, the ledger and errors are made when asked for.
"""

from __future__ import annotations

import ctypes
import struct
import threading
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NoReturn, final

import numpy as np

from piezo_sym.errors import PiezoError, RunError, UsageError, listing, quote
from piezo_sym.run.checks import FloatArray, number, positive, vector
from piezo_sym.run.collocation import layout_of, read_order
from piezo_sym.run.dataset import Known, Trajectory
from piezo_sym.run.engine.batch import Batch, Stepping
from piezo_sym.run.engine.engine import engine_of
from piezo_sym.run.engine.records import POINTER, at, c_record
from piezo_sym.run.guard import check_start, domain_error, input_conditions
from piezo_sym.run.inputs import Inputs, read_inputs
from piezo_sym.run.module import GeneratedModule, checked, row_names
from piezo_sym.run.parameters import LaneValue, read_initial, read_parameters
from piezo_sym.run.signals import Constant
from piezo_sym.run.system import DrivenModule


@final
class Limits:
    """The conditions of the domain on inputs alone, which C looks at before each step."""

    def __init__(self, system: DrivenModule) -> None:
        conditions, _ = input_conditions(system)
        domain = system.module.DOMAIN
        self.conditions = np.array(conditions, dtype="l")
        self.strict = np.array([domain[n].strict for n in conditions], dtype="l")
        self.margins = np.zeros(len(domain))

    def hold(self) -> bool:
        """Return whether the last step's inputs lay in the domain; a margin of nan does not."""
        found = self.margins[self.conditions]
        return bool(np.all((found > 0) | ((found == 0) & (self.strict == 0))))


def _refuse_signals(module: GeneratedModule, known: Inputs) -> None:
    for record, signal in zip(module.INPUTS, known.signals, strict=True):
        if not isinstance(signal, Constant):
            where, remedy = f"Stepper.inputs.{record.name}", "give the others to step(u)"
            raise UsageError("this is no number", where, "the input at t = 0", remedy)


@final
class Stepper:
    """A model that goes step by step, with inputs that the caller decides.

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

    Parameters
    ----------
    module : a generated module; `piezo_sym.Stepper` takes a model, a name or a path.
    step : length of a step [s]; the step is halved inside where it has to be.
    order : 2, 4, 6, 8 or 10: by which power of the step its error falls, where all is smooth.
    parameters, initial, inputs : as for `simulate`; `inputs` are those at t = 0, numbers only.

    Attributes
    ----------
    states, inputs, outputs : the names of the entries of x, u and y, in order; lanes `phi_1`, ...
    x : the state (n,), a copy, banks spread.
    time : the time [s] after the steps taken.
    ledger : what ports and processes did since t = 0, by the names of `simulate`'s Dataset.

    Raises
    ------
    UsageError, EngineError, RunError
        If an option is wrong, there is no compiler, or the start is outside the domain.
    """

    def __init__(
        self,
        module: GeneratedModule,
        *,
        step: float,
        order: int = 2,
        parameters: Mapping[str, LaneValue] | None = None,
        initial: Mapping[str, LaneValue] | None = None,
        inputs: Mapping[str, float] | None = None,
    ) -> None:
        checked(module)
        self._h = positive(step, "Stepper.step")
        stages = read_order(order, "Stepper.order") // 2
        engine = engine_of(module)
        values = read_parameters(module, parameters)
        known = read_inputs(module, inputs, self._h)
        _refuse_signals(module, known)
        system = self._system = DrivenModule(module, values, known)
        x = read_initial(module, values, system.inputs.segments[0].at(0.0), initial)
        check_start(system, x)
        self.states = tuple(row_names(module.STATES, values))
        self.inputs = tuple(record.name for record in module.INPUTS)
        self.outputs = tuple(record.name for record in module.OUTPUTS)
        self._start, self._taken = x, 0
        stepping = Stepping(stages, 0.0, self._h, self._h, fixed=self._h)
        layout = layout_of(1, x.size, side_by_side=False)
        self._batch = Batch(engine, [values], x[None], system.inputs, np.empty(0), stepping, layout)
        self._u, self._y = np.zeros(len(self.inputs)), np.zeros(len(self.outputs))
        self._kept = np.zeros(2 * x.size + self._batch.ledgers.size)
        self._put, self._buffer = struct.Struct(f"{self._u.size}d").pack_into, self._u.data
        self._copied: Callable[[], FloatArray] = self._y.copy
        self._limits = Limits(system)
        functions = (ctypes.cast(engine.function(n), POINTER) for n in ("outputs", "margins"))
        self._call = self._made(*functions)
        self._at = ctypes.byref(self._call)
        self._once: Any = self._batch.function("step_once")
        self._forget: Any = self._batch.function("forget")
        self._forget(self._at)
        lock = threading.Lock()
        self._begin, self._end = lock.acquire, lock.release

    def __repr__(self) -> str:
        """Return the model, the step and the time."""
        return f"<Stepper of {self._system.module.NAME}: step {self._h:g} s, time {self.time:g} s>"

    def _made(self, outputs: Any, margins: Any) -> Any:
        """Return what a call needs, all in one place; functions are those of ``<model>.c``."""
        batch, limits = self._batch, self._limits
        return c_record("stepper")(
            *(batch.address, batch.run, batch.inputs.segments[0].signals),
            *(at(self._u), at(self._y), outputs, margins),
            *(at(self._kept), at(limits.margins), at(limits.conditions), at(limits.strict)),
            limits.conditions.size,
        )

    @property
    def x(self) -> FloatArray:
        """The state, shape (n,)."""
        x: FloatArray = self._batch.x[0].copy()
        return x

    @property
    def time(self) -> float:
        """The time [s]."""
        return self._taken * self._h

    @property
    def ledger(self) -> dict[str, Any]:
        """The ledger since t = 0: numbers, or for a bank one per lane (lanes,).

        `supplied_<port>`, `heat_<element>` [J], `produced_<element>` [J/K],
        `entropy_exchanged_<port>` [J/K]; `energy_residual` [J] and `entropy_residual` [J/K] are
        what is left over of the two balances: round-off.
        """
        x, u = self._batch.x[0][:, None], self._u[:, None]
        sums = self._batch.ledgers[0, 0][:, None]
        past = Trajectory(self._start, x, u, sums, self._taken, 0)
        rows = {name: values[0] for name, (_, values, _) in Known.of(self._system, past).ledger()}
        return {name: row.copy() if row.ndim else float(row) for name, row in rows.items()}

    def step(self, u: Sequence[float] | FloatArray) -> FloatArray:
        """Take one step with the inputs u held, and return the outputs y after it.

        Parameters
        ----------
        u : one number per input, in the order of `inputs`, SI units.

        Returns
        -------
        numpy.ndarray
            y (ports,), in the order of `outputs`, SI units; an array of the caller's own.

        Raises
        ------
        UsageError : there are more or fewer numbers than inputs, one is not finite, or another
            thread is stepping it.
        RunError : inputs leave the domain, or no step stays in it. State, time and ledger are those
            before the step.
        """
        if not self._begin(False):  # not to wait
            what = "another thread is stepping this Stepper"
            raise UsageError(what, "Stepper.step", remedy="give each thread a Stepper of its own")
        try:
            self._put(self._buffer, 0, *u)
            if not self._once(self._at):
                raise self._refusal(u)
            self._taken += 1
            return self._copied()
        except (ValueError, TypeError, OverflowError, struct.error) as error:
            raise self._no_inputs(u) from error
        finally:
            self._end()

    def __reduce__(self) -> NoReturn:
        """Refuse to be pickled or copied: its state lies in C."""
        what = "a Stepper stays in its process"
        remedy = "make another there, with initial=dict(zip(stepper.states, stepper.x))"
        raise UsageError(what, "Stepper", remedy=remedy)

    def reset(self, x: Sequence[float] | FloatArray | None = None) -> None:
        """Go back to t = 0, with an empty ledger.

        Parameters
        ----------
        x : the state to start from (n,), in the order of `states`; the last one when left out.

        Raises
        ------
        UsageError : this is no state.
        RunError : it is outside the domain.
        """
        if x is not None:
            start = vector(x, "Stepper.reset")
            if start.size != len(self.states):
                expected = f"one number each for {listing(self.states)}"
                raise UsageError(f"{start.size} numbers are no state", "Stepper.reset", expected)
            check_start(self._system, start)
            self._start = start
        self._batch.x[0] = self._start
        self._batch.largest[0] = np.abs(self._start)
        self._batch.ledgers[:] = 0.0
        self._forget(self._at)
        self._taken = 0

    def _no_inputs(self, u: object) -> UsageError:
        if isinstance(u, Sequence) and not isinstance(u, str) and len(u) == len(self.inputs):
            for name, value in zip(self.inputs, u, strict=True):
                number(value, f"Stepper.step: input {quote(name)}")
        expected = f"one number each for {', '.join(self.inputs)}"
        return UsageError("these are no inputs", "Stepper.step", expected)

    def _refusal(self, u: Sequence[float] | FloatArray) -> PiezoError:
        for name, value in zip(self.inputs, u, strict=True):
            number(value, f"Stepper.step: input {quote(name)}")
        if not self._limits.hold():
            return domain_error(self._system, self.time, self._batch.x[0], self._u)
        what = f"no step stays in the domain at t = {self.time:.6g} s"
        return RunError(what, "Stepper.step", remedy="look at the inputs, or take shorter steps")
