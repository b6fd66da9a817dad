"""Linear models: the derivatives of rates and outputs at a point, exact to round-off.

Input: a model, and a point: an operating point, a state, or the inputs that lead to rest.  Output:
a `LinearModel` with the matrices of

    d/dt dx = A dx + B du        dy = C dx + D du

which are the chain rule of the generated Jacobian, for inputs and outputs, too.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import lru_cache
from math import fsum
from pathlib import Path
from typing import Any, final

import numpy as np

from piezo_sym.analysis.operating_point import OperatingPoint, operating_point, read_constants
from piezo_sym.codegen.differences import sharp_program
from piezo_sym.codegen.functions import functions_of
from piezo_sym.codegen.jacobian import jacobian_of
from piezo_sym.codegen.lower import program_of
from piezo_sym.codegen.program import Entry, Names, Program, bank_of
from piezo_sym.codegen.quantities import quantities_of
from piezo_sym.derivation import derive
from piezo_sym.errors import RunError, UsageError, quote
from piezo_sym.expressions.tree import Expr, LaneSum, evaluate, names
from piezo_sym.modules import module_of
from piezo_sym.run.checks import FloatArray, known_keys
from piezo_sym.run.module import GeneratedModule, by_name, lanes, row_names, rows
from piezo_sym.run.parameters import LaneValue, read_initial, read_parameters
from piezo_sym.spec.load import load
from piezo_sym.spec.model import Model

WHERE = "linearize"


@final
@dataclass(frozen=True, eq=False)
class LinearModel:
    """A model near a point, d/dt dx = A dx + B du, dy = C dx + D du; SI units.

    ``A, B, C, D = linearize(...)`` unpacks it, and ``scipy.signal.StateSpace(*linearize(...))``
    takes it.

    Attributes
    ----------
    A, B, C, D : shapes (n, n), (n, m), (ports, n), (ports, m); banks spread.
    states, inputs, outputs : the names of x, u and y, lanes spread: phi_1, phi_2; outputs are
        `y_<port>`, as in a Dataset.
    units : of each name.
    x, u, y : the point.
    rates : dx/dt there: zero, to round-off, where it is at rest.
    """

    A: FloatArray
    B: FloatArray
    C: FloatArray
    D: FloatArray
    states: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    units: Mapping[str, str]
    x: FloatArray
    u: FloatArray
    y: FloatArray
    rates: FloatArray

    def __iter__(self) -> Iterator[FloatArray]:
        """Yield A, B, C, D."""
        return iter((self.A, self.B, self.C, self.D))

    def __repr__(self) -> str:
        """Return the names of x, u and y."""
        parts = {"x": self.states, "u": self.inputs, "y": self.outputs}
        shown = "; ".join(f"{word} = {', '.join(parts[word])}" for word in parts)
        return f"LinearModel({shown})"


def linearize(
    model: str | Path | Model,
    *,
    at: OperatingPoint | Mapping[str, LaneValue] | None = None,
    inputs: Mapping[str, float] | None = None,
    parameters: Mapping[str, LaneValue] | None = None,
) -> LinearModel:
    """Return the linear model near a point; where a law has a kink there, that of one side.

    >>> from piezo_sym import linearize
    >>> linear = linearize("piezo_stack", inputs={"V_in": 100.0})
    >>> linear.states, linear.outputs
    (('q', 'p', 'Q_C', 'phi_1', 'phi_2', 'S'), ('y_load', 'y_supply', 'y_ambient'))
    >>> linear.A[0, 1]  # dq/dt = p/M
    285.714...

    Parameters
    ----------
    model : the name of a shipped spec, the path of a spec file, or a `Model`.
    at : an `operating_point`; or state -> number, of a bank also one per lane, SI units, the other
        states at their initial values. Left out, the operating point of these inputs.
    inputs : name -> number, SI units; the others are those of `at`, or have their defaults.
    parameters : as for `simulate`; left out, those of `at`.

    Raises
    ------
    UsageError : a name is unknown, or a value is no number.
    RunError : the rates have no derivative there, or `operating_point` finds none.
    """
    model = model if isinstance(model, Model) else load(model)
    module: Any = module_of(model)
    if at is None:
        at = operating_point(module, inputs=inputs, parameters=parameters)
    if isinstance(at, OperatingPoint):
        initial, parameters = at.initial, at.parameters if parameters is None else parameters
        given: Any = known_keys(inputs, at.inputs, f"{WHERE}.inputs")
        inputs = {**at.inputs, **given}
    elif isinstance(at, Mapping):
        initial = at
    else:
        expected = "an OperatingPoint, or state -> value"
        raise UsageError(f"{quote(at)} is no state", f"{WHERE}.at", expected)
    p = read_parameters(module, parameters)
    u = read_constants(module, inputs, f"{WHERE}.inputs")
    return _linear(module, _program(model), p, read_initial(module, p, u, initial), u)


@lru_cache(maxsize=32)
def _program(model: Model) -> Program:
    """Return a program whose Jacobian has the rows of rates, then outputs; by states, then inputs.

    Its `states` are both.
    """
    q = quantities_of(derive(model))
    found = {function.name: function.rows for function in functions_of(q)}
    program, new = program_of(q, ()), Names(q.taken)
    variables = (*program.states, *program.inputs)
    made = (*found["rhs"], *found["outputs"])
    entries, derivatives = jacobian_of(made, variables, q.defined, q.lanes, new, q.temperatures)
    quantities = (*q.defined, *derivatives)
    return sharp_program(
        replace(program, quantities=quantities, jacobian=entries, states=variables)
    )


def _linear(
    module: GeneratedModule, program: Program, p: Any, x: FloatArray, u: FloatArray
) -> LinearModel:
    try:
        matrix = _matrix(module, program, p, x, u)
    except (ArithmeticError, ValueError) as cause:
        what = f"the rates and outputs have no derivative there: {cause}"
        remedy = "give another 'at', or other inputs"
        raise RunError(what, f"model '{module.NAME}'", remedy=remedy) from cause
    parts = module.STATES, module.INPUTS, module.OUTPUTS
    states, inputs, outputs = (row_names(records, p) for records in parts)
    outputs = [f"y_{name}" for name in outputs]
    n = len(states)
    units = {
        name: record.unit
        for records, prefix in zip(parts, ("", "", "y_"), strict=True)
        for record in records
        for name in (f"{prefix}{row}" for row in row_names([record], p))
    }
    return LinearModel(
        *(matrix[:n, :n], matrix[:n, n:], matrix[n:, :n], matrix[n:, n:]),
        *(tuple(states), tuple(inputs), tuple(outputs), units),
        *(x, u, module.outputs(x, u, p), module.rhs(x, u, p)),
    )


def _matrix(
    module: GeneratedModule, program: Program, p: Any, x: FloatArray, u: FloatArray
) -> FloatArray:
    """Return the derivative of rates and outputs by states and inputs, banks spread."""
    values = _Values.at(module, program, p, x, u)
    down = rows((*module.STATES, *module.OUTPUTS), p)
    across = rows((*module.STATES, *module.INPUTS), p)
    fields = (*module.STATES, *module.OUTPUTS)
    out = np.zeros((down[-1].stop, across[-1].stop))
    for entry in program.jacobian:
        pair = fields[entry.row].bank, program.states[entry.col].bank
        out[down[entry.row], across[entry.col]] = _block(entry, pair, values)
    return out


def _block(entry: Entry, banks: tuple[str | None, str | None], values: _Values) -> FloatArray:
    """Return the part of the matrix that an entry stands for."""
    row, col = banks
    value = values.of(entry.value)
    if row and row == col:
        block = np.diag(np.broadcast_to(value, values.counts[row]))
    else:
        block = np.reshape(value, (-1, 1) if row else (1, -1))
    for outer in entry.outer:
        block = block + np.reshape(values.of(outer.left), (-1, 1)) * values.of(outer.right)
    return block


@final
@dataclass(frozen=True)
class _Values:
    """The value of every name at a point, for a bank one per lane, (count,)."""

    lanes: Mapping[str, str]
    counts: Mapping[str, int]
    known: dict[str, Any] = field(default_factory=dict)

    @staticmethod
    def at(
        module: GeneratedModule, program: Program, p: Any, x: FloatArray, u: FloatArray
    ) -> _Values:
        """Compute all quantities of a program."""
        counts = {bank: lanes(p, bank) for bank in module.BANKS}
        found = _Values(program.lane_names(), counts)
        found.known.update({f"{bank}_count": count for bank, count in counts.items()})
        for record in module.PARAMETERS:
            value = getattr(p, record.name)
            found.known[record.name] = (
                np.broadcast_to(value, counts[record.bank]) if record.bank else value
            )
        found.known.update(by_name(module.STATES, p, x) | by_name(module.INPUTS, p, u))
        for quantity in program.quantities:
            found.known[quantity.name] = found.of(quantity.value)
        return found

    def of(self, node: Expr) -> Any:
        """Return the value of an expression, or one per lane, (count,)."""
        if isinstance(node, LaneSum):
            return fsum(self._each(node.arg, self.counts[node.bank]))
        bank = bank_of(node, self.lanes)
        return np.array([*self._each(node, self.counts[bank])]) if bank else self._one(node)

    def _each(self, node: Expr, count: int) -> Iterator[float]:
        return (self._one(node, lane) for lane in range(count))

    def _one(self, node: Expr, lane: int = 0) -> float:
        used = {name: self.known[name] for name in names(node)}
        own = {n: float(v[lane] if np.ndim(v) else v) for n, v in used.items()}
        return evaluate(node, own)
