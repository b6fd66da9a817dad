"""Linear models: the derivatives of rates and outputs at a point, to round-off.

Input: a model, and a point: an operating point, a state, or the inputs of an operating point.
Output: a `LinearModel` with the matrices of

    d/dt dx = A dx + B du        dy = C dx + D du

by the derivatives of the generated Jacobian, extended to inputs and outputs.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from pathlib import Path
from typing import Any, final

import numpy as np

from piezo_sym.analysis.operating_point import OperatingPoint, operating_point, read_constants
from piezo_sym.codegen.differences import sharp_program
from piezo_sym.codegen.functions import functions_of
from piezo_sym.codegen.jacobian import jacobian_of
from piezo_sym.codegen.lower import program_of
from piezo_sym.codegen.numpy.module import numpy_module
from piezo_sym.codegen.program import Names
from piezo_sym.codegen.quantities import quantities_of
from piezo_sym.derivation import derive
from piezo_sym.errors import RunError, UsageError, quote
from piezo_sym.files import temporary_folder
from piezo_sym.module_cache import write_module
from piezo_sym.modules import module_of
from piezo_sym.run.checks import FloatArray, calling, checked_call, known_keys
from piezo_sym.run.guard import stop_rows
from piezo_sym.run.module import GeneratedModule, row_names
from piezo_sym.run.parameters import (
    LaneValue,
    Start,
    at_end,
    read_initial,
    read_parameters,
    start_of,
)
from piezo_sym.spec.load import load
from piezo_sym.spec.model import Model

WHERE = "linearize"
#: Distances from a point, over the least one: a derivative that grows from each to the next by more
#: than GROWTH has no bound there.  The least is of round-off, or LEAST at zero.  What a derivative
#: adds to a rate is round-off below this part of what others add.
NEAR, GROWTH, LEAST, ROUND_OFF = (256.0, 16.0, 1.0), 1.1, 1e-100, 1e-10


@final
@dataclass(frozen=True, eq=False)
class LinearModel:
    """A linear model at a point, d/dt dx = A dx + B du, dy = C dx + D du; SI units.

    ``A, B, C, D = linearize(...)`` unpacks it, and ``scipy.signal.StateSpace(*linearize(...))``
    takes it.

    Attributes
    ----------
    A, B, C, D : shapes (n, n), (n, m), (ports, n), (ports, m); banks spread.
    states, inputs, outputs : the names of x, u and y, lanes spread: phi_1, phi_2; outputs are
        `y_<port>`, as in a Dataset.
    units : of each name.
    x, u, y : the point.
    rates : dx/dt there: zero, to round-off, at a state of rest.
    sticking, yielding : the states of stops, by what the stops do in this model. It holds for
        motions in which they go on doing so: one that yields sticks when the motion turns.
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
    sticking: tuple[str, ...] = ()
    yielding: tuple[str, ...] = ()

    def __iter__(self) -> Iterator[FloatArray]:
        """Yield A, B, C, D."""
        return iter((self.A, self.B, self.C, self.D))

    def __repr__(self) -> str:
        """Return the names of x, u and y, and which stops stick or yield."""
        parts = {"x =": self.states, "u =": self.inputs, "y =": self.outputs}
        stops = {"stops stick:": self.sticking, "stops yield:": self.yielding}
        parts |= {word: names for word, names in stops.items() if names}
        shown = "; ".join(f"{word} {', '.join(parts[word])}" for word in parts)
        return f"LinearModel({shown})"


@partial(checked_call, name="linearize")
@calling("linearize", initial="at")
def linearize(
    model: str | Path | Model,
    *,
    at: "OperatingPoint | Start | None" = None,
    inputs: Mapping[str, float] | None = None,
    parameters: Mapping[str, LaneValue] | None = None,
) -> LinearModel:
    """Return the linear model at a point; at the kink of a law or of a stop, that of one side.

    >>> from piezo_sym import linearize
    >>> linear = linearize("piezo_stack", inputs={"V_in": 100.0})
    >>> linear.states, linear.outputs
    (('q', 'p', 'Q_C', 'phi_1', 'phi_2', 'S'), ('y_load', 'y_supply', 'y_ambient'))
    >>> linear.A[0, 1]  # dq/dt = p/M
    285.714...

    Parameters
    ----------
    model : the name of a shipped spec, the path of a spec file, or a `Model`.
    at : an `operating_point`; or state -> number, of a bank also one per lane, SI units, with the
        other states at their initial values; or a run (Dataset), whose last instant it is, with its
        inputs and parameters. When left out, the operating point of the inputs.
    inputs : name -> number, SI units; those left out are as in `at`, or have their defaults.
    parameters : as for `simulate`; when left out, those of `at`.

    Raises
    ------
    UsageError : a name is unknown, or a value is no number.
    RunError : the rates have no derivative there, or `operating_point` finds none.
    """
    model = model if isinstance(model, Model) else load(model)
    module: Any = module_of(model)
    if at is None:
        at = operating_point(module, inputs=inputs, parameters=parameters)
    initial: Any = at
    if isinstance(at, OperatingPoint):
        initial, parameters = at.initial, at.parameters if parameters is None else parameters
        given: Any = known_keys(inputs, at.inputs, f"{WHERE}.inputs")
        inputs = {**at.inputs, **given}
    elif hasattr(at, "data_vars"):
        _, initial, parameters = start_of(module, None, at, parameters)
        own = [r.name for r in module.INPUTS if r.name not in (inputs or {})]
        inputs = {**at_end(at, own), **(inputs or {})}
    elif not isinstance(at, Mapping):
        expected = "an OperatingPoint, a run, or state -> value"
        raise UsageError(f"{quote(at)} is no state", f"{WHERE}.at", expected)
    p = read_parameters(module, parameters)
    u = read_constants(module, inputs, f"{WHERE}.inputs")
    return _linear(module, _derivatives(model), p, read_initial(module, p, u, initial), u)


