"""The kinds of elements, by the name that a spec gives them: a type each, made of its row."""

from collections.abc import Mapping

from piezo_sym.spec.elements.base import Element, Form, Kind
from piezo_sym.spec.elements.domains import PhysicalDomain, PowerVariable
from piezo_sym.spec.elements.kinds import TABLE

KINDS: Mapping[str, type[Element]] = {kind.name: kind.made() for kind in TABLE}
globals().update({kind.__name__: kind for kind in KINDS.values()})  # where pickle looks for them


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
