"""Unit strings: products of powers, in the law language, of names that pint knows.

Input: text such as ``N*s/m``.  Output: a `Unit`, its exact factor to coherent SI and its dimension.
Powers are up to 9, whole (``m**2``) or rational (``N/(m/s)**(1/2)``); ``1`` is the unit of a pure
number.
"""

import re
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, lru_cache
from math import prod
from typing import Any, final

from flint import fmpz

from piezo_sym.errors import SpecError, nearest, quote, similar
from piezo_sym.expressions.dimensions import BASES
from piezo_sym.expressions.grammar import RefusedError, parse_rule
from piezo_sym.expressions.si_units import EXACT, PREFIXES
from piezo_sym.expressions.tree import Div, Expr, Mul, Num, Pow, Sym

#: Names and their powers.
Terms = list[tuple[str, Fraction]]

#: Longer words than this may be the long name of a unit, misspelt.
MAX_UNIT, SHORT = 60, 3
ATOM = "[A-Za-z]+"
PLAIN = re.compile(r"[A-Za-z0-9*/^()-]+")
#: Spellings in ASCII: of micro (two characters that look alike), ohm (two), degrees, powers.
ASCII = str.maketrans(
    {"\u00b5": "u", "\u03bc": "u", "\u03a9": "ohm", "\u2126": "ohm", "\u00b0": "deg"}
    | {"\u00b7": "*", "\u00b2": "**2", "\u00b3": "**3"}
)
COMMON = ("m", "kg", "s", "A", "K", "N", "J", "W", "V", "C", "F", "H", "Wb", "ohm", "Hz", "Pa")
#: The units of specs, by pint's long names; each may have an SI prefix.
_UNITS = """meter gram second ampere kelvin mole candela hertz newton pascal joule watt coulomb volt
    farad ohm siemens weber tesla henry radian degree turn revolutions_per_minute minute hour day
    liter bar standard_atmosphere pound_force_per_square_inch metric_ton inch foot pound force_pound
    force_kilogram electron_volt degree_Celsius degree_Fahrenheit decibel
    neper count percent"""
UNITS = frozenset(_UNITS.split())
#: Pint's names for the dimensions of the base units.
_DIMENSIONS = "mass length time current temperature substance luminosity"
DIMENSIONS = dict(zip(BASES, (f"[{name}]" for name in _DIMENSIONS.split()), strict=True))


@final
@dataclass(frozen=True)
class Unit:
    """A unit of a spec."""

    text: str  # as the spec writes it
    si: str  # the coherent SI unit of the same dimension, such as ``F`` for ``uF``
    factor: Fraction  # exact; a value in this unit times `factor` is the value in coherent SI
    dimension: tuple[Fraction, ...]  # powers of kg, m, s, A, K, mol, cd


def base_units(dimension: tuple[Fraction, ...]) -> str:
    """Return a dimension in SI base units, such as ``kg*m/s**2``."""
    return product_text(tuple(zip(BASES, dimension, strict=True)))


def product_text(powers: Sequence[tuple[str, Fraction | int]]) -> str:
    """Return a product of powers of units as text, those with negative powers last."""
    above = [raised(name, power) for name, power in powers if power > 0]
    below = [raised(name, -power) for name, power in powers if power < 0]
    return "/".join(["*".join(above) or "1", *below])


def raised(name: str, power: Fraction | int) -> str:
    """Return a power of a unit as text."""
    if power == 1:
        return name
    return f"{name}**{power}" if Fraction(power).denominator == 1 else f"{name}**({power})"


def parse_unit(text: str, where: str = "unit", value: float | None = None) -> Unit:
    """Return the unit that `text` names; `value` is a value in it, for the message.

    Raises `SpecError` if the text is not of the grammar, no unit, or one with an offset (degC).
    """
    try:
        with suppress(RefusedError):
            return _read(text)
        return _read(text, value)  # raises again
    except RefusedError as refused:
        raise SpecError(refused.what, where, refused.expected, refused.remedy) from None


@lru_cache(maxsize=1024)
def _read(text: str, value: float | None = None) -> Unit:
    if (plain := text.translate(ASCII)) != text and plain.isascii():
        _read(plain, value)  # raises if the unit is wrong in ASCII, too
        raise RefusedError(f"{quote(text)} is not ASCII", "a unit", f"write {quote(plain)}")
    factor, dimension = Fraction(1), [Fraction(0)] * len(BASES)
    names = _terms(text)
    alone = len(names) == 1 and names[0][1] == 1
    terms = [(_named(name, value, alone, text), power) for name, power in names]
    for unit, power in terms:
        factor *= _raised(unit.factor, power)
        dimension = [d + p * power for d, p in zip(dimension, unit.dimension, strict=True)]
    if not factor:
        raise _no_root(terms, text, value)
    as_written = all(unit.si == unit.text != "1" for unit, _ in terms)
    si = text if as_written else _spelled([(unit.si, power) for unit, power in terms])
    return Unit(text, si, factor, tuple(dimension))


