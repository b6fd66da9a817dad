"""Units of a spec by pint: exact factors and dimensions, and the check of trees.

Input: texts such as ``N*s/m``, and trees with the dimension of every symbol.  Output: the factor to
SI and the dimension of a unit, and the faults of a tree.
"""

import re
from collections.abc import Mapping
from fractions import Fraction
from functools import cache
from typing import Any

from flint import fmpz

from .functions import SMOOTH
from .laws import ARITHMETIC, InputError, Node, need, parse

Dimension = Any  # of pint: a product of powers
PLAIN = re.compile(r"[A-Za-z1-9*/^() -]{1,60}")
MAX_BITS, EQUAL = 10_000, ("+", "min", "max", "deadzone", "saturate", "table", "cmp", "if")


@cache
def _registry() -> Any:
    import pint

    return pint.UnitRegistry(non_int_type=Fraction)


@cache
def unit(text: str) -> tuple[Fraction, Dimension]:
    """Return the factor to SI and the dimension of a unit; raises `InputError` if it is none."""
    need(PLAIN.fullmatch(text), f"{text[:60]!r} is no unit")
    try:  # parsed as a law; the prefix keeps names from being keywords of Python
        found = _read(parse(re.sub("[A-Za-z]+", r"unit_\g<0>", text.replace("^", "**")), 400))
        return Fraction(found.magnitude), found.dimensionality
    except (InputError, TypeError, AttributeError, ValueError, ArithmeticError, AssertionError):
        raise InputError(f"{text!r} is no unit") from None


def _read(node: Node) -> Any:
    """Return a product of powers of named units as a quantity in base units."""
    if node.op in ("sym", "num"):
        need(node.op == "sym" or node.value == 1, "a unit has no number")
        named = _registry().parse_units(str(node.value).removeprefix("unit_").strip("1"))
        zero, one = (_registry().Quantity(Fraction(n), named).to_base_units() for n in (0, 1))
        need(zero.magnitude == 0, "it has an offset")
        return one
    need(node.op in ("*", "/", "**"), "a unit is a product of powers")
    base, *others = map(_read, node.args)
    if others:
        return ARITHMETIC[node.op](base, *others)
    factor, power = Fraction(base.magnitude), Fraction(node.value)
    bits = max(factor.numerator, factor.denominator).bit_length() * abs(power.numerator)
    need(bits < MAX_BITS, "its factor is too long")
    size = factor**power.numerator
    roots = (fmpz(n).root(power.denominator) for n in (size.numerator, size.denominator))
    root = Fraction(*map(int, roots))
    need(root**power.denominator == size, "its factor is no exact number")
    return _registry().Quantity(root, base.units**power)


def faults(tree: Node, units: Mapping[Any, Dimension], needed: Any, where: str) -> list[str]:
    """Return the first fault of a tree's units, or none."""
    try:
        fits = _dimension(tree, units) in (None, needed) or needed is None
        return [] if fits else [f"{where} has another unit than its row"]
    except InputError as fault:
        return [f"{where}: {fault}"]


def _dimension(node: Node, units: Mapping[Any, Dimension]) -> Dimension | None:
    """Return the dimension of a tree; None if it is zero, which has any."""
    pure = unit("1")[1]
    if node.op in ("num", "sym"):
        return units[node.value] if node.op == "sym" else pure if node.value else None
    parts = [_dimension(arg, units) for arg in node.args]
    if node.op == "table":
        x = [part for part in (*parts[:1], *parts[1::2]) if part is not None]
        need(all(part == x[0] for part in x), "the knots of a table have different units")
        parts = parts[2::2]
    known = [part for part in (parts[1:] if node.op == "if" else parts) if part is not None]
    need(node.op not in SMOOTH or {*known} <= {pure}, f"the argument of {node.op} has a unit")
    equal = node.op not in EQUAL or all(part == known[0] for part in known)
    need(equal, f"the terms of {node.op!r} have different units")
    if node.op in (*SMOOTH, "sign") or (node.op == "**" and node.value == 0):
        return pure
    if node.op in "*/":
        return ARITHMETIC[node.op](*known) if len(known) == 2 else None
    return known[0] ** (node.value if node.op == "**" else 1) if known else None
