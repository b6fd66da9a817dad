"""Energies of a spec: fields that go together, and laws of stores that depend on one state.

A capacitor whose capacitance depends on a temperature has no energy of its charge alone, but one of
its charge and the body's entropy, for which there is the kind `storage`.
"""

from collections.abc import Mapping

from piezo_sym.errors import SpecError, quote
from piezo_sym.expressions.energies import antiderivative
from piezo_sym.expressions.text import spell
from piezo_sym.expressions.tree import names, replace
from piezo_sym.spec.elements.marks import LawField
from piezo_sym.spec.elements.ports import Body, Storage
from piezo_sym.spec.fields import Tables
from piezo_sym.spec.tables import temperatures


def check_energies(spec: Tables) -> None:
    """Check the fields and laws of elements that store energy."""
    warm = temperatures(spec)
    hot = {"T": next(iter(warm.values()), ""), **warm, **{f"T_{b}": b for b in warm.values()}}
    for name, element in spec.elements.items():
        if fault := element.row.form.fault(element):
            field, what, expected, remedy = fault
            raise SpecError(what, f"elements.{name}{field}", expected, remedy)
        for law in element.laws(name):
            if element.letter and law.letters == (element.letter,) and not element.is_body:
                _check_law(spec, law, hot)


def _check_law(spec: Tables, law: LawField, hot: Mapping[str, str]) -> None:
    """Refuse a law of a store that depends on a temperature; `hot` is the body of each."""
    word = next((w for w in names(law.tree) if w in hot and w not in spec.parameters), "")
    if not word:
        return
    name, letter = law.element, spec.elements[law.element].letter
    what = f"the {law.field} depends on {quote(word)}, and then is no energy of {letter}"
    remedy = "let it depend on parameters and its own state"
    if hot[word]:
        body = hot[word]
        storage = _storage(spec, name, body, word)
        remedy = f"give one energy of both states in place of '{name}' and '{body}': {storage}"
    raise SpecError(what, law.where, "an energy of all states that it depends on", remedy)


def _storage(spec: Tables, name: str, body: str, word: str) -> str:
    """Return the text of a `storage` that has the energy of a store and of the body it names.

    `word` is the temperature in the store's law; the body's own law is put in its place.
    """
    (store,) = (p for p in spec.elements[name].ports(name) if isinstance(p, Storage))
    heat = next(p for p in spec.elements[body].ports(body) if isinstance(p, Body))
    law = replace(store.law, {word: heat.law})
    stored, warm = antiderivative(law, store.state), antiderivative(heat.law, heat.state)
    texts = (spell(part) if part else "<its energy>" for part in (stored, warm))
    rate = store.domain.variable(store.imposes.other).name
    nodes = ", ".join(f'"{node}"' for node in store.branch)
    branch = f'{{ rate = "{rate}", between = [{nodes}] }}'
    states = f'{{ {store.state} = {branch}, {heat.state} = {{ rate = "entropy" }} }}'
    return f'{body} = {{ kind = "storage", energy = "{" + ".join(texts)}", states = {states} }}'
