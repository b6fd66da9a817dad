"""The plants of a Stepper: each a model with its parameters and its record in C.

Input: a user's parameters, inputs and quanta; a driven module, its engine, its state at t = 0, and
the options of steps.  Output: the arguments checked; `Plant`, which owns the arrays that C uses.
"""

from __future__ import annotations

import ctypes
from collections.abc import Mapping, Sequence
from typing import Any, final

import numpy as np

from piezo_sym.errors import PiezoError, RunError, UsageError, listing, quote
from piezo_sym.run.checks import FloatArray, known_keys, positive
from piezo_sym.run.collocation import layout_of
from piezo_sym.run.dataset import Evaluation, Trajectory
from piezo_sym.run.engine.batch import Batch, Stepping
from piezo_sym.run.engine.engine import Engine
from piezo_sym.run.engine.records import POINTER, at, c_record
from piezo_sym.run.guard import (
    check_start,
    domain_error,
    edge_ahead,
    input_conditions,
    remedies,
)
from piezo_sym.run.inputs import Inputs, read_inputs
from piezo_sym.run.module import GeneratedModule, heat_exchanges, lanes, row_names
from piezo_sym.run.parameters import Given, Start, read_initial, read_parameters, start_of
from piezo_sym.run.signals import Constant
from piezo_sym.run.system import DrivenModule

#: The fractions of a call's time over which a failed state is extrapolated, to find the cause.
AHEAD = (1e-6, 1e-4, 1e-2, 0.1, 0.3, 1.0)


def read_plants(
    module: GeneratedModule, given: Given | Sequence[Given] | None, initial: Start | None
) -> tuple[list[Any], Given | None]:
    """Return the parameters of each plant, and the state from which all start, of a run its last.

    Raises `UsageError` if their states differ in number.
    """
    each = given if isinstance(given, Sequence) else [given]
    starts = [start_of(module, None, initial, values) for values in each]
    plants = [read_parameters(module, values) for _, _, values in starts]
    if len({tuple(lanes(p, bank) for bank in module.BANKS) for p in plants}) == 1:
        return plants, starts[0][1]
    what = "banks differ in size" if plants else "there is no plant"
    expected = "one mapping per plant, equal in the sizes of banks"
    raise UsageError(what, "Stepper.parameters", expected)


def read_held(module: GeneratedModule, given: Mapping[str, float] | None, step: float) -> Inputs:
    """Return the inputs at t = 0; raise `UsageError` if one is not a number."""
    known = read_inputs(module, given, step)
    for record, signal in zip(module.INPUTS, known.signals, strict=True):
        if not isinstance(signal, Constant):
            where, remedy = f"Stepper.inputs.{record.name}", "give the others to step(u)"
            raise UsageError("this is no number", where, "the input at t = 0", remedy)
    return known


def read_quanta(
    given: Mapping[str, float] | None, module: GeneratedModule, p: Any, outputs: tuple[str, ...]
) -> tuple[FloatArray | None, FloatArray | None]:
    """Return the quanta of x (n,) and of y (ports,), 0 for rows without one; None if all are.

    That of a bank's state is the quantum of all lanes that have none of their own.
    """
    states = row_names(module.STATES, p)
    banks = {record.name: row_names([record], p) for record in module.STATES if record.bank}
    where = "Stepper.quantum"
    for name in {*(given or ())} & {f"T_{body.name}" for body in module.BODIES}:
        known_hot = [outputs[n] for n in heat_exchanges(module)]
        remedy = f"temperatures among the outputs: {listing(known_hot)}"
        expected = f"a state or output: {listing([*states, *outputs, *banks])}"
        raise UsageError(f"{quote(name)} is not measured", where, expected, remedy)
    known = known_keys(given, (*states, *outputs, *banks), where)
    sizes = {name: positive(value, f"{where}.{name}") for name, value in known.items()}
    shared = {lane: sizes[bank] for bank in banks if bank in sizes for lane in banks[bank]}
    sizes = shared | sizes
    x, y = (np.array([sizes.get(name, 0.0) for name in names]) for names in (states, outputs))
    return x if np.any(x) else None, y if np.any(y) else None