def _spelled(terms: Terms) -> str:
    """Return a unit as text, without numbers: N*m, not N*m/1."""
    named = [(name, power) for name, power in terms if name != "1"]
    text = "" if named and named[0][1] > 0 else "1"
    for name, power in named:
        over, product = bool(text) and power < 0, re.search("[*/]", name) and power != 1
        part = raised(f"({name})" if product else name, -power if over else power)
        text += f"{'/' if over else '*'}{part}" if text else part
    return text


def _terms(text: str) -> Terms:
    """Return the names in a unit with their powers, in their order."""
    try:
        return _parsed(text)
    except RefusedError:
        expected = "names joined by * and /, with powers up to 9, such as 'N*s/m', 'm**2'"
        expected += " or 'N/(m/s)**(1/2)'"
        meant, remedy = re.sub(r"(?<=[A-Za-z])[. ](?=[A-Za-z])", "*", text), ""
        meant = meant.replace("%", "percent")
        with suppress(RefusedError):
            remedy = f"write {quote(meant)}" if meant != text and _parsed(meant) else ""
        raise RefusedError(f"{quote(text)} is not a unit", expected, remedy) from None


def _parsed(text: str) -> Terms:
    """Read a unit as a law; names get an underscore, since `in` and `as` are keywords of Python."""
    if len(text) > MAX_UNIT or not PLAIN.fullmatch(text):
        raise RefusedError("is not a unit")
    terms = _powers(parse_rule(re.sub(ATOM, r"_\g<0>", text.replace("^", "**"))))
    if any(max(abs(power.numerator), power.denominator) > 9 for _, power in terms):
        raise RefusedError("has too large a power")
    return terms


def _powers(tree: Expr) -> Terms:
    match tree:
        case Num(value) if value == 1:
            return [("1", Fraction(1))]
        case Sym(name) if re.fullmatch(f"_{ATOM}", name):
            return [(name[1:], Fraction(1))]
        case Mul(left, right):
            return _powers(left) + _powers(right)
        case Div(left, right):
            return _powers(left) + [(name, -power) for name, power in _powers(right)]
        case Pow(base, exponent) if exponent:
            return [(name, power * exponent) for name, power in _powers(base)]
    raise RefusedError("is not a product of powers")


def _raised(factor: Fraction, power: Fraction) -> Fraction:
    """Return a power of a factor, or 0 if it is no rational number."""
    order, size = power.denominator, factor**power.numerator
    root = Fraction(*(int(fmpz(n).root(order)) for n in size.as_integer_ratio()))
    return root if root**order == size else Fraction(0)


def _no_root(terms: list[Any], text: str, value: float | None) -> RefusedError:
    """Return the error of a unit with roots of factors that are no rational numbers."""
    rooted = [(unit.factor, power) for unit, power in terms if not _raised(unit.factor, power)]
    factor = prod(float(size) ** float(power) for size, power in rooted)
    meant = _spelled([(u.text if _raised(u.factor, p) else u.si, p) for u, p in terms])
    given = f"the value, times {factor:.12g}," if value is None else f"{value * factor:.12g}"
    remedy = f"give {given} in {meant}"
    what = f"unit {quote(text)} has a root of {rooted[0][0]}, which is no exact number"
    return RefusedError(what, "a root of coherent SI units, such as Pa**(1/2)", remedy)


@cache
def _registry() -> Any:
    """Return pint's registry with exact rational factors; built when first needed."""
    import pint

    return pint.UnitRegistry(non_int_type=Fraction)