@lru_cache(maxsize=32)
def _derivatives(model: Model) -> Any:
    """Return a module whose states are states, inputs and outputs, and so is its Jacobian.

    Only the rows of states (rates) and outputs, and the columns of states and inputs, are not zero.
    """
    q = quantities_of(derive(model))
    rows = {function.name: function.rows for function in functions_of(q)}
    program, new = program_of(q), Names(q.taken)
    n, m = len(program.states), len(program.inputs)
    entries, derivatives = jacobian_of(
        (*rows["rhs"], *rows["outputs"]),
        (*program.states, *program.inputs),
        *(q.defined, q.lanes, new, q.temperatures),
    )
    outputs = (replace(field, name=new(f"y_{field.name}")) for field in program.outputs)
    extended = replace(
        program,
        states=(*program.states, *program.inputs, *outputs),
        inputs=(),
        quantities=(*q.defined, *derivatives),
        jacobian=tuple(replace(e, row=e.row + m * (e.row >= n)) for e in entries),
        taken=frozenset(new.taken),
    )
    folder = temporary_folder() / f"{model.sha256}-linear"
    return write_module(folder, model.name, {".py": numpy_module(sharp_program(extended))})


def _linear(
    module: GeneratedModule, derivatives: Any, p: Any, x: FloatArray, u: FloatArray
) -> LinearModel:
    parts = module.STATES, module.INPUTS, module.OUTPUTS
    states, inputs, outputs = (row_names(records, p) for records in parts)
    outputs = [f"y_{name}" for name in outputs]
    n, m = len(states), len(inputs)
    point = np.concatenate([x, u, np.zeros(len(outputs))])
    with np.errstate(all="ignore"):
        matrix = derivatives.jacobian(point, np.empty(0), p)
        steep = _is_steep(derivatives, p, point, np.abs(matrix))
    if steep or not np.isfinite(matrix).all():
        what = "the rates and outputs have no derivative there"
        remedy = "give another 'at', or other inputs"
        raise RunError(what, f"model '{module.NAME}'", remedy=remedy)
    units = {
        name: record.unit
        for records, prefix in zip(parts, ("", "", "y_"), strict=True)
        for record in records
        for name in (f"{prefix}{row}" for row in row_names([record], p))
    }
    stops = [row for own in stop_rows(module, p, x, u).values() for row in range(n)[own]]
    fixed = {row: not matrix[row].any() for row in stops}
    return LinearModel(
        *(matrix[:n, :n], matrix[:n, n : n + m], matrix[n + m :, :n], matrix[n + m :, n : n + m]),
        *(tuple(states), tuple(inputs), tuple(outputs), units),
        *(x, u, module.outputs(x, u, p), module.rhs(x, u, p)),
        sticking=tuple(states[row] for row in stops if not fixed[row]),
        yielding=tuple(states[row] for row in stops if fixed[row]),
    )


def _is_steep(derivatives: Any, p: Any, point: FloatArray, there: FloatArray) -> bool:
    """Return whether a derivative is unbounded near a point, like that of a root at zero."""
    size = np.abs(point)
    step = np.diag(np.maximum(4 * np.finfo(float).eps * size, LEAST))
    floor = ROUND_OFF * np.max(there * size, axis=1)[:, None, None]
    for side in (1.0, -1.0):
        around = (point[:, None] + side * times * step for times in NEAR)
        far, near, nearest = (np.abs(derivatives.jacobian(x, np.empty(0), p)) for x in around)
        grows = (near > GROWTH * far) & (nearest > GROWTH * near)
        counts = (size == 0)[:, None] | (nearest * size[:, None] > floor)
        if np.any(grows & counts & (nearest > GROWTH * there[..., None])):
            return True
    return False
