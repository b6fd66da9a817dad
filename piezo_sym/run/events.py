"""Events of a run: when an expression changes sign, located to round-off; and where to stop.

Input: expressions in the language of laws over states, inputs, `y_<port>`, `T_<body>` and
parameters, and a function that gives the run at any times.  Output: the times of each event, and
when the run stops.

A sample is a step of its own from the run's last accepted state, so the run may be asked for more
times without changing: first at all samples and four times per step, then where signs change.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import Any, TypeAlias, final

import numpy as np

from piezo_sym.errors import PiezoError, UsageError, nearest, quote
from piezo_sym.expressions.exact_eval import evaluate
from piezo_sym.expressions.parse import parse_condition, parse_law
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import Add, Expr, Neg, names
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.dataset import Known, Trajectory, described
from piezo_sym.run.module import row_names
from piezo_sym.run.system import DrivenModule

#: Gives the samples at some times, as far as the run goes.
Sampler: TypeAlias = Callable[[FloatArray], tuple[FloatArray, Trajectory]]
#: Looked at: so many times per step, so many at least and at most.
PER_STEP, LEAST, MOST = 4, 1000, 20_000
#: Even times in a bracket that one pass looks at, and how many passes there are at most.
EVEN, ROUNDS = 63, 16


@final
@dataclass(frozen=True)
class Watched:
    """What is looked for: events (name -> expression), and the condition on which a run ends.

    `stop` is positive where that, in words `condition`, holds. `signs` are those of events at the
    end of what was looked at so far, from which a run in windows goes on.
    """

    event: Mapping[str, Expr]
    stop: Expr | None
    condition: str = ""
    signs: dict[str, float] = field(default_factory=dict)

    def __bool__(self) -> bool:
        """Return whether there is anything to look for."""
        return bool(self.event) or self.stop is not None


@final
@dataclass(frozen=True)
class Located:
    """The times [s] of each event, and when the run ends early, if it does."""

    times: Mapping[str, FloatArray]
    end: float | None


def read_watched(system: DrivenModule, events: object, stop: object, step: object) -> Watched:
    """Return what a user wants to be looked for; not in a run with a fixed step."""
    given = {} if events is None else events
    if not isinstance(given, Mapping):
        expected = 'name -> expression, such as {"hit": "q - 1e-3"}'
        raise UsageError(f"{quote(given)} is no mapping", "simulate.events", expected)
    if step is not None and (given or stop is not None):
        what = "with a fixed step, events are not located"
        raise UsageError(what, "simulate.step", "rtol", "leave out step, or events and stop")
    known = _words(system)
    found = {}
    for name, text in given.items():
        where = f"simulate.events.{name}"
        if not isinstance(name, str) or not name.isidentifier() or name in {*known, "time"}:
            why = ": the run has a quantity of that name" if name in {*known, "time"} else ""
            what = f"{quote(name)} cannot name an event{why}"
            raise UsageError(what, "simulate.events", "a new name of letters, digits and _")
        found[name] = _known(_event(text, where), known, where)
    if stop is None:
        return Watched(found, None)
    condition: Any = _read(parse_condition, stop, "simulate.stop", '"T_body > 350"')
    _known(condition, known, "simulate.stop")
    sides = condition.left, condition.right
    more, less = sides if condition.op in {">", ">="} else sides[::-1]
    return Watched(found, Add((more, Neg(less))), str(stop))


def _event(text: object, where: str) -> Expr:
    """Return the law of an event; of a comparison, say which law changes its sign there."""
    try:
        law: Expr = _read(parse_law, text, where, '"q - 1e-3"')
    except UsageError as error:
        with suppress(PiezoError, TypeError):
            sides = parse_condition(str(text), where)
            error.remedy = f"write {quote(spell(Add((sides.left, Neg(sides.right)))))}"
        raise
    return law


def _read(read: Callable[[str, str], Any], text: object, where: str, such: str) -> Any:
    if not isinstance(text, str):
        raise UsageError(f"{quote(text)} is no text", where, f"text such as {such}")
    try:
        return read(text, where)
    except PiezoError as error:
        raise UsageError(error.what, where, error.expected, error.remedy) from error


def _known(tree: Any, words: Sequence[str], where: str) -> Any:
    for name in names(tree):
        if name not in words:
            what = f"the run has no {quote(name)}"
            raise UsageError(what, where, remedy=nearest(name, words))
    return tree


def _words(system: DrivenModule) -> list[str]:
    module, p = system.module, system.parameters
    return [
        *row_names(module.STATES, p),
        *(record.name for record in module.INPUTS),
        *(f"y_{record.name}" for record in module.OUTPUTS),
        *(f"T_{record.name}" for record in module.BODIES),
        *(record.name for record in module.PARAMETERS if not record.bank),
    ]


def _rows(system: DrivenModule, trajectory: Trajectory) -> dict[str, list[float]]:
    module, p = system.module, system.parameters
    x, u = trajectory.states, trajectory.inputs
    fixed = [getattr(p, record.name) for record in module.PARAMETERS if not record.bank]
    values = [*x, *u, *module.outputs(x, u, p), *module.temperatures(x, p), *fixed]
    spread = (np.broadcast_to(value, x.shape[1]).tolist() for value in values)
    return dict(zip(_words(system), spread, strict=True))


def values_of(system: DrivenModule, tree: Expr, trajectory: Trajectory) -> FloatArray:
    """Return an expression at every sample of a run, (nt,); nan where it has no value."""
    rows = _rows(system, trajectory)
    columns = {name: rows[name] for name in names(tree)}
    found = np.full(trajectory.states.shape[1], np.nan)
    for k in range(found.size):
        with suppress(ArithmeticError, ValueError):
            found[k] = evaluate(tree, {name: column[k] for name, column in columns.items()})
    return found


def look(
    system: DrivenModule, watched: Watched, samples: FloatArray, steps: int, run: Sampler
) -> Located:
    """Return where events are, and where the run ends, from a run of so many steps."""
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
    found = [(b.name, float(b.times[1])) for b in _narrowed(system, brackets, run)]
    end = next((t for name, t in found if not name), None)
    kept = [(name, t) for name, t in found if end is None or t <= end]
    named = {name: np.array([t for n, t in kept if n == name]) for name in watched.event}
    return Located(named, end)


def _signs(values: FloatArray) -> FloatArray:
    """Return the sign of each value; what is zero or nan has the one before it."""
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
        """Return the times between the two that are looked at next."""
        first, last = self.times.tolist()
        times = np.unique(np.linspace(first, last, EVEN + 2))
        return np.asarray(times[(times > first) & (times < last)])

    def narrowed(self, times: FloatArray, values: FloatArray) -> _Bracket:
        """Return the bracket between two of these times."""
        first, last = np.searchsorted(times, self.times)
        times, signs = times[first : last + 1], _signs(values[first : last + 1])
        k = int(np.argmax(signs == signs[-1])) or times.size - 1
        return replace(self, times=times[[k - 1, k]])


def _narrowed(system: DrivenModule, brackets: list[_Bracket], run: Sampler) -> list[_Bracket]:
    """Return brackets as narrow as two neighbouring numbers, where round-off lets them be.

    All are narrowed together, by a run each time.
    """
    for _ in range(ROUNDS):
        inner = [bracket.inner() for bracket in brackets]
        if not any(times.size for times in inner):
            break
        asked = np.unique(np.concatenate([*inner, *(b.times for b in brackets)]))
        times, seen = run(asked)
        trees = dict.fromkeys(b.tree for b in brackets)
        values = {tree: values_of(system, tree, seen) for tree in trees}
        brackets = [b.narrowed(times, values[b.tree]) for b in brackets]
    return brackets


def event_variables(
    system: DrivenModule, located: Located, times: FloatArray, seen: Trajectory
) -> Iterator[tuple[str, Any]]:
    """Yield for each event its times, a coordinate, and states, inputs, outputs, temperatures."""
    for name, at in located.times.items():
        yield name, ((name,), at, described("s", f"times of event {quote(name)}"))
        then = seen.at(np.searchsorted(times, at))
        for quantity, (dims, values, attrs) in Known.of(system, then).instants():
            yield f"{quantity}_at_{name}", ((name, *dims[1:]), values, attrs)
