"""Dimensions in words: short unit texts, and what the quantities are called.

Input: a dimension.  Output: text such as ``A/K`` or ``a voltage [V]``.  A unit is spelled as a
product and quotient of at most three common units, the shortest first, else in base units.
"""

from collections.abc import Iterator, Mapping
from fractions import Fraction
from functools import cache
from itertools import combinations, product

from piezo_sym.errors import with_article
from piezo_sym.expressions.dimensions import BASES, Dimension
from piezo_sym.expressions.units import base_units, parse_unit, product_text
from piezo_sym.spec.elements.domains import DOMAINS

#: Usual spellings, preferred to shorter ones.
USUAL = ("N*s/m", "N/m", "kg*m/s", "C/m")
#: A dimension of these alone is spelled in base units: ``m**2/s**2``, not ``J/kg``.
PLAIN = frozenset({"m", "s", "K"})
#: The units texts are made of, best first.
PARTS = ("V", "A", "N", "W", "J", "C", "ohm", "F", "H", "Wb", "Pa", "m", "s", "kg", "K")
MOST_PARTS = 3
SMALL, LARGE = (1, -1, 2, -2), (1, -1, 2, -2, 3, -3, 4, -4)
#: Units and their powers.
Powers = tuple[tuple[str, int], ...]

_VARIABLES = [variable for domain in DOMAINS for variable in (domain.across, domain.through)]
#: The quantity of each unit; of several units of one dimension, the first names the dimension.
QUANTITIES: Mapping[str, str] = {
    "J": "an energy",
    "J*s": "an action",
    "1": "a number without unit",
    "1/s": "a rate",
    **{variable.unit: with_article(variable.word) for variable in _VARIABLES},
    **{variable.state_unit: with_article(variable.state) for variable in _VARIABLES},
    "m": "a length",
    "rad": "an angle",
    "K": "a temperature",
    "J/K": "an entropy",
    "W/K": "a heat conductance",
    "s": "a time",
    "kg": "a mass",
    "N/m": "a stiffness",
    "F": "a capacitance",
    "H": "an inductance",
    "ohm": "a resistance",
    "C/m": "a transducer ratio",
    "V/K": "a Seebeck coefficient",
    "W": "a power",
    "m**3/Pa": "a hydraulic capacitance",
    "Pa*s**2/m**3": "an inertance",
    "m**2": "an area",
    "m**3/rad": "a displacement",
    "kg*m**2": "a moment of inertia",
    "N/A": "a motor constant",
    "N*m/A": "a motor constant",
    "N*m/rad": "a torsional stiffness",
}


@cache
def unit_text(dimension: Dimension) -> str:
    """Return a short text for a dimension, such as ``ohm*K``; ``1`` if there is none."""
    if {name for name, power in zip(BASES, dimension, strict=True) if power} <= PLAIN:
        return base_units(dimension)
    return _spellings().get(dimension) or base_units(dimension)


@cache
def quantity(dimension: Dimension, spelling: str = "") -> str:
    """Return the name of a quantity with its unit, such as ``a voltage [V]``.

    `spelling` is the unit in the record of an element's kind, if it has one: ``a torque [N*m]``.
    """
    for text in (spelling,) if spelling in QUANTITIES else QUANTITIES:
        if parse_unit(text).dimension == dimension:
            return QUANTITIES[text] + f" [{text}]" * (text != "1")
    return f"a quantity in {unit_text(dimension)}"


@cache
def _spellings() -> Mapping[tuple[Fraction | int, ...], str]:
    """Return the shortest text of each dimension that has one."""
    spellings: dict[tuple[Fraction | int, ...], str] = {
        parse_unit(text).dimension: text for text in USUAL
    }
    units = {name: [int(p) for p in parse_unit(name).dimension] for name in PARTS}
    for powers in sorted(_products(), key=_length):
        total = tuple(sum(units[name][k] * p for name, p in powers) for k in range(len(BASES)))
        spellings.setdefault(total, product_text(powers))
    return spellings


def _products() -> Iterator[Powers]:
    """Yield the products of powers of units to try."""
    for size in range(1, MOST_PARTS + 1):
        for parts in combinations(PARTS, size):
            for powers in product(SMALL if size == MOST_PARTS else LARGE, repeat=size):
                yield tuple(zip(parts, powers, strict=True))


def _length(powers: Powers) -> tuple[int, int, int]:
    size = sum(abs(power) for _, power in powers)
    return len(powers), size, sum(power < 0 for _, power in powers)
