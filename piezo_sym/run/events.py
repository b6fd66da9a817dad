"""Events of a run: times at which expressions change sign, to round-off; and when it stops.

Input: expressions in the language of laws over states, inputs, `y_<port>`, `T_<body>`,
`<element>.<quantity>` and parameters, and a function that samples the run at any times.  Output:
the times of each event, and when the run stops.

A sample is a step of its own from the last accepted state, so more samples do not change the run:
it is sampled at the user's times and four times per step, then again where signs change.
"""

import re
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import Any, Self, TypeAlias, final

import numpy as np

from piezo_sym.errors import PiezoError, UsageError, nearest, quote
from piezo_sym.expressions.exact_eval import evaluate
from piezo_sym.expressions.incomplete import CONSTANTS, OR, conditions_of
from piezo_sym.expressions.parse import parse_condition, parse_law
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import ZERO, Add, Call, Expr, Neg, names, rename
from piezo_sym.run.checks import FloatArray
from piezo_sym.run.dataset import Evaluation, Trajectory, attributes, element_remedy
from piezo_sym.run.module import row_names, rows
from piezo_sym.run.system import DrivenModule

#: Returns the given times that the run reaches, and the run there.
Sampler: TypeAlias = Callable[[FloatArray], tuple[FloatArray, Trajectory]]
#: Samples to find changes of sign: per step, and the least and greatest number of them.
PER_STEP, LEAST, MOST = 4, 1000, 20_000
#: How the description of the times of an event begins.
EVENT = "times of event"
KNOWN = "a state, input, y_<port>, T_<body> or parameter"
#: A quantity of an element, as `spring.effort`: no name of the language of laws.
QUANTITY = re.compile(r"\b([A-Za-z_]\w*)\.([A-Za-z_]\w*)")
#: A number with a unit, which the language does not have either.
WITH_UNIT = re.compile(r"(?<![\w.])(\d+\.?\d*(?:[eE][-+]?\d+)?) ?([^\W\d_]+(?:/[^\W\d_]+)*)")
#: Samples inside a bracket in one pass: around the zero of the chord, at these fractions of the
#: bracket to either side; or evenly, where that did not narrow it by LITTLE. The most passes.
AROUND = 2.0 ** np.array([-4.0, -12.0, -24.0, -40.0])
EVEN, LITTLE, ROUNDS = 63, 1 / 16, 24


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
        law = _parsed(parse_law, text, where, '"q - 1e-3"', "{}")
        laws[name] = _check_names(law, known, where)
    if stop is None:
        return Watched(laws, None)
    where = "simulate.stop"
    margin = _parsed(_margin, stop, where, '"T_body > 350"', "{} > 0")
    return Watched(laws, _check_names(margin, known, where), str(stop))


def _margin(text: str, where: str) -> Expr:
    """Return what is positive where a comparison holds."""
    condition = parse_condition(text, where)
    sides = condition.left, condition.right
    more, less = sides if condition.op in {">", ">="} else sides[::-1]
    return more if less == ZERO else Add((more, Neg(less)))


def _margin_of_several(text: str, where: str) -> Expr:
    """Return what is positive where comparisons hold that are joined by 'and' or 'or'."""
    for function, parts in (("max", OR.split(text, maxsplit=1)), ("min", conditions_of(text))):
        if len(parts) > 1:
            return Call(function, tuple(_margin_of_several(part, where) for part in parts))
    return _margin(text, where)


def _parsed(
    read: Callable[[str, str], Expr], text: object, where: str, such: str, form: str
) -> Expr:
    """Return the parsed text; if only a condition may stand there, the remedy has it in `form`."""
    if not isinstance(text, str):
        raise UsageError(f"{quote(text)} is no text", where, f"text such as {such}")
    plain = QUANTITY.sub(r"_\1_\2", text)  # no spec has such names
    spelled = {
        f"_{element}_{word}": f"{element}.{word}" for element, word in QUANTITY.findall(text)
    }
    try:
        return rename(read(plain, where), spelled)
    except PiezoError as error:
        said = [error.what, error.expected, error.remedy]
        with suppress(PiezoError):
            said[2] = _in_si(text, where) or said[2]
        with suppress(PiezoError):
            said[2] = f"write '{form.format(spell(_margin_of_several(plain, where)))}'"
        for name, own in spelled.items():
            said = [part.replace(name, own) for part in said]
        what, expected, remedy = said
        raise UsageError(what, where, expected, remedy) from error


