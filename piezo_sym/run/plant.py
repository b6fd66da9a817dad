"""A plant for closed loops: one model or several, sampled, with delay and quantised measurements.

Input: Steppers of equal models, what a sample is, and what lies between controller and plant.
Output: `Plant`, which a controller steps sample by sample.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping, Sequence
from typing import Any, final

import numpy as np

from piezo_sym.errors import UsageError, quote
from piezo_sym.run.checks import FloatArray, known_keys, positive, whole
from piezo_sym.run.stepper import Stepper

#: A sample that is a whole number of steps but for such a part of one.
ROUNDING = 1e-9


@final
class Plant:
    """One Stepper or several side by side, as a controller sees them: see `piezo_sym.Stepper`.

    `made` makes a Stepper with some parameters; a list of them makes as many plants.

    Attributes
    ----------
    states, inputs, outputs : names, in the order of x, u and y.
    x : the state (n,), of several (n, plants); `time` [s].
    ledgers : of each plant, see `Stepper.ledger`.
    """

    def __init__(
        self,
        made: Callable[[Mapping[str, Any] | None], Stepper],
        parameters: Sequence[Mapping[str, Any]] | Mapping[str, Any] | None,
        step: float,
        sample: float | None,
        delay: int,
        resolution: Mapping[str, float] | None,
    ) -> None:
        self._many = isinstance(parameters, Sequence)
        each = parameters if isinstance(parameters, Sequence) else [parameters]
        if not each:
            raise UsageError("there is no plant", "Stepper.parameters", "one mapping per plant")
        self._plants = tuple(made(one) for one in each)
        first = self._plants[0]
        self.states, self.inputs, self.outputs = first.states, first.inputs, first.outputs
        ratio = 1.0 if sample is None else positive(sample, "Stepper.sample") / step
        self._steps = round(ratio)
        if self._steps < 1 or abs(ratio - self._steps) > ROUNDING * self._steps:
            what = f"{quote(sample)} s is no multiple of the step"
            raise UsageError(what, "Stepper.sample", f"a whole number of steps of {step:g} s")
        self._delay = whole(delay, "Stepper.delay", 0)
        self._wanted = self._waiting()
        ports = {f"y_{name}": name for name in self.outputs}
        known = known_keys(resolution, (*self.outputs, *ports), "Stepper.resolution")
        sizes = {ports.get(name, name): value for name, value in known.items()}
        named = ((name, sizes.get(name, 0.0)) for name in self.outputs)
        checked = [positive(v, f"Stepper.resolution.{name}") if v else 0.0 for name, v in named]
        self._resolution = np.array(checked)[:, None]

    def _waiting(self) -> deque[FloatArray]:
        """Return the inputs at t = 0 (m, plants), as often as there is delay."""
        first = np.repeat(self._plants[0].initial_inputs[:, None], len(self._plants), axis=1)
        return deque([first] * self._delay)

    @property
    def x(self) -> FloatArray:
        """The state, shape (n,), of several plants (n, plants)."""
        found = np.stack([plant.x for plant in self._plants], axis=1)
        return found if self._many else found[:, 0]

    @property
    def time(self) -> float:
        """The time [s]."""
        return self._plants[0].time

    @property
    def ledgers(self) -> tuple[dict[str, Any], ...]:
        """The ledger of each plant."""
        return tuple(plant.ledger for plant in self._plants)

    def step(self, u: Sequence[float] | FloatArray) -> FloatArray:
        """Take one sample, and return what is measured at its end.

        Parameters
        ----------
        u : one number per input (m,), the same for all plants, or (m, plants); SI units. They act
            `delay` samples later.

        Returns
        -------
        numpy.ndarray
            y (ports,), of several plants (ports, plants), rounded to the resolution.

        Raises
        ------
        UsageError, RunError : as for `piezo_sym.run.stepper.Stepper.step`.
        """
        shape = len(self.inputs), len(self._plants)
        try:
            given = np.asarray(u, dtype=float)
            if given.shape[:1] != shape[:1]:
                raise ValueError
            wanted = np.broadcast_to(given[:, None] if given.ndim == 1 else given, shape)
        except (ValueError, TypeError) as error:
            what, expected = f"{quote(u)} are no inputs", f"numbers of shape {shape}"
            raise UsageError(what, "Stepper.step", expected) from error
        self._wanted.append(wanted)
        acting = self._wanted.popleft()
        y = np.empty((len(self.outputs), len(self._plants)))
        for n, plant in enumerate(self._plants):
            for _ in range(self._steps):
                measured = plant.step(acting[:, n])
            y[:, n] = measured
        rounded = self._resolution > 0
        size = np.where(rounded, self._resolution, 1.0)
        y = np.where(rounded, np.round(y / size) * size, y)
        return y if self._many else y[:, 0]

    def reset(self) -> None:
        """Go back to t = 0, with empty ledgers, and no inputs on their way."""
        for plant in self._plants:
            plant.reset()
        self._wanted = self._waiting()
