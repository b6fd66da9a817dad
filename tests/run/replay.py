"""Runs whose steps can be taken again, to the bit, and looked at: for derivatives along them.

Input: one run of a module.  Output: `Taped`, whose steps are `TapedStep` records: what each begins
with is all that it depends on, beside the run's parameters, inputs, scales and noise of states.
"""

import ctypes
from dataclasses import dataclass, replace
from typing import Any, final

import numpy as np

from piezo_sym.run.checks import FloatArray
from piezo_sym.run.engine.batch import Batch, Stepping
from piezo_sym.run.engine.engine import Engine
from piezo_sym.run.engine.records import DOUBLE, at, c_record
from piezo_sym.run.inputs import Inputs

#: Steps that are taken before the tape is read.
ROOM = 256


@final
@dataclass(frozen=True)
class TapedStep:
    """What a step begins with: its time and length [s], the state (n,), branches (stages, ...)."""

    t: float
    h: float
    x: FloatArray
    branches: FloatArray


@final
@dataclass(frozen=True)
class Solved:
    """A step: rates (stages, n), inputs at its stages and its end (stages + 1, inputs), its end."""

    rates: FloatArray
    u: FloatArray
    end: FloatArray


@final
class Taped:
    """A run from x (n,) at t = 0, of steps that can be taken again.

    Steps end at kinks, or go over them if they are fixed.

    Parameters
    ----------
    engine, parameters, inputs : of the run.
    x : the state at t = 0.
    scale : the size of each state, by which changes count as noise; when left out, a survey's.
    noise : how far round-off moves each state that is at rest; when left out, not at all.
    """

    def __init__(
        self,
        engine: Engine,
        parameters: Any,
        x: FloatArray,
        inputs: Inputs,
        stepping: Stepping,
        scale: FloatArray | None = None,
        noise: FloatArray | float = 0.0,
    ) -> None:
        self.engine, self.parameters, self.stages = engine, parameters, stepping.stages
        if stepping.lossy:
            raise ValueError("a dissipative step is not taken again")
        self._duration = inputs.duration
        stepping = stepping if stepping.fixed else replace(stepping, kinks="end")
        starts, none = np.atleast_2d(x), np.empty(0)
        self._batch = Batch(engine, [parameters], starts, inputs, none, stepping, "one")
        if scale is None:
            self._batch.survey(stepping.longest)
            scale = self._batch.largest[0]
        self._batch.largest[0] = scale
        self._batch.noise[0] = noise
        self.scale = np.array(np.broadcast_to(scale, x.shape), dtype=float)
        branches = self._batch.sizes()[2]
        self._t, self._h = np.empty(ROOM), np.empty(ROOM)
        self._x = np.empty((ROOM, x.size))
        self._branches = np.empty((ROOM, stepping.stages, branches))
        arrays = (self.scale, self._t, self._h, self._x, self._branches)
        segments = self._batch.inputs.address(inputs.start)
        self._record = c_record("tape")(segments, *map(at, arrays))
        self._batch.call("keep", ctypes.byref(self._record))

    def run(self) -> tuple[TapedStep, ...]:
        """Take the run as far as it goes; return its steps."""
        steps: list[TapedStep] = []
        more = True
        while more:
            more = self._batch.go(ROOM)
            arrays = zip(self._t, self._h, self._x, self._branches, strict=True)
            for _, (t, h, x, b) in zip(range(self._record.count), arrays, strict=False):
                steps.append(TapedStep(float(t), float(h), x.copy(), b.copy()))
            self._record.count = 0
        return tuple(steps)

    @property
    def x(self) -> FloatArray:
        """Where the run stands, (n,)."""
        x: FloatArray = self._batch.x[0]
        return x

    def replay(self, step: TapedStep) -> Solved:
        """Take a step again; the same to the bit.

        Raises
        ------
        ValueError
            If it has no rates: it is no step of this run.
        """
        inputs = len(self.engine.module.INPUTS)
        rates, u = np.empty((self.stages, step.x.size)), np.empty((self.stages + 1, inputs))
        end = np.empty_like(step.x)
        own = (np.ascontiguousarray(a, dtype=float) for a in (step.x, step.branches))
        arrays = (*own, rates, u, end)
        inside = 0 <= step.t < self._duration
        given = "replay", DOUBLE(step.t), DOUBLE(step.h)
        if not inside or not self._batch.call(*given, *map(at, arrays)):
            raise ValueError("the step has no rates")
        return Solved(rates, u, end)