def _in_si(text: str, where: str) -> str:
    """Return how to write the first number with a unit, as in q > 1um, or ''."""
    found = WITH_UNIT.search(text)
    if found is None:
        return ""
    from piezo_sym.expressions.units import parse_unit, to_si

    value = to_si(float(found[1]), parse_unit(found[2], where))
    return f"write numbers in SI: {value:g} for {found[0]}"


def _check_names(tree: Expr, words: Sequence[str], where: str) -> Expr:
    for name in names(tree):
        if name not in words:
            dotted = tuple(word for word in words if "." in word)
            own = (word for word in words if word not in dotted)
            remedy = element_remedy(name, dotted) if "." in name else ""
            remedy = remedy or CONSTANTS.get(name) or nearest(name, own)
            what = f"events and stop know no {quote(name)}"
            expected = f"{KNOWN}, or a quantity of an element, such as '{dotted[0]}'"
            raise UsageError(what, where, expected, remedy)
    return tree


def _quantity_names(system: DrivenModule) -> list[str]:
    module, p = system.module, system.parameters
    return [
        *row_names(module.STATES, p),
        *(record.name for record in module.INPUTS),
        *(f"y_{record.name}" for record in module.OUTPUTS),
        *(f"T_{record.name}" for record in module.BODIES),
        *row_names(module.PARAMETERS, p),
        *row_names(module.ELEMENTS, p),
    ]


def _quantity_values(
    system: DrivenModule, wanted: Collection[str], trajectory: Trajectory
) -> dict[str, list[float]]:
    module, p = system.module, system.parameters
    x, u = trajectory.states, trajectory.inputs
    given = zip(module.PARAMETERS, rows(module.PARAMETERS, p), strict=True)
    fixed = [
        value
        for record, row in given
        for value in np.broadcast_to(getattr(p, record.name), row.stop - row.start)
    ]
    values = [*x, *u, *module.outputs(x, u, p), *module.temperatures(x, p), *fixed]
    values += [*module.elements(x, u, p)] if any("." in name for name in wanted) else []
    named = zip(_quantity_names(system), values, strict=False)
    return {n: np.broadcast_to(row, x.shape[1]).tolist() for n, row in named if n in wanted}


def values_of(system: DrivenModule, tree: Expr, trajectory: Trajectory) -> FloatArray:
    """Return the values (nt,) of an expression at the samples of a run; nan where it has none."""
    columns = _quantity_values(system, [*names(tree)], trajectory)
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
        pairs = (slice(k - 1, k + 1) for k in first)
        brackets += [_Bracket("", watched.stop, times[pair], margin[pair]) for pair in pairs]
    for name, tree in watched.event.items():
        values = values_of(system, tree, seen)
        signs = _signs(np.append(watched.signs.get(name, 0.0), values))
        watched.signs[name] = float(signs[-1])
        changed = np.flatnonzero((signs[1:] != signs[:-1]) & (signs[:-1] != 0))
        ends = np.stack([np.maximum(changed - 1, 0), changed], axis=1)
        brackets += [_Bracket(name, tree, times[pair], values[pair]) for pair in ends]
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
    """Two times [s] between which an expression changes its sign, and its values there."""

    name: str
    tree: Expr
    times: FloatArray
    values: FloatArray
    evenly: bool = False

    def inner(self) -> FloatArray:
        """Return the times between the two to sample next."""
        first, last = self.times.tolist()
        low, high = self.values.tolist()
        ways = [np.linspace(first, last, EVEN + 2)]
        if not self.evenly and low * high < 0:
            zero = first + (last - first) * (low / (low - high))
            apart = (last - first) * AROUND
            ways.insert(0, np.concatenate([[zero], zero - apart, zero + apart]))
        inside = (np.unique(times[(times > first) & (times < last)]) for times in ways)
        return next((times for times in inside if times.size), np.empty(0))

    def narrow(self, times: FloatArray, values: FloatArray) -> Self:
        """Return the bracket between the two of these times where the sign changes."""
        first, last = np.searchsorted(times, self.times)
        times, values = times[first : last + 1], values[first : last + 1]
        signs = _signs(values)
        k = int(np.argmax(signs == signs[-1])) or times.size - 1
        evenly = times[k] - times[k - 1] > LITTLE * (times[-1] - times[0])
        pair = slice(k - 1, k + 1)
        return replace(self, times=times[pair], values=values[pair], evenly=bool(evenly))


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
        yield name, ((name,), at, attributes("s", f"{EVENT} {quote(name)}"))
        run = seen.at(np.searchsorted(times, at))
        for quantity, (dims, values, attrs) in Evaluation.of(system, run).instants():
            yield f"{quantity}_at_{name}", ((name, *dims[1:]), values, attrs)
