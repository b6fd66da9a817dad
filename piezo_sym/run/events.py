"""Events of a run: times at which expressions change sign, to round-off; and when it stops.

Input: expressions in the language of laws over states, inputs, `y_<port>`, `T_<body>` and
parameters, and a function that samples the run at any times.  Output: the times of each event, and
when the run stops.

A sample is a step of its own from the last accepted state, so more samples do not change the run:
it is sampled at the user's times and four times per step, then again where signs change.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import Any, Self, TypeAlias, final

import numpy as np

from piezo_sym.errors import PiezoError, UsageError, nearest, quote
from piezo_sym.expressions.exact_eval import evaluate
from piezo_sym.expressions.parse import parse_condition, parse_law
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import Add, Expr, Neg, names
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.dataset import Evaluation, Trajectory, attributes
from piezo_sym.run.module import row_names
from piezo_sym.run.system import DrivenModule

#: Returns the given times that the run reaches, and the run there.
Sampler: TypeAlias = Callable[[FloatArray], tuple[FloatArray, Trajectory]]
#: Samples to find changes of sign: per step, and the least and greatest number of them.
PER_STEP, LEAST, MOST = 4, 1000, 20_000
#: Samples inside a bracket in one pass, and the most passes.
EVEN, ROUNDS = 63, 16


@final
@dataclass(frozen=True)
class Watched:
    """Events (name -> expression), and the condition that ends a run.

    `stop` is positive where `condition`, its text, holds. `signs` are those of the events at the
    last sample so far, with which the next window of a run goes on.
    """

    event: Mapping[str, Expr]
    stop: Expr | None
    condition: str = ""
    signs: dict[str, float] = field(default_factory=dict)

    def __bool__(self) -> bool:
        """Return whether there is an event or a condition."""
        return bool(self.event) or self.stop is not None


@final
@dataclass(frozen=True)
class Located:
    """The times [s] of each event, and when the run ends early (None: it does not)."""

    times: Mapping[str, FloatArray]
    end: float | None


def read_watched(system: DrivenModule, events: object, stop: object, step: object) -> Watched:
    """Return a user's events and condition; raise `UsageError` for a run with a fixed step."""
    given = {} if events is None else events
    if not isinstance(given, Mapping):
        expected = 'name -> expression, such as {"hit": "q - 1e-3"}'
        raise UsageError(f"{quote(given)} is no mapping", "simulate.events", expected)
    if step is not None and (given or stop is not None):
        what = "with a fixed step, events are not located"
        raise UsageError(what, "simulate.step", "rtol", "leave out step, or events and stop")
    known = _quantity_names(system)
    laws = {}
    for name, text in given.items():
        where = f"simulate.events.{name}"
        if not isinstance(name, str) or not name.isidentifier() or name in {*known, "time"}:
            why = ": the run has a quantity of that name" if name in {*known, "time"} else ""
            what = f"{quote(name)} cannot name an event{why}"
            raise UsageError(what, "simulate.events", "a new name of letters, digits and _")
        laws[name] = _check_names(_event_law(text, where), known, where)
    if stop is None:
        return Watched(laws, None)
    condition: Any = _parsed(parse_condition, stop, "simulate.stop", '"T_body > 350"')
    _check_names(condition, known, "simulate.stop")
    sides = condition.left, condition.right
    more, less = sides if condition.op in {">", ">="} else sides[::-1]
    return Watched(laws, Add((more, Neg(less))), str(stop))


def _event_law(text: object, where: str) -> Expr:
    """Return the law of an event; the error of a comparison names the law to write instead."""
    try:
        law: Expr = _parsed(parse_law, text, where, '"q - 1e-3"')
    except UsageError as error:
        with suppress(PiezoError, TypeError):
            sides = parse_condition(str(text), where)
            error.remedy = f"write {quote(spell(Add((sides.left, Neg(sides.right)))))}"
        raise
    return law


def _parsed(read: Callable[[str, str], Any], text: object, where: str, such: str) -> Any:
    if not isinstance(text, str):
        raise UsageError(f"{quote(text)} is no text", where, f"text such as {such}")
    try:
        return read(text, where)
    except PiezoError as error:
        raise UsageError(error.what, where, error.expected, error.remedy) from error


def _check_names(tree: Any, words: Sequence[str], where: str) -> Any:
    for name in names(tree):
        if name not in words:
            what = f"the run has no {quote(name)}"
            raise UsageError(what, where, remedy=nearest(name, words))
    return tree


def _quantity_names(system: DrivenModule) -> list[str]:
    module, p = system.module, system.parameters
    return [
        *row_names(module.STATES, p),
        *(record.name for record in module.INPUTS),
        *(f"y_{record.name}" for record in module.OUTPUTS),
        *(f"T_{record.name}" for record in module.BODIES),
        *(record.name for record in module.PARAMETERS if not record.bank),
    ]


