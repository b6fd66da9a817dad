"""Units of a spec: texts to exact factors and dimensions, and the walk that compares them.

Input: texts such as ``N*s/m``, which are read as laws are, and trees with the dimension of every
symbol.  Output: `Unit`, and the faults that a tree has.  pint knows the units.
"""

from collections.abc import Iterator, Mapping
from fractions import Fraction
from functools import cache
from typing import Any, NamedTuple

from .laws import SMOOTH, InputError, Node, need, num, parse, symbols, value, walk

BASES = [
    f"[{w}]"
    for w in ["mass", "length", "time", "current", "temperature", "substance", "luminosity"]
]
Dimension = tuple[Fraction, ...]
NONE: Dimension = (Fraction(0),) * len(BASES)
EQUAL = ("+", "min", "max", "deadzone", "saturate", "cmp", "if")


class Unit(NamedTuple):
    """A unit: a value in it times `factor` is the value in SI."""

    factor: Fraction
    dimension: Dimension


@cache
def unit(text: str) -> Unit:
    """Return the unit that a text names; raises `InputError` if it names none."""
    tree = parse(text.replace("^", "**"))
    parts = all(n.op in ("*", "/", "**", "sym") or n == num(1) for n in walk(tree))
    need(parts, f"{text[:60]!r} is no unit")
    named = {name: _named(name) for name in symbols(tree)}
    factor = value(tree, {name: own.factor for name, own in named.items()})
    dimension = _dimension(tree, {name: own.dimension for name, own in named.items()})
    return Unit(factor, dimension or NONE)


@cache
def _registry() -> Any:
    import pint

    return pint.UnitRegistry(non_int_type=Fraction)


@cache
def _named(name: str) -> Unit:
    try:
        factor, base = _registry().get_base_units(name)
        origin = _registry().Quantity(Fraction(0), name).to_base_units().magnitude
        powers = dict(base.dimensionality)
    except (TypeError, AttributeError, ValueError):  # pint's own errors are among them
        raise InputError(f"{name!r} is no unit") from None
    dimension = tuple(Fraction(powers.pop(word, 0)) for word in BASES)
    need(not origin and not powers, f"{name!r} is no plain unit")
    return Unit(Fraction(factor), dimension)


def _times(left: Dimension, right: Dimension, power: Fraction | int) -> Dimension:
    return tuple(a + power * b for a, b in zip(left, right, strict=True))


def check(
    tree: Node, units: Mapping[Any, Dimension], needed: Dimension | None, where: str
) -> Iterator[str]:
    """Yield the first fault of a tree's units, if there is one."""
    try:
        if _dimension(tree, units) not in (None, needed) and needed is not None:
            yield f"{where} has another unit than its row"
    except InputError as fault:
        yield f"{where}: {fault}"


def _dimension(node: Node, units: Mapping[Any, Dimension]) -> Dimension | None:
    """Return the dimension of a tree; None if it is zero and fits any."""
    if node.op in ("num", "sym"):
        return units[node.value] if node.op == "sym" else NONE if node.value else None
    parts = [_dimension(arg, units) for arg in node.args]
    known = [part for part in (parts[1:] if node.op == "if" else parts) if part is not None]
    need(node.op not in SMOOTH or known in ([], [NONE]), f"the argument of {node.op} has a unit")
    equal = node.op not in EQUAL or all(part == known[0] for part in known)
    need(equal, f"the terms of {node.op!r} have different units")
    if node.op in (*SMOOTH, "sign") or (node.op == "**" and node.value == 0):
        return NONE
    if node.op in "*/":
        sign = 1 if node.op == "*" else -1
        return _times(known[0], known[1], sign) if len(known) == 2 else None
    power = node.value if node.op == "**" else 1
    return _times(NONE, known[0], power) if known else None
