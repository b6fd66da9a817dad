"""References and laws of a spec: what they name exists, and the text is of the law language."""

from __future__ import annotations

from collections.abc import Collection

from piezo_sym.errors import SpecError, listing, nearest, quote
from piezo_sym.spec.elements import KINDS, Conduction
from piezo_sym.spec.expressions import Node, names
from piezo_sym.spec.names import NAME
from piezo_sym.spec.parse import parse_law
from piezo_sym.spec.tables import (
    Condition,
    LawField,
    Tables,
    banks,
    bodies,
    conditions,
    law_fields,
    references,
    states,
    temperatures,
)


def check_references(spec: Tables) -> None:
    """Check that there are elements, and that inputs and bodies they name are declared."""
    if not spec.elements:
        raise SpecError("has no elements", "elements", "at least one", f"kinds: {listing(KINDS)}")
    for name, element in spec.elements.items():
        for field, to, given in references(element):
            known = bodies(spec) if to == "thermal_mass" else tuple(spec.inputs)
            if given not in known:
                raise _unknown_reference(f"elements.{name}.{field}", to, given, known)
        if isinstance(element, Conduction) and len({*element.between}) == 1:
            what = f"both ends are at body {quote(element.between[0])}"
            remedy = "name another thermal_mass"
            raise SpecError(what, f"elements.{name}.between", "two different bodies", remedy)


def _unknown_reference(where: str, to: str, given: str, known: tuple[str, ...]) -> SpecError:
    what = f"{quote(given)} is no {to} of this spec"
    if known:
        return SpecError(what, where, remedy=nearest(given, known))
    if to == "thermal_mass":
        name = given if NAME.fullmatch(given) else "body"
        body = f'{name} = {{ kind = "thermal_mass", temperature = "T_0*exp(S/c_0)" }}'
        remedy = f"add one to [elements]: {body}"
        return SpecError(what, where, "a body for the heat", remedy)
    return SpecError(what, where, remedy=f'declare it in [inputs]: {given} = {{ unit = "V" }}')


def check_laws(spec: Tables) -> None:
    """Parse every law, initial value and condition, and check the names in them."""
    for name, element in spec.elements.items():
        for law in law_fields(name, element):
            _check_words(law.tree, law.where, law.letters, spec.parameters)
            _check_body(spec, name, law)
    _check_initial(spec)
    words = [*spec.parameters, *spec.inputs, *states(spec), *temperatures(spec)]
    for condition in conditions(spec):
        _check_words(condition.tree, condition.where, (), words)
        _check_banks(spec, condition)


def _check_body(spec: Tables, name: str, law: LawField) -> None:
    """Refuse a temperature in a law of an element that names no body, unless there is just one."""
    named = any(to == "thermal_mass" for _, to, _ in references(spec.elements[name]))
    if "T" in names(law.tree) and not named and len(bodies(spec)) != 1:
        remedy = "add to the element: temperature = '<name of a thermal_mass>'"
        raise SpecError("'T' is the temperature of no body", law.where, "a body named", remedy)


def _check_banks(spec: Tables, condition: Condition) -> None:
    """Refuse a condition on the states of two banks, whose lanes have nothing in common."""
    elements, sizes = states(spec), banks(spec)
    mixed = {elements[word] for word in names(condition.tree) if elements.get(word) in sizes}
    if len(mixed) > 1:
        what = f"mixes states of the banks {listing(sorted(mixed))}"
        raise SpecError(what, condition.where, "states of one bank", "write a condition for each")


def _check_initial(spec: Tables) -> None:
    known, sizes = states(spec), banks(spec)
    for symbol, start in spec.initial.items():
        where = f"initial.{symbol}"
        if symbol not in known:
            what = f"{quote(symbol)} is no state of this spec"
            raise SpecError(what, where, remedy=nearest(symbol, known))
        count = sizes.get(known[symbol])
        if isinstance(start, tuple) and len(start) != count:
            expected = (
                f"{count} values, one a lane" if count else "one value: no bank has this state"
            )
            raise SpecError(f"{len(start)} values are given", where, expected)
        for part in start if isinstance(start, tuple) else (start,):
            if isinstance(part, str):
                tree = parse_law(part, where)
                _check_words(tree, where, (), [*spec.parameters, *spec.inputs])


def _check_words(tree: Node, where: str, letters: tuple[str, ...], words: Collection[str]) -> None:
    for word in names(tree):
        if word in letters or word in words:
            continue
        if word in {"i", "v", "f", "T", *(kind.letter for kind in KINDS.values())}:
            expected = f"the letters {listing(letters)}" if letters else "parameters"
            raise SpecError(f"{quote(word)} has no meaning here", where, expected)
        remedy = nearest(word, [*letters, *words])
        raise SpecError(f"unknown name {quote(word)}", where, remedy=remedy)
