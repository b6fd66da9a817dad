"""The kinds of elements by their names in a spec: one type per kind, made from its row."""

from collections.abc import Iterator, Mapping
from itertools import product
from typing import Any

from piezo_sym.expressions.dimensions import Dimension
from piezo_sym.expressions.units import parse_unit
from piezo_sym.spec.elements.base import Element, element_type
from piezo_sym.spec.elements.domains import DOMAINS
from piezo_sym.spec.elements.kinds import TABLE
from piezo_sym.spec.elements.ports import Coupling

KINDS: Mapping[str, type[Element]] = {name: element_type(name, *row) for name, row in TABLE.items()}
globals().update({kind.__name__: kind for kind in KINDS.values()})  # where pickle looks for them
#: The letters of laws: of variables, states and T.
LETTERS = frozenset(v.letter for d in DOMAINS for v in (d.across, d.through)) | {"T"}
LETTERS |= {kind.form.letter for kind in KINDS.values()}


def kind_of(*role: Any) -> str:
    """Return the kind whose form has a role, such as ``("dissipation", ELECTRICAL)``."""
    return next(name for name, kind in KINDS.items() if kind.form.role == role)


def with_ratio_in(unit: Dimension, element: Element) -> Iterator[tuple[str, str]]:
    """Yield the kinds that take a ratio in `unit` and couple the first domain that `element` does.

    With each goes the name of its second domain if `element` does not couple that, else ''.
    """
    couplings = (port for port in element.ports("") if isinstance(port, Coupling))
    for port, (name, kind) in product(couplings, KINDS.items()):
        own = {port.first_domain, port.second_domain}
        for first, second, ratio_unit in kind.form.ratios:
            alike = (first == port.first_domain != second) or {first, second} == own
            if alike and parse_unit(ratio_unit).dimension == unit:
                yield name, "" if second in own else second.name
