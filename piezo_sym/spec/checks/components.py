"""Components of a spec: what they name exists, here or in their models, and units agree."""

from collections.abc import Iterable, Mapping
from typing import Any

from piezo_sym.errors import SpecError, listing, nearest, quote, with_article
from piezo_sym.spec.elements.domains import REFERENCES
from piezo_sym.spec.fields import Component, Input, Parameter, Tables
from piezo_sym.spec.names import NAME, check_name
from piezo_sym.spec.unit_text import quantity


def check_component(spec: Tables, where: str, component: Component, model: Tables) -> None:
    """Check a component of a spec; `model` is the component's, flat.

    Raises `SpecError` if the component names something that does not exist, or with another unit.
    """
    check_name(where.removeprefix("components."), where)
    used = {node for e in model.elements.values() for _, node in e.named("node")}
    for node in component.nodes:
        if node in REFERENCES:
            what = f"{quote(node)} is a reference, the same node in all models"
            raise SpecError(what, f"{where}.nodes.{node}", remedy="leave it out")
        _check_known(f"{where}.nodes.{node}", "node", node, used - REFERENCES.keys(), model)
    for what in ("parameter", "input"):
        ours, theirs, table = (getattr(t, f"{what}s") for t in (spec, model, component))
        for name, given in table.items():
            place = f"{where}.{what}s.{name}"
            _check_known(place, what, name, theirs, model)
            if isinstance(given, str):
                _check_fits(place, what, given, ours, theirs[name])
    for name in component.without:
        _check_known(f"{where}.without", "element", name, model.elements, model)
    _check_left_out(where, component, model)


def _check_known(where: str, what: str, name: str, known: Iterable[str], model: Tables) -> None:
    if name not in known:
        text = f"{quote(name)} is no {what} of '{model.model.name}'"
        raise SpecError(text, where, remedy=nearest(name, known))


def _check_fits(
    where: str, what: str, given: str, known: Mapping[str, Any], meant: Parameter | Input
) -> None:
    """Refuse a name that this spec does not have, or whose unit differs from that of `meant`."""
    if given not in known:
        example = f'{given} = {{ value = 1.0, unit = "{meant.unit}" }}'
        example = example.replace("value = 1.0, ", "") if what == "input" else example
        ways = [nearest(given, known)] if known else []
        ways += [f"declare it in [{what}s]: {example}"] if NAME.fullmatch(given) else []
        remedy, expected = "; or ".join(ways), with_article(what)
        if what == "parameter":
            expected = f"a number in the component's unit, {meant.unit}, or {expected}"
        raise SpecError(f"{quote(given)} is no {what} of this spec", where, expected, remedy)
    unit = known[given].dimension.dimension
    needed = meant.dimension.dimension
    if unit != needed:
        raise SpecError(f"{quote(given)} is {quantity(unit)}", where, quantity(needed))


def _check_left_out(where: str, component: Component, model: Tables) -> None:
    """Refuse to leave out everything, or a body that another element names."""
    gone = {*component.without}
    if gone >= model.elements.keys():
        raise SpecError("leaves out all elements", f"{where}.without", "some are left")
    users = {
        name: (f"elements.{name}.{field}", body)
        for name, element in model.elements.items()
        for field, body in element.named("thermal_mass")
        if body in gone and name not in gone
    }
    if users:
        places, lost = zip(*users.values(), strict=True)
        verb, bodies = "name" if len(users) > 1 else "names", dict.fromkeys(lost)
        gone_too = f"which {'are' if len(bodies) > 1 else 'is'} left out"
        what = f"{listing(places)} {verb} {listing(map(quote, bodies))}, {gone_too}"
        remedy = f"leave out {listing(map(quote, users))} too"
        raise SpecError(what, f"{where}.without", remedy=remedy)
