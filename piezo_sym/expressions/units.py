"""Unit strings: a grammar of our own, then pint.

Input: text such as ``N*s/m``.  Output: a `Unit`, its exact factor to coherent SI and its dimension.
The grammar knows names, ``*``, ``/``, parentheses and powers up to 9, whole (``m**2``) or rational
(``N/(m/s)**(1/2)``); ``1`` is the unit of a pure number.  pint sees names alone.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, lru_cache
from typing import Any, final

from piezo_sym.errors import SpecError, nearest, quote
from piezo_sym.expressions.dimensions import BASES

MAX_UNIT = 60
ATOM = r"[A-Za-z]+"
POWER = re.compile(r"(?:\*\*|\^)(?P<power>-?[1-9]|\(-?[1-9]/[2-9]\))")
MAX_DEPTH = 2
#: How letters beyond ASCII are written: micro (two letters that look alike), ohm (two), degrees.
ASCII = str.maketrans(
    {"\u00b5": "u", "\u03bc": "u", "\u03a9": "ohm", "\u2126": "ohm", "\u00b0": "deg"}
    | {"\u00b7": "*", "\u00b2": "**2", "\u00b3": "**3"}
)
COMMON = ("m", "kg", "s", "A", "K", "N", "J", "W", "V", "C", "F", "H", "Wb", "ohm", "Hz", "Pa")
#: Powers of kg, m, s, A, K, as the SI defines its units; pint, which has the others, loads slowly.
COHERENT = {
    "1": (), "kg": (1,), "m": (0, 1), "s": (0, 0, 1), "A": (0, 0, 0, 1), "K": (0, 0, 0, 0, 1),
    "N": (1, 1, -2), "Pa": (1, -1, -2), "J": (1, 2, -2), "W": (1, 2, -3), "Hz": (0, 0, -1),
    "C": (0, 0, 1, 1), "V": (1, 2, -3, -1), "F": (-1, -2, 4, 2), "ohm": (1, 2, -3, -2),
    "S": (-1, -2, 3, 2), "Wb": (1, 2, -2, -1), "T": (1, 0, -2, -1), "H": (1, 2, -2, -2),
}  # fmt: skip
#: The units known, by pint's long names; SI prefixes go with each.
_UNITS = """meter gram second ampere kelvin mole candela hertz newton pascal joule watt coulomb volt
    farad ohm siemens weber tesla henry radian degree turn revolutions_per_minute minute hour day
    liter bar metric_ton inch foot pound electron_volt degree_Celsius degree_Fahrenheit decibel
    neper count percent"""
UNITS = frozenset(_UNITS.split())
DIMENSIONS = dict(
    zip(
        BASES,
        (
            "[mass]",
            "[length]",
            "[time]",
            "[current]",
            "[temperature]",
            "[substance]",
            "[luminosity]",
        ),
        strict=True,
    )
)


@final
@dataclass(frozen=True)
class Unit:
    """A unit of a spec.

    Attributes
    ----------
    text : as the spec writes it.
    si : the coherent SI unit in its place, such as ``F`` for ``uF``.
    factor : exact; a value in this unit times it is the value in coherent SI.
    dimension : powers of kg, m, s, A, K, mol, cd.
    """

    text: str
    si: str
    factor: Fraction
    dimension: tuple[Fraction, ...]


def base_units(dimension: tuple[Fraction, ...]) -> str:
    """Return a dimension in SI base units, such as ``kg*m/s**2``."""
    powers = list(zip(BASES, dimension, strict=True))
    above = [raised(name, p) for name, p in powers if p > 0]
    below = [raised(name, -p) for name, p in powers if p < 0]
    return "/".join(["*".join(above) or "1", *below])


def raised(name: str, power: Fraction | int) -> str:
    """Return a power of a unit as text."""
    if power == 1:
        return name
    return f"{name}**{power}" if Fraction(power).denominator == 1 else f"{name}**({power})"


def parse_unit(text: str, where: str = "unit", value: float | None = None) -> Unit:
    """Return the unit that `text` names; `value` is what is given in it, for the message.

    Raises
    ------
    SpecError
        If the text is not of the grammar, names no unit, or a unit with an offset (degC).
    """
    try:
        return _known(text)
    except SpecError:  # raised again with the place in the spec
        return _read(text, where, value)


@lru_cache(maxsize=1024)
def _known(text: str) -> Unit:
    return _read(text, "unit", None)


def _read(text: str, where: str, value: float | None) -> Unit:
    if (plain := text.translate(ASCII)) != text and plain.isascii():
        _read(plain, where, value)  # a unit that is refused in ASCII, too, says why
        raise SpecError(f"{quote(text)} is not ASCII", where, "a unit", f"write {quote(plain)}")
    factor, dimension = Fraction(1), [Fraction(0)] * len(BASES)
    found = _terms(text, where)
    alone = len(found) == 1 and found[0][1] == 1
    terms = [(_named(name, where, value, alone), power) for name, power in found]
    for unit, power in terms:
        factor *= _raised(unit.factor, power, text, where)
        dimension = [d + p * power for d, p in zip(dimension, unit.dimension, strict=True)]
    as_written = all(unit.si == unit.text for unit, _ in terms)
    si = text if as_written else _spelled([(unit.si, power) for unit, power in terms])
    return Unit(text, si, factor, tuple(dimension))


def _spelled(terms: list[tuple[str, Fraction]]) -> str:
    text = ""
    for name, power in terms:
        if re.search("[*/]", name):  # a product of base units
            part, sign = name if power == 1 else raised(f"({name})", power), "*"
        else:
            over = bool(text) and power < 0
            part, sign = raised(name, -power if over else power), "/" if over else "*"
        text += f"{sign}{part}" if text else part
    return text


def _terms(text: str, where: str) -> list[tuple[str, Fraction]]:
    read = _product(text, 0, MAX_DEPTH) if len(text) <= MAX_UNIT else None
    if read is None or read[1] != len(text) or any(_most(power) > 9 for _, power in read[0]):
        expected = "names joined by * and /, with powers up to 9, such as 'N*s/m', 'm**2'"
        expected += " or 'N/(m/s)**(1/2)'"
        meant = re.sub(r"(?<=[A-Za-z])[. ](?=[A-Za-z])", "*", text.replace("%", "percent"))
        remedy = f"write {quote(meant)}" if meant != text and _product(meant, 0, MAX_DEPTH) else ""
        raise SpecError(f"{quote(text)} is not a unit", where, expected, remedy)
    return read[0]


def _most(power: Fraction) -> int:
    return max(abs(power.numerator), power.denominator)


def _product(text: str, at: int, depth: int) -> tuple[list[tuple[str, Fraction]], int] | None:
    """Return names with their powers, and where the product ends; None if there is none.

    Parentheses are for a power of what stands in them.
    """
    sign, terms = 1, list[tuple[str, Fraction]]()
    while True:
        read = _factor(text, at, depth)
        if read is None:
            return None
        inner, at = read
        match = POWER.match(text, at)
        if text[at - 1] == ")" and not match:
            return None
        power = sign * (Fraction(match["power"].strip("()")) if match else Fraction(1))
        terms += [(name, own * power) for name, own in inner]
        at = match.end() if match else at
        if text[at : at + 1] not in {"*", "/"}:
            return terms, at
        sign, at = (1 if text[at] == "*" else -1), at + 1


def _factor(text: str, at: int, depth: int) -> tuple[list[tuple[str, Fraction]], int] | None:
    """Return a name, or what stands in parentheses, and where it ends."""
    name = re.compile(rf"{ATOM}|1").match(text, at)
    if name:
        return [(name.group(), Fraction(1))], name.end()
    inner = _product(text, at + 1, depth - 1) if depth and text[at : at + 1] == "(" else None
    if inner is None or text[inner[1] : inner[1] + 1] != ")":
        return None
    return inner[0], inner[1] + 1


def _raised(factor: Fraction, power: Fraction, text: str, where: str) -> Fraction:
    """Return a power of a factor, which has to be a rational number."""
    order, size = power.denominator, factor**power.numerator
    parts = [_root(number, order) for number in (size.numerator, size.denominator)]
    if None in parts:
        what = f"unit {quote(text)} has a root of {factor}, which is no exact number"
        raise SpecError(what, where, "a root of coherent SI units", "give the value in those")
    return Fraction(*(number or 0 for number in parts))


def _root(number: int, order: int) -> int | None:
    """Return the whole root of a whole number, by halving, or None if it has none."""
    low, high = 0, number
    while low < high:
        middle = (low + high + 1) // 2
        low, high = (middle, high) if middle**order <= number else (low, middle - 1)
    return low if low**order == number else None


@cache
def _registry() -> Any:
    """Return pint's registry with exact rational factors; built when first needed."""
    import pint

    return pint.UnitRegistry(non_int_type=Fraction)


