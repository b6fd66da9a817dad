"""Operating points: states of rest under constant inputs, with bodies free or held.

Input: a generated module, constant inputs, the temperatures of the bodies that are held.  Output:
an `OperatingPoint`, or a `RunError` that says why there is none.

    rhs(x, u) = 0       in all rows but the entropies of held bodies

Steps of the implicit Euler method, each longer than the last, follow the motion from the initial
state towards rest; Newton's method ends the search.  Linear functions of the state that the motion
conserves, such as the difference in length of parallel springs, keep their initial values.  Where
other states of rest are near, as stops slip or currents circulate in dead zones, a run decides.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from math import isnan
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from piezo_sym.analysis.rest import ROUND_OFF, RestSearch
from piezo_sym.analysis.settling import Held, Rest, followed
from piezo_sym.errors import RunError, UsageError, listing, quote
from piezo_sym.run.checks import FloatArray, calling, known_keys, number
from piezo_sym.run.guard import check_start, stop_rows
from piezo_sym.run.inputs import read_inputs
from piezo_sym.run.module import GeneratedModule, by_name, checked, names_elsewhere, row_name
from piezo_sym.run.parameters import LaneValue, Start, read_initial, read_parameters, start_of
from piezo_sym.run.system import DrivenModule

WHERE = "operating_point"
#: The step along directions to other states of rest; the least relative change of a temperature per
#: unit step that is not round-off. The size of an entropy is what changes a temperature by 1e-6.
STEP, SAME = 1e-2, 1e-9
MOST_SHOWN = 8  # states, or lanes of one


@final
@dataclass(frozen=True, eq=False)
class OperatingPoint:
    """A state of rest; SI units.

    Attributes
    ----------
    inputs : name -> value.
    initial : the state by name, of a bank one value per lane, as for `simulate(initial=...)`.
    x, u : state (n,), banks spread, and inputs (m,).
    parameters : those that were given, as for `simulate`.
    outputs : `y_<port>` -> value.
    temperatures : body -> temperature [K].
    holding : held body -> heat [W] to be supplied to keep its temperature.
    eigenvalues : of the Jacobian of all states that are not held [1/s].
    stable : whether none of them has a positive real part, beyond round-off: of the branch on which
        stops stick or yield as they do at x.
    undetermined : rows of x that differ between states of rest.
    after : where rest depends on the way there, as stops (Maxwell-slip, play) and slipping stores
        have memory, how long [s] the run took that decided between states of rest; 0 if x is the
        only one, or the initial state; nan if no run decided, and x is near the initial state.
    """

    inputs: Mapping[str, float]
    initial: Mapping[str, LaneValue]
    x: FloatArray
    u: FloatArray
    parameters: Mapping[str, LaneValue]
    outputs: Mapping[str, float]
    temperatures: Mapping[str, float]
    holding: Mapping[str, float]
    eigenvalues: NDArray[np.complex128]
    stable: bool
    undetermined: tuple[str, ...]
    after: float
    _shown: tuple[Mapping[str, LaneValue], Mapping[str, float]]  # initial, outputs; round-off is 0

    def __repr__(self) -> str:
        """Return states, outputs, temperatures, stability, which rest it is, and what is open."""
        initial, outputs = self._shown
        states = [f"{name} = {_digits(value)}" for name, value in initial.items()]
        shown = {**outputs, **{f"T_{body}": T for body, T in self.temperatures.items()}}
        values = ", ".join(f"{name} = {value:.6g}" for name, value in shown.items())
        values = f"{listing(states, MOST_SHOWN)}; {values}"
        free = f"; history decides: {listing(self.undetermined, MOST_SHOWN)}"
        free *= bool(self.undetermined)
        way = f"where a run from the initial state rests, settled after {self.after:.3g} s"
        way = "as no run of 'initial' decides, a near one" if isnan(self.after) else way
        which = f", one rest of many: {way}" if self.after else ""
        return f"OperatingPoint({values}, {'stable' if self.stable else 'unstable'}{which}{free})"


def _digits(value: LaneValue) -> str:
    """Return a number with a few digits, or those of the first lanes."""
    lanes = listing((f"{x:.6g}" for x in np.ravel(value)), MOST_SHOWN)
    return f"[{lanes}]" if np.ndim(value) else lanes


@calling("operating_point")
def operating_point(
    module: GeneratedModule,
    *,
    inputs: Mapping[str, float] | None = None,
    temperatures: Mapping[str, float] | None = None,
    parameters: Mapping[str, LaneValue] | None = None,
    initial: "Start | None" = None,
) -> OperatingPoint:
    """Return the state of rest under constant inputs that a run from the initial state approaches.

    >>> from piezo_sym import operating_point
    >>> operating_point("piezo_stack", inputs={"V_in": 100.0}).initial["q"]
    0.002013506...

    Parameters
    ----------
    model : the name of a shipped spec, the path of a spec file, or a `Model`; here, of
        `piezo_sym.analysis`, a generated module.
    inputs : name -> number, SI units; the others have their defaults.
    temperatures : body -> temperature [K] at which it is held; the other bodies are free.
    parameters, initial : as for `simulate`; the search begins at `initial`. Of a run (Dataset) they
        are its parameters and its end, but not its inputs.

    Notes
    -----
    With stops or other hysteresis there are many states of rest, and history decides between them.
    Returned is where a run from `initial` rests, the inputs being constant from its start, so with
    what its overshoot makes slip. For another history, such as a slow ramp, simulate it and give
    the run as `initial`, whose end it is. Runs hold no body: with `temperatures` the search alone
    decides, whose damped motion slips less.

    Raises
    ------
    UsageError : a name is unknown, or a value is no number.
    RunError : there is no state of rest (the error names a state that keeps moving), none is found
        in the domain, or the temperature of a free body is undetermined because nothing exchanges
        heat with the surroundings.
    """
    _, initial, parameters = start_of(checked(module), None, initial, parameters)
    p = read_parameters(module, parameters)
    u = read_constants(module, inputs)
    start = read_initial(module, p, u, initial)
    system = DrivenModule(module, p, read_inputs(module, by_name(module.INPUTS, p, u), 1.0))
    held = Held.of(system, start, temperatures, f"{WHERE}.temperatures")
    free = np.setdiff1d(np.arange(start.size), held.entropies)
    check_start(system, start)
    stops = stop_rows(module, p, start, u)
    search = RestSearch(system, u, free, free, np.eye(start.size)[:, free], stops)
    rest = held.rest(search, start)
    _refuse_open_bodies(rest, held)
    return _described(followed(rest, search, start), parameters or {}, held)


def read_constants(
    module: GeneratedModule, given: Mapping[str, float] | None, where: str = f"{WHERE}.inputs"
) -> FloatArray:
    """Return constant inputs u (m,): those given, else the defaults."""
    names = [record.name for record in module.INPUTS]
    values = known_keys(given, names, where, names_elsewhere(module, "inputs"))
    default = dict(zip(names, module.INPUT_DEFAULTS, strict=True))
    for name, value in values.items():
        if callable(value):
            what, remedy = f"{quote(value)} varies in time", "for a period: periodic_steady_state()"
            raise UsageError(what, f"{where}.{name}", "a constant", remedy)
    return np.array([number(values.get(name, default[name]), f"{where}.{name}") for name in names])


def _refuse_open_bodies(rest: Rest, held: Held) -> None:
    """Raise `RunError` if the temperature of a body that is free differs between states of rest."""
    module, p, x = rest.search.module, rest.search.system.parameters, rest.x[:, None]
    ahead, behind = (
        np.asarray(module.temperatures(x + step * rest.directions, p)) for step in (STEP, -STEP)
    )
    change = np.abs(ahead - behind) / (STEP * (ahead + behind))
    for n, body in enumerate(module.BODIES):
        if np.any(change[n] > SAME) and n not in held.bodies:
            what = f"rest leaves the temperature of '{body.name}' open: it depends on the way there"
            call = f"operating_point(..., temperatures={{'{body.name}': ...}})"
            remedy = f"hold it: {call}, for linearize as 'at'; or simulate() until it rests"
            raise RunError(what, f"model '{module.NAME}'", remedy=remedy)


def _described(rest: Rest, parameters: Mapping[str, LaneValue], held: Held) -> OperatingPoint:
    search, x, open_ = rest.search, rest.x, rest.directions.any(axis=1)
    module, p, u = search.module, search.system.parameters, search.u
    temperatures = by_name(module.BODIES, p, module.temperatures(x, p))
    rates = module.rhs(x, u, p)
    names = [module.BODIES[body].name for body in held.bodies]
    given = zip(names, held.entropies, strict=True)
    holding = {name: -temperatures[name] * float(rates[row]) for name, row in given}
    jacobian = held.jacobian(search, x)
    eigenvalues = np.linalg.eigvals(jacobian[np.ix_(search.free, search.free)])
    margin = ROUND_OFF * float(np.max(np.abs(eigenvalues), initial=0.0))
    y = np.asarray(module.outputs(x, u, p))
    initial, outputs = _named(module, p, x, y)
    return OperatingPoint(
        inputs=by_name(module.INPUTS, p, u),
        initial=initial,
        x=x,
        u=u,
        parameters=parameters,
        outputs=outputs,
        temperatures=temperatures,
        holding=holding,
        eigenvalues=eigenvalues.astype(complex),
        stable=bool(np.max(eigenvalues.real, initial=0.0) <= margin),
        undetermined=tuple(
            row_name(module.STATES, p, row) for row in np.flatnonzero(open_).tolist()
        ),
        after=rest.after,
        _shown=_named(module, p, *_without_round_off(rest, y, rest.scales(jacobian, eigenvalues))),
    )


def _named(
    module: GeneratedModule, p: Any, x: FloatArray, y: FloatArray
) -> tuple[dict[str, LaneValue], dict[str, float]]:
    """Return states and outputs by name."""
    outputs = {f"y_{port}": value for port, value in by_name(module.OUTPUTS, p, y).items()}
    return by_name(module.STATES, p, x), outputs


def _without_round_off(
    rest: Rest, y: FloatArray, scales: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the state (n,) and the outputs y (ports,), with 0 for round-off of the scales (n,)."""
    search, x, noise = rest.search, rest.x, ROUND_OFF * scales
    moved = search.module.outputs(x[:, None] + np.diag(noise), search.u, search.system.parameters)
    least = np.abs(moved - y[:, None]).sum(axis=1)
    return np.where(np.abs(x) > noise, x, 0.0), np.where(np.abs(y) > least, y, 0.0)
