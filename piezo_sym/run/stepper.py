"""One step at a time, with inputs that the caller decides: closed loops, hardware in the loop.

Input: a generated module, a step, parameters and initial values.  Output: a `Stepper`, whose
`step(u)` takes one step of the discrete gradient in C and returns the outputs y.
"""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, final

import numpy as np

from piezo_sym.errors import RunError, UsageError
from piezo_sym.run.checks import positive
from piezo_sym.run.engine.engine import engine_of
from piezo_sym.run.engine.march import Batch, Model, Path, at
from piezo_sym.run.guard import check_start
from piezo_sym.run.inputs import read_inputs
from piezo_sym.run.module import checked
from piezo_sym.run.parameters import read_initial, read_parameters
from piezo_sym.run.system import System

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from piezo_sym.run.checks import FloatArray
    from piezo_sym.run.module import GeneratedModule
    from piezo_sym.run.parameters import LaneValue


class Tick(ctypes.Structure):
    """MODEL(stepper) of stepper.c."""

    _fields_ = [
        ("model", Model),
        ("path", Path),
        ("u", ctypes.c_void_p),
        ("y", ctypes.c_void_p),
        ("h", ctypes.c_double),
    ]


@final
class Stepper:
    """A model that goes step by step, its inputs given anew for each step.

    >>> from piezo_sym import Stepper
    >>> actuator = Stepper("piezo_stack", step=2e-5)
    >>> for _ in range(1000):
    ...     v, i, T = actuator.step([0.0, 50.0, 298.15])  # y of the ports; u = F_ext, V_in, T_e
    >>> print(f"q = {actuator.x[0] * 1e6:.0f} um, T = {T:.2f} K at t = {actuator.time:.2f} s")
    q = 1007 um, T = 298.20 K at t = 0.02 s

    Parameters
    ----------
    module : a generated module; `piezo_sym.Stepper` also takes a model, a name or a path.
    step : length of a step [s]; the step is halved inside where it has to be.
    parameters, initial, inputs : as for `simulate`; `inputs` are those at t = 0, numbers only.

    Attributes
    ----------
    x : the state (n,), a copy, banks spread.
    time : the time [s] after the steps taken.

    Raises
    ------
    UsageError : an argument is wrong.
    EngineError : there is no compiler.
    RunError : the state at t = 0 is outside the domain.
    """

    def __init__(
        self,
        module: GeneratedModule,
        *,
        step: float,
        parameters: Mapping[str, LaneValue] | None = None,
        initial: Mapping[str, LaneValue] | None = None,
        inputs: Mapping[str, float] | None = None,
    ) -> None:
        checked(module)
        self._h = positive(step, "Stepper.step")
        engine = engine_of(module)
        values = read_parameters(module, parameters)
        system = System(module, values, read_inputs(module, inputs, self._h))
        x = read_initial(module, values, system.inputs.segments[0].at(0.0), initial)
        check_start(system, x)
        self._batch = Batch(engine, [values], x[None], 0)
        member = self._batch.members[0]
        member.fine.sums = None  # nobody asks for the ledger
        self._u, self._y = np.zeros(len(module.INPUTS)), np.zeros(len(module.OUTPUTS))
        self._all = Tick(member.model, member.fine, at(self._u), at(self._y), self._h)
        self._tick: Any = getattr(engine.library, f"{module.NAME}_tick")
        self._at = ctypes.byref(self._all)
        self._names = [record.name for record in module.INPUTS]
        self._taken = 0

    @property
    def x(self) -> FloatArray:
        """The state, shape (n,)."""
        x: FloatArray = self._batch.x[0].copy()
        return x

    @property
    def time(self) -> float:
        """The time [s]."""
        return self._taken * self._h

    def step(self, u: Sequence[float] | FloatArray) -> FloatArray:
        """Take one step with the inputs u held, and return the outputs y after it.

        Parameters
        ----------
        u : one number an input, in the spec's order, SI units. Conditions of the domain on inputs
            alone, such as T_e > T_0, are the caller's to keep: they are looked at when it is made.

        Returns
        -------
        numpy.ndarray
            y, one a port (shared with the next call: copy what you keep).

        Raises
        ------
        UsageError : there are more or fewer numbers than inputs.
        RunError : no step stays in the domain; the state is that before the step.
        """
        try:
            if len(u) != len(self._names):
                raise TypeError
            self._u[:] = u
        except (ValueError, TypeError) as error:
            expected = f"one number each for {', '.join(self._names)}"
            raise UsageError("these are no inputs", "Stepper.step", expected) from error
        if not self._tick(self._at):
            what = f"no step stays in the domain at t = {self.time:.6g} s"
            raise RunError(what, "Stepper.step", remedy="look at the inputs, or take shorter steps")
        self._taken += 1
        return self._y