@lru_cache(maxsize=256)
def _named(name: str, value: float | None = None, alone: bool = True, text: str = "") -> Unit:
    """Return one named unit of a text; its coherent spelling drops the prefix (``uF`` gives ``F``).

    One with an offset is a temperature if it stands `alone`, else a difference, as in W/degC.
    """
    prefixed = name[:1] in PREFIXES and name[1:] in EXACT.keys() - {"1", "kg"}
    if name in EXACT or prefixed:
        si, factor, powers = EXACT[name if name in EXACT else name[1:]]
        scale = Fraction(1) if name in EXACT else Fraction(10) ** PREFIXES[name[0]]
        powers = (*powers, *(0,) * len(BASES))[: len(BASES)]
        return Unit(name, si, scale * factor, tuple(map(Fraction, powers)))
    if _root(name) not in UNITS:
        raise RefusedError(f"unknown unit {quote(name)}", remedy=_meant(name, text))
    try:
        factor, base = _registry().get_base_units(name)
        origin = _registry().Quantity(Fraction(0), name).to_base_units().magnitude
    except TypeError:  # a logarithm of an exact number: dB, Np
        raise RefusedError(f"unit {quote(name)} is logarithmic", "a plain unit") from None
    if origin != 0 and alone:
        remedy = "give the value in K (t degC is t + 273.15 K)"
        if value is not None:
            remedy = f"give it in K: {float(Fraction(repr(value)) * factor + origin)}"
        raise RefusedError(f"unit {quote(name)} has an offset", "a plain unit", remedy)
    if origin != 0:
        return Unit(name, "K", Fraction(factor), _read("K").dimension)
    left = dict(base.dimensionality)
    dimension = tuple(Fraction(left.pop(DIMENSIONS[unit], 0)) for unit in BASES)
    if left:
        raise RefusedError(f"unit {quote(name)} is not physical", remedy=nearest(name, COMMON))
    return Unit(name, _bare(name, Fraction(factor), dimension), Fraction(factor), dimension)


def _root(name: str) -> str:
    """Return pint's long name of a unit without its prefix; '' if there is none.

    The plural of a symbol is none: Pas is meant for Pa*s.
    """
    one, many = (_registry().parse_unit_name(text) for text in (name.removesuffix("s"), name))
    root = str(many[0][1]) if many else ""
    return "" if name.endswith("s") and one[:1] == many[:1] and root not in name else root


def _meant(name: str, text: str) -> str:
    """Return what to write for an unknown name: N*s/m for Ns/m, kV for KV, else a similar name."""
    cuts = ((name[:n], name[n:]) for n in reversed(range(1, len(name))))
    two = next((f"{a}*{b}" for a, b in cuts if _is_common(a) and _is_common(b)), "")
    kilo = next((f"k{unit}" for unit in COMMON if name.lower() == f"k{unit}".lower()), "")
    offers = [f"({two})" * bool(two)]
    offers.insert(0, kilo if name.startswith("K") else "")
    if said := [_put(text or name, name, offer) for offer in offers if offer]:
        return f"write {', or '.join(map(quote, said))}"
    alike = [*_registry().parse_unit_name(name, case_sensitive=False)]  # as mHenry
    word = similar(name.lower(), UNITS)
    alike += [("", word, "")] if len(name) > SHORT and word[:1] == name[0].lower() else []
    for prefix, root, _ in (unit for unit in alike if unit[1] in UNITS):
        symbol = str(_registry().get_symbol(prefix + root)).translate(ASCII)
        return f"did you mean {quote(symbol)}?"
    return nearest(name, (*COMMON, *filter(_is_common, [name[1:]])))


def _is_common(name: str) -> bool:
    return name in COMMON or (name[:1] in PREFIXES and name[1:] in COMMON)


def _put(text: str, name: str, new: str) -> str:
    """Return a unit's text with another for a name in it, in brackets only behind a /."""
    text = re.sub(rf"/{name}(?![A-Za-z])", f"/{new}", text)
    return re.sub(rf"(?<![A-Za-z]){name}(?![A-Za-z])", new.strip("()"), text)


def _bare(name: str, factor: Fraction, dimension: tuple[Fraction, ...]) -> str:
    """Return the coherent unit of a named one: itself, without prefix, a common or base units."""
    if factor == 1:
        return name
    registry = _registry()
    root = next((unit for prefix, unit, _ in registry.parse_unit_name(name) if prefix), "")
    if root and registry.get_base_units(root)[0] == 1:
        symbol = str(registry.get_symbol(root))
        return symbol if symbol.isascii() else root
    alike = (name for name in COMMON if name != "Hz" and _read(name).dimension == dimension)
    return next(alike, base_units(dimension))


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
            unit = _named(name)
        except RefusedError:  # an offset, a logarithm, a count
            continue
        short = str(_registry().get_symbol(name))
        factor = f"{float(unit.factor):.12g} " if unit.factor != 1 else ""
        symbol = short if re.fullmatch(ATOM, short) else name
        yield symbol, name.replace("_", " "), f"{factor}{base_units(unit.dimension)}"
