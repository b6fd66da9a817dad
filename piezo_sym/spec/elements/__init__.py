"""The kinds of elements, by the name that a spec gives them: a type each, made of its row."""

from collections.abc import Iterator, Mapping

from piezo_sym.expressions.dimensions import Dimension
from piezo_sym.expressions.units import parse_unit
from piezo_sym.spec.elements.base import Element, Form, Kind
from piezo_sym.spec.elements.couplings import PairCoupling
from piezo_sym.spec.elements.domains import DOMAINS, PhysicalDomain, PowerVariable
from piezo_sym.spec.elements.kinds import TABLE
from piezo_sym.spec.elements.ports import Coupling

KINDS: Mapping[str, type[Element]] = {kind.name: kind.made() for kind in TABLE}
globals().update({kind.__name__: kind for kind in KINDS.values()})  # where pickle looks for them
#: The letters of laws: of variables, states and T.
LETTERS = frozenset(v.letter for d in DOMAINS for v in (d.across, d.through)) | {"T"}
LETTERS |= {kind.letter for kind in TABLE}


def kind_of(form: type[Form], domain: PhysicalDomain, imposes: PowerVariable | None = None) -> Kind:
    """Return the first kind that is one form in a domain, such as its store or its resistor."""
    return next(
        kind
        for kind in TABLE
        if len(kind.forms) == 1
        and isinstance(own := kind.forms[0], form)
        and getattr(own, "domain", None) == domain
        and imposes in (None, getattr(own, "imposes", None))
    )


def with_ratio_in(unit: Dimension, element: Element) -> Iterator[Kind]:
    """Yield the kinds that couple the same domains as an element, with a ratio of some unit."""
    port = element.ports("")[0] if len(element.row.forms) == 1 else None
    if not isinstance(port, Coupling):
        return
    for kind in TABLE:
        for form in kind.forms:
            if isinstance(form, PairCoupling):
                own = form.unit_between(port.first_domain, port.second_domain)
                if own and parse_unit(own).dimension == unit:
                    yield kind