@lru_cache(maxsize=256)
def _named(name: str, where: str, value: float | None, alone: bool = True) -> Unit:
    """Return one named unit; its coherent spelling drops the prefix (``uF`` gives ``F``).

    One with an offset is a temperature if it stands alone; else it is a difference of them, as in
    W/degC.
    """
    if name in COHERENT:
        powers = (*COHERENT[name], *(0,) * len(BASES))[: len(BASES)]
        return Unit(name, name, Fraction(1), tuple(map(Fraction, powers)))
    if not any(root in UNITS for _, root, _ in _registry().parse_unit_name(name)):
        raise SpecError(f"unknown unit {quote(name)}", where, remedy=_meant(name))
    try:
        factor, base = _registry().get_base_units(name)
        origin = _registry().Quantity(Fraction(0), name).to_base_units().magnitude
    except TypeError:  # a logarithm of an exact number: dB, Np
        raise SpecError(f"unit {quote(name)} is logarithmic", where, "a plain unit") from None
    if origin != 0 and alone:
        remedy = "give the value in K (t degC is t + 273.15 K)"
        if value is not None:
            remedy = f"give it in K: {float(Fraction(repr(value)) * factor + origin)}"
        raise SpecError(f"unit {quote(name)} has an offset", where, "a plain unit", remedy)
    if origin != 0:
        return Unit(name, "K", Fraction(factor), _known("K").dimension)
    left = dict(base.dimensionality)
    dimension = tuple(Fraction(left.pop(DIMENSIONS[unit], 0)) for unit in BASES)
    if left:
        raise SpecError(f"unit {quote(name)} is not physical", where, remedy=nearest(name, COMMON))
    return Unit(name, _bare(name, Fraction(factor), dimension), Fraction(factor), dimension)