def _quantity_values(system: DrivenModule, trajectory: Trajectory) -> dict[str, list[float]]:
    module, p = system.module, system.parameters
    x, u = trajectory.states, trajectory.inputs
    fixed = [getattr(p, record.name) for record in module.PARAMETERS if not record.bank]
    values = [*x, *u, *module.outputs(x, u, p), *module.temperatures(x, p), *fixed]
    spread = (np.broadcast_to(value, x.shape[1]).tolist() for value in values)
    return dict(zip(_quantity_names(system), spread, strict=True))


def values_of(system: DrivenModule, tree: Expr, trajectory: Trajectory) -> FloatArray:
    """Return the values (nt,) of an expression at the samples of a run; nan where it has none."""
    rows = _quantity_values(system, trajectory)
    columns = {name: rows[name] for name in names(tree)}
    values = np.full(trajectory.states.shape[1], np.nan)
    for k in range(values.size):
        with suppress(ArithmeticError, ValueError):
            values[k] = evaluate(tree, {name: column[k] for name, column in columns.items()})
    return values


def locate(
    system: DrivenModule, watched: Watched, samples: FloatArray, steps: int, run: Sampler
) -> Located:
    """Return the times of events and of the end of a run that took this many steps."""
    number = min(max(PER_STEP * steps, LEAST), MOST)
    even = np.linspace(system.inputs.start, system.inputs.end, number)
    times, seen = run(np.union1d(samples, even))
    brackets: list[_Bracket] = []
    if watched.stop:
        margin = values_of(system, watched.stop, seen)
        if margin[0] > 0:
            what = f"the condition holds at t = {times[0]:g} s already"
            raise UsageError(what, "simulate.stop", "one that does not hold at the start")
        first = np.flatnonzero(margin > 0)[:1].tolist()
        brackets += [_Bracket("", watched.stop, times[[k - 1, k]]) for k in first]
    for name, tree in watched.event.items():
        signs = _signs(np.append(watched.signs.get(name, 0.0), values_of(system, tree, seen)))
        watched.signs[name] = float(signs[-1])
        changed = np.flatnonzero((signs[1:] != signs[:-1]) & (signs[:-1] != 0)).tolist()
        brackets += [_Bracket(name, tree, times[[max(k - 1, 0), k]]) for k in changed]
    located = [(b.name, float(b.times[1])) for b in _narrow(system, brackets, run)]
    end = next((t for name, t in located if not name), None)
    kept = [(name, t) for name, t in located if end is None or t <= end]
    times_of = {name: np.array([t for n, t in kept if n == name]) for name in watched.event}
    return Located(times_of, end)


def _signs(values: FloatArray) -> FloatArray:
    """Return the sign of each value; zero and nan take the sign of the value before."""
    signs: FloatArray = np.nan_to_num(np.sign(values))
    return signs[np.maximum.accumulate(np.where(signs != 0, np.arange(signs.size), 0))]


@final
@dataclass(frozen=True)
class _Bracket:
    """Two times [s] between which an expression changes its sign."""

    name: str
    tree: Expr
    times: FloatArray

    def inner(self) -> FloatArray:
        """Return the times between the two to sample next."""
        first, last = self.times.tolist()
        times = np.unique(np.linspace(first, last, EVEN + 2))
        return np.asarray(times[(times > first) & (times < last)])

    def narrow(self, times: FloatArray, values: FloatArray) -> Self:
        """Return the bracket between the two of these times where the sign changes."""
        first, last = np.searchsorted(times, self.times)
        times, signs = times[first : last + 1], _signs(values[first : last + 1])
        k = int(np.argmax(signs == signs[-1])) or times.size - 1
        return replace(self, times=times[[k - 1, k]])


def _narrow(system: DrivenModule, brackets: list[_Bracket], run: Sampler) -> list[_Bracket]:
    """Return brackets narrowed to neighbouring floats or round-off, all with the same runs."""
    for _ in range(ROUNDS):
        inner = [bracket.inner() for bracket in brackets]
        if not any(times.size for times in inner):
            break
        times, seen = run(np.unique(np.concatenate([*inner, *(b.times for b in brackets)])))
        values = {tree: values_of(system, tree, seen) for tree in {b.tree for b in brackets}}
        brackets = [b.narrow(times, values[b.tree]) for b in brackets]
    return brackets


def event_variables(
    system: DrivenModule, located: Located, times: FloatArray, seen: Trajectory
) -> Iterator[tuple[str, Any]]:
    """Yield each event's times, a coordinate, and the states, inputs, outputs, temperatures."""
    for name, at in located.times.items():
        yield name, ((name,), at, attributes("s", f"times of event {quote(name)}"))
        run = seen.at(np.searchsorted(times, at))
        for quantity, (dims, values, attrs) in Evaluation.of(system, run).instants():
            yield f"{quantity}_at_{name}", ((name, *dims[1:]), values, attrs)
