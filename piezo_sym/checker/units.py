"""Units of a spec, by pint: exact factors and dimensions, and the walk that compares them.

Input: texts such as ``N*s/m``, and trees with the dimension of every symbol.  Output: `Unit`, and
the faults that a tree has.
"""

from collections.abc import Iterator, Mapping
from fractions import Fraction
from functools import cache
from tokenize import TokenError
from typing import Any, NamedTuple

from .laws import ARITHMETIC, PLAIN, SMOOTH, InputError, Node, need

Dimension = Any  # of pint: a product of powers
EQUAL = ("+", "min", "max", "deadzone", "saturate", "cmp", "if")


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
    need(
        len(text) <= 60 and bool(PLAIN.fullmatch(text.replace("^", "*"))),
        f"{text[:60]!r} is no unit",
    )
    try:
        named = _registry().parse_units(text)
        zero, one = (_registry().Quantity(Fraction(n), named).to_base_units() for n in (0, 1))
        factor = Fraction(one.magnitude)
    except (TypeError, AttributeError, ValueError, ArithmeticError, AssertionError, TokenError):
        raise InputError(f"{text!r} is no unit") from None
    need(zero.magnitude == 0, f"{text!r} is no plain unit")
    return Unit(factor, one.dimensionality)


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
    pure = unit("1").dimension
    if node.op in ("num", "sym"):
        return units[node.value] if node.op == "sym" else pure if node.value else None
    parts = [_dimension(arg, units) for arg in node.args]
    known = [part for part in (parts[1:] if node.op == "if" else parts) if part is not None]
    need(node.op not in SMOOTH or known in ([], [pure]), f"the argument of {node.op} has a unit")
    equal = node.op not in EQUAL or all(part == known[0] for part in known)
    need(equal, f"the terms of {node.op!r} have different units")
    if node.op in (*SMOOTH, "sign") or (node.op == "**" and node.value == 0):
        return pure
    if node.op in "*/":
        return ARITHMETIC[node.op](*known) if len(known) == 2 else None
    return known[0] ** (node.value if node.op == "**" else 1) if known else None