def _meant(name: str) -> str:
    """Return what to write for a name that is none: N*m for Nm, else one that is like it."""
    cuts = ((name[:n], name[n:]) for n in range(1, len(name)))
    two = next((f"{a}*{b}" for a, b in cuts if a in COMMON and b in COMMON), "")
    return f"write {quote(two)}" if two else nearest(name, COMMON)


def _bare(name: str, factor: Fraction, dimension: tuple[Fraction, ...]) -> str:
    """Return the coherent unit behind a named one: itself, itself without prefix, or its bases."""
    if factor == 1:
        return name
    registry = _registry()
    root = next((unit for prefix, unit, _ in registry.parse_unit_name(name) if prefix), "")
    if root and registry.get_base_units(root)[0] == 1:
        symbol = str(registry.get_symbol(root))
        return symbol if symbol.isascii() else root
    return base_units(dimension)


def to_si(value: float, unit: Unit) -> float:
    """Return `value` given in `unit` in coherent SI, rounded once."""
    return scaled(value, unit.factor)


def scaled(value: float, factor: Fraction) -> float:
    """Return a value times an exact factor, rounded once."""
    return value if factor == 1 else float(Fraction(repr(value)) * factor)


def known_units() -> Iterator[tuple[str, str, str]]:
    """Yield the symbol, the name and the value in coherent SI of each unit that specs may use."""
    for name in _UNITS.split():
        try:
            unit = _named(name, "", None)
        except SpecError:  # an offset, a logarithm, a count
            continue
        short = str(_registry().get_symbol(name))
        factor = f"{float(unit.factor):.12g} " if unit.factor != 1 else ""
        symbol = short if re.fullmatch(ATOM, short) else name
        yield symbol, name.replace("_", " "), f"{factor}{base_units(unit.dimension)}"
