"""Which stores follow others: those whose co-states the junction laws tie to earlier ones.

Input: junction laws that contradict each other.  Output: the states of the stores that are given
their co-state and give their rate instead, or one `NetworkError` that says what cannot be joined.
Kept are, in the order of the spec, those whose co-state is no combination of those kept before.
"""

from __future__ import annotations

from typing import Any

from piezo_sym.algebra.linear import Form, SingularError, combine
from piezo_sym.errors import quote
from piezo_sym.expressions.tree import names
from piezo_sym.network.inverse import constant_slope, vanishes
from piezo_sym.network.kirchhoff import Laws
from piezo_sym.network.refusals import couplings_in, refusal
from piezo_sym.spec.elements.ports import Body, DissipativePort


def dependent(laws: Laws, singular: SingularError) -> set[str]:
    """Return the states of stores whose co-states are decided by others, before them in the spec.

    Raises
    ------
    NetworkError
        If the laws do not fix the network otherwise, or a store cannot be joined.
    """
    if not singular.relations:
        raise refusal(laws, singular)
    found = set()
    for label, row in _reduced(singular.relations).items():
        why = _hindrance(laws, row)
        if label[0] != "E" or len(row) == 1 or why:
            said = [relation for relation in singular.relations if relation.keys() == row.keys()]
            raise refusal(laws, SingularError([*said, row, *singular.relations], []), why)
        found.add(laws.states[label[1]][1].state)
    return found


def _reduced(relations: list[Form]) -> dict[Any, Form]:
    """Return relations solved for the last store in each, or for what is no store's co-state."""
    labels = dict.fromkeys(label for relation in relations for label in relation)
    stores = sorted(label for label in labels if label[0] == "E")
    order = [*stores, *(label for label in labels if label[0] != "E")]
    rows: dict[Any, Form] = {}
    for relation in relations:
        form = dict(relation)
        for pivot, row in rows.items():
            combine(form, row, -form.get(pivot, 0))
        if form:
            last = max(form, key=order.index)
            form = {label: value / form[last] for label, value in form.items()}
            for row in rows.values():
                combine(row, form, -row.get(last, 0))
            rows[last] = form
    return rows


def _hindrance(laws: Laws, row: Form) -> str:
    """Return why stores whose co-states depend on each other cannot be joined, else nothing."""
    labels = [label[1] if label[0] == "sum" else label for label in row]
    stores = [laws.states[n] for kind, n in labels if kind == "E"]
    if len(stores) < len(row):
        return ""
    known = laws.circuit.model.parameters.keys()
    slips = {port.state for _, port in laws.circuit.of(DissipativePort) if port.rate}
    for placed, store in stores:
        name = quote(placed.element)
        if isinstance(store, Body):
            return f", and {name} is a body, whose temperature nothing else can impose"
        if placed.bank:
            return f", and {name} is a bank, which is not joined to others"
        if store.state in slips:
            return f", and {name} slips"
        slope = constant_slope(store.law, store.state)
        used = {*names(store.law), *names(store.energy or store.law)} - {store.state}
        if slope is None or vanishes(slope) or not known >= used:
            return f", and the energy of {name} is not quadratic"
    for placed, port in couplings_in(laws, row):
        if not known >= {*names(port.ratio)}:
            return f", and the ratio of {quote(placed.element)} is not of parameters alone"
    return ""
