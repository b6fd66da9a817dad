"""Values of a spec: lanes of the right number, starts that exist, all inside the domain."""

from collections.abc import Mapping

from piezo_sym.errors import SpecError, quote
from piezo_sym.spec.elements.base import state_symbol
from piezo_sym.spec.expressions import evaluate, holds, names
from piezo_sym.spec.parse import parse_law
from piezo_sym.spec.tables import (
    Condition,
    Tables,
    banks,
    condition_text,
    conditions,
    lane_parameters,
    states,
    temperatures,
)


def check_values(spec: Tables) -> None:
    """Check lists against banks, then every condition of the domain, lane by lane."""
    _check_lists(spec)
    fixed = {name: entry.si for name, entry in spec.inputs.items()}
    fixed |= {name: p.lanes[0] for name, p in spec.parameters.items() if len(p.lanes) == 1}
    lists = {name: p.lanes for name, p in spec.parameters.items() if len(p.lanes) > 1}
    starts = {s: _starts(spec, s, fixed, lists) for s in states(spec)}
    lists |= {s: values for s, values in starts.items() if len(values) > 1}
    fixed |= {s: values[0] for s, values in starts.items() if len(values) == 1}
    fixed |= _temperatures(spec, fixed)
    for condition in conditions(spec):
        _check_condition(condition, fixed, lists)


def _check_lists(spec: Tables) -> None:
    sizes, owners = banks(spec), lane_parameters(spec)
    for name, parameter in spec.parameters.items():
        if not isinstance(parameter.value, tuple):
            continue
        where, count = f"parameters.{name}.value", len(parameter.value)
        if name not in owners:
            remedy = "give one number, or use the parameter in the laws of one bank only"
            raise SpecError("a list is given", where, "one number", remedy)
        if count != sizes[owners[name]]:
            expected = f"{sizes[owners[name]]}, one for each lane of bank '{owners[name]}'"
            raise SpecError(f"a list of {count} values is given", where, expected)


def _starts(
    spec: Tables, symbol: str, fixed: Mapping[str, float], lists: Mapping[str, tuple[float, ...]]
) -> tuple[float, ...]:
    """Return the initial values of a state, one, or one a lane where lanes differ."""
    start = spec.initial.get(symbol, 0.0)
    if isinstance(start, tuple):
        return tuple(_start(part, n, symbol, fixed, lists) for n, part in enumerate(start))
    words = names(parse_law(start, f"initial.{symbol}")) if isinstance(start, str) else ()
    lanes = max((len(lists[word]) for word in words if word in lists), default=1)
    return tuple(_start(start, n, symbol, fixed, lists) for n in range(lanes))


def _start(
    start: str | float,
    lane: int,
    symbol: str,
    fixed: Mapping[str, float],
    lists: Mapping[str, tuple[float, ...]],
) -> float:
    """Return the initial value of a state in one lane."""
    if not isinstance(start, str):
        return start
    tree = parse_law(start, f"initial.{symbol}")
    here = {word: lists[word][lane] for word in names(tree) if word in lists}
    return _value(tree, {**fixed, **here}, f"initial.{symbol}")


def _value(tree: object, values: Mapping[str, float], where: str) -> float:
    try:
        return evaluate(tree, values)  # type: ignore[arg-type]
    except (ArithmeticError, ValueError):
        remedy = "check the values of its parameters"
        raise SpecError("has no finite real value", where, remedy=remedy) from None


def _temperatures(spec: Tables, values: Mapping[str, float]) -> dict[str, float]:
    found = {}
    for symbol, body in temperatures(spec).items():
        element = spec.elements[body]
        here = {**values, element.letter: values[state_symbol(element, body)]}
        where = f"elements.{body}.temperature"
        found[symbol] = _value(element.law("temperature"), here, where)
    return found


def _check_condition(
    condition: Condition, fixed: Mapping[str, float], lists: Mapping[str, tuple[float, ...]]
) -> None:
    words = names(condition.tree)
    lanes = max((len(lists[word]) for word in words if word in lists), default=1)
    for lane in range(lanes):
        values = {**fixed, **{word: lists[word][lane] for word in words if word in lists}}
        try:
            good = holds(condition.tree, values)
        except (ArithmeticError, ValueError):
            good = False
        if not good:
            given = ", ".join(f"{word} = {values[word]:.6g}" for word in words)
            what = f"the values given are outside the domain: {given}"
            at = f" in lane {lane + 1}" if lanes > 1 else ""
            expected = quote(condition_text(condition.tree)) + at
            raise SpecError(what, condition.where, expected, "change a value or the domain")
