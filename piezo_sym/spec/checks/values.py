"""Values of a spec: as many as there are lanes, finite, and inside the domain.

Parameters and defaults of inputs are the exact rationals of their doubles; initial states and
temperatures may be balls.  A condition that these cannot decide is not refused here.
"""

import math
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from fractions import Fraction
from typing import TypeAlias

from piezo_sym.errors import SpecError, quote
from piezo_sym.expressions.exact_eval import TooCloseError, Value, holds, value_of
from piezo_sym.expressions.tree import Call, Expr, names, walk
from piezo_sym.spec.elements.base import state_symbol
from piezo_sym.spec.elements.ports import Body
from piezo_sym.spec.fields import Tables
from piezo_sym.spec.tables import (
    Condition,
    banks,
    condition_text,
    conditions,
    lane_parameters,
    orders,
    starts,
    states,
    temperatures,
    without_default,
)

#: The value of a name, or its values, one per lane of a bank.
Values: TypeAlias = tuple[Value, ...]


def check_values(spec: Tables) -> None:
    """Check lists against the sizes of banks, then knots and the domain, lane by lane."""
    domain = conditions(spec)
    _check_lists(spec, domain)
    lanes: dict[str, Values] = {n: (Fraction(entry.si),) for n, entry in spec.inputs.items()}
    lanes |= {name: tuple(map(Fraction, p.lanes)) for name, p in spec.parameters.items()}
    for order in orders(spec, domain):
        _check_condition(
            order, lanes, "the knots of a table do not increase", remedy="sort the knots"
        )
    lanes |= {symbol: tuple(_starts(spec, symbol, lanes)) for symbol in states(spec)}
    tests = (*domain, *_start_conditions(spec))
    hot = temperatures(spec)
    late = [test for test in tests if not hot.keys().isdisjoint(names(test.tree))]
    for condition in tests:  # a state outside the domain may have no temperature
        if hot.keys().isdisjoint(names(condition.tree)):
            _check_condition(condition, lanes, remedy=_remedy(condition, spec))
    for symbol, body in hot.items():
        element = spec.elements[body]
        ports, field = element.ports(body), next(law.field for law in element.laws(body))
        law = next(port.law for port in ports if isinstance(port, Body))
        values = _in_lane(0, names(law), lanes)
        lanes[symbol] = (_value(law, values, f"elements.{body}.{field}", spec),)
    for condition in late:
        _check_condition(condition, lanes, remedy=_remedy(condition, spec))


def are_all_margins(spec: Tables) -> bool:
    """Return whether the values of a spec have to satisfy the conditions of its domain alone."""
    ordered = any(names(condition.tree) for condition in orders(spec, conditions(spec)))
    return not ordered and not any(_start_conditions(spec))


def _remedy(condition: Condition, spec: Tables) -> str:
    """Return what to do about a condition that the values given do not satisfy."""
    words = names(condition.tree)
    value = next((f"initial.{word}" for word in words if word in spec.initial), "a value")
    advice, more = f"change {value} or the domain", without_default(spec, words)
    name = condition.where.removeprefix("elements.")
    element = spec.elements.get(name)
    if element and element.form.role[:1] == ("store",):
        size, law, _ = element.form.one_of
        if state_symbol(element, name) in words:  # perhaps the whole law
            advice += (
                f"; a law of the {law.replace('_', ' ')} itself is given as {law}, not as {size}"
            )
        elif getattr(element, size) is not None and {*words} <= {*names(element.law(size))}:
            advice = f"check its sign: {size} has to be above 0"
    return advice + f"; {more}" * bool(more)


def _start_conditions(spec: Tables) -> Iterator[Condition]:
    """Yield the conditions that kinds impose on initial states."""
    for name, element in spec.elements.items():
        yield from (
            Condition(f"elements.{name}", test) for test in element.form.starts(element, name)
        )


def _in_lane(lane: int, words: Iterable[str], lanes: Mapping[str, Values]) -> dict[str, Value]:
    """Return the values of names in a lane, counted from 0."""
    return {word: lanes[word][lane if len(lanes[word]) > 1 else 0] for word in words}


def _count(words: Iterable[str], lanes: Mapping[str, Values]) -> int:
    """Return the number of lanes in which names have values; 1 if all lanes are alike."""
    return max((len(lanes[word]) for word in words), default=1)


def _check_lists(spec: Tables, domain: Iterable[Condition]) -> None:
    sizes, owners = banks(spec), lane_parameters(spec, domain)
    for name, parameter in spec.parameters.items():
        if not isinstance(parameter.value, tuple):
            continue
        where, count = f"parameters.{name}.value", len(parameter.value)
        if name not in owners:
            remedy = "give one number, or use the parameter in the laws of one bank only"
            if spec.joined:
                remedy += "; what count joins is alike: give different ones as elements"
            raise SpecError("a list is given", where, "one number", remedy)
        if count != sizes[owners[name]]:
            expected = f"{sizes[owners[name]]}, one for each lane of bank '{owners[name]}'"
            raise SpecError(f"a list of {count} values is given", where, expected)


def _starts(spec: Tables, symbol: str, lanes: Mapping[str, Values]) -> Iterator[Value]:
    """Yield the initial values of a state, one, or one per lane where lanes differ."""
    parts = starts(spec, symbol)
    for n, tree in enumerate(parts):
        words = names(tree)
        for lane in range(_count(words, lanes)) if len(parts) == 1 else (n,):
            yield _value(tree, _in_lane(lane, words, lanes), f"initial.{symbol}", spec)


def _value(tree: Expr, values: Mapping[str, Value], where: str, spec: Tables) -> Value:
    with suppress(ArithmeticError, ValueError):
        value = value_of(tree, values)
        if math.isfinite(float(value)):
            return value
    what = f"has no finite real value{_values_text(values)}"
    more = without_default(spec, values)
    remedy = "check the values of its parameters"
    called = {part.function for part in walk(tree) if isinstance(part, Call)} & {"log", "sqrt"}
    remedy += f", and the sign inside {' and '.join(sorted(called))}" * bool(called)
    remedy += f"; {more}" * bool(more)
    raise SpecError(what, where, remedy=remedy)


def _values_text(values: Mapping[str, Value]) -> str:
    """Return the values of names as the end of a sentence."""
    given = ", ".join(f"{word} = {float(value):.6g}" for word, value in values.items())
    return f": {given}" * bool(given)


def _check_condition(
    condition: Condition,
    lanes: Mapping[str, Values],
    what: str = "the values given are outside the domain",
    *,
    remedy: str,
) -> None:
    words = names(condition.tree)
    count = _count(words, lanes)
    for lane in range(count):
        values = _in_lane(lane, words, lanes)
        try:
            outside = not holds(condition.tree, values)
        except TooCloseError:
            outside = False
        except (ArithmeticError, ValueError):
            outside = True
        if outside:
            at = f" in lane {lane + 1}" if count > 1 else ""
            expected = quote(condition_text(condition.tree)) + at
            raise SpecError(what + _values_text(values), condition.where, expected, remedy)
