"""Unit strings: a grammar of our own, then pint.

Input: text such as ``N*s/m``.  Output: a `Unit`, its exact factor to coherent SI and its dimension.
The grammar knows names, ``*``, ``/``, and whole powers up to 9 (``m**2``); ``1`` is
the unit of a pure number.  pint never sees anything else.
"""

import re
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, lru_cache
from typing import Any, final

from piezo_sym.errors import SpecError, nearest, quote

MAX_UNIT = 60
ATOM = r"[A-Za-z]+"
TERM = re.compile(rf"(?P<name>{ATOM}|1)(?:(?:\*\*|\^)(?P<power>-?[1-9]))?")
COMMON = ("m", "kg", "s", "A", "K", "N", "J", "W", "V", "C", "F", "H", "Wb", "ohm", "Hz", "Pa")
BASES = ("kg", "m", "s", "A", "K", "mol", "cd")
#: The units known, by pint's long names; SI prefixes go with each.
_UNITS = """meter gram second ampere kelvin mole candela hertz newton pascal joule watt coulomb volt
    farad ohm siemens weber tesla henry radian degree turn revolutions_per_minute minute hour day
    liter bar tonne inch foot pound electron_volt degree_Celsius degree_Fahrenheit decibel neper
    count percent"""
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
    except SpecError:  # say it again, of the place where it stands
        return _read(text, where, value)


@lru_cache(maxsize=1024)
def _known(text: str) -> Unit:
    return _read(text, "unit", None)


def _read(text: str, where: str, value: float | None) -> Unit:
    factor, dimension = Fraction(1), [Fraction(0)] * len(BASES)
    terms = [(_named(name, where, value), power) for name, power in _terms(text, where)]
    for unit, power in terms:
        factor *= unit.factor**power
        dimension = [d + p * power for d, p in zip(dimension, unit.dimension, strict=True)]
    si = text if factor == 1 else _spelled([(unit.si, power) for unit, power in terms])
    return Unit(text, si, factor, tuple(dimension))


def _spelled(terms: list[tuple[str, int]]) -> str:
    first, *rest = terms
    text = raised(*first)
    for name, power in rest:
        text += f"*{raised(name, power)}" if power > 0 else f"/{raised(name, -power)}"
    return text


def _terms(text: str, where: str) -> list[tuple[str, int]]:
    expected = "names joined by * and /, with whole powers up to 9, such as 'N*s/m' or 'm**2'"
    fault = SpecError(f"{quote(text)} is not a unit", where, expected)
    if not text or len(text) > MAX_UNIT:
        raise fault
    position, sign, terms = 0, 1, []
    while True:
        match = TERM.match(text, position)
        if match is None:
            raise fault
        terms.append((match["name"], sign * int(match["power"] or 1)))
        position = match.end()
        if position == len(text):
            return terms
        if text[position] not in "*/":
            raise fault
        sign = -1 if text[position] == "/" else 1
        position += 1


@cache
def _registry() -> Any:
    """Return pint's registry with exact rational factors; built when first needed."""
    import pint

    return pint.UnitRegistry(non_int_type=Fraction)


@lru_cache(maxsize=256)
def _named(name: str, where: str, value: float | None) -> Unit:
    """Return one named unit; its coherent spelling drops the prefix (``uF`` gives ``F``)."""
    if name == "1":
        return Unit(name, name, Fraction(1), (Fraction(0),) * len(BASES))
    if not any(root in UNITS for _, root, _ in _registry().parse_unit_name(name)):
        raise SpecError(f"unknown unit {quote(name)}", where, remedy=nearest(name, COMMON))
    try:
        factor, base = _registry().get_base_units(name)
        origin = _registry().Quantity(Fraction(0), name).to_base_units().magnitude
    except TypeError:  # a logarithm of an exact number: dB, Np
        raise SpecError(f"unit {quote(name)} is logarithmic", where, "a plain unit") from None
    if origin != 0:
        remedy = "give the value in K (t degC is t + 273.15 K)"
        if value is not None:
            remedy = f"give it in K: {float(Fraction(repr(value)) * factor + origin)}"
        raise SpecError(f"unit {quote(name)} has an offset", where, "a plain unit", remedy)
    powers = dict(base.dimensionality)
    dimension = tuple(Fraction(powers.pop(DIMENSIONS[unit], 0)) for unit in BASES)
    if powers:
        raise SpecError(f"unit {quote(name)} is not physical", where, remedy=nearest(name, COMMON))
    return Unit(name, _bare(name, Fraction(factor), dimension), Fraction(factor), dimension)


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
    return value if unit.factor == 1 else float(Fraction(repr(value)) * unit.factor)
