"""Units of a spec: texts to exact factors and dimensions, and the walk that compares them.

Input: texts such as ``N*s/m``, and trees with the dimension of every symbol.  Output: `Unit`, and
the faults that a tree has.  pint knows the units; the grammar is the checker's own.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from fractions import Fraction
from functools import cache
from typing import Any, NamedTuple

from .laws import InputError, Node

TERM = re.compile(r"([A-Za-z]+|1)(?:(?:\*\*|\^)(-?[1-9]))?")
_WORDS = "mass length time current temperature substance luminosity"
BASES = tuple(f"[{word}]" for word in _WORDS.split())
Dimension = tuple[Fraction, ...]
NONE: Dimension = (Fraction(0),) * len(BASES)
PURE = ("exp", "log", "sin", "cos", "tanh")
EQUAL = ("+", "min", "max", "deadzone", "saturate", "cmp")


class Unit(NamedTuple):
    """A unit: a value in it times `factor` is the value in SI."""

    factor: Fraction
    dimension: Dimension


@cache
def _registry() -> Any:
    import pint

    return pint.UnitRegistry(non_int_type=Fraction)


@cache
def unit(text: str) -> Unit:
    """Return the unit that a text names; raises `InputError` if it names none."""
    fault = InputError(f"{text[:60]!r} is no unit")
    factor, dimension, place, sign = Fraction(1), NONE, 0, 1
    while len(text) <= 60 and (term := TERM.match(text, place)):
        power = sign * int(term[2] or 1)
        named = _named(term[1])
        factor *= named.factor**power
        dimension = _times(dimension, named.dimension, power)
        place = term.end()
        if place == len(text):
            return Unit(factor, dimension)
        if text[place] not in "*/":
            break
        sign, place = (-1 if text[place] == "/" else 1), place + 1
    raise fault


@cache
def _named(name: str) -> Unit:
    if name == "1":
        return Unit(Fraction(1), NONE)
    import pint

    try:
        factor, base = _registry().get_base_units(name)
        origin = _registry().Quantity(Fraction(0), name).to_base_units().magnitude
        powers = dict(base.dimensionality)
        dimension = tuple(Fraction(powers.pop(word, 0)) for word in BASES)
    except (pint.PintError, TypeError, AttributeError, ValueError):
        raise InputError(f"{name!r} is no unit") from None
    if origin or powers:
        raise InputError(f"{name!r} is no plain unit")
    return Unit(Fraction(factor), dimension)


def dimension_of(text: str) -> Dimension:
    """Return the dimension of a unit."""
    return unit(text).dimension


def _times(left: Dimension, right: Dimension, power: Fraction | int = 1) -> Dimension:
    return tuple(a + power * b for a, b in zip(left, right, strict=True))


class _Fault(Exception):
    """Two parts of a tree have different units."""


def check(
    tree: Node, units: Mapping[Any, Dimension], needed: Dimension | None, where: str
) -> Iterator[str]:
    """Yield the first fault of a tree's units, if there is one."""
    try:
        found = _dimension(tree, units)
    except _Fault as fault:
        yield f"{where}: {fault}"
        return
    if needed is not None and found not in (None, needed):
        yield f"{where} has another unit than its row"


def _dimension(node: Node, units: Mapping[Any, Dimension]) -> Dimension | None:
    """Return the dimension of a tree; None if it is zero and fits any."""
    if node.op == "num":
        return None if node.value == 0 else NONE
    if node.op == "sym":
        return units[node.value]
    parts = [_dimension(arg, units) for arg in node.args]
    first = parts[0]
    if node.op in PURE or node.op == "sign":
        if node.op != "sign" and first not in (None, NONE):
            raise _Fault(f"the argument of {node.op} has a unit")
        return NONE
    if node.op == "if":
        parts = parts[1:]
    if node.op in (*EQUAL, "if"):
        known = [part for part in parts if part is not None]
        if any(part != known[0] for part in known):
            raise _Fault(f"terms of {node.op} have different units")
        return known[0] if known else None
    if node.op in "*/":
        if None in parts:
            return None
        return _times(parts[0] or NONE, parts[1] or NONE, 1 if node.op == "*" else -1)
    power = {"**": node.value, "sqrt": Fraction(1, 2)}.get(node.op, Fraction(1))
    if first is None:
        return NONE if power == 0 else None
    return _times(NONE, first, power)