@final
class Plant:
    """One model that goes step by step, its inputs held in each.

    Attributes
    ----------
    system : the model with its parameters.
    batch : the run in C.
    start : the state (n,) at t = 0.
    u : the inputs (m,) that C reads.
    y : the outputs (ports,) that it writes.
    """

    def __init__(
        self,
        system: DrivenModule,
        engine: Engine,
        initial: Given | None,
        stepping: Stepping,
        u: FloatArray,
        y: FloatArray,
    ) -> None:
        x = read_initial(system.module, system.parameters, u, initial)
        check_start(system, x)
        self.system, self.start, self._step = system, x, stepping.fixed
        self.u, self.y = u, y
        layout = layout_of(1, x.size)
        given = engine, [system.parameters], x[None], system.inputs, np.empty(0)
        self.batch = Batch(*given, stepping, layout)
        self._kept = np.zeros(2 * x.size + self.batch.ledgers.size)
        domain, (conditions, _) = system.module.DOMAIN, input_conditions(system)
        self._conditions = np.array(conditions, dtype="l")
        self._strict = np.array([domain[n].strict for n in conditions], dtype="l")
        self._margins = np.zeros(len(domain))
        named = ("outputs", "margins")
        self._functions = [ctypes.cast(engine.function(name), POINTER) for name in named]

    def record(self, steps: int, plants: int) -> Any:
        """Return MODEL(stepper) for the first of `plants` plants, with `steps` steps per call."""
        batch, self._length = self.batch, steps * self._step
        return c_record("stepper")(
            *(batch.address, batch.run, batch.inputs.segments[0].signals),
            *(at(self.u), at(self.y), *self._functions),
            *(at(self._kept), at(self._margins), at(self._conditions), at(self._strict)),
            *(self._conditions.size, steps, plants),
        )

    def inputs_error(self, u: FloatArray, t: float) -> RunError | None:
        """Return why the inputs u (m,), which act from t [s] on, leave the domain, or None."""
        x = self.start  # conditions on inputs do not depend on the state
        if np.any(self.system.violated(x, u)[self._conditions]):
            return domain_error(self.system, t, x, u)
        return None

    def reset(self) -> None:
        """Go back to the start, with an empty ledger; MODEL(forget) does the rest."""
        self.batch.x[0] = self.start
        self.batch.largest[0] = np.abs(self.start)
        self.batch.ledgers[:] = 0.0

    def ledger(self, taken: int) -> dict[str, FloatArray]:
        """Return the ledger after `taken` calls, by the names of `simulate`."""
        x, u = self.batch.x[0][:, None], self.u[:, None]
        sums = self.batch.ledgers[0, 0][:, None]
        past = Trajectory(self.start, x, u, sums, taken, 0)
        ledger = Evaluation.of(self.system, past).ledger()
        return {name: values[0].copy() for name, (_, values, _) in ledger}

    def refusal(self, t: float) -> PiezoError:
        """Return why C took no step at t [s]: the inputs, or the state."""
        margins = self._margins[self._conditions]
        if not np.all((margins > 0) | ((margins == 0) & (self._strict == 0))):  # nan lies outside
            return domain_error(self.system, t, self.batch.x[0], self.u)
        what, length = f"no step stays in the domain at t = {t:.6g} s", self._length
        x, lengths = self.batch.x[0], (part * length for part in AHEAD)
        if (edge := edge_ahead(self.system, x, self.u, *lengths))[0]:
            remedy = f"change {listing(remedies(self.system, edge[0]))}"
            return RunError(f"{what}: {edge[1]}", "Stepper.step", remedy=remedy)
        return RunError(what, "Stepper.step", remedy="look at the inputs, or take shorter steps")
